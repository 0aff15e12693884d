//! Actuators: a force between two points against a link with the same preload, and the joint of the same kind.

use crate::support::{read_deck, run_to_the_end};
use rdsolve::solve::Frame;

/// A boom on a hinge, and `ram` between it and the ground. Returns position and velocity of the boom at the end.
fn boom(ram: &str) -> Vec<f64> {
    let text = format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = 0.2\ntime_step = 0.002\n[integrator]\nscheme = \"runge-kutta\"\n\
         [environment]\ngravity = [0.0, 0.0, -9.81]\n[[bodies]]\nname = \"boom\"\ncenter = [1.2, 0.0, 0.1]\nmass = 100.0\n\
         inertia = [2.0, 30.0, 30.0]\n[[joints]]\nname = \"hinge\"\nkind = \"revolute\"\naxis = [0.0, -1.0, 0.0]\n\
         from = {{ ground = [0.0, 0.0, 0.0] }}\nto = {{ body = \"boom\" }}\n{ram}"
    );
    let model = read_deck(&text);
    let body = crate::support::node(&model, "boom");
    let done = run_to_the_end(&model, &mut |frame: &Frame| {
        let node = &frame.state.nodes[body];
        vec![node.x.x, node.x.z, node.v.x, node.v.z]
    });
    done.rows.last().unwrap().clone()
}

const ENDS: &str =
    "name = \"ram\"\nfrom = { ground = [0.4, 0.0, -0.8] }\nto = { body = \"boom\", point = [0.9, 0.0, -0.1] }\n";

/// Forces, springs and dampers of both go along the same line; only the order of sums differs.
#[test]
fn an_actuator_pushes_like_a_link() {
    let link = boom(&format!("[[links]]\n{ENDS}preload = -2000.0\nstiffness = 500.0\ndamping = 50.0\n"));
    let ram = "effort = { value = 2000.0 }\nstiffness = 500.0\ndamping = 50.0\n";
    for actuator in [format!("[[actuators]]\n{ENDS}{ram}"), format!("[[joints]]\nkind = \"actuator\"\n{ENDS}{ram}")] {
        let found = boom(&actuator);
        for (found, link) in found.iter().zip(&link) {
            assert!((found - link).abs() < 1e-11, "{found} for {link}");
        }
    }
    // The force alone lifts the boom, which falls without it.
    assert!(link[1] > 0.1 && boom("")[1] < 0.1);
}
