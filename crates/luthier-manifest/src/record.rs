//! The record of a layer, as shaders and their f64 twins read it.

use std::f64::consts::{FRAC_1_PI, LOG2_E};

use luthier_lut::{TableKind, refracted_cosine};
use luthier_model::{
    DiffusePart, InternalReflection, LowerAlpha, LowerCosine, LowerFacets, LowerReflectance, Masking, Reflectance,
    ReflectanceCurve,
};
use luthier_optics::schlick::F82;
use luthier_optics::stack::Distribution;
use serde::{Deserialize, Serialize};

use crate::tiles::Tiles;

/// `vec4` words of a layer in the material buffer: 11 for its numbers, and more if kinds of tables have slots beyond.
pub const LAYER_WORDS: usize = {
    let (mut words, mut i) = (11, 0);
    while i < TableKind::ALL.len() {
        if let Some([word, _]) = TableKind::ALL[i].facts().slot
            && word >= words
        {
            words = word + 1;
        }
        i += 1;
    }
    words
};

/// Kind of a layer, to the shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LayerKind {
    /// A dielectric interface with a slab below: reflects, and lets light through.
    #[default]
    Dielectric,
    /// A conductor: reflects only.
    Conductor,
    /// A diffuse base.
    Diffuse,
}

/// Everything a shader needs of one layer; the f64 twin reads the same record.
///
/// Indices are relative to the medium above the interface, at the three wavelengths of the material.
///
/// ```
/// use luthier_manifest::{LAYER_WORDS, LayerKind, LayerRecord};
///
/// let base = LayerRecord { kind: LayerKind::Diffuse, albedo: [0.5; 3], ..LayerRecord::default() };
/// let words = base.words();
/// assert_eq!(words.len(), LAYER_WORDS);
/// // Word 3 has the albedo over pi; word 1 has tiles, -1 for none.
/// assert!((words[3][0] * std::f32::consts::PI - 0.5).abs() < 1e-6);
/// assert_eq!(words[1], [-1.0; 4]);
/// ```
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct LayerRecord {
    /// Kind of the layer.
    pub kind: LayerKind,
    /// Slope distribution: `beckmann`, `ggx`, `blinn`, or an object of the type `abc` or `sgd` with the parameters of a material file.
    #[serde(with = "crate::distribution")]
    pub distribution: Distribution,
    /// Isotropic slope parameter, clamped to the domain of the model.
    pub alpha: f64,
    /// Slope parameters along the layer's tangent and bitangent, clamped alike.
    pub alpha_xy: [f64; 2],
    /// Angle from the surface's tangent to the layer's, counter-clockwise, in radians.
    pub rotation: f64,
    /// Real index below over index above at 589.3 nm, which bends the refracted directions; 1 for opaque bases.
    pub eta: f64,
    /// Absorption times thickness of the slab below, RGB.
    pub optical_depth: [f64; 3],
    /// Diffuse albedo, RGB.
    pub albedo: [f64; 3],
    /// Oren-Nayar slope deviation, radians; 0 is Lambert.
    pub sigma: f64,
    /// Rows of the matrix from light to light of a fluorescent base, linear Rec.709 under D65, whose sums are its colour under white
    /// light; absent where the base returns light at its own wavelength alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reradiation: Option<[[f64; 3]; 3]>,
    /// Real part of the relative index at the three wavelengths.
    pub ior_n: [f64; 3],
    /// Imaginary part.
    pub ior_k: [f64; 3],
    /// Reflectance at normal incidence, RGB, of an interface that reflects by Schlick's formula, f0 + (1 - f0)(1 - cos)^5. Its index bends
    /// directions only. Beside a film it is that of a conductor, or that without metal of a base whose maps give each place an F0: the film then
    /// reflects by a series that reads the phase row ([`luthier_optics::film_over_f0`]).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub f0: Option<[f64; 3]>,
    /// Edge tint of such an interface, RGB: its reflectance at 81.8 degrees over that of Schlick's formula (F82). Absent without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub f82_tint: Option<[f64; 3]>,
    /// Edge tint of the metal that a `metallic-roughness` interface with maps is at some places, RGB. Absent without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub metal_f82_tint: Option<[f64; 3]>,
    /// Whether such an interface is a metal at all places: a map of its base colour, which has none of metal beside it, is that of the F0 of a conductor.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_metal: bool,
    /// Real part of the film's relative index; 0 without a film.
    pub film_ior_n: [f64; 3],
    /// Imaginary part.
    pub film_ior_k: [f64; 3],
    /// Film thickness over the wavelength in the medium above, per channel; 0 without a film.
    pub film_thickness_waves: [f64; 3],
    /// Nominal film thickness; 0 without a film.
    pub film_thickness_nm: f64,
    /// Thickest the film gets; 0 without a film.
    pub film_thickness_max_nm: f64,
    /// Squared cotangent of the critical angle, if the Fresnel row and the film tile are over the cosine of the refracted direction: for
    /// interfaces with total reflection. Else 0.
    #[serde(default)]
    pub critical_cot_sq: f64,
    /// Masking of the models `microfacet`, `elek` and `weidlich-wilkie`; absent where it is the default.
    #[serde(default, skip_serializing_if = "is_default")]
    pub masking: Masking,
    /// Computation of the reflectance of the interface; absent where it is the default.
    #[serde(default, skip_serializing_if = "is_default")]
    pub reflectance: Reflectance,
    /// Curve of the reflectance, if that is an approximation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curve: Option<ReflectanceCurve>,
    /// Light from below that the interface lets out, of the models `elek` and `weidlich-wilkie`; absent where it is the default.
    #[serde(default, skip_serializing_if = "is_default")]
    pub internal_reflection: InternalReflection,
    /// Medium above the interface in the computation of its reflectance, and of the indices here; absent where it is the default.
    #[serde(default, skip_serializing_if = "is_default")]
    pub lower_reflectance: LowerReflectance,
    /// Cosine of the light on the interface, of the model `elek`; absent where it is the default.
    #[serde(default, skip_serializing_if = "is_default")]
    pub lower_cosine: LowerCosine,
    /// Reflection of the interface if it is not the first, of the models `elek` and `weidlich-wilkie`; absent where it is the default.
    #[serde(default, skip_serializing_if = "is_default")]
    pub lower_facets: LowerFacets,
    /// Slope parameter of the interface below others, of the model `weidlich-wilkie`; absent where it is the default.
    #[serde(default, skip_serializing_if = "is_default")]
    pub lower_alpha: LowerAlpha,
    /// Place of the diffuse base that follows the interface, of the models `elek` and `weidlich-wilkie`; absent where it is the default.
    #[serde(default, skip_serializing_if = "is_default")]
    pub diffuse_part: DiffusePart,
    /// The tiles that serve the layer: fields `fresnel_tile` and so on.
    #[serde(flatten)]
    pub tiles: Tiles,
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

impl LayerRecord {
    /// Whether the thickness of its film varies over the surface.
    pub fn varies(&self) -> bool {
        self.film_thickness_max_nm > self.film_thickness_nm
    }

    /// Whether its interface lies between transparent media of one relative index in all channels.
    pub fn has_one_index(&self) -> bool {
        self.ior_k == [0.0; 3] && self.ior_n == [self.ior_n[0]; 3]
    }

    /// Whether a film reflects by a series in the F0 of the place below it. Its phase row has means over the channels then.
    pub fn has_film_over_f0(&self) -> bool {
        self.f0.is_some() && self.film_ior_n[0] > 0.0
    }

    /// The cosine at which the Fresnel row and the film tile are read for light that meets the interface at `cos_theta`.
    pub fn row_cosine(&self, cos_theta: f64) -> f64 {
        refracted_cosine(self.critical_cot_sq, cos_theta)
    }

    /// Weights of the correction of Schlick's formula by an edge tint, RGB; 0 without one.
    fn edge_weights(&self) -> [f64; 3] {
        let (f0, tint) = (self.f0.unwrap_or_default(), self.f82_tint.unwrap_or([1.0; 3]));
        [0, 1, 2].map(|c: usize| F82 { f0: f0[c], tint: tint[c] }.dip())
    }

    /// The words of the material buffer, in the order that the shader unpacks them. Tiles are numbers, -1 for none, where
    /// [`luthier_lut::KindFacts::slot`] says.
    ///
    /// | word | x, y, z, w |
    /// |---|---|
    /// | 0 | falloff, peak, 1 / eta, 1 - 1 / eta^2 |
    /// | 1 | Fresnel tile, distribution tile, FGD tile, phase tile |
    /// | 2 | optical depth RGB over ln 2, thickness tile |
    /// | 3 | albedo RGB over pi, of a `metallic-roughness` interface with maps 1 less the edge tint of its metal RGB; distribution (0 beckmann, 1 ggx, 2 blinn, 3 abc, 4 sgd) |
    /// | 4 | ior_n RGB, of an interface of Schlick's f0 RGB; film thickness nm |
    /// | 5 | ior_k RGB, of an interface of Schlick's -1 less the weight of its edge tint; film thickness max nm |
    /// | 6 | film_ior_n RGB, film tile; of a curve f0 RGB |
    /// | 7 | film_ior_k RGB, squared cotangent of the critical angle; of a curve its weights RGB |
    /// | 8 | film thickness in waves RGB, escape tile; of a curve its exponents RGB |
    /// | 9 | alpha_x, alpha_y, cosine and sine of the rotation; of abc b and c, of sgd 1 / alpha and p in x and y |
    /// | 10 | kind (0 dielectric, 1 conductor, 2 diffuse) plus 4 times the number of the reflectance (0 table, 1 exact, 2 approximate, 3 lazanyi) and 16 times that of the masking and 128 times that of the internal reflection (0 facets, 1 none, 2 directions), 512 with the cosine of the refracted direction, 1,024 times the number of the lower facets (0 torrance-sparrow, 1 blinn-phong, 2 phong), 4,096 with a slope parameter of at least those above, alpha, eta, sigma |
    ///
    /// Masking is numbered 0 smith, 1 smith-separable, 2 schlick-smith, 3 v-cavity, 4 kelemen, 5 implicit. An interface with a curve ([`ReflectanceCurve`])
    /// has no film.
    ///
    /// An interface with its diffuse base beside it ([`DiffusePart::Beside`]) has the words of one that neither bends, absorbs nor reflects
    /// inward: its eta is 1, its optical depth 0 and its internal reflection none.
    ///
    /// The weight of an edge tint t is `(1 - t) F(1/7) / (1/7 (6/7)^6)`, F being Schlick's formula: cos (1 - cos)^6 times the weight is taken off.
    ///
    /// A fluorescent base has the rows of its re-radiation matrix over pi in words 4, 5 and 6, red, green and blue, and 1 in x of word 8.
    ///
    /// The falloff of D with the squared slope is 1 / alpha^2, over ln 2 for Beckmann, whose D is a power of two then. Of abc and sgd it is the square
    /// of the slope parameter that their parameters have over alpha: 1 unless a map scales alpha, which stretches slopes. The peak,
    /// 1 / (4 pi alpha^2), is a quarter of the greatest D, as every lobe has it. A reciprocal of 0 is 0: what has no slopes, or lets
    /// nothing through, has no use for it.
    pub fn words(&self) -> [[f32; 4]; LAYER_WORDS] {
        let kind = match self.kind {
            LayerKind::Dielectric => 0,
            LayerKind::Conductor => 1,
            LayerKind::Diffuse => 2,
        };
        let is_beside = self.diffuse_part == DiffusePart::Beside;
        let internal_reflection = if is_beside { InternalReflection::None } else { self.internal_reflection };
        let (eta, optical_depth) = if is_beside { (1.0, [0.0; 3]) } else { (self.eta, self.optical_depth) };
        let parts = 4 * self.reflectance.number()
            + 16 * self.masking.number()
            + 128 * internal_reflection.number()
            + 512 * self.lower_cosine as u32
            + 1024 * self.lower_facets.number()
            + 4096 * self.lower_alpha.number();
        let [first, second, third] = match self.curve {
            Some(ReflectanceCurve { f0, weight, exponent }) => [f0, weight, exponent],
            None => [self.film_ior_n, self.film_ior_k, self.film_thickness_waves],
        };
        let distribution = match self.distribution {
            Distribution::Beckmann => 0.0,
            Distribution::Ggx => 1.0,
            Distribution::Blinn => 2.0,
            Distribution::Abc(_) => 3.0,
            Distribution::Sgd(_) => 4.0,
        };
        let sharpness = reciprocal(self.alpha * self.alpha);
        let unit = match self.distribution {
            Distribution::Beckmann => LOG2_E,
            Distribution::Ggx | Distribution::Blinn => 1.0,
            Distribution::Abc(shape) | Distribution::Sgd(shape) => shape.alpha() * shape.alpha(),
        };
        let [tangent, bitangent] = match self.distribution {
            Distribution::Abc(shape) => shape.parameters(),
            Distribution::Sgd(shape) => [reciprocal(shape.parameters()[0]), shape.parameters()[1]],
            _ => self.alpha_xy,
        };
        let grazing_cos_sq = (eta - 1.0) * (eta + 1.0) / (eta * eta).max(f64::MIN_POSITIVE);
        let numbers = [
            vec4([sharpness * unit, sharpness * 0.25 * FRAC_1_PI, reciprocal(eta)], grazing_cos_sq),
            [0.0; 4],
            vec4(optical_depth.map(|depth| depth * LOG2_E), 0.0),
            vec4(self.metal_f82_tint.map_or(self.albedo.map(|albedo| albedo * FRAC_1_PI), dark), distribution),
            vec4(self.f0.unwrap_or(self.ior_n), self.film_thickness_nm),
            vec4(
                self.f0.map_or(self.ior_k, |_| self.edge_weights().map(|weight| -1.0 - weight)),
                self.film_thickness_max_nm,
            ),
            vec4(first, 0.0),
            vec4(second, self.critical_cot_sq),
            vec4(third, 0.0),
            vec4([tangent, bitangent, libm::cos(self.rotation)], libm::sin(self.rotation)),
            [whole(kind + parts as usize), self.alpha as f32, eta as f32, self.sigma as f32],
        ];
        let mut words = [[0.0; 4]; LAYER_WORDS];
        words[..numbers.len()].copy_from_slice(&numbers);
        if let Some(rows) = self.reradiation {
            for (word, row) in words[4..7].iter_mut().zip(rows) {
                *word = vec4(row.map(|share| share * FRAC_1_PI), f64::from(word[3]));
            }
            words[8][0] = 1.0;
        }
        for kind in TableKind::ALL {
            if let Some([word, component]) = kind.facts().slot {
                words[word][component] = self.tiles[kind].map_or(-1.0, |tile| tile as f32);
            }
        }
        words
    }
}

/// Reflectances that tints keep.
fn dark(tint: [f64; 3]) -> [f64; 3] {
    tint.map(|tint| 1.0 - tint)
}

/// 1 / value, and 0 for values that are not positive.
fn reciprocal(value: f64) -> f64 {
    if value > 0.0 { 1.0 / value } else { 0.0 }
}

/// A word of the material buffer.
pub(crate) fn vec4([x, y, z]: [f64; 3], w: f64) -> [f32; 4] {
    [x, y, z, w].map(|value| value as f32)
}

/// A whole number below 2^23 as the material buffer has it.
pub(crate) fn whole(n: usize) -> f32 {
    ((1 << 23) + n) as f32
}

#[cfg(test)]
mod tests {
    use luthier_optics::ndf::Shape;

    use super::*;

    fn numbered(kind: LayerKind) -> LayerRecord {
        LayerRecord {
            kind,
            distribution: Distribution::Ggx,
            alpha: 2.0,
            alpha_xy: [30.0, 31.0],
            rotation: 0.0,
            eta: 4.0,
            optical_depth: [3.0, 4.0, 5.0],
            albedo: [6.0, 7.0, 8.0],
            sigma: 9.0,
            reradiation: None,
            ior_n: [10.0, 11.0, 12.0],
            ior_k: [13.0, 14.0, 15.0],
            f0: None,
            f82_tint: None,
            metal_f82_tint: None,
            is_metal: false,
            film_ior_n: [16.0, 17.0, 18.0],
            film_ior_k: [19.0, 20.0, 21.0],
            film_thickness_waves: [22.0, 23.0, 24.0],
            film_thickness_nm: 25.0,
            film_thickness_max_nm: 26.0,
            critical_cot_sq: 35.0,
            masking: Masking::Smith,
            reflectance: Reflectance::Table,
            curve: None,
            internal_reflection: InternalReflection::Facets,
            lower_reflectance: LowerReflectance::InPlace,
            lower_cosine: LowerCosine::Outside,
            lower_facets: LowerFacets::TorranceSparrow,
            lower_alpha: LowerAlpha::Own,
            diffuse_part: DiffusePart::Below,
            tiles: Tiles::default().with([
                (TableKind::Fresnel, Some(27)),
                (TableKind::Distribution, Some(28)),
                (TableKind::Fgd, None),
                (TableKind::Phase, Some(0)),
                (TableKind::Thickness, None),
                (TableKind::Film, Some(33)),
                (TableKind::Escape, Some(34)),
            ]),
        }
    }

    /// The table in the documentation of `words`, filled in by hand.
    #[test]
    fn words_lie_where_the_documentation_says() {
        assert_eq!(
            numbered(LayerKind::Conductor).words(),
            [
                [0.25, 0.019_894_367, 0.25, 0.9375],
                [27.0, 28.0, -1.0, 0.0],
                [4.328_085, 5.770_78, 7.213_475, -1.0],
                [1.909_859_3, 2.228_169_2, 2.546_479, 1.0],
                [10.0, 11.0, 12.0, 25.0],
                [13.0, 14.0, 15.0, 26.0],
                [16.0, 17.0, 18.0, 33.0],
                [19.0, 20.0, 21.0, 35.0],
                [22.0, 23.0, 24.0, 34.0],
                [30.0, 31.0, 1.0, 0.0],
                [8_388_609.0, 2.0, 4.0, 9.0],
            ]
        );
        assert_eq!(numbered(LayerKind::Dielectric).words()[10][0], 8_388_608.0);
        assert_eq!(numbered(LayerKind::Diffuse).words()[10][0], 8_388_610.0);
        let rows = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]];
        let glowing = LayerRecord { reradiation: Some(rows), ..numbered(LayerKind::Diffuse) };
        let plain = numbered(LayerKind::Diffuse).words();
        for (i, (word, plain)) in glowing.words().iter().zip(plain).enumerate() {
            let expected = match i {
                4..=6 => [0, 1, 2, 3].map(|c| if c < 3 { (rows[i - 4][c] * FRAC_1_PI) as f32 } else { plain[c] }),
                8 => [1.0, plain[1], plain[2], plain[3]],
                _ => plain,
            };
            assert_eq!(*word, expected);
        }
        let beckmann = LayerRecord { distribution: Distribution::Beckmann, ..numbered(LayerKind::Diffuse) };
        assert_eq!((beckmann.words()[3][3], beckmann.words()[0][0]), (0.0, 0.360_673_76));
        let blinn = LayerRecord { distribution: Distribution::Blinn, ..numbered(LayerKind::Conductor) };
        assert_eq!((blinn.words()[3][3], blinn.words()[0][0]), (2.0, 0.25));
        let shaped = |shape: Shape, distribution: fn(Shape) -> Distribution| {
            let alpha = shape.alpha();
            LayerRecord {
                distribution: distribution(shape),
                alpha,
                alpha_xy: [alpha; 2],
                ..numbered(LayerKind::Conductor)
            }
            .words()
        };
        let abc = shaped(Shape::abc(100.0, 1.5).unwrap(), Distribution::Abc);
        assert_eq!((abc[3][3], abc[0][0], abc[9]), (3.0, 1.0, [100.0, 1.5, 1.0, 0.0]));
        let sgd = shaped(Shape::sgd(0.125, 0.5).unwrap(), Distribution::Sgd);
        assert_eq!((sgd[3][3], sgd[0][0], sgd[9]), (4.0, 1.0, [8.0, 0.5, 1.0, 0.0]));
        let schlick = LayerRecord { f0: Some([0.25, 0.5, 0.75]), ..numbered(LayerKind::Conductor) };
        assert_eq!(schlick.words()[4..6], [[0.25, 0.5, 0.75, 25.0], [-1.0, -1.0, -1.0, 26.0]]);
        // By hand at an F0 of 1: (1 - t) / (1/7 (6/7)^6) = 17.651385 (1 - t).
        let tinted = LayerRecord { f0: Some([1.0; 3]), f82_tint: Some([1.0, 0.5, 0.0]), ..schlick.clone() };
        let [r, g, b, _] = tinted.words()[5];
        assert!(r == -1.0 && (g + 9.825_692).abs() < 1e-5 && (b + 18.651_385).abs() < 1e-5, "{r} {g} {b}");
        let mixed = LayerRecord { metal_f82_tint: Some([1.0, 0.75, 0.5]), ..schlick.clone() };
        assert_eq!(mixed.words()[3][..3], [0.0, 0.25, 0.5]);
    }

    /// By hand: a metal is 1, Lazanyi's reflectance 3, V-cavities 3, no internal reflection 128, the inner cosine 512, Phong's
    /// lobe 2,048, slope parameters of those above 4,096.
    #[test]
    fn chosen_parts_lie_where_the_documentation_says() {
        let plain = numbered(LayerKind::Conductor);
        let curve = ReflectanceCurve { f0: [0.1, 0.2, 0.3], weight: [1.1, 1.2, 1.3], exponent: [6.1, 6.2, 6.3] };
        let chosen = LayerRecord {
            masking: Masking::VCavity,
            reflectance: Reflectance::Lazanyi,
            curve: Some(curve),
            internal_reflection: InternalReflection::None,
            lower_reflectance: LowerReflectance::InAir,
            lower_cosine: LowerCosine::Inside,
            lower_facets: LowerFacets::Phong,
            lower_alpha: LowerAlpha::AtLeastAbove,
            ..plain.clone()
        };
        let words = chosen.words();
        assert_eq!(words[6..9], [[0.1, 0.2, 0.3, 33.0], [1.1, 1.2, 1.3, 35.0], [6.1, 6.2, 6.3, 34.0]]);
        assert_eq!(words[10][0].to_bits() & 0x7f_ffff, 1 + 4 * 3 + 16 * 3 + 128 + 512 + 1024 * 2 + 4096);
        let json = serde_json::to_value(&chosen).unwrap();
        assert_eq!((&json["masking"], &json["reflectance"]), (&"v-cavity".into(), &"lazanyi".into()));
        assert_eq!(serde_json::from_value::<LayerRecord>(json).unwrap(), chosen);
        let json = serde_json::to_value(plain).unwrap();
        assert!(
            [
                "masking",
                "reflectance",
                "curve",
                "internal_reflection",
                "lower_reflectance",
                "lower_cosine",
                "lower_facets",
                "lower_alpha",
                "diffuse_part"
            ]
            .iter()
            .all(|key| json.get(key).is_none()),
            "{json}"
        );
    }

    /// By hand: an interface beside its base is that of an eta of 1 without absorption, and 128 for no internal reflection.
    #[test]
    fn beside_its_base_an_interface_does_not_bend() {
        let below = LayerRecord { optical_depth: [0.5; 3], ..numbered(LayerKind::Dielectric) };
        let unbent = LayerRecord {
            eta: 1.0,
            optical_depth: [0.0; 3],
            internal_reflection: InternalReflection::None,
            ..below.clone()
        };
        let words = LayerRecord { diffuse_part: DiffusePart::Beside, ..below }.words();
        assert_eq!(words, unbent.words());
        assert_eq!((words[0][2], words[0][3], words[2], words[10][2]), (1.0, 0.0, [0.0, 0.0, 0.0, -1.0], 1.0));
    }

    #[test]
    fn what_has_no_slopes_and_lets_nothing_through_has_zeros() {
        let words = LayerRecord { alpha: 0.0, eta: 0.0, ..numbered(LayerKind::Diffuse) }.words();
        assert_eq!(words[0][..3], [0.0; 3]);
    }

    #[test]
    fn a_film_varies_if_it_gets_thicker() {
        let film = |thickest| LayerRecord {
            film_thickness_nm: 25.0,
            film_thickness_max_nm: thickest,
            ..LayerRecord::default()
        };
        assert_eq!([24.0, 25.0, 26.0].map(|thickest| film(thickest).varies()), [false, false, true]);
    }

    /// From index 1.5 to 1: 30 degrees inside are asin(.75) outside.
    #[test]
    fn rows_of_total_reflection_are_over_the_refracted_cosine() {
        let plain = LayerRecord::default();
        assert_eq!(plain.row_cosine(0.3), 0.3);
        let inside = LayerRecord { critical_cot_sq: 1.25, ..plain };
        let found = inside.row_cosine(libm::sqrt(0.75));
        assert!((found - libm::sqrt(1.0 - 0.75 * 0.75)).abs() < 1e-12, "{found}");
    }
}
