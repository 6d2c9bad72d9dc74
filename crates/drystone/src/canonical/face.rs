//! Faces: all points in which two bodies touch on one plane, and the elastic layer between them.

use super::section::{Section, outline};
use crate::{
    contact::Contact,
    formulate::Assembly,
    geometry::{cross, dot, minus},
};

/// Width of the layer at an edge, and both widths at a corner, as a share of the radius of the smaller body (that of its
/// corner furthest from its centre of mass). Small beside faces, and not so small that other numbers are lost beside it.
const WIDTH: f64 = 0.1;

/// Normals that differ by less, per axis, are those of one plane.
const SAME_NORMAL: f64 = 1e-6;
/// Points further from a plane than this share of the smaller body's radius, and than the gaps there, are not on it.
const SAME_PLANE: f64 = 1e-6;

/// A face and its layer.
#[derive(Debug, Clone)]
pub(crate) struct Face {
    /// Its contacts, by their place among those asked about.
    pub points: Vec<usize>,
    /// Those of them that are corners of its outline.
    pub corners: Vec<usize>,
    /// The normal, and the principal axes of the outline.
    frame: [[f64; 3]; 3],
    centroid: [f64; 3],
    /// Diagonal of `Q^-1`, forces along the frame and moments about it, in the order of a body's rows: m^2 and m^4, in the plane m
    /// and m^3.
    pub stiffness: Vec<f64>,
}

impl Face {
    /// The wrench about the centroid of a unit force along a direction at a point, in the order of a body's rows.
    pub fn wrench(&self, direction: [f64; 3], point: [f64; 3]) -> [f64; 6] {
        let along = |vector: [f64; 3]| self.frame.map(|axis| dot(axis, vector));
        let (force, moment) = (along(direction), along(cross(minus(point, self.centroid), direction)));
        match self.stiffness.len() {
            3 => [force[0], force[1], moment[2], 0.0, 0.0, 0.0],
            _ => [force[0], force[1], force[2], moment[0], moment[1], moment[2]],
        }
    }

    fn of(assembly: &Assembly, contacts: &[&Contact], points: Vec<usize>, radius: f64) -> Self {
        let first = contacts[points[0]];
        let normal @ [x, y, _] = first.normal;
        let [u, v] = match assembly.in_plane() {
            true => [[-y, x, 0.0], [0.0, 0.0, 1.0]],
            false => across(normal),
        };
        let from = |point: &usize| minus(contacts[*point].point, first.point);
        let flat: Vec<[f64; 2]> = points.iter().map(from).map(|from| [dot(u, from), dot(v, from)]).collect();
        let corners = outline(&flat);
        let Section { centroid: [along, aside], axis: [c, s], area, spread } =
            Section::of(&flat, &corners, WIDTH * radius);
        let centroid = [0, 1, 2].map(|k| first.point[k] + along * u[k] + aside * v[k]);
        let stiffness = |factors: &[f64], size: f64| factors.iter().map(|factor| size * factor).collect();
        let (frame, stiffness) = if assembly.in_plane() {
            // As deep as it is long, the section is a square: per metre of depth it is the length.
            let length = (12.0 * spread[0]).sqrt();
            ([normal, u, v], stiffness(&[1.0, 1.0, spread[0]], length))
        } else {
            let turned = [0, 1].map(|k| [0, 1, 2].map(|i| [c * u[i] + s * v[i], c * v[i] - s * u[i]][k]));
            let moments = [spread[0] + spread[1], spread[1], spread[0]];
            ([normal, turned[0], turned[1]], stiffness(&[1.0, 1.0, 1.0, moments[0], moments[1], moments[2]], area))
        };
        let corners = corners.into_iter().map(|k| points[k]).collect();
        Self { points, corners, frame, centroid, stiffness }
    }
}

/// Two unit vectors square to a normal and to one another.
fn across(normal: [f64; 3]) -> [[f64; 3]; 2] {
    let furthest = (1..3).fold(0, |best, k| if normal[k].abs() < normal[best].abs() { k } else { best });
    let mut first = [0.0; 3];
    first[furthest] = 1.0;
    let along = dot(first, normal);
    let first = [0, 1, 2].map(|k| first[k] - along * normal[k]);
    let scale = dot(first, first).sqrt().recip();
    let first = first.map(|x| x * scale);
    [first, cross(normal, first)]
}

/// The faces of some contacts, ordered by pair of bodies and then by their first point.
pub(crate) fn faces(assembly: &Assembly, contacts: &[&Contact]) -> Vec<Face> {
    let mut order: Vec<usize> = (0..contacts.len()).collect();
    order.sort_by_key(|&point| contacts[point].bodies);
    let pairs = order.chunk_by(|&a, &b| contacts[a].bodies == contacts[b].bodies);
    pairs.flat_map(|pair| of_pair(assembly, contacts, pair)).collect()
}

fn of_pair(assembly: &Assembly, contacts: &[&Contact], pair: &[usize]) -> Vec<Face> {
    let radius = contacts[pair[0]].bodies.map(|body| assembly.bodies()[body].radius);
    let radius = radius[0].min(radius[1]);
    let mut planes: Vec<Vec<usize>> = Vec::new();
    for &point in pair {
        let contact = contacts[point];
        let on = |plane: &Vec<usize>| {
            let first = contacts[plane[0]];
            let turned = minus(first.normal, contact.normal).iter().fold(0.0_f64, |most, d| most.max(d.abs()));
            let off = dot(first.normal, minus(contact.point, first.point)).abs();
            turned <= SAME_NORMAL && off <= SAME_PLANE * radius + first.gap.abs() + contact.gap.abs()
        };
        match planes.iter().position(on) {
            Some(plane) => planes[plane].push(point),
            None => planes.push(vec![point]),
        }
    }
    planes.into_iter().map(|points| Face::of(assembly, contacts, points, radius)).collect()
}
