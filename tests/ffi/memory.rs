//! Memory that is not what it should be: flipped, shifted, mixed or foreign contacts, elements, states and workspaces;
//! states that are not finite or not nested; batches with invalid items; arbitrary bytes.

use super::values::NON_FINITE;
use super::*;
use calls::mutation::{Bytes, mutated_call};
use microslip::element::{Directions, Element, NormalInput};

/// Pseudorandom bytes, the same in every run.
fn pseudorandom(seed: u64, length: usize) -> Vec<u8> {
    let mut random = common::Random(seed);
    (0..length).map(|_| random.below(256) as u8).collect()
}

fn words(bytes: &[u8]) -> Vec<u64> {
    bytes.as_chunks().0.iter().map(|word| u64::from_le_bytes(*word)).collect()
}

fn laws() -> impl Iterator<Item = (&'static Call, &'static Law)> {
    let contacts = calls::contacts().iter().map(|law| (call("mslip_contact_check"), law));
    contacts.chain(calls::elements().iter().map(|law| (call("mslip_element_check"), law)))
}

/// Any changed bit of a contact or an element is found, and text that has changed it, but no copy.
#[test]
fn changed_contacts_and_elements() {
    for (check, law) in laws() {
        let mut arguments = Arguments::new(check, law);
        let status = check.arguments[0].status;
        let valid = arguments.memory(0).values::<u64>().to_vec();
        let mut expect = |words: &[u64], status: i32| {
            arguments.memory_mut(0).values_mut().copy_from_slice(words);
            assert_eq!(check.make(&arguments.slots), status);
        };
        expect(&valid, MSLIP_OK);
        let mut words = valid.clone();
        for bit in 0..64 * valid.len() {
            words[bit / 64] ^= 1 << (bit % 64);
            expect(&words, status);
            words[bit / 64] ^= 1 << (bit % 64);
        }
        for digits in 15..=17 {
            let text =
                |word: &u64| format!("{:.*e}", digits - 1, f64::from_bits(*word)).parse::<f64>().unwrap().to_bits();
            let text: Vec<u64> = valid.iter().map(text).collect();
            expect(&text, if text == valid { MSLIP_OK } else { status });
        }
        expect(&[&valid[1..], &valid[..1]].concat(), status);
        expect(&valid.iter().map(|word| word.swap_bytes()).collect::<Vec<_>>(), status);
    }
}

/// Shifted memory; counts and sizes that are not allowed; random bytes.
pub fn invalid_headers(call: &Call, law: &Law, arguments: &mut Arguments, place: usize, words: &[u64]) {
    let argument = &call.arguments[place];
    let mut expect = |words: &[u64]| rejected_with(call, arguments, place, words, argument.status);
    expect(&[&words[1..], &words[..1]].concat());
    match argument.kind {
        State if !(call.is_of_element() && law.directions == 2) => {
            let counts = [2000.0, 2f64.powi(32), 2f64.powi(52), 2f64.powi(60), -1.0].map(f64::to_bits);
            for count in counts.into_iter().chain(NON_FINITE) {
                expect(&[&words[..1], &[count], &words[2..]].concat());
            }
        }
        Workspace => {
            for sizes in [
                [0, 16, 1],
                [2, 0, 1],
                [2, 4, 1],
                [2, (1 << 24) + 1, 1],
                [(1 << 24) + 1, 1 << 24, 1],
                [2, 16, 0],
                [2, 16, (1 << 16) + 1],
            ] {
                expect(&[&words[..1], &sizes.map(|size| (size as f64).to_bits()), &words[4..]].concat());
            }
        }
        _ => {}
    }
    (0..20).for_each(|seed| expect(&self::words(&pseudorandom(seed, 8 * words.len()))));
}

pub fn check(law: &Law, of_element: bool, state: &Memory) -> i32 {
    let (n, s) = (state.bytes / 8, state.start.cast());
    unsafe { if of_element { mslip_element_state_check(law.directions, n, s) } else { mslip_state_check(n, s) } }
}

const REVERSALS: usize = 3;
const PIECES: usize = 5;

