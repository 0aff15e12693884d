//! Modes against all eigenvalues of the same matrices, by a dense solver, and what the number of pivots tells.

use super::{head, modes, modes_of, omegas, outcome};
use crate::support::read_deck;
use nalgebra::DMatrix;
use rdsolve::elements::Moduli;
use rdsolve::linear::{Factorization, Solver, Sparse};
use rdsolve::model::Model;
use rdsolve::plan::Plan;
use rdsolve::solve::{Failure, Outcome};
use rdsolve::state::{Configuration, Node};
use rdsolve::system::assembly::Assembly;
use rdsolve::system::{Forces, Loading, System, TangentWeights};

/// K and M of a scene at rest, without loads.
fn matrices(model: &Model) -> [Sparse; 2] {
    let system = System::new(model).unwrap();
    let plan = Plan::new(model, &system, 1);
    let nodes: Vec<Node> = model.nodes.iter().map(|n| Node::at_rest(n.x)).collect();
    let loading = Loading { factors: vec![0.0; model.loading.nodal.len()], ..Loading::default() };
    let mut forces = Forces::new(&system, nodes.len());
    let now = Configuration::of(&nodes);
    system.residual(&now, &loading, &mut forces);
    let mut solver = Solver::new(&plan.structure, Factorization::Cholesky, 1).unwrap();
    let mut assembly = Assembly::new(&system, &plan.dofs, &solver, 1);
    [(true, 0.0), (false, 1.0)].map(|(stiffness, acceleration)| {
        let weights = TangentWeights { stiffness, rate: 0.0, acceleration, turning: None, moduli: Moduli::Elastic };
        assembly.unconstrained(&system, &now, &loading, &mut forces, weights, &mut solver);
        solver.matrix(plan.dofs.nodal_dofs().len())
    })
}

fn dense(sparse: &Sparse) -> DMatrix<f64> {
    let mut dense = DMatrix::zeros(sparse.rows(), sparse.rows());
    sparse.entries().for_each(|(i, j, value)| dense[(i, j)] += value);
    dense
}

/// All angular frequencies squared by L⁻¹ K L⁻ᵀ, M = L Lᵀ, ascending.
fn all(model: &Model) -> Vec<f64> {
    let [K, M] = matrices(model).each_ref().map(dense);
    dense::eigenvalues(&dense::by_masses(&K, M))
}

/// A cube of 3 by 3 by 3 posts and beams, each between neighbours, whose symmetry makes pairs and triples.
fn cube(analysis: &str, supports: &str) -> String {
    let mut text = head(analysis, 0.01, 0.01) + "[points]\n";
    let at = |i: [usize; 3]| format!("p{}{}{}", i[0], i[1], i[2]);
    let mut paths = Vec::new();
    for k in 0..27 {
        let i = [k % 3, k / 3 % 3, k / 9];
        text += &format!("{} = [{}.0, {}.0, {}.0]\n", at(i), i[0], i[1], i[2]);
        for axis in 0..3 {
            let mut next = i;
            next[axis] += 1;
            if next[axis] < 3 {
                paths.push((at(i), at(next), axis));
            }
        }
    }
    for (number, (a, b, axis)) in paths.iter().enumerate() {
        let orientation = ["[0.0, 1.0, 0.0]", "[0.0, 0.0, 1.0]", "[1.0, 0.0, 0.0]"][*axis];
        text += &format!(
            "[[beams]]\nname = \"b{number}\"\npath = [\"{a}\", \"{b}\"]\nelements = 1\nmaterial = \"steel\"\nsection = \"s\"\n\
             orientation = {orientation}\nmass = \"lumped\"\n"
        );
    }
    text + supports
}

/// Every one of the modes asked for, triples included, against a dense solver, whose error is 1e-15 of the largest eigenvalue.
#[test]
fn frames_with_pairs_and_triples() {
    for (supports, rigid) in
        [("", 6), ("[[supports]]\nat = [\"p000\", \"p200\", \"p020\", \"p220\"]\nfix = \"all\"\n", 0)]
    {
        let model = read_deck(&cube("modes = 40", supports));
        let dense = all(&model);
        let found = modes_of(&model);
        assert_eq!(found.list.len(), 40);
        for (k, (mode, exact)) in found.list.iter().zip(&dense).enumerate() {
            let squared = mode.angular_frequency().powi(2);
            if k < rigid {
                assert_eq!(squared, 0.0, "mode {k}: {exact:e}");
            } else {
                let digits = 4e-15 * dense[dense.len() - 1] + 1e-9 * exact;
                assert!((squared - exact).abs() < digits, "mode {k}: {squared} {exact}, {digits:e}");
            }
        }
        // Of the modes up to a frequency, none more and none less.
        let f = (0.5 * (dense[29] + dense[30])).sqrt() / std::f64::consts::TAU;
        if dense[30] / dense[29] > 1.0 + 1e-6 {
            let up_to = modes_of(&read_deck(&cube(&format!("up_to = {f:?}"), supports)));
            assert_eq!(up_to.list.len(), 30, "{supports}");
        }
        println!("{} solves, {} factorizations", found.solves, found.factorizations);
    }
}

/// A scene with fewer modes than are asked for has all of them found: a mass on three springs.
#[test]
fn fewer_than_asked() {
    let text = "[analysis]\nkind = \"modal\"\nmodes = 9\n[points]\na = [0.0, 0.0, 0.0]\nx = [1.0, 0.0, 0.0]\ny = [0.0, 1.0, 0.0]\n\
                z = [0.0, 0.0, 1.0]\n[[masses]]\nat = \"a\"\nmass = 2.0\n[[supports]]\nat = [\"x\", \"y\", \"z\"]\nfix = \"all\"\n";
    let link = |to: &str, k: f64| {
        format!(
            "[[links]]\nname = \"{to}{to}\"\nfrom = {{ node = \"a\" }}\nto = {{ node = \"{to}\" }}\nlaw = \"linear\"\nstiffness = {k:?}\n"
        )
    };
    let found = modes(&(text.to_owned() + &link("x", 2.0) + &link("y", 8.0) + &link("z", 18.0)));
    let omegas = omegas(&found);
    assert_eq!(omegas.len(), 3, "{omegas:?}");
    assert!(super::off(&omegas, &[1.0, 2.0, 3.0]) < 1e-12, "{omegas:?}");
    // Each link holds all the energy of its mode.
    for (k, mode) in found.list.iter().enumerate() {
        assert_eq!(mode.shares.len(), 3);
        assert!((mode.shares[k].strain - 1.0).abs() < 1e-9, "{:?}", mode.shares);
    }
}

/// What has no mass has no modes.
#[test]
fn without_mass() {
    let text = head("", 0.1, 0.1)
        + "[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n[[beams]]\nname = \"arm\"\npath = [\"a\", \"b\"]\nelements = 1\n\
           material = \"steel\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\nmass = \"none\"\n[[supports]]\nat = \"a\"\nfix = \"all\"\n";
    let (outcome, _) = outcome(&read_deck(&text));
    let Outcome::Failed { failure: Failure::Modes(fault), .. } = outcome else { panic!("{outcome:?}") };
    assert_eq!(fault, rdsolve::modes::ModesFault::NoMass);
}
