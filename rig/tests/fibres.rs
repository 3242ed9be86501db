//! HABER 5.1 point by point, by numbers: what fibres do alone, what they do to those they are merged with,
//! and that skin which hangs on them does not fold over.

use std::sync::{Arc, OnceLock};

use glam::{Affine3A, Vec3};
use mouthpiece_rig::{
    Contraction, Control, Controls, Fibre, Head, KeyFrame, LIP_LEVELS, Muscle, Simulation,
};

#[allow(
    clippy::unwrap_used,
    reason = "a helper of tests; clippy sees only test functions"
)]
fn head() -> &'static Arc<Head> {
    static HEAD: OnceLock<Arc<Head>> = OnceLock::new();
    HEAD.get_or_init(|| Arc::new(Head::reference().unwrap()))
}

fn controls(values: &[(Control, f32)]) -> Controls {
    let mut controls = Controls::default();
    for (control, value) in values {
        controls[*control] = *value;
    }
    controls
}

/// A third of a second of it.
fn moved(values: &[(Control, f32)]) -> (Simulation, KeyFrame) {
    let mut simulation = Simulation::new(Arc::clone(head()));
    for _ in 0..160 {
        simulation.step(&controls(values));
    }
    let mut frame = KeyFrame::default();
    simulation.save(&mut frame);
    (simulation, frame)
}

fn alone(fibre: &Fibre, values: &[(Control, f32)]) -> Vec<Vec3> {
    let mut points = fibre.points.clone();
    fibre.contracted(&controls(values), &Affine3A::IDENTITY, &mut points);
    points
}

fn length(points: &[Vec3]) -> f32 {
    points.windows(2).map(|w| w[0].distance(w[1])).sum()
}

/// How far along a polygon the place on it is that lies nearest to `p`, mm.
fn along(points: &[Vec3], p: Vec3) -> f32 {
    let (mut best, mut before) = ((f32::MAX, 0.0), 0.0);
    for w in points.windows(2) {
        let d = w[1] - w[0];
        let share = ((p - w[0]).dot(d) / d.length_squared()).clamp(0.0, 1.0);
        let distance = p.distance(w[0] + d * share);
        if distance < best.0 {
            best = (distance, before + share * d.length());
        }
        before += d.length();
    }
    best.1
}

/// How straight a polygon is: 1 on a line.
fn straight(points: &[Vec3]) -> f32 {
    points[0].distance(points[points.len() - 1]) / length(points)
}

/// The fibres of a muscle, each with its control points in motion.
fn fibres(simulation: &Simulation, muscle: Muscle) -> Vec<(&'static Fibre, Vec<Vec3>)> {
    let mut start = 0;
    let mut found = Vec::new();
    for fibre in &head().fibres {
        let points = &simulation.fibre_points()[start..start + fibre.points.len()];
        start += fibre.points.len();
        if fibre.muscle == muscle {
            found.push((fibre, points.to_vec()));
        }
    }
    found
}

#[test]
fn a_linear_fibre_loses_the_same_share_of_its_length_for_every_share_of_contraction() {
    for fibre in &head().fibres {
        if fibre.contraction != Contraction::Linear {
            continue;
        }
        let control = Control::contraction(fibre.muscle);
        let rest = length(&fibre.points);
        let lost = |c: f32| {
            let end = alone(fibre, &[(control, c)])[fibre.points.len() - 1];
            1.0 - along(&fibre.points, end) / rest
        };
        let (half, full) = (lost(0.5), lost(1.0));
        assert!((0.17..0.40).contains(&full), "{:?}: {full}", fibre.muscle);
        assert!(
            (half / full - 0.5).abs() < 0.01,
            "{:?}: {half} of {full}",
            fibre.muscle
        );
        let origin = alone(fibre, &[(control, 1.0)])[0];
        assert!(origin.distance(fibre.points[0]) < 1e-4);
    }
}

