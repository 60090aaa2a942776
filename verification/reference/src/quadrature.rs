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

pub struct Quadrature {
    bits: u32,
}

impl Quadrature {
    pub fn new(bits: u32) -> Quadrature {
        Quadrature { bits }
    }

    fn nodes(&self, steps: u32) -> Rc<[Node]> {
        let new = || nodes(self.bits, 1.0 / f64::from(steps)).into();
        RULES.with_borrow_mut(|rules| rules.entry((self.bits, steps)).or_insert_with(new).clone())
    }

    /// ∫ f, refined until two steps agree to 25 digits of ∫ |f|; the finer one then has more.
    pub fn integral(&self, from: &Real, to: &Real, f: impl Fn(&Real) -> Real) -> Real {
        self.integrals(1e-25, from, to, |x| vec![f(x)]).remove(0)
    }

    /// Several integrals over the same nodes.
    pub fn integrals(&self, tolerance: f64, from: &Real, to: &Real, f: impl Fn(&Real) -> Vec<Real>) -> Vec<Real> {
        let length = to - from;
        let mut last: Option<Vec<Real>> = None;
        for steps in [8, 16, 24, 32, 48, 64, 96, 128] {
            let (mut sums, mut sizes) = (Vec::new(), Vec::new());
            for (share, upper, weight) in self.nodes(steps).iter() {
                let values = f(&if *upper { to - share * &length } else { from + share * &length });
                sums.resize(values.len(), Real::new(self.bits, 0.0));
                sizes.resize(values.len(), 0.0);
                for ((sum, size), value) in sums.iter_mut().zip(&mut sizes).zip(values) {
                    let term = weight * value * &length;
                    *size += term.abs().f64();
                    *sum = &*sum + term;
                }
            }
            let agrees = |(i, last): (usize, &Real)| (&sums[i] - last).abs().f64() <= tolerance * sizes[i];
            if last.is_some_and(|last| last.iter().enumerate().all(agrees)) {
                return sums;
            }
            last = Some(sums);
        }
        panic!("quadrature did not converge");
    }
}
