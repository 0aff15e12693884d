//! Paths of equilibria by arc length: limit points, snap-through and snap-back.

#![allow(non_snake_case)]

mod support;


use rdsolve::diagnostic::Source;
use rdsolve::model::{self, Model};
use rdsolve::solve::{Frame, Outcome};
use support::{Done, node};

fn read(text: &str) -> Model {
    let source = Source::new("path.toml", text, &[]);
    let (model, problems) = model::read(&source);
    model
        .unwrap_or_else(|| panic!("{}", problems.iter().map(|p| p.draw(&source, false)).collect::<Vec<_>>().join("\n")))
}

/// Runs a deck to its end; a row is the time, then the displacements asked for. The start is left out.
fn follow(model: &Model, at: &[(&str, usize)]) -> Done {
    let places: Vec<(usize, usize)> = at.iter().map(|&(label, dof)| (node(model, label), dof)).collect();
    let mut done = support::run(model, &mut |frame: &Frame| {
        let u = |&(node, dof): &(usize, usize)| frame.state.nodes[node].x[dof] - frame.model.nodes[node].x[dof];
        std::iter::once(frame.state.time).chain(places.iter().map(u)).collect()
    });
    done.rows.remove(0);
    let (c, n) = (done.counts, done.unknowns);
    println!(
        "{}: {n} unknowns, {} steps, {} iterations, {} cuts, {:.3} s, {:?}",
        model.title, c.steps, c.iterations, c.cuts, done.seconds, done.outcome
    );
    done
}

fn follow_to_the_end(model: &Model, at: &[(&str, usize)]) -> Done {
    let done = follow(model, at);
    assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
    done
}

/// Where the rows turn in their first column.
fn turns(rows: &[Vec<f64>]) -> usize {
    rows.windows(3).filter(|r| (r[1][0] - r[0][0]) * (r[2][0] - r[1][0]) < 0.0).count()
}

/// Two bars of EA = 1000 over a span of 2, the crown 0.5 above the feet; time is the load on it.
const TRUSS: &str = r#"
title = "truss"
[analysis]
kind = "static"
control = "arc-length"
end_time = 60.0
time_step = 5.0
[points]
left = [-1.0, 0.0, 0.0]
right = [1.0, 0.0, 0.0]
crown = [0.0, 0.0, 0.5]
[[bars]]
name = "bars"
path = ["left", "crown", "right"]
axial_stiffness = 1000.0
mass_per_length = 0.0
[[supports]]
at = ["left", "right"]
fix = "translations"
"#;

const ON_CROWN: &str = r#"
[[loads]]
at = "crown"
force = [0.0, 0.0, -60.0]
"#;

/// P(w) of the truss: 2 EA (L − l)/L (h − w)/l.
fn truss(w: f64) -> f64 {
    let (L, z): (f64, f64) = (1.25f64.sqrt(), 0.5 - w);
    let l = (1.0 + z * z).sqrt();
    2000.0 * (L - l) / L * z / l
}

#[test]
fn truss_snaps_through() {
    let model = read(&format!("{TRUSS}{ON_CROWN}"));
    let done = follow_to_the_end(&model, &[("crown", 2), ("crown", 0)]);
    let rows = &done.rows;
    for row in rows {
        let exact = truss(-row[1]);
        println!("{row:?} {exact} {:e}", row[0] - exact);
    }
    for row in rows {
        assert!((row[0] - truss(-row[1])).abs() < 1e-8 * 60.0 && row[2].abs() < 1e-12, "{row:?}");
    }
    assert_eq!(rows.last().unwrap()[0], 60.0);
    assert_eq!(turns(rows), 2);
}

#[test]
fn truss_behind_a_spring_snaps_back() {
    let spring = r#"
[[links]]
name = "spring"
from = { node = "crown" }
to = { node = "hand" }
direction = [0.0, 0.0, 1.0]
stiffness = 40.0
[[loads]]
at = "hand"
force = [0.0, 0.0, -60.0]
"#;
    let deck = format!("{TRUSS}{spring}").replace("crown = [", "hand = [0.0, 0.0, 1.0]\ncrown = [");
    let done = follow_to_the_end(&read(&deck), &[("crown", 2), ("hand", 2)]);
    let rows = &done.rows;
    for row in rows {
        let p = truss(-row[1]);
        println!("{row:?} {p} {:e} {:e}", row[0] - p, -row[2] + row[1] - p / 40.0);
    }
    for row in rows {
        let p = truss(-row[1]);
        assert!((row[0] - p).abs() < 1e-8 * 60.0 && (-row[2] + row[1] - p / 40.0).abs() < 1e-8, "{row:?}");
    }
    // The hand goes back as the load does.
    assert!(rows.windows(2).any(|r| r[1][2] > r[0][2] + 0.01 && r[1][0] < r[0][0]));
    assert_eq!(turns(rows), 2);
}
