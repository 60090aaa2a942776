//! Instruction counts of calls of the C interface, and relations between them that the documentation promises to users.
//!
//! Counts under callgrind are reproducible to the instruction, unlike times, but depend on the compiler and on the C library.
//! Relations between counts of one build do not; a violated one fails the run.

use microslip::ffi::*;
use microslip::{Layer, Material, Parameters};
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::mem::MaybeUninit;
use std::process::Command;
use std::ptr::{self, null_mut};

/// The first count is below this ratio times the second, and why.
const RELATIONS: &[(&str, f64, &str, &str)] = &[
    ("curve_no_output", 0.1, "curve", "outputs that are NULL are not computed"),
    ("curve_force", 0.2, "curve", "the half-width of the stick zone costs a root"),
    ("stiffness_imaginary", 0.6, "stiffness", "K'' needs no quadrature"),
    ("update_force", 0.9, "update", "the force does not need the energy"),
    ("harmonics_force", 0.9, "harmonics", "the force does not need the Jacobian"),
    ("event_driven_force", 0.9, "event_driven", "the force does not need the Jacobian"),
    ("curve_gross_slip", 0.25, "curve", "in gross slip no interpolant is evaluated"),
    ("path_gross_slip", 0.5, "path", "in gross slip no interpolant is evaluated"),
    ("harmonics_gross_slip", 0.7, "harmonics", "in gross slip no derivatives are summed; the transforms remain"),
    ("harmonics_open", 0.08, "harmonics", "an open contact has no force"),
    ("harmonics_odd", 0.85, "harmonics", "half a period of a symmetric motion is computed; the transforms remain"),
    ("batch_stiffness_inactive", 0.05, "batch_stiffness", "inactive items are skipped"),
    ("batch_update_inactive", 0.05, "batch_update", "inactive items are skipped"),
    ("batch_harmonics_inactive", 0.05, "batch_harmonics", "inactive items are skipped"),
    ("batch_stiffness_open", 0.12, "batch_stiffness", "an open contact has no force"),
    ("batch_update_open", 0.6, "batch_update", "an open contact has no force, but a state"),
    ("batch_harmonics_open", 0.05, "batch_harmonics", "an open contact has no force"),
    ("batch_stiffness_shared", 1.05, "batch_stiffness", "items may share a contact at no cost"),
    ("batch_update_shared", 1.05, "batch_update", "items may share a contact at no cost"),
    ("batch_harmonics_shared", 1.05, "batch_harmonics", "items may share a contact at no cost"),
    ("harmonics_force", 2.2, "curve_force", "a sample costs a point of the curve and two transforms"),
    ("event_driven_force", 5.5, "harmonics_force", "the documented cost of the event-driven rule"),
    ("element_force", 0.55, "element", "the force does not need the energy"),
    ("element", 2.1, "element_force", "the energy costs a step"),
    ("element_in_place", 1.0, "element", "a step in place copies no state"),
    ("element_discarded", 1.05, "element_in_place", "a discarded state costs nothing"),
    ("element_no_output", 1.01, "element_force_in_place", "outputs that are NULL cost nothing"),
    ("batch_element", 1.2, "path_element", "an item of a batch costs a step of a path"),
    ("batch_element_inactive", 0.05, "batch_element", "inactive items are skipped"),
    ("batch_element_shared", 1.05, "batch_element", "items may share an element at no cost"),
    ("path_element_force_beyond", 10.0, "path_element_force", "the documented cost of loads beyond `normal_force`"),
    ("path_element_beyond", 40.0, "path_element", "the documented cost of loads beyond `normal_force`"),
    ("path_element_layer_beyond", 80.0, "path_element", "the documented cost of loads beyond `normal_force`"),
    ("path_element_rough_layer_beyond", 80.0, "path_element", "the documented cost of loads beyond `normal_force`"),
    ("element_harmonics_force", 0.9, "element_harmonics", "the force does not need the Jacobian"),
    ("element_harmonics_energy", 1.05, "element_harmonics", "the energy is the work of the force"),
    ("element_harmonics_open", 0.05, "element_harmonics", "an open contact has no force"),
    ("curve_layer", 1.02, "curve_force", "a layer with N_c >= N/12 changes the polynomials only"),
    ("harmonics_layer", 1.02, "harmonics", "a layer with N_c >= N/12 changes the polynomials only"),
    ("stiffness_layer", 1.3, "stiffness", "a layer with N_c >= N/12 changes the polynomials only"),
    ("curve_rough_layer", 20.0, "curve_force", "the documented cost of a small N_c"),
    ("harmonics_rough_layer", 15.0, "harmonics", "the documented cost of a small N_c"),
    ("stiffness_rough_layer", 70.0, "stiffness", "the documented cost of a small N_c"),
];

