//! Which update of the matrix leads, by counts.

use rdsolve::solve::inner::CheaperUpdate;

/// Takes steps with these numbers of iterations and matrices, those of a reused matrix first. A matrix costs three iterations. Returns how many
/// steps had a fresh matrix in every iteration.
fn fresh_steps(counts: [[usize; 2]; 2], steps: usize) -> usize {
    let mut update = CheaperUpdate::new(3.0);
    let mut fresh = 0;
    for _ in 0..steps {
        fresh += usize::from(update.is_fresh());
        let [iterations, matrices] = counts[usize::from(update.is_fresh())];
        (0..iterations).for_each(|_| update.count_iteration());
        (0..matrices).for_each(|_| update.count_matrix());
        update.accepted(1e-3);
    }
    fresh
}

/// Eight iterations cost as much as two with a fresh matrix each, the least that a nonlinear step needs.
#[test]
fn a_reused_matrix_that_pays_is_kept() {
    assert_eq!(fresh_steps([[8, 0], [2, 2]], 1000), 0);
}

/// Trials of four steps follow turns of 4, 8, 16, 32 and 64 steps, and then turns of 64: 18 trials in 1000 steps.
#[test]
fn the_cheaper_update_leads_and_the_other_is_tried_ever_more_rarely() {
    let fresh = fresh_steps([[9, 3], [3, 3]], 1000);
    assert!(fresh > 900 && fresh < 1000, "{fresh}");
    let fresh = fresh_steps([[12, 1], [5, 5]], 1000);
    assert!(fresh > 0 && fresh < 100, "{fresh}");
}
