//! sections.csv: stress resultants of the beams at their integration points, section axes.

use crate::model::{Beam, PartKind};
use crate::output::extent::Rows;
use crate::output::table::{TableKind, WriteRow};
use crate::quantities::{Axes, Column, PLASTIC_STRAIN, Unit};
use crate::solve::{Frame, Wanted};
use std::io;

const fn force(name: &'static str, meaning: &'static str, sign: &'static str) -> Column {
    Column::scalar(name, meaning, Unit::Force).kind("section force").in_axes(Axes::Section).positive(sign)
}

const fn moment(name: &'static str, meaning: &'static str, sign: &'static str) -> Column {
    Column::scalar(name, meaning, Unit::Moment).kind("section moment").in_axes(Axes::Section).positive(sign)
}

pub static TABLE: TableKind = TableKind {
    file: "sections.csv",
    about: "One row for each integration point of each beam element. Forces and moments are those that the part of the beam \
            beyond the point, on the side of larger `s`, exerts on the part before it; moments are about the centroid. \
            Written if `[output] sections = true` and there are beams.",
    columns: &[&[
        Column::key("beam", "name of the beam"),
        Column::key("element", "number of the element along the beam, from 0"),
        Column::key("point", "number of the integration point in the element, from 0"),
        Column::scalar("s", "distance from the start of the beam, in the initial state", Unit::Length),
        force("N", "normal force", "tension"),
        force("Vy", "shear force along y", "along +y").formerly("Qy"),
        force("Vz", "shear force along z", "along +z").formerly("Qz"),
        moment("T", "torsional moment", "right-handed about the beam axis"),
        moment("My", "bending moment about y", "tension on the side of +z"),
        moment("Mz", "bending moment about z", "tension on the side of −y"),
        PLASTIC_STRAIN,
    ]],
    wanted: |model| model.output.sections && model.has(PartKind::Beam),
    needs: Wanted::SECTIONS,
    every_step: false,
    extent: |extent| {
        let beams = || extent.model.each::<Beam>();
        let points = |beam: &Beam| beam.elements.len() * beam.order;
        let names = beams().flat_map(|beam| std::iter::repeat_n(beam.name.as_str(), points(beam)));
        let forces: usize = extent.components().iter().sum();
        let numbers = |beam: &Beam| points(beam) * (forces + usize::from(beam.yielding.is_some()));
        Rows::named(names, beams().map(numbers).sum())
    },
    rows: |_| Box::new(write),
    answers: None,
};

fn write(table: &mut dyn WriteRow, frame: &Frame) -> io::Result<()> {
    frame.derived.sections.iter().try_for_each(|point| {
        let at = &point.at;
        table.row(frame.step, frame.state.time).text(frame.model.parts[point.part].name());
        table.count(point.element).count(point.point).number(at.s).numbers(&at.forces).number(at.plastic_strain).end()
    })
}
