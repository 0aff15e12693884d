//! The central solutions of a section: stresses of a long beam far from its ends under each of six resultants, after Saint-Venant.
//!
//! Forces are constant along the beam and moments linear, so ψ and the warping u are linear. With E = ∫BᵀQB, R = ∫BᵀQZ, A = ∫ZᵀQZ (see
//! [`SectionTriangle`]) and resultants θ at the section, θ′ their growth:
//!
//! E u′ + R ψ′ = 0,  Rᵀu′ + A ψ′ = θ′
//! E u + R ψ = f(u′, ψ′),  Rᵀu + A ψ = θ − ∫ZᵀQSu′
//!
//! A shear strain of ψ is a tilt of u, so both shear strains of ψ are set to zero here. Warping as a rigid body has no strain: springs at four
//! unknowns hold it, and no force acts in them. The flexibility is the energy that pairs of solutions share.

use super::mesh::SectionMesh;
use base::math::{Mat6, Vec6};
use linear::{Factorization, Solver, Structure};
use mechanics::sections::section_triangle::{NodalWarping, SectionTriangle, WarpedState};
use nalgebra::{Matrix4, Vector4};

/// The strains of ψ that are unknown: along the beam, twist and curvatures.
const UNKNOWN: [usize; 4] = [0, 3, 4, 5];

/// Solutions for a unit of each force and moment along and about x, y and z.
pub(super) struct CentralSolutions {
    /// The triangles.
    triangles: Vec<SectionTriangle>,
    /// Strains ψ.
    strain: [Vec6; 6],
    /// Warping.
    warping: [Vec<f64>; 6],
    /// Rates of warping along the beam.
    rate: [Vec<f64>; 6],
}

/// A section without a factor: its memory is short, or a stiffness is zero.
pub(super) struct NoFactor;

impl CentralSolutions {
    /// Solves for the six resultants at the origin of the mesh. `triangles` are those of the mesh with their materials.
    ///
    /// # Errors
    /// The matrix has no factor.
    pub fn new(mesh: &SectionMesh, triangles: Vec<SectionTriangle>) -> Result<CentralSolutions, NoFactor> {
        let unknowns = 3 * mesh.nodes.len();
        let (mut solver, R, A) = factored(mesh, &triangles)?;
        let mut X = UNKNOWN.map(|k| R[k].clone());
        X.iter_mut().for_each(|column| solver.solve(column));
        let schur = Matrix4::from_fn(|i, j| A[(UNKNOWN[i], UNKNOWN[j])] - dot(&R[UNKNOWN[i]], &X[j]));
        let flexibility = schur.try_inverse().ok_or(NoFactor)?;
        let zero = || vec![0.0; unknowns];
        let mut all = CentralSolutions {
            triangles,
            strain: [Vec6::zeros(); 6],
            warping: [(); 6].map(|_| zero()),
            rate: [(); 6].map(|_| zero()),
        };
        for resultant in 0..6 {
            // M_y grows by F_z and M_z by −F_y.
            let growth = match resultant {
                1 => Vector4::new(0.0, 0.0, 0.0, -1.0),
                2 => Vector4::new(0.0, 0.0, 1.0, 0.0),
                _ => Vector4::zeros(),
            };
            let strain_growth = flexibility * growth;
            let rate = combined(&X, &-strain_growth);
            let (mut warping, whole) = all.of_growth(mesh, &rate, &spread(&strain_growth));
            if growth != Vector4::zeros() {
                solver.solve(&mut warping);
            }
            let known = Vec6::ith(resultant, 1.0) - whole;
            let known = Vector4::from_fn(|k, _| known[UNKNOWN[k]] - dot(&R[UNKNOWN[k]], &warping));
            let strain = flexibility * known;
            warping.iter_mut().zip(combined(&X, &-strain)).for_each(|(u, more)| *u += more);
            (all.strain[resultant], all.warping[resultant], all.rate[resultant]) = (spread(&strain), warping, rate);
        }
        Ok(all)
    }

    /// Forces on nodes and on ψ where ψ grows by `strain` and the warping by `rate` per length.
    fn of_growth(&self, mesh: &SectionMesh, rate: &[f64], strain: &Vec6) -> (Vec<f64>, Vec6) {
        let (mut forces, mut whole) = (vec![0.0; rate.len()], Vec6::zeros());
        for (triangle, nodes) in self.triangles.iter().zip(&mesh.triangles) {
            let growth = WarpedState { strain: *strain, warping: gathered(rate, nodes), rate: NodalWarping::zeros() };
            let (nodal, own) = triangle.forces_of_growth(&growth);
            nodes
                .iter()
                .enumerate()
                .for_each(|(k, node)| (0..3).for_each(|c| forces[3 * node + c] += nodal[3 * k + c]));
            whole += own;
        }
        (forces, whole)
    }

