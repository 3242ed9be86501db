//! One closed surface over neighbouring fibres: curves, the sheet through them, its thickness.
//!
//! A sheet is a grid of places: rings along the fibres, each from one edge of the muscle to the other.
//! Every ring becomes a closed loop, over the outer side and back over the inner one; loops are joined,
//! and the two ends closed by fans, or joined to each other in a round sphincter.

use std::ops::Range;

use glam::{Vec2, Vec3, vec2};

use super::curve::{curve, longer, on_line};
use super::shape::{self, Shape, along};
use super::{Belly, enclosed_volume};
use crate::anatomy::Rays;
use crate::mesh::normals;
use crate::muscle::grid::inwards;
use crate::{Contraction, Mesh, Muscle};

/// Rings of a muscle that has two ends, and of one that closes on itself.
const RINGS: usize = 44;
const RINGS_CLOSED: usize = 72;
/// Places across a sheet: this many, and more per fibre beyond the first.
const ACROSS: usize = 11;
const ACROSS_PER_FIBRE: usize = 6;
/// Ends of a control polygon nearer than this are one, mm.
const JOINED_MM: f32 = 0.5;
/// How much thicker or thinner than at rest a muscle may be drawn, and a sphincter: fibres that close on
/// a point would make a ball.
const SWELLING: Range<f32> = 0.4..3.0;
const SWELLING_ROUND: Range<f32> = 0.7..1.8;
/// Rounds of fitting the thickness to the volume; each leaves a few per cent of the error.
const ROUNDS: usize = 5;
/// Share of a fan's length that its round edge draws on.
const ROUNDED: f32 = 0.7;

/// Fibres that form one surface.
#[derive(Clone, Debug)]
pub(super) struct Sheet {
    muscle: Muscle,
    pub(super) shape: Shape,
    contraction: Contraction,
    /// Each fibre's control points among all.
    fibres: Vec<Range<usize>>,
    closed: bool,
    pub(super) rings: usize,
    pub(super) across: usize,
    /// 1 or -1: which side of the grid is out.
    out: f32,
    /// How far each place of the grid stands off its curve so that bone does not cover it, mm.
    pub(super) lift: Vec<f32>,
    /// At rest: volume, mm3, and how far each ring is out of the line between the ends, mm.
    volume: f32,
    bow: Vec<f32>,
    uvs: Vec<Vec2>,
    triangles: Vec<[u32; 3]>,
}

/// The sheet's middle in one pose.
pub(super) struct Middle {
    /// Ring by ring.
    pub(super) places: Vec<Vec3>,
    pub(super) normals: Vec<Vec3>,
    /// Place across, -1 to 1.
    pub(super) across: Vec<f32>,
    /// Half the width of each ring, mm.
    half: Vec<f32>,
}

impl Sheet {
    /// Over these fibres; none where there is nothing to draw.
    pub(super) fn new(
        muscle: Muscle,
        contraction: Contraction,
        fibres: &[Range<usize>],
        rest: &[Vec3],
        bones: &Rays,
        number: usize,
    ) -> Option<Self> {
        if fibres.is_empty() || fibres.iter().any(|f| f.len() < 2) {
            return None;
        }
        let closed = fibres
            .iter()
            .all(|f| f.len() > 3 && rest[f.start].distance(rest[f.end - 1]) < JOINED_MM);
        let mut sheet = Self {
            muscle,
            shape: shape::of(muscle),
            contraction,
            fibres: fibres.to_vec(),
            closed,
            rings: if closed { RINGS_CLOSED } else { RINGS },
            across: ACROSS + ACROSS_PER_FIBRE * (fibres.len() - 1),
            out: 1.0,
            lift: Vec::new(),
            volume: 0.0,
            bow: Vec::new(),
            uvs: Vec::new(),
            triangles: Vec::new(),
        };
        let middle = sheet.middle(rest, 1.0);
        let facing: f32 = middle
            .places
            .iter()
            .zip(&middle.normals)
            .map(|(p, n)| n.dot(-inwards(*p)))
            .sum();
        sheet.out = if facing < 0.0 { -1.0 } else { 1.0 };
        let middle = sheet.middle(rest, 1.0);
        sheet.bow = sheet.bows(&middle);
        sheet.lift = sheet.lifts(&middle, bones);
        sheet.uvs = sheet.uvs(&middle, number);
        sheet.triangles = sheet.joined();
        let places = sheet.solid(rest, 1.0, &sheet.lift);
        sheet.volume = enclosed_volume(&places, &sheet.triangles);
        if sheet.volume < 0.0 {
            sheet.volume = -sheet.volume;
            for t in &mut sheet.triangles {
                t.swap(1, 2);
            }
        }
        Some(sheet)
    }

