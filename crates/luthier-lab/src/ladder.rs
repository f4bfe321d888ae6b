//! `ladder`: what limits on the errors of lobes take, and what that costs.

use std::fmt::Write as _;

use luthier::{MemoryStore, Options, outline, read_materials};
use luthier_cost::{DeviceCost, Style, shader_text};
use luthier_export::GENERATOR;
use luthier_manifest::{Budget, FunctionGroup, LobesRecord, Manifest, ShadingModel};
use luthier_material::Material;
use luthier_report::Spread;
use luthier_shader::{Form, MaterialSet, StaticCounts, Yardstick, count};
use luthier_terminal::{Failure, Outcome, deliver, valid};
use rayon::prelude::*;

use crate::cli::{LadderOptions, call};

/// Lights on a prepared view.
const LIGHTS: [u32; 3] = [1, 4, 16];

/// Limits on the lobe error; none at first.
const LIMITS: [Option<f64>; 5] = [None, Some(0.02), Some(0.03), Some(0.05), Some(0.1)];

/// The limit on the error of the albedo, over that on the lobe error.
const OF_ALBEDO: f64 = 0.4;

/// Device whose costs the page has.
const DEVICE: &str = "h100";

/// A form of lobes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Rung {
    NoLobe,
    OneWidth,
    OneLobe,
    TwoLobes,
    /// Rows over something beside the view.
    Varied,
}

