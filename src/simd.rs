//! SIMD dispatch: kernels compiled for the baseline and for AVX2, selected at run time.
//!
//! A kernel is one loop, or a few, over arrays; the control flow around it is compiled once. Both variants perform the same
//! operations in the same order, without fused multiply-add: the results are bit-identical.
//!
//! The call of a kernel is unsafe code: a function compiled for AVX2 may be called if the processor has AVX2, and no other
//! module can check that next to the call. It reads and writes no memory of its own.

/// Whether kernels run on AVX2.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn has_avx2() -> bool {
    #[cfg(test)]
    if tests::is_baseline() {
        return false;
    }
    std::is_x86_feature_detected!("avx2")
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
#[inline(never)]
fn on_avx2<R>(kernel: impl FnOnce() -> R) -> R {
    kernel()
}

#[inline(never)]
fn on_baseline<R>(kernel: impl FnOnce() -> R) -> R {
    kernel()
}

/// The result of a kernel in the variant for the present processor.
#[inline(always)]
pub(crate) fn on_any<R>(kernel: impl FnOnce() -> R) -> R {
    #[cfg(target_arch = "x86_64")]
    if has_avx2() {
        // SAFETY: the processor has AVX2.
        #[allow(unsafe_code)]
        return unsafe { on_avx2(kernel) };
    }
    on_baseline(kernel)
}

/// Returns the result of a call of a kernel, in the variant for the present processor: `dispatch!(kernel(x, y))`. The kernel must be
/// `#[inline(always)]`, like the closures around the call, so that it is compiled for the processor of the function that runs it.
macro_rules! dispatch {
    ($call:expr) => {
        $crate::simd::on_any(
            #[inline(always)]
            move || $call,
        )
    };
}

pub(crate) use dispatch;

/// `target + scale row`. All values are loaded before one is stored: otherwise the compiler, which cannot exclude that they
/// overlap, would not combine them in a vector.
#[inline(always)]
pub(crate) fn plus(target: [f64; 4], scale: f64, row: [f64; 4]) -> [f64; 4] {
    let ([a, b, c, d], [e, f, g, h]) = (target, row);
    [a + scale * e, b + scale * f, c + scale * g, d + scale * h]
}

#[cfg(target_arch = "x86_64")]
#[cfg(test)]
mod tests;
