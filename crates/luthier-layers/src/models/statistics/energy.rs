//! Energies of the statistical models: FGD-infinity and total reflection, computed or read.

use std::array::from_fn;
use std::sync::Arc;

use luthier_optics::albedo::{ALPHA_MIN, Effort, FacetStatistics, ReflectanceCurves, crossed_albedo};
use luthier_optics::color::Color;
use luthier_optics::interface::{self, Interface, Sampled};
use luthier_optics::interpolation::cubic_stencil;
use luthier_optics::microsurface::TransparentFacets;
use luthier_optics::stack::{Base, Distribution, Stack, Surface};

use super::total_reflection::escaping_share;
use crate::formulas::refraction::REFRACTION_WAVELENGTH_NM;
use crate::layers::Layers;
use crate::monochrome::{Monochrome, MonochromeBelow, MonochromeLayer};

/// Source of the energies of a stack, in `C` channels.
///
/// A closure `(layer, cos_theta_i, alpha) -> reflectance` is a source for a single channel.
pub trait Energy<const C: usize> {
    /// FGD-infinity: the part of light at `cos_theta_i` that the interface of a layer (counted from the top) returns upward, after all bounces between
    /// its facets. `alpha` is the isotropic slope parameter of the layer.
    fn fgd(&self, layer: usize, cos_theta_i: f64, alpha: f64) -> [f64; C];

    /// TIR, see [`escaping_share`]. The lobe lies in the medium below the interface of `layer`, and meets that interface.
    fn escaping(&self, _layer: usize, cos_theta_i: f64, alpha: f64, eta: f64) -> f64 {
        escaping_share(cos_theta_i, alpha, eta)
    }
}

impl<F: Fn(usize, f64, f64) -> f64> Energy<1> for F {
    fn fgd(&self, layer: usize, cos_theta_i: f64, alpha: f64) -> [f64; 1] {
        [self(layer, cos_theta_i, alpha)]
    }
}

/// Below this alpha, nodes have the difference to a smooth interface, which vanishes with alpha: cubics would blur the kinks and fringes of
/// FGD-infinity itself. FGD-infinity of rougher surfaces has none, and is in the nodes.
const NEARLY_SMOOTH: f64 = 0.025;

/// Fineness of the computation of FGD-infinity. Of pairs, the first is for reflectances without a kink of total reflection, the second for those
/// with one.
#[derive(Debug, Clone, Copy)]
struct Detail {
    /// Intervals over the cosine. Between nodes, FGD-infinity is a cubic.
    intervals: [usize; 2],
    /// Effort of the quadrature and the walks at a node.
    effort: [Effort; 2],
    /// Walks per node with light that crosses the interface and comes back. Wavelengths share them.
    crossed_walks: [u32; 2],
    /// Least number of such walks for a wavelength.
    crossed_walks_min: u32,
}

/// Detail for models evaluated wavelength by wavelength; within 2e-3, see [`ExactEnergy`].
const QUICK: Detail = Detail {
    intervals: [32, 96],
    effort: [Effort { first: 24, later: 20 }, Effort { first: 64, later: 32 }],
    crossed_walks: [128, 512],
    crossed_walks_min: 128,
};

/// Detail for energies with which tables are compared.
const FINE: Detail = Detail {
    intervals: [64, 96],
    effort: [Effort { first: 48, later: 64 }, Effort { first: 64, later: 48 }],
    crossed_walks: [4096, 4096],
    crossed_walks_min: 256,
};

/// FGD-infinity of every interface of a stack at one wavelength, computed from the micro-surface.
///
/// Smooth interfaces are exact. Rough ones are computed at 33 cosines and joined by cubics, within 2e-3 of a direct computation. From the denser
/// side there are 97 cosines, and the error is within 2e-2. Right beside the critical angle it may be 0.2 for alpha below 0.025.
#[derive(Debug, Clone)]
pub struct ExactEnergy {
    layers: Vec<LayerEnergy>,
}

#[derive(Debug, Clone)]
struct LayerEnergy {
    interface: MonochromeLayer,
    /// FGD-infinity at each node, less the smooth reflectance if the surface is nearly smooth; empty for smooth surfaces.
    nodes: Vec<[f64; 1]>,
}

