//! The calls of the C interface with valid arguments: each array is an allocation of its own, of exact length.

use microslip::ffi::*;
use microslip::{EllipticParameters, Layer, Material, Parameters};
use std::alloc::{Layout, alloc, dealloc};
use std::ptr::{self, null_mut};
use std::sync::OnceLock;

#[cfg(not(miri))]
pub mod mutation;
#[rustfmt::skip]
mod table;
pub use table::CALLS;

/// What an argument is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Parameters,
    EllipticParameters,
    NewParameters,
    Contact,
    Element,
    NewContact,
    NewElement,
    /// Items or steps.
    Count,
    /// Contacts or elements of a batch.
    Laws,
    /// The length of a state or workspace.
    Length,
    /// Harmonics or samples.
    Size,
    /// Directions, normal input, rule.
    Choice,
    Index,
    Active,
    FailedItem,
    FoundChoice,
    FoundSize,
    State,
    NewState,
    Workspace,
    /// A state or workspace to be initialised.
    Buffer,
    Value,
    Input,
    Output,
}
use Kind::*;

impl Kind {
    pub fn is_written(self) -> bool {
        matches!(
            self,
            NewParameters | NewContact | NewElement | FailedItem | FoundChoice | FoundSize | NewState | Buffer | Output
        )
    }

    pub fn is_required(self) -> bool {
        !matches!(self, NewParameters | Index | Active | FailedItem | FoundChoice | FoundSize | NewState | Output)
    }
}

pub struct Argument {
    pub name: &'static str,
    pub kind: Kind,
    /// n: items or steps, m: components of a displacement, k: coefficients, p: parameters, q: pairs.
    pub extents: &'static str,
    /// The status of an invalid value.
    pub status: i32,
}

pub struct Call {
    pub name: &'static str,
    /// Not for elliptical contacts.
    pub flat: bool,
    /// Not for two directions.
    pub one_direction: bool,
    pub function: fn(&[Slot]) -> i32,
    pub arguments: &'static [Argument],
}

impl Call {
    pub fn place(&self, kind: Kind) -> Option<usize> {
        self.arguments.iter().position(|argument| argument.kind == kind)
    }

    pub fn has(&self, kind: Kind) -> bool {
        self.place(kind).is_some()
    }

    pub fn is_of_element(&self) -> bool {
        self.has(Element) || self.has(NewElement) || self.name.contains("element")
    }

    pub fn is_sliders(&self) -> bool {
        self.name == "mslip_iwan_equivalent"
    }

    pub fn items(&self) -> usize {
        if self.has(Index) { N } else { 1 }
    }

    /// The status. A floating-point exception that an application may trap is a failure.
    pub fn make(&self, slots: &[Slot]) -> i32 {
        self.make_rounding(0, slots)
    }

    /// The status in one of the rounding modes; 0 is to nearest.
    pub fn make_rounding(&self, mode: usize, slots: &[Slot]) -> i32 {
        environment::enter(mode);
        let status = (self.function)(slots);
        let raised = environment::leave();
        assert!(!raised, "{}: a floating-point exception in rounding mode {mode}: {slots:?}", self.name);
        status
    }
}

#[cfg(all(unix, not(miri), any(target_arch = "x86_64", target_arch = "aarch64")))]
mod environment {
    unsafe extern "C" {
        fn fesetround(mode: i32) -> i32;
        fn feclearexcept(flags: i32) -> i32;
        fn fetestexcept(flags: i32) -> i32;
    }

    /// To nearest, upward, downward, toward zero; invalid operation, division by zero and overflow; all flags.
    #[cfg(target_arch = "x86_64")]
    const CODES: ([i32; 4], i32, i32) = ([0, 0x800, 0x400, 0xc00], 0x0d, 0x3d);
    #[cfg(target_arch = "aarch64")]
    const CODES: ([i32; 4], i32, i32) = ([0, 0x40_0000, 0x80_0000, 0xc0_0000], 0x07, 0x1f);
    /// In the last one subnormal numbers are flushed to zero, where processors do.
    pub const MODES: usize = 5;

