//! The scalar type of element kernels: one number, or the numbers of eight elements. Each operation rounds in each lane as it does on a
//! single number, so the same kernel gives the same bits.

use super::Vec3;
use super::lanes::{LANES, Lanes, by_lane, lanes};
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, Neg, Not, Sub, SubAssign};
use wide::f64x4;

/// A condition of a number, or one for each of eight.
pub trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// True where the condition holds for any.
    fn any(self) -> bool;
    /// True where it holds for the one in a lane.
    fn lane(self, lane: usize) -> bool;
}

impl Mask for bool {
    #[inline(always)]
    fn any(self) -> bool {
        self
    }

    #[inline(always)]
    fn lane(self, _: usize) -> bool {
        self
    }
}

impl Mask for Lanes {
    #[inline(always)]
    fn any(self) -> bool {
        self.to_bitmask() != 0
    }

    #[inline(always)]
    fn lane(self, lane: usize) -> bool {
        self.to_bitmask() >> lane & 1 == 1
    }
}

/// A number, or one for each of eight elements.
pub trait Number:
    Copy
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Mul<LaneVec3<Self>, Output = LaneVec3<Self>>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// The result of comparisons.
    type Mask: Mask;
    /// The number of elements.
    const COUNT: usize;
    /// Zero for all.
    const ZERO: Self;
    /// One for all.
    const ONE: Self;
    /// Sets all lanes to one number.
    fn splat(x: f64) -> Self;
    /// The numbers of the elements.
    fn gather(of: impl FnMut(usize) -> f64) -> Self;
    /// The number of one element.
    fn lane(self, lane: usize) -> f64;
    /// The numbers of the elements; of one, that number in every place.
    fn to_lanes(self) -> [f64; LANES];
    /// a b + c, rounded as [`super::fma`] does.
    fn fma(a: Self, b: Self, c: Self) -> Self;
    /// The number, or its negative where `sign` is below zero.
    fn with_sign_of(self, sign: Self) -> Self;
    /// True where this is less than `other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// True where this is `other` or less.
    fn le(self, other: Self) -> Self::Mask;
    /// `yes` where the condition holds, `no` elsewhere.
    fn select(condition: Self::Mask, yes: Self, no: Self) -> Self;
    /// The square root.
    fn sqrt(self) -> Self;
    /// The size.
    fn abs(self) -> Self;
    /// The larger number.
    fn max(self, other: Self) -> Self;
    /// The smaller number.
    fn min(self, other: Self) -> Self;
    /// A function of the number, one element after the other.
    #[inline(always)]
    fn map(self, of: impl Fn(f64) -> f64) -> Self {
        Self::gather(|lane| of(self.lane(lane)))
    }
    /// Two functions of the number, one element after the other.
    #[inline(always)]
    fn map_two(self, of: impl Fn(f64) -> (f64, f64)) -> (Self, Self) {
        let mut second = [0.0; LANES];
        let first = Self::gather(|lane| {
            let both = of(self.lane(lane));
            second[lane] = both.1;
            both.0
        });
        (first, Self::gather(|lane| second[lane]))
    }
    /// Reads as many numbers of each element as there is room for, one after the other from its place `at` on.
    fn read(numbers: &mut [Self], from: &[f64], at: impl Fn(usize) -> usize);
    /// Writes numbers of the first `count` elements, those of each one after the other from its place `at` on.
    fn write(numbers: &[Self], count: usize, to: &mut [f64], at: impl Fn(usize) -> usize);
}

impl Number for f64 {
    type Mask = bool;
    const COUNT: usize = 1;
    const ZERO: f64 = 0.0;
    const ONE: f64 = 1.0;

    #[inline(always)]
    fn splat(x: f64) -> f64 {
        x
    }

    #[inline(always)]
    fn gather(mut of: impl FnMut(usize) -> f64) -> f64 {
        of(0)
    }

    #[inline(always)]
    fn lane(self, _: usize) -> f64 {
        self
    }

    #[inline(always)]
    fn to_lanes(self) -> [f64; LANES] {
        [self; LANES]
    }

    #[inline(always)]
    fn fma(a: f64, b: f64, c: f64) -> f64 {
        super::fma(a, b, c)
    }

    #[inline(always)]
    fn with_sign_of(self, sign: f64) -> f64 {
        if sign < 0.0 { -self } else { self }
    }

    #[inline(always)]
    fn lt(self, other: f64) -> bool {
        self < other
    }

    #[inline(always)]
    fn le(self, other: f64) -> bool {
        self <= other
    }

