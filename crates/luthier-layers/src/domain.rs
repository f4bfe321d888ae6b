//! Stacks outside the domain of a model: the ranges are facts of the model ([`luthier_model::Facts::domain`]).

use luthier_model::{Limit, Quantity, ShadingModel};
use luthier_optics::interface::Interface;
use luthier_optics::stack::{Base, Stack};

use crate::formulas::refraction::REFRACTION_WAVELENGTH_NM;

/// A quantity outside the domain of a model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outside {
    /// Number of the layer, from the top.
    pub layer: usize,
    /// Limit that the quantity breaks.
    pub limit: Limit,
    /// Its value.
    pub value: f64,
}

impl Outside {
    /// The nearest value inside.
    pub fn nearest(&self) -> f64 {
        self.value.clamp(self.limit.least, self.limit.most)
    }
}

/// Limit of the light that comes back through a coat from below, times the ratio of indices. Below the limit the missing 1/n^2 is too faint to warn
/// about. A larger limit would leave out coats that are too bright; a smaller one would warn of dim bases. The metal of the suite is off by 1.0, 1.24
/// and 1.35 at ratios of 2, 2.5 and 4, at which this product is 1.45, 1.53 and 1.50.
const DIM: f64 = 1.0;

/// Light that comes back once from below the dielectric of a layer, at normal incidence, in the channel that absorbs least: `(1 - F)^2 e^(-2 depth) R`.
/// R counts as 1 if the next layer is transparent.
fn returned(stack: &Stack, layer: usize) -> f64 {
    let Some(Base::Dielectric { slab, .. }) = stack.layers.get(layer).map(|here| &here.base) else { return 0.0 };
    let depth = slab.optical_depth().into_iter().fold(f64::INFINITY, f64::min);
    let mut most = 0.0;
    for channel in 0..3 {
        let below = match stack.layers.get(layer + 1).map(|next| &next.base) {
            Some(Base::Conductor { .. }) => mirrored(stack, layer + 1, channel),
            Some(Base::Diffuse(diffuse)) => diffuse.albedo.into_iter().fold(0.0, f64::max),
            Some(Base::Dielectric { .. }) => 1.0,
            None => 0.0,
        };
        let crossed = 1.0 - mirrored(stack, layer, channel);
        most = f64::max(most, crossed * crossed * libm::exp(-2.0 * depth) * below);
    }
    most
}

/// Reflectance of the interface of a layer at normal incidence in a channel. Channels differ only if the interface has an F0: the wavelength is fixed.
fn mirrored(stack: &Stack, layer: usize, channel: usize) -> f64 {
    let interface = Interface::of(stack, layer);
    interface.map_or(0.0, |interface| interface.at(REFRACTION_WAVELENGTH_NM, channel).reflectance(1.0))
}

