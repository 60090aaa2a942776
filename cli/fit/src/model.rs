//! The model of a loop: the law of a contact in series with a spring, by Masing's rule.
//!
//! With the monotonic curve T(d) of the contact under a friction coefficient of 1, the total displacement under a force is
//!
//! ```text
//! u = μ [f z + C h(T₁)],   T = μ T₁(z),   up to gross slip, T = μN
//! h = (N₀/s) ln[(1 - s + s N/N₀)/(1 - s + s (N - T₁)/N₀)],   h = T₁ for s = 0
//! ```
//!
//! f the factor on the displacements of the law, C the series compliance under the normal force N₀ of the contact, z the
//! displacement of the contact over μ: T/μ is a function of d/μ. The series stiffness is constant (s = 0), or a share s of it
//! grows in proportion to N: the law of the library's layer with N_c = N₀ (1/s - 1). A spring in parallel adds a force in proportion
//! to u. Derivatives at constant u follow from the differential of both equations, with k = dT₁/dz and h' = dh/dT₁:
//!
//! ```text
//! (f + C h' k) dT = [f (T₁ - k z) + C k (h' T₁ - h)] dμ - k μ (h dC + z df + C dh(T₁; s)) + f μ dT₁(z; shape)
//! dT/du = k/(f + C h' k)
//! ```

use crate::cycles::{Loop, Sample};
use crate::error::{Error, error};
use crate::input::{self, DisplacementReference, Geometry, ShapeParameter};
use microslip::parameters::{CENTRE_POINT, RIGID_STRIP};
use microslip::{Contact, EllipticParameters, Material, Parameters};

/// Places of the parameters in arrays.
pub(crate) const FRICTION: usize = 0;
pub(crate) const SERIES: usize = 1;
pub(crate) const CONTACT: usize = 2;
pub(crate) const SHAPE: usize = 3;
pub(crate) const STIFFENING: usize = 4;
pub(crate) const PARALLEL: usize = 5;
pub(crate) const PARAMETERS: usize = 6;
/// The largest share s: the library's least N_c, 1e-3 of N₀.
pub(crate) const MOST_STIFFENING: f64 = 0.999;

/// The contact as a family of shapes: with the ratio a/b under its normal force as parameter.
#[derive(Debug, Clone)]
pub(crate) struct Family {
    contact: input::Contact,
    parameter: ShapeParameter,
    /// E* of Eq. 2.
    modulus: f64,
}

impl Family {
    pub fn new(contact: &input::Contact, parameter: ShapeParameter) -> Result<Family, Error> {
        if parameter == ShapeParameter::EdgeRadius
            && !matches!(contact.geometry, Geometry::Flat { flat_half_width, .. } if flat_half_width > 0.0)
        {
            return error("the radius of the edges can be fitted only with a flat of a given half-width > 0");
        }
        let compliance = |body: &Material| (1.0 - body.poisson_ratio.powi(2)) / body.young_modulus;
        let modulus = 1.0 / contact.material.iter().map(compliance).sum::<f64>();
        let family = Family { contact: contact.clone(), parameter, modulus };
        family.at(&family.contact.geometry, contact.normal_force)?;
        Ok(family)
    }

    /// a/b of the given contact; `None` for an ellipse.
    pub fn shape(&self) -> Option<f64> {
        let Geometry::Flat { flat_half_width, .. } = self.contact.geometry else { return None };
        let contact = self.at(&self.contact.geometry, self.contact.normal_force).ok()?;
        Some(flat_half_width / contact.half_width)
    }

