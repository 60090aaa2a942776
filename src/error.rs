//! Status codes: one per argument that can be invalid, with a message that states the allowed range.

use core::ffi::CStr;

/// Defines [`Error`] and the constants of the C interface from one table: name, constant, code and message. The message is also
/// their documentation.
macro_rules! status_codes {
    ($($name:ident, $constant:ident = $code:literal: $message:literal;)*) => {
        /// Reason for which a call was rejected. The discriminants are the status codes of the C interface: explicit, never reused.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        #[repr(i32)]
        #[non_exhaustive]
        pub enum Error {
            $(#[doc = $message] $name = $code,)*
        }

        /// The status codes as constants of the C interface.
        pub mod constants {
            $(#[doc = $message] pub const $constant: i32 = $code;)*
        }

        impl Error {
            /// All errors, in the order of their status codes.
            pub const ALL: &[Error] = &[$(Error::$name),*];

            /// Name of the constant of the C interface.
            pub const fn constant(self) -> &'static str {
                match self {
                    $(Error::$name => stringify!($constant),)*
                }
            }

            /// Message: the error and the allowed range.
            pub const fn message(self) -> &'static CStr {
                match self {
                    $(Error::$name => match CStr::from_bytes_with_nul(concat!($message, "\0").as_bytes()) {
                        Ok(message) => message,
                        Err(_) => c"",
                    },)*
                }
            }
        }
    };
}

