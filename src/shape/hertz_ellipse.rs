//! Elliptical Hertz contact (section 3.3) in absolute terms, a sphere if both semi-axes are equal.
//!
//! Both semi-axes grow as w, the semi-axis along the force. With the compliances C_n and C_t of a flat elliptical punch of the
//! semi-axes b and l under the normal force N0 of the parameters, and `n = N/N0 = (w/b)³`,
//!
//! ```text
//! U = (3/2) C_n N0 n^(2/3),   S = (3/2) C_t N0 n^(2/3),   K = C n^(-1/3),   M = (2/5) N S.
//! ```
//!
//! The displacement at the centre under `T/(2πbl) (1 - x²/b² - y²/l²)^(-1/2)` (Boussinesq, and Cerruti's Eq. 5) gives sums over both
//! bodies,
//!
//! ```text
//! C_n = Σ (1-ν²)/(πE) J,      C_t = Σ (1+ν)/(πE) [(1-ν) J + ν J_cos],
//! J = ∫ dθ/W,   J_cos = ∫ cos²θ dθ/W,     W² = l² cos²θ + b² sin²θ,     θ from 0 to π/2,
//! ```
//!
//! complete elliptic integrals that the arithmetic-geometric mean evaluates.

use crate::error::Error;
use crate::limits::in_range;
use crate::parameters::{EllipticParameters, Pair};
use crate::shape::rounded_punch::TINY;
use crate::shape::{Layer, Plane, Quantity, Series, Shape, identity};
use core::array::from_fn;
use core::f64::consts::{FRAC_PI_2, PI};

/// An elliptical Hertz contact.
#[derive(Debug, Clone, Copy, Default)]
pub struct HertzEllipse {
    semi_axis_x: f64,
    semi_axis_y: f64,
    normal_force: f64,
    /// C_n and C_t \[m/N\].
    normal: f64,
    tangential: f64,
    /// C_t for a force along y.
    lateral: f64,
}

impl HertzEllipse {
    /// S/U = C_t/C_n, the same for all sizes.
    pub(crate) fn tangential_ratio(&self) -> f64 {
        self.tangential / self.normal
    }

    /// The shape of parameters that were checked, N > 0.
    /// Errors: `OutOfRange` if derived quantities are not representable.
    pub fn new(parameters: &EllipticParameters) -> Result<HertzEllipse, Error> {
        let EllipticParameters { semi_axis_x, semi_axis_y, normal_force, ref material, .. } = *parameters;
        let modulus = Pair::new(material).composite_modulus;
        for axis in [semi_axis_x, semi_axis_y] {
            in_range(&[axis], &[])?;
            in_range(&[axis, modulus], &[])?;
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
        Ok(HertzEllipse {
            semi_axis_x,
            semi_axis_y,
            normal_force,
            normal: sum(&|nu| (1.0 - nu) * all),
            tangential: sum(&|nu| (1.0 - nu) * all + nu * cosine),
            lateral: sum(&|nu| (1.0 - nu) * all + nu * (all - cosine)),
        })
    }

    /// C_n or C_t.
    fn punch_compliance(&self, quantity: Quantity) -> f64 {
        if quantity == Quantity::Approach { self.normal } else { self.tangential }
    }

    /// C_t: displacement per force of the fully stuck contact under the normal force of the parameters \[m/N\].
    pub(crate) fn initial_compliance(&self) -> f64 {
        self.tangential
    }
}

impl Shape for HertzEllipse {
    /// Both directions in the plane of contact.
    fn plane(&self) -> Plane<'_> {
        let per_approach = [self.tangential_ratio(), self.lateral / self.normal];
        let largest = self.largest_size();
        Plane { shape: self, layer: &Layer::NONE, per_approach, per_load: [0.0; 2], flat: 0.0, largest }
    }

    fn half_width(&self, w: f64) -> f64 {
        w
    }

