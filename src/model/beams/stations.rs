//! `stations` of a beam: sections, twist and offset by place along it, for tapered beams and blades.

use super::station_file::FileStation;
use crate::data::{BeamElement, MassKind, SectionAt, VariedElement};
use crate::part_context::PartContext;
use crate::report::Owner;
use crate::values::keys;
use base::diagnostic::{At, Span};
use base::math::quadrature::{gauss, lobatto};
use base::math::{Mat3, Vec3};
use base::names::short;
use deck::beams as words;
use deck::words::Table;

/// The stations of a beam, rising from 0 to 1.
pub(super) struct Stations<'d>(Vec<Station<'d>>);

/// A station whose section is sound.
struct Station<'d> {
    at: f64,
    /// The name of its section in the deck; `None` of a file.
    name: Option<&'d At<String>>,
    /// Index of its stiffness.
    section: usize,
    twist: f64,
    offset: [f64; 2],
}

/// Reads the stations of a beam; `None` where it has none, or there are errors.
pub(super) fn stations<'d>(
    owner: &Owner<'d>,
    (index, beam): (usize, &'d words::Beam),
    setting: (MassKind, bool),
    cx: &mut PartContext<'_, 'd>,
) -> Option<Stations<'d>> {
    if beam.station_file.is_some() {
        let unused = keys!(beam; section, stations, material);
        cx.report.reject_unused("a beam with `station_file`", &unused);
        return of_file(index, setting.1, cx);
    }
    let table = beam.stations.as_ref()?;
    if let Some(section) = &beam.section {
        let message = format!("{} has `section` and `stations`", owner.what);
        return cx.report.error_with(&section.span, message, "remove it: each station names its own");
    }
    let mut all = Vec::new();
    let mut sound = Some(());
    for station in &table.value {
        match read(beam, station, setting, cx) {
            Some(station) => all.push(station),
            None => sound = None,
        }
    }
    sound?;
    check(&all, table, cx)?;
    note_keys(&all, cx);
    Some(Stations(all))
}

/// The stations of the file of a beam; `None` after errors, which reading it has reported.
fn of_file<'d>(index: usize, shear: bool, cx: &mut PartContext<'_, 'd>) -> Option<Stations<'d>> {
    let given = cx.station_files.get(index)?.as_ref()?;
    let station = |station: &FileStation| Station {
        at: station.at,
        name: None,
        section: cx.sections.add(&station.stiffness, shear),
        twist: station.twist,
        offset: [0.0; 2],
    };
    Some(Stations(given.list.iter().map(station).collect()))
}

fn read<'d>(
    beam: &'d words::Beam,
    station: &'d At<Table<words::Station>>,
    setting: (MassKind, bool),
    cx: &mut PartContext<'_, 'd>,
) -> Option<Station<'d>> {
    let owner = Owner::new("a station", &station.span);
    let at = cx.report.require(&owner, "at", &station.at);
    let section = cx.sections.beam_section(&owner, [&station.section, &beam.material], setting, cx.report);
    Some(Station {
        at: at?.value,
        name: Some(station.section.as_ref()?),
        section: section?,
        twist: station.twist.as_ref().map_or(0.0, |twist| twist.value),
        offset: station.offset.as_ref().map_or([0.0; 2], |offset| offset.value.0),
    })
}

/// Checks that stations rise from 0 to 1.
fn check<'d>(
    all: &[Station<'d>],
    table: &'d At<Vec<At<Table<words::Station>>>>,
    cx: &mut PartContext<'_, 'd>,
) -> Option<()> {
    let span = |index: usize| -> &'d Span {
        let station = &table.value[index];
        station.at.as_ref().map_or(&station.span, |at| &at.span)
    };
    let (Some(first), Some(last)) = (all.first(), all.last()) else {
        return cx.report.error_with(&table.span, "`stations` is empty", "give one at 0 and one at 1");
    };
    if let Some(index) = (1..all.len()).find(|&index| all[index].at <= all[index - 1].at) {
        let message = format!("station {} lies at {}, not beyond the one before", index + 1, short(all[index].at));
        let hint = "stations rise from 0 to 1; for a sudden change make two beams that share a point";
        return cx.report.error_with(span(index), message, hint);
    }
    for (index, station, at) in [(0, first, 0.0), (all.len() - 1, last, 1.0)] {
        if station.at != at {
            let which = if at == 0.0 { "first" } else { "last" };
            let message = format!("the {which} station lies at {}, not at {at:.1}", short(station.at));
            let hint = "`at` is a part of the length of the beam, from 0 at its start to 1 at its end";
            return cx.report.error_with(span(index), message, hint);
        }
    }
    Some(())
}

