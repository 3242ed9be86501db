//! Measurements: only what has its landmarks, pairs by their sides.

use mouthpiece_rig::{Head, Landmark, Layer, SurfacePoint, measurements};

fn put(head: &mut Head, name: &str, vertex: u32) {
    head.landmarks.push(Landmark {
        name: name.into(),
        layer: Layer::Skin,
        at: SurfacePoint {
            vertices: [vertex; 3],
            shares: [0.5, 0.25, 0.25],
        },
        of: None,
    });
}

#[test]
fn only_what_has_its_landmarks_is_measured() {
    let mut head = Head::reference().unwrap();
    head.landmarks.clear();
    assert!(measurements(&head).is_empty());
    for (name, vertex) in [("en_l", 10), ("en_r", 20), ("ex_l", 30), ("n", 40)] {
        put(&mut head, name, vertex);
    }
    let drawn = head.drawn_rest();
    let at = |v: usize| drawn[v];
    let found = measurements(&head);
    assert_eq!(found.len(), 1);
    assert_eq!((found[0].name.as_str(), found[0].sides_mm), ("en-en", None));
    assert!((found[0].mm - at(10).distance(at(20))).abs() < 1e-4);
}

#[test]
fn a_pair_is_measured_on_both_sides() {
    let mut head = Head::reference().unwrap();
    head.landmarks.clear();
    for (name, vertex) in [("t_l", 10), ("t_r", 20), ("gn", 30)] {
        put(&mut head, name, vertex);
    }
    let drawn = head.drawn_rest();
    let at = |v: usize| drawn[v];
    let found = measurements(&head);
    let [left, right] = found[0].sides_mm.unwrap();
    assert_eq!(found[0].name, "t-gn");
    assert!((left - at(10).distance(at(30))).abs() < 1e-4);
    assert!((right - at(20).distance(at(30))).abs() < 1e-4);
    assert!((found[0].mm - 0.5 * (left + right)).abs() < 1e-4);
}
