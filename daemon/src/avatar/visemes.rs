//! The 15 visemes of Oculus LipSync over time, from the phones and their times alone.
//!
//! At every instant at most two neighbours share the mouth, so the weights add up to 1. Visemes
//! change round the boundary of their labels, except that lips touch for the whole of their hold:
//! a mouth is closed when a hold begins and begins to open when it ends. A release after its
//! closure belongs to what comes next: TIMIT's closure owns the contact.

use std::fmt::Write as _;

use mouthpiece_phonemes::{Class, Phone, Segment};

use crate::cli::Fps;
use crate::interrupt;
use crate::media::text::TextOutput;

/// The visemes in the order of their numbers there.
pub const NAMES: [&str; 15] = [
    "sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "ih", "oh", "ou",
];

/// A viseme by its place in [`NAMES`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
enum Viseme {
    Sil,
    Pp,
    Ff,
    Th,
    Dd,
    Kk,
    Ch,
    Ss,
    Nn,
    Rr,
    Aa,
    E,
    Ih,
    Oh,
    Ou,
}
use Viseme::{Aa, Ch, Dd, E, Ff, Ih, Kk, Nn, Oh, Ou, Pp, Rr, Sil, Ss, Th};

/// What a phone looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Look {
    One(Viseme),
    /// From one to another.
    Glide(Viseme, Viseme),
    /// The mouth already has the shape of what follows.
    Next,
}
use Look::{Glide, Next, One};

/// The viseme of each phone, by the examples in the documentation of Oculus LipSync (PP put, FF fat,
/// TH think, DD tip, kk call, CH chair, SS sir, nn lot and not, RR red, aa car, E bed, ih tip, oh
/// toe, ou book); phones without an example go to the one whose lips are nearest.
fn look(phone: Phone) -> Look {
    match phone {
        Phone::Iy => One(Ih),
        Phone::Ih => One(Ih),
        Phone::Eh => One(E),
        Phone::Ey => Glide(E, Ih),
        Phone::Ae => One(Aa),
        Phone::Aa => One(Aa),
        Phone::Aw => Glide(Aa, Ou),
        Phone::Ay => Glide(Aa, Ih),
        Phone::Ah => One(Aa),
        Phone::Ao => One(Oh),
        Phone::Oy => Glide(Oh, Ih),
        Phone::Ow => Glide(Oh, Ou),
        Phone::Uh => One(Ou),
        Phone::Uw => One(Ou),
        Phone::Ux => One(Ou),
        Phone::Er => One(Rr),
        Phone::Ax => One(E),
        Phone::Ix => One(Ih),
        Phone::Axr => One(Rr),
        Phone::AxH => One(E),
        Phone::L => One(Nn),
        Phone::R => One(Rr),
        Phone::W => One(Ou),
        Phone::Y => One(Ih),
        Phone::Hh => Next,
        Phone::Hv => Next,
        Phone::El => One(Nn),
        Phone::M => One(Pp),
        Phone::N => One(Nn),
        Phone::Ng => One(Kk),
        Phone::Em => One(Pp),
        Phone::En => One(Nn),
        Phone::Eng => One(Kk),
        Phone::Nx => One(Nn),
        Phone::S => One(Ss),
        Phone::Sh => One(Ch),
        Phone::Z => One(Ss),
        Phone::Zh => One(Ch),
        Phone::F => One(Ff),
        Phone::Th => One(Th),
        Phone::V => One(Ff),
        Phone::Dh => One(Th),
        Phone::Jh => One(Ch),
        Phone::Ch => One(Ch),
        Phone::B => One(Pp),
        Phone::D => One(Dd),
        Phone::G => One(Kk),
        Phone::P => One(Pp),
        Phone::T => One(Dd),
        Phone::K => One(Kk),
        Phone::Dx => One(Dd),
        Phone::Q => Next,
        Phone::Bcl => One(Pp),
        Phone::Dcl => One(Dd),
        Phone::Gcl => One(Kk),
        Phone::Pcl => One(Pp),
        Phone::Tcl => One(Dd),
        Phone::Kcl => One(Kk),
        Phone::Pau => One(Sil),
        Phone::Epi => One(Sil),
        Phone::HSharp => One(Sil),
    }
}

