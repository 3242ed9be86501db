//! Joined muscles at a moment: each node where its muscles want it, then a few iterations along the springs
//! (HABER 5.1), and back to the fibres.

use glam::{Affine3A, Mat3, Vec3};

use super::{IDLE, Joined};
use crate::muscle::{carried, chord, length, straighten};

/// HABER: three or four are enough, and they depend on the longest way among the nodes (here 3 springs).
const ITERATIONS: usize = 4;
/// How much more a linear muscle counts that works fully than a sphincter that does: it is the stronger.
const STRONGER: f32 = 4.0;
/// Stiffness of a spring along a relaxed sphincter, and what full work adds.
const SPRING: f32 = 0.35;
const SPRING_WORK: f32 = 0.5;
/// Share of a spring that resists turning; the rest resists only another length.
const UNTURNED: f32 = 0.5;
/// The muscles never draw a modiolus farther than this, mm (a full smile moves it by some 12).
const MODIOLUS_MAX_MM: f32 = 13.0;

impl Joined {
    /// Moves the points of joined fibres from where each would be alone to where they are together.
    /// `works` says how hard each fibre works, 0 to 1.
    pub(crate) fn resolve(
        &mut self,
        works: &[f32],
        mandible: &Affine3A,
        rest: &[Vec3],
        starts: &[usize],
        points: &mut [Vec3],
    ) {
        self.meet(works, rest, starts, points);
        for _ in 0..ITERATIONS {
            self.relax(works);
        }
        for (node, shift) in self
            .nodes
            .iter()
            .zip(&mut self.now)
            .filter(|(n, _)| n.bounded)
        {
            let jaw = carried(node.rest, node.mandible, mandible) - node.rest;
            *shift = jaw + bound(*shift - jaw, MODIOLUS_MAX_MM);
        }
        self.hand_back(rest, starts, points);
    }

    /// Every node goes to the weighted mean of its muscles.
    fn meet(&mut self, works: &[f32], rest: &[Vec3], starts: &[usize], points: &[Vec3]) {
        self.weight.fill(Mat3::ZERO);
        self.pull.fill(Vec3::ZERO);
        let mut slot = 0;
        for ring in &self.rings {
            let weight = IDLE + works[ring.fibres.start];
            for (node, places) in ring.nodes.iter().zip(&ring.places) {
                let sum: Vec3 = places.iter().map(|p| p.on(points) - p.on(rest)).sum();
                let own = sum / places.len().max(1) as f32;
                self.own[slot] = own;
                slot += 1;
                self.weight[*node as usize] += Mat3::from_diagonal(Vec3::splat(weight));
                self.pull[*node as usize] += own * weight;
            }
        }
        for tie in &self.ties {
            let end = starts[tie.fibre + 1] - 1;
            let own = points[end] - rest[end];
            for (node, share) in tie.along.ends() {
                let weight = tie.weight * (share * (tie.idle + STRONGER * works[tie.fibre]));
                self.weight[node] += weight;
                self.pull[node] += weight * own;
            }
        }
        for ((now, pull), weight) in self.now.iter_mut().zip(&self.pull).zip(&self.weight) {
            *now = weight.inverse() * *pull;
        }
        // What the iterations divide by: the springs' stiffness resists in all directions.
        self.stiffness.fill(0.0);
        for ring in &self.rings {
            let stiffness = SPRING + SPRING_WORK * works[ring.fibres.start];
            for (i, j) in ring.spans() {
                self.stiffness[ring.nodes[i] as usize] += stiffness;
                self.stiffness[ring.nodes[j] as usize] += stiffness;
            }
        }
        for ((solve, weight), s) in self.solve.iter_mut().zip(&self.weight).zip(&self.stiffness) {
            *solve = (*weight + Mat3::from_diagonal(Vec3::splat(*s))).inverse();
        }
    }

    /// One iteration: every node goes to the mean of where its muscles and its springs want it.
    fn relax(&mut self, works: &[f32]) {
        self.next.copy_from_slice(&self.pull);
        let mut base = 0;
        for ring in &self.rings {
            let stiffness = SPRING + SPRING_WORK * works[ring.fibres.start];
            for (i, j) in ring.spans() {
                let (a, b) = (ring.nodes[i] as usize, ring.nodes[j] as usize);
                let apart = self.nodes[b].rest - self.nodes[a].rest;
                let alone = apart + self.own[base + j] - self.own[base + i];
                let is = apart + self.now[b] - self.now[a];
                let as_long = is * (alone.length() / is.length().max(1e-3));
                let wanted = as_long.lerp(alone, UNTURNED) - apart;
                self.next[a] += (self.now[b] - wanted) * stiffness;
                self.next[b] += (self.now[a] + wanted) * stiffness;
            }
            base += ring.nodes.len();
        }
        for ((now, next), solve) in self.now.iter_mut().zip(&self.next).zip(&self.solve) {
            *now = *solve * *next;
        }
    }

