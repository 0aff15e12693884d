//! Whether `rdsolve compare` sees what differs, and nothing else.

use assert_cmd::Command;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A tip that moves, and a foot that does not but for rounding.
fn nodes(step: f64, count: usize) -> String {
    let mut text = String::from("step,time,node,ux,uy\n");
    for i in 0..=count {
        let t = i as f64 * step;
        text += &format!("{i},{t:?},tip,{:?},{:?}\n", (3.0 * t).sin(), 0.5);
        text += &format!("{i},{t:?},foot,0.0,{:?}\n", 0.5);
    }
    text
}

const STEPS: &str = "step,time,dt,iterations,refactorizations,residual,cuts\n1,0.1,0.1,3,1,1e-9,0\n";
const RESULT: &str = r#"{ "status": "done", "timings": { "loop_s": 1.0 } }"#;

/// Two folders, `a` and `b`, the same.
fn folders() -> TempDir {
    let root = tempfile::tempdir().unwrap();
    for name in ["a", "b"] {
        let dir = root.path().join(name);
        fs::create_dir(&dir).unwrap();
        for (file, text) in [("nodes.csv", nodes(0.1, 20)), ("steps.csv", STEPS.into()), ("result.json", RESULT.into())]
        {
            fs::write(dir.join(file), text).unwrap();
        }
    }
    root
}

/// Rewrites a file of `b`.
fn change(root: &TempDir, file: &str, to: impl FnOnce(String) -> String) {
    let path = root.path().join("b").join(file);
    let text = fs::read_to_string(&path).unwrap();
    fs::write(path, to(text)).unwrap();
}

/// Exit code, standard output and standard error of `rdsolve compare`.
fn compare(root: &Path, arguments: &[&str]) -> (i32, String, String) {
    let done =
        Command::cargo_bin("rdsolve").unwrap().current_dir(root).arg("compare").args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (done.status.code().unwrap(), text(done.stdout), text(done.stderr))
}

/// Both orders end alike and say the same numbers; what is said of `a` then `b`.
fn both_ways(root: &TempDir, code: i32, more: &[&str]) -> String {
    let said = [["a", "b"], ["b", "a"]].map(|order| compare(root.path(), &[&order[..], more].concat()));
    assert_eq!([said[0].0, said[1].0], [code; 2], "{said:?}");
    let lines = |(_, out, _): &(i32, String, String)| -> Vec<String> {
        out.lines().filter(|line| line.contains("DIFFERS") && line.contains(" t = ")).map(String::from).collect()
    };
    if !said[0].1.contains("ends at") {
        assert_eq!(lines(&said[0]), lines(&said[1]), "swapped");
    }
    said[0].1.clone()
}

#[test]
fn the_same_agree_whatever_the_timings() {
    let root = folders();
    change(&root, "result.json", |text| text.replace("1.0", "2.0"));
    fs::write(root.path().join("b/run.log"), "another day").unwrap();
    let said = both_ways(&root, 0, &[]);
    assert!(said.contains("nodes.csv: 42 rows matched at 21 times") && said.ends_with("the folders agree\n"), "{said}");
    assert_eq!(both_ways(&root, 0, &["--quiet"]), "");
}

#[test]
fn a_difference_is_measured_against_the_range() {
    let root = folders();
    // sin(0.3) of the tip at t = 0.1; its range over two seconds is sin(1.5) - sin(4.8), both among the times.
    change(&root, "nodes.csv", |text| {
        text.replace(&format!("tip,{:?}", (3.0 * 0.1_f64).sin()), &format!("tip,{:?}", (3.0 * 0.1_f64).sin() + 1e-5))
    });
    let said = both_ways(&root, 5, &[]);
    let row: Vec<&str> = said.lines().find(|line| line.contains("DIFFERS")).unwrap().split_whitespace().collect();
    assert_eq!(row[..2], ["nodes.csv", "ux"]);
    let (relative, absolute): (f64, f64) = (row[2].parse().unwrap(), row[3].parse().unwrap());
    let range = 1.5_f64.sin() - 4.8_f64.sin();
    // Printed with three digits.
    assert!((relative / (1e-5 / range) - 1.0).abs() < 5e-3 && (absolute / 1e-5 - 1.0).abs() < 5e-3, "{said}");
    assert!(said.contains("t = 0.1, tip"), "{said}");
    // The largest of the limits that apply.
    for (more, code) in [
        (&["--tolerance", "1e-5"][..], 0),
        (&["--tolerance", "nodes.csv:ux=1e-5"], 0),
        (&["--tolerance", "nodes.csv:uy=1e-5"], 5),
        (&["--tolerance", "ux=1e-5", "--tolerance", "nodes.csv:ux=1e-7"], 5),
        (&["--absolute", "1.1e-5"], 0),
        (&["--absolute", "0.9e-5"], 5),
        (&["--columns", "uy"], 0),
        (&["--columns", "uy,nodes.csv:ux"], 5),
    ] {
        both_ways(&root, code, more);
    }
}

