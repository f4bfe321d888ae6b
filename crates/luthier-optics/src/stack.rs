//! Description of a layered surface: layers, interfaces, films, slabs and bases.
//!
//! A [`Stack`] is read from the top down. Each [`Layer`] is one interface (its micro-surface, the thin
//! films that coat it, the medium or base below it). A dielectric base continues into a [`Slab`] and
//! the next layer; a conductor or a diffuse base ends the stack; a dielectric that comes last is
//! half-infinite, and light that enters it is lost.

use crate::Rgb;
use crate::fresnel::FilmLayer;
use crate::ior::Ior;
use crate::ndf::Shape;
use crate::schlick::DIELECTRIC_INDEX;

/// A layered surface, from the exterior down.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Stack {
    /// The medium above the first layer; transparent (k = 0 everywhere).
    pub exterior: Ior,
    /// The interfaces from the top down; at least one.
    pub layers: Vec<Layer>,
}

impl Stack {
    /// The stack with interfaces below the first that reflect as if air lay above each: the F2 of O. Elek, "Layered Materials in Real-Time
    /// Rendering", CESCG 2010, Algorithm 1, line 21. Directions are bent as before.
    #[must_use]
    pub fn with_lower_in_air(&self) -> Self {
        let mut here = self.clone();
        for layer in here.layers.iter_mut().skip(1) {
            if let Base::Dielectric { ior, .. } | Base::Conductor { ior } = &mut layer.base {
                *ior = ior.clone().reflecting_as_in_air();
            }
        }
        here
    }

    /// The stack without its first layer. A `metallic-roughness` surface bends light as before, by its index over that of what lies above.
    #[must_use]
    pub fn without_first(&self) -> Self {
        let mut here = Self { exterior: self.exterior.clone(), layers: self.layers.iter().skip(1).cloned().collect() };
        if let Some(Base::Dielectric { ior, .. }) = here.layers.first_mut().map(|layer| &mut layer.base)
            && let Some((index, curves)) = ior.of_engine().zip(ior.f82_rgb())
        {
            *ior = Ior::engine(&self.exterior, index).with_f82(curves);
        }
        here
    }

    /// Whether it has a `metallic-roughness` surface that bends light.
    pub fn bends_in_engine(&self) -> bool {
        self.layers.iter().any(|layer| matches!(&layer.base, Base::Dielectric { ior, .. } if ior.of_engine().is_some_and(|index| index != 1.0)))
    }

    /// The stack as models see it that follow light down and up once: a `metallic-roughness` surface shows its colour by that light alone. Its interface bends
    /// none, and the albedo of its diffuse base is `r / (n^2 - r (n^2 - 1))`, n being the index by which it did: that of the base below such an interface which
    /// has the colour of the base r.
    #[must_use]
    pub fn crossed_once(&self) -> Self {
        self.by_index(1.0)
    }

    /// The inverse of [`Self::crossed_once`]: the stack as simulations have it, where a `metallic-roughness` surface bends light by [`DIELECTRIC_INDEX`].
    #[must_use]
    pub fn bent(&self) -> Self {
        self.by_index(DIELECTRIC_INDEX)
    }

    /// The stack with another index of `metallic-roughness` surfaces, and the same colour of them.
    fn by_index(&self, to: f64) -> Self {
        let mut here = self.clone();
        let mut above = self.exterior.clone();
        let mut square = 1.0;
        for layer in &mut here.layers {
            match &mut layer.base {
                Base::Dielectric { ior, .. } => {
                    let engine = ior.of_engine().filter(|index| *index != to).zip(ior.f82_rgb());
                    square = engine.map_or(1.0, |(index, _)| (index / to) * (index / to));
                    if let Some((_, curves)) = engine {
                        *ior = Ior::engine(&above, to).with_f82(curves);
                    }
                    above = ior.clone();
                }
                Base::Diffuse(base) => base.albedo = base.albedo.map(|r| r / (square - r * (square - 1.0))),
                Base::Conductor { .. } => {}
            }
        }
        here
    }
}

impl Stack {
    /// The stack without films on its first layer.
    #[must_use]
    pub fn without_first_films(&self) -> Self {
        let mut bare = self.clone();
        bare.layers.iter_mut().take(1).for_each(|first| first.films.clear());
        bare
    }
}

/// One interface, and the material below it.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Layer {
    /// Coherent thin films on the interface, from the top down; they share its micro-surface.
    pub films: Vec<Film>,
    /// The micro-surface. Ignored by a diffuse base.
    pub surface: Surface,
    /// Material below the interface.
    pub base: Base,
}

impl Layer {
    /// Whether it is an interface with other slopes along one axis than along the other.
    pub fn is_anisotropic(&self) -> bool {
        !matches!(self.base, Base::Diffuse(_)) && self.surface.alpha_x != self.surface.alpha_y
    }
}

/// Material below an interface.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Base {
    /// A transparent or absorbing medium, and the slab of it down to the next layer.
    Dielectric {
        /// Index of the medium.
        ior: Ior,
        /// The slab below the interface; of no consequence when the layer is the last (half-infinite).
        slab: Slab,
    },
    /// An opaque medium.
    Conductor {
        /// Complex index of the medium.
        ior: Ior,
    },
    /// An opaque diffuse base, with no interface of its own.
    Diffuse(Diffuse),
}

