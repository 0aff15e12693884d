//! The mass, the loads and the motions that are given, in numbers that a reader compares with a hand calculation.

use super::explanation::Explanation;
use crate::system::energy::mass_and_center;
use crate::system::{CentrifugalLoad, Excitation, Side, System};
use crate::tolerances::explained_quantities::ROUNDING;
use base::math::Vec3;
use base::names::{short, to_digits};
use base::quantities::{Unit, UnitSystem};
use mechanics::amplitude::Amplitude;
use mechanics::state::Node;
use model::{self, DIRECTIONS, History, Load, Model};

/// Times at which loads and motions are looked at, besides the points of tables.
const SAMPLES: usize = 1000;
/// Motions that are listed one by one.
const LISTED: usize = 6;

/// Adds lines about the mass, the applied loads and the given motions.
pub fn explain(text: &mut Explanation, model: &Model, system: &System) {
    let units = model.output.units.as_deref().and_then(UnitSystem::find);
    let inertia = mass_and_center(system, &model.nodes);
    text.computed.extend(inertia.map(|of| ("mass", mass(model, of, units))));
    let weight = inertia.map_or(0.0, |(mass, _)| mass * model.loading.gravity.norm());
    let excitation = Excitation::new(model);
    let times = times(model);
    text.computed.extend(loads(model, weight, (&excitation, &times), units).map(|line| ("loads", line)));
    let turning = centrifugal(model, system, (&excitation, &times), units);
    text.computed.extend(turning.into_iter().map(|line| ("centrifugal", line)));
    let motions = motions(model, &excitation, &times, units);
    let more = motions.len().saturating_sub(LISTED);
    text.computed.extend(motions.into_iter().take(LISTED).map(|line| ("motion", line)));
    if more > 0 {
        text.add("motion", format!("and {more} more given motions"));
    }
}

/// The symbol of a unit behind a number, if the deck has units.
pub fn symbol(unit: Unit, units: Option<&UnitSystem>) -> String {
    units.map_or(String::new(), |units| format!(" {}", unit.text(Some(units))))
}

/// "8.1 kg with its center at (0, 0, 1.5) m; weight 79.5 N under gravity 9.81 m/s² along -z".
fn mass(model: &Model, (mass, center): (f64, Vec3), units: Option<&UnitSystem>) -> String {
    let size = model.nodes.iter().map(|node| node.x.amax()).fold(0.0, f64::max);
    let at: Vec<String> = center.iter().map(|x| short(if x.abs() < ROUNDING * size { 0.0 } else { *x })).collect();
    let [of_mass, of_length] = [Unit::Mass, Unit::Length].map(|unit| symbol(unit, units));
    let mut line = format!("{}{of_mass} with its center at ({}){of_length}", to_digits(mass, 6), at.join(", "));
    let gravity = model.loading.gravity.norm();
    if gravity > 0.0 {
        let [of_force, of_field] = [Unit::Force, Unit::Acceleration].map(|unit| symbol(unit, units));
        let [weight, field] = [to_digits(mass * gravity, 6), short(gravity)];
        let way = along(&(model.loading.gravity / gravity));
        line += &format!("; weight {weight}{of_force} under gravity {field}{of_field} along {way}");
    } else {
        line += "; no gravity";
    }
    line
}

/// A direction by its axis, "-z", or by its components.
pub fn along(direction: &Vec3) -> String {
    let axis = (0..3).find(|&i| direction[i].abs() > 1.0 - ROUNDING);
    match axis {
        Some(i) => format!("{}{}", if direction[i] < 0.0 { "-" } else { "" }, ["x", "y", "z"][i]),
        None => format!("({}, {}, {})", short(direction.x), short(direction.y), short(direction.z)),
    }
}

