//! Scans made ready for a fit, in any place, turn and unit; and what must be refused and why.

use glam::{DQuat, DVec3, Vec3, dvec3, vec3};
use mouthpiece_shop::landmarks::{Landmarks, Unit};
use mouthpiece_shop::mesh::{Options, PrepareError, Prepared, Scan, prepare, tidy};
use proptest::prelude::*;

use crate::shapes::{self, head, joined, landmarks, mask, moved, only, reference};

fn ready(scan: &Scan, landmarks: &Landmarks) -> Result<Prepared, PrepareError> {
    let options = Options {
        scan_file: "scan.ply".to_owned(),
        landmarks_file: "marks.json".to_owned(),
        ..Options::default()
    };
    prepare(scan.clone(), landmarks, &reference(), &options)
}

fn refused(scan: &Scan, landmarks: &Landmarks, parts: &[&str]) {
    match ready(scan, landmarks) {
        Ok(done) => panic!("taken, and should say {parts:?}: {:?}", done.report),
        Err(error) => {
            let message = error.to_string();
            for part in parts {
                assert!(message.contains(part), "`{part}` in: {message}");
            }
        }
    }
}

const FOUR: [&str; 4] = ["ex_l", "ex_r", "prn", "gn"];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn any_place_turn_and_unit_gives_the_same_head(
        turn in prop::array::uniform4(-1.0..1.0f64),
        shift in prop::array::uniform3(-800.0..800.0f64),
        unit in prop::sample::select(Unit::ALL.to_vec()),
        says in prop::sample::select(Unit::ALL.to_vec()),
        few: bool,
        part: bool,
    ) {
        let length = DQuat::from_array(turn).length();
        prop_assume!(length > 0.1);
        let turn = DQuat::from_array(turn) / length;
        let place = |p: DVec3| (turn * p + DVec3::from_array(shift)) / unit.mm();
        let scan = if part { mask() } else { head() };
        let mut marks = if few { only(&FOUR) } else { landmarks() };
        if part {
            marks.points.retain(|n, _| n != "v" && n != "op" && !n.starts_with("t_"));
        }
        // The landmarks say the unit rightly, in numbers of their own or in the scan's, or wrongly.
        let (there, mut there_marks) = moved(&scan, &marks, place);
        there_marks.unit = says;
        let straight = ready(&scan, &marks).unwrap();
        let turned = ready(&there, &there_marks).unwrap();
        prop_assert!((turned.report.mm_per_unit / unit.mm() - 1.0).abs() < 1e-9);
        let pairs = straight.scan.positions.iter().zip(&turned.scan.positions);
        for (a, b) in pairs {
            prop_assert!(a.distance(*b) < 0.05, "{a} {b}");
        }
        prop_assert_eq!(&straight.scan.triangles, &turned.scan.triangles);
        for ((i, a), (j, b)) in straight.landmarks.iter().zip(&turned.landmarks) {
            prop_assert!(i == j && a.distance(*b) < 0.05);
        }
        // Back to where it came from.
        for (a, b) in turned.scan.positions.iter().zip(&there.positions) {
            let back = turned.scan_from_head.transform_point3(a.as_dvec3());
            prop_assert!(back.distance(b.as_dvec3()) * unit.mm() < 0.05);
        }
    }
}

#[test]
fn landmarks_in_another_unit_than_the_scan_are_brought_to_it() {
    let (scan, _) = moved(&head(), &landmarks(), |p| p / 1000.0);
    let done = ready(&scan, &landmarks()).unwrap();
    assert_eq!(done.report.mm_per_unit, 1000.0);
    assert_eq!(done.report.notes.len(), 1);
    let direct = ready(&head(), &landmarks()).unwrap();
    assert!(done.scan.positions[100].distance(direct.scan.positions[100]) < 0.01);
}

#[test]
fn size_is_kept_and_the_face_looks_ahead() {
    let done = ready(&head(), &landmarks()).unwrap();
    let size = |scan: &Scan| {
        scan.positions
            .iter()
            .map(|p| p.distance(scan.positions[0]))
            .fold(0.0, f32::max)
    };
    assert!((size(&done.scan) - size(&head())).abs() < 0.01);
    let nose = done
        .landmarks
        .iter()
        .find(|(i, _)| reference()[*i].name == "prn")
        .unwrap()
        .1;
    assert!(done.scan.positions.iter().all(|p| p.z <= nose.z + 3.0));
    let [_, _, _, last] = done.rows();
    assert_eq!(last, [0.0, 0.0, 0.0, 1.0]);
}

