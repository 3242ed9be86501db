//! The images a frame is drawn into before it reaches the window or the readback buffer:
//! multisampled colour, and depth.

/// Depth without stencil: offered everywhere.
pub(crate) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Attachments of one size.
#[derive(Debug)]
pub(crate) struct Targets {
    pub(crate) size: (u32, u32),
    /// None when a pixel has one sample: the target itself is drawn to then.
    pub(crate) colour: Option<wgpu::TextureView>,
    pub(crate) depth: wgpu::TextureView,
}

impl Targets {
    pub(crate) fn new(
        device: &wgpu::Device,
        size: (u32, u32),
        format: wgpu::TextureFormat,
        samples: u32,
    ) -> Self {
        let view = |label, format| {
            texture(
                device,
                label,
                size,
                format,
                samples,
                wgpu::TextureUsages::empty(),
            )
            .create_view(&wgpu::TextureViewDescriptor::default())
        };
        Self {
            size,
            colour: (samples > 1).then(|| view("multisampled colour", format)),
            depth: view("depth", DEPTH),
        }
    }
}

/// An image that can be drawn to, and `usage` besides.
pub(crate) fn texture(
    device: &wgpu::Device,
    label: &str,
    (width, height): (u32, u32),
    format: wgpu::TextureFormat,
    sample_count: u32,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    })
}