/// A long state with nested reversals or with pieces, and the length that is in use.
fn filled_state(law: &Law, of_element: bool) -> (Memory, usize) {
    if of_element {
        let length = mslip_element_state_length(law.directions, 50) + 9;
        let state = law.long_state(call("mslip_element_update"), length);
        for k in 0..PIECES {
            let u = 0.01 * law.displacement * if k % 2 == 0 { 1.0 } else { -1.0 };
            assert_eq!(law.step(true, &state, [u, 0.7 * u, law.normal * (0.1 + 0.15 * k as f64)]), MSLIP_OK);
        }
        (state, mslip_element_state_length(law.directions, PIECES))
    } else {
        let state = law.long_state(call("mslip_masing_update"), mslip_state_length(50));
        for k in 0..=REVERSALS {
            let part = 0.15 * (1.0 - 0.05 * k as f64) * if k % 2 == 0 { 1.0 } else { -1.0 };
            assert_eq!(law.step(false, &state, [part * law.displacement, 0.0, 0.0]), MSLIP_OK);
        }
        (state, mslip_state_length(REVERSALS))
    }
}

/// Takes a filled state, and a new one of NaN; returns the length in use.
pub fn set_filled_state(call: &Call, law: &Law, arguments: &mut Arguments, place: usize) -> usize {
    let (state, used) = filled_state(law, call.is_of_element());
    let length = call.arguments.iter().position(|argument| argument.kind == Length).expect("a length");
    arguments.slots[length] = Slot::Size(state.bytes / 8);
    call.place(NewState).inspect(|new| arguments.set(*new, Memory::of(&vec![f64::NAN; state.bytes / 8])));
    arguments.set(place, state);
    used
}

/// Own states are valid in every rounding mode, also with a layer of the smallest N_c: the loads of neighbouring knots differ by
/// the error of the polynomials of N(S), which is largest where two of them meet, at shifts S = 2^k (1 + q/4). Gross slip is at mu
/// S.
#[test]
fn states_with_layers_are_valid() {
    let update = call("mslip_element_update");
    let element = |layer: microslip::Layer| {
        let parameters = microslip::Parameters { layer, ..FLAT };
        (parameters, Element::rounded_flat(&parameters, Directions::One, NormalInput::Force).unwrap())
    };
    let stiffness = element(microslip::Layer::none()).1.tangential_stiffness;
    for share in 1..=8 {
        let compliance = f64::from(share) / stiffness;
        let (parameters, element) = element(microslip::Layer {
            normal_compliance: compliance,
            tangential_compliance: compliance,
            stiffening_load: 1e-3 * FLAT.normal_force,
            reference_load: 0.0,
        });
        let law = calls::element(false, |element| unsafe {
            mslip_element_init(&raw const parameters, 1, MSLIP_INPUT_NORMAL_FORCE, element)
        });
        let slip_under = |load: f64| element.displacement_under(0, FLAT.friction_coefficient * load, load).value;
        let shift = slip_under(FLAT.normal_force) / FLAT.friction_coefficient;
        // The edges of the largest dyadic interval, where N/N_c is largest; one beyond the load is at its end.
        for edge in [1.0, 1.25, 1.5, 1.75].map(|part| FLAT.friction_coefficient * part * shift.log2().floor().exp2()) {
            let (mut low, mut high) = (0.0, FLAT.normal_force);
            for _ in 0..60 {
                let load = 0.5 * (low + high);
                *(if slip_under(load) < edge { &mut low } else { &mut high }) = load;
            }
            for mode in 0..calls::MODES {
                let mut arguments = Arguments::new(update, &law);
                let [state, new, input] = [State, NewState, Input].map(|kind| update.place(kind).expect("an argument"));
                let (mut random, mut u, mut load) = (common::Random(mode as u64), 0.0, 0.0);
                for step in 0..800 {
                    u += edge * 10f64.powf(-11.0 - 3.0 * random.signed()) * random.signed().signum();
                    load *= 1.0 + 1e-10 * random.next();
                    if step % 20 == 0 {
                        (u, load) = (0.0, high * (1.0 + 1e-9 * step as f64 / 20.0));
                        arguments.set(state, law.long_state(update, mslip_element_state_length(1, 200)));
                        arguments.slots[1] = Slot::Size(arguments.memory(state).bytes / 8);
                        arguments.slots[new] = arguments.slots[state];
                    }
                    arguments.set(input, Memory::of(&[u, load]));
                    assert_eq!(update.make_rounding(mode, &arguments.slots), MSLIP_OK);
                    assert_eq!(check(&law, true, arguments.memory(state)), MSLIP_OK, "share {share}, mode {mode}");
                }
            }
        }
    }
}

