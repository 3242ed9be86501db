//! The reference skin: the half template of [`layout`](super::layout) with the insides of its openings,
//! mirrored, with a crown on top.

use glam::{Vec2, Vec3, vec3};

use super::LEVELS as LIP_LEVELS;
use super::eyes::{Eyes, LOOP};
use super::layout::{self, Line};
use super::surface::{BACK, Surface, chart_of, uv_of};
use super::{ReferenceError, crown, mouth, polyline, shapes};
use crate::head::normals;
use crate::{Lid, Lips, Mesh, Skin};

/// A vertex of the half template.
#[derive(Clone, Copy)]
pub(super) struct Vertex {
    pub position: Vec3,
    pub chart: Vec2,
    pub vermilion: f32,
    pub wet: f32,
    /// Share of its light that reaches it through openings the mesh is too coarse to show.
    pub lit: f32,
}

/// The half template while it grows.
#[derive(Default)]
struct Half {
    vertices: Vec<Vertex>,
    triangles: Vec<[usize; 3]>,
    lines: Vec<Line>,
}

impl Half {
    fn push(&mut self, position: Vec3, chart: Vec2, vermilion: f32, wet: f32) -> usize {
        self.vertices.push(Vertex {
            position,
            chart,
            vermilion,
            wet,
            lit: 1.0,
        });
        self.vertices.len() - 1
    }

    /// A vertex on the skin where the chart and the surface agree.
    fn on_skin(&mut self, position: Vec3) -> usize {
        self.push(position, chart_of(position), 0.0, 0.0)
    }

    /// Joins two rows of vertices by quads; an opening's rim runs counter-clockwise, its inside on the left.
    fn strip(&mut self, outer: &[usize], inner: &[usize]) {
        for i in 0..outer.len() - 1 {
            let [a, b, c, d] = [outer[i], outer[i + 1], inner[i + 1], inner[i]];
            for t in [[a, b, c], [a, c, d]] {
                if t[0] != t[1] && t[1] != t[2] && t[2] != t[0] {
                    self.triangles.push(t);
                }
            }
        }
    }
}

/// One lip's vertex numbers: `[station][level]`.
type LipRows = Vec<[usize; LIP_LEVELS]>;

/// The skin, the lips' columns in it, and the vertices that the lids carry.
pub(super) fn build(
    surface: &Surface,
    eyes: &Eyes,
) -> Result<(Skin, Lips, Vec<Lid>), ReferenceError> {
    let mut half = Half::default();
    let columns = [mouth::lip(surface, 1.0), mouth::lip(surface, -1.0)];
    let (mut upper, mut lower) = lips(&mut half, &columns);
    let mut lid_loops = lid_loops(&mut half, surface);
    let nostril = nostril_loop(&mut half, surface);
    for line in [
        polyline::evenly(&surface.curves.upper_lid_crease, 14),
        polyline::evenly(&surface.curves.alar_crease[..33], 11),
    ] {
        let points = line.into_iter().map(|p| half.on_skin(p)).collect();
        half.lines.push(Line {
            points,
            opening: false,
        });
    }

    let fixed: Vec<Vec2> = half.vertices.iter().map(|v| v.chart).collect();
    let template = layout::build(fixed, &half.lines)?;
    for &chart in &template.points[half.vertices.len()..] {
        half.push(surface.point(chart), chart, 0.0, 0.0);
    }
    half.triangles.extend(&template.triangles);

    smooth_ear(&mut half);
    line_mouth(&mut half, &mut upper, &mut lower, &columns);
    line_lids(&mut half, &mut lid_loops, surface, eyes);
    line_nostril(&mut half, &nostril, surface);
    Ok(assemble(&half, &upper, &lower, surface, eyes, &lid_loops))
}

