//! Sequences of calls of every function of the C interface, also with invalid pointers and lengths and with corrupted memory.
//!
//! No call accesses memory outside the given lengths, panics, loops endlessly or modifies an input; a rejected call modifies no
//! output. With valid memory, no call raises an invalid operation, a division by zero or an overflow, results are within their
//! bounds and depend neither on the requested outputs nor on where the new state is stored, and batches agree with single calls.
#![no_main]

use libfuzzer_sys::arbitrary::{self, Arbitrary};
use libfuzzer_sys::fuzz_target;
use microslip::ffi::*;
use microslip_fuzz::calls::{UNTOUCHED, not_negative, run, same, status, untouched};
use microslip_fuzz::{AnyParameters, Choice, Number, Numbers, all};
use std::ffi::CStr;
use std::ptr::{null, null_mut};

const CONTACTS: usize = 4;
const SIZE: usize = size_of::<mslip_contact>() / size_of::<f64>();

#[derive(Arbitrary, Debug)]
struct Input {
    contacts: [Choice; CONTACTS],
    calls: Vec<Call>,
}

/// A call; each function uses some of the arguments.
#[derive(Arbitrary, Debug)]
struct Call {
    function: Function,
    /// The contact and its state.
    contact: u8,
    workspace: u8,
    value: Number,
    values: Vec<Number>,
    fault: Fault,
    /// Bit k is set if output k is not requested.
    omitted: u8,
    index: Option<[i8; 7]>,
    active: Option<u8>,
}

#[derive(Arbitrary, Clone, Copy, Debug)]
enum Function {
    Init(Choice),
    Corrupt(u8, Option<u8>),
    Checks,
    Tractions,
    Slip,
    MonotonicDisplacement,
    MonotonicForce,
    StateInit(u8),
    MasingUpdate,
    MasingPath,
    MasingTractions,
    HysteresisLoop,
    DissipatedEnergy,
    ComplexStiffness,
    /// The table of this contact.
    ComplexStiffnessTabulated(u8),
    JenkinsEquivalent,
    IwanEquivalent,
    WorkspaceInit(u8, u8, i8),
    HarmonicForce,
    BatchComplexStiffness,
    BatchMasingUpdate,
    BatchHarmonicForce,
    Lengths(u64, u64, i32),
}

/// An invalid argument.
#[derive(Arbitrary, Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    /// The same, for as many valid as invalid pointers.
    NoneAgain,
    NullContact,
    NullState,
    NullWorkspace,
    NullInput,
    /// A length beyond the address space.
    Length(u8),
}

#[derive(Clone, Default)]
struct State {
    values: Vec<f64>,
    valid: bool,
    /// Its contact was initialised again since.
    foreign: bool,
}

#[derive(Clone, Default)]
struct Workspace {
    values: Vec<f64>,
    valid: bool,
    coefficients: usize,
}

struct Memory {
    contacts: Vec<f64>,
    valid: [bool; CONTACTS],
    states: [State; CONTACTS],
    workspaces: [Workspace; 2],
    numbers: Numbers,
}

fuzz_target!(|input: Input| {
    let mut memory = Memory {
        contacts: vec![UNTOUCHED; CONTACTS * SIZE],
        valid: [false; CONTACTS],
        states: [(); CONTACTS].map(|()| State::default()),
        workspaces: [(); 2].map(|()| Workspace::default()),
        numbers: Numbers::default(),
    };
    for (slot, choice) in input.contacts.iter().enumerate() {
        memory.init(slot, *choice);
    }
    for slot in 0..CONTACTS {
        memory.state_init(slot, mslip_state_length(4 * slot), Fault::None);
    }
    for rule in [MSLIP_UNIFORM_SAMPLING, MSLIP_EVENT_DRIVEN] {
        memory.workspace_init(rule as usize, [2, 9], rule, Fault::None);
    }
    for call in &input.calls {
        let before = memory.contacts.clone();
        memory.perform(call);
        let changed = matches!(call.function, Function::Init(_) | Function::Corrupt(..));
        assert!(changed || same(&memory.contacts, &before), "a contact was modified");
    }
});

