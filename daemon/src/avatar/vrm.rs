//! The expressions of VRM avatars: five vowels, lids and gaze.
//!
//! A VRM mouth has five shapes and no muscles, so they are told apart by what the simulated lips do:
//! how far they are from each other, and how round they are. Lips that touch give no vowel at all, so
//! that a /p/ is closed on the other avatar as it is here; the weights of the vowels never add up to
//! more than 1. Lids that close together are a blink, what one of them closes further a wink, so that
//! the two never add up either.

use mouthpiece_rig::Control;

use super::face::Face;

/// Names in VRM 1.0 and in VRM 0.x, and the value, before it is held within 0 and 1.
type Expression = (&'static str, &'static str, fn(&Face<'_>) -> f32);

/// How many expressions are given.
pub const COUNT: usize = 12;

/// As in the specifications of both versions, without the expressions of feeling.
const EXPRESSIONS: [Expression; COUNT] = [
    ("aa", "A", |f| spread(f)[2]),
    ("ih", "I", |f| spread(f)[0]),
    ("ou", "U", |f| round(f) * (1.0 - f.open())),
    ("ee", "E", |f| spread(f)[1]),
    ("oh", "O", |f| round(f) * f.open()),
    ("blink", "Blink", both_lids),
    ("blinkLeft", "Blink_L", |f| lid(f, true) - both_lids(f)),
    ("blinkRight", "Blink_R", |f| lid(f, false) - both_lids(f)),
    ("lookUp", "LookUp", |f| f.look(Control::GazePitch)),
    ("lookDown", "LookDown", |f| -f.look(Control::GazePitch)),
    ("lookLeft", "LookLeft", |f| f.look(Control::GazeYaw)),
    ("lookRight", "LookRight", |f| -f.look(Control::GazeYaw)),
];

/// Gap of the most open vowel, mm (/aa/, measured: 13).
const OPEN_MM: f32 = 12.0;
/// Shares of it at which a mouth that is not round shows `ih` and `ee`.
const IH: f32 = 0.25;
const EE: f32 = 0.5;
/// Gap from which on the lips count as apart, mm: a round mouth in /p b m/ is closed, too.
const PARTED_MM: f32 = 1.0;

/// The names in VRM 1.0.
pub fn names() -> impl Iterator<Item = &'static str> {
    EXPRESSIONS.iter().map(|(name, ..)| *name)
}

/// The names in VRM 0.x.
pub fn names_of_0() -> impl Iterator<Item = &'static str> {
    EXPRESSIONS.iter().map(|(_, name, _)| *name)
}

/// The weights, each within 0 and 1, in the order of the names.
pub fn weights(face: &Face<'_>) -> [f32; COUNT] {
    // Adding 0 makes of -0 a plain one.
    EXPRESSIONS.map(|(.., value)| value(face).clamp(0.0, 1.0) + 0.0)
}

fn round(face: &Face<'_>) -> f32 {
    face.round() * (face.gap_mm() / PARTED_MM).min(1.0)
}

/// Shares of `ih`, `ee` and `aa`: each is left for the next as the mouth opens.
fn spread(face: &Face<'_>) -> [f32; 3] {
    let open = (face.gap_mm() / OPEN_MM).min(1.0);
    let unround = 1.0 - face.round();
    let ee = ((open - IH) / (EE - IH)).clamp(0.0, 1.0);
    let aa = ((open - EE) / (1.0 - EE)).clamp(0.0, 1.0);
    let ih = (open / IH).min(1.0);
    [ih - ee, ee - aa, aa].map(|share| share * unround)
}

fn lid(face: &Face<'_>, left: bool) -> f32 {
    face.blink(left).clamp(0.0, 1.0)
}

fn both_lids(face: &Face<'_>) -> f32 {
    lid(face, true).min(lid(face, false))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::avatar::face::Reader;
    use crate::avatar::tests::held;
    use mouthpiece_phonemes::Phone;

    #[test]
    fn vowels_go_to_theirs_and_lips_that_touch_to_none() {
        let (head, frames) = held(&[
            Phone::M,
            Phone::B,
            Phone::Aa,
            Phone::Iy,
            Phone::Uw,
            Phone::Ao,
        ]);
        let reader = Reader::new(&head);
        let all: Vec<_> = frames.iter().map(|f| weights(&reader.face(f))).collect();
        let vowels = |i: usize| &all[i][..5];
        for closed in [0, 1] {
            assert!(
                vowels(closed).iter().sum::<f32>() < 0.15,
                "{:?}",
                vowels(closed)
            );
        }
        let most = |i: usize| {
            let best = (0..5).max_by(|&a, &b| all[i][a].total_cmp(&all[i][b]));
            names().nth(best.unwrap()).unwrap()
        };
        let found: Vec<_> = (2..6).map(most).collect();
        assert_eq!(found[0], "aa", "{:?}", vowels(2));
        assert!(["ih", "ee"].contains(&found[1]), "{:?}", vowels(3));
        assert_eq!(found[2], "ou", "{:?}", vowels(4));
        assert!(["oh", "aa"].contains(&found[3]), "{:?}", vowels(5));
        for weights in &all {
            assert!(weights[..5].iter().sum::<f32>() <= 1.0 + 1e-5);
        }
    }

    #[test]
    fn a_wink_is_no_blink() {
        let (head, mut frames) = held(&[Phone::M]);
        let reader = Reader::new(&head);
        let state = &mut frames[0].state;
        (state[Control::LidL], state[Control::LidR]) = (1.0, 0.25);
        let weights = weights(&reader.face(&frames[0]));
        let of = |name| weights[names().position(|n| n == name).unwrap()];
        assert_eq!(
            (of("blink"), of("blinkLeft"), of("blinkRight")),
            (0.25, 0.75, 0.0)
        );
    }
}
