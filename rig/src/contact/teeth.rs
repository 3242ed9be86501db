//! Lips slide over the front of both rows of teeth and their gums, which this head has as parts.
//!
//! Each row is a height field made once: how far forward it stands over height and width, gaps between neighbouring
//! teeth closed, and where its biting edge is. A point that is drawn behind the front is pushed out square
//! to it, or past the edge where that is nearer: so the lower lip of /f/ reaches the upper edge and stops there.
//! What is behind the teeth (the tongue's side) is not looked at.

use glam::{Affine3A, Vec3, Vec3A, vec3};

use super::drawn::{Drawn, Limit};
use super::field::Field;
use super::profile::BOW;
use crate::Head;
use crate::mesh::LIP_LEVELS;
use crate::mesh::lip_level::{CONTACT, CREST, INNER};
use crate::simulation::STEP_S;
use crate::tissue::Nodes;

/// Passes of pushing, and the share of its way out that a point is pushed in one: points share vertices.
const PASSES: usize = 3;
const PUSH_SHARE: f32 = 0.75;
/// Lips keep this far from the teeth, mm: the surface between points that are looked at bows less.
const CLEARANCE_MM: f32 = 0.3;
/// A lip in front of its own row leaves it ahead, unless that is so much farther than past the edge, mm.
const RATHER_AHEAD_MM: f32 = 1.5;
/// A point nearer than this by its rest is worked out as it is drawn, mm.
const NEAR_MM: f32 = 0.6;

/// Both rows, and what of the lips can touch them.
#[derive(Clone, Debug)]
pub(super) struct Teeth {
    upper: Option<Field>,
    lower: Option<Field>,
    /// The upper lip's points come first.
    points: Vec<Point>,
    upper_lip: usize,
    drawn: Drawn,
}

/// A place on a lip: the nodes that it is pushed by, twice the same for a vertex, and from their middle to where it is
/// drawn at rest.
#[derive(Clone, Copy, Debug)]
struct Point {
    nodes: [u32; 2],
    drawn: Vec3A,
}

impl Teeth {
    pub(super) fn new(head: &Head, limit: &Limit<'_>) -> Self {
        let field = |names: [&str; 2], up: f32| {
            let parts = names.into_iter().filter_map(|name| head.part(name));
            Field::new(parts.map(|p| &p.mesh), up)
        };
        let mut teeth = Self {
            upper: field(["teeth_upper", "gums_upper"], 1.0),
            lower: field(["teeth_lower", "gums_lower"], -1.0),
            points: Vec::new(),
            upper_lip: 0,
            drawn: Drawn::default(),
        };
        // Of the lower lip the red too, which reaches under the upper teeth; of the upper one what faces them.
        teeth.take(&head.lips.upper, CONTACT - 2, limit, head);
        teeth.upper_lip = teeth.points.len();
        teeth.take(&head.lips.lower, CREST + 1, limit, head);
        teeth
    }

    fn take(&mut self, columns: &[[u32; LIP_LEVELS]], from: usize, limit: &Limit<'_>, head: &Head) {
        for column in columns.iter().skip(1).take(columns.len().saturating_sub(2)) {
            for level in from..LIP_LEVELS {
                if column[level] != column[level - 1] {
                    self.push(&[(column[level], 1.0)], [column[level]; 2], limit, head);
                }
                // The inner side's levels lie far apart, and the surface bows between them.
                if (INNER..LIP_LEVELS - 1).contains(&level) {
                    let at = |i: usize| column[i.min(LIP_LEVELS - 1)];
                    let mix = [
                        (at(level - 1), -BOW),
                        (at(level), 0.5 + BOW),
                        (at(level + 1), 0.5 + BOW),
                        (at(level + 2), -BOW),
                    ];
                    self.push(&mix, [at(level), at(level + 1)], limit, head);
                }
            }
        }
    }

