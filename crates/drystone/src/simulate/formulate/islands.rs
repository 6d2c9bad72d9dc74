//! Islands: bodies that can push one another in a step. Between two of them A has no entry.

use crate::simulate::{
    formulate::contact_problem::ContactProblem,
    kinematics::{Kinematics, is_zero},
};

/// The island of every body. Fixed bodies belong to none: nothing is passed on through them.
#[derive(Debug)]
pub struct Islands {
    parent: Vec<usize>,
    movable: Vec<bool>,
}

impl Islands {
    /// Joins the bodies of every contact. `inverse_mass` is zero for fixed bodies.
    pub fn new<S: Kinematics>(contacts: &ContactProblem<S>, inverse_mass: &[S::Velocity]) -> Self {
        let movable = inverse_mass.iter().map(|mass| !is_zero(mass)).collect();
        let mut islands = Self { parent: (0..inverse_mass.len()).collect(), movable };
        for candidate in contacts.candidates() {
            let [a, b] = candidate.id.bodies;
            if islands.movable[a] && islands.movable[b] {
                let (a, b) = (islands.of_body(a), islands.of_body(b));
                islands.parent[a.max(b)] = a.min(b);
            }
        }
        islands
    }

    /// The least body of the island.
    pub fn of_body(&self, mut body: usize) -> usize {
        while self.parent[body] != body {
            body = self.parent[body];
        }
        body
    }

    /// The island that a contact of two bodies belongs to.
    pub fn of(&self, [a, b]: [usize; 2]) -> usize {
        self.of_body(if self.movable[a] { a } else { b })
    }

    /// The contacts of every island with one that is `chosen`, in order.
    pub fn with<S: Kinematics>(&self, contacts: &ContactProblem<S>, chosen: impl Fn(usize) -> bool) -> Vec<Vec<usize>> {
        let mut members = vec![Vec::new(); self.parent.len()];
        let mut wanted = vec![false; self.parent.len()];
        for (k, candidate) in contacts.candidates().iter().enumerate() {
            let island = self.of(candidate.id.bodies);
            members[island].push(k);
            wanted[island] |= chosen(k);
        }
        members.into_iter().zip(wanted).filter_map(|(members, wanted)| wanted.then_some(members)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BodyOptions, Scene, contact::candidates::CandidateFinder, formulate::Cones};

    /// Two columns on one fixed ground, of two blocks and of three, are two islands.
    #[test]
    fn the_ground_joins_nothing() {
        let mut scene = Scene::new([0.0, -9.81], 0.5).unwrap();
        let ground = BodyOptions { fixed: true, ..BodyOptions::default() };
        scene.add_box([0.0, -0.5], [20.0, 1.0], 0.0, ground).unwrap();
        for place in [[0.0, 0.5], [0.0, 1.5], [3.0, 0.5], [3.0, 1.5], [3.0, 2.5]] {
            scene.add_box(place, [1.0, 1.0], 0.0, BodyOptions::default()).unwrap();
        }
        let mut finder = CandidateFinder::default();
        finder.find(&scene, &[[0.0; 3]; 6]);
        let contacts: ContactProblem =
            ContactProblem::new(finder.candidates().copied().collect(), Cones::default(), [0.0, -9.81]);
        let mass: Vec<_> = scene.bodies().iter().map(|body| if body.fixed { [0.0; 3] } else { [1.0; 3] }).collect();
        let islands = Islands::new(&contacts, &mass);
        let sizes: Vec<usize> = islands.with(&contacts, |_| true).iter().map(Vec::len).collect();
        assert_eq!(sizes, [4, 6]);
        let second = islands.with(&contacts, |k| contacts.candidates()[k].id.bodies.contains(&5));
        assert_eq!(second.len(), 1);
        assert!(second[0].iter().all(|&k| islands.of(contacts.candidates()[k].id.bodies) == 3));
    }
}
