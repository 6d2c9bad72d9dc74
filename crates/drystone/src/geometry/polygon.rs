//! Convex polygons, checked once, in the frame of their centre of mass.

use super::{Face, OWN_AXES, Pose, Shape, Vector, Vector3};
use parry2d_f64::mass_properties::{MassProperties, details};
use thiserror::Error;

/// A vertex this close to the chord of its neighbours, as a share of the polygon's largest
/// extent, is on a straight line and is merged away; further inside, it is a dent. The bound keeps
/// the moved outline a thousand times below the default contact tolerance of a compact block, yet
/// far above the rounding of coordinates.
const STRAIGHT: f64 = 1e-9;

/// Two vertices closer than this share of the largest extent count as one given twice.
const COINCIDENT: f64 = 1e-9;

/// A polygon narrower than this share of its largest extent has no area to speak of: its faces
/// could not be told apart within [`STRAIGHT`].
const FLAT: f64 = 1e-8;

/// What is wrong with a list of vertices, and what to do about it.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ShapeFault {
    /// Fewer than three vertices.
    #[error("{count} vertices do not make a polygon: give at least three")]
    TooFewVertices {
        /// Vertices given.
        count: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} is not finite: give finite coordinates in metres")]
    NotFinite {
        /// Index of the vertex.
        vertex: usize,
    },
    /// Two vertices in the same place.
    #[error("vertices {first} and {second} coincide: give every corner once")]
    RepeatedVertex {
        /// Index of the first of them.
        first: usize,
        /// Index of the other.
        second: usize,
    },
    /// All vertices lie on a line.
    #[error("the polygon has zero area: give corners that are not all on one line, in order round the block")]
    ZeroArea,
    /// A corner points inwards.
    #[error("the polygon is not convex at vertex {vertex}: split it into convex blocks")]
    NotConvex {
        /// Index of the vertex, as given.
        vertex: usize,
    },
    /// The outline winds round more than once.
    #[error("the outline crosses itself: give the corners in order round the block")]
    SelfCrossing,
}

/// A convex polygon whose centre of mass is the origin.
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    vertices: Vec<Vector>,
    centroid: Vector,
    area: f64,
    second_moment: f64,
    width: f64,
    radius: f64,
}

impl Polygon {
    /// The rectangle with the given width and height, in metres.
    ///
    /// Vertex 0 is the lower left corner, and face k runs from vertex k to the next one: face 0 is
    /// the bottom, 1 the right side, 2 the top and 3 the left side. Sizes must be finite and
    /// positive (the scene checks them).
    pub fn rectangle(size: [f64; 2]) -> Self {
        let (x, y) = (0.5 * size[0], 0.5 * size[1]);
        let corners = [[-x, -y], [x, -y], [x, y], [-x, y]];
        Self::measured(corners.map(Vector::from_array).to_vec())
    }

    /// A polygon from its corners in metres, in order round it either way, and the centroid they had.
    ///
    /// A last corner that repeats the first closes the ring and is dropped. Corners on a straight line are merged. Corners whose centroid is the origin (to rounding)
    /// are kept bit for bit, so that a stored polygon comes back as it was.
    pub fn from_vertices(corners: &[[f64; 2]]) -> Result<(Self, [f64; 2]), ShapeFault> {
        let (convex, extent) = convex_corners(corners)?;
        let (local, centroid) = centred(convex, extent);
        Ok((Self::measured(local).with_area(extent)?, centroid.to_array()))
    }

    /// The same with its origin at a centre of mass, metres, which may be anywhere. About the origin the corners are kept bit
    /// for bit.
    pub fn about(corners: &[[f64; 2]], center_of_mass: [f64; 2]) -> Result<Self, ShapeFault> {
        let (convex, extent) = convex_corners(corners)?;
        let center = Vector::from_array(center_of_mass);
        let local: Vec<Vector> = convex.into_iter().map(|v| v - center).collect();
        // Measured about the centroid, so that nothing is lost however far away it is.
        let (near, centroid) = centred(local.clone(), extent);
        let radius = furthest(&local);
        Ok(Self { vertices: local, centroid, radius, ..Self::measured(near).with_area(extent)? })
    }

    fn with_area(self, extent: f64) -> Result<Self, ShapeFault> {
        if self.width <= FLAT * extent { Err(ShapeFault::ZeroArea) } else { Ok(self) }
    }

