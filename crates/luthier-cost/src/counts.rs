//! Counts of a kernel.

use serde::{Deserialize, Serialize};

/// Counts that RADV's compiler (ACO) reports of one kernel, for one wave of 64.
///
/// ```
/// use luthier_cost::Counts;
///
/// let harness = Counts { instructions: 10, vgprs: 8, ..Counts::default() };
/// let shader = Counts { instructions: 250, vgprs: 40, ..Counts::default() };
/// // Registers belong to the whole kernel and are not subtracted.
/// assert_eq!(shader.beyond(&harness), Counts { instructions: 240, vgprs: 40, ..Counts::default() });
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Counts {
    /// Instructions, of all branches.
    pub instructions: i64,
    /// Cycles per wave by the compiler's model of the pipeline with all its waves in flight: those of the busiest unit, or the latency
    /// over the number of waves, whichever is more. Code under a branch counts three quarters if threads may differ, and half if they agree.
    pub inverse_throughput: i64,
    /// Cycles from the first instruction to the last for one wave alone, memory at the compiler's fixed estimate.
    pub latency: i64,
    /// Cycles of one SIMD to issue the vector instructions of all branches. No branch counts as skipped, and latency is not included.
    pub issue_cycles: i64,
    /// Vector registers.
    pub vgprs: i64,
    /// Waves that fit on one SIMD.
    pub waves: i64,
    /// Bytes of machine code.
    pub code_bytes: i64,
    /// Vector and scalar registers that had to go to memory.
    pub spills: i64,
    /// Reads of textures, filtered or not, as issued: no cache is modelled.
    pub texture_reads: i64,
    /// Reads of buffers, vector and scalar, as issued.
    pub buffer_reads: i64,
    /// Branches, taken or not.
    pub branches: i64,
}

impl Counts {
    /// The counts less those of another kernel. Registers, waves and spills belong to the whole kernel and stay.
    pub fn beyond(&self, harness: &Self) -> Self {
        Self {
            instructions: self.instructions - harness.instructions,
            inverse_throughput: self.inverse_throughput - harness.inverse_throughput,
            latency: self.latency - harness.latency,
            issue_cycles: self.issue_cycles - harness.issue_cycles,
            code_bytes: self.code_bytes - harness.code_bytes,
            texture_reads: self.texture_reads - harness.texture_reads,
            buffer_reads: self.buffer_reads - harness.buffer_reads,
            branches: self.branches - harness.branches,
            ..*self
        }
    }
}

/// Counts of some kernels, as a driver compiled them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Compiled {
    /// Name and version of the driver, in its own words.
    pub driver: String,
    /// Name of the device that the null device stands for.
    pub device: String,
    /// One for each kernel, in order.
    pub counts: Vec<Counts>,
}
