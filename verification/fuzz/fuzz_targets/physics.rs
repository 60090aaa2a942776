//! Physical invariants of a valid contact under any load history, and the agreement of all ways to one result.
#![no_main]

use libfuzzer_sys::arbitrary::{self, Arbitrary};
use libfuzzer_sys::{Corpus, fuzz_target};
use microslip::Contact;
use microslip::constant_load::equivalents;
use microslip::ffi::*;
use microslip_fuzz::{AnyParameters, Choice, Number, Numbers, Path};
use std::f64::consts::PI;

#[derive(Arbitrary, Debug)]
struct Input {
    contact: Choice,
    invariants: Invariants,
}

#[derive(Arbitrary, Debug)]
enum Invariants {
    History { path: Path, parts: u8, inner: u8 },
    Curve { parts: [Number; 6], x: Number },
    Cycle { amplitudes: [Number; 2], sliders: Option<u8> },
    Harmonics { harmonics: u8, samples: u8, event_driven: bool, displacement: [Number; 9] },
    Units { length: i8, force: i8, part: Number },
}

fuzz_target!(|input: Input| -> Corpus {
    let Some((parameters, contact)) = input.contact.contact() else { return Corpus::Reject };
    if contact.slip_force <= 0.0 {
        return Corpus::Reject;
    }
    let mut numbers = Numbers::default();
    // An admissible displacement.
    let mut displacement = |number| {
        let value = numbers.one(number, contact.slip_displacement);
        if value.abs() <= 1e150 { value } else { contact.slip_displacement }
    };
    match input.invariants {
        Invariants::History { path, parts, inner } => {
            let mut path = path.displacements(&mut Numbers::default(), contact.slip_displacement);
            path.retain(|displacement| displacement.abs() <= 1e150);
            history(&contact, &path, usize::from(parts % 4) + 1, (f64::from(inner) + 0.5) / 256.0);
        }
        Invariants::Curve { parts, x } => curve(&contact, &parts, x),
        Invariants::Cycle { amplitudes, sliders } => cycle(&contact, amplitudes.map(displacement), sliders),
        Invariants::Harmonics { harmonics, samples, event_driven, displacement: coefficients } => {
            let harmonics = usize::from(harmonics % 4) + 1;
            let rule = if event_driven { MSLIP_EVENT_DRIVEN } else { MSLIP_UNIFORM_SAMPLING };
            let coefficients: Vec<f64> = coefficients[..2 * harmonics + 1].iter().map(|&c| displacement(c)).collect();
            harmonic_force(&contact, &coefficients, 2 * harmonics + 1 + usize::from(samples % 32), rule);
        }
        Invariants::Units { length, force, part: number } => {
            units(
                &parameters,
                &contact,
                [length, force].map(|exponent| 2f64.powi(i32::from(exponent) / 2)),
                part(number),
            );
        }
    }
    Corpus::Keep
});

/// A part of gross slip, so large that no product underflows.
fn part(number: Number) -> f64 {
    let part = Numbers::default().one(number, 1.0).abs();
    let part = if part <= 1.0 { part } else { 1.0 / part };
    if part >= 1e-100 { part } else { 0.0 }
}

/// The C interface with a contact and a state.
struct Stepper {
    contact: mslip_contact,
    state: Vec<f64>,
}

impl Stepper {
    fn new(contact: &Contact, reversals: usize) -> Stepper {
        let mut state = vec![f64::NAN; mslip_state_length(reversals)];
        assert!(unsafe { mslip_state_init(state.len(), state.as_mut_ptr()) } == MSLIP_OK);
        Stepper { contact: (*contact).into(), state }
    }

    /// Force, tangent stiffness and dissipated energy of a step.
    fn step(&mut self, displacement: f64) -> (f64, f64, f64) {
        let (mut force, mut stiffness, mut dissipated) = (f64::NAN, f64::NAN, f64::NAN);
        let (n, state) = (self.state.len(), self.state.as_mut_ptr());
        let status = unsafe {
            mslip_masing_update(
                &self.contact,
                n,
                state,
                displacement,
                state,
                &mut force,
                &mut stiffness,
                &mut dissipated,
            )
        };
        assert!(status == MSLIP_OK, "{status}");
        (force, stiffness, dissipated)
    }

