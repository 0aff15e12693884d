//! Shells as the model describes them, and the quantities computed once from the undeformed geometry.

use super::camber::Camber;
use super::edge::EdgeTangents;
use super::edge_bending::EdgeBending;
use super::edge_bubbles::edge_bubbles;
use super::interpolation::{Interpolation, Quadrilateral, Triangle};
use super::layers::{LayerModel, LayerPack};
use super::pack::{Shell, ShellPack, Shells};
use super::plane_strains::PlaneStrains;
use super::section::{Drilling, InPlaneSection, ShellStiffness, StiffnessPack};
use super::surface::ElementSurface;
use crate::elements::block::ElementBlock;
use crate::elements::heat::Heat;
use base::math::Vec3;
use base::math::lanes::{LANES, Lanes};
use nalgebra::{Matrix3, SMatrix};
use std::array::from_fn;
use std::marker::PhantomData;

/// Shear correction factor: shear stress is not constant through the thickness.
pub(super) const SHEAR_FACTOR: f64 = 5.0 / 6.0;

/// Stiffness against different drilling at the ends of a straight edge, relative to the drilling stiffness; small, because bending of a
/// curved surface causes such drilling.
const UNEVEN: f64 = 1e-2;

/// Largest turn of a surface along an edge times its length, relative to the thickness, for an element to count as flat. Flat elements have
/// bulging edges and stretch along chords; others have straight edges and stretch along arcs.
pub const FLAT: f64 = 0.5;

/// Length over thickness above which stretch is measured along chords on any surface. A side compressed by a strain ε buckles
/// above ε (ℓ/h)² of about 5, and metals yield at a strain of 2e-3.
pub const SLENDER: f64 = 50.0;

/// Thickness and elastic constants of a group of elements.
#[derive(Debug, Clone, Copy)]
pub struct Plate {
    /// Thickness h.
    pub thickness: f64,
    /// Young's modulus.
    pub E: f64,
    /// Poisson's ratio.
    pub nu: f64,
    /// Stiffness of drilling over shear modulus times thickness; see [`super::DRILLING`].
    pub drilling: f64,
}

impl Plate {
    pub(super) fn shear_modulus(&self) -> f64 {
        0.5 * self.E / (1.0 + self.nu)
    }

    /// Plane stress per unit of thickness.
    pub(super) fn plane_stress(&self) -> Matrix3<f64> {
        let (E, nu) = (self.E, self.nu);
        Matrix3::new(1.0, nu, 0.0, nu, 1.0, 0.0, 0.0, 0.0, 0.5 * (1.0 - nu)) * (E / (1.0 - nu * nu))
    }
}

/// One element as the model describes it.
#[derive(Debug, Clone, Copy)]
pub struct ShellGeometry<'a> {
    /// Its three, four, six or nine nodes, the corners counter-clockwise about the normals, then those on the sides, then the middle.
    pub nodes: &'a [usize],
    /// Unit normals at the nodes at t = 0, which are the directors there.
    pub normals: &'a [Vec3],
    /// Its thickness; `None` for that of the plate.
    pub thickness: Option<f64>,
    /// The fraction of the bulge of each edge (from each node to the next) in the strain: [`Interpolation::BULGE`], equal in all elements
    /// of an edge, or zero for a straight edge.
    pub bulge: [f64; 4],
}

impl<'a> ShellGeometry<'a> {
    /// The plate with the thickness of the element.
    pub(super) fn plate(&self, plate: &Plate) -> Plate {
        Plate { thickness: self.thickness.unwrap_or(plate.thickness), ..*plate }
    }

    /// An element whose edges are free, and shared with others of its shape only.
    pub fn new(nodes: &'a [usize], normals: &'a [Vec3]) -> Self {
        ShellGeometry {
            nodes,
            normals,
            thickness: None,
            bulge: if nodes.len() == 3 { [Triangle::BULGE; 4] } else { [Quadrilateral::BULGE; 4] },
        }
    }
}

