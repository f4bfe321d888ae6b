//! Exact values of the functions that audited tables are said to hold.

use std::f64::consts::PI;

use luthier_optics::Rgb;
use luthier_optics::albedo::{Effort, FacetStatistics, ReflectanceCurves};
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::interpolation::cubic_stencil;
use luthier_optics::microfacet::scaled_distribution;
use luthier_optics::schlick::schlick;
use luthier_optics::split_sum::{Masking, split_sum, split_sums};
use luthier_optics::stack::Distribution;
use rayon::prelude::*;

/// Function that a table is said to hold.
#[derive(Debug, Clone, PartialEq)]
pub enum Model {
    /// The split sum of image-based lighting: scale, bias, or albedo under Schlick's Fresnel.
    SplitSum {
        /// Slope distribution.
        distribution: Distribution,
        /// Masking term.
        masking: Masking,
    },
    /// A slope distribution over the angle of the half vector.
    Density {
        /// Slope distribution.
        distribution: Distribution,
    },
    /// Reflectance of a smooth interface over the cosine, RGB under D65.
    Reflectance {
        /// The interface.
        interface: Interface,
    },
    /// Directional albedo of a rough interface with all bounces between its facets that do not cross it, RGB under D65.
    Albedo {
        /// Slope distribution.
        distribution: Distribution,
        /// The interface.
        interface: Interface,
    },
}

/// Term that one channel of a table is said to hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Term {
    /// Factor of f0.
    Scale,
    /// Summand beside the factor of f0.
    Bias,
    /// Sum of scale and bias.
    Albedo,
    /// Linear Rec.709.
    Red,
    /// Linear Rec.709.
    Green,
    /// Linear Rec.709.
    Blue,
    /// pi alpha^2 D.
    ScaledDensity,
    /// D, 1/sr.
    Density,
}

impl Term {
    /// Names, for the command line.
    pub const NAMES: [(Self, &'static str); 8] = [
        (Self::Scale, "scale"),
        (Self::Bias, "bias"),
        (Self::Albedo, "albedo"),
        (Self::Red, "red"),
        (Self::Green, "green"),
        (Self::Blue, "blue"),
        (Self::ScaledDensity, "scaled-d"),
        (Self::Density, "d"),
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(term, _)| *term == self).map_or("", |(_, name)| name)
    }

    /// The value of a channel from the components of a model.
    pub(super) fn of(self, components: [f64; 3]) -> f64 {
        match self {
            Self::Scale | Self::Red | Self::ScaledDensity | Self::Density => components[0],
            Self::Bias | Self::Green => components[1],
            Self::Albedo => components[0] + components[1],
            Self::Blue => components[2],
        }
    }

    /// Factor on a file's value before the comparison. Densities are compared as pi alpha^2 D, because D itself has a pole at small alpha.
    pub(super) fn scale(self, alpha: f64) -> f64 {
        if self == Self::Density { PI * alpha * alpha } else { 1.0 }
    }
}

impl Model {
    /// Terms that channels of the model may hold.
    pub fn terms(&self) -> &'static [Term] {
        match self {
            Self::SplitSum { .. } => &[Term::Scale, Term::Bias, Term::Albedo],
            Self::Density { .. } => &[Term::ScaledDensity, Term::Density],
            Self::Reflectance { .. } | Self::Albedo { .. } => &[Term::Red, Term::Green, Term::Blue],
        }
    }

    /// Whether the model depends on a micro-surface, and needs a second axis.
    pub fn has_slope(&self) -> bool {
        !matches!(self, Self::Reflectance { .. })
    }
}

/// Effort of albedos with all bounces: enough for the noise of the walks to be the only error.
const EFFORT: Effort = Effort { first: 24, later: 24 };
/// Wavelengths of the three-wavelength values, nm: CONVENTIONS.md.
const WAVELENGTHS: [f64; 3] = [645.0, 525.0, 445.0];

