//! Settings that a material file asks of its tables.

use luthier_lut::{TableKind, TexelFormat, named};
use luthier_manifest::{
    ColorMode, DiffusePart, DiffuseTerm, InternalReflection, LobeHeight, LobesForm, LowerAlpha, LowerCosine,
    LowerFacets, LowerReflectance, Masking, ModelPart, PathParts, Reflectance, ShadingModel,
};

/// The three wavelengths of a material that names none, as R, G and B (Granier and Heidrich 2003).
pub const DEFAULT_WAVELENGTHS_NM: [f64; 3] = [645.0, 525.0, 445.0];

/// The line at which a single index is usually quoted.
pub(crate) const SODIUM_D_NM: f64 = 589.3;

named! {
    /// Axis of a Fresnel row.
    pub enum FresnelMapping("mapping") {
        /// Linear in cos theta.
        Cosine = "cosine",
        /// Linear in the square root of cos theta.
        SqrtCosine = "sqrt-cosine",
        /// Linear in theta.
        Theta = "theta",
    }
}

named! {
    /// Angle axis of the table of slope distributions.
    pub enum DistributionMapping("mapping") {
        /// theta_h = (pi/2) u^exponent (Elek 2010, section 3.1).
        Power = "power",
        /// theta_h = (pi/2) u.
        Linear = "linear",
        /// cos theta_h = u^(1/exponent): the other reading of the same passage, for comparison.
        CosPower = "cos-power",
    }
}

named! {
    /// Slope axis of the table of slope distributions.
    pub enum AlphaMapping("mapping") {
        /// Equal ratios.
        Log = "log",
        /// Equal steps.
        Linear = "linear",
    }
}

/// Settings that a material asks of its tables; `None` leaves the choice to the baker.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct BakeSettings {
    /// The reflectance model of the shader.
    pub model: Option<ShadingModel>,
    /// Masking of the models `microfacet`, `elek` and `weidlich-wilkie`.
    pub masking: Option<Masking>,
    /// Computation of reflectances, of models that have a choice.
    pub reflectance: Option<Reflectance>,
    /// Internal reflection of the models `elek` and `weidlich-wilkie`.
    pub internal_reflection: Option<InternalReflection>,
    /// Reflectance of the interfaces below the first, of these models.
    pub lower_reflectance: Option<LowerReflectance>,
    /// Cosine of the light on these interfaces, of the model `elek`.
    pub lower_cosine: Option<LowerCosine>,
    /// Reflection of these interfaces, of the models `elek` and `weidlich-wilkie`.
    pub lower_facets: Option<LowerFacets>,
    /// Their slope parameters, of the model `weidlich-wilkie`.
    pub lower_alpha: Option<LowerAlpha>,
    /// Place of the diffuse base, of the models `elek` and `weidlich-wilkie`.
    pub diffuse_part: Option<DiffusePart>,
    /// Light of the diffuse base, of the model `microfacet`.
    pub diffuse_term: Option<DiffuseTerm>,
    /// Numbers of the model `granier-heidrich`.
    pub beams: Option<Beams>,
    /// Form of rows of the model `lobes`, which no file states: a scene chooses it. Rows of a set are of one width where each of its materials has that form or no lobe.
    pub lobes: Option<LobesForm>,
    /// Kinds of tables to bake beside those that the shader reads.
    pub tables: Vec<TableKind>,
    /// Spectral or at three wavelengths.
    pub color: Option<ColorMode>,
    /// Wavelengths taken as R, G and B, in nm.
    pub wavelengths_nm: Option<[f64; 3]>,
    /// Fresnel rows.
    pub fresnel: FresnelSettings,
    /// Slope distribution.
    pub distribution: DistributionSettings,
    /// Energy of the rough interface.
    pub fgd: GridSettings,
    /// Phase rows of films.
    pub phase: RowSettings,
    /// Thickness textures of films; square.
    pub thickness: RowSettings,
}

/// Numbers of the model `granier-heidrich` that belong to no layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beams {
    /// Weight of the specular part.
    pub specular_weight: f64,
    /// Weight of the diffuse part, beside the albedo of the base.
    pub diffuse_weight: f64,
    /// Lean of the inner boundary, in radians.
    pub inner_tilt: f64,
    /// Azimuth to which its normal leans, in radians.
    pub inner_azimuth: f64,
    /// Height of both lobes.
    pub lobe_height: LobeHeight,
}

impl Default for Beams {
    fn default() -> Self {
        Self {
            specular_weight: 1.0,
            diffuse_weight: 1.0,
            inner_tilt: 0.0,
            inner_azimuth: 0.0,
            lobe_height: LobeHeight::Scaled,
        }
    }
}

impl BakeSettings {
    /// The three wavelengths, by default [`DEFAULT_WAVELENGTHS_NM`].
    pub fn wavelengths_nm(&self) -> [f64; 3] {
        self.wavelengths_nm.unwrap_or(DEFAULT_WAVELENGTHS_NM)
    }

    /// The parts of a model that goes down a path, as far as it offers a choice.
    pub fn path_parts(&self, model: ShadingModel) -> PathParts {
        if !model.is_path() {
            return PathParts::default();
        }
        PathParts {
            masking: self.masking.filter(|masking| *masking == Masking::Kelemen).unwrap_or_default(),
            internal_reflection: self.internal_reflection.unwrap_or_default(),
            lower_cosine: self.lower_cosine.filter(|_| model.takes(ModelPart::LowerCosine)).unwrap_or_default(),
            lower_facets: self.lower_facets.filter(|_| model.takes(ModelPart::LowerFacets)).unwrap_or_default(),
            lower_alpha: self.lower_alpha.filter(|_| model.takes(ModelPart::LowerAlpha)).unwrap_or_default(),
            diffuse_part: self.diffuse_part.filter(|_| model.takes(ModelPart::DiffusePart)).unwrap_or_default(),
        }
    }

    /// Whether the file asks for tables of a kind, even if the shader does not read them: `tables` names the kind, or the kind has settings.
    pub fn asks_for(&self, kind: TableKind) -> bool {
        let is_set = match kind {
            TableKind::Fresnel => self.fresnel != FresnelSettings::default(),
            TableKind::Distribution => self.distribution != DistributionSettings::default(),
            TableKind::Fgd => self.fgd != GridSettings::default(),
            TableKind::Phase => self.phase != RowSettings::default(),
            TableKind::Thickness => self.thickness != RowSettings::default(),
            _ => false,
        };
        is_set || self.tables.contains(&kind)
    }
}

/// Settings of the Fresnel rows.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FresnelSettings {
    /// Texels of a row.
    pub size: Option<u32>,
    /// Texel format.
    pub format: Option<TexelFormat>,
    /// Axis.
    pub mapping: Option<FresnelMapping>,
}

/// Settings of the table of slope distributions.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DistributionSettings {
    /// Texels along the angle and along alpha.
    pub size: Option<[u32; 2]>,
    /// Texel format.
    pub format: Option<TexelFormat>,
    /// Angle axis.
    pub mapping: Option<DistributionMapping>,
    /// Exponent of the angle axis.
    pub exponent: Option<f64>,
    /// Slope axis.
    pub alpha_mapping: Option<AlphaMapping>,
}

/// Settings of a table with two axes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct GridSettings {
    /// Texels along x and y.
    pub size: Option<[u32; 2]>,
    /// Texel format.
    pub format: Option<TexelFormat>,
}

/// Settings of a row or of a square texture.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RowSettings {
    /// Texels along a side.
    pub size: Option<u32>,
    /// Texel format.
    pub format: Option<TexelFormat>,
}