    /// The values in use: a header of 5 doubles, whose first holds the number of reversals in its last 40 bits, and 3 for each.
    fn used(&self) -> Vec<f64> {
        let depth = self.state[0].to_bits() & 0xff_ffff_ffff;
        self.state[..5 + 3 * depth as usize].to_vec()
    }

    /// Bound on the error of the force due to removed reversals.
    fn error(&self) -> f64 {
        let mut error = f64::NAN;
        assert!(unsafe { mslip_state_error(self.state.len(), self.state.as_ptr(), &mut error) } == MSLIP_OK);
        error
    }

    fn check(&self) {
        assert!(unsafe { mslip_state_check(self.state.len(), self.state.as_ptr()) } == MSLIP_OK, "{:?}", self.state);
    }
}

/// Coulomb's bound, dissipation, odd symmetry, steps of zero and in parts, one call for all steps, small states, and closed loops.
fn history(contact: &Contact, path: &[f64], parts: usize, inner: f64) {
    let new = |reversals| Stepper::new(contact, reversals);
    let capacity = path.len() + 2;
    let [mut whole, mut opposite, mut divided, mut at_once] = [(); 4].map(|()| new(capacity));
    let mut small = new(2 + path.len() % 7);
    let (limit, stiffest) = (contact.slip_force, contact.initial_stiffness);
    let farthest = path.iter().fold(0.0, |farthest: f64, displacement| farthest.max(displacement.abs()));
    let mut steps = Vec::new();
    let (mut before, mut last) = (0.0, 0.0);
    for &displacement in path {
        let step = whole.step(displacement);
        let (force, stiffness, energy) = step;
        assert!(force.abs() <= limit, "{force:e} exceeds {limit:e}");
        assert!(stiffness >= 0.0 && stiffness <= stiffest * (1.0 + 1e-15), "{stiffness:e} exceeds {stiffest:e}");
        assert!(energy >= 0.0 && energy.is_finite(), "dissipated {energy:e}");
        steps.push(step);

        assert_eq!(opposite.step(-displacement), (-force, stiffness, energy), "the opposite step");

        let ((merged, ..), error) = (small.step(displacement), small.error());
        assert!(whole.error() == 0.0 && (error > 0.0 || merged == force), "{merged:e} instead of {force:e}");
        // Displacements far from the initial one round the ranges of their branches.
        let rounding = 4e-15 * limit + 4.0 * f64::EPSILON * farthest * stiffest;
        assert!((merged - force).abs() <= error + rounding, "{merged:e} instead of {force:e}, bound {error:e}");

        small.check();

        let state = whole.used();
        assert_eq!(whole.step(displacement), (force, stiffness, 0.0), "a step of zero");
        assert_eq!(whole.used(), state, "a step of zero");

        let mut sum = 0.0;
        for part in 1..parts {
            let between = last + (displacement - last) * (part as f64 / parts as f64);
            sum += divided.step(between.max(last.min(displacement)).min(last.max(displacement))).2;
        }
        let end = divided.step(displacement);
        sum += end.2;
        assert_eq!((end.0, end.1), (force, stiffness), "in parts");
        assert_eq!(divided.used(), whole.used(), "in parts");
        // The energies are differences of those of loops.
        let scale = limit * (contact.slip_displacement + (displacement - last).abs());
        assert!((sum - energy).abs() <= 1e-12 * scale, "dissipated {sum:e} in parts, {energy:e} in one step");
        if displacement != last {
            (before, last) = (last, displacement);
        }
    }

    let n = path.len();
    let mut outputs = [(); 3].map(|()| vec![0.0; n]);
    let [force, stiffness, dissipated] = outputs.each_mut().map(|output| output.as_mut_ptr());
    let (length, state) = (at_once.state.len(), at_once.state.as_mut_ptr());
    let status = unsafe {
        mslip_masing_path(&at_once.contact, length, state, n, path.as_ptr(), state, force, stiffness, dissipated)
    };
    assert!(status == MSLIP_OK, "{status}");
    for (i, &step) in steps.iter().enumerate() {
        assert_eq!((outputs[0][i], outputs[1][i], outputs[2][i]), step, "step {i} of a path");
    }
    assert_eq!(at_once.used(), whole.used(), "after a path");
    whole.check();

    let Some(&(force, stiffness, _)) = steps.last() else { return };
    let state = whole.used();
    whole.step(last + inner * (before - last));
    let (again, tangent, _) = whole.step(last);
    assert!((again - force).abs() <= 1e-13 * limit, "after a loop {again:e} instead of {force:e}");
    // In gross slip the initial loading curve is shifted back and forth.
    if force.abs() < limit && last + inner * (before - last) != before {
        assert_eq!((again, tangent), (force, stiffness), "after a closed loop");
        assert_eq!(whole.used(), state, "after a closed loop");
    }
}

