//! `bars`, `core` and `cover` of `[sections.x]`: the fibres of a section of several materials, and its stiffness and mass.

use super::materials::Materials;
use super::report::{Owner, Report};
use base::diagnostic::{At, Span};
use base::math::Mat3;
use base::names::short;
use deck::sections as words;
use deck::words::Numbers;
use deck::words::kinds::OneOf;
use mechanics::elements::beam::{FibreGroup, FibreSum};
use mechanics::materials::uniaxial::UniaxialLaw;
use mechanics::sections::{Fibre, SectionShape, SectionStresses, Stiffness};
use std::f64::consts::PI;

/// Largest number of bars of a section.
const MOST_BARS: u64 = 1000;

/// The fibres of one material of a section, and its density.
pub(super) struct SectionPart {
    /// Fibres and law.
    pub group: FibreGroup,
    /// 0 where nothing needs a mass.
    pub density: f64,
}

/// True for a section of several materials.
pub(super) fn is_composite(section: &words::Section) -> bool {
    section.core.is_some() || section.cover.is_some() || section.bars.is_some()
}

/// A section with stiffness and normal stresses of its fibres in place of its own in tension and bending, and their mass.
pub(super) fn with_fibres(
    (section, stresses): (Stiffness, Option<SectionStresses>),
    parts: &[SectionPart],
) -> (Stiffness, Option<SectionStresses>) {
    let all = || parts.iter().flat_map(|part| part.group.fibres.iter().map(move |fibre| (part, fibre)));
    let [mut stiffness, mut mass] = [FibreSum::default(), FibreSum::default()];
    for (part, fibre) in all() {
        stiffness.add(fibre, &[[part.group.law.modulus()]]);
        mass.add(fibre, &[[part.density]]);
    }
    let (C, M) = (stiffness.axial(), mass.axial());
    let mut out = section;
    (out.N[(0, 0)], out.NM[(0, 1)], out.NM[(0, 2)]) = (C[(0, 0)], C[(0, 1)], C[(0, 2)]);
    (out.M[(1, 1)], out.M[(2, 2)], out.M[(1, 2)], out.M[(2, 1)]) = (C[(1, 1)], C[(2, 2)], C[(1, 2)], C[(2, 1)]);
    let mass = M[(0, 0)];
    let [y, z] = if mass > 0.0 { [-M[(0, 2)] / mass, M[(0, 1)] / mass] } else { [0.0; 2] };
    let [Iy, Iz, Iyz] = [M[(1, 1)] - mass * z * z, M[(2, 2)] - mass * y * y, -M[(1, 2)] - mass * y * z];
    (out.mass_per_length, out.mass_center) = (mass, [y, z]);
    out.inertia_per_length = Mat3::new(Iy + Iz, 0.0, 0.0, 0.0, Iy, -Iyz, 0.0, -Iyz, Iz);
    let stressed = all().filter(|(_, fibre)| fibre.area > 0.0);
    let fibres = stressed.map(|(part, fibre)| [fibre.y, fibre.z, part.group.law.modulus()]).collect();
    (out, stresses.and_then(|stresses| stresses.of_fibres(&C, fibres)))
}

