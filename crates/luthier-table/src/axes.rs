//! Axes of a table: quantity, mapping, position of nodes.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, SQRT_2};
use std::fmt;
use std::str::FromStr;

use luthier_lut::{Axis, Mapping};
use serde::Serialize;
use thiserror::Error;

/// Why a text names no axes.
#[derive(Debug, Error, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum AxesError {
    /// An axis that does not parse.
    #[error(
        "`{0}` is no axis; write [-]QUANTITY[=MIN..MAX][^EXPONENT|@log] with cos_theta, theta, cos_theta_sq, sqrt_cos_theta, sqrt_one_minus_cos_theta, roughness, alpha, alpha_sq, sqrt_roughness, ior, inverse_ior, f0, sqrt_f0, fourth_root_f0, ior_n, ior_k or thickness_nm"
    )]
    Axis(String),
    /// Axes other than one of the direction and at most one of the micro-surface.
    #[error(
        "`{0}`: a table has an axis of the angle and at most one of the roughness, such as \"cos_theta,roughness\""
    )]
    Axes(String),
    /// Axes other than one of the micro-surface, at most one of the direction, and one of the index if the function
    /// depends on it.
    #[error(
        "`{0}`: a table of energy has an axis of the roughness, at most one of the angle, and one of the index for dielectrics, such as \"roughness,cos_theta,ior\""
    )]
    EnergyAxes(String),
    /// Axes other than one of the direction and one of the thickness.
    #[error(
        "`{0}`: a table of a film has an axis of the angle and one of the thickness, such as \"cos_theta,thickness_nm=0..800\""
    )]
    FilmAxes(String),
    /// Axes other than one of the direction, one of the index and one of the absorption index.
    #[error(
        "`{0}`: a table of reflectances has an axis of the angle, ior_n and ior_k, such as \"cos_theta,ior_n=0.05..5,ior_k=0..10\""
    )]
    FresnelAxes(String),
}

/// Quantity of an axis of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Cosine against the normal.
    CosTheta,
    /// The square of the cosine.
    CosThetaSq,
    /// The square root of the cosine.
    SqrtCosTheta,
    /// The square root of one less the cosine: the axis of area-light tables.
    SqrtOneMinusCosTheta,
    /// Angle against the normal, radians.
    Theta,
    /// The artist's roughness, alpha = roughness^2.
    Roughness,
    /// The slope parameter.
    Alpha,
    /// The square of the slope parameter.
    AlphaSq,
    /// The root of the roughness, alpha = its fourth power.
    SqrtRoughness,
    /// The index of the denser side over that of the rarer.
    Ior,
    /// 1 over the index.
    InverseIor,
    /// The reflectance at normal incidence, ((ior - 1)/(ior + 1))^2.
    F0,
    /// The root of the reflectance at normal incidence.
    SqrtF0,
    /// The fourth root of the reflectance at normal incidence.
    FourthRootF0,
    /// Index of refraction of any material, the real part.
    IorN,
    /// Absorption index, the imaginary part.
    IorK,
    /// Thickness of a film.
    ThicknessNm,
}

/// Largest thickness of an axis: beyond, fringes are finer than the steps of the spectral integral.
const THICKNESS_MAX_NM: f64 = 5000.0;

/// Largest index of an axis: f0 is within 4e-6 of 1.
const IOR_MAX: f64 = 1e6;

/// Ends of axes of a complex index: no metal at visible wavelengths lies beyond.
const COMPLEX_N_MIN: f64 = 1e-3;
const COMPLEX_MAX: f64 = 100.0;

impl Quantity {
    /// Quantities of the direction.
    pub const ANGLES: [Self; 5] =
        [Self::CosTheta, Self::Theta, Self::CosThetaSq, Self::SqrtCosTheta, Self::SqrtOneMinusCosTheta];
    /// Quantities of the micro-surface.
    pub const SLOPES: [Self; 4] = [Self::Roughness, Self::Alpha, Self::AlphaSq, Self::SqrtRoughness];

    /// Quantities of the index.
    pub const INDICES: [Self; 5] = [Self::Ior, Self::InverseIor, Self::F0, Self::SqrtF0, Self::FourthRootF0];

