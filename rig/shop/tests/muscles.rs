//! Muscles painted on the reference head: where they lie, and that they follow a warp with skin and bones.

use std::sync::OnceLock;

use glam::{Vec3, vec3};
use mouthpiece_rig::{
    Contraction, Fibre, Head, Layer, Material, Mesh, Muscle, MuscleGrid, rebuild,
};
use mouthpiece_shop::closest::{Facing, Surface};
use mouthpiece_shop::{bones, muscles, sculpt};

struct Reference {
    head: Head,
    bones: Vec<Mesh>,
    grids: Vec<MuscleGrid>,
}

#[allow(
    clippy::unwrap_used,
    reason = "a helper of tests; clippy sees only test functions"
)]
fn reference() -> &'static Reference {
    static REFERENCE: OnceLock<Reference> = OnceLock::new();
    REFERENCE.get_or_init(|| {
        let head = sculpt::reference(Head::reference().unwrap().calibration).unwrap();
        let bones: Vec<Mesh> = bones_of(&head);
        let grids = muscles::paint(&head.skin.mesh, &bones).unwrap();
        Reference { head, bones, grids }
    })
}

fn bones_of(head: &Head) -> Vec<Mesh> {
    head.parts
        .iter()
        .filter(|p| p.material == Material::Bone)
        .map(|p| p.mesh.clone())
        .collect()
}

/// What of the skin is seen from outside: not the inside of lips, lids and nostrils.
#[allow(
    clippy::unwrap_used,
    reason = "a helper of tests; clippy sees only test functions"
)]
fn dry(positions: &[Vec3]) -> Surface {
    let skin = &reference().head.skin;
    let dry: Vec<[u32; 3]> = skin
        .mesh
        .triangles
        .iter()
        .filter(|t| t.iter().all(|v| skin.wet[*v as usize] < 0.5))
        .copied()
        .collect();
    Surface::new(positions, &dry).unwrap()
}

/// How deep a place lies under the skin, mm.
fn depth(skin: &Surface, place: Vec3) -> f32 {
    let hit = skin.closest_facing(place, 40.0, Facing::ANY);
    hit.map_or(f32::MAX, |hit| (hit.point - place).dot(skin.normal(&hit)))
}

/// Faults of fibres against the skin over them and the bones under them.
#[allow(
    clippy::unwrap_used,
    reason = "a helper of tests; clippy sees only test functions"
)]
fn faults(fibres: &[Fibre], skin: &[Vec3], bones: &[Mesh]) -> Vec<String> {
    let dry = dry(skin);
    let bones: Vec<Surface> = bones
        .iter()
        .map(|b| Surface::new(&b.positions, &b.triangles).unwrap())
        .collect();
    let mut faults = Vec::new();
    for fibre in fibres {
        for place in &fibre.points {
            let under = depth(&dry, *place);
            if under < 0.3 {
                faults.push(format!(
                    "{:?} at {place:.1} lies {under:.1} mm under the skin",
                    fibre.muscle
                ));
            }
            // Straight out from the fibre there is skin and no bone on the way.
            let out = (*place - vec3(0.0, place.y, 30.0)).normalize();
            let way = dry
                .ray(*place + out * 0.3, out, 40.0, Facing::ANY)
                .map_or(0.0, |hit| hit.distance);
            let bone = bones
                .iter()
                .any(|b| b.ray(*place + out * 0.3, out, way, Facing::ANY).is_some());
            if bone {
                faults.push(format!("{:?} at {place:.1} lies behind bone", fibre.muscle));
            }
        }
    }
    faults
}

#[test]
fn fibres_lie_between_skin_and_bone() {
    let r = reference();
    let fibres = rebuild(&r.grids, &r.head.skin.mesh.positions, &r.bones);
    for muscle in Muscle::ALL {
        let bellies = r.grids.iter().filter(|g| g.muscle == muscle).count();
        let single = matches!(
            muscle,
            Muscle::OrbicularisOrisSuperior | Muscle::OrbicularisOrisInferior
        );
        assert_eq!(bellies, if single { 1 } else { 2 }, "{muscle:?}");
    }
    let faults = faults(&fibres, &r.head.skin.mesh.positions, &r.bones);
    assert!(faults.is_empty(), "{faults:#?}");
}

