//! Two surfaces, and which of their triangles come near one another.

use crate::{
    geometry::{Surface, Vector3},
    interrupt::poll,
};
use parry3d_f64::partitioning::BvhNode;

/// Operations on the way to a pair of leaves, about.
pub(super) const LEAF: usize = 100;

/// Two surfaces.
pub(super) struct Pair<'a> {
    pub surfaces: [&'a Surface; 2],
    /// Where the second stands from the first.
    pub offset: Vector3,
    pub tolerance: f64,
}

impl<'a> Pair<'a> {
    /// One of the two, and the other with where it stands from it.
    pub fn seen_from(&self, side: usize) -> (&'a Surface, Seen<'a>) {
        let at = if side == 0 { self.offset } else { -self.offset };
        (self.surfaces[side], Seen { surface: self.surfaces[1 - side], at })
    }

    /// Triangles whose boxes come within the tolerance, in the order of their numbers.
    pub fn candidates(&self) -> Vec<[u32; 2]> {
        let [a, b] = self.surfaces;
        let near = |m: &BvhNode, n: &BvhNode| {
            let between = (n.mins() + self.offset - m.maxs()).max(m.mins() - n.maxs() - self.offset);
            between.max_element() <= self.tolerance
        };
        let pairs = a.tree().leaf_pairs(b.tree(), near);
        let mut found: Vec<[u32; 2]> = pairs.map(|(ta, tb)| [ta, tb]).inspect(|_| poll(LEAF)).collect();
        found.sort_unstable();
        found
    }
}

/// A surface and where it stands from the other.
pub(super) struct Seen<'a> {
    pub surface: &'a Surface,
    pub at: Vector3,
}
