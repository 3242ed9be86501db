//! Who is whose neighbour on a mesh: edges with their uses, and rings of vertices. For borders, smoothness and relaxing.

/// An edge and how many triangles use it: one on a border, two inside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// The two vertices, smaller number first.
    pub vertices: [u32; 2],
    /// How many triangles.
    pub uses: u32,
}

/// Every edge once. Sorted by counting, as scans have hundreds of thousands.
pub fn shared_edges(vertices: usize, triangles: &[[u32; 3]]) -> Vec<Edge> {
    let sides = || {
        triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
    };
    let mut start = vec![0_u32; vertices + 1];
    for [a, b] in sides() {
        start[a.min(b) as usize + 1] += 1;
    }
    for v in 0..vertices {
        start[v + 1] += start[v];
    }
    let mut next = start.clone();
    let mut far = vec![0_u32; triangles.len() * 3];
    for [a, b] in sides() {
        let slot = &mut next[a.min(b) as usize];
        far[*slot as usize] = a.max(b);
        *slot += 1;
    }
    let mut edges = Vec::with_capacity(triangles.len() * 3 / 2 + 16);
    for v in 0..vertices {
        let ends = &mut far[start[v] as usize..start[v + 1] as usize];
        ends.sort_unstable();
        for group in ends.chunk_by(|a, b| a == b) {
            if group[0] != v as u32 {
                edges.push(Edge {
                    vertices: [v as u32, group[0]],
                    uses: group.len() as u32,
                });
            }
        }
    }
    edges
}

/// The neighbours of every vertex, one after the other.
#[derive(Debug, Clone)]
pub struct Rings {
    start: Vec<u32>,
    neighbours: Vec<u32>,
}

impl Rings {
    /// From edges, each given once.
    pub fn new(vertices: usize, edges: impl Iterator<Item = [u32; 2]> + Clone) -> Self {
        let mut start = vec![0_u32; vertices + 1];
        for [a, b] in edges.clone() {
            start[a as usize + 1] += 1;
            start[b as usize + 1] += 1;
        }
        for v in 0..vertices {
            start[v + 1] += start[v];
        }
        let mut next = start.clone();
        let mut neighbours = vec![0; start[vertices] as usize];
        for [a, b] in edges {
            for (from, to) in [(a, b), (b, a)] {
                neighbours[next[from as usize] as usize] = to;
                next[from as usize] += 1;
            }
        }
        Self { start, neighbours }
    }

    /// The neighbours of a vertex.
    pub fn of(&self, vertex: usize) -> &[u32] {
        &self.neighbours[self.span(vertex)]
    }

    /// Where the neighbours of a vertex stand in a list of all neighbours.
    pub fn span(&self, vertex: usize) -> std::ops::Range<usize> {
        self.start[vertex] as usize..self.start[vertex + 1] as usize
    }

    /// An entry of that list.
    pub fn entry(&self, place: usize) -> usize {
        self.neighbours[place] as usize
    }

    /// Adds to a set of vertices all their neighbours.
    pub fn grow(&self, set: &mut [bool]) {
        let before = set.to_vec();
        for v in (0..before.len()).filter(|&v| before[v]) {
            for &n in self.of(v) {
                set[n as usize] = true;
            }
        }
    }
}