/// N_c over N of layers as compliant as the contact; without a layer.
const NONE: f64 = f64::NAN;
const LAYER: f64 = 0.09;
const ROUGH: f64 = 0.01;

const POINTS: usize = 128; // of the curve, of a path, samples and items
const HARMONICS: usize = 5;
const N: usize = 2 * HARMONICS + 1;
const STATE: usize = 6 + 3 * 16; // 16 reversals

type Call = Box<dyn FnMut() -> i32>;

/// Lazy initialisation belongs to the first call, which is not counted.
fn prepared(mut call: impl FnMut() -> i32 + 'static) -> Call {
    assert_eq!(call(), MSLIP_OK);
    Box::new(call)
}

/// Arrays live until the process ends: one call is counted in each.
fn array<T>(item: impl FnMut(usize) -> T) -> *mut T {
    (0..POINTS).map(item).collect::<Vec<_>>().leak().as_mut_ptr()
}

/// The first `requested` outputs; the others are NULL.
fn outputs<const K: usize>(requested: usize) -> [*mut f64; K] {
    std::array::from_fn(|k| if k < requested { vec![0.0; POINTS * 4 * N * N].leak().as_mut_ptr() } else { null_mut() })
}

fn parameters(normal_force: f64) -> Parameters {
    Parameters {
        flat_half_width: 3e-4,
        edge_radius: 2e-3,
        length: 2e-2,
        normal_force,
        friction_coefficient: 0.4,
        material: [Material { young_modulus: 2e11, poisson_ratio: 0.3 }; 2],
        displacement_reference: microslip::parameters::CENTRE_POINT,
        ..Parameters::default()
    }
}

/// With a layer as compliant as the contact.
fn parameters_with(normal_force: f64, stiffening: f64) -> Parameters {
    let mut parameters = parameters(normal_force);
    if stiffening > 0.0 {
        let compliance = 1.0 / contact(normal_force).initial_stiffness;
        let stiffening_load = stiffening * normal_force;
        parameters.layer = Layer {
            normal_compliance: compliance,
            tangential_compliance: compliance,
            stiffening_load,
            reference_load: 0.0,
        };
    }
    parameters
}

fn contact(normal_force: f64) -> mslip_contact {
    contact_with(normal_force, NONE)
}

fn contact_with(normal_force: f64, stiffening: f64) -> mslip_contact {
    let parameters = parameters_with(normal_force, stiffening);
    let mut contact = MaybeUninit::uninit();
    // SAFETY: valid pointers; the contact is initialised if the status is MSLIP_OK.
    unsafe {
        assert_eq!(mslip_contact_init(&parameters, contact.as_mut_ptr()), MSLIP_OK);
        contact.assume_init()
    }
}

// All pointers below are NULL or point to arrays of `array` and `outputs` that are long enough.

fn curve(layer: f64, first: f64, last: f64, requested: usize) -> Call {
    let c = contact_with(200.0, layer);
    let u = array(|i| c.slip_displacement * (first + (last - first) * (i + 1) as f64 / POINTS as f64));
    let [force, stiffness, stick] = outputs(requested);
    prepared(move || unsafe { mslip_monotonic_force(&c, POINTS, u, force, stiffness, stick) })
}

fn stiffness(layer: f64, imaginary_alone: bool) -> Call {
    let c = contact_with(200.0, layer);
    let amplitude = array(|i| c.slip_displacement * (i as f64 + 0.5) / POINTS as f64);
    let [imaginary, real, d_real, d_imaginary] = outputs(if imaginary_alone { 1 } else { 4 });
    prepared(move || unsafe { mslip_complex_stiffness(&c, POINTS, amplitude, real, imaginary, d_real, d_imaginary) })
}

