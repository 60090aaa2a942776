//! Complex stiffness and energy (3.4, 3.5, Fig. 13 to 15).

use super::*;

pub fn end_of_microslip() -> Claim {
    let slope = |case: &Case, force: f64| case.at_force(force).stiffness() / case.contact.initial_stiffness;
    let (cylinder, ellipse, flat) = (Case::flat(0.0, LENGTH), Case::ellipse(LENGTH), Case::flat(NEARLY_FLAT, LENGTH));
    let slopes = [&ellipse, &cylinder].map(|case| slope(case, 1.0 - 1e-6));
    let ends = [&ellipse, &cylinder, &flat].map(|case| slope(case, 1.0));
    (
        format!(
            "stiffness at Q/μP = 1 - 10⁻⁶ over the initial one: ellipse {:.3}, cylinder {:.3}. The cylinder's does vanish at μP, \
             but only like 1/ln(1/c); that of a/b = {NEARLY_FLAT} ends at {:.3}",
            slopes[0], slopes[1], ends[2]
        ),
        slopes[0] < 0.02 && slopes[1] > 0.2 && ends[..2] == [0.0; 2] && ends[2] > 0.5,
    )
}

/// Displacement amplitudes in microslip and gross slip of every shape.
fn amplitudes() -> impl Iterator<Item = (Case, f64)> {
    let shares = || [0.5, 1.0, 2.0].into_iter();
    SHAPES.into_iter().flat_map(move |shape| shares().map(move |share| (Case::flat(shape, LENGTH), share))).map(
        |(case, share)| {
            let amplitude = share * case.slip_displacement();
            (case, amplitude)
        },
    )
}

pub fn first_harmonic() -> Claim {
    const INSTANTS: usize = 20_000;
    let errors = amplitudes().map(|(case, amplitude)| {
        let (displacements, forces) = case.hysteresis_loop(amplitude, INSTANTS);
        let (mut real, mut imaginary) = (0.0, 0.0);
        for (i, (displacement, force)) in displacements.iter().zip(&forces).take(INSTANTS).enumerate() {
            real += force * displacement / amplitude;
            imaginary -= force * (2.0 * PI * i as f64 / INSTANTS as f64).sin();
        }
        // From force over displacement in their units to K/(E* L).
        let unit = PI / 2.0 / amplitude * 2.0 / INSTANTS as f64;
        let expected = case.complex_stiffness(amplitude);
        largest([unit * real - expected.0, unit * imaginary - expected.1].map(f64::abs))
    });
    // The loop has kinks: the error of its sums scales as 1/INSTANTS².
    let (text, stands) = to_within(1e-7, "Fourier sums over the loop and the library's K', K'' agree to", errors);
    (format!("{text} E\\*L, in microslip and gross slip"), stands)
}

pub fn imaginary_part_dissipates() -> Claim {
    // π K'' δ0² in the unit of the energy.
    let errors = amplitudes().map(|(case, amplitude)| {
        (area(&case, amplitude) - 2.0 * case.complex_stiffness(amplitude).1 * amplitude * amplitude).abs()
    });
    let text = "the area of the loop is πK''δ0², in microslip and gross slip, to 1e-6 of the unit";
    (text.to_owned(), largest(errors) < 1e-6)
}

pub fn imaginary_part_by_shape() -> Claim {
    let cases = shapes();
    let ordered = even(0.05, 1.0, 19).into_iter().all(|share| {
        let amplitude = share * cases[4].slip_displacement();
        falls(&cases.each_ref().map(|case| case.complex_stiffness(amplitude).1))
    });
    let at_slip = cases.map(|case| case.complex_stiffness(case.slip_displacement()).1);
    (
        format!(
            "at every amplitude; K''/(E\\*L) at incipient gross slip {} for a/b = 0, 0.5, 0.75, 0.9, 0.99",
            list(&at_slip, 4)
        ),
        ordered && falls(&at_slip),
    )
}

