//! Gauss's principle for a sub-assembly, on bodies and contact points: what the interior-point method takes.

use super::{Assembly, BlockSet, Components, ContactForce, FrictionCone, Push, answers::force_at};
use crate::{
    contact::Contact,
    formulate::cones::tangents,
    geometry::{cross, dot},
};
use drystone_lcp::interior::{Cone, Found, Gauss, Layers, Point};
use std::ops::Range;

/// A sub-assembly as [`Gauss`] takes it.
#[derive(Debug, Clone)]
pub(crate) struct BodySpace<'a> {
    assembly: &'a Assembly,
    blocks: Vec<usize>,
    points: Vec<Touched>,
    problem: Gauss,
}

/// A point of the problem.
#[derive(Debug, Clone)]
struct Touched {
    contact: usize,
    /// The directions of its rows.
    frame: [[f64; 3]; 3],
    /// Generators of the contact: the edges of its cone.
    generators: Range<usize>,
    /// The column of [`Assembly::equilibrium`] of its axis, if that is one of its edges here.
    axis: Option<usize>,
    /// Whether only forces against a way in which it slides are left of its cone.
    slides: bool,
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
        self.spanned_body_space(blocks, None, cone, false)
    }

    /// The same where some of the blocks are held, which is to be fixed for the others.
    pub(crate) fn held_body_space(&self, blocks: &BlockSet, held: &BlockSet, cone: FrictionCone) -> BodySpace<'_> {
        self.spanned_body_space(blocks, Some(held), cone, false)
    }

    /// The same with the axis of each cone beside its edges, as [`Self::equilibrium`] has it.
    pub(crate) fn body_space_with_axes(&self, blocks: &BlockSet) -> BodySpace<'_> {
        self.spanned_body_space(blocks, None, FrictionCone::Pyramid, true)
    }

    fn spanned_body_space(
        &self,
        blocks: &BlockSet,
        held: Option<&BlockSet>,
        cone: FrictionCone,
        axes: bool,
    ) -> BodySpace<'_> {
        let is_held = |block: usize| held.is_some_and(|held| held.contains(block));
        let present: Vec<usize> = blocks.iter().filter(|&block| !is_held(block)).collect();
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
            let moves = |body: usize| self.block_of(body).filter(|&block| !(blocks.contains(block) && is_held(block)));
            let there = contact.bodies.map(|body| moves(body).map(|block| place[block]));
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
            points.push(Touched { contact: index, frame, generators: own, axis, slides: false });
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

