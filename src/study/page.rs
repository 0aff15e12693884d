//! study.html: the picture and the tables on one page that opens without a network.

use super::cost::Cost;
use super::found::Found;
use super::{asked_picture, picture, table};
use results::report::STYLE;
use results::report::html::{self, escaped};

/// The styles with which the chosen axis shows its picture and hides the others.
const CHOICE: &str = ".axes > svg { display: none; }\n.axes > label { margin-right: 1em; }\n\
    #axis0:checked ~ .axis0, #axis1:checked ~ .axis1, #axis2:checked ~ .axis2 { display: block; }\n";

/// The pictures over all costs; a button selects one.
fn pictures(found: &Found, axis: Cost) -> String {
    let (mut buttons, mut pictures) = (String::new(), String::new());
    for (index, cost) in Cost::ALL.into_iter().enumerate() {
        let checked = if cost == axis { " checked" } else { "" };
        buttons += &format!("<input type=\"radio\" name=\"axis\" id=\"axis{index}\"{checked}/>");
        buttons += &format!("<label for=\"axis{index}\">{}</label>\n", cost.word());
        let picture = picture::draw(found, cost).replace(" xmlns=\"http://www.w3.org/2000/svg\"", "");
        pictures += &picture.replacen("class=\"study\"", &format!("class=\"study axis{index}\""), 1);
    }
    buttons + &pictures
}

/// Requested and reached errors of automatic steps, with their picture.
fn asked(found: &Found) -> String {
    let picture = asked_picture::draw(&found.grid, &found.asked).unwrap_or_default();
    let picture = picture.replace(" xmlns=\"http://www.w3.org/2000/svg\"", "");
    table::asked(found).html() + &picture
}

/// The page of a study, which shows errors against this cost first.
pub fn page(found: &Found, axis: Cost) -> String {
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
            let cost = table::cost(&found.grid.lines[of.line], of);
            cheapest.push(vec![format!("{wanted:e}"), label(of.line), table::rank(of, list), cost]);
        }
        if list.is_empty() {
            cheapest.push(vec![format!("{wanted:e}"), "no run reaches it".into(), String::new(), String::new()]);
        }
    }
    let (title, deck) = (escaped(&found.title), escaped(&found.deck));
    let (reference, timing) = (escaped(&table::reference(found)), escaped(&table::timing(found)));
    let stopped = if found.stopped { "<p><span class=\"badge bad\">stopped by a signal</span></p>\n" } else { "" };
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<title>{title}: study</title>\n\
         <link rel=\"icon\" href=\"data:,\">\n<style>\n{STYLE}.study {{ width: 100%; height: auto; }}\n\
         .study text {{ fill: var(--ink) !important; }}\n{CHOICE}</style>\n</head>\n<body>\n<header>\n<h1>{title}</h1>\n{stopped}\
         <p class=\"note\">Error against run time of <code>{deck}</code>. Reference: {reference}.<br>{timing}</p>\n</header>\n\
         <section class=\"axes\">\n{}</section>\n\
         <section><h2>Measured orders</h2>\n{}</section>\n\
         <section><h2>Cheapest setting</h2>\n{}</section>\n{}\
         <section><h2>Runs</h2>\n{}</section>\n</body>\n</html>\n",
        pictures(found, axis),
        html::table(&["setting", "order"], &orders),
        html::table(&["error", "setting", "beside the first", "cost"], &cheapest),
        asked(found),
        html::table(&table::HEAD, &table::cells(found)),
    )
}