#[test]
fn a_unit_that_is_said_must_make_a_head() {
    let options = Options {
        mm_per_unit: Some(1000.0),
        ..Options::default()
    };
    let message = prepare(head(), &landmarks(), &reference(), &options)
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("1000 mm") && message.contains("times as large"),
        "{message}"
    );
    let (scan, marks) = moved(&head(), &landmarks(), |p| p / 230.0);
    refused(&scan, &marks, &["marks.json", "scale the scan"]);
    let options = Options {
        mm_per_unit: Some(230.0),
        ..Options::default()
    };
    let done = prepare(scan, &marks, &reference(), &options).unwrap();
    assert!(
        done.scan.positions[100]
            .distance(ready(&head(), &landmarks()).unwrap().scan.positions[100])
            < 0.01
    );
}

#[test]
fn exchanged_sides_are_said() {
    let swapped = |marks: &Landmarks, which: &dyn Fn(&str) -> bool| {
        let name = |n: &String| match n.rsplit_once('_') {
            Some((base, "l")) if which(base) => format!("{base}_r"),
            Some((base, "r")) if which(base) => format!("{base}_l"),
            _ => n.clone(),
        };
        Landmarks {
            points: marks.points.iter().map(|(n, &p)| (name(n), p)).collect(),
            ..marks.clone()
        }
    };
    for scan in [head(), mask()] {
        let all = if scan == mask() {
            only(&["en_l", "en_r", "ex_l", "ex_r", "ch_l", "ch_r", "prn", "gn"])
        } else {
            landmarks()
        };
        refused(
            &scan,
            &swapped(&all, &|_| true),
            &["marks.json", "left and right are swapped"],
        );
        refused(
            &scan,
            &swapped(&only(&FOUR), &|_| true),
            &["left and right are swapped"],
        );
        // In one plane: the surface must tell.
        let plane = only(&["ex_l", "ex_r", "ch_l", "ch_r"]);
        assert!(ready(&scan, &plane).is_ok());
        refused(
            &scan,
            &swapped(&plane, &|_| true),
            &["left and right are swapped"],
        );
        refused(
            &scan,
            &swapped(&all, &|base| base == "ex"),
            &["ex_l and ex_r"],
        );
    }
}

#[test]
fn a_mirrored_scan_is_told_from_exchanged_landmarks() {
    let (scan, marks) = moved(&head(), &landmarks(), |p| p * dvec3(-1.0, 1.0, 1.0));
    refused(&scan, &marks, &["scan.ply", "mirror image"]);
}

#[test]
fn a_scan_inside_out_is_turned() {
    let mut scan = head();
    for t in &mut scan.triangles {
        t.swap(0, 1);
    }
    for marks in [
        landmarks(),
        only(&FOUR),
        only(&["ex_l", "ex_r", "ch_l", "ch_r"]),
    ] {
        let done = ready(&scan, &marks).unwrap();
        assert!(done.report.turned_inside_out);
        assert!(!ready(&head(), &marks).unwrap().report.turned_inside_out);
    }
}

#[test]
fn landmarks_that_place_nothing_are_refused() {
    let head = head();
    refused(
        &head,
        &only(&["prn", "gn", "n"]),
        &["3 landmark", "at least 4"],
    );
    refused(&head, &Landmarks::default(), &["0 landmark"]);
    let mut spot = landmarks();
    let nose = spot.points["prn"];
    spot.points.values_mut().for_each(|p| *p = nose);
    refused(&head, &spot, &["marks.json", "one spot"]);
    for (i, p) in spot.points.values_mut().enumerate() {
        *p += DVec3::splat(0.1 * i as f64);
    }
    refused(&head, &spot, &["one spot"]);
    // Along one meridian of the egg nearly straight: from the side of the forehead upwards.
    let mut line = only(&["n", "prn", "sn", "sto", "gn"]);
    for (i, p) in line.points.values_mut().enumerate() {
        *p = shapes::head_at(1.0, 0.0)
            .as_dvec3()
            .lerp(shapes::head_at(1.0, 0.3).as_dvec3(), i as f64 / 4.0);
    }
    refused(&head, &line, &["one line"]);
    let mut bad = landmarks();
    bad.points
        .insert("gn".to_owned(), dvec3(0.0, f64::INFINITY, 0.0));
    refused(&head, &bad, &["`gn`", "inf"]);
    bad.points.insert("gnn".to_owned(), DVec3::ZERO);
    bad.points.remove("gn");
    refused(&head, &bad, &["`gnn`", "`gn`"]);
}