/// Replaces the fibres of a section of one material by those of cover, core and bars. `counts` are the numbers of fibres.
pub(super) fn reinforce<'d>(
    materials: &Materials<'d>,
    (name, section): (&'d At<String>, &'d At<OneOf<words::Section>>),
    shape: &dyn SectionShape,
    counts: [usize; 2],
    base: SectionPart,
    needs_mass: bool,
    report: &mut Report<'d>,
) -> Option<Vec<SectionPart>> {
    let owner = Owner::new(format!("section `{}`", name.value), &section.span);
    let mut parts = vec![base];
    let mut depth_of_core = f64::INFINITY;
    if let Some(core) = &section.core {
        let cover = report.require_positive(&owner, "cover", &section.cover)?;
        let part = self::part(materials, core, &owner, needs_mass, report)?;
        require_concrete(core, &part.group.law, report)?;
        let Some([outside, inside]) = shape.cover_and_core(cover, counts) else {
            let place = &section.cover.as_ref()?.span;
            let message = format!("{} has no core within a cover of {}", owner.what, short(cover));
            return report.error_with(place, message, "a core has shape \"rectangle\" or \"circle\" and some width");
        };
        parts[0].group.fibres = outside;
        parts.push(SectionPart { group: FibreGroup { fibres: inside, ..part.group }, ..part });
        depth_of_core = cover;
    } else if let Some(cover) = &section.cover {
        let message = format!("{} has a `cover`, but no `core`", owner.what);
        return report.error_with(&cover.span, message, "name the material of the core");
    }
    let (mut sound, mut laid) = (true, Vec::new());
    for bars in section.bars.iter().flat_map(|bars| &bars.value) {
        let read =
            self::bars(materials, (&owner, bars), shape, (&mut parts, &mut laid, depth_of_core), needs_mass, report);
        sound &= read.is_some();
    }
    sound.then_some(parts)
}

/// A material without fibres yet.
fn part<'d>(
    materials: &Materials<'d>,
    name: &'d At<String>,
    owner: &Owner<'d>,
    needs_mass: bool,
    report: &mut Report<'d>,
) -> Option<SectionPart> {
    let (_, material) = materials.find(name, report)?;
    let density = materials.density_if(needs_mass, name, material, &owner.what, report)?;
    let law = match materials.law_of_fibres(name)? {
        Some(law) => law,
        None => UniaxialLaw::Elastic(material.youngs_modulus.as_ref()?.value),
    };
    Some(SectionPart { group: FibreGroup { law, fibres: Vec::new() }, density })
}

/// Reports a material that is no concrete.
pub(super) fn require_concrete(name: &At<String>, law: &UniaxialLaw, report: &mut Report) -> Option<()> {
    if matches!(law, UniaxialLaw::Concrete(_)) {
        return Some(());
    }
    let message = format!("material `{}` is no concrete: `core` and `bars` belong to sections of concrete", name.value);
    report.error_with(&name.span, message, "name a material of model \"concrete\"")
}

/// The centre and the radius of a bar in its section.
type Laid = ([f64; 2], f64);

/// Adds bars to the parts of a section, and takes away the concrete that they displace.
fn bars<'d>(
    materials: &Materials<'d>,
    (owner, bars): (&Owner<'d>, &'d At<deck::words::Table<words::SectionBars>>),
    shape: &dyn SectionShape,
    (parts, laid, depth_of_core): (&mut Vec<SectionPart>, &mut Vec<Laid>, f64),
    needs_mass: bool,
    report: &mut Report<'d>,
) -> Option<()> {
    let table = Owner::new(format!("`bars` of {}", owner.what), &bars.span);
    let places = places(&table, bars, report);
    let area = area(&table, bars, report);
    let name = report.require(&table, "material", &bars.material)?;
    let mut part = self::part(materials, name, owner, needs_mass, report)?;
    if matches!(part.group.law, UniaxialLaw::Concrete(_)) {
        let message = format!("{} are of concrete, material `{}`", table.what, name.value);
        return report.error_with(&name.span, message, "name a material of steel");
    }
    let (area, places) = (area?, places?);
    let radius = (area / PI).sqrt();
    for at @ [y, z] in places {
        let Some(depth) = shape.depth(at) else {
            let message = format!("{} has `bars`, which its shape does not take", owner.what);
            return report.error_with(&bars.span, message, "take shape \"rectangle\", \"circle\" or \"tube\"");
        };
        // A bar that touches the surface is inside, to rounding.
        if depth < radius * (1.0 - 1e-9) {
            let message = format!("the bar at [{}, {}] does not lie within {}", short(y), short(z), owner.what);
            let hint = format!("its centre is {} deep, its radius is {}", short(depth), short(radius));
            return report.error_with(&bars.span, message, hint);
        }
        let touches = |([v, w], other): &&Laid| (y - v).hypot(z - w) < (radius + other) * (1.0 - 1e-9);
        if let Some(([v, w], _)) = laid.iter().find(touches) {
            let [y, z, v, w] = [y, z, *v, *w].map(short);
            let message = format!("the bars at [{y}, {z}] and [{v}, {w}] of {} overlap", owner.what);
            return report.error_with(
                &bars.span,
                message,
                "a bar counts once; leave the corners out of one of two rows",
            );
        }
        laid.push((at, radius));
        // Hoops enclose bars on the edge of the core.
        let concrete = usize::from(depth >= depth_of_core * (1.0 - 1e-9));
        let fibre = |area: f64| Fibre { area, y, z, shear: [[0.0; 3]; 2] };
        parts[concrete].group.fibres.push(fibre(-area));
        part.group.fibres.push(fibre(area));
    }
    // Bars of one material are one part.
    match parts.iter_mut().find(|other| other.group.law == part.group.law && other.density == part.density) {
        Some(other) => other.group.fibres.append(&mut part.group.fibres),
        None => parts.push(part),
    }
    Some(())
}

