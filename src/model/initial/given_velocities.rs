//! The table behind each node's initial velocity: one, or several that agree.

use std::collections::HashMap;

use crate::data::{DIRECTIONS, GivenVelocity, History, Restraint};
use crate::places::nodes::Nodes;
use crate::places::spot::Spot;
use crate::report::Report;
use base::diagnostic::Span;
use base::math::Vec3;
use base::names::short;
use mechanics::amplitude::{Amplitude, Side};

/// Relative tolerance of two equal velocities: formulas give twelve digits (`SAME`). A prescribed motion and a velocity written beside it
/// agree to six digits (`AS_WRITTEN`).
const SAME: f64 = 1e-9;
const AS_WRITTEN: f64 = 1e-6;

/// The quantity of a table: a velocity or an angular velocity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum InitialQuantity {
    Velocity,
    AngularVelocity,
}

impl InitialQuantity {
    /// The deck's key.
    fn word(self) -> &'static str {
        match self {
            InitialQuantity::Velocity => "velocity",
            InitialQuantity::AngularVelocity => "angular_velocity",
        }
    }

    /// The first of its three degrees of freedom.
    fn first_dof(self) -> usize {
        match self {
            InitialQuantity::Velocity => 0,
            InitialQuantity::AngularVelocity => 3,
        }
    }
}

/// A table that gives velocities.
pub struct Giver<'d> {
    /// Words for the table, such as "entry 2 of `[[initial]]`".
    pub what: String,
    /// The place of the table.
    pub span: &'d Span,
    /// True where its velocities replace those of earlier tables.
    pub replaces: bool,
}

/// The velocities that tables have given so far.
#[derive(Default)]
pub struct GivenVelocities<'d> {
    givers: Vec<Giver<'d>>,
    /// The value by node and quantity, and the index of the table that gave it.
    values: HashMap<(usize, InitialQuantity), (Vec3, usize)>,
    /// Tables that contradict each other, the earlier one first: the first node, and how many there are.
    contradictions: Vec<Contradiction>,
}

struct Contradiction {
    givers: [usize; 2],
    quantity: InitialQuantity,
    values: [Vec3; 2],
    node: usize,
    count: usize,
}

impl<'d> GivenVelocities<'d> {
    /// Begins the next table.
    pub fn begin(&mut self, giver: Giver<'d>) {
        self.givers.push(giver);
    }

    /// Gives a node a velocity by the table begun last.
    pub fn give(&mut self, node: usize, quantity: InitialQuantity, by: GivenVelocity, nodes: &mut Nodes) {
        let giver = self.givers.len() - 1;
        let of = &mut nodes.list[node];
        let value = match quantity {
            InitialQuantity::Velocity => by.velocity(&of.x, &by.normal),
            InitialQuantity::AngularVelocity => by.angular_velocity(&of.x),
        };
        match quantity {
            InitialQuantity::Velocity => (of.v, of.given[0]) = (value, Some(by)),
            InitialQuantity::AngularVelocity => (of.omega, of.given[1]) = (value, Some(by)),
        }
        let before = self.values.insert((node, quantity), (value, giver));
        let Some((old, earlier)) = before.filter(|_| !self.givers[giver].replaces) else { return };
        // The velocity of a dependent node is replaced by its master's later.
        if (value - old).amax() <= SAME * value.amax().max(old.amax()) || follows(node, quantity, nodes) {
            return;
        }
        let same = |c: &&mut Contradiction| c.givers == [earlier, giver] && c.quantity == quantity;
        match self.contradictions.iter_mut().find(same) {
            Some(contradiction) => contradiction.count += 1,
            None => {
                let (givers, values) = ([earlier, giver], [old, value]);
                self.contradictions.push(Contradiction { givers, quantity, values, node, count: 1 });
            }
        }
    }