/// Values that are not finite, of the wrong sign or not nested are found; what is not in use is not read.
#[test]
fn invalid_states() {
    for (of_element, law) in laws().map(|(check, law)| (check.is_of_element(), law)).filter(|(_, law)| law.force > 0.0)
    {
        let (mut state, used) = filled_state(law, of_element);
        let mut found = |i: usize, value: f64, what: &str| {
            let valid = std::mem::replace(&mut state.values_mut::<f64>()[i], value);
            assert_eq!(check(law, of_element, &state), MSLIP_BAD_STATE, "{what}: double {i}, {value}");
            state.values_mut::<f64>()[i] = valid;
            valid
        };
        for i in 1..used {
            NON_FINITE.into_iter().for_each(|bits| _ = found(i, f64::from_bits(bits), "not finite"));
        }
        match (of_element, law.directions) {
            (false, _) => {
                // Displacement, force and error of each reversal.
                const FIRST: usize = 6;
                for (i, value) in [(1, 2.5), (3, 0.5), (3, -2.0), (2, 1.0), (2, -1.0)] {
                    found(i, value, "a count, a slip direction, a displacement outside of the last branch");
                }
                for i in 0..REVERSALS {
                    let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
                    found(FIRST + 3 * i + 2, -1e-3, "a negative error");
                    found(FIRST + 3 * i, -sign, "not nested");
                    (i > 0).then(|| found(FIRST + 3 * i, sign, "not nested"));
                }
            }
            (true, 1) => {
                const FIRST: usize = 9;
                found(1, PIECES as f64 - 0.5, "a count");
                (4..FIRST).for_each(|i| _ = found(i, -1e-3, "negative"));
                for i in (FIRST..FIRST + 4 * PIECES).step_by(4) {
                    found(i, -1.0, "a size that decreases");
                    found(i + 1, 1.0, "a size that decreases");
                    found(i + 2, -1.0, "a negative force");
                }
                found(2, 1.0, "a displacement outside of the last knot");
                let load = found(4, -1.0, "negative");
                found(4, 1e-6 * load, "less than the last knot");
            }
            _ => {
                // Loads, units, the normal state and its derivatives, springs, guesses of slips, a double of 17 digits, and rows of
                // the nodes.
                const ROW: usize = 16;
                let [pressed, slopes, springs, guesses, all_digits, nodes] = [10, 17, 24, 58, 90, 91];
                let tables = [(0, 3), (5, 3), (6, 3), (7, 3), (8, 3), (11, 2)].map(|(row, j)| nodes + ROW * row + j);
                let sizes = [1, 7, 8, 9, pressed, pressed + 1, pressed + 2, pressed + 3];
                sizes.into_iter().chain(tables).for_each(|i| _ = found(i, -1.0, "a negative size"));
                found(all_digits, 1000.0, "text of 16 digits");
                found(slopes + 3, 1e50, "a derivative that overflows");
                [guesses + 2, guesses + ROW + 2]
                    .into_iter()
                    .for_each(|i| _ = found(i, 2.0, "a point that turns too far"));
                [springs + 3, springs + ROW + 3]
                    .into_iter()
                    .for_each(|i| _ = found(i, 10.0, "a spring beyond its limit"));
            }
        }
        let length = state.bytes / 8;
        for shorter in 0..used {
            let (d, s) = (law.directions, state.start.cast());
            let status = unsafe {
                if of_element { mslip_element_state_check(d, shorter, s) } else { mslip_state_check(shorter, s) }
            };
            assert!(matches!(status, MSLIP_BAD_STATE | MSLIP_STATE_TOO_SHORT), "{shorter} of {used}: {status}");
        }
        state.values_mut::<u64>()[used..length].fill(u64::MAX);
        assert_eq!(check(law, of_element, &state), MSLIP_OK);
    }
}