    /// The geometry with another a/b, and the derivatives of a and R with respect to it. In units of b, Eq. 1 is
    /// `4NR/(E*L b²) = 2ψ - 2 (a/b) w`, w = sqrt(1 - (a/b)²), ψ = acos(a/b); its derivative is -4w.
    fn shaped(&self, shape: f64) -> (Geometry, [f64; 2]) {
        let (mut geometry, mut slopes) = (self.contact.geometry, [0.0; 2]);
        if let Geometry::Flat { flat_half_width, edge_radius, length, .. } = &mut geometry {
            let w = ((1.0 - shape) * (1.0 + shape)).sqrt();
            let load = 2.0 * (shape.acos() - shape * w);
            let scale = 4.0 * self.contact.normal_force / (self.modulus * *length);
            match self.parameter {
                ShapeParameter::FlatHalfWidth => {
                    let half_width = (scale * *edge_radius / load).sqrt();
                    *flat_half_width = shape * half_width;
                    slopes[0] = half_width * (1.0 + 2.0 * shape * w / load);
                }
                ShapeParameter::EdgeRadius => {
                    *edge_radius = (*flat_half_width / shape).powi(2) * load / scale;
                    slopes[1] = -*edge_radius * (2.0 / shape + 4.0 * w / load);
                }
                ShapeParameter::Fixed => {}
            }
        }
        (geometry, slopes)
    }

    /// The geometry with another a/b.
    pub fn geometry(&self, shape: f64) -> Geometry {
        self.shaped(shape).0
    }

    /// Smallest and largest ratio a/b that are fitted: from a cylinder to a stamp with nearly sharp edges. The radius of a cylinder
    /// of given a > 0 is infinite.
    pub fn shape_range(&self) -> [f64; 2] {
        [if self.parameter == ShapeParameter::EdgeRadius { 0.02 } else { 0.0 }, 0.98]
    }

    /// The contact under a normal force, with a friction coefficient of 1.
    fn at(&self, geometry: &Geometry, normal_force: f64) -> Result<Contact, Error> {
        let material = self.contact.material;
        let contact = match *geometry {
            Geometry::Flat { flat_half_width, edge_radius, length, displacement_reference } => {
                Contact::rounded_flat(&Parameters {
                    flat_half_width,
                    edge_radius,
                    length,
                    normal_force,
                    friction_coefficient: 1.0,
                    material,
                    displacement_reference: match displacement_reference {
                        DisplacementReference::CentrePoint => CENTRE_POINT,
                        DisplacementReference::RigidStrip => RIGID_STRIP,
                    },
                    ..Parameters::default()
                })
            }
            Geometry::Ellipse { semi_axis_x, semi_axis_y } => {
                // Hertz: lengths scale as N^(1/3).
                let scale = (normal_force / self.contact.normal_force).cbrt();
                let (semi_axis_x, semi_axis_y) = (scale * semi_axis_x, scale * semi_axis_y);
                let friction_coefficient = 1.0;
                Contact::elliptic(&EllipticParameters {
                    semi_axis_x,
                    semi_axis_y,
                    normal_force,
                    friction_coefficient,
                    material,
                    ..EllipticParameters::default()
                })
            }
        };
        contact.map_err(|reason| Error(format!("the contact under a normal force of {normal_force:e}: {reason}")))
    }

    /// The curve under the normal force of the contact.
    pub fn reference_curve(&self, shape: Option<f64>) -> Result<Curve, Error> {
        self.curve(shape, self.contact.normal_force)
    }

    /// The curve under a normal force at a/b, or of the given geometry.
    pub fn curve(&self, shape: Option<f64>, normal_force: f64) -> Result<Curve, Error> {
        let (geometry, shape_slopes) = shape.map_or((self.contact.geometry, [0.0; 2]), |shape| self.shaped(shape));
        let relative_load = normal_force / self.contact.normal_force;
        Ok(Curve { contact: self.at(&geometry, normal_force)?, relative_load, shape_slopes })
    }
}

/// The monotonic curve of a contact of friction coefficient 1, its normal force over N₀, and the derivatives of a and R with
/// respect to the shape.
#[derive(Debug, Clone)]
pub(crate) struct Curve {
    contact: Contact,
    relative_load: f64,
    shape_slopes: [f64; 2],
}

/// The displacement h of what is in series, over C, and its derivatives with respect to T₁, s and N.
struct Series {
    displacement: f64,
    by_force: f64,
    by_share: f64,
    by_load: f64,
}

