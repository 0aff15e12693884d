//! Request to a material point and its response, for one point or for eight side by side.

use super::dissipation::Dissipation;
use base::math::number::Number;
use std::array::from_fn;

/// The results of a material beyond the stress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ask {
    /// Nothing more.
    Stress,
    /// The derivative of the stress.
    Tangent,
    /// The history variables after this fraction of the step, and the dissipation until then.
    History(f64),
}

/// The history variables of a point.
#[derive(Debug, Clone, Copy)]
pub struct MaterialHistory<T, const N: usize> {
    /// Plastic strain.
    pub plastic: [T; N],
    /// Accumulated plastic strain.
    pub accumulated: T,
    /// Back stress; `None` without kinematic hardening.
    pub back: Option<[T; N]>,
    /// Damage; `None` where failure depends on neither stress nor rate.
    pub damage: Option<T>,
    /// Overstress of the last state; `None` without viscosity.
    pub overstress: Option<T>,
}

/// The response of a material point.
#[derive(Debug, Clone, Copy)]
pub struct PointResponse<T, const N: usize> {
    /// Stress.
    pub stress: [T; N],
    /// Derivative of the stress by the strain, if asked for; `None` where it is the elastic stiffness.
    pub tangent: Option<[[T; N]; N]>,
    /// New history variables, if asked for; `None` where they do not change.
    pub new: Option<MaterialHistory<T, N>>,
    /// Energy per volume dissipated in the step, if the history is asked for; `None` where nothing yields.
    pub dissipation: Option<Spent<T>>,
}

/// Plastic parts of [`Dissipation`] for one point or for eight; `None` for parts that the law does not have.
#[derive(Debug, Clone, Copy)]
pub struct Spent<T> {
    /// Dissipated by yielding.
    pub plastic: T,
    /// Dissipated by viscosity.
    pub viscous: Option<T>,
    /// Kept by kinematic hardening.
    pub stored: Option<T>,
    /// Energy stored in failed points and removed with them.
    pub eroded: Option<T>,
}

impl<T: Number> Spent<T> {
    /// Nothing.
    pub const ZERO: Self = Spent { plastic: T::ZERO, viscous: None, stored: None, eroded: None };

    /// Adds `part` of more.
    #[inline(always)]
    pub fn add(&mut self, more: &Spent<T>, part: T) {
        let add = |sum: &mut Option<T>, more: Option<T>| {
            if let Some(more) = more {
                *sum = Some(sum.unwrap_or(T::ZERO) + more * part);
            }
        };
        self.plastic += more.plastic * part;
        add(&mut self.viscous, more.viscous);
        add(&mut self.stored, more.stored);
        add(&mut self.eroded, more.eroded);
    }

    /// The energies of one point.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> Dissipation {
        let of = |part: Option<T>| part.map_or(0.0, |part| part.lane(lane));
        Dissipation {
            plastic: self.plastic.lane(lane),
            viscous: of(self.viscous),
            stored: of(self.stored),
            eroded: of(self.eroded),
            ..Dissipation::default()
        }
    }
}

impl Spent<f64> {
    /// Adds `part` of more, point by point: `count` of them.
    #[inline(always)]
    pub fn add_each<T: Number>(&mut self, more: &Spent<T>, part: T, count: usize) {
        let add = |sum: &mut f64, more: T| (more * part).to_lanes()[..count].iter().for_each(|more| *sum += more);
        let add_some = |sum: &mut Option<f64>, more: Option<T>| {
            if let Some(more) = more {
                add(sum.get_or_insert(0.0), more);
            }
        };
        add(&mut self.plastic, more.plastic);
        add_some(&mut self.viscous, more.viscous);
        add_some(&mut self.stored, more.stored);
        add_some(&mut self.eroded, more.eroded);
    }
}

impl<T: Number, const N: usize> MaterialHistory<T, N> {
    /// `old` where the condition holds, this elsewhere.
    #[inline(always)]
    pub(super) fn unless(self, condition: T::Mask, old: &Self) -> Self {
        let of = |new, old| T::select(condition, old, new);
        let both = |new: Option<T>, old: Option<T>| new.zip(old).map(|(new, old)| of(new, old));
        MaterialHistory {
            plastic: from_fn(|i| of(self.plastic[i], old.plastic[i])),
            accumulated: of(self.accumulated, old.accumulated),
            back: self.back.zip(old.back).map(|(new, old)| from_fn(|i| of(new[i], old[i]))),
            damage: both(self.damage, old.damage),
            overstress: both(self.overstress, old.overstress),
        }
    }
}
