//! Quantities computed once from the undeformed geometry of curved elements.

use super::kinematics::{CurvedShell, CurvedShells, CurvedStrain};
use super::sampling::CurvedStrains;
use super::surface::{CurvedSurface, tangents};
use crate::elements::block::ElementBlock;
use crate::elements::heat::Heat;
use crate::elements::shell::geometry::{Plate, SHEAR_FACTOR, ShellGeometry, squared};
use crate::elements::shell::layers::{LayerModel, LayerPack};
use crate::elements::shell::nodal_vectors::NodalVectors;
use crate::elements::shell::section::{Drilling, InPlaneSection, ShellStiffness, StiffnessPack};
use base::math::Vec3;
use base::math::curved_faces::{CurvedFace, NineNodes, SixNodes};
use std::array::from_fn;
use std::marker::PhantomData;
use std::sync::LazyLock;

/// Drilling stiffness of each node, relative to that of the element over its number of nodes. It keeps a node under a moment from turning
/// about its normal during iteration. Ten times more stiffens coarse meshes of very thin twisted surfaces.
const OF_NODES: f64 = 0.1;

static OF_SIX: LazyLock<[[[f64; 6]; 2]; 6]> = LazyLock::new(|| SixNodes::NODES.map(SixNodes::slopes));
static OF_NINE: LazyLock<[[[f64; 9]; 2]; 9]> = LazyLock::new(|| NineNodes::NODES.map(NineNodes::slopes));

/// Curved shapes whose slopes at the nodes are known.
pub trait SlopesAtNodes<const N: usize> {
    /// The slopes along r and s at the nodes, by the nodes.
    fn at_nodes() -> &'static [[[f64; N]; 2]; N];
}

impl SlopesAtNodes<6> for SixNodes {
    fn at_nodes() -> &'static [[[f64; 6]; 2]; 6] {
        &OF_SIX
    }
}

impl SlopesAtNodes<9> for NineNodes {
    fn at_nodes() -> &'static [[[f64; 9]; 2]; 9] {
        &OF_NINE
    }
}

impl<K, const N: usize, const V: usize, const P: usize, const Q: usize> CurvedShells<K, N, V, P, Q>
where
    K: CurvedStrains<N, V, P, Q> + SlopesAtNodes<N>,
{
    /// Elastic shells. `x`: positions of all nodes at t = 0; `damping`: factor of stiffness-proportional damping (time).
    pub fn new<'a>(
        elements: impl Iterator<Item = ShellGeometry<'a>>,
        x: &[Vec3],
        plate: &Plate,
        damping: f64,
    ) -> CurvedShells<K, N, V, P, Q> {
        let mut section = |of: InPlaneSection<P, P>| StiffnessPack::gather(|_| &of.elastic);
        let elements = elements.map(|e| shell::<K, N, V, P, Q, _>(&e, x, plate, &mut section)).collect();
        CurvedShells { elements, history: 0, damping, heat: None, shape: PhantomData }
    }
}

impl LayerModel {
    /// Curved shells whose layers yield. `x`: positions of all nodes at t = 0; `damping`: factor of stiffness-proportional damping
    /// (time).
    pub fn curved_shells<'a, K, const N: usize, const V: usize, const P: usize, const Q: usize>(
        &self,
        elements: impl Iterator<Item = ShellGeometry<'a>>,
        x: &[Vec3],
        (plate, heat): (&Plate, &Heat),
        damping: f64,
    ) -> Box<dyn ElementBlock>
    where
        K: CurvedStrains<N, V, P, Q> + SlopesAtNodes<N>,
    {
        let layers = self.layers(plate.thickness);
        let mut history = 0;
        let mut section = |of: InPlaneSection<P, P>| {
            let first = history;
            history += layers.history(of.points.len());
            LayerPack::<P, P, f64>::new(&layers, &[(&of, first)])
        };
        let elements = elements.map(|e| shell::<K, N, V, P, Q, _>(&e, x, plate, &mut section)).collect();
        let shells = CurvedShells::<K, N, V, P, Q, _> { elements, history, damping, heat: None, shape: PhantomData };
        Box::new(shells.heated(heat, x))
    }
}

