//! study.html: the picture and the tables on one page that opens without a network.

use super::found::Found;
use super::table;
use crate::output::report::STYLE;
use crate::output::report::html::{self, escaped};

/// The page of a study; `picture` is its SVG.
pub fn page(found: &Found, picture: &str) -> String {
    let label = |line: usize| found.grid.lines[line].label.clone();
    let orders: Vec<Vec<String>> = found
        .orders
        .iter()
        .enumerate()
        .map(|(line, order)| vec![label(line), table::order(&found.grid.lines[line], order)])
        .collect();
    let mut cheapest = Vec::new();
    for (wanted, list) in &found.cheapest {
        for of in list {
            cheapest.push(vec![format!("{wanted:e}"), label(of.line), table::cost(&found.grid.lines[of.line], of)]);
        }
        if list.is_empty() {
            cheapest.push(vec![format!("{wanted:e}"), "no run reaches it".into(), String::new()]);
        }
    }
    let picture = picture.replace(" xmlns=\"http://www.w3.org/2000/svg\"", "");
    let (title, deck) = (escaped(&found.title), escaped(&found.deck));
    let (reference, timing) = (escaped(&table::reference(found)), escaped(&table::timing(found)));
    let stopped = if found.stopped { "<p><span class=\"badge bad\">stopped by a signal</span></p>\n" } else { "" };
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<title>{title}: study</title>\n\
         <link rel=\"icon\" href=\"data:,\">\n<style>\n{STYLE}.study {{ width: 100%; height: auto; }}\n\
         .study text {{ fill: var(--ink) !important; }}\n</style>\n</head>\n<body>\n<header>\n<h1>{title}</h1>\n{stopped}\
         <p class=\"note\">Error against run time of <code>{deck}</code>. Reference: {reference}.<br>{timing}</p>\n</header>\n\
         <section>\n{picture}</section>\n\
         <section><h2>Measured orders</h2>\n{}</section>\n\
         <section><h2>Cheapest setting</h2>\n{}</section>\n\
         <section><h2>Runs</h2>\n{}</section>\n</body>\n</html>\n",
        html::table(&["setting", "order"], &orders),
        html::table(&["error", "setting", "cost"], &cheapest),
        html::table(&table::HEAD, &table::cells(found)),
    )
}
