//! Links that are pulled to a force in a static stage: what they hold together, what they carry afterwards, and how it swings.

use crate::support::run_source;
use rdsolve::diagnostic::Source;
use rdsolve::model::Link;
use rdsolve::solve::{Frame, Outcome};

/// A flange of 8e8 N/m between the ground and a plate of 20 kg, and a bolt of 2e8 N/m beside it.
fn bolted(stages: &str, bolt: &str, others: &str) -> String {
    format!(
        r#"
{stages}
[points]
plate = [0.1, 0.0, 0.0]
[[masses]]
at = "plate"
mass = 20.0
[[supports]]
at = "plate"
fix = ["uy", "uz"]
[[links]]
name = "flange"
from = {{ ground = [0.0, 0.0, 0.0] }}
to = {{ node = "plate" }}
law = "compression-only"
stiffness = 8e8
[[links]]
name = "bolt"
from = {{ ground = [0.0, 0.0, 0.0] }}
to = {{ node = "plate" }}
{bolt}
pretension = 40e3
[output]
links = true
{others}
"#
    )
}

const PULL: &str = "[[stages]]\nname = \"tighten\"\nkind = \"static\"\nduration = 1.0\ntime_step = 0.25\n";
const SERVE: &str = "[[stages]]\nname = \"serve\"\nkind = \"static\"\nduration = 1.0\ntime_step = 0.125\n";

/// Time, displacement of the plate, forces of the named links, mechanical energy, what came from outside and what is missing.
fn rows(text: &str, names: &[&str]) -> Vec<Vec<f64>> {
    let probe = &mut |frame: &Frame| {
        let plate = frame.model.nodes.iter().position(|node| node.label == "plate").expect("the plate");
        let energy = frame.derived.energy.expect("energies");
        let force = |name: &&str| {
            let index = frame.model.each::<Link>().position(|link| link.name == **name).expect("the link");
            frame.derived.links[index].force
        };
        let moved = frame.state.nodes[plate].x.x - frame.model.nodes[plate].x.x;
        let forces: Vec<f64> = names.iter().map(force).collect();
        [vec![frame.state.time, moved], forces, vec![energy.mechanical, energy.external, energy.numerical]].concat()
    };
    let done = run_source(&Source::new("bolt.toml", text, &[]), probe);
    assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
    done.rows
}

/// The diagram of a bolted joint: of a force P on the plate the bolt takes P k_b/(k_b + k_f) until the flange opens at F (k_b + k_f)/k_f, and all of
/// it beyond. What the wrench has done is F²/2k_b + F²/2k_f.
#[test]
fn a_bolted_joint() {
    let (kb, kf, F) = (2e8, 8e8, 40e3);
    let pull = "[[loads]]\nat = \"plate\"\nforce = [100e3, 0.0, 0.0]\nstages = [\"serve\"]\n";
    let laws = [
        "stiffness = 2e8",
        "stiffness = 2e8\nlaw = \"tension-only\"",
        "law = \"table\"\npoints = [[-1.0, -2e8], [0.0, 0.0], [1.0, 2e8]]",
    ];
    for law in laws {
        for row in rows(&bolted(&format!("{PULL}{SERVE}"), law, pull), &["bolt", "flange"]) {
            let [time, moved, bolt, flange, mechanical, external, numerical] = row[..] else { panic!("{row:?}") };
            let P = 100e3 * (time - 1.0).max(0.0);
            let F = F * time.min(1.0);
            let exact = if P < F * (kb + kf) / kf { F + P * kb / (kb + kf) } else { P };
            assert!((bolt - exact).abs() < 1e-9 * 100e3, "{law}: {row:?} {exact}");
            assert!((bolt + flange - P).abs() < 1e-9 * 100e3, "{law}: {row:?}");
            assert!((moved - flange.min(0.0) / kf).abs() < 1e-15 || P > F, "{law}: {row:?}");
            if time <= 1.0 {
                let work = 0.5 * F * F * (1.0 / kb + 1.0 / kf);
                assert!((external - work).abs() < 1e-9 && (mechanical - work).abs() < 1e-9, "{law}: {row:?} {work}");
            }
            // Steps that straddle the opening of the flange are the whole error of the trapezoidal rule: their work is off by no more than the
            // change of force over the step times what the flange moves in it.
            assert!(numerical.abs() < if time > 1.4 { 0.2 } else { 1e-9 }, "{law}: {row:?}");
        }
    }
}

