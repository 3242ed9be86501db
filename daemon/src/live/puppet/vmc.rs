//! VMC protocol (protocol.vmc.info, MIT licence): OSC messages for VRM avatars. We are its
//! "performer", the avatar's program is the "marionette".
//!
//! An instant is `/VMC/Ext/OK` 1, `/VMC/Ext/T` (the audible instant, seconds), the pose of the bone
//! `Head`, a `/VMC/Ext/Blend/Val` an expression, and `/VMC/Ext/Blend/Apply`. Expressions are named as
//! in VRM 1.0, as in VRM 0.x, or as ARKit's 52 shapes ("perfect sync"): whichever the avatar has; both
//! at once would open its mouth twice.
//!
//! A bone's pose is local and in Unity's frame: X to the subject's right, Y up, Z forward,
//! left-handed. A position must go with it though it is the avatar's own affair; ours is a common
//! length of the neck, and receivers that take positions should be told not to.

use mouthpiece_rig::TICK_RATE;
use rosc::{OscMessage, OscType};

use super::Moment;
use super::osc::{floats, small};
use crate::avatar::{arkit, vrm};
use crate::cli::Says;

/// From the bone `Neck` up to the bone `Head`, m.
const NECK_M: f32 = 0.1;

/// What the face does, in the names that the avatar knows.
pub(super) fn messages(moment: &Moment<'_>, says: Says) -> Vec<OscMessage> {
    let face = &moment.face;
    let time = (moment.ticks as f64 / TICK_RATE as f64) as f32;
    let mut all = vec![
        OscMessage {
            addr: "/VMC/Ext/OK".to_owned(),
            args: vec![OscType::Int(1)],
        },
        floats("/VMC/Ext/T", &[time]),
    ];
    // The mirror image along X, since Unity's X goes the other way.
    let [x, y, z, w] = face.turned().to_array();
    let mut head = floats("/VMC/Ext/Bone/Pos", &[0.0, NECK_M, 0.0, x, -y, -z, w]);
    head.args.insert(0, OscType::String("Head".to_owned()));
    all.push(head);
    match says {
        Says::Vrm1 => all.extend(vrm::names().zip(vrm::weights(face)).map(value)),
        Says::Vrm0 => all.extend(vrm::names_of_0().zip(vrm::weights(face)).map(value)),
        _ => {
            let shapes = arkit::names().map(small).zip(arkit::shapes(face));
            all.extend(shapes.map(value));
        }
    }
    all.push(floats("/VMC/Ext/Blend/Apply", &[]));
    all
}

fn value((name, weight): (impl Into<String>, f32)) -> OscMessage {
    OscMessage {
        addr: "/VMC/Ext/Blend/Val".to_owned(),
        args: vec![OscType::String(name.into()), OscType::Float(weight)],
    }
}
