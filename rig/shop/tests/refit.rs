//! Whole heads out of scans (HEADSHOP 5.2 and 6): the reference head warped by a known smooth map, drawn finely, scanned
//! badly, and made a head again. Guards what a user gets: a face in the right place, a file that is whole, a mouth that
//! speaks, the scan's colour.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "tests")]

use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

use glam::{DVec3, Quat, Vec3, vec3};
use mouthpiece_rig::{Articulation, Detail, Head, Simulation, lip_level, measure};
use mouthpiece_shop::closest::Surface;
use mouthpiece_shop::landmarks::{Landmarks, Unit};
use mouthpiece_shop::mesh::{Scan, ScanColour};
use mouthpiece_shop::refit::{Fitted, Options, RefitError, fit_head, landmarks_of};

/// A scan as files have it, its landmarks, and the truth.
struct Scanned {
    scan: Scan,
    landmarks: Landmarks,
    /// Where the landmarks of the reference head truly are, mm, in the scan's frame.
    truth: HashMap<String, Vec3>,
}

/// Another face: narrow, with a long nose and a strong chin, asymmetric by a little.
fn other(p: Vec3) -> Vec3 {
    let bump = |at: Vec3, wide: f32| (-(p - at).length_squared() / (wide * wide)).exp();
    p * vec3(0.93, 1.03, 1.01)
        + vec3(0.0, -4.0, 11.0) * bump(vec3(0.0, 0.0, 128.0), 27.0)
        + vec3(0.5, -3.0, 6.0) * bump(vec3(0.0, -76.0, 104.0), 30.0)
        + vec3(1.5 * (p.y / 60.0).sin(), 0.0, 2.0 * (p.x / 50.0).sin())
}

/// A child's, by size and by proportion.
fn child(p: Vec3) -> Vec3 {
    let high = ((p.y - 40.0) / 100.0).clamp(0.0, 1.0);
    p * vec3(0.82, 0.77, 0.80) + Vec3::Y * (6.0 * high)
}

/// About normal, the same every run.
fn random(i: usize, salt: u32) -> Vec3 {
    let one = |k: u32| {
        let mut sum = 0.0;
        for j in 0..4_u32 {
            let mut h = (i as u32).wrapping_mul(0x9E37_79B9)
                ^ (k * 31 + j + salt * 977).wrapping_mul(0x85EB_CA6B);
            h = (h ^ (h >> 15)).wrapping_mul(0x2C1B_3C6D);
            h = (h ^ (h >> 12)).wrapping_mul(0x297A_2D39);
            sum += (h >> 8) as f32 / (1 << 24) as f32 - 0.5;
        }
        sum * 3.0_f32.sqrt()
    };
    vec3(one(0), one(1), one(2))
}

/// In metres, somewhere, turned; with noise and holes, without the back and the insides.
fn scanned(head: &Head, warp: impl Fn(Vec3) -> Vec3) -> Scanned {
    let detail = Detail {
        levels: 1,
        ..Detail::default()
    };
    let fine = head.subdivision(&detail).unwrap();
    let mut points = vec![Vec3::ZERO; fine.point_count()];
    fine.apply(&head.skin.mesh.positions, &mut points);
    let wet = fine.spread(&head.skin.wet);
    for copy in fine.copies() {
        points.push(points[*copy as usize]);
    }
    let wet_at = |v: u32| wet.get(v as usize).copied().unwrap_or(0.0);
    let holes = [
        vec3(45.0, 0.0, 88.0),
        vec3(-30.0, 90.0, 92.0),
        vec3(12.0, -60.0, 106.0),
    ];
    let seen = |v: &u32| {
        let p = points[*v as usize];
        p.z > -25.0 && wet_at(*v) < 0.5 && holes.iter().all(|h| p.distance(*h) > 7.0)
    };
    let triangles: Vec<[u32; 3]> = fine
        .triangles()
        .iter()
        .filter(|t| t.iter().all(seen))
        .copied()
        .collect();
    let turn = Quat::from_euler(glam::EulerRot::XYZ, 2.2, -0.7, 1.3);
    let place = |p: Vec3| turn * p + vec3(300.0, -90.0, 40.0);
    let truth: HashMap<String, Vec3> = landmarks_of(head)
        .unwrap()
        .into_iter()
        .map(|r| (r.name, place(warp(r.at))))
        .collect();
    let points = truth
        .iter()
        // The back of the head is not there.
        .filter(|(name, _)| *name != "op")
        .map(|(name, at)| (name.clone(), at.as_dvec3() / 1000.0))
        .collect::<BTreeMap<String, DVec3>>();
    let landmarks = Landmarks {
        unit: Unit::Metre,
        points,
    };
    // Copies at seams of the texture get the noise of what they repeat.
    let number = |i: usize| {
        let own = fine.point_count();
        if i < own {
            i
        } else {
            fine.copies()[i - own] as usize
        }
    };
    let positions = {
        let mut all = vec![Vec3::ZERO; fine.point_count()];
        fine.apply(&head.skin.mesh.positions, &mut all);
        (0..fine.vertex_count())
            .map(|i| place(warp(all[number(i)]) + random(number(i), 3) * 0.12) / 1000.0)
            .collect()
    };
    Scanned {
        scan: Scan {
            positions,
            triangles,
            colour: None,
        },
        landmarks,
        truth,
    }
}

