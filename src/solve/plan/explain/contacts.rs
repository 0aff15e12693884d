//! Contacts: touching pairs and their law.

use super::explanation::Explanation;

use crate::system::System;
use base::names::short;
use mechanics::elements::contact::{ConvexBody, Facet, FacetTouchers};
use model::{Body, CarriedSurface, Contact, Model, TouchedSurface};

/// Adds lines about contacts. Parts may pass a monitor unnoticed, because its gaps are only the gaps of its points; its line reports this.
pub fn explain(text: &mut Explanation, model: &Model, _: &System) {
    for contact in model.each::<Contact>() {
        text.add("contact", contact_in_words(model, contact));
        if contact.law.is_some() {
            text.notes.extend(unseen(contact).map(|what| format!("contact `{}` does not see {what}", contact.name)));
        }
    }
}

/// Undetected contact, for each kind of touching part.
fn unseen(contact: &Contact) -> impl Iterator<Item = &'static str> {
    contact.touchers.iter().filter_map(|toucher| match &contact.surface {
        TouchedSurface::Shape(carried) => toucher.unseen(&carried.surface.shape, contact.has_multipliers()),
        TouchedSurface::Facets(faces) if faces.touchers == FacetTouchers::Among => toucher.unseen_among(),
        TouchedSurface::Facets(faces) if faces.facets.iter().any(Facet::is_line) => toucher.unseen_by_lines(),
        TouchedSurface::Facets(_) => toucher.unseen_by_faces(),
    })
}

/// The two sides of a contact and its law.
fn contact_in_words(model: &Model, contact: &Contact) -> String {
    let pair = format!("`{}`: {}", contact.name, sides_in_words(model, contact));
    let Some(law) = &contact.law else {
        let by_points = if unseen(contact).next().is_some() { "; gaps are those of the points" } else { "" };
        return format!("{pair}; clearance monitor, no force acts{by_points}");
    };
    let chosen = contact.chosen.as_ref().map_or(String::new(), |reason| format!(" (chosen: {reason})"));
    let left = law.tolerance.map_or(String::new(), |left| format!("; multipliers leave a depth of {}", short(left)));
    let stiffness = format!("penalty stiffness {}{chosen}{left}", short(law.stiffness));
    match law.resolution {
        limit if limit < f64::INFINITY => {
            format!("{pair}; {stiffness}; steps during impacts at most {}", short(limit))
        }
        _ => format!("{pair}; {stiffness}"),
    }
}

/// The touching and the touched bodies in words.
fn sides_in_words(model: &Model, contact: &Contact) -> String {
    let touching = touching_in_words(contact);
    let faces = match &contact.surface {
        TouchedSurface::Facets(faces) => faces,
        TouchedSurface::Shape(CarriedSurface { node, surface }) => {
            let carrier = Body::at(&model.bodies, *node);
            let on = carrier.map_or("the ground".to_string(), |body| format!("body `{}`", model.bodies[body].name));
            return format!("{touching} against a {} on {on}", surface.shape.word());
        }
    };
    let (count, part) = (faces.facets.len(), &faces.part);
    let back = match faces.solids.len() {
        0 => String::new(),
        1 => format!(", and its nodes against a {}", faces.solids[0].surface.shape.word()),
        solids => format!(", and its nodes against {solids} convex bodies"),
    };
    let kind = match faces.facets.iter().any(Facet::is_line) {
        _ if faces.is_of_edges => "lines of free edges",
        true => "lines",
        false => "faces",
    };
    match faces.touchers {
        FacetTouchers::Others => format!("{touching} against {count} {kind} of `{part}`{back}"),
        FacetTouchers::Itself => format!("{touching} of `{part}` against its own {count} {kind}"),
        FacetTouchers::Among => {
            let balls = counted(count, "ball", "balls");
            let all = balls.into_iter().chain(solids_in_words(contact)).collect::<Vec<_>>().join(" and ");
            let joined = counted(contact.joined.len(), "pair that is joined does", "pairs that are joined do");
            let joined = joined.map_or(String::new(), |joined| format!("; {joined} not touch"));
            format!("{all} among themselves{joined}")
        }
    }
}

/// The points, and the convex bodies with all that they are.
fn touching_in_words(contact: &Contact) -> String {
    let radius = contact.points.iter().map(|point| point.radius).fold(0.0, f64::max);
    let radius = if radius > 0.0 { format!(" of contact radius {}", short(radius)) } else { String::new() };
    let words =
        if contact.points.iter().any(|point| point.is_line()) { ["line", "lines"] } else { ["point", "points"] };
    let points = counted(contact.points.len(), words[0], words[1]).map(|points| points + &radius);
    let solids = solids_in_words(contact).map(|solids| solids + " with all their surface");
    points.into_iter().chain(solids).collect::<Vec<_>>().join(" and ")
}

/// The convex bodies, each kind that there is.
fn solids_in_words(contact: &Contact) -> impl Iterator<Item = String> {
    let is_box = |one: &&ConvexBody| one.shape.half_edges().is_some();
    let is_polyhedron = |one: &&ConvexBody| one.shape.as_polyhedron().is_some();
    let boxes = contact.convex.iter().filter(is_box).count();
    let polyhedra = contact.convex.iter().filter(is_polyhedron).count();
    let cylinders = contact.convex.iter().filter(|one| one.shape.is_cylinder()).count();
    let capsules = contact.convex.len() - polyhedra - cylinders;
    let kinds = [
        (boxes, "box", "boxes"),
        (polyhedra - boxes, "hull", "hulls"),
        (cylinders, "cylinder", "cylinders"),
        (capsules, "capsule", "capsules"),
    ];
    kinds.into_iter().filter_map(|(count, one, many)| counted(count, one, many))
}

/// So many of a kind; nothing where there are none.
fn counted(count: usize, one: &str, many: &str) -> Option<String> {
    match count {
        0 => None,
        1 => Some(format!("1 {one}")),
        _ => Some(format!("{count} {many}")),
    }
}
