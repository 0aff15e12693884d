//! docs as a book: every page is in its summary, and it builds where `mdbook` is installed.

use super::{read, root};
use std::fs;
use std::process::Command;

#[test]
fn the_book_has_every_page() {
    let summary = read(&root().join("docs/SUMMARY.md"));
    for entry in fs::read_dir(root().join("docs")).expect("docs/") {
        let name = entry.unwrap().file_name().into_string().unwrap();
        if name.ends_with(".md") && name != "SUMMARY.md" {
            assert!(summary.contains(&format!("]({name})")), "docs/SUMMARY.md does not list {name}");
        }
    }
}

#[test]
fn the_book_builds_where_mdbook_is_installed() {
    let folder = tempfile::tempdir().unwrap();
    let built = Command::new("mdbook").arg("build").arg(root().join("docs")).arg("-d").arg(folder.path()).output();
    let Ok(built) = built else { return eprintln!("mdbook is not installed") };
    let said = String::from_utf8_lossy(&built.stderr).into_owned() + &String::from_utf8_lossy(&built.stdout);
    assert!(built.status.success() && !said.contains("WARN") && !said.contains("ERROR"), "{said}");
    for picture in ["pictures/joints.svg", "gallery/first.svg", "gallery.html"] {
        assert!(folder.path().join(picture).exists(), "the book lacks {picture}");
    }
}
