//! Stopping long work from outside, wherever it is: Ctrl-C and time limits.
//!
//! Whoever starts long work says who may stop it, [`Interrupt::run`]; the work calls [`poll`] in its loops. Mostly
//! that subtracts a number. When some work has been done it asks, and after a yes it unwinds to `run`, which then returns
//! None. So neither an answer nor a signature changes on the way, and any loop can be stopped, a single factor of a large
//! matrix too. (Salsa, the engine of rust-analyzer, cancels its queries in this way.)
//!
//! What is unwound through is left half done. So every object that outlives its calls puts itself right on the way, with
//! [`or_else`]: its documentation says in which state an interrupted call leaves it. Work that nobody may stop is not
//! touched: [`poll`] returns.

use std::{
    cell::{Cell, RefCell},
    fmt,
    panic::{AssertUnwindSafe, catch_unwind, resume_unwind},
    sync::{Arc, Mutex, PoisonError, mpsc},
    thread,
    time::{Duration, Instant},
};

type Asked = Arc<dyn Fn() -> bool + Send + Sync>;

/// Who is asked whether to stop; None if nobody. Clones ask the same.
#[derive(Clone, Default)]
pub struct Interrupt {
    asked: Option<Asked>,
}

/// Operations between two questions: about a millisecond of floating-point work, so that a question, with a look at the
/// clock, costs nothing.
const WORTH_ASKING: usize = 1 << 20;

thread_local! {
    static LEFT: Cell<usize> = const { Cell::new(WORTH_ASKING) };
    static CURRENT: RefCell<Interrupt> = const { RefCell::new(Interrupt { asked: None }) };
}

/// What unwinds.
struct Stopped;

/// Says that about so many operations are done, and unwinds to [`Interrupt::run`] if it is time to stop.
#[inline]
pub fn poll(operations: usize) {
    LEFT.with(|left| match left.get().checked_sub(operations) {
        Some(rest) => left.set(rest),
        None => {
            left.set(WORTH_ASKING);
            poll_now();
        }
    });
}

/// Counts the operations of an object that does little in a call and is called often, and [`poll`]s once there are many: to
/// look at the thread's own count for each walk of a few steps would take as long as the walk.
#[derive(Debug, Clone, Copy, Default)]
pub struct Tally {
    operations: usize,
}

/// Operations that a [`Tally`] keeps back: some hundredths of a millisecond.
const KEPT_BACK: usize = 1 << 15;

impl Tally {
    /// [`poll`], now or later.
    #[inline]
    pub fn count(&mut self, operations: usize) {
        self.operations += operations;
        if self.operations >= KEPT_BACK {
            self.pass_on();
        }
    }

    #[cold]
    fn pass_on(&mut self) {
        poll(std::mem::take(&mut self.operations));
    }
}

/// [`poll`] without delay: after a step whose length in operations nobody knows.
#[cold]
pub fn poll_now() {
    // A copy: who is asked may begin work of its own.
    if Interrupt::current().stops() {
        resume_unwind(Box::new(Stopped)); // unlike panic!, this calls no panic hook
    }
}

/// Does some work on an object; if that is stopped on the way, `mend` puts the object right before it goes on to unwind. So
/// it does after a panic.
pub fn or_else<S: ?Sized, T>(object: &mut S, work: impl FnOnce(&mut S) -> T, mend: impl FnOnce(&mut S)) -> T {
    match catch_unwind(AssertUnwindSafe(|| work(object))) {
        Ok(done) => done,
        Err(cause) => {
            // To mend is never stopped itself.
            Interrupt::default().instead(|| mend(object));
            resume_unwind(cause)
        }
    }
}

/// Operations of a call that is long: some hundredths of a second.
const LONG: usize = 1 << 26;
/// Time between two questions while only another thread works.
const PERIOD: Duration = Duration::from_millis(10);

