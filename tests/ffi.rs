//! Every call of the C interface, by a table, with memory of exact length: each array is an allocation of its own, and outputs are
//! uninitialised.
//!
//! Under Miri (`tools/miri.sh`) every access outside an array, read of uninitialised memory, misaligned access, use of an
//! invalidated reference and race between threads is an error.

#![allow(
    clippy::undocumented_unsafe_blocks,
    reason = "all calls: each pointer is rejected or valid for the length that is passed"
)]

mod calls;

use calls::Kind::*;
use calls::{
    Argument, Arguments, Before, CALLS, Call, FILLED, FLAT, HARMONICS, Kind, Law, Memory, N, SAMPLES, SPHERE, Slot,
};
use microslip::ffi::*;
use std::ffi::CStr;
use std::ptr::{null, null_mut};

/// Each call with each law for which it is available.
fn for_each_call(test: impl Fn(&Call, &Law)) {
    for call in CALLS {
        Law::all(call).iter().filter(|law| is_available(call, law)).for_each(|law| test(call, law));
    }
}

fn is_available(call: &Call, law: &Law) -> bool {
    !(call.flat && law.is_elliptic || call.one_direction && law.directions == 2)
}

/// Under Miri the bisection for a contact with friction takes minutes.
fn is_slow(call: &Call, law: &Law) -> bool {
    cfg!(miri) && call.is_sliders() && law.force > 0.0
}

fn bytes(arguments: &Arguments) -> Vec<Vec<u8>> {
    arguments.memory.iter().flatten().map(|memory| memory.values().to_vec()).collect()
}

/// Rejected with this status, and no memory is modified.
fn rejected_as(call: &Call, arguments: &Arguments, status: i32, what: &str) {
    let before = bytes(arguments);
    assert_eq!((call.function)(&arguments.slots), status, "{}: {what}", call.name);
    // Whether the normal motion of an element is allowed depends on samples in the workspace.
    let by_samples = call.has(Workspace) && matches!(status, MSLIP_LENGTH_TOO_SHORT | MSLIP_BAD_NORMAL_FORCE);
    assert!(by_samples || bytes(arguments) == before, "{}: {what}: memory is modified", call.name);
}

/// Rejected if an argument is changed.
fn rejected(call: &Call, law: &Law, status: i32, what: &str, change: impl Fn(&mut Arguments)) {
    let mut arguments = Arguments::new(call, law, Before::Filled);
    change(&mut arguments);
    rejected_as(call, &arguments, status, what);
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
                rejected(call, &law, MSLIP_NOT_AVAILABLE, "not available", |_| {});
                continue;
            }
            if is_slow(call, &law) {
                continue;
            }
            let all = Arguments::new(call, &law, Before::Uninitialised);
            assert_eq!((call.function)(&all.slots), MSLIP_OK, "{}", call.name);
            let expected = results(call, &all);
            check_initialised(call, &all);
            let optional: Vec<usize> =
                (0..call.arguments.len()).filter(|place| !call.arguments[*place].kind.is_required()).collect();
            // The C drivers request every subset; Miri takes too long.
            let alone = if cfg!(miri) { &[][..] } else { &optional[..] };
            for requested in alone.iter().map(Some).chain([None]) {
                let mut some = Arguments::new(call, &law, Before::Uninitialised);
                let omitted = optional.iter().filter(|place| Some(*place) != requested);
                omitted.filter(|place| call.arguments[**place].kind != Index).for_each(|place| some.omit(*place));
                assert_eq!((call.function)(&some.slots), MSLIP_OK, "{}", call.name);
                let kept = places(call, Output).zip(&expected).filter(|(place, _)| !is_null(some.slots[*place]));
                assert!(results(call, &some).iter().eq(kept.map(|(_, bits)| bits)), "{}", call.name);
            }
            if let (Some(old), Some(new)) = (call.place(State), call.place(NewState)) {
                let mut in_place = Arguments::new(call, &law, Before::Uninitialised);
                in_place.slots[new] = in_place.slots[old];
                assert_eq!((call.function)(&in_place.slots), MSLIP_OK, "{}", call.name);
                assert_eq!(results(call, &in_place), expected, "{}", call.name);
                let [old, new] = [in_place.memory(old), all.memory(new)].map(|state| &state.values::<u64>()[..3]);
                assert_eq!(old, new, "{}", call.name);
            }
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

