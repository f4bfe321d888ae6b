//! Parity: every shader on a device against its f64 twin, over five sets of directions.

mod page;
mod sets;
mod tolerances;

use std::collections::BTreeMap;

use luthier_layers::models::shade::ShaderTerms;
use luthier_layers::twins::real_time::Twin;
use luthier_manifest::{ColorMode, Form, ShadingModel};
use luthier_optics::Rgb;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::error::ReportError;
use crate::measure::causes::{Factor, Factors, Miss, Part};
use crate::measure::device::{Device, WeightsVote, run};
use crate::measure::directions::Pair;
use crate::measure::references::{References, evaluate};
use crate::measure::statistics::{ErrorSummary, FLOOR, Statistics, WorstPair, statistics};
use crate::measure::subject::Subject;
use crate::measure::table_terms::{TableTerms, Weights};
use crate::places::{PLACES_SEED, PlaceErrors, at_places};
use crate::text::json;

pub use sets::{POLISHED_ALPHAS, ParitySet};
pub use tolerances::{KNOWN, Known, Share, tolerance};

use tolerances::known;

/// Limit of the 99th percentile of errors at random places, over max(brightest channel, [`crate::PLACE_FLOOR`]).
pub const AT_PLACES: f64 = 0.01;

/// A material of a bake, and its polished variants ([`POLISHED_ALPHAS`]): numbers of materials of the [`Subject`].
#[derive(Debug, Clone, PartialEq)]
pub struct ParityCase {
    /// Name of the material.
    pub name: String,
    /// The material.
    pub material: u32,
    /// Its variants; at least one.
    pub polished: Vec<u32>,
}

/// A parity run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Parity {
    /// Program and version.
    pub generator: String,
    /// The adapter.
    pub device: String,
    /// Pairs of directions in each of the five sets.
    pub pairs_per_set: u32,
    /// Floor of relative errors, which are over max(brightest channel of the reference, this).
    pub floor: f64,
    /// One per model, material and form.
    pub rows: Vec<ParityRow>,
}

/// Errors of one shader of one material, over all sets.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ParityRow {
    /// The model.
    pub model: ShadingModel,
    /// The form.
    pub form: Form,
    /// Name of the material.
    pub material: String,
    /// Colour mode of the reference: spectral or at three wavelengths.
    pub color: ColorMode,
    /// Pairs compared; three samples each.
    pub pairs: u64,
    /// Samples that are NaN or infinite; they are in none of the errors.
    pub not_finite: u64,
    /// The device against the reference.
    pub total: ErrorSummary,
    /// f64 on the tables, read with the device's weights, against the reference; `None` for a form without tables.
    pub table: Option<ErrorSummary>,
    /// The device against f64 on the same tables; without tables, against the reference.
    pub arithmetic: ErrorSummary,
    /// The weights that explain the device's values best; `None` for a form without tables.
    pub weights: Option<Weights>,
    /// Largest table and arithmetic error of every set.
    pub sets: Vec<(ParitySet, [f64; 2])>,
    /// The pair with the largest table error, with its set.
    pub worst_table: Option<(ParitySet, WorstPair)>,
    /// The pair with the largest arithmetic error.
    pub worst_arithmetic: Option<(ParitySet, WorstPair)>,
    /// Parts of the error of the shader at the pair with the largest table error, largest first.
    pub parts: Vec<Part>,
    /// The form `baked` at random places, against f64 on the same tables; `None` for a material that is the same everywhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub places: Option<PlaceErrors>,
}

/// Whether an error keeps its tolerance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Verdict {
    /// The error keeps its tolerance.
    Met,
    /// The error breaks its tolerance, for a reason that is known and listed.
    Explained(&'static Known),
    /// The error breaks its tolerance.
    Broken,
}

impl ParityRow {
    /// The largest error of a share.
    pub fn max(&self, share: Share) -> f64 {
        match share {
            Share::Table => self.table.map_or(0.0, |table| table.max),
            Share::Arithmetic => self.arithmetic.max,
        }
    }

    /// Whether the largest error of a share keeps the tolerance of the model.
    pub fn verdict(&self, share: Share) -> Verdict {
        let max = self.max(share);
        if max <= tolerance(self.model, self.form, share, self.weights).limit {
            return Verdict::Met;
        }
        let factor = match share {
            Share::Table => self.parts.first().map(|part| part.cause.factor()),
            Share::Arithmetic => Some(Factor::Arithmetic),
        };
        let known = factor.and_then(|factor| known(self.model, share, factor));
        known.filter(|known| max <= known.limit).map_or(Verdict::Broken, Verdict::Explained)
    }

    /// Whether the shader agrees with f64 on its tables at random places: 99 of 100 samples within [`AT_PLACES`].
    pub fn holds_at_places(&self) -> bool {
        self.places.as_ref().is_none_or(|at| at.not_finite == 0 && at.relative_dim.p99 <= AT_PLACES)
    }

