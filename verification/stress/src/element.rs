//! Elements under a varying normal force: adversarial histories with checks on every step.

pub mod mindlin;
pub mod springs;
pub mod two_directions;

use crate::library::{in_all_rounding_directions, trapped};
use crate::{Outcome, ensure};
use microslip::element::{Directions, NormalInput};
use microslip::one_direction::{self as state, Step};
use microslip::{EllipticParameters, Material, Parameters};
use rand::Rng;
use rand::rngs::SmallRng;
use rand::seq::IndexedRandom;
use reference::Input;
use reference::family::{Family, Given};
use std::ops::RangeInclusive;

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

    /// Displacement and normal input.
    fn place(&self) -> [f64; 2] {
        [self.0[1], self.0[2]]
    }

    fn knots(&self) -> &[[f64; PER_KNOT]] {
        let used = (self.0[0].to_bits() & 0xff_ffff_ffff) as usize;
        &self.0[HEADER..].as_chunks().0[..used]
    }

    /// Tangential energy that it stores, by the closed formula over its pieces, with `M = ∫ N dS` in multi-precision.
    fn stored(&self, element: &Element, family: &Family) -> f64 {
        let mu = element.library.friction_coefficient;
        let potential = |load: f64| {
            let distinct = load > 1e-40 * element.library.normal_force;
            if distinct { family.find(Given::Load, &family.real(load)).potential.f64() } else { 0.0 }
        };
        let pieces = self.knots().windows(2).map(|knots| {
            let ([xi, eta, load, force], [next_xi, next_eta, next_load, _]) = (knots[0], knots[1]);
            let rise = 0.5 * ((next_eta - eta) + (xi - next_xi)) / mu;
            if rise <= 0.0 {
                return 0.0;
            }
            let slope = 0.5 * ((next_eta - eta) - (xi - next_xi)) / rise;
            slope * ((force - slope * load) * rise + slope * (potential(next_load) - potential(load)))
        });
        pieces.sum()
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
    let family = Family::new(&element.input);
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
            opposite.force == [-force, load] && opposite.dissipated == dissipated && opposite.tangent[0] == tangent[0],
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
            if kind != "tiny and giant" {
                substeps(element, &before, &state, step, reach, rng).map_err(context)?;
                energy_balance(element, &family, &before, &state, step, reach).map_err(context)?;
            }
        }
        past.push(to);
        if past.len() > PAST {
            past.remove(0);
        }
    }
    Ok(())
}

/// Points of the straight path in (S, u) from one place to another, at the given fractions; `None` if it opens or closes the contact.
fn along(element: &Element, [u0, w0]: [f64; 2], [u1, w1]: [f64; 2], fraction: f64) -> Option<[f64; 2]> {
    if w0 <= 0.0 || w1 <= 0.0 {
        return None;
    }
    let library = &element.library;
    let load = |w: f64| if element.by_force() { w } else { library.normal_force_at(w).value };
    let [from, to] = [w0, w1].map(|w| library.shift_under(load(w)));
    let load = library.load_under(from + fraction * (to - from));
    let input = if element.by_force() { load } else { library.approach_under(load).value };
    Some([u0 + fraction * (u1 - u0), if w0 == w1 { w0 } else { input }])
}

/// A step in parts gives the same force and the same energy.
fn substeps(element: &Element, before: &State, after: &State, step: Step, reach: f64, rng: &mut SmallRng) -> Outcome {
    let (from, to) = (before.place(), after.place());
    let parts = rng.random_range(2..6);
    let mut state = before.clone();
    let mut sum = 0.0;
    for part in 1..parts {
        let Some(place) = along(element, from, to, f64::from(part) / f64::from(parts)) else { return Ok(()) };
        sum += state.step(element, place)?.dissipated;
    }
    let last = state.step(element, to)?;
    sum += last.dissipated;
    // Each part rounds displacements and loads.
    let force = 1e-13 * (element.slip_force() + reach * element.library.tangential_stiffness);
    ensure!((last.force[0] - step.force[0]).abs() <= force, "in {parts} parts {last:?}, not {step:?}");
    let energy = 1e-12 * element.slip_force() * reach;
    ensure!((sum - step.dissipated).abs() <= energy, "in {parts} parts {sum:e} dissipated, not {step:?}");
    Ok(())
}

/// `∫ T du = E + ΔW`, the work by adaptive Simpson quadrature of the forces along the step.
fn energy_balance(
    element: &Element,
    family: &Family,
    before: &State,
    after: &State,
    step: Step,
    reach: f64,
) -> Outcome {
    let (from, to) = (before.place(), after.place());
    if along(element, from, to, 0.5).is_none() {
        return Ok(());
    }
    let force = |fraction: f64| {
        let place = along(element, from, to, fraction).expect("closed");
        before.clone().step(element, place).expect("a step").force[0]
    };
    let scale = element.slip_force() * reach;
    let start = before.knots().last().map_or(0.0, |knot| knot[3]);
    let values = [start, force(0.5), step.force[0]];
    let tolerance = 1e-9 * element.slip_force();
    let work = (to[0] - from[0]) * simpson(&force, [0.0, 1.0], values, tolerance, 0);
    let stored = after.stored(element, family) - before.stored(element, family);
    let off = work - step.dissipated - stored;
    // Tolerances of all intervals add up; the derivative of T jumps between them.
    ensure!(off.abs() <= 1e-8 * scale, "work {work:e}, stored {stored:e}, dissipated {:e}", step.dissipated);
    Ok(())
}