impl Memory {
    fn init(&mut self, slot: usize, choice: Choice) {
        let mut contact = vec![UNTOUCHED; SIZE];
        let pointer = contact.as_mut_ptr().cast::<mslip_contact>();
        let answer = match choice {
            Choice::Listed(_) => {
                let (_, listed) = choice.contact().expect("a listed contact is valid");
                unsafe { pointer.write(listed.into()) };
                MSLIP_OK
            }
            _ => match choice.parameters() {
                AnyParameters::Flat(p) => status(true, || unsafe { mslip_contact_init(&p, pointer) }),
                AnyParameters::Ellipse(p) => status(true, || unsafe { mslip_contact_init_elliptic(&p, pointer) }),
            },
        };
        if answer != MSLIP_OK {
            assert!(untouched(&contact), "a rejected contact has been modified");
            return;
        }
        let c = unsafe { &*pointer };
        assert!(c.composite_modulus > 0.0 && c.composite_modulus.is_finite());
        let fields = [c.half_width, c.slip_force, c.slip_displacement, c.initial_stiffness, c.slip_energy];
        all!(fields, not_negative);
        if c.slip_force > 0.0 {
            // The curve is concave and ends at mu N; the loop lies within its parallelogram.
            all!(fields, |value| value > 0.0);
            assert!(c.slip_force <= c.initial_stiffness * c.slip_displacement * (1.0 + 1e-13), "{fields:?}");
            assert!(c.slip_energy <= 4.0 * c.slip_force * c.slip_displacement, "{fields:?}");
        } else {
            all!(&fields[1..], |value| value == 0.0);
        }
        self.contacts[slot * SIZE..][..SIZE].copy_from_slice(&contact);
        self.valid[slot] = true;
        self.states[slot].foreign = true;
    }

    fn state_init(&mut self, slot: usize, length: usize, fault: Fault) {
        let mut values = vec![UNTOUCHED; length];
        let pointer = if fault == Fault::NullState { null_mut() } else { values.as_mut_ptr() };
        let answer = status(true, || unsafe { mslip_state_init(with_fault(length, fault), pointer) });
        assert!(answer == MSLIP_OK || untouched(&values), "a rejected state has been modified");
        self.states[slot] = State { values, valid: answer == MSLIP_OK, foreign: false };
    }

    fn workspace_init(&mut self, slot: usize, [harmonics, samples]: [usize; 2], rule: i32, fault: Fault) {
        let mut values = vec![UNTOUCHED; mslip_harmonic_workspace_length(harmonics, samples, rule).max(3)];
        let pointer = if fault == Fault::NullWorkspace { null_mut() } else { values.as_mut_ptr() };
        let length = with_fault(values.len(), fault);
        let answer =
            status(true, || unsafe { mslip_harmonic_workspace_init(harmonics, samples, rule, length, pointer) });
        if answer == MSLIP_OK {
            let (mut h, mut s, mut r) = (0, 0, -1);
            let size = unsafe { mslip_harmonic_workspace_size(pointer, &mut h, &mut s, &mut r) };
            assert_eq!((size, h, s, r), (MSLIP_OK, harmonics, samples, rule));
        } else {
            assert!(untouched(&values), "a rejected workspace has been modified");
        }
        self.workspaces[slot] = Workspace { values, valid: answer == MSLIP_OK, coefficients: 2 * harmonics + 1 };
    }

