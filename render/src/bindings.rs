//! What the shaders read beside vertices, bound once: the shadow map, and the maps of skin, eyes and hair.

use mouthpiece_rig::Head;

use crate::gpu::Gpu;
use crate::maps::Maps;
use crate::pipelines::Layouts;
use crate::targets::{DEPTH, texture};
use crate::tier::Detail;
use crate::upload;

/// The maps of the materials that have some.
#[derive(Debug)]
pub(crate) struct MapGroups {
    pub(crate) skin: wgpu::BindGroup,
    pub(crate) eye: wgpu::BindGroup,
    pub(crate) hair: wgpu::BindGroup,
}

/// Paints the maps of `head` and puts them on the card.
pub(crate) fn maps(gpu: &Gpu, layouts: &Layouts, head: &Head, detail: &Detail) -> MapGroups {
    let painted = Maps::paint(head, detail);
    let eye = upload::image(gpu, "eye", painted.eye);
    let hair = upload::image(gpu, "hair", painted.hair);
    let colour = upload::image(gpu, "skin colour", painted.skin.colour);
    let fine = upload::image(gpu, "skin detail", painted.skin.detail);
    // Never in software: Mesa's rasteriser was seen to take minutes over one anisotropic frame.
    let anisotropy = if gpu.is_software() {
        1
    } else {
        detail.anisotropy
    };
    let sampler = gpu.device().create_sampler(&wgpu::SamplerDescriptor {
        label: Some("maps"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        // In software a second level is a second read; anisotropic reads need it.
        mipmap_filter: if anisotropy > 1 {
            wgpu::MipmapFilterMode::Linear
        } else {
            wgpu::MipmapFilterMode::Nearest
        },
        anisotropy_clamp: anisotropy,
        ..Default::default()
    });
    let bound = |first, second| {
        let view = wgpu::BindingResource::TextureView;
        group(
            gpu.device(),
            &layouts.maps,
            &[
                wgpu::BindingResource::Sampler(&sampler),
                view(first),
                view(second),
            ],
        )
    };
    MapGroups {
        skin: bound(&colour, &fine),
        eye: bound(&eye, &eye),
        hair: bound(&hair, &hair),
    }
}

/// The key lamp's shadow map, to be drawn to, and as the shaders read it.
pub(crate) fn shadow(
    gpu: &Gpu,
    layouts: &Layouts,
    detail: &Detail,
) -> (wgpu::TextureView, wgpu::BindGroup) {
    let size = (detail.shadow_map, detail.shadow_map);
    let usage = wgpu::TextureUsages::TEXTURE_BINDING;
    let view = texture(gpu.device(), "shadow map", size, DEPTH, 1, usage)
        .create_view(&wgpu::TextureViewDescriptor::default());
    let compare = gpu.device().create_sampler(&wgpu::SamplerDescriptor {
        label: Some("shadow"),
        compare: Some(wgpu::CompareFunction::LessEqual),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    });
    let group = group(
        gpu.device(),
        &layouts.shadow,
        &[
            wgpu::BindingResource::TextureView(&view),
            wgpu::BindingResource::Sampler(&compare),
        ],
    );
    (view, group)
}

/// A bind group of resources numbered in order.
pub(crate) fn group(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    resources: &[wgpu::BindingResource<'_>],
) -> wgpu::BindGroup {
    let entries: Vec<wgpu::BindGroupEntry<'_>> = resources
        .iter()
        .enumerate()
        .map(|(binding, resource)| wgpu::BindGroupEntry {
            binding: binding as u32,
            resource: resource.clone(),
        })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout,
        entries: &entries,
    })
}
