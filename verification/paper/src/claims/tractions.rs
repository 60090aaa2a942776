//! Pressure, shear and slip (2.2, Fig. 3 and 4, Eq. 15).

use super::*;

pub fn hertz() -> Claim {
    let case = Case::flat(0.0, LENGTH);
    let width = (4.0 * case.line_load() * case.edge_radius / (PI * case.contact.composite_modulus)).sqrt();
    let pressures = even(0.0, 0.999, 100).into_iter();
    let errors = pressures.map(|x| relative(case.pressure(x), 2.0 / PI * (1.0 - x * x).sqrt()));
    let errors = errors.chain([relative(case.contact.half_width, width)]);
    to_within(CLOSED_FORMS, "p and b = √(4PR/πE\\*) agree to", errors)
}

pub fn pressure_by_shape() -> Claim {
    let other = Material { young_modulus: 7e10, poisson_ratio: 0.1 };
    let errors = SHAPES.iter().flat_map(|&shape| {
        let (one, other) = (Case::flat(shape, LENGTH), Case::scaled(shape, 25.0, 0.7, other, 0.2));
        even(0.0, 0.999, 100).into_iter().map(move |x| relative(one.pressure(x), other.pressure(x)))
    });
    to_within(OTHER_UNITS, "other R, L, E, ν and load: the same to", errors)
}

/// 4PR/(a²E*).
fn shape_parameter(case: &Case) -> f64 {
    4.0 * case.line_load() * case.edge_radius / (case.flat.powi(2) * case.contact.composite_modulus)
}

pub fn two_limits_of_shape() -> Claim {
    let shapes = [(0.1, 1e-9), (1e-5, 1e-3)].map(|(flat, load)| Case::under_load(flat, LENGTH_OVER_RADIUS, load, 1.0));
    let flats = shapes.each_ref().map(Case::flat_over_width);
    let parameters = shapes.each_ref().map(shape_parameter);
    let consistent = [0, 1].map(|i| relative(2.0 * printed_load(flats[i]), parameters[i]));
    (
        format!(
            "4PR/(a²E\\*) = {:.0e}: a/b = {:.5}; {:.0e}: a/b = {:.1e}",
            parameters[0], flats[0], parameters[1], flats[1]
        ),
        // Eq. 1 loses digits as (1 - a/b)^(-3/2).
        largest(consistent) < 1e-8 && flats[0] > 0.999 && flats[1] < 1e-3,
    )
}

pub fn incomplete_contact() -> Claim {
    let falls_like_root = |case: Case| [1e-6, 1e-8].map(|left: f64| case.pressure(1.0 - left) / (2.0 * left).sqrt());
    let errors = shapes().map(falls_like_root).map(|[far, near]| relative(far, near));
    // The next term is of the order of 1e-6 over the width of the edge.
    ("as √(1-x²/b²) from x/b = 1 - 10⁻⁶ on, to 10⁻³, for every a/b".to_owned(), largest(errors) < 1e-3)
}

pub fn slip_at_any_force() -> Claim {
    let forces = even(0.0, 1.0, 100);
    let narrows = shapes().iter().all(|case| {
        let sticks: Vec<f64> = forces.iter().map(|&force| case.stick_zone(force)).collect();
        falls(&sticks) && (sticks[100] - case.flat_over_width()).abs() < CLOSED_FORMS
    });
    let widths = shapes().map(|case| 1.0 - case.stick_zone(0.01));
    (
        format!(
            "Q/μP = 0.01: (b-c)/b = {:.4} for the cylinder, {:.1e} for a/b = {}; c falls to a",
            widths[0], widths[4], SHAPES[4]
        ),
        narrows && widths.iter().all(|&width| width > 0.0),
    )
}

pub fn full_stick() -> Claim {
    let (case, force) = (Case::flat(0.0, LENGTH), 1e-6);
    let full = |x: f64| 1.0 / (PI * (1.0 - x * x).sqrt());
    // The stick zone ends 5e-7 before b: a relative error of that over 1 - x.
    let error = largest([0.0, 0.5, 0.9].map(|x| relative(case.shear(x, force) / force, full(x))));
    let quotients = [0.9, 0.99, 0.999].map(|x| full(x) / case.pressure(x));
    (
        format!(
            "the traction of a small force is bq/Q = 1/(π√(1-x²/b²)), to 10⁻⁵ at Q/μP = 10⁻⁶; over bp/P of the cylinder {} at \
             x/b = 0.9, 0.99, 0.999",
            list(&quotients, 1)
        ),
        error < 1e-5 && quotients.windows(2).all(|pair| pair[1] > 5.0 * pair[0]),
    )
}

