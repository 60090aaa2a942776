"""microslip: a friction contact law for blade dynamics, the microslip model of Allara (2009).

`Contact` is the law under a constant normal force, `Element` that under a varying one, with separation. Forces are totals in any
one consistent set of units; the text names SI. A positive displacement gives a positive force. Harmonics are coefficients
[c0, cos1, sin1, ..., cosH, sinH]; Jacobians are jacobian[i, j] = d force_i / d displacement_j.

Arrays of float64 that are contiguous are read where they are; other real numbers are converted, anything else is a TypeError, a
wrong shape or value a ValueError; both name the argument. A call that the library rejects raises `Error` with its status code.
After any error nothing has changed. Any thread may call any function; only a `State` that is advanced in place must not be used by
two threads at once.
"""

from ._constants import Parameter, Status
from ._contact import (
    ComplexStiffness,
    Contact,
    ContactArray,
    HarmonicForce,
    HysteresisLoop,
    Iwan,
    Jenkins,
    MonotonicDisplacement,
    MonotonicForce,
    Sensitivity,
    Slip,
    Step,
    Tractions,
)
from ._core import Error, ffi, lib, status_text
from ._element import Element, ElementArray, ElementStep, NormalApproach, NormalForce, StaticDisplacement
from ._face import FaceParts, face_parts
from ._fit import FitError, fit
from ._law import PlausibilityWarning
from ._memory import ElementState, ElementWorkspace, State, Workspace
from ._parameters import read_parameters

__version__: str = ffi.string(lib.mslip_version()).decode()
ABI_VERSION: int = lib.mslip_abi_version()
if ABI_VERSION != lib.MSLIP_ABI_VERSION:
    raise ImportError("package and library of microslip have different interfaces")

CENTRE_POINT = 0
RIGID_STRIP = 1
UNIFORM_SAMPLING = 0
EVENT_DRIVEN = 1
INPUT_APPROACH = 16
INPUT_NORMAL_FORCE = 17

__all__ = [
    "ABI_VERSION",
    "CENTRE_POINT",
    "EVENT_DRIVEN",
    "INPUT_APPROACH",
    "INPUT_NORMAL_FORCE",
    "RIGID_STRIP",
    "UNIFORM_SAMPLING",
    "ComplexStiffness",
    "Contact",
    "ContactArray",
    "Element",
    "ElementArray",
    "ElementState",
    "ElementStep",
    "ElementWorkspace",
    "Error",
    "FaceParts",
    "FitError",
    "HarmonicForce",
    "HysteresisLoop",
    "Iwan",
    "Jenkins",
    "MonotonicDisplacement",
    "MonotonicForce",
    "NormalApproach",
    "NormalForce",
    "Parameter",
    "PlausibilityWarning",
    "Sensitivity",
    "Slip",
    "State",
    "StaticDisplacement",
    "Status",
    "Step",
    "Tractions",
    "Workspace",
    "__version__",
    "face_parts",
    "fit",
    "read_parameters",
    "status_text",
]
