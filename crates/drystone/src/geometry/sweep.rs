//! Whether one convex piece can be moved away along a straight line, past another.
//!
//! A moves along the direction d and B stays. A never enters B if and only if a plane parts them that A does not move
//! towards:
//!
//! ```text
//! min_b n'b - max_a n'a >= 0    and    n'd <= 0    for some n
//! ```
//!
//! (the half-line t d, t >= 0, then does not meet the interior of the difference B - A; both are convex). Such an n is found
//! among few: if some n is square to d, the shadows along d are apart, and a normal of an edge of one of them parts them; if
//! all have n'd < 0, so has the normal of a face of B - A, which comes from a face of A, a face of B or an edge of each.
//!
//! Which piece is in the way of which, for every direction, is the non-directional blocking graph of R. H. Wilson and
//! J.-F. Rit, "Maintaining geometric dependencies in an assembly planner", ICRA 1990.

use super::{
    PoseInSpace, Solid, Vector3,
    vectors::{cross, dot, length, minus, unit},
};
use crate::interrupt::poll;
use parry3d_f64::{
    bounding_volume::{Aabb, BoundingVolume},
    partitioning::{Bvh, BvhBuildStrategy, BvhNode},
};

/// How far a direction may be from lying in a face, radians, to slide along it: far above the rounding of normals, and less
/// than a contact tolerance on the way of a thousand blocks.
const SLIDING: f64 = 1e-9;

/// A convex piece. One in the plane is a column without end, whose edges are upright.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// In the world, metres.
    vertices: Vec<[f64; 3]>,
    /// Outward unit normals of the faces.
    normals: Vec<[f64; 3]>,
    /// Areas of the faces, square metres; in the plane lengths.
    areas: Vec<f64>,
    /// Unit directions of the edges.
    edges: Vec<[f64; 3]>,
    /// All vertices are within the radius of the middle, metres.
    middle: [f64; 3],
    radius: f64,
}

impl Piece {
    /// A convex polygon, corners counter-clockwise.
    pub fn planar(corners: &[[f64; 2]]) -> Self {
        let next = corners.iter().cycle().skip(1);
        let across = corners.iter().zip(next).map(|([ax, ay], [bx, by])| [by - ay, ax - bx, 0.0]);
        let faces = across.filter_map(|across| Some((unit(across)?, dot(across, across).sqrt())));
        let (normals, areas) = faces.unzip();
        Self::new(corners.iter().map(|&[x, y]| [x, y, 0.0]).collect(), normals, areas, vec![[0.0, 0.0, 1.0]])
    }

    fn new(vertices: Vec<[f64; 3]>, normals: Vec<[f64; 3]>, areas: Vec<f64>, edges: Vec<[f64; 3]>) -> Self {
        let count = vertices.len() as f64;
        let middle = [0, 1, 2].map(|k| vertices.iter().map(|v| v[k]).sum::<f64>() / count);
        let radius = vertices.iter().map(|&v| length(minus(v, middle))).fold(0.0, f64::max);
        Self { vertices, normals, areas, edges, middle, radius }
    }

    /// The convex pieces of a solid; the triangles of its surface, if it has one. A solid on its way enters another where its
    /// surface meets the other's. The first triangle of a flat face has the area of all.
    pub fn of_solid(solid: &Solid, pose: &PoseInSpace) -> Vec<Self> {
        if let Some(surface) = solid.surface() {
            let mut areas: Vec<f64> = surface.flat_faces().map(|(_, area)| area).collect();
            let triangle = |k: u32| {
                let corners = surface.corners(k).map(|v| pose.transform(v).to_array());
                let normal = pose.rotate(surface.normal(k)).to_array();
                let area = std::mem::take(&mut areas[surface.face(k) as usize]);
                let edge = |i: usize| unit_of(minus(corners[(i + 1) % 3], corners[i]));
                let normals = vec![normal, normal.map(|x| -x)];
                Self::new(corners.to_vec(), normals, vec![area, area], (0..3).filter_map(edge).collect())
            };
            return (0..surface.triangles().len() as u32).map(triangle).collect();
        }
        let pieces = solid.pieces().iter().map(|piece| {
            let edge = |k: usize| {
                let [a, b] = piece.edges()[k].ends;
                unit(pose.rotate(piece.vertices()[b] - piece.vertices()[a]).to_array())
            };
            Self::new(
                piece.vertices().iter().map(|&v| pose.transform(v).to_array()).collect(),
                piece.normals().iter().map(|&n| pose.rotate(n).to_array()).collect(),
                piece.areas().collect(),
                (0..piece.edges().len()).filter_map(edge).collect(),
            )
        });
        pieces.collect()
    }

