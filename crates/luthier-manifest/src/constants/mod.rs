//! Constants of a whole surface, beside its layers.

mod beams;
mod lobes_form;

use std::f64::consts::FRAC_1_PI;

use luthier_model::DiffuseTerm;
use serde::{Deserialize, Serialize};

pub use self::beams::BeamsRecord;
pub use self::lobes_form::LobesForm;
use crate::record::{LayerRecord, vec4};

/// Constants of a whole surface that a shader needs beside its layers; those that a model does not use are zero.
///
/// ```
/// use luthier_manifest::{GlitterRecord, MaterialConstants};
///
/// let glitter = GlitterRecord { seed: 0x0003_0007, frequency: 200.0, filled: 0.1, tilt: 0.0 };
/// let words = MaterialConstants { glitter: Some(glitter), ..MaterialConstants::default() }.words();
/// // Word 9 of the header, the ninth of the constants: the seed in two halves, which floats hold exactly.
/// assert_eq!(words[8][..3], [7.0, 3.0, 200.0]);
/// assert_eq!(words[0], [0.0; 4]);
/// ```
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct MaterialConstants {
    /// Diffuse coefficient of Phong's model, RGB.
    pub phong_diffuse: [f64; 3],
    /// Specular coefficient of Phong's model, RGB.
    pub phong_specular: [f64; 3],
    /// Exponent of Phong's model, about the mirror direction.
    pub phong_exponent: f64,
    /// Cosine-weighted share of the light from a diffuse base that the layers above send back to it, RGB.
    pub internal_reflectance: [f64; 3],
    /// Share of diffuse light that layers keep from below in excess of the share from above: 1 - Ti0/T0i of the statistics; 0 for smooth
    /// layers.
    pub upward_loss: f64,
    /// Lobes, for the model that reads these.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lobes: Option<LobesRecord>,
    /// Numbers of the model `granier-heidrich`, if its material has some of its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub beams: Option<BeamsRecord>,
    /// Light of the diffuse base in the model `microfacet`; left out where it is the default.
    #[serde(default, skip_serializing_if = "is_none")]
    pub diffuse_term: DiffuseTerm,
    /// Flakes in the coat.
    pub flakes: Option<FlakesRecord>,
    /// Patina: the first layer has grown over the others in places.
    pub patina: Option<PatinaRecord>,
    /// A coat whose weight is below 1 or in a map.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coat: Option<CoatRecord>,
    /// A base whose colour looks through the coat as the file says.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub brightening: Option<BrighteningRecord>,
    /// Cells of the surface that glitter.
    pub glitter: Option<GlitterRecord>,
}

fn is_none(term: &DiffuseTerm) -> bool {
    *term == DiffuseTerm::None
}

/// Numbers of the model `lobes` that hold at all views.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LobesRecord {
    /// Relative index of the medium in whose half vectors the lobes are.
    pub index: f64,
    /// Coefficients a and b of the wide remainder, `S = 1 - a (1 - c)^5 - b (1 - c)^2`, not below 0; c is the cosine of the light.
    pub falloff: [f64; 2],
    /// Integral of `S c / pi` over the hemisphere.
    pub integral: f64,
    /// Squared cotangent k of the critical angle: c is then the cosine inside. 0 where there is none.
    pub critical_cot_sq: f64,
    /// Half the width w over which the cosine inside turns at the critical angle, in squared cosines.
    pub critical_width: f64,
    /// Share of `5 cos / (1 + 4 cos)` of the view in the axis of the rows; the rest is the cosine inside.
    pub critical_plain_share: f64,
    /// Number of lobes; rows of a set have as many as the material with the most.
    pub lobes: u32,
    /// 1 over the tail of each of two lobes, as the texels of the rows have it; 0 for a lobe that the first tile lacks. All rows of one tile have
    /// the same. Where there are several tiles, these numbers are of the first, and shaders read the rows.
    pub inverse_tails: [f64; 2],
    /// Where rows have one lobe of one width: its sharpness across the plane of the eye over that along it is `1 + rise sin^2` of the view.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rise: Option<f64>,
    /// Where rows have one short lobe: its other numbers, beside [`Self::rise`] and [`Self::reflectance`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub short: Option<ShortRecord>,
    /// Where the first interface reflects by a polynomial: its f, p and q in `f + u (p + u (q + (1 - f - p - q) u))`, u being the cube of 1 less the cosine of a facet.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reflectance: Option<[f64; 3]>,
    /// Tiles over a factor of a texture, if there are such tiles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub varying: Option<VaryingRecord>,
    /// Axes of an anisotropic stack, with tiles over the azimuth; lobes of others are in the plane of the eye.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axes: Option<AxesRecord>,
    /// Diffuse base below interfaces, whose light rows have: it may have another colour at a place.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub painted: Option<PaintedRecord>,
    /// Errors against the simulated stack at views that no fit saw; absent where nothing was fitted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<LobesError>,
}

