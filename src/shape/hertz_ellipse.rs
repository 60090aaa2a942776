//! Elliptical Hertz contact (section 3.3) in absolute terms, a sphere if both semi-axes are equal.
//!
//! Both semi-axes grow as leg, the semi-axis along the force. With the compliances C_n and C_t of a flat elliptical punch of the
//! semi-axes b and l under the normal force N0 of the parameters, and `n = N/N0 = (leg/b)³`,
//!
//! ```text
//! U = (3/2) C_n N0 n^(2/3),   S = (3/2) C_t N0 n^(2/3),   Λ = C n^(-1/3),   M = (2/5) N S.
//! ```
//!
//! The displacement at the centre under `T/(2πbl) (1 - x²/b² - y²/l²)^(-1/2)` (Boussinesq, and Cerruti's Eq. 5) gives sums over
//! both bodies,
//!
//! ```text
//! C_n = Σ (1-ν²)/(πE) J,      C_t = Σ (1+ν)/(πE) [(1-ν) J + ν J_cos],
//! J = ∫ dθ/root,   J_cos = ∫ cos²θ dθ/root,     root² = l² cos²θ + b² sin²θ,     θ from 0 to π/2,
//! ```
//!
//! complete elliptic integrals that the arithmetic-geometric mean evaluates. In units of b and N0 the load is `g = leg³`, with the
//! compliance 1/leg of each size in units of C, and `β = 1/(2 leg)`, `γ = 1/(5 leg)`, `ψ = 3 leg/4`.

use crate::error::Error;
use crate::limits::{in_range, quotient_in_range};
use crate::numerics::guard::{quotient, root};
use crate::parameters::{Common, EllipticParameters, Pair, positive};
use crate::shape::series::{Series, identity};
use crate::shape::size::Size;
use crate::shape::tractions::SurfacePoint;
use crate::shape::{Geometry, LARGEST, Quantity, Shape, ShapeKind};
use core::array::from_fn;
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
            in_range(&[axis])?;
            in_range(&[axis, composite_modulus])?;
        }
        quotient_in_range(&[semi_axis_x], &[semi_axis_y])?;
        quotient_in_range(&[normal_force], &[semi_axis_x, semi_axis_y])?;
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
            unit: semi_axis_x,
            length: 1.0,
            load_scale: normal_force,
            compliances: [normal, tangential, lateral].map(|scale| [scale, 0.0]),
            pressure_scale: 4.0 / PI * (normal_force / (semi_axis_x * semi_axis_y) / semi_axis_x),
            reference_half_width: semi_axis_x,
            reference_size: Size::new(ShapeKind::HertzEllipse, 0.0, 1.0),
            composite_modulus,
            ..Shape::default()
        })
    }

    /// The largest size, with loads and displacements up to 2^498.
    fn largest_size(&self, shape: &Shape, _directions: usize) -> Result<f64, Error> {
        // The approach must not overflow.
        for axis in [self.semi_axis_x, self.semi_axis_y] {
            quotient_in_range(&[self.normal_force], &[axis, shape.composite_modulus])?;
        }
        let by_load = (LARGEST / shape.load_scale).cbrt();
        let [[normal, _], [tangential, _], _] = shape.compliances;
        let compliance = 1.5 * normal.max(tangential);
        Ok(shape.unit * by_load.min((LARGEST / (compliance * shape.load_scale)).sqrt()))
    }
}

pub fn angle(size: &Size) -> f64 {
    0.75 * size.leg
}

pub fn rates(_: &Size) -> [f64; 2] {
    [1.0, 0.0]
}

pub fn load(size: &Size) -> f64 {
    size.leg * size.leg * size.leg
}

pub fn beta(size: &Size, _: f64) -> f64 {
    quotient(0.5, size.leg)
}

pub fn gamma(size: &Size, _: f64) -> f64 {
    quotient(0.2, size.leg)
}

pub fn at_load(size: &Size, load: f64) -> Size {
    size.resized(load.cbrt())
}

pub fn estimated_leg(_: &Size, load: f64) -> f64 {
    (load / 1.5).sqrt()
}

/// The difference of the pressures `sqrt(s² - x²)` of two sizes.
pub fn pressure(_: &Size, [from, _, square_difference]: [f64; 3], point: &SurfacePoint) -> f64 {
    let outer = point.from_edge * (1.0 + point.x);
    let inner = (from - point.x) * (from + point.x);
    // The sum of both heights; the inner one is 0 outside that size.
    let sum = root(outer) + root(inner);
    0.375 * if inner > 0.0 { quotient(square_difference, sum) } else { sum }
}

pub fn slip(_: &Size, _: &SurfacePoint) -> f64 {
    f64::NAN
}

/// The series of an ellipse are binomial: N scales as U and S to the power 3/2.
pub fn series(_: &Size, shape: &Shape, leg: f64, argument: Quantity) -> [Series; 3] {
    let binomial = |value: f64, exponent: f64| -> Series {
        let mut term = value;
        from_fn(|k| {
            let coefficient = term;
            term *= (exponent - k as f64) / (k + 1) as f64;
            coefficient
        })
    };
    let size = shape.size(leg);
    let [approach, shift] = [Quantity::Approach, Quantity::Shift]
        .map(|quantity| shape.own_sums(shape.compliance_coefficients(quantity), &size, size.load())[0]);
    let load = shape.load(leg);
    if argument == Quantity::Load {
        let power = binomial(1.0, 2.0 / 3.0);
        [identity(load), power.map(|term| approach * term), power.map(|term| shift * term)]
    } else {
        [binomial(load, 1.5), identity(approach), identity(shift)]
    }
}

/// J and J_cos over the semi-axes along (b) and across (l) the force \[1/m\].
///
/// With M the mean of both axes, J = π/(2M). The fraction of J for the direction of the smaller axis is
/// `½ [1 + Σ 2ⁿ c_n²/c_0²]`, where c_n are the half-differences of the means and c_0² = 1 - k'²: positive terms.
fn cerruti_integrals(along: f64, across: f64) -> (f64, f64) {
    let large = along.max(across);
    let ratio = along.min(across) / large;
    let (mut mean, mut geometric, mut half_difference) = (1.0, ratio, 0.5 * (1.0 - ratio));
    // 2 c_1²/c_0², then the next terms from c_{n+1} = c_n²/(4 M_{n+1}).
    let (mut sum, mut term) = (1.0, half_difference / (1.0 + ratio));
    while term > 1e-17 {
        sum += term;
        (mean, geometric) = (0.5 * (mean + geometric), (mean * geometric).sqrt());
        let decrease = half_difference / (2.0 * (mean + geometric));
        half_difference *= decrease;
        term *= 2.0 * decrease * decrease;
    }
    let all = FRAC_PI_2 / (0.5 * (mean + geometric)) / large;
    let fraction = 0.5 * sum;
    // sin² belongs to the smaller axis: root² = large² (1 - k² sin²) for b < l, and with cos and sin exchanged for b > l.
    (all, if along <= across { all * (1.0 - fraction) } else { all * fraction })
}
