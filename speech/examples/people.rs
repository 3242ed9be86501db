//! The built-in head's mouth beside what was measured on people, over label files of any format: `cargo run
//! --release -p mouthpiece-speech --example people -- tests/fixtures/sentences/*.PHN`.
//!
//! Figures for people are those of the recordings that the tables name as EMA (articulograph, American
//! English), or have their source beside them. Ours are read off the simulated skin as it is drawn, 240 times
//! a second. Peaks are over 12.5 ms, as slow as an articulograph's filter. Files called `articulation.toml` and
//! `dominance.toml` take the place of the built-in tables, for tuning.

use std::error::Error;
use std::path::Path;
use std::sync::Arc;

use mouthpiece_phonemes::{Phone, ReadOptions, Segment, read_file};
use mouthpiece_rig::{Head, KeyFrame, Measures, STEP_TICKS, Simulation, TICK_RATE, measure};
use mouthpiece_speech::{Speech, Tables};

const ROW_S: f64 = STEP_TICKS as f64 / TICK_RATE as f64;
/// Lips that are this near count as closed, as in the tests.
const CLOSED_MM: f64 = 0.3;
/// How far the lower incisors drop when the jaw turns by a radian, mm.
const INCISORS_MM: f64 = 80.0;

/// An utterance as the head spoke it.
struct Spoken {
    segments: Vec<Segment>,
    aperture: Vec<f64>,
    teeth: Vec<f64>,
    protrusion: Vec<f64>,
    jaw: Vec<f64>,
}

struct Face {
    head: Arc<Head>,
    speech: Speech,
}

impl Face {
    fn speak(&self, segments: Vec<Segment>) -> Spoken {
        let track = self.speech.track(&segments);
        let mut simulation = Simulation::new(Arc::clone(&self.head));
        simulation.set_time(-TICK_RATE);
        let mut frame = KeyFrame::default();
        let mut rows: Vec<Measures> = Vec::new();
        while simulation.time() < track.end() {
            simulation.step(&track.controls_at(simulation.time() + STEP_TICKS));
            if simulation.time() >= 0 {
                simulation.save(&mut frame);
                rows.push(measure(&self.head, &frame));
            }
        }
        let column = |of: fn(&Measures) -> f32| rows.iter().map(|m| f64::from(of(m))).collect();
        Spoken {
            segments,
            aperture: column(|m| m.aperture_mm.max(0.0)),
            teeth: column(|m| m.lip_teeth_mm),
            protrusion: column(|m| m.protrusion_mm),
            jaw: column(|m| m.jaw_rad),
        }
    }
}

fn row(ticks: i64) -> usize {
    (ticks.max(0) / STEP_TICKS) as usize
}

fn within<'a>(values: &'a [f64], segment: &Segment) -> &'a [f64] {
    let end = row(segment.end).min(values.len());
    &values[row(segment.start).min(end)..end]
}

fn most(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::MIN, f64::max)
}

fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::MAX, f64::min)
}

/// Speeds, per second.
fn speeds(values: &[f64]) -> Vec<f64> {
    let speed = |w: &[f64]| (w[3] - w[0]) / (3.0 * ROW_S);
    values.windows(4).map(speed).collect()
}

/// The median and the middle four fifths.
fn spread(mut values: Vec<f64>, decimals: usize) -> String {
    if values.is_empty() {
        return "none".into();
    }
    values.sort_by(f64::total_cmp);
    let at = |share: f64| values[((values.len() - 1) as f64 * share).round() as usize];
    let (low, middle, high) = (at(0.1), at(0.5), at(0.9));
    format!("{middle:.decimals$} ({low:.decimals$} to {high:.decimals$})")
}

/// The rows in which the lips are closed nearest to the middle of `segment`.
fn closed(aperture: &[f64], segment: &Segment) -> Option<(usize, usize)> {
    let shut = |i: &usize| aperture[*i] <= CLOSED_MM;
    let middle = row(segment.start + segment.duration() / 2) as i64;
    let rows = row(segment.start)..row(segment.end).min(aperture.len());
    let at = rows
        .filter(shut)
        .min_by_key(|i| (*i as i64 - middle).abs())?;
    let first = (0..=at).rev().take_while(shut).last()?;
    let last = (at..aperture.len()).take_while(shut).last()?;
    Some((first, last))
}

