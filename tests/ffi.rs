//! Every call of the C interface, by a table, with memory of exact length: each array is an allocation of its own, and outputs are
//! uninitialised.
//!
//! No call raises a floating-point exception that an application may trap, and a rejected one has the same status in four rounding
//! modes. Under Miri (`tools/miri.sh`) every access outside an array, read of uninitialised memory, misaligned access, use of an
//! invalidated reference and race between threads is an error.

#![allow(
    clippy::undocumented_unsafe_blocks,
    reason = "all calls: each pointer is rejected or valid for the length that is passed"
)]

mod calls;
#[cfg(not(miri))]
#[path = "ffi/memory.rs"]
mod memory;
#[cfg(not(miri))]
#[path = "ffi/values.rs"]
mod values;

use calls::Kind::*;
use calls::{Arguments, Before, CALLS, Call, FILLED, FLAT, HARMONICS, Kind, Law, Memory, N, SAMPLES, SPHERE, Slot};
use microslip::ffi::*;
use std::collections::HashSet;
use std::ffi::CStr;
use std::ops::Range;
use std::ptr::{null, null_mut};

fn is_available(call: &Call, law: &Law) -> bool {
    !(call.flat && law.is_elliptic || call.one_direction && law.directions == 2)
}

/// Each call with the first law of each number of directions and rule of a workspace: what is rejected depends on no more.
fn for_each_call(test: impl Fn(&Call, &Law)) {
    for call in CALLS {
        let laws = Law::all(call);
        let is_first = |(place, law): &(usize, &Law)| {
            laws[..*place].iter().all(|other| (other.directions, other.rule) != (law.directions, law.rule))
        };
        let first = laws.iter().enumerate().filter(is_first).map(|(_, law)| law);
        first.filter(|law| is_available(call, law)).for_each(|law| test(call, law));
    }
}

/// Under Miri the bisection for a contact with friction takes minutes, as do contacts, elements and tables, which the arguments of
/// other calls have initialised.
fn is_slow(call: &Call, law: &Law) -> bool {
    let is_made = call.has(NewContact) || call.has(NewElement) || call.name == "mslip_stiffness_table_init";
    cfg!(miri) && (is_made || call.is_sliders() && law.force > 0.0)
}

fn bytes(arguments: &Arguments) -> Vec<Vec<u8>> {
    arguments.memory.iter().flatten().map(|memory| memory.values().to_vec()).collect()
}

/// Rejected with this status, and no memory is modified.
fn rejected_as(call: &Call, arguments: &Arguments, status: i32, what: &str) {
    rejected_in(0..calls::MODES, call, arguments, status, what);
}

/// Rejected in these rounding modes.
fn rejected_in(modes: Range<usize>, call: &Call, arguments: &Arguments, status: i32, what: &str) {
    let before = bytes(arguments);
    for mode in modes {
        assert_eq!(call.make_rounding(mode, &arguments.slots), status, "{}: {what}, rounding mode {mode}", call.name);
    }
    // Whether the normal motion of an element is allowed depends on samples in the workspace.
    let by_samples = call.has(Workspace) && matches!(status, MSLIP_LENGTH_TOO_SHORT | MSLIP_BAD_NORMAL_FORCE);
    assert!(by_samples || bytes(arguments) == before, "{}: {what}: memory is modified", call.name);
}

/// Rejected with another value of an argument, which is then restored.
fn rejected(call: &Call, arguments: &mut Arguments, place: usize, slot: Slot, status: i32) {
    let valid = std::mem::replace(&mut arguments.slots[place], slot);
    rejected_as(call, arguments, status, call.arguments[place].name);
    arguments.slots[place] = valid;
}

/// Rejected with other memory of an argument, which is then restored.
fn rejected_with(call: &Call, arguments: &mut Arguments, place: usize, words: &[u64], status: i32) {
    let valid = arguments.memory[place].take().expect("memory");
    arguments.set(place, Memory::of(words));
    rejected_as(call, arguments, status, call.arguments[place].name);
    arguments.slots[place] = Slot::Pointer(valid.start);
    arguments.memory[place] = Some(valid);
}

