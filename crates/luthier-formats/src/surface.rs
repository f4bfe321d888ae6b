//! A material as a coat, a film and a base, with what is lost on the way.

use luthier_import::{Fate, Line};
use luthier_layers::engines::facets::Facets;
use luthier_material::{LayerExtras, Material, Metallic};
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::schlick::{F82, F82_COS_THETA};
use luthier_optics::stack::{self, Base as Below, Diffuse, Distribution, FilmThickness, Layer};

/// Wavelength at which an index counts: the line D of sodium.
const D_NM: f64 = 589.3;

/// A material as formats see one.
#[derive(Debug, Clone)]
pub(crate) struct Surface {
    pub(crate) coat: Option<Coat>,
    pub(crate) film: Option<Film>,
    pub(crate) base: Base,
    /// Slopes of the interface of the base.
    pub(crate) slopes: Slopes,
    /// Numbers of the layers that the coat and the base come from.
    pub(crate) numbers: [usize; 2],
}

/// Slopes of an interface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Slopes {
    pub(crate) facets: Facets,
    /// Whether the distribution is GGX, as that of the formats, or none is seen.
    pub(crate) is_ggx: bool,
}

/// A clear or absorbing layer above all others.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coat {
    pub(crate) weight: f64,
    pub(crate) ior: f64,
    pub(crate) slopes: Slopes,
    /// Optical depth along the normal.
    pub(crate) depth: Rgb,
    /// Whether the base is darker for the light that comes back to it.
    pub(crate) darkens: bool,
}

/// A film on the base.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Film {
    pub(crate) weight: f64,
    pub(crate) ior: f64,
    pub(crate) thickness: FilmThickness,
    /// Whether it lies on the coat.
    pub(crate) is_on_coat: bool,
}

/// A base.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Base {
    /// Numbers that the file states in the words of formats, and the slope deviation of the diffuse part.
    Stated(Metallic, f64),
    /// A metal by its index: reflectance at the normal and at 82 degrees.
    Metal([F82; 3]),
    /// An interface over a diffuse base.
    Plastic(Plastic),
    /// A diffuse base without an interface.
    Matte(Diffuse),
    /// An interface below which light is lost, by its F0.
    Black(Rgb),
}

/// An interface over a diffuse base.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plastic {
    /// Reflectance along the normal.
    pub(crate) f0: Rgb,
    /// Index in air.
    pub(crate) ior: f64,
    /// Optical depth of the slab.
    pub(crate) depth: Rgb,
    pub(crate) diffuse: Diffuse,
    /// Share of the surface that the interface covers.
    pub(crate) weight: f64,
    /// Whether the base is darker for the light that comes back to it.
    pub(crate) darkens: bool,
}

impl Plastic {
    /// It as a coat over a diffuse base, for formats whose coats say more.
    pub(crate) fn as_coat(&self, slopes: Slopes) -> Coat {
        let Self { ior, depth, weight, darkens, .. } = *self;
        Coat { weight, ior, slopes, depth, darkens }
    }

    /// Whether something is said of it that only a coat can be.
    pub(crate) fn is_coat(&self) -> bool {
        self.weight < 1.0 || !self.darkens
    }

    /// Whether its slab absorbs.
    pub(crate) fn absorbs(&self) -> bool {
        self.depth != [0.0; 3]
    }
}

fn line(property: impl Into<String>, fate: Fate, note: impl Into<String>) -> Line {
    Line { property: property.into(), fate, note: note.into() }
}

impl Surface {
    /// The surface of a material, and a line for all that no format has.
    pub(crate) fn of(material: &Material) -> (Self, Vec<Line>) {
        let (layers, extras) = (&material.stack.layers, &material.layers);
        let mut lines = lost(material);
        let exterior = material.stack.exterior.at(D_NM).re;
        if exterior != 1.0 {
            lines.push(line(
                "exterior",
                Fate::Approximated,
                "formats have surfaces in air: indices are over that of the exterior",
            ));
        }
        let last = layers.len().saturating_sub(1);
        let of_diffuse = |number: usize| match layers.get(number).map(|layer| &layer.base) {
            Some(Below::Diffuse(diffuse)) => Some(*diffuse),
            _ => None,
        };
        // Number of the layer with the interface of the base.
        let number = if of_diffuse(last).is_some() { last.saturating_sub(1) } else { last };
        let base = base_of(material, number, of_diffuse(last));
        let slopes = slopes_of(&layers[number]);
        let coats = number;
        let coat = (coats > 0).then(|| {
            let first = &layers[0];
            let mut depth = [0.0; 3];
            for layer in &layers[..coats] {
                if let Below::Dielectric { slab, .. } = &layer.base {
                    let own = slab.optical_depth();
                    depth = [0, 1, 2].map(|c: usize| depth[c] + own[c]);
                }
            }
            if coats > 1 {
                let note = "formats have one coat: it has the interface of the first and what all of them absorb";
                lines.push(line(format!("layers 2 to {coats}"), Fate::Dropped, note));
            }
            Coat {
                weight: if extras[0].weighs_film { 1.0 } else { extras[0].weight },
                ior: index(first) / exterior,
                slopes: slopes_of(first),
                depth,
                darkens: material.brightening().is_none(),
            }
        });
        let film = film_of(layers, extras, number, exterior, &mut lines);
        (Self { coat, film, base, slopes, numbers: [0, number] }, lines)
    }
}

