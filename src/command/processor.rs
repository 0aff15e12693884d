//! The levels of instructions of x86-64: the level of the build, and the level of the processor. A program that lacks instructions of its
//! build dies at the first such instruction.

use clap::ValueEnum;

/// A level of instructions, by its name in the System V ABI.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub enum Level {
    /// Any processor.
    #[value(name = "x86-64")]
    Any,
    /// Vectors of four numbers, multiply and add in one.
    #[value(name = "x86-64-v3")]
    V3,
    /// Vectors of eight numbers.
    #[value(name = "x86-64-v4")]
    V4,
}

impl Level {
    /// All levels, the lowest first.
    pub const ALL: [Level; 3] = [Level::Any, Level::V3, Level::V4];

    /// The level that the build was free to use; `None` on other processors than x86-64.
    pub const BUILT_FOR: Option<Level> = if cfg!(target_feature = "avx512f") {
        Some(Level::V4)
    } else if cfg!(all(target_feature = "avx2", target_feature = "fma")) {
        Some(Level::V3)
    } else if cfg!(target_arch = "x86_64") {
        Some(Level::Any)
    } else {
        None
    };

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Level::Any => "x86-64",
            Level::V3 => "x86-64-v3",
            Level::V4 => "x86-64-v4",
        }
    }

    /// The highest level that the processor and the system have.
    #[cfg(target_arch = "x86_64")]
    pub fn of_processor() -> Level {
        use std::is_x86_feature_detected as has;
        let third = has!("avx2") && has!("fma") && has!("bmi1") && has!("bmi2") && has!("f16c") && has!("lzcnt");
        let fourth = has!("avx512f") && has!("avx512bw") && has!("avx512cd") && has!("avx512dq") && has!("avx512vl");
        match (third && has!("movbe"), fourth) {
            (true, true) => Level::V4,
            (true, false) => Level::V3,
            (false, _) => Level::Any,
        }
    }

    /// Of other processors nothing is known.
    #[cfg(not(target_arch = "x86_64"))]
    pub fn of_processor() -> Level {
        Level::Any
    }
}

/// The instructions that the program was built for, in words.
pub fn built_for() -> &'static str {
    match Level::BUILT_FOR {
        Some(Level::V4) => "x86-64-v4 (AVX-512)",
        Some(Level::V3) => "x86-64-v3 (AVX2, FMA)",
        Some(Level::Any) => "x86-64",
        None => std::env::consts::ARCH,
    }
}

/// The instructions of the build that the processor lacks; `None` if it has all.
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
