//! What follows the skin (HEADSHOP 5.2, steps 2 and 4): teeth and tongue by place and scale, all that is soft by the
//! warp, and what grows on the skin by the skin itself, to the last tenth of a millimetre.

use std::collections::HashMap;

use glam::{IVec3, Vec3};
use mouthpiece_rig::{Head, Material, Mesh, Part, Placement, lip_level};

/// Factors from the reference head's teeth to any head's.
const SCALE: (f32, f32) = (0.7, 1.35);
/// Front teeth: this far from the middle on the reference head, mm.
const FRONT_MM: f32 = 18.0;
/// The share of the lips' inner side that may come nearer to the teeth than on the reference head.
const NEARER: f32 = 0.1;
/// Grid in which the skin near a place is looked up, mm, and the skin that a place on it follows.
const CELL_MM: f32 = 8.0;
/// How sharply nearer skin counts more, mm.
const SHARP_MM: f32 = 0.6;

/// Moves all parts of `head` but eyes and bones, its bite and its pivots. `rest` and `skin` are the drawn skin before
/// and after; `carry` takes places of the reference head to the new one.
pub(super) fn follow(
    reference: &Head,
    rest: &[Vec3],
    skin: &[Vec3],
    carry: &impl Fn(&[Vec3]) -> Vec<Vec3>,
    head: &mut Head,
) {
    let (bite, forward) = bite(reference, rest, skin, carry);
    let pivots = carry(&[reference.condyle_axis, reference.neck_pivot]);
    // Axis and pivot are the middle's: a head that is not symmetric still turns straight.
    head.condyle_axis = pivots[0].with_x(reference.condyle_axis.x);
    head.neck_pivot = pivots[1];
    // Of a head that was fitted before, the bite is from the reference head on.
    head.bite = Placement {
        scale: bite.scale * reference.bite.scale,
        shift: bite.place(reference.bite.shift),
    };
    let missed = Missed::new(rest, skin, carry);
    for part in &mut head.parts {
        let mesh = &mut part.mesh;
        match part.material {
            Material::Teeth | Material::Gums | Material::Tongue => {
                for p in &mut mesh.positions {
                    *p = bite.place(*p);
                }
                for n in &mut mesh.normals {
                    *n = (*n / bite.scale).normalize_or(*n);
                }
            }
            Material::Cavity => {
                mesh.positions = carry(&mesh.positions);
                for p in &mut mesh.positions {
                    *p += forward;
                }
                turn_normals(mesh);
            }
            Material::Hair | Material::Lash | Material::Cloth => {
                let mut places = carry(&mesh.positions);
                for (place, from) in places.iter_mut().zip(&mesh.positions) {
                    *place += missed.near(*from);
                }
                bend_normals(mesh, &places);
                mesh.positions = places;
            }
            Material::Eye
            | Material::Bone
            | Material::Skin
            | Material::Muscle
            | Material::Spring => {}
        }
    }
}

/// Where the teeth go: by the warp of the teeth, in least squares, then to the lips, behind which they stand as on the
/// reference head. Also the latter shift alone.
fn bite(
    reference: &Head,
    rest: &[Vec3],
    skin: &[Vec3],
    carry: &impl Fn(&[Vec3]) -> Vec<Vec3>,
) -> (Placement, Vec3) {
    let from: Vec<Vec3> = reference
        .parts
        .iter()
        .filter(|p| p.material == Material::Teeth)
        .flat_map(|p| p.mesh.positions.iter().copied())
        .collect();
    let to = carry(&from);
    let count = from.len().max(1) as f32;
    let (a, b) = (
        from.iter().sum::<Vec3>() / count,
        to.iter().sum::<Vec3>() / count,
    );
    let (mut both, mut own) = (Vec3::ZERO, Vec3::splat(1e-3));
    for (p, q) in from.iter().zip(&to) {
        both += (*p - a) * (*q - b);
        own += (*p - a) * (*p - a);
    }
    let scale = (both / own).clamp(Vec3::splat(SCALE.0), Vec3::splat(SCALE.1));
    let mut bite = Placement {
        scale,
        shift: b - a * scale,
    };
    let columns = reference.lips.upper.iter().chain(&reference.lips.lower);
    let mut room: Vec<f32> = columns
        .flat_map(|c| &c[lip_level::CONTACT..])
        .map(|v| *v as usize)
        .filter(|v| rest[*v].x.abs() < FRONT_MM)
        .map(|v| skin[v].z - bite.place(rest[v]).z)
        .collect();
    room.sort_by(f32::total_cmp);
    let forward = room.get((room.len() as f32 * NEARER) as usize);
    let forward = Vec3::Z * forward.copied().unwrap_or(0.0);
    bite.shift += forward;
    (bite, forward)
}

