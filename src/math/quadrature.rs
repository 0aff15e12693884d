//! Gauss and Lobatto points on [−1, 1].

/// Points and weights of the n-point Gauss rule, n = 1..=5; exact to degree 2n − 1.
pub fn gauss(n: usize) -> (&'static [f64], &'static [f64]) {
    match n {
        1 => (&[0.0], &[2.0]),
        2 => (&[-0.577_350_269_189_625_8, 0.577_350_269_189_625_8], &[1.0, 1.0]),
        3 => (&[-0.774_596_669_241_483_4, 0.0, 0.774_596_669_241_483_4], &[5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0]),
        4 => (
            &[-0.861_136_311_594_052_6, -0.339_981_043_584_856_3, 0.339_981_043_584_856_3, 0.861_136_311_594_052_6],
            &[0.347_854_845_137_453_86, 0.652_145_154_862_546_1, 0.652_145_154_862_546_1, 0.347_854_845_137_453_86],
        ),
        5 => (
            &[-0.906_179_845_938_664, -0.538_469_310_105_683_1, 0.0, 0.538_469_310_105_683_1, 0.906_179_845_938_664],
            &[
                0.236_926_885_056_189_1,
                0.478_628_670_499_366_5,
                0.568_888_888_888_888_9,
                0.478_628_670_499_366_5,
                0.236_926_885_056_189_1,
            ],
        ),
        _ => unreachable!("no Gauss rule of {n} points is tabulated"),
    }
}

/// Points and weights of the n-point Lobatto rule (ends included), n = 2..=5; exact to degree 2n − 3.
pub fn lobatto(n: usize) -> (&'static [f64], &'static [f64]) {
    match n {
        2 => (&[-1.0, 1.0], &[1.0, 1.0]),
        3 => (&[-1.0, 0.0, 1.0], &[1.0 / 3.0, 4.0 / 3.0, 1.0 / 3.0]),
        4 => (
            &[-1.0, -0.447_213_595_499_957_9, 0.447_213_595_499_957_9, 1.0],
            &[1.0 / 6.0, 5.0 / 6.0, 5.0 / 6.0, 1.0 / 6.0],
        ),
        5 => (
            &[-1.0, -0.654_653_670_707_977_2, 0.0, 0.654_653_670_707_977_2, 1.0],
            &[0.1, 49.0 / 90.0, 32.0 / 45.0, 49.0 / 90.0, 0.1],
        ),
        _ => unreachable!("no Lobatto rule of {n} points is tabulated"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every rule integrates the monomials it claims to; the bound is a few units in the last place of the sum.
    #[test]
    fn rules_are_exact_to_their_degree() {
        let rules = (1..=5).map(|n| (gauss(n), 2 * n - 1)).chain((2..=5).map(|n| (lobatto(n), 2 * n - 3)));
        for ((points, weights), degree) in rules {
            for power in 0..=degree {
                let sum: f64 = points.iter().zip(weights).map(|(x, w)| w * x.powi(power as i32)).sum();
                let exact = if power % 2 == 0 { 2.0 / (power as f64 + 1.0) } else { 0.0 };
                assert!((sum - exact).abs() < 4e-15, "{} points, power {power}: {sum} for {exact}", points.len());
            }
        }
    }
}
