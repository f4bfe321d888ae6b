//! The simulated light of a material, and the errors of a function against it.

use glam::DVec3;
use luthier_material::Material;
use luthier_optics::Rgb;
use luthier_optics::ior::Ior;
use luthier_optics::schlick::F82;
use luthier_optics::stack::{Base, FilmThickness, Stack};
use luthier_report::{CellDifferences, ColorView, ReferenceSettings};
use rayon::prelude::*;

/// Angles of the eye against the normal, degrees: those of the judge.
pub const VIEWS_DEG: [f64; 4] = [0.0, 30.0, 60.0, 80.0];

/// Seed of the paths.
const SEED: u64 = 0x6f75_7470;

/// How much is simulated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Lobe error that noise may cause.
    pub noise: f64,
    /// The most paths of a view.
    pub most: u64,
}

impl Settings {
    /// Settings of the command: noise of a hundredth of the lobe, or 2^19 paths.
    pub fn usual() -> Self {
        Self { noise: 0.01, most: 1 << 19 }
    }

    /// Few paths, for a look.
    pub fn quick() -> Self {
        Self { noise: 0.05, most: 1 << 14 }
    }
}

/// Errors that remain at an angle of the eye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    /// The angle against the normal, degrees.
    pub theta_deg: f64,
    /// Directional albedo by the format's formula.
    pub albedo: Rgb,
    /// Directional albedo of the layers.
    pub expected: Rgb,
    /// Standard error of the albedo of the layers.
    pub std_err: Rgb,
    /// Share of the light that is elsewhere: half the absolute differences of the cells over the albedo of the layers.
    pub lobe: Rgb,
    /// The lobe error that noise alone makes.
    pub lobe_floor: Rgb,
}

/// The largest difference of directional albedos, over angles and channels.
pub(crate) fn worst_albedo(residuals: &[Residual]) -> f64 {
    let all = residuals.iter().flat_map(|at| at.albedo.into_iter().zip(at.expected));
    all.map(|(found, expected)| (found - expected).abs()).fold(0.0, f64::max)
}

/// The largest lobe error, over angles and channels.
pub(crate) fn worst_lobe(residuals: &[Residual]) -> f64 {
    residuals.iter().flat_map(|at| at.lobe).fold(0.0, f64::max)
}

/// `f cos_theta_i` of unit directions to the light and to the eye.
pub(crate) type Values = Box<dyn Fn(DVec3, DVec3) -> Rgb + Send + Sync>;

/// The light of a material at all angles.
#[derive(Debug)]
pub(crate) struct Light {
    views: Vec<ColorView>,
}

impl Light {
    /// Traces a material where maps have texels of 1.
    pub(crate) fn of(material: &Material, settings: &Settings) -> Self {
        let parts = parts(material);
        let (color, nm) = (material.color(), material.bake.wavelengths_nm());
        let reference = ReferenceSettings {
            noise: settings.noise,
            albedo_std_err: 0.1 * settings.noise,
            most: settings.most,
            seed: SEED,
        };
        let views = VIEWS_DEG.par_iter().filter_map(|&deg| ColorView::blended(&parts, &color, nm, deg, reference));
        Self { views: views.collect() }
    }

    /// A function beside this light, angle by angle.
    pub(crate) fn compared(&self, values: &(dyn Fn(DVec3, DVec3) -> Rgb + Sync)) -> Vec<CellDifferences> {
        self.views.par_iter().map(|view| view.compared(values)).collect()
    }

    /// Errors of a function, angle by angle.
    pub(crate) fn residuals(&self, values: &(dyn Fn(DVec3, DVec3) -> Rgb + Sync)) -> Vec<Residual> {
        let found = self.compared(values).into_iter().zip(VIEWS_DEG);
        found
            .map(|(CellDifferences { albedo, expected, std_err, lobe, lobe_floor, .. }, theta_deg)| Residual {
                theta_deg,
                albedo,
                expected,
                std_err,
                lobe,
                lobe_floor,
            })
            .collect()
    }
}

/// Stacks of a material with their shares of the surface: bare and coated, metal and none.
fn parts(material: &Material) -> Vec<(f64, Stack)> {
    let mut parts: Vec<(f64, Stack)> = Vec::new();
    for (share, mut stack) in by_metal(material) {
        // A film that varies is seen in the middle of its range.
        for film in stack.layers.iter_mut().flat_map(|layer| &mut layer.films) {
            let nominal = film.thickness.nominal_nm();
            film.thickness = FilmThickness { min_nm: nominal, max_nm: nominal };
        }
        let weight = material.layers.first().map_or(1.0, |first| first.weight);
        if weight < 1.0 {
            parts.push((share * (1.0 - weight), material.bare(&stack)));
        }
        if weight > 0.0 {
            parts.push((share * weight, stack));
        }
    }
    parts
}

/// The stack, or, where maps decide how metallic a surface is, those of the metal and of the rest.
fn by_metal(material: &Material) -> Vec<(f64, Stack)> {
    let found =
        material.layers.iter().zip(0..).find_map(|(layer, number)| Some((number, layer.metallic?, layer.brightening)));
    let Some((number, of, brightening)) = found else { return vec![(1.0, material.stack.clone())] };
    let weight = material.layers.first().map_or(1.0, |first| if first.weighs_film { 1.0 } else { first.weight });
    let f0 = brightening.map_or(of.base_color, |shares| shares.metal(of.base_color, weight));
    let mut metal = material.stack.clone();
    metal.layers.truncate(number + 1);
    if let Some(layer) = metal.layers.last_mut() {
        let curves = [0, 1, 2].map(|c: usize| F82 { f0: f0[c], tint: of.f82_tint[c] });
        layer.base = Base::Conductor { ior: Ior::vacuum().with_f82(curves) };
    }
    let both = [(of.metallic, metal), (1.0 - of.metallic, material.stack.clone())];
    both.into_iter().filter(|(share, _)| *share > 0.0).collect()
}
