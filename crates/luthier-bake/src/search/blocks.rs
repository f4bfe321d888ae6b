//! Blocks of 4 x 4 texels beside texels by themselves, for `docs/pages/budgets.md`.

use luthier_lut::{Axis, Image, Mapping, SchlickBase, TexelFormat, WeightBits, bilinear};
use luthier_manifest::{Candidate, CandidateForm};
use luthier_optics::Rgb;
use rayon::prelude::*;

use super::grids::{self, Group};
use crate::graph::Results;
use crate::kinds::fresnel::RowShape;
use crate::kinds::fresnel::search::{Truth, price};
use crate::plan::Plan;
use crate::settings::axis;
use crate::tile::balance;

/// The format of blocks.
const BLOCKS: TexelFormat = TexelFormat::Bc6hRgbUfloat;

/// The fewest bytes within an error, of a group of tiles.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockStep {
    /// Whose tiles.
    pub group: &'static str,
    /// Largest absolute error as sampled, not counting what the function may be off itself.
    pub max_abs: f64,
    /// Candidate in a format of core WebGPU.
    pub texels: Option<Candidate>,
    /// Candidate in blocks of texels.
    pub blocks: Option<Candidate>,
}

/// Errors that are asked of tiles.
const TILE_LIMITS: [f64; 7] = [1e-1, 5e-2, 2e-2, 1e-2, 5e-3, 3e-3, 2e-3];

/// Albedo tiles of bare interfaces and of films, and film tiles, in all formats that the plan may take.
pub(crate) fn tiles(plan: &Plan, results: &Results) -> Vec<BlockStep> {
    let groups = [Group::BareAlbedo, Group::FilmAlbedo, Group::Film];
    let found = groups.map(|group| (group, grids::of_group(plan, results, group)));
    let step = |group: Group, candidates: &[Candidate], max_abs: f64| {
        let least = |in_blocks: bool| {
            let of = |c: &&Candidate| {
                let CandidateForm::Table { format, .. } = c.form else { return false };
                (format == BLOCKS) == in_blocks && (in_blocks || format.is_core()) && c.error.max_abs <= max_abs
            };
            candidates.iter().filter(of).min_by(|a, b| a.bytes.cmp(&b.bytes).then(a.cost.total_cmp(&b.cost))).cloned()
        };
        BlockStep { group: group.name(), max_abs, texels: least(false), blocks: least(true) }
    };
    let steps = found.iter().flat_map(|(group, candidates)| TILE_LIMITS.map(|limit| step(*group, candidates, limit)));
    steps.filter(|step| step.texels.is_some() || step.blocks.is_some()).collect()
}

/// The fewest bytes of one Fresnel row within an error of all rows.
#[derive(Debug, Clone, PartialEq)]
pub struct RowBlocks {
    /// Largest absolute error.
    pub max_abs: f64,
    /// Plain, four rows to a block; plain, a row repeated four times; the same two of what Schlick's form misses, whose coefficients are
    /// counted as three texels of half floats.
    pub bytes: [Option<u32>; 4],
}

const ROW_LIMITS: [f64; 6] = [2e-2, 1e-2, 5e-3, 2e-3, 1e-3, 5e-4];
const ROW_SIZES: [u32; 10] = [4, 8, 12, 16, 24, 32, 48, 64, 96, 128];
const ROW_EXPONENTS: [f64; 4] = [1.0, 2.0, 3.0, 4.0];

/// Bytes of the coefficients beside a row.
const COEFFICIENTS: u32 = SchlickBase::TEXELS * 8;

/// Points between two nodes.
const PER_CELL: u32 = 5;

