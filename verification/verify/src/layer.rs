//! Contacts with a layer in series: the monotonic curve, its inverse and the energy per cycle, at a constant normal force.

use crate::call;
use crate::curve::{moved, share_of_slip};
use crate::sampler::{Case, Sampler, text};
use crate::tally::Tally;
use microslip::ffi::mslip_contact;
use microslip::{EllipticParameters, Layer, Parameters};
use reference::law::bits_for;
use reference::{Input, Law, Point, Real};
use std::rc::Rc;

/// Bits beyond those of the contact: a stick zone that carries 2⁻¹⁰⁰ of the load, and N/N_c up to 2¹⁰.
const EXTRA: i32 = 400;

/// A contact with a layer; the reference is that of the contact alone.
pub struct Layered<'a> {
    case: &'a Case,
    pub contact: mslip_contact,
    pub input: Input,
    law: Rc<Law>,
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

/// A point of the curve \[N, m, J\]; of the layer alone what its name says.
struct Both {
    point: Point,
    force: Real,
    displacement: Real,
    remaining: Real,
    compliance: Real,
    energy: Real,
    layer_compliance: Real,
    layer_curvature: Real,
    layer_displacement: Real,
}

impl<'a> Layered<'a> {
    /// With the layer of an input, if the library accepts it.
    fn new(case: &'a Case, input: Input) -> Option<Layered<'a>> {
        Some(Layered { case, contact: call::prepare(&input)?, input, law: case.reference.law(EXTRA) })
    }

    /// Takes the bits for a force or a displacement at this share of gross slip.
    fn set_bits_for(&mut self, share: f64) {
        self.law = self.case.reference.law(EXTRA + bits_for(&self.law.real(share)));
    }

    /// The point with the share τ of mu N.
    fn at(&self, point: Point) -> Both {
        let (Input::Flat(Parameters { layer, normal_force, .. })
        | Input::Ellipse(EllipticParameters { layer, normal_force, .. })) = &self.input;
        let law = &self.law;
        let [load, compliance, stiffening] =
            [*normal_force, layer.tangential_compliance, layer.stiffening_load].map(|value| law.real(value));
        let force = &law.slip_force * &point.tau;
        let zero = law.real(0.0);
        // Displacement, remaining one, compliance, its derivative by the force, energy.
        let [displacement, remaining, slope, curvature, energy] = if layer.stiffening_load.is_infinite() {
            let left = &law.slip_force - &force;
            [&compliance * &force, &compliance * left, compliance, zero.clone(), zero]
        } else {
            let both = &load + &stiffening;
            let scale = &law.friction * &compliance * &both;
            let y = &load * &point.tau / &both;
            let logarithm = (1.0 - &y).ln();
            let left = (1.0 + load * &point.one_minus_tau / stiffening).ln();
            let slope = compliance / (1.0 - &y);
            let curvature = &slope / ((1.0 - &y) * &both * &law.friction);
            let energy = 4.0 * &law.friction * &scale * &both * loss(&y, &logarithm);
            [-(&scale * logarithm), scale * left, slope, curvature, energy]
        };
        Both {
            displacement: &law.displacement_unit * &point.x + &displacement,
            remaining: &law.displacement_unit * &point.x_remaining + remaining,
            compliance: &point.compliance / &law.stiffness_unit + &slope,
            energy: law.energy_unit() * &point.energy + energy,
            layer_compliance: slope,
            layer_curvature: curvature,
            layer_displacement: displacement,
            force,
            point,
        }
    }

    /// Newton's method in the logarithms, for the share of mu N or what is left of it.
    fn at_displacement(&self, displacement: f64) -> Both {
        let slip = self.at(self.law.slip_point());
        let (target, half) = (self.law.real(displacement), slip.displacement.f64() / 2.0);
        let left = &slip.displacement - &target;
        if !left.is_positive() {
            return slip;
        }
        let guess = call::force(&self.contact, displacement)[0] / self.contact.slip_force;
        let near_slip = displacement > half;
        let mut unknown = self.law.real(if near_slip { (1.0 - guess).max(1e-20) } else { guess });
        for _ in 0..60 {
            let tau = if near_slip { 1.0 - &unknown } else { unknown.clone() };
            let found = self.at(self.law.at_tau(&tau));
            let value = if near_slip { &found.remaining } else { &found.displacement };
            let ratio = if near_slip { &left / value } else { &target / value };
            let rate = value / (&unknown * &self.law.slip_force * &found.compliance);
            let step = ratio.ln() * rate;
            if step.abs().f64() < 1e-36 {
                return found;
            }
            unknown = unknown * step.exp();
        }
        panic!("{}: no force at {displacement:e}", text(&self.input));
    }

    fn at_force(&mut self, force: f64, range: &'static str, tally: &mut Tally) {
        self.set_bits_for(force / self.contact.slip_force);
        let mut at = tally.at(self.case.kind, range, || format!("{} T {force:e}", text(&self.input)));
        let exact = self.at(self.law.at_force(force));
        let [displacement, compliance, _] = call::displacement(&self.contact, force);
        // The rounding of T over mu N enters with the layer's compliance.
        let of_contact = 1.0 - (&exact.layer_displacement / &exact.displacement).f64();
        let condition = of_contact * (&exact.point.tau / &exact.point.x).f64()
            + (&exact.force * &exact.layer_compliance / &exact.displacement).f64();
        at.check("layer_displacement", displacement, &exact.displacement, condition);
        let of_contact = self.share_of_contact(&exact);
        let stiff = exact.point.compliance.f64();
        let rate = (&exact.force * &exact.layer_curvature / &exact.compliance).f64();
        let condition = of_contact * (1.0 + exact.point.rate()) / stiff + rate;
        let value = &exact.compliance;
        at.check_between("layer_compliance", compliance, value, value, condition, || {
            [-4.0, 4.0].map(|units| self.at(self.law.at_force(moved(force, units))).compliance).into()
        });
        let change = 4.0 * (&exact.force * &exact.layer_compliance - &exact.layer_displacement) * &exact.force;
        let condition = (change / &exact.energy).f64();
        let energy = call::energy(&self.contact, force);
        at.check("layer_dissipated_energy", energy, &exact.energy, condition);
    }

    /// The part of the compliance that is the contact's.
    fn share_of_contact(&self, exact: &Both) -> f64 {
        if exact.point.slips() && exact.point.compliance.f64().is_infinite() {
            return 1.0;
        }
        1.0 - (&exact.layer_compliance / &exact.compliance).f64()
    }

    fn at_given_displacement(&mut self, displacement: f64, range: &'static str, tally: &mut Tally) {
        self.set_bits_for(displacement / self.contact.slip_displacement);
        let mut at = tally.at(self.case.kind, range, || format!("{} u {displacement:e}", text(&self.input)));
        let [force, stiffness, _] = call::force(&self.contact, displacement);
        let exact = self.at_displacement(displacement);
        let slips = exact.point.slips();
        let soft = self.share_of_contact(&exact) / exact.point.compliance.f64();
        at.check("layer_force", force, &exact.force, soft);
        let of = |exact: &Both| if exact.point.slips() { self.law.real(0.0) } else { 1.0 / &exact.compliance };
        // Changes of the compliance by the rounding of the displacement and of the force.
        let rate = if slips {
            0.0
        } else {
            let curvature = &exact.point.curvature / (&self.law.stiffness_unit * &self.law.slip_force);
            let moved = &exact.displacement / &exact.compliance + &exact.force;
            (moved * (curvature + &exact.layer_curvature) / &exact.compliance).f64()
        };
        let value = of(&exact);
        let condition = soft + rate * (1.0 + soft);
        at.check_between("layer_stiffness", stiffness, &value, &value, condition, || {
            let units = 4.0 * (2.0 + 1.0 / self.law.x_slip.f64());
            [-units, units].map(|units| of(&self.at_displacement(moved(displacement, units)))).into()
        });
    }
}

/// `(2 - y) ln(1/(1-y)) - 2y`, given the logarithm of 1 - y: for small y the sum of `(k-2)/(k(k-1)) y^k` from k = 3 on.
fn loss(y: &Real, logarithm: &Real) -> Real {
    if y.f64() > 1.0 / 16.0 {
        return -((2.0 - y) * logarithm) - 2.0 * y;
    }
    let (mut power, mut sum) = (y.square() * y, Real::new(y.bits(), 0.0));
    for k in 3.. {
        let factor = Real::new(y.bits(), f64::from(k - 2)) / f64::from(k * (k - 1));
        let term = factor * &power;
        if k > 4 && (&term / &sum).f64() < 1e-36 {
            break;
        }
        sum = sum + term;
        power = power * y;
    }
    sum
}

/// Curve, inverse and energy of a contact with a layer.
pub fn curve(case: &Case, sampler: &mut Sampler, tally: &mut Tally) {
    let mut layered = random(case, sampler);
    let half = call::displacement(&layered.contact, 0.5 * layered.contact.slip_force)[0];
    for _ in 0..10 {
        let (share, range) = sampler.share_of_force();
        layered.at_force(share * layered.contact.slip_force, range, tally);
        let (share, range) = share_of_slip(sampler, half / layered.contact.slip_displacement);
        layered.at_given_displacement(share * layered.contact.slip_displacement, range, tally);
    }
}

/// The same at one force "T" or displacement "u".
pub fn at(case: &Case, layer: Layer, given: (&str, f64), range: &'static str, tally: &mut Tally) {
    let mut layered =
        Layered::new(case, with_layer(&case.reference.input, layer)).expect("a layer that the library accepts");
    match given {
        ("T", force) => layered.at_force(force, range, tally),
        (_, displacement) => layered.at_given_displacement(displacement, range, tally),
    }
}
