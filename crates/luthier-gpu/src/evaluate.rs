//! Evaluation of `luthier_eval` for arrays of pairs of directions.

use crate::context::Pass;
use crate::{GpuError, Scene};

/// Threads of a workgroup in the evaluation and look-up kernels.
pub(crate) const WORKGROUP: usize = 64;

/// Elements per submission: 8 MiB of pairs, and at most a quarter of a second's work on a software adapter.
pub(crate) const CHUNK: usize = 1 << 18;

impl Scene {
    /// `luthier_eval` of a material for pairs `(wi, wo)`: unit vectors in the local frame, away from the surface. Gives
    /// `f cos_theta_i`, linear RGB, in the order of the pairs; any number of them.
    ///
    /// # Errors
    /// [`GpuError::NoMaterial`], and whatever the device reports.
    pub fn evaluate(&self, material: u32, pairs: &[([f32; 3], [f32; 3])]) -> Result<Vec<[f32; 3]>, GpuError> {
        self.layers(material)?;
        self.values("evaluation", &self.evaluate, pairs, |chunk| pair_words(material, chunk))
    }

    /// Runs a kernel that gives one colour for each element; `words` encodes elements for the kernel's input.
    pub(crate) fn values<T, W: bytemuck::NoUninit>(
        &self,
        what: &'static str,
        pipeline: &wgpu::ComputePipeline,
        elements: &[T],
        words: impl Fn(&[T]) -> Vec<W>,
    ) -> Result<Vec<[f32; 3]>, GpuError> {
        let mut values = Vec::with_capacity(elements.len());
        for chunk in elements.chunks(CHUNK) {
            let out = self.context.run(&Pass {
                what,
                pipeline,
                shader_group: &self.group,
                workgroups: [chunk.len().div_ceil(WORKGROUP) as u32, 1],
                inputs: bytemuck::cast_slice(&words(chunk)),
                output_words: chunk.len(),
            })?;
            values.extend(out.into_iter().map(|[r, g, b, _]| [r, g, b]));
        }
        Ok(values)
    }
}

/// Pairs of directions of a material as kernels read them.
pub(crate) fn pair_words(material: u32, pairs: &[([f32; 3], [f32; 3])]) -> Vec<[u32; 8]> {
    let words = pairs.iter().map(|(wi, wo)| (wi.map(f32::to_bits), wo.map(f32::to_bits)));
    words.map(|([ix, iy, iz], [ox, oy, oz])| [ix, iy, iz, material, ox, oy, oz, 0]).collect()
}
