//! A robot as a deck: links are bodies, joints are joints, and links that fixed joints weld together are one body.

use crate::deck_text::{DeckTable, DeckText, inline, list, quoted, vector};
use crate::robot::{FramePose, LinkInertia, LinkOutline, Robot, RobotJoint, RobotReader};
use crate::verdicts::KeywordVerdict::{Changed, Ignored, Translated};
use base::math::{Mat3, Vec3};
use std::collections::HashMap;

/// How far a stop gives under the largest effort of the drive, in radians.
const GIVE: f64 = 0.01;
/// How far a stop of a prismatic joint gives under the largest effort.
const GIVE_ALONG: f64 = 1e-3;
/// The effort that a stop is made for where the file has none.
const EFFORT: f64 = 100.0;
/// By how much a principal moment may exceed the sum of the other two, over it.
const ROUNDING: f64 = 1e-9;
/// How far an outline may lie off the centre of mass, over the size of the robot.
const COINCIDENT: f64 = 1e-6;

/// A robot that becomes a deck.
pub struct RobotBuild<'r, 'a, 't> {
    /// The reader, which keeps the verdicts.
    pub reader: &'r mut RobotReader<'a, 't>,
    robot: Robot,
    /// The frame of each link that has been reached.
    frames: HashMap<String, FramePose>,
    /// The link whose body each link is part of.
    heads: HashMap<String, String>,
    /// The fixed link, and the links welded to it.
    ground: String,
    deck: DeckText,
}

/// The deck of a robot.
pub fn deck(reader: &mut RobotReader, robot: Robot) -> DeckText {
    let (frames, heads, ground) = (HashMap::new(), HashMap::new(), String::new());
    let mut build = RobotBuild { reader, robot, frames, heads, ground, deck: DeckText::default() };
    if build.tree().is_none() {
        return build.deck;
    }
    let line = build.robot.links[0].line;
    let analysis =
        DeckTable::new("analysis", 0).text("kind", "dynamic").number("end_time", 1.0).text("time_step", "auto");
    build.deck.add(analysis);
    build.deck.add(DeckTable::new("environment", 0).numbers("gravity", &[0.0, 0.0, -9.81]));
    build.deck.add(DeckTable::new("output", 0).value("joints", "true"));
    build.bodies();
    build.frames_of_welded();
    for joint in build.robot.joints.clone() {
        build.joint(&joint);
    }
    if build.heads.values().all(|head| *head == build.ground) {
        build.reader.refuse(line, "no link moves: a robot needs a joint that is not fixed");
    }
    build.deck
}

