//! Every value of every argument: non-finite, beyond its limit, and extreme but valid ones.

use super::*;
use std::iter::once;

/// NaN, quiet and signalling, of either sign, and infinities.
pub const NON_FINITE: [u64; 6] = [
    0x7ff8_0000_0000_0000,
    0xfff8_0000_0000_0000,
    0x7ff0_0000_0000_0001,
    0xfff4_0000_0000_0000,
    0x7ff0_0000_0000_0000,
    0xfff0_0000_0000_0000,
];
const BEYOND: f64 = 1.000_000_1e150;
const LEAST: f64 = 5e-324;

/// Invalid values of a quantity with their status; forces as multiples of mu N.
#[rustfmt::skip]
const INVALID: [(&str, i32, &[f64]); 17] = [
    ("force", MSLIP_FORCE_EXCEEDS_SLIP, &[1.001, -1.001, 1.0 + 1e-12, 1e300, -1e300]),
    ("force_amplitude", MSLIP_FORCE_EXCEEDS_SLIP, &[1.001, 1e300]),
    ("force_amplitude", MSLIP_BAD_FORCE_AMPLITUDE, &[-1.0, -1e-320, -1e300]),
    ("displacement", MSLIP_BAD_DISPLACEMENT, &[BEYOND, -BEYOND, f64::MAX, f64::MIN]),
    ("amplitude", MSLIP_BAD_AMPLITUDE, &[BEYOND, f64::MAX, -1.0, -LEAST, f64::MIN]),
    ("approach", MSLIP_BAD_DISPLACEMENT, &[BEYOND, -BEYOND, f64::MAX, f64::MIN]),
    ("normal_force", MSLIP_BAD_NORMAL_FORCE, &[BEYOND, f64::MAX, -1.0, -LEAST, f64::MIN]),
    ("coefficient of approach", MSLIP_BAD_DISPLACEMENT, &[BEYOND, f64::MIN]),
    ("coefficient of force", MSLIP_BAD_DISPLACEMENT, &[BEYOND, f64::MIN]),
    // Of a contact with a length.
    ("approach", MSLIP_LENGTH_TOO_SHORT, &[1.0, 1e150]),
    ("normal_force", MSLIP_LENGTH_TOO_SHORT, &[1e12, 1e150]),
    ("coefficient of approach", MSLIP_LENGTH_TOO_SHORT, &[1.0, 1e149]),
    ("area", MSLIP_BAD_AREA, &[-1.0, -LEAST, 1.000_000_1e50, f64::MAX]),
    ("pressure", MSLIP_BAD_PRESSURE, &[-1.0, -LEAST, 1.000_000_1e50, f64::MAX]),
    ("x", MSLIP_BAD_POSITION, &[]),
    ("force", MSLIP_BAD_FORCE, &[]),
    ("displacement", MSLIP_BAD_DISPLACEMENT, &[1e160]),
];

#[rustfmt::skip]
const VALID: [(&str, &[f64]); 9] = [
    ("area", &[1e-50, 1e-20, 1e50]),
    ("pressure", &[0.0, -0.0, LEAST, 1e-300, 1.0, 1e50]),
    ("x", &[0.0, -0.0, LEAST, -1e-300, 1e300, f64::MIN]),
    ("force", &[0.0, -0.0, 1e-320, -1e-300, 1.0, -1.0]),
    ("force_amplitude", &[0.0, -0.0, 1e-320, 1e-300, 1.0]),
    ("displacement", &[0.0, -0.0, LEAST, -1e-300, 1e-150, 1.0, 1e150, -1e150]),
    ("amplitude", &[0.0, -0.0, LEAST, 1e-300, 1e-150, 1.0, 1e150]),
    ("approach", &[0.0, -0.0, LEAST, 1e-300, 1e-150, 1e-20, 1e-5, -1e-300, -1.0, -1e150]),
    ("normal_force", &[0.0, -0.0, LEAST, 1e-300, 1e-150, 1e-12, 1e4]),
];

fn quantity(call: &Call, law: &Law, argument: &calls::Argument, i: usize) -> &'static str {
    match (law.is_normal(call, argument, i), call.has(Workspace), law.normal_input == MSLIP_INPUT_NORMAL_FORCE) {
        (false, ..) => argument.name,
        (true, false, false) => "approach",
        (true, false, true) => "normal_force",
        (true, true, false) => "coefficient of approach",
        (true, true, true) => "coefficient of force",
    }
}

