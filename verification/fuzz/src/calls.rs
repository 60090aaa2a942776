//! Sequences of calls of the C interface by its table, with valid and invalid arguments and with corrupted memory.

use crate::interface::{Argument, CALLS, Call, Kind::*, Slot};
use crate::{AnyParameters, Choice, Number, Numbers, all};
use libfuzzer_sys::arbitrary::{self, Arbitrary};
use microslip::Error;
use microslip::ffi::*;
use std::ffi::CStr;
use std::ptr::{null_mut, without_provenance_mut};

/// Initial value of all memory, also of outputs: a NaN that is no tag.
const UNTOUCHED: f64 = f64::from_bits(0x7ff8_5ee5_5ee5_5ee5);

fn untouched(values: &[f64]) -> bool {
    values.iter().all(|value| value.to_bits() == UNTOUCHED.to_bits())
}

fn same(one: &[f64], two: &[f64]) -> bool {
    one.len() == two.len() && one.iter().zip(two).all(|(one, two)| one.to_bits() == two.to_bits())
}

/// The control word of SSE with invalid operation, division by zero and overflow unmasked, or with all exceptions masked.
#[cfg(target_arch = "x86_64")]
fn set_traps(trap: bool) {
    let word: u32 = if trap { 0x1f80 & !(0x080 | 0x200 | 0x400) } else { 0x1f80 };
    unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const word, options(nostack)) }
}

#[cfg(not(target_arch = "x86_64"))]
fn set_traps(_: bool) {}

/// The status of a call, which must be a declared one; floating-point exceptions of valid calls end the run.
fn status(valid: bool, call: &Call, slots: &[Slot]) -> i32 {
    set_traps(valid);
    let status = (call.function)(slots);
    set_traps(false);
    assert!(status == MSLIP_OK || Error::ALL.iter().any(|error| error.code() == status), "undeclared status {status}");
    status
}

const LAWS: usize = 4;
/// Random steps at the end of some paths of elements.
const WALK: usize = 16;

#[derive(Arbitrary, Debug)]
pub struct Input {
    laws: [(Choice, bool); LAWS],
    steps: Vec<Step>,
}

/// A call; each function uses some of the arguments.
#[derive(Arbitrary, Clone, Debug)]
struct Step {
    /// Place in the table; beyond its end, memory is corrupted.
    call: u8,
    /// The contact or element and its state.
    law: u8,
    workspace: u8,
    values: Vec<Number>,
    fault: Fault,
    /// Bit k is set if output k is not requested.
    omitted: u8,
    sizes: [u64; 2],
    /// Directions, normal input and rule.
    codes: [i8; 3],
    choice: Choice,
    index: Option<[i8; 7]>,
    /// Flags of a batch; the seed of random steps of a path.
    active: Option<u8>,
}

/// An invalid argument.
#[derive(Arbitrary, Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    /// The same, for more valid than invalid calls.
    NoneAgain,
    Null(u8),
    Misaligned(u8),
    /// A length beyond the address space.
    Length(u8),
}

#[derive(Clone, Default)]
struct State {
    values: Vec<f64>,
    directions: i32,
    valid: bool,
    /// Its contact or element was initialised again since.
    foreign: bool,
}

#[derive(Clone, Default)]
struct Workspace {
    values: Vec<f64>,
    directions: i32,
    valid: bool,
    coefficients: usize,
}

/// What a contact or an element states of itself.
#[derive(Clone, Copy)]
struct Units {
    directions: i32,
    by_force: bool,
    half_width: f64,
    /// Largest tangential force, and a displacement near gross slip.
    force: f64,
    shift: f64,
    approach: f64,
    normal_force: f64,
    friction: f64,
    /// Of a contact: initial stiffness and energy of full cycles.
    stiffness: f64,
    energy: f64,
}

struct Memory {
    of_elements: bool,
    laws: Vec<f64>,
    valid: [bool; LAWS],
    states: [State; LAWS],
    workspaces: [Workspace; 2],
    table: Vec<f64>,
    valid_table: bool,
    numbers: Numbers,
}

/// Lengths of arrays: items, components of a displacement, coefficients of a component.
#[derive(Clone, Copy)]
struct Extents {
    n: usize,
    m: usize,
    k: usize,
}

impl Extents {
    fn of(self, extents: &str) -> usize {
        let factor = |letter| match letter {
            'n' => self.n,
            'm' => self.m,
            'k' => self.m * self.k,
            _ => MSLIP_PARAMETER_COUNT as usize,
        };
        extents.chars().map(factor).product()
    }
}

/// A call, without its outputs.
struct Prepared<'a> {
    call: &'static Call,
    step: &'a Step,
    slots: Vec<Slot>,
    extents: Extents,
    units: Units,
    input: Vec<f64>,
    value: f64,
    states: Vec<f64>,
    state_length: usize,
    /// The contacts or elements of the items of a batch, if active.
    items: Vec<Option<usize>>,
    n_laws: usize,
    /// All memory is valid.
    valid: bool,
    /// Results are defined besides: elements require states of their own.
    defined: bool,
}