/// What the warp misses of the skin, to be added to what grows on it.
struct Missed {
    cells: HashMap<IVec3, Vec<(Vec3, Vec3)>>,
}

impl Missed {
    fn new(rest: &[Vec3], skin: &[Vec3], carry: &impl Fn(&[Vec3]) -> Vec<Vec3>) -> Self {
        let mut cells: HashMap<IVec3, Vec<(Vec3, Vec3)>> = HashMap::new();
        for ((from, to), carried) in rest.iter().zip(skin).zip(carry(rest)) {
            let cell = cells.entry(cell(*from)).or_default();
            cell.push((*from, *to - carried));
        }
        Self { cells }
    }

    /// Of the skin near a place of the reference head, the nearest most; nothing far from all skin.
    fn near(&self, place: Vec3) -> Vec3 {
        let (mut sum, mut weight) = (Vec3::ZERO, 0.0);
        let middle = cell(place);
        for x in -1..=1 {
            for y in -1..=1 {
                for z in -1..=1 {
                    let Some(list) = self.cells.get(&(middle + IVec3::new(x, y, z))) else {
                        continue;
                    };
                    for (at, missed) in list {
                        let squared = at.distance_squared(place) + SHARP_MM * SHARP_MM;
                        let share = 1.0 / (squared * squared);
                        sum += *missed * share;
                        weight += share;
                    }
                }
            }
        }
        if weight > 0.0 {
            sum / weight
        } else {
            Vec3::ZERO
        }
    }
}

fn cell(place: Vec3) -> IVec3 {
    (place / CELL_MM).floor().as_ivec3()
}

/// Normals of a closed shape anew, on the side that they were.
fn turn_normals(mesh: &mut Mesh) {
    let fresh = mouthpiece_rig::normals(&mesh.positions, &mesh.triangles);
    for (normal, fresh) in mesh.normals.iter_mut().zip(fresh) {
        *normal = if fresh.dot(*normal) < 0.0 {
            -fresh
        } else {
            fresh
        };
    }
}

/// Normals of ribbons, which were rounded on purpose: turned as their triangles turn.
fn bend_normals(mesh: &mut Mesh, places: &[Vec3]) {
    let before = mouthpiece_rig::normals(&mesh.positions, &mesh.triangles);
    let after = mouthpiece_rig::normals(places, &mesh.triangles);
    for (normal, (before, after)) in mesh.normals.iter_mut().zip(before.into_iter().zip(after)) {
        *normal = glam::Quat::from_rotation_arc(before, after) * *normal;
    }
}

/// Gives the bones their new places, in the order of the parts.
pub(super) fn bones(head: &mut Head, places: Vec<Vec<Vec3>>) {
    let bones = head
        .parts
        .iter_mut()
        .filter(|p| p.material == Material::Bone);
    for (part, places) in bones.zip(places) {
        part.mesh.positions = places;
        part.mesh.normals = mouthpiece_rig::normals(&part.mesh.positions, &part.mesh.triangles);
    }
}

/// The meshes that muscles are built over.
pub(super) fn bone_meshes(parts: &[Part]) -> impl Iterator<Item = &Mesh> {
    let bone = |p: &&Part| p.material == Material::Bone;
    parts.iter().filter(bone).map(|p| &p.mesh)
}
