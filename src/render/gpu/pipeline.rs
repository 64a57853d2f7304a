//! The ways of drawing a part: what is culled, cut out and let through.

use crate::render::scene::{Alpha, Material};
use std::collections::HashMap;
use wgpu::{BufferBindingType, ShaderStages, TextureFormat, VertexStepMode};

pub(super) const COLOUR: TextureFormat = TextureFormat::Rgba8UnormSrgb;
pub(super) const DEPTH: TextureFormat = TextureFormat::Depth32Float;
/// Samples a pixel, where graphics cards by convention put them.
pub(super) const SAMPLES: u32 = 4;
/// Position, normal, texture coordinates and colour, 4 bytes a number.
pub(super) const VERTEX_BYTES: usize = 4 * 12;
/// Clip matrix, normal matrix with the cutoff in it, colour.
pub(super) const PLACEMENT_BYTES: usize = 4 * 32;

/// What sets pipelines apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Kind {
    masked: bool,
    blended: bool,
    double_sided: bool,
    unlit: bool,
    mirrored: bool,
}

impl Kind {
    pub(super) fn new(material: &Material, mirrored: bool) -> Self {
        Kind {
            masked: matches!(material.alpha, Alpha::Mask(_)),
            blended: material.alpha == Alpha::Blend,
            double_sided: material.double_sided,
            unlit: material.unlit,
            mirrored,
        }
    }
}

/// The pipelines in use, made when a kind is first seen.
#[derive(Debug)]
pub(super) struct Pipelines {
    made: HashMap<Kind, wgpu::RenderPipeline>,
    shader: wgpu::ShaderModule,
    layout: wgpu::PipelineLayout,
    light: wgpu::BindGroupLayout,
    texture: wgpu::BindGroupLayout,
}

impl Pipelines {
    pub(super) fn new(device: &wgpu::Device) -> Self {
        let light = layout(device, &[(ShaderStages::VERTEX_FRAGMENT, uniform())]);
        let texture =
            layout(device, &[(ShaderStages::FRAGMENT, picture()), (ShaderStages::FRAGMENT, reading())]);
        Pipelines {
            made: HashMap::new(),
            shader: device.create_shader_module(wgpu::include_wgsl!("mesh.wgsl")),
            layout: device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: None,
                bind_group_layouts: &[Some(&light), Some(&texture)],
                immediate_size: 0,
            }),
            light,
            texture,
        }
    }

    /// Makes the pipeline for a kind unless there is one.
    pub(super) fn prepare(&mut self, device: &wgpu::Device, kind: Kind) {
        if !self.made.contains_key(&kind) {
            let pipeline = self.make(device, kind);
            self.made.insert(kind, pipeline);
        }
    }

    /// The pipeline for a kind that was prepared.
    pub(super) fn get(&self, kind: Kind) -> &wgpu::RenderPipeline {
        &self.made[&kind]
    }

    pub(super) fn light(&self, device: &wgpu::Device, buffer: &wgpu::Buffer) -> wgpu::BindGroup {
        bind(device, &self.light, &[buffer.as_entire_binding()])
    }

    pub(super) fn texture(
        &self,
        device: &wgpu::Device,
        picture: &wgpu::TextureView,
        reading: &wgpu::Sampler,
    ) -> wgpu::BindGroup {
        let resources =
            [wgpu::BindingResource::TextureView(picture), wgpu::BindingResource::Sampler(reading)];
        bind(device, &self.texture, &resources)
    }

    fn make(&self, device: &wgpu::Device, kind: Kind) -> wgpu::RenderPipeline {
        let constants = [("MASKED", kind.masked), ("BLENDED", kind.blended), ("UNLIT", kind.unlit)]
            .map(|(name, so)| (name, f64::from(u8::from(so))));
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: Some(&self.layout),
            vertex: wgpu::VertexState {
                module: &self.shader,
                entry_point: Some("place"),
                compilation_options: Default::default(),
                buffers: &[Some(corners()), Some(placements())],
            },
            primitive: primitive(kind),
            depth_stencil: Some(depth(kind)),
            multisample: wgpu::MultisampleState { count: SAMPLES, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &self.shader,
                entry_point: Some("shade"),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &constants,
                    ..Default::default()
                },
                targets: &[Some(colour(kind))],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

fn primitive(kind: Kind) -> wgpu::PrimitiveState {
    wgpu::PrimitiveState {
        front_face: if kind.mirrored { wgpu::FrontFace::Cw } else { wgpu::FrontFace::Ccw },
        cull_mode: (!kind.double_sided).then_some(wgpu::Face::Back),
        ..Default::default()
    }
}

fn depth(kind: Kind) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: DEPTH,
        depth_write_enabled: Some(!kind.blended),
        depth_compare: Some(wgpu::CompareFunction::Greater),
        stencil: Default::default(),
        bias: Default::default(),
    }
}

fn colour(kind: Kind) -> wgpu::ColorTargetState {
    wgpu::ColorTargetState {
        format: COLOUR,
        blend: kind.blended.then_some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
        write_mask: wgpu::ColorWrites::ALL,
    }
}

fn corners() -> wgpu::VertexBufferLayout<'static> {
    const ATTRIBUTES: [wgpu::VertexAttribute; 4] =
        wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x2, 3 => Float32x4];
    wgpu::VertexBufferLayout {
        array_stride: VERTEX_BYTES as u64,
        step_mode: VertexStepMode::Vertex,
        attributes: &ATTRIBUTES,
    }
}

fn placements() -> wgpu::VertexBufferLayout<'static> {
    const ATTRIBUTES: [wgpu::VertexAttribute; 8] = wgpu::vertex_attr_array![
        4 => Float32x4, 5 => Float32x4, 6 => Float32x4, 7 => Float32x4,
        8 => Float32x4, 9 => Float32x4, 10 => Float32x4, 11 => Float32x4
    ];
    wgpu::VertexBufferLayout {
        array_stride: PLACEMENT_BYTES as u64,
        step_mode: VertexStepMode::Instance,
        attributes: &ATTRIBUTES,
    }
}

fn uniform() -> wgpu::BindingType {
    wgpu::BindingType::Buffer {
        ty: BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    }
}

fn picture() -> wgpu::BindingType {
    wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    }
}

fn reading() -> wgpu::BindingType {
    wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)
}

fn layout(device: &wgpu::Device, bindings: &[(ShaderStages, wgpu::BindingType)]) -> wgpu::BindGroupLayout {
    let entries: Vec<_> = (0..)
        .zip(bindings)
        .map(|(binding, (visibility, ty))| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: *visibility,
            ty: *ty,
            count: None,
        })
        .collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
}

fn bind(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    resources: &[wgpu::BindingResource],
) -> wgpu::BindGroup {
    let entries: Vec<_> = (0..)
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource: resource.clone() })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
}
