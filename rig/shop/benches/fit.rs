//! What a fit costs, by stage, on one core: solving and applying warps, closest points, the whole.

#[path = "../tests/synthetic/mod.rs"]
#[allow(dead_code, reason = "shared with tests that use all of it")]
mod synthetic;

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::Vec3;
use mouthpiece_shop::closest::Surface;
use mouthpiece_shop::fit::{Options, fit};
use mouthpiece_shop::warp::Warp;
use synthetic::{Faults, Pair, warp};

fn stages(c: &mut Criterion) {
    let faults = Faults {
        noise_mm: 0.15,
        holes: true,
        clumsy_mm: 0.5,
    };
    let pair = Pair::new(warp(3), 3, faults);
    for n in [60, 600, 1500] {
        // In the open, where no two vertices meet.
        let free = |list: &[Vec3]| -> Vec<Vec3> {
            let free = list
                .iter()
                .zip(&pair.freedom)
                .filter(|(_, f)| **f >= 1.0)
                .map(|(p, _)| *p);
            let step = pair.freedom.iter().filter(|f| **f >= 1.0).count() / n;
            free.step_by(step.max(1)).take(n).collect()
        };
        let (from, to) = (free(&pair.positions), free(&pair.truth));
        c.bench_function(&format!("warp/solve {n}"), |b| {
            b.iter(|| Warp::smoothed(black_box(&from), &to, &vec![1.0; n]));
        });
        let Ok(solved) = Warp::new(&from, &to) else {
            continue;
        };
        let mut out = vec![Vec3::ZERO; pair.positions.len()];
        c.bench_function(&format!("warp/apply {n} to {}", out.len()), |b| {
            b.iter(|| solved.apply(black_box(&pair.positions), &mut out));
        });
    }
    c.bench_function("surface/build", |b| {
        b.iter(|| Surface::new(&pair.scan.0, &pair.scan.1));
    });
    let Ok(scan) = Surface::new(&pair.scan.0, &pair.scan.1) else {
        return;
    };
    let near: Vec<Vec3> = pair
        .truth
        .iter()
        .map(|p| *p + Vec3::new(1.0, -0.5, 1.0))
        .collect();
    c.bench_function(&format!("surface/closest {} points", near.len()), |b| {
        b.iter(|| near.iter().filter_map(|p| scan.closest(*p, 10.0)).count());
    });
    c.bench_function(&format!("fit/{} triangles", pair.scan.1.len()), |b| {
        b.iter(|| {
            let scan = Surface::new(&pair.scan.0, &pair.scan.1).ok()?;
            fit(
                &pair.template(),
                &scan,
                &pair.landmarks,
                &Options::default(),
            )
            .ok()
        });
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20);
    targets = stages
}
criterion_main!(benches);
