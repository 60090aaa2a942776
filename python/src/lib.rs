//! The shared library of the Python package: the functions of `microslip.h`, and the identification from loops.

pub use microslip::ffi::*;

use std::ffi::{CStr, CString, c_char};

/// Calls [`microslip_fit::fit_json`]: returns 0 and the report, or 1 and a message, to be freed by [`microslip_python_free`].
///
/// # Safety
/// `problem` is a C string, `answer` is valid for a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn microslip_python_fit(problem: *const c_char, answer: *mut *mut c_char) -> i32 {
    // SAFETY: `problem` is a C string: guaranteed by the caller.
    let problem = unsafe { CStr::from_ptr(problem) }.to_string_lossy();
    let (status, text) = match microslip_fit::fit_json(&problem) {
        Ok(report) => (0, report),
        Err(message) => (1, message.to_string()),
    };
    // JSON escapes NUL, so a report has none.
    let text = CString::new(text.replace('\0', " ")).unwrap_or_default();
    // SAFETY: `answer` is valid for a pointer: guaranteed by the caller.
    unsafe { answer.write(text.into_raw()) };
    status
}

/// Frees an answer.
///
/// # Safety
/// `text` is an answer of [`microslip_python_fit`] that was not freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn microslip_python_free(text: *mut c_char) {
    // SAFETY: `text` comes from `CString::into_raw`: guaranteed by the caller.
    drop(unsafe { CString::from_raw(text) });
}
