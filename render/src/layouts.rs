//! Layouts of the bind groups that shaders share: 0 the frame, 1 the key lamp's shadow, 2 a material's maps.

use crate::gpu_data::Frame;

/// Layouts of the bind groups.
#[derive(Debug)]
pub(crate) struct Layouts {
    pub(crate) frame: wgpu::BindGroupLayout,
    pub(crate) shadow: wgpu::BindGroupLayout,
    pub(crate) maps: wgpu::BindGroupLayout,
    pub(crate) skin: wgpu::BindGroupLayout,
}

impl Layouts {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let layout = |label, entries: &[wgpu::BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some(label),
                entries,
            })
        };
        let entry = |binding, visibility, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility,
            ty,
            count: None,
        };
        let texture = |sample_type| wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let map = texture(wgpu::TextureSampleType::Float { filterable: true });
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let fragment = wgpu::ShaderStages::FRAGMENT;
        // Coarse surfaces read the shadow at their vertices.
        let both = wgpu::ShaderStages::VERTEX_FRAGMENT;
        Self {
            frame: layout(
                "frame",
                &[entry(
                    0,
                    wgpu::ShaderStages::VERTEX_FRAGMENT,
                    wgpu::BindingType::Buffer {
                        ty: wgpu::BufferBindingType::Uniform,
                        has_dynamic_offset: false,
                        min_binding_size: wgpu::BufferSize::new(size_of::<Frame>() as u64),
                    },
                )],
            ),
            shadow: layout(
                "shadow",
                &[
                    entry(0, both, texture(wgpu::TextureSampleType::Depth)),
                    entry(
                        1,
                        both,
                        wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison),
                    ),
                ],
            ),
            maps: layout(
                "maps",
                &[
                    entry(0, fragment, sampler),
                    entry(1, fragment, map),
                    entry(2, fragment, map),
                ],
            ),
            // Sampler, colour, mask, wrinkles; and the tile of the fine structure with its own sampler.
            skin: layout(
                "skin",
                &[
                    entry(0, fragment, sampler),
                    entry(1, fragment, map),
                    entry(2, fragment, map),
                    entry(3, fragment, map),
                    entry(4, fragment, map),
                    entry(5, fragment, sampler),
                ],
            ),
        }
    }
}
