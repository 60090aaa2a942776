//! Elements under a varying normal force: adversarial histories with checks on every step.

pub mod mindlin;
pub mod springs;
pub mod two_directions;

use crate::library::trapped;
use crate::{Outcome, ensure};
use microslip::element::{Directions, NormalInput};
use microslip::one_direction::{self as state, Step};
use rand::Rng;
use rand::rngs::SmallRng;
use rand::seq::IndexedRandom;
use reference::Input;

/// An initialised element.
pub struct Element {
    pub library: microslip::element::Element,
    pub input: Input,
}

impl Element {
    /// With one tangential direction; `None` if the contact is too wide for its length.
    pub fn new(input: &Input, by_force: bool) -> Option<Element> {
        let normal = if by_force { NormalInput::Force } else { NormalInput::Approach };
        Element::with_directions(input, Directions::One, normal)
    }

    /// `None` if rejected.
    pub fn with_directions(input: &Input, directions: Directions, normal: NormalInput) -> Option<Element> {
        use microslip::element::Element as Library;
        let library = trapped(|| match input {
            Input::Flat(parameters) => Library::rounded_flat(parameters, directions, normal),
            Input::Ellipse(parameters) => Library::elliptic(parameters, directions, normal),
        });
        library.ok().map(|library| Element { library, input: *input })
    }

    pub fn by_force(&self) -> bool {
        self.library.normal_input == NormalInput::Force as i32
    }

    /// The normal input of a share of the largest load of the tables.
    pub fn input_of(&self, share: f64) -> f64 {
        let load = share * self.library.normal_force;
        if self.by_force() { load } else { self.library.approach_under(load).value }
    }

    /// Displacement of gross slip under the largest load of the tables.
    pub fn slip(&self) -> f64 {
        self.library.friction_coefficient * self.library.shift_under(self.library.normal_force)
    }

    /// mu N of the largest load of the tables.
    pub fn slip_force(&self) -> f64 {
        self.library.friction_coefficient * self.library.normal_force
    }
}

/// A state in the caller's memory.
#[derive(Clone)]
pub struct State(Vec<f64>);

/// Doubles before the knots of a state, and of a knot: ξ, η, N and T.
const HEADER: usize = 8;
const PER_KNOT: usize = 4;

impl State {
    pub fn new(pieces: usize) -> State {
        let mut memory = vec![f64::NAN; state::state_length(pieces)];
        state::state_init(&mut memory).expect("a state");
        State(memory)
    }

    pub fn step(&mut self, element: &Element, [displacement, input]: [f64; 2]) -> Result<Step, String> {
        let step = trapped(|| state::advance(&element.library, &mut self.0, [displacement, input], true));
        step.map_err(|error| format!("rejected: {error:?}"))
    }

    fn force_error(&self) -> f64 {
        state::force_error(&self.0)
    }

    fn knots(&self) -> &[[f64; PER_KNOT]] {
        let used = (self.0[0].to_bits() & 0xff_ffff_ffff) as usize;
        &self.0[HEADER..].as_chunks().0[..used]
    }
}

/// Kinds of histories.
pub const KINDS: [&str; 7] =
    ["scattered", "random walk", "spirals", "near-ties", "returns", "multiples", "tiny and giant"];

/// The next displacement and normal input of a kind of history, given those before.
fn next(kind: &str, element: &Element, past: &[[f64; 2]], rng: &mut SmallRng) -> [f64; 2] {
    let [u, w] = past.last().copied().unwrap_or([0.0; 2]);
    let (slip, mu) = (element.slip(), element.library.friction_coefficient);
    let shift = |w: f64| {
        let load = if element.by_force() { w } else { element.library.normal_force_at(w).value };
        if load > 0.0 { element.library.shift_under(load) } else { 0.0 }
    };
    let open = |rng: &mut SmallRng| if element.by_force() { 0.0 } else { -element.input_of(rng.random()) };
    match kind {
        "scattered" => {
            let share: f64 = rng.random_range(-0.2..1.0);
            let input = if share > 0.0 { element.input_of(share) } else { open(rng) };
            [slip * rng.random_range(-1.2..1.2), input]
        }
        "random walk" => {
            let share = (w / element.input_of(1.0) + rng.random_range(-0.1..0.1)).clamp(1e-3, 1.0);
            [(u + slip * rng.random_range(-0.1..0.1)).clamp(-slip, slip), element.input_of(share)]
        }
        // Loads that rise in small steps of different direction, each of which leaves a piece, and falls through all of them.
        "spirals" => {
            let load = if w > element.input_of(0.95) { 0.05 } else { (w / element.input_of(1.0)).max(0.0) };
            let input = element.input_of((load + 0.02).min(1.0));
            [u + mu * (shift(input) - shift(w)) * rng.random_range(-0.99..0.99), input]
        }
        "near-ties" => {
            let mut to = [u, w];
            match rng.random_range(0..9) {
                // On a characteristic, rounded.
                0 | 1 => {
                    let share: f64 = rng.random();
                    to[1] = element.input_of(share);
                    let rise = mu * (shift(to[1]) - shift(w));
                    to[0] = u + if rng.random() { rise } else { -rise };
                }
                2 => to[1] = if w > 0.0 { w.next_up().min(element.input_of(1.0)) } else { element.input_of(1e-12) },
                3 => to[1] = w.next_down().max(0.0),
                4 => to[0] = u + u.abs().max(f64::MIN_POSITIVE) * rng.random_range(-2.0..2.0) * f64::EPSILON,
                5 => to[1] = element.input_of(rng.random()),
                // Just open, just closed.
                6 => to[1] = 0.0,
                7 => to[1] = f64::from_bits(rng.random_range(0..4)),
                _ => to[0] = slip * rng.random_range(-1.0..1.0),
            }
            to
        }
        "returns" => {
            let [old, _] = *past.choose(rng).unwrap_or(&[0.0; 2]);
            let [_, input] = *past.choose(rng).unwrap_or(&[0.0; 2]);
            match rng.random_range(0..4) {
                0 => [old, w],
                1 => [u, input],
                2 => [old, input],
                _ => [slip * rng.random_range(-1.0..1.0), element.input_of(rng.random())],
            }
        }
        "multiples" => {
            let [i, j] = [(); 2].map(|()| f64::from(rng.random_range(-8..=8)));
            [slip * i / 8.0, if j > 0.0 { element.input_of(j / 8.0) } else { open(rng) }]
        }
        "tiny and giant" => {
            let size = 10f64.powf(rng.random_range(-300.0..3.0));
            let u = if rng.random() { slip * size } else { -slip * size };
            let input = 10f64.powf(rng.random_range(-320.0..0.0)) * element.input_of(1.0);
            [u, if rng.random_bool(0.1) { open(rng) } else { input }]
        }
        _ => unreachable!("{kind}"),
    }
}

