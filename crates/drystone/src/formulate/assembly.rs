//! The complete assembly's contact problem. Every sub-assembly's problem is a principal sub-problem of it.

use super::{
    answers::{Acceleration, ContactForce, force_at},
    block_rows::BlockRows,
    block_set::BlockSet,
    cones::{Bound, Cones, FrictionCone, STEEP, cone_edges},
    generator::{Generator, Wrench},
    part::{Assemble, Components, Part},
};
use crate::{
    bounds::FRICTION,
    contact::{Contact, ContactSet},
    error::SceneError,
    geometry::{dot, length},
    interrupt::Tally,
    scene::SceneOf,
    suggest::nearest,
};
use drystone_lcp::{
    Problem,
    cone::{Columns, ConeSolver},
};

/// Operations to make a generator, or to write it down, about.
const GENERATOR: usize = 200;

/// The heaviest block over the lightest from which on forces alone do not tell the accelerations: 64-bit numbers leave 1e-11
/// of a block's own load then, a hundredth of what counts.
const WIDE: f64 = 1e5;

/// Contacts, generators and loads of a scene.
#[derive(Debug, Clone)]
pub struct Assembly {
    bodies: Vec<Part>,
    gravity: [f64; 3],
    /// The acceleration under which masses are weights, m/s^2: that of gravity, or 1 without any.
    weighing: f64,
    cones: Cones,
    /// Components of a block's wrench: three in the plane, six in space.
    components: &'static [usize],
    contacts: ContactSet,
    movable: Vec<usize>,
    /// Mass of the heaviest block, kg: loads count as the mass that would weigh as much.
    heaviest: f64,
    /// Whether some blocks are [`WIDE`] times as heavy as others.
    wide: bool,
    generators: Vec<Generator>,
    /// Axes of the cones of the contacts that have friction, and which of them is a contact's.
    pub(super) axes: Vec<Generator>,
    axis_of: Vec<Option<usize>>,
    /// Generators that act on each movable block.
    generators_on: Vec<Vec<usize>>,
    /// Diagonal of `M^-1`, block after block.
    inverse_mass: Vec<f64>,
    /// Applied wrenches `F`, block after block.
    applied: Vec<f64>,
}

impl Assembly {
    /// Finds the contacts of a scene and their generators, with the default [`Cones`].
    ///
    /// # Errors
    /// [`SceneError::Overlap`] if blocks overlap.
    pub fn new<S: Assemble>(scene: &SceneOf<S>) -> Result<Self, SceneError> {
        Self::with_cones(scene, Cones::default())
    }

    /// [`Self::new`] with a choice of friction cones, which the plane has no need of.
    ///
    /// # Errors
    /// [`SceneError::Overlap`] if blocks overlap; [`SceneError::BadFacets`].
    pub fn with_cones<S: Assemble>(scene: &SceneOf<S>, cones: Cones) -> Result<Self, SceneError> {
        cones.check()?;
        let bodies: Vec<Part> = scene.bodies().iter().map(S::part).collect();
        let movable: Vec<usize> = (0..bodies.len()).filter(|&i| !bodies[i].fixed).collect();
        let components = S::COMPONENTS;
        let picked = |value: Components| components.iter().map(move |&k| value[k]);
        let gravity = S::in_space(scene.gravity());
        let load = |&body: &usize| {
            let [x, y, z] = gravity.map(|g| bodies[body].mass * g);
            let (weight, load) = ([x, y, z, 0.0, 0.0, 0.0], bodies[body].load);
            picked(std::array::from_fn(|k| weight[k] + load[k]))
        };
        let assembly = Self {
            gravity,
            weighing: 1.0,
            cones,
            components,
            contacts: S::contacts(scene)?,
            generators: Vec::new(),
            axes: Vec::new(),
            axis_of: Vec::new(),
            generators_on: vec![Vec::new(); movable.len()],
            inverse_mass: movable.iter().flat_map(|&body| picked(bodies[body].inverse_mass())).collect(),
            applied: movable.iter().flat_map(load).collect(),
            heaviest: 0.0,
            wide: false,
            bodies,
            movable,
        };
        Ok(assembly.weighed().spanned())
    }

