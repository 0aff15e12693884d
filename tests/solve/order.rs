//! Order of convergence, measured: error against references over ladders of time steps and of element sizes.
//! `cargo test --test all order -- --nocapture --test-threads 1` shows the tables.

use crate::support::{self, body_omega, error, node, position, read, reference, run_to_the_end, slope};
use rdsolve::model::Model;
use rdsolve::solve::Frame;

type Probe = Box<dyn FnMut(&Frame) -> Vec<f64>>;

/// A scene, its quantities in the order of reference.csv, and the rows to leave out at the start.
struct Scene {
    deck: &'static str,
    /// Besides the time step.
    sets: &'static [&'static str],
    /// Of reference.csv, which every step must divide.
    interval: f64,
    probe: fn(&Model) -> Probe,
    skip: usize,
}

/// One rung of a ladder.
struct Rung {
    step: f64,
    error: f64,
}

impl Scene {
    fn model(&self, step: f64) -> Model {
        let mut sets = vec![format!("analysis.time_step={step:e}"), "output.energy=false".to_owned()];
        sets.extend(self.sets.iter().map(|set| (*set).to_owned()));
        let mut model = read(self.deck, &sets);
        // Steps would land on the times of expected values too.
        model.expects.clear();
        model
    }

    /// Runs at the steps `interval / division` and shows the table of errors against reference.csv.
    fn ladder(&self, divisions: &[u32]) -> Vec<Rung> {
        println!("\n{} {}", self.deck, self.sets.join(" "));
        self.ladder_against(&reference(self.deck), divisions)
    }

    fn ladder_against(&self, exact: &[Vec<f64>], divisions: &[u32]) -> Vec<Rung> {
        println!(
            "{:>12} {:>10} {:>6} {:>9} {:>14} {:>5} {:>9}",
            "step", "error", "order", "it/step", "factorizations", "cuts", "loop s"
        );
        let mut rungs: Vec<Rung> = Vec::new();
        for &division in divisions {
            let step = self.interval / f64::from(division);
            let model = self.model(step);
            let done = run_to_the_end(&model, &mut (self.probe)(&model));
            let error = error(&done.rows, exact, self.skip);
            let order = rungs.last().map_or(String::new(), |last: &Rung| {
                format!("{:.2}", (last.error / error).ln() / (last.step / step).ln())
            });
            let c = done.counts;
            println!(
                "{step:12.5e} {error:10.3e} {order:>6} {:9.2} {:14} {:5} {:9.4}",
                c.iterations as f64 / c.steps as f64,
                c.factorizations,
                c.cuts,
                done.seconds
            );
            assert!(error.is_finite());
            rungs.push(Rung { step, error });
        }
        rungs
    }
}

fn assert_order(rungs: &[Rung], least: f64, most: f64) {
    let points: Vec<(f64, f64)> = rungs.iter().map(|rung| (rung.step, rung.error)).collect();
    let order = slope(&points);
    println!("slope {order:.3} over the last {}", rungs.len());
    assert!((least..most).contains(&order), "order {order}, expected {least} to {most}");
}

fn last(rungs: &[Rung]) -> f64 {
    rungs.last().expect("a rung").error
}

const FREE_BODY: Scene = Scene {
    deck: "free_body",
    // What the iteration leaves is enlarged 1e4 times beside the separatrix.
    sets: &["iteration.tolerance=1e-13"],
    interval: 0.25,
    probe: |model| {
        let body = node(model, "body");
        Box::new(move |frame| {
            let now = &frame.state.nodes[body];
            body_omega(now).into_iter().chain(now.R().iter().copied()).collect()
        })
    },
    skip: 0,
};

const TWO_BODIES: Scene = Scene {
    deck: "two_bodies_on_springs",
    sets: &[],
    interval: 0.025,
    probe: |model| {
        let (a, b) = (node(model, "a"), node(model, "b"));
        Box::new(move |frame| {
            let [a, b] = [a, b].map(|body| &frame.state.nodes[body]);
            [position(a), position(b), body_omega(a), body_omega(b)].concat()
        })
    },
    skip: 0,
};

