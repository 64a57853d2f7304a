//! From a glTF primitive to plain triangles.

use super::scene::{Part, Vertex};
use super::texture::Textures;
use crate::asset::{Asset, Error};
use glam::{DMat4, DVec3, Vec3};
use gltf::json;
use gltf::json::mesh::{Mode, Semantic};
use gltf::json::validation::Checked;
use std::collections::BTreeSet;
use std::fmt;

/// A kind of thing that glTF can hold and this crate does not draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Left {
    Skins,
    MorphTargets,
    Points,
    Emission,
    NormalMaps,
}

impl Left {
    /// What of a material is not drawn.
    fn of(material: &json::Material) -> impl Iterator<Item = Left> {
        let glows = material.emissive_factor.0.iter().any(|light| *light > 0.0);
        let kinds = [(glows, Left::Emission), (material.normal_texture.is_some(), Left::NormalMaps)];
        kinds.into_iter().filter_map(|(is, kind)| is.then_some(kind))
    }
}

impl fmt::Display for Left {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Left::Skins => "skins (meshes rest)",
            Left::MorphTargets => "morph targets",
            Left::Points => "points",
            Left::Emission => "emission",
            Left::NormalMaps => "normal maps",
        })
    }
}

/// The triangles of a primitive that exists; `None` where it has none.
pub(crate) fn part(
    asset: &mut Asset,
    mesh: usize,
    primitive: usize,
    textures: &mut Textures,
    left: &mut BTreeSet<Left>,
) -> Result<Option<Part>, Error> {
    let stored = &asset.root().meshes[mesh].primitives[primitive];
    let (mode, indices, material) = (stored.mode, stored.indices, stored.material);
    let of = |semantic| stored.attributes.get(&Checked::Valid(semantic)).map(|a| a.value());
    let (positions, normals) = (of(Semantic::Positions), of(Semantic::Normals));
    let (colours, uvs) = (of(Semantic::Colors(0)), [0, 1, 2, 3].map(|n| of(Semantic::TexCoords(n))));
    if stored.targets.as_ref().is_some_and(|t| !t.is_empty()) {
        left.insert(Left::MorphTargets);
    }
    let Some(positions) = positions else {
        return Ok(None);
    };
    let positions: Vec<[f32; 3]> = attribute(asset, positions)?;
    let given = indices.map(|accessor| asset.indices(accessor.value())).transpose()?;
    let order = given.unwrap_or_else(|| (0..positions.len() as u32).collect());
    let (triangles, segments) = (triangles(mode, &order), segments(mode, &order));
    if triangles.is_none() && segments.is_none() {
        left.insert(Left::Points);
        return Ok(None);
    }
    let materials = &asset.root().materials;
    left.extend(material.and_then(|m| materials.get(m.value())).into_iter().flat_map(Left::of));
    let (mut material, uv_set) = textures.material(asset, material.map(|m| m.value()));
    let uv = uvs.get(uv_set).copied().flatten().filter(|_| material.texture.is_some());
    let vertices = positions.iter().map(|p| plain(*p)).collect();
    let mut raw = Raw { vertices, triangles: triangles.unwrap_or_default() };
    let has_normals = match normals {
        Some(accessor) => raw.fill(&attribute(asset, accessor)?, |v, n| v.normal = n),
        None => false,
    };
    if let Some(accessor) = uv {
        raw.fill(&attribute(asset, accessor)?, |v, uv| v.uv = uv);
    }
    if let Some(accessor) = colours {
        raw.fill(&vertex_colours(asset, accessor)?, |v, c| v.colour = c);
    }
    if let Some(segments) = segments.filter(|segments| !segments.is_empty()) {
        raw.thicken(&segments);
        // What has no surface has nothing for lamps to shine on.
        material.unlit = true;
    }
    raw.drop_broken();
    if !has_normals {
        raw.flatten();
    }
    let (placement, half_extent) = raw.shrink();
    Ok(Some(Part {
        vertices: raw.vertices,
        indices: raw.triangles.into_flattened(),
        material,
        placement,
        half_extent,
    }))
}

/// All elements of an accessor of `N` numbers each.
fn attribute<const N: usize>(asset: &mut Asset, accessor: usize) -> Result<Vec<[f32; N]>, Error> {
    let shape = asset.shape(accessor)?;
    if shape.components != N {
        let pointer = format!("/accessors/{accessor}/type");
        let problem = format!("must have {N} numbers, has {}", shape.components);
        return Err(Error::data(pointer, problem));
    }
    let numbers = asset.floats(accessor, 0..shape.count)?;
    Ok(numbers.as_chunks().0.to_vec())
}

/// Vertex colours may lack the fourth number.
fn vertex_colours(asset: &mut Asset, accessor: usize) -> Result<Vec<[f32; 4]>, Error> {
    match asset.shape(accessor)?.components {
        3 => {
            let colours = attribute(asset, accessor)?;
            Ok(colours.into_iter().map(|[r, g, b]| [r, g, b, 1.0]).collect())
        }
        _ => attribute(asset, accessor),
    }
}

fn plain(position: [f32; 3]) -> Vertex {
    Vertex { position, colour: [1.0; 4], ..Vertex::default() }
}

