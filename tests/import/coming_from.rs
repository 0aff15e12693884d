//! The page about coming from other programs: its files run, and its numbers come out.

use super::values::near;
use assert_cmd::Command;
use std::path::Path;

/// Each row of the table: the file runs, and the last row of its node has the value.
#[test]
fn examples_have_the_values_of_the_page() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let page = std::fs::read_to_string(docs.join("coming_from.md")).unwrap();
    let rows = page.lines().filter(|line| line.starts_with("| ") && line.contains("]("));
    let mut count = 0;
    for cells in rows.map(|line| line.split('|').map(str::trim).collect::<Vec<_>>()) {
        let file = cells[2].split(['(', ')']).nth(1).unwrap();
        let name = Path::new(file).file_name().unwrap().to_str().unwrap();
        assert!(page.contains(&format!("```\nrdsolve {name}\n```")), "the page has the command for {name}");
        let out = tempfile::tempdir().unwrap();
        let mut program = Command::cargo_bin("rdsolve").unwrap();
        let folder = docs.join(file).parent().unwrap().to_owned();
        let done =
            program.current_dir(folder).args([name, "--quiet", "--overwrite", "--set", "output.nodes=\"all\"", "-o"]);
        let done = done.arg(out.path()).output().unwrap();
        assert!(done.status.success(), "{name}: {}", String::from_utf8_lossy(&done.stderr));
        let mut table = csv::Reader::from_path(out.path().join("nodes.csv")).unwrap();
        let head = table.headers().unwrap().clone();
        let at = |wanted: &str| head.iter().position(|column| column == wanted).unwrap();
        let (node, column) = (at("node"), at(cells[4]));
        let last = table.records().map(Result::unwrap).filter(|row| &row[node] == cells[3]).last().unwrap();
        // Shear of the pipe by another coefficient differs by less, and so do large rotations of 6e-3.
        near(last[column].parse().unwrap(), cells[5].parse().unwrap(), 2e-3);
        count += 1;
    }
    assert_eq!(count, 4);
}
