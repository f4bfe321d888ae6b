//! `eval`: a reflectance model of a material, in f64.

mod polarised;
mod shipped;
mod sweep;
mod values;

use std::sync::Arc;

use glam::{DVec2, DVec3};
use luthier::function::{self, Color, Inputs, Kind, Refusal, is_fitted, nearest_channel, textured};
use luthier::{Files, Source, Sources, TomlFile, surface_map};
use luthier_layers::model::{Estimate, WEIGHTS_MOST};
use luthier_layers::models::lobes::{Fit, Varied};
use luthier_layers::monochrome::Monochrome;
use luthier_layers::registry::{model, models};
use luthier_layers::twins::shaded::Place;
use luthier_material::{FileKind, Material};
use luthier_optics::stack::{Base, Layer, Stack};
use luthier_terminal::{Failure, Outcome, complain, valid};
use serde_json::{Value, json};

use crate::cli::EvalOptions;
use crate::directions;
use crate::materials::valid_surfaces;
use crate::reradiation::Reradiation;
use crate::store::store;
use sweep::{Sweep, sweep};
use values::values;

/// Wavelength of tables against the angle, unless another is given.
const WAVELENGTH_NM: f64 = 550.0;

/// Subject of an evaluation, and what the command line adds to it.
struct Subject {
    of: Arc<function::Subject>,
    /// Name of the surface, if the material is the one at a place of a surface.
    surface: Option<String>,
    /// Wavelengths of the light and of the light seen, if these differ.
    bins_nm: Option<[f64; 2]>,
}

