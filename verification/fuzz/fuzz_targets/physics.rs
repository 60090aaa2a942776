//! An input is a contact and a history, an amplitude, or forces: properties of every contact, and agreement of all functions.
#![no_main]

use libfuzzer_sys::{Corpus, fuzz_target};
use microslip::ffi::*;
use microslip_fuzz::contacts::{self, Bits, Given};
use microslip_fuzz::interface::{self, status};
use microslip_fuzz::memory::same;
use microslip_fuzz::source::{Scatter, Source};
use microslip_fuzz::tell;
use std::f64::consts::PI;

fuzz_target!(init: interface::start(), |input: &[u8]| -> Corpus {
    let mut source = Source::new(input);
    let what = source.byte();
    let Some((given, bits)) = choose(&mut source) else { return Corpus::Reject };
    tell!("{given:?}");
    let contact = Contact(&bits);
    if contact.slip_force() <= 0.0 {
        return Corpus::Reject;
    }
    match what % 16 {
        0..8 => history(&contact, &mut source),
        8..11 => curve(&contact, &mut source),
        11..13 => cycle(&contact, &mut source),
        13..15 => harmonics(&contact, &mut source),
        _ => units(&given, &contact, &mut source),
    }
    Corpus::Keep
});

/// A contact of the collection, or one of its own.
fn choose(source: &mut Source) -> Option<(Given, Bits)> {
    match source.byte() {
        choice if choice < 160 => {
            let all = contacts::all();
            Some(all[choice as usize % all.len()])
        }
        choice => {
            let given = match choice % 3 {
                0 => Given::Ellipse(contacts::draw_ellipse(source)),
                _ => Given::Flat(contacts::draw_flat(source)),
            };
            Some((given, given.prepare().ok()?))
        }
    }
}

/// The calls that are made of one contact: all of them are allowed.
struct Contact<'a>(&'a Bits);

/// Force, tangent stiffness, and energy of a step.
type Step = (f64, f64, f64);

fn ok(name: &str, call: impl FnOnce() -> i32) {
    let answer = status(name, true, call);
    assert!(answer == 0, "{name} answers {answer}");
}

impl Contact<'_> {
    fn pointer(&self) -> *const mslip_contact {
        self.0.as_ptr().cast()
    }

    fn half_width(&self) -> f64 {
        self.0[1]
    }

    fn slip_force(&self) -> f64 {
        self.0[2]
    }

    fn slip_displacement(&self) -> f64 {
        self.0[3]
    }

    fn initial_stiffness(&self) -> f64 {
        self.0[4]
    }

    fn slip_energy(&self) -> f64 {
        self.0[5]
    }

    fn step(&self, state: &mut [f64], displacement: f64) -> Step {
        let (mut force, mut stiffness, mut dissipated) = (f64::NAN, f64::NAN, f64::NAN);
        let (length, at) = (state.len(), state.as_mut_ptr());
        ok("mslip_masing_update", || unsafe {
            mslip_masing_update(
                self.pointer(),
                length,
                at,
                displacement,
                at,
                &mut force,
                &mut stiffness,
                &mut dissipated,
            )
        });
        (force, stiffness, dissipated)
    }

    /// Displacement, compliance and stick half-width.
    fn at_force(&self, force: f64) -> (f64, f64, f64) {
        let (mut displacement, mut compliance, mut stick) = (f64::NAN, f64::NAN, f64::NAN);
        ok("mslip_monotonic_displacement", || unsafe {
            mslip_monotonic_displacement(self.pointer(), 1, &force, &mut displacement, &mut compliance, &mut stick)
        });
        (displacement, compliance, stick)
    }

    /// Force, stiffness and stick half-width.
    fn at_displacement(&self, displacement: f64) -> (f64, f64, f64) {
        let (mut force, mut stiffness, mut stick) = (f64::NAN, f64::NAN, f64::NAN);
        ok("mslip_monotonic_force", || unsafe {
            mslip_monotonic_force(self.pointer(), 1, &displacement, &mut force, &mut stiffness, &mut stick)
        });
        (force, stiffness, stick)
    }

    fn energy(&self, amplitude: f64) -> f64 {
        let mut energy = f64::NAN;
        ok("mslip_dissipated_energy", || unsafe {
            mslip_dissipated_energy(self.pointer(), 1, &amplitude, &mut energy)
        });
        energy
    }

    fn complex_stiffness(&self, amplitude: f64) -> [f64; 4] {
        let mut k = [f64::NAN; 4];
        let [a, b, da, db] = &mut k;
        ok("mslip_complex_stiffness", || unsafe {
            mslip_complex_stiffness(self.pointer(), 1, &amplitude, a, b, da, db)
        });
        k
    }

    fn tractions(&self, force: f64, x: f64) -> (f64, f64) {
        let (mut pressure, mut shear) = (f64::NAN, f64::NAN);
        ok("mslip_tractions", || unsafe { mslip_tractions(self.pointer(), force, 1, &x, &mut pressure, &mut shear) });
        (pressure, shear)
    }

    /// A displacement that is allowed.
    fn draw(&self, source: &mut Source) -> f64 {
        let slip = self.slip_displacement();
        let number = source.number(slip);
        if number.abs() <= 1e150 { number } else { slip }
    }

    /// A part of gross slip, of its force or of its displacement: so large that no product has lost digits to underflow.
    fn draw_part(source: &mut Source) -> f64 {
        let part = source.number(1.0).abs();
        let part = if part <= 1.0 { part } else { 1.0 / part };
        if part >= 1e-100 { part } else { 0.0 }
    }
}

