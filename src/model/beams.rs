//! `[[beams]]` and `[[bars]]`: paths → nodes and elements.

use super::build::{Builder, Owner, chosen, span, vec3};
use super::{AnalysisKind, Bar, Beam, BeamElement, MassKind};
use crate::deck::beams as deck;
use crate::deck::words::{Maybe, OneOrMany, Vector};
use crate::diagnostic::At;
use crate::elements::beam::{DEFAULT_ORDER, IntegrationRule, MOST_POINTS, Yielding};
use crate::math::quadrature::lobatto;
use crate::math::{Mat3, Vec3};

/// More elements in a segment are a slip of the keyboard, and would only exhaust memory.
const MOST_ELEMENTS: u64 = 1_000_000;
/// Sine of the angle between orientation and axis below which they count as parallel.
const PARALLEL: f64 = 1e-6;

impl<'d> Builder<'d> {
    pub fn beams(&mut self) {
        for (index, beam) in self.deck.beams.iter().enumerate() {
            let name = beam.name.as_ref().or(beam.group.as_ref());
            let name = name.map_or_else(|| format!("beams.{index}"), |name| name.value.clone());
            let owner = Owner { what: format!("beam `{name}`"), span: &beam.span };
            if beam.group.is_none() {
                self.need(&owner, "name", &beam.name);
            }
            self.beam_nodes.push(Vec::new());
            let before = self.model.parts.len();
            self.beam(index, name, &owner, beam);
            self.beam_parts.push(before..self.model.parts.len());
        }
    }

    /// Goes as far as it can, so that all errors of the beam are found; `None` means there were some.
    fn beam(&mut self, index: usize, name: String, owner: &Owner<'d>, beam: &'d deck::Beam) -> Option<()> {
        let order = self.count("order", &beam.order, DEFAULT_ORDER);
        if let Some(at) = &beam.order
            && order > 4
        {
            self.error::<()>(&at.span, "`order` can be 1, 2, 3 or 4");
        }
        let mass = chosen(&beam.mass);
        let section = self.beam_section(owner, beam, mass);
        let yielding = self.yielding(owner, beam, order, section.is_some());
        let orientation = self.need(owner, "orientation", &beam.orientation);
        let rotary_inertia = beam.rotary_inertia.as_ref().is_none_or(|keep| keep.value);
        if let Some(group) = &beam.group {
            let strays = [
                ("path", span(&beam.path)),
                ("elements", span(&beam.elements)),
                ("offset_start", span(&beam.offset_start)),
                ("offset_end", span(&beam.offset_end)),
            ];
            self.stray("a beam made of a group of the mesh", &strays);
            let toward = orientation.and_then(|orientation| self.unit("orientation", orientation));
            let (inner, _) = lobatto(order.min(4) + 1);
            // Without an orientation, which has been said, the group is still read.
            let some = |along: &Vec3| frame(along, &Vec3::ith(along.iamin(), 1.0));
            let of = |along: Vec3| toward.map_or_else(|| some(&along), |toward| frame(&along, &toward));
            let made = self.meshed_beam((index, &name), owner, group, inner, of);
            let (section, yielding, mut elements) = (section?, yielding?, made?);
            toward?;
            if order > 4 {
                return None;
            }
            elements.iter_mut().for_each(|element| element.section = section);
            self.model.add(Beam { name, order, mass, rotary_inertia, yielding, elements });
            return Some(());
        }
        if self.is_spoiled(owner.span, "group") {
            return None;
        }
        let elements = self.need(owner, "elements", &beam.elements);
        let mut path = self.path(owner, &beam.path, true)?;
        let ends = [(0, "offset_start", &beam.offset_start), (path.len() - 1, "offset_end", &beam.offset_end)];
        for (at, key, offset) in ends {
            if let Some(offset) = offset
                && offset.value.0 != [0.0; 3]
            {
                let x = self.x(path[at]) + vec3(offset);
                let label = format!("{name}.{}", key.trim_start_matches("offset_"));
                path[at] = self.rider(label, x, path[at], &offset.span);
                self.touch(path[at], true);
            }
        }
        let points = &beam.path.as_ref()?.values;
        let lengths = self.segments(owner, points, &path);
        let frames = orientation.and_then(|orientation| self.frames(points, &path, orientation));
        let counts = elements.and_then(|elements| self.counts(elements, path.len() - 1))?;
        lengths?;
        let (section, yielding, frames) = (section?, yielding?, frames?);
        if order > 4 {
            return None;
        }

        let (inner, _) = lobatto(order + 1);
        let mut nodes = vec![path[0]];
        let mut made = Vec::new();
        for (segment, &count) in counts.iter().enumerate() {
            let [start, end] = [path[segment], path[segment + 1]];
            let [x0, x1] = [self.x(start), self.x(end)];
            for element in 0..count {
                let mut ids = [*nodes.last()?; 5];
                for (i, xi) in inner.iter().enumerate().skip(1) {
                    let last = element + 1 == count && i == order;
                    let s = (element as f64 + 0.5 * (1.0 + xi)) / count as f64;
                    ids[i] = if last {
                        end
                    } else {
                        let node = self.node(format!("{name}[{}]", nodes.len()), false, x0 + (x1 - x0) * s);
                        self.touch(node, true);
                        node
                    };
                    nodes.push(ids[i]);
                }
                made.push(BeamElement { nodes: ids, frame: frames[segment], section });
            }
        }
        self.beam_nodes[index] = nodes;
        self.model.add(Beam { name, order, mass, rotary_inertia, yielding, elements: made });
        Some(())
    }

