//! The reference head and its muscles at rest: a sound mesh, and fibres that do what HABER 5.1 says.

use std::collections::HashMap;
use std::sync::OnceLock;

use glam::{Affine3A, Vec3};
use mouthpiece_rig::lip_level::{CONTACT, CREST};
use mouthpiece_rig::{Contraction, Control, Controls, Fibre, Head, Material, Muscle};

#[allow(
    clippy::unwrap_used,
    reason = "a helper of tests; clippy sees only test functions"
)]
fn head() -> &'static Head {
    static HEAD: OnceLock<Head> = OnceLock::new();
    HEAD.get_or_init(|| Head::reference().unwrap())
}

fn contracted(fibre: &Fibre, control: Control, value: f32) -> Vec<Vec3> {
    let mut controls = Controls::default();
    controls[control] = value;
    let mut points = fibre.points.clone();
    fibre.contracted(&controls, &Affine3A::IDENTITY, &mut points);
    points
}

fn length(points: &[Vec3]) -> f32 {
    points.windows(2).map(|w| w[0].distance(w[1])).sum()
}

fn fibres(muscle: Muscle) -> impl Iterator<Item = &'static Fibre> {
    head().fibres.iter().filter(move |f| f.muscle == muscle)
}

#[test]
fn a_linear_fibre_shortens_towards_its_origin() {
    let mut seen = 0;
    for fibre in head()
        .fibres
        .iter()
        .filter(|f| f.contraction == Contraction::Linear)
    {
        let half = contracted(fibre, Control::contraction(fibre.muscle), 0.5);
        let full = contracted(fibre, Control::contraction(fibre.muscle), 1.0);
        let origin = half[0].distance(fibre.points[0]);
        assert!(
            origin < 1e-3,
            "{:?}: the origin moved {origin} mm",
            fibre.muscle
        );
        let (rest, half, full) = (length(&fibre.points), length(&half), length(&full));
        assert!(
            rest > half && half > full,
            "{:?}: {rest} {half} {full} mm",
            fibre.muscle
        );
        seen += 1;
    }
    assert!(
        seen >= 20,
        "ten paired muscles have at least twenty fibres, found {seen}"
    );
}

#[test]
fn the_sphincter_shrinks_on_its_axis_and_not_along_it() {
    for fibre in fibres(Muscle::OrbicularisOrisSuperior) {
        let closed = contracted(fibre, Control::OrbicularisOrisSuperior, 1.0);
        for (p, q) in fibre.points.iter().zip(&closed) {
            assert!(q.x.abs() <= p.x.abs() + 1e-4, "{p} went outwards to {q}");
            assert!((q.z - p.z).abs() < 1e-4, "{p} left its plane for {q}");
        }
    }
}

#[test]
fn protrusion_falls_from_the_inner_fibre_to_the_outer() {
    for (muscle, control) in [
        (Muscle::OrbicularisOrisSuperior, Control::ProtrusionSuperior),
        (Muscle::OrbicularisOrisInferior, Control::ProtrusionInferior),
    ] {
        let forward: Vec<f32> = fibres(muscle)
            .map(|f| contracted(f, control, 1.0)[3].z - f.points[3].z)
            .collect();
        assert_eq!(forward.len(), 3);
        assert!(
            forward[0] > 8.0 && forward[0] > forward[1] && forward[1] > forward[2],
            "{forward:?}"
        );
        let back = fibres(muscle).map(|f| contracted(f, control, -0.5)[3].z - f.points[3].z);
        assert!(back.into_iter().all(|z| z < 0.0), "lips can be tucked in");
    }
}

#[test]
fn the_two_halves_of_the_orbicularis_oris_work_alone() {
    for fibre in fibres(Muscle::OrbicularisOrisInferior) {
        for control in [
            Control::OrbicularisOrisSuperior,
            Control::ProtrusionSuperior,
        ] {
            let moved = contracted(fibre, control, 1.0);
            assert!(
                moved
                    .iter()
                    .zip(&fibre.points)
                    .all(|(q, p)| q.distance(*p) < 1e-3)
            );
        }
    }
}

