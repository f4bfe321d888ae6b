//! Doubts about the parts of a model that a material chooses: parts and distributions that its model lacks, and the errors of approximations.

use luthier_layers::models::parts::Parts;
use luthier_lut::TableKind;
use luthier_manifest::ModelPart;
use luthier_manifest::{
    BeamsRecord, DiffusePart, DiffuseTerm, Feature, Form, InternalReflection, LowerAlpha, LowerCosine, LowerFacets,
    LowerReflectance, Masking, Reflectance, ShadingModel,
};
use luthier_material::{Diagnostic, Material, Severity, distribution_key};
use luthier_model::Reach;
use luthier_optics::interface::Interface;
use luthier_optics::schlick::schlick;
use luthier_optics::stack::Base;

use super::beams::{self, of_beams};

/// Errors for parts that a model lacks, and for films where the chosen curve of a reflectance has none; warnings with the effect of other parts.
/// `asked` is the model of the command line.
///
/// ```
/// use luthier::{ShadingModel, refusals};
/// # let text = "schema = 1\nname = \"dim\"\n[[layer]]\ntype = \"conductor\"\nf0 = 0.9\nalpha = 0.5\n[bake]\nmasking = \"implicit\"\nmodel = \"microfacet\"\n";
///
/// // The file chooses a masking, which `belcour` lets no file choose.
/// let dim = luthier::parse("dim.toml", text)?;
/// assert!(refusals::of_parts(&dim, Some(ShadingModel::Belcour)).iter().any(|error| error.is_error()));
/// # Ok::<(), luthier::Error>(())
/// ```
pub fn of_parts(material: &Material, asked: Option<ShadingModel>) -> Vec<Diagnostic> {
    let model = asked.unwrap_or_else(|| material.model());
    let mut doubts = Vec::new();
    doubts.extend(of_distribution(material, model));
    doubts.extend(material.bake.masking.and_then(|masking| of_masking(material, model, masking)));
    let chosen = material.bake.reflectance.filter(|reflectance| *reflectance != Reflectance::Table);
    doubts.extend(chosen.and_then(|reflectance| of_reflectance(material, model, reflectance)));
    doubts.extend(of_beams(material, model));
    let internal = material.bake.internal_reflection;
    doubts.extend(internal.and_then(|internal| of_internal_reflection(material, model, internal)));
    let lower = material.bake.lower_reflectance;
    doubts.extend(lower.and_then(|lower| of_lower_reflectance(material, model, lower)));
    doubts.extend(material.bake.lower_cosine.and_then(|lower| of_lower_cosine(material, model, lower)));
    doubts.extend(material.bake.lower_facets.and_then(|lower| of_lower_facets(material, model, lower)));
    doubts.extend(material.bake.lower_alpha.and_then(|lower| of_lower_alpha(material, model, lower)));
    doubts.extend(material.bake.diffuse_part.and_then(|part| of_diffuse_part(material, model, part)));
    doubts.extend(material.bake.diffuse_term.and_then(|term| of_diffuse_term(material, model, term)));
    doubts
}

/// The parts of a model that a material chooses, for the f64 twin.
///
/// ```
/// use luthier::{ShadingModel, refusals};
/// use luthier_manifest::Masking;
/// # let text = "schema = 1\nname = \"dim\"\n[[layer]]\ntype = \"conductor\"\nf0 = 0.9\nalpha = 0.5\n[bake]\nmasking = \"implicit\"\nmodel = \"microfacet\"\n";
///
/// let dim = luthier::parse("dim.toml", text)?;
/// assert_eq!(refusals::parts_of(&dim, ShadingModel::Microfacet).masking, Masking::Implicit);
/// # Ok::<(), luthier::Error>(())
/// ```
pub fn parts_of(material: &Material, model: ShadingModel) -> Parts {
    let bake = &material.bake;
    let masking = bake.masking.filter(|_| model.takes(ModelPart::Masking)).unwrap_or_default();
    let reflectance = bake.reflectance.filter(|_| model.takes(ModelPart::Reflectance)).unwrap_or_default();
    let diffuse_term = bake.diffuse_term.filter(|_| model.takes(ModelPart::DiffuseTerm)).unwrap_or_default();
    let parts = Parts { masking, reflectance, path: bake.path_parts(model), diffuse_term, ..Parts::PLAIN };
    let beams = material.beams().filter(|_| model.takes(ModelPart::Beams));
    beams.map_or(
        parts,
        |BeamsRecord { inner_alpha_ratio, specular_weight, diffuse_weight, inner_normal, lobe_height }| {
            parts.with_beams(inner_alpha_ratio, [specular_weight, diffuse_weight], inner_normal, lobe_height)
        },
    )
}