    /// The same with more loads: a wrench on each block, in its components.
    pub(crate) fn with_loads(&self, more: impl Fn(usize) -> Components) -> Self {
        let mut loaded = self.clone();
        for (block, &body) in self.movable.iter().enumerate() {
            let wrench = more(block);
            (0..6).for_each(|k| loaded.bodies[body].load[k] += wrench[k]);
            let own = &mut loaded.applied[self.components.len() * block..][..self.components.len()];
            own.iter_mut().zip(self.components).for_each(|(sum, &k)| *sum += wrench[k]);
        }
        loaded.weighed()
    }

    /// The same without any load.
    pub(super) fn unloaded(&self) -> Self {
        let mut alone = self.clone();
        alone.gravity = [0.0; 3];
        alone.bodies.iter_mut().for_each(|body| body.load = [0.0; 6]);
        alone.applied.fill(0.0);
        alone
    }

    /// Weighs the blocks with their loads.
    fn weighed(mut self) -> Self {
        self.weighing = Some(length(self.gravity)).filter(|&gravity| gravity > 0.0).unwrap_or(1.0);
        let burden = |&body: &usize| self.bodies[body].mass + self.bodies[body].load_size() / self.weighing;
        self.heaviest = self.movable.iter().map(burden).fold(0.0, f64::max);
        let masses = || self.movable.iter().map(|&body| self.bodies[body].mass);
        self.wide = masses().fold(0.0, f64::max) > WIDE * masses().fold(f64::INFINITY, f64::min);
        self
    }

    /// Whether 64-bit forces may not tell the accelerations: some blocks are far heavier than others.
    pub(crate) fn is_wide(&self) -> bool {
        self.wide
    }

    /// Adds the generators of the contacts.
    fn spanned(mut self) -> Self {
        let mut block_of = vec![None; self.bodies.len()];
        for (block, &body) in self.movable.iter().enumerate() {
            block_of[body] = Some(block);
        }
        self.axis_of = vec![None; self.contacts.contacts.len()];
        let mut tally = Tally::default();
        for (index, contact) in self.contacts.contacts.iter().enumerate() {
            tally.count(GENERATOR);
            let blocks = contact.bodies.map(|body| block_of[body]);
            let directions = self.directions(contact).into_iter();
            self.generators.extend(directions.map(|direction| Generator::new(index, blocks, direction)));
            // An axis adds no force that the edges do not have, but one number instead of several says that a contact is
            // pressed straight.
            if contact.friction > 0.0 {
                self.axis_of[index] = Some(self.axes.len());
                self.axes.push(Generator::new(index, blocks, contact.normal));
            }
        }
        for (j, generator) in self.generators.iter().enumerate() {
            generator.blocks().for_each(|block| self.generators_on[block].push(j));
        }
        self
    }

    /// Whether the blocks are in the plane.
    pub fn in_plane(&self) -> bool {
        self.components.len() == 3
    }

    /// Whether friction cones of this kind are round here: not in the plane, nor without friction.
    pub(crate) fn is_round(&self, cone: FrictionCone) -> bool {
        cone == FrictionCone::Round && !self.in_plane() && !self.axes.is_empty()
    }

    /// All movable blocks.
    pub(crate) fn every_block(&self) -> BlockSet {
        BlockSet::full(self.blocks())
    }

    /// The friction cones of the forces of what was found to stand within these: Coulomb's, if the pyramids lie within.
    pub(crate) fn cone_of_rest(&self, cone: FrictionCone) -> FrictionCone {
        if self.cones.bound == Bound::Inscribed { FrictionCone::Round } else { cone }
    }

    /// The same contacts with pyramids around their cones.
    pub(crate) fn circumscribed(&self) -> Self {
        let cones = Cones { bound: Bound::Circumscribed, ..self.cones };
        let none = vec![Vec::new(); self.blocks()];
        Self { cones, generators: Vec::new(), axes: Vec::new(), generators_on: none, ..self.clone() }.spanned()
    }