/// The monotonic curve in both directions, its monotony and concavity, tractions, and energy.
fn curve(contact: &Contact, parts: &[Number], x: Number) {
    let (limit, slip) = (contact.slip_force, contact.slip_displacement);
    let mut parts: Vec<f64> = parts.iter().map(|&number| part(number)).chain([0.0, 1.0]).collect();
    parts.sort_by(f64::total_cmp);
    let x = contact.half_width * Numbers::default().one(x, 1.0).clamp(-2.0, 2.0);
    let x = if x.is_nan() { 0.0 } else { x };
    let coulomb = contact.curve_at_force(limit).unwrap().shear(x);
    let mut previous: Option<(f64, [f64; 8])> = None;
    for part in parts {
        let force = part * limit;
        let at_force = contact.curve_at_force(force).unwrap();
        let (displacement, compliance, shear) = (at_force.displacement(), at_force.compliance(), at_force.shear(x));
        assert!(shear <= coulomb * (1.0 + 1e-11), "shear {shear:e} exceeds {coulomb:e}");
        let back = contact.curve_at_displacement(displacement).unwrap();
        assert!((back.force() - force).abs() <= 1e-13 * force, "{force:e} and back {:e}", back.force());
        if part < 0.99 {
            let product = back.stiffness() * compliance;
            assert!((product - 1.0).abs() <= 1e-10, "stiffness times compliance {product:e}");
        }
        let at_part = contact.curve_at_displacement(part * slip).unwrap();
        let values = [
            displacement,
            contact.dissipated_energy(force).unwrap(),
            if part == 1.0 { limit } else { at_part.force() },
            shear,
            compliance,
            -at_force.stick_half_width(),
            -at_part.stiffness(),
            -at_part.stick_half_width(),
        ];
        if let Some((last, lower)) = previous {
            // Neighbouring points may change places within their errors.
            let order = if part > last * (1.0 + 1e-14) { 1e-13 } else { 1e-12 };
            let errors = [order, order, order, f64::NAN, 1e-12, 1e-12, 1e-12, 1e-12];
            for (k, ((value, lower), error)) in values.iter().zip(lower).zip(errors).enumerate() {
                let error = if k == 3 { 1e-11 * coulomb } else { error * lower.abs() };
                assert!(
                    *value >= lower || *value >= lower - error,
                    "quantity {k} decreases from {lower:e} at {last:e} to {value:e} at {part:e}"
                );
            }
        }
        previous = Some((part, values));
    }
}

