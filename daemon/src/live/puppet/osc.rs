//! Plain OSC 1.0 over UDP, for programs that have no avatar protocol: TouchDesigner, Max, a script.
//!
//! | address | holds |
//! |---|---|
//! | `/mouthpiece/time` | the audible instant, seconds, a double |
//! | `/mouthpiece/arkit/NAME` | one of ARKit's 52 shapes by ARKit's own name (`jawOpen`), 0 to 1 |
//! | `/mouthpiece/mouth` | gap between the lips, width, protrusion, mm; jaw, radians |
//! | `/mouthpiece/head` | yaw to the subject's left, pitch up, roll to the left shoulder, radians |
//! | `/mouthpiece/eyes` | yaw to the subject's left, pitch up, radians |
//!
//! Numbers are floats unless said otherwise. An instant is more than one packet takes, so it comes as a few
//! bundles that are due at once; time is in the first.

use mouthpiece_rig::Control;
use rosc::{OscBundle, OscMessage, OscPacket, OscTime, OscType, encoder};

use super::Moment;
use crate::avatar::arkit;
use crate::live::time::seconds;

/// Messages in one bundle: at 60 bytes each, names included, it fits into one frame of Ethernet, which
/// the VMC protocol asks for, too.
const MESSAGES_MAX: usize = 20;
/// OSC's word for a bundle that is due when it comes.
const AT_ONCE: OscTime = OscTime {
    seconds: 0,
    fractional: 1,
};

/// Bundles `messages`, in order.
pub(super) fn pack(messages: Vec<OscMessage>, packets: &mut Vec<Vec<u8>>) {
    let mut messages = messages.into_iter().map(OscPacket::Message).peekable();
    while messages.peek().is_some() {
        let bundle = OscPacket::Bundle(OscBundle {
            timetag: AT_ONCE,
            content: messages.by_ref().take(MESSAGES_MAX).collect(),
        });
        match encoder::encode(&bundle) {
            Ok(bytes) => packets.push(bytes),
            Err(error) => tracing::debug!(%error, "a message that cannot be written"),
        }
    }
}

/// A message with numbers.
pub(super) fn floats(address: impl Into<String>, values: &[f32]) -> OscMessage {
    OscMessage {
        addr: address.into(),
        args: values.iter().map(|v| OscType::Float(*v)).collect(),
    }
}

/// ARKit's own name of a shape: Live Link Face's with a small letter.
pub(super) fn small(name: &str) -> String {
    let mut name = name.to_owned();
    if let Some(first) = name.get_mut(..1) {
        first.make_ascii_lowercase();
    }
    name
}

/// What the face does.
pub(super) fn messages(moment: &Moment<'_>) -> Vec<OscMessage> {
    let (is, mouth) = (moment.face.is, &moment.face.mouth);
    let mut all = vec![
        OscMessage {
            addr: "/mouthpiece/time".to_owned(),
            args: vec![OscType::Double(seconds(moment.ticks))],
        },
        floats(
            "/mouthpiece/mouth",
            &[
                moment.face.gap_mm(),
                mouth.width_mm,
                mouth.protrusion_mm,
                mouth.jaw_rad,
            ],
        ),
        floats(
            "/mouthpiece/head",
            &[Control::HeadYaw, Control::HeadPitch, Control::HeadRoll].map(|c| is[c]),
        ),
        floats(
            "/mouthpiece/eyes",
            &[Control::GazeYaw, Control::GazePitch].map(|c| is[c]),
        ),
    ];
    let shapes = arkit::names().zip(arkit::shapes(&moment.face));
    all.extend(
        shapes.map(|(name, value)| floats(format!("/mouthpiece/arkit/{}", small(name)), &[value])),
    );
    all
}
