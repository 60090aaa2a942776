//! Histories of displacement: regular, random, and adversarial ones that depend on comparisons and rounding.

use crate::memory::Memory;
use rand::Rng;
use rand::rngs::SmallRng;
use rand::seq::IndexedRandom;

/// The next displacement, given the memory.
pub type History = Box<dyn FnMut(&Memory, &mut SmallRng) -> f64 + Send>;

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
        ("neighbours", neighbours(slip)),
        ("tiny and giant", tiny_and_giant(slip)),
        ("exact returns", exact_returns(slip)),
        ("multiples", multiples(slip / 16.0)),
        ("last digits", multiples(spacing)),
        ("subnormal", multiples(f64::from_bits(1))),
    ]
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