impl RobotBuild<'_, '_, '_> {
    /// Frames and bodies of all links from the root on; `None` where they are no tree.
    fn tree(&mut self) -> Option<()> {
        let children: Vec<&String> = self.robot.joints.iter().map(|joint| &joint.child).collect();
        let roots: Vec<_> = self.robot.links.iter().filter(|link| !children.contains(&&link.name)).collect();
        let (root, line) = match roots[..] {
            [root] => (root.name.clone(), root.line),
            [_, second, ..] => {
                let about = format!(
                    "the links `{}` and `{}` hang on no joint: a robot has one root",
                    roots[0].name, second.name
                );
                let line = second.line;
                self.reader.refuse(line, &about);
                return None;
            }
            [] => {
                self.reader.refuse(1, "every link hangs on a joint: a robot needs a root");
                return None;
            }
        };
        self.ground.clone_from(&root);
        self.frames.insert(root.clone(), FramePose::here());
        self.heads.insert(root.clone(), root);
        self.reader.say(
            Changed,
            line,
            "the root link stands still; give it a floating joint to a link `world` where it moves",
        );
        let mut waiting = self.robot.joints.clone();
        while let Some(at) = waiting.iter().position(|joint| self.frames.contains_key(&joint.parent)) {
            let joint = waiting.remove(at);
            let frame = self.frames[&joint.parent].then(&joint.origin);
            let head = if joint.kind == "fixed" { self.heads[&joint.parent].clone() } else { joint.child.clone() };
            if self.frames.insert(joint.child.clone(), frame).is_some() {
                self.reader
                    .refuse(joint.line, &format!("the link `{}` hangs on two joints: a robot is a tree", joint.child));
                return None;
            }
            self.heads.insert(joint.child, head);
        }
        let lost = waiting.first().map(|joint| (joint.line, format!("no link is named `{}`", joint.parent)));
        let known = |name: &String| self.robot.links.iter().any(|link| link.name == *name);
        let missing = self.robot.joints.iter().find(|joint| !known(&joint.child));
        let fault = lost.or(missing.map(|joint| (joint.line, format!("no link is named `{}`", joint.child))));
        match fault {
            None => Some(()),
            Some((line, about)) => {
                self.reader.refuse(line, &about);
                None
            }
        }
    }

    /// Adds a body for each link that moves, with the mass of all that is welded to it.
    fn bodies(&mut self) {
        for link in self.robot.links.clone() {
            if self.heads.get(&link.name) != Some(&link.name) || link.name == self.ground {
                continue;
            }
            let members = self.robot.links.iter().filter(|other| self.heads[&other.name] == link.name);
            let parts: Vec<(FramePose, LinkInertia)> = members
                .filter_map(|of| Some((self.frames[&of.name].then(&of.inertia.as_ref()?.origin), of.inertia.clone()?)))
                .collect();
            let mass: f64 = parts.iter().map(|(_, part)| part.mass).sum();
            if mass <= 0.0 {
                self.reader
                    .refuse(link.line, &format!("the link `{}` moves and has no mass: give it <inertial>", link.name));
                continue;
            }
            let center = parts.iter().map(|(frame, part)| frame.x * part.mass).sum::<Vec3>() / mass;
            let inertia: Mat3 = parts.iter().map(|(frame, part)| about(&center, frame, part)).sum();
            if !is_of_a_body(&inertia) {
                let why = "no body has this inertia: its principal moments must be positive, none larger than the sum of the other two";
                self.reader.refuse(link.line, why);
            }
            let six = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)].map(|at| inertia[at]);
            let table = DeckTable::new("bodies", link.line)
                .text("name", &self.deck.unique(&link.name))
                .numbers("center", center.as_slice())
                .number("mass", mass)
                .numbers("inertia", &six);
            let table = self.outline(&link.name, &center, table);
            self.deck.add(table);
        }
    }

    /// Adds the first outline of a link whose middle is the centre of mass, about which the deck draws shapes.
    fn outline(&mut self, name: &str, center: &Vec3, table: DeckTable) -> DeckTable {
        let Some(link) = self.robot.links.iter().find(|link| link.name == name).cloned() else { return table };
        let size = self.frames.values().map(|frame| frame.x.norm()).fold(center.norm(), f64::max);
        let mut shape = None;
        for (outline, frame, line) in &link.outlines {
            let frame = self.frames[name].then(frame);
            let is_at_center = (frame.x - center).norm() <= COINCIDENT * size;
            let about = match (outline, is_at_center) {
                (LinkOutline::Surface(file), _) => {
                    format!("the surface `{file}` is not drawn; the body has a shape by its inertia")
                }
                (_, true) if shape.is_none() => {
                    shape = Some(drawn(outline, &frame));
                    continue;
                }
                _ => {
                    "an outline beside the centre of mass is not drawn; the body has a shape by its inertia".to_owned()
                }
            };
            self.reader.say(Ignored, *line, &about);
        }
        match shape {
            Some(keys) => table.value("shape", inline(&keys)),
            None => table,
        }
    }

    /// Adds a point on its body for each link that is welded to another one.
    fn frames_of_welded(&mut self) {
        for link in self.robot.links.clone() {
            let head = self.heads[&link.name].clone();
            if head == link.name || head == self.ground {
                continue;
            }
            let name = self.deck.unique(&link.name);
            let point = DeckTable::new("points", link.line).value(&name, vector(self.frames[&link.name].x.as_slice()));
            self.deck.add(point);
            let nodes = [name];
            self.deck.add(DeckTable::new("attachments", link.line).text("body", &head).names("nodes", &nodes));
        }
    }

    fn joint(&mut self, joint: &RobotJoint) {
        let kind = match &joint.kind[..] {
            "revolute" | "continuous" => "revolute",
            "prismatic" => "prismatic",
            "planar" => "planar",
            "fixed" => return self.reader.say(Translated, joint.line, "parent and child are one body"),
            "floating" => return self.reader.say(Translated, joint.line, "the child is free"),
            kind => return self.reader.refuse(joint.line, &format!("joints of type {kind} are not known")),
        };
        let frame = self.frames[&joint.child];
        let Some(axis) = (frame.turn * joint.axis).try_normalize(0.0) else {
            return self.reader.refuse(joint.line, "the axis of a joint must not be zero");
        };
        let x = vector(frame.x.as_slice());
        let head = &self.heads[&joint.parent];
        let from = match *head == self.ground {
            true => inline(&[("ground", x)]),
            false => inline(&[("body", quoted(head)), ("point", x)]),
        };
        let table = DeckTable::new("joints", joint.line)
            .text("name", &self.deck.unique_or(&joint.name, "joint"))
            .text("kind", kind)
            .value("from", from)
            .value("to", inline(&[("body", quoted(&joint.child))]))
            .numbers("axis", axis.map(|c| if c.abs() < 1e-15 { 0.0 } else { c }).as_slice());
        let table = if kind == "planar" { table } else { self.effects(joint, table, kind == "prismatic") };
        self.deck.add(table);
    }

    /// Adds damping, friction, stops, and the joint that this one follows.
    fn effects(&mut self, joint: &RobotJoint, mut table: DeckTable, is_along: bool) -> DeckTable {
        if joint.damping != 0.0 {
            table = table.number("damping", joint.damping);
        }
        if joint.friction != 0.0 {
            table = table.number(if is_along { "friction_force" } else { "friction_moment" }, joint.friction);
        }
        if let Some(limits) = joint.limits.filter(|_| joint.kind != "continuous") {
            if limits[0] < 0.0 && limits[1] > 0.0 {
                let effort = if joint.effort > 0.0 { joint.effort } else { EFFORT };
                let stiffness = effort / if is_along { GIVE_ALONG } else { GIVE };
                table = table.numbers("limits", &limits).number("limit_stiffness", stiffness);
                self.reader.say(
                    Changed,
                    joint.line,
                    "the stops are springs that give 0.01 rad or 0.001 under the effort",
                );
            } else {
                self.reader.say(
                    Changed,
                    joint.line,
                    "the limits do not hold 0 between them, where the deck begins, and are left out",
                );
            }
        }
        if let Some((other, ratio, offset)) = &joint.mimic {
            if !self.robot.joints.iter().any(|known| known.name == *other) {
                self.reader.refuse(joint.line, &format!("no joint is named `{other}`"));
            }
            if *offset != 0.0 {
                self.reader.say(Changed, joint.line, "both joints begin at 0: the offset is left out");
            }
            table =
                table.value("gear", inline(&[("joint", quoted(other)), ("ratio", crate::deck_text::number(*ratio))]));
        }
        table
    }
}