    /// Changes a double, or one of its bits. The header of a longer workspace is not allowed: its length would be another one.
    fn corrupt(&mut self, call: &Call, place: u8, bit: Option<u8>) {
        let number = self.numbers.one(call.value, 1e-6);
        let change = |values: &mut [f64]| {
            if let Some(value) = values.len().checked_sub(1).map(|last| &mut values[place as usize % (last + 1)]) {
                *value = bit.map_or(number, |bit| f64::from_bits(value.to_bits() ^ 1 << (bit % 64)));
            }
        };
        let slot = call.contact as usize % CONTACTS;
        match call.workspace / 2 % 3 {
            0 => {
                self.valid[slot] = false;
                change(&mut self.contacts[slot * SIZE..][..SIZE]);
            }
            1 => {
                let state = &mut self.states[slot];
                state.valid = false;
                change(&mut state.values);
            }
            _ => {
                let Workspace { values, valid, coefficients } = &mut self.workspaces[call.workspace as usize % 2];
                let before = values.clone();
                change(values);
                let header = values.first_chunk().expect("a header");
                if microslip::constant_load::harmonic_force::workspace_extent(header)
                    .is_ok_and(|extent| extent > values.len())
                {
                    *values = before;
                } else {
                    *valid = false;
                    *coefficients =
                        microslip::constant_load::harmonic_force::workspace_size(header).map_or(1, |(h, ..)| 2 * h + 1);
                }
            }
        }
    }

