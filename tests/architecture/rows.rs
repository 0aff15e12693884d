//! Who may import whom: a folder of src uses the rows above its own, and of its own row only what is named here.

use super::source::{files, root};

/// Rows from the bottom up; siblings do not know each other.
const ROWS: [&[&str]; 12] = [
    &["math", "names", "quantities", "diagnostic"],
    &["words", "text_file", "snapshot"],
    &["state", "sections", "solids", "materials", "amplitude", "linear", "mesh", "record"],
    &["elements", "constraints", "integrators"],
    &["deck"],
    &["model", "system"],
    &["plan"],
    &["modes"],
    &["solve", "output"],
    &["study", "sweep"],
    &["command"],
    &["main"],
];

/// Siblings that are allowed: a state keeps the account of what materials spent, equations are set up from the model, and files are written from what the march shows.
const NAMED: [(&str, &str); 3] = [("state", "materials"), ("system", "model"), ("output", "solve")];

/// What has no business with how a scene is written down or computed.
const KINDS: [&str; 7] = ["elements", "constraints", "integrators", "sections", "solids", "materials", "amplitude"];

fn row(room: &str) -> usize {
    ROWS.iter()
        .position(|row| row.contains(&room))
        .unwrap_or_else(|| panic!("`{room}` has no row in tests/architecture/rows.rs"))
}

/// First names after `crate::` in a text without its tests.
fn imports(text: &str) -> Vec<String> {
    let code = text.split("#[cfg(test)]").next().unwrap_or(text);
    let code: String = code.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
    let word = |rest: &str| rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    let behind = |root: &'static str| {
        let rests = code.split(root).skip(1).collect::<Vec<_>>();
        rests.into_iter().flat_map(|rest| match rest.strip_prefix('{') {
            // use crate::{model, plan::Plan}: the names at the first level of the braces.
            Some(list) => list.split('}').next().unwrap_or("").split(',').map(|item| word(item.trim())).collect(),
            None => vec![word(rest)],
        })
    };
    behind("crate::").chain(behind("rdsolve::")).filter(|name| name.starts_with(char::is_lowercase)).collect()
}

#[test]
fn rooms_use_what_lies_below_them() {
    let src = root().join("src");
    let mut seen = 0;
    for path in files(&src) {
        let inner = path.strip_prefix(&src).unwrap();
        let room = inner.iter().next().unwrap().to_str().unwrap().trim_end_matches(".rs");
        if room == "lib" {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(room == "linear" || !text.contains("faer::"), "{} imports faer", inner.display());
        for other in imports(&text) {
            let at = inner.display();
            let named = NAMED.contains(&(room, other.as_str()));
            assert!(other == room || row(&other) < row(room) || named, "{at}: `{room}` imports `{other}`");
            let words = ["deck", "model", "plan"].contains(&other.as_str());
            assert!(!(KINDS.contains(&room) && words), "{at}: a kind imports `{other}`");
            assert!((room, other.as_str()) != ("solve", "output"), "{at}: the march knows of files");
            seen += 1;
        }
    }
    assert!(seen > 100, "{seen} imports");
}
