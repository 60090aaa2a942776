//! The family of the elliptical Hertz contact (section 3.3), a sphere when both semi-axes are equal.
//!
//! Sizes are σ, the stick ellipse's semi-axes over those of the contact; loads go with σ³, the approach with σ², so that
//!
//! ```text
//! x = (3/2) [1 - (1-τ)^(2/3)],      dx/dτ = (1-τ)^(-1/3) = 1/σ,      in units of C0 μ N,
//! ```
//!
//! with C0 the initial compliance. Cerruti's displacement at the centre (Eq. 5) under `T/(2πbl) (1 - x²/b² - y²/l²)^(-1/2)`
//! gives it as a sum over both bodies,
//!
//! ```text
//! C0 = Σ (1+ν)/(π E) [(1-ν) J + ν J_cos],     J = ∫ dθ/W,  J_cos = ∫ cos²θ dθ/W,     W² = l² cos²θ + b² sin²θ,
//! ```
//!
//! θ from 0 to π/2: complete elliptic integrals, taken from the arithmetic-geometric mean.

use crate::parameters::Material;
use crate::shape::rounded_punch::TINY;
use crate::shape::small_load::{SmallLoadSeries, TERMS, economized};
use crate::shape::{Complement, QuadraturePoint, SizeFamily, StickZone, SurfacePoint};
use core::f64::consts::{FRAC_PI_2, PI};

/// Shape-free: every elliptical contact has the same curve in its own units.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Elliptic;

/// h'' = (1/3) (1-τ)^(-4/3).
const CURVATURE: [f64; TERMS] = {
    let mut table = [1.0 / 3.0; TERMS];
    let mut n = 1;
    while n < TERMS {
        table[n] = table[n - 1] * (n as f64 + 1.0 / 3.0) / n as f64;
        n += 1;
    }
    table
};

static ORIGIN: SmallLoadSeries = SmallLoadSeries::new(1.0, economized(CURVATURE));

const SLIP_APPROACH: f64 = 1.5;

/// J and J_cos over the semi-axes along (b) and across (l) the force \[1/m\].
///
/// With M the mean of both axes, J = π/(2M). The share of J that goes with the smaller axis' direction is
/// `½ [1 + Σ 2ⁿ c_n²/c_0²]`, where c_n are the half-differences of the means and c_0² = 1 - k'²: positive terms.
fn cerruti_integrals(along: f64, across: f64) -> (f64, f64) {
    let (small, large) = (along.min(across), along.max(across));
    let ratio = small / large;
    let (mut mean, mut geometric) = (1.0, ratio);
    // c_1²/c_0², then the following ones from c_{n+1} = c_n²/(4 M_{n+1}).
    let mut half = 0.5 * (1.0 - ratio);
    let mut square = 0.25 * (1.0 - ratio) / (1.0 + ratio);
    let mut power = 2.0;
    let mut sum = 1.0;
    for _ in 0..12 {
        sum += power * square;
        let next = 0.5 * (mean + geometric);
        geometric = (mean * geometric).sqrt();
        mean = next;
        let following = half * half / (2.0 * (mean + geometric));
        square *= (following / half.max(TINY)) * (following / half.max(TINY));
        half = following;
        power *= 2.0;
        if square <= 1e-18 {
            break;
        }
    }
    let all = FRAC_PI_2 / (0.5 * (mean + geometric)) / large;
    let share = 0.5 * sum;
    // sin² goes with the smaller axis: W² = large² (1 - k² sin²) for b < l, and with cos and sin exchanged for b > l.
    (all, if along <= across { all * (1.0 - share) } else { all * share })
}

impl Elliptic {
    /// C0 \[m/N\]: displacement per force of the full stick.
    pub fn initial_compliance(along: f64, across: f64, material: &[Material; 2]) -> f64 {
        let (all, cosine) = cerruti_integrals(along, across);
        material
            .iter()
            .map(|body| {
                let nu = body.poisson_ratio;
                (1.0 + nu) / (PI * body.young_modulus) * ((1.0 - nu) * all + nu * cosine)
            })
            .sum()
    }
}

impl SizeFamily for Elliptic {
    fn origin(&self) -> &SmallLoadSeries {
        &ORIGIN
    }

    fn slip_shift(&self) -> f64 {
        SLIP_APPROACH
    }

    fn at_load_remaining(&self, remaining: f64) -> StickZone {
        let size = remaining.cbrt();
        let left = SLIP_APPROACH * size * size;
        let compliance_increase = if size > 0.0 { 1.0 / size.max(TINY) - 1.0 } else { f64::INFINITY };
        StickZone {
            load: Complement { consumed: 1.0 - remaining, remaining },
            shift: Complement { consumed: SLIP_APPROACH - left, remaining: left },
            compliance_increase,
            size_parameter: Some(size),
        }
    }

    fn at_shift_remaining(&self, remaining: f64) -> StickZone {
        let size = (remaining / SLIP_APPROACH).max(0.0).sqrt();
        let load = size * size * size;
        let compliance_increase = if size > 0.0 { 1.0 / size.max(TINY) - 1.0 } else { f64::INFINITY };
        StickZone {
            load: Complement { consumed: 1.0 - load, remaining: load },
            shift: Complement { consumed: SLIP_APPROACH - remaining, remaining },
            compliance_increase,
            size_parameter: Some(size),
        }
    }