/// Bits of the values of the outputs; none is NaN.
fn results(call: &Call, arguments: &Arguments) -> Vec<Vec<u64>> {
    let of = |place: usize| {
        let values = arguments.memory(place).values::<f64>();
        assert!(values.iter().all(|value| !value.is_nan()), "{}: {values:?}", call.name);
        values.iter().map(|value| value.to_bits()).collect()
    };
    places(call, Output).filter(|place| !is_null(arguments.slots[*place])).map(of).collect()
}

fn is_null(slot: Slot) -> bool {
    slot.pointer().is_some_and(<*mut u8>::is_null)
}

fn places(call: &Call, kind: Kind) -> impl Iterator<Item = usize> {
    call.arguments.iter().enumerate().filter(move |(_, argument)| argument.kind == kind).map(|(place, _)| place)
}

/// With all outputs, each alone, and none: the same results, which are written. In place.
#[test]
fn valid_arguments() {
    for call in CALLS {
        for law in Law::all(call) {
            if !is_available(call, &law) {
                rejected_as(call, &Arguments::new(call, &law, Before::Filled), MSLIP_NOT_AVAILABLE, "not available");
                continue;
            }
            if is_slow(call, &law) {
                continue;
            }
            let all = Arguments::new(call, &law, Before::Uninitialised);
            assert_eq!(call.make(&all.slots), MSLIP_OK, "{}", call.name);
            let expected = results(call, &all);
            check_initialised(call, &all);
            check_found(call, &law, &all);
            let optional: Vec<usize> =
                (0..call.arguments.len()).filter(|place| !call.arguments[*place].kind.is_required()).collect();
            let omitted: Vec<usize> =
                optional.into_iter().filter(|place| call.arguments[*place].kind != Index).collect();
            // Every subset of the outputs; under Miri none of them.
            for subset in 0..if cfg!(miri) { 1 } else { 1 << omitted.len() } {
                let mut some = Arguments::new(call, &law, Before::Uninitialised);
                let left_out = omitted.iter().enumerate().filter(|(i, _)| subset >> i & 1 == 0);
                left_out.for_each(|(_, place)| some.omit(*place));
                assert_eq!(call.make(&some.slots), MSLIP_OK, "{}", call.name);
                let of_all = places(call, Output).zip(&expected).filter(|(place, _)| !is_null(some.slots[*place]));
                assert!(results(call, &some).iter().eq(of_all.map(|(_, values)| values)), "{}: {subset:b}", call.name);
            }
            if let (Some(old), Some(new)) = (call.place(State), call.place(NewState)) {
                let mut in_place = Arguments::new(call, &law, Before::Uninitialised);
                in_place.slots[new] = in_place.slots[old];
                assert_eq!(call.make(&in_place.slots), MSLIP_OK, "{}", call.name);
                assert_eq!(results(call, &in_place), expected, "{}", call.name);
                let [old, new] = [in_place.memory(old), all.memory(new)].map(|state| &state.values::<u64>()[..3]);
                assert_eq!(old, new, "{}", call.name);
            }
        }
    }
}

/// The results at several points are those at each alone.
#[test]
fn points_are_independent() {
    for_each_call(|call, law| {
        let of_points = |place: &usize| call.arguments[*place].extents == "n";
        let (Some(count), false) = (call.place(Count), call.has(State) || !call.has(Input)) else { return };
        let arrays: Vec<usize> = places(call, Input).chain(places(call, Output)).collect();
        if call.has(Index) || !arrays.iter().all(of_points) {
            return;
        }
        let all = Arguments::new(call, law, Before::Filled);
        assert_eq!(call.make(&all.slots), MSLIP_OK, "{}", call.name);
        let expected = results(call, &all);
        for i in 0..calls::N {
            let mut slots = all.slots.clone();
            slots[count] = Slot::Size(1);
            let one = |place: usize| Slot::Pointer(all.memory(place).start.wrapping_add(8 * i));
            arrays.iter().for_each(|place| slots[*place] = one(*place));
            assert_eq!(call.make(&slots), MSLIP_OK, "{}", call.name);
        }
        assert_eq!(results(call, &all), expected, "{}", call.name);
    });
}

