//! The complete assembly's contact problem. Every sub-assembly's problem is a principal sub-problem of it.

use super::{
    block_set::BlockSet,
    generator::{Bodies, Generator, axis_share},
};
use crate::{
    contact::{Contact, ContactSet, find_contacts},
    error::SceneError,
    scene::{Body, Scene},
};
use drystone_lcp::{
    Problem,
    cone::{Columns, ConeSolver},
};

/// Contacts, generators and loads of a scene.
#[derive(Debug, Clone)]
pub struct Assembly {
    bodies: Vec<Body>,
    gravity: [f64; 2],
    contacts: ContactSet,
    movable: Vec<usize>,
    generators: Vec<Generator>,
    /// Axes of the cones of the contacts that have friction, and which of them is a contact's.
    axes: Vec<Generator>,
    axis_of: Vec<Option<usize>>,
    /// Generators that act on each movable block.
    generators_on: Vec<Vec<usize>>,
    /// Diagonal of `M^-1` for each movable block: 1/kg, 1/kg, 1/(kg m^2).
    inverse_mass: Vec<[f64; 3]>,
}

/// The force that the first body of a contact exerts on the second, newtons.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactForce {
    /// Index of the contact in [`Assembly::contacts`].
    pub contact: usize,
    /// Along the contact normal (first body into second): not negative.
    pub normal: f64,
    /// Along the normal turned 90 degrees counter-clockwise.
    pub tangential: f64,
    /// In world axes.
    pub force: [f64; 2],
}

impl Assembly {
    /// Finds the contacts of a scene and their generators.
    ///
    /// # Errors
    /// [`SceneError::Overlap`] if blocks overlap.
    pub fn new(scene: &Scene) -> Result<Self, SceneError> {
        let contacts = find_contacts(scene)?;
        let bodies = scene.bodies().to_vec();
        let movable: Vec<usize> = (0..bodies.len()).filter(|&i| !bodies[i].fixed).collect();
        let mut block_of = vec![None; bodies.len()];
        for (block, &body) in movable.iter().enumerate() {
            block_of[body] = Some(block);
        }
        let spanning = Bodies { bodies: &bodies, movable: |body: usize| block_of[body] };
        let points = || contacts.contacts.iter().enumerate();
        let generators: Vec<Generator> =
            points().flat_map(|(index, contact)| spanning.generators(index, contact)).collect();
        let axes: Vec<Generator> = points().filter_map(|(index, contact)| spanning.axis(index, contact)).collect();
        let mut axis_of = vec![None; contacts.contacts.len()];
        axes.iter().enumerate().for_each(|(k, axis)| axis_of[axis.contact] = Some(k));
        let mut generators_on = vec![Vec::new(); movable.len()];
        for (j, generator) in generators.iter().enumerate() {
            for wrench in &generator.wrenches {
                generators_on[wrench.block].push(j);
            }
        }
        let inverse_mass = movable
            .iter()
            .map(|&body| {
                let (mass, inertia) = (bodies[body].mass(), bodies[body].inertia());
                [mass.recip(), mass.recip(), inertia.recip()]
            })
            .collect();
        Ok(Self {
            gravity: scene.gravity(),
            bodies,
            contacts,
            movable,
            generators,
            axes,
            axis_of,
            generators_on,
            inverse_mass,
        })
    }

    /// Number of movable blocks.
    pub fn blocks(&self) -> usize {
        self.movable.len()
    }

    /// The body of a movable block.
    pub fn body(&self, block: usize) -> &Body {
        &self.bodies[self.movable[block]]
    }

    /// Index in the scene of a movable block's body.
    pub fn body_index(&self, block: usize) -> usize {
        self.movable[block]
    }

    /// All bodies of the scene, fixed ones too.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// m/s^2.
    pub fn gravity(&self) -> [f64; 2] {
        self.gravity
    }

    /// Every contact point of the complete assembly.
    pub fn contacts(&self) -> &[Contact] {
        &self.contacts.contacts
    }

    /// Every generator of the complete assembly, in the order of the rows of its problem.
    pub fn generators(&self) -> &[Generator] {
        &self.generators
    }

