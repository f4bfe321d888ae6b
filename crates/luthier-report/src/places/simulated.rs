//! Rows of lobes at places against the simulation of the stack that the material file means there.

use glam::DVec3;
use luthier_layers::models::lobes::Lobes;
use luthier_layers::twins::shaded::Place;
use luthier_manifest::{LayerValues, MaterialEntry, PlaceValues};
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::stack::{Base, Stack};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::{PLACE_FLOOR, Places, Rows, rows, words};
use crate::error::ReportError;
use crate::measure::references::bare_stack;
use crate::measure::statistics::UNCERTAINTY_MARGIN;
use crate::measure::subject::{Subject, color};
use crate::measure::table_terms::Weights;
use crate::models::colored::{ColorView, ViewErrors};
use crate::models::{PHI_DEG, ReferenceSettings, direction};

/// Settings of the simulation at places.
#[derive(Debug, Clone)]
pub struct SimulatedSettings {
    /// Random places of a material.
    pub places: u64,
    /// Angles of the eye at every place, degrees; if empty, each place has one angle of its own.
    pub thetas_deg: Vec<f64>,
    /// Noise of the simulation.
    pub reference: ReferenceSettings,
    /// Family of the places.
    pub seed: u64,
}

impl Default for SimulatedSettings {
    /// Eight places, each from its own angle, with so little noise that an error of a twentieth of the light shows: a few tenths of a second.
    fn default() -> Self {
        let reference = ReferenceSettings { noise: 0.04, albedo_std_err: 3e-3, most: 1 << 16, seed: 1 << 50 };
        Self { places: 8, thetas_deg: Vec::new(), reference, seed: super::PLACES_SEED }
    }
}

/// Limit on the lobe error of rows at a place, beside noise.
const LOBE_AT_PLACES: f64 = 0.08;

/// Limit on the absolute error of the directional albedo, beside noise.
const ALBEDO_AT_PLACES: f64 = 0.02;

/// Limit on the error of the mean of grazing light over max(itself, 0.01), beside noise.
const GRAZING_AT_PLACES: f64 = 0.08;

/// Errors of rows of lobes at a place, from an angle of the eye.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SimulatedAt {
    /// Number of the place, see [`Places::place`].
    pub number: u64,
    /// Values of the maps there, in words.
    pub place: String,
    /// Angle of the eye against the normal.
    pub theta_deg: f64,
    /// Lobe error of the worst channel, and the lobe error that noise alone causes on average.
    pub lobe: [f64; 2],
    /// Absolute error of the directional albedo in the worst channel, and the standard error of the simulation there.
    pub albedo: [f64; 2],
    /// Directional albedo of the rows and of the simulation in that channel.
    pub albedos: [f64; 2],
    /// Error of the mean of `f cos_theta_i` over light flatter than 87.1 degrees, relative to max(the mean, [`PLACE_FLOOR`]), and its standard error. 0 for
    /// an eye flatter than 78.5 degrees, which has its highlight in that light.
    pub grazing: [f64; 2],
}

impl SimulatedAt {
    /// Quantities that exceed their limit by more than noise, each with its error and the limit.
    pub fn misses(&self) -> Vec<(&'static str, f64, f64)> {
        [
            ("lobe error", self.lobe, LOBE_AT_PLACES, 1.5),
            ("error of the albedo", self.albedo, ALBEDO_AT_PLACES, UNCERTAINTY_MARGIN),
            ("error of grazing light", self.grazing, GRAZING_AT_PLACES, UNCERTAINTY_MARGIN),
        ]
        .into_iter()
        .filter(|(_, [error, noise], limit, margin)| *error > limit + margin * noise)
        .map(|(name, [error, _], limit, _)| (name, error, limit))
        .collect()
    }

    /// The largest ratio of such an error to its limit; 0 without any.
    pub fn excess(&self) -> f64 {
        self.misses().iter().map(|(_, found, limit)| found / limit).fold(0.0, f64::max)
    }

    /// Place, angle and misses in words.
    pub fn words(&self) -> String {
        let misses: Vec<String> =
            self.misses().iter().map(|(name, found, limit)| format!("{name} {found:.3} for {limit}")).collect();
        let ([stated, simulated], theta_deg) = (self.albedos, self.theta_deg);
        format!(
            "at place {} ({}), seen from {theta_deg:.1} degrees, its lobes are not the simulated stack: {} (albedo {stated:.4}, simulated {simulated:.4})",
            self.number,
            self.place,
            misses.join(", ")
        )
    }
}

/// Errors of the rows of a material at random places.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SimulatedErrors {
    /// Every place and angle.
    pub views: Vec<SimulatedAt>,
    /// Paths that were traced.
    pub paths: u64,
}

impl SimulatedErrors {
    /// The largest value of a quantity, with its noise.
    pub fn worst(&self, of: impl Fn(&SimulatedAt) -> [f64; 2]) -> [f64; 2] {
        self.views.iter().map(of).fold([0.0; 2], |most, found| if found[0] > most[0] { found } else { most })
    }

    /// The views with a quantity beyond its limit.
    pub fn misses(&self) -> impl Iterator<Item = &SimulatedAt> {
        self.views.iter().filter(|view| !view.misses().is_empty())
    }
}