/// The area of a bar.
fn area<'d>(owner: &Owner<'d>, bars: &'d words::SectionBars, report: &mut Report<'d>) -> Option<f64> {
    match (&bars.diameter, &bars.area) {
        (Some(_), Some(area)) => {
            report.error(&area.span, format!("{} take `diameter` or `area`, not both", owner.what))
        }
        (None, Some(_)) => report.positive("area", &bars.area),
        _ => report.require_positive(owner, "diameter", &bars.diameter).map(|d| 0.25 * PI * d * d),
    }
}

/// The places of the bars.
fn places<'d>(owner: &Owner<'d>, bars: &'d words::SectionBars, report: &mut Report<'d>) -> Option<Vec<[f64; 2]>> {
    let count = |report: &mut Report<'d>| {
        let count = report.require(owner, "count", &bars.count)?;
        match count.value {
            2..=MOST_BARS => Some(count.value),
            _ => report.error(&count.span, format!("`count` must lie between 2 and {MOST_BARS}")),
        }
    };
    let reject = |of: &str, keys: &[(&str, Option<&'d Span>)], report: &mut Report<'d>| {
        for (key, span) in keys.iter().filter_map(|(key, span)| Some((key, (*span)?))) {
            report.error::<()>(span, format!("`{key}` does not apply to {of}"));
        }
    };
    let place = |at: &'d Option<At<Numbers<2>>>| at.as_ref().map(|at| &at.span);
    let (from, to) = (("from", place(&bars.from)), ("to", place(&bars.to)));
    if let Some(at) = &bars.at {
        let others = [
            from,
            to,
            ("circle", bars.circle.as_ref().map(|at| &at.span)),
            ("count", bars.count.as_ref().map(|at| &at.span)),
        ];
        reject("a single bar with `at`", &others, report);
        return Some(vec![at.value.0]);
    }
    if bars.circle.is_some() {
        reject("bars on a `circle`", &[from, to], report);
        let (radius, count) = (report.positive("circle", &bars.circle), count(report));
        let (radius, count) = (radius?, count?);
        let on = |k: u64| {
            let (sin, cos) = (2.0 * PI * k as f64 / count as f64).sin_cos();
            [radius * cos, radius * sin]
        };
        return Some((0..count).map(on).collect());
    }
    if bars.from.is_none() && bars.to.is_none() {
        let message =
            format!("{} need a place: `at`, `from` and `to` with `count`, or `circle` with `count`", owner.what);
        return report.error(owner.span, message);
    }
    let from = report.require(owner, "from", &bars.from);
    let to = report.require(owner, "to", &bars.to);
    let (count, from, to) = (count(report)?, from?.value.0, to?.value.0);
    let between = |k: u64, i: usize| from[i] + (to[i] - from[i]) * (k as f64 / (count - 1) as f64);
    Some((0..count).map(|k| [between(k, 0), between(k, 1)]).collect())
}
