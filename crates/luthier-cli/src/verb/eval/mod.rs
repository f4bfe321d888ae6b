mod sweep;
mod values;

use luthier_layers::model::Model;
use luthier_layers::monochrome::Monochrome;
use luthier_layers::registry::{model, models};
use luthier_material::Material;
use luthier_optics::color::GRANIER_WAVELENGTHS_NM;
use luthier_optics::stack::Stack;

use crate::cli::EvalOptions;
use crate::directions;
use crate::failure::{Failure, Outcome};
use crate::materials::{read_one, valid};
use crate::reradiation::Reradiation;
use sweep::{Sweep, sweep};
use values::{Kind, values};

/// What is evaluated: a model, with all that it takes, of a material.
struct Subject {
    model: Box<dyn Model>,
    material: Material,
    /// Wavelengths of the light and of what is seen, where these are two.
    bins_nm: Option<[f64; 2]>,
}

/// Evaluates a model of a material.
pub(crate) fn run(options: &EvalOptions) -> Outcome {
    let subject = subject(options)?;
    let asked =
        [(options.albedo, Sweep::Albedo), (options.furnace, Sweep::Furnace), (options.environment, Sweep::Environment)];
    if let Some((_, what)) = asked.into_iter().find(|(is_asked, _)| *is_asked) {
        return sweep(&subject, what, options.wavelength, options.json);
    }
    let pairs = match (&options.directions, options.wi, options.wo) {
        (Some(path), ..) => directions::read(path)?,
        (None, Some(wi), Some(wo)) => vec![[wi, wo]],
        // The command line asks for one or the other.
        (None, ..) => Vec::new(),
    };
    values(&subject, Kind::of(options, &subject), &pairs, options.json)
}

fn subject(options: &EvalOptions) -> Outcome<Subject> {
    let known = model(&options.model).ok_or_else(|| {
        let names: Vec<&str> = models().iter().map(|model| model.info().name).collect();
        Failure::unknown("model", &options.model, &names)
    })?;
    let inputs = &options.inputs;
    inputs.check(known.as_ref(), options.environment)?;
    let mut model = inputs.give(known);

    let files = std::iter::once(&options.file).chain(&inputs.other);
    let mut materials = valid(files.map(|file| read_one(file)).collect::<Outcome<_>>()?, false)?;
    // Without another material, the first is everywhere.
    let index = model.stack_index().min(materials.len() - 1);
    let material = materials.swap_remove(index);

    let mut bins_nm = None;
    if let (Some(path), Some(excitation), Some(seen)) = (&inputs.matrix, inputs.excitation, options.wavelength) {
        let matrix = Reradiation::read(path)?;
        let (reradiated, bins) = matrix.between(excitation, seen, |nm| at(&material.stack, nm))?;
        (model, bins_nm) = (Box::new(reradiated), Some(bins));
    }
    Ok(Subject { model: inputs.textured(model), material, bins_nm })
}

/// The stack at a wavelength, for the nearest channel.
fn at(stack: &Stack, wavelength_nm: f64) -> Monochrome {
    let distance = |channel: &usize| (GRANIER_WAVELENGTHS_NM[*channel] - wavelength_nm).abs();
    let channel = (0..3).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(1);
    Monochrome::new(stack, wavelength_nm, channel)
}

/// Seven digits.
fn significant(value: f64) -> String {
    format!("{value:.6e}")
}