/// Notes sections of one shape whose keys differ: dimensions are then not linear between them.
fn note_keys<'d>(all: &[Station<'d>], cx: &mut PartContext<'_, 'd>) {
    for pair in all.windows(2) {
        let (Some(a), Some(b)) = (pair[0].name, pair[1].name) else { continue };
        if let Some(key) = cx.sections.differing_key([a, b]) {
            let message = format!(
                "stiffness and mass are linear between sections `{}` and `{}`, not dimensions: `{key}` differs",
                a.value, b.value
            );
            let hint = "give both the same keys with as many numbers; without, no stresses are written between them";
            cx.report.note(&b.span, message, hint);
        }
    }
}

impl<'d> Stations<'d> {
    /// The index of the stiffness of the first.
    pub fn first(&self) -> Option<usize> {
        self.0.first().map(|station| station.section)
    }

    /// Gives elements, which follow each other, their sections.
    pub fn lay(
        &self,
        elements: &mut [BeamElement],
        beam: &'d words::Beam,
        (order, shear): (usize, bool),
        cx: &mut PartContext<'_, 'd>,
    ) -> Option<()> {
        if let Some(k) = (1..elements.len()).find(|&k| elements[k - 1].nodes[order] != elements[k].nodes[0]) {
            let file = beam.station_file.as_ref().map(|file| &file.span);
            let place = beam.stations.as_ref().map(|stations| &stations.span).or(file)?;
            let message = format!(
                "`stations` follow a line, and segment {} of the group does not begin where segment {k} ends",
                k + 1
            );
            return cx.report.error_with(place, message, "order the segments in the mesh, or make a beam of each line");
        }
        let lengths = elements.iter().map(|e| (cx.nodes.x(e.nodes[order]) - cx.nodes.x(e.nodes[0])).norm());
        let lengths: Vec<f64> = lengths.collect();
        let whole: f64 = lengths.iter().sum();
        let (mut start, mut last) = (0.0, None);
        for (element, length) in elements.iter_mut().zip(&lengths) {
            let mut at = |xi: &f64| {
                let s = ((start + 0.5 * (1.0 + xi) * length) / whole).min(1.0);
                // The end of an element is the start of the next.
                match last.filter(|(place, frame, _)| *place == s && *frame == element.frame) {
                    Some((.., known)) => known,
                    None => {
                        let made = self.at(s, &element.frame, (beam, shear), cx);
                        last = Some((s, element.frame, made));
                        made
                    }
                }
            };
            let (inner, points) = (lobatto(order + 1).0, gauss(order).0);
            let mut nodes = [at(&inner[0]); 5];
            (1..order).for_each(|k| nodes[k] = at(&inner[k]));
            let mut at_points = [nodes[0]; 4];
            (0..order).for_each(|g| at_points[g] = at(&points[g]));
            nodes[order] = at(&inner[order]);
            element.section = at_points[order / 2].section;
            let plain = SectionAt { section: element.section, frame: element.frame };
            if nodes[..=order].iter().chain(&at_points[..order]).any(|place| *place != plain) {
                element.varied = Some(Box::new(VariedElement { nodes, points: at_points }));
            }
            start += length;
        }
        Some(())
    }

    /// The section at this part of the length, where the columns of `frame` are the axes by the orientation.
    fn at(
        &self,
        s: f64,
        frame: &Mat3,
        (beam, shear): (&'d words::Beam, bool),
        cx: &mut PartContext<'_, 'd>,
    ) -> SectionAt {
        let next = self.0.partition_point(|station| station.at <= s).clamp(1, self.0.len() - 1);
        let (a, b) = (&self.0[next - 1], &self.0[next]);
        let part = (s - a.at) / (b.at - a.at);
        let between = |a: f64, b: f64| a + part * (b - a);
        let twist = between(a.twist, b.twist);
        let [y, z]: [f64; 2] = std::array::from_fn(|k| between(a.offset[k], b.offset[k]));
        let (sin, cos) = twist.sin_cos();
        let turn = Mat3::from_columns(&[Vec3::x(), Vec3::new(0.0, cos, sin), Vec3::new(0.0, -sin, cos)]);
        let frame = if twist == 0.0 { *frame } else { frame * turn };
        // Along the axes of the section, which are twisted.
        let place = if twist == 0.0 { [y, z] } else { [cos * y + sin * z, cos * z - sin * y] };
        let section = if a.section == b.section && place == [0.0; 2] {
            a.section
        } else {
            let ends = [(a.name, a.section), (b.name, b.section)];
            cx.sections.between(ends, &beam.material, (part, place, shear), cx.report)
        };
        SectionAt { section, frame }
    }
}
