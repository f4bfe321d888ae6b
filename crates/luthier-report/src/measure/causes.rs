//! Causes of an error: the factors of a model, each read from the tables while all others are exact.

use std::cell::RefCell;

use glam::DVec3;
use luthier_layers::models::lobes::Below;
use luthier_layers::models::shade::ShaderTerms;
use luthier_layers::models::statistics::diffuse_base::Veil;
use luthier_layers::models::statistics::energy::Energy;
use luthier_layers::terms::Terms;
use luthier_layers::twins::real_time::Twin;
use luthier_layers::twins::terms::Exact;
use luthier_lut::TableKind;
use luthier_optics::Rgb;
use luthier_optics::stack::Distribution;
use serde::{Deserialize, Serialize};

use crate::measure::directions::{Pair, wide};
use crate::measure::statistics::{FLOOR, TARGET_MAX_REL_ERR, WorstPair, brightest, relative_error};
use crate::measure::table_terms::TableTerms;
use crate::text::format::{number, number_deg, rounded, theta_deg, value};

/// A factor of the model that errs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Factor {
    /// A Fresnel row, or a film tile.
    Fresnel,
    /// A distribution tile.
    Distribution,
    /// A phase row.
    Phase,
    /// A tile of the albedo table.
    Fgd,
    /// A tile of the escape table.
    Escape,
    /// The material's record of the layers above a diffuse base.
    Veil,
    /// The rows of lobes.
    Lobes,
    /// f32 arithmetic: the difference between the device and f64 on the same tables.
    Arithmetic,
}

impl Factor {
    /// All factors.
    pub(crate) const ALL: [Self; 8] = [
        Self::Fresnel,
        Self::Distribution,
        Self::Phase,
        Self::Fgd,
        Self::Escape,
        Self::Veil,
        Self::Lobes,
        Self::Arithmetic,
    ];

    /// The name in reports.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Fresnel => "Fresnel",
            Self::Distribution => "distribution",
            Self::Phase => "phase",
            Self::Fgd => "albedo",
            Self::Escape => "escape",
            Self::Veil => "internal reflectance",
            Self::Lobes => "rows of lobes",
            Self::Arithmetic => "arithmetic",
        }
    }
}

/// Part of an error that one factor causes, measured with all other factors exact.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// Signed change of the worst channel, relative to max(brightest channel of the reference, [`FLOOR`]).
    pub rel_err: f64,
    /// Cause of the change.
    pub cause: Cause,
}

/// A factor, with the place in its table that was read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Cause {
    /// A Fresnel row, or a film tile.
    Fresnel {
        /// Layer, from 0.
        layer: u32,
        /// Name of the row.
        tile: String,
        /// Cosine of the look-up.
        cos_theta_d: f64,
        /// Reflectance there, in the channel of the worst pair.
        expected: f64,
        /// Value that the row gives.
        sampled: f64,
    },
    /// A distribution tile.
    Distribution {
        /// Layer, from 0.
        layer: u32,
        /// Name of the tile.
        tile: String,
        /// Slope parameter of the look-up.
        alpha: f64,
        /// Angle of the half vector, degrees.
        theta_h_deg: f64,
        /// `pi alpha^2 D` there.
        expected: f64,
        /// Value that the tile gives.
        sampled: f64,
    },
    /// A phase row, in the channel of the worst pair.
    Phase {
        /// Layer, from 0.
        layer: u32,
        /// Sum of the cosines in the film.
        cosines: f64,
    },
    /// A tile of the albedo table.
    Fgd {
        /// Layer, from 0.
        layer: u32,
        /// Name of the tile.
        tile: String,
        /// Slope parameter of the look-up.
        alpha: f64,
        /// Cosine of the look-up.
        cos_theta: f64,
        /// Share of the light that the interface sends back there, in the channel of the worst pair.
        expected: f64,
        /// Value that the tile gives.
        sampled: f64,
    },
    /// A tile of the escape table.
    Escape {
        /// Layer, from 0.
        layer: u32,
        /// Name of the tile.
        tile: String,
        /// Slope parameter of the look-up.
        alpha: f64,
        /// Cosine of the look-up, in the medium below the layer.
        cos_theta: f64,
        /// Share of the lobe that is not totally reflected.
        expected: f64,
        /// Value that the tile gives.
        sampled: f64,
    },
    /// The material's record of the layers above a diffuse base.
    Veil {
        /// Internal reflectance, in the channel of the worst pair.
        expected: f64,
        /// Value that the record gives.
        sampled: f64,
    },
    /// The rows of lobes.
    Lobes {
        /// Name of the tile.
        tile: String,
        /// Cosine of the view.
        cos_theta: f64,
    },
    /// f32 arithmetic.
    Arithmetic,
}

