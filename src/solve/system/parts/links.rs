//! Links in the equation of motion: their blocks, and their forces for output.

use super::assembled::{Assembled, NumberedBlock, Setting};
use super::coordinate_springs::{CoordinateSpring, CoordinateSprings};
use crate::system::group::Group;
use crate::system::plane::MotionPlane;
use base::math::{Mat3, Vec3, angular, linear};
use mechanics::elements::bearing::{Bearing, Bearings};
use mechanics::elements::bushing::{Bushing, Bushings};
use mechanics::elements::coordinate_law::CoordinateLaw;
use mechanics::elements::hysteretic_link::{HystereticLink, HystereticLinks};
use mechanics::elements::isolator::{self, Isolator, IsolatorLaw, Isolators};
use mechanics::elements::link::{self, Links};
use mechanics::elements::link_failure;
use mechanics::elements::relative_rotation::RotationalSpring;
use mechanics::sections::Stiffness;
use mechanics::state::{Configuration, Node};
use model::{Link, LinkKind, Model, PartKind};

/// The state of a link at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinkState {
    /// Elongation, relative displacement along the first axis of a bushing, or coordinate of a joint.
    pub elongation: f64,
    /// Rate of the elongation.
    pub rate: f64,
    /// Axial force, positive in tension; of a joint, the effort that pulls its second end back.
    pub force: f64,
    /// Force that the link exerts on its first end, global components; the second end pulls on it.
    pub f: Vec3,
    /// Moment that the link exerts on its first end, global components.
    pub m: Vec3,
    /// True where it has failed.
    pub failed: bool,
}

/// A link as the deck lists it; the blocks that integrate links hold copies.
pub enum LinkElement {
    /// A spring or damper along a line.
    Line(link::Link),
    /// A spring along a line that remembers.
    Hysteretic(HystereticLink),
    /// A bushing.
    Bushing(Bushing),
    /// A bearing.
    Bearing(Bearing),
    /// A seismic isolator.
    Isolator(Isolator),
    /// The laws along the coordinate of a joint.
    Joint(CoordinateSpring),
}

impl Assembled for Link {
    /// The first link creates the blocks of all links, which share one block for each kind.
    fn blocks(&self, setting: &Setting) -> Vec<NumberedBlock> {
        if !setting.model.each::<Link>().next().is_some_and(|first| std::ptr::eq(first, self)) {
            return Vec::new();
        }
        let (mut lines, mut taken_up, mut bushings, mut joints) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let (mut bearings, mut hysteretic, mut isolators) = (Vec::new(), Vec::new(), Vec::new());
        for element in elements(setting.model, setting.x) {
            match element {
                LinkElement::Line(line) if line.is_taken_up() => taken_up.push(line),
                LinkElement::Line(line) => lines.push(line),
                LinkElement::Bushing(bushing) => bushings.push(bushing),
                LinkElement::Bearing(bearing) => bearings.push(bearing),
                LinkElement::Hysteretic(link) => hysteretic.push(link),
                LinkElement::Isolator(isolator) => isolators.push(isolator),
                LinkElement::Joint(spring) => joints.push(spring),
            }
        }
        // Links of joints come after the links of the deck, and so does their history.
        vec![
            (Box::new(Links::new(lines)), 0),
            (Box::new(Links::new(taken_up)), 0),
            (Box::new(Bushings::new(bushings)), 0),
            (Box::new(CoordinateSprings::new(joints)), 0),
            (Box::new(Bearings::new(bearings)), 0),
            (Box::new(HystereticLinks::new(hysteretic)), 0),
            (Box::new(Isolators::new(isolators)), 0),
        ]
    }