#[test]
fn rounding_in_a_constant_column_is_no_difference() {
    let root = folders();
    // uy varies by less than a billionth of ux: it is measured against ux.
    change(&root, "nodes.csv", |text| text.replace("foot,0.0,0.5", "foot,1e-17,0.5000000005"));
    both_ways(&root, 0, &[]);
    change(&root, "nodes.csv", |text| text.replace("0.5000000005", "0.5001"));
    both_ways(&root, 5, &[]);
}

#[test]
fn what_only_one_side_has_is_named() {
    let root = folders();
    change(&root, "nodes.csv", |text| {
        text.lines()
            .filter(|line| !line.starts_with("3,") || !line.contains("foot"))
            .flat_map(|line| [line, "\n"])
            .collect()
    });
    let said = both_ways(&root, 5, &[]);
    assert!(said.contains("MISSING nodes.csv: 1 row only in a, the first at t = 0.3, foot"), "{said}");
    assert!(said.contains("nodes.csv: 41 rows matched"), "{said}");

    let root = folders();
    change(&root, "nodes.csv", |text| text.replace("ux,uy", "ux,rz"));
    let said = both_ways(&root, 5, &[]);
    assert!(said.contains("column `uy` is only in a") && said.contains("column `rz` is only in b"), "{said}");
    both_ways(&root, 0, &["--columns", "ux"]);

    let root = folders();
    fs::remove_file(root.path().join("b/steps.csv")).unwrap();
    assert!(both_ways(&root, 5, &[]).contains("MISSING steps.csv: only in a"));
    let root = folders();
    fs::remove_file(root.path().join("b/result.json")).unwrap();
    assert!(both_ways(&root, 5, &[]).contains("MISSING result.json: only in a"));
    let root = folders();
    change(&root, "result.json", |text| text.replace("done", "not-converged"));
    assert!(both_ways(&root, 5, &[]).contains("status `done` in a and `not-converged` in b"));
}

#[test]
fn rows_may_stand_in_another_order() {
    let root = folders();
    change(&root, "nodes.csv", |text| {
        let (head, rows) = text.split_once('\n').unwrap();
        let rows: Vec<&str> = rows.lines().collect();
        let swapped = rows.chunks(2).flat_map(|pair| [pair[1], "\n", pair[0], "\n"]);
        format!("{head}\n{}", swapped.collect::<String>())
    });
    assert!(both_ways(&root, 0, &[]).contains("42 rows matched"));
}

#[test]
fn no_number_is_a_difference_unless_both_have_none() {
    let root = folders();
    let without = |text: String| text.replace("1,0.1,foot,0.0,", "1,0.1,foot,,");
    change(&root, "nodes.csv", without);
    assert!(both_ways(&root, 5, &["--tolerance", "1e9", "--absolute", "1e9"]).contains("no number"));
    let path = root.path().join("a/nodes.csv");
    fs::write(&path, without(fs::read_to_string(&path).unwrap())).unwrap();
    both_ways(&root, 0, &[]);
    // What says NaN agrees with nothing, not with another NaN either: a computation has failed there.
    for says in ["NaN", "nan"] {
        change(&root, "nodes.csv", |text| text.replace("1,0.1,foot,,", &format!("1,0.1,foot,{says},")));
        both_ways(&root, 5, &["--tolerance", "1e9", "--absolute", "1e9"]);
        let both = fs::read_to_string(root.path().join("b/nodes.csv")).unwrap();
        let (alone, blank) = (fs::read_to_string(&path).unwrap(), both.replace(&format!("foot,{says},"), "foot,,"));
        fs::write(&path, &both).unwrap();
        assert!(both_ways(&root, 5, &["--tolerance", "1e9"]).contains("NaN"));
        fs::write(&path, alone).unwrap();
        fs::write(root.path().join("b/nodes.csv"), blank).unwrap();
    }
    change(&root, "nodes.csv", |text| text.replace("1,0.1,foot,,", "1,0.1,foot,NaN,"));
    change(&root, "nodes.csv", |text| text.replace("foot,NaN,", "foot,inf,"));
    both_ways(&root, 5, &[]);
}