/// Runs the steps with contacts, or with elements.
pub fn run(input: &Input, of_elements: bool) {
    let size = if of_elements { size_of::<mslip_element>() } else { size_of::<mslip_contact>() } / size_of::<f64>();
    let mut memory = Memory {
        of_elements,
        laws: vec![UNTOUCHED; LAWS * size],
        valid: [false; LAWS],
        states: [(); LAWS].map(|()| State::default()),
        workspaces: [(); 2].map(|()| Workspace::default()),
        table: vec![UNTOUCHED; mslip_stiffness_table_length()],
        valid_table: false,
        numbers: Numbers::default(),
    };
    let place = |end: &str| memory.calls().position(|call| call.name.ends_with(end)).unwrap_or(0) as u8;
    let [init, state, workspace] = ["_init", "state_init", "workspace_init"].map(place);
    let first = Step {
        call: init,
        law: 0,
        workspace: 0,
        values: Vec::new(),
        fault: Fault::None,
        omitted: 0,
        sizes: [2, 9],
        codes: [0; 3],
        choice: input.laws[0].0,
        index: None,
        active: None,
    };
    for (law, (choice, by_force)) in (0..).zip(&input.laws) {
        // Elements of one and of two directions.
        let step = Step { law, choice: *choice, codes: [i8::from(law > 0), i8::from(*by_force), 0], ..first.clone() };
        match (choice, choice.contact()) {
            // Initialised once for all runs.
            (Choice::Listed(_), Some((_, listed))) if !of_elements => {
                unsafe {
                    memory.laws[usize::from(law) * size..].as_mut_ptr().cast::<mslip_contact>().write(listed.into())
                };
                memory.valid[usize::from(law)] = true;
            }
            _ => memory.perform(&step),
        }
        memory.perform(&Step { call: state, sizes: [4 * u64::from(law), 0], ..step });
    }
    for rule in [0, 1] {
        // Of two directions, or event-driven.
        let codes = if of_elements { [rule, 0, 0] } else { [0, 0, rule] };
        memory.perform(&Step { call: workspace, workspace: rule as u8, codes, ..first.clone() });
    }
    for step in &input.steps {
        memory.perform(step);
    }
}

/// A code of which small ones are valid: `least` or the next.
fn code(value: i8, least: i32) -> i32 {
    if value < 100 { least + i32::from(value & 1) } else { value.into() }
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

fn positive(value: f64) -> f64 {
    if value > 0.0 && value < 1e150 { value } else { 1e-6 }
}

fn not_negative(value: f64) -> bool {
    value >= 0.0 && value.is_finite()
}

fn named(name: &str) -> Option<&'static Call> {
    CALLS.iter().find(|call| call.name == name)
}

