//! Calls of the interface: counted, logged on request, and stopped by floating-point exceptions.

use microslip::Error;
use std::ffi::CStr;
use std::io::Write;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

static CALLS: AtomicU64 = AtomicU64::new(0);

/// Once, before the first input: the number of calls is printed at the end, and appended to the file MICROSLIP_FUZZ_CALLS.
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
    let text = unsafe { CStr::from_ptr(microslip::ffi::mslip_status_text(status)) };
    assert!(text.to_bytes().len() > 1, "the status {status} has no text");
    text.to_bytes()
}

/// Whether each call is logged: MICROSLIP_FUZZ_TELL is set.
pub fn tells() -> bool {
    static TELLS: OnceLock<bool> = OnceLock::new();
    *TELLS.get_or_init(|| std::env::var_os("MICROSLIP_FUZZ_TELL").is_some())
}

/// Logs a call on request.
#[macro_export]
macro_rules! tell {
    ($($argument:tt)*) => { if $crate::interface::tells() { eprintln!($($argument)*) } };
}

/// A call. If it `traps`, an invalid operation, a division by zero or an overflow ends the run at the instruction.
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

/// A call that returns a status, which must be one that the header declares.
pub fn status(name: &str, traps: bool, function: impl FnOnce() -> i32) -> i32 {
    let status = call(traps, function);
    tell!("{name}: {status}");
    let declared = status == 0 || Error::ALL.iter().any(|error| error.code() == status);
    assert!(declared, "{name} returns {status}, which the header does not declare");
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

/// What is wrong with a call: the statuses that it may return.
#[derive(Clone, Copy, Default)]
pub struct Faults {
    codes: [i32; 12],
    count: usize,
    rejected: bool,
    arbitrary: bool,
}

impl Faults {
    pub const NONE: Faults = Faults { codes: [0; 12], count: 0, rejected: false, arbitrary: false };

    /// A reason to reject the call.
    pub fn when(mut self, wrong: bool, error: Error) -> Faults {
        self.rejected |= wrong;
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

    /// Arbitrary numbers behind a valid tag: any status and any results, but no memory error and no panic.
    pub fn arbitrary(mut self, arbitrary: bool) -> Faults {
        self.arbitrary |= arbitrary;
        self
    }

    pub fn is_arbitrary(&self) -> bool {
        self.arbitrary
    }

    /// Whether there is a reason to reject the call.
    pub fn rejects(&self) -> bool {
        self.rejected
    }

    /// Those of two arguments.
    pub fn and(self, other: Faults) -> Faults {
        let codes = &other.codes[..other.count];
        let errors = Error::ALL.iter().copied().filter(|error| codes.contains(&error.code()));
        let both = errors.fold(self, |faults, error| faults.may(true, error));
        Faults { rejected: self.rejected || other.rejected, arbitrary: self.arbitrary || other.arbitrary, ..both }
    }

    /// A call with faults is rejected by one of them, a call without is not.
    pub fn explain(&self, name: &str, status: i32) {
        let codes = &self.codes[..self.count];
        let explained = self.arbitrary || codes.contains(&status) || (status == 0 && !self.rejected);
        assert!(explained, "{name} returns {status}; what is wrong: {codes:?}");
    }
}
