//! What is asked of a problem: how bodies begin to move, and a basis of the forces that hold them.

use super::{
    layers::Layers,
    method::{Found, Interior},
    problem::{Cone, Gauss},
    scaled::Scaled,
};

/// What is asked of a problem.
enum Question<'a> {
    /// (1).
    Motion,
    /// The same, begun further away.
    MotionFromOnes,
    /// Forces of these costs, from some that hold the bodies.
    LeastCost(&'a [f64], Vec<f64>),
    GreatestPush {
        within: f64,
    },
    LeastEnergy,
}

impl Gauss {
    /// Solves it from nothing; with a push for the factor under which it is nearest to rest.
    ///
    /// # Panics
    /// If bodies have neither 3 nor 6 unknowns.
    pub fn solve(&self) -> Found {
        self.solve_while(&mut || true).expect("nobody stops it")
    }

    /// [`Self::solve`] as long as `go_on`, asked before every iteration, says so; None if stopped.
    ///
    /// # Panics
    /// If bodies have neither 3 nor 6 unknowns.
    pub fn solve_while(&self, go_on: &mut dyn FnMut() -> bool) -> Option<Found> {
        self.by_size(Question::Motion, go_on)
    }

    /// [`Self::solve`] from forces and accelerations of one: a few iterations more, and fewer digits lost where masses differ by 1e10.
    ///
    /// # Panics
    /// If bodies have neither 3 nor 6 unknowns.
    pub fn solve_from_ones(&self) -> Found {
        self.by_size(Question::MotionFromOnes, &mut || true).expect("nobody stops it")
    }

    /// Forces that hold the bodies under the largest factor of the push, and the motion in which more of it moves them. Does not
    /// converge where there are no such forces, or no largest factor; the caller judges the answer. None if stopped.
    ///
    /// # Panics
    /// If bodies have neither 3 nor 6 unknowns.
    pub fn greatest_while(&self, go_on: &mut dyn FnMut() -> bool) -> Option<Found> {
        self.greatest_within(0.0, go_on)
    }

    /// The same, at an end as soon as the factors that the forces and the motion give differ by no more than `within`.
    ///
    /// # Panics
    /// If bodies have neither 3 nor 6 unknowns.
    pub fn greatest_within(&self, within: f64, go_on: &mut dyn FnMut() -> bool) -> Option<Found> {
        self.by_size(Question::GreatestPush { within }, go_on)
    }

    /// The displacement in which the loads do most work, with the offset that is given, and the forces after it; in place of
    /// accelerations. None if stopped.
    ///
    /// # Panics
    /// If bodies have neither 3 nor 6 unknowns.
    pub fn least_energy_while(&self, go_on: &mut dyn FnMut() -> bool) -> Option<Found> {
        self.by_size(Question::LeastEnergy, go_on)
    }

    /// A basis of the forces that hold the bodies, from such forces, all of them positive: those that are positive where a
    /// cost is least that is close to one for each edge, but less for the last edge of the points that `straight` names. At
    /// most as many as there are rows; none where round cones are. None if the method does not come to an end.
    ///
    /// # Panics
    /// If bodies have neither 3 nor 6 unknowns.
    pub fn basis(&self, forces: &[f64], straight: impl Fn(usize) -> bool) -> Option<Vec<usize>> {
        let mut cost = Vec::with_capacity(forces.len());
        for (index, point) in self.points.iter().enumerate() {
            let Cone::Edges(edges) = &point.cone else { return None };
            for edge in 0..edges.len() {
                let factor = if edge + 1 == edges.len() && straight(index) { STRAIGHT } else { 1.0 };
                cost.push(factor * (1.0 + (cost.len() as f64 * GOLDEN).fract()));
            }
        }
        let found = self.by_size(Question::LeastCost(forces, cost), &mut || true)?;
        let bearing = || (0..found.bearing.len()).filter(|&j| found.bearing[j]).collect();
        (found.gap <= TOLD_APART).then(bearing)
    }

    /// The forces of least norm that balance the loads: of all f in the cones with `J' f = -F` those whose layers bear the least
    /// `sum W' Q W`. Masses do not matter, but that they set the scale. The accelerations are those of the bodies and then the
    /// layers' `Q W`, all to an unknown factor.
    ///
    /// # Panics
    /// If bodies have neither 3 nor 6 unknowns.
    pub fn least_norm(&self, layers: &Layers) -> Found {
        let bodies = self.load.len() / self.size;
        let found = match self.size {
            3 => Interior::of_least_norm(Scaled::<3, 2, 3>::with_layers(self, layers), bodies).solve(&mut || true),
            6 => Interior::of_least_norm(Scaled::<6, 3, 3>::with_layers(self, layers), bodies).solve(&mut || true),
            size => panic!("a body has 3 or 6 unknowns, not {size}"),
        };
        found.expect("nobody stops it")
    }

    fn by_size(&self, question: Question<'_>, go_on: &mut dyn FnMut() -> bool) -> Option<Found> {
        match self.size {
            3 => self.run::<3, 2>(question, go_on),
            6 => self.run::<6, 3>(question, go_on),
            size => panic!("a body has 3 or 6 unknowns, not {size}"),
        }
    }

    fn run<const B: usize, const D: usize>(
        &self,
        question: Question<'_>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Option<Found> {
        let scaled = Scaled::<B, D, 2>::new(self);
        match question {
            Question::Motion => Interior::new(scaled),
            Question::MotionFromOnes => Interior::from_ones(scaled),
            Question::LeastCost(forces, cost) => Interior::of_least_cost(scaled, forces, cost),
            Question::GreatestPush { within } => Interior::of_greatest_push(scaled, within),
            Question::LeastEnergy => Interior::of_least_energy(scaled),
        }
        .solve(go_on)
    }
}

/// Gap from which on forces that are positive in the end are told from those that are not.
const TOLD_APART: f64 = 1e-6;

/// Multiples of the golden ratio's fraction are spread evenly and never repeat: no two sums of such costs are the same.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Cost of a force straight across a joint, so that what stands by straight pressure is held by it.
const STRAIGHT: f64 = 0.25;