const RIGHT_ANGLE: Scene = Scene {
    deck: "right_angle_cantilever",
    sets: &["beams.legs.elements=4", "beams.legs.order=3"],
    interval: 0.15,
    probe: |model| {
        let (elbow, tip) = (node(model, "elbow"), node(model, "tip"));
        Box::new(move |frame| [elbow, tip].map(|n| frame.state.nodes[n].x.z).to_vec())
    },
    skip: 0,
};

const FLYING_BEAM: Scene = Scene {
    deck: "flying_beam",
    sets: &["beams.rod.elements=4", "beams.rod.order=3"],
    interval: 0.05,
    probe: |model| {
        let nodes = ["a", "middle", "b"].map(|name| node(model, name));
        Box::new(move |frame| nodes.map(|n| position(&frame.state.nodes[n])).concat())
    },
    skip: 0,
};

const BLOCK: Scene = Scene {
    deck: "block_on_cantilever",
    sets: &["beams.beam.elements=4", "beams.beam.order=3"],
    interval: 0.01,
    probe: |model| {
        let nodes = ["block", "tip"].map(|name| node(model, name));
        Box::new(move |frame| nodes.map(|n| position(&frame.state.nodes[n])).concat())
    },
    skip: 0,
};

const HUB: Scene = Scene {
    deck: "hub_with_blades",
    sets: &["beams.blade_1.elements=4", "beams.blade_2.elements=4"],
    interval: 0.015,
    probe: |model| {
        let [hub, tip_1, tip_2] = ["hub", "tip_1", "tip_2"].map(|name| node(model, name));
        let mut angle = 0.0f64;
        Box::new(move |frame| {
            let nodes = &frame.state.nodes;
            // The hub turns about z only: its angle, continued over whole turns.
            let q = nodes[hub].rotation;
            let turned = 2.0 * q.k.atan2(q.w);
            angle = turned + ((angle - turned) / std::f64::consts::TAU).round() * std::f64::consts::TAU;
            let [x_1, x_2] = [nodes[tip_1].x, nodes[tip_2].x];
            vec![angle, x_1.x, x_1.y, x_2.x, x_2.y]
        })
    },
    skip: 0,
};

const SPRING_CHAIN: Scene = Scene {
    deck: "extreme/stiff_spring_chain",
    sets: &["analysis.end_time=52.35987755982988", "output.interval=0.2617993877991494"],
    interval: 0.2617993877991494,
    probe: |model| {
        let [m2, m3] = ["m2", "m3"].map(|name| node(model, name));
        Box::new(move |frame| {
            let [a, b] = [m2, m3].map(|n| &frame.state.nodes[n]);
            // The force on the support is taken where equilibrium is written: k (u1 - u2) at the end of a step is
            // useless in Wilson-theta.
            let reaction = frame.reactions[0];
            vec![a.x.x - 1.0, b.x.x - 2.0, a.v.x, b.v.x, a.a.x, b.a.x, reaction]
        })
    },
    // The stiff mode's free oscillation dies out in these.
    skip: 10,
};

const STIFF_PENDULUM: Scene = Scene {
    deck: "extreme/stiff_pendulum",
    sets: &[],
    interval: 0.2066761,
    probe: |model| {
        let bob = node(model, "bob");
        Box::new(move |frame| {
            let x = frame.state.nodes[bob].x;
            vec![x.x, x.z]
        })
    },
    skip: 0,
};

#[test]
fn r1() {
    let rungs = FREE_BODY.ladder(&[5, 10, 20, 40, 80, 160, 320]);
    // The angular momentum stays, the rotation errs by third order. Beyond these steps, rounding, enlarged 1e4 times beside the
    // separatrix, shows.
    assert_order(&rungs, 2.9, 3.1);
    assert!(last(&rungs) < 5e-8);
}

