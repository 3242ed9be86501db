//! The pipelines: one per material, the two of the shadow map, backdrop and flash; and the layouts
//! of the three bind groups they share: 0 the frame, 1 the key lamp's shadow, 2 a material's maps.

use crate::gpu::Gpu;
use crate::gpu_data::{self, Frame};
use crate::shader::{self, ShaderError};
use crate::targets::DEPTH;
use crate::tier::Detail;

/// Layouts of the bind groups.
#[derive(Debug)]
pub(crate) struct Layouts {
    pub(crate) frame: wgpu::BindGroupLayout,
    pub(crate) shadow: wgpu::BindGroupLayout,
    pub(crate) maps: wgpu::BindGroupLayout,
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
                    entry(
                        0,
                        fragment,
                        wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
                    ),
                    entry(1, fragment, map),
                    entry(2, fragment, map),
                ],
            ),
        }
    }
}

/// What a pipeline draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mesh {
    Skin,
    Part,
    None,
}

/// How one pipeline is made.
#[derive(Clone, Copy, Debug)]
struct Recipe {
    file: &'static str,
    vertex: &'static str,
    /// None: depth only, for the shadow map.
    fragment: Option<&'static str>,
    mesh: Mesh,
    cull: Option<wgpu::Face>,
    /// Alpha says how many samples are covered.
    strands: bool,
    depth: wgpu::CompareFunction,
}

const fn solid(file: &'static str) -> Recipe {
    Recipe {
        file,
        vertex: "mouth_vertex",
        fragment: Some(file),
        mesh: Mesh::Part,
        cull: Some(wgpu::Face::Back),
        strands: false,
        depth: wgpu::CompareFunction::Less,
    }
}

const SKIN: Recipe = Recipe {
    vertex: "skin_vertex",
    mesh: Mesh::Skin,
    ..solid("skin")
};
const HAIR: Recipe = Recipe {
    vertex: "hair_vertex",
    strands: true,
    ..solid("hair")
};
const EYE: Recipe = Recipe {
    vertex: "eye_vertex",
    ..solid("eye")
};
const LASH: Recipe = Recipe {
    vertex: "lash_vertex",
    cull: None,
    ..solid("lash")
};
const CAVITY: Recipe = Recipe {
    cull: None,
    ..solid("cavity")
};
const CLOTH: Recipe = Recipe {
    vertex: "cloth_vertex",
    cull: None,
    ..solid("cloth")
};
const BONE: Recipe = Recipe {
    vertex: "anatomy_vertex",
    cull: None,
    ..solid("bone")
};
const MUSCLE: Recipe = Recipe {
    vertex: "anatomy_vertex",
    ..solid("muscle")
};
const SPRING: Recipe = Recipe {
    vertex: "anatomy_vertex",
    cull: None,
    ..solid("spring")
};
const BACKDROP: Recipe = Recipe {
    vertex: "backdrop_vertex",
    fragment: Some("backdrop"),
    mesh: Mesh::None,
    depth: wgpu::CompareFunction::LessEqual,
    ..solid("background")
};
const FLASH: Recipe = Recipe {
    vertex: "flash_vertex",
    mesh: Mesh::None,
    depth: wgpu::CompareFunction::Always,
    ..solid("flash")
};
const INSIDE: Recipe = Recipe {
    vertex: "inside_vertex",
    mesh: Mesh::Skin,
    cull: Some(wgpu::Face::Front),
    ..solid("inside")
};
const SKIN_SHADOW: Recipe = Recipe {
    vertex: "skin_shadow",
    fragment: None,
    mesh: Mesh::Skin,
    ..solid("shadow")
};

const PART_SHADOW: Recipe = Recipe {
    vertex: "part_shadow",
    mesh: Mesh::Part,
    cull: None,
    ..SKIN_SHADOW
};

/// All pipelines of one target format and sample count.
#[derive(Debug)]
pub(crate) struct Pipelines {
    pub(crate) skin: wgpu::RenderPipeline,
    pub(crate) eye: wgpu::RenderPipeline,
    pub(crate) teeth: wgpu::RenderPipeline,
    pub(crate) gums: wgpu::RenderPipeline,
    pub(crate) tongue: wgpu::RenderPipeline,
    pub(crate) cavity: wgpu::RenderPipeline,
    pub(crate) hair: wgpu::RenderPipeline,
    pub(crate) lash: wgpu::RenderPipeline,
    pub(crate) cloth: wgpu::RenderPipeline,
    pub(crate) bone: wgpu::RenderPipeline,
    pub(crate) muscle: wgpu::RenderPipeline,
    pub(crate) spring: wgpu::RenderPipeline,
    pub(crate) backdrop: wgpu::RenderPipeline,
    pub(crate) flash: wgpu::RenderPipeline,
    pub(crate) inside: wgpu::RenderPipeline,
    pub(crate) skin_shadow: wgpu::RenderPipeline,
    pub(crate) part_shadow: wgpu::RenderPipeline,
}