    /// The flexibility of the section: strains and curvatures from forces and moments.
    pub fn flexibility(&self, mesh: &SectionMesh) -> Mat6 {
        let each = self.triangles.iter().zip(&mesh.triangles);
        let all: Mat6 = each.map(|(triangle, nodes)| triangle.shared_energy(&self.states(nodes))).sum();
        0.5 * (all + all.transpose())
    }

    /// Stresses at the corners of a triangle under each unit resultant.
    pub fn corner_stresses(&self, mesh: &SectionMesh, triangle: usize) -> [[Vec6; 6]; 3] {
        let states = self.states(&mesh.triangles[triangle]);
        [0, 1, 2].map(|corner| states.map(|state| self.triangles[triangle].stress_at(corner, &state)))
    }

    fn states(&self, nodes: &[usize; 6]) -> [WarpedState; 6] {
        [0, 1, 2, 3, 4, 5].map(|k| WarpedState {
            strain: self.strain[k],
            warping: gathered(&self.warping[k], nodes),
            rate: gathered(&self.rate[k], nodes),
        })
    }
}

/// The factored stiffness of the warping with its springs, the matrix R by columns, and A.
fn factored(mesh: &SectionMesh, triangles: &[SectionTriangle]) -> Result<(Solver, [Vec<f64>; 6], Mat6), NoFactor> {
    let structure = Structure {
        sizes: vec![3; mesh.nodes.len()],
        connectivity: mesh.triangles.iter().map(|nodes| nodes.to_vec()).collect(),
        multipliers: 0,
        positions: mesh.nodes.iter().map(|[y, z]| [*y, *z, 0.0]).collect(),
    };
    let mut solver = Solver::new(&structure, Factorization::Cholesky, 1).map_err(|_| NoFactor)?;
    let mut R = [(); 6].map(|_| vec![0.0; 3 * mesh.nodes.len()]);
    let mut A = Mat6::zeros();
    let mut largest: f64 = 0.0;
    for (triangle, nodes) in triangles.iter().zip(&mesh.triangles) {
        let (E, of_motion, own) = triangle.stiffness();
        let row = |k: usize| 3 * nodes[k / 3] + k % 3;
        for (i, j) in (0..18).flat_map(|i| (0..18).map(move |j| (i, j))) {
            // A solver of symmetric matrices takes each pair once.
            if row(j) <= row(i) {
                let slot = solver.slot(row(i), row(j)).ok_or(NoFactor)?;
                solver.values()[slot] += E[(i, j)];
            }
        }
        for (i, k) in (0..18).flat_map(|i| (0..6).map(move |k| (i, k))) {
            R[k][row(i)] += of_motion[(i, k)];
        }
        A += own;
        largest = largest.max(E.diagonal().max());
    }
    for row in held(mesh) {
        let slot = solver.slot(row, row).ok_or(NoFactor)?;
        solver.values()[slot] += largest;
    }
    solver.factor().map_err(|_| NoFactor)?;
    Ok((solver, R, A))
}

/// Four unknowns that hold the warping against motions of a rigid body: a node, and the rotation by another far from it.
fn held(mesh: &SectionMesh) -> [usize; 4] {
    let [y, z] = mesh.nodes[0];
    let off = |node: &usize| (mesh.nodes[*node][0] - y).abs().max((mesh.nodes[*node][1] - z).abs());
    let far = (0..mesh.nodes.len()).max_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0);
    let is_along_y = (mesh.nodes[far][0] - y).abs() > (mesh.nodes[far][1] - z).abs();
    [0, 1, 2, 3 * far + if is_along_y { 2 } else { 1 }]
}

/// The warping of the nodes of a triangle.
fn gathered(all: &[f64], nodes: &[usize; 6]) -> NodalWarping {
    NodalWarping::from_fn(|k, _| all[3 * nodes[k / 3] + k % 3])
}

/// Strains ψ of which shear is zero.
fn spread(of: &Vector4<f64>) -> Vec6 {
    Vec6::new(of[0], 0.0, 0.0, of[1], of[2], of[3])
}

/// The sum of columns with factors.
fn combined(columns: &[Vec<f64>; 4], factors: &Vector4<f64>) -> Vec<f64> {
    (0..columns[0].len()).map(|row| (0..4).map(|k| factors[k] * columns[k][row]).sum()).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
