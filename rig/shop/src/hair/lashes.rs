//! Lashes: tapering blades in fans along the lids' margins, curved away from the eye, whose tips lean together by twos
//! and threes. They hang on the skull; the renderer turns them with the lids.

use glam::{Vec3, vec2, vec3};
use mouthpiece_rig::{Body, Head, Material, Mesh, Part};

use crate::lines::{CHART_MM, Line};
use crate::noise::Dice;

/// One lid's lashes.
#[derive(Clone, Copy, Debug)]
struct Row {
    count: usize,
    length_mm: [f32; 2],
    /// Width at the root, mm.
    width_mm: f32,
    /// How steeply they leave the lid, and how they turn from there: up is positive.
    rise: [f32; 2],
    /// The shortest against the longest at the same place.
    uneven: f32,
    /// How many at most lean together, and how far of the way to one another at their tips.
    together: f32,
    gathered: f32,
    upper: bool,
}

const ROWS: [Row; 2] = [
    Row {
        count: 66,
        length_mm: [4.5, 7.8],
        width_mm: 0.36,
        rise: [-0.25, 0.95],
        uneven: 0.62,
        together: 4.0,
        gathered: 0.60,
        upper: true,
    },
    Row {
        count: 40,
        length_mm: [1.7, 3.5],
        width_mm: 0.09,
        rise: [-0.70, -0.35],
        uneven: 0.45,
        together: 3.4,
        gathered: 0.45,
        upper: false,
    },
];
/// Segments of a lash.
const STEPS: usize = 3;

/// `lashes_l` and `lashes_r`, along the features `lid_margin_l` and `_r`. `uv`: x is where the root lies over the
/// eyeball, from its centre to the subject's left in its radii; y runs from root (0) to tip (1), plus 2 on the
/// lower lid.
#[must_use]
pub fn lashes(head: &Head) -> Vec<Part> {
    ["l", "r"]
        .into_iter()
        .zip(head.eyes)
        .filter_map(|(side, eye)| {
            let line = Line::of(head, &format!("lid_margin_{side}"))?;
            let margin = on_skin(head, &line, eye.centre);
            let mut mesh = Mesh::default();
            for row in ROWS {
                grow(&mut mesh, row, &margin, eye.centre, eye.radius);
            }
            (!mesh.triangles.is_empty()).then(|| Part {
                name: format!("lashes_{side}"),
                material: Material::Lash,
                weight: vec![0.0; mesh.positions.len()],
                mesh,
                bodies: vec![Body::Skull],
            })
        })
        .collect()
}

/// The margin's places in space: of each of the line's points the nearest skin vertex near the eye.
fn on_skin(head: &Head, line: &Line, eye: Vec3) -> Vec<Vec3> {
    let mesh = &head.skin.mesh;
    let near: Vec<(glam::Vec2, Vec3)> = mesh
        .positions
        .iter()
        .zip(&mesh.uvs)
        .zip(&head.skin.wet)
        .filter(|((p, _), wet)| p.distance(eye) < 26.0 && **wet > 0.05 && **wet < 0.6)
        .map(|((p, uv), _)| (*uv * CHART_MM, *p))
        .collect();
    let mut places: Vec<Vec3> = Vec::new();
    for point in &line.points {
        let nearest = near
            .iter()
            .min_by(|a, b| a.0.distance(*point).total_cmp(&b.0.distance(*point)));
        if let Some((_, place)) = nearest
            && !places.contains(place)
        {
            places.push(*place);
        }
    }
    places
}

fn grow(mesh: &mut Mesh, row: Row, margin: &[Vec3], eye: Vec3, radius: f32) {
    // The margin's upper or lower edge, sorted across.
    let (Some(first), Some(last)) = (
        margin
            .iter()
            .copied()
            .reduce(|a, b| if b.x < a.x { b } else { a }),
        margin
            .iter()
            .copied()
            .reduce(|a, b| if b.x > a.x { b } else { a }),
    ) else {
        return;
    };
    let chord = |x: f32| {
        let share = (x - first.x) / (last.x - first.x).max(1e-3);
        first.y + (last.y - first.y) * share
    };
    let mut edge: Vec<Vec3> = margin
        .iter()
        .copied()
        .filter(|p| (p.y > chord(p.x)) == row.upper || *p == first || *p == last)
        .collect();
    edge.sort_by(|a, b| a.x.total_cmp(&b.x));
    let at = |x: f32| -> Vec3 {
        for w in edge.windows(2) {
            if x <= w[1].x {
                let share = ((x - w[0].x) / (w[1].x - w[0].x).max(1e-3)).clamp(0.0, 1.0);
                return w[0].lerp(w[1], share);
            }
        }
        last
    };
    // Towards the temple.
    let out = eye.x.signum();
    let mut dice = Dice::new(if row.upper { 301 } else { 302 });
    // Where those lean that stand together, and how many of them are still to come.
    let (mut middle, mut left) = (0.0, 0_usize);
    for i in 0..row.count {
        // None at the inner corner; longest two thirds of the way out.
        let placed = |number: f32| 0.10 + 0.88 * (number + 0.5) / row.count as f32;
        if left == 0 {
            left = 1 + (row.together * dice.roll()) as usize;
            middle = placed(i as f32 + 0.5 * (left as f32 - 1.0) + 0.5 * dice.spread());
        }
        left -= 1;
        let along = placed(i as f32 + 0.4 * dice.spread());
        let x = if out > 0.0 {
            first.x + (last.x - first.x) * along
        } else {
            last.x + (first.x - last.x) * along
        };
        let root = at(x) + vec3(0.0, if row.upper { 0.15 } else { -0.1 }, 0.15);
        let full = (std::f32::consts::PI * (0.15 + 0.75 * along)).sin();
        let [short, long] = row.length_mm;
        let uneven = row.uneven + (1.0 - row.uneven) * dice.roll();
        let length = (short + (long - short) * full) * uneven;
        let lean = (middle - along) * (last.x - first.x) * out * row.gathered;
        // Away from the eye, fanned outwards along the lid.
        let away = (root - eye).normalize_or(Vec3::Z);
        let fan = 1.5 * (along - 0.38) + 0.16 * dice.spread();
        let forward = vec3(away.x * 0.35 + fan * 0.62 * out, 0.0, 1.0).normalize_or(Vec3::Z);
        let mut place = root;
        let base = mesh.positions.len() as u32;
        for step in 0..=STEPS {
            let v = step as f32 / STEPS as f32;
            let rise = row.rise[0] + (row.rise[1] - row.rise[0]) * v;
            let heading = (forward + Vec3::Y * rise).normalize_or(Vec3::Z);
            let across = heading.cross(Vec3::Y).normalize_or(Vec3::X);
            let half = 0.5 * row.width_mm * (1.0 - 0.92 * v);
            for sign in [-1.0, 1.0] {
                mesh.positions.push(place + across * (half * sign));
                mesh.normals
                    .push(heading.cross(across).normalize_or(Vec3::Y));
                mesh.uvs.push(vec2(
                    (root.x - eye.x) / radius,
                    v + if row.upper { 0.0 } else { 2.0 },
                ));
                mesh.occlusion.push(1.0);
            }
            if step > 0 {
                let a = base + 2 * (step as u32 - 1);
                mesh.triangles.push([a, a + 2, a + 3]);
                mesh.triangles.push([a, a + 3, a + 1]);
            }
            place += (heading * length + Vec3::X * lean) / STEPS as f32;
        }
    }
}
