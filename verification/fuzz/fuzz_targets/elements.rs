//! Sequences of calls of the element functions of the C interface, also with invalid pointers and lengths and with corrupted memory.
//!
//! The same holds as for the target `calls`. With valid memory the forces satisfy Coulomb's law and the normal law, no energy is
//! negative, a path gives the results of its steps and a batch those of single calls.
#![no_main]

use libfuzzer_sys::arbitrary::{self, Arbitrary};
use libfuzzer_sys::fuzz_target;
use microslip::ffi::*;
use microslip_fuzz::calls::{UNTOUCHED, not_negative, run, same, status, untouched};
use microslip_fuzz::{AnyParameters, Choice, Number, Numbers, all};
use std::ptr::{null, null_mut};

const ELEMENTS: usize = 3;
const SIZE: usize = size_of::<mslip_element>() / size_of::<f64>();

#[derive(Arbitrary, Debug)]
struct Input {
    elements: [(Choice, bool); ELEMENTS],
    calls: Vec<Call>,
}

/// A call; each function uses some of the arguments.
#[derive(Arbitrary, Debug)]
struct Call {
    function: Function,
    /// The element and its state.
    element: u8,
    values: Vec<Number>,
    fault: Fault,
    /// Bit k is set if output k is not requested.
    omitted: u8,
    index: Option<[i8; 5]>,
    active: Option<u8>,
}

#[derive(Arbitrary, Clone, Copy, Debug)]
enum Function {
    Init(Choice, i8, i8),
    Corrupt(u16, Option<u8>),
    Checks,
    NormalForce,
    NormalApproach,
    StateInit(i8, u8),
    Update,
    Path,
    Tractions,
    WorkspaceInit(i8, u8, u8, i8),
    HarmonicForce,
    BatchUpdate,
    BatchHarmonicForce,
    Lengths(i32, u64, u64, i32),
}

/// An invalid argument.
#[derive(Arbitrary, Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    /// The same, for as many valid as invalid pointers.
    NoneAgain,
    NullElement,
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
    /// Its element was initialised again since.
    foreign: bool,
}

struct Memory {
    elements: Vec<f64>,
    valid: [bool; ELEMENTS],
    states: [State; ELEMENTS],
    workspace: Vec<f64>,
    valid_workspace: bool,
    /// 2H+1 of the workspace.
    coefficients: usize,
    numbers: Numbers,
}

fuzz_target!(|input: Input| {
    let mut memory = Memory {
        elements: vec![UNTOUCHED; ELEMENTS * SIZE],
        valid: [false; ELEMENTS],
        states: [(); ELEMENTS].map(|()| State::default()),
        workspace: Vec::new(),
        valid_workspace: false,
        coefficients: 0,
        numbers: Numbers::default(),
    };
    for (slot, (choice, by_force)) in input.elements.iter().enumerate() {
        memory.init(slot, *choice, 1, i32::from(*by_force));
        memory.state_init(slot, 1, mslip_element_state_length(1, 4 + 3 * slot), Fault::None);
    }
    memory.workspace_init([1, MSLIP_UNIFORM_SAMPLING], [2, 9], Fault::None);
    for call in &input.calls {
        let before = memory.elements.clone();
        memory.perform(call);
        let changed = matches!(call.function, Function::Init(..) | Function::Corrupt(..));
        assert!(changed || same(&memory.elements, &before), "an element was modified");
    }
});

/// A small code is valid.
fn code(value: i8) -> i32 {
    if value < 100 { i32::from(value & 1) } else { value.into() }
}

/// The values in use: a header of 8 doubles, whose first holds the number of knots in its last 40 bits, and 4 for each.
fn used(state: &[f64]) -> &[f64] {
    let knots = (state[0].to_bits() & 0xff_ffff_ffff) as usize;
    state.get(..8 + 4 * knots).unwrap_or(state)
}