    fn measured(vertices: Vec<Vector>) -> Self {
        let (area, _) = details::convex_polygon_area_and_center_of_mass(&vertices);
        let second_moment = MassProperties::from_convex_polygon(1.0, &vertices).principal_inertia();
        let width = least_width(&vertices);
        let radius = furthest(&vertices);
        Self { vertices, centroid: Vector::ZERO, area, second_moment, width, radius }
    }

    /// The corners relative to the centre of mass, metres, counter-clockwise.
    pub fn vertices(&self) -> &[Vector] {
        &self.vertices
    }

    /// Area in square metres.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Polar second moment of area about the centroid, m^4.
    pub fn second_moment(&self) -> f64 {
        self.second_moment
    }

    /// Integrals of x^2, y^2 and x y over the area about the centroid, m^4.
    pub(crate) fn second_moments(&self) -> [f64; 3] {
        let about: Vec<Vector> = self.vertices.iter().map(|v| *v - self.centroid).collect();
        let of_side = |[xx, yy, xy]: [f64; 3], (a, b): (Vector, Vector)| {
            let (share, sum) = (a.perp_dot(b) / 24.0, a + b);
            let square = |a: f64, b: f64, sum: f64| share * (a * a + b * b + sum * sum);
            let mixed = share * (a.x * a.y + b.x * b.y + sum.x * sum.y);
            [xx + square(a.x, b.x, sum.x), yy + square(a.y, b.y, sum.y), xy + mixed]
        };
        sides(&about).fold([0.0; 3], of_side)
    }
}

impl Shape for Polygon {
    type Vector = [f64; 2];
    type Pose = Pose;

    fn measure(&self) -> f64 {
        self.area
    }

    fn moments(&self) -> Vec<f64> {
        vec![self.second_moment]
    }

    fn axes(&self) -> [Vector3; 3] {
        OWN_AXES
    }

    fn radius(&self) -> f64 {
        self.radius
    }

    fn width(&self) -> f64 {
        self.width
    }

    fn centroid(&self) -> [f64; 2] {
        self.centroid.to_array()
    }

    fn place(pose: &Pose) -> [f64; 2] {
        pose.position
    }

    fn turned(pose: &Pose, vector: [f64; 2]) -> [f64; 2] {
        pose.rotate(vector.into()).to_array()
    }

    fn seen_from(pose: &Pose, point: [f64; 2]) -> [f64; 2] {
        let back = Pose { angle: -pose.angle, ..*pose };
        back.rotate(Vector::from_array(point) - Vector::from_array(pose.position)).to_array()
    }

    fn faces(&self) -> Vec<Face<[f64; 2]>> {
        let face = |(a, b): (Vector, Vector)| {
            let along = b - a;
            let normal = -along.normalize_or_zero().perp();
            Face { normal: normal.to_array(), area: along.length(), middle: (0.5 * (a + b)).to_array() }
        };
        sides(&self.vertices).map(face).collect()
    }

    fn placed(pose: Pose, position: [f64; 2]) -> Pose {
        Pose { position, ..pose }
    }

    fn bounds(&self, pose: &Pose) -> [[f64; 2]; 2] {
        let (place, turn) = (Vector::from_array(pose.position), pose.turn());
        let corners = || self.vertices.iter().map(|&v| turn(v) + place);
        let least = corners().fold(Vector::INFINITY, Vector::min);
        let most = corners().fold(Vector::NEG_INFINITY, Vector::max);
        [least.to_array(), most.to_array()]
    }
}

/// The corners counter-clockwise, each once and none on a straight line, and the larger side of the bounding box; refuses
/// what is no convex polygon.
fn convex_corners(corners: &[[f64; 2]]) -> Result<(Vec<Vector>, f64), ShapeFault> {
    let mut given: Vec<Vector> = corners.iter().copied().map(Vector::from_array).collect();
    if given.len() > 3 && given.first() == given.last() {
        given.pop();
    }
    let (extent, twice_area) = measured_corners(&given)?;
    if twice_area > 0.0 {
        return Ok((merge_straight(&given, extent)?, extent));
    }
    given[1..].reverse();
    let convex = merge_straight(&given, extent).map_err(|fault| match fault {
        ShapeFault::NotConvex { vertex } => ShapeFault::NotConvex { vertex: (given.len() - vertex) % given.len() },
        other => other,
    })?;
    Ok((convex, extent))
}

