//! Budgets of tables, and the candidates that a search compared.

use luthier_lut::{AtlasLayout, Axis, RowBase, TableKind, TexelFormat};
use serde::{Deserialize, Serialize};

/// Limits on tables; an absent limit does not limit.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Budget {
    /// Largest absolute error of a sampled read, any channel.
    pub max_abs: Option<f64>,
    /// Largest error relative to the brightest channel, or to [`REL_FLOOR`] where that is larger.
    pub max_rel: Option<f64>,
    /// Largest CIEDE2000 difference of reflectances seen under D65.
    pub delta_e: Option<f64>,
    /// Bytes of the texels of all tables together.
    pub max_bytes: Option<u64>,
    /// Estimated cost of one read of every table, see [`Candidate::cost`].
    pub max_cost: Option<f64>,
    /// Largest lobe error of fitted lobes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_lobe_err: Option<f64>,
    /// Largest error of the directional albedo of fitted lobes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_albedo_err: Option<f64>,
}

/// Values below this count as this in relative errors.
pub const REL_FLOOR: f64 = 0.01;

impl Budget {
    /// Whether nothing is limited.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// The limits by the names of their keys.
    pub fn limits(&self) -> [(&'static str, Option<f64>); 7] {
        [
            ("max_abs", self.max_abs),
            ("max_rel", self.max_rel),
            ("delta_e", self.delta_e),
            ("max_bytes", self.max_bytes.map(|bytes| bytes as f64)),
            ("max_cost", self.max_cost),
            ("max_lobe_err", self.max_lobe_err),
            ("max_albedo_err", self.max_albedo_err),
        ]
    }

    /// Whether errors are limited.
    pub fn limits_errors(&self) -> bool {
        self.max_abs.is_some() || self.max_rel.is_some() || self.delta_e.is_some() || self.limits_lobes()
    }

    /// Whether errors of fitted lobes are limited.
    pub fn limits_lobes(&self) -> bool {
        self.max_lobe_err.is_some() || self.max_albedo_err.is_some()
    }

    /// The limits on fitted lobes alone.
    #[must_use]
    pub fn of_lobes(&self) -> Self {
        Self { max_lobe_err: self.max_lobe_err, max_albedo_err: self.max_albedo_err, ..Self::default() }
    }

    /// The limits on texels alone.
    #[must_use]
    pub fn of_texels(&self) -> Self {
        Self { max_lobe_err: None, max_albedo_err: None, ..*self }
    }

    /// The tighter of two budgets, limit by limit.
    #[must_use]
    pub fn tighter(&self, other: &Self) -> Self {
        Self {
            max_abs: least(self.max_abs, other.max_abs),
            max_rel: least(self.max_rel, other.max_rel),
            delta_e: least(self.delta_e, other.delta_e),
            max_bytes: self.max_bytes.into_iter().chain(other.max_bytes).min(),
            max_cost: least(self.max_cost, other.max_cost),
            max_lobe_err: least(self.max_lobe_err, other.max_lobe_err),
            max_albedo_err: least(self.max_albedo_err, other.max_albedo_err),
        }
    }

    /// The largest quotient of an error and its limit: the budget holds if it is at most 1.
    pub fn excess(&self, error: &MeasuredError) -> f64 {
        over_limit(self.max_abs, Some(error.max_abs))
            .max(over_limit(self.max_rel, Some(error.max_rel)))
            .max(over_limit(self.delta_e, error.delta_e))
            .max(over_limit(self.max_lobe_err, error.lobe))
            .max(over_limit(self.max_albedo_err, error.albedo))
    }
}

/// Error over limit; 0 without a limit or without an error.
pub(crate) fn over_limit(limit: Option<f64>, error: Option<f64>) -> f64 {
    limit.zip(error).map_or(0.0, |(limit, error)| error / limit)
}

fn least(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    a.into_iter().chain(b).reduce(f64::min)
}

/// Largest errors of a kind of table, as sampled with 8-bit weights, over all its tiles.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct MeasuredError {
    /// Absolute.
    pub max_abs: f64,
    /// Relative to the brightest channel or [`REL_FLOOR`].
    pub max_rel: f64,
    /// CIEDE2000 under D65; absent where it was not asked for, or where values are no colours.
    pub delta_e: Option<f64>,
    /// Lobe error of fitted lobes against the simulated stack; absent for other tables.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lobe: Option<f64>,
    /// Error of their directional albedo.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub albedo: Option<f64>,
}

impl MeasuredError {
    /// The larger of each error.
    #[must_use]
    pub fn max(&self, other: &Self) -> Self {
        let [delta_e, lobe, albedo] =
            [(self.delta_e, other.delta_e), (self.lobe, other.lobe), (self.albedo, other.albedo)]
                .map(|(a, b)| a.into_iter().chain(b).reduce(f64::max));
        let [max_abs, max_rel] = [self.max_abs.max(other.max_abs), self.max_rel.max(other.max_rel)];
        Self { max_abs, max_rel, delta_e, lobe, albedo }
    }
}