/// Numbers of a short lobe. It has the tail of GGX, no remainder is beside it, and rows have its energy and its shift alone.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ShortRecord {
    /// The a, b and c of its sharpness along the plane of the eye, `a + b s + c s^2`, s being the squared sine of the view.
    pub sharpness: [f64; 3],
}

/// Diffuse base below lobes. Rows hold its light for `albedo`. For an albedo R the light is `q(R) / q(albedo)` times as much, with
/// `q(R) = R / (1 - r R)`, where r is the share that the layers send back to the base.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PaintedRecord {
    /// Albedo with which the stack was simulated, RGB.
    pub albedo: [f64; 3],
    /// Integrals of `(1 - c)^5 mu / pi` and `(1 - c)^2 mu / pi` over the hemisphere, mu being the cosine of the light. Present if the base is
    /// Lambertian and rows over a factor have coefficients a and b of their own. The integral of S is 1 less a times the first and b times
    /// the second.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moments: Option<[f64; 2]>,
}

/// Errors of fitted lobes against the simulated stack, the largest of a few views half way between rows, and between the tiles of a factor or
/// of azimuths. The noise of the paths that judge is in them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LobesError {
    /// Lobe error, the largest channel.
    pub lobe: f64,
    /// Lobe error that noise alone makes on average.
    pub lobe_noise: f64,
    /// Absolute error of the directional albedo, the largest channel.
    pub albedo: f64,
    /// Standard error of the albedo that judges.
    pub albedo_noise: f64,
}

/// Tiles of lobes one after the other, over a factor of a texture, at equal steps of the root of the factor. The first tile has the factor 1.
/// The last tile has the factor 0 of a slab, and for slope parameters the factor one step above 0. Shaders mix rows of two tiles linearly in
/// the root. Tiles over a film are at equal steps of the factor itself, between `factors`.
///
/// Over patina, or over the weight of a coat, the last tile has the bare layers and the one before it patina that has grown whole: the place of an amount lies that amount
/// before the last. If scattering, tarnish or another base come with patina, there are three tiles, and the first has all layers without
/// these.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct VaryingRecord {
    /// Factor of the texture.
    pub factor: VaryingFactor,
    /// Number of the tiles.
    pub tiles: u32,
    /// The least factor on slopes: rows have theirs divided by it.
    pub least_spread: f64,
    /// Factors on the nominal thickness of the film at the first tile and at the last.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub factors: Option<[f64; 2]>,
    /// Axes of a family, whose tiles are over slope parameters of single layers in place of one factor.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub family: Option<FamilyRecord>,
}

/// Axes of a family: textures vary slope parameters and colours of a coat, the first interface, and of the base, the lowest one. Tiles over the base follow
/// each other for each node of the coat: tile `coat * base.nodes + base`. Rows hold numbers from which energies follow for the colours of a place
/// (docs/manifest.md), and slopes of lobes over `sqrt(base^2 + 0.09 coat^2)` and `min(1, sqrt(4.84 base^2 + coat^2))` of the slope parameters there.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FamilyRecord {
    /// Slope parameter of the first interface; absent where the base is the first interface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coat: Option<SlopesRecord>,
    /// Slope parameter of the base.
    pub base: SlopesRecord,
    /// Number of the base among the layers.
    pub interface: u32,
    /// Whether the base is metallic in places, whose colours are in closed form. Else rows have energies of the channels.
    pub is_metallic: bool,
    /// Whether that metal has an edge tint, for which rows have two numbers more. Families of bakes from before have other rows, and lack it: they are
    /// refused.
    pub is_tinted: bool,
    /// Whether lobes have another tail than GGX: rows then have their shares above the horizon, as part -1.
    pub has_tail: bool,
    /// Of a base that is metallic in places, the share of the light of a diffuse base that layers send back to it: at slope parameters of 0, and what it grows by over a unit of
    /// the root of that of the coat, and of that of the base. Families of bakes from before have it in rows, and are refused.
    pub sent_back: [f64; 3],
    /// Whether the optical depth of the first slab varies above a base that keeps its colours: rows have lengths of light in it. Absent where not.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub has_lengths: bool,
}

/// Nodes over a range of slope parameters, at equal steps of the root.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SlopesRecord {
    /// Slope parameter of the first node: places with less are held to it.
    pub least: f64,
    /// Slope parameter of the last node.
    pub most: f64,
    /// Number of nodes; 1 where the slope parameter does not vary.
    pub nodes: u32,
}

impl SlopesRecord {
    /// The roots of both ends, and the number of steps in a unit of the root.
    fn words(&self) -> [f64; 3] {
        let [least, most] = [self.least, self.most].map(f64::sqrt);
        let steps = f64::from(self.nodes) - 1.0;
        [least, most, if self.nodes > 1 { steps / (most - least) } else { 0.0 }]
    }
}