fn unloaded(reversals: usize) -> Vec<f64> {
    let mut state = vec![f64::NAN; mslip_state_length(reversals)];
    let length = state.len();
    ok("mslip_state_init", || unsafe { mslip_state_init(length, state.as_mut_ptr()) });
    state
}

/// The part of a state that is in use.
fn used(state: &[f64]) -> &[f64] {
    &state[..microslip_fuzz::memory::used_length(state)]
}

/// Bound on the error of the force by merged reversals.
fn state_error(state: &[f64]) -> f64 {
    let mut error = f64::NAN;
    ok("mslip_state_error", || unsafe { mslip_state_error(state.len(), state.as_ptr(), &mut error) });
    error
}

fn check_state(state: &[f64]) {
    ok("mslip_state_check", || unsafe { mslip_state_check(state.len(), state.as_ptr()) });
}

/// A history of steps, its mirror image, its parts, the same in one call, and in a state of few reversals.
fn history(contact: &Contact, source: &mut Source) {
    let parts = source.below(4) + 1;
    let inner = (source.byte() as f64 + 0.5) / 256.0;
    let (more, width) = (4 * source.byte() as usize, contact.draw(source));
    let mut scatter = Scatter::new(source, width);
    let mut path = Vec::new();
    while !source.is_empty() && path.len() < 64 {
        path.push(contact.draw(source));
    }
    for _ in 0..more {
        path.push(scatter.next(&path));
    }
    tell!("{path:?}");
    let room = path.len() + 2;
    let [mut whole, mut mirrored, mut divided, mut at_once] = [(); 4].map(|()| unloaded(room));
    let mut short = unloaded(2 + path.len() % 7);
    let (limit, first) = (contact.slip_force(), contact.initial_stiffness());
    let mut steps = Vec::new();
    let (mut before, mut last) = (0.0, 0.0);
    let farthest = path.iter().fold(0.0_f64, |farthest, displacement| farthest.max(displacement.abs()));
    for &displacement in &path {
        let (force, stiffness, energy) = contact.step(&mut whole, displacement);
        assert!(force.abs() <= limit, "{force:e} beyond {limit:e}");
        assert!(stiffness >= 0.0 && stiffness <= first * (1.0 + 1e-15), "{stiffness:e} beyond {first:e}");
        assert!(energy >= 0.0 && energy.is_finite(), "{energy:e} dissipated");
        steps.push((force, stiffness, energy));

        assert!(contact.step(&mut mirrored, -displacement) == (-force, stiffness, energy), "the mirror image differs");

        let (merged, ..) = contact.step(&mut short, displacement);
        let error = state_error(&short);
        assert!(state_error(&whole) == 0.0 && (error > 0.0 || merged == force), "{merged:e} instead of {force:e}");
        // Displacements far from the origin round the ranges of their branches.
        let rounding = 4e-15 * limit + 4.0 * f64::EPSILON * farthest * first;
        assert!((merged - force).abs() <= error + rounding, "{merged:e} instead of {force:e}, reported {error:e}");
        check_state(&short);

        // A step of zero changes nothing.
        let state = whole.clone();
        assert!(
            contact.step(&mut whole, displacement) == (force, stiffness, 0.0),
            "a step of zero gives something else"
        );
        assert!(same(&whole, &state), "a step of zero changes the state");

        let mut sum = 0.0;
        for part in 1..parts {
            let between = last + (displacement - last) * (part as f64 / parts as f64);
            let between = between.max(last.min(displacement)).min(last.max(displacement));
            sum += contact.step(&mut divided, between).2;
        }
        let end = contact.step(&mut divided, displacement);
        assert!((end.0, end.1) == (force, stiffness), "in parts {end:?}, in one {force:e}, {stiffness:e}");
        assert!(
            used(&divided) == used(&whole),
            "in parts the state is {:?}, in one {:?}",
            used(&divided),
            used(&whole)
        );
        // A sum of differences of energies, each to the accuracy of the loops that it is part of.
        let scale = limit * (contact.slip_displacement() + (displacement - last).abs());
        assert!((sum + end.2 - energy).abs() <= 1e-12 * scale, "in parts {:e}, in one {energy:e}", sum + end.2);
        if displacement != last {
            (before, last) = (last, displacement);
        }
    }

    let n = path.len();
    let mut outputs = [vec![0.0; n], vec![0.0; n], vec![0.0; n]];
    let ([force, stiffness, dissipated], state) =
        (outputs.each_mut().map(|output| output.as_mut_ptr()), at_once.as_mut_ptr());
    ok("mslip_masing_path", || unsafe {
        mslip_masing_path(
            contact.pointer(),
            at_once.len(),
            state,
            n,
            path.as_ptr(),
            state,
            force,
            stiffness,
            dissipated,
        )
    });
    for (i, &(force, stiffness, energy)) in steps.iter().enumerate() {
        assert!(
            (outputs[0][i], outputs[1][i], outputs[2][i]) == (force, stiffness, energy),
            "step {i} differs at once"
        );
    }
    assert!(same(used(&at_once), used(&whole)), "at once the state is another");

    // An inner loop is closed and erased.
    if let Some(&(force, stiffness, _)) = steps.last() {
        let state = whole.clone();
        let between = last + inner * (before - last);
        contact.step(&mut whole, between);
        let (again, tangent, _) = contact.step(&mut whole, last);
        assert!((again - force).abs() <= 1e-13 * limit, "after a loop {again:e} instead of {force:e}");
        // In gross slip the offset of the initial loading curve moves back and forth.
        if force.abs() < limit && between != before {
            assert!(again == force && tangent == stiffness, "after a loop {tangent:e} instead of {stiffness:e}");
            assert!(used(&whole) == used(&state), "a closed loop is not erased");
        }
    }
}