fn update(requested: usize) -> Call {
    let c = contact(200.0);
    let [old, new] = [0.0; 2].map(|initial| array(|_| initial));
    let reversals = array(|i| c.slip_displacement * [0.8, -0.6, 0.4, -0.2][i % 4]);
    let [force, stiffness, dissipated] = outputs(requested);
    let [none] = outputs(0);
    unsafe {
        assert_eq!(mslip_state_init(STATE, old), MSLIP_OK);
        assert_eq!(mslip_masing_path(&c, STATE, old, 4, reversals, old, none, none, none), MSLIP_OK);
    }
    let u = 0.1 * c.slip_displacement;
    prepared(move || unsafe { mslip_masing_update(&c, STATE, old, u, new, force, stiffness, dissipated) })
}

fn path(displacement: fn(f64) -> f64) -> Call {
    let c = contact(200.0);
    let [old, new] = [0.0; 2].map(|initial| array(|_| initial));
    let u = array(|i| c.slip_displacement * displacement((i as f64 + 0.5) / POINTS as f64));
    let [force, stiffness, dissipated] = outputs(3);
    unsafe { assert_eq!(mslip_state_init(STATE, old), MSLIP_OK) };
    prepared(move || unsafe { mslip_masing_path(&c, STATE, old, POINTS, u, new, force, stiffness, dissipated) })
}

fn harmonics(rule: i32, normal_force: f64, displacement: [f64; N], requested: usize) -> Call {
    let slip_displacement = contact(200.0).slip_displacement;
    harmonics_of(contact(normal_force), rule, displacement.map(|u| u * slip_displacement), requested)
}

fn harmonics_layer(layer: f64) -> Call {
    let c = contact_with(200.0, layer);
    let slip_displacement = c.slip_displacement;
    harmonics_of(c, UNIFORM, EVEN.map(|u| u * slip_displacement), 2)
}

fn harmonics_of(c: mslip_contact, rule: i32, u: [f64; N], requested: usize) -> Call {
    let length = mslip_harmonic_workspace_length(HARMONICS, POINTS, rule);
    let workspace = vec![0.0; length].leak().as_mut_ptr();
    let [force, jacobian, dissipated] = outputs(requested);
    unsafe { assert_eq!(mslip_harmonic_workspace_init(HARMONICS, POINTS, rule, length, workspace), MSLIP_OK) };
    prepared(move || unsafe { mslip_harmonic_force(&c, workspace, u.as_ptr(), force, jacobian, dissipated) })
}

struct Batch {
    n_contacts: usize,
    contacts: *mut mslip_contact,
    index: *mut i32,
    active: *mut i32,
    u: *mut f64, // also amplitudes
}

/// Items of a contact each, or of one for all.
fn batch(normal_force: f64, shared: bool, active: i32) -> Batch {
    let slip_displacement = contact(200.0).slip_displacement;
    Batch {
        n_contacts: if shared { 1 } else { POINTS },
        contacts: array(|_| contact(normal_force)),
        index: if shared { array(|_| 0) } else { null_mut() },
        active: array(|_| active),
        u: array(|i| slip_displacement * (i as f64 + 0.5) / POINTS as f64),
    }
}

fn batch_stiffness(b: Batch) -> Call {
    let [p, q, r, s] = outputs(4);
    prepared(move || unsafe {
        mslip_batch_complex_stiffness(POINTS, b.n_contacts, b.contacts, b.index, b.active, b.u, p, q, r, s, null_mut())
    })
}

fn batch_update(b: Batch) -> Call {
    let [old, new] = [0.0; 2].map(|initial| array(|_| [initial; STATE]).cast::<f64>());
    let [p, q, r] = outputs(3);
    for i in 0..POINTS {
        unsafe { assert_eq!(mslip_state_init(STATE, old.add(i * STATE)), MSLIP_OK) };
    }
    prepared(move || unsafe {
        mslip_batch_masing_update(
            POINTS,
            b.n_contacts,
            b.contacts,
            b.index,
            b.active,
            STATE,
            old,
            b.u,
            new,
            p,
            q,
            r,
            null_mut(),
        )
    })
}

