//! The pipelines: one per material, the two of the shadow map, backdrop and flash; and the layouts
//! of the three bind groups they share: 0 the frame, 1 the key lamp's shadow, 2 a material's maps. Those that a
//! face needs are made beforehand, on several threads; the others when they are first asked for.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

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
const SKIN_BLINN_PHONG: Recipe = Recipe {
    file: "skin_blinn_phong",
    fragment: Some("skin_blinn_phong"),
    ..SKIN
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
const PICTURE: Recipe = Recipe {
    file: "picture",
    vertex: "picture_vertex",
    fragment: Some("picture"),
    ..BACKDROP
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

/// Which bind groups a pipeline reads, from 0 on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Groups {
    /// The frame.
    Bare,
    /// Frame and the key lamp's shadow.
    Lit,
    /// Frame, shadow and a material's maps.
    Mapped,
    /// Frame, and a picture as if it were a map.
    Hung,
    /// Frame, shadow and the skin's maps.
    Skin,
}

/// Everything that is drawn by a pipeline of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Draw {
    Skin,
    SkinBlinnPhong,
    Hair,
    Eye,
    Teeth,
    Gums,
    Tongue,
    Cavity,
    Lash,
    Cloth,
    Inside,
    SkinShadow,
    Backdrop,
    Picture,
    Flash,
    Bone,
    Muscle,
    Spring,
    PartShadow,
}

impl Draw {
    /// What a face needs, the most work first. The others are made when they are first asked for.
    pub(crate) const FACE: [Self; 12] = [
        Self::Skin,
        Self::Eye,
        Self::Hair,
        Self::Teeth,
        Self::Tongue,
        Self::Gums,
        Self::Cavity,
        Self::Lash,
        Self::Cloth,
        Self::Inside,
        Self::SkinShadow,
        Self::Backdrop,
    ];
    const COUNT: usize = Self::PartShadow as usize + 1;

    fn recipe(self) -> (Recipe, Groups) {
        match self {
            Self::Skin => (SKIN, Groups::Skin),
            Self::SkinBlinnPhong => (SKIN_BLINN_PHONG, Groups::Skin),
            Self::Hair => (HAIR, Groups::Mapped),
            Self::Eye => (EYE, Groups::Mapped),
            Self::Teeth => (solid("teeth"), Groups::Lit),
            Self::Gums => (solid("gums"), Groups::Lit),
            Self::Tongue => (solid("tongue"), Groups::Lit),
            Self::Cavity => (CAVITY, Groups::Lit),
            Self::Lash => (LASH, Groups::Lit),
            Self::Cloth => (CLOTH, Groups::Lit),
            Self::Bone => (BONE, Groups::Lit),
            Self::Muscle => (MUSCLE, Groups::Lit),
            Self::Spring => (SPRING, Groups::Lit),
            Self::Inside => (INSIDE, Groups::Bare),
            Self::SkinShadow => (SKIN_SHADOW, Groups::Bare),
            Self::PartShadow => (PART_SHADOW, Groups::Bare),
            Self::Backdrop => (BACKDROP, Groups::Bare),
            Self::Flash => (FLASH, Groups::Bare),
            Self::Picture => (PICTURE, Groups::Hung),
        }
    }
}

/// The pipelines of one target format and sample count, each made when it is first needed.
#[derive(Debug)]
pub(crate) struct Pipelines {
    device: wgpu::Device,
    format: wgpu::TextureFormat,
    samples: u32,
    detail: Detail,
    layouts: [wgpu::PipelineLayout; 5],
    texts: Vec<(&'static str, String)>,
    made: [OnceLock<wgpu::RenderPipeline>; Draw::COUNT],
}

impl Pipelines {
    pub(crate) fn new(
        device: &wgpu::Device,
        layouts: &Layouts,
        format: wgpu::TextureFormat,
        samples: u32,
        detail: &Detail,
    ) -> Result<Self, ShaderError> {
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
        Ok(Self {
            device: device.clone(),
            format,
            samples,
            detail: *detail,
            // In the order of `Groups`.
            layouts: [
                layout(&[frame]),
                layout(&[frame, shadow]),
                layout(&[frame, shadow, maps]),
                layout(&[frame, maps]),
                layout(&[frame, shadow, Some(&layouts.skin)]),
            ],
            texts: shader::resolve_all()?,
            made: std::array::from_fn(|_| OnceLock::new()),
        })
    }

    /// The pipeline that draws that.
    pub(crate) fn get(&self, draw: Draw) -> &wgpu::RenderPipeline {
        self.made[draw as usize].get_or_init(|| self.make(draw))
    }

    /// Makes those of `wanted` that no one else has taken from `next` yet: for several threads at once.
    pub(crate) fn make_some(&self, wanted: &[Draw], next: &AtomicUsize) {
        while let Some(draw) = wanted.get(next.fetch_add(1, Ordering::Relaxed)) {
            self.get(*draw);
        }
    }

    fn make(&self, draw: Draw) -> wgpu::RenderPipeline {
        let (recipe, groups) = draw.recipe();
        let text = self.texts.iter().find(|(name, _)| *name == recipe.file);
        // A recipe's file is one of the files: a test asks for all of them.
        let text = text.map_or("", |(_, text)| text.as_str());
        let layout = &self.layouts[groups as usize];
        pipeline(
            &self.device,
            text,
            &recipe,
            layout,
            self.format,
            self.samples,
            &self.detail,
        )
    }
}

fn pipeline(
    device: &wgpu::Device,
    text: &str,
    recipe: &Recipe,
    layout: &wgpu::PipelineLayout,
    format: wgpu::TextureFormat,
    samples: u32,
    detail: &Detail,
) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(recipe.file),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let all = [
        ("DECODE_SRGB", f64::from(u8::from(format.is_srgb()))),
        ("SHADOW_TAPS", f64::from(detail.shadow_taps)),
        ("SAMPLES", f64::from(samples)),
        ("GRAIN", f64::from(u8::from(detail.grain))),
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
    })
}
