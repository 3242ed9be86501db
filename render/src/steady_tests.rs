//! A face that runs all day: once it has been drawn a few times, a picture takes no new memory of ours and makes nothing
//! new on the card.

use assert_no_alloc::{AllocDisabler, assert_no_alloc};
use mouthpiece_rig::{Control, Head};
use mouthpiece_tests::or_skipped;

use crate::{Gpu, Offscreen, Tier, View};

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

#[test]
fn a_picture_of_many_makes_nothing_new() {
    let Some(gpu) = or_skipped(Gpu::headless()) else {
        return;
    };
    // The second has hairs that follow the skin, too.
    for tier in [Tier::Low, Tier::Medium] {
        makes_nothing_new(&gpu, tier);
    }
}

fn makes_nothing_new(gpu: &Gpu, tier: Tier) {
    let head = Head::reference().unwrap();
    let (size, view) = ((160, 120), View::default());
    let mut offscreen = Offscreen::new(gpu, &head, size, tier).unwrap();
    let mut key_frame = head.rest_frame();
    let mut made = Vec::new();
    for picture in 0..24 {
        key_frame.state[Control::HeadYaw] = 0.01 * picture as f32;
        key_frame.state[Control::Jaw] = 0.01 * (picture % 7) as f32;
        offscreen.render(&key_frame, &view).unwrap();
        let report = gpu.instance().generate_report().unwrap();
        let hub = report.hub_report();
        made.push([
            hub.buffers.num_allocated,
            hub.textures.num_allocated,
            hub.texture_views.num_allocated,
            hub.bind_groups.num_allocated,
            hub.render_pipelines.num_allocated,
            hub.shader_modules.num_allocated,
        ]);
        if picture > 4 {
            assert_no_alloc(|| {
                offscreen.renderer().prepare(&key_frame, &view, size);
            });
        }
    }
    let steady = made[8];
    assert!(
        made[8..].iter().all(|count| *count == steady),
        "buffers, textures, views, bind groups, pipelines, shaders: {made:?}"
    );
}