impl Cause {
    /// The factor, without the place.
    pub fn factor(&self) -> Factor {
        match self {
            Self::Fresnel { .. } => Factor::Fresnel,
            Self::Distribution { .. } => Factor::Distribution,
            Self::Phase { .. } => Factor::Phase,
            Self::Fgd { .. } => Factor::Fgd,
            Self::Escape { .. } => Factor::Escape,
            Self::Veil { .. } => Factor::Veil,
            Self::Lobes { .. } => Factor::Lobes,
            Self::Arithmetic => Factor::Arithmetic,
        }
    }

    /// The cause in words, with the error of the table at the place.
    pub(crate) fn words(&self) -> String {
        match self {
            Self::Fresnel { tile, cos_theta_d, expected, sampled, .. } => {
                format!(
                    "reflectance tile {tile} at cos θ {}: {}",
                    number(rounded(*cos_theta_d, 3)),
                    off(*expected, *sampled)
                )
            }
            Self::Distribution { tile, alpha, theta_h_deg, expected, sampled, .. } => format!(
                "distribution table {tile} at α {}, θₕ {}°: {}",
                number(rounded(*alpha, 3)),
                number_deg(*theta_h_deg),
                off(*expected, *sampled)
            ),
            Self::Phase { layer, cosines } => {
                format!("phase row of layer {layer} at a sum of cosines of {}", number(rounded(*cosines, 3)))
            }
            Self::Fgd { tile, alpha, cos_theta, expected, sampled, .. } => format!(
                "albedo table {tile} at α {}, cos θ {}: {}",
                number(rounded(*alpha, 3)),
                number(rounded(*cos_theta, 3)),
                off(*expected, *sampled)
            ),
            Self::Escape { tile, alpha, cos_theta, expected, sampled, .. } => format!(
                "escape table {tile} at α {}, cos θ {}: {}",
                number(rounded(*alpha, 3)),
                number(rounded(*cos_theta, 3)),
                off(*expected, *sampled)
            ),
            Self::Veil { expected, sampled } => format!("internal reflectance: {}", off(*expected, *sampled)),
            Self::Lobes { tile, cos_theta } => {
                format!("rows of lobes {tile} at cos θ {}", number(rounded(*cos_theta, 3)))
            }
            Self::Arithmetic => "f32 arithmetic".to_owned(),
        }
    }
}

/// A pair that misses the target, with its worst channel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Miss {
    pair: Pair,
    channel: usize,
    found: f64,
    expected: f64,
    /// Divisor of errors.
    scale: f64,
}

impl Miss {
    /// All pairs with a finite sample that misses the target.
    pub(crate) fn among(pairs: &[Pair], found: &[Rgb], expected: &[Rgb]) -> Vec<Self> {
        let misses = pairs.iter().zip(found).zip(expected).filter_map(|((&pair, found), expected)| {
            let bright = brightest(expected);
            let mut worst: Option<(usize, f64)> = None;
            for channel in 0..3 {
                let error = relative_error(found[channel], expected[channel], bright, FLOOR);
                if error.is_finite() && worst.is_none_or(|(_, w)| error > w) {
                    worst = Some((channel, error));
                }
            }
            let (channel, error) = worst?;
            let (found, expected, scale) = (found[channel], expected[channel], bright.max(FLOOR));
            (error > TARGET_MAX_REL_ERR).then_some(Self { pair, channel, found, expected, scale })
        });
        misses.collect()
    }

    /// A pair and a channel of it, whether it misses or not.
    pub(crate) fn at(pair: Pair, channel: usize, found: &Rgb, expected: &Rgb) -> Self {
        Self {
            pair,
            channel,
            found: found[channel],
            expected: expected[channel],
            scale: brightest(expected).max(FLOOR),
        }
    }

    pub(crate) fn of(pair: &WorstPair, misses: &[Self]) -> Option<Self> {
        misses.iter().find(|m| m.pair == (pair.wi, pair.wo)).copied()
    }

    /// The larger angle to the normal, degrees.
    pub(crate) fn angle_deg(&self) -> f64 {
        theta_deg(self.pair.0).max(theta_deg(self.pair.1))
    }
}