/// Rows in blocks, in the order of their atlas.
pub(crate) fn rows(truths: &[&Truth]) -> Vec<RowBlocks> {
    let shapes: Vec<(u32, f64)> = ROW_SIZES.iter().flat_map(|&size| ROW_EXPONENTS.map(|e| (size, e))).collect();
    let measured: Vec<[(u32, f64); 4]> = shapes
        .into_par_iter()
        .map(|(size, exponent)| {
            let x = axis("cos_theta", "", [0.0, 1.0], size, Mapping::Power { exponent });
            [(false, true), (false, false), (true, true), (true, false)].map(|(over_schlick, is_shared)| {
                let bytes = if is_shared { size } else { 4 * size } + if over_schlick { COEFFICIENTS } else { 0 };
                (bytes, row_error(truths, &x, over_schlick, is_shared))
            })
        })
        .collect();
    let least = |way: usize, max_abs: f64| {
        measured.iter().map(|m| m[way]).filter(|(_, error)| *error <= max_abs).map(|(bytes, _)| bytes).min()
    };
    ROW_LIMITS.map(|max_abs| RowBlocks { max_abs, bytes: [0, 1, 2, 3].map(|way| least(way, max_abs)) }).to_vec()
}

/// A row to be put into blocks.
struct Row<'a> {
    truth: &'a Truth,
    texels: Image,
    /// Correction that a texel of 1 adds to the closed form, and that one of 0 takes off; none without the closed form.
    scale: Option<Rgb>,
}

impl<'a> Row<'a> {
    fn new(truth: &'a Truth, x: &Axis, over_schlick: bool) -> Self {
        let mut values = Image::zeros(x.size, 1, 3);
        for i in 0..x.size {
            let exact = truth.at(x.node(i));
            let base = if over_schlick { truth.fit.closed_form(x.node(i)) } else { [0.0; 3] };
            values.texel_mut(i, 0).copy_from_slice(&[0, 1, 2].map(|c: usize| (exact[c] - base[c]) as f32));
        }
        let mut texels = balance(&values, if over_schlick { f64::NEG_INFINITY } else { 0.0 });
        let scale = over_schlick.then(|| {
            let largest = |c: usize| texels.texels().map(|t| f64::from(t[c]).abs()).fold(f64::MIN_POSITIVE, f64::max);
            [0, 1, 2].map(largest)
        });
        if let Some(scale) = scale {
            for texel in texels.data.chunks_exact_mut(3) {
                texel.iter_mut().zip(scale).for_each(|(t, s)| *t = (0.5 + 0.5 * f64::from(*t) / s) as f32);
            }
        }
        Self { truth, texels, scale }
    }

    fn value(&self, cos_theta: f64, texel: [f64; 4]) -> Rgb {
        let base = self.truth.fit.closed_form(cos_theta);
        [0, 1, 2].map(|c: usize| self.scale.map_or(texel[c], |scale| base[c] + scale[c] * (2.0 * texel[c] - 1.0)))
    }
}

/// The largest error of rows in blocks.
fn row_error(truths: &[&Truth], x: &Axis, over_schlick: bool, is_shared: bool) -> f64 {
    let rows: Vec<Row<'_>> = truths.iter().map(|truth| Row::new(truth, x, over_schlick)).collect();
    let side = BLOCKS.block_side();
    let count = x.intervals() * PER_CELL;
    let mut worst = 0.0_f64;
    for rows in rows.chunks(if is_shared { side as usize } else { 1 }) {
        let stacked = (0..side as usize).flat_map(|j| rows[j % rows.len()].texels.data.iter().copied()).collect();
        let read = BLOCKS.quantise(&Image { width: x.size, height: side, channels: 3, data: stacked });
        for (j, row) in (0..).zip(rows) {
            for i in 0..=count {
                let cos_theta = x.decode(f64::from(i) / f64::from(count));
                let texel = bilinear(&read, [x.index(cos_theta) + 0.5, f64::from(j) + 0.5], WeightBits::Fixed(8));
                let (exact, found) = (row.truth.at(cos_theta), row.value(cos_theta, texel));
                worst = (0..3).map(|c| (found[c] - exact[c]).abs()).fold(worst, f64::max);
            }
        }
    }
    worst
}

/// The fewest bytes of one row within an error and a cost.
pub(crate) fn least_row(rows: &[(RowShape, f64)], max_abs: f64, max_cost: f64) -> Option<u32> {
    let bytes = |shape: &RowShape| (shape.axis.size + shape.base.header_texels()) * shape.format.texel_bytes();
    let holds = |(shape, error): &&(RowShape, f64)| *error <= max_abs && price(shape) <= max_cost;
    rows.iter().filter(holds).map(|(shape, _)| bytes(shape)).min()
}
