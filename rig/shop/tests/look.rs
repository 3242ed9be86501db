//! What the shop paints and grows on a head, as one who looks at it would notice.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on should stop")]

use glam::{Vec2, Vec3, vec2, vec3};
use mouthpiece_rig::{ColourMap, Head, Material};
use mouthpiece_shop::{colour, hair};

fn head() -> Head {
    Head::reference().unwrap()
}

/// Mean colour of the map in a square of `side` (of the map's width) round a place, 0..255.
fn mean(map: &ColourMap, at: Vec2, side: f32) -> Vec3 {
    let (mut sum, mut count) = (Vec3::ZERO, 0.0);
    for (i, rgb) in map.rgb.chunks_exact(3).enumerate() {
        let (x, y) = ((i % map.width) as f32 + 0.5, (i / map.width) as f32 + 0.5);
        let off = vec2(x, y) / vec2(map.width as f32, map.height as f32) - at;
        if off.x.abs() < 0.5 * side && off.y.abs() < side {
            sum += vec3(f32::from(rgb[0]), f32::from(rgb[1]), f32::from(rgb[2]));
            count += 1.0;
        }
    }
    sum / count
}

/// Place in the map of a feature's middle.
fn middle(head: &Head, name: &str) -> Vec2 {
    let points = &head.feature(name).unwrap().points;
    points[points.len() / 2]
}

#[test]
fn lips_are_redder_and_brows_and_scalp_darker_than_the_forehead() {
    let head = head();
    let map = colour::paint(&head, 1024);
    assert_eq!(map.rgb.len(), map.width * map.height * 3);
    let forehead = mean(&map, vec2(0.5, 0.27), 0.02);
    let lower = middle(&head, "vermilion_lower_l") - vec2(0.0, 0.012);
    let lips = mean(&map, lower, 0.006);
    assert!(
        lips.y / lips.x < 0.85 * forehead.y / forehead.x,
        "lips {lips}, forehead {forehead}"
    );
    for side in ["l", "r"] {
        let lower = middle(&head, &format!("brow_lower_{side}"));
        let upper = middle(&head, &format!("brow_upper_{side}"));
        let brow = mean(&map, lower.lerp(upper, 0.5), 0.006);
        assert!(
            brow.x < 0.8 * forehead.x,
            "brow {brow}, forehead {forehead}"
        );
    }
    let scalp = mean(&map, vec2(0.5, 0.06), 0.02);
    assert!(scalp.x < 0.5 * forehead.x, "scalp {scalp}");
}

#[test]
fn every_corner_of_the_drawn_skin_finds_paint() {
    let head = head();
    let width = 512;
    let texels = colour::texels(&head.skin, width);
    let shown: f32 = head
        .skin
        .wedges
        .iter()
        .map(|w| {
            let middle = (w[0] + w[1] + w[2]) / 3.0;
            let x = (middle.x.rem_euclid(1.0) * width as f32) as usize;
            let y = (middle.y * (width / 2) as f32) as usize;
            let found = (y * width + x.min(width - 1)) < texels.len() && middle.y >= 0.0;
            let painted = found && texels[y * width + x.min(width - 1)].is_some();
            // Above the chart lies the crown, under hair.
            f32::from(u8::from(painted || middle.y < 0.02))
        })
        .sum();
    let share = shown / head.skin.wedges.len().max(1) as f32;
    assert!(share > 0.999, "{share} of the triangles have texels");
}

#[test]
fn hair_covers_the_crown_leaves_the_face_and_is_the_same_every_time() {
    let head = head();
    let part = hair::grow(&head).unwrap();
    let mesh = &part.mesh;
    assert_eq!(part.material, Material::Hair);
    // Each triangle costs as much as its pixels in software.
    assert!(mesh.triangles.len() < 12_000, "{}", mesh.triangles.len());
    for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
        assert!(p.is_finite() && (n.length() - 1.0).abs() < 1e-3);
    }
    let over = |at: Vec3, reach: f32| {
        let near = |p: &&Vec3| p.distance(at) < reach;
        mesh.positions.iter().filter(near).count()
    };
    assert!(over(vec3(0.0, 155.0, 0.0), 30.0) > 100, "a bald crown");
    let tip = head.landmarks.iter().position(|l| l.name == "prn").unwrap();
    let nose = head.landmark_places()[tip];
    assert_eq!(over(nose, 60.0), 0, "hair in the face");
    let again = hair::grow(&head).unwrap();
    assert_eq!(again.mesh.positions, mesh.positions);
}

#[test]
fn lashes_root_on_the_lids() {
    let head = head();
    let parts = hair::lashes(&head);
    assert_eq!(parts.len(), 2);
    for (part, eye) in parts.iter().zip(head.eyes) {
        let mesh = &part.mesh;
        let (mut upper, mut lower) = (0, 0);
        for (p, uv) in mesh.positions.iter().zip(&mesh.uvs) {
            match uv.y {
                0.0 => upper += 1,
                2.0 => lower += 1,
                _ => continue,
            }
            let off = p.distance(eye.centre) - eye.radius;
            assert!(
                (-2.0..6.0).contains(&off),
                "a lash roots {off} mm off the eyeball"
            );
        }
        assert!(upper > 80 && lower > 40, "{upper} and {lower}");
    }
}
