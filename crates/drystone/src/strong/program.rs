//! The linear relaxation of the contact laws in a branch.
//!
//! ```text
//! a - J' f = F,   -r <= a_k <= r,   a_n >= 0,   a_t = u+ - u-,   f = (n + mu t) e+ + (n - mu t) e-
//! a' F - sum mu N+ u+ + N- u- >= 0                                                     (2)
//! ```
//!
//! and the same with turned loads (`turned.rs`); with a, f, e and u not negative but a, and N what is known of the least normal force of a face where it slides. What a branch has
//! settled takes columns out: e of a point without force, one of the two e of a face that slides, u of a way in which none
//! slides; a_n = 0 is a row without slack.

use super::{branch::Branch, chains::bearings, hinges::Turned, laws::Laws, turned::virial};
use drystone_lcp::cone::{Columns, ConeSolver, Greatest, Membership};

/// What a program is to find.
#[derive(Clone, Copy)]
pub(super) enum Objective<'a> {
    /// The most power of the loads beyond what friction is known to take: the left side of (2).
    Power,
    /// The least normal force of some faces together.
    Bearing(&'a [usize]),
    /// By how much the second of two faces slides faster along the tangent than the first, at least.
    Lead([usize; 2]),
    /// The least virial of the forces on a block, times one or minus one.
    Virial(usize, f64),
}

/// How a program ended.
pub(super) enum Answer {
    /// There is no solution in this branch.
    None,
    /// The optimum.
    Best(f64, Found),
    /// Pivots or digits did not suffice.
    Unknown,
}

/// Where the optimum is.
pub(super) struct Found {
    /// Accelerations.
    pub a: Vec<f64>,
    /// Along the normal and the tangent, at each point.
    pub forces: Vec<[f64; 2]>,
    /// Columns of the basis, as [`Branch::basis`] has them.
    pub basis: Vec<usize>,
}

/// Most effort ([`ConeSolver::effort`]) for a row: some hundred times what a program usually takes.
const EFFORT: usize = 100_000;

/// Columns of all programs by their kind, so that a basis of one means the same in another.
struct Layout {
    size: usize,
    points: usize,
    faces: usize,
    /// Of the row of turned loads.
    blocks: usize,
    hinges: usize,
}

impl Layout {
    fn of(laws: &Laws) -> Self {
        let (size, hinges) = (laws.size(), laws.turned.as_ref().map_or(0, |turned| turned.hinges.len()));
        Self { size, points: laws.points.len(), faces: laws.faces.len(), blocks: size / 3, hinges }
    }
    /// The positive and the negative part of an acceleration.
    fn acceleration(&self, k: usize, side: usize) -> usize {
        2 * k + side
    }
    fn room(&self, k: usize) -> usize {
        2 * self.size + k
    }
    fn edge(&self, point: usize, edge: usize) -> usize {
        3 * self.size + 2 * point + edge
    }
    fn parting(&self, point: usize) -> usize {
        3 * self.size + 2 * self.points + point
    }
    fn sliding(&self, face: usize, way: usize) -> usize {
        3 * self.size + 3 * self.points + 2 * face + way
    }
    fn surplus(&self) -> usize {
        3 * self.size + 3 * self.points + 2 * self.faces
    }
    fn turning(&self, block: usize, side: usize) -> usize {
        self.surplus() + 1 + 2 * block + side
    }
    fn at_hinge(&self, hinge: usize, side: usize) -> usize {
        self.surplus() + 1 + 2 * self.blocks + 2 * hinge + side
    }
    fn turned_surplus(&self) -> usize {
        self.surplus() + 1 + 2 * self.blocks + 2 * self.hinges
    }
    // Rows.
    fn box_row(&self, k: usize) -> usize {
        self.size + k
    }
    fn normal_row(&self, point: usize) -> usize {
        2 * self.size + point
    }
    fn tangent_row(&self, face: usize) -> usize {
        2 * self.size + self.points + face
    }
    fn power_row(&self) -> usize {
        2 * self.size + self.points + self.faces
    }
    fn turned_row(&self) -> usize {
        self.power_row() + 1
    }
    fn hinge_row(&self, hinge: usize, side: usize) -> usize {
        self.turned_row() + 1 + 2 * hinge + side
    }
    /// That of the objective, the last if it is not the power.
    fn objective_row(&self, turned: bool) -> usize {
        if turned { self.hinge_row(self.hinges, 0) } else { self.power_row() + 1 }
    }
}

/// The row of turned loads, once virials are known.
fn turned_of<'a>(laws: &'a Laws<'_>, branch: &Branch) -> Option<&'a Turned> {
    laws.turned.as_ref().filter(|_| !branch.virials.is_empty())
}

/// Columns of one program, with the name that each has in all of them.
#[derive(Default)]
struct Writer {
    names: Vec<usize>,
    starts: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
}

