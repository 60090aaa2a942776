//! Complex stiffness and energy (3.4, 3.5, Fig. 13 to 15).

use super::*;

pub fn end_of_microslip() -> Claim {
    let slope = |case: &Case, force: f64| {
        let point = case.contact.curve_at_force(force * case.contact.slip_force).expect("a force");
        point.stiffness() / case.contact.initial_stiffness
    };
    let (cylinder, ellipse, flat) = (Case::flat(0.0, LENGTH), Case::ellipse(LENGTH), Case::flat(NEARLY_FLAT, LENGTH));
    let near = 1.0 - 1e-6;
    let slopes = [&ellipse, &cylinder].map(|case| slope(case, near));
    let kink = slope(&flat, 1.0);
    Claim {
        figure: "fig11",
        computed: format!(
            "stiffness at Q/μP = 1 - 10⁻⁶ over the initial one: ellipse {:.3}, cylinder {:.3}. The cylinder's does vanish at μP, \
             but only like 1/ln(1/c); that of a/b = {NEARLY_FLAT} ends at {kink:.3}",
            slopes[0], slopes[1]
        ),
        stands: slopes[0] < 0.02
            && slopes[1] > 0.2
            && slope(&ellipse, 1.0) == 0.0
            && slope(&cylinder, 1.0) == 0.0
            && kink > 0.5,
    }
}

pub fn first_harmonic() -> Claim {
    const INSTANTS: usize = 20_000;
    let error = largest(shapes().iter().flat_map(|case| {
        [0.5, 1.0, 2.0].into_iter().flat_map(move |share| {
            let amplitude = share * case.slip_displacement();
            let (displacements, forces) = case.hysteresis_loop(amplitude, INSTANTS);
            let (mut real, mut imaginary) = (0.0, 0.0);
            for (i, (displacement, force)) in displacements.iter().zip(&forces).take(INSTANTS).enumerate() {
                real += force * displacement / amplitude;
                imaginary -= force * (2.0 * PI * i as f64 / INSTANTS as f64).sin();
            }
            // From force over displacement in their units to K/(E* L).
            let unit = PI / 2.0 / amplitude * 2.0 / INSTANTS as f64;
            let (expected_real, expected_imaginary) = case.complex_stiffness(amplitude);
            [unit * real - expected_real, unit * imaginary - expected_imaginary].map(f64::abs)
        })
    }));
    // The loop has kinks: the error of its sums scales as 1/INSTANTS².
    let sums = 1e-7;
    Claim {
        figure: "fig13",
        computed: format!(
            "Fourier sums over the loop and the library's K', K'' agree to {sums:e} E\\*L, in microslip and gross slip"
        ),
        stands: error < sums,
    }
}

pub fn imaginary_part_dissipates() -> Claim {
    let error = largest(
        shapes()
            .iter()
            .flat_map(|case| {
                [0.5, 1.0, 2.0].map(|share| {
                    let amplitude = share * case.slip_displacement();
                    // π K'' δ0² in the unit of the energy.
                    let energy = 2.0 * case.complex_stiffness(amplitude).1 * amplitude * amplitude;
                    area(case, amplitude) - energy
                })
            })
            .map(f64::abs),
    );
    Claim {
        figure: "fig13",
        computed: "the area of the loop is πK''δ0², in microslip and gross slip, to 1e-6 of the unit".to_owned(),
        stands: error < 1e-6,
    }
}

pub fn imaginary_part_by_shape() -> Claim {
    let cases = shapes();
    let ordered = even(0.05, 1.0, 19).into_iter().all(|share| {
        let amplitude = share * cases[4].slip_displacement();
        falls(&cases.iter().map(|case| case.complex_stiffness(amplitude).1).collect::<Vec<_>>())
    });
    let at_slip: Vec<f64> = cases.iter().map(|case| case.complex_stiffness(case.slip_displacement()).1).collect();
    Claim {
        figure: "fig13",
        computed: format!(
            "at every amplitude; K''/(E\\*L) at incipient gross slip {} for a/b = 0, 0.5, 0.75, 0.9, 0.99",
            list(&at_slip, 4)
        ),
        stands: ordered && falls(&at_slip),
    }
}

