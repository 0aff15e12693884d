//! Entries written into the text of a deck, which keeps its comments and its order.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The text with the value of each entry, `KEY=VALUE`, in its place, and without the line of one key. `None` if a key shares its line with
/// others, or if the text is no TOML.
pub fn with_entries(text: &str, entries: &[String], without: &str) -> Option<String> {
    let mut text = without_line(text, without)?;
    for entry in entries {
        let (key, value) = entry.split_once('=')?;
        let key = key.replace('[', ".").replace(']', "");
        text = with_entry(&text, &key.split('.').map(str::trim).collect::<Vec<_>>(), &as_toml(value.trim()))?;
    }
    Some(text)
}

/// A value of an override as TOML: a bare word gets quotes.
fn as_toml(value: &str) -> String {
    match DeTable::parse(&format!("value = {value}")) {
        Ok(_) => value.to_owned(),
        Err(_) => format!("\"{value}\""),
    }
}

/// The table that holds an entry.
fn holder<'t, 'i>(root: &'t DeTable<'i>, path: &[&str]) -> Option<&'t DeTable<'i>> {
    let mut table = root;
    let mut words = path.iter();
    while let Some(word) = words.next() {
        table = match table.get(*word)?.get_ref() {
            DeValue::Table(inner) => inner,
            DeValue::Array(list) => item(list, words.next()?)?,
            _ => return None,
        };
    }
    Some(table)
}

/// The table of a list by its number or name.
fn item<'t, 'i>(list: &'t [Spanned<DeValue<'i>>], word: &str) -> Option<&'t DeTable<'i>> {
    let tables = || list.iter().filter_map(|item| item.get_ref().as_table());
    let is_named = |table: &&DeTable| {
        let name = table.get("name").or_else(|| table.get("group"));
        name.and_then(|name| name.get_ref().as_str()).is_some_and(|name| name == word)
    };
    tables().find(is_named).or_else(|| tables().nth(word.parse().ok()?))
}

fn with_entry(text: &str, path: &[&str], value: &str) -> Option<String> {
    let root = DeTable::parse(text).ok()?.into_inner();
    let (last, parents) = path.split_last()?;
    let Some(table) = holder(&root, parents) else {
        // A missing table begins at the end of the text.
        let [table] = parents else { return None };
        let is_new = !root.contains_key(*table);
        return is_new.then(|| format!("{}\n\n[{table}]\n{last} = {value}\n", text.trim_end()));
    };
    let written = match table.get(*last) {
        Some(found) => format!("{}{value}{}", &text[..found.span().start], &text[found.span().end..]),
        None => {
            // Nested tables stand on separate lines.
            let is_line = |value: &Spanned<DeValue>, at: usize| value.span().start > at;
            let first =
                table.iter().filter(|(key, value)| is_line(value, key.span().start)).map(|(key, _)| key.span().start);
            let first = first.min()?;
            let line = text[..first].rfind('\n').map_or(0, |end| end + 1);
            match text[line..first].trim().is_empty() {
                true => format!("{}{last} = {value}\n{}", &text[..first], &text[line..]),
                false => format!("{}{last} = {value}, {}", &text[..first], &text[first..]),
            }
        }
    };
    let again = DeTable::parse(&written).ok()?.into_inner();
    holder(&again, parents)?.contains_key(*last).then_some(written)
}

/// The text without the line of a key; unchanged if the key is missing.
fn without_line(text: &str, key: &str) -> Option<String> {
    let root = DeTable::parse(text).ok()?.into_inner();
    let path: Vec<&str> = key.split('.').collect();
    let (last, parents) = path.split_last()?;
    let found = holder(&root, parents).and_then(|table| table.get_key_value(*last));
    let Some((key, value)) = found else { return Some(text.to_owned()) };
    let begin = text[..key.span().start].rfind('\n').map_or(0, |end| end + 1);
    let end = text[value.span().end..].find('\n').map_or(text.len(), |end| value.span().end + end + 1);
    let rest = text[value.span().end..end].trim();
    let is_alone = text[begin..key.span().start].trim().is_empty() && (rest.is_empty() || rest.starts_with('#'));
    is_alone.then(|| format!("{}{}", &text[..begin], &text[end..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_keep_comments_and_order() {
        let text = "# A mast.\n[analysis]\naccuracy = 1e-3 # of the tip\nend_time = 2.0\n\n[[beams]]\n  name = \"mast\" # steel\n  elements = 2\n";
        let entries =
            ["analysis.time_step=\"auto\"".to_owned(), "beams.0.elements=4".into(), "beams.mast.order=3".into()];
        let written = with_entries(text, &entries, "analysis.accuracy").expect("room for the entries");
        let wanted = "# A mast.\n[analysis]\ntime_step = \"auto\"\nend_time = 2.0\n\n[[beams]]\n  order = 3\n  name = \"mast\" # steel\n  elements = 4\n";
        assert_eq!(written, wanted);
    }

    #[test]
    fn inline_tables_take_entries_between_braces() {
        let text = "beams = [{ name = \"mast\" }]\n";
        let written = with_entries(text, &["beams.mast.order=3".to_owned()], "analysis.accuracy");
        assert_eq!(written.as_deref(), Some("beams = [{ order = 3, name = \"mast\" }]\n"));
    }

    #[test]
    fn a_missing_table_comes_last() {
        let written = with_entries("title = \"mast\"\n", &["output.nodes=\"all\"".to_owned()], "analysis.accuracy");
        assert_eq!(written.as_deref(), Some("title = \"mast\"\n\n[output]\nnodes = \"all\"\n"));
    }
}
