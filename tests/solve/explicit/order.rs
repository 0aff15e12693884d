//! The error falls with the step as the order of the scheme says, with joints and with rotations of their own.

use super::{CENTRAL, EIGHT, FIVE, Probe, assert_order, attitude, deck, ladder, place_of, scene, two_bodies};
use crate::support::{error, node, reference, run_to_the_end};
use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};
use rdsolve::model::Model;
use rdsolve::plan::Plan;
use rdsolve::solve::Frame;
use rdsolve::system::System;

/// R1, R2 with its pivot as a joint and by elimination, R3: the order is that of the name. Rungs are long steps, where errors
/// fall a little faster than in the limit.
#[test]
fn order_of_runge_kutta() {
    for (scheme, order, divisions) in [(EIGHT, 8.0, [[1, 2, 3], [1, 2, 3]]), (FIVE, 5.0, [[2, 4, 8], [4, 8, 16]])] {
        let [slow, fast] = &divisions;
        let range = order - 0.3..order + 1.6;
        let points = ladder("free_body", &[scheme], &attitude, (0.25, slow), &reference("free_body"));
        assert_order(&points, range.clone());
        let exact = reference("heavy_top/pivot");
        let points = ladder("heavy_top/pivot", &[scheme], &place_of("top"), (0.01, fast), &exact);
        assert_order(&points, range.clone());
        let points = ladder("heavy_top", &[scheme], &place_of("centre_of_mass"), (0.01, fast), &exact);
        assert_order(&points, range.clone());
        let exact = reference("two_bodies_on_springs");
        let points = ladder("two_bodies_on_springs", &[scheme], &two_bodies, (0.025, fast), &exact);
        assert_order(&points, range);
    }
}

#[test]
fn order_of_central_differences() {
    let exact = reference("two_bodies_on_springs");
    let points = ladder("two_bodies_on_springs", &[CENTRAL], &two_bodies, (0.025, &[16, 32, 64]), &exact);
    assert_order(&points, 1.9..2.15);
    // A body that turns about all axes, away from its separatrix; against the scheme of order 8.
    let spun = |scheme| [scheme, "bodies.body.angular_velocity=[1.0,1.0,1.0]", "analysis.end_time=10.0"];
    let fine = deck("free_body", &[&spun(EIGHT)[..], &["analysis.time_step=0.05", "output.interval=0.25"]].concat());
    let exact = run_to_the_end(&fine, &mut attitude(&fine)).rows;
    let points = ladder("free_body", &spun(CENTRAL), &attitude, (0.25, &[16, 32, 64]), &exact);
    assert_order(&points, 1.9..2.1);
    // Joints, and a top at 150 rad/s: 0.05 rad a step on the first rung.
    let exact = reference("heavy_top/pivot");
    let points = ladder("heavy_top/pivot", &[CENTRAL], &place_of("top"), (0.01, &[32, 64, 128]), &exact);
    assert_order(&points, 1.8..2.6);
    let points = ladder("heavy_top", &[CENTRAL], &place_of("centre_of_mass"), (0.01, &[32, 64, 128]), &exact);
    assert_order(&points, 1.8..2.6);
}

/// A beam at large rotations; against Runge-Kutta on the same mesh.
#[test]
fn order_for_a_flexible_beam() {
    let mesh = ["beams.legs.elements=4", "beams.legs.order=1", "analysis.end_time=15.0"];
    let tips = |model: &Model| -> Probe {
        let at = ["elbow", "tip"].map(|name| node(model, name));
        Box::new(move |frame| at.map(|n| frame.state.nodes[n].x.z).to_vec())
    };
    let text = ["analysis.time_step=0.00125", "output.interval=0.15"];
    let fine = deck("right_angle_cantilever", &[&[EIGHT][..], &mesh, &text].concat());
    let exact = run_to_the_end(&fine, &mut tips(&fine)).rows;
    let sets = [&[CENTRAL][..], &mesh].concat();
    let points = ladder("right_angle_cantilever", &sets, &tips, (0.15, &[80, 160, 320]), &exact);
    assert_order(&points, 1.8..2.2);
}

/// A rotor on a tumbling body, both about one point, with ω_x and ω_y in common.
const ROTOR: &str = r#"
[analysis]
kind = "dynamic"
end_time = 1.0
time_step = 0.01

[integrator]
scheme = "central-difference"

[[bodies]]
name = "a"
center = [0.0, 0.0, 0.0]
mass = 1.0
inertia = [0.3, 0.2, 0.15]
angular_velocity = [2.0, 1.0, 0.5]

[[bodies]]
name = "b"
center = [0.0, 0.0, 0.0]
mass = 1.0
inertia = [0.1, 0.25, 0.2]
angular_velocity = [2.0, 1.0, 6.0]

[[attachments]]
body = "a"
nodes = "b"
dofs = ["ux", "uy", "uz", "rx", "ry"]

[output]
interval = 0.25
"#;

