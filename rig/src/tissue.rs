//! Skin as a mass-spring mesh on muscles and skull (HEADSHOP 4.2, HABER 5.3): which springs there are.
//!
//! Edges of the skin mesh are springs; every vertex has springs to the bone under it (skull or
//! mandible, by a share), those near a muscle have springs to its fibres, those at the lids to the
//! lids. All vertices have the same mass: on a graded mesh, masses by area would force a step
//! several times shorter. Stiffness is therefore given per unit of mass, in 1/s². Volume
//! preservation and a biphasic stiffness are not here yet.

use glam::Vec3;

use crate::mesh::LIP_LEVELS;
use crate::mesh::lip_level::CONTACT;
use crate::mesh::ramp;
use crate::muscle::Contraction;
use crate::{Head, Muscle};

/// Stiffness per mass of a skin edge.
pub(crate) const EDGE: f32 = 34_000.0;
/// Of the spring to the bone where the skin lies thin on it, and where it lies on soft tissue.
const BONE_THIN: f32 = 60_000.0;
const BONE_SOFT: f32 = 1_500.0;
/// What is left of that stiffness where the forehead's skin slides over the bone.
const FOREHEAD: f32 = 0.12;
/// Of a spring to a muscle fibre right beside the vertex.
const FIBRE: f32 = 26_000.0;
/// Of a lid's hold on its margin.
const LID: f32 = 150_000.0;
/// A fibre holds vertices within this distance, mm; one of the thin sheets within the other.
const FIBRE_REACH_MM: f32 = 13.0;
const SHEET_REACH_MM: f32 = 19.0;
/// A vertex is held by at most this many fibres of each muscle's side.
const FIBRES_MAX: usize = 6;

/// A spring to a place on a fibre: between control points `point` and `point + 1`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Attachment {
    pub vertex: u32,
    pub fibre: u32,
    pub point: u32,
    pub share: f32,
    pub stiffness: f32,
}

/// A spring along an edge of the skin, seen from its end of the lower number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    pub other: u32,
    pub rest_mm: f32,
}

/// The springs of a head. Vertices are renumbered so that those that move come first, in an order
/// that keeps neighbours close.
#[derive(Clone, Debug)]
pub(crate) struct Tissue {
    /// Skin vertex of each simulated one.
    pub vertices: Vec<u32>,
    /// Simulated vertex of each skin vertex; `u32::MAX` where it is none.
    number: Vec<u32>,
    /// How many of them move; the rest is the fixed rim that edges end at.
    pub movable: usize,
    /// The edges of each movable vertex to those after it, one vertex after the other.
    pub edges: Vec<Edge>,
    /// Where each movable vertex's edges start among them, and where the last one's end.
    pub starts: Vec<u32>,
    /// Per movable vertex: stiffness to the bone, skull and mandible together.
    pub bone: Vec<f32>,
    /// Vertices that the mandible takes along, with its share of that stiffness.
    pub jawed: Vec<(u32, f32)>,
    /// By fibre, and where each fibre's start among them.
    pub attachments: Vec<Attachment>,
    pub fibres: Vec<u32>,
    /// `(simulated vertex, index into Head::lids, stiffness)`.
    pub lids: Vec<(u32, u32, f32)>,
}

/// Where on a lip or beside it a vertex lies: above the slit, below it, or neither.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Upper,
    Lower,
    Neither,
}

