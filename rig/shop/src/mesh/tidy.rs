//! A scan made clean: vertices that coincide become one, triangles without area go, and so do specks and
//! debris; two heads are refused. Holes, noise and missing backs of heads stay: the fit lives with them
//! (HEADSHOP 6.2), and small islands of data are worth having, so that only what is both tiny and alone,
//! or small and far away, is dropped.

use std::collections::HashMap;
use std::hash::BuildHasherDefault;

use glam::Vec3;
use serde::Serialize;

use super::error::Fault;
use super::limits::MIN_TRIANGLES;
use super::scan::{Scan, ScanColour};
use super::stl::Mix;

/// What tidying took away.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Dropped {
    /// Vertices that lay on another one.
    pub welded_vertices: usize,
    /// Vertices that no triangle uses any more.
    pub unused_vertices: usize,
    /// Triangles without area.
    pub degenerate_triangles: usize,
    /// Pieces that were specks or debris.
    pub islands: usize,
    /// Their triangles.
    pub island_triangles: usize,
}

/// Vertices nearer than this share of the scan's size are one.
const WELD: f32 = 1e-6;
/// A piece smaller than this share of the largest piece's diagonal is a speck ...
const SPECK: f32 = 0.02;
/// ... and one with less than this share of its area is debris ...
const DEBRIS_AREA: f64 = 0.02;
/// ... if it is farther than this share of the diagonal from the largest piece's box.
const DEBRIS_DISTANCE: f32 = 0.15;
/// What is kept must have this share of the area, else the scan is all fragments.
const KEPT_AREA: f64 = 0.7;
/// Two pieces are two heads if the smaller one has this share of the larger one's area and size ...
const TWIN_AREA: f64 = 0.45;
const TWIN_SIZE: f64 = 0.65;
/// ... and their centres are apart by this share of their radii of gyration together. The halves of
/// one head stay below 0.75, two heads side by side are above 1.
const TWIN_DISTANCE: f64 = 0.9;

/// `scan` made clean.
///
/// # Errors
/// When nothing is left, or when there are two heads.
pub fn tidy(mut scan: Scan) -> Result<(Scan, Dropped), Fault> {
    let mut dropped = Dropped::default();
    weld(&mut scan, &mut dropped);
    let before = scan.triangles.len();
    let size = diagonal(&scan.positions);
    let keep: Vec<bool> = scan
        .triangles
        .iter()
        .map(|&t| has_area(&scan.positions, t, size))
        .collect();
    retain(&mut scan, &keep);
    dropped.degenerate_triangles = before - scan.triangles.len();
    if scan.triangles.is_empty() {
        return Err(Fault::NoArea);
    }
    islands(&mut scan, &mut dropped)?;
    if scan.triangles.len() < MIN_TRIANGLES {
        return Err(Fault::FewTriangles(scan.triangles.len()));
    }
    drop_unused(&mut scan, &mut dropped);
    Ok((scan, dropped))
}

fn bounds(points: impl Iterator<Item = Vec3>) -> (Vec3, Vec3) {
    points.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| {
        (low.min(p), high.max(p))
    })
}

/// Of the box round the points.
pub(crate) fn diagonal(points: &[Vec3]) -> f32 {
    let (low, high) = bounds(points.iter().copied());
    (high - low).length()
}

fn weld(scan: &mut Scan, dropped: &mut Dropped) {
    let (low, _) = bounds(scan.positions.iter().copied());
    let cell = diagonal(&scan.positions) * WELD;
    if cell <= 0.0 {
        return;
    }
    let mut known: HashMap<(u32, u32, u32), u32, BuildHasherDefault<Mix>> = HashMap::default();
    known.reserve(scan.positions.len());
    let mut first = Vec::with_capacity(scan.positions.len());
    for (i, &p) in scan.positions.iter().enumerate() {
        let [x, y, z] = ((p - low) / cell).round().to_array().map(|c| c as u32);
        first.push(*known.entry((x, y, z)).or_insert(i as u32));
    }
    dropped.welded_vertices = scan.positions.len() - known.len();
    if dropped.welded_vertices > 0 {
        for t in &mut scan.triangles {
            *t = t.map(|i| first[i as usize]);
        }
    }
}

/// Whether a triangle is more than a line at single precision.
fn has_area(positions: &[Vec3], [a, b, c]: [u32; 3], size: f32) -> bool {
    if a == b || b == c || c == a {
        return false;
    }
    let [a, b, c] = [a, b, c].map(|i| positions[i as usize].as_dvec3());
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    let height = (b - a).cross(c - a).length() / longest;
    // A millionth of a head is 0.3 µm; a height of a ten-thousandth of the side is a needle.
    height > f64::from(size) * 1e-7 && height > longest * 1e-4
}

fn retain(scan: &mut Scan, keep: &[bool]) {
    if keep.iter().all(|&k| k) {
        return;
    }
    let mut flags = keep.iter();
    scan.triangles
        .retain(|_| flags.next().copied().unwrap_or(true));
    if let Some(ScanColour::Texture { uvs, .. }) = &mut scan.colour {
        let mut flags = keep.iter();
        uvs.retain(|_| flags.next().copied().unwrap_or(true));
    }
}