impl FamilyRecord {
    /// Whether rows are over both slope parameters: shaders then read two of them.
    pub fn has_two_axes(&self) -> bool {
        self.base.nodes > 1 && self.coat.is_some_and(|coat| coat.nodes > 1)
    }
}

impl VaryingRecord {
    /// Fractional number of the tile of the nominal surface, where all factors are 1. A family has the largest slope parameters in its last tile, and
    /// factors are at most 1.
    pub fn nominal(&self) -> f64 {
        if self.family.is_some() {
            return f64::from(self.tiles) - 1.0;
        }
        let [most, least] = self.factors.unwrap_or([1.0, 0.0]);
        (most - 1.0) / (most - least) * (f64::from(self.tiles) - 1.0)
    }
}

/// Tiles of lobes one after the other, over the azimuth of the eye in the axes of an anisotropic stack.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AxesRecord {
    /// Cosine and sine of the angle from the tangent of the surface to the first axis.
    pub turn: [f64; 2],
    /// Whether the stack is its own mirror image in both axes: tiles then go over a quarter of a circle, else over half a circle, where the
    /// last tile equals the first.
    pub is_mirrored: bool,
    /// Number of the tiles.
    pub tiles: u32,
}

/// A member of `LuthierPlace` over which lobes have tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum VaryingFactor {
    /// Factor on the slope parameters of all interfaces; rows have the slopes of lobes divided by it.
    AlphaFactor,
    /// Factor on the thickness of the first slab.
    SlabFactor,
    /// Factor on the thickness of the film on the first interface.
    FilmFactor,
    /// Amount of patina; see [`VaryingRecord`].
    Patina,
    /// Factor on the weight of a coat, whose tiles are those of an amount of patina: weight and factor make the amount.
    WeightFactor,
    /// Slope parameters and colours of single layers; see [`FamilyRecord`].
    Family,
}

impl LobesRecord {
    /// Number of tiles after the first over the factor on slope parameters, then over the factor on the first slab or film, and the least
    /// factor on slopes. [`Self::beyond_cover`] has the number over patina or a weight.
    fn varying(&self) -> [f64; 3] {
        let Some(VaryingRecord { factor, tiles, least_spread, .. }) = self.varying else {
            return [0.0, 0.0, SPREAD_MIN];
        };
        if let Some(family) = self.family() {
            return family.base.words();
        }
        let beyond = f64::from(tiles) - 1.0;
        match factor {
            VaryingFactor::AlphaFactor => [beyond, 0.0, least_spread],
            VaryingFactor::SlabFactor | VaryingFactor::FilmFactor => [0.0, beyond, SPREAD_MIN],
            VaryingFactor::Patina | VaryingFactor::WeightFactor | VaryingFactor::Family => [0.0, 0.0, SPREAD_MIN],
        }
    }

    /// The axes of a family.
    pub fn family(&self) -> Option<FamilyRecord> {
        self.varying?.family
    }

    /// Number of tiles after the first over the amount of patina or of a coat; 0 without such tiles.
    fn beyond_cover(&self) -> f64 {
        let over = self.varying.filter(|varying| varying.factor.is_cover());
        over.map_or(0.0, |varying| f64::from(varying.tiles) - 1.0)
    }

    /// Numbers of tiles over the azimuth: cosine and sine of the first axis, and tiles after the first in a quarter of a circle. Of tiles over
    /// the film: the place among the tiles per unit of its factor, the place at factor 0, and -1. Of a family: the reciprocal tail of its lobes, the number of the
    /// base among the layers, and by how much the share sent back grows over the root of the slope parameter of the coat. Of tiles over another factor: zeros. Of a single tile: the reciprocal tails, 0 for lobes that it lacks, and 0; with one width the rise in place of the second tail.
    fn sheet(&self) -> [f64; 3] {
        if let Some(family) = self.family() {
            return [self.inverse_tails[0], f64::from(family.interface), family.sent_back[1]];
        }
        if let Some([most, least]) = self.varying.and_then(|varying| varying.factors) {
            return [1.0 / (least - most), most / (most - least), -1.0];
        }
        let Some(AxesRecord { turn: [cos, sin], is_mirrored, tiles }) = self.axes else {
            let [first, second] = self.inverse_tails;
            return if self.varying.is_some() { [0.0; 3] } else { [first, self.rise.unwrap_or(second), 0.0] };
        };
        [cos, sin, (f64::from(tiles) - 1.0) / if is_mirrored { 1.0 } else { 2.0 }]
    }

    /// The number of lobes, with marks of the form of the rows.
    fn form(&self) -> f32 {
        let widths = match (self.rise, self.short) {
            (None, _) => 0,
            (Some(_), None) => ONE_WIDTH,
            (Some(_), Some(_)) => SHORT,
        };
        (self.lobes + widths + self.reflectance.map_or(0, |_| CURVED)) as f32
    }

