//! Features of a material that its model leaves out.

use luthier_manifest::{Feature, Form, MapSlot, ModelPart, ShadingModel};
use luthier_optics::stack::{Base, Distribution, Film, Layer};

use crate::material::Material;

/// A feature that a material asks for and its model does not show.
///
/// ```
/// use luthier_manifest::{Feature, ShadingModel};
/// use luthier_material::{left_out, parse};
///
/// let text = "schema = 1\nname = \"steel\"\n[[layer]]\ntype = \"conductor\"\nior = \"steel_316\"\nalpha_x = 0.1\nalpha_y = 0.3\n";
/// let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
/// let steel = parse("steel.toml", text, &no_files).unwrap().material;
/// let parts = left_out(&steel, ShadingModel::Belcour);
/// assert_eq!((parts[0].feature, parts[0].key.as_str()), (Feature::Anisotropy, "layer.0.alpha_x"));
/// assert!(left_out(&steel, ShadingModel::Yamaguchi).is_empty());
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LeftOut {
    /// Feature that is not shown.
    pub feature: Feature,
    /// The key that asks for it, as in [`Places`](crate::Places).
    pub key: String,
    /// The forms of the shader that leave it out; at least one.
    pub forms: Vec<Form>,
}

/// The features of a material that a model leaves out, layers from the top down, then effects. Layers that are left out have one entry in
/// all.
pub fn left_out(material: &Material, model: ShadingModel) -> Vec<LeftOut> {
    let mut asked = Vec::new();
    let layers = &material.stack.layers;
    let mut is_told = false;
    let adds_base = material.adds_base() && model.takes(ModelPart::DiffuseTerm);
    for (number, layer) in layers.iter().enumerate() {
        let is_added = adds_base && feature_of(layer) == Feature::Base;
        if number > 0 && !is_added && !missing(model, feature_of(layer)).is_empty() {
            if !is_told {
                asked.push((feature_of(layer), format!("layer.{number}.type")));
            }
            is_told = true;
            continue;
        }
        // Whether light of interfaces, and of a base, comes up through the slab.
        let [lights_of_interfaces, light_of_base] = [Feature::InnerInterface, Feature::Base].map(|kind| {
            let is_shown = missing(model, kind).is_empty() || adds_base && kind == Feature::Base;
            is_shown && layers[number + 1..].iter().any(|below| feature_of(below) == kind)
        });
        let film = layer.films.first();
        let varies = film.is_some_and(Film::varies);
        let slopes = layer.surface;
        let (absorbs, deviates, is_facetted) = match &layer.base {
            Base::Dielectric { slab, .. } => (slab.optical_depth() != [0.0; 3], false, true),
            Base::Conductor { .. } => (false, false, true),
            Base::Diffuse(diffuse) => (false, diffuse.sigma != 0.0, false),
        };
        let is_rough = is_facetted && !slopes.is_smooth();
        for (is_asked, feature, name) in [
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
            (absorbs && lights_of_interfaces, Feature::Absorption, "absorption_per_um"),
            (absorbs && light_of_base, Feature::BaseAbsorption, "absorption_per_um"),
            (deviates, Feature::DiffuseSlopes, "sigma"),
            (material.layers[number].reradiation.is_some(), Feature::Reradiation, "reradiation"),
        ] {
            if is_asked {
                asked.push((feature, format!("layer.{number}.{name}")));
            }
        }
        for (key, slot) in material.layers[number].varied() {
            if let Some(feature) = slot.layer_feature(number as u32) {
                asked.push((feature, format!("layer.{number}.{key}")));
            }
        }
    }
    let first = material.layers.first();
    let key_of =
        |slot| first.and_then(|first| Some(format!("layer.0.{}", first.varied_key(slot)?))).unwrap_or_default();
    let slots = [MapSlot::Normal, MapSlot::Roughness, MapSlot::Thickness, MapSlot::Absorption];
    let [normal_key, roughness_key, thickness_key, absorption_key] = slots.map(key_of);
    let effects = &material.effects;
    for (is_asked, feature, key) in [
        (!normal_key.is_empty(), Feature::NormalMap, normal_key.as_str()),
        (!roughness_key.is_empty(), Feature::RoughnessMap, &roughness_key),
        (!thickness_key.is_empty(), Feature::ThicknessMap, &thickness_key),
        (effects.flakes.is_some(), Feature::Flakes, "effects.flakes"),
        (effects.patina.is_some(), Feature::Patina, "effects.patina"),
        (material.weight().is_some() && !material.weighs_film(), Feature::Weight, weight_key(material)),
        (material.weight().is_some() && material.weighs_film(), Feature::FilmWeight, weight_key(material)),
        (effects.glitter.is_some(), Feature::Glitter, "effects.glitter"),
    ] {
        if is_asked {
            asked.push((feature, key.to_owned()));
        }
    }
    let found = asked.into_iter().map(|(feature, key)| LeftOut { feature, key, forms: missing(model, feature) });
    let mut found: Vec<LeftOut> = found.filter(|part| !part.forms.is_empty()).collect();
    if model.is_fitted() && first.is_some() {
        // Rows are over one factor, over the amount of patina, or over the azimuth. Beside a weight, the layers below the coat have rows of their own.
        let is_turned = layers.iter().any(Layer::is_anisotropic);
        let film = layers.first().and_then(|first| first.films.first()).is_some_and(Film::varies);
        let film_below = material.film_of_lobes().filter(|number| layers[*number].films[0].varies() && *number > 0);
        let film_below_key = film_below.map(|number| format!("layer.{number}.film.0.thickness_nm")).unwrap_or_default();
        // Flakes lie below the patina alone, and rows do not tell its lobes from those of several layers that are bare.
        let has_flakes_above_lobes = effects.flakes.is_some() && layers.len() > 2;
        let is_under_patina = effects.patina.is_some() && layers.len() > 1;
        let family = material.family();
        // A family has the factors of a roughness map in its axes, and what slabs absorb in closed form.
        let [roughness, thickness, absorption] =
            [&roughness_key, &thickness_key, &absorption_key].map(|key| !key.is_empty() && family.is_none());
        let slab = thickness || absorption;
        for (number, layer) in material.layers.iter().enumerate() {
            for (key, slot) in layer.varied() {
                let has_axis = family.is_some_and(|family| number == 0 || number == family.interface);
                let lacks = match slot {
                    MapSlot::Alpha
                    | MapSlot::AlphaX
                    | MapSlot::AlphaY
                    | MapSlot::Tangent
                    | MapSlot::BaseColor
                    | MapSlot::Metallic
                    | MapSlot::F0 => !has_axis,
                    _ => false,
                };
                if let Some(feature) = slot.layer_feature(number as u32).filter(|_| lacks) {
                    let key = format!("layer.{number}.{key}");
                    found.push(LeftOut { feature, key, forms: Form::ALL.to_vec() });
                }
            }
        }
        for (lacks, feature, key) in [
            (roughness && is_turned, Feature::RoughnessMap, roughness_key.as_str()),
            (thickness && (is_turned || roughness), Feature::ThicknessMap, &thickness_key),
            (absorption && (is_turned || roughness), Feature::AbsorptionMap, &absorption_key),
            (
                film && family.is_none() && (is_turned || roughness || slab),
                Feature::FilmVariation,
                "layer.0.film.0.thickness_nm",
            ),
            (film_below.is_some() && family.is_none(), Feature::FilmVariation, &film_below_key),
            (
                is_under_patina && (is_turned || roughness || slab || film || has_flakes_above_lobes),
                Feature::Patina,
                "effects.patina",
            ),
        ] {
            if lacks {
                found.push(LeftOut { feature, key: key.to_owned(), forms: Form::ALL.to_vec() });
            }
        }
        // Lobes of several interfaces are not told apart: the lowest one tilts them.
        let lowest = layers.iter().rposition(|layer| !matches!(layer.base, Base::Diffuse(_))).unwrap_or(0);
        let bumps_of = |number: usize| {
            material.layers[number].varied_key(MapSlot::Bumps).map(|key| format!("layer.{number}.{key}"))
        };
        for key in (1..lowest).filter_map(bumps_of) {
            if !found.iter().any(|part| part.key == key) {
                found.push(LeftOut { feature: Feature::Bumps, key, forms: Form::ALL.to_vec() });
            }
        }
    }
    found
}