/// Terms of a model, exact and from tables, by which an error is split into parts.
pub(crate) struct Factors<'a> {
    pub(crate) twin: &'a Twin,
    pub(crate) exact: &'a Exact,
    /// The tables as the shader reads them; `None` for a shader without tables.
    pub(crate) tables: Option<&'a TableTerms<'a>>,
    /// Whether the values come from a device, so that f32 arithmetic can be a cause.
    pub(crate) on_device: bool,
}

/// A sampled value, the expected value and their relative difference, in words.
fn off(expected: f64, sampled: f64) -> String {
    let percent = 100.0 * (sampled - expected) / expected.abs();
    let sign = if percent < 0.0 { "−" } else { "+" };
    let relative = if percent.is_finite() {
        format!(" ({sign}{}\u{a0}%)", number(rounded(percent.abs(), 2)))
    } else {
        String::new()
    };
    format!("{} for {}{relative}", value(sampled), value(expected))
}

impl Factors<'_> {
    /// The parts of an error, largest first. For each factor of each layer, the model is evaluated with this factor from the tables and all others
    /// exact. f32 arithmetic is the device against f64 on the same tables. Second-order terms, products of two errors, belong to no part.
    pub(crate) fn parts(&self, miss: &Miss) -> Vec<Part> {
        let [wi, wo] = [miss.pair.0, miss.pair.1].map(wide);
        let mut parts = Vec::new();
        let mut without_arithmetic = miss.expected;
        if let Some(tables) = self.tables {
            let recorder = Mixed::new(self.exact, tables, None);
            self.twin.eval(&recorder, wi, wo);
            let mut seen = Vec::new();
            for read in recorder.reads.into_inner() {
                let part = (read.layer, read.factor());
                if seen.contains(&part) {
                    continue;
                }
                seen.push(part);
                let mixed = Mixed::new(self.exact, tables, Some(part));
                let value = self.twin.eval(&mixed, wi, wo)[miss.channel];
                let rel_err = (value - miss.expected) / miss.scale;
                parts.push(Part { rel_err, cause: read.cause(tables, miss.channel) });
            }
            without_arithmetic = self.twin.eval(tables, wi, wo)[miss.channel];
        }
        if self.on_device {
            let rel_err = (miss.found - without_arithmetic) / miss.scale;
            parts.push(Part { rel_err, cause: Cause::Arithmetic });
        }
        parts.retain(|part| part.rel_err.is_finite());
        parts.sort_by(|a, b| b.rel_err.abs().total_cmp(&a.rel_err.abs()));
        parts
    }
}

/// Exact terms, except for one factor of one layer, which comes from the tables. It records every read.
struct Mixed<'a> {
    exact: &'a Exact,
    tables: &'a TableTerms<'a>,
    from_tables: Option<(usize, Factor)>,
    reads: RefCell<Vec<Read>>,
}

/// A term that the model read.
struct Read {
    layer: usize,
    term: Term,
}

enum Term {
    Fresnel { cos_theta_d: f64, expected: Rgb, sampled: Rgb },
    Distribution { alpha: f64, theta_h: f64, expected: f64, sampled: f64 },
    Phase { cosines: f64 },
    Fgd { alpha: f64, cos_theta: f64, expected: Rgb, sampled: Rgb },
    Escape { alpha: f64, cos_theta: f64, expected: f64, sampled: f64 },
    Veil { expected: Rgb, sampled: Rgb },
    Lobes { cos_theta: f64 },
}

impl<'a> Mixed<'a> {
    fn new(exact: &'a Exact, tables: &'a TableTerms<'a>, from_tables: Option<(usize, Factor)>) -> Self {
        Self { exact, tables, from_tables, reads: RefCell::new(Vec::new()) }
    }

    fn record<T>(&self, layer: usize, term: Term, expected: T, sampled: T) -> T {
        let read = Read { layer, term };
        let chosen = self.from_tables == Some((layer, read.factor()));
        self.reads.borrow_mut().push(read);
        if chosen { sampled } else { expected }
    }
}

