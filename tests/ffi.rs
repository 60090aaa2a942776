//! Calls of every function of the C interface with memory of exact length: each array is an allocation of its own, and outputs are
//! uninitialised.
//!
//! Under Miri (`tools/miri.sh`) every access outside an array, read of uninitialised memory, misaligned access, use of an
//! invalidated reference and race between threads is an error.

#![allow(
    clippy::undocumented_unsafe_blocks,
    reason = "all calls: each pointer is rejected or valid for the length that is passed"
)]

use microslip::ffi::*;
use microslip::{EllipticParameters, Material, Parameters};
use std::alloc::{Layout, alloc, dealloc};
use std::ffi::CStr;
use std::ptr::{self, null, null_mut};
use std::sync::OnceLock;

/// Uninitialised memory on the heap.
struct Memory<T> {
    start: *mut T,
    length: usize,
}

impl<T> Memory<T> {
    fn new(length: usize) -> Memory<T> {
        // SAFETY: the size of the layout is not 0.
        let start: *mut T = unsafe { alloc(Memory::<T>::layout(length)) }.cast();
        assert!(!start.is_null(), "out of memory");
        Memory { start, length }
    }

    /// At least one byte.
    fn layout(length: usize) -> Layout {
        let layout = Layout::array::<T>(length).unwrap();
        Layout::from_size_align(layout.size().max(1), layout.align()).unwrap()
    }

    fn of(values: impl IntoIterator<Item = T, IntoIter: ExactSizeIterator>) -> Memory<T> {
        let values = values.into_iter();
        let memory: Memory<T> = Memory::new(values.len());
        for (i, value) in values.enumerate() {
            // SAFETY: i is below the length.
            unsafe { memory.start.add(i).write(value) };
        }
        memory
    }

    /// The values, all of which were written.
    fn values(&self) -> &[T] {
        // SAFETY: valid for the length, and written.
        unsafe { std::slice::from_raw_parts(self.start, self.length) }
    }
}

impl<T> Drop for Memory<T> {
    fn drop(&mut self) {
        // SAFETY: allocated with the same layout.
        unsafe { dealloc(self.start.cast(), Memory::<T>::layout(self.length)) };
    }
}

const STEEL: Material = Material { young_modulus: 2.1e11, poisson_ratio: 0.3 };

fn flat(flat_half_width: f64, length: f64) -> Parameters {
    Parameters {
        flat_half_width,
        edge_radius: 5e-3,
        length,
        normal_force: 3e3 * length,
        friction_coefficient: 0.5,
        material: [STEEL; 2],
        displacement_reference: MSLIP_CENTRE_POINT,
        reserved: 0,
    }
}

/// Slightly flattened, elliptical, and without friction; initialised once, which takes seconds under Miri.
fn contacts() -> [Memory<mslip_contact>; 3] {
    static INITIALISED: OnceLock<[mslip_contact; 3]> = OnceLock::new();
    let initialised = |init: &dyn Fn(*mut mslip_contact) -> i32| {
        let contact = Memory::new(1);
        assert_eq!(init(contact.start), MSLIP_OK);
        // SAFETY: one contact, initialised.
        unsafe { contact.start.read() }
    };
    let contacts = INITIALISED.get_or_init(|| {
        let rounded = flat(1e-6, 0.02);
        let frictionless = Parameters { friction_coefficient: 0.0, ..flat(1e-4, 0.02) };
        let ellipse = EllipticParameters {
            semi_axis_x: 1e-4,
            semi_axis_y: 3e-4,
            normal_force: 100.0,
            friction_coefficient: 0.3,
            material: [STEEL; 2],
        };
        [
            initialised(&|contact| unsafe { mslip_contact_init(&raw const rounded, contact) }),
            initialised(&|contact| unsafe { mslip_contact_init_elliptic(&raw const ellipse, contact) }),
            initialised(&|contact| unsafe { mslip_contact_init(&raw const frictionless, contact) }),
        ]
    });
    contacts.each_ref().map(copy)
}

/// Contacts may be copied as bytes.
fn copy(contact: &mslip_contact) -> Memory<mslip_contact> {
    let memory = Memory::new(1);
    // SAFETY: one contact.
    unsafe { ptr::copy_nonoverlapping(contact, memory.start, 1) };
    memory
}

/// Uninitialised contacts, and one with another tag.
fn bad_contacts() -> [Memory<mslip_contact>; 3] {
    let filled = |byte: u8| {
        let contact = Memory::<mslip_contact>::new(1);
        // SAFETY: one contact.
        unsafe { contact.start.write_bytes(byte, 1) };
        contact
    };
    let [other, ..] = contacts();
    // SAFETY: the tag of the contact.
    unsafe { (*other.start).reserved[0] = 0.0 };
    [filled(0), filled(0xff), other]
}

fn slip(contact: &Memory<mslip_contact>) -> (f64, f64) {
    let contact = &contact.values()[0];
    (contact.slip_force, contact.slip_displacement)
}

type Outputs<'a> = &'a [*mut f64];

/// Accepted with all outputs, each alone, and none; requested outputs are written and not NaN. A misaligned output is rejected.
fn accepted(lengths: &[usize], call: impl Fn(Outputs) -> i32) {
    // The C drivers request every subset; Miri takes too long.
    let alone = if cfg!(miri) { 1 } else { lengths.len() };
    for subset in (0..alone).map(|k| 1 << k).chain([0, u32::MAX]) {
        let outputs: Vec<Option<Memory<f64>>> =
            (0..).zip(lengths).map(|(k, &length)| (subset >> k & 1 == 1).then(|| Memory::new(length))).collect();
        let pointers: Vec<*mut f64> =
            outputs.iter().map(|output| output.as_ref().map_or(null_mut(), |output| output.start)).collect();
        assert_eq!(call(&pointers), MSLIP_OK, "{subset:b}");
        assert!(outputs.iter().flatten().all(|output| output.values().iter().all(|value| !value.is_nan())));
    }
    for k in 0..lengths.len() {
        rejected(MSLIP_BAD_ALIGNMENT, lengths, |pointers| {
            let mut pointers = pointers.to_vec();
            pointers[k] = misaligned(pointers[k]);
            call(&pointers)
        });
    }
}

/// Rejected with this status; no output is modified.
fn rejected(status: i32, lengths: &[usize], call: impl Fn(Outputs) -> i32) {
    const BEFORE: f64 = 77.0;
    let outputs: Vec<Memory<f64>> = lengths.iter().map(|&length| Memory::of(vec![BEFORE; length])).collect();
    let pointers: Vec<*mut f64> = outputs.iter().map(|output| output.start).collect();
    assert_eq!(call(&pointers), status);
    assert!(outputs.iter().all(|output| output.values().iter().all(|&value| value == BEFORE)));
}

/// The address half an item further.
fn misaligned<T>(pointer: *const T) -> *mut T {
    pointer.cast_mut().wrapping_byte_add(align_of::<T>() / 2)
}

/// NULL, misaligned and invalid contacts are rejected.
fn check_contact(lengths: &[usize], call: impl Fn(*const mslip_contact, Outputs) -> i32) {
    rejected(MSLIP_NULL_POINTER, lengths, |out| call(null(), out));
    let [contact, ..] = contacts();
    rejected(MSLIP_BAD_ALIGNMENT, lengths, |out| call(misaligned(contact.start), out));
    for contact in bad_contacts() {
        rejected(MSLIP_BAD_CONTACT, lengths, |out| call(contact.start, out));
    }
}

/// A function of a contact and a value: accepted; invalid contacts and values are rejected.
fn check_value(
    contact: &Memory<mslip_contact>,
    lengths: &[usize],
    value: f64,
    invalid: &[(i32, f64)],
    call: impl Fn(*const mslip_contact, f64, Outputs) -> i32,
) {
    accepted(lengths, |out| call(contact.start, value, out));
    check_contact(lengths, |contact, out| call(contact, value, out));
    for &(status, value) in invalid {
        rejected(status, lengths, |out| call(contact.start, value, out));
    }
}

/// A function of a contact and an array: accepted; NULL, a misaligned array, and an invalid last value are rejected.
fn check_array(
    contact: &Memory<mslip_contact>,
    lengths: &[usize],
    values: &[f64],
    invalid: &[(i32, f64)],
    call: impl Fn(*const mslip_contact, *const f64, Outputs) -> i32,
) {
    let x = Memory::of(values.to_vec());
    accepted(lengths, |out| call(contact.start, x.start, out));
    check_contact(lengths, |contact, out| call(contact, x.start, out));
    rejected(MSLIP_NULL_POINTER, lengths, |out| call(contact.start, null(), out));
    rejected(MSLIP_BAD_ALIGNMENT, lengths, |out| call(contact.start, misaligned(x.start), out));
    for &(status, value) in invalid {
        let mut values = values.to_vec();
        values[x.length - 1] = value;
        let x = Memory::of(values);
        rejected(status, lengths, |out| call(contact.start, x.start, out));
    }
}