    fn stays_in(&self, plane: &MotionPlane, _: &[Stiffness]) -> bool {
        match &self.kind {
            LinkKind::Line { direction, .. } | LinkKind::Hysteretic { direction, .. } => {
                direction.is_none_or(|d| plane.contains(&d))
            }
            LinkKind::Bushing { stiffness, damping, axes } => [stiffness, damping].into_iter().all(|k| {
                let turn = |k: &[f64]| axes * Mat3::from_diagonal(&Vec3::new(k[0], k[1], k[2])) * axes.transpose();
                plane.decouples(&turn(&k[..3])) && plane.decouples(&turn(&k[3..]))
            }),
            // Across the shaft, or not at all.
            LinkKind::Bearing { .. } => false,
            // Alike in all directions across its first axis. A slider that moves in the plane rises out of a dish that lies in it.
            LinkKind::Isolator { axes, law, .. } => {
                let rises =
                    matches!(law, IsolatorLaw::Pendulum { .. }) && !plane.contains(&axes.column(0).into_owned());
                !rises && plane.decouples(&(axes.column(0) * axes.column(0).transpose()))
            }
            LinkKind::Joint { lock, law } => {
                *law == CoordinateLaw::FREE || lock.in_plane(plane.normal, &Vec3::zeros()) == Some(true)
            }
        }
    }
}

/// All links one by one, in deck order.
pub fn elements(model: &Model, x: &[Vec3]) -> Vec<LinkElement> {
    let drive = |spring: usize| {
        let coordinates = model.constraints.joints.iter().filter_map(|joint| joint.coordinate.as_ref());
        let drive = coordinates.filter(|coordinate| coordinate.spring == Some(spring)).find_map(|of| of.drive)?;
        Some(drive.at(x))
    };
    let beta = |part: &Link| model.damping.beta(&part.own_damping);
    let element = |(index, part): (usize, &Link)| match &part.kind {
        LinkKind::Line { law, damper, direction, free_length } => {
            let start = part.ends.map(|node| x[node]);
            let line = link::Link::new(part.ends, law.clone(), *damper, *direction, *free_length, start);
            LinkElement::Line(line.damped_by(beta(part)).failing(part.failure).taken_up(part.take_up))
        }
        LinkKind::Hysteretic { law, damper, direction, free_length } => {
            let start = part.ends.map(|node| x[node]);
            let none = link::LinkLaw::Linear { stiffness: 0.0, preload: 0.0 };
            let link = link::Link::new(part.ends, none, *damper, *direction, *free_length, start);
            LinkElement::Hysteretic(HystereticLink { link, law: *law, beside: beta(part) * law.stiffness() })
        }
        LinkKind::Bushing { stiffness, damping, axes } => LinkElement::Bushing(Bushing {
            nodes: part.ends,
            axes: *axes,
            stiffness: Vec3::from_column_slice(&stiffness[..3]),
            spring: RotationalSpring::new(Vec3::from_column_slice(&stiffness[3..])),
            damping: std::array::from_fn(|i| damping[i] + beta(part) * stiffness[i]),
            offset: axes.tr_mul(&(x[part.ends[1]] - x[part.ends[0]])),
            failure: part.failure,
        }),
        LinkKind::Bearing { matrices, axes } => LinkElement::Bearing(Bearing {
            nodes: part.ends,
            axes: *axes,
            offset: axes.tr_mul(&(x[part.ends[1]] - x[part.ends[0]])),
            matrices: matrices.clone(),
        }),
        LinkKind::Isolator { law, stiffness, axial_stiffness, axes } => LinkElement::Isolator(Isolator {
            nodes: part.ends,
            axes: *axes,
            offset: axes.tr_mul(&(x[part.ends[1]] - x[part.ends[0]])),
            law: *law,
            stiffness: *stiffness,
            axial_stiffness: *axial_stiffness,
            beta: beta(part),
        }),
        LinkKind::Joint { lock, law } => {
            let law = law.damped_by(beta(part));
            LinkElement::Joint(CoordinateSpring { nodes: part.ends, lock: *lock, law, drive: drive(index) })
        }
    };
    model.each::<Link>().enumerate().map(element).collect()
}