    fn push(&mut self, mix: &[(u32, f32)], ends: [u32; 2], limit: &Limit<'_>, head: &Head) {
        let numbering = limit.numbering();
        let (Some(a), Some(b)) = (numbering.moving(ends[0]), numbering.moving(ends[1])) else {
            return;
        };
        if self.drawn.push_mix(limit, mix) {
            let rest = &head.skin.mesh.positions;
            let at: Vec3 = mix
                .iter()
                .map(|(v, share)| limit.at(*v, rest) * *share)
                .sum();
            let middle = (rest[ends[0] as usize] + rest[ends[1] as usize]) * 0.5;
            self.points.push(Point {
                nodes: [a, b],
                drawn: (at - middle).into(),
            });
        }
    }

    pub(super) fn resolve(&self, skin: &mut Nodes, mandible: &Affine3A) {
        let (upper_lip, lower_lip) = self.points.split_at(self.upper_lip);
        let first = self.upper_lip;
        if let Some(upper) = &self.upper {
            let row = Row {
                field: upper,
                frames: None,
                rather_ahead_mm: RATHER_AHEAD_MM,
            };
            self.hold(upper_lip, 0, &row, skin);
            let row = Row {
                rather_ahead_mm: 0.0,
                ..row
            };
            self.hold(lower_lip, first, &row, skin);
        }
        if let Some(lower) = &self.lower {
            let row = Row {
                field: lower,
                frames: Some([mandible.inverse(), *mandible]),
                rather_ahead_mm: RATHER_AHEAD_MM,
            };
            self.hold(lower_lip, first, &row, skin);
        }
    }

    /// Keeps points, of which `first` come before, out of one row.
    fn hold(&self, points: &[Point], first: usize, row: &Row<'_>, skin: &mut Nodes) {
        for _ in 0..PASSES {
            let mut touched = false;
            for (i, point) in points.iter().enumerate() {
                let [a, b] = point.nodes.map(|node| node as usize);
                let middle = (skin.place[a] + skin.place[b]) * 0.5;
                let near = row.to(middle + point.drawn);
                if !row.field.may_hold(near, NEAR_MM) {
                    continue;
                }
                let at = row.to(self.drawn.at(first + i, &skin.place));
                let Some(push) = row.field.push(at, CLEARANCE_MM, row.rather_ahead_mm) else {
                    continue;
                };
                touched = true;
                let push = row.from(push) * PUSH_SHARE;
                let depth = push.length();
                let normal = push.normalize_or_zero();
                for node in &[a, b][..if a == b { 1 } else { 2 }] {
                    skin.place[*node] += push;
                    // Only the speed that brought it there goes: no rebound, and what is pressed lies still.
                    let inwards = skin.velocity[*node].dot(normal).min(0.0);
                    skin.velocity[*node] -= normal * inwards.max(-depth / STEP_S);
                }
            }
            if !touched {
                break;
            }
        }
    }
}

/// A row of teeth as it is now.
struct Row<'a> {
    field: &'a Field,
    /// From the head to where the row was at rest, and back; none of the upper row.
    frames: Option<[Affine3A; 2]>,
    rather_ahead_mm: f32,
}

impl Row<'_> {
    fn to(&self, p: Vec3A) -> Vec3A {
        self.frames.map_or(p, |[to, _]| to.transform_point3a(p))
    }

    fn from(&self, v: Vec3A) -> Vec3A {
        self.frames
            .map_or(v, |[_, from]| from.transform_vector3a(v))
    }
}

/// Height of the upper teeth's biting edge and how far forward the incisors' fronts stand, mm at rest, for
/// [`measure`](crate::measure).
const UPPER_EDGE_Y: f32 = -35.3;
const UPPER_FRONT_Z: f32 = 106.6;

/// Front of the upper incisors' biting edge at `x` on the reference head.
pub(crate) fn upper_edge(x: f32) -> Vec3 {
    vec3(x, UPPER_EDGE_Y, UPPER_FRONT_Z - 8.5 * (x / 17.0).powi(2))
}
