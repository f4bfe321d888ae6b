//! The judgement of a bake: order of its parts, settings, progress.

pub(crate) mod evidence;
pub(crate) mod exceptions;
pub(crate) mod limits;
pub(crate) mod profile;
pub(crate) mod report;

use std::fmt;

use luthier_layers::layers::{Below, Layer};
use luthier_lut::TexelFormat;
use luthier_manifest::{ColorMode, Form, LayerKind, LayerRecord, Manifest, ShaderEntry, ShadingModel};
use luthier_optics::Rgb;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::error::ReportError;
use crate::judge::evidence::ShaderVerdict;
use crate::judge::exceptions::{Exception, exception};
use crate::judge::profile::{AngleProfile, Exceedance};
use crate::judge::report::{Compared, Comparison, MaterialReport, REPORT_SCHEMA, Report};
use crate::measure::causes::{Factors, Miss};
use crate::measure::device::{Device, WeightsVote, run};
use crate::measure::directions::{DirectionSet, Pair};
use crate::measure::memory::{Memory, Remembered};
use crate::measure::references::{References, evaluate};
use crate::measure::scan;
use crate::measure::scan::report::TableReport;
use crate::measure::seen::SeenBy;
use crate::measure::statistics::{FLOOR, Statistics, TARGET_MAX_REL_ERR, UNCERTAINTY_MARGIN, statistics};
use crate::measure::subject::Subject;
use crate::measure::table_terms::{TableTerms, Weights};
use crate::places::{AtPlaces, PLACES_SEED, SimulatedErrors, SimulatedSettings, at_places, simulated};
use crate::stability::{Shipped, Stressed, shipped};
use crate::text::format;

/// Factor by which the judge's largest table error may exceed the baker's before it is a finding. Both scan finitely many points, so that
/// smaller differences mean nothing.
const BAKER_MARGIN: f64 = 1.05;

/// Keys of votes and of judgements of materials in a memory.
const VOTE: &str = "judge-vote";
const JUDGED: &str = "judged";

/// Settings of a judgement.
#[derive(Clone)]
pub struct Settings<'a> {
    /// Pairs of directions in every set of every material, at least 1. Albedos are estimated at one point for every 64 pairs, at 4 to 48 in all.
    pub pairs_per_set: u32,
    /// Limit on [`Report::max_error`].
    pub budget: Option<f64>,
    /// Facts about the run from the caller, shown and stored as given.
    pub provenance: Vec<(String, String)>,
    /// Results of earlier judgements: unchanged tiles and materials are not judged again.
    pub memory: Option<&'a dyn Memory>,
    /// Simulation of materials of the model `lobes` at places of their maps; `None` skips it.
    pub simulated: Option<SimulatedSettings>,
    /// Called after every part of the table scan and every set of every material.
    pub progress: Option<&'a dyn Fn(Progress<'_>)>,
}

impl Default for Settings<'_> {
    /// 4096 pairs, no budget, no provenance, no memory, a quick simulation, no progress.
    fn default() -> Self {
        let simulated = Some(SimulatedSettings::default());
        Self { pairs_per_set: 4096, budget: None, provenance: Vec::new(), memory: None, simulated, progress: None }
    }
}

impl fmt::Debug for Settings<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Settings")
            .field("pairs_per_set", &self.pairs_per_set)
            .field("budget", &self.budget)
            .field("provenance", &self.provenance)
            .field("simulated", &self.simulated)
            .finish_non_exhaustive()
    }
}

/// Progress of a judgement.
#[derive(Debug, Clone, Copy)]
pub struct Progress<'a> {
    /// Steps done: parts of the table scan, then sets of every material, then materials at places.
    pub done: u64,
    /// Steps in all.
    pub total: u64,
    /// The current material; `tables` during the scan of tables.
    pub subject: &'a str,
}

