//! The instructions that the program was built with, and whether the processor at hand has them: without them a program dies of an illegal
//! instruction, wherever it first meets one.

/// The largest level of instructions of x86-64 that the build was free to use, by the names of the System V ABI.
pub const BUILT_FOR: &str = if cfg!(target_feature = "avx512f") {
    "x86-64-v4 (AVX-512)"
} else if cfg!(all(target_feature = "avx2", target_feature = "fma")) {
    "x86-64-v3 (AVX2, FMA)"
} else if cfg!(target_arch = "x86_64") {
    "x86-64"
} else {
    std::env::consts::ARCH
};

/// What the program was built with and the processor has not; `None` where it has all that is asked about.
#[cfg(target_arch = "x86_64")]
pub fn missing() -> Option<&'static str> {
    let cpu = raw_cpuid::CpuId::new();
    let features = cpu.get_feature_info();
    let extended = cpu.get_extended_feature_info();
    let has = |name: &'static str, built: bool, has: Option<bool>| (built && has != Some(true)).then_some(name);
    let first = features.as_ref();
    let more = extended.as_ref();
    has("FMA", cfg!(target_feature = "fma"), first.map(|features| features.has_fma()))
        .or_else(|| has("AVX", cfg!(target_feature = "avx"), first.map(|features| features.has_avx())))
        .or_else(|| has("AVX2", cfg!(target_feature = "avx2"), more.map(|features| features.has_avx2())))
        .or_else(|| has("BMI2", cfg!(target_feature = "bmi2"), more.map(|features| features.has_bmi2())))
        .or_else(|| has("AVX-512", cfg!(target_feature = "avx512f"), more.map(|features| features.has_avx512f())))
        .or_else(|| has("AVX-512 VL", cfg!(target_feature = "avx512vl"), more.map(|features| features.has_avx512vl())))
}

/// Of other processors nothing is known.
#[cfg(not(target_arch = "x86_64"))]
pub fn missing() -> Option<&'static str> {
    None
}