/// Evens out the ear: the chart sees its rim and folds edge on, where one step of the surface map
/// jumps by centimetres.
fn smooth_ear(half: &mut Half) {
    const ROUNDS: usize = 3;
    let near = |p: Vec3| p.x > 62.0 && (-28.0..44.0).contains(&p.y) && (-30.0..24.0).contains(&p.z);
    for _ in 0..ROUNDS {
        let mut sum = vec![(Vec3::ZERO, 0.0_f32); half.vertices.len()];
        for t in &half.triangles {
            for i in 0..3 {
                let (a, b) = (t[i], t[(i + 1) % 3]);
                sum[a].0 += half.vertices[b].position;
                sum[a].1 += 1.0;
            }
        }
        for (v, (total, count)) in half.vertices.iter_mut().zip(sum) {
            if near(v.position) && count > 0.0 {
                v.position = v.position.lerp(total / count, 0.5);
            }
        }
    }
}

/// Places both lips' columns and the slit between them.
fn lips(half: &mut Half, columns: &[Vec<mouth::Column>; 2]) -> (LipRows, LipRows) {
    let last = mouth::STATIONS - 1;
    let mut rows = [Vec::new(), Vec::new()];
    for (row, lip) in rows.iter_mut().zip(columns) {
        for column in lip {
            let mut numbers = [usize::MAX; LIP_LEVELS];
            for level in 0..4 {
                let corner = row.len() == last;
                numbers[level] = match (corner, level) {
                    (true, 1) => numbers[0],
                    (true, 2) => half.push(column.points[3], column.chart[3], 0.8, 0.4),
                    (true, 3) => numbers[2],
                    _ => half.push(
                        column.points[level],
                        column.chart[level],
                        [0.45, 1.0, 1.0, 1.0][level] * if corner { 0.3 } else { 1.0 },
                        [0.0, 0.0, 0.15, 0.5][level],
                    ),
                };
            }
            row.push(numbers);
        }
    }
    let [upper, mut lower] = rows;
    // Both lips end in the same two vertices at the corner: the lower lip's own are dropped.
    half.vertices.truncate(half.vertices.len() - 2);
    lower[last] = upper[last];
    for rows in [&upper, &lower] {
        for level in 0..3 {
            let points: Vec<usize> = rows.iter().map(|r| r[level]).collect();
            half.lines.push(Line {
                points: dedup(points),
                opening: false,
            });
        }
    }
    let slit = upper
        .iter()
        .map(|r| r[3])
        .chain(lower.iter().rev().skip(1).map(|r| r[3]))
        .collect();
    half.lines.push(Line {
        points: slit,
        opening: true,
    });
    (upper, lower)
}

fn dedup(mut points: Vec<usize>) -> Vec<usize> {
    points.dedup();
    points
}

/// Extrudes the lips' inner side and completes the columns with its vertices.
fn line_mouth(
    half: &mut Half,
    upper: &mut LipRows,
    lower: &mut LipRows,
    columns: &[Vec<mouth::Column>; 2],
) {
    let last = mouth::STATIONS - 1;
    for (rows, lip, own) in [
        (&mut *upper, &columns[0], last + 1),
        (&mut *lower, &columns[1], last),
    ] {
        // At the corner the lower lip has no vertices of its own.
        for (row, column) in rows.iter_mut().zip(lip).take(own) {
            for (level, number) in row.iter_mut().enumerate().skip(4) {
                *number = half.push(column.points[level], column.chart[3], 1.0, 1.0);
            }
        }
    }
    lower[last] = upper[last];
    for (rows, is_upper) in [(upper, true), (lower, false)] {
        for level in 3..LIP_LEVELS - 1 {
            let line = |level: usize| -> Vec<usize> {
                let along = rows.iter().map(|r| r[level]);
                if is_upper {
                    along.rev().collect()
                } else {
                    along.collect()
                }
            };
            half.strip(&line(level), &line(level + 1));
        }
    }
}