    /// Reports tables that give the same node different velocities.
    pub fn report_contradictions(&self, nodes: &Nodes, report: &mut Report<'d>) {
        for Contradiction { givers: [earlier, later], quantity, values: [old, new], node, count } in
            &self.contradictions
        {
            let (earlier, later) = (&self.givers[*earlier], &self.givers[*later]);
            let more = match count - 1 {
                0 => String::new(),
                more => format!(", and {more} more of their nodes"),
            };
            let message = format!(
                "`{}` is given two initial values of `{}`: {} by {}, {} by {}{more}",
                nodes.label(*node),
                quantity.word(),
                components(old),
                earlier.what,
                components(new),
                later.what,
            );
            let hint = "give it once; `replaces = true` lets this table take the place of the ones before it";
            report.error_with::<()>(later.span, message, hint);
        }
    }

    /// Warns of names with nonzero velocities from the last table in a direction restrained by supports at all of their nodes. A support at
    /// the end of a part is no error.
    pub fn report_dropped(
        &self,
        spots: &[Spot<'d>],
        quantities: &[InitialQuantity],
        amplitudes: &[Amplitude],
        nodes: &Nodes,
        report: &mut Report<'d>,
    ) {
        for spots in spots.chunk_by(|a, b| a.span == b.span) {
            for (quantity, i) in quantities.iter().flat_map(|&quantity| (0..3).map(move |i| (quantity, i))) {
                let dof = quantity.first_dof() + i;
                let given = |spot: &Spot| self.values.get(&(spot.node, quantity)).map_or(Vec3::zeros(), |(v, _)| *v);
                let dropped = |spot: &Spot| {
                    let v = given(spot);
                    let held = nodes.restraint(spot.node, dof).filter(|_| v[i].abs() > SAME * v.amax());
                    held.filter(|held| (v[i] - start_velocity(held, amplitudes)).abs() > AS_WRITTEN * v[i].abs())
                };
                let Some(held) = dropped(&spots[0]).filter(|_| spots.iter().all(|spot| dropped(spot).is_some())) else {
                    continue;
                };
                let (name, word) = (&spots[0].name, quantity.word());
                let holds = if held.motion.is_some() { "prescribes another motion" } else { "holds it at rest" };
                let message = format!(
                    "`{name}` does not take the {word} {} that it is given in {}: its support {holds} there",
                    short(given(&spots[0])[i]),
                    DIRECTIONS[dof]
                );
                let hint = "leave the component out, or take the direction out of the support";
                report.warn(spots[0].span, message, hint);
            }
        }
    }

    /// Warns of names with an angular velocity but no rotational degree of freedom.
    pub fn report_without_rotation(&self, spots: &[Spot<'d>], nodes: &Nodes, report: &mut Report<'d>) {
        for spots in spots.chunk_by(|a, b| a.span == b.span) {
            let idle = |spot: &Spot| {
                let omega =
                    self.values.get(&(spot.node, InitialQuantity::AngularVelocity)).map_or(0.0, |(w, _)| w.amax());
                omega > 0.0 && !nodes.turns(spot.node) && (3..6).all(|dof| nodes.master_in(spot.node, dof).is_none())
            };
            if spots.iter().all(idle) {
                let message = format!("`{}` does not take the angular_velocity that it is given", spots[0].name);
                let hint = "remove it: bars, springs and masses without inertia have no rotations";
                report.warn(spots[0].span, message, hint);
            }
        }
    }
}

/// True for a node with the velocity of its master.
fn follows(node: usize, quantity: InitialQuantity, nodes: &Nodes) -> bool {
    nodes.master_in(node, quantity.first_dof()).is_some()
}

/// The velocity with which a restrained direction begins.
fn start_velocity(restraint: &Restraint, amplitudes: &[Amplitude]) -> f64 {
    restraint.motion.as_ref().map_or(0.0, |motion| {
        let amplitude = &amplitudes[motion.amplitude];
        match motion.history {
            History::Displacement => motion.scale * amplitude.rate(0.0, Side::After),
            History::Velocity => motion.scale * amplitude.value(0.0),
            History::Acceleration => 0.0,
        }
    })
}

fn components(v: &Vec3) -> String {
    format!("[{}, {}, {}]", short(v.x + 0.0), short(v.y + 0.0), short(v.z + 0.0))
}
