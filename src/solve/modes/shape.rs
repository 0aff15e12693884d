//! Shapes of modes: motions of all nodes, scale, rigid-motion content, and distribution of energy.

use super::linearized::Linearized;
use super::mode::EigenMode;
use super::pencil::Pencil;
use super::shares::{Energies, energies};
use crate::system::Forces;
use crate::tolerances::shape::{ROUNDING, STILL};
use base::math::{Vec3, Vec6, angular, linear, stack};
use linear::eigen::{Complex, ComplexPair};
use mechanics::state::Node;
use std::f64::consts::TAU;

/// Common data of all modes of a state.
pub struct Shapes {
    /// M r over the unknowns for the six rigid motions r.
    rigid: [Vec<f64>; 6],
    /// As in [`super::Modes::masses`].
    pub masses: [f64; 6],
    /// Size of the scene.
    length: f64,
}

impl Shapes {
    /// The rigid motions of a state.
    pub fn new(pencil: &Pencil) -> Shapes {
        let (at, nodes) = (&pencil.at, &pencil.nodes);
        let mut forces = Forces::new(at.system, nodes.len());
        let mut inertia = |about: Vec3, axis: usize, turns: bool| {
            let e = Vec3::ith(axis, 1.0);
            let rigid = |node: &Node| match turns {
                true => stack(&e.cross(&(node.x - about)), &e),
                false => stack(&e, &Vec3::zeros()),
            };
            let mut motions = of_places(at, rigid);
            at.system.apply_mass(nodes, &mut motions, &mut forces);
            let mut force = vec![0.0; at.unknowns()];
            for (rows, f) in at.plan.dofs.each_node().iter().zip(&forces.on_nodes) {
                rows.scatter(&Vec6::from_row_slice(f), &mut force);
            }
            // Forces on dependent nodes have been transferred to their masters.
            let mut whole = Vec6::zeros();
            // Forces on amplitudes of modes are no forces in space.
            for (n, f) in forces.on_nodes.iter().enumerate().filter(|(n, _)| !at.model.nodes[*n].is_number) {
                let (f, m) = (Vec3::new(f[0], f[1], f[2]), Vec3::new(f[3], f[4], f[5]));
                whole += stack(&f, &(m + (nodes[n].x - about).cross(&f)));
            }
            (force, whole)
        };
        let origin = nodes.first().map_or(Vec3::zeros(), |node| node.x);
        let moved = [0, 1, 2].map(|axis| inertia(origin, axis, false));
        let part = |force: usize, moment: usize| {
            let whole = &moved[force].1;
            if whole[force] > 0.0 { whole[moment] / whole[force] } else { 0.0 }
        };
        let center = origin + Vec3::new(part(1, 5), part(2, 3), part(0, 4));
        let turned = [0, 1, 2].map(|axis| inertia(center, axis, true));
        let [x, y, z] = moved;
        let [rx, ry, rz] = turned;
        let masses = [x.1[0], y.1[1], z.1[2], rx.1[3], ry.1[4], rz.1[5]];
        let extent = nodes.iter().map(|node| (node.x - origin).norm()).fold(0.0, f64::max);
        let length = if extent > 0.0 { extent } else { 1.0 };
        Shapes { rigid: [x.0, y.0, z.0, rx.0, ry.0, rz.0], masses, length }
    }

    /// ω² of rigid motions caused by rounding.
    pub fn rounding(&self, pencil: &Pencil) -> f64 {
        let nodes = &pencil.nodes;
        let center = nodes.iter().map(|node| node.x).sum::<Vec3>() / nodes.len().max(1) as f64;
        let rigid = |k: usize| {
            let e = Vec3::ith(k % 3, 1.0);
            let motion = |node: &Node| match k > 2 {
                true => stack(&e.cross(&(node.x - center)), &e),
                false => stack(&e, &Vec3::zeros()),
            };
            of_places(&pencil.at, motion)
        };
        let shapes: Vec<Vec<Vec6>> = (0..6).map(rigid).collect();
        let energies = energies(&pencil.at, nodes, &shapes);
        let all = energies.iter().zip(self.masses).filter(|(_, mass)| *mass > 0.0);
        all.map(|(energies, mass)| ROUNDING * energies.without_signs / mass).fold(0.0, f64::max)
    }

    /// The modes of eigenvalues λ = ω² with vectors of modal mass 1.
    pub fn natural(&self, pencil: &Pencil, pairs: &[(f64, Vec<f64>)]) -> Vec<EigenMode> {
        let shapes: Vec<Vec<Vec6>> = pairs.iter().map(|(_, x)| pencil.at.motions(&pencil.nodes, x)).collect();
        let energies = energies(&pencil.at, &pencil.nodes, &shapes);
        let all = pairs.iter().zip(shapes).zip(energies);
        all.map(|(((lambda, vector), shape), energies)| self.natural_mode(*lambda, vector, shape, energies)).collect()
    }

