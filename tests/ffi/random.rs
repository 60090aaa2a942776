//! Random contacts and elements from the whole range that is allowed, in every rounding mode: no call raises an exception that may be
//! trapped or returns NaN, and every new state passes its check.

use super::*;
use crate::common::Random;
use microslip::{EllipticParameters, Layer, Material, Parameters};

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.next())
    }

    fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    /// A share of 1: usual, or of any magnitude.
    fn share(&mut self) -> f64 {
        match self.below(8) {
            0 => 0.0,
            1 => 1.0,
            2..5 => self.between(1e-300, 1.0),
            _ => self.next(),
        }
    }

    fn material(&mut self) -> Material {
        let young_modulus = if self.one_in(4) { self.between(1e-20, 1e30) } else { self.between(1e9, 1e12) };
        let poisson_ratio = [0.0, 0.5, 0.5 * self.next(), 0.5 * self.next()][self.below(4)];
        Material { young_modulus, poisson_ratio }
    }
}

/// Upward, the compliance of an interior stick zone is 0: 2L/b is 1 but for a rounding error.
const LEAST_COMPLIANCE: Parameters = Parameters {
    flat_half_width: 0.0,
    edge_radius: 0.1026255573584203,
    length: 0.0002283963619094519,
    normal_force: 33.07472369097524,
    friction_coefficient: 0.6387916804937607,
    material: [
        Material { young_modulus: 165914232035.1276, poisson_ratio: 0.0 },
        Material { young_modulus: 2e11, poisson_ratio: 0.0 },
    ],
    layer: Layer::none(),
    displacement_reference: MSLIP_CENTRE_POINT,
    reserved: 0,
};

fn flat(random: &mut Random, span: f64) -> Parameters {
    let near_one = |random: &mut Random| random.between(1.0 / span, span);
    let edge_radius = 0.02 * near_one(random);
    let share = [0.0, 0.2 * random.next(), random.between(1e-20, 1e3)][random.below(3)];
    let mut p = Parameters {
        flat_half_width: edge_radius * share,
        edge_radius,
        length: 0.02 * near_one(random),
        normal_force: 100.0 * near_one(random),
        friction_coefficient: if random.one_in(4) { random.between(1e-20, 1e20) } else { 2.0 * random.next() },
        material: [random.material(), random.material()],
        layer: Layer::none(),
        displacement_reference: random.below(2) as i32,
        reserved: 0,
    };
    if random.one_in(2) {
        // Near the shortest length that is allowed with this force per length.
        let (load, [mut low, mut high]) = (p.normal_force / p.length, [1e-9 * p.length, p.length]);
        for _ in 0..60 {
            let length = low.sqrt() * high.sqrt();
            let contact = Parameters { length, normal_force: load * length, ..p };
            *(if microslip::Contact::rounded_flat(&contact).is_ok() { &mut high } else { &mut low }) = length;
        }
        p.length = high * (1.0 + random.between(1e-16, 4.0));
        p.normal_force = load * p.length;
    }
    p
}