#[test]
fn another_cadence_is_compared_at_common_times() {
    let root = folders();
    change(&root, "nodes.csv", |_| nodes(0.05, 40));
    // 0.05 i and 0.1 i differ in their last digits, and the sine by as much.
    let said = both_ways(&root, 0, &[]);
    assert!(said.contains("nodes.csv: 42 rows matched at 21 times"), "{said}");
    assert!(said.contains("nodes.csv: b has 20 more times, 40 rows"), "{said}");
    // Of 0.01, 0.3, .. 2.1 and 0, 0.1, .. 2.0.
    change(&root, "nodes.csv", |_| nodes(0.3, 7).replace("0,0.0,", "0,0.01,"));
    assert!(both_ways(&root, 0, &["--columns", "nodes.csv"]).contains("12 rows matched at 6 times"));
    // None.
    change(&root, "nodes.csv", |_| nodes(0.1, 20).replace(",0.", ",100."));
    assert!(both_ways(&root, 5, &["--columns", "nodes.csv"]).contains("DIFFERS nodes.csv"));
    change(&root, "nodes.csv", |_| "step,time,node,ux,uy\n".into());
    assert!(both_ways(&root, 5, &[]).contains("no row of one matches"));
    // One that ends early is no other cadence.
    change(&root, "nodes.csv", |_| nodes(0.1, 15));
    assert!(both_ways(&root, 5, &[]).contains("ends at t = 2 in a and t = 1.5 in b"));
}

/// A load that falls and rises again is at one time more than once: steps count.
#[test]
fn a_path_that_turns_is_matched_by_step() {
    let root = folders();
    let path = |shift: f64| {
        let mut text = String::from("step,time,node,ux\n");
        (0..=20).for_each(|i| {
            text += &format!("{i},{:?},tip,{:?}\n", 0.1 * (7 - (i - 7_i32).abs()) as f64 + shift, i as f64)
        });
        text
    };
    for (side, shift) in [("a", 0.0), ("b", 1e-9)] {
        fs::write(root.path().join(side).join("nodes.csv"), path(shift)).unwrap();
        fs::write(root.path().join(side).join("steps.csv"), format!("{STEPS}2,0.05,-0.05,3,1,1e-9,0\n")).unwrap();
    }
    assert!(both_ways(&root, 0, &[]).contains("nodes.csv: 21 rows matched at 21 steps"));
    change(&root, "nodes.csv", |_| path(1e-3));
    let said = both_ways(&root, 5, &[]);
    assert!(said.contains("time") && said.contains("DIFFERS"), "{said}");
}

/// Rows of a response belong together by their frequency, response by response, wherever they stand in the file.
/// Under displacement control times are results: each row has its partner at its step, and a wrong one is seen.
#[test]
fn a_displacement_that_is_led_is_matched_by_step() {
    let root = folders();
    let path = |factor: f64, fifth: f64| {
        let mut text = String::from("step,time,node,ux\n");
        (0..=20).for_each(|i| {
            let u = if i == 5 { fifth } else { f64::from(i) };
            text += &format!("{i},{:?},tip,{u:?}\n", 0.1 * factor * f64::from(i))
        });
        text
    };
    for (side, factor) in [("a", 1.0), ("b", 1.0005)] {
        fs::write(root.path().join(side).join("nodes.csv"), path(factor, 5.0)).unwrap();
        let result = RESULT.replace("\"done\"", "\"done\", \"by_displacement\": true, \"counts\": { \"steps\": 20 }");
        fs::write(root.path().join(side).join("result.json"), result).unwrap();
    }
    let tolerance = ["--tolerance", "1e-3"];
    assert!(both_ways(&root, 0, &tolerance).contains("nodes.csv: 21 rows matched at 21 steps"));
    change(&root, "nodes.csv", |_| path(1.0005, 50.0));
    assert!(both_ways(&root, 5, &tolerance).contains("ux"));
    // A run that was led by time has its times in common with the other.
    change(&root, "result.json", |_| RESULT.to_owned());
    assert!(both_ways(&root, 0, &tolerance).contains("matched at 1 time"));
}