/// Outer and inner margin of the left lids: two closed loops.
fn lid_loops(half: &mut Half, surface: &Surface) -> [Vec<usize>; 2] {
    let curves = &surface.curves;
    let centre = middle(&curves.lid_margin_outer);
    let outer: Vec<usize> =
        polyline::by_angle(&curves.lid_margin_outer, centre, Eyes::SQUASH, LOOP)
            .into_iter()
            .map(|p| half.push(p, chart_of(p), 0.0, 0.1))
            .collect();
    half.lines.push(Line {
        points: outer.clone(),
        opening: true,
    });
    [outer, Vec::new()]
}

/// Extrudes the lids' thickness and a short way behind it.
fn line_lids(half: &mut Half, loops: &mut [Vec<usize>; 2], surface: &Surface, eyes: &Eyes) {
    let curves = &surface.curves;
    let centre = middle(&curves.lid_margin_outer);
    let ball = |p: Vec3, height: f32| {
        eyes.centre + (p - eyes.centre).normalize_or(Vec3::Z) * (eyes.radius + height)
    };
    let mut inner = Vec::new();
    let mut behind = Vec::new();
    for (i, p) in polyline::by_angle(&curves.lid_margin_inner, centre, Eyes::SQUASH, LOOP)
        .into_iter()
        .enumerate()
    {
        let chart = half.vertices[loops[0][i]].chart;
        inner.push(half.push(ball(p, 0.25), chart, 0.0, 0.8));
        let out = (p - centre) * vec3(0.12, 0.8, 0.0);
        behind.push(half.push(ball(p + out - vec3(0.0, 0.0, 1.0), 0.1), chart, 0.0, 1.0));
    }
    for ring in [[&loops[0], &inner], [&inner, &behind]] {
        let [outer, inner] = ring.map(|l| closed(l));
        half.strip(&outer, &inner);
    }
    loops[1] = inner;
}

/// Rim of the left nostril.
fn nostril_loop(half: &mut Half, surface: &Surface) -> Vec<usize> {
    const COUNT: usize = 12;
    let rim = &surface.curves.nostril_rim;
    let points = polyline::by_angle(rim, middle(rim), 1.6, COUNT);
    let ring: Vec<usize> = points.into_iter().map(|p| half.on_skin(p)).collect();
    half.lines.push(Line {
        points: ring.clone(),
        opening: true,
    });
    ring
}

/// Extrudes the nostril up into the nose.
fn line_nostril(half: &mut Half, rim: &[usize], surface: &Surface) {
    let inner = polyline::by_angle(
        &surface.curves.nostril_inner,
        middle(&surface.curves.nostril_inner),
        1.6,
        rim.len(),
    );
    let up = vec3(0.8, 7.5, -2.5);
    let first = half.vertices.len();
    let mut outer = rim.to_vec();
    for (rise, shrink) in [(0.0, 1.0), (0.8, 0.75), (1.6, 0.35)] {
        let centre = middle(&inner);
        let ring: Vec<usize> = inner
            .iter()
            .zip(rim)
            .map(|(p, &i)| {
                let chart = half.vertices[i].chart;
                half.push(centre + (*p - centre) * shrink + up * rise, chart, 0.0, 0.0)
            })
            .collect();
        half.strip(&closed(&outer), &closed(&ring));
        outer = ring;
    }
    let chart = half.vertices[rim[0]].chart;
    let apex = half.push(middle(&inner) + up * 1.9, chart, 0.0, 0.0);
    half.strip(&closed(&outer), &vec![apex; outer.len() + 1]);
    for v in &mut half.vertices[first..] {
        v.lit = 0.12;
    }
}

fn closed(ring: &[usize]) -> Vec<usize> {
    ring.iter().chain(ring.first()).copied().collect()
}

fn middle(points: &[Vec3]) -> Vec3 {
    points.iter().sum::<Vec3>() / points.len().max(1) as f32
}

