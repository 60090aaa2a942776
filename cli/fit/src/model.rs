//! The model of a loop: the law of a contact in series with a spring, by Masing's rule.
//!
//! With the monotonic curve δ(T) of the given contact, the total displacement under a force is
//!
//! ```text
//! u = f δ(T) + C h(T)
//! ```
//!
//! f the factor on the displacements of the law, C the series compliance under the normal force N₀ of the contact. The series
//! stiffness is constant, h = T, or a share s of it grows in proportion to N. That is the library's contact of moduli E/f and
//! radius R/f with a layer of N_c = N₀ (1/s - 1), and its derivatives. A spring in parallel adds a force in proportion to u.

use crate::cycles::{Loop, Sample};
use crate::error::{Error, error};
use crate::input::{self, Geometry, ShapeParameter};
use crate::report::stiffening_load;
use microslip::{Contact, Layer, Material};

/// Places of the parameters in arrays.
pub(crate) const FRICTION: usize = 0;
pub(crate) const SERIES: usize = 1;
pub(crate) const CONTACT: usize = 2;
pub(crate) const SHAPE: usize = 3;
pub(crate) const STIFFENING: usize = 4;
pub(crate) const PARALLEL: usize = 5;
pub(crate) const PARAMETERS: usize = 6;
/// The law itself, with a friction coefficient of 1.
const LAW: [f64; PARAMETERS] = [1.0, 0.0, 1.0, 0.0, 0.0, 0.0];
/// The largest share s: the library admits N_c from 1e-3 of each normal force.
pub(crate) const MOST_STIFFENING: f64 = 0.99;
/// Step of the share s in its derivative, which the library does not have.
const STEP: f64 = 1e-5;
/// The least compliance of the contact over that of its layer, beside which it is rigid.
const RIGID: f64 = 1e-9;

/// The contact as a family: the ratio a/b is that under its normal force.
#[derive(Debug, Clone)]
pub(crate) struct Family {
    contact: input::Contact,
    parameter: ShapeParameter,
    /// E* of Eq. 2, and initial compliance.
    modulus: f64,
    compliance: f64,
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
        let mut family = Family { contact: contact.clone(), parameter, modulus, compliance: 1.0 };
        family.compliance = 1.0 / family.given()?.initial_stiffness;
        Ok(family)
    }

    /// The given contact, with a friction coefficient of 1.
    fn given(&self) -> Result<Contact, Error> {
        self.at(&self.contact.geometry, self.contact.normal_force, &LAW)
    }

    /// a/b of the given contact; `None` for an ellipse.
    pub fn shape(&self) -> Result<Option<f64>, Error> {
        let Geometry::Flat { flat_half_width, .. } = self.contact.geometry else { return Ok(None) };
        Ok(Some(flat_half_width / self.given()?.half_width))
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

    /// The factor on the displacements of the law.
    fn factor(&self, parameters: &[f64; PARAMETERS]) -> f64 {
        parameters[CONTACT].max(RIGID * (1.0 + parameters[SERIES] / self.compliance))
    }

    /// The contact and what is in series with it, under a normal force.
    fn at(&self, geometry: &Geometry, normal_force: f64, parameters: &[f64; PARAMETERS]) -> Result<Contact, Error> {
        let [friction_coefficient, tangential_compliance, _, _, share, _] = *parameters;
        let (factor, mut geometry, reference_load) = (self.factor(parameters), *geometry, self.contact.normal_force);
        match &mut geometry {
            Geometry::Flat { edge_radius, .. } => *edge_radius /= factor,
            Geometry::Ellipse { semi_axis_x, semi_axis_y } => {
                // Hertz: lengths scale as N^(1/3).
                let scale = (normal_force / reference_load).cbrt();
                (*semi_axis_x, *semi_axis_y) = (scale * *semi_axis_x, scale * *semi_axis_y);
            }
        }
        let material =
            self.contact.material.map(|body| Material { young_modulus: body.young_modulus / factor, ..body });
        let stiffening_load = if share > 0.0 { stiffening_load(share, reference_load) } else { 0.0 };
        let layer = Layer { tangential_compliance, stiffening_load, reference_load, ..Layer::none() };
        let contact = input::Contact { geometry, normal_force, friction_coefficient, material };
        let contact = contact.parameters(layer).contact();
        contact.map_err(|reason| Error(format!("the contact under a normal force of {normal_force:e}: {reason}")))
    }

    /// Initial compliance of the contact alone under a normal force.
    pub fn compliance(&self, shape: f64, normal_force: f64) -> Result<f64, Error> {
        let contact = self.at(&self.geometry(shape), normal_force, &LAW)?;
        Ok(1.0 / contact.initial_stiffness)
    }

    /// Initial compliance of the contact alone under its normal force.
    pub fn reference_compliance(&self, shape: f64) -> Result<f64, Error> {
        self.compliance(shape, self.contact.normal_force)
    }

    /// The monotonic curve under a normal force, with its derivative by the share s or without.
    pub fn curve(&self, parameters: &[f64; PARAMETERS], normal_force: f64, has_share: bool) -> Result<Curve, Error> {
        let (geometry, shape_slopes) = self.shaped(parameters[SHAPE]);
        let stiffer = has_share.then(|| {
            let mut stiffer = *parameters;
            stiffer[STIFFENING] += if stiffer[STIFFENING] > 0.5 { -STEP } else { STEP };
            Ok((self.at(&geometry, normal_force, &stiffer)?, stiffer[STIFFENING] - parameters[STIFFENING]))
        });
        let factor = self.factor(parameters);
        let edge_radius = if let Geometry::Flat { edge_radius, .. } = geometry { edge_radius } else { 0.0 };
        Ok(Curve {
            contact: self.at(&geometry, normal_force, parameters)?,
            stiffer: stiffer.transpose()?,
            by_factor: [-edge_radius, -self.modulus].map(|scale| scale / (factor * factor)),
            by_shape: [shape_slopes[0], shape_slopes[1] / factor],
        })
    }
}

