//! `h in cone(G)` decided once more, slowly, where 64-bit numbers do not decide it.
//!
//! A load of 1e10 that passes through a block of weight 1 leaves no digit of that weight in a 64-bit sum. Here every basic
//! value and every multiplier is a double-double number (32 digits): the basis is factored in 64 bits, and the solution is
//! refined with residuals in double-double arithmetic until they do not shrink any more (Wilkinson's iterative refinement; for
//! linear programs Gleixner, Steffy and Wolter 2016). The pivoting rules are those of phase one (`membership/phase_one.rs`).
//!
//! The entries of G are taken as given, but known only to rounding: columns that help by less than the rounding of
//! directions do not enter, and the certificate counts only if its power is above what such rounding could make of the
//! forces that are there. What is neither proved inside nor outside is [`Membership::Borderline`].

mod factored;

use super::{
    answer::{Doubt, MARGIN, Membership, OF_FORCE, OF_LOAD},
    basic::{Basic, ZERO, infeasible},
    columns::Columns,
};
use crate::interrupt::poll_now;
use factored::Factored;
use twofloat::TwoFloat;

/// Rounding of directions: a rate below this share of the sum of its terms is none. A column that depends on some ten others but
/// for the rounding of all their entries has a rate of that size.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// Entries of `B^-1 g` below this share of the largest do not block: far above what refinement leaves of rounding, far below
/// what a heavy block makes of a light one.
const PIVOT: f64 = 1e-18;
/// The infeasibility must fall by this share to count as progress: where loads differ widely, what is left of a light one is
/// little beside the others.
const PROGRESS: f64 = 1e-15;
/// Pivots without progress after which ties go by least index (Bland 1977).
const STALL: usize = 50;

/// A decision under way.
pub(super) struct Extended<'a> {
    g: &'a Columns,
    h: &'a [f64],
    own: &'a [f64],
    rows: Vec<u32>,
    /// Of each present row.
    basis: Vec<Basic>,
    /// Columns that take part and are not basic.
    columns: Vec<u32>,
    /// Columns that would help only by what rounding makes of the basic ones that they depend on.
    dependent: Vec<u32>,
    /// Columns with which the basis is singular but for rounding.
    aside: Vec<u32>,
}

/// One exchange: where, and what went.
#[derive(Debug, Clone, Copy)]
struct Exchange {
    place: usize,
    left: Basic,
}

/// What forces leave in a row.
struct Rest {
    imbalance: f64,
    allowed: f64,
}

/// How a decision ended.
pub(super) struct Decision {
    pub found: Membership,
    pub pivots: usize,
    /// What is basic in the position of each present row, with its value.
    pub values: Vec<(Basic, f64)>,
    /// For [`Membership::Outside`]: the multiplier of each present row.
    pub multipliers: Vec<f64>,
    /// Of a borderline one.
    pub doubt: Option<Doubt>,
}

impl<'a> Extended<'a> {
    /// Takes the load of each row's own block in the unit of the row, the rows present, what is basic in the position of each,
    /// and the columns that take part without being basic.
    pub fn new(
        g: &'a Columns,
        h: &'a [f64],
        own: &'a [f64],
        rows: Vec<u32>,
        basis: Vec<Basic>,
        columns: Vec<u32>,
    ) -> Self {
        Self { g, h, own, rows, basis, columns, dependent: Vec::new(), aside: Vec::new() }
    }

