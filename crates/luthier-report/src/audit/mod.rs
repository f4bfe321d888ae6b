//! The audit of a table of another program. It measures the error of sampled reads against the stated model, and searches for a statement that
//! fits better. [`audit`] tells flips, swaps, shifted nodes, mistaken axes and channels, encodings and masking terms apart: it compares texels with
//! quadrature under every combination of them.
//!
//! Simplifications: a mistake that changes less than the table's noise is not found. Mistakes that cancel are not found either.
//! The search never takes a one-row table for one over both angle and alpha.

mod hypothesis;
mod page;
mod search;
mod stated;
mod truth;

#[cfg(test)]
mod tests;

use luthier_lut::{Comparison, ErrorStats, Image, Scan, WeightBits, bilinear, measure_scan};
use serde::Serialize;
use thiserror::Error;

pub use hypothesis::Mistake;
use hypothesis::{Encoding, Hypothesis};
use luthier_table::Layout;
use search::{Subject, search};
pub use stated::{Stated, StatedError};
use truth::Truth;
pub use truth::{Model, Term};

/// Fraction bits of the sampler's weights.
const WEIGHTS: WeightBits = WeightBits::Fixed(8);
/// Largest root mean square error of a hypothesis that is accepted as the content of a table.
const NO_FIT: f64 = 0.03;

/// Failure to audit a table.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum AuditError {
    /// A channel that the file does not have.
    #[error("there is no channel {channel}: the file has {found}")]
    Channel {
        /// Asked for, from 0.
        channel: usize,
        /// Channels in the file.
        found: u32,
    },
    /// Channels and their meanings differ in number, or a term does not belong to the model.
    #[error("{channels} channels are read and {terms} values are named; name one for each, of: {known}")]
    Terms {
        /// Channels read.
        channels: usize,
        /// Terms named.
        terms: usize,
        /// Terms that the model has.
        known: String,
    },
    /// The number of axes does not suit the model or the size of the table.
    #[error("{0}")]
    Shape(&'static str),
}

/// Statement of the contents and the layout of a table.
///
/// ```
/// use luthier_optics::{microfacet::scaled_distribution, stack::Distribution};
/// use luthier_report::{Model, Statement, Term, audit};
/// # use luthier_table::{Layout, Nodes};
/// let (distribution, mut image) = (Distribution::Ggx, luthier_lut::Image::zeros(32, 32, 1));
/// for (i, texel) in image.data.iter_mut().enumerate() {
///     // Rows run from large to small alpha.
///     let [u, alpha] = [i % 32, 31 - i / 32].map(|k| (k as f64 + 0.5) / 32.0);
///     let (sin, cos) = (u * std::f64::consts::FRAC_PI_2).sin_cos();
///     *texel = scaled_distribution(distribution, alpha, cos, sin * sin) as f32;
/// }
/// let layout = Layout::parse("theta,alpha", Nodes::CENTRES).unwrap();
/// let (channels, terms, step) = (vec![0], vec![Term::ScaledDensity], f64::from(f32::EPSILON));
/// let stated = Statement { model: Model::Density { distribution }, layout, channels, terms, min_cos: 0.01, min_alpha: 0.05, step };
/// assert_eq!(audit(&image, &stated).unwrap().verdict_line(), "fits better as: flipped in y");
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Statement {
    /// The function.
    pub model: Model,
    /// The axes.
    pub layout: Layout,
    /// Channels of the file, from 0.
    pub channels: Vec<usize>,
    /// Term that each of these channels holds.
    pub terms: Vec<Term>,
    /// Lowest cosine that counts.
    pub min_cos: f64,
    /// Lowest alpha that counts.
    pub min_alpha: f64,
    /// Distance of neighbouring values near 1 in the file's format: the size of rounding errors.
    pub step: f64,
}

/// One line of the table of hypotheses.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Candidate {
    /// Differences from the statement; none for the statement itself.
    pub mistakes: Vec<Mistake>,
    /// Root mean square error of texels against quadrature; errors above a quarter count as a quarter.
    pub rms: f64,
}

/// Verdict on a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum AuditVerdict {
    /// No other hypothesis fits better.
    AsStated,
    /// The first candidate fits better than the statement.
    FitsBetterAs,
    /// No hypothesis fits.
    FitsNothing,
}

/// The outcome.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Audit {
    /// Texels across and down.
    pub size: [u32; 2],
    /// Verdict on the table.
    pub verdict: AuditVerdict,
    /// Error as sampled under the statement; places are `cos_theta` and `alpha`.
    pub stated: ErrorStats,
    /// Error as sampled under the best hypothesis, if that is not the statement.
    pub remaining: Option<ErrorStats>,
    /// The best hypotheses, the best first; the statement is among them.
    pub candidates: Vec<Candidate>,
    /// Texel values in the read channels that are not finite.
    pub not_finite: u64,
    /// Texel values in the read channels that are below 0.
    pub negative: u64,
    /// Lowest cosine that counted in the errors.
    pub min_cos: f64,
    /// Lowest alpha.
    pub min_alpha: f64,
}

impl Audit {
    /// Whether the table is as stated and its largest sampled error within a budget.
    pub fn is_within(&self, max_error: f64) -> bool {
        self.verdict == AuditVerdict::AsStated && self.stated.max_abs_err <= max_error && self.not_finite == 0
    }
}