    fn natural_mode(&self, lambda: f64, vector: &[f64], mut shape: Vec<Vec6>, energies: Energies) -> EigenMode {
        let Energies { parts, without_signs, is_stiff, .. } = energies;
        let rounding = ROUNDING * without_signs;
        let lost = (lambda.abs() <= rounding && is_stiff).then(|| rounding.sqrt() / TAU);
        let lambda = if lambda.abs() <= rounding { 0.0 } else { lambda };
        let scale = self.scale(&shape);
        shape.iter_mut().for_each(|motion| *motion *= scale);
        let root = if lambda < 0.0 { [(-lambda).sqrt(), 0.0] } else { [0.0, lambda.sqrt()] };
        let modal_mass = scale * scale;
        let participation = std::array::from_fn(|k| dot(&self.rigid[k], vector) / scale);
        let mut shares = parts;
        shares.iter_mut().for_each(|share| share.strain /= lambda);
        if lambda == 0.0 {
            shares.clear();
        }
        EigenMode {
            root,
            factor: None,
            shape,
            quadrature: Vec::new(),
            modal_mass,
            participation,
            shares,
            whirl: None,
            lost,
        }
    }

    /// The mode of a complex root and vector z = (φ, s φ).
    pub fn complex(&self, pencil: &Pencil, root: Complex, pair: &ComplexPair) -> EigenMode {
        let n = pencil.at.unknowns();
        let motions = |x: &[f64]| pencil.at.motions(&pencil.nodes, &x[..n]);
        let (a, b) = (motions(&pair.real), motions(&pair.imaginary));
        // The motion is the real part of (a + i b) e^(s t); the largest component defines the phase.
        let sizes = |of: &dyn Fn(&Vec6) -> Vec3| {
            let nodes = a.iter().zip(&b).map(|(a, b)| (of(a), of(b)));
            let size = |(a, b): &(Vec3, Vec3)| a.norm_squared() + b.norm_squared();
            let (a, b) = nodes.max_by(|x, y| size(x).total_cmp(&size(y))).unwrap_or_default();
            let axis = (a.component_mul(&a) + b.component_mul(&b)).imax();
            (size(&(a, b)).sqrt(), [a[axis], b[axis]])
        };
        let (moved, turned) = (sizes(&linear), sizes(&angular));
        let (size, [p, q]) = if moved.0 > STILL * turned.0 * self.length { moved } else { turned };
        let length = p.hypot(q).max(f64::MIN_POSITIVE) * size.max(f64::MIN_POSITIVE);
        let (p, q) = (p / length, -q / length);
        let shape: Vec<Vec6> = a.iter().zip(&b).map(|(a, b)| p * a - q * b).collect();
        // A quarter of a period later it is the real part of i (a + i b).
        let quadrature: Vec<Vec6> = a.iter().zip(&b).map(|(a, b)| -(q * a + p * b)).collect();
        let [Energies { parts: mut shares, .. }, Energies { parts: more, .. }] = of(pencil, [&shape, &quadrature]);
        shares.iter_mut().zip(more).for_each(|(share, more)| share.strain += more.strain);
        let whole: f64 = shares.iter().map(|share| share.strain).sum();
        shares.iter_mut().for_each(|share| share.strain /= whole);
        if root == [0.0; 2] || whole <= 0.0 || whole.is_nan() {
            shares.clear();
        }
        let participation = [0.0; 6];
        EigenMode {
            root,
            factor: None,
            shape,
            quadrature,
            modal_mass: 0.0,
            participation,
            shares,
            whirl: None,
            lost: None,
        }
    }

    /// The mode of buckling at a load factor, with a vector of strain energy ½.
    pub fn buckling(&self, pencil: &Pencil, factor: f64, vector: &[f64]) -> EigenMode {
        let mut shape = pencil.at.motions(&pencil.nodes, vector);
        let [Energies { parts: shares, .. }] = of(pencil, [&shape]);
        let scale = self.scale(&shape);
        shape.iter_mut().for_each(|motion| *motion *= scale);
        let (root, participation) = ([0.0; 2], [0.0; 6]);
        let lost = None;
        EigenMode {
            root,
            factor: Some(factor),
            shape,
            quadrature: Vec::new(),
            modal_mass: 0.0,
            participation,
            shares,
            whirl: None,
            lost,
        }
    }

    /// Factor that makes the largest displacement 1, or the largest rotation without displacements; the largest component becomes positive.
    pub fn scale(&self, shape: &[Vec6]) -> f64 {
        let most = |of: &dyn Fn(&Vec6) -> Vec3| {
            let largest = shape.iter().map(of).max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()));
            largest.map_or((0.0, 1.0), |vector| (vector.norm(), vector[vector.iamax()].signum()))
        };
        let ((moved, sign), (turned, sense)) = (most(&linear), most(&angular));
        match () {
            () if moved > STILL * turned * self.length => sign / moved,
            () if turned > 0.0 => sense / turned,
            () => 1.0,
        }
    }
}

/// The motions of nodes with a place; numbers stay.
fn of_places(at: &Linearized, motion: impl Fn(&Node) -> Vec6) -> Vec<Vec6> {
    let places = at.model.nodes.iter().zip(&at.state.nodes);
    places.map(|(node, now)| if node.is_number { Vec6::zeros() } else { motion(now) }).collect()
}

/// The energies of some shapes.
fn of<const N: usize>(pencil: &Pencil, shapes: [&Vec<Vec6>; N]) -> [Energies; N] {
    let mut all = energies(&pencil.at, &pencil.nodes, &shapes.map(Clone::clone)).into_iter();
    std::array::from_fn(|_| all.next().unwrap_or_default())
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