/// Cosines at which a curve is compared with the reflectance.
const COSINES: u32 = 100;

/// Errors for parts that a material of a scene chooses: its model is the scene's choice.
///
/// ```
/// # let text = "schema = 1\nname = \"dim\"\n[[layer]]\ntype = \"conductor\"\nf0 = 0.9\nalpha = 0.5\n[bake]\nmasking = \"implicit\"\nmodel = \"microfacet\"\n";
/// let dim = luthier::parse("dim.toml", text)?;
/// let errors = luthier::refusals::of_scene(&dim);
/// assert!(errors[0].message.contains("a scene chooses the models of its materials"));
/// # Ok::<(), luthier::Error>(())
/// ```
pub fn of_scene(material: &Material) -> Vec<Diagnostic> {
    let keys = [
        ("masking", material.bake.masking.is_some()),
        ("reflectance", material.bake.reflectance.is_some_and(|reflectance| reflectance != Reflectance::Table)),
        ("internal_reflection", material.bake.internal_reflection.is_some()),
        ("lower_reflectance", material.bake.lower_reflectance.is_some()),
        ("lower_cosine", material.bake.lower_cosine.is_some()),
        ("lower_facets", material.bake.lower_facets.is_some()),
        ("lower_alpha", material.bake.lower_alpha.is_some()),
        ("diffuse_part", material.bake.diffuse_part.is_some()),
        ("diffuse_term", material.bake.diffuse_term.is_some()),
    ];
    let parts = keys.into_iter().filter(|(_, is_chosen)| *is_chosen).map(|(key, _)| format!("bake.{key}"));
    let of_slopes = first_free(material, material.stack.layers.len()).map(|layer| {
        let distribution = material.stack.layers[layer].surface.distribution;
        let message = format!(
            "a scene compares models with a simulation, which has no facets of the distribution `{}`",
            distribution.name()
        );
        let hint = "take `ggx` or `beckmann`, or bake the material by itself".to_owned();
        let key = format!("layer.{layer}.{}", distribution_key(distribution));
        material.diagnostic(Severity::Error, &key, message, Some(hint))
    });
    let of_film = material.film_of_lobes().map(|layer| {
        let message = "a scene compares models, and one alone shows a film that varies below the first layer, or on a surface whose maps give each place another F0";
        let hint = "leave the film out, or bake the material by itself".to_owned();
        let key = format!("layer.{layer}.film.0.type");
        material.diagnostic(Severity::Error, &key, message.to_owned(), Some(hint))
    });
    let beams = beams::keys(material).map(str::to_owned);
    parts.chain(beams).map(|place| chosen_part(material, &place)).chain(of_slopes).chain(of_film).collect()
}

/// The error for a part that a material of a scene chooses.
fn chosen_part(material: &Material, place: &str) -> Diagnostic {
    let key = place.rsplit_once('.').map_or(place, |(_, key)| key);
    let message = format!("a scene chooses the models of its materials, and `{key}` is a part of some models");
    let hint = "leave it out, or bake the material by itself".to_owned();
    material.diagnostic(Severity::Error, place, message, Some(hint))
}

