//! The C interface: a thin shell that turns pointers into slices, asks the modules, and writes what was wanted.
//!
//! The only module with `unsafe`. Every function follows one order: take the inputs, check them all, compute, write. What
//! is refused has written nothing.

#![allow(unsafe_code, non_camel_case_types)]

mod pointer;
mod widest;

mod single;

mod cycle;

mod interface;

pub use cycle::*;
pub use interface::*;
pub use single::*;

use crate::contact::Contact;
use crate::error::Error;
use crate::parameters::{EllipticParameters, Parameters};
use libc::c_char;

/// Raised whenever a name, a meaning or a size of this interface changes.
pub const MSLIP_ABI_VERSION: i32 = 2;

/// Displacement of the centre point under a line of uniform traction: the paper's Eq. 5-10.
pub const MSLIP_CENTRE_POINT: i32 = 0;
/// Displacement of a rigid strip, corrected to three-dimensional contact mechanics.
pub const MSLIP_RIGID_STRIP: i32 = 1;

/// Harmonic force from equidistant samples of a period.
pub const MSLIP_EQUIDISTANT: i32 = 0;
/// Harmonic force from Gauss-Legendre nodes between the instants at which the displacement turns, a loop closes or gross slip
/// starts.
pub const MSLIP_BETWEEN_REVERSALS: i32 = 1;

/// All went well.
pub const MSLIP_OK: i32 = 0;
/// A required pointer is NULL.
pub const MSLIP_NULL_POINTER: i32 = 1;
/// flat_half_width is not a finite number >= 0.
pub const MSLIP_BAD_FLAT_HALF_WIDTH: i32 = 2;
/// edge_radius is not a finite number > 0.
pub const MSLIP_BAD_EDGE_RADIUS: i32 = 3;
/// length is not a finite number > 0.
pub const MSLIP_BAD_LENGTH: i32 = 4;
/// normal_force is not a finite number >= 0.
pub const MSLIP_BAD_NORMAL_FORCE: i32 = 5;
/// friction_coefficient is not a finite number >= 0.
pub const MSLIP_BAD_FRICTION_COEFFICIENT: i32 = 6;
/// A young_modulus is not a finite number > 0.
pub const MSLIP_BAD_YOUNG_MODULUS: i32 = 7;
/// A poisson_ratio is not in 0 <= nu <= 0.5.
pub const MSLIP_BAD_POISSON_RATIO: i32 = 8;
/// displacement_reference is neither MSLIP_CENTRE_POINT nor MSLIP_RIGID_STRIP.
pub const MSLIP_BAD_DISPLACEMENT_REFERENCE: i32 = 9;
/// semi_axis_x is not a finite number > 0.
pub const MSLIP_BAD_SEMI_AXIS_X: i32 = 10;
/// semi_axis_y is not a finite number > 0.
pub const MSLIP_BAD_SEMI_AXIS_Y: i32 = 11;
/// 2 length <= half-width, or the initial stiffness would not be positive.
pub const MSLIP_LENGTH_TOO_SHORT: i32 = 12;
/// Half-width, force, displacement or energy would be beyond about 1e-150 to 1e150.
pub const MSLIP_OUT_OF_RANGE: i32 = 13;
/// The contact was never prepared, belongs to another version, or its memory was changed.
pub const MSLIP_BAD_CONTACT: i32 = 20;
/// The state was never initialised, is cut short, or its memory was changed.
pub const MSLIP_BAD_STATE: i32 = 21;
/// The workspace was never initialised, or its memory was changed.
pub const MSLIP_BAD_WORKSPACE: i32 = 22;
/// state_length is below mslip_state_length(0).
pub const MSLIP_STATE_TOO_SHORT: i32 = 23;
/// The state holds no further reversal.
pub const MSLIP_STATE_FULL: i32 = 24;
/// workspace_length is below mslip_harmonic_workspace_length.
pub const MSLIP_WORKSPACE_TOO_SHORT: i32 = 25;
/// A force is not finite.
pub const MSLIP_BAD_FORCE: i32 = 30;
/// |force| exceeds mu N.
pub const MSLIP_FORCE_EXCEEDS_SLIP: i32 = 31;
/// A displacement is not finite, or beyond 1e150.
pub const MSLIP_BAD_DISPLACEMENT: i32 = 32;
/// A position x is not finite.
pub const MSLIP_BAD_POSITION: i32 = 33;
/// A displacement amplitude is not finite, negative, or beyond 1e150.
pub const MSLIP_BAD_AMPLITUDE: i32 = 34;
/// A force amplitude is not finite, or negative.
pub const MSLIP_BAD_FORCE_AMPLITUDE: i32 = 35;
/// The number of harmonics is 0, or beyond 2^24.
pub const MSLIP_BAD_HARMONICS: i32 = 36;
/// The number of samples does not exceed twice the number of harmonics, or is beyond 2^24.
pub const MSLIP_BAD_SAMPLES: i32 = 37;
/// The number of sliders is 0, or beyond 65536.
pub const MSLIP_BAD_COUNT: i32 = 38;
/// rule is neither MSLIP_EQUIDISTANT nor MSLIP_BETWEEN_REVERSALS.
pub const MSLIP_BAD_RULE: i32 = 39;
/// Slip is not available for an elliptical contact.
pub const MSLIP_NOT_AVAILABLE: i32 = 40;
/// An array is too long to be addressed, which every function with a length may answer; in Fortran also: too short, or of a
/// size that does not agree with the others.
pub const MSLIP_BAD_ARRAY_SIZE: i32 = 90;
/// A pointer is not a multiple of 8 bytes, for flags of 4, which every function with pointers may answer.
pub const MSLIP_BAD_ALIGNMENT: i32 = 91;