/// The stated model and the models that a table might hold instead, each as exact values and as fast ones.
pub(super) struct Truth<'a> {
    model: &'a Model,
    /// Names of the models; they follow the words `fits better as`.
    pub(super) variants: Vec<String>,
    /// Index of the stated model.
    pub(super) stated: usize,
    /// Reflectance at each wavelength of an albedo, with the wavelength's weight in RGB.
    spectrum: Option<(Vec<Rgb>, ReflectanceCurves)>,
    grid: Option<Grid>,
}

impl<'a> Truth<'a> {
    pub(super) fn new(model: &'a Model) -> Self {
        let (variants, stated): (Vec<String>, usize) = match model {
            Model::SplitSum { masking, .. } => (
                Masking::ALL.map(|m| format!("masking {}", m.name())).into(),
                Masking::ALL.iter().position(|m| m == masking).unwrap_or(0),
            ),
            Model::Density { distribution } => (
                vec!["distribution GGX".into(), "distribution Beckmann".into()],
                usize::from(*distribution == Distribution::Beckmann),
            ),
            Model::Reflectance { .. } => (
                vec![
                    "exact Fresnel".into(),
                    "Schlick's Fresnel".into(),
                    "three wavelengths for red, green, blue".into(),
                ],
                0,
            ),
            Model::Albedo { .. } => (vec!["all bounces".into(), "the first bounce only".into()], 0),
        };
        let spectrum = match model {
            Model::Albedo { interface, .. } => {
                let nodes = interface.sampled(&Color::Spectral).nodes;
                let curves = ReflectanceCurves::new(nodes.len(), |k, cos| nodes[k].1.reflectance(cos));
                Some((nodes.into_iter().map(|(weight, _)| weight).collect(), curves))
            }
            _ => None,
        };
        let mut truth = Self { model, variants, stated, spectrum, grid: None };
        let size = match model {
            Model::SplitSum { .. } => Some([81, 49]),
            Model::Density { .. } => None,
            Model::Reflectance { .. } => Some([257, 1]),
            Model::Albedo { .. } => Some([33, 17]),
        };
        truth.grid = size.map(|size| Grid::new(size, |theta, alpha| truth.exact_all([theta, alpha])));
        truth
    }

    /// All variants at theta and alpha.
    pub(super) fn exact_all(&self, [theta, alpha]: [f64; 2]) -> Vec<[f64; 3]> {
        let cos = libm::cos(theta).max(0.0);
        match self.model {
            Model::SplitSum { distribution, .. } => {
                split_sums(*distribution, alpha, cos).map(|sum| [sum.scale, sum.bias, 0.0]).into()
            }
            Model::Density { .. } => {
                let sin = libm::sin(theta);
                [Distribution::Ggx, Distribution::Beckmann]
                    .map(|d| [scaled_distribution(d, alpha, cos, sin * sin), 0.0, 0.0])
                    .into()
            }
            Model::Reflectance { interface } => {
                let sampled = interface.sampled(&Color::Spectral);
                let f0 = sampled.rgb(1.0);
                let three = WAVELENGTHS.map(|nm| interface.at(nm, 0).reflectance(cos));
                vec![sampled.rgb(cos), f0.map(|f0| schlick(f0, cos)), three]
            }
            Model::Albedo { distribution, .. } => {
                let Some((weights, curves)) = &self.spectrum else { return vec![[0.0; 3]; 2] };
                let facets = FacetStatistics::new(*distribution, alpha, cos, EFFORT, 1);
                let bounces = [facets.albedo(curves), facets.single_scattering(curves)].map(|albedos| {
                    let mut rgb = [0.0; 3];
                    for (weight, albedo) in weights.iter().zip(albedos) {
                        (0..3).for_each(|c| rgb[c] += weight[c] * albedo);
                    }
                    rgb
                });
                bounces.into()
            }
        }
    }

