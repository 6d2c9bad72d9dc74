//! A convex region of the plane about the origin, by points of its boundary with the lines that touch it there.

/// A point of the boundary and its line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Support {
    /// The point's direction, of length one.
    toward: [f64; 2],
    pub point: [f64; 2],
    /// Outward, of length one; zero without a line.
    pub normal: [f64; 2],
}

/// Farther than this is endless.
const FAR: f64 = 1e6;

fn dot([a, b]: [f64; 2], [c, d]: [f64; 2]) -> f64 {
    a * c + b * d
}

fn across([a, b]: [f64; 2], [c, d]: [f64; 2]) -> f64 {
    a * d - b * c
}

impl Support {
    /// The point that far towards a direction, on a line with this normal of whatever length.
    pub fn new(toward: [f64; 2], far: f64, normal: [f64; 2]) -> Self {
        let size = normal[0].hypot(normal[1]);
        let limited = far < FAR && size > 0.0;
        let normal = if limited { normal.map(|x| x / size) } else { [0.0; 2] };
        Self { toward, point: toward.map(|x| far.min(FAR) * x), normal }
    }

    /// The direction in which the point is.
    pub fn toward(&self) -> [f64; 2] {
        self.toward
    }

    /// Of the line from the origin; infinite without one.
    pub fn distance(&self) -> f64 {
        if self.normal == [0.0; 2] { f64::INFINITY } else { dot(self.normal, self.point).max(0.0) }
    }
}

/// Points of the boundary, counter-clockwise.
#[derive(Debug, Default)]
pub(super) struct Region {
    supports: Vec<Support>,
}

impl Region {
    pub fn new() -> Self {
        Self::default()
    }

    pub fn add(&mut self, support: Support) {
        let angle = |s: &Support| s.toward[1].atan2(s.toward[0]);
        let place = self.supports.partition_point(|other| angle(other) < angle(&support));
        self.supports.insert(place, support);
    }

    /// The boundary's points.
    pub fn boundary(&self) -> Vec<[f64; 2]> {
        self.supports.iter().map(|support| support.point).collect()
    }

    /// The direction in which the lines leave most room beyond the hull of the points, if that is more than this.
    pub fn worst(&self, tolerance: f64) -> Option<[f64; 2]> {
        let next = self.supports.iter().cycle().skip(1);
        let rooms = self.supports.iter().zip(next).filter_map(|(a, b)| room(a, b));
        let (most, corner) = rooms.max_by(|a, b| a.0.total_cmp(&b.0))?;
        (most > tolerance).then(|| {
            let size = corner[0].hypot(corner[1]);
            corner.map(|x| x / size)
        })
    }
}

/// How far the corner of two neighbours' lines is beyond the line through their points, and where that corner is. Where one has no
/// line, or they do not meet in front, what is half-way.
fn room(a: &Support, b: &Support) -> Option<(f64, [f64; 2])> {
    let chord = [b.point[0] - a.point[0], b.point[1] - a.point[1]];
    let size = chord[0].hypot(chord[1]);
    if size == 0.0 {
        return None;
    }
    let corner = corner(a, b)?;
    let from = [corner[0] - a.point[0], corner[1] - a.point[1]];
    Some((-across(chord, from) / size, corner))
}

fn corner(a: &Support, b: &Support) -> Option<[f64; 2]> {
    // Between the two directions, or nothing is left to find.
    const BETWEEN: f64 = 1e-9;
    let inside = |c: [f64; 2]| across(a.toward, c) > BETWEEN && across(c, b.toward) > BETWEEN;
    let denominator = across(a.normal, b.normal);
    if a.normal != [0.0; 2] && b.normal != [0.0; 2] && denominator > BETWEEN {
        let (c, d) = (dot(a.normal, a.point), dot(b.normal, b.point));
        let met =
            [(c * b.normal[1] - d * a.normal[1]) / denominator, (d * a.normal[0] - c * b.normal[0]) / denominator];
        let size = met[0].hypot(met[1]);
        return (size > 0.0 && inside(met.map(|x| x / size))).then_some(met);
    }
    if a.normal != [0.0; 2] && b.normal != [0.0; 2] {
        return None; // the same line
    }
    let half = [a.toward[0] + b.toward[0], a.toward[1] + b.toward[1]];
    let size = half[0].hypot(half[1]);
    let half = half.map(|x| x / size);
    // An end without a line is looked for until it is narrow.
    const NARROW: f64 = 0.02;
    (inside(half) && across(a.toward, b.toward) > NARROW).then(|| half.map(|x| x * FAR))
}
