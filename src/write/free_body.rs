//! The free body: centred, nose along +Z, up +Y, three arrows in the axes' colours.

use super::mesh::Mesh;
use glam::Vec3;

/// Indices of its materials: body, nose, fin, and the axes x, y, z.
pub(super) struct Colours {
    pub(super) body: usize,
    pub(super) nose: usize,
    pub(super) fin: usize,
    pub(super) axes: [usize; 3],
}

/// About how large it is.
pub(super) const SIZE: f64 = 2.0;

/// Builds the mesh. The body is about 1.6 long; the arrows reach 1.5 from the centre.
pub(super) fn mesh(colours: &Colours) -> Mesh {
    let mut mesh = Mesh::new("body");
    let v = Vec3::new;
    mesh.cuboid([colours.body; 6], v(-0.35, -0.2, -0.8), v(0.35, 0.2, 0.4));
    pyramid(&mut mesh, colours.nose, v(0.0, 0.0, 0.4), v(0.35, 0.0, 0.0), v(0.0, 0.2, 0.0), v(0.0, 0.0, 0.8));
    fin(&mut mesh, colours.fin);
    for (axis, &colour) in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().zip(&colours.axes) {
        arrow(&mut mesh, colour, axis);
    }
    mesh
}

/// An upright fin at the back of the body's top.
fn fin(mesh: &mut Mesh, material: usize) {
    let v = Vec3::new;
    let side = |x: f32| [v(x, 0.2, -0.8), v(x, 0.2, -0.2), v(x, 0.6, -0.8)];
    let ([a, b, c], [d, e, f]) = (side(0.05), side(-0.05));
    mesh.face(material, &[a, c, b]);
    mesh.face(material, &[d, e, f]);
    mesh.face(material, &[a, b, e, d]);
    mesh.face(material, &[b, c, f, e]);
    mesh.face(material, &[c, a, d, f]);
}

/// A slender arrow from the centre along an axis.
fn arrow(mesh: &mut Mesh, material: usize, axis: Vec3) {
    const SHAFT: f32 = 0.03;
    const HEAD: f32 = 0.09;
    let (right, up) = across(axis);
    let (end, width) = (axis * 1.25, right * SHAFT + up * SHAFT);
    let corner = [right * SHAFT + up * SHAFT, up * SHAFT - right * SHAFT, -width, right * SHAFT - up * SHAFT];
    for i in 0..4 {
        let (a, b) = (corner[i], corner[(i + 1) % 4]);
        mesh.face(material, &[a, b, b + end, a + end]);
    }
    mesh.face(material, &[corner[3], corner[2], corner[1], corner[0]]);
    pyramid(mesh, material, end, right * HEAD, up * HEAD, axis * 0.25);
}

/// Two directions that with `axis` form a right-handed frame.
fn across(axis: Vec3) -> (Vec3, Vec3) {
    let right = Vec3::new(axis.y, axis.z, axis.x);
    (right, axis.cross(right))
}

/// A pyramid on a rectangle with half sides `right` and `up`; `rise`, from the base's
/// centre to the tip, points to right × up.
fn pyramid(mesh: &mut Mesh, material: usize, centre: Vec3, right: Vec3, up: Vec3, rise: Vec3) {
    let base = [right + up, up - right, -right - up, right - up].map(|corner| centre + corner);
    let tip = centre + rise;
    mesh.face(material, &[base[3], base[2], base[1], base[0]]);
    for i in 0..4 {
        mesh.face(material, &[base[i], base[(i + 1) % 4], tip]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::write::mesh::tests::volume;

    #[test]
    fn faces_look_outwards() {
        let built = mesh(&Colours { body: 0, nose: 1, fin: 2, axes: [3, 4, 5] });
        for (material, expected) in [
            (0, 0.7 * 0.4 * 1.2),
            (1, 0.7 * 0.4 * 0.8 / 3.0),
            (2, 0.6 * 0.4 / 2.0 * 0.1),
            (3, 0.06 * 0.06 * 1.25 + 0.18 * 0.18 * 0.25 / 3.0),
        ] {
            let parts = built.parts.iter().filter(|part| part.material == material).cloned().collect();
            // The arrow's shaft lacks the end that its head covers.
            let found = volume(&Mesh { parts, ..built.clone() });
            let end = if material == 3 { 0.06 * 0.06 * 1.25 / 3.0 } else { 0.0 };
            assert!((found - (expected - end)).abs() < 1e-5, "{material}: {found} {expected}");
        }
    }

    #[test]
    fn nose_is_z_and_arrows_are_axes() {
        let built = mesh(&Colours { body: 0, nose: 1, fin: 2, axes: [3, 4, 5] });
        let farthest = |material: usize| {
            let part = built.parts.iter().find(|part| part.material == material).unwrap();
            let corners = part.triangles.iter().map(|&i| built.corners[i as usize].0);
            corners.max_by(|a, b| a.length().total_cmp(&b.length())).unwrap()
        };
        assert_eq!(farthest(1), Vec3::Z * 1.2);
        assert_eq!([farthest(3), farthest(4), farthest(5)], [Vec3::X, Vec3::Y, Vec3::Z].map(|a| a * 1.5));
    }
}
