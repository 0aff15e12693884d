//! Request of shells to their sections, and elastic sections. Sections that yield are in [`super::layers`].

use super::in_plane::{InPlane, LinearisedPlane, product};
use super::plane_strains::PointStrains;
use crate::elements::block::Moduli;
use crate::elements::results::LayerStress;
use crate::materials::Spent;
use crate::state::Configuration;
use base::math::number::Number;
use std::array::from_fn;

/// Where history variables are written.
pub struct NewHistory<'a, T> {
    /// The part of the step after which they are wanted.
    pub part: f64,
    /// The history of the group.
    pub new: &'a mut [f64],
    /// Energy dissipated by each element in this part of the step.
    pub spent: &'a mut Spent<T>,
}

/// The sections of one element or of eight side by side; an element has bitwise the same result alone and among eight.
pub trait ShellSections<const P: usize, const E: usize, T: Number>: Send + Sync {
    /// The stiffness before the material yields.
    fn elastic(&self) -> &StiffnessPack<P, E, T>;
    /// Stress at a strain.
    fn stress(&self, strain: &InPlane<P, E, T>, now: &Configuration) -> InPlane<P, E, T>;
    /// Stress at a strain and its derivative.
    fn linearise(&self, strain: &InPlane<P, E, T>, now: &Configuration, moduli: Moduli) -> LinearisedPlane<P, E, T>;
    /// Stress at a strain, with the history variables there.
    fn advance(&self, strain: &InPlane<P, E, T>, now: &Configuration, to: NewHistory<T>) -> InPlane<P, E, T>;
    /// Elastic energy of an element.
    fn energy(&self, lane: usize, strain: &InPlane<P, E>, now: &Configuration) -> f64;
    /// Writes the mean stress and the largest plastic strain of each layer of an element, in its axes, and returns the number of layers.
    fn layers(&self, _lane: usize, _strain: &InPlane<P, E>, _now: &Configuration, _: &mut [LayerStress]) -> usize {
        0
    }
    /// Largest accumulated plastic strain of an element, by the history variables of the group.
    fn plastic_strain(&self, _lane: usize, _history: &[f64]) -> f64 {
        0.0
    }
    /// True for sections that may fail.
    fn can_fail(&self) -> bool {
        false
    }
    /// The membrane strain of largest size of each element, of Green, and whether the material yields by logarithmic strain; `None` where it
    /// does not yield.
    fn surface_strain(&self, _strain: &InPlane<P, E, T>) -> Option<(T, bool)> {
        None
    }
    /// True where an element has failed as a whole, by the history variables of the group: there is no stress then, nor damping.
    fn has_failed(&self, _lane: usize, _history: &[f64]) -> bool {
        false
    }
}

/// Stiffness against drilling, which causes no strain; it stays elastic.
#[derive(Debug, Clone)]
pub struct Drilling<const E: usize, T = f64> {
    /// The factor on r rᵀ.
    pub stiffness: T,
    /// Rows r of r rᵀ by the numbers of the membrane.
    pub rows: [[T; E]; 2],
    /// Further stiffness on the diagonal, of the edges that are held straight.
    pub edges: [T; E],
}

impl<const E: usize> Drilling<E> {
    /// Adds the stiffness.
    pub fn add_to(&self, K: &mut [[f64; E]; E]) {
        for i in 0..E {
            K[i][i] += self.edges[i];
            for j in 0..E {
                K[i][j] += self.stiffness * self.rows.iter().map(|row| row[i] * row[j]).sum::<f64>();
            }
        }
    }
}

impl<const E: usize, T: Number> Drilling<E, T> {
    /// Packs several elements.
    pub fn gather<'a>(of: impl Fn(usize) -> &'a Drilling<E>) -> Self {
        Drilling {
            stiffness: T::gather(|lane| of(lane).stiffness),
            rows: from_fn(|k| from_fn(|i| T::gather(|lane| of(lane).rows[k][i]))),
            edges: from_fn(|i| T::gather(|lane| of(lane).edges[i])),
        }
    }

    /// The stress of the numbers of the membrane.
    #[inline(always)]
    pub fn stress(&self, membrane: &[T; E]) -> [T; E] {
        let mut stress = from_fn(|i| self.edges[i] * membrane[i]);
        for row in &self.rows {
            let s = self.stiffness * product(row, membrane);
            (0..E).for_each(|i| stress[i] += s * row[i]);
        }
        stress
    }
}

/// The stiffness C of an element in its plane, σ = C ε.
#[derive(Debug, Clone)]
pub struct ShellStiffness<const P: usize, const E: usize> {
    /// Membrane.
    pub N: [[f64; E]; E],
    /// Bending.
    pub M: [[f64; P]; P],
}

impl<const P: usize, const E: usize> ShellStiffness<P, E> {
    /// No stiffness.
    pub const ZERO: Self = ShellStiffness { N: [[0.0; E]; E], M: [[0.0; P]; P] };
}

/// The section of an element in its plane: stiffness and strains.
pub struct InPlaneSection<const P: usize, const E: usize> {
    /// The stiffness before the material yields.
    pub elastic: ShellStiffness<P, E>,
    /// The stiffness of drilling, a part of it.
    pub drilling: Drilling<E>,
    /// The strains at its integration points.
    pub points: Vec<PointStrains<P, E>>,
}

