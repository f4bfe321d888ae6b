//! `eval`: a reflectance model of a material, in f64.

mod function;
mod live;
mod place;
mod polarised;
mod shipped;
mod sweep;
mod values;

use std::sync::Arc;

use glam::{DVec2, DVec3};
use luthier_bake::fitted;
use luthier_layers::model::{Estimate, Model, ModelInfo};
use luthier_layers::models::lobes::{Fit, Fitted, Varied};
use luthier_layers::monochrome::Monochrome;
use luthier_layers::registry::{model, models};
use luthier_layers::twins::shaded::{Growth, Place, Side};
use luthier_manifest::ShadingModel;
use luthier_material::{FileKind, Material};
use luthier_optics::color::{Color, GRANIER_WAVELENGTHS_NM};
use luthier_optics::stack::Stack;
use serde_json::{Value, json};

use crate::cli::EvalOptions;
use crate::directions;
use crate::materials::valid_surfaces;
use crate::model_inputs::ModelInputs;
use crate::reradiation::Reradiation;
use crate::store::store;
use function::Kind;
use luthier::refusals::of_function;
use luthier::{Files, Source, Sources, TomlFile, surface_map};
use luthier_terminal::{Failure, Outcome, complain, valid};
use place::{add_layers, place, weight};
use sweep::{Sweep, sweep};
use values::values;

/// Wavelength of tables against the angle, unless another is given.
const WAVELENGTH_NM: f64 = 550.0;

/// Subject of an evaluation: a model with its inputs, and a material.
struct Subject {
    model: Box<dyn Model>,
    material: Material,
    /// Gives the model `lobes` its lobes.
    fit: Arc<Fit<'static>>,
    place: Place,
    /// Share of the surface that the first layer covers, if that is a coat with a weight and the model shows it.
    weight: Option<f64>,
    /// Name of the surface, if the material is the one at a place of a surface.
    surface: Option<String>,
    /// Whether effects of the file are in the place.
    has_effects: bool,
    /// Wavelengths of the light and of the light seen, if these differ.
    bins_nm: Option<[f64; 2]>,
}

impl Subject {
    /// The head of what is printed as JSON.
    fn head(&self) -> Value {
        let mut head = json!({"model": self.model.info().name, "material": self.material.name});
        if let Some(surface) = &self.surface {
            head["surface"] = json!(surface);
        }
        if let Some(weight) = self.weight {
            head["weight"] = json!(weight);
        }
        if self.has_effects || self.surface.is_some() {
            head["place"] = json!({
                "normal": self.place.sample.normal.to_array(),
                "flake_normal": self.place.under.flake_normal.to_array(),
                "patina": self.place.patina.filter(|_| self.weight.is_none()).map(|patina| patina.amount),
            });
            if !self.place.layers.is_empty() {
                let layers = self.place.layers.iter().map(|own| {
                    json!({
                        "normal": own.normal.to_array(),
                        "alpha_factors": own.alpha_factors,
                        "tangent": own.tangent.to_array(),
                        "slab_factor": own.slab_factor,
                        "absorption_factors": own.absorption_factors,
                    })
                });
                head["place"]["layers"] = layers.collect();
            }
        }
        head
    }
}

/// Evaluates a model of a material.
pub(crate) fn run(options: &EvalOptions) -> Outcome {
    let Some(name) = &options.model else {
        // The command line asks for a model wherever one is needed.
        let material = valid(vec![Source::read(&options.file)?], false)?.swap_remove(0);
        let kind = match options.wavelength {
            None if options.three_wavelengths => Kind::Color(Color::ThreeWavelengths(material.bake.wavelengths_nm())),
            None if options.rgb => Kind::Color(Color::Spectral),
            nm => Kind::Wavelength(nm.unwrap_or(WAVELENGTH_NM)),
        };
        return polarised::polarised(&material, &kind, &sweep::thetas_deg(options), options.json);
    };
    let subject = subject(options, name)?;
    let asked =
        [(options.albedo, Sweep::Albedo), (options.furnace, Sweep::Furnace), (options.environment, Sweep::Environment)];
    if let Some((_, what)) = asked.into_iter().find(|(is_asked, _)| *is_asked) {
        let kind = Kind::asked(options, &subject).unwrap_or(Kind::Wavelength(WAVELENGTH_NM));
        return sweep(&subject, what, &kind, options);
    }
    let pairs = match (&options.directions, options.wi, options.wo) {
        (Some(path), ..) => directions::read(path)?,
        (None, Some(wi), Some(wo)) => vec![[wi, wo]],
        // The command line asks for one or the other.
        (None, ..) => Vec::new(),
    };
    if let Some(folder) = &options.out {
        return shipped::shipped(&subject, folder, &pairs, options.json);
    }
    if is_fitted(&subject.model.info()) && subject.place != luthier_layers::twins::shaded::Place::NONE {
        let what = "fitted to the stack at this place; `--out FOLDER` reads the rows that a bake ships";
        complain(&format!("note: lobes are {what}"));
    }
    let kind = Kind::asked(options, &subject).unwrap_or_else(|| Kind::Color(subject.material.color()));
    values(&subject, kind, &pairs, options.json)
}

/// Whether a model is fitted to a simulation of the stack.
fn is_fitted(model: &ModelInfo) -> bool {
    model.shading().is_some_and(ShadingModel::is_fitted)
}

