//! A call of the table with valid arguments after a random history, of which bytes then change some: values, pointers, lengths, and
//! memory behind its tags.

use super::{Arguments, CALLS, Call, Kind::*, Law, Memory, Slot};
use microslip::Error;
use microslip::ffi::MSLIP_OK;

/// Bytes of the fuzzer, which select the mutations; 0 after their end.
pub struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    pub fn new(bytes: &[u8]) -> Bytes<'_> {
        Bytes(bytes)
    }

    #[allow(dead_code, reason = "for the fuzzer")]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn byte(&mut self) -> usize {
        let Some((first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        (*first).into()
    }

    fn word(&mut self) -> u64 {
        (0..8).fold(0, |word, _| word << 8 | self.byte() as u64)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.byte() << 8 | self.byte()) % count.max(1)
    }

    /// A number near a scale, a special one, or any bits.
    fn number(&mut self, scale: f64) -> u64 {
        const SPECIAL: [f64; 12] =
            [0.0, -0.0, 1.0, 5e-324, f64::MIN_POSITIVE, 1e-160, 1e-8, 1e150, -1e150, 1e160, f64::MAX, f64::INFINITY];
        match self.byte() % 8 {
            0 => self.word(),
            1 => SPECIAL[self.byte() % SPECIAL.len()].to_bits(),
            2 => (scale * 2f64.powi(self.byte() as i32 - 128)).to_bits(),
            3 => scale.to_bits().wrapping_add_signed(self.byte() as i64 - 128),
            _ => (scale * (self.below(1 << 16) as f64 / 8192.0 - 4.0)).to_bits(),
        }
    }
}

/// Makes the call, and checks that it returns a declared status, modifies no input and, if it is rejected, no output. With valid
/// memory it raises no floating-point exception, no result is NaN, and a path gives what its steps give.
pub fn mutated_call(bytes: &mut Bytes) {
    let call = &CALLS[bytes.byte() % CALLS.len()];
    // It takes long.
    if call.is_sliders() {
        return;
    }
    let laws = Law::all(call);
    let (harmonics, samples) = (1 + bytes.byte() % 5, 11 + bytes.byte() % 64);
    let law = Law { harmonics, samples, ..laws[bytes.byte() % laws.len()].clone() };
    let mut arguments = Arguments::new(call, &law);
    if call.has(State) {
        apply_random_history(bytes, call, &law, &mut arguments);
    }
    let mut memory_is_valid = true;
    for _ in 0..bytes.byte() % 6 {
        memory_is_valid &= mutate(bytes, call, &mut arguments);
    }
    let before = contents(&arguments);
    let status = if memory_is_valid { call.make(&arguments.slots) } else { (call.function)(&arguments.slots) };
    assert!(status == MSLIP_OK || Error::ALL.iter().any(|error| error.code() == status), "undeclared status {status}");
    for (place, (argument, (before, after))) in
        call.arguments.iter().zip(before.iter().zip(contents(&arguments))).enumerate()
    {
        let may_change = match argument.kind {
            Workspace => true,
            FailedItem => status != MSLIP_OK,
            kind => status == MSLIP_OK && kind.is_written(),
        };
        assert!(may_change || *before == after, "{}: argument {place} is modified, status {status}", call.name);
    }
    if memory_is_valid && status == MSLIP_OK {
        for (argument, memory) in call.arguments.iter().zip(&arguments.memory) {
            let values = memory.iter().flat_map(Memory::values::<f64>);
            assert!(argument.kind != Output || values.clone().all(|value| !value.is_nan()), "{}: NaN", call.name);
        }
        check_steps(call, &law, &arguments);
    }
}

fn contents(arguments: &Arguments) -> Vec<Vec<u8>> {
    let bytes = |memory: &Option<Memory>| memory.as_ref().map_or(vec![], |memory| memory.values().to_vec());
    arguments.memory.iter().map(bytes).collect()
}

/// Sets states of any length after any history.
fn apply_random_history(bytes: &mut Bytes, call: &Call, law: &Law, arguments: &mut Arguments) {
    let of_element = call.is_of_element();
    let length = law.memory_length(call, "state") + bytes.byte() % 64;
    let state = law.long_state(call, length);
    for _ in 0..bytes.byte() % 32 {
        let scales = [law.displacement, law.displacement, law.normal];
        // Invalid values leave the state.
        law.step(of_element, &state, scales.map(|scale| f64::from_bits(bytes.number(scale))));
    }
    let place = |kind| call.place(kind).filter(|place| arguments.memory[*place].is_some());
    let ([old, new], count) = ([place(State), place(NewState)], call.arguments.iter().position(|a| a.kind == Length));
    for place in [old, new].into_iter().flatten() {
        arguments.set(place, Memory::of(&state.values::<u64>().repeat(call.items())));
    }
    count.into_iter().for_each(|count| arguments.slots[count] = Slot::Size(length));
    state.fill(0);
}

