//! An input is a sequence of calls on a few contacts, states and workspaces; some of their memory is corrupted in between.
//!
//! Checks of each call: the status is declared and explained by the arguments; a rejected call has written nothing; no output
//! depends on which others are requested, or on where the states are; outputs are within their bounds, inputs are not modified,
//! and no floating-point exception is raised. Uninitialised memory is rejected. Corrupted memory behind a valid tag may give
//! any results, but no access out of bounds and no panic; the checks of contacts and states are called for it, too.
#![no_main]

use libfuzzer_sys::fuzz_target;
use microslip::ffi::*;
use microslip::{EllipticParameters, Error, Material, Parameters};
use microslip_fuzz::contacts::{self, SIZE};
use microslip_fuzz::interface::{self, Faults, call, status};
use microslip_fuzz::memory::{Array, Output, UNTOUCHED, same};
use microslip_fuzz::source::{Scatter, Source};
use microslip_fuzz::tell;
use std::ptr::{null, null_mut};

fuzz_target!(init: interface::start(), |input: &[u8]| {
    let mut world = World::new(Source::new(input));
    while !world.source.is_empty() {
        world.step();
    }
    assert!(world.contacts.is(&world.contacts_as_written), "a contact that was to be read was changed");
});

/// Status of a buffer: uninitialised, initialised, or corrupted since.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Status {
    Uninitialised,
    Good,
    Corrupted,
}
use Status::{Corrupted, Good, Uninitialised};

impl Status {
    fn faults(self, error: Error) -> Faults {
        Faults::default().when(self == Uninitialised, error).arbitrary(self == Corrupted)
    }
}

struct State {
    numbers: Array,
    status: Status,
}

struct Workspace {
    numbers: Array,
    status: Status,
    harmonics: usize,
}

const CONTACTS: usize = 4;

struct World<'a> {
    source: Source<'a>,
    contacts: Array,
    contacts_as_written: Array,
    contact_status: [Status; CONTACTS],
    states: [State; 3],
    workspaces: [Workspace; 2],
}

/// A contact as an argument, and what its results are compared with.
struct Chosen {
    pointer: *const mslip_contact,
    faults: Faults,
    half_width: f64,
    slip_force: f64,
    slip_displacement: f64,
    initial_stiffness: f64,
    slip_energy: f64,
}

impl Chosen {
    /// A scale for displacements.
    fn scale(&self) -> f64 {
        if self.slip_displacement > 0.0 { self.slip_displacement } else { 1e-6 }
    }
}

/// Items of a batch.
struct Items {
    n: usize,
    n_contacts: usize,
    contacts: *const mslip_contact,
    index: Option<Vec<i32>>,
    active: Option<Vec<i32>>,
    /// The contact of each item; `None` for those that are skipped.
    slots: Vec<Option<usize>>,
    faults: Faults,
}

impl Items {
    fn active(&self) -> impl Iterator<Item = usize> {
        self.slots.iter().enumerate().filter_map(|(i, slot)| slot.map(|_| i))
    }
}

fn pointer(flags: &Option<Vec<i32>>) -> *const i32 {
    flags.as_ref().map_or(null(), |flags| flags.as_ptr())
}

const UNKNOWN: Chosen = Chosen {
    pointer: null(),
    faults: Faults::NONE,
    half_width: 1.0,
    slip_force: 0.0,
    slip_displacement: 0.0,
    initial_stiffness: 0.0,
    slip_energy: 0.0,
};

/// An excess over mu N that is a few units of rounding is taken as mu N.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Displacements beyond are rejected.
const FARTHEST: f64 = 1e150;

fn is_near(displacement: f64) -> bool {
    displacement.abs() <= FARTHEST
}

/// Within a bound, up to rounding.
fn within(value: f64, bound: f64) -> bool {
    value.abs() <= bound * (1.0 + 1e-13)
}

fn all(values: &[f64], holds: impl Fn(f64) -> bool) -> bool {
    values.iter().all(|&value| holds(value))
}

fn not_negative(values: &[f64]) -> bool {
    all(values, |value| value >= 0.0 && value.is_finite())
}