/// A point of the total curve: force, and its derivatives with respect to the displacement and the parameters.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Point {
    pub force: f64,
    pub stiffness: f64,
    pub slopes: [f64; PARAMETERS],
}

fn contact_force(contact: &Contact, displacement: f64) -> (f64, f64) {
    contact.curve_at_displacement(displacement).map_or((f64::NAN, f64::NAN), |at| at.force_and_stiffness())
}

impl Curve {
    /// dT/d(displacement) of the contact at no force.
    pub fn initial_stiffness(&self) -> f64 {
        self.contact.initial_stiffness
    }

    /// What is in series, at T₁ and a share s.
    fn series(&self, force: f64, share: f64) -> Series {
        // The stiffness over that under N₀: under N, and under N - T₁.
        let (load, reference) = (self.relative_load, self.contact.slip_force / self.relative_load);
        let relative_force = force / reference;
        let stiffness = 1.0 - share + share * load;
        let rest = (stiffness - share * relative_force).max(1.0 - share);
        // Without the cancellation of small shares.
        if share < 1e-7 {
            let by_share = force * (1.0 - load + 0.5 * relative_force);
            return Series { displacement: force + share * by_share, by_force: 1.0 / rest, by_share, by_load: 0.0 };
        }
        let displacement = -reference / share * (-share * relative_force / stiffness).ln_1p();
        let slopes = [(load - 1.0) / stiffness, (load - relative_force - 1.0) / rest];
        Series {
            displacement,
            by_force: 1.0 / rest,
            by_share: (reference * (slopes[0] - slopes[1]) - displacement) / share,
            by_load: 1.0 / stiffness - 1.0 / rest,
        }
    }

    /// Total displacement at the onset of gross slip.
    pub fn slip_displacement(&self, [friction, series, contact, _, share, _]: &[f64; PARAMETERS]) -> f64 {
        let of_series = self.series(self.contact.slip_force, *share).displacement;
        friction * (contact * self.contact.slip_displacement + series * of_series)
    }

    /// The point at a total displacement, odd in it.
    fn at(&self, displacement: f64, parameters: &[f64; PARAMETERS], with_shape: bool) -> Point {
        let [friction, series, contact, _, share, _] = *parameters;
        let (distance, sign) = (displacement.abs(), displacement.signum());
        if distance >= self.slip_displacement(parameters) {
            let force = self.contact.slip_force;
            return Point {
                force: sign * friction * force,
                stiffness: 0.0,
                slopes: [sign * force, 0.0, 0.0, 0.0, 0.0, 0.0],
            };
        }
        let (z, (force, stiffness)) = self.solve(distance / friction, parameters);
        let Series { displacement, by_force, by_share, .. } = self.series(force, share);
        let compliance = (contact + series * by_force * stiffness).max(f64::MIN_POSITIVE);
        let slopes = [
            contact * (force - stiffness * z) + series * stiffness * (by_force * force - displacement),
            -stiffness * friction * displacement,
            -stiffness * friction * z,
            if with_shape { contact * friction * self.shape_slope(z) } else { 0.0 },
            -stiffness * friction * series * by_share,
            0.0,
        ];
        Point {
            force: sign * friction * force,
            stiffness: stiffness / compliance,
            slopes: slopes.map(|slope| sign * slope / compliance),
        }
    }

