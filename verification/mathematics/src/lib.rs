//! The mathematical functions that the library calls, without any choice by processor: a program that is linked with the option
//! `--wrap` for each computes the same bits on every platform, unless the library itself does not.

macro_rules! functions {
    ($($name:ident($($argument:ident),+) $wrapped:ident)*) => {
        $(
            #[unsafe(no_mangle)]
            pub extern "C" fn $wrapped($($argument: f64),+) -> f64 {
                libm::$name($($argument),+)
            }
        )*
    };
}

functions! {
    acos(x) __wrap_acos
    atan2(y, x) __wrap_atan2
    cbrt(x) __wrap_cbrt
    cos(x) __wrap_cos
    cosh(x) __wrap_cosh
    exp(x) __wrap_exp
    expm1(x) __wrap_expm1
    fma(x, y, z) __wrap_fma
    hypot(x, y) __wrap_hypot
    log(x) __wrap_log
    log1p(x) __wrap_log1p
    sin(x) __wrap_sin
    sinh(x) __wrap_sinh
}

#[unsafe(no_mangle)]
pub extern "C" fn __wrap_sincos(x: f64, sine: &mut f64, cosine: &mut f64) {
    (*sine, *cosine) = libm::sincos(x);
}
