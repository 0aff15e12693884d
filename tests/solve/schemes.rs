//! Time integration schemes through the whole program: digits of each on a stiff chain, order in the step, joints, jumps.

use crate::support::{body_omega, error, node, position, read, read_deck, reference, run_to_the_end, slope};

/// The schemes as the deck writes them.
const SCHEMES: [(&str, &str); 8] = [
    ("trapezoidal", "integrator={scheme=\"newmark\"}"),
    ("newmark 0.6", "integrator={scheme=\"newmark\",gamma=0.6}"),
    ("hht -0.05", "integrator={scheme=\"hht-alpha\"}"),
    ("hht -0.3", "integrator={scheme=\"hht-alpha\",alpha=-0.3}"),
    ("gen-alpha 0.8", "integrator={scheme=\"generalized-alpha\"}"),
    ("gen-alpha 0.5", "integrator={scheme=\"generalized-alpha\",spectral_radius=0.5}"),
    ("gen-alpha 0", "integrator={scheme=\"generalized-alpha\",spectral_radius=0.0}"),
    ("bathe", "integrator={scheme=\"bathe\",split=0.5}"),
];

fn owned(sets: &[&str]) -> Vec<String> {
    sets.iter().map(|set| (*set).to_owned()).collect()
}

/// K. J. Bathe, G. Noh, Comput. Struct. 98-99 (2012): three masses on springs of 1e7 and 1. v2 after steps 1 and 10, u3, v2, and
/// m2 a2 + k2 (u2 − u3), the force of the stiff spring, after step 38, of each scheme by its definition; the load is taken where the scheme writes equilibrium. The trapezoidal
/// rule never damps the stiff mode: that force is the phase of that after 38 steps, which rounding of 1e7 leaves four digits of.
#[test]
fn digits_on_the_stiff_chain() {
    let table: [[f64; 5]; 8] = [
        [2.360702, -2.418524, 0.091840, -0.210728, -698.380],
        [2.341194, -1.701167, -0.108389, 0.974059, 0.073825],
        [2.355349, -2.099897, 0.104431, 0.850347, -17.2438],
        [2.234986, -1.231442, 0.137019, 0.980947, 0.144112],
        [2.337095, -1.631911, 0.097720, 0.976893, -1.210931],
        [2.213160, -1.223308, 0.137488, 0.981402, 0.143726],
        [1.770531, -1.238129, 0.302365, 0.996309, 0.062412],
        [1.151014, -1.209784, 0.031711, 0.978075, 0.360844],
    ];
    for ((name, scheme), row) in SCHEMES.iter().zip(table) {
        let mut model = read("extreme/stiff_spring_chain", &owned(&[scheme, "iteration.tolerance=1e-12"]));
        model.expects.clear();
        let [m2, m3] = ["m2", "m3"].map(|name| node(&model, name));
        let start = [m2, m3].map(|node| model.nodes[node].x.x);
        let done = run_to_the_end(&model, &mut |frame| {
            let nodes = &frame.state.nodes;
            let [u2, u3] = [nodes[m2].x.x - start[0], nodes[m3].x.x - start[1]];
            vec![nodes[m2].v.x, u3, nodes[m2].a.x + (u2 - u3)]
        });
        let rows = &done.rows;
        let got = [rows[1][0], rows[10][0], rows[38][1], rows[38][0], rows[38][2]];
        println!("{name:14} {got:?}");
        for (k, (got, exact)) in got.iter().zip(row).enumerate() {
            // Digits as printed; accelerations hold the rounding of 1e7 times positions near 1.
            let tolerance = if k == 4 { 1e-3_f64.max(1e-5 * exact.abs()) } else { 2e-6 };
            assert!((got - exact).abs() < tolerance, "{name}, column {k}: {got} for {exact}");
        }
    }
}

/// Two rigid bodies on springs against a reference of 1e-12.
#[test]
fn order_for_rigid_bodies() {
    let exact = reference("two_bodies_on_springs");
    for (name, scheme) in SCHEMES {
        let points: Vec<(f64, f64)> = [16.0, 32.0, 64.0]
            .into_iter()
            .map(|division| {
                let dt = 0.025 / division;
                let step = format!("analysis.time_step={dt:e}");
                let mut model = read("two_bodies_on_springs", &owned(&[scheme, &step, "output.interval=0.025"]));
                model.expects.clear();
                let [a, b] = ["a", "b"].map(|name| node(&model, name));
                let done = run_to_the_end(&model, &mut |frame| {
                    let [a, b] = [a, b].map(|body| &frame.state.nodes[body]);
                    [position(a), position(b), body_omega(a), body_omega(b)].concat()
                });
                (dt, error(&done.rows, &exact, 0))
            })
            .collect();
        let order = slope(&points);
        println!("{name:14} {order:.2} {:.2e}", points[2].1);
        // Of first order, and 3 % off at the last rung.
        let expected = if name == "newmark 0.6" { 0.9..1.4 } else { 1.9..2.15 };
        assert!(expected.contains(&order), "{name}: {order}");
    }
}