    fn perform(&mut self, call: &Call) {
        let Call { fault, omitted, .. } = *call;
        let (slot, ws) = (call.contact as usize % CONTACTS, call.workspace as usize % 2);
        let own: *const mslip_contact = self.contacts[slot * SIZE..].as_ptr().cast();
        let c = unsafe { &*own };
        let contact = if fault == Fault::NullContact { null() } else { own };
        let limit = c.slip_force;
        let unit = if c.slip_displacement > 0.0 { c.slip_displacement } else { 1e-6 };
        let valid = self.valid[slot];
        let (value_scale, scale) = match call.function {
            Function::Tractions | Function::Slip => (limit, c.half_width),
            Function::MasingTractions => (unit, c.half_width),
            Function::MonotonicDisplacement | Function::DissipatedEnergy => (limit, limit),
            _ => (unit, unit),
        };
        let (value, values) = (self.numbers.one(call.value, value_scale), self.numbers.all(&call.values, scale));
        let (count, n) = (values.len(), with_fault(values.len(), fault));
        let input = |values: &[f64]| if fault == Fault::NullInput { null() } else { values.as_ptr() };
        let x = input(&values);

        let State { values: state, valid: valid_state, foreign } = self.states[slot].clone();
        let (length, valid_history) = (with_fault(state.len(), fault), valid && valid_state);
        let old = if fault == Fault::NullState { null() } else { state.as_ptr() };
        let Workspace { valid: valid_workspace, coefficients: m, .. } = self.workspaces[ws];
        let workspace = match fault {
            Fault::NullWorkspace => null_mut(),
            _ => self.workspaces[ws].values.as_mut_ptr(),
        };
        let coefficients = |items: usize| (0..items * m).map(|i| values.get(i % count.max(1)).copied().unwrap_or(0.0));

        let coulomb = |force: f64| force.abs() <= limit;
        let tangent = |stiffness: f64| (0.0..=c.initial_stiffness * (1.0 + 1e-13)).contains(&stiffness);
        let stick = |half_width: f64| (0.0..=c.half_width * (1.0 + 1e-13)).contains(&half_width);
        let same_sign = |results: &[f64], arguments: &[f64]| {
            let sign = |(result, argument): (&f64, &f64)| result * argument.signum() >= 0.0;
            assert!(results.iter().zip(arguments).all(sign), "{results:?} at {arguments:?}");
        };

        match call.function {
            Function::Init(choice) => self.init(slot, choice),
            Function::Corrupt(place, bit) => self.corrupt(call, place, bit),
            Function::StateInit(length) => {
                let length = length as usize;
                let length = if length < 192 { mslip_state_length(length % 12) } else { length % 16 };
                self.state_init(slot, length, fault);
            }
            Function::WorkspaceInit(harmonics, samples, rule) => {
                let rule = if rule < 120 { i32::from(rule & 1) } else { rule.into() };
                self.workspace_init(ws, [harmonics as usize % 10, samples.into()], rule, fault);
            }
            Function::Checks => {
                let checked = status(true, || unsafe { mslip_contact_check(contact) });
                assert!(!valid || contact.is_null() || checked == MSLIP_OK, "the check rejects a contact");
                let checked = status(true, || unsafe { mslip_state_check(length, old) });
                // Steps of several contacts may leave reversals that are not nested.
                let comparable = valid_history && !foreign && fault == Fault::None;
                assert!(!comparable || checked == MSLIP_OK, "the check rejects {state:?}");
                let error = |[error]: [*mut f64; 1]| unsafe { mslip_state_error(length, old, error) };
                if let Some([error]) = run(valid_state, omitted, [1], error) {
                    all!(error, not_negative);
                }
            }
            Function::Tractions => {
                let tractions = |[p, q]: [*mut f64; 2]| unsafe { mslip_tractions(contact, value, n, x, p, q) };
                if let Some([pressure, shear]) = run(valid, omitted, [count; 2], tractions) {
                    all!(pressure, not_negative);
                    all!(shear, |shear| shear.is_finite() && shear * value >= 0.0);
                }
            }
            Function::Slip => {
                let slip = |[s, d]: [*mut f64; 2]| unsafe { mslip_slip(contact, value, n, x, s, d) };
                if let Some([slip, damage]) = run(valid, omitted, [count; 2], slip) {
                    if value == 0.0 {
                        // Rounding at the edge of the stick zone.
                        all!(slip, |slip| slip.abs() <= 1e-15 * c.slip_displacement);
                    } else {
                        all!(slip, |slip| slip.is_finite() && slip * value >= 0.0);
                    }
                    all!(damage, not_negative);
                }
            }
            Function::MonotonicDisplacement => {
                let curve = |[u, d, s]: [*mut f64; 3]| unsafe { mslip_monotonic_displacement(contact, n, x, u, d, s) };
                if let Some([displacement, compliance, sticks]) = run(valid, omitted, [count; 3], curve) {
                    all!(displacement, |displacement| displacement.abs() <= c.slip_displacement * (1.0 + 1e-13));
                    same_sign(&displacement, &values);
                    let least = if limit > 0.0 { (1.0 - 1e-13) / c.initial_stiffness } else { f64::INFINITY };
                    all!(compliance, |compliance| compliance >= least);
                    all!(sticks, stick);
                }
            }
            Function::MonotonicForce => {
                let curve = |[f, k, s]: [*mut f64; 3]| unsafe { mslip_monotonic_force(contact, n, x, f, k, s) };
                if let Some([force, stiffness, sticks]) = run(valid, omitted, [count; 3], curve) {
                    all!(force, coulomb);
                    same_sign(&force, &values);
                    all!(stiffness, tangent);
                    all!(sticks, stick);
                }
            }
            Function::MasingUpdate | Function::MasingPath => {
                let is_path = matches!(call.function, Function::MasingPath);
                let steps = if is_path { count } else { 1 };
                let step = |old: *const f64, new: *mut f64, [f, k, d]: [*mut f64; 3]| unsafe {
                    if is_path {
                        mslip_masing_path(contact, length, old, n, x, new, f, k, d)
                    } else {
                        mslip_masing_update(contact, length, old, value, new, f, k, d)
                    }
                };
                let before = state.clone();
                let result = run(valid_history, omitted, [state.len(), steps, steps, steps], |[new, f, k, d]| {
                    step(old, new, [f, k, d])
                });
                assert!(same(&state, &before), "the old state was modified");
                // In place.
                let mut in_place = state.clone();
                let repeated = run(valid_history, omitted.rotate_left(3), [steps; 3], |outputs| {
                    in_place.copy_from_slice(&state);
                    let pointer = if old.is_null() { null_mut() } else { in_place.as_mut_ptr() };
                    step(pointer, pointer, outputs)
                });
                if let (Some([new, force, stiffness, dissipated]), Some(repeated)) = (&result, &repeated) {
                    all!(force, coulomb);
                    all!(stiffness, tangent);
                    all!(dissipated, not_negative);
                    assert!(same(&in_place, new), "in place {in_place:?}, elsewhere {new:?}");
                    for (elsewhere, in_place) in [force, stiffness, dissipated].into_iter().zip(repeated) {
                        assert!(same(elsewhere, in_place), "in place {in_place:?}, elsewhere {elsewhere:?}");
                    }
                }
                assert!(result.is_some() == repeated.is_some());
                self.states[slot].values = in_place;
            }
            Function::MasingTractions => {
                let tractions =
                    |[p, q]: [*mut f64; 2]| unsafe { mslip_masing_tractions(contact, length, old, n, x, p, q) };
                if let Some([pressure, shear]) = run(valid_history, omitted, [count; 2], tractions) {
                    all!(pressure, not_negative);
                    all!(shear, f64::is_finite);
                }
            }
            Function::HysteresisLoop => {
                let cycle = |[u, f]: [*mut f64; 2]| unsafe { mslip_hysteresis_loop(contact, value, n, u, f) };
                if let Some([displacement, force]) = run(valid, omitted, [count; 2], cycle) {
                    all!(displacement, |displacement| displacement.abs() <= value);
                    all!(force, coulomb);
                }
            }
            Function::DissipatedEnergy => {
                let energy = |[energy]: [*mut f64; 1]| unsafe { mslip_dissipated_energy(contact, n, x, energy) };
                if let Some([energy]) = run(valid, omitted, [count], energy) {
                    all!(energy, |energy| (0.0..=c.slip_energy * (1.0 + 1e-13)).contains(&energy));
                }
            }
            Function::ComplexStiffness => {
                let stiffness =
                    |[a, b, da, db]: [*mut f64; 4]| unsafe { mslip_complex_stiffness(contact, n, x, a, b, da, db) };
                if let Some([real, imaginary, d_real, d_imag]) = run(valid, omitted, [count; 4], stiffness) {
                    all!(real, tangent);
                    all!(imaginary, tangent);
                    all!(d_real, |slope| slope <= 0.0 && slope.is_finite());
                    all!(d_imag, f64::is_finite);
                }
            }
            Function::ComplexStiffnessTabulated(place) => {
                let of = self.contacts[place as usize % CONTACTS * SIZE..].as_ptr().cast();
                let mut table = vec![UNTOUCHED; mslip_stiffness_table_length()];
                let length = with_fault(table.len(), fault);
                let pointer = if fault == Fault::NullWorkspace { null_mut() } else { table.as_mut_ptr() };
                let made = status(true, || unsafe { mslip_stiffness_table_init(of, length, pointer) });
                assert!(made == MSLIP_OK || untouched(&table), "a rejected table has been modified");
                let tabulated = |[a, b, da, db]: [*mut f64; 4]| unsafe {
                    mslip_complex_stiffness_tabulated(contact, pointer, n, x, a, b, da, db)
                };
                let valid = valid && self.valid[place as usize % CONTACTS] && made == MSLIP_OK;
                if let Some([real, imaginary, d_real, d_imag]) = run(valid, omitted, [count; 4], tabulated) {
                    // Rounding of |K| and of |K|/amplitude.
                    let limit = c.initial_stiffness * (1.0 + 1e-13);
                    all!(real, |k| (0.0..=limit).contains(&k));
                    all!(imaginary, |k| (-1e-13 * limit..=limit).contains(&k));
                    all!(d_real, f64::is_finite);
                    all!(d_imag, f64::is_finite);
                }
            }
            Function::JenkinsEquivalent => {
                let jenkins = |[k, f]: [*mut f64; 2]| unsafe { mslip_jenkins_equivalent(contact, value, k, f) };
                if let Some([stiffness, slip_force]) = run(valid, omitted, [1; 2], jenkins) {
                    all!(stiffness, not_negative);
                    all!(slip_force, not_negative);
                }
            }
            Function::IwanEquivalent => {
                // Each slider costs some 0.3 ms.
                let sliders = count % 4;
                let n = with_fault(sliders, fault);
                let iwan = |[k, f, error]: [*mut f64; 3]| unsafe { mslip_iwan_equivalent(contact, n, k, f, error) };
                if let Some([stiffness, slip_force, error]) = run(valid, omitted, [sliders, sliders, 1], iwan) {
                    all!(stiffness, not_negative);
                    all!(slip_force, not_negative);
                    all!(error, |error| (0.0..=1.0).contains(&error));
                    let sum: f64 = slip_force.iter().sum();
                    assert!((sum - limit).abs() <= 1e-12 * limit, "{sum:e} instead of {limit:e}");
                }
            }
            Function::HarmonicForce => {
                let displacement: Vec<f64> = coefficients(1).collect();
                let harmonic = |[f, j, d]: [*mut f64; 3]| unsafe {
                    mslip_harmonic_force(contact, workspace, input(&displacement), f, j, d)
                };
                if let Some([force, jacobian, dissipated]) =
                    run(valid && valid_workspace, omitted, [m, m * m, 1], harmonic)
                {
                    // A coefficient is at most twice an average of forces.
                    all!(force, |force| force.abs() <= 2.0 * limit * (1.0 + 1e-13));
                    all!(jacobian, f64::is_finite);
                    all!(dissipated, not_negative);
                }
            }
            Function::BatchComplexStiffness => {
                let items = self.items(call, count);
                let (p, index, active) = items.pointers(contact);
                let stiffness = |[a, b, da, db]: [*mut f64; 4]| unsafe {
                    mslip_batch_complex_stiffness(n, items.n_contacts, p, index, active, x, a, b, da, db)
                };
                self.run_items(&items, true, omitted, [1; 4], stiffness, |i, contact, [a, b, da, db]| unsafe {
                    mslip_complex_stiffness(contact, 1, &values[i], a, b, da, db)
                });
            }
            Function::BatchMasingUpdate => {
                let items = self.items(call, count);
                let (p, index, active) = items.pointers(contact);
                let mut states = state.repeat(count);
                let update = |old: *const f64, new: *mut f64, [f, k, d]: [*mut f64; 3]| unsafe {
                    let nc = items.n_contacts;
                    mslip_batch_masing_update(n, nc, p, index, active, state.len(), old, x, new, f, k, d)
                };
                let old = if old.is_null() { null() } else { states.as_ptr() };
                let elsewhere = |[new, f, k, d]: [*mut f64; 4]| update(old, new, [f, k, d]);
                let widths = [state.len(), 1, 1, 1];
                let result = self.run_items(
                    &items,
                    valid_state,
                    omitted,
                    widths,
                    elsewhere,
                    |i, contact, [new, f, k, d]| unsafe {
                        mslip_masing_update(contact, state.len(), state.as_ptr(), values[i], new, f, k, d)
                    },
                );
                assert!(same(&states, &state.repeat(count)), "an old state was modified");
                if let Some([new, ..]) = result {
                    let pointer = states.as_mut_ptr();
                    assert!(status(true, || update(pointer, pointer, [null_mut(); 3])) == MSLIP_OK);
                    for ((slot, in_place), new) in
                        items.slots.iter().zip(states.chunks(state.len())).zip(new.chunks(state.len()))
                    {
                        assert!(
                            same(in_place, if slot.is_some() { new } else { &state }),
                            "in place {in_place:?}, elsewhere {new:?}"
                        );
                    }
                }
            }
            Function::BatchHarmonicForce => {
                let items = self.items(call, count % 5);
                let (p, index, active) = items.pointers(contact);
                let displacement: Vec<f64> = coefficients(items.slots.len()).collect();
                let n = with_fault(items.slots.len(), fault);
                let force = |[f, j, d]: [*mut f64; 3]| unsafe {
                    let (nc, u) = (items.n_contacts, input(&displacement));
                    mslip_batch_harmonic_force(n, nc, p, index, active, workspace, u, f, j, d)
                };
                self.run_items(
                    &items,
                    valid_workspace,
                    omitted,
                    [m, m * m, 1],
                    force,
                    |i, contact, [f, j, d]| unsafe {
                        mslip_harmonic_force(contact, workspace, displacement[i * m..].as_ptr(), f, j, d)
                    },
                );
            }
            Function::Lengths(harmonics, samples, code) => {
                let [harmonics, samples] = [harmonics, samples].map(|value| (value >> (value % 64)) as usize);
                assert!(mslip_state_length(harmonics) >= mslip_state_length(0));
                let length = mslip_harmonic_workspace_length(harmonics, samples, code % 3);
                assert!(length == 0 || (harmonics > 0 && samples / 2 >= harmonics));
                assert!(!unsafe { CStr::from_ptr(mslip_status_text(code)) }.is_empty());
            }
        }
    }