/// Rows of a response belong together by their frequency, response by response, wherever they stand in the file.
#[test]
fn a_response_is_matched_by_frequency_and_point() {
    let root = folders();
    let response = |frequencies: [&[f64]; 2], shift: f64| {
        let mut text = String::from("step,time,stage,frequency,node,ux\n");
        for (stage, frequencies) in ["first", "second"].iter().zip(frequencies) {
            for f in frequencies {
                let of = |scale: f64| scale / (4.1 - f * f).abs() + shift;
                text += &format!("2,1.0,{stage},{f:?},tip,{:?}\n2,1.0,{stage},{f:?},foot,{:?}\n", of(1.0), of(2.0));
            }
        }
        text
    };
    let write = |side: &str, text: String| fs::write(root.path().join(side).join("response.csv"), text).unwrap();
    let coarse: &[f64] = &[1.0, 2.0, 3.0, 4.0];
    let fine: &[f64] = &[1.0, 1.5, 2.0, 2.0 + 1e-12, 3.0, 3.5, 4.0];
    write("a", response([coarse, fine], 0.0));
    write("b", response([fine, coarse], 0.0));
    let said = both_ways(&root, 0, &["--columns", "response.csv"]);
    assert!(said.contains("response.csv: 16 rows matched at 8 frequencies"), "{said}");
    assert!(said.contains("response.csv: b has 3 more frequencies, 6 rows"), "{said}");
    // Another order of the points of a frequency.
    let swap = |text: String| {
        let mut lines: Vec<&str> = text.lines().collect();
        lines[1..].chunks_mut(2).for_each(|pair| pair.reverse());
        lines.join("\n") + "\n"
    };
    write("b", swap(response([coarse, fine], 0.0)));
    assert!(both_ways(&root, 0, &["--columns", "response.csv"]).contains("22 rows matched at 11 frequencies"));
    write("b", response([coarse, fine], 0.1));
    let said = both_ways(&root, 5, &["--columns", "response.csv:ux"]);
    assert!(said.contains("DIFFERS") && said.contains("frequency 2, first foot"), "{said}");
    write("b", response([coarse, &fine[..3]], 0.0));
    let said = both_ways(&root, 5, &["--columns", "response.csv"]);
    assert!(said.contains("ends at frequency 4 in a and frequency 2 in b"), "{said}");
}

#[test]
fn a_line_torn_off_is_no_agreement() {
    let root = folders();
    change(&root, "nodes.csv", |text| text[..text.len() - 6].into());
    let said = both_ways(&root, 5, &[]);
    assert!(
        said.contains("TORN nodes.csv: the last line in b is incomplete") && said.contains("41 rows matched"),
        "{said}"
    );
    assert!(!said.contains("DIFFERS") && !said.contains("MISSING"), "{said}");
    assert!(both_ways(&root, 5, &["--quiet"]).contains("TORN"));
    both_ways(&root, 0, &["--ignore", "nodes.csv"]);
    // Both torn at the same byte; one that is not judged; one torn within its header.
    let torn = fs::read(root.path().join("b/nodes.csv")).unwrap();
    fs::write(root.path().join("a/nodes.csv"), torn).unwrap();
    both_ways(&root, 5, &[]);
    let root = folders();
    change(&root, "steps.csv", |text| text[..text.len() - 1].into());
    assert!(both_ways(&root, 5, &[]).contains("TORN steps.csv"));
    change(&root, "steps.csv", |_| "step,ti".into());
    let (code, _, error) = compare(root.path(), &["a", "b"]);
    assert!(code == 6 && error.contains("steps.csv: no whole header row"), "{error}");
}

