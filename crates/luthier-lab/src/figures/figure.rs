//! Definition of a figure, and its results.

use luthier_gpu::ToneMapping;
use luthier_lut::Image;
use luthier_report::{PictureComparison, Plot, brightened_difference, compare_pictures, sheet};
use luthier_terminal::{Failure, Outcome};

use super::claim::Claim;
use super::numbers::pixels;
use super::studio::Studio;

/// A figure of a paper, and the function that makes it anew.
#[derive(Clone, Copy)]
pub(crate) struct Figure {
    pub(crate) name: &'static str,
    pub(crate) title: &'static str,
    /// Paper and number there.
    pub(crate) source: &'static str,
    /// Text below the figure: its content in the paper, differences here, and what to see.
    pub(crate) caption: &'static str,
    /// Judgement of the pictures by eye, beside the caption in the paper.
    pub(crate) seen: &'static str,
    /// Side of each single picture in pixels, where the command line has none.
    pub(crate) size: u32,
    pub(crate) claim: Claim,
    pub(crate) make: fn(&Studio, &mut Made) -> Outcome,
}

/// Results of a figure.
#[derive(Default)]
pub(crate) struct Made {
    pub(crate) files: Vec<(String, Content)>,
    pub(crate) measured: Vec<Measured>,
}

pub(crate) enum Content {
    /// A picture as a display shows it, before its transfer function.
    Picture(Image),
    Plot(Plot),
}

/// A number of this run.
pub(crate) struct Measured {
    pub(crate) what: String,
    pub(crate) value: f64,
}

/// Pictures with the labels below them.
pub(crate) type Labelled = Vec<(String, Image)>;

/// Side of a picture of two or three on a sheet.
pub(crate) const LARGE: u32 = 512;

/// Side of a picture of three in a row, in several rows.
pub(crate) const MEDIUM: u32 = 352;

/// Side of a picture of many on a sheet.
pub(crate) const SMALL: u32 = 256;

/// Side of a picture that is simulated: minutes on a software adapter.
pub(crate) const SIMULATED: u32 = 128;

/// Tone curve of all pictures.
pub(crate) const TONE: ToneMapping = ToneMapping::Shoulder;

impl Made {
    /// Adds a sheet of linear pictures.
    pub(crate) fn sheet<L: Into<String>>(
        &mut self,
        file: &str,
        pictures: impl IntoIterator<Item = (L, Image)>,
        columns: u32,
    ) {
        let shown = pictures.into_iter().map(|(label, image)| (label.into(), TONE.image(image)));
        self.shown(file, shown.collect(), columns);
    }

    /// Adds a sheet of pictures that are as a display shows them.
    pub(crate) fn shown(&mut self, file: &str, pictures: Labelled, columns: u32) {
        self.files.push((format!("{file}.png"), Content::Picture(sheet(&pictures, columns))));
    }

    /// Adds one linear picture without a name below.
    pub(crate) fn picture(&mut self, file: &str, picture: Image) {
        self.files.push((format!("{file}.png"), Content::Picture(TONE.image(picture))));
    }

    pub(crate) fn plot(&mut self, file: &str, plot: Plot) {
        self.files.push((format!("{file}.svg"), Content::Plot(plot)));
    }

    pub(crate) fn measure(&mut self, what: impl Into<String>, value: f64) {
        self.measured.push(Measured { what: what.into(), value });
    }

    /// Notes the visible difference of two linear pictures.
    pub(crate) fn apart(&mut self, what: &str, a: &Image, b: &Image) -> Outcome {
        self.measure(format!("{what}: mean FLIP"), compared(a, b)?.flip_mean);
        Ok(())
    }

    /// Notes the errors of a linear picture against another: RMSE, and FLIP.
    pub(crate) fn errors(&mut self, what: &str, a: &Image, b: &Image) -> Outcome {
        let compared = compared(a, b)?;
        self.measure(format!("{what}: RMSE of linear radiance"), compared.rms_err);
        self.measure(format!("{what}: mean FLIP"), compared.flip_mean);
        Ok(())
    }

    /// Compares two linear pictures, and notes RMSE, largest difference and FLIP. Returns their brightened difference on a display, with its label.
    pub(crate) fn compare(&mut self, what: &str, a: &Image, b: &Image) -> Outcome<(String, Image)> {
        self.errors(what, a, b)?;
        let (shown, gain) = brightened_difference(a, b, |v| TONE.value(v));
        let largest = shown.data.iter().copied().fold(0.0, f32::max) / gain as f32;
        self.measure(format!("{what}: largest difference of what a display shows"), f64::from(largest));
        Ok((format!("diff. x{gain}"), shown))
    }
}

/// Two linear pictures as a display shows them.
pub(crate) fn compared(a: &Image, b: &Image) -> Outcome<PictureComparison> {
    compare_pictures(a, b, |v| TONE.value(v)).map_err(Failure::input)
}

/// Some channels of an image as a square picture, enlarged without filtering.
pub(crate) fn enlarged(image: &Image, size: u32, channels: [usize; 3]) -> Image {
    let mut large = Image::zeros(size, size, 3);
    for (x, y) in pixels(&large) {
        let texel = image.texel(x * image.width / size, y * image.height / size);
        large.texel_mut(x, y).copy_from_slice(&channels.map(|channel| texel[channel]));
    }
    large
}
