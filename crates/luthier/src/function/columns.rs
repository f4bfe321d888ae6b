//! The function that is evaluated, in the columns that are asked for.

use std::borrow::Cow;
use std::sync::Arc;

use luthier_layers::directional_albedo::over_hemisphere;
use luthier_layers::frame::each_pair;
use luthier_layers::glam::DVec3;
use luthier_layers::model::{Estimate, Estimator};
use luthier_layers::models::parts::Parts;
use luthier_layers::monochrome::Monochrome;
use luthier_layers::twins::shaded::{Shaded, at_wavelength};
use luthier_manifest::ModelPart;
use luthier_manifest::Reflectance;
use luthier_model::Family;
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::stack::Stack;

use super::{Subject, nearest_channel};
use crate::refusals::parts_of;

/// Meaning of the numbers of a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// Light of one wavelength, in nm.
    Wavelength(f64),
    /// Light of one wavelength seen at another.
    Reradiated([f64; 2]),
    /// Linear Rec.709.
    Color(Color),
}

impl Kind {
    /// Names of the columns, the only one by `single`.
    pub fn columns(&self, single: &'static str) -> Vec<&'static str> {
        match self {
            Self::Wavelength(_) | Self::Reradiated(_) => vec![single],
            Self::Color(_) => vec!["r", "g", "b"],
        }
    }

    /// The monochrome stacks whose sums are the columns, each with its weight in each column. Equal stacks are merged.
    pub fn parts(&self, stack: &Stack) -> Vec<(Monochrome, Rgb)> {
        let color = match self {
            Self::Wavelength(nm) | Self::Reradiated([_, nm]) => {
                return vec![(Monochrome::new(stack, *nm, nearest_channel(*nm)), [1.0, 0.0, 0.0])];
            }
            Self::Color(color) => color,
        };
        let mut parts: Vec<(Monochrome, Rgb)> = Vec::new();
        for node in color.nodes() {
            for channel in (0..3).filter(|&c| node.weight[c] != 0.0) {
                let one = Monochrome::new(stack, node.wavelength_nm, channel);
                let known = parts.iter().position(|(other, _)| *other == one).unwrap_or_else(|| {
                    parts.push((one, [0.0; 3]));
                    parts.len() - 1
                });
                parts[known].1[channel] += node.weight[channel];
            }
        }
        parts
    }
}

/// A directional albedo in the columns.
#[derive(Debug, Clone)]
pub struct Albedo {
    /// One value per column.
    pub values: Vec<Estimate>,
    /// Change of a quadrature on the last doubling of its points.
    pub changes: Option<Vec<f64>>,
}

impl Albedo {
    /// The albedo of a surface of which a share has this one, and the rest another.
    pub fn over(self, share: f64, bare: Self) -> Self {
        let changes = self.changes.zip(bare.changes).map(|(covered, bare)| {
            covered.iter().zip(bare).map(|(covered, bare)| share * covered + (1.0 - share) * bare).collect()
        });
        Self { values: blended(share, self.values, bare.values), changes }
    }
}

/// The function of two directions: `f cos_theta_i` of a subject.
///
/// ```
/// # use std::sync::Arc;
/// # use luthier::function::{Color, Function, Inputs, Kind, Subject};
/// # use luthier_layers::glam::DVec3;
/// # let text = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
/// # let chalk = luthier::parse("chalk.toml", text)?;
/// # let model = luthier_layers::registry::model("elek").ok_or("no such model")?;
/// # let fit = Arc::new(luthier_layers::models::lobes::Varied::of);
/// # let subject = Arc::new(Subject::new(model, chalk, None, fit, &Inputs::default(), None)?);
/// let function = Function::new(&subject, &Kind::Color(Color::Spectral));
/// assert!(function.columns() == 3 && !function.is_estimate());
/// let lambert = 0.8 / std::f64::consts::PI;
/// assert!((function.values(DVec3::Z, DVec3::Z)[0].mean - lambert).abs() < 1e-4);
/// assert!((function.albedo(DVec3::Z).values[0].mean - 0.8).abs() < 1e-3);
/// let mut values = [0.0; 3];
/// function.eval_pairs(&[[0.0, 0.0, 1.0]], &[[0.0, 0.6, 0.8]], &mut values);
/// assert!((values[0] - lambert).abs() < 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Function {
    subject: Arc<Subject>,
    columns: usize,
    how: How,
    /// The share that the first layer covers, and the function where it is not, of a model without a shader.
    bare: Option<(f64, Box<Function>)>,
}

