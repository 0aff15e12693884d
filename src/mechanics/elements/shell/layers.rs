//! Shells of layers in plane stress; the layers yield and have separate history variables. Strain of the reference surface is Green's, or
//! logarithmic, see [`super::stretch`], and curvature adds to it. Transverse shear stays elastic until all layers have failed.

use super::in_plane::{InPlane, LinearisedPlane, product, subtract};
use super::plane_strains::PointStrains;
use super::section::{Drilling, InPlaneSection, NewHistory, ShellSections, StiffnessPack};
use super::stretch::Stretch;
use crate::elements::block::Moduli;
use crate::elements::results::LayerStress;
use crate::materials::{Ask, MaterialLaw, PlaneStress};
use crate::state::Configuration;
use base::math::lanes::{LANES, by_lane};
use base::math::number::Number;
use base::math::quadrature;
use std::array::from_fn;
use std::ops::Range;
use std::sync::Arc;

/// The layers of a shell whose material yields.
#[derive(Debug, Clone)]
pub struct LayerModel {
    /// The law of the layers.
    pub law: MaterialLaw,
    /// The number of points through the thickness, at most [`super::MOST_LAYERS`]: up to five of Gauss, beyond that those of
    /// [`quadrature::kinked`].
    pub layers: usize,
    /// Strain of the reference surface is logarithmic, not Green's: see the file `stretch.rs`.
    pub logarithmic: bool,
}

impl LayerModel {
    /// The layers of a given thickness.
    pub(super) fn layers(&self, thickness: f64) -> Arc<Layers> {
        let points: Vec<(f64, f64)> = match self.layers {
            n @ ..=5 => {
                let (points, weights) = quadrature::gauss(n);
                points.iter().copied().zip(weights.iter().copied()).collect()
            }
            n => quadrature::kinked(n),
        };
        let half = 0.5 * thickness;
        Arc::new(Layers {
            law: self.law.clone(),
            at: points.iter().map(|(z, w)| [half * z, half * w]).collect(),
            variables: self.law.history(PlaneStress),
            stiffness: self.law.stiffness(PlaneStress),
            thickness,
            logarithmic: self.logarithmic,
        })
    }
}

/// The layers and their law, shared by all elements of a part.
pub struct Layers {
    law: MaterialLaw,
    /// Height above the reference surface, and thickness, of each layer.
    at: Vec<[f64; 2]>,
    /// The number of history variables of a layer.
    variables: usize,
    /// ∂stress/∂strain of a layer that does not yield.
    stiffness: [[f64; 3]; 3],
    /// The thickness of all layers together.
    thickness: f64,
    /// Strain of the reference surface is logarithmic, see [`Stretch`].
    logarithmic: bool,
}

/// The layered sections of one element, or of eight side by side.
pub struct LayerPack<const P: usize, const E: usize, T> {
    layers: Arc<Layers>,
    elastic: StiffnessPack<P, E, T>,
    drilling: Drilling<E, T>,
    /// Integration points. An element that has fewer than others of its pack repeats the last with no area.
    points: Vec<PointPack<P, E, T>>,
    /// The number of points of each element.
    counts: [usize; LANES],
    /// Starts of their ranges in the history of the group.
    first: [usize; LANES],
}

/// An integration point of one element, or of eight.
struct PointPack<const P: usize, const E: usize, T> {
    /// Rows of the strain of the reference surface by the numbers of the membrane.
    membrane: [[T; E]; 3],
    /// Rows of curvature by the numbers of bending.
    bending: [[T; P]; 3],
    /// Area.
    weight: T,
}

/// The strain at a point of the reference surface.
struct PointState<T> {
    /// Green's strain, or logarithmic strain.
    strain: [T; 3],
    curvature: [T; 3],
    /// `None` where strain is Green's.
    stretch: Option<Stretch<T>>,
}

/// The resultants of a section, and what their derivatives lose by yielding: moments over the layers.
struct Resultants<T> {
    N: [T; 3],
    M: [T; 3],
    /// The losses of N, NM and M are the moments of the loss with z⁰, z¹ and z².
    loss: [[[T; 3]; 3]; 3],
    yields: bool,
}

