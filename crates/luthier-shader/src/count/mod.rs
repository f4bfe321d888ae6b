//! Operations of a shader, counted without a driver.
//!
//! The text is followed from the evaluated function on, scalar by scalar, and becomes a graph of operations as a compiler's is: calls are inlined, constants
//! folded, equal terms shared, and what no result needs is removed. Where a condition is not known, both sides are followed and the dearer one counts
//! ([`StaticCounts::operations`] compares them), unless other [`Sides`] are asked for. Loops are unrolled up to their constant bound; one without such a bound counts as one turn.

mod expression;
mod graph;
mod value;
mod walk;
mod words;

use crate::ShaderError;
use crate::validate::module;
use walk::Walk;

/// Operations of one evaluation of a shader: reads by kind, special functions, plain arithmetic, branches.
///
/// | operation | counts as |
/// |---|---|
/// | sum, product, comparison, selection, conversion, minimum, bit operation of one component | 1 plain |
/// | sum of a product that nothing else needs (a fused one) | 0, the product 1 |
/// | negation, absolute value, saturation | 0: modifiers of another instruction |
/// | `sqrt`, `inverseSqrt`, `exp2`, `log2`, reciprocal | 1 special |
/// | quotient | the reciprocal, which quotients share, and a product |
/// | `exp`, `log`, `sin`, `cos` | 1 special, 1 plain |
/// | `pow` | 2 special, 1 plain |
/// | `tan` | 3 special, 2 plain |
/// | `asin`, `acos` | 1 special, 8 plain |
/// | `atan`, `atan2` | 1 special, 12 plain |
/// | `sinh`, `cosh`, `tanh` and their inverses | 2 special, 4 plain |
/// | integer quotient, remainder | 1 special, 8 plain |
///
/// ```
/// use luthier_shader::{StaticCounts, count};
///
/// let wgsl = "fn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
///     return wi / dot(wo, wo);
/// }\n";
/// // Three operations for the dot product, one reciprocal, three products.
/// assert_eq!(count(wgsl, &[], 1)?, StaticCounts { plain: 6, special: 1, ..StaticCounts::default() });
/// # Ok::<(), luthier_shader::ShaderError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StaticCounts {
    /// Reads through a sampler of textures with at most 4 bytes a texel.
    pub filtered_reads: u32,
    /// Reads through a sampler of textures with more bytes a texel.
    pub wide_reads: u32,
    /// Reads of textures without one.
    pub texel_fetches: u32,
    /// Reads of `luthier_materials`, in words of 16 bytes.
    pub record_reads: u32,
    /// Reads of other storage buffers, of at most 16 bytes each.
    pub buffer_reads: u32,
    /// Roots, exponentials, logarithms, reciprocals and sines, component by component.
    pub special: u32,
    /// Other arithmetic, component by component.
    pub plain: u32,
    /// Branches whose sides have operations of their own.
    pub branches: u32,
}

impl StaticCounts {
    /// Names of the counts, in the order of [`Self::values`].
    pub const NAMES: [&'static str; 8] = [
        "filtered_reads",
        "wide_reads",
        "texel_fetches",
        "record_reads",
        "buffer_reads",
        "special",
        "plain",
        "branches",
    ];

    /// The counts, one by one.
    pub fn values(&self) -> [u32; 8] {
        let &Self { filtered_reads, wide_reads, texel_fetches, record_reads, buffer_reads, special, plain, branches } =
            self;
        [filtered_reads, wide_reads, texel_fetches, record_reads, buffer_reads, special, plain, branches]
    }

    /// The counts of [`Self::values`].
    pub fn of_values(values: [u32; 8]) -> Self {
        let [filtered_reads, wide_reads, texel_fetches, record_reads, buffer_reads, special, plain, branches] = values;
        Self { filtered_reads, wide_reads, texel_fetches, record_reads, buffer_reads, special, plain, branches }
    }

    /// The counts of two shaders, one after the other.
    #[must_use]
    pub fn and(&self, other: &Self) -> Self {
        let (own, other) = (self.values(), other.values());
        Self::of_values(std::array::from_fn(|i| own[i] + other[i]))
    }

    /// One number by which sides of a branch are compared, of no device: 1 for a plain operation or a branch, 4 for a special function, a texel, a word
    /// of a buffer, 16 for each 4 bytes of a filtered texel.
    pub fn operations(&self) -> u32 {
        let quarter_rate = self.special + self.texel_fetches + self.record_reads + self.buffer_reads;
        self.plain + self.branches + 4 * quarter_rate + 16 * self.filtered_reads + 32 * self.wide_reads
    }
}

/// Operations of a branch that count.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sides<'a> {
    /// Those of the dearer side.
    Dearer,
    /// Those of both sides, one after the other: neighbours of a group of threads take different ones.
    Both,
    /// Those of the side that the numbers of a material take, where they decide; elsewhere those of the dearer side.
    Of(Record<'a>),
}

/// A material of a buffer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Record<'a> {
    /// All words of `luthier_materials`.
    pub words: &'a [[f32; 4]],
    /// Index of the material.
    pub material: u32,
}

/// Counts of one evaluation of a WGSL text under some lights: `luthier_eval` for one, `luthier_prepare` and `luthier_light` for more. A text
/// without these two counts `luthier_eval` for each light, less what the lights share. `wide` names the textures with more than 4 bytes a texel
/// ([`MaterialSet::wide_textures`](crate::MaterialSet::wide_textures)). Of branches the dearer side counts. Where functions take a place, they count with all of it
/// unknown but normals, those of flakes where a material is known that has none: at the place without textures a compiler would fold what textures decide.
///
/// # Errors
/// [`ShaderError::Invalid`] for invalid WGSL, and [`ShaderError::Uncounted`] for a text without these functions or with statements that no evaluation has.
pub fn count(wgsl: &str, wide: &[String], lights: u32) -> Result<StaticCounts, ShaderError> {
    count_sides(wgsl, wide, lights, Sides::Dearer)
}

/// Counts as [`count`], with other sides of branches.
///
/// # Errors
/// As [`count`], and [`ShaderError::Uncounted`] for a material that the buffer lacks.
pub fn count_sides(wgsl: &str, wide: &[String], lights: u32, sides: Sides<'_>) -> Result<StaticCounts, ShaderError> {
    let (module, _) = module(wgsl)?;
    Walk::new(&module, wide, sides).evaluation(lights).map_err(|reason| ShaderError::Uncounted(reason.to_owned()))
}

#[cfg(test)]
mod tests;
