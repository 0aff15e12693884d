//! Motion and efforts along the coordinate of a joint: prescribed motion, motor, spring, damper, stops, friction and hysteresis.

use crate::data::{
    History, Joint, JointCoordinate, JointDrive, JointEffort, Load, LoadOrigin, LoadedCoordinate, Node, OwnDamping,
    PrescribedMotion,
};
use crate::links::ModelLinks;
use crate::links::hysteretic::{deteriorating, pinching};
use crate::own_damping::of_joint;
use crate::places::nodes::Nodes;
use crate::report::{Owner, Report};
use crate::scene::Scene;
use crate::values::{flag, keys, span};
use base::diagnostic::{At, Span};
use base::math::{Mat3, Vec3};
use base::names::short;
use base::words::kinds::{OneOf, Values};
use deck::joints as words;
use deck::words::Table;
use mechanics::amplitude::Amplitude;
use mechanics::constraints::joints::JointKind;
use mechanics::constraints::joints::kind::Coordinate;
use mechanics::elements::contact::restitution::{LEAST, Loss, number};
use mechanics::elements::coordinate_law::{CoordinateLaw, JointFriction, Stops};
use mechanics::elements::hysteresis::Hysteresis;
use mechanics::elements::path_law::PathLaw;
use std::collections::HashSet;

/// The result of `[[joints]]`.
#[derive(Default)]
pub struct Joints {
    /// The joints in deck order.
    pub list: Vec<Joint>,
    /// Forces and moments of motors, two of each.
    pub efforts: Vec<Load>,
}

/// Where a joint lies.
pub struct PlacedJoint<'v> {
    /// Its two ends.
    pub ends: [usize; 2],
    /// True for a joint of a later stage; its ends are then at their current positions.
    pub later: bool,
    /// Its axes as columns, global at t = 0.
    pub axes: Mat3,
    /// The values of its kind's own keys.
    pub values: &'v Values,
}

/// The keys of a joint that are about its coordinate.
pub struct CoordinateKeys<'a, 'd> {
    /// The joint, as messages call it.
    pub owner: &'a Owner<'d>,
    /// Its table.
    pub joint: &'d OneOf<words::Joint>,
    /// The scene.
    pub scene: &'a Scene<'d>,
    /// The amplitudes; motions without an amplitude add one.
    pub amplitudes: &'a mut Vec<Amplitude>,
    /// The problems.
    pub report: &'a mut Report<'d>,
}

/// The coupling of a joint's coordinate with another one's.
pub struct Gear<'d> {
    /// Name of the other joint.
    pub other: &'d At<String>,
    /// This coordinate per that of the other.
    pub ratio: f64,
}

/// Motion and efforts along the coordinate of a joint.
pub struct CoordinateActions<'d> {
    coordinate: Coordinate,
    motion: Option<PrescribedMotion>,
    /// The gear: the other joint and the ratio.
    pub gear: Option<Gear<'d>>,
    effort: Option<JointEffort>,
    law: CoordinateLaw,
    own_damping: OwnDamping,
    /// By how much the joint gives before friction slips, where the deck says so.
    stick: Option<f64>,
    /// True where its turns are counted although nothing acts.
    counted: bool,
}