impl Writer {
    fn column(&mut self, name: usize, entries: impl IntoIterator<Item = (usize, f64)>) {
        self.names.push(name);
        self.starts.push(self.rows.len());
        for (row, value) in entries.into_iter().filter(|entry| entry.1 != 0.0) {
            self.rows.push(row);
            self.values.push(value);
        }
    }
}

/// Solves the program of a branch from its basis, with no more than some effort: that which it took, and the answer.
pub(super) fn solve(laws: &Laws, branch: &Branch, objective: Objective<'_>, most: usize) -> (usize, Answer) {
    let layout = Layout::of(laws);
    let turned = turned_of(laws, branch).is_some();
    let rows = layout.objective_row(turned) + usize::from(!matches!(objective, Objective::Power));
    let columns = columns(laws, branch, objective, &layout);
    let mut h = vec![0.0; rows];
    h[..layout.size].copy_from_slice(&laws.load);
    let mut unit = vec![1.0; rows];
    for k in 0..layout.size {
        (h[layout.box_row(k)], unit[layout.box_row(k)]) = (branch.radius, branch.radius);
    }
    let Writer { names, mut starts, rows: indices, values } = columns;
    starts.push(indices.len());
    let written = indices.len();
    let Ok(mut solver) = Columns::new(rows, &starts, &indices, &values).and_then(|g| ConeSolver::new(g, &h, &unit))
    else {
        return (written, Answer::Unknown);
    };
    solver.only_in_64_bits();
    solver.limit_effort(most.min(EFFORT * rows));
    let sought = match objective {
        Objective::Power if turned => vec![(layout.power_row(), -1.0), (layout.turned_row(), -1.0)],
        Objective::Power => vec![(layout.power_row(), -1.0)],
        _ => vec![(layout.objective_row(turned), 1.0)],
    };
    let Ok(load) = solver.add_load(&sought) else { return (written, Answer::Unknown) };
    solver.add_rows(&(0..rows).collect::<Vec<_>>());
    let mut place = vec![usize::MAX; layout.turned_surplus() + 1];
    names.iter().enumerate().for_each(|(column, &name)| place[name] = column);
    solver.start_from(branch.basis.iter().map(|&name| place[name]).filter(|&column| column != usize::MAX));
    let answer = match solver.solve() {
        Membership::Inside => match solver.greatest(load) {
            Greatest::Limited(value) => {
                let best = if matches!(objective, Objective::Power) { value } else { -value };
                Answer::Best(best, found(laws, &layout, &solver, &names, &place))
            }
            _ => Answer::Unknown,
        },
        Membership::Outside => Answer::None,
        _ => Answer::Unknown,
    };
    (written + solver.effort(), answer)
}

fn columns(laws: &Laws, branch: &Branch, objective: Objective<'_>, layout: &Layout) -> Writer {
    let (bearings, turned) = (bearings(laws, branch), turned_of(laws, branch));
    let (size, objective_row) = (layout.size, layout.objective_row(turned.is_some()));
    let mut own: Vec<Vec<(usize, f64)>> = vec![Vec::new(); size];
    for (k, entries) in own.iter_mut().enumerate() {
        entries.push((k, 1.0));
    }
    for (index, point) in laws.points.iter().enumerate() {
        point.normal.iter().for_each(|&(k, value)| own[k].push((layout.normal_row(index), value)));
    }
    for (index, face) in laws.faces.iter().enumerate() {
        let tangent = &laws.points[face.points[0]].tangent;
        tangent.iter().for_each(|&(k, value)| own[k].push((layout.tangent_row(index), value)));
    }
    (0..size).for_each(|k| own[k].push((layout.power_row(), laws.load[k])));
    if let Some(turned) = turned {
        turn_accelerations(laws, turned, layout, &mut own);
    }
    if let Objective::Lead(faces) = objective {
        for (face, sign) in faces.into_iter().zip([-1.0, 1.0]) {
            let tangent = &laws.points[laws.faces[face].points[0]].tangent;
            tangent.iter().for_each(|&(k, value)| own[k].push((objective_row, sign * value)));
        }
        own.iter_mut().for_each(|entries| *entries = summed(entries.iter().copied()));
    }
    let mut writer = Writer::default();
    for (k, entries) in own.iter().enumerate() {
        for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
            let signed = entries.iter().map(move |&(row, value)| (row, sign * value));
            writer.column(layout.acceleration(k, side), signed.chain([(layout.box_row(k), 1.0)]));
        }
        writer.column(layout.room(k), [(layout.box_row(k), 1.0)]);
    }
    let mut face_of = vec![None; laws.points.len()];
    for (index, face) in laws.faces.iter().enumerate() {
        face.points.iter().for_each(|&point| face_of[point] = Some(index));
    }
    for (index, point) in laws.points.iter().enumerate() {
        for (edge, sign) in [1.0, -1.0].into_iter().enumerate() {
            let out = branch.no_force[index] || face_of[index].map_or(edge == 1, |face| branch.no_edge[face][edge]);
            if !out {
                let normal = point.normal.iter().map(|&(k, value)| (k, -value));
                let slope = sign * point.friction;
                let tangent = point.tangent.iter().map(move |&(k, value)| (k, -slope * value));
                let counted = match objective {
                    Objective::Bearing(faces) if face_of[index].is_some_and(|face| faces.contains(&face)) => 1.0,
                    Objective::Virial(block, factor) => {
                        let [along, across] = virial(laws, index, block);
                        factor * (along + slope * across)
                    }
                    _ => 0.0,
                };
                let counted = Some((objective_row, counted));
                writer.column(layout.edge(index, edge), summed(normal.chain(tangent)).into_iter().chain(counted));
            }
        }
    }
    for index in (0..laws.points.len()).filter(|&index| !branch.no_parting[index]) {
        writer.column(layout.parting(index), [(layout.normal_row(index), -1.0)]);
    }
    for (index, face) in laws.faces.iter().enumerate() {
        for (way, sign) in [-1.0, 1.0].into_iter().enumerate() {
            if !branch.no_sliding[index][way] {
                let bears = bearings[index][way];
                let entries = [(layout.tangent_row(index), sign), (layout.power_row(), -face.friction * bears)];
                // The sign in that row is the other one: what slides along the tangent takes it from the row's balance.
                let left = turned.map(|turned| (layout.turned_row(), -(face.friction + sign * turned.factor) * bears));
                writer.column(layout.sliding(index, way), entries.into_iter().chain(left));
            }
        }
    }
    if turned.is_some() || !matches!(objective, Objective::Power) {
        writer.column(layout.surplus(), [(layout.power_row(), -1.0)]);
    }
    if let Some(turned) = turned {
        turning_columns(branch, turned, layout, &mut writer);
    }
    writer
}