    /// The surface for displaced control points, as thick as keeps its volume.
    pub(super) fn shaped(&self, points: &[Vec3], skull: &Rays) -> Belly {
        let lift = self.lifts_now(points, skull);
        let range = match self.contraction {
            Contraction::Linear => SWELLING,
            Contraction::Sphincter { .. } => SWELLING_ROUND,
            Contraction::Belly { .. } => 1.0..1.0,
        };
        let mut swelling = 1.0_f32;
        let mut positions = self.solid(points, swelling, &lift);
        for _ in 0..ROUNDS {
            let volume = enclosed_volume(&positions, &self.triangles);
            let wanted = swelling * (self.volume / volume.max(1e-3));
            let next = wanted.clamp(range.start, range.end);
            if (next - swelling).abs() < 1e-3 {
                break;
            }
            swelling = next;
            positions = self.solid(points, swelling, &lift);
        }
        Belly {
            muscle: self.muscle,
            mesh: Mesh {
                normals: normals(&positions, &self.triangles),
                occlusion: vec![1.0; positions.len()],
                uvs: self.uvs.clone(),
                triangles: self.triangles.clone(),
                positions,
            },
        }
    }

    /// Place of a ring along the muscle, 0 to 1.
    fn along(&self, ring: usize) -> f32 {
        let last = if self.closed {
            self.rings
        } else {
            self.rings - 1
        };
        ring as f32 / last as f32
    }

    /// The same as widths and tendons go: a round muscle begins and ends at its ligament.
    pub(super) fn end_place(&self, ring: usize) -> f32 {
        let u = self.along(ring);
        if self.closed { u.min(1.0 - u) } else { u }
    }

    /// How much more than at rest a ring swells: the belly most, the ends not.
    fn swelling(&self, ring: usize, swelling: f32) -> f32 {
        let bell = if self.closed {
            1.0
        } else {
            (std::f32::consts::PI * self.along(ring))
                .sin()
                .max(0.0)
                .sqrt()
        };
        1.0 + (swelling - 1.0) * bell
    }