/// Both halves, the crown on top, and what refers to vertices by number.
fn assemble(
    half: &Half,
    upper: &LipRows,
    lower: &LipRows,
    surface: &Surface,
    eyes: &Eyes,
    lid_loops: &[Vec<usize>; 2],
) -> (Skin, Lips, Vec<Lid>) {
    let mut vertices = half.vertices.clone();
    let on_seam = |v: &Vertex| v.chart.x.abs() < 1e-3 || (BACK - v.chart.x).abs() < 1e-3;
    for v in &mut vertices {
        if on_seam(v) {
            v.position.x = 0.0;
        }
    }
    let mirror: Vec<usize> = (0..vertices.len())
        .map(|i| {
            let mut v = vertices[i];
            if on_seam(&v) {
                return i;
            }
            v.position.x = -v.position.x;
            v.chart.x = -v.chart.x;
            vertices.push(v);
            vertices.len() - 1
        })
        .collect();
    let mut triangles = half.triangles.clone();
    triangles.extend(
        half.triangles
            .iter()
            .map(|&[a, b, c]| [mirror[a], mirror[c], mirror[b]]),
    );
    crown::close(&mut vertices, &mut triangles, surface);

    let mut positions: Vec<Vec3> = vertices.iter().map(|v| v.position).collect();
    let triangles: Vec<[u32; 3]> = triangles
        .iter()
        .map(|t| t.map(|i| i as u32))
        .filter(|t| {
            let [a, b, c] = t.map(|i| positions[i as usize]);
            (b - a).cross(c - a).length() > 1e-4
        })
        .collect();
    let columns = |rows: &LipRows| -> Vec<[u32; crate::LIP_LEVELS]> {
        let right = rows
            .iter()
            .skip(1)
            .rev()
            .map(|r| r.map(|i| mirror[i] as u32));
        right
            .chain(rows.iter().map(|r| r.map(|i| i as u32)))
            .map(|r| [0, 1, 1, 2, 2, 3, 4, 5, 6].map(|level| r[level]))
            .collect()
    };
    let lips = Lips {
        upper: columns(upper),
        lower: columns(lower),
    };
    let mut lids = eyes.lids(&positions, &lid_loops[0], &lid_loops[1]);
    let right: Vec<Lid> = lids
        .iter()
        .filter(|l| {
            mirror
                .get(l.vertex as usize)
                .is_some_and(|&m| m != l.vertex as usize)
        })
        .map(|l| Lid {
            vertex: mirror[l.vertex as usize] as u32,
            left: false,
            ..*l
        })
        .collect();
    lids.extend(right);
    eyes.relax(&mut positions, &mut lids);
    let mut skin = Skin {
        weight: positions
            .iter()
            .map(|p| shapes::ramp(-103.0, -74.0, p.y + 0.12 * (p.z - 60.0).min(0.0)))
            .collect(),
        wedges: Vec::new(),
        creases: Vec::new(),
        reference: positions.clone(),
        vermilion: vertices.iter().map(|v| v.vermilion).collect(),
        wet: vertices.iter().map(|v| v.wet).collect(),
        mesh: Mesh {
            normals: normals(&positions, &triangles),
            uvs: vertices.iter().map(|v| uv_of(v.chart)).collect(),
            occlusion: vertices.iter().map(|v| v.lit).collect(),
            positions,
            triangles,
        },
    };
    let uv = |i: u32| skin.mesh.uvs[i as usize];
    skin.wedges = skin
        .mesh
        .triangles
        .iter()
        .map(|t| across_seam(t.map(uv)))
        .collect();
    for columns in [&lips.upper, &lips.lower] {
        skin.creases.extend(columns.windows(2).map(|w| {
            [
                w[0][crate::lip_level::CONTACT],
                w[1][crate::lip_level::CONTACT],
            ]
        }));
    }
    (skin, lips, lids)
}

/// A triangle's texture coordinates, past 1 where it crosses the chart's seam.
fn across_seam(uv: [Vec2; 3]) -> [Vec2; 3] {
    let high = uv[0].x.max(uv[1].x).max(uv[2].x);
    uv.map(|c| if high - c.x > 0.5 { c + Vec2::X } else { c })
}
