//! Lips slide over the teeth and never through them.

use glam::{Affine3A, Vec3};
use mouthpiece_rig::{Control, Controls, KeyFrame, measure};

use super::surface::Drawn;
use super::{head, lip_to_teeth, posed, postures, pressed};

const DEEPEST_MM: f32 = 0.2;

/// The deepest a drawn point of the lips is in a row of teeth: by the nearest point of the row's own surface, where
/// that lies straight ahead of it or, at the edge, below or above.
fn deepest(drawn: &Drawn, frame: &KeyFrame) -> (f32, Vec3) {
    let points = drawn.points(&frame.skin);
    let jaw = head().mandible(frame.state[Control::Jaw]);
    let mut worst = (0.0, Vec3::ZERO);
    for (parts, pose, lips) in [
        (
            ["teeth_upper", "gums_upper"],
            Affine3A::IDENTITY,
            [&drawn.upper, &drawn.lower],
        ),
        (
            ["teeth_lower", "gums_lower"],
            jaw,
            [&drawn.lower, &drawn.lower],
        ),
    ] {
        let mut triangles = Vec::new();
        for name in parts {
            let mesh = &head().part(name).unwrap().mesh;
            let at = |v: u32| pose.transform_point3(mesh.positions[v as usize]);
            triangles.extend(mesh.triangles.iter().map(|t| t.map(at)));
        }
        triangles.retain(|t| t.iter().any(|p| p.x.abs() < 26.0));
        for &p in lips.iter().flat_map(|sheet| &sheet.points) {
            let p = points[p as usize];
            if p.x.abs() > 20.0 {
                continue;
            }
            // How far ahead of the point a surface still stands, and how near it is at all. What a look ahead first
            // meets from behind is a row that the point is behind of: the tongue's side, where a lip may be drawn.
            let (mut ahead, mut near) = (f32::MIN, f32::MAX);
            let mut first = (f32::MAX, 0.0);
            for t in &triangles {
                let low = t[0].min(t[1]).min(t[2]);
                let high = t[0].max(t[1]).max(t[2]);
                if (p - high).max(low - p).truncate().max_element() > 1.0 || high.z < p.z - 1.0 {
                    continue;
                }
                let [a, b, c] = *t;
                let area = (b - a).truncate().perp_dot((c - a).truncate());
                let share =
                    |q: Vec3, r: Vec3| (q - p).truncate().perp_dot((r - p).truncate()) / area;
                let (u, v, w) = (share(b, c), share(c, a), share(a, b));
                if area.abs() > 1e-9 && u.min(v).min(w) >= 0.0 {
                    let distance = a.z * u + b.z * v + c.z * w - p.z;
                    ahead = ahead.max(distance);
                    if distance > 0.0 && distance < first.0 {
                        first = (distance, area);
                    }
                }
                let shares = super::surface::nearest(p, *t);
                let at: Vec3 = t.iter().zip(shares).map(|(c, s)| *c * s).sum();
                near = near.min(at.distance(p));
            }
            let depth = ahead.min(near);
            if ahead > 0.0 && ahead < 6.0 && first.1 > 0.0 && depth > worst.0 {
                worst = (depth, p);
            }
        }
    }
    worst
}

#[test]
fn no_mouth_puts_a_lip_through_the_teeth() {
    let drawn = Drawn::new(head(), 1);
    let mut spread = Controls::default();
    spread[Control::Risorius] = 0.6;
    spread[Control::ZygomaticusMajor] = 0.6;
    let mut drawn_in = pressed();
    drawn_in[Control::ProtrusionSuperior] = -0.6;
    drawn_in[Control::ProtrusionInferior] = -0.6;
    let mut poses = vec![
        Controls::default(),
        pressed(),
        spread,
        drawn_in,
        lip_to_teeth(),
    ];
    poses.extend(postures(30));
    let mut most = 0.0_f32;
    for controls in &poses {
        let (depth, _) = deepest(&drawn, &posed(controls));
        most = most.max(depth);
    }
    assert!(
        most < DEEPEST_MM,
        "a lip is {most} mm behind the teeth's front"
    );
}

#[test]
fn the_lower_lip_reaches_the_upper_teeth() {
    let frame = posed(&lip_to_teeth());
    let got = measure(head(), &frame);
    assert!(got.lip_teeth_mm < 1.5, "{got:?}");
}
