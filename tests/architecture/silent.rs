//! A crate whose own tests are not compiled has none: they would never run, and nobody would see it.

use super::source::{CRATES, files, root};

#[test]
fn crates_without_tests_hold_none() {
    for crate_name in CRATES {
        let folder = root().join("src").join(crate_name);
        let settings = std::fs::read_to_string(folder.join("Cargo.toml")).expect("a crate has settings");
        if settings.contains("\ntest = false") {
            for path in files(&folder).into_iter().filter(|path| path.extension().is_some_and(|end| end == "rs")) {
                let text = std::fs::read_to_string(&path).expect("a file of text");
                assert!(!text.contains("#[cfg(test)]"), "{} holds tests that never run", path.display());
            }
        }
    }
}
