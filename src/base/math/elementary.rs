//! The elementary functions of a release, under their names in C: whatever calls `sin` is linked with these, libraries too. Those of the
//! system choose their instructions by the processor at hand, and round otherwise in each of its versions; these are part of
//! the program, so their bits are the same everywhere. Sources: the functions of FreeBSD and musl, by the crate `libm`.

/// Defines functions of one or two numbers under their names in C.
macro_rules! functions_of_c {
    ($($name:ident($($x:ident),+))*) => {
        $(
            // SAFETY: the name is that of C's function of the same meaning, whose arguments and value these are.
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

/// Sine and cosine of the same angle, which the compiler asks for at once.
// SAFETY: the name is that of the function of the GNU C library of the same meaning, which writes to two places that are there.
#[unsafe(no_mangle)]
extern "C" fn sincos(x: f64, sine: &mut f64, cosine: &mut f64) {
    (*sine, *cosine) = libm::sincos(x);
}