    /// The box around it.
    fn bounds(&self) -> Aabb {
        let corners = || self.vertices.iter().copied().map(Vector3::from_array);
        let low = corners().fold(Vector3::INFINITY, Vector3::min);
        Aabb::new(low, corners().fold(Vector3::NEG_INFINITY, Vector3::max))
    }

    /// Outward unit normals of the faces, each with its area in square metres; in the plane with its length.
    pub fn faces(&self) -> impl Iterator<Item = ([f64; 3], f64)> + '_ {
        self.normals.iter().copied().zip(self.areas.iter().copied())
    }

    /// Whether another piece is no farther away than this one is wide.
    pub fn is_near(&self, other: &Self) -> bool {
        length(minus(self.middle, other.middle)) <= 3.0 * self.radius + other.radius
    }

    /// Whether this piece, moved along a unit direction as far as one likes, would enter another that stays. They may touch
    /// on the way, and be as deep in each other as the tolerance, metres.
    pub fn is_stopped_by(&self, other: &Self, direction: [f64; 3], tolerance: f64) -> bool {
        if self.is_far_past(other, direction) {
            return false;
        }
        poll(self.edges.len() * other.edges.len() * (self.vertices.len() + other.vertices.len()));
        let parts = |n: [f64; 3]| dot(n, direction) <= SLIDING && self.gap(other, n) >= -tolerance;
        let back = direction.map(|d| -d);
        let sideways = self.edges.iter().chain(&other.edges).filter_map(|&edge| unit(cross(edge, direction)));
        let edges = self.edges.iter().flat_map(|&a| other.edges.iter().filter_map(move |&b| unit(cross(a, b))));
        let both = sideways.chain(edges).flat_map(|n| [n, n.map(|x| -x)]);
        let faces = self.normals.iter().copied().chain(other.normals.iter().map(|n| n.map(|x| -x)));
        ![back].into_iter().chain(both).chain(faces).any(parts)
    }

    /// How far this piece can be moved along a unit direction before it is in another that stays by more than the tolerance,
    /// metres; infinite if it never is.
    ///
    /// The other piece less this one is a convex body whose faces have the normals that [`Self::is_stopped_by`] tries; each face is
    /// moved inward by the tolerance, and the half-line along the direction is cut with it.
    pub fn reach(&self, other: &Self, direction: [f64; 3], tolerance: f64) -> f64 {
        if self.is_far_past(other, direction) {
            return f64::INFINITY;
        }
        poll(self.edges.len() * other.edges.len() * (self.vertices.len() + other.vertices.len()));
        let edges = self.edges.iter().flat_map(|&a| other.edges.iter().filter_map(move |&b| unit(cross(a, b))));
        let faces = self.normals.iter().map(|n| n.map(|x| -x)).chain(other.normals.iter().copied());
        let (mut enters, mut leaves) = (0.0_f64, f64::INFINITY);
        for n in faces.chain(edges.flat_map(|n| [n, n.map(|x| -x)])) {
            let (room, along) = (-self.gap(other, n.map(|x| -x)) - tolerance, dot(n, direction));
            if along.abs() <= SLIDING {
                if room <= 0.0 {
                    return f64::INFINITY;
                }
            } else if along < 0.0 {
                enters = enters.max(room / along);
            } else {
                leaves = leaves.min(room / along);
            }
        }
        if enters < leaves { enters } else { f64::INFINITY }
    }

    /// The same piece elsewhere.
    pub fn moved(&self, by: [f64; 3]) -> Self {
        let plus = |v: &[f64; 3]| [v[0] + by[0], v[1] + by[1], v[2] + by[2]];
        Self { vertices: self.vertices.iter().map(plus).collect(), middle: plus(&self.middle), ..self.clone() }
    }

    /// Outward unit normals of the faces, each with how far its face is along it, metres.
    pub fn planes(&self) -> impl Iterator<Item = ([f64; 3], f64)> + '_ {
        let far = |n: [f64; 3]| self.vertices.iter().map(|&v| dot(n, v)).fold(f64::NEG_INFINITY, f64::max);
        self.normals.iter().map(move |&n| (n, far(n)))
    }

    /// Whether balls around both pieces show that they never meet: the other is behind, or far beside the way.
    fn is_far_past(&self, other: &Self, direction: [f64; 3]) -> bool {
        let (there, apart) = (minus(other.middle, self.middle), self.radius + other.radius);
        let ahead = dot(there, direction);
        ahead < -apart || dot(there, there) - ahead * ahead > apart * apart
    }

    /// The corners in the world, metres.
    pub(crate) fn vertices(&self) -> &[[f64; 3]] {
        &self.vertices
    }

    /// How far the other piece is ahead along a unit vector, metres.
    fn gap(&self, other: &Self, n: [f64; 3]) -> f64 {
        let along = |vertices: &[[f64; 3]], start, pick: fn(f64, f64) -> f64| {
            vertices.iter().map(|&vertex| dot(n, vertex)).fold(start, pick)
        };
        along(&other.vertices, f64::INFINITY, f64::min) - along(&self.vertices, f64::NEG_INFINITY, f64::max)
    }
}