/// Complex stiffness and energy of two amplitudes, the loop step by step, and the equivalent Jenkins and Iwan models.
fn cycle(contact: &Contact, amplitudes: [f64; 2], sliders: Option<u8>) {
    let (limit, slip) = (contact.slip_force, contact.slip_displacement);
    // Energies must be representable.
    let [one, two] =
        amplitudes.map(f64::abs).map(|a| if (1e-40 * slip..=1e20 * slip).contains(&a) { a } else { 0.5 * slip });
    let (amplitude, larger) = (one.min(two), one.max(two));
    let at = |amplitude| contact.complex_stiffness(amplitude).unwrap();
    let (real, imaginary) = (at(amplitude).real(), at(amplitude).imaginary());
    assert!(
        at(larger).real() <= real * (1.0 + 1e-12),
        "K' {real:e} at {amplitude:e}, {:e} at {larger:e}",
        at(larger).real()
    );

    let mut stepper = Stepper::new(contact, 2);
    let [(force, _, first), (back, _, down), (again, _, up)] =
        [amplitude, -amplitude, amplitude].map(|u| stepper.step(u));
    let closed = (back + force).abs() <= 1e-13 * force && (again - force).abs() <= 1e-13 * force;
    assert!(closed, "forces {force:e} {back:e} {again:e}");
    let close = |value: f64, expected: f64| (value - expected).abs() <= 1e-10 * expected;
    let (dissipated, energy) = (down + up, PI * imaginary * amplitude * amplitude);
    // Subnormal energies have too few digits.
    if energy < 1e-280 {
        return;
    }
    assert!(close(dissipated, energy), "dissipated {dissipated:e}, by K'' {energy:e}");
    if amplitude < 0.999 * slip {
        let by_force = contact.dissipated_energy(force).unwrap();
        assert!(close(dissipated, by_force), "dissipated {dissipated:e}, by the force {by_force:e}");
        assert!(close(4.0 * first, dissipated), "dissipated {dissipated:e}, first quarter {first:e}");
    }

    let jenkins = equivalents::jenkins(contact, amplitude).unwrap();
    // The reversal angle of very slender loops is lost to rounding.
    if imaginary > 1e-12 * real && amplitude <= 1e4 * slip {
        let cosine = (1.0 - 2.0 * jenkins.slip_force / (jenkins.stiffness * amplitude)).clamp(-1.0, 1.0);
        let angle = cosine.acos();
        let [a, b] = [angle - angle.sin() * cosine, angle.sin().powi(2)].map(|value| value * jenkins.stiffness / PI);
        // Near 1 and -1 half of the digits of the angle are lost.
        let agrees = (a - real).abs() <= 1e-6 * real && (b - imaginary).abs() <= 1e-6 * (real + imaginary);
        assert!(agrees, "Jenkins element {a:e} {b:e}, contact {real:e} {imaginary:e}");
    }
    if let Some(sliders) = sliders {
        let mut model = 0.0;
        let iwan = equivalents::iwan(contact, usize::from(sliders % 3) + 1, |slider| {
            model += (slider.stiffness * amplitude).min(slider.slip_force);
        });
        let (error, force) = (iwan.unwrap(), contact.curve_at_displacement(amplitude).unwrap().force());
        let bound = error * limit * (1.0 + 1e-5) + 1e-12 * limit;
        assert!((model - force).abs() <= bound, "Iwan model {model:e}, contact {force:e}, bound {bound:e}");
    }
}