    /// Whether all samples are finite, and all tolerances are met or the reason is listed.
    pub fn holds(&self) -> bool {
        self.not_finite == 0
            && self.holds_at_places()
            && Share::ALL.into_iter().all(|share| self.verdict(share) != Verdict::Broken)
    }
}

impl Parity {
    /// A run of some rows.
    pub fn new(generator: &str, device: String, pairs_per_set: u32, rows: Vec<ParityRow>) -> Self {
        Self { generator: generator.to_owned(), device, pairs_per_set, floor: FLOOR, rows }
    }

    /// Whether all rows hold.
    pub fn holds(&self) -> bool {
        self.rows.iter().all(ParityRow::holds)
    }

    /// JSON, objects indented and arrays in a line, with a final newline.
    ///
    /// # Errors
    /// [`ReportError::Json`], should the writer fail.
    pub fn to_json(&self) -> Result<String, ReportError> {
        json::to_string(self)
    }

    /// A page in Markdown; `command` is the command line that makes it.
    pub fn to_markdown(&self, command: &str) -> String {
        page::markdown(self, command)
    }
}

/// Compares the shaders of a bake with their twins: a row for every case and form. `progress` is called after each case.
///
/// # Errors
/// See [`ReportError`].
pub fn parity(
    subject: &Subject<'_>,
    device: &dyn Device,
    cases: &[ParityCase],
    pairs_per_set: u32,
    progress: &mut dyn FnMut(),
) -> Result<Vec<ParityRow>, ReportError> {
    if pairs_per_set == 0 {
        return Err(ReportError::NoPairs);
    }
    subject.check()?;
    let mut rows = Vec::with_capacity(2 * cases.len());
    for case in cases {
        rows.extend(compare(subject, device, case, pairs_per_set)?);
        progress();
    }
    Ok(rows)
}

/// Values of one material at the pairs of a set.
struct Block {
    set: ParitySet,
    material: usize,
    pairs: Vec<Pair>,
    reference: Vec<Rgb>,
    /// Empty without this form.
    full_reference: Vec<Rgb>,
    /// f64 on the tables, with 8-bit and with exact weights.
    tables: [Vec<Rgb>; 2],
    baked: Vec<Rgb>,
    /// Empty without this form.
    full: Vec<Rgb>,
}

impl Block {
    fn read(&self, weights: Weights) -> &Vec<Rgb> {
        match weights {
            Weights::EightBit => &self.tables[0],
            Weights::Exact => &self.tables[1],
        }
    }
}

fn compare(
    subject: &Subject<'_>,
    device: &dyn Device,
    case: &ParityCase,
    pairs_per_set: u32,
) -> Result<Vec<ParityRow>, ReportError> {
    let mut numbers: Vec<u32> = std::iter::once(case.material).chain(case.polished.iter().copied()).collect();
    numbers.sort_unstable();
    numbers.dedup();
    // Energies of rough interfaces take seconds and are computed at their first use. Asking for them here computes all in parallel.
    let prepared: BTreeMap<u32, References> = numbers
        .into_par_iter()
        .map(|number| {
            let references = references(subject, number as usize);
            let model = subject.manifest.materials[number as usize].model;
            if model.is_statistical() {
                references.baked().veil();
            }
            if model.is_fitted() {
                references.baked().lobes();
            }
            Ok((number, references))
        })
        .collect::<Result<_, ReportError>>()?;
    let has_full = subject.manifest.materials[case.material as usize].model.has(Form::Full) && device.has(Form::Full);
    let mut blocks = Vec::new();
    let mut vote = WeightsVote::default();
    for set in ParitySet::ALL {
        let own = [case.material];
        let materials = if set == ParitySet::Smooth { case.polished.as_slice() } else { &own };
        let count = pairs_per_set.div_ceil(materials.len().max(1) as u32);
        for &number in materials {
            let material = number as usize;
            let Some(references) = prepared.get(&number) else { continue };
            let References { layers, twin, .. } = references;
            let pairs = set.pairs(count, layers);
            let tables =
                |weights| Ok::<_, ReportError>(evaluate(twin, &TableTerms::new(subject, material, weights)?, &pairs));
            let block = Block {
                set,
                material,
                reference: evaluate(twin, references.baked(), &pairs),
                full_reference: if has_full { evaluate(twin, references.full(), &pairs) } else { Vec::new() },
                tables: [tables(Weights::EightBit)?, tables(Weights::Exact)?],
                baked: run(device, Form::Baked, number, &pairs)?,
                full: if has_full { run(device, Form::Full, number, &pairs)? } else { Vec::new() },
                pairs,
            };
            vote.add(&block.baked, &block.tables[0], &block.tables[1]);
            blocks.push(block);
        }
    }
    let weights = vote.decide();
    let entry = &subject.manifest.materials[case.material as usize];
    let row = |form, compared: Compared, weights| {
        let Compared { total, table, arithmetic, sets } = compared;
        ParityRow {
            model: entry.model,
            form,
            material: case.name.clone(),
            color: entry.color,
            pairs: total.pairs,
            not_finite: total.not_finite,
            total: total.relative,
            table: table.as_ref().map(|(statistics, _)| statistics.relative),
            arithmetic: arithmetic.0.relative,
            weights,
            sets,
            worst_table: table.and_then(|(statistics, set)| Some((set?, statistics.worst?))),
            worst_arithmetic: arithmetic.1.zip(arithmetic.0.worst),
            parts: Vec::new(),
            places: None,
        }
    };
    let mut baked =
        row(Form::Baked, Compared::new(&blocks, |b| &b.baked, |b| &b.reference, Some(weights)), Some(weights));
    baked.parts = parts(subject, &blocks, weights, &baked, &prepared)?;
    let at = at_places(subject, case.material as usize, Some((device, weights)), pairs_per_set, PLACES_SEED)?;
    baked.places = at.and_then(|at| at.shader);
    let full =
        has_full.then(|| row(Form::Full, Compared::new(&blocks, |b| &b.full, |b| &b.full_reference, None), None));
    Ok(std::iter::once(baked).chain(full).collect())
}