fn batch_harmonics(b: Batch) -> Call {
    let length = mslip_harmonic_workspace_length(1, 64, UNIFORM);
    let workspace = vec![0.0; length].leak().as_mut_ptr();
    let motion = unsafe { array(|i| [0.05, 0.7, 0.2].map(|u| u * *b.u.add(i))).cast() };
    let [p, q, r] = outputs(3);
    unsafe { assert_eq!(mslip_harmonic_workspace_init(1, 64, UNIFORM, length, workspace), MSLIP_OK) };
    prepared(move || unsafe {
        mslip_batch_harmonic_force(
            POINTS,
            b.n_contacts,
            b.contacts,
            b.index,
            b.active,
            workspace,
            motion,
            p,
            q,
            r,
            null_mut(),
        )
    })
}

/// All approaches of a swing are then beyond the approach of the parameters.
const BEYOND: f64 = 4.0;

const ELEMENT_STATE: usize = 9 + 4 * 17; // 16 pieces

fn element() -> &'static mslip_element {
    element_with(NONE)
}

fn element_with(stiffening: f64) -> &'static mslip_element {
    let parameters = parameters_with(200.0, stiffening);
    let mut element = Box::new(MaybeUninit::uninit());
    // SAFETY: valid pointers; the element is initialised if the status is MSLIP_OK.
    unsafe {
        assert_eq!(mslip_element_init(&parameters, 1, MSLIP_INPUT_APPROACH, element.as_mut_ptr()), MSLIP_OK);
        Box::leak(element.assume_init())
    }
}

/// Displacements of a swing of the normal force of half its mean, with slip.
fn swing(e: &mslip_element) -> *mut f64 {
    scaled_swing(e, 1.0)
}

fn scaled_swing(e: &mslip_element, scale: f64) -> *mut f64 {
    let motion = |i: usize| {
        let t = TAU * 2.0 * i as f64 / POINTS as f64;
        [0.15 * t.sin(), 0.6 + 0.3 * (t + 0.7).cos()].map(|part| scale * part * e.approach)
    };
    array(motion).cast()
}

#[derive(Clone, Copy, PartialEq)]
enum NewState {
    Separate,
    InPlace,
    Discarded,
}

fn element_update(requested: usize, new_state: NewState) -> Call {
    let e = element();
    let [old, new] = [0.0; 2].map(|initial| array(|_| initial));
    let x = swing(e);
    let [force, tangent, dissipated] = outputs(requested);
    let [none] = outputs(0);
    unsafe {
        assert_eq!(mslip_element_state_init(1, ELEMENT_STATE, old), MSLIP_OK);
        assert_eq!(mslip_element_path(e, ELEMENT_STATE, old, 70, x, old, none, none, none), MSLIP_OK);
    }
    // The same step each time.
    let before = array(|i| if i < ELEMENT_STATE { unsafe { *old.add(i) } } else { 0.0 });
    let (from, to) = match new_state {
        NewState::Separate => (before, new),
        NewState::InPlace => (old, old),
        NewState::Discarded => (before, null_mut()),
    };
    let u = unsafe { x.add(2 * 70) };
    let call = move || unsafe { mslip_element_update(e, ELEMENT_STATE, from, u, to, force, tangent, dissipated) };
    assert_eq!(call(), MSLIP_OK);
    if new_state == NewState::InPlace {
        unsafe { old.copy_from_nonoverlapping(before, ELEMENT_STATE) };
    }
    Box::new(call)
}

fn element_path(e: &'static mslip_element, scale: f64, requested: usize) -> Call {
    let (x, old) = (scaled_swing(e, scale), array(|_| 0.0));
    let [force, tangent, dissipated] = outputs(requested);
    unsafe { assert_eq!(mslip_element_state_init(1, ELEMENT_STATE, old), MSLIP_OK) };
    let new = array(|_| 0.0);
    prepared(move || unsafe { mslip_element_path(e, ELEMENT_STATE, old, POINTS, x, new, force, tangent, dissipated) })
}