    /// How the beam yields, `Some(None)` where its material is elastic. `section`: its section is sound.
    fn yielding(
        &mut self,
        owner: &Owner<'d>,
        beam: &'d deck::Beam,
        order: usize,
        section: bool,
    ) -> Option<Option<Yielding>> {
        let strays = [
            ("integration", span(&beam.integration)),
            ("points", span(&beam.points)),
            ("shear_yields", span(&beam.shear_yields)),
        ];
        let Some(law) = self.yielding_of(&beam.material)? else {
            self.stray(&format!("{}, whose material is elastic", owner.what), &strays);
            return Some(None);
        };
        let points = self.count("points", &beam.points, order);
        if let Some(at) = &beam.points
            && order == 1
            && points > 1
        {
            let message = "elements of order 1 take one point: with more they lock in shear";
            return self.error_with(&at.span, message, "take a higher `order`");
        }
        if let Some(at) = &beam.points
            && !(order..=MOST_POINTS).contains(&points)
        {
            let message = format!("`points` must lie between the order of the elements, {order}, and {MOST_POINTS}");
            return self.error(&at.span, message);
        }
        let rule = match &beam.integration {
            Some(at) if at.value == IntegrationRule::Lobatto && points < 3 => {
                let message = "a Lobatto rule needs three points";
                return self.error_with(&at.span, message, "take elements of order 3 or 4");
            }
            rule => chosen(rule),
        };
        let shear = beam.shear_yields.as_ref().is_none_or(|yields| yields.value);
        // Where the section is wrong, that has been said.
        let fibres = if section { self.fibres(beam)? } else { return None };
        Some(Some(Yielding { law, fibres, shear, rule, points }))
    }

    /// Nodes of a path of two or more points; a beam also acts on their rotations.
    fn path(&mut self, owner: &Owner<'d>, path: &'d Maybe<OneOrMany<String>>, rotations: bool) -> Option<Vec<usize>> {
        let path = self.need(owner, "path", path)?;
        if path.values.len() < 2 {
            self.unsure = true;
            self.error_with::<()>(&path.span, "a path needs two points or more", "such as [\"foot\", \"knee\"]");
        }
        let nodes: Vec<Option<usize>> = path.values.iter().map(|point| self.point("path", point)).collect();
        // What meets at these points is known even if the rest has errors.
        nodes.iter().flatten().for_each(|&node| self.touch(node, rotations));
        nodes.into_iter().collect::<Option<Vec<usize>>>().filter(|nodes| nodes.len() >= 2)
    }

    /// Reports segments without length.
    fn segments(&mut self, owner: &Owner<'d>, points: &'d [At<String>], path: &[usize]) -> Option<()> {
        let mut sound = Some(());
        for (i, pair) in path.windows(2).enumerate() {
            let [x0, x1] = [self.x(pair[0]), self.x(pair[1])];
            // Below this the ends agree to round-off of their coordinates.
            if (x1 - x0).norm() <= 1e-12 * x0.amax().max(x1.amax()) {
                let [from, to] = [&points[i], &points[i + 1]];
                let message = format!("{}: segment `{}` - `{}` has no length", owner.what, from.value, to.value);
                sound = self.error_with(&to.span, message, "its ends lie at the same place");
            }
        }
        sound
    }

    /// Section frame of each segment: x along it, y towards the orientation, z = x × y.
    fn frames(&mut self, points: &'d [At<String>], path: &[usize], orientation: &At<Vector>) -> Option<Vec<Mat3>> {
        let toward = self.unit("orientation", orientation)?;
        let mut frames = Vec::new();
        for (i, pair) in path.windows(2).enumerate() {
            let along = self.x(pair[1]) - self.x(pair[0]);
            if along.try_normalize(0.0).is_none() {
                continue;
            }
            let Some(frame) = frame(&along, &toward) else {
                let message =
                    format!("`orientation` is parallel to segment `{}` - `{}`", points[i].value, points[i + 1].value);
                let hint = "it must point to the side, where local y is to lie";
                self.error_with::<()>(&orientation.span, message, hint);
                continue;
            };
            frames.push(frame);
        }
        (frames.len() + 1 == path.len()).then_some(frames)
    }

    /// Elements of each segment.
    fn counts(&mut self, elements: &At<OneOrMany<u64>>, segments: usize) -> Option<Vec<usize>> {
        let mut sound = true;
        for count in &elements.values {
            if count.value == 0 || count.value > MOST_ELEMENTS {
                let message = format!("`elements` must lie between 1 and {MOST_ELEMENTS}");
                self.error::<()>(&count.span, message);
                sound = false;
            }
        }
        if !elements.single && elements.values.len() != segments {
            let message = format!("`elements` has {} numbers and the path {segments} segments", elements.values.len());
            return self.error_with(&elements.span, message, "one for each, or one without brackets for all");
        }
        let count = |segment: usize| elements.values[if elements.single { 0 } else { segment }].value as usize;
        if !sound {
            return None;
        }
        self.made((0..segments).map(count).sum(), &elements.span)?;
        Some((0..segments).map(count).collect())
    }

