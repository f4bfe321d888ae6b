//! Baked materials as one HTML file that draws them.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! A [`Gallery`] has packages and exhibits. Each [`Exhibit`] is a material with one look or several: its numbers in packages, which differ by model. The shaders are
//! emitted anew in GLSL ES 3.00, one for each model of a package, so that a package needs none in that language.
//!
//! Pictures match those of luthier-gpu's ball in camera, light and surroundings, sample by sample. Surroundings that were blurred beforehand light
//! materials with tables of albedos (`luthier::lit`) or lobes; other materials draw directions.
//!
//! # Roughness
//!
//! The large picture has a slider: a factor on the slopes of all interfaces, from a quarter to four. It is the `alpha_factor` of a `LuthierPlace`,
//! which multiplies that of a roughness map where there is one. Shaders without places get them: the emitter is given a roughness map of one texel,
//! so the code is the same as for maps, and nothing is baked for it. Tables are over the slope parameter or do not depend on it. Slopes are widened
//! by the size of the light after the factor, so a picture equals that of a material whose file has the multiplied slopes.
//!
//! `lobes` is a fit for one roughness. Its shaders stay without places, and the slider is disabled and says why. Fits over `alpha_factor`, which a material with a roughness map has, follow
//! down from 1. As with maps, the slopes of a base under patina stay where `base_alpha` states them, and `belcour` and `yamaguchi` keep the light that layers return to a diffuse base.
//!
//! # Live numbers
//!
//! The large picture has a slider for each live number of the manifest, normals left out. They decide members of the `LuthierPlace` of all pixels, beside those of maps.
//!
//! # Simplifications
//!
//! Maps of single layers ([`hidden_maps`]), but for the albedo of a base, and surfaces of several materials are not shown; textures with more than 512 rows or columns are averaged down.
//!
//! # Rooms
//!
//! Each uses only those above it.
//!
//! - `error`, `exhibit`, `live`, `markup`, `pack`, `roughness`: exhibits, and texts, numbers, sliders and factors of the page.
//! - `maps`, `sets`, `skies`, `section`: textures, shaders, surroundings and cross-sections.
//! - `data`, `document`: the data of the script, and the page around it.

mod data;
mod document;
mod error;
mod exhibit;
mod live;
mod maps;
mod markup;
mod pack;
mod roughness;
mod section;
mod sets;
mod skies;

pub use error::GalleryError;
pub use exhibit::{Exhibit, Look, Simulated};
pub use luthier_environment::Scenery;
pub use maps::hidden_maps;
pub use markup::escape;

use luthier_export::Package;

/// Angular radius of the light in radians, as in luthier-gpu's pictures.
const LIGHT_RADIUS: f64 = 0.05_f32 as f64;

/// Materials for a page.
#[derive(Debug, Clone)]
pub struct Gallery {
    /// Title of the page.
    pub title: String,
    /// Bakes, by number.
    pub packages: Vec<Package>,
    /// The materials, in the order of the page. Names are distinct.
    pub exhibits: Vec<Exhibit>,
    /// Surroundings beside the studio, which is the first.
    pub skies: Vec<Scenery>,
}

impl Gallery {
    /// The page: HTML, complete in itself.
    ///
    /// # Errors
    /// [`GalleryError`] for names that are there twice, for looks of materials that no package has, and for shaders that cannot be emitted.
    pub fn html(&self) -> Result<String, GalleryError> {
        let data = data::PageData::new(self)?;
        Ok(document::html(self, &data.json()))
    }
}
