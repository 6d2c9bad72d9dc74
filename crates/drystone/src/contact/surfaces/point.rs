//! Points where two surfaces touch, and how sets of triangles are hashed.

use crate::{contact::Feature, geometry::Vector3};
use std::{
    collections::HashSet,
    hash::{BuildHasherDefault, Hasher},
};

/// The plane on which a point was found, before planes are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum Plane {
    /// Between a flat face of each.
    Between(u32, u32),
    /// On a flat face of the first.
    OfA(u32),
    /// On a flat face of the second.
    OfB(u32),
    /// On a seam between facets of a curved surface, by the bits of the normal there.
    Seam([u64; 3]),
    /// Along an edge of each, by their ends.
    Across([u32; 2], [u32; 2]),
}

/// A point where two surfaces touch, seen from the first.
#[derive(Debug, Clone, Copy)]
pub(super) struct Found {
    pub plane: Plane,
    pub point: Vector3,
    /// From the first into the second.
    pub normal: Vector3,
    pub gap: f64,
    pub triangles: [u32; 2],
}

/// A contact point of two bodies, seen from the first.
#[derive(Debug, Clone, Copy)]
pub(in crate::contact) struct SurfacePoint {
    pub feature: Feature,
    pub point: Vector3,
    pub normal: Vector3,
    pub gap: f64,
}

/// Pairs of triangles that lie on one another.
pub(super) type Lying = HashSet<[u32; 2], BuildHasherDefault<Mixed>>;

/// A hash of some numbers, of triangles mostly: there are millions of them, and nobody chooses them to collide.
#[derive(Default)]
pub(super) struct Mixed(u64);

impl Hasher for Mixed {
    fn finish(&self) -> u64 {
        self.0 ^ self.0 >> 32
    }

    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.write_u64(u64::from_ne_bytes(word));
        }
    }

    fn write_u32(&mut self, number: u32) {
        self.write_u64(number.into());
    }

    fn write_u64(&mut self, number: u64) {
        // Multiplication by an odd number near the golden section of 2^64 (D. Knuth, 6.4).
        self.0 = (self.0.rotate_left(26) ^ number).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }
}