/// Quantities of a stack outside the domain of a model. Slope parameters below [`crate::layers::ALPHA_MIN`] count as inside: all models raise
/// them to it.
pub fn outside(model: ShadingModel, stack: &Stack) -> Vec<Outside> {
    let mut out = Vec::new();
    let mut above = stack.exterior.at(REFRACTION_WAVELENGTH_NM).re;
    for (layer, here) in stack.layers.iter().enumerate() {
        let mut found: Vec<(Quantity, f64)> = vec![(Quantity::Layers, (layer + 1) as f64)];
        found.extend(here.films.iter().map(|film| (Quantity::FilmNm, film.thickness.max_nm)));
        match &here.base {
            Base::Dielectric { ior, slab } => {
                let index = ior.at(REFRACTION_WAVELENGTH_NM).re;
                if layer + 1 < stack.layers.len() {
                    let ratio = index / above;
                    if ratio.max(1.0 / ratio) * returned(stack, layer) > DIM {
                        found.push((Quantity::Index, ratio));
                    }
                    found.push((Quantity::OpticalDepth, slab.optical_depth().into_iter().fold(0.0, f64::max)));
                }
                above = index;
            }
            Base::Conductor { ior } => {
                found.push((Quantity::MetalK, ior.samples().iter().fold(0.0, |k: f64, s| k.max(s.k))));
            }
            Base::Diffuse(_) => {}
        }
        if !matches!(here.base, Base::Diffuse(_)) && !here.surface.is_smooth() {
            let surface = here.surface;
            found.extend([surface.alpha_x, surface.alpha_y].map(|alpha| (Quantity::Alpha, alpha)));
        }
        for (quantity, value) in found {
            let limits = model.limits().filter(|limit| limit.quantity == quantity);
            for limit in limits.filter(|limit| !(limit.least..=limit.most).contains(&value)) {
                let new = Outside { layer, limit: *limit, value };
                // One report for all layers that are too many, and one for both slope parameters of a layer.
                if !out
                    .iter()
                    .any(|o: &Outside| o.limit == *limit && (quantity == Quantity::Layers || o.layer == layer))
                {
                    out.push(new);
                }
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use luthier_optics::ior::Ior;
    use luthier_optics::stack::{Diffuse, Film, FilmThickness, Layer, Slab, Surface};

    use super::*;

    fn coat(n: f64, film_nm: Option<f64>) -> Layer {
        let thickness = |nm| FilmThickness { min_nm: 0.0, max_nm: nm };
        let film = |nm| Film { ior: Ior::constant(1.4, 0.0).unwrap(), thickness: thickness(nm) };
        let slab = Slab { thickness_um: 0.0, absorption_per_um: [0.0; 3] };
        let base = Base::Dielectric { ior: Ior::constant(n, 0.0).unwrap(), slab };
        Layer { films: film_nm.map(film).into_iter().collect(), surface: Surface::smooth(), base }
    }

    fn on_white(coats: Vec<Layer>) -> Stack {
        let white = Layer {
            films: Vec::new(),
            surface: Surface::smooth(),
            base: Base::Diffuse(Diffuse { albedo: [0.8; 3], sigma: 0.0 }),
        };
        Stack { exterior: Ior::vacuum(), layers: coats.into_iter().chain([white]).collect() }
    }

    #[test]
    fn what_is_outside_is_named_once_and_where_it_is() {
        let found = outside(ShadingModel::Elek, &on_white(vec![coat(1.5, None), coat(3.9, None)]));
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].layer, found[0].limit.quantity, found[0].nearest()), (1, Quantity::Index, 1.9));
        assert!((found[0].value - 2.6).abs() < 1e-12 && !found[0].limit.refuses);
        assert!(outside(ShadingModel::Belcour, &on_white(vec![coat(3.9, None)])).is_empty());
        // The same coat over a dim base: what is too bright is little light.
        let mut dim = on_white(vec![coat(1.5, None), coat(3.9, None)]);
        dim.layers[2].base = Base::Diffuse(Diffuse { albedo: [0.3; 3], sigma: 0.0 });
        assert!(outside(ShadingModel::Elek, &dim).is_empty());
        let found = outside(ShadingModel::GranierHeidrich, &on_white(vec![coat(1.5, None), coat(1.4, None)]));
        assert_eq!(found.iter().map(|o| o.layer).collect::<Vec<_>>(), [1]);
    }

    /// The last dielectric has nothing below it that could be too bright.
    #[test]
    fn an_end_without_a_base_has_no_index_to_warn_of() {
        let stack = Stack { exterior: Ior::vacuum(), layers: vec![coat(3.9, None)] };
        assert!(outside(ShadingModel::Elek, &stack).is_empty());
    }

    #[test]
    fn a_millimetre_is_no_film() {
        let found = outside(ShadingModel::Phong, &on_white(vec![coat(1.5, Some(2e6))]));
        assert!(found.len() == 1 && found[0].limit.refuses, "{found:?}");
        assert!(outside(ShadingModel::Phong, &on_white(vec![coat(1.5, Some(2e4))])).is_empty());
    }
}
