//! Quadrature on [−1, 1]: the rules of Gauss and Lobatto, and those for stresses with kinks.

/// Points and weights of the n-point Gauss rule for n = 1..=10, exact to degree 2n − 1.
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
        6 => (
            &[
                -0.932_469_514_203_152,
                -0.661_209_386_466_264_5,
                -0.238_619_186_083_196_9,
                0.238_619_186_083_196_9,
                0.661_209_386_466_264_5,
                0.932_469_514_203_152,
            ],
            &[
                0.171_324_492_379_170_34,
                0.360_761_573_048_138_6,
                0.467_913_934_572_691_05,
                0.467_913_934_572_691_05,
                0.360_761_573_048_138_6,
                0.171_324_492_379_170_34,
            ],
        ),
        7 => (
            &[
                -0.949_107_912_342_758_5,
                -0.741_531_185_599_394_4,
                -0.405_845_151_377_397_2,
                0.0,
                0.405_845_151_377_397_2,
                0.741_531_185_599_394_4,
                0.949_107_912_342_758_5,
            ],
            &[
                0.129_484_966_168_869_7,
                0.279_705_391_489_276_64,
                0.381_830_050_505_118_9,
                0.417_959_183_673_469_4,
                0.381_830_050_505_118_9,
                0.279_705_391_489_276_64,
                0.129_484_966_168_869_7,
            ],
        ),
        8 => (
            &[
                -0.960_289_856_497_536_3,
                -0.796_666_477_413_626_7,
                -0.525_532_409_916_329,
                -0.183_434_642_495_649_8,
                0.183_434_642_495_649_8,
                0.525_532_409_916_329,
                0.796_666_477_413_626_7,
                0.960_289_856_497_536_3,
            ],
            &[
                0.101_228_536_290_376_26,
                0.222_381_034_453_374_48,
                0.313_706_645_877_887_27,
                0.362_683_783_378_362,
                0.362_683_783_378_362,
                0.313_706_645_877_887_27,
                0.222_381_034_453_374_48,
                0.101_228_536_290_376_26,
            ],
        ),
        9 => (
            &[
                -0.968_160_239_507_626_1,
                -0.836_031_107_326_635_8,
                -0.613_371_432_700_590_4,
                -0.324_253_423_403_808_9,
                0.0,
                0.324_253_423_403_808_9,
                0.613_371_432_700_590_4,
                0.836_031_107_326_635_8,
                0.968_160_239_507_626_1,
            ],
            &[
                0.081_274_388_361_574_41,
                0.180_648_160_694_857_4,
                0.260_610_696_402_935_44,
                0.312_347_077_040_002_86,
                0.330_239_355_001_259_8,
                0.312_347_077_040_002_86,
                0.260_610_696_402_935_44,
                0.180_648_160_694_857_4,
                0.081_274_388_361_574_41,
            ],
        ),
        10 => (
            &[
                -0.973_906_528_517_171_7,
                -0.865_063_366_688_984_5,
                -0.679_409_568_299_024_4,
                -0.433_395_394_129_247_2,
                -0.148_874_338_981_631_22,
                0.148_874_338_981_631_22,
                0.433_395_394_129_247_2,
                0.679_409_568_299_024_4,
                0.865_063_366_688_984_5,
                0.973_906_528_517_171_7,
            ],
            &[
                0.066_671_344_308_688_14,
                0.149_451_349_150_580_6,
                0.219_086_362_515_982_04,
                0.269_266_719_309_996_35,
                0.295_524_224_714_752_87,
                0.295_524_224_714_752_87,
                0.269_266_719_309_996_35,
                0.219_086_362_515_982_04,
                0.149_451_349_150_580_6,
                0.066_671_344_308_688_14,
            ],
        ),
        _ => unreachable!("no Gauss rule of {n} points is tabulated"),
    }
}

/// Places and weights.
type Rule = (&'static [f64], &'static [f64]);

