//! Features of a material that its model leaves out.

use luthier_manifest::{Feature, Form, ShadingModel};
use luthier_optics::stack::{Base, Distribution, Film, Layer};

use crate::material::Material;

/// A feature that a material asks for and its model does not show.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LeftOut {
    /// Feature that is not shown.
    pub feature: Feature,
    /// The key that asks for it, as in [`Places`](crate::Places).
    pub key: String,
    /// The forms of the shader that leave it out; at least one.
    pub forms: Vec<Form>,
}

/// The features of a material that a model leaves out, layers from the top down, then effects. Of a layer that is left out nothing else is
/// told.
pub fn left_out(material: &Material, model: ShadingModel) -> Vec<LeftOut> {
    let mut found = Vec::new();
    let missing =
        |feature| -> Vec<Form> { Form::ALL.into_iter().filter(|&form| !model.honours(feature, form)).collect() };
    let mut tell = |feature: Feature, key: String| {
        let forms = missing(feature);
        if !forms.is_empty() {
            found.push(LeftOut { feature, key, forms });
        }
    };
    let layers = &material.stack.layers;
    let of_layer = |number: usize| match layers[number].base {
        Base::Diffuse(_) => Feature::Base,
        _ => Feature::InnerInterface,
    };
    let is_read = |number: usize| number == 0 || number < layers.len() && missing(of_layer(number)).is_empty();
    // Whether light of such a layer comes up through a slab.
    let lights = |slab: usize, kind| (slab + 1..layers.len()).any(|below| of_layer(below) == kind && is_read(below));
    let mut is_told = false;
    for (number, layer) in layers.iter().enumerate() {
        let key = |name: &str| format!("layer.{number}.{name}");
        if !is_read(number) {
            if !is_told {
                tell(of_layer(number), key("type"));
            }
            is_told = true;
            continue;
        }
        let film = layer.films.first();
        let varies = film.is_some_and(Film::varies);
        let slopes = layer.surface;
        let (absorbs, deviates, is_facetted) = match &layer.base {
            Base::Dielectric { slab, .. } => (slab.optical_depth() != [0.0; 3], false, true),
            Base::Conductor { .. } => (false, false, true),
            Base::Diffuse(diffuse) => (false, diffuse.sigma != 0.0, false),
        };
        let is_rough = is_facetted && !slopes.is_smooth();
        for (asked, feature, name) in [
            (film.is_some(), Feature::Films, "film.0.type"),
            (varies, Feature::FilmVariation, "film.0.thickness_nm"),
            (layer.films.len() > 1, Feature::InnerFilms, "film.1.type"),
            (layer.is_anisotropic(), Feature::Anisotropy, "alpha_x"),
            (is_rough && slopes.distribution == Distribution::Beckmann, Feature::Beckmann, "distribution"),
            (
                is_rough && !slopes.distribution.has_walks(),
                Feature::Distribution,
                distribution_key(slopes.distribution),
            ),
            (absorbs && lights(number, Feature::InnerInterface), Feature::Absorption, "absorption_per_um"),
            (absorbs && lights(number, Feature::Base), Feature::BaseAbsorption, "absorption_per_um"),
            (deviates, Feature::DiffuseSlopes, "sigma"),
            (material.layers[number].reradiation.is_some(), Feature::Reradiation, "reradiation"),
        ] {
            if asked {
                tell(feature, key(name));
            }
        }
        for map in material.layers[number].maps.named() {
            if let Some(feature) = map.slot.layer_feature(number as u32) {
                tell(feature, key(&format!("maps.{}", map.key)));
            }
        }
    }
    let maps = material.layers.first().map(|first| &first.maps);
    let effects = &material.effects;
    for (asked, feature, key) in [
        (maps.is_some_and(|maps| maps.normal.is_some()), Feature::NormalMap, "layer.0.maps.normal"),
        (maps.is_some_and(|maps| maps.roughness.is_some()), Feature::RoughnessMap, "layer.0.maps.roughness"),
        (maps.is_some_and(|maps| maps.thickness.is_some()), Feature::ThicknessMap, "layer.0.maps.thickness"),
        (effects.flakes.is_some(), Feature::Flakes, "effects.flakes"),
        (effects.patina.is_some(), Feature::Patina, "effects.patina"),
        (effects.glitter.is_some(), Feature::Glitter, "effects.glitter"),
    ] {
        if asked {
            tell(feature, key.to_owned());
        }
    }
    if let Some(maps) = maps.filter(|_| model.is_fitted()) {
        // Rows are over one factor, over the amount of patina, or over the azimuth.
        let is_turned = layers.iter().any(Layer::is_anisotropic);
        let (roughness, thickness) = (maps.roughness.is_some(), maps.thickness.is_some());
        let film = layers.first().and_then(|first| first.films.first()).is_some_and(Film::varies);
        // Flakes lie below the patina alone, and rows do not tell its lobes from those of several layers that are bare.
        let has_flakes_above_lobes = effects.flakes.is_some() && layers.len() > 2;
        let covers = effects.patina.is_some() && layers.len() > 1;
        for (lacks, feature, key) in [
            (roughness && is_turned, Feature::RoughnessMap, "layer.0.maps.roughness"),
            (thickness && (is_turned || roughness), Feature::ThicknessMap, "layer.0.maps.thickness"),
            (film && (is_turned || roughness || thickness), Feature::FilmVariation, "layer.0.film.0.thickness_nm"),
            (
                covers && (is_turned || roughness || thickness || film || has_flakes_above_lobes),
                Feature::Patina,
                "effects.patina",
            ),
        ] {
            if lacks {
                found.push(LeftOut { feature, key: key.to_owned(), forms: Form::ALL.to_vec() });
            }
        }
    }
    found
}

/// The key of a layer that says which distribution its slopes have.
pub fn distribution_key(distribution: Distribution) -> &'static str {
    if distribution.own_alpha().is_some() { distribution.name() } else { "distribution" }
}
