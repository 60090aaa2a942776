//! What can be wrong with a call, one error for each parameter, and the sentence that says what is allowed.

/// Why a call was refused. The number is the status code of the C interface: fixed by hand, never reused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i32)]
#[non_exhaustive]
#[expect(missing_docs, reason = "each says what it is in its sentence")]
pub enum Error {
    NullPointer = 1,
    BadFlatHalfWidth = 2,
    BadEdgeRadius = 3,
    BadLength = 4,
    BadNormalForce = 5,
    BadFrictionCoefficient = 6,
    BadYoungModulus = 7,
    BadPoissonRatio = 8,
    BadDisplacementReference = 9,
    BadSemiAxisX = 10,
    BadSemiAxisY = 11,
    LengthTooShort = 12,
    OutOfRange = 13,
    BadContact = 20,
    BadState = 21,
    BadWorkspace = 22,
    StateTooShort = 23,
    StateFull = 24,
    WorkspaceTooShort = 25,
    BadForce = 30,
    ForceExceedsSlip = 31,
    BadDisplacement = 32,
    BadPosition = 33,
    BadAmplitude = 34,
    BadForceAmplitude = 35,
    BadHarmonics = 36,
    BadSamples = 37,
    BadCount = 38,
    BadRule = 39,
    NotAvailable = 40,
    BadArraySize = 90,
    BadAlignment = 91,
}

impl Error {
    /// Every error, in the order of the status codes.
    pub const ALL: [Error; 32] = [
        Error::NullPointer,
        Error::BadFlatHalfWidth,
        Error::BadEdgeRadius,
        Error::BadLength,
        Error::BadNormalForce,
        Error::BadFrictionCoefficient,
        Error::BadYoungModulus,
        Error::BadPoissonRatio,
        Error::BadDisplacementReference,
        Error::BadSemiAxisX,
        Error::BadSemiAxisY,
        Error::LengthTooShort,
        Error::OutOfRange,
        Error::BadContact,
        Error::BadState,
        Error::BadWorkspace,
        Error::StateTooShort,
        Error::StateFull,
        Error::WorkspaceTooShort,
        Error::BadForce,
        Error::ForceExceedsSlip,
        Error::BadDisplacement,
        Error::BadPosition,
        Error::BadAmplitude,
        Error::BadForceAmplitude,
        Error::BadHarmonics,
        Error::BadSamples,
        Error::BadCount,
        Error::BadRule,
        Error::NotAvailable,
        Error::BadArraySize,
        Error::BadAlignment,
    ];

    /// The status code of the C interface.
    #[must_use]
    pub const fn code(self) -> i32 {
        self as i32
    }

    /// What is wrong and what is allowed, as a sentence.
    #[must_use]
    pub const fn sentence(self) -> &'static core::ffi::CStr {
        match self {
            Error::NullPointer => c"a required pointer is NULL: inputs, contacts, states and workspaces must be given",
            Error::BadFlatHalfWidth => c"flat_half_width must be a finite number >= 0 (0 is a cylinder)",
            Error::BadEdgeRadius => c"edge_radius must be a finite number > 0",
            Error::BadLength => c"length must be a finite number > 0",
            Error::BadNormalForce => c"normal_force must be a finite number >= 0 (0 is an open contact)",
            Error::BadFrictionCoefficient => c"friction_coefficient must be a finite number >= 0",
            Error::BadYoungModulus => c"young_modulus of both materials must be a finite number > 0",
            Error::BadPoissonRatio => c"poisson_ratio of both materials must lie in 0 <= nu <= 0.5",
            Error::BadDisplacementReference => {
                c"displacement_reference must be MSLIP_CENTRE_POINT (0) or MSLIP_RIGID_STRIP (1)"
            }
            Error::BadSemiAxisX => c"semi_axis_x must be a finite number > 0",
            Error::BadSemiAxisY => c"semi_axis_y must be a finite number > 0",
            Error::LengthTooShort => {
                c"length is too short for the contact half-width b: 2 length > b and a positive initial stiffness are needed"
            }
            Error::OutOfRange => {
                c"the parameters are each allowed, but together they give numbers beyond about 1e-150 to 1e150"
            }
            Error::BadContact => c"the contact was never prepared, belongs to another version, or was changed: call mslip_contact_init first",
            Error::BadState => c"the state was never initialised, is cut short, or was changed: call mslip_state_init first",
            Error::BadWorkspace => {
                c"the workspace was never initialised, or was changed: call mslip_harmonic_workspace_init first"
            }
            Error::StateTooShort => c"state_length is too short: use mslip_state_length for the number of reversals wanted",
            Error::StateFull => {
                c"the state holds no further reversal and is unchanged: make it longer, by mslip_state_length"
            }
            Error::WorkspaceTooShort => {
                c"workspace_length is too short: use mslip_harmonic_workspace_length for these harmonics and samples"
            }
            Error::BadForce => c"force must be a finite number",
            Error::ForceExceedsSlip => c"|force| must not exceed slip_force = mu N",
            Error::BadDisplacement => c"displacement must be a finite number, at most 1e150 in size",
            Error::BadPosition => c"position x must be a finite number",
            Error::BadAmplitude => c"amplitude must be a finite number >= 0, at most 1e150",
            Error::BadForceAmplitude => c"force_amplitude must be a finite number >= 0",
            Error::BadHarmonics => c"the number of harmonics must lie in 1 to 16777216",
            Error::BadSamples => c"the number of samples must exceed twice the number of harmonics, and be at most 16777216",
            Error::BadCount => c"the number of sliders must lie in 1 to 65536",
            Error::BadRule => c"rule must be MSLIP_EQUIDISTANT (0) or MSLIP_BETWEEN_REVERSALS (1)",
            Error::NotAvailable => c"slip is not available for an elliptical contact",
            Error::BadArraySize => c"an array is longer than memory, too short, or of a size that does not agree with the others",
            Error::BadAlignment => c"a pointer must be a multiple of what it points to: of 8 bytes, for flags of 4",
        }
    }
}

impl core::fmt::Display for Error {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.sentence().to_str().unwrap_or(""))
    }
}

impl core::error::Error for Error {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_is_shown_as_its_sentence() {
        for error in Error::ALL {
            assert_eq!(std::format!("{error}").as_bytes(), error.sentence().to_bytes());
        }
    }
}