/// The first of the upper `layers` layers whose distribution has no walks in closed form.
fn first_free(material: &Material, layers: usize) -> Option<usize> {
    let mut surfaces = material.stack.layers.iter().take(layers).map(|layer| &layer.surface);
    surfaces.position(|surface| !surface.is_smooth() && !surface.distribution.has_walks())
}

/// Beginnings of the names of functions in f64 that need no more of a distribution than D, or the names.
const OF_ANY_SLOPES: [&str; 8] =
    ["microfacet-", "weidlich-wilkie", "elek", "heterogeneous-", "flakes", "patina", "lambert", "oren-nayar"];

/// An error where a function in f64, given by name, cannot use the distribution of a layer. A model with a shader cannot where its shader cannot;
/// other functions cannot if they walk between facets, draw visible normals or follow statistics of lobes.
///
/// ```
/// use luthier::refusals;
///
/// let text = "schema = 1\nname = \"steel\"\n[[layer]]\ntype = \"conductor\"\nior = \"fe\"\nabc = { b = 100.0, c = 0.8 }\n";
/// let steel = luthier::parse("steel.toml", text)?;
/// assert!(refusals::of_function(&steel, "layered-mc").is_some(), "its facets cannot be walked between");
/// assert!(refusals::of_function(&steel, "elek").is_none());
/// # Ok::<(), luthier::Error>(())
/// ```
pub fn of_function(material: &Material, name: &str) -> Option<Diagnostic> {
    if let Some(model) = ShadingModel::from_name(name) {
        return of_distribution(material, model);
    }
    let layer = first_free(material, material.stack.layers.len())?;
    if OF_ANY_SLOPES.iter().any(|known| name.starts_with(known)) {
        return None;
    }
    Some(no_slopes(material, name, layer))
}

/// The error for a model that cannot use the distribution of a layer.
fn no_slopes(material: &Material, model: &str, layer: usize) -> Diagnostic {
    let distribution = material.stack.layers[layer].surface.distribution;
    let name = distribution.name();
    let message =
        format!("the model `{model}` has no distribution `{name}`: it needs facets as Beckmann's or those of GGX");
    let hint = "take `ggx` or `beckmann`, or the model `elek`, `weidlich-wilkie` or `microfacet`".to_owned();
    let key = format!("layer.{layer}.{}", distribution_key(distribution));
    material.diagnostic(Severity::Error, &key, message, Some(hint))
}

/// An error where a model, its masking or a table cannot use the distribution of a layer.
fn of_distribution(material: &Material, model: ShadingModel) -> Option<Diagnostic> {
    let read = if model.facts().reach == Reach::First { 1 } else { material.stack.layers.len() };
    let layer = first_free(material, read)?;
    let distribution = material.stack.layers[layer].surface.distribution;
    let (name, key) = (distribution.name(), format!("layer.{layer}.{}", distribution_key(distribution)));
    if !model.honours(Feature::Distribution, Form::Baked) {
        return Some(no_slopes(material, model.name(), layer));
    }
    let masking = material.bake.masking.unwrap_or_default();
    if model.takes(ModelPart::Masking) && masking.needs_lambda() {
        let is_named = material.bake.masking.is_some();
        let message = format!("the masking `{}` of the distribution `{name}` has no closed form", masking.name());
        let hint =
            "write `[bake] masking = \"v-cavity\"`, or `\"kelemen\"`, `\"implicit\"` or `\"schlick-smith\"`".to_owned();
        let key = if is_named { "bake.masking" } else { key.as_str() };
        return Some(material.diagnostic(Severity::Error, key, message, Some(hint)));
    }
    let table = Some(TableKind::Fgd).filter(|kind| material.bake.asks_for(*kind))?;
    let message =
        format!("the table `{}` holds walks between facets, of which the distribution `{name}` has none", table.name());
    let hint = format!("leave the table out, or take `ggx` or `beckmann` for layer {}", layer + 1);
    Some(material.diagnostic(Severity::Error, &key, message, Some(hint)))
}

