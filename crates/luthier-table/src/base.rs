//! Closed forms under a table that holds the difference to the exact function.

use luthier_optics::split_sum::SplitSum;

use crate::ClosedForm;

/// A closed form to which the texels of a table are added.
///
/// A channel is the form's value plus texel * scale + offset. The texels hold the *rest*: the difference of the exact
/// function to the form. A rest is straighter than the function and takes fewer texels. If it is small, bytes hold it:
/// the rest of a form that errs by 5e-3 is rounded by 2e-5.
#[derive(Debug, Clone, PartialEq)]
pub struct Base {
    /// The form, computed in single precision.
    pub form: ClosedForm,
    /// Factor of texels, above 0.
    pub scale: f64,
    /// Summand after the factor.
    pub offset: f64,
}

impl Base {
    /// A base whose texels are the rests themselves, for floats.
    pub fn plain(form: ClosedForm) -> Self {
        Self { form, scale: 1.0, offset: 0.0 }
    }

    /// A base with texels in 0..1, for rests of up to an amplitude to both sides of 0.
    pub fn normalised(form: ClosedForm, amplitude: f64) -> Self {
        Self { form, scale: 2.0 * amplitude, offset: -amplitude }
    }

    /// Whether texels are the rests themselves.
    pub fn is_plain(&self) -> bool {
        self.scale == 1.0 && self.offset == 0.0
    }

    /// The texel that adds up to a content over a value of the form.
    pub(crate) fn texel(&self, content: f64, of_form: f64) -> f64 {
        (content - of_form - self.offset) / self.scale
    }

    /// The content of a texel added to a value of the form.
    pub(crate) fn content(&self, texel: f64, of_form: f64) -> f64 {
        of_form + (texel * self.scale + self.offset)
    }

    /// The split sum of the form.
    pub(crate) fn sum(&self, alpha: f64, cos_theta: f64) -> SplitSum {
        self.form.read(cos_theta, alpha)
    }
}