#[test]
fn pointers() {
    for_each_call(|call, law| {
        for (place, argument) in call.arguments.iter().enumerate() {
            if Arguments::new(call, law, Before::Filled).memory[place].is_none() {
                continue;
            }
            rejected(call, law, MSLIP_BAD_ALIGNMENT, argument.name, |arguments| {
                arguments.slots[place] = Slot::Pointer(arguments.memory(place).misaligned());
            });
            if argument.kind.is_required() {
                rejected(call, law, MSLIP_NULL_POINTER, argument.name, |arguments| arguments.omit(place));
            }
        }
    });
}

/// Lengths and counts beyond the address space, and below what is needed; arrays of no items may be NULL.
#[test]
fn lengths() {
    for_each_call(|call, law| {
        for (place, argument) in call.arguments.iter().enumerate() {
            let rejected_at = |status, sizes: &[usize]| {
                for &size in sizes {
                    rejected(call, law, status, argument.name, |arguments| arguments.slots[place] = Slot::Size(size));
                }
            };
            let too_long = [usize::MAX, usize::MAX / 2 + 1, usize::MAX / 8];
            match argument.kind {
                Count if call.is_sliders() => {
                    rejected_at(MSLIP_BAD_COUNT, &[0, 1 << 20, usize::MAX / 16]);
                    rejected_at(MSLIP_BAD_ARRAY_SIZE, &too_long);
                }
                Count => {
                    rejected_at(MSLIP_BAD_ARRAY_SIZE, &too_long);
                    let mut none = Arguments::new(call, law, Before::Filled);
                    none.slots[place] = Slot::Size(0);
                    places(call, Laws).for_each(|place| none.slots[place] = Slot::Size(0));
                    let of_items = |argument: &Argument| match argument.kind {
                        Contact | Element | State => call.has(Index),
                        Workspace | Table => false,
                        _ => true,
                    };
                    let arrays = (0..none.slots.len()).filter(|place| none.slots[*place].pointer().is_some());
                    let arrays: Vec<usize> = arrays.filter(|place| of_items(&call.arguments[*place])).collect();
                    arrays.into_iter().for_each(|place| none.omit(place));
                    rejected_as(call, &none, MSLIP_OK, "no items");
                }
                Laws => rejected_at(MSLIP_BAD_ARRAY_SIZE, &too_long),
                Length => {
                    rejected_at(MSLIP_BAD_ARRAY_SIZE, &too_long[..2]);
                    let least: usize = Arguments::new(call, law, Before::Filled).slots[place].get();
                    for length in [0, 1, 5, least - 1] {
                        rejected(call, law, argument.status, argument.name, |arguments| {
                            arguments.slots[place] = Slot::Size(length);
                            for kind in [State, Buffer] {
                                places(call, kind).for_each(|array| {
                                    let short = arguments.memory(array).values::<f64>()[..length].to_vec();
                                    arguments.set(array, Memory::of(&short));
                                });
                            }
                        });
                    }
                }
                Kind::Size if argument.name == "harmonics" => {
                    rejected_at(argument.status, &[0, (1 << 24) + 1, usize::MAX, usize::MAX / 2 + 1]);
                }
                Kind::Size if argument.name == "periods" => {
                    rejected_at(argument.status, &[(1 << 16) + 1, usize::MAX]);
                }
                Kind::Size => {
                    rejected_at(argument.status, &[0, 2 * HARMONICS, (1 << 24) + 1, usize::MAX, usize::MAX / 2 + 1]);
                }
                _ => {}
            }
        }
    });
}

