//! The tanh-sinh rule, which needs no smoothness at the ends of an interval.

use crate::Real;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;

/// Distance from the nearer end as a share of the interval, whether that is the upper end, and weight.
type Node = (Real, bool, Real);

fn nodes(bits: u32, step: f64) -> Vec<Node> {
    let half_pi = Real::pi(bits) / 2.0;
    let last = (4.5 / step) as i32;
    (-last..=last)
        .map(|k| {
            let t = Real::new(bits, f64::from(k.abs())) * step;
            let (up, down) = (t.exp(), (-&t).exp());
            let decay = (-(&half_pi * (&up - &down))).exp();
            let share = &decay / (1.0 + &decay);
            let weight = step * &half_pi * (up + down) * &decay / (1.0 + &decay).square();
            (share, k > 0, weight)
        })
        .collect()
}

/// Nodes by precision and steps per unit.
type Rules = BTreeMap<(u32, u32), Rc<[Node]>>;

thread_local!(static RULES: RefCell<Rules> = RefCell::default());

fn rule(bits: u32, steps: u32) -> Rc<[Node]> {
    let new = || nodes(bits, 1.0 / f64::from(steps)).into();
    RULES.with_borrow_mut(|rules| rules.entry((bits, steps)).or_insert_with(new).clone())
}

/// Integrals ∫ f over the same nodes, refined until two steps agree to 25 digits of ∫ |f|; the finer one then has more.
pub fn integrals<const K: usize>(from: &Real, to: &Real, f: impl Fn(&Real) -> [Real; K]) -> [Real; K] {
    let (length, bits) = (to - from, from.bits());
    let mut last: Option<[Real; K]> = None;
    for steps in [8, 16, 24, 32, 48, 64, 96, 128] {
        let (mut sums, mut sizes) = ([(); K].map(|()| Real::new(bits, 0.0)), [0.0; K]);
        for (share, upper, weight) in rule(bits, steps).iter() {
            let values = f(&if *upper { to - share * &length } else { from + share * &length });
            for ((sum, size), value) in sums.iter_mut().zip(&mut sizes).zip(values) {
                let term = weight * value * &length;
                *size += term.abs().f64();
                *sum = &*sum + term;
            }
        }
        if last.is_some_and(|last| (0..K).all(|i| (&sums[i] - &last[i]).abs().f64() <= 1e-25 * sizes[i])) {
            return sums;
        }
        last = Some(sums);
    }
    panic!("quadrature did not converge");
}
