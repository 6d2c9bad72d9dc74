//! The contact points of a sub-assembly, in units in which free fall has the length one.

use super::hinges::Turned;
use crate::formulate::{Assembly, BlockSet, ContactForce, FrictionCone};
use crate::formulate::{BodySpace, Components};

/// Two points of one face slide alike if their rows differ by no more than this share.
pub(super) const ALIKE: f64 = 1e-9;

/// Mass matrix, loads and contact points of a sub-assembly: accelerations are `M^1/2 a / s` and forces `f / s`, with `s^2 =
/// F' M^-1 F`.
pub(super) struct Laws<'a> {
    pub space: BodySpace<'a>,
    /// `s`, and of every unknown `M^1/2`.
    scale: f64,
    root_mass: Vec<f64>,
    /// `M^-1/2 F / s`.
    pub load: Vec<f64>,
    pub points: Vec<Point>,
    /// The points that slide alike, those of one face, and their coefficient.
    pub faces: Vec<Face>,
    /// See [`super::chains`]; none before they are looked for.
    pub chains: Vec<Vec<usize>>,
    /// See [`super::turned`]; none before it is looked for.
    pub turned: Option<Turned>,
}

/// A row of `J M^-1/2`: by (unknown, value).
pub(super) type Row = Vec<(usize, f64)>;

pub(super) struct Point {
    pub normal: Row,
    pub tangent: Row,
    pub friction: f64,
}

pub(super) struct Face {
    pub points: Vec<usize>,
    pub friction: f64,
}

impl<'a> Laws<'a> {
    /// None if no load acts.
    pub fn new(assembly: &'a Assembly, blocks: &BlockSet) -> Option<Self> {
        let space = assembly.body_space(blocks, FrictionCone::Pyramid);
        let problem = space.problem();
        let root_mass: Vec<f64> = problem.inverse_mass.iter().map(|inverse| inverse.sqrt().recip()).collect();
        let falls = problem.load.iter().zip(&root_mass).map(|(load, root)| (load / root).powi(2)).sum::<f64>().sqrt();
        if falls == 0.0 {
            return None;
        }
        let load = problem.load.iter().zip(&root_mass).map(|(load, root)| load / root / falls).collect();
        let row = |point: &drystone_lcp::interior::Point, axis: usize| -> Row {
            let own = |side: usize| {
                let first = point.bodies[side].map(|body| problem.size * body);
                let entry = move |k: usize| Some((first? + k, point.jacobian[side][axis][k]));
                (0..problem.size).filter_map(entry)
            };
            let scaled = own(0).chain(own(1)).map(|(k, value)| (k, value / root_mass[k]));
            scaled.filter(|entry| entry.1 != 0.0).collect()
        };
        let frictions = space.contacts().map(|contact| contact.friction);
        let points: Vec<Point> = (problem.points.iter().zip(frictions))
            .map(|(point, friction)| Point { normal: row(point, 0), tangent: row(point, 1), friction })
            .collect();
        let pairs: Vec<[usize; 2]> = space.contacts().map(|contact| contact.bodies).collect();
        let faces = faces(&points, &pairs);
        Some(Self { scale: falls, root_mass, load, points, faces, chains: Vec::new(), turned: None, space })
    }

    /// Unknown accelerations.
    pub fn size(&self) -> usize {
        self.load.len()
    }

    /// `M^1/2` of an unknown.
    pub fn root_mass(&self, k: usize) -> f64 {
        self.root_mass[k]
    }

    /// Accelerations of the blocks, and forces from their normal and tangential components at each point, both in the units of this
    /// problem.
    pub fn in_si(&self, a: &[f64], forces: &[[f64; 2]]) -> (Vec<(usize, Components)>, Vec<ContactForce>) {
        let a: Vec<f64> = a.iter().zip(&self.root_mass).map(|(a, root)| self.scale * a / root).collect();
        let at = |(point, [n, t]): (usize, &[f64; 2])| self.space.force(point, [self.scale * n, self.scale * t, 0.0]);
        (self.space.motion(&a), forces.iter().enumerate().map(at).collect())
    }
}

/// Points with friction of the same two bodies on one line across the normal.
fn faces(points: &[Point], pairs: &[[usize; 2]]) -> Vec<Face> {
    let alike = |a: &Row, b: &Row| {
        let size = a.iter().map(|entry| entry.1.abs()).fold(0.0, f64::max);
        let value = |row: &Row, k: usize| row.iter().find(|entry| entry.0 == k).map_or(0.0, |entry| entry.1);
        a.iter().chain(b).all(|&(k, _)| (value(a, k) - value(b, k)).abs() <= ALIKE * size)
    };
    let mut faces: Vec<Face> = Vec::new();
    let mut of_pair: std::collections::BTreeMap<[usize; 2], Vec<usize>> = std::collections::BTreeMap::new();
    for (index, point) in points.iter().enumerate().filter(|(_, point)| point.friction > 0.0) {
        let known = of_pair.entry(pairs[index]).or_default();
        let same = |&&face: &&usize| {
            let first: &Point = &points[faces[face].points[0]];
            first.friction == point.friction && alike(&first.tangent, &point.tangent)
        };
        match known.iter().find(same).copied() {
            Some(face) => faces[face].points.push(index),
            None => {
                known.push(faces.len());
                faces.push(Face { points: vec![index], friction: point.friction });
            }
        }
    }
    faces
}