fn simpson(
    f: &dyn Fn(f64) -> f64,
    [from, to]: [f64; 2],
    [first, middle, last]: [f64; 3],
    tolerance: f64,
    depth: u32,
) -> f64 {
    // A corner of the force may make two of the first estimates agree by chance.
    const DEPTHS: RangeInclusive<u32> = 4..=20;
    let centre = 0.5 * (from + to);
    let [lower, upper] = [f(0.5 * (from + centre)), f(0.5 * (centre + to))];
    let whole = (first + 4.0 * middle + last) / 6.0;
    let halves = (first + 4.0 * lower + 2.0 * middle + 4.0 * upper + last) / 12.0;
    let agree = depth >= *DEPTHS.start() && (halves - whole).abs() <= tolerance;
    if agree || depth == *DEPTHS.end() {
        return (to - from) * halves;
    }
    simpson(f, [from, centre], [first, lower, middle], tolerance, depth + 1)
        + simpson(f, [centre, to], [middle, upper, last], tolerance, depth + 1)
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

/// The element of the same contact in other units: lengths and forces.
fn in_units(element: &Element, [length, force]: [f64; 2]) -> Element {
    let scaled = |material: [Material; 2]| {
        material.map(|body| Material { young_modulus: body.young_modulus * force / length / length, ..body })
    };
    let input = match element.input {
        Input::Flat(p) => Input::Flat(Parameters {
            flat_half_width: p.flat_half_width * length,
            edge_radius: p.edge_radius * length,
            length: p.length * length,
            normal_force: p.normal_force * force,
            material: scaled(p.material),
            ..p
        }),
        Input::Ellipse(p) => Input::Ellipse(EllipticParameters {
            semi_axis_x: p.semi_axis_x * length,
            semi_axis_y: p.semi_axis_y * length,
            normal_force: p.normal_force * force,
            material: scaled(p.material),
            ..p
        }),
    };
    Element::new(&input, element.by_force()).expect("an element")
}

/// The same history in other units, and under each rounding direction.
pub fn scaled_and_rounded(element: &Element, units: [f64; 2], steps: u64, rng: &mut SmallRng) -> Outcome {
    let [length, force_unit] = units;
    let other = &in_units(element, units);
    let by_force = element.by_force();
    let mut past: Vec<[f64; 2]> = vec![[0.0; 2]];
    for number in 0..steps.min(20_000) {
        let kind = KINDS[[0, 1, 2, 4, 5][(number / 50 % 5) as usize]];
        let mut to = next(kind, element, &past, rng);
        if number % 50 == 49 && !by_force {
            to[1] = -to[1].abs();
        }
        past.push(to);
    }
    let run = |element: &Element, [length, input]: [f64; 2]| -> Result<Vec<Step>, String> {
        let mut state = State::new(500);
        // Without traps, which the control word of a rounding direction replaces.
        let step = |[u, w]: &[f64; 2]| {
            state::advance(&element.library, &mut state.0, [u * length, w * input], true)
                .map_err(|error| format!("{error:?}"))
        };
        past.iter().map(step).collect()
    };
    let input_unit = if by_force { force_unit } else { length };
    let expected = run(element, [1.0, 1.0])?;
    let scaled = run(other, [length, input_unit])?;
    let reach = past.iter().map(|[u, _]| u.abs()).fold(element.slip(), f64::max);
    let scale = element.slip_force() + reach * element.library.tangential_stiffness;
    let differ = |steps: &[Step], [length, force]: [f64; 2]| {
        let pairs = expected.iter().zip(steps);
        let far = |(one, two): (&Step, &Step)| {
            let forces = (one.force[0] - two.force[0] / force).abs().max((one.force[1] - two.force[1] / force).abs());
            let energy = (one.dissipated - two.dissipated / force / length).abs();
            // Rounding of displacements and loads; of the slip times the largest force.
            forces > 2e-13 * scale || energy > 1e-12 * scale * reach
        };
        pairs.clone().position(far).map(|i| format!("step {i}: {:?}, not {:?}", steps[i], expected[i]))
    };
    if let Some(message) = differ(&scaled, units) {
        return Err(format!("in other units {message}"));
    }
    for (direction, steps) in
        ["nearest", "down", "up", "zero"].iter().zip(in_all_rounding_directions(|| run(element, [1.0, 1.0])))
    {
        if let Some(message) = differ(&steps?, [1.0, 1.0]) {
            return Err(format!("rounding {direction}: {message}"));
        }
    }
    Ok(())
}