/// The key that gives the first layer a weight.
fn weight_key(material: &Material) -> &'static str {
    let is_stated = material.layers.first().is_some_and(|first| first.weight < 1.0);
    let has_map = material.layers.first().is_some_and(|first| first.maps.weight.is_some());
    match (material.weighs_film(), is_stated) {
        (false, true) => "layer.0.weight",
        (false, false) if !has_map => "layer.0.live.weight",
        (false, false) => "layer.0.maps.weight",
        (true, true) => "layer.0.film.0.weight",
        (true, false) => "layer.0.film.0.maps.weight",
    }
}

/// The forms of a model that leave a feature out.
fn missing(model: ShadingModel, feature: Feature) -> Vec<Form> {
    Form::ALL.into_iter().filter(|&form| !model.honours(feature, form)).collect()
}

/// The feature that a layer below the first is.
fn feature_of(layer: &Layer) -> Feature {
    match layer.base {
        Base::Diffuse(_) => Feature::Base,
        _ => Feature::InnerInterface,
    }
}

/// The key of a layer that says which distribution its slopes have.
pub fn distribution_key(distribution: Distribution) -> &'static str {
    if distribution.own_alpha().is_some() { distribution.name() } else { "distribution" }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parse;

    /// Films under the first are a feature of their own: one film alone is not.
    #[test]
    fn a_second_film_is_told_apart() {
        let film = "[[layer]]\ntype = \"thin-film\"\nior = 1.33\nthickness_nm = 300\n";
        let keys = |films: &str| {
            let text = format!(
                "schema = 1\nname = \"m\"\n{films}[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.2\n"
            );
            let material = parse("m.toml", &text, &|_| Err(std::io::ErrorKind::NotFound.into())).unwrap().material;
            let parts = ShadingModel::ALL.into_iter().flat_map(|model| left_out(&material, model));
            parts.filter(|part| part.feature == Feature::InnerFilms).map(|part| part.key).collect::<Vec<_>>()
        };
        assert_eq!(keys(film), [""; 0]);
        let two = keys(&film.repeat(2));
        assert!(!two.is_empty() && two.iter().all(|key| key == "layer.0.film.1.type"), "{two:?}");
    }
}
