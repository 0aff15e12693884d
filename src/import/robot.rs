//! A robot as URDF describes it: links and joints, read from XML.

use crate::verdicts::{KeywordVerdict, Verdicts};
use base::math::{Mat3, Vec3, rotation};
use base::text_file::Text;
use roxmltree::{Document, Node};

/// A place and the directions of its axes, as columns.
#[derive(Debug, Clone, Copy)]
pub struct FramePose {
    /// The axes.
    pub turn: Mat3,
    /// The place.
    pub x: Vec3,
}

impl FramePose {
    /// The frame itself.
    pub fn here() -> Self {
        FramePose { turn: Mat3::identity(), x: Vec3::zeros() }
    }

    /// A pose that is given in this frame.
    pub fn then(&self, inner: &FramePose) -> FramePose {
        FramePose { turn: self.turn * inner.turn, x: self.x + self.turn * inner.x }
    }
}

/// Mass, and inertia about the centre along the axes of the inertial frame.
#[derive(Debug, Clone)]
pub struct LinkInertia {
    /// The mass.
    pub mass: f64,
    /// The frame of the centre in that of the link.
    pub origin: FramePose,
    /// The inertia.
    pub inertia: Mat3,
}

/// The outline of a link.
#[derive(Debug, Clone)]
pub enum LinkOutline {
    /// A cuboid by its edges.
    Cuboid(Vec3),
    /// Radius and length, along local z.
    Cylinder(f64, f64),
    /// The radius.
    Sphere(f64),
    /// The name of a file.
    Surface(String),
}

/// A link.
#[derive(Debug, Clone)]
pub struct RobotLink {
    /// Its name.
    pub name: String,
    /// Its line.
    pub line: usize,
    /// Its mass, if it has one.
    pub inertia: Option<LinkInertia>,
    /// Its outlines and their frames, with the line.
    pub outlines: Vec<(LinkOutline, FramePose, usize)>,
}

/// A joint.
#[derive(Debug, Clone)]
pub struct RobotJoint {
    /// Its name.
    pub name: String,
    /// Its line.
    pub line: usize,
    /// Its kind.
    pub kind: String,
    /// The link that carries it.
    pub parent: String,
    /// The link that it carries.
    pub child: String,
    /// The frame of the child in that of the parent.
    pub origin: FramePose,
    /// The axis in the frame of the child.
    pub axis: Vec3,
    /// The least and the largest coordinate.
    pub limits: Option<[f64; 2]>,
    /// The largest effort of its drive, 0 if not given.
    pub effort: f64,
    /// The damping factor.
    pub damping: f64,
    /// The force or moment of dry friction.
    pub friction: f64,
    /// The joint that it follows, the factor and the offset.
    pub mimic: Option<(String, f64, f64)>,
}

/// All of a file.
#[derive(Debug, Default)]
pub struct Robot {
    /// Its name.
    pub name: String,
    /// The links.
    pub links: Vec<RobotLink>,
    /// The joints.
    pub joints: Vec<RobotJoint>,
}

/// Reads a file and keeps verdicts on its elements.
pub struct RobotReader<'a, 't> {
    /// The file.
    pub text: &'a Text<'t>,
    /// The verdicts.
    pub verdicts: Verdicts,
}

impl RobotReader<'_, '_> {
    /// Adds a verdict on a line.
    pub fn say(&mut self, verdict: KeywordVerdict, line: usize, why: &str) {
        self.verdicts.add(self.text, verdict, line, None, why.to_owned());
    }

    /// Refuses a line.
    pub fn refuse(&mut self, line: usize, why: &str) {
        self.say(KeywordVerdict::Refused, line, why);
    }

    /// Reads a robot.
    pub fn robot(&mut self, document: &Document) -> Robot {
        let root = document.root_element();
        let mut robot = Robot { name: root.attribute("name").unwrap_or("robot").to_owned(), ..Robot::default() };
        if root.tag_name().name() != "robot" {
            self.refuse(line_of(&root), "the file is no URDF: its first element is not <robot>");
        }
        for node in root.children().filter(Node::is_element) {
            let line = line_of(&node);
            match node.tag_name().name() {
                "link" => robot.links.extend(self.link(&node)),
                "joint" => robot.joints.extend(self.joint(&node)),
                "material" => self.say(KeywordVerdict::Ignored, line, "colours are not drawn"),
                "transmission" => {
                    self.say(KeywordVerdict::Ignored, line, "drives are `motion` or `effort` of [[joints]] in the deck")
                }
                "gazebo" | "sensor" => self.say(KeywordVerdict::Ignored, line, "settings of another program"),
                name => self.refuse(line, &format!("<{name}> is not known; run xacro before rdsolve import")),
            }
        }
        robot
    }

    fn link(&mut self, node: &Node) -> Option<RobotLink> {
        let mut outlines = Vec::new();
        for shown in node.children().filter(|child| child.has_tag_name("visual")) {
            if let Some(outline) = child(&shown, "geometry").and_then(|geometry| self.outline(&geometry)) {
                outlines.push((outline, self.origin(&shown)?, line_of(&shown)));
            }
        }
        let inertia = match child(node, "inertial") {
            Some(inertial) => Some(self.inertia(&inertial)?),
            None => None,
        };
        Some(RobotLink { name: self.text_of(node, "name")?, line: line_of(node), inertia, outlines })
    }

