//! Elements that are shorter at the ends of a segment.

use rdsolve::model::inner::cuts;

/// Seven elements of grading 1/8 are as 1 : 2 : 4 : 8 : 4 : 2 : 1, six as 1 : √8 : 8 : 8 : √8 : 1, to rounding of sums of order one.
#[test]
fn lengths_grow_by_one_factor_towards_the_middle() {
    let lengths = |cuts: &[f64]| cuts.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<_>>();
    let root = 8.0_f64.sqrt();
    for (count, expected) in [
        (7, vec![1.0, 2.0, 4.0, 8.0, 4.0, 2.0, 1.0]),
        (6, vec![1.0, root, 8.0, 8.0, root, 1.0]),
        (3, vec![1.0, 8.0, 1.0]),
    ] {
        let whole: f64 = expected.iter().sum();
        let cuts = cuts(count, 0.125);
        assert_eq!((cuts[0], cuts[count], cuts.len()), (0.0, 1.0, count + 1));
        for (got, expected) in lengths(&cuts).iter().zip(&expected) {
            assert!((got - expected / whole).abs() < 4.0 * f64::EPSILON, "{count}: {got} {expected}");
        }
        for i in 0..=count {
            assert!((cuts[i] + cuts[count - i] - 1.0).abs() <= f64::EPSILON, "{count}: {cuts:?}");
        }
    }
}
