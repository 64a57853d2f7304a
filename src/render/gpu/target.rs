//! Where a pass draws to, and the way from there into the machine's memory.

use super::pipeline::{COLOUR, DEPTH, SAMPLES};
use crate::render::error::Error;
use crate::render::layer::Layer;
use std::time::Duration;
use wgpu::{TextureFormat, TextureUsages};

/// How long an adapter may take for one pass before it counts as hung.
const PATIENCE: Duration = Duration::from_secs(120);

/// The textures of a pass, used again for the next.
#[derive(Debug)]
pub(super) struct Target {
    pub size: (u32, u32),
    samples: wgpu::TextureView,
    depth: wgpu::TextureView,
    resolved: wgpu::Texture,
    resolved_view: wgpu::TextureView,
    rows: wgpu::Buffer,
    /// Copies want rows of a multiple of 256 bytes.
    row_bytes: u32,
}

impl Target {
    pub(super) fn new(device: &wgpu::Device, size: (u32, u32)) -> Self {
        let attachment = TextureUsages::RENDER_ATTACHMENT;
        let texture = |format, samples, usage| texture(device, size, format, samples, usage);
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let resolved = texture(COLOUR, 1, attachment | TextureUsages::COPY_SRC);
        let row_bytes = (size.0 * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        Target {
            size,
            samples: view(&texture(COLOUR, SAMPLES, attachment)),
            depth: view(&texture(DEPTH, SAMPLES, attachment)),
            resolved_view: view(&resolved),
            resolved,
            rows: device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("rows"),
                size: u64::from(row_bytes) * u64::from(size.1),
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            }),
            row_bytes,
        }
    }

    /// Begins a pass over nothing: transparent, and infinitely far.
    pub(super) fn begin<'e>(&self, encoder: &'e mut wgpu::CommandEncoder) -> wgpu::RenderPass<'e> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.samples,
                depth_slice: None,
                resolve_target: Some(&self.resolved_view),
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Discard,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        })
    }

    pub(super) fn copy_out(&self, encoder: &mut wgpu::CommandEncoder) {
        let rows = wgpu::TexelCopyBufferInfo {
            buffer: &self.rows,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(self.row_bytes),
                rows_per_image: None,
            },
        };
        encoder.copy_texture_to_buffer(self.resolved.as_image_copy(), rows, self.resolved.size());
    }

    /// Waits for the pass and puts its pixels into the picture at `at`.
    pub(super) fn read(&self, device: &wgpu::Device, layer: &mut Layer, at: (u32, u32)) -> Result<(), Error> {
        self.rows.map_async(wgpu::MapMode::Read, .., |_| {});
        let wait = wgpu::PollType::Wait { submission_index: None, timeout: Some(PATIENCE) };
        device.poll(wait).map_err(Error::adapter)?;
        // Fails when mapping did.
        let mapped = self.rows.get_mapped_range(..).map_err(Error::adapter)?;
        let width = self.size.0.min(layer.width() - at.0) as usize * 4;
        let stride = layer.width() as usize * 4;
        let rows = layer.chunks_exact_mut(stride).skip(at.1 as usize);
        for (row, read) in rows.zip(mapped.chunks_exact(self.row_bytes as usize)) {
            row[at.0 as usize * 4..][..width].copy_from_slice(&read[..width]);
        }
        drop(mapped);
        self.rows.unmap();
        Ok(())
    }
}

fn texture(
    device: &wgpu::Device,
    (width, height): (u32, u32),
    format: TextureFormat,
    sample_count: u32,
    usage: TextureUsages,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}
