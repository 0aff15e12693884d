//! Beams: how long their elements are, and how they yield.

use super::explanation::Explanation;
use crate::system::System;
use crate::system::parts::beams::merges_fibres;
use crate::tolerances::weak_axis::{LEVEL, OPEN, STRONG};
use base::names::{short, to_digits};
use mechanics::elements::beam::IntegrationRule;
use model::{Beam, BeamElement, Model, SectionPlaces};
use nalgebra::Vector2;

/// One beam, and several.
const BEAMS: [&str; 2] = ["beam", "beams"];

/// Adds lines about beams.
pub fn explain(text: &mut Explanation, model: &Model, system: &System) {
    for beam in model.each::<Beam>() {
        if beam.graded {
            let length = |e: &BeamElement| {
                let [start, end] = e.ends(beam.order).map(|node| model.nodes[node].x);
                (end - start).norm()
            };
            let lengths = beam.elements.iter().map(length);
            let [shortest, longest] =
                lengths.fold([f64::INFINITY, 0.0], |[least, most], length| [length.min(least), length.max(most)]);
            let graded = format!("elements {} to {} long, the shortest at the ends", short(shortest), short(longest));
            text.add_of("grading", BEAMS, &beam.name, graded);
        }
        if let Some(orientation) = upright(beam, model) {
            let [x, y, z] = orientation.map(short);
            let flat = format!(
                "gravity bends its open section about the weak axis. If the web should stand upright, give `orientation` = [{x}, {y}, {z}]"
            );
            text.add_of("weak axis", BEAMS, &beam.name, flat);
        }
        if let Some(inside) = inside(beam, model) {
            text.add_of("stresses", BEAMS, &beam.name, inside);
        }
        let Some(yielding) = &beam.yielding else { continue };
        let (fibres, points) = (yielding.fibres(), yielding.points);
        let rule = if yielding.rule == IntegrationRule::Gauss { "Gauss" } else { "Lobatto" };
        let stress = if yielding.shear { "normal and shear stress" } else { "normal stress alone" };
        let merged = if merges_fibres(beam, system.plane) {
            "; fibres of equal strain merged, the motion being plane"
        } else {
            ""
        };
        let of = match yielding.groups.len() {
            1 => String::new(),
            materials => format!(" of {materials} kinds"),
        };
        let section =
            format!("{fibres} fibres{of} at {points} {rule} points per element, yielding under {stress}{merged}");
        text.add_of("yielding", BEAMS, &beam.name, section);
    }
}

/// The distance of the stresses of sections.csv from the ends of elements, and the remedy; `None` if some stand at the ends.
fn inside(beam: &Beam, model: &Model) -> Option<String> {
    let places = model.output.sections?;
    let (rule, points, remedy) = match &beam.yielding {
        Some(yielding) if places != SectionPlaces::Ends => {
            let remedy = match yielding.points {
                ..3 => "`integration = \"lobatto\"` with `order = 3` has points at the ends",
                _ => "`integration = \"lobatto\"` has points at the ends",
            };
            (yielding.rule, yielding.points, remedy)
        }
        None if places == SectionPlaces::Points => {
            (IntegrationRule::Gauss, beam.order, "`sections = { at = \"ends\" }` has those at the ends")
        }
        _ => return None,
    };
    let outermost = rule.points(points).0.iter().fold(0.0, |most: f64, at| most.max(at.abs()));
    let part = 50.0 * (1.0 - outermost);
    (part > 0.0).then(|| {
        let part = to_digits(part, 2);
        format!("at integration points, {part} % of an element from its ends: at a clamp they miss {part} % of their change over the element. {remedy}")
    })
}

/// The orientation that turns the strong axis of a horizontal beam against gravity, where its weak one is there and its section is open: flat bars
/// lie flat on purpose.
fn upright(beam: &Beam, model: &Model) -> Option<[f64; 3]> {
    let down = model.loading.gravity.try_normalize(0.0)?;
    let lies_flat = |element: &BeamElement| {
        let (M, along) = (&model.stiffnesses[element.section].M, element.frame.column(0));
        let bending = M.fixed_view::<2, 2>(1, 1).into_owned();
        let stiffnesses = bending.symmetric_eigenvalues();
        let (least, most) = (stiffnesses.min(), stiffnesses.max());
        let level = along.cross(&down);
        let about = Vector2::new(element.frame.column(1).dot(&level), element.frame.column(2).dot(&level));
        along.dot(&down).abs() < LEVEL
            && M[(0, 0)] < OPEN * least
            && most > STRONG * least
            && about.dot(&(bending * about)) < 2.0 * least
    };
    let first = beam.elements.first().filter(|_| beam.elements.iter().all(lies_flat))?;
    let along = first.frame.column(0).into_owned();
    let level = along.cross(&down);
    // The strong axis lies at this direction (cos, sin) from local y.
    let principal = model.stiffnesses[first.section].M.fixed_view::<2, 2>(1, 1).into_owned().symmetric_eigen();
    let strong = principal.eigenvectors.column(principal.eigenvalues.imax());
    let [cos, sin] = [strong[0].abs(), strong[1] * strong[0].signum()];
    let y = cos * level - sin * along.cross(&level);
    Some(std::array::from_fn(|i| if y[i].abs() < 1e-9 { 0.0 } else { y[i] }))
}
