//! Sections of shape "polygons": stiffness, mass and stresses by finite elements of the section.

mod central;
mod mesh;
mod outlines;

use super::data::SectionFacts;
use super::materials::Materials;
use super::report::{Owner, Report};
use base::diagnostic::{At, Span};
use base::math::{Mat3, Mat6, Vec3, Vec6};
use base::names::short;
use central::CentralSolutions;
use deck::sections as words;
use deck::words::Table;
use deck::words::kinds::OneOf;
use mechanics::sections::section_triangle::{Lamina, SectionTriangle, isotropic};
use mechanics::sections::stresses::StressPoint;
use mechanics::sections::{Section, SectionOutline, SectionStresses, Stiffness};
use mesh::{MeshFault, SectionMesh};
use nalgebra::Matrix3;
use outlines::{Outlines, PolygonPoints};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::sync::{Arc, Mutex};

/// Entries of the matrix smaller than this, over the root of the product of their diagonals, are errors of the mesh.
const NO_COUPLING: f64 = 1e-6;

/// Mesh size over that by default beyond which the user is told: at four times, a rectangle errs by 0.2 % in torsion.
const COARSE: f64 = 3.0;

/// Largest Poisson's ratio: strains of the section are plane, and volume changes little.
const MOST_RATIO: f64 = 0.499;

/// Angle of material at a corner beyond which stress has no bound, so that such corners count in no extreme.
const RE_ENTRANT: f64 = 1.25 * PI;

/// The material of a polygon.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PolygonMaterial {
    /// Stresses from the strains of a triangle.
    pub elasticity: Mat6,
    /// Young's modulus, along the fibres of a layer.
    pub modulus: f64,
    /// True of a layer with fibres.
    pub has_fibres: bool,
    /// Density, 0 where nothing needs it.
    pub density: f64,
}

/// The settings of the section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PolygonSettings {
    /// Place of the beam's axis; `None` for the centroid.
    pub axis: Option<[f64; 2]>,
    /// Length of the edges of triangles; `None` for that by the shape.
    pub mesh_size: Option<f64>,
}

/// The section that polygons make up.
pub(super) struct MeshedSection {
    /// Stiffness and mass about the axis of the beam.
    pub stiffness: Stiffness,
    /// What stresses follow from; `None` of layers with fibres.
    pub stresses: Option<SectionStresses>,
    /// Its numbers for people.
    pub facts: SectionFacts,
    /// The mesh size over that by default.
    coarseness: f64,
}

/// All that a section follows from.
#[derive(PartialEq)]
struct Asked {
    points: Vec<PolygonPoints>,
    materials: Vec<PolygonMaterial>,
    settings: PolygonSettings,
}

/// Sections computed last, as each stage and each plan of a deck asks for them again.
static SOLVED: Mutex<Vec<(Asked, Arc<MeshedSection>)>> = Mutex::new(Vec::new());

/// Number of sections that are kept: those of one deck.
const KEPT: usize = 16;

/// A polygon of the deck with its points.
type DeckPolygon = At<Table<words::SectionPolygon>>;

/// Finds the material of each polygon, which is elastic; `made_of` is the material of the beam.
pub(super) fn polygon_materials<'d>(
    (owner, polygons): (&Owner<'d>, &'d [DeckPolygon]),
    made_of: Option<&'d At<String>>,
    materials: &Materials<'d>,
    needs_mass: bool,
    report: &mut Report<'d>,
) -> Option<Vec<PolygonMaterial>> {
    let each = polygons.iter().enumerate().map(|(number, polygon)| {
        let what = format!("polygon {} of {}", number + 1, owner.what);
        match &polygon.lamina {
            Some(lamina) => laminate((&what, polygon), lamina, needs_mass, report),
            None => plain_material((&what, polygon), made_of, materials, needs_mass, report),
        }
    });
    let found = each.collect::<Option<Vec<PolygonMaterial>>>()?;
    let is_own = |polygon: &DeckPolygon| polygon.material.is_some() || polygon.lamina.is_some();
    if let Some(made_of) = made_of.filter(|_| polygons.iter().all(is_own)) {
        let message = format!("each polygon of {} has a material of its own, so the beam takes none", owner.what);
        return report.error_with(&made_of.span, message, "remove it here, or from the polygons that it is meant for");
    }
    Some(found)
}