/// Corners three by three; `None` for points and lines.
fn triangles(mode: Checked<Mode>, order: &[u32]) -> Option<Vec<[u32; 3]>> {
    let windows = order.windows(3).enumerate();
    match mode {
        Checked::Valid(Mode::Triangles) => Some(order.as_chunks().0.to_vec()),
        // Every other triangle of a strip runs the other way round.
        Checked::Valid(Mode::TriangleStrip) => {
            let turned = |(i, w): (usize, &[u32])| match i % 2 {
                0 => [w[0], w[1], w[2]],
                _ => [w[0], w[2], w[1]],
            };
            Some(windows.map(turned).collect())
        }
        Checked::Valid(Mode::TriangleFan) => {
            let hub = order.first().copied().unwrap_or_default();
            let pairs = order.get(1..).unwrap_or_default().windows(2);
            Some(pairs.map(|w| [w[0], w[1], hub]).collect())
        }
        _ => None,
    }
}

/// Ends of lines two by two; `None` for what is no line.
fn segments(mode: Checked<Mode>, order: &[u32]) -> Option<Vec<[u32; 2]>> {
    let steps = || order.windows(2).map(|w| [w[0], w[1]]);
    match mode {
        Checked::Valid(Mode::Lines) => Some(order.as_chunks().0.to_vec()),
        Checked::Valid(Mode::LineStrip) => Some(steps().collect()),
        Checked::Valid(Mode::LineLoop) => {
            let close = order.first().zip(order.last()).map(|(first, last)| [*last, *first]);
            Some(steps().chain(close).collect())
        }
        _ => None,
    }
}

/// How thick lines are drawn, as a share of the largest extent of what they are part of.
const THICKNESS: f64 = 0.004;

/// Sine and cosine of thirds of a turn.
const SIDES: [(f64, f64); 3] =
    [(0.0, 1.0), (0.866_025_403_784_438_6, -0.5), (-0.866_025_403_784_438_6, -0.5)];

/// A primitive on its way.
struct Raw {
    vertices: Vec<Vertex>,
    triangles: Vec<[u32; 3]>,
}

impl Raw {
    /// Gives each vertex its value, if there is one for each.
    fn fill<T: Copy>(&mut self, values: &[T], set: impl Fn(&mut Vertex, T)) -> bool {
        let fits = values.len() == self.vertices.len();
        if fits {
            self.vertices.iter_mut().zip(values).for_each(|(v, value)| set(v, *value));
        }
        fits
    }

    /// Makes a three-sided rod of each line, for a line has no width of its own.
    fn thicken(&mut self, segments: &[[u32; 2]]) {
        let place = |vertex: &Vertex| Vec3::from(vertex.position).as_dvec3();
        let at = |index: u32| self.vertices.get(index as usize).copied();
        let ends: Vec<[Vertex; 2]> = segments.iter().filter_map(|&[a, b]| Some([at(a)?, at(b)?])).collect();
        let places = ends.iter().flatten().map(place).filter(|p| p.is_finite());
        let (low, high) =
            places.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        let radius = 0.5 * THICKNESS * (high - low).max_element();
        self.vertices.clear();
        for [a, b] in ends {
            let Some(along) = (place(&b) - place(&a)).try_normalize() else { continue };
            let (across, up) = along.any_orthonormal_pair();
            let first = self.vertices.len() as u32;
            for (side, (sin, cos)) in (0..).zip(SIDES) {
                let off = radius * (across * cos + up * sin);
                let moved = |v: Vertex| Vertex { position: (place(&v) + off).as_vec3().to_array(), ..v };
                self.vertices.extend([moved(a), moved(b)]);
                let (here, next) = (first + 2 * side, first + 2 * ((side + 1) % 3));
                self.triangles.extend([[here, next, next + 1], [here, next + 1, here + 1]]);
            }
        }
    }

    /// Drops triangles with a corner that does not exist or is not finite.
    fn drop_broken(&mut self) {
        let finite = |v: &Vertex| v.position.iter().all(|c| c.is_finite());
        let sound = |index: &u32| self.vertices.get(*index as usize).is_some_and(finite);
        self.triangles.retain(|t| t.iter().all(sound));
    }

    /// Gives each triangle corners of its own that point where it faces.
    fn flatten(&mut self) {
        let mut vertices = Vec::with_capacity(self.triangles.len() * 3);
        for triangle in &mut self.triangles {
            let corners = triangle.map(|i| self.vertices[i as usize]);
            let [a, b, c] = corners.map(|v| Vec3::from(v.position).as_dvec3());
            let normal = (b - a).cross(c - a).normalize_or_zero().as_vec3().to_array();
            let first = vertices.len() as u32;
            vertices.extend(corners.map(|v| Vertex { normal, ..v }));
            *triangle = [first, first + 1, first + 2];
        }
        self.vertices = vertices;
    }

    /// Moves the vertices into the cube from −1 to 1 and returns the way back
    /// and half the size of the box they fill there.
    fn shrink(&mut self) -> (DMat4, DVec3) {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for index in self.triangles.as_flattened() {
            let p = Vec3::from(self.vertices[*index as usize].position).as_dvec3();
            (low, high) = (low.min(p), high.max(p));
        }
        if self.triangles.is_empty() {
            return (DMat4::IDENTITY, DVec3::ZERO);
        }
        let middle = (low + high) / 2.0;
        let half = (high - low) / 2.0;
        let scale = match half.max_element() {
            0.0 => 1.0,
            size => size,
        };
        for vertex in &mut self.vertices {
            let p = (Vec3::from(vertex.position).as_dvec3() - middle) / scale;
            vertex.position = p.as_vec3().to_array();
        }
        let back = DMat4::from_translation(middle) * DMat4::from_scale(DVec3::splat(scale));
        (back, half / scale)
    }
}