#[test]
fn r1_far_from_the_separatrix() {
    // Angular velocity in body axes at t = 5, 10 and 20 from (1, 1, 1): Jacobi elliptic functions.
    let exact = [
        vec![1.007980330983, -0.991955468935, 1.002667167716],
        vec![-0.603470423093, -1.278993138548, 0.887726788216],
        vec![0.182937038384, 1.402331644080, 0.823299451397],
    ];
    println!("\nfree_body from (1, 1, 1)");
    let points: Vec<(f64, f64)> = [0.1, 0.05, 0.025, 0.0125, 0.00625, 0.003125, 0.0015625, 0.00078125]
        .into_iter()
        .map(|step| {
            let sets = [
                "bodies.body.angular_velocity=[1.0, 1.0, 1.0]".to_owned(),
                "output.interval=5.0".to_owned(),
                format!("analysis.time_step={step}"),
            ];
            let mut model = read("free_body", &sets);
            model.expects.clear();
            let body = node(&model, "body");
            let rows = run_to_the_end(&model, &mut |frame| body_omega(&frame.state.nodes[body]).to_vec()).rows;
            let error = error(&[rows[1].clone(), rows[2].clone(), rows[4].clone()], &exact, 0);
            println!("{step:12.5e} {error:10.3e}");
            (step, error)
        })
        .collect();
    let order = slope(&points[2..]);
    println!("slope {order:.3} over the last {}", points.len() - 2);
    assert!((2.9..3.1).contains(&order), "order {order}"); // free rotation errs by third order
    assert!(points.last().expect("a rung").1 < 4e-9);
}

#[test]
fn r3() {
    let rungs = TWO_BODIES.ladder(&[1, 2, 4, 8, 16, 32, 64, 128, 256]);
    // The fastest oscillation has 60 rad/s: in the asymptotic range from the fourth rung on, where a step is 0.2 rad of it.
    assert_order(&rungs[3..], 1.8, 2.3);
    assert!(last(&rungs) < 1e-5);
}

#[test]
fn loads_that_jump_cost_no_order() {
    // The two bodies on ground that is pushed from t = 1.03 to 2.17, off the grid of the steps. Against the finest steps.
    let pushed = Scene {
        sets: &[
            "environment={base_acceleration=[{direction=[0.3,0.1,1.0],amplitude=\"push\",scale=5.0}]}",
            "amplitudes={push={kind=\"step\",start=1.03,end=2.17}}",
        ],
        ..TWO_BODIES
    };
    println!("\n{} {}", pushed.deck, pushed.sets.join(" "));
    let fine = pushed.model(pushed.interval / 512.0);
    let fine = run_to_the_end(&fine, &mut (pushed.probe)(&fine)).rows;
    let rungs = pushed.ladder_against(&fine, &[8, 16, 32, 64, 128]);
    // As r3; carrying the old acceleration over the jump gives 1. The finest steps are a reference to 1/16 of the last rung.
    assert_order(&rungs, 1.8, 2.3);
}

#[test]
fn b1() {
    let rungs = RIGHT_ANGLE.ladder(&[1, 2, 4, 8, 16, 32]);
    // In the asymptotic range from the second rung on; the last one begins to see the mesh, which leaves 1e-5.
    assert_order(&rungs[1..5], 1.8, 2.3);
    assert!(last(&rungs) < 1e-4);
}

#[test]
fn b2() {
    let rungs = FLYING_BEAM.ladder(&[1, 2, 4, 8, 16, 32]);
    // In the asymptotic range from the start; the last rung begins to see the mesh, which leaves 2e-6.
    assert_order(&rungs[..5], 1.8, 2.3);
    assert!(last(&rungs) < 1e-5);
}

#[test]
fn c1() {
    let rungs = BLOCK.ladder(&[1, 2, 4, 8, 16, 32, 64, 128]);
    // Weight that acts at once sets all modes swinging, the faster the less. Those that a step resolves follow with second
    // order; the others are off by their amplitude, and every halving resolves some more: 1.5 in all.
    assert_order(&rungs, 1.3, 2.3);
    assert!(last(&rungs) < 1e-5);
}

