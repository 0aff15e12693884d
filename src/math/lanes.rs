//! Eight numbers side by side, of eight like elements: each operation rounds in each lane as it does on a single number.

use super::Vec3;
use std::array::from_fn;
use std::ops::{Add, AddAssign, Mul, Sub, SubAssign};

/// A number of each of eight elements.
pub type Lanes = wide::f64x8;

/// The number of lanes.
pub const LANES: usize = 8;

/// The numbers of the lanes.
#[inline(always)]
pub fn lanes(of: impl FnMut(usize) -> f64) -> Lanes {
    Lanes::new(from_fn(of))
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

/// A vector of three numbers for each of eight elements.
#[derive(Clone, Copy)]
pub struct LaneVec3(pub [Lanes; 3]);

impl LaneVec3 {
    /// Zero in all lanes.
    pub const ZERO: Self = LaneVec3([Lanes::ZERO; 3]);

    /// The vectors of the lanes.
    #[inline(always)]
    pub fn gather(of: impl Fn(usize) -> Vec3) -> Self {
        let of: [Vec3; LANES] = from_fn(of);
        LaneVec3(from_fn(|i| lanes(|lane| of[lane][i])))
    }

    /// a·b.
    #[inline(always)]
    pub fn dot(&self, b: &Self) -> Lanes {
        self.0[0] * b.0[0] + self.0[1] * b.0[1] + self.0[2] * b.0[2]
    }

    /// a × b.
    #[inline(always)]
    pub fn cross(&self, b: &Self) -> Self {
        let ([x, y, z], [u, v, w]) = (self.0, b.0);
        LaneVec3([y * w - z * v, z * u - x * w, x * v - y * u])
    }
}

impl Add for LaneVec3 {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        LaneVec3(from_fn(|i| self.0[i] + b.0[i]))
    }
}

impl Sub for LaneVec3 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        LaneVec3(from_fn(|i| self.0[i] - b.0[i]))
    }
}

impl Mul<LaneVec3> for Lanes {
    type Output = LaneVec3;
    #[inline(always)]
    fn mul(self, b: LaneVec3) -> LaneVec3 {
        LaneVec3(from_fn(|i| self * b.0[i]))
    }
}

impl AddAssign for LaneVec3 {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl SubAssign for LaneVec3 {
    #[inline(always)]
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}
