//! Look-up of a table of reflectances as WGSL.

use std::fmt::Write as _;

use super::{Bindings, axis, float};
use crate::{FresnelTable, Quantity};

/// Name of the function.
pub const REFLECTANCE: &str = "luthier_reflectance";
/// Name of its texture.
pub const REFLECTANCE_TEXTURE: &str = "luthier_reflectance_table";
/// Name of its sampler.
pub const REFLECTANCE_SAMPLER: &str = "luthier_reflectance_sampler";

impl FresnelTable {
    /// WGSL of `fn luthier_reflectance(cos_theta: f32, ior_n: f32, ior_k: f32) -> f32`, which reads this table. None if
    /// an axis is periodic.
    ///
    /// The text declares the texture [`REFLECTANCE_TEXTURE`] and the sampler [`REFLECTANCE_SAMPLER`], which must filter
    /// linearly and clamp to the edge. The function reads twice, in the two nearest slices. Values beyond an axis are
    /// read at its end.
    pub fn wgsl(&self, bindings: Bindings) -> Option<String> {
        let Bindings { group, texture, sampler } = bindings;
        let [width, rows, slices] = self.size;
        let mut out = format!(
            "@group({group}) @binding({texture}) var {REFLECTANCE_TEXTURE}: texture_2d<f32>;\n\
             @group({group}) @binding({sampler}) var {REFLECTANCE_SAMPLER}: sampler;\n\n\
             /// Reflectance of a smooth surface of index n + ik in air, for unpolarised light.\n\
             /// Linear filter, clamp to edge; slices of the third axis lie one below the other.\n\
             /// Table: {} over {}; {width} x {rows} x {slices}, {}.\n\
             fn {REFLECTANCE}(cos_theta: f32, ior_n: f32, ior_k: f32) -> f32 {{\n",
            "reflectance",
            self.layout,
            self.stored.name(),
        );
        for ((name, spec), size) in ["x", "row", "depth"].into_iter().zip(self.layout.axes()).zip(self.size) {
            let input = match spec.quantity {
                Quantity::IorN => "ior_n",
                Quantity::IorK => "ior_k",
                _ => "cos_theta",
            };
            axis::write(&mut out, name, spec, input, size)?;
        }
        // Rows keep half a texel away from the neighbouring slices.
        let [rows, slices] = [rows, slices].map(f64::from);
        let (edge, last, share) = (float(0.5 / rows), float(slices - 1.0), float(1.0 / slices));
        let [count, far] = [float(slices), float(1.0 - 0.5 / rows)];
        let _ = write!(
            out,
            "    let y = clamp(row, {edge}, {far});\n    \
             let place = clamp(depth * {count} - 0.5, 0.0, {last});\n    \
             let slice = floor(place);\n    \
             let near = textureSampleLevel({REFLECTANCE_TEXTURE}, {REFLECTANCE_SAMPLER}, vec2<f32>(x, (slice + y) * {share}), 0.0).r;\n    \
             let next = min(slice + 1.0, {last});\n    \
             let far = textureSampleLevel({REFLECTANCE_TEXTURE}, {REFLECTANCE_SAMPLER}, vec2<f32>(x, (next + y) * {share}), 0.0).r;\n    \
             return mix(near, far, place - slice);\n}}\n"
        );
        Some(out)
    }
}
