//! Closed forms under a table of what they lack.

use luthier_optics::split_sum::SplitSum;

use crate::ClosedForm;

/// A closed form to which the texels of a table are added.
///
/// A channel is the form's content of it and (2 texel - 1) amplitude, so that rests to both sides of 0 have texels in 0..1, which bytes hold: the rest
/// of a form that errs by 5e-3 is rounded by 2e-5. A rest is also smoother than the function, hence takes fewer texels.
#[derive(Debug, Clone, PartialEq)]
pub struct Base {
    /// The form, which is computed in single precision.
    pub form: ClosedForm,
    /// The largest rest that a texel in 0..1 holds, above 0.
    pub amplitude: f64,
}

impl Base {
    /// The value of a texel for a content, where the form has another.
    pub(crate) fn texel(&self, content: f64, of_form: f64) -> f64 {
        0.5 + 0.5 * (content - of_form) / self.amplitude
    }

    /// The content that a texel makes of the form's.
    pub(crate) fn content(&self, texel: f64, of_form: f64) -> f64 {
        of_form + (2.0 * texel - 1.0) * self.amplitude
    }

    /// The split sum of the form.
    pub(crate) fn sum(&self, alpha: f64, cos_theta: f64) -> SplitSum {
        let [scale, bias] = self.form.eval_f32(cos_theta as f32, alpha as f32).map(f64::from);
        SplitSum { scale, bias }
    }
}
