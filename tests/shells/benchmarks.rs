//! Statics at large rotations against the tables of Sze, Liu & Lo (Finite Elem. Anal. Des. 40, 2004), and linear ones.

use super::support;
use rdsolve::diagnostic::Source;
use rdsolve::model::{self, Model};
use rdsolve::state::Node;

pub fn read(text: &str) -> Model {
    let source = Source::new("shell.toml", text, &[]);
    let (model, problems) = model::read(&source);
    model
        .unwrap_or_else(|| panic!("{}", problems.iter().map(|p| p.draw(&source, false)).collect::<Vec<_>>().join("\n")))
}

/// Displacements at named points after every load step.
pub fn displacements(model: &Model, at: &[(&str, usize)]) -> Vec<Vec<f64>> {
    let places: Vec<(usize, usize, f64)> = at
        .iter()
        .map(|&(label, dof)| {
            let node = support::node(model, label);
            (node, dof, model.nodes[node].x[dof])
        })
        .collect();
    let began = std::time::Instant::now();
    let done = support::run_to_the_end(model, &mut |frame| {
        let u = |node: &Node, dof: usize, x: f64| node.x[dof] - x;
        places.iter().map(|&(node, dof, x)| u(&frame.state.nodes[node], dof, x)).collect()
    });
    println!("{}: {} unknowns, {:?}, {:.2} s", model.title, done.unknowns, done.counts, began.elapsed().as_secs_f64());
    done.rows
}

/// Greatest difference from a table, of the greatest value in each column.
fn worst(rows: &[Vec<f64>], table: &[Vec<f64>]) -> f64 {
    let columns = table[0].len();
    let largest: Vec<f64> = (0..columns).map(|c| table.iter().fold(0.0f64, |m, row| m.max(row[c].abs()))).collect();
    let error = |(row, wanted): (&Vec<f64>, &Vec<f64>)| {
        (0..columns).map(|c| (row[c] - wanted[c]).abs() / largest[c]).fold(0.0, f64::max)
    };
    rows.iter().zip(table).map(error).fold(0.0, f64::max)
}

const STRIP: &str = r#"
title = "cantilever"
[analysis]
kind = "static"
end_time = 1.0
time_step = 0.05
[materials.m]
model = "elastic"
youngs_modulus = 1.2e6
poisson_ratio = 0.0
[points]
a = [0.0, 0.0, 0.0]
b = [LENGTH, 0.0, 0.0]
c = [LENGTH, 1.0, 0.0]
d = [0.0, 1.0, 0.0]
[[shells]]
name = "strip"
corners = ["a", "b", "c", "d"]
elements = [16, 1]
thickness = 0.1
material = "m"
kind = "KIND"
[[supports]]
at = "strip.edge4"
fix = "all"
"#;

#[test]
fn cantilever_under_end_shear() {
    for kind in ["quadrilateral", "triangle"] {
        let deck = STRIP.replace("LENGTH", "10.0").replace("KIND", kind)
            + "[[loads]]\nat = \"strip.edge2\"\nforce_per_length = [0.0, 0.0, 4.0]\n";
        let rows = displacements(&read(&deck), &[("b", 0), ("b", 2)]);
        println!("{kind} tip: {:?}", rows.last().unwrap());
    }
}

#[test]
fn cantilever_rolled_up() {
    for kind in ["quadrilateral", "triangle"] {
        let deck = STRIP.replace("LENGTH", "12.0").replace("KIND", kind)
            + "[[loads]]\nat = [\"b\", \"c\"]\nmoment = [0.0, -26.179938779914945, 0.0]\n";
        let rows = displacements(&read(&deck), &[("b", 0), ("b", 2)]);
        println!("{kind} tip: {:?}", rows.last().unwrap());
    }
}