/// Longest half of a change from one viseme to the next, ticks: 40 ms, by which lips lead sounds.
const HALF_CHANGE: i64 = 1920;

/// A viseme held for a while, changes included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Held {
    viseme: Viseme,
    start: i64,
    end: i64,
}

/// The visemes of `segments`, which ascend and do not overlap, without holes.
fn held(segments: &[Segment]) -> Vec<Held> {
    let mut out: Vec<Held> = Vec::with_capacity(segments.len() + 2);
    let mut add = |viseme, end: i64| {
        let start = out.last().map_or(i64::MIN / 4, |last| last.end);
        match out.last_mut() {
            Some(last) if last.viseme == viseme => last.end = last.end.max(end),
            _ if end > start => out.push(Held { viseme, start, end }),
            _ => {}
        }
    };
    let mut covered = i64::MIN / 4;
    for (i, segment) in segments.iter().enumerate() {
        if segment.start > covered {
            add(Sil, segment.start);
        }
        let before = i.checked_sub(1).map(|i| segments[i].phone);
        let after = segments.get(i + 1).map(|s| s.phone);
        let (start, end) = (segment.start, segment.end);
        covered = end;
        match (segment.phone, look(segment.phone)) {
            // What follows a release begins with it.
            (p, _)
                if p.class() == Class::Stop && p.closure().is_some() && p.closure() == before =>
            {
                if after.is_none() {
                    add(Sil, end);
                }
            }
            // Lips protrude for an affricate from its closure on.
            (Phone::Tcl, _) if after == Some(Phone::Ch) => add(Ch, end),
            (Phone::Dcl, _) if after == Some(Phone::Jh) => add(Ch, end),
            // A stop in one label: closed first, then open for what follows.
            (p @ (Phone::P | Phone::B), One(viseme)) => {
                debug_assert!(p.is_bilabial());
                add(viseme, start + (end - start) * 3 / 5);
                if after.is_none() {
                    add(Sil, end);
                }
            }
            (_, One(viseme)) => add(viseme, end),
            (_, Glide(from, to)) => {
                add(from, start + (end - start) * 3 / 5);
                add(to, end);
            }
            (_, Next) => {
                if after.is_none() {
                    add(Sil, end);
                }
            }
        }
    }
    add(Sil, i64::MAX / 4);
    out
}

/// From where to where `a` becomes `b`: within the nearer half of each.
fn change(a: &Held, b: &Held) -> (i64, i64) {
    let touching = |h: &Held| matches!(h.viseme, Pp | Ff);
    let room = (a.end - a.start).min(b.end - b.start);
    let half = HALF_CHANGE.min(room / 4);
    match (touching(a), touching(b)) {
        (false, true) => (b.start - 2 * half, b.start),
        (true, false) => (b.start, b.start + 2 * half),
        _ => (b.start - half, b.start + half),
    }
}

/// The weights at `ticks`, in the order of [`NAMES`]; they add up to 1.
fn weights(held: &[Held], ticks: i64) -> [f64; 15] {
    let mut weights = [0.0; 15];
    let i = held
        .partition_point(|h| h.end <= ticks)
        .min(held.len().saturating_sub(1));
    let Some(now) = held.get(i) else {
        weights[Sil as usize] = 1.0;
        return weights;
    };
    let neighbours = [
        i.checked_sub(1).map(|before| (&held[before], now)),
        held.get(i + 1).map(|after| (now, after)),
    ];
    for (a, b) in neighbours.into_iter().flatten() {
        let (from, to) = change(a, b);
        if (from..to).contains(&ticks) {
            let x = (ticks - from) as f64 / (to - from) as f64;
            let share = x * x * (3.0 - 2.0 * x);
            weights[a.viseme as usize] += 1.0 - share;
            weights[b.viseme as usize] += share;
            return weights;
        }
    }
    weights[now.viseme as usize] = 1.0;
    weights
}

