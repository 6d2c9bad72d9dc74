//! What is wrong with a solid that is given by its corners.

use thiserror::Error;

/// Most points of one convex piece. Contacts cost edges times edges.
pub const MOST_POINTS: usize = 2000;

/// What is wrong with the points of a convex piece, and what to do about it.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SolidFault {
    /// No pieces.
    #[error("a solid has no pieces: give at least one list of corners")]
    NoPieces,
    /// Fewer than four points.
    #[error("{count} vertices do not make a polyhedron: give at least four")]
    TooFewVertices {
        /// Vertices given.
        count: usize,
    },
    /// More points than contacts can be found for in reasonable time.
    #[error("{count} vertices in one convex piece: simplify the mesh to at most {MOST_POINTS}")]
    TooManyVertices {
        /// Vertices given.
        count: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} is not finite: give finite coordinates in metres")]
    NotFinite {
        /// Index of the vertex.
        vertex: usize,
    },
    /// A surface without triangles.
    #[error("the surface has no triangles: give a closed surface")]
    NoTriangles,
    /// A triangle uses a vertex twice, or one that is not there.
    #[error(
        "triangle {triangle} does not have three different vertices of those given: number them from 0, and leave out triangles without area"
    )]
    NotATriangle {
        /// Index of the triangle.
        triangle: usize,
    },
    /// A surface has a border, or triangles that face opposite ways.
    #[error(
        "the surface is not closed: its triangles do not go as often one way as the other along the edge between vertices {} and \
         {}; close it, and let all triangles be counter-clockwise from outside", .ends[0], .ends[1]
    )]
    Open {
        /// The ends of the first such edge, indices of vertices.
        ends: [usize; 2],
    },
    /// A surface goes through itself.
    #[error(
        "the surface goes through itself at ({:.4}, {:.4}, {:.4}), and would weigh twice what it encloses twice: join its parts \
         to one solid", .at[0], .at[1], .at[2]
    )]
    ThroughItself {
        /// A place where it does, in the frame of the vertices, metres.
        at: [f64; 3],
    },
    /// The triangles look inwards.
    #[error("the surface is inside out: let its triangles be counter-clockwise from outside")]
    InsideOut,
    /// All vertices lie in a plane.
    #[error("the polyhedron has zero volume: give corners that are not all in one plane")]
    ZeroVolume,
    /// The hull of the points could not be computed.
    #[error("the convex hull of the vertices is not a closed surface ({reason}): merge vertices that nearly coincide")]
    NoHull {
        /// What went wrong.
        reason: String,
    },
    /// Two pieces of one solid occupy the same place.
    #[error(
        "pieces {first} and {second} overlap by {depth:.3e} m: their mass would count twice; give the block's mass, or pieces \
         that only touch"
    )]
    PiecesOverlap {
        /// Index of the first of them.
        first: usize,
        /// Index of the other.
        second: usize,
        /// The shortest way to part them, metres.
        depth: f64,
    },
}
