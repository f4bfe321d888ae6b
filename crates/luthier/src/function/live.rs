//! Live numbers of a material at a place.

use luthier_layers::effects::layer_sample::LayerSample;
use luthier_layers::glam::{DVec2, DVec3};
use luthier_layers::twins::shaded::Place;
use luthier_manifest::{Form, LiveEntry, LiveRange, MapSlot, ShadingModel};
use luthier_material::{Material, left_out};
use luthier_optics::Rgb;

use super::Refusal;

/// A live number, and the value that it gets.
#[derive(Debug, Clone, PartialEq)]
pub struct LiveValue {
    /// The layer, from the top.
    pub layer: usize,
    /// The key in the layer.
    pub name: String,
    /// The numbers.
    pub values: Vec<f64>,
}

/// A layer with its edge tint, and its base colour and metal at a place.
pub(super) type Metallic = Option<(usize, Rgb, Rgb, f64)>;

/// Gives a place the values of live numbers, and base colour and metal those of a layer that has them live.
///
/// # Errors
/// A number that the file does not have live, that the model does not show, or that is out of its range.
pub(super) fn set(
    place: &mut Place,
    metallic: &mut Metallic,
    material: &Material,
    model: Option<ShadingModel>,
    given: &[LiveValue],
) -> Result<(), Refusal> {
    let known = luthier_bake::live_numbers(material);
    for live in known.iter().filter(|live| matches!(live.slot, MapSlot::BaseColor | MapSlot::Metallic)) {
        let surface = material.layers[live.layer as usize].metallic;
        *metallic = metallic.or(surface.map(|s| (live.layer as usize, s.f82_tint, s.base_color, s.metallic)));
    }
    for LiveValue { layer, name, values } in given {
        let key = format!("layer.{layer}.{name}");
        let is_meant = |live: &&LiveEntry| live.layer as usize == *layer && live.slot.name().replace('-', "_") == *name;
        let Some(live) = known.iter().find(is_meant) else {
            let keys = known.iter().map(|live| format!("layer.{}.{}", live.layer, live.slot.name().replace('-', "_")));
            let keys = keys.collect::<Vec<_>>().join(", ");
            let keys = if keys.is_empty() { "it has none".to_owned() } else { format!("it has {keys}") };
            return usage(format!("{} has no live `{key}`: {keys}", material.source));
        };
        let Some(shader) = model else {
            return usage(format!("a model without a shader has no live numbers: change `{key}` in the file"));
        };
        let feature = live.slot.layer_feature(live.layer);
        let is_lost = |feature| {
            left_out(material, shader).iter().any(|part| part.feature == feature && part.forms.len() == Form::ALL.len())
        };
        if feature.is_some_and(is_lost) {
            return usage(format!("model `{}` does not show the live `{key}`", shader.name()));
        }
        if values.len() != live.default.len() {
            return usage(format!("`{key}` takes {} numbers, not {}", live.default.len(), values.len()));
        }
        if let (Some(LiveRange { least, most }), true) = (live.range, values.iter().any(|v| live.held(*v) != *v)) {
            let most = most.map_or(String::new(), |most| format!(" to {most:.6}"));
            return usage(format!("`{key}` is from {least:.6}{most}"));
        }
        let layer = live.layer as usize;
        if live.member.starts_with("layers[") && place.layers.len() <= layer {
            place.layers.resize(layer + 1, LayerSample::NONE);
        }
        let own = place.layers.get_mut(layer);
        let rgb = || Rgb::try_from(values.as_slice()).unwrap_or_default();
        match (live.slot, own) {
            (MapSlot::Normal, _) => place.sample.normal = unit(values),
            (MapSlot::Roughness, _) => place.sample.alpha_factor *= values[0],
            (MapSlot::Thickness, _) if layer == 0 => place.sample.slab_factor *= values[0],
            (MapSlot::Thickness, Some(own)) => own.slab_factor *= values[0],
            (MapSlot::Absorption, Some(own)) => (0..3).for_each(|c| own.absorption_factors[c] *= values[c]),
            (MapSlot::Bumps, Some(own)) => own.normal = unit(values),
            (MapSlot::Alpha, Some(own)) => own.alpha_factors = own.alpha_factors.map(|factor| factor * values[0]),
            (MapSlot::AlphaX, Some(own)) => own.alpha_factors[0] *= values[0],
            (MapSlot::AlphaY, Some(own)) => own.alpha_factors[1] *= values[0],
            (MapSlot::Tangent, Some(own)) => {
                own.tangent = DVec2::new(values[0], values[1]).try_normalize().unwrap_or(DVec2::X);
            }
            (MapSlot::Albedo, _) => place.base_color = Some(rgb()),
            (MapSlot::BaseColor, _) => *metallic = metallic.map(|(layer, tint, _, metal)| (layer, tint, rgb(), metal)),
            (MapSlot::Metallic, _) => {
                *metallic = metallic.map(|(layer, tint, color, _)| (layer, tint, color, values[0]))
            }
            // A weight is that of the whole place: see `weight_factor`.
            _ => {}
        }
    }
    Ok(())
}

/// The live factor on the weight of a coat.
pub(super) fn weight_factor(given: &[LiveValue]) -> f64 {
    given.iter().filter(|live| live.layer == 0 && live.name == "weight").map(|live| live.values[0]).product()
}

/// A unit vector above the surface.
fn unit(values: &[f64]) -> DVec3 {
    DVec3::new(values[0], values[1], values[2].max(1e-3)).normalize()
}

fn usage<T>(text: String) -> Result<T, Refusal> {
    Err(Refusal::Live(text))
}