/// A body that may leave along a line: its convex pieces, or the triangles of its surface in a tree of boxes.
#[derive(Debug, Clone)]
pub struct Sweeping {
    pieces: Vec<Piece>,
    /// Around all of them.
    bounds: Aabb,
    /// Of many pieces.
    tree: Option<Bvh>,
}

/// So many pieces of both bodies are compared each with each.
const FEW: usize = 64;

impl Sweeping {
    /// A body of these pieces, or triangles.
    pub fn of(pieces: Vec<Piece>) -> Self {
        let boxes: Vec<Aabb> = pieces.iter().map(Piece::bounds).collect();
        let bounds = boxes.iter().fold(Aabb::new_invalid(), |all, one| all.merged(one));
        let tree = (pieces.len() > FEW).then(|| {
            poll(1000 * pieces.len());
            Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes)
        });
        Self { pieces, bounds, tree }
    }

    /// Whether the body is within a surface of many triangles.
    pub fn is_fine(&self) -> bool {
        self.tree.is_some()
    }

    /// The pieces, or triangles.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// Whether pieces of another body are no farther away than this one is wide; of a fine one its box decides.
    pub fn is_near(&self, other: &Piece) -> bool {
        let Some(tree) = &self.tree else { return self.pieces.iter().any(|piece| piece.is_near(other)) };
        let whole = tree.root_aabb();
        let apart =
            (whole.mins - Vector3::from_array(other.middle)).max(Vector3::from_array(other.middle) - whole.maxs);
        apart.max(Vector3::ZERO).length() <= whole.extents().length() + other.radius
    }

    /// Whether this body, moved along a unit direction as far as one likes, would enter another; see [`Piece::is_stopped_by`].
    pub fn is_stopped_by(&self, other: &Self, direction: [f64; 3], tolerance: f64) -> bool {
        self.any_on_the_way(other, [0.0; 3], direction, &mut |a, b| a.is_stopped_by(b, direction, tolerance))
    }

    /// The same from another place, which is so far from where it is.
    pub fn is_stopped_from(&self, by: [f64; 3], other: &Self, direction: [f64; 3], tolerance: f64) -> bool {
        self.any_on_the_way(other, by, direction, &mut |a, b| a.moved(by).is_stopped_by(b, direction, tolerance))
    }

    /// How far it can be moved; see [`Piece::reach`].
    pub fn reach(&self, other: &Self, direction: [f64; 3], tolerance: f64) -> f64 {
        let mut least = f64::INFINITY;
        self.any_on_the_way(other, [0.0; 3], direction, &mut |a, b| {
            least = least.min(a.reach(b, direction, tolerance));
            least <= 0.0
        });
        least
    }

    /// How far along a unit direction the box around this body, moved so from another place, is for the last time within the tolerance of
    /// the box around another, metres; zero if it never is.
    pub fn passes(&self, by: [f64; 3], other: &Self, direction: [f64; 3], tolerance: f64) -> f64 {
        let (by, more) = (Vector3::from_array(by), Vector3::splat(tolerance));
        let (own, there) = (self.bounds, other.bounds);
        let own = [own.mins + by - more, own.maxs + by + more];
        let when = times_of_meeting(own, [there.mins, there.maxs], direction);
        when.map_or(0.0, |[_, last]| last)
    }

    /// Whether `holds` is true for a pair of pieces of both bodies whose boxes come to touch as this one moves along a direction from
    /// so far from where it is.
    fn any_on_the_way(
        &self,
        other: &Self,
        by: [f64; 3],
        direction: [f64; 3],
        holds: &mut dyn FnMut(&Piece, &Piece) -> bool,
    ) -> bool {
        let by = Vector3::from_array(by);
        let meet = |low: Vector3, high: Vector3, there: [Vector3; 2]| {
            times_of_meeting([low + by, high + by], there, direction).is_some()
        };
        match (&self.tree, &other.tree) {
            (Some(own), Some(others)) => {
                let near = |m: &BvhNode, n: &BvhNode| meet(m.mins(), m.maxs(), [n.mins(), n.maxs()]);
                let mut pairs = own.leaf_pairs(others, near);
                pairs.any(|(a, b)| holds(&self.pieces[a as usize], &other.pieces[b as usize]))
            }
            (Some(own), None) => other.pieces.iter().any(|b| {
                let there = b.bounds();
                let near = |m: &BvhNode| meet(m.mins(), m.maxs(), [there.mins, there.maxs]);
                own.leaves(near).any(|a| holds(&self.pieces[a as usize], b))
            }),
            (None, Some(others)) => self.pieces.iter().any(|a| {
                let here = a.bounds();
                let near = |n: &BvhNode| meet(here.mins, here.maxs, [n.mins(), n.maxs()]);
                others.leaves(near).any(|b| holds(a, &other.pieces[b as usize]))
            }),
            (None, None) => self.pieces.iter().any(|a| other.pieces.iter().any(|b| holds(a, b))),
        }
    }
}