/// Results depend neither on the unused part of a state, nor on the new one before the call, which may be discarded, nor on the
/// scratch memory of a workspace.
#[test]
fn unused_memory() {
    for_each_call(|call, law, mut arguments| {
        let of_element = call.is_of_element();
        let Some(input) = call.place(State).or(call.place(Workspace)) else { return };
        if call.has(Index) || !call.has(Output) || call.name.ends_with("_error") {
            return;
        }
        let mut used = 4;
        if call.has(State) {
            used = set_filled_state(call, law, &mut arguments, input);
        } else if call.has(Workspace) {
            arguments.memory(input).fill(0);
            law.init_workspace(call, arguments.memory(input));
        }
        let before = arguments.memory(input).values::<u64>().to_vec();
        assert_eq!(call.make(&arguments.slots), MSLIP_OK, "{}", call.name);
        let expected = results(call, &arguments);
        let is_valid = |place: &usize| check(law, of_element, arguments.memory(*place)) == MSLIP_OK;
        assert!(call.place(NewState).iter().all(is_valid), "{}: the new state", call.name);
        let mut changed = 0;
        for (i, word) in before.iter().enumerate() {
            let memory = arguments.memory_mut(input).values_mut::<u64>();
            let is_scratch = call.has(Workspace) && memory[i] != *word || call.has(State) && i >= used;
            if is_scratch {
                (memory[i], changed) = (u64::MAX, changed + 1);
            }
        }
        assert!(changed > 0 && arguments.memory(input).values::<u64>()[..3] == before[..3], "{}", call.name);
        for _ in 0..2 {
            places(call, Output).for_each(|place| arguments.memory(place).fill(u8::MAX));
            assert_eq!(call.make(&arguments.slots), MSLIP_OK, "{}", call.name);
            assert_eq!(results(call, &arguments), expected, "{}", call.name);
            call.place(NewState).inspect(|new| arguments.omit(*new));
        }
    });
}

/// The state of a stronger contact has forces that a weaker one cannot carry.
#[test]
fn states_of_other_contacts() {
    let (state, _) = filled_state(&calls::contact(&FLAT), false);
    let weak = calls::contact(&microslip::Parameters { friction_coefficient: 0.01, ..FLAT });
    let tractions = call("mslip_masing_tractions");
    let mut arguments = Arguments::new(tractions, &weak);
    arguments.slots[1] = Slot::Size(state.bytes / 8);
    arguments.set(2, state);
    rejected_as(tractions, &arguments, MSLIP_FORCE_EXCEEDS_SLIP, "the state of a stronger contact");
}

