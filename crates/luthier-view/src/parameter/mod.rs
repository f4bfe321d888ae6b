//! The numbers of a material that can be edited.

use std::f64::consts::FRAC_PI_2;
use std::ops::RangeInclusive;

use luthier_material::{FlakeSource, Material, SurfaceClass};
use luthier_optics::ior::{Ior, IorSample};
use luthier_optics::stack::{Base, Surface};

/// One number of a material. Layers count from the top; a handle that a material does not have reads as `None`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Handle {
    /// Both slope parameters of an isotropic surface.
    Alpha(usize),
    /// Slope parameter along the tangent.
    AlphaX(usize),
    /// Slope parameter along the bitangent.
    AlphaY(usize),
    /// Turn of the tangent in degrees.
    Rotation(usize),
    /// Real part of a constant index below an interface.
    IorN(usize),
    /// Imaginary part of a constant index of a conductor.
    IorK(usize),
    /// Reflectance at normal incidence of an interface without an index: red, green or blue.
    F0(usize, usize),
    /// Thickness of an absorbing slab in um.
    SlabThickness(usize),
    /// Absorption of a slab in 1/um: red, green or blue.
    Absorption(usize, usize),
    /// Albedo of a diffuse base: red, green or blue.
    Albedo(usize, usize),
    /// Standard deviation of the facets' angle of a diffuse base, in radians.
    Sigma(usize),
    /// Thickness in nm of an even film: layer, film.
    FilmThickness(usize, usize),
    /// Thinnest place of a film, in nm.
    FilmMin(usize, usize),
    /// Thickest place of a film, in nm.
    FilmMax(usize, usize),
    /// Constant index of a film.
    FilmIor(usize, usize),
    /// Stage of the patina.
    PatinaExtent,
    /// Softness of its boundary.
    PatinaTransition,
    /// Slope parameter of the layer below it.
    PatinaBaseAlpha,
    /// Share of the cells that glitter.
    GlitterFilled,
    /// Cells per unit of texture coordinate.
    GlitterFrequency,
    /// Largest tilt in degrees.
    GlitterTilt,
    /// Weight of the flakes.
    FlakeScale,
    /// Repeats of the flakes per unit of texture coordinate.
    FlakeTiling,
    /// Distance up to which flakes keep their weight.
    FlakeFadeStart,
    /// Standard deviation of the flakes' angle in degrees.
    FlakeSpread,
}

/// Name, unit and range of a number in the window.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Number of the material.
    pub handle: Handle,
    /// Its name in the window.
    pub label: &'static str,
    /// Its unit, if any, as it follows the number.
    pub unit: &'static str,
    /// Range of the number.
    pub range: RangeInclusive<f64>,
    /// Whether a slider over it is logarithmic.
    pub logarithmic: bool,
}

/// Parameters that belong together: a layer, or an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// Its title.
    pub title: String,
    /// Parameters in the order in which they are shown.
    pub parameters: Vec<Parameter>,
}

/// Films as thin as a few atoms, up to those that only a spectrometer sees.
const FILM_NM: RangeInclusive<f64> = 1.0..=2000.0;

/// A film that varies does so by this at least, in nm: an even one has other tables.
const FILM_LEAST_VARIATION_NM: f64 = 1.0;

/// Dense gases to germanium.
const DIELECTRIC_N: RangeInclusive<f64> = 1.01..=4.0;

/// Everything that can be edited, from the top down. Data sets and indices that depend on the wavelength are left alone.
pub fn groups(material: &Material) -> Vec<Group> {
    let mut groups: Vec<Group> = (0..material.stack.layers.len()).map(|i| layer(material, i)).collect();
    groups.extend(effects(material));
    groups
}

fn plain(handle: Handle, label: &'static str, unit: &'static str, range: RangeInclusive<f64>) -> Parameter {
    Parameter { handle, label, unit, range, logarithmic: false }
}

fn logarithmic(handle: Handle, label: &'static str, unit: &'static str, range: RangeInclusive<f64>) -> Parameter {
    Parameter { handle, label, unit, range, logarithmic: true }
}

