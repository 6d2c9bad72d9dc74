//! Which numbers a scene and a motion may hold.
//!
//! Lengths, times, speeds and gravity lie within 1e-12 to 1e12 of their SI units, masses within 1e-24 to 1e24 kg. That is far
//! beyond what anybody stacks, in whatever units, and far within what floats hold (1e-308 to 1e308): every moment of inertia (mass
//! length^2) lies within 1e-48 and 1e48 kg m^2, every weight within 1e-36 and 1e36 N, every entry of `A = G' M^-1 G` (1/mass,
//! length^2/inertia) below 1e72 1/kg, and products of two of these and sums of a million of them within 1e-150 and 1e150,
//! so that their squares and inverses are still numbers. What lies outside is refused where it enters, by the name of the block.

use std::fmt;

/// The values that a quantity may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The least one.
    pub least: f64,
    /// The greatest one.
    pub most: f64,
    /// The unit, after a space, or nothing.
    pub unit: &'static str,
    /// What to do about a value outside.
    pub advice: &'static str,
}

const UNITS: &str = "measure the scene in other units";

/// The sides of a box, the width of any block, and the distance of its corners from its centre, metres.
pub const LENGTH: Bounds = Bounds { least: 1e-12, most: 1e12, unit: " m", advice: UNITS };

/// Coordinates of points and centres of mass, metres, either way. At 1e12 m neighbouring floats are 1e-4 m apart.
pub const COORDINATE: Bounds = Bounds { least: -1e12, most: 1e12, unit: " m", advice: UNITS };

/// Distance of a block's furthest corner from its centre of mass, in widths. A default contact tolerance is 1e-6 widths, and corners are
/// known to 1e-16 of that distance: they must not come near one another.
pub const SLENDERNESS: Bounds = Bounds { least: 0.0, most: 1e8, unit: " widths", advice: "give it more width" };

/// Mass of a block that moves, kg.
pub const MASS: Bounds = Bounds { least: 1e-24, most: 1e24, unit: " kg", advice: UNITS };

/// Moment of inertia of a block that moves, kg m^2: that of a mass at a length.
pub const INERTIA: Bounds = Bounds { least: 1e-48, most: 1e48, unit: " kg m^2", advice: UNITS };

/// Size of gravity, where there is any, m/s^2.
pub const GRAVITY: Bounds = Bounds { least: 1e-12, most: 1e12, unit: " m/s^2", advice: UNITS };

/// Coefficients of friction. With 1e6 nothing slides: the cone's edges are a millionth of a radian from the face, where a
/// load's own rounding (1e-9 of it passes for balanced) times the coefficient is still a thousandth of the load. With more a
/// wall would hold what only touches it.
pub const FRICTION: Bounds = Bounds { least: 0.0, most: 1e6, unit: "", advice: "with 1e6 nothing slides" };

/// In motion a greater coefficient counts as this one: nothing slides where its load leans by up to 89.4 degrees from the normal.
/// The iteration for sliding contacts (`simulate/solve/pivots.rs`) contracts by mu^2 / (1 + mu^2), and the friction at a contact's own
/// rounding of speeds is mu times that: from 1e3 on steps end short of Coulomb's law.
pub const MOST_FRICTION_IN_MOTION: f64 = drystone_contact::MOST_FRICTION;

/// Contact tolerances, metres: from the default one of the thinnest block to the size of the largest.
pub const TOLERANCE: Bounds = Bounds { least: 1e-18, most: 1e12, unit: " m", advice: UNITS };

/// Angles, radians. At 1e12 neighbouring floats are 1e-4 rad apart.
pub const ANGLE: Bounds = Bounds { least: -1e12, most: 1e12, unit: " rad", advice: "take off whole turns" };

/// Turns of a settlement, radians, either way. A displacement is small while the sine of its turn is the turn: at .1 within 0.2 %.
pub const SMALL_TURN: Bounds = Bounds {
    least: -0.1,
    most: 0.1,
    unit: " rad",
    advice: "a settlement is a small displacement, its turn in radians",
};

/// Edges of a friction cone in space. With 1000 the pyramid leaves out 5e-6 of the coefficient; contacts cost edges times edges.
pub const MOST_FACETS: usize = 1000;

/// A step, seconds.
pub const TIME_STEP: Bounds = Bounds { least: 1e-12, most: 1e12, unit: " s", advice: "give seconds" };

/// Velocities, m/s and rad/s, either way.
pub const VELOCITY: Bounds = Bounds { least: -1e12, most: 1e12, unit: "", advice: "give SI units" };

/// Forces (N), moments (N m) and impulses (N s, N m s) given to a world, either way: the greatest mass under the greatest gravity.
pub const PUSH: Bounds = Bounds { least: -1e36, most: 1e36, unit: "", advice: "give SI units" };

impl fmt::Display for Bounds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (least, most, unit) = (Plain(self.least), Plain(self.most), self.unit);
        match self.least {
            0.0 => write!(f, "at most {most}{unit}"),
            _ => write!(f, "from {least} to {most}{unit}"),
        }
    }
}

/// A number as people write it: 0.5, 1e12.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plain(pub f64);

impl fmt::Display for Plain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let usual = self.0 == 0.0 || (1e-3..1e5).contains(&self.0.abs());
        if usual { write!(f, "{}", self.0) } else { write!(f, "{:e}", self.0) }
    }
}

impl Bounds {
    /// Whether a value lies within; not a number does not.
    pub fn hold(self, value: f64) -> bool {
        (self.least..=self.most).contains(&value)
    }
}
