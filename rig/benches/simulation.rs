//! The whole simulation of the reference head: everything on, and without one part after the other.
//!
//! `cargo bench -p mouthpiece-rig --bench simulation` prints ratios first (see `turns`), then criterion's figures.
//! All move by the same controls; of every step the shortest of all turns counts.

#[path = "turns/mod.rs"]
mod turns;

use std::sync::Arc;
use std::time::{Duration, Instant};

use criterion::Criterion;
use mouthpiece_rig::{Control, Controls, Head, STEP_TICKS, Simulation, TICK_RATE, TissueModel};
use turns::{TURNS, only_asked};

/// Steps that are measured, after those that bring the head into motion.
const STEPS: usize = 480;
const WARM: usize = 48;
/// Steps from one target of a control to its next: eight a second, about as fast as phones.
const HOLD: usize = 60;

/// What is taken away.
type Change = fn(&mut Simulation);

struct Rival {
    name: &'static str,
    simulation: Simulation,
    controls: Vec<Controls>,
    /// The shortest run of each step, s.
    shortest: Vec<f64>,
}

impl Rival {
    fn new(name: &'static str, head: &Arc<Head>, controls: &[Controls], change: Change) -> Self {
        let mut simulation = Simulation::new(Arc::clone(head));
        change(&mut simulation);
        Self {
            name,
            simulation,
            controls: controls.to_vec(),
            shortest: vec![f64::INFINITY; STEPS],
        }
    }

    /// From rest once through all controls.
    fn turn(&mut self) {
        let mut simulation = self.simulation.clone();
        let (warm, measured) = self.controls.split_at(WARM);
        for controls in warm {
            simulation.step(controls);
        }
        for (controls, shortest) in measured.iter().zip(&mut self.shortest) {
            let start = Instant::now();
            simulation.step(controls);
            *shortest = shortest.min(start.elapsed().as_secs_f64());
        }
    }

    fn step_s(&self) -> f64 {
        self.shortest.iter().sum::<f64>() / self.shortest.len() as f64
    }
}

/// Half of each control's range, from one random target smoothly to the next.
fn moving() -> Vec<Controls> {
    let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = move || {
        // Knuth's multiplier: the upper bits are random enough for a motion.
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 40) as f32 / (1_u64 << 24) as f32
    };
    let mut target = || {
        let mut controls = Controls::default();
        for &control in Control::ALL {
            let (min, max) = control.range();
            controls[control] = 0.5 * (min + (max - min) * random());
        }
        controls
    };
    let (mut from, mut to) = (Controls::default(), target());
    let mut all = Vec::with_capacity(WARM + STEPS);
    for step in 0..WARM + STEPS {
        let t = (step % HOLD) as f32 / HOLD as f32;
        let share = t * t * (3.0 - 2.0 * t);
        let mut controls = from;
        for &control in Control::ALL {
            controls[control] += share * (to[control] - from[control]);
        }
        all.push(controls);
        if (step + 1) % HOLD == 0 {
            (from, to) = (to, target());
        }
    }
    all
}

/// The same without the muscles: jaw, tongue, lids, eyes and head still move.
fn idle(moving: &[Controls]) -> Vec<Controls> {
    let still = |control: &Control| {
        (*control as usize) < Control::Jaw as usize
            || (*control as usize) > Control::HeadRoll as usize
    };
    let mut all = moving.to_vec();
    for controls in &mut all {
        for &control in Control::ALL.iter().filter(|c| still(c)) {
            controls[control] = 0.0;
        }
    }
    all
}

fn ratios(rivals: &mut [Rival]) {
    for _ in 0..6 * TURNS {
        for rival in &mut *rivals {
            rival.turn();
        }
    }
    let step_s = STEP_TICKS as f64 / TICK_RATE as f64;
    println!("A step of the reference head, {STEPS} steps of seeded motion");
    println!("    springs      KB   us a step   x real time   / everything on");
    let whole = rivals[0].step_s();
    for rival in rivals {
        let (simulation, step) = (&rival.simulation, rival.step_s());
        println!(
            "  {:9} {:7} {:11.1} {:13.1} {:17.2}   {}",
            simulation.spring_count(),
            simulation.tissue_bytes() / 1024,
            step * 1e6,
            step_s / step,
            step / whole,
            rival.name
        );
    }
    println!();
}

fn main() {
    let Ok(head) = Head::reference() else {
        println!("the reference head does not load");
        return;
    };
    let mut layered = head.clone();
    layered.tissue.model = TissueModel::Layered;
    let (head, layered) = (Arc::new(head), Arc::new(layered));
    let (all, rest) = (moving(), vec![Controls::default(); WARM + STEPS]);
    let idle = idle(&all);
    let mut rivals = [
        Rival::new("everything on", &head, &all, |_| {}),
        Rival::new("without contact", &head, &all, |s| s.set_contacts(false)),
        Rival::new("lips do not stop each other", &head, &all, |s| {
            s.set_lip_contact(false);
        }),
        Rival::new("without volume of the cheeks", &head, &all, |s| {
            s.set_volume_stiffness(0.0);
        }),
        Rival::new("muscles idle", &head, &idle, |_| {}),
        Rival::new("at rest", &head, &rest, |_| {}),
        Rival::new("layered tissue, everything on", &layered, &all, |_| {}),
        Rival::new("layered tissue without contact", &layered, &all, |s| {
            s.set_contacts(false);
        }),
    ];
    if !only_asked() {
        ratios(&mut rivals);
    }
    let mut bench = Criterion::default()
        .sample_size(20)
        .measurement_time(Duration::from_secs(2))
        .configure_from_args();
    for rival in &mut rivals {
        let (simulation, controls) = (&mut rival.simulation, &rival.controls);
        let mut steps = controls.iter().cycle();
        bench.bench_function(&format!("a step, {}", rival.name), |b| {
            b.iter(|| steps.next().map(|controls| simulation.step(controls)));
        });
    }
    bench.final_summary();
}