#[test]
fn c1_shaken_smoothly() {
    // The same scene without the jump: the ground pushes for half a second, as sin². Against the finest steps.
    let smooth = Scene {
        sets: &[
            "beams.beam.elements=4",
            "beams.beam.order=3",
            "environment={base_acceleration=[{direction=[0.0,0.0,1.0],amplitude=\"push\",scale=9.81}]}",
            "amplitudes={push={kind=\"sine-squared\",frequency=1.0,end=0.5}}",
        ],
        ..BLOCK
    };
    println!("\n{} {}", smooth.deck, smooth.sets.join(" "));
    let fine = smooth.model(smooth.interval / 256.0);
    let fine = run_to_the_end(&fine, &mut (smooth.probe)(&fine)).rows;
    let rungs = smooth.ladder_against(&fine, &[1, 2, 4, 8, 16, 32]);
    assert_order(&rungs[1..], 1.8, 2.3);
}

#[test]
fn c2() {
    let rungs = HUB.ladder(&[1, 2, 4, 8, 16, 32, 64]);
    // In the asymptotic range from the start: the torque is smooth.
    assert_order(&rungs, 1.8, 2.3);
    assert!(last(&rungs) < 1e-5);
}

#[test]
fn x1() {
    let rungs = SPRING_CHAIN.ladder(&[1, 2, 4, 8, 16, 32]);
    // The stiff mode is never resolved, and must not spoil the soft one.
    assert_order(&rungs, 1.8, 2.3);
    assert!(last(&rungs) < 2e-4);
}

#[test]
fn x1_stays_bounded_at_any_step() {
    // Steps from 1/4 to 1/640 of the forcing period; the stiff mode goes through 500 to 80,000 radians in 20 of them.
    println!("\nstiff_spring_chain, largest |u3|, |a2| over the first and the second five periods");
    for (multiple, division) in [(5u32, 1), (2, 1), (1, 1), (1, 4), (1, 32)] {
        let interval = SPRING_CHAIN.interval * f64::from(multiple);
        let mut model = SPRING_CHAIN.model(interval / f64::from(division));
        model.output.cadence = rdsolve::model::Cadence::Interval(interval);
        let rows = run_to_the_end(&model, &mut (SPRING_CHAIN.probe)(&model)).rows;
        let largest = |rows: &[Vec<f64>], column: usize| rows.iter().map(|row| row[column].abs()).fold(0.0, f64::max);
        let (first, second) = rows.split_at(rows.len() / 2);
        let [u, a] = [1, 4].map(|column| [largest(first, column), largest(second, column)]);
        println!("{:11.4e} {u:8.4?} {a:10.4?}", interval / f64::from(division));
        // The soft mode alone swings by up to 2.73 + 2.27.
        assert!(u[0].max(u[1]) < 5.0 * 1.05, "u3 {u:?}");
        // The overshoot of the start, up to 19.6, dies by a factor of 0.86 a step; then there is the forced motion, 1.44.
        assert!(a[1] < a[0] * (1.0 + 1e-6), "a2 {a:?}");
        assert!(a[1] < 1.6 || rows.len() < 100, "a2 {a:?}");
    }
}

#[test]
fn a_small_theta_is_warned_of_and_blows_up() {
    let sets = ["integrator.theta=1.3".to_owned()];
    let warnings = support::warnings("extreme/stiff_spring_chain", &sets);
    assert!(warnings.iter().any(|warning| warning.contains("theta")), "{warnings:?}");
    let mut model = read("extreme/stiff_spring_chain", &sets);
    model.expects.clear();
    let done = support::run(&model, &mut (SPRING_CHAIN.probe)(&model));
    // From 1.2, by a factor a step of 1.38, the spectral radius of Wilson-theta 1.3 at infinite frequency.
    let end = done.rows.last().expect("a row")[2].abs();
    println!("v2 after {} steps with theta = 1.3: {end:.2e}", done.counts.steps);
    assert!(end > 1e3, "v2 {end}");
}