impl<'a> BodySpace<'a> {
    /// Whose it is.
    pub fn assembly(&self) -> &'a Assembly {
        self.assembly
    }

    /// The same without points between bodies that are fixed or held: only layers between them would feel these.
    pub fn of_moving(mut self) -> Self {
        let moves = |point: &Point| point.bodies.iter().any(Option::is_some);
        let mut moving = self.problem.points.iter().map(moves);
        self.points.retain(|_| moving.next().unwrap_or(false));
        self.problem.points.retain(moves);
        self
    }

    /// The same under a push, whose factor is sought.
    pub fn under(mut self, push: &Push) -> Self {
        self.problem.push = self.load(push);
        self
    }

    /// The same where the supports have settled by a multiple of what is prescribed for them: an offset of the contacts.
    pub fn settled(mut self, factor: f64) -> Self {
        let bodies = self.assembly.bodies();
        for (touched, point) in self.points.iter().zip(&self.problem.points) {
            let contact = &self.assembly.contacts()[touched.contact];
            let mut relative = [0.0; 3];
            for (side, _) in point.bodies.iter().enumerate().filter(|(_, body)| body.is_none()) {
                let settlement = &bodies[contact.bodies[side]].settlement;
                for (relative, row) in relative.iter_mut().zip(&point.jacobian[side]) {
                    let along = self.assembly.components().iter().zip(row);
                    *relative += along.map(|(&k, row)| factor * settlement[k] * row).sum::<f64>();
                }
            }
            match &point.cone {
                Cone::Round { .. } => self.problem.offset.extend(relative),
                Cone::Edges(edges) => self.problem.offset.extend(edges.iter().map(|&edge| dot(edge, relative))),
            }
        }
        self
    }

    /// Pulls the blocks towards a motion, one unknown after another: with `M motion` added to the load (1) has its least where a is
    /// near that motion, but for the loads.
    pub fn pulled_towards(&self, motion: &[f64]) -> Self {
        let mut pulled = self.clone();
        let pull = motion.iter().zip(&self.problem.inverse_mass).map(|(a, inverse)| a / inverse);
        pulled.problem.load.iter_mut().zip(pull).for_each(|(load, pull)| *load += pull);
        pulled
    }

    /// The same with the forces that are left after a displacement of the second bodies relative to the first, one for each point: none
    /// where a point opens by more than `resolution`, metres; where it slides those against the way. Which way that is on a round cone
    /// forces tell better, which bear there, world axes: they balance.
    pub fn bearing_after(mut self, relative: &[[f64; 3]], resolution: f64, bearing: &[[f64; 3]]) -> Self {
        let mut kept = Vec::with_capacity(self.points.len());
        let points = self.points.iter_mut().zip(&mut self.problem.points);
        for (((touched, point), relative), bearing) in points.zip(relative).zip(bearing) {
            let moved = touched.frame.map(|axis| dot(axis, *relative));
            let [_, first, second] = moved;
            let across = first.hypot(second);
            let left = match &point.cone {
                Cone::Round { friction } if moved[0] - friction * across > resolution => Some(Vec::new()),
                Cone::Round { .. } if across > resolution => {
                    let force = touched.frame.map(|axis| dot(axis, *bearing));
                    Some(if force[0] > 0.0 { vec![force.map(|f| f / force[0])] } else { Vec::new() })
                }
                Cone::Round { .. } => None,
                Cone::Edges(edges) => {
                    let closed = |edge: &&[f64; 3]| dot(**edge, moved) <= resolution;
                    let closed: Vec<[f64; 3]> = edges.iter().filter(closed).copied().collect();
                    (closed.len() < edges.len()).then_some(closed)
                }
            };
            kept.push(left.as_ref().is_none_or(|edges| !edges.is_empty()));
            if let Some(edges) = left {
                (touched.slides, point.cone) = (true, Cone::Edges(edges));
            }
        }
        let mut bears = kept.iter();
        self.points.retain(|_| *bears.next().unwrap_or(&false));
        let mut bears = kept.iter();
        self.problem.points.retain(|_| *bears.next().unwrap_or(&false));
        self
    }

    /// Whether only forces against a way in which it slides are left at a point.
    pub fn slides(&self, point: usize) -> bool {
        self.points[point].slides
    }

    /// A push as a load of the problem, body after body.
    pub fn load(&self, push: &Push) -> Vec<f64> {
        self.blocks.iter().flat_map(|&block| push.on(block, self.problem.size)).copied().collect()
    }

    /// Forces under the largest factor of the push, and the motion in which more of it moves the blocks, in place of accelerations.
    pub fn greatest_within(&self, within: f64) -> Constrained {
        self.constrained(self.problem.greatest_within(within, &mut || true).expect("nobody stops it"))
    }

    pub fn solve(&self) -> Constrained {
        self.solve_while(&mut || true).expect("nobody stops it")
    }

    /// Forces that hold the blocks, near some that are positive along all generators; zeros where nothing is known. None if that leads
    /// nowhere, which proves nothing. With pyramids only.
    pub fn rest_near(&self, magnitudes: &[f64]) -> Option<Constrained> {
        let near: Vec<f64> = self.columns().map(|generator| magnitudes[generator]).collect();
        Some(self.constrained(self.problem.rest_near(&near)?))
    }

    /// The force of each generator of the assembly in a solution; with pyramids only.
    pub fn magnitudes(&self, found: &Found) -> Vec<f64> {
        let mut magnitudes = vec![0.0; self.assembly.generators().len()];
        self.columns().zip(&found.forces).for_each(|(generator, force)| magnitudes[generator] = *force);
        magnitudes
    }

    /// [`Self::solve`] as long as `go_on`, asked before every iteration, says so; None if stopped.
    pub fn solve_while(&self, go_on: &mut dyn FnMut() -> bool) -> Option<Constrained> {
        Some(self.constrained(self.problem.solve_while(go_on)?))
    }

    /// Solves it from ones, for a basis: where masses differ by 1e10 its forces keep more digits.
    pub fn solve_from_ones(&self) -> Constrained {
        self.constrained(self.problem.solve_from_ones())
    }

    /// The motion nearest to one (of the same blocks) among those in which no contact closes: Gauss's principle with that motion in
    /// place of free fall, and bodies of mass one with the radius of their own as that of gyration.
    pub fn nearest(mut self, motion: &[(usize, Components)]) -> Vec<(usize, Components)> {
        let components = self.assembly.components();
        let inertia = |block: usize, k: usize| if k < 3 { 1.0 } else { self.assembly.body(block).radius.powi(2) };
        let of_all = || self.blocks.iter().flat_map(|&block| components.iter().map(move |&k| (block, k)));
        let moving = |block: usize| motion.binary_search_by_key(&block, |moving| moving.0).map(|place| motion[place].1);
        self.problem.inverse_mass = of_all().map(|(block, k)| inertia(block, k).recip()).collect();
        self.problem.load =
            of_all().map(|(block, k)| moving(block).map_or(0.0, |velocity| inertia(block, k) * velocity[k])).collect();
        self.solve().motion
    }

    /// What the method has found in the terms of the assembly.
    pub fn constrained(&self, found: Found) -> Constrained {
        Constrained { motion: self.motion(&found.accelerations), forces: self.forces(&found.forces), found }
    }

    /// The blocks with their accelerations, from the unknowns of the problem.
    pub fn motion(&self, accelerations: &[f64]) -> Vec<(usize, Components)> {
        let of = |(&block, own): (&usize, &[f64])| {
            let mut acceleration = [0.0; 6];
            self.assembly.components().iter().zip(own).for_each(|(&c, a)| acceleration[c] = *a);
            (block, acceleration)
        };
        self.blocks.iter().zip(accelerations.chunks(self.problem.size)).map(of).collect()
    }

    /// The blocks with their accelerations under a load of the problem and forces, which are unknowns of the problem.
    pub fn accelerations(&self, load: &[f64], forces: &[f64]) -> Vec<(usize, Components)> {
        let (size, mut wrenches, mut rest) = (self.problem.size, load.to_vec(), forces);
        for point in &self.problem.points {
            let (own, others) = rest.split_at(point.cone.unknowns());
            rest = others;
            let force = point.cone.force(own);
            for (body, jacobian) in point.bodies.iter().zip(&point.jacobian) {
                let Some(body) = body else { continue };
                for (force, row) in force.iter().zip(jacobian) {
                    wrenches[body * size..][..size].iter_mut().zip(row).for_each(|(sum, row)| *sum += force * row);
                }
            }
        }
        wrenches.iter_mut().zip(&self.problem.inverse_mass).for_each(|(wrench, inverse)| *wrench *= inverse);
        self.motion(&wrenches)
    }

    /// What is solved.
    pub fn problem(&self) -> &Gauss {
        &self.problem
    }

    /// The force at every point, from the unknowns of its cone.
    pub fn forces(&self, unknowns: &[f64]) -> Vec<ContactForce> {
        let (mut forces, mut next) = (Vec::with_capacity(self.points.len()), 0);
        for (Touched { contact, frame, .. }, point) in self.points.iter().zip(&self.problem.points) {
            let own = &unknowns[next..next + point.cone.unknowns()];
            next += own.len();
            let local = point.cone.force(own);
            forces.push(self.force_along(*contact, frame, local));
        }
        forces
    }

    /// A contact's force from its components along a frame.
    fn force_along(&self, contact: usize, frame: &[[f64; 3]; 3], local: [f64; 3]) -> ContactForce {
        let force = [0, 1, 2].map(|k| (0..3).map(|axis| local[axis] * frame[axis][k]).sum());
        force_at(contact, self.assembly.contacts()[contact].normal, self.assembly.in_plane(), force)
    }

    /// The contact of each point.
    pub fn contacts(&self) -> impl Iterator<Item = &'a Contact> {
        let contacts = self.assembly.contacts();
        self.points.iter().map(|point| &contacts[point.contact])
    }

    /// The directions of a point's rows.
    pub fn directions(&self, point: usize) -> &[[f64; 3]; 3] {
        &self.points[point].frame
    }

    /// The forces that a point can bear, along its directions.
    pub fn cone(&self, point: usize) -> &Cone {
        &self.problem.points[point].cone
    }

    /// The force at a point from its components along its directions.
    pub fn force(&self, point: usize, local: [f64; 3]) -> ContactForce {
        self.force_along(self.points[point].contact, &self.points[point].frame, local)
    }

    /// Takes other wrenches for the loads, one for each block of the assembly.
    pub fn balance(&mut self, wrenches: &[Components]) {
        let components = self.assembly.components();
        let own = |&block: &usize| components.iter().map(move |&c| wrenches[block][c]);
        self.problem.load = self.blocks.iter().flat_map(own).collect();
    }

    /// The forces of least norm at every point, along its directions; the norm is that of what the layers bear.
    pub fn least_norm(&self, layers: &Layers) -> Vec<[f64; 3]> {
        let found = self.problem.least_norm(layers);
        let mut rest = &found.forces[..];
        let own = |point: &Point| {
            let (own, others) = rest.split_at(point.cone.unknowns());
            rest = others;
            point.cone.force(own)
        };
        self.problem.points.iter().map(own).collect()
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
