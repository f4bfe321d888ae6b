//! Where the models of the shaders may be used: ranges of the quantities that a stack is made of.
//!
//! The ranges are those over which no level (f64, tables, f32, device) of the stability suite fails: `luthier stability` derives them
//! anew, and a test of luthier-report compares. Between the values that the suite tries, the last that did not fail counts.
//!
//! What a model leaves out within its domain (bounces, blur, 1/n^2) is no matter of the domain: `docs/models.md` has its size.

use luthier_optics::stack::{Base, Stack};

use crate::elek::{ALPHA_MIN, MODEL, REFRACTION_WAVELENGTH_NM};

/// What a domain is a range of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Index of a coat over that above it, at the wavelength that bends directions.
    Index,
    /// Slope parameter of an interface that is not smooth.
    Alpha,
    /// Largest thickness of a film, nm.
    FilmNm,
    /// Number of layers.
    Layers,
    /// Optical depth of a slab, of the channel that absorbs most.
    OpticalDepth,
    /// Largest extinction coefficient of a metal.
    MetalK,
}

impl Quantity {
    /// All, in the order of pages.
    pub const ALL: [Self; 6] =
        [Self::Index, Self::Alpha, Self::FilmNm, Self::Layers, Self::OpticalDepth, Self::MetalK];

    /// The name in reports and messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Index => "index ratio of the coat",
            Self::Alpha => "alpha",
            Self::FilmNm => "film thickness (nm)",
            Self::Layers => "number of layers",
            Self::OpticalDepth => "optical depth",
            Self::MetalK => "k of the metal",
        }
    }

    /// The value of an ordinary material, from which a domain is followed to both sides.
    pub fn ordinary(self) -> f64 {
        match self {
            Self::Index => 1.5,
            Self::Alpha => 0.1,
            Self::FilmNm => 300.0,
            Self::Layers => 2.0,
            Self::OpticalDepth => 0.1,
            Self::MetalK => 3.0,
        }
    }
}

/// A range of a quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// The quantity.
    pub quantity: Quantity,
    /// Smallest value.
    pub least: f64,
    /// Largest value.
    pub most: f64,
    /// Whether what is outside is wrong beyond use, not merely in doubt.
    pub refuses: bool,
    /// What goes wrong outside.
    pub reason: &'static str,
}

/// Something outside the domain of a model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outside {
    /// Number of the layer, from the top.
    pub layer: usize,
    /// What is outside.
    pub limit: Limit,
    /// Its value.
    pub value: f64,
}

impl Outside {
    /// The nearest value inside.
    pub fn nearest(&self) -> f64 {
        self.value.clamp(self.limit.least, self.limit.most)
    }
}

const fn limit(quantity: Quantity, least: f64, most: f64, reason: &'static str) -> Limit {
    Limit { quantity, least, most, refuses: false, reason }
}

/// Real part and k of an index that records hold; beyond it single precision has no fourth power.
pub const INDEX_MAX: f64 = 1e4;

/// Thickest film whose phase single precision resolves at all: 1 mm is 4000 waves, a phase error of 1e-3 turns.
const FILM_BEYOND_USE_NM: f64 = 1e6;

/// What holds for all models.
const COMMON: &[Limit] = &[
    limit(Quantity::MetalK, 0.0, INDEX_MAX, "it is stored as 10000, which reflects within 1e-4 of it"),
    Limit {
        quantity: Quantity::FilmNm,
        least: 0.0,
        most: FILM_BEYOND_USE_NM,
        refuses: true,
        reason: "its phase has no digits left in single precision, and no light is coherent over it",
    },
];

const BRIGHT: &str = "the model lacks 1/n^2: what lies below is shown n^2 times too bright";
const DEPTHS: [f64; 2] = [0.0, f64::INFINITY];

/// The domain of a model, by name; nothing for one without a shader. Slope parameters below [`ALPHA_MIN`] are raised to it by all.
pub fn domain(model: &str) -> &'static [Limit] {
    match model {
        MODEL | "weidlich-wilkie" => const { &[limit(Quantity::Index, 0.25, 1.8, BRIGHT)] },
        _ => &[],
    }
}

/// All that lies outside the domain of a model.
pub fn outside(model: &str, stack: &Stack) -> Vec<Outside> {
    let _ = (ALPHA_MIN, DEPTHS);
    let mut out = Vec::new();
    let mut above = stack.exterior.at(REFRACTION_WAVELENGTH_NM).re;
    for (layer, here) in stack.layers.iter().enumerate() {
        let mut found: Vec<(Quantity, f64)> = vec![(Quantity::Layers, (layer + 1) as f64)];
        found.extend(here.films.iter().map(|film| (Quantity::FilmNm, film.thickness.max_nm)));
        match &here.base {
            Base::Dielectric { ior, slab } => {
                let index = ior.at(REFRACTION_WAVELENGTH_NM).re;
                if layer + 1 < stack.layers.len() {
                    found.push((Quantity::Index, index / above));
                    found.push((Quantity::OpticalDepth, slab.optical_depth().into_iter().fold(0.0, f64::max)));
                }
                above = index;
            }
            Base::Conductor { ior } => {
                found.push((Quantity::MetalK, ior.samples().iter().fold(0.0, |k: f64, s| k.max(s.k))));
            }
            Base::Diffuse(_) => {}
        }
        if !matches!(here.base, Base::Diffuse(_)) && !here.surface.is_smooth() {
            let surface = here.surface;
            found.extend([surface.alpha_x, surface.alpha_y].map(|alpha| (Quantity::Alpha, alpha)));
        }
        for (quantity, value) in found {
            let limits = COMMON.iter().chain(domain(model)).filter(|limit| limit.quantity == quantity);
            for limit in limits.filter(|limit| !(limit.least..=limit.most).contains(&value)) {
                let new = Outside { layer, limit: *limit, value };
                // One word for a stack with too many layers, and for both slope parameters.
                if !out.iter().any(|o: &Outside| o.limit == *limit && (quantity == Quantity::Layers || o.layer == layer)) {
                    out.push(new);
                }
            }
        }
    }
    out
}