/// A medium between two interfaces; it absorbs but does not scatter.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Slab {
    /// Thickness along the normal.
    pub thickness_um: f64,
    /// Absorption coefficient per colour channel (linear Rec.709).
    pub absorption_per_um: Rgb,
}

impl Slab {
    /// Thickness times absorption, per channel: the optical depth along the normal.
    pub fn optical_depth(&self) -> Rgb {
        self.absorption_per_um.map(|a| a * self.thickness_um)
    }
}

/// An opaque diffuse reflector (Oren and Nayar 1994, full model; Lambert at `sigma = 0`).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Diffuse {
    /// Diffuse albedo per channel (linear Rec.709), each in 0..1.
    pub albedo: Rgb,
    /// Standard deviation of the facet slope angle, in radians; 0 is Lambert.
    pub sigma: f64,
}

/// A coherent thin film.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Film {
    /// Index of the film.
    pub ior: Ior,
    /// Thickness.
    pub thickness: FilmThickness,
}

/// Extinction coefficient that counts as none: data sets of clear glass and water reach it in the visible.
const CLEAR: f64 = 1e-6;

impl Film {
    /// The film at a wavelength, at its nominal thickness.
    pub fn at(&self, wavelength_nm: f64) -> FilmLayer {
        FilmLayer { ior: self.ior.at(wavelength_nm), waves: self.thickness.nominal_nm() / wavelength_nm }
    }

    /// Whether it absorbs no light.
    pub fn is_clear(&self) -> bool {
        self.ior.samples().iter().all(|sample| sample.k <= CLEAR)
    }

    /// Whether its thickness varies over the surface.
    pub fn varies(&self) -> bool {
        self.thickness.min_nm < self.thickness.max_nm
    }
}

/// Thickness of a film, constant or varying over the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FilmThickness {
    /// Thinnest.
    pub min_nm: f64,
    /// Thickest; equal to `min_nm` for a film of constant thickness.
    pub max_nm: f64,
}

impl FilmThickness {
    /// The middle of the range, for models without a thickness map.
    pub fn nominal_nm(&self) -> f64 {
        0.5 * (self.min_nm + self.max_nm)
    }
}

/// Slope distribution of a micro-surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Distribution {
    /// Beckmann and Spizzichino 1963: Gaussian slopes.
    Beckmann,
    /// Trowbridge and Reitz 1975; "GGX" in Walter et al. 2007.
    #[default]
    Ggx,
    /// Blinn 1977, normalised: a power of the cosine, of exponent 2/alpha^2 - 2 (Walter et al. 2007).
    Blinn,
    /// Low et al. 2012, "ABC", normalised.
    Abc(Shape),
    /// Bagher et al. 2012: the shifted gamma distribution.
    Sgd(Shape),
}

impl Distribution {
    /// The name used in files, manifests and shaders.
    pub fn name(self) -> &'static str {
        match self {
            Self::Beckmann => "beckmann",
            Self::Ggx => "ggx",
            Self::Blinn => "blinn",
            Self::Abc(_) => "abc",
            Self::Sgd(_) => "sgd",
        }
    }

    /// The distribution of a name; `None` for one that has parameters of its own.
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Beckmann, Self::Ggx, Self::Blinn].into_iter().find(|distribution| distribution.name() == name)
    }

    /// Slope parameter that the own parameters of a distribution decide; `None` for distributions that take any slope parameter.
    pub fn own_alpha(self) -> Option<f64> {
        match self {
            Self::Abc(shape) | Self::Sgd(shape) => Some(shape.alpha()),
            Self::Beckmann | Self::Ggx | Self::Blinn => None,
        }
    }

    /// Whether Smith's masking, visible normals and walks between facets have a closed form: for Beckmann and GGX, because every alpha is a
    /// stretched alpha 1.
    pub fn has_walks(self) -> bool {
        matches!(self, Self::Beckmann | Self::Ggx)
    }

    /// The distribution that stands in for it in walks between facets: itself, or GGX of equal slope parameter.
    #[must_use]
    pub fn walked(self) -> Self {
        if self.has_walks() { self } else { Self::Ggx }
    }
}

/// A micro-surface: slope parameters along two tangents. `alpha_x == alpha_y == 0` is smooth.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Surface {
    /// Slope distribution.
    pub distribution: Distribution,
    /// Slope parameter along the tangent, 0..=1.
    pub alpha_x: f64,
    /// Slope parameter along the bitangent, 0..=1.
    pub alpha_y: f64,
    /// Angle from the surface's tangent to this layer's, counter-clockwise, in radians.
    pub rotation: f64,
}

impl Surface {
    /// Isotropic surface.
    pub fn isotropic(distribution: Distribution, alpha: f64) -> Self {
        Self { distribution, alpha_x: alpha, alpha_y: alpha, rotation: 0.0 }
    }

    /// Perfectly smooth.
    pub fn smooth() -> Self {
        Self::isotropic(Distribution::Ggx, 0.0)
    }

    /// Whether both slope parameters are zero.
    pub fn is_smooth(&self) -> bool {
        self.alpha_x == 0.0 && self.alpha_y == 0.0
    }

    /// Geometric mean of the two slope parameters, for isotropic models.
    pub fn alpha_isotropic(&self) -> f64 {
        (self.alpha_x * self.alpha_y).sqrt()
    }
}
