//! What must hold of a head in motion whichever of its two models of tissue moves the skin.

use std::sync::Arc;

use assert_no_alloc::{AllocDisabler, assert_no_alloc};
use glam::Vec3;
use mouthpiece_rig::{
    Control, Controls, KeyFrame, Muscle, STEP_TICKS, Simulation, TICK_RATE, TissueModel,
};

mod deeds;
mod models;

use deeds::{DEEDS, vertex};
use models::{head, settled};

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

/// The head as it stands when nothing has moved it: contact may have settled it a little.
fn undisturbed(model: TissueModel) -> KeyFrame {
    let mut simulation = Simulation::new(Arc::clone(head(model)));
    settled(&mut simulation, &Controls::default(), TWO_SECONDS)
}

/// The farthest that a vertex is from where it was; not a number if one of them has none.
fn farthest(was: &KeyFrame, frame: &KeyFrame) -> f32 {
    let moved = frame
        .skin
        .iter()
        .zip(&was.skin)
        .map(|(p, q)| p.distance(*q));
    moved.fold(
        0.0,
        |most, d| if d.is_nan() { f32::NAN } else { most.max(d) },
    )
}

/// Steps in the time that skin has to come to rest.
const TWO_SECONDS: usize = (2 * TICK_RATE / STEP_TICKS) as usize;

/// Numbers that look random, 0 to 1, the same each time.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (self.0 >> 40) as f32 / (1_u64 << 24) as f32
    }
}

/// White noise in turn with steps from end to end of each range, 60 times a second, then 2 s of rest.
fn survives_anything(model: TissueModel, seconds: i64) {
    const PER_CHANGE: i64 = TICK_RATE / 60 / STEP_TICKS;
    let head = head(model);
    let mut simulation = Simulation::new(Arc::clone(head));
    let (rest, mut frame) = (undisturbed(model), head.rest_frame());
    let mut noise = Noise(2026);
    for change in 0..seconds * 60 {
        let mut controls = Controls::default();
        let white = change / 60 % 2 == 0;
        for &control in Control::ALL {
            let (low, high) = control.range();
            let share = if white {
                noise.next()
            } else {
                noise.next().round()
            };
            controls[control] = low + (high - low) * share;
        }
        for _ in 0..PER_CHANGE {
            simulation.step(&controls);
        }
        simulation.save(&mut frame);
        let far = farthest(&rest, &frame);
        assert!(
            far < 60.0,
            "{model:?}: a vertex went {far} mm after {change} changes"
        );
    }
    let frame = settled(&mut simulation, &Controls::default(), TWO_SECONDS);
    let left = farthest(&rest, &frame);
    assert!(left < 0.05, "{model:?}: {left} mm from rest after 2 s");
    let skin = &head.skin;
    let near = |t: &&[u32; 3]| {
        let lid = |v: &u32| head.lids.iter().any(|l| l.vertex == *v);
        t.iter()
            .any(|v| skin.vermilion[*v as usize] > 0.0 || skin.wet[*v as usize] > 0.0 || lid(v))
    };
    for t in skin.mesh.triangles.iter().filter(near) {
        let normal = |places: &[Vec3]| {
            let [a, b, c] = t.map(|v| places[v as usize]);
            (b - a).cross(c - a)
        };
        let turned = normal(&frame.skin).dot(normal(&skin.mesh.positions)) <= 0.0;
        assert!(!turned, "{model:?}: triangle {t:?} is turned over");
    }
}

#[test]
fn springs_survive_ten_minutes_of_any_controls() {
    survives_anything(TissueModel::Springs, 600);
}

#[test]
fn layers_survive_any_controls() {
    survives_anything(TissueModel::Layered, 20);
}

#[test]
#[ignore = "ten simulated minutes take layers some minutes: by hand"]
fn layers_survive_ten_minutes_of_any_controls() {
    survives_anything(TissueModel::Layered, 600);
}

#[test]
fn without_stiffness_of_the_muscles_no_contraction_moves_the_skin() {
    for model in [TissueModel::Springs, TissueModel::Layered] {
        let rest = head(model).rest_frame();
        let mut cut = Simulation::new(Arc::clone(head(model)));
        // Contact may move skin at rest; this is of the tissue alone.
        cut.set_contacts(false);
        cut.set_muscle_stiffness(0.0);
        for muscle in Muscle::ALL {
            let mut controls = Controls::default();
            controls[Control::contraction(muscle)] = 1.0;
            controls[Control::ProtrusionSuperior] = 1.0;
            controls[Control::ProtrusionInferior] = -1.0;
            let moved = farthest(&rest, &settled(&mut cut, &controls, 60));
            assert!(
                moved < 0.01,
                "{model:?}: {muscle:?} moved the skin by {moved} mm"
            );
        }
    }
}

