//! Meshes of flat faces, and the box.

use glam::Vec3;

/// Triangles with normals, in parts of one material each.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Its name in the file.
    pub name: String,
    /// Corners: position and normal. Each face has its own, so that edges stay sharp.
    pub corners: Vec<(Vec3, Vec3)>,
    /// Triangles by material.
    pub parts: Vec<Part>,
}

/// The triangles of a mesh that share a material.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Index into the scene's materials.
    pub material: usize,
    /// Three corners a triangle, counter-clockwise seen from outside.
    pub triangles: Vec<u16>,
}

/// A matt colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Its name in the file.
    pub name: &'static str,
    /// Red, green, blue as screens show them (sRGB), 0 to 255.
    pub colour: [u8; 3],
}

impl Mesh {
    pub(super) fn new(name: &str) -> Mesh {
        Mesh { name: name.to_owned(), corners: Vec::new(), parts: Vec::new() }
    }

    /// Adds a flat, convex face: its outline counter-clockwise seen from outside.
    pub(super) fn face(&mut self, material: usize, outline: &[Vec3]) {
        // Newell's normal: corners may lie along one line.
        let edges = outline.iter().zip(outline.iter().cycle().skip(1));
        let normal = edges.map(|(a, b)| a.cross(*b)).sum::<Vec3>().normalize();
        let first = self.corners.len() as u16;
        self.corners.extend(outline.iter().map(|&corner| (corner, normal)));
        let part = match self.parts.iter_mut().position(|part| part.material == material) {
            Some(known) => &mut self.parts[known],
            None => {
                self.parts.push(Part { material, triangles: Vec::new() });
                self.parts.last_mut().expect("just added")
            }
        };
        for i in 2..outline.len() as u16 {
            part.triangles.extend([first, first + i - 1, first + i]);
        }
    }

    /// Adds the six faces of the box from `low` to `high`, in the order +X −X +Y −Y +Z −Z.
    pub(super) fn cuboid(&mut self, materials: [usize; 6], low: Vec3, high: Vec3) {
        let at = |x: usize, y: usize, z: usize| {
            let pick = |i: usize, k: usize| if k == 0 { low[i] } else { high[i] };
            Vec3::new(pick(0, x), pick(1, y), pick(2, z))
        };
        let faces = [
            [at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)],
            [at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0)],
            [at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0)],
            [at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)],
            [at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)],
            [at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0)],
        ];
        for (material, face) in materials.into_iter().zip(faces) {
            self.face(material, &face);
        }
    }

    /// Position and normal of every corner, interleaved, as the file holds them.
    pub(super) fn vertex_bytes(&self) -> Vec<u8> {
        let floats = self
            .corners
            .iter()
            .flat_map(|(position, normal)| position.to_array().into_iter().chain(normal.to_array()));
        floats.flat_map(f32::to_le_bytes).collect()
    }

    /// The indices of all parts, one after another.
    pub(super) fn index_bytes(&self) -> Vec<u8> {
        self.parts.iter().flat_map(|part| &part.triangles).flat_map(|i| i.to_le_bytes()).collect()
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Volume inside the triangles: positive only if all of them face outwards.
    pub(in crate::write) fn volume(mesh: &Mesh) -> f32 {
        let triangles = mesh.parts.iter().flat_map(|part| part.triangles.chunks(3));
        triangles
            .map(|t| {
                let [a, b, c] = [0, 1, 2].map(|i| mesh.corners[t[i] as usize].0);
                a.dot(b.cross(c)) / 6.0
            })
            .sum()
    }

    /// Every edge is used once in each direction: the surface is closed.
    pub(in crate::write) fn is_closed(mesh: &Mesh) -> bool {
        let key = |v: Vec3| v.to_array().map(|x| (x * 1024.0).round() as i32);
        let mut edges = std::collections::HashMap::new();
        for triangle in mesh.parts.iter().flat_map(|part| part.triangles.chunks(3)) {
            for i in 0..3 {
                let corner = |i: usize| key(mesh.corners[triangle[i % 3] as usize].0);
                *edges.entry((corner(i), corner(i + 1))).or_insert(0) += 1;
                *edges.entry((corner(i + 1), corner(i))).or_insert(0) -= 1;
            }
        }
        edges.values().all(|&balance| balance == 0)
    }

    #[test]
    fn cuboid_is_closed_and_faces_outwards() {
        let mut mesh = Mesh::new("box");
        mesh.cuboid([0, 1, 2, 3, 4, 5], Vec3::new(-0.5, -3.0, -0.5), Vec3::new(0.5, 0.0, 0.5));
        assert_eq!(volume(&mesh), 3.0);
        assert!(is_closed(&mesh));
        let normals: Vec<Vec3> = mesh.corners.iter().step_by(4).map(|c| c.1).collect();
        let axes = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
        assert_eq!(normals, axes);
        assert_eq!(mesh.vertex_bytes().len(), 24 * 24);
        assert_eq!(mesh.index_bytes().len(), 36 * 2);
    }
}