fn references(subject: &Subject<'_>, material: usize) -> References {
    References::new(&subject.stacks[material], &subject.manifest.materials[material])
}

/// The parts of the largest table error.
fn parts(
    subject: &Subject<'_>,
    blocks: &[Block],
    weights: Weights,
    row: &ParityRow,
    references: &BTreeMap<u32, References>,
) -> Result<Vec<Part>, ReportError> {
    let Some((set, worst)) = &row.worst_table else { return Ok(Vec::new()) };
    let at = blocks.iter().filter(|block| block.set == *set).find_map(|block| {
        block.pairs.iter().position(|pair| *pair == (worst.wi, worst.wo)).map(|index| (block, index))
    });
    let Some((block, index)) = at else { return Ok(Vec::new()) };
    let Some(references) = references.get(&(block.material as u32)) else { return Ok(Vec::new()) };
    let tables = TableTerms::new(subject, block.material, weights)?;
    let twin: &Twin = &references.twin;
    let factors = Factors { twin, exact: references.baked(), tables: Some(&tables), on_device: false };
    let miss = Miss::at(block.pairs[index], worst.channel as usize, &block.baked[index], &block.reference[index]);
    Ok(factors.parts(&miss))
}

/// Errors over all sets.
struct Compared {
    total: Statistics,
    table: Option<(Statistics, Option<ParitySet>)>,
    arithmetic: (Statistics, Option<ParitySet>),
    sets: Vec<(ParitySet, [f64; 2])>,
}

impl Compared {
    fn new(
        blocks: &[Block],
        found: impl Fn(&Block) -> &Vec<Rgb>,
        reference: impl Fn(&Block) -> &Vec<Rgb>,
        weights: Option<Weights>,
    ) -> Self {
        let (mut pairs, mut all_found, mut all_reference, mut all_tables) = (vec![], vec![], vec![], vec![]);
        let mut ends = Vec::new();
        for block in blocks {
            pairs.extend_from_slice(&block.pairs);
            all_found.extend_from_slice(found(block));
            all_reference.extend_from_slice(reference(block));
            all_tables.extend_from_slice(weights.map_or_else(|| reference(block), |weights| block.read(weights)));
            ends.push((block.set, pairs.len()));
        }
        let with_set = |statistics: Statistics| {
            let pair = statistics.worst.as_ref().map(|w| (w.wi, w.wo));
            let index = pair.and_then(|pair| pairs.iter().position(|p| *p == pair));
            let set = index.and_then(|index| ends.iter().find(|(_, end)| index < *end)).map(|(set, _)| *set);
            (statistics, set)
        };
        let mut sets = Vec::new();
        for set in ParitySet::ALL {
            let mut max = [0.0_f64; 2];
            let mut start = 0;
            for (of, end) in &ends {
                let range = start..*end;
                start = *end;
                if *of == set {
                    let (p, f) = (&pairs[range.clone()], &all_found[range.clone()]);
                    let (r, t) = (&all_reference[range.clone()], &all_tables[range]);
                    max[0] = max[0].max(statistics(p, t, r).relative.max);
                    max[1] = max[1].max(statistics(p, f, t).relative.max);
                }
            }
            sets.push((set, max));
        }
        Self {
            total: statistics(&pairs, &all_found, &all_reference),
            table: weights.map(|_| with_set(statistics(&pairs, &all_tables, &all_reference))),
            arithmetic: with_set(statistics(&pairs, &all_found, &all_tables)),
            sets,
        }
    }
}
