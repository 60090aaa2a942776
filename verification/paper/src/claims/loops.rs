//! Displacements and loops (2.3, 2.4, 3.1, Fig. 7 to 9).

use super::*;

pub fn far_field() -> Claim {
    let case = Case::flat(0.0, LENGTH);
    let tractions = Tractions::first(&case, 0.5);
    let quotients = [1.0, 10.0, 100.0].map(|depth| tractions.displacement_below(LENGTH, depth * LENGTH));
    let distances = quotients.map(|quotient| (quotient - 1.0).abs());
    (
        format!(
            "Eq. 3 below the centre, cylinder, L/b = {LENGTH}: over the displacement by T in one point {} at z/L = 1, 10, 100",
            list(&quotients, 5)
        ),
        falls(&distances) && distances[2] < 1e-4,
    )
}

pub fn displacement_of_tractions() -> Claim {
    let cases = [0.0, SHAPE, NEARLY_FLAT].iter().flat_map(|&shape| LENGTHS.map(|length| (shape, length)));
    let errors = cases.flat_map(|(shape, length)| {
        let case = Case::flat(shape, length);
        [0.1, 0.5, 0.9, 1.0]
            .map(|force| relative(case.displacement(force), Tractions::first(&case, force).displacement(length)))
    });
    to_within(QUADRATURE, "its quadrature and the library's closed form agree to", errors)
}

pub fn long_contact() -> Claim {
    let percent = LENGTHS.map(|length| {
        let case = Case::flat(0.0, length);
        let tractions = Tractions::first(&case, 0.5);
        100.0 * relative(tractions.displacement(length), tractions.displacement_of_any_length(length))
    });
    (
        format!("cylinder, Q/μP = 0.5: the displacement is off by {} % for L/b = 5, 10, 20, 40", list(&percent, 3)),
        falls(&percent) && percent[0] < 1.0,
    )
}

pub fn gross_slip_is_horizontal() -> Claim {
    let errors = shapes().into_iter().flat_map(|case| {
        [0.5, 2.0].map(|beyond| {
            let displacement = case.slip_displacement() + beyond;
            let loss = relative(case.energy_of_amplitude(displacement), case.energy(1.0) + 4.0 * beyond);
            largest([loss, (case.force(displacement) - 1.0).abs()])
        })
    });
    to_within(CLOSED_FORMS, "the force stays μN and the energy grows by 4μN per displacement, to", errors)
}

pub fn no_effect_of_frequency() -> Claim {
    let error = largest(shapes().map(|case| {
        let top = case.displacement(REVERSAL);
        let two = [top, -0.5 * top];
        let many = [&even(0.0, top, 100), &even(top, -0.49 * top, 1000), &two[1..]].concat();
        (case.force_after(&many) - case.force_after(&two)).abs()
    }));
    ("two steps of displacement, up and back, and 1103 lead to the same force, to the bit".to_owned(), error == 0.0)
}

pub fn direct_tractions() -> Claim {
    // Absolute, of displacements, forces and tractions of order one.
    let mut errors = Vec::new();
    let mut allowed = true;
    // No flat ends at one of these.
    let x = even(0.0033, 0.9971, 142);
    for shape in [0.0, SHAPE, NEARLY_FLAT] {
        let case = Case::flat(shape, LENGTH);
        let law = case.reference().law(0);
        let at = |force: f64| law.at_tau(&law.real(force));
        let (top, displacement) = (at(REVERSAL), case.displacement(REVERSAL));
        for force in AFTER_REVERSAL.into_iter().chain([0.6, 0.1, -0.75]) {
            let tractions = Tractions::after_reversal(&case, REVERSAL, force);
            let branch = displacement - 2.0 * case.displacement((REVERSAL - force) / 2.0);
            errors.extend([tractions.displacement(LENGTH) - branch, tractions.force() - force]);
            let half = at((REVERSAL - force) / 2.0);
            for &x in &x {
                let (traction, place) = (tractions.at(x), law.real(x));
                errors.push(traction - (law.shear(&place, &top) - 2.0 * law.shear(&place, &half)).f64());
                allowed &= traction.abs() <= case.pressure(x) * (1.0 + CLOSED_FORMS);
            }
        }
    }
    (
        format!(
            "Eq. 10 over the library's tractions, which agree with multi-precision, and Eq. 11 agree to \
             {QUADRATURE:e}; \\|q\\| <= μp everywhere"
        ),
        largest(errors.into_iter().map(f64::abs)) < QUADRATURE && allowed,
    )
}

pub fn reloading() -> Claim {
    let errors = shapes().into_iter().flat_map(|case| {
        let top = case.displacement(REVERSAL);
        even(-1.0, 1.0, 16).into_iter().map(move |share| {
            (case.force_after(&[top, -top, share * top]) + case.force_after(&[top, -share * top])).abs()
        })
    });
    to_within(CLOSED_FORMS, "forces after three displacements, up, back and up, and after two, agree to", errors)
}