impl ExactEnergy {
    /// The energies of a stack.
    pub fn new(stack: &Monochrome) -> Self {
        Self::with_facets(stack, &mut FacetCache::default())
    }

    /// The energies of a stack. Stacks at other wavelengths may share `facets`, which depend on the micro-surface alone.
    pub fn with_facets(stack: &Monochrome, facets: &mut FacetCache) -> Self {
        Self { layers: stack.layers.iter().map(|layer| LayerEnergy::new(layer, facets)).collect() }
    }
}

impl Energy<1> for ExactEnergy {
    fn fgd(&self, layer: usize, cos_theta_i: f64, _alpha: f64) -> [f64; 1] {
        [self.layers.get(layer).map_or(0.0, |l| l.fgd(cos_theta_i.clamp(0.0, 1.0)))]
    }
}

/// FGD-infinity of every interface of a stack in colour: the sum of [`ExactEnergy`] over the wavelengths of a colour mode. Slope parameters are
/// those of shaders ([`Layers::rgb`]).
///
/// Computed at 65 cosines (97 from the denser side), within 5e-4 of a direct computation from above, and within 2e-2 from the denser
/// side.
#[derive(Debug, Clone)]
pub struct ColorEnergy {
    layers: Vec<Option<ColorLayer>>,
}

#[derive(Debug, Clone)]
struct ColorLayer {
    interface: Sampled,
    nearly_smooth: bool,
    nodes: Vec<[f64; 3]>,
}

impl ColorEnergy {
    /// Computes the energies of a stack, which takes up to some seconds for spectra of films.
    pub fn new(stack: &Stack, color: Color) -> Self {
        let mut facets = FacetCache { detail: FINE, surfaces: Vec::new() };
        let shader = Layers::rgb(stack);
        let layers = (0..stack.layers.len()).map(|i| {
            let interface = Interface::of(stack, i)?;
            let bent = interface.eta_under_films(REFRACTION_WAVELENGTH_NM);
            let transparent = matches!(stack.layers[i].base, Base::Dielectric { .. });
            let sampled = interface.sampled(&color);
            Some(ColorLayer::new(sampled, transparent, bent, &shader.layers[i].surface, &mut facets))
        });
        Self { layers: layers.collect() }
    }
}

impl ColorLayer {
    /// `bent` is the relative index that bends light, where it is not that by which the interface reflects.
    fn new(
        interface: Sampled,
        transparent: bool,
        bent: Option<f64>,
        surface: &Surface,
        facets: &mut FacetCache,
    ) -> Self {
        let curves = ReflectanceCurves::new(interface.nodes.len(), |k, cos| interface.nodes[k].1.reflectance(cos));
        let ones = interface.nodes.iter().map(|(_, one)| one);
        let eta = |one: &interface::Monochrome| bent.unwrap_or(one.below.re / one.above.re);
        let etas: Vec<Option<f64>> = ones.map(|one| transparent.then(|| eta(one))).collect();
        let nearly_smooth = surface.alpha_isotropic() < NEARLY_SMOOTH;
        let nodes = albedo_nodes(surface, &curves, &etas, facets)
            .map(|(cos, albedos)| {
                let smooth = if nearly_smooth { interface.rgb(cos) } else { [0.0; 3] };
                [0, 1, 2].map(|c: usize| {
                    let sum: f64 = interface.nodes.iter().zip(&albedos).map(|((w, _), albedo)| w[c] * albedo).sum();
                    sum - smooth[c]
                })
            })
            .collect();
        Self { interface, nearly_smooth, nodes }
    }
}

impl Energy<3> for ColorEnergy {
    fn fgd(&self, layer: usize, cos_theta_i: f64, _alpha: f64) -> [f64; 3] {
        let Some(Some(layer)) = self.layers.get(layer) else { return [0.0; 3] };
        let cos_theta_i = cos_theta_i.clamp(0.0, 1.0);
        let smooth = if layer.nearly_smooth { layer.interface.rgb(cos_theta_i) } else { [0.0; 3] };
        let between = between_nodes(&layer.nodes, cos_theta_i);
        [0, 1, 2].map(|c: usize| between[c] + smooth[c])
    }
}