    fn items(&self, call: &Call, n: usize) -> Items {
        let slot = |i: i8| if i.unsigned_abs() < 120 { i32::from(i).rem_euclid(4) } else { i32::from(i) / 30 };
        let index = call.index.map(|index| (0..n).map(|i| slot(index[i % 7])).collect());
        let active =
            call.active.map(|flags| (0..n).map(|i| i32::from(flags >> (i % 8) & 1) * i32::from(flags)).collect());
        let contact = |i: usize| index.as_ref().map_or(i, |index: &Vec<i32>| index[i] as usize);
        let is_active = |i: usize| active.as_ref().is_none_or(|active: &Vec<i32>| active[i] != 0);
        let slots = (0..n).map(|i| is_active(i).then(|| contact(i))).collect();
        // Indices beyond the contacts, rarely.
        let n_contacts = if call.omitted < 0xf0 { CONTACTS } else { call.omitted as usize % CONTACTS };
        Items { n_contacts, index, active, slots, contacts: self.contacts.as_ptr().cast() }
    }

    /// As [`run`], for a batch: each item gives the results of a single call, and skipped items are not written.
    fn run_items<const K: usize>(
        &self,
        items: &Items,
        valid: bool,
        omitted: u8,
        widths: [usize; K],
        batch: impl FnMut([*mut f64; K]) -> i32,
        single: impl Fn(usize, *const mslip_contact, [*mut f64; K]) -> i32,
    ) -> Option<[Vec<f64>; K]> {
        let valid = valid && items.slots.iter().flatten().all(|&slot| self.valid.get(slot).is_none_or(|valid| *valid));
        let outputs = run(valid, omitted, widths.map(|width| items.slots.len() * width), batch)?;
        for (i, slot) in items.slots.iter().enumerate() {
            let mut expected = widths.map(|width| vec![UNTOUCHED; width]);
            if let Some(slot) = slot {
                let contact = self.contacts[slot * SIZE..].as_ptr().cast();
                assert!(status(true, || single(i, contact, expected.each_mut().map(Vec::as_mut_ptr))) == MSLIP_OK);
            }
            for ((output, expected), width) in outputs.iter().zip(&expected).zip(widths) {
                let part = &output[i * width..][..width];
                assert!(same(part, expected), "item {i} of {:?} is {part:?} instead of {expected:?}", items.slots);
            }
        }
        Some(outputs)
    }
}

/// Items of a batch; `slots` are the contacts of the active ones.
struct Items {
    n_contacts: usize,
    contacts: *const mslip_contact,
    index: Option<Vec<i32>>,
    active: Option<Vec<i32>>,
    slots: Vec<Option<usize>>,
}

impl Items {
    /// The arguments contacts, index and active; the first is NULL with the contact of the call.
    fn pointers(&self, contact: *const mslip_contact) -> (*const mslip_contact, *const i32, *const i32) {
        let pointer = |flags: &Option<Vec<i32>>| flags.as_ref().map_or(null(), |flags| flags.as_ptr());
        (if contact.is_null() { null() } else { self.contacts }, pointer(&self.index), pointer(&self.active))
    }
}

/// A length, or one beyond the address space.
fn with_fault(length: usize, fault: Fault) -> usize {
    match fault {
        Fault::Length(choice) => [usize::MAX, isize::MAX as usize, isize::MAX as usize / 8 + 1][choice as usize % 3],
        _ => length,
    }
}