impl Terms for Mixed<'_> {
    fn fresnel(&self, layer: usize, cos_theta_d: f64) -> Rgb {
        let [expected, sampled] = [self.exact.fresnel(layer, cos_theta_d), self.tables.fresnel(layer, cos_theta_d)];
        self.record(layer, Term::Fresnel { cos_theta_d, expected, sampled }, expected, sampled)
    }

    fn distribution(
        &self,
        layer: usize,
        distribution: Distribution,
        alpha: f64,
        cos_theta_h: f64,
        sin_theta_h_sq: f64,
    ) -> f64 {
        let expected = self.exact.distribution(layer, distribution, alpha, cos_theta_h, sin_theta_h_sq);
        let sampled = self.tables.distribution(layer, distribution, alpha, cos_theta_h, sin_theta_h_sq);
        let theta_h = libm::atan2(sin_theta_h_sq.sqrt(), cos_theta_h);
        let term = Term::Distribution { alpha, theta_h, expected, sampled };
        self.record(layer, term, expected, sampled)
    }

    /// `None` lets the model compute the exact value.
    fn interference(&self, layer: usize, channel: usize, cosines: f64) -> Option<f64> {
        let sampled = self.tables.interference(layer, channel, cosines)?;
        self.record(layer, Term::Phase { cosines }, None, Some(sampled))
    }
}

impl Energy<3> for Mixed<'_> {
    fn fgd(&self, layer: usize, cos_theta: f64, alpha: f64) -> Rgb {
        let [expected, sampled] = [self.exact.fgd(layer, cos_theta, alpha), self.tables.fgd(layer, cos_theta, alpha)];
        self.record(layer, Term::Fgd { alpha, cos_theta, expected, sampled }, expected, sampled)
    }

    fn escaping(&self, layer: usize, cos_theta: f64, alpha: f64, eta: f64) -> f64 {
        let expected = self.exact.escaping(layer, cos_theta, alpha, eta);
        let sampled = self.tables.escaping(layer, cos_theta, alpha, eta);
        self.record(layer, Term::Escape { alpha, cos_theta, expected, sampled }, expected, sampled)
    }
}

impl ShaderTerms for Mixed<'_> {
    fn veil(&self) -> Veil<3> {
        let [expected, sampled] = [self.exact.veil(), self.tables.veil()];
        let term = Term::Veil { expected: expected.internal, sampled: sampled.internal };
        self.record(0, term, expected, sampled)
    }

    fn below(&self, wo: DVec3) -> Option<Below> {
        let [expected, sampled] = [self.exact.below(wo), self.tables.below(wo)];
        self.record(0, Term::Lobes { cos_theta: wo.z }, expected, sampled)
    }

    /// Reads of the layers below a coat with a weight are no parts: they have records of their own.
    fn bare(&self) -> Option<&dyn ShaderTerms> {
        self.exact.bare()
    }
}

impl Read {
    fn factor(&self) -> Factor {
        match self.term {
            Term::Fresnel { .. } => Factor::Fresnel,
            Term::Distribution { .. } => Factor::Distribution,
            Term::Phase { .. } => Factor::Phase,
            Term::Fgd { .. } => Factor::Fgd,
            Term::Escape { .. } => Factor::Escape,
            Term::Veil { .. } => Factor::Veil,
            Term::Lobes { .. } => Factor::Lobes,
        }
    }

    fn cause(&self, tables: &TableTerms<'_>, channel: usize) -> Cause {
        let layer = self.layer as u32;
        match self.term {
            Term::Fresnel { cos_theta_d, expected, sampled } => Cause::Fresnel {
                layer,
                tile: tables.fresnel_name(self.layer).to_owned(),
                cos_theta_d,
                expected: expected[channel],
                sampled: sampled[channel],
            },
            Term::Distribution { alpha, theta_h, expected, sampled } => Cause::Distribution {
                layer,
                tile: tables.name(TableKind::Distribution, self.layer).to_owned(),
                alpha,
                theta_h_deg: theta_h.to_degrees(),
                expected,
                sampled,
            },
            Term::Phase { cosines } => Cause::Phase { layer, cosines },
            Term::Fgd { alpha, cos_theta, expected, sampled } => Cause::Fgd {
                layer,
                tile: tables.name(TableKind::Fgd, self.layer).to_owned(),
                alpha,
                cos_theta,
                expected: expected[channel],
                sampled: sampled[channel],
            },
            Term::Escape { alpha, cos_theta, expected, sampled } => {
                let tile = tables.name(TableKind::Escape, self.layer).to_owned();
                Cause::Escape { layer, tile, alpha, cos_theta, expected, sampled }
            }
            Term::Veil { expected, sampled } => Cause::Veil { expected: expected[channel], sampled: sampled[channel] },
            Term::Lobes { cos_theta } => {
                Cause::Lobes { tile: tables.name(TableKind::Lobes, self.layer).to_owned(), cos_theta }
            }
        }
    }
}