    /// `(4/3) ∫ (1-u) (u-s) u^(-4/3) du` from s to 1.
    fn dissipation_beyond_half(&self, member: &StickZone) -> f64 {
        let s = member.load.remaining;
        let size = self.size(member);
        let square = size * size;
        (4.0 / 3.0) * (1.5 * (1.0 + s) * (1.0 - square) - 0.6 * (1.0 - s * square) + 3.0 * (s - square))
    }

    fn size(&self, member: &StickZone) -> f64 {
        1.0 / (1.0 + member.compliance_increase)
    }

    fn size_parameter(&self, member: &StickZone) -> f64 {
        member.size_parameter.unwrap_or_else(|| self.size(member))
    }

    fn station(&self, size: f64) -> QuadraturePoint {
        let left = SLIP_APPROACH * size * size;
        let inverse = 1.0 / size.max(1e-100);
        QuadraturePoint {
            shift: Complement { consumed: SLIP_APPROACH - left, remaining: left },
            compliance: inverse,
            dload_dsigma: 3.0 * size * size,
            dcompliance_dsigma: inverse * inverse,
        }
    }

    /// No branch point: nearly even spacing.
    fn log_branch_distance(&self) -> f64 {
        1.0
    }

    fn pressure(&self, place: &SurfacePoint) -> f64 {
        SLIP_APPROACH / PI * (place.from_edge * (1.0 + place.x)).max(0.0).sqrt()
    }

    fn shear(&self, place: &SurfacePoint, stick: &StickZone) -> f64 {
        let (size, x) = (self.size(stick), place.x);
        let outer = (place.from_edge * (1.0 + x)).max(0.0).sqrt();
        let inner = ((size - x) * (size + x)).max(0.0).sqrt();
        // The difference of both roots, where both exist, from the difference of their squares.
        let difference = if inner > 0.0 { lost_size(stick) * (1.0 + size) / (outer + inner).max(TINY) } else { outer };
        SLIP_APPROACH / PI * difference
    }

    fn slip(&self, _place: &SurfacePoint, _stick: &StickZone) -> Option<f64> {
        None
    }
}

