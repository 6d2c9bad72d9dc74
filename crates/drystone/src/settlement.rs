//! Settlements: small displacements that are prescribed for supports.

/// How a support moves: a small displacement of a fixed block, as a rigid body.
#[derive(Debug, Clone, PartialEq)]
pub struct Settlement<V> {
    /// Displacement of the point `at`, world axes, metres.
    pub displacement: V,
    /// Turn about that point, radians, about the axes of the world; in the plane only the last entry is used.
    pub rotation: [f64; 3],
    /// About which point it turns, in the block's frame, metres: its origin is the centre of mass.
    pub at: V,
}
