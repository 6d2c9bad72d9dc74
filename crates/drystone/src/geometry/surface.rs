//! Closed surfaces of triangles: bodies that are not cut into convex pieces.

use super::{
    Face, Vector3,
    closed::{SurfaceEdge, check_numbers, edges_of},
    polyhedron::Polyhedron,
    solid_fault::SolidFault,
};
use crate::interrupt::poll;
use parry3d_f64::{
    bounding_volume::Aabb,
    partitioning::{Bvh, BvhBuildStrategy},
};

/// Triangles of which every corner is within this share of the largest extent of one plane are one flat face: five times the
/// rounding of single precision, in which meshes are often kept.
pub const PLANE: f64 = 3e-7;

/// A closed surface, its triangles counter-clockwise from outside.
#[derive(Debug, Clone)]
pub struct Surface {
    vertices: Vec<Vector3>,
    triangles: Vec<[u32; 3]>,
    /// The flat face that each triangle is of.
    faces: Vec<u32>,
    /// Outward unit normal of each flat face.
    normals: Vec<Vector3>,
    /// Square metres, of each flat face.
    areas: Vec<f64>,
    edges: Vec<SurfaceEdge>,
    /// The edges of each triangle: between its first and second vertex, and so on.
    sides: Vec<[u32; 3]>,
    /// Where the edges of each vertex begin in `around`, and one more.
    starts: Vec<u32>,
    /// The edges at each vertex, one vertex after the other.
    around: Vec<u32>,
    /// The first triangle at each vertex.
    owners: Vec<u32>,
    /// Of each vertex the sum of the normals around it, each by the angle there (J. A. Baerentzen and H. Aanaes, 2005).
    corners: Vec<Vector3>,
    tree: Bvh,
}

impl PartialEq for Surface {
    fn eq(&self, other: &Self) -> bool {
        self.vertices == other.vertices && self.triangles == other.triangles
    }
}

/// Operations for a triangle, about: to sort its edges and find its flat face and its place in the tree.
const TRIANGLE: usize = 1000;

impl Surface {
    /// A surface of vertices, metres, and triangles.
    ///
    /// # Errors
    /// [`SolidFault`] for what is not closed.
    pub fn new(vertices: Vec<Vector3>, triangles: Vec<[u32; 3]>) -> Result<Self, SolidFault> {
        check_numbers(&vertices, &triangles)?;
        poll(TRIANGLE * triangles.len());
        let crosses: Vec<Vector3> = triangles.iter().map(|t| across(t, &vertices)).collect();
        let own = |k: u32| crosses[k as usize].normalize_or_zero();
        let edges = edges_of(&triangles, &vertices, own)?;
        let sides = sides_of(&triangles, &edges);
        let tight = PLANE * extent(&vertices);
        let (faces, normals, areas) = flat_faces(&vertices, &triangles, &crosses, (&edges, &sides), tight);
        let tree = tree_of(&vertices, &triangles);
        let (starts, around) = around_of(vertices.len(), &edges);
        let (corners, owners) = (Vec::new(), owners_of(vertices.len(), &triangles));
        let mut surface =
            Self { vertices, triangles, faces, normals, areas, edges, sides, starts, around, owners, corners, tree };
        surface.turn_edges();
        surface.corners = surface.corner_normals();
        Ok(surface)
    }

    /// The surface of a convex polyhedron.
    pub(crate) fn of_polyhedron(piece: &Polyhedron) -> Result<Self, SolidFault> {
        let fan = |face: &Vec<usize>| {
            let face: Vec<u32> = face.iter().map(|&k| k as u32).collect();
            (1..face.len() - 1).map(move |k| [face[0], face[k], face[k + 1]]).collect::<Vec<_>>()
        };
        Self::new(piece.vertices().to_vec(), piece.faces().iter().flat_map(fan).collect())
    }

    /// The normals of flat faces decide how an edge bends, not those of slivers.
    fn turn_edges(&mut self) {
        for edge in &mut self.edges {
            let [first, second] = edge.triangles.map(|k| self.normals[self.faces[k as usize] as usize]);
            let [from, to] = edge.ends.map(|k| self.vertices[k as usize]);
            let along = (to - from).normalize_or_zero();
            let same = edge.triangles.map(|k| self.faces[k as usize]);
            edge.turn = match same[0] == same[1] {
                true => 0.0,
                false => first.cross(second).dot(along).atan2(first.dot(second)),
            };
        }
    }