    pub fn enter(mode: usize) {
        flush(mode == MODES - 1);
        // SAFETY: the environment is the default one again when other code runs.
        assert_eq!(unsafe { feclearexcept(CODES.2) | fesetround(CODES.0[mode % 4]) }, 0);
    }

    /// Whether an exception was raised.
    pub fn leave() -> bool {
        // SAFETY: as above.
        let raised = unsafe { fetestexcept(CODES.1) | fesetround(CODES.0[0]) != 0 };
        flush(false);
        raised
    }

    #[cfg(target_arch = "x86_64")]
    fn flush(flushes: bool) {
        const DEFAULT: u32 = 0x1f80;
        let word = DEFAULT | if flushes { 0x8040 } else { 0 };
        // SAFETY: a valid word; as above.
        unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const word, options(nostack)) }
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn flush(_: bool) {}
}

#[cfg(not(all(unix, not(miri), any(target_arch = "x86_64", target_arch = "aarch64"))))]
mod environment {
    pub const MODES: usize = 1;
    pub fn enter(_: usize) {}
    pub fn leave() -> bool {
        false
    }
}

#[allow(unused_imports, reason = "not for the fuzzer")]
pub use environment::MODES;

/// An argument as it is passed.
#[derive(Clone, Copy, Debug)]
pub enum Slot {
    Pointer(*mut u8),
    Value(f64),
    Size(usize),
    Choice(i32),
}

impl Slot {
    pub fn get<T: Passed>(self) -> T {
        T::of(self)
    }

    pub fn pointer(self) -> Option<*mut u8> {
        match self {
            Slot::Pointer(pointer) => Some(pointer),
            _ => None,
        }
    }
}

/// The type of an argument of a function.
pub trait Passed {
    fn of(slot: Slot) -> Self;
}

macro_rules! passed {
    ($($type:ty: $slot:ident;)*) => {
        $(impl Passed for $type {
            fn of(slot: Slot) -> $type {
                let Slot::$slot(value) = slot else { panic!("{slot:?}") };
                value
            }
        })*
    };
}

passed! {
    f64: Value;
    usize: Size;
    i32: Choice;
}

impl<T> Passed for *mut T {
    fn of(slot: Slot) -> *mut T {
        slot.pointer().expect("a pointer").cast()
    }
}

impl<T> Passed for *const T {
    fn of(slot: Slot) -> *const T {
        <*mut T>::of(slot)
    }
}

/// Uninitialised memory on the heap.
pub struct Memory {
    pub start: *mut u8,
    pub bytes: usize,
    align: usize,
}

impl Memory {
    pub fn new<T>(length: usize) -> Memory {
        let (bytes, align) = (length * size_of::<T>(), align_of::<T>());
        // SAFETY: the size of the layout is not 0.
        let start = unsafe { alloc(Memory::layout(bytes, align)) };
        assert!(!start.is_null(), "out of memory");
        Memory { start, bytes, align }
    }

    fn layout(bytes: usize, align: usize) -> Layout {
        Layout::from_size_align(bytes.max(1), align).unwrap()
    }

    pub fn of<T: Copy>(values: &[T]) -> Memory {
        let memory = Memory::new::<T>(values.len());
        // SAFETY: valid for the values.
        unsafe { ptr::copy_nonoverlapping(values.as_ptr(), memory.start.cast(), values.len()) };
        memory
    }

    pub fn fill(&self, byte: u8) {
        // SAFETY: valid for the bytes.
        unsafe { self.start.write_bytes(byte, self.bytes) };
    }

    /// The values, all of which were written.
    pub fn values<T>(&self) -> &[T] {
        // SAFETY: valid for the length, and written.
        unsafe { std::slice::from_raw_parts(self.start.cast(), self.bytes / size_of::<T>()) }
    }

    pub fn values_mut<T>(&mut self) -> &mut [T] {
        // SAFETY: valid for the length, and written.
        unsafe { std::slice::from_raw_parts_mut(self.start.cast(), self.bytes / size_of::<T>()) }
    }