/// The results of the layers beyond the stress.
enum LayersAsk<'a, const P: usize, const E: usize, T> {
    Stress,
    Tangent(&'a mut LinearisedPlane<P, E, T>),
    History(NewHistory<'a, T>),
}

impl<T: Number> PointState<T> {
    /// The strain of a layer.
    #[inline(always)]
    fn at(&self, z: f64) -> [T; 3] {
        from_fn(|i| self.strain[i] + T::splat(z) * self.curvature[i])
    }
}

impl<const P: usize, const E: usize, T: Number> PointPack<P, E, T> {
    fn new<'a>(point: impl Fn(usize) -> (&'a PointStrains<P, E>, bool)) -> Self {
        PointPack {
            membrane: from_fn(|i| from_fn(|m| T::gather(|lane| point(lane).0.membrane[(i, m)]))),
            bending: from_fn(|i| from_fn(|m| T::gather(|lane| point(lane).0.bending[(i, m)]))),
            weight: T::gather(|lane| if point(lane).1 { point(lane).0.weight } else { 0.0 }),
        }
    }

    /// Strain of Green and curvature.
    #[inline(always)]
    fn strain(&self, strain: &InPlane<P, E, T>) -> [[T; 3]; 2] {
        [
            from_fn(|i| product(&self.membrane[i], &strain.membrane)),
            from_fn(|i| product(&self.bending[i], &strain.bending)),
        ]
    }

    /// The strain that layers have.
    #[inline(always)]
    fn state(&self, strain: &InPlane<P, E, T>, logarithmic: bool) -> PointState<T> {
        let [e, curvature] = self.strain(strain);
        let stretch = logarithmic.then(|| Stretch::new(&e));
        PointState { strain: stretch.as_ref().map_or(e, |stretch| stretch.strain), curvature, stretch }
    }

    /// Adds to the stress of the element that of the point.
    #[inline(always)]
    fn add(&self, Resultants { N, M, .. }: &Resultants<T>, state: &PointState<T>, stress: &mut InPlane<P, E, T>) {
        let N = state.stretch.as_ref().map_or(*N, |stretch| stretch.conjugate(N));
        let [N, M] = [N, *M].map(|part| part.map(|s| self.weight * s));
        (0..E).for_each(|m| stress.membrane[m] += product(&from_fn(|i| self.membrane[i][m]), &N));
        (0..P).for_each(|m| stress.bending[m] += product(&from_fn(|i| self.bending[i][m]), &M));
    }

    /// Subtracts the stiffness lost by yielding at the point.
    #[inline(always)]
    fn subtract(&self, Resultants { loss, yields, .. }: &Resultants<T>, out: &mut LinearisedPlane<P, E, T>) {
        let loss = loss.map(|loss| loss.map(|row| row.map(|lost| self.weight * lost)));
        subtract(&self.membrane, &loss[0], &self.membrane, &mut out.N);
        if *yields {
            out.coupled = true;
            subtract(&self.membrane, &loss[1], &self.bending, &mut out.NM);
            subtract(&self.bending, &loss[2], &self.bending, &mut out.M);
        }
    }
}

impl<T: Number> Resultants<T> {
    const ZERO: Self = Resultants { N: [T::ZERO; 3], M: [T::ZERO; 3], loss: [[[T::ZERO; 3]; 3]; 3], yields: false };

    /// Adds the stress of a layer.
    #[inline(always)]
    fn add(&mut self, [z, w]: [f64; 2], sigma: &[T; 3]) {
        for i in 0..3 {
            self.N[i] += T::splat(w) * sigma[i];
            self.M[i] += T::splat(w * z) * sigma[i];
        }
    }

    /// Adds the difference between the `elastic` stiffness and the stiffness C of a layer.
    #[inline(always)]
    fn lose(&mut self, [z, w]: [f64; 2], C: &[[T; 3]; 3], elastic: &[[f64; 3]; 3]) {
        self.yields = true;
        let lost: [[T; 3]; 3] = from_fn(|i| from_fn(|j| T::splat(elastic[i][j]) - C[i][j]));
        for (loss, w) in self.loss.iter_mut().zip([w, w * z, w * z * z]) {
            for i in 0..3 {
                (0..3).for_each(|j| loss[i][j] = T::fma(T::splat(w), lost[i][j], loss[i][j]));
            }
        }
    }

    /// The losses of N and NM by logarithmic strain as those by Green's: C − (∂H/∂E)ᵀ (C − loss) ∂H/∂E − N:∂²H/∂E², (∂H/∂E)ᵀ loss. `whole`:
    /// C, the stiffness of all layers before they yield.
    #[inline(always)]
    fn stretched(&mut self, stretch: &Stretch<T>, whole: impl Fn(usize, usize) -> T) {
        let (slopes, curvature) = (stretch.slopes(), stretch.curvature(&self.N));
        let loss = &mut self.loss;
        let half = T::splat(0.5);
        let right: [[T; 3]; 3] =
            from_fn(|j| from_fn(|i| product(&from_fn(|k| whole(i, k) - loss[0][i][k]), &slopes[j])));
        let kept = |i: usize, j: usize| product(&slopes[i], &right[j]) + curvature[j][i];
        loss[0] = from_fn(|i| from_fn(|j| whole(i, j) - half * (kept(i, j) + kept(j, i))));
        loss[1] = from_fn(|i| from_fn(|j| product(&slopes[i], &from_fn(|k| loss[1][k][j]))));
    }
}

