//! All cases, by subject.

mod banks;
mod capacity;
mod cycles;
mod histories;
mod loops;
mod paths;

use crate::Case;

/// `scale` is the length of the long cases over their full length.
pub fn all(scale: f64) -> Vec<Case> {
    let steps = |full: f64| (full * scale).max(100.0) as u64;
    let subjects = [
        histories::cases(steps(1e7)),
        cycles::cases(steps(1e8)),
        loops::cases(steps(1e4)),
        capacity::cases(steps(1e5), steps(1e6) as usize),
        paths::cases(steps(1e3)),
        banks::cases(steps(1e6)),
    ];
    subjects.into_iter().flatten().collect()
}