#[test]
fn a_landmark_that_stands_where_it_cannot_is_named() {
    let mut two = landmarks();
    two.points.insert("ex_l".to_owned(), two.points["en_l"]);
    refused(&head(), &two, &["`en_l`", "`ex_l`", "one spot"]);
    let mut off = landmarks();
    off.points.get_mut("prn").unwrap().z += 60.0;
    refused(&head(), &off, &["`prn`", "off the scan's surface"]);
    // On the surface, but the chin's name at the temple.
    let mut astray = landmarks();
    astray
        .points
        .insert("gn".to_owned(), shapes::head_at(1.2, 0.5).as_dvec3());
    refused(&head(), &astray, &["`gn`", "from where the others say"]);
    let mut away = landmarks();
    away.points
        .values_mut()
        .for_each(|p| *p += dvec3(900.0, 0.0, 0.0));
    refused(&head(), &away, &["marks.json", "another scan"]);
    // Names dealt out anew.
    let mut dealt = landmarks();
    let points: Vec<DVec3> = dealt.points.values().copied().collect();
    let count = points.len();
    for (i, p) in dealt.points.values_mut().enumerate() {
        *p = points[(i * 7 + 3) % count];
    }
    refused(&head(), &dealt, &["marks.json"]);
}

#[test]
fn a_landmark_over_a_hole_may_hang_in_the_air() {
    // A mask has no top of the head, but one may know where it was: within reach of the rim.
    let mut marks = only(&["en_l", "en_r", "ex_l", "ex_r", "ch_l", "ch_r", "prn", "gn"]);
    marks
        .points
        .insert("v".to_owned(), shapes::head_at(0.0, 1.25).as_dvec3());
    let done = ready(&mask(), &marks).unwrap();
    assert_eq!(done.report.mid_air_landmarks, ["v"]);
}

#[test]
fn two_heads_are_refused_and_specks_are_dropped() {
    let head = head();
    let aside = |by: Vec3, scale: f32| Scan {
        positions: head.positions.iter().map(|&p| p * scale + by).collect(),
        ..head.clone()
    };
    for (by, scale) in [(vec3(250.0, 0.0, 0.0), 1.0), (vec3(0.0, 20.0, 900.0), 0.9)] {
        refused(
            &joined(head.clone(), &aside(by, scale)),
            &landmarks(),
            &["scan.ply", "two heads"],
        );
    }
    let speck = joined(head.clone(), &aside(vec3(30.0, 0.0, 60.0), 0.01));
    let far = joined(speck, &aside(vec3(0.0, 0.0, 700.0), 0.1));
    let done = ready(&far, &landmarks()).unwrap();
    assert_eq!(done.report.dropped.islands, 2);
    assert_eq!(
        done.scan.positions.len(),
        ready(&head, &landmarks()).unwrap().scan.positions.len()
    );
    // An eye in its socket is no debris.
    let eye = joined(head.clone(), &aside(vec3(30.0, 40.0, 70.0), 0.1));
    assert_eq!(ready(&eye, &landmarks()).unwrap().report.dropped.islands, 0);
}

#[test]
fn halves_that_do_not_touch_are_one_head() {
    let head = head();
    let side = |left: bool| {
        let keep = |t: &&[u32; 3]| {
            (t.iter().map(|&i| head.positions[i as usize].x).sum::<f32>() > 0.0) == left
        };
        Scan {
            triangles: head.triangles.iter().filter(keep).copied().collect(),
            ..head.clone()
        }
    };
    let halves = joined(side(true), &side(false));
    assert!(ready(&halves, &landmarks()).is_ok());
}

#[test]
fn soup_is_welded_and_colours_follow() {
    use mouthpiece_shop::mesh::ScanColour;
    let head = head();
    let corners = head.triangles.iter().flatten();
    let soup = Scan {
        positions: corners
            .clone()
            .map(|&i| head.positions[i as usize])
            .collect(),
        triangles: (0..head.triangles.len() as u32)
            .map(|t| [3 * t, 3 * t + 1, 3 * t + 2])
            .collect(),
        colour: Some(ScanColour::PerVertex(
            corners.map(|&i| [i as u8, (i >> 8) as u8, 0]).collect(),
        )),
    };
    let (tidied, dropped) = tidy(soup).unwrap();
    assert_eq!(tidied.positions.len(), head.positions.len());
    assert_eq!(
        dropped.welded_vertices,
        head.triangles.len() * 3 - head.positions.len()
    );
    let Some(ScanColour::PerVertex(colours)) = &tidied.colour else {
        panic!("colours are lost")
    };
    for (p, c) in tidied.positions.iter().zip(colours) {
        let i = head.positions.iter().position(|q| q == p).unwrap();
        assert_eq!(*c, [i as u8, (i >> 8) as u8, 0]);
    }
}
