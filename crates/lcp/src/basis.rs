//! The active set: which `z` are basic. Index and position live in one type, so they cannot drift apart.

/// A subset of 0..n with constant-time insertion, removal and membership, iterated in a deterministic order.
#[derive(Debug, Clone, Default)]
pub(crate) struct Basis {
    members: Vec<usize>,
    place: Vec<usize>,
}

const OUT: usize = usize::MAX;

impl Basis {
    pub fn new(n: usize) -> Self {
        Self { members: Vec::new(), place: vec![OUT; n] }
    }

    pub fn members(&self) -> &[usize] {
        &self.members
    }

    pub fn contains(&self, i: usize) -> bool {
        self.place[i] != OUT
    }

    pub fn insert(&mut self, i: usize) {
        if !self.contains(i) {
            self.place[i] = self.members.len();
            self.members.push(i);
        }
    }

    pub fn remove(&mut self, i: usize) {
        let place = std::mem::replace(&mut self.place[i], OUT);
        if place != OUT {
            self.members.swap_remove(place);
            if let Some(&moved) = self.members.get(place) {
                self.place[moved] = place;
            }
        }
    }

    pub fn clear(&mut self) {
        for &i in &self.members {
            self.place[i] = OUT;
        }
        self.members.clear();
    }
}
