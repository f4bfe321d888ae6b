//! A statement about a foreign table, made from the command line.

use luthier_optics::interface::Interface;
use luthier_optics::ior::Ior;
use luthier_optics::split_sum::Masking;
use luthier_optics::stack::Distribution;
use luthier_report::{Model, Statement, Term};
use luthier_table::{Layout, Nodes, Preset, Value};
use luthier_terminal::{Failure, Outcome};
use luthier_texture::table::Table;

use crate::cli::{AuditOptions, NodesName};
use crate::verb::ior;

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

/// The statement that the options make about a file, as data and in words.
pub(super) fn statement(options: &AuditOptions, table: &Table) -> Outcome<(Statement, String)> {
    let preset = options.preset;
    let preset_model = preset.map(|preset| format!("ggx-{}", preset.masking.name()));
    let name = options.model.as_deref().or(preset_model.as_deref()).unwrap_or("ggx-correlated");
    let model = model(name, options.ior.as_deref())?;
    let default_axes = if model.has_slope() { "cos_theta,roughness" } else { "cos_theta" };
    let axes = options.axes.as_deref().or(preset.map(|preset| preset.axes)).unwrap_or(default_axes);
    let nodes = match options.nodes {
        Some(NodesName::Centres) => Nodes::CENTRES,
        Some(NodesName::Ends) => Nodes::Ends,
        None => preset.map_or(Nodes::CENTRES, |preset| preset.nodes),
    };
    let nodes_name = if nodes == Nodes::Ends { "ends" } else { "centres" };
    let layout = Layout::parse(axes, nodes).map_err(|source| Failure::Usage(source.into()))?;
    let terms = match (&options.values, &preset) {
        (Some(names), _) => names.iter().map(|name| term(name, &model)).collect::<Outcome<Vec<Term>>>()?,
        (None, Some(preset)) => preset_terms(preset),
        (None, None) => terms(&model, options.channel.as_ref().map_or(table.image.channels as usize, Vec::len)),
    };
    let channels = options
        .channel
        .as_ref()
        .map_or_else(|| (0..terms.len()).collect(), |names| names.iter().map(|&name| name as usize).collect());
    let values = terms.iter().map(|t| t.name()).collect::<Vec<_>>().join(",");
    let words = format!("{name}, axes {axes}, nodes at {nodes_name}, values {values}");
    let statement = Statement {
        model,
        layout,
        channels,
        terms,
        min_cos: options.min_cos,
        min_alpha: options.min_alpha,
        step: table.samples.step(),
    };
    Ok((statement, words))
}

/// Terms of the channels where the command line states none.
fn terms(model: &Model, channels: usize) -> Vec<Term> {
    match (model, channels) {
        (Model::SplitSum { .. }, 1) => vec![Term::Albedo],
        (Model::SplitSum { .. }, _) => vec![Term::Scale, Term::Bias],
        (Model::Density { .. }, _) => vec![Term::ScaledDensity],
        (Model::Reflectance { .. } | Model::Albedo { .. }, n) => model.terms()[..n.clamp(1, 3)].to_vec(),
    }
}

fn term(name: &str, model: &Model) -> Outcome<Term> {
    let known: Vec<&str> = model.terms().iter().map(|t| t.name()).collect();
    let found = Term::NAMES.iter().find(|(term, known)| *known == name && model.terms().contains(term));
    found.map(|(term, _)| *term).ok_or_else(|| Failure::unknown("value of this model", name, &known))
}

fn model(name: &str, ior: Option<&str>) -> Outcome<Model> {
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

/// The failure for a name that no model has, with all names.
fn unknown(name: &str) -> Failure {
    let mut known = Vec::new();
    for distribution in ["ggx", "beckmann"] {
        let kinds = Masking::ALL.iter().map(|masking| masking.name()).chain(["ndf", "all-bounces"]);
        known.extend(kinds.map(|kind| format!("{distribution}-{kind}")));
    }
    known.push("fresnel".to_owned());
    Failure::unknown("model", name, &known.iter().map(String::as_str).collect::<Vec<_>>())
}

/// The interface from vacuum to the index that is named.
fn interface(model: &str, ior: Option<&str>) -> Outcome<Interface> {
    let Some(text) = ior else {
        let text = format!("the model {model} needs the index of a medium: --ior au, --ior 1.5 or --ior 0.27,2.9");
        return Err(Failure::Usage(anyhow::anyhow!(text)));
    };
    let numbers: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    let below = match numbers.as_deref() {
        Some([n]) => Ior::constant(*n, 0.0).map_err(|source| Failure::Usage(source.into()))?,
        Some([n, k]) => Ior::constant(*n, *k).map_err(|source| Failure::Usage(source.into()))?,
        _ => ior::named(text)?.ior.clone(),
    };
    Ok(Interface { above: Ior::vacuum(), films: Vec::new(), below })
}
