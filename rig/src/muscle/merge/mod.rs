//! Where muscles merge: nodes that they share, joined by springs along the muscles (HABER 5.1).
//!
//! Along each sphincter lie nodes; both halves of the orbicularis oris share those at the corners of the
//! mouth, and there the muscles of the corner end as well: that is the modiolus. A node first goes to the
//! mean of where its muscles would be each alone, weighted by how hard they work; then springs along the
//! sphincters, as long as these alone would be, even out the rest in a few iterations, and what came of it
//! is handed back to the fibres. Nothing is remembered from step to step, nothing allocated.

mod resolve;

use std::ops::Range;

use glam::{Mat3, Vec3};

use super::{Contraction, Fibre, chord, length};
use crate::Muscle;

/// A linear muscle merges into a sphincter within this distance of its insertion, mm.
const REACH_MM: f32 = 17.0;
/// Springs along half of the orbicularis oris, and round the orbicularis oculi: few, so that the
/// iterations reach from a corner of the mouth to the middle.
const SPANS_OPEN: usize = 6;
const SPANS_CLOSED: usize = 8;
/// How much a relaxed muscle counts at a node beside one that works fully (1 more).
const IDLE: f32 = 0.12;
/// The same of a muscle of the corner, which has to hold that one against the sphincter.
const IDLE_CORNER: f32 = 0.2;
/// The same of a muscle that ends in a lip rather than at its corner: it lies loose.
const IDLE_LIP: f32 = 0.03;
/// What a linear muscle counts across its own direction, against along it: it draws, and does not steer.
const ACROSS: f32 = 0.15;

/// A place on a fibre: between a control point, by its number among all, and the next.
#[derive(Clone, Copy, Debug)]
struct Place {
    point: u32,
    share: f32,
}

impl Place {
    fn on(self, points: &[Vec3]) -> Vec3 {
        let i = self.point as usize;
        points[i].lerp(points[i + 1], self.share)
    }
}

/// Where muscles are joined.
#[derive(Clone, Debug)]
struct Node {
    rest: Vec3,
    mandible: f32,
    bounded: bool,
}

/// A place along nodes: from `a` a share of the way to `b`.
#[derive(Clone, Copy, Debug)]
struct Along {
    a: u32,
    b: u32,
    share: f32,
}

/// A sphincter, or half of one.
#[derive(Clone, Debug)]
struct Ring {
    fibres: Range<usize>,
    /// Its nodes in order, and at each the places on its fibres.
    nodes: Vec<u32>,
    places: Vec<Vec<Place>>,
    closed: bool,
    /// Per control point of its fibres: where along its nodes.
    along: Vec<(u32, Along)>,
}

/// A linear fibre's insertion.
#[derive(Clone, Debug)]
struct Tie {
    fibre: usize,
    along: Along,
    /// Weight at the nodes by direction, and how firmly the fibre follows them.
    weight: Mat3,
    idle: f32,
    hold: f32,
    /// Share of the way from its origin of each of its points.
    shares: Vec<f32>,
}

/// Muscles that are joined by nodes.
#[derive(Clone, Debug)]
pub(crate) struct Joined {
    nodes: Vec<Node>,
    rings: Vec<Ring>,
    ties: Vec<Tie>,
    /// Scratch, per node: displacement, the next one, summed weights and pulls.
    now: Vec<Vec3>,
    next: Vec<Vec3>,
    weight: Vec<Mat3>,
    stiffness: Vec<f32>,
    solve: Vec<Mat3>,
    pull: Vec<Vec3>,
    /// Scratch: per ring and node of it, the ring's own displacement.
    own: Vec<Vec3>,
}

