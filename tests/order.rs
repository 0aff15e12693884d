//! Order of convergence, measured: error against references over ladders of time steps and of element sizes.
//! `cargo test --test order -- --nocapture --test-threads 1` shows the tables.

mod support;

use rdsolve::model::Model;
use rdsolve::solve::Frame;
use support::{body_omega, error, node, position, read, reference, run_to_the_end, slope};

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
        read(self.deck, &sets)
    }

    /// Runs at the steps `interval / division` and shows the table.
    fn ladder(&self, divisions: &[u32]) -> Vec<Rung> {
        let exact = reference(self.deck);
        println!("\n{} {}", self.deck, self.sets.join(" "));
        println!(
            "{:>12} {:>10} {:>6} {:>9} {:>13} {:>9}",
            "step", "error", "order", "it/step", "factorizations", "loop s"
        );
        let mut rungs: Vec<Rung> = Vec::new();
        for &division in divisions {
            let step = self.interval / f64::from(division);
            let model = self.model(step);
            let done = run_to_the_end(&model, &mut (self.probe)(&model));
            let error = error(&done.rows, &exact, self.skip);
            let order = rungs.last().map_or(String::new(), |last: &Rung| {
                format!("{:.2}", (last.error / error).ln() / (last.step / step).ln())
            });
            let c = done.counts;
            println!(
                "{step:12.5e} {error:10.3e} {order:>6} {:9.2} {:13} {:9.4}",
                c.iterations as f64 / c.steps as f64,
                c.factorizations,
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
    sets: &[],
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
            let q = nodes[hub].q;
            let turned = 2.0 * q.k.atan2(q.w);
            angle = turned + ((angle - turned) / std::f64::consts::TAU).round() * std::f64::consts::TAU;
            let [x_1, x_2] = [nodes[tip_1].x, nodes[tip_2].x];
            vec![angle, x_1.x, x_1.y, x_2.x, x_2.y]
        })
    },
    skip: 0,
};

const SPRING_CHAIN: Scene = Scene {
    deck: "stiff_spring_chain",
    sets: &[],
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
    deck: "stiff_pendulum",
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
    let rungs = FREE_BODY.ladder(&[5, 10, 20, 40, 80, 160, 320, 640, 1280, 2560]);
    assert_order(&rungs[rungs.len() - 4..], 1.8, 2.3);
    assert!(last(&rungs) < 1e-5);
}

#[test]
fn r3() {
    let rungs = TWO_BODIES.ladder(&[1, 2, 4, 8, 16, 32, 64, 128, 256]);
    assert_order(&rungs[rungs.len() - 4..], 1.8, 2.3);
    assert!(last(&rungs) < 1e-5);
}

#[test]
fn b1() {
    let rungs = RIGHT_ANGLE.ladder(&[1, 2, 4, 8, 16, 32]);
    assert_order(&rungs[rungs.len() - 4..], 1.8, 2.3);
    assert!(last(&rungs) < 1e-3);
}

#[test]
fn b2() {
    let rungs = FLYING_BEAM.ladder(&[1, 2, 4, 8, 16, 32]);
    assert_order(&rungs[rungs.len() - 4..], 1.8, 2.3);
    assert!(last(&rungs) < 1e-3);
}

#[test]
fn c1() {
    let rungs = BLOCK.ladder(&[1, 2, 4, 8, 16, 32, 64]);
    assert_order(&rungs[rungs.len() - 4..], 1.8, 2.3);
    assert!(last(&rungs) < 1e-3);
}

#[test]
fn c2() {
    let rungs = HUB.ladder(&[1, 2, 4, 8, 16, 32, 64]);
    assert_order(&rungs[rungs.len() - 4..], 1.8, 2.3);
    assert!(last(&rungs) < 1e-3);
}

#[test]
fn x1() {
    let rungs = SPRING_CHAIN.ladder(&[1, 2, 4, 8, 16, 32]);
    assert!(last(&rungs) < 1.0);
}

#[test]
fn x2() {
    let rungs = STIFF_PENDULUM.ladder(&[1, 4, 16, 64]);
    assert!(last(&rungs) < 1.0);
}