/// Points of the monotonic curve, in order.
fn curve(contact: &Contact, source: &mut Source) {
    let (limit, slip) = (contact.slip_force(), contact.slip_displacement());
    let mut parts: Vec<f64> = (0..6).map(|_| Contact::draw_part(source)).chain([0.0, 1.0]).collect();
    parts.sort_by(f64::total_cmp);
    let x = contact.half_width() * source.number(1.0).clamp(-2.0, 2.0);
    let x = if x.is_nan() { 0.0 } else { x };
    tell!("{parts:?} x {x:e}");
    let everywhere = contact.tractions(limit, x);
    let mut before: Option<(f64, [f64; 5], [f64; 3])> = None;
    for part in parts {
        let force = part * limit;
        let (displacement, compliance, stick) = contact.at_force(force);
        let energy = contact.energy(force);
        let (pressure, shear) = contact.tractions(force, x);
        // Coulomb's law, to the accuracy of both tractions.
        assert!(pressure == everywhere.0 && shear <= everywhere.1 * (1.0 + 1e-11), "{shear:e} {:e}", everywhere.1);
        let (back, stiffness, _) = contact.at_displacement(displacement);
        // A few units of the displacement and of the force, which the curve's slope makes no more of.
        assert!((back - force).abs() <= 1e-13 * force, "{force:e} comes back as {back:e}");
        if part < 0.99 {
            assert!((stiffness * compliance - 1.0).abs() <= 1e-10, "stiffness {stiffness:e} compliance {compliance:e}");
        }
        let way = part * slip;
        let (mut at_way, stiffness_at_way, stick_at_way) = contact.at_displacement(way);
        if way == slip {
            at_way = limit;
        }
        if let Some((last, [d, c, s, e, q], [f, k, w])) = before {
            // Neighbours may change places within their errors.
            let order = if part > last * (1.0 + 1e-14) { 1e-13 } else { 1e-12 };
            assert!(
                displacement >= d * (1.0 - order) && energy >= e * (1.0 - order),
                "{displacement:e} {d:e}, {energy:e} {e:e}"
            );
            assert!(
                compliance >= c * (1.0 - 1e-12) && stick <= s * (1.0 + 1e-12),
                "{compliance:e} {c:e}, {stick:e} {s:e}"
            );
            assert!(shear >= q - 1e-11 * everywhere.1, "{shear:e} {q:e}");
            assert!(at_way >= f * (1.0 - order), "{at_way:e} {f:e}");
            assert!(stiffness_at_way <= k * (1.0 + 1e-12), "{stiffness_at_way:e} {k:e}");
            assert!(stick_at_way <= w * (1.0 + 1e-12), "{stick_at_way:e} {w:e}");
        }
        before =
            Some((part, [displacement, compliance, stick, energy, shear], [at_way, stiffness_at_way, stick_at_way]));
    }
}