/// Bounds of the harmonic force by both rules; by uniform sampling odd symmetry and the definition as steps of two periods.
fn harmonic_force(contact: &Contact, displacement: &[f64], samples: usize, rule: i32) {
    let (limit, n) = (contact.slip_force, displacement.len());
    let harmonics = n / 2;
    let mut workspace = vec![0.0; mslip_harmonic_workspace_length(harmonics, samples, rule)];
    let (length, memory) = (workspace.len(), workspace.as_mut_ptr());
    assert!(unsafe { mslip_harmonic_workspace_init(harmonics, samples, rule, length, memory) } == MSLIP_OK);
    let c_contact = mslip_contact::from(*contact);
    let evaluate = |displacement: &[f64]| {
        let (mut force, mut jacobian, mut dissipated) = (vec![f64::NAN; n], vec![f64::NAN; n * n], f64::NAN);
        let (u, f, j) = (displacement.as_ptr(), force.as_mut_ptr(), jacobian.as_mut_ptr());
        assert!(unsafe { mslip_harmonic_force(&c_contact, memory, u, f, j, &mut dissipated) } == MSLIP_OK);
        (force, jacobian, dissipated)
    };
    let (force, jacobian, dissipated) = evaluate(displacement);
    assert!(force.iter().all(|f| f.abs() <= 2.0 * limit * (1.0 + 1e-13)), "{force:?}");
    assert!(dissipated >= 0.0 && dissipated.is_finite(), "dissipated {dissipated:e}");
    assert!(jacobian.iter().all(|j| j.is_finite()), "{jacobian:?}");

    let largest: f64 = displacement.iter().map(|u| u.abs()).sum();
    if rule == MSLIP_EVENT_DRIVEN || largest > 1e3 * contact.slip_displacement {
        return;
    }
    let (opposite, ..) = evaluate(&displacement.iter().map(|u| -u).collect::<Vec<_>>());
    let (expected, energy) = harmonic_force_by_steps(contact, samples, displacement);
    // Rounding of the displacement, times the stiffness, and of the sums.
    let rounding = 1e-14 * (limit + contact.initial_stiffness * largest) * samples as f64;
    for ((force, opposite), expected) in force.iter().zip(opposite).zip(expected) {
        assert!((force + opposite).abs() <= rounding, "{force:e}, opposite {opposite:e}");
        assert!((force - expected).abs() <= rounding, "{force:e} instead of {expected:e} ± {rounding:e}");
    }
    let rounding = 1e-12 * (contact.slip_energy + limit * largest) * samples as f64;
    assert!((dissipated - energy).abs() <= rounding, "dissipated {dissipated:e} instead of {energy:e}");
}

/// Fourier coefficients of the force and dissipated energy in the second of two periods from the unloaded state.
fn harmonic_force_by_steps(contact: &Contact, samples: usize, displacement: &[f64]) -> (Vec<f64>, f64) {
    let mut stepper = Stepper::new(contact, 2 * samples);
    let (mut force, mut energy) = (vec![0.0; displacement.len()], 0.0);
    for step in 0..2 * samples {
        let basis: Vec<f64> = (0..displacement.len())
            .map(|i| {
                let angle = 2.0 * PI * (i.div_ceil(2) * (step % samples) % samples) as f64 / samples as f64;
                if i % 2 == 0 && i > 0 { angle.sin() } else { angle.cos() }
            })
            .collect();
        let (f, _, dissipated) = stepper.step(basis.iter().zip(displacement).map(|(basis, u)| basis * u).sum());
        if step >= samples {
            energy += dissipated;
            for (i, (force, basis)) in force.iter_mut().zip(basis).enumerate() {
                *force += f * basis * if i == 0 { 1.0 } else { 2.0 } / samples as f64;
            }
        }
    }
    (force, energy)
}

/// A change of units by powers of 2 is exact.
fn units(parameters: &AnyParameters, contact: &Contact, [l, f]: [f64; 2], part: f64) {
    let other = parameters.scaled(l, f);
    // A subnormal flat has fewer digits.
    if let (AnyParameters::Flat(one), AnyParameters::Flat(other)) = (parameters, &other) {
        let flats = [one.flat_half_width, other.flat_half_width];
        if flats.iter().any(|&flat| flat > 0.0) && !flats.iter().all(|flat| flat.is_normal()) {
            return;
        }
    }
    let Ok(scaled) = other.contact() else { return };
    let fields = |c: &Contact, [p, l, f]: [f64; 3]| {
        let at = c.curve_at_displacement(part * c.slip_displacement).unwrap();
        let curve = [at.force() * f, at.stiffness() * (f / l), at.stick_half_width() * l];
        let fields = [c.composite_modulus * p, c.half_width * l, c.slip_force * f, c.slip_displacement * l];
        (fields, c.initial_stiffness * (f / l), c.slip_energy * (f * l), curve)
    };
    assert_eq!(fields(contact, [f / l / l, l, f]), fields(&scaled, [1.0; 3]), "{other:?}");
}
