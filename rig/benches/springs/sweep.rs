//! The pass over finer and finer meshes: what an edge costs while they fit a cache, and beyond.

use std::collections::HashMap;
use std::fs;

use glam::{DVec3, Vec3, dvec3};
use mouthpiece_rig::{Isa, SpringPass};

use crate::turns::TURNS;
use crate::{STRETCH, ns_per_edge};

/// Pieces that an icosahedron's edges are cut into: 20 n^2 triangles, from 2,880 to 302,580, and some more to
/// see where the last cache ends.
const PIECES: [u32; 11] = [12, 17, 24, 34, 48, 69, 87, 123, 174, 246, 348];
/// Up to here it is the range that is asked for.
const ASKED_TRIANGLES: usize = 310_000;
/// The cache has ended where an edge costs this many times what it costs at best.
const CACHE_ENDS: f64 = 1.5;
/// Radius of a head, mm.
const RADIUS_MM: f64 = 100.0;

struct Size {
    triangles: usize,
    pass: SpringPass,
    ns: f64,
}

/// Measures all sizes in turns and prints the curve.
pub(crate) fn run() {
    let isa = Isa::best();
    let mut sizes: Vec<Size> = PIECES
        .iter()
        .map(|&n| {
            let (positions, triangles) = sphere(n);
            Size {
                triangles: triangles.len(),
                pass: SpringPass::new(&positions, &triangles, STRETCH),
                ns: f64::INFINITY,
            }
        })
        .collect();
    for _ in 0..TURNS {
        for size in &mut sizes {
            size.ns = size.ns.min(ns_per_edge(&mut size.pass, isa));
        }
    }
    let caches = caches();
    println!("Spheres of a head's size, {} lanes", isa.lanes());
    println!("  triangles     edges   bytes (KB)   ns an edge   fits in");
    for size in &sizes {
        let (bytes, edges) = (size.pass.bytes(), size.pass.edges().len());
        let fits = caches.iter().find(|c| bytes <= c.bytes);
        let fits = fits.map_or("memory", |c| &c.name);
        println!(
            "  {:9} {edges:9} {:12} {:12.3}   {fits}",
            size.triangles,
            bytes / 1024,
            size.ns
        );
    }
    for cache in &caches {
        println!("{} holds {} KB", cache.name, cache.bytes / 1024);
    }
    let spread = |fits: &dyn Fn(&Size) -> bool| {
        let ns = || sizes.iter().filter(|s| fits(s)).map(|s| s.ns);
        let ratio = ns().fold(0.0, f64::max) / ns().fold(f64::INFINITY, f64::min);
        (ns().count() > 1).then_some(ratio)
    };
    for cache in &caches {
        if let Some(ratio) = spread(&|s| s.pass.bytes() <= cache.bytes) {
            println!(
                "ns an edge, most / least, of what fits in {}: {ratio:.2}",
                cache.name
            );
        }
    }
    let least = sizes.iter().map(|s| s.ns).fold(f64::INFINITY, f64::min);
    match sizes.iter().find(|s| s.ns > CACHE_ENDS * least) {
        Some(size) => println!("the cache ends before {} triangles", size.triangles),
        None => println!("the cache does not end within these sizes"),
    }
    if let Some(ratio) = spread(&|s| s.triangles < ASKED_TRIANGLES) {
        println!("ns an edge, most / least, up to 300,000 triangles: {ratio:.2}");
    }
    println!();
}

struct Cache {
    name: String,
    bytes: usize,
}

/// The first core's caches for data, the smallest first; none where the system does not tell.
fn caches() -> Vec<Cache> {
    let cache = |index: u32| {
        let word = |file: &str| {
            let folder = "/sys/devices/system/cpu/cpu0/cache";
            let text = fs::read_to_string(format!("{folder}/index{index}/{file}")).ok()?;
            Some(text.trim().to_owned())
        };
        let kb: usize = word("size")?.strip_suffix('K')?.parse().ok()?;
        let cache = Cache {
            name: format!("L{}", word("level")?),
            bytes: kb * 1024,
        };
        (word("type")? != "Instruction").then_some(cache)
    };
    let mut caches: Vec<Cache> = (0..8).filter_map(cache).collect();
    caches.sort_by_key(|c| c.bytes);
    caches
}

/// An icosahedron's faces cut into `n` x `n` triangles each, blown up to a sphere.
fn sphere(n: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (corners, faces) = icosahedron();
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    // A vertex is known by its shares of the icosahedron's corners: those on a face's edge are met again.
    let mut known: HashMap<[(usize, u32); 3], u32> = HashMap::new();
    for face in faces {
        let mut vertex = |i: u32, j: u32| {
            let mut shares = [(face[0], n - i - j), (face[1], i), (face[2], j)];
            for share in &mut shares {
                if share.1 == 0 {
                    share.0 = usize::MAX;
                }
            }
            shares.sort_unstable();
            *known.entry(shares).or_insert_with(|| {
                let at: DVec3 = shares
                    .iter()
                    .filter(|(_, share)| *share > 0)
                    .map(|&(corner, share)| corners[corner] * f64::from(share))
                    .sum();
                positions.push((at * (RADIUS_MM / at.length())).as_vec3());
                positions.len() as u32 - 1
            })
        };
        for i in 0..n {
            for j in 0..n - i {
                let (a, b, c) = (vertex(i, j), vertex(i + 1, j), vertex(i, j + 1));
                triangles.push([a, b, c]);
                if i + j + 1 < n {
                    triangles.push([b, vertex(i + 1, j + 1), c]);
                }
            }
        }
    }
    (positions, triangles)
}

/// Corners of three golden rectangles; a face is three of them that are all neighbours.
fn icosahedron() -> (Vec<DVec3>, Vec<[usize; 3]>) {
    let long = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let signs = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    let corners: Vec<DVec3> = signs
        .iter()
        .flat_map(|(s, l)| {
            let (s, l) = (*s, l * long);
            [dvec3(0.0, s, l), dvec3(s, l, 0.0), dvec3(l, 0.0, s)]
        })
        .collect();
    let near = |a: usize, b: usize| corners[a].distance(corners[b]) < 2.1;
    let mut faces = Vec::new();
    for a in 0..corners.len() {
        for b in (0..a).filter(|&b| near(a, b)) {
            faces.extend(
                (0..b)
                    .filter(|&c| near(a, c) && near(b, c))
                    .map(|c| [a, b, c]),
            );
        }
    }
    (corners, faces)
}