/// Reads the elastic material of a polygon.
fn plain_material<'d>(
    (what, polygon): (&str, &'d DeckPolygon),
    made_of: Option<&'d At<String>>,
    materials: &Materials<'d>,
    needs_mass: bool,
    report: &mut Report<'d>,
) -> Option<PolygonMaterial> {
    let Some(name) = polygon.material.as_ref().or(made_of) else {
        let message = format!("{what} has no material");
        return report.error_with(&polygon.span, message, "name one here, or give the beam a `material`");
    };
    let (_, material) = materials.find(name, report)?;
    if materials.law_of_fibres(name)?.is_some() {
        let message = format!("{what} is of material `{}`, which yields", name.value);
        return report.error_with(&name.span, message, "a section of polygons takes materials of model \"elastic\"");
    }
    let of_material = Owner::new(format!("material `{}`, of which {what} is made,", name.value), &material.span);
    let ratio = report.require(&of_material, "poisson_ratio", &material.poisson_ratio)?;
    if ratio.value > MOST_RATIO {
        let message = format!("`poisson_ratio` of {what} must not be above {MOST_RATIO}");
        return report.error_with(
            &ratio.span,
            message,
            format!("take {MOST_RATIO}: finite elements of nearly constant volume lock"),
        );
    }
    let density = materials.density_if(needs_mass, name, material, what, report)?;
    let modulus = material.youngs_modulus.as_ref()?.value;
    Some(PolygonMaterial { elasticity: isotropic(modulus, ratio.value), modulus, has_fibres: false, density })
}

/// Reads the layer of a polygon.
fn laminate<'d>(
    (what, polygon): (&str, &'d DeckPolygon),
    lamina: &'d At<Table<words::SectionLamina>>,
    needs_mass: bool,
    report: &mut Report<'d>,
) -> Option<PolygonMaterial> {
    if let Some(material) = &polygon.material {
        let message = format!("`material` does not apply to {what}, which has a `lamina`");
        return report.error_with(&material.span, message, "remove one of both");
    }
    let owner = Owner::new(format!("the lamina of {what}"), &lamina.span);
    let moduli = report.require(&owner, "youngs_moduli", &lamina.youngs_moduli);
    let shear_moduli = report.require(&owner, "shear_moduli", &lamina.shear_moduli);
    let ratios = report.require(&owner, "poisson_ratios", &lamina.poisson_ratios);
    let direction = report.require(&owner, "direction", &lamina.direction);
    report.positive("density", &lamina.density);
    if needs_mass {
        report.require(&owner, "density", &lamina.density)?;
    }
    let (moduli, shear_moduli, ratios, direction) = (moduli?, shear_moduli?, ratios?, direction?);
    for (key, of) in [("youngs_moduli", moduli), ("shear_moduli", shear_moduli)] {
        if of.0.iter().any(|&modulus| modulus <= 0.0) {
            return report.error(&of.span, format!("all values of `{key}` must be above zero"));
        }
    }
    let [y, z] = direction.0;
    let Some(along) = Vec3::new(0.0, y, z).try_normalize(0.0) else {
        return report.error(&direction.span, "`direction` must not be zero");
    };
    let (sin, cos) = lamina.angle.as_ref().map_or(0.0, |angle| angle.value).sin_cos();
    let fibres = cos * Vec3::x() + sin * along;
    let across = cos * along - sin * Vec3::x();
    let axes = Mat3::from_columns(&[fibres, across, fibres.cross(&across)]);
    let layer = Lamina { moduli: moduli.0, shear_moduli: shear_moduli.0, ratios: ratios.0 };
    let Some(elasticity) = layer.elasticity(&axes) else {
        let message = format!("{} has no positive energy in some strain", owner.what);
        return report.error_with(
            &ratios.span,
            message,
            "`nu12` must be below the root of E1/E2: look at the order of axes",
        );
    };
    let density = lamina.density.as_ref().map_or(0.0, |density| density.value);
    Some(PolygonMaterial { elasticity, modulus: moduli.0[0], has_fibres: true, density })
}