/// The larger side of the bounding box, and twice the area: negative of what runs clockwise.
fn measured_corners(corners: &[Vector]) -> Result<(f64, f64), ShapeFault> {
    if corners.len() < 3 {
        return Err(ShapeFault::TooFewVertices { count: corners.len() });
    }
    if let Some(vertex) = corners.iter().position(|v| !v.is_finite()) {
        return Err(ShapeFault::NotFinite { vertex });
    }
    let low = corners.iter().fold(corners[0], |low, v| low.min(*v));
    let high = corners.iter().fold(corners[0], |high, v| high.max(*v));
    let extent = (high - low).max_element();
    for (second, v) in corners.iter().enumerate() {
        let close = |u: &Vector| u.distance(*v) <= COINCIDENT * extent;
        if let Some(first) = corners[..second].iter().position(close) {
            return Err(ShapeFault::RepeatedVertex { first, second });
        }
    }
    let twice_area: f64 = sides(corners).map(|(a, b)| (a - corners[0]).perp_dot(b - corners[0])).sum();
    if twice_area.abs() <= FLAT * extent * extent { Err(ShapeFault::ZeroArea) } else { Ok((extent, twice_area)) }
}

/// Drops corners on a straight line, refuses dents and outlines that wind round twice.
fn merge_straight(corners: &[Vector], extent: f64) -> Result<Vec<Vector>, ShapeFault> {
    let mut kept: Vec<usize> = (0..corners.len()).collect();
    let mut k = 0;
    while k < kept.len() && kept.len() > 3 {
        let [a, v, b] = around(corners, &kept, k);
        let chord = b - a;
        let outwards = (v - a).perp_dot(chord);
        if outwards.abs() <= STRAIGHT * extent * chord.length() && (v - a).dot(b - v) > 0.0 {
            kept.remove(k);
        } else {
            k += 1;
        }
    }
    let mut turning = 0.0;
    for k in 0..kept.len() {
        let [a, v, b] = around(corners, &kept, k);
        let turn = (v - a).angle_to(b - v);
        if turn <= 0.0 {
            return Err(ShapeFault::NotConvex { vertex: kept[k] });
        }
        turning += turn;
    }
    // A simple convex outline turns by one full turn; a star by two or more.
    if turning > 1.5 * std::f64::consts::TAU {
        return Err(ShapeFault::SelfCrossing);
    }
    Ok(kept.into_iter().map(|k| corners[k]).collect())
}

/// The k-th kept corner between its two neighbours.
fn around(corners: &[Vector], kept: &[usize], k: usize) -> [Vector; 3] {
    let n = kept.len();
    [(k + n - 1) % n, k, (k + 1) % n].map(|i| corners[kept[i]])
}

/// Shifts the centroid to the origin. The shift is found relative to the first corner, so that it
/// is as exact far from the world's origin as near it.
fn centred(corners: Vec<Vector>, extent: f64) -> (Vec<Vector>, Vector) {
    let (_, centroid) = details::convex_polygon_area_and_center_of_mass(&corners);
    if centroid.length() <= 1e-14 * extent {
        return (corners, Vector::ZERO);
    }
    let first = corners[0];
    let near: Vec<Vector> = corners.iter().map(|v| *v - first).collect();
    let (_, offset) = details::convex_polygon_area_and_center_of_mass(&near);
    let local = near.into_iter().map(|v| v - offset).collect();
    (local, first + offset)
}

/// The least distance from a face's line to the furthest corner: the width of a convex polygon is
/// always attained square to one of its faces.
fn least_width(vertices: &[Vector]) -> f64 {
    let across = |(a, b): (Vector, Vector)| {
        let inwards = (b - a).normalize_or_zero().perp();
        vertices.iter().map(|v| inwards.dot(*v - a)).fold(0.0, f64::max)
    };
    sides(vertices).map(across).fold(f64::INFINITY, f64::min)
}

/// The greatest distance of a corner from the origin.
fn furthest(vertices: &[Vector]) -> f64 {
    vertices.iter().fold(0.0, |radius, v| v.length().max(radius))
}

/// Every face as its two ends.
fn sides(vertices: &[Vector]) -> impl Iterator<Item = (Vector, Vector)> + '_ {
    let next = vertices.iter().cycle().skip(1);
    vertices.iter().copied().zip(next.copied())
}
