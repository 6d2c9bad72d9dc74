//! Row operations still to be done, in the order of their numbers.

use std::ops::Range;

/// A set of numbers that is emptied from one end while more are added on the way; bits, because a row of a large
/// structure is read by many operations.
#[derive(Debug, Clone, Default)]
pub(super) struct Due {
    words: Vec<u64>,
    /// No bit is set outside these words.
    span: Range<usize>,
}

impl Due {
    /// Makes room for the numbers below `count`. The set must be empty, as it is after being taken to the end.
    pub fn reset(&mut self, count: usize) {
        self.words.resize(count.div_ceil(64), 0);
        self.span = self.words.len()..0;
    }

    /// Adds those of some ascending numbers that lie in a range.
    pub fn insert_all(&mut self, numbers: &[u32], range: Range<u32>) {
        let from = numbers.partition_point(|&number| number < range.start);
        for &number in numbers[from..].iter().take_while(|&&number| number < range.end) {
            let word = number as usize / 64;
            self.words[word] |= 1 << (number % 64);
            self.span = self.span.start.min(word)..self.span.end.max(word + 1);
        }
    }

    /// Takes the least number out.
    pub fn take_first(&mut self) -> Option<u32> {
        while self.span.start < self.span.end {
            let word = &mut self.words[self.span.start];
            if *word != 0 {
                let bit = word.trailing_zeros();
                *word &= *word - 1;
                return Some(64 * self.span.start as u32 + bit);
            }
            self.span.start += 1;
        }
        None
    }

    /// Takes the largest number out.
    pub fn take_last(&mut self) -> Option<u32> {
        while self.span.start < self.span.end {
            let word = &mut self.words[self.span.end - 1];
            if *word != 0 {
                let bit = 63 - word.leading_zeros();
                *word &= !(1 << bit);
                return Some(64 * (self.span.end as u32 - 1) + bit);
            }
            self.span.end -= 1;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::Due;

    #[test]
    fn numbers_come_out_in_order_from_either_end_whatever_is_added_on_the_way() {
        let mut due = Due::default();
        due.reset(200);
        due.insert_all(&[3, 64, 70, 199], 0..u32::MAX);
        assert_eq!(due.take_first(), Some(3));
        due.insert_all(&[1, 5, 64, 130], 4..u32::MAX);
        let rest: Vec<u32> = std::iter::from_fn(|| due.take_first()).collect();
        assert_eq!(rest, [5, 64, 70, 130, 199]);
        due.reset(200);
        due.insert_all(&[3, 64, 199], 0..u32::MAX);
        assert_eq!(due.take_last(), Some(199));
        due.insert_all(&[1, 63, 198, 199], 0..199);
        let rest: Vec<u32> = std::iter::from_fn(|| due.take_last()).collect();
        assert_eq!(rest, [198, 64, 63, 3, 1]);
    }
}
