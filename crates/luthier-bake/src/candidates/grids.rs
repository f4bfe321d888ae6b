//! Tables with two axes and costly values: one fine grid of each tile is computed, and coarser tables are interpolated
//! from it.

use luthier_lut::{Axis, Image, RowBase, TableKind, TexelFormat};
use luthier_manifest::{Candidate, CandidateForm, MeasuredError};
use rayon::prelude::*;

use super::{WEIGHTS, cost, measured};
use crate::grid::resampled;
use crate::tile::lone_tile;

/// A tile on its fine grid, and points off it.
pub(crate) struct Fine {
    pub(crate) kind: TableKind,
    pub(crate) grid: [Axis; 2],
    pub(crate) image: Image,
    /// Axis values, and the function there.
    pub(crate) probes: Vec<([f64; 2], [f64; 4])>,
    /// Channels that are compared.
    pub(crate) channels: usize,
    /// Error of the function itself.
    pub(crate) slack: f64,
}

impl Fine {
    /// The tile on other axes.
    fn on(&self, axes: &[Axis; 2]) -> Image {
        if *axes == self.grid { self.image.clone() } else { resampled(&self.image, &self.grid, axes) }
    }

    /// The error of the tile in a format, from its image on these axes.
    fn error(&self, image: &Image, axes: &[Axis; 2], format: TexelFormat, colors: bool) -> MeasuredError {
        let channels = self.channels.min(format.channels() as usize);
        let atlas = lone_tile(self.kind, &[&axes[0], &axes[1]], format, image);
        let points = self.probes.iter().map(|(at, value)| (at, *value));
        measured(points, channels, colors, self.slack, |at| atlas.sample(0, at, WEIGHTS))
    }
}

/// The errors of tiles in this form, in their order.
pub(crate) fn errors(tiles: &[Fine], form: &CandidateForm) -> Vec<(usize, MeasuredError)> {
    let CandidateForm::Table { x, y: Some(y), format, .. } = form else { return Vec::new() };
    let axes = [x.clone(), y.clone()];
    tiles.iter().map(|tile| tile.error(&tile.on(&axes), &axes, *format, true)).enumerate().collect()
}

/// Tables with these axes in these formats, as far as blocks of texels fill their sides.
pub(crate) fn candidates(
    tiles: &[Fine],
    axes: Vec<[Axis; 2]>,
    formats: &[TexelFormat],
    colors: bool,
) -> Vec<Candidate> {
    let measured: Vec<Vec<Candidate>> = axes
        .into_par_iter()
        .map(|axes| {
            let images: Vec<Image> = tiles.iter().map(|tile| tile.on(&axes)).collect();
            let whole = formats.iter().filter(|format| axes.iter().all(|a| a.size.is_multiple_of(format.block_side())));
            whole.map(|&format| candidate(tiles, &images, &axes, format, colors)).collect()
        })
        .collect();
    measured.concat()
}

/// The candidate of one table, from the images of all tiles on its axes.
fn candidate(tiles: &[Fine], images: &[Image], axes: &[Axis; 2], format: TexelFormat, colors: bool) -> Candidate {
    let errors = tiles.iter().zip(images).map(|(tile, image)| tile.error(image, axes, format, colors));
    let error = errors.reduce(|a, b| a.max(&b)).unwrap_or_default();
    let [x, y] = axes.clone();
    let form = CandidateForm::Table { x, y: Some(y), format, base: RowBase::Zero };
    Candidate { bytes: form.bytes(tiles.len() as u32), cost: price(axes, format), error, form }
}

/// The cost of a look-up.
pub(crate) fn price(axes: &[Axis; 2], format: TexelFormat) -> f64 {
    axes.iter().map(cost::axis).sum::<f64>() + cost::read(format)
}