    /// The address half an item further.
    pub fn misaligned(&self) -> *mut u8 {
        self.start.wrapping_byte_add(self.align / 2)
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        // SAFETY: allocated with the same layout.
        unsafe { dealloc(self.start, Memory::layout(self.bytes, self.align)) };
    }
}

const STEEL: Material = Material { young_modulus: 2.1e11, poisson_ratio: 0.3 };

pub static FLAT: Parameters = Parameters {
    flat_half_width: 1e-4,
    edge_radius: 5e-3,
    length: 0.02,
    normal_force: 60.0,
    friction_coefficient: 0.5,
    material: [STEEL; 2],
    layer: Layer::none(),
    displacement_reference: MSLIP_CENTRE_POINT,
    reserved: 0,
};

pub static SPHERE: EllipticParameters = EllipticParameters {
    semi_axis_x: 1e-4,
    semi_axis_y: 1e-4,
    normal_force: 100.0,
    friction_coefficient: 0.3,
    material: [STEEL; 2],
    layer: Layer::none(),
};

pub const RULES: [i32; 2] = [MSLIP_UNIFORM_SAMPLING, MSLIP_EVENT_DRIVEN];
/// Numbers of items, steps and points.
pub const N: usize = 3;
pub const HARMONICS: usize = 1;
/// Samples of a period; an ellipse has one less.
pub const SAMPLES: usize = 9;
pub const PERIODS: usize = 2;
/// Pairs of nodes of a part of a face.
pub const PAIRS: usize = 2;

/// A contact or an element, with its units, and the rule of a workspace.
#[derive(Clone)]
pub struct Law {
    pub bytes: Vec<u8>,
    pub is_elliptic: bool,
    pub directions: i32,
    pub normal_input: i32,
    pub rule: i32,
    pub harmonics: usize,
    pub samples: usize,
    pub half_width: f64,
    pub force: f64,
    /// A displacement near gross slip.
    pub displacement: f64,
    pub normal: f64,
    pub approach: f64,
    pub normal_force: f64,
}

fn initialised<T>(init: impl Fn(*mut T) -> i32) -> (Memory, Vec<u8>) {
    let memory = Memory::new::<T>(1);
    assert_eq!(init(memory.start.cast()), MSLIP_OK);
    let bytes = memory.values().to_vec();
    (memory, bytes)
}

/// Slightly flattened, elliptical, and without friction; initialised once, which takes seconds under Miri.
pub fn contacts() -> &'static [Law; 3] {
    static CONTACTS: OnceLock<[Law; 3]> = OnceLock::new();
    CONTACTS.get_or_init(|| {
        let ellipse = EllipticParameters { semi_axis_y: 3e-4, ..SPHERE };
        [
            contact(&Parameters { flat_half_width: 1e-6, ..FLAT }),
            law_of_contact(true, |contact| unsafe { mslip_contact_init_elliptic(&raw const ellipse, contact) }),
            contact(&Parameters { friction_coefficient: 0.0, ..FLAT }),
        ]
    })
}

pub fn contact(p: &Parameters) -> Law {
    law_of_contact(false, |contact| unsafe { mslip_contact_init(p, contact) })
}

pub fn law_of_contact(is_elliptic: bool, init: impl Fn(*mut mslip_contact) -> i32) -> Law {
    let (memory, bytes) = initialised(init);
    let c: &mslip_contact = &memory.values()[0];
    law(bytes, is_elliptic, [c.half_width, c.slip_force, c.slip_displacement])
}

fn law(bytes: Vec<u8>, is_elliptic: bool, [half_width, force, displacement]: [f64; 3]) -> Law {
    Law {
        bytes,
        is_elliptic,
        directions: 1,
        normal_input: MSLIP_INPUT_APPROACH,
        rule: MSLIP_UNIFORM_SAMPLING,
        harmonics: HARMONICS,
        samples: SAMPLES - usize::from(is_elliptic),
        half_width,
        force,
        displacement,
        normal: 0.0,
        approach: 0.0,
        normal_force: 0.0,
    }
}