/// 1 - σ from λ = 1/σ - 1.
fn lost_size(member: &StickZone) -> f64 {
    if member.compliance_increase < 1e300 {
        member.compliance_increase / (1.0 + member.compliance_increase)
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constant_load::contact::Contact;
    use crate::constant_load::contact::tests::{cylinder, ellipse};
    use crate::parameters::{CENTRE_POINT, EllipticParameters};
    use crate::shape::integrate;

    fn like(young_modulus: f64, poisson_ratio: f64) -> [Material; 2] {
        [Material { young_modulus, poisson_ratio }; 2]
    }

    #[test]
    fn a_sphere_has_the_stiffness_of_mindlin() {
        let radius = 0.3e-3;
        let material = [
            Material { young_modulus: 2.1e11, poisson_ratio: 0.3 },
            Material { young_modulus: 7e10, poisson_ratio: 0.42 },
        ];
        let compliance = Elliptic::initial_compliance(radius, radius, &material);
        let shear = |body: Material| 0.5 * body.young_modulus / (1.0 + body.poisson_ratio);
        let inverse: f64 = material.iter().map(|body| (2.0 - body.poisson_ratio) / shear(*body)).sum();
        assert!((compliance * 8.0 * radius / inverse - 1.0).abs() < 1e-15);
    }

    /// The example `cattaneo` of the program CONTACT; millimetres and newtons, numbers given to five digits. The friction
    /// work is that of one monotonic loading, a quarter of a cycle's.
    #[test]
    fn cattaneos_problem_has_the_shift_and_the_friction_work_known() {
        let (normal_force, radius, friction, ratio) = (9.1954, 50.0, 0.4, 0.42);
        let material = like(200.0 * 2.0 * (1.0 + ratio), ratio);
        let modulus = 200.0 * (1.0 + ratio) / (1.0 - ratio * ratio);
        let size: f64 = (0.75 * normal_force * radius / modulus).cbrt();
        let contact = Contact::elliptic(&EllipticParameters {
            semi_axis_x: size,
            semi_axis_y: size,
            normal_force,
            friction_coefficient: friction,
            material,
        })
        .unwrap();
        let force = 7.0 / 8.0 * friction * normal_force;
        let point = contact.curve_at_force(force).unwrap();
        let work = 0.25 * contact.dissipated_energy(force).unwrap();
        assert!((point.displacement() - 8.1724e-3).abs() < 0.5e-7, "{}", point.displacement());
        assert!((work - 2.7554e-3).abs() < 0.5e-7, "{work}");
        // Half of the contact's size sticks: (1 - 7/8)^(1/3).
        assert!((point.stick_half_width() / size - 0.5).abs() < 4e-16);
    }

    #[test]
    fn a_long_ellipse_tends_to_the_cylinder() {
        let nu = 0.3;
        for slenderness in [40.0, 400.0, 4000.0_f64] {
            let line = cylinder(slenderness, nu, CENTRE_POINT).unwrap();
            let compliance = Elliptic::initial_compliance(line.half_width, 0.01 / 2.0, &like(2e11, nu));
            // Both integrals for k' = b/l → 0, to the next term.
            let (square, log) = (16.0 / (slenderness * slenderness), slenderness.ln());
            let next = (1.0 - nu) * 0.25 * (log - 1.0) + nu * (0.75 - 0.5 * log);
            let expected = square * next / ((1.0 - nu) * log + nu);
            let off = compliance * line.initial_stiffness - 1.0;
            // The term after that is k'⁴ ln k', and both compliances are rounded.
            assert!((off - expected).abs() < square * square * log + 2e-15, "{slenderness}: {off:e} {expected:e}");
        }
    }

    #[test]
    fn swapped_axes_share_one_elliptic_integral() {
        for (one, two) in [(1.0, 1.0), (1.0, 1.01), (1e-3, 0.2), (1e-9, 1.0)] {
            let ((all, along), (same, across)) = (cerruti_integrals(one, two), cerruti_integrals(two, one));
            // cos² and sin² add up to 1; a share of nearly all or nothing has its error in the other.
            assert!((all / same - 1.0).abs() < 1e-15 && ((along + across) / all - 1.0).abs() < 1e-15, "{one} {two}");
            let compliance = |x: f64, y: f64, nu: f64| Elliptic::initial_compliance(x, y, &like(1.0, nu));
            assert!((compliance(one, two, 0.0) / compliance(two, one, 0.0) - 1.0).abs() < 1e-15);
            // With Poisson's ratio the contact that is long along the force is the softer one.
            assert!(one == two || compliance(two, one, 0.3) > compliance(one, two, 0.3));
        }
    }

    #[test]
    fn the_integrals_are_those_of_cerruti() {
        for (along, across) in [(1.0, 1.0), (1.0, 0.7), (0.3, 1.1)] {
            // The midpoint rule over a period errs by ((l-b)/(l+b))⁶⁴, 4e-16 of these axes, and by the rounding of its sum.
            let (mut all, mut cosine) = (0.0, 0.0);
            for k in 0..64 {
                let angle = PI * (k as f64 + 0.5) / 64.0;
                let (sine, cos) = angle.sin_cos();
                let term = PI / 128.0 / (across * cos).hypot(along * sine);
                all += term;
                cosine += term * cos * cos;
            }
            let (j, j_cos) = cerruti_integrals(along, across);
            assert!((j / all - 1.0).abs() < 4e-15 && (j_cos / cosine - 1.0).abs() < 4e-15, "{along} {across}");
        }
    }

    #[test]
    fn series_and_closed_form_meet() {
        // Below 1/2 the series, above the closed form: within 1e-12 of the change both have the same tangent.
        let family = Elliptic;
        let at = |tau: f64| family.at_load(Complement { consumed: tau, remaining: 1.0 - tau });
        let (low, high) = (at(0.5), at(0.5 + 1e-12));
        let step = 1e-12 * family.compliance(&low);
        assert!((high.shift.consumed - low.shift.consumed - step).abs() < 1e-15);
        assert!((high.compliance_increase - low.compliance_increase).abs() < 2e-12);
        let slope = family.d_dissipation(&low);
        assert!((family.dissipation(&high) - family.dissipation(&low) - 1e-12 * slope).abs() < 2e-15);
        // The whole cycle, and its integral over the family: e = 4 ∫ t (τ - t) h'' dt with τ = 1.
        let end = family.dissipation(&family.at_load_remaining(0.0));
        let sum = integrate(&family, 0.0, 1.0, |station| {
            let size = (station.shift.remaining / SLIP_APPROACH).sqrt();
            let remaining = size * size * size;
            4.0 * (1.0 - remaining) * remaining * station.dcompliance_dsigma
        });
        assert!((end - 1.2).abs() < 4e-16 && (sum - 1.2).abs() < 4e-15, "{end} {sum}");
    }

    #[test]
    fn tractions_on_the_axis_are_hertz_less_the_stick_ellipse() {
        let (x_axis, y_axis) = (0.1e-3, 0.4e-3);
        let contact = ellipse(x_axis, y_axis);
        let peak = 1.5 * 150.0 / (PI * x_axis * y_axis);
        let point = contact.curve_at_force(0.6 * contact.slip_force).unwrap();
        let stick = point.stick_half_width();
        for part in [0.0, 0.5, 0.9, 0.99, 1.0, 1.1] {
            let x = part * x_axis;
            let root = |size: f64| (1.0 - (x / size) * (x / size)).max(0.0).sqrt();
            // The stick ellipse carries σ³ of the load on σ² of the area.
            let shear = 0.4 * peak * (root(x_axis) - stick / x_axis * root(stick));
            assert!((contact.pressure(x) - peak * root(x_axis)).abs() < 1e-14 * peak, "{part}");
            assert!((point.shear(x) - shear).abs() < 1e-14 * peak, "{part}");
        }
    }
}