/// From when to when a box that moves along a direction, one metre a unit of time, touches another; None if it never does.
fn times_of_meeting(
    [low, high]: [Vector3; 2],
    [there_low, there_high]: [Vector3; 2],
    direction: [f64; 3],
) -> Option<[f64; 2]> {
    let (mut first, mut last) = (0.0_f64, f64::INFINITY);
    for k in 0..3 {
        let (ahead, past) = (there_low[k] - high[k], there_high[k] - low[k]);
        let along = direction[k];
        if along.abs() <= SLIDING {
            if ahead > 0.0 || past < 0.0 {
                return None;
            }
            continue;
        }
        let (enter, leave) = if along > 0.0 { (ahead / along, past / along) } else { (past / along, ahead / along) };
        first = first.max(enter);
        last = last.min(leave);
    }
    (first <= last).then_some([first, last])
}

/// The unit vector along another one, however short.
fn unit_of(vector: [f64; 3]) -> Option<[f64; 3]> {
    let length = length(vector);
    (length > 0.0).then(|| vector.map(|x| x / length))
}

#[cfg(test)]
mod tests {
    use super::{Piece, cross, dot, unit};

    fn rectangle(x: [f64; 2], y: [f64; 2]) -> Piece {
        Piece::planar(&[[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]])
    }

    fn brick(low: [f64; 3], high: [f64; 3]) -> Piece {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let corner = |mask: usize| [0, 1, 2].map(|k| if mask >> k & 1 == 1 { high[k] } else { low[k] });
        let normals = axes.iter().flat_map(|&n| [n, n.map(|x: f64| -x)]).collect();
        Piece::new((0..8).map(corner).collect(), normals, vec![1.0; 6], axes.to_vec())
    }

    #[test]
    fn a_square_slides_along_what_it_touches_and_not_through_it() {
        let (block, right) = (rectangle([0.0, 1.0], [0.0, 1.0]), rectangle([1.0, 2.0], [0.0, 1.0]));
        for (direction, stopped) in
            [([1.0, 0.0, 0.0], true), ([-1.0, 0.0, 0.0], false), ([0.0, 1.0, 0.0], false), ([0.6, 0.8, 0.0], true)]
        {
            assert_eq!(block.is_stopped_by(&right, direction, 1e-6), stopped, "{direction:?}");
        }
    }

    #[test]
    fn what_is_far_ahead_stops_and_what_is_behind_does_not() {
        let block = rectangle([0.0, 1.0], [0.0, 1.0]);
        let (ahead, behind) = (rectangle([0.9, 3.0], [50.0, 51.0]), rectangle([0.2, 0.4], [-9.0, -3.0]));
        let up = [0.0, 1.0, 0.0];
        assert!(block.is_stopped_by(&ahead, up, 1e-6) && !block.is_stopped_by(&behind, up, 1e-6));
        // A corner that is behind, not opposite any face square to the way.
        let diamond = Piece::planar(&[[0.5, -2.0], [1.0, -1.5], [0.5, -1.0], [0.0, -1.5]]);
        assert!(!block.is_stopped_by(&diamond, [0.3_f64.sin(), 0.3_f64.cos(), 0.0], 1e-6));
    }