#[test]
fn left_and_right_are_mirror_images() {
    let r = reference();
    let fibres = rebuild(&r.grids, &r.head.skin.mesh.positions, &r.bones);
    let mirror = vec3(-1.0, 1.0, 1.0);
    for fibre in &fibres {
        let twin = fibres
            .iter()
            .filter(|f| f.muscle == fibre.muscle && f.points.len() == fibre.points.len());
        let apart = twin
            .map(|f| {
                let across = fibre
                    .points
                    .iter()
                    .zip(&f.points)
                    .map(|(p, q)| p.distance(*q * mirror));
                let reversed = fibre
                    .points
                    .iter()
                    .zip(f.points.iter().rev())
                    .map(|(p, q)| p.distance(*q * mirror));
                across.fold(0.0, f32::max).min(reversed.fold(0.0, f32::max))
            })
            .fold(f32::MAX, f32::min);
        assert!(
            apart < 0.2,
            "{:?} is {apart} mm off its mirror image",
            fibre.muscle
        );
    }
}

/// A head of other proportions: longer, narrower at the jaw, fuller in the cheeks.
fn other(p: Vec3) -> Vec3 {
    let jaw = ((-20.0 - p.y) / 60.0).clamp(0.0, 1.0);
    vec3(
        p.x * (1.06 - 0.12 * jaw) + 1.5 * (p.y / 35.0).sin() * (p.x / 60.0),
        p.y * 1.09 - 2.0,
        p.z * 0.97 + 2.0 * (p.y / 40.0).cos(),
    )
}

#[test]
fn muscles_and_bones_follow_a_warp() {
    let r = reference();
    let warp = |points: &[Vec3]| -> Vec<Vec3> { points.iter().map(|p| other(*p)).collect() };
    let skin = warp(&r.head.skin.mesh.positions);
    let follow =
        bones::follow(&r.head, &skin, warp, 1.0).expect("the head has landmarks on its bones");
    let mut bones = r.bones.clone();
    for (bone, positions) in bones.iter_mut().zip(follow) {
        bone.positions = positions;
    }
    let dry = dry(&skin);
    let nearest = bones
        .iter()
        .flat_map(|b| &b.positions)
        .map(|p| depth(&dry, *p))
        .filter(|d| *d > -8.0)
        .fold(f32::MAX, f32::min);
    println!("bone is {nearest:.2} mm under the skin at the nearest");
    let fibres = rebuild(&r.grids, &skin, &bones);
    let faults = faults(&fibres, &skin, &bones);
    assert!(faults.is_empty(), "{faults:#?}");
    // They lie where the warp takes them, but for the thickness of what is over them.
    let before = rebuild(&r.grids, &r.head.skin.mesh.positions, &r.bones);
    for (a, b) in before.iter().zip(&fibres) {
        for (p, q) in a.points.iter().zip(&b.points) {
            let apart = other(*p).distance(*q);
            assert!(apart < 5.0, "{:?} went {apart:.1} mm astray", a.muscle);
        }
        if let (Contraction::Sphincter { centre, .. }, Contraction::Sphincter { centre: now, .. }) =
            (a.contraction, b.contraction)
        {
            assert!(
                other(centre).distance(now) < 6.0,
                "{:?}: its axis went from {centre} to {now}",
                a.muscle
            );
        }
    }
}

#[test]
fn no_bone_comes_through_the_skin() {
    let r = reference();
    let dry = dry(&r.head.skin.mesh.positions);
    for bone in &r.bones {
        for place in &bone.positions {
            // The tooth rows stand before the slit of the mouth, the nasal floor beside the nostrils.
            let openings =
                place.x.abs() < 30.0 && (-50.0..2.0).contains(&place.y) && place.z > 78.0;
            let orbit = place.x.abs() < 48.0 && (20.0..54.0).contains(&place.y) && place.z < 90.0;
            // The ear's hollow goes in towards the canal.
            let ear = place.x.abs() > 52.0 && (-25.0..40.0).contains(&place.y) && place.z < 22.0;
            let under = depth(&dry, *place);
            assert!(
                openings || orbit || (ear && under > 0.5) || under > 1.8,
                "bone at {place} is {under} mm under the skin"
            );
        }
    }
    let on_bone = r
        .head
        .landmarks
        .iter()
        .filter(|m| m.layer != Layer::Skin)
        .count();
    assert_eq!(on_bone, 22);
    let vault = r.bones[0]
        .positions
        .iter()
        .filter(|p| p.y > 90.0)
        .map(|p| depth(&dry, *p));
    let (least, most) = vault.fold((f32::MAX, 0.0_f32), |(a, b), d| (a.min(d), b.max(d)));
    assert!(least > 3.0 && most < 8.0, "scalp of {least} to {most} mm");
}

#[test]
fn a_skin_of_another_template_is_refused() {
    let r = reference();
    let other = bones::follow(
        &r.head,
        &r.head.skin.mesh.positions[1..],
        <[Vec3]>::to_vec,
        1.0,
    );
    let error = other.expect_err("one vertex is missing").to_string();
    assert!(error.contains("template"), "{error}");
}