/// Cycles of two amplitudes, and spring-sliders.
fn cycle(contact: &Contact, source: &mut Source) {
    let (limit, slip) = (contact.slip_force(), contact.slip_displacement());
    let [one, two] = [(); 2].map(|()| {
        let amplitude = contact.draw(source).abs();
        // Where energies are representable.
        if amplitude >= 1e-40 * slip && amplitude <= 1e20 * slip { amplitude } else { 0.5 * slip }
    });
    let (small, large) = (one.min(two), one.max(two));
    tell!("{small:e} {large:e}");
    let [(real, imaginary), (weaker, _)] = [small, large].map(|amplitude| {
        let [real, imaginary, ..] = contact.complex_stiffness(amplitude);
        (real, imaginary)
    });
    assert!(weaker <= real * (1.0 + 1e-12), "K' {real:e} at {small:e}, {weaker:e} at {large:e}");

    // Once around the loop.
    let mut state = unloaded(2);
    let (force, _, up) = contact.step(&mut state, small);
    let (back, _, down) = contact.step(&mut state, -small);
    let (again, _, forth) = contact.step(&mut state, small);
    assert!(
        (back + force).abs() <= 1e-13 * force && (again - force).abs() <= 1e-13 * force,
        "{force:e} {back:e} {again:e}"
    );
    let around = down + forth;
    let energy = PI * imaginary * small * small;
    // What is not, or hardly, a normal number has no digits to be compared.
    if energy < 1e-280 {
        return;
    }
    assert!((around - energy).abs() <= 1e-10 * energy, "around {around:e}, by K'' {energy:e}");
    if small < 0.999 * slip {
        let by_force = contact.energy(force);
        // By the force, whose rounding counts for more the nearer gross slip is.
        assert!((around - by_force).abs() <= 1e-10 * by_force, "around {around:e}, by the force {by_force:e}");
        assert!((4.0 * up - around).abs() <= 1e-10 * around, "first {up:e}, around {around:e}");
    }

    let (mut stiffness, mut slider) = (f64::NAN, f64::NAN);
    ok("mslip_jenkins_equivalent", || unsafe {
        mslip_jenkins_equivalent(contact.pointer(), small, &mut stiffness, &mut slider)
    });
    // Loops so slender that the angle at which they slip is lost are springs.
    if imaginary > 1e-12 * real && small <= 1e4 * slip {
        let cosine = (1.0 - 2.0 * slider / (stiffness * small)).clamp(-1.0, 1.0);
        let angle = cosine.acos();
        let [a, b] = [angle - angle.sin() * cosine, angle.sin() * angle.sin()].map(|value| value * stiffness / PI);
        // The cosine near 1 or -1 has lost half its digits.
        assert!(
            (a - real).abs() <= 1e-6 * real && (b - imaginary).abs() <= 1e-6 * (real + imaginary),
            "{a:e} {real:e}, {b:e} {imaginary:e}"
        );
    }

    if source.below(8) == 0 {
        let n = source.below(3) + 1;
        let (mut stiffness, mut limits, mut error) = ([f64::NAN; 3], [f64::NAN; 3], f64::NAN);
        ok("mslip_iwan_equivalent", || unsafe {
            mslip_iwan_equivalent(contact.pointer(), n, stiffness.as_mut_ptr(), limits.as_mut_ptr(), &mut error)
        });
        let bank: f64 = (0..n).map(|i| (stiffness[i] * small).min(limits[i])).sum();
        let (force, ..) = contact.at_displacement(small);
        assert!(
            (bank - force).abs() <= error * limit * (1.0 + 1e-5) + 1e-12 * limit,
            "{bank:e} {force:e}, error {error:e}"
        );
    }
}

