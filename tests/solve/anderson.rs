//! Anderson acceleration of an iteration.

use rdsolve::solve::inner::Anderson;

/// As many mixed corrections as unknowns solve a linear problem; those of the plain iteration would shrink by 0.9 each.
#[test]
fn a_linear_problem_ends_after_as_many_corrections_as_unknowns() {
    let rates = [0.9, 0.5, -0.8, 0.1];
    let mut x = [1.0, -2.0, 0.5, 3.0];
    let mut anderson = Anderson::new([1.0, 10.0, 1.0, 0.1].into_iter());
    for _ in 0..6 {
        let mut f: Vec<f64> = x.iter().zip(&rates).map(|(x, rate)| (rate - 1.0) * x).collect();
        anderson.mix(&mut f);
        x.iter_mut().zip(&f).for_each(|(x, f)| *x += f);
    }
    // Rounding, times the condition of the differences.
    assert!(x.iter().all(|x| x.abs() < 1e-10), "{x:?}");
}
