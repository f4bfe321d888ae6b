//! Simplified materials: variants with parts left out.

use luthier_manifest::{Feature, MapSlot};
use luthier_material::Material;
use luthier_optics::stack::{Base, Distribution, FilmThickness, Slab, Surface};

/// A part that a material can do without.
///
/// ```
/// use luthier_manifest::Feature;
/// use luthier_scene::LeaveOut;
///
/// assert_eq!(LeaveOut::from_name("layer 2"), Some(LeaveOut::Layer(2)));
/// let films = LeaveOut::Feature(Feature::Films);
/// assert_eq!(LeaveOut::from_name(&films.name()), Some(films));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LeaveOut {
    /// A feature, in all layers. Films are removed entirely; an anisotropic surface becomes isotropic with the geometric mean of both slope
    /// parameters.
    Feature(Feature),
    /// A transparent layer, by its number from the top. The layers below move up.
    Layer(usize),
}

impl LeaveOut {
    /// Parts whose absence makes models cheaper.
    const CHEAPER: [Self; 4] = [
        Self::Feature(Feature::Absorption),
        Self::Feature(Feature::Films),
        Self::Feature(Feature::DiffuseSlopes),
        Self::Feature(Feature::Anisotropy),
    ];

    /// The name in manifests and reports.
    pub fn name(self) -> String {
        match self {
            Self::Feature(feature) => feature.name().to_owned(),
            Self::Layer(layer) => format!("layer {layer}"),
        }
    }

    /// The part of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        let feature = Feature::from_name(name).map(Self::Feature);
        feature.or_else(|| Some(Self::Layer(name.strip_prefix("layer ")?.parse().ok()?)))
    }
}

/// A material without some of its parts; `None` if one of them is absent, or needed.
pub fn simplified(material: &Material, left_out: &[LeaveOut]) -> Option<Material> {
    let mut material = material.clone();
    for part in left_out {
        if !leave_out(&mut material, *part) {
            return None;
        }
    }
    Some(material)
}

fn leave_out(material: &mut Material, part: LeaveOut) -> bool {
    match part {
        LeaveOut::Feature(feature) => leave_out_feature(material, feature),
        LeaveOut::Layer(index) => {
            let is_bare_in_places = material.is_bare_in_places();
            let layers = &mut material.stack.layers;
            let is_coat = layers.get(index).is_some_and(|layer| matches!(layer.base, Base::Dielectric { .. }));
            // Flakes, patina, a weight and maps name their layer by number, which a removed layer would shift.
            let stays = material.effects.flakes.is_some() || is_bare_in_places;
            let found = is_coat && index + 1 < layers.len() && !stays;
            if found {
                layers.remove(index);
                material.layers.remove(index);
            }
            found
        }
    }
}