/// The base of a material, whose interface has a number.
fn base_of(material: &Material, number: usize, diffuse: Option<Diffuse>) -> Base {
    let (layers, extras) = (&material.stack.layers, &material.layers);
    let color = material.color();
    if number + 1 == layers.len()
        && let Some(diffuse) = diffuse
    {
        return Base::Matte(diffuse);
    }
    if let Some(stated) = extras[number].stated {
        return Base::Stated(stated, diffuse.map_or(0.0, |diffuse| diffuse.sigma));
    }
    let reflectance = |cos: f64| {
        let bare = Interface::of(&material.stack, number).map(|mut at| {
            at.films.clear();
            at
        });
        bare.map_or([0.0; 3], |at| at.sampled(&color).rgb(cos))
    };
    let f0 = reflectance(1.0);
    match (&layers[number].base, diffuse) {
        (Below::Dielectric { slab, .. }, Some(diffuse)) => {
            let own = &extras[number];
            let is_first = number == 0;
            // What the file says of the colour, not what a coat that does not darken it makes of it.
            let albedo = match extras[number + 1].brightening {
                Some(shares) => diffuse.albedo.map(|x| darkened(x, shares.diffuse, extras[0].weight)),
                None => diffuse.albedo,
            };
            Base::Plastic(Plastic {
                f0,
                ior: index(&layers[number]) / material.stack.exterior.at(D_NM).re,
                depth: slab.optical_depth(),
                diffuse: Diffuse { albedo, ..diffuse },
                weight: if is_first && !own.weighs_film { own.weight } else { 1.0 },
                darkens: !is_first || extras[number + 1].brightening.is_none(),
            })
        }
        (Below::Conductor { .. }, _) => {
            let edge = reflectance(F82_COS_THETA);
            Base::Metal([0, 1, 2].map(|c: usize| F82::through(f0[c], edge[c])))
        }
        _ => Base::Black(f0),
    }
}

/// The colour that a base of a colour shows below a coat that covers a share of it, of which the base gets back another: the inverse of
/// `luthier_optics::brightening`.
fn darkened(x: f64, share: f64, weight: f64) -> f64 {
    weight * (1.0 - share) * x / (1.0 - share * x) + (1.0 - weight) * x
}

fn slopes_of(layer: &Layer) -> Slopes {
    let stack::Surface { distribution, alpha_x, alpha_y, rotation } = layer.surface;
    let is_ggx =
        matches!(layer.base, Below::Diffuse(_)) || layer.surface.is_smooth() || distribution == Distribution::Ggx;
    Slopes { facets: Facets { alpha: [alpha_x, alpha_y], turn: rotation }, is_ggx }
}

/// Real index of the medium below an interface.
fn index(layer: &Layer) -> f64 {
    match &layer.base {
        Below::Dielectric { ior, .. } | Below::Conductor { ior } => ior.at(D_NM).re,
        Below::Diffuse(_) => 1.0,
    }
}

fn film_of(
    layers: &[Layer],
    extras: &[LayerExtras],
    base: usize,
    exterior: f64,
    lines: &mut Vec<Line>,
) -> Option<Film> {
    let filmed: Vec<usize> = (0..layers.len()).filter(|number| !layers[*number].films.is_empty()).collect();
    let number = filmed.iter().copied().find(|number| *number == base).or(filmed.first().copied())?;
    let films = &layers[number].films;
    if films.len() > 1 || filmed.len() > 1 {
        lines.push(line("further films", Fate::Dropped, "formats have one film"));
    }
    let film = &films[0];
    if !film.is_clear() {
        lines.push(line("film: absorption", Fate::Dropped, "films of formats are clear"));
    }
    if !film.ior.is_constant() {
        lines.push(line("film: dispersion", Fate::Approximated, "the index at 589 nm"));
    }
    let weight = if extras[number].weighs_film { extras[number].weight } else { 1.0 };
    Some(Film { weight, ior: film.ior.at(D_NM).re / exterior, thickness: film.thickness, is_on_coat: number != base })
}

/// Lines on what no format has.
fn lost(material: &Material) -> Vec<Line> {
    let mut lines = Vec::new();
    let effects = &material.effects;
    if effects.flakes.is_some() {
        lines.push(line("flakes", Fate::Dropped, "glints of the coat: no format has them"));
    }
    if effects.glitter.is_some() {
        lines.push(line("glitter", Fate::Dropped, "tilted particles: no format has them"));
    }
    if effects.patina.is_some() {
        let note =
            "the first layer covers all of the surface, without the light that it scatters and the tarnish below it";
        lines.push(line("patina", Fate::Dropped, note));
    }
    if material.reradiation().is_some() {
        lines.push(line(
            "reradiation",
            Fate::Dropped,
            "the colour under white light is kept; light of other colours is not changed into it",
        ));
    }
    for (number, extras) in material.layers.iter().enumerate() {
        for live in extras.live.numbers() {
            let note = "a number that programs set at run time: the number of the file is written";
            lines.push(line(format!("layer {}: live {}", number + 1, live.key), Fate::Dropped, note));
        }
        if extras.maps.lean.is_some() {
            lines.push(line(format!("layer {}: maps.lean", number + 1), Fate::Dropped, "normals of an inner boundary"));
        }
    }
    if material.color() != Color::Spectral && material.stack.layers.iter().any(|layer| !layer.films.is_empty()) {
        let note = "three wavelengths stand for colours here: films of formats are seen in the spectrum or as engines approximate it";
        lines.push(line("film: colour", Fate::Approximated, note));
    }
    lines
}