pub fn shear_is_coulombs() -> Claim {
    let mut errors = Vec::new();
    let mut below = true;
    for (case, force) in shapes().iter().flat_map(|case| [0.1, 0.5, 0.9].map(|force| (case, force))) {
        let stick = case.stick_zone(force);
        for x in even(0.0, 0.999, 333) {
            let (shear, limit) = (case.shear(x, force), case.pressure(x));
            if x > stick { errors.push(relative(shear, limit)) } else { below &= shear < limit }
        }
        let carried = 2.0 * integral(&[0.0, case.flat_over_width(), stick, 1.0], 1.0, |x| case.shear(x, force));
        errors.push(relative(carried, force));
    }
    let (text, stands) = to_within(QUADRATURE, "for a/b from 0 to 0.99, to", errors);
    (text, stands && below)
}

pub fn width_of_contact() -> Claim {
    // b/√(4PR/πE*) of a/b = 10⁻⁴, which has 2/π of that left: 1 for Hertz.
    let width = |factor: f64| (PI / (factor * printed_load(1e-4) * 1e-8)).sqrt();
    let (printed, corrected) = (width(1.0), width(2.0));
    let library = relative(2.0 * printed_load(SHAPE), shape_parameter(&Case::flat(SHAPE, LENGTH)));
    (
        format!(
            "b over that of Hertz at a/b = 10⁻⁴: corrected {corrected:.4}, printed {printed:.4}; the library's a/b = {SHAPE} from \
             the corrected one, to {CLOSED_FORMS:e}"
        ),
        relative(corrected, 1.0) < 1e-4 && relative(printed, 2f64.sqrt()) < 1e-4 && library < CLOSED_FORMS,
    )
}

/// Integral over both halves of the width.
fn both_halves(traction: impl Fn(f64) -> f64) -> f64 {
    integral(&[0.0, SHAPE, 1.0], 1.0, |x| traction(x) + traction(-x))
}

pub fn load_of_pressure() -> Claim {
    let case = Case::flat(SHAPE, LENGTH);
    let (printed, corrected) = (both_halves(|x| printed_pressure(SHAPE, x)), both_halves(|x| case.pressure(x)));
    let law = case.reference().law(0);
    let exact = |x: f64| law.pressure(&law.real(x), None).f64();
    let library = largest(even(0.005, 0.995, 99).iter().map(|&x| relative(case.pressure(x), exact(x))));
    (
        format!(
            "a/b = {SHAPE}: corrected 1, and the library agrees with multi-precision to {CLOSED_FORMS:e}; printed {printed:.3}"
        ),
        relative(corrected, 1.0) < QUADRATURE && library < CLOSED_FORMS && relative(printed, 1.0) > 1e-3,
    )
}

/// Corrected, the relieved traction is the pressure of [`load_of_pressure`].
pub fn relieved_load() -> Claim {
    let printed = both_halves(|x| printed_relieved_traction(SHAPE, x));
    (format!("a/c = {SHAPE}: corrected 1; printed {printed:.3}, and infinite at x = a"), printed < 0.0)
}

pub fn slip_of_plane_problem() -> Claim {
    let case = Case::flat(SHAPE, LENGTH);
    let tractions = Tractions::first(&case, REVERSAL);
    let stick = case.stick_zone(REVERSAL);
    let outside = even(0.755, 0.995, 8).into_iter().map(|x| (tractions.slip(x, 1.0) - case.slip(x, REVERSAL)).abs());
    let in_stick = |limit| largest(even(0.05, 0.95 * stick, 8).iter().map(|&x| tractions.slip(x, limit).abs()));
    let edge = case.slip(1.0, REVERSAL);
    (
        format!(
            "with the upper limit b, to {QUADRATURE:e}; with the printed a the stick zone would slip up to {:.1} times as far as \
             the edge",
            in_stick(SHAPE) / edge
        ),
        largest(outside) < QUADRATURE && in_stick(1.0) < QUADRATURE && in_stick(SHAPE) > 0.1 * edge,
    )
}