/// The rules of [`kinked`].
const KINKED: [Rule; 6] = [
    (
        &[-0.867_54, -0.507_32, -0.15, 0.15, 0.507_32, 0.867_54],
        &[
            0.309_345_067_109_625_9,
            0.361_78,
            0.328_874_932_890_374_1,
            0.328_874_932_890_374_1,
            0.361_78,
            0.309_345_067_109_625_9,
        ],
    ),
    (
        &[-0.886_84, -0.57, -0.275_81, 0.0, 0.275_81, 0.57, 0.886_84],
        &[
            0.268_410_338_289_885_4,
            0.309_22,
            0.286_14,
            0.272_459_323_420_229_1,
            0.286_14,
            0.309_22,
            0.268_410_338_289_885_4,
        ],
    ),
    (
        &[-0.902_68, -0.630_5, -0.371_29, -0.123_8, 0.123_8, 0.371_29, 0.630_5, 0.902_68],
        &[
            0.230_741_471_238_671_84,
            0.267_03,
            0.256_82,
            0.245_408_528_761_328_15,
            0.245_408_528_761_328_15,
            0.256_82,
            0.267_03,
            0.230_741_471_238_671_84,
        ],
    ),
    (
        &[-0.912_41, -0.679_4, -0.446_08, -0.21, 0.0, 0.21, 0.446_08, 0.679_4, 0.912_41],
        &[
            0.202_607_990_367_139_4,
            0.233_72,
            0.235_17,
            0.226_45,
            0.204_104_019_265_721_2,
            0.226_45,
            0.235_17,
            0.233_72,
            0.202_607_990_367_139_4,
        ],
    ),
    (
        &[-0.925_5, -0.714_21, -0.501_76, -0.286_09, -0.086_11, 0.086_11, 0.286_09, 0.501_76, 0.714_21, 0.925_5],
        &[
            0.176_364_358_082_451_13,
            0.215_51,
            0.214_853_384_985_375_54,
            0.205_95,
            0.187_322_256_932_173_33,
            0.187_322_256_932_173_33,
            0.205_95,
            0.214_853_384_985_375_54,
            0.215_51,
            0.176_364_358_082_451_13,
        ],
    ),
    (
        &[
            -0.932_56, -0.753_94, -0.575_07, -0.421_48, -0.240_25, -0.069_79, 0.069_79, 0.240_25, 0.421_48, 0.575_07,
            0.753_94, 0.932_56,
        ],
        &[
            0.155_876_003_635_471_72,
            0.179_05,
            0.168_931_215_055_858_26,
            0.164_27,
            0.176_57,
            0.155_302_781_308_67,
            0.155_302_781_308_67,
            0.176_57,
            0.164_27,
            0.168_931_215_055_858_26,
            0.179_05,
            0.155_876_003_635_471_72,
        ],
    ),
];

/// `n` points in two-point Gauss pairs side by side, n even: places, and weights that sum to 2.
pub fn pairs(n: usize) -> impl Iterator<Item = (f64, f64)> + Clone {
    let share = 2.0 / n as f64;
    (0..n / 2).flat_map(move |cell| {
        let middle = share * (2 * cell + 1) as f64 - 1.0;
        [-1.0, 1.0].map(|side| (middle + side * share / 3f64.sqrt(), share))
    })
}

/// Places and weights across the depth of a yielding section, whose stress has kinks. n is an entry of the table, or even: then [`pairs`]
/// is used.
///
/// Sums of weights, w z² and, with 10 and 12 points, w |z| are exact: area, elastic and plastic moment. Places and weights make the
/// largest error of M(κ) of an ideally plastic rectangle least, with axial forces from 0 to 0.6 N_p. Errors in parts of the plastic moment,
/// at the worst and, over cycles, at the median of 60 histories of eight reversals:
///
/// | points | 6 | 7 | 8 | 9 | 10 | 12 | 16, pairs | 20, pairs | 24, pairs |
/// |---|---|---|---|---|---|---|---|---|---|
/// | first bending | 1.9 % | 1.4 % | 1.0 % | 0.8 % | 0.7 % | 0.5 % | 0.33 % | 0.21 % | 0.15 % |
/// | with axial force | 2.0 % | 1.45 % | 1.1 % | 0.9 % | 0.8 % | 0.5 % | 0.3 % | 0.3 % | |
/// | cycles, worst | 11 % | | 5.5 % | | 4.6 % | 2.4 % | 2.1 % | 1.1 % | 0.7 % |
/// | cycles, median | 5.4 % | | 2.7 % | | 1.9 % | 1.3 % | 0.9 % | 0.5 % | 0.4 % |
///
/// Five points of Gauss err by 5.4 % in first bending and by up to 14 % over cycles, ten by 1.5 and 4.8 %.
pub fn kinked(n: usize) -> Vec<(f64, f64)> {
    match KINKED.into_iter().find(|(points, _)| points.len() == n) {
        Some((points, weights)) => points.iter().copied().zip(weights.iter().copied()).collect(),
        None => pairs(n).collect(),
    }
}

/// Points and weights of the n-point Lobatto rule, which includes the ends, for n = 2..=5; exact to degree 2n − 3.
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

