//! Our speech in the words of other avatars: for files (`mouthpiece curves --as …`) and, live, for
//! `--drive` (`live::puppet`), by the same code.
//!
//! | module | gives |
//! |---|---|
//! | [`face`] | what the simulated face does: what shapes and expressions are made of |
//! | [`arkit`] | ARKit's 52 blend shapes and Live Link Face's angles |
//! | [`recording`] | them as Live Link Face records them, CSV |
//! | [`vrm`] | the expressions of VRM avatars |
//! | [`visemes`] | the 15 visemes of Oculus LipSync, as weights that add up to 1, CSV |
//! | [`fap`] | MPEG-4's facial animation parameters of the mouth |
//!
//! Shapes and parameters are read off the simulated head, visemes off the labels alone: another
//! avatar brings its own lips to those, and what changes only the face has no effect on them.

pub mod arkit;
pub mod face;
mod fap;
mod recording;
mod visemes;
pub mod vrm;

use crate::cli::{AvatarArg, CurvesArgs, Fps, StateArg, Usage};
use crate::input::Utterance;
use crate::media::text::TextOutput;
use crate::pipeline::{Cast, Instants};

/// A writer of one row an instant.
trait Rows {
    /// What stands before so many rows.
    fn header(&self, rows: u64) -> String;
    /// Adds row `k` to `out`.
    fn row(&mut self, k: u64, frame: &mouthpiece_rig::KeyFrame, out: &mut String);
}

/// Writes what `instants` give, for the avatar that is asked for.
pub fn write(
    avatar: AvatarArg,
    args: &CurvesArgs,
    cast: &Cast,
    utterance: &Utterance,
    instants: impl FnOnce() -> anyhow::Result<Instants>,
) -> anyhow::Result<()> {
    let json = args.output.as_deref().and_then(|p| p.extension());
    if json.is_some_and(|e| e == "json") {
        return Err(Usage("curves --as writes text; name the output .csv or .fap".into()).into());
    }
    refuse_what_has_no_effect(avatar, args)?;
    let rate = args.rate;
    let count = rate.instants(utterance.ticks);
    let mut out = TextOutput::create(args.output.as_deref())?;
    let mut rows: Box<dyn Rows> = match avatar {
        AvatarArg::Oculus => {
            let track = cast.speech.track(&utterance.segments);
            visemes::write(track.segments(), rate, count, &mut out)?;
            return out.finish();
        }
        AvatarArg::Arkit => Box::new(recording::Table::new(&cast.head, rate)),
        AvatarArg::Fap => Box::new(fap::Table::new(&cast.head, rate)?),
    };
    let mut text = rows.header(count);
    instants()?.each(|k, instant| {
        rows.row(k, &instant.frame, &mut text);
        let wanted = out.write(&text);
        text.clear();
        wanted
    })?;
    out.finish()
}

/// Options that would silently change nothing.
fn refuse_what_has_no_effect(avatar: AvatarArg, args: &CurvesArgs) -> Result<(), Usage> {
    if avatar == AvatarArg::Fap && args.rate.den != 1 {
        let why = "--as fap: its rate is a whole number; give --rate 25, 30 or 60";
        return Err(Usage(why.into()));
    }
    if avatar != AvatarArg::Oculus {
        return Ok(());
    }
    let given = [
        ("--seed", args.seed.is_some()),
        ("--look-ahead", args.look_ahead.is_some()),
        ("--expression", args.mood.expression.is_some()),
        ("--script", args.mood.script.is_some()),
        ("--state", args.mood.state != StateArg::default()),
        ("--head", args.cast.head.is_some()),
        ("--tissue", args.cast.tissue.is_some()),
    ];
    match given.into_iter().find(|(_, given)| *given) {
        None => Ok(()),
        Some((option, _)) => Err(Usage(format!(
            "{option} has no effect with --as oculus: visemes come of the labels alone; leave it out, or take --as arkit"
        ))),
    }
}

/// When row `k` is due, as HH:MM:SS:FF.mmm: frames within the second and thousandths of a frame,
/// which differ from 0 only at rates like 30000/1001.
fn timecode(rate: Fps, k: u64) -> String {
    let (num, den) = (u64::from(rate.num), u64::from(rate.den));
    let seconds = k * den / num;
    let rest = k * den % num;
    let (frame, part) = (rest / den, rest % den * 1000 / den);
    let (hours, minutes) = (seconds / 3600, seconds / 60 % 60);
    format!(
        "{hours:02}:{minutes:02}:{:02}:{frame:02}.{part:03}",
        seconds % 60
    )
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::cli::CastArgs;
    use crate::pipeline::{Instant, Part, Performance};
    use mouthpiece_phonemes::{Phone, Segment};
    use mouthpiece_rig::{Head, KeyFrame};

    /// The built-in head in the middle of each phone's contact or vowel.
    pub fn held(phones: &[Phone]) -> (Arc<Head>, Vec<KeyFrame>) {
        let cast = Cast::load(&CastArgs::default()).unwrap();
        let frame = |phone: &Phone| {
            // A stop's contact is its closure's.
            let phone = phone.closure().unwrap_or(*phone);
            let segments = [
                Segment::new(Phone::HSharp, 0, 9600),
                Segment::new(phone, 9600, 19_200),
                Segment::new(Phone::HSharp, 19_200, 28_800),
            ];
            let part = Part::new(&cast, &segments, None);
            let mut instant = Instant::default();
            Performance::new(Arc::clone(&cast.head), part).at(14_400, &mut instant);
            instant.frame
        };
        let frames = phones.iter().map(frame).collect();
        (Arc::clone(&cast.head), frames)
    }

    #[test]
    fn a_timecode_counts_frames_within_seconds_of_real_time() {
        let whole = Fps { num: 60, den: 1 };
        assert_eq!(timecode(whole, 0), "00:00:00:00.000");
        assert_eq!(timecode(whole, 60 * 3661 + 59), "01:01:01:59.000");
        let ntsc = Fps {
            num: 30000,
            den: 1001,
        };
        assert_eq!(timecode(ntsc, 29), "00:00:00:29.000");
        // Frame 30 is due at 1.001 s: 0.02997 frames into the second.
        assert_eq!(timecode(ntsc, 30), "00:00:01:00.029");
    }
}