    /// Numbers of the cosine inside, whose x is `(1 + k) (cos^2 - k / (1 + k))`: the squared cosine `k / (1 + k)` of the critical angle,
    /// `4 w^2 / (1 + k)^2`, and factor and offset for the root to be 0 at the horizon and 1 at the normal.
    fn inside(&self) -> [f64; 4] {
        let scale = 1.0 + self.critical_cot_sq;
        let (cos_sq, width) = (self.critical_cot_sq / scale, self.critical_width / scale);
        let four_width_sq = 4.0 * width * width;
        let [horizon, normal] =
            [-cos_sq, 1.0 - cos_sq].map(|x: f64| (x + (x * x + four_width_sq).sqrt()).max(0.0).sqrt());
        [cos_sq, four_width_sq, 1.0 / (normal - horizon), (0.0 - horizon) / (normal - horizon)]
    }
}

impl VaryingFactor {
    /// Whether it is the share of the surface that the first layer covers.
    pub fn is_cover(self) -> bool {
        matches!(self, Self::Patina | Self::WeightFactor)
    }
}

/// Added to the number of lobes in the words where a coat has a [`CoatRecord::side`].
const OVER_SIDE: f32 = 4.0;

/// Added to that number with a polynomial reflectance, with one width, and with a short lobe.
const CURVED: u32 = 8;
const ONE_WIDTH: u32 = 16;
const SHORT: u32 = 32;

/// Least factor on slopes if tiles are over no such factor.
const SPREAD_MIN: f64 = 1e-3;

/// Flakes, one per cell of a grid or as a normal map has them (Elek 2010, section 4.1).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FlakesRecord {
    /// Seed of the flakes.
    pub seed: u32,
    /// Cells along one repeat; 0 if a normal map has the flakes.
    pub count: u32,
    /// Repeats per unit of texture coordinate.
    pub tiling: f64,
    /// Standard deviation of the flakes' slope angle, radians.
    pub spread: f64,
    /// Weight of the flakes' normal against the surface's.
    pub scale: f64,
    /// Distance from the eye, in scene units, up to which flakes keep their full weight.
    pub fade_start: f64,
}

/// Patina (Elek 2010, section 4.2): its amount is `clamp(1/2 + (extent - map) / (2 transition), 0, 1)`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PatinaRecord {
    /// How far it has developed.
    pub extent: f64,
    /// Softness of its edge; 0 is a step.
    pub transition: f64,
    /// Diffuse albedo that stands for scattering in the patina, RGB.
    pub diffuse_albedo: [f64; 3],
    /// Slope parameter of the layer below where patina has grown; `None` leaves it alone.
    pub base_alpha: Option<f64>,
    /// Factor on the reflection of the layer below where patina has grown, RGB.
    pub tarnish: [f64; 3],
    /// The layer below the first at places without patina, where it meets the medium above the surface.
    pub bare: LayerRecord,
}

/// A coat, or a film, that covers a share of the surface, as patina does that scatters nothing and leaves the layer below as it is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CoatRecord {
    /// Share of the surface that the first layer covers, 0 to 1; maps and places multiply it.
    pub weight: f64,
    /// The layer below the first where the first is not, as it meets the medium above the surface; of a film the first layer without it.
    pub bare: LayerRecord,
    /// The layers below where the first is not, if these have lobes apart from those of all layers: textures vary the surface in more than the weight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub side: Option<SideRecord>,
}

/// The layers below a coat, or the layers without the film on the first, as a surface of their own, see [`MaterialEntry::side`](crate::MaterialEntry::side).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SideRecord {
    /// Lobes; none of a diffuse base alone, and of other models. Their first tile is that of [`CoatRecord::bare`].
    pub lobes: Option<LobesRecord>,
    /// Whether the weight is that of a film: the side has all layers, the first without it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub without_film: bool,
}

/// A `metallic-roughness` surface below a coat that does not darken it: records have a brighter colour than the file, and places have one, too.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BrighteningRecord {
    /// Share of the light of a diffuse base that the coat sends back to it.
    pub diffuse: f64,
    /// Share of the light of a metal.
    pub metal: f64,
    /// Base colour of the file, RGB: that of a place without a map of it.
    pub base_color: [f64; 3],
}

/// Glitter (Weidlich and Wilkie 2009, section 5.2.1): a share of the Voronoi cells of the surface is tilted.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct GlitterRecord {
    /// Seed of the cells.
    pub seed: u32,
    /// Cells per unit of texture coordinate.
    pub frequency: f64,
    /// Share of the cells that glitter, 0..=1.
    pub filled: f64,
    /// Largest tilt of a glittering cell, radians; tilts are uniform in solid angle.
    pub tilt: f64,
}

