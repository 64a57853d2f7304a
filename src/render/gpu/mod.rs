//! The renderer that runs on a graphics adapter, real or emulated, by wgpu.

mod pipeline;
mod stock;
mod target;

use super::error::Error;
use super::layer::Layer;
use super::scene::{Light, Part, Scene, Texture};
use pipeline::{Kind, Pipelines};
use stock::{Stock, StockedPart};
use target::Target;
use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// Pixels a side that are drawn in one pass: with four samples a pixel even a
/// picture as large as allowed then needs little memory at a time.
const PASS: u32 = 2048;

/// An adapter made ready for the parts of one file.
#[derive(Debug)]
pub(crate) struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    pipelines: Pipelines,
    stock: Stock,
    /// What the last picture was drawn to, for the next of its size.
    target: Option<Target>,
    /// The adapter, in words.
    pub(crate) name: String,
}

impl Gpu {
    /// Finds an adapter and hands it the parts.
    pub(crate) fn new(parts: &[Part], textures: &[Texture]) -> Result<Self, Error> {
        let adapter = adapter()?;
        let info = adapter.get_info();
        let (device, queue) =
            pollster::block_on(adapter.request_device(&needs(&adapter))).map_err(Error::adapter)?;
        // Errors are caught in scopes; without a handler of ours wgpu panics
        // on what is raised outside them.
        device.on_uncaptured_error(std::sync::Arc::new(|_| {}));
        let (pipelines, stock) = checked(&device, || {
            let pipelines = Pipelines::new(&device);
            let stock = Stock::new(&device, &queue, &pipelines, parts, textures);
            Ok((pipelines, stock))
        })?;
        let name = format!("wgpu: {} ({})", info.name, info.backend);
        Ok(Gpu { device, queue, pipelines, stock, target: None, name })
    }

    /// Draws a scene made of the parts that the adapter was made ready for.
    pub(crate) fn draw(&mut self, scene: &Scene) -> Result<Layer, Error> {
        let device = self.device.clone();
        checked(&device, || self.draw_in_passes(scene))
    }

    fn draw_in_passes(&mut self, scene: &Scene) -> Result<Layer, Error> {
        let (width, height) = scene.size;
        let batches = self.batches(scene);
        let placements = self.placements(scene);
        let extras: Vec<_> = scene.extras.iter().map(|part| StockedPart::new(&self.device, part)).collect();
        let pass = (width.min(PASS), height.min(PASS));
        let kept = self.target.take().filter(|target| target.size == pass);
        let target = kept.unwrap_or_else(|| Target::new(&self.device, pass));
        let mut layer = Layer::new(width, height);
        for top in (0..height).step_by(PASS as usize) {
            for left in (0..width).step_by(PASS as usize) {
                let light = self.light(&scene.light, crop(scene.size, target.size, (left, top)));
                let mut encoder = self.device.create_command_encoder(&Default::default());
                self.encode(&mut encoder, &target, (&batches, &extras), &placements, &light);
                target.copy_out(&mut encoder);
                self.queue.submit([encoder.finish()]);
                target.read(&self.device, &mut layer, (left, top))?;
            }
        }
        // Not kept where reading failed: it may still be mapped.
        self.target = Some(target);
        Ok(layer)
    }

    fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &Target,
        (batches, extras): (&[Batch], &[Option<StockedPart>]),
        placements: &wgpu::Buffer,
        light: &wgpu::BindGroup,
    ) {
        let mut pass = target.begin(encoder);
        pass.set_bind_group(0, light, &[]);
        for batch in batches {
            let mut stock = self.stock.parts.iter().chain(extras);
            let Some(part) = stock.nth(batch.part).and_then(Option::as_ref) else {
                continue;
            };
            let [first, end] = batch.draws.map(|d| (d * pipeline::PLACEMENT_BYTES) as u64);
            pass.set_pipeline(self.pipelines.get(batch.kind));
            pass.set_bind_group(1, &self.stock.textures[part.texture], &[]);
            pass.set_vertex_buffer(0, part.vertices.slice(..));
            pass.set_vertex_buffer(1, placements.slice(first..end));
            pass.set_index_buffer(part.indices.slice(..), wgpu::IndexFormat::Uint32);
            let count = (batch.draws[1] - batch.draws[0]) as u32;
            pass.draw_indexed(0..part.index_count, 0, 0..count);
        }
    }

    /// Neighbouring draws that differ in their placement only, as one.
    fn batches(&mut self, scene: &Scene) -> Vec<Batch> {
        let mut batches: Vec<Batch> = Vec::new();
        for (index, draw) in scene.draws.iter().enumerate() {
            let kind = Kind::new(scene.material(draw), draw.mirrored);
            match batches.last_mut() {
                Some(last) if (last.part, last.kind) == (draw.part, kind) => last.draws[1] += 1,
                _ => batches.push(Batch { part: draw.part, kind, draws: [index, index + 1] }),
            }
            self.pipelines.prepare(&self.device, kind);
        }
        batches
    }

    fn placements(&self, scene: &Scene) -> wgpu::Buffer {
        let rows: Vec<_> =
            scene.draws.iter().map(|draw| stock::placement(draw, scene.material(draw))).collect();
        self.device.create_buffer_init(&BufferInitDescriptor {
            label: Some("placements"),
            contents: bytemuck::cast_slice(&rows),
            usage: wgpu::BufferUsages::VERTEX,
        })
    }

    fn light(&self, light: &Light, crop: [f32; 4]) -> wgpu::BindGroup {
        let numbers = [
            light.up.extend(0.0).to_array(),
            light.key.extend(0.0).to_array(),
            light.fill.extend(0.0).to_array(),
            light.strength,
            crop,
        ];
        let buffer = self.device.create_buffer_init(&BufferInitDescriptor {
            label: Some("light"),
            contents: bytemuck::cast_slice(&numbers),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        self.pipelines.light(&self.device, &buffer)
    }
}

/// Draws of one part in one kind.
struct Batch {
    part: usize,
    kind: Kind,
    /// The first, and one past the last.
    draws: [usize; 2],
}

/// Scale and shift of x and y that bring one pass's share of the picture to
/// the whole of clip space.
fn crop(whole: (u32, u32), pass: (u32, u32), at: (u32, u32)) -> [f32; 4] {
    let axis = |whole: u32, pass: u32, at: u32| {
        let scale = f64::from(whole) / f64::from(pass);
        let shift = scale - 2.0 * f64::from(at) / f64::from(pass) - 1.0;
        (scale as f32, shift as f32)
    };
    let (across, right) = axis(whole.0, pass.0, at.0);
    let (down, below) = axis(whole.1, pass.1, at.1);
    [across, down, right, -below]
}

fn adapter() -> Result<wgpu::Adapter, Error> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
    // Layers for debugging would cost start-up time and print.
    descriptor.flags = wgpu::InstanceFlags::empty();
    let instance = wgpu::Instance::new(descriptor);
    let found = instance.request_adapter(&wgpu::RequestAdapterOptions::default());
    pollster::block_on(found).map_err(|e| Error::NoAdapter { reason: e.to_string() })
}

/// As little as possible, but pictures, textures and meshes as large as the
/// adapter can.
fn needs(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
    let offered = adapter.limits();
    wgpu::DeviceDescriptor {
        label: Some("dat2glb"),
        required_limits: wgpu::Limits {
            max_buffer_size: offered.max_buffer_size,
            ..wgpu::Limits::downlevel_webgl2_defaults().using_resolution(offered)
        },
        memory_hints: wgpu::MemoryHints::MemoryUsage,
        ..Default::default()
    }
}

/// Runs `work` and returns what the device complained about meanwhile.
fn checked<T>(device: &wgpu::Device, work: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    use wgpu::ErrorFilter::{Internal, OutOfMemory, Validation};
    let scopes = [Internal, OutOfMemory, Validation].map(|f| device.push_error_scope(f));
    let done = work();
    let complaints: Vec<_> =
        scopes.into_iter().rev().filter_map(|scope| pollster::block_on(scope.pop())).collect();
    match complaints.first() {
        Some(complaint) => Err(Error::adapter(complaint)),
        None => done,
    }
}