impl<K, const N: usize, const V: usize, const P: usize, const E: usize> Shells<K, N, V, P, E>
where
    K: PlaneStrains<N, V, P, E>,
{
    /// Elastic shells. `x`: positions of all nodes at t = 0; `damping`: factor of stiffness-proportional damping (time).
    pub fn new<'a>(
        elements: impl Iterator<Item = ShellGeometry<'a>>,
        x: &[Vec3],
        plate: &Plate,
        damping: f64,
    ) -> Shells<K, N, V, P, E> {
        let section =
            |of: &[Shell<N, V, P, E>]| StiffnessPack::gather(|lane| &of[lane.min(of.len() - 1)].section.elastic);
        build(elements, x, plate, damping, section)
    }
}

impl LayerModel {
    /// Shells whose layers yield. `x`: positions of all nodes at t = 0; `damping`: factor of stiffness-proportional damping (time).
    pub fn shells<'a, K, const N: usize, const V: usize, const P: usize, const E: usize>(
        &self,
        elements: impl Iterator<Item = ShellGeometry<'a>>,
        x: &[Vec3],
        (plate, heat): (&Plate, &Heat),
        damping: f64,
    ) -> Box<dyn ElementBlock>
    where
        K: PlaneStrains<N, V, P, E> + 'static,
    {
        let layers = self.layers(plate.thickness);
        let mut history = 0;
        let section = |of: &[Shell<N, V, P, E>]| {
            let mut all = Vec::with_capacity(LANES);
            for element in of {
                all.push((&element.section, history));
                history += layers.history(element.section.points.len());
            }
            LayerPack::new(&layers, &all)
        };
        let mut shells: Shells<K, N, V, P, E, LayerPack<P, E, Lanes>> = build(elements, x, plate, damping, section);
        shells.history = history;
        Box::new(shells.heated(heat, x))
    }
}

/// Shells, where `sections` packs the sections of up to eight elements.
fn build<'a, K, const N: usize, const V: usize, const P: usize, const E: usize, S>(
    elements: impl Iterator<Item = ShellGeometry<'a>>,
    x: &[Vec3],
    plate: &Plate,
    damping: f64,
    mut sections: impl FnMut(&[Shell<N, V, P, E>]) -> S,
) -> Shells<K, N, V, P, E, S>
where
    K: PlaneStrains<N, V, P, E>,
{
    let mut packs = Vec::new();
    let mut eight = Vec::with_capacity(LANES);
    let mut elements = elements.peekable();
    while let Some(e) = elements.next() {
        eight.push(shell::<K, N, V, P, E>(&e, x, plate));
        if eight.len() == LANES || elements.peek().is_none() {
            packs.push(ShellPack::new::<K>(&eight, sections(&eight)));
            eight.clear();
        }
    }
    Shells { packs, history: 0, damping, heat: None, interpolation: PhantomData }
}

/// An undeformed element with its directors and tangents.
fn shell<K, const N: usize, const V: usize, const P: usize, const E: usize>(
    e: &ShellGeometry,
    x: &[Vec3],
    plate: &Plate,
) -> Shell<N, V, P, E>
where
    K: PlaneStrains<N, V, P, E>,
{
    let plate = &e.plate(plate);
    let nodes: [usize; N] = from_fn(|a| e.nodes[a]);
    let D: [Vec3; N] = from_fn(|a| e.normals[a]);
    let surface = ElementSurface::<N, V>::new::<K, P>(from_fn(|a| x[nodes[a]] - x[nodes[0]]));
    let X = surface.X;
    let T = D.map(|d| surface.tangents(&d));
    let cambered = K::CAMBERED && is_curved(&X, &D, K::EDGES, plate.thickness);
    // Positions and directors both fall short of an arc.
    let (camber, arcs) = if cambered { (surface.camber, 2.0) } else { (Camber::NONE, 1.0) };
    let (shear, bent) = shear_stiffness::<K, N, V, P>(&surface, &D, plate);
    Shell {
        nodes,
        X,
        D,
        T,
        slopes: surface.slopes,
        arc: surface.arc.map(|row| row.map(|s| arcs * s)),
        camber,
        edges: K::EDGES.map(|[a, b]| EdgeTangents::new(&(X[b] - X[a]), [&T[a], &T[b]])),
        shear,
        bent,
        section: in_plane::<K, N, V, P, E>(&surface, plate, &from_fn(|a| e.bulge[a])),
    }
}

