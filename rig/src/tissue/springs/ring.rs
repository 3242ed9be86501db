//! The neighbours of each node in their order round it, and what share of a cheek's volume each triangle
//! between two of them is.

use super::simd::Neighbour;
use crate::tissue::Numbering;

/// Neighbours of all nodes that move. `rest_mm` is the length of an edge at rest; a triangle counts in a
/// volume when it is among `counted` (sorted).
pub(super) fn rings(
    numbering: &Numbering,
    rest_mm: impl Fn(u32, u32) -> f32,
    counted: &[[u32; 3]],
) -> Vec<Vec<Neighbour>> {
    // Round node i: each triangle leads from one neighbour to the next.
    let mut round: Vec<Vec<(u32, u32, f32)>> = vec![Vec::new(); numbering.movable];
    for t in &numbering.triangles {
        let share = f32::from(u8::from(counted.binary_search(t).is_ok()));
        for k in 0..3 {
            if let Some(list) = round.get_mut(t[k] as usize) {
                list.push((t[(k + 1) % 3], t[(k + 2) % 3], share));
            }
        }
    }
    let ring = |(i, list): (usize, Vec<(u32, u32, f32)>)| walk(list, |j| rest_mm(i as u32, j));
    round.into_iter().enumerate().map(ring).collect()
}

/// One walk after another until all triangles are used; a closed one ends with its first neighbour again, without
/// a spring.
fn walk(mut left: Vec<(u32, u32, f32)>, rest_mm: impl Fn(u32) -> f32) -> Vec<Neighbour> {
    let mut ring: Vec<Neighbour> = Vec::with_capacity(left.len() + 1);
    while !left.is_empty() {
        // An open one begins where no triangle leads to.
        let begin = left
            .iter()
            .position(|(from, ..)| left.iter().all(|(_, to, _)| to != from))
            .unwrap_or(0);
        let mut at = left[begin].0;
        let mut corner = 0.0;
        loop {
            let seen = ring.iter().any(|n| n.node == at && n.rest_mm >= 0.0);
            ring.push(Neighbour {
                node: at,
                rest_mm: if seen { -1.0 } else { rest_mm(at) },
                corner,
            });
            let Some(next) = left.iter().position(|(from, ..)| *from == at) else {
                break;
            };
            (_, at, corner) = left.swap_remove(next);
        }
    }
    // A closing neighbour that no volume needs is no row either.
    while ring
        .last()
        .is_some_and(|n| n.rest_mm < 0.0 && n.corner == 0.0)
    {
        ring.pop();
    }
    ring
}
