//! The pipelines: one for everything that is drawn in a way of its own (see `recipes`). Each is made when it is
//! first asked for; `warm_up` asks beforehand for those of a face.

use std::sync::OnceLock;

use crate::brows;
use crate::gpu_data;
use crate::layouts::Layouts;
use crate::recipes::{Draw, Mesh, Recipe};
use crate::shader::{self, ShaderError};
use crate::targets::DEPTH;
use crate::tier::Detail;

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

    /// Goes back to the shaders as they are, or to them with a text of one file changed: for tests that are to fail.
    #[cfg(test)]
    pub(crate) fn edit(&mut self, edit: Option<[&str; 3]>) {
        self.texts = shader::resolve_all().unwrap();
        if let Some([file, old, new]) = edit {
            let (_, text) = self
                .texts
                .iter_mut()
                .find(|(name, _)| *name == file)
                .unwrap();
            assert!(text.contains(old), "{file}.wgsl has no {old:?}");
            *text = text.replace(old, new);
        }
        self.made = std::array::from_fn(|_| OnceLock::new());
    }

    /// The pipeline that draws that.
    pub(crate) fn get(&self, draw: Draw) -> &wgpu::RenderPipeline {
        self.made[draw as usize].get_or_init(|| self.make(draw))
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
        ("ALL_LAMPS", f64::from(u8::from(detail.all_lamps))),
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
    let brow = [Some(brows::BROW_MOVING), Some(brows::BROW_STILL)];
    let skin = [Some(gpu_data::SKIN_MOVING), Some(gpu_data::SKIN_STILL)];
    let targets = [Some(wgpu::ColorTargetState {
        format,
        blend: (recipe.blended && samples == 1).then_some(wgpu::BlendState::ALPHA_BLENDING),
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
                Mesh::Brow => &brow,
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
