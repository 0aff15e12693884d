//! sections.csv: stress resultants of the beams at their integration points, section axes.

use crate::extent::Rows;
use crate::table::{Answers, TableKind, WriteRow};
use base::quantities::{Column, PLASTIC_STRAIN, SECTION_FORCES, SECTION_STRESSES, Unit, names};
use model::{Beam, ExpectAt, PartKind, SectionPlaces};
use solve::{Frame, SectionPlace, SectionPoint, Wanted};
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "sections.csv",
    about: "One row for each integration point of each beam element. The part of the beam at larger `s` exerts these forces and moments \
            on the part before the point. Moments are about the centroid. With { at = \"ends\" } there is one row for each end of each \
            element, in equilibrium with the forces at the nodes. With { at = \"both\" } the table has both kinds of rows. Stresses are \
            those of the elastic section under the resultants, at its extreme points: corners, faces of walls, middles of sides, the edge \
            of a tube. If the material yields, they are those of the fibres, at integration points alone: `integration = \"lobatto\"` \
            of the beam puts some at the ends. The von Mises stress then has \
            no shear stress unless the yield condition contains it. In concrete `plastic_strain` is the larger of the plastic strain of \
            crushing and the accumulated plastic strain of the bars. Sections of shape \"general\" have none. Written with `[output] \
            sections` if there are beams.",
    columns: &[
        &[
            Column::key("beam", "name of the beam"),
            Column::key("element", "number of the element along the beam, from 0"),
            Column::key(
                "point",
                "number of the integration point in the element, from 0; `start` and `end` for its ends",
            ),
            Column::scalar("s", "distance from the start of the beam, in the initial state", Unit::Length),
        ],
        &SECTION_FORCES,
        &[PLASTIC_STRAIN],
        &SECTION_STRESSES,
    ],
    wanted: |model| model.output.sections.is_some() && model.has(PartKind::Beam),
    needs: Wanted::SECTIONS,
    has_last: |_| true,
    every_step: false,
    extent: |extent| {
        let beams = || extent.model.each::<Beam>();
        let places = |beam: &Beam| match extent.model.output.sections.unwrap_or(SectionPlaces::Points) {
            SectionPlaces::Points => beam.order,
            SectionPlaces::Ends => 2,
            SectionPlaces::Both => beam.order + 2,
        };
        let points = |beam: &Beam| beam.elements.len() * places(beam);
        let names = beams().flat_map(|beam| std::iter::repeat_n(beam.name.as_str(), points(beam)));
        let forces: usize = extent.components().iter().sum();
        let numbers =
            |beam: &Beam| points(beam) * (forces + SECTION_STRESSES.len() + usize::from(beam.yielding.is_some()));
        Rows::named(names, beams().map(numbers).sum())
    },
    rows: |_| Box::new(write),
    answers: Some(Answers { quantities, needs: Wanted::SECTIONS, value }),
};

fn quantities(at: ExpectAt) -> Vec<&'static str> {
    match at {
        ExpectAt::Sections(_) => names(&[&SECTION_FORCES, &SECTION_STRESSES]),
        _ => Vec::new(),
    }
}

/// Of a force the value of the largest magnitude over the beam, at ends of elements and at points between, with its sign; of a stress the
/// largest, of `sigma_min` the smallest.
fn value(at: ExpectAt, index: usize, frame: &Frame) -> Option<f64> {
    let ExpectAt::Sections(part) = at else { return None };
    let points = frame.derived.sections.iter().filter(|point| point.part == part);
    if let Some(stress) = index.checked_sub(SECTION_FORCES.len()) {
        let least = SECTION_STRESSES[stress].name == "sigma_min";
        let stresses = points.filter_map(|point| Some(point.at.stresses?.values[stress]));
        return stresses.reduce(|a, b| if least { a.min(b) } else { a.max(b) });
    }
    points.map(|point| point.at.forces[index]).reduce(|most, force| if force.abs() > most.abs() { force } else { most })
}

fn write(table: &mut dyn WriteRow, frame: &Frame) -> io::Result<()> {
    let Some(places) = frame.model.output.sections else { return Ok(()) };
    let is_listed = |point: &&SectionPoint| match point.place {
        SectionPlace::Point(_) => places != SectionPlaces::Ends,
        SectionPlace::Start | SectionPlace::End => places != SectionPlaces::Points,
    };
    frame.derived.sections.iter().filter(is_listed).try_for_each(|point| {
        let at = &point.at;
        table.row(frame.step, frame.state.time).text(frame.model.parts[point.part].name());
        table.count(point.element);
        match point.place {
            SectionPlace::Start => table.text("start"),
            SectionPlace::Point(number) => table.count(number),
            SectionPlace::End => table.text("end"),
        };
        table.number(at.s).numbers(&at.forces);
        // Strains are those of integration points alone.
        match point.place {
            SectionPlace::Point(_) => table.number(at.plastic_strain),
            SectionPlace::Start | SectionPlace::End => table.text(""),
        };
        match &at.stresses {
            Some(stresses) => table.numbers(&stresses.values),
            None => table.text("").text("").text("").text(""),
        };
        table.end()
    })
}