/// After the blow of a load that is let go the plate swings on bolt and flange together, and the bolt about its pretension.
#[test]
fn a_bolted_plate_swings() {
    let swing = "[[stages]]\nname = \"swing\"\nkind = \"dynamic\"\nduration = 2e-3\ntime_step = 2e-6\n[integrator]\nscheme = \"SCHEME\"\n";
    let pull = "[[loads]]\nat = \"plate\"\nforce = [20e3, 0.0, 0.0]\nstages = [\"serve\"]\n";
    let omega = (1e9f64 / 20.0).sqrt();
    for scheme in ["newmark", "generalized-alpha", "bathe", "esdirk3", "central-difference", "runge-kutta"] {
        let stages = format!("{PULL}{SERVE}{}", swing.replace("SCHEME", scheme));
        let rows = rows(&bolted(&stages, "stiffness = 2e8", pull), &["bolt"]);
        for row in rows.iter().filter(|row| row[0] > 2.0) {
            let exact = 40e3 + 20e3 * 0.2 * (omega * (row[0] - 2.0)).cos();
            // (ωΔt)²/12 of 14 rad of phase are 2.3e-4 of the amplitude of 4000 N; of schemes with errors a few times larger.
            assert!((row[2] - exact).abs() < 5.0, "{scheme}: {row:?} {exact}");
        }
        assert!((rows.last().unwrap()[0] - 2.002).abs() < 1e-9, "{scheme}");
    }
}

/// A mass between two ropes: the force to which one of them is pulled is all that holds it across, ω² = F/m (1/L₁ + 1/L₂) with the lengths after
/// that, in a stage of modes and in motion.
#[test]
fn ropes_are_tuned_by_pretension() {
    let ropes = |stages: &str, others: &str| {
        let rope = |name: &str, x: f64, pretension: &str| {
            format!(
                "[[links]]\nname = \"{name}\"\nfrom = {{ ground = [{x:?}, 0.0, 0.0] }}\nto = {{ node = \"plate\" }}\n\
                 law = \"tension-only\"\nstiffness = 1e6\n{pretension}\n"
            )
        };
        format!(
            "{stages}{others}[points]\nplate = [0.0, 0.0, 0.0]\n[[masses]]\nat = \"plate\"\nmass = 0.5\n{}{}\
             [output]\nlinks = true\n",
            rope("left", -2.0, "pretension = 500.0"),
            rope("right", 2.0, "")
        )
    };
    let held = "[[supports]]\nat = \"plate\"\nfix = [\"uy\", \"uz\"]\nstages = [\"tighten\"]\n";
    let swing = "[[stages]]\nname = \"swing\"\nkind = \"dynamic\"\nduration = 1.0\ntime_step = 5e-4\n[integrator]\nscheme = \"newmark\"\n\
                 [[initial]]\nat = \"plate\"\nvelocity = [0.0, 0.01, 0.0]\n";
    let omega = (500.0 / 0.5 * (1.0 / 1.9995 + 1.0 / 2.0005f64)).sqrt();
    let text = ropes(&format!("{PULL}{swing}"), held);
    let probe = &mut |frame: &Frame| {
        let plate = frame.model.nodes.iter().position(|node| node.label == "plate").expect("the plate");
        vec![frame.state.time, frame.state.nodes[plate].x.y, frame.derived.links[1].force]
    };
    let done = run_source(&Source::new("ropes.toml", &text, &[]), probe);
    assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
    for row in done.rows.iter().filter(|row| row[0] > 1.0) {
        let exact = 0.01 / omega * (omega * (row[0] - 1.0)).sin();
        // (ωΔt)²/12 of 32 rad of phase: 7e-4 of the amplitude; the amplitude of 0.3 mm stiffens the ropes by k a²/2L²/F = 2e-5.
        assert!((row[1] - exact).abs() < 1e-3 * 0.01 / omega, "{row:?} {exact}");
        assert!((row[2] - 500.0).abs() < 0.1, "{row:?}");
    }
    let modes = "[[stages]]\nname = \"tune\"\nkind = \"modal\"\nmodes = 3\n";
    let expect = |mode: usize, value: f64| {
        let of = "quantity = \"angular_frequency\"\ntolerance = 1e-9\nsource = \"closed form\"";
        format!("[[expect]]\nmode = {mode}\nvalue = {value:?}\n{of}\n")
    };
    let expected = [expect(1, omega), expect(2, omega), expect(3, (2e6f64 / 0.5).sqrt())].concat();
    let done =
        run_source(&Source::new("ropes.toml", &(ropes(&format!("{PULL}{modes}"), held) + &expected), &[]), probe);
    assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
    assert_eq!(done.verdicts.len(), 3);
    for verdict in &done.verdicts {
        assert!(verdict.passed, "{verdict:?}");
    }
}

