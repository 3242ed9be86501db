//! Whether a face is on the screen and moving, and if not, which part is ill.

use serde::Serialize;

use crate::live::vitals::{DeviceState, Vitals};

/// The judgement on the whole, and on each part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// A face is on the screen and moving.
    pub ok: bool,
    /// How long the process has run, seconds.
    pub uptime_s: f64,
    /// The parts that it follows from, and those that a face can do without.
    pub parts: Parts,
}

/// Each part by itself.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parts {
    /// Pictures reach the screen, and differ.
    pub window: Part,
    /// Key frames come, and differ.
    pub simulation: Part,
    /// Sound is heard, if it is wanted. A silent face lives all the same.
    pub sound: Part,
}

/// One part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// Nothing is wrong with it.
    pub ok: bool,
    /// What is wrong, or what is to be known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}

impl Part {
    fn well() -> Self {
        Self {
            ok: true,
            why: None,
        }
    }
    fn ill(why: impl Into<String>) -> Self {
        Self {
            ok: false,
            why: Some(why.into()),
        }
    }
}

/// Judges by what the threads say: a part that has said nothing for `stall_ns` is ill.
pub fn judge(vitals: &Vitals, now_ns: i64, stall_ns: i64) -> Verdict {
    let stalled_s = |last_ns: i64| {
        let since_ns = now_ns - last_ns;
        (since_ns > stall_ns).then_some(since_ns as f64 * 1e-9)
    };
    let window = match (
        vitals.window.presented_ns.get(),
        vitals.window.moved_ns.get(),
    ) {
        (Some(presented_ns), moved_ns) => {
            match (stalled_s(presented_ns), moved_ns.and_then(stalled_s)) {
                (Some(s), _) => Part::ill(format!("the screen has taken no picture for {s:.1} s")),
                (None, Some(s)) => {
                    Part::ill(format!("the face on the screen has not moved for {s:.1} s"))
                }
                (None, None) => Part::well(),
            }
        }
        (None, _) => Part::ill("no picture has been shown; the log says why"),
    };
    let simulation = match vitals.simulation.moved_ns.get() {
        None => Part::ill("the simulation has not begun"),
        Some(moved_ns) => match stalled_s(moved_ns) {
            Some(s) => Part::ill(format!("key frames have not changed for {s:.1} s")),
            None => Part::well(),
        },
    };
    let sound = match vitals.sound.device() {
        DeviceState::Playing => Part::well(),
        DeviceState::Unwanted => Part {
            ok: true,
            why: Some("no sound is wanted: a steady clock keeps time".to_owned()),
        },
        DeviceState::Missing => {
            Part::ill("there is no sound device: a steady clock keeps time until there is")
        }
    };
    Verdict {
        ok: window.ok && simulation.ok,
        uptime_s: now_ns as f64 * 1e-9,
        parts: Parts {
            window,
            simulation,
            sound,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::live::time::Origin;

    const MS: i64 = 1_000_000;
    const STALL_NS: i64 = 2000 * MS;

    fn after(vitals: &Vitals, ms: i64) -> Verdict {
        judge(vitals, ms * MS, STALL_NS)
    }

    #[test]
    fn a_face_is_well_while_new_pictures_of_a_moving_head_come() {
        let vitals = Vitals::new(Origin::new());
        assert!(!after(&vitals, 0).ok);
        vitals.simulation.moved_ns.set(990 * MS);
        vitals.window.shown(980 * MS, 1000 * MS, true, 0);
        vitals.sound.set_device(DeviceState::Missing);
        let verdict = after(&vitals, 1001);
        assert!(verdict.ok && !verdict.parts.sound.ok, "{verdict:?}");

        // No picture any more.
        let verdict = after(&vitals, 3001);
        let why = verdict.parts.window.why.unwrap();
        assert!(!verdict.ok && why.contains("no picture for 2.0 s"), "{why}");

        // Pictures, but the same face in all of them, since the simulation stands.
        vitals.window.shown(3000 * MS, 3010 * MS, false, 0);
        let verdict = after(&vitals, 3020);
        let why = verdict.parts.window.why.unwrap();
        assert!(!verdict.ok && why.contains("not moved"), "{why}");
        assert!(!verdict.parts.simulation.ok);

        // The head moves, but what is shown does not.
        vitals.simulation.moved_ns.set(3015 * MS);
        let verdict = after(&vitals, 3020);
        assert!(!verdict.ok && verdict.parts.simulation.ok);
        vitals.window.shown(3020 * MS, 3030 * MS, true, 0);
        assert!(after(&vitals, 3031).ok);
    }
}