/// Entries of the accelerations in the row of turned loads, and of the partings at hinges.
fn turn_accelerations(laws: &Laws, turned: &Turned, layout: &Layout, own: &mut [Vec<(usize, f64)>]) {
    for (k, entries) in own.iter_mut().enumerate() {
        entries.push((layout.turned_row(), turned.load(laws, k)));
    }
    for (index, hinge) in turned.hinges.iter().enumerate() {
        for (side, &end) in hinge.ends.iter().enumerate() {
            for &(k, value) in &laws.points[end].normal {
                own[k].push((layout.hinge_row(index, side), -value / hinge.width));
            }
        }
    }
}

/// What turnings are at most each way: the parting at any of the block's hinges over its width, and the turning below.
fn turning_columns(branch: &Branch, turned: &Turned, layout: &Layout, writer: &mut Writer) {
    let mut at: Vec<Vec<(usize, f64)>> = vec![Vec::new(); layout.blocks];
    for (index, hinge) in turned.hinges.iter().enumerate() {
        at[hinge.block].push((index, 1.0));
        hinge.below.into_iter().for_each(|(below, ratio)| at[below].push((index, -ratio)));
    }
    for (block, hinges) in at.iter().enumerate() {
        let gains = turned.gains(branch, block);
        for (side, gain) in gains.into_iter().enumerate() {
            let bounds = hinges.iter().map(|&(hinge, value)| (layout.hinge_row(hinge, side), value));
            writer.column(layout.turning(block, side), [(layout.turned_row(), gain)].into_iter().chain(bounds));
        }
    }
    for hinge in 0..layout.hinges {
        for side in 0..2 {
            writer.column(layout.at_hinge(hinge, side), [(layout.hinge_row(hinge, side), 1.0)]);
        }
    }
    writer.column(layout.turned_surplus(), [(layout.turned_row(), -1.0)]);
}

/// One entry a row.
fn summed(entries: impl Iterator<Item = (usize, f64)>) -> Vec<(usize, f64)> {
    let mut all: Vec<(usize, f64)> = entries.collect();
    all.sort_by_key(|entry| entry.0);
    all.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        kept.1 += if same { next.1 } else { 0.0 };
        same
    });
    all
}

fn found(laws: &Laws, layout: &Layout, solver: &ConeSolver, names: &[usize], place: &[usize]) -> Found {
    let value = |name: usize| place.get(name).filter(|&&column| column != usize::MAX).map_or(0.0, |&c| solver.f(c));
    let a = (0..layout.size).map(|k| value(layout.acceleration(k, 0)) - value(layout.acceleration(k, 1))).collect();
    let force = |(index, point): (usize, &super::laws::Point)| {
        let [plus, minus] = [0, 1].map(|edge| value(layout.edge(index, edge)));
        [plus + minus, point.friction * (plus - minus)]
    };
    Found {
        a,
        forces: laws.points.iter().enumerate().map(force).collect(),
        basis: solver.basic_columns().filter_map(|column| names.get(column).copied()).collect(),
    }
}
