//! Guards the muscles' surfaces and the other parts that are drawn without skin: closed, without
//! degenerate triangles, as thick as keeps a muscle's volume, and between skin and bone.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{Vec3, vec3};
use mouthpiece_rig::{
    Anatomy, Belly, Contraction, Control, Controls, Head, KeyFrame, Material, Mesh, Muscle,
    MuscleSurfaces, Simulation, SpringKind, enclosed_volume, undressed,
};
use proptest::prelude::*;

/// Long enough for muscles to have followed their controls.
const STEPS: usize = 120;

#[allow(
    clippy::unwrap_used,
    reason = "a helper of tests; clippy sees only test functions"
)]
fn head() -> Arc<Head> {
    Arc::new(Head::reference().unwrap())
}

/// The head's state after a while under `controls`.
fn settled(head: &Arc<Head>, controls: &Controls) -> Simulation {
    let mut simulation = Simulation::new(Arc::clone(head));
    for _ in 0..STEPS {
        simulation.step(controls);
    }
    simulation
}

fn contracted(muscle: Muscle, value: f32) -> Controls {
    let mut controls = Controls::default();
    controls[Control::contraction(muscle)] = value;
    controls
}

fn at_rest(head: &Arc<Head>) -> Vec<Belly> {
    MuscleSurfaces::new(head).shaped(settled(head, &Controls::default()).fibre_points())
}

fn volume(belly: &Belly) -> f32 {
    enclosed_volume(&belly.mesh.positions, &belly.mesh.triangles)
}

/// What is wrong with a surface, if anything is.
fn fault(belly: &Belly) -> Option<String> {
    let mesh = &belly.mesh;
    let mut edges: HashMap<(u32, u32), u32> = HashMap::new();
    for t in &mesh.triangles {
        for i in 0..3 {
            *edges.entry((t[i], t[(i + 1) % 3])).or_default() += 1;
        }
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        let area = 0.5 * (b - a).cross(c - a).length();
        if area.is_nan() || area < 1e-6 {
            return Some(format!("{:?} has a triangle of {area} mm2", belly.muscle));
        }
    }
    // Two triangles an edge, which run along it in opposite directions.
    let open = edges
        .iter()
        .find(|((a, b), n)| **n != 1 || edges.get(&(*b, *a)) != Some(&1));
    if let Some((edge, _)) = open {
        return Some(format!("{:?} is open at {edge:?}", belly.muscle));
    }
    let volume = volume(belly);
    (volume.is_nan() || volume < 20.0).then(|| format!("{:?}: {volume} mm3", belly.muscle))
}

#[test]
fn every_muscle_has_a_surface_on_each_side() {
    let head = head();
    let bellies = at_rest(&head);
    for muscle in Muscle::ALL {
        let middles: Vec<f32> = bellies
            .iter()
            .filter(|b| b.muscle == muscle)
            .map(|b| b.mesh.positions.iter().map(|p| p.x).sum::<f32>())
            .collect();
        let whole = matches!(
            muscle,
            Muscle::OrbicularisOrisSuperior | Muscle::OrbicularisOrisInferior
        );
        let sided = middles.iter().any(|x| *x > 0.0) && middles.iter().any(|x| *x < 0.0);
        assert!(sided || whole && middles.len() == 1, "{muscle:?}");
    }
}

#[test]
fn a_muscle_that_shortens_keeps_its_volume() {
    let head = head();
    let surfaces = MuscleSurfaces::new(&head);
    let rest = surfaces.shaped(settled(&head, &Controls::default()).fibre_points());
    for muscle in Muscle::ALL {
        let linear = head
            .fibres
            .iter()
            .any(|f| f.muscle == muscle && f.contraction == Contraction::Linear);
        if !linear {
            continue;
        }
        let now = surfaces.shaped(settled(&head, &contracted(muscle, 1.0)).fibre_points());
        for (a, b) in rest.iter().zip(&now).filter(|(a, _)| a.muscle == muscle) {
            let change = volume(b) / volume(a) - 1.0;
            assert!(change.abs() < 0.03, "{muscle:?}: {:.1} %", 100.0 * change);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(12) })]
    #[test]
    fn surfaces_are_closed_whatever_the_face_does(values in prop::collection::vec(0.0_f32..=1.0, Control::COUNT)) {
        let head = head();
        let mut controls = Controls::default();
        for (&control, share) in Control::ALL.iter().zip(&values) {
            let (least, most) = control.range();
            controls[control] = least + (most - least) * share;
        }
        let simulation = settled(&head, &controls);
        for belly in MuscleSurfaces::new(&head).shaped(simulation.fibre_points()) {
            let fault = fault(&belly);
            prop_assert!(fault.is_none(), "{}", fault.unwrap_or_default());
        }
    }
}

