//! The second picture, beside the material's own: its maker, the divider, and the difference of the two.

use luthier_gpu::ToneMapping;
use luthier_lut::Image;
use luthier_manifest::{Form, ShadingModel};

use crate::host::Differences;
use crate::work::baker::Way;
use crate::work::crop::shown;
use crate::work::gathering::Progress;

/// Maker of the second picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Against {
    /// A shader. Its model and form are those of the first picture unless stated.
    Shader {
        /// Its model.
        model: Option<ShadingModel>,
        /// Its form.
        form: Option<Form>,
    },
    /// The simulation of the layers on the device.
    Simulation,
}

/// How two pictures are shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Comparison {
    /// Maker of the second picture; `None` shows the first alone.
    pub against: Option<Against>,
    /// Paths of each pixel at which a simulated picture ends.
    pub paths: u32,
    /// Share of the width at which the second picture begins, 0 to 1.
    pub divider: f32,
    /// Whether the difference is shown in place of the two.
    pub difference: bool,
    /// Factor on the difference.
    pub gain: f32,
}

/// Factors on a difference.
pub(crate) const GAIN: std::ops::RangeInclusive<f32> = 1.0..=1024.0;

/// Step of the divider for a key, as a share of the width.
const DIVIDER_STEP: f32 = 0.05;

impl Default for Comparison {
    fn default() -> Self {
        Self { against: None, paths: 1024, divider: 0.5, difference: false, gain: 8.0 }
    }
}

impl Comparison {
    /// Moves the divider by steps to the right.
    pub(crate) fn move_divider(&mut self, steps: f32) {
        self.divider = (self.divider + DIVIDER_STEP * steps).clamp(0.0, 1.0);
    }

    /// The maker of the second picture if the first is of a form.
    pub(crate) fn way(&self, form: Form) -> Option<Way> {
        self.against.map(|against| match against {
            Against::Shader { form: own, .. } => Way::Shader(own.unwrap_or(form)),
            Against::Simulation => Way::Simulation,
        })
    }

    /// True where the second picture has another form and no model of its own, so that the material's model needs both forms.
    pub(crate) fn is_of_forms(&self, form: Form) -> bool {
        matches!(self.against, Some(Against::Shader { model: None, form: Some(other) }) if other != form)
    }
}

/// Progress of a comparison in words: paths and noise, then distances.
pub(crate) fn report(progress: Option<Progress>, differences: Option<Differences>) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(Progress { paths, goal, noise }) = progress {
        // One path of a pixel has no spread.
        let noise = if paths > 1 { format!(", noise {noise:.2e}") } else { String::new() };
        lines.push(format!("{paths} of {goal} paths per pixel{noise}"));
    }
    if let Some(Differences { rms_err, flip_mean }) = differences {
        lines.push(format!("RMSE {rms_err:.2e}, FLIP {flip_mean:.4}"));
    }
    lines
}

/// Absolute difference of two linear pictures of one size, times a factor, in sRGB; `None` where their sizes differ.
pub(crate) fn difference(a: &Image, b: &Image, gain: f32) -> Option<Vec<u8>> {
    if (a.width, a.height, a.channels) != (b.width, b.height, b.channels) {
        return None;
    }
    let mut image = a.clone();
    image.data.iter_mut().zip(&b.data).for_each(|(a, b)| *a = gain * (*a - *b).abs());
    Some(shown(&image, ToneMapping::None))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(width: u32, values: &[f32]) -> Image {
        Image { width, height: 1, channels: 3, data: values.to_vec() }
    }

    #[test]
    fn equal_pictures_have_no_difference() {
        let a = image(2, &[0.1, 0.5, 4.0, 0.0, 1.0, 0.25]);
        assert_eq!(difference(&a, &a, 1024.0), Some(vec![0; 6]));
    }

    #[test]
    fn differences_are_linear_and_multiplied() {
        let a = image(1, &[0.5, 0.25, 4.0]);
        let b = image(1, &[0.375, 0.5, 4.0]);
        // 0.5 in linear light is 188 in sRGB; values above 1 are clipped.
        assert_eq!(difference(&a, &b, 4.0), Some(vec![188, 255, 0]));
        assert_eq!(difference(&a, &b, 8.0), Some(vec![255, 255, 0]));
        assert_eq!(difference(&b, &a, 4.0), difference(&a, &b, 4.0));
        assert_eq!(difference(&a, &image(2, &[0.0; 6]), 1.0), None);
    }

    #[test]
    fn the_divider_stays_in_the_picture() {
        let mut comparison = Comparison::default();
        (0..50).for_each(|_| comparison.move_divider(1.0));
        assert_eq!(comparison.divider, 1.0);
        (0..50).for_each(|_| comparison.move_divider(-1.0));
        assert_eq!(comparison.divider, 0.0);
    }

    #[test]
    fn sides_are_named_by_what_makes_them() {
        let against = |against| Comparison { against: Some(against), ..Comparison::default() };
        let other_form = against(Against::Shader { model: None, form: Some(Form::Full) });
        assert_eq!(other_form.way(Form::Baked), Some(Way::Shader(Form::Full)));
        assert!(other_form.is_of_forms(Form::Baked) && !other_form.is_of_forms(Form::Full));
        let model = against(Against::Shader { model: Some(ShadingModel::Belcour), form: None });
        assert_eq!(model.way(Form::Full), Some(Way::Shader(Form::Full)));
        assert!(!model.is_of_forms(Form::Full));
        assert_eq!(against(Against::Simulation).way(Form::Full), Some(Way::Simulation));
        assert_eq!(Comparison::default().way(Form::Full), None);
    }

    #[test]
    fn reports_say_paths_and_noise() {
        let progress = |paths| Some(Progress { paths, goal: 64, noise: 0.0123 });
        assert_eq!(report(progress(1), None), ["1 of 64 paths per pixel"]);
        let differences = Some(Differences { rms_err: 0.00456, flip_mean: 0.0321 });
        let lines = report(progress(32), differences);
        assert_eq!(lines, ["32 of 64 paths per pixel, noise 1.23e-2", "RMSE 4.56e-3, FLIP 0.0321"]);
    }
}
