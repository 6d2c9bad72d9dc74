//! The zero of a function that falls.

/// Where a function that is above zero at the first end and not at the second becomes zero, to this accuracy; the second end where
/// it does not. By false position with the Illinois rule (Dowell and Jarratt 1971), and halving where that is slow.
pub(super) fn falling(of: &mut impl FnMut(f64) -> f64, [mut low, mut high]: [f64; 2], accuracy: f64) -> f64 {
    const MOST: usize = 200;
    let (mut above, mut below) = (of(low), of(high));
    if above <= 0.0 {
        return low;
    }
    if below > 0.0 {
        return high;
    }
    for k in 0..MOST {
        if high - low <= accuracy * high.abs().max(1.0) {
            break;
        }
        let share = above / (above - below);
        let middle = if k % 3 == 2 { 0.5 * (low + high) } else { low + share.clamp(0.01, 0.99) * (high - low) };
        let value = of(middle);
        if value > 0.0 {
            (low, above) = (middle, value);
            below *= 0.5;
        } else {
            (high, below) = (middle, value);
            above *= 0.5;
        }
    }
    high
}