#[test]
fn a_curved_fibre_straightens_when_its_insertion_is_drawn_away() {
    let curved = Fibre {
        muscle: Muscle::ZygomaticusMajor,
        contraction: Contraction::Linear,
        points: vec![
            Vec3::ZERO,
            Vec3::new(10.0, 4.0, 0.0),
            Vec3::new(20.0, 0.0, 0.0),
        ],
        mandible: vec![0.0, 0.0, 1.0],
    };
    let bend = |drawn: f32| {
        let away = Affine3A::from_translation(Vec3::new(drawn, 0.0, 0.0));
        let mut points = curved.points.clone();
        curved.contracted(&Controls::default(), &away, &mut points);
        points[1].y
    };
    assert!((bend(0.0) - 4.0).abs() < 1e-4, "relaxed it keeps its bend");
    assert!(bend(0.8) < bend(0.2), "it straightens as it is drawn out");
    assert!(
        bend(5.0).abs() < 1e-3,
        "drawn out past its length it is straight"
    );
}

#[test]
fn the_skin_is_a_clean_mesh() {
    let mesh = &head().skin.mesh;
    let mut edges: HashMap<(u32, u32), u32> = HashMap::new();
    for t in &mesh.triangles {
        for i in 0..3 {
            let (a, b) = (t[i], t[(i + 1) % 3]);
            assert_ne!(a, b);
            *edges.entry((a, b)).or_default() += 1;
        }
    }
    assert!(
        edges.values().all(|&n| n == 1),
        "every edge is used once in each sense"
    );
    // Open only at the collar, and where the insides of lips, lids and nostrils end.
    let open = edges
        .keys()
        .filter(|(a, b)| !edges.contains_key(&(*b, *a)))
        .count();
    assert!(open < 400, "{open} open edges");
    assert!(mesh.positions.iter().all(|p| p.is_finite()));
    assert!(mesh.occlusion.iter().all(|o| (0.0..=1.0).contains(o)));
    assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-3));
}

#[test]
fn lips_meet_at_rest_and_part_at_the_corners_only() {
    let head = head();
    let rest = &head.skin.mesh.positions;
    let (upper, lower) = (&head.lips.upper, &head.lips.lower);
    assert_eq!(upper.len(), lower.len());
    for (u, l) in upper.iter().zip(lower) {
        let gap = rest[u[CONTACT] as usize].distance(rest[l[CONTACT] as usize]);
        assert!(gap < 0.05, "contact lines {gap} mm apart");
        assert!(
            rest[u[CREST] as usize].y >= rest[l[CREST] as usize].y,
            "the upper lip is above the lower"
        );
    }
    assert_eq!(upper[0], lower[0], "one corner for both lips");
    assert_ne!(upper[5], lower[5], "an opening between them");
}

#[test]
fn every_part_of_a_face_is_there() {
    let head = head();
    for name in [
        "eye_l",
        "eye_r",
        "teeth_upper",
        "teeth_lower",
        "gums_upper",
        "gums_lower",
        "tongue",
        "cavity",
        "hair",
        "cloth",
    ] {
        let part = head.parts.iter().find(|p| p.name == name);
        assert!(
            part.is_some_and(|p| !p.mesh.triangles.is_empty()),
            "{name} is missing"
        );
    }
    let iris = head.parts.iter().filter(|p| p.material == Material::Eye);
    for eye in iris {
        // The pupil's middle is drawn where the eye looks.
        let front = eye
            .mesh
            .positions
            .iter()
            .zip(&eye.mesh.uvs)
            .max_by(|a, b| a.0.z.total_cmp(&b.0.z));
        assert!(front.is_some_and(|(_, uv)| uv.length() < 0.3));
    }
    let counted = Muscle::ALL
        .iter()
        .filter(|m| fibres(**m).next().is_some())
        .count();
    assert_eq!(counted, Muscle::COUNT, "every muscle has fibres");
}
