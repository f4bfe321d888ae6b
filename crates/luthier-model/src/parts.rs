//! Parts of a facet model that a material may choose: the masking of the model `microfacet`, how reflectances are computed, and the term of
//! internal reflection.

use serde::{Deserialize, Serialize};

/// A part of a model that a material may choose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModelPart {
    /// Masking and shadowing, by [`Masking`].
    Masking,
    /// Computation of reflectances, by [`Reflectance`].
    Reflectance,
    /// Light from below that an interface lets out, by [`InternalReflection`].
    InternalReflection,
    /// Reflectance of interfaces below the first, by [`LowerReflectance`].
    LowerReflectance,
    /// Cosine of the light on interfaces below the first, by [`LowerCosine`].
    LowerCosine,
    /// Masking of the cavities of a path, by [`Masking`]: V-cavities, or Kelemen's.
    CavityMasking,
    /// Reflection of interfaces below the first, by [`LowerFacets`].
    LowerFacets,
    /// Slope parameters of interfaces below the first, by [`LowerAlpha`].
    LowerAlpha,
    /// Place of the diffuse base, by [`DiffusePart`].
    DiffusePart,
    /// Exponents, weights and a lean of the inner boundary of a film.
    Beams,
    /// Light of a diffuse base beside that of the first interface, by [`DiffuseTerm`].
    DiffuseTerm,
}

luthier_lut::named! {
    /// Masking and shadowing of the model `microfacet`.
    ///
    /// ```
    /// use luthier_model::{Masking, ModelPart, ShadingModel};
    ///
    /// assert!(ShadingModel::Microfacet.takes(ModelPart::Masking) && !ShadingModel::Elek.takes(ModelPart::Masking));
    /// assert_eq!(Masking::from_name("v-cavity"), Some(Masking::VCavity));
    /// // V-cavities need D alone, so that any distribution may have them.
    /// assert!(!Masking::VCavity.needs_lambda());
    /// ```
    #[derive(Default, Serialize, Deserialize)]
    #[serde(into = "&'static str", try_from = "String")]
    pub enum Masking("masking") {
        /// Smith's, height-correlated: `1 / (1 + Lambda_i + Lambda_o)` (Heitz 2014, eq. 99).
        #[default]
        Smith = "smith",
        /// Smith's for each direction, multiplied (Walter et al. 2007, eq. 23).
        SmithSeparable = "smith-separable",
        /// Schlick's fit to Smith's (1994), `cos / (cos (1 - k) + k)` with `k = alpha sqrt(2 / pi)`, multiplied.
        SchlickSmith = "schlick-smith",
        /// V-cavities (Torrance and Sparrow 1967; Cook and Torrance 1982, eq. 9).
        VCavity = "v-cavity",
        /// `cos_theta_i cos_theta_o / cos_theta_d^2` (Kelemen and Szirmay-Kalos 2001).
        Kelemen = "kelemen",
        /// `cos_theta_i cos_theta_o`, which cancels the denominator (Hoffman 2013).
        Implicit = "implicit",
    }
}

luthier_lut::named! {
    /// Computation of the reflectance of interfaces, of the models `elek`, `weidlich-wilkie` and `microfacet`. In `belcour` and `yamaguchi` the table is
    /// that of FGD-infinity; the others take facets as level, as Unity's StackLit does (section 3 of Yamaguchi et al. 2019).
    #[derive(Default, Serialize, Deserialize)]
    #[serde(into = "&'static str", try_from = "String")]
    pub enum Reflectance("reflectance") {
        /// Rows of the Fresnel table; in the form `full`, which has none, Fresnel's equations.
        #[default]
        Table = "table",
        /// Fresnel's equations at three wavelengths, in both forms.
        Exact = "exact",
        /// Schlick's form with the F0 of the complex index: the `FresnelTermNP` of Elek 2010, appendix B.
        Approximate = "approximate",
        /// Schlick's form less the correction `a cos (1 - cos)^alpha` of Lazanyi and Szirmay-Kalos 2005.
        Lazanyi = "lazanyi",
    }
}