/// Whether the segment alone keeps the lips closed.
fn alone(segments: &[Segment], i: usize) -> bool {
    let far = 60 * TICK_RATE / 1000;
    let near = |other: &Segment| {
        other.start - segments[i].end < far && segments[i].start - other.end < far
    };
    let holds = |j: usize, other: &Segment| {
        other.phone.is_silence() || (other.phone.is_bilabial() && j != i + 1)
    };
    let mut others = segments.iter().enumerate();
    others.all(|(j, other)| j == i || !near(other) || !holds(j, other))
}

const fn is_hold(phone: Phone) -> bool {
    phone.is_bilabial() && !matches!(phone, Phone::P | Phone::B)
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len() as f64;
    let mean = |v: &[f64]| v.iter().sum::<f64>() / n;
    let (ma, mb) = (mean(a), mean(b));
    let pairs = a.iter().zip(b);
    let dot: f64 = pairs.map(|(x, y)| (x - ma) * (y - mb)).sum();
    let square = |v: &[f64], m: f64| v.iter().map(|x| (x - m).powi(2)).sum::<f64>();
    dot / (square(a, ma) * square(b, mb)).sqrt().max(1e-12)
}

/// Cohen and Massaro's plain model with what fitted the recordings best: one theta for all, a lead, more
/// alpha for closures and less for pauses.
#[derive(Clone, Copy)]
struct Plain {
    theta: f64,
    lead_ms: f64,
    /// The same of lips that touch; ours touch on their labels.
    contact_lead_ms: f64,
}

impl Plain {
    fn at(&self, segments: &[Segment], target: impl Fn(Phone) -> Option<f64>, ms: f64) -> f64 {
        let (mut sum, mut weight) = (0.0, 1e-9);
        for segment in segments {
            let Some(target) = target(segment.phone) else {
                continue;
            };
            let alpha = match segment.phone {
                phone if is_hold(phone) => 2.0,
                phone if phone.is_silence() => 0.5,
                _ => 1.0,
            };
            let middle = (segment.start + segment.end) as f64 / 2.0 / TICK_RATE as f64 * 1e3;
            let lead = match segment.phone {
                phone if is_hold(phone) || phone.is_labiodental() => self.contact_lead_ms,
                _ => self.lead_ms,
            };
            let d = alpha * (-self.theta * (middle - lead - ms).abs()).exp();
            sum += d * target;
            weight += d;
        }
        (sum / weight).max(0.0)
    }

    /// How `values` correlate with it, and by how many ms they lag behind it.
    fn beside(
        &self,
        values: &[f64],
        segments: &[Segment],
        target: impl Fn(Phone) -> Option<f64>,
    ) -> (f64, f64) {
        let ms = (0..values.len()).map(|i| i as f64 * ROW_S * 1e3);
        let plain: Vec<f64> = ms.map(|ms| self.at(segments, &target, ms)).collect();
        let shifted = |by: i64| {
            let n = values.len() - by.unsigned_abs() as usize;
            let (a, b) = (by.max(0) as usize, (-by).max(0) as usize);
            (by, correlation(&values[a..a + n], &plain[b..b + n]))
        };
        let best = (-25..=25).map(shifted).max_by(|a, b| a.1.total_cmp(&b.1));
        let lag = best.map_or(0.0, |best| best.0 as f64 * ROW_S * 1e3);
        (shifted(0).1, lag)
    }
}

/// Rounding of /uw/ after /iy/ and a consonant of `ms`: how long before the vowel's label it begins, how
/// long it takes from a fifth to four fifths.
fn rounding(face: &Face, ms: i64) -> (f64, f64) {
    let mut at = 0;
    let parts = [
        (Phone::HSharp, 300),
        (Phone::Iy, 200),
        (Phone::Kcl, ms),
        (Phone::Uw, 200),
        (Phone::HSharp, 300),
    ];
    let segments = parts.map(|(phone, ms)| {
        let start = at;
        at += ms * TICK_RATE / 1000;
        Segment::new(phone, start, at)
    });
    let vowel = segments[3];
    let spoken = face.speak(segments.to_vec());
    let from = row(segments[1].start + segments[1].duration() / 2);
    let forward = &spoken.protrusion[from..row(vowel.end)];
    let (low, high) = (forward[0], most(forward));
    let passes = |share: f64| {
        let over = |x: &f64| *x > low + (high - low) * share;
        forward.iter().position(over).unwrap_or(0) as f64
    };
    let begins = (row(vowel.start) - from) as f64 - passes(0.2);
    let takes = passes(0.8) - passes(0.2);
    (begins * ROW_S * 1e3, takes * ROW_S * 1e3)
}