/// A rounded flat by approach, and a sphere by normal force, both with one direction; a sphere by approach and, but under Miri, a
/// rigid strip by normal force with two. Initialised once, which takes minutes under Miri.
pub fn elements() -> &'static [Law] {
    static ELEMENTS: OnceLock<Vec<Law>> = OnceLock::new();
    ELEMENTS.get_or_init(|| {
        // Harmonic forces with the springs of both directions take too long under Miri: without friction there are none.
        let sphere = EllipticParameters { friction_coefficient: if cfg!(miri) { 0.0 } else { 0.3 }, ..SPHERE };
        let strip = Parameters { displacement_reference: MSLIP_RIGID_STRIP, ..FLAT };
        let (by_approach, by_force) = (MSLIP_INPUT_APPROACH, MSLIP_INPUT_NORMAL_FORCE);
        let mut elements = vec![
            element(false, |element| unsafe { mslip_element_init(&raw const FLAT, 1, by_approach, element) }),
            element(true, |element| unsafe { mslip_element_init_elliptic(&raw const SPHERE, 1, by_force, element) }),
            element(true, |element| unsafe { mslip_element_init_elliptic(&raw const sphere, 2, by_approach, element) }),
        ];
        if !cfg!(miri) {
            let init = |element| unsafe { mslip_element_init(&raw const strip, 2, by_force, element) };
            elements.push(element(false, init));
        }
        elements
    })
}

pub fn element(is_elliptic: bool, init: impl Fn(*mut mslip_element) -> i32) -> Law {
    let (memory, bytes) = initialised(init);
    let e: &mslip_element = &memory.values()[0];
    let mslip_element { directions, normal_input, normal_force, approach, half_width, friction_coefficient, .. } = *e;
    let normal = if normal_input == MSLIP_INPUT_NORMAL_FORCE { normal_force } else { approach };
    let units = [half_width, friction_coefficient * normal_force, friction_coefficient * approach];
    Law { directions, normal_input, normal, approach, normal_force, ..law(bytes, is_elliptic, units) }
}

impl Law {
    pub fn components(&self) -> usize {
        1 + self.directions as usize
    }

    /// The laws for which a function is called, with each rule of a workspace.
    pub fn all(call: &Call) -> Vec<Law> {
        if call.is_of_element() {
            return elements().to_vec();
        }
        let rules = if call.has(Workspace) || call.name.contains("workspace") { &RULES[..] } else { &RULES[..1] };
        let with_rules = contacts().iter().flat_map(|law| rules.iter().map(|&rule| Law { rule, ..law.clone() }));
        with_rules.collect()
    }

    pub fn length(&self, extents: &str, of_element: bool) -> usize {
        let m = if of_element { self.components() } else { 1 };
        let factor = |letter| match letter {
            'n' => N,
            'm' => m,
            'k' => m * (2 * self.harmonics + 1),
            'q' => PAIRS,
            _ => MSLIP_PARAMETER_COUNT as usize,
        };
        extents.chars().map(factor).product()
    }

    /// The length of the shortest state, or of a workspace.
    pub fn memory_length(&self, call: &Call, name: &str) -> usize {
        let of_element = call.is_of_element();
        match (&name[..5], of_element) {
            ("state", false) => mslip_state_length(0),
            ("state", true) => mslip_element_state_length(self.directions, 0),
            ("works", false) => mslip_harmonic_workspace_length(self.harmonics, self.samples, self.rule),
            _ => mslip_element_workspace_length(self.directions, self.harmonics, self.samples, self.rule),
        }
    }