/// The energies of shaders without tables: Fresnel's reflectance at the mean direction, at three wavelengths, films included.
///
/// In place of FGD-infinity, facets count as level, and no part of a lobe is totally reflected, as in Unity's StackLit. Smooth interfaces are exact.
/// For rough interfaces the reflectance at grazing angles lacks that of tilted facets, and slabs absorb less because no light is kept in them.
#[derive(Debug, Clone, PartialEq)]
pub struct FresnelEnergy {
    interfaces: Vec<Option<[interface::Monochrome; 3]>>,
}

impl FresnelEnergy {
    /// The energies of a stack at three wavelengths.
    pub fn new(stack: &Stack, wavelengths_nm: [f64; 3]) -> Self {
        let interfaces = (0..stack.layers.len()).map(|i| Interface::of(stack, i));
        let at = interfaces.map(|one| one.map(|one| [0, 1, 2].map(|c: usize| one.at(wavelengths_nm[c], c))));
        Self { interfaces: at.collect() }
    }
}

impl Energy<3> for FresnelEnergy {
    fn fgd(&self, layer: usize, cos_theta_i: f64, _alpha: f64) -> [f64; 3] {
        match self.interfaces.get(layer) {
            Some(Some(interfaces)) => [0, 1, 2].map(|c: usize| interfaces[c].reflectance(cos_theta_i)),
            _ => [0.0; 3],
        }
    }

    fn escaping(&self, _: usize, _: f64, _: f64, _: f64) -> f64 {
        1.0
    }
}

impl LayerEnergy {
    fn new(layer: &MonochromeLayer, facets: &mut FacetCache) -> Self {
        let interface = layer.clone();
        let alpha = layer.surface.alpha_isotropic();
        if alpha < ALPHA_MIN || matches!(layer.below, MonochromeBelow::Diffuse { .. }) {
            return Self { interface, nodes: Vec::new() };
        }
        let etas = [matches!(layer.below, MonochromeBelow::Dielectric { .. }).then(|| layer.eta())];
        let curve = ReflectanceCurves::new(1, |_, cos| layer.reflectance(cos));
        let nodes = albedo_nodes(&layer.surface, &curve, &etas, facets)
            .map(|(cos, albedo)| [albedo[0] - smooth_part(layer, cos)])
            .collect();
        Self { interface, nodes }
    }

    fn fgd(&self, cos_theta_i: f64) -> f64 {
        if self.nodes.is_empty() {
            return self.interface.reflectance(cos_theta_i);
        }
        let [between] = between_nodes(&self.nodes, cos_theta_i);
        (between + smooth_part(&self.interface, cos_theta_i)).clamp(0.0, 1.0)
    }
}

/// Cosine and FGD-infinity of each curve at every node of a rough surface. `etas` has, for each curve of a transparent interface, the index below
/// over the index above.
fn albedo_nodes(
    surface: &Surface,
    curves: &ReflectanceCurves,
    etas: &[Option<f64>],
    facets: &mut FacetCache,
) -> impl Iterator<Item = (f64, Vec<f64>)> {
    let (distribution, alpha) = (surface.distribution, surface.alpha_isotropic());
    let kinked = etas.iter().flatten().any(|&eta| eta < 1.0);
    let Detail { crossed_walks, crossed_walks_min, .. } = facets.detail;
    let walks = (crossed_walks[usize::from(kinked)] / etas.len() as u32).max(crossed_walks_min);
    let facets = facets.nodes(distribution, alpha, kinked);
    (0..facets.len()).map(move |i| {
        let cos = node(i, facets.len());
        let mut albedos = facets[i].albedo(curves);
        for (curve, (albedo, eta)) in albedos.iter_mut().zip(etas).enumerate() {
            if let Some(eta) = *eta {
                let transparent = TransparentFacets { eta, from_above: |cos| curves.at(curve, cos) };
                *albedo += crossed_albedo(distribution, alpha, transparent, cos, walks, 1);
            }
        }
        (cos, albedos)
    })
}