pub fn no_microslip_of_a_flat() -> Claim {
    let flats = [0.9, 0.99, 0.999, 0.9999];
    let energies = flats.map(|shape| Case::flat(shape, LENGTH).energy(1.0));
    // The largest K'' of a spring-slider: 1/π of its stiffness, at twice the displacement of slip.
    let flat = Case::flat(flats[3], LENGTH);
    let peak = PI * flat.complex_stiffness(2.0 * flat.slip_displacement()).1 / flat.initial_stiffness();
    (
        format!(
            "energy at incipient gross slip {} for a/b = 0.9, 0.99, 0.999, 0.9999; the largest K'' of the last is {peak:.4} of a \
             spring-slider's",
            energies.map(|energy| format!("{energy:.1e}")).join(", ")
        ),
        falls(&energies) && energies[3] < 1e-4 && relative(peak, 1.0) < 1e-3,
    )
}

pub fn one_initial_stiffness() -> Claim {
    let expected = PI / (2.0 * ((2.0 * LENGTH).ln() + POISSON / (1.0 - POISSON)));
    let stiffnesses = shapes().map(|case| [case.initial_stiffness(), case.complex_stiffness(0.0).0]);
    let errors = stiffnesses.into_iter().flatten().map(|stiffness| relative(stiffness, expected));
    to_within(CLOSED_FORMS, &format!("π/(2 ln(2L/b) + 2ν/(1-ν)) = {expected:.4} for every a/b, to"), errors)
}

pub fn initial_stiffness_by_length() -> Claim {
    let lengths = [5.0, 10.0, 20.0, 40.0, 1e6, 1e100];
    let stiffnesses = lengths.map(|length| Case::flat(NEARLY_CYLINDER, length).complex_stiffness(0.0).0);
    (
        format!("{} for L/b = 5, 10, 20, 40, 10⁶, 10¹⁰⁰", list(&stiffnesses, 4)),
        falls(&stiffnesses) && stiffnesses[5] < 0.01,
    )
}

pub fn cube_of_the_force() -> Claim {
    let slopes =
        |from: f64, to: f64| shapes().map(|case| (case.energy(to) / case.energy(from)).ln() / (to / from).ln());
    // The next term of the energy is of the fourth power, with about the same factor.
    let error = largest(slopes(1e-4, 1.01e-4).map(|slope| (slope - 3.0).abs()));
    let (lower, upper) = (slopes(0.01, 0.1), slopes(0.1, 1.0));
    let steeper = |slopes: &[f64]| slopes.iter().all(|&slope| slope > 3.0 && slope < 3.5) && falls(slopes);
    (
        format!(
            "slope 3 for small forces, to 10⁻³ at Q/μP = 10⁻⁴. Mean slope from 0.01 to 0.1: {}, from 0.1 to 1: {} for a/b = 0, \
             0.5, 0.75, 0.9, 0.99: steeper towards gross slip",
            list(&lower, 2),
            list(&upper, 2)
        ),
        error < 1e-3 && steeper(&lower) && steeper(&upper),
    )
}

pub fn work_of_slip() -> Claim {
    let cases = [0.0, SHAPE, NEARLY_FLAT].map(|shape| Case::flat(shape, LENGTH));
    let errors = cases.iter().flat_map(|case| {
        [0.3, REVERSAL, 1.0].map(|force| {
            let damage = |x| case.pressure(x) * case.slip(x, force);
            let points = [0.0, case.flat_over_width(), case.stick_zone(force), 1.0];
            // Both edges, and four quarters of a cycle.
            relative(8.0 * integral(&points, 1.0, damage), case.energy(force))
        })
    });
    to_within(QUADRATURE, "the integral of μp s over the slip zones and the area of the loop agree to", errors)
}

pub fn unit_energy() -> Claim {
    let energies = shapes().map(|case| case.energy(1.0));
    (
        format!("1 to {CLOSED_FORMS:e}; other shapes less: {}", list(&energies[1..], 4)),
        relative(energies[0], 1.0) < CLOSED_FORMS && falls(&energies),
    )
}
