//! Long lists of independent items, on all cores.

use crate::interrupt::{Interrupt, poll_now};
use std::{
    num::NonZero,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
};

/// Items that are worth a thread of their own: some milliseconds of work.
const WORTH_A_THREAD: usize = 1 << 14;

/// More threads than this wait for memory only.
const MOST: usize = 8;

/// What work gives on parts of some items that follow one another, put together in their order: the same on any number of
/// threads, as long as `work` gives for two lists together what it gives for one and then the other.
pub(super) fn in_parts<T: Sync, R: Send>(items: &[T], work: impl Fn(&[T]) -> Vec<R> + Sync) -> Vec<R> {
    let cores = thread::available_parallelism().map_or(1, NonZero::get).min(MOST);
    on_threads(items, cores.min(items.len() / WORTH_A_THREAD), work)
}

fn on_threads<T: Sync, R: Send>(items: &[T], threads: usize, work: impl Fn(&[T]) -> Vec<R> + Sync) -> Vec<R> {
    if threads < 2 || items.is_empty() {
        return work(items);
    }
    let stopped = Arc::new(AtomicBool::new(false));
    let mut parts = items.chunks(items.len().div_ceil(threads));
    let own = parts.next().unwrap_or_default();
    let done = thread::scope(|scope| {
        let begun: Vec<_> = parts
            .map(|part| {
                // A signal is often seen by the first thread only.
                let (current, flag) = (Interrupt::current(), Arc::clone(&stopped));
                let interrupt = Interrupt::new(move || flag.load(Ordering::Relaxed) || current.stops());
                let work = &work;
                scope.spawn(move || interrupt.run(|| work(part)))
            })
            .collect();
        let first = Interrupt::default().run(|| work(own));
        stopped.store(first.is_none(), Ordering::Relaxed);
        let others =
            begun.into_iter().map(|thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        let all: Vec<Option<Vec<R>>> = [first].into_iter().chain(others).collect();
        all.into_iter().collect::<Option<Vec<_>>>()
    });
    match done {
        Some(parts) => parts.into_iter().flatten().collect(),
        None => loop {
            poll_now(); // unwinds: somebody said that it is time to stop
            thread::yield_now();
        },
    }
}

#[cfg(test)]
mod tests {
    use super::on_threads;
    use crate::interrupt::{Interrupt, poll};
    use std::time::{Duration, Instant};

    #[test]
    fn parts_come_together_in_order_on_any_number_of_threads() {
        let items: Vec<usize> = (0..1001).collect();
        let odd = |part: &[usize]| part.iter().filter(|&k| k % 2 == 1).map(|k| 3 * k).collect();
        for threads in 1..6 {
            assert_eq!(on_threads(&items, threads, odd), odd(&items));
        }
        assert!(on_threads(&[], 4, odd).is_empty());
    }

    #[test]
    fn all_threads_are_stopped() {
        let (items, begun) = (vec![0; 4], Instant::now());
        let forever = |_: &[i32]| -> Vec<i32> {
            loop {
                poll(1000);
            }
        };
        let stop = Interrupt::at(begun + Duration::from_millis(20));
        assert!(stop.run(|| on_threads(&items, 4, forever)).is_none());
        assert!(begun.elapsed() < Duration::from_secs(5));
    }
}