/// The values at ξ of the polynomials that are one at one of the `nodes` and zero at the others.
pub fn lagrange(nodes: &[f64], xi: f64) -> Vec<f64> {
    let others = |a: usize| (0..nodes.len()).filter(move |&b| b != a);
    (0..nodes.len()).map(|a| others(a).map(|b| (xi - nodes[b]) / (nodes[a] - nodes[b])).product()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every rule integrates the monomials it claims to; the bound is a few units in the last place of the sum.
    #[test]
    fn rules_are_exact_to_their_degree() {
        let rules = (1..=10).map(|n| (gauss(n), 2 * n - 1)).chain((2..=5).map(|n| (lobatto(n), 2 * n - 3)));
        for ((points, weights), degree) in rules {
            for power in 0..=degree {
                let sum: f64 = points.iter().zip(weights).map(|(x, w)| w * x.powi(power as i32)).sum();
                let exact = if power % 2 == 0 { 2.0 / (power as f64 + 1.0) } else { 0.0 };
                assert!((sum - exact).abs() < 4e-15, "{} points, power {power}: {sum} for {exact}", points.len());
            }
        }
    }

    /// Area, elastic moment and, where the rule says so, plastic moment are exact; the bound is a few units in the last place.
    #[test]
    fn rules_for_kinks_keep_elastic_and_plastic_moments() {
        for n in [6, 7, 8, 9, 10, 12] {
            let rule = kinked(n);
            let sum = |of: fn(f64) -> f64| rule.iter().map(|&(z, w)| w * of(z)).sum::<f64>();
            let sums = [(sum(|_| 1.0), 2.0), (sum(|z| z), 0.0), (sum(|z| z * z), 2.0 / 3.0)];
            for (sum, exact) in sums {
                assert!((sum - exact).abs() < 1e-15, "{n} points: {sum} for {exact}");
            }
            let plastic = sum(f64::abs);
            assert!((plastic - 1.0).abs() < if n >= 10 { 1e-15 } else { 0.014 }, "{n} points: {plastic}");
        }
    }

    /// Moment of an ideally plastic section of depth 2 at a curvature κ and the axial force N, with E = yield strain = 1.
    fn moment(rule: &[(f64, f64)], kappa: f64, N: f64) -> f64 {
        let at = |strain: f64, of: fn(f64) -> f64| -> f64 {
            rule.iter().map(|&(z, w)| w * of(z) * (strain + kappa * z).clamp(-1.0, 1.0)).sum()
        };
        let (mut low, mut high) = (-1.0 - kappa, 1.0 + kappa);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if at(middle, |_| 1.0) < N { low = middle } else { high = middle }
        }
        at(low, |z| z)
    }

    /// M(κ) against 50 pairs, whose own error is 0.33 % (16/100)² = 8e-5: the bounds of the table.
    #[test]
    fn rules_for_kinks_follow_moments_of_yielding_sections() {
        let fine: Vec<_> = pairs(100).collect();
        let bounds = [
            (6, [0.019, 0.020]),
            (7, [0.014, 0.0145]),
            (8, [0.0103, 0.011]),
            (9, [0.008, 0.009]),
            (10, [0.0069, 0.008]),
            (12, [0.0047, 0.005]),
            (16, [0.0033, 0.0033]),
            (24, [0.0015, 0.0015]),
        ];
        for (n, bounds) in bounds {
            for axial in [0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2] {
                let bound = bounds[usize::from(axial > 0.0)];
                for i in 1..60 {
                    let kappa = 0.5 * 1.07f64.powi(i);
                    let off = moment(&kinked(n), kappa, axial) - moment(&fine, kappa, axial);
                    assert!(off.abs() < bound + 1e-4, "{n} points, N = {axial}, curvature {kappa}: {off}");
                }
            }
        }
    }

    /// The largest error of M(κ) over cycles of a fixed amplitude of κ, against 500 pairs, whose own error is below 1e-5.
    fn error_over_cycles(rule: &[(f64, f64)], amplitude: f64) -> f64 {
        let fine: Vec<_> = pairs(1000).collect();
        let moments = |rule: &[(f64, f64)]| -> Vec<f64> {
            let mut plastic = vec![0.0; rule.len()];
            let way = (0..1000).map(|i| amplitude * (std::f64::consts::TAU * f64::from(i) / 400.0).sin());
            way.map(|kappa| {
                let stress = |(&(z, w), plastic): (&(f64, f64), &mut f64)| {
                    let stress = (kappa * z - *plastic).clamp(-1.0, 1.0);
                    *plastic = kappa * z - stress;
                    w * z * stress
                };
                rule.iter().zip(&mut plastic).map(stress).sum()
            })
            .collect()
        };
        moments(rule).iter().zip(moments(&fine)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    /// Cycles of a fixed amplitude, in parts of the plastic moment: the bounds that docs/limits.md states.
    #[test]
    fn rules_for_kinks_over_cycles() {
        for (n, bound) in [(8, 0.029), (12, 0.0135), (16, 0.0092), (24, 0.0034)] {
            let rule = kinked(n);
            let errors = [1.3, 2.0, 3.0, 5.0, 8.0].map(|amplitude| error_over_cycles(&rule, amplitude));
            let worst = errors.into_iter().fold(0.0, f64::max);
            assert!(worst < bound, "{n} points: {errors:?}");
        }
    }
}
