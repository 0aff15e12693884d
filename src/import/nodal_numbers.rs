//! Numbers of a part that differ from node to node, as the deck has them.

use crate::build::Build;
use crate::deck_text::{inline, number, quoted};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Numbers by nodes, alike ones together; a set of several nodes is named after `what`.
pub fn by_nodes(build: &mut Build, varying: &BTreeMap<u64, f64>, what: &str) -> String {
    let (mut nodes, mut places): (Vec<(f64, BTreeSet<u64>)>, _) = (Vec::new(), HashMap::new());
    for (node, value) in varying {
        // Both zeros are one number.
        let at = *places.entry((value + 0.0).to_bits()).or_insert(nodes.len());
        if at == nodes.len() {
            nodes.push((*value, BTreeSet::new()));
        }
        nodes[at].1.insert(*node);
    }
    let mut keys = Vec::new();
    for (value, of) in nodes {
        keys.extend(build.names(&of, &[], what).into_iter().map(|name| (quoted(&name), number(value))));
    }
    let keys: Vec<(&str, String)> = keys.iter().map(|(name, text)| (&name[..], text.clone())).collect();
    inline(&keys)
}