/// An undeformed element.
fn shell<K, const N: usize, const V: usize, const P: usize, const Q: usize, S>(
    e: &ShellGeometry,
    x: &[Vec3],
    plate: &Plate,
    section: &mut impl FnMut(InPlaneSection<P, P>) -> S,
) -> CurvedShell<N, V, P, Q, S>
where
    K: CurvedStrains<N, V, P, Q> + SlopesAtNodes<N>,
{
    let plate = &e.plate(plate);
    let nodes: [usize; N] = from_fn(|a| e.nodes[a]);
    let D: [Vec3; N] = from_fn(|a| e.normals[a]);
    let surface = CurvedSurface::new::<K>(from_fn(|a| x[nodes[a]] - x[nodes[0]]));
    let in_plane = in_plane::<K, N, V, P, Q>(&surface, plate);
    let area: f64 = in_plane.points.iter().map(|point| point.weight).sum();
    let stiff = plate.drilling * plate.shear_modulus() * plate.thickness * area;
    let T = measures::<K, N>(&surface);
    let mut shell = CurvedShell {
        nodes,
        D,
        T,
        sampling: K::sampling(&surface, plate.thickness),
        at_nodes: K::at_nodes(),
        start: CurvedStrain::ZERO,
        shear: shear_stiffness::<K, N, V, P, Q>(&surface, plate),
        drilling: [OF_NODES * stiff / N as f64, stiff / (N * N) as f64],
        heat: None,
        section: section(in_plane),
    };
    shell.start = shell.measure(&NodalVectors { x: surface.X, triads: [D, T.map(|t| t[0]), T.map(|t| t[1])] });
    shell
}

/// The vectors p, q of the nodes: ½ (t₁·x,₂ − t₂·x,₁) = ½ (x,r·p + x,s·q). None where the surface has no normal.
fn measures<K: CurvedFace<N>, const N: usize>(surface: &CurvedSurface<N>) -> [[Vec3; 2]; N] {
    from_fn(|a| {
        let by = tangents::<K, N>(&surface.X, K::NODES[a]);
        let across = by[0].cross(&by[1]);
        /// Sine of the angle between the coordinates below which they give no plane.
        const FLAT: f64 = 1e-3;
        if across.norm() <= FLAT * by[0].norm() * by[1].norm() {
            return [Vec3::zeros(); 2];
        }
        let [t1, t2] = surface.turned(&across.normalize());
        let [[a, b], [c, d]] = surface.point::<K>(K::NODES[a]).inverse;
        [c * t1 - a * t2, d * t1 - b * t2]
    })
}

/// The stiffness of an element in its plane, without drilling.
fn in_plane<K, const N: usize, const V: usize, const P: usize, const Q: usize>(
    surface: &CurvedSurface<N>,
    plate: &Plate,
) -> InPlaneSection<P, P>
where
    K: CurvedStrains<N, V, P, Q>,
{
    let h = plate.thickness;
    let points = K::strains(surface, plate);
    let C = plate.plane_stress();
    let mut elastic = ShellStiffness::ZERO;
    for point in &points {
        squared(&point.membrane, &C, h * point.weight, &mut elastic.N);
        squared(&point.bending, &C, h.powi(3) / 12.0 * point.weight, &mut elastic.M);
    }
    let drilling = Drilling { stiffness: 0.0, rows: [[0.0; P]; 2], edges: [0.0; P] };
    InPlaneSection { elastic, drilling, points }
}

/// Stiffness of the transverse shears.
fn shear_stiffness<K: CurvedStrains<N, V, P, Q>, const N: usize, const V: usize, const P: usize, const Q: usize>(
    surface: &CurvedSurface<N>,
    plate: &Plate,
) -> [[f64; Q]; Q] {
    let mut shear = [[0.0; Q]; Q];
    for &(at, w) in K::RULE {
        let (point, rows) = (surface.point::<K>(at), K::shear(at));
        let w = SHEAR_FACTOR * plate.shear_modulus() * plate.thickness * w * point.area;
        for i in point.inverse {
            let Z: [f64; Q] = from_fn(|q| i[0] * rows[0][q] + i[1] * rows[1][q]);
            for a in 0..Q {
                (0..Q).for_each(|b| shear[a][b] += w * Z[a] * Z[b]);
            }
        }
    }
    shear
}
