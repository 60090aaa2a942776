//! Every function of the C interface in every rounding mode, with contacts and elements of every kind, half of them with a layer:
//! no call raises an exception that an application may trap or returns NaN, and every new state passes its check.

use crate::calls::Kind::{Contact, Element, NewState, Output, State, Value};
use crate::calls::{self, Arguments, CALLS, Call, Law, MODES, Memory};
use crate::layer;
use crate::sampler::{Case, Sampler};
use microslip::ffi::*;
use microslip::{Layer, Material, Parameters};
use reference::Input;

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

/// The contact with both rules of a workspace, and elements of all directions and normal inputs that are accepted.
fn laws(input: &Input) -> Vec<Law> {
    let is_elliptic = matches!(input, Input::Ellipse(_));
    let contact = |contact| unsafe {
        match input {
            Input::Flat(p) => mslip_contact_init(p, contact),
            Input::Ellipse(p) => mslip_contact_init_elliptic(p, contact),
        }
    };
    let contacts = calls::RULES.map(|rule| Law { rule, ..calls::law_of_contact(is_elliptic, contact) });
    let elements = [1, 2].into_iter().flat_map(|n| [(n, MSLIP_INPUT_APPROACH), (n, MSLIP_INPUT_NORMAL_FORCE)]);
    let elements = elements.filter_map(|(directions, normal)| {
        let element = |element| unsafe {
            match input {
                Input::Flat(p) => mslip_element_init(p, directions, normal, element),
                Input::Ellipse(p) => mslip_element_init_elliptic(p, directions, normal, element),
            }
        };
        let is_made = element(Memory::new::<mslip_element>(1).start.cast()) == MSLIP_OK;
        is_made.then(|| calls::element(is_elliptic, element))
    });
    contacts.into_iter().chain(elements).collect()
}

/// A share of 1: usual, or of any magnitude.
fn share(sampler: &mut Sampler) -> f64 {
    match sampler.below(8) {
        0 => 0.0,
        1 => 1.0,
        2..5 => sampler.power(-300.0, 0.0),
        _ => sampler.unit(),
    }
}

/// Other values of the arguments than the valid ones: shares of them, of displacements also far beyond gross slip.
fn change(arguments: &mut Arguments, call: &Call, law: &Law, sampler: &mut Sampler) {
    for (place, argument) in call.arguments.iter().enumerate() {
        if !matches!(argument.kind, Value | calls::Kind::Input) {
            continue;
        }
        for (i, valid) in law.input(call, argument).into_iter().enumerate() {
            let is_normal = law.is_normal(call, argument, i);
            let far = if argument.name == "displacement" && !is_normal && sampler.chance(0.06) { 100.0 } else { 0.0 };
            let size = sampler.power(0.0, far) * share(sampler) * valid;
            let sign = if argument.name == "displacement" && !is_normal && sampler.chance(0.5) { -1.0 } else { 1.0 };
            // Harmonics that open a contact by approach make a force negative.
            let is_kept = is_normal && call.has(calls::Kind::Workspace);
            arguments.exchange(place, i, if is_kept { valid } else { (sign * size).clamp(-1e150, 1e150) });
        }
    }
}

pub fn check_all_laws(case: &Case, sampler: &mut Sampler, _: &mut crate::Tally) {
    let layered = sampler.chance(0.5).then(|| layer::random(case, sampler).reference.input);
    let (mut made, mut accepted) = (0, 0);
    let input =
        layered.unwrap_or(if sampler.chance(0.1) { Input::Flat(LEAST_COMPLIANCE) } else { case.reference.input });
    for law in laws(&input) {
        let is_element = law.approach > 0.0;
        let of_law = |call: &&Call| {
            call.has(Output)
                && call.has(if is_element { Element } else { Contact })
                && !(call.is_sliders() || call.flat && law.is_elliptic || call.one_direction && law.directions == 2)
        };
        for call in CALLS.iter().filter(of_law) {
            let (mode, mut arguments) = (sampler.below(MODES), Arguments::new(call, &law));
            for _ in 0..if call.has(State) { 4 } else { 1 } {
                change(&mut arguments, call, &law, sampler);
                made += 1;
                if call.make_rounding(mode, &arguments.slots) != MSLIP_OK {
                    continue;
                }
                accepted += 1;
                for (argument, memory) in call.arguments.iter().zip(&arguments.memory) {
                    let values = memory.iter().flat_map(Memory::values::<f64>);
                    assert!(
                        argument.kind != Output || values.clone().all(|value| !value.is_nan()),
                        "{}: NaN",
                        call.name
                    );
                }
                if let (Some(old), Some(new)) = (call.place(State), call.place(NewState)) {
                    let states = arguments.memory(new).values::<f64>();
                    for state in states.chunks(states.len() / call.items()) {
                        let (n, start) = (state.len(), state.as_ptr());
                        let status = unsafe {
                            if is_element {
                                mslip_element_state_check(law.directions, n, start)
                            } else {
                                mslip_state_check(n, start)
                            }
                        };
                        assert_eq!(status, MSLIP_OK, "{}, mode {mode}: {state:?}", call.name);
                    }
                    arguments.set(old, Memory::of(states));
                }
            }
        }
    }
    assert!(2 * accepted > made, "{accepted} of {made} calls were accepted");
}
