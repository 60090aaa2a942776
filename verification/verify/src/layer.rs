//! Contacts with a layer in series: the monotonic curve, its inverse and the energy per cycle, at a constant normal force.

use crate::call;
use crate::curve::{moved, share_of_slip};
use crate::sampler::{Case, Sampler, text};
use crate::tally::Tally;
use microslip::ffi::mslip_contact;
use microslip::{EllipticParameters, Layer, Parameters};
use reference::{Input, Law, Point, Real, Reference};

/// A contact with a layer, and the same in multi-precision.
pub struct Layered<'a> {
    /// Without the layer.
    case: &'a Case,
    pub contact: mslip_contact,
    pub reference: Reference,
}

fn with_layer(input: &Input, layer: Layer) -> Input {
    match *input {
        Input::Flat(p) => Input::Flat(Parameters { layer, ..p }),
        Input::Ellipse(p) => Input::Ellipse(EllipticParameters { layer, ..p }),
    }
}

/// The input with a random layer, for a contact of the given stiffness.
pub fn random_input(input: &Input, stiffness: f64, sampler: &mut Sampler) -> Input {
    let (Input::Flat(Parameters { normal_force, .. }) | Input::Ellipse(EllipticParameters { normal_force, .. })) =
        input;
    let tangential_compliance = sampler.power(-3.0, 3.0) / stiffness;
    let stiffening_load = if sampler.chance(0.3) { f64::INFINITY } else { normal_force * sampler.power(-3.0, 2.0) };
    with_layer(input, Layer { normal_compliance: 0.0, tangential_compliance, stiffening_load, reference_load: 0.0 })
}

/// A contact with a random layer that the library accepts.
pub fn random<'a>(case: &'a Case, sampler: &mut Sampler) -> Layered<'a> {
    loop {
        let input = random_input(&case.reference.input, case.contact.initial_stiffness, sampler);
        if let Some(layered) = Layered::new(case, input) {
            return layered;
        }
    }
}

fn compliance(law: &Law, point: &Point) -> Real {
    &point.compliance / &law.stiffness_unit
}

fn stiffness(law: &Law, point: &Point) -> Real {
    &law.stiffness_unit * point.stiffness()
}

impl<'a> Layered<'a> {
    /// With the layer of an input, if the library accepts it.
    fn new(case: &'a Case, input: Input) -> Option<Layered<'a>> {
        Some(Layered { case, contact: call::prepare(&input)?, reference: Reference::new(input) })
    }

    /// Compliance of the layer at a point, which has the normal force that the stick zone carries.
    fn compliance(&self, law: &Law, point: &Point) -> Real {
        let (Input::Flat(Parameters { layer, normal_force, .. })
        | Input::Ellipse(EllipticParameters { layer, normal_force, .. })) = &self.reference.input;
        let ratio = law.real(*normal_force) / layer.stiffening_load;
        &law.stiffness_unit * layer.tangential_compliance * (1.0 + &ratio) / (1.0 + ratio * &point.one_minus_tau)
    }

    fn at_force(&self, force: f64, range: &'static str, tally: &mut Tally) {
        let mut at = tally.at(self.case.kind, range, || format!("{} T {force:e}", text(&self.reference.input)));
        let (law, point) = self.reference.at_force(force);
        let (_, alone) = self.case.reference.at_force(force);
        let [displacement, slope, _] = call::displacement(&self.contact, force);
        // The rounding of T over mu N enters with the layer's compliance.
        let of_layer = &point.tau * self.compliance(&law, &point);
        let condition = ((&point.tau + &of_layer) / &point.x).f64();
        at.check("layer_displacement", displacement, &(&law.displacement_unit * &point.x), condition);
        let exact = compliance(&law, &point);
        let condition = (1.0 + point.rate()) / point.compliance.f64();
        at.check_between("layer_compliance", slope, &exact, &exact, condition, || {
            let around = [-4.0, 4.0].map(|units| self.reference.at_force(moved(force, units)));
            around.map(|(law, point)| compliance(&law, &point)).into()
        });
        let change = 4.0 * (of_layer - (&point.x - &alone.x)) * &point.tau;
        let energy = call::energy(&self.contact, force);
        let condition = (change / &point.energy).f64();
        at.check("layer_dissipated_energy", energy, &(law.energy_unit() * &point.energy), condition);
    }

    fn at_displacement(&self, displacement: f64, range: &'static str, tally: &mut Tally) {
        let mut at = tally.at(self.case.kind, range, || format!("{} u {displacement:e}", text(&self.reference.input)));
        let [force, slope, _] = call::force(&self.contact, displacement);
        let (law, point) = self.reference.at_displacement(displacement);
        let soft = 1.0 / point.compliance.f64();
        at.check("layer_force", force, &(&law.slip_force * &point.tau), soft);
        // Changes of the compliance by the rounding of the displacement and of the force.
        let moves = &point.x * point.stiffness() + &point.tau;
        let rate = if point.slips() { 0.0 } else { (moves * &point.curvature).f64() * soft };
        let exact = stiffness(&law, &point);
        at.check_between("layer_stiffness", slope, &exact, &exact, soft + rate * (1.0 + soft), || {
            let units = 4.0 * (2.0 + 1.0 / law.x_slip.f64());
            let around = [-units, units].map(|units| self.reference.at_displacement(moved(displacement, units)));
            around.map(|(law, point)| stiffness(&law, &point)).into()
        });
    }
}

/// Curve, inverse and energy of a contact with a layer.
pub fn curve(case: &Case, sampler: &mut Sampler, tally: &mut Tally) {
    let layered = random(case, sampler);
    let half = call::displacement(&layered.contact, 0.5 * layered.contact.slip_force)[0];
    for _ in 0..10 {
        let (share, range) = sampler.share_of_force();
        layered.at_force(share * layered.contact.slip_force, range, tally);
        let (share, range) = share_of_slip(sampler, half / layered.contact.slip_displacement);
        layered.at_displacement(share * layered.contact.slip_displacement, range, tally);
    }
}

/// The same at one force "T" or displacement "u".
pub fn at(case: &Case, layer: Layer, given: (&str, f64), range: &'static str, tally: &mut Tally) {
    let layered =
        Layered::new(case, with_layer(&case.reference.input, layer)).expect("a layer that the library accepts");
    match given {
        ("T", force) => layered.at_force(force, range, tally),
        (_, displacement) => layered.at_displacement(displacement, range, tally),
    }
}
