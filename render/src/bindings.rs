//! What the shaders read beside vertices, bound once: the shadow map, and the maps of skin, eyes and hair.

use crate::gpu::Gpu;
use crate::layouts::Layouts;
use crate::maps::Maps;
use crate::maps::hair;
use crate::maps::image::Image;
use crate::picture::Picture;
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

/// Puts painted maps on the card.
pub(crate) fn maps(gpu: &Gpu, layouts: &Layouts, painted: Maps, detail: &Detail) -> MapGroups {
    let eye = upload::image(gpu, "eye", painted.eye);
    let strands = hair::mips(painted.hair, detail.samples);
    let hair = upload::levels(gpu, "hair", strands);
    let colour = upload::image(gpu, "skin colour", painted.skin.colour);
    let mask = upload::image(gpu, "skin mask", painted.skin.mask);
    let wrinkles = upload::image(gpu, "skin wrinkles", painted.skin.wrinkles);
    let grain = upload::image(gpu, "skin grain", painted.skin.grain);
    let [sampler, tiling] = samplers(gpu, detail);
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
        skin: group(
            gpu.device(),
            &layouts.skin,
            &[
                wgpu::BindingResource::Sampler(&sampler),
                wgpu::BindingResource::TextureView(&colour),
                wgpu::BindingResource::TextureView(&mask),
                wgpu::BindingResource::TextureView(&wrinkles),
                wgpu::BindingResource::TextureView(&grain),
                wgpu::BindingResource::Sampler(&tiling),
            ],
        ),
        eye: bound(&eye, &eye),
        hair: bound(&hair, &hair),
    }
}

/// For maps that end at their edges, and for one that repeats.
fn samplers(gpu: &Gpu, detail: &Detail) -> [wgpu::Sampler; 2] {
    // Never in software: Mesa's rasteriser was seen to take minutes over one anisotropic frame.
    let anisotropy = if gpu.is_software() {
        1
    } else {
        detail.anisotropy
    };
    let clamped = wgpu::SamplerDescriptor {
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
    };
    [
        gpu.device().create_sampler(&clamped),
        gpu.device().create_sampler(&wgpu::SamplerDescriptor {
            label: Some("tile"),
            address_mode_u: wgpu::AddressMode::Repeat,
            address_mode_v: wgpu::AddressMode::Repeat,
            ..clamped
        }),
    ]
}

/// Bound as `maps` binds them, but of images made by `image`, which is told a map's side.
pub(crate) fn stand_ins(
    gpu: &Gpu,
    layouts: &Layouts,
    detail: &Detail,
    image: impl Fn(u32) -> Image,
) -> MapGroups {
    let view = |side| upload::image(gpu, "warm-up", image(side));
    let (hair, eye, skin) = (
        view(detail.hair_map),
        view(detail.eye_map),
        view(detail.mask_map),
    );
    let [sampler, tiling] = samplers(gpu, detail);
    let hair = wgpu::BindingResource::TextureView(&hair);
    let eye = wgpu::BindingResource::TextureView(&eye);
    let skin = wgpu::BindingResource::TextureView(&skin);
    let sampler = wgpu::BindingResource::Sampler(&sampler);
    let tiling = wgpu::BindingResource::Sampler(&tiling);
    let of_skin = [
        sampler.clone(),
        skin.clone(),
        skin.clone(),
        skin.clone(),
        skin,
        tiling,
    ];
    let device = gpu.device();
    MapGroups {
        skin: group(device, &layouts.skin, &of_skin),
        eye: group(device, &layouts.maps, &[sampler.clone(), eye.clone(), eye]),
        hair: group(device, &layouts.maps, &[sampler, hair.clone(), hair]),
    }
}

/// A user's picture, bound as a material's maps are.
pub(crate) fn picture(
    gpu: &Gpu,
    maps: &wgpu::BindGroupLayout,
    picture: &Picture,
) -> wgpu::BindGroup {
    let view = upload::image(gpu, "backdrop", picture.premultiplied());
    let sampler = gpu.device().create_sampler(&wgpu::SamplerDescriptor {
        label: Some("backdrop"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Nearest,
        ..Default::default()
    });
    let view = wgpu::BindingResource::TextureView(&view);
    let resources = [wgpu::BindingResource::Sampler(&sampler), view.clone(), view];
    group(gpu.device(), maps, &resources)
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