impl<const P: usize, const E: usize> InPlaneSection<P, E> {
    /// The mean strain of the element by a number of the membrane, as 11, 22 and 12 of a symmetric tensor.
    pub fn mean_of_membrane(&self, number: usize) -> [f64; 3] {
        let area: f64 = self.points.iter().map(|point| point.weight).sum();
        let mean =
            |i: usize| self.points.iter().map(|point| point.weight / area * point.membrane[(i, number)]).sum::<f64>();
        [mean(0), mean(1), 0.5 * mean(2)]
    }
}

/// The stiffnesses of one element or of eight by the rows of their upper halves: the matrices are symmetric to the last bit.
#[derive(Debug, Clone)]
pub struct StiffnessPack<const P: usize, const E: usize, T> {
    N: Box<[T]>,
    M: Box<[T]>,
}

/// The rows of the upper half of a matrix of `R` rows.
fn upper<T, const R: usize>(entry: impl Fn(usize, usize) -> T) -> Box<[T]> {
    let entry = &entry;
    (0..R).flat_map(|i| (i..R).map(move |j| entry(i, j))).collect()
}

/// An entry of a symmetric matrix of `R` rows, from those of its upper half.
#[inline(always)]
fn in_upper<T: Copy, const R: usize>(upper: &[T], i: usize, j: usize) -> T {
    let (i, j) = if i < j { (i, j) } else { (j, i) };
    upper[i * (2 * R - i - 1) / 2 + j]
}

impl<const P: usize, const E: usize, T: Number> StiffnessPack<P, E, T> {
    /// Packs several elements.
    pub fn gather<'a>(of: impl Fn(usize) -> &'a ShellStiffness<P, E>) -> Self {
        StiffnessPack {
            N: upper::<T, E>(|i, j| T::gather(|lane| of(lane).N[i][j])),
            M: upper::<T, P>(|i, j| T::gather(|lane| of(lane).M[i][j])),
        }
    }

    /// σ = C ε, membrane and bending.
    #[inline(always)]
    pub fn stress(&self, strain: &InPlane<P, E, T>) -> InPlane<P, E, T> {
        let (N, M) = (&self.N[..E * (E + 1) / 2], &self.M[..P * (P + 1) / 2]);
        let mut stress = InPlane::ZERO;
        // By columns of symmetric matrices: no sum waits for the one before.
        for i in 0..E {
            for j in 0..E {
                let C = in_upper::<T, E>(N, i, j);
                stress.membrane[j] = T::fma(C, strain.membrane[i], stress.membrane[j]);
            }
        }
        for i in 0..P {
            for j in 0..P {
                let C = in_upper::<T, P>(M, i, j);
                stress.bending[j] = T::fma(C, strain.bending[i], stress.bending[j]);
            }
        }
        stress
    }

    /// The whole matrices, without stress.
    #[inline(always)]
    pub fn linearised(&self) -> LinearisedPlane<P, E, T> {
        let (N, M) = (&self.N[..E * (E + 1) / 2], &self.M[..P * (P + 1) / 2]);
        let mut out = LinearisedPlane {
            stress: InPlane::ZERO,
            N: [[T::ZERO; E]; E],
            M: [[T::ZERO; P]; P],
            NM: [[T::ZERO; P]; E],
            coupled: false,
        };
        for i in 0..E {
            (0..E).for_each(|j| out.N[i][j] = in_upper::<T, E>(N, i, j));
        }
        for i in 0..P {
            (0..P).for_each(|j| out.M[i][j] = in_upper::<T, P>(M, i, j));
        }
        out
    }

    /// ½ ε·C ε of an element.
    fn energy(&self, lane: usize, strain: &InPlane<P, E>) -> f64 {
        let of = |x: f64| T::splat(x);
        let all = InPlane { membrane: strain.membrane.map(of), bending: strain.bending.map(of) };
        0.5 * strain.dot(&self.stress(&all).lane(lane))
    }
}

impl<const P: usize, const E: usize, T: Number> ShellSections<P, E, T> for StiffnessPack<P, E, T> {
    #[inline(always)]
    fn elastic(&self) -> &StiffnessPack<P, E, T> {
        self
    }

    #[inline(always)]
    fn stress(&self, strain: &InPlane<P, E, T>, _: &Configuration) -> InPlane<P, E, T> {
        StiffnessPack::stress(self, strain)
    }

    #[inline(always)]
    fn linearise(&self, strain: &InPlane<P, E, T>, _: &Configuration, _: Moduli) -> LinearisedPlane<P, E, T> {
        LinearisedPlane { stress: StiffnessPack::stress(self, strain), ..self.linearised() }
    }

    #[inline(always)]
    fn advance(&self, strain: &InPlane<P, E, T>, _: &Configuration, _: NewHistory<T>) -> InPlane<P, E, T> {
        StiffnessPack::stress(self, strain)
    }

    fn energy(&self, lane: usize, strain: &InPlane<P, E>, _: &Configuration) -> f64 {
        StiffnessPack::energy(self, lane, strain)
    }
}
