//! What is tested, each subject in its module.

mod banks;
mod capacity;
mod cycles;
mod loops;
mod together;
mod walks;

use crate::Case;
use rand::Rng;
use rand_chacha::ChaCha8Rng;

/// All cases; `scale` is the length of the long ones over their full length.
pub fn all(scale: f64) -> Vec<Case> {
    let steps = |full: f64| (full * scale).max(100.0) as u64;
    let subjects = [
        walks::cases(steps(1e7)),
        cycles::cases(steps(1e8)),
        loops::cases(steps(1e4)),
        capacity::cases(steps(1e5), steps(1e6) as usize),
        together::cases(steps(1e3)),
        banks::cases(steps(1e6)),
    ];
    subjects.into_iter().flatten().collect()
}

/// Places on the way, in order, and its end.
pub fn divided(from: f64, to: f64, parts: usize, rng: &mut ChaCha8Rng) -> Vec<f64> {
    // Rounding must not lead beyond the end.
    let (low, high) = (from.min(to), from.max(to));
    let mut places: Vec<f64> =
        (1..parts).map(|_| (from + rng.random::<f64>() * (to - from)).clamp(low, high)).collect();
    places.sort_by(f64::total_cmp);
    if to < from {
        places.reverse();
    }
    places.push(to);
    places
}