    pub fn bars(&mut self) {
        for (index, bar) in self.deck.bars.iter().enumerate() {
            let name = bar.name.as_ref().map_or_else(|| format!("bars.{index}"), |name| name.value.clone());
            let owner = Owner { what: format!("bar `{name}`"), span: &bar.span };
            self.need(&owner, "name", &bar.name);
            self.bar_nodes.push(Vec::new());
            let before = self.model.parts.len();
            self.bar(index, name, &owner, bar);
            self.bar_parts.push(before..self.model.parts.len());
        }
    }

    fn bar(&mut self, index: usize, name: String, owner: &Owner<'d>, bar: &'d deck::Bar) -> Option<()> {
        let mass = chosen(&bar.mass);
        let stiffness = self.bar_stiffness(owner, bar, mass);
        let path = self.path(owner, &bar.path, false)?;
        let lengths = self.segments(owner, &bar.path.as_ref()?.values, &path);
        let counts = match &bar.elements {
            Some(elements) => self.counts(elements, path.len() - 1),
            None if self.is_spoiled(owner.span, "elements") => None,
            None => Some(vec![1; path.len() - 1]),
        };
        let (counts, (axial_stiffness, mass_per_length)) = (counts?, stiffness?);
        lengths?;
        let whole: f64 = path.windows(2).map(|pair| (self.x(pair[1]) - self.x(pair[0])).norm()).sum();
        let free = self.positive("free_length", &bar.free_length).map_or(1.0, |free| free / whole);
        let mut nodes = vec![path[0]];
        for (segment, &count) in counts.iter().enumerate() {
            let [x0, x1] = [self.x(path[segment]), self.x(path[segment + 1])];
            for i in 1..count {
                let x = x0 + (x1 - x0) * (i as f64 / count as f64);
                let node = self.node(format!("{name}[{}]", nodes.len()), false, x);
                self.touch(node, false);
                nodes.push(node);
            }
            nodes.push(path[segment + 1]);
        }
        let elements = nodes.windows(2).map(|pair| [pair[0], pair[1]]).collect();
        self.bar_nodes[index] = nodes;
        let tension_only = bar.tension_only.as_ref().is_some_and(|only| only.value);
        let yielding = self.yielding_of(&bar.material)?;
        self.model.add(Bar { name, axial_stiffness, mass_per_length, mass, tension_only, free, yielding, elements });
        Some(())
    }

    /// E A and mass per length.
    fn bar_stiffness(&mut self, owner: &Owner<'d>, bar: &'d deck::Bar, mass: MassKind) -> Option<(f64, f64)> {
        if bar.axial_stiffness.is_some() {
            let strays = [("material", span(&bar.material)), ("area", span(&bar.area))];
            self.stray("a bar with `axial_stiffness`", &strays);
            let stiffness = self.positive("axial_stiffness", &bar.axial_stiffness);
            if self.needs_mass(mass) {
                self.need(owner, "mass_per_length", &bar.mass_per_length)?;
            }
            return Some((stiffness?, self.not_negative("mass_per_length", &bar.mass_per_length, 0.0)));
        }
        if self.is_spoiled(owner.span, "axial_stiffness") {
            return None;
        }
        self.stray("a bar with `material`", &[("mass_per_length", span(&bar.mass_per_length))]);
        if bar.material.is_none() && bar.area.is_none() && !self.is_spoiled(owner.span, "material") {
            let message = format!("{} needs `material` and `area`, or `axial_stiffness`", owner.what);
            return self.error(owner.span, message);
        }
        let material = self.need(owner, "material", &bar.material);
        let area = self.need_positive(owner, "area", &bar.area);
        let name = material?;
        let (_, material) = self.find("material", &self.deck.materials, name)?;
        let density = self.density(name, material, mass, &owner.what)?;
        let modulus = material.youngs_modulus.as_ref()?.value;
        Some((modulus * area?, density * area?))
    }

    /// Whether a deformable part must have a mass: in dynamics, and where gravity pulls or the ground accelerates.
    pub fn needs_mass(&self, mass: MassKind) -> bool {
        let pulled = self
            .deck
            .environment
            .as_ref()
            .is_some_and(|environment| environment.gravity.is_some() || !environment.base_acceleration.is_empty());
        mass != MassKind::None && (self.model.analysis.kind == AnalysisKind::Dynamic || pulled)
    }
}

/// Section axes: x along a segment, y towards the orientation, z = x × y. `None` where the two are parallel.
fn frame(along: &Vec3, toward: &Vec3) -> Option<Mat3> {
    let x = along.try_normalize(0.0)?;
    let z = x.cross(toward).try_normalize(PARALLEL)?;
    Some(Mat3::from_columns(&[x, z.cross(&x), z]))
}