impl Pipelines {
    pub(crate) fn new(
        gpu: &Gpu,
        layouts: &Layouts,
        format: wgpu::TextureFormat,
        samples: u32,
        detail: &Detail,
    ) -> Result<Self, ShaderError> {
        let device = gpu.device();
        let layout = |groups: &[Option<&wgpu::BindGroupLayout>]| {
            device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: None,
                bind_group_layouts: groups,
                immediate_size: 0,
            })
        };
        let (frame, shadow, maps) = (
            Some(&layouts.frame),
            Some(&layouts.shadow),
            Some(&layouts.maps),
        );
        let bare = layout(&[frame]);
        let lit = layout(&[frame, shadow]);
        let mapped = layout(&[frame, shadow, maps]);
        let make = |recipe: &Recipe, layout: &wgpu::PipelineLayout| {
            pipeline(device, recipe, layout, format, samples, detail)
        };
        Ok(Self {
            skin: make(&SKIN, &mapped)?,
            eye: make(&EYE, &mapped)?,
            teeth: make(&solid("teeth"), &lit)?,
            gums: make(&solid("gums"), &lit)?,
            tongue: make(&solid("tongue"), &lit)?,
            cavity: make(&CAVITY, &lit)?,
            hair: make(&HAIR, &mapped)?,
            lash: make(&LASH, &lit)?,
            cloth: make(&CLOTH, &lit)?,
            bone: make(&BONE, &lit)?,
            muscle: make(&MUSCLE, &lit)?,
            spring: make(&SPRING, &lit)?,
            backdrop: make(&BACKDROP, &bare)?,
            flash: make(&FLASH, &bare)?,
            inside: make(&INSIDE, &bare)?,
            skin_shadow: make(&SKIN_SHADOW, &bare)?,
            part_shadow: make(&PART_SHADOW, &bare)?,
        })
    }
}

fn pipeline(
    device: &wgpu::Device,
    recipe: &Recipe,
    layout: &wgpu::PipelineLayout,
    format: wgpu::TextureFormat,
    samples: u32,
    detail: &Detail,
) -> Result<wgpu::RenderPipeline, ShaderError> {
    let text = shader::resolve(recipe.file)?;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(recipe.file),
        source: wgpu::ShaderSource::Wgsl(text.as_str().into()),
    });
    let all = [
        ("DECODE_SRGB", f64::from(u8::from(format.is_srgb()))),
        ("SHADOW_TAPS", f64::from(detail.shadow_taps)),
        ("SAMPLES", f64::from(samples)),
    ];
    // A constant that a shader does not declare is an error, so each gets its own.
    let constants: Vec<(&str, f64)> = all
        .into_iter()
        .filter(|(name, _)| text.contains(&format!("override {name}:")))
        .collect();
    let options = wgpu::PipelineCompilationOptions {
        constants: &constants,
        ..Default::default()
    };
    let shadow = recipe.fragment.is_none();
    let part = [Some(gpu_data::PART)];
    let skin = [Some(gpu_data::SKIN_MOVING), Some(gpu_data::SKIN_STILL)];
    let targets = [Some(wgpu::ColorTargetState {
        format,
        blend: None,
        // Strands write coverage to alpha; the picture's own alpha stays 1.
        write_mask: if recipe.strands {
            wgpu::ColorWrites::COLOR
        } else {
            wgpu::ColorWrites::ALL
        },
    })];
    Ok(
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(recipe.vertex),
            layout: Some(layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(recipe.vertex),
                compilation_options: options.clone(),
                buffers: match recipe.mesh {
                    Mesh::Skin => &skin,
                    Mesh::Part => &part,
                    Mesh::None => &[],
                },
            },
            primitive: wgpu::PrimitiveState {
                cull_mode: if recipe.mesh == Mesh::None {
                    None
                } else {
                    recipe.cull
                },
                ..Default::default()
            },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(recipe.mesh != Mesh::None),
                depth_compare: Some(recipe.depth),
                stencil: wgpu::StencilState::default(),
                bias: if shadow {
                    wgpu::DepthBiasState {
                        constant: 2,
                        slope_scale: 1.5,
                        clamp: 0.0,
                    }
                } else {
                    wgpu::DepthBiasState::default()
                },
            }),
            multisample: wgpu::MultisampleState {
                count: if shadow { 1 } else { samples },
                alpha_to_coverage_enabled: recipe.strands && samples > 1,
                ..Default::default()
            },
            fragment: recipe.fragment.map(|entry| wgpu::FragmentState {
                module: &module,
                entry_point: Some(entry),
                compilation_options: options,
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        }),
    )
}
