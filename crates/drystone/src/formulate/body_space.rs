//! Gauss's principle for a sub-assembly, on bodies and contact points: what the interior-point method takes.

use super::{Assembly, BlockSet, Components, ContactForce, answers::force_at};
use crate::{
    contact::Contact,
    formulate::cones::tangents,
    geometry::{cross, dot},
};
use drystone_lcp::interior::{Cone, Found, Gauss, Point};
use std::ops::Range;

/// Which friction cones a question is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FrictionCone {
    /// Hulls of finitely many edges: the generators. In the plane these are Coulomb's own.
    #[default]
    Pyramid,
    /// Coulomb's round cones.
    Round,
}

/// A sub-assembly as [`Gauss`] takes it.
#[derive(Debug)]
pub(crate) struct BodySpace<'a> {
    assembly: &'a Assembly,
    blocks: Vec<usize>,
    points: Vec<Touched>,
    problem: Gauss,
}

/// A point of the problem.
#[derive(Debug)]
struct Touched {
    contact: usize,
    /// The directions of its rows.
    frame: [[f64; 3]; 3],
    /// Generators of the contact: the edges of its cone.
    generators: Range<usize>,
    /// The column of [`Assembly::equilibrium`] of its axis, if that is one of its edges here.
    axis: Option<usize>,
}

/// What the method found, in the terms of an assembly.
#[derive(Debug)]
pub(crate) struct Constrained {
    /// Accelerations of the blocks, ascending.
    pub motion: Vec<(usize, Components)>,
    /// Of every contact point between them, ascending.
    pub forces: Vec<ContactForce>,
    pub found: Found,
}

impl Assembly {
    /// Gauss's principle for a sub-assembly.
    pub(crate) fn body_space(&self, blocks: &BlockSet, cone: FrictionCone) -> BodySpace<'_> {
        self.spanned_body_space(blocks, cone, false)
    }

    /// The same with the axis of each cone beside its edges, as [`Self::equilibrium`] has it.
    pub(crate) fn body_space_with_axes(&self, blocks: &BlockSet) -> BodySpace<'_> {
        self.spanned_body_space(blocks, FrictionCone::Pyramid, true)
    }

    fn spanned_body_space(&self, blocks: &BlockSet, cone: FrictionCone, axes: bool) -> BodySpace<'_> {
        let present: Vec<usize> = blocks.iter().collect();
        let mut place = vec![None; self.blocks()];
        present.iter().enumerate().for_each(|(k, &block)| place[block] = Some(k));
        let mut problem = Gauss { size: self.components().len(), ..Gauss::default() };
        for &block in &present {
            problem.inverse_mass.extend(self.inverse_mass(block));
            problem.load.extend(self.applied(block));
        }
        let mut points = Vec::new();
        let mut first = 0;
        for (index, contact) in self.contacts().iter().enumerate() {
            let own = self.generators_of(index, first);
            first = own.end;
            let blocks = contact.bodies.map(|body| self.block_of(body));
            let there = blocks.map(|block| block.map(|block| place[block]));
            if there.contains(&Some(None)) {
                continue; // one of the two is not there
            }
            let frame = self.frame(contact);
            let axis = self.axis_column(index).filter(|_| axes);
            let cone = match cone {
                FrictionCone::Round if contact.friction > 0.0 && !self.in_plane() => {
                    Cone::Round { friction: contact.friction }
                }
                _ => {
                    let along = |direction: [f64; 3]| frame.map(|axis| dot(axis, direction));
                    let edges = self.generators()[own.clone()].iter().map(|generator| along(generator.direction));
                    Cone::Edges(edges.chain(axis.map(|_| [1.0, 0.0, 0.0])).collect())
                }
            };
            let jacobian = [0, 1].map(|side| {
                let sign = if side == 0 { -1.0 } else { 1.0 };
                let body = &self.bodies()[contact.bodies[side]];
                frame.map(|axis| {
                    let wrench = body.wrench(axis.map(|x| sign * x), contact.point);
                    let mut row = [0.0; 6];
                    self.components().iter().enumerate().for_each(|(k, &c)| row[k] = wrench[c]);
                    row
                })
            });
            problem.points.push(Point { bodies: there.map(Option::flatten), jacobian, cone });
            points.push(Touched { contact: index, frame, generators: own, axis });
        }
        BodySpace { assembly: self, blocks: present, points, problem }
    }

    /// The normal of a contact and two directions square to it; in the plane the second of these is that of z.
    fn frame(&self, contact: &Contact) -> [[f64; 3]; 3] {
        let normal @ [x, y, _] = contact.normal;
        if self.in_plane() {
            return [normal, [-y, x, 0.0], [0.0, 0.0, 1.0]];
        }
        let [first, _] = tangents(normal, self.gravity());
        [normal, first, cross(normal, first)]
    }
}

