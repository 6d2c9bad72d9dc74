//! Many short lists in one piece of memory.

use serde::{Deserialize, Serialize};

/// Lists that grow and shrink at their ends. One that has no room left moves to the end of the memory, with twice the room;
/// what it leaves behind is gathered up when there is more of it than of what is in use. So a list costs no allocation.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Lists<T> {
    memory: Vec<T>,
    spans: Vec<Span>,
    /// Room of all lists.
    room: usize,
}

#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
struct Span {
    start: u32,
    len: u32,
    room: u32,
}

/// Room of a list that gets its first entry: most stay shorter.
const FIRST_ROOM: u32 = 4;
/// Memory that is not worth gathering up.
const SMALL: usize = 1024;

impl<T: Copy + Default> Lists<T> {
    pub fn empty(lists: usize) -> Self {
        Self { memory: Vec::with_capacity(FIRST_ROOM as usize * lists), spans: vec![Span::default(); lists], room: 0 }
    }

    pub fn of(&self, list: u32) -> &[T] {
        let Span { start, len, .. } = self.spans[list as usize];
        &self.memory[start as usize..(start + len) as usize]
    }

    pub fn len_of(&self, list: u32) -> usize {
        self.spans[list as usize].len as usize
    }

    pub fn push(&mut self, list: u32, value: T) {
        if self.spans[list as usize].len == self.spans[list as usize].room {
            self.make_room(list);
        }
        let span = &mut self.spans[list as usize];
        self.memory[(span.start + span.len) as usize] = value;
        span.len += 1;
    }

    pub fn pop(&mut self, list: u32) {
        self.spans[list as usize].len -= 1;
    }

    /// Removes the entry at a place; the last one takes it.
    pub fn swap_remove(&mut self, list: u32, place: usize) {
        let span = &mut self.spans[list as usize];
        span.len -= 1;
        self.memory[span.start as usize + place] = self.memory[(span.start + span.len) as usize];
    }

    /// Puts an empty list behind the others.
    pub fn push_list(&mut self) {
        self.spans.push(Span::default());
    }

    /// Takes the last list away.
    pub fn pop_list(&mut self) {
        if let Some(Span { start, room, .. }) = self.spans.pop() {
            self.room -= room as usize;
            if (start + room) as usize == self.memory.len() {
                self.memory.truncate(start as usize);
            }
        }
    }

    /// Changes the number of lists; new ones are empty.
    pub fn resize(&mut self, lists: usize) {
        while self.spans.len() > lists {
            self.pop_list();
        }
        self.spans.resize(lists, Span::default());
    }

    fn make_room(&mut self, list: u32) {
        if self.memory.len() > SMALL + 2 * self.room {
            self.gather();
        }
        let Span { start, len, room } = self.spans[list as usize];
        let more = (2 * room).max(FIRST_ROOM);
        self.room += (more - room) as usize;
        let start = if (start + room) as usize == self.memory.len() {
            start
        } else {
            let end = self.memory.len();
            self.memory.extend_from_within(start as usize..(start + len) as usize);
            end as u32
        };
        self.memory.resize((start + more) as usize, T::default());
        self.spans[list as usize] = Span { start, len, room: more };
    }

    /// Puts all lists side by side.
    fn gather(&mut self) {
        let mut memory = Vec::with_capacity(2 * self.room);
        for span in &mut self.spans {
            let (start, end) = (memory.len(), memory.len() + span.room as usize);
            memory.extend_from_slice(&self.memory[span.start as usize..(span.start + span.len) as usize]);
            memory.resize(end, T::default());
            span.start = start as u32;
        }
        self.memory = memory;
    }
}

#[cfg(test)]
mod tests {
    use super::Lists;
    use rand::{Rng, SeedableRng};
    use rand_pcg::Pcg64;

    /// Whatever comes and goes, each list is what a vector of its own would be, and little memory is left behind.
    #[test]
    fn lists_are_vectors() {
        let mut random = Pcg64::seed_from_u64(1);
        let (mut lists, mut vectors) = (Lists::empty(5), vec![Vec::new(); 5]);
        for step in 0..100_000 {
            let last = vectors.len() - 1;
            let list = random.random_range(0..=last);
            match random.random_range(0..8) {
                0 if last < 400 => {
                    lists.push_list();
                    vectors.push(Vec::new());
                }
                1 if last > 5 => {
                    lists.pop_list();
                    vectors.pop();
                }
                2 if !vectors[list].is_empty() => {
                    lists.pop(list as u32);
                    vectors[list].pop();
                }
                3 if !vectors[list].is_empty() => {
                    let place = random.random_range(0..vectors[list].len());
                    lists.swap_remove(list as u32, place);
                    vectors[list].swap_remove(place);
                }
                _ => {
                    lists.push(list as u32, step);
                    vectors[list].push(step);
                }
            }
            let list = random.random_range(0..vectors.len());
            assert_eq!((lists.of(list as u32), lists.len_of(list as u32)), (&vectors[list][..], vectors[list].len()));
        }
        lists.resize(3);
        vectors.truncate(3);
        assert!((0..3).all(|list| lists.of(list as u32) == vectors[list]));
        assert!(lists.memory.len() <= 2 * (super::SMALL + 2 * 2 * 100_000), "{}", lists.memory.len());
    }
}
