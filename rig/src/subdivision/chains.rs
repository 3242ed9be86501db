//! Puts sharp edges in order: each chain runs from the corner with the lower number to the other, so
//! that two creases between the same corners (the lips' contact lines) are summed in the same order and
//! coincide to the bit where their control points do. Used by `level` on the control mesh only.

/// Turns the ends of the sharp edges round so that chains run one way. `fixed` are the corners;
/// `at` lists the sharp edges at each vertex.
pub(super) fn orient(edges: &mut [[u32; 2]], at: &[Vec<u32>], fixed: &[bool]) {
    let mut done = vec![false; edges.len()];
    let starts = (0..at.len()).filter(|&v| fixed[v]);
    // What no corner reaches is a loop: any of its vertices will do.
    for start in starts.chain(0..at.len()) {
        for &first in &at[start] {
            let (mut vertex, mut edge) = (start as u32, Some(first));
            while let Some(e) = edge.filter(|&e| !done[e as usize]) {
                done[e as usize] = true;
                let ends = &mut edges[e as usize];
                if ends[0] != vertex {
                    ends.swap(0, 1);
                }
                vertex = ends[1];
                edge = at[vertex as usize]
                    .iter()
                    .copied()
                    .find(|&next| !fixed[vertex as usize] && !done[next as usize]);
            }
        }
    }
}