#[test]
fn x2() {
    let rungs = STIFF_PENDULUM.ladder(&[1, 4, 16, 64]);
    assert!(last(&rungs) < 1e-3);
    // Kinetic energy and weight; not the bar's energy, which at the end of long steps, where Wilson-theta does not write
    // equilibrium, is that of a bar 1e-3 off its length.
    let scale = 3.0 * 9.8 * 3.0443;
    for division in [1, 4, 16] {
        let model = STIFF_PENDULUM.model(STIFF_PENDULUM.interval / f64::from(division));
        let bob = node(&model, "bob");
        let rows = run_to_the_end(&model, &mut |frame| {
            let bob = &frame.state.nodes[bob];
            vec![1.5 * bob.v.norm_squared() + 3.0 * 9.8 * bob.x.z, bob.x.norm() / 3.0443 - 1.0]
        })
        .rows;
        let energy = |rows: &[Vec<f64>]| rows.iter().map(|row| row[0] / scale).fold(f64::NEG_INFINITY, f64::max);
        let (first, second) = rows.split_at(rows.len() / 2);
        let stretch = rows.iter().map(|row| row[1].abs()).fold(0.0, f64::max);
        println!(
            "interval/{division:<2}: energy at most {:9.2e} and {:9.2e} of m g L in the two halves, {:9.2e} at the end; bar off by {stretch:.1e}",
            energy(first),
            energy(second),
            rows.last().expect("a row")[0] / scale,
        );
        assert!(energy(second) <= energy(first));
    }
}

/// Errors of elements of order 1 to 4 over their number, from `error_of(elements, order)`, as a table; orders follow.
fn mesh_table(
    title: &str,
    counts: [&[usize]; 4],
    mut error_of: impl FnMut(usize, usize) -> f64,
) -> Vec<Vec<(f64, f64)>> {
    println!("\n{title}");
    println!("{:>6} {:>9} {:>10} {:>6}", "order", "elements", "error", "slope");
    let mut table = Vec::new();
    for (order, counts) in (1..).zip(counts) {
        let mut points: Vec<(f64, f64)> = Vec::new();
        for &count in counts {
            let point = (1.0 / count as f64, error_of(count, order));
            let slope = points.last().map_or(String::new(), |&last| format!("{:.2}", slope(&[last, point])));
            println!("{order:6} {count:9} {:10.3e} {slope:>6}", point.1);
            points.push(point);
        }
        table.push(points);
    }
    table
}

/// Tip displacements (along, across) of a cantilever of length 10 under a transverse dead load: the plane rod with
/// stretch and shear, its equations integrated from the clamp (Runge-Kutta, fourth order), the moment there by shooting.
fn end_shear(load: f64) -> [f64; 2] {
    let (axial, shear, bending, length, steps) = (1.2e5, 5e4, 100.0, 10.0, 4000);
    let slope_of = |[_, _, angle, moment]: [f64; 4]| {
        let (s, c) = f64::sin_cos(angle);
        let (stretch, slip) = (1.0 + load * s / axial, load * c / shear);
        let along = stretch * c - slip * s;
        [along, stretch * s + slip * c, moment / bending, -load * along]
    };
    let integrate = |clamp: f64| {
        let h = length / f64::from(steps);
        let mut y = [0.0, 0.0, 0.0, clamp];
        for _ in 0..steps {
            let ahead = |k: [f64; 4], by: f64| std::array::from_fn(|i| y[i] + by * k[i]);
            let k1 = slope_of(y);
            let k2 = slope_of(ahead(k1, 0.5 * h));
            let k3 = slope_of(ahead(k2, 0.5 * h));
            let k4 = slope_of(ahead(k3, h));
            y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        }
        y
    };
    // The moment at the tip vanishes: secant method.
    let (mut a, mut b) = (0.6 * load * length, 0.7 * load * length);
    for _ in 0..50 {
        let (at_a, at_b) = (integrate(a)[3], integrate(b)[3]);
        if at_a == at_b {
            break;
        }
        (a, b) = (b, b - at_b * (b - a) / (at_b - at_a));
    }
    let tip = integrate(b);
    [tip[0] - length, tip[1]]
}