    /// Solves `f z + C h(T₁(z)) = u` by Newton's method, from 0; the left side grows, and is concave for s = 0.
    fn solve(&self, displacement: f64, [_, series, contact, _, share, _]: &[f64; PARAMETERS]) -> (f64, (f64, f64)) {
        let (mut z, mut response) = (0.0, (0.0, self.contact.initial_stiffness));
        let [mut low, mut high] = [0.0, self.contact.slip_displacement];
        for _ in 0..60 {
            let of_series = self.series(response.0, *share);
            // Without a contact compliance the slope may vanish at gross slip.
            let slope = (contact + series * of_series.by_force * response.1).max(f64::MIN_POSITIVE);
            let rest = displacement - contact * z - series * of_series.displacement;
            *(if rest > 0.0 { &mut low } else { &mut high }) = z;
            let step = rest / slope;
            let is_inside = (low..=high).contains(&(z + step));
            z = if is_inside { z + step } else { 0.5 * (low + high) };
            response = contact_force(&self.contact, z);
            // The error that is left is of the order of the square.
            if is_inside && step.abs() <= 1e-8 * z {
                break;
            }
        }
        (z, response)
    }

    /// dT/dN at a total displacement >= 0.
    fn load_slope(&self, displacement: f64, parameters: &[f64; PARAMETERS]) -> f64 {
        let [friction, series, contact, _, share, _] = *parameters;
        if displacement >= self.slip_displacement(parameters) {
            return friction;
        }
        let (z, (force, stiffness)) = self.solve(displacement / friction, parameters);
        let [by_load, ..] = self.contact.monotonic_sensitivity(z).unwrap_or([f64::NAN; microslip::PARAMETERS]);
        let of_series = self.series(force, share);
        let compliance = (contact + series * of_series.by_force * stiffness).max(f64::MIN_POSITIVE);
        friction * (contact * by_load - series * stiffness * of_series.by_load) / compliance
    }

    /// dT₁/d(a/b) at constant z.
    fn shape_slope(&self, z: f64) -> f64 {
        let [of_flat, of_radius] = self.shape_slopes;
        let [_, _, by_flat, by_radius, ..] =
            self.contact.monotonic_sensitivity(z).unwrap_or([f64::NAN; microslip::PARAMETERS]);
        by_flat * of_flat + by_radius * of_radius
    }
}

/// Parameters of one loop: offset and drift of the force, corrections of the lower and the upper reversal, outwards.
pub(crate) const NUISANCES: usize = 4;

/// The force at a sample and its derivatives.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Prediction {
    pub force: f64,
    pub slopes: [f64; PARAMETERS],
    pub nuisance_slopes: [f64; NUISANCES],
    /// dF/d(displacement).
    pub stiffness: f64,
}

/// The loop with given parameters.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LoopModel<'a> {
    curve: &'a Curve,
    parameters: &'a [f64; PARAMETERS],
    nuisances: &'a [f64; NUISANCES],
    with_shape: bool,
    amplitude: f64,
    /// The law at the end of the loop.
    pub end: Point,
}