luthier_lut::named! {
    /// Reflectance of the interfaces below the first, of the models `elek` and `weidlich-wilkie`.
    #[derive(Default, Serialize, Deserialize)]
    #[serde(into = "&'static str", try_from = "String")]
    pub enum LowerReflectance("lower reflectance") {
        /// By the index below over that of the medium above.
        #[default]
        InPlace = "in-place",
        /// By the index below alone, as if air lay above: the F2 of Elek 2010, Algorithm 1, line 21.
        InAir = "in-air",
    }
}

luthier_lut::named! {
    /// Cosine of the light on the interfaces below the first, of the model `elek`.
    #[derive(Default, Serialize, Deserialize)]
    #[serde(into = "&'static str", try_from = "String")]
    pub enum LowerCosine("lower cosine") {
        /// Cosine outside, as light falls on the surface: f cos_theta_i of Elek 2010, eq. 2.
        #[default]
        Outside = "outside",
        /// Cosine of the refracted direction, as the code of Elek 2010 has it (Algorithm 1, line 21, and appendix B). Light is not kept: at grazing
        /// incidence lower interfaces are too bright by the ratio of both cosines.
        Inside = "inside",
    }
}

luthier_lut::named! {
    /// Reflection of the interfaces below the first, of the models `elek` and `weidlich-wilkie`. Each is times the reflectance F of the interface, and
    /// lobes of a power hide nothing: G is 1 in the term of internal reflection.
    #[derive(Default, Serialize, Deserialize)]
    #[serde(into = "&'static str", try_from = "String")]
    pub enum LowerFacets("lower facets") {
        /// Facets of Torrance and Sparrow, D G / (4 cos_theta_i cos_theta_o).
        #[default]
        TorranceSparrow = "torrance-sparrow",
        /// Lobe of Blinn and Phong about the normal, (e + 2) / (8 pi) cos_theta_h^e with e = 2 / alpha^2 - 2: a distribution of Blinn's with implicit
        /// masking.
        BlinnPhong = "blinn-phong",
        /// Phong's lobe about the mirrored direction, (e + 2) / (2 pi) cos^e, with a quarter of Blinn's exponent.
        Phong = "phong",
    }
}

luthier_lut::named! {
    /// Slope parameters of the interfaces below the first, of the model `weidlich-wilkie`.
    #[derive(Default, Serialize, Deserialize)]
    #[serde(into = "&'static str", try_from = "String")]
    pub enum LowerAlpha("lower alpha") {
        /// Those of the file.
        #[default]
        Own = "own",
        /// At least the greatest above, for the blur by refraction: the rough base of type f in the slides of the course, and Elek 2010, Algorithm 1,
        /// line 21.
        AtLeastAbove = "at-least-above",
    }
}

luthier_lut::named! {
    /// Place of a diffuse base, of the models `elek` and `weidlich-wilkie`.
    #[derive(Default, Serialize, Deserialize)]
    #[serde(into = "&'static str", try_from = "String")]
    pub enum DiffusePart("diffuse part") {
        /// Below the last interface, which light crosses both ways.
        #[default]
        Below = "below",
        /// Beside the facets of the last interface, in one layer with them: (1 - F) times its BRDF, unbent (Elek 2010, Algorithm 1, line 22).
        Beside = "beside",
    }
}

luthier_lut::named! {
    /// Light from below that an interface lets out, of the models `elek` and `weidlich-wilkie` (the term t of Elek 2010, eq. 4).
    #[derive(Default, Serialize, Deserialize)]
    #[serde(into = "&'static str", try_from = "String")]
    pub enum InternalReflection("internal reflection") {
        /// `t = (1 - G) + T_21 G`: facets reflect a part back, and let out what they hide from each other (the course, eq. 3.3).
        #[default]
        Facets = "facets",
        /// `t = 1`: all of it comes out (the right half of figure 3.7 of the course).
        None = "none",
        /// `t = T_21`, with T_12 at the angle of the light and T_21 at that of the eye, where both are taken at the half vector else.
        Directions = "directions",
    }
}

luthier_lut::named! {
    /// Light of the diffuse base in the model `microfacet`.
    #[derive(Default, Serialize, Deserialize)]
    #[serde(into = "&'static str", try_from = "String")]
    pub enum DiffuseTerm("diffuse term") {
        /// None: what the first interface lets through is lost.
        #[default]
        None = "none",
        /// The base as if no interface lay above it: `albedo / pi` beside `F D G / (4 cos_theta_i cos_theta_o)`, as shaders of engines add both. It returns
        /// more light than falls in where albedo and reflectance sum to more than 1.
        Added = "added",
    }
}

