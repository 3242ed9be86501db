//! Bytes onto the card: buffers with contents, images with their mip levels.

use wgpu::util::DeviceExt as _;

use crate::gpu::Gpu;
use crate::maps::image::Image;

/// A buffer that holds `contents`.
pub(crate) fn buffer<T: bytemuck::NoUninit>(
    gpu: &Gpu,
    label: &str,
    contents: &[T],
    usage: wgpu::BufferUsages,
) -> wgpu::Buffer {
    gpu.device()
        .create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(label),
            contents: bytemuck::cast_slice(contents),
            usage,
        })
}

/// An image of plain bytes, with all its halvings.
pub(crate) fn image(gpu: &Gpu, label: &str, image: Image) -> wgpu::TextureView {
    levels(gpu, label, image.into_mips())
}

/// An image whose halvings are given, largest first.
pub(crate) fn levels(gpu: &Gpu, label: &str, mut levels: Vec<Image>) -> wgpu::TextureView {
    // What is larger than the card can hold is shown a step coarser.
    let max = gpu.device().limits().max_texture_dimension_2d as usize;
    let fits = |level: &Image| level.width <= max && level.height <= max;
    levels.drain(..levels.iter().position(fits).unwrap_or(0));
    let size = |level: &Image| wgpu::Extent3d {
        width: level.width as u32,
        height: level.height as u32,
        depth_or_array_layers: 1,
    };
    let texture = gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: size(&levels[0]),
        mip_level_count: levels.len() as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (number, level) in levels.iter().enumerate() {
        gpu.queue().write_texture(
            wgpu::TexelCopyTextureInfo {
                texture: &texture,
                mip_level: number as u32,
                origin: wgpu::Origin3d::ZERO,
                aspect: wgpu::TextureAspect::All,
            },
            bytemuck::cast_slice(&level.texels),
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(level.width as u32 * 4),
                rows_per_image: None,
            },
            size(level),
        );
    }
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
