//! Links in words.

use super::explanation::Explanation;
use crate::system::System;
use base::names::short;
use model::{Link, Model};

/// Adds a line about the links that are pretensioned.
pub fn explain(text: &mut Explanation, model: &Model, _: &System) {
    let pretension = |link: &Link| {
        let node = link.take_up?;
        let pull = model.loading.nodal.iter().find(|load| load.node == node);
        Some(match pull {
            Some(pull) => format!("`{}` is pulled to {}", link.name, short(pull.force.x)),
            None => format!("`{}` keeps its length", link.name),
        })
    };
    let all: Vec<String> = model.each::<Link>().filter_map(pretension).collect();
    match all.len() {
        0 => {}
        1..=6 => text.add("pretension", all.join(", ")),
        many => text.add("pretension", format!("{many} links: {}, …", all[..6].join(", "))),
    }
}