#[test]
fn elements_of_order_p_converge_with_power_2p_in_statics() {
    let exact = end_shear(4.0);
    // K. Y. Sze et al. 2004, problem 3.1, with the strip's stretch and shear: digits as published.
    assert!((exact[0] + 3.289509).abs() < 1e-6 && (exact[1] - 6.700133).abs() < 1e-6, "{exact:?}");
    let counts: [&[usize]; 4] = [&[4, 8, 16, 32, 64], &[2, 4, 8, 16, 32], &[1, 2, 4, 8, 16], &[1, 2, 4, 8]];
    let table = mesh_table("cantilever under end shear", counts, |elements, order| {
        let sets = [
            format!("beams.strip.elements={elements}"),
            format!("beams.strip.order={order}"),
            "iteration.tolerance=1e-12".to_owned(),
        ];
        let model = read("cantilever_end_shear", &sets);
        let tip = node(&model, "tip");
        let done = run_to_the_end(&model, &mut |frame| position(&frame.state.nodes[tip]).to_vec());
        let end = done.rows.last().expect("a row");
        (end[0] - 10.0 - exact[0]).hypot(end[2] - exact[1]) / exact[0].hypot(exact[1])
    });
    for (order, points) in (1..).zip(&table) {
        // Over the last three meshes; the last quarter of an order comes later than that.
        let slope = slope(&points[points.len() - 3..]);
        let full = 2.0 * f64::from(order);
        assert!(slope > full - 0.5 && slope < full + 0.2, "elements of order {order}: {slope}");
    }
}

#[test]
fn elements_of_higher_order_converge_faster_in_dynamics() {
    let run = |elements: usize, order: usize| {
        let sets = [
            format!("beams.legs.elements={elements}"),
            format!("beams.legs.order={order}"),
            "analysis.time_step=0.0375".to_owned(),
            "iteration.tolerance=1e-10".to_owned(),
        ];
        let mut model = read("right_angle_cantilever", &sets);
        model.expects.clear();
        run_to_the_end(&model, &mut (RIGHT_ANGLE.probe)(&model)).rows
    };
    // Steps are the same in both, so that only the mesh is seen.
    let exact = run(16, 4);
    let counts: [&[usize]; 4] = [&[4, 8, 16, 32, 64], &[2, 4, 8, 16, 32], &[1, 2, 4, 8, 16], &[1, 2, 4, 8]];
    let table = mesh_table("right-angle cantilever", counts, |elements, order| error(&run(elements, order), &exact, 0));
    // Lumped masses keep the 2p of statics for orders 1 and 2. Orders 3 and 4 see the waves that the corners of the load
    // send out, which no mesh of these resolves: they gain 5 and 6 orders.
    for (points, (least, most)) in table.iter().zip([(1.9, 2.1), (3.8, 4.1), (5.0, 6.3), (5.5, 8.2)]) {
        let slope = slope(&points[1..]);
        println!("slope {slope:.2}");
        assert!((least..most).contains(&slope), "{slope}, expected {least} to {most}");
    }
}

/// Legs graded towards their hinges: half the elements have a smaller error than eight alike, 4e-4 against 7e-4.
#[test]
fn graded_legs_take_half_the_elements() {
    let exact = reference("portal_and_block");
    let run = |mesh: &[&str]| {
        let mut sets: Vec<String> = mesh.iter().map(|set| (*set).to_owned()).collect();
        sets.push("output.sections=false".to_owned());
        let mut model = read("portal_and_block", &sets);
        model.expects.clear();
        let [knee, block] = ["knee_left", "block"].map(|name| node(&model, name));
        let done = run_to_the_end(&model, &mut |frame| [knee, block].map(|n| frame.state.nodes[n].x.x).to_vec());
        (error(&done.rows, &exact, 0), done.counts.iterations)
    };
    let (alike, iterations) = run(&["beams.portal.elements=8"]);
    let (graded, of_graded) = run(&["beams.portal.elements=4", "beams.portal.grading=0.25"]);
    println!("alike {alike:.2e} in {iterations} iterations, graded {graded:.2e} in {of_graded} of half the size");
    assert!(graded < alike && alike < 1e-3, "{graded:e} {alike:e}");
    assert!((of_graded as f64) < 1.2 * iterations as f64, "{of_graded} {iterations}");
}