fn made(reference: &Head, of: &Scanned) -> Fitted {
    let options = Options::default();
    fit_head(reference, of.scan.clone(), &of.landmarks, &options, |_| {}).unwrap()
}

/// A place of the new head in the scan's frame, mm.
fn in_scan(fitted: &Fitted, p: Vec3) -> Vec3 {
    let rows = fitted.report.scan_from_head;
    let p = [f64::from(p.x), f64::from(p.y), f64::from(p.z), 1.0];
    let row = |i: usize| (0..4).map(|k| rows[i][k] * p[k]).sum::<f64>() * 1000.0;
    vec3(row(0) as f32, row(1) as f32, row(2) as f32)
}

fn drawn(head: &Head) -> Vec<Vec3> {
    let limit = head.skin_limit().unwrap();
    let mut drawn = vec![Vec3::ZERO; limit.len()];
    limit.apply(&head.skin.mesh.positions, &mut drawn);
    drawn
}

#[test]
fn a_known_face_comes_back_from_a_bad_scan() {
    let reference = Head::reference().unwrap();
    for warp in [other, child] {
        let scanned = scanned(&reference, warp);
        let fitted = made(&reference, &scanned);
        let report = &fitted.report;
        assert!(report.skin_to_scan_mm.mean <= 0.3, "{report:?}");
        assert!(report.skin_to_scan_mm.p95 <= 1.2, "{report:?}");
        assert!(report.scan_to_skin_mm.mean <= 0.7, "{report:?}");
        assert!(report.turned_faces <= 0.0005, "{report:?}");
        assert_eq!(report.turned_at_features, 0);
        assert!(report.landmark_error_mm.max < 1.5, "{report:?}");
        assert_eq!(report.estimated_landmarks, ["op"]);
        assert!((report.preparation.mm_per_unit - 1000.0).abs() < 1.0);
        for mark in landmarks_of(&fitted.head).unwrap() {
            let off = in_scan(&fitted, mark.at).distance(scanned.truth[&mark.name]);
            let room = if mark.name == "op" { 12.0 } else { 1.5 };
            assert!(off < room, "{} is {off} mm off", mark.name);
        }
    }
}

