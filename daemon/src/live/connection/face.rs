//! What a client's messages about the face mean for this head's controls: names become muscles here,
//! seconds become ticks.

use mouthpiece_protocol::message::{Express, FaceState, Look};
use mouthpiece_rig::{Controls, ExpressionError, Library, TICK_RATE};
use mouthpiece_speech::State;

use crate::live::showing::{Direction, Showing};

/// How long a face takes to go over, seconds, where a client does not say (judgement: as people's do).
const EXPRESS_FADE_S: f32 = 0.3;
/// The same for a head that follows the eyes.
const LOOK_FADE_S: f32 = 0.5;

/// The controls of an `express`.
pub(super) fn express(express: &Express) -> Result<Showing, ExpressionError> {
    let full = match (&express.expression, &express.muscles) {
        (Some(name), _) => match Library::built_in() {
            Ok(library) => *library.get(name)?.controls(),
            Err(error) => return Err(ExpressionError::Setting(error.to_string())),
        },
        (None, Some(muscles)) => Controls::named(muscles.iter().map(|(n, v)| (n.as_str(), *v)))?,
        (None, None) => Controls::default(),
    };
    Ok(Showing::Face {
        controls: Box::new(Controls::default().lerp(&full, express.weight.unwrap_or(1.0))),
        fade: ticks(express.fade_s.unwrap_or(EXPRESS_FADE_S)),
    })
}

/// Where a `look` turns eyes and head.
pub(super) fn look(look: &Look) -> Showing {
    Showing::Look {
        at: look.at.map(Direction::to),
        fade: ticks(look.fade_s.unwrap_or(LOOK_FADE_S)),
    }
}

/// The state of a face that says nothing.
pub(super) fn state(state: FaceState) -> Showing {
    Showing::State(match state {
        FaceState::Idle => State::Idle,
        FaceState::Listening => State::Listening,
        FaceState::Thinking => State::Thinking,
    })
}

fn ticks(seconds: f32) -> i64 {
    (f64::from(seconds) * TICK_RATE as f64).round() as i64
}

#[cfg(test)]
mod tests {
    use super::*;
    use mouthpiece_rig::Control;

    #[test]
    fn names_become_muscles_and_unknown_ones_are_answered_with_those_there_are() {
        let named = |name: &str| Express {
            expression: Some(name.to_owned()),
            weight: Some(0.5),
            ..Express::default()
        };
        let Ok(Showing::Face { controls, fade }) = express(&named("happiness")) else {
            panic!("happiness is known");
        };
        assert!(controls[Control::ZygomaticusMajor] > 0.1 && fade == 14_400);
        let why = express(&named("hapiness")).unwrap_err().to_string();
        assert!(why.contains("`happiness`"), "{why}");

        let muscles = |name: &str, value: f32| Express {
            muscles: Some([(name.to_owned(), value)].into()),
            ..Express::default()
        };
        let Ok(Showing::Face { controls, .. }) = express(&muscles("frontalis_outer_l", 0.8)) else {
            panic!("one belly is known");
        };
        assert!((controls[Control::FrontalisOuter] - 0.4).abs() < 1e-6);
        for (name, value) in [("frontalis", 0.5), ("zygomaticus_major", 1.5)] {
            assert!(express(&muscles(name, value)).is_err(), "{name} {value}");
        }
    }
}
