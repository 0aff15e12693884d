//! `--set KEY=VALUE`: one entry of the deck, overridden before it is read.
//!
//! An argument is itself a line of TOML. Its spans are then moved by its offset in the [`Source`], so that they are those of the source.
//! Two freedoms are added. Shells remove quotes, so a bare word or file name that is neither a number nor `true` or `false` is text (`--set
//! integrator.scheme=wilson-theta`, `--set mesh.file=fine.msh`). And `loads[0].force` is `loads.0.force`.
//!
//! [`Source`]: base::diagnostic::Source

use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::number_slips;
use base::diagnostic::{Diagnostic, Span};
use base::names::nearest;

/// Tables that an override may begin; entries of any other must stand in the deck.
const SINGLE: [&str; 8] = ["mesh", "analysis", "integrator", "iteration", "environment", "damping", "output", "study"];
/// Tables whose entries are named by the user.
const NAMED: [&str; 5] = ["materials", "sections", "points", "sets", "amplitudes"];

/// The argument as TOML: a bare word in quotes, an index in brackets behind a dot; no byte before the value changes its place.
pub fn toml(argument: &str) -> String {
    let Some((key, value)) = equals(argument).map(|at| argument.split_at(at + 1)) else {
        return argument.to_owned();
    };
    let key = dotted(key);
    if is_bare_word(value) { format!("{key}\"{value}\"") } else { format!("{key}{value}") }
}

/// A table with all places, including nested ones, moved by `offset`.
pub fn moved<'i>(table: DeTable<'i>, offset: usize) -> DeTable<'i> {
    let place = |span: Span| span.start + offset..span.end + offset;
    let entry = |(key, value): (Spanned<DeString<'i>>, Spanned<DeValue<'i>>)| {
        (Spanned::new(place(key.span()), key.into_inner()), moved_value(value, offset))
    };
    table.into_iter().map(entry).collect()
}

fn moved_value(value: Spanned<DeValue>, offset: usize) -> Spanned<DeValue> {
    let span = value.span();
    let inner = match value.into_inner() {
        DeValue::Table(table) => DeValue::Table(moved(table, offset)),
        DeValue::Array(list) => DeValue::Array(list.into_iter().map(|item| moved_value(item, offset)).collect()),
        other => other,
    };
    Spanned::new(span.start + offset..span.end + offset, inner)
}

/// `a[0].b` as `a.0 .b`; brackets within quotes stay.
fn dotted(key: &str) -> String {
    let mut quote = None;
    let mut plain = |c: char| {
        match (quote, c) {
            (None, '"' | '\'') => quote = Some(c),
            (Some(open), _) if open == c => quote = None,
            (None, '[') => return '.',
            (None, ']') => return ' ',
            _ => {}
        }
        c
    };
    key.chars().map(&mut plain).collect()
}

fn is_bare_word(value: &str) -> bool {
    let letters = |c: char| c.is_alphanumeric() || "_-./".contains(c);
    value.starts_with(char::is_alphabetic)
        && value.chars().all(letters)
        && !["true", "false", "inf", "nan"].contains(&value)
}

/// The first `=` outside quotes.
fn equals(argument: &str) -> Option<usize> {
    let mut quote = None;
    for (at, c) in argument.char_indices() {
        match (quote, c) {
            (None, '=') => return Some(at),
            (None, '"' | '\'') => quote = Some(c),
            (Some(open), _) if open == c => quote = None,
            _ => {}
        }
    }
    None
}

/// Puts the value of an argument, written as [`toml`] has it, in its place in the deck.
///
/// # Errors
/// It is not KEY=VALUE, or the deck has no such entry; places are those of the source, where the argument begins at `offset`.
pub fn merge<'i>(root: &mut DeTable<'i>, toml: &'i str, offset: usize, argument: &str) -> Result<(), Diagnostic> {
    let all = offset..offset + argument.len();
    let example = "such as beams.portal.elements=24";
    let equals = equals(argument)
        .ok_or_else(|| Diagnostic::error("`--set` takes KEY=VALUE").at(&all).hint(example))
        .map(|at| offset + at)?;
    let table = DeTable::parse(toml)
        .map_err(|error| {
            let inside = error.span().unwrap_or(0..argument.len());
            let slip = number_slips::explain(toml, inside.start);
            let place = inside.start + offset..inside.end + offset;
            let hint = match (argument[equals + 1 - offset..].trim_start(), &slip) {
                _ if place.start < equals => "the key is a dotted path, such as beams.portal.elements or loads.0.force",
                (_, Some((_, hint))) => hint,
                (value, None) if value.contains(',') => "several numbers need brackets, such as [1.0, 0.0, 0.0]",
                _ => "text with blanks or signs needs quotes",
            };
            Diagnostic::error(format!("this is not KEY=VALUE with a TOML value: {}", error.message()))
                .at(&place)
                .hint(hint)
        })?
        .into_inner();
    let mut table = moved(table, offset);
    if let Some(problem) = super::aliases::unify(&mut table).pop() {
        return Err(problem);
    }
    // Down the dotted key; a table behind the sign is the value itself.
    let mut path = Vec::new();
    let value = loop {
        let Some((key, value)) = table.into_iter().next() else {
            return Err(Diagnostic::error("`--set` takes KEY=VALUE").at(&all).hint(example));
        };
        path.push(key);
        let span = value.span();
        match value.into_inner() {
            DeValue::Table(inner) if inner.keys().next().is_some_and(|key| key.span().start < equals) => table = inner,
            value => break Spanned::new(span, value),
        }
    };
    fn word<'k>(key: &'k Spanned<DeString>) -> &'k str {
        key.get_ref().as_ref()
    }
    if let [first, second, ..] = path.as_slice() {
        match root.get(word(first)).map(Spanned::get_ref) {
            None if !SINGLE.contains(&word(first)) => {
                return Err(unknown("the deck has no", first, root.keys().map(word)));
            }
            Some(DeValue::Table(named)) if NAMED.contains(&word(first)) && !named.contains_key(word(second)) => {
                return Err(unknown(&format!("`{}` has no", word(first)), second, named.keys().map(word)));
            }
            _ => {}
        }
    }
    put(root, &path, value)
}