fn scale(law: &Law, quantity: &str) -> f64 {
    if quantity.starts_with("force") { law.force } else { 1.0 }
}

/// Accepted; inputs are unchanged and outputs finite.
pub fn accepted(call: &Call, arguments: &Arguments, what: &str) {
    let inputs = |arguments: &Arguments| {
        let read = (0..call.arguments.len())
            .filter(|place| !call.arguments[*place].kind.is_written() && call.arguments[*place].kind != Workspace);
        read.filter_map(|place| arguments.memory[place].as_ref().map(|memory| memory.values::<u8>().to_vec()))
            .collect::<Vec<_>>()
    };
    let before = inputs(arguments);
    places(call, Output).for_each(|place| arguments.memory(place).fill(0xff));
    assert_eq!(call.make(&arguments.slots), MSLIP_OK, "{}: {what}", call.name);
    for place in places(call, Output).filter(|place| !is_null(arguments.slots[*place])) {
        let values = arguments.memory(place).values::<f64>();
        // The compliance of an ellipse is infinite without load, and at the onset of gross slip.
        let most = if call.arguments[place].name == "compliance" { f64::INFINITY } else { f64::MAX };
        assert!(values.iter().all(|value| value.abs() <= most), "{}: {what}: {values:?}", call.name);
    }
    assert!(inputs(arguments) == before, "{}: {what}: an input is modified", call.name);
}

