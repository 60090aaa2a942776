//! Two tangential directions with rough layers: gross slip, energy of long steps, stiffness of a stuck contact, continuity of the
//! force.

mod common;

use common::Random;
use common::two_directions::*;
use microslip::element::{Directions, Element, NormalInput};
use microslip::law::LawStep;
use microslip::parameters::{EllipticParameters, Layer, Material, Parameters};
use microslip::two_directions::TwoDirections;
use std::f64::consts::TAU;

/// A value between two positive ones, uniform in its logarithm.
fn between(random: &mut Random, low: f64, high: f64) -> f64 {
    low * (high / low).powf(random.next())
}

/// A flat of a/b from 0 to 0.999 or an ellipse under 1000 N, and its layer: compliances of 0.01 to 100 times those of the contact,
/// N_c of 1 N to 1e6 N, one in four without.
fn element(random: &mut Random, poisson_ratio: f64) -> Element {
    let (material, friction_coefficient) = ([Material { poisson_ratio, ..STEEL }; 2], 0.5);
    let build = |flat_half_width: f64, ratio: f64, layer: Layer| {
        if ratio > 0.0 {
            let own = elliptic_parameters(1e-3, ratio * 1e-3);
            let parameters = EllipticParameters { friction_coefficient, material, layer, ..own };
            return Element::elliptic(&parameters, Directions::Two, NormalInput::Force).unwrap();
        }
        element_of(&Parameters { friction_coefficient, material, layer, ..parameters(flat_half_width) })
    };
    let cylinder = build(0.0, 0.0, Layer::none()).half_width;
    let flat = if random.next() < 0.25 { 0.0 } else { cylinder * between(random, 1e-2, 10.0) };
    let ratio = if random.next() < 0.3 { between(random, 0.2, 5.0) } else { 0.0 };
    let bare = build(flat, ratio, Layer::none());
    if random.next() < 0.25 {
        return bare;
    }
    let layer = Layer {
        normal_compliance: between(random, 0.01, 100.0) / bare.normal_stiffness,
        tangential_compliance: between(random, 0.01, 100.0) / bare.tangential_stiffness,
        stiffening_load: 1000.0 * between(random, 1e-3, 1e3),
        reference_load: 0.0,
    };
    build(flat, ratio, layer)
}

/// The larger slip displacement of both directions under a load.
fn slip_displacement(element: &Element, load: f64) -> f64 {
    let limit = element.friction_coefficient * load;
    element.displacement_under(0, limit, load).value.max(element.displacement_under(1, limit, load).value)
}

#[test]
fn long_slides_carry_the_friction_force_and_dissipate_their_work() {
    let mut random = Random(11);
    for k in 0..150 {
        let poisson_ratio = if k < 120 { 0.5 * random.next() } else { 0.0 };
        let element = element(&mut random, poisson_ratio);
        let load = 1000.0 * (0.3 + 0.7 * random.next());
        let (sin, cos) = (TAU * random.next()).sin_cos();
        // Closing, a tenfold load after a small slide, and a constant load.
        for start in [0.0, 0.1 * load, load] {
            // Springs that were displaced the other way still pass 5 slip displacements.
            let length = between(&mut random, 7.0, 1000.0) * slip_displacement(&element, load);
            let mut contact = Contact::new(&element);
            let mut from = [0.0, 0.0, start];
            if start > 0.0 {
                contact.to(from);
                from[1] = 2.0 * random.next() * slip_displacement(&element, start);
                contact.to(from);
            }
            let to = [from[0] + length * cos, from[1] + length * sin, load];
            let (mut fine, mut short) = (contact.clone(), contact.clone());
            let step = contact.to(to);
            let missing = |step: &LawStep<TwoDirections>| {
                1.0 - step.force[0].hypot(step.force[1]) / (element.friction_coefficient * load)
            };
            let error = missing(&step).abs();
            let of_energy = (step.dissipated / fine.along(from, to, 64) - 1.0).abs();
            assert!(error < 1e-12 && of_energy < 0.07, "{start} {length:e}: {error:e} {of_energy:e}, {element:?}");
            // Unless both directions are equally stiff, the points, whose shares of the force differ between them, turn apart: a
            // shorter slide carries less, by the second order of the angles.
            if from[1] == 0.0 {
                let part = 3.0 * slip_displacement(&element, load) / length;
                let error = missing(&short.to([part * (to[0] - from[0]), part * to[1], load]));
                assert!(error < if k < 120 { 4e-4 } else { 4e-12 }, "{start}: {error:e}, {element:?}");
            }
        }
    }
}

