//! The program with a mesh: from any folder, with overrides, and its hash.

use super::Plate;
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
    let fields = std::fs::read_to_string(dir.path().join("out/fields_000000.vtu")).unwrap();
    assert!(fields.contains("NumberOfPoints=\"15\" NumberOfCells=\"8\""), "{}", &fields[..400]);
    assert!(std::fs::read_to_string(dir.path().join("out/fields.csv")).unwrap().contains("body,plate"));
}