impl Tissue {
    pub(crate) fn new(head: &Head) -> Self {
        let rest = &head.skin.mesh.positions;
        let reference = &head.skin.reference;
        let movable_skin: Vec<bool> = reference.iter().map(|p| moves(*p)).collect();
        let mut neighbours = vec![Vec::new(); rest.len()];
        for t in &head.skin.mesh.triangles {
            for i in 0..3 {
                let (a, b) = (t[i], t[(i + 1) % 3]);
                neighbours[a as usize].push(b);
                neighbours[b as usize].push(a);
            }
        }
        for list in &mut neighbours {
            list.sort_unstable();
            list.dedup();
        }

        let mut vertices: Vec<u32> = (0..rest.len() as u32)
            .filter(|&i| movable_skin[i as usize])
            .collect();
        vertices.sort_by_key(|&i| morton(rest[i as usize]));
        let movable = vertices.len();
        let mut number = vec![u32::MAX; rest.len()];
        for (new, &old) in vertices.iter().enumerate() {
            number[old as usize] = new as u32;
        }
        let (mut edges, mut starts) = (Vec::new(), vec![0]);
        for i in 0..movable {
            let old = vertices[i];
            for &other in &neighbours[old as usize] {
                if number[other as usize] == u32::MAX {
                    number[other as usize] = vertices.len() as u32;
                    vertices.push(other);
                }
                let j = number[other as usize];
                if j > i as u32 {
                    let rest_mm = rest[old as usize].distance(rest[other as usize]);
                    edges.push(Edge { other: j, rest_mm });
                }
            }
            starts.push(edges.len() as u32);
        }

        let sides = sides(head);
        // Springs to bone by what lies under that place of the reference head.
        let at = |i: usize| reference[vertices[i] as usize];
        let mut lid_hold = vec![0.0_f32; rest.len()];
        for lid in &head.lids {
            lid_hold[lid.vertex as usize] = lid.hold;
        }
        let mut attachments: Vec<Attachment> = (0..movable)
            .flat_map(|i| {
                let vertex = vertices[i] as usize;
                attach(head, i, rest[vertex], sides[vertex], lid_hold[vertex])
            })
            .collect();
        attachments.sort_by_key(|a| a.fibre);
        let fibres = (0..=head.fibres.len() as u32)
            .map(|k| attachments.partition_point(|a| a.fibre < k) as u32)
            .collect();
        let lids = head
            .lids
            .iter()
            .enumerate()
            .filter(|(_, lid)| (number[lid.vertex as usize] as usize) < movable)
            .map(|(k, lid)| {
                (
                    number[lid.vertex as usize],
                    k as u32,
                    LID * lid.hold * lid.hold,
                )
            })
            .collect();
        let bone: Vec<f32> = (0..movable)
            .map(|i| bone_stiffness(at(i), sides[vertices[i] as usize]))
            .collect();
        let jawed = (0..movable)
            .map(|i| {
                (
                    i as u32,
                    bone[i] * mandible_share(at(i), sides[vertices[i] as usize]),
                )
            })
            .filter(|(_, stiffness)| *stiffness > 0.0)
            .collect();
        Self {
            bone,
            jawed,
            vertices,
            number,
            movable,
            edges,
            starts,
            attachments,
            fibres,
            lids,
        }
    }

    /// The simulated vertex of a skin vertex, where that one moves.
    pub(crate) fn moving(&self, skin_vertex: u32) -> Option<u32> {
        let number = self.number[skin_vertex as usize];
        ((number as usize) < self.movable).then_some(number)
    }

    /// Springs of all kinds.
    pub(crate) fn spring_count(&self) -> usize {
        self.edges.len() + self.movable + self.attachments.len() + self.lids.len()
    }
}

/// Whether the skin there moves at all: the face from the hairline to the throat, back to the ears.
fn moves(p: Vec3) -> bool {
    let ahead = p.z > 8.0 + 0.35 * (p.y + 30.0).abs().min(60.0);
    let side = if p.y > 60.0 { 66.0 } else { 75.0 };
    ahead && (-98.0..110.0).contains(&p.y) && p.x.abs() < side
}

/// Interleaves the bits of a place on a 4 mm grid, so that neighbours lie close in memory.
fn morton(p: Vec3) -> u64 {
    let cell = ((p + 256.0) / 4.0).max(Vec3::ZERO);
    let spread =
        |v: f32| (0..10).fold(0_u64, |sum, bit| sum | ((v as u64 >> bit & 1) << (3 * bit)));
    spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2
}