    fn value(&self, quantity: Quantity, w: f64) -> f64 {
        let ratio = w / self.semi_axis_x;
        match quantity {
            Quantity::Load => self.normal_force * (ratio * ratio * ratio),
            _ => 1.5 * self.punch_compliance(quantity) * self.normal_force * (ratio * ratio),
        }
    }

    fn compliance(&self, quantity: Quantity, w: f64) -> f64 {
        match quantity {
            Quantity::Load => 1.0,
            _ => self.punch_compliance(quantity) * (self.semi_axis_x / w.max(TINY)),
        }
    }

    fn potential(&self, w: f64) -> f64 {
        0.4 * self.load(w) * self.value(Quantity::Shift, w)
    }

    fn compliance_under_flat(&self, _: f64) -> f64 {
        0.0
    }

    fn pressure_weight(&self, _: f64) -> f64 {
        1.0
    }

    fn size_slope(&self, w: f64) -> f64 {
        2.0 / 3.0 * (w / self.load(w).max(TINY)) * w
    }

    fn size_at(&self, quantity: Quantity, value: f64) -> f64 {
        self.semi_axis_x
            * match quantity {
                Quantity::Load => (value / self.normal_force).cbrt(),
                _ => (value / (1.5 * self.punch_compliance(quantity) * self.normal_force)).sqrt(),
            }
    }

    /// Loads up to 2^498 N, approaches and shifts up to 2^498 m.
    fn largest_size(&self) -> f64 {
        let largest = f64::from_bits((1023 + 498) << 52);
        let compliance = 1.5 * self.normal.max(self.tangential);
        let by_load = (largest / self.normal_force).cbrt();
        self.semi_axis_x * by_load.min((largest / (compliance * self.normal_force)).sqrt())
    }

    /// Differences of `(3/2) N0/(π b² l) sqrt(s² - x²)`, which is the pressure of the size s.
    fn pressure_between(&self, from: f64, to: f64, x: f64) -> f64 {
        // The squares of distant points are not representable.
        let x = x.abs().min(from.max(to));
        let square = |s: f64| (s - x) * (s + x);
        let difference = difference_of_heights(square(to), square(from), (to - from) * (to + from));
        let area = self.semi_axis_x.max(TINY) * self.semi_axis_y.max(TINY);
        1.5 / PI * (self.normal_force / area) * (difference / self.semi_axis_x.max(TINY))
    }

    /// Binomial series: N scales as the powers 3/2 of U and of S.
    fn series(&self, w: f64, argument: Quantity) -> [Series; 3] {
        let binomial = |value: f64, exponent: f64| -> Series {
            let mut term = value;
            from_fn(|k| {
                let coefficient = term;
                term *= (exponent - k as f64) / (k + 1) as f64;
                coefficient
            })
        };
        let [load, approach, shift] = Quantity::ALL.map(|quantity| self.value(quantity, w));
        if argument == Quantity::Load {
            let power = binomial(1.0, 2.0 / 3.0);
            [identity(load), power.map(|term| approach * term), power.map(|term| shift * term)]
        } else {
            [binomial(load, 1.5), identity(approach), identity(shift)]
        }
    }
}

/// The difference of the roots of two numbers, 0 of a negative one, given the difference of these.
pub(crate) fn difference_of_heights(outer: f64, inner: f64, difference: f64) -> f64 {
    let root = outer.max(0.0).sqrt();
    if inner > 0.0 { difference / (root + inner.sqrt()).max(TINY) } else { root }
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
        square *= (next_half / half.max(TINY)) * (next_half / half.max(TINY));
        half = next_half;
        power *= 2.0;
        if square <= 1e-18 {
            break;
        }
    }
    let all = FRAC_PI_2 / (0.5 * (mean + geometric)) / large;
    let fraction = 0.5 * sum;
    // sin² belongs to the smaller axis: W² = large² (1 - k² sin²) for b < l, and with cos and sin exchanged for b > l.
    (all, if along <= across { all * (1.0 - fraction) } else { all * fraction })
}