    /// Its name in an axis. Names of the half vector's angle may also end in `_h`.
    pub fn name(self) -> &'static str {
        match self {
            Self::CosTheta => "cos_theta",
            Self::CosThetaSq => "cos_theta_sq",
            Self::SqrtCosTheta => "sqrt_cos_theta",
            Self::SqrtOneMinusCosTheta => "sqrt_one_minus_cos_theta",
            Self::Theta => "theta",
            Self::Roughness => "roughness",
            Self::Alpha => "alpha",
            Self::AlphaSq => "alpha_sq",
            Self::SqrtRoughness => "sqrt_roughness",
            Self::Ior => "ior",
            Self::InverseIor => "inverse_ior",
            Self::F0 => "f0",
            Self::SqrtF0 => "sqrt_f0",
            Self::FourthRootF0 => "fourth_root_f0",
            Self::IorN => "ior_n",
            Self::IorK => "ior_k",
            Self::ThicknessNm => "thickness_nm",
        }
    }

    /// Whether it is a quantity of the direction.
    pub fn is_angle(self) -> bool {
        Self::ANGLES.contains(&self)
    }

    /// Whether it is a quantity of the micro-surface.
    pub fn is_slope(self) -> bool {
        Self::SLOPES.contains(&self)
    }

    /// Whether it is a quantity of the index.
    pub fn is_index(self) -> bool {
        Self::INDICES.contains(&self)
    }

    fn from_name(name: &str) -> Option<Self> {
        let name = name.strip_suffix("_h").unwrap_or(name);
        let others = [Self::IorN, Self::IorK, Self::ThicknessNm];
        let mut all = Self::ANGLES.into_iter().chain(Self::SLOPES).chain(Self::INDICES).chain(others);
        all.find(|quantity| quantity.name() == name)
    }

    /// Least and largest value of an axis.
    fn range(self) -> [f64; 2] {
        match self {
            Self::Theta => [0.0, FRAC_PI_2 + 1e-6],
            Self::Ior => [1.0, IOR_MAX],
            Self::InverseIor => [1.0 / IOR_MAX, 1.0],
            Self::IorN => [COMPLEX_N_MIN, COMPLEX_MAX],
            Self::IorK => [0.0, COMPLEX_MAX],
            Self::ThicknessNm => [0.0, THICKNESS_MAX_NM],
            _ => [0.0, 1.0],
        }
    }

    /// The canonical value (theta, alpha, index or thickness) of a value of this quantity.
    fn to_canonical(self, value: f64) -> f64 {
        let value = value.max(0.0);
        match self {
            Self::CosTheta => theta(value),
            Self::CosThetaSq => theta(value.sqrt()),
            Self::SqrtCosTheta => theta(value * value),
            // 1 - cos = 2 sin^2 of the half angle. The arc sine is exact at normal incidence, the arc cosine is not.
            Self::SqrtOneMinusCosTheta => 2.0 * libm::asin((value / SQRT_2).min(FRAC_1_SQRT_2)),
            Self::Theta => value.min(FRAC_PI_2),
            Self::Roughness => value * value,
            Self::Alpha => value,
            Self::AlphaSq => value.sqrt(),
            Self::SqrtRoughness => (value * value) * (value * value),
            Self::Ior => value.max(1.0),
            Self::InverseIor => 1.0 / value.clamp(1.0 / IOR_MAX, 1.0),
            Self::F0 => ior(value.sqrt()),
            Self::SqrtF0 => ior(value),
            Self::FourthRootF0 => ior(value * value),
            Self::IorN | Self::IorK | Self::ThicknessNm => value,
        }
    }

    /// The value of this quantity for a canonical value.
    pub fn of_canonical(self, canonical: f64) -> f64 {
        let sqrt_f0 = ((canonical - 1.0) / (canonical + 1.0)).max(0.0);
        match self {
            Self::CosTheta => libm::cos(canonical),
            Self::CosThetaSq => libm::cos(canonical) * libm::cos(canonical),
            Self::SqrtCosTheta => libm::cos(canonical).max(0.0).sqrt(),
            Self::SqrtOneMinusCosTheta => SQRT_2 * libm::sin(0.5 * canonical),
            Self::Theta => canonical,
            Self::Roughness => canonical.sqrt(),
            Self::Alpha => canonical,
            Self::AlphaSq => canonical * canonical,
            Self::SqrtRoughness => canonical.sqrt().sqrt(),
            Self::Ior => canonical,
            Self::InverseIor => 1.0 / canonical,
            Self::F0 => sqrt_f0 * sqrt_f0,
            Self::SqrtF0 => sqrt_f0,
            Self::FourthRootF0 => sqrt_f0.sqrt(),
            Self::IorN | Self::IorK | Self::ThicknessNm => canonical,
        }
    }
}