/// Does work that asks nobody, such as a library's: on a thread of its own if it takes so many operations that they are long and
/// someone may stop them. If they are stopped, the thread comes to its end alone.
pub fn apart<T: Send + 'static>(operations: usize, work: impl FnOnce() -> T + Send + 'static) -> T {
    if operations < LONG || Interrupt::current().asked.is_none() {
        return work();
    }
    let (tell, told) = mpsc::channel();
    let kept = Arc::new(Mutex::new(Some(work)));
    let taken = Arc::clone(&kept);
    let take = |kept: &Mutex<Option<_>>| kept.lock().unwrap_or_else(PoisonError::into_inner).take();
    let begun = thread::Builder::new().spawn(move || {
        let done = take(&taken).map(|work| catch_unwind(AssertUnwindSafe(work)));
        tell.send(done).ok() // there may be nobody left to tell
    });
    if begun.is_err() {
        return take(&kept).map(|work| work()).expect("no thread has taken it");
    }
    loop {
        match told.recv_timeout(PERIOD) {
            Ok(done) => return done.expect("taken once").unwrap_or_else(|panic| resume_unwind(panic)),
            Err(mpsc::RecvTimeoutError::Timeout) => poll_now(),
            Err(mpsc::RecvTimeoutError::Disconnected) => unreachable!("the thread tells what it did"),
        }
    }
}

impl Interrupt {
    /// Asked from time to time, on whatever thread works; the answer yes must be followed by no other.
    pub fn new(stops: impl Fn() -> bool + Send + Sync + 'static) -> Self {
        Self { asked: Some(Arc::new(stops)) }
    }

    /// Stops at a time.
    pub fn at(end: Instant) -> Self {
        Self::new(move || Instant::now() >= end)
    }

    /// Who may stop the work of this thread at the moment; to be handed to threads that take a part of it.
    pub fn current() -> Self {
        CURRENT.with_borrow(Clone::clone)
    }

    /// Does some work that this, and whoever could stop the caller, may stop. None if it was stopped.
    pub fn run<T>(&self, work: impl FnOnce() -> T) -> Option<T> {
        self.clone().lent(work).0
    }

    /// [`Self::run`], for one that is run again and again: it is handed back.
    pub fn lent<T>(self, work: impl FnOnce() -> T) -> (Option<T>, Self) {
        let (before, kept) = CURRENT.with_borrow_mut(|current| {
            let (asked, kept) = match current.asked {
                Some(_) => (current.and(&self), Some(self)),
                None => (self, None),
            };
            (std::mem::replace(current, asked), kept)
        });
        let (done, asked) = until_stopped(before, work);
        (done, kept.unwrap_or(asked))
    }

    /// [`Self::run`], where whoever could stop the caller is not asked.
    pub fn instead<T>(&self, work: impl FnOnce() -> T) -> Option<T> {
        until_stopped(CURRENT.replace(self.clone()), work).0
    }

    /// Asks both.
    fn and(&self, other: &Self) -> Self {
        match (&self.asked, &other.asked) {
            (Some(one), Some(other)) => {
                let (one, other) = (Arc::clone(one), Arc::clone(other));
                Self::new(move || one() || other())
            }
            (one, other) => Self { asked: one.as_ref().or(other.as_ref()).cloned() },
        }
    }

    /// Whether to stop now.
    pub fn stops(&self) -> bool {
        self.asked.as_ref().is_some_and(|asked| asked())
    }
}

impl fmt::Debug for Interrupt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Interrupt").field("asked", &self.asked.is_some()).finish()
    }
}

/// Does work until it is stopped, puts back who was asked `before`, and hands out who was asked on the way.
fn until_stopped<T>(before: Interrupt, work: impl FnOnce() -> T) -> (Option<T>, Interrupt) {
    let ended = catch_unwind(AssertUnwindSafe(work));
    let asked = CURRENT.replace(before);
    match ended {
        Ok(done) => (Some(done), asked),
        Err(cause) if cause.is::<Stopped>() => (None, asked),
        Err(panic) => resume_unwind(panic),
    }
}

#[cfg(test)]
mod tests {
    use super::{Interrupt, KEPT_BACK, LONG, Tally, WORTH_ASKING, apart, or_else, poll, poll_now};
    use std::{
        cell::Cell,
        panic::{AssertUnwindSafe, catch_unwind},
        sync::{
            Arc,
            atomic::{AtomicUsize, Ordering::Relaxed},
        },
        time::Instant,
    };