luthier_lut::named! {
    /// Height of the lobes of the model `granier-heidrich`.
    #[derive(Default, Serialize, Deserialize)]
    #[serde(into = "&'static str", try_from = "String")]
    pub enum LobeHeight("lobe height") {
        /// Each lobe carries its coefficient: `(e + 1) / (2 pi)`, and in the film `cos_theta_i / (n^2 cos_theta_t)` more.
        #[default]
        Scaled = "scaled",
        /// Height one, as printed (Granier and Heidrich 2003, eq. 6 and 10). A lobe carries `2 pi / (e + 1)` of its coefficient, more than all of it where
        /// e is below 5.28.
        One = "one",
    }
}

/// Parts of a model that goes down a path, as far as a material chooses them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PathParts {
    /// Masking: Kelemen's; else that of V-cavities, whatever it says.
    pub masking: Masking,
    /// Light from below that interfaces let out.
    pub internal_reflection: InternalReflection,
    /// Cosine of the light on interfaces below the first.
    pub lower_cosine: LowerCosine,
    /// Reflection of interfaces below the first.
    pub lower_facets: LowerFacets,
    /// Slope parameters of interfaces below the first.
    pub lower_alpha: LowerAlpha,
    /// Place of the diffuse base.
    pub diffuse_part: DiffusePart,
}

impl PathParts {
    /// The parts of a material that chooses none.
    pub const PLAIN: Self = Self {
        masking: Masking::Smith,
        internal_reflection: InternalReflection::Facets,
        lower_cosine: LowerCosine::Outside,
        lower_facets: LowerFacets::TorranceSparrow,
        lower_alpha: LowerAlpha::Own,
        diffuse_part: DiffusePart::Below,
    };

    /// Masking of the path: [`Masking::Kelemen`] or [`Masking::VCavity`].
    pub fn cavity_masking(self) -> Masking {
        if self.masking == Masking::Kelemen { Masking::Kelemen } else { Masking::VCavity }
    }
}

impl Masking {
    /// Formula and source, for headers and messages.
    pub fn title(self) -> &'static str {
        match self {
            Self::Smith => "Smith, height-correlated (Heitz 2014)",
            Self::SmithSeparable => "Smith for each direction, multiplied (Walter et al. 2007)",
            Self::SchlickSmith => "Schlick's fit to Smith (1994)",
            Self::VCavity => "V-cavities (Torrance and Sparrow 1967)",
            Self::Kelemen => "cos_theta_i cos_theta_o / cos_theta_d^2 (Kelemen and Szirmay-Kalos 2001)",
            Self::Implicit => "cos_theta_i cos_theta_o (Hoffman 2013)",
        }
    }

    /// Whether it is made of Smith's Lambda, which Beckmann's distribution and GGX have in closed form.
    pub fn needs_lambda(self) -> bool {
        matches!(self, Self::Smith | Self::SmithSeparable)
    }

    /// Its number in the material buffer.
    pub fn number(self) -> u32 {
        self as u32
    }
}

impl Reflectance {
    /// Formula and source, for headers and messages.
    pub fn title(self) -> &'static str {
        match self {
            Self::Table => "rows of a table",
            Self::Exact => "Fresnel's equations at three wavelengths",
            Self::Approximate => "Schlick's form with the F0 of n and k (Elek 2010, FresnelTermNP), an approximation",
            Self::Lazanyi => {
                "Schlick's form less a cos (1 - cos)^alpha (Lazanyi and Szirmay-Kalos 2005), an approximation"
            }
        }
    }

    /// Whether it is a curve through a few numbers: see [`ReflectanceCurve`].
    pub fn is_fitted(self) -> bool {
        matches!(self, Self::Approximate | Self::Lazanyi)
    }

    /// Its number in the material buffer.
    pub fn number(self) -> u32 {
        self as u32
    }
}

impl LowerReflectance {
    /// Rule and source, for headers and messages.
    pub fn title(self) -> &'static str {
        match self {
            Self::InPlace => "by the index over that of the medium above",
            Self::InAir => "by the index alone, as in air (Elek 2010, Algorithm 1, line 21)",
        }
    }
}