/// A line of the table of phones.
const PHONES: [(&str, &[Phone], &str); 12] = [
    ("iy", &[Phone::Iy], "jaw 2.9 (German i, VTL)"),
    ("ih eh ey", &[Phone::Ih, Phone::Eh, Phone::Ey], ""),
    (
        "ae",
        &[Phone::Ae],
        "jaw 10.2 (quartiles 8.6, 12.1) in words (JAW)",
    ),
    (
        "aa ay aw",
        &[Phone::Aa, Phone::Ay, Phone::Aw],
        "aperture 9.9, jaw 5.9 (German a, VTL)",
    ),
    ("ah", &[Phone::Ah], ""),
    ("ao ow", &[Phone::Ao, Phone::Ow], "jaw 8.7 (German o, VTL)"),
    (
        "uw ux",
        &[Phone::Uw, Phone::Ux],
        "aperture 3.4, jaw 5.4 (German u, VTL); protrusion 1.1 to 3.9 (EMA)",
    ),
    ("w", &[Phone::W], ""),
    ("s z", &[Phone::S, Phone::Z], ""),
    ("sh ch jh", &[Phone::Sh, Phone::Ch, Phone::Jh], ""),
    ("f v", &[Phone::F, Phone::V], "jaw 2.1 (German, VTL)"),
    (
        "m pcl bcl",
        &[Phone::M, Phone::Pcl, Phone::Bcl],
        "jaw 4.2 (German, VTL)",
    ),
];

fn tell_phones(all: &[Spoken]) {
    println!("phone: aperture mm, drop of the incisors mm, protrusion mm; vowels at their widest");
    for (name, phones, people) in PHONES {
        let vowel = phones[0].is_vowel();
        let extreme = if vowel { most } else { least };
        let of = |values: fn(&Spoken) -> &Vec<f64>, extreme: fn(&[f64]) -> f64, scale: f64| {
            let values = all.iter().flat_map(|spoken| {
                let wanted = spoken.segments.iter().filter(|s| phones.contains(&s.phone));
                let seen = wanted.map(move |s| within(values(spoken), s));
                seen.filter(|v| !v.is_empty()).map(|v| scale * extreme(v))
            });
            spread(values.collect(), 1)
        };
        println!(
            "  {name}: {}, {}, {}; people: {people}",
            of(|s| &s.aperture, extreme, 1.0),
            of(|s| &s.jaw, extreme, INCISORS_MM),
            of(|s| &s.protrusion, most, 1.0),
        );
    }
}

fn tell_closures(all: &[Spoken]) {
    let mut furthest = 0.0_f64;
    let (mut lasts, mut off, mut closing, mut opening) = (vec![], vec![], vec![], vec![]);
    for spoken in all {
        let speed = speeds(&spoken.aperture);
        for (i, segment) in spoken.segments.iter().enumerate() {
            if segment.phone.is_labiodental() {
                furthest = furthest.max(least(within(&spoken.teeth, segment)));
            }
            if !is_hold(segment.phone) || !alone(&spoken.segments, i) {
                continue;
            }
            let Some((first, last)) = closed(&spoken.aperture, segment) else {
                let at = segment.start as f64 / TICK_RATE as f64;
                println!("  lips stay open: {} at {at:.3} s", segment.phone);
                continue;
            };
            lasts.push((last - first + 1) as f64 * ROW_S * 1e3);
            let middle = (segment.start + segment.end) as f64 / 2.0 / TICK_RATE as f64;
            off.push(((first + last) as f64 / 2.0 * ROW_S - middle) * 1e3);
            let near = |row: usize| &speed[row.saturating_sub(24)..(row + 24).min(speed.len())];
            closing.push(-least(near(first)));
            opening.push(most(near(last)));
        }
    }
    let (shortest, longest) = (least(&lasts), most(&lasts));
    println!("f v: at most {furthest:.2} mm from the teeth");
    println!(
        "closures: {} ms, all {shortest:.0} to {longest:.0}; people: 40 to 90, median 55 (EMA), 57 +- 24 (Crystal and House 1988)",
        spread(lasts, 0)
    );
    println!("their middle after that of the hold: {} ms", spread(off, 0));
    println!(
        "peak speed of the lips into them: {} mm/s, out of them: {}",
        spread(closing, 0),
        spread(opening, 0)
    );
    let peak = |of: fn(&Spoken) -> &Vec<f64>, scale: f64| {
        let fastest =
            |s: &Spoken| scale * speeds(of(s)).iter().fold(0.0, |a: f64, v| a.max(v.abs()));
        spread(all.iter().map(fastest).collect(), 0)
    };
    println!(
        "peak speed in an utterance: lips {} mm/s, jaw {}; people: lips 135 to 213, fast 269, jaw 83 to 138 (EMA)",
        peak(|s| &s.aperture, 1.0),
        peak(|s| &s.jaw, INCISORS_MM),
    );
}