impl<'a> LoopModel<'a> {
    /// With or without the derivatives with respect to the shape.
    pub fn new(
        one: &Loop,
        curve: &'a Curve,
        parameters: &'a [f64; PARAMETERS],
        nuisances: &'a [f64; NUISANCES],
        with_shape: bool,
    ) -> LoopModel<'a> {
        let amplitude = one.amplitude + 0.5 * (nuisances[2] + nuisances[3]);
        let end = curve.at(amplitude, parameters, with_shape);
        LoopModel { curve, parameters, nuisances, with_shape, amplitude, end }
    }

    /// The correction of the reversal from which a branch starts, and its place among the nuisances.
    fn start(&self, sample: &Sample) -> (f64, usize) {
        let place = if sample.direction > 0.0 { 2 } else { 3 };
        (self.nuisances[place], place)
    }

    /// Masing's rule from the reversal of the branch.
    pub fn at(&self, sample: &Sample) -> Prediction {
        let (sign, [offset, drift, ..], (start, place)) = (sample.direction, *self.nuisances, self.start(sample));
        let point = self.curve.at(0.5 * (sample.distance + start), self.parameters, self.with_shape);
        let (of_end, spring) = (-0.5 * sign * self.end.stiffness, self.parameters[PARALLEL]);
        let mut nuisance_slopes = [1.0, sample.time, of_end, of_end];
        nuisance_slopes[place] += sign * point.stiffness;
        let mut slopes = std::array::from_fn(|i| sign * (2.0 * point.slopes[i] - self.end.slopes[i]));
        slopes[PARALLEL] = sample.displacement;
        let of_law = sign * (2.0 * point.force - self.end.force);
        Prediction {
            force: offset + drift * sample.time + of_law + spring * sample.displacement,
            slopes,
            nuisance_slopes,
            stiffness: point.stiffness + spring,
        }
    }

    /// Effect of the swing of the normal force, to first order.
    ///
    /// Between the stick zone and the present edge of the contact the shear has the sign of the present branch, further inside that
    /// of the one before, whose slip zone started at the edge under the load of the reversal. With G(d) the derivative dT/dN of the
    /// monotonic curve, and dN from the mean, the force changes by `G(half) dN - (G(end) - G(half)) dN(reversal)`; in gross slip by
    /// μ dN.
    pub fn load_effect(&self, sample: &Sample) -> f64 {
        let [here, end] = [0.5 * (sample.distance + self.start(sample).0), self.amplitude]
            .map(|displacement| self.curve.load_slope(displacement, self.parameters));
        let [now, then] = [sample.load_excess, sample.load_excess_at_reversal];
        sample.direction * (here * now - (end - here) * then)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contact(flat_half_width: f64) -> input::Contact {
        let material = Material { young_modulus: 2e11, poisson_ratio: 0.3 };
        let geometry = Geometry::Flat {
            flat_half_width,
            edge_radius: 5e-2,
            length: 2e-2,
            displacement_reference: DisplacementReference::CentrePoint,
        };
        input::Contact { geometry, normal_force: 800.0, friction_coefficient: 0.5, material: [material; 2] }
    }

    /// Central differences of relative step 1e-5 have an error of about 1e-10 of third derivatives, which grow towards gross slip.
    #[test]
    fn derivatives_are_those_of_the_force() {
        for (parameter, share) in [(ShapeParameter::FlatHalfWidth, 0.9), (ShapeParameter::EdgeRadius, 0.3)] {
            let family = Family::new(&contact(1e-4), parameter).unwrap();
            let stiffness = family.reference_curve(None).unwrap().initial_stiffness();
            let parameters = [0.5, 0.3 / stiffness, 1.2, 0.4, share, 0.0];
            // Another load than that of the ratio a/b.
            let curve = |parameters: &[f64; PARAMETERS]| family.curve(Some(parameters[SHAPE]), 500.0).unwrap();
            let end = curve(&parameters).slip_displacement(&parameters);
            for part in [1e-3, 0.3, 0.7, 0.95, -0.5, 1.5] {
                let at = curve(&parameters).at(part * end, &parameters, true);
                let differences = |i: usize| {
                    let step = 1e-5 * parameters[i];
                    let [low, high] = [-step, step].map(|step| {
                        let mut changed = parameters;
                        changed[i] += step;
                        curve(&changed).at(part * end, &changed, false).force
                    });
                    (high - low) / (2.0 * step)
                };
                for (i, slope) in at.slopes.into_iter().enumerate().take(PARALLEL) {
                    let scale = at.force.abs() / parameters[i];
                    assert!((slope - differences(i)).abs() < 1e-6 * scale, "{parameter:?} {part} {i}");
                }
                let step = 1e-6 * end;
                let [low, high] =
                    [-step, step].map(|step| curve(&parameters).at(part * end + step, &parameters, false).force);
                assert!((at.stiffness - (high - low) / (2.0 * step)).abs() < 1e-6 * stiffness, "{part}");
            }
        }
    }

    #[test]
    fn a_geometry_has_its_shape() {
        let family = Family::new(&contact(0.0), ShapeParameter::FlatHalfWidth).unwrap();
        let Geometry::Flat { flat_half_width, .. } = family.geometry(0.5) else { panic!() };
        let with_flat = family.at(&family.geometry(0.5), 800.0).unwrap();
        assert!((flat_half_width / with_flat.half_width - 0.5).abs() < 1e-13);
    }
}
