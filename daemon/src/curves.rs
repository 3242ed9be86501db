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
use crate::media::text::TextOutput;
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
    let times = (0..rate.instants(utterance.ticks)).map(move |k| rate.ticks(k));
    let start = || Instants::start(cast.head.clone(), part, times);
    if let Some(avatar) = args.avatar {
        return avatar::write(avatar, args, &cast, &utterance, start);
    }
    let json = args.json
        || args
            .output
            .as_deref()
            .is_some_and(|p| p.extension().is_some_and(|e| e == "json"));
    let table = Table::new(json);
    let mut out = TextOutput::create(args.output.as_deref())?;
    let mut text = table.header();
    start()?.each(|k, instant| {
        table.row(
            rate,
            k,
            instant,
            &measure(&cast.head, &instant.frame),
            &mut text,
        );
        let wanted = out.write(&text);
        text.clear();
        wanted
    })?;
    out.write(table.footer())?;
    out.finish()
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

/// How a table is written: as CSV, or as an array of JSON objects, one a row.
struct Table {
    columns: Vec<String>,
    json: bool,
}

impl Table {
    fn new(json: bool) -> Self {
        Self {
            columns: columns(),
            json,
        }
    }

    fn header(&self) -> String {
        match self.json {
            true => "[".into(),
            false => self.columns.join(",") + "\n",
        }
    }

    const fn footer(&self) -> &'static str {
        if self.json { "\n]\n" } else { "" }
    }

    /// Adds row `k` to `out`.
    fn row(&self, rate: Fps, k: u64, instant: &Instant, m: &Measures, out: &mut String) {
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
        if self.json {
            out.push_str(if k == 0 { "\n{" } else { ",\n{" });
            let _ = write!(out, "\"time_s\":{time:.6}");
            for (name, value) in self.columns[1..].iter().zip(values) {
                let _ = write!(out, ",\"{name}\":{value:.5}");
            }
            out.push('}');
        } else {
            let _ = write!(out, "{time:.6}");
            for value in values {
                let _ = write!(out, ",{value:.5}");
            }
            out.push('\n');
        }
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
        let written = |json| {
            let table = Table::new(json);
            let mut text = table.header();
            for k in 0..2 {
                table.row(fps, k, &Instant::default(), &measures, &mut text);
            }
            text + table.footer()
        };
        let (csv, json) = (written(false), written(true));
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
