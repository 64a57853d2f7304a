//! The glider that flies along a path: front, top and sides are told apart at a glance.

use super::mesh::{Material, Mesh};
use glam::Vec3;

/// Wings in the colours of a ship's lights: red to port, green to starboard.
pub(super) const COLOURS: [Material; 6] = [
    Material { name: "nose", colour: [245, 166, 35] },
    Material { name: "port", colour: [214, 69, 56] },
    Material { name: "starboard", colour: [70, 160, 80] },
    Material { name: "top", colour: [118, 138, 172] },
    Material { name: "bottom", colour: [70, 80, 100] },
    Material { name: "fin", colour: [58, 110, 207] },
];

/// From nose to tail.
pub(super) const LENGTH: f64 = 2.0;

const NOSE: usize = 0;
const PORT: usize = 1;
const STARBOARD: usize = 2;
const TOP: usize = 3;
const BOTTOM: usize = 4;
const FIN: usize = 5;

/// Builds the mesh: about 2 long, 1.8 wide, its middle in the origin, nose along +Z and top
/// along +Y. Facing +Z with +Y up, port (left) is +X.
pub(super) fn mesh() -> Mesh {
    let mut mesh = Mesh::new("glider");
    let v = Vec3::new;
    let (tip, ridge, keel) = (v(0.0, 0.0, 1.2), v(0.0, 0.16, -0.5), v(0.0, -0.1, -0.5));
    // Where the nose ends and the wings begin, a third of the way back.
    let at = |corner: Vec3| tip.lerp(corner, 0.35);
    for (side, colour) in [(1.0, PORT), (-1.0, STARBOARD)] {
        let wing = v(0.9 * side, 0.0, -0.8);
        let mut face = |material: usize, corners: &[Vec3]| {
            // Mirrored faces run the other way round.
            let mut corners = corners.to_vec();
            if side < 0.0 {
                corners.reverse();
            }
            mesh.face(material, &corners);
        };
        face(NOSE, &[tip, at(wing), at(ridge)]);
        face(NOSE, &[tip, at(keel), at(wing)]);
        // The wing's outer half is coloured, its inner half is the body's top.
        let (front, back) = (at(wing).lerp(wing, 0.45), ridge.lerp(wing, 0.45));
        face(TOP, &[at(ridge), at(wing), front, back]);
        face(TOP, &[at(ridge), back, ridge]);
        face(colour, &[back, front, wing]);
        face(BOTTOM, &[at(keel), keel, wing, front, at(wing)]);
        face(BOTTOM, &[keel, ridge, back, wing]);
    }
    fin(&mut mesh);
    mesh
}

/// An upright fin at the back.
fn fin(mesh: &mut Mesh) {
    let v = Vec3::new;
    let side = |x: f32| [v(x, 0.1, -0.55), v(x, 0.1, 0.0), v(x, 0.6, -0.75)];
    let ([a, b, c], [d, e, f]) = (side(0.04), side(-0.04));
    mesh.face(FIN, &[a, c, b]);
    mesh.face(FIN, &[d, e, f]);
    mesh.face(FIN, &[a, b, e, d]);
    mesh.face(FIN, &[b, c, f, e]);
    mesh.face(FIN, &[c, a, d, f]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::write::mesh::tests::{is_closed, volume};

    fn without_fin() -> Mesh {
        let built = mesh();
        let parts = built.parts.iter().filter(|part| part.material != FIN).cloned().collect();
        Mesh { parts, ..built }
    }

    #[test]
    fn the_body_is_closed_and_faces_outwards() {
        assert!(is_closed(&without_fin()));
        // Two tetrahedra on the triangle of tip, ridge and keel, half a wing each.
        let expected = 2.0 * (0.26 * 1.7 / 2.0) * 0.9 / 3.0;
        assert!((volume(&without_fin()) - expected).abs() < 1e-5, "{}", volume(&without_fin()));
    }

    #[test]
    fn normals_are_units() {
        assert!(mesh().corners.iter().all(|(_, normal)| (normal.length() - 1.0).abs() < 1e-6));
    }

    #[test]
    fn port_is_left() {
        let built = mesh();
        let part = built.parts.iter().find(|part| part.material == PORT).unwrap();
        assert!(part.triangles.iter().all(|&i| built.corners[i as usize].0.x > 0.0));
    }
}
