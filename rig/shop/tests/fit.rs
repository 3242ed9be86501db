//! Synthetic round trips (HEADSHOP 6): the reference head's skin, warped by a known smooth map, scanned badly, and fitted.
//! What is asked of every fit of the product: distances both ways, landmarks, no face turned over.

#![allow(clippy::unwrap_used, reason = "tests")]

#[allow(
    dead_code,
    reason = "shared with the bench and the example, each of which uses a part"
)]
mod synthetic;

use glam::{Quat, Vec3};
use mouthpiece_shop::closest::{Facing, Surface};
use mouthpiece_shop::fit::align::Similarity;
use mouthpiece_shop::fit::estimate::{Source, estimate};
use mouthpiece_shop::fit::report::{Report, Spread, report};
use mouthpiece_shop::fit::{Fit, FitError, Options, fit};
use mouthpiece_shop::warp::WarpError;
use synthetic::{Faults, Pair, warp};

const BAD_SCAN: Faults = Faults {
    noise_mm: 0.15,
    holes: true,
    clumsy_mm: 0.0,
};

fn fitted(pair: &Pair) -> (Fit, Report) {
    let scan = Surface::new(&pair.scan.0, &pair.scan.1).unwrap();
    let fit = fit(
        &pair.template(),
        &scan,
        &pair.landmarks,
        &Options::default(),
    )
    .unwrap();
    let report = report(&pair.template(), &fit, &scan, &pair.landmarks, &pair.face).unwrap();
    (fit, report)
}

fn assert_good(report: &Report) {
    assert!(report.skin_to_scan_mm.mean <= 0.3, "{report:?}");
    assert!(report.skin_to_scan_mm.p95 <= 1.2, "{report:?}");
    assert!(report.scan_to_skin_mm.mean <= 0.7, "{report:?}");
    assert_eq!(report.turned, [0; 0]);
}

fn error_on_face(pair: &Pair, fit: &Fit) -> Spread {
    let on_face = |v: &usize| pair.face[*v];
    Spread::of(
        (0..pair.truth.len())
            .filter(on_face)
            .map(|v| fit.positions[v].distance(pair.truth[v]))
            .collect(),
    )
}

#[test]
fn a_known_warp_is_found_again_through_noise_and_holes() {
    for kind in 0..4 {
        let pair = Pair::new(warp(kind), 3, BAD_SCAN);
        let (fit, report) = fitted(&pair);
        assert_good(&report);
        let landmarks = Spread::of(pair.landmark_errors(&fit, warp(kind)));
        assert!(landmarks.max < 1.5, "head {kind}: {landmarks:?}");
        let skin = error_on_face(&pair, &fit);
        assert!(skin.mean < 0.6 && skin.p95 < 1.5, "head {kind}: {skin:?}");
        // The back of the head, of which there is no scan, goes on smoothly.
        let back = Spread::of(
            (0..pair.truth.len())
                .filter(|&v| pair.positions[v].z < -40.0)
                .map(|v| fit.positions[v].distance(pair.truth[v]))
                .collect(),
        );
        assert!(back.p95 < 8.0, "head {kind}: {back:?}");
    }
}

#[test]
fn what_lies_under_the_skin_is_carried_along() {
    let pair = Pair::new(warp(3), 3, BAD_SCAN);
    let (fit, _) = fitted(&pair);
    let carrier = fit.carrier(&pair.template()).unwrap();
    let errors = |depth: f32| {
        let on_face = |v: &usize| pair.face[*v];
        let inward =
            |v: usize| pair.positions[v] - pair.positions[v].with_y(0.0).normalize() * depth;
        Spread::of(
            (0..pair.truth.len())
                .filter(on_face)
                .map(|v| carrier.point(inward(v)).distance(warp(3)(inward(v))))
                .collect(),
        )
    };
    assert!(errors(0.0).mean < 0.6, "{:?}", errors(0.0));
    assert!(errors(12.0).mean < 1.2, "{:?}", errors(12.0));
}

#[test]
fn landmarks_placed_by_an_unsteady_hand_do_not_crumple_the_face() {
    let clumsy = Faults {
        clumsy_mm: 1.5,
        ..BAD_SCAN
    };
    let pair = Pair::new(warp(2), 3, clumsy);
    let (_, report) = fitted(&pair);
    assert_good(&report);
}