/// The points of the polygons of a section.
fn polygon_points<'d>(
    (owner, polygons): (&Owner<'d>, &'d [DeckPolygon]),
    report: &mut Report<'d>,
) -> Option<Vec<PolygonPoints>> {
    let read = |(number, polygon): (usize, &'d DeckPolygon)| {
        let what = Owner::new(format!("polygon {} of {}", number + 1, owner.what), &polygon.span);
        let outline = report.require(&what, "points", &polygon.points)?;
        let holes = polygon.holes.iter().flat_map(|holes| &holes.value);
        let rings = std::iter::once(&outline.value).chain(holes);
        Some(PolygonPoints { rings: rings.map(|ring| ring.iter().map(|at| at.0).collect()).collect() })
    };
    polygons.iter().enumerate().map(read).collect()
}

/// Computes the section of polygons, and reports what is wrong with them.
pub(super) fn meshed_section<'d>(
    section: &'d At<OneOf<words::Section>>,
    (owner, polygons): (&Owner<'d>, &'d [DeckPolygon]),
    materials: &[PolygonMaterial],
    settings: PolygonSettings,
    report: &mut Report<'d>,
) -> Option<Arc<MeshedSection>> {
    let points = polygon_points((owner, polygons), report)?;
    let asked = Asked { points, materials: materials.to_vec(), settings };
    let find = |solved: &[(Asked, Arc<MeshedSection>)]| {
        solved.iter().find(|(other, _)| *other == asked).map(|(_, made)| Arc::clone(made))
    };
    let made = match SOLVED.lock().ok().and_then(|solved| find(&solved)) {
        Some(made) => made,
        None => {
            let made = Arc::new(solve(section, (owner, polygons), &asked, report)?);
            if let Ok(mut solved) = SOLVED.lock() {
                let excess = (solved.len() + 1).saturating_sub(KEPT);
                solved.drain(..excess);
                solved.push((asked, Arc::clone(&made)));
            }
            made
        }
    };
    if let Some(place) = section.values.place("mesh_size").filter(|_| made.coarseness > COARSE) {
        let times = short(made.coarseness);
        let message = format!("`mesh_size` is {times} times that by default in a polygon of {}", owner.what);
        report.warn(place, message, "torsion and shear may err by per cent: leave it out, or lower it until they stay");
    }
    Some(made)
}

/// Meshes the section and computes it.
fn solve<'d>(
    section: &'d At<OneOf<words::Section>>,
    (owner, polygons): (&Owner<'d>, &'d [DeckPolygon]),
    Asked { points, materials, settings }: &Asked,
    report: &mut Report<'d>,
) -> Option<MeshedSection> {
    let outlines = match Outlines::new(points) {
        Ok(outlines) => outlines,
        Err(fault) => {
            let message = format!("polygon {} of {} {}", fault.polygon + 1, owner.what, fault.message);
            return report.error_with(&polygons[fault.polygon].span, message, fault.hint);
        }
    };
    let mesh = match SectionMesh::new(&outlines, settings.mesh_size) {
        Ok(mesh) => mesh,
        Err(fault) => return mesh_error(fault, (owner, section), report),
    };
    match compute(&mesh, materials, settings.axis) {
        Some(made) => Some(made),
        None => report.error(&section.span, format!("{}: its finite elements have no solution", owner.what)),
    }
}

/// Reports why there is no mesh.
fn mesh_error<T>(
    fault: MeshFault,
    (owner, section): (&Owner, &At<OneOf<words::Section>>),
    report: &mut Report,
) -> Option<T> {
    let size: &Span = section.values.place("mesh_size").unwrap_or(&section.span);
    match fault {
        MeshFault::TooFine(triangles) => {
            let message = format!("`mesh_size` asks for {} triangles in {}", short(triangles.round()), owner.what);
            report.error_with(size, message, "leave it out, or raise it: errors fall with its third power or faster")
        }
        MeshFault::Failed => {
            let hint = "look for edges that nearly touch, and for corners that nearly agree";
            report.error_with(&section.span, format!("the polygons of {} have no triangulation", owner.what), hint)
        }
        MeshFault::Pieces(pieces) => {
            let message = format!("the polygons of {} are {pieces} pieces that no edge joins", owner.what);
            report.error_with(&section.span, message, "let polygons touch along edges, or make a beam of each piece")
        }
    }
}

