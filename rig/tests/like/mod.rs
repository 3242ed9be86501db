//! Heads for tests of the file, and how alike two are.
#![allow(
    clippy::unwrap_used,
    reason = "helpers of tests; clippy sees only test functions"
)]

use std::sync::OnceLock;

use glam::{Vec2, Vec3};
use mouthpiece_rig::{
    ColourMap, GridPoint, Head, Landmark, Layer, Muscle, MuscleGrid, SurfacePoint, TissueModel,
    TissueRecord, rebuild,
};

pub(crate) fn reference() -> &'static Head {
    static HEAD: OnceLock<Head> = OnceLock::new();
    HEAD.get_or_init(|| Head::reference().unwrap())
}

/// The reference head with something in every field: islands in its texture, a colour map, a landmark.
pub(crate) fn decorated() -> Head {
    let mut head = reference().clone();
    let skin = &mut head.skin;
    skin.wedges = skin
        .mesh
        .triangles
        .iter()
        .map(|t| {
            let island = f32::from(u8::from(t[0] % 7 == 0));
            t.map(|v| skin.mesh.uvs[v as usize] + Vec2::new(island, 0.0))
        })
        .collect();
    let [a, b, c] = skin.mesh.triangles[0];
    skin.creases = vec![[a, b], [b, c]];
    head.landmarks = vec![Landmark {
        name: "prn".into(),
        layer: Layer::Skin,
        at: SurfacePoint {
            vertices: [a, b, c],
            shares: [0.25, 0.5, 0.25],
        },
        of: None,
    }];
    head.muscles = vec![grid(&head, Muscle::Risorius), grid(&head, Muscle::Mentalis)];
    let bones = ["skull", "mandible"].map(|name| &head.part(name).unwrap().mesh);
    head.fibres = rebuild(&head.muscles, &head.skin.mesh.positions, bones);
    head.tissue = TissueRecord {
        model: TissueModel::Layered,
        vertex_mass_g: 0.125,
    };
    let (width, height) = (64, 32);
    head.colour = Some(ColourMap {
        width,
        height,
        rgb: (0..width * height * 3)
            .map(|i| (i * 7 % 251) as u8)
            .collect(),
    });
    head
}

/// Two fibres over the first triangles of the skin.
fn grid(head: &Head, muscle: Muscle) -> MuscleGrid {
    let point = |t: usize, depth: f32| GridPoint {
        at: SurfacePoint {
            vertices: head.skin.mesh.triangles[t],
            shares: [0.2, 0.3, 0.5],
        },
        depth,
        mandible: 0.1,
    };
    let fibre = |t: usize| vec![point(t, 0.8), point(t + 5, 0.3)];
    MuscleGrid {
        muscle,
        fibres: vec![fibre(0), fibre(20)],
        axes: Vec::new(),
        bulge_mm: 0.0,
    }
}

/// Places of triangles by their corners, so that their order does not matter.
fn sorted(head: &Head) -> Vec<([u32; 3], [Vec2; 3])> {
    let skin = &head.skin;
    let mut all: Vec<_> = skin
        .mesh
        .triangles
        .iter()
        .zip(&skin.wedges)
        .map(|(t, w)| {
            // The smallest corner first: other programs may turn a triangle, not turn it over.
            let first = (0..3).min_by_key(|&i| t[i]).unwrap_or(0);
            let turned = |i: usize| (first + i) % 3;
            (
                std::array::from_fn(|i| t[turned(i)]),
                std::array::from_fn(|i| w[turned(i)]),
            )
        })
        .collect();
    all.sort_by_key(|(t, _)| *t);
    all
}

#[track_caller]
fn near(what: &str, a: &[Vec3], b: &[Vec3], tolerance: f32) {
    assert_eq!(a.len(), b.len(), "{what}");
    let worst = a
        .iter()
        .zip(b)
        .map(|(a, b)| a.distance(*b))
        .fold(0.0, f32::max);
    assert!(worst <= tolerance, "{what}: {worst} apart");
}

/// Fails unless both are the same head, places to `tolerance` mm.
#[track_caller]
pub(crate) fn assert_alike(a: &Head, b: &Head, tolerance: f32) {
    let flat = |uvs: &[Vec2]| uvs.iter().map(|uv| uv.extend(0.0)).collect::<Vec<_>>();
    let (skin, other) = (&a.skin, &b.skin);
    near(
        "skin",
        &skin.mesh.positions,
        &other.mesh.positions,
        tolerance,
    );
    near("normals", &skin.mesh.normals, &other.mesh.normals, 1e-4);
    near("chart", &flat(&skin.mesh.uvs), &flat(&other.mesh.uvs), 1e-6);
    near("reference", &skin.reference, &other.reference, 1e-6);
    for (one, two) in sorted(a).iter().zip(&sorted(b)) {
        assert_eq!(one.0, two.0);
        near("wedges", &flat(&one.1), &flat(&two.1), 1e-6);
    }
    assert_eq!(skin.mesh.triangles.len(), other.mesh.triangles.len());
    assert_eq!(skin.creases, other.creases);
    assert_eq!(skin.mesh.occlusion, other.mesh.occlusion);
    assert_eq!(
        (&skin.weight, &skin.vermilion, &skin.wet),
        (&other.weight, &other.vermilion, &other.wet)
    );
    assert_eq!(a.parts.len(), b.parts.len());
    for (part, other) in a.parts.iter().zip(&b.parts) {
        assert_eq!(
            (&part.name, part.material, &part.bodies, &part.weight),
            (&other.name, other.material, &other.bodies, &other.weight)
        );
        near(
            &part.name,
            &part.mesh.positions,
            &other.mesh.positions,
            tolerance,
        );
        near(
            &part.name,
            &flat(&part.mesh.uvs),
            &flat(&other.mesh.uvs),
            1e-5,
        );
        assert_eq!(part.mesh.occlusion, other.mesh.occlusion);
        assert_eq!(part.mesh.triangles.len(), other.mesh.triangles.len());
    }
    assert_eq!((&a.features, &a.landmarks), (&b.features, &b.landmarks));
    assert_eq!(
        (&a.lips, &a.lids, &a.muscles),
        (&b.lips, &b.lids, &b.muscles)
    );
    assert_eq!((&a.eyes, &a.bite), (&b.eyes, &b.bite));
    assert_eq!(
        (a.condyle_axis, a.neck_pivot),
        (b.condyle_axis, b.neck_pivot)
    );
    assert_eq!((a.tissue, &a.calibration), (b.tissue, &b.calibration));
    assert_eq!(a.fibres.len(), b.fibres.len());
    for (one, two) in a.fibres.iter().zip(&b.fibres) {
        near("fibre", &one.points, &two.points, 0.01);
    }
}
