//! Long lists of independent items, on all cores.

use crate::threads::{available, each};

/// Items that are worth a thread of their own: some milliseconds of work.
const WORTH_A_THREAD: usize = 1 << 14;

/// More threads than this wait for memory only.
const MOST: usize = 8;

/// What work gives on parts of some items that follow one another, put together in their order: the same on any number of
/// threads, as long as `work` gives for two lists together what it gives for one and then the other.
pub(super) fn in_parts<T: Sync, R: Send>(items: &[T], work: impl Fn(&[T]) -> Vec<R> + Sync) -> Vec<R> {
    on_threads(items, available().min(MOST).min(items.len() / WORTH_A_THREAD), work)
}

fn on_threads<T: Sync, R: Send>(items: &[T], threads: usize, work: impl Fn(&[T]) -> Vec<R> + Sync) -> Vec<R> {
    if threads < 2 || items.is_empty() {
        return work(items);
    }
    each(items.chunks(items.len().div_ceil(threads)), work).into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::on_threads;

    #[test]
    fn parts_come_together_in_order_on_any_number_of_threads() {
        let items: Vec<usize> = (0..1001).collect();
        let odd = |part: &[usize]| part.iter().filter(|&k| k % 2 == 1).map(|k| 3 * k).collect();
        for threads in 1..6 {
            assert_eq!(on_threads(&items, threads, odd), odd(&items));
        }
        assert!(on_threads(&[], 4, odd).is_empty());
    }
}