    fn outline(&mut self, geometry: &Node) -> Option<LinkOutline> {
        let node = geometry.children().find(Node::is_element)?;
        match node.tag_name().name() {
            "box" => Some(LinkOutline::Cuboid(self.vector(&node, "size")?)),
            "cylinder" => Some(LinkOutline::Cylinder(self.number(&node, "radius")?, self.number(&node, "length")?)),
            "sphere" => Some(LinkOutline::Sphere(self.number(&node, "radius")?)),
            "mesh" => Some(LinkOutline::Surface(node.attribute("filename").unwrap_or_default().to_owned())),
            name => {
                self.refuse(line_of(&node), &format!("the shape <{name}> is not known"));
                None
            }
        }
    }

    fn inertia(&mut self, node: &Node) -> Option<LinkInertia> {
        let mass = match child(node, "mass") {
            Some(mass) => self.number(&mass, "value")?,
            None => 0.0,
        };
        let mut inertia = Mat3::zeros();
        if let Some(of) = child(node, "inertia") {
            for (name, i, j) in
                [("ixx", 0, 0), ("iyy", 1, 1), ("izz", 2, 2), ("ixy", 0, 1), ("ixz", 0, 2), ("iyz", 1, 2)]
            {
                if i == j || of.has_attribute(name) {
                    inertia[(i, j)] = self.number(&of, name)?;
                    inertia[(j, i)] = inertia[(i, j)];
                }
            }
        }
        Some(LinkInertia { mass, origin: self.origin(node)?, inertia })
    }

    fn joint(&mut self, node: &Node) -> Option<RobotJoint> {
        let mut link = |name: &str| match child(node, name) {
            Some(of) => self.text_of(&of, "link"),
            None => {
                self.refuse(line_of(node), &format!("a joint needs <{name} link=\"...\"/>"));
                None
            }
        };
        let [parent, child_link] = [link("parent"), link("child")];
        let axis = match child(node, "axis") {
            Some(axis) => self.vector(&axis, "xyz")?,
            None => Vec3::x(),
        };
        let mut of = |name: &str, key: &str| match child(node, name) {
            Some(child) if child.has_attribute(key) => self.number(&child, key),
            _ => None,
        };
        let limits = [of("limit", "lower"), of("limit", "upper")];
        let [effort, damping, friction] =
            [of("limit", "effort"), of("dynamics", "damping"), of("dynamics", "friction")];
        let mimic = [of("mimic", "multiplier").unwrap_or(1.0), of("mimic", "offset").unwrap_or(0.0)];
        let follows = child(node, "mimic").and_then(|mimic| self.text_of(&mimic, "joint"));
        Some(RobotJoint {
            name: self.text_of(node, "name")?,
            line: line_of(node),
            kind: self.text_of(node, "type")?,
            parent: parent?,
            child: child_link?,
            origin: self.origin(node)?,
            axis,
            limits: child(node, "limit").map(|_| limits.map(|limit| limit.unwrap_or(0.0))),
            effort: effort.unwrap_or(0.0),
            damping: damping.unwrap_or(0.0),
            friction: friction.unwrap_or(0.0),
            mimic: follows.map(|joint| (joint, mimic[0], mimic[1])),
        })
    }

    /// The frame of `<origin>`: roll, pitch and yaw about fixed axes, one after the other.
    fn origin(&mut self, node: &Node) -> Option<FramePose> {
        let Some(origin) = child(node, "origin") else { return Some(FramePose::here()) };
        let mut read = |key: &str| match origin.has_attribute(key) {
            true => self.vector(&origin, key),
            false => Some(Vec3::zeros()),
        };
        let [x, angles] = [read("xyz")?, read("rpy")?];
        let about = |axis: Vec3, angle: f64| rotation::matrix(&rotation::exp(&(axis * angle)));
        let turn = about(Vec3::z(), angles[2]) * about(Vec3::y(), angles[1]) * about(Vec3::x(), angles[0]);
        Some(FramePose { turn, x })
    }

    fn text_of(&mut self, node: &Node, key: &str) -> Option<String> {
        let text = node.attribute(key).map(str::to_owned);
        if text.is_none() {
            self.refuse(line_of(node), &format!("<{}> needs {key}=\"...\"", node.tag_name().name()));
        }
        text
    }

    fn number(&mut self, node: &Node, key: &str) -> Option<f64> {
        let text = self.text_of(node, key)?;
        let number = text.trim().parse::<f64>().ok().filter(|x| x.is_finite());
        if number.is_none() {
            self.refuse(line_of(node), &format!("{key}=\"{text}\" must be a number"));
        }
        number
    }

    fn vector(&mut self, node: &Node, key: &str) -> Option<Vec3> {
        let text = self.text_of(node, key)?;
        let numbers: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        let is_whole =
            numbers.len() == 3 && text.split_whitespace().count() == 3 && numbers.iter().all(|x| x.is_finite());
        if !is_whole {
            self.refuse(line_of(node), &format!("{key}=\"{text}\" must be three numbers"));
            return None;
        }
        Some(Vec3::new(numbers[0], numbers[1], numbers[2]))
    }
}

fn child<'n, 'd>(node: &Node<'n, 'd>, name: &str) -> Option<Node<'n, 'd>> {
    node.children().find(|child| child.has_tag_name(name))
}

/// The line of an element, counted from 1.
pub fn line_of(node: &Node) -> usize {
    node.document().text_pos_at(node.range().start).row as usize
}