impl Memory {
    fn init(&mut self, slot: usize, choice: Choice, directions: i32, normal_input: i32) {
        let mut element = vec![UNTOUCHED; SIZE];
        let pointer = element.as_mut_ptr().cast::<mslip_element>();
        let answer = match choice.parameters() {
            AnyParameters::Flat(p) => {
                status(true, || unsafe { mslip_element_init(&p, directions, normal_input, pointer) })
            }
            AnyParameters::Ellipse(p) => {
                status(true, || unsafe { mslip_element_init_elliptic(&p, directions, normal_input, pointer) })
            }
        };
        if answer != MSLIP_OK {
            assert!(untouched(&element), "a rejected element has been modified");
            return;
        }
        let e = unsafe { &*pointer };
        let fields =
            [e.composite_modulus, e.normal_force, e.half_width, e.approach, e.normal_stiffness, e.tangential_stiffness];
        all!(fields, |value| value > 0.0 && value.is_finite());
        assert!(not_negative(e.friction_coefficient) && (e.directions, e.normal_input) == (1, normal_input));
        self.elements[slot * SIZE..][..SIZE].copy_from_slice(&element);
        self.valid[slot] = true;
        self.states[slot].foreign = true;
    }

    fn state_init(&mut self, slot: usize, directions: i32, length: usize, fault: Fault) {
        let mut values = vec![UNTOUCHED; length];
        let pointer = if fault == Fault::NullState { null_mut() } else { values.as_mut_ptr() };
        let answer =
            status(true, || unsafe { mslip_element_state_init(directions, with_fault(length, fault), pointer) });
        assert!(answer == MSLIP_OK || untouched(&values), "a rejected state has been modified");
        self.states[slot] = State { values, valid: answer == MSLIP_OK, foreign: false };
    }

    fn workspace_init(&mut self, [directions, rule]: [i32; 2], [harmonics, samples]: [usize; 2], fault: Fault) {
        let length = mslip_element_workspace_length(directions, harmonics, samples, rule).max(2);
        let mut values = vec![UNTOUCHED; length];
        let pointer = if fault == Fault::NullWorkspace { null_mut() } else { values.as_mut_ptr() };
        let n = with_fault(length, fault);
        let answer =
            status(true, || unsafe { mslip_element_workspace_init(directions, harmonics, samples, rule, n, pointer) });
        if answer == MSLIP_OK {
            let (mut d, mut h, mut s, mut r) = (0, 0, 0, -1);
            let size = unsafe { mslip_element_workspace_size(pointer, &mut d, &mut h, &mut s, &mut r) };
            assert_eq!((size, d, h, s, r), (MSLIP_OK, directions, harmonics, samples, rule));
        } else {
            assert!(untouched(&values), "a rejected workspace has been modified");
        }
        (self.workspace, self.valid_workspace) = (values, answer == MSLIP_OK);
        self.coefficients = 2 * harmonics + 1;
    }

    /// Changes a double, or one of its bits. The header of a longer workspace is not allowed: its length would be another one.
    fn corrupt(&mut self, call: &Call, place: u16, bit: Option<u8>) {
        let number = call.values.first().map_or(0.5, |number| self.numbers.one(*number, 1e-6));
        let change = |values: &mut [f64]| {
            if let Some(value) = values.len().checked_sub(1).map(|last| &mut values[place as usize % (last + 1)]) {
                *value = bit.map_or(number, |bit| f64::from_bits(value.to_bits() ^ 1 << (bit % 64)));
            }
        };
        let slot = call.element as usize % ELEMENTS;
        match call.omitted % 3 {
            0 => {
                self.valid[slot] = false;
                change(&mut self.elements[slot * SIZE..][..SIZE]);
            }
            1 => {
                self.states[slot].valid = false;
                change(&mut self.states[slot].values);
            }
            _ => {
                let before = self.workspace.clone();
                change(&mut self.workspace);
                self.valid_workspace = false;
                let header = self.workspace.as_ptr();
                let (mut harmonics, mut samples) = (0, 0);
                let size = unsafe {
                    mslip_element_workspace_size(header, null_mut(), &mut harmonics, &mut samples, null_mut())
                };
                let length = mslip_element_workspace_length(1, harmonics, samples, MSLIP_UNIFORM_SAMPLING);
                if size == MSLIP_OK && length > self.workspace.len() {
                    self.workspace = before;
                } else {
                    self.coefficients = 2 * harmonics + 1;
                }
            }
        }
    }