/// Removes a feature and returns whether it was there. [`LeaveOut::Layer`] removes layers, one by one.
fn leave_out_feature(material: &mut Material, feature: Feature) -> bool {
    let (layers, effects) = (&mut material.stack.layers, &mut material.effects);
    let mut found = false;
    match feature {
        Feature::InnerInterface | Feature::Base => {}
        Feature::Absorption | Feature::BaseAbsorption => {
            for layer in layers {
                if let Base::Dielectric { slab, .. } = &mut layer.base {
                    found |= slab.optical_depth() != [0.0; 3];
                    *slab = Slab { absorption_per_um: [0.0; 3], ..*slab };
                }
            }
        }
        Feature::Films => {
            for (layer, extras) in layers.iter_mut().zip(&mut material.layers) {
                found |= !layer.films.is_empty();
                layer.films.clear();
                extras.film_variation = None;
                if std::mem::take(&mut extras.weighs_film) {
                    (extras.weight, extras.maps.weight) = (1.0, None);
                }
            }
        }
        Feature::InnerFilms => {
            for layer in layers {
                found |= layer.films.len() > 1;
                layer.films.truncate(1);
            }
        }
        Feature::FilmVariation => {
            for (layer, extras) in layers.iter_mut().zip(&mut material.layers) {
                found |= extras.film_variation.take().is_some();
                for FilmThickness { min_nm, max_nm } in layer.films.iter_mut().map(|film| &mut film.thickness) {
                    let nominal_nm = 0.5 * (*min_nm + *max_nm);
                    (*min_nm, *max_nm) = (nominal_nm, nominal_nm);
                }
            }
        }
        Feature::DiffuseSlopes => {
            for layer in layers {
                if let Base::Diffuse(diffuse) = &mut layer.base {
                    found |= diffuse.sigma != 0.0;
                    diffuse.sigma = 0.0;
                }
            }
        }
        Feature::Anisotropy => {
            for layer in layers {
                let Surface { distribution, alpha_x, alpha_y, .. } = layer.surface;
                found |= alpha_x != alpha_y;
                layer.surface = Surface::isotropic(distribution, (alpha_x * alpha_y).sqrt());
            }
            for slot in [MapSlot::AlphaX, MapSlot::AlphaY, MapSlot::Tangent] {
                take(material, slot, |_| true);
            }
        }
        Feature::Beckmann => {
            let surfaces = layers.iter_mut().map(|layer| &mut layer.surface);
            for surface in surfaces.filter(|surface| surface.distribution == Distribution::Beckmann) {
                found |= !surface.is_smooth();
                surface.distribution = Distribution::Ggx;
            }
        }
        Feature::Distribution => {
            for surface in layers.iter_mut().map(|layer| &mut layer.surface) {
                found |= !surface.distribution.has_walks() && !surface.is_smooth();
                surface.distribution = surface.distribution.walked();
            }
        }
        Feature::NormalMap => found = take(material, MapSlot::Normal, |number| number == 0),
        Feature::RoughnessMap => found = take(material, MapSlot::Roughness, |number| number == 0),
        Feature::ThicknessMap => found = take(material, MapSlot::Thickness, |number| number == 0),
        Feature::InnerThickness => found = take(material, MapSlot::Thickness, |number| number > 0),
        Feature::AbsorptionMap => found = take(material, MapSlot::Absorption, |number| number == 0),
        Feature::InnerAbsorptionMap => found = take(material, MapSlot::Absorption, |number| number > 0),
        Feature::Bumps => found = take(material, MapSlot::Bumps, |_| true),
        Feature::LayerAlpha => {
            for slot in [MapSlot::Alpha, MapSlot::AlphaX, MapSlot::AlphaY] {
                found |= take(material, slot, |_| true);
            }
        }
        Feature::Tangents => found = take(material, MapSlot::Tangent, |_| true),
        Feature::AlbedoMap => found = take(material, MapSlot::Albedo, |_| true),
        Feature::LeanMap => found = take(material, MapSlot::Lean, |_| true),
        Feature::MetallicMap => {
            for slot in [MapSlot::BaseColor, MapSlot::Metallic, MapSlot::F0] {
                found |= take(material, slot, |_| true);
            }
        }
        Feature::Flakes => found = effects.flakes.take().is_some(),
        Feature::Patina => found = effects.patina.take().is_some(),
        Feature::Weight | Feature::FilmWeight => {
            if let Some(first) = material.layers.first_mut() {
                found = first.weight < 1.0 || first.varies(MapSlot::Weight);
                (first.weight, first.weighs_film) = (1.0, false);
                first.take(MapSlot::Weight);
            }
        }
        Feature::Glitter => found = effects.glitter.take().is_some(),
        Feature::Reradiation => {
            for extras in &mut material.layers {
                found |= extras.reradiation.take().is_some();
            }
        }
    }
    found
}

/// Takes what varies a quantity of some layers, by number, away; whether there was any.
fn take(material: &mut Material, slot: MapSlot, is_of: impl Fn(usize) -> bool) -> bool {
    let layers = material.layers.iter_mut().enumerate().filter(|(number, _)| is_of(*number));
    layers.fold(false, |found, (_, extras)| extras.take(slot) | found)
}

/// Every set of parts that can be left out together, with the remaining material. A set has at most one layer; the whole material comes first.
pub fn variants(material: &Material) -> Vec<(Vec<LeaveOut>, Material)> {
    let mut found: Vec<(Vec<LeaveOut>, Material)> = Vec::new();
    let layers = (0..material.stack.layers.len()).map(|layer| Some(LeaveOut::Layer(layer)));
    for layer in std::iter::once(None).chain(layers) {
        for bits in 0..1_u32 << LeaveOut::CHEAPER.len() {
            let parts =
                LeaveOut::CHEAPER.into_iter().enumerate().filter(|(i, _)| bits >> i & 1 == 1).map(|(_, part)| part);
            let left_out: Vec<LeaveOut> = layer.into_iter().chain(parts).collect();
            if let Some(simple) = simplified(material, &left_out) {
                found.push((left_out, simple));
            }
        }
    }
    found
}