    /// Values of a quantity: 0, within the model, and beyond it where that is allowed.
    fn value(&self, name: &str, i: usize, normal: bool, harmonic: bool) -> f64 {
        let part = [0.3, 0.0, -0.9][i % 3];
        match name {
            _ if normal && harmonic => self.normal * [0.5, 0.3, 0.1][i % 3],
            _ if normal => self.normal * [0.4, 0.9, 0.6][i % 3],
            "x" => part * self.half_width,
            "area" => [1e-6, 3e-6, 0.0][i % 3],
            "pressure" => [2e6, 0.0, 0.0, 4e6][i % 4],
            "force" => part * self.force,
            "force_amplitude" => part.abs() * self.force,
            "amplitude" => 1.5 * part.abs() * self.displacement,
            "displacement" => 1.2 * part * self.displacement,
            "approach" => 2.5 * part * self.approach,
            "normal_force" => 2.5 * part.abs() * self.normal_force,
            _ => panic!("no value of {name}"),
        }
    }

    /// Whether value i of an input is the normal component of a displacement, or one of its coefficients.
    pub fn is_normal(&self, call: &Call, argument: &Argument, i: usize) -> bool {
        let of_steps = argument.extents.contains('m');
        let share = if of_steps { 1 } else { 2 * self.harmonics + 1 };
        let is_vector = of_steps || argument.extents.contains('k');
        call.has(Element) && is_vector && i / share % self.components() == self.components() - 1
    }

    pub fn input(&self, call: &Call, argument: &Argument) -> Vec<f64> {
        let harmonic = argument.extents.contains('k');
        (0..self.length(argument.extents, call.has(Element)))
            .map(|i| {
                self.value(
                    argument.name,
                    i / if argument.extents.contains('m') { self.components() } else { 1 },
                    self.is_normal(call, argument, i),
                    harmonic,
                )
            })
            .collect()
    }

    pub fn state(&self, call: &Call) -> Memory {
        self.long_state(call, self.memory_length(call, "state"))
    }

    pub fn long_state(&self, call: &Call, length: usize) -> Memory {
        let state = Memory::of(&vec![f64::NAN; length]);
        let (n, start) = (state.bytes / 8, state.start.cast());
        let status = if call.is_of_element() {
            unsafe { mslip_element_state_init(self.directions, n, start) }
        } else {
            unsafe { mslip_state_init(n, start) }
        };
        assert_eq!(status, MSLIP_OK);
        state
    }

    /// A step to a displacement along x and y and a normal component; its status.
    #[cfg(not(miri))]
    pub fn step(&self, of_element: bool, state: &Memory, [u, v, w]: [f64; 3]) -> i32 {
        let (n, s, none) = (state.bytes / 8, state.start.cast(), null_mut());
        let laws = Memory::of_law(self, 1);
        unsafe {
            if of_element {
                let step = if self.directions == 1 { [u, w, 0.0] } else { [u, v, w] };
                mslip_element_update(laws.start.cast(), n, s, step.as_ptr(), s, none, none, none)
            } else {
                mslip_masing_update(laws.start.cast(), n, s, u, s, none, none, none)
            }
        }
    }

    pub fn workspace(&self, call: &Call) -> Memory {
        let memory = Memory::new::<f64>(self.memory_length(call, "workspace"));
        self.init_workspace(call, &memory);
        memory
    }

    pub fn init_workspace(&self, call: &Call, memory: &Memory) {
        let (n, start) = (memory.bytes / 8, memory.start.cast());
        let Law { directions, harmonics, samples, rule, .. } = *self;
        let status = if call.is_of_element() {
            unsafe { mslip_element_workspace_init(directions, harmonics, samples, rule, PERIODS, n, start) }
        } else {
            unsafe { mslip_harmonic_workspace_init(harmonics, samples, rule, n, start) }
        };
        assert_eq!(status, MSLIP_OK);
    }
}

impl Memory {
    /// Copies of a contact or an element.
    pub fn of_law(law: &Law, items: usize) -> Memory {
        let memory = Memory::new::<f64>(items * law.bytes.len() / 8);
        // SAFETY: valid for the items, which may be copied as bytes.
        (0..items).for_each(|i| unsafe {
            ptr::copy_nonoverlapping(law.bytes.as_ptr(), memory.start.add(i * law.bytes.len()), law.bytes.len());
        });
        memory
    }
}

/// The arguments of a call and their memory.
pub struct Arguments {
    pub slots: Vec<Slot>,
    pub memory: Vec<Option<Memory>>,
}

