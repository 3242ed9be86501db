//! The pass over skin edges: beside kernels in C, over meshes from 3,000 triangles upwards, and by itself.
//!
//! `cargo bench -p mouthpiece-rig --bench springs` prints ratios first (see `turns`), then criterion's figures.

#[path = "../turns/mod.rs"]
mod turns;

mod rivals;
mod sweep;

use std::time::Duration;

use criterion::Criterion;
use mouthpiece_rig::{Head, Isa, SpringPass};
use turns::{TURNS, only_asked, shortest_ns};

/// By how much edges are stretched.
const STRETCH: f32 = 1.02;

/// The shortest pass, ns per edge.
fn ns_per_edge(pass: &mut SpringPass, isa: Isa) -> f64 {
    shortest_ns(|| pass.run(isa)) / pass.edges().len() as f64
}

/// The pass and kernels in C on the same mesh, in turns.
fn beside_c(pass: &mut SpringPass) {
    println!(
        "Spring forces of the reference head's skin: {} edges",
        pass.edges().len()
    );
    let rivals = rivals::Rivals::compile(pass);
    let isas = Isa::all();
    let mut ours = vec![f64::INFINITY; isas.len()];
    let mut theirs: Vec<rivals::Figure> = Vec::new();
    for turn in 0..TURNS {
        for (best, &isa) in ours.iter_mut().zip(&isas) {
            *best = best.min(ns_per_edge(pass, isa));
        }
        let figures = match &rivals {
            Ok(rivals) => rivals.measure(),
            Err(why) if turn == 0 => Err(why.clone()),
            Err(_) => continue,
        };
        match figures {
            Ok(figures) if theirs.is_empty() => theirs = figures,
            Ok(figures) => {
                for (best, new) in theirs.iter_mut().zip(figures) {
                    best.ns = best.ns.min(new.ns);
                }
            }
            Err(why) => println!("No kernels in C beside ours: {why}"),
        }
    }
    for (ns, isa) in ours.iter().zip(&isas) {
        println!("  {ns:6.3} ns an edge  ours, {} lanes", isa.lanes());
    }
    for figure in &theirs {
        println!("  {:6.3} ns an edge  {}", figure.ns, figure.name);
        if figure.difference > 1e-3 {
            println!(
                "         but its forces are off by {:.1e}",
                figure.difference
            );
        }
    }
    let known = |f: &&rivals::Figure| f.name != rivals::OUR_LAYOUT;
    let least = |all: &mut dyn Iterator<Item = f64>| all.fold(f64::INFINITY, f64::min);
    let ours = least(&mut ours.into_iter());
    let best = least(&mut theirs.iter().filter(known).map(|f| f.ns));
    let same = least(&mut theirs.iter().filter(|f| !known(f)).map(|f| f.ns));
    if best.is_finite() {
        println!(
            "spring pass / best C kernel: {:.2} (at most 1.5)",
            ours / best
        );
    }
    if same.is_finite() {
        println!("spring pass / our own layout in C: {:.2}", ours / same);
    }
    println!();
}

fn main() {
    let Ok(head) = Head::reference() else {
        println!("the reference head does not load");
        return;
    };
    let skin = &head.skin.mesh;
    let mut pass = SpringPass::new(&skin.positions, &skin.triangles, STRETCH);
    if !only_asked() {
        beside_c(&mut pass);
        sweep::run();
    }
    let mut bench = Criterion::default()
        .sample_size(20)
        .measurement_time(Duration::from_secs(2))
        .configure_from_args();
    for isa in Isa::all() {
        let name = format!(
            "spring pass, {} edges, {} lanes",
            pass.edges().len(),
            isa.lanes()
        );
        bench.bench_function(&name, |b| b.iter(|| pass.run(isa)));
    }
    bench.final_summary();
}
