//! Sequences of calls of the element functions of the C interface, also with invalid pointers and lengths and with corrupted memory.
//!
//! The same holds as for the target `calls`. With valid memory the forces satisfy Coulomb's law and the normal law, no energy is
//! negative, states pass their check, a path gives the results of its steps and a batch status and results of single calls.
//! Elements, states and workspaces of different numbers of directions are rejected.
#![no_main]

use libfuzzer_sys::arbitrary::{self, Arbitrary};
use libfuzzer_sys::fuzz_target;
use microslip::Error;
use microslip::ffi::*;
use microslip_fuzz::calls::{UNTOUCHED, not_negative, run, same, status, untouched};
use microslip_fuzz::{AnyParameters, Choice, Number, Numbers, all};
use std::ptr::{null, null_mut};

const ELEMENTS: usize = 3;
/// Tangential directions of the elements at first.
const DIRECTIONS: [i32; ELEMENTS] = [1, 2, 2];
/// Random steps at the end of some paths.
const WALK: usize = 16;
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
    /// Flags of a batch; the seed of random steps of a path.
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
    directions: i32,
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
    /// Directions and 2H+1 of the workspace.
    workspace_directions: i32,
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
        workspace_directions: 1,
        coefficients: 0,
        numbers: Numbers::default(),
    };
    for (slot, (choice, by_force)) in input.elements.iter().enumerate() {
        let directions = DIRECTIONS[slot];
        memory.init(slot, *choice, directions, i32::from(*by_force));
        memory.state_init(slot, directions, mslip_element_state_length(directions, 4 + 3 * slot), Fault::None);
    }
    let directions = 1 + (input.calls.len() % 2) as i32;
    memory.workspace_init([directions, MSLIP_UNIFORM_SAMPLING], [2, 9], Fault::None);
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

/// A number of tangential directions; small ones are valid.
fn directions_of(value: i8) -> i32 {
    if value < 100 { 1 + i32::from(value & 1) } else { value.into() }
}

/// The values in use: for one direction a header of 8 doubles, whose first holds the number of knots in its last 40 bits, and 4 for
/// each; for two the shortest state.
fn used(directions: i32, state: &[f64]) -> &[f64] {
    let knots = (state[0].to_bits() & 0xff_ffff_ffff) as usize;
    let length = if directions == 1 { 8 + 4 * knots } else { mslip_element_state_length(2, 0) };
    state.get(..length).unwrap_or(state)
}

/// Continues a path of displacements of c components by random steps of one width; the normal component mostly stays.
fn walk(path: &mut Vec<f64>, seed: u8, c: usize, [shift, normal]: [f64; 2]) {
    let mut state = u32::from(seed);
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) * 2f64.powi(-23) - 1.0
    };
    let width = shift * 2f64.powi(1 - i32::from(seed % 8));
    for _ in 0..WALK {
        for k in 1..=c {
            let before = path.len().checked_sub(c).map(|i| path[i]);
            let (change, stays) = (random(), random() > -0.5);
            path.push(match before {
                Some(before) if k < c => before + width * change,
                Some(before) if stays => before,
                _ if k < c => 0.0,
                _ => normal * change.abs(),
            });
        }
    }
}

/// Calls a batch, and each item alone if all memory is valid: the status is that of the first item that is rejected.
fn batch<const K: usize>(
    [valid, predictable, safe]: [bool; 3],
    omitted: u8,
    slots: &[Option<usize>],
    lengths: [usize; K],
    together: impl Fn([*mut f64; K]) -> i32,
    alone: impl Fn(usize, usize, [*mut f64; K]) -> i32,
) {
    let single = |(i, slot): (usize, &Option<usize>)| {
        let mut outputs = lengths.map(|length| vec![UNTOUCHED; length]);
        let pointers = outputs.each_mut().map(Vec::as_mut_ptr);
        (slot.map_or(MSLIP_OK, |slot| alone(i, slot, pointers)), outputs)
    };
    let singles: Vec<_> = if valid { slots.iter().enumerate().map(single).collect() } else { Vec::new() };
    let expected = singles.iter().map(|(code, _)| *code).find(|code| *code != MSLIP_OK).unwrap_or(MSLIP_OK);
    let expected = predictable.then_some(expected);
    let all = run(safe, omitted, lengths.map(|length| slots.len() * length), |outputs| {
        predicted(expected, together(outputs))
    });
    for (output, k) in all.iter().flatten().zip(0..) {
        for (item, (_, single)) in output.chunks(lengths[k]).zip(&singles) {
            assert!(same(item, &single[k]), "output {k}: {item:?}, alone {:?}", single[k]);
        }
    }
}