    fn perform(&mut self, call: &Call) {
        let Call { fault, omitted, .. } = *call;
        let slot = call.element as usize % ELEMENTS;
        let own: *const mslip_element = self.elements[slot * SIZE..].as_ptr().cast();
        let e = unsafe { &*own };
        let element = if fault == Fault::NullElement { null() } else { own };
        let valid = self.valid[slot];
        let positive = |value: f64| if value > 0.0 && value < 1e150 { value } else { 1e-6 };
        let shift = positive(e.approach * e.friction_coefficient.min(1e3));
        let normal = positive(if e.normal_input == MSLIP_NORMAL_FORCE { e.normal_force } else { e.approach });
        let scales = match call.function {
            Function::NormalForce => [e.approach; 2],
            Function::NormalApproach => [e.normal_force; 2],
            Function::Tractions => [positive(e.half_width); 2],
            _ => [shift, normal],
        };
        let values: Vec<f64> = (0..).zip(&call.values).map(|(i, v)| self.numbers.one(*v, scales[i % 2])).collect();
        let count = values.len();
        let steps = count / 2;
        let input = |values: &[f64]| if fault == Fault::NullInput { null() } else { values.as_ptr() };
        let x = input(&values);

        let State { values: state, valid: valid_state, foreign } = self.states[slot].clone();
        let length = with_fault(state.len(), fault);
        let valid_history = valid && valid_state && !foreign;
        let old = if fault == Fault::NullState { null() } else { state.as_ptr() };
        let workspace = if fault == Fault::NullWorkspace { null_mut() } else { self.workspace.as_mut_ptr() };
        let m = 2 * self.coefficients;
        let coefficients = |items: usize| -> Vec<f64> {
            let at = |i: usize| values.get(i % count.max(1)).copied().unwrap_or(0.0);
            (0..items * m).map(|i| at(2 * (i % self.coefficients) + usize::from(i % m >= self.coefficients))).collect()
        };
        let coulomb = |force: &[f64]| {
            for force in force.as_chunks::<2>().0 {
                // The force is a sum over pieces of the diagram, which may belong to larger loads.
                let limit = e.friction_coefficient * (force[1] + 1e-13 * e.normal_force.max(force[1]));
                assert!(force[1] >= 0.0 && force[0].abs() <= limit, "{force:?}");
            }
        };

        match call.function {
            Function::Init(choice, directions, normal_input) => {
                let directions = if directions < 100 { 1 } else { directions.into() };
                self.init(slot, choice, directions, code(normal_input));
            }
            Function::Corrupt(place, bit) => self.corrupt(call, place, bit),
            Function::StateInit(directions, length) => {
                let directions = if directions < 100 { 1 } else { directions.into() };
                let length = length as usize;
                let length = if length < 192 { mslip_element_state_length(1, length % 12) } else { length % 36 };
                self.state_init(slot, directions, length, fault);
            }
            Function::WorkspaceInit(directions, harmonics, samples, rule) => {
                let directions = if directions < 100 { 1 } else { directions.into() };
                let rule = if rule < 100 { MSLIP_UNIFORM_SAMPLING } else { rule.into() };
                self.workspace_init([directions, rule], [harmonics as usize % 7, samples.into()], fault);
            }
            Function::Checks => {
                let checked = status(true, || unsafe { mslip_element_check(element) });
                assert!(!valid || element.is_null() || checked == MSLIP_OK, "the check rejects an element");
                let checked = status(true, || unsafe { mslip_element_state_check(1, length, old) });
                let comparable = valid_history && fault == Fault::None;
                assert!(!comparable || checked == MSLIP_OK, "the check rejects {state:?}");
                let error = |[error]: [*mut f64; 1]| unsafe { mslip_element_state_error(1, length, old, error) };
                if let Some([error]) = run(valid_history, omitted, [1], error) {
                    all!(error, not_negative);
                }
            }
            Function::NormalForce => {
                let n = with_fault(count, fault);
                let law = |[f, k, b]: [*mut f64; 3]| unsafe { mslip_normal_force(element, n, x, f, k, b) };
                if let Some(outputs) = run(valid, omitted, [count; 3], law) {
                    outputs.iter().for_each(|output| all!(output, not_negative));
                }
            }
            Function::NormalApproach => {
                let n = with_fault(count, fault);
                let law = |[w, c, b]: [*mut f64; 3]| unsafe { mslip_normal_approach(element, n, x, w, c, b) };
                if let Some([approach, compliance, half_width]) = run(valid, omitted, [count; 3], law) {
                    all!(approach, not_negative);
                    all!(compliance, |compliance| compliance > 0.0);
                    all!(half_width, not_negative);
                }
            }
            Function::Update | Function::Path => {
                let is_path = matches!(call.function, Function::Path);
                if !is_path && steps == 0 {
                    return;
                }
                let steps = if is_path { steps } else { 1 };
                let n = with_fault(steps, fault);
                let step = |old: *const f64, new: *mut f64, [f, k, d]: [*mut f64; 3]| unsafe {
                    if is_path {
                        mslip_element_path(element, length, old, n, x, new, f, k, d)
                    } else {
                        mslip_element_update(element, length, old, x, new, f, k, d)
                    }
                };
                let lengths = [state.len(), 2 * steps, 4 * steps, steps];
                let result = run(valid_history, omitted, lengths, |[new, f, k, d]| step(old, new, [f, k, d]));
                assert!(same(&state, &self.states[slot].values), "the old state was modified");
                // In place.
                let mut in_place = state.clone();
                let [_, lengths @ ..] = lengths;
                let repeated = run(valid_history, omitted.rotate_left(3), lengths, |outputs| {
                    in_place.copy_from_slice(&state);
                    let pointer = if old.is_null() { null_mut() } else { in_place.as_mut_ptr() };
                    step(pointer, pointer, outputs)
                });
                assert!(result.is_some() == repeated.is_some());
                if let (Some([new, force, tangent, dissipated]), Some(repeated)) = (&result, &repeated) {
                    coulomb(force);
                    all!(tangent, f64::is_finite);
                    all!(dissipated, not_negative);
                    assert!(same(used(&in_place), used(new)), "in place {in_place:?}, elsewhere {new:?}");
                    for (elsewhere, in_place) in [force, tangent, dissipated].into_iter().zip(repeated) {
                        assert!(same(elsewhere, in_place), "in place {in_place:?}, elsewhere {elsewhere:?}");
                    }
                    // Step by step.
                    let mut stepwise = state.clone();
                    let s = stepwise.as_mut_ptr();
                    for i in 0..steps {
                        let (mut f, mut k, mut d) = ([UNTOUCHED; 2], [UNTOUCHED; 4], [UNTOUCHED]);
                        let (x, none) = (&raw const values[2 * i], null_mut());
                        let (pf, pk, pd) = (f.as_mut_ptr(), k.as_mut_ptr(), d.as_mut_ptr());
                        unsafe {
                            assert_eq!(mslip_element_update(own, state.len(), s, x, none, pf, pk, pd), MSLIP_OK);
                            assert!(same(&force[2 * i..][..2], &f) && same(&tangent[4 * i..][..4], &k));
                            assert!(same(&dissipated[i..][..1], &d), "{dissipated:?} {i} {d:?}");
                            assert_eq!(mslip_element_update(own, state.len(), s, x, s, pf, none, none), MSLIP_OK);
                        }
                        assert!(same(&force[2 * i..][..2], &f));
                    }
                    assert!(same(used(&stepwise), used(new)), "stepwise {stepwise:?}, at once {new:?}");
                }
                self.states[slot].values = in_place;
            }
            Function::Tractions => {
                let n = with_fault(count, fault);
                let tractions =
                    |[p, q]: [*mut f64; 2]| unsafe { mslip_element_tractions(element, length, old, n, x, p, q) };
                if let Some([pressure, shear]) = run(valid_history, omitted, [count; 2], tractions) {
                    all!(pressure, not_negative);
                    all!(shear, f64::is_finite);
                }
            }
            Function::HarmonicForce => {
                let displacement = coefficients(1);
                let harmonic = |[f, j, d]: [*mut f64; 3]| unsafe {
                    mslip_element_harmonic_force(element, workspace, input(&displacement), f, j, d)
                };
                if let Some([force, jacobian, dissipated]) =
                    run(valid && self.valid_workspace, omitted, [m, m * m, 1], harmonic)
                {
                    all!(force, f64::is_finite);
                    all!(jacobian, f64::is_finite);
                    all!(dissipated, not_negative);
                }
            }
            Function::BatchUpdate | Function::BatchHarmonicForce => {
                let is_update = matches!(call.function, Function::BatchUpdate);
                let items = if is_update { steps } else { steps % 4 };
                let slot_of =
                    |i: i8| if i.unsigned_abs() < 120 { i32::from(i).rem_euclid(3) } else { i32::from(i) / 30 };
                let index: Option<Vec<i32>> =
                    call.index.map(|index| (0..items).map(|i| slot_of(index[i % 5])).collect());
                let active: Option<Vec<i32>> = call
                    .active
                    .map(|flags| (0..items).map(|i| i32::from(flags >> (i % 8) & 1) * i32::from(flags)).collect());
                let element_of = |i: usize| index.as_ref().map_or(i, |index| index[i] as usize);
                let slots: Vec<Option<usize>> = (0..items)
                    .map(|i| active.as_ref().is_none_or(|active| active[i] != 0).then(|| element_of(i)))
                    .collect();
                let all_valid = slots.iter().flatten().all(|&slot| self.valid.get(slot).is_none_or(|valid| *valid));
                let foreign = slots.iter().flatten().any(|&other| other != slot) || foreign;
                let (pi, pa) =
                    (index.as_ref().map_or(null(), |i| i.as_ptr()), active.as_ref().map_or(null(), |a| a.as_ptr()));
                let first: *const mslip_element = self.elements.as_ptr().cast();
                let p = if element.is_null() { null() } else { first };
                let n = with_fault(items, fault);
                let single = |slot: usize| -> *const mslip_element { self.elements[slot * SIZE..].as_ptr().cast() };
                let none = null_mut();
                if is_update {
                    let states = state.repeat(items);
                    let old = if old.is_null() { null() } else { states.as_ptr() };
                    let width = state.len();
                    let update = |[new, f, k, d]: [*mut f64; 4]| unsafe {
                        mslip_batch_element_update(n, ELEMENTS, p, pi, pa, width, old, x, new, f, k, d)
                    };
                    let lengths = [items * width, 2 * items, 4 * items, items];
                    let safe = all_valid && valid_state && !foreign;
                    if let Some([new, force, tangent, dissipated]) = run(safe, omitted, lengths, update) {
                        for (i, slot) in slots.iter().enumerate() {
                            let mut alone = vec![UNTOUCHED; width];
                            let (mut f, mut k, mut d) = ([UNTOUCHED; 2], [UNTOUCHED; 4], [UNTOUCHED]);
                            if let Some(slot) = slot {
                                let (x, s) = (&raw const values[2 * i], alone.as_mut_ptr());
                                let (pf, pk, pd) = (f.as_mut_ptr(), k.as_mut_ptr(), d.as_mut_ptr());
                                let answer = unsafe {
                                    mslip_element_update(single(*slot), width, state.as_ptr(), x, s, pf, pk, pd)
                                };
                                assert_eq!(answer, MSLIP_OK);
                            }
                            assert!(same(&new[i * width..][..width], &alone));
                            assert!(same(&force[2 * i..][..2], &f) && same(&tangent[4 * i..][..4], &k));
                            assert!(same(&dissipated[i..][..1], &d));
                        }
                    }
                } else {
                    let displacement = coefficients(items);
                    let harmonic = |[f, j, d]: [*mut f64; 3]| unsafe {
                        let u = input(&displacement);
                        mslip_batch_element_harmonic_force(n, ELEMENTS, p, pi, pa, workspace, u, f, j, d)
                    };
                    let lengths = [items * m, items * m * m, items];
                    if let Some([force, ..]) = run(all_valid && self.valid_workspace, omitted, lengths, harmonic) {
                        for (i, slot) in slots.iter().enumerate() {
                            let mut alone = vec![UNTOUCHED; m];
                            if let Some(slot) = slot {
                                let (u, f) = (displacement[i * m..].as_ptr(), alone.as_mut_ptr());
                                let answer =
                                    unsafe { mslip_element_harmonic_force(single(*slot), workspace, u, f, none, none) };
                                assert_eq!(answer, MSLIP_OK);
                            }
                            assert!(same(&force[i * m..][..m], &alone));
                        }
                    }
                }
            }
            Function::Lengths(directions, pieces, samples, rule) => {
                let [pieces, samples] = [pieces, samples].map(|value| (value >> (value % 64)) as usize);
                let length = mslip_element_state_length(directions % 3, pieces);
                assert!((length > 0) == matches!(directions % 3, 1 | 2));
                let length = mslip_element_workspace_length(directions % 3, pieces, samples, rule % 3);
                assert!(length == 0 || (pieces > 0 && samples / 2 >= pieces));
            }
        }
    }
}

/// A length, or one beyond the address space.
fn with_fault(length: usize, fault: Fault) -> usize {
    match fault {
        Fault::Length(choice) => [usize::MAX, isize::MAX as usize, isize::MAX as usize / 8 + 1][choice as usize % 3],
        _ => length,
    }
}