impl<'d> CoordinateKeys<'_, 'd> {
    /// Reads motion and efforts along the coordinate; `None` for a joint without one.
    pub fn read(mut self, kind: &JointKind) -> Option<CoordinateActions<'d>> {
        let joint = self.joint;
        let Some(&own) = kind.make.coordinates.first() else {
            let what = format!("a joint of kind \"{}\": it has no coordinate", kind.word);
            self.report.reject_unused(&what, &keys(joint));
            return None;
        };
        let coordinate = match &joint.coordinate {
            Some(word) if !kind.make.coordinates.contains(&word.value) => {
                let message = format!("the coordinate of a joint of kind \"{}\" is no {}", kind.word, word.word());
                self.report.error_with::<()>(&word.span, message, format!("it is its {}", own.word()));
                own
            }
            word => word.as_ref().map_or(own, |word| word.value),
        };
        self.reject_if_later();
        let motion = self.motion();
        let gear = self.gear();
        let effort = self.effort();
        if own == Coordinate::Length {
            self.needs_an_action(kind);
        }
        let (damping, own_damping) = of_joint(&self.joint.damping, self.report);
        let law = self.law(kind, coordinate, damping);
        let stick = self.report.positive("stick", &joint.stick);
        let counted = self.is_counted();
        Some(CoordinateActions { coordinate, motion, gear, effort, law, own_damping, stick, counted })
    }

    /// Reports an actuator that does nothing.
    fn needs_an_action(&mut self, kind: &JointKind) {
        let joint = self.joint;
        let acts = keys!(joint; motion, gear, effort, stiffness, damping, limits, friction_force, backbone);
        if acts.iter().all(|(key, place)| place.is_none() && !self.report.is_spoiled(self.owner.span, key)) {
            let message = format!("{} of kind \"{}\" does nothing", self.owner.what, kind.word);
            let hint = "give the change of its length as `motion` = { position = 1.0, amplitude = \"...\" }, or a force as `effort`";
            self.report.error_with::<()>(self.owner.span, message, hint);
        }
    }

    /// True for a joint absent at t = 0 or later: the deck does not define the origin of its coordinate.
    fn is_later(&self) -> bool {
        is_later(self.scene, self.joint)
    }

    /// Reports keys that need the origin of the coordinate, for a joint absent at t = 0 or later.
    fn reject_if_later(&mut self) {
        if !self.is_later() {
            return;
        }
        for (key, place) in keys(self.joint).into_iter().filter(|(key, _)| !NEEDS_NO_ORIGIN.contains(key)) {
            let Some(place) = place else { continue };
            let message = format!("`{key}` needs a joint that is there from t = 0 on, without a break");
            let hint = "leave out `stages`: a drive whose amplitude is zero holds the joint until it begins";
            self.report.error_with::<()>(place, message, hint);
        }
    }

    /// True where results of the coordinate are requested; turns of a later joint cannot be counted.
    fn is_counted(&self) -> bool {
        if self.is_later() {
            return false;
        }
        let deck = self.scene.deck;
        let name = self.joint.name.as_ref().map(|name| name.as_str());
        let of_coordinate = |word: &str| ["coordinate", "rate", "effort", "power"].contains(&word);
        deck.output.as_ref().is_some_and(|output| flag(&output.joints, false))
            || deck.expect.iter().any(|expect| {
                expect.at.as_ref().map(|at| at.as_str()) == name
                    && expect.quantity.as_ref().is_some_and(|quantity| of_coordinate(quantity.as_str()))
            })
    }

    fn amplitude(&mut self, name: &'d Option<At<String>>) -> Option<usize> {
        self.report.find("amplitude", &self.scene.deck.amplitudes, name.as_ref()?).map(|(index, _)| index)
    }

    fn motion(&mut self) -> Option<PrescribedMotion> {
        let motion = self.joint.motion.as_ref()?;
        for (key, place) in self.against_motion() {
            let message = format!("{} has both `motion` and `{key}`", self.owner.what);
            self.report.error_with::<()>(place, message, "the motion is prescribed, whatever acts against it");
        }
        let amplitude = self.amplitude(&motion.amplitude);
        let (scale, history) = self.quantity(motion)?;
        // Static stages advance in time, so rates define positions.
        let is_static = self.scene.analysis.is_static();
        if is_static && self.scene.stage.is_none() && history != History::Displacement {
            return self.report.error(&scale.span, "a static analysis can have a motion by `position` only");
        }
        let index = match (&motion.amplitude, history) {
            (Some(_), _) => amplitude?,
            (None, _) if self.report.is_spoiled(&motion.span, "amplitude") => return None,
            (None, History::Displacement) => {
                let message = format!("the motion of {} by `position` needs `amplitude`", self.owner.what);
                let hint = "the coordinate is zero at t = 0, and goes on from there";
                return self.report.error_with(&motion.span, message, hint);
            }
            (None, _) => {
                self.amplitudes.push(Amplitude::Constant);
                self.amplitudes.len() - 1
            }
        };
        let index = self.scene.amplitude_of_motion(index, history);
        let starts = scale.value * self.amplitudes[index].value(0.0);
        let begins = self.scene.stage.is_none_or(|stage| stage.is_first());
        let moves = self.scene.analysis.is_dynamic() && begins;
        if history == History::Displacement && moves && starts != 0.0 {
            let (what, starts) = (&self.owner.what, short(starts));
            let message = format!("the motion of {what} begins at {starts}, but the coordinate is zero at t = 0");
            return self.report.error_with(&motion.span, message, "let the amplitude begin at zero");
        }
        Some(PrescribedMotion { amplitude: index, scale: scale.value, history })
    }

    /// The one quantity that a motion gives.
    fn quantity(&mut self, motion: &'d At<Table<words::JointMotion>>) -> Option<(&'d At<f64>, History)> {
        let given = [
            (&motion.position, History::Displacement),
            (&motion.velocity, History::Velocity),
            (&motion.acceleration, History::Acceleration),
        ];
        let mut given = given.into_iter().filter_map(|(value, history)| Some((value.as_ref()?, history)));
        let Some(first) = given.next() else {
            if !self.report.is_any_spoiled(&motion.span) {
                let message = format!("the motion of {} says nothing", self.owner.what);
                let hint = "give it `position`, `velocity` or `acceleration`";
                self.report.error_with::<()>(&motion.span, message, hint);
            }
            return None;
        };
        if let Some((other, _)) = given.next() {
            let message = format!("{} has two motions", self.owner.what);
            return self.report.error_with(&other.span, message, "one quantity gives the other two");
        }
        Some(first)
    }

    /// Keys in contradiction to a prescribed motion, with their places.
    fn against_motion(&self) -> Vec<(&'static str, &'d Span)> {
        let joint = self.joint;
        let keys = keys!(
            joint; gear, effort, limits, friction, friction_moment, friction_force, yield_moment, yield_force,
            backbone
        );
        keys.into_iter().filter_map(|(key, place)| Some((key, place?))).collect()
    }

    fn gear(&mut self) -> Option<Gear<'d>> {
        let gear = self.joint.gear.as_ref()?;
        let owner = Owner::new(format!("the gear of {}", self.owner.what), &gear.span);
        let other = self.report.require(&owner, "joint", &gear.joint);
        let ratio = self.report.require(&owner, "ratio", &gear.ratio);
        if let Some(ratio) = ratio.filter(|ratio| ratio.value == 0.0) {
            let hint = "a `motion` by a velocity of 0 holds a coordinate";
            return self.report.error_with(&ratio.span, "`ratio` must not be zero", hint);
        }
        Some(Gear { other: other?, ratio: ratio?.value })
    }

    fn effort(&mut self) -> Option<JointEffort> {
        let joint = self.joint;
        let effort: &'d words::Effort = &self.joint.effort.as_ref()?.value;
        let span = &self.joint.effort.as_ref()?.span;
        let owner = Owner::new(format!("the effort of {}", self.owner.what), span);
        let value = self.report.require(&owner, "value", &effort.value).map(|value| value.value);
        let amplitude = match self.scene.stage.filter(|_| effort.amplitude.is_none()) {
            Some(stage) => {
                return Some(JointEffort { value: value?, amplitude: Some(stage.own_amplitude(&joint.stages)) });
            }
            None => self.amplitude(&effort.amplitude),
        };
        (effort.amplitude.is_none() || amplitude.is_some()).then_some(JointEffort { value: value?, amplitude })
    }

    fn law(&mut self, kind: &JointKind, coordinate: Coordinate, damping: f64) -> CoordinateLaw {
        let joint = self.joint;
        if let (Some(rest), None) = (&joint.rest, &joint.stiffness)
            && !self.report.is_spoiled(self.owner.span, "stiffness")
        {
            self.report.error_with::<()>(
                &rest.span,
                "`rest` needs `stiffness`",
                "without a spring nothing rests there",
            );
        }
        let hysteresis = self.hysteresis(coordinate);
        // The hysteresis law includes the stiffness.
        let spring = self.report.not_negative("stiffness", &joint.stiffness, 0.0);
        CoordinateLaw {
            stiffness: if hysteresis.is_some() { 0.0 } else { spring },
            rest: joint.rest.as_ref().map_or(0.0, |rest| rest.value),
            damping,
            stops: self.stops(),
            friction: self.friction(kind, coordinate),
            hysteresis,
        }
    }

    fn stops(&mut self) -> Option<Stops> {
        let joint = self.joint;
        let Some(limits) = &joint.limits else {
            let of_stops = keys!(joint; limit_stiffness, restitution);
            if !self.report.is_spoiled(self.owner.span, "limits") {
                self.report.reject_unused("a joint without `limits`", &of_stops);
            }
            return None;
        };
        let [low, high] = limits.0;
        if low >= high {
            let message = format!("the limits of {} are reversed", self.owner.what);
            self.report.error_with::<()>(&limits.span, message, "the least coordinate comes first");
        } else if low > 0.0 || high < 0.0 {
            let message = format!("{} starts outside its limits", self.owner.what);
            self.report.error_with::<()>(
                &limits.span,
                message,
                "the coordinate is zero at t = 0, as the deck draws the joint",
            );
        }
        let stiffness = self.report.require_positive(self.owner, "limit_stiffness", &joint.limit_stiffness);
        let loss = match &joint.restitution {
            Some(e) if !(LEAST..=1.0).contains(&e.value) => {
                let hint = format!("from {LEAST} to 1");
                return self.report.error_with(&e.span, "`restitution` lies out of its range", hint);
            }
            Some(e) if e.value < 1.0 => Loss::Restitution { number: number(e.value), floor: 0.0 },
            _ => Loss::None,
        };
        Some(Stops { limits: [low, high], stiffness: stiffness?, loss })
    }

    /// The hysteresis law, by its yield moment or force, or by its backbone.
    fn hysteresis(&mut self, coordinate: Coordinate) -> Option<PathLaw> {
        let joint = self.joint;
        let (moment, force) = (("yield_moment", &joint.yield_moment), ("yield_force", &joint.yield_force));
        let ((key, value), other) = match coordinate {
            Coordinate::Angle => (moment, force),
            Coordinate::Distance | Coordinate::Length => (force, moment),
        };
        let what = format!("a joint whose coordinate is its {}", coordinate.word());
        self.report.reject_unused(&what, &[(other.0, span(other.1))]);
        let after = ("post_yield_stiffness", span(&joint.post_yield_stiffness));
        let rest = ("rest", span(&joint.rest));
        if let Some(backbone) = &joint.backbone {
            let others = [("stiffness", span(&joint.stiffness)), rest, (key, span(value)), after];
            self.report.reject_unused("a joint with a `backbone`", &others);
            let points: Vec<[f64; 2]> = backbone.value.iter().map(|point| point.value.0).collect();
            self.report.reject_unused("a joint with a `backbone`", &keys!(joint; deterioration));
            return match &joint.pinching {
                Some(table) => pinching(self.owner, (&points, &backbone.span), table, self.report),
                None => self.yielding(&backbone.span, &points, 0.0),
            };
        }
        self.report.reject_unused("a joint without a `backbone`", &keys!(joint; pinching));
        let Some(limit) = value else {
            if !self.report.is_spoiled(self.owner.span, key) {
                let deterioration = ("deterioration", span(&joint.deterioration));
                self.report.reject_unused("a joint that does not yield", &[after, deterioration]);
            }
            return None;
        };
        self.report.reject_unused("a joint that yields", &[rest]);
        let limit = self.report.positive(key, value).map(|value| (value, &limit.span));
        let stiffness = self.report.require_positive(self.owner, "stiffness", &joint.stiffness);
        let after = self.report.not_negative("post_yield_stiffness", &joint.post_yield_stiffness, 0.0);
        let ((limit, place), stiffness) = (limit?, stiffness?);
        if let (Some(given), false) = (&joint.post_yield_stiffness, after < stiffness) {
            return self.report.error(&given.span, "`post_yield_stiffness` must be below `stiffness`");
        }
        match &joint.deterioration {
            Some(table) => deteriorating([stiffness, after, limit], table, self.report),
            None => self.yielding(place, &[[limit / stiffness, limit]], after),
        }
    }

    fn yielding(&mut self, place: &'d Span, points: &[[f64; 2]], after: f64) -> Option<PathLaw> {
        match Hysteresis::new(points, after) {
            Ok(hysteresis) => Some(PathLaw::Backbone(hysteresis)),
            Err(reason) => self.report.error(place, format!("the backbone of {}: {reason}", self.owner.what)),
        }
    }

    /// Friction, the way on which it sticks yet to be found.
    fn friction(&mut self, kind: &JointKind, coordinate: Coordinate) -> Option<JointFriction> {
        let joint = self.joint;
        let moment = ("friction_moment", &joint.friction_moment);
        let force = ("friction_force", &joint.friction_force);
        let ((key, value), other) = match coordinate {
            Coordinate::Angle => (moment, force),
            Coordinate::Distance | Coordinate::Length => (force, moment),
        };
        let what = format!("a joint whose coordinate is its {}", coordinate.word());
        self.report.reject_unused(&what, &[(other.0, span(other.1))]);
        let slips = value.is_some() || other.1.is_some() || joint.friction.is_some();
        let unread =
            self.report.is_spoiled(self.owner.span, key) || self.report.is_spoiled(self.owner.span, "friction");
        if !slips && !unread {
            self.report.reject_unused("a joint without friction", &keys!(joint; stick));
        }
        let limit = self.report.not_negative(key, value, 0.0);
        let per_load = self.friction_per_load(kind, coordinate);
        (limit > 0.0 || per_load > 0.0).then_some(JointFriction { limit, per_load, stick: 0.0 })
    }

    /// Friction by a coefficient follows the load of the step before.
    fn judge_steps(&mut self, friction: &'d At<f64>) {
        let analysis = &self.scene.analysis;
        if analysis.is_static() {
            let message = "`friction` follows the load of the load step before, and the first has none";
            self.report.warn(
                &friction.span,
                message,
                "take several load steps, the last of them small, or a limit that is given",
            );
        } else if analysis.is_dynamic() && analysis.step_length.is_automatic() {
            let message = "`friction` needs a `time_step` that is given: friction follows the load of the previous step, so the error of a step \
                           is unknown";
            self.report.error_with::<()>(
                &friction.span,
                message,
                "give a number as `time_step`, or a limit that does not depend on the load of \
                                                                   the joint",
            );
        }
    }

    /// By how much the limit of friction grows with the force that the joint carries across its axis.
    fn friction_per_load(&mut self, kind: &JointKind, coordinate: Coordinate) -> f64 {
        let joint = self.joint;
        let Some(friction) = &joint.friction else {
            self.report.reject_unused("a joint without `friction`", &keys!(joint; radius));
            return 0.0;
        };
        let (coefficient, turns) =
            (self.report.not_negative("friction", &joint.friction, 0.0), coordinate == Coordinate::Angle);
        if !kind.make.carries_across {
            let message = format!("`friction` does not apply to a joint of kind \"{}\"", kind.word);
            let limit = if turns { "`friction_moment`" } else { "`friction_force`" };
            self.report.error_with::<()>(
                &friction.span,
                message,
                format!("{limit} is one that the joint's load does not change"),
            );
            return 0.0;
        }
        self.judge_steps(friction);
        if !turns {
            self.report.reject_unused("friction against a distance", &keys!(joint; radius));
            return coefficient;
        }
        self.report.require_positive(self.owner, "radius", &joint.radius).map_or(0.0, |radius| coefficient * radius)
    }
}

