//! Explicit Runge-Kutta schemes of Dormand and Prince, of order 8 and 5, each with embedded ones that tell the error of a step. The
//! unknowns are y = (q, v), with q the increment of the step including its rotation vector, ẏ = (T⁻¹ v, M⁻¹ r). For scenes that are not
//! stiff: bodies on soft links, tops, mechanisms. Inside a step the motion is known to order 7 and 4. P. J. Prince, J. R. Dormand, J. Comput. Appl. Math. 7 (1981); E. Hairer, S. P. Nørsett,
//! G. Wanner, Solving Ordinary Differential Equations I (1993), II.5 and II.10, whence the coefficients; they are proved by the order
//! conditions below.

#![allow(clippy::excessive_precision)] // as published

use std::sync::Arc;

use super::coefficients::Coefficients;
use super::scheme::{MakeScheme, Scheme, SchemeKind, Stepping};
use super::tableau::{StepPolynomial, Tableau};
use base::math::rotation::RotationUpdate;
use base::words::kinds::{Form, Key};

/// The scheme's word, keys and maker.
pub static KIND: SchemeKind = SchemeKind {
    word: "runge-kutta",
    aliases: &[],
    guesses: &["rk4", "rk45", "dopri5", "dopri853", "dormand-prince", "ode45"],
    about: "Dormand and Prince, explicit, of high order: for scenes that are not stiff. It does not take material that yields.",
    keys: &[Key {
        name: "order",
        form: Form::Count,
        about: "Order of the error in the time step, 5 or 8. Default: 8.",
    }],
    make: MakeScheme {
        scheme: |given, _| {
            let order = given.number("order").unwrap_or(8.0);
            let scheme = RungeKutta::of_order(order as usize);
            if scheme.is_none() {
                given.error_with::<()>("order", format!("there is no Runge-Kutta scheme of order {order}"), "5 or 8");
            }
            Arc::new(scheme.unwrap_or_default())
        },
        rotation_update: false,
    },
};

/// An explicit Runge-Kutta scheme of Dormand and Prince.
#[derive(Debug, Clone, PartialEq)]
pub struct RungeKutta {
    /// Its coefficients.
    pub tableau: &'static Tableau,
}

impl RungeKutta {
    /// `None`: there is none of that order.
    pub fn of_order(order: usize) -> Option<RungeKutta> {
        let tableau = [&DORMAND_PRINCE_8, &DORMAND_PRINCE_5].into_iter().find(|tableau| tableau.order == order)?;
        Some(RungeKutta { tableau })
    }
}

impl Default for RungeKutta {
    fn default() -> Self {
        RungeKutta { tableau: &DORMAND_PRINCE_8 }
    }
}

impl Scheme for RungeKutta {
    fn word(&self) -> &'static str {
        KIND.word
    }

    fn in_words(&self) -> String {
        format!("{} of order {}", KIND.word, self.tableau.order)
    }

    fn note(&self) -> Option<&'static str> {
        Some("explicit: stiff models need very short steps; an implicit scheme is then faster")
    }

    fn order(&self) -> usize {
        self.tableau.order
    }

    fn stepping(&self) -> Stepping<'_> {
        Stepping::RungeKutta(self.tableau)
    }

    fn coefficients(&self, dt: f64) -> Coefficients {
        Coefficients::verlet(dt, RotationUpdate::Exponential)
    }
}

