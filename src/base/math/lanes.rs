//! Eight numbers side by side, of eight like elements: each operation rounds in each lane as it does on a single number.

/// A number of each of eight elements.
pub type Lanes = wide::f64x8;

/// The number of lanes.
pub const LANES: usize = 8;

/// The numbers of the lanes.
#[inline(always)]
pub fn lanes(of: impl FnMut(usize) -> f64) -> Lanes {
    Lanes::new(by_lane(of))
}

/// An item of each lane.
#[inline(always)]
pub fn by_lane<R>(mut of: impl FnMut(usize) -> R) -> [R; LANES] {
    // A closure handed on to the standard library is not always inlined.
    [of(0), of(1), of(2), of(3), of(4), of(5), of(6), of(7)]
}

/// All bits set in the lanes whose bit is set, for a choice between two numbers.
#[inline(always)]
pub fn mask(bits: u32) -> Lanes {
    lanes(|lane| if bits >> lane & 1 == 1 { f64::from_bits(u64::MAX) } else { 0.0 })
}

/// a b + c, rounded as [`super::fma`] does.
#[inline(always)]
pub fn fma(a: Lanes, b: Lanes, c: Lanes) -> Lanes {
    if cfg!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
}
