//! Elements of two tangential directions in adversarial histories, with checks on every step. `verification/validation` compares
//! values.

use crate::call::quiet;
use crate::element::make;
use crate::sampler::{ElementCase, Sampler};
use microslip::element::{Directions, Element, NormalInput};
use microslip::law::StepResult;
use microslip::two_directions::{Law, TwoDirections};

/// Error of the force of a step that is repeated, over mu N of the parameters: rounding errors of the springs, times the condition
/// of the map to tractions, up to 1e-8 in millions of steps.
const REPEATED: f64 = 1e-7;

/// A displacement after another one; `scale` is the length of most steps.
fn next(element: &Element, [u, v, w]: [f64; 3], scale: f64, sampler: &mut Sampler) -> [f64; 3] {
    let by_force = element.normal_input == NormalInput::Force as i32;
    let [x, y] = [(); 2].map(|()| scale * sampler.between(-1.0, 1.0));
    let [u, v] = match sampler.below(12) {
        0..5 => [u + x, v + y],
        5 => [u + x, v],
        6 => [u, v + y],
        7 => [u, v],
        8 => [x, y],
        9 => [u + x, v + x],
        10 => [u + x * 1e-12, v - y * 1e-14],
        _ => [x * sampler.power(-20.0, 9.0), y * sampler.power(-20.0, 9.0)],
    };
    // Of a share of the load of the parameters.
    let input_of = |share: f64| {
        let load = share * element.normal_force;
        if by_force || element.check_normal_force(load).is_err() { load } else { element.approach_under(load).value }
    };
    let w = match sampler.below(12) {
        0..5 => w,
        5 if by_force => 0.0,
        5 => -input_of(sampler.unit()),
        6 => input_of(sampler.power(-12.0, 0.0)),
        7 => input_of(sampler.between(1.0, 3.0)),
        8 => sampler.near(w, 1).max(0.0),
        _ => input_of(sampler.between(0.01, 1.0)),
    };
    [u, v, w]
}

/// A history of 100 steps.
pub fn histories(case: &ElementCase, sampler: &mut Sampler, _: &mut crate::Tally) {
    let normal = if sampler.chance(0.5) { NormalInput::Force } else { NormalInput::Approach };
    let Some(element) = make(&case.input, Directions::Two, normal) else { return };
    let mu = element.friction_coefficient;
    let mut state = vec![f64::NAN; TwoDirections::STATE_LENGTH];
    TwoDirections::state_init(&mut state).expect("a state");
    let scale = sampler.power(-3.0, 1.0) * mu * element.shift_under(element.normal_force);
    let mut at = [0.0; 3];
    for number in 0..100 {
        let to = next(&element, at, scale, sampler);
        let accepted = if normal == NormalInput::Force {
            element.check_normal_force(to[2])
        } else {
            element.check_approach(to[2])
        };
        if accepted.is_err() {
            continue;
        }
        let before = state.clone();
        let context = || format!("step {number}, state before {before:?}, then {to:?}");
        let advance = |state: &mut Vec<f64>| {
            quiet("advance", || TwoDirections::step(&element, state, to))
                .unwrap_or_else(|e| panic!("{e:?}; {}", context()))
        };
        let step = advance(&mut state);
        let StepResult { force: [x, y, load], tangent, dissipated } = step;
        let finite = load.is_finite() && tangent.iter().all(|value| value.is_finite()) && dissipated.is_finite();
        assert!(finite && load >= 0.0 && dissipated >= 0.0, "{step:?}; {}", context());
        // The force is divided by its excess; the squares of forces are within the range of doubles.
        assert!(x.hypot(y) <= mu * load * (1.0 + 1e-15), "Coulomb's bound: {step:?}; {}", context());
        assert!(TwoDirections::state_check(&state).is_ok(), "the state is not valid: {state:?}; {}", context());
        let again = advance(&mut state.clone());
        let moved = (again.force[0] - x).hypot(again.force[1] - y) / (mu * element.normal_force);
        assert!(
            moved <= REPEATED,
            "repeated, the force moves by {moved:e} of mu N: {again:?}, not {step:?}; {}",
            context()
        );
        at = to;
    }
}
