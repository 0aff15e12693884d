//! The Lagrange multipliers of joints in the iteration; see [`super::joints`] for the equations.

/// ε: a repeated row is felt as 1e-16/ε of a length, and a gap shrinks by ε in an iteration.
pub(super) const REGULARIZATION: f64 = 1e-7;

/// What joints carry, a number for each row of all joints.
#[derive(Debug, Clone, Default)]
pub struct Multipliers {
    /// λ: forces and moments. Written by the iteration.
    pub values: Vec<f64>,
    /// c: how far the joints gape. Written by [`super::System::residual`].
    pub gaps: Vec<f64>,
    /// s. Written by the tangent.
    pub(super) penalties: Vec<f64>,
}

impl Multipliers {
    pub fn new(rows: usize) -> Self {
        Multipliers { values: vec![0.0; rows], gaps: vec![0.0; rows], penalties: vec![0.0; rows] }
    }

    /// All but the gaps of another.
    pub fn copy_from(&mut self, other: &Multipliers) {
        self.values.copy_from_slice(&other.values);
        self.penalties.copy_from_slice(&other.penalties);
    }

    /// The right-hand side of the second equation.
    #[inline]
    pub fn write_rhs(&self, tail: &mut [f64]) {
        for ((r, s), c) in tail.iter_mut().zip(&self.penalties).zip(&self.gaps) {
            *r = -s * (1.0 + REGULARIZATION) * c;
        }
    }

    /// From δμ to δλ/s.
    #[inline]
    pub fn subtract_gaps(&self, tail: &mut [f64]) {
        tail.iter_mut().zip(&self.gaps).for_each(|(r, c)| *r -= c);
    }

    /// λ ← λ + s times what [`Multipliers::subtract_gaps`] has left.
    #[inline]
    pub fn add(&mut self, tail: &[f64]) {
        for ((value, s), r) in self.values.iter_mut().zip(&self.penalties).zip(tail) {
            *value += s * r;
        }
    }
}