/// The times of the run at which loads and motions are looked at, ascending. Modes have one.
fn times(model: &Model) -> Vec<f64> {
    let (begin, end) = (model.analysis.begin, model.analysis.end_time);
    if model.analysis.has_modes() {
        return vec![end];
    }
    let even = (0..=SAMPLES).map(|k| begin + (end - begin) * k as f64 / SAMPLES as f64);
    let points = model.loading.amplitudes.iter().filter_map(Amplitude::points).flatten().map(|point| point[0]);
    let mut times: Vec<f64> = even.chain(points.filter(|time| (begin..=end).contains(time))).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

/// Force and moment of the loads with an amplitude.
type Sum = (Option<usize>, [f64; 6]);

/// The sums of forces and moments by amplitude, and the sums of their sizes. Forces that cancel leave rounding of these sizes.
fn sums(model: &Model) -> (Vec<Sum>, [f64; 2]) {
    let mut sums: Vec<Sum> = Vec::new();
    let mut terms = [0.0; 2];
    let mut add = |amplitude: Option<usize>, force: Vec3, moment: Vec3| {
        terms[0] += force.norm();
        terms[1] += moment.norm();
        let place = sums.iter().position(|(of, _)| *of == amplitude).unwrap_or_else(|| {
            sums.push((amplitude, [0.0; 6]));
            sums.len() - 1
        });
        (0..3).for_each(|i| sums[place].1[i] += force[i]);
        (0..3).for_each(|i| sums[place].1[3 + i] += moment[i]);
    };
    // The pretension of a link acts on a number, its shortening, and not in a direction. An unbalance is no force before its spin is known.
    let acts = |load: &&Load| load.coordinate().is_none() && !load.is_unbalance() && !model.nodes[load.node].is_number;
    for load in model.loading.nodal.iter().filter(acts) {
        let moment = if load.moment_counts { load.moment } else { Vec3::zeros() };
        add(load.amplitude, load.force, moment);
    }
    for load in &model.loading.pressures {
        let areas = load.faces.iter().flat_map(|face| face.areas(|node| model.nodes[node].x));
        add(load.amplitude, areas.sum::<Vec3>() * -load.pressure, Vec3::zeros());
    }
    (sums, terms)
}

/// The sums of forces and moments on nodes and of pressures on faces, by direction. Weight, motors and pretension are not among them.
/// "Fx 0 to 1200, Fz -300; the largest force is 4 times the weight".
fn loads(
    model: &Model,
    weight: f64,
    (excitation, times): (&Excitation, &[f64]),
    units: Option<&UnitSystem>,
) -> Option<String> {
    let (sums, terms) = sums(model);
    if sums.is_empty() {
        return None;
    }
    let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; 6];
    let harmonic =
        |amplitude: Option<usize>| amplitude.is_some_and(|i| model.loading.amplitudes[i].harmonic_phase().is_some());
    for &time in times {
        let mut now = [0.0; 6];
        for (amplitude, sum) in &sums {
            let factor = if harmonic(*amplitude) { 1.0 } else { excitation.factor_of(*amplitude, time, Side::After) };
            now.iter_mut().zip(sum).for_each(|(now, sum)| *now += factor * sum);
        }
        ranges.iter_mut().zip(now).for_each(|([least, most], now)| {
            *least = least.min(now);
            *most = most.max(now);
        });
    }
    let words = ["Fx", "Fy", "Fz", "Mx", "My", "Mz"];
    let largest = |of: std::ops::Range<usize>| ranges[of].iter().flatten().fold(0.0, |a: f64, b| a.max(b.abs()));
    let sizes = [largest(0..3), largest(3..6)];
    let symbols = [Unit::Force, Unit::Moment].map(|unit| symbol(unit, units));
    let line = ranges.iter().enumerate().filter_map(|(i, [least, most])| {
        let size = sizes[i / 3];
        let is_seen = least.abs().max(most.abs()) > ROUNDING * size.max(terms[i / 3]);
        is_seen.then(|| format!("{} {}{}", words[i], range(*least, *most, size), symbols[i / 3]))
    });
    let line: Vec<String> = line.collect();
    if line.is_empty() {
        return Some("sum to zero".to_owned());
    }
    // Forces of kN given in N, or the other way round, show beside the weight.
    let beside = (weight > 0.0 && sizes[0] > 0.0)
        .then(|| format!("; the largest force is {} times the weight", to_digits(sizes[0] / weight, 2)));
    Some(line.join(", ") + &beside.unwrap_or_default())
}

/// "mass 12 kg about (0, 0, 1) at a speed up to 100 rad/s; its forces at t = 0 sum to (0, 1200, 0) N", a line for each centrifugal load.
fn centrifugal(
    model: &Model,
    system: &System,
    (excitation, times): (&Excitation, &[f64]),
    units: Option<&UnitSystem>,
) -> Vec<String> {
    let [of_mass, of_speed, of_force] =
        [Unit::Mass, Unit::AngularVelocity, Unit::Force].map(|unit| symbol(unit, units));
    let nodes: Vec<Node> = model.nodes.iter().map(|node| Node::at_rest(node.x)).collect();
    let vector = |v: &Vec3| {
        let clean = |x: f64| short(if x.abs() < ROUNDING * v.amax() { 0.0 } else { x });
        format!("({}, {}, {})", clean(v.x), clean(v.y), clean(v.z))
    };
    let line = |(load, placed): (&model::Centrifugal, &CentrifugalLoad)| {
        let factors = times.iter().map(|&time| excitation.factor_of(load.amplitude, time, Side::After).abs());
        let speed = load.speed.abs() * factors.fold(0.0, f64::max);
        let [mass, about] = [to_digits(placed.mass(), 6), vector(&load.axis.direction)];
        let force = vector(&placed.total(speed * speed, &nodes));
        let speed = short(speed);
        format!(
            "mass {mass}{of_mass} about {about} at a speed up to {speed}{of_speed}; its forces at t = 0 sum to {force}{of_force}"
        )
    };
    model.loading.centrifugal.iter().zip(system.centrifugal()).map(line).collect()
}