fn subject(options: &EvalOptions, name: &str) -> Outcome<Subject> {
    let mut known = model(name).ok_or_else(|| {
        let names: Vec<&str> = models().iter().map(|model| model.info().name).collect();
        Failure::unknown("model", name, &names)
    })?;
    let inputs = &options.inputs;
    let (mut materials, picked) = materials(options)?;
    let mut fit: Arc<Fit<'static>> = Arc::new(Varied::of);
    if is_fitted(&known.info()) {
        let store = store()?;
        fit = Arc::new(|stack, color, varying| fitted(stack, color, varying, store));
        known = Box::new(Fitted::by(fit.clone()));
    }
    let (shown, dropped) = inputs.shown(&materials[0], known.as_ref());
    let (maps, unshown) = inputs.layer_maps(&materials[0], known.as_ref());
    let has_weight_map = inputs.weight_map(&materials[0]).is_some();
    inputs.check(known.as_ref(), &shown, has_weight_map || !maps.is_empty(), picked.is_some(), options.environment)?;
    if !maps.is_empty() && (options.furnace || options.environment) {
        let text = "a furnace and an environment have no place: leave the maps of layers out with `--no-effects`";
        return Err(Failure::Usage(anyhow::anyhow!(text)));
    }
    inputs.check_weights(&materials[0])?;
    let mut model = inputs.give(known);

    // Without another material, the first is everywhere.
    let index = model.stack_index().min(materials.len() - 1);
    let material = materials.swap_remove(index);
    if let Some(error) = of_function(&material, name) {
        return Err(Failure::Input(anyhow::anyhow!("{}: {}", error.label, error.message)));
    }
    if !dropped.is_empty() {
        let (names, file) = (dropped.join(" and "), &material.source);
        complain(&format!("note: model `{name}` does not show the {names} of {file}; `elek` and `weidlich-wilkie` do"));
    }

    if !unshown.is_empty() {
        let (names, file) = (unshown.join(" and "), &material.source);
        complain(&format!("note: model `{name}` does not show {names} of {file}"));
    }

    let mut bins_nm = None;
    if let (Some(path), Some(excitation), Some(seen)) = (&inputs.matrix, inputs.excitation, options.wavelength) {
        let matrix = Reradiation::read(path)?;
        let (reradiated, bins) = matrix.between(excitation, seen, |nm| at(&material.stack, nm))?;
        (model, bins_nm) = (Box::new(reradiated), Some(bins));
    }
    let mut place = place(&material, inputs, &shown)?;
    add_layers(&mut place, &material, model.info().shading(), inputs, &maps)?;
    if inputs.has_weight_factor() && material.weight().is_none() {
        let file = &material.source;
        let text = format!("{file} has no coat or film with a weight below 1 or in a map: leave --weight-factor out");
        return Err(Failure::Usage(anyhow::anyhow!(text)));
    }
    let weight = weight(&material, inputs)?.filter(|_| ModelInputs::shows_weight(&material, model.as_ref()));
    if let Some(weight) = weight.filter(|_| model.info().shading().is_some()) {
        place.patina = Some(Growth::of_coat(weight));
        let side = if material.weighs_film() { Side::Film } else { Side::Coat };
        place.side = material.has_side().then_some(side);
    } else if weight.is_some() && (place.sample.slab_factor, place.sample.film_factor) != (1.0, 1.0) {
        let text =
            format!("model `{name}` has no place: leave --slab-factor and --film-factor out for a coat with a weight");
        return Err(Failure::Usage(anyhow::anyhow!(text)));
    }
    if let Some((_, normal)) = picked.as_ref().filter(|(_, normal)| !inputs.has_normal() && normal.z < 1.0) {
        place.sample.normal = *normal;
    }
    let surface = picked.map(|(surface, _)| surface);
    let has_effects = shown != luthier_material::Effects::default() || !maps.is_empty() || !inputs.live.is_empty();
    Ok(Subject {
        model: ModelInputs::textured(place.sample, model),
        material,
        fit,
        place,
        weight,
        surface,
        has_effects,
        bins_nm,
    })
}

/// Name of a surface, and the normal at the place.
type Picked = (String, DVec3);

/// The material of the file and the material of `--other`. For a surface file, it is the material at the place, with the name of the surface and its
/// normal there.
fn materials(options: &EvalOptions) -> Outcome<(Vec<Material>, Option<Picked>)> {
    let inputs = &options.inputs;
    let file = TomlFile::read(&options.file)?;
    if file.kind() != FileKind::Surface {
        let other = inputs.other.as_ref().map(|other| Source::read(other)).transpose()?;
        return Ok((valid([Source::of(file)].into_iter().chain(other).collect(), false)?, None));
    }
    if inputs.other.is_some() {
        let text = "a surface has materials of its own: leave out `--other`";
        return Err(Failure::Usage(anyhow::anyhow!(text)));
    }
    let mut sources = Sources::of(Files::of(vec![file]));
    sources.refuse_surfaces();
    let surface = valid_surfaces(&sources.surfaces)?.swap_remove(0);
    let mut materials = valid(sources.materials, false)?;
    let pick = surface_map(&surface).pick(inputs.uv().unwrap_or(DVec2::ZERO));
    Ok((vec![materials.swap_remove(pick.stack)], Some((surface.name, pick.normal))))
}

/// The channel whose absorption and albedo are those at a wavelength.
fn nearest_channel(wavelength_nm: f64) -> usize {
    let distances = GRANIER_WAVELENGTHS_NM.map(|nm| (nm - wavelength_nm).abs());
    (0..3).min_by(|&a, &b| distances[a].total_cmp(&distances[b])).unwrap_or(1)
}

/// The stack at a wavelength, for the nearest channel.
fn at(stack: &Stack, wavelength_nm: f64) -> Monochrome {
    Monochrome::new(stack, wavelength_nm, nearest_channel(wavelength_nm))
}

/// Seven digits.
fn significant(value: f64) -> String {
    format!("{value:.6e}")
}

/// The standard error of an estimate as lists have it.
fn error(estimate: &Estimate) -> String {
    if estimate.is_settled() { significant(estimate.std_err) } else { "not-settled".to_owned() }
}