/// In any direction, under loads down to 1e-2 of that of the tables, after unloading too.
#[test]
fn the_stiffness_of_a_stuck_contact_is_that_of_the_curve() {
    let mut random = Random(12);
    for _ in 0..200 {
        let poisson_ratio = 0.5 * random.next();
        let element = element(&mut random, poisson_ratio);
        let load = 1000.0 * between(&mut random, 1e-2, 1.0);
        let mut contact = Contact::new(&element);
        contact.to([0.0, 0.0, 1000.0]);
        contact.to([0.0, 0.0, load]);
        let (sin, cos) = (TAU * random.next()).sin_cos();
        let small = 1e-6 * slip_displacement(&element, load);
        let step = contact.to([small * cos, small * sin, load]);
        let expected = [cos, sin].map(|part| small * part);
        let expected = [0, 1].map(|k| expected[k] / element.displacement_under(k, 0.0, load).slope);
        let error = (step.force[0] - expected[0]).hypot(step.force[1] - expected[1]) / expected[0].hypot(expected[1]);
        assert!(error < 2e-4, "{load}: {error:e}, {element:?}");
    }
}

/// The largest jump on a line from 0 to 1, of which values and derivatives are given: an interval is halved until the derivatives
/// at its ends explain the difference of the values to 3e-7.
fn jump(mut of: impl FnMut(f64) -> [[f64; 2]; 2]) -> f64 {
    let (mut largest, mut halvings) = (0.0f64, 0);
    let mut intervals = vec![[(0.0, of(0.0)), (1.0, of(1.0))]];
    while let Some([low, high]) = intervals.pop() {
        let width = high.0 - low.0;
        let unexplained = [0, 1].map(|k| high.1[0][k] - low.1[0][k] - 0.5 * width * (low.1[1][k] + high.1[1][k]));
        let unexplained = unexplained[0].hypot(unexplained[1]);
        if unexplained > 3e-7 && width <= 1e-12 {
            largest = largest.max(unexplained);
        } else if unexplained > 3e-7 {
            halvings += 1;
            assert!(halvings < 20_000, "the derivatives explain nothing");
            let at = 0.5 * (low.0 + high.0);
            let middle = (at, of(at));
            intervals.extend([[low, middle], [middle, high]]);
        }
    }
    largest
}

/// The largest jump of the force of a step over mu N, on lines from displacements of random histories; with loads that differ by a
/// part.
fn jumps(random: &mut Random, elements: usize, by_load: f64) -> f64 {
    let mut largest = 0.0f64;
    for _ in 0..elements {
        let poisson_ratio = 0.5 * random.next();
        let element = element(random, poisson_ratio);
        let scale = between(random, 0.1, 4.0) * slip_displacement(&element, 1000.0);
        let (mut contact, mut at) = (Contact::new(&element), [0.0, 0.0, 700.0]);
        if by_load != 0.0 {
            // The springs are not aligned anew from there on.
            contact.to([0.0, 0.0, 1000.0]);
        }
        for k in 0..60 {
            at = [at[0] + scale * random.signed(), at[1] + scale * random.signed(), at[2]];
            if k % 3 == 0 {
                at[2] = 1000.0 * between(random, 0.02, 1.0);
            }
            let slip_force = element.friction_coefficient * at[2];
            let line = [0.3 * scale * random.signed(), 0.3 * scale * random.signed(), by_load * at[2]];
            largest = largest.max(jump(|part| {
                let step = contact.trial([0, 1, 2].map(|i| at[i] + part * line[i]));
                let slope = |i: usize| (0..3).map(|j| step.tangent[3 * j + i] * line[j]).sum::<f64>() / slip_force;
                [[step.force[0] / slip_force, step.force[1] / slip_force], [slope(0), slope(1)]]
            }));
            contact.to(at);
        }
    }
    largest
}