#[test]
fn protrusion_is_linear_from_the_inner_fibre_to_the_outer() {
    for (muscle, control) in [
        (Muscle::OrbicularisOrisSuperior, Control::ProtrusionSuperior),
        (Muscle::OrbicularisOrisInferior, Control::ProtrusionInferior),
    ] {
        let forward: Vec<f32> = head()
            .fibres
            .iter()
            .filter(|f| f.muscle == muscle)
            .map(|f| alone(f, &[(control, 1.0)])[4].z - f.points[4].z)
            .collect();
        let [inner, between, outer] = forward[..] else {
            panic!("three fibres, not {forward:?}");
        };
        // The middle fibre is painted three quarters of the way in.
        let share = (between - outer) / (inner - outer);
        assert!((share - 0.75).abs() < 1e-3, "{forward:?}");
        assert!(outer < 0.2 * inner, "{forward:?}");
    }
}

#[test]
fn a_muscle_is_drawn_straight_by_the_one_that_pulls_its_end_away() {
    let (simulation, _) = moved(&[(Control::DepressorAnguliOris, 1.0)]);
    for (fibre, now) in fibres(&simulation, Muscle::ZygomaticusMajor) {
        let longer = length(&now) / length(&fibre.points);
        let bend = |p: &[Vec3]| 1.0 - straight(p);
        assert!(longer > 1.02, "it is drawn out: {longer}");
        assert!(
            bend(&now) < 0.6 * bend(&fibre.points),
            "{} of {}",
            bend(&now),
            bend(&fibre.points)
        );
        assert!(now[0].distance(fibre.points[0]) < 1e-4, "on the bone");
    }
}

#[test]
fn contracted_muscles_are_thicker_and_push_the_lips_out() {
    let pursed = [
        (Control::OrbicularisOrisSuperior, 0.8),
        (Control::OrbicularisOrisInferior, 0.8),
    ];
    let (simulation, frame) = moved(&pursed);
    for muscle in [
        Muscle::OrbicularisOrisSuperior,
        Muscle::OrbicularisOrisInferior,
    ] {
        for (fibre, now) in fibres(&simulation, muscle) {
            let factor = fibre.thickened(&now);
            let volume = factor * length(&now) / length(&fibre.points);
            assert!(factor > 1.15, "{muscle:?} is {factor} times as thick");
            assert!((volume - 1.0).abs() < 1e-3, "volume times {volume}");
            let belly = fibre.thickness_mm(fibre.points.len() / 2);
            assert!(belly > fibre.thickness_mm(0) && belly < 6.0, "{belly} mm");
        }
    }
    // Contraction leaves depth along the axis alone: what comes forward is thickness.
    let middle = head().lips.upper.len() / 2;
    for lip in [&head().lips.upper, &head().lips.lower] {
        let v = lip[middle][0] as usize;
        let forward = frame.skin[v].z - head().skin.mesh.positions[v].z;
        assert!(forward > 0.3, "the lip came {forward} mm forward");
    }
}

#[test]
fn the_lower_lip_follows_a_smile() {
    let (simulation, frame) = moved(&[(Control::ZygomaticusMajor, 1.0)]);
    for (muscle, least) in [
        (Muscle::OrbicularisOrisSuperior, 2.0),
        (Muscle::OrbicularisOrisInferior, 1.0),
    ] {
        for (fibre, now) in fibres(&simulation, muscle) {
            let longer = length(&now) / length(&fibre.points);
            assert!(longer > 1.04, "{muscle:?} is stretched: {longer}");
            let raised: Vec<f32> = now
                .iter()
                .zip(&fibre.points)
                .filter(|(_, p)| (14.0..18.0).contains(&p.x.abs()))
                .map(|(q, p)| q.y - p.y)
                .collect();
            assert!(
                raised.iter().all(|mm| *mm > least),
                "{muscle:?} rises by {raised:.1?} mm"
            );
        }
    }
    // The skin of the lower lip a third of the way from the corner.
    let column = head().lips.lower[head().lips.lower.len() * 5 / 6][0] as usize;
    let raised = frame.skin[column].y - head().skin.mesh.positions[column].y;
    assert!(raised > 1.0, "the lower lip rises by {raised} mm");
}

