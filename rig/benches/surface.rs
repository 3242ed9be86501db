//! What the drawn surface costs: points and normals per frame, and building its stencils once.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::Vec3;
use mouthpiece_rig::{Detail, Head, fit_control};

fn surface(bench: &mut Criterion) {
    let Ok(head) = Head::reference() else {
        return;
    };
    let skin = &head.skin.mesh;
    for levels in 0..3 {
        let detail = Detail {
            levels,
            ..Detail::default()
        };
        let Ok(drawn) = head.subdivision(&detail) else {
            return;
        };
        let mut points = vec![Vec3::ZERO; drawn.point_count()];
        let mut normals = points.clone();
        let size = format!(
            "level {levels}, {} points, {} weights",
            points.len(),
            drawn.stencils().weight_count()
        );
        bench.bench_function(&format!("points, {size}"), |b| {
            b.iter(|| drawn.apply(black_box(&skin.positions), &mut points));
        });
        bench.bench_function(&format!("normals, {size}"), |b| {
            b.iter(|| drawn.normals(black_box(&points), &mut normals));
        });
        bench.bench_function(&format!("build, level {levels}"), |b| {
            b.iter(|| head.subdivision(black_box(&detail)));
        });
    }
    if let Ok(limit) = head.skin_limit() {
        bench.bench_function("fit_control", |b| {
            b.iter(|| fit_control(&limit, black_box(&skin.positions)));
        });
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20);
    targets = surface
}
criterion_main!(benches);