/// The bushing, by its place among the links, whose ends have turned over against each other between `start` and `end`:
/// its moments are no longer defined there.
pub fn turned_over(links: &[LinkElement], start: &[Node], end: &[Node]) -> Option<usize> {
    let turned = |link: &LinkElement| match link {
        LinkElement::Bushing(bushing) => bushing.is_turned_over(start, end),
        LinkElement::Bearing(bearing) => bearing.is_turned_over(end),
        LinkElement::Line(_) | LinkElement::Hysteretic(_) | LinkElement::Isolator(_) | LinkElement::Joint(_) => false,
    };
    links.iter().position(turned)
}

/// The bushing, by its place among the links, whose relative rotation in a step of length `dt` from `start` to `end` is ambiguous by a full
/// turn.
pub fn turns_too_far(links: &[LinkElement], start: &[Node], end: &[Node], dt: f64) -> Option<usize> {
    let turns =
        |link: &LinkElement| matches!(link, LinkElement::Bushing(bushing) if bushing.turns_too_far(start, end, dt));
    links.iter().position(turns)
}

/// True for a group that elements of several parts share.
pub fn is_shared(group: &Group) -> bool {
    group.kind == PartKind::Link
}

/// A link that remembers something.
pub struct RememberingLink {
    /// The name of the link, or of the joint along which it acts.
    pub name: String,
    /// The places of its history variables.
    pub slots: Vec<usize>,
    /// True for a link along the coordinate of a joint.
    pub is_joint: bool,
}

/// The links that remember something, such as full turns. `links` and `groups` are those of the whole system.
pub fn remembering_links(model: &Model, links: &[LinkElement], groups: &[Group]) -> Vec<RememberingLink> {
    let all: Vec<usize> =
        groups.iter().filter(|group| is_shared(group)).flat_map(|group| group.history.clone()).collect();
    let mut next = Slots::before_kinds(links);
    let mut found = Vec::new();
    for (link, element) in model.each::<Link>().zip(links) {
        let slots = all[next.of(element)].to_vec();
        if !slots.is_empty() {
            let is_joint = matches!(element, LinkElement::Joint(_));
            found.push(RememberingLink { name: link.name.clone(), slots, is_joint });
        }
    }
    found
}

impl LinkElement {
    /// The number of its history variables.
    fn memory(&self) -> usize {
        match self {
            LinkElement::Line(line) => line.memory(),
            LinkElement::Bushing(bushing) => bushing.memory(),
            LinkElement::Bearing(_) => 0,
            LinkElement::Hysteretic(of) => of.law.memory(),
            LinkElement::Isolator(_) => isolator::MEMORY,
            LinkElement::Joint(spring) => spring.law.memory(),
        }
    }

    /// The place of its block among the blocks of links.
    fn kind(&self) -> usize {
        match self {
            LinkElement::Line(line) => usize::from(line.is_taken_up()),
            LinkElement::Bushing(_) => 2,
            LinkElement::Joint(_) => 3,
            LinkElement::Bearing(_) => 4,
            LinkElement::Hysteretic(_) => 5,
            LinkElement::Isolator(_) => 6,
        }
    }
}

/// The next history variables of each kind of link, among all links: first lines, then pretensioned lines, then bushings, joints,
/// bearings, lines that remember and isolators.
struct Slots([usize; 7]);

impl Slots {
    fn before_kinds(links: &[LinkElement]) -> Slots {
        let mut slots = [0; 7];
        for link in links {
            slots[link.kind() + 1..].iter_mut().for_each(|slot| *slot += link.memory());
        }
        Slots(slots)
    }

    /// The slots of the next link.
    fn of(&mut self, link: &LinkElement) -> std::ops::Range<usize> {
        let next = &mut self.0[link.kind()];
        let first = *next;
        *next += link.memory();
        first..*next
    }
}

