//! `rdsolve study`: ladders, axes of the grid, what automatic steps reach, confirmed references, recommendations.

use super::{KEYS, OSCILLATOR, STRIP, exact, folder, number, study, table, well_formed};
use std::fs;

const QUICK: [&str; 4] = ["--repeats", "1", "--quiet", "--overwrite"];

#[test]
fn ladders_go_by_quarters_of_a_decade() {
    let folder = folder(OSCILLATOR);
    let steps = |arguments: &[&str]| -> Vec<f64> {
        study(folder.path(), &[&QUICK[..], &["--samples", "1"], arguments].concat(), 0);
        table(&folder.path().join("x.study/study.csv")).iter().map(|row| number(row, "time_step")).collect()
    };
    let found = steps(&["--time-steps", "1e-2..1e-3"]);
    assert_eq!((found.len(), found[0], found[4]), (5, 1e-2, 1e-3));
    // Each fits a whole number of times into the second, which moves a step of n by 1/n at most.
    assert!(found.windows(2).all(|pair| (pair[0] / pair[1] / 10f64.powf(0.25) - 1.0).abs() < 0.01), "{found:?}");
    let keys = "[study]\ntime_steps = { from = 1e-3, to = 1e-2, per_decade = 2 }\n";
    fs::write(folder.path().join("x.toml"), format!("{OSCILLATOR}{keys}")).unwrap();
    assert_eq!(steps(&[]).len(), 3);
    let wrong = "[study]\ntime_steps = { from = 0.0, to = -1e-2 }\nerror_tolerances = { from = 1e-1, to = 1e-4, per_decade = 90 }\n\
                 iteration_tolerances = { from = 1e-300, to = 1e-2 }\nbeam_orders = [0, 5]\n";
    fs::write(folder.path().join("x.toml"), format!("{OSCILLATOR}{wrong}")).unwrap();
    let said = study(folder.path(), &QUICK, 3).1;
    for word in [
        "`time_steps` must be above zero",
        "`per_decade` must lie between 1 and 20",
        "`iteration_tolerances` has 1192 steps",
        "`beam_orders` can be 1, 2, 3 or 4",
    ] {
        assert!(said.contains(word), "{word}: {said}");
    }
    study(folder.path(), &["--time-steps", "1e-2..0"], 2);
}

#[test]
fn tolerances_of_the_iteration_and_orders_of_beams_are_lines() {
    let folder = folder(STRIP);
    let common =
        ["--quantities", "tip.uz", "--samples", "50", "--time-steps", "0.004,0.002,0.001", "--meshes", "1,2,4"];
    let axes = ["--beam-orders", "1,2", "--iteration-tolerances", "1e-8,1e-2"];
    let (text, _) = study(folder.path(), &[&QUICK[..], &common, &axes].concat(), 0);
    let rows = table(&folder.path().join("x.study/study.csv"));
    assert_eq!(rows.len(), 3 * 3 * 2 * 2);
    assert!(text.contains("iteration 1e-8, mesh x 4, order 2"), "{text}");
    let of = |tolerance: f64, mesh: f64, order: f64| -> Vec<_> {
        let is = |row: &&std::collections::HashMap<String, String>| {
            number(row, "iteration_tolerance") == tolerance
                && number(row, "mesh") == mesh
                && number(row, "beam_order") == order
        };
        rows.iter().filter(is).collect()
    };
    let (linear, quadratic) = (of(1e-8, 2.0, 1.0), of(1e-8, 2.0, 2.0));
    assert!(number(linear[0], "unknowns") < number(quadratic[0], "unknowns"));
    // Elements of order 1 fall with h², those of order 2 with h⁴.
    assert!(number(linear[2], "error") > 5.0 * number(quadratic[2], "error"), "{text}");
    // Looser iterations are fewer where steps follow the motion; long ones end with their own error at either tolerance.
    assert!(number(of(1e-2, 2.0, 2.0)[2], "iterations") < number(quadratic[2], "iterations"), "{text}");
    // The reference comes from the finest mesh, the highest order and the least tolerance.
    assert!(text.contains("reference: the finest runs of iteration 1e-8, mesh x 4, order 2"), "{text}");
    let said = study(self::folder(OSCILLATOR).path(), &["--beam-orders", "2"], 3).1;
    assert!(said.contains("the deck has no beams that deform"), "{said}");
}