/// A status, which must be the expected one.
fn predicted(expected: Option<i32>, status: i32) -> i32 {
    assert!(expected.is_none_or(|expected| expected == status), "status {status}, not {expected:?}");
    status
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
        assert!(not_negative(e.friction_coefficient) && (e.directions, e.normal_input) == (directions, normal_input));
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
        self.states[slot] = State { values, directions, valid: answer == MSLIP_OK, foreign: false };
    }

    fn workspace_init(&mut self, [directions, rule]: [i32; 2], [harmonics, samples]: [usize; 2], fault: Fault) {
        let length = mslip_element_workspace_length(directions, harmonics, samples, rule).max(3);
        let mut values = vec![UNTOUCHED; length];
        let pointer = if fault == Fault::NullWorkspace { null_mut() } else { values.as_mut_ptr() };
        let n = with_fault(length, fault);
        let answer = status(true, || unsafe {
            mslip_element_workspace_init(directions, harmonics, samples, rule, 0, n, pointer)
        });
        if answer == MSLIP_OK {
            let (mut d, mut h, mut s, mut r) = (0, 0, 0, -1);
            let size = unsafe { mslip_element_workspace_size(pointer, &mut d, &mut h, &mut s, &mut r, null_mut()) };
            assert_eq!((size, d, h, s, r), (MSLIP_OK, directions, harmonics, samples, rule));
        } else {
            assert!(untouched(&values), "a rejected workspace has been modified");
        }
        (self.workspace, self.valid_workspace) = (values, answer == MSLIP_OK);
        self.workspace_directions = if self.valid_workspace { directions } else { 1 };
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
                let (mut directions, mut harmonics, mut samples) = (1, 0, 0);
                let size = unsafe {
                    mslip_element_workspace_size(
                        header,
                        &mut directions,
                        &mut harmonics,
                        &mut samples,
                        null_mut(),
                        null_mut(),
                    )
                };
                let length = mslip_element_workspace_length(directions, harmonics, samples, MSLIP_UNIFORM_SAMPLING);
                if size == MSLIP_OK && length > self.workspace.len() {
                    self.workspace = before;
                } else {
                    (self.workspace_directions, self.coefficients) = (directions, 2 * harmonics + 1);
                }
            }
        }
    }

    fn element(&self, slot: usize) -> *const mslip_element {
        self.elements[slot * SIZE..].as_ptr().cast()
    }

    fn perform(&mut self, call: &Call) {
        let Call { fault, omitted, .. } = *call;
        let faultless = matches!(fault, Fault::None | Fault::NoneAgain);
        let slot = call.element as usize % ELEMENTS;
        let own = self.element(slot);
        let e = unsafe { &*own };
        let element = if fault == Fault::NullElement { null() } else { own };
        let valid = self.valid[slot];
        // Buffers for a corrupted element suffice for two directions.
        let components = |valid: bool, directions: i32| if valid { directions as usize + 1 } else { 3 };
        let c = components(valid, e.directions);
        let positive = |value: f64| if value > 0.0 && value < 1e150 { value } else { 1e-6 };
        let shift = positive(e.approach * e.friction_coefficient.min(1e3));
        let normal = positive(if e.normal_input == MSLIP_INPUT_NORMAL_FORCE { e.normal_force } else { e.approach });
        let scales = match call.function {
            Function::NormalForce => [e.approach; 2],
            Function::NormalApproach => [e.normal_force; 2],
            Function::Tractions => [positive(e.half_width); 2],
            _ => [shift, normal],
        };
        let normal_at = |i: usize| i % c == c - 1;
        let mut values: Vec<f64> =
            (0..).zip(&call.values).map(|(i, v)| self.numbers.one(*v, scales[usize::from(normal_at(i))])).collect();
        if let (Function::Path, Some(seed)) = (call.function, call.active) {
            values.truncate(values.len() / c * c);
            walk(&mut values, seed, c, [shift, normal]);
        }
        let count = values.len();
        let steps = count / c;
        let input = |values: &[f64]| if fault == Fault::NullInput { null() } else { values.as_ptr() };
        let x = input(&values);

        let State { values: state, directions: state_directions, valid: valid_state, foreign } =
            self.states[slot].clone();
        let length = with_fault(state.len(), fault);
        let valid_history = valid && valid_state && !foreign;
        let old = if fault == Fault::NullState { null() } else { state.as_ptr() };
        let workspace = if fault == Fault::NullWorkspace { null_mut() } else { self.workspace.as_mut_ptr() };
        // The status if a state is that of another number of directions.
        let other_directions = |valid: bool, directions: i32| {
            let short = state.len() < mslip_element_state_length(directions, 0);
            let error = if short { Error::StateTooShort } else { Error::BadDirections };
            (faultless && valid && valid_state && directions != state_directions).then_some(error.code())
        };
        let workspace_directions = self.workspace_directions;
        let wc = components(true, workspace_directions);
        let m = wc * self.coefficients;
        let coefficients = |items: usize| -> Vec<f64> {
            let at = |i: usize| values.get(i % count.max(1)).copied().unwrap_or(0.0);
            (0..items * m).map(|i| at(wc * (i % self.coefficients) + i % m / self.coefficients)).collect()
        };
        let coulomb = |force: &[f64]| {
            for force in force.chunks(c) {
                let (normal, tangential) = (force[c - 1], force[..c - 1].iter().copied().fold(0.0, f64::hypot));
                // The force is a sum over pieces of the diagram, which may belong to larger loads.
                let limit = e.friction_coefficient * (normal + 1e-13 * e.normal_force.max(normal));
                assert!(normal >= 0.0 && tangential <= limit, "{force:?}");
            }
        };

        match call.function {
            Function::Init(choice, directions, normal_input) => {
                let directions = directions_of(directions);
                self.init(slot, choice, directions, code(normal_input));
            }
            Function::Corrupt(place, bit) => self.corrupt(call, place, bit),
            Function::StateInit(directions, length) => {
                let directions = directions_of(directions);
                let length = length as usize;
                let length = match length {
                    ..128 => mslip_element_state_length(directions, length % 12),
                    // Longer than a state of two directions.
                    128..192 => mslip_element_state_length(1, length),
                    _ => length % 36,
                };
                self.state_init(slot, directions, length, fault);
            }
            Function::WorkspaceInit(directions, harmonics, samples, rule) => {
                let directions = directions_of(directions);
                let rule = if rule < 100 { MSLIP_UNIFORM_SAMPLING } else { rule.into() };
                self.workspace_init([directions, rule], [harmonics as usize % 7, samples.into()], fault);
            }
            Function::Checks => {
                let checked = status(true, || unsafe { mslip_element_check(element) });
                assert!(!valid || element.is_null() || checked == MSLIP_OK, "the check rejects an element");
                for directions in [1, 2] {
                    let other = other_directions(valid_history, directions);
                    let checked = status(true, || unsafe { mslip_element_state_check(directions, length, old) });
                    let expected = (valid_history && faultless).then(|| other.unwrap_or(MSLIP_OK));
                    predicted(expected, checked);
                    let error = |[error]: [*mut f64; 1]| {
                        predicted(other, unsafe { mslip_element_state_error(directions, length, old, error) })
                    };
                    if let Some([error]) = run(valid_history, omitted, [1], error) {
                        all!(error, not_negative);
                    }
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
                let other = other_directions(valid, e.directions);
                let step = |old: *const f64, new: *mut f64, [f, k, d]: [*mut f64; 3]| unsafe {
                    let status = if is_path {
                        mslip_element_path(element, length, old, n, x, new, f, k, d)
                    } else {
                        mslip_element_update(element, length, old, x, new, f, k, d)
                    };
                    predicted(other, status)
                };
                let lengths = [state.len(), c * steps, c * c * steps, steps];
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
                let accepted = result.is_some() || !valid_history;
                assert!(accepted || same(&in_place, &state), "a rejected call has modified the state");
                if let (Some([new, force, tangent, dissipated]), Some(repeated)) = (&result, &repeated) {
                    coulomb(force);
                    all!(tangent, f64::is_finite);
                    all!(dissipated, not_negative);
                    let used = |state| used(e.directions, state);
                    assert!(same(used(&in_place), used(new)), "in place {in_place:?}, elsewhere {new:?}");
                    for (elsewhere, in_place) in [force, tangent, dissipated].into_iter().zip(repeated) {
                        assert!(same(elsewhere, in_place), "in place {in_place:?}, elsewhere {elsewhere:?}");
                    }
                    // Step by step.
                    let mut stepwise = state.clone();
                    let (s, none) = (stepwise.as_mut_ptr(), null_mut());
                    for i in 0..steps {
                        let mut outputs = [c, c * c, 1].map(|length| vec![UNTOUCHED; length]);
                        let [f, k, d] = outputs.each_mut().map(Vec::as_mut_ptr);
                        let x = &raw const values[c * i];
                        unsafe {
                            assert_eq!(mslip_element_update(own, state.len(), s, x, none, f, k, d), MSLIP_OK);
                            for (all, one) in [force, tangent, dissipated].into_iter().zip(&outputs) {
                                assert!(same(&all[i * one.len()..][..one.len()], one), "step {i}: {all:?}, {one:?}");
                            }
                            assert_eq!(mslip_element_update(own, state.len(), s, x, s, f, none, none), MSLIP_OK);
                            assert_eq!(mslip_element_state_check(e.directions, state.len(), s), MSLIP_OK, "step {i}");
                        }
                        assert!(same(&force[c * i..][..c], &outputs[0]));
                    }
                    assert!(same(used(&stepwise), used(new)), "stepwise {stepwise:?}, at once {new:?}");
                }
                self.states[slot].values = in_place;
            }
            Function::Tractions => {
                let n = with_fault(count, fault);
                let expected = match other_directions(valid, 1) {
                    _ if valid && faultless && e.directions == 2 => Some(Error::NotAvailable.code()),
                    other => other,
                };
                let tractions = |[p, q]: [*mut f64; 2]| {
                    predicted(expected, unsafe { mslip_element_tractions(element, length, old, n, x, p, q) })
                };
                if let Some([pressure, shear]) = run(valid_history, omitted, [count; 2], tractions) {
                    all!(pressure, not_negative);
                    all!(shear, f64::is_finite);
                }
            }
            Function::HarmonicForce => {
                let displacement = coefficients(1);
                let valid = valid && self.valid_workspace;
                let other = valid && faultless && e.directions != workspace_directions;
                let expected = other.then_some(Error::BadDirections.code());
                let harmonic = |[f, j, d]: [*mut f64; 3]| unsafe {
                    let u = input(&displacement);
                    predicted(expected, mslip_element_harmonic_force(element, workspace, u, f, j, d, null_mut()))
                };
                if let Some([force, jacobian, dissipated]) = run(valid, omitted, [m, m * m, 1], harmonic) {
                    all!(force, f64::is_finite);
                    all!(jacobian, f64::is_finite);
                    all!(dissipated, not_negative);
                }
            }
            Function::BatchUpdate | Function::BatchHarmonicForce => {
                let is_update = matches!(call.function, Function::BatchUpdate);
                let items = if is_update { count / 3 } else { count / 3 % 4 };
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
                // An item alone; its element must be one and have the directions of the others.
                let single = |slot: usize, directions: i32, call: &dyn Fn(*const mslip_element) -> i32| {
                    if slot >= ELEMENTS {
                        return Error::BadIndex.code();
                    }
                    let one = self.element(slot);
                    if unsafe { &*one }.directions == directions { call(one) } else { Error::BadDirections.code() }
                };
                if is_update {
                    let states = state.repeat(items);
                    let old = if old.is_null() { null() } else { states.as_ptr() };
                    let width = state.len();
                    let first = slots.iter().flatten().next().filter(|slot| **slot < ELEMENTS);
                    let directions = first.map_or(1, |slot| unsafe { &*self.element(*slot) }.directions);
                    let c = components(all_valid, directions);
                    let update = |[new, f, k, d]: [*mut f64; 4]| unsafe {
                        mslip_batch_element_update(n, ELEMENTS, p, pi, pa, width, old, x, new, f, k, d)
                    };
                    let alone = |i: usize, slot: usize, [new, f, k, d]: [*mut f64; 4]| {
                        single(slot, directions, &|one| unsafe {
                            mslip_element_update(one, width, state.as_ptr(), &raw const values[c * i], new, f, k, d)
                        })
                    };
                    let valid = all_valid && valid_state;
                    let validity = [valid, valid && faultless, valid && !foreign];
                    batch(validity, omitted, &slots, [width, c, c * c, 1], update, alone);
                } else {
                    let displacement = coefficients(items);
                    let harmonic = |[f, j, d]: [*mut f64; 3]| unsafe {
                        let u = input(&displacement);
                        mslip_batch_element_harmonic_force(n, ELEMENTS, p, pi, pa, workspace, u, f, j, d, null_mut())
                    };
                    let own_workspace = self.workspace.as_ptr().cast_mut();
                    let alone = |i: usize, slot: usize, [f, j, d]: [*mut f64; 3]| {
                        single(slot, workspace_directions, &|one| unsafe {
                            mslip_element_harmonic_force(
                                one,
                                own_workspace,
                                displacement[i * m..].as_ptr(),
                                f,
                                j,
                                d,
                                null_mut(),
                            )
                        })
                    };
                    let valid = all_valid && self.valid_workspace;
                    batch([valid, valid && faultless, valid], omitted, &slots, [m, m * m, 1], harmonic, alone);
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
