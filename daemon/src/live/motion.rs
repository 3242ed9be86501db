//! Whether the face moves: two key frames compared by a few of their values.
//!
//! A living face never stands still, so one that does is ill, whatever else works. Cheap enough for every frame.

use mouthpiece_rig::{Control, KeyFrame};

/// Vertices looked at, spread over the whole skin.
const VERTICES: usize = 32;

/// Remembers one frame.
#[derive(Debug, Default)]
pub struct Motion(u64);

impl Motion {
    /// Whether `frame` shows another face than the last one did.
    pub fn differs(&mut self, frame: &KeyFrame) -> bool {
        let seen = fingerprint(frame);
        std::mem::replace(&mut self.0, seen) != seen
    }
}

/// FNV-1a over the bits of all controls and some vertices.
fn fingerprint(frame: &KeyFrame) -> u64 {
    let stride = frame.skin.len().div_ceil(VERTICES).max(1);
    let controls = Control::ALL.iter().map(|&c| frame.state[c]);
    let skin = frame
        .skin
        .iter()
        .step_by(stride)
        .flat_map(|p| [p.x, p.y, p.z]);
    controls.chain(skin).fold(0xcbf2_9ce4_8422_2325, |hash, x| {
        (hash ^ u64::from(x.to_bits())).wrapping_mul(0x0100_0000_01b3)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn only_another_face_differs_not_another_time() {
        let mut motion = Motion::default();
        let mut frame = KeyFrame {
            skin: vec![Vec3::ONE; 1000],
            ..KeyFrame::default()
        };
        assert!(motion.differs(&frame));
        frame.time = 400;
        assert!(!motion.differs(&frame));
        frame.state[Control::Jaw] = 1e-6;
        assert!(motion.differs(&frame));
        frame.skin[0].y += 1e-6;
        assert!(motion.differs(&frame));
        assert!(!motion.differs(&frame));
    }
}