#[test]
fn what_automatic_steps_cost_and_reach_is_shown() {
    let folder = folder(&format!("{OSCILLATOR}{KEYS}"));
    exact(folder.path());
    let arguments = ["--error-tolerances", "1e-1..1e-4", "--schemes", "newmark", "--axis", "iterations"];
    let (text, _) = study(folder.path(), &[&QUICK[..], &arguments].concat(), 0);
    let out = folder.path().join("x.study");
    let rows = table(&out.join("study.csv"));
    assert_eq!(rows.len(), 4 + 13);
    for row in &rows {
        let result: serde_json::Value =
            serde_json::from_slice(&fs::read(out.join(&row["folder"]).join("result.json")).unwrap()).unwrap();
        assert_eq!(number(row, "iterations"), result["counts"]["iterations"].as_f64().unwrap());
        if row["error_tolerance"].is_empty() {
            assert!(row["other_iterations"].is_empty());
            continue;
        }
        let other = |key: &str| result["step_error"][key].as_f64().unwrap();
        for key in ["other_runs", "other_steps", "other_iterations", "other_factorizations"] {
            assert_eq!(number(row, key), other(key), "{key}");
        }
        assert!(number(row, "other_iterations") > 0.0);
    }
    // The slope and the largest ratio, from the table by itself: it errs against an exact answer.
    let automatic = &rows[4..];
    let ratios: Vec<f64> = automatic.iter().map(|row| number(row, "error") / number(row, "error_tolerance")).collect();
    let largest = ratios.iter().fold(0.0f64, |most, ratio| most.max(*ratio));
    assert!(text.contains(&format!("reached/asked at most {largest:.2}")), "{largest}: {text}");
    assert!(
        text.contains("newmark, automatic: reached ~ asked^") && text.contains("(13 of 13 runs resolved)"),
        "{text}"
    );
    let picture = fs::read_to_string(out.join("asked.svg")).unwrap();
    well_formed(&picture);
    assert_eq!(picture.matches("<path").count(), 13 + 1);
    assert!(fs::read_to_string(out.join("study.svg")).unwrap().contains("Error against iterations"));
    let page = fs::read_to_string(out.join("study.html")).unwrap();
    assert_eq!(page.matches("type=\"radio\"").count(), 3);
    assert!(page.contains("id=\"axis1\" checked") && page.contains("Asked and reached"));
    // The picture of each cost, and of what was asked for and reached.
    assert_eq!(page.matches("<svg").count(), 4);
}

/// Lines of another family come to the same answer. Where they do not, the difference is the error of the reference: two runs of one
/// scheme, stopped by a loose iteration at another answer, tell nothing of it.
#[test]
fn a_reference_is_confirmed_by_another_family() {
    let folder = folder(&format!("{OSCILLATOR}{KEYS}"));
    exact(folder.path());
    let of = |schemes: &str| {
        let steps = ["--finest", "--time-steps", "0.02,0.01,0.005,0.0025", "--schemes", schemes];
        study(folder.path(), &[&QUICK[..], &steps].concat(), 0).0
    };
    let alone = of("newmark,hht-alpha");
    assert!(alone.contains("not confirmed: all schemes are of one family"), "{alone}");
    for (schemes, names) in [("newmark,bathe", ["newmark", "bathe"]), ("newmark,esdirk3", ["newmark", "esdirk3"])] {
        let text = of(schemes);
        let says = |name: &str| text.contains(&format!("confirmed by {name}, which tends to the same within"));
        assert!(names.into_iter().any(says) && !text.contains("not confirmed"), "{text}");
        assert_eq!(table(&folder.path().join("x.study/study.csv")).len(), 8);
    }
}

