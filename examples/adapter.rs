//! What a graphics adapter itself takes from a process's start to a picture in memory: the
//! floor under pictures by wgpu. It clears 512 × 512 pixels with four samples each and reads
//! them back.
//!
//! ```sh
//! cargo run --release --example adapter
//! ```

use pollster::block_on;
use std::error::Error;

const SIDE: u32 = 512;

fn main() -> Result<(), Box<dyn Error>> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
    descriptor.flags = wgpu::InstanceFlags::empty();
    let instance = wgpu::Instance::new(descriptor);
    let adapter = block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    let (device, queue) = block_on(adapter.request_device(&wgpu::DeviceDescriptor {
        required_limits: wgpu::Limits::downlevel_webgl2_defaults().using_resolution(adapter.limits()),
        ..Default::default()
    }))?;
    let texture = |samples, usage| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: SIDE, height: SIDE, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: samples,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8UnormSrgb,
            usage,
            view_formats: &[],
        })
    };
    let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
    let (samples, resolved) =
        (texture(4, attachment), texture(1, attachment | wgpu::TextureUsages::COPY_SRC));
    let rows = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(4 * SIDE * SIDE),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &samples.create_view(&Default::default()),
            depth_slice: None,
            resolve_target: Some(&resolved.create_view(&Default::default())),
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::WHITE),
                store: wgpu::StoreOp::Discard,
            },
        })],
        ..Default::default()
    });
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * SIDE), rows_per_image: None };
    encoder.copy_texture_to_buffer(
        resolved.as_image_copy(),
        wgpu::TexelCopyBufferInfo { buffer: &rows, layout },
        resolved.size(),
    );
    queue.submit([encoder.finish()]);
    rows.slice(..).map_async(wgpu::MapMode::Read, |_| ());
    device.poll(wgpu::PollType::Wait { submission_index: None, timeout: None })?;
    let white = rows.slice(..).get_mapped_range()?.iter().all(|&byte| byte == 255);
    assert!(white, "what is cleared to white is white");
    println!("{}", adapter.get_info().name);
    Ok(())
}