/// Each item takes the next step of the path.
fn batch_element(shared: bool, active: i32) -> Call {
    let e = element();
    // SAFETY: an initialised element.
    let elements = if shared { ptr::from_ref(e) } else { array(|_| unsafe { ptr::read(e) }).cast_const() };
    let (n, index) = if shared { (1, array(|_| 0)) } else { (POINTS, null_mut()) };
    let (x, active) = (swing(e), array(|_| active));
    let [old, new] = [0.0; 2].map(|initial| array(|_| [initial; ELEMENT_STATE]).cast::<f64>());
    let ([p, q, r], [none]) = (outputs(3), outputs(0));
    for i in 0..POINTS {
        unsafe {
            let state = old.add(i * ELEMENT_STATE);
            assert_eq!(mslip_element_state_init(1, ELEMENT_STATE, state), MSLIP_OK);
            assert_eq!(mslip_element_path(e, ELEMENT_STATE, state, i, x, state, none, none, none), MSLIP_OK);
        }
    }
    prepared(move || unsafe {
        mslip_batch_element_update(POINTS, n, elements, index, active, ELEMENT_STATE, old, x, new, p, q, r, null_mut())
    })
}

fn element_harmonics(open: bool, requested: usize) -> Call {
    let e = element();
    let length = mslip_element_workspace_length(1, HARMONICS, POINTS, UNIFORM);
    let workspace = vec![0.0; length].leak().as_mut_ptr();
    let mean = if open { -2.0 } else { 0.6 };
    let mut motion = [0.0; 2 * N];
    (motion[1], motion[4], motion[N], motion[N + 2]) = (0.2, 0.03, mean, 0.3);
    let u = motion.map(|u| u * e.approach);
    let [force, jacobian, dissipated] = outputs(requested);
    unsafe {
        assert_eq!(mslip_element_workspace_init(1, HARMONICS, POINTS, UNIFORM, 0, length, workspace), MSLIP_OK);
    }
    prepared(move || unsafe {
        mslip_element_harmonic_force(e, workspace, u.as_ptr(), force, jacobian, dissipated, std::ptr::null_mut())
    })
}

const UNIFORM: i32 = MSLIP_UNIFORM_SAMPLING;
const EVENTS: i32 = MSLIP_EVENT_DRIVEN;
const ODD: [f64; N] = [0.0, 0.7, 0.2, 0.0, 0.0, 0.05, 0.03, 0.0, 0.0, 0.0, 0.0];
const EVEN: [f64; N] = [0.05, 0.7, 0.2, 0.04, 0.0, 0.05, 0.03, 0.0, 0.0, 0.0, 0.0];