impl<const P: usize, const E: usize, T: Number> LayerPack<P, E, T> {
    /// Packs one element or up to eight, each with the start of its range in the history of the group; lanes beyond the last repeat it.
    pub(super) fn new(layers: &Arc<Layers>, of: &[(&InPlaneSection<P, E>, usize)]) -> Self {
        let at = |lane: usize| of[lane.min(of.len() - 1)];
        let counts: [usize; LANES] = from_fn(|lane| at(lane).0.points.len());
        let point = |g: usize| PointPack::new(|lane| (&at(lane).0.points[g.min(counts[lane] - 1)], g < counts[lane]));
        LayerPack {
            layers: Arc::clone(layers),
            elastic: StiffnessPack::gather(|lane| &at(lane).0.elastic),
            drilling: Drilling::gather(|lane| &at(lane).0.drilling),
            points: (0..counts.into_iter().max().unwrap_or(0)).map(point).collect(),
            counts,
            first: from_fn(|lane| at(lane).1),
        }
    }

    /// The start of the history variables of a point.
    #[inline(always)]
    fn place(&self, lane: usize, point: usize) -> usize {
        self.first[lane] + self.layers.history(point.min(self.counts[lane] - 1))
    }

    /// The range of the history of the group that an element has.
    fn history_range(&self, lane: usize) -> Range<usize> {
        self.first[lane]..self.first[lane] + self.layers.history(self.counts[lane])
    }

    /// The stress at a strain, and the further results in `ask`. The derivative is the elastic one, less the loss of yielding layers,
    /// corrected for stretching.
    #[inline(always)]
    fn respond(&self, strain: &InPlane<P, E, T>, now: &Configuration, ask: LayersAsk<P, E, T>) -> InPlane<P, E, T> {
        match self.layers.law.plain() {
            Some(law) => self.by_law(&law, strain, now, ask),
            None => self.by_law(&self.layers.law, strain, now, ask),
        }
    }

    /// As [`LayerPack::respond`], by the law of the layers.
    #[inline(always)]
    fn by_law(
        &self,
        law: &MaterialLaw,
        strain: &InPlane<P, E, T>,
        now: &Configuration,
        mut ask: LayersAsk<P, E, T>,
    ) -> InPlane<P, E, T> {
        let Layers { stiffness, thickness, logarithmic, .. } = &*self.layers;
        let mut stress = InPlane::ZERO;
        stress.membrane = self.drilling.stress(&strain.membrane);
        for (g, point) in self.points.iter().enumerate() {
            let state = point.state(strain, *logarithmic);
            let mut sum = self.through(law, g, &state, now, &mut ask);
            point.add(&sum, &state, &mut stress);
            let LayersAsk::Tangent(out) = &mut ask else { continue };
            if let Some(stretch) = &state.stretch {
                sum.stretched(stretch, |i, j| T::splat(thickness * stiffness[i][j]));
            }
            if sum.yields || state.stretch.is_some() {
                point.subtract(&sum, out);
            }
        }
        stress
    }

    /// The resultants of the layers at an integration point.
    #[inline(always)]
    fn through(
        &self,
        law: &MaterialLaw,
        g: usize,
        state: &PointState<T>,
        now: &Configuration,
        ask: &mut LayersAsk<P, E, T>,
    ) -> Resultants<T> {
        let Layers { at, stiffness, .. } = &*self.layers;
        let asked = match ask {
            LayersAsk::Stress => Ask::Stress,
            LayersAsk::Tangent(_) => Ask::Tangent,
            LayersAsk::History(to) => Ask::History(to.part),
        };
        let variables = law.history(PlaneStress);
        let mut places = by_lane(|lane| self.place(lane, g));
        let mut sum = Resultants::ZERO;
        for &[z, w] in at {
            let place = |lane: usize| places[lane];
            let old = law.recall(PlaneStress, now.history, place);
            let answer = law.respond(PlaneStress, &state.at(z), (now.dt, &old), asked);
            sum.add([z, w], &answer.stress);
            if let Some(C) = &answer.tangent {
                sum.lose([z, w], C, stiffness);
            }
            if let LayersAsk::History(to) = ask {
                law.remember(PlaneStress, &answer.new, (now.history, &mut *to.new), place);
                if let Some(spent) = &answer.dissipation {
                    to.spent.add(spent, T::splat(w) * self.points[g].weight);
                }
            }
            for place in &mut places {
                *place += variables;
            }
        }
        sum
    }