impl MaterialConstants {
    /// The layer below the first where a patina has not grown or a coat is not.
    pub fn bare(&self) -> Option<&LayerRecord> {
        let of_coat = || self.coat.as_ref().map(|coat| &coat.bare);
        self.patina.as_ref().map(|patina| &patina.bare).or_else(of_coat)
    }

    /// [`Self::bare`], to change.
    pub fn bare_mut(&mut self) -> Option<&mut LayerRecord> {
        let Self { patina, coat, .. } = self;
        patina.as_mut().map(|patina| &mut patina.bare).or_else(|| coat.as_mut().map(|coat| &mut coat.bare))
    }

    /// Number of the header word that is all 0 without flakes.
    pub const FLAKES_WORD: usize = 4;

    /// `vec4` words of the constants in the material buffer.
    pub const WORDS: usize = 10;

    /// The words, in the order that the shader unpacks them.
    ///
    /// | header word | x, y, z, w |
    /// |---|---|
    /// | 1 | Phong's diffuse coefficient RGB, exponent; of lobes tiles beyond the first over `alpha_factor`, those over `slab_factor` or `film_factor`, least factor on slopes, of a family the roots of the least and the most slope parameter of the base and its steps in a unit of the root, share of the cosine of the view in the axis of the rows; of beams the ratio of the slope parameters, the weights of the specular and the diffuse part, number of the lobes' height |
    /// | 2 | Phong's specular coefficient RGB; of lobes k, 4 w^2, and factor and offset of the root that is the cosine inside; of a short lobe its a, b, c and rise, else of a polynomial reflectance its f, p, q and 1 less these; of beams the normal of the inner boundary, 1; of `microfacet` with an added diffuse term 1 in w |
    /// | 3 | internal reflectance RGB, upward loss; of lobes the squared index less 1, a, b, and 1 over pi and the integral of S; of a short lobe the f, p and q of the reflectance after the first; of a family the first and the last of `sent_back` in place of a and of that integral |
    /// | 4 | flakes: low and high 16 bits of the seed, cells, tiling; all 0 without flakes |
    /// | 5 | flakes: spread, scale, fade start; in w of a brightened base the share of the light of a diffuse base that comes back, else 0 |
    /// | 6 | patina: extent, transition, alpha of the base (-1: its own), 1; of a coat with a weight the weight, 0, -1, 2, and of a film with one in other models 3; of lobes over a diffuse base without either the albedo of that base RGB, -2 where rows have a and b, else -1, and of a family -3 |
    /// | 7 | patina: diffuse albedo RGB; of such lobes, and of a family, the two integrals of [`PaintedRecord`], 0; without patina in z of a brightened base the share of a metal; in w the number of lobes, 4 more where a coat has a weight and [`CoatRecord::side`], 8 more with a polynomial reflectance, and 16 more with one width or 32 with a short lobe |
    /// | 8 | patina: tarnish RGB, of lobes over patina tiles beyond the first; of a coat with a weight 1, 1, 1, the same number; of a family as word 1 for the coat, and the nodes over the base, below 0 where that is metallic nowhere |
    /// | 9 | glitter: low and high 16 bits of the seed, frequency, filled; all 0 without glitter |
    /// | 10 | 1 - cos tilt of glitter; of anisotropic lobes cosine and sine of the first axis, and tiles beyond the first in a quarter of a circle; of lobes over a film the share of the tiles per `film_factor`, that at 0, and -1; of a family 1 over the tail of its lobes, number of the base among the layers, the second of `sent_back`; of lobes with one tile 1 over the tail of each, 0; all 0 without |
    pub fn words(&self) -> [[f32; 4]; Self::WORDS] {
        let mut words = [[0.0; 4]; Self::WORDS];
        words[0] = vec4(self.phong_diffuse, self.phong_exponent);
        words[1] = vec4(self.phong_specular, 0.0);
        words[2] = vec4(self.internal_reflectance, self.upward_loss);
        if self.diffuse_term == DiffuseTerm::Added {
            words[1][3] = 1.0;
        }
        if let Some(lobes) = self.lobes {
            let LobesRecord { index, falloff: [a, b], integral, .. } = lobes;
            words[0] = vec4(lobes.varying(), lobes.critical_plain_share);
            words[1] = lobes.inside().map(|x| x as f32);
            words[2] = vec4([(index - 1.0) * (index + 1.0), a, b], FRAC_1_PI / integral);
            words[6][3] = lobes.form();
            if let Some([f, p, q]) = lobes.reflectance {
                // Such materials have no critical angle.
                words[1] = [f, p, q, 1.0 - f - p - q].map(|x| x as f32);
                if let Some(ShortRecord { sharpness }) = lobes.short {
                    // And these no remainder.
                    words[1] = vec4(sharpness, lobes.rise.unwrap_or_default());
                    words[2] = [(index - 1.0) * (index + 1.0), f, p, q].map(|x| x as f32);
                }
            }
        }
        if let Some(beams) = &self.beams {
            words[..2].copy_from_slice(&beams.words());
        }
        if let Some(f) = &self.flakes {
            let [low, high] = [f.seed & 0xffff, f.seed >> 16].map(|bits| bits as f32);
            words[3] = [low, high, f.count as f32, f.tiling as f32];
            words[4] = vec4([f.spread, f.scale, f.fade_start], 0.0);
        }
        let lobes = f64::from(words[6][3]);
        // Models of paths have no lobes: films with a weight are as coats there.
        let weighs_film = |side: &SideRecord| side.without_film && side.lobes.is_none();
        let whole = self.coat.as_ref().and_then(|coat| coat.side);
        let side = whole.filter(|side| !weighs_film(side));
        let cover = self.bare().filter(|_| side.is_none());
        if let (Some(base), None) = (self.lobes.and_then(|lobes| lobes.painted), cover) {
            let [fifth, square] = base.moments.unwrap_or_default();
            words[5] = vec4(base.albedo, if base.moments.is_some() { -2.0 } else { -1.0 });
            words[6] = vec4([fifth, square, 0.0], lobes);
        }
        if let Some(family) = self.lobes.and_then(|lobes| lobes.family()) {
            let nodes = f64::from(family.base.nodes);
            words[5][3] = -3.0;
            let nodes = if family.is_metallic { nodes } else { -nodes };
            words[7] = vec4(family.coat.map_or([0.0; 3], |coat| coat.words()), nodes);
            // Rows have a, from which the integral follows.
            let [least, _, by_base] = family.sent_back.map(|x| x as f32);
            (words[2][1], words[2][3]) = (least, by_base);
        }
        if let Some(base) = self.brightening {
            words[4][3] = base.diffuse as f32;
            words[6][2] = base.metal as f32;
        }
        if let Some(p) = &self.patina {
            words[5] = vec4([p.extent, p.transition, p.base_alpha.unwrap_or(-1.0)], 1.0);
            words[6] = vec4(p.diffuse_albedo, lobes);
            words[7] = vec4(p.tarnish, self.lobes.map_or(0.0, |lobes| lobes.beyond_cover()));
        } else if side.is_some() {
            words[6][3] += OVER_SIDE;
        } else if let Some(coat) = &self.coat {
            words[5] = vec4([coat.weight, 0.0, -1.0], if whole.is_some() { 3.0 } else { 2.0 });
            words[7] = vec4([1.0; 3], self.lobes.map_or(0.0, |lobes| lobes.beyond_cover()));
        }
        if let Some(g) = &self.glitter {
            let [low, high] = [g.seed & 0xffff, g.seed >> 16].map(|bits| bits as f32);
            words[8] = [low, high, g.frequency as f32, g.filled as f32];
            words[9][0] = (1.0 - libm::cos(g.tilt)) as f32;
        }
        let [y, z, w] = self.lobes.map_or([0.0; 3], |lobes| lobes.sheet()).map(|x| x as f32);
        words[9] = [words[9][0], y, z, w];
        words
    }
}

