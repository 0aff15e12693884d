//! The keys of links along a line, which other links do not have.

use super::{hysteretic, isolator};
use crate::values::span;
use base::diagnostic::Span;
use deck::links as words;
use deck::words::NumberOrTable;

/// The keys of a law along a line.
pub fn of_lines(link: &words::Link) -> Vec<(&'static str, Option<&Span>)> {
    let of_paths = hysteretic::keys(link);
    let others = [
        ("law", span(&link.law)),
        ("stiffness", span(&link.stiffness)),
        ("damping", dashpot(link)),
        ("gap", span(&link.gap)),
        ("preload", span(&link.preload)),
        ("free_length", span(&link.free_length)),
        ("direction", span(&link.direction)),
        ("points", span(&link.points)),
    ];
    let of_isolators = isolator::keys(link);
    others.into_iter().chain(of_paths).chain(of_isolators).collect()
}

/// The place of a damper along the line of a link, which a bushing does not have.
pub fn dashpot(link: &words::Link) -> Option<&Span> {
    let given = link.damping.as_ref()?;
    match &given.value {
        NumberOrTable::Number(_) => Some(&given.span),
        NumberOrTable::Table(table) => span(&table.viscous),
    }
}
