//! Reads of the tables through the shader's own look-up functions.

use luthier_lut::TableKind;
use luthier_manifest::FunctionEntry;

use crate::context::Pass;
use crate::evaluate::{CHUNK, WORKGROUP};
use crate::{GpuError, Scene};

const KERNEL: &str = include_str!("wgsl/lookup.wgsl");

impl Scene {
    /// Reads a tile of a table on the device, through the shader's own look-up function. `values` are the axis values:
    ///
    /// | table | values | channels |
    /// |---|---|---|
    /// | fresnel | cos_theta, ignored | RGB reflectance |
    /// | distribution | theta_h in radians, alpha | pi alpha^2 D in R |
    /// | fgd | cos_theta, alpha | RGB albedo, A never-crossed luminance |
    /// | phase | normalised thickness, ignored | RGB |
    /// | thickness | u, v | the record |
    ///
    /// Channels that the look-up does not return are 0. A bare read of the manifest's layout is
    /// `luthier_lut::bilinear`; the two differ by the hardware's weights and f32 coordinates only.
    ///
    /// # Errors
    /// [`GpuError::NoTable`], [`GpuError::NoTile`], and whatever the device reports.
    pub fn lookup(&self, kind: TableKind, tile: u32, values: &[[f32; 2]]) -> Result<Vec<[f32; 4]>, GpuError> {
        let (Some(function), Some(table)) = (self.look_up(kind), self.manifest.table(kind)) else {
            return Err(GpuError::NoTable { kind, form: self.form() });
        };
        let count = table.layout.tiles;
        if tile >= count {
            return Err(GpuError::NoTile { kind, tile, count });
        }
        let kernel = KERNEL.replace("KERNEL_LOOKUP", &call(function));
        let pipeline = self.pipeline(&self.lookups[kind as usize], &kernel)?;

        let mut read = Vec::with_capacity(values.len());
        for chunk in values.chunks(CHUNK) {
            let inputs: Vec<[f32; 4]> = chunk.iter().map(|&v| arguments(kind, tile, v)).collect();
            read.extend(self.context.run(&Pass {
                what: "look-up",
                pipeline,
                shader_group: &self.group,
                workgroups: [chunk.len().div_ceil(WORKGROUP) as u32, 1],
                inputs: bytemuck::cast_slice(&inputs),
                output_words: chunk.len(),
            })?);
        }
        Ok(read)
    }
}

/// The expression that reads a table: the components of `at`, in order, become the arguments of the look-up.
fn call(FunctionEntry { name, parameters, value }: &FunctionEntry) -> String {
    let mut components = "xyzw".chars();
    let mut arguments = Vec::with_capacity(parameters.len());
    for kind in parameters {
        arguments.push(format!("at.{}", components.by_ref().take(width(kind)).collect::<String>()));
    }
    let read = format!("{name}({})", arguments.join(", "));
    match width(value) {
        4 => read,
        channels => format!("vec4<f32>({read}{})", ", 0.0".repeat(4 - channels)),
    }
}

/// Numbers in a WGSL type: `f32` or a vector.
fn width(kind: &str) -> usize {
    kind.strip_prefix("vec").and_then(|rest| rest[..1].parse().ok()).unwrap_or(1)
}

/// The argument `at` of the kernel.
fn arguments(kind: TableKind, tile: u32, [x, y]: [f32; 2]) -> [f32; 4] {
    match kind {
        TableKind::Distribution => {
            let (sin, cos) = libm::sincos(f64::from(x));
            [tile as f32, cos as f32, (sin * sin) as f32, y]
        }
        _ => [tile as f32, x, y, 0.0],
    }
}