#[test]
fn a_recommendation_is_a_deck_that_reaches_the_error() {
    let folder = folder(&format!("{OSCILLATOR}{KEYS}"));
    exact(folder.path());
    let out = folder.path().join("x.study");
    let (text, said) = study(folder.path(), &["--recommend", "1e-3", "--repeats", "1", "--overwrite"], 0);
    assert!(said.contains("results in x.study"), "{said}");
    let lines: toml::Table = text.parse().unwrap_or_else(|error| panic!("{error}: {text}"));
    // The cheapest row that reaches it, from the table; times scatter, so the row is told by its setting.
    let (analysis, integrator) = (&lines["analysis"], &lines["integrator"]);
    let rows = table(&out.join("study.csv"));
    let is = |row: &&std::collections::HashMap<String, String>| {
        row["scheme"] == integrator["scheme"].as_str().unwrap()
            && number(row, "time_step") == analysis["time_step"].as_float().unwrap()
    };
    let row = rows.iter().find(is).unwrap();
    let reaching: Vec<_> = rows.iter().filter(|row| number(row, "error") <= 1e-3).collect();
    assert!(reaching.iter().all(|other| number(row, "loop_s") <= number(other, "loop_s")), "{text}");
    let margin = 1e-3 / number(row, "error");
    assert!(text.contains(&format!("{margin:.2} times below the 1e-3 asked for")), "{margin}: {text}");
    assert!(text.contains(&format!("{} iterations", row["iterations"])), "{text}");
    // Automatic steps alone: the command in the last line does what was measured.
    let automatic =
        ["--recommend", "1e-3", "--repeats", "1", "--overwrite", "--quiet", "--error-tolerances", "1e-2..1e-4"];
    fs::write(folder.path().join("x.toml"), format!("{OSCILLATOR}{}", KEYS.replace("time_steps", "# time_steps")))
        .unwrap();
    let (text, _) = study(folder.path(), &[&automatic[..], &["--schemes", "newmark"]].concat(), 0);
    let lines: toml::Table = text.parse().unwrap();
    assert_eq!(lines["analysis"]["time_step"].as_str(), Some("auto"), "{text}");
    let command = text.lines().last().unwrap().strip_prefix("# rdsolve ").unwrap();
    let arguments = command.split('\'').enumerate().flat_map(|(i, piece)| match i % 2 {
        0 => piece.split_whitespace().map(String::from).collect(),
        _ => vec![piece.to_owned()],
    });
    let mut run = assert_cmd::Command::cargo_bin("rdsolve").unwrap();
    run.current_dir(folder.path()).args(arguments).args(["--quiet", "-o", "again"]).assert().code(0);
    let counts = |path: &str| -> serde_json::Value {
        let text = fs::read(folder.path().join(path).join("result.json")).unwrap();
        serde_json::from_slice::<serde_json::Value>(&text).unwrap()["counts"].clone()
    };
    let tolerance = lines["analysis"]["error_tolerance"].as_float().unwrap();
    let rows = table(&out.join("study.csv"));
    let row = rows.iter().find(|row| number(row, "error_tolerance") == tolerance).unwrap();
    assert_eq!(counts("again"), counts(&format!("x.study/{}", row["folder"])));
    // Steps that do not end at output times need none in the deck.
    let (text, _) = study(folder.path(), &[&automatic[..], &["--schemes", "runge-kutta"]].concat(), 0);
    assert!(text.contains("\"auto\"") && !text.contains("interval"), "{text}");
}

#[test]
fn where_nothing_reaches_the_error_that_is_said() {
    let folder = folder(&format!("{OSCILLATOR}{KEYS}"));
    exact(folder.path());
    let (text, said) = study(folder.path(), &["--recommend", "1e-9", "--repeats", "1", "--quiet"], 5);
    assert!(text.is_empty(), "{text}");
    assert!(said.contains("no setting reaches an error of 1e-9: the nearest is bathe, time step 0.0025"), "{said}");
    // Against its own reference nothing is known that closely.
    let own = ["--recommend", "1e-9", "--finest", "--schemes", "newmark", "--repeats", "1", "--quiet", "--overwrite"];
    let said = study(folder.path(), &own, 5).1;
    assert!(said.contains("no setting reaches an error of 1e-9"), "{said}");
    // With nothing but the error, it goes over default steps and automatic ones.
    fs::write(folder.path().join("x.toml"), OSCILLATOR).unwrap();
    let (text, _) = study(folder.path(), &["--recommend", "1e-3", "--repeats", "1", "--quiet", "--overwrite"], 0);
    assert!(text.parse::<toml::Table>().is_ok() && text.contains("the reference is known to"), "{text}");
    let rows = table(&folder.path().join("x.study/study.csv"));
    let schemes: std::collections::BTreeSet<&str> = rows.iter().map(|row| row["scheme"].as_str()).collect();
    // Fixed steps have the default scheme; automatic ones take theirs.
    assert!(schemes.contains("wilson-theta") && schemes.contains("runge-kutta"), "{schemes:?}");
    assert_eq!(rows.iter().filter(|row| !row["error_tolerance"].is_empty()).count(), 4);
}
