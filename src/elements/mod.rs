//! Deformable parts and links. An element sees the motion of its nodes and hands over forces and their derivatives;
//! of bodies, constraints and schemes it knows nothing.

pub mod bar;
pub mod beam;
pub mod bushing;
pub mod contact;
pub mod link;
pub mod pressure;
pub mod shell;

use crate::materials::Dissipation;
use crate::math::{Mat3, Vec3};
use crate::state::Configuration;

/// Generalised force on a node: force and moment, global components.
pub type Force = [f64; 6];

/// Which moduli of the material a tangent is formed with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Moduli {
    /// The derivative of the stress that the step arrives at: K(ep) + K(σ).
    Algorithmic,
    /// K(e) + K(σ), whatever has yielded (11).
    Elastic,
}

/// A group of like elements. Matrices are row-major over the element's nodes, [`ElementBlock::dofs`] directions each.
pub trait ElementBlock: Send + Sync {
    fn len(&self) -> usize;
    fn is_empty(&self) -> bool {
        self.len() == 0
    }
    /// Nodes of element `e`.
    fn nodes(&self, e: usize) -> &[usize];
    /// 3: translations only; 6: translations and rotations.
    fn dofs(&self) -> usize;
    /// Numbers that the material points of all elements remember.
    fn history(&self) -> usize {
        0
    }
    /// Subtracts the internal forces of all elements from `F`, which is indexed by node.
    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]);
    /// Tangent of element `e`: K ← ∂f/∂(x, θ) + `rate_weight` · ∂f/∂(v, ω), f the internal force, θ spatial.
    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, moduli: Moduli, K: &mut [f64]);
    /// Writes what the material points will remember of `part` of the way from the last state to `now`, and returns what became
    /// of the work of plastic strains on it.
    fn update_history(&self, _now: &Configuration, _part: f64, _history: &mut [f64]) -> Dissipation {
        Dissipation::default()
    }
    /// Elastic energy stored.
    fn energy(&self, now: &Configuration) -> f64;
    /// Power that the damping of the elements takes (≥ 0), where there is any.
    fn damping_power(&self, _now: &Configuration) -> f64 {
        0.0
    }
    /// Integration points of an element at which [`ElementBlock::point`] has an answer.
    fn points(&self) -> usize {
        0
    }
    /// The state of an integration point, stress resultants in the axes of `frame` (columns, global at t = 0).
    fn point(&self, _e: usize, _point: usize, _frame: &Mat3, _now: &Configuration) -> Option<Point> {
        None
    }
    /// Stress resultants of a shell element whose nodes lay at `start`; axis 1 is `axis` laid into the surface at t = 0, or where
    /// it stands on the surface the global axis the farthest from it.
    fn resultants(&self, _e: usize, _axis: &Vec3, _start: &[Vec3], _now: &Configuration) -> Option<Resultants> {
        None
    }
    /// Largest accumulated plastic strain in element `e`.
    fn plastic_strain(&self, _e: usize, _past: &[f64]) -> f64 {
        0.0
    }
    /// True when the tangent never changes, whatever the motion.
    fn is_linear(&self) -> bool {
        false
    }
    /// The one direction in which an element acts, where it is fixed.
    fn fixed_direction(&self, _e: usize) -> Option<Vec3> {
        None
    }
    /// Whether element `e`, with six directions a node, acts on the rotations of its `node`-th.
    fn is_rotational(&self, _e: usize, _node: usize) -> bool {
        true
    }
    /// True where element `e` does nothing at this motion, and has no tangent.
    fn is_inactive(&self, _e: usize, _now: &Configuration) -> bool {
        false
    }
    /// The block as contacts, where it is one.
    fn as_contacts(&self) -> Option<&contact::Contacts> {
        None
    }
    /// True when the element resists or damps by rate.
    fn is_damped(&self) -> bool {
        false
    }
}

/// An integration point of an element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Distance from the element's start.
    pub s: f64,
    /// N, Q_y, Q_z, T, M_y, M_z.
    pub forces: [f64; 6],
    /// Largest accumulated plastic strain in the section.
    pub plastic_strain: f64,
}

/// What a shell element feels: means over its area, per length or area at t = 0, in axes that go with the surface. Moments
/// are positive where the top, the side of the normal, is in tension; ∂M₁₁/∂1 + ∂M₁₂/∂2 = Q₁.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resultants {
    /// Axis 1, axis 2 and the normal as they lie now; columns, global components.
    pub frame: Mat3,
    /// N₁₁, N₂₂, N₁₂.
    pub N: [f64; 3],
    /// M₁₁, M₂₂, M₁₂.
    pub M: [f64; 3],
    /// Q₁, Q₂.
    pub Q: [f64; 2],
    /// See [`Resultants::layers`].
    layers: [Layer; shell::MOST_LAYERS],
    count: usize,
}

impl Resultants {
    /// From the bottom up; none where the material is elastic.
    pub fn layers(&self) -> &[Layer] {
        &self.layers[..self.count]
    }

    /// Stress at the two surfaces of an elastic shell of thickness `h`, linear between them.
    pub(crate) fn surfaces(&mut self, h: f64) {
        let stress = |side: f64| std::array::from_fn(|i| self.N[i] / h + side * 6.0 * self.M[i] / (h * h));
        let layer = |side: f64| Layer { z: 0.5 * side * h, stress: stress(side), plastic_strain: 0.0 };
        (self.layers[0], self.layers[1]) = (layer(-1.0), layer(1.0));
        self.count = 2;
    }
}

/// Stress in a shell at a height above its reference surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Layer {
    pub z: f64,
    /// σ₁₁, σ₂₂, σ₁₂: means over the element.
    pub stress: [f64; 3],
    /// Largest accumulated one of the element.
    pub plastic_strain: f64,
}

impl Layer {
    /// Without transverse shear.
    pub fn von_mises(&self) -> f64 {
        let [a, b, ab] = self.stress;
        (a * a + b * b - a * b + 3.0 * ab * ab).sqrt()
    }
}

#[inline]
pub(crate) fn subtract(F: &mut Force, at: usize, f: &Vec3) {
    F[at] -= f.x;
    F[at + 1] -= f.y;
    F[at + 2] -= f.z;
}