/// A way to get the values of a kind of table at run time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// `table`, or `closed-form`: computed by the shader, no texels.
    pub form: CandidateForm,
    /// Bytes of its texels, all tiles.
    pub bytes: u64,
    /// Estimated cost of one look-up, address arithmetic included: an operation on one number 1, a root, logarithm, exponential,
    /// division or sine 4, a fetch 16 for each 4 bytes of its texel.
    pub cost: f64,
    /// Error as measured by the search.
    pub error: MeasuredError,
}

/// Form of a [`Candidate`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum CandidateForm {
    /// Computed.
    ClosedForm,
    /// Read.
    Table {
        /// Axis across a tile.
        x: Axis,
        /// Axis down a tile.
        y: Option<Axis>,
        /// Texel format.
        format: TexelFormat,
        /// Base that a look-up adds to the texels.
        base: RowBase,
    },
}

impl CandidateForm {
    /// Bytes of so many tiles.
    pub fn bytes(&self, tiles: u32) -> u64 {
        match self {
            Self::ClosedForm => 0,
            Self::Table { x, y, format, base } => {
                let layout = AtlasLayout { x: x.clone(), y: y.clone(), apron: 0, columns: 1, tiles, base: *base };
                let [width, height] = layout.size();
                u64::from(width) * u64::from(height) * u64::from(format.texel_bytes())
            }
        }
    }
}

/// Result of a search for one kind of table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Search {
    /// The kind.
    pub kind: TableKind,
    /// Budget of the kind.
    pub budget: Budget,
    /// The candidate that ships: its place in `front`.
    pub chosen: usize,
    /// Candidates that no other beats in bytes, cost and error at once, cheapest first; and the one that ships.
    pub front: Vec<Candidate>,
    /// Number of candidates that were measured.
    pub measured: u32,
}

#[cfg(test)]
mod tests {
    use luthier_lut::Mapping;

    use super::*;

    #[test]
    fn the_tighter_budget_has_the_smaller_limits() {
        let one = Budget { max_abs: Some(1e-3), max_bytes: Some(100), ..Budget::default() };
        let two = Budget { max_abs: Some(2e-3), max_bytes: Some(50), delta_e: Some(1.0), ..Budget::default() };
        let both = Budget { max_abs: Some(1e-3), max_bytes: Some(50), delta_e: Some(1.0), ..Budget::default() };
        assert_eq!(one.tighter(&two), both);
        assert_eq!(two.tighter(&one), both);
        assert_eq!(one.tighter(&Budget::default()), one);
    }

    #[test]
    fn excess_is_that_of_the_tightest_limit() {
        let budget = Budget { max_abs: Some(1e-3), max_rel: Some(1e-2), ..Budget::default() };
        let error = MeasuredError { max_abs: 5e-4, max_rel: 2e-2, delta_e: Some(9.0), ..MeasuredError::default() };
        assert_eq!(budget.excess(&error), 2.0);
        assert_eq!(Budget::default().excess(&error), 0.0);
    }

    #[test]
    fn excess_counts_each_limit() {
        let error = MeasuredError { max_abs: 0.5, max_rel: 0.25, delta_e: Some(3.0), ..MeasuredError::default() };
        for (budget, expected) in [
            (Budget { max_abs: Some(0.25), ..Budget::default() }, 2.0),
            (Budget { max_rel: Some(0.0625), ..Budget::default() }, 4.0),
            (Budget { delta_e: Some(2.0), ..Budget::default() }, 1.5),
            (Budget { max_bytes: Some(1), max_cost: Some(1e-9), ..Budget::default() }, 0.0),
        ] {
            assert_eq!(budget.excess(&error), expected, "{budget:?}");
            assert_eq!(budget.limits_errors(), expected > 0.0, "{budget:?}");
            assert!(!budget.is_empty(), "{budget:?}");
        }
        assert!(Budget::default().is_empty());
    }

    #[test]
    fn the_larger_of_two_errors_is_so_in_each_measure() {
        let one = MeasuredError { max_abs: 1.0, max_rel: 4.0, delta_e: None, ..MeasuredError::default() };
        let two = MeasuredError { max_abs: 2.0, max_rel: 3.0, delta_e: Some(5.0), ..MeasuredError::default() };
        let both = MeasuredError { max_abs: 2.0, max_rel: 4.0, delta_e: Some(5.0), ..MeasuredError::default() };
        assert_eq!((one.max(&two), two.max(&one), one.max(&one)), (both, both, one));
    }

    /// Rows over Schlick's form begin with three texels of coefficients.
    #[test]
    fn bytes_are_those_of_all_tiles() {
        let axis = |size| Axis {
            quantity: "cos_theta".into(),
            unit: String::new(),
            min: 0.0,
            max: 1.0,
            size,
            mapping: Mapping::Linear,
        };
        let table = |y: Option<u32>, format, base| CandidateForm::Table { x: axis(16), y: y.map(axis), format, base };
        assert_eq!(table(None, TexelFormat::Rgba16Float, RowBase::Zero).bytes(3), 16 * 8 * 3);
        assert_eq!(table(None, TexelFormat::Rgb10a2Unorm, RowBase::Schlick).bytes(2), (16 + 3) * 4 * 2);
        assert_eq!(table(Some(5), TexelFormat::Rg16Float, RowBase::Zero).bytes(2), 16 * 5 * 4 * 2);
        assert_eq!(CandidateForm::ClosedForm.bytes(7), 0);
    }
}
