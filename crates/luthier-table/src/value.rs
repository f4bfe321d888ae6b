//! Contents of channels, and the functions behind them.

use luthier_optics::cloth::{ClothRow, ClothVisibility, cloth_albedo};
use luthier_optics::diffuse_albedo::unity_disney_albedo;
use luthier_optics::split_sum::{Masking, SplitSum, SplitSumRow, SplitSumSurface, split_sum};
use luthier_optics::stack::Distribution;

luthier_lut::named! {
    /// Content of one channel.
    pub enum Value("value") {
        /// Factor of f0.
        Scale = "scale",
        /// Summand beside the factor of f0.
        Bias = "bias",
        /// Sum of scale and bias: the albedo for f0 = 1.
        Albedo = "albedo",
        /// 1 less the albedo. It is small where the albedo is near 1, so half floats hold it more closely.
        Loss = "loss",
        /// The albedo of cloth under [`ClothVisibility::Neubelt`]. It exceeds 1 at low alphas and grazing light.
        Cloth = "cloth",
        /// The albedo of cloth under [`ClothVisibility::EstevezKulla`].
        Sheen = "sheen",
        /// The albedo of Disney's diffuse lobe as Unity scales it, less 1/2 ([`unity_disney_albedo`]).
        Disney = "disney",
        /// 0: a channel that the engine keeps for something else.
        Zero = "zero",
        /// 1.
        One = "one",
    }
}

impl Value {
    /// Whether the split sum determines it.
    pub fn is_split_sum(self) -> bool {
        matches!(self, Self::Scale | Self::Bias | Self::Albedo | Self::Loss)
    }

    pub(crate) fn of(self, parts: &Parts) -> f64 {
        match self {
            Self::Scale => parts.sum.scale,
            Self::Bias => parts.sum.bias,
            Self::Albedo => parts.sum.albedo(),
            Self::Loss => 1.0 - parts.sum.albedo(),
            Self::Cloth => parts.cloth,
            Self::Sheen => parts.sheen,
            Self::Disney => parts.disney - 0.5,
            Self::Zero => 0.0,
            Self::One => 1.0,
        }
    }
}

/// The functions that a list of contents needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Needs {
    pub(crate) split_sum: bool,
    cloth: bool,
    sheen: bool,
    disney: bool,
}

impl Needs {
    pub(crate) fn of(values: &[Value]) -> Self {
        Self {
            split_sum: values.iter().any(|value| value.is_split_sum()),
            cloth: values.contains(&Value::Cloth),
            sheen: values.contains(&Value::Sheen),
            disney: values.contains(&Value::Disney),
        }
    }
}

/// Functions at one direction and alpha; unneeded ones are 0.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Parts {
    sum: SplitSum,
    cloth: f64,
    sheen: f64,
    disney: f64,
}

impl From<SplitSum> for Parts {
    fn from(sum: SplitSum) -> Self {
        Self { sum, ..Self::default() }
    }
}

impl Parts {
    /// The functions by quadrature.
    pub(crate) fn exact(needs: Needs, distribution: Distribution, masking: Masking, alpha: f64, cos: f64) -> Self {
        let mut parts = Self::in_passing(needs, alpha, cos);
        if needs.split_sum {
            parts.sum = split_sum(distribution, masking, alpha, cos);
        }
        if needs.cloth {
            parts.cloth = cloth_albedo(ClothVisibility::Neubelt, alpha, cos);
        }
        parts
    }

    /// The functions that have no faster way along a line.
    fn in_passing(needs: Needs, alpha: f64, cos: f64) -> Self {
        let mut parts = Self::default();
        if needs.sheen {
            parts.sheen = cloth_albedo(ClothVisibility::EstevezKulla, alpha, cos);
        }
        if needs.disney {
            parts.disney = unity_disney_albedo(alpha.sqrt(), cos);
        }
        parts
    }
}

/// Functions along a line of one alpha.
pub(crate) struct Line {
    needs: Needs,
    pub(crate) alpha: f64,
    sum: Option<SplitSumRow>,
    cloth: Option<ClothRow>,
}

impl Line {
    pub(crate) fn new(needs: Needs, surface: Option<&SplitSumSurface>, alpha: f64) -> Self {
        let sum = surface.filter(|_| needs.split_sum).map(|surface| surface.row(alpha));
        Self { needs, alpha, sum, cloth: needs.cloth.then(|| ClothRow::new(alpha)) }
    }

    pub(crate) fn at(&self, cos: f64) -> Parts {
        Parts {
            sum: self.sum.as_ref().map_or_else(SplitSum::default, |row| row.at(cos)),
            cloth: self.cloth.as_ref().map_or(0.0, |row| row.at(cos)),
            ..Parts::in_passing(self.needs, self.alpha, cos)
        }
    }
}
