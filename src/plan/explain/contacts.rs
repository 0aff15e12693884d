//! Contacts: what meets what, and how.

use super::explanation::Explanation;

use crate::model::{Contact, Model};
use crate::names::short;
use crate::system::System;

/// Adds lines about contacts.
pub fn explain(text: &mut Explanation, model: &Model, _: &System) {
    for contact in model.each::<Contact>() {
        text.add("contact", contact_in_words(model, contact));
        let unseen = contact.touchers.iter().filter_map(|toucher| toucher.unseen(&contact.surface.shape));
        for what in unseen {
            text.notes.push(format!("contact `{}` does not see {what}", contact.name));
        }
    }
}

/// The two sides of a contact and its law.
fn contact_in_words(model: &Model, contact: &Contact) -> String {
    let shape = contact.surface.shape.word();
    let carrier = model.bodies.iter().find(|body| body.node == contact.node);
    let on = carrier.map_or("the ground".to_string(), |body| format!("body `{}`", body.name));
    let name = &contact.name;
    let pair = format!("`{name}`: {} against a {shape} on {on}", touching_in_words(contact));
    let Some(law) = &contact.law else { return format!("{pair}; clearance monitor, no force acts") };
    let chosen = contact.chosen.as_ref().map_or(String::new(), |reason| format!(" (chosen: {reason})"));
    let stiffness = format!("penalty stiffness {}{chosen}", short(law.stiffness));
    match law.resolution {
        limit if limit < f64::INFINITY => {
            format!("{pair}; {stiffness}; steps during impacts at most {}", short(limit))
        }
        _ => format!("{pair}; {stiffness}"),
    }
}

/// The points, and the boxes with all that they are.
fn touching_in_words(contact: &Contact) -> String {
    let counted = |count: usize, one: &str, many: &str| match count {
        0 => None,
        1 => Some(format!("1 {one}")),
        _ => Some(format!("{count} {many}")),
    };
    let radius = contact.points.iter().map(|point| point.radius).fold(0.0, f64::max);
    let radius = if radius > 0.0 { format!(" of contact radius {}", short(radius)) } else { String::new() };
    let points = counted(contact.points.len(), "point", "points").map(|points| points + &radius);
    let boxes = counted(contact.boxes.len(), "box", "boxes").map(|boxes| boxes + " with corners, edges and faces");
    points.into_iter().chain(boxes).collect::<Vec<_>>().join(" and ")
}