/// The sizes and choices that a call has found.
fn check_found(call: &Call, law: &Law, arguments: &Arguments) {
    for (argument, memory) in call.arguments.iter().zip(&arguments.memory) {
        let Some(memory) = memory else { continue };
        match (argument.kind, argument.name) {
            (FoundSize, "harmonics") => assert_eq!(memory.values::<usize>(), [law.harmonics]),
            (FoundSize, "samples") => assert_eq!(memory.values::<usize>(), [law.samples]),
            (FoundSize, _) => assert_eq!(memory.values::<usize>(), [calls::PERIODS]),
            (FoundChoice, "directions") => assert_eq!(memory.values::<i32>(), [law.directions]),
            (FoundChoice, _) => assert_eq!(memory.values::<i32>(), [law.rule]),
            _ => {}
        }
    }
}

/// The check functions accept what was initialised.
fn check_initialised(call: &Call, arguments: &Arguments) {
    let status = |place: usize| unsafe {
        let Some(memory) = &arguments.memory[place] else { return MSLIP_OK };
        let start = memory.start;
        match call.arguments[place].kind {
            NewContact => mslip_contact_check(start.cast()),
            NewElement => mslip_element_check(start.cast()),
            Buffer if call.name == "mslip_state_init" => mslip_state_check(memory.bytes / 8, start.cast()),
            Buffer if call.name == "mslip_element_state_init" => {
                mslip_element_state_check(arguments.slots[0].get(), memory.bytes / 8, start.cast())
            }
            _ => MSLIP_OK,
        }
    };
    assert!((0..call.arguments.len()).all(|place| status(place) == MSLIP_OK), "{}", call.name);
}

/// Pointers that are misaligned or NULL; lengths and counts beyond the address space; memory that is uninitialised, truncated to
/// its header or its length, or of the other number of directions.
#[test]
fn invalid_arguments() {
    for_each_call(|call, law| {
        let mut arguments = Arguments::new(call, law, Before::Filled);
        for (place, argument) in call.arguments.iter().enumerate() {
            if let Some(memory) = &arguments.memory[place] {
                let misaligned = Slot::Pointer(memory.misaligned());
                rejected(call, &mut arguments, place, misaligned, MSLIP_BAD_ALIGNMENT);
                if argument.kind.is_required() {
                    rejected(call, &mut arguments, place, Slot::Pointer(null_mut()), MSLIP_NULL_POINTER);
                }
            }
            invalid_length(call, &mut arguments, place);
            invalid_memory(call, law, &mut arguments, place);
        }
    });
}

/// Arrays of no items may be NULL.
fn invalid_length(call: &Call, arguments: &mut Arguments, place: usize) {
    let argument = &call.arguments[place];
    if !matches!(argument.kind, Count | Laws | Length) {
        return;
    }
    let valid: usize = arguments.slots[place].get();
    for size in [usize::MAX, usize::MAX / 2 + 1, usize::MAX / 8] {
        rejected(call, arguments, place, Slot::Size(size), MSLIP_BAD_ARRAY_SIZE);
    }
    if argument.kind == Count && !call.is_sliders() {
        let slots = arguments.slots.clone();
        arguments.slots[place] = Slot::Size(0);
        places(call, Laws).for_each(|place| arguments.slots[place] = Slot::Size(0));
        for (place, argument) in call.arguments.iter().enumerate() {
            let is_of_items = match argument.kind {
                Contact | Element | State => call.has(Index),
                Workspace | Table => false,
                _ => slots[place].pointer().is_some(),
            };
            if is_of_items {
                arguments.omit(place);
            }
        }
        rejected_as(call, arguments, MSLIP_OK, "no items");
        arguments.slots = slots;
    }
    let array = call.place(State).or(call.place(Buffer));
    if let (Length, Some(array)) = (argument.kind, array) {
        for length in [0, 1, valid - 1] {
            arguments.slots[place] = Slot::Size(length);
            let states = if call.has(Index) { N } else { 1 };
            let words = vec![0x7777_7777_7777_7777; states * length];
            rejected_with(call, arguments, array, &words, argument.status);
        }
        // NULL of no length is NULL.
        arguments.slots[place] = Slot::Size(0);
        rejected(call, arguments, array, Slot::Pointer(null_mut()), MSLIP_NULL_POINTER);
        arguments.slots[place] = Slot::Size(valid);
    }
}

