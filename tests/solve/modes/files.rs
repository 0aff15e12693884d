//! What an analysis of modes writes and says.

use super::head;
use crate::support::grid::Grid;
use assert_cmd::Command;
use std::fs;
use std::path::Path;

fn rdsolve(folder: &Path, arguments: &[&str]) -> (i32, String) {
    let done = Command::cargo_bin("rdsolve").unwrap().current_dir(folder).args(arguments).output().unwrap();
    let text = [done.stdout, done.stderr].map(|bytes| String::from_utf8(bytes).unwrap()).concat();
    (done.status.code().unwrap(), text)
}

fn arm(analysis: &str, more: &str) -> String {
    head(analysis, 0.02, 0.01)
        + "[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n[[beams]]\nname = \"arm\"\npath = [\"a\", \"b\"]\nelements = 4\n\
           material = \"steel\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\n[[supports]]\nat = \"a\"\nfix = \"all\"\n"
        + more
}

#[test]
fn tables_grids_and_the_page() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let text = arm(
        "modes = 3",
        "[output]\nfields = { format = \"vtu\" }\n[[expect]]\nmode = 1\nquantity = \"frequency\"\nat_least = 8.3\n",
    );
    fs::write(here.join("arm.toml"), text).unwrap();
    let (code, said) = rdsolve(here, &["arm.toml"]);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("ok   frequency of mode 1: 8.35"), "{said}");
    let rows = |file: &str| fs::read_to_string(here.join("arm.out").join(file)).unwrap().lines().count() - 1;
    // A row for each mode; for each mode and part; for each mode and named point.
    assert_eq!([rows("modes.csv"), rows("mode_parts.csv"), rows("mode_shapes.csv")], [3, 3, 6]);
    let list = fs::read_to_string(here.join("arm.out/modes.pvd")).unwrap();
    for mode in 1..=3 {
        let name = format!("mode_{mode:04}.vtu");
        assert!(list.contains(&name), "{list}");
        let grid = Grid::read(&here.join("arm.out").join(name)).xml;
        assert!(grid.contains("Name=\"displacement\"") && !grid.contains("displacement_ahead"), "{mode}");
    }
    let (code, said) = rdsolve(here, &["report", "arm.out"]);
    assert_eq!(code, 0, "{said}");
    let page = fs::read_to_string(here.join("arm.html")).unwrap();
    assert!(page.contains("modes 1 to 3 of 3 swing"), "no modes in the page");
    // Complex modes have a motion ahead too, and the folder is cleared of what the run before has written.
    let (code, said) =
        rdsolve(here, &["arm.toml", "--overwrite", "--set", "analysis.damped=true", "--set", "analysis.modes=2"]);
    assert_eq!(code, 0, "{said}");
    assert!(!here.join("arm.out/mode_0003.vtu").exists());
    assert!(Grid::read(&here.join("arm.out/mode_0001.vtu")).xml.contains("displacement_ahead"));
}

#[test]
fn what_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let run = |name: &str, text: &str, more: &[&str]| {
        fs::write(here.join(name), text).unwrap();
        rdsolve(here, &[&[name], more].concat())
    };
    let (code, said) = run("low.toml", &arm("up_to = 1.0", ""), &[]);
    assert!(code == 0 && said.contains("warning: no mode lies below `up_to` = 1"), "{code} {said}");
    // A mass stands on a rod that is hinged at its foot: it falls over, as exp(√(g/L) t).
    let rod = "[analysis]\nkind = \"modal\"\nmodes = 1\nplane = \"auto\"\n[environment]\ngravity = [0.0, 0.0, -9.81]\n[[bodies]]\nname = \"rod\"\n\
               center = [0.0, 0.0, 1.0]\nmass = 3.0\ninertia = [1e-9, 1e-9, 1e-9]\n[[joints]]\nname = \"foot\"\nkind = \"revolute\"\n\
               from = { ground = [0.0, 0.0, 0.0] }\nto = { body = \"rod\" }\naxis = [0.0, 1.0, 0.0]\n";
    let (code, said) = run("rod.toml", rod, &[]);
    assert!(code == 0 && said.contains("the state is unstable: mode 1 grows with rate 3.132"), "{code} {said}");
    // Nothing holds a free beam against its weight: no equilibrium, no modes.
    let free = arm("", "[environment]\ngravity = [0.0, 0.0, -9.81]\n").replace("fix = \"all\"", "fix = [\"ux\"]");
    let (code, said) = run("free.toml", &free, &[]);
    assert!(code == 4 && said.contains("singular"), "{code} {said}");
    let (code, said) = rdsolve(here, &["study", "low.toml"]);
    assert!(code == 3 && said.contains("computes modes"), "{code} {said}");
    let (code, said) = rdsolve(here, &["check", "low.toml"]);
    assert!(code == 0 && said.contains("natural modes, all up to 1 per time"), "{code} {said}");
}

/// A Campbell diagram is a sweep of speeds.
#[test]
fn campbell_diagram_by_a_sweep() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let deck = fs::read_to_string(crate::support::decks().join("rotor_whirl/deck.toml")).unwrap();
    fs::write(here.join("rotor.toml"), deck.split("# ---- expected").next().unwrap()).unwrap();
    let sweep = "deck = \"rotor.toml\"\n[vary]\n\"bodies.disc.angular_velocity[0]\" = [0.0, 600.0]\n[collect]\n\
                 backward = { at = \"2\", quantity = \"angular_frequency\", time = \"end\" }\n\
                 forward = { at = \"3\", quantity = \"angular_frequency\", time = \"end\" }\n";
    fs::write(here.join("speeds.toml"), sweep).unwrap();
    let (_, said) = rdsolve(here, &["sweep", "speeds.toml"]);
    let summary = fs::read_to_string(here.join("speeds.out/summary.csv")).unwrap();
    let numbers: Vec<Vec<f64>> = summary
        .lines()
        .skip(1)
        .map(|line| line.split(',').skip(3).filter_map(|field| field.parse().ok()).collect())
        .collect();
    assert_eq!(numbers.len(), 2, "{summary} {said}");
    // At rest both are equal; at 600 rad/s as in the deck.
    assert!((numbers[0][0] / numbers[0][1] - 1.0).abs() < 1e-6, "{summary}");
    assert!((numbers[1][0] - 74.0264).abs() < 1e-3 && (numbers[1][1] - 119.5728).abs() < 1e-3, "{summary}");
}