/// Which lip a skin vertex belongs to; off the lips' columns, by the height of the slit there.
fn sides(head: &Head) -> Vec<Side> {
    let rest = &head.skin.reference;
    let corner = head
        .lips
        .upper
        .last()
        .map_or(Vec3::ZERO, |c| rest[c[CONTACT] as usize]);
    let mut sides: Vec<Side> = rest
        .iter()
        .map(|p| match (p.x.abs() < corner.x, p.y > slit_height(p.x)) {
            (false, _) => Side::Neither,
            (true, true) => Side::Upper,
            (true, false) => Side::Lower,
        })
        .collect();
    for (columns, side) in [
        (&head.lips.upper, Side::Upper),
        (&head.lips.lower, Side::Lower),
    ] {
        for column in columns.iter().skip(1).take(columns.len().saturating_sub(2)) {
            for level in 0..LIP_LEVELS {
                sides[column[level] as usize] = side;
            }
        }
    }
    sides
}

/// Height of the line between upper and lower face: the slit, then from the corner up to the ear.
fn slit_height(x: f32) -> f32 {
    -34.0 - 1.0 * (x.abs() / 24.0).min(1.0) + (x.abs() - 26.0).max(0.0) * 0.55
}

/// How much of the mandible's motion the bone under a vertex takes part in.
fn mandible_share(p: Vec3, side: Side) -> f32 {
    // Between the lips a step, beyond the corner a ramp that widens backwards over the cheek.
    let beyond = (p.x.abs() - 24.0).max(0.0);
    let half = 1.5 + 0.8 * beyond;
    let share = ramp(-half, half, slit_height(p.x) - p.y);
    let share = match side {
        Side::Upper => share.min(0.5) * (p.x.abs() / 24.0).powi(4).min(1.0),
        Side::Lower => 1.0 - (1.0 - share.max(0.5)) * (p.x.abs() / 24.0).powi(4).min(1.0),
        Side::Neither => share,
    };
    // Down the throat and back towards the ear the skin leaves the jaw again.
    let throat = ramp(-96.0, -70.0, p.y) * ramp(14.0, 66.0, p.z);
    share * throat
}

/// Stiff on forehead, nose and cheek bones, soft on cheeks and lips.
fn bone_stiffness(p: Vec3, side: Side) -> f32 {
    let from_mouth = ((p.x / 1.25).powi(2) + (p.y + 36.0).powi(2)).sqrt();
    let near_mouth = 1.0 - ((from_mouth - 22.0) / 34.0).clamp(0.0, 1.0);
    let nose = (1.0 - (p.x.abs() - 9.0).max(0.0) / 10.0).clamp(0.0, 1.0)
        * ((p.y + 16.0) / 14.0).clamp(0.0, 1.0)
        * (1.0 - 0.8 * ramp(38.0, 54.0, p.y));
    // The scalp is fast to the bone at the hairline and on the temples; over the forehead and the
    // brows it slides.
    let brow = ramp(80.0, 106.0, p.y + 0.3 * (p.x.abs() - 30.0).max(0.0));
    let slides = ramp(40.0, 50.0, p.y) * ramp(62.0, 50.0, p.x.abs()) * (1.0 - brow);
    let chin =
        (1.0 - (p.x.abs() / 30.0).powi(2)).clamp(0.0, 1.0) * ((-p.y - 52.0) / 10.0).clamp(0.0, 1.0);
    let thin = (nose.max(brow) + 0.35 * chin).min(1.0);
    let far = (1.0 - near_mouth).powi(2) * 0.22;
    // Under the jaw the skin hangs free between jaw and throat.
    let free = ramp(-52.0, -66.0, p.y - 0.35 * (p.z - 90.0).min(0.0))
        * ramp(20.0, 45.0, p.z)
        * (1.0 - chin);
    let lip = if side == Side::Neither { 1.0 } else { 0.75 };
    let held = thin.max(far) * (1.0 - 0.85 * free);
    (BONE_SOFT * lip) + (BONE_THIN - BONE_SOFT) * held * (1.0 - (1.0 - FOREHEAD) * slides)
}