/// Where the middle of a step begins to slip while its end sticks, where a contact that sticks exceeds Coulomb's bound, where
/// Newton's method needs sweeps, and where springs are released: with these seeds, all are met. From one load to the next the force
/// jumps where the size inside the edge, under a load that is smaller by 8e-6, passes a node.
#[test]
fn the_force_does_not_jump() {
    for (seed, elements) in [(15, 8), (23, 48), (1096, 8), (3220, 8)] {
        for (by_load, bound) in [(0.0, 1e-6), (-0.03, 1e-5)] {
            let size = jumps(&mut Random(seed), elements, by_load);
            assert!(size <= bound, "{seed} {by_load}: {size:e}");
        }
    }
    for (seed, elements) in [(2010, 7), (2043, 6), (2127, 8), (3046, 8)] {
        let size = jumps(&mut Random(seed), elements, -0.9);
        assert!(size <= 1e-5, "{seed}: {size:e}");
    }
}

/// The largest jump of the harmonic force, that in phase, over μ times the mean load, on a line of coefficients along which the
/// load grows or turns its phase.
fn jump_of_harmonic_force(random: &mut Random, periods: usize, turns: bool) -> f64 {
    let poisson_ratio = 0.5 * random.next();
    let element = element(random, poisson_ratio);
    let scale = between(random, 0.1, 4.0) * slip_displacement(&element, 1000.0);
    let (mean, swing, (sin, cos)) =
        (between(random, 50.0, 500.0), 0.9 * random.next(), (TAU * random.next()).sin_cos());
    let (mut start, mut line) = ([0.0; COEFFICIENTS], [0.0; COEFFICIENTS]);
    for i in 0..6 {
        (start[i], line[i]) = (scale * random.signed(), 0.3 * scale * random.signed());
    }
    let (a, b, growth) = (mean * swing * cos, mean * swing * sin, 0.1 * random.signed());
    start[6..].copy_from_slice(&[mean, a, b]);
    line[6..].copy_from_slice(&if turns { [0.0, -0.3 * b, 0.3 * a] } else { [mean, a, b].map(|load| growth * load) });
    let slip_force = element.friction_coefficient * mean;
    jump(|part| {
        let motion = std::array::from_fn(|i| start[i] + part * line[i]);
        let Harmonic { force, jacobian, .. } = harmonic(&element, periods, &motion);
        let slope = |i: usize| (0..COEFFICIENTS).map(|j| jacobian[COEFFICIENTS * j + i] * line[j]).sum::<f64>();
        [[force[1] / slip_force, force[4] / slip_force], [slope(1) / slip_force, slope(4) / slip_force]]
    })
}

/// Unless the largest load moves to another sample: then by what the guide says, with the default number of periods and with 10.
#[test]
fn the_harmonic_force_does_not_jump() {
    let cases =
        [(0, 1, false, 1e-6), (1, 3, false, 1e-6), (2, 3, false, 1e-6), (366, 4, true, 5e-4), (193, 10, true, 7e-5)];
    for (seed, periods, turns, bound) in cases {
        let size = jump_of_harmonic_force(&mut Random(seed), periods, turns);
        assert!(size <= bound, "{seed} {periods} {turns}: {size:e}");
    }
}
