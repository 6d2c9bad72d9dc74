//! Identities of contacts, stable across sub-assemblies.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Names a contact by the two blocks and the features that meet. It depends on this pair alone,
/// so a contact keeps its identity in every sub-assembly that holds both blocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ContactId {
    /// Indices of the two blocks, the lower first.
    pub bodies: [usize; 2],
    /// What meets there.
    pub feature: Feature,
}

impl ContactId {
    /// The convex pieces of the two that meet: 0 in the plane.
    pub fn pieces(&self) -> [usize; 2] {
        match self.feature {
            Feature::Solids { a, b } | Feature::Borders { a, b } => [a.piece, b.piece],
            Feature::Surfaces { pieces, .. } => pieces,
            _ => [0, 0],
        }
    }
}

/// What meets at a contact point. Face k runs from vertex k to the next one, counter-clockwise;
/// "a" is the block with the lower index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Feature {
    /// One end of the segment that two faces share.
    Faces {
        /// Face of a.
        a: usize,
        /// Face of b.
        b: usize,
        /// 0 for the end met first along b's face, 1 for the other.
        end: usize,
    },
    /// A corner of a on a face of b.
    CornerOfA {
        /// Corner of a.
        a: usize,
        /// Face of b.
        b: usize,
    },
    /// A corner of b on a face of a.
    CornerOfB {
        /// Face of a.
        a: usize,
        /// Corner of b.
        b: usize,
    },
    /// What meets in space, on a piece of each block.
    Solids {
        /// Of a.
        a: SolidFeature,
        /// Of b.
        b: SolidFeature,
    },
    /// A corner of a on a corner of b; the normal is that of slightly rounded ones.
    Corners {
        /// Corner of a.
        a: usize,
        /// Corner of b.
        b: usize,
    },
    /// Borders that meet in space, corners or edges: an end of what they share. The normal is that of slightly rounded ones.
    Borders {
        /// Of a.
        a: SolidFeature,
        /// Of b.
        b: SolidFeature,
    },
    /// What meets of a closed surface and another, or a convex piece.
    Surfaces {
        /// Of a and of b; 0 of a surface.
        pieces: [usize; 2],
        /// The triangles of a and of b. Those of a convex piece are numbered as its faces are fanned from their first corners.
        triangles: [usize; 2],
        /// Of several points on these two which one.
        corner: usize,
    },
}

impl Feature {
    /// Whether only borders meet here (a corner a corner, in space also a corner an edge or an edge an edge along it), so that the
    /// normal is that of slightly rounded ones.
    pub fn at_borders(&self) -> bool {
        matches!(self, Self::Corners { .. } | Self::Borders { .. })
    }
}

/// A corner, an edge or a face of one convex piece of a solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct SolidFeature {
    /// Which piece.
    pub piece: usize,
    /// What on it.
    pub part: SolidPart,
}

/// See [`SolidFeature`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum SolidPart {
    /// By its number.
    Corner(usize),
    /// By the numbers of its ends, the lower first.
    Edge([usize; 2]),
    /// By its number.
    Face(usize),
}

impl fmt::Display for SolidFeature {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.part {
            SolidPart::Corner(k) => write!(f, "corner {k}")?,
            SolidPart::Edge([i, j]) => write!(f, "edge {i}-{j}")?,
            SolidPart::Face(k) => write!(f, "face {k}")?,
        }
        if self.piece == 0 { Ok(()) } else { write!(f, " of piece {}", self.piece) }
    }
}

impl fmt::Display for Feature {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Faces { a, b, end } => write!(f, "a:face {a} / b:face {b} / end {end}"),
            Self::CornerOfA { a, b } => write!(f, "a:corner {a} / b:face {b}"),
            Self::CornerOfB { a, b } => write!(f, "a:face {a} / b:corner {b}"),
            Self::Solids { a, b } => write!(f, "a:{a} / b:{b}"),
            Self::Corners { a, b } => write!(f, "a:corner {a} / b:corner {b}"),
            Self::Borders { a, b } => write!(f, "a:{a} / b:{b} / borders"),
            Self::Surfaces { pieces, triangles, corner } => {
                let on = |k: usize| match pieces[k] {
                    0 => format!("triangle {}", triangles[k]),
                    piece => format!("triangle {} of piece {piece}", triangles[k]),
                };
                write!(f, "a:{} / b:{} / point {corner}", on(0), on(1))
            }
        }
    }
}

impl fmt::Display for ContactId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [a, b] = self.bodies;
        write!(f, "a = {a}, b = {b}: {}", self.feature)
    }
}