    /// The grid of places between outer and inner side.
    pub(super) fn middle(&self, points: &[Vec3], swelling: f32) -> Middle {
        let curves: Vec<Vec<Vec3>> = self
            .fibres
            .iter()
            .map(|f| {
                let beyond = if self.closed {
                    [0.0; 2]
                } else {
                    self.shape.beyond
                };
                curve(&longer(&points[f.clone()], beyond), self.closed, self.rings)
            })
            .collect();
        let mut middle = Middle {
            places: Vec::with_capacity(self.rings * self.across),
            normals: Vec::new(),
            across: Vec::with_capacity(self.rings * self.across),
            half: Vec::with_capacity(self.rings),
        };
        let mut knots = Vec::with_capacity(curves.len() + 2);
        for ring in 0..self.rings {
            // Half of the swelling goes sideways.
            let beside = along(self.shape.beside, self.end_place(ring))
                * self.swelling(ring, swelling).sqrt();
            let (first, last) = (curves[0][ring], curves[curves.len() - 1][ring]);
            let (before, after) = self.neighbours(ring);
            let aside = |curve: &[Vec3]| {
                (curve[after] - curve[before])
                    .cross(-inwards(curve[ring]))
                    .normalize_or(Vec3::X)
            };
            let (left, right) = match curves.len() {
                1 => (-aside(&curves[0]), aside(&curves[0])),
                n => (
                    (first - curves[1][ring]).normalize_or(Vec3::X),
                    (last - curves[n - 2][ring]).normalize_or(Vec3::X),
                ),
            };
            knots.clear();
            knots.push(first + left * (beside * (1.0 - self.shape.lean)));
            knots.extend(curves.iter().map(|c| c[ring]));
            knots.push(last + right * (beside * (1.0 + self.shape.lean)));
            let width: f32 = knots.windows(2).map(|w| w[0].distance(w[1])).sum();
            middle.half.push(0.5 * width);
            for j in 0..self.across {
                let share = j as f32 / (self.across - 1) as f32;
                // Closer at the edges, where the surface turns.
                let round = 0.5 - 0.5 * (std::f32::consts::PI * share).cos();
                let share = 0.4 * share + 0.6 * round;
                middle.places.push(on_line(&knots, share * width));
                middle.across.push(2.0 * share - 1.0);
            }
        }
        self.round_off(&mut middle);
        for ring in 0..self.rings {
            let (before, after) = self.neighbours(ring);
            for j in 0..self.across {
                let at = |ring: usize, j: usize| middle.places[ring * self.across + j];
                let (low, high) = (j.saturating_sub(1), (j + 1).min(self.across - 1));
                let normal = (at(after, j) - at(before, j)).cross(at(ring, high) - at(ring, low));
                middle.normals.push(normal.normalize_or(Vec3::Z) * self.out);
            }
        }
        middle
    }

    /// Draws the origin of a fan out to a round edge.
    fn round_off(&self, middle: &mut Middle) {
        if self.closed || self.shape.round == 0.0 {
            return;
        }
        for j in 0..self.across {
            let back = (middle.places[j] - middle.places[j + self.across]).normalize_or_zero();
            for ring in 0..self.rings {
                let k = ring * self.across + j;
                let near = (1.0 - self.along(ring) / ROUNDED).max(0.0);
                let out = self.shape.round * near * near * (1.0 - middle.across[k].powi(2));
                middle.places[k] += back * out;
            }
        }
    }

    pub(super) fn neighbours(&self, ring: usize) -> (usize, usize) {
        if self.closed {
            (
                (ring + self.rings - 1) % self.rings,
                (ring + 1) % self.rings,
            )
        } else {
            (ring.saturating_sub(1), (ring + 1).min(self.rings - 1))
        }
    }

    /// Half the thickness at a place of the grid at rest.
    pub(super) fn half_thickness(&self, ring: usize, across: f32) -> f32 {
        let edge = 2.0 * self.fibres.len() as f32;
        let round = (1.0 - across.abs().powf(edge)).max(0.0).sqrt();
        0.5 * along(self.shape.thick, self.end_place(ring)) * round
    }

    /// How far each ring's middle is out of the line between the ends.
    fn bows(&self, middle: &Middle) -> Vec<f32> {
        let centre = |ring: usize| ring * self.across + self.across / 2;
        let (first, last) = (
            middle.places[centre(0)],
            middle.places[centre(self.rings - 1)],
        );
        (0..self.rings)
            .map(|ring| {
                let p = middle.places[centre(ring)];
                (p - first.lerp(last, self.along(ring))).dot(middle.normals[centre(ring)])
            })
            .collect()
    }

