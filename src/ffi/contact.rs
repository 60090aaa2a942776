//! One contact: initialisation, tractions, slip, monotonic curve.

use crate::constant_load::contact::Contact;
use crate::error::{Error, ensure};
use crate::face::divide;
use crate::ffi::mslip_contact;
use crate::ffi::pointers::{self, call, each, input, item, optional_output, output, outputs, set, sum, write};
use crate::limits::{check_displacement, check_positions};
use crate::numerics::slices::PanicFreeSlice;
use crate::parameters::PARAMETERS;
use crate::parameters::{EllipticParameters, Parameters};
use core::ffi::{CStr, c_char};
use core::ptr;
use libc::size_t;

/// Sets all parameters to NaN and the displacement reference to -1, so that an omitted one is rejected by its own status code, and
/// the layer to none. NULL is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_parameters_default(p: *mut Parameters) {
    if !p.is_null() {
        // A misaligned pointer cannot be reported.
        p.write_unaligned(Parameters::default());
    }
}

/// Sets all parameters to NaN. NULL is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_elliptic_parameters_default(p: *mut EllipticParameters) {
    if !p.is_null() {
        // A misaligned pointer cannot be reported.
        p.write_unaligned(EllipticParameters::default());
    }
}

/// Text of a warning, NULL without one. Parameters are unset or invalid, and misaligned: they have no status.
unsafe fn text_of<P: Copy, W: Iterator<Item = &'static CStr>>(
    p: *const P,
    i: i32,
    warnings: fn(&P, Option<f64>) -> W,
) -> *const c_char {
    let Some(i) = usize::try_from(i).ok().filter(|_| !p.is_null()) else { return ptr::null() };
    let parameters = p.read_unaligned();
    warnings(&parameters, None).nth(i).map_or(ptr::null(), CStr::as_ptr)
}

/// Warning i >= 0 of parameters that are valid but implausible: another unit, an exchanged pair, a contact for which the model is
/// inaccurate. A static text, NULL if there are no more: for the host to print. Lengths are in m and moduli in Pa, or in mm and MPa
/// if both moduli are at most 1.3e6. Any value of any parameter is accepted; errors are those of mslip_contact_init.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_parameters_warning(p: *const Parameters, i: i32) -> *const c_char {
    text_of(p, i, Parameters::warnings)
}

/// Warning i >= 0 of the parameters of an elliptical contact, as mslip_parameters_warning.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_elliptic_parameters_warning(p: *const EllipticParameters, i: i32) -> *const c_char {
    text_of(p, i, EllipticParameters::warnings)
}

/// Initialises a contact with a constructor.
unsafe fn initialise<P>(
    parameters: *const P,
    contact: *mut mslip_contact,
    construct: impl FnOnce(&P) -> Result<Contact, Error>,
) -> i32 {
    call(|| {
        let (parameters, contact) = (item(parameters)?, optional_output(contact.cast())?.ok_or(Error::NullPointer)?);
        *contact = construct(parameters)?;
        contact.checksum = sum(contact).wrapping_neg();
        Ok(())
    })
}

/// Initialises the contact of a flat with rounded edges, or of a cylinder (Eq. 1, 2, 10).
///
/// Returns MSLIP_NULL_POINTER, the code of the first invalid parameter, MSLIP_LENGTH_TOO_SHORT or
/// MSLIP_OUT_OF_RANGE; the contact is unchanged then.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_contact_init(p: *const Parameters, contact: *mut mslip_contact) -> i32 {
    initialise(p, contact, Contact::rounded_flat)
}

/// Initialises an elliptical Hertz contact (section 3.3); a sphere if both semi-axes are equal.
///
/// Returns MSLIP_NULL_POINTER, the code of the first invalid parameter, or MSLIP_OUT_OF_RANGE; the contact is
/// unchanged then.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_contact_init_elliptic(p: *const EllipticParameters, contact: *mut mslip_contact) -> i32 {
    initialise(p, contact, Contact::elliptic)
}

