use crate::named::named;

/// The three wavelengths of a material that names none, as R, G and B (Granier and Heidrich 2003).
pub const DEFAULT_WAVELENGTHS_NM: [f64; 3] = [645.0, 525.0, 445.0];

named! {
    /// Colour mode of the channels of a table.
    pub enum ColorSetting {
        /// Spectra, integrated against the CIE 1931 observer under D65.
        Spectral = "spectral",
        /// The function at three wavelengths, taken as R, G and B.
        ThreeWavelengths = "three-wavelengths",
    }
}

named! {
    /// Models that shaders evaluate.
    pub enum ModelSetting {
        /// Elek 2010.
        Elek = "elek",
        /// Weidlich and Wilkie 2007.
        WeidlichWilkie = "weidlich-wilkie",
        /// Granier and Heidrich 2003.
        GranierHeidrich = "granier-heidrich",
        /// Belcour 2018.
        Belcour = "belcour",
        /// Yamaguchi et al. 2019.
        Yamaguchi = "yamaguchi",
        /// One Phong lobe over one diffuse term.
        Phong = "phong",
        /// The first interface alone.
        Microfacet = "microfacet",
    }
}

named! {
    /// Kinds of tables.
    pub enum TableSetting {
        /// Fresnel reflectance of interfaces.
        Fresnel = "fresnel",
        /// Slope distributions.
        Distribution = "distribution",
        /// Energy of rough interfaces, all bounces included.
        Fgd = "fgd",
        /// Interference of films.
        Phase = "phase",
        /// Thickness of films that vary over the surface.
        Thickness = "thickness",
        /// Reflectance of interfaces whose film varies.
        Film = "film",
        /// Share of light that is not totally reflected inside a denser medium.
        Escape = "escape",
    }
}

named! {
    /// Texel formats, named as WebGPU names them.
    pub enum Format {
        /// One half float.
        R16Float = "r16float",
        /// Two half floats, which hold the sixteenth root of one value.
        Rg16Float = "rg16float",
        /// One float.
        R32Float = "r32float",
        /// Four unsigned normalised bytes.
        Rgba8Unorm = "rgba8unorm",
        /// Four unsigned normalised values of 16 bits; not in core WebGPU.
        Rgba16Unorm = "rgba16unorm",
        /// Three half floats without sign in blocks of 4 x 4 texels; not in core WebGPU.
        Bc6hRgbUfloat = "bc6h-rgb-ufloat",
        /// Four half floats.
        Rgba16Float = "rgba16float",
        /// Four floats.
        Rgba32Float = "rgba32float",
    }
}

named! {
    /// Axis of a Fresnel row.
    pub enum FresnelMapping {
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
    pub enum DistributionMapping {
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
    pub enum AlphaMapping {
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
    pub model: Option<ModelSetting>,
    /// Kinds of tables to bake beside those that the shader reads.
    pub tables: Vec<TableSetting>,
    /// Spectral or at three wavelengths.
    pub color: Option<ColorSetting>,
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

impl BakeSettings {
    /// The three wavelengths, by default [`DEFAULT_WAVELENGTHS_NM`].
    pub fn wavelengths_nm(&self) -> [f64; 3] {
        self.wavelengths_nm.unwrap_or(DEFAULT_WAVELENGTHS_NM)
    }

    /// Whether tables of a kind are to be baked whether or not the shader reads them: `tables` names the kind, or it has settings of its
    /// own.
    pub fn asks_for(&self, kind: TableSetting) -> bool {
        let is_set = match kind {
            TableSetting::Fresnel => self.fresnel != FresnelSettings::default(),
            TableSetting::Distribution => self.distribution != DistributionSettings::default(),
            TableSetting::Fgd => self.fgd != GridSettings::default(),
            TableSetting::Phase => self.phase != RowSettings::default(),
            TableSetting::Thickness => self.thickness != RowSettings::default(),
            TableSetting::Film | TableSetting::Escape => false,
        };
        is_set || self.tables.contains(&kind)
    }
}

/// Limits on the tables that serve a material; the baker looks for the cheapest that hold them.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BudgetSettings {
    /// Largest absolute error of a sampled read.
    pub max_abs: Option<f64>,
    /// Largest relative error, with a floor.
    pub max_rel: Option<f64>,
    /// Largest CIEDE2000 difference.
    pub delta_e: Option<f64>,
    /// Bytes of all tables of the bake.
    pub max_bytes: Option<u64>,
    /// Estimated cost of one read of every table.
    pub max_cost: Option<f64>,
}

/// Settings of the Fresnel rows.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FresnelSettings {
    /// Texels of a row.
    pub size: Option<u32>,
    /// Texel format.
    pub format: Option<Format>,
    /// Axis.
    pub mapping: Option<FresnelMapping>,
}

/// Settings of the table of slope distributions.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DistributionSettings {
    /// Texels along the angle and along alpha.
    pub size: Option<[u32; 2]>,
    /// Texel format.
    pub format: Option<Format>,
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
    pub format: Option<Format>,
}

/// Settings of a row or of a square texture.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RowSettings {
    /// Texels along a side.
    pub size: Option<u32>,
    /// Texel format.
    pub format: Option<Format>,
}