#[test]
fn each_half_of_the_orbicularis_oris_protrudes_its_own_lip() {
    let (_, frame) = moved(&[(Control::ProtrusionSuperior, 0.8)]);
    let forward = |lip: &[[u32; LIP_LEVELS]]| {
        let v = lip[lip.len() / 2][0] as usize;
        frame.skin[v].z - head().skin.mesh.positions[v].z
    };
    let (upper, lower) = (forward(&head().lips.upper), forward(&head().lips.lower));
    assert!(
        upper > 3.0 && lower < 0.4 * upper,
        "{upper} and {lower} mm forward"
    );
}

#[test]
fn the_mandible_takes_along_what_hangs_on_it() {
    let (simulation, frame) = moved(&[(Control::Jaw, 0.2)]);
    let mandible = head().mandible(frame.state[Control::Jaw]);
    for (fibre, now) in fibres(&simulation, Muscle::DepressorLabiiInferioris) {
        let there = mandible.transform_point3(fibre.points[0]);
        assert!(now[0].distance(there) < 0.01, "its origin is on the jaw");
        assert!(there.distance(fibre.points[0]) > 10.0, "and that is open");
    }
    for (fibre, now) in fibres(&simulation, Muscle::ZygomaticusMajor) {
        assert!(now[0].distance(fibre.points[0]) < 1e-4, "on the skull");
        let end = now[now.len() - 1] - fibre.points[fibre.points.len() - 1];
        assert!(
            end.y < -2.0,
            "its insertion goes down with the corner: {end}"
        );
    }
}

/// What is turned over of the skin outside the mouth within 55 mm of it: triangles that face away from
/// where they faced at rest.
fn turned(frame: &KeyFrame) -> usize {
    let skin = &head().skin;
    let normal = |p: &[Vec3], t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| p[i as usize]);
        (b - a).cross(c - a)
    };
    let near = |t: &&[u32; 3]| {
        t.iter().all(|&v| {
            let v = v as usize;
            skin.wet[v] == 0.0 && skin.reference[v].distance(Vec3::new(0.0, -36.0, 108.0)) < 55.0
        })
    };
    let rest = &skin.mesh.positions;
    let over = |t: &&[u32; 3]| normal(rest, t).dot(normal(&frame.skin, t)) < 0.0;
    skin.mesh.triangles.iter().filter(near).filter(over).count()
}

/// Before muscles of the corner shared a node and holds were spread over the mesh, these 60 turned over
/// some 1,700 triangles, in each of them some.
#[test]
fn muscles_that_work_hard_together_do_not_fold_the_skin() {
    let mut state = 0x1234_5678_9abc_def1_u64;
    let mut random = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 40) as f32 / (1_u64 << 24) as f32
    };
    let mut all = 0;
    for _ in 0..60 {
        let mut values = Vec::new();
        for _ in 0..2 + (random() * 3.0) as usize {
            let muscle = Muscle::ALL[(random() * 12.0) as usize];
            values.push((Control::contraction(muscle), 0.6 + 0.4 * random()));
        }
        if random() < 0.3 {
            values.push((Control::ProtrusionSuperior, 2.0 * random() - 1.0));
            values.push((Control::ProtrusionInferior, 2.0 * random() - 1.0));
        }
        if random() < 0.3 {
            values.push((Control::Jaw, 0.25 * random()));
        }
        let (_, frame) = moved(&values);
        let count = turned(&frame);
        assert!(
            count <= 24,
            "{count} triangles are turned over by {values:?}"
        );
        all += count;
    }
    println!("{all} triangles turned over in 60 postures");
    assert!(all <= 220, "{all} triangles are turned over in 60 postures");
}