/// Nothing is read after an invalid header.
fn invalid_memory(call: &Call, law: &Law, arguments: &mut Arguments, place: usize) {
    let argument = &call.arguments[place];
    if !matches!(argument.kind, Contact | Element | State | Workspace | Table) {
        return;
    }
    let words = arguments.memory(place).values::<u64>().to_vec();
    let header = match argument.kind {
        Workspace => 3,
        Table => 1,
        _ => words.len(),
    };
    for byte in [0, 0x77_77_77_77_77_77_77_77, u64::MAX] {
        rejected_with(call, arguments, place, &vec![byte; header], argument.status);
    }
    // A valid header with more reversals or knots than the state holds.
    if argument.kind == State && !(call.is_of_element() && law.directions == 2) {
        let mut words = words.clone();
        words[0] += if call.is_of_element() { 5 } else { 3 };
        rejected_with(call, arguments, place, &words, argument.status);
    }
    // Of the other number of directions; a state that is long enough for both. The arrays of a batch have the lengths of its
    // workspace: a longer one would exceed them.
    let other = Law { directions: 3 - law.directions, ..law.clone() };
    if !call.is_of_element() || !(call.has(Element) || call.has(Choice)) {
        return;
    }
    let foreign = match argument.kind {
        State => {
            let state = Memory::new::<u64>(mslip_element_state_length(1, 1000));
            let (n, least) = (state.bytes / 8, law.memory_length(call, "state"));
            assert_eq!(unsafe { mslip_element_state_init(other.directions, n, state.start.cast()) }, MSLIP_OK);
            Some(state.values::<u64>()[..least].repeat(call.items()))
        }
        Workspace if call.has(Element) && !(call.has(Index) && other.directions == 2) => {
            Some(other.workspace(call).values::<u64>().to_vec())
        }
        _ => None,
    };
    if let Some(words) = foreign {
        rejected_with(call, arguments, place, &words, MSLIP_BAD_DIRECTIONS);
    }
}

/// An item that is not active is neither checked nor written.
#[test]
fn skipped_items() {
    for_each_call(|call, law| {
        let (Some(index), Some(active)) = (call.place(Index), call.place(Active)) else { return };
        // The last item is skipped: its contact is uninitialised, its index invalid, and its values NaN.
        for with_index in [false, true] {
            let mut arguments = Arguments::new(call, law, Before::Filled);
            arguments.memory_mut(active).values_mut().copy_from_slice(&[1, -1, 0]);
            arguments.memory_mut(index).values_mut().copy_from_slice(&[1, 0, -1]);
            if !with_index {
                arguments.omit(index);
            }
            for kind in [Contact, Element, State, Input] {
                places(call, kind).for_each(|place| {
                    let values = arguments.memory_mut(place).values_mut::<u64>();
                    let last = values.len() / N * (N - 1);
                    values[last..].fill(u64::MAX);
                });
            }
            assert_eq!(call.make(&arguments.slots), MSLIP_OK, "{}", call.name);
            for place in places(call, Output).chain(places(call, NewState)) {
                let bytes = arguments.memory(place).values::<u8>();
                let (written, last) = bytes.split_at(bytes.len() / N * (N - 1));
                assert!(last.iter().all(|byte| *byte == FILLED), "{}: a skipped item is written", call.name);
                let is_written = |value: &[u8]| value.iter().any(|byte| *byte != FILLED);
                assert!(call.arguments[place].kind != Output || written.chunks(8).all(is_written), "{}", call.name);
            }
            // Without flags its contact is invalid.
            arguments.omit(active);
            let law = call.place(Contact).or(call.place(Element)).expect("a batch of laws");
            let status = if with_index { MSLIP_BAD_INDEX } else { call.arguments[law].status };
            rejected_as(call, &arguments, status, "an invalid item");
        }
    });
}