/// Order 8 with 12 evaluations a step.
pub static DORMAND_PRINCE_8: Tableau = Tableau {
    order: 8,
    c: &[
        0.0526001519587677318785587544488,
        0.0789002279381515978178381316732,
        0.118350341907227396726757197510,
        0.281649658092772603273242802490,
        1.0 / 3.0,
        0.25,
        4.0 / 13.0,
        127.0 / 195.0,
        0.6,
        6.0 / 7.0,
        1.0,
    ],
    a: &[
        &[(0, 0.0526001519587677318785587544488)],
        &[(0, 0.0197250569845378994544595329183), (1, 0.0591751709536136983633785987549)],
        &[(0, 0.0295875854768068491816892993775), (2, 0.0887627564304205475450678981324)],
        &[
            (0, 0.241365134159266685502369798665),
            (2, -0.884549479328286085344864962717),
            (3, 0.924834003261792003115737966543),
        ],
        &[(0, 1.0 / 27.0), (3, 0.170828608729473871279604482173), (4, 0.125467687566822425016691814123)],
        &[
            (0, 19.0 / 512.0),
            (3, 0.170252211019544039314978060272),
            (4, 0.0602165389804559606850219397283),
            (5, -9.0 / 512.0),
        ],
        &[
            (0, 0.0370920001185047927108779319836),
            (3, 0.170383925712239993810214054705),
            (4, 0.107262030446373284651809199168),
            (5, -0.0153194377486244017527936158236),
            (6, 0.00827378916381402288758473766002),
        ],
        &[
            (0, 0.624110958716075717114429577812),
            (3, -3.36089262944694129406857109825),
            (4, -0.868219346841726006818189891453),
            (5, 27.5920996994467083049415600797),
            (6, 20.1540675504778934086186788979),
            (7, -43.4898841810699588477366255144),
        ],
        &[
            (0, 0.477662536438264365890433908527),
            (3, -2.48811461997166764192642586468),
            (4, -0.590290826836842996371446475743),
            (5, 21.2300514481811942347288949897),
            (6, 15.2792336328824235832596922938),
            (7, -33.2882109689848629194453265587),
            (8, -0.0203312017085086261358222928593),
        ],
        &[
            (0, -0.93714243008598732571704021658),
            (3, 5.18637242884406370830023853209),
            (4, 1.09143734899672957818500254654),
            (5, -8.14978701074692612513997267357),
            (6, -18.5200656599969598641566180701),
            (7, 22.7394870993505042818970056734),
            (8, 2.49360555267965238987089396762),
            (9, -3.0467644718982195003823669022),
        ],
        &[
            (0, 2.27331014751653820792359768449),
            (3, -10.5344954667372501984066689879),
            (4, -2.00087205822486249909675718444),
            (5, -17.9589318631187989172765950534),
            (6, 27.9488845294199600508499808837),
            (7, -2.85899827713502369474065508674),
            (8, -8.87285693353062954433549289258),
            (9, 12.3605671757943030647266201528),
            (10, 0.643392746015763530355970484046),
        ],
    ],
    b: &[
        (0, 0.0542937341165687622380535766363),
        (5, 4.45031289275240888144113950566),
        (6, 1.89151789931450038304281599044),
        (7, -5.8012039600105847814672114227),
        (8, 0.31116436695781989440891606237),
        (9, -0.152160949662516078556178806805),
        (10, 0.201365400804030348374776537501),
        (11, 0.0447106157277725905176885569043),
    ],
    errors: &[
        // The differences are those to the scheme of order 5.
        &[
            (0, 0.01312004499419488073250102996),
            (5, -1.225156446376204440720569753),
            (6, -0.4957589496572501915214079952),
            (7, 1.664377182454986536961530415),
            (8, -0.3503288487499736816886487290),
            (9, 0.3341791187130174790297318841),
            (10, 0.08192320648511571246570742613),
            (11, -0.02235530786388629525884427845),
        ],
        // The differences are those to the scheme of order 3.
        &[
            (0, 0.0542937341165687622380535766363 - 0.244094488188976377952755905512),
            (5, 4.45031289275240888144113950566),
            (6, 1.89151789931450038304281599044),
            (7, -5.8012039600105847814672114227),
            (8, 0.31116436695781989440891606237 - 0.733846688281611857341361741547),
            (9, -0.152160949662516078556178806805),
            (10, 0.201365400804030348374776537501),
            (11, 0.0447106157277725905176885569043 - 0.0220588235294117647058823529412),
        ],
    ],
    error_order: 8.0,
    inside: StepPolynomial {
        c: &[0.1, 0.2, 7.0 / 9.0],
        a: &[
            &[
                (0, 0.0561675022830479523392909219681),
                (6, 0.253500210216624811088794765333),
                (7, -0.246239037470802489917441475441),
                (8, -0.124191423263816360469010140626),
                (9, 0.15329179827876569731206322685),
                (10, 0.00820105229563468988491666602057),
                (11, 0.00756789766054569976138603589584),
                (12, -0.008298),
            ],
            &[
                (0, 0.0318346481635021405060768473261),
                (5, 0.0283009096723667755288322961402),
                (6, 0.0535419883074385676223797384372),
                (7, -0.0549237485713909884646569340306),
                (10, -0.000108347328697249322858509316994),
                (11, 0.000382571090835658412954920192323),
                (12, -0.000340465008687404560802977114492),
                (13, 0.141312443674632500278074618366),
            ],
            &[
                (0, -0.428896301583791923408573538692),
                (5, -4.69762141536116384314449447206),
                (6, 7.68342119606259904184240953878),
                (7, 4.06898981839711007970213554331),
                (8, 0.356727187455281109270669543021),
                (12, -0.00139902416515901462129418009734),
                (13, 2.9475147891527723389556272149),
                (14, -9.15095847217987001081870187138),
            ],
        ],
        bubbles: &[
            &[
                (0, -8.4289382761090128651353491142),
                (5, 0.56671495351937776962531783590),
                (6, -3.0689499459498916912797304727),
                (7, 2.3846676565120698287728149680),
                (8, 2.1170345824450282767155149946),
                (9, -0.87139158377797299206789907490),
                (10, 2.2404374302607882758541771650),
                (11, 0.63157877876946881815570249290),
                (12, -0.088990336451333310820698117400),
                (13, 18.148505520854727256656404962),
                (14, -9.1946323924783554000451984436),
                (15, -4.4360363875948939664310572000),
            ],
            &[
                (0, 10.427508642579134603413151009),
                (5, 242.28349177525818288430175319),
                (6, 165.20045171727028198505394887),
                (7, -374.54675472269020279518312152),
                (8, -22.113666853125306036270938578),
                (9, 7.7334326684722638389603898808),
                (10, -30.674084731089398182061213626),
                (11, -9.3321305264302278729567221706),
                (12, 15.697238121770843886131091075),
                (13, -31.139403219565177677282850411),
                (14, -9.3529243588444783865713862664),
                (15, 35.816841486394083752465898540),
            ],
            &[
                (0, 19.985053242002433820987653617),
                (5, -387.03730874935176555105901742),
                (6, -189.17813819516756882830838328),
                (7, 527.80815920542364900561016686),
                (8, -11.573902539959630126141871134),
                (9, 6.8812326946963000169666922661),
                (10, -1.0006050966910838403183860980),
                (11, 0.77771377980534432092869265740),
                (12, -2.7782057523535084065932004339),
                (13, -60.196695231264120758267380846),
                (14, 84.320405506677161018159903784),
                (15, 11.992291136182789328035130030),
            ],
            &[
                (0, -25.693933462703749003312586129),
                (5, -154.18974869023643374053993627),
                (6, -231.52937917604549567536039109),
                (7, 357.63911791061412378285349910),
                (8, 93.405324183624310003907691704),
                (9, -37.458323136451633156875139351),
                (10, 104.09964950896230045147246184),
                (11, 29.840293426660503123344363579),
                (12, -43.533456590011143754432175058),
                (13, 96.324553959188282948394950600),
                (14, -39.177261675615439165231486172),
                (15, -149.72683625798562581422125276),
            ],
        ],
    },
};