/// The springs of one vertex to the fibres near it.
fn attach(head: &Head, vertex: usize, p: Vec3, side: Side, lid: f32) -> Vec<Attachment> {
    let mut found: Vec<(f32, Attachment)> = Vec::new();
    for (f, fibre) in head.fibres.iter().enumerate() {
        let other_lip = match fibre.muscle {
            Muscle::OrbicularisOrisSuperior | Muscle::LevatorLabiiSuperioris => Side::Lower,
            Muscle::OrbicularisOrisInferior
            | Muscle::DepressorLabiiInferioris
            | Muscle::Mentalis => Side::Upper,
            _ => Side::Neither,
        };
        if side == other_lip && side != Side::Neither {
            continue;
        }
        let (mut best, mut place) = (f32::MAX, (0, 0.0));
        for (j, w) in fibre.points.windows(2).enumerate() {
            let d = w[1] - w[0];
            let share = ((p - w[0]).dot(d) / d.length_squared().max(1e-6)).clamp(0.0, 1.0);
            let distance = p.distance(w[0] + d * share);
            if distance < best {
                (best, place) = (distance, (j, share));
            }
        }
        let sheet = matches!(
            fibre.muscle,
            Muscle::FrontalisInner | Muscle::FrontalisOuter | Muscle::Masseter | Muscle::Temporalis
        );
        let reach = if sheet {
            SHEET_REACH_MM
        } else {
            FIBRE_REACH_MM
        };
        if best >= reach {
            continue;
        }
        let near = 1.0 - best / reach;
        // At its origin a linear muscle lies on bone and holds no skin.
        let along = (place.0 as f32 + place.1) / (fibre.points.len() - 1) as f32;
        let (hold, weight) = match fibre.contraction {
            // A sheet draws all the skin over it along.
            Contraction::Linear if sheet => (along.sqrt(), 0.6),
            // Those of the frown are short and end in the skin itself.
            Contraction::Linear if frowns(fibre.muscle) => (along.powi(2), 1.2),
            // What raises the corner of the mouth takes the cheek along.
            Contraction::Linear if carries_cheek(fibre.muscle) => (along.powi(2), 0.6),
            Contraction::Linear => (along.powi(3), 0.6),
            Contraction::Sphincter { .. } => (1.0, 1.0),
            Contraction::Belly { .. } => ((std::f32::consts::PI * along).sin(), 0.6),
        };
        let least = if fibre.muscle as usize >= Muscle::FrontalisInner as usize {
            0.015
        } else {
            0.004
        };
        // What a lid carries is the lid's: the muscles of the brow end over it.
        let hold = if fibre.muscle as usize >= Muscle::FrontalisInner as usize {
            hold * (1.0 - lid).powi(2)
        } else {
            hold
        };
        let stiffness = FIBRE * weight * hold * near * near;
        if stiffness > least * FIBRE {
            found.push((
                stiffness,
                Attachment {
                    vertex: vertex as u32,
                    fibre: f as u32,
                    point: place.0 as u32,
                    share: place.1,
                    stiffness,
                },
            ));
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.truncate(FIBRES_MAX);
    found.into_iter().map(|(_, a)| a).collect()
}

/// Whether a muscle lies in the fat of the cheek and lifts it.
const fn carries_cheek(muscle: Muscle) -> bool {
    matches!(
        muscle,
        Muscle::ZygomaticusMajor | Muscle::ZygomaticusMinor | Muscle::LevatorAnguliOris
    )
}

/// Whether a muscle ends in the skin of the brow and draws it together or down.
const fn frowns(muscle: Muscle) -> bool {
    matches!(
        muscle,
        Muscle::CorrugatorSupercilii | Muscle::Procerus | Muscle::DepressorSupercilii
    )
}