fn tell_plain(all: &[Spoken], tables: &Tables) {
    let of = |phone: Phone| &tables.articulation[phone.index()];
    let plain = |theta, lead_ms, contact_lead_ms| Plain {
        theta,
        lead_ms,
        contact_lead_ms,
    };
    let lips = |plain: Plain| {
        let beside = all.iter().map(|s| {
            let target = |p| of(p).lips.map(|l| f64::from(l.aperture_mm));
            plain.beside(&s.aperture, &s.segments, target)
        });
        beside.unzip::<f64, f64, Vec<_>, Vec<_>>()
    };
    let jaw = |plain: Plain| {
        let beside = all.iter().map(|s| {
            let target = |p| of(p).jaw_rad.map(f64::from);
            plain.beside(&s.jaw, &s.segments, target)
        });
        beside.unzip()
    };
    println!("beside the plain model, which correlates 0.84 (lips) and 0.80 (jaw) with people:");
    for (what, (fits, lags)) in [
        ("lips", lips(plain(0.03, 40.0, 40.0))),
        ("lips, contact on its labels", lips(plain(0.03, 40.0, 0.0))),
        ("jaw", jaw(plain(0.02, 15.0, 15.0))),
    ] {
        let (fits, lags) = (spread(fits, 2), spread(lags, 0));
        println!("  {what}: {fits}, {lags} ms behind it");
    }
}

/// How much of the opening of an open vowel is left at a faster rate.
fn tell_undershoot(slow: &[Spoken], fast: &[Spoken]) {
    let open = |p: Phone| matches!(p, Phone::Aa | Phone::Ae | Phone::Ay | Phone::Aw | Phone::Ao);
    let (mut lips, mut jaw) = (vec![], vec![]);
    for (slow, fast) in slow.iter().zip(fast) {
        for (a, b) in slow.segments.iter().zip(&fast.segments) {
            let widest = |values: &[f64], s: &Segment| most(within(values, s));
            if open(a.phone) && row(b.duration()) > 0 {
                lips.push(widest(&fast.aperture, b) / widest(&slow.aperture, a));
                jaw.push(widest(&fast.jaw, b) / widest(&slow.jaw, a));
            }
        }
    }
    println!(
        "open vowels at twice the rate: aperture {} times, jaw {}",
        spread(lips, 2),
        spread(jaw, 2)
    );
}

fn main() -> Result<(), Box<dyn Error>> {
    let head = Arc::new(Head::reference()?);
    let (tables, files): (Vec<_>, Vec<_>) =
        std::env::args().skip(1).partition(|a| a.ends_with(".toml"));
    let table = |name: &str| tables.iter().map(Path::new).find(|p| p.ends_with(name));
    let tables = Tables::load(table("articulation.toml"), table("dominance.toml"))?;
    let speech = Speech::from_tables(&tables, |a| head.calibration.controls(a))?;
    let face = Face { head, speech };
    let mut read = Vec::new();
    for file in files {
        read.push(read_file(Path::new(&file), None, &ReadOptions::default())?.segments);
    }
    if read.is_empty() {
        return Err("name some label files".into());
    }
    let at = |rate: i64| {
        let scaled = |s: &Segment| Segment {
            start: s.start / rate,
            end: s.end / rate,
            ..*s
        };
        let spoken = |s: &Vec<Segment>| face.speak(s.iter().map(scaled).collect());
        read.iter().map(spoken).collect::<Vec<_>>()
    };
    let (slow, fast) = (at(1), at(2));
    tell_phones(&slow);
    tell_closures(&slow);
    tell_plain(&slow, &tables);
    tell_undershoot(&slow, &fast);
    println!("twice the rate:");
    tell_closures(&fast);
    println!("rounding for uw behind iy and a consonant:");
    for ms in [70, 140, 210, 280] {
        let (begins, takes) = rounding(&face, ms);
        println!("  of {ms} ms: begins {begins:.0} ms before the vowel, takes {takes:.0} ms");
    }
    println!(
        "  people: begins 0.7 ms earlier a ms of consonant (Perrier et al. 1996), takes 50 to 100 ms (Stevens 1998)"
    );
    Ok(())
}
