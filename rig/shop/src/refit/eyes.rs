//! Eyeballs of the new head by its lids: place and size only, as HEADSHOP 5.2 has them; lids lie outside them, and turn
//! as far as their own opening asks.

use glam::{Mat3, Vec3};
use mouthpiece_rig::{Eye, Head, Lid};

/// Lids hold their margins this firmly.
const MARGIN: f32 = 0.985;
/// Skin of the reference head within this of an eyeball keeps its distance, mm; beyond, it is free.
const NEAR_MM: f32 = 7.0;
/// No skin needs more room over the ball than this, mm.
const ROOM_MM: f32 = 0.5;
/// Size of an eyeball against the reference's: they differ by less than faces do.
const SIZE: (f32, f32) = (0.75, 1.25);
/// Weight of the guess by the lids' shape beside their distances.
const PRIOR: f32 = 0.15;
/// How much more or less than the reference's a lid may turn.
const TURN: (f32, f32) = (0.4, 2.0);

/// Places the eyes of `head` under `skin`, its new drawn skin, moves lids that are in their way, and sets how far they
/// turn. `rest` is the reference head's drawn skin.
pub(super) fn follow(reference: &Head, rest: &[Vec3], skin: &mut [Vec3], head: &mut Head) {
    for (i, (name, left)) in [("eye_l", true), ("eye_r", false)].into_iter().enumerate() {
        let lids: Vec<Lid> = reference
            .lids
            .iter()
            .filter(|l| l.left == left)
            .copied()
            .collect();
        let old = reference.eyes[i];
        let Some(eye) = place(old, &lids, rest, skin) else {
            continue;
        };
        keep_outside(old, eye, rest, skin);
        head.eyes[i] = eye;
        let scale = eye.radius / old.radius;
        for part in head.parts.iter_mut().filter(|p| p.name == name) {
            for p in &mut part.mesh.positions {
                *p = eye.centre + (*p - old.centre) * scale;
            }
        }
        let margins = [
            Margin::of(&lids, true, rest),
            Margin::of(&lids, false, rest),
        ];
        let [Some(upper), Some(lower)] = margins else {
            continue;
        };
        let turns = head.lids.iter_mut().filter(|l| l.left == left);
        for lid in turns {
            let x = rest[lid.vertex as usize].x;
            let opening = |skin: &[Vec3], eye: Eye| {
                let angle = |p: Vec3| (p.y - eye.centre.y).atan2(p.z - eye.centre.z);
                angle(upper.at(x, skin)) - angle(lower.at(x, skin))
            };
            let (now, before) = (opening(skin, eye), opening(rest, old));
            if before > 0.02 {
                lid.turn *= (now / before).clamp(TURN.0, TURN.1);
            }
        }
    }
}

/// The ball that the lids lie on as the reference's lie on theirs.
fn place(old: Eye, lids: &[Lid], rest: &[Vec3], skin: &[Vec3]) -> Option<Eye> {
    let margin: Vec<usize> = lids
        .iter()
        .filter(|l| l.hold >= MARGIN)
        .map(|l| l.vertex as usize)
        .collect();
    if margin.len() < 6 {
        return None;
    }
    let count = margin.len() as f32;
    let mean = |of: &[Vec3]| margin.iter().map(|v| of[*v]).sum::<Vec3>() / count;
    let (from, to) = (mean(rest), mean(skin));
    let spread = |of: &[Vec3], middle: Vec3| -> f32 {
        margin.iter().map(|v| of[*v].distance_squared(middle)).sum()
    };
    let scale = (spread(skin, to) / spread(rest, from).max(1e-6)).sqrt();
    let scale = scale.clamp(SIZE.0, SIZE.1);
    let guess = to + (old.centre - from) * scale;
    let radius = old.radius * scale;
    // Gauss-Newton on the margins' distances from the ball.
    let mut centre = guess;
    for _ in 0..4 {
        let (mut gram, mut slope) = (
            Mat3::from_diagonal(Vec3::splat(PRIOR * count)),
            (guess - centre) * (PRIOR * count),
        );
        for &v in &margin {
            let out = skin[v] - centre;
            let wanted = rest[v].distance(old.centre) * scale;
            let normal = out.normalize_or_zero();
            gram += Mat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z);
            slope += normal * (out.length() - wanted);
        }
        centre += gram.inverse() * slope;
    }
    centre.is_finite().then_some(Eye { centre, radius })
}

/// Moves skin out of the ball, to where it lies over the reference's.
fn keep_outside(old: Eye, eye: Eye, rest: &[Vec3], skin: &mut [Vec3]) {
    let scale = eye.radius / old.radius;
    for (rest, place) in rest.iter().zip(skin) {
        let over = rest.distance(old.centre) - old.radius;
        if over > NEAR_MM {
            continue;
        }
        let least = eye.radius + (over * scale).min(ROOM_MM);
        let out = *place - eye.centre;
        let distance = out.length();
        if distance < least && distance > 1.0 {
            *place = eye.centre + out * (least / distance);
        }
    }
}

/// The edge of a lid, in order from side to side on the reference head.
struct Margin(Vec<(f32, usize)>);

impl Margin {
    fn of(lids: &[Lid], upper: bool, rest: &[Vec3]) -> Option<Self> {
        let mut edge: Vec<(f32, usize)> = lids
            .iter()
            .filter(|l| l.hold >= MARGIN && (l.turn < 0.0) == upper)
            .map(|l| (rest[l.vertex as usize].x, l.vertex as usize))
            .collect();
        edge.sort_by(|a, b| a.0.total_cmp(&b.0));
        (edge.len() >= 2).then_some(Self(edge))
    }

    /// Where the edge that lies at `x` on the reference head is for these positions.
    fn at(&self, x: f32, positions: &[Vec3]) -> Vec3 {
        let next = self
            .0
            .partition_point(|e| e.0 < x)
            .clamp(1, self.0.len() - 1);
        let ((xa, a), (xb, b)) = (self.0[next - 1], self.0[next]);
        let share = ((x - xa) / (xb - xa).max(1e-4)).clamp(0.0, 1.0);
        positions[a].lerp(positions[b], share)
    }
}