    #[inline(always)]
    fn select(condition: bool, yes: f64, no: f64) -> f64 {
        if condition { yes } else { no }
    }

    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }

    #[inline(always)]
    fn abs(self) -> f64 {
        f64::abs(self)
    }

    #[inline(always)]
    fn max(self, other: f64) -> f64 {
        f64::max(self, other)
    }

    #[inline(always)]
    fn min(self, other: f64) -> f64 {
        f64::min(self, other)
    }

    #[inline(always)]
    fn read(numbers: &mut [f64], from: &[f64], at: impl Fn(usize) -> usize) {
        numbers.copy_from_slice(&from[at(0)..][..numbers.len()]);
    }

    #[inline(always)]
    fn write(numbers: &[f64], _: usize, to: &mut [f64], at: impl Fn(usize) -> usize) {
        to[at(0)..][..numbers.len()].copy_from_slice(numbers);
    }
}

impl Number for Lanes {
    type Mask = Lanes;
    const COUNT: usize = LANES;
    const ZERO: Lanes = Lanes::ZERO;
    const ONE: Lanes = Lanes::ONE;

    #[inline(always)]
    fn splat(x: f64) -> Lanes {
        Lanes::splat(x)
    }

    #[inline(always)]
    fn gather(of: impl FnMut(usize) -> f64) -> Lanes {
        lanes(of)
    }

    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        self.to_array()[lane]
    }

    #[inline(always)]
    fn to_lanes(self) -> [f64; LANES] {
        self.to_array()
    }

    #[inline(always)]
    fn fma(a: Lanes, b: Lanes, c: Lanes) -> Lanes {
        super::lanes::fma(a, b, c)
    }

    #[inline(always)]
    fn with_sign_of(self, sign: Lanes) -> Lanes {
        sign.simd_lt(Lanes::ZERO).select(-self, self)
    }

    #[inline(always)]
    fn lt(self, other: Lanes) -> Lanes {
        self.simd_lt(other)
    }

    #[inline(always)]
    fn le(self, other: Lanes) -> Lanes {
        self.simd_le(other)
    }

    #[inline(always)]
    fn select(condition: Lanes, yes: Lanes, no: Lanes) -> Lanes {
        condition.select(yes, no)
    }

    #[inline(always)]
    fn sqrt(self) -> Lanes {
        Lanes::sqrt(self)
    }

    #[inline(always)]
    fn abs(self) -> Lanes {
        Lanes::abs(self)
    }

    #[inline(always)]
    fn max(self, other: Lanes) -> Lanes {
        Lanes::fast_max(self, other)
    }

    #[inline(always)]
    fn min(self, other: Lanes) -> Lanes {
        Lanes::min(self, other)
    }

    #[inline(always)]
    fn read(numbers: &mut [Lanes], from: &[f64], at: impl Fn(usize) -> usize) {
        let own = by_lane(|lane| &from[at(lane)..][..numbers.len()]);
        let (tiles, rest) = numbers.as_chunks_mut::<4>();
        let read = 4 * tiles.len();
        for (t, tile) in tiles.iter_mut().enumerate() {
            let four = |lane: usize| f64x4::new(own[lane].as_chunks().0[t]);
            let low = f64x4::transpose([four(0), four(1), four(2), four(3)]).map(f64x4::to_array);
            let high = f64x4::transpose([four(4), four(5), four(6), four(7)]).map(f64x4::to_array);
            for k in 0..4 {
                let ([a, b, c, d], [e, f, g, h]) = (low[k], high[k]);
                tile[k] = Lanes::new([a, b, c, d, e, f, g, h]);
            }
        }
        for (k, number) in rest.iter_mut().enumerate() {
            *number = lanes(|lane| own[lane][read + k]);
        }
    }

    #[inline(always)]
    fn write(numbers: &[Lanes], count: usize, to: &mut [f64], at: impl Fn(usize) -> usize) {
        let at = by_lane(at);
        let (tiles, rest) = numbers.as_chunks::<4>();
        for (t, tile) in tiles.iter().enumerate() {
            for (half, first) in [0, 4].into_iter().enumerate().take_while(|(_, first)| *first < count) {
                for (lane, of) in (first..count).zip(transposed_half(tile, half)) {
                    to[at[lane] + 4 * t..][..4].copy_from_slice(&of.to_array());
                }
            }
        }
        for (k, numbers) in (4 * tiles.len()..).zip(rest) {
            let numbers = numbers.to_array();
            (0..count).for_each(|lane| to[at[lane] + k] = numbers[lane]);
        }
    }
}

/// Four numbers of each of the first four elements, or of the last four, element by element.
#[inline(always)]
fn transposed_half([a, b, c, d]: &[Lanes; 4], half: usize) -> [f64x4; 4] {
    let of = |numbers: &Lanes| f64x4::new(numbers.as_array().as_chunks().0[half]);
    f64x4::transpose([of(a), of(b), of(c), of(d)])
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