impl Joined {
    /// All groups of joined muscles among `fibres`; `starts` says where each one's points begin.
    pub(crate) fn find(fibres: &[Fibre], starts: &[usize]) -> Vec<Self> {
        let mut groups: Vec<Self> = Vec::new();
        let mut first = 0;
        while first < fibres.len() {
            let muscle = fibres[first].muscle;
            let left = |f: &Fibre| f.points.iter().map(|p| p.x).sum::<f32>() > 0.0;
            let whole = |m| {
                matches!(
                    m,
                    Muscle::OrbicularisOrisSuperior | Muscle::OrbicularisOrisInferior
                )
            };
            let alike = |f: &Fibre| {
                f.muscle == muscle && (whole(muscle) || left(f) == left(&fibres[first]))
            };
            let count = fibres[first..].iter().take_while(|f| alike(f)).count();
            let range = first..first + count;
            first += count;
            let round = matches!(
                fibres[range.start].contraction,
                Contraction::Sphincter { .. }
            );
            // The part of the orbicularis oculi in the lids works alone.
            if !round || muscle == Muscle::OrbicularisOculiPalpebral {
                continue;
            }
            let mouth = whole(muscle);
            let other = groups
                .iter_mut()
                .find(|g| mouth && g.rings.iter().any(|r| whole(fibres[r.fibres.start].muscle)));
            match other {
                Some(group) => group.add_ring(fibres, starts, range),
                None => {
                    let mut group = Self::empty();
                    group.add_ring(fibres, starts, range);
                    groups.push(group);
                }
            }
        }
        for group in &mut groups {
            group.tie(fibres);
            let count = group.nodes.len();
            group.now = vec![Vec3::ZERO; count];
            group.next = group.now.clone();
            group.pull = group.now.clone();
            group.weight = vec![Mat3::ZERO; count];
            group.solve = group.weight.clone();
            group.stiffness = vec![0.0; count];
            group.own = vec![Vec3::ZERO; group.rings.iter().map(|r| r.nodes.len()).sum()];
        }
        groups
    }

    fn empty() -> Self {
        Self {
            nodes: Vec::new(),
            rings: Vec::new(),
            ties: Vec::new(),
            now: Vec::new(),
            next: Vec::new(),
            weight: Vec::new(),
            stiffness: Vec::new(),
            solve: Vec::new(),
            pull: Vec::new(),
            own: Vec::new(),
        }
    }

    /// Nodes along a sphincter; its ends are those of one that is there already.
    fn add_ring(&mut self, fibres: &[Fibre], starts: &[usize], range: Range<usize>) {
        let first = &fibres[range.start].points;
        let closed = chord(first) < 0.1 * length(first);
        let spans = if closed { SPANS_CLOSED } else { SPANS_OPEN };
        let count = if closed { spans } else { spans + 1 };
        let (mut nodes, mut places) = (Vec::new(), Vec::new());
        for k in 0..count {
            let share = k as f32 / spans as f32;
            let here: Vec<Place> = range
                .clone()
                .map(|f| place_at(&fibres[f].points, starts[f], share))
                .collect();
            let mean = |of: &dyn Fn(usize, usize) -> Vec3| {
                let sum: Vec3 = range
                    .clone()
                    .zip(&here)
                    .map(|(f, place)| {
                        let i = place.point as usize - starts[f];
                        of(f, i).lerp(of(f, i + 1), place.share)
                    })
                    .sum();
                sum / here.len().max(1) as f32
            };
            let rest = mean(&|f, i| fibres[f].points[i]);
            let mandible = mean(&|f, i| Vec3::splat(fibres[f].mandible[i])).x;
            let end = !closed && (k == 0 || k == spans);
            let shared = self.rings.first().filter(|_| end).map(|r| {
                if k == 0 {
                    r.nodes[0]
                } else {
                    r.nodes[r.nodes.len() - 1]
                }
            });
            let number = if let Some(number) = shared {
                let node = &mut self.nodes[number as usize];
                node.rest = (node.rest + rest) * 0.5;
                node.mandible = (node.mandible + mandible) * 0.5;
                number
            } else {
                self.nodes.push(Node {
                    rest,
                    mandible,
                    bounded: end,
                });
                self.nodes.len() as u32 - 1
            };
            nodes.push(number);
            places.push(here);
        }
        let mut along = Vec::new();
        for f in range.clone() {
            let points = &fibres[f].points;
            let whole = length(points).max(1e-3);
            for i in 0..points.len() {
                let share = length(&points[..=i]) / whole;
                along.push((
                    (starts[f] + i) as u32,
                    Along::new(nodes.len(), closed, share),
                ));
            }
        }
        self.rings.push(Ring {
            fibres: range,
            nodes,
            places,
            closed,
            along,
        });
    }