fn layer(material: &Material, i: usize) -> Group {
    let layer = &material.stack.layers[i];
    let mut parameters = Vec::new();
    for (j, film) in layer.films.iter().enumerate() {
        if film.thickness.min_nm == film.thickness.max_nm {
            parameters.push(plain(Handle::FilmThickness(i, j), "film", " nm", FILM_NM));
        } else {
            parameters.push(plain(Handle::FilmMin(i, j), "film, thinnest", " nm", FILM_NM));
            parameters.push(plain(Handle::FilmMax(i, j), "film, thickest", " nm", FILM_NM));
        }
        if film.ior.is_constant() {
            parameters.push(plain(Handle::FilmIor(i, j), "film index", "", DIELECTRIC_N));
        }
    }
    let kind = match &layer.base {
        Base::Dielectric { ior, .. } => {
            if ior.f0().is_some() {
                parameters.extend(f0(i));
            } else if ior.is_constant() {
                parameters.push(plain(Handle::IorN(i), "index", "", DIELECTRIC_N));
            }
            "dielectric"
        }
        Base::Conductor { ior } => {
            if ior.f0().is_some() {
                parameters.extend(f0(i));
            } else if ior.is_constant() {
                parameters.push(logarithmic(Handle::IorN(i), "index n", "", 0.02..=8.0));
                parameters.push(plain(Handle::IorK(i), "index k", "", 0.0..=10.0));
            }
            "conductor"
        }
        Base::Diffuse(_) => "diffuse",
    };
    if !matches!(layer.base, Base::Diffuse(_)) {
        let Surface { alpha_x, alpha_y, .. } = layer.surface;
        if alpha_x == alpha_y {
            parameters.push(plain(Handle::Alpha(i), "alpha", "", 0.0..=1.0));
        } else {
            parameters.push(logarithmic(Handle::AlphaX(i), "alpha x", "", 0.001..=1.0));
            parameters.push(logarithmic(Handle::AlphaY(i), "alpha y", "", 0.001..=1.0));
            parameters.push(plain(Handle::Rotation(i), "rotation", "°", -180.0..=180.0));
        }
    }
    match &layer.base {
        // Light that enters the last dielectric is lost, so its slab has no effect.
        Base::Dielectric { .. } if i + 1 < material.stack.layers.len() => {
            parameters.push(logarithmic(Handle::SlabThickness(i), "thickness", " µm", 0.0..=1000.0));
            for (c, label) in ["absorption r", "absorption g", "absorption b"].into_iter().enumerate() {
                parameters.push(logarithmic(Handle::Absorption(i, c), label, " /µm", 0.0..=10.0));
            }
        }
        Base::Diffuse(_) => {
            for (c, label) in ["albedo r", "albedo g", "albedo b"].into_iter().enumerate() {
                parameters.push(plain(Handle::Albedo(i, c), label, "", 0.0..=1.0));
            }
            parameters.push(plain(Handle::Sigma(i), "facet angle", " rad", 0.0..=FRAC_PI_2));
        }
        _ => {}
    }
    Group { title: format!("{} · {kind}", i + 1), parameters }
}

/// The channels of the F0 of a layer.
fn f0(i: usize) -> [Parameter; 3] {
    let labels = ["F0 r", "F0 g", "F0 b"];
    [0, 1, 2].map(|c| plain(Handle::F0(i, c), labels[c], "", 0.0..=1.0))
}

fn effects(material: &Material) -> Vec<Group> {
    let effects = &material.effects;
    let mut groups = Vec::new();
    if let Some(patina) = &effects.patina {
        let mut parameters = vec![
            plain(Handle::PatinaExtent, "extent", "", -patina.transition..=1.0 + patina.transition),
            plain(Handle::PatinaTransition, "transition", "", 0.0..=1.0),
        ];
        if patina.base_alpha.is_some() {
            parameters.push(plain(Handle::PatinaBaseAlpha, "alpha below", "", 0.0..=1.0));
        }
        groups.push(Group { title: "patina".to_owned(), parameters });
    }
    if let Some(flakes) = &effects.flakes {
        let mut parameters = vec![
            plain(Handle::FlakeScale, "weight", "", 0.0..=4.0),
            logarithmic(Handle::FlakeTiling, "tiling", "", 1.0..=10_000.0),
            logarithmic(Handle::FlakeFadeStart, "fade start", "", 0.1..=100.0),
        ];
        if matches!(flakes.source, FlakeSource::Cells { .. }) {
            parameters.push(plain(Handle::FlakeSpread, "spread", "°", 0.1..=45.0));
        }
        groups.push(Group { title: "flakes".to_owned(), parameters });
    }
    if effects.glitter.is_some() {
        let parameters = vec![
            plain(Handle::GlitterFilled, "filled", "", 0.0..=1.0),
            logarithmic(Handle::GlitterFrequency, "frequency", "", 1.0..=10_000.0),
            plain(Handle::GlitterTilt, "tilt", "°", 0.1..=45.0),
        ];
        groups.push(Group { title: "glitter".to_owned(), parameters });
    }
    groups
}