impl LowerCosine {
    /// Rule and source, for headers and messages.
    pub fn title(self) -> &'static str {
        match self {
            Self::Outside => "the cosine outside (Elek 2010, eq. 2)",
            Self::Inside => "the cosine of the refracted direction (Elek 2010, Algorithm 1, line 21)",
        }
    }
}

impl LowerFacets {
    /// Formula and source, for headers and messages.
    pub fn title(self) -> &'static str {
        match self {
            Self::TorranceSparrow => "D G / (4 cos_theta_i cos_theta_o) (Torrance and Sparrow 1967)",
            Self::BlinnPhong => "(e + 2) / (8 pi) cos_theta_h^e (Blinn 1977)",
            Self::Phong => "(e + 2) / (2 pi) cos^e about the mirrored direction (Phong 1975)",
        }
    }

    /// Its number in the material buffer.
    pub fn number(self) -> u32 {
        self as u32
    }
}

impl LowerAlpha {
    /// Rule, for headers and messages.
    pub fn title(self) -> &'static str {
        match self {
            Self::Own => "their own",
            Self::AtLeastAbove => "at least the greatest above",
        }
    }

    /// Its number in the material buffer.
    pub fn number(self) -> u32 {
        self as u32
    }
}

impl DiffusePart {
    /// Rule and source, for headers and messages.
    pub fn title(self) -> &'static str {
        match self {
            Self::Below => "below the last interface",
            Self::Beside => "of the layer of the last interface (Elek 2010, Algorithm 1, line 22)",
        }
    }
}

impl DiffuseTerm {
    /// Rule and source, for headers and messages.
    pub fn title(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Added => "the diffuse base as if no interface lay above it",
        }
    }
}

impl LobeHeight {
    /// Rule and source, for headers and messages.
    pub fn title(self) -> &'static str {
        match self {
            Self::Scaled => "each lobe carries its coefficient",
            Self::One => "lobes of height one (Granier and Heidrich 2003, eq. 6 and 10)",
        }
    }

    /// Its number in the material buffer.
    pub fn number(self) -> u32 {
        self as u32
    }
}

impl InternalReflection {
    /// Formula and source, for headers and messages.
    pub fn title(self) -> &'static str {
        match self {
            Self::Facets => "t = (1 - G) + T_21 G (Elek 2010, eq. 4)",
            Self::None => "t = 1, none",
            Self::Directions => "t = T_21, transmission at the directions' own angles",
        }
    }

    /// Its number in the material buffer.
    pub fn number(self) -> u32 {
        self as u32
    }
}

/// Reflectance of an interface as a curve, RGB: `f0 + (1 - f0) (1 - c)^5 - weight c (1 - c)^exponent`, c the cosine.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct ReflectanceCurve {
    /// Reflectance at normal incidence.
    pub f0: [f64; 3],
    /// Weight of the correction; 0 is Schlick's form.
    pub weight: [f64; 3],
    /// Exponent of the correction, at least 1.
    pub exponent: [f64; 3],
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_the_first_and_have_the_number_0() {
        assert_eq!((Masking::default(), Masking::default().number()), (Masking::ALL[0], 0));
        assert_eq!((Reflectance::default(), Reflectance::default().number()), (Reflectance::ALL[0], 0));
        assert_eq!(InternalReflection::default().number(), 0);
        assert_eq!(LowerReflectance::default(), LowerReflectance::ALL[0]);
        assert_eq!(LowerCosine::default(), LowerCosine::ALL[0]);
        assert_eq!((LowerFacets::default().number(), LowerAlpha::default().number()), (0, 0));
        assert_eq!(DiffusePart::default(), DiffusePart::ALL[0]);
        assert_eq!(DiffuseTerm::default(), DiffuseTerm::ALL[0]);
        assert_eq!((LobeHeight::default(), LobeHeight::default().number()), (LobeHeight::ALL[0], 0));
        // Two bits and three of a word: see `LayerRecord::words`.
        assert!(Reflectance::ALL.iter().all(|reflectance| reflectance.number() < 4));
        assert!(Masking::ALL.iter().all(|masking| masking.number() < 8));
    }
}