pub fn no_microslip_of_a_flat() -> Claim {
    let flats = [0.9, 0.99, 0.999, 0.9999];
    let energies = flats.map(|shape| Case::flat(shape, LENGTH).energy(1.0));
    // The largest K'' of a spring-slider: 1/π of its stiffness, at twice the displacement of slip.
    let flat = Case::flat(flats[3], LENGTH);
    let peak = PI * flat.complex_stiffness(2.0 * flat.slip_displacement()).1 / flat.initial_stiffness();
    Claim {
        figure: "fig13",
        computed: format!(
            "energy at incipient gross slip {} for a/b = 0.9, 0.99, 0.999, 0.9999; the largest K'' of the last is {peak:.4} of a \
             spring-slider's",
            energies.map(|energy| format!("{energy:.1e}")).join(", ")
        ),
        stands: falls(&energies) && energies[3] < 1e-4 && relative(peak, 1.0) < 1e-3,
    }
}

pub fn one_initial_stiffness() -> Claim {
    let cases = shapes();
    let compliance = (2.0 * LENGTH).ln() + POISSON / (1.0 - POISSON);
    let expected = PI / (2.0 * compliance);
    let error = largest(cases.iter().flat_map(|case| {
        [case.initial_stiffness(), case.complex_stiffness(0.0).0].map(|stiffness| relative(stiffness, expected))
    }));
    Claim {
        figure: "fig13",
        computed: format!("π/(2 ln(2L/b) + 2ν/(1-ν)) = {expected:.4} for every a/b, to {CLOSED_FORMS:e}"),
        stands: error < CLOSED_FORMS,
    }
}

pub fn initial_stiffness_by_length() -> Claim {
    let lengths = [5.0, 10.0, 20.0, 40.0, 1e6, 1e100];
    let stiffnesses = lengths.map(|length| Case::flat(NEARLY_CYLINDER, length).complex_stiffness(0.0).0);
    Claim {
        figure: "fig14",
        computed: format!("{} for L/b = 5, 10, 20, 40, 10⁶, 10¹⁰⁰", list(&stiffnesses, 4)),
        stands: falls(&stiffnesses) && stiffnesses[5] < 0.01,
    }
}

pub fn cube_of_the_force() -> Claim {
    let slope = |case: &Case, from: f64, to: f64| (case.energy(to) / case.energy(from)).ln() / (to / from).ln();
    let cases = shapes();
    let small = cases.iter().map(|case| slope(case, 1e-4, 1.01e-4));
    // The next term of the energy is of the fourth power, with about the same factor.
    let error = largest(small.map(|slope| (slope - 3.0).abs()));
    let [lower, upper] =
        [(0.01, 0.1), (0.1, 1.0)].map(|(from, to)| cases.iter().map(|case| slope(case, from, to)).collect::<Vec<_>>());
    Claim {
        figure: "fig15",
        computed: format!(
            "slope 3 for small forces, to 10⁻³ at Q/μP = 10⁻⁴. Mean slope from 0.01 to 0.1: {}, from 0.1 to 1: {} for a/b = 0, \
             0.5, 0.75, 0.9, 0.99: steeper towards gross slip",
            list(&lower, 2),
            list(&upper, 2)
        ),
        stands: error < 1e-3
            && [&lower, &upper]
                .iter()
                .all(|slopes| slopes.iter().all(|&slope| slope > 3.0 && slope < 3.5) && falls(slopes)),
    }
}

pub fn work_of_slip() -> Claim {
    let cases = [0.0, SHAPE, NEARLY_FLAT].map(|shape| Case::flat(shape, LENGTH));
    let error = largest(cases.iter().flat_map(|case| {
        [0.3, REVERSAL, 1.0].map(|force| {
            let damage = |x| case.pressure(x) * case.slip(x, force);
            let points = [0.0, case.flat_over_width(), case.stick_zone(force), 1.0];
            // Both edges, and four quarters of a cycle.
            relative(8.0 * integral(&points, 1.0, damage), case.energy(force))
        })
    }));
    Claim {
        figure: "fig15",
        computed: format!("the integral of μp s over the slip zones and the area of the loop agree to {QUADRATURE:e}"),
        stands: error < QUADRATURE,
    }
}

pub fn unit_energy() -> Claim {
    let energy = Case::flat(0.0, LENGTH).energy(1.0);
    let others: Vec<f64> = shapes().iter().map(|case| case.energy(1.0)).collect();
    Claim {
        figure: "fig15",
        computed: format!("1 to {CLOSED_FORMS:e}; other shapes less: {}", list(&others[1..], 4)),
        stands: relative(energy, 1.0) < CLOSED_FORMS && falls(&others),
    }
}