    /// Ties the insertions of linear fibres to the nodes.
    fn tie(&mut self, fibres: &[Fibre]) {
        for (f, fibre) in fibres.iter().enumerate() {
            let Some(&insertion) = fibre.points.last() else {
                continue;
            };
            if fibre.contraction != Contraction::Linear {
                continue;
            }
            // The nearest place of the sphincters that it can merge into.
            let mut best: Option<(f32, usize, f32)> = None;
            for (r, ring) in self.rings.iter().enumerate() {
                if !merge_into(fibre.muscle, fibres[ring.fibres.start].muscle) {
                    continue;
                }
                for other in &fibres[ring.fibres.clone()] {
                    let (distance, share) = nearest(&other.points, insertion);
                    if distance < REACH_MM && best.is_none_or(|b| distance < b.0) {
                        best = Some((distance, r, share));
                    }
                }
            }
            let Some((distance, r, share)) = best else {
                continue;
            };
            let ring = &self.rings[r];
            let share = if at_modiolus(fibre.muscle) {
                share.round()
            } else {
                share
            };
            let mut along = Along::new(ring.nodes.len(), ring.closed, share);
            (along.a, along.b) = (ring.nodes[along.a as usize], ring.nodes[along.b as usize]);
            let whole = length(&fibre.points).max(1e-3);
            let hold = if at_modiolus(fibre.muscle) && fibre.muscle != Muscle::Platysma {
                1.0
            } else {
                1.0 - (distance / REACH_MM).powi(2)
            };
            self.ties.push(Tie {
                fibre: f,
                along,
                weight: along_and_across(insertion - fibre.points[0]) * hold,
                idle: if at_modiolus(fibre.muscle) {
                    IDLE_CORNER
                } else {
                    IDLE_LIP
                },
                hold,
                shares: (0..fibre.points.len())
                    .map(|i| length(&fibre.points[..=i]) / whole)
                    .collect(),
            });
        }
        // Fibres of one muscle together pull no harder than one.
        let muscle = |t: &Tie| fibres[t.fibre].muscle;
        let counts: Vec<f32> = self
            .ties
            .iter()
            .map(|t| {
                let near = |o: &&Tie| {
                    muscle(o) == muscle(t)
                        && fibres[o.fibre].points[0].x * fibres[t.fibre].points[0].x > 0.0
                };
                self.ties.iter().filter(near).count() as f32
            })
            .collect();
        for (tie, count) in self.ties.iter_mut().zip(counts) {
            tie.weight *= (2.0 / count).min(1.0);
        }
    }

    /// The fibres that are joined here.
    pub(crate) fn fibres(&self) -> impl Iterator<Item = usize> {
        let rings = self.rings.iter().flat_map(|r| r.fibres.clone());
        rings.chain(self.ties.iter().map(|t| t.fibre))
    }
}

impl Along {
    /// Where on the nodes of a sphincter a share of its length is; by their order in it.
    fn new(count: usize, closed: bool, share: f32) -> Self {
        let spans = if closed { count } else { count - 1 };
        let place = share.clamp(0.0, 1.0) * spans as f32;
        let a = (place as usize).min(spans - 1);
        Self {
            a: a as u32,
            b: ((a + 1) % count) as u32,
            share: place - a as f32,
        }
    }

