//! What a graphics adapter itself takes from a process's start to a picture in memory: the
//! floor under pictures by wgpu. It draws four shaded boxes into 512 × 512 pixels with four samples
//! each, by the plainest shader there is, and reads them back.
//!
//! ```sh
//! cargo run --release --example adapter
//! ```

use pollster::block_on;
use std::error::Error;

const SIDE: u32 = 512;
const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Boxes in a row, turned by their number; bit i of a corner is its side along axis i.
const SHADER: &str = "
struct Corner { @builtin(position) place: vec4f, @location(0) light: f32 }

@vertex fn corner(@builtin(vertex_index) vertex: u32, @builtin(instance_index) number: u32) -> Corner {
    let face = vertex / 6u;
    let axis = face / 2u;
    let side = f32(face % 2u) * 2.0 - 1.0;
    var ways = array(vec2f(-1, -1), vec2f(1, -1), vec2f(1, 1), vec2f(-1, -1), vec2f(1, 1), vec2f(-1, 1));
    let way = ways[vertex % 6u];
    var at = vec3f(way, side);
    var normal = vec3f(0, 0, side);
    if axis == 1u { at = at.yzx; normal = normal.yzx; }
    if axis == 2u { at = at.zxy; normal = normal.zxy; }
    let turn = 0.7 + 0.5 * f32(number);
    let about = mat3x3f(cos(turn), 0.0, -sin(turn), 0.0, 1.0, 0.0, sin(turn), 0.0, cos(turn));
    let tilt = mat3x3f(1.0, 0.0, 0.0, 0.0, 0.8, 0.6, 0.0, -0.6, 0.8);
    let seen = tilt * about * at * 0.16 + vec3f(f32(number) * 0.45 - 0.68, 0.0, 0.5);
    return Corner(vec4f(seen.xy, seen.z, 1.0), 0.4 + 0.6 * max(dot(tilt * about * normal, vec3f(0.0, 0.6, -0.8)), 0.0));
}

@fragment fn pixel(corner: Corner) -> @location(0) vec4f { return vec4f(vec3f(corner.light), 1.0); }
";

fn main() -> Result<(), Box<dyn Error>> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
    descriptor.flags = wgpu::InstanceFlags::empty();
    let instance = wgpu::Instance::new(descriptor);
    let adapter = block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    let (device, queue) = block_on(adapter.request_device(&wgpu::DeviceDescriptor {
        required_limits: wgpu::Limits::downlevel_webgl2_defaults().using_resolution(adapter.limits()),
        ..Default::default()
    }))?;
    let texture = |format, samples, usage| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: SIDE, height: SIDE, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: samples,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    };
    let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
    let (samples, depth) = (texture(COLOUR, 4, attachment), texture(DEPTH, 4, attachment));
    let resolved = texture(COLOUR, 1, attachment | wgpu::TextureUsages::COPY_SRC);
    let boxes = pipeline(&device);
    let rows = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(4 * SIDE * SIDE),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &samples.create_view(&Default::default()),
            depth_slice: None,
            resolve_target: Some(&resolved.create_view(&Default::default())),
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::WHITE),
                store: wgpu::StoreOp::Discard,
            },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &depth.create_view(&Default::default()),
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(1.0),
                store: wgpu::StoreOp::Discard,
            }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    pass.set_pipeline(&boxes);
    pass.draw(0..36, 0..4);
    drop(pass);
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
    let picture = rows.slice(..).get_mapped_range()?.to_vec();
    let drawn = picture.chunks(4).filter(|pixel| pixel[0] < 255).count();
    println!("{}: {drawn} pixels of boxes", adapter.get_info().name);
    Ok(())
}

fn pipeline(device: &wgpu::Device) -> wgpu::RenderPipeline {
    let source = wgpu::ShaderSource::Wgsl(SHADER.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Less),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState { count: 4, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            targets: &[Some(COLOUR.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