/// A bolt fails at its force in the stage that follows; what it had stored is lost, and the plate leaves.
#[test]
fn a_pretensioned_bolt_fails() {
    let swing = "[[stages]]\nname = \"tear\"\nkind = \"dynamic\"\nduration = 1e-3\ntime_step = 1e-6\n[integrator]\nscheme = \"newmark\"\n";
    let pull = "[[loads]]\nat = \"plate\"\nforce = [60e3, 0.0, 0.0]\nstages = [\"tear\"]\n";
    let bolt = "stiffness = 2e8\nfailure = { normal = 55e3 }";
    let rows = rows(&bolted(&format!("{PULL}{swing}"), bolt, pull), &["bolt"]);
    let highest = rows.iter().map(|row| row[2]).fold(0.0, f64::max);
    assert!(highest > 54e3 && highest < 56e3 && rows.last().unwrap()[2] == 0.0, "{highest} {:?}", rows.last());
}

/// The matrix of a link that is taken up, damper and all, is the derivative of its forces.
#[test]
fn tangents_are_those_of_forces() {
    use rdsolve::elements::damper::Damper;
    use rdsolve::elements::link::{LinkLaw, Links};
    use rdsolve::elements::{Mechanics, Moduli, link};
    use rdsolve::math::Vec3;
    use rdsolve::state::{Configuration, Node};
    let start = [Vec3::new(0.3, -0.2, 0.1), Vec3::new(1.0, 0.7, -0.4), Vec3::new(0.3, -0.2, 0.1)];
    for direction in [None, Some(Vec3::new(0.6, 0.0, 0.8))] {
        let law = LinkLaw::Linear { stiffness: 20.0, preload: 0.0 };
        let of =
            link::Link::new([0, 1], law, Damper::linear(0.7), direction, 0.9, [start[0], start[1]]).taken_up(Some(2));
        let block = Links::new(vec![of]);
        let mut nodes = start.map(Node::at_rest);
        for (i, node) in nodes.iter_mut().enumerate() {
            node.x += Vec3::new(0.1, -0.05 * i as f64, 0.07);
            node.v = Vec3::new(0.4 - i as f64, 0.3, 0.2 * i as f64);
        }
        let forces = |nodes: &[Node; 3]| {
            let mut F = vec![[0.0; 6]; 3];
            block.subtract_forces(&Configuration::of(nodes), &mut F);
            F
        };
        let mut K = vec![0.0; 81];
        block.tangent(0, &Configuration::of(&nodes), 0.3, Moduli::Algorithmic, &mut K);
        let h = 1e-6; // central differences: h² = 1e-12 and rounding 1e-16/h
        for column in 0..9 {
            let moved = |by: f64| {
                let mut nodes = nodes;
                nodes[column / 3].x[column % 3] += by;
                nodes[column / 3].v[column % 3] += 0.3 * by;
                forces(&nodes)
            };
            let (ahead, back) = (moved(h), moved(-h));
            for row in 0..9 {
                let exact = -(ahead[row / 3][row % 3] - back[row / 3][row % 3]) / (2.0 * h);
                assert!((K[9 * row + column] - exact).abs() < 1e-8 * 20.0, "{direction:?} {row} {column}: {exact}");
            }
        }
    }
}

/// Ends have no order: the bolt carries the load alone once the flange is open, named from either side.
#[test]
fn a_bolt_may_be_named_from_the_end_that_moves() {
    let pull = "[[loads]]\nat = \"plate\"\nforce = [100e3, 0.0, 0.0]\nstages = [\"serve\"]\n";
    let text = bolted(&format!("{PULL}{SERVE}"), "stiffness = 2e8", pull);
    let ends = "from = { ground = [0.0, 0.0, 0.0] }\nto = { node = \"plate\" }\nstiffness";
    let exchanged = text.replace(ends, "from = { node = \"plate\" }\nto = { ground = [0.0, 0.0, 0.0] }\nstiffness");
    assert_ne!(text, exchanged);
    let [one, other] = [&text, &exchanged].map(|text| rows(text, &["bolt", "flange"]));
    assert_eq!(one.len(), other.len());
    for (a, b) in one.iter().zip(&other) {
        for k in [2, 3] {
            // Of 100 kN.
            assert!((a[k] - b[k]).abs() < 1e-4, "{a:?} {b:?}");
        }
    }
}
