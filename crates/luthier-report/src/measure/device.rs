//! The device side of a comparison: a runner of the emitted shaders, and the weights that it reads tables with.

use luthier_manifest::{Form, PlaceValues};
use luthier_optics::Rgb;
use serde::{Deserialize, Serialize};

use crate::error::ReportError;
use crate::measure::directions::Pair;
use crate::measure::statistics::{FLOOR, brightest, relative_error};
use crate::measure::table_terms::Weights;

/// A runner of the emitted shaders.
pub trait Device {
    /// Name of the adapter, as the report shows it.
    fn name(&self) -> String;

    /// Identity of the values beside the material's own numbers and texels: adapter, driver, text of the shaders. It is a part of the key under which
    /// a [`Memory`](crate::Memory) keeps results.
    fn identity(&self) -> String;

    /// Whether it has a shader of a form. That of the form `baked` is always there.
    fn has(&self, _form: Form) -> bool {
        true
    }

    /// `f cos_theta_i`, linear RGB, of a material for pairs `(wi, wo)` of unit directions: one value per pair, in
    /// order.
    ///
    /// # Errors
    /// The failure, in words for the user.
    fn evaluate(&self, form: Form, material: u32, pairs: &[Pair]) -> Result<Vec<[f32; 3]>, String>;

    /// [`Self::evaluate`] with a place of the surface for each pair.
    ///
    /// # Errors
    /// The failure, in words for the user.
    fn evaluate_at(&self, form: Form, material: u32, spots: &[(PlaceValues, Pair)]) -> Result<Vec<[f32; 3]>, String>;
}

/// The values of a device: one for each pair.
pub(crate) fn run(device: &dyn Device, form: Form, material: u32, pairs: &[Pair]) -> Result<Vec<Rgb>, ReportError> {
    checked(device.evaluate(form, material, pairs), form, material, pairs.len())
}

/// [`run`] with a place for each pair.
pub(crate) fn run_at(
    device: &dyn Device,
    form: Form,
    material: u32,
    spots: &[(PlaceValues, Pair)],
) -> Result<Vec<Rgb>, ReportError> {
    checked(device.evaluate_at(form, material, spots), form, material, spots.len())
}

fn checked(
    values: Result<Vec<[f32; 3]>, String>,
    form: Form,
    material: u32,
    asked: usize,
) -> Result<Vec<Rgb>, ReportError> {
    let values = values.map_err(|message| ReportError::Device { form, material, message })?;
    if values.len() != asked {
        return Err(ReportError::DeviceCount { form, material, asked, found: values.len() });
    }
    Ok(values.into_iter().map(|v| v.map(f64::from)).collect())
}

/// Vote on the interpolation weights of a device: the weights with the smaller sum of squared relative errors over all materials win.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
pub(crate) struct WeightsVote {
    eight_bit: f64,
    exact: f64,
}

impl WeightsVote {
    pub(crate) fn add(&mut self, device: &[Rgb], eight_bit: &[Rgb], exact: &[Rgb]) {
        for (sum, expected) in [(&mut self.eight_bit, eight_bit), (&mut self.exact, exact)] {
            let errors = device.iter().zip(expected).flat_map(|(d, e)| {
                let bright = brightest(e);
                [0, 1, 2].map(|c: usize| relative_error(d[c], e[c], bright, FLOOR))
            });
            *sum += errors.map(|e| e * e).filter(|e| e.is_finite()).sum::<f64>();
        }
    }

    /// Adds the sums of another vote.
    pub(crate) fn merge(&mut self, other: Self) {
        self.eight_bit += other.eight_bit;
        self.exact += other.exact;
    }

    pub(crate) fn decide(&self) -> Weights {
        if self.exact <= self.eight_bit { Weights::Exact } else { Weights::EightBit }
    }
}
