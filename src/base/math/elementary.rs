//! The elementary functions of a release, under their names in C: whatever calls `sin` is linked with these, libraries too. System
//! libraries choose instructions by processor and round differently by version. These functions are part of the program, so their bits are
//! the same everywhere. Sources: the functions of FreeBSD and musl, by the crate `libm`.

/// Defines functions of one or two numbers under their names in C.
macro_rules! functions_of_c {
    ($($name:ident($($x:ident),+))*) => {
        $(
            // SAFETY: name, arguments and value are those of the C function.
            #[unsafe(no_mangle)]
            extern "C" fn $name($($x: f64),+) -> f64 {
                libm::$name($($x),+)
            }
        )*
    };
}

functions_of_c! {
    sin(x) cos(x) tan(x) asin(x) acos(x) atan(x) atan2(y, x)
    sinh(x) cosh(x) tanh(x)
    exp(x) exp2(x) expm1(x) log(x) log2(x) log10(x) log1p(x)
    pow(x, y) cbrt(x) hypot(x, y)
}

/// Sine and cosine of one angle; the compiler emits calls to it.
// SAFETY: name and arguments are those of the function of the GNU C library, and both references are valid.
#[unsafe(no_mangle)]
extern "C" fn sincos(x: f64, sine: &mut f64, cosine: &mut f64) {
    (*sine, *cosine) = libm::sincos(x);
}
