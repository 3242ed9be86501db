//! Would the golden pictures notice a wrong shader? Draws the face with one line of a shader changed and asks what they
//! are judged by.

use mouthpiece_rig::Head;
use mouthpiece_tests::or_skipped;
use mouthpiece_tests::picture::Picture;

use crate::{Gpu, Offscreen, Tier, View};

const SIZE: (u32, u32) = (240, 300);

/// A shader's file, a line of it, and what takes its place.
const WRONG: [[&str; 3]; 3] = [
    // Lit from the wrong side; without the colour map's own encoding; eyes without a colour.
    [
        "skin",
        "let l = frame.key_dir.xyz;",
        "let l = -frame.key_dir.xyz;",
    ],
    ["skin", "texel.rgb * texel.rgb", "texel.rgb"],
    ["eye", "texel.rgb * texel.rgb", "vec3(0.0)"],
];

#[test]
fn a_wrong_shader_is_seen() {
    let Some(gpu) = or_skipped(Gpu::headless()) else {
        return;
    };
    let head = Head::reference().unwrap();
    let mut offscreen = Offscreen::new(&gpu, &head, SIZE, Tier::Medium).unwrap();
    let mut draw = |edit: Option<[&str; 3]>| {
        offscreen.renderer().pipelines.edit(edit);
        let pixels = offscreen
            .render(&head.rest_frame(), &View::default())
            .unwrap();
        Picture::from_rgba(SIZE.0, SIZE.1, pixels)
    };
    let right = draw(None);
    assert!(draw(None).difference(&right).is_none(), "the same twice");
    for edit in WRONG {
        let found = draw(Some(edit)).difference(&right);
        println!(
            "{edit:?}: mean {:.4}, worst tile {:.3}",
            found.mean, found.worst_tile
        );
        assert!(!found.is_none(), "{edit:?} is not seen");
    }
}