enum How {
    /// The twin of the model's shader, and the channel of a single column.
    Shader(Box<Shaded>, usize),
    /// A sum over wavelengths.
    Sum(Vec<(Monochrome, Rgb)>),
    /// The model's own colour.
    Own(Box<[(f64, Monochrome); 3]>),
}

impl Function {
    /// The function of a subject, with values of a kind.
    pub fn new(subject: &Arc<Subject>, kind: &Kind) -> Self {
        let material = &subject.material;
        let shading = subject.model.info().shading();
        let stack = shading.map_or(Cow::Borrowed(&material.stack), |model| material.stack_of(model));
        let whole = Self::of(subject, &stack, kind);
        let bare = subject.weight.filter(|_| shading.is_none());
        let bare = bare.map(|weight| (weight, Box::new(Self::of(subject, &material.bare(&material.stack), kind))));
        Self { bare, ..whole }
    }

    fn of(subject: &Arc<Subject>, stack: &Stack, kind: &Kind) -> Self {
        let (model, material) = (subject.model.as_ref(), &subject.material);
        let wavelengths_nm = material.bake.wavelengths_nm();
        let how = shaded(subject, kind).unwrap_or_else(|| {
            let channels = [0, 1, 2].map(|c: usize| {
                let nm = wavelengths_nm[c];
                (nm, Monochrome::new(stack, nm, c))
            });
            let is_own =
                *kind == Kind::Color(Color::Spectral) && model.eval_rgb(&channels, DVec3::Z, DVec3::Z).is_some();
            if is_own { How::Own(Box::new(channels)) } else { How::Sum(kind.parts(stack)) }
        });
        Self { subject: Arc::clone(subject), columns: kind.columns("").len(), how, bare: None }
    }

    /// Number of columns: 1, or 3 of a colour.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Whether values are means of random samples.
    pub fn is_estimate(&self) -> bool {
        self.estimator().is_some()
    }

    fn estimator(&self) -> Option<&dyn Estimator> {
        self.subject.model.estimator().filter(|_| matches!(self.how, How::Sum(_)))
    }

    /// One estimate per column.
    pub fn values(&self, wi: DVec3, wo: DVec3) -> Vec<Estimate> {
        let found = self.covered(wi, wo);
        let Some((weight, bare)) = &self.bare else { return found };
        blended(*weight, found, bare.values(wi, wo))
    }

    fn covered(&self, wi: DVec3, wo: DVec3) -> Vec<Estimate> {
        match (&self.how, self.estimator()) {
            (How::Sum(parts), Some(estimator)) => self.summed(parts, |stack| estimator.eval_with_error(stack, wi, wo)),
            _ => self.eval_covered(wi, wo)[..self.columns].iter().map(|&value| Estimate::exact(value)).collect(),
        }
    }

    /// The share of the light from each direction above the surface that `wo` sees.
    pub fn albedo(&self, wo: DVec3) -> Albedo {
        if let (How::Sum(parts), Some(estimator)) = (&self.how, self.estimator()) {
            let values = self.summed(parts, |stack| estimator.albedo_with_error(stack, wo, DVec3::Z));
            let values = match &self.bare {
                Some((weight, bare)) => blended(*weight, values, bare.albedo(wo).values),
                None => values,
            };
            return Albedo { values, changes: None };
        }
        if wo.z <= 0.0 {
            return Albedo { values: vec![Estimate::exact(0.0); self.columns], changes: Some(vec![0.0; self.columns]) };
        }
        let normal = self.subject.place.sample.normal;
        let mirrored = 2.0 * normal.dot(wo) * normal - wo;
        let (values, changes) = over_hemisphere(mirrored, |wi| self.eval(wi, wo));
        let values = values[..self.columns].iter().map(|&value| Estimate::exact(value)).collect();
        Albedo { values, changes: Some(changes[..self.columns].to_vec()) }
    }

    fn summed(&self, parts: &[(Monochrome, Rgb)], f: impl Fn(&Monochrome) -> Estimate) -> Vec<Estimate> {
        let found: Vec<Estimate> = parts.iter().map(|(stack, _)| f(stack)).collect();
        let columns = (0..self.columns)
            .map(|c| Estimate::sum(parts.iter().zip(&found).map(|((_, weight), one)| (weight[c], *one))));
        columns.collect()
    }

