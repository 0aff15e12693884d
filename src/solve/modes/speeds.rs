//! Complex modes over speeds of rotation, and the critical speeds among them.
//!
//! The k-th lowest frequency is a continuous function of the speed, also where modes cross or exchange their shapes. A critical speed is a root of
//! its difference from the speed.

use super::damped::damped_modes;
use super::fault::ModesFault;
use super::linearized::Linearized;
use super::mode::Modes;
use super::speed_modes::{CriticalSpeed, SpeedMode, SpeedModes};
use crate::system::assembly::Assembly;
use crate::tolerances::speeds::{CLOSE, CONTINUOUS, IN_RANGE, MOST_STEPS};
use base::names::short;
use linear::Solver;
use model::ModeExtent;
use std::f64::consts::TAU;

/// A scene whose spin is scaled.
struct Spinning<'s, 'a> {
    at: &'s Linearized<'a>,
    /// The spin of the state that a speed replaces.
    spin: f64,
    /// The modes at each speed.
    extent: ModeExtent,
    /// Factorizations and solutions so far.
    effort: [usize; 2],
}

/// Adds to the modes of a state those over speeds of rotation.
///
/// # Errors
/// The reason why there are no modes at one of the speeds.
pub fn over_speeds(
    at: &Linearized,
    speeds: &[f64],
    mut modes: Modes,
    linear: (&mut Solver, &mut Assembly),
) -> Result<Modes, ModesFault> {
    let fastest = at.state.nodes.iter().map(|node| node.omega.norm()).fold(0.0, f64::max);
    let mut spinning = Spinning { at, spin: fastest, extent: at.model.analysis.extent(), effort: [0; 2] };
    let (found, critical) = spinning.over(speeds, linear)?;
    if let Some(SpeedModes { speed, list }) = found.last()
        && let Some(highest) = list.last().map(|mode| mode.root[1]).filter(|highest| highest < speed)
    {
        modes.warnings.push(format!(
            "modes are known up to an angular frequency of {} at the speed {}: critical speeds above may be missing (more `modes`)",
            short(highest),
            short(*speed)
        ));
    }
    modes.factorizations += spinning.effort[0];
    modes.solves += spinning.effort[1];
    Ok(Modes { speeds: found, critical_speeds: critical, ..modes })
}

/// The critical speeds of bending within a range, in turns per time. `spin` is the spin of the state; the cost is counted.
///
/// # Errors
/// The reason why there are no modes at one of the speeds.
pub fn critical_frequencies(
    at: &Linearized,
    ([from, to], spin): ([f64; 2], f64),
    linear: (&mut Solver, &mut Assembly),
    counts: &mut Modes,
) -> Result<Vec<f64>, ModesFault> {
    let speeds: Vec<f64> =
        (0..IN_RANGE).map(|k| TAU * (from + (to - from) * k as f64 / (IN_RANGE - 1) as f64)).collect();
    // At the lower end of an interval a mode may be faster than at its critical speed.
    let mut spinning = Spinning { at, spin, extent: ModeExtent::UpTo(2.0 * to), effort: [0; 2] };
    let (_, critical) = spinning.over(&speeds, linear)?;
    counts.factorizations += spinning.effort[0];
    counts.solves += spinning.effort[1];
    let bends = critical.iter().filter(|critical| critical.mode.whirl.is_none_or(|whirl| !whirl.is_along));
    Ok(bends.map(|critical| critical.speed / TAU).collect())
}

impl Spinning<'_, '_> {
    /// The modes at ascending speeds, and the critical speeds between them, ascending.
    fn over(
        &mut self,
        speeds: &[f64],
        (solver, assembly): (&mut Solver, &mut Assembly),
    ) -> Result<(Vec<SpeedModes>, Vec<CriticalSpeed>), ModesFault> {
        let mut found: Vec<SpeedModes> = Vec::with_capacity(speeds.len());
        let mut critical = Vec::new();
        for &speed in speeds {
            self.at.check_stop()?;
            let list = self.modes(speed, (&mut *solver, &mut *assembly))?;
            let next = SpeedModes { speed, list };
            if let Some(before) = found.last() {
                for k in 0..before.list.len().min(next.list.len()) {
                    critical.extend(self.critical(k, [before, &next], (&mut *solver, &mut *assembly))?);
                }
            }
            found.push(next);
        }
        critical.sort_by(|a: &CriticalSpeed, b| a.speed.total_cmp(&b.speed));
        Ok((found, critical))
    }

    /// The modes at a speed, by their frequency.
    fn modes(&mut self, speed: f64, linear: (&mut Solver, &mut Assembly)) -> Result<Vec<SpeedMode>, ModesFault> {
        let state = self.at.spun(speed / self.spin);
        let modes = damped_modes(&Linearized { state: &state, ..*self.at }, self.extent, linear)?;
        self.effort[0] += modes.factorizations;
        self.effort[1] += modes.solves;
        let mode = |mode: &super::EigenMode| SpeedMode { root: [mode.root[0], mode.root[1].abs()], whirl: mode.whirl };
        let mut list: Vec<SpeedMode> = modes.list.iter().map(mode).collect();
        list.sort_by(|a, b| a.root[1].total_cmp(&b.root[1]));
        Ok(list)
    }

    /// The critical speed of the k-th frequency between two speeds, by regula falsi with halved weights (Illinois); `None` where there is none.
    fn critical(
        &mut self,
        k: usize,
        ends: [&SpeedModes; 2],
        (solver, assembly): (&mut Solver, &mut Assembly),
    ) -> Result<Option<CriticalSpeed>, ModesFault> {
        let [mut a, mut b] = ends.map(|end| end.speed);
        let [mut at_a, mut at_b] = ends.map(|end| end.list[k].root[1] - end.speed);
        if (at_a > 0.0) == (at_b > 0.0) {
            return Ok(None);
        }
        for _ in 0..MOST_STEPS {
            let speed = (a * at_b - b * at_a) / (at_b - at_a);
            let list = self.modes(speed, (&mut *solver, &mut *assembly))?;
            let Some(&mode) = list.get(k) else { return Ok(None) };
            let apart = mode.root[1] - speed;
            if apart.abs() <= CLOSE * speed || (b - a).abs() <= CLOSE * speed {
                // A frequency that jumps, where a damped motion begins to oscillate, meets no speed.
                return Ok((apart.abs() <= CONTINUOUS * speed).then_some(CriticalSpeed { speed, mode }));
            }
            if (apart > 0.0) == (at_b > 0.0) {
                at_a *= 0.5;
            } else {
                (a, at_a) = (b, at_b);
            }
            (b, at_b) = (speed, apart);
        }
        Ok(None)
    }
}
