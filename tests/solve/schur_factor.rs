//! The factor of G M⁻¹ Gᵀ, dense and sparse.

use rdsolve::diagnostic::Source;
use rdsolve::model;
use rdsolve::solve::inner::{SchurFactor, SparseFactor};

/// A chain of joints: what the sparse factor solves is what the dense one solves, sharing and inert equations included.
#[test]
fn sparse_and_dense_agree() {
    let text = |bodies: usize| {
        let body = |k: usize| {
            format!(
                "[[bodies]]\nname = \"b{k}\"\ncenter = [{}, 0.0, 0.0]\nmass = 1.0\ninertia = [0.1, 0.1, 0.1]\n[[joints]]\n\
                 name = \"j{k}\"\nkind = \"revolute\"\naxis = [0.0, 1.0, 0.3]\nfrom = {}\n\
                 to = {{ body = \"b{k}\", point = [{k}.0, 0.0, 0.0] }}\n",
                k as f64 + 0.5,
                match k {
                    0 => "{ ground = [0.0, 0.0, 0.0] }".to_owned(),
                    _ => format!("{{ body = \"b{}\", point = [{k}.0, 0.0, 0.0] }}", k - 1),
                }
            )
        };
        let bodies: String = (0..bodies).map(body).collect();
        format!("[analysis]\nkind = \"dynamic\"\nend_time = 1.0\ntime_step = 0.1\n{bodies}")
    };
    let source = Source::new("chain.toml", text(7), &[]);
    let model = model::read(&source).0.unwrap();
    // Each joint of five equations moves the body before it and its own.
    let body = |k: usize| model.bodies[k].node;
    let rows: Vec<[Option<usize>; 2]> =
        (0..35).map(|row| [(row >= 5).then(|| body(row / 5 - 1)), Some(body(row / 5))]).collect();
    let rows: Vec<&[Option<usize>]> = rows.iter().map(|ends| &ends[..]).collect();
    let mut dense = SchurFactor::new(&[5; 7], &rows).unwrap();
    let mut sparse = SchurFactor::Sparse(SparseFactor::new(&[5; 7], &rows).unwrap());
    assert!(!dense.is_sparse());
    let mut inert = vec![false; 35];
    inert[11] = true;
    let entry = |k: usize, l: usize| match (k / 5).abs_diff(l / 5) {
        0 if k == l => 20.0 + k as f64,
        0 | 1 => ((k * l) as f64).sin(),
        _ => 0.0,
    };
    for raised in [[0.0; 35], [1e-6; 35]] {
        assert!(dense.factor(&inert, &raised, entry) && sparse.factor(&inert, &raised, entry));
        let given: Vec<f64> = (0..35).map(|i| (i as f64).cos()).collect();
        let solved = |factor: &mut SchurFactor| {
            let (mut x, mut rest) = (given.clone(), given.clone());
            factor.substitute(&mut x);
            factor.subtract_product(&x, &mut rest);
            [x, rest]
        };
        let [both, other] = [solved(&mut dense), solved(&mut sparse)];
        for (a, b) in both.iter().flatten().zip(other.iter().flatten()) {
            assert!((a - b).abs() < 1e-14, "{a} {b}"); // rounding of numbers near 1/20
        }
    }
    // What is not positive definite is refused by both.
    let flat = |_: usize, _: usize| 1.0;
    assert!(!dense.factor(&[false; 35], &[0.0; 35], flat) && !sparse.factor(&[false; 35], &[0.0; 35], flat));
}