/// Lagrange's cubic through the four nodes around a cosine in 0..=1.
fn between_nodes<const C: usize>(nodes: &[[f64; C]], cos_theta_i: f64) -> [f64; C] {
    let (first, weights) = cubic_stencil(cos_theta_i.sqrt() * (nodes.len() - 1) as f64, nodes.len());
    from_fn(|c| weights.iter().zip(&nodes[first..]).map(|(w, value)| w * value[c]).sum())
}

/// Part of the energy of an interface outside its nodes: the smooth reflectance of a nearly smooth one.
fn smooth_part(interface: &MonochromeLayer, cos_theta_i: f64) -> f64 {
    if interface.surface.alpha_isotropic() < NEARLY_SMOOTH { interface.reflectance(cos_theta_i) } else { 0.0 }
}

/// Cosine of a node. Nodes gather at grazing angles.
fn node(i: usize, count: usize) -> f64 {
    let u = i as f64 / (count - 1) as f64;
    u * u
}

/// Facet statistics of micro-surfaces at all nodes. The energies of any interface with such a surface follow from them.
#[derive(Debug, Clone)]
pub struct FacetCache {
    detail: Detail,
    surfaces: Vec<FacetNodes>,
}

impl Default for FacetCache {
    fn default() -> Self {
        Self { detail: QUICK, surfaces: Vec::new() }
    }
}

#[derive(Debug, Clone)]
struct FacetNodes {
    distribution: Distribution,
    alpha: f64,
    kinked: bool,
    nodes: Arc<[FacetStatistics]>,
}