/// Computes the section; `None` without a solution.
fn compute(mesh: &SectionMesh, materials: &[PolygonMaterial], axis: Option<[f64; 2]>) -> Option<MeshedSection> {
    let reference = materials[0].modulus;
    let elasticity: Vec<Mat6> = materials.iter().map(|of| of.elasticity / reference).collect();
    let triangles = mesh.triangles.iter().zip(&mesh.polygons).map(|(nodes, &polygon)| SectionTriangle {
        corners: [0, 1, 2].map(|k| mesh.nodes[nodes[k]]),
        elasticity: elasticity[polygon],
    });
    let triangles: Vec<SectionTriangle> = triangles.collect();
    let moments = |of: &dyn Fn(usize) -> f64| -> Vec6 {
        triangles.iter().zip(&mesh.polygons).map(|(triangle, &polygon)| of(polygon) * triangle.moments()).sum()
    };
    let (area, mass) = (moments(&|_| 1.0)[0], moments(&|polygon| materials[polygon].density));
    let solutions = CentralSolutions::new(mesh, triangles).ok()?;
    let F = solutions.flexibility(mesh);
    let scaling = F.diagonal().map(|f| f.sqrt().recip());
    let K = Mat6::from_diagonal(&scaling)
        * F.component_mul(&(scaling * scaling.transpose())).try_inverse()?
        * Mat6::from_diagonal(&scaling);
    // Lengths of the mesh are parts of its scale, and stresses parts of the reference.
    let s = mesh.scale;
    let lengths = Vec6::new(1.0, 1.0, 1.0, s, s, s);
    let K = (reference * s * s) * K.component_mul(&(lengths * lengths.transpose()));
    let own =
        with_mass(&K, &mass.component_mul(&Vec6::new(s * s, s.powi(3), s.powi(3), s.powi(4), s.powi(4), s.powi(4))));
    let centroid = [-K[(0, 5)] / K[(0, 0)], K[(0, 4)] / K[(0, 0)]];
    let shear_center = [-F[(3, 2)] / F[(3, 3)] * s, F[(3, 1)] / F[(3, 3)] * s];
    let about_centroid = clean(&own.beside(centroid.map(|c| -c)));
    let place = [0, 1].map(|k| axis.map_or(0.0, |axis| mesh.origin[k] + centroid[k] - axis[k]));
    let place = place.map(|c| if c.abs() > NO_COUPLING * radius_of(&about_centroid) { c } else { 0.0 });
    let stiffness = if place == [0.0; 2] { about_centroid.clone() } else { about_centroid.beside(place) };
    let moduli: Vec<f64> = materials.iter().map(|of| of.modulus / reference).collect();
    let from_centroid = [0, 1].map(|k| shear_center[k] - centroid[k]);
    let is_plain = materials.iter().all(|of| !of.has_fibres);
    let stresses = is_plain.then(|| {
        let points = stress_points((mesh, &solutions), &moduli, (centroid, shear_center));
        let equal = equal_section(&about_centroid, reference, from_centroid);
        SectionStresses::new(&equal, SectionOutline::Points(points)).beside(place)
    });
    let facts = SectionFacts {
        name: String::new(),
        material: None,
        triangles: mesh.triangles.len(),
        area: area * s * s,
        centroid: [0, 1].map(|k| mesh.origin[k] + centroid[k]),
        shear_center: [0, 1].map(|k| mesh.origin[k] + shear_center[k]),
        stiffness: about_centroid,
    };
    Some(MeshedSection { stiffness, stresses, facts, coarseness: mesh.coarseness })
}

/// The section with a matrix of stiffness, and with a mass by its integrals of ρ times 1, y, z, y², z² and y z.
fn with_mass(K: &Mat6, mass: &Vec6) -> Stiffness {
    let [m, my, mz, yy, zz, yz] = (*mass).into();
    let [y, z] = if m > 0.0 { [my / m, mz / m] } else { [0.0; 2] };
    let [yy, zz, yz] = [yy - m * y * y, zz - m * z * z, yz - m * y * z];
    Stiffness {
        mass_per_length: m,
        mass_center: [y, z],
        inertia_per_length: Mat3::new(yy + zz, 0.0, 0.0, 0.0, zz, -yz, 0.0, -yz, yy),
        ..Stiffness::general(1.0, [1.0; 2], 1.0, [1.0; 2], 0.0, [0.0; 3]).with_matrix(K)
    }
}