/// A contact and elements of all directions and normal inputs; those that are accepted. Half of them have a layer.
fn laws(random: &mut Random, least: bool) -> Vec<Law> {
    let span = [10.0, 1e6, 1e6, 1e60][random.below(4)];
    let mut p = if least { LEAST_COMPLIANCE } else { flat(random, span) };
    let semi_axis_x = 1e-3 * random.between(1.0 / span, span);
    let mut e = EllipticParameters {
        semi_axis_x,
        semi_axis_y: semi_axis_x * [1.0, random.between(1e-3, 1e3)][random.below(2)],
        normal_force: p.normal_force,
        friction_coefficient: p.friction_coefficient,
        material: p.material,
        layer: Layer::none(),
    };
    let is_elliptic = !least && random.one_in(3);
    let alone = if is_elliptic { microslip::Contact::elliptic(&e) } else { microslip::Contact::rounded_flat(&p) };
    if let (Ok(contact), false, true) = (alone, least, random.one_in(2)) {
        let mut compliance = || random.between(1e-4, 1e4) / contact.initial_stiffness;
        let [normal_compliance, tangential_compliance] = [compliance(), compliance()];
        let stiffening_load = p.normal_force * random.between(1e-3, 1e3);
        p.layer = Layer { normal_compliance, tangential_compliance, stiffening_load, reference_load: 0.0 };
        e.layer = p.layer;
    }
    let init = |contact| unsafe {
        if is_elliptic {
            mslip_contact_init_elliptic(&raw const e, contact)
        } else {
            mslip_contact_init(&raw const p, contact)
        }
    };
    let is_made = |init: &dyn Fn(*mut u8) -> i32| init(Memory::new::<mslip_element>(1).start) == MSLIP_OK;
    let mut laws = Vec::new();
    if is_made(&|start| init(start.cast())) {
        laws.extend(calls::RULES.map(|rule| Law { rule, ..calls::law_of_contact(is_elliptic, init) }));
    }
    for (directions, input) in
        [1, 2].into_iter().flat_map(|n| [(n, MSLIP_INPUT_APPROACH), (n, MSLIP_INPUT_NORMAL_FORCE)])
    {
        let init = |element| unsafe {
            if is_elliptic {
                mslip_element_init_elliptic(&raw const e, directions, input, element)
            } else {
                mslip_element_init(&raw const p, directions, input, element)
            }
        };
        if is_made(&|start| init(start.cast())) {
            laws.push(calls::element(is_elliptic, init));
        }
    }
    laws
}

/// A value of an argument, of which the valid one is given: another share of it, of a displacement also far beyond gross slip.
fn value(random: &mut Random, argument: &calls::Argument, valid: f64) -> f64 {
    let far = if argument.name == "displacement" && random.one_in(16) { random.between(1.0, 1e100) } else { 1.0 };
    let sign = if argument.name == "displacement" && random.one_in(2) { -1.0 } else { 1.0 };
    (sign * far * random.share() * valid).clamp(-1e150, 1e150)
}

#[test]
fn random_laws_in_all_rounding_modes() {
    let (mut random, mut accepted, mut made) = (Random(common::seed()), 0, 0);
    for draw in 0..1000 {
        for law in laws(&mut random, draw % 20 == 0) {
            let is_element = law.approach > 0.0;
            let of_law =
                |call: &&Call| call.has(if is_element { Element } else { Contact }) && is_available(call, &law);
            for call in CALLS.iter().filter(|call| call.has(Output) && !call.is_sliders()).filter(of_law) {
                let mode = random.below(calls::MODES);
                let mut arguments = Arguments::new(call, &law);
                for _ in 0..if call.has(State) { 4 } else { 1 } {
                    for (place, argument) in call.arguments.iter().enumerate() {
                        if !matches!(argument.kind, Value | Input) {
                            continue;
                        }
                        for (i, valid) in law.input(call, argument).into_iter().enumerate() {
                            let value = match law.is_normal(call, argument, i) {
                                // Harmonics that open a contact by approach make a force negative.
                                true if call.has(Workspace) => valid,
                                true => valid * random.share(),
                                false => value(&mut random, argument, valid),
                            };
                            arguments.exchange(place, i, value);
                        }
                    }
                    made += 1;
                    if call.make_rounding(mode, &arguments.slots) != MSLIP_OK {
                        continue;
                    }
                    accepted += 1;
                    _ = results(call, &arguments);
                    if let (Some(old), Some(new)) = (call.place(State), call.place(NewState)) {
                        let states = arguments.memory(new).values::<f64>();
                        for state in states.chunks(states.len() / call.items()) {
                            let status = memory::check(&law, is_element, &Memory::of(state));
                            assert_eq!(status, MSLIP_OK, "{}, mode {mode}: {state:?}", call.name);
                        }
                        arguments.set(old, Memory::of(states));
                    }
                }
            }
        }
    }
    assert!(4 * accepted > 3 * made, "{accepted} of {made} calls were accepted");
}