/// A batch gives the results of its items alone, each with a contact, a state and values of its own.
#[test]
fn batches_are_single_items() {
    for batch in CALLS.iter().filter(|call| call.has(Index)) {
        let single = call(&batch.name.replace("batch_", ""));
        let directions = if batch.is_of_element() { vec![1, 2] } else { vec![1] };
        for directions in directions {
            let laws: Vec<Law> =
                Law::all(batch).into_iter().filter(|law| law.directions == directions && law.rule == 0).collect();
            let law = |i: usize| &laws[i % laws.len()];
            let items: Vec<Arguments> = (0..N).map(|i| Arguments::new(batch, law(i))).collect();
            let mut all = Arguments::new(batch, law(0));
            let part = |memory: &Memory, i: usize| {
                memory.values::<u8>()[memory.bytes / N * i..memory.bytes / N * (i + 1)].to_vec()
            };
            // Contact i is of law i; item i uses contact index(i), and all values are of that.
            let index: Vec<usize> =
                all.memory(batch.place(Index).expect("an index")).values::<i32>().iter().map(|i| *i as usize).collect();
            for (place, argument) in batch.arguments.iter().enumerate() {
                if matches!(argument.kind, Contact | Element | State | Input) {
                    let is_law = matches!(argument.kind, Contact | Element);
                    let own = |i: usize| part(items[if is_law { i } else { index[i] }].memory(place), i);
                    let bytes: Vec<u8> = (0..N).flat_map(own).collect();
                    all.memory_mut(place).values_mut::<u8>().copy_from_slice(&bytes);
                }
            }
            // The last item is skipped, with its outputs unchanged.
            all.memory_mut(batch.place(Active).expect("flags")).values_mut().copy_from_slice(&[1, 2, 0]);
            assert_eq!(batch.make(&all.slots), MSLIP_OK, "{}", batch.name);
            let pairs = |kinds: [Kind; 2]| {
                kinds.into_iter().flat_map(|kind| places(single, kind).zip(places(batch, kind))).collect::<Vec<_>>()
            };
            for i in 0..N {
                let mut one = Arguments::new(single, law(index[i]));
                for (to, from) in pairs([State, Input]) {
                    one.set(to, Memory::of(&part(all.memory(from), i)));
                }
                if let Some(value) = single.place(Value) {
                    let input = all.memory(batch.place(Input).expect("an input")).values::<f64>()[i];
                    one.slots[value] = Slot::Value(input);
                }
                single.place(Count).inspect(|count| one.slots[*count] = Slot::Size(1));
                for (to, from) in pairs([NewState, Output]) {
                    one.set(to, Memory::of(&vec![FILLED; all.memory(from).bytes / N]));
                }
                if i < N - 1 {
                    assert_eq!(single.make(&one.slots), MSLIP_OK, "{}", single.name);
                }
                for (to, from) in pairs([NewState, Output]) {
                    let (found, expected) = (part(all.memory(from), i), one.memory(to).values::<u8>());
                    assert_eq!(found, expected, "{}: item {i}", batch.name);
                }
            }
        }
    }
}

/// One invalid index, or fewer contacts than items: nothing is written.
#[test]
fn invalid_items() {
    for_each_call(|call, law, _| {
        let Some(index) = call.place(Index) else { return };
        for bad in 0..N {
            let mut arguments = Arguments::new(call, law);
            arguments.memory_mut(index).values_mut().copy_from_slice(&[0, 1, 2]);
            for code in [-1, N as i32, i32::MAX, i32::MIN] {
                arguments.memory_mut(index).values_mut::<i32>()[bad] = code;
                rejected_as(call, &arguments, MSLIP_BAD_INDEX, "one index");
            }
            arguments.memory_mut(index).values_mut::<i32>()[bad] = bad as i32;
        }
        // Fewer contacts than items, with an index or without.
        let mut arguments = Arguments::new(call, law);
        let count = call.place(Laws).expect("a number of contacts");
        for _ in 0..2 {
            (0..N).for_each(|n| rejected(call, &mut arguments, count, Slot::Size(n), MSLIP_BAD_INDEX));
            arguments.omit(index);
        }
    });
}

/// Two items are at fault, each in one of its arguments: the first one is reported.
#[test]
fn first_item_at_fault() {
    for_each_call(|call, law, _| {
        let Some(index) = call.place(Index) else { return };
        let of_item = |place: &usize| matches!(call.arguments[*place].kind, Index | Contact | Element | State | Input);
        let places: Vec<usize> = (0..call.arguments.len()).filter(of_item).collect();
        for (first, second) in places.iter().flat_map(|first| places.iter().map(move |second| (*first, *second))) {
            let mut arguments = Arguments::new(call, law);
            arguments.memory_mut(index).values_mut().copy_from_slice(&[0, 1, 2]);
            for (item, place) in [(1, first), (2, second)] {
                let memory = arguments.memory_mut(place);
                let share = memory.bytes / N;
                memory.values_mut::<u8>()[share * item..share * (item + 1)].fill(u8::MAX);
            }
            rejected_as(call, &arguments, call.arguments[first].status, "two items at fault");
        }
    });
}

/// Calls with invalid pointers and lengths, arbitrary values and arbitrary memory behind valid tags. `verification/fuzz` makes the
/// same under AddressSanitizer, guided by coverage.
#[test]
fn arbitrary_bytes() {
    for seed in 0..20_000 {
        let bytes = pseudorandom(seed, 96);
        mutated_call(&mut Bytes::new(&bytes));
    }
}