/// A contact: prepared once, then only read. Plain data of fixed size that may be copied, stored and sent.
/// An open contact (N = 0) has zero width, force and stiffness.
#[repr(C)]
pub struct mslip_contact {
    /// E*, Eq. 2 \[Pa\].
    pub composite_modulus: f64,
    /// Half-width b of the contact under its normal force \[m\]; elliptical: semi_axis_x.
    pub half_width: f64,
    /// mu N \[N\].
    pub slip_force: f64,
    /// Displacement at which gross slip starts on the monotonic curve \[m\].
    pub slip_displacement: f64,
    /// dT/d(displacement) at 0 \[N/m\].
    pub initial_stiffness: f64,
    /// Dissipated per cycle at incipient gross slip \[J\].
    pub slip_energy: f64,
    /// Prepared coefficients and marks: not to be read or written.
    pub reserved: [f64; 243],
}

const _: () = {
    assert!(size_of::<mslip_contact>() == size_of::<Contact>() && align_of::<mslip_contact>() == align_of::<Contact>());
    assert!(core::mem::offset_of!(mslip_contact, slip_energy) == core::mem::offset_of!(Contact, slip_energy));
    assert!(core::mem::offset_of!(Contact, composite_modulus) == 0 && core::mem::offset_of!(Contact, half_width) == 8);
    assert!(
        core::mem::offset_of!(Contact, slip_force) == 16 && core::mem::offset_of!(Contact, slip_displacement) == 24
    );
    assert!(
        core::mem::offset_of!(Contact, initial_stiffness) == 32 && core::mem::offset_of!(Contact, slip_energy) == 40
    );
    assert!(size_of::<Parameters>() == 80 && size_of::<EllipticParameters>() == 64);
    assert!(core::mem::offset_of!(Parameters, material) == 40);
    assert!(core::mem::offset_of!(Parameters, displacement_reference) == 72);
    assert!(core::mem::offset_of!(EllipticParameters, material) == 32);
};

/// Version of the library, "1.2.3".
#[unsafe(no_mangle)]
pub extern "C" fn mslip_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

/// Version of this interface: equals MSLIP_ABI_VERSION of the header that belongs to the library.
#[unsafe(no_mangle)]
pub extern "C" fn mslip_abi_version() -> i32 {
    MSLIP_ABI_VERSION
}

/// What a status says is wrong, and what is allowed: a static sentence.
#[unsafe(no_mangle)]
pub extern "C" fn mslip_status_text(status: i32) -> *const c_char {
    if status == MSLIP_OK {
        return c"all went well".as_ptr();
    }
    let known = Error::ALL.iter().find(|error| error.code() == status);
    known.map_or(c"this status is not one of microslip's", |error| error.sentence()).as_ptr()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The constants are written out for the header; here they are held against the errors.
    #[test]
    fn every_error_has_its_constant() {
        let constants = [
            MSLIP_NULL_POINTER,
            MSLIP_BAD_FLAT_HALF_WIDTH,
            MSLIP_BAD_EDGE_RADIUS,
            MSLIP_BAD_LENGTH,
            MSLIP_BAD_NORMAL_FORCE,
            MSLIP_BAD_FRICTION_COEFFICIENT,
            MSLIP_BAD_YOUNG_MODULUS,
            MSLIP_BAD_POISSON_RATIO,
            MSLIP_BAD_DISPLACEMENT_REFERENCE,
            MSLIP_BAD_SEMI_AXIS_X,
            MSLIP_BAD_SEMI_AXIS_Y,
            MSLIP_LENGTH_TOO_SHORT,
            MSLIP_OUT_OF_RANGE,
            MSLIP_BAD_CONTACT,
            MSLIP_BAD_STATE,
            MSLIP_BAD_WORKSPACE,
            MSLIP_STATE_TOO_SHORT,
            MSLIP_STATE_FULL,
            MSLIP_WORKSPACE_TOO_SHORT,
            MSLIP_BAD_FORCE,
            MSLIP_FORCE_EXCEEDS_SLIP,
            MSLIP_BAD_DISPLACEMENT,
            MSLIP_BAD_POSITION,
            MSLIP_BAD_AMPLITUDE,
            MSLIP_BAD_FORCE_AMPLITUDE,
            MSLIP_BAD_HARMONICS,
            MSLIP_BAD_SAMPLES,
            MSLIP_BAD_COUNT,
            MSLIP_BAD_RULE,
            MSLIP_NOT_AVAILABLE,
            MSLIP_BAD_ARRAY_SIZE,
            MSLIP_BAD_ALIGNMENT,
        ];
        assert!(constants.iter().copied().eq(Error::ALL.iter().map(|error| error.code())));
        assert!(constants.windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!(
            [MSLIP_CENTRE_POINT, MSLIP_RIGID_STRIP],
            [crate::parameters::CENTRE_POINT, crate::parameters::RIGID_STRIP]
        );
    }
}