fn drop_unused(scan: &mut Scan, dropped: &mut Dropped) {
    let mut place = vec![u32::MAX; scan.positions.len()];
    for &i in scan.triangles.iter().flatten() {
        place[i as usize] = 0;
    }
    let used: Vec<bool> = place.iter().map(|&p| p == 0).collect();
    let mut next = 0;
    for (place, _) in place.iter_mut().zip(&used).filter(|(_, used)| **used) {
        *place = next;
        next += 1;
    }
    let total = scan.positions.len() - next as usize;
    dropped.unused_vertices = total - dropped.welded_vertices.min(total);
    let mut flags = used.iter();
    scan.positions
        .retain(|_| flags.next().copied().unwrap_or(false));
    if let Some(ScanColour::PerVertex(colours)) = &mut scan.colour {
        let mut flags = used.iter();
        colours.retain(|_| flags.next().copied().unwrap_or(false));
    }
    for t in &mut scan.triangles {
        *t = t.map(|i| place[i as usize]);
    }
}

/// A piece of a scan that hangs together.
#[derive(Clone)]
struct Piece {
    triangles: usize,
    area: f64,
    /// Area times centre, and area times its square, summed.
    centre: glam::DVec3,
    square: f64,
    low: Vec3,
    high: Vec3,
}

impl Piece {
    fn middle(&self) -> glam::DVec3 {
        self.centre / self.area
    }

    /// Radius of gyration of its surface.
    fn radius(&self) -> f64 {
        (self.square / self.area - self.middle().length_squared())
            .max(0.0)
            .sqrt()
    }

    fn diagonal(&self) -> f32 {
        (self.high - self.low).length()
    }

    /// Between the boxes.
    fn distance(&self, other: &Self) -> f32 {
        (self.low - other.high)
            .max(other.low - self.high)
            .max(Vec3::ZERO)
            .length()
    }
}

fn islands(scan: &mut Scan, dropped: &mut Dropped) -> Result<(), Fault> {
    let piece_of = pieces_of(scan);
    let count = piece_of.iter().max().map_or(0, |&p| p as usize + 1);
    let pieces = measure(scan, &piece_of, count);
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| pieces[b].area.total_cmp(&pieces[a].area));
    let largest = &pieces[order[0]];
    // Of many pieces a few are large; the second head is among them.
    for &other in order.iter().skip(1).take(8) {
        let other = &pieces[other];
        let radii = [largest.radius(), other.radius()];
        let alike = other.area > TWIN_AREA * largest.area
            && radii[0].min(radii[1]) > TWIN_SIZE * radii[0].max(radii[1]);
        let apart = largest.middle().distance(other.middle());
        if alike && apart > TWIN_DISTANCE * (radii[0] + radii[1]) {
            return Err(Fault::TwoHeads {
                first: largest.triangles,
                second: other.triangles,
            });
        }
    }
    let size = largest.diagonal();
    let stays = |piece: &Piece| {
        let speck = piece.diagonal() < SPECK * size;
        let debris = piece.area < DEBRIS_AREA * largest.area
            && piece.distance(largest) > DEBRIS_DISTANCE * size;
        !(speck || debris)
    };
    let stay: Vec<bool> = pieces.iter().map(stays).collect();
    let total: f64 = pieces.iter().map(|p| p.area).sum();
    let kept: f64 = pieces
        .iter()
        .zip(&stay)
        .filter(|(_, s)| **s)
        .map(|(p, _)| p.area)
        .sum();
    if kept < KEPT_AREA * total {
        // Nearly all of it is fragments: nothing tells dirt from data.
        return match largest.triangles {
            0..MIN_TRIANGLES => Err(Fault::Fragments(largest.triangles)),
            _ => Ok(()),
        };
    }
    dropped.islands = stay.iter().filter(|s| !**s).count();
    let before = scan.triangles.len();
    let keep: Vec<bool> = piece_of.iter().map(|&p| stay[p as usize]).collect();
    retain(scan, &keep);
    dropped.island_triangles = before - scan.triangles.len();
    Ok(())
}

/// Per triangle, the number of its piece: union-find over vertices.
fn pieces_of(scan: &Scan) -> Vec<u32> {
    let mut parent: Vec<u32> = (0..scan.positions.len() as u32).collect();
    for &[a, b, c] in &scan.triangles {
        for (i, j) in [(a, b), (b, c)] {
            let (i, j) = (root(&mut parent, i), root(&mut parent, j));
            parent[i.max(j) as usize] = i.min(j);
        }
    }
    let mut number = vec![u32::MAX; parent.len()];
    let mut count = 0;
    let mut of = Vec::with_capacity(scan.triangles.len());
    for t in &scan.triangles {
        let piece = &mut number[root(&mut parent, t[0]) as usize];
        if *piece == u32::MAX {
            *piece = count;
            count += 1;
        }
        of.push(*piece);
    }
    of
}

fn root(parent: &mut [u32], mut i: u32) -> u32 {
    while parent[i as usize] != i {
        // Halving the path keeps it short.
        let up = parent[parent[i as usize] as usize];
        parent[i as usize] = up;
        i = up;
    }
    i
}

fn measure(scan: &Scan, piece_of: &[u32], count: usize) -> Vec<Piece> {
    let empty = Piece {
        triangles: 0,
        area: 0.0,
        centre: glam::DVec3::ZERO,
        square: 0.0,
        low: Vec3::INFINITY,
        high: Vec3::NEG_INFINITY,
    };
    let mut pieces = vec![empty; count];
    for (t, &piece) in scan.triangles.iter().zip(piece_of) {
        let piece = &mut pieces[piece as usize];
        let corners = t.map(|i| scan.positions[i as usize]);
        let [a, b, c] = corners.map(Vec3::as_dvec3);
        let area = (b - a).cross(c - a).length() / 2.0;
        let middle = (a + b + c) / 3.0;
        piece.triangles += 1;
        piece.area += area;
        piece.centre += middle * area;
        piece.square += middle.length_squared() * area;
        for c in corners {
            piece.low = piece.low.min(c);
            piece.high = piece.high.max(c);
        }
    }
    pieces
}