/// Order 5 with 6 evaluations a step.
pub static DORMAND_PRINCE_5: Tableau = Tableau {
    order: 5,
    c: &[0.2, 0.3, 0.8, 8.0 / 9.0, 1.0],
    a: &[
        &[(0, 0.2)],
        &[(0, 3.0 / 40.0), (1, 9.0 / 40.0)],
        &[(0, 44.0 / 45.0), (1, -56.0 / 15.0), (2, 32.0 / 9.0)],
        &[(0, 19372.0 / 6561.0), (1, -25360.0 / 2187.0), (2, 64448.0 / 6561.0), (3, -212.0 / 729.0)],
        &[(0, 9017.0 / 3168.0), (1, -355.0 / 33.0), (2, 46732.0 / 5247.0), (3, 49.0 / 176.0), (4, -5103.0 / 18656.0)],
    ],
    b: &[(0, 35.0 / 384.0), (2, 500.0 / 1113.0), (3, 125.0 / 192.0), (4, -2187.0 / 6784.0), (5, 11.0 / 84.0)],
    // The differences are those to the scheme of order 4.
    errors: &[&[
        (0, 71.0 / 57600.0),
        (2, -71.0 / 16695.0),
        (3, 71.0 / 1920.0),
        (4, -17253.0 / 339200.0),
        (5, 22.0 / 525.0),
        (6, -1.0 / 40.0),
    ]],
    error_order: 5.0,
    inside: StepPolynomial {
        c: &[],
        a: &[],
        bubbles: &[&[
            (0, -12715105075.0 / 11282082432.0),
            (2, 87487479700.0 / 32700410799.0),
            (3, -10690763975.0 / 1880347072.0),
            (4, 701980252875.0 / 199316789632.0),
            (5, -1453857185.0 / 822651844.0),
            (6, 69997945.0 / 29380423.0),
        ]],
    },
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrators::tableau::StageWeights;

    /// A rooted tree by its branches, biggest first.
    #[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
    struct Tree(Vec<Tree>);

    impl Tree {
        fn order(&self) -> usize {
            1 + self.0.iter().map(Tree::order).sum::<usize>()
        }

        /// γ of J. C. Butcher.
        fn density(&self) -> f64 {
            self.order() as f64 * self.0.iter().map(Tree::density).product::<f64>()
        }

        /// Per stage: the product over the branches of Σ a Φ.
        fn weights(&self, a: &[Vec<f64>]) -> Vec<f64> {
            let sums = |branch: &Tree| -> Vec<f64> {
                let inner = branch.weights(a);
                a.iter().map(|row| row.iter().zip(&inner).map(|(a, phi)| a * phi).sum()).collect()
            };
            let all: Vec<Vec<f64>> = self.0.iter().map(sums).collect();
            (0..a.len()).map(|i| all.iter().map(|branch| branch[i]).product()).collect()
        }
    }

    /// All trees of an order.
    fn trees(order: usize) -> Vec<Tree> {
        fn branches(left: usize, most: Option<&Tree>, all: &[Vec<Tree>]) -> Vec<Vec<Tree>> {
            if left == 0 {
                return vec![Vec::new()];
            }
            let mut out = Vec::new();
            for size in 1..=left {
                for first in all[size].iter().filter(|tree| most.is_none_or(|most| *tree <= most)) {
                    for mut rest in branches(left - size, Some(first), all) {
                        rest.insert(0, first.clone());
                        out.push(rest);
                    }
                }
            }
            out
        }
        let mut all: Vec<Vec<Tree>> = vec![Vec::new()];
        for order in 1..=order {
            let next = branches(order - 1, None, &all).into_iter().map(Tree).collect();
            all.push(next);
        }
        all.remove(order)
    }

    fn dense(weights: StageWeights, stages: usize) -> Vec<f64> {
        let mut row = vec![0.0; stages];
        weights.iter().for_each(|&(stage, weight)| row[stage] = weight);
        row
    }

    /// The rows of all stages, and of the end of the step as the last.
    fn matrix(tableau: &Tableau) -> Vec<Vec<f64>> {
        let stages = tableau.stages();
        let first: StageWeights = &[];
        let rows = std::iter::once(first).chain(tableau.a.iter().copied()).chain([tableau.b]);
        rows.map(|row| dense(row, stages)).collect()
    }

    #[test]
    fn there_are_as_many_trees_as_cayley_counted() {
        let counts: Vec<usize> = (1..=8).map(|order| trees(order).len()).collect();
        assert_eq!(counts, [1, 1, 2, 4, 9, 20, 48, 115]);
    }

    /// Σ b Φ(t) = 1/γ(t) for every tree up to the order, and not for all of the next; the embedded schemes likewise.
    #[test]
    fn order_conditions() {
        let orders: [(&Tableau, &[usize]); 2] = [(&DORMAND_PRINCE_8, &[5, 3]), (&DORMAND_PRINCE_5, &[4])];
        for (tableau, embedded) in orders {
            let a = matrix(tableau);
            let of = |weights: &[f64], order: usize| {
                let miss = |tree: &Tree| {
                    let sum: f64 = weights.iter().zip(tree.weights(&a)).map(|(b, phi)| b * phi).sum();
                    (sum - 1.0 / tree.density()).abs()
                };
                trees(order).iter().map(miss).fold(0.0, f64::max)
            };
            let b = dense(tableau.b, tableau.stages());
            let difference = |errors: &StageWeights| -> Vec<f64> {
                b.iter().zip(dense(errors, tableau.stages())).map(|(b, e)| b - e).collect()
            };
            let all = std::iter::once((b.clone(), tableau.order));
            for (weights, full) in all.chain(tableau.errors.iter().map(difference).zip(embedded.iter().copied())) {
                for order in 1..=full {
                    // Weights of up to 44 cancel: a hundred roundings of that.
                    assert!(of(&weights, order) < 1e-13, "order {full}: {:e} at {order}", of(&weights, order));
                }
                assert!(of(&weights, full + 1) > 1e-6, "order {full}: {:e}", of(&weights, full + 1));
            }
        }
    }

    /// The rows of all stages with the further ones; the last two are the motion at the fraction `s` of the step, and its derivative.
    fn matrix_inside(tableau: &Tableau, s: f64) -> Vec<Vec<f64>> {
        let (all, own) = (tableau.all_stages(), matrix(tableau));
        let wide = |row: &Vec<f64>| row.iter().copied().chain(std::iter::repeat(0.0)).take(all).collect();
        let mut rows: Vec<Vec<f64>> = own.iter().map(wide).collect();
        rows.extend(tableau.inside.a.iter().map(|row| dense(row, all)));
        let mut weights = vec![[0.0; 2]; all];
        let whole = tableau.weights_inside(s, &mut weights);
        let end = rows[tableau.stages() - 1].clone();
        rows.extend(
            [0, 1].map(|of| weights.iter().zip(&end).map(|(weight, end)| weight[of] + whole[of] * end).collect()),
        );
        rows
    }

    /// The motion inside: Σ b(s) Φ(t) = s^|t|/γ(t) for every tree up to order 7 and 4, and not for all of the next; its derivative likewise.
    #[test]
    fn order_conditions_inside_steps() {
        for (tableau, full) in [(&DORMAND_PRINCE_8, 7), (&DORMAND_PRINCE_5, 4)] {
            for s in [0.13, 0.5, 0.71] {
                let mut a = matrix_inside(tableau, s);
                let [slopes, b] = [(); 2].map(|()| a.pop().expect("the motion inside"));
                let miss = |weights: &[f64], order: usize, power: f64| {
                    let of = |tree: &Tree| {
                        let sum: f64 = weights.iter().zip(tree.weights(&a)).map(|(b, phi)| b * phi).sum();
                        (sum - power / tree.density()).abs()
                    };
                    trees(order).iter().map(of).fold(0.0, f64::max)
                };
                for order in 1..=full + 1 {
                    let power = s.powi(order as i32 - 1);
                    let misses = [miss(&b, order, s * power), miss(&slopes, order, order as f64 * power)];
                    println!("{full}: {misses:?} at {order}, s = {s}");
                    // Weights of up to 530 cancel: a hundred roundings of that.
                    assert!(misses.iter().all(|miss| (*miss < 1e-11) == (order <= full)), "{misses:?}");
                }
            }
            // At both ends the motion is that of the step, with its rates.
            for (s, end) in [(0.0, 0.0), (1.0, 1.0)] {
                let mut weights = vec![[0.0; 2]; tableau.all_stages()];
                assert_eq!(tableau.weights_inside(s, &mut weights), [end, 0.0]);
                for (stage, weight) in weights.into_iter().enumerate() {
                    let rate =
                        if (stage == 0 && s == 0.0) || (stage == tableau.stages() - 1 && s == 1.0) { 1.0 } else { 0.0 };
                    assert_eq!(weight.map(f64::abs), [0.0, rate], "{stage}");
                }
            }
        }
    }

    #[test]
    fn stages_are_when_their_weights_say() {
        for tableau in [&DORMAND_PRINCE_8, &DORMAND_PRINCE_5] {
            let further = tableau.inside.c.iter().zip(tableau.inside.a);
            for (c, a) in tableau.c.iter().zip(tableau.a).chain(further) {
                let sum: f64 = a.iter().map(|(_, a)| a).sum();
                assert!((c - sum).abs() < 2e-14, "{c} {sum}"); // terms of up to 44
            }
        }
    }
}
