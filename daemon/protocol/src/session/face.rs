//! What a client says of the face besides speech: checked here as far as no head is needed for it.
//! Which names there are is the daemon's to know.

use mouthpiece_phonemes::TICK_RATE;

use super::{Action, Refusal, chars_beyond};
use crate::message::{Caption, Express, Look};
use crate::{ErrorCode, limits};

/// An `express` whose numbers make sense.
pub(super) fn express(express: Express) -> Result<Action, Refusal> {
    let wrong = |message: String| Err((ErrorCode::Face, message));
    if express.expression.is_some() && express.muscles.is_some() {
        return wrong("`express` has either `expression` or `muscles`; send two".to_owned());
    }
    let muscles = express.muscles.as_ref();
    if muscles.is_some_and(|m| m.len() > limits::MUSCLES_MAX) {
        return Err((
            ErrorCode::Limit,
            format!("`muscles` has at most {} entries", limits::MUSCLES_MAX),
        ));
    }
    let mut names = muscles.into_iter().flat_map(|m| m.keys());
    if names
        .by_ref()
        .chain(&express.expression)
        .any(|name| chars_beyond(name, limits::FACE_NAME_CHARS_MAX))
    {
        return Err((
            ErrorCode::Limit,
            format!(
                "the name of an expression or muscle has at most {} characters",
                limits::FACE_NAME_CHARS_MAX
            ),
        ));
    }
    if let Some(weight) = express.weight.filter(|w| !(0.0..=1.0).contains(w)) {
        return wrong(format!("`weight` goes from 0 to 1, not to {weight}"));
    }
    fade(express.fade_s)?;
    Ok(Action::Express(express))
}

/// A `look` at a point in front of the face.
pub(super) fn look(look: Look) -> Result<Action, Refusal> {
    if let Some([x, y, z]) = look.at {
        let far = limits::LOOK_MM_MAX;
        let near = [x, y].iter().all(|v| v.abs() <= far) && (1.0..=far).contains(&z);
        if !near {
            return Err((
                ErrorCode::Face,
                format!(
                    "`at` is [left, up, towards the viewer] in mm, the last from 1, none beyond {far}"
                ),
            ));
        }
    }
    fade(look.fade_s)?;
    Ok(Action::Look(look))
}

/// When a caption is shown, ticks, and its text, fit to be drawn.
pub(super) fn caption(caption: &Caption) -> Result<(i64, String), Refusal> {
    if chars_beyond(&caption.text, limits::CAPTION_CHARS_MAX) {
        return Err((
            ErrorCode::Limit,
            format!(
                "a caption has at most {} characters; send several with `start`",
                limits::CAPTION_CHARS_MAX
            ),
        ));
    }
    let start = caption.start.unwrap_or(0.0);
    if !(0.0..86_400.0).contains(&start) {
        return Err((
            ErrorCode::Label,
            format!("{start} is not a time in seconds from 0"),
        ));
    }
    let blank = |c: char| if c.is_control() { ' ' } else { c };
    let text = caption.text.chars().map(blank).collect::<String>();
    Ok((
        (start * TICK_RATE as f64).round() as i64,
        text.trim().to_owned(),
    ))
}

fn fade(seconds: Option<f32>) -> Result<(), Refusal> {
    let range = 0.0..=limits::FADE_SECONDS_MAX;
    match seconds.filter(|s| !range.contains(s)) {
        Some(seconds) => Err((
            ErrorCode::Face,
            format!(
                "`fade_s` goes from 0 to {} s, not to {seconds}",
                range.end()
            ),
        )),
        None => Ok(()),
    }
}
