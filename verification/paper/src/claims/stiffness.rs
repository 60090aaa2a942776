//! Stiffness under a normal load, and the elliptical contact (3.2, 3.3, Fig. 10 and 11).

use super::*;

/// Increases of a quantity in per cent, by ten times the load.
fn gains(quantity: impl Fn(&Case) -> f64) -> [f64; 4] {
    FLATS_OVER_RADIUS.map(|flat| {
        let under = |share: f64| quantity(&Case::under_load(flat, LENGTH_OVER_RADIUS, share * LARGEST_LOAD, 1.0));
        100.0 * (under(1.0) / under(0.1) - 1.0)
    })
}

pub fn stiffness_by_load() -> Claim {
    let gains = gains(Case::initial_stiffness);
    (
        format!("ten times the load: + {} % for a/R = 0, 0.02, 0.1, 0.5", list(&gains, 1)),
        falls(&gains) && gains[3] > 0.0,
    )
}

pub fn width_by_load() -> Claim {
    let gains = gains(|case| case.contact.half_width);
    (format!("ten times the load: b + {} %", list(&gains, 0)), falls(&gains) && gains[3] > 0.0)
}

pub fn slope_after_reversal() -> Claim {
    let errors = shapes().into_iter().flat_map(|case| {
        [0.3, REVERSAL, 1.0]
            .map(|force| relative(case.stiffness_after_reversal(force, 1e-12), case.initial_stiffness()))
    });
    to_within(QUADRATURE, &format!("after reversals at Q/μP = 0.3, {REVERSAL} and 1, to"), errors)
}

pub fn common_tangent() -> Claim {
    let lengths = [5.0, 10.0, 20.0, 40.0, 1e4];
    let ratios =
        lengths.map(|length| Case::ellipse(length).initial_stiffness() / Case::flat(0.0, length).initial_stiffness());
    let distances = ratios.map(|ratio| (ratio - 1.0).abs());
    (
        format!("quotient of the initial stiffnesses {} for L/b = 5, 10, 20, 40, 10⁴", list(&ratios, 4)),
        falls(&distances) && distances[1] < 0.02,
    )
}

pub fn elliptic_dissipates_more() -> Claim {
    let (cylinder, ellipse) = (Case::flat(0.0, LENGTH), Case::ellipse(LENGTH));
    let by_force = |force| ellipse.energy(force) / cylinder.energy(force);
    let by_amplitude = |share: f64| {
        let amplitude = share * cylinder.slip_displacement();
        ellipse.energy_of_amplitude(amplitude) / cylinder.energy_of_amplitude(amplitude)
    };
    (
        format!(
            "L/b = {LENGTH}: {} times as much at Q/μP = 0.1, 0.5, 1; {:.1} times at the cylinder's displacement of gross slip",
            list(&[0.1, 0.5, 1.0].map(by_force), 1),
            by_amplitude(1.0)
        ),
        even(0.02, 1.0, 49).into_iter().all(|share| by_force(share) > 1.0 && by_amplitude(share) > 1.0),
    )
}