#[test]
fn choices() {
    for_each_call(|call, law| {
        for (place, argument) in call.arguments.iter().enumerate().filter(|(_, argument)| argument.kind == Choice) {
            let least_invalid = if argument.name == "directions" { [0, 3] } else { [-1, 2] };
            for choice in least_invalid.into_iter().chain([i32::MIN, i32::MAX]) {
                rejected(call, law, argument.status, argument.name, |arguments| {
                    arguments.slots[place] = Slot::Choice(choice);
                });
            }
            if argument.name == "rule" && call.is_of_element() {
                rejected(call, law, MSLIP_NOT_AVAILABLE, "rule", |arguments| {
                    arguments.slots[place] = Slot::Choice(MSLIP_EVENT_DRIVEN);
                });
            }
        }
    });
}

/// The invalid values of a quantity, and their status.
fn invalid(call: &Call, law: &Law, argument: &Argument, i: usize) -> Vec<(f64, i32)> {
    let by_force = law.normal_input == MSLIP_INPUT_NORMAL_FORCE && !argument.extents.contains('k');
    let is_normal_force = law.is_normal(call, argument, i) && by_force;
    let status = if is_normal_force { MSLIP_BAD_NORMAL_FORCE } else { argument.status };
    let mut values: Vec<(f64, i32)> = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY].map(|value| (value, status)).into();
    match if is_normal_force { "normal_force" } else { argument.name } {
        "force" => values.push((law.force + 1e9, MSLIP_FORCE_EXCEEDS_SLIP)),
        "force_amplitude" => values.extend([(-1.0, status), (law.force + 1e9, MSLIP_FORCE_EXCEEDS_SLIP)]),
        "normal_force" | "amplitude" => values.extend([(-1.0, status), (1e151, status)]),
        "displacement" | "approach" => values.extend([(1e151, status), (-1e151, status)]),
        _ => {}
    }
    values
}

#[test]
#[cfg_attr(miri, ignore = "takes long, and rejects values before any memory is used")]
fn values() {
    for_each_call(|call, law| {
        for (place, argument) in call.arguments.iter().enumerate() {
            if argument.kind == Value {
                for (value, status) in invalid(call, law, argument, 0) {
                    rejected(call, law, status, argument.name, |arguments| arguments.slots[place] = Slot::Value(value));
                }
            }
            let count = if argument.kind == Input { law.length(argument.extents, call.has(Element)) } else { 0 };
            for i in 0..count {
                for (value, status) in invalid(call, law, argument, i) {
                    rejected(call, law, status, argument.name, |arguments| {
                        arguments.memory_mut(place).values_mut()[i] = value;
                    });
                }
            }
        }
    });
}