/// Judges a table. Deterministic, whatever the number of threads.
///
/// # Errors
/// [`AuditError`] when the statement does not suit the file.
pub fn audit(image: &Image, statement: &Statement) -> Result<Audit, AuditError> {
    check(image, statement)?;
    Ok(against(image, statement, &Truth::new(&statement.model)))
}

fn against(image: &Image, statement: &Statement, truth: &Truth) -> Audit {
    let stated = Hypothesis {
        layout: statement.layout,
        variant: truth.stated,
        terms: statement.terms.clone(),
        encoding: Encoding::Linear,
        clamped: false,
    };
    // Rounding errors are uniform over a step, whose standard deviation is 1/sqrt(12) of it.
    let rounding = statement.step / 12.0f64.sqrt();
    let subject = Subject { image, channels: &statement.channels, rounding };
    let fits = search(&subject, &stated, truth);
    let best = &fits[0];
    let verdict = if best.rms > NO_FIT {
        AuditVerdict::FitsNothing
    } else if best.hypothesis == stated {
        AuditVerdict::AsStated
    } else {
        AuditVerdict::FitsBetterAs
    };
    let values = || image.texels().flat_map(|texel| statement.channels.iter().map(|&c| texel[c]));
    Audit {
        size: [image.width, image.height],
        verdict,
        stated: sampled(&subject, statement, truth, &stated),
        remaining: (verdict == AuditVerdict::FitsBetterAs)
            .then(|| sampled(&subject, statement, truth, &best.hypothesis)),
        candidates: fits
            .iter()
            .map(|fit| Candidate { mistakes: fit.hypothesis.mistakes(&stated, truth), rms: fit.rms })
            .collect(),
        not_finite: values().filter(|v| !v.is_finite()).count() as u64,
        negative: values().filter(|v| *v < 0.0).count() as u64,
        min_cos: statement.min_cos,
        min_alpha: statement.min_alpha,
    }
}

fn check(image: &Image, statement: &Statement) -> Result<(), AuditError> {
    let Statement { model, layout, channels, terms, .. } = statement;
    if let Some(&channel) = channels.iter().find(|&&c| c >= image.channels as usize) {
        return Err(AuditError::Channel { channel, found: image.channels });
    }
    if channels.is_empty() || channels.len() != terms.len() || terms.iter().any(|term| !model.terms().contains(term)) {
        let known = model.terms().iter().map(|t| t.name()).collect::<Vec<_>>().join(", ");
        return Err(AuditError::Terms { channels: channels.len(), terms: terms.len(), known });
    }
    let long = [image.width, image.height].iter().filter(|side| **side > 1).count();
    match (layout.slope.is_some(), model.has_slope()) {
        (true, false) => {
            Err(AuditError::Shape("a smooth interface has no axis of roughness: name the angle alone in --axes"))
        }
        (false, true) => {
            Err(AuditError::Shape("this model needs an axis of roughness or alpha beside the angle in --axes"))
        }
        (true, true) if long < 2 => Err(AuditError::Shape("a table over two axes has at least two texels along both")),
        (false, false) if image.width < 2 => {
            Err(AuditError::Shape("a table over the angle alone has at least two texels across"))
        }
        _ => Ok(()),
    }
}

/// The error of reads through a sampler. [`measure_scan`] reads at points off the nodes and at the ends of the axes, and climbs to the worst.
fn sampled(subject: &Subject, statement: &Statement, truth: &Truth, h: &Hypothesis) -> ErrorStats {
    // The scan runs over the coordinates of the statement for every hypothesis, so that all are compared at the same places.
    let (angle, slope) = (statement.layout.angle, statement.layout.slope);
    let (points, refinements) = truth.scan();
    let ends = |a: f64, b: f64| (a.min(b), a.max(b));
    let (from, to) = ends(angle.coordinate(0.0), angle.coordinate(libm::acos(statement.min_cos.clamp(0.0, 1.0))));
    let mut scan =
        Scan { points: [points * points, 1], from: [from, 0.5], to: [to, 0.5], nodes: [points, 0], refinements };
    if let Some(slope) = slope {
        let (from, to) = ends(slope.coordinate(statement.min_alpha), slope.coordinate(1.0));
        (scan.points, scan.nodes, scan.from[1], scan.to[1]) = ([points; 2], [points; 2], from, to);
    }
    let canonical = |u: [f64; 2]| {
        [angle.canonical_of_coordinate(u[0]), slope.map_or(0.0, |slope| slope.canonical_of_coordinate(u[1]))]
    };
    let size = [subject.image.width, subject.image.height];
    let compare = |u: [f64; 2]| {
        let at = canonical(u);
        let texel = bilinear(subject.image, h.layout.position(size, at), WEIGHTS);
        let components = truth.exact(h.variant, at);
        let mut result = Comparison { expected: [0.0; 4], sampled: [0.0; 4] };
        for (c, &channel) in subject.channels.iter().enumerate().take(4) {
            result.expected[c] = h.terms[c].of(components);
            result.sampled[c] = h.comparable(c, texel[channel], at[1]);
        }
        result
    };
    let axis_values = |u: [f64; 2]| {
        let [theta, alpha] = canonical(u);
        if slope.is_some() { vec![libm::cos(theta), alpha] } else { vec![libm::cos(theta)] }
    };
    measure_scan(&scan, compare, axis_values)
}
