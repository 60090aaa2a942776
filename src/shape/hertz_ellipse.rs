//! Elliptical Hertz contact (section 3.3) in absolute terms, a sphere if both semi-axes are equal.
//!
//! Both semi-axes grow as leg, the semi-axis along the force. With the compliances C_n and C_t of a flat elliptical punch of the
//! semi-axes b and l under the normal force N0 of the parameters, and `n = N/N0 = (leg/b)³`,
//!
//! ```text
//! U = (3/2) C_n N0 n^(2/3),   S = (3/2) C_t N0 n^(2/3),   Λ = C n^(-1/3),   M = (2/5) N S.
//! ```
//!
//! The displacement at the centre under `T/(2πbl) (1 - x²/b² - y²/l²)^(-1/2)` (Boussinesq, and Cerruti's Eq. 5) gives sums over both
//! bodies,
//!
//! ```text
//! C_n = Σ (1-ν²)/(πE) J,      C_t = Σ (1+ν)/(πE) [(1-ν) J + ν J_cos],
//! J = ∫ dθ/root,   J_cos = ∫ cos²θ dθ/root,     root² = l² cos²θ + b² sin²θ,     θ from 0 to π/2,
//! ```
//!
//! complete elliptic integrals that the arithmetic-geometric mean evaluates.

use crate::error::Error;
use crate::limits::in_range;
use crate::numerics::guard::quotient;
use crate::parameters::{Common, EllipticParameters, Pair, positive};
use crate::shape::{Geometry, LayerCompliance, RoundedPunch, Shape};
use core::f64::consts::{FRAC_PI_2, PI};

impl Geometry for EllipticParameters {
    fn checked(&self) -> Result<Common, Error> {
        let EllipticParameters { normal_force, friction_coefficient, material, layer, .. } = *self;
        positive(self.semi_axis_x, Error::BadSemiAxisX)?;
        positive(self.semi_axis_y, Error::BadSemiAxisY)?;
        Common { normal_force, friction_coefficient, material, layer }.checked()
    }

    fn shape(&self) -> Result<Shape, Error> {
        let EllipticParameters { semi_axis_x, semi_axis_y, normal_force, ref material, .. } = *self;
        let composite_modulus = Pair::new(material).composite_modulus;
        for axis in [semi_axis_x, semi_axis_y] {
            in_range(&[axis], &[])?;
            in_range(&[axis, composite_modulus], &[])?;
        }
        in_range(&[semi_axis_x], &[semi_axis_y])?;
        in_range(&[normal_force], &[semi_axis_x, semi_axis_y])?;
        let (all, cosine) = cerruti_integrals(semi_axis_x, semi_axis_y);
        let sum = |term: &dyn Fn(f64) -> f64| -> f64 {
            material
                .iter()
                .map(|body| (1.0 + body.poisson_ratio) / (PI * body.young_modulus) * term(body.poisson_ratio))
                .sum()
        };
        let normal = sum(&|nu| (1.0 - nu) * all);
        let tangential = sum(&|nu| (1.0 - nu) * all + nu * cosine);
        let lateral = sum(&|nu| (1.0 - nu) * all + nu * (all - cosine));
        Ok(Shape {
            length: semi_axis_x,
            load_scale: normal_force,
            compliance_scale: 1.0,
            constants: [normal, tangential],
            per_approach: [tangential / normal, lateral / normal],
            pressure_scale: 1.5 / PI * (normal_force / (semi_axis_x * semi_axis_y) / semi_axis_x),
            reference: (semi_axis_x, RoundedPunch::ellipse(1.0)),
            composite_modulus,
            layer: LayerCompliance::default(),
            ..Shape::default()
        })
    }

    /// The approach, free of overflow.
    fn check_element(&self, modulus: f64) -> Result<(), Error> {
        [self.semi_axis_x, self.semi_axis_y]
            .iter()
            .try_for_each(|axis| in_range(&[self.normal_force], &[*axis, modulus]))
    }
}

/// J and J_cos over the semi-axes along (b) and across (l) the force \[1/m\].
///
/// With M the mean of both axes, J = π/(2M). The fraction of J for the direction of the smaller axis is
/// `½ [1 + Σ 2ⁿ c_n²/c_0²]`, where c_n are the half-differences of the means and c_0² = 1 - k'²: positive terms.
fn cerruti_integrals(along: f64, across: f64) -> (f64, f64) {
    let (small, large) = (along.min(across), along.max(across));
    let ratio = small / large;
    let (mut mean, mut geometric) = (1.0, ratio);
    // c_1²/c_0², then the next ones from c_{n+1} = c_n²/(4 M_{n+1}).
    let mut half = 0.5 * (1.0 - ratio);
    let mut square = 0.25 * (1.0 - ratio) / (1.0 + ratio);
    let mut power = 2.0;
    let mut sum = 1.0;
    for _ in 0..12 {
        sum += power * square;
        let next = 0.5 * (mean + geometric);
        geometric = (mean * geometric).sqrt();
        mean = next;
        let next_half = half * half / (2.0 * (mean + geometric));
        square *= quotient(next_half, half) * quotient(next_half, half);
        half = next_half;
        power *= 2.0;
        if square <= 1e-18 {
            break;
        }
    }
    let all = FRAC_PI_2 / (0.5 * (mean + geometric)) / large;
    let fraction = 0.5 * sum;
    // sin² belongs to the smaller axis: root² = large² (1 - k² sin²) for b < l, and with cos and sin exchanged for b > l.
    (all, if along <= across { all * (1.0 - fraction) } else { all * fraction })
}
