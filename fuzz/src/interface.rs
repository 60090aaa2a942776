//! Calls of the interface: counted, told on request, and stopped where a floating-point exception is raised.

use microslip::Error;
use std::ffi::CStr;
use std::io::Write;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

static CALLS: AtomicU64 = AtomicU64::new(0);

/// Once, before the first input: the number of calls is told at the end, and added to the file that MICROSLIP_FUZZ_CALLS
/// names.
pub fn start() {
    extern "C" fn tell() {
        let calls = CALLS.load(Relaxed);
        eprintln!("{calls} calls of the interface");
        if let Ok(name) = std::env::var("MICROSLIP_FUZZ_CALLS")
            && let Ok(mut file) = std::fs::OpenOptions::new().append(true).create(true).open(name)
        {
            let _ = writeln!(file, "{calls}");
        }
    }
    unsafe { libc::atexit(tell) };
    for error in Error::ALL {
        assert!(text(error.code()) != text(-1), "the status {} has no text", error.code());
    }
}

fn text(status: i32) -> &'static [u8] {
    let text = unsafe { CStr::from_ptr(microslip::c_api::mslip_status_text(status)) };
    assert!(text.to_bytes().len() > 1, "the status {status} has no text");
    text.to_bytes()
}

/// Whether each call is to be told: MICROSLIP_FUZZ_TELL is set.
pub fn tells() -> bool {
    static TELLS: OnceLock<bool> = OnceLock::new();
    *TELLS.get_or_init(|| std::env::var_os("MICROSLIP_FUZZ_TELL").is_some())
}

/// What is told of a call, if anything is.
#[macro_export]
macro_rules! tell {
    ($($argument:tt)*) => { if $crate::interface::tells() { eprintln!($($argument)*) } };
}

/// A call. Where it `traps`, an invalid operation, a division by zero or an overflow ends the run at the instruction.
pub fn call<R>(traps: bool, call: impl FnOnce() -> R) -> R {
    // One thread makes all calls.
    let calls = CALLS.load(Relaxed) + 1;
    CALLS.store(calls, Relaxed);
    if calls.is_multiple_of(1 << 25) {
        eprintln!("{calls} calls so far");
    }
    if traps {
        set_exceptions(TRAPPED);
    }
    let result = call();
    if traps {
        set_exceptions(MASKED);
    }
    result
}

/// A call that answers with a status, which must be one that the header declares.
pub fn status(name: &str, traps: bool, function: impl FnOnce() -> i32) -> i32 {
    let status = call(traps, function);
    tell!("{name}: {status}");
    let declared = status == 0 || Error::ALL.iter().any(|error| error.code() == status);
    assert!(declared, "{name} answers {status}, which the header does not declare");
    status
}

/// The control word of SSE: all exceptions masked, or all but those of denormal, underflowing and inexact results.
const MASKED: u32 = 0x1f80;
const TRAPPED: u32 = 0x1f80 & !(0x080 | 0x200 | 0x400);

#[cfg(target_arch = "x86_64")]
fn set_exceptions(word: u32) {
    unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const word, options(nostack)) }
}

/// Elsewhere exceptions are not watched.
#[cfg(not(target_arch = "x86_64"))]
fn set_exceptions(_: u32) {}

/// What is wrong with a call: the statuses that may answer it.
#[derive(Clone, Copy, Default)]
pub struct Faults {
    codes: [i32; 12],
    count: usize,
    refused: bool,
}

impl Faults {
    /// A reason to refuse the call.
    pub fn when(mut self, wrong: bool, error: Error) -> Faults {
        self.refused |= wrong;
        self.may(wrong, error)
    }

    /// A reason that there may be.
    pub fn may(mut self, perhaps: bool, error: Error) -> Faults {
        if perhaps && !self.codes[..self.count].contains(&error.code()) {
            self.codes[self.count] = error.code();
            self.count += 1;
        }
        self
    }

    /// Whether there is a reason to refuse the call.
    pub fn refuses(&self) -> bool {
        self.refused
    }

    /// Those of two arguments.
    pub fn and(self, other: Faults) -> Faults {
        let codes = &other.codes[..other.count];
        let errors = Error::ALL.into_iter().filter(|error| codes.contains(&error.code()));
        let both = errors.fold(self, |faults, error| faults.may(true, error));
        Faults { refused: self.refused || other.refused, ..both }
    }

    /// A call with faults is refused by one of them, a call without is not.
    pub fn explain(&self, name: &str, status: i32) {
        let codes = &self.codes[..self.count];
        let explained = codes.contains(&status) || (status == 0 && !self.refused);
        assert!(explained, "{name} answers {status}; what is wrong: {codes:?}");
    }
}