fn of_masking(material: &Material, model: ShadingModel, masking: Masking) -> Option<Diagnostic> {
    let (name, key) = (masking.name(), "bake.masking");
    if !model.takes_masking(masking) {
        let (message, hint) = if model.takes(ModelPart::CavityMasking) {
            (
                format!("the model `{model}` of this material has no masking `{name}`"),
                "take `v-cavity`, its default, or `kelemen`, or write `[bake] model = \"microfacet\"`",
            )
        } else {
            (
                format!("the masking `{name}` is a part of the model `microfacet`, and this material has `{model}`"),
                "leave it out, or write `[bake] model = \"microfacet\"`",
            )
        };
        return Some(material.diagnostic(Severity::Error, key, message, Some(hint.to_owned())));
    }
    if model.takes(ModelPart::CavityMasking) {
        let message = "the masking `kelemen` leaves G out, and does not depend on the roughness: in mirror directions it is 1, as of V-cavities, and \
                       away from them facets hide more of each other";
        let hint = "`v-cavity`, the default, is the masking of the papers".to_owned();
        let doubt = material.diagnostic(Severity::Warning, key, message, Some(hint));
        return (masking == Masking::Kelemen).then_some(doubt);
    }
    // Of a perfect mirror, alpha 0.5, at 0 and 85 degrees, by `luthier eval --furnace`.
    let effect = match masking {
        Masking::Smith => return None,
        Masking::SmithSeparable => {
            "takes the heights of facets twice: a mirror of alpha 0.5 returns 0.69 to 0.78 of the light, with `smith` 0.69 to 0.87"
        }
        Masking::SchlickSmith => {
            "is a fit that loses light: a mirror of alpha 0.5 returns 0.45 to 0.62, with `smith` 0.69 to 0.87"
        }
        Masking::VCavity => {
            "hides nothing in mirror directions, so that highlights at grazing angles are too bright: f grows as 1 / cos^2"
        }
        Masking::Kelemen => {
            "does not depend on the roughness: a mirror of alpha 0.5 returns 0.60 to 0.81, with `smith` 0.69 to 0.87"
        }
        Masking::Implicit => {
            "is too dark: a mirror of alpha 0.1 returns 0.93 of the light from above, and 0.03 at 85 degrees"
        }
    };
    let hint = "`smith`, the default, is the masking that a rough surface without correlation has".to_owned();
    Some(material.diagnostic(Severity::Warning, key, format!("the masking `{name}` {effect}"), Some(hint)))
}

fn of_reflectance(material: &Material, model: ShadingModel, reflectance: Reflectance) -> Option<Diagnostic> {
    let (name, key) = (reflectance.name(), "bake.reflectance");
    if !model.takes(ModelPart::Reflectance) {
        let message = format!("the model `{model}` of this material has no reflectance `{name}`");
        let hint =
            "leave it out, or write `[bake] model = \"elek\"`, `\"weidlich-wilkie\"` or `\"microfacet\"`".to_owned();
        return Some(material.diagnostic(Severity::Error, key, message, Some(hint)));
    }
    if model.is_statistical() && reflectance == Reflectance::Exact {
        let message = format!(
            "the reflectance `{name}` takes facets as level: rough interfaces lack what tilted facets reflect, and nothing of a lobe is totally reflected"
        );
        let hint = "`table`, the default, has FGD-infinity, with all bounces between facets".to_owned();
        return Some(material.diagnostic(Severity::Warning, key, message, Some(hint)));
    }
    if !reflectance.is_fitted() {
        return None;
    }
    let layers = &material.stack.layers;
    let read = if model.facts().reach == Reach::First { layers.len().min(1) } else { layers.len() };
    if let Some(layer) = layers[..read].iter().position(|layer| !layer.films.is_empty()) {
        let message = format!("the reflectance `{name}` knows of no films, and this interface has one");
        let hint = "leave the film out, or write `[bake] reflectance = \"exact\"` or `\"table\"`".to_owned();
        return Some(material.diagnostic(Severity::Error, &format!("layer.{layer}.film.0.type"), message, Some(hint)));
    }
    let (layer, error, cos) = worst(material, reflectance, read)?;
    let message = format!(
        "the reflectance `{name}` is an approximation: of layer {} it is up to {error:.3} off, where the cosine is {cos:.2}",
        layer + 1
    );
    let hint = "`table`, the default, and `exact` have the reflectance itself".to_owned();
    Some(material.diagnostic(Severity::Warning, key, message, Some(hint)))
}

