//! The judge at places: shaders and tables of materials that vary over the surface, at random values of all varying quantities.
//!
//! A chain of three is compared, each with the next: the shader on the device; the f64 evaluation of the tables that ship, at the same place ([`Rows`]);
//! and the truth. For a model with closed terms the truth is exact terms at the place. For `lobes` it is the simulation of the stack that the material
//! file means there ([`simulated`]).
//!
//! [`Site`] has both at one place that a caller names, and [`albedos`] compares them, and any other formula of the surface, in a white furnace. [`Site::lit`] has the light
//! of all three under any surroundings.

mod albedos;
mod lit;
mod ranges;
mod rows;
mod simulated;
mod site;

use luthier_manifest::{Form, PlaceValues};
use luthier_optics::Rgb;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

pub use albedos::{AlbedoSettings, AlbedosAt, albedos};
pub use lit::Ways;
pub use ranges::Places;
pub use rows::Rows;
pub use simulated::{SimulatedAt, SimulatedErrors, SimulatedSettings, simulated, simulated_by};
pub use site::Site;

use crate::error::ReportError;
use crate::measure::device::{Device, run_at};
use crate::measure::directions::{DirectionSet, Pair, wide};
use crate::measure::scan::DOMAIN_COS_THETA;
use crate::measure::statistics::{ErrorSummary, FLOOR, brightest, relative_error, summarise};
use crate::measure::subject::Subject;
use crate::measure::table_terms::Weights;

/// Default seed of the random places.
pub const PLACES_SEED: u64 = 37;

/// Floor of the errors at places: |difference| over max(brightest channel, this).
pub const PLACE_FLOOR: f64 = 0.01;

/// Errors of values at random places and pairs of directions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlaceErrors {
    /// Samples that are NaN or infinite; they are in none of the errors.
    pub not_finite: u64,
    /// Relative to max(brightest channel of the reference, [`FLOOR`]).
    pub relative: ErrorSummary,
    /// Relative to max(brightest channel of the reference, [`PLACE_FLOOR`]).
    pub relative_dim: ErrorSummary,
    /// The worst sample by `relative`.
    pub worst: Option<WorstPlace>,
}

/// The worst sample: a place, a pair of directions and a channel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WorstPlace {
    /// Number of the place, see [`Places::place`].
    pub number: u64,
    /// Values of the maps there, in words.
    pub place: String,
    /// Direction to the light.
    pub wi: [f32; 3],
    /// Direction to the eye.
    pub wo: [f32; 3],
    /// Channel, 0-based.
    pub channel: u32,
    /// Reference there.
    pub expected: f64,
    /// Value that was judged.
    pub found: f64,
    /// Error relative to max(brightest channel of the reference, [`FLOOR`]).
    pub error: f64,
}

impl PlaceErrors {
    fn new(spots: &[Spot], found: &[Rgb], expected: &[Rgb]) -> Self {
        let (mut not_finite, mut worst) = (0, None::<(usize, usize, f64)>);
        let (mut relative, mut dim) = (Vec::new(), Vec::new());
        for (n, (found, expected)) in found.iter().zip(expected).enumerate() {
            let bright = brightest(expected);
            for c in 0..3 {
                let error = relative_error(found[c], expected[c], bright, FLOOR);
                if !error.is_finite() {
                    not_finite += 1;
                    continue;
                }
                relative.push(error);
                dim.push(relative_error(found[c], expected[c], bright, PLACE_FLOOR));
                if worst.is_none_or(|(.., most)| error > most) {
                    worst = Some((n, c, error));
                }
            }
        }
        let worst = worst.map(|(n, channel, error)| {
            let Spot { number, place, pair: (wi, wo) } = &spots[n];
            let (expected, found) = (expected[n][channel], found[n][channel]);
            let (wi, wo, channel) = (*wi, *wo, channel as u32);
            WorstPlace { number: *number, place: words(place), wi, wo, channel, expected, found, error }
        });
        Self { not_finite, relative: summarise(relative), relative_dim: summarise(dim), worst }
    }

    /// The largest relative error; infinite when a sample is not finite.
    pub fn max_error(&self) -> f64 {
        if self.not_finite > 0 { f64::INFINITY } else { self.relative.max }
    }
}

/// A material at random places.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AtPlaces {
    /// Quantities that its maps and effects vary.
    pub varies: Vec<String>,
    /// Places, each with a pair of directions.
    pub places: u64,
    /// The shader on the device against f64 on the tables that ship; `None` without a device.
    pub shader: Option<PlaceErrors>,
    /// f64 on the tables that ship against exact terms at the place, for directions within 89.5 degrees. Closer to the horizon the resonances of a film
    /// are narrower than the spectral steps of the terms. `None` for models whose terms have no closed form.
    pub tables: Option<PlaceErrors>,
    /// Rows of `lobes` against the simulation of the stack at the place; `None` for other models.
    pub simulated: Option<SimulatedErrors>,
}

impl AtPlaces {
    /// The largest relative error of shader and tables.
    pub fn max_error(&self) -> f64 {
        [&self.shader, &self.tables].into_iter().flatten().map(PlaceErrors::max_error).fold(0.0, f64::max)
    }
}