    /// Says no so many times, then yes.
    fn after(questions: usize) -> (Interrupt, Arc<AtomicUsize>) {
        let asked = Arc::new(AtomicUsize::new(0));
        let count = Arc::clone(&asked);
        (Interrupt::new(move || count.fetch_add(1, Relaxed) >= questions), asked)
    }

    #[test]
    fn work_stops_at_the_first_yes_and_is_asked_by_what_it_does() {
        let (interrupt, asked) = after(3);
        let done = Cell::new(0);
        let ended = interrupt.run(|| {
            loop {
                done.set(done.get() + 1);
                poll(WORTH_ASKING / 4);
            }
        });
        assert_eq!((ended, asked.load(Relaxed)), (None::<()>, 4));
        assert!((16..=20).contains(&done.get()), "{done:?} quarters between four questions");
        assert_eq!(Interrupt::default().run(|| 7), Some(7));
    }

    #[test]
    fn a_tally_asks_as_often_as_the_operations_themselves() {
        let (interrupt, asked) = after(3);
        let (done, step) = (Cell::new(0), KEPT_BACK / 3);
        let ended = interrupt.run(|| {
            let mut tally = Tally::default();
            loop {
                done.set(done.get() + 1);
                tally.count(step);
            }
        });
        assert_eq!((ended, asked.load(Relaxed)), (None::<()>, 4));
        let share = (done.get() * step) as f64 / WORTH_ASKING as f64;
        assert!((3.0..=4.5).contains(&share), "{share} times the operations between two questions");
    }

    #[test]
    fn what_is_lent_comes_back_and_asks_the_same() {
        let (outer, outside) = after(usize::MAX);
        let (inner, inside) = after(1);
        let (done, inner) = inner.lent(poll_now);
        assert_eq!(done, Some(()));
        let (done, inner) = outer.run(|| inner.lent(poll_now)).expect("nobody stops it outside");
        assert_eq!((done, inside.load(Relaxed), outside.load(Relaxed)), (None, 2, 1));
        assert!(inner.stops());
        assert!(!Interrupt::current().stops());
    }

    #[test]
    fn outside_and_inside_may_both_stop_and_nobody_is_asked_afterwards() {
        let (outer, _) = after(0);
        let (inner, _) = after(usize::MAX);
        assert_eq!(outer.run(|| inner.run(poll_now).is_none()), Some(true));
        assert_eq!(Interrupt::at(Instant::now()).run(poll_now), None);
        poll_now();
        assert!(!Interrupt::current().stops());
    }

    #[test]
    fn an_object_is_put_right_before_the_work_ends_and_without_being_stopped() {
        let (interrupt, _) = after(0);
        let mut object = vec![1, 2, 3];
        let ended = interrupt.run(|| {
            or_else(
                &mut object,
                |object| {
                    object.clear();
                    poll_now();
                },
                |object| {
                    poll_now();
                    object.push(4);
                },
            );
        });
        assert_eq!((ended, object), (None, vec![4]));
    }

    #[test]
    fn work_that_asks_nobody_is_left_alone_when_it_is_stopped() {
        let (interrupt, asked) = after(1);
        let (end, ended) = std::sync::mpsc::channel::<()>();
        assert_eq!(interrupt.run(|| apart(usize::MAX, move || ended.recv().is_err())), None);
        assert_eq!(asked.load(Relaxed), 2);
        drop(end);
        assert_eq!(interrupt.run(|| apart(LONG - 1, || 7)), Some(7));
        let (never, _) = after(usize::MAX);
        assert_eq!(never.run(|| apart(LONG, || 7)), Some(7));
    }

    #[test]
    fn a_panic_is_not_taken_for_a_stop() {
        let panicked =
            catch_unwind(AssertUnwindSafe(|| Interrupt::default().run(|| std::panic::resume_unwind(Box::new(1)))));
        assert!(panicked.is_err_and(|cause| cause.is::<i32>()));
    }
}
