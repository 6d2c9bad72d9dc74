//! A case of the search: which laws are settled, and what is known of the rest.

use super::laws::Laws;

/// One of the two ways in which a face can slide: along its tangent or against it.
pub(super) type Way = usize;

/// A choice between two of which every solution obeys one.
#[derive(Debug, Clone, Copy)]
pub(super) enum Choice {
    /// A point has no force, or does not part.
    Parting(usize),
    /// A face slides this way, with its forces on the edge of the cone that resists; or it does not slide this way.
    Sliding(usize, Way),
}

/// What holds in a node and in all below it.
#[derive(Debug, Clone)]
pub(super) struct Branch {
    /// Most length of the accelerations.
    pub radius: f64,
    /// Of each point.
    pub no_force: Vec<bool>,
    pub no_parting: Vec<bool>,
    /// Of each face: it does not slide this way.
    pub no_sliding: Vec<[bool; 2]>,
    /// Of each face: no force on the edge that pushes this way.
    pub no_edge: Vec<[bool; 2]>,
    /// Of each face: what it bears at least, along its normal, where it slides this way.
    pub least: Vec<[f64; 2]>,
    /// Of each chain and way: what a face, the fastest first, and all that are faster bear at least together, where it slides.
    pub sums: Vec<[Vec<f64>; 2]>,
    /// Of each block the least and the greatest virial of the forces on it, and the radius with which these were found; none before
    /// they are looked for.
    pub virials: Vec<[f64; 2]>,
    pub virial_radius: f64,
    /// Where the next program begins: its basis.
    pub basis: Vec<usize>,
}

impl Branch {
    /// Nothing is settled.
    pub fn root(laws: &Laws) -> Self {
        let (points, faces) = (laws.points.len(), laws.faces.len());
        Self {
            radius: 1.0,
            no_force: vec![false; points],
            no_parting: vec![false; points],
            no_sliding: vec![[false; 2]; faces],
            no_edge: vec![[false; 2]; faces],
            least: vec![[0.0; 2]; faces],
            sums: Vec::new(),
            virials: Vec::new(),
            virial_radius: f64::INFINITY,
            basis: Vec::new(),
        }
    }

    /// The first of a choice: the point parts, the face slides.
    pub fn first(mut self, choice: Choice) -> Self {
        match choice {
            Choice::Parting(point) => self.no_force[point] = true,
            Choice::Sliding(face, way) => {
                self.no_edge[face][way] = true;
                self.no_sliding[face][1 - way] = true;
            }
        }
        self
    }

    /// The second of a choice: the point stays closed, the face does not slide this way.
    pub fn second(mut self, choice: Choice) -> Self {
        match choice {
            Choice::Parting(point) => self.no_parting[point] = true,
            Choice::Sliding(face, way) => self.no_sliding[face][way] = true,
        }
        self
    }
}