impl FacetCache {
    fn nodes(&mut self, distribution: Distribution, alpha: f64, kinked: bool) -> Arc<[FacetStatistics]> {
        let mut surfaces = self.surfaces.iter();
        if let Some(known) = surfaces.find(|s| s.distribution == distribution && s.alpha == alpha && s.kinked == kinked)
        {
            return Arc::clone(&known.nodes);
        }
        let Detail { effort, intervals, .. } = self.detail;
        let (effort, intervals) = (effort[usize::from(kinked)], intervals[usize::from(kinked)]);
        let cosines = (0..=intervals).map(|i| node(i, intervals + 1));
        let nodes: Arc<[FacetStatistics]> =
            cosines.map(|cos| FacetStatistics::new(distribution, alpha, cos, effort, 0)).collect();
        self.surfaces.push(FacetNodes { distribution, alpha, kinked, nodes: Arc::clone(&nodes) });
        nodes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use luthier_optics::ior::Ior;
    use luthier_optics::stack;
    use num_complex::Complex64;

    fn interface(alpha: f64, above: f64, below: MonochromeBelow) -> Monochrome {
        let surface = Surface::isotropic(Distribution::Ggx, alpha);
        Monochrome::joined(above, Monochrome::bare(&[(surface, below)]).layers)
    }

    fn glass(ior: f64) -> MonochromeBelow {
        MonochromeBelow::dielectric(ior, 0.0)
    }

    #[test]
    fn nodes_and_cubics_agree_with_direct_walks() {
        // Oracle: fresh statistics at three times the points and other seeds, at cosines off the nodes.
        let metal = MonochromeBelow::Conductor { ior: Complex64::new(0.2, 3.0) };
        for (alpha, above, below, tolerance) in [
            (0.1, 1.0, glass(1.5), 2e-3),
            (0.5, 1.0, glass(1.5), 2e-3),
            (0.9, 1.0, metal, 2e-3),
            (0.02, 1.0, metal, 2e-3),
            (0.3, 1.5, glass(1.0), 1e-2),
            (0.06, 1.5, glass(1.0), 1e-2),
            (0.03, 1.5, glass(1.0), 2e-2),
        ] {
            let stack = interface(alpha, above, below);
            let layer = &stack.layers[0];
            let energy = ExactEnergy::new(&stack);
            let curve = ReflectanceCurves::new(1, |_, cos| layer.reflectance(cos));
            for cos in [0.02, 0.11, 0.37, 0.69, 0.74, 0.93] {
                let statistics =
                    FacetStatistics::new(Distribution::Ggx, alpha, cos, Effort { first: 96, later: 48 }, 7);
                let facets = TransparentFacets { eta: layer.eta(), from_above: |cos| curve.at(0, cos) };
                let crossed = match below {
                    MonochromeBelow::Dielectric { .. } => {
                        crossed_albedo(Distribution::Ggx, alpha, facets, cos, 2048, 9)
                    }
                    _ => 0.0,
                };
                let expected = statistics.albedo(&curve)[0] + crossed;
                let [got] = energy.fgd(0, cos, alpha);
                assert!((got - expected).abs() < tolerance, "{alpha} {above} {cos}: {got} against {expected}");
            }
        }
    }

    /// Oracle: twice the points for the first bounce, three times the later walks, five times the crossing walks, other seeds, at
    /// cosines off the nodes.
    #[test]
    fn colour_energies_agree_with_direct_walks() {
        const TOLERANCE: f64 = 5e-4;
        let layer = |alpha, base| {
            let surface = Surface::isotropic(Distribution::Ggx, alpha);
            stack::Layer { films: Vec::new(), surface, base }
        };
        let slab = stack::Slab { thickness_um: 0.0, absorption_per_um: [0.0; 3] };
        let glass = || Base::Dielectric { ior: Ior::constant(1.5, 0.0).unwrap(), slab };
        let metal = || Base::Conductor { ior: Ior::constant(0.2, 3.0).unwrap() };
        for base in [glass(), metal()] {
            for alpha in [0.01, 0.3, 1.0] {
                let stack = Stack { exterior: Ior::vacuum(), layers: vec![layer(alpha, base.clone())] };
                let energy = ColorEnergy::new(&stack, Color::Spectral);
                let one = Monochrome::new(&stack, 550.0, 1);
                let curve = ReflectanceCurves::new(1, |_, cos| one.layers[0].reflectance(cos));
                for cos in [0.003, 0.02, 0.11, 0.37, 0.74, 0.93] {
                    let effort = Effort { first: 96, later: 56 };
                    let estimate =
                        |seed| FacetStatistics::new(Distribution::Ggx, alpha, cos, effort, seed).albedo(&curve)[0];
                    let mut expected = (7..11).map(estimate).sum::<f64>() / 4.0;
                    if matches!(stack.layers[0].base, Base::Dielectric { .. }) {
                        let facets = TransparentFacets { eta: 1.5, from_above: |cos| curve.at(0, cos) };
                        expected += crossed_albedo(Distribution::Ggx, alpha, facets, cos, 20_000, 9);
                    }
                    let [_, got, _] = energy.fgd(0, cos, alpha);
                    let error = (got - expected).abs();
                    eprintln!("{alpha} {cos}: {error:.1e}");
                    assert!(error < TOLERANCE, "{alpha} {cos}: {got} against {expected}");
                }
            }
        }
    }

    /// The roughest surfaces take the most walks, seen from the denser side too: they must not outnumber their random numbers.
    #[test]
    fn the_roughest_surfaces_can_be_prepared() {
        let slab = stack::Slab { thickness_um: 0.0, absorption_per_um: [0.0; 3] };
        for distribution in [Distribution::Beckmann, Distribution::Ggx] {
            let surface = Surface::isotropic(distribution, 1.0);
            let layer = |n| stack::Layer {
                films: Vec::new(),
                surface,
                base: Base::Dielectric { ior: Ior::constant(n, 0.0).unwrap(), slab },
            };
            let stack = Stack { exterior: Ior::vacuum(), layers: vec![layer(1.5), layer(1.1)] };
            let energy = ColorEnergy::new(&stack, Color::Spectral);
            for cos in [0.0, 0.3, 1.0] {
                let [above, below] = [0, 1].map(|l| energy.fgd(l, cos, 1.0)[0]);
                assert!(above > 0.0 && above < below && below < 1.0, "{distribution:?} {cos}: {above} {below}");
            }
        }
    }

    #[test]
    fn smooth_interfaces_are_fresnel() {
        let stack = interface(0.0, 1.0, glass(1.5));
        for cos in [0.0, 0.3, 1.0] {
            assert_eq!(ExactEnergy::new(&stack).fgd(0, cos, 0.0), [stack.layers[0].reflectance(cos)]);
        }
        assert_eq!(ExactEnergy::new(&stack).fgd(7, 0.5, 0.0), [0.0]);
    }
}