impl CoordinateActions<'_> {
    /// Gives a joint its coordinate, motion and efforts.
    pub fn set_up(
        mut self,
        placed: &PlacedJoint,
        joint: &mut Joint,
        (scene, nodes, links): (&Scene, &mut Nodes, &mut ModelLinks),
        efforts: &mut Vec<Load>,
    ) {
        let [from, to] = placed.ends;
        let d = nodes.x(from) - nodes.x(to);
        // An actuator pushes along the line between its ends, which turns with them.
        let axis = match self.coordinate {
            Coordinate::Length => -d.normalize(),
            _ => placed.axes.column(0).into_owned(),
        };
        let lock = self.coordinate.lock(&placed.axes, &d);
        if let Some(friction) = &mut self.law.friction {
            friction.stick = self.stick.unwrap_or_else(|| match self.coordinate {
                Coordinate::Angle => 1e-4,
                Coordinate::Distance | Coordinate::Length => 1e-5 * size(scene, nodes, &joint.name),
            });
        }
        let drive = self.motion.map(|motion| {
            let drive = nodes.add_number(format!("{}.motion", joint.name), from);
            nodes.restrain(drive, 0, Some(motion));
            JointDrive { node: drive, ratio: 1.0, is_free: false }
        });
        if let Some(effort) = &self.effort {
            let pull = effort.value * axis;
            let (force, moment) = match self.coordinate {
                Coordinate::Angle => (Vec3::zeros(), pull),
                Coordinate::Distance | Coordinate::Length => (pull, Vec3::zeros()),
            };
            efforts.extend([(0, -1.0), (1, 1.0)].map(|(end, sign)| Load {
                node: placed.ends[end],
                force: sign * force,
                moment: sign * moment,
                follower: false,
                amplitude: effort.amplitude,
                origin: Some(LoadOrigin::Coordinate(LoadedCoordinate {
                    ends: placed.ends,
                    end,
                    lock,
                    effort: effort.value,
                })),
                moment_counts: true,
            }));
        }
        let spring = (self.counted || self.law != CoordinateLaw::FREE)
            .then(|| links.add_to_coordinate(&joint.name, placed.ends, (lock, self.law), self.own_damping));
        joint.coordinate = Some(JointCoordinate { lock, axis, drive: None, effort: self.effort, spring });
        if let Some(drive) = drive {
            joint.set_drive(drive);
        }
    }
}