/// Uninitialised, truncated or foreign contacts, elements, states, workspaces and tables. Nothing is read after an invalid header.
#[test]
fn memory() {
    for_each_call(|call, law| {
        for (place, argument) in call.arguments.iter().enumerate() {
            let change = |change: &dyn Fn(&mut Arguments)| rejected(call, law, argument.status, argument.name, change);
            let words = |words: &[f64]| change(&|arguments| arguments.set(place, Memory::of(words)));
            match argument.kind {
                Contact | Element => {
                    [0, 0xff].iter().for_each(|byte| change(&|arguments| arguments.memory(place).fill(*byte)));
                    change(&|arguments| {
                        // The tag of the last item.
                        let values = arguments.memory_mut(place).values_mut::<f64>();
                        let size = law.bytes.len() / 8;
                        values[call.items() * size - size + if argument.kind == Contact { 6 } else { 8 }] = 0.0;
                    });
                }
                State => {
                    [0, 0x5a, 0xff].iter().for_each(|byte| change(&|arguments| arguments.memory(place).fill(*byte)));
                    let of_two = call.is_of_element() && law.directions == 2;
                    let counts = if call.is_of_element() { [5, -1] } else { [3, 1 << 32] };
                    for count in if of_two { &[][..] } else { &counts[..] } {
                        change(&|arguments| {
                            let tag = &mut arguments.memory_mut(place).values_mut::<u64>()[0];
                            *tag = tag.wrapping_add_signed(*count);
                        });
                    }
                }
                Workspace => {
                    let header = law.workspace(call).values::<f64>()[..3].to_vec();
                    for (word, value) in [(0, 0.0), (0, f64::NAN), (1, 0.5), (1, f64::NAN), (1, -1.0), (2, 0.0)] {
                        let mut header = header.clone();
                        header[word] = value;
                        words(&header);
                    }
                }
                Table => [0.0, f64::NAN].into_iter().for_each(|tag| words(&[tag])),
                _ => {}
            }
            // Of the other number of directions; a state that is long enough for both.
            let of_element = call.is_of_element() && is_law_in_use(call);
            let other = Law { directions: 3 - law.directions, ..law.clone() };
            let foreign = match argument.kind {
                State if of_element => {
                    let one = Memory::new::<f64>(mslip_element_state_length(1, 1000));
                    let n = one.bytes / 8;
                    assert_eq!(unsafe { mslip_element_state_init(other.directions, n, one.start.cast()) }, MSLIP_OK);
                    let least = law.memory_length(call, "state");
                    (n >= least).then(|| Memory::of(&one.values::<u64>()[..least].repeat(call.items())))
                }
                // The arrays of a batch have the lengths of its workspace: a longer one would exceed them.
                Workspace if of_element && call.has(Element) && !(call.has(Index) && other.directions == 2) => {
                    Some(other.workspace(call))
                }
                _ => None,
            };
            if let Some(foreign) = foreign {
                let foreign = foreign.values::<u64>().to_vec();
                rejected(call, law, MSLIP_BAD_DIRECTIONS, "other directions", |arguments| {
                    arguments.set(place, Memory::of(&foreign));
                });
            }
        }
    });
}

fn is_law_in_use(call: &Call) -> bool {
    call.has(Element) || call.has(Choice)
}

/// Any changed bit of a contact or an element, and values of a state that are not possible.
#[test]
fn checks() {
    for call in CALLS.iter().filter(|call| call.name.ends_with("_check")) {
        for law in Law::all(call) {
            let argument = call.arguments.len() - 1;
            let status = call.arguments[argument].status;
            let memory = Arguments::new(call, &law, Before::Filled).memory(argument).values::<u64>().to_vec();
            let is_state = call.has(State);
            let places = if is_state { (1..5).collect() } else { vec![0, 7, 50, memory.len() - 8, memory.len() - 1] };
            for place in places {
                rejected(call, &law, status, "a changed value", |arguments| {
                    let word = &mut arguments.memory_mut(argument).values_mut::<u64>()[place];
                    *word = if is_state { f64::NAN.to_bits() } else { *word ^ 1 << 20 };
                });
            }
        }
    }
}

