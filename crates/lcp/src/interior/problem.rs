//! What is solved: bodies with masses and loads, and contact points between them.

/// Gauss's principle for bodies of 3 (in the plane) or 6 unknowns.
#[derive(Debug, Clone, Default)]
pub struct Gauss {
    /// Unknowns of one body.
    pub size: usize,
    /// Diagonal of `M^-1`, body after body: 1/kg, 1/(kg m^2).
    pub inverse_mass: Vec<f64>,
    /// `F`, body after body: N, N m.
    pub load: Vec<f64>,
    /// A load that acts times a factor t, beside [`Self::load`]: N, N m; none if empty. See [`Gauss::greatest_while`].
    pub push: Vec<f64>,
    /// Where bodies touch.
    pub points: Vec<Point>,
    /// By how much each unknown of the cones may be negative, point after point, in the unit of J a; nowhere if empty: (1) is
    /// over `J a + offset` then.
    pub offset: Vec<f64>,
}

/// A contact point: how two bodies move relative to one another there, and which forces it can bear.
#[derive(Debug, Clone)]
pub struct Point {
    /// The bodies that move of the two.
    pub bodies: [Option<usize>; 2],
    /// For each of the two, three rows of as many entries as a body has unknowns: the relative motion along three
    /// directions is the sum of the rows times the bodies' accelerations, and a force with such components acts on the
    /// bodies by the columns. 1 and m.
    pub jacobian: [[[f64; 6]; 3]; 2],
    /// The forces that it can bear, in components along the three directions.
    pub cone: Cone,
}

/// The forces that a contact point can bear.
#[derive(Debug, Clone)]
pub enum Cone {
    /// Sums of these with factors that are not negative.
    Edges(Vec<[f64; 3]>),
    /// Coulomb's: `hypot(f_1, f_2) <= friction f_0`; friction is positive.
    Round {
        /// mu.
        friction: f64,
    },
}

impl Cone {
    /// Number of unknown forces: a magnitude for each edge, or three components.
    pub fn unknowns(&self) -> usize {
        match self {
            Self::Edges(edges) => edges.len(),
            Self::Round { .. } => 3,
        }
    }

    /// The force along the three directions that some unknowns are.
    pub fn force(&self, unknowns: &[f64]) -> [f64; 3] {
        match self {
            Self::Round { .. } => [unknowns[0], unknowns[1], unknowns[2]],
            Self::Edges(edges) => [0, 1, 2].map(|k| edges.iter().zip(unknowns).map(|(edge, f)| edge[k] * f).sum()),
        }
    }
}
