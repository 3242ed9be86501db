//! `mouthpiece curves`: what speech computed and what the mesh then did, as a table.
//!
//! Steps the same simulation as export and measures the skin that would be drawn; no GPU. The
//! control that turns the jaw and the jaw as measured share a name, so the former's column is called
//! `target_jaw_rad`.

use std::fmt::Write as _;

use mouthpiece_rig::{Control, Measures, TICK_RATE, measure};

use crate::avatar;
use crate::cli::{CurvesArgs, Fps};
use crate::input::Utterance;
use crate::interrupt;
use crate::media::output;
use crate::pipeline::{Cast, Instant, Instants, Mood, Part};

/// Names of what is measured, in order of the columns.
const MEASURED: [&str; 5] = [
    "aperture_mm",
    "width_mm",
    "protrusion_mm",
    "jaw_rad",
    "lip_teeth_mm",
];

/// Runs the command.
pub fn run(args: &CurvesArgs) -> anyhow::Result<()> {
    let utterance = Utterance::load(&args.input)?;
    let cast = Cast::load(&args.cast)?;
    let mut part = Part::new(&cast, &utterance.segments, args.seed)
        .hearing(utterance.sound.as_deref())
        .with_mood(Mood::load(&args.mood)?);
    if let Some(ms) = args.look_ahead {
        let cost = part.look_ahead(&cast, i64::from(ms) * TICK_RATE / 1000);
        eprintln!("look-ahead of {ms} ms: {cost}");
    }
    let rate = args.rate;
    // Both ends count: a second at 100 Hz is 101 rows.
    let rows = (0..=rate.frames(utterance.ticks)).take_while({
        let end = utterance.ticks;
        move |&k| rate.ticks(k) <= end
    });
    let times = rows.map(move |k| rate.ticks(k));
    let start = || Instants::start(cast.head.clone(), part, times);
    if let Some(avatar) = args.avatar {
        return avatar::write(avatar, args, &cast, &utterance, start);
    }
    let instants = start()?;
    let json = args.json
        || args
            .output
            .as_deref()
            .is_some_and(|p| p.extension().is_some_and(|e| e == "json"));
    let mut table = if json { Table::json() } else { Table::csv() };
    let mut k = 0;
    while let Some(instant) = instants.next() {
        interrupt::check()?;
        table.row(rate, k, &instant, &measure(&cast.head, &instant.frame));
        instants.recycle(instant);
        k += 1;
    }
    instants.finish()?;
    output::write_or_print(args.output.as_deref(), &table.finish())
}

/// The columns' names.
fn columns() -> Vec<String> {
    let controls = Control::ALL.iter().map(|control| match control.name() {
        name if MEASURED.contains(&name) => format!("target_{name}"),
        name => name.to_owned(),
    });
    std::iter::once("time_s".to_owned())
        .chain(controls)
        .chain(MEASURED.map(String::from))
        .collect()
}

/// A table being written.
struct Table {
    columns: Vec<String>,
    json: bool,
    text: String,
}

impl Table {
    fn csv() -> Self {
        let columns = columns();
        let text = columns.join(",") + "\n";
        Self {
            columns,
            json: false,
            text,
        }
    }

    /// An array of objects, one a row.
    fn json() -> Self {
        Self {
            columns: columns(),
            json: true,
            text: "[".into(),
        }
    }

    fn row(&mut self, rate: Fps, k: u64, instant: &Instant, m: &Measures) {
        let time = k as f64 * f64::from(rate.den) / f64::from(rate.num);
        // Lips that touch have no gap, whatever the last bit of the float says.
        let measured = [
            m.aperture_mm.max(0.0),
            m.width_mm,
            m.protrusion_mm,
            m.jaw_rad,
            m.lip_teeth_mm,
        ];
        let values = instant.controls.0.iter().chain(&measured);
        let first = self.text.len() <= 1;
        if self.json {
            self.text.push_str(if first { "\n{" } else { ",\n{" });
            let _ = write!(self.text, "\"time_s\":{time:.6}");
            for (name, value) in self.columns[1..].iter().zip(values) {
                let _ = write!(self.text, ",\"{name}\":{value:.5}");
            }
            self.text.push('}');
        } else {
            let _ = write!(self.text, "{time:.6}");
            for value in values {
                let _ = write!(self.text, ",{value:.5}");
            }
            self.text.push('\n');
        }
    }

    fn finish(mut self) -> String {
        if self.json {
            self.text.push_str("\n]\n");
        }
        self.text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_columns_share_a_name_and_json_says_the_same_as_csv() {
        let names = columns();
        let mut sorted = names.clone();
        sorted.sort();
        sorted.dedup();
        assert_eq!(sorted.len(), names.len());
        let fps = Fps { num: 100, den: 1 };
        let measures = Measures {
            aperture_mm: -0.5,
            width_mm: 50.25,
            ..Measures::default()
        };
        let mut csv = Table::csv();
        let mut json = Table::json();
        for k in 0..2 {
            csv.row(fps, k, &Instant::default(), &measures);
            json.row(fps, k, &Instant::default(), &measures);
        }
        let (csv, json) = (csv.finish(), json.finish());
        let rows: Vec<std::collections::BTreeMap<String, f64>> =
            serde_json::from_str(&json).unwrap();
        assert_eq!(rows.len(), 2);
        assert_eq!(rows[1]["time_s"], 0.01);
        assert_eq!(rows[1]["aperture_mm"], 0.0);
        let line = csv.lines().nth(2).unwrap();
        for (name, value) in names.iter().zip(line.split(',')) {
            assert_eq!(rows[1][name], value.parse::<f64>().unwrap(), "{name}");
        }
    }
}
