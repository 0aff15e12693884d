//! Contacts: what meets what, and how.

use super::explanation::Explanation;

use crate::elements::contact::{Facet, FacetTouchers};
use crate::model::{CarriedSurface, Contact, Model, TouchedSurface};
use crate::names::short;
use crate::system::System;

/// Adds lines about contacts.
pub fn explain(text: &mut Explanation, model: &Model, _: &System) {
    for contact in model.each::<Contact>() {
        text.add("contact", contact_in_words(model, contact));
        let unseen = contact.touchers.iter().filter_map(|toucher| match &contact.surface {
            TouchedSurface::Shape(carried) => toucher.unseen(&carried.surface.shape),
            TouchedSurface::Facets(faces) if faces.facets.iter().any(Facet::is_line) => toucher.unseen_by_lines(),
            TouchedSurface::Facets(_) => toucher.unseen_by_faces(),
        });
        for what in unseen {
            text.notes.push(format!("contact `{}` does not see {what}", contact.name));
        }
    }
}

/// The two sides of a contact and its law.
fn contact_in_words(model: &Model, contact: &Contact) -> String {
    let pair = format!("`{}`: {}", contact.name, sides_in_words(model, contact));
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

/// What touches what.
fn sides_in_words(model: &Model, contact: &Contact) -> String {
    let touching = touching_in_words(contact);
    let faces = match &contact.surface {
        TouchedSurface::Facets(faces) => faces,
        TouchedSurface::Shape(CarriedSurface { node, surface }) => {
            let carrier = model.bodies.iter().find(|body| body.node == *node);
            let on = carrier.map_or("the ground".to_string(), |body| format!("body `{}`", body.name));
            return format!("{touching} against a {} on {on}", surface.shape.word());
        }
    };
    let (count, part) = (faces.facets.len(), &faces.part);
    let back = match faces.boxes.len() {
        0 => String::new(),
        1 => ", and its nodes against a box".to_owned(),
        boxes => format!(", and its nodes against {boxes} boxes"),
    };
    let kind = if faces.facets.iter().any(Facet::is_line) { "lines" } else { "faces" };
    match faces.touchers {
        FacetTouchers::Others => format!("{touching} against {count} {kind} of `{part}`{back}"),
        FacetTouchers::Itself => format!("{touching} of `{part}` against its own {count} {kind}"),
        FacetTouchers::Among => format!("{count} balls among themselves"),
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
    let words = if contact.points.iter().any(|point| point.is_line) { ["line", "lines"] } else { ["point", "points"] };
    let points = counted(contact.points.len(), words[0], words[1]).map(|points| points + &radius);
    let boxes = counted(contact.boxes.len(), "box", "boxes").map(|boxes| boxes + " with corners, edges and faces");
    points.into_iter().chain(boxes).collect::<Vec<_>>().join(" and ")
}