/// Judges a bake: its tables always, its shaders when there is a device to run them.
///
/// The result depends on the subject, the settings and the device's values only, not on the number of threads.
///
/// # Errors
/// See [`ReportError`]: a subject that does not fit together, a device that fails. Bad values are no error here; they
/// are in the report.
pub fn judge(
    subject: &Subject<'_>,
    device: Option<&dyn Device>,
    settings: &Settings<'_>,
) -> Result<Report, ReportError> {
    if settings.pairs_per_set == 0 {
        return Err(ReportError::NoPairs);
    }
    subject.check()?;
    let manifest = subject.manifest;
    let references: Vec<References> = manifest
        .materials
        .iter()
        .zip(&subject.stacks)
        .map(|(material, stack)| References::new(stack, material))
        .collect();
    let total = u64::from(scan::STEPS) + (manifest.materials.len() * (DirectionSet::ALL.len() + 1)) as u64;
    let mut done = 0;
    let mut step = |subject: &str| {
        done += 1;
        if let Some(progress) = settings.progress {
            progress(Progress { done, total, subject });
        }
    };
    let mut findings = Vec::new();
    let remembered = Remembered::new(settings.memory, subject);
    let pairs = settings.pairs_per_set;
    let tables = scan::scan(subject, &references, &remembered, pairs, &mut || step("tables"), &mut findings)?;

    let bench = Bench { subject, references: &references, remembered: &remembered, device, settings };
    let mut materials = Vec::with_capacity(manifest.materials.len());
    let mut weights = WeightsVote::default();
    for (index, (entry, references)) in manifest.materials.iter().zip(&references).enumerate() {
        record_findings(&entry.name, &references.layers, &entry.layers, &mut findings);
        let inputs = remembered.material(subject, index, device, settings.pairs_per_set, &settings.simulated);
        let known: Option<WeightsVote> = remembered.recall(VOTE, &inputs);
        let gathered = known.is_none().then(|| bench.gather(index)).transpose()?;
        let vote = known.or_else(|| gathered.as_ref().map(|gathered| gathered.vote)).unwrap_or_default();
        if gathered.is_some() {
            remembered.keep(VOTE, &inputs, &vote);
        }
        weights.merge(vote);
        materials.push((inputs, gathered));
        DirectionSet::ALL.iter().for_each(|_| step(&entry.name));
    }

    let device_weights = device.map(|_| weights.decide());
    let mut exceptions = Vec::new();
    let mut judged = Vec::with_capacity(materials.len());
    for (index, (inputs, gathered)) in materials.into_iter().enumerate() {
        let entry = &manifest.materials[index];
        let inputs = json!([inputs, device_weights]);
        let Judged { comparisons, exceptions: own, stability, at_places } = match remembered.recall(JUDGED, &inputs) {
            Some(judged) => judged,
            None => {
                let gathered = gathered.map_or_else(|| bench.gather(index), Ok)?;
                let judged = bench.judge(index, gathered, device_weights)?;
                remembered.keep(JUDGED, &inputs, &judged);
                judged
            }
        };
        exceptions.extend(own);
        judged.push(MaterialReport {
            name: entry.name.clone(),
            source: entry.source.clone(),
            source_hash: entry.source_hash.clone(),
            class: entry.class.clone(),
            model: entry.model,
            color: entry.color,
            layers: entry.layers.iter().map(format::layer).collect(),
            comparisons,
            against_reference: Vec::new(),
            at_places,
            stability,
            alone: Vec::new(),
            picture: None,
            shape_cost: None,
            choice: None,
        });
        step(&entry.name);
    }
    let materials = judged;
    table_findings(&tables, &mut findings);
    value_findings(&materials, &mut findings);
    place_findings(&materials, &mut findings);
    stability_findings(&materials, &mut findings);
    filter_findings(&materials, &tables, &mut findings);
    Ok(Report {
        schema: REPORT_SCHEMA,
        generator: manifest.generator.clone(),
        model: models(manifest),
        provenance: settings.provenance.clone(),
        device: device.map(Device::name),
        device_weights,
        budget: settings.budget,
        pairs_per_set: settings.pairs_per_set,
        floor: FLOOR,
        findings,
        target_max_rel_err: TARGET_MAX_REL_ERR,
        exceptions,
        limits: Vec::new(),
        searches: manifest.searches.clone(),
        costs: None,
        reference: None,
        stability: None,
        times: None,
        shaders: manifest.shaders.iter().map(verdict).collect(),
        tables,
        materials,
    })
}

fn verdict(shader: &ShaderEntry) -> ShaderVerdict {
    let ShaderEntry { target, form, file, checks, .. } = shader;
    ShaderVerdict { target: *target, form: *form, path: file.path.clone(), checks: checks.clone() }
}

/// Judgement of a material, as a memory keeps it: comparisons, exceptions, values where methods fail, and errors at places.
#[derive(Serialize, Deserialize)]
struct Judged {
    comparisons: Vec<Comparison>,
    exceptions: Vec<Exception>,
    stability: Option<Shipped>,
    at_places: Option<AtPlaces>,
}

/// Inputs of the judgement that all materials share.
struct Bench<'a> {
    subject: &'a Subject<'a>,
    references: &'a [References],
    remembered: &'a Remembered<'a>,
    device: Option<&'a dyn Device>,
    settings: &'a Settings<'a>,
}