    fn corner_normals(&self) -> Vec<Vector3> {
        let mut sums = vec![Vector3::ZERO; self.vertices.len()];
        for (k, triangle) in self.triangles.iter().enumerate() {
            let corners = triangle.map(|v| self.vertices[v as usize]);
            for (i, &vertex) in triangle.iter().enumerate() {
                let [to, fro] = [corners[(i + 1) % 3] - corners[i], corners[(i + 2) % 3] - corners[i]];
                sums[vertex as usize] += to.cross(fro).length().atan2(to.dot(fro)) * self.normal(k as u32);
            }
        }
        sums
    }

    /// Metres.
    pub fn vertices(&self) -> &[Vector3] {
        &self.vertices
    }

    /// The vertices of each, counter-clockwise from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Every edge once.
    pub fn edges(&self) -> &[SurfaceEdge] {
        &self.edges
    }

    /// The edges of a triangle: between its first and second vertex, second and third, third and first.
    pub fn sides(&self, triangle: u32) -> [u32; 3] {
        self.sides[triangle as usize]
    }

    /// The flat face of a triangle.
    pub fn face(&self, triangle: u32) -> u32 {
        self.faces[triangle as usize]
    }

    /// Outward unit normal of a triangle's flat face.
    pub fn normal(&self, triangle: u32) -> Vector3 {
        self.normals[self.faces[triangle as usize] as usize]
    }

    /// Outward unit normals of the flat faces, each with its area in square metres.
    pub fn flat_faces(&self) -> impl Iterator<Item = (Vector3, f64)> + '_ {
        self.normals.iter().copied().zip(self.areas.iter().copied())
    }

    /// The triangles with their own normals, areas and centroids; without those that have no area.
    pub(crate) fn plane_parts(&self) -> impl Iterator<Item = Face<[f64; 3]>> + '_ {
        (0..self.triangles.len() as u32).filter_map(|k| {
            let [a, b, c] = self.corners(k);
            let across = (b - a).cross(c - a);
            let normal = across.try_normalize()?;
            let middle = (a + b + c) / 3.0;
            Some(Face { normal: normal.to_array(), area: 0.5 * across.length(), middle: middle.to_array() })
        })
    }

    /// The corners of a triangle, metres.
    pub fn corners(&self, triangle: u32) -> [Vector3; 3] {
        self.triangles[triangle as usize].map(|k| self.vertices[k as usize])
    }

    /// The edges at a vertex.
    pub(crate) fn edges_at(&self, vertex: u32) -> impl Iterator<Item = &SurfaceEdge> + '_ {
        let [from, to] = [0, 1].map(|k| self.starts[vertex as usize + k] as usize);
        self.around[from..to].iter().map(|&edge| &self.edges[edge as usize])
    }

    /// The first of the triangles at a vertex.
    pub(crate) fn owner(&self, vertex: u32) -> u32 {
        self.owners[vertex as usize]
    }

    /// A vector that looks out of the surface at a vertex.
    pub(crate) fn corner_normal(&self, vertex: u32) -> Vector3 {
        self.corners[vertex as usize]
    }

    /// The triangles in a tree of boxes.
    pub(crate) fn tree(&self) -> &Bvh {
        &self.tree
    }

    /// The same, put through a rotation.
    pub(crate) fn turned(&self, rotate: impl Fn(Vector3) -> Vector3) -> Self {
        poll(TRIANGLE * self.triangles.len());
        let all = |vectors: &[Vector3]| -> Vec<Vector3> { vectors.iter().map(|&v| rotate(v)).collect() };
        let vertices = all(&self.vertices);
        let tree = tree_of(&vertices, &self.triangles);
        Self { vertices, tree, normals: all(&self.normals), corners: all(&self.corners), ..self.clone() }
    }

    /// One vertex of each connected shell.
    pub(crate) fn shell_vertices(&self) -> Vec<u32> {
        let mut shell: Vec<u32> = (0..self.vertices.len() as u32).collect();
        fn root(shell: &mut [u32], mut k: u32) -> u32 {
            while shell[k as usize] != k {
                shell[k as usize] = shell[shell[k as usize] as usize];
                k = shell[k as usize];
            }
            k
        }
        for &[a, b, c] in &self.triangles {
            let (a, b, c) = (root(&mut shell, a), root(&mut shell, b), root(&mut shell, c));
            let least = a.min(b).min(c);
            [a, b, c].into_iter().for_each(|k| shell[k as usize] = least);
        }
        let mut roots: Vec<u32> = self.triangles.iter().map(|t| root(&mut shell, t[0])).collect();
        roots.sort_unstable();
        roots.dedup();
        roots
    }
}

/// The largest side of the box around points.
pub(super) fn extent(points: &[Vector3]) -> f64 {
    let low = points.iter().fold(Vector3::INFINITY, |low, v| low.min(*v));
    let high = points.iter().fold(Vector3::NEG_INFINITY, |high, v| high.max(*v));
    (high - low).max_element()
}

