//! summary.html: the summary of a sweep as scatter plots and a sortable table, on one page that opens without a network.

use results::report::STYLE;
use results::report::html::{data, escaped};
use serde_json::json;

const SCRIPT: &str = include_str!("page.js");

/// The page of a summary: the header and the rows of summary.csv, the folders of the cases, and how many columns vary and are collected.
pub fn page(header: &[String], rows: &[Vec<String>], folders: &[&str], [varied, collected]: [usize; 2]) -> String {
    // The columns are: case, varied entries, status, collected numbers, reason, warnings.
    let all = json!({
        "columns": header,
        "rows": rows,
        "folders": folders,
        "varied": (1..=varied).collect::<Vec<_>>(),
        "collected": (varied + 2..varied + 2 + collected).collect::<Vec<_>>(),
    });
    let count = rows.len();
    let title = escaped(&format!("Sweep of {count} cases"));
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<title>{title}</title>\n\
         <link rel=\"icon\" href=\"data:,\">\n<style>\n{STYLE}\n#scatter {{ width: 100%; height: 24rem; }}\n</style>\n</head>\n<body>\n\
         <h1>{title}</h1>\n<section id=\"plot\"><h2>One number over another</h2>\n<div id=\"controls\" class=\"controls\"></div>\n\
         <canvas id=\"scatter\"></canvas></section>\n\
         <section><h2>Cases</h2>\n<p class=\"note\">A click on a head sorts; numbers of cases lead to their folders, where these are kept.</p>\n\
         <table id=\"cases\"></table></section>\n{}<script>\n{SCRIPT}</script>\n</body>\n</html>\n",
        data("data", &all)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_asks_for_nothing_from_elsewhere() {
        let row = vec!["1".to_owned(), "</script>".to_owned(), "done".to_owned(), "2.0".to_owned(), String::new()];
        let header = ["case", "a.b", "status", "peak", "reason"].map(str::to_owned);
        let page = page(&header, &[row], &["00ff"], [1, 1]);
        for word in ["http:", "https:", "src=", "@import", "url(", "fetch("] {
            assert!(!page.contains(word), "{word}");
        }
        assert_eq!(page.matches("</script>").count(), 2);
        assert!(page.contains("\"varied\":[1]") && page.contains("\"collected\":[3]"));
    }
}