    /// Pivots to the end. None if accuracy is lost even so.
    pub fn decide(mut self) -> Option<Decision> {
        let limit = 1000 + 50 * self.rows.len();
        let mut path: Vec<Exchange> = Vec::new();
        let mut factored = match Factored::new(self.g, &self.rows, &self.basis) {
            Some(factored) => factored,
            None => self.retreat(&mut path)?,
        };
        let load: Vec<TwoFloat> = self.rows.iter().map(|&row| self.h[row as usize].into()).collect();
        let (mut best, mut stalled) = (TwoFloat::from(f64::INFINITY), 0);
        let mut pivots = 0;
        for _ in 0..limit {
            poll_now();
            let Some((x, signs, y)) = self.values(&mut factored, &load) else {
                factored = self.retreat(&mut path)?;
                continue;
            };
            if signs.iter().all(|&sign| sign == 0.0) {
                return Some(self.ended(Membership::Inside, None, pivots, &x, &[]));
            }
            let infeasibility = x.iter().zip(&signs).fold(TwoFloat::from(0.0), |sum, (x, sign)| sum + *x * *sign);
            stalled = if infeasibility < best * (1.0 - PROGRESS) { 0 } else { stalled + 1 };
            best = infeasibility;
            let least_index = stalled > STALL;
            let Some(entering) = self.entering(&y, least_index) else {
                if self.take_up_dependent(&mut factored, &y) {
                    continue;
                }
                if self.helps_aside(&y) {
                    return None;
                }
                let (found, doubt) = self.outside_or_not(&x, &y);
                return Some(self.ended(found, doubt, pivots, &x, &y));
            };
            let direction = factored.solve(&factored.scattered(entering));
            self.columns.retain(|&j| j != entering);
            if direction.as_ref().is_some_and(|direction| !self.helps(&y, entering, direction)) {
                self.dependent.push(entering);
                continue;
            }
            let blocking = direction.as_ref().and_then(|d| self.blocking(&x, &signs, d, least_index));
            let (Some(direction), Some(place)) = (direction, blocking) else {
                self.aside.push(entering);
                continue;
            };
            let left = std::mem::replace(&mut self.basis[place], Basic::Column(entering));
            path.push(Exchange { place, left });
            pivots += 1;
            if let Basic::Column(j) = left {
                self.columns.push(j);
            }
            if factored.replace(place, entering, &direction).is_none() {
                factored = self.retreat(&mut path)?;
            }
        }
        None
    }

    /// Basic values, which of them are infeasible, and the multipliers. None if the basis is singular but for rounding.
    #[allow(clippy::type_complexity)]
    fn values(
        &self,
        factored: &mut Factored<'_>,
        load: &[TwoFloat],
    ) -> Option<(Vec<TwoFloat>, Vec<f64>, Vec<TwoFloat>)> {
        let x = factored.solve(load)?;
        let signs: Vec<f64> = (0..x.len()).map(|k| infeasible(self.basis[k], x[k].hi(), self.zero(k))).collect();
        let costs: Vec<TwoFloat> = signs.iter().map(|&sign| sign.into()).collect();
        let y = factored.solve_transposed(&costs)?;
        Some((x, signs, y))
    }

