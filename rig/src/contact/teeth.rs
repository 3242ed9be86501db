//! Lips slide over the front of both rows of teeth and their gums, which this head has as parts.
//!
//! Each row is a height field made once: how far forward it stands over height and width, gaps between neighbouring
//! teeth closed, and where its biting edge is. A point that is drawn behind the front is pushed out square
//! to it, or past the edge where that is nearer: so the lower lip of /f/ reaches the upper edge and stops there.
//! What is behind the teeth (the tongue's side) is not looked at.

use glam::{Affine3A, Vec3, Vec3A, vec3};

use super::drawn::{Drawn, Limit};
use super::field::Field;
use super::four::{FOUR, Four, List, Places, bits};
use super::profile::BOW;
use crate::Head;
use crate::mesh::LIP_LEVELS;
use crate::mesh::lip_level::{CONTACT, CREST, INNER};
use crate::tissue::Nodes;

/// Passes of pushing, and the share of its way out that a point is pushed in one: points share vertices.
const PASSES: usize = 3;
const PUSH_SHARE: f32 = 0.75;
/// What was no deeper than this, mm, is not looked at again in the same step.
const DONE_MM: f32 = 0.02;
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
    upper_lip: Points,
    lower_lip: Points,
    /// Points that are near each row, then those that the pass before was not done with.
    near: [List; 2],
}

/// Places on a lip: those of vertices, then those between two of them.
#[derive(Clone, Debug, Default)]
struct Points {
    /// Of vertices.
    fours: Vec<Four>,
    /// Per vertex: the points between it and the levels before and after it.
    beside: Vec<[Option<u32>; 2]>,
    /// A row a point.
    drawn: Drawn,
    /// The nodes that a point is pushed by: twice its own one, or those that it lies between.
    nodes: Vec<[u32; 2]>,
}

impl Teeth {
    pub(super) fn new(head: &Head, limit: &Limit<'_>) -> Self {
        let field = |names: [&str; 2], up: f32| {
            let parts = names.into_iter().filter_map(|name| head.part(name));
            Field::new(parts.map(|p| &p.mesh), up, NEAR_MM)
        };
        // Of the lower lip the red too, which reaches under the upper teeth; of the upper one what faces them.
        let upper_lip = Points::new(&head.lips.upper, CONTACT - 2, limit, head);
        let lower_lip = Points::new(&head.lips.lower, CREST + 1, limit, head);
        let most = upper_lip.drawn.rows().max(lower_lip.drawn.rows());
        Self {
            upper: field(["teeth_upper", "gums_upper"], 1.0),
            lower: field(["teeth_lower", "gums_lower"], -1.0),
            upper_lip,
            lower_lip,
            near: std::array::from_fn(|_| List::with_room(most)),
        }
    }

    pub(super) fn resolve(&mut self, skin: &mut Nodes, mandible: &Affine3A, step_s: f32) {
        let upper = self.upper.as_ref().map(|field| Row {
            field,
            frames: None,
            rather_ahead_mm: RATHER_AHEAD_MM,
            per_step: step_s.recip(),
        });
        let lower = self.lower.as_ref().map(|field| Row {
            field,
            frames: Some([mandible.inverse(), *mandible]),
            rather_ahead_mm: RATHER_AHEAD_MM,
            per_step: step_s.recip(),
        });
        self.upper_lip.hold([upper, None], &mut self.near, skin);
        let upper = upper.map(|row| Row {
            rather_ahead_mm: 0.0,
            ..row
        });
        self.lower_lip.hold([upper, lower], &mut self.near, skin);
    }
}