impl Subject {
    /// The head of what is printed as JSON.
    fn head(&self) -> Value {
        let function::Subject { model, material, place, weight, has_effects, .. } = self.of.as_ref();
        let mut head = json!({"model": model.info().name, "material": material.name});
        if let Some(surface) = &self.surface {
            head["surface"] = json!(surface);
        }
        if let Some(weight) = weight {
            head["weight"] = json!(weight);
        }
        if *has_effects || self.surface.is_some() {
            head["place"] = json!({
                "normal": place.sample.normal.to_array(),
                "flake_normal": place.under.flake_normal.to_array(),
                "patina": place.patina.filter(|_| weight.is_none()).map(|patina| patina.amount),
            });
            if !place.layers.is_empty() {
                let layers = place.layers.iter().map(|own| {
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
    let sweeps =
        [(options.albedo, Sweep::Albedo), (options.furnace, Sweep::Furnace), (options.environment, Sweep::Environment)];
    if let Some((_, what)) = sweeps.into_iter().find(|(is_asked, _)| *is_asked) {
        let kind = asked(options, &subject).unwrap_or(Kind::Wavelength(WAVELENGTH_NM));
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
    if is_fitted(&subject.of.model.info()) && subject.of.place != Place::NONE {
        let what = "fitted to the stack at this place; `--out FOLDER` reads the rows that a bake ships";
        complain(&format!("note: lobes are {what}"));
    }
    let kind = asked(options, &subject).unwrap_or_else(|| Kind::Color(subject.of.material.color()));
    values(&subject, kind, &pairs, options.json)
}

/// The kind of values that the command line asks for; `None` where it asks for nothing particular.
fn asked(options: &EvalOptions, subject: &Subject) -> Option<Kind> {
    match (subject.bins_nm, options.wavelength) {
        (Some(bins_nm), _) => Some(Kind::Reradiated(bins_nm)),
        (None, Some(nm)) => Some(Kind::Wavelength(nm)),
        (None, None) if options.three_wavelengths => {
            Some(Kind::Color(Color::ThreeWavelengths(subject.of.material.bake.wavelengths_nm())))
        }
        (None, None) => options.rgb.then_some(Kind::Color(Color::Spectral)),
    }
}

/// A kind of values for programs.
fn describe(kind: &Kind) -> Value {
    match kind {
        Kind::Wavelength(nm) => json!({"wavelength_nm": nm}),
        Kind::Reradiated([light, seen]) => json!({"excitation_nm": light, "wavelength_nm": seen}),
        Kind::Color(Color::Spectral) => json!("spectral"),
        Kind::Color(Color::ThreeWavelengths(nm)) => json!({"three_wavelengths_nm": nm}),
    }
}

/// A refusal in the words of the command line.
fn refused(refusal: Refusal) -> Failure {
    let text = match &refusal {
        Refusal::Live(text) => format!("--live: {text}"),
        Refusal::Weights { given, layers } => format!(
            "--weights has {given} numbers: give one for each of the {layers} layers, at most {WEIGHTS_MOST}, and one of them above 0"
        ),
        Refusal::NoWeight { file } => {
            format!("{file} has no coat or film with a weight below 1 or in a map: leave --weight-factor out")
        }
        Refusal::NoPlace { model } => {
            format!("model `{model}` has no place: leave --slab-factor and --film-factor out for a coat with a weight")
        }
        _ => return Failure::input(refusal),
    };
    Failure::Usage(anyhow::anyhow!(text))
}

fn subject(options: &EvalOptions, name: &str) -> Outcome<Subject> {
    let known = model(name).ok_or_else(|| {
        let names: Vec<&str> = models().iter().map(|model| model.info().name).collect();
        Failure::unknown("model", name, &names)
    })?;
    let (inputs, given): (_, Inputs) = (&options.inputs, options.inputs.given());
    let (first, other, picked) = materials(options)?;
    let fit: Arc<Fit<'static>> = if is_fitted(&known.info()) { function::fits(store()?) } else { Arc::new(Varied::of) };
    let (shown, dropped) = given.shown(&first, known.as_ref());
    let (maps, unshown) = given.layer_maps(&first, known.as_ref());
    let has_weight_map = given.weight_map(&first).is_some();
    inputs.check(known.as_ref(), &shown, has_weight_map || !maps.is_empty(), picked.is_some(), options.environment)?;
    if !maps.is_empty() && (options.furnace || options.environment) {
        let text = "a furnace and an environment have no place: leave the maps of layers out with `--no-effects`";
        return Err(Failure::Usage(anyhow::anyhow!(text)));
    }
    let (surface, normal) = picked.unzip();
    let mut of = function::Subject::new(known, first, other, fit, &given, normal).map_err(refused)?;
    let file = &of.material.source;
    if !dropped.is_empty() {
        let names = dropped.join(" and ");
        complain(&format!("note: model `{name}` does not show the {names} of {file}; `elek` and `weidlich-wilkie` do"));
    }
    if !unshown.is_empty() {
        let names = unshown.join(" and ");
        complain(&format!("note: model `{name}` does not show {names} of {file}"));
    }
    for text in unheard(&of.material.stack, &given) {
        complain(&format!("note: {text} of {file}"));
    }
    let is_isotropic = of.model.info().shading().is_some_and(|model| model.facts().is_isotropic);
    if is_isotropic && of.material.stack.layers.iter().any(Layer::is_anisotropic) {
        complain(&format!("note: model `{name}` leaves out anisotropy of {file}: it takes mean slope parameters"));
    }
    let mut bins_nm = None;
    if let (Some(path), Some(excitation), Some(seen)) = (&inputs.matrix, inputs.excitation, options.wavelength) {
        let matrix = Reradiation::read(path)?;
        let (reradiated, bins) = matrix.between(excitation, seen, |nm| at(&of.material.stack, nm))?;
        of.model = textured(of.place.sample, Box::new(reradiated));
        bins_nm = Some(bins);
    }
    Ok(Subject { of: Arc::new(of), surface, bins_nm })
}

/// Factors that change nothing, because the first layer of a stack has no part that they are on.
fn unheard(stack: &Stack, given: &Inputs) -> Vec<&'static str> {
    let Some(first) = stack.layers.first() else { return Vec::new() };
    let has_slab = matches!(first.base, Base::Dielectric { .. });
    let parts = [
        (
            given.slab_factor.is_some() && !has_slab,
            "--slab-factor changes nothing: no slab is below the first interface",
        ),
        (
            given.film_factor.is_some() && first.films.is_empty(),
            "--film-factor changes nothing: no film is on the first interface",
        ),
    ];
    parts.into_iter().filter_map(|(is_unheard, text)| is_unheard.then_some(text)).collect()
}

/// Name of a surface, and the normal at the place.
type Picked = (String, DVec3);

/// The material of the file and the material of `--other`. For a surface file, it is the material at the place, with the name of the surface and its
/// normal there.
fn materials(options: &EvalOptions) -> Outcome<(Material, Option<Material>, Option<Picked>)> {
    let inputs = &options.inputs;
    let file = TomlFile::read(&options.file)?;
    if file.kind() != FileKind::Surface {
        let other = inputs.other.as_ref().map(|other| Source::read(other)).transpose()?;
        let mut materials = valid([Source::of(file)].into_iter().chain(other).collect(), false)?.into_iter();
        let first = materials.next().unwrap_or_else(|| unreachable!("the file is one of the materials"));
        return Ok((first, materials.next(), None));
    }
    if inputs.other.is_some() {
        let text = "a surface has materials of its own: leave out `--other`";
        return Err(Failure::Usage(anyhow::anyhow!(text)));
    }
    let mut sources = Sources::of(Files::of(vec![file]));
    sources.refuse_surfaces();
    let surface = valid_surfaces(&sources.surfaces)?.swap_remove(0);
    let mut materials = valid(sources.materials, false)?;
    let pick = surface_map(&surface).pick(inputs.given().uv.unwrap_or(DVec2::ZERO));
    Ok((materials.swap_remove(pick.stack), None, Some((surface.name, pick.normal))))
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