/// Invalid indices. An item that is not active is neither checked nor written.
#[test]
fn batches() {
    for_each_call(|call, law| {
        let (Some(index), Some(active)) = (call.place(Index), call.place(Active)) else { return };
        for bad in [-1, N as i32, i32::MAX, i32::MIN] {
            rejected(call, law, MSLIP_BAD_INDEX, "index", |arguments| {
                arguments.memory_mut(index).values_mut()[N - 1] = bad;
            });
        }
        rejected(call, law, MSLIP_BAD_INDEX, "fewer contacts than items", |arguments| {
            arguments.omit(index);
            arguments.slots[1] = Slot::Size(N - 1);
        });
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
            assert_eq!((call.function)(&arguments.slots), MSLIP_OK, "{}", call.name);
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

/// Elements with different numbers of directions, unless those of another number are skipped.
#[test]
fn batches_of_different_directions() {
    let [one, _, two] = calls::elements();
    for call in CALLS.iter().filter(|call| call.has(Index) && call.has(Element)) {
        let mut arguments = Arguments::new(call, two, Before::Filled);
        let size = one.bytes.len();
        arguments.memory_mut(2).values_mut::<u8>()[2 * size..].copy_from_slice(&one.bytes);
        arguments.memory_mut(3).values_mut().copy_from_slice(&[0, 1, 2]);
        rejected_as(call, &arguments, MSLIP_BAD_DIRECTIONS, "different directions");
        arguments.memory_mut(4).values_mut().copy_from_slice(&[1, 1, 0]);
        assert_eq!((call.function)(&arguments.slots), MSLIP_OK);
    }
}

#[test]
fn versions_and_messages() {
    // SAFETY: static strings.
    let text = |pointer: *const _| unsafe { CStr::from_ptr(pointer) }.to_str().unwrap().to_owned();
    assert_eq!(text(mslip_version()), env!("CARGO_PKG_VERSION"));
    assert_eq!(mslip_abi_version(), MSLIP_ABI_VERSION);
    for status in [MSLIP_OK, MSLIP_NULL_POINTER, MSLIP_BAD_ARRAY_SIZE, -1, i32::MAX] {
        assert!(text(mslip_status_text(status)).len() >= "success".len());
    }
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
                assert_eq!((update.function)(&arguments.slots), MSLIP_OK);
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
            assert_eq!((path.function)(&arguments.slots), MSLIP_OK);
            assert_eq!(results(path, &arguments), expected);
            let new = place(path, NewState);
            assert_eq!(arguments.memory(new).values::<f64>()[1..3], state[1..3]);
            arguments.omit(new);
            assert_eq!((path.function)(&arguments.slots), MSLIP_OK);
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
    assert_eq!((path.function)(&arguments.slots), MSLIP_OK);
    let energy = results(path, &arguments)[2][2];
    assert!(f64::from_bits(energy) > 0.0);
}

/// Constant, in microslip with all and with odd harmonics only, and in gross slip; with normal motions with and without separation;
/// even and odd numbers of samples.
#[test]
fn harmonic_motions() {
    for call in CALLS.iter().filter(|call| call.has(Workspace) && call.has(Output) && !call.has(Index)) {
        for law in Law::all(call) {
            for motion in [
                [0.0, 0.0, 0.0, 0.5, 0.0],
                [0.1, 0.5, 0.2, 0.5, 0.3],
                [0.0, 0.6, 0.3, 0.2, 0.6],
                [0.2, 9.0, 1.0, -0.7, 0.6],
            ] {
                for samples in [8, SAMPLES] {
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
                    assert_eq!((call.function)(&arguments.slots), expected, "{}: {motion:?}", call.name);
                    if !is_negative {
                        results(call, &arguments);
                    }
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
            assert_eq!(found, periods.max(1));
            assert_eq!((call.function)(&arguments.slots), MSLIP_OK);
            let results = results(call, &arguments);
            if law.directions == 1 {
                assert_eq!(drift.values::<f64>(), [0.0]);
                assert_eq!(expected.get_or_insert_with(|| results.clone()), &results);
            }
        }
    }
}

/// The table of another shape.
#[test]
fn tables_of_other_contacts() {
    let [rounded, ellipse, _] = calls::contacts();
    let tabulated = call("mslip_complex_stiffness_tabulated");
    let own = Arguments::new(tabulated, rounded, Before::Filled);
    rejected(tabulated, ellipse, MSLIP_BAD_TABLE, "the table of a flat", |arguments| {
        arguments.set(1, Memory::of(own.memory(1).values::<f64>()));
    });
    let init = call("mslip_stiffness_table_init");
    rejected(init, rounded, MSLIP_BAD_CONTACT, "an uninitialised contact", |arguments| arguments.memory(0).fill(0));
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
