//! Eight numbers side by side, of eight like elements: each operation rounds in each lane as it does on a single number.

use super::Vec3;
use super::number::Number;
use std::ops::{Add, AddAssign, Mul, Sub, SubAssign};

/// A number of each of eight elements.
pub type Lanes = wide::f64x8;

/// The number of lanes.
pub const LANES: usize = 8;

/// The numbers of the lanes.
#[inline(always)]
pub fn lanes(mut of: impl FnMut(usize) -> f64) -> Lanes {
    // A closure handed on to the standard library is not always inlined.
    Lanes::new([of(0), of(1), of(2), of(3), of(4), of(5), of(6), of(7)])
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

/// A vector of three numbers, for each of eight elements or of one.
#[derive(Clone, Copy)]
pub struct LaneVec3<T = Lanes>(pub [T; 3]);

impl<T: Number> LaneVec3<T> {
    /// Zero in all lanes.
    pub const ZERO: Self = LaneVec3([T::ZERO; 3]);

    /// The vectors of the lanes.
    #[inline(always)]
    pub fn gather(of: impl Fn(usize) -> Vec3) -> Self {
        LaneVec3([T::gather(|lane| of(lane).x), T::gather(|lane| of(lane).y), T::gather(|lane| of(lane).z)])
    }

    /// The vector of one lane.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> Vec3 {
        Vec3::from(self.0.map(|of| of.lane(lane)))
    }

    /// a·b.
    #[inline(always)]
    pub fn dot(&self, b: &Self) -> T {
        self.0[0] * b.0[0] + self.0[1] * b.0[1] + self.0[2] * b.0[2]
    }

    /// a × b.
    #[inline(always)]
    pub fn cross(&self, b: &Self) -> Self {
        let ([x, y, z], [u, v, w]) = (self.0, b.0);
        LaneVec3([y * w - z * v, z * u - x * w, x * v - y * u])
    }
}

impl<T: Number> Add for LaneVec3<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        LaneVec3([self.0[0] + b.0[0], self.0[1] + b.0[1], self.0[2] + b.0[2]])
    }
}

impl<T: Number> Sub for LaneVec3<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        LaneVec3([self.0[0] - b.0[0], self.0[1] - b.0[1], self.0[2] - b.0[2]])
    }
}

impl Mul<LaneVec3> for Lanes {
    type Output = LaneVec3;
    #[inline(always)]
    fn mul(self, b: LaneVec3) -> LaneVec3 {
        LaneVec3([self * b.0[0], self * b.0[1], self * b.0[2]])
    }
}

impl Mul<LaneVec3<f64>> for f64 {
    type Output = LaneVec3<f64>;
    #[inline(always)]
    fn mul(self, b: LaneVec3<f64>) -> LaneVec3<f64> {
        LaneVec3([self * b.0[0], self * b.0[1], self * b.0[2]])
    }
}

impl<T: Number> AddAssign for LaneVec3<T> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl<T: Number> SubAssign for LaneVec3<T> {
    #[inline(always)]
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}