/// Positions of the nodes of an axis: the coordinate of texel `i` of `n`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Nodes {
    /// `i / (n - 1)`: the first and the last texel hold both ends of the axis, and a look-up maps 0..1 to their centres.
    Ends,
    /// `(i + offset) / n`, clamped to 0..1. With texel centres (0.5), a look-up reads at the coordinate itself.
    Offset(f64),
}

impl Nodes {
    /// Texel centres.
    pub const CENTRES: Self = Self::Offset(0.5);
    /// Texel centres and ends, and frequent mistakes: half a texel off to either side, and a whole one.
    pub const MISTAKEN: [Self; 6] =
        [Self::CENTRES, Self::Ends, Self::Offset(0.0), Self::Offset(1.0), Self::Offset(1.5), Self::Offset(-0.5)];

    fn coordinate(self, texel: u32, size: u32) -> f64 {
        let (i, n) = (f64::from(texel), f64::from(size));
        match self {
            Self::Ends if size < 2 => 0.5,
            Self::Ends => i / (n - 1.0),
            Self::Offset(offset) => ((i + offset) / n).clamp(0.0, 1.0),
        }
    }

    fn position(self, u: f64, size: u32) -> f64 {
        let n = f64::from(size);
        match self {
            Self::Ends => 0.5 + u * (n - 1.0),
            Self::Offset(offset) => u * n - offset + 0.5,
        }
    }
}

/// One axis of a table, as stated or supposed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisSpec {
    /// Quantity of the axis.
    pub quantity: Quantity,
    /// Value at coordinate 0, before a falling axis is turned around.
    pub min: f64,
    /// Value at coordinate 1.
    pub max: f64,
    /// Mapping from the coordinate to the value.
    pub mapping: Mapping,
    /// Whether values fall from the first texel to the last.
    pub descending: bool,
    /// Positions of its nodes.
    pub nodes: Nodes,
    /// Lowest value. Lower values are evaluated as this one.
    pub floor: f64,
    /// Highest value. Higher values are evaluated as this one.
    pub ceiling: f64,
}

/// The lowest cosine that counts when texels are balanced at grazing angles.
const GRAZING: f64 = 0.01;

impl AxisSpec {
    /// The whole range of a quantity, linear and ascending. Indices end at 3, complex ones run from 0.05 to 5 and from
    /// 0 to 10, films end at 1200 nm.
    pub fn whole(quantity: Quantity, nodes: Nodes) -> Self {
        let (min, max) = match quantity {
            Quantity::Theta => (0.0, FRAC_PI_2),
            Quantity::Ior => (1.0, 3.0),
            Quantity::InverseIor => (1.0 / 3.0, 1.0),
            Quantity::IorN => (0.05, 5.0),
            Quantity::IorK => (0.0, 10.0),
            Quantity::ThicknessNm => (0.0, 1200.0),
            _ => (0.0, 1.0),
        };
        let (floor, ceiling) = (0.0, f64::INFINITY);
        Self { quantity, min, max, mapping: Mapping::Linear, descending: false, nodes, floor, ceiling }
    }

    fn axis(&self) -> Axis {
        let Self { min, max, mapping, .. } = *self;
        Axis { quantity: String::new(), unit: String::new(), min, max, size: 2, mapping }
    }

    pub(crate) fn canonical(&self, texel: u32, size: u32) -> f64 {
        let u = self.nodes.coordinate(texel, size);
        let u = if self.descending { 1.0 - u } else { u };
        self.quantity.to_canonical(self.axis().decode(u).max(self.floor).min(self.ceiling))
    }

