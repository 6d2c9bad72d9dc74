//! A dense vector that knows where it is not zero.

use serde::{Deserialize, Serialize};

/// Values of all entries, and a list of those that may differ from zero. Clearing costs only the listed ones.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct SparseVector {
    value: Vec<f64>,
    listed: Vec<bool>,
    index: Vec<u32>,
}

impl SparseVector {
    pub fn zero(n: usize) -> Self {
        Self { value: vec![0.0; n], listed: vec![false; n], index: Vec::new() }
    }

    /// Becomes the zero vector of another length.
    pub fn resize(&mut self, n: usize) {
        self.clear();
        self.value.resize(n, 0.0);
        self.listed.resize(n, false);
    }

    pub fn get(&self, i: u32) -> f64 {
        self.value[i as usize]
    }

    /// Overwrites a listed entry.
    pub fn set(&mut self, i: u32, value: f64) {
        self.list(i);
        self.value[i as usize] = value;
    }

    pub fn add(&mut self, i: u32, amount: f64) {
        self.list(i);
        self.value[i as usize] += amount;
    }

    /// Lists an entry; true if it was not listed before.
    pub fn list(&mut self, i: u32) -> bool {
        let new = !std::mem::replace(&mut self.listed[i as usize], true);
        if new {
            self.index.push(i);
        }
        new
    }

    pub fn index(&self) -> &[u32] {
        &self.index
    }

    pub fn iter(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        self.index.iter().map(|&i| (i, self.value[i as usize]))
    }

    /// Largest absolute value.
    pub fn largest(&self) -> f64 {
        self.iter().fold(0.0, |largest, (_, value)| if value.abs() > largest { value.abs() } else { largest })
    }

    pub fn clear(&mut self) {
        for i in self.index.drain(..) {
            self.value[i as usize] = 0.0;
            self.listed[i as usize] = false;
        }
    }
}