/// A beam at large rotations, with a load that has kinks.
#[test]
fn order_for_a_flexible_beam() {
    let exact = reference("right_angle_cantilever");
    for (name, scheme) in SCHEMES.into_iter().filter(|(name, _)| *name != "newmark 0.6") {
        let points: Vec<(f64, f64)> = [2.0, 4.0, 8.0]
            .into_iter()
            .map(|division| {
                let step = format!("analysis.time_step={}", 0.15 / division);
                let sets = [scheme, &step, "output.interval=0.15", "beams.legs.elements=4", "beams.legs.order=3"];
                let mut model = read("right_angle_cantilever", &owned(&sets));
                model.expects.clear();
                let [elbow, tip] = ["elbow", "tip"].map(|name| node(&model, name));
                let done = run_to_the_end(&model, &mut |frame| [elbow, tip].map(|n| frame.state.nodes[n].x.z).to_vec());
                (0.15 / division, error(&done.rows, &exact, 0))
            })
            .collect();
        let order = slope(&points);
        println!("{name:14} {order:.2} {:.2e}", points[2].1);
        assert!((1.7..2.3).contains(&order), "{name}: {order}"); // the first rung has 10 steps a period
    }
}

/// The pivot of a fast top, held by multipliers.
#[test]
fn order_with_joints() {
    let exact = reference("heavy_top/pivot");
    for (name, scheme) in SCHEMES.into_iter().filter(|(name, _)| *name != "newmark 0.6") {
        let points: Vec<(f64, f64)> = [5e-4, 2.5e-4, 1.25e-4]
            .into_iter()
            .map(|dt| {
                let step = format!("analysis.time_step={dt}");
                let sets = [scheme, &step, "output.interval=0.01", "iteration.tolerance=1e-11"];
                let mut model = read("heavy_top/pivot", &owned(&sets));
                model.expects.clear();
                let top = node(&model, "top");
                let done = run_to_the_end(&model, &mut |frame| position(&frame.state.nodes[top]).to_vec());
                (dt, error(&done.rows, &exact, 0))
            })
            .collect();
        let order = slope(&points);
        println!("{name:14} {order:.2} {:.2e} {:.2e} {:.2e}", points[0].1, points[1].1, points[2].1);
        assert!((1.7..2.6).contains(&order), "{name}: {order}"); // 0.075 rad a step on the first rung
    }
}

/// A body that tumbles freely beside its unstable axis, where an error of the energy decides when it tumbles: no scheme changes its
/// angular momentum, for which 800 steps of rounding are left, and the errors are those of fourth order of the trapezoidal rule and of third
/// order of those that damp. The trapezoidal rule had 7e-2 here in the coordinates of rotation vectors.
#[test]
fn a_free_body_keeps_its_angular_momentum() {
    let exact = reference("free_body");
    for (name, scheme, most) in [
        ("newmark", "integrator.scheme=\"newmark\"", 8e-6),
        ("hht-alpha", "integrator.scheme=\"hht-alpha\"", 2e-4),
        ("bathe", "integrator.scheme=\"bathe\"", 8e-3),
        ("wilson-theta", "integrator.scheme=\"wilson-theta\"", 4e-2),
    ] {
        let sets = owned(&[scheme, "analysis.time_step=0.0625", "output.interval=0.25", "iteration.tolerance=1e-13"]);
        let mut model = read("free_body", &sets);
        model.expects.clear();
        let body = node(&model, "body");
        let J0 = model.bodies[0].inertia;
        let mut off = 0.0f64;
        let done = run_to_the_end(&model, &mut |frame| {
            let now = &frame.state.nodes[body];
            let momentum = now.R() * (J0 * now.R().tr_mul(&now.omega));
            off = off.max((momentum - rdsolve::math::Vec3::new(0.01, 2.0, 0.03)).amax());
            body_omega(now).into_iter().chain(now.R().iter().copied()).collect()
        });
        let error = error(&done.rows, &exact, 0);
        println!("{name:14} {error:.2e}, momentum {off:.1e}");
        assert!(off < 1e-12, "{name}: {off:e}");
        assert!(error < most, "{name}: {error:e}");
    }
}

/// A body that nothing moves has no place among the nodes that move; the next one tumbles as it does alone.
#[test]
fn a_body_at_rest_leaves_the_next_one_alone() {
    let still = "[[bodies]]\nname = \"still\"\ncenter = [9.0, 0.0, 0.0]\nmass = 1.0\ninertia = [1.0, 2.0, 2.5]\n";
    let tumbling = "[[bodies]]\nname = \"body\"\ncenter = [0.0, 0.0, 0.0]\nmass = 1.0\ninertia = [1.0, 2.0, 3.0]\n\
                    angular_velocity = [1.0, 1.0, 1.0]\n";
    for scheme in ["wilson-theta", "generalized-alpha"] {
        let rows = |bodies: &str| {
            let model = read_deck(&format!(
                "[analysis]\nkind = \"dynamic\"\nend_time = 2.0\ntime_step = 0.05\n\
                 [integrator]\nscheme = \"{scheme}\"\n[iteration]\ntolerance = 1e-13\n{bodies}"
            ));
            let body = node(&model, "body");
            run_to_the_end(&model, &mut |frame| body_omega(&frame.state.nodes[body]).to_vec()).rows
        };
        let (beside, alone) = (rows(&format!("{still}{tumbling}")), rows(tumbling));
        assert_eq!(beside.len(), 41);
        for (beside, alone) in beside.iter().flatten().zip(alone.iter().flatten()) {
            assert!((beside - alone).abs() < 1e-12, "{scheme}: {beside} for {alone}"); // what the iteration leaves
        }
    }
}