/// Changes an argument. Whether all memory is valid still.
fn mutate(bytes: &mut Bytes, call: &Call, arguments: &mut Arguments) -> bool {
    let place = bytes.below(call.arguments.len());
    let argument = &call.arguments[place];
    match (arguments.slots[place], bytes.byte() % 8) {
        (Slot::Value(value), _) => arguments.slots[place] = Slot::Value(f64::from_bits(bytes.number(value))),
        // Smaller, or beyond the address space.
        (Slot::Size(size), what) if size < 1 << 32 => {
            arguments.slots[place] = Slot::Size([usize::MAX - what, bytes.below(size + 1)][what % 2]);
        }
        (Slot::Size(_), _) => {}
        (Slot::Choice(_), _) => arguments.slots[place] = Slot::Choice(bytes.byte() as i32 - 128),
        (Slot::Pointer(_), 0) => arguments.omit(place),
        (Slot::Pointer(_), 1) => arguments.slots[place] = Slot::Pointer(arguments.memory(place).misaligned()),
        (Slot::Pointer(_), _) => {
            let from = if argument.kind == Workspace { 3 } else { 0 };
            let Some(memory) = arguments.memory[place].as_mut().filter(|_| !argument.kind.is_written()) else {
                return true;
            };
            if matches!(argument.kind, Index | Active) {
                let codes = memory.values_mut::<i32>();
                codes[bytes.below(codes.len())] = bytes.byte() as i32 % 8 - 2;
                return true;
            }
            let values = memory.values_mut::<f64>();
            let i = from + bytes.below(values.len() - from);
            if argument.kind == Element && matches!(i % (values.len() / call.items()), 7 | 8) {
                return true; // The number of directions, which decides the lengths of arrays.
            }
            let largest = values.iter().copied().filter(|value| value.abs() < 1e150).fold(0.0, f64::max);
            let bits = bytes.number(if values[i] == 0.0 { largest } else { values[i] });
            values[i] = f64::from_bits(bits);
            return matches!(argument.kind, Input | Parameters | EllipticParameters);
        }
    }
    true
}

/// A step or path in place, and the steps of a path one by one, give the same outputs.
fn check_steps(call: &Call, law: &Law, arguments: &Arguments) {
    let (Some(old), Some(new), Some(count), false) =
        (call.place(State), call.place(NewState), call.place(Count), call.has(Index))
    else {
        return;
    };
    let (n, state): (usize, _) = (arguments.slots[count].get(), Memory::of(arguments.memory(old).values::<u64>()));
    let mut slots = arguments.slots.clone();
    [slots[old], slots[new], slots[count]] = [Slot::Pointer(state.start), Slot::Pointer(state.start), Slot::Size(1)];
    let is_step = |kind| matches!(kind, Input | Output);
    let copies: Vec<Option<Memory>> = (0..slots.len())
        .map(|place| {
            let memory = arguments.memory[place].as_ref().filter(|_| call.arguments[place].kind == Output)?;
            Some(Memory::of(memory.values::<u8>()))
        })
        .collect();
    for i in 0..n {
        for (place, argument) in call.arguments.iter().enumerate().filter(|(_, argument)| is_step(argument.kind)) {
            let start = copies[place].as_ref().or(arguments.memory[place].as_ref()).expect("memory").start;
            let share = law.length(argument.extents, call.has(Element)) / super::N;
            if !arguments.slots[place].pointer().is_some_and(<*mut u8>::is_null) {
                slots[place] = Slot::Pointer(start.wrapping_add(8 * share * i));
            }
        }
        assert_eq!((call.function)(&slots), MSLIP_OK, "{}: step {i}", call.name);
    }
    for (copy, memory) in copies.iter().zip(&arguments.memory) {
        let Some(copy) = copy else { continue };
        assert!(
            copy.values::<u8>() == memory.as_ref().expect("memory").values::<u8>(),
            "{}: a path and its steps",
            call.name
        );
    }
}
