//! Elements of two tangential directions: random contacts in adversarial histories, with checks on every step.

use super::Element;
use crate::contacts::{self, Shape};
use crate::library::trapped;
use crate::{Outcome, ensure};
use microslip::Material;
use microslip::element::{Directions, NormalInput};
use microslip::parameters::{CENTRE_POINT, RIGID_STRIP};
use microslip::two_directions::{self, Step};
use rand::Rng;
use rand::rngs::SmallRng;
use reference::Input;

/// Steps with one contact.
const STEPS: u64 = 100;
/// Error of the force of a step that is repeated, over mu N of the parameters: where the slip converges, a rounding error.
const REPEATED: f64 = 1e-9;

/// 10 to the power of a random number.
fn power(rng: &mut SmallRng, low: f64, high: f64) -> f64 {
    10f64.powf(rng.random_range(low..high))
}

/// Every kind of contact, in units of up to 2^±330; `None` if it is out of range.
fn random_element(rng: &mut SmallRng) -> Option<Element> {
    let mut body = || Material { young_modulus: power(rng, 9.0, 12.0), poisson_ratio: rng.random_range(0.0..=0.5) };
    let unlike = [body(), body()];
    let material = if rng.random() { unlike } else { [unlike[0]; 2] };
    let [length_unit, force_unit] =
        if rng.random_ratio(1, 4) { [(); 2].map(|()| rng.random_range(-330..=330)) } else { [0; 2] };
    let mut input = if rng.random() {
        let rounded = if rng.random() { 1.0 } else { power(rng, -3.0, 0.0) };
        let reference = if rng.random() { CENTRE_POINT } else { RIGID_STRIP };
        let shape = Shape { rounded, length: power(rng, 0.5, 3.0), material, reference };
        contacts::flat(&shape, length_unit, force_unit)
    } else {
        contacts::ellipse(2e-4, 2e-4 * power(rng, -1.0, 1.0), length_unit, force_unit)
    };
    let friction = power(rng, -3.0, 0.3);
    match &mut input {
        Input::Flat(parameters) => parameters.friction_coefficient = friction,
        Input::Ellipse(parameters) => parameters.friction_coefficient = friction,
    }
    let normal = if rng.random() { NormalInput::Force } else { NormalInput::Approach };
    Element::with_directions(&input, Directions::Two, normal)
}

/// A displacement after another one; `scale` is the length of most steps over the slip displacement.
fn next(element: &Element, [u, v, w]: [f64; 3], scale: f64, rng: &mut SmallRng) -> [f64; 3] {
    let slip = element.slip();
    let mut random = || slip * scale * rng.random_range(-1.0..1.0);
    let [x, y] = [random(), random()];
    let [u, v] = match rng.random_range(0..12) {
        0..5 => [u + x, v + y],
        5 => [u + x, v],
        6 => [u, v + y],
        7 => [u, v],
        8 => [x, y],
        9 => [u + x, v + x],
        10 => [u + x * 1e-12, v - y * 1e-14],
        _ => [x * power(rng, -20.0, 9.0), y * power(rng, -20.0, 9.0)],
    };
    let w = match rng.random_range(0..12) {
        0..5 => w,
        5 if element.by_force() => 0.0,
        5 => -element.input_of(rng.random()),
        6 => element.input_of(power(rng, -12.0, 0.0)),
        7 => element.input_of(rng.random_range(1.0..3.0)),
        8 => if rng.random() { w.next_up() } else { w.next_down() }.max(0.0),
        _ => element.input_of(rng.random_range(0.01..1.0)),
    };
    [u, v, w]
}

/// Whether the contact is not too wide for its length.
fn accepts(element: &Element, input: f64) -> bool {
    let library = &element.library;
    (if element.by_force() { library.check_normal_force(input) } else { library.check_approach(input) }).is_ok()
}

fn advance(element: &Element, state: &mut [f64], to: [f64; 3]) -> Result<Step, String> {
    trapped(|| two_directions::advance(&element.library, state, to)).map_err(|error| format!("rejected: {error:?}"))
}

/// Random contacts, each in a history of its own.
pub fn histories(steps: u64, rng: &mut SmallRng) -> Outcome {
    for _ in 0..steps.div_ceil(STEPS) {
        let Some(element) = random_element(rng) else { continue };
        history(&element, rng).map_err(|message| format!("{message}\n  {:?}", element.input))?;
    }
    Ok(())
}

fn history(element: &Element, rng: &mut SmallRng) -> Outcome {
    let mu = element.library.friction_coefficient;
    let mut state = vec![f64::NAN; two_directions::state_length()];
    two_directions::state_init(&mut state).expect("a state");
    let mut at = [0.0; 3];
    let scale = power(rng, -3.0, 1.0);
    for number in 0..STEPS {
        let to = next(element, at, scale, rng);
        if !accepts(element, to[2]) {
            continue;
        }
        let before = state.clone();
        let context = |message: String| format!("step {number}: {message}\n  state before: {before:?}\n  then: {to:?}");
        let step = advance(element, &mut state, to).map_err(context)?;
        let check = || -> Outcome {
            let Step { force: [x, y, load], tangent, dissipated } = step;
            ensure!(load >= 0.0 && load.is_finite() && tangent.iter().all(|value| value.is_finite()), "{step:?}");
            // The force is divided by its excess; the squares of forces are within the range of doubles.
            ensure!(x.hypot(y) <= mu * load * (1.0 + 1e-15), "Coulomb's bound is exceeded: {step:?}");
            ensure!(dissipated >= 0.0 && dissipated.is_finite(), "dissipated: {step:?}");
            ensure!(two_directions::state_check(&state).is_ok(), "the state is not valid: {state:?}");
            let again = advance(element, &mut state.clone(), to)?;
            let moved = (again.force[0] - x).hypot(again.force[1] - y) / element.slip_force();
            ensure!(moved <= REPEATED, "repeated, the force moves by {moved:e} of mu N: {again:?}, not {step:?}");
            Ok(())
        };
        check().map_err(context)?;
        at = to;
    }
    Ok(())
}