    /// Generators that act on a movable block, ascending.
    pub fn generators_on(&self, block: usize) -> &[usize] {
        &self.generators_on[block]
    }

    /// Diagonal of `M^-1` of a movable block: 1/kg, 1/kg, 1/(kg m^2).
    pub fn inverse_mass(&self, block: usize) -> [f64; 3] {
        self.inverse_mass[block]
    }

    /// Applied wrench on a movable block: its weight, N, N, N m.
    pub fn applied(&self, block: usize) -> [f64; 3] {
        let mass = self.body(block).mass();
        [mass * self.gravity[0], mass * self.gravity[1], 0.0]
    }

    /// `A = G' M^-1 G` (1/kg) and `b = G' M^-1 F` (m/s^2) of the complete assembly. Equation 8 of Loomis and
    /// Balkcom: a sub-assembly's problem is the principal sub-problem on [`Self::rows`] of its blocks.
    pub fn problem(&self) -> Problem {
        let inverse_mass = self.inverse_mass.as_flattened();
        Problem::from_generators(&self.columns(self.generators.iter()), inverse_mass, &self.balance())
            .expect("a validated scene has finite masses, positions and directions")
    }

    /// Static equilibrium `G f = -F`, `f >= 0` of the complete assembly, without any block yet. Imbalance is measured in
    /// each block's own weight, moments with its radius of gyration as the arm.
    ///
    /// Beside the generators, whose columns come first, it has the axis of every friction cone, and tries these first:
    /// what stands by straight pressure alone is then held by few forces, and the basis of its columns is far sparser.
    /// [`Self::magnitude`] gives such a force back to the edges.
    pub fn equilibrium(&self) -> ConeSolver {
        let units: Vec<f64> = (0..self.blocks()).flat_map(|block| self.balance_unit(block)).collect();
        let columns = self.columns(self.generators.iter().chain(&self.axes));
        let axes = self.generators.len()..columns.len();
        let mut solver = ConeSolver::new(columns, &self.balance(), &units)
            .expect("a validated scene has finite masses, positions and directions");
        solver.prefer(axes);
        solver
    }

    /// In which the imbalance of a block is measured: its weight, its weight, its weight times its radius of gyration.
    pub(crate) fn balance_unit(&self, block: usize) -> [f64; 3] {
        let [gx, gy] = self.gravity;
        let gravity = Some(gx.hypot(gy)).filter(|&gravity| gravity > 0.0).unwrap_or(1.0);
        let [per_mass, _, per_inertia] = self.inverse_mass[block];
        let weight = gravity / per_mass;
        [weight, weight, weight * (per_mass / per_inertia).sqrt()]
    }

    /// Magnitude of a generator in a solution of [`Self::equilibrium`], N.
    pub fn magnitude(&self, solver: &ConeSolver, generator: usize) -> f64 {
        let contact = self.generators[generator].contact;
        let straight = self.axis_of[contact]
            .map_or(0.0, |axis| axis_share(&self.contacts()[contact]) * solver.f(self.generators.len() + axis));
        solver.f(generator) + straight
    }

