//! Warnings of valid but implausible parameters: another unit, an exchanged pair, or a contact for which the model is inaccurate.

use crate::numerics::fp_class::{in_0_to, le};
use crate::parameters::{CENTRE_POINT, EllipticParameters, Material, Pair, Parameters};
use crate::shape::{Geometry, size_under_load};
use core::ffi::CStr;
use core::ops::RangeInclusive;

/// The plausible range in SI units, and the warning.
type Plausible = (RangeInclusive<f64>, &'static CStr);

const FLAT: Plausible = (0.0..=0.1, c"flat_half_width is implausible: a flank is at most 0.2 m wide; check the units");
const RADIUS: Plausible = (1e-5..=1.0, c"edge_radius is implausible: roundings have 10 um to 1 m; check the units");
const LENGTH: Plausible =
    (1e-4..=1.0, c"length is implausible: flanks and dampers are 0.1 mm to 1 m long; check the units");
const SEMI_AXIS_X: Plausible =
    (1e-6..=0.1, c"semi_axis_x is implausible: contacts have 1 um to 0.1 m; check the units");
const SEMI_AXIS_Y: Plausible =
    (1e-6..=0.1, c"semi_axis_y is implausible: contacts have 1 um to 0.1 m; check the units");
const MODULUS: Plausible =
    (1e7..=1.3e12, c"young_modulus is implausible: plastics have 10 MPa, diamond 1.2 TPa; check the units");
const FRICTION: Plausible =
    (0.0..=2.0, c"friction_coefficient is implausible: metals and ceramics in air have 0.1 to 1.5");
const EXCHANGED: &CStr =
    c"edge_radius is below flat_half_width: exchanged? If not, do the bodies reach far beyond the contact, as half-planes?";
const WIDE_EDGES: &CStr =
    c"normal_force is implausible: b - a > R/4, where edges are no parabolas and bodies no half-planes; check the units";
const SHORT: &CStr =
    c"length is below two widths of the contact, L/2b < 2: compare the initial stiffness with a 3-D analysis";
const SMALL_RADIUS: &CStr =
    c"normal_force is implausible: the semi-axes exceed a quarter of the radii, where bodies are no half-spaces; check the units";

/// Largest plausible ratio of b - a to the edge radius. At this ratio an arc of a circle is 1.6 % higher and 3.3 % steeper than its
/// parabola, and the error of a half-plane is of the order of the square of the slope.
const EDGE: f64 = 0.25;

/// The warning if a valid number is outside the range. Invalid numbers have errors.
fn check(value: f64, unit: f64, (range, text): &Plausible) -> Option<&'static CStr> {
    let plausible = (unit * range.start()).to_bits()..=(unit * range.end()).to_bits();
    let is_outside = in_0_to(value, f64::MAX) && !plausible.contains(&value.abs().to_bits());
    is_outside.then_some(text)
}

/// Warnings that apply: first for single values, then for relations between them. `metre` is the number of units of length in a
/// metre, 1 (SI) or 1000 (mm, N, MPa); if None, it follows from Young's moduli. An implausible dimension or modulus suppresses the
/// warnings for relations.
fn warnings<P, const K: usize, const M: usize>(
    parameters: &P,
    dimensions: [(f64, &Plausible); K],
    material: &[Material; 2],
    friction_coefficient: f64,
    related: fn(&P) -> [Option<&'static CStr>; M],
    metre: Option<f64>,
) -> impl Iterator<Item = &'static CStr> + use<P, K, M> {
    let is_mm = || material.iter().all(|body| in_0_to(body.young_modulus, 1.3e6));
    let metre = metre.unwrap_or_else(|| if is_mm() { 1e3 } else { 1.0 });
    let single = dimensions.map(|(value, rule)| check(value, metre, rule));
    let modulus = material.iter().find_map(|body| check(body.young_modulus, 1.0 / (metre * metre), &MODULUS));
    let is_plausible = single == [None; K] && modulus.is_none();
    let related = if is_plausible { related(parameters) } else { [None; M] };
    single.into_iter().chain([modulus, check(friction_coefficient, 1.0, &FRICTION)]).chain(related).flatten()
}

impl Parameters {
    /// Warnings that apply; `metre` is 1 for m and Pa, 1000 for mm and MPa, or found from Young's moduli.
    pub fn warnings(&self, metre: Option<f64>) -> impl Iterator<Item = &'static CStr> + use<> {
        let dimensions = [(self.flat_half_width, &FLAT), (self.edge_radius, &RADIUS), (self.length, &LENGTH)];
        warnings(self, dimensions, &self.material, self.friction_coefficient, Parameters::related, metre)
    }

    /// Warnings for relations between sizes; none if the size of the contact is undefined.
    fn related(&self) -> [Option<&'static CStr>; 3] {
        let size = || {
            Parameters { displacement_reference: CENTRE_POINT, ..*self }.checked().ok()?;
            let (b, punch) = size_under_load(self, Pair::new(&self.material).composite_modulus).ok()?;
            // b - a from w² = b² - a², free of cancellation.
            Some((b, b * (punch.leg * punch.leg / (1.0 + punch.flat))))
        };
        let Some((b, edge)) = size() else { return [None; 3] };
        [
            (!le(self.flat_half_width, self.edge_radius)).then_some(EXCHANGED),
            (!le(edge, EDGE * self.edge_radius)).then_some(WIDE_EDGES),
            (!le(4.0 * b, self.length)).then_some(SHORT),
        ]
    }
}

impl EllipticParameters {
    /// Warnings that apply; `metre` as for [`Parameters::warnings`].
    pub fn warnings(&self, metre: Option<f64>) -> impl Iterator<Item = &'static CStr> + use<> {
        let dimensions = [(self.semi_axis_x, &SEMI_AXIS_X), (self.semi_axis_y, &SEMI_AXIS_Y)];
        warnings(self, dimensions, &self.material, self.friction_coefficient, EllipticParameters::related, metre)
    }

    fn related(&self) -> [Option<&'static CStr>; 1] {
        // A sphere of semi-axis s and radius R has N = 4/3 E* s³/R.
        let force =
            || EDGE * (4.0 / 3.0) * Pair::new(&self.material).composite_modulus * self.semi_axis_x * self.semi_axis_y;
        [(self.checked().is_ok() && !le(self.normal_force, force())).then_some(SMALL_RADIUS)]
    }
}