/// An array of no values may be NULL; a length beyond the address space is rejected.
fn check_length(outputs: usize, call: impl Fn(usize, *const f64, Outputs) -> i32) {
    let x = Memory::of([0.0]);
    accepted(&vec![0; outputs], |out| call(0, null(), out));
    rejected(MSLIP_BAD_ARRAY_SIZE, &vec![1; outputs], |out| call(usize::MAX / 8, x.start, out));
}

/// Number of doubles in a state of two reversals, the shortest.
const LEAST: usize = 11;

fn unloaded(reversals: usize) -> Memory<f64> {
    let state = Memory::new(mslip_state_length(reversals));
    assert_eq!(unsafe { mslip_state_init(state.length, state.start) }, MSLIP_OK);
    state
}

/// NULL, misaligned, short, uninitialised and truncated states are rejected; `lengths` are those of the outputs.
fn check_state(lengths: &[usize], call: impl Fn(usize, *const f64, Outputs) -> i32) {
    let state = unloaded(2);
    rejected(MSLIP_NULL_POINTER, lengths, |out| call(LEAST, null(), out));
    rejected(MSLIP_NULL_POINTER, lengths, |out| call(0, null(), out));
    rejected(MSLIP_BAD_ALIGNMENT, lengths, |out| call(LEAST, misaligned(state.start), out));
    for length in [0, 5, LEAST - 1] {
        let short = Memory::of(state.values()[..length].to_vec());
        rejected(MSLIP_STATE_TOO_SHORT, lengths, |out| call(length, short.start, out));
    }
    let mut truncated = state.values().to_vec();
    truncated[0] = f64::from_bits(truncated[0].to_bits() + 3);
    let filled = [0, 0x5a, 0xff].map(|byte: u8| vec![f64::from_bits(u64::from_ne_bytes([byte; 8])); LEAST]);
    for bad in filled.into_iter().chain([truncated]).map(Memory::of) {
        rejected(MSLIP_BAD_STATE, lengths, |out| call(LEAST, bad.start, out));
    }
}

