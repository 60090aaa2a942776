//! SIMD dispatch: functions compiled for the baseline and for AVX2, selected at run time.
//!
//! Both variants perform the same operations in the same order, without fused multiply-add: the results are bit-identical.

/// Calls a function, which must be `#[inline(always)]`, in the variant for the present processor.
macro_rules! dispatch_simd {
    ($function:path, $($argument:ident: $type:ty),+ => $result:ty) => {{
        // A function of its own, so that the variant for AVX2 does not run above its frame.
        #[inline(never)]
        fn on_baseline($($argument: $type),+) -> $result {
            $function($($argument),+)
        }
        #[cfg(target_arch = "x86_64")]
        {
            #[target_feature(enable = "avx2")]
            fn on_avx2($($argument: $type),+) -> $result {
                $function($($argument),+)
            }
            if std::is_x86_feature_detected!("avx2") {
                // SAFETY: the processor supports AVX2.
                return unsafe { on_avx2($($argument),+) };
            }
        }
        on_baseline($($argument),+)
    }};
}

pub(super) use dispatch_simd;
