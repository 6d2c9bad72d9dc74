//! Two pieces of work on two threads.

use crate::interrupt::{Interrupt, poll_now};
use std::{panic::resume_unwind, thread};

/// Does two pieces of work, at the same time if that is worth a thread and there are two. Whoever may stop the caller may stop both.
pub(super) fn at_once<T: Send>(worth: bool, one: impl FnOnce() -> T, other: impl FnOnce() -> T + Send) -> [T; 2] {
    if !worth || thread::available_parallelism().map_or(1, Into::into) < 2 {
        return [one(), other()];
    }
    let interrupt = Interrupt::current();
    thread::scope(|scope| {
        let beside = scope.spawn(move || interrupt.instead(other));
        let own = one();
        match beside.join() {
            Ok(Some(done)) => [own, done],
            Ok(None) => {
                poll_now();
                unreachable!("who stopped the other stops this as well")
            }
            Err(panic) => resume_unwind(panic),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::at_once;
    use crate::interrupt::{Interrupt, poll_now};

    #[test]
    fn answers_come_in_order_and_both_are_stopped() {
        assert_eq!(at_once(true, || 1, || 2), [1, 2]);
        assert_eq!(at_once(false, || 1, || 2), [1, 2]);
        let stops = Interrupt::new(|| true);
        assert_eq!(stops.run(|| at_once(true, poll_now, poll_now)), None);
    }
}