    /// One variant at theta and alpha.
    pub(super) fn exact(&self, variant: usize, at: [f64; 2]) -> [f64; 3] {
        match self.model {
            Model::SplitSum { distribution, .. } => {
                let cos = libm::cos(at[0]).max(0.0);
                let sum = split_sum(*distribution, Masking::ALL[variant], at[1], cos);
                [sum.scale, sum.bias, 0.0]
            }
            _ => self.exact_all(at)[variant],
        }
    }

    /// One variant, by cubics between the nodes of a grid: exact enough to rank hypotheses.
    pub(super) fn fast(&self, variant: usize, at: [f64; 2]) -> [f64; 3] {
        match &self.grid {
            Some(grid) => grid.at(variant, at),
            None => self.exact(variant, at),
        }
    }

    /// The terms that the channels may hold.
    pub(super) fn terms(&self) -> &'static [Term] {
        self.model.terms()
    }

    /// Points along each axis that an exact comparison can afford, and halvings of the search for the worst.
    pub(super) fn scan(&self) -> (u32, u32) {
        if matches!(self.model, Model::Albedo { .. }) { (20, 3) } else { (48, 8) }
    }
}

/// Values on a grid over the square roots of the cosine and of alpha. Roots put most nodes at grazing angles and low alpha, where values change
/// fastest.
struct Grid {
    size: [usize; 2],
    variants: usize,
    values: Vec<[f64; 3]>,
}

impl Grid {
    fn new(size: [usize; 2], f: impl Fn(f64, f64) -> Vec<[f64; 3]> + Sync) -> Self {
        let rows: Vec<Vec<[f64; 3]>> = (0..size[1] * size[0])
            .into_par_iter()
            .map(|k| {
                let [s, t] = [(k % size[0], size[0]), (k / size[0], size[1])]
                    .map(|(i, n)| if n < 2 { 0.0 } else { i as f64 / (n - 1) as f64 });
                f(libm::acos(s * s), t * t)
            })
            .collect();
        let variants = rows.first().map_or(0, Vec::len);
        Self { size, variants, values: rows.into_iter().flatten().collect() }
    }

    fn at(&self, variant: usize, [theta, alpha]: [f64; 2]) -> [f64; 3] {
        let [(x, wx), (y, wy)] = [(libm::cos(theta), self.size[0]), (alpha, self.size[1])]
            .map(|(value, nodes)| cubic_stencil(value.clamp(0.0, 1.0).sqrt() * (nodes - 1) as f64, nodes));
        let mut out = [0.0; 3];
        for (j, wy) in wy.into_iter().enumerate().filter(|(_, w)| *w != 0.0) {
            for (i, wx) in wx.into_iter().enumerate().filter(|(_, w)| *w != 0.0) {
                let value = self.values[((y + j) * self.size[0] + x + i) * self.variants + variant];
                (0..3).for_each(|c| out[c] += wx * wy * value[c]);
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cubics between nodes miss far less, root mean square, than the differences that hypotheses are told apart by, which are decided by
    /// quadrature in the end.
    #[test]
    fn the_grid_follows_quadrature() {
        let model = Model::SplitSum { distribution: Distribution::Ggx, masking: Masking::SmithCorrelated };
        let truth = Truth::new(&model);
        let (mut squares, mut worst, mut count) = (0.0, 0.0f64, 0);
        for i in 0..23 {
            for j in 0..23 {
                let at = [libm::acos((f64::from(i) + 0.37) / 23.0), libm::pow((f64::from(j) + 0.37) / 23.0, 2.0)];
                for (variant, exact) in truth.exact_all(at).into_iter().enumerate() {
                    let fast = truth.fast(variant, at);
                    for c in 0..2 {
                        let off = (fast[c] - exact[c]).abs();
                        squares += off * off;
                        worst = worst.max(off);
                        count += 1;
                    }
                }
            }
        }
        let rms = (squares / f64::from(count)).sqrt();
        assert!(rms < 3e-4 && worst < 1e-2, "{rms:e} {worst:e}");
    }
}