/// A name, and what prepares the call.
type Case = (&'static str, fn() -> Call);

const CASES: &[Case] = &[
    ("curve", || curve(NONE, 0.0, 0.99, 3)),
    ("curve_force", || curve(NONE, 0.0, 0.99, 1)),
    ("curve_no_output", || curve(NONE, 0.0, 0.99, 0)),
    ("curve_gross_slip", || curve(NONE, 2.0, 9.0, 3)),
    ("curve_layer", || curve(LAYER, 0.0, 0.99, 1)),
    ("curve_rough_layer", || curve(ROUGH, 0.0, 0.99, 1)),
    ("stiffness", || stiffness(NONE, false)),
    ("stiffness_imaginary", || stiffness(NONE, true)),
    ("stiffness_layer", || stiffness(LAYER, false)),
    ("stiffness_rough_layer", || stiffness(ROUGH, false)),
    ("update", || update(3)),
    ("update_force", || update(2)),
    ("path", || path(|t| 0.8 * (2.0 * TAU * t).sin())),
    ("path_gross_slip", || path(|t| 2.0 + t)),
    ("harmonics", || harmonics(UNIFORM, 200.0, EVEN, 2)),
    ("harmonics_force", || harmonics(UNIFORM, 200.0, EVEN, 1)),
    ("harmonics_odd", || harmonics(UNIFORM, 200.0, ODD, 2)),
    ("harmonics_gross_slip", || harmonics(UNIFORM, 200.0, EVEN.map(|u| 1e3 * u), 2)),
    ("harmonics_open", || harmonics(UNIFORM, 0.0, EVEN, 2)),
    ("harmonics_layer", || harmonics_layer(LAYER)),
    ("harmonics_rough_layer", || harmonics_layer(ROUGH)),
    ("event_driven", || harmonics(EVENTS, 200.0, EVEN, 2)),
    ("event_driven_force", || harmonics(EVENTS, 200.0, EVEN, 1)),
    ("batch_stiffness", || batch_stiffness(batch(200.0, false, 1))),
    ("batch_stiffness_shared", || batch_stiffness(batch(200.0, true, 1))),
    ("batch_stiffness_inactive", || batch_stiffness(batch(200.0, false, 0))),
    ("batch_stiffness_open", || batch_stiffness(batch(0.0, false, 1))),
    ("batch_update", || batch_update(batch(200.0, false, 1))),
    ("batch_update_shared", || batch_update(batch(200.0, true, 1))),
    ("batch_update_inactive", || batch_update(batch(200.0, false, 0))),
    ("batch_update_open", || batch_update(batch(0.0, false, 1))),
    ("batch_harmonics", || batch_harmonics(batch(200.0, false, 1))),
    ("batch_harmonics_shared", || batch_harmonics(batch(200.0, true, 1))),
    ("batch_harmonics_inactive", || batch_harmonics(batch(200.0, false, 0))),
    ("batch_harmonics_open", || batch_harmonics(batch(0.0, false, 1))),
    ("element", || element_update(3, NewState::Separate)),
    ("element_force", || element_update(2, NewState::Separate)),
    ("element_in_place", || element_update(3, NewState::InPlace)),
    ("element_discarded", || element_update(3, NewState::Discarded)),
    ("element_force_in_place", || element_update(2, NewState::InPlace)),
    ("element_no_output", || element_update(0, NewState::InPlace)),
    ("path_element", || element_path(element(), 1.0, 3)),
    ("path_element_force", || element_path(element(), 1.0, 2)),
    ("path_element_beyond", || element_path(element(), BEYOND, 3)),
    ("path_element_force_beyond", || element_path(element(), BEYOND, 2)),
    ("path_element_layer_beyond", || element_path(element_with(LAYER), BEYOND, 3)),
    ("path_element_rough_layer_beyond", || element_path(element_with(ROUGH), BEYOND, 3)),
    ("batch_element", || batch_element(false, 1)),
    ("batch_element_shared", || batch_element(true, 1)),
    ("batch_element_inactive", || batch_element(false, 0)),
    ("element_harmonics", || element_harmonics(false, 2)),
    ("element_harmonics_force", || element_harmonics(false, 1)),
    ("element_harmonics_energy", || element_harmonics(false, 3)),
    ("element_harmonics_open", || element_harmonics(true, 2)),
];

/// Callgrind counts from its call to its return.
#[unsafe(no_mangle)]
#[inline(never)]
fn count(mut call: Call) -> i32 {
    call()
}

/// Runs itself under callgrind, which writes a profile after each call of `count`, prints the counts and checks the relations.
fn main() {
    if std::env::args().len() > 1 {
        return CASES.iter().for_each(|(_, prepare)| assert_eq!(count(prepare()), MSLIP_OK));
    }
    let program = std::env::current_exe().expect("the path of this program");
    let profile = program.with_extension("profile").display().to_string();
    let mut valgrind = Command::new("valgrind");
    valgrind.args(["--quiet", "--tool=callgrind", "--toggle-collect=count", "--dump-after=count"]);
    let status = valgrind.arg(format!("--callgrind-out-file={profile}")).arg(program).arg("calls").status();
    assert!(status.is_ok_and(|status| status.success()), "valgrind fails");
    let counts = CASES.iter().enumerate().map(|(i, (name, _))| {
        let profile = std::fs::read_to_string(format!("{profile}.{}", i + 1)).expect("a profile of each call");
        let total = profile.lines().find_map(|line| line.strip_prefix("totals: ")).expect("a line of totals");
        println!("{name} {total}");
        (*name, total.trim().parse().expect("a count of instructions"))
    });
    let counts: HashMap<&str, f64> = counts.collect();
    let mut failed = 0;
    for &(smaller, bound, larger, reason) in RELATIONS {
        let ratio = counts[smaller] / counts[larger];
        let holds = ratio < bound;
        failed += usize::from(!holds);
        println!("{} {smaller} < {bound} {larger}: {ratio:.3}; {reason}", if holds { "ok   " } else { "FAIL " });
    }
    println!("{} passed, {failed} failed", RELATIONS.len() - failed);
    std::process::exit(i32::from(failed > 0));
}