/// Divides a face with an uneven pressure along its length into n parts, each with a normal force of its own: parts\[n\] are the
/// parameters of their contacts or elements, whose forces add up to that of the face. A part is a row of pairs of opposite nodes in
/// the direction of motion: area \[m2\] and pressure \[Pa\], pairs x n, part after part; an area of 0 fills up a shorter row.
/// weight, pairs x n, is the share of a pair in its part: the displacements of the part are the sums of those of its pairs times
/// their weights, and a pair carries its weight times the forces of the part.
///
/// p are the parameters of the whole face. Their normal_force is not read: it is the sum of pressures times areas, also for a layer
/// whose reference_load is 0. A part whose normal force is below 1e-50 is open: its normal_force is 0, its weights are in
/// proportion to the areas, and it does not count in the length. An element requires a normal_force > 0, the largest in its motion:
/// set that of each part before mslip_element_init.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_AREA, MSLIP_BAD_PRESSURE, the code of the first other parameter that is invalid, or
/// MSLIP_OUT_OF_RANGE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_face_parts(
    p: *const Parameters,
    n: size_t,
    pairs: size_t,
    area: *const f64,
    pressure: *const f64,
    parts: *mut Parameters,
    weight: *mut f64,
) -> i32 {
    call(|| {
        let all = n.saturating_mul(pairs);
        let (p, area, pressure) = (item(p)?, input(area, all)?, input(pressure, all)?);
        let (parts, weight) = (output(parts, n)?.unwrap_or_default(), output(weight, all)?.unwrap_or_default());
        if n == 0 { Ok(()) } else { divide(*p, pairs, area, pressure, parts, weight) }
    })
}

/// Validates a contact that was read from a file or a message: its checksum must be that written at initialisation, which detects
/// any single changed bit. Text needs 17 digits; initialise it again instead. Other functions only check a tag.
///
/// Returns MSLIP_NULL_POINTER or MSLIP_BAD_CONTACT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_contact_check(contact: *const mslip_contact) -> i32 {
    call(|| ensure(sum(pointers::contact(contact)?) == 0, Error::BadContact))
}

/// Tractions \[Pa\] at x\[n\] \[m\] along the width, under a monotonically increasing force \[N\] (Eq. 17, 21-24); 0 outside the
/// contact. Elliptical: on the x axis.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE, MSLIP_FORCE_EXCEEDS_SLIP or MSLIP_BAD_POSITION.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_tractions(
    contact: *const mslip_contact,
    force: f64,
    n: size_t,
    x: *const f64,
    pressure: *mut f64,
    shear: *mut f64,
) -> i32 {
    call(|| {
        let (contact, x, outputs) = (pointers::contact(contact)?, input(x, n)?, outputs([pressure, shear], n)?);
        let point = contact.curve_at_force(force)?;
        check_positions(x)?;
        for (&x, [pressure, shear]) in each(x, outputs) {
            set(pressure, || contact.pressure(x));
            set(shear, || point.shear(x));
        }
        Ok(())
    })
}

/// Relative slip \[m\] (Eq. 15) and frictional damage parameter mu p |s| \[N/m\] (section 3.5) at x\[n\] \[m\], under a
/// monotonically increased force \[N\]; 0 in the stick zone and outside the contact.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE, MSLIP_FORCE_EXCEEDS_SLIP, MSLIP_BAD_POSITION, or
/// MSLIP_NOT_AVAILABLE for an elliptical contact.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_slip(
    contact: *const mslip_contact,
    force: f64,
    n: size_t,
    x: *const f64,
    slip: *mut f64,
    damage: *mut f64,
) -> i32 {
    call(|| {
        let (contact, x, outputs) = (pointers::contact(contact)?, input(x, n)?, outputs([slip, damage], n)?);
        let point = contact.curve_at_force(force)?;
        check_positions(x)?;
        point.slip(0.0)?;
        for (&x, [slip, damage]) in each(x, outputs) {
            let local_slip = point.slip(x)?;
            set(slip, || local_slip);
            set(damage, || point.damage_of(x, local_slip));
        }
        Ok(())
    })
}