/// `contact` is an energy in energy.csv and a name in contacts.csv.
#[test]
fn a_column_is_a_name_where_its_table_says_so() {
    let root = folders();
    let energy = |kinetic: f64, contact: f64| {
        let mut text = String::from("step,time,kinetic,contact,external\n");
        (0..=20).for_each(|i| {
            let t = 0.1 * i as f64;
            text += &format!("{i},{t:?},{:?},{:?},1.0\n", kinetic + t.sin(), contact * t)
        });
        text
    };
    fs::write(root.path().join("a/energy.csv"), energy(1.0, 1.0)).unwrap();
    fs::write(root.path().join("b/energy.csv"), energy(1.0, 1.0 + 1e-9)).unwrap();
    let said = both_ways(&root, 0, &[]);
    assert!(said.contains("energy.csv: 21 rows matched") && said.contains("contact"), "{said}");
    both_ways(&root, 0, &["--columns", "kinetic"]);
    fs::write(root.path().join("b/energy.csv"), energy(1.0, 1.1)).unwrap();
    both_ways(&root, 5, &[]);
    both_ways(&root, 0, &["--columns", "kinetic"]);
    // Tables that are not ours: leading texts are names, and a number is none whatever its column is called.
    let probe = |shift: f64| format!("time,who,contact,node\n0.0,a,{:?},1.0\n0.0,b,2.0,1.0\n", 1.0 + shift);
    let root = folders();
    fs::write(root.path().join("a/probe.csv"), probe(0.0)).unwrap();
    fs::write(root.path().join("b/probe.csv"), probe(1e-9)).unwrap();
    assert!(both_ways(&root, 0, &[]).contains("probe.csv: 2 rows matched at 1 time"));
    fs::write(root.path().join("b/probe.csv"), probe(0.5)).unwrap();
    assert!(both_ways(&root, 5, &[]).contains("t = 0, a"));
}

#[test]
fn columns_and_tables_may_be_ignored() {
    let root = folders();
    change(&root, "nodes.csv", |text| text.replace("foot,0.0,0.5", "foot,0.1,0.5"));
    both_ways(&root, 5, &[]);
    for ignored in ["ux", "nodes.csv:ux", "nodes.csv", "uy,ux"] {
        both_ways(&root, 0, &["--ignore", ignored]);
    }
    both_ways(&root, 5, &["--ignore", "uy"]);
    both_ways(&root, 0, &["--columns", "nodes.csv", "--ignore", "ux"]);
    // A column or table of one side alone.
    change(&root, "nodes.csv", |text| text.replace("ux,uy", "ux,rz"));
    both_ways(&root, 0, &["--ignore", "ux,uy,rz"]);
    fs::remove_file(root.path().join("b/steps.csv")).unwrap();
    both_ways(&root, 0, &["--ignore", "ux,uy,rz", "--ignore", "steps.csv"]);
    let (code, _, error) = compare(root.path(), &["a", "b", "--ignore", "uz"]);
    assert!(code == 2 && error.contains("no column is named `uz`"), "{error}");
}

#[test]
fn what_a_run_cost_is_shown_and_judged_only_when_named() {
    let root = folders();
    change(&root, "steps.csv", |text| text.replace(",3,1,1e-9", ",4,1,2e-9"));
    assert!(both_ways(&root, 0, &[]).contains("not judged"));
    both_ways(&root, 5, &["--columns", "steps.csv"]);
    both_ways(&root, 5, &["--tolerance", "iterations=1e-3"]);
}

#[test]
fn what_cannot_be_read_or_is_not_there_is_said() {
    let root = folders();
    let code = |arguments: &[&str], words: &str| {
        let (code, _, error) = compare(root.path(), arguments);
        assert!(error.contains(words), "{error}");
        code
    };
    assert_eq!(code(&["a", "none"], "none"), 6);
    fs::create_dir(root.path().join("empty")).unwrap();
    assert_eq!(code(&["empty", "a"], "no results"), 6);
    assert_eq!(code(&["a"], "DIR_B"), 2);
    assert_eq!(code(&["a", "b", "--tolerance=-1"], "not negative"), 2);
    assert_eq!(code(&["a", "b", "--tolerance", "nodes.csv:uz=1"], "did you mean `ux`?"), 2);
    assert_eq!(code(&["a", "b", "--columns", "node.csv"], "did you mean `nodes.csv`?"), 2);
    change(&root, "nodes.csv", |text| text.replacen("tip,", "tip,7,", 2));
    assert_eq!(code(&["a", "b"], "nodes.csv: row 1 has 6 fields, the header 5"), 6);
    change(&root, "result.json", |_| "{".into());
    assert_eq!(code(&["a", "b"], "result.json"), 6);
}