/// Compares shipped rows of lobes with the simulation at random places. `None` for materials of other models, for materials that are the same everywhere,
/// and for a diffuse base alone.
///
/// Places have the quantities that maps vary, with three exceptions. Normals of the surface are left out, because they only turn the frame of the eye. Flakes and normals of
/// single layers are left out, because their shift of the lobes is an approximation that is measured elsewhere (`luthier_layers::models::lobes::Below::tilted`). Patina and coats with a
/// weight are whole or absent, and a base is metal or not, because light is linear between.
///
/// # Errors
/// See [`ReportError`].
pub fn simulated(
    subject: &Subject<'_>,
    material: usize,
    settings: &SimulatedSettings,
) -> Result<Option<SimulatedErrors>, ReportError> {
    let entry = &subject.manifest.materials[material];
    let Some(places) = Places::of(subject, material).filter(|_| entry.model.is_fitted()) else {
        return Ok(None);
    };
    let stack = &subject.stacks[material];
    if stack.layers.first().is_none_or(|layer| matches!(layer.base, Base::Diffuse(_))) {
        return Ok(None);
    }
    let color = color(entry);
    let views: Vec<(u64, f64)> = (0..settings.places)
        .flat_map(|number| {
            // Own angles rotate the cosine by the golden ratio, from the normal to 86 degrees, so that few places spread evenly.
            let share = (number as f64 * 0.618_033_988_75).fract();
            let own = libm::acos(1.0 - 0.93 * share).to_degrees();
            let all = if settings.thetas_deg.is_empty() { vec![own] } else { settings.thetas_deg.clone() };
            all.into_iter().map(move |theta_deg| (number, theta_deg))
        })
        .collect();
    let found = views.par_iter().map(|&(number, theta_deg)| {
        let values = upright(number, places.place(settings.seed, number), entry);
        let Some(here) = meant(stack, &rows::place(&values, entry), entry) else { return Ok(None) };
        let view = ColorView::new(&here, &color, entry.wavelengths_nm, theta_deg, settings.reference);
        let rows = Rows::new(subject, material, &values, Weights::Exact)?;
        Ok(Some(seen(number, &values, theta_deg, &view, |wi, wo| rows.eval(wi, wo))))
    });
    let found: Vec<Option<(SimulatedAt, u64)>> = found.collect::<Result<_, ReportError>>()?;
    let (views, paths): (Vec<SimulatedAt>, Vec<u64>) = found.into_iter().flatten().unzip();
    Ok((!views.is_empty()).then(|| SimulatedErrors { views, paths: paths.iter().sum() }))
}

/// The errors at a view of [`simulated`], but of lobes that `fit` makes for the stack of the place; `None` if the place has no lobes.
pub fn simulated_by(
    subject: &Subject<'_>,
    material: usize,
    settings: &SimulatedSettings,
    at: &SimulatedAt,
    fit: &dyn Fn(&Stack, &Color) -> Lobes,
) -> Option<SimulatedAt> {
    let entry = subject.manifest.materials.get(material)?;
    let values = upright(at.number, Places::of(subject, material)?.place(settings.seed, at.number), entry);
    let here = meant(&subject.stacks[material], &rows::place(&values, entry), entry)?;
    let color = color(entry);
    let view = ColorView::new(&here, &color, entry.wavelengths_nm, at.theta_deg, settings.reference);
    let lobes = fit(&here, &color);
    Some(seen(at.number, &values, at.theta_deg, &view, |wi, wo| lobes.eval(wi, wo)).0)
}

/// Errors of values at a view, with the number of its paths.
fn seen(
    number: u64,
    place: &PlaceValues,
    theta_deg: f64,
    view: &ColorView,
    values: impl Fn(DVec3, DVec3) -> Rgb,
) -> (SimulatedAt, u64) {
    let wo = direction(theta_deg, PHI_DEG);
    let ViewErrors { lobe, albedo, albedos, grazing, paths } = view.errors(|wi| values(wi, wo), PLACE_FLOOR);
    (SimulatedAt { number, place: words(place), theta_deg, lobe, albedo, albedos, grazing }, paths)
}

/// The place without normals, with a base that is metal or not, and with patina or a coat whole or absent: a coat by turns.
fn upright(number: u64, values: PlaceValues, entry: &MaterialEntry) -> PlaceValues {
    let PlaceValues { normal, flake_normal, .. } = PlaceValues::NONE;
    let patina = values.patina.map(|amount| if amount >= 0.5 && scatters_nothing(entry) { 1.0 } else { 0.0 });
    let weight = entry.constants.coat.as_ref().map_or(1.0, |coat| coat.weight);
    let is_covered = weight > 0.0 && number.is_multiple_of(2);
    let weight_factor = if is_covered { (1.0 / weight) as f32 } else { 0.0 };
    let layers = values.layers.iter().map(|own| LayerValues { normal: LayerValues::NONE.normal, ..*own }).collect();
    let metallic = values.metallic.map(|(color, metallic)| (color, if metallic >= 0.5 { 1.0 } else { 0.0 }));
    PlaceValues { normal, flake_normal, patina, weight_factor, layers, metallic, ..values }
}

/// Whether fully grown patina is nothing but its layers.
fn scatters_nothing(entry: &MaterialEntry) -> bool {
    entry.constants.patina.as_ref().is_none_or(|patina| {
        patina.diffuse_albedo == [0.0; 3] && patina.base_alpha.is_none() && patina.tarnish == [1.0; 3]
    })
}

/// The stack that the material file means at a place; `None` for a diffuse base alone, whose light has a closed form.
fn meant(stack: &Stack, place: &Place, entry: &MaterialEntry) -> Option<Stack> {
    let whole = place.stack(stack);
    let is_bare = entry.constants.bare().is_some() && place.patina.is_some_and(|growth| growth.amount < 0.5);
    let here = if is_bare { bare_stack(entry, &whole) } else { whole };
    let is_interface = here.layers.first().is_some_and(|layer| !matches!(layer.base, Base::Diffuse(_)));
    is_interface.then_some(here)
}
