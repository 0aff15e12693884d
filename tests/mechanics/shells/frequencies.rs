//! Mass of shells: totals and momenta, and frequencies of plates from the assembled matrices.

use super::benchmarks::{kind_of, read};
use nalgebra::DMatrix;
use rdsolve::elements::Moduli;
use rdsolve::math::Vec3;
use rdsolve::model::Model;
use rdsolve::plan::Plan;
use rdsolve::state::{Configuration, Node};
use rdsolve::system::TangentWeights;
use rdsolve::system::{Excitation, Forces, Loading, Side, System};
use std::f64::consts::TAU;

/// A square plate of n by n elements, 10 by 10.
fn plate(n: usize, kind: &str, mass: &str, thickness: f64, supports: &str) -> Model {
    read(&format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = 1.0\ntime_step = 0.1\n[materials.m]\nmodel = \"elastic\"\n\
         youngs_modulus = 200e9\npoisson_ratio = 0.3\ndensity = 8000.0\n\
         [points]\na = [0.0, 0.0, 0.0]\nb = [10.0, 0.0, 0.0]\nc = [10.0, 10.0, 0.0]\nd = [0.0, 10.0, 0.0]\n\
         [[shells]]\nname = \"plate\"\ncorners = [\"a\", \"b\", \"c\", \"d\"]\nelements = {n}\n{}\n\
         thickness = {thickness:?}\nmaterial = \"m\"\nmass = \"{mass}\"\n{supports}",
        kind_of(kind)
    ))
}

/// The matrix of a step at rest: K for (1, 0), M for (0, 1).
fn matrix(model: &Model, stiffness: bool) -> DMatrix<f64> {
    let system = System::new(model).unwrap();
    let plan = Plan::new(model, &system, 1);
    let nodes: Vec<Node> = model.nodes.iter().map(|n| Node::at_rest(n.x)).collect();
    let mut loading = Loading::default();
    Excitation::new(model).loading(0.0, Side::After, &mut loading);
    let mut forces = Forces::new(&system, nodes.len());
    system.residual(&Configuration::of(&nodes), &loading, &mut forces);
    let (mut solver, mut assembly) = plan.build(&system).unwrap();
    let acceleration = if stiffness { 0.0 } else { 1.0 };
    let weights = TangentWeights { stiffness, rate: 0.0, acceleration, turning: None, moduli: Moduli::Algorithmic };
    assembly.tangent(&system, &Configuration::of(&nodes), &loading, &mut forces, weights, &mut solver);
    let n = plan.dofs.unknowns();
    // A symmetric solver stores one triangle under either name.
    DMatrix::from_fn(n, n, |i, j| solver.slot(i, j).map_or(0.0, |slot| solver.values()[slot]))
}

/// Frequencies in ascending order, Hz: of L⁻¹ K L⁻ᵀ with M = L Lᵀ.
fn frequencies(model: &Model) -> Vec<f64> {
    let (K, M) = (matrix(model, true), matrix(model, false));
    dense::eigenvalues(&dense::by_masses(&K, M)).iter().map(|s| s.max(0.0).sqrt() / TAU).collect()
}

/// In the plane nothing moves.
const FLAT: &str = "[[supports]]\nat = \"plate\"\nfix = [\"ux\", \"uy\", \"rz\"]\n";
const HINGED: &str =
    "[[supports]]\nat = [\"plate.edge1\", \"plate.edge2\", \"plate.edge3\", \"plate.edge4\"]\nfix = [\"uz\"]\n";

/// NAFEMS FV12: a free thin square plate. Modes 4 to 8 against the published frequencies, for both masses and both kinds.
#[test]
fn a_free_plate() {
    let published = [1.622, 2.360, 2.922, 4.190, 4.190];
    for (kind, mass, tolerance) in [
        ("quadrilateral", "lumped", 0.03),
        ("quadrilateral", "consistent", 0.03),
        ("triangle", "lumped", 0.03),
        ("triangle", "consistent", 0.03),
        ("quadrilateral2", "lumped", 0.01),
        ("quadrilateral2", "consistent", 0.01),
        ("triangle2", "lumped", 0.02),
        ("triangle2", "consistent", 0.01),
    ] {
        let n = if kind.ends_with('2') { 6 } else { 12 };
        let all = frequencies(&plate(n, kind, mass, 0.05, FLAT));
        println!("{kind} {mass}: {:.4?}", &all[..9]);
        assert!(all[..3].iter().all(|f| *f < 1e-2), "rigid motions: {:?}", &all[..3]);
        for (f, wanted) in all[3..8].iter().zip(published) {
            assert!((f / wanted - 1.0).abs() < tolerance, "{kind} {mass}: {f} {wanted}");
        }
    }
}