fn header() -> String {
    format!("time_s,{}\n", NAMES.join(","))
}

fn row(held: &[Held], rate: Fps, k: u64, out: &mut String) {
    let time = k as f64 * f64::from(rate.den) / f64::from(rate.num);
    let _ = write!(out, "{time:.6}");
    for weight in weights(held, rate.ticks(k)) {
        let _ = write!(out, ",{weight:.5}");
    }
    out.push('\n');
}

/// A row an instant, so many `rows`: the time and a weight per viseme.
pub fn write(
    segments: &[Segment],
    rate: Fps,
    rows: u64,
    out: &mut TextOutput,
) -> anyhow::Result<()> {
    let held = held(segments);
    let mut text = header();
    for k in 0..rows {
        interrupt::check()?;
        row(&held, rate, k, &mut text);
        if !out.write(&text)? {
            break;
        }
        text.clear();
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn say(phones: &[Phone], each: i64) -> Vec<Segment> {
        let segments = phones.iter().zip(0..);
        segments
            .map(|(&p, i)| Segment::new(p, i * each, (i + 1) * each))
            .collect()
    }

    #[test]
    fn weights_add_up_to_one_whatever_is_said_however_fast() {
        for each in [1, 7, 480, 3000, 9600] {
            let mut segments = say(&Phone::ALL, each);
            segments.remove(20); // a hole
            let held = held(&segments);
            for ticks in (-5000..each * 61 + 5000).step_by(37) {
                let sum: f64 = weights(&held, ticks).iter().sum();
                assert!((sum - 1.0).abs() < 1e-9, "{sum} at {ticks}, {each}");
            }
        }
    }

    #[test]
    fn lips_touch_for_the_whole_hold_and_open_with_the_release() {
        use Phone::{Aa, B, Bcl, F, HSharp, M};
        let held = held(&say(&[HSharp, Aa, M, Aa, Bcl, B, Aa, F, HSharp], 4800));
        for (segment, viseme) in [(2, Pp), (4, Pp), (7, Ff)] {
            for ticks in [
                segment * 4800,
                segment * 4800 + 2400,
                (segment + 1) * 4800 - 1,
            ] {
                assert_eq!(weights(&held, ticks)[viseme as usize], 1.0, "{ticks}");
            }
        }
        assert!(weights(&held, 6 * 4800)[super::Aa as usize] > 0.9);
    }

    #[test]
    fn vowels_open_round_and_glide() {
        use Phone::{Aa, Ay, HSharp, Hh, Uw};
        let held = held(&say(&[HSharp, Hh, Aa, Uw, Ay, HSharp], 9600));
        let at = |ticks, viseme: Viseme| weights(&held, ticks)[viseme as usize];
        // /h/ has the mouth of its vowel.
        assert_eq!(at(14_400, super::Aa), 1.0);
        assert_eq!(at(33_600, Ou), 1.0);
        assert_eq!(at(41_000, super::Aa), 1.0);
        assert_eq!(at(46_500, Ih), 1.0);
        assert_eq!(at(0, Sil), 1.0);
        assert_eq!(at(100_000, Sil), 1.0);
    }

    #[test]
    fn the_table_has_a_row_an_instant_and_fifteen_weights() {
        let mut text = header();
        let held = held(&say(&[Phone::M], 4800));
        for k in 0..6 {
            row(&held, Fps { num: 50, den: 1 }, k, &mut text);
        }
        let lines: Vec<_> = text.lines().collect();
        assert_eq!(
            lines[0],
            "time_s,sil,PP,FF,TH,DD,kk,CH,SS,nn,RR,aa,E,ih,oh,ou"
        );
        assert_eq!(lines.len(), 1 + 6);
        assert!(lines.iter().all(|line| line.split(',').count() == 16));
        assert!(lines[3].starts_with("0.040000,0.00000,1.00000"));
    }
}