impl Memory {
    fn calls(&self) -> impl Iterator<Item = &'static Call> + use<> {
        let of_elements = self.of_elements;
        CALLS.iter().filter(move |call| call.is_of_element() == of_elements)
    }

    fn size(&self) -> usize {
        self.laws.len() / LAWS
    }

    fn law(&self, slot: usize) -> *mut u8 {
        self.laws[slot * self.size()..].as_ptr().cast_mut().cast()
    }

    fn units(&self, slot: usize) -> Units {
        if self.of_elements {
            let e = unsafe { &*self.law(slot).cast::<mslip_element>() };
            let shift = positive(e.approach * e.friction_coefficient.min(1e3));
            Units {
                directions: e.directions,
                by_force: e.normal_input == MSLIP_INPUT_NORMAL_FORCE,
                half_width: positive(e.half_width),
                force: e.friction_coefficient * e.normal_force,
                shift,
                approach: positive(e.approach),
                normal_force: positive(e.normal_force),
                friction: e.friction_coefficient,
                stiffness: 0.0,
                energy: 0.0,
            }
        } else {
            let c = unsafe { &*self.law(slot).cast::<mslip_contact>() };
            Units {
                directions: 0,
                by_force: false,
                half_width: c.half_width,
                force: c.slip_force,
                shift: c.slip_displacement,
                approach: 0.0,
                normal_force: 0.0,
                friction: 0.0,
                stiffness: c.initial_stiffness,
                energy: c.slip_energy,
            }
        }
    }

    fn least_state(&self, directions: i32) -> usize {
        if self.of_elements { mslip_element_state_length(directions, 0) } else { mslip_state_length(0) }
    }

    /// The values of a state in use: of an element with one direction a header of 8 doubles, whose first holds the number of knots
    /// in its last 40 bits, and 4 for each; with two the shortest state.
    fn used<'a>(&self, directions: i32, state: &'a [f64]) -> &'a [f64] {
        let knots = state.first().map_or(0, |tag| tag.to_bits() & 0xff_ffff_ffff) as usize;
        let length = match (self.of_elements, directions) {
            (false, _) => state.len(),
            (true, 1) => 8 + 4 * knots,
            _ => self.least_state(2),
        };
        state.get(..length).unwrap_or(state)
    }

    fn perform(&mut self, step: &Step) {
        let before = self.laws.clone();
        let count = self.calls().count();
        match self.calls().nth(step.call as usize % (count + 1)) {
            Some(call) => self.make(call, step),
            None => self.corrupt(step),
        }
        let place = step.law as usize % LAWS * self.size();
        let others = |laws: &[f64]| [&laws[..place], &laws[place + self.size()..]].concat();
        assert!(same(&others(&self.laws), &others(&before)), "a contact or an element was modified");
    }

    /// Changes a double, or one of its bits. The header of a longer workspace is not allowed: its length would be another one.
    fn corrupt(&mut self, step: &Step) {
        let number = step.values.first().map_or(0.5, |number| self.numbers.one(*number, 1e-6));
        let [place, bit] = step.sizes;
        let change = |values: &mut [f64]| {
            let place = place as usize % values.len().max(1);
            if let Some(value) = values.get_mut(place) {
                *value = if step.omitted & 1 == 0 { number } else { f64::from_bits(value.to_bits() ^ 1 << (bit % 64)) };
            }
        };
        let (slot, size) = (step.law as usize % LAWS, self.size());
        match step.omitted / 2 % 4 {
            0 => {
                self.valid[slot] = false;
                change(&mut self.laws[slot * size..][..size]);
            }
            1 => {
                self.states[slot].valid = false;
                change(&mut self.states[slot].values);
            }
            2 => {
                self.valid_table = false;
                change(&mut self.table);
            }
            _ => {
                let of_elements = self.of_elements;
                let Workspace { values, directions, valid, coefficients } =
                    &mut self.workspaces[step.workspace as usize % 2];
                let before = values.clone();
                change(values);
                let (header, mut d, mut h, mut s, mut r, mut periods) = (values.as_ptr(), 1, 0, 0, 0, 0);
                let (size, length) = unsafe {
                    if of_elements {
                        let size = mslip_element_workspace_size(header, &mut d, &mut h, &mut s, &mut r, &mut periods);
                        (size, mslip_element_workspace_length(d, h, s, r))
                    } else {
                        let size = mslip_harmonic_workspace_size(header, &mut h, &mut s, &mut r);
                        (size, mslip_harmonic_workspace_length(h, s, r))
                    }
                };
                // Many periods take long.
                if size == MSLIP_OK && (length > values.len() || periods > 4) {
                    *values = before;
                } else {
                    (*valid, *directions, *coefficients) = (false, d, 2 * h + 1);
                }
            }
        }
    }

    fn make(&mut self, call: &'static Call, step: &Step) {
        // The parameters decide which shape is initialised.
        let parameters = step.choice.parameters();
        let shape = if matches!(parameters, AnyParameters::Flat(_)) { Parameters } else { EllipticParameters };
        let takes_parameters = call.has(Parameters) || call.has(EllipticParameters);
        let of_shape = |other: &&'static Call| other.has(shape) && other.is_of_element() == self.of_elements;
        let call = if takes_parameters { CALLS.iter().find(of_shape).unwrap_or(call) } else { call };
        let slot = step.law as usize % LAWS;
        let own_states = self.states[slot].values.clone();
        let prepared = self.prepare(call, step, &parameters);
        let faultless = matches!(step.fault, Fault::None | Fault::NoneAgain);
        let expected = if faultless { self.expected(&prepared) } else { None };
        let (status, some) = prepared.attempt(self, step.omitted, None);
        assert!(expected.is_none_or(|expected| expected == status), "{}: {status}, not {expected:?}", call.name);
        assert!(same(&own_states, &self.states[slot].values), "the old state was modified");
        if status != MSLIP_OK {
            assert!(
                some.iter().all(|(_, output)| untouched(output)),
                "{}: a rejected call modified an output",
                call.name
            );
            return;
        }
        self.keep(&prepared, &some);
        if prepared.defined && !takes_parameters && !call.has(Buffer) {
            self.compare(&prepared, &some);
        }
    }

    /// Units, input, memory and all arguments but the outputs.
    fn prepare<'a>(&mut self, call: &'static Call, step: &'a Step, parameters: &AnyParameters) -> Prepared<'a> {
        let (slot, ws) = (step.law as usize % LAWS, step.workspace as usize % 2);
        let (is_batch, count) = (call.has(Index), step.values.len());
        let State { values: state, directions: _, valid: valid_state, .. } = self.states[slot].clone();
        let mut items = vec![Some(slot)];
        let mut n_laws = LAWS;
        let flags = |i: usize| step.active.map_or(1, |flags| i32::from(flags >> (i % 8) & 1) * i32::from(flags));
        let index_of = |i: usize| {
            step.index.map_or(i as i32, |index| {
                let index = index[i % 7];
                if index.unsigned_abs() < 120 {
                    i32::from(index).rem_euclid(LAWS as i32)
                } else {
                    i32::from(index) / 30
                }
            })
        };
        if is_batch {
            // Harmonic forces of few items; indices beyond the contacts, rarely.
            let n = if call.has(Workspace) { count % 4 } else { count / if self.of_elements { 3 } else { 1 } };
            items = (0..n).map(|i| (flags(i) != 0).then_some(index_of(i) as usize)).collect();
            n_laws = if step.omitted < 0xf0 { LAWS } else { step.omitted as usize % LAWS };
        }
        let first = items.iter().flatten().find(|law| **law < n_laws).copied().unwrap_or(slot);
        let mut valid = items.iter().flatten().all(|law| *law >= n_laws || self.valid[*law]);
        valid &= !call.has(State) || valid_state;
        valid &= !call.has(Table) || self.valid_table;
        let workspace = &self.workspaces[ws];
        valid &= !call.has(Workspace) || workspace.valid;
        let is_foreign = self.states[slot].foreign || items.iter().flatten().any(|law| *law != slot);
        let defined = valid && !(self.of_elements && call.has(State) && is_foreign);
        let units = self.units(first);
        // Buffers for corrupted elements suffice for two directions.
        let directions = if call.has(Workspace) {
            workspace.directions
        } else if valid && self.valid[first] {
            units.directions
        } else {
            2
        };
        let m = if call.has(Element) || call.has(Workspace) && self.of_elements { 1 + directions as usize } else { 1 };
        let n = match call.place(Input) {
            _ if is_batch => items.len(),
            // Each slider takes some 0.3 ms.
            _ if call.is_sliders() => count % 4,
            Some(place) if call.arguments[place].extents.contains('m') => count / m,
            _ => count,
        };
        let mut extents = Extents { n, m, k: workspace.coefficients };
        let scale = |argument: &Argument, i: usize| {
            let share = if argument.extents.contains('k') { extents.k } else { 1 };
            let is_vector = argument.extents.contains(['m', 'k']) && self.of_elements;
            match argument.name {
                "x" => units.half_width,
                "force" | "force_amplitude" => units.force,
                "approach" => units.approach,
                "normal_force" => units.normal_force,
                _ if is_vector && i / share.max(1) % m == m - 1 => {
                    if units.by_force {
                        units.normal_force
                    } else {
                        units.approach
                    }
                }
                _ if units.shift > 0.0 => units.shift,
                _ => 1e-6,
            }
        };
        let number = |i: usize| step.values.get(i % count.max(1)).copied().unwrap_or(Number::Special(0));
        let value =
            call.place(Value).map_or(0.0, |place| self.numbers.one(number(0), scale(&call.arguments[place], 0)));
        let mut input = Vec::new();
        if let Some(place) = call.place(Input) {
            let argument = &call.arguments[place];
            let length = extents.of(argument.extents);
            input = (0..length).map(|i| self.numbers.one(number(i), scale(argument, i))).collect();
            if let (true, true, Some(seed)) =
                (call.has(NewState) && call.has(Count) && !is_batch, self.of_elements, step.active)
            {
                walk(&mut input, seed, m, [units.shift, scale(argument, m - 1)]);
                extents.n = input.len() / m;
            }
        }
        let states = state.repeat(items.len());
        let mut prepared = Prepared {
            call,
            step,
            slots: Vec::new(),
            extents,
            units,
            input,
            value,
            states,
            state_length: state.len(),
            items,
            n_laws,
            valid,
            defined,
        };
        let [directions, normal_input, rule] =
            [code(step.codes[0], 1), code(step.codes[1], MSLIP_INPUT_APPROACH), code(step.codes[2], 0)];
        let rule = if self.of_elements && step.codes[2] < 100 { MSLIP_UNIFORM_SAMPLING } else { rule };
        let sizes = [step.sizes[0] % 10, step.sizes[1] % 256].map(|size| size as usize);
        check_lengths(step.sizes, directions, rule);
        for argument in call.arguments {
            prepared.slots.push(match argument.kind {
                Parameters | EllipticParameters => Slot::Pointer(match parameters {
                    AnyParameters::Flat(p) => (&raw const *p).cast_mut().cast(),
                    AnyParameters::Ellipse(p) => (&raw const *p).cast_mut().cast(),
                }),
                Contact | Element => Slot::Pointer(self.law(if is_batch { 0 } else { slot })),
                Count => Slot::Size(prepared.extents.n),
                Laws => Slot::Size(n_laws),
                Length => Slot::Size(match argument.name {
                    "state_length" if call.has(State) => prepared.state_length,
                    "state_length" => self.new_state_length(directions, step.sizes[0] as u8),
                    "table_length" => self.table.len(),
                    _ if self.of_elements => {
                        mslip_element_workspace_length(directions, sizes[0], sizes[1], rule).max(3)
                    }
                    _ => mslip_harmonic_workspace_length(sizes[0], sizes[1], rule).max(3),
                }),
                Size => Slot::Size(match argument.name {
                    "periods" => (step.sizes[0] >> 8) as usize % 4,
                    name => sizes[usize::from(name == "samples")],
                }),
                Choice => Slot::Choice(match argument.name {
                    "directions" => directions,
                    "normal_input" => normal_input,
                    _ => rule,
                }),
                Workspace => Slot::Pointer(self.workspaces[ws].values.as_mut_ptr().cast()),
                Table => Slot::Pointer(self.table.as_mut_ptr().cast()),
                Value => Slot::Value(prepared.value),
                // Set by an attempt.
                _ => Slot::Pointer(null_mut()),
            });
        }
        prepared
    }

    fn new_state_length(&self, directions: i32, length: u8) -> usize {
        let length = usize::from(length);
        match (self.of_elements, length) {
            (false, ..192) => mslip_state_length(length % 12),
            (false, _) => length % 16,
            (true, ..128) => mslip_element_state_length(directions, length % 12),
            // Longer than a state of two directions.
            (true, 128..192) => mslip_element_state_length(1, length),
            (true, _) => length % 36,
        }
    }

    /// The status of a call with valid memory, if the memory decides it.
    fn expected(&self, prepared: &Prepared) -> Option<i32> {
        let Prepared { call, step, units, .. } = *prepared;
        let state = &self.states[step.law as usize % LAWS];
        if !prepared.valid {
            return None;
        }
        if call.has(Index) {
            return prepared
                .items_alone(self)
                .into_iter()
                .map(|(status, _)| status)
                .find(|status| *status != MSLIP_OK)
                .or(Some(MSLIP_OK));
        }
        let directions = call.place(Choice).map_or(units.directions, |place| prepared.slots[place].get());
        if call.one_direction && units.directions == 2 {
            Some(MSLIP_NOT_AVAILABLE)
        } else if self.of_elements && call.has(State) && matches!(directions, 1 | 2) && directions != state.directions {
            Some(if state.values.is_empty() { MSLIP_STATE_TOO_SHORT } else { MSLIP_BAD_DIRECTIONS })
        } else if call.has(Element)
            && call.has(Workspace)
            && directions != self.workspaces[step.workspace as usize % 2].directions
        {
            Some(MSLIP_BAD_DIRECTIONS)
        } else if call.name.ends_with("_check") && !(call.has(State) && (state.foreign || !matches!(directions, 0..=2)))
        {
            // Steps of several contacts may leave reversals that are not nested.
            Some(MSLIP_OK)
        } else {
            None
        }
    }

    /// Keeps what a call initialised, and the new state.
    fn keep(&mut self, prepared: &Prepared, written: &[(usize, Vec<f64>)]) {
        let Prepared { call, step, .. } = *prepared;
        let (slot, size) = (step.law as usize % LAWS, self.size());
        let directions =
            call.arguments.iter().position(|argument| (argument.name, argument.kind) == ("directions", Choice));
        let directions: i32 = directions.map_or(0, |place| prepared.slots[place].get());
        for (place, values) in written {
            match call.arguments[*place].kind {
                NewContact | NewElement => {
                    self.laws[slot * size..][..size].copy_from_slice(values);
                    self.valid[slot] = true;
                    self.states[slot].foreign = true;
                    self.check_law(slot);
                }
                Buffer if call.name.ends_with("state_init") => {
                    self.states[slot] = State { values: values.clone(), directions, valid: true, foreign: false };
                }
                Buffer if call.name.ends_with("table_init") => {
                    (self.table, self.valid_table) = (values.clone(), self.valid[slot]);
                }
                Buffer => {
                    let harmonics = call.arguments.iter().position(|argument| argument.name == "harmonics");
                    let coefficients = harmonics.map_or(1, |place| 2 * prepared.slots[place].get::<usize>() + 1);
                    self.workspaces[step.workspace as usize % 2] =
                        Workspace { values: values.clone(), directions, valid: true, coefficients };
                }
                NewState if !call.has(Index) && !values.is_empty() => {
                    // Of an element only the used part is written.
                    let used = self.used(prepared.units.directions, values).len();
                    self.states[slot].values[..used].copy_from_slice(&values[..used]);
                }
                _ => {}
            }
        }
    }

    fn check_law(&self, slot: usize) {
        let u = self.units(slot);
        let size = [u.half_width, u.force, u.shift, u.stiffness, u.energy];
        all!(size, not_negative);
        if self.of_elements {
            let e = unsafe { &*self.law(slot).cast::<mslip_element>() };
            let fields = [
                e.composite_modulus,
                e.normal_force,
                e.half_width,
                e.approach,
                e.normal_stiffness,
                e.tangential_stiffness,
            ];
            all!(fields, |value| value > 0.0 && value.is_finite());
            assert!(not_negative(e.friction_coefficient));
        } else if u.force > 0.0 {
            // The curve is concave and ends at mu N; the loop lies within its parallelogram.
            all!(size, |value| value > 0.0);
            assert!(
                u.force <= u.stiffness * u.shift * (1.0 + 1e-13) && u.energy <= 4.0 * u.force * u.shift,
                "{size:?}"
            );
        } else {
            all!(&size[1..], |value| value == 0.0);
        }
    }

    /// Results depend neither on the requested outputs nor on where the new state is stored, are within their bounds, and are those
    /// of the steps of a path and of the items of a batch.
    fn compare(&mut self, prepared: &Prepared, some: &[(usize, Vec<f64>)]) {
        let Prepared { call, step, .. } = *prepared;
        let directions = prepared.units.directions;
        let faultless = Prepared { step: &Step { fault: Fault::None, ..step.clone() }, ..prepared.clone() };
        let (status, full) = faultless.attempt(self, 0, None);
        assert_eq!(status, MSLIP_OK, "{}: accepted with some outputs, rejected with all", call.name);
        let same_outputs = |written: &[(usize, Vec<f64>)]| {
            for (place, values) in written {
                let all = full.iter().find(|(other, _)| other == place).map_or(&[][..], |(_, values)| values);
                assert!(same(values, all), "{}, {}: {values:?}, {all:?}", call.name, call.arguments[*place].name);
            }
        };
        same_outputs(some);
        if call.has(State) && call.has(NewState) {
            let mut states = prepared.states.clone();
            let (status, mut written) = faultless.attempt(self, 0, Some(&mut states));
            assert_eq!(status, MSLIP_OK);
            written.retain(|(place, _)| call.arguments[*place].kind != NewState);
            same_outputs(&written);
            let new =
                full.iter().find(|(place, _)| call.arguments[*place].kind == NewState).map_or(&[][..], |(_, new)| new);
            let length = prepared.state_length.max(1);
            for ((item, in_place), new) in prepared.items.iter().zip(states.chunks(length)).zip(new.chunks(length)) {
                let expected = if item.is_some() { new } else { &prepared.states[..length] };
                assert!(
                    same(self.used(directions, in_place), self.used(directions, expected)),
                    "{in_place:?}, {expected:?}"
                );
            }
        }
        if call.has(Index) {
            for (i, (_, outputs)) in prepared.items_alone(self).iter().enumerate() {
                for ((place, all), one) in full.iter().zip(outputs) {
                    let item = &all[i * one.len()..][..one.len()];
                    assert!(same(item, one), "{}, item {i}, argument {place}: {item:?}, alone {one:?}", call.name);
                }
            }
        } else {
            for (place, values) in &full {
                self.check_bounds(prepared, call.arguments[*place].name, values);
            }
            if let (true, Some(update)) = (call.has(NewState), named(&call.name.replace("_path", "_update"))) {
                self.check_steps(prepared, update, &full);
            }
        }
    }

    /// A path gives the results of its steps, and each state passes its check.
    fn check_steps(&self, prepared: &Prepared, update: &Call, full: &[(usize, Vec<f64>)]) {
        let Prepared { call, extents, units, .. } = *prepared;
        let mut state = prepared.states.clone();
        let steps = if call.has(Count) { extents.n } else { 1 };
        let outputs: Vec<&Vec<f64>> =
            full.iter().filter(|(place, _)| call.arguments[*place].kind == Output).map(|(_, all)| all).collect();
        for i in 0..steps {
            let step = if call.has(Count) { &prepared.input[extents.m * i..] } else { &prepared.input[..] };
            let value = if call.has(Count) { step.first().copied().unwrap_or(0.0) } else { prepared.value };
            let mut one: Vec<Vec<f64>> = outputs.iter().map(|all| vec![UNTOUCHED; all.len() / steps]).collect();
            let mut output = one.iter_mut();
            let start = state.as_mut_ptr();
            let slot = |argument: &Argument| match argument.kind {
                Contact | Element => prepared.slots[0],
                Length => Slot::Size(state.len()),
                Value => Slot::Value(value),
                Input => Slot::Pointer(step.as_ptr().cast_mut().cast()),
                State | NewState => Slot::Pointer(start.cast()),
                _ => Slot::Pointer(output.next().map_or(null_mut(), |output| output.as_mut_ptr().cast())),
            };
            let slots: Vec<Slot> = update.arguments.iter().map(slot).collect();
            assert_eq!(status(true, update, &slots), MSLIP_OK, "step {i}");
            for (all, one) in outputs.iter().zip(&one) {
                assert!(same(&all[i * one.len()..][..one.len()], one), "step {i}: {all:?}, {one:?}");
            }
            let checked = unsafe {
                if self.of_elements {
                    mslip_element_state_check(units.directions, state.len(), start)
                } else {
                    mslip_state_check(state.len(), start)
                }
            };
            let foreign = self.states[prepared.step.law as usize % LAWS].foreign;
            assert!(foreign || checked == MSLIP_OK, "step {i}: the check rejects {state:?}");
        }
        if let (true, Some((_, new))) =
            (steps > 0, full.iter().find(|(place, _)| call.arguments[*place].kind == NewState))
        {
            let [stepwise, new] = [&state, new].map(|state| self.used(units.directions, state));
            assert!(same(stepwise, new), "stepwise {stepwise:?}, at once {new:?}");
        }
    }

    fn check_bounds(&self, prepared: &Prepared, name: &str, values: &[f64]) {
        let Prepared { call, units, value, .. } = *prepared;
        let is = |part: &str| call.name.contains(part);
        let limit = units.force;
        let tangent = |stiffness: f64| (0.0..=units.stiffness * (1.0 + 1e-13)).contains(&stiffness);
        let same_sign = |argument: f64, result: f64| result * argument.signum() >= 0.0;
        let coulomb = |force: &[f64]| {
            let (normal, tangential) =
                (force[force.len() - 1], force[..force.len() - 1].iter().copied().fold(0.0, f64::hypot));
            // The force is a sum over pieces of the diagram, which may belong to larger loads.
            normal >= 0.0 && tangential <= units.friction * (normal + 1e-13 * units.normal_force.max(normal))
        };
        match name {
            "force" | "displacement" if is("monotonic") => {
                let bound = if name == "force" { limit } else { units.shift * (1.0 + 1e-13) };
                all!(values, |value| value.abs() <= bound);
                assert!(prepared.input.iter().zip(values).all(|(x, y)| same_sign(*x, *y)), "{values:?}");
            }
            "displacement" => all!(values, |displacement| displacement.abs() <= value),
            "force" if is("harmonic") && self.of_elements => all!(values, f64::is_finite),
            // A coefficient is at most twice an average of forces.
            "force" if is("harmonic") => all!(values, |force| force.abs() <= 2.0 * limit * (1.0 + 1e-13)),
            "force" if self.of_elements => {
                assert!(values.chunks(prepared.extents.m).all(coulomb), "{values:?}");
            }
            "force" => all!(values, |force| force.abs() <= limit),
            "shear" if is("masing") || self.of_elements => all!(values, f64::is_finite),
            // Rounding at the edge of the stick zone.
            "slip" if value == 0.0 => all!(values, |slip| slip.abs() <= 1e-15 * units.shift),
            "shear" | "slip" => all!(values, |x| x.is_finite() && x * value >= 0.0),
            "compliance" if self.of_elements => all!(values, |compliance| compliance > 0.0),
            "compliance" => {
                let least = if limit > 0.0 { (1.0 - 1e-13) / units.stiffness } else { f64::INFINITY };
                all!(values, |compliance| compliance >= least);
            }
            "stick_half_width" => {
                all!(values, |half_width| (0.0..=units.half_width * (1.0 + 1e-13)).contains(&half_width))
            }
            "stiffness" if !self.of_elements && !is("equivalent") => all!(values, tangent),
            // Rounding of |K| and of |K|/amplitude.
            "k_imag" if is("tabulated") => all!(values, |k| k >= -1e-13 * units.stiffness && tangent(k.max(0.0))),
            "k_real" | "k_imag" => all!(values, tangent),
            "dk_real" if !is("tabulated") => all!(values, |slope| slope <= 0.0 && slope.is_finite()),
            "energy" => all!(values, |energy| (0.0..=units.energy * (1.0 + 1e-13)).contains(&energy)),
            "force_error" if is("iwan") => all!(values, |error| (0.0..=1.0).contains(&error)),
            "slip_force" if is("iwan") => {
                all!(values, not_negative);
                let sum: f64 = values.iter().sum();
                assert!((sum - limit).abs() <= 1e-12 * limit, "{sum:e} instead of {limit:e}");
            }
            "tangent" | "jacobian" | "sensitivity" | "dk_real" | "dk_imag" => all!(values, f64::is_finite),
            "harmonics" | "samples" | "periods" | "rule" | "directions" | "state_new" => {}
            _ => all!(values, not_negative),
        }
    }
}

