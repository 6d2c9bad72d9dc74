//! The equilibrium solver on random walks: rows come, go, and are rolled back, verdicts are asked for with and without
//! forces, and every answer is compared with a fresh one.

use drystone::{
    formulate::Assembly,
    scene::Scene,
    scenes::{arch, column, diamond, five_blocks, inverted_triangle, pyramid, random_stack, wall},
};
use drystone_lcp::cone::{ConeSolver, Mark, Membership};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

/// A state to come back to, with the blocks that were there.
struct Kept {
    mark: Mark,
    blocks: Vec<usize>,
    forces: Vec<f64>,
}

struct Walk<'a> {
    assembly: &'a Assembly,
    solver: ConeSolver,
    blocks: Vec<usize>,
    kept: Vec<Kept>,
    /// Answers that it falls and that it stands.
    seen: [usize; 2],
    /// States whose values were to come back from memory.
    remembered: usize,
}

impl<'a> Walk<'a> {
    fn new(assembly: &'a Assembly) -> Self {
        let mut solver = assembly.equilibrium();
        let kept = vec![Kept { mark: solver.mark(), blocks: Vec::new(), forces: forces(&solver) }];
        Self { assembly, solver, blocks: Vec::new(), kept, seen: [0; 2], remembered: 0 }
    }

    fn step(&mut self, random: &mut Pcg64) {
        match random.random_range(0..20) {
            0 | 1 => self.remove(random),
            2 => self.roll_back(random),
            3..8 => self.keep(),
            _ => self.add(random),
        }
    }

    /// Mostly a block that touches what is there, so that things get high; sometimes two at once.
    fn add(&mut self, random: &mut Pcg64) {
        for _ in 0..random.random_range(1..=2) {
            let order = self.assembly.upward();
            let missing: Vec<usize> = order.into_iter().filter(|block| !self.blocks.contains(block)).collect();
            if missing.is_empty() {
                return;
            }
            let within = if random.random_range(0..5) > 0 { missing.len().min(3) } else { missing.len() };
            let added = missing[random.random_range(0..within)];
            self.solver.add_rows(self.assembly.equilibrium_rows().of(added));
            self.blocks.push(added);
        }
        let stands = self.ask(random.random_range(0..3) == 0);
        if !stands && random.random_range(0..4) > 0 {
            let Some(last) = self.blocks.pop() else { return };
            self.solver.remove_rows(self.assembly.equilibrium_rows().of(last));
        }
    }

    fn remove(&mut self, random: &mut Pcg64) {
        for _ in 0..random.random_range(1..=3).min(self.blocks.len()) {
            let from = if random.random_range(0..2) == 0 { 0 } else { self.blocks.len() - 1 };
            let gone = self.blocks.remove(random.random_range(from..self.blocks.len()));
            self.solver.remove_rows(self.assembly.equilibrium_rows().of(gone));
        }
        self.ask(random.random_range(0..2) == 0);
    }

    fn keep(&mut self) {
        let mark = self.solver.mark();
        self.kept.push(Kept { mark, blocks: self.blocks.clone(), forces: forces(&self.solver) });
    }

    /// To the last mark or to one before it; later ones are void. What is remembered comes back bit for bit.
    fn roll_back(&mut self, random: &mut Pcg64) {
        let back = random.random_range(0..self.kept.len().min(3));
        self.kept.truncate(self.kept.len() - back);
        if let Some(last) = self.kept.last() {
            let remembers = self.solver.remembers(last.mark);
            self.solver.roll_back(last.mark);
            if remembers {
                assert_eq!(forces(&self.solver), last.forces);
                self.remembered += 1;
            }
            self.blocks.clone_from(&last.blocks);
        }
        self.ask(random.random_range(0..2) == 0);
    }