/// Checks a valid state; returns the bound on its error.
fn state_error(state: &Memory<f64>) -> f64 {
    let error = Memory::new(1);
    unsafe {
        assert_eq!(mslip_state_check(state.length, state.start), MSLIP_OK);
        assert_eq!(mslip_state_error(state.length, state.start, error.start), MSLIP_OK);
    }
    error.values()[0]
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

#[test]
fn parameters() {
    let (p, e) = (Memory::<Parameters>::new(1), Memory::<EllipticParameters>::new(1));
    let (contact, c) = (Memory::<mslip_contact>::new(1), null_mut());
    unsafe {
        mslip_parameters_default(null_mut());
        mslip_elliptic_parameters_default(null_mut());
        mslip_parameters_default(p.start);
        mslip_elliptic_parameters_default(e.start);
        // These have no status and write to any address.
        let room = Memory::<[Parameters; 2]>::new(1);
        mslip_parameters_default(misaligned(room.start.cast()));
        mslip_elliptic_parameters_default(misaligned(room.start.cast()));
        for (status, p, e, c) in [
            (MSLIP_NULL_POINTER, p.start, e.start, c),
            (MSLIP_NULL_POINTER, null_mut(), null_mut(), contact.start),
            (MSLIP_BAD_ALIGNMENT, misaligned(p.start), misaligned(e.start), contact.start),
            (MSLIP_BAD_ALIGNMENT, p.start, e.start, misaligned(contact.start)),
        ] {
            assert_eq!([mslip_contact_init(p, c), mslip_contact_init_elliptic(e, c)], [status; 2]);
        }
        assert_eq!(mslip_contact_init(p.start, contact.start), MSLIP_BAD_FLAT_HALF_WIDTH);
        assert_eq!(mslip_contact_init_elliptic(e.start, contact.start), MSLIP_BAD_SEMI_AXIS_X);
    }
}

#[test]
fn contact_check() {
    check_contact(&[], |contact, _| unsafe { mslip_contact_check(contact) });
    for contact in contacts() {
        // SAFETY: a contact.
        assert_eq!(unsafe { mslip_contact_check(contact.start) }, MSLIP_OK);
    }
    for place in [0, 1, 100, 239, 240] {
        let [contact, ..] = contacts();
        unsafe {
            let value = &mut (*contact.start).reserved[place];
            *value = f64::from_bits(value.to_bits() ^ 1 << 20);
            assert_eq!(mslip_contact_check(contact.start), MSLIP_BAD_CONTACT);
        }
    }
}

#[test]
fn tractions_and_slip() {
    for contact in contacts() {
        let (force, half_width) = (0.6 * slip(&contact).0, contact.values()[0].half_width);
        let x = [-0.3, 0.0, 0.99, 1.0, 2.0].map(|x| x * half_width);
        let infinite = [(MSLIP_BAD_POSITION, f64::INFINITY)];
        let tractions =
            |contact, force, x, out: Outputs| unsafe { mslip_tractions(contact, force, 5, x, out[0], out[1]) };
        let slip = |contact, force, x, out: Outputs| unsafe { mslip_slip(contact, force, 5, x, out[0], out[1]) };
        let is_available = slip(contact.start, force, x.as_ptr(), &[null_mut(); 2]) == MSLIP_OK;
        check_array(&contact, &[5; 2], &x, &infinite, |contact, x, out| tractions(contact, force, x, out));
        if is_available {
            check_array(&contact, &[5; 2], &x, &infinite, |contact, x, out| slip(contact, force, x, out));
        } else {
            rejected(MSLIP_NOT_AVAILABLE, &[5; 2], |out| slip(contact.start, force, x.as_ptr(), out));
        }
        for function in [tractions, slip] {
            let at = |force, out: Outputs| function(contact.start, force, x.as_ptr(), out);
            rejected(MSLIP_BAD_FORCE, &[5; 2], |out| at(f64::NAN, out));
            rejected(MSLIP_FORCE_EXCEEDS_SLIP, &[5; 2], |out| at(force + 1e9, out));
        }
        check_length(2, |n, x, out| unsafe { mslip_tractions(contact.start, 0.0, n, x, out[0], out[1]) });
    }
}

#[test]
fn monotonic_curve() {
    for contact in contacts() {
        let (force, displacement) = slip(&contact);
        let by_force = |contact, n, x: *const f64, out: Outputs| unsafe {
            mslip_monotonic_displacement(contact, n, x, out[0], out[1], out[2])
        };
        let by_displacement = |contact, n, x: *const f64, out: Outputs| unsafe {
            mslip_monotonic_force(contact, n, x, out[0], out[1], out[2])
        };
        let parts = [0.0, -0.3, 0.8, 1.0];
        let invalid = [(MSLIP_BAD_FORCE, f64::NAN), (MSLIP_FORCE_EXCEEDS_SLIP, force + 1e9)];
        check_array(&contact, &[4; 3], &parts.map(|x| x * force), &invalid, |c, x, out| by_force(c, 4, x, out));
        let invalid = [(MSLIP_BAD_DISPLACEMENT, f64::INFINITY)];
        let x = parts.map(|x| x * displacement);
        check_array(&contact, &[4; 3], &x, &invalid, |c, x, out| by_displacement(c, 4, x, out));
        let derivatives = |contact, n, x: *const f64, out: Outputs| unsafe {
            mslip_monotonic_sensitivity(contact, n, x, out[0], out[1])
        };
        check_array(&contact, &[4, 24], &x, &invalid, |c, x, out| derivatives(c, 4, x, out));
        check_length(2, |n, x, out| derivatives(contact.start, n, x, out));
        check_length(3, |n, x, out| by_force(contact.start, n, x, out));
        check_length(3, |n, x, out| by_displacement(contact.start, n, x, out));
    }
}

#[test]
fn state_init_check_and_error() {
    let init = |n, state| unsafe { mslip_state_init(n, state) };
    assert_eq!(init(LEAST, null_mut()), MSLIP_NULL_POINTER);
    assert_eq!(init(LEAST, misaligned(Memory::new(LEAST + 1).start)), MSLIP_BAD_ALIGNMENT);
    assert_eq!(init(0, Memory::new(0).start), MSLIP_STATE_TOO_SHORT);
    assert_eq!(init(LEAST - 1, Memory::new(LEAST - 1).start), MSLIP_STATE_TOO_SHORT);
    assert_eq!(init(usize::MAX, Memory::new(5).start), MSLIP_BAD_ARRAY_SIZE);
    let state = unloaded(3);
    let error = |n, state, out: Outputs| unsafe { mslip_state_error(n, state, out[0]) };
    accepted(&[1], |out| error(state.length, state.start, out));
    check_state(&[1], error);
    check_state(&[], |n, state, _| unsafe { mslip_state_check(n, state) });
    for (place, value) in [(1, f64::NAN), (2, 0.5), (3, f64::INFINITY), (4, f64::NAN)] {
        let mut values = state.values().to_vec();
        values[place] = value;
        let changed = Memory::of(values);
        assert_eq!(unsafe { mslip_state_check(changed.length, changed.start) }, MSLIP_BAD_STATE);
    }
}

/// Displacements over that of gross slip with four nested reversals, closed loops, and gross slip.
const PATH: [f64; 8] = [0.9, -0.5, 0.4, 0.1, 0.2, -0.6, 1.5, 0.0];

#[test]
fn masing_update() {
    let update = |contact, n, state: *const f64, u, out: Outputs| unsafe {
        mslip_masing_update(contact, n, state, u, out[0], out[1], out[2], out[3])
    };
    let [rounded, _, frictionless] = contacts();
    for contact in [rounded, frictionless] {
        let unit = slip(&contact).1;
        let state = unloaded(4);
        let (n, lengths) = (state.length, [state.length, 1, 1, 1]);
        for u in PATH.map(|part| part * unit) {
            accepted(&lengths, |out| update(contact.start, n, state.start, u, out));
            let (next, force) = (Memory::<f64>::new(n), Memory::new(1));
            for new in [next.start, state.start] {
                let out = [new, force.start, null_mut(), null_mut()];
                assert_eq!(update(contact.start, n, state.start, u, &out), MSLIP_OK);
            }
            assert!(next.values()[1] == u && state.values()[1] == u && force.values()[0].is_finite());
            state_error(&next);
        }
        let invalid = [(MSLIP_BAD_DISPLACEMENT, f64::NAN)];
        check_value(&contact, &lengths, unit, &invalid, |contact, u, out| update(contact, n, state.start, u, out));
        check_state(&[LEAST, 1, 1, 1], |n, state, out| update(contact.start, n, state, 0.0, out));
        // A capacity of two reversals is exceeded.
        let small = unloaded(0);
        for part in [0.9, -0.8, 0.7, -0.6, 0.5] {
            let out = [small.start, null_mut(), null_mut(), null_mut()];
            assert_eq!(update(contact.start, LEAST, small.start, part * unit, &out), MSLIP_OK);
        }
        assert_eq!(state_error(&small) > 0.0, unit > 0.0);
    }
}

#[test]
fn masing_path() {
    let advance = |contact, n, state: *const f64, count, path: *const f64, out: Outputs| unsafe {
        mslip_masing_path(contact, n, state, count, path, out[0], out[1], out[2], out[3])
    };
    let [rounded, _, frictionless] = contacts();
    for contact in [rounded, frictionless] {
        let path = PATH.map(|part| part * slip(&contact).1);
        let points = path.len();
        // The second state is too small for all reversals.
        for reversals in [16, 2] {
            let state = unloaded(reversals);
            let (n, invalid) = (state.length, [(MSLIP_BAD_DISPLACEMENT, f64::NAN)]);
            check_array(&contact, &[n, points, points, points], &path, &invalid, |contact, path, out| {
                advance(contact, n, state.start, points, path, out)
            });
            accepted(&[n, 0, 0, 0], |out| advance(contact.start, n, state.start, 0, null(), out));
            let force = Memory::<f64>::new(points);
            let in_place = [state.start, force.start, null_mut(), null_mut()];
            assert_eq!(advance(contact.start, n, state.start, points, path.as_ptr(), &in_place), MSLIP_OK);
            assert!(state.values()[1] == path[points - 1] && force.values().iter().all(|force| force.is_finite()));
            state_error(&state);
        }
        check_state(&[LEAST, points, points, points], |n, state, out| {
            advance(contact.start, n, state, points, path.as_ptr(), out)
        });
    }
}

#[test]
fn masing_tractions() {
    for contact in contacts() {
        let (state, path) = (unloaded(4), [0.9, -0.4, 0.2].map(|part| part * slip(&contact).1));
        let (n, s, none) = (state.length, state.start, null_mut());
        let status = unsafe { mslip_masing_path(contact.start, n, s, 3, path.as_ptr(), s, none, none, none) };
        assert_eq!(status, MSLIP_OK);
        let x = [0.0, 0.5, 0.99].map(|x| x * contact.values()[0].half_width);
        let tractions = |contact, n, state: *const f64, x: *const f64, out: Outputs| unsafe {
            mslip_masing_tractions(contact, n, state, 3, x, out[0], out[1])
        };
        let invalid = [(MSLIP_BAD_POSITION, f64::NAN)];
        check_array(&contact, &[3; 2], &x, &invalid, |contact, x, out| tractions(contact, n, s, x, out));
        check_state(&[3; 2], |n, state, out| tractions(contact.start, n, state, x.as_ptr(), out));
    }
}

#[test]
fn cycles_and_equivalents() {
    for contact in contacts() {
        let (force, unit) = slip(&contact);
        let invalid = [(MSLIP_BAD_AMPLITUDE, -1.0), (MSLIP_BAD_AMPLITUDE, f64::NAN)];
        let stiffness = |contact, n, x: *const f64, out: Outputs| unsafe {
            mslip_complex_stiffness(contact, n, x, out[0], out[1], out[2], out[3])
        };
        let amplitudes = [0.0, 0.3, 1.5].map(|part| part * unit);
        check_array(&contact, &[3; 4], &amplitudes, &invalid, |contact, x, out| stiffness(contact, 3, x, out));
        check_length(4, |n, x, out| stiffness(contact.start, n, x, out));
        check_value(&contact, &[3; 2], 0.7 * unit, &invalid, |contact, amplitude, out| unsafe {
            mslip_hysteresis_loop(contact, amplitude, 3, out[0], out[1])
        });
        check_length(2, |n, _, out| unsafe { mslip_hysteresis_loop(contact.start, unit, n, out[0], out[1]) });
        check_value(&contact, &[1; 2], 0.7 * unit, &invalid, |contact, amplitude, out| unsafe {
            mslip_jenkins_equivalent(contact, amplitude, out[0], out[1])
        });

        let energy =
            |contact, n, x: *const f64, out: Outputs| unsafe { mslip_dissipated_energy(contact, n, x, out[0]) };
        let invalid = [(MSLIP_BAD_FORCE_AMPLITUDE, -1.0), (MSLIP_FORCE_EXCEEDS_SLIP, force + 1e9)];
        let forces = [0.0, 0.3, 1.0].map(|part| part * force);
        check_array(&contact, &[3], &forces, &invalid, |contact, x, out| energy(contact, 3, x, out));
        check_length(1, |n, x, out| energy(contact.start, n, x, out));

        let iwan = |contact, n, out: Outputs| unsafe { mslip_iwan_equivalent(contact, n, out[0], out[1], out[2]) };
        // The bisection for a contact with friction takes minutes under Miri.
        if !cfg!(miri) || unit == 0.0 {
            accepted(&[2, 2, 1], |out| iwan(contact.start, 2, out));
        }
        check_contact(&[2, 2, 1], |contact, out| iwan(contact, 2, out));
        rejected(MSLIP_BAD_COUNT, &[0, 0, 1], |out| iwan(contact.start, 0, out));
        rejected(MSLIP_BAD_COUNT, &[1], |out| iwan(contact.start, 1 << 20, &[null_mut(), null_mut(), out[0]]));
    }
}

#[test]
fn stiffness_tables() {
    let length = mslip_stiffness_table_length();
    let init = |contact, length, table| unsafe { mslip_stiffness_table_init(contact, length, table) };
    let tables: Vec<Memory<f64>> = contacts()
        .iter()
        .map(|contact| {
            let table = Memory::new(length);
            assert_eq!(init(contact.start, length, table.start), MSLIP_OK);
            table
        })
        .collect();
    let [rounded, ..] = contacts();
    let start = tables[0].start;
    for (status, contact, length, table) in [
        (MSLIP_TABLE_TOO_SHORT, rounded.start, length - 1, start),
        (MSLIP_TABLE_TOO_SHORT, rounded.start, 0, start),
        (MSLIP_NULL_POINTER, rounded.start, length, null_mut()),
        (MSLIP_NULL_POINTER, null_mut(), length, start),
        (MSLIP_BAD_ALIGNMENT, rounded.start, length, misaligned(start)),
        (MSLIP_BAD_ALIGNMENT, misaligned(rounded.start), length, start),
        (MSLIP_BAD_ARRAY_SIZE, rounded.start, usize::MAX, start),
        (MSLIP_BAD_CONTACT, bad_contacts()[0].start, length, start),
    ] {
        assert_eq!(init(contact, length, table), status);
    }
    let stiffness = |contact, table, n, x: *const f64, out: Outputs| unsafe {
        mslip_complex_stiffness_tabulated(contact, table, n, x, out[0], out[1], out[2], out[3])
    };
    for (contact, table) in contacts().iter().zip(&tables) {
        let unit = slip(contact).1;
        let invalid = [(MSLIP_BAD_AMPLITUDE, -1.0), (MSLIP_BAD_AMPLITUDE, f64::NAN)];
        let amplitudes = [0.0, 0.3, 0.7, 1.0, 1.01, 1.5].map(|part| part * unit);
        check_array(contact, &[6; 4], &amplitudes, &invalid, |contact, x, out| {
            stiffness(contact, table.start, 6, x, out)
        });
        check_length(4, |n, x, out| stiffness(contact.start, table.start, n, x, out));
        let with = |table, out: Outputs| stiffness(contact.start, table, 6, amplitudes.as_ptr(), out);
        rejected(MSLIP_NULL_POINTER, &[6; 4], |out| with(null(), out));
        rejected(MSLIP_BAD_ALIGNMENT, &[6; 4], |out| with(misaligned(table.start), out));
        // Nothing is read after an invalid tag.
        rejected(MSLIP_BAD_TABLE, &[6; 4], |out| with(Memory::of([0.0]).start, out));
    }
    let [_, ellipse, _] = contacts();
    rejected(MSLIP_BAD_TABLE, &[1; 4], |out| stiffness(ellipse.start, start, 1, [0.0].as_ptr(), out));
}

const RULES: [i32; 2] = [MSLIP_UNIFORM_SAMPLING, MSLIP_EVENT_DRIVEN];

fn workspace(harmonics: usize, samples: usize, rule: i32) -> Memory<f64> {
    let workspace = Memory::new(mslip_harmonic_workspace_length(harmonics, samples, rule));
    let status = unsafe { mslip_harmonic_workspace_init(harmonics, samples, rule, workspace.length, workspace.start) };
    assert_eq!(status, MSLIP_OK);
    workspace
}

#[test]
fn workspaces() {
    let length_of = mslip_harmonic_workspace_length;
    assert_eq!([length_of(0, 9, 0), length_of(2, 4, 0), length_of(2, 9, 2), length_of(2, 9, -1)], [0; 4]);
    for rule in RULES {
        let memory = workspace(2, 9, rule);
        let (length, start) = (memory.length, memory.start);
        for (status, harmonics, samples, rule, length, start) in [
            (MSLIP_WORKSPACE_TOO_SHORT, 2, 9, rule, length - 1, start),
            (MSLIP_WORKSPACE_TOO_SHORT, 2, 9, rule, 0, start),
            (MSLIP_NULL_POINTER, 2, 9, rule, length, null_mut()),
            (MSLIP_BAD_ALIGNMENT, 2, 9, rule, length - 1, misaligned(start)),
            (MSLIP_BAD_ARRAY_SIZE, 2, 9, rule, usize::MAX, start),
            (MSLIP_BAD_SAMPLES, 2, 4, rule, length, start),
            (MSLIP_BAD_HARMONICS, 0, 9, rule, length, start),
            (MSLIP_BAD_RULE, 2, 9, 7, length, start),
        ] {
            assert_eq!(unsafe { mslip_harmonic_workspace_init(harmonics, samples, rule, length, start) }, status);
        }
        // Only the header is read.
        let header = Memory::of(memory.values()[..2].to_vec());
        let (harmonics, samples, found) = (Memory::<usize>::new(1), Memory::<usize>::new(1), Memory::<i32>::new(1));
        let (w, h, s, r) = (header.start, harmonics.start, samples.start, found.start);
        let size = |w: *const f64, h, s, r| unsafe { mslip_harmonic_workspace_size(w, h, s, r) };
        assert_eq!(size(w, h, s, r), MSLIP_OK);
        assert_eq!((harmonics.values()[0], samples.values()[0], found.values()[0]), (2, 9, rule));
        assert_eq!(size(w, null_mut(), null_mut(), null_mut()), MSLIP_OK);
        assert_eq!(size(null(), h, s, r), MSLIP_NULL_POINTER);
        assert_eq!(size(misaligned(w), h, s, r), MSLIP_BAD_ALIGNMENT);
        for (h, s, r) in [(misaligned(h), s, r), (h, misaligned(s), r), (h, s, misaligned(r))] {
            assert_eq!(size(w, h, s, r), MSLIP_BAD_ALIGNMENT);
        }
        assert_eq!(size(Memory::of([0.0; 2]).start, h, s, r), MSLIP_BAD_WORKSPACE);
    }
}

#[test]
fn harmonic_force() {
    let force = |contact, workspace, u: *const f64, out: Outputs| unsafe {
        mslip_harmonic_force(contact, workspace, u, out[0], out[1], out[2])
    };
    let [rounded, _, frictionless] = contacts();
    let contacts = [rounded, frictionless];
    // Even and odd numbers of samples.
    for (rule, (harmonics, samples)) in RULES.into_iter().flat_map(|rule| [(rule, (1, 8)), (rule, (2, 9))]) {
        let n = 2 * harmonics + 1;
        let lengths = [n, n * n, 1];
        let workspace = workspace(harmonics, samples, rule);
        for contact in &contacts {
            let unit = slip(contact).1;
            // Constant, in microslip with all and with odd harmonics only, and in gross slip.
            for motion in [[0.0; 5], [0.1, 0.5, 0.2, 0.3, -0.2], [0.0, 0.6, 0.3, 0.0, 0.0], [0.2, 9.0, 1.0, 3.0, 1.0]] {
                let u = Memory::of(motion[..n].iter().map(|part| part * unit));
                accepted(&lengths, |out| force(contact.start, workspace.start, u.start, out));
                accepted(&[n, 6 * n], |out| unsafe {
                    mslip_harmonic_sensitivity(contact.start, workspace.start, u.start, out[0], out[1])
                });
            }
            let invalid = [(MSLIP_BAD_DISPLACEMENT, f64::NAN)];
            check_array(contact, &lengths, &vec![0.0; n], &invalid, |contact, u, out| {
                force(contact, workspace.start, u, out)
            });
            check_array(contact, &[n, 6 * n], &vec![0.0; n], &invalid, |contact, u, out| unsafe {
                mslip_harmonic_sensitivity(contact, workspace.start, u, out[0], out[1])
            });
        }
        let u = Memory::of(vec![0.0; n]);
        let with = |workspace, out: Outputs| force(contacts[0].start, workspace, u.start, out);
        rejected(MSLIP_NULL_POINTER, &lengths, |out| with(null_mut(), out));
        rejected(MSLIP_BAD_ALIGNMENT, &lengths, |out| with(misaligned(workspace.start), out));
        // Nothing is read after an invalid header.
        for (place, value) in [(0, 0.0), (0, f64::NAN), (1, 0.5), (1, f64::NAN), (1, -1.0)] {
            let mut header = workspace.values()[..2].to_vec();
            header[place] = value;
            let header = Memory::of(header);
            rejected(MSLIP_BAD_WORKSPACE, &lengths, |out| with(header.start, out));
        }
    }
}

#[test]
fn batches() {
    type Batch<'a> = &'a dyn Fn(*const mslip_contact, *const i32, *const i32, Outputs) -> i32;
    const N: usize = 4;
    let memory: Memory<mslip_contact> = Memory::new(N);
    let all = memory.start;
    for (i, contact) in contacts().iter().enumerate() {
        // SAFETY: the first three of four contacts.
        unsafe { ptr::copy_nonoverlapping(contact.start, all.add(i), 1) };
    }
    let unit = unsafe { (*all).slip_displacement };
    // The last item is skipped: its contact is uninitialised, its index invalid, and its displacement NaN.
    let (active, index) = (Memory::of([1, -1, 255, 0]), Memory::of([2, 0, 2, -1]));
    let [bad, ..] = bad_contacts();
    let check = |widths: &[usize], call: Batch| {
        for index in [null_mut(), index.start] {
            let outputs: Vec<Memory<f64>> = widths.iter().map(|width| Memory::new(N * width)).collect();
            let pointers: Vec<*mut f64> = outputs.iter().map(|output| output.start).collect();
            assert_eq!(call(all, index, active.start, &pointers), MSLIP_OK);
            for (output, width) in outputs.iter().zip(widths) {
                // SAFETY: three items of four.
                let written = unsafe { std::slice::from_raw_parts(output.start, 3 * width) };
                assert!(written.iter().all(|value| value.is_finite()));
            }
            assert_eq!(call(all, index, active.start, &vec![null_mut(); widths.len()]), MSLIP_OK);
        }
        let lengths: Vec<usize> = widths.iter().map(|width| N * width).collect();
        rejected(MSLIP_NULL_POINTER, &lengths, |out| call(null(), null(), active.start, out));
        rejected(MSLIP_BAD_ALIGNMENT, &lengths, |out| call(all, null(), misaligned(active.start), out));
        rejected(MSLIP_BAD_ALIGNMENT, &lengths, |out| call(all, misaligned(index.start), active.start, out));
        rejected(MSLIP_BAD_INDEX, &lengths, |out| call(all, index.start, null(), out));
        rejected(MSLIP_BAD_INDEX, &lengths, |out| call(all, Memory::of([0, 0, 4, 0]).start, null(), out));
        unsafe { ptr::copy(bad.start, all.add(3), 1) };
        rejected(MSLIP_BAD_CONTACT, &lengths, |out| call(all, null(), null(), out));
    };

    let amplitude = Memory::of([0.5, 0.9, 1.5, f64::NAN].map(|part| part * unit));
    let stiffness = |contacts, index, active, x: *const f64, o: Outputs| unsafe {
        mslip_batch_complex_stiffness(N, N, contacts, index, active, x, o[0], o[1], o[2], o[3])
    };
    check(&[1; 4], &|contacts, index, active, out| stiffness(contacts, index, active, amplitude.start, out));
    rejected(MSLIP_NULL_POINTER, &[N; 4], |out| stiffness(all, null(), active.start, null(), out));

    let states: Memory<f64> = Memory::new(N * LEAST);
    for i in 0..3 {
        assert_eq!(unsafe { mslip_state_init(LEAST, states.start.add(LEAST * i)) }, MSLIP_OK);
    }
    let update = |contacts, index, active, length, states: *const f64, x: *const f64, o: Outputs| unsafe {
        mslip_batch_masing_update(N, N, contacts, index, active, length, states, x, o[0], o[1], o[2], o[3])
    };
    let valid = |contacts, index, active, out: Outputs| {
        update(contacts, index, active, LEAST, states.start, amplitude.start, out)
    };
    check(&[LEAST, 1, 1, 1], &valid);
    assert_eq!(valid(all, null(), active.start, &[states.start, null_mut(), null_mut(), null_mut()]), MSLIP_OK);
    let far = Memory::of([0.0, 0.0, f64::NAN, 0.0]);
    for (status, length, states, x) in [
        (MSLIP_NULL_POINTER, LEAST, null_mut(), amplitude.start),
        (MSLIP_NULL_POINTER, LEAST, states.start, null_mut()),
        (MSLIP_STATE_TOO_SHORT, 0, states.start, amplitude.start),
        (MSLIP_BAD_ARRAY_SIZE, usize::MAX / 2, states.start, amplitude.start),
        (MSLIP_BAD_DISPLACEMENT, LEAST, states.start, far.start),
    ] {
        let lengths = [N * LEAST, N, N, N];
        rejected(status, &lengths, |out| update(all, null(), active.start, length, states, x, out));
    }

    for rule in RULES {
        let workspace = workspace(1, 8, rule);
        let motion = Memory::of([0.1, 0.5, 0.2, 0.0, 1.5, 0.0, 0.0, 0.3, 0.1, f64::NAN, 0.0, 0.0].map(|x| x * unit));
        let force = |contacts, index, active, workspace, u: *const f64, o: Outputs| unsafe {
            mslip_batch_harmonic_force(N, N, contacts, index, active, workspace, u, o[0], o[1], o[2])
        };
        check(&[3, 9, 1], &|contacts, index, active, out| {
            force(contacts, index, active, workspace.start, motion.start, out)
        });
        for (workspace, u) in [(null_mut(), motion.start), (workspace.start, null_mut())] {
            rejected(MSLIP_NULL_POINTER, &[12, 36, 4], |out| force(all, null(), active.start, workspace, u, out));
        }
    }
}

static SPHERE: EllipticParameters = EllipticParameters {
    semi_axis_x: 1e-4,
    semi_axis_y: 1e-4,
    normal_force: 100.0,
    friction_coefficient: 0.3,
    material: [STEEL; 2],
};

/// A slightly flattened element by approach, and a sphere by normal force, both with one direction; a sphere by approach with two.
/// Initialised once, which takes minutes under Miri.
fn elements() -> [Memory<mslip_element>; 3] {
    static INITIALISED: OnceLock<[Vec<u8>; 3]> = OnceLock::new();
    let initialised = |init: &dyn Fn(*mut mslip_element) -> i32| {
        let element = Memory::<mslip_element>::new(1);
        assert_eq!(init(element.start), MSLIP_OK);
        // SAFETY: an initialised element consists of bytes.
        unsafe { std::slice::from_raw_parts(element.start.cast::<u8>(), size_of::<mslip_element>()) }.to_vec()
    };
    let elements = INITIALISED.get_or_init(|| {
        let rounded = flat(1e-4, 0.02);
        [
            initialised(&|element| unsafe { mslip_element_init(&raw const rounded, 1, MSLIP_APPROACH, element) }),
            initialised(&|element| unsafe {
                mslip_element_init_elliptic(&raw const SPHERE, 1, MSLIP_NORMAL_FORCE, element)
            }),
            // The springs of both directions take too long under Miri: without friction there are none.
            initialised(&|element| unsafe {
                let sphere = EllipticParameters { friction_coefficient: if cfg!(miri) { 0.0 } else { 0.3 }, ..SPHERE };
                mslip_element_init_elliptic(&raw const sphere, 2, MSLIP_APPROACH, element)
            }),
        ]
    });
    elements.each_ref().map(|bytes| {
        let memory = Memory::<mslip_element>::new(1);
        // SAFETY: elements may be copied as bytes.
        unsafe { ptr::copy_nonoverlapping(bytes.as_ptr(), memory.start.cast(), bytes.len()) };
        memory
    })
}

/// Units of an element's tangential displacement and normal component.
fn units(element: &Memory<mslip_element>) -> [f64; 2] {
    let e = &element.values()[0];
    let normal = if e.normal_input == MSLIP_NORMAL_FORCE { e.normal_force } else { e.approach };
    [e.friction_coefficient * e.approach, normal]
}

fn directions(element: &Memory<mslip_element>) -> i32 {
    element.values()[0].directions
}

/// The vectors of displacements `[x, y]` in the units of an element; with two directions oblique.
fn vectors(element: &Memory<mslip_element>, values: &[[f64; 2]]) -> Vec<f64> {
    let [u, w] = units(element);
    let vector = |[x, y]: &[f64; 2]| {
        if directions(element) == 1 { vec![x * u, y * w] } else { vec![x * u, -0.4 * x * u, y * w] }
    };
    values.iter().flat_map(vector).collect()
}

/// NULL, misaligned and uninitialised elements are rejected.
fn check_element(lengths: &[usize], call: impl Fn(*const mslip_element, Outputs) -> i32) {
    rejected(MSLIP_NULL_POINTER, lengths, |out| call(null(), out));
    let [element, ..] = elements();
    rejected(MSLIP_BAD_ALIGNMENT, lengths, |out| call(misaligned(element.start), out));
    for byte in [0, 0xff] {
        // SAFETY: one element.
        unsafe { element.start.write_bytes(byte, 1) };
        rejected(MSLIP_BAD_ELEMENT, lengths, |out| call(element.start, out));
    }
}

/// Number of doubles in the state of an element with four pieces, the shortest.
const LEAST_OF_ELEMENT: usize = 28;

fn open_state(directions: i32, pieces: usize) -> Memory<f64> {
    let state = Memory::new(mslip_element_state_length(directions, pieces));
    assert_eq!(unsafe { mslip_element_state_init(directions, state.length, state.start) }, MSLIP_OK);
    state
}

/// NULL, misaligned, short, uninitialised and truncated states are rejected, and those of the other number of directions.
fn check_element_state(directions: i32, lengths: &[usize], call: impl Fn(usize, *const f64, Outputs) -> i32) {
    let (state, other) = (open_state(directions, 0), open_state(3 - directions, 1000));
    let least = state.length;
    rejected(MSLIP_NULL_POINTER, lengths, |out| call(least, null(), out));
    rejected(MSLIP_BAD_ALIGNMENT, lengths, |out| call(least, misaligned(state.start), out));
    rejected(MSLIP_BAD_DIRECTIONS, lengths, |out| call(other.length.min(least), other.start, out));
    for length in [0, 5, least - 1] {
        let short = Memory::of(state.values()[..length].to_vec());
        rejected(MSLIP_STATE_TOO_SHORT, lengths, |out| call(length, short.start, out));
    }
    for tag in [
        0.0,
        f64::NAN,
        f64::from_bits(state.values()[0].to_bits() + 5),
        f64::from_bits(state.values()[0].to_bits() - 1),
    ] {
        let mut values = state.values().to_vec();
        values[0] = tag;
        let bad = Memory::of(values);
        rejected(MSLIP_BAD_STATE, lengths, |out| call(least, bad.start, out));
    }
}

#[test]
fn element_init_and_check() {
    let (p, e) = (Memory::<Parameters>::of([flat(0.0, 0.02)]), Memory::<EllipticParameters>::new(1));
    let element = Memory::<mslip_element>::new(1);
    unsafe {
        mslip_elliptic_parameters_default(e.start);
        for (status, p, e, element) in [
            (MSLIP_NULL_POINTER, p.start, e.start, null_mut()),
            (MSLIP_NULL_POINTER, null_mut(), null_mut(), element.start),
            (MSLIP_BAD_ALIGNMENT, misaligned(p.start), misaligned(e.start), element.start),
            (MSLIP_BAD_ALIGNMENT, p.start, e.start, misaligned(element.start)),
        ] {
            let statuses = [mslip_element_init(p, 1, 0, element), mslip_element_init_elliptic(e, 1, 0, element)];
            assert_eq!(statuses, [status; 2]);
        }
        for (status, directions, input) in
            [(MSLIP_BAD_DIRECTIONS, 0, 0), (MSLIP_BAD_DIRECTIONS, 3, 0), (MSLIP_BAD_NORMAL_INPUT, 2, 2)]
        {
            assert_eq!(mslip_element_init(p.start, directions, input, element.start), status);
            assert_eq!(mslip_element_init_elliptic(e.start, directions, input, element.start), status);
        }
        assert_eq!(mslip_element_init_elliptic(e.start, 1, 0, element.start), MSLIP_BAD_SEMI_AXIS_X);
    }
    check_element(&[], |element, _| unsafe { mslip_element_check(element) });
    for element in elements() {
        assert_eq!(unsafe { mslip_element_check(element.start) }, MSLIP_OK);
        unsafe {
            let value = &mut (*element.start).reserved[2000];
            *value = f64::from_bits(value.to_bits() ^ 1 << 20);
            assert_eq!(mslip_element_check(element.start), MSLIP_BAD_ELEMENT);
        }
    }
}

#[test]
fn normal_law() {
    for element in elements() {
        let e = &element.values()[0];
        let (approach, force) = (e.approach, e.normal_force);
        for (unit, status, law) in [
            (approach, MSLIP_BAD_DISPLACEMENT, mslip_normal_force as unsafe extern "C" fn(_, _, _, _, _, _) -> _),
            (force, MSLIP_BAD_NORMAL_FORCE, mslip_normal_approach),
        ] {
            let call = |element, n, x: *const f64, out: Outputs| unsafe { law(element, n, x, out[0], out[1], out[2]) };
            // Open, within and beyond the tables.
            let x = Memory::of([0.0, 0.3, 1.0, 2.5].map(|part| part * unit));
            accepted(&[4; 3], |out| call(element.start, 4, x.start, out));
            check_element(&[4; 3], |element, out| call(element, 4, x.start, out));
            rejected(MSLIP_NULL_POINTER, &[4; 3], |out| call(element.start, 4, null(), out));
            let invalid = Memory::of([0.0, 0.0, 0.0, f64::NAN]);
            rejected(status, &[4; 3], |out| call(element.start, 4, invalid.start, out));
            check_length(3, |n, x, out| call(element.start, n, x, out));
        }
    }
}

#[test]
fn element_state_init_check_and_error() {
    let init = |directions, n, state| unsafe { mslip_element_state_init(directions, n, state) };
    assert_eq!([0, 3].map(|directions| mslip_element_state_length(directions, 5)), [0; 2]);
    assert_eq!(mslip_element_state_length(1, 0), LEAST_OF_ELEMENT);
    assert_eq!(init(0, LEAST_OF_ELEMENT, null_mut()), MSLIP_BAD_DIRECTIONS);
    let fixed = mslip_element_state_length(2, 0);
    assert!(fixed > LEAST_OF_ELEMENT && mslip_element_state_length(2, usize::MAX) == fixed);
    assert_eq!(init(2, fixed, null_mut()), MSLIP_NULL_POINTER);
    assert_eq!(init(2, fixed - 1, Memory::new(fixed - 1).start), MSLIP_STATE_TOO_SHORT);
    assert_eq!(init(1, LEAST_OF_ELEMENT, null_mut()), MSLIP_NULL_POINTER);
    assert_eq!(init(1, LEAST_OF_ELEMENT, misaligned(Memory::new(LEAST_OF_ELEMENT + 1).start)), MSLIP_BAD_ALIGNMENT);
    assert_eq!(init(1, 0, Memory::new(0).start), MSLIP_STATE_TOO_SHORT);
    assert_eq!(init(1, LEAST_OF_ELEMENT - 1, Memory::new(LEAST_OF_ELEMENT - 1).start), MSLIP_STATE_TOO_SHORT);
    assert_eq!(init(1, usize::MAX, Memory::new(5).start), MSLIP_BAD_ARRAY_SIZE);
    for directions in [1, 2] {
        let state = open_state(directions, 5);
        let error = |n, state, out: Outputs| unsafe { mslip_element_state_error(directions, n, state, out[0]) };
        accepted(&[1], |out| error(state.length, state.start, out));
        check_element_state(directions, &[1], error);
        let check = |n, state, _: Outputs| unsafe { mslip_element_state_check(directions, n, state) };
        check_element_state(directions, &[], check);
        for place in 1..8 {
            let mut values = state.values().to_vec();
            values[place] = f64::NAN;
            let changed = Memory::of(values);
            assert_eq!(check(changed.length, changed.start, &[]), MSLIP_BAD_STATE);
        }
    }
}

/// Displacements over the units of an element: many pieces, slip, gross slip, separation.
const ELEMENT_PATH: [[f64; 2]; 10] = [
    [0.02, 0.2],
    [0.0, 0.4],
    [0.03, 0.5],
    [0.01, 0.7],
    [0.04, 0.8],
    [0.3, 0.9],
    [-0.2, 0.6],
    [2.0, 0.7],
    [1.0, 0.0],
    [1.1, 0.5],
];

#[test]
fn element_update_and_path() {
    let update = |element, n, state: *const f64, x: *const f64, out: Outputs| unsafe {
        mslip_element_update(element, n, state, x, out[0], out[1], out[2], out[3])
    };
    let advance = |element, n, state: *const f64, count, x: *const f64, out: Outputs| unsafe {
        mslip_element_path(element, n, state, count, x, out[0], out[1], out[2], out[3])
    };
    for element in elements() {
        let directions = directions(&element);
        let m = 1 + directions as usize;
        let path = Memory::of(vectors(&element, &ELEMENT_PATH));
        let (steps, none) = (ELEMENT_PATH.len(), null_mut());
        // The second state is too small for all pieces.
        for pieces in [8, 4] {
            let (state, start) = (open_state(directions, pieces), open_state(directions, pieces));
            let n = state.length;
            for i in 0..steps {
                let x = Memory::of(path.values()[m * i..][..m].to_vec());
                // Only what is in use of the new state is written.
                let (next, force, tangent, energy) =
                    (open_state(directions, pieces), Memory::new(m), Memory::new(m * m), Memory::new(1));
                let out = [next.start, force.start, tangent.start, energy.start];
                assert_eq!(update(element.start, n, state.start, x.start, &out), MSLIP_OK);
                accepted(&[m, m * m, 1], |out| {
                    update(element.start, n, state.start, x.start, &[none, out[0], out[1], out[2]])
                });
                assert_eq!(update(element.start, n, state.start, x.start, &[state.start, none, none, none]), MSLIP_OK);
                assert_eq!(next.values()[..3], state.values()[..3]);
                assert_eq!(unsafe { mslip_element_state_check(directions, n, next.start) }, MSLIP_OK);
            }
            let lengths = [n, m * steps, m * m * steps, steps];
            accepted(&lengths, |out| advance(element.start, n, start.start, steps, path.start, out));
            accepted(&[n, 0, 0, 0], |out| advance(element.start, n, start.start, 0, null(), out));
            let out = [start.start, none, none, none];
            assert_eq!(advance(element.start, n, start.start, steps, path.start, &out), MSLIP_OK);
            assert_eq!(start.values()[..3], state.values()[..3]);
        }
        let x = Memory::of(vectors(&element, &[[0.1, 0.5]]));
        let one = [mslip_element_state_length(directions, 0), m, m * m, 1];
        let state = open_state(directions, 0);
        let (n, s) = (state.length, state.start);
        check_element(&one, |element, out| update(element, n, s, x.start, out));
        check_element(&one, |element, out| advance(element, n, s, 1, x.start, out));
        check_element_state(directions, &one, |n, state, out| update(element.start, n, state, x.start, out));
        check_element_state(directions, &one, |n, state, out| advance(element.start, n, state, 1, x.start, out));
        rejected(MSLIP_NULL_POINTER, &one, |out| update(element.start, n, s, null(), out));
        rejected(MSLIP_NULL_POINTER, &one, |out| advance(element.start, n, s, 1, null(), out));
        rejected(MSLIP_BAD_ALIGNMENT, &one, |out| update(element.start, n, s, misaligned(x.start), out));
        rejected(MSLIP_BAD_ARRAY_SIZE, &one, |out| advance(element.start, n, s, usize::MAX / 2, x.start, out));
        for k in 0..4 {
            let bad = |out: Outputs| {
                let mut out = out.to_vec();
                out[k] = misaligned(out[k]);
                out
            };
            rejected(MSLIP_BAD_ALIGNMENT, &one, |out| update(element.start, n, s, x.start, &bad(out)));
            rejected(MSLIP_BAD_ALIGNMENT, &one, |out| advance(element.start, n, s, 1, x.start, &bad(out)));
        }
        let by_force = element.values()[0].normal_input == MSLIP_NORMAL_FORCE;
        let status = if by_force { MSLIP_BAD_NORMAL_FORCE } else { MSLIP_BAD_DISPLACEMENT };
        for place in 0..m {
            let mut x = x.values().to_vec();
            x[place] = f64::NAN;
            let (status, x) = (if place == m - 1 { status } else { MSLIP_BAD_DISPLACEMENT }, Memory::of(x));
            rejected(status, &one, |out| update(element.start, n, s, x.start, out));
            rejected(status, &one, |out| advance(element.start, n, s, 1, x.start, out));
        }
    }
}

/// Slip with springs, with all outputs.
#[test]
fn slip_in_two_directions() {
    let element = Memory::<mslip_element>::new(1);
    assert_eq!(unsafe { mslip_element_init_elliptic(&raw const SPHERE, 2, MSLIP_APPROACH, element.start) }, MSLIP_OK);
    let (state, [u, w]) = (open_state(2, 0), units(&element));
    let (n, s) = (state.length, state.start);
    let path = Memory::of([0.0, 0.0, w, 0.3 * u, 0.1 * u, w, 0.6 * u, -0.4 * u, 0.8 * w]);
    let (force, tangent, energy) = (Memory::new(9), Memory::new(27), Memory::new(3));
    let status =
        unsafe { mslip_element_path(element.start, n, s, 3, path.start, s, force.start, tangent.start, energy.start) };
    assert_eq!((status, energy.values()[2] > 0.0), (MSLIP_OK, true));
    let values = [force.values(), tangent.values(), energy.values()].concat();
    assert!(values.iter().all(|value: &f64| value.is_finite()));
}

#[test]
fn element_tractions() {
    let [by_approach, by_force, oblique] = elements();
    for element in [by_approach, by_force] {
        let ([u, w], state, none) = (units(&element), open_state(1, 4), null_mut());
        let path = Memory::of([0.02 * u, 0.6 * w, 0.3 * u, 0.8 * w]);
        let (n, s) = (state.length, state.start);
        let status = unsafe { mslip_element_path(element.start, n, s, 2, path.start, s, none, none, none) };
        assert_eq!(status, MSLIP_OK);
        let half_width = element.values()[0].half_width;
        let tractions = |element, n, state: *const f64, points, x: *const f64, out: Outputs| unsafe {
            mslip_element_tractions(element, n, state, points, x, out[0], out[1])
        };
        let x = Memory::of([0.0, 0.5, -0.9, 2.0].map(|part| part * half_width));
        accepted(&[4; 2], |out| tractions(element.start, n, s, 4, x.start, out));
        check_element(&[4; 2], |element, out| tractions(element, n, s, 4, x.start, out));
        check_element_state(1, &[4; 2], |n, state, out| tractions(element.start, n, state, 4, x.start, out));
        rejected(MSLIP_NULL_POINTER, &[4; 2], |out| tractions(element.start, n, s, 4, null(), out));
        let invalid = Memory::of([0.0, f64::INFINITY]);
        rejected(MSLIP_BAD_POSITION, &[2; 2], |out| tractions(element.start, n, s, 2, invalid.start, out));
        check_length(2, |points, x, out| tractions(element.start, n, s, points, x, out));
    }
    let (state, x) = (open_state(2, 0), Memory::of([0.0]));
    rejected(MSLIP_NOT_AVAILABLE, &[1; 2], |out| unsafe {
        mslip_element_tractions(oblique.start, state.length, state.start, 1, x.start, out[0], out[1])
    });
}

fn element_workspace(directions: i32, harmonics: usize, samples: usize) -> Memory<f64> {
    let rule = MSLIP_UNIFORM_SAMPLING;
    let workspace = Memory::new(mslip_element_workspace_length(directions, harmonics, samples, rule));
    let (length, start) = (workspace.length, workspace.start);
    let status = unsafe { mslip_element_workspace_init(directions, harmonics, samples, rule, length, start) };
    assert_eq!(status, MSLIP_OK);
    workspace
}

#[test]
fn element_workspaces() {
    for one_or_two in [1, 2] {
        check_element_workspace(one_or_two);
    }
}

fn check_element_workspace(one_or_two: i32) {
    let memory = element_workspace(one_or_two, 2, 9);
    let (length, start) = (memory.length, memory.start);
    for (status, directions, harmonics, samples, rule, length, start) in [
        (MSLIP_WORKSPACE_TOO_SHORT, one_or_two, 2, 9, 0, length - 1, start),
        (MSLIP_WORKSPACE_TOO_SHORT, one_or_two, 2, 9, 0, 0, start),
        (MSLIP_NULL_POINTER, one_or_two, 2, 9, 0, length, null_mut()),
        (MSLIP_BAD_ALIGNMENT, one_or_two, 2, 9, 0, length - 1, misaligned(start)),
        (MSLIP_BAD_ARRAY_SIZE, one_or_two, 2, 9, 0, usize::MAX, start),
        (MSLIP_BAD_SAMPLES, one_or_two, 2, 4, 0, length, start),
        (MSLIP_BAD_HARMONICS, one_or_two, 0, 9, 0, length, start),
        (MSLIP_BAD_RULE, one_or_two, 2, 9, 7, length, start),
        (MSLIP_NOT_AVAILABLE, one_or_two, 2, 9, MSLIP_EVENT_DRIVEN, length, start),
        (MSLIP_BAD_DIRECTIONS, 0, 2, 9, 0, length, start),
    ] {
        let answer = unsafe { mslip_element_workspace_init(directions, harmonics, samples, rule, length, start) };
        assert_eq!(answer, status);
    }
    // Only the header is read.
    let header = Memory::of(memory.values()[..2].to_vec());
    let (kinds, sizes) = (Memory::<i32>::new(2), Memory::<usize>::new(2));
    let (k, s) = (kinds.start, sizes.start);
    let size = |w: *const f64, d, h, s, r| unsafe { mslip_element_workspace_size(w, d, h, s, r) };
    unsafe {
        assert_eq!(size(header.start, k, s, s.add(1), k.add(1)), MSLIP_OK);
        assert_eq!((kinds.values(), sizes.values()), (&[one_or_two, MSLIP_UNIFORM_SAMPLING][..], &[2, 9][..]));
        let none = null_mut();
        assert_eq!(size(header.start, none, null_mut(), null_mut(), none), MSLIP_OK);
        assert_eq!(size(null(), k, s, s.add(1), k.add(1)), MSLIP_NULL_POINTER);
        assert_eq!(size(misaligned(header.start), k, s, s.add(1), k.add(1)), MSLIP_BAD_ALIGNMENT);
        assert_eq!(size(header.start, misaligned(k), s, s.add(1), k.add(1)), MSLIP_BAD_ALIGNMENT);
        assert_eq!(size(header.start, k, misaligned(s), s.add(1), k.add(1)), MSLIP_BAD_ALIGNMENT);
        assert_eq!(size(Memory::of([0.0; 2]).start, k, s, s.add(1), k.add(1)), MSLIP_BAD_WORKSPACE);
    }
}

#[test]
fn element_harmonic_force() {
    let force = |element, workspace, x: *const f64, out: Outputs| unsafe {
        mslip_element_harmonic_force(element, workspace, x, out[0], out[1], out[2])
    };
    // Even and odd numbers of samples.
    for (harmonics, samples) in [(1, 8), (2, 9)] {
        let n = 2 * harmonics + 1;
        let lengths = [2 * n, 4 * n * n, 1];
        let workspace = element_workspace(1, harmonics, samples);
        let [by_approach, by_force, oblique] = elements();
        for element in [&by_approach, &by_force] {
            let [u, w] = units(element);
            let mut motion = vec![0.0; 2 * n];
            // Constant; in microslip under constant and varying load; in gross slip.
            for (tangential, normal) in [(0.0, 0.0), (0.3, 0.0), (0.3, 0.4), (3.0, 0.3)] {
                (motion[1], motion[2]) = (tangential * u, 0.1 * tangential * u);
                (motion[n], motion[n + 2]) = (0.5 * w, normal * w);
                let x = Memory::of(motion.clone());
                accepted(&lengths, |out| force(element.start, workspace.start, x.start, out));
            }
            motion[2 * n - 1] = f64::NAN;
            let x = Memory::of(motion.clone());
            rejected(MSLIP_BAD_DISPLACEMENT, &lengths, |out| force(element.start, workspace.start, x.start, out));
        }
        // Separation, for a part of the period and for all of it.
        let [u, w] = units(&by_approach);
        let mut motion = vec![0.0; 2 * n];
        (motion[1], motion[n + 1]) = (0.3 * u, 0.6 * w);
        for mean in [0.2, -0.7] {
            motion[n] = mean * w;
            let x = Memory::of(motion.clone());
            accepted(&lengths, |out| force(by_approach.start, workspace.start, x.start, out));
        }
        let x = Memory::of(motion);
        rejected(MSLIP_BAD_NORMAL_FORCE, &lengths, |out| force(by_force.start, workspace.start, x.start, out));
        check_element(&lengths, |element, out| force(element, workspace.start, x.start, out));
        let with = |workspace, out: Outputs| force(by_approach.start, workspace, x.start, out);
        rejected(MSLIP_NULL_POINTER, &lengths, |out| with(null_mut(), out));
        rejected(MSLIP_BAD_ALIGNMENT, &lengths, |out| with(misaligned(workspace.start), out));
        rejected(MSLIP_NULL_POINTER, &lengths, |out| force(by_approach.start, workspace.start, null(), out));
        for (place, value) in [(0, 0.0), (0, f64::NAN), (1, 0.5), (1, -1.0)] {
            let mut header = workspace.values()[..2].to_vec();
            header[place] = value;
            let header = Memory::of(header);
            rejected(MSLIP_BAD_WORKSPACE, &lengths, |out| with(header.start, out));
        }
        // Two directions: three components.
        let ([u, w], of_two) = (units(&oblique), element_workspace(2, harmonics, samples));
        let mut motion = vec![0.0; 3 * n];
        (motion[1], motion[n + 2]) = (0.3 * u, 0.2 * u);
        for (mean, swing) in [(0.5, 0.0), (0.5, 0.3), (0.2, 0.6), (-0.7, 0.6)] {
            (motion[2 * n], motion[2 * n + 1]) = (mean * w, swing * w);
            let x = Memory::of(motion.clone());
            accepted(&[3 * n, 9 * n * n, 1], |out| force(oblique.start, of_two.start, x.start, out));
        }
        for place in 0..3 * n {
            let mut motion = motion.clone();
            motion[place] = f64::NAN;
            let x = Memory::of(motion);
            let lengths = [3 * n, 9 * n * n, 1];
            rejected(MSLIP_BAD_DISPLACEMENT, &lengths, |out| force(oblique.start, of_two.start, x.start, out));
        }
        rejected(MSLIP_BAD_DIRECTIONS, &[], |_| {
            let none = null_mut();
            force(oblique.start, workspace.start, x.start, &[none, none, none])
        });
        rejected(MSLIP_BAD_DIRECTIONS, &lengths, |out| with(of_two.start, out));
    }
}

#[test]
fn element_batches() {
    const N: usize = 3;
    let memory: Memory<mslip_element> = Memory::new(N);
    let [element, _, oblique] = elements();
    let [u, w] = units(&element);
    // SAFETY: the first two of three elements.
    unsafe {
        ptr::copy_nonoverlapping(element.start, memory.start, 1);
        ptr::copy_nonoverlapping(element.start, memory.start.add(1), 1);
    }
    // The last item is skipped: its element and its state are uninitialised, its index invalid, and its displacement NaN.
    let (active, index) = (Memory::of([1, -1, 0]), Memory::of([1, 0, -1]));
    let (all, none) = (memory.start, null_mut());
    let states: Memory<f64> = Memory::new(N * LEAST_OF_ELEMENT);
    for i in 0..2 {
        let state = unsafe { states.start.add(LEAST_OF_ELEMENT * i) };
        assert_eq!(unsafe { mslip_element_state_init(1, LEAST_OF_ELEMENT, state) }, MSLIP_OK);
    }
    let update = |elements, index, active, length, states: *const f64, x: *const f64, o: Outputs| unsafe {
        mslip_batch_element_update(N, N, elements, index, active, length, states, x, o[0], o[1], o[2], o[3])
    };
    let x = Memory::of([0.1 * u, 0.5 * w, 3.0 * u, 0.3 * w, f64::NAN, f64::NAN]);
    let lengths = [N * LEAST_OF_ELEMENT, 2 * N, 4 * N, N];
    let n = LEAST_OF_ELEMENT;
    for index in [null_mut(), index.start] {
        for new in [none, states.start] {
            let (force, tangent, energy) = (Memory::new(2 * N), Memory::new(4 * N), Memory::new(N));
            let out = [new, force.start, tangent.start, energy.start];
            assert_eq!(update(all, index, active.start, n, states.start, x.start, &out), MSLIP_OK);
            // SAFETY: two items of three are written.
            let written = unsafe { std::slice::from_raw_parts(force.start, 4) };
            assert!(written.iter().all(|value: &f64| value.is_finite()));
        }
    }
    let (bad, outside) = (Memory::of([u, w, u, w, u, f64::NAN]), Memory::of([0, 3, 0]));
    for (status, elements, index, length, states, x) in [
        (MSLIP_NULL_POINTER, null_mut(), null_mut(), n, states.start, x.start),
        (MSLIP_NULL_POINTER, all, null_mut(), n, null_mut(), x.start),
        (MSLIP_NULL_POINTER, all, null_mut(), n, states.start, null_mut()),
        (MSLIP_BAD_ALIGNMENT, misaligned(all), null_mut(), n, states.start, x.start),
        (MSLIP_BAD_ALIGNMENT, all, misaligned(index.start), n, states.start, x.start),
        (MSLIP_STATE_TOO_SHORT, all, null_mut(), 0, states.start, x.start),
        (MSLIP_BAD_ARRAY_SIZE, all, null_mut(), usize::MAX / 2, states.start, x.start),
        (MSLIP_BAD_INDEX, all, outside.start, n, states.start, x.start),
    ] {
        rejected(status, &lengths, |out| update(elements, index, active.start, length, states, x, out));
    }
    rejected(MSLIP_BAD_DISPLACEMENT, &lengths, |out| {
        let first = Memory::of([u, f64::NAN, u, w, u, w]);
        update(all, null_mut(), active.start, n, states.start, first.start, out)
    });
    unsafe { all.add(2).write_bytes(0, 1) };
    rejected(MSLIP_BAD_ELEMENT, &lengths, |out| update(all, null_mut(), null_mut(), n, states.start, bad.start, out));

    let workspace = element_workspace(1, 1, 8);
    let mut motion = vec![f64::NAN; 6 * N];
    for i in 0..2 {
        motion[6 * i..6 * (i + 1)].copy_from_slice(&[0.0, 0.4 * u, 0.1 * u, 0.5 * w, 0.0, 0.3 * w]);
    }
    let motion = Memory::of(motion);
    let force = |elements, index, workspace, x: *const f64, o: Outputs| unsafe {
        mslip_batch_element_harmonic_force(N, N, elements, index, active.start, workspace, x, o[0], o[1], o[2])
    };
    for index in [null_mut(), index.start] {
        let (coefficients, jacobian, energy) = (Memory::new(6 * N), Memory::new(36 * N), Memory::new(N));
        let out = [coefficients.start, jacobian.start, energy.start];
        assert_eq!(force(all, index, workspace.start, motion.start, &out), MSLIP_OK);
        // SAFETY: two items of three are written.
        let written = unsafe { std::slice::from_raw_parts(jacobian.start, 72) };
        assert!(written.iter().all(|value: &f64| value.is_finite()));
    }
    for (status, workspace, x) in [
        (MSLIP_NULL_POINTER, null_mut(), motion.start),
        (MSLIP_NULL_POINTER, workspace.start, null_mut()),
        (MSLIP_BAD_ALIGNMENT, misaligned(workspace.start), motion.start),
    ] {
        rejected(status, &[6 * N, 36 * N, N], |out| force(all, null_mut(), workspace, x, out));
    }

    // Two directions, three components; a mixture is rejected, unless items are skipped.
    let (state, x) = (open_state(2, 0), Memory::of(vectors(&oblique, &[[0.1, 0.5], [3.0, 0.3], [0.2, 0.4]])));
    let n = state.length;
    let states = Memory::of(state.values().repeat(N));
    let of_two = element_workspace(2, 1, 8);
    let motion = Memory::of(vec![0.01 * w; 9 * N]);
    let (everything, last_skipped) = (Memory::of([1; N]), Memory::of([1, 1, 0]));
    let update = |active: &Memory<i32>, o: Outputs| unsafe {
        let (active, states, x) = (active.start, states.start, x.start);
        mslip_batch_element_update(N, N, all, null(), active, n, states, x, o[0], o[1], o[2], o[3])
    };
    let force = |active: &Memory<i32>, workspace, o: Outputs| unsafe {
        mslip_batch_element_harmonic_force(N, N, all, null(), active.start, workspace, motion.start, o[0], o[1], o[2])
    };
    for i in 0..N {
        // SAFETY: item i of three.
        unsafe { ptr::copy_nonoverlapping(oblique.start, all.add(i), 1) };
    }
    accepted(&[N * n, 3 * N, 9 * N, N], |out| update(&everything, out));
    accepted(&[9 * N, 81 * N, N], |out| force(&everything, of_two.start, out));
    rejected(MSLIP_BAD_DIRECTIONS, &[6 * N, 36 * N, N], |out| force(&everything, workspace.start, out));
    // SAFETY: the last item.
    unsafe { ptr::copy_nonoverlapping(element.start, all.add(2), 1) };
    rejected(MSLIP_BAD_DIRECTIONS, &[N * n, 3 * N, 9 * N, N], |out| update(&everything, out));
    rejected(MSLIP_BAD_DIRECTIONS, &[9 * N, 81 * N, N], |out| force(&everything, of_two.start, out));
    assert_eq!(update(&last_skipped, &[none; 4]), MSLIP_OK);
    assert_eq!(force(&last_skipped, of_two.start, &[none; 3]), MSLIP_OK);
}

/// Contacts are only read: threads share one, each with memory of its own.
#[test]
fn threads_share_a_contact() {
    let [contact, ..] = contacts();
    // SAFETY: the contact lives until the threads are joined.
    let shared: &'static mslip_contact = unsafe { &*contact.start };
    let threads = [0.4, 0.8].map(|part| {
        std::thread::spawn(move || {
            let unit = shared.slip_displacement;
            let (workspace, u, force) = (workspace(1, 8, 0), Memory::of([0.0, part * unit, 0.0]), Memory::new(3));
            let (state, none) = (unloaded(3), null_mut());
            let s = state.start;
            let statuses = unsafe {
                [
                    mslip_harmonic_force(shared, workspace.start, u.start, force.start, none, none),
                    mslip_masing_update(shared, state.length, s, part * unit, s, none, none, none),
                ]
            };
            (statuses, force.values()[1] > 0.0)
        })
    });
    for thread in threads {
        assert_eq!(thread.join().unwrap(), ([MSLIP_OK; 2], true));
    }
}
