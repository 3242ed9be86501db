//! What the simulation costs: a sentence with each model of the tissue, and the pass over skin edges alone.
//!
//! Rivals take turns, and of each step of the sentence the shortest run counts: other work on the machine
//! only ever makes a run longer. `cargo bench -p mouthpiece-rig` goes into the parts and compares with kernels in C.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant as Wall;

use mouthpiece_rig::{
    Controls, Head, Isa, STEP_TICKS, Simulation, SpringPass, TICK_RATE, TissueModel,
};
use serde_json::{Map, Value, json};

use super::rounded;

/// Turns that each rival takes.
const TURNS: usize = 5;
/// Passes over all edges in a turn.
const PASSES: usize = 500;
/// Simulations that are held at once to see how much memory each takes, after as many that fill holes.
const HELD: usize = 12;

/// Figures of both models of the tissue, those of the default first.
pub(super) fn models(head: &Arc<Head>, controls: &[Controls]) -> [Value; 2] {
    let mut rivals = [TissueModel::Springs, TissueModel::Layered].map(|model| {
        let mut head = Head::clone(head);
        head.tissue.model = model;
        let simulation = Simulation::new(Arc::new(head));
        (simulation, vec![f64::INFINITY; controls.len()])
    });
    for _ in 0..TURNS {
        for (simulation, shortest) in &mut rivals {
            let mut simulation = simulation.clone();
            for (controls, shortest) in controls.iter().zip(shortest) {
                let started = Wall::now();
                simulation.step(controls);
                *shortest = shortest.min(started.elapsed().as_secs_f64());
            }
        }
    }
    let steps = controls.len().max(1) as f64;
    rivals.map(|(simulation, shortest)| {
        let wall: f64 = shortest.iter().sum();
        let springs = simulation.spring_count();
        json!({
            "realtime_factor": rounded(steps * STEP_TICKS as f64 / TICK_RATE as f64 / wall),
            "us_per_step": rounded(wall * 1e6 / steps),
            "springs": springs,
            "ns_per_spring_step": rounded(wall * 1e9 / (steps * springs.max(1) as f64)),
            "tissue_bytes": simulation.tissue_bytes(),
            "state_mb": state_mb(&simulation),
        })
    })
}

/// The pass over the edges of the head's skin with the best instructions of this processor, and with those of any.
pub(super) fn spring_pass(head: &Head) -> Value {
    let skin = &head.skin.mesh;
    let mut pass = SpringPass::new(&skin.positions, &skin.triangles, 1.02);
    let isas = [Some(Isa::best()), Isa::all().pop()];
    let mut shortest = [f64::INFINITY; 2];
    for _ in 0..TURNS {
        for (isa, shortest) in isas.iter().zip(&mut shortest) {
            for _ in 0..isa.map_or(0, |_| PASSES) {
                let started = Wall::now();
                isa.iter().for_each(|isa| black_box(&mut pass).run(*isa));
                *shortest = shortest.min(started.elapsed().as_secs_f64());
            }
        }
    }
    let edges = pass.edges().len();
    let figures = isas.iter().zip(shortest).zip(["best", "portable"]);
    let mut map = Map::from_iter([("edges".into(), json!(edges))]);
    map.extend(figures.filter_map(|((isa, wall), name)| {
        let ns = rounded(wall * 1e9 / edges.max(1) as f64);
        let lanes = (*isa)?.lanes();
        Some((name.into(), json!({ "lanes": lanes, "ns_per_edge": ns })))
    }));
    Value::Object(map)
}

/// Memory that one more head in motion takes, all of it but the head's own data; where the system tells.
fn state_mb(simulation: &Simulation) -> Option<f64> {
    let clones = || -> Vec<Simulation> { (0..HELD).map(|_| simulation.clone()).collect() };
    let filler = clones();
    let before = resident_kb()?;
    let held = clones();
    let after = resident_kb()?;
    black_box((filler, held));
    let bytes = (after - before) * 1024.0 / HELD as f64;
    // Where the allocator had room left it seems to be less than it is.
    Some(rounded(bytes.max(simulation.tissue_bytes() as f64) / 1e6))
}

fn resident_kb() -> Option<f64> {
    crate::memory::status_kb("VmRSS:")
}