    pub(crate) fn position(&self, canonical: f64, size: u32) -> f64 {
        let u = self.coordinate(canonical);
        self.nodes.position(if self.descending { 1.0 - u } else { u }, size)
    }

    /// Canonical value up to which reads return this texel alone. It is the end of the axis at normal incidence or at
    /// the roughest surface, or a cosine of [`GRAZING`]. None unless nodes are texel centres and the texel lies beside
    /// that end.
    pub(crate) fn beyond(&self, texel: u32, size: u32) -> Option<f64> {
        if self.nodes != Nodes::CENTRES || size < 2 {
            return None;
        }
        let rises = !matches!(self.quantity, Quantity::Theta | Quantity::SqrtOneMinusCosTheta);
        let [low, high] = if self.descending == rises { [size - 1, 0] } else { [0, size - 1] };
        let is_coarse = self.quantity.is_angle() && libm::cos(self.canonical(low, size)) > GRAZING;
        if texel == high {
            Some(self.quantity.to_canonical(if rises { self.max } else { self.min }))
        } else {
            (texel == low && is_coarse).then(|| libm::acos(GRAZING))
        }
    }

    /// The value as the axis words it, and the coordinate of a canonical value, ascending or not.
    pub fn coordinate(&self, canonical: f64) -> f64 {
        self.axis().encode(self.quantity.of_canonical(canonical))
    }

    /// Coordinates of two canonical values, the lower coordinate first.
    pub(crate) fn ends(&self, canonical: [f64; 2]) -> [f64; 2] {
        let [a, b] = canonical.map(|value| self.coordinate(value));
        [a.min(b), a.max(b)]
    }

    /// Coordinates from normal incidence down to a cosine; the whole axis of other quantities.
    pub(crate) fn ends_from_cosine(&self, min_cos: f64) -> [f64; 2] {
        if self.quantity.is_angle() { self.ends([0.0, libm::acos(min_cos.clamp(0.0, 1.0))]) } else { [0.0, 1.0] }
    }

    /// Parses axes separated by commas, all with these positions of nodes.
    pub(crate) fn parse_all(text: &str, nodes: Nodes) -> Result<Vec<Self>, AxesError> {
        text.split(',').map(|axis| Ok(Self { nodes, ..axis.parse()? })).collect()
    }

    /// The canonical value at a coordinate, ascending or not.
    pub fn canonical_of_coordinate(&self, u: f64) -> f64 {
        self.quantity.to_canonical(self.axis().decode(u))
    }
}

impl fmt::Display for AxisSpec {
    /// The grammar of [`AxisSpec::from_str`].
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { quantity, min, max, mapping, descending, .. } = *self;
        write!(f, "{}{}", if descending { "-" } else { "" }, quantity.name())?;
        let whole = Self::whole(quantity, self.nodes);
        if (min, max) != (whole.min, whole.max) {
            write!(f, "={min}..{max}")?;
        }
        match mapping {
            Mapping::Power { exponent } => write!(f, "^{exponent}"),
            Mapping::Logarithmic => write!(f, "@log"),
            _ => Ok(()),
        }
    }
}

impl FromStr for AxisSpec {
    type Err = AxesError;

    /// `[-]QUANTITY[=MIN..MAX][^EXPONENT|@log]`: `cos_theta`, `-roughness`, `theta_h=0..1.5707963^8`, `alpha=0.01..1@log`.
    fn from_str(text: &str) -> Result<Self, AxesError> {
        Self::parse(text.trim()).ok_or_else(|| AxesError::Axis(text.to_owned()))
    }
}

fn theta(cos: f64) -> f64 {
    libm::acos(cos.clamp(0.0, 1.0))
}

/// The index of a reflectance at normal incidence, given its root.
fn ior(sqrt_f0: f64) -> f64 {
    (1.0 + sqrt_f0) / (1.0 - sqrt_f0).max(2.0 / IOR_MAX)
}

fn finite(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|value: &f64| value.is_finite())
}

