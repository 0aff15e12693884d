//! The page of `rdsolve report`: whole, of one piece, and nothing in it is taken for markup.

use assert_cmd::Command;
use base64::prelude::{BASE64_STANDARD, Engine};
use serde_json::Value;
use std::fs;
use std::path::Path;

const PLATE: &str = r#"
title = "A plate <script>alert('x')</script> & co"
[analysis]
kind = "static"
end_time = 1.0
time_step = 0.25
[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0
[points]
a = [0.0, 0.0, 0.0]
b = [1.0, 0.0, 0.0]
c = [1.0, 1.0, 0.0]
d = [0.0, 1.0, 0.0]
[[shells]]
name = "plate"
corners = ["a", "b", "c", "d"]
elements = [2, 3]
material = "steel"
thickness = 0.01
[[supports]]
at = ["a", "d"]
fix = "all"
[[loads]]
at = "b"
force = [0.0, 0.0, -10.0]
[[expect]]
at = "b"
quantity = "uz"
time = 1.0
value = -1.0
tolerance = 1e-3
source = "<b>made up</b>"
"#;
const FIELDS: &str = "[output]\nfields = { format = \"vtu\", every = 1 }\nsections = true\n";
const BALL: &str = r#"
[analysis]
kind = "dynamic"
end_time = 1.0
time_step = 0.01
[[bodies]]
name = "ball"
center = [0.0, 0.0, 0.0]
mass = 1.0
velocity = [1.0, 0.0, 0.0]
shape = { kind = "sphere", radius = 0.1 }
"#;

fn rdsolve(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("rdsolve").unwrap().current_dir(folder).args(arguments).assert()
}

/// Runs a deck into `x.out` with this exit code and makes its page.
fn page(deck: &str, code: i32) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("x.toml"), deck).unwrap();
    rdsolve(folder.path(), &["x.toml", "--quiet"]).code(code);
    rdsolve(folder.path(), &["report", "x.out"]).code(0);
    let text = fs::read_to_string(folder.path().join("x.html")).unwrap();
    sound(&text);
    (folder, text)
}

/// Of one piece: nothing from elsewhere, nothing left to fill in, as many scripts as we wrote.
fn sound(page: &str) {
    for word in ["http:", "https:", "src=", "@import", "url(", "{{"] {
        assert!(!page.contains(word), "{word}");
    }
    assert_eq!((page.matches("<script").count(), page.matches("</script>").count()), (2, 2));
    assert!(page.starts_with("<!DOCTYPE html>") && page.trim_end().ends_with("</html>"));
}

/// What the page's script reads.
fn data(page: &str) -> Value {
    let begin = page.split_once("id=\"data\">").unwrap().1;
    serde_json::from_str(begin.split_once("</script>").unwrap().0).unwrap()
}

fn floats(base64: &Value) -> Vec<f32> {
    let bytes = BASE64_STANDARD.decode(base64.as_str().unwrap()).unwrap();
    bytes.as_chunks().0.iter().map(|&four| f32::from_le_bytes(four)).collect()
}

#[test]
fn shells_with_fields_move_and_names_are_only_names() {
    let (folder, page) = page(&format!("{PLATE}{FIELDS}"), 5);
    assert!(page.contains("A plate &lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt; &amp; co"));
    assert!(page.contains("&lt;b&gt;made up&lt;/b&gt;") && page.contains("MISSED"));
    assert!(page.contains("expectation-missed") && page.contains("1 of 1 expected values missed"));
    // The deck is that of the run to the last byte, so its text is there; plan and counts too.
    assert!(page.contains("[materials.steel]") && page.contains("<h2>Plan</h2>") && page.contains("factorizations"));

    let data = data(&page);
    let scene = &data["scene"];
    let (x0, u, times) = (floats(&scene["x0"]), floats(&scene["u"]), floats(&scene["times"]));
    assert_eq!((x0.len(), u.len()), (3 * 12, 5 * 3 * 12));
    assert_eq!(times, [0.0, 0.25, 0.5, 0.75, 1.0]);
    let names: Vec<&str> = scene["fields"].as_array().unwrap().iter().map(|f| f["name"].as_str().unwrap()).collect();
    assert!(names.contains(&"von_mises_top") && names.contains(&"von_mises_bottom"), "{names:?}");
    assert!(scene["fields"].as_array().unwrap().iter().all(|field| floats(&field["values"]).len() == 5 * 6));

    // Numbers of the tables, as they are there.
    let table = |name: &str| data["histories"].as_array().unwrap().iter().find(|t| t["file"] == name).unwrap().clone();
    let nodes = table("nodes.csv");
    assert_eq!(nodes["names"], serde_json::json!(["a", "b", "c", "d"]));
    let (columns, values) = (nodes["columns"].as_array().unwrap(), floats(&nodes["values"]));
    let uz = columns.iter().position(|column| column == "uz").unwrap();
    // At the fifth time, of the second of four nodes.
    let last = values[(4 * 4 + 1) * columns.len() + uz];
    let csv = fs::read_to_string(folder.path().join("x.out/nodes.csv")).unwrap();
    let row = csv.lines().rfind(|line| line.contains(",b,")).unwrap();
    let place = csv.lines().next().unwrap().split(',').position(|column| column == "uz").unwrap();
    assert_eq!(last, row.split(',').nth(place).unwrap().parse::<f64>().unwrap() as f32);
    // The corner that is loaded moves as far in the scene: of the points at (1, 0, 0), the one.
    let corner = (0..12).find(|p| x0[3 * p..3 * p + 3] == [1.0, 0.0, 0.0]).unwrap();
    assert_eq!(u[4 * 36 + 3 * corner + 2], last);
    assert_eq!(table("shells.csv")["names"].as_array().unwrap().len(), 6);
}

