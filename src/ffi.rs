//! The C interface: converts pointers to slices, calls the other modules, and writes the requested outputs.
//!
//! All functions check every input before they write: a rejected call leaves all outputs unchanged. Unsafe code
//! is here, for the pointers of the caller, and in `fourier/workspace`.
//!
//! # Safety
//! All functions have one contract, the conventions `Memory` and `Aliasing` of the header: each pointer is NULL or valid for what
//! it stands for, a workspace was initialised, and no output overlaps another argument, but for a new state that is the old one.

#![allow(unsafe_code, non_camel_case_types)]
#![allow(
    clippy::missing_safety_doc,
    unsafe_op_in_unsafe_fn,
    reason = "one contract, above; other reasons stand at their blocks"
)]

mod contact;
mod history;

mod cycle;
mod harmonic_force;

mod element;

mod batch;
mod pointers;

pub use crate::error::constants::*;
pub use batch::*;
pub use contact::*;
pub use cycle::*;
pub use element::*;
pub use harmonic_force::*;
pub use history::*;

use crate::constant_load::contact::Contact;
use crate::element::Element;
use crate::error::Error;
use core::ffi::c_char;

/// Version of this interface: incremented whenever a name, a meaning or a size changes.
pub const MSLIP_ABI_VERSION: i32 = 6;

/// Displacement of the centre point under a line of uniform traction: Eq. 5-10 of the paper.
pub const MSLIP_CENTRE_POINT: i32 = 0;
/// Displacement of a rigid strip, corrected to three-dimensional contact mechanics.
pub const MSLIP_RIGID_STRIP: i32 = 1;

/// Harmonic force from uniformly spaced samples of a period; its Jacobian is exact for this discretisation.
pub const MSLIP_UNIFORM_SAMPLING: i32 = 0;
/// Harmonic force from Gauss-Legendre nodes between the events: reversals, loop closures, onset of gross slip.
pub const MSLIP_EVENT_DRIVEN: i32 = 1;

/// The normal component of a displacement is the normal approach \[m\]; if it is not positive, the contact is open.
pub const MSLIP_INPUT_APPROACH: i32 = 16;
/// The normal component of a displacement is the normal force \[N\] itself.
pub const MSLIP_INPUT_NORMAL_FORCE: i32 = 17;

/// Row of a sensitivity: derivative with respect to the normal force N.
pub const MSLIP_BY_NORMAL_FORCE: i32 = 0;
/// Derivative with respect to the friction coefficient mu.
pub const MSLIP_BY_FRICTION_COEFFICIENT: i32 = 1;
/// Derivative with respect to the half-width a of the flat; from above if a = 0.
pub const MSLIP_BY_FLAT_HALF_WIDTH: i32 = 2;
/// Derivative with respect to the edge radius R.
pub const MSLIP_BY_EDGE_RADIUS: i32 = 3;
/// Derivative with respect to the length L.
pub const MSLIP_BY_LENGTH: i32 = 4;
/// Derivative with respect to E* at constant Poisson's ratios and a constant ratio of Young's moduli.
pub const MSLIP_BY_COMPOSITE_MODULUS: i32 = 5;
/// Derivative with respect to the tangential compliance of the layer under its reference load; without a layer, with respect to one
/// that is added.
pub const MSLIP_BY_LAYER_COMPLIANCE: i32 = 6;
/// Number of parameters: rows of a sensitivity.
pub const MSLIP_PARAMETER_COUNT: i32 = 7;

/// Success.
pub const MSLIP_OK: i32 = 0;

/// A contact under a constant normal force: initialised once and only read afterwards. Plain data of fixed size that may be copied,
/// stored and sent. An open contact (N = 0) has zero width, force and stiffness.
#[repr(C)]
pub struct mslip_contact {
    /// E*, Eq. 2 \[Pa\].
    pub composite_modulus: f64,
    /// Half-width b of the contact under its normal force \[m\]; elliptical: semi_axis_x.
    pub half_width: f64,
    /// mu N \[N\].
    pub slip_force: f64,
    /// Displacement at the onset of gross slip on the monotonic curve \[m\].
    pub slip_displacement: f64,
    /// Tangent stiffness at zero displacement \[N/m\].
    pub initial_stiffness: f64,
    /// Energy dissipated per cycle at incipient gross slip \[J\].
    pub slip_energy: f64,
    /// Internal tables.
    pub reserved: [f64; 373],
}

/// A friction contact element: the law under a normal force that varies, with separation. Initialised once and only read
/// afterwards; it serves any number of contact points of its geometry. Plain data of fixed size that may be copied, stored and
/// sent.
#[repr(C)]
pub struct mslip_element {
    /// E*, Eq. 2 \[Pa\].
    pub composite_modulus: f64,
    /// Coulomb's friction coefficient.
    pub friction_coefficient: f64,
    /// The largest normal force that the tables cover \[N\]; larger ones are exact, but slower.
    pub normal_force: f64,
    /// Half-width of the contact under that force \[m\]; elliptical: the semi-axis x.
    pub half_width: f64,
    /// Normal approach under that force \[m\].
    pub approach: f64,
    /// dN/d(approach) under that force \[N/m\].
    pub normal_stiffness: f64,
    /// dT/d(displacement) of a fully stuck contact under that force, x direction \[N/m\].
    pub tangential_stiffness: f64,
    /// Number of tangential directions, 1 or 2: a displacement is \[u, w\] or \[u, v, w\], a force \[T, N\] or \[Tx, Ty, N\].
    pub directions: i32,
    /// MSLIP_INPUT_APPROACH or MSLIP_INPUT_NORMAL_FORCE.
    pub normal_input: i32,
    /// Internal tables.
    pub reserved: [f64; 1853],
}

const _: () = {
    macro_rules! is_laid_out_as {
        ($public:ty, $own:ty: $($field:ident),*) => {
            assert!(size_of::<$public>() == size_of::<$own>() && align_of::<$public>() == align_of::<$own>());
            $(assert!(core::mem::offset_of!($public, $field) == core::mem::offset_of!($own, $field));)*
        };
    }
    is_laid_out_as!(mslip_contact, Contact: composite_modulus, half_width, slip_force, slip_displacement, initial_stiffness, slip_energy);
    is_laid_out_as!(mslip_element, Element: composite_modulus, friction_coefficient, normal_force, half_width, approach);
    is_laid_out_as!(mslip_element, Element: normal_stiffness, tangential_stiffness, directions, normal_input);
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

/// Message of a status code: a static string, never NULL.
#[unsafe(no_mangle)]
pub extern "C" fn mslip_status_text(status: i32) -> *const c_char {
    if status == MSLIP_OK {
        return c"success".as_ptr();
    }
    let known = Error::ALL.iter().find(|error| error.code() == status);
    known.map_or(c"unknown status code", |error| error.message()).as_ptr()
}