fn of_internal_reflection(
    material: &Material,
    model: ShadingModel,
    internal: InternalReflection,
) -> Option<Diagnostic> {
    let (name, key) = (internal.name(), "bake.internal_reflection");
    if !model.is_path() {
        let message = format!("the model `{model}` of this material has no internal reflection `{name}`");
        let hint = "leave it out, or write `[bake] model = \"elek\"` or `\"weidlich-wilkie\"`".to_owned();
        return Some(material.diagnostic(Severity::Error, key, message, Some(hint)));
    }
    let has_below = material.stack.layers.len() > 1;
    // Of a coat over a mirror, both of alpha 0.1, at 0 degrees, by `luthier eval --furnace`.
    let effect = match internal {
        InternalReflection::Facets => return None,
        _ if !has_below => "changes nothing here: no layer lies below the first",
        InternalReflection::None => {
            "lets out what facets would reflect back: over a mirror, coats of alpha 0.1 return 2.06 of the light, with `facets` 1.98 (index 1.5), and \
             4.33, with `facets` 3.58 (index 2.5)"
        }
        InternalReflection::Directions => {
            "knows no facets that hide each other, and reflects for each direction as a smooth interface does: right for smooth coats alone"
        }
    };
    let message = format!("the internal reflection `{name}` {effect}");
    let hint = "`facets`, the default, is the term t of the papers".to_owned();
    Some(material.diagnostic(Severity::Warning, key, message, Some(hint)))
}

fn of_lower_reflectance(material: &Material, model: ShadingModel, lower: LowerReflectance) -> Option<Diagnostic> {
    let (name, key) = (lower.name(), "bake.lower_reflectance");
    if !model.is_path() {
        let message = format!("the model `{model}` of this material has no lower reflectance `{name}`");
        let hint = "leave it out, or write `[bake] model = \"elek\"` or `\"weidlich-wilkie\"`".to_owned();
        return Some(material.diagnostic(Severity::Error, key, message, Some(hint)));
    }
    if lower == LowerReflectance::InPlace {
        return None;
    }
    let (color, in_air) = (material.color(), material.stack.with_lower_in_air());
    let mut worst: Option<(usize, f64, f64)> = None;
    for layer in 1..material.stack.layers.len() {
        let interfaces = [&material.stack, &in_air].map(|stack| Interface::of(stack, layer));
        let [Some(here), Some(air)] = interfaces else { continue };
        let [here, air] = [here, air].map(|interface| interface.sampled(&color).rgb(1.0));
        for (here, air) in here.into_iter().zip(air) {
            if worst.is_none_or(|(_, a, b)| (air - here).abs() > (b - a).abs()) {
                worst = Some((layer, here, air));
            }
        }
    }
    let effect = worst.map_or_else(
        || "changes nothing here: no interface lies below the first".to_owned(),
        |(layer, here, air)| {
            format!(
                "leaves out the medium above: layer {} reflects {air:.3} at normal incidence, and {here:.3} where it lies",
                layer + 1
            )
        },
    );
    let hint = "`in-place`, the default, is the reflectance of the interface".to_owned();
    Some(material.diagnostic(Severity::Warning, key, format!("the lower reflectance `{name}` {effect}"), Some(hint)))
}

