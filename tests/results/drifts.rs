//! Drifts of two points, in their table and in `[[expect]]`, and the modes and curves that the terminal prints.

use crate::support::{read_deck, run_to_the_end, tables_of};
use assert_cmd::Command;
use rdsolve::solve::Frame;
use std::fs;

/// The top moves by (0.3, -0.4, 0) and the foot by (0, 0, 0.1), a bar between them from (0, 0, 0) to (0, 0, 3).
const STOREY: &str = "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 0.25\n[points]\nfoot = [0.0, 0.0, 0.0]\n\
    top = [0.0, 0.0, 3.0]\nq = [5.0, 0.0, 0.0]\nr = [6.0, 0.0, 0.0]\n[[bars]]\nname = \"free\"\npath = [\"q\", \"r\"]\naxial_stiffness = 1.0\n\
    [[supports]]\nat = \"q\"\nfix = \"translations\"\n[[supports]]\nat = \"r\"\nfix = [\"uy\", \"uz\"]\n[[bars]]\nname = \"post\"\npath = [\"foot\", \"top\"]\naxial_stiffness = 100.0\n\
    [amplitudes.r]\nkind = \"ramp\"\nend = 1.0\n[[supports]]\nat = \"foot\"\nfix = [\"ux\", \"uy\"]\n\
    motion = { uz = { amplitude = \"r\", scale = 0.1 } }\n[[supports]]\nat = \"top\"\nfix = [\"uz\"]\n\
    motion = { ux = { amplitude = \"r\", scale = 0.3 }, uy = { amplitude = \"r\", scale = -0.4 } }\n\
    [[drifts]]\nname = \"storey 1\"\nfrom = \"foot\"\nto = \"top\"\n[output]\nreactions = true\n";

#[test]
fn drifts_are_those_of_a_hand_calculation() {
    let length = (0.25_f64 + 2.9 * 2.9).sqrt();
    let known =
        [("ux", 0.3), ("uy", -0.4), ("uz", -0.1), ("distance", length - 3.0), ("lateral", 0.5), ("ratio", 0.5 / 3.0)];
    let rows = tables_of(&read_deck(STOREY)).rows("drifts.csv");
    assert_eq!((rows.len(), rows[4].text("drift")), (5, "storey 1"));
    let expected: String = known
        .iter()
        .map(|(quantity, value)| {
            format!(
                "[[expect]]\nat = \"storey 1\"\nquantity = \"{quantity}\"\ntime = 1.0\nvalue = {value:?}\ntolerance = 1e-12\n"
            )
        })
        .collect();
    for (quantity, value) in known {
        assert!((rows[4].number(quantity) - value).abs() < 1e-13, "{quantity}: {}", rows[4].number(quantity));
    }
    let done = run_to_the_end(&read_deck(&format!("{STOREY}{expected}")), &mut |_: &Frame| Vec::new());
    assert!(done.verdicts.len() == 6 && done.verdicts.iter().all(|verdict| verdict.passed), "{:?}", done.verdicts);
    // Points that coincide have no line between them, so no ratio.
    let close = STOREY.replace("top = [0.0, 0.0, 3.0]", "top = [0.0, 0.0, 3.0]\nnear = [0.0, 0.0, 3.0]");
    let close = close.replace("from = \"foot\"", "from = \"near\"").replace(
        "[output]\n",
        "[[bars]]\nname = \"other\"\npath = [\"foot\", \"near\"]\naxial_stiffness = 1.0\n[[supports]]\nat = \"near\"\nfix = [\"ux\", \"uy\", \"uz\"]\n[output]\n",
    );
    let rows = tables_of(&read_deck(&close)).rows("drifts.csv");
    assert_eq!((rows[4].text("ratio"), rows[4].number("lateral")), ("", 0.5));
}

fn told(folder: &std::path::Path, arguments: &[&str], code: i32) -> String {
    let done = Command::cargo_bin("rdsolve").unwrap().current_dir(folder).args(arguments).assert().code(code);
    String::from_utf8([&done.get_output().stdout[..], &done.get_output().stderr[..]].concat()).unwrap()
}