/// A number behind a handle, and how the window shows it.
type Place<'a> = (&'a mut f64, Unit);

/// Unit of a number in the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Unit {
    /// The material's own.
    Own,
    /// Degrees, of an angle in radians.
    Degrees,
}

impl Unit {
    fn shown(self, number: f64) -> f64 {
        if self == Self::Degrees { number.to_degrees() } else { number }
    }

    /// The number that the reader of files makes of this one.
    fn held(self, shown: f64) -> f64 {
        if self == Self::Degrees { shown.to_radians() } else { shown }
    }
}

impl Handle {
    /// The number as the window shows it.
    pub fn get(self, material: &Material) -> Option<f64> {
        match self {
            Self::IorN(i) => Some(constant_ior(base_ior(material, i)?)?[0]),
            Self::IorK(i) => Some(constant_ior(base_ior(material, i)?)?[1]),
            Self::F0(i, c) => base_ior(material, i)?.f0()?.get(c).copied(),
            Self::FilmIor(i, j) => Some(constant_ior(&material.stack.layers.get(i)?.films.get(j)?.ior)?[0]),
            // Everything else is a number that lies somewhere in the material.
            _ => self.place(&mut material.clone()).map(|(number, unit)| unit.shown(*number)),
        }
    }

    /// Changes the number within its range and as its neighbours allow, and updates the class of the surface. Values that are not finite change
    /// nothing.
    pub fn set(self, material: &mut Material, value: f64) {
        let known = groups(material).into_iter().flat_map(|group| group.parameters).find(|p| p.handle == self);
        let Some(parameter) = known.filter(|_| value.is_finite()) else { return };
        let value = value.clamp(*parameter.range.start(), *parameter.range.end());
        match self {
            Self::IorN(_) | Self::IorK(_) | Self::F0(..) | Self::FilmIor(..) => self.set_ior(material, value),
            _ => {
                if let Some((number, unit)) = self.place(material) {
                    *number = unit.held(value);
                }
            }
        }
        self.agree(material);
        material.class = SurfaceClass::of(&material.stack);
    }

    /// Adjusts numbers that a new value no longer allows.
    fn agree(self, material: &mut Material) {
        match self {
            Self::Alpha(i) => {
                let surface = &mut material.stack.layers[i].surface;
                surface.alpha_y = surface.alpha_x;
            }
            // An interface with an F0 lies below no denser medium.
            Self::IorN(i) => {
                let above = base_ior(material, i).and_then(constant_ior);
                let below = base_ior_mut(material, i + 1).filter(|ior| ior.f0().is_some());
                if let (Some([least, _]), Some(ior)) = (above, below) {
                    let raised = ior.samples().iter().map(|s| IorSample { n: s.n.max(least), ..*s }).collect();
                    *ior = ior.with_samples(raised).unwrap_or_else(|_| ior.clone());
                }
            }
            Self::FilmThickness(i, j) => {
                let thickness = &mut material.stack.layers[i].films[j].thickness;
                thickness.max_nm = thickness.min_nm;
            }
            Self::FilmMin(i, j) => {
                let thickness = &mut material.stack.layers[i].films[j].thickness;
                thickness.min_nm = thickness.min_nm.min(*FILM_NM.end() - FILM_LEAST_VARIATION_NM);
                thickness.max_nm = thickness.max_nm.max(thickness.min_nm + FILM_LEAST_VARIATION_NM);
            }
            Self::FilmMax(i, j) => {
                let thickness = &mut material.stack.layers[i].films[j].thickness;
                thickness.max_nm = thickness.max_nm.max(*FILM_NM.start() + FILM_LEAST_VARIATION_NM);
                thickness.min_nm = thickness.min_nm.min(thickness.max_nm - FILM_LEAST_VARIATION_NM);
            }
            Self::PatinaTransition => {
                if let Some(patina) = &mut material.effects.patina {
                    patina.extent = patina.extent.clamp(-patina.transition, 1.0 + patina.transition);
                }
            }
            _ => {}
        }
    }