/// A hinged plate of h/L = 1/10 that lets its edges turn: Mindlin's frequency with rotary inertia is met to second order by
/// both masses. f of the wave numbers (1, 1): the lesser root of his equation for hinged edges.
#[test]
fn a_hinged_thick_plate_converges() {
    let (h, e, nu, rho): (f64, f64, f64, f64) = (1.0, 200e9, 0.3, 8000.0);
    let (g, d) = (0.5 * e / (1.0 + nu), e * h.powi(3) / (12.0 * (1.0 - nu * nu)));
    let k2 = 2.0 * (std::f64::consts::PI / 10.0).powi(2);
    // w, and the slope along the wave: ρh ω² w = S k (k w − ψ), I ω² ψ = D k² ψ − S (k w − ψ), S = 5/6 G h, I = ρ h³/12.
    let (s, m, i) = (5.0 / 6.0 * g * h, rho * h, rho * h.powi(3) / 12.0);
    let (b, c) = (s * k2 / m + (d * k2 + s) / i, s * k2 * d * k2 / (m * i));
    let exact = (0.5 * (b - (b * b - 4.0 * c).sqrt())).sqrt() / TAU;
    println!("exact {exact}"); // NAFEMS FV52, of solids: 45.897
    for kind in ["quadrilateral", "triangle"] {
        for mass in ["lumped", "consistent"] {
            // Hinges of the hard kind: no slope along the edge.
            let hard = "[[supports]]\nat = [\"plate.edge1\", \"plate.edge3\"]\nfix = [\"ry\"]\n[[supports]]\nat = [\"plate.edge2\", \"plate.edge4\"]\nfix = [\"rx\"]\n";
            let error = |n: usize| {
                let model = plate(n, kind, mass, h, &format!("{FLAT}{HINGED}{hard}"));
                (frequencies(&model)[0] / exact - 1.0).abs()
            };
            let errors = [4, 8].map(error);
            let order = (errors[0] / errors[1]).log2();
            println!("{kind} {mass}: {errors:?}, order {order:.2}");
            assert!(order > 1.7, "{kind} {mass}: {errors:?}");
            assert!(errors[1] < 0.04, "{kind} {mass}: {errors:?}");
        }
    }
}

/// Total mass by every direction, whichever the mass, also on distorted and curved patches: M on rigid translations; and the
/// rotary inertia of ρ h³/12 a unit of area.
#[test]
fn mass_is_that_of_the_plate() {
    for kind in ["quadrilateral", "triangle", "quadrilateral2", "triangle2"] {
        for mass in ["lumped", "consistent"] {
            let mut model = plate(3, kind, mass, 0.5, "");
            // The same area, distorted inside.
            let inner: Vec<usize> = (0..model.nodes.len())
                .filter(|&n| model.nodes[n].x.iter().take(2).all(|x| *x > 1.0 && *x < 9.0))
                .collect();
            for (k, n) in inner.into_iter().enumerate() {
                let far = if kind.ends_with('2') { 0.2 } else { 0.7 };
                model.nodes[n].x += far * Vec3::new((k as f64).sin(), (k as f64).cos(), 0.0);
            }
            let M = matrix(&model, false);
            let plan = Plan::new(&model, &System::new(&model).unwrap(), 1);
            let sum = |dof: usize| {
                let of = |k: usize| plan.dofs.nodal_dofs()[k].1 == dof;
                (0..M.nrows())
                    .filter(|&i| of(i))
                    .map(|i| (0..M.ncols()).filter(|&j| of(j)).map(|j| M[(i, j)]).sum::<f64>())
                    .sum::<f64>()
            };
            let whole = 8000.0 * 0.5 * 100.0;
            for dof in 0..3 {
                assert!((sum(dof) / whole - 1.0).abs() < 1e-12, "{kind} {mass} {dof}: {}", sum(dof)); // rounding
            }
            for dof in 3..6 {
                assert!((sum(dof) / (whole * 0.25 / 12.0) - 1.0).abs() < 1e-12, "{kind} {mass} {dof}: {}", sum(dof));
            }
            // Momentum and energy of a velocity that grows along x: exactly ∫ρ h (x/10)² with consistent mass.
            model.nodes.iter_mut().for_each(|n| n.v = Vec3::new(0.0, 0.0, 0.1 * n.x.x));
            let v: Vec<f64> = plan
                .dofs
                .nodal_dofs()
                .iter()
                .map(|&(n, dof)| if dof < 3 { model.nodes[n].v[dof] } else { 0.0 })
                .collect();
            let v = nalgebra::DVector::from_vec(v);
            let kinetic = 0.5 * v.dot(&(&M * &v));
            let exact = 0.5 * whole / 3.0;
            // Curved elements are not of the degree that the rule has.
            let bound = match (mass, kind.ends_with('2')) {
                ("consistent", false) => 1e-12,
                ("consistent", true) => 1e-5,
                _ => 0.1,
            };
            assert!((kinetic / exact - 1.0).abs() < bound, "{kind} {mass}: {kinetic} {exact}");
        }
    }
}