/// True for an element with an edge along which turn times length exceeds half the thickness. Slender elements are excepted, because
/// tension would bend them between their nodes, see [`super::camber`].
fn is_curved<const N: usize>(X: &[Vec3; N], D: &[Vec3; N], edges: [[usize; 2]; N], thickness: f64) -> bool {
    let mut lengths = edges.into_iter().map(|[a, b]| (X[b] - X[a]).norm());
    most_turn(X, D, edges) > FLAT * thickness && lengths.all(|L| L <= SLENDER * thickness)
}

/// The largest turn of the surface along an edge times its length.
fn most_turn<const N: usize>(X: &[Vec3; N], D: &[Vec3; N], edges: [[usize; 2]; N]) -> f64 {
    edges.into_iter().map(|[a, b]| (D[b] - D[a]).norm() * (X[b] - X[a]).norm()).fold(0.0, f64::max)
}

/// w Aᵀ C A by rows.
pub(super) fn squared<const R: usize>(A: &SMatrix<f64, 3, R>, C: &Matrix3<f64>, w: f64, to: &mut [[f64; R]; R]) {
    let K: SMatrix<f64, R, R> = w * A.transpose() * C * A;
    for i in 0..R {
        for j in 0..R {
            to[i][j] += 0.5 * (K[(i, j)] + K[(j, i)]);
        }
    }
}

/// The stiffness of an element in its plane.
fn in_plane<K, const N: usize, const V: usize, const P: usize, const E: usize>(
    surface: &ElementSurface<N, V>,
    plate: &Plate,
    bulge: &[f64; N],
) -> InPlaneSection<P, E>
where
    K: PlaneStrains<N, V, P, E>,
{
    let h = plate.thickness;
    let points = K::strains(surface, plate.nu, bulge);
    let C = plate.plane_stress();
    let mut elastic = ShellStiffness::ZERO;
    for point in &points {
        squared(&point.membrane, &C, h * point.weight, &mut elastic.N);
        squared(&point.bending, &C, h.powi(3) / 12.0 * point.weight, &mut elastic.M);
    }
    let stiff = plate.drilling * plate.shear_modulus() * h * surface.area;
    // Constant stress does not resist the drilling of straight edges; this stiffness keeps their nodes from drilling freely.
    let edges = from_fn(|i| if (P..P + N).contains(&i) && bulge[i - P] == 0.0 { stiff * UNEVEN } else { 0.0 });
    let drilling = Drilling { stiffness: stiff, rows: K::drilling(surface, bulge), edges };
    drilling.add_to(&mut elastic.N);
    InPlaneSection { elastic, drilling, points }
}

/// Stiffness of the shear strains at the edges, and the bending of the edges.
fn shear_stiffness<K: Interpolation<N, V, P>, const N: usize, const V: usize, const P: usize>(
    surface: &ElementSurface<N, V>,
    D: &[Vec3; N],
    plate: &Plate,
) -> ([[f64; N]; N], EdgeBending<f64, N>) {
    let (h, G) = (plate.thickness, plate.shear_modulus());
    let (bent, left, mut shear) = if K::EDGES_BEND {
        let squared = 2.0 / (SHEAR_FACTOR * (1.0 - plate.nu)) * h * h;
        edge_bubbles::<K, N, V, P>(surface, &(plate.plane_stress() * h.powi(3) / 12.0), squared)
    } else {
        let turn = most_turn(&surface.X, D, K::EDGES) / h;
        let flexibility = K::FLEXIBILITY * turn * turn / (1.0 + turn * turn);
        let left = K::EDGES.map(|[a, b]| {
            let length = (surface.X[b] - surface.X[a]).norm_squared();
            let span = length.min(surface.area * surface.area / length);
            h / (h * h + flexibility * span).sqrt()
        });
        (EdgeBending::NONE, left, [[0.0; N]; N])
    };
    for point in &surface.points {
        let edges = K::shear(point.at);
        let w = SHEAR_FACTOR * G * h * point.weight;
        for i in point.inverse {
            let Z: [f64; N] = from_fn(|e| left[e] * (i[0] * edges[0][e] + i[1] * edges[1][e]));
            for a in 0..N {
                for b in 0..N {
                    shear[a][b] += w * Z[a] * Z[b];
                }
            }
        }
    }
    (shear, bent)
}