impl AxisSpec {
    fn parse(text: &str) -> Option<Self> {
        let (descending, rest) = text.strip_prefix('-').map_or((false, text), |rest| (true, rest));
        let (rest, mapping) = if let Some((rest, exponent)) = rest.split_once('^') {
            (rest, Mapping::Power { exponent: finite(exponent)? })
        } else if let Some(rest) = rest.strip_suffix("@log") {
            (rest, Mapping::Logarithmic)
        } else {
            (rest, Mapping::Linear)
        };
        let (name, range) = rest.split_once('=').map_or((rest, None), |(name, range)| (name, Some(range)));
        let mut spec = Self::whole(Quantity::from_name(name.trim())?, Nodes::CENTRES);
        if let Some(range) = range {
            let (min, max) = range.split_once("..")?;
            (spec.min, spec.max) = (finite(min)?, finite(max)?);
        }
        (spec.mapping, spec.descending) = (mapping, descending);
        let [least, limit] = spec.quantity.range();
        let exponent_ok = !matches!(mapping, Mapping::Power { exponent } if exponent <= 0.0);
        let range_ok = least <= spec.min && spec.min < spec.max && spec.max <= limit;
        let logarithmic_ok = mapping != Mapping::Logarithmic || spec.min > 0.0;
        (exponent_ok && range_ok && logarithmic_ok).then_some(spec)
    }
}

/// Layout of a table: the axes along its sides.
///
/// ```
/// use luthier_table::{Layout, Nodes};
///
/// let layout = Layout::parse("cos_theta,roughness", Nodes::CENTRES)?;
/// let [theta, alpha] = layout.at_texel([4, 4], [3, 1]);
/// assert!((theta - 0.875_f64.acos()).abs() < 1e-12);
/// assert_eq!(alpha, 0.375 * 0.375); // alpha = roughness^2
/// assert_eq!(layout.to_string(), "cos_theta,roughness");
/// # Ok::<(), luthier_table::AxesError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layout {
    /// The axis of the direction.
    pub angle: AxisSpec,
    /// The axis of the micro-surface; absent in a table of one row or column.
    pub slope: Option<AxisSpec>,
    /// Whether the direction runs down and the micro-surface across.
    pub transposed: bool,
}

impl Layout {
    /// Parses the layout of `--axes`: one or two axes separated by a comma, the one across first.
    ///
    /// # Errors
    /// [`AxesError::Axis`] for an axis that does not parse, [`AxesError::Axes`] unless there is one of the direction and at most one
    /// of the micro-surface.
    pub fn parse(text: &str, nodes: Nodes) -> Result<Self, AxesError> {
        match *AxisSpec::parse_all(text, nodes)?.as_slice() {
            [angle] if angle.quantity.is_angle() => Ok(Self { angle, slope: None, transposed: false }),
            [x, y] if x.quantity.is_angle() && y.quantity.is_slope() => {
                Ok(Self { angle: x, slope: Some(y), transposed: false })
            }
            [x, y] if y.quantity.is_angle() && x.quantity.is_slope() => {
                Ok(Self { angle: y, slope: Some(x), transposed: true })
            }
            _ => Err(AxesError::Axes(text.to_owned())),
        }
    }

    /// Cosines across and alphas down, each from its minimum to 1 by a power of the coordinate.
    pub fn powers(lowest: [f64; 2], [cos, alpha]: [f64; 2], nodes: Nodes) -> Self {
        Self::from_lowest(lowest, [cos, alpha].map(|exponent| Mapping::Power { exponent }), nodes)
    }

    /// Cosines across and alphas down, each from its minimum, above 0, to 1 in equal ratios.
    pub fn logarithms(lowest: [f64; 2], nodes: Nodes) -> Self {
        Self::from_lowest(lowest, [Mapping::Logarithmic; 2], nodes)
    }

    fn from_lowest([min_cos, min_alpha]: [f64; 2], [cos, alpha]: [Mapping; 2], nodes: Nodes) -> Self {
        let angle = AxisSpec { min: min_cos, mapping: cos, ..AxisSpec::whole(Quantity::CosTheta, nodes) };
        let slope = AxisSpec { min: min_alpha, mapping: alpha, ..AxisSpec::whole(Quantity::Alpha, nodes) };
        Self { angle, slope: Some(slope), transposed: false }
    }

