//! Independent pieces of work at the same time. Whoever may stop the caller may stop all of them.

use crate::interrupt::{Interrupt, poll_now};
use std::{
    num::NonZero,
    panic::resume_unwind,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
};

/// As many as can work at the same time.
pub(crate) fn available() -> usize {
    thread::available_parallelism().map_or(1, NonZero::get)
}

/// What `work` gives for each of some items, in their order: for the first on this thread, for each other one on a thread of its own.
pub(crate) fn each<T: Send, R: Send>(items: impl IntoIterator<Item = T>, work: impl Fn(T) -> R + Sync) -> Vec<R> {
    let (mut items, work) = (items.into_iter(), &work);
    let Some(own) = items.next() else { return Vec::new() };
    let stopped = Arc::new(AtomicBool::new(false));
    let done: Option<Vec<R>> = thread::scope(|scope| {
        let begun: Vec<_> = items
            .map(|item| {
                // A signal is often seen by the first thread only.
                let (current, flag) = (Interrupt::current(), Arc::clone(&stopped));
                let interrupt = Interrupt::new(move || flag.load(Ordering::Relaxed) || current.stops());
                scope.spawn(move || interrupt.run(|| work(item)))
            })
            .collect();
        let first = Interrupt::default().run(|| work(own));
        stopped.store(first.is_none(), Ordering::Relaxed);
        let others = begun.into_iter().map(|thread| thread.join().unwrap_or_else(|panic| resume_unwind(panic)));
        let all: Vec<Option<R>> = [first].into_iter().chain(others).collect();
        all.into_iter().collect()
    });
    done.unwrap_or_else(|| {
        loop {
            poll_now(); // unwinds: somebody said that it is time to stop
            thread::yield_now();
        }
    })
}

/// [`each`], or one after the other where only one can work.
pub(crate) fn at_once<T: Send, R: Send>(items: impl IntoIterator<Item = T>, work: impl Fn(T) -> R + Sync) -> Vec<R> {
    if available() < 2 { items.into_iter().map(work).collect() } else { each(items, work) }
}

#[cfg(test)]
mod tests {
    use super::{at_once, each};
    use crate::interrupt::{Interrupt, poll, poll_now};
    use std::time::{Duration, Instant};

    #[test]
    fn answers_come_in_order_and_all_are_stopped() {
        assert_eq!(each([1, 2, 3], |k| 2 * k), [2, 4, 6]);
        assert_eq!(at_once([1, 2, 3], |k| 2 * k), [2, 4, 6]);
        assert!(each([0; 0], |k| k).is_empty());
        let stops = Interrupt::new(|| true);
        assert_eq!(stops.run(|| each([1, 2], |_| poll_now())), None);
    }

    #[test]
    fn all_threads_are_stopped() {
        let begun = Instant::now();
        let forever = |_: i32| -> i32 {
            loop {
                poll(1000);
            }
        };
        let stop = Interrupt::at(begun + Duration::from_millis(20));
        assert!(stop.run(|| each([0; 4], forever)).is_none());
        assert!(begun.elapsed() < Duration::from_secs(5));
    }
}
