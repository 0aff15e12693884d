//! Contacts: what meets what, and how.

use super::explanation::Explanation;

use crate::model::{Contact, Model};
use crate::names::short;
use crate::system::System;

/// Adds lines about contacts.
pub fn explain(text: &mut Explanation, model: &Model, _: &System) {
    for contact in model.each::<Contact>() {
        text.add("contact", contact_in_words(model, contact));
    }
}

/// The two sides of a contact and its law.
fn contact_in_words(model: &Model, contact: &Contact) -> String {
    let shape = contact.surface.shape.word();
    let carrier = model.bodies.iter().find(|body| body.node == contact.node);
    let on = carrier.map_or("the ground".to_string(), |body| format!("body `{}`", body.name));
    let (name, count) = (&contact.name, contact.points.len());
    let points = if count == 1 { "point" } else { "points" };
    let radius = contact.points.iter().map(|point| point.radius).fold(0.0, f64::max);
    let radius = if radius > 0.0 { format!(" of contact radius {}", short(radius)) } else { String::new() };
    let pair = format!("`{name}`: {count} {points}{radius} against a {shape} on {on}");
    let Some(law) = &contact.law else { return format!("{pair}; clearance monitor, no force acts") };
    let chosen = if contact.chosen { " (chosen so that an impact lasts 20 steps)" } else { "" };
    let stiffness = format!("penalty stiffness {}{chosen}", short(law.stiffness));
    match law.resolution {
        limit if limit < f64::INFINITY => {
            format!("{pair}; {stiffness}; steps during impacts at most {}", short(limit))
        }
        _ => format!("{pair}; {stiffness}"),
    }
}