    /// The values of many pairs, row by row, see [`each_pair`]: those of [`Self::values`], without their errors.
    pub fn eval_pairs(&self, wi: &[[f64; 3]], wo: &[[f64; 3]], values: &mut [f64]) {
        if let (How::Shader(shaded, _), 3, None) = (&self.how, self.columns, &self.bare) {
            return shaded.eval_pairs(wi, wo, values);
        }
        each_pair(wi, wo).zip(values.chunks_exact_mut(self.columns)).for_each(|([wi, wo], row)| {
            row.copy_from_slice(&self.eval(wi, wo)[..self.columns]);
        });
    }

    /// The values of a model that is a function. A single column takes the first channel.
    fn eval(&self, wi: DVec3, wo: DVec3) -> Rgb {
        let found = self.eval_covered(wi, wo);
        let Some((weight, bare)) = &self.bare else { return found };
        let bare = bare.eval(wi, wo);
        [0, 1, 2].map(|c: usize| weight * found[c] + (1.0 - weight) * bare[c])
    }

    fn eval_covered(&self, wi: DVec3, wo: DVec3) -> Rgb {
        match &self.how {
            How::Shader(shaded, channel) if self.columns == 1 => [shaded.eval(wi, wo)[*channel], 0.0, 0.0],
            How::Shader(shaded, _) => shaded.eval(wi, wo),
            How::Own(channels) => self.subject.model.eval_rgb(channels, wi, wo).unwrap_or([0.0; 3]),
            How::Sum(parts) => {
                let mut sum = [0.0; 3];
                for (stack, weight) in parts {
                    let value = self.subject.model.eval(stack, wi, wo);
                    (0..3).for_each(|c| sum[c] += weight[c] * value);
                }
                sum
            }
        }
    }
}

/// Values of a surface that is covered by a weight, and bare elsewhere.
fn blended(weight: f64, covered: Vec<Estimate>, bare: Vec<Estimate>) -> Vec<Estimate> {
    let pairs = covered.into_iter().zip(bare);
    pairs.map(|(covered, bare)| Estimate::sum([(weight, covered), (1.0 - weight, bare)])).collect()
}

/// The parts that the file chooses, as far as the evaluated model has them.
pub fn parts(subject: &Subject) -> (Parts, Reflectance) {
    let Some(model) = subject.model.info().shading() else {
        return (Parts::PLAIN, Reflectance::default());
    };
    let reflectance =
        subject.material.bake.reflectance.filter(|_| model.takes(ModelPart::Reflectance)).unwrap_or_default();
    (parts_of(&subject.material, model), reflectance)
}

/// The twin of the model's shader, where it has one. At one wavelength the models of Belcour and Yamaguchi are evaluated without it: in colour their
/// energies take seconds, and they show no effects.
fn shaded(subject: &Subject, kind: &Kind) -> Option<How> {
    let (model, place) = (subject.model.info().shading()?, &subject.place);
    let material = &subject.material;
    let stack = material.stack_of(model);
    let stack = stack.as_ref();
    let fit = subject.fit.as_ref();
    let (parts, reflectance) = parts(subject);
    let made = |stack: &Stack, wavelengths_nm: [f64; 3], color: Color| match parts == Parts::PLAIN {
        true => Shaded::fitted_by(fit, model, stack, wavelengths_nm, color, place),
        false => Shaded::with(model, stack, wavelengths_nm, color, place, parts),
    };
    match *kind {
        Kind::Reradiated(_) => None,
        Kind::Wavelength(_)
            if model.is_statistical()
                && reflectance == Reflectance::Table
                && place.base_color.is_none()
                && place.layers.is_empty() =>
        {
            None
        }
        Kind::Wavelength(nm) => {
            let color = Color::ThreeWavelengths([nm; 3]);
            let shaded = made(&at_wavelength(stack, nm), [nm; 3], color)?;
            Some(How::Shader(Box::new(shaded), nearest_channel(nm)))
        }
        Kind::Color(color) => {
            let wavelengths_nm = subject.material.bake.wavelengths_nm();
            // Coefficients of a stack and curves of reflectances are in the material's colour, in both forms of its shader.
            let is_own = model.facts().family == Family::Coefficients || reflectance.is_fitted();
            let color = if is_own { subject.material.color() } else { color };
            Some(How::Shader(Box::new(made(stack, wavelengths_nm, color)?), 0))
        }
    }
}