fn of_lower_cosine(material: &Material, model: ShadingModel, lower: LowerCosine) -> Option<Diagnostic> {
    let (name, key) = (lower.name(), "bake.lower_cosine");
    if !model.takes(ModelPart::LowerCosine) {
        let message = format!("the model `{model}` of this material has no lower cosine `{name}`");
        let hint = "leave it out, or write `[bake] model = \"elek\"`".to_owned();
        return Some(material.diagnostic(Severity::Error, key, message, Some(hint)));
    }
    if lower == LowerCosine::Outside {
        return None;
    }
    let effect = if !has_lower_interface(material) {
        "changes nothing here: no interface lies below the first"
    } else {
        // By hand: cos(asin(sin 75 / 1.5)) / cos 75.
        "returns more light than falls in: below an index of 1.5, an interface is 2.96 times as bright for light at 75 degrees"
    };
    let message = format!("the lower cosine `{name}` {effect}");
    let hint = "`outside`, the default, is that of the light on the surface".to_owned();
    Some(material.diagnostic(Severity::Warning, key, message, Some(hint)))
}

/// The error for a part that only models of a path have.
fn of_paths(material: &Material, model: ShadingModel, key: &str, what: &str, models: &str) -> Diagnostic {
    let message = format!("the model `{model}` of this material has no {what}");
    let hint = format!("leave it out, or write `[bake] model = {models}");
    material.diagnostic(Severity::Error, key, message, Some(hint))
}

fn of_lower_facets(material: &Material, model: ShadingModel, lower: LowerFacets) -> Option<Diagnostic> {
    let (name, key) = (lower.name(), "bake.lower_facets");
    if !model.takes(ModelPart::LowerFacets) {
        let what = format!("lower facets `{name}`");
        return Some(of_paths(material, model, key, &what, "\"elek\"` or `\"weidlich-wilkie\"`"));
    }
    let effect = match lower {
        LowerFacets::TorranceSparrow => return None,
        _ if !has_lower_interface(material) => "change nothing here: no interface lies below the first",
        LowerFacets::BlinnPhong => {
            "are a lobe that is dark at grazing angles: of a mirror, one of alpha 0.3 has the albedo 0.84 at 0 degrees and 0.06 at 85"
        }
        LowerFacets::Phong => {
            "are a lobe that the horizon cuts: of a mirror, one of alpha 0.3 has the albedo 1.00 at 0 degrees and 0.22 at 85"
        }
    };
    let message = format!("the lower facets `{name}` {effect}");
    let hint = "`torrance-sparrow`, the default, are the facets of the papers".to_owned();
    Some(material.diagnostic(Severity::Warning, key, message, Some(hint)))
}

fn of_lower_alpha(material: &Material, model: ShadingModel, lower: LowerAlpha) -> Option<Diagnostic> {
    let (name, key) = (lower.name(), "bake.lower_alpha");
    if !model.takes(ModelPart::LowerAlpha) {
        return Some(of_paths(material, model, key, &format!("lower alpha `{name}`"), "\"weidlich-wilkie\"`"));
    }
    if lower == LowerAlpha::Own || has_smoother_below(material) {
        return None;
    }
    let message = format!("the lower alpha `{name}` changes nothing here: no interface is smoother than one above it");
    let hint = "leave it out".to_owned();
    Some(material.diagnostic(Severity::Warning, key, message, Some(hint)))
}

fn of_diffuse_part(material: &Material, model: ShadingModel, part: DiffusePart) -> Option<Diagnostic> {
    let (name, key) = (part.name(), "bake.diffuse_part");
    if !model.takes(ModelPart::DiffusePart) {
        let what = format!("diffuse part `{name}`");
        return Some(of_paths(material, model, key, &what, "\"elek\"` or `\"weidlich-wilkie\"`"));
    }
    let layers = &material.stack.layers;
    let is_base = layers.len() > 1 && layers.last().is_some_and(|last| matches!(last.base, Base::Diffuse(_)));
    let effect = match part {
        DiffusePart::Below => return None,
        DiffusePart::Beside if is_base => {
            "lets light through the last interface once, unbent and unabsorbed, where it crosses both ways"
        }
        DiffusePart::Beside => "changes nothing here: no diffuse base lies below an interface",
    };
    let message = format!("the diffuse part `{name}` {effect}");
    let hint = "`below`, the default, is a base below the interface".to_owned();
    Some(material.diagnostic(Severity::Warning, key, message, Some(hint)))
}