    /// The texel at a place along the axis of the direction and a place along the axis of the micro-surface.
    pub(crate) fn texel(&self, along_angle: u32, along_slope: u32) -> [u32; 2] {
        if self.transposed { [along_slope, along_angle] } else { [along_angle, along_slope] }
    }

    /// Theta and alpha at coordinates; alpha is 0 without such an axis.
    pub(crate) fn canonical(&self, u: [f64; 2]) -> [f64; 2] {
        let slope = self.slope.map_or(0.0, |axis| axis.canonical_of_coordinate(u[1]));
        [self.angle.canonical_of_coordinate(u[0]), slope]
    }

    /// Theta and alpha of a texel; alpha is 0 without such an axis.
    pub fn at_texel(&self, size: [u32; 2], texel: [u32; 2]) -> [f64; 2] {
        let [a, s] = self.order();
        let slope = self.slope.map_or(0.0, |axis| axis.canonical(texel[s], size[s]));
        [self.angle.canonical(texel[a], size[a]), slope]
    }

    /// Position, in texels, at which a shader with this layout reads.
    pub fn position(&self, size: [u32; 2], [theta, alpha]: [f64; 2]) -> [f64; 2] {
        let [a, s] = self.order();
        let mut position = [0.5; 2];
        position[a] = self.angle.position(theta, size[a]);
        if let Some(axis) = self.slope {
            position[s] = axis.position(alpha, size[s]);
        }
        position
    }

    /// The image axes of direction and micro-surface.
    pub fn order(&self) -> [usize; 2] {
        if self.transposed { [1, 0] } else { [0, 1] }
    }
}

impl fmt::Display for Layout {
    /// The grammar of [`Layout::parse`].
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.slope {
            Some(slope) if self.transposed => write!(f, "{slope},{}", self.angle),
            Some(slope) => write!(f, "{},{slope}", self.angle),
            None => write!(f, "{}", self.angle),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_parse_as_documented() {
        let axis: AxisSpec = "theta_h=0..1.5707963^8".parse().unwrap();
        assert_eq!((axis.quantity, axis.mapping), (Quantity::Theta, Mapping::Power { exponent: 8.0 }));
        let axis: AxisSpec = "-alpha=0.01..1@log".parse().unwrap();
        assert!(axis.descending && axis.min == 0.01);
        for bad in [
            "",
            "cosine",
            "alpha=1..0",
            "alpha@log",
            "cos_theta=0..2",
            "roughness^0",
            "alpha=nan..1",
            "alpha=0",
            "ior=0.5..2",
        ] {
            assert!(bad.parse::<AxisSpec>().is_err(), "{bad}");
        }
        assert!(Layout::parse("roughness,cos_theta", Nodes::CENTRES).unwrap().transposed);
        for bad in ["roughness", "cos_theta,theta", "cos_theta,alpha,alpha", "cos_theta,ior", "cos_theta,thickness_nm"]
        {
            assert!(Layout::parse(bad, Nodes::CENTRES).is_err(), "{bad}");
        }
    }

    /// A shader reads texel `i` exactly, centre on centre, where it looks for what the layout says is there.
    #[test]
    fn positions_invert_texels() {
        for nodes in [Nodes::CENTRES, Nodes::Ends, Nodes::Offset(0.0)] {
            for text in [
                "cos_theta,roughness",
                "alpha,-theta",
                "-sqrt_cos_theta,alpha_sq",
                "cos_theta_sq^2,sqrt_roughness=0.1..1",
                "roughness,sqrt_one_minus_cos_theta",
            ] {
                let layout = Layout::parse(text, nodes).unwrap();
                assert_eq!(layout.to_string(), text);
                for texel in [[1, 1], [3, 2], [6, 4]] {
                    let [x, y] = layout.position([8, 6], layout.at_texel([8, 6], texel));
                    let off = (x - f64::from(texel[0]) - 0.5).abs().max((y - f64::from(texel[1]) - 0.5).abs());
                    assert!(off < 1e-6, "{text} {nodes:?} {texel:?}: {x} {y}");
                }
            }
        }
    }
}