/// The harmonic force of both rules; for uniform sampling odd, and by its definition.
fn harmonics(contact: &Contact, source: &mut Source) {
    let (limit, slip) = (contact.slip_force(), contact.slip_displacement());
    let harmonics = source.below(4) + 1;
    let samples = 2 * harmonics + 1 + source.below(32);
    let rule = (source.byte() % 2) as i32;
    let n = 2 * harmonics + 1;
    let displacement: Vec<f64> = (0..n).map(|_| contact.draw(source)).collect();
    tell!("{harmonics} harmonics, {samples} samples, rule {rule}: {displacement:?}");
    let mut workspace = vec![0.0; mslip_harmonic_workspace_length(harmonics, samples, rule)];
    ok("mslip_harmonic_workspace_init", || unsafe {
        mslip_harmonic_workspace_init(harmonics, samples, rule, workspace.len(), workspace.as_mut_ptr())
    });
    let mut of = |displacement: &[f64]| {
        let (mut force, mut jacobian, mut dissipated) = (vec![f64::NAN; n], vec![f64::NAN; n * n], f64::NAN);
        let (f, j) = (force.as_mut_ptr(), jacobian.as_mut_ptr());
        ok("mslip_harmonic_force", || unsafe {
            mslip_harmonic_force(
                contact.pointer(),
                workspace.as_mut_ptr(),
                displacement.as_ptr(),
                f,
                j,
                &mut dissipated,
            )
        });
        (force, jacobian, dissipated)
    };
    let (force, jacobian, dissipated) = of(&displacement);
    assert!(force.iter().all(|f| f.abs() <= 2.0 * limit * (1.0 + 1e-13)), "{force:?}");
    assert!(
        dissipated >= 0.0 && dissipated.is_finite() && jacobian.iter().all(|j| j.is_finite()),
        "{dissipated:e} {jacobian:?}"
    );
    let opposite: Vec<f64> = displacement.iter().map(|u| -u).collect();
    let (minus, ..) = of(&opposite);
    let largest: f64 = displacement.iter().map(|u| u.abs()).sum();
    if rule == MSLIP_UNIFORM_SAMPLING && largest <= 1e3 * slip {
        // Rounding of the waves, by the stiffness, and of the sums.
        let rounding = 1e-14 * (limit + contact.initial_stiffness() * largest) * samples as f64;
        for (plus, minus) in force.iter().zip(&minus) {
            assert!((plus + minus).abs() <= rounding, "{plus:e} {minus:e}");
        }
        let (by_definition, energy) = stepped(contact, harmonics, samples, &displacement);
        for (force, expected) in force.iter().zip(by_definition) {
            assert!((force - expected).abs() <= rounding, "{force:e}, by definition {expected:e} ± {rounding:e}");
        }
        let rounding = 1e-12 * (contact.slip_energy() + limit * largest) * samples as f64;
        assert!((dissipated - energy).abs() <= rounding, "dissipated {dissipated:e}, by definition {energy:e}");
    }
}

