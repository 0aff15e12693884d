//! Pieces of HTML; every text in them is [`escaped`].

/// A text that may stand anywhere in HTML, in an attribute too.
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            other => out.push(other),
        }
    }
    out
}

/// A table whose first column names its rows; the others are numbers. Cells are plain text; an empty head is left out.
pub fn table(head: &[&str], rows: &[Vec<String>]) -> String {
    let head: String = head.iter().map(|cell| format!("<th>{}</th>", escaped(cell))).collect();
    let row = |cells: &Vec<String>| {
        let cells: String = cells.iter().map(|cell| format!("<td>{}</td>", escaped(cell))).collect();
        format!("<tr>{cells}</tr>\n")
    };
    let head = if head.is_empty() { head } else { format!("<thead><tr>{head}</tr></thead>\n") };
    format!("<table>{head}<tbody>\n{}</tbody></table>\n", rows.iter().map(row).collect::<String>())
}

/// A script element with JSON; nothing in the JSON can end the element.
pub fn data(id: &str, value: &serde_json::Value) -> String {
    let json = value.to_string().replace('<', "\\u003c");
    format!("<script type=\"application/json\" id=\"{id}\">{json}</script>\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_text_ends_what_it_stands_in() {
        let evil = "</script><script>alert('1')\"&";
        assert!(!escaped(evil).contains(['<', '"', '\'']));
        let data = data("d", &serde_json::json!({ "name": evil }));
        assert_eq!(data.matches('<').count(), 2);
        assert!(table(&["a"], &[vec![evil.into()]]).contains("&lt;/script&gt;"));
    }
}
