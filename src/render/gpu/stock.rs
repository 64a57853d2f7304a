//! Parts and textures in the adapter's memory, and draws as it reads them.

use super::pipeline::{COLOUR, Pipelines};
use crate::render::scene::{Alpha, Draw, Level, Material, Part, Texture, Vertex, Wrap};
use wgpu::util::{BufferInitDescriptor, DeviceExt, TextureDataOrder};

/// What stays the same from picture to picture.
#[derive(Debug)]
pub(super) struct Stock {
    /// `None` for parts without triangles.
    pub parts: Vec<Option<StockedPart>>,
    /// A white pixel for parts without a texture, then the scene's.
    pub textures: Vec<wgpu::BindGroup>,
}

#[derive(Debug)]
pub(super) struct StockedPart {
    pub vertices: wgpu::Buffer,
    pub indices: wgpu::Buffer,
    pub index_count: u32,
    /// Index into [`Stock::textures`].
    pub texture: usize,
}

impl Stock {
    pub(super) fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        pipelines: &Pipelines,
        parts: &[Part],
        textures: &[Texture],
    ) -> Self {
        let white = white();
        let textures = std::iter::once(&white).chain(textures);
        Stock {
            parts: parts.iter().map(|p| StockedPart::new(device, p)).collect(),
            textures: textures.map(|t| upload(device, queue, pipelines, t)).collect(),
        }
    }
}

impl StockedPart {
    pub(super) fn new(device: &wgpu::Device, part: &Part) -> Option<Self> {
        if part.indices.is_empty() {
            return None;
        }
        let rows: Vec<[f32; 12]> = part.vertices.iter().map(vertex).collect();
        let buffer = |contents: &[u8], usage| {
            let label = None;
            device.create_buffer_init(&BufferInitDescriptor { label, contents, usage })
        };
        Some(StockedPart {
            vertices: buffer(bytemuck::cast_slice(&rows), wgpu::BufferUsages::VERTEX),
            indices: buffer(bytemuck::cast_slice(&part.indices), wgpu::BufferUsages::INDEX),
            index_count: part.indices.len() as u32,
            texture: part.material.texture.map_or(0, |t| t + 1),
        })
    }
}

fn vertex(v: &Vertex) -> [f32; 12] {
    let ([x, y, z], [i, j, k], [s, t], [r, g, b, a]) = (v.position, v.normal, v.uv, v.colour);
    [x, y, z, i, j, k, s, t, r, g, b, a]
}

/// A draw as `Placement` in `mesh.wgsl`.
pub(super) fn placement(draw: &Draw, material: &Material) -> [[f32; 4]; 8] {
    let cutoff = match material.alpha {
        Alpha::Mask(cutoff) => cutoff,
        _ => 0.0,
    };
    let [c0, c1, c2, c3] = draw.clip;
    let [n0, n1, n2] = draw.normal;
    let column = |n: [f32; 3], last: f32| [n[0], n[1], n[2], last];
    [c0, c1, c2, c3, column(n0, cutoff), column(n1, 0.0), column(n2, 0.0), material.colour]
}

fn white() -> Texture {
    let level = Level { width: 1, height: 1, pixels: vec![[255; 4]] };
    Texture { levels: std::sync::Arc::new(vec![level]), wrap: [Wrap::Clamp; 2], nearest: true }
}

fn upload(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    pipelines: &Pipelines,
    texture: &Texture,
) -> wgpu::BindGroup {
    let largest = device.limits().max_texture_dimension_2d;
    let too_large = |level: &&Level| level.width > largest || level.height > largest;
    let levels: Vec<&Level> = texture.levels.iter().skip_while(too_large).collect();
    let size = wgpu::Extent3d { width: levels[0].width, height: levels[0].height, depth_or_array_layers: 1 };
    let descriptor = wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: levels.len() as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: COLOUR,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let bytes: Vec<u8> = levels.iter().flat_map(|l| l.pixels.as_flattened()).copied().collect();
    let order = TextureDataOrder::LayerMajor;
    let picture = device.create_texture_with_data(queue, &descriptor, order, &bytes);
    let view = picture.create_view(&Default::default());
    pipelines.texture(device, &view, &sampler(device, texture))
}

fn sampler(device: &wgpu::Device, texture: &Texture) -> wgpu::Sampler {
    let filter = if texture.nearest { wgpu::FilterMode::Nearest } else { wgpu::FilterMode::Linear };
    let [address_mode_u, address_mode_v] = texture.wrap.map(|wrap| match wrap {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
        Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
    });
    device.create_sampler(&wgpu::SamplerDescriptor {
        address_mode_u,
        address_mode_v,
        mag_filter: filter,
        min_filter: filter,
        ..Default::default()
    })
}
