//! What the spring pass promises: the same forces on every set of instructions, those of the formula, and
//! none that a mesh gives to itself.

use glam::{DVec3, Vec3, vec3};
use mouthpiece_rig::{Head, Isa, SpringPass};
use proptest::prelude::*;

/// Triangles between any vertices of a small cloud: some of them on no triangle at all, some very close together,
/// many edges at one vertex, several triangles at one edge.
fn soup() -> impl Strategy<Value = (Vec<Vec3>, Vec<[u32; 3]>, f32)> {
    let coordinate = || -120.0_f32..120.0;
    let place = (coordinate(), coordinate(), coordinate()).prop_map(|(x, y, z)| vec3(x, y, z));
    // Now and then a vertex stands right beside the one before it.
    let beside = prop_oneof![3 => Just(None), 1 => (1e-3_f32..0.1).prop_map(Some)];
    let places = prop::collection::vec((place, beside), 3..90).prop_map(|list| {
        let mut places: Vec<Vec3> = Vec::new();
        for (place, beside) in list {
            places.push(match (places.last(), beside) {
                (Some(last), Some(way)) => *last + way * place.normalize_or(Vec3::X),
                _ => place,
            });
        }
        places
    });
    (places, 0.8_f32..1.3).prop_flat_map(|(places, stretch)| {
        let count = places.len() as u32;
        let corner = move || 0..count;
        let triangle = (corner(), 1..count - 1, 1..count - 1).prop_filter_map(
            "three corners",
            move |(a, b, c)| {
                let (b, c) = ((a + b) % count, (a + b + c) % count);
                (a != b && b != c && a != c).then_some([a, b, c])
            },
        );
        let triangles = prop::collection::vec(triangle, 0..150);
        (Just(places), triangles, Just(stretch))
    })
}

fn forces(pass: &mut SpringPass, isa: Isa) -> Vec<DVec3> {
    pass.run(isa);
    pass.forces().map(Vec3::as_dvec3).collect()
}

/// Hooke's law edge by edge, and per vertex the sum of what was added: what rounding is a share of.
fn plainly(pass: &SpringPass, stretch: f32) -> (Vec<DVec3>, Vec<f64>) {
    let places: Vec<Vec3> = pass.places().collect();
    let mut forces = vec![DVec3::ZERO; places.len()];
    let mut scale = vec![0.0; places.len()];
    for edge in pass.edges() {
        let [a, b] = edge.map(|v| places[v as usize]);
        let rest = f64::from(a.distance(b) / stretch);
        let way = b.as_dvec3() - a.as_dvec3();
        let strain = 0.5 * (way.length_squared() / (rest * rest) - 1.0);
        let force = way * SpringPass::stress(strain);
        for (&v, force) in edge.iter().zip([force, -force]) {
            forces[v as usize] += force;
            // Strain is a difference of nearly equal lengths.
            scale[v as usize] += way.length() + rest;
        }
    }
    (forces, scale)
}

/// Some roundings of an f32 per edge.
const ROUNDING: f64 = 2e-6;

fn check(pass: &mut SpringPass, stretch: f32) -> Result<(), TestCaseError> {
    let (plain, scale) = plainly(pass, stretch);
    let all: f64 = scale.iter().sum();
    let portable = Isa::all().pop().map(|isa| forces(pass, isa));
    for isa in Isa::all() {
        let found = forces(pass, isa);
        prop_assert_eq!(found.len(), plain.len());
        for (v, force) in found.iter().enumerate() {
            let slack = ROUNDING * scale[v];
            let off = force.distance(plain[v]);
            prop_assert!(
                off <= slack,
                "{isa:?}, vertex {v}: {force}, not {}",
                plain[v]
            );
            let other = portable.as_ref().map_or(DVec3::NAN, |p| p[v]);
            let off = force.distance(other);
            prop_assert!(
                off <= slack,
                "{isa:?}, vertex {v}: {force}, portable {other}"
            );
        }
        let sum: DVec3 = found.iter().sum();
        prop_assert!(
            sum.length() <= ROUNDING * all,
            "{isa:?}: {sum} is left over"
        );
    }
    Ok(())
}

proptest! {
    #[test]
    fn forces_are_by_the_law_and_even_out_on_all_instructions((places, triangles, stretch) in soup()) {
        let mut pass = SpringPass::new(&places, &triangles, stretch);
        check(&mut pass, stretch)?;
    }
}

/// The same on the mesh that matters; and that it is stretched, so that the check has something to see.
#[test]
fn the_skin_of_the_reference_head_pulls_as_the_formula_says() {
    let head = Head::reference().unwrap();
    let skin = &head.skin.mesh;
    let mut pass = SpringPass::new(&skin.positions, &skin.triangles, 1.05);
    check(&mut pass, 1.05).unwrap();
    assert_eq!(Isa::best(), Isa::all()[0]);
    let pulled = forces(&mut pass, Isa::best());
    let most = pulled.iter().map(|f| f.length()).fold(0.0, f64::max);
    assert!(most > 0.1, "{most}");
}

/// A vertex on no triangle feels nothing, and its place between others changes nothing for them.
#[test]
fn lonely_vertices_feel_nothing() {
    let triangle = [Vec3::ZERO, vec3(3.0, 0.0, 0.0), vec3(0.0, 4.0, 0.0)];
    let lonely: Vec<Vec3> = (0..20).map(|i| vec3(i as f32, 1.0, 2.0)).collect();
    let places: Vec<Vec3> = lonely.iter().chain(&triangle).copied().collect();
    let mut pass = SpringPass::new(&places, &[[20, 21, 22]], 2.0);
    assert_eq!(pass.edges().len(), 3);
    for isa in Isa::all() {
        let found = forces(&mut pass, isa);
        let pulled = found.iter().filter(|f| f.length() > 0.0).count();
        assert_eq!(pulled, 3, "{isa:?}");
        // Twice too long.
        let at = pass.places().position(|p| p == Vec3::ZERO).unwrap();
        assert!(
            found[at].distance(glam::dvec3(3.0, 4.0, 0.0) * SpringPass::stress(1.5)) < 1e-5,
            "{isa:?}"
        );
    }
}
