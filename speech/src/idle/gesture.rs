//! What a face does besides the mouth while it says something: nods and brow raises on stressed syllables,
//! blinks where phrases end, a breath before they begin, swallowing in long pauses.
//!
//! A function of the seed and of what the [`Track`] knows of its utterance; ticks are the utterance's own,
//! so that it looks the same wherever on a timeline it is spoken. Lips that must touch stay together:
//! what opens the mouth here ends where a contact begins.

use mouthpiece_rig::{Control, Controls};

use super::breath::bump;
use super::ms;
use super::noise::{Noise, Purpose};
use super::{blink, swallow};
use crate::prosody::Accent;
use crate::track::Track;

/// A nod goes down and up within this; its lowest point is on the syllable (judgement: the task of a nod is
/// a beat; 300 ms).
const NOD: i64 = ms(320);
/// Depth of a nod on the least and the most prominent syllable, degrees.
const NOD_DEGREES: (f32, f32) = (1.6, 3.2);
/// Share of accents with a nod: from the least to the most prominent (judgement).
const NODS: (f32, f32) = (0.35, 0.75);

/// A brow goes up and comes down within this.
const BROW: i64 = ms(440);
/// Contraction of the frontalis on the least and most prominent syllable (judgement).
const BROW_SIZE: (f32, f32) = (0.16, 0.4);
/// Share of accents to which pitch rises that have a brow raise (judgement).
const BROWS: f32 = 0.4;
/// Of fast rises of the brows this share goes with a rise of pitch (Cave, Guaitella et al., 10 speakers).
const BROWS_WITH_PITCH: f32 = 0.71;
/// The others stand this long behind an accent.
const BROW_ASIDE: (i64, i64) = (ms(450), ms(900));

/// Share of phrases that end with a blink, beside those that come anyway: at 15 phrases a minute that makes
/// 26 of 17 (Bentivoglio et al. 1997: conversation against rest).
const BLINKS: f32 = 0.6;
/// When it begins after the last sound.
const BLINK_AFTER: (i64, i64) = (ms(-60), ms(220));

/// A breath is drawn for at most this long before a phrase, and ends so long before its first sound, or the
/// lips could not be where they must.
const INTAKE: i64 = ms(520);
const INTAKE_ENDS: i64 = ms(130);
/// Pauses shorter than this leave no time for one.
const INTAKE_PAUSE: i64 = ms(380);
/// How far the jaw goes down for it, radians: 2 mm at the incisors (judgement).
const INTAKE_JAW: f32 = 0.026;

/// Pauses from this length on may hold a swallow.
const SWALLOW_PAUSE: i64 = ms(1600);
const SWALLOWS: f32 = 0.5;

/// How far any of these reaches from what causes it.
pub(super) const REACH: i64 = BROW_ASIDE.1 + BROW;

/// Adds to `controls` what goes with `track` at `ticks`, `share` of it.
pub(super) fn add(noise: &Noise, track: &Track, ticks: i64, share: f32, controls: &mut Controls) {
    let mut lid = 0.0_f32;
    for accent in track.accents_near(ticks, REACH) {
        let (nod, brow) = on(noise, &accent, ticks);
        controls[Control::HeadPitch] -= nod * share;
        // The eyes stay on the viewer.
        controls[Control::GazePitch] += nod * share;
        for (control, part) in [
            (Control::FrontalisInner, 1.0),
            (Control::FrontalisOuter, 0.8),
        ] {
            controls[control] += brow * part * share;
        }
    }
    for pause in track.pauses_near(ticks, INTAKE + INTAKE_ENDS + REACH) {
        let number = pause.0 / ms(10);
        if pause.0 > i64::MIN && noise.uniform(Purpose::PhraseBlink, number) < BLINKS {
            let after = between(
                BLINK_AFTER,
                noise.uniform(Purpose::PhraseBlinkOnset, number),
            );
            lid = lid.max(blink::closing(
                ticks.saturating_sub(pause.0.saturating_add(after)),
            ));
        }
        breathe(track, pause, ticks, share, controls);
        let length = pause.1.saturating_sub(pause.0);
        if pause.0 > i64::MIN
            && length >= SWALLOW_PAUSE
            && noise.uniform(Purpose::PauseSwallow, number) < SWALLOWS
        {
            let since = ticks.saturating_sub(pause.0.saturating_add(ms(500)));
            swallow::add(since, share, controls);
        }
    }
    super::lower_lids(lid * share, controls);
}

/// Nod, radians, and brows' contraction at `ticks`, that an accent brings.
fn on(noise: &Noise, accent: &Accent, ticks: i64) -> (f32, f32) {
    let number = accent.at / ms(10);
    let since = ticks.saturating_sub(accent.at);
    let size = accent.size.clamp(0.0, 1.0);
    let nods = noise.uniform(Purpose::Nod, number) < mix(NODS, size);
    let nod = if nods {
        mix(NOD_DEGREES, size).to_radians()
            * bump(since.saturating_add(NOD / 2) as f32 / NOD as f32)
    } else {
        0.0
    };
    if !accent.rises {
        return (nod, 0.0);
    }
    let chance = noise.uniform(Purpose::Brow, number);
    let aside = BROWS * (1.0 - BROWS_WITH_PITCH) / BROWS_WITH_PITCH;
    let onset = if chance < BROWS {
        // Highest shortly before the syllable's loudest moment.
        -BROW / 2 - ms(30)
    } else if chance < BROWS + aside {
        between(BROW_ASIDE, noise.uniform(Purpose::BrowOnset, number))
    } else {
        return (nod, 0.0);
    };
    let share = since.saturating_sub(onset) as f32 / BROW as f32;
    // Up faster than down.
    (
        nod,
        mix(BROW_SIZE, size) * bump(share.clamp(0.0, 1.0).powf(0.8)),
    )
}

/// The breath at the end of a pause: the lips part, the head rises with the chest and sinks again.
fn breathe(track: &Track, pause: (i64, i64), ticks: i64, share: f32, controls: &mut Controls) {
    let length = pause.1.saturating_sub(pause.0);
    if pause.1 == i64::MAX || length < INTAKE_PAUSE {
        return;
    }
    let end = pause.1.saturating_sub(INTAKE_ENDS);
    let span = INTAKE.min(length - INTAKE_ENDS - ms(60));
    let since = ticks.saturating_sub(end.saturating_sub(span));
    let drawn = bump(since as f32 / span as f32);
    if drawn > 0.0 {
        let free = 1.0 - track.contact_at(ticks);
        controls[Control::Jaw] += INTAKE_JAW * drawn * share * free;
        controls[Control::DilatorNaris] += 0.2 * drawn * share;
    }
    let up = crate::contact::ease(since as f32 / span as f32);
    let down = crate::contact::ease(since.saturating_sub(span) as f32 / ms(800) as f32);
    controls[Control::HeadPitch] += (up - down) * share * 0.7_f32.to_radians();
}

fn mix(range: (f32, f32), share: f32) -> f32 {
    range.0 + (range.1 - range.0) * share
}

fn between(range: (i64, i64), share: f32) -> i64 {
    range.0 + ((range.1 - range.0) as f32 * share) as i64
}
