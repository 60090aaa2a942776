//! Calls of every function of the C interface with memory of exact length: each array is an allocation of its own, and outputs are
//! uninitialised.
//!
//! Without Miri these are plain tests. With it (`tools/miri.sh`) each access beyond an array, each read of uninitialised memory,
//! each misaligned access, each use of an invalidated reference and each race between threads is an error.

use microslip::ffi::*;
use microslip::{EllipticParameters, Material, Parameters};
use std::alloc::{Layout, alloc, dealloc};
use std::ffi::CStr;
use std::mem::MaybeUninit;
use std::ptr::{self, null, null_mut};
use std::sync::OnceLock;

/// Uninitialised memory, as from C's malloc.
struct Memory<T> {
    start: *mut T,
    length: usize,
}

impl<T> Memory<T> {
    fn new(length: usize) -> Memory<T> {
        // SAFETY: the layout has a size, of one item at least.
        let start: *mut T = unsafe { alloc(Memory::<T>::layout(length)) }.cast();
        assert!(!start.is_null(), "no memory");
        Memory { start, length }
    }

    /// For no items a byte, so that there is an address.
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

    /// The values, which must have been written.
    fn values(&self) -> &[T] {
        // SAFETY: valid for the length; the test has written it.
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

/// Slightly flattened, elliptical, and without friction: initialised once, because that takes Miri seconds.
fn contacts() -> [Memory<mslip_contact>; 3] {
    static INITIALISED: OnceLock<[mslip_contact; 3]> = OnceLock::new();
    let initialised = INITIALISED.get_or_init(|| {
        let rounded = |p: Parameters| {
            let mut contact = MaybeUninit::uninit();
            // SAFETY: parameters, and memory of a contact, which is one after MSLIP_OK.
            unsafe {
                assert_eq!(mslip_contact_init(&p, contact.as_mut_ptr()), MSLIP_OK);
                contact.assume_init()
            }
        };
        let mut ellipse = MaybeUninit::uninit();
        let p = EllipticParameters {
            semi_axis_x: 1e-4,
            semi_axis_y: 3e-4,
            normal_force: 100.0,
            friction_coefficient: 0.3,
            material: [STEEL; 2],
        };
        // SAFETY: as above.
        let ellipse = unsafe {
            assert_eq!(mslip_contact_init_elliptic(&p, ellipse.as_mut_ptr()), MSLIP_OK);
            ellipse.assume_init()
        };
        let smooth = Parameters { friction_coefficient: 0.0, ..flat(1e-4, 0.02) };
        [rounded(flat(1e-6, 0.02)), ellipse, rounded(smooth)]
    });
    initialised.each_ref().map(copy)
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

/// Accepts the call with all of its outputs, each alone, and none; output k has `lengths[k]` doubles. Requested outputs are
/// written and not NaN. A misaligned output is rejected.
fn accepted(lengths: &[usize], call: impl Fn(&[*mut f64]) -> i32) {
    // The C drivers have every subset; Miri takes too long.
    let alone = if cfg!(miri) { 1 } else { lengths.len() };
    let each = (0..alone).map(|k| 1 << k);
    for subset in each.chain([0, u32::MAX]) {
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

/// The call is rejected with this status and modifies no output.
fn rejected(status: i32, lengths: &[usize], call: impl Fn(&[*mut f64]) -> i32) {
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
fn needs_contact(lengths: &[usize], call: impl Fn(*const mslip_contact, &[*mut f64]) -> i32) {
    rejected(MSLIP_NULL_POINTER, lengths, |out| call(null(), out));
    let [contact, ..] = contacts();
    rejected(MSLIP_BAD_ALIGNMENT, lengths, |out| call(misaligned(contact.start), out));
    for contact in bad_contacts() {
        rejected(MSLIP_BAD_CONTACT, lengths, |out| call(contact.start, out));
    }
}

#[test]
fn names_and_versions() {
    // SAFETY: static messages that end with 0.
    let text = |pointer: *const _| unsafe { CStr::from_ptr(pointer) }.to_str().unwrap().to_owned();
    assert_eq!(text(mslip_version()), env!("CARGO_PKG_VERSION"));
    assert_eq!(mslip_abi_version(), MSLIP_ABI_VERSION);
    for status in [MSLIP_OK, MSLIP_NULL_POINTER, MSLIP_BAD_ARRAY_SIZE, -1, i32::MAX] {
        assert!(text(mslip_status_text(status)).len() >= "success".len());
    }
}

#[test]
fn parameters() {
    unsafe {
        mslip_parameters_default(null_mut());
        mslip_elliptic_parameters_default(null_mut());
        let (p, e) = (Memory::<Parameters>::new(1), Memory::<EllipticParameters>::new(1));
        mslip_parameters_default(p.start);
        mslip_elliptic_parameters_default(e.start);
        let contact = Memory::<mslip_contact>::new(1);
        assert_eq!(mslip_contact_init(p.start, contact.start), MSLIP_BAD_FLAT_HALF_WIDTH);
        assert_eq!(mslip_contact_init_elliptic(e.start, contact.start), MSLIP_BAD_SEMI_AXIS_X);
        assert_eq!(mslip_contact_init(misaligned(p.start), contact.start), MSLIP_BAD_ALIGNMENT);
        assert_eq!(mslip_contact_init_elliptic(misaligned(e.start), contact.start), MSLIP_BAD_ALIGNMENT);
        assert_eq!(mslip_contact_init(p.start, misaligned(contact.start)), MSLIP_BAD_ALIGNMENT);
        // These have no status and write to any address.
        let room = Memory::<[Parameters; 2]>::new(1);
        mslip_parameters_default(misaligned(room.start.cast()));
        mslip_elliptic_parameters_default(misaligned(room.start.cast()));
        assert_eq!(mslip_contact_init(null(), contact.start), MSLIP_NULL_POINTER);
        assert_eq!(mslip_contact_init(p.start, null_mut()), MSLIP_NULL_POINTER);
        assert_eq!(mslip_contact_init_elliptic(null(), contact.start), MSLIP_NULL_POINTER);
        assert_eq!(mslip_contact_init_elliptic(e.start, null_mut()), MSLIP_NULL_POINTER);
    }
}

#[test]
fn checks_of_contacts() {
    for contact in contacts() {
        // SAFETY: a contact.
        assert_eq!(unsafe { mslip_contact_check(contact.start) }, MSLIP_OK);
    }
    let [contact, ..] = contacts();
    unsafe {
        assert_eq!(mslip_contact_check(null()), MSLIP_NULL_POINTER);
        assert_eq!(mslip_contact_check(misaligned(contact.start)), MSLIP_BAD_ALIGNMENT);
        for place in [0, 1, 100, 239, 240] {
            let [contact, ..] = contacts();
            let value = &mut (*contact.start).reserved[place];
            *value = f64::from_bits(value.to_bits() ^ 1 << 20);
            assert_eq!(mslip_contact_check(contact.start), MSLIP_BAD_CONTACT);
        }
        for bad in bad_contacts() {
            assert_eq!(mslip_contact_check(bad.start), MSLIP_BAD_CONTACT);
        }
    }
}

#[test]
fn tractions_and_slip() {
    for contact in contacts() {
        let (force, half_width) = (0.6 * slip(&contact).0, contact.values()[0].half_width);
        let x = Memory::of([-0.3, 0.0, 0.99, 1.0, 2.0].map(|x| x * half_width));
        let of = |contact, x, force, out: &[*mut f64]| unsafe { mslip_tractions(contact, force, 5, x, out[0], out[1]) };
        accepted(&[5, 5], |out| of(contact.start, x.start, force, out));
        let slip_of = |contact, x, force, out: &[*mut f64]| unsafe { mslip_slip(contact, force, 5, x, out[0], out[1]) };
        match slip_of(contact.start, x.start, force, &[null_mut(); 2]) {
            MSLIP_NOT_AVAILABLE => {
                rejected(MSLIP_NOT_AVAILABLE, &[5, 5], |o| slip_of(contact.start, x.start, force, o))
            }
            _ => accepted(&[5, 5], |out| slip_of(contact.start, x.start, force, out)),
        }
        for of in [of, slip_of] {
            needs_contact(&[5, 5], |contact, out| of(contact, x.start, force, out));
            rejected(MSLIP_NULL_POINTER, &[5, 5], |out| of(contact.start, null_mut(), force, out));
            rejected(MSLIP_BAD_ALIGNMENT, &[5, 5], |out| of(contact.start, misaligned(x.start), force, out));
            rejected(MSLIP_BAD_FORCE, &[5, 5], |out| of(contact.start, x.start, f64::NAN, out));
            rejected(MSLIP_FORCE_EXCEEDS_SLIP, &[5, 5], |out| of(contact.start, x.start, force + 1e9, out));
            let bad = Memory::of([0.0, 0.0, 0.0, 0.0, f64::INFINITY]);
            rejected(MSLIP_BAD_POSITION, &[5, 5], |out| of(contact.start, bad.start, force, out));
        }
        assert_eq!(unsafe { mslip_tractions(contact.start, force, 0, null(), null_mut(), null_mut()) }, MSLIP_OK);
    }
}

#[test]
fn the_monotonic_curve() {
    for contact in contacts() {
        let (force, displacement) = slip(&contact);
        let parts = [0.0, -0.3, 0.8, 1.0];
        let n = parts.len();
        let of_force = |contact, n, x: *const f64, out: &[*mut f64]| unsafe {
            mslip_monotonic_displacement(contact, n, x, out[0], out[1], out[2])
        };
        let of_displacement = |contact, n, x: *const f64, out: &[*mut f64]| unsafe {
            mslip_monotonic_force(contact, n, x, out[0], out[1], out[2])
        };
        for (of, unit, bad, status) in [
            (of_force as fn(_, _, _, &[*mut f64]) -> i32, force, f64::NAN, MSLIP_BAD_FORCE),
            (of_force, force, force + 1e9, MSLIP_FORCE_EXCEEDS_SLIP),
            (of_displacement, displacement, f64::INFINITY, MSLIP_BAD_DISPLACEMENT),
        ] {
            let x = Memory::of(parts.map(|part| part * unit));
            accepted(&[n; 3], |out| of(contact.start, n, x.start, out));
            accepted(&[0; 3], |out| of(contact.start, 0, null(), out));
            needs_contact(&[n; 3], |contact, out| of(contact, n, x.start, out));
            rejected(MSLIP_NULL_POINTER, &[n; 3], |out| of(contact.start, n, null(), out));
            rejected(MSLIP_BAD_ALIGNMENT, &[n; 3], |out| of(contact.start, n, misaligned(x.start), out));
            rejected(MSLIP_BAD_ARRAY_SIZE, &[n; 3], |out| of(contact.start, usize::MAX / 8, x.start, out));
            let x = Memory::of([0.0, bad]);
            rejected(status, &[2; 3], |out| of(contact.start, 2, x.start, out));
        }
    }
}

fn unloaded(reversals: usize) -> Memory<f64> {
    let state = Memory::new(mslip_state_length(reversals));
    assert_eq!(unsafe { mslip_state_init(state.length, state.start) }, MSLIP_OK);
    state
}

/// Uninitialised states, and one with more reversals than fit.
fn bad_states() -> Vec<Memory<f64>> {
    let filled = |byte: u8| Memory::of([f64::from_bits(u64::from_ne_bytes([byte; 8])); LEAST]);
    let mut long = unloaded(2).values().to_vec();
    long[0] = f64::from_bits(long[0].to_bits() + 3);
    vec![filled(0), filled(0x5a), filled(0xff), Memory::of(long)]
}

/// Doubles of a state of two reversals, the shortest.
const LEAST: usize = 11;

/// Displacements over that of gross slip that nest four reversals, close loops, and slip.
const PATH: [f64; 8] = [0.9, -0.5, 0.4, 0.1, 0.2, -0.6, 1.5, 0.0];

#[test]
fn a_history_step_by_step() {
    unsafe {
        assert_eq!(mslip_state_init(LEAST, null_mut()), MSLIP_NULL_POINTER);
        assert_eq!(mslip_state_init(LEAST, misaligned(Memory::new(LEAST + 1).start)), MSLIP_BAD_ALIGNMENT);
        assert_eq!(mslip_state_init(0, Memory::new(0).start), MSLIP_STATE_TOO_SHORT);
        assert_eq!(mslip_state_init(LEAST - 1, Memory::new(LEAST - 1).start), MSLIP_STATE_TOO_SHORT);
        assert_eq!(mslip_state_init(usize::MAX, Memory::new(5).start), MSLIP_BAD_ARRAY_SIZE);
    }
    let [rounded, _, smooth] = contacts();
    for contact in [rounded, smooth] {
        let unit = slip(&contact).1;
        let state = unloaded(4);
        let n = state.length;
        for part in PATH {
            let next = Memory::<f64>::new(n);
            let of = |contact, n, state: *const f64, x, out: &[*mut f64]| unsafe {
                mslip_masing_update(contact, n, state, x, out[0], out[1], out[2], out[3])
            };
            let lengths = [n, 1, 1, 1];
            // With a new state, then in place.
            accepted(&lengths, |out| of(contact.start, n, state.start, part * unit, out));
            assert_eq!(
                of(contact.start, n, state.start, part * unit, &[next.start, null_mut(), null_mut(), null_mut()]),
                MSLIP_OK
            );
            assert_eq!(next.values()[1], part * unit);
            check_state(&next);
            let force = Memory::new(1);
            assert_eq!(
                of(contact.start, n, state.start, part * unit, &[state.start, force.start, null_mut(), null_mut()]),
                MSLIP_OK
            );
            assert!(force.values()[0].is_finite());
            rejected(MSLIP_BAD_DISPLACEMENT, &lengths, |out| of(contact.start, n, state.start, f64::NAN, out));
        }
        let of = |contact, n, state: *const f64, x, out: &[*mut f64]| unsafe {
            mslip_masing_update(contact, n, state, x, out[0], out[1], out[2], out[3])
        };
        needs_contact(&[n, 1, 1, 1], |contact, out| of(contact, n, state.start, 0.0, out));
        rejected(MSLIP_NULL_POINTER, &[n, 1, 1, 1], |out| of(contact.start, n, null(), 0.0, out));
        rejected(MSLIP_BAD_ALIGNMENT, &[n, 1, 1, 1], |out| of(contact.start, n, misaligned(state.start), 0.0, out));
        rejected(MSLIP_STATE_TOO_SHORT, &[5, 1, 1, 1], |out| of(contact.start, 5, state.start, 0.0, out));
        rejected(MSLIP_NULL_POINTER, &[0, 1, 1, 1], |out| of(contact.start, 0, null(), 0.0, out));
        for bad in bad_states() {
            rejected(MSLIP_BAD_STATE, &[LEAST, 1, 1, 1], |out| of(contact.start, LEAST, bad.start, 0.0, out));
        }
        // With two reversals a third is merged.
        let short = unloaded(0);
        for part in [0.9, -0.8, 0.7, -0.6, 0.5] {
            let out = [short.start, null_mut(), null_mut(), null_mut()];
            assert_eq!(of(contact.start, LEAST, short.start, part * unit, &out), MSLIP_OK);
        }
        assert_eq!(check_state(&short) > 0.0, unit > 0.0);
    }
}

/// Validates a state; its error.
fn check_state(state: &Memory<f64>) -> f64 {
    let error = Memory::new(1);
    unsafe {
        assert_eq!(mslip_state_check(state.length, state.start), MSLIP_OK);
        assert_eq!(mslip_state_error(state.length, state.start, null_mut()), MSLIP_OK);
        assert_eq!(mslip_state_error(state.length, state.start, error.start), MSLIP_OK);
    }
    error.values()[0]
}

#[test]
fn checks_of_states() {
    let state = unloaded(3);
    let (n, error) = (state.length, Memory::<f64>::new(1));
    unsafe {
        assert_eq!(mslip_state_check(n, null()), MSLIP_NULL_POINTER);
        assert_eq!(mslip_state_check(n, misaligned(state.start)), MSLIP_BAD_ALIGNMENT);
        assert_eq!(mslip_state_check(LEAST - 1, state.start), MSLIP_STATE_TOO_SHORT);
        assert_eq!(mslip_state_error(n, null(), error.start), MSLIP_NULL_POINTER);
        assert_eq!(mslip_state_error(n, state.start, misaligned(error.start)), MSLIP_BAD_ALIGNMENT);
        assert_eq!(mslip_state_error(LEAST - 1, state.start, error.start), MSLIP_STATE_TOO_SHORT);
        for bad in bad_states() {
            assert_eq!(mslip_state_check(LEAST, bad.start), MSLIP_BAD_STATE);
            assert_eq!(mslip_state_error(LEAST, bad.start, error.start), MSLIP_BAD_STATE);
        }
        for (place, value) in [(1, f64::NAN), (2, 0.5), (3, f64::INFINITY), (4, f64::NAN)] {
            let mut values = state.values().to_vec();
            values[place] = value;
            assert_eq!(mslip_state_check(n, Memory::of(values).start), MSLIP_BAD_STATE);
        }
    }
}

#[test]
fn a_history_as_one_path() {
    let [rounded, _, smooth] = contacts();
    for contact in [rounded, smooth] {
        let unit = slip(&contact).1;
        let (path, points) = (Memory::of(PATH.map(|part| part * unit)), PATH.len());
        let of = |contact, n, state: *const f64, count, path: *const f64, out: &[*mut f64]| unsafe {
            mslip_masing_path(contact, n, state, count, path, out[0], out[1], out[2], out[3])
        };
        // With room for all reversals, and with so little that some are merged.
        for reversals in [16, 2] {
            let state = unloaded(reversals);
            let (n, lengths) = (state.length, [state.length, points, points, points]);
            accepted(&lengths, |out| of(contact.start, n, state.start, points, path.start, out));
            accepted(&[n, 0, 0, 0], |out| of(contact.start, n, state.start, 0, null(), out));
            needs_contact(&lengths, |contact, out| of(contact, n, state.start, points, path.start, out));
            rejected(MSLIP_NULL_POINTER, &lengths, |out| of(contact.start, n, null(), points, path.start, out));
            rejected(MSLIP_NULL_POINTER, &lengths, |out| of(contact.start, n, state.start, points, null(), out));
            let bad = Memory::of([0.0, 1.0, f64::NAN]);
            rejected(MSLIP_BAD_DISPLACEMENT, &[n, 3, 3, 3], |out| of(contact.start, n, state.start, 3, bad.start, out));
            // In place.
            let force = Memory::new(points);
            let status = unsafe {
                let (s, f) = (state.start, force.start);
                mslip_masing_path(contact.start, n, s, points, path.start, s, f, null_mut(), null_mut())
            };
            assert_eq!((status, force.values().len()), (MSLIP_OK, points));
            assert_eq!(state.values()[1], path.values()[points - 1]);
            check_state(&state);
        }
        for bad in bad_states() {
            let lengths = [LEAST, points, points, points];
            rejected(MSLIP_BAD_STATE, &lengths, |out| of(contact.start, LEAST, bad.start, points, path.start, out));
        }
    }
}

#[test]
fn tractions_after_a_history() {
    for contact in contacts() {
        let unit = slip(&contact).1;
        let (state, path) = (unloaded(4), Memory::of([0.9 * unit, -0.4 * unit, 0.2 * unit]));
        let (n, s) = (state.length, state.start);
        let status =
            unsafe { mslip_masing_path(contact.start, n, s, 3, path.start, s, null_mut(), null_mut(), null_mut()) };
        assert_eq!(status, MSLIP_OK);
        let x = Memory::of([0.0, 0.5, 0.99].map(|x| x * contact.values()[0].half_width));
        let of = |contact, n, state: *const f64, x: *const f64, out: &[*mut f64]| unsafe {
            mslip_masing_tractions(contact, n, state, 3, x, out[0], out[1])
        };
        accepted(&[3, 3], |out| of(contact.start, n, s, x.start, out));
        needs_contact(&[3, 3], |contact, out| of(contact, n, s, x.start, out));
        rejected(MSLIP_NULL_POINTER, &[3, 3], |out| of(contact.start, n, null(), x.start, out));
        rejected(MSLIP_NULL_POINTER, &[3, 3], |out| of(contact.start, n, s, null(), out));
        rejected(MSLIP_STATE_TOO_SHORT, &[3, 3], |out| of(contact.start, 3, s, x.start, out));
        for bad in bad_states() {
            rejected(MSLIP_BAD_STATE, &[3, 3], |out| of(contact.start, LEAST, bad.start, x.start, out));
        }
    }
}

#[test]
fn cycles() {
    for contact in contacts() {
        let (force, unit) = slip(&contact);
        let amplitudes = Memory::of([0.0, 0.3, 1.5].map(|part| part * unit));
        let n = amplitudes.length;
        let stiffness = |contact, n, x: *const f64, out: &[*mut f64]| unsafe {
            mslip_complex_stiffness(contact, n, x, out[0], out[1], out[2], out[3])
        };
        accepted(&[n; 4], |out| stiffness(contact.start, n, amplitudes.start, out));
        needs_contact(&[n; 4], |contact, out| stiffness(contact, n, amplitudes.start, out));
        rejected(MSLIP_NULL_POINTER, &[n; 4], |out| stiffness(contact.start, n, null(), out));
        let bad = Memory::of([0.0, -1.0]);
        rejected(MSLIP_BAD_AMPLITUDE, &[2; 4], |out| stiffness(contact.start, 2, bad.start, out));

        let hysteresis = |contact, amplitude, n, out: &[*mut f64]| unsafe {
            mslip_hysteresis_loop(contact, amplitude, n, out[0], out[1])
        };
        accepted(&[3, 3], |out| hysteresis(contact.start, 0.7 * unit, 3, out));
        accepted(&[0, 0], |out| hysteresis(contact.start, 0.7 * unit, 0, out));
        needs_contact(&[7, 7], |contact, out| hysteresis(contact, 0.7 * unit, 7, out));
        rejected(MSLIP_BAD_AMPLITUDE, &[7, 7], |out| hysteresis(contact.start, f64::NAN, 7, out));

        let energy =
            |contact, n, x: *const f64, out: &[*mut f64]| unsafe { mslip_dissipated_energy(contact, n, x, out[0]) };
        let forces = Memory::of([0.0, 0.3, 1.0].map(|part| part * force));
        accepted(&[3], |out| energy(contact.start, 3, forces.start, out));
        needs_contact(&[3], |contact, out| energy(contact, 3, forces.start, out));
        rejected(MSLIP_NULL_POINTER, &[3], |out| energy(contact.start, 3, null(), out));
        let bad = Memory::of([0.0, -1.0]);
        rejected(MSLIP_BAD_FORCE_AMPLITUDE, &[2], |out| energy(contact.start, 2, bad.start, out));
    }
}

#[test]
fn equivalents() {
    for contact in contacts() {
        let unit = slip(&contact).1;
        let jenkins = |contact, amplitude, out: &[*mut f64]| unsafe {
            mslip_jenkins_equivalent(contact, amplitude, out[0], out[1])
        };
        accepted(&[1, 1], |out| jenkins(contact.start, 0.7 * unit, out));
        needs_contact(&[1, 1], |contact, out| jenkins(contact, 0.7 * unit, out));
        rejected(MSLIP_BAD_AMPLITUDE, &[1, 1], |out| jenkins(contact.start, -1.0, out));
        let iwan = |contact, n, out: &[*mut f64]| unsafe { mslip_iwan_equivalent(contact, n, out[0], out[1], out[2]) };
        // The bisection for the sliders of a contact with friction takes Miri minutes.
        if !cfg!(miri) || unit == 0.0 {
            accepted(&[2, 2, 1], |out| iwan(contact.start, 2, out));
        }
        needs_contact(&[2, 2, 1], |contact, out| iwan(contact, 2, out));
        rejected(MSLIP_BAD_COUNT, &[0, 0, 1], |out| iwan(contact.start, 0, out));
        rejected(MSLIP_BAD_COUNT, &[1], |out| iwan(contact.start, 1 << 20, &[null_mut(), null_mut(), out[0]]));
    }
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
    let of_size = mslip_harmonic_workspace_length;
    assert_eq!([of_size(0, 9, 0), of_size(2, 4, 0), of_size(2, 9, 2), of_size(2, 9, -1)], [0; 4]);
    for rule in RULES {
        let length = of_size(2, 9, rule);
        let memory = Memory::<f64>::new(length);
        let init = |harmonics, samples, rule, length, workspace| unsafe {
            mslip_harmonic_workspace_init(harmonics, samples, rule, length, workspace)
        };
        assert_eq!(init(2, 9, rule, length, memory.start), MSLIP_OK);
        for (status, harmonics, samples, rule, length, workspace) in [
            (MSLIP_WORKSPACE_TOO_SHORT, 2, 9, rule, length - 1, memory.start),
            (MSLIP_WORKSPACE_TOO_SHORT, 2, 9, rule, 0, memory.start),
            (MSLIP_NULL_POINTER, 2, 9, rule, length, null_mut()),
            (MSLIP_BAD_ALIGNMENT, 2, 9, rule, length - 1, misaligned(memory.start)),
            (MSLIP_BAD_ARRAY_SIZE, 2, 9, rule, usize::MAX, memory.start),
            (MSLIP_BAD_SAMPLES, 2, 4, rule, length, memory.start),
            (MSLIP_BAD_HARMONICS, 0, 9, rule, length, memory.start),
            (MSLIP_BAD_RULE, 2, 9, 7, length, memory.start),
        ] {
            assert_eq!(init(harmonics, samples, rule, length, workspace), status);
        }
        let (harmonics, samples, found) = (Memory::<usize>::new(1), Memory::<usize>::new(1), Memory::<i32>::new(1));
        let (h, s, r) = (harmonics.start, samples.start, found.start);
        // The header is all that is read.
        let header = Memory::of(memory.values()[..2].to_vec());
        unsafe {
            assert_eq!(mslip_harmonic_workspace_size(header.start, h, s, r), MSLIP_OK);
            assert_eq!((harmonics.values()[0], samples.values()[0], found.values()[0]), (2, 9, rule));
            assert_eq!(mslip_harmonic_workspace_size(header.start, null_mut(), null_mut(), null_mut()), MSLIP_OK);
            assert_eq!(mslip_harmonic_workspace_size(null(), h, s, r), MSLIP_NULL_POINTER);
            assert_eq!(mslip_harmonic_workspace_size(misaligned(header.start), h, s, r), MSLIP_BAD_ALIGNMENT);
            assert_eq!(mslip_harmonic_workspace_size(header.start, misaligned(h), s, r), MSLIP_BAD_ALIGNMENT);
            assert_eq!(mslip_harmonic_workspace_size(header.start, h, misaligned(s), r), MSLIP_BAD_ALIGNMENT);
            assert_eq!(mslip_harmonic_workspace_size(header.start, h, s, misaligned(r)), MSLIP_BAD_ALIGNMENT);
            *header.start = 0.0;
            assert_eq!(mslip_harmonic_workspace_size(header.start, h, s, r), MSLIP_BAD_WORKSPACE);
        }
    }
}

#[test]
fn the_harmonic_force() {
    let of = |contact, workspace, x: *const f64, out: &[*mut f64]| unsafe {
        mslip_harmonic_force(contact, workspace, x, out[0], out[1], out[2])
    };
    let beginning = |memory: &Memory<f64>| Memory::of(memory.values()[..2].to_vec());
    for rule in RULES {
        // An even and an odd number of samples.
        for (harmonics, samples) in [(1, 8), (2, 9)] {
            let n = 2 * harmonics + 1;
            let workspace = workspace(harmonics, samples, rule);
            let [rounded, _, smooth] = contacts();
            for contact in [rounded, smooth] {
                let unit = slip(&contact).1;
                // Constant, in microslip with all harmonics, with odd ones only, and in gross slip.
                for motion in
                    [[0.0; 5], [0.1, 0.5, 0.2, 0.3, -0.2], [0.0, 0.6, 0.3, 0.0, 0.0], [0.2, 9.0, 1.0, 3.0, 1.0]]
                {
                    let x = Memory::of(motion[..n].iter().map(|part| part * unit));
                    accepted(&[n, n * n, 1], |out| of(contact.start, workspace.start, x.start, out));
                }
                let x = Memory::of(vec![unit; n]);
                needs_contact(&[n, n * n, 1], |contact, out| of(contact, workspace.start, x.start, out));
                rejected(MSLIP_NULL_POINTER, &[n, n * n, 1], |out| of(contact.start, null_mut(), x.start, out));
                let off_by_four = misaligned(workspace.start);
                rejected(MSLIP_BAD_ALIGNMENT, &[n, n * n, 1], |out| of(contact.start, off_by_four, x.start, out));
                rejected(MSLIP_NULL_POINTER, &[n, n * n, 1], |out| of(contact.start, workspace.start, null(), out));
                let bad = Memory::of(vec![f64::NAN; n]);
                rejected(MSLIP_BAD_DISPLACEMENT, &[n, n * n, 1], |o| of(contact.start, workspace.start, bad.start, o));
            }
            let [contact, ..] = contacts();
            let x = Memory::of(vec![0.0; n]);
            // Of an invalid header nothing beyond is read.
            for (place, value) in [(0, 0.0), (0, f64::NAN), (1, 0.5), (1, f64::NAN), (1, -1.0)] {
                let header = beginning(&workspace);
                unsafe { *header.start.add(place) = value };
                rejected(MSLIP_BAD_WORKSPACE, &[n, n * n, 1], |out| of(contact.start, header.start, x.start, out));
            }
        }
    }
}

#[test]
fn batches() {
    let n = 4;
    let memory: Memory<mslip_contact> = Memory::new(n);
    let contacts = memory.start;
    for (i, contact) in self::contacts().iter().take(3).enumerate() {
        // SAFETY: both are contacts.
        unsafe { ptr::copy_nonoverlapping(contact.start, contacts.add(i), 1) };
    }
    let unit = unsafe { (*contacts).slip_displacement };
    // The last contact is uninitialised and its item inactive, and the last index invalid: neither is read.
    let (active, index) = (Memory::of([1, -1, 255, 0]), Memory::of([2, 0, 2, -1]));
    let (all, own): (*const i32, *const i32) = (null(), null());
    let [bad, ..] = bad_contacts();
    type Batch<'a> = &'a dyn Fn(*const mslip_contact, *const i32, *const i32, &[*mut f64]) -> i32;
    let check_items = |lengths: &[usize], call: Batch| {
        rejected(MSLIP_NULL_POINTER, lengths, |out| call(null(), own, active.start, out));
        rejected(MSLIP_BAD_ALIGNMENT, lengths, |out| call(contacts, own, misaligned(active.start), out));
        rejected(MSLIP_BAD_ALIGNMENT, lengths, |out| call(contacts, misaligned(index.start), active.start, out));
        rejected(MSLIP_BAD_INDEX, lengths, |out| call(contacts, index.start, all, out));
        rejected(MSLIP_BAD_INDEX, lengths, |out| call(contacts, Memory::of([0, 0, 4, 0]).start, all, out));
        unsafe { ptr::copy(bad.start, contacts.add(3), 1) };
        rejected(MSLIP_BAD_CONTACT, lengths, |out| call(contacts, own, all, out));
    };
    // The three active items are written.
    let partly = |widths: &[usize], call: Batch| {
        for index in [own, index.start] {
            let outputs: Vec<Memory<f64>> = widths.iter().map(|width| Memory::new(n * width)).collect();
            let pointers: Vec<*mut f64> = outputs.iter().map(|output| output.start).collect();
            assert_eq!(call(contacts, index, active.start, &pointers), MSLIP_OK);
            for (output, width) in outputs.iter().zip(widths) {
                // SAFETY: three items of four.
                let written = unsafe { std::slice::from_raw_parts(output.start, 3 * width) };
                assert!(written.iter().all(|value| value.is_finite()));
            }
            assert_eq!(call(contacts, index, active.start, &vec![null_mut(); widths.len()]), MSLIP_OK);
        }
    };

    let amplitude = Memory::of([0.5, 0.9, 1.5, f64::NAN].map(|part| part * unit));
    let stiffness = |contacts, index, active, x: *const f64, o: &[*mut f64]| unsafe {
        mslip_batch_complex_stiffness(n, n, contacts, index, active, x, o[0], o[1], o[2], o[3])
    };
    partly(&[1; 4], &|contacts, index, active, out| stiffness(contacts, index, active, amplitude.start, out));
    check_items(&[4; 4], &|contacts, index, active, out| stiffness(contacts, index, active, amplitude.start, out));
    rejected(MSLIP_NULL_POINTER, &[4; 4], |out| stiffness(contacts, own, active.start, null(), out));

    let states: Memory<f64> = Memory::new(n * LEAST);
    for i in 0..3 {
        assert_eq!(unsafe { mslip_state_init(LEAST, states.start.add(LEAST * i)) }, MSLIP_OK);
    }
    let update = |contacts, index, active, length, states: *const f64, x: *const f64, o: &[*mut f64]| unsafe {
        mslip_batch_masing_update(n, n, contacts, index, active, length, states, x, o[0], o[1], o[2], o[3])
    };
    let valid = |contacts, index, active, out: &[*mut f64]| {
        update(contacts, index, active, LEAST, states.start, amplitude.start, out)
    };
    partly(&[LEAST, 1, 1, 1], &valid);
    assert_eq!(valid(contacts, own, active.start, &[states.start, null_mut(), null_mut(), null_mut()]), MSLIP_OK);
    let lengths = [4 * LEAST, 4, 4, 4];
    check_items(&lengths, &valid);
    let far = Memory::of([0.0, 0.0, f64::NAN, 0.0]);
    for (status, length, states, x) in [
        (MSLIP_NULL_POINTER, LEAST, null_mut(), amplitude.start),
        (MSLIP_NULL_POINTER, LEAST, states.start, null_mut()),
        (MSLIP_STATE_TOO_SHORT, 0, states.start, amplitude.start),
        (MSLIP_BAD_ARRAY_SIZE, usize::MAX / 2, states.start, amplitude.start),
        (MSLIP_BAD_DISPLACEMENT, LEAST, states.start, far.start),
    ] {
        rejected(status, &lengths, |out| update(contacts, own, active.start, length, states, x, out));
    }

    for rule in RULES {
        let workspace = workspace(1, 8, rule);
        let motion = Memory::of([0.1, 0.5, 0.2, 0.0, 1.5, 0.0, 0.0, 0.3, 0.1, f64::NAN, 0.0, 0.0].map(|x| x * unit));
        let force = |contacts, index, active, workspace, x: *const f64, o: &[*mut f64]| unsafe {
            mslip_batch_harmonic_force(n, n, contacts, index, active, workspace, x, o[0], o[1], o[2])
        };
        let valid = |contacts, index, active, out: &[*mut f64]| {
            force(contacts, index, active, workspace.start, motion.start, out)
        };
        partly(&[3, 9, 1], &valid);
        let lengths = [12, 36, 4];
        check_items(&lengths, &valid);
        rejected(MSLIP_NULL_POINTER, &lengths, |o| force(contacts, own, active.start, null_mut(), motion.start, o));
        rejected(MSLIP_NULL_POINTER, &lengths, |o| force(contacts, own, active.start, workspace.start, null(), o));
    }
}

/// A contact is only read: many threads share it, each with memory of its own.
#[test]
fn threads_share_a_contact() {
    let [contact, ..] = contacts();
    // SAFETY: the contact lives until the threads have ended.
    let shared: &'static mslip_contact = unsafe { &*contact.start };
    let threads = [0.4, 0.8].map(|part| {
        std::thread::spawn(move || {
            let unit = shared.slip_displacement;
            let (workspace, x, force) = (workspace(1, 8, 0), Memory::of([0.0, part * unit, 0.0]), Memory::new(3));
            let status =
                unsafe { mslip_harmonic_force(shared, workspace.start, x.start, force.start, null_mut(), null_mut()) };
            let state = unloaded(3);
            let s = state.start;
            let update = unsafe {
                mslip_masing_update(shared, state.length, s, part * unit, s, null_mut(), null_mut(), null_mut())
            };
            (status, update, force.values()[1] > 0.0)
        })
    });
    for thread in threads {
        assert_eq!(thread.join().unwrap(), (MSLIP_OK, MSLIP_OK, true));
    }
}