#[test]
fn versions_and_messages() {
    // SAFETY: static strings.
    let text = |pointer: *const _| unsafe { CStr::from_ptr(pointer) }.to_str().unwrap().to_owned();
    assert_eq!(text(mslip_version()), env!("CARGO_PKG_VERSION"));
    assert_eq!(mslip_abi_version(), MSLIP_ABI_VERSION);
    let messages: HashSet<String> = (0..1000).map(|status| text(mslip_status_text(status))).collect();
    assert_eq!(messages.len(), microslip::Error::ALL.len() + 2);
    assert!([-1, 1000, i32::MIN, i32::MAX].iter().all(|status| messages.contains(&text(mslip_status_text(*status)))));
}

/// These have no status and write to any address; the parameters are unset then.
#[test]
fn default_parameters() {
    let (p, e) = (Memory::of(&[FLAT; 2]), Memory::of(&[SPHERE; 2]));
    let contact = Memory::new::<mslip_contact>(1);
    unsafe {
        mslip_parameters_default(null_mut());
        mslip_elliptic_parameters_default(null_mut());
        mslip_parameters_default(p.misaligned().cast());
        mslip_elliptic_parameters_default(e.misaligned().cast());
        mslip_parameters_default(p.start.cast());
        mslip_elliptic_parameters_default(e.start.cast());
        assert_eq!(mslip_contact_init(p.start.cast(), contact.start.cast()), MSLIP_BAD_FLAT_HALF_WIDTH);
        assert_eq!(mslip_contact_init_elliptic(e.start.cast(), contact.start.cast()), MSLIP_BAD_SEMI_AXIS_X);
        let implausible = Memory::of(&[microslip::Parameters { friction_coefficient: 45.0, ..FLAT }]);
        for (p, i, starts) in [(implausible.start, 0, true), (implausible.start, 1, false), (p.start, 0, false)] {
            let text = mslip_parameters_warning(p.cast(), i);
            assert_eq!(!text.is_null() && CStr::from_ptr(text).to_bytes().starts_with(b"friction_coefficient"), starts);
        }
        mslip_parameters_warning(p.misaligned().cast(), 0);
        assert!(mslip_elliptic_parameters_warning(null_mut(), -1).is_null());
    }
}

fn call(name: &str) -> &'static Call {
    CALLS.iter().find(|call| call.name == name).expect("a function")
}