    #[test]
    fn the_same_as_many_small_steps_find() {
        use super::super::Vector;
        use parry2d_f64::{math::Pose, query::distance, shape::ConvexPolygon};
        use rand::{Rng, SeedableRng};

        let mut random = rand_pcg::Pcg64::seed_from_u64(5);
        let mut polygon = |x: f64| {
            let corners = random.random_range(3..7);
            let mut angles: Vec<f64> = (0..corners).map(|_| random.random_range(0.0..std::f64::consts::TAU)).collect();
            angles.sort_by(f64::total_cmp);
            let centre = [x + random.random_range(-0.5..0.5), random.random_range(-1.5..1.5)];
            let corner = |angle: &f64| [centre[0] + angle.cos(), centre[1] + angle.sin()];
            (angles.iter().map(corner).collect::<Vec<_>>(), random.random_range(0.0..std::f64::consts::TAU))
        };
        let hull = |corners: &[[f64; 2]]| {
            ConvexPolygon::from_convex_polyline(corners.iter().map(|&corner| Vector::from_array(corner)).collect())
        };
        let mut seen = [0, 0];
        for _ in 0..2000 {
            let ((a, angle), (b, _)) = (polygon(0.0), polygon(1.2));
            let (Some(shape_a), Some(shape_b)) = (hull(&a), hull(&b)) else { continue };
            let meets = |t: f64| {
                let moved = Pose::translation(t * angle.cos(), t * angle.sin());
                distance(&moved, &shape_a, &Pose::IDENTITY, &shape_b).unwrap().distance <= 0.0
            };
            if meets(0.0) {
                continue;
            }
            let direction = [angle.cos(), angle.sin(), 0.0];
            let (a, b) = (Piece::planar(&a), Piece::planar(&b));
            let met = (1..1000).any(|step| meets(0.005 * f64::from(step)));
            // What is only grazed falls between the steps.
            let (surely, perhaps) = (a.is_stopped_by(&b, direction, 0.03), a.is_stopped_by(&b, direction, 0.0));
            assert!(!surely || met, "{a:?} {b:?} {direction:?}");
            assert!(!met || perhaps, "{a:?} {b:?} {direction:?}");
            seen[usize::from(met)] += 1;
        }
        assert!(seen[0] > 200 && seen[1] > 100, "{seen:?}");
    }

    #[test]
    fn how_far_it_goes_is_where_a_stop_begins() {
        let (block, stop) = (brick([0.0; 3], [1.0; 3]), brick([0.5, -1.0, 3.0], [2.0, 5.0, 4.0]));
        assert_eq!(block.reach(&stop, [0.0, 0.0, 1.0], 0.0), 2.0);
        assert!((block.reach(&stop, [0.0, 0.0, 1.0], 0.01) - 2.01).abs() < 1e-12);
        assert_eq!(block.reach(&stop, [0.0, 0.0, -1.0], 0.0), f64::INFINITY);
        assert_eq!(block.reach(&stop, [-1.0, 0.0, 0.0], 0.0), f64::INFINITY);
        // Sixty degrees from upright it goes twice as far; a ramp is met where its edge is.
        let slanted = unit([0.75_f64.sqrt(), 0.0, 0.5]).unwrap();
        assert!((block.reach(&brick([-9.0, -9.0, 3.0], [99.0, 9.0, 4.0]), slanted, 0.0) - 4.0).abs() < 1e-12);
        assert_eq!(block.reach(&brick([1.0, 0.0, 0.0], [2.0, 1.0, 1.0]), [0.0, 0.0, 1.0], 1e-9), f64::INFINITY);
        assert_eq!(block.reach(&brick([1.0, 0.0, 0.0], [2.0, 1.0, 1.0]), [1.0, 0.0, 0.0], 0.0), 0.0);
        assert!(!block.moved([2.0, 0.0, 0.0]).is_stopped_by(&stop, [0.0, 0.0, 1.0], 1e-9));
    }

    #[test]
    fn in_space_an_edge_past_an_edge_is_seen() {
        // Two long bricks, crossed and one above the other, both turned by 45 degrees about their length.
        let along_x = brick([-5.0, -0.5, -0.5], [5.0, 0.5, 0.5]);
        let along_y = brick([-0.5, -5.0, 1.0], [0.5, 5.0, 2.0]);
        assert!(along_x.is_stopped_by(&along_y, [0.0, 0.0, 1.0], 1e-6));
        assert!(!along_x.is_stopped_by(&along_y, [1.0, 0.0, 0.0], 1e-6));
        assert!(!along_x.is_stopped_by(&along_y, [0.0, 0.0, -1.0], 1e-6));
        let tilted = unit([1.0, 0.0, 0.05]).unwrap();
        assert!(!brick([-5.0, 6.0, -0.5], [5.0, 7.0, 0.5]).is_stopped_by(&along_y, tilted, 1e-6));
        assert!(dot(cross(tilted, [0.0, 1.0, 0.0]), tilted).abs() < 1e-15);
    }
}
