//! Exceptions that may only become fewer: one that is worse than it is known to be fails, and so does one that is better or gone.

use std::collections::BTreeMap;

/// What is known to break a rule, by how much.
pub type Known = &'static [(&'static str, usize)];

/// Fails with a list where what was found is not what is known.
pub fn compare(rule: &str, known: Known, found: &BTreeMap<String, usize>) {
    let known: BTreeMap<&str, usize> = known.iter().copied().collect();
    let mut said = Vec::new();
    for (name, count) in found {
        match known.get(name.as_str()) {
            None => said.push(format!("(\"{name}\", {count}), // new")),
            Some(listed) if count > listed => said.push(format!("(\"{name}\", {count}), // more than {listed}")),
            Some(listed) if count < listed => {
                said.push(format!("(\"{name}\", {count}), // fewer than {listed}: list it"))
            }
            Some(_) => {}
        }
    }
    let gone = known.keys().filter(|name| !found.contains_key(**name));
    said.extend(gone.map(|name| format!("\"{name}\" is no exception any more")));
    assert!(said.is_empty(), "{rule}:\n{}", said.join("\n"));
}