/// Twice the area of a triangle, along its normal.
fn across(triangle: &[u32; 3], vertices: &[Vector3]) -> Vector3 {
    let [a, b, c] = triangle.map(|k| vertices[k as usize]);
    (b - a).cross(c - a)
}

fn tree_of(vertices: &[Vector3], triangles: &[[u32; 3]]) -> Bvh {
    let boxes: Vec<Aabb> = triangles
        .iter()
        .map(|triangle| {
            let [a, b, c] = triangle.map(|k| vertices[k as usize]);
            Aabb::new(a.min(b).min(c), a.max(b).max(c))
        })
        .collect();
    Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes)
}

fn around_of(vertices: usize, edges: &[SurfaceEdge]) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0_u32; vertices + 2];
    edges.iter().flat_map(|edge| edge.ends).for_each(|end| starts[end as usize + 2] += 1);
    for k in 2..starts.len() {
        starts[k] += starts[k - 1];
    }
    let mut around = vec![0; 2 * edges.len()];
    for (number, edge) in edges.iter().enumerate() {
        for end in edge.ends {
            let place = &mut starts[end as usize + 1];
            around[*place as usize] = number as u32;
            *place += 1;
        }
    }
    (starts, around)
}

fn owners_of(vertices: usize, triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut owners = vec![u32::MAX; vertices];
    for (k, triangle) in triangles.iter().enumerate().rev() {
        triangle.iter().for_each(|&vertex| owners[vertex as usize] = k as u32);
    }
    owners
}

fn sides_of(triangles: &[[u32; 3]], edges: &[SurfaceEdge]) -> Vec<[u32; 3]> {
    let mut sides = vec![[0; 3]; triangles.len()];
    for (number, edge) in edges.iter().enumerate() {
        for triangle in edge.triangles.map(|k| k as usize) {
            let [a, b, c] = triangles[triangle];
            let side = [[a, b], [b, c], [c, a]].iter().position(|&[p, q]| edge.ends == [p.min(q), p.max(q)]);
            if let Some(side) = side {
                sides[triangle][side] = number as u32;
            }
        }
    }
    sides
}

/// From the largest triangle on, each takes its neighbours in as long as they lie on its plane.
///
/// A neighbour must look the same way too, unless it is so thin that its normal is rounding.
fn flat_faces(
    vertices: &[Vector3],
    triangles: &[[u32; 3]],
    crosses: &[Vector3],
    (edges, sides): (&[SurfaceEdge], &[[u32; 3]]),
    tight: f64,
) -> (Vec<u32>, Vec<Vector3>, Vec<f64>) {
    const NONE: u32 = u32::MAX;
    let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
    let sizes: Vec<f64> = crosses.iter().map(|cross| cross.length_squared()).collect();
    order.sort_unstable_by(|&i, &j| sizes[j as usize].total_cmp(&sizes[i as usize]).then(i.cmp(&j)));
    let mut faces = vec![NONE; triangles.len()];
    let (mut normals, mut areas) = (Vec::new(), Vec::new());
    for &seed in &order {
        if faces[seed as usize] != NONE {
            continue;
        }
        let face = normals.len() as u32;
        let normal = crosses[seed as usize].normalize_or_zero();
        let offset = normal.dot(vertices[triangles[seed as usize][0] as usize]);
        let on_plane = |k: u32| {
            let [a, b, c] = triangles[k as usize].map(|v| vertices[v as usize]);
            let near = [a, b, c].into_iter().all(|v| (normal.dot(v) - offset).abs() <= tight);
            let longest = (b - a).length().max((c - b).length()).max((a - c).length());
            let thin = crosses[k as usize].length() <= 4.0 * tight * longest;
            near && (thin || crosses[k as usize].dot(normal) > 0.0)
        };
        faces[seed as usize] = face;
        let mut waiting = vec![seed];
        let mut double = Vector3::ZERO;
        while let Some(k) = waiting.pop() {
            double += crosses[k as usize];
            for side in sides[k as usize] {
                let [first, second] = edges[side as usize].triangles;
                let other = if first == k { second } else { first };
                if faces[other as usize] == NONE && on_plane(other) {
                    faces[other as usize] = face;
                    waiting.push(other);
                }
            }
        }
        // The whole face's: what the seed's corners are off is spread over a larger base.
        let whole = double.normalize_or_zero();
        normals.push(if whole == Vector3::ZERO { normal } else { whole });
        areas.push(0.5 * double.length());
    }
    (faces, normals, areas)
}