    /// The basis is singular but for rounding: goes back exchange by exchange until one is not, and sets the columns that had
    /// come aside. From nothing if that leads back to the beginning. None if it began from nothing.
    fn retreat(&mut self, path: &mut Vec<Exchange>) -> Option<Factored<'a>> {
        loop {
            match path.pop() {
                Some(Exchange { place, left }) => {
                    if let Basic::Column(j) = std::mem::replace(&mut self.basis[place], left) {
                        self.aside.push(j);
                    }
                    if let Basic::Column(j) = left {
                        self.columns.retain(|&other| other != j);
                    }
                }
                None => self.begin_anew()?,
            }
            let factored = Factored::new(self.g, &self.rows, &self.basis);
            if factored.is_some() {
                return factored;
            }
        }
    }

    /// Every row has its unit column again. None if it had.
    fn begin_anew(&mut self) -> Option<()> {
        let before = self.columns.len();
        for basic in &mut self.basis {
            if let Basic::Column(j) = std::mem::replace(basic, Basic::Unit) {
                self.columns.push(j);
            }
        }
        let begun = self.columns.len() > before;
        self.columns.append(&mut self.aside);
        self.columns.append(&mut self.dependent);
        self.columns.sort_unstable();
        begun.then_some(())
    }

    /// Whether a column lowers the infeasibility by more than rounding. Its rate is that of `g - B d`, which is zero but for the
    /// entries' rounding if it depends on the basic columns: the multipliers of these may be far larger than its own.
    fn helps(&self, y: &[TwoFloat], j: u32, direction: &[TwoFloat]) -> bool {
        let multiplier = self.by_row(y);
        let of_basic = |(basic, d): (&Basic, &TwoFloat)| match *basic {
            Basic::Column(k) if d.hi() != 0.0 => d.hi().abs() * self.rate(&multiplier, k).1,
            _ => 0.0,
        };
        let (rate, size) = self.rate(&multiplier, j);
        rate > ROUNDING * (size + self.basis.iter().zip(direction).map(of_basic).sum::<f64>())
    }

    /// Takes up again what depended on an earlier basis and helps now. Whether there is any.
    fn take_up_dependent(&mut self, factored: &mut Factored<'_>, y: &[TwoFloat]) -> bool {
        let dependent = std::mem::take(&mut self.dependent);
        let before = self.columns.len();
        for j in dependent {
            let direction = factored.solve(&factored.scattered(j));
            match direction {
                Some(direction) if !self.helps(y, j, &direction) => self.dependent.push(j),
                _ => self.columns.push(j),
            }
        }
        self.columns.len() > before
    }

    /// Whether a column that was set aside would lower the infeasibility.
    fn helps_aside(&self, y: &[TwoFloat]) -> bool {
        let multiplier = self.by_row(y);
        let helps = |&j: &u32| {
            let (rate, size) = self.rate(&multiplier, j);
            rate > ROUNDING * size
        };
        self.aside.iter().any(helps)
    }

    /// Which values are zero in a position.
    fn zero(&self, place: usize) -> f64 {
        let own = |row: u32| self.own[row as usize];
        ZERO * match self.basis[place] {
            Basic::Unit => own(self.rows[place]),
            Basic::Column(j) => self.g.column(j).iter().map(|&(row, _)| own(row)).fold(1.0, f64::min),
        }
    }

    /// The column that lowers the infeasibility fastest, if one does by more than the rounding of its direction.
    fn entering(&self, y: &[TwoFloat], least_index: bool) -> Option<u32> {
        let mut best: Option<(f64, u32)> = None;
        let multiplier = self.by_row(y);
        for &j in &self.columns {
            let (rate, size) = self.rate(&multiplier, j);
            if rate > ROUNDING * size && best.is_none_or(|best| rate > best.0) {
                best = Some((rate, j));
                if least_index {
                    break;
                }
            }
        }
        best.map(|best| best.1)
    }

    /// Multipliers by row of the complete problem.
    fn by_row(&self, y: &[TwoFloat]) -> Vec<TwoFloat> {
        let mut multiplier = vec![TwoFloat::from(0.0); self.h.len()];
        self.rows.iter().zip(y).for_each(|(&row, y)| multiplier[row as usize] = *y);
        multiplier
    }

    /// `y' g`, and the sum of the sizes of its terms.
    fn rate(&self, multiplier: &[TwoFloat], j: u32) -> (f64, f64) {
        let (mut rate, mut size) = (TwoFloat::from(0.0), 0.0);
        for &(row, value) in self.g.column(j) {
            let term = multiplier[row as usize] * value;
            rate += term;
            size += term.hi().abs();
        }
        (rate.hi(), size)
    }

    /// The position whose value blocks the step first; of near ties the one with the largest rate.
    fn blocking(&self, x: &[TwoFloat], signs: &[f64], direction: &[TwoFloat], least_index: bool) -> Option<usize> {
        let largest = direction.iter().fold(0.0_f64, |largest, d| largest.max(d.hi().abs()));
        let room = |place: usize| {
            let (rate, sign, value) = (direction[place].hi(), signs[place], x[place].hi());
            match (sign != 0.0, self.basis[place]) {
                _ if rate.abs() <= PIVOT * largest => None,
                (true, _) => (sign * rate > 0.0).then(|| value.abs()),
                (false, Basic::Unit) => Some(0.0),
                (false, Basic::Column(_)) => (rate > 0.0).then(|| value.max(0.0)),
            }
            .map(|room| (room / rate.abs(), (room + self.zero(place)) / rate.abs()))
        };
        let slack = (0..x.len())
            .filter_map(room)
            .fold(f64::INFINITY, |least, (ratio, relaxed)| least.min(if least_index { ratio } else { relaxed }));
        let within = (0..x.len()).filter(|&place| room(place).is_some_and(|(ratio, _)| ratio <= slack));
        let order = |&place: &usize| match self.basis[place] {
            Basic::Unit => u32::MAX - self.rows[place],
            Basic::Column(j) => u32::MAX / 2 - j.min(u32::MAX / 2),
        };
        if least_index {
            return within.max_by_key(order);
        }
        within.max_by(|&a, &b| {
            let size = |place: usize| direction[place].hi().abs();
            size(a).total_cmp(&size(b)).then(order(&a).cmp(&order(&b)))
        })
    }

    /// No column helps any more. Proved outside if the power of y is above what rounding of directions could make of the
    /// forces, and above what an imbalance that forces may leave could do; inside if it is not above the first, and the
    /// forces at hand leave no more. Borderline if neither is so.
    fn outside_or_not(&self, x: &[TwoFloat], y: &[TwoFloat]) -> (Membership, Option<Doubt>) {
        let multiplier = self.by_row(y);
        let force = |place: usize| match self.basis[place] {
            Basic::Column(j) if x[place].hi() > 0.0 => Some((j, x[place].hi())),
            _ => None,
        };
        let forces: Vec<(u32, f64)> = (0..x.len()).filter_map(force).collect();
        let balance = self.balance(&forces);
        let (mut power, mut bound, mut allowed, mut own) = (TwoFloat::from(0.0), 0.0, 0.0, 0.0);
        for (&row, rest) in self.rows.iter().zip(&balance) {
            let term = multiplier[row as usize] * self.h[row as usize];
            power += term;
            bound += ROUNDING * term.hi().abs();
            // Forces that leave an imbalance r have y' h = y' (G f + r) <= y' r.
            allowed += multiplier[row as usize].hi().abs() * rest.allowed;
            own += multiplier[row as usize].hi().abs() * self.own[row as usize];
        }
        bound += forces.iter().map(|&(j, f)| ROUNDING * f * self.rate(&multiplier, j).1).sum::<f64>();
        let power = power.hi();
        let falls = power > MARGIN * bound;
        if falls && power > allowed {
            (Membership::Outside, None)
        } else if !falls && balance.iter().all(|rest| rest.imbalance <= rest.allowed) {
            (Membership::Inside, None)
        } else {
            (Membership::Borderline, Some(Doubt { imbalance: power / own, power: power / bound }))
        }
    }

    /// What forces leave in each present row, and what they may: a billionth of the largest force in it, at most a millionth of
    /// the block's own load.
    fn balance(&self, forces: &[(u32, f64)]) -> Vec<Rest> {
        let mut rows: Vec<(TwoFloat, f64)> =
            self.h.iter().zip(self.own).map(|(&h, &own)| (TwoFloat::from(-h), own)).collect();
        for &(j, force) in forces {
            for &(row, value) in self.g.column(j) {
                let (sum, largest) = &mut rows[row as usize];
                *sum += TwoFloat::new_mul(force, value);
                *largest = largest.max((force * value).abs());
            }
        }
        let rest = |&row: &u32| {
            let (sum, largest) = rows[row as usize];
            let allowed = (OF_FORCE * largest).min(OF_LOAD * self.own[row as usize]);
            Rest { imbalance: sum.hi().abs(), allowed }
        };
        self.rows.iter().map(rest).collect()
    }

    fn ended(
        &self,
        found: Membership,
        doubt: Option<Doubt>,
        pivots: usize,
        x: &[TwoFloat],
        y: &[TwoFloat],
    ) -> Decision {
        let values = self.basis.iter().zip(x).map(|(&basic, x)| (basic, x.hi())).collect();
        Decision { found, pivots, values, multipliers: y.iter().map(|y| y.hi()).collect(), doubt }
    }
}