/// Whether an interface lies below the first.
fn has_lower_interface(material: &Material) -> bool {
    material.stack.layers.iter().skip(1).any(|layer| !matches!(layer.base, Base::Diffuse(_)))
}

/// Whether an interface may be smoother than one above it: maps of slopes leave it open.
fn has_smoother_below(material: &Material) -> bool {
    let of_interfaces = material.stack.layers.iter().filter(|layer| !matches!(layer.base, Base::Diffuse(_)));
    let alphas: Vec<[f64; 2]> = of_interfaces.map(|layer| [layer.surface.alpha_x, layer.surface.alpha_y]).collect();
    let mut above = 0.0;
    alphas.into_iter().any(|[x, y]| {
        let is_smoother = x.min(y) < above;
        above = f64::max(above, (x * y).sqrt());
        is_smoother
    }) || !material.images().is_empty()
}

fn of_diffuse_term(material: &Material, model: ShadingModel, term: DiffuseTerm) -> Option<Diagnostic> {
    let (name, key) = (term.name(), "bake.diffuse_term");
    if !model.takes(ModelPart::DiffuseTerm) {
        let message = format!("the model `{model}` of this material has no diffuse term `{name}`");
        let hint = "leave it out, or write `[bake] model = \"microfacet\"`".to_owned();
        return Some(material.diagnostic(Severity::Error, key, message, Some(hint)));
    }
    if term == DiffuseTerm::None {
        return None;
    }
    let effect = match (Interface::of(&material.stack, 0), material.stack.layers.last().map(|last| &last.base)) {
        (Some(first), Some(Base::Diffuse(base))) => {
            let mirrored = first.sampled(&material.color()).rgb(1.0);
            let [r, g, b] = [0, 1, 2].map(|c: usize| base.albedo[c] + mirrored[c]);
            format!(
                "adds the base as if nothing lay above it: albedo and reflectance at the normal sum to {r:.3}, {g:.3}, {b:.3}"
            )
        }
        _ => "changes nothing here: no interface lies above a diffuse base".to_owned(),
    };
    let message = format!("the diffuse term `{name}` {effect}");
    let hint = "models such as `lobes` follow the light of the base through the interface".to_owned();
    Some(material.diagnostic(Severity::Warning, key, message, Some(hint)))
}

/// The layer whose curve is farthest off, the error of its worst channel, and the cosine there.
fn worst(material: &Material, reflectance: Reflectance, layers: usize) -> Option<(usize, f64, f64)> {
    let color = material.color();
    let stack = material.reflecting_stack();
    let mut worst: Option<(usize, f64, f64)> = None;
    for layer in 0..layers {
        let Some(interface) = Interface::of(&stack, layer) else { continue };
        let sampled = interface.sampled(&color);
        let curves = if reflectance == Reflectance::Lazanyi { sampled.lazanyi() } else { sampled.schlick() };
        for cos in (1..=COSINES).map(|i| f64::from(i) / f64::from(COSINES)) {
            let exact = sampled.rgb(cos);
            let found =
                curves.map(|c| if reflectance == Reflectance::Lazanyi { c.eval(cos) } else { schlick(c.f0, cos) });
            let error = (0..3).map(|c| (found[c] - exact[c]).abs()).fold(0.0, f64::max);
            if worst.is_none_or(|(_, most, _)| error > most) {
                worst = Some((layer, error, cos));
            }
        }
    }
    worst
}