#[cfg(test)]
mod tests {
    use luthier_model::LobeHeight;

    use super::*;

    /// The table in the documentation of `words`, filled in by hand.
    #[test]
    fn words_lie_where_the_documentation_says() {
        let flakes =
            FlakesRecord { seed: 0x0003_0002, count: 4, tiling: 5.0, spread: 6.0, scale: 7.0, fade_start: 8.0 };
        let patina = PatinaRecord {
            extent: 9.0,
            transition: 10.0,
            diffuse_albedo: [11.0, 12.0, 13.0],
            base_alpha: None,
            tarnish: [14.0, 15.0, 16.0],
            bare: LayerRecord::default(),
        };
        let glitter =
            GlitterRecord { seed: 0x0005_0004, frequency: 30.0, filled: 0.25, tilt: std::f64::consts::FRAC_PI_3 };
        let constants = MaterialConstants {
            phong_diffuse: [20.0, 21.0, 22.0],
            phong_specular: [23.0, 24.0, 25.0],
            phong_exponent: 26.0,
            internal_reflectance: [27.0, 28.0, 29.0],
            upward_loss: 30.0,
            lobes: None,
            beams: None,
            diffuse_term: DiffuseTerm::None,
            flakes: Some(flakes),
            patina: Some(patina),
            coat: None,
            brightening: None,
            glitter: Some(glitter),
        };
        assert_eq!(
            constants.words(),
            [
                [20.0, 21.0, 22.0, 26.0],
                [23.0, 24.0, 25.0, 0.0],
                [27.0, 28.0, 29.0, 30.0],
                [2.0, 3.0, 4.0, 5.0],
                [6.0, 7.0, 8.0, 0.0],
                [9.0, 10.0, -1.0, 1.0],
                [11.0, 12.0, 13.0, 0.0],
                [14.0, 15.0, 16.0, 0.0],
                [4.0, 5.0, 30.0, 0.25],
                [0.5, 0.0, 0.0, 0.0],
            ]
        );
        let beams = BeamsRecord {
            inner_alpha_ratio: 0.5,
            specular_weight: 0.75,
            diffuse_weight: 0.25,
            inner_normal: [0.0, 0.6, 0.8],
            lobe_height: LobeHeight::One,
        };
        let of_beams = MaterialConstants { beams: Some(beams), ..constants.clone() }.words();
        assert_eq!(of_beams[..3], [[0.5, 0.75, 0.25, 1.0], [0.0, 0.6, 0.8, 1.0], [27.0, 28.0, 29.0, 30.0]]);
        let added = MaterialConstants { diffuse_term: DiffuseTerm::Added, ..constants.clone() }.words();
        assert_eq!(added[1], [23.0, 24.0, 25.0, 1.0]);
        assert_eq!(MaterialConstants::default().words(), [[0.0; 4]; MaterialConstants::WORDS]);
        let lobes = LobesRecord {
            index: 1.25,
            falloff: [0.5, 0.75],
            integral: FRAC_1_PI,
            critical_cot_sq: 3.0,
            critical_width: 2.0,
            critical_plain_share: 0.25,
            lobes: 2,
            inverse_tails: [2.0, 3.0],
            rise: None,
            short: None,
            reflectance: None,
            varying: None,
            axes: None,
            painted: None,
            error: None,
        };
        let words = |lobes| MaterialConstants { lobes: Some(lobes), ..MaterialConstants::default() }.words();
        let albedo = [0.5, 0.0, 1.0];
        let over = |moments| words(LobesRecord { painted: Some(PaintedRecord { albedo, moments }), ..lobes });
        assert_eq!(over(None)[5..8], [[0.5, 0.0, 1.0, -1.0], [0.0, 0.0, 0.0, 2.0], [0.0; 4]]);
        assert_eq!(over(Some([0.25, 0.125]))[5..8], [[0.5, 0.0, 1.0, -2.0], [0.25, 0.125, 0.0, 2.0], [0.0; 4]]);
        // Roots: of -3/4 + sqrt(9/16 + 1) = 1/2, and of 1/4 + sqrt(1/16 + 1).
        let horizon = f64::sqrt(0.5);
        let range = f64::sqrt(0.25 * (1.0 + f64::sqrt(17.0))) - horizon;
        let inside = [0.75, 1.0, (1.0 / range) as f32, (-horizon / range) as f32];
        assert_eq!(words(lobes)[..3], [[0.0, 0.0, 1e-3, 0.25], inside, [0.5625, 0.5, 0.75, 1.0]]);
        let without = LobesRecord { critical_cot_sq: 0.0, critical_width: 0.0, ..lobes };
        assert_eq!(words(without)[1], [0.0, 0.0, f32::sqrt(0.5), 0.0]);
        assert_eq!(words(lobes)[9], [0.0, 2.0, 3.0, 0.0]);
        let of_curve = LobesRecord { reflectance: Some([0.25, 0.5, 0.125]), ..lobes };
        assert_eq!(words(of_curve)[1..3], [[0.25, 0.5, 0.125, 0.125], [0.5625, 0.5, 0.75, 1.0]]);
        let short = Some(ShortRecord { sharpness: [4.0, 5.0, 6.0] });
        let of_short = words(LobesRecord { short, rise: Some(-0.5), ..of_curve });
        assert_eq!(of_short[1..3], [[4.0, 5.0, 6.0, -0.5], [0.5625, 0.25, 0.5, 0.125]]);
        let over = |factor| {
            let varying = Some(VaryingRecord { factor, tiles: 9, least_spread: 0.5, factors: None, family: None });
            words(LobesRecord { varying, ..lobes })[0]
        };
        let film = VaryingRecord {
            factor: VaryingFactor::FilmFactor,
            tiles: 9,
            least_spread: 1.0,
            factors: Some([1.5, 0.5]),
            family: None,
        };
        let of_film = words(LobesRecord { varying: Some(film), ..lobes });
        assert_eq!([of_film[0], of_film[9]], [[0.0, 8.0, 1e-3, 0.25], [0.0, -1.0, 1.5, -1.0]]);
        assert_eq!(film.nominal(), 4.0);
        assert_eq!(VaryingRecord { factors: None, ..film }.nominal(), 0.0);
        let slopes = |nodes| SlopesRecord { least: 0.25, most: 1.0, nodes };
        let family = FamilyRecord {
            coat: Some(slopes(3)),
            base: slopes(5),
            interface: 1,
            is_metallic: true,
            is_tinted: false,
            has_lengths: false,
            has_tail: false,
            sent_back: [0.625, 0.125, -0.25],
        };
        let of_family = VaryingRecord {
            factor: VaryingFactor::Family,
            tiles: 15,
            least_spread: 1.0,
            factors: None,
            family: Some(family),
        };
        let of_family = words(LobesRecord { varying: Some(of_family), ..lobes });
        assert_eq!([of_family[0], of_family[2]], [[0.5, 1.0, 8.0, 0.25], [0.5625, 0.625, 0.75, -0.25]]);
        assert_eq!([of_family[7], of_family[9]], [[0.5, 1.0, 4.0, 5.0], [0.0, 2.0, 1.0, 0.125]]);
        assert_eq!(over(VaryingFactor::AlphaFactor), [8.0, 0.0, 0.5, 0.25]);
        assert_eq!(over(VaryingFactor::SlabFactor), [0.0, 8.0, 1e-3, 0.25]);
        let over_patina =
            VaryingRecord { factor: VaryingFactor::Patina, tiles: 3, least_spread: 1.0, factors: None, family: None };
        let of_patina = MaterialConstants {
            lobes: Some(LobesRecord { varying: Some(over_patina), ..lobes }),
            patina: constants.patina.clone(),
            ..MaterialConstants::default()
        };
        assert_eq!(of_patina.words()[0], [0.0, 0.0, 1e-3, 0.25]);
        assert_eq!(of_patina.words()[9], [0.0; 4]);
        assert_eq!(of_patina.words()[6], [11.0, 12.0, 13.0, 2.0]);
        assert_eq!(of_patina.words()[7], [14.0, 15.0, 16.0, 2.0]);
        let coat = CoatRecord { weight: 0.75, bare: LayerRecord::default(), side: None };
        let over_weight = VaryingRecord { factor: VaryingFactor::WeightFactor, tiles: 2, ..over_patina };
        let of_coat = MaterialConstants {
            lobes: Some(LobesRecord { varying: Some(over_weight), ..lobes }),
            coat: Some(coat),
            ..MaterialConstants::default()
        };
        assert_eq!(of_coat.words()[5..8], [[0.75, 0.0, -1.0, 2.0], [0.0, 0.0, 0.0, 2.0], [1.0, 1.0, 1.0, 1.0]]);
        assert_eq!(of_coat.words()[0], of_patina.words()[0]);
        // Of a coat over a side of its own all words but one are those of its lobes.
        let painted = Some(PaintedRecord { albedo, moments: None });
        let apart = LobesRecord { painted, ..lobes };
        let film = Some(SideRecord { lobes: None, without_film: true });
        let coat = Some(CoatRecord { weight: 0.75, bare: LayerRecord::default(), side: film });
        let of_film = MaterialConstants { coat, ..MaterialConstants::default() }.words();
        assert_eq!((of_film[5], of_film[6], of_film[7]), ([0.75, 0.0, -1.0, 3.0], [0.0; 4], [1.0, 1.0, 1.0, 0.0]));
        let side = Some(SideRecord { lobes: Some(lobes), without_film: false });
        let coat = Some(CoatRecord { weight: 0.75, bare: LayerRecord::default(), side });
        let of_sides = MaterialConstants { lobes: Some(apart), coat, ..MaterialConstants::default() }.words();
        let mut expected = words(apart);
        expected[6][3] = 6.0;
        assert_eq!(of_sides, expected);
        let brightening = Some(BrighteningRecord { diffuse: 0.5, metal: 0.25, base_color: [1.0; 3] });
        let brightened = MaterialConstants { brightening, ..of_coat }.words();
        assert_eq!([brightened[4], brightened[6]], [[0.0, 0.0, 0.0, 0.5], [0.0, 0.0, 0.25, 2.0]]);
        let around = |is_mirrored| {
            let axes = Some(AxesRecord { turn: [0.6, 0.8], is_mirrored, tiles: 8 });
            words(LobesRecord { axes, ..lobes })[9]
        };
        assert_eq!([true, false].map(around), [[0.0, 0.6, 0.8, 7.0], [0.0, 0.6, 0.8, 3.5]]);
    }

    /// Rows of families from before these fields have other parts, so that reading them would go unseen.
    #[test]
    fn families_of_earlier_rows_are_refused() {
        let earlier = r#"{"base": {"least": 0.1, "most": 0.4, "nodes": 3}, "interface": 1, "is_metallic": true"#;
        let read = |end: &str| serde_json::from_str::<FamilyRecord>(&format!("{earlier}{end}}}"));
        assert!(read("").unwrap_err().to_string().contains("is_tinted"));
        assert!(read(", \"is_tinted\": false").unwrap_err().to_string().contains("has_tail"));
        let later = ", \"is_tinted\": false, \"has_tail\": true";
        assert!(read(later).unwrap_err().to_string().contains("sent_back"));
        assert!(read(&format!("{later}, \"sent_back\": [0.6, 0.0, 0.0]")).unwrap().has_tail);
    }
}