impl Bench<'_> {
    /// Compares a material over all sets of directions.
    fn gather(&self, index: usize) -> Result<Gathered, ReportError> {
        let Self { subject, device, settings, .. } = *self;
        let (manifest, references) = (subject.manifest, &self.references[index]);
        let entry = &manifest.materials[index];
        self.remembered.fit(references, entry);
        let eight_bit = TableTerms::new(subject, index, Weights::EightBit)?;
        let exact_weights = TableTerms::new(subject, index, Weights::Exact)?;
        let mut gathered = Gathered::new(device.is_some());
        for set in DirectionSet::ALL {
            let pairs = set.pairs(settings.pairs_per_set, &references.layers);
            let baked_reference = &evaluate(&references.twin, references.baked(), &pairs);
            let tables_8 = evaluate(&references.twin, &eight_bit, &pairs);
            let tables_exact = evaluate(&references.twin, &exact_weights, &pairs);
            gathered.add(Compared::TablesEightBit, set, &pairs, &tables_8, baked_reference);
            gathered.add(Compared::TablesExact, set, &pairs, &tables_exact, baked_reference);
            // Only the form without tables computes at three wavelengths.
            let three = entry.model.has(Form::Full).then(|| evaluate(&references.twin, &references.three, &pairs));
            if let Some(three) = &three {
                let spectral = match entry.color {
                    ColorMode::Spectral => baked_reference,
                    ColorMode::ThreeWavelengths => &evaluate(&references.twin, &references.spectral, &pairs),
                };
                gathered.add(Compared::ThreeWavelengths, set, &pairs, three, spectral);
            }
            if let Some(device) = device {
                if let Some(three) = three.as_ref().filter(|_| device.has(Form::Full)) {
                    let found = run(device, Form::Full, index as u32, &pairs)?;
                    let level = references.level.as_ref().map(|level| evaluate(&references.twin, level, &pairs));
                    gathered.add(Compared::FullDevice, set, &pairs, &found, level.as_ref().unwrap_or(three));
                }
                let found = run(device, Form::Baked, index as u32, &pairs)?;
                gathered.add(Compared::BakedDevice, set, &pairs, &found, baked_reference);
                gathered.vote.add(&found, &tables_8, &tables_exact);
                gathered.device.push((set, pairs, found, [tables_8, tables_exact]));
            }
        }
        Ok(gathered)
    }

    /// Judges gathered comparisons. It runs after all materials have voted on the weights of the device.
    fn judge(&self, index: usize, mut gathered: Gathered, weights: Option<Weights>) -> Result<Judged, ReportError> {
        if let Some(weights) = weights {
            gathered.split_arithmetic(weights);
        }
        for (comparison, (_, seen)) in gathered.comparisons.iter_mut().zip(gathered.seen) {
            comparison.seen = seen.finish();
        }
        gathered.comparisons.sort_by_key(|c| c.compared);
        let (reference, name) = (&self.references[index], &self.subject.manifest.materials[index].name);
        let read = TableTerms::new(self.subject, index, weights.unwrap_or(Weights::EightBit))?;
        let mut exceptions = Vec::new();
        for (compared, misses) in gathered.misses {
            let factors = Factors {
                twin: &reference.twin,
                exact: reference.baked(),
                tables: (compared != Compared::FullDevice).then_some(&read),
                on_device: self.device.is_some(),
            };
            let comparison = gathered.comparisons.iter().find(|comparison| comparison.compared == compared);
            exceptions.extend(comparison.and_then(|comparison| exception(name, comparison, &misses, &factors)));
        }
        let model = self.subject.manifest.materials[index].model;
        let stability = Some(shipped(index as u32, model, reference, &read, self.device)?);
        let at_places = at_places_of(self.subject, index, self.device.zip(weights), self.settings)?;
        Ok(Judged { comparisons: gathered.comparisons, exceptions, stability, at_places })
    }
}

/// A material at random places, with the simulation there.
fn at_places_of(
    subject: &Subject<'_>,
    material: usize,
    device: Option<(&dyn Device, Weights)>,
    settings: &Settings<'_>,
) -> Result<Option<AtPlaces>, ReportError> {
    let mut found = at_places(subject, material, device, settings.pairs_per_set, PLACES_SEED)?;
    if let (Some(found), Some(settings)) = (&mut found, &settings.simulated) {
        found.simulated = simulated(subject, material, settings)?;
    }
    Ok(found)
}