#[test]
fn every_part_of_the_new_file_is_there_finite_and_of_the_same_topology() {
    let reference = Head::reference().unwrap();
    let fitted = made(&reference, &scanned(&reference, child));
    let read = Head::read(&fitted.head.write()).unwrap();
    assert_eq!(read.fibres.len(), reference.fibres.len());
    for (a, b) in read.fibres.iter().zip(&fitted.head.fibres) {
        for (p, q) in a.points.iter().zip(&b.points) {
            assert!(p.is_finite() && p.distance(*q) < 0.05);
        }
    }
    for head in [&fitted.head, &read] {
        let names = |h: &Head| h.parts.iter().map(|p| p.name.clone()).collect::<Vec<_>>();
        assert_eq!(names(head), names(&reference));
        for (new, old) in head.parts.iter().zip(&reference.parts) {
            assert_eq!(new.mesh.triangles, old.mesh.triangles, "{}", new.name);
            assert_eq!(new.weight.len(), old.weight.len());
            assert_eq!(new.bodies, old.bodies);
        }
        assert_eq!(head.skin.mesh.triangles, reference.skin.mesh.triangles);
        assert_eq!(head.lips, reference.lips);
        assert_eq!(head.landmarks.len(), reference.landmarks.len());
        assert_eq!(head.muscles, reference.muscles);
        assert_eq!(head.features, reference.features);
        let meshes = head.parts.iter().map(|p| &p.mesh).chain([&head.skin.mesh]);
        for mesh in meshes {
            assert!(mesh.positions.iter().all(|p| p.is_finite()));
            let unit = |n: &Vec3| (n.length() - 1.0).abs() < 1e-2;
            assert!(mesh.normals.iter().all(unit));
        }
        // Manifold: no directed edge comes twice.
        let mut seen = HashSet::new();
        for t in &head.skin.mesh.triangles {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                assert!(seen.insert((a, b)), "edge {a} {b} comes twice");
            }
        }
        // A head is about as large as the scanned one, bone is under skin, teeth behind lips.
        let height = |h: &Head, name: &str| {
            let y = h.part(name).unwrap().mesh.positions.iter().map(|p| p.y);
            let (low, high) = y.fold((f32::MAX, f32::MIN), |(l, h), y| (l.min(y), h.max(y)));
            high - low
        };
        for name in ["skull", "mandible", "hair", "teeth_upper", "eye_l"] {
            let share = height(head, name) / height(&reference, name);
            assert!((0.70..0.92).contains(&share), "{name}: {share}");
        }
    }
}

#[test]
fn eyes_lie_behind_their_lids_and_lips_meet() {
    let reference = Head::reference().unwrap();
    for warp in [other, child] {
        let head = made(&reference, &scanned(&reference, warp)).head;
        let skin = drawn(&head);
        for lid in &head.lids {
            let eye = head.eyes[usize::from(!lid.left)];
            let over = skin[lid.vertex as usize].distance(eye.centre) - eye.radius;
            assert!(over > -0.25, "a lid lies {over} mm over the eyeball");
        }
        for (eye, old) in head.eyes.iter().zip(&reference.eyes) {
            let off = eye
                .centre
                .distance(warp(old.centre) + (head.neck_pivot - warp(reference.neck_pivot)));
            assert!(off < 4.0, "an eye is {off} mm off");
        }
        for (upper, lower) in head.lips.upper.iter().zip(&head.lips.lower) {
            let [a, b] = [upper, lower].map(|c| skin[c[lip_level::CONTACT] as usize]);
            assert!(a.distance(b) < 1e-3, "{a} {b}");
        }
    }
}

/// How high each vertex of a part lies over the dry skin, mm; only those near it.
fn heights(head: &Head, part: &str) -> Vec<Option<f32>> {
    const NEAR_MM: f32 = 8.0;
    let dry = |t: &&[u32; 3]| t.iter().all(|v| head.skin.wet[*v as usize] < 0.5);
    let triangles = head.skin.mesh.triangles.iter().filter(dry).copied();
    let skin = Surface::new(&drawn(head), &triangles.collect::<Vec<_>>()).unwrap();
    let places = &head.part(part).unwrap().mesh.positions;
    places
        .iter()
        .map(|p| {
            let hit = skin.closest(*p, NEAR_MM)?;
            Some((*p - hit.point).dot(skin.normal(&hit)))
        })
        .collect()
}

#[test]
fn bones_stay_under_the_skin_and_hair_over_it() {
    let reference = Head::reference().unwrap();
    for warp in [other, child] {
        let head = made(&reference, &scanned(&reference, warp)).head;
        for part in ["skull", "mandible"] {
            let pairs = heights(&reference, part);
            let worse = heights(&head, part)
                .into_iter()
                .zip(pairs)
                .filter(|pair| matches!(pair, (Some(new), Some(old)) if *new > old.max(-0.5) + 1.0))
                .count();
            assert!(worse < 5, "{worse} vertices of the {part} come out");
        }
        let sunk = |head: &Head| {
            let all = heights(head, "hair");
            all.iter().flatten().filter(|h| **h < -1.0).count() as f32 / all.len() as f32
        };
        let (before, after) = (sunk(&reference), sunk(&head));
        assert!(after < before + 0.02, "hair sinks: {before} {after}");
    }
}

