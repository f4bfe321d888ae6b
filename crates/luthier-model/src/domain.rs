//! Domains: ranges of index, slope, thickness and absorption within which models may be used.
//!
//! The ranges are those over which no level (f64, tables, f32, device) of the stability suite fails: `luthier-lab stability` derives them
//! anew, and a test of luthier-report compares. Between the values that the suite tries, the last that did not fail counts.
//!
//! A model may leave out parts of the light within its domain (bounces, blur, 1/n^2): `docs/pages/models.md` has their size.

luthier_lut::named! {
    /// Quantity that a domain limits.
    pub enum Quantity("quantity") {
        /// Index of a coat over that above it, at the wavelength that bends directions.
        Index = "index ratio of the coat",
        /// Slope parameter of an interface that is not smooth.
        Alpha = "alpha",
        /// Largest thickness of a film, nm.
        FilmNm = "film thickness (nm)",
        /// Number of layers.
        Layers = "number of layers",
        /// Optical depth of a slab, of the channel that absorbs most.
        OpticalDepth = "optical depth",
        /// Largest extinction coefficient of a metal.
        MetalK = "k of the metal",
    }
}

impl Quantity {
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
///
/// ```
/// use luthier_model::{Quantity, ShadingModel};
///
/// // `elek` lacks 1/n^2: coats of a high index would be too bright.
/// let limit = ShadingModel::Elek.limits().find(|limit| limit.quantity == Quantity::Index).unwrap();
/// assert!(limit.most < 2.0 && !limit.refuses);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// The quantity.
    pub quantity: Quantity,
    /// Smallest value.
    pub least: f64,
    /// Largest value.
    pub most: f64,
    /// Whether values outside are refused as wrong beyond use, and not merely doubted.
    pub refuses: bool,
    /// Fault outside the range, in words.
    pub reason: &'static str,
}

const fn limit(quantity: Quantity, least: f64, most: f64, reason: &'static str) -> Limit {
    Limit { quantity, least, most, refuses: false, reason }
}

/// Largest real part and k of an index that records hold. Formulas of Fresnel square it twice, to 1e16, and single precision has room for products
/// of such numbers.
pub const INDEX_MAX: f64 = 1e4;

/// Thickest film whose phase single precision resolves at all: 1 mm is 4000 waves, a phase error of 1e-3 turns.
const FILM_BEYOND_USE_NM: f64 = 1e6;

/// Limits of all models.
pub(crate) const COMMON: &[Limit] = &[
    limit(Quantity::MetalK, 0.0, INDEX_MAX, "it is stored as 10000, which reflects within 1e-4 of it"),
    Limit {
        quantity: Quantity::FilmNm,
        least: 0.0,
        most: FILM_BEYOND_USE_NM,
        refuses: true,
        reason: "its phase has no digits left in single precision, and no light is coherent over it",
    },
];

/// Limit of the index of a coat over a metal that reflects 0.92: 1.9 is the last index of the suite before the albedo of the coated metal is
/// off by more than 1.
pub(crate) const BRIGHT: Limit = limit(
    Quantity::Index,
    0.25,
    1.9,
    "the model lacks 1/n^2: what lies below is up to n^2 times too bright, by more light than falls on it",
);

/// Beams return all light, and the diffuse term of a base comes on top of them.
pub(crate) const ONE_SURFACE: Limit = limit(
    Quantity::Layers,
    1.0,
    1.0,
    "the model adds the whole diffuse light of a base to beams that return all light, and leaves out absorption",
);

/// Fringes of a film on a row of phases.
pub(crate) const FEW_NODES: Limit = limit(
    Quantity::FilmNm,
    0.0,
    5000.0,
    "the 256 nodes of its phase row are too few for the fringes: off by 0.57 at 20 um",
);

/// Rows on both sides of a critical angle: 0.5 gains 0.05, 0.667 is the last that does not gain.
pub(crate) const BETWEEN_ROWS: Limit = limit(
    Quantity::Index,
    0.667,
    4.0,
    "rows of lobes are too far apart at the critical angle of a rough interface: up to 0.05 more light than falls on it",
);