/// The laws for which a call is available and has values other than 0.
fn for_each_law(test: impl Fn(&'static Call, &Law)) {
    for call in CALLS {
        let laws = Law::all(call).into_iter().filter(|law| is_available(call, law) && law.force > 0.0);
        laws.for_each(|law| test(call, &law));
    }
}

#[test]
fn values() {
    for_each_law(|call, law| {
        let mut arguments = Arguments::new(call, law);
        for (place, argument) in call.arguments.iter().enumerate() {
            let count = match argument.kind {
                Value => 1,
                Input => law.length(argument.extents, call.has(Element)),
                _ => 0,
            };
            for i in 0..count {
                let quantity = quantity(call, law, argument, i);
                let status = if quantity == "normal_force" { MSLIP_BAD_NORMAL_FORCE } else { argument.status };
                let invalid = INVALID.iter().filter(|(name, status, _)| {
                    *name == quantity && !(*status == MSLIP_LENGTH_TOO_SHORT && law.is_elliptic)
                });
                let invalid = invalid.flat_map(|(_, status, values)| {
                    values.iter().map(|value| ((value * scale(law, quantity)).to_bits(), *status))
                });
                let non_finite = NON_FINITE.map(|bits| (bits, status));
                for (bits, status) in non_finite.into_iter().chain(invalid) {
                    let valid = arguments.exchange(place, i, f64::from_bits(bits));
                    rejected_as(call, &arguments, status, &format!("{quantity} {i}: {}", f64::from_bits(bits)));
                    arguments.exchange(place, i, valid);
                }
                let valid = VALID.iter().filter(|(name, _)| *name == quantity).flat_map(|(_, values)| *values);
                for value in valid {
                    let before = arguments.exchange(place, i, value * scale(law, quantity));
                    accepted(call, &arguments, quantity);
                    arguments.exchange(place, i, before);
                }
            }
        }
    });
}

/// The curve of an element, which is not in the table: its two inputs depend on each other.
#[test]
fn forces_and_normal_forces() {
    let curve = Call {
        name: "mslip_element_displacement",
        flat: false,
        one_direction: false,
        function: |a| unsafe {
            mslip_element_displacement(a[0].get(), a[1].get(), 1, a[2].get(), a[3].get(), a[4].get(), a[5].get())
        },
        arguments: &[],
    };
    for law in calls::elements() {
        let (element, most, load) = (Memory::of_law(law, 1), law.force, law.normal_force);
        for (direction, force, normal_force, status) in [
            (law.directions - 1, most, load, MSLIP_OK),
            (law.directions, most, load, MSLIP_BAD_DIRECTIONS),
            (-1, most, load, MSLIP_BAD_DIRECTIONS),
            (0, f64::NAN, load, MSLIP_BAD_FORCE),
            (0, -1.001 * most, load, MSLIP_FORCE_EXCEEDS_SLIP),
            (0, most, 0.999 * load, MSLIP_FORCE_EXCEEDS_SLIP),
            (0, 0.0, f64::NAN, MSLIP_BAD_NORMAL_FORCE),
            (0, 0.0, -1.0, MSLIP_BAD_NORMAL_FORCE),
        ] {
            let values = [force, normal_force, f64::NAN, f64::NAN].map(|value| Memory::of(&[value]));
            let [force, normal_force, displacement, compliance] =
                values.each_ref().map(|memory| Slot::Pointer(memory.start));
            let element = Slot::Pointer(element.start);
            let mut slots = [element, Slot::Choice(direction), force, normal_force, displacement, compliance];
            assert_eq!(curve.make(&slots), status, "{slots:?}");
            let is_written = |memory: &Memory| !memory.values::<f64>()[0].is_nan();
            assert!(values[2..].iter().all(|memory| is_written(memory) == (status == MSLIP_OK)), "{slots:?}");
            for required in [0, 2, 3] {
                let valid = std::mem::replace(&mut slots[required], Slot::Pointer(null_mut()));
                assert_eq!(curve.make(&slots), MSLIP_NULL_POINTER, "{slots:?}");
                slots[required] = valid;
            }
        }
    }
}

/// Harmonics, samples and periods; directions, normal inputs and rules. What follows an invalid choice is not read.
#[test]
fn sizes_and_choices() {
    const MOST: usize = 1 << 24;
    const SIZES: [(usize, usize, i32); 12] = [
        (0, 16, MSLIP_BAD_HARMONICS),
        (0, 0, MSLIP_BAD_HARMONICS),
        (MOST + 1, usize::MAX, MSLIP_BAD_HARMONICS),
        (usize::MAX, usize::MAX, MSLIP_BAD_HARMONICS),
        (usize::MAX / 2 + 1, 1, MSLIP_BAD_HARMONICS),
        (2, 0, MSLIP_BAD_SAMPLES),
        (2, 4, MSLIP_BAD_SAMPLES),
        (MOST, MOST, MSLIP_BAD_SAMPLES),
        (2, MOST + 1, MSLIP_BAD_SAMPLES),
        (2, usize::MAX, MSLIP_BAD_SAMPLES),
        (2, usize::MAX / 2 + 1, MSLIP_BAD_SAMPLES),
        (MOST / 2 - 1, MOST, MSLIP_WORKSPACE_TOO_SHORT),
    ];
    for_each_call(|call, _, mut arguments| {
        let place = |name: &str| call.arguments.iter().position(|argument| argument.name == name);
        let of_element = call.is_of_element();
        let length = |arguments: &Arguments| {
            let slot = |name: &str| arguments.slots[place(name).expect("an argument")];
            let (harmonics, samples, rule) = (slot("harmonics").get(), slot("samples").get(), slot("rule").get());
            if of_element {
                mslip_element_workspace_length(slot("directions").get(), harmonics, samples, rule)
            } else {
                mslip_harmonic_workspace_length(harmonics, samples, rule)
            }
        };
        if let (true, Some(harmonics), Some(samples)) = (call.has(Size), place("harmonics"), place("samples")) {
            for (h, s, status) in SIZES {
                let valid = [arguments.slots[harmonics], arguments.slots[samples]];
                [arguments.slots[harmonics], arguments.slots[samples]] = [Slot::Size(h), Slot::Size(s)];
                assert_eq!(length(&arguments) > 0, status == MSLIP_WORKSPACE_TOO_SHORT);
                rejected_as(call, &arguments, status, "sizes");
                [arguments.slots[harmonics], arguments.slots[samples]] = valid;
            }
        }
        for (i, argument) in call.arguments.iter().enumerate() {
            let codes: &[i32] = match (argument.kind, argument.name) {
                (Size, "periods") => {
                    for periods in [65537, usize::MAX / 2 + 1, usize::MAX] {
                        rejected(call, &mut arguments, i, Slot::Size(periods), argument.status);
                    }
                    continue;
                }
                (Choice, "directions") => &[0, 3, -1, i32::MAX, i32::MIN],
                (Choice, "normal_input") => &[0, 1, -1, i32::MAX, i32::MIN],
                (Choice, _) => &[2, 7, -1, i32::MAX, i32::MIN],
                _ => continue,
            };
            for code in codes {
                rejected(call, &mut arguments, i, Slot::Choice(*code), argument.status);
                let valid = arguments.slots.clone();
                arguments.slots[i] = Slot::Choice(*code);
                let later = (i + 1..call.arguments.len()).filter(|later| call.arguments[*later].kind == Size);
                later.for_each(|later| arguments.slots[later] = Slot::Size(0));
                assert!(!call.has(Size) || length(&arguments) == 0);
                rejected_as(call, &arguments, argument.status, "not read");
                arguments.slots = valid;
            }
            if of_element && argument.name == "rule" {
                rejected(call, &mut arguments, i, Slot::Choice(MSLIP_EVENT_DRIVEN), MSLIP_NOT_AVAILABLE);
            }
        }
    });
    assert_eq!([usize::MAX, usize::MAX / 2].map(|n| mslip_state_length(n)), [usize::MAX; 2]);
    assert_eq!(mslip_state_length(0), mslip_state_length(2));
    assert_eq!([usize::MAX, usize::MAX / 4].map(|n| mslip_element_state_length(1, n)), [usize::MAX; 2]);
    assert_eq!(mslip_element_state_length(1, 0), mslip_element_state_length(1, 4));
    assert_eq!(mslip_element_state_length(2, 0), mslip_element_state_length(2, usize::MAX));
    assert!([0, 3, -1, i32::MAX, i32::MIN].iter().all(|directions| mslip_element_state_length(*directions, 4) == 0));
    for n in [0, 65537, 1_000_000, usize::MAX / 16] {
        let (call, law) = (call("mslip_iwan_equivalent"), &calls::contacts()[0]);
        let mut arguments = Arguments::new(call, law);
        rejected(call, &mut arguments, 1, Slot::Size(n), MSLIP_BAD_COUNT);
    }
}

/// The parameters of a shape as doubles: the status of an invalid one, whether 0 is valid, and the largest valid value.
type Field = (i32, bool, f64);
const LOAD_AND_MATERIAL: [Field; 6] = [
    (MSLIP_BAD_NORMAL_FORCE, true, f64::MAX),
    (MSLIP_BAD_FRICTION_COEFFICIENT, true, f64::MAX),
    (MSLIP_BAD_YOUNG_MODULUS, false, f64::MAX),
    (MSLIP_BAD_POISSON_RATIO, true, 0.5),
    (MSLIP_BAD_YOUNG_MODULUS, false, f64::MAX),
    (MSLIP_BAD_POISSON_RATIO, true, 0.5),
];
const FLAT_GEOMETRY: [Field; 3] = [
    (MSLIP_BAD_FLAT_HALF_WIDTH, true, f64::MAX),
    (MSLIP_BAD_EDGE_RADIUS, false, f64::MAX),
    (MSLIP_BAD_LENGTH, false, f64::MAX),
];
const AXES: [Field; 2] = [(MSLIP_BAD_SEMI_AXIS_X, false, f64::MAX), (MSLIP_BAD_SEMI_AXIS_Y, false, f64::MAX)];

/// The four functions that initialise a contact or an element, with the fields of their parameters; elements with all directions
/// and normal inputs.
fn for_each_shape(test: impl Fn(&Call, &Law, &[Field])) {
    for call in CALLS.iter().filter(|call| call.has(NewContact) || call.has(NewElement)) {
        let geometry = if call.has(Parameters) { &FLAT_GEOMETRY[..] } else { &AXES };
        let mut fields = [geometry, &LOAD_AND_MATERIAL].concat();
        // An element has no tables for a normal force of 0.
        fields[geometry.len()].1 = call.has(NewContact);
        let laws = if call.has(NewContact) { &calls::contacts()[..1] } else { calls::elements() };
        laws.iter().for_each(|law| test(call, law, &fields));
    }
}

/// Either all quantities of friction vanish, or none.
fn is_possible_contact(c: &mslip_contact) -> bool {
    let friction = [c.slip_force, c.slip_displacement, c.initial_stiffness, c.slip_energy];
    let all = [c.composite_modulus, c.half_width].into_iter().chain(friction);
    c.composite_modulus > 0.0
        && all.into_iter().all(|value| value.is_finite() && value >= 0.0)
        && friction.iter().all(|value| (*value > 0.0) == (c.slip_force > 0.0))
}

/// Finite and positive but for the friction coefficient.
fn is_possible_element(e: &mslip_element) -> bool {
    let positive =
        [e.composite_modulus, e.normal_force, e.half_width, e.approach, e.normal_stiffness, e.tangential_stiffness];
    let mu = e.friction_coefficient;
    positive.iter().all(|value| value.is_finite() && *value > 0.0) && mu.is_finite() && mu >= 0.0
}

/// An extreme valid value: a possible contact or element, or a status of the combination.
fn extreme(call: &Call, arguments: &Arguments, what: &str) {
    let status = call.make(&arguments.slots);
    if status == MSLIP_OK {
        let holds = if call.has(NewContact) {
            is_possible_contact(&arguments.memory(1).values()[0])
        } else {
            is_possible_element(&arguments.memory(3).values()[0])
        };
        let p = arguments.memory(0).values::<f64>();
        assert!(holds, "{}: {what}: {p:?}", call.name);
    } else {
        let of_layer =
            what == "layer" && matches!(status, MSLIP_BAD_NORMAL_COMPLIANCE | MSLIP_BAD_TANGENTIAL_COMPLIANCE);
        let too_short = status == MSLIP_LENGTH_TOO_SHORT && call.has(Parameters);
        assert!(status == MSLIP_OUT_OF_RANGE || of_layer || too_short, "{}: {what}: status {status}", call.name);
        let written = arguments.memory(call.arguments.len() - 1);
        written.fill(FILLED);
        rejected_as(call, arguments, status, what);
    }
}

#[test]
fn parameters() {
    const EXTREMES: [f64; 11] = [LEAST, 1e-310, 1e-300, 1e-200, 1e-160, 1e-100, 1e100, 1e160, 1e200, 1e300, f64::MAX];
    for_each_shape(|call, law, fields| {
        let mut arguments = Arguments::new(call, law);
        for (i, (status, zero_is_valid, largest)) in fields.iter().enumerate() {
            let non_finite = NON_FINITE.map(f64::from_bits).into_iter();
            let zero = [0.0, -0.0].into_iter().filter(|_| !zero_is_valid);
            let large = [largest * (1.0 + f64::EPSILON), f64::MAX].into_iter().filter(|value| value > largest);
            for value in non_finite.chain([-1.0, -LEAST, f64::MIN]).chain(zero).chain(large.filter(|v| v.is_finite())) {
                let valid = arguments.exchange(0, i, value);
                rejected_as(call, &arguments, *status, &format!("parameter {i}: {value}"));
                arguments.exchange(0, i, valid);
            }
            let zero = [0.0, -0.0].into_iter().filter(|_| *zero_is_valid);
            let valid = |value: &f64| value <= largest;
            let largest = once(*largest).filter(|value| *value < f64::MAX);
            for value in EXTREMES.into_iter().filter(valid).chain(zero).chain(largest) {
                let before = arguments.exchange(0, i, value);
                extreme(call, &arguments, "one value");
                assert!(value != 0.0 || call.make(&arguments.slots) == MSLIP_OK);
                arguments.exchange(0, i, before);
            }
        }
        // The first invalid value decides the status.
        for i in (0..fields.len()).rev() {
            arguments.exchange(0, i, f64::NAN);
            rejected_as(call, &arguments, fields[i].0, "unset");
        }
    });
}

/// Values that are valid one by one but not together; and references of the displacement.
#[test]
fn combinations() {
    for_each_shape(|call, law, fields| {
        if law.normal_input == MSLIP_INPUT_NORMAL_FORCE && call.has(NewElement) {
            return;
        }
        let mut arguments = Arguments::new(call, law);
        let words = arguments.memory(0).bytes / 4;
        let mut code = |place: usize, code: i32, status: i32| {
            let valid = std::mem::replace(&mut arguments.memory_mut(0).values_mut::<i32>()[place], code);
            rejected_as(call, &arguments, status, "a code");
            arguments.memory_mut(0).values_mut::<i32>()[place] = valid;
        };
        if call.has(Parameters) {
            for reference in [-1, 2, 255, i32::MAX, i32::MIN] {
                code(words - 2, reference, MSLIP_BAD_DISPLACEMENT_REFERENCE);
            }
            for (field, value, reference, status) in [
                (2, 0.49 * calls::contact(&FLAT).half_width, MSLIP_CENTRE_POINT, MSLIP_LENGTH_TOO_SHORT),
                (2, 0.49 * calls::contact(&FLAT).half_width, MSLIP_RIGID_STRIP, MSLIP_LENGTH_TOO_SHORT),
                (0, 2.1 * FLAT.length, MSLIP_CENTRE_POINT, MSLIP_LENGTH_TOO_SHORT),
                (1, 1e6, MSLIP_CENTRE_POINT, MSLIP_LENGTH_TOO_SHORT),
                (1, 1e300, MSLIP_CENTRE_POINT, MSLIP_OUT_OF_RANGE),
                (2, 1e-300, MSLIP_CENTRE_POINT, MSLIP_OUT_OF_RANGE),
                (0, 1e200, MSLIP_CENTRE_POINT, MSLIP_OUT_OF_RANGE),
                // The energy of a cycle, which elements do not have, would not be a normal number.
                (3, 1e-115, MSLIP_CENTRE_POINT, MSLIP_OUT_OF_RANGE),
            ] {
                if field == 3 && call.name != "mslip_contact_init" {
                    continue;
                }
                let valid = arguments.exchange(0, field, value);
                arguments.memory_mut(0).values_mut::<i32>()[words - 2] = reference;
                rejected_as(call, &arguments, status, "a combination");
                arguments.exchange(0, field, valid);
            }
        }
        layers(call, &mut arguments, fields.len());
    });
}

/// The four fields of a layer, behind the materials.
fn layers(call: &Call, arguments: &mut Arguments, first: usize) {
    const EXTREMES: [f64; 9] = [0.0, LEAST, 1e-300, 1e-160, 1e-12, 1e-8, 1.0, 1e160, f64::MAX];
    let load = arguments.memory(0).values::<f64>()[first - 6];
    let [by_normal, by_tangential] = [MSLIP_BAD_NORMAL_COMPLIANCE, MSLIP_BAD_TANGENTIAL_COMPLIANCE];
    for (field, status, values) in [
        (0, by_normal, [-1e-9, f64::INFINITY, f64::NAN, 1e-160, 1e160]),
        (1, by_tangential, [-LEAST, f64::INFINITY, f64::NAN, 1e-160, 1e60]),
        (2, MSLIP_BAD_STIFFENING_LOAD, [-1.0, f64::NAN, 0.999e-3 * load, f64::MIN_POSITIVE, f64::NEG_INFINITY]),
        (3, MSLIP_BAD_REFERENCE_LOAD, [-LEAST, f64::NAN, 2e150, f64::INFINITY, -1.0]),
    ] {
        for value in values {
            let valid = arguments.exchange(0, first + field, value);
            rejected_as(call, arguments, status, &format!("layer: field {field}: {value}"));
            arguments.exchange(0, first + field, valid);
        }
    }
    for (i, reference) in (0..EXTREMES.len() * EXTREMES.len() * 3).zip(EXTREMES[..7].iter().cycle()) {
        let compliance = [EXTREMES[i % 9], EXTREMES[i / 9 % 9]];
        let stiffening = [0.0, 1e-3 * load, 1e300][i / 81];
        let layer = [compliance[0], compliance[1], stiffening, *reference];
        layer.iter().enumerate().for_each(|(k, value)| _ = arguments.exchange(0, first + k, *value));
        extreme(call, arguments, "layer");
    }
    let soft = [1e-9, 1e-9, 0.01 * load, 1e13 * load];
    soft.iter().enumerate().for_each(|(k, value)| _ = arguments.exchange(0, first + k, *value));
    rejected_as(call, arguments, MSLIP_BAD_REFERENCE_LOAD, "a layer of 1e13 times its compliance under the load");
}
