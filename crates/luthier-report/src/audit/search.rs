//! Search for the hypothesis that fits a table best.

use std::collections::BTreeSet;

use luthier_lut::{Image, Mapping};
use rayon::prelude::*;

use super::hypothesis::{Encoding, Hypothesis, arrangements};
use super::truth::Truth;
use luthier_table::{AxisSpec, Layout, Nodes, Quantity};

/// Cap on the error of a value in a fit. Without it, one wildly wrong corner would decide about the whole table.
const CAP: f64 = 0.25;
/// Factor by which a hypothesis must fit better for each additional mistake. Without it, a combination of mistakes that fits noise would win.
const PENALTY: f64 = 1.25;
/// Root mean square error below which hypotheses are not told apart: the error of the quadrature itself.
const FLOOR: f64 = 5e-5;
/// Texels along each axis in the first, second and last round.
const TEXELS: [u32; 3] = [12, 28, 16];
/// Hypotheses kept after the first round, and after the second.
const KEPT: [usize; 2] = [40, 8];
/// Least roughness that tables may stop at: 0.045 and 0.089 are Filament's for 32-bit and 16-bit floats.
const FLOORS: [f64; 10] = [0.01, 0.02, 0.03, 0.04, 0.045, 0.05, 0.0625, 0.08, 0.089, 0.1];

/// A hypothesis with its fit.
#[derive(Debug, Clone)]
pub(super) struct Fit {
    pub(super) hypothesis: Hypothesis,
    pub(super) mistakes: usize,
    /// Root mean square over texels, each error at most [`CAP`].
    pub(super) rms: f64,
    score: f64,
}

/// The table under judgement: the picked channels of its file, in the order of the statement.
pub(super) struct Subject<'a> {
    pub(super) image: &'a Image,
    pub(super) channels: &'a [usize],
    /// Root mean square error of rounding to the format.
    pub(super) rounding: f64,
}

impl Subject<'_> {
    fn size(&self) -> [u32; 2] {
        [self.image.width, self.image.height]
    }

    /// Texels spread evenly, the first and the last of both axes among them, with their values.
    fn texels(&self, most: u32) -> Vec<([u32; 2], Vec<f64>)> {
        let [xs, ys] = self.size().map(|size: u32| -> Vec<u32> {
            let count = size.min(most);
            (0..count).map(|i| if count < 2 { 0 } else { i * (size - 1) / (count - 1) }).collect()
        });
        // A single row may spend the texels of all rows.
        let xs = if ys.len() == 1 { spread(self.image.width, most * most) } else { xs };
        let ys = if xs.len() == 1 { spread(self.image.height, most * most) } else { ys };
        let places = ys.iter().flat_map(|&y| xs.iter().map(move |&x| [x, y]));
        let texels = places.map(|[x, y]| ([x, y], self.image.texel(x, y)));
        texels.map(|(at, texel)| (at, self.channels.iter().map(|&c| f64::from(texel[c])).collect())).collect()
    }

    fn has_negative(&self) -> bool {
        self.image.texels().any(|texel| self.channels.iter().any(|&c| texel[c] < 0.0))
    }
}

fn spread(size: u32, most: u32) -> Vec<u32> {
    let count = size.min(most).max(1);
    (0..count)
        .map(|i| if count < 2 { 0 } else { (u64::from(i) * u64::from(size - 1) / u64::from(count - 1)) as u32 })
        .collect()
}

/// Hypotheses in the order of their fit, the stated one among them. The result does not depend on the number of threads.
pub(super) fn search(subject: &Subject, stated: &Hypothesis, truth: &Truth) -> Vec<Fit> {
    let mut fits = coarse(subject, stated, truth);
    let texels = subject.texels(TEXELS[1]);
    for _ in 0..2 {
        let mut all: Vec<Hypothesis> = vec![stated.clone()];
        for fit in &fits {
            all.push(fit.hypothesis.clone());
            all.extend(neighbours(&fit.hypothesis, stated));
        }
        let negative = subject.has_negative();
        if negative {
            all.extend(all.clone().into_iter().map(|h| Hypothesis { clamped: true, ..h }));
        }
        fits = all.into_par_iter().map(|h| judge(subject, stated, truth, h, &texels, false)).collect();
        rank(&mut fits, KEPT[0]);
    }
    fits.truncate(KEPT[1]);
    if !fits.iter().any(|fit| fit.hypothesis == *stated) {
        fits.push(judge(subject, stated, truth, stated.clone(), &texels, false));
    }
    let texels = subject.texels(TEXELS[2]);
    let mut fits: Vec<Fit> =
        fits.into_par_iter().map(|fit| judge(subject, stated, truth, fit.hypothesis, &texels, true)).collect();
    rank(&mut fits, KEPT[1] + 1);
    fits
}

/// Sorts by score and removes duplicates.
fn rank(fits: &mut Vec<Fit>, kept: usize) {
    fits.sort_by(|a, b| a.score.total_cmp(&b.score).then(a.mistakes.cmp(&b.mistakes)));
    let mut seen = BTreeSet::new();
    fits.retain(|fit| seen.insert(format!("{:?}", fit.hypothesis)));
    fits.truncate(kept);
}