/// True where a joint is not there from t = 0 on, or comes back.
pub fn is_later(scene: &Scene, joint: &words::Joint) -> bool {
    scene.stage.is_some_and(|stage| !stage.is_carried(&joint.stages))
}

/// The size of the scene as a joint chooses by it, or 1 for a single point. The ends of other joints and of links that come or go between
/// stages do not count: the choice is the same in all stages.
pub fn size(scene: &Scene, nodes: &Nodes, joint: &str) -> f64 {
    let deck = scene.deck;
    let tables = deck.links.iter().map(|link| (&link.name, &link.stages));
    let tables = tables.chain(deck.joints.iter().map(|joint| (&joint.name, &joint.stages)));
    let passing = tables.filter(|(_, stages)| stages.is_some()).filter_map(|(name, _)| Some(name.as_ref()?.as_str()));
    let passing: HashSet<&str> = passing.filter(|name| *name != joint).collect();
    let stays = |node: &&Node| {
        let of = [".from", ".to"].into_iter().find_map(|end| node.label.strip_suffix(end));
        of.is_none_or(|of| !passing.contains(of))
    };
    let first = nodes.list.first().map_or(Vec3::zeros(), |node| node.x);
    let size = nodes.list.iter().filter(stays).map(|node| (node.x - first).norm()).fold(0.0, f64::max);
    if size > 0.0 { size } else { 1.0 }
}

/// The keys that act alike wherever the coordinate is zero.
const NEEDS_NO_ORIGIN: [&str; 7] =
    ["coordinate", "damping", "friction", "radius", "friction_moment", "friction_force", "stick"];

/// The keys about the coordinate, with the places where they stand.
fn keys(joint: &words::Joint) -> [(&'static str, Option<&Span>); 19] {
    keys!(
        joint; coordinate, motion, gear, effort, stiffness, rest, damping, limits, limit_stiffness, restitution,
        friction, radius, friction_moment, friction_force, stick, yield_moment, yield_force,
        post_yield_stiffness, backbone
    )
}