/// Returns a section about its centroid without the couplings and the distance of its mass that are rounding or errors of the mesh.
fn clean(section: &Stiffness) -> Stiffness {
    let K = section.matrix();
    let size = |i: usize, j: usize| (K[(i, i)] * K[(j, j)]).sqrt();
    let K = Mat6::from_fn(|i, j| if K[(i, j)].abs() > NO_COUPLING * size(i, j) { K[(i, j)] } else { 0.0 });
    let radius = radius_of(section);
    let mass_center = section.mass_center.map(|c| if c.abs() > NO_COUPLING * radius { c } else { 0.0 });
    Stiffness { mass_center, ..section.with_matrix(&K) }
}

/// A radius of the section, by its stiffness in torsion and bending and by that in tension.
fn radius_of(section: &Stiffness) -> f64 {
    (section.M.trace() / section.N[(0, 0)]).sqrt()
}

/// The section of one material with the stiffness in tension and bending of this one.
fn equal_section(section: &Stiffness, modulus: f64, shear_center: [f64; 2]) -> Section {
    let M: Matrix3<f64> = section.M / modulus;
    let area = section.N[(0, 0)] / modulus;
    Section {
        area,
        Iy: M[(1, 1)],
        Iz: M[(2, 2)],
        Iyz: -M[(1, 2)],
        torsion: M[(0, 0)],
        shear: [area, area, 0.0],
        shear_center,
    }
}

/// The sum of two components of shear stress, each for three resultants, and the number of its terms.
type ShearSum = ([[f64; 3]; 2], f64);

/// Places on the edges of polygons with the shear stress there, the mean of the triangles of one polygon. Re-entrant corners are left out.
fn stress_points(
    (mesh, solutions): (&SectionMesh, &CentralSolutions),
    moduli: &[f64],
    (centroid, shear_center): ([f64; 2], [f64; 2]),
) -> Vec<StressPoint> {
    let s = mesh.scale;
    let mut angles = vec![0.0; mesh.edge_nodes];
    let mut sums: BTreeMap<(usize, usize), ShearSum> = BTreeMap::new();
    for (number, (nodes, &polygon)) in mesh.triangles.iter().zip(&mesh.polygons).enumerate() {
        if nodes[..3].iter().all(|&node| node >= mesh.edge_nodes) {
            continue;
        }
        let stresses = solutions.corner_stresses(mesh, number);
        for corner in (0..3).filter(|&corner| nodes[corner] < mesh.edge_nodes) {
            angles[nodes[corner]] += angle([0, 1, 2].map(|k| mesh.nodes[nodes[(corner + k) % 3]]));
            let sum = sums.entry((polygon, nodes[corner])).or_default();
            sum.1 += 1.0;
            for component in 0..2 {
                let [y, z, twist] = [1, 2, 3].map(|k| stresses[corner][k][1 + component] / (s * s));
                let twist = twist / s;
                let through = [y - shear_center[1] * twist, z + shear_center[0] * twist, twist];
                (0..3).for_each(|k| sum.0[component][k] += through[k]);
            }
        }
    }
    let kept = sums.into_iter().filter(|((_, node), _)| !(RE_ENTRANT..1.999 * PI).contains(&angles[*node]));
    let point = |((polygon, node), (sum, count)): ((usize, usize), ShearSum)| StressPoint {
        at: [0, 1].map(|k| s * mesh.nodes[node][k] - centroid[k]),
        wall: 0,
        modulus: moduli[polygon],
        shear: sum.map(|of| of.map(|tau| tau / count)),
    };
    kept.map(point).collect()
}

/// The angle of a triangle at its first corner.
fn angle([a, b, c]: [[f64; 2]; 3]) -> f64 {
    let ([by, bz], [cy, cz]) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
    (by * cz - bz * cy).atan2(by * cy + bz * cz)
}

/// Half the smaller side of the box around polygons, the contact radius of a beam; 0 where they have none.
pub(super) fn half_depth(section: &words::Section) -> f64 {
    let polygons = section.polygons.iter().flat_map(|polygons| &polygons.value);
    let points = || polygons.clone().filter_map(|polygon| polygon.points.as_ref()).flat_map(|points| &points.value);
    let sides = [0, 1].map(|k| {
        let [low, high] =
            points().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], at| [a.min(at.0[k]), b.max(at.0[k])]);
        0.5 * (high - low)
    });
    sides[0].min(sides[1]).max(0.0)
}