    /// The same contacts with a multiple of their friction.
    pub(crate) fn with_friction(&self, multiple: f64) -> Self {
        let none = vec![Vec::new(); self.blocks()];
        let mut scaled = Self { generators: Vec::new(), axes: Vec::new(), generators_on: none, ..self.clone() };
        let most = FRICTION.most;
        scaled.contacts.contacts.iter_mut().for_each(|c| c.friction = (multiple * c.friction).min(most));
        scaled.spanned()
    }

    /// The directions that span a contact's friction cone: its edges, and its normal where that is of use.
    pub(crate) fn directions(&self, contact: &Contact) -> Vec<[f64; 3]> {
        let [nx, ny, _] = contact.normal;
        let mut directions = match self.in_plane() {
            true => cone_edges([nx, ny], contact.friction).into_iter().map(|[x, y]| [x, y, 0.0]).collect(),
            false => self.cones.edges(contact.normal, contact.friction, self.gravity),
        };
        directions.extend((contact.friction > STEEP).then_some(contact.normal));
        directions
    }

    /// Number of movable blocks.
    pub fn blocks(&self) -> usize {
        self.movable.len()
    }

    /// The body of a movable block.
    pub fn body(&self, block: usize) -> &Part {
        &self.bodies[self.movable[block]]
    }

    /// The movable block of a body, if it moves.
    pub(crate) fn block_of(&self, body: usize) -> Option<usize> {
        self.movable.binary_search(&body).ok()
    }

    /// Index in the scene of a movable block's body.
    pub fn body_index(&self, block: usize) -> usize {
        self.movable[block]
    }

    /// All bodies of the scene, fixed ones too.
    pub fn bodies(&self) -> &[Part] {
        &self.bodies
    }

    /// The movable blocks with these names; fixed bodies are left out, for they are always there.
    ///
    /// # Errors
    /// [`SceneError::UnknownName`].
    pub fn named(&self, names: &[String]) -> Result<Vec<usize>, SceneError> {
        let of = |name: &String| match self.bodies.iter().position(|body| body.name == *name) {
            Some(body) => Ok(self.movable.binary_search(&body).ok()),
            None => {
                let nearest = nearest(name, self.bodies.iter().map(|body| body.name.as_str()));
                Err(SceneError::UnknownName { name: name.clone(), nearest })
            }
        };
        names.iter().filter_map(|name| of(name).transpose()).collect()
    }

    /// m/s^2.
    pub fn gravity(&self) -> [f64; 3] {
        self.gravity
    }

