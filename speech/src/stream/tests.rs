//! Late labels: never a jump, and with half a second of look-ahead no difference that counts.

use mouthpiece_phonemes::{Phone, Segment};
use mouthpiece_rig::{Control, Controls};
use proptest::prelude::*;

use super::LookAhead;
use crate::{Correction, Speech};

const MS: i64 = 48;

fn speech() -> Speech {
    Speech::with(|a| {
        let mut c = Controls::default();
        c[Control::Jaw] = a.jaw_rad;
        c[Control::OrbicularisOrisSuperior] = 0.5 - a.aperture_mm / 60.0;
        c[Control::ProtrusionSuperior] = a.protrusion_mm / 8.0;
        c[Control::Risorius] = a.width - 0.5;
        c[Control::TongueTip] = a.tongue.tip;
        c[Control::TongueBody] = a.tongue.body;
        c
    })
    .unwrap()
}

fn labels() -> impl Strategy<Value = Vec<Segment>> {
    prop::collection::vec((0..Phone::ALL.len(), 30..200_i64), 1..25).prop_map(|phones| {
        let mut at = 0;
        let segment = |(phone, length)| {
            let start = at;
            at += length * MS;
            Segment::new(Phone::ALL[phone], start, at)
        };
        phones.into_iter().map(segment).collect()
    })
}

proptest! {
    #[test]
    fn a_late_label_changes_nothing_at_once(segments in labels(), look_ahead in 0..500_i64) {
        let speech = speech();
        let end = segments.last().map_or(0, |s| s.end);
        let mut coming = LookAhead::new(&speech, &segments, look_ahead * MS);
        coming.advance(-1000 * MS);
        // A step of the simulation is shorter; this is fine enough to see a jump.
        let step = 240;
        let mut last = coming.stream().controls_at(-1000 * MS);
        for tick in (-1000 * MS..end + 500 * MS).step_by(step) {
            let own = |coming: &LookAhead, control| {
                let at = |tick| coming.stream().track().controls_at(tick)[control];
                (at(tick) - at(tick - step as i64)).abs()
            };
            let old = coming.clone();
            coming.advance(tick);
            let now = coming.stream().controls_at(tick);
            for &control in Control::ALL {
                // No faster than what was known or is known by now, and the correction on top of it.
                let own = own(&old, control).max(own(&coming, control));
                let most = own + Correction::speed(control) * step as f32 + 1e-5;
                let change = (now[control] - last[control]).abs();
                prop_assert!(change <= most, "{} by {change} at {tick}", control.name());
            }
            last = now;
        }
        // In the end all is known and no difference is left.
        let whole = speech.track(&segments);
        for tick in (end + 300 * MS..end + 500 * MS).step_by(480) {
            prop_assert_eq!(coming.stream().controls_at(tick), whole.controls_at(tick));
        }
    }

    #[test]
    fn half_a_second_is_as_good_as_all(mut segments in labels()) {
        // As in any language every other phone is a vowel: a mouth that nobody asks for anything for half a
        // second is moved by the faintest call from afar.
        let vowels = [Phone::Aa, Phone::Iy, Phone::Uw, Phone::Ax, Phone::Ow, Phone::Ae];
        for (i, segment) in segments.iter_mut().enumerate().step_by(2) {
            segment.phone = vowels[(i + segment.phone.index()) % vowels.len()];
        }
        let speech = speech();
        let end = segments.last().map_or(0, |s| s.end);
        let whole = speech.track(&segments);
        let mut coming = LookAhead::new(&speech, &segments, 500 * MS);
        let (mut square, mut count) = (0.0, 0.0);
        for tick in (-500 * MS..end).step_by(480) {
            coming.advance(tick);
            let (now, all) = (coming.stream().controls_at(tick), whole.controls_at(tick));
            square += Control::ALL.iter().map(|c| (now[*c] - all[*c]).powi(2)).sum::<f32>();
            count += 6.0;
        }
        let rms = (square / count).sqrt();
        prop_assert!(rms < 0.01, "{rms}");
    }
}