/// The second of two periods from the unloaded state, step by step.
fn stepped(contact: &Contact, harmonics: usize, samples: usize, displacement: &[f64]) -> (Vec<f64>, f64) {
    let mut state = unloaded(2 * samples);
    let (mut force, mut energy) = (vec![0.0; 2 * harmonics + 1], 0.0);
    let wave = |order: usize, sample: usize| {
        let angle = 2.0 * PI * ((order * sample) % samples) as f64 / samples as f64;
        (angle.cos(), angle.sin())
    };
    for step in 0..2 * samples {
        let sample = step % samples;
        let waves = (1..=harmonics).map(|order| {
            let (cosine, sine) = wave(order, sample);
            displacement[2 * order - 1] * cosine + displacement[2 * order] * sine
        });
        let (f, _, dissipated) = contact.step(&mut state, displacement[0] + waves.sum::<f64>());
        if step < samples {
            continue;
        }
        energy += dissipated;
        force[0] += f / samples as f64;
        for order in 1..=harmonics {
            let (cosine, sine) = wave(order, sample);
            force[2 * order - 1] += 2.0 * f * cosine / samples as f64;
            force[2 * order] += 2.0 * f * sine / samples as f64;
        }
    }
    (force, energy)
}

/// Units that are powers of 2 change no bit.
fn units(given: &Given, contact: &Contact, source: &mut Source) {
    let [l, f] = [(); 2].map(|()| 2f64.powi(source.byte() as i8 as i32 / 2));
    let other = given.scaled(l, f);
    tell!("length {l:e} force {f:e} {other:?}");
    // A flat that is subnormal in one of both has as many digits as the unit leaves it, or none.
    if let (Given::Flat(one), Given::Flat(other)) = (given, &other) {
        let flats = [one.flat_half_width, other.flat_half_width];
        if flats.iter().any(|&flat| flat > 0.0) && !flats.iter().all(|flat| flat.is_normal()) {
            return;
        }
    }
    // Out of range in one of both, or with numbers that are not normal.
    let Ok(bits) = other.prepare() else { return };
    let scaled = Contact(&bits);
    let expected = [f / l / l, l, f, l, f / l, f * l];
    for (i, (unit, one)) in expected.iter().zip(contact.0).enumerate() {
        assert!(one * unit == bits[i], "field {i}: {:e} instead of {:e}", bits[i], one * unit);
    }
    let part = Contact::draw_part(source);
    let displacement = part * contact.slip_displacement();
    let ((a, b, c), (x, y, z)) = (contact.at_displacement(displacement), scaled.at_displacement(displacement * l));
    assert!((a * f, b * f / l, c * l) == (x, y, z), "{a:e} {b:e} {c:e} and {x:e} {y:e} {z:e}");
}