/// "-12" of what is constant, "-12 to 3" of all else.
fn range(least: f64, most: f64, size: f64) -> String {
    let clean = |value: f64| short(if value.abs() < ROUNDING * size { 0.0 } else { value });
    if most - least < ROUNDING * size { clean(most) } else { format!("{} to {}", clean(least), clean(most)) }
}

/// A line for each amplitude of the ground or of supports: the largest value, and what its table is.
fn motions(model: &Model, excitation: &Excitation, times: &[f64], units: Option<&UnitSystem>) -> Vec<String> {
    let ground = model.loading.base_accelerations.iter().flat_map(|base| {
        let along = (0..3).filter(|&i| base.direction[i] != 0.0);
        let unit = Some(Unit::Acceleration);
        along.map(move |i| {
            (format!("ground {}", DIRECTIONS[i]), ("acceleration", unit), base.amplitude, base.direction[i])
        })
    });
    let supports = model.constraints.restraints.iter().filter_map(|restraint| {
        let motion = restraint.motion.as_ref()?;
        let (what, [linear, angular]) = match motion.history {
            History::Displacement => ("displacement", [Unit::Length, Unit::Radian]),
            History::Velocity => ("velocity", [Unit::Velocity, Unit::AngularVelocity]),
            History::Acceleration => ("acceleration", [Unit::Acceleration, Unit::AngularAcceleration]),
        };
        let node = &model.nodes[restraint.node];
        let heats = model.parts.iter().filter_map(|part| part.heat());
        let mut numbers = heats.flat_map(|heat| heat.numbers.into_iter().enumerate().map(|at| (at, heat.length)));
        if let Some(((of, _), length)) = numbers.find(|((_, number), _)| *number == Some(restraint.node)) {
            let what = if of == 0 { "strain without stress" } else { "curvature without stress" };
            return Some((format!("`{}`", node.label), (what, None), motion.amplitude, motion.scale / length));
        }
        let place = match node.is_number {
            true => format!("`{}`", node.label),
            false => format!("`{}` {}", node.label, DIRECTIONS[restraint.dof]),
        };
        // A number is the coordinate of a joint, a length or an angle.
        let unit = (!node.is_number).then_some(if restraint.dof < 3 { linear } else { angular });
        Some((place, (what, unit), motion.amplitude, motion.scale))
    });
    let of_time = symbol(Unit::Time, units);
    let line = |(place, (what, unit), amplitude, scale): (String, (&str, Option<Unit>), usize, f64)| {
        // A jump at the end acts in the next stage.
        let side = |time: f64| if time >= model.analysis.end_time { Side::Before } else { Side::After };
        let value = |time: f64| scale * excitation.factor_of(Some(amplitude), time, side(time));
        let values = times.iter().map(|&time| (value(time), time));
        let (most, at) =
            values.fold((0.0, 0.0), |most: (f64, f64), next| if next.0.abs() > most.0.abs() { next } else { most });
        if most == 0.0 {
            return None;
        }
        let table =
            model.loading.amplitudes[amplitude].points().map_or(String::new(), |points| table(points, &of_time));
        let gravities = units
            .filter(|_| unit == Some(Unit::Acceleration))
            .map_or(String::new(), |units| format!(", {} g,", to_digits(most.abs() / units.gravity, 3)));
        let unit = unit.map_or(String::new(), |unit| symbol(unit, units)) + &gravities;
        Some(format!("{place}: {what} up to {}{unit} at t = {}{of_time}{table}", short(most), short(at)))
    };
    ground.chain(supports).filter_map(line).collect()
}

/// "; a table of 4001 points 0.005 s apart, to t = 20 s".
fn table(points: &[[f64; 2]], of_time: &str) -> String {
    let ([first, last], count) = match points {
        [first, .., last] => ([first[0], last[0]], points.len()),
        _ => return String::new(),
    };
    let step = (last - first) / (count - 1) as f64;
    let is_even = points.windows(2).all(|pair| (pair[1][0] - pair[0][0] - step).abs() <= 1e-6 * step.abs());
    let apart = if is_even && count > 2 { format!(" {}{of_time} apart", short(step)) } else { String::new() };
    format!("; a table of {count} points{apart}, to t = {}{of_time}", short(last))
}
