//! A material in a format.

use std::io;

use luthier_import::{Fate, Line};
use luthier_material::Material;

use crate::closed::{Closed, closed};
use crate::fit::fitted;
use crate::light::{Light, Residual, Settings, worst_albedo, worst_lobe};
use crate::maps::{self, Texture};
use crate::surface::Surface;
use crate::{Format, Numbers, formula};

/// A material in a format, with what remains.
#[derive(Debug, Clone)]
pub struct Exported {
    /// Its name.
    pub name: String,
    /// The format.
    pub format: Format,
    /// Numbers; textures multiply them.
    pub numbers: Numbers,
    /// Textures.
    pub textures: Vec<Texture>,
    /// Properties of the layers, and what became of each.
    pub lines: Vec<Line>,
    /// How many numbers were fitted.
    pub fitted: usize,
    /// Errors by angle.
    pub residuals: Vec<Residual>,
}

impl Exported {
    /// The largest difference of directional albedos, over angles and channels.
    pub fn albedo_error(&self) -> f64 {
        worst_albedo(&self.residuals)
    }

    /// The largest lobe error, over angles and channels.
    pub fn lobe_error(&self) -> f64 {
        worst_lobe(&self.residuals)
    }

    /// The largest lobe error that noise alone makes.
    pub fn lobe_floor(&self) -> f64 {
        self.residuals.iter().flat_map(|at| at.lobe_floor).fold(0.0, f64::max)
    }
}

/// Weight of a fitted coat that is none.
const LEAST_COAT: f64 = 1e-3;

/// A material in a format. `files` reads its pictures by their paths in the material file; one that cannot be read is dropped, and told.
///
/// The result depends on the arguments alone, not on the number of threads.
pub fn exported(
    material: &Material,
    format: Format,
    settings: &Settings,
    files: &dyn Fn(&str) -> io::Result<Vec<u8>>,
) -> Exported {
    let (surface, mut lines) = Surface::of(material);
    let Closed { numbers, free, lines: own } = closed(format, &surface);
    let color = material.color();
    let light = Light::of(material, settings);
    let count = free.iter().map(|free| free.count()).sum();
    let mut numbers = fitted(format, numbers, &free, &light, &color);
    if numbers.coat.as_ref().is_some_and(|coat| coat.weight < LEAST_COAT) {
        numbers.coat = None;
        let note = "the fit gives its light to the base".to_owned();
        lines.push(Line { property: "coat".to_owned(), fate: Fate::Approximated, note });
    }
    let values = formula::values(format, &numbers, &color);
    let residuals = light.residuals(&values);
    lines.splice(0..0, own);
    let textures = maps::textures(material, format, &surface, &mut numbers, files, &mut lines);
    Exported { name: material.name.clone(), format, numbers, textures, lines, fitted: count, residuals }
}