/// Monotonic (initial loading) curve (Eq. 10), odd in the force: displacement \[m\], compliance \[m/N\] and stick half-width \[m\]
/// at force\[n\] \[N\]. At mu N the compliance is infinite for a cylinder and an elliptical contact, and the stick half-width is
/// that of the flat, a.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE or MSLIP_FORCE_EXCEEDS_SLIP.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_monotonic_displacement(
    contact: *const mslip_contact,
    n: size_t,
    force: *const f64,
    displacement: *mut f64,
    compliance: *mut f64,
    stick_half_width: *mut f64,
) -> i32 {
    call(|| {
        let (contact, force, outputs) =
            (pointers::contact(contact)?, input(force, n)?, outputs([displacement, compliance, stick_half_width], n)?);
        force.iter().try_for_each(|&force| contact.check_force(force))?;
        for (&force, [displacement, compliance, stick_half_width]) in each(force, outputs) {
            let point = contact.curve_at_force(force)?;
            set(displacement, || point.displacement());
            set(compliance, || point.compliance());
            set(stick_half_width, || point.stick_half_width());
        }
        Ok(())
    })
}

/// Inverse of the monotonic curve, odd in the displacement: force \[N\], stiffness \[N/m\] and stick half-width \[m\] at
/// displacement\[n\] \[m\]. At slip_displacement the stick half-width is a, as at mu N; beyond, the force stays at mu N, and
/// stiffness and stick half-width are 0.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT or MSLIP_BAD_DISPLACEMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_monotonic_force(
    contact: *const mslip_contact,
    n: size_t,
    displacement: *const f64,
    force: *mut f64,
    stiffness: *mut f64,
    stick_half_width: *mut f64,
) -> i32 {
    call(|| {
        let (contact, displacement, outputs) =
            (pointers::contact(contact)?, input(displacement, n)?, outputs([force, stiffness, stick_half_width], n)?);
        displacement.iter().try_for_each(|&displacement| check_displacement(displacement))?;
        for (&displacement, [force, stiffness, stick_half_width]) in each(displacement, outputs) {
            let point = contact.curve_at_displacement(displacement)?;
            write([force, stiffness], point.force_and_stiffness().into());
            set(stick_half_width, || point.stick_half_width());
        }
        Ok(())
    })
}

/// Derivatives of the force of the monotonic curve with respect to the parameters at displacement\[n\] \[m\], which stays fixed:
/// force\[n\] \[N\] and sensitivity, MSLIP_PARAMETER_COUNT x n, column-major. The derivatives of force i are sensitivity\[7 i +
/// MSLIP_BY_...\], in \[N\] over the unit of the parameter. Beyond slip_displacement they are those of mu N; so are, one-sided,
/// those of a contact with mu = 0 or N = 0 at any displacement but 0.
///
/// Of an elliptical contact the bodies keep their shapes, so that the ellipse changes with N and E*. The derivative with respect to
/// the edge radius is that for bodies whose radii of curvature change in proportion, with R = 4 E* semi_axis_x^3/(3 N): of a
/// sphere, its radius. Those with respect to a and L are 0. A layer is the same body under any N: its compliance under the
/// reference load, and both its loads, stay fixed. A reference_load of 0 stays at the N of the contact.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_ARRAY_SIZE or MSLIP_BAD_DISPLACEMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_monotonic_sensitivity(
    contact: *const mslip_contact,
    n: size_t,
    displacement: *const f64,
    force: *mut f64,
    sensitivity: *mut f64,
) -> i32 {
    call(|| {
        let sensitivity = output(sensitivity, n.saturating_mul(PARAMETERS))?;
        let (contact, displacement, force) = (pointers::contact(contact)?, input(displacement, n)?, output(force, n)?);
        displacement.iter().try_for_each(|&displacement| check_displacement(displacement))?;
        for (&displacement, [force]) in each(displacement, [force]) {
            let point = contact.curve_at_displacement(displacement)?;
            set(force, || point.force());
        }
        let columns = sensitivity.map(PanicFreeSlice::blocks_mut).into_iter().flatten();
        for (column, &displacement) in columns.zip(displacement) {
            *column = contact.monotonic_sensitivity(displacement)?;
        }
        Ok(())
    })
}
