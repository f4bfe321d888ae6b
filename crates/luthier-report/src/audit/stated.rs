//! A statement about a foreign table in names, of which a preset may decide some.

use luthier_optics::constants::{dataset, datasets};
use luthier_optics::interface::Interface;
use luthier_optics::ior::Ior;
use luthier_optics::split_sum::Masking;
use luthier_optics::stack::Distribution;
use luthier_table::{AxesError, Layout, Nodes, Preset, Value};
use thiserror::Error;

use super::{Model, Statement, Term};

/// A statement in names. What is `None` is that of the preset, or the default.
#[derive(Debug, Clone, Default)]
pub struct Stated<'a> {
    /// Model, axes, nodes and values of an engine.
    pub preset: Option<&'static Preset>,
    /// Function: ggx- or beckmann- with a masking term, ndf or all-bounces; or fresnel.
    pub model: Option<&'a str>,
    /// Index of the medium below: a data set of `luthier ior`, N, or N,K.
    pub ior: Option<&'a str>,
    /// Axes of the table, the one across first.
    pub axes: Option<&'a str>,
    /// Position of the nodes.
    pub nodes: Option<Nodes>,
    /// Content of each channel.
    pub values: Option<&'a [String]>,
    /// Channels to read, from 0, in the order of the values.
    pub channels: Option<Vec<usize>>,
    /// Lowest cosine that counts.
    pub min_cos: f64,
    /// Lowest alpha that counts.
    pub min_alpha: f64,
}

/// Names that make no statement.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StatedError {
    /// A name that is none of those known.
    #[error("no {what} `{name}`; known: {}", known.join(", "))]
    Unknown {
        /// Meaning of the name.
        what: &'static str,
        /// The name.
        name: String,
        /// All names.
        known: Vec<String>,
    },
    /// A model of an interface without the index below it.
    #[error("the model {0} needs the index of a medium: --ior au, --ior 1.5 or --ior 0.27,2.9")]
    NoIndex(String),
    /// An index that no medium has.
    #[error(transparent)]
    Index(#[from] luthier_optics::ior::IorError),
    /// Axes that no table has.
    #[error(transparent)]
    Axes(#[from] AxesError),
}

impl StatedError {
    fn unknown(what: &'static str, name: &str, known: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Self::Unknown { what, name: name.to_owned(), known: known.into_iter().map(Into::into).collect() }
    }
}

/// Terms of the channels of a preset that hold a split sum: the first ones.
fn preset_terms(preset: &Preset) -> Vec<Term> {
    let terms = preset.values.iter().map_while(|value| match value {
        Value::Scale => Some(Term::Scale),
        Value::Bias => Some(Term::Bias),
        Value::Albedo => Some(Term::Albedo),
        _ => None,
    });
    terms.collect()
}

impl Stated<'_> {
    /// The statement about a file of some channels, and the statement in words. `step` is that of the samples in the file, see [`Statement::step`].
    ///
    /// # Errors
    /// [`StatedError`].
    pub fn statement(&self, file_channels: u32, step: f64) -> Result<(Statement, String), StatedError> {
        let preset = self.preset;
        let preset_model = preset.map(|preset| format!("ggx-{}", preset.masking.name()));
        let name = self.model.or(preset_model.as_deref()).unwrap_or("ggx-correlated");
        let model = model(name, self.ior)?;
        let default_axes = if model.has_slope() { "cos_theta,roughness" } else { "cos_theta" };
        let axes = self.axes.or(preset.map(|preset| preset.axes)).unwrap_or(default_axes);
        let nodes = self.nodes.or(preset.map(|preset| preset.nodes)).unwrap_or(Nodes::CENTRES);
        let nodes_name = if nodes == Nodes::Ends { "ends" } else { "centres" };
        let layout = Layout::parse(axes, nodes)?;
        let terms = match (self.values, preset) {
            (Some(names), _) => names.iter().map(|name| term(name, &model)).collect::<Result<Vec<Term>, _>>()?,
            (None, Some(preset)) => preset_terms(preset),
            (None, None) => terms(&model, self.channels.as_ref().map_or(file_channels as usize, Vec::len)),
        };
        let channels = self.channels.clone().unwrap_or_else(|| (0..terms.len()).collect());
        let values = terms.iter().map(|t| t.name()).collect::<Vec<_>>().join(",");
        let words = format!("{name}, axes {axes}, nodes at {nodes_name}, values {values}");
        let (min_cos, min_alpha) = (self.min_cos, self.min_alpha);
        Ok((Statement { model, layout, channels, terms, min_cos, min_alpha, step }, words))
    }
}

/// Terms of the channels where nothing states them.
fn terms(model: &Model, channels: usize) -> Vec<Term> {
    match (model, channels) {
        (Model::SplitSum { .. }, 1) => vec![Term::Albedo],
        (Model::SplitSum { .. }, _) => vec![Term::Scale, Term::Bias],
        (Model::Density { .. }, _) => vec![Term::ScaledDensity],
        (Model::Reflectance { .. } | Model::Albedo { .. }, n) => model.terms()[..n.clamp(1, 3)].to_vec(),
    }
}

fn term(name: &str, model: &Model) -> Result<Term, StatedError> {
    let known: Vec<&str> = model.terms().iter().map(|t| t.name()).collect();
    let found = Term::NAMES.iter().find(|(term, known)| *known == name && model.terms().contains(term));
    found.map(|(term, _)| *term).ok_or_else(|| StatedError::unknown("value of this model", name, known))
}

fn model(name: &str, ior: Option<&str>) -> Result<Model, StatedError> {
    if name == "fresnel" {
        return Ok(Model::Reflectance { interface: interface(name, ior)? });
    }
    let (distribution, kind) = match name.split_once('-') {
        Some(("ggx", kind)) => (Distribution::Ggx, kind),
        Some(("beckmann", kind)) => (Distribution::Beckmann, kind),
        _ => return Err(unknown(name)),
    };
    match kind {
        "ndf" => Ok(Model::Density { distribution }),
        "all-bounces" => Ok(Model::Albedo { distribution, interface: interface(name, ior)? }),
        _ => {
            let masking = Masking::ALL.into_iter().find(|m| m.name() == kind).ok_or_else(|| unknown(name))?;
            Ok(Model::SplitSum { distribution, masking })
        }
    }
}

/// The error for a name that no model has, with all names.
fn unknown(name: &str) -> StatedError {
    let mut known = Vec::new();
    for distribution in ["ggx", "beckmann"] {
        let kinds = Masking::ALL.iter().map(|masking| masking.name()).chain(["ndf", "all-bounces"]);
        known.extend(kinds.map(|kind| format!("{distribution}-{kind}")));
    }
    known.push("fresnel".to_owned());
    StatedError::unknown("model", name, known)
}

/// The interface from vacuum to the index that is named.
fn interface(model: &str, ior: Option<&str>) -> Result<Interface, StatedError> {
    let text = ior.ok_or_else(|| StatedError::NoIndex(model.to_owned()))?;
    let numbers: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    let below = match numbers.as_deref() {
        Some([n]) => Ior::constant(*n, 0.0)?,
        Some([n, k]) => Ior::constant(*n, *k)?,
        _ => {
            let unknown = || StatedError::unknown("data set", text, datasets().iter().map(|set| set.id));
            dataset(text).ok_or_else(unknown)?.ior.clone()
        }
    };
    Ok(Interface { above: Ior::vacuum(), films: Vec::new(), below })
}