    /// Calls `of` for each layer of an element with its number, [height, thickness, area], its strain and its history variables.
    fn each(
        &self,
        lane: usize,
        strain: &InPlane<P, E>,
        history: &[f64],
        mut of: impl FnMut(usize, [f64; 3], &[f64; 3], &[f64]),
    ) {
        let Layers { at, variables, logarithmic, .. } = &*self.layers;
        let splat = |x: f64| T::splat(x);
        let strain = InPlane { membrane: strain.membrane.map(splat), bending: strain.bending.map(splat) };
        for (g, point) in self.points[..self.counts[lane]].iter().enumerate() {
            let state = point.state(&strain, *logarithmic);
            let history = history[self.place(lane, g)..].chunks_exact(*variables);
            for ((layer, &[z, w]), own) in at.iter().enumerate().zip(history) {
                of(layer, [z, w, point.weight.lane(lane)], &state.at(z).map(|e| e.lane(lane)), own);
            }
        }
    }
}

impl Layers {
    /// The number of history variables of an element with so many integration points.
    pub(super) fn history(&self, points: usize) -> usize {
        points * self.at.len() * self.variables
    }
}

impl<const P: usize, const E: usize, T: Number> ShellSections<P, E, T> for LayerPack<P, E, T> {
    #[inline(always)]
    fn elastic(&self) -> &StiffnessPack<P, E, T> {
        &self.elastic
    }

    fn stress(&self, strain: &InPlane<P, E, T>, now: &Configuration) -> InPlane<P, E, T> {
        self.respond(strain, now, LayersAsk::Stress)
    }

    fn linearise(&self, strain: &InPlane<P, E, T>, now: &Configuration, moduli: Moduli) -> LinearisedPlane<P, E, T> {
        let mut out = self.elastic.linearised();
        out.stress = match moduli {
            Moduli::Algorithmic => self.respond(strain, now, LayersAsk::Tangent(&mut out)),
            Moduli::Elastic => ShellSections::stress(self, strain, now),
        };
        out
    }

    fn advance(&self, strain: &InPlane<P, E, T>, now: &Configuration, to: NewHistory<T>) -> InPlane<P, E, T> {
        self.respond(strain, now, LayersAsk::History(to))
    }

    fn energy(&self, lane: usize, strain: &InPlane<P, E>, now: &Configuration) -> f64 {
        let drilling = self.drilling.stress(&strain.membrane.map(T::splat));
        let mut sum = 0.5 * (0..E).map(|i| drilling[i].lane(lane) * strain.membrane[i]).sum::<f64>();
        self.each(lane, strain, now.history, |_, [_, w, area], strain, own| {
            sum += w * area * self.layers.law.elastic_energy(PlaneStress, strain, own);
        });
        sum
    }

    fn layers(&self, lane: usize, strain: &InPlane<P, E>, now: &Configuration, out: &mut [LayerStress]) -> usize {
        let Layers { law, at, .. } = &*self.layers;
        let out = &mut out[..at.len()];
        out.fill(LayerStress::default());
        let whole: f64 = self.points.iter().map(|point| point.weight.lane(lane)).sum();
        self.each(lane, strain, now.history, |layer, [z, _, area], strain, own| {
            let sigma = law.at_point(PlaneStress, strain, (now.dt, own), Ask::Stress).stress;
            let layer = &mut out[layer];
            layer.z = z;
            (0..3).for_each(|i| layer.stress[i] += area / whole * sigma[i]);
            layer.plastic_strain = layer.plastic_strain.max(law.accumulated(PlaneStress, own));
        });
        at.len()
    }

    fn plastic_strain(&self, lane: usize, history: &[f64]) -> f64 {
        let Layers { law, variables, .. } = &*self.layers;
        let own = history[self.history_range(lane)].chunks_exact(*variables);
        own.map(|own| law.accumulated(PlaneStress, own)).fold(0.0, f64::max)
    }

    fn can_fail(&self) -> bool {
        self.layers.law.can_fail()
    }

    fn surface_strain(&self, strain: &InPlane<P, E, T>) -> Option<(T, bool)> {
        let (half, mut most) = (T::splat(0.5), T::ZERO);
        for point in &self.points {
            let [a, b, shear] = point.strain(strain)[0];
            let (mean, apart, across) = (half * (a + b), half * (a - b), half * shear);
            let radius = (apart * apart + across * across).sqrt();
            let largest = T::select(mean.lt(T::ZERO), mean - radius, mean + radius);
            most = T::select(most.abs().lt(largest.abs()), largest, most);
        }
        Some((most, self.layers.logarithmic))
    }

    fn has_failed(&self, lane: usize, history: &[f64]) -> bool {
        let Layers { law, variables, .. } = &*self.layers;
        let all = |own: &[f64]| own.chunks_exact(*variables).all(|own| law.has_failed(PlaneStress, own));
        law.can_fail() && all(&history[self.history_range(lane)])
    }
}
