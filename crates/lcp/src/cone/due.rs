//! Row operations or stages still to be dealt with, in the order of their numbers.

use serde::{Deserialize, Serialize};
use std::ops::Range;

/// A set of numbers that is emptied from one end while more are added on the way; bits, because a row of a large
/// structure is read by many operations.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Due {
    words: Vec<u64>,
    /// No bit is set outside these words.
    span: Range<usize>,
}

impl Due {
    /// Makes room for the numbers below `count`. The set must be empty, as it is after a walk to the end.
    pub fn reset(&mut self, count: usize) {
        self.words.resize(count.div_ceil(64), 0);
        self.span = self.words.len()..0;
    }

    /// Adds a number.
    pub fn insert(&mut self, number: u32) {
        let word = number as usize / 64;
        self.words[word] |= 1 << (number % 64);
        self.span = self.span.start.min(word)..self.span.end.max(word + 1);
    }

    /// Adds several numbers.
    pub fn insert_all(&mut self, numbers: &[u32]) {
        numbers.iter().for_each(|&number| self.insert(number));
    }

    /// From the least number upward; what is added on the way must be larger than what was taken last.
    pub fn upward(&mut self) -> Upward<'_> {
        let at = self.span.start;
        let bits = self.words.get_mut(at).map_or(0, std::mem::take);
        Upward { words: &mut self.words, end: self.span.end, at, bits }
    }

    /// From the largest number downward; what is added on the way must be less than what was taken last.
    pub fn downward(&mut self) -> Downward<'_> {
        let at = self.span.end.saturating_sub(1);
        let bits = self.words.get_mut(at).map_or(0, std::mem::take);
        Downward { words: &mut self.words, start: self.span.start, at, bits }
    }
}

/// A walk through a [`Due`] from its least number. The word that the walk is at stands apart, in a register.
#[derive(Debug)]
pub(super) struct Upward<'a> {
    words: &'a mut [u64],
    end: usize,
    at: usize,
    bits: u64,
}

impl Upward<'_> {
    /// Takes the next number out.
    pub fn take(&mut self) -> Option<u32> {
        while self.bits == 0 {
            self.at += 1;
            if self.at >= self.end {
                return None;
            }
            self.bits = std::mem::take(&mut self.words[self.at]);
        }
        let bit = self.bits.trailing_zeros();
        self.bits &= self.bits - 1;
        Some(64 * self.at as u32 + bit)
    }

    /// Adds a number.
    pub fn insert(&mut self, number: u32) {
        let (word, bit) = (number as usize / 64, 1 << (number % 64));
        if word == self.at {
            self.bits |= bit;
        } else {
            self.words[word] |= bit;
            self.end = self.end.max(word + 1);
        }
    }

    /// Adds those of some ascending numbers that are larger than `last`.
    pub fn insert_after(&mut self, last: u32, numbers: &[u32]) {
        let from = numbers.partition_point(|&number| number <= last);
        numbers[from..].iter().for_each(|&number| self.insert(number));
    }
}

/// A walk through a [`Due`] from its largest number.
#[derive(Debug)]
pub(super) struct Downward<'a> {
    words: &'a mut [u64],
    start: usize,
    at: usize,
    bits: u64,
}

impl Downward<'_> {
    /// Takes the next number out.
    pub fn take(&mut self) -> Option<u32> {
        while self.bits == 0 {
            if self.at <= self.start {
                return None;
            }
            self.at -= 1;
            self.bits = std::mem::take(&mut self.words[self.at]);
        }
        let bit = 63 - self.bits.leading_zeros();
        self.bits ^= 1 << bit;
        Some(64 * self.at as u32 + bit)
    }

    /// Adds a number.
    pub fn insert(&mut self, number: u32) {
        let (word, bit) = (number as usize / 64, 1 << (number % 64));
        if word == self.at {
            self.bits |= bit;
        } else {
            self.words[word] |= bit;
            self.start = self.start.min(word);
        }
    }

    /// Adds those of some ascending numbers that are less than `last`.
    pub fn insert_before(&mut self, last: u32, numbers: &[u32]) {
        numbers.iter().take_while(|&&number| number < last).for_each(|&number| self.insert(number));
    }
}

#[cfg(test)]
mod tests {
    use super::Due;

    #[test]
    fn numbers_come_out_in_order_from_either_end_whatever_is_added_on_the_way() {
        let mut due = Due::default();
        due.reset(200);
        due.insert_all(&[3, 64, 70, 199]);
        let mut upward = due.upward();
        assert_eq!(upward.take(), Some(3));
        upward.insert_after(3, &[1, 5, 64, 130]);
        upward.insert(6);
        let rest: Vec<u32> = std::iter::from_fn(|| upward.take()).collect();
        assert_eq!(rest, [5, 6, 64, 70, 130, 199]);
        due.reset(200);
        due.insert_all(&[3, 64, 199]);
        let mut downward = due.downward();
        assert_eq!(downward.take(), Some(199));
        downward.insert_before(199, &[1, 63, 198, 199]);
        downward.insert(197);
        let rest: Vec<u32> = std::iter::from_fn(|| downward.take()).collect();
        assert_eq!(rest, [198, 197, 64, 63, 3, 1]);
    }

    #[test]
    fn nothing_is_due_in_an_empty_set() {
        let mut due = Due::default();
        due.reset(0);
        assert_eq!((due.upward().take(), due.downward().take()), (None, None));
        due.reset(200);
        assert_eq!((due.upward().take(), due.downward().take()), (None, None));
    }
}
