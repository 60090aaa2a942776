//! Every call of the C interface, by a table, with memory of exact length: each array is an allocation of its own, and outputs are
//! uninitialised.
//!
//! No call raises a floating-point exception that an application may trap. Under Miri (`tools/miri.sh`) every access outside an
//! array, read of uninitialised memory, misaligned access and use of an invalidated reference is an error.

#![allow(
    clippy::undocumented_unsafe_blocks,
    reason = "all calls: each pointer is rejected or valid for the length that is passed"
)]

mod calls;
#[cfg(not(miri))]
mod common;
#[cfg(not(miri))]
#[path = "ffi/memory.rs"]
mod memory;
#[cfg(not(miri))]
#[path = "ffi/values.rs"]
mod values;

use calls::Kind::*;
use calls::{Arguments, CALLS, Call, FILLED, FLAT, Kind, Law, Memory, N, SPHERE, Slot};
use microslip::ffi::*;
use std::collections::HashSet;
use std::ffi::CStr;
use std::ptr::null_mut;

fn is_available(call: &Call, law: &Law) -> bool {
    !(call.flat && law.is_elliptic || call.one_direction && law.directions == 2)
}

/// Each call with the first law of each number of directions and rule of a workspace: what is rejected depends on no more. Under
/// Miri with the first one.
fn for_each_call(test: impl Fn(&Call, &Law, Arguments)) {
    for call in CALLS {
        let laws = Law::all(call);
        let is_first = |(place, law): &(usize, &Law)| {
            laws[..*place].iter().all(|other| (other.directions, other.rule) != (law.directions, law.rule))
        };
        let first = laws.iter().enumerate().filter(is_first).map(|(_, law)| law);
        let few = if cfg!(miri) { 1 } else { usize::MAX };
        first
            .filter(|law| is_available(call, law))
            .take(few)
            .for_each(|law| test(call, law, Arguments::new(call, law)));
    }
}

/// Under Miri the bisection for a contact with friction takes minutes, as do contacts and elements, which the arguments of
/// other calls have initialised.
fn is_slow(call: &Call, law: &Law) -> bool {
    let is_made = call.has(NewContact) || call.has(NewElement);
    cfg!(miri) && (is_made || call.is_sliders() && law.force > 0.0)
}

fn bytes(arguments: &Arguments) -> Vec<Vec<u8>> {
    arguments.memory.iter().flatten().map(|memory| memory.values().to_vec()).collect()
}

/// A failed item that is not written.
const UNWRITTEN: usize = usize::from_ne_bytes([FILLED; size_of::<usize>()]);

/// The failed item of a batch, which is set to another value; `None` if it is no argument.
fn take_failed_item(call: &Call, arguments: &Arguments) -> Option<usize> {
    let memory = arguments.memory(call.place(FailedItem)?);
    let failed = memory.values::<usize>()[0];
    memory.fill(FILLED);
    Some(failed)
}

/// The failed item of a batch that was rejected is rejected alone, and those before it are accepted. It is n if the call is
/// rejected without any item.
fn check_failed_item(call: &Call, arguments: &Arguments, failed: usize, status: i32, what: &str) {
    let [active, output, count] = [Active, FailedItem, Count].map(|kind| call.place(kind).expect("an argument"));
    let (start, n) = (arguments.memory(output).start, arguments.slots[count].get::<usize>());
    if status == MSLIP_OK || arguments.slots[output].pointer() != Some(start) {
        assert_eq!(failed, UNWRITTEN, "{}: {what}", call.name);
        return;
    }
    let before = bytes(arguments);
    let status_of = |is_active: &dyn Fn(usize) -> bool, output_of_item: *mut u8| {
        let flags = Memory::of(&(0..N).map(|i| i32::from(is_active(i))).collect::<Vec<_>>());
        let mut slots = arguments.slots.clone();
        slots[output] = Slot::Pointer(output_of_item);
        if status != MSLIP_BAD_ALIGNMENT {
            slots[active] = Slot::Pointer(flags.start);
        }
        call.make(&slots)
    };
    // The length of states is checked with each state, but belongs to no item.
    let of_call = status == MSLIP_STATE_TOO_SHORT || status_of(&|_| false, null_mut()) == status;
    assert_eq!(failed == n, of_call, "{}: {what}: failed item {failed}", call.name);
    if !of_call {
        assert!(failed < n, "{}: {what}: failed item {failed}", call.name);
        assert_eq!(status_of(&|i| i == failed, null_mut()), status, "{}: {what}: item {failed}", call.name);
        assert_eq!(status_of(&|i| i < failed, start), MSLIP_OK, "{}: {what}: before item {failed}", call.name);
    }
    for (memory, before) in arguments.memory.iter().flatten().zip(before) {
        // SAFETY: valid for the bytes.
        unsafe { memory.start.copy_from_nonoverlapping(before.as_ptr(), before.len()) };
    }
    assert!(take_failed_item(call, arguments).is_some());
}