/// A path gives the results of its steps: nested reversals or pieces, slip, gross slip, separation, also with less capacity.
#[test]
fn paths() {
    const PATH: [[f64; 2]; 10] = [
        [0.9, 0.2],
        [-0.5, 0.4],
        [0.4, 0.5],
        [0.1, 0.7],
        [0.2, 0.8],
        [-0.6, 0.9],
        [0.3, 0.6],
        [2.0, 0.7],
        [1.0, 0.0],
        [1.1, 0.5],
    ];
    let motion = |law: &Law, of_element: bool, [u, w]: [f64; 2]| match (of_element, law.directions) {
        (false, _) => vec![u * law.displacement],
        (true, 1) => vec![u * law.displacement, w * law.normal],
        (true, _) => vec![u * law.displacement, -0.4 * u * law.displacement, w * law.normal],
    };
    for (update, path) in [("mslip_masing_update", "mslip_masing_path"), ("mslip_element_update", "mslip_element_path")]
    {
        let (update, path) = (call(update), call(path));
        let place = |call: &Call, kind| call.place(kind).expect("an argument");
        for law in Law::all(update) {
            let of_element = update.is_of_element();
            let start: Vec<f64> = law.state(update).values().to_vec();
            let (mut steps, mut state) = (Vec::new(), start.clone());
            let mut expected = vec![vec![]; places(update, Output).count()];
            for step in PATH {
                let step = motion(&law, of_element, step);
                let mut arguments = Arguments::new(update, &law, Before::Uninitialised);
                [State, NewState].into_iter().for_each(|kind| arguments.set(place(update, kind), Memory::of(&state)));
                if of_element {
                    arguments.set(place(update, Input), Memory::of(&step));
                } else {
                    arguments.slots[place(update, Value)] = Slot::Value(step[0]);
                }
                assert_eq!(update.make(&arguments.slots), MSLIP_OK);
                expected.iter_mut().zip(results(update, &arguments)).for_each(|(all, one)| all.extend(one));
                state = arguments.memory(place(update, NewState)).values().to_vec();
                steps.extend(step);
            }
            let mut arguments = Arguments::new(path, &law, Before::Uninitialised);
            [State, NewState].into_iter().for_each(|kind| arguments.set(place(path, kind), Memory::of(&start)));
            arguments.slots[place(path, Count)] = Slot::Size(PATH.len());
            arguments.set(place(path, Input), Memory::of(&steps));
            for output in places(path, Output) {
                let share = law.length(path.arguments[output].extents, of_element) / N;
                arguments.set(output, Memory::new::<f64>(share * PATH.len()));
            }
            assert_eq!(path.make(&arguments.slots), MSLIP_OK);
            assert_eq!(results(path, &arguments), expected);
            let new = place(path, NewState);
            assert_eq!(arguments.memory(new).values::<f64>()[1..3], state[1..3]);
            arguments.omit(new);
            assert_eq!(path.make(&arguments.slots), MSLIP_OK);
        }
    }
}

/// Slip with springs, with all outputs.
#[test]
fn slip_in_two_directions() {
    let law = calls::element(true, |element| unsafe {
        mslip_element_init_elliptic(&raw const SPHERE, 2, MSLIP_INPUT_APPROACH, element)
    });
    let path = call("mslip_element_path");
    let [u, w] = [law.displacement, law.normal];
    let mut arguments = Arguments::new(path, &law, Before::Uninitialised);
    arguments.set(4, Memory::of(&[0.0, 0.0, w, 0.3 * u, 0.1 * u, w, 0.6 * u, -0.4 * u, 0.8 * w]));
    assert_eq!(path.make(&arguments.slots), MSLIP_OK);
    let energy = results(path, &arguments)[2][2];
    assert!(f64::from_bits(energy) > 0.0);
}