/// A place and a pair of directions.
#[derive(Debug, Clone)]
pub(crate) struct Spot {
    number: u64,
    place: PlaceValues,
    pair: Pair,
}

/// Compares the shader of a material with f64 on the tables that ship, and these with exact terms, at `count` random places, each with its own pair of
/// directions. `device` comes with the weights with which it reads tables. `None` for a material that is the same everywhere.
///
/// # Errors
/// See [`ReportError`].
pub fn at_places(
    subject: &Subject<'_>,
    material: usize,
    device: Option<(&dyn Device, Weights)>,
    count: u32,
    seed: u64,
) -> Result<Option<AtPlaces>, ReportError> {
    let Some(places) = Places::of(subject, material) else { return Ok(None) };
    let entry = &subject.manifest.materials[material];
    let layers = luthier_layers::layers::Layers::isotropic_rgb(&subject.stacks[material]).layers;
    // Half of the pairs lie anywhere in the hemisphere, half in highlights.
    let sets = [DirectionSet::Random, DirectionSet::Highlight];
    let pairs = sets.map(|set| set.pairs(count.div_ceil(2), &layers));
    let spots: Vec<Spot> = (0..u64::from(count))
        .map(|number| {
            let pair = pairs[number as usize % 2][number as usize / 2];
            Spot { number, place: places.place(seed, number), pair }
        })
        .collect();
    let weights = device.map_or(Weights::EightBit, |(_, weights)| weights);
    let read = spots.par_iter().map(|spot| {
        let rows = Rows::new(subject, material, &spot.place, weights)?;
        Ok(rows.eval(wide(spot.pair.0), wide(spot.pair.1)))
    });
    let read: Vec<Rgb> = read.collect::<Result<_, ReportError>>()?;
    let shader = match device {
        Some((device, _)) => {
            let at: Vec<(PlaceValues, Pair)> = spots.iter().map(|spot| (spot.place.clone(), spot.pair)).collect();
            let found = run_at(device, Form::Baked, material as u32, &at)?;
            Some(PlaceErrors::new(&spots, &found, &read))
        }
        None => None,
    };
    // Exact energies and lobes would take seconds for each place.
    let is_closed = !(entry.model.is_statistical() || entry.model.is_fitted());
    let tables = is_closed.then(|| {
        let all = spots.iter().cloned().zip(read);
        let resolved = all.filter(|(Spot { pair: (wi, wo), .. }, _)| wi[2].min(wo[2]) >= DOMAIN_COS_THETA as f32);
        let (near, read): (Vec<Spot>, Vec<Rgb>) = resolved.unzip();
        let exact = near.par_iter().map(|spot| {
            let exact = rows::exact(subject, material, &spot.place);
            exact.map_or([f64::NAN; 3], |exact| exact.eval(wide(spot.pair.0), wide(spot.pair.1)))
        });
        PlaceErrors::new(&near, &read, &exact.collect::<Vec<_>>())
    });
    Ok(Some(AtPlaces { varies: places.quantities(), places: spots.len() as u64, shader, tables, simulated: None }))
}

/// A place in words: the values that differ from a place without textures.
pub(crate) fn words(place: &PlaceValues) -> String {
    let none = PlaceValues::NONE;
    let mut out = Vec::new();
    for (name, value, plain) in [
        ("alpha_factor", place.alpha_factor, none.alpha_factor),
        ("slab_factor", place.slab_factor, none.slab_factor),
        ("film_factor", place.film_factor, none.film_factor),
        ("patina", place.patina.unwrap_or(-1.0), -1.0),
        ("weight_factor", place.weight_factor, none.weight_factor),
    ] {
        if value != plain {
            out.push(format!("{name} {value:.4}"));
        }
    }
    for (name, value) in
        [("normal", place.normal), ("inner_normal", place.inner_normal), ("flake_normal", place.flake_normal)]
    {
        if value != none.normal {
            out.push(vector(name, value));
        }
    }
    out.extend(place.base_color.map(|color| vector("base_color", color)));
    out.extend(place.f0.map(|f0| vector("F0", f0)));
    out.extend(place.metallic.map(|(color, metallic)| format!("{}, metallic {metallic:.3}", vector("colour", color))));
    for (i, own) in place.layers.iter().enumerate() {
        let plain = luthier_manifest::LayerValues::NONE;
        if own.normal != plain.normal {
            out.push(vector(&format!("layers[{i}].normal"), own.normal));
        }
        if own.alpha_factors != plain.alpha_factors {
            let [x, y] = own.alpha_factors;
            out.push(format!("layers[{i}].alpha_factors ({x:.4}, {y:.4})"));
        }
        if own.slab_factor != plain.slab_factor {
            out.push(format!("layers[{i}].slab_factor {:.4}", own.slab_factor));
        }
        if own.absorption_factors != plain.absorption_factors {
            out.push(vector(&format!("layers[{i}].absorption_factors"), own.absorption_factors));
        }
    }
    if out.is_empty() { "no textures".to_owned() } else { out.join(", ") }
}

fn vector(name: &str, [x, y, z]: [f32; 3]) -> String {
    format!("{name} ({x:.3}, {y:.3}, {z:.3})")
}