    fn set_ior(self, material: &mut Material, value: f64) {
        let ior = match self {
            Self::FilmIor(i, j) => {
                material.stack.layers.get_mut(i).and_then(|l| l.films.get_mut(j)).map(|f| &mut f.ior)
            }
            Self::IorN(i) | Self::IorK(i) | Self::F0(i, _) => base_ior_mut(material, i),
            _ => None,
        };
        let Some(ior) = ior else { return };
        if let (Self::F0(_, c), Some(mut f0)) = (self, ior.f0()) {
            f0[c] = value;
            *ior = ior.clone().with_f0(f0);
            return;
        }
        let Some([n, k]) = constant_ior(ior) else { return };
        let [n, k] = if matches!(self, Self::IorK(_)) { [n, value] } else { [value, k] };
        if let Ok(changed) = Ior::constant(n, k) {
            *ior = changed;
        }
    }

    fn place(self, material: &mut Material) -> Option<Place<'_>> {
        let effects = &mut material.effects;
        let layers = &mut material.stack.layers;
        Some(match self {
            Self::Alpha(i) | Self::AlphaX(i) => (&mut layers.get_mut(i)?.surface.alpha_x, Unit::Own),
            Self::AlphaY(i) => (&mut layers.get_mut(i)?.surface.alpha_y, Unit::Own),
            Self::Rotation(i) => (&mut layers.get_mut(i)?.surface.rotation, Unit::Degrees),
            Self::SlabThickness(i) => match &mut layers.get_mut(i)?.base {
                Base::Dielectric { slab, .. } => (&mut slab.thickness_um, Unit::Own),
                _ => return None,
            },
            Self::Absorption(i, c) => match &mut layers.get_mut(i)?.base {
                Base::Dielectric { slab, .. } => (slab.absorption_per_um.get_mut(c)?, Unit::Own),
                _ => return None,
            },
            Self::Albedo(i, c) => match &mut layers.get_mut(i)?.base {
                Base::Diffuse(diffuse) => (diffuse.albedo.get_mut(c)?, Unit::Own),
                _ => return None,
            },
            Self::Sigma(i) => match &mut layers.get_mut(i)?.base {
                Base::Diffuse(diffuse) => (&mut diffuse.sigma, Unit::Own),
                _ => return None,
            },
            Self::FilmThickness(i, j) | Self::FilmMin(i, j) => {
                (&mut layers.get_mut(i)?.films.get_mut(j)?.thickness.min_nm, Unit::Own)
            }
            Self::FilmMax(i, j) => (&mut layers.get_mut(i)?.films.get_mut(j)?.thickness.max_nm, Unit::Own),
            Self::IorN(_) | Self::IorK(_) | Self::F0(..) | Self::FilmIor(..) => return None,
            Self::PatinaExtent => (&mut effects.patina.as_mut()?.extent, Unit::Own),
            Self::PatinaTransition => (&mut effects.patina.as_mut()?.transition, Unit::Own),
            Self::PatinaBaseAlpha => (effects.patina.as_mut()?.base_alpha.as_mut()?, Unit::Own),
            Self::GlitterFilled => (&mut effects.glitter.as_mut()?.filled, Unit::Own),
            Self::GlitterFrequency => (&mut effects.glitter.as_mut()?.frequency, Unit::Own),
            Self::GlitterTilt => (&mut effects.glitter.as_mut()?.tilt, Unit::Degrees),
            Self::FlakeScale => (&mut effects.flakes.as_mut()?.scale, Unit::Own),
            Self::FlakeTiling => (&mut effects.flakes.as_mut()?.tiling, Unit::Own),
            Self::FlakeFadeStart => (&mut effects.flakes.as_mut()?.fade_start, Unit::Own),
            Self::FlakeSpread => match &mut effects.flakes.as_mut()?.source {
                FlakeSource::Cells { spread, .. } => (spread, Unit::Degrees),
                FlakeSource::NormalMap(_) | FlakeSource::HeightMap { .. } => return None,
            },
        })
    }
}

fn base_ior(material: &Material, layer: usize) -> Option<&Ior> {
    match &material.stack.layers.get(layer)?.base {
        Base::Dielectric { ior, .. } | Base::Conductor { ior } => Some(ior),
        Base::Diffuse(_) => None,
    }
}

fn base_ior_mut(material: &mut Material, layer: usize) -> Option<&mut Ior> {
    match &mut material.stack.layers.get_mut(layer)?.base {
        Base::Dielectric { ior, .. } | Base::Conductor { ior } => Some(ior),
        Base::Diffuse(_) => None,
    }
}

/// n and k of an index that is the same at all wavelengths.
fn constant_ior(ior: &Ior) -> Option<[f64; 2]> {
    let sample = ior.samples().first().filter(|_| ior.is_constant())?;
    Some([sample.n, sample.k])
}

#[cfg(test)]
mod tests;