/// Constant, in microslip with all and with odd harmonics only, and in gross slip; with normal motions with and without separation;
/// even and odd numbers of samples.
#[test]
fn harmonic_motions() {
    for call in CALLS.iter().filter(|call| call.has(Workspace) && call.has(Output) && !call.has(Index)) {
        for law in Law::all(call) {
            for (motion, samples) in [
                ([0.0, 0.0, 0.0, 0.5, 0.0], 8),
                ([0.1, 0.5, 0.2, 0.5, 0.3], SAMPLES),
                ([0.0, 0.6, 0.3, 0.2, 0.6], 8),
                ([0.2, 9.0, 1.0, -0.7, 0.6], SAMPLES),
            ] {
                let mut arguments = Arguments::new(call, &law, Before::Uninitialised);
                let (n, workspace) = (2 * HARMONICS + 1, arguments.memory(1));
                let (length, start) = (workspace.bytes / 8, workspace.start.cast());
                let status = if call.has(Element) {
                    unsafe { mslip_element_workspace_init(law.directions, 1, samples, law.rule, 0, length, start) }
                } else {
                    unsafe { mslip_harmonic_workspace_init(1, samples, law.rule, length, start) }
                };
                assert_eq!(status, MSLIP_OK);
                let mut values: Vec<f64> = motion[..n].iter().map(|part| part * law.displacement).collect();
                if call.has(Element) {
                    values.resize(n * law.directions as usize, 0.1 * law.displacement);
                    values.extend([motion[3] * law.normal, motion[4] * law.normal, 0.0]);
                }
                arguments.set(2, Memory::of(&values));
                let by_force = call.has(Element) && law.normal_input == MSLIP_INPUT_NORMAL_FORCE;
                let is_negative = by_force && motion[4] > motion[3];
                let expected = if is_negative { MSLIP_BAD_NORMAL_FORCE } else { MSLIP_OK };
                assert_eq!(call.make(&arguments.slots), expected, "{}: {motion:?}", call.name);
                if !is_negative {
                    results(call, &arguments);
                }
            }
        }
    }
}

/// Any allowed number of periods, with one direction the same bits; the size call returns it.
#[test]
fn periods() {
    let call = call("mslip_element_harmonic_force");
    for law in Law::all(call) {
        let mut expected = None;
        for periods in [0, 1, 3, 1 << 16] {
            if periods > 3 && law.directions == 2 {
                continue;
            }
            let arguments = Arguments::new(call, &law, Before::Uninitialised);
            let (workspace, drift) = (arguments.memory(1), arguments.memory(call.arguments.len() - 1));
            let (length, start) = (workspace.bytes / 8, workspace.start.cast());
            let (h, s, rule, mut found) = (HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING, 0);
            unsafe {
                assert_eq!(mslip_element_workspace_init(law.directions, h, s, rule, periods, length, start), MSLIP_OK);
                let (none, no_size) = (null_mut(), null_mut());
                assert_eq!(mslip_element_workspace_size(start, none, no_size, no_size, none, &raw mut found), MSLIP_OK);
            }
            let default = if law.directions == 2 { 3 } else { 1 };
            assert_eq!(found, if periods == 0 { default } else { periods });
            assert_eq!(call.make(&arguments.slots), MSLIP_OK);
            let results = results(call, &arguments);
            if law.directions == 1 {
                assert_eq!(drift.values::<f64>(), [0.0]);
                assert_eq!(expected.get_or_insert_with(|| results.clone()), &results);
            }
        }
    }
}

/// Contacts are only read: threads share one, each with memory of its own.
#[test]
fn threads_share_a_contact() {
    let [contact, ..] = calls::contacts();
    let contact = Memory::of_law(contact, 1);
    // SAFETY: the contact lives until the threads are joined.
    let shared: &'static mslip_contact = unsafe { &*contact.start.cast() };
    let threads = [0.4, 0.8].map(|part| {
        std::thread::spawn(move || {
            let [law, ..] = calls::contacts();
            let (u, none) = (part * shared.slip_displacement, null_mut());
            let force = call("mslip_harmonic_force");
            let arguments = Arguments::new(force, law, Before::Uninitialised);
            let state = law.state(call("mslip_masing_update"));
            let s = state.start.cast();
            unsafe {
                let (workspace, coefficients) = (arguments.slots[1].get(), [0.0, u, 0.0]);
                let mut result = [0.0; 3];
                let (c, f) = (coefficients.as_ptr(), result.as_mut_ptr());
                assert_eq!(mslip_harmonic_force(shared, workspace, c, f, none, none), MSLIP_OK);
                assert_eq!(mslip_masing_update(shared, state.bytes / 8, s, u, s, none, none, none), MSLIP_OK);
                assert_eq!(mslip_contact_check(null()), MSLIP_NULL_POINTER);
                result[1] > 0.0
            }
        })
    });
    for thread in threads {
        assert!(thread.join().unwrap());
    }
}