/// Past points that a history may return to.
const PAST: usize = 32;

/// Advances an element through a kind of history.
pub fn checked_history(element: &Element, kind: &str, steps: u64, rng: &mut SmallRng) -> Outcome {
    let mu = element.library.friction_coefficient;
    let (mut state, mut mirrored, mut short) = (State::new(500), State::new(500), State::new(6));
    let mut past: Vec<[f64; 2]> = vec![[0.0; 2]];
    for number in 0..steps {
        let to = next(kind, element, &past, rng);
        let before = state.clone();
        let context = |message: String| {
            format!(
                "step {number}: {message}\n  state before: {:?}\n  then: {to:?}",
                &before.0[..HEADER + PER_KNOT * before.knots().len()]
            )
        };
        let step = state.step(element, to).map_err(context)?;
        let Step { force: [force, load], tangent, dissipated } = step;
        let check = || -> Outcome {
            ensure!(force.is_finite() && load.is_finite() && tangent.iter().all(|value| value.is_finite()), "{step:?}");
            ensure!(force.abs() <= mu * load, "Coulomb's bound is exceeded: {step:?}");
            ensure!(dissipated >= 0.0 && dissipated.is_finite(), "dissipated: {step:?}");
            ensure!(state.force_error() == 0.0, "merged");
            Ok(())
        };
        check().map_err(context)?;
        // Odd symmetry, to the bit.
        let opposite = mirrored.step(element, [-to[0], to[1]]).map_err(context)?;
        ensure!(
            opposite.force == [-force, load]
                && opposite.dissipated == dissipated
                && [opposite.tangent[0], -opposite.tangent[2]] == [tangent[0], tangent[2]],
            "{}",
            context(format!("mirrored {opposite:?}, not {step:?}; {:?}", mirrored.knots()))
        );
        // Bounded memory: the reported error, and the rounding of displacements.
        let reach = past.iter().map(|[u, _]| u.abs()).fold(to[0].abs(), f64::max) + element.slip();
        let rounding = 1e-13 * (element.slip_force() + reach * element.library.tangential_stiffness);
        let merged = short.step(element, to).map_err(context)?;
        let error = short.force_error();
        ensure!(
            (merged.force[0] - force).abs() <= error + rounding,
            "{}",
            context(format!("in a short state {:?}, not {force:?}, error {error:?}", merged.force[0]))
        );
        if number < 20 || rng.random_ratio(1, 512) {
            ensure!(state::state_check(&state.0).is_ok(), "{}", context("the state is not valid".to_owned()));
        }
        past.push(to);
        if past.len() > PAST {
            past.remove(0);
        }
    }
    Ok(())
}

/// A periodic motion repeats to the bit from the second period on, after any number of periods.
pub fn cycles(element: &Element, cycles: u64, rng: &mut SmallRng) -> Outcome {
    let period: Vec<[f64; 2]> = (0..6)
        .map(|_| [element.slip() * rng.random_range(-1.0..1.0), element.input_of(rng.random_range(0.05..1.0))])
        .collect();
    let mut state = State::new(64);
    let mut expected: Vec<Step> = Vec::new();
    for cycle in 0..cycles {
        for (i, place) in period.iter().enumerate() {
            let step = state.step(element, *place)?;
            match cycle {
                0 => {}
                1 => expected.push(step),
                _ => {
                    ensure!(step == expected[i], "cycle {cycle}: {step:?}, not {:?}; {period:?}", expected[i]);
                }
            }
        }
    }
    Ok(())
}
