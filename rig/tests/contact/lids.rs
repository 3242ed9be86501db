//! Lids stay outside the eyeballs wherever these look, and cover them when closed.

use glam::{Quat, Vec3, Vec3A};
use mouthpiece_rig::{Body, Control, Controls, KeyFrame};

use super::surface::Drawn;
use super::{head, posed};

const DEEPEST_MM: f32 = 0.2;

/// Skin within this angle of straight ahead is a lid's or beside it.
const AHEAD: f32 = 0.35;

/// How far the eyeballs stick out through the lids, mm, and where.
fn stick_out(drawn: &Drawn, frame: &KeyFrame) -> (f32, Vec3) {
    let points = drawn.points(&frame.skin);
    let mut lids = vec![0.0; head().skin.mesh.positions.len()];
    for lid in &head().lids {
        lids[lid.vertex as usize] = 1.0;
    }
    let sheet = drawn.sheet(&lids);
    let poses = head().bodies(&frame.state);
    let skull = poses[Body::Skull as usize].inverse();
    let mut worst = (0.0, Vec3::ZERO);
    for (eye, (name, body)) in head()
        .eyes
        .iter()
        .zip([("eye_l", Body::EyeL), ("eye_r", Body::EyeR)])
    {
        let pose = skull * poses[body as usize];
        let ball: Vec<Vec3> = head()
            .part(name)
            .unwrap()
            .mesh
            .positions
            .iter()
            .map(|p| pose.transform_point3(*p))
            .collect();
        // How far out skin lies over each place of the ball, as far as there is any.
        let mut over = vec![f32::MIN; ball.len()];
        for t in &sheet.triangles {
            let corners = t.map(|p| points[p as usize] - eye.centre);
            if corners.iter().any(|c| c.length() > 24.0) {
                continue;
            }
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            for (p, over) in ball.iter().zip(&mut over) {
                let ray = (*p - eye.centre).normalize_or_zero();
                if ray.z < AHEAD
                    || ray.dot(corners[0]) < 8.0
                    || ray.cross(corners[0]).length() > 5.0
                {
                    continue;
                }
                let side = |a: Vec3, b: Vec3| a.cross(b).dot(ray);
                let [a, b, c] = corners;
                let (u, v, w) = (side(b, c), side(c, a), side(a, b));
                let inside = u.min(v).min(w) >= 0.0 || u.max(v).max(w) <= 0.0;
                let per = normal.dot(ray);
                if inside && per.abs() > 1e-9 {
                    *over = over.max(normal.dot(a) / per);
                }
            }
        }
        for (p, over) in ball.iter().zip(over) {
            let out = p.distance(eye.centre) - over;
            if over > 0.0 && out > worst.0 {
                worst = (out, *p);
            }
        }
    }
    worst
}

fn controls(lid: f32, yaw: f32, pitch: f32) -> Controls {
    let mut controls = Controls::default();
    for (control, value) in [
        (Control::LidL, lid),
        (Control::LidR, lid),
        (Control::GazeYaw, yaw),
        (Control::GazePitch, pitch),
    ] {
        controls[control] = value;
    }
    controls
}

#[test]
fn no_gaze_puts_an_eyeball_through_a_lid() {
    let drawn = Drawn::new(head(), 2);
    let mut most = 0.0_f32;
    for lid in [0.0, 0.5, 1.0] {
        for (yaw, pitch) in [
            (0.0, 0.0),
            (0.5, 0.0),
            (0.0, 0.4),
            (0.0, -0.5),
            (-0.5, -0.3),
            (0.4, 0.3),
        ] {
            let (out, _) = stick_out(&drawn, &posed(&controls(lid, yaw, pitch)));
            most = most.max(out);
        }
    }
    assert!(most < DEEPEST_MM, "an eyeball sticks out by {most} mm");
}

#[test]
fn lids_close_over_the_eyes_wherever_they_look() {
    let drawn = Drawn::new(head(), 1);
    for (yaw, pitch) in [(0.0, 0.0), (0.3, 0.0), (0.0, -0.3), (0.0, 0.3)] {
        let frame = posed(&controls(1.0, yaw, pitch));
        let points = drawn.points(&frame.skin);
        let gaze = Quat::from_rotation_y(yaw) * Quat::from_rotation_x(-pitch);
        for eye in &head().eyes {
            // Rays from the eyeball's centre over the pupil and the iris round it.
            for turn in 0..8 {
                let turn = std::f32::consts::TAU * turn as f32 / 8.0;
                let aside = Vec3::new(0.3 * turn.cos(), 0.3 * turn.sin(), 1.0);
                for ray in [Vec3::Z, aside] {
                    let ray = Vec3::from(gaze * Vec3A::from(ray));
                    let covered = drawn.triangles().iter().any(|t| {
                        let [a, b, c] = t.map(|p| points[p as usize] - eye.centre);
                        let side = |a: Vec3, b: Vec3| a.cross(b).dot(ray);
                        let (u, v, w) = (side(b, c), side(c, a), side(a, b));
                        a.dot(ray) > 0.0 && (u.min(v).min(w) >= 0.0 || u.max(v).max(w) <= 0.0)
                    });
                    assert!(
                        covered,
                        "gaze {yaw} {pitch}: the eye shows through its lid along {ray}"
                    );
                }
            }
        }
    }
}