pub const FILLED: u8 = 0x77;

impl Arguments {
    /// Valid arguments, and outputs that are filled.
    pub fn new(call: &Call, law: &Law) -> Arguments {
        let arguments = Arguments::uninitialised(call, law);
        let written = call.arguments.iter().zip(&arguments.memory).filter(|(argument, _)| argument.kind.is_written());
        written.filter_map(|(_, memory)| memory.as_ref()).for_each(|memory| memory.fill(FILLED));
        arguments
    }

    /// Valid arguments, and outputs that are not.
    pub fn uninitialised(call: &Call, law: &Law) -> Arguments {
        let mut arguments = Arguments { slots: Vec::new(), memory: Vec::new() };
        let items = call.items();
        for argument in call.arguments {
            let memory_length = |name: &str| law.memory_length(call, name);
            let made = match argument.kind {
                Count => Ok(Slot::Size(N)),
                Laws => Ok(Slot::Size(items)),
                Length => Ok(Slot::Size(memory_length(argument.name))),
                Size => Ok(Slot::Size(match argument.name {
                    "harmonics" => law.harmonics,
                    "periods" => PERIODS,
                    "pairs" => PAIRS,
                    _ => law.samples,
                })),
                Choice => Ok(Slot::Choice(match argument.name {
                    "directions" => law.directions,
                    "normal_input" => law.normal_input,
                    _ => law.rule,
                })),
                Value => Ok(Slot::Value(law.value(argument.name, 0, false, false))),
                Parameters => Err(Memory::of(&[FLAT])),
                EllipticParameters => Err(Memory::of(&[SPHERE])),
                Contact | Element => Err(Memory::of_law(law, items)),
                NewParameters => Err(Memory::of(&[FLAT; N])),
                NewContact => Err(Memory::new::<mslip_contact>(1)),
                NewElement => Err(Memory::new::<mslip_element>(1)),
                Index => Err(Memory::of::<i32>(&[2, 0, 1])),
                Active => Err(Memory::of::<i32>(&[1, -1, 255])),
                FoundChoice => Err(Memory::new::<i32>(1)),
                FailedItem | FoundSize => Err(Memory::new::<usize>(1)),
                // Of an element only the used part is written.
                State | NewState => Err(Memory::of(&law.state(call).values::<f64>().repeat(items))),
                Workspace => Err(law.workspace(call)),
                Buffer => {
                    let name = call.name.trim_start_matches("mslip_");
                    Err(Memory::new::<f64>(memory_length(if name.ends_with("state_init") { "state" } else { "works" })))
                }
                Input => Err(Memory::of(&law.input(call, argument))),
                Output => Err(Memory::new::<f64>(law.length(argument.extents, call.has(Element)))),
            };
            let (slot, memory) = match made {
                Ok(slot) => (slot, None),
                Err(memory) => (Slot::Pointer(memory.start), Some(memory)),
            };
            arguments.slots.push(slot);
            arguments.memory.push(memory);
        }
        arguments
    }

    /// Replaces the memory of an argument.
    pub fn set(&mut self, place: usize, memory: Memory) {
        self.slots[place] = Slot::Pointer(memory.start);
        self.memory[place] = Some(memory);
    }

    /// Another value i of an argument; returns the one before.
    #[cfg(not(miri))]
    pub fn exchange(&mut self, place: usize, i: usize, value: f64) -> f64 {
        if let Slot::Value(before) = self.slots[place] {
            self.slots[place] = Slot::Value(value);
            return before;
        }
        std::mem::replace(&mut self.memory_mut(place).values_mut()[i], value)
    }

    pub fn omit(&mut self, place: usize) {
        self.slots[place] = Slot::Pointer(null_mut());
    }

    pub fn memory(&self, place: usize) -> &Memory {
        self.memory[place].as_ref().expect("memory")
    }

    pub fn memory_mut(&mut self, place: usize) -> &mut Memory {
        self.memory[place].as_mut().expect("memory")
    }
}