    /// Fibres follow their nodes: sphincters between two of them, linear ones from their origin on, which
    /// draws them straight.
    fn hand_back(&self, rest: &[Vec3], starts: &[usize], points: &mut [Vec3]) {
        let mut base = 0;
        for ring in &self.rings {
            let shift = |k: u32| {
                let k = k as usize;
                self.now[ring.nodes[k] as usize] - self.own[base + k]
            };
            for (point, along) in &ring.along {
                points[*point as usize] += shift(along.a).lerp(shift(along.b), along.share);
            }
            base += ring.nodes.len();
        }
        for tie in &self.ties {
            let range = starts[tie.fibre]..starts[tie.fibre + 1];
            let end = range.end - 1;
            let there = self.now[tie.along.a as usize]
                .lerp(self.now[tie.along.b as usize], tie.along.share);
            let drawn = (there - (points[end] - rest[end])) * tie.hold;
            let fibre = &mut points[range];
            let (chord, length) = (chord(fibre), length(fibre));
            for (point, share) in fibre.iter_mut().zip(&tie.shares) {
                *point += drawn * *share;
            }
            straighten(fibre, chord, length);
        }
    }
}

/// `v`, but never longer than `most`, which it approaches smoothly.
fn bound(v: Vec3, most: f32) -> Vec3 {
    let over = v.length_squared() / (most * most);
    v / (1.0 + over * over).sqrt().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::muscle::Measure;
    use crate::{Control, Controls, Head};

    /// How much longer or shorter the springs are than rest has them, squared, mm2.
    fn distortion(joined: &Joined) -> f32 {
        let (mut sum, mut base) = (0.0, 0);
        for ring in &joined.rings {
            for (i, j) in ring.spans() {
                let (a, b) = (ring.nodes[i] as usize, ring.nodes[j] as usize);
                let apart = joined.nodes[b].rest - joined.nodes[a].rest;
                let is = apart + joined.now[b] - joined.now[a];
                let alone = apart + joined.own[base + j] - joined.own[base + i];
                sum += (is.length() - alone.length()).powi(2);
            }
            base += ring.nodes.len();
        }
        sum
    }

    #[test]
    fn distortion_of_the_springs_falls_in_the_iterations() -> Result<(), crate::HeadError> {
        let head = Head::reference()?;
        let mut starts = vec![0];
        for fibre in &head.fibres {
            starts.push(starts[starts.len() - 1] + fibre.points.len());
        }
        let mut controls = Controls::default();
        controls[Control::ZygomaticusMajor] = 1.0;
        controls[Control::OrbicularisOrisInferior] = 0.3;
        let still = Affine3A::IDENTITY;
        let rest: Vec<Vec3> = head.fibres.iter().flat_map(|f| f.points.clone()).collect();
        let (mut points, mut works) = (rest.clone(), Vec::new());
        for (k, fibre) in head.fibres.iter().enumerate() {
            let measure = Measure::new(fibre);
            works.push(fibre.works(&measure, &controls));
            fibre.contract(
                &measure,
                &controls,
                &still,
                &mut points[starts[k]..starts[k + 1]],
            );
        }
        let mut groups = Joined::find(&head.fibres, &starts);
        assert_eq!(groups.len(), 3, "a mouth and two eyes");
        let mouth = &mut groups[0];
        assert_eq!(mouth.nodes.len(), 12, "two corners, five nodes on each lip");
        mouth.meet(&works, &rest, &starts, &points);
        let first = distortion(mouth);
        let fallen: Vec<f32> = (0..ITERATIONS)
            .map(|_| {
                mouth.relax(&works);
                distortion(mouth) / first
            })
            .collect();
        assert!(fallen.iter().all(|share| *share < 0.7), "{fallen:?}");
        assert!(fallen[ITERATIONS - 1] < 0.5, "{fallen:?}");
        Ok(())
    }

    #[test]
    fn the_modiolus_is_bounded_smoothly() {
        let gone = |mm: f32| bound(Vec3::new(mm, 0.0, 0.0), MODIOLUS_MAX_MM).x;
        assert!((gone(5.0) - 5.0).abs() < 0.05, "little is left alone");
        assert!(gone(12.0) > gone(11.0) && gone(40.0) < MODIOLUS_MAX_MM);
    }
}