/// Names of the models in use.
fn models(manifest: &Manifest) -> String {
    let used = ShadingModel::ALL.into_iter().filter(|model| manifest.materials.iter().any(|m| m.model == *model));
    used.map(ShadingModel::name).collect::<Vec<_>>().join(", ")
}

/// Pairs, the device's values there, and those of f64 arithmetic on the tables with 8-bit and exact weights.
type DeviceRun = (DirectionSet, Vec<Pair>, Vec<Rgb>, [Vec<Rgb>; 2]);

/// The comparisons of one material, filled set by set.
struct Gathered {
    with_device: bool,
    comparisons: Vec<Comparison>,
    device: Vec<DeviceRun>,
    /// Colour differences of each comparison.
    seen: Vec<(Compared, SeenBy)>,
    /// Pairs that miss the target, for each judged comparison.
    misses: Vec<(Compared, Vec<Miss>)>,
    vote: WeightsVote,
}

impl Gathered {
    fn new(with_device: bool) -> Self {
        let (seen, misses) = (Vec::new(), Vec::new());
        Self { with_device, comparisons: Vec::new(), device: Vec::new(), seen, misses, vote: WeightsVote::default() }
    }

    fn add(&mut self, compared: Compared, set: DirectionSet, pairs: &[Pair], found: &[Rgb], expected: &[Rgb]) {
        let at = self.comparisons.iter().position(|c| c.compared == compared).unwrap_or_else(|| {
            self.comparisons.push(Comparison {
                compared,
                sets: Vec::new(),
                by_angle: AngleProfile::new(),
                exceedance: Exceedance::new(),
                seen: Vec::new(),
            });
            self.seen.push((compared, SeenBy::default()));
            self.comparisons.len() - 1
        });
        let comparison = &mut self.comparisons[at];
        comparison.sets.push((set, statistics(pairs, found, expected)));
        comparison.by_angle.add(pairs, found, expected);
        comparison.exceedance.add(found, expected);
        self.seen[at].1.add(pairs, found, expected);
        if compared.is_judged(self.with_device) {
            let misses = Miss::among(pairs, found, expected);
            match self.misses.iter_mut().find(|(c, _)| *c == compared) {
                Some((_, all)) => all.extend(misses),
                None => self.misses.push((compared, misses)),
            }
        }
    }

    /// Compares the device with f64 on the same tables, now that its weights are known.
    fn split_arithmetic(&mut self, weights: Weights) {
        for (set, pairs, found, [eight_bit, exact]) in std::mem::take(&mut self.device) {
            let expected = match weights {
                Weights::EightBit => &eight_bit,
                Weights::Exact => &exact,
            };
            self.add(Compared::Arithmetic, set, &pairs, &found, expected);
        }
    }
}

/// Reports records whose numbers differ from the material file. It compares the running maximum of alpha, because models evaluate no layer
/// smoother than the one above it.
fn record_findings(material: &str, layers: &[Layer], records: &[LayerRecord], findings: &mut Vec<String>) {
    let (mut alpha, mut recorded) = (0.0_f64, 0.0_f64);
    for (i, (layer, record)) in layers.iter().zip(records).enumerate() {
        if record.kind == LayerKind::Diffuse {
            break;
        }
        alpha = alpha.max(layer.surface.alpha_x);
        recorded = recorded.max(record.alpha);
        if (alpha - recorded).abs() > 1e-6 {
            findings.push(format!(
                "{material}, layer {i}: the shader's alpha is {}, the material file's {}.",
                format::number(recorded),
                format::number(alpha)
            ));
        }
        if matches!(layer.below, Below::Dielectric { .. }) && (layer.eta() - record.eta).abs() > 1e-6 {
            findings.push(format!(
                "{material}, layer {i}: the shader's relative index is {}, the material file's {}.",
                format::number(record.eta),
                format::number(layer.eta())
            ));
        }
    }
}

fn table_findings(tables: &[TableReport], findings: &mut Vec<String>) {
    for table in tables {
        for tile in &table.tiles {
            let name = format!("{} tile {}", table.kind.name(), tile.name);
            if tile.not_finite > 0 {
                findings.push(format!("{name}: {} reads are not finite.", tile.not_finite));
            }
            if let Some((found, aim)) = tile.miss() {
                let (found, aim) = (format::error(found), format::error(aim));
                findings.push(format!("{name}: off by up to {found} as sampled, where the bake aimed at {aim}."));
            }
            if let Some((error, largest)) = tile.coarse() {
                let (error, largest) = (format::error(error), format::number(largest));
                findings
                    .push(format!("{name}: off by up to {error}, more than a tenth of its largest value, {largest}."));
            }
            if tile.users.is_empty() {
                findings.push(format!("{name}: no layer reads it."));
            }
            let Some(judge) = &tile.judge else { continue };
            let doubt = UNCERTAINTY_MARGIN * tile.uncertainty.unwrap_or(0.0);
            if judge.max_abs_err - doubt > BAKER_MARGIN * tile.baker.max_abs_err {
                findings.push(format!(
                    "{name}: measured here {}, the baker states {}.",
                    format::uncertain(judge.max_abs_err, tile.uncertainty),
                    format::error(tile.baker.max_abs_err)
                ));
            }
        }
    }
}

