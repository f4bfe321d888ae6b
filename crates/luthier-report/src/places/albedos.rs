//! Directional albedos of a material at places that a caller names: by a formula of the surface, by the simulation of its layers, and by its model.

use glam::DVec3;
use luthier_layers::directional_albedo::over_hemisphere;
use luthier_manifest::PlaceValues;
use luthier_optics::Rgb;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::Site;
use super::site::Mean;
use crate::error::ReportError;
use crate::measure::subject::Subject;
use crate::models::{PHI_DEG, direction};

/// Settings of the comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct AlbedoSettings {
    /// Angles of the eye against the normal, degrees.
    pub thetas_deg: Vec<f64>,
    /// Paths of light from each angle, of all places together.
    pub paths: u64,
    /// Family of random numbers.
    pub seed: u64,
}

impl Default for AlbedoSettings {
    /// Five angles, with so many paths that the standard error is at most 0.004.
    fn default() -> Self {
        Self { thetas_deg: vec![0.0, 30.0, 60.0, 75.0, 85.0], paths: 1 << 14, seed: 1 }
    }
}

/// Albedos from an angle, RGB: means over the places.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AlbedosAt {
    /// Angle of the eye against the normal, degrees.
    pub theta_deg: f64,
    /// Albedo by the formula of the surface.
    pub formula: Rgb,
    /// Albedo of the simulated layers.
    pub simulated: Rgb,
    /// Standard error of the simulated albedo; it is an upper bound, because the paths fill their cube evenly.
    pub std_err: Rgb,
    /// Albedo by the model of the material, with the rows that ship.
    pub model: Rgb,
}

/// Compares albedos of a material, by its number, at places. Each has its values and a formula, which gives `f cos_theta_i` of directions to the light and to
/// the eye. The eye is at the azimuth [`PHI_DEG`].
///
/// # Errors
/// As [`Rows::new`](super::Rows::new).
pub fn albedos<F: Fn(DVec3, DVec3) -> Rgb + Sync>(
    subject: &Subject<'_>,
    material: usize,
    places: &[(PlaceValues, F)],
    settings: &AlbedoSettings,
) -> Result<Vec<AlbedosAt>, ReportError> {
    let sites: Vec<Site<'_>> =
        places.par_iter().map(|(values, _)| Site::new(subject, material, values)).collect::<Result<_, _>>()?;
    let count = settings.paths.div_ceil(places.len().max(1) as u64);
    let of_angle = |&theta_deg: &f64| {
        let wo = direction(theta_deg, PHI_DEG);
        let mirrored = DVec3::new(-wo.x, -wo.y, wo.z);
        let found = places.par_iter().zip(&sites).enumerate().map(|(number, ((_, formula), site))| {
            let [formula, model] = [
                over_hemisphere(mirrored, |wi| formula(wi, wo)).0,
                over_hemisphere(mirrored, |wi| site.eval(wi, wo)).0,
            ];
            (formula, site.simulated(settings.seed + number as u64, count, wo), model)
        });
        let found: Vec<(Rgb, Mean, Rgb)> = found.collect();
        let mean = |of: &dyn Fn(&(Rgb, Mean, Rgb)) -> f64| found.iter().map(of).sum::<f64>() / found.len() as f64;
        let rgb = |of: &dyn Fn(&(Rgb, Mean, Rgb)) -> Rgb| [0, 1, 2].map(|c: usize| mean(&|one| of(one)[c]));
        let variance = rgb(&|one| one.1.std_err.map(|error| error * error));
        AlbedosAt {
            theta_deg,
            formula: rgb(&|one| one.0),
            simulated: rgb(&|one| one.1.mean),
            std_err: variance.map(|variance| (variance / found.len() as f64).sqrt()),
            model: rgb(&|one| one.2),
        }
    };
    Ok(settings.thetas_deg.iter().map(of_angle).collect())
}