fn unknown<'a>(what: &str, key: &Spanned<DeString>, known: impl Iterator<Item = &'a str>) -> Diagnostic {
    let diagnostic = Diagnostic::error(format!("{what} `{}`", key.get_ref())).at(&key.span());
    match nearest(key.get_ref(), known) {
        Some(near) => diagnostic.hint(format!("did you mean `{near}`?")),
        None => diagnostic.hint("only entries of the deck can be overridden"),
    }
}

fn put<'i>(
    table: &mut DeTable<'i>,
    path: &[Spanned<DeString<'i>>],
    value: Spanned<DeValue<'i>>,
) -> Result<(), Diagnostic> {
    let Some((key, rest)) = path.split_first() else { return Ok(()) };
    match table.get_mut(key.get_ref().as_ref()) {
        Some(found) if rest.is_empty() => *found = value,
        Some(found) => return put_below(found, key, rest, value),
        None if rest.is_empty() => {
            table.insert(key.clone(), value);
        }
        None => {
            let mut inner = DeTable::new();
            put(&mut inner, rest, value)?;
            table.insert(key.clone(), Spanned::new(key.span(), DeValue::Table(inner)));
        }
    }
    Ok(())
}

/// `rest` is not empty.
fn put_below<'i>(
    found: &mut Spanned<DeValue<'i>>,
    key: &Spanned<DeString<'i>>,
    rest: &[Spanned<DeString<'i>>],
    value: Spanned<DeValue<'i>>,
) -> Result<(), Diagnostic> {
    match found.get_mut() {
        DeValue::Table(inner) => put(inner, rest, value),
        DeValue::Array(list) => {
            let Some((word, rest)) = rest.split_first() else { return Ok(()) };
            let index = item(list, key.get_ref(), word.get_ref(), &word.span())?;
            let Some(found) = list.get_mut(index) else { return Ok(()) };
            if rest.is_empty() {
                *found = value;
                return Ok(());
            }
            put_below(found, word, rest, value)
        }
        _ => {
            let message = format!("`{}` is a value and has no entry `{}`", key.get_ref(), rest[0].get_ref());
            Err(Diagnostic::error(message).at(&rest[0].span()).hint(format!("write {}=VALUE", key.get_ref())))
        }
    }
}

/// Which item of a list is meant, by its number or its `name`; parts of a mesh without one go by their `group`.
fn item(list: &[Spanned<DeValue>], key: &str, word: &str, place: &Span) -> Result<usize, Diagnostic> {
    let names: Vec<(usize, &str)> = list
        .iter()
        .enumerate()
        .filter_map(|(i, item)| {
            let table = item.get_ref().as_table()?;
            Some((i, table.get("name").or_else(|| table.get("group"))?.get_ref().as_str()?))
        })
        .collect();
    if let Some((index, _)) = names.iter().find(|(_, name)| *name == word) {
        return Ok(*index);
    }
    match word.parse::<usize>() {
        Ok(index) if index < list.len() => Ok(index),
        Ok(_) => {
            let last = list.len().saturating_sub(1);
            Err(Diagnostic::error(format!("`{key}` has no item {word}"))
                .at(place)
                .hint(format!("items are 0 to {last}")))
        }
        Err(_) => {
            let diagnostic = Diagnostic::error(format!("`{key}` has no item named `{word}`")).at(place);
            Err(match nearest(word, names.iter().map(|(_, name)| *name)) {
                Some(near) => diagnostic.hint(format!("did you mean `{near}`?")),
                None => diagnostic.hint(format!("items go by their name or by a number, such as {key}.0")),
            })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_index_may_stand_in_brackets() {
        assert_eq!(toml("loads[0].force[2]=1.0"), "loads.0 .force.2 =1.0");
        assert_eq!(toml("sets.\"a[0]\"=b"), "sets.\"a[0]\"=\"b\"");
        assert_eq!(toml("bodies.b.velocity=[1.0]"), "bodies.b.velocity=[1.0]");
    }
}