/// Rejected with this status, and no memory is modified.
fn rejected_as(call: &Call, arguments: &Arguments, status: i32, what: &str) {
    take_failed_item(call, arguments);
    let before = bytes(arguments);
    assert_eq!(call.make(&arguments.slots), status, "{}: {what}", call.name);
    if let Some(failed) = take_failed_item(call, arguments) {
        check_failed_item(call, arguments, failed, status, what);
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
                rejected_as(call, &Arguments::new(call, &law), MSLIP_NOT_AVAILABLE, "not available");
                continue;
            }
            if is_slow(call, &law) {
                continue;
            }
            let all = Arguments::uninitialised(call, &law);
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
                let mut some = Arguments::uninitialised(call, &law);
                let left_out = omitted.iter().enumerate().filter(|(i, _)| subset >> i & 1 == 0);
                left_out.for_each(|(_, place)| some.omit(*place));
                assert_eq!(call.make(&some.slots), MSLIP_OK, "{}", call.name);
                let of_all = places(call, Output).zip(&expected).filter(|(place, _)| !is_null(some.slots[*place]));
                assert!(results(call, &some).iter().eq(of_all.map(|(_, values)| values)), "{}: {subset:b}", call.name);
            }
            if let (Some(old), Some(new)) = (call.place(State), call.place(NewState)) {
                let mut in_place = Arguments::uninitialised(call, &law);
                in_place.slots[new] = in_place.slots[old];
                assert_eq!(call.make(&in_place.slots), MSLIP_OK, "{}", call.name);
                assert_eq!(results(call, &in_place), expected, "{}", call.name);
                let [old, new] = [in_place.memory(old), all.memory(new)].map(|state| &state.values::<u64>()[..3]);
                assert_eq!(old, new, "{}", call.name);
            }
        }
    }
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
    for_each_call(|call, law, mut arguments| {
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
                Workspace | Parameters => false,
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
    if !matches!(argument.kind, Contact | Element | State | Workspace) {
        return;
    }
    let words = arguments.memory(place).values::<u64>().to_vec();
    let header = match argument.kind {
        Workspace => 8,
        _ => words.len(),
    };
    for byte in [0, 0x77_77_77_77_77_77_77_77, u64::MAX] {
        rejected_with(call, arguments, place, &vec![byte; header], argument.status);
    }
    #[cfg(not(miri))]
    memory::invalid_headers(call, law, arguments, place, &words);
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
    for_each_call(|call, law, _| {
        let (Some(index), Some(active)) = (call.place(Index), call.place(Active)) else { return };
        // The last item is skipped: its contact is uninitialised, its index invalid, and its values NaN.
        for with_index in [false, true] {
            let mut arguments = Arguments::new(call, law);
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
            assert_eq!(take_failed_item(call, &arguments), Some(UNWRITTEN));
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
    const MOST_STATUS: i32 = 200;
    // SAFETY: static strings.
    let text = |pointer: *const _| unsafe { CStr::from_ptr(pointer) }.to_str().unwrap().to_owned();
    assert_eq!(text(mslip_version()), env!("CARGO_PKG_VERSION"));
    assert_eq!(mslip_abi_version(), MSLIP_ABI_VERSION);
    let messages: HashSet<String> = (0..MOST_STATUS).map(|status| text(mslip_status_text(status))).collect();
    assert_eq!(messages.len(), microslip::Error::ALL.len() + 2);
    assert!(
        [-1, MOST_STATUS, i32::MIN, i32::MAX].iter().all(|status| messages.contains(&text(mslip_status_text(*status))))
    );
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

#[cfg(not(miri))]
fn call(name: &str) -> &'static Call {
    CALLS.iter().find(|call| call.name == name).expect("a function")
}