/// The inertia of a part about a point, along global axes.
fn about(center: &Vec3, frame: &FramePose, part: &LinkInertia) -> Mat3 {
    let r = frame.x - center;
    let own = frame.turn * part.inertia * frame.turn.transpose();
    own + (Mat3::identity() * r.norm_squared() - r * r.transpose()) * part.mass
}

/// True where a body can have this inertia.
fn is_of_a_body(inertia: &Mat3) -> bool {
    let mut moments = inertia.symmetric_eigenvalues();
    moments.as_mut_slice().sort_by(f64::total_cmp);
    moments[0] >= -1e-12 * moments[2] && moments[1] > 0.0 && moments[2] <= (moments[0] + moments[1]) * (1.0 + ROUNDING)
}

/// The shape of an outline along global axes.
fn drawn(outline: &LinkOutline, frame: &FramePose) -> Vec<(&'static str, String)> {
    let number = crate::deck_text::number;
    match outline {
        LinkOutline::Cuboid(size) => {
            let corner = |at: usize| {
                let signs = Vec3::from_fn(|i, _| if at >> i & 1 == 1 { 0.5 } else { -0.5 });
                frame.x + frame.turn * size.component_mul(&signs)
            };
            let points = list((0..8).map(|at| vector(corner(at).as_slice())));
            vec![("kind", quoted("hull")), ("points", points)]
        }
        LinkOutline::Cylinder(radius, length) => {
            let axis = vector(frame.turn.column(2).as_slice());
            vec![("kind", quoted("cylinder")), ("radius", number(*radius)), ("length", number(*length)), ("axis", axis)]
        }
        LinkOutline::Sphere(radius) => vec![("kind", quoted("sphere")), ("radius", number(*radius))],
        LinkOutline::Surface(_) => Vec::new(),
    }
}
