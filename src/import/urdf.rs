//! Robots of URDF: a file is read whole, and becomes a deck and a verdict on every element below `<robot>`.

use crate::robot::{RobotReader, line_of};
use crate::verdicts::{KeywordVerdict, Verdicts};
use crate::{ImportOptions, Imported, deck_text, robot_deck, source};
use base::text_file::Text;
use roxmltree::{Document, Node};

/// Makes a deck of a robot.
pub fn import_robot(text: &Text, options: &ImportOptions) -> Imported {
    let utf8 = std::str::from_utf8(text.bytes).map(|utf8| utf8.trim_start_matches('\u{feff}'));
    let found = match utf8 {
        Ok(utf8) => Document::parse(utf8).map_err(|error| (error.pos().row as usize, error.to_string())),
        Err(_) => Err((1, "the file is not encoded in UTF-8".to_owned())),
    };
    let document = match found {
        Ok(document) => document,
        Err((line, why)) => {
            let mut verdicts = Verdicts::new(vec![(1, "<robot>".to_owned())]);
            verdicts.add(text, KeywordVerdict::Refused, line.max(1), None, why);
            return Imported { deck: String::new(), mesh: String::new(), verdicts };
        }
    };
    let elements: Vec<(usize, String)> = document
        .root_element()
        .children()
        .filter(Node::is_element)
        .map(|node| {
            (line_of(&node), format!("<{}> {}", node.tag_name().name(), node.attribute("name").unwrap_or_default()))
        })
        .collect();
    let mut keywords = vec![(line_of(&document.root_element()), "<robot>".to_owned())];
    keywords.extend(elements.iter().cloned());
    let mut reader = RobotReader { text, verdicts: Verdicts::new(keywords) };
    let robot = reader.robot(&document);
    let name = robot.name.clone();
    let deck = match robot.links.is_empty() || reader.verdicts.count(KeywordVerdict::Refused) > 0 {
        true => None,
        false => Some(robot_deck::deck(&mut reader, robot)),
    };
    let mut verdicts = reader.verdicts;
    if deck.is_none() && verdicts.count(KeywordVerdict::Refused) == 0 {
        verdicts.add(text, KeywordVerdict::Refused, 1, None, "the robot has no link".to_owned());
    }
    for (line, what) in &elements {
        if !verdicts.has(*line) {
            let about = if what.starts_with("<link>") { "a body, or a part of one" } else { "[[joints]]" };
            verdicts.add(text, KeywordVerdict::Translated, *line, None, about.to_owned());
        }
    }
    verdicts.rows.sort_by_key(|row| row.line);
    let units = options.units.as_deref().unwrap_or("SI");
    let path = text.path.rsplit(['/', '\\']).next().unwrap_or(text.path);
    let head = format!(
        "# made of {path} by rdsolve import; joints without `motion` or `effort` swing freely\ntitle = {}\nunits = {}\n",
        deck_text::quoted(&name),
        deck_text::quoted(units)
    );
    let deck = deck.map_or_else(String::new, |deck| deck.write(&head, |line| source(text, line)));
    Imported { deck, mesh: String::new(), verdicts }
}