/// Whether a ray meets a mesh before it has gone `far` mm.
fn meets(mesh: &Mesh, from: Vec3, direction: Vec3, far: f32) -> bool {
    mesh.triangles.iter().any(|t| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        let (u, v) = (b - a, c - a);
        let normal = u.cross(v);
        let along = direction.dot(normal);
        if along.abs() < 1e-9 {
            return false;
        }
        let way = (a - from).dot(normal) / along;
        let q = from + direction * way - a;
        let area = normal.length_squared();
        let (s, t) = (q.cross(v).dot(normal) / area, u.cross(q).dot(normal) / area);
        (0.0..far).contains(&way) && s >= 0.0 && t >= 0.0 && s + t <= 1.0
    })
}

/// The grids say where fibres lie; their flesh must not stand out of the face or lie in the bone.
#[test]
fn muscles_lie_between_skin_and_bone() {
    let head = head();
    let bones = ["skull", "mandible"].map(|name| &head.part(name).unwrap().mesh);
    let bellies = at_rest(&head);
    let (mut outside, mut buried, mut all) = (0, 0, 0);
    let places = bellies
        .iter()
        .flat_map(|b| b.mesh.positions.iter().zip(&b.mesh.normals));
    for (p, n) in places.step_by(9) {
        let out = (*p - vec3(0.0, p.y, 30.0)).normalize();
        // What looks inwards rests on bone, or in it where fibres arise.
        if n.dot(out) < 0.2 {
            continue;
        }
        all += 1;
        outside += usize::from(!meets(&head.skin.mesh, *p, out, 60.0));
        buried += usize::from(bones.iter().any(|bone| meets(bone, *p, out, 5.0)));
    }
    println!("of {all} outer vertices {outside} stand out of the skin, {buried} lie in bone");
    assert!(outside * 100 < all * 6, "{outside} of {all} stand out");
    assert!(buried * 100 < all * 8, "{buried} of {all} are buried");
}

#[test]
fn bones_and_springs_are_there_to_be_drawn() {
    let head = head();
    let smile = settled(&head, &contracted(Muscle::ZygomaticusMajor, 1.0));
    let mut frame = KeyFrame::default();
    smile.save(&mut frame);
    let of = |what, material| {
        let mut parts = undressed(&head, &frame, what);
        parts.retain(|p| p.material == material);
        parts
    };
    let bones = of(Anatomy::Skull, Material::Bone);
    assert!(bones.iter().any(|b| b.name == "mandible"));
    assert!(
        bones.iter().any(|b| b.name == "teeth_upper"),
        "teeth stand in bone"
    );
    // Folds are dark, open places light.
    let skull = bones.iter().find(|b| b.name == "skull").unwrap();
    let darkest = skull.mesh.occlusion.iter().copied().fold(1.0, f32::min);
    let lightest = skull.mesh.occlusion.iter().copied().fold(0.0, f32::max);
    assert!(darkest < 0.3 && lightest > 0.9, "{darkest} to {lightest}");

    let springs = of(Anatomy::Springs, Material::Spring);
    let uvs = || springs.iter().flat_map(|s| &s.mesh.uvs);
    for kind in [SpringKind::Skin, SpringKind::Bone, SpringKind::Muscle] {
        let count = uvs().filter(|uv| uv.x == f32::from(kind as u8)).count();
        assert!(count > 1000, "{count} ends of springs to {kind:?}");
    }
    let skin = uvs().filter(|uv| uv.x == 0.0).map(|uv| uv.y);
    let (least, most) = skin.fold((0.0, 0.0), |(a, b): (f32, f32), s| (a.min(s), b.max(s)));
    assert!(
        least < -0.1 && most > 0.1,
        "a smile strains skin: {least} to {most}"
    );
}
