//! Eyeballs, the lids' hold on the skin round them.

use glam::{Quat, Vec3, vec2, vec3};

use super::polyline;
use super::shapes;
use mouthpiece_rig::{Body, Lid, Material, Mesh, Part};

/// The eyes. Centre and radius are those of the globe that the reference lids were shaped by
/// (figures of the ICT mean head); the iris is life-size.
pub(super) struct Eyes {
    pub centre: Vec3,
    pub radius: f32,
}

impl Eyes {
    /// Height of the lid loop is multiplied by this when it is walked by angle: it is long and low.
    pub(super) const SQUASH: f32 = 2.4;
    const IRIS_RADIUS: f32 = 5.8;

    pub(super) fn new() -> Self {
        Self {
            centre: vec3(31.05, 36.04, 78.9),
            radius: 15.37,
        }
    }

    /// Both eyeballs.
    pub(super) fn parts(&self) -> Vec<Part> {
        // Of an eye little is seen, and its cornea is round by the shader: finer rings would be below a pixel.
        let (columns, rows) = (28, 15);
        let iris = (Self::IRIS_RADIUS / self.radius).asin();
        let left = shapes::outward(shapes::grid(columns, rows, false, |u, v| {
            // From the pupil backwards; closer rings where the cornea bulges.
            let polar = std::f32::consts::PI * 0.62 * v.powf(1.35);
            let turn = std::f32::consts::TAU * u;
            let bulge = 1.9 * (1.0 - (polar / (iris * 1.12)).powi(2)).max(0.0).powf(0.8);
            let direction = vec3(
                polar.sin() * turn.sin(),
                polar.sin() * turn.cos(),
                polar.cos(),
            );
            self.centre + direction * (self.radius + bulge)
        }));
        let left = self.with_iris_uv(left, self.centre, iris);
        let right = self.with_iris_uv(
            shapes::mirrored(&left),
            self.centre * vec3(-1.0, 1.0, 1.0),
            iris,
        );
        let part = |name: &str, mesh: Mesh, body| Part {
            name: name.into(),
            material: Material::Eye,
            weight: vec![0.0; mesh.positions.len()],
            mesh,
            bodies: vec![body],
        };
        vec![
            part("eye_l", left, Body::EyeL),
            part("eye_r", right, Body::EyeR),
        ]
    }

    /// Sets `uv` to the direction from the centre as [`Material::Eye`] defines it.
    fn with_iris_uv(&self, mut mesh: Mesh, centre: Vec3, iris: f32) -> Mesh {
        for (uv, p) in mesh.uvs.iter_mut().zip(&mesh.positions) {
            let d = (*p - centre).normalize_or(Vec3::Z);
            let polar = d.z.clamp(-1.0, 1.0).acos();
            let across = vec2(d.x, d.y).normalize_or_zero();
            *uv = across * (polar / iris);
        }
        mesh
    }

    /// The left lids: how far each vertex near the margins turns about the eye's centre to close.
    pub(super) fn lids(&self, positions: &[Vec3], outer: &[usize], inner: &[usize]) -> Vec<Lid> {
        let margin: Vec<Vec3> = outer.iter().map(|&i| positions[i]).collect();
        let inside = |x: f32, upper: bool| -> Option<Vec3> {
            let half = margin.len() / 2;
            let mut line: Vec<Vec3> = if upper {
                margin[..half].to_vec()
            } else {
                margin[half..].to_vec()
            };
            line.sort_by(|a, b| a.x.total_cmp(&b.x));
            (line[0].x..=line[line.len() - 1].x)
                .contains(&x)
                .then(|| polyline::at_x(&line, x))
        };
        let angle = |p: Vec3| (p.y - self.centre.y).atan2(p.z - self.centre.z);
        let mut lids = Vec::new();
        for (i, &p) in positions.iter().enumerate() {
            if p.distance(self.centre) > self.radius + 9.0 || p.x < 0.0 || p.z < self.centre.z {
                continue;
            }
            let (Some(top), Some(bottom)) = (inside(p.x, true), inside(p.x, false)) else {
                continue;
            };
            // The lids meet low: the upper one does the work.
            let meeting = bottom.lerp(top, 0.18);
            let on_margin = outer.contains(&i) || inner.contains(&i);
            let upper = p.y > bottom.lerp(top, 0.5).y;
            let (edge, reach) = if upper { (top, 10.0) } else { (bottom, 6.0) };
            let away = if on_margin { 0.0 } else { (p.y - edge.y).abs() };
            let hold = 1.0 - shapes::ramp(0.0, reach, away);
            if hold > 0.01 {
                let turn = (angle(meeting) - angle(edge)) * hold;
                lids.push(Lid {
                    vertex: i as u32,
                    left: true,
                    turn,
                    hold,
                });
            }
        }
        lids
    }

    /// Lowers the upper lids to where they rest in life, on the upper rim of the iris: the surface
    /// data has them wide open.
    pub(super) fn relax(&self, positions: &mut [Vec3], lids: &mut [Lid]) {
        const SHARE: f32 = 0.08;
        for lid in lids.iter_mut().filter(|lid| lid.turn < 0.0) {
            let centre = self.centre * vec3(if lid.left { 1.0 } else { -1.0 }, 1.0, 1.0);
            let place = &mut positions[lid.vertex as usize];
            *place = centre + Quat::from_rotation_x(-lid.turn * SHARE) * (*place - centre);
            lid.turn *= 1.0 - SHARE;
        }
    }
}
