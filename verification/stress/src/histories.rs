//! Histories of displacement: regular, random, chaotic, and adversarial ones that depend on comparisons and rounding.

use crate::memory::Memory;
use rand::Rng;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

/// The next displacement, given the memory.
pub type History = Box<dyn FnMut(&Memory, &mut ChaCha8Rng) -> f64 + Send>;

/// Below the largest displacement of the interface (1e150), with room for sums.
const FARTHEST: f64 = 1e149;

/// All kinds, by name, for a displacement of gross slip.
pub fn all(slip: f64) -> Vec<(&'static str, History)> {
    let spacing = f64::from_bits(slip.to_bits() + 1) - slip;
    vec![
        ("scattered", scattered(slip)),
        ("random walk", random_walk(slip)),
        ("spirals", spirals(slip)),
        ("drifting sine", drifting_sine(slip)),
        ("logistic map", logistic_map(slip)),
        ("Lorenz", lorenz(slip)),
        ("Duffing", duffing(slip)),
        ("neighbours", neighbours(slip)),
        ("tiny and giant", tiny_and_giant(slip)),
        ("exact returns", exact_returns(slip)),
        ("multiples", multiples(slip / 16.0)),
        ("last digits", multiples(spacing)),
        ("subnormal", multiples(f64::from_bits(1))),
    ]
}

pub fn names() -> Vec<&'static str> {
    all(1.0).into_iter().map(|(name, _)| name).collect()
}

fn scattered(slip: f64) -> History {
    Box::new(move |_, rng| {
        let width = if rng.random_bool(0.2) { 3.0 } else { 1.0 };
        rng.random_range(-width..width) * slip
    })
}

/// Steps of a tenth of gross slip within a range that changes.
fn random_walk(slip: f64) -> History {
    let (mut place, mut range) = (0.0_f64, 1.0);
    Box::new(move |_, rng| {
        if rng.random_bool(1e-3) {
            range = rng.random_range(0.1..2.0);
        }
        place = (place + rng.random_range(-0.1..0.1_f64)).clamp(-range, range);
        place * slip
    })
}

/// Nested loops inwards, then outwards, closing loop after loop.
fn spirals(slip: f64) -> History {
    let (mut width, mut ratio, mut side, mut left) = (1.0, 0.9, 1.0, 0);
    Box::new(move |_, rng| {
        if left == 0 {
            left = rng.random_range(2..60);
            ratio = rng.random_range(0.5_f64..0.999).powi(if ratio < 1.0 { -1 } else { 1 });
        }
        left -= 1;
        side = -side;
        width *= ratio;
        if !(1e-6..=1.2).contains(&width) {
            width = rng.random_range(0.2..1.2);
        }
        side * width * slip
    })
}

/// Cycles whose mean drifts far into gross slip and back.
fn drifting_sine(slip: f64) -> History {
    let (mut phase, mut middle, mut speed, mut amplitude) = (0.0_f64, 0.0, 1e-3, 0.8);
    Box::new(move |_, rng| {
        if rng.random_bool(2e-3) {
            amplitude = rng.random_range(0.0..1.5);
            speed = 10f64.powf(rng.random_range(-6.0..0.0)) * if middle > 0.0 { -1.0 } else { 1.0 };
        }
        phase = (phase + rng.random_range(0.05..0.4)) % std::f64::consts::TAU;
        middle += speed;
        (middle + amplitude * phase.sin()) * slip
    })
}

fn logistic_map(slip: f64) -> History {
    let (mut x, mut width) = (0.3_f64, 1.0);
    Box::new(move |_, rng| {
        x = 3.9999 * x * (1.0 - x);
        if rng.random_bool(1e-3) {
            width = 10f64.powf(rng.random_range(-3.0..0.3));
        }
        (2.0 * x - 1.0) * width * slip
    })
}

/// A Runge-Kutta step.
fn runge_kutta<const N: usize>(x: [f64; N], h: f64, rate: impl Fn([f64; N]) -> [f64; N]) -> [f64; N] {
    let towards = |k: [f64; N], h: f64| std::array::from_fn(|i| x[i] + h * k[i]);
    let k1 = rate(x);
    let k2 = rate(towards(k1, 0.5 * h));
    let k3 = rate(towards(k2, 0.5 * h));
    let k4 = rate(towards(k3, h));
    std::array::from_fn(|i| x[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
}

fn lorenz(slip: f64) -> History {
    let mut x = [1.0, 1.0, 20.0];
    Box::new(move |_, _| {
        x = runge_kutta(x, 0.01, |[x, y, z]| [10.0 * (y - x), x * (28.0 - z) - y, x * y - 8.0 / 3.0 * z]);
        x[0] / 18.0 * slip
    })
}

/// A driven buckled beam in its chaotic range.
fn duffing(slip: f64) -> History {
    let mut state = [0.1, 0.0, 0.0];
    Box::new(move |_, _| {
        state = runge_kutta(state, 0.05, |[x, v, t]| [v, x - x * x * x - 0.3 * v + 0.5 * (1.2 * t).cos(), 1.0]);
        state[0] * 0.8 * slip
    })
}

/// Reversals within a few doubles, rarely a jump.
fn neighbours(slip: f64) -> History {
    let mut place = 0.4 * slip;
    Box::new(move |_, rng| {
        if rng.random_bool(0.01) {
            place = rng.random_range(-1.3..1.3) * slip;
        }
        for _ in 0..rng.random_range(0..4) {
            place = if rng.random() { place.next_up() } else { place.next_down() };
        }
        place
    })
}

/// Steps of every size, from a part in 1e18 of gross slip to the largest displacement allowed.
fn tiny_and_giant(slip: f64) -> History {
    let farthest = (FARTHEST / slip).log10();
    Box::new(move |memory, rng| {
        let exponent =
            if rng.random_bool(0.02) { rng.random_range(0.0..farthest) } else { rng.random_range(-18.0..0.5) };
        let step = slip * 10f64.powf(exponent) * if rng.random() { 1.0 } else { -1.0 };
        let place = if rng.random_bool(0.02) { 0.0 } else { memory.now().displacement };
        (place + step).clamp(-FARTHEST, FARTHEST)
    })
}

/// Exactly to a reversal, its opposite, the ends of the elastic range or the origin, or to the next double.
fn exact_returns(slip: f64) -> History {
    Box::new(move |memory, rng| {
        let reversal = memory.points.choose(rng).map_or(0.0, |point| point.displacement);
        let end = memory.points[0].displacement;
        let target = match rng.random_range(0..12) {
            0..4 => reversal,
            4 => -reversal,
            5 => 2.0 * end - reversal,
            6 => slip.copysign(rng.random_range(-1.0..1.0)),
            7 => end - memory.slip_direction * 2.0 * slip,
            8 => 0.0,
            9 => -0.0,
            _ => rng.random_range(-1.0..1.0) * slip,
        };
        match rng.random_range(0..8) {
            0 => target.next_up(),
            1 => target.next_down(),
            _ => target,
        }
        .clamp(-10.0 * slip, 10.0 * slip)
    })
}

/// Small multiples of a unit, so that displacements repeat.
fn multiples(unit: f64) -> History {
    let mut most = 20.0;
    Box::new(move |_, rng| {
        if rng.random_bool(0.01) {
            most = rng.random_range(1.0..40.0);
        }
        let number: f64 = rng.random_range(-most..=most);
        number.round() * unit
    })
}

/// Random displacements between two, in order, and the end.
pub fn divided(from: f64, to: f64, parts: usize, rng: &mut ChaCha8Rng) -> Vec<f64> {
    // Rounding must not exceed the end.
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
