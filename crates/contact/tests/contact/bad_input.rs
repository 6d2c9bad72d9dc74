//! Bad input is one error that names the thing; long work can be stopped.

use crate::common::tower;
use drystone_contact::{Bodies, ContactError, Settings};
use drystone_lcp::interrupt::Interrupt;

#[test]
fn each_is_named() {
    let good = tower(&[1.0, 2.0], 0.5, [0.0, 0.0]);
    let with = |change: &dyn Fn(&mut Bodies)| {
        let mut problem = good.clone();
        change(&mut problem);
        problem.solve(None, &Settings::default()).unwrap_err()
    };
    assert_eq!(with(&|p| p.size = 4), ContactError::Size { size: 4 });
    assert!(matches!(with(&|p| p.free.truncate(6)), ContactError::Length { what: "free", found: 6, expected: 12 }));
    assert_eq!(with(&|p| p.inverse_mass[3] = 0.0), ContactError::Mass { place: 3 });
    assert_eq!(with(&|p| p.inverse_mass[3] = f64::INFINITY), ContactError::Mass { place: 3 });
    assert_eq!(with(&|p| p.free[7] = f64::NAN), ContactError::NotFinite { what: "free", place: 7 });
    assert!(matches!(with(&|p| p.contacts[5].friction = -0.1), ContactError::Friction { contact: 5, .. }));
    assert!(matches!(with(&|p| p.contacts[5].friction = f64::NAN), ContactError::Friction { contact: 5, .. }));
    assert!(matches!(with(&|p| p.contacts[1].offset = f64::NAN), ContactError::NotFinite { what: "offset", place: 1 }));
    assert!(matches!(
        with(&|p| p.contacts[1].bodies[1] = Some(9)),
        ContactError::Body { contact: 1, body: 9, bodies: 2 }
    ));
    assert!(matches!(with(&|p| p.contacts[2].jacobian[1][0][0] = f64::NAN), ContactError::NotFinite { .. }));
    let short = good.solve(Some(&[0.0; 3]), &Settings::default()).unwrap_err();
    assert_eq!(short, ContactError::Start { found: 3, expected: 24 });
    assert!(good.solve(Some(&[f64::NAN; 24]), &Settings::default()).is_err());
}

/// A contact between fixed bodies has nothing to move; one that is listed with one body twice neither.
#[test]
fn contacts_that_move_nothing() {
    let mut problem = tower(&[1.0], 0.5, [0.0, 0.0]);
    let mut fixed = problem.contacts[0].clone();
    fixed.bodies = [None, None];
    problem.contacts.push(fixed);
    let solution = problem.solve(None, &Settings::default()).unwrap();
    assert!(solution.velocities.iter().all(|v| v.abs() < 1e-9));
    assert_eq!(solution.impulses[12..], [0.0; 3]);
}

#[test]
fn work_can_be_stopped() {
    let problem = tower(&[1.0; 300], 0.5, [0.3, 0.1]);
    let stop = Interrupt::new(|| true);
    assert!(stop.run(|| problem.solve(None, &Settings::default())).is_none());
}