    /// Which of the six [`Components`] a block has, in the order of its rows.
    pub fn components(&self) -> &'static [usize] {
        self.components
    }

    /// Every contact point of the complete assembly.
    pub fn contacts(&self) -> &[Contact] {
        &self.contacts.contacts
    }

    /// Every generator of the complete assembly, in the order of the rows of its problem.
    pub fn generators(&self) -> &[Generator] {
        &self.generators
    }

    /// The wrenches of a generator, one for each movable body of its contact.
    pub fn wrenches(&self, generator: &Generator) -> impl Iterator<Item = Wrench> {
        generator.wrenches(&self.contacts()[generator.contact()], |block| self.body(block))
    }

    /// Generators that act on a movable block, ascending.
    pub fn generators_on(&self, block: usize) -> &[usize] {
        &self.generators_on[block]
    }

    /// Diagonal of `M^-1` of a movable block, in the order of its rows: 1/kg and 1/(kg m^2).
    pub fn inverse_mass(&self, block: usize) -> &[f64] {
        &self.inverse_mass[self.components.len() * block..self.components.len() * (block + 1)]
    }

    /// Applied wrench on a movable block, in the order of its rows: its weight and permanent loads, N and N m.
    pub fn applied(&self, block: usize) -> &[f64] {
        &self.applied[self.components.len() * block..self.components.len() * (block + 1)]
    }

    /// `A = G' M^-1 G` (1/kg) and `b = G' M^-1 F` (m/s^2) of the complete assembly. Equation 8 of Loomis and
    /// Balkcom: a sub-assembly's problem is the principal sub-problem on [`Self::rows`] of its blocks.
    pub fn problem(&self) -> Problem {
        // Weights accelerate all blocks alike, so that b is 0 between two of them: computed by way of the masses it would
        // be rounding, and all there is where everything falls freely.
        let gravity = self.gravity;
        let pull = |generator: &Generator| -> f64 {
            let along = |wrench: Wrench| (0..3).map(|k| wrench.value[k] * gravity[k]).sum::<f64>();
            self.wrenches(generator).map(along).sum()
        };
        let loaded = |wrench: Wrench| -> f64 {
            let (part, inverse) = (self.body(wrench.block), self.inverse_mass(wrench.block));
            let along = self.components.iter().zip(inverse);
            along.map(|(&k, inverse)| wrench.value[k] * part.load[k] * inverse).sum()
        };
        let push = |generator: &Generator| self.wrenches(generator).map(loaded).sum::<f64>();
        let b = match self.bodies.iter().any(|body| body.load != [0.0; 6]) {
            false => self.generators.iter().map(pull).collect(),
            true => self.generators.iter().map(|generator| pull(generator) + push(generator)).collect(),
        };
        Problem::from_generators_and_q(&self.columns(self.generators.iter()), &self.inverse_mass, b)
            .expect("a validated scene has finite masses, positions and directions")
    }

    /// Static equilibrium `G f = -F`, `f >= 0` of the complete assembly, without any block yet. Imbalance is measured in
    /// each block's own weight, moments with its radius of gyration as the arm.
    ///
    /// Beside the generators, whose columns come first, it has the axis of every friction cone, and tries these first:
    /// what stands by straight pressure alone is then held by few forces, and the basis of its columns is far sparser.
    /// [`Self::magnitude`] gives such a force back to the edges.
    pub fn equilibrium(&self) -> ConeSolver {
        let columns = self.columns(self.generators.iter().chain(&self.axes));
        let axes = self.generators.len()..columns.len();
        let mut solver = ConeSolver::new(columns, &self.balance(), &self.balance_units())
            .expect("a validated scene has finite masses, positions and directions")
            .with_own_loads(self.own_loads());
        solver.prefer(axes);
        solver
    }

    /// The acceleration under which masses are weights, m/s^2: that of gravity, or 1 without any.
    pub(crate) fn weighing(&self) -> f64 {
        self.weighing
    }

    /// The acceleration that a block's own loads give it, weight and others, m/s^2: without gravity the weight is that under
    /// 1 m/s^2.
    pub(crate) fn unit_of_acceleration(&self, block: usize) -> f64 {
        self.weighing + self.body(block).load_size() * self.inverse_mass(block)[0]
    }

    /// In which the imbalance of a block is measured: its load for forces, its load times the radius of gyration for
    /// moments.
    pub(crate) fn balance_unit(&self, block: usize) -> impl Iterator<Item = f64> + '_ {
        let inverse = self.inverse_mass(block);
        let weight = self.weighing / inverse[0] + self.body(block).load_size();
        self.components.iter().zip(inverse).map(move |(&k, per_inertia)| match k {
            0..3 => weight,
            _ => weight * (inverse[0] / per_inertia).sqrt(),
        })
    }

    /// The unit of every row of [`Self::equilibrium`]: the block's own load, but for blocks so light beside the heaviest that
    /// pivots on a heavy block's rows would be lost in rounding.
    pub(super) fn balance_units(&self) -> Vec<f64> {
        let of = |block| {
            let load = self.own_load(block);
            self.balance_unit(block).map(move |own| own / load)
        };
        (0..self.blocks()).flat_map(of).collect()
    }

    /// The load of every row's own block, in the unit of the row.
    pub(super) fn own_loads(&self) -> Vec<f64> {
        let of = |block| std::iter::repeat_n(self.own_load(block), self.components.len());
        (0..self.blocks()).flat_map(of).collect()
    }

    /// A block's load in the unit of its rows: one, or less where a block weighs 1e8 times as much.
    fn own_load(&self, block: usize) -> f64 {
        const LIGHTEST: f64 = 1e-8;
        let mass = self.inverse_mass(block)[0].recip() + self.body(block).load_size() / self.weighing;
        (mass / (LIGHTEST * self.heaviest)).min(1.0)
    }

    /// The column of [`Self::equilibrium`] of a contact's axis, if it has one.
    pub(super) fn axis_column(&self, contact: usize) -> Option<usize> {
        Some(self.generators.len() + self.axis_of[contact]?)
    }

    /// The generators of a contact, the first of which is known.
    pub(super) fn generators_of(&self, contact: usize, first: usize) -> std::ops::Range<usize> {
        let own = self.generators[first..].iter().take_while(|generator| generator.contact() == contact);
        first..first + own.count()
    }

    /// Magnitude of a generator in a solution of [`Self::equilibrium`], N.
    pub fn magnitude(&self, solver: &ConeSolver, generator: usize) -> f64 {
        let contact = self.generators[generator].contact();
        let straight = self.axis_of[contact]
            .map_or(0.0, |axis| self.axis_share(generator) * solver.f(self.generators.len() + axis));
        solver.f(generator) + straight
    }

    /// What a force of one newton along the axis of its contact is in a generator, newtons.
    fn axis_share(&self, generator: usize) -> f64 {
        let direction = self.generators[generator].direction;
        let Contact { friction, normal, .. } = self.contacts()[self.generators[generator].contact()];
        match () {
            _ if friction > STEEP => f64::from(direction == normal),
            _ if self.in_plane() => 0.5 * friction.hypot(1.0),
            _ => self.cones.axis_share(friction),
        }
    }

    /// Generators as the columns of G.
    fn columns<'a>(&self, generators: impl Iterator<Item = &'a Generator>) -> Columns {
        let (indptr, indices, data) = self.compressed(generators);
        Columns::new(self.applied.len(), &indptr, &indices, &data)
            .expect("a validated scene has finite masses, positions and directions")
    }

    /// Generators as compressed columns: where each begins, and the rows and the values of all.
    pub(super) fn compressed<'a>(
        &self,
        generators: impl Iterator<Item = &'a Generator>,
    ) -> (Vec<usize>, Vec<usize>, Vec<f64>) {
        let count = generators.size_hint().0;
        let entries = 2 * self.components.len() * count;
        let (mut indptr, mut indices) = (Vec::with_capacity(count + 1), Vec::with_capacity(entries));
        let mut data = Vec::with_capacity(entries);
        indptr.push(0);
        let mut tally = Tally::default();
        for generator in generators {
            tally.count(GENERATOR);
            for wrench in self.wrenches(generator) {
                let first = self.components.len() * wrench.block;
                let entries = self.components.iter().map(|&k| wrench.value[k]).enumerate();
                for (row, value) in entries.filter(|&(_, value)| value != 0.0) {
                    indices.push(first + row);
                    data.push(value);
                }
            }
            indptr.push(indices.len());
        }
        (indptr, indices, data)
    }

    /// What the contact forces have to balance: `-F`.
    pub(super) fn balance(&self) -> Vec<f64> {
        self.applied.iter().map(|load| -load).collect()
    }

    /// Rows of [`Self::equilibrium`] by block.
    pub fn equilibrium_rows(&self) -> BlockRows {
        BlockRows::of_components(self.components, self.blocks())
    }

    /// Rows of the complete problem that belong to a sub-assembly: generators between its blocks, and between them
    /// and fixed bodies.
    pub fn rows(&self, blocks: &BlockSet) -> Vec<usize> {
        let inside = |generator: &Generator| generator.blocks().all(|block| blocks.contains(block));
        (0..self.generators.len()).filter(|&j| inside(&self.generators[j])).collect()
    }

    /// Rows that a block brings along when it joins a sub-assembly.
    pub fn rows_added(&self, blocks: &BlockSet, added: usize) -> Vec<usize> {
        let joins = |&j: &usize| self.generators[j].blocks().all(|block| block == added || blocks.contains(block));
        self.generators_on[added].iter().copied().filter(joins).collect()
    }

    /// Movable blocks from the supports upward: by the height of their centre of mass against gravity, the lower index first
    /// among equals. Heights within rounding of one another count as equal, so that a row of a wall is taken in order.
    pub fn upward(&self) -> Vec<usize> {
        const LEVELS: f64 = 1e9;
        let size = length(self.gravity);
        let height = |block: usize| match size {
            0.0 => 0.0,
            size => -dot(self.body(block).center, self.gravity) / size,
        };
        let heights: Vec<f64> = (0..self.blocks()).map(height).collect();
        let extent = heights.iter().fold(0.0_f64, |extent, h| extent.max(h.abs())).max(f64::MIN_POSITIVE);
        let mut order: Vec<usize> = (0..self.blocks()).collect();
        order.sort_by_key(|&block| ((heights[block] / extent * LEVELS).round() as i64, block));
        order
    }

    /// Accelerations `M^-1 (F + G f)` of the blocks of a sub-assembly, in the order of the set. `f(j)` is the magnitude of
    /// generator j, N, zero outside the sub-assembly.
    pub fn accelerations(&self, blocks: &BlockSet, f: impl Fn(usize) -> f64) -> Vec<Acceleration> {
        blocks.iter().map(|block| self.in_world(block, self.acceleration(block, &f))).collect()
    }

    /// What [`Self::acceleration`] gives for a block, in world axes.
    pub(crate) fn in_world(&self, block: usize, [x, y, z, turning @ ..]: Components) -> Acceleration {
        Acceleration { linear: [x, y, z], angular: self.body(block).in_world(turning) }
    }

    /// Acceleration of one movable block, turning about its principal axes; see [`Self::accelerations`].
    pub fn acceleration(&self, block: usize, f: impl Fn(usize) -> f64) -> Components {
        let mut wrench = [0.0; 6];
        self.components.iter().zip(self.applied(block)).for_each(|(&k, load)| wrench[k] = *load);
        for &j in &self.generators_on[block] {
            let magnitude = f(j);
            if magnitude == 0.0 {
                continue; // most are
            }
            for part in self.wrenches(&self.generators[j]).filter(|part| part.block == block) {
                self.components.iter().for_each(|&k| wrench[k] += magnitude * part.value[k]);
            }
        }
        self.components.iter().zip(self.inverse_mass(block)).for_each(|(&k, inverse)| wrench[k] *= inverse);
        wrench
    }

    /// A normal force at a contact point, N.
    pub(crate) fn normal_force(&self, contact: usize, size: f64) -> ContactForce {
        let normal = self.contacts()[contact].normal;
        force_at(contact, normal, self.in_plane(), normal.map(|n| size * n))
    }

    /// The force at every contact point that has a generator among `rows` (ascending).
    pub fn contact_forces(&self, rows: &[usize], f: impl Fn(usize) -> f64) -> Vec<ContactForce> {
        let mut forces: Vec<ContactForce> = Vec::with_capacity(rows.len());
        let complete =
            |contact: usize, force| force_at(contact, self.contacts()[contact].normal, self.in_plane(), force);
        let mut at: Option<(usize, [f64; 3])> = None;
        for &j in rows {
            let (contact, direction) = (self.generators[j].contact(), self.generators[j].direction);
            match &mut at {
                Some((same, sum)) if *same == contact => (0..3).for_each(|k| sum[k] += direction[k] * f(j)),
                other => {
                    let new = (contact, direction.map(|d| d * f(j)));
                    forces.extend(other.replace(new).map(|(contact, force)| complete(contact, force)));
                }
            }
        }
        forces.extend(at.map(|(contact, force)| complete(contact, force)));
        forces
    }
}
