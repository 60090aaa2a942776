//! Stiffness under a normal load, and the elliptical contact (3.2, 3.3, Fig. 10 and 11).

use super::*;

fn under_largest_load() -> [[Case; 2]; 4] {
    FLATS_OVER_RADIUS
        .map(|flat| [0.1, 1.0].map(|share| Case::under_load(flat, LENGTH_OVER_RADIUS, share * LARGEST_LOAD, 1.0)))
}

pub fn stiffness_by_load() -> Claim {
    let gains =
        under_largest_load().map(|[low, high]| 100.0 * (high.initial_stiffness() / low.initial_stiffness() - 1.0));
    Claim {
        figure: "fig10",
        computed: format!("ten times the load: + {} % for a/R = 0, 0.02, 0.1, 0.5", list(&gains, 1)),
        stands: falls(&gains) && gains[3] > 0.0,
    }
}

pub fn width_by_load() -> Claim {
    let gains =
        under_largest_load().map(|[low, high]| 100.0 * (high.contact.half_width / low.contact.half_width - 1.0));
    Claim {
        figure: "fig10",
        computed: format!("ten times the load: b + {} %", list(&gains, 0)),
        stands: falls(&gains) && gains[3] > 0.0,
    }
}

pub fn slope_after_reversal() -> Claim {
    let error = largest(shapes().iter().flat_map(|case| {
        [0.3, REVERSAL, 1.0]
            .map(|force| relative(case.stiffness_after_reversal(force, 1e-12), case.initial_stiffness()))
    }));
    Claim {
        figure: "fig11",
        computed: format!("after reversals at Q/μP = 0.3, {REVERSAL} and 1, to {QUADRATURE:e}"),
        stands: error < QUADRATURE,
    }
}

pub fn common_tangent() -> Claim {
    let lengths = [5.0, 10.0, 20.0, 40.0, 1e4];
    let ratios =
        lengths.map(|length| Case::ellipse(length).initial_stiffness() / Case::flat(0.0, length).initial_stiffness());
    let distances = ratios.map(|ratio| (ratio - 1.0).abs());
    Claim {
        figure: "fig11",
        computed: format!("quotient of the initial stiffnesses {} for L/b = 5, 10, 20, 40, 10⁴", list(&ratios, 4)),
        stands: falls(&distances) && distances[1] < 0.02,
    }
}

pub fn elliptic_dissipates_more() -> Claim {
    let (cylinder, ellipse) = (Case::flat(0.0, LENGTH), Case::ellipse(LENGTH));
    let more = even(0.02, 1.0, 49).into_iter().all(|share| {
        let amplitude = share * cylinder.slip_displacement();
        ellipse.energy(share) > cylinder.energy(share)
            && ellipse.energy_of_amplitude(amplitude) > cylinder.energy_of_amplitude(amplitude)
    });
    let at_force = [0.1, 0.5, 1.0].map(|force| ellipse.energy(force) / cylinder.energy(force));
    let at_slip = cylinder.slip_displacement();
    Claim {
        figure: "fig11",
        computed: format!(
            "L/b = {LENGTH}: {} times as much at Q/μP = 0.1, 0.5, 1; {:.1} times at the cylinder's displacement of gross slip",
            list(&at_force, 1),
            ellipse.energy_of_amplitude(at_slip) / cylinder.energy_of_amplitude(at_slip)
        ),
        stands: more,
    }
}