/// Lengths of states and workspaces of any size.
fn check_lengths(sizes: [u64; 2], directions: i32, rule: i32) {
    let [size, samples] = sizes.map(|value| (value >> (value % 64)) as usize);
    assert!(mslip_state_length(size) >= mslip_state_length(0));
    assert_eq!(mslip_element_state_length(directions, size) > 0, matches!(directions, 1 | 2));
    for length in [
        mslip_harmonic_workspace_length(size, samples, rule),
        mslip_element_workspace_length(directions, size, samples, rule),
    ] {
        assert!(length == 0 || (size > 0 && samples / 2 >= size));
    }
    assert!(!unsafe { CStr::from_ptr(mslip_status_text(rule)) }.is_empty());
}

impl Clone for Prepared<'_> {
    fn clone(&self) -> Self {
        let Prepared { call, step, extents, units, value, state_length, n_laws, valid, defined, .. } = *self;
        let (slots, input, states, items) =
            (self.slots.clone(), self.input.clone(), self.states.clone(), self.items.clone());
        Prepared {
            call,
            step,
            slots,
            extents,
            units,
            input,
            value,
            states,
            state_length,
            items,
            n_laws,
            valid,
            defined,
        }
    }
}

impl Prepared<'_> {
    /// Length of the memory that an argument writes, in doubles.
    fn length(&self, memory: &Memory, argument: &Argument) -> usize {
        let of_length = |name: &str| {
            let place = self.call.arguments.iter().position(|argument| argument.name == name);
            place.map_or(0, |place| self.slots[place].get())
        };
        match argument.kind {
            NewContact | NewElement => memory.size(),
            NewState => self.states.len(),
            Buffer if argument.name == "table" => of_length("table_length"),
            Buffer if argument.name == "state" => of_length("state_length"),
            Buffer | Workspace => of_length("workspace_length"),
            FoundChoice | FoundSize => 1,
            _ => self.extents.of(argument.extents),
        }
    }

    /// The status, and the outputs that were requested, with the new states in place if these are given.
    fn attempt(&self, memory: &Memory, omitted: u8, in_place: Option<&mut Vec<f64>>) -> (i32, Vec<(usize, Vec<f64>)>) {
        let (call, step) = (self.call, self.step);
        let mut written: Vec<(usize, Vec<f64>)> = Vec::new();
        let mut slots = self.slots.clone();
        let bits = |length: usize, value: &dyn Fn(usize) -> i32| (0..length).map(value).collect::<Vec<i32>>();
        let index = bits(self.items.len(), &|i| {
            step.index.map_or(0, |index| {
                let index = index[i % 7];
                if index.unsigned_abs() < 120 {
                    i32::from(index).rem_euclid(LAWS as i32)
                } else {
                    i32::from(index) / 30
                }
            })
        });
        let active = bits(self.items.len(), &|i| {
            step.active.map_or(1, |flags| i32::from(flags >> (i % 8) & 1) * i32::from(flags))
        });
        let states = in_place.as_ref().map_or(self.states.as_ptr(), |states| states.as_ptr()).cast_mut();
        for (place, argument) in call.arguments.iter().enumerate() {
            let is_omitted = !argument.kind.is_required() && omitted >> (written.len() % 8) & 1 == 1;
            match argument.kind {
                Index => {
                    slots[place] = Slot::Pointer(step.index.map_or(null_mut(), |_| index.as_ptr().cast_mut().cast()))
                }
                Active => {
                    slots[place] = Slot::Pointer(step.active.map_or(null_mut(), |_| active.as_ptr().cast_mut().cast()))
                }
                State => slots[place] = Slot::Pointer(states.cast()),
                Input => slots[place] = Slot::Pointer(self.input.as_ptr().cast_mut().cast()),
                NewState if in_place.is_some() => slots[place] = Slot::Pointer(states.cast()),
                kind if kind.is_written() => {
                    let mut output = vec![UNTOUCHED; self.length(memory, argument)];
                    slots[place] = Slot::Pointer(if is_omitted { null_mut() } else { output.as_mut_ptr().cast() });
                    written.push((place, output));
                }
                _ => {}
            }
        }
        let of_kind = |choice: u8, which: fn(&Slot) -> bool| {
            let places: Vec<usize> = (0..slots.len()).filter(|place| which(&slots[*place])).collect();
            places.get(choice as usize % places.len().max(1)).copied()
        };
        let is_pointer = |slot: &Slot| matches!(slot, Slot::Pointer(pointer) if !pointer.is_null());
        // Without an index or flags a batch is another one.
        let is_optional = |place: &usize| matches!(call.arguments[*place].kind, Index | Active);
        match step.fault {
            Fault::Null(choice) => {
                if let Some(place) = of_kind(choice, is_pointer).filter(|place| !is_optional(place)) {
                    slots[place] = Slot::Pointer(null_mut());
                }
            }
            Fault::Misaligned(choice) => {
                if let Some(place) = of_kind(choice, is_pointer) {
                    let half = if matches!(call.arguments[place].kind, Index | Active | FoundChoice) { 2 } else { 4 };
                    let address = slots[place].pointer().map_or(0, |pointer| pointer.addr());
                    slots[place] = Slot::Pointer(without_provenance_mut(address + half));
                }
            }
            Fault::Length(choice) => {
                if let Some(place) = of_kind(choice, |slot| matches!(slot, Slot::Size(_))) {
                    let long = [usize::MAX, isize::MAX as usize, isize::MAX as usize / 8 + 1];
                    slots[place] = Slot::Size(long[choice as usize / 8 % 3]);
                }
            }
            Fault::None | Fault::NoneAgain => {}
        }
        let status = status(self.defined, call, &slots);
        // A rejected call must not have written to any of them.
        let is_kept = |(place, _): &(usize, Vec<f64>)| {
            status != MSLIP_OK || slots[*place].pointer().is_some_and(|p| !p.is_null())
        };
        written.retain(is_kept);
        (status, written)
    }

    /// Status and outputs of each item of a batch in a call of its own; none of an item that is not active.
    fn items_alone(&self, memory: &Memory) -> Vec<(i32, Vec<Vec<f64>>)> {
        let single = named(&self.call.name.replace("_batch", "")).expect("a single call");
        let workspace = &memory.workspaces[self.step.workspace as usize % 2];
        let directions = if self.call.has(Workspace) { workspace.directions } else { self.units.directions };
        let written: Vec<&Argument> =
            self.call.arguments.iter().filter(|argument| argument.kind.is_written()).collect();
        let share = |i: usize| &self.input[i * self.input.len() / self.items.len().max(1)..];
        let alone = |(i, item): (usize, &Option<usize>)| {
            let lengths = written.iter().map(|argument| self.length(memory, argument) / self.items.len());
            let mut outputs: Vec<Vec<f64>> = lengths.map(|length| vec![UNTOUCHED; length]).collect();
            let Some(law) = *item else { return (MSLIP_OK, outputs) };
            if law >= self.n_laws {
                return (MSLIP_BAD_INDEX, outputs);
            }
            if memory.of_elements && memory.units(law).directions != directions {
                return (MSLIP_BAD_DIRECTIONS, outputs);
            }
            let mut output = outputs.iter_mut();
            let slot = |argument: &Argument| match argument.kind {
                Contact | Element => Slot::Pointer(memory.law(law)),
                Count => Slot::Size(1),
                Length => Slot::Size(self.state_length),
                Value => Slot::Value(self.input[i]),
                State => Slot::Pointer(self.states[i * self.state_length..].as_ptr().cast_mut().cast()),
                Workspace => Slot::Pointer(workspace.values.as_ptr().cast_mut().cast()),
                Input => Slot::Pointer(share(i).as_ptr().cast_mut().cast()),
                _ => Slot::Pointer(output.next().map_or(null_mut(), |output| output.as_mut_ptr().cast())),
            };
            let slots: Vec<Slot> = single.arguments.iter().map(slot).collect();
            (status(self.defined, single, &slots), outputs)
        };
        self.items.iter().enumerate().map(alone).collect()
    }
}