    /// The verdict, compared with a fresh solver's; and the forces, if wanted, with the loads.
    fn ask(&mut self, forces: bool) -> bool {
        let found = if forces { self.solver.solve() } else { self.solver.decide() };
        let mut fresh = self.assembly.equilibrium();
        for &block in &self.blocks {
            fresh.add_rows(self.assembly.equilibrium_rows().of(block));
        }
        assert_eq!(found, fresh.solve(), "{:?}", self.blocks);
        let stands = found == Membership::Inside;
        if stands && forces {
            assert!(self.solver.residual() <= 1e-9);
            self.balances();
        }
        self.seen[usize::from(stands)] += 1;
        stands
    }

    /// No force pulls, and every block is at rest to a billionth of gravity.
    fn balances(&self) {
        let inside = |j: usize| self.assembly.generators()[j].blocks().all(|block| self.blocks.contains(&block));
        let f = |j: usize| {
            let force = self.assembly.magnitude(&self.solver, j);
            assert!(force >= 0.0 && (inside(j) || force == 0.0), "force {force} on generator {j}");
            force
        };
        for &block in &self.blocks {
            let [ax, ay, _, _, _, alpha] = self.assembly.acceleration(block, f);
            assert!(ax.hypot(ay).max(alpha.abs()) <= 1e-7, "block {block}: {ax} {ay} {alpha}");
        }
    }
}

/// Every force as it is at the moment, up to date or not.
fn forces(solver: &ConeSolver) -> Vec<f64> {
    (0..solver.columns()).map(|j| solver.f(j)).collect()
}

fn scenes() -> Vec<Scene> {
    let mut scenes = vec![
        column(12, 0.0).unwrap(),
        pyramid(5, 0.0).unwrap(),
        pyramid(6, 0.5).unwrap(),
        wall(5, 4, 0, 0.6).unwrap(),
        wall(5, 4, 3, 0.0).unwrap(),
        arch(9, 0.25, 0.7).unwrap(),
        arch(15, 0.15, 0.5).unwrap(),
        five_blocks(0.3).unwrap(),
        diamond(3, 0.0).unwrap(),
        diamond(3, 0.4).unwrap(),
        inverted_triangle(3, 0.5).unwrap(),
    ];
    for seed in 0..8 {
        scenes.push(random_stack(20, seed, if seed % 2 == 0 { 0.0 } else { 0.4 }).unwrap());
    }
    scenes
}

#[test]
fn every_answer_of_a_walk_is_that_of_a_fresh_solver() {
    let (mut seen, mut remembered) = ([0; 2], 0);
    for (seed, scene) in (0..3).flat_map(|seed| scenes().into_iter().map(move |scene| (seed, scene))) {
        let mut random = Pcg64::seed_from_u64(seed);
        let assembly = Assembly::new(&scene).unwrap();
        let mut walk = Walk::new(&assembly);
        for _ in 0..400 {
            walk.step(&mut random);
        }
        (seen[0], seen[1]) = (seen[0] + walk.seen[0], seen[1] + walk.seen[1]);
        remembered += walk.remembered;
    }
    assert!(seen.iter().all(|&count| count > 500), "falling and standing: {seen:?}");
    assert!(remembered > 300, "{remembered}");
}

/// Putting a block on what stands firm costs the same however high the structure is (the bearing lemma); asking for all forces
/// then costs a pass over them.
#[test]
fn a_verdict_on_one_block_more_does_not_walk_to_the_ground() {
    let visits = |n: usize, forces: bool| {
        let assembly = Assembly::new(&column(n, 0.0).unwrap()).unwrap();
        let mut solver = assembly.equilibrium();
        for block in assembly.upward() {
            solver.add_rows(assembly.equilibrium_rows().of(block));
            let found = if forces { solver.solve() } else { solver.decide() };
            assert_eq!(found, Membership::Inside);
        }
        assert_eq!(solver.solve(), Membership::Inside);
        assert!(solver.residual() <= 1e-9);
        solver.counts().entries_solved
    };
    let growth = |forces| visits(4000, forces) as f64 / visits(1000, forces) as f64;
    assert!(growth(false) < 5.0, "without forces {}", growth(false));
    assert!(growth(true) > 12.0, "with forces {}", growth(true));
}