status_codes! {
    NullPointer, MSLIP_NULL_POINTER = 1: "a required pointer is NULL";
    BadFlatHalfWidth, MSLIP_BAD_FLAT_HALF_WIDTH = 2: "flat_half_width must be finite and >= 0";
    BadEdgeRadius, MSLIP_BAD_EDGE_RADIUS = 3: "edge_radius must be finite and > 0";
    BadLength, MSLIP_BAD_LENGTH = 4: "length must be finite and > 0";
    BadNormalForce, MSLIP_BAD_NORMAL_FORCE = 5:
        "normal_force must be finite and >= 0, in the parameters of an element > 0; so must each step and sample of a given normal force";
    BadFrictionCoefficient, MSLIP_BAD_FRICTION_COEFFICIENT = 6: "friction_coefficient must be finite and >= 0";
    BadYoungModulus, MSLIP_BAD_YOUNG_MODULUS = 7: "each young_modulus must be finite and > 0";
    BadPoissonRatio, MSLIP_BAD_POISSON_RATIO = 8: "each poisson_ratio must be between 0 and 0.5";
    BadDisplacementReference, MSLIP_BAD_DISPLACEMENT_REFERENCE = 9:
        "displacement_reference must be MSLIP_RIGID_STRIP, the contact of a machine, or MSLIP_CENTRE_POINT, that of the paper, 7 to 13 % more compliant";
    BadSemiAxisX, MSLIP_BAD_SEMI_AXIS_X = 10: "semi_axis_x must be finite and > 0";
    BadSemiAxisY, MSLIP_BAD_SEMI_AXIS_Y = 11: "semi_axis_y must be finite and > 0";
    LengthTooShort, MSLIP_LENGTH_TOO_SHORT = 12:
        "length too small for the half-width b of the contact, or approach or force of an element too large: requires 2*length > b and a positive initial stiffness";
    OutOfRange, MSLIP_OUT_OF_RANGE = 13: "parameters out of range: a derived quantity would exceed 1e-150 .. 1e150";
    BadNormalCompliance, MSLIP_BAD_NORMAL_COMPLIANCE = 15:
        "normal_compliance of a layer must be finite and >= 0, and under normal_force at most 2^40 times that of the contact and 0 or 1e-150 .. 1e150";
    BadTangentialCompliance, MSLIP_BAD_TANGENTIAL_COMPLIANCE = 16:
        "tangential_compliance of a layer must be finite and >= 0, and under normal_force at most 2^40 times that of the contact and 0 or 1e-150 .. 1e150";
    BadStiffeningLoad, MSLIP_BAD_STIFFENING_LOAD = 17:
        "stiffening_load of a layer must be 0, infinite, or at least 1e-3 of normal_force";
    BadReferenceLoad, MSLIP_BAD_REFERENCE_LOAD = 18:
        "reference_load of a layer must be between 0 (for normal_force) and 1e150; the compliances under normal_force may be at most 2^40 times those under this load";
    BadContact, MSLIP_BAD_CONTACT = 20:
        "invalid contact: uninitialised, corrupted, written as text of fewer than 17 digits, or created by an incompatible version of the library";
    BadState, MSLIP_BAD_STATE = 21:
        "invalid state: uninitialised, truncated, corrupted, written as text of too few digits (17 are always enough), or created by an incompatible version of the library";
    BadWorkspace, MSLIP_BAD_WORKSPACE = 22:
        "invalid workspace: uninitialised, or created by an incompatible version of the library";
    StateTooShort, MSLIP_STATE_TOO_SHORT = 23:
        "state_length must be at least mslip_state_length(0) or mslip_element_state_length(directions, 0)";
    BadElement, MSLIP_BAD_ELEMENT = 24:
        "invalid element: uninitialised, corrupted, written as text of fewer than 17 digits, or created by an incompatible version of the library";
    WorkspaceTooShort, MSLIP_WORKSPACE_TOO_SHORT = 25:
        "workspace_length must be at least mslip_harmonic_workspace_length or mslip_element_workspace_length";
    BadForce, MSLIP_BAD_FORCE = 30: "a force must be finite";
    ForceExceedsSlip, MSLIP_FORCE_EXCEEDS_SLIP = 31: "a force must not exceed mu N in magnitude";
    BadDisplacement, MSLIP_BAD_DISPLACEMENT = 32: "a displacement must be finite and at most 1e150 in magnitude";
    BadPosition, MSLIP_BAD_POSITION = 33: "a position x must be finite";
    BadAmplitude, MSLIP_BAD_AMPLITUDE = 34: "a displacement amplitude must be between 0 and 1e150";
    BadForceAmplitude, MSLIP_BAD_FORCE_AMPLITUDE = 35: "a force amplitude must be finite and >= 0";
    BadHarmonics, MSLIP_BAD_HARMONICS = 36: "the number of harmonics must be between 1 and 2^24";
    BadSamples, MSLIP_BAD_SAMPLES = 37:
        "the number of samples must exceed twice the number of harmonics and be at most 2^24";
    BadCount, MSLIP_BAD_COUNT = 38: "the number of sliders must be between 1 and 65536";
    BadRule, MSLIP_BAD_RULE = 39: "rule must be MSLIP_UNIFORM_SAMPLING or MSLIP_EVENT_DRIVEN";
    NotAvailable, MSLIP_NOT_AVAILABLE = 40:
        "not available for this kind of contact; elements have uniform sampling only; for two directions no tractions";
    BadIndex, MSLIP_BAD_INDEX = 41: "an index must refer to one of the n_contacts contacts or n_elements elements";
    BadDirections, MSLIP_BAD_DIRECTIONS = 42: "directions must be 1 or 2, equal for all elements, states and workspaces of a call";
    BadNormalInput, MSLIP_BAD_NORMAL_INPUT = 43: "normal_input must be MSLIP_INPUT_APPROACH or MSLIP_INPUT_NORMAL_FORCE";
    BadPeriods, MSLIP_BAD_PERIODS = 44: "the number of periods must be at most 65536";
    BadCoefficients, MSLIP_BAD_COEFFICIENTS = 45:
        "a displacement must have the number of coefficients of the workspace: 2*harmonics + 1 for each component (in Fortran)";
    BadArea, MSLIP_BAD_AREA = 46: "each area must be between 0 and 1e50, and that of each part at least 1e-50";
    BadPressure, MSLIP_BAD_PRESSURE = 47: "each pressure must be between 0 and 1e50, and the normal force of a face at least 1e-50";
    BadArraySize, MSLIP_BAD_ARRAY_SIZE = 90:
        "the shape of an optional argument, a state or a second input does not agree with that of the first input (in Fortran), or an array is too long to be addressed";
    BadAlignment, MSLIP_BAD_ALIGNMENT = 91: "misaligned pointer: doubles need 8-byte, int32 flags 4-byte alignment";
}

/// An error unless a condition holds.
pub(crate) fn ensure(condition: bool, error: Error) -> Result<(), Error> {
    if condition { Ok(()) } else { Err(error) }
}

impl Error {
    /// Status code of the C interface.
    pub const fn code(self) -> i32 {
        self as i32
    }
}

impl core::fmt::Display for Error {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.message().to_str().unwrap_or(""))
    }
}

impl core::error::Error for Error {}