impl<'a> World<'a> {
    fn new(source: Source<'a>) -> World<'a> {
        let mut source = source;
        let mut contacts = Array::new(CONTACTS * SIZE, UNTOUCHED);
        let (choices, mut contact_status) = (contacts::all(), [Uninitialised; CONTACTS]);
        for (contact, status) in contacts.values_mut().chunks_exact_mut(SIZE).zip(&mut contact_status) {
            // The last choice leaves it uninitialised.
            if let Some((_, bits)) = choices.get(source.below(choices.len() + 1)) {
                contact.copy_from_slice(bits);
                *status = Good;
            }
        }
        let states = [(); 3].map(|()| {
            let byte = source.byte() as usize;
            let mut numbers = Array::new(mslip_state_length(byte % 24), UNTOUCHED);
            if byte >= 240 {
                return State { numbers, status: Uninitialised };
            }
            let answer = call(true, || unsafe { mslip_state_init(numbers.values().len(), numbers.pointer_mut()) });
            assert!(answer == 0);
            State { numbers, status: Good }
        });
        let workspaces =
            [(); 2].map(|()| Workspace { numbers: Array::new(4, UNTOUCHED), status: Uninitialised, harmonics: 1 });
        World { source, contacts_as_written: contacts.copy(), contacts, contact_status, states, workspaces }
    }

    fn step(&mut self) {
        // Cheap calls are frequent: a contact costs as much as a thousand steps, sliders as much as ten thousand.
        match self.source.byte() {
            0 => self.init(),
            1 => self.contact_check(),
            2..5 => self.init_elliptic(),
            5..11 => self.copy_contact(),
            11..17 => self.corrupt(),
            17..27 => self.tractions(),
            27..35 => self.slip(),
            35..49 => self.monotonic_displacement(),
            49..67 => self.monotonic_force(),
            67..79 => self.state_init(),
            79..129 => self.masing_update(),
            129..155 => self.steps(),
            155..159 => self.state_check(),
            159..177 => self.masing_path(),
            177..185 => self.masing_tractions(),
            185..193 => self.hysteresis_loop(),
            193..201 => self.dissipated_energy(),
            201..211 => self.complex_stiffness(),
            211..214 => self.workspace_init(),
            214..225 => self.harmonic_force(),
            225..229 => self.jenkins_equivalent(),
            229 => self.iwan_equivalent(),
            230..235 => self.batch_complex_stiffness(),
            235..245 => self.batch_masing_update(),
            245..248 => self.batch_harmonic_force(),
            _ => self.others(),
        }
    }

    // Arguments.

    fn contact(&mut self) -> Chosen {
        let byte = self.source.byte() as usize;
        let slot = byte % CONTACTS;
        let status = self.contact_status[slot];
        tell!("  contact {slot}, {status:?}");
        if byte >= 0xfc {
            return Chosen { pointer: null(), faults: Faults::default().when(true, Error::NullPointer), ..UNKNOWN };
        }
        let chosen = self.item(slot);
        let known = if status == Good { chosen } else { Chosen { pointer: chosen.pointer, ..UNKNOWN } };
        Chosen { faults: status.faults(Error::BadContact), ..known }
    }

    fn contact_check(&mut self) {
        let slot = self.source.below(CONTACTS);
        let contact = self.contacts.values()[slot * SIZE..].as_ptr().cast();
        let answer = status("mslip_contact_check", true, || unsafe { mslip_contact_check(contact) });
        // A contact that was corrupted may have been corrected by chance.
        let faults = self.contact_status[slot].faults(Error::BadContact);
        faults.explain("mslip_contact_check", answer);
    }

    /// An input, its pointer and its length as they are passed, and what is wrong with them.
    fn numbers(&mut self, scale: f64) -> (Array, *const f64, usize, Faults) {
        let length = self.source.length();
        let array = Array::of((0..length).map(|_| self.source.number(scale)));
        tell!("  {:?}", array.values());
        match self.source.byte() {
            0xff => {
                let n = self.source.huge().unwrap_or(length);
                let faults = Faults::default().when(n != length, Error::BadArraySize);
                (Array::new(0, 0.0), null(), n, faults.when(n > 0, Error::NullPointer))
            }
            0xfe => match self.source.huge() {
                Some(n) => {
                    let pointer = array.pointer();
                    (array, pointer, n, Faults::default().when(true, Error::BadArraySize))
                }
                None => (Array::new(0, 0.0), null(), 0, Faults::default()),
            },
            _ => {
                let pointer = array.pointer();
                (array, pointer, length, Faults::default())
            }
        }
    }

    /// A call whose outputs have the given lengths, once with outputs requested by the input, and perhaps again with all.
    /// `None` for one that was rejected, or has arbitrary results.
    fn run<const K: usize>(
        &mut self,
        name: &str,
        faults: Faults,
        lengths: [usize; K],
        mut function: impl FnMut([*mut f64; K]) -> i32,
    ) -> Option<[Output; K]> {
        let choice = self.source.byte();
        let mut k = 0;
        let mut outputs = lengths.map(|length| {
            k += 1;
            Output::new(choice >> (k - 1) & 1 == 0, length)
        });
        let answer = status(name, !faults.is_arbitrary(), || function(outputs.each_mut().map(Output::pointer)));
        tell!("  {:?}", outputs.each_ref().map(Output::values));
        faults.explain(name, answer);
        if answer != 0 {
            assert!(outputs.iter().all(Output::is_untouched), "{name} is rejected and has written");
            return None;
        }
        if faults.is_arbitrary() {
            return None;
        }
        assert!(outputs.iter().all(|output| all(output.values(), |value| !value.is_nan())), "{name} gives no number");
        if choice & 0x40 != 0 {
            let mut again = lengths.map(|length| Output::new(true, length));
            let second = status(name, true, || function(again.each_mut().map(Output::pointer)));
            assert!(second == 0, "{name} returns {second} the second time");
            for (one, two) in outputs.iter().zip(&again) {
                let equal = one.0.is_none() || same(one.values(), two.values());
                assert!(equal, "{name} gives something else the second time: {:?} {:?}", one.values(), two.values());
            }
        }
        Some(outputs)
    }

    // Contacts.

    /// Whether each number is allowed by itself.
    fn faults_of_materials(material: &[Material; 2], faults: Faults) -> Faults {
        let modulus = |value: f64| value > 0.0 && value.is_finite();
        let wrong_modulus = material.iter().any(|body| !modulus(body.young_modulus));
        let wrong_ratio = material.iter().any(|body| !(0.0..=0.5).contains(&body.poisson_ratio));
        faults.when(wrong_modulus, Error::BadYoungModulus).when(wrong_ratio, Error::BadPoissonRatio)
    }

    fn faults_of(p: &Parameters) -> Faults {
        let wrong = |value: f64| !(value > 0.0 && value.is_finite());
        let faults = Faults::default()
            .when(wrong(p.flat_half_width) && p.flat_half_width != 0.0, Error::BadFlatHalfWidth)
            .when(wrong(p.edge_radius), Error::BadEdgeRadius)
            .when(wrong(p.length), Error::BadLength)
            .when(wrong(p.normal_force) && p.normal_force != 0.0, Error::BadNormalForce)
            .when(wrong(p.friction_coefficient) && p.friction_coefficient != 0.0, Error::BadFrictionCoefficient)
            .when(!(0..=1).contains(&p.displacement_reference), Error::BadDisplacementReference);
        World::faults_of_materials(&p.material, faults).may(true, Error::LengthTooShort).may(true, Error::OutOfRange)
    }

    /// Copies an initialised contact into a slot.
    fn keep(&mut self, slot: usize, contact: &[f64]) {
        self.contacts.values_mut()[slot * SIZE..][..SIZE].copy_from_slice(contact);
        self.contacts_as_written.values_mut()[slot * SIZE..][..SIZE].copy_from_slice(contact);
        self.contact_status[slot] = Good;
        let &[modulus, half_width, slip_force, slip_displacement, stiffness, energy, ..] = contact else { return };
        assert!(modulus > 0.0 && modulus.is_finite(), "E* {modulus}");
        let others = [half_width, slip_force, slip_displacement, stiffness, energy];
        assert!(not_negative(&others), "{others:?}");
        if slip_force > 0.0 {
            assert!(others.iter().all(|&value| value > 0.0), "{others:?}");
            // The curve is concave, and as high as mu N at its end; its cycle lies within its parallelogram.
            assert!(slip_force <= stiffness * slip_displacement * (1.0 + 1e-13), "{others:?}");
            assert!(energy <= 4.0 * slip_force * slip_displacement, "{others:?}");
        } else {
            assert!(slip_displacement == 0.0 && stiffness == 0.0 && energy == 0.0, "{others:?}");
        }
    }

    fn init(&mut self) {
        let slot = self.source.below(CONTACTS);
        let p = contacts::draw_flat(&mut self.source);
        tell!("{p:?}");
        let [mut made, mut again] = [(); 2].map(|()| Array::new(SIZE, UNTOUCHED));
        let null_contact = self.source.byte() == 0xff;
        let pointer = if null_contact { null_mut() } else { made.pointer_mut().cast() };
        let answer = status("mslip_contact_init", true, || unsafe { mslip_contact_init(&p, pointer) });
        World::faults_of(&p).when(null_contact, Error::NullPointer).explain("mslip_contact_init", answer);
        if answer == 0 {
            call(true, || unsafe { mslip_contact_init(&p, again.pointer_mut().cast()) });
            assert!(made.is(&again), "the same parameters make another contact");
            self.keep(slot, made.values());
        } else {
            assert!(made.is(&again), "a rejected contact was written to");
        }
    }

    fn init_elliptic(&mut self) {
        let slot = self.source.below(CONTACTS);
        let p = contacts::draw_ellipse(&mut self.source);
        tell!("{p:?}");
        let wrong = |value: f64| !(value > 0.0 && value.is_finite());
        let faults = Faults::default()
            .when(wrong(p.semi_axis_x), Error::BadSemiAxisX)
            .when(wrong(p.semi_axis_y), Error::BadSemiAxisY)
            .when(wrong(p.normal_force) && p.normal_force != 0.0, Error::BadNormalForce)
            .when(wrong(p.friction_coefficient) && p.friction_coefficient != 0.0, Error::BadFrictionCoefficient);
        let faults = World::faults_of_materials(&p.material, faults).may(true, Error::OutOfRange);
        let mut made = Array::new(SIZE, UNTOUCHED);
        let answer = status("mslip_contact_init_elliptic", true, || unsafe {
            mslip_contact_init_elliptic(&p, made.pointer_mut().cast())
        });
        faults.explain("mslip_contact_init_elliptic", answer);
        if answer == 0 {
            self.keep(slot, made.values());
        } else {
            assert!(all(made.values(), |value| value.to_bits() == UNTOUCHED.to_bits()));
        }
    }

    fn copy_contact(&mut self) {
        let (from, to) = (self.source.byte() as usize, self.source.below(CONTACTS));
        if let Some((_, bits)) = contacts::all().get(from) {
            self.keep(to, bits);
        } else {
            let from = from % CONTACTS;
            for contacts in [&mut self.contacts, &mut self.contacts_as_written] {
                contacts.values_mut().copy_within(from * SIZE..(from + 1) * SIZE, to * SIZE);
            }
            self.contact_status[to] = self.contact_status[from];
        }
    }

    /// Corrupts a double of a buffer.
    fn corrupt(&mut self) {
        let (what, place) = (self.source.byte() as usize, self.source.byte() as usize);
        let value = match self.source.byte() {
            bit if bit < 128 => Err(1 << (bit % 64)),
            _ => Ok(self.source.number(1e-6)),
        };
        tell!("corrupt {what}, {place}: {value:?}");
        let change = |number: &mut f64, status: &mut Status| {
            let before = number.to_bits();
            *number = value.unwrap_or_else(|bit: u64| f64::from_bits(before ^ bit));
            if *status == Good && before != number.to_bits() {
                *status = Corrupted;
            }
        };
        match what % 8 {
            0..3 => {
                let slot = what / 8 % CONTACTS;
                let contact = &mut self.contacts.values_mut()[slot * SIZE..][..SIZE];
                change(&mut contact[place % SIZE], &mut self.contact_status[slot]);
                self.contacts_as_written.values_mut()[slot * SIZE..][..SIZE].copy_from_slice(contact);
            }
            3..6 => {
                let State { numbers, status } = &mut self.states[what / 8 % 3];
                let numbers = numbers.values_mut();
                if !numbers.is_empty() {
                    let place = place % numbers.len();
                    change(&mut numbers[place], status);
                }
            }
            _ => {
                let Workspace { numbers, status, .. } = &mut self.workspaces[what / 8 % 2];
                let numbers = numbers.values_mut();
                let header: [f64; 4] = *numbers.first_chunk().expect("a header");
                let place = if what % 2 == 0 { place % 4 } else { place % numbers.len() };
                change(&mut numbers[place], status);
                // The header of another valid workspace belongs to memory of another length.
                let extent = microslip::hbm::workspace_extent(numbers.first_chunk().expect("a header"));
                if extent.is_ok_and(|extent| extent > numbers.len()) {
                    numbers[..header.len()].copy_from_slice(&header);
                }
            }
        }
    }

    // The monotonic curve and its tractions.

    fn faults_of_force(c: &Chosen, force: f64) -> Faults {
        c.faults
            .when(!force.is_finite(), Error::BadForce)
            .when(force.abs() > c.slip_force * (1.0 + ROUNDING), Error::ForceExceedsSlip)
    }

    fn tractions(&mut self) {
        let c = self.contact();
        let force = self.source.number(c.slip_force);
        let (x, at, n, faults) = self.numbers(c.half_width);
        let faults =
            faults.and(World::faults_of_force(&c, force)).when(!all(x.values(), f64::is_finite), Error::BadPosition);
        tell!("  force {force:e}");
        let given = self.run("mslip_tractions", faults, [x.values().len(); 2], |[pressure, shear]| unsafe {
            mslip_tractions(c.pointer, force, n, at, pressure, shear)
        });
        if let Some([pressure, shear]) = given {
            assert!(not_negative(pressure.values()), "a pressure is negative");
            assert!(
                all(shear.values(), |shear| shear.is_finite() && shear * force >= 0.0),
                "the shear has another sign"
            );
        }
    }

    fn slip(&mut self) {
        let c = self.contact();
        let force = self.source.number(c.slip_force);
        let (x, at, n, faults) = self.numbers(c.half_width);
        tell!("  force {force:e}");
        let faults = faults
            .and(World::faults_of_force(&c, force))
            .when(!all(x.values(), f64::is_finite), Error::BadPosition)
            .may(true, Error::NotAvailable);
        let given = self.run("mslip_slip", faults, [x.values().len(); 2], |[slip, damage]| unsafe {
            mslip_slip(c.pointer, force, n, at, slip, damage)
        });
        if let Some([slip, damage]) = given {
            // At the stick edge itself rounding leaves a sliver, without a force too.
            let signed =
                |slip: f64| if force == 0.0 { slip.abs() <= 1e-15 * c.slip_displacement } else { slip * force >= 0.0 };
            assert!(all(slip.values(), |slip| slip.is_finite() && signed(slip)), "the slip has another sign");
            assert!(not_negative(damage.values()), "a damage is negative");
        }
    }

    fn monotonic_displacement(&mut self) {
        let c = self.contact();
        let (force, at, n, faults) = self.numbers(c.slip_force);
        let faults = force.values().iter().fold(faults.and(c.faults), |faults, &force| {
            let here = World::faults_of_force(&Chosen { faults: Faults::default(), ..c }, force);
            faults.and(here)
        });
        let lengths = [force.values().len(); 3];
        let name = "mslip_monotonic_displacement";
        let given = self.run(name, faults, lengths, |[displacement, compliance, stick]| unsafe {
            mslip_monotonic_displacement(c.pointer, n, at, displacement, compliance, stick)
        });
        let Some([displacement, compliance, stick]) = given else { return };
        for (&displacement, &force) in displacement.values().iter().zip(force.values()) {
            assert!(
                within(displacement, c.slip_displacement) && displacement * force.signum() >= 0.0,
                "{displacement:e}"
            );
        }
        let least = if c.slip_force > 0.0 { (1.0 - 1e-13) / c.initial_stiffness } else { f64::INFINITY };
        assert!(
            all(compliance.values(), |compliance| compliance >= least),
            "{:?} below {least:e}",
            compliance.values()
        );
        assert!(all(stick.values(), |stick| stick >= 0.0 && within(stick, c.half_width)), "{:?}", stick.values());
    }

    fn monotonic_force(&mut self) {
        let c = self.contact();
        let (displacement, at, n, faults) = self.numbers(c.scale());
        let far = !all(displacement.values(), is_near);
        let faults = faults.and(c.faults).when(far, Error::BadDisplacement);
        let lengths = [displacement.values().len(); 3];
        let given = self.run("mslip_monotonic_force", faults, lengths, |[force, stiffness, stick]| unsafe {
            mslip_monotonic_force(c.pointer, n, at, force, stiffness, stick)
        });
        let Some([force, stiffness, stick]) = given else { return };
        for (&force, &displacement) in force.values().iter().zip(displacement.values()) {
            assert!(force.abs() <= c.slip_force && force * displacement.signum() >= 0.0, "{force:e}");
        }
        assert!(
            all(stiffness.values(), |value| value >= 0.0 && within(value, c.initial_stiffness)),
            "{:?}",
            stiffness.values()
        );
        assert!(all(stick.values(), |stick| stick >= 0.0 && within(stick, c.half_width)), "{:?}", stick.values());
    }

    // Histories.

    fn state_init(&mut self) {
        let slot = self.source.below(3);
        let byte = self.source.byte() as usize;
        // Valid lengths, and shorter ones.
        let length = if byte < 192 { mslip_state_length(byte % 12) } else { byte % 16 };
        let mut numbers = Array::new(length, UNTOUCHED);
        let (pointer, passed, faults) = match self.source.huge() {
            Some(huge) => (numbers.pointer_mut(), huge, Faults::default().when(true, Error::BadArraySize)),
            None if byte == 0xff => (null_mut(), length, Faults::default().when(true, Error::NullPointer)),
            None => {
                let faults = Faults::default().when(length < mslip_state_length(0), Error::StateTooShort);
                (numbers.pointer_mut(), length, faults)
            }
        };
        let answer = status("mslip_state_init", true, || unsafe { mslip_state_init(passed, pointer) });
        faults.explain("mslip_state_init", answer);
        assert!(answer == 0 || all(numbers.values(), |value| value.to_bits() == UNTOUCHED.to_bits()));
        self.states[slot] = State { numbers, status: if answer == 0 { Good } else { Uninitialised } };
    }

    /// A state: the number of its slot, a copy of it, and what is wrong with it.
    fn state(&mut self) -> (usize, Array, Faults) {
        let slot = self.source.below(3);
        let State { numbers, status } = &self.states[slot];
        let short = numbers.values().len() < mslip_state_length(0);
        let faults = Faults::default()
            .when(short, Error::StateTooShort)
            .when(short && numbers.values().is_empty(), Error::NullPointer);
        let faults = if short { faults } else { faults.and(status.faults(Error::BadState)) };
        tell!("  state {slot}, {status:?}: {:?}", numbers.values());
        (slot, numbers.copy(), faults)
    }

    fn state_check(&mut self) {
        let (_, state, faults) = self.state();
        let (length, at) = (state.values().len(), state.pointer());
        let answer = status("mslip_state_check", true, || unsafe { mslip_state_check(length, at) });
        // Steps of different contacts may leave what no history of one contact does.
        faults.may(true, Error::BadState).explain("mslip_state_check", answer);
        if let Some([error]) =
            self.run("mslip_state_error", faults, [1], |[error]| unsafe { mslip_state_error(length, at, error) })
        {
            assert!(not_negative(error.values()), "an error of {:?}", error.values());
        }
    }

    /// Checks the bounds of the results of a history.
    fn check_history(c: &Chosen, [force, stiffness, dissipated]: [&[f64]; 3]) {
        assert!(all(force, |force| force.abs() <= c.slip_force), "{force:?} beyond {:e}", c.slip_force);
        assert!(all(stiffness, |value| value >= 0.0 && within(value, c.initial_stiffness)), "{stiffness:?}");
        assert!(not_negative(dissipated), "dissipated {dissipated:?}");
    }

    fn masing_update(&mut self) {
        let c = self.contact();
        let (slot, before, faults) = self.state();
        let displacement = self.source.number(c.scale());
        tell!("  to {displacement:e}");
        let faults = faults.and(c.faults).when(!is_near(displacement), Error::BadDisplacement);
        self.advance(
            &c,
            slot,
            before,
            faults,
            1,
            "mslip_masing_update",
            |length, from, to, [force, stiffness, dissipated]| unsafe {
                mslip_masing_update(c.pointer, length, from, displacement, to, force, stiffness, dissipated)
            },
        );
    }

    fn masing_path(&mut self) {
        let c = self.contact();
        let (slot, before, faults) = self.state();
        let (path, at, n, wrong) = self.numbers(c.scale());
        let far = !all(path.values(), is_near);
        let faults = faults.and(wrong).and(c.faults).when(far, Error::BadDisplacement);
        let steps = path.values().len();
        self.advance(
            &c,
            slot,
            before,
            faults,
            steps,
            "mslip_masing_path",
            |length, from, to, [force, stiffness, dissipated]| unsafe {
                mslip_masing_path(c.pointer, length, from, n, at, to, force, stiffness, dissipated)
            },
        );
    }

    /// Advances a state in place, into other memory, or discards the new one: all must give the same.
    #[allow(clippy::too_many_arguments)]
    fn advance(
        &mut self,
        c: &Chosen,
        slot: usize,
        before: Array,
        faults: Faults,
        steps: usize,
        name: &str,
        mut function: impl FnMut(usize, *const f64, *mut f64, [*mut f64; 3]) -> i32,
    ) {
        let (where_to, huge) = (self.source.byte(), self.source.huge());
        let length = before.values().len();
        let passed = huge.unwrap_or(length);
        let faults = faults.when(huge.is_some(), Error::BadArraySize);
        let mut state = std::mem::replace(&mut self.states[slot].numbers, Array::new(0, 0.0));
        let mut other = Array::new(length, UNTOUCHED);
        let given = self.run(name, faults, [steps; 3], |outputs| {
            // The old state of a second call.
            state.values_mut().copy_from_slice(before.values());
            let pointer = state.pointer_mut();
            let to = [pointer, other.pointer_mut(), null_mut()][where_to as usize % 3];
            function(passed, pointer, to, outputs)
        });
        let in_place = where_to % 3 == 0;
        let arbitrary = faults.is_arbitrary();
        if !in_place || (given.is_none() && !arbitrary) {
            assert!(state.is(&before), "{name} has modified a state that it may only read");
        }
        if let Some([force, stiffness, dissipated]) = &given {
            World::check_history(c, [force.values(), stiffness.values(), dissipated.values()]);
            // The same into other memory.
            let mut elsewhere = Array::new(length, UNTOUCHED);
            let answer =
                status(name, true, || function(passed, before.pointer(), elsewhere.pointer_mut(), [null_mut(); 3]));
            assert!(answer == 0, "{name} returns {answer} if only the state is requested");
            let written = if in_place { Some(&state) } else { Some(&other).filter(|_| where_to % 3 == 1) };
            assert!(written.is_none_or(|written| written.is(&elsewhere)), "{name} leaves another state elsewhere");
            state = elsewhere;
        }
        self.states[slot].numbers = state;
    }

    /// Many steps one by one, compared with one call.
    fn steps(&mut self) {
        let c = self.contact();
        let (slot, before, faults) = self.state();
        let steps = self.source.byte() as usize + 1;
        let width = self.source.number(c.scale());
        let mut scatter = Scatter::new(&mut self.source, width);
        let mut path = Array::new(steps, 0.0);
        for i in 0..steps {
            path.values_mut()[i] = scatter.next(&path.values()[..i]);
        }
        tell!("  {:?}", path.values());
        let far = !all(path.values(), is_near);
        let faults = faults.and(c.faults).when(far, Error::BadDisplacement);
        let (mut stepped, mut at_once, length) = (before.copy(), before.copy(), before.values().len());
        let [mut force, mut stiffness, mut dissipated] = [(); 3].map(|()| Array::new(steps, UNTOUCHED));
        let traps = !faults.is_arbitrary();
        let mut answer = 0;
        for i in 0..steps {
            let state = stepped.pointer_mut();
            let outputs = [&mut force, &mut stiffness, &mut dissipated].map(|array| &raw mut array.values_mut()[i]);
            let [force, stiffness, dissipated] = outputs;
            let displacement = path.values()[i];
            answer = status("mslip_masing_update", traps, || unsafe {
                mslip_masing_update(c.pointer, length, state, displacement, state, force, stiffness, dissipated)
            });
            if answer != 0 {
                break;
            }
        }
        faults.explain("mslip_masing_update", answer);
        let mut outputs = [(); 3].map(|()| Array::new(steps, UNTOUCHED));
        let state = at_once.pointer_mut();
        let [f, k, d] = outputs.each_mut().map(Array::pointer_mut);
        let status_at_once = status("mslip_masing_path", traps, || unsafe {
            mslip_masing_path(c.pointer, length, state, steps, path.pointer(), state, f, k, d)
        });
        if faults.is_arbitrary() {
            return;
        }
        assert!(answer == status_at_once, "steps return {answer}, a path {status_at_once}");
        let taken = force.values().iter().take_while(|force| force.to_bits() != UNTOUCHED.to_bits()).count();
        let [force, stiffness, dissipated] = [&force, &stiffness, &dissipated].map(|array| &array.values()[..taken]);
        World::check_history(&c, [force, stiffness, dissipated]);
        if answer == 0 {
            let [f, k, d] = outputs.each_ref().map(Array::values);
            assert!(same(force, f) && same(stiffness, k) && same(dissipated, d), "a path differs from its steps");
            assert!(stepped.is(&at_once), "the state after a path differs from that after its steps");
            self.states[slot].numbers = stepped;
        } else {
            assert!(at_once.is(&before), "a path that was rejected has modified its state");
        }
    }

    fn masing_tractions(&mut self) {
        let c = self.contact();
        let (slot, _, faults) = self.state();
        let (x, at, n, wrong) = self.numbers(c.half_width);
        let faults = faults
            .and(wrong)
            .and(c.faults)
            .when(!all(x.values(), f64::is_finite), Error::BadPosition)
            .may(true, Error::ForceExceedsSlip);
        let (from, length) = (self.states[slot].numbers.pointer(), self.states[slot].numbers.values().len());
        let lengths = [x.values().len(); 2];
        let given = self.run("mslip_masing_tractions", faults, lengths, |[pressure, shear]| unsafe {
            mslip_masing_tractions(c.pointer, length, from, n, at, pressure, shear)
        });
        if let Some([pressure, shear]) = given {
            assert!(not_negative(pressure.values()) && all(shear.values(), f64::is_finite));
        }
    }

    // Cycles.

    fn faults_of_amplitude(amplitude: f64) -> Faults {
        Faults::default().when(!(0.0..=FARTHEST).contains(&amplitude), Error::BadAmplitude)
    }

    fn hysteresis_loop(&mut self) {
        let c = self.contact();
        let amplitude = self.source.number(c.scale());
        let n = self.source.length();
        let huge = self.source.huge();
        tell!("  amplitude {amplitude:e}, {n} points");
        let faults = World::faults_of_amplitude(amplitude).and(c.faults).when(huge.is_some(), Error::BadArraySize);
        let given = self.run("mslip_hysteresis_loop", faults, [n; 2], |[displacement, force]| unsafe {
            mslip_hysteresis_loop(c.pointer, amplitude, huge.unwrap_or(n), displacement, force)
        });
        if let Some([displacement, force]) = given {
            assert!(all(displacement.values(), |value| value.abs() <= amplitude), "{:?}", displacement.values());
            assert!(all(force.values(), |force| force.abs() <= c.slip_force), "{:?}", force.values());
        }
    }

    fn dissipated_energy(&mut self) {
        let c = self.contact();
        let (amplitude, at, n, faults) = self.numbers(c.slip_force);
        let wrong = !all(amplitude.values(), |amplitude| amplitude >= 0.0 && amplitude.is_finite());
        let beyond = amplitude.values().iter().any(|&amplitude| amplitude > c.slip_force * (1.0 + ROUNDING));
        let faults = faults.and(c.faults).when(wrong, Error::BadForceAmplitude).when(beyond, Error::ForceExceedsSlip);
        let given = self.run("mslip_dissipated_energy", faults, [amplitude.values().len()], |[energy]| unsafe {
            mslip_dissipated_energy(c.pointer, n, at, energy)
        });
        if let Some([energy]) = given {
            assert!(
                all(energy.values(), |energy| energy >= 0.0 && within(energy, c.slip_energy)),
                "{:?}",
                energy.values()
            );
        }
    }

    fn check_complex_stiffness(c: &Chosen, [real, imaginary, real_slope, imaginary_slope]: [&[f64]; 4]) {
        assert!(all(real, |value| value >= 0.0 && within(value, c.initial_stiffness)), "K' {real:?}");
        assert!(all(imaginary, |value| value >= 0.0 && within(value, c.initial_stiffness)), "K'' {imaginary:?}");
        assert!(all(real_slope, |value| value <= 0.0 && value.is_finite()), "dK' {real_slope:?}");
        assert!(all(imaginary_slope, f64::is_finite), "dK'' {imaginary_slope:?}");
    }

    fn complex_stiffness(&mut self) {
        let c = self.contact();
        let (amplitude, at, n, faults) = self.numbers(c.scale());
        let faults = amplitude
            .values()
            .iter()
            .fold(faults.and(c.faults), |faults, &one| faults.and(World::faults_of_amplitude(one)));
        let name = "mslip_complex_stiffness";
        let given = self.run(name, faults, [amplitude.values().len(); 4], |[a, b, da, db]| unsafe {
            mslip_complex_stiffness(c.pointer, n, at, a, b, da, db)
        });
        if let Some(given) = given {
            World::check_complex_stiffness(&c, given.each_ref().map(Output::values));
        }
    }

    fn jenkins_equivalent(&mut self) {
        let c = self.contact();
        let amplitude = self.source.number(c.scale());
        tell!("  amplitude {amplitude:e}");
        let faults = World::faults_of_amplitude(amplitude).and(c.faults);
        let given = self.run("mslip_jenkins_equivalent", faults, [1; 2], |[stiffness, slip_force]| unsafe {
            mslip_jenkins_equivalent(c.pointer, amplitude, stiffness, slip_force)
        });
        if let Some([stiffness, slip_force]) = given {
            assert!(not_negative(stiffness.values()) && not_negative(slip_force.values()));
        }
    }

    fn iwan_equivalent(&mut self) {
        let c = self.contact();
        // Each slider costs some 0.3 ms.
        let n = self.source.below(4);
        let huge = self.source.huge();
        let count = huge.unwrap_or(n);
        let faults =
            c.faults.when(huge.is_some(), Error::BadArraySize).when(count == 0 || huge.is_some(), Error::BadCount);
        let given = self.run("mslip_iwan_equivalent", faults, [n, n, 1], |[stiffness, slip_force, error]| unsafe {
            mslip_iwan_equivalent(c.pointer, count, stiffness, slip_force, error)
        });
        if let Some([stiffness, slip_force, error]) = given {
            assert!(not_negative(stiffness.values()) && not_negative(slip_force.values()));
            let sum: f64 = slip_force.values().iter().sum();
            assert!(slip_force.0.is_none() || (sum - c.slip_force).abs() <= 1e-12 * c.slip_force, "{sum:e}");
            assert!(all(error.values(), |error| (0.0..=1.0).contains(&error)), "{:?}", error.values());
        }
    }

    // The harmonic force.

    fn workspace_init(&mut self) {
        let slot = self.source.below(2);
        let (harmonics, samples) = (self.source.below(10), self.source.byte() as usize);
        let rule = match self.source.byte() {
            byte if byte < 248 => (byte & 1).into(),
            byte => byte as i8 as i32,
        };
        let length = mslip_harmonic_workspace_length(harmonics, samples, rule);
        let short = self.source.byte();
        // Too short, or with something behind it.
        let length = if short < 224 { length } else { (length + short as usize).saturating_sub(240) };
        let mut numbers = Array::new(length.max(4), UNTOUCHED);
        let needed = mslip_harmonic_workspace_length(harmonics, samples, rule);
        let pointer = if short == 0xff { null_mut() } else { numbers.pointer_mut() };
        let length = numbers.values().len();
        let faults = Faults::default()
            .when(!(0..=1).contains(&rule), Error::BadRule)
            .when(harmonics == 0, Error::BadHarmonics)
            .when(samples <= 2 * harmonics, Error::BadSamples)
            .when(pointer.is_null(), Error::NullPointer)
            .when(length < needed, Error::WorkspaceTooShort);
        let answer = status("mslip_harmonic_workspace_init", true, || unsafe {
            mslip_harmonic_workspace_init(harmonics, samples, rule, length, pointer)
        });
        tell!("  {harmonics} harmonics, {samples} samples, rule {rule}, {length} numbers");
        faults.explain("mslip_harmonic_workspace_init", answer);
        if answer == 0 {
            let (mut h, mut n, mut r) = (0, 0, -1);
            let size = status("mslip_harmonic_workspace_size", true, || unsafe {
                mslip_harmonic_workspace_size(pointer, &mut h, &mut n, &mut r)
            });
            assert!(
                (size, h, n, r) == (0, harmonics, samples, rule),
                "a workspace of {h} harmonics, {n} samples, rule {r}"
            );
        }
        let untouched = all(numbers.values(), |value| value.to_bits() == UNTOUCHED.to_bits());
        assert!(untouched || answer == 0, "a rejected workspace was written to");
        self.workspaces[slot] =
            Workspace { numbers, status: if answer == 0 { Good } else { Uninitialised }, harmonics };
    }

    /// A workspace: its pointer, 2H + 1, and what is wrong with it.
    fn workspace(&mut self) -> (*mut f64, usize, Faults) {
        let byte = self.source.byte() as usize;
        let workspace = &mut self.workspaces[byte % 2];
        tell!("  workspace {}, {:?}, {} harmonics", byte % 2, workspace.status, workspace.harmonics);
        if byte >= 0xfc {
            return (null_mut(), 1, Faults::default().when(true, Error::NullPointer));
        }
        // A corrupted header may give another number of harmonics.
        let header = workspace.numbers.values().first_chunk().expect("a header");
        let harmonics = microslip::hbm::workspace_size(header).map_or(workspace.harmonics, |(harmonics, ..)| harmonics);
        (workspace.numbers.pointer_mut(), 2 * harmonics + 1, workspace.status.faults(Error::BadWorkspace))
    }

    fn check_harmonic_force(c: &Chosen, [force, jacobian, dissipated]: [&[f64]; 3]) {
        // A coefficient is at most twice a mean of forces.
        assert!(all(force, |value| within(value, 2.0 * c.slip_force)), "{force:?}");
        assert!(all(jacobian, f64::is_finite), "{jacobian:?}");
        assert!(not_negative(dissipated), "dissipated {dissipated:?}");
    }

    /// Numbers around a scale.
    fn coefficients(&mut self, count: usize, scale: f64) -> Array {
        let scale = scale * self.source.power();
        let array = Array::of((0..count).map(|_| self.source.number(scale)));
        tell!("  {:?}", array.values());
        array
    }

    fn harmonic_force(&mut self) {
        let c = self.contact();
        let (workspace, one, faults) = self.workspace();
        let displacement = self.coefficients(one, c.scale());
        let far = !all(displacement.values(), is_near);
        let null_input = self.source.byte() == 0xff;
        let at = if null_input { null() } else { displacement.pointer() };
        let faults = faults.and(c.faults).when(far, Error::BadDisplacement).when(null_input, Error::NullPointer);
        let name = "mslip_harmonic_force";
        let given = self.run(name, faults, [one, one * one, 1], |[force, jacobian, dissipated]| unsafe {
            mslip_harmonic_force(c.pointer, workspace, at, force, jacobian, dissipated)
        });
        if let Some(given) = given {
            World::check_harmonic_force(&c, given.each_ref().map(Output::values));
        }
    }

    // Batches.

    /// Items: their number, the contacts and what each item uses of them, and what is wrong.
    fn items(&mut self) -> Items {
        let n = self.source.below(2 * CONTACTS);
        let choice = self.source.byte();
        let active = (choice & 1 == 0)
            .then(|| (0..n).map(|i| (choice >> (i % 7 + 1) & 1) as i32 * choice as i8 as i32).collect::<Vec<_>>());
        let index = (choice & 2 == 0).then(|| {
            let wrong = self.source.byte() >= 0xf0;
            (0..n)
                .map(|_| self.source.below(CONTACTS + usize::from(wrong)) as i32 - i32::from(wrong))
                .collect::<Vec<_>>()
        });
        let n_contacts = if self.source.byte() < 0xf0 { CONTACTS } else { self.source.below(CONTACTS) };
        let contact = |i: usize| index.as_ref().map_or(i, |index: &Vec<i32>| index[i] as usize);
        let slots: Vec<Option<usize>> = (0..n)
            .map(|i| active.as_ref().is_none_or(|active: &Vec<i32>| active[i] != 0).then(|| contact(i)))
            .collect();
        let null_contacts = choice == 0xff && n_contacts > 0;
        let faults = slots.iter().flatten().fold(Faults::default(), |faults, &slot| match slot {
            0..CONTACTS if slot < n_contacts => faults.and(self.contact_status[slot].faults(Error::BadContact)),
            _ => faults.when(true, Error::BadIndex),
        });
        tell!("  {n} items, index {index:?}, active {active:?}, {n_contacts} contacts, {:?}", self.contact_status);
        Items {
            n,
            n_contacts,
            contacts: if null_contacts { null() } else { self.contacts.pointer().cast() },
            index,
            active,
            slots,
            faults: faults.when(null_contacts, Error::NullPointer),
        }
    }

    /// The contact of a slot, with what its results are compared with.
    fn item(&self, slot: usize) -> Chosen {
        let contact = &self.contacts.values()[slot * SIZE..][..SIZE];
        Chosen {
            pointer: contact.as_ptr().cast(),
            faults: Faults::default(),
            half_width: contact[1],
            slip_force: contact[2],
            slip_displacement: contact[3],
            initial_stiffness: contact[4],
            slip_energy: contact[5],
        }
    }

    /// Compares outputs of a batch with those of each item: `each` values an item.
    fn check_items<const K: usize>(
        &self,
        items: &Items,
        given: &[Output; K],
        each: [usize; K],
        mut one: impl FnMut(usize, &Chosen, [*mut f64; K]) -> i32,
    ) {
        for (i, slot) in items.slots.iter().enumerate() {
            let mut k = 0;
            let parts = given.each_ref().map(|output| {
                k += 1;
                output.values().get(i * each[k - 1]..(i + 1) * each[k - 1]).unwrap_or(&[])
            });
            let Some(slot) = *slot else {
                let untouched = parts.iter().all(|part| all(part, |value| value.to_bits() == UNTOUCHED.to_bits()));
                assert!(untouched, "an item that is skipped was written to");
                continue;
            };
            let mut alone = each.map(|length| Output::new(true, length));
            let answer = one(i, &self.item(slot), alone.each_mut().map(Output::pointer));
            assert!(answer == 0, "alone item {i} is rejected by {answer}");
            for (part, alone) in parts.iter().zip(&alone) {
                assert!(
                    part.is_empty() || same(part, alone.values()),
                    "item {i}: {part:?}, alone {:?}",
                    alone.values()
                );
            }
        }
    }

    /// As [`run`], for outputs of which items may be skipped.
    fn run_items<const K: usize>(
        &mut self,
        name: &str,
        faults: Faults,
        lengths: [usize; K],
        function: impl FnOnce([*mut f64; K]) -> i32,
    ) -> Option<[Output; K]> {
        let choice = self.source.byte();
        let mut k = 0;
        let mut outputs = lengths.map(|length| {
            k += 1;
            Output::new(choice >> (k - 1) & 1 == 0, length)
        });
        let answer = status(name, !faults.is_arbitrary(), || function(outputs.each_mut().map(Output::pointer)));
        faults.explain(name, answer);
        if answer != 0 {
            assert!(outputs.iter().all(Output::is_untouched), "{name} is rejected and has written");
            return None;
        }
        Some(outputs).filter(|_| !faults.is_arbitrary())
    }

    fn batch_complex_stiffness(&mut self) {
        let items = self.items();
        let n = items.n;
        let amplitude = self.coefficients(n, 1e-6);
        let faults = items
            .active()
            .fold(items.faults, |faults, i| faults.and(World::faults_of_amplitude(amplitude.values()[i])));
        let (contacts, index, active) = (items.contacts, pointer(&items.index), pointer(&items.active));
        let name = "mslip_batch_complex_stiffness";
        let given = self.run_items(name, faults, [n; 4], |[a, b, da, db]| unsafe {
            let amplitude = amplitude.pointer();
            mslip_batch_complex_stiffness(n, items.n_contacts, contacts, index, active, amplitude, a, b, da, db)
        });
        if let Some(given) = given {
            self.check_items(&items, &given, [1; 4], |i, c, [a, b, da, db]| {
                call(true, || unsafe { mslip_complex_stiffness(c.pointer, 1, &amplitude.values()[i], a, b, da, db) })
            });
        }
    }

    fn batch_masing_update(&mut self) {
        let items = self.items();
        let n = items.n;
        let (_, one, state_faults) = self.state();
        let length = one.values().len();
        let states = Array::of((0..n * length).map(|i| one.values()[i % length]));
        let displacement = self.coefficients(n, 1e-6);
        let far = items.active().any(|i| !is_near(displacement.values()[i]));
        let faults = items
            .faults
            .and(if items.active().next().is_some() { state_faults } else { Faults::default() })
            .when(n > 0 && length < mslip_state_length(0), Error::StateTooShort)
            .when(far, Error::BadDisplacement);
        let in_place = self.source.below(2) == 0;
        let (mut from, mut to) = (states.copy(), Array::new(n * length, UNTOUCHED));
        let (contacts, index, active) = (items.contacts, pointer(&items.index), pointer(&items.active));
        let name = "mslip_batch_masing_update";
        let given = self.run_items(name, faults, [n; 3], |[force, stiffness, dissipated]| unsafe {
            let states_old = from.pointer_mut();
            let states_new = if in_place { states_old } else { to.pointer_mut() };
            mslip_batch_masing_update(
                n,
                items.n_contacts,
                contacts,
                index,
                active,
                length,
                states_old,
                displacement.pointer(),
                states_new,
                force,
                stiffness,
                dissipated,
            )
        });
        let may_write = in_place && (given.is_some() || faults.is_arbitrary());
        assert!(may_write || from.is(&states), "{name} has modified states that it may only read");
        if let Some(given) = given {
            let written = if in_place { &from } else { &to };
            self.check_items(&items, &given, [1; 3], |i, c, [force, stiffness, dissipated]| {
                let (mut alone, displacement) = (Array::new(length, UNTOUCHED), displacement.values()[i]);
                let (old, new) = (one.pointer(), alone.pointer_mut());
                let answer = call(true, || unsafe {
                    mslip_masing_update(c.pointer, length, old, displacement, new, force, stiffness, dissipated)
                });
                assert!(
                    same(alone.values(), &written.values()[i * length..][..length]),
                    "item {i} has another state alone"
                );
                answer
            });
        }
    }

    fn batch_harmonic_force(&mut self) {
        let items = self.items();
        let n = items.n;
        let (workspace, one, workspace_faults) = self.workspace();
        let displacement = self.coefficients(n * one, 1e-6);
        let far = items.active().any(|i| !all(&displacement.values()[i * one..][..one], is_near));
        let faults = items.faults.and(workspace_faults).when(far, Error::BadDisplacement);
        let lengths = [n * one, n * one * one, n];
        let (contacts, index, active) = (items.contacts, pointer(&items.index), pointer(&items.active));
        let name = "mslip_batch_harmonic_force";
        let given = self.run_items(name, faults, lengths, |[force, jacobian, dissipated]| unsafe {
            let u = displacement.pointer();
            let n_contacts = items.n_contacts;
            mslip_batch_harmonic_force(
                n, n_contacts, contacts, index, active, workspace, u, force, jacobian, dissipated,
            )
        });
        if let Some(given) = given {
            self.check_items(&items, &given, [one, one * one, 1], |i, c, [force, jacobian, dissipated]| {
                let u = displacement.values()[i * one..][..one].as_ptr();
                call(true, || unsafe { mslip_harmonic_force(c.pointer, workspace, u, force, jacobian, dissipated) })
            });
        }
    }

    /// Functions that cannot fail.
    fn others(&mut self) {
        let [one, two] = [(); 2].map(|()| self.source.number(1.0).to_bits());
        let [harmonics, samples] = [one, two].map(|bits| bits as usize >> (bits % 64));
        let byte = self.source.byte();
        assert!(call(true, || mslip_abi_version()) == MSLIP_ABI_VERSION);
        call(true, || mslip_state_length(harmonics));
        let length = call(true, || mslip_harmonic_workspace_length(harmonics, samples, (byte % 4) as i32 - 1));
        assert!(length == 0 || (harmonics > 0 && samples / 2 >= harmonics));
        let text = call(true, || mslip_status_text(two as i32));
        assert!(unsafe { *text } != 0);
        let mut p = Parameters::default();
        call(true, || unsafe { mslip_parameters_default(if byte < 128 { &mut p } else { null_mut() }) });
        assert!(p.flat_half_width.is_nan());
        let mut p = EllipticParameters::default();
        call(true, || unsafe { mslip_elliptic_parameters_default(if byte < 128 { &mut p } else { null_mut() }) });
        assert!(p.semi_axis_x.is_nan());
    }
}