#[test]
fn landmarks_that_change_places_give_way_instead_of_folding_a_lip() {
    let mut pair = Pair::new(warp(1), 3, BAD_SCAN);
    // The peaks of the upper lip, 7 mm from its middle, past it.
    let middle = pair.landmarks[7].1;
    let peak = pair
        .landmarks
        .iter()
        .position(|(from, _)| from.x > 5.0 && from.distance(pair.landmarks[7].0) < 10.0);
    pair.landmarks[peak.unwrap()].1 = middle - Vec3::X * 3.0;
    let (_, report) = fitted(&pair);
    assert_good(&report);
}

#[test]
fn a_scan_in_another_frame_inside_out_and_of_loose_triangles_is_fitted_alike() {
    let mut pair = Pair::new(warp(0), 2, BAD_SCAN);
    let turn = Quat::from_euler(glam::EulerRot::XYZ, 2.2, -0.7, 1.3);
    let place = |p: Vec3| turn * p + Vec3::new(900.0, -400.0, 77.0);
    let (points, faces) = &pair.scan;
    let loose: Vec<Vec3> = faces
        .iter()
        .flatten()
        .map(|&v| place(points[v as usize]))
        .collect();
    let turned = (0..faces.len() as u32)
        .map(|i| [3 * i, 3 * i + 2, 3 * i + 1])
        .collect();
    pair.scan = (loose, turned);
    for (_, to) in &mut pair.landmarks {
        *to = place(*to);
    }
    let (fit, report) = fitted(&pair);
    assert!(fit.inside_out);
    assert_good(&report);
}

#[test]
fn hair_specks_and_a_second_shell_inside_do_not_draw_the_skin_away() {
    let mut pair = Pair::new(warp(1), 3, BAD_SCAN);
    let (mut points, mut faces) = pair.scan.clone();
    let inner = points.len() as u32;
    // A copy 4 mm inside that faces inwards, as of a scan that was made solid; and specks in front of the face.
    let scan = Surface::new(&points, &faces).unwrap();
    let shell: Vec<Vec3> = points
        .iter()
        .zip(scan.normals())
        .map(|(p, n)| *p - *n * 4.0)
        .collect();
    faces.extend(
        pair.scan
            .1
            .iter()
            .map(|&[a, b, c]| [a + inner, c + inner, b + inner]),
    );
    points.extend(shell);
    for speck in 0..200_u32 {
        let at = points[(speck * 97) as usize] * 1.04;
        let first = points.len() as u32;
        points.extend([
            at,
            at + Vec3::new(0.8, 0.0, 0.1),
            at + Vec3::new(0.0, 0.8, 0.1),
        ]);
        faces.push([first, first + 1, first + 2]);
    }
    pair.scan = (points, faces);
    let (fit, report) = fitted(&pair);
    assert!(error_on_face(&pair, &fit).mean < 0.6);
    assert_eq!(report.turned, [0; 0]);
}

#[test]
fn six_landmarks_are_enough_for_a_start() {
    let pair = Pair::new(warp(2), 3, BAD_SCAN);
    let skin = Surface::new(&pair.positions, &pair.triangles).unwrap();
    // Tip of the nose, chin, outer corners of the eyes, corners of the mouth.
    let known = [5, 11, 15, 16, 27, 28];
    let sources: Vec<Source> = pair
        .landmarks
        .iter()
        .enumerate()
        .map(|(i, &(at, to))| {
            let hit = skin.closest(at, f32::INFINITY).unwrap();
            Source {
                at,
                normal: skin.normal(&hit),
                known: known.contains(&i).then_some(to),
            }
        })
        .collect();
    let scan = Surface::new(&pair.scan.0, &pair.scan.1).unwrap();
    let found = estimate(&sources, &scan).unwrap();
    assert_eq!(found.iter().filter(|e| !e.estimated).count(), known.len());
    let landmarks: Vec<(Vec3, Vec3)> = sources
        .iter()
        .zip(&found)
        .map(|(s, e)| (s.at, e.at))
        .collect();
    let fit = fit(&pair.template(), &scan, &landmarks, &Options::default()).unwrap();
    let report = report(&pair.template(), &fit, &scan, &landmarks, &pair.face).unwrap();
    assert_good(&report);
}