#[test]
fn a_rewind_repeats_itself_to_the_bit() {
    for model in [TissueModel::Springs, TissueModel::Layered] {
        let mut open = Controls::default();
        open[Control::Jaw] = 0.15;
        open[Control::Risorius] = 0.3;
        let mut simulation = Simulation::new(Arc::clone(head(model)));
        let kept = settled(&mut simulation, &open, 50);
        let first = settled(&mut simulation, &Controls::default(), 70);
        assert!(simulation.restore(&kept));
        let second = settled(&mut simulation, &Controls::default(), 70);
        assert!(first == second, "{model:?}");
        // A frame that knows nothing of what is inside leaves that at rest.
        assert!(simulation.restore(&head(model).rest_frame()));
        let again = settled(&mut simulation, &Controls::default(), TWO_SECONDS);
        assert!(farthest(&undisturbed(model), &again) < 0.01, "{model:?}");
    }
}

#[test]
fn a_step_allocates_nothing() {
    for model in [TissueModel::Springs, TissueModel::Layered] {
        let mut simulation = Simulation::new(Arc::clone(head(model)));
        let mut controls = Controls::default();
        controls[Control::Jaw] = 0.2;
        controls[Control::ZygomaticusMajor] = 0.5;
        controls[Control::ProtrusionSuperior] = 0.5;
        let mut frame = settled(&mut simulation, &controls, 1);
        assert_no_alloc(|| {
            for _ in 0..20 {
                simulation.step(&controls);
            }
            simulation.save(&mut frame);
        });
    }
}

#[test]
fn the_jaw_carries_the_lower_face_and_leaves_the_upper() {
    for model in [TissueModel::Springs, TissueModel::Layered] {
        let mut open = Controls::default();
        open[Control::Jaw] = 0.25;
        let frame = settled(&mut Simulation::new(Arc::clone(head(model))), &open, 240);
        let rest = &head(model).skin.mesh.positions;
        let moved = |place| {
            let v = vertex(head(model), place);
            (
                frame.skin[v] - rest[v],
                head(model).mandible(0.25).transform_point3(rest[v]) - rest[v],
            )
        };
        let (chin, bone) = moved(Vec3::new(0.0, -66.0, 110.0));
        assert!(
            chin.distance(bone) < 0.15 * bone.length(),
            "{model:?}: {chin}, not {bone}"
        );
        let (brow, _) = moved(Vec3::new(27.0, 57.0, 104.0));
        assert!(brow.length() < 0.5, "{model:?}: the brow moved by {brow}");
    }
}

#[test]
fn lids_close_over_the_eyes() {
    for model in [TissueModel::Springs, TissueModel::Layered] {
        let head = head(model);
        let mut controls = Controls::default();
        controls[Control::LidL] = 1.0;
        controls[Control::LidR] = 1.0;
        let frame = settled(&mut Simulation::new(Arc::clone(head)), &controls, 150);
        // A ray from the pupil forwards must meet skin.
        for eye in &head.eyes {
            let pupil = eye.centre;
            let covered = head.skin.mesh.triangles.iter().any(|t| {
                let [a, b, c] = t.map(|i| frame.skin[i as usize]);
                let side = |p: Vec3, q: Vec3| (q - p).truncate().perp_dot((pupil - p).truncate());
                let (u, v, w) = (side(a, b), side(b, c), side(c, a));
                a.z > pupil.z
                    && ((u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0))
            });
            assert!(covered, "{model:?}: the pupil shows through the closed lid");
        }
    }
}

/// What of a deed's limit for the default model the layered one must do: LEE's straight vectors and his
/// profile along them pull the middle of a muscle as much as its end, so that landmarks at the end go less far.
const LAYERED_PART: f32 = 0.7;

#[test]
fn every_muscle_does_its_deed_in_layers_too() {
    let head = head(TissueModel::Layered);
    let rest = &head.skin.mesh.positions;
    let mut wrong = Vec::new();
    for (muscle, what, place, way, least) in DEEDS {
        let mut controls = Controls::default();
        controls[Control::contraction(muscle)] = 1.0;
        let frame = settled(&mut Simulation::new(Arc::clone(head)), &controls, 240);
        for side in [Vec3::ONE, Vec3::new(-1.0, 1.0, 1.0)] {
            let v = vertex(head, Vec3::from(place) * side);
            let along = (frame.skin[v] - rest[v]).dot((Vec3::from(way) * side).normalize());
            println!("{muscle:?}: {what} {along:.2} mm of {least}");
            if along < LAYERED_PART * least {
                wrong.push(format!("{muscle:?}: {what} went {along:.2} mm of {least}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
