//! The same computation for the widest vectors that the processor at hand has, chosen at run time.
//!
//! Only the registers differ: every path performs the same operations in the same order, without fused multiplication and
//! addition, and gives the same bits.

/// Calls a function that is inlined always, compiled for the vectors that there are.
macro_rules! dispatch_simd {
    ($function:path, $($argument:ident: $type:ty),+ => $result:ty) => {{
        #[cfg(target_arch = "x86_64")]
        {
            #[target_feature(enable = "avx2")]
            fn on_avx2($($argument: $type),+) -> $result {
                $function($($argument),+)
            }
            if std::is_x86_feature_detected!("avx2") {
                // SAFETY: the processor has what the function was compiled for.
                return unsafe { on_avx2($($argument),+) };
            }
        }
        $function($($argument),+)
    }};
}

pub(super) use dispatch_simd;