/// The monotonic curve of contact and series compliance.
#[derive(Debug, Clone)]
pub(crate) struct Curve {
    contact: Contact,
    /// The contact with another share s, and the difference of both.
    stiffer: Option<(Contact, f64)>,
    /// Derivatives of R and E* with respect to the factor, of a and R with respect to a/b.
    by_factor: [f64; 2],
    by_shape: [f64; 2],
}

/// A point of the total curve: force, and its derivatives with respect to the displacement, the parameters and the normal force.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Point {
    pub force: f64,
    pub stiffness: f64,
    pub slopes: [f64; PARAMETERS],
    by_load: f64,
}

fn contact_force(contact: &Contact, displacement: f64) -> (f64, f64) {
    contact.curve_at_displacement(displacement).map_or((f64::NAN, f64::NAN), |at| at.force_and_stiffness())
}

impl Curve {
    /// Total displacement at the onset of gross slip.
    pub fn slip_displacement(&self) -> f64 {
        self.contact.slip_displacement
    }

    /// The point at a total displacement.
    fn at(&self, displacement: f64) -> Point {
        let (force, stiffness) = contact_force(&self.contact, displacement);
        let slopes = self.contact.monotonic_sensitivity(displacement).unwrap_or([f64::NAN; microslip::PARAMETERS]);
        let [by_load, by_friction, by_flat, by_radius, _, by_modulus, by_series] = slopes;
        let by_share = |(stiffer, step): &(Contact, f64)| (contact_force(stiffer, displacement).0 - force) / step;
        let slopes = [
            by_friction,
            by_series,
            by_radius * self.by_factor[0] + by_modulus * self.by_factor[1],
            by_flat * self.by_shape[0] + by_radius * self.by_shape[1],
            self.stiffer.as_ref().map_or(0.0, by_share),
            0.0,
        ];
        Point { force, stiffness, slopes, by_load }
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
    spring: f64,
    nuisances: &'a [f64; NUISANCES],
    /// The law at the end of the loop.
    pub end: Point,
}

impl<'a> LoopModel<'a> {
    pub fn new(one: &Loop, curve: &'a Curve, spring: f64, nuisances: &'a [f64; NUISANCES]) -> LoopModel<'a> {
        let end = curve.at(one.amplitude + 0.5 * (nuisances[2] + nuisances[3]));
        LoopModel { curve, spring, nuisances, end }
    }

    /// The correction of the reversal from which a branch starts, and its place among the nuisances.
    fn start(&self, sample: &Sample) -> (f64, usize) {
        let place = if sample.direction > 0.0 { 2 } else { 3 };
        (self.nuisances[place], place)
    }

    /// Masing's rule from the reversal of the branch.
    pub fn at(&self, sample: &Sample) -> Prediction {
        let (sign, [offset, drift, ..], (start, place)) = (sample.direction, *self.nuisances, self.start(sample));
        let point = self.curve.at(0.5 * (sample.distance + start));
        let (of_end, spring) = (-0.5 * sign * self.end.stiffness, self.spring);
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
        let (here, end) = (self.curve.at(0.5 * (sample.distance + self.start(sample).0)).by_load, self.end.by_load);
        let [now, then] = [sample.load_excess, sample.load_excess_at_reversal];
        sample.direction * (here * now - (end - here) * then)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::DisplacementReference;

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

    /// Central differences of relative step 1e-5 have an error of about 1e-10 of third derivatives, which grow towards gross slip,
    /// the derivative by the share an error of its step.
    #[test]
    fn derivatives_are_those_of_the_force() {
        for (parameter, share) in [(ShapeParameter::FlatHalfWidth, 0.9), (ShapeParameter::EdgeRadius, 0.3)] {
            let family = Family::new(&contact(1e-4), parameter).unwrap();
            let parameters = [0.5, 0.3 * family.compliance(0.4, 800.0).unwrap(), 1.2, 0.4, share, 0.0];
            // Another load than that of the ratio a/b.
            let curve = |parameters: &[f64; PARAMETERS]| family.curve(parameters, 500.0, true).unwrap();
            let end = curve(&parameters).slip_displacement();
            for part in [1e-3, 0.3, 0.7, 0.95, -0.5, 1.5] {
                let at = curve(&parameters).at(part * end);
                for (i, slope) in at.slopes.into_iter().enumerate().take(PARALLEL) {
                    let step = 1e-5 * parameters[i];
                    let [low, high] = [-step, step].map(|step| {
                        let mut changed = parameters;
                        changed[i] += step;
                        curve(&changed).at(part * end).force
                    });
                    let (difference, scale) = ((high - low) / (2.0 * step), at.force.abs() / parameters[i]);
                    let error = if i == STIFFENING { 1e-4 } else { 1e-6 };
                    assert!(
                        (slope - difference).abs() < error * scale,
                        "{parameter:?} {part} {i}: {slope} {difference}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_geometry_has_its_shape() {
        let family = Family::new(&contact(0.0), ShapeParameter::FlatHalfWidth).unwrap();
        let Geometry::Flat { flat_half_width, .. } = family.geometry(0.5) else { panic!() };
        let with_flat = family.at(&family.geometry(0.5), 800.0, &[1.0, 0.0, 1.0, 0.5, 0.0, 0.0]).unwrap();
        assert!((flat_half_width / with_flat.half_width - 0.5).abs() < 1e-13);
    }
}
