//! The program with a mesh: from any folder, with overrides, and its hash.

use super::Plate;
use crate::support::grid::Grid;
use assert_cmd::Command;
use std::path::Path;

const DECK: &str = r#"
[analysis]
kind = "static"
end_time = 1.0
time_step = 1.0
[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
[mesh]
file = "meshes/plate.msh"
[[shells]]
group = "plate"
thickness = 0.02
material = "steel"
[[supports]]
at = "root"
fix = "all"
[[loads]]
at = "tip"
force_per_length = [0.0, 0.0, 10.0]
[output]
fields = { format = "vtu" }
"#;

fn run(from: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("rdsolve").unwrap().current_dir(from).args(arguments).assert()
}

fn hash(folder: &Path) -> String {
    let bytes = std::fs::read(folder.join("result.json")).unwrap();
    let result: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
    result["deck_hash"].as_str().unwrap().to_owned()
}

#[test]
fn a_mesh_is_found_from_the_deck() {
    let dir = tempfile::tempdir().unwrap();
    let scene = dir.path().join("scene");
    let elsewhere = dir.path().join("elsewhere");
    std::fs::create_dir_all(scene.join("meshes")).unwrap();
    std::fs::create_dir_all(&elsewhere).unwrap();
    std::fs::write(scene.join("deck.toml"), DECK).unwrap();
    let plate = |m| Plate { n: 4, m, size: [1.0, 0.5] }.msh4();
    std::fs::write(scene.join("meshes/plate.msh"), plate(2)).unwrap();
    std::fs::write(scene.join("meshes/finer.msh"), plate(3)).unwrap();

    run(&scene, &["deck.toml", "-o", "../a", "--quiet"]).code(0);
    run(&elsewhere, &["../scene/deck.toml", "-o", "../b", "--quiet"]).code(0);
    let absolute = scene.join("deck.toml");
    run(&elsewhere, &[absolute.to_str().unwrap(), "-o", "../c", "--quiet"]).code(0);
    let finer = "mesh.file=\"meshes/finer.msh\"";
    run(&elsewhere, &["../scene/deck.toml", "-o", "../d", "--quiet", "--set", finer]).code(0);
    let [a, b, c, d] = ["a", "b", "c", "d"].map(|name| hash(&dir.path().join(name)));
    assert!(a == b && a == c && a != d);
    // The deck is the same, its mesh is not.
    std::fs::write(scene.join("meshes/plate.msh"), plate(3)).unwrap();
    run(&scene, &["deck.toml", "-o", "../e", "--quiet"]).code(0);
    assert_ne!(hash(&dir.path().join("e")), a);

    let checked = run(&elsewhere, &["check", "../scene/deck.toml"]).code(0);
    let said = String::from_utf8(checked.get_output().stdout.clone()).unwrap();
    assert!(said.contains("plate.msh`: 20 nodes, 18 elements, 12 of them in parts"), "{said}");
    run(&elsewhere, &["check", "../scene/deck.toml", "--set", "mesh.file=\"none.msh\""]).code(3);
}

/// A rigid part is drawn with its faces, a grid of which every file holds.
#[test]
fn a_rigid_part_is_drawn() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::create_dir(dir.path().join("meshes")).unwrap();
    std::fs::write(dir.path().join("meshes/plate.msh"), Plate { n: 4, m: 2, size: [1.0, 0.5] }.msh4()).unwrap();
    let deck =
        DECK.replace("group = \"plate\"", "group = \"plate\"\nrigid = true").replace("at = \"root\"", "at = \"plate\"");
    std::fs::write(dir.path().join("deck.toml"), deck).unwrap();
    run(dir.path(), &["deck.toml", "-o", "out", "--quiet"]).code(0);
    let fields = Grid::read(&dir.path().join("out/fields_000000.vtu")).xml;
    assert!(fields.contains("NumberOfPoints=\"15\" NumberOfCells=\"8\""), "{}", &fields[..400]);
    assert!(std::fs::read_to_string(dir.path().join("out/fields.csv")).unwrap().contains("body,plate"));
}

/// A strip of a quadrilateral, two triangles and a quadrilateral, in this order in the file, bent at its end: one part with
/// elements 0 to 3, in one order in every file.
#[test]
fn a_group_of_both_kinds_is_numbered_once() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::create_dir(dir.path().join("meshes")).unwrap();
    let mesh = "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 2., 0.\n4, 3., 0.\n5, 0., 1.\n6, 1., 1.\n7, 2., 1.\n8, 3., 1.\n\
                *ELEMENT, TYPE=S4, ELSET=plate\n1, 1, 2, 6, 5\n*ELEMENT, TYPE=S3, ELSET=plate\n2, 2, 3, 7\n3, 2, 7, 6\n\
                *ELEMENT, TYPE=S4, ELSET=plate\n4, 3, 4, 8, 7\n*NSET, NSET=root\n1, 5\n*NSET, NSET=tip\n4, 8\n";
    std::fs::write(dir.path().join("meshes/plate.inp"), mesh).unwrap();
    let deck = DECK.replace("plate.msh", "plate.inp").replace("[output]", "[output]\nsections = true\nlayers = true");
    let deck = deck.replace("\"elastic\"", "\"elastic-plastic\"\nyield_stress = 1e9");
    std::fs::write(dir.path().join("deck.toml"), deck).unwrap();
    run(dir.path(), &["deck.toml", "-o", "out", "--quiet"]).code(0);
    let read = |name: &str| std::fs::read_to_string(dir.path().join("out").join(name)).unwrap();
    let column = |name: &str, at: usize| -> Vec<String> {
        read(name).lines().skip(1).map(|line| line.split(',').nth(at).unwrap().to_owned()).collect()
    };
    assert_eq!(column("shells.csv", 3), ["0", "1", "2", "3", "0", "1", "2", "3"]);
    let layers: Vec<String> = (0..8).flat_map(|k| std::iter::repeat_n((k % 4).to_string(), 8)).collect();
    assert_eq!(column("layers.csv", 3), layers);
    // The moment falls from the root to the tip.
    let moments: Vec<f64> = column("shells.csv", 7)[4..].iter().map(|m| m.parse::<f64>().unwrap().abs()).collect();
    assert!((1..3).all(|k| moments[0] > moments[k] && moments[k] > moments[3]), "{moments:?}");
    assert_eq!(read("fields.csv"), "part,kind,name\n0,shell,plate\n");
    let told = String::from_utf8(run(dir.path(), &["check", "deck.toml"]).code(0).get_output().stdout.clone()).unwrap();
    assert_eq!(told.matches("shell `plate`: 8 layers").count(), 1, "{told}");
}