impl Points {
    fn new(columns: &[[u32; LIP_LEVELS]], from: usize, limit: &Limit<'_>, head: &Head) -> Self {
        let (rest, numbering) = (&head.skin.mesh.positions, limit.numbering());
        let (mut points, mut all) = (Vec::new(), Self::default());
        // Where a level's vertex is among the points.
        let mut found = Vec::new();
        let inner = columns.get(1..columns.len().saturating_sub(1));
        let inner = inner.unwrap_or_default();
        for column in inner {
            let mut own = [None; LIP_LEVELS];
            for level in from..LIP_LEVELS {
                let vertex = column[level];
                if vertex == column[level - 1] {
                    own[level] = own[level - 1];
                } else if let Some(node) = numbering.moving(vertex) {
                    own[level] = Some(points.len());
                    points.push((node, limit.at(vertex, rest) - rest[vertex as usize]));
                    all.nodes.push([node; 2]);
                    all.drawn.push(limit, vertex, node);
                }
            }
            found.push(own);
        }
        all.beside = vec![[None; 2]; points.len()];
        // The inner side's levels lie far apart, and the surface bows between them.
        for (column, own) in inner.iter().zip(found) {
            for level in INNER..LIP_LEVELS - 1 {
                let (Some(a), Some(b)) = (own[level], own[level + 1]) else {
                    continue;
                };
                let at = |i: usize| column[i.min(LIP_LEVELS - 1)];
                let mix = [
                    (at(level - 1), -BOW),
                    (at(level), 0.5 + BOW),
                    (at(level + 1), 0.5 + BOW),
                    (at(level + 2), -BOW),
                ];
                if a != b && all.drawn.push_mix(limit, &mix) {
                    let between = Some(all.nodes.len() as u32);
                    all.nodes.push([points[a].0, points[b].0]);
                    (all.beside[a][1], all.beside[b][0]) = (between, between);
                }
            }
        }
        all.fours = Four::all(&points);
        all
    }

    /// Keeps the points out of two rows of teeth, one after the other.
    fn hold(&self, rows: [Option<Row<'_>>; 2], near: &mut [List; 2], skin: &mut Nodes) {
        near.iter_mut().for_each(List::clear);
        for (i, four) in self.fours.iter().enumerate() {
            let at = four.at(&skin.place);
            for (row, near) in rows.iter().zip(&mut *near) {
                if let Some(row) = row {
                    for lane in bits(row.near(&at) & four.some) {
                        near.push(i * FOUR + lane);
                    }
                }
            }
        }
        for (row, near) in rows.iter().zip(near) {
            if let Some(row) = row {
                self.add_between(near);
                // What is free is not pushed in by what is pushed out beside it.
                for _ in 0..PASSES {
                    near.keep(|points, some| self.push(points, some, row, skin));
                }
            }
        }
    }

    /// Adds what lies beside a vertex that is near, each once: the list is in order, and of two neighbours the second
    /// finds that the first was there.
    fn add_between(&self, near: &mut List) {
        let mut last = None;
        for i in 0..near.points().len() {
            let [before, after] = self.beside[near.points()[i] as usize];
            if before != last
                && let Some(before) = before
            {
                near.push(before as usize);
            }
            if let Some(after) = after {
                near.push(after as usize);
            }
            last = after;
        }
    }

    /// Pushes points out of a row of teeth, each for itself; bits of those that were so deep that they are to be
    /// looked at again.
    #[inline]
    fn push(&self, points: [usize; FOUR], some: u32, row: &Row<'_>, skin: &mut Nodes) -> u32 {
        let at = points.map(|point| row.to(self.drawn.at(point, &skin.place)));
        bits(some).fold(0, |again, i| {
            let Some(push) = row.field.push(at[i], CLEARANCE_MM, row.rather_ahead_mm) else {
                return again;
            };
            let push = row.from(push) * PUSH_SHARE;
            let depth = push.length();
            let normal = push * depth.max(f32::MIN_POSITIVE).recip();
            let [a, b] = self.nodes[points[i]];
            for node in &[a, b][..if a == b { 1 } else { 2 }] {
                let node = *node as usize;
                skin.place[node] += push;
                // Only the speed that brought it there goes: no rebound, and what is pressed lies still.
                let inwards = skin.velocity[node].dot(normal).min(0.0);
                skin.velocity[node] -= normal * inwards.max(-depth * row.per_step);
            }
            again | u32::from(depth > DONE_MM) << i
        })
    }
}

/// A row of teeth as it is now.
#[derive(Clone, Copy)]
struct Row<'a> {
    field: &'a Field,
    /// From the head to where the row was at rest, and back; none of the upper row.
    frames: Option<[Affine3A; 2]>,
    rather_ahead_mm: f32,
    /// 1 over the length of the step, 1/s.
    per_step: f32,
}

impl Row<'_> {
    fn to(&self, p: Vec3A) -> Vec3A {
        self.frames.map_or(p, |[to, _]| to.transform_point3a(p))
    }

    fn from(&self, v: Vec3A) -> Vec3A {
        self.frames
            .map_or(v, |[_, from]| from.transform_vector3a(v))
    }

    /// Bits of the points that the row may hold.
    #[inline]
    fn near(&self, at: &Places) -> u32 {
        match &self.frames {
            Some([to, _]) => self.field.near(&at.moved(to)),
            None => self.field.near(at),
        }
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