fn value_findings(materials: &[MaterialReport], findings: &mut Vec<String>) {
    for material in materials {
        for comparison in &material.comparisons {
            for (set, Statistics { not_finite, pairs, .. }) in &comparison.sets {
                if *not_finite > 0 {
                    findings.push(format!(
                        "{}, {}, {} set: {not_finite} of {} values are not finite.",
                        material.name,
                        comparison.compared.name(),
                        set.name(),
                        3 * pairs
                    ));
                }
            }
        }
    }
}

fn place_findings(materials: &[MaterialReport], findings: &mut Vec<String>) {
    for material in materials {
        let Some(at) = &material.at_places else { continue };
        for (what, errors) in [("shader", &at.shader), ("tables", &at.tables)] {
            if let Some(errors) = errors.as_ref().filter(|errors| errors.not_finite > 0) {
                let (count, all) = (errors.not_finite, 3 * at.places);
                findings.push(format!("{}, {what} at places: {count} of {all} values are not finite.", material.name));
            }
        }
        let worst =
            at.simulated.iter().flat_map(SimulatedErrors::misses).max_by(|a, b| a.excess().total_cmp(&b.excess()));
        let Some(worst) = worst else { continue };
        let misses = at.simulated.iter().flat_map(SimulatedErrors::misses).count();
        findings.push(format!(
            "{}: {}; {misses} of {} places and angles are like it.",
            material.name,
            worst.words(),
            at.simulated.as_ref().map_or(0, |s| s.views.len())
        ));
    }
}

fn stability_findings(materials: &[MaterialReport], findings: &mut Vec<String>) {
    for material in materials {
        let Some(stability) = &material.stability else { continue };
        for Stressed { level, directions, values, not_finite, negative, .. } in &stability.stressed {
            let at = format!("{}, {} at {} directions", material.name, level.shipped_name(), directions.name());
            if *not_finite > 0 {
                findings.push(format!("{at}: {not_finite} of {values} values are not finite."));
            }
            if *negative > 0.0 {
                let size = format::error(*negative);
                findings.push(format!("{at}: light at or below the horizon, or negative light, of up to {size}."));
            }
        }
        for albedo in &stability.albedos {
            if albedo.albedo.is_none() {
                let (level, angle) = (albedo.level.shipped_name(), albedo.theta_deg);
                findings.push(format!("{}, {level}: the albedo at {angle} degrees is not finite.", material.name));
            }
        }
        for gain in stability.gains() {
            let (level, angle) = (gain.level.shipped_name(), gain.theta_deg);
            let albedo = format::number(gain.albedo.unwrap_or(0.0));
            let model = material.model.name();
            findings.push(format!(
                "{}, {level}: the albedo at {angle} degrees is {albedo}, and {model} claims to return no more light than falls in.",
                material.name
            ));
        }
    }
}

/// Materials whose tables have codes of 8 bits, and whose shader is far from f64 on the same tables: the adapter rounds filtered values to such codes.
fn filter_findings(materials: &[MaterialReport], tables: &[TableReport], findings: &mut Vec<String>) {
    for material in materials {
        let Some(arithmetic) = material.comparison(Compared::Arithmetic).map(Comparison::max_error) else { continue };
        let read = tables.iter().find(|table| {
            table.format == TexelFormat::Rgba8Unorm && table.tiles.iter().any(|tile| tile.is_read_by(&material.name))
        });
        if let Some(table) = read.filter(|_| arithmetic > TARGET_MAX_REL_ERR) {
            findings.push(format!(
                "{}: the baked shader is up to {} from f64 on the same tables. It reads the table {} as {}, and an adapter may round what it filters to codes of 8 bits, as \
                 llvmpipe does: half a code is {:.0e}, of values that may be small.",
                material.name,
                format::error(arithmetic),
                table.kind.name(),
                table.format,
                0.5 / 255.0
            ));
        }
    }
}