    /// The closed surface's places: loop by loop, then the middles of the two ends.
    fn solid(&self, points: &[Vec3], swelling: f32, lift: &[f32]) -> Vec<Vec3> {
        let middle = self.middle(points, swelling);
        let bows = match self.contraction {
            Contraction::Belly { .. } => self.bows(&middle),
            _ => self.bow.clone(),
        };
        let mut out = Vec::with_capacity(self.uvs.len());
        for (ring, (bow, at_rest)) in bows.iter().zip(&self.bow).enumerate() {
            // What has come out of the line is thickness: the inner side stays on the bone.
            let bulge = (bow - at_rest).max(0.0);
            let factor = self.swelling(ring, swelling).sqrt();
            let place = |j: usize, side: f32| {
                let k = ring * self.across + j;
                let (n, across) = (middle.normals[k], middle.across[k]);
                let half = self.half_thickness(ring, across);
                let inner = bulge * (1.0 - across.abs().powi(2));
                let off = if side > 0.0 {
                    half * factor
                } else {
                    -half * factor - inner
                };
                middle.places[k] + n * (lift[k] + off)
            };
            for j in 0..self.across {
                out.push(place(j, 1.0));
            }
            for j in (1..self.across - 1).rev() {
                out.push(place(j, -1.0));
            }
        }
        if !self.closed {
            let size = self.loop_size();
            for ring in [0, self.rings - 1] {
                let all = &out[ring * size..(ring + 1) * size];
                out.push(all.iter().sum::<Vec3>() / size as f32);
            }
        }
        out
    }

    fn loop_size(&self) -> usize {
        2 * (self.across - 1)
    }

    fn joined(&self) -> Vec<[u32; 3]> {
        let size = self.loop_size();
        let at = |ring: usize, k: usize| ((ring % self.rings) * size + k % size) as u32;
        let spans = if self.closed {
            self.rings
        } else {
            self.rings - 1
        };
        let mut triangles = Vec::with_capacity(2 * (spans + 1) * size);
        for ring in 0..spans {
            for k in 0..size {
                let (a, b) = (at(ring, k), at(ring, k + 1));
                let (c, d) = (at(ring + 1, k), at(ring + 1, k + 1));
                triangles.extend([[a, b, d], [a, d, c]]);
            }
        }
        if !self.closed {
            let (low, high) = ((self.rings * size) as u32, (self.rings * size + 1) as u32);
            for k in 0..size {
                triangles.push([low, at(0, k + 1), at(0, k)]);
                triangles.push([high, at(self.rings - 1, k), at(self.rings - 1, k + 1)]);
            }
        }
        triangles
    }

    /// See [`Material::Muscle`](crate::Material::Muscle). Fibres keep their number where the muscle
    /// widens, so what is across is counted as in the belly.
    fn uvs(&self, middle: &Middle, number: usize) -> Vec<Vec2> {
        let half = middle.half[self.rings / 2];
        let mut out = Vec::new();
        for ring in 0..self.rings {
            let u = self.flesh(ring);
            let v = |j: usize| middle.across[ring * self.across + j] * half + 61.0 * number as f32;
            out.extend((0..self.across).map(|j| vec2(u, v(j))));
            out.extend((1..self.across - 1).rev().map(|j| vec2(u, v(j))));
        }
        if !self.closed {
            let middle = 61.0 * number as f32;
            out.push(vec2(self.flesh(0), middle));
            out.push(vec2(self.flesh(self.rings - 1), middle));
        }
        out
    }

    /// Place along the flesh, 0 to 1; tendon is beyond. An end without tendon keeps clear of it.
    fn flesh(&self, ring: usize) -> f32 {
        let [origin, insertion] = self.shape.tendon;
        let u = self.end_place(ring);
        if self.closed {
            return (u - origin) / (1.0 - 2.0 * origin);
        }
        let (from, low) = if origin > 0.0 {
            (origin, 0.0)
        } else {
            (0.0, CLEAR)
        };
        let (to, high) = if insertion > 0.0 {
            (1.0 - insertion, 1.0)
        } else {
            (1.0, 1.0 - CLEAR)
        };
        low + (u - from) / (to - from) * (high - low)
    }
}

/// How far from its end flesh without tendon is said to begin.
const CLEAR: f32 = 0.25;
