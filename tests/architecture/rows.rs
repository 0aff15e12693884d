//! Who may import whom: a folder of src uses the rows above its own, and of its own row only what is named here.

use super::source::{CRATES, files, room_of, root};

/// Rows from the bottom up; siblings do not know each other.
const ROWS: [&[&str]; 12] = [
    &["math", "names", "quantities", "diagnostic", "tolerances"],
    &["words", "text_file", "snapshot"],
    &["state", "sections", "solids", "materials", "amplitude", "linear", "mesh", "record"],
    &["elements", "constraints", "integrators"],
    &["deck"],
    &["model", "system", "import"],
    &["plan"],
    &["modes"],
    &["solve", "results"],
    &["study", "sweep"],
    &["command"],
    &["main"],
];

/// Siblings that are allowed: a state keeps the account of what materials spent, equations are set up from the model, and files are written from what the march shows.
const NAMED: [(&str, &str); 3] = [("state", "materials"), ("system", "model"), ("results", "solve")];

/// What has no business with how a scene is written down or computed.
const KINDS: [&str; 7] = ["elements", "constraints", "integrators", "sections", "solids", "materials", "amplitude"];

fn row(room: &str) -> usize {
    ROWS.iter()
        .position(|row| row.contains(&room))
        .unwrap_or_else(|| panic!("`{room}` has no row in tests/architecture/rows.rs"))
}

/// The rooms that the paths of a text without its tests name, in the crate `own`.
fn imports(own: &str, text: &str) -> Vec<String> {
    // A module may bear the name of a crate that its own crate does not use.
    let package = if CRATES.contains(&own) { root().join("src").join(own) } else { root() };
    let package = std::fs::read_to_string(package.join("Cargo.toml")).expect("a package");
    let used = |name: &str| name != own && CRATES.contains(&name) && package.contains(&format!("\n{name}.workspace"));
    let code = text.split("#[cfg(test)]").next().unwrap_or(text);
    let code: String = code.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
    let mut rooms = Vec::new();
    for (at, _) in code.match_indices("::") {
        let before = code[..at].rsplit(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or("");
        let path = code[..at - before.len()].ends_with("::");
        let next: String = code[at + 2..].chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        match before {
            "crate" => rooms.push(room_of(own, Some(&next)).to_string()),
            name if !path && used(name) => rooms.push(room_of(name, Some(&next)).to_string()),
            _ => {}
        }
    }
    rooms
}

#[test]
fn rooms_use_what_lies_below_them() {
    let src = root().join("src");
    let mut seen = 0;
    for path in files(&src) {
        let inner = path.strip_prefix(&src).unwrap();
        if inner.extension().is_none_or(|extension| extension != "rs") {
            continue;
        }
        let mut names = inner.iter().map(|name| name.to_str().unwrap().trim_end_matches(".rs"));
        let own = names.next().unwrap();
        let room = room_of(own, names.next());
        if ["lib", "main"].contains(&own) {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(room == "linear" || !text.contains("faer::"), "{} imports faer", inner.display());
        for other in imports(own, &text) {
            let at = inner.display();
            // The root of a crate that is rooms alone holds their list and their macros.
            if ["base", "mechanics"].contains(&other.as_str()) {
                continue;
            }
            let named = NAMED.contains(&(room, other.as_str()));
            assert!(other == room || row(&other) < row(room) || named, "{at}: `{room}` imports `{other}`");
            let words = ["deck", "model", "plan"].contains(&other.as_str());
            assert!(!(KINDS.contains(&room) && words), "{at}: a kind imports `{other}`");
            assert!((room, other.as_str()) != ("solve", "results"), "{at}: the march knows of files");
            seen += 1;
        }
    }
    assert!(seen > 100, "{seen} imports");
}