pub fn mindlin() -> Claim {
    let sphere = Case::sphere();
    let slip = sphere.slip_displacement();
    let errors = [0.3, 0.8, 1.0].into_iter().flat_map(|top: f64| {
        let amplitude = slip * (1.0 - (1.0 - top).powf(2.0 / 3.0));
        let (displacements, forces) = sphere.hysteresis_loop(amplitude, 64);
        // Unloading from Q* by Mindlin, Mason, Osmer and Deresiewicz.
        displacements.into_iter().zip(forces).take(33).map(move |(displacement, force)| {
            let half = 1.0 - (top - force) / 2.0;
            let expected = slip * (2.0 * half.clamp(0.0, 1.0).powf(2.0 / 3.0) - (1.0 - top).powf(2.0 / 3.0) - 1.0);
            (displacement - expected).abs() / slip
        })
    });
    // Near full reversal of the force the power 2/3 amplifies rounding of 1e-16 to 1e-11.
    to_within(QUADRATURE, "their equation and the loop of the elliptical contact of equal axes agree to", errors)
}

pub fn curve_by_ratios() -> Claim {
    let other = Material { young_modulus: 7e10, poisson_ratio: POISSON };
    let ratios = SHAPES.iter().flat_map(|&shape| LENGTHS.map(|length| (shape, length)));
    let errors = ratios.flat_map(|(shape, length)| {
        let (one, other) = (Case::flat(shape, length), Case::scaled(shape, length, 0.7, other, 0.2));
        even(0.1, 1.0, 9).into_iter().map(move |force| relative(one.displacement(force), other.displacement(force)))
    });
    to_within(OTHER_UNITS, "other R, E, μ and load: the same initial loading, of which all else follows, to", errors)
}

pub fn area_by_shape() -> Claim {
    let cases = shapes();
    let ordered = even(0.05, 1.0, 19).into_iter().all(|share| {
        // Microslip of every shape.
        let amplitude = share * cases[4].slip_displacement();
        falls(&cases.each_ref().map(|case| case.energy_of_amplitude(amplitude)))
    });
    let [microslip, gross] = AMPLITUDES.map(|amplitude| {
        [NEARLY_CYLINDER, NEARLY_FLAT].map(|shape| Case::flat(shape, LENGTH).energy_of_amplitude(amplitude))
    });
    (
        format!(
            "at every amplitude; energies for a/b = {NEARLY_CYLINDER} and {NEARLY_FLAT}: {} at δ0 = {}, {} at {}, in gross slip",
            list(&microslip, 3),
            AMPLITUDES[0],
            list(&gross, 3),
            AMPLITUDES[1]
        ),
        ordered && falls(&microslip) && gross[1] > gross[0],
    )
}

pub fn slip_stays_on_the_edges() -> Claim {
    let stands = shapes().iter().all(|case| {
        let flat = case.flat_over_width();
        (flat == 0.0 || case.slip(0.999 * flat, 1.0) == 0.0) && case.slip(0.5 * (1.0 + flat), 1.0) > 0.0
    });
    ("up to μP the slip is 0 for \\|x\\| < a and positive beyond".to_owned(), stands)
}

pub fn length_is_a_spring() -> Claim {
    let bent = |shape, length: f64, force| {
        let series = (2.0 * length).ln() + POISSON / (1.0 - POISSON);
        Case::flat(shape, length).displacement(force) - series * force
    };
    let errors = SHAPES.iter().flat_map(|&shape| {
        let forces = even(0.1, 1.0, 9).into_iter().flat_map(|force| LENGTHS.map(|length| (force, length)));
        forces.map(move |(force, length)| (bent(shape, length, force) - bent(shape, LENGTH, force)).abs())
    });
    to_within(CLOSED_FORMS, "the displacement less Λ Q/μP is the same for L/b = 5, 10, 20, 40, to", errors)
}

pub fn area_by_length() -> Claim {
    let cases = LENGTHS.map(|length| Case::flat(NEARLY_CYLINDER, length));
    let energy = cases[0].energy(1.0);
    let error = largest(cases.iter().map(|case| relative(area(case, case.slip_displacement()), energy)));
    let closed = largest(cases.iter().map(|case| relative(case.energy(1.0), energy)));
    let slopes = cases.map(|case| case.initial_stiffness());
    (
        format!(
            "area {energy:.4} for L/b = 5, 10, 20, 40, equal to {CLOSED_FORMS:e}; initial stiffness {}",
            list(&slopes, 4)
        ),
        error < 1e-6 && closed < CLOSED_FORMS && falls(&slopes),
    )
}