/// The reaction of the top over its drift: the force of the bar, E A (ℓ − ℓ₀)/ℓ₀, times the slope of the bar at the end; the work is the
/// energy that the bar stores less what the foot does, by trapezoids.
#[test]
fn a_curve_goes_over_two_tables() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("d.toml"), STOREY).unwrap();
    told(at, &["d.toml", "--quiet"], 0);
    let axes = ["drifts.csv:storey 1:ux", "reactions.csv:top ux:value"];
    let csv = told(at, &["summary", "d.out", "--curve", axes[0], axes[1], "--format", "csv"], 0);
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!((lines.len(), lines[0]), (6, "time,drifts.csv:storey 1:ux,reactions.csv:top ux:value"));
    let last: Vec<f64> = lines[5].split(',').map(|field| field.parse().unwrap()).collect();
    let length = (0.25_f64 + 2.9 * 2.9).sqrt();
    let force = 100.0 * (length - 3.0) / 3.0 * 0.3 / length;
    assert!((last[1] - 0.3).abs() < 1e-13 && (last[2] - force).abs() < 1e-8, "{last:?} {force}");
    let text = told(at, &["summary", "d.out", "--curve", axes[0], "-reactions.csv:* ux:value"], 0);
    assert!(text.starts_with("-reactions.csv:* ux:value over drifts.csv:storey 1:ux: 5 points"), "{text}");
    // Foot and top are in balance, so their sum does no work.
    assert!(text.contains("work along the curve"), "{text}");
    assert!(told(at, &["summary", "d.out", "--curve", "drifts.csv:x:ux", axes[1]], 6).contains("no row is about `x`"));
    // Filters refuse rows that do not hold their frequencies, and `--only` shows single columns.
    assert!(told(at, &["summary", "d.out", "--filter", "cfc60"], 6).contains("below the cutoff frequency"));
    let smooth = told(at, &["summary", "d.out", "--filter", "butterworth:1", "--only", "drifts.csv:ux", "ratio"], 0);
    assert!(
        smooth.contains("filtered: Butterworth of order 2, cutoff frequency 1, forwards and backwards"),
        "{smooth}"
    );
    assert!(smooth.contains("  ux: ") && !smooth.contains("uy"), "{smooth}");
}

/// A mass on a spring: its frequency, period and the whole of its mass; other directions have none.
#[test]
fn modes_are_listed_in_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let deck = "[analysis]\nkind = \"modal\"\nmodes = 1\n[[bodies]]\nname = \"ball\"\ncenter = [1.0, 0.0, 0.0]\nmass = 2.0\n\
                inertia = [1.0, 1.0, 1.0]\n[[supports]]\nat = \"ball\"\nfix = [\"uy\", \"uz\", \"rx\", \"ry\", \"rz\"]\n[[links]]\nname = \"s\"\n\
                from = { ground = [0.0, 0.0, 0.0] }\nto = { body = \"ball\" }\nstiffness = 50.0\n";
    fs::write(folder.path().join("d.toml"), deck).unwrap();
    let lines = told(folder.path(), &["d.toml"], 0);
    let words = |line: &str| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    let table: Vec<Vec<String>> = lines.lines().map(words).collect();
    let place = table.iter().position(|line| line.first().is_some_and(|word| word == "mode")).unwrap();
    assert_eq!(table[place], ["mode", "frequency", "period", "mass", "x", "mass", "y", "mass", "z"]);
    let frequency = (50.0_f64 / 2.0).sqrt() / std::f64::consts::TAU;
    let digits = |x: f64| rdsolve::names::to_digits(x, 5);
    assert_eq!(table[place + 1][..5], ["1", &digits(frequency), &digits(1.0 / frequency), "100.0", "%"]);
    let log = fs::read_to_string(folder.path().join("d.out/run.log")).unwrap();
    assert!(log.contains("  mode  frequency"), "{log}");
}

/// A response has one time: its summary names the frequency of a peak, and its curves go over the frequency.
#[test]
fn a_response_is_summed_up_over_its_frequency() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let deck = "[analysis]\nkind = \"frequency-response\"\nfrequencies = [0.5, 1.0, 2.0]\n[[bodies]]\nname = \"a\"\ncenter = [1.0, 0.0, 0.0]\nmass = 1.0\n\
        inertia = [1.0, 1.0, 1.0]\n[[links]]\nname = \"k\"\nfrom = { ground = [0.0, 0.0, 0.0] }\nto = { body = \"a\" }\nstiffness = 40.0\ndamping = 1.0\n\
        [[loads]]\nat = \"a\"\nforce = [1.0, 0.0, 0.0]\namplitude = \"shake\"\n[amplitudes.shake]\nkind = \"harmonic\"\n";
    fs::write(at.join("r.toml"), deck).unwrap();
    told(at, &["r.toml", "--quiet"], 0);
    let text = told(at, &["summary", "r.out", "--only", "response.csv:ux"], 0);
    assert!(text.contains("(a, frequency = 1)\n") && !text.contains("at the end") && !text.contains("t = "), "{text}");
    let curve = ["summary", "r.out", "--curve", "response.csv:a:frequency", "response.csv:a:ux"];
    let text = told(at, &curve, 0);
    assert!(text.contains("3 points") && text.contains("at 1 (frequency = 1)"), "{text}");
    assert!(
        told(at, &[&curve[..], &["--format", "csv"]].concat(), 0).starts_with("frequency,response.csv:a:frequency,")
    );
    let filtered = told(at, &[&curve[..], &["--filter", "butterworth:1"]].concat(), 2);
    assert!(filtered.contains("a filter goes over time"), "{filtered}");
}