/// The group and the element in it of each link of the deck, in deck order; `groups` are those of the whole system.
pub fn of_deck<'g>(links: &[LinkElement], groups: &'g [Group]) -> Vec<(&'g Group, usize)> {
    let shared = groups.iter().filter(|group| is_shared(group));
    let all = shared.flat_map(|group| (0..group.block.len()).map(move |e| (group, e)));
    // The blocks follow each other by kinds.
    let mut order: Vec<usize> = (0..links.len()).collect();
    order.sort_by_key(|&link| links[link].kind());
    let mut places: Vec<_> = order.into_iter().zip(all).collect();
    places.sort_by_key(|(link, _)| *link);
    places.retain(|(link, _)| !matches!(links[*link], LinkElement::Joint(_)));
    places.into_iter().map(|(_, place)| place).collect()
}

/// The places of the history variables of a link among the history of all groups.
pub fn history_of(links: &[LinkElement], groups: &[Group], link: usize) -> std::ops::Range<usize> {
    let first = groups.iter().find(|group| is_shared(group)).map_or(0, |group| group.history.start);
    let mut next = Slots::before_kinds(links);
    let mut found = 0..0;
    links[..=link].iter().for_each(|link| found = next.of(link));
    first + found.start..first + found.end
}

/// The state of a link by the displacement along its axes, its rate along the first, and force and moment at its second end along them.
fn in_axes(
    nodes: &[Node],
    (ends, axes): (&[usize; 2], &Mat3),
    (d, rate, f, m): (Vec3, f64, Vec3, Vec3),
    failed: bool,
) -> LinkState {
    let [first, second] = ends.map(|n| &nodes[n]);
    let B = first.R() * axes;
    let f_global = B * f;
    // Force and moment act at the second end; the force, across the distance of the ends, adds a moment on the first.
    let m = B * m + (second.x - first.x).cross(&f_global);
    LinkState { elongation: d.x, rate, force: f.x, f: f_global, m, failed }
}

/// Writes the states of all links into `out`, in deck order. `groups` are those of the whole system.
pub fn link_states(links: &[LinkElement], groups: &[Group], now: &Configuration, out: &mut Vec<LinkState>) {
    out.clear();
    let nodes = now.nodes;
    let own = groups.iter().filter(|group| is_shared(group)).map(|group| &group.history);
    // The blocks of links follow each other.
    let history = own.cloned().reduce(|all, group| all.start..group.end).map_or(&[][..], |all| &now.history[all]);
    let mut next = Slots::before_kinds(links);
    out.extend(links.iter().map(|link| (link, &history[next.of(link)])).map(|(link, memory)| match link {
        LinkElement::Line(link) => {
            let (elongation, rate, force) = link.state(nodes, memory);
            let failed = link_failure::has_failed(memory);
            LinkState { elongation, rate, force, f: force * link.axis(nodes), m: Vec3::zeros(), failed }
        }
        LinkElement::Hysteretic(of) => {
            let (elongation, rate, force) = of.state(nodes, memory);
            LinkState { elongation, rate, force, f: force * of.link.axis(nodes), m: Vec3::zeros(), failed: false }
        }
        LinkElement::Bushing(bushing) => {
            let failed = bushing.has_failed(memory);
            in_axes(nodes, (&bushing.nodes, &bushing.axes), bushing.state(nodes, memory), failed)
        }
        LinkElement::Bearing(bearing) => in_axes(nodes, (&bearing.nodes, &bearing.axes), bearing.state(nodes), false),
        LinkElement::Isolator(of) => {
            let (d, rate, p) = of.state(nodes, memory);
            in_axes(nodes, (&of.nodes, &of.axes), (d, rate, p, Vec3::zeros()), false)
        }
        LinkElement::Joint(spring) => {
            let at = spring.state(nodes, memory, 0.0);
            let [G, _] = spring.lock.gradient(&nodes[spring.nodes[0]], &nodes[spring.nodes[1]]);
            let [f, m] = [linear(&G), angular(&G)].map(|part| -at.effort * part);
            LinkState { elongation: at.q, rate: at.rate, force: at.effort, f, m, failed: false }
        }
    }));
}