impl Rung {
    const ALL: [(Self, &'static str); 5] = [
        (Self::NoLobe, "no lobe"),
        (Self::OneWidth, "one of one width"),
        (Self::OneLobe, "one lobe"),
        (Self::TwoLobes, "two lobes"),
        (Self::Varied, "rows over more than the view"),
    ];

    fn of(record: &LobesRecord) -> Self {
        match (record.lobes, record.rise) {
            _ if record.varying.is_some() || record.axes.is_some() => Self::Varied,
            (0, _) => Self::NoLobe,
            (_, Some(_)) => Self::OneWidth,
            (1, None) => Self::OneLobe,
            (_, None) => Self::TwoLobes,
        }
    }
}

/// Form, errors and costs of a material under a limit.
struct Taken {
    rung: Rung,
    lobe: f64,
    albedo: f64,
    /// Costs of a light, by number of lights.
    costs: [f64; LIGHTS.len()],
}

/// Outlines every material under every limit and prints a page.
pub(crate) fn run(options: &LadderOptions) -> Outcome {
    let materials = valid(read_materials(&options.sources.paths)?, true)?;
    let device = DeviceCost::shipped(DEVICE).ok_or_else(|| Failure::Usage(anyhow::anyhow!("no costs of {DEVICE}")))?;
    let yardstick = costs(&device, |lights| count(&Yardstick::GltfClearcoat.wgsl(), &[], lights))?;
    let mut page = format!(
        "# A ladder of lobes\n\nMade by `{}`, {GENERATOR}. Costs are predicted {}: they come from counts of the texts and costs that were fitted to times of other shaders, and are no times.\n",
        call("ladder", &options.sources.paths),
        device.label()
    );
    page.push_str(INTRODUCTION);
    let _ = writeln!(
        page,
        "\n| limit | materials that hold it | {} | lobe error: median | 95th percentile | largest | albedo error: largest | one light | each of 4 | each of 16 |\n\
         |--:|--:|{}--:|--:|--:|--:|--:|--:|--:|",
        Rung::ALL.map(|(_, words)| words).join(" | "),
        "--:|".repeat(Rung::ALL.len())
    );
    for limit in LIMITS {
        let taken = materials.par_iter().map(|material| take(material, limit, &device));
        let taken: Vec<Taken> = taken.collect::<Outcome<Vec<Option<Taken>>>>()?.into_iter().flatten().collect();
        row(&mut page, limit, materials.len(), &taken, &yardstick);
    }
    let _ = writeln!(
        page,
        "\n`gltf-clearcoat` by the same costs: {}.\n\nThe materials: {}.",
        LIGHTS
            .iter()
            .zip(&yardstick)
            .map(|(lights, cost)| format!("{cost:.1} ps for each of {lights}"))
            .collect::<Vec<_>>()
            .join(", "),
        materials.iter().map(|material| material.name.as_str()).collect::<Vec<_>>().join(", ")
    );
    deliver(&page, options.destination.output.as_deref())
}

const INTRODUCTION: &str = "\nWhere a file or the command line limits the errors of `lobes` (`max_lobe_err`, `max_albedo_err`), a bake takes the form with the lowest cost that holds: no lobe, \
    one lobe of one width, one lobe, or two. Without limits it takes the fewest lobes that fit as well as two. This page takes each material by itself, with a limit on the albedo of .4 times that on the lobe error. \
    Errors are those that the bake states: the largest of five views that no fit saw, with the noise of the judge in them (.006 to .009). Costs are picoseconds of a light on one view, medians over the \
    materials; in brackets is the median over the cost of `gltf-clearcoat` for as many lights.\n";

/// The cheapest form of a material under a limit; `None` where none holds it.
fn take(material: &Material, limit: Option<f64>, device: &DeviceCost) -> Outcome<Option<Taken>> {
    let mut material = material.clone();
    material.bake.model = Some(ShadingModel::Lobes);
    let budget =
        Budget { max_lobe_err: limit, max_albedo_err: limit.map(|limit| OF_ALBEDO * limit), ..Budget::default() };
    let options = Options { budget, ..Options::default() };
    let outlined: Manifest = match outline(std::slice::from_ref(&material), &options, &MemoryStore::default()) {
        Ok(outlined) => outlined,
        Err(_) if limit.is_some() => return Ok(None),
        Err(error) => return Err(error.into()),
    };
    let Some((record, error)) = outlined.materials[0].constants.lobes.and_then(|lobes| Some((lobes, lobes.error?)))
    else {
        return Ok(None);
    };
    let mut set = MaterialSet::from_manifest(&outlined);
    set.functions = [FunctionGroup::Light].into_iter().collect();
    let style = Style { form: Form::Baked, constant: false, approximate: false };
    let text = shader_text(&set, style).map_err(Failure::input)?;
    let costs = costs(device, |lights| count(&text, &set.wide_textures(), lights))?;
    Ok(Some(Taken { rung: Rung::of(&record), lobe: error.lobe, albedo: error.albedo, costs }))
}

/// Costs of a light, by number of lights.
fn costs<E: std::error::Error + Send + Sync + 'static>(
    device: &DeviceCost,
    counts: impl Fn(u32) -> Result<StaticCounts, E>,
) -> Outcome<[f64; LIGHTS.len()]> {
    let mut costs = [0.0; LIGHTS.len()];
    for (cost, lights) in costs.iter_mut().zip(LIGHTS) {
        *cost = device.cost(&counts(lights).map_err(Failure::input)?) / f64::from(lights);
    }
    Ok(costs)
}

fn row(page: &mut String, limit: Option<f64>, all: usize, taken: &[Taken], yardstick: &[f64; LIGHTS.len()]) {
    let words = limit.map_or_else(|| "none".to_owned(), |limit| format!("{limit}"));
    let _ = write!(page, "| {words} | {} of {all} |", taken.len());
    for (rung, _) in Rung::ALL {
        let _ = write!(page, " {} |", taken.iter().filter(|taken| taken.rung == rung).count());
    }
    if taken.is_empty() {
        page.push_str(" – | – | – | – | – | – | – |\n");
        return;
    }
    let mut lobes: Vec<f64> = taken.iter().map(|taken| taken.lobe).collect();
    lobes.sort_by(f64::total_cmp);
    let at = |share: usize| lobes[(lobes.len() * share / 100).min(lobes.len() - 1)];
    let albedo = taken.iter().map(|taken| taken.albedo).fold(0.0, f64::max);
    let _ = write!(page, " {:.3} | {:.3} | {:.3} | {albedo:.3} |", at(50), at(95), at(100));
    for (i, yardstick) in yardstick.iter().enumerate() {
        let median = Spread::of(&taken.iter().map(|taken| taken.costs[i]).collect::<Vec<_>>()).median;
        let _ = write!(page, " {median:.1} ({:.2}) |", median / yardstick);
    }
    page.push('\n');
}