#[test]
fn without_fields_bodies_and_nodes_are_points() {
    let (_, page) = page(BALL, 0);
    let data = data(&page);
    let scene = &data["scene"];
    assert_eq!(scene["labels"], serde_json::json!(["ball"]));
    let u = floats(&scene["u"]);
    // A free body moves at its speed; Float32 keeps seven digits.
    assert!((u[u.len() - 3] - 1.0).abs() < 1e-6, "{u:?}");
    // 101 times are all there.
    assert!(!page.contains("shown are"));
}

#[test]
fn a_table_alone_is_enough_and_an_unfinished_run_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let results = folder.path().join("killed");
    fs::create_dir(&results).unwrap();
    fs::write(results.join("energy.csv"), "step,time,kinetic,total\n0,0.0,1.0,1.0\n1,0.1,2.0,2.0\n2,0.").unwrap();
    let done = rdsolve(folder.path(), &["report", "killed", "-o", "page.html"]).code(0);
    assert!(String::from_utf8(done.get_output().stdout.clone()).unwrap().starts_with("page.html, "));
    let page = fs::read_to_string(folder.path().join("page.html")).unwrap();
    sound(&page);
    assert!(page.contains("unfinished"));
    let data = data(&page);
    assert!(data["scene"].is_null());
    assert_eq!(floats(&data["histories"][0]["times"]), [0.0, 0.1]);
}

#[test]
fn a_failed_run_has_its_reason() {
    let root = tempfile::tempdir().unwrap();
    let results = root.path().join("r");
    fs::create_dir(&results).unwrap();
    fs::write(
        results.join("result.json"),
        r#"{ "status": "not-converged", "reason": "at t = 0.5: <no> equilibrium" }"#,
    )
    .unwrap();
    rdsolve(root.path(), &["report", "r", "--quiet"]).code(0);
    let page = fs::read_to_string(root.path().join("r.html")).unwrap();
    sound(&page);
    assert!(page.contains("not-converged") && page.contains("at t = 0.5: &lt;no&gt; equilibrium"));
}

#[test]
fn nothing_is_overwritten_unasked_and_nothing_is_made_of_nothing() {
    let root = tempfile::tempdir().unwrap();
    let said = |arguments: &[&str], code| {
        String::from_utf8(rdsolve(root.path(), arguments).code(code).get_output().stderr.clone()).unwrap()
    };
    assert!(said(&["report", "none"], 6).contains("none"));
    fs::create_dir(root.path().join("empty")).unwrap();
    assert!(said(&["report", "empty"], 6).contains("no results"));
    assert!(!root.path().join("empty.html").exists());
    fs::create_dir(root.path().join("r")).unwrap();
    fs::write(root.path().join("r/result.json"), "{}").unwrap();
    fs::write(root.path().join("r.html"), "kept").unwrap();
    assert!(said(&["report", "r"], 2).contains("--overwrite"));
    assert_eq!(fs::read_to_string(root.path().join("r.html")).unwrap(), "kept");
    said(&["report", "r", "--overwrite"], 0);
    assert!(fs::read_to_string(root.path().join("r.html")).unwrap().starts_with("<!DOCTYPE"));
    // A folder is no file, and a grid that is none of ours is named.
    said(&["report", "r", "-o", "empty", "--overwrite"], 6);
    fs::write(root.path().join("r/fields.pvd"), "<DataSet timestep=\"0\" part=\"0\" file=\"f.vtu\"/>\n").unwrap();
    fs::write(root.path().join("r/f.vtu"), "<VTKFile/>").unwrap();
    assert!(said(&["report", "r", "--overwrite"], 6).contains("f.vtu: this grid has not"));
    // Names of grids stay in the folder.
    fs::write(root.path().join("r/fields.pvd"), "<DataSet timestep=\"0\" part=\"0\" file=\"../x\"/>\n").unwrap();
    said(&["report", "r", "--overwrite"], 0);
}