/// All layouts with all models, channels and encodings over a few texels.
fn coarse(subject: &Subject, stated: &Hypothesis, truth: &Truth) -> Vec<Fit> {
    let texels = subject.texels(TEXELS[0]);
    let terms = arrangements(&stated.terms, truth.terms());
    let layouts = layouts(&stated.layout, subject.size());
    let mut fits: Vec<Fit> = layouts
        .into_par_iter()
        .flat_map_iter(|layout| {
            let places: Vec<[f64; 2]> =
                texels.iter().map(|(texel, _)| layout.at_texel(subject.size(), *texel)).collect();
            let mut found = Vec::new();
            for variant in 0..truth.variants.len() {
                let components: Vec<[f64; 3]> = places.iter().map(|at| truth.fast(variant, *at)).collect();
                for terms in &terms {
                    for encoding in Encoding::ALL {
                        let h = Hypothesis { layout, variant, terms: terms.clone(), encoding, clamped: false };
                        let mut squares = 0.0;
                        for (((_, values), components), at) in texels.iter().zip(&components).zip(&places) {
                            squares += squared_errors(&h, values, *components, at[1]);
                        }
                        found.push(fit(subject, stated, truth, h, squares, texels.len()));
                    }
                }
            }
            // Later rounds try the neighbours of each survivor: a few hypotheses can stand for a layout.
            found.sort_by(|a, b| a.score.total_cmp(&b.score));
            found.truncate(6);
            found
        })
        .collect();
    rank(&mut fits, KEPT[0]);
    fits
}

fn squared_errors(h: &Hypothesis, values: &[f64], components: [f64; 3], alpha: f64) -> f64 {
    let errors = values.iter().enumerate().map(|(c, &stored)| {
        let off = (h.comparable(c, stored, alpha) - h.terms[c].of(components)).abs();
        // Written so that NaN counts as the cap.
        let off = if off < CAP { off } else { CAP };
        off * off
    });
    errors.sum()
}

fn fit(
    subject: &Subject,
    stated: &Hypothesis,
    truth: &Truth,
    hypothesis: Hypothesis,
    squares: f64,
    texels: usize,
) -> Fit {
    let rms = (squares / (texels * subject.channels.len()).max(1) as f64).sqrt();
    let mistakes = hypothesis.mistakes(stated, truth).len();
    let told_apart = (rms * rms + subject.rounding * subject.rounding + FLOOR * FLOOR).sqrt();
    Fit { hypothesis, mistakes, rms, score: told_apart * libm::pow(PENALTY, mistakes as f64) }
}

fn judge(
    subject: &Subject,
    stated: &Hypothesis,
    truth: &Truth,
    h: Hypothesis,
    texels: &[([u32; 2], Vec<f64>)],
    exact: bool,
) -> Fit {
    let mut squares = 0.0;
    for (texel, values) in texels {
        let at = h.layout.at_texel(subject.size(), *texel);
        let components = if exact { truth.exact(h.variant, at) } else { truth.fast(h.variant, at) };
        squares += squared_errors(&h, values, components, at[1]);
    }
    fit(subject, stated, truth, h, squares, texels.len())
}

/// All layouts of the first round: axes swapped or not, both flips, equal nodes on both axes, any quantity of each axis.
fn layouts(stated: &Layout, size: [u32; 2]) -> Vec<Layout> {
    let nodes = &Nodes::MISTAKEN[..4];
    let mut all = vec![*stated];
    let turned = [false, true].map(|turn| stated.transposed != turn);
    for transposed in if stated.slope.is_some() { &turned[..] } else { &turned[..1] } {
        for angle in alternatives(&stated.angle, &Quantity::ANGLES, nodes) {
            match stated.slope {
                None => all.push(Layout { angle, slope: None, transposed: *transposed }),
                Some(slope) => {
                    // A statement may have different nodes on both axes; alternatives have equal ones.
                    for slope in alternatives(&slope, &Quantity::SLOPES, &[angle.nodes]) {
                        all.push(Layout { angle, slope: Some(slope), transposed: *transposed });
                    }
                }
            }
        }
    }
    all.retain(|layout| layout.slope.is_some() || size[layout.order()[0]] > 1);
    all
}

fn alternatives(stated: &AxisSpec, quantities: &[Quantity], nodes: &[Nodes]) -> Vec<AxisSpec> {
    let plain = quantities
        .iter()
        .filter(|q| **q != stated.quantity || stated.mapping != Mapping::Linear)
        .map(|q| AxisSpec::whole(*q, stated.nodes));
    let mut all = Vec::new();
    for axis in std::iter::once(*stated).chain(plain) {
        for &nodes in nodes {
            for descending in [stated.descending, !stated.descending] {
                all.push(AxisSpec { descending, nodes, ..axis });
            }
        }
    }
    all
}

/// Hypotheses one step away: other nodes of one axis or both, another start of the slope axis, another floor.
fn neighbours(h: &Hypothesis, stated: &Hypothesis) -> Vec<Hypothesis> {
    let mut layouts = Vec::new();
    let layout = h.layout;
    for nodes in Nodes::MISTAKEN {
        let angle = AxisSpec { nodes, ..layout.angle };
        layouts.push(Layout { angle, ..layout });
        if let Some(slope) = layout.slope {
            let slope = Some(AxisSpec { nodes, ..slope });
            layouts.push(Layout { slope, ..layout });
            layouts.push(Layout { angle, slope, ..layout });
        }
    }
    if let Some(slope) = layout.slope {
        for roughness in FLOORS {
            let value = slope.quantity.of_canonical(roughness * roughness);
            layouts.push(Layout { slope: Some(AxisSpec { floor: value, ..slope }), ..layout });
            if slope.mapping != Mapping::Logarithmic {
                layouts.push(Layout { slope: Some(AxisSpec { min: value, ..slope }), ..layout });
            }
        }
        let same = stated.layout.slope.filter(|s| s.quantity == slope.quantity && s.mapping == slope.mapping);
        let plain = same.map_or(0.0, |s| s.min);
        layouts.push(Layout { slope: Some(AxisSpec { floor: 0.0, min: plain, ..slope }), ..layout });
    }
    layouts.into_iter().map(|layout| Hypothesis { layout, ..h.clone() }).collect()
}