    fn ends(self) -> [(usize, f32); 2] {
        [
            (self.a as usize, 1.0 - self.share),
            (self.b as usize, self.share),
        ]
    }
}

impl Ring {
    /// Neighbouring nodes, by their order in it.
    fn spans(&self) -> impl Iterator<Item = (usize, usize)> {
        let count = self.nodes.len();
        let spans = if self.closed { count } else { count - 1 };
        (0..spans).map(move |i| (i, (i + 1) % count))
    }
}

/// Weights of a linear muscle that runs in this direction.
fn along_and_across(direction: Vec3) -> Mat3 {
    let d = direction.normalize_or(Vec3::X);
    Mat3::from_cols(d * d.x, d * d.y, d * d.z) * (1.0 - ACROSS)
        + Mat3::from_diagonal(Vec3::splat(ACROSS))
}

/// Where on a fibre, whose points begin at `start`, a share of its length is.
fn place_at(points: &[Vec3], start: usize, share: f32) -> Place {
    let mut left = length(points) * share;
    for (i, w) in points.windows(2).enumerate() {
        let along = w[0].distance(w[1]);
        if left <= along || i + 2 == points.len() {
            return Place {
                point: (start + i) as u32,
                share: (left / along.max(1e-6)).clamp(0.0, 1.0),
            };
        }
        left -= along;
    }
    Place {
        point: start as u32,
        share: 0.0,
    }
}

/// How near a polygon comes to a place, and at which share of its length.
fn nearest(points: &[Vec3], place: Vec3) -> (f32, f32) {
    let (mut best, mut before) = ((f32::MAX, 0.0), 0.0);
    for w in points.windows(2) {
        let d = w[1] - w[0];
        let share = ((place - w[0]).dot(d) / d.length_squared().max(1e-6)).clamp(0.0, 1.0);
        let distance = place.distance(w[0] + d * share);
        if distance < best.0 {
            best = (distance, before + share * d.length());
        }
        before += d.length();
    }
    (best.0, best.1 / before.max(1e-3))
}

/// Whether a linear muscle ends at the modiolus, the node of muscles beside the corner of the mouth.
const fn at_modiolus(linear: Muscle) -> bool {
    matches!(
        linear,
        Muscle::ZygomaticusMajor
            | Muscle::LevatorAnguliOris
            | Muscle::Risorius
            | Muscle::Buccinator
            | Muscle::DepressorAnguliOris
            | Muscle::Platysma
    )
}

/// Whether fibres of a linear muscle end among those of a sphincter. Raisers of the upper lip end in the
/// upper half of the orbicularis oris, depressors of the lower lip in the lower one; what moves the brows
/// ends in the orbital part of the orbicularis oculi.
const fn merge_into(linear: Muscle, sphincter: Muscle) -> bool {
    use Muscle::{
        CorrugatorSupercilii, DepressorLabiiInferioris, DepressorSupercilii, FrontalisInner,
        FrontalisOuter, LevatorLabiiSuperioris, LevatorLabiiSuperiorisAlaequeNasi,
        OrbicularisOculiOrbital, OrbicularisOrisInferior, OrbicularisOrisSuperior,
        ZygomaticusMinor,
    };
    match linear {
        LevatorLabiiSuperioris | LevatorLabiiSuperiorisAlaequeNasi | ZygomaticusMinor => {
            matches!(sphincter, OrbicularisOrisSuperior)
        }
        DepressorLabiiInferioris => matches!(sphincter, OrbicularisOrisInferior),
        FrontalisInner | FrontalisOuter | CorrugatorSupercilii | DepressorSupercilii => {
            matches!(sphincter, OrbicularisOculiOrbital)
        }
        _ => {
            at_modiolus(linear)
                && matches!(sphincter, OrbicularisOrisSuperior | OrbicularisOrisInferior)
        }
    }
}