#[test]
fn the_new_head_speaks() {
    let reference = Head::reference().unwrap();
    for warp in [other, child] {
        let head = Arc::new(made(&reference, &scanned(&reference, warp)).head);
        let settled = |articulation: &Articulation| {
            let controls = head.calibration.controls(articulation);
            let mut simulation = Simulation::new(Arc::clone(&head));
            let mut frame = head.rest_frame();
            for _ in 0..240 {
                simulation.step(&controls);
            }
            simulation.save(&mut frame);
            measure(&head, &frame)
        };
        let m = settled(&Articulation {
            aperture_mm: -1.0,
            width: 1.0,
            jaw_rad: 0.02,
            ..Articulation::REST
        });
        assert!(m.aperture_mm < 0.1, "pressed lips gape: {m:?}");
        let aa = settled(&Articulation {
            aperture_mm: 12.0,
            width: 1.0,
            jaw_rad: 0.2,
            ..Articulation::REST
        });
        assert!(aa.aperture_mm > 7.0, "an open mouth is shut: {aa:?}");
    }
}

#[test]
fn four_landmarks_make_a_head_and_the_others_are_told() {
    let reference = Head::reference().unwrap();
    let mut scanned = scanned(&reference, other);
    let given = ["ex_l", "ex_r", "prn", "gn"];
    let known = |name: &String, _: &mut DVec3| given.contains(&name.as_str());
    scanned.landmarks.points.retain(known);
    let fitted = made(&reference, &scanned);
    let all = landmarks_of(&reference).unwrap().len();
    assert_eq!(fitted.report.estimated_landmarks.len(), all - 4);
    assert!(!fitted.report.preparation.turned_inside_out);
    assert!(fitted.report.skin_to_scan_mm.mean < 0.5);
    assert_eq!(fitted.report.turned_at_features, 0);
    Head::read(&fitted.head.write()).unwrap();
}

#[test]
fn the_colour_of_a_scan_is_the_new_heads_and_hair_is_not() {
    let reference = Head::reference().unwrap();
    let mut scanned = scanned(&reference, other);
    let tone = [120, 80, 60];
    scanned.scan.colour = Some(ScanColour::PerVertex(vec![
        tone;
        scanned.scan.positions.len()
    ]));
    let fitted = made(&reference, &scanned);
    let share = fitted.report.scan_colour;
    assert!((0.1..0.7).contains(&share), "{share}");
    let map = fitted.head.colour.unwrap();
    let old = reference.colour.as_ref().unwrap();
    assert_eq!((map.width, map.height), (old.width, old.height));
    let at = |map: &mouthpiece_rig::ColourMap, u: f32, v: f32| {
        let (x, y) = (
            (u * map.width as f32) as usize,
            (v * map.height as f32) as usize,
        );
        let i = 3 * (y * map.width + x);
        [map.rgb[i], map.rgb[i + 1], map.rgb[i + 2]]
    };
    // The cheeks and the forehead.
    for (u, v) in [(0.60, 0.62), (0.40, 0.62), (0.5, 0.27)] {
        let found = at(&map, u, v);
        let near = found.iter().zip(tone).all(|(a, b)| a.abs_diff(b) <= 3);
        assert!(near, "{found:?} at {u} {v}");
    }
    // The nape, which was not scanned, took the tone.
    let (before, after) = (at(old, 0.02, 0.85), at(&map, 0.02, 0.85));
    assert!(
        i32::from(after[0]) < i32::from(before[0]) - 25,
        "{before:?} {after:?}"
    );
}

#[test]
fn what_is_no_face_is_refused() {
    let reference = Head::reference().unwrap();
    let mut scanned = scanned(&reference, other);
    scanned.landmarks.points.insert("nose".into(), DVec3::ONE);
    let refused = fit_head(
        &reference,
        scanned.scan,
        &scanned.landmarks,
        &Options::default(),
        |_| {},
    );
    assert!(matches!(refused, Err(RefitError::Prepare(_))));
}