    /// Generators as the columns of G, three rows a block.
    fn columns<'a>(&self, generators: impl Iterator<Item = &'a Generator>) -> Columns {
        let (mut indptr, mut indices, mut data) = (vec![0], Vec::new(), Vec::new());
        for generator in generators {
            for wrench in &generator.wrenches {
                let entries = Self::equilibrium_rows(wrench.block).into_iter().zip(wrench.value);
                for (row, value) in entries.filter(|&(_, value)| value != 0.0) {
                    indices.push(row);
                    data.push(value);
                }
            }
            indptr.push(indices.len());
        }
        Columns::new(3 * self.blocks(), &indptr, &indices, &data)
            .expect("a validated scene has finite masses, positions and directions")
    }

    /// What the contact forces have to balance: `-F`, three entries a block.
    fn balance(&self) -> Vec<f64> {
        (0..self.blocks()).flat_map(|block| self.applied(block).map(|load| -load)).collect()
    }

    /// Rows of [`Self::equilibrium`] that are a block's x force, y force and moment.
    pub fn equilibrium_rows(block: usize) -> [usize; 3] {
        [3 * block, 3 * block + 1, 3 * block + 2]
    }

    /// Rows of the complete problem that belong to a sub-assembly: generators between its blocks, and between them
    /// and fixed bodies.
    pub fn rows(&self, blocks: &BlockSet) -> Vec<usize> {
        let inside = |generator: &Generator| generator.wrenches.iter().all(|wrench| blocks.contains(wrench.block));
        (0..self.generators.len()).filter(|&j| inside(&self.generators[j])).collect()
    }

    /// Rows that a block brings along when it joins a sub-assembly.
    pub fn rows_added(&self, blocks: &BlockSet, added: usize) -> Vec<usize> {
        let joins = |&j: &usize| {
            let mut wrenches = self.generators[j].wrenches.iter();
            wrenches.all(|wrench| wrench.block == added || blocks.contains(wrench.block))
        };
        self.generators_on[added].iter().copied().filter(joins).collect()
    }

    /// Movable blocks from the supports upward: by the height of their centroid against gravity, the lower index first
    /// among equals. Heights within rounding of one another count as equal, so that a row of a wall is taken in order.
    pub fn upward(&self) -> Vec<usize> {
        const LEVELS: f64 = 1e9;
        let [gx, gy] = self.gravity;
        let size = gx.hypot(gy);
        let height = |block: usize| {
            let [x, y] = self.body(block).pose.position;
            if size == 0.0 { 0.0 } else { -(x * gx + y * gy) / size }
        };
        let heights: Vec<f64> = (0..self.blocks()).map(height).collect();
        let extent = heights.iter().fold(0.0_f64, |extent, h| extent.max(h.abs())).max(f64::MIN_POSITIVE);
        let mut order: Vec<usize> = (0..self.blocks()).collect();
        order.sort_by_key(|&block| ((heights[block] / extent * LEVELS).round() as i64, block));
        order
    }

    /// Accelerations `M^-1 (F + G f)` of the blocks of a sub-assembly, in the order of the set: m/s^2, m/s^2,
    /// rad/s^2. `f(j)` is the magnitude of generator j, N, zero outside the sub-assembly.
    pub fn accelerations(&self, blocks: &BlockSet, f: impl Fn(usize) -> f64) -> Vec<[f64; 3]> {
        blocks.iter().map(|block| self.acceleration(block, &f)).collect()
    }

    /// Acceleration of one movable block; see [`Self::accelerations`].
    pub fn acceleration(&self, block: usize, f: impl Fn(usize) -> f64) -> [f64; 3] {
        let mut wrench = self.applied(block);
        for &j in &self.generators_on[block] {
            let magnitude = f(j);
            for part in self.generators[j].wrenches.iter().filter(|part| part.block == block) {
                (0..3).for_each(|k| wrench[k] += magnitude * part.value[k]);
            }
        }
        let inverse_mass = self.inverse_mass[block];
        [0, 1, 2].map(|k| wrench[k] * inverse_mass[k])
    }

    /// The force at every contact point that has a generator among `rows` (ascending).
    pub fn contact_forces(&self, rows: &[usize], f: impl Fn(usize) -> f64) -> Vec<ContactForce> {
        let mut forces: Vec<ContactForce> = Vec::new();
        for &j in rows {
            let Generator { contact, direction, .. } = self.generators[j];
            if forces.last().is_none_or(|last| last.contact != contact) {
                forces.push(ContactForce { contact, normal: 0.0, tangential: 0.0, force: [0.0; 2] });
            }
            let [nx, ny] = self.contacts.contacts[contact].normal;
            let [fx, fy] = direction.map(|d| d * f(j));
            if let Some(total) = forces.last_mut() {
                total.normal += fx * nx + fy * ny;
                total.tangential += fy * nx - fx * ny;
                total.force = [total.force[0] + fx, total.force[1] + fy];
            }
        }
        forces
    }
}