impl BodySpace<'_> {
    pub fn solve(&self) -> Constrained {
        self.solve_while(&mut || true).expect("nobody stops it")
    }

    /// [`Self::solve`] as long as `go_on`, asked before every iteration, says so; None if stopped.
    pub fn solve_while(&self, go_on: &mut dyn FnMut() -> bool) -> Option<Constrained> {
        let found = self.problem.solve_while(go_on)?;
        let size = self.problem.size;
        let mut motion = Vec::with_capacity(self.blocks.len());
        for (place, &block) in self.blocks.iter().enumerate() {
            let mut acceleration = [0.0; 6];
            let own = &found.accelerations[place * size..][..size];
            self.assembly.components().iter().zip(own).for_each(|(&c, a)| acceleration[c] = *a);
            motion.push((block, acceleration));
        }
        let forces = self.forces(&found.forces);
        Some(Constrained { motion, forces, found })
    }

    /// The force at every point, from the unknowns of its cone.
    fn forces(&self, unknowns: &[f64]) -> Vec<ContactForce> {
        let (mut forces, mut next) = (Vec::with_capacity(self.points.len()), 0);
        for (Touched { contact, frame, .. }, point) in self.points.iter().zip(&self.problem.points) {
            let own = &unknowns[next..next + point.cone.unknowns()];
            next += own.len();
            let local = match &point.cone {
                Cone::Round { .. } => [own[0], own[1], own[2]],
                Cone::Edges(edges) => [0, 1, 2].map(|k| edges.iter().zip(own).map(|(edge, f)| edge[k] * f).sum()),
            };
            let force = [0, 1, 2].map(|k| (0..3).map(|axis| local[axis] * frame[axis][k]).sum());
            let normal = self.assembly.contacts()[*contact].normal;
            forces.push(force_at(*contact, normal, self.assembly.in_plane(), force));
        }
        forces
    }

    /// A basis of columns of [`Assembly::equilibrium`] that hold the blocks, where [`Self::solve`] has found forces that do. None
    /// if the method does not come to an end.
    pub fn basis(&self, found: &Found) -> Option<Vec<usize>> {
        let basis = self.problem.basis(&found.forces, |point| self.points[point].axis.is_some())?;
        let columns: Vec<usize> = self.columns().collect();
        Some(basis.into_iter().map(|unknown| columns[unknown]).collect())
    }

    /// The columns of [`Assembly::equilibrium`] that bear in a solution rather than open.
    pub fn bearing(&self, found: &Found) -> Vec<usize> {
        let bears = found.bearing.iter().zip(self.columns()).filter(|(bears, _)| **bears);
        bears.map(|(_, column)| column).collect()
    }

    /// Column of [`Assembly::equilibrium`] of every unknown; with pyramids only.
    fn columns(&self) -> impl Iterator<Item = usize> {
        self.points.iter().flat_map(|point| point.generators.clone().chain(point.axis))
    }
}