#[test]
fn swapped_sides_and_landmarks_on_one_spot_are_refused() {
    let pair = Pair::new(warp(3), 1, BAD_SCAN);
    let scan = Surface::new(&pair.scan.0, &pair.scan.1).unwrap();
    let swapped: Vec<(Vec3, Vec3)> = pair
        .landmarks
        .iter()
        .map(|&(a, b)| (a * Vec3::new(-1.0, 1.0, 1.0), b))
        .collect();
    let options = Options::default();
    assert!(matches!(
        fit(&pair.template(), &scan, &swapped, &options),
        Err(FitError::Mirrored)
    ));
    let refused = |change: &dyn Fn((Vec3, Vec3)) -> (Vec3, Vec3)| {
        let landmarks: Vec<(Vec3, Vec3)> = pair.landmarks.iter().copied().map(change).collect();
        match fit(&pair.template(), &scan, &landmarks, &options) {
            Err(FitError::Landmarks(why)) => why,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(refused(&|(a, _)| (a, Vec3::ONE)), WarpError::OneSpot);
    assert_eq!(refused(&|(_, b)| (Vec3::ONE, b)), WarpError::OneSpot);
    assert_eq!(
        refused(&|(a, b)| (a, b * f32::NAN)),
        WarpError::NotFinite(0)
    );
    assert_eq!(
        refused(&|(a, b)| (a * Vec3::new(1.0, 1.0, 0.0), b)),
        WarpError::Flat
    );
}

#[test]
fn units_show_in_the_similarity_of_the_landmarks() {
    let pair = Pair::new(warp(1), 1, BAD_SCAN);
    let (from, to): (Vec<Vec3>, Vec<Vec3>) =
        pair.landmarks.iter().map(|&(a, b)| (a, b * 0.001)).unzip();
    let scale = Similarity::between(&from, &to).unwrap().scale;
    assert!((0.0008..0.0012).contains(&scale), "{scale}");
}

#[test]
fn closest_points_and_rays_are_those_of_trying_every_triangle() {
    let pair = Pair::new(warp(0), 1, BAD_SCAN);
    let (points, faces) = &pair.scan;
    let surface = Surface::new(points, faces).unwrap();
    for i in 0..60 {
        let t = i as f32;
        let q = Vec3::new(
            (t * 1.3).sin() * 90.0,
            (t * 2.1).cos() * 110.0,
            (t * 0.7).sin() * 60.0 + 60.0,
        );
        let way = (Vec3::new(0.0, 10.0, 20.0) - q).normalize();
        let facing = Facing {
            direction: -way,
            cosine: 0.5,
        };
        for (facing, admits) in [(Facing::ANY, -1.0), (facing, 0.5)] {
            let (mut near, mut met) = (f32::INFINITY, f32::INFINITY);
            for t in faces {
                let [a, b, c] = t.map(|v| points[v as usize]);
                let n = (b - a).cross(c - a).normalize_or_zero();
                if facing.direction.dot(n) < admits || n == Vec3::ZERO {
                    continue;
                }
                near = near.min(distance(a, b, c, q));
                let along = (a - q).dot(n) / way.dot(n);
                let p = q + way * along;
                let inside = [(a, b), (b, c), (c, a)]
                    .iter()
                    .all(|(u, v)| (*v - *u).cross(p - *u).dot(n) >= 0.0);
                if along >= 0.0 && inside {
                    met = met.min(along);
                }
            }
            let hit = surface.closest_facing(q, 1e3, facing).unwrap();
            assert!(
                (hit.distance - near).abs() < 1e-3,
                "{} {near}",
                hit.distance
            );
            let [a, b, c] = surface.triangles()[hit.triangle as usize].map(|v| points[v as usize]);
            let again = a * hit.barycentric[0] + b * hit.barycentric[1] + c * hit.barycentric[2];
            assert!(again.distance(hit.point) < 1e-3);
            let ray = surface
                .ray(q, way, 1e3, facing)
                .map_or(f32::INFINITY, |h| h.distance);
            assert!(ray == met || (ray - met).abs() < 1e-2, "{ray} {met}");
            assert_eq!(surface.closest_facing(q, near * 0.99, facing), None);
        }
    }
}

/// Distance from a point to a triangle, by another road than the crate's: the plane if above it, else the sides.
fn distance(a: Vec3, b: Vec3, c: Vec3, q: Vec3) -> f32 {
    let n = (b - a).cross(c - a).normalize();
    let above = [(a, b), (b, c), (c, a)]
        .iter()
        .all(|(u, v)| (*v - *u).cross(q - *u).dot(n) >= 0.0);
    if above {
        return (q - a).dot(n).abs();
    }
    let side = |u: Vec3, v: Vec3| {
        let s = ((q - u).dot(v - u) / (v - u).length_squared()).clamp(0.0, 1.0);
        q.distance(u + (v - u) * s)
    };
    side(a, b).min(side(b, c)).min(side(c, a))
}