/// Attitudes of [`ROTOR`] at its output times: moments about z are none, about x and y they balance, so four momenta are kept and
/// give the four angular velocities that are left. By the classical Runge-Kutta of order 4 in small steps.
fn tumbling_rotor() -> Vec<Vec<f64>> {
    type Attitudes = [Matrix3<f64>; 2];
    let inertias = [[0.3, 0.2, 0.15], [0.1, 0.25, 0.2]].map(|J: [f64; 3]| Matrix3::from_diagonal(&J.into()));
    // Of (ω_x, ω_y, ω_z of a, ω_z of b).
    let momenta = |R: &Attitudes| {
        let [a, b] = [0, 1].map(|i| R[i] * inertias[i] * R[i].transpose());
        let c = a + b;
        Matrix4::new(
            c[(0, 0)],
            c[(0, 1)],
            a[(0, 2)],
            b[(0, 2)], //
            c[(1, 0)],
            c[(1, 1)],
            a[(1, 2)],
            b[(1, 2)], //
            a[(2, 0)],
            a[(2, 1)],
            a[(2, 2)],
            0.0, //
            b[(2, 0)],
            b[(2, 1)],
            0.0,
            b[(2, 2)],
        )
    };
    let mut R = [Matrix3::identity(); 2];
    let kept = momenta(&R) * Vector4::new(2.0, 1.0, 0.5, 6.0);
    let rate = |R: &Attitudes| -> Attitudes {
        let w = momenta(R).lu().solve(&kept).unwrap();
        [0, 1].map(|i| Vector3::new(w[0], w[1], w[2 + i]).cross_matrix() * R[i])
    };
    let after = |R: &Attitudes, rate: &Attitudes, h: f64| [R[0] + rate[0] * h, R[1] + rate[1] * h];
    let row = |R: &Attitudes| R.iter().flat_map(|R| R.iter().copied()).collect::<Vec<f64>>();
    let mut rows = vec![row(&R)];
    let h = 1e-3;
    for step in 1..=1000 {
        let k1 = rate(&R);
        let k2 = rate(&after(&R, &k1, 0.5 * h));
        let k3 = rate(&after(&R, &k2, 0.5 * h));
        let k4 = rate(&after(&R, &k3, h));
        R = std::array::from_fn(|i| R[i] + (k1[i] + (k2[i] + k3[i]) * 2.0 + k4[i]) * (h / 6.0));
        if step % 250 == 0 {
            rows.push(row(&R));
        }
    }
    rows
}

/// A dependent node that turns with its master about two axes.
#[test]
fn order_with_rotations_of_its_own() {
    let exact = tumbling_rotor();
    let rung = |scheme: &str, division: u32| {
        let step = 0.25 / f64::from(division);
        let sets = [format!("analysis.time_step={step:e}"), format!("integrator={{scheme=\"{scheme}\"}}")];
        let model = scene(ROTOR, &sets.each_ref().map(String::as_str));
        let at = ["a", "b"].map(|name| node(&model, name));
        let attitudes = |frame: &Frame| {
            at.iter().flat_map(|&n| frame.state.nodes[n].R().iter().copied().collect::<Vec<_>>()).collect()
        };
        let off = error(&run_to_the_end(&model, &mut |frame| attitudes(frame)).rows, &exact, 0);
        println!("{step:12.5e} {off:10.3e}");
        (step, off)
    };
    let ladder = |scheme: &str| -> Vec<(f64, f64)> {
        println!("{scheme}");
        [16, 32, 64, 128].into_iter().map(|division| rung(scheme, division)).collect()
    };
    assert_order(&ladder("central-difference"), 1.8..2.2);
    // Implicit schemes tie the rotation vectors of a step, which is of first order in the rates.
    for scheme in ["wilson-theta", "newmark", "hht-alpha", "generalized-alpha", "bathe", "esdirk3"] {
        assert_order(&ladder(scheme), 0.9..1.1);
    }
    // Stages of Runge-Kutta do not keep to it: said, not done.
    let partial_rotations = |text: &str| {
        let model = scene(text, &[EIGHT]);
        let system = System::new(&model).unwrap();
        Plan::new(&model, &system, 1).partial_rotations(&model)
    };
    let problems = partial_rotations(ROTOR);
    assert_eq!(problems.len(), 1);
    assert!(problems[0].message.contains("`b` turns with `a` about some axes only"), "{}", problems[0].message);
    assert_eq!(&ROTOR[problems[0].place.clone().expect("a place")], "\"b\"");
    // All or none of the rotations are as good as any.
    for dofs in ["[\"ux\",\"uy\",\"uz\"]", "[\"ux\",\"uy\",\"uz\",\"rx\",\"ry\",\"rz\"]"] {
        let text = ROTOR.replace("[\"ux\", \"uy\", \"uz\", \"rx\", \"ry\"]", dofs).replace("6.0]", "0.5]");
        assert!(partial_rotations(&text).is_empty());
    }
}
