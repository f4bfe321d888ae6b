//! Counts of a kernel.

use serde::{Deserialize, Serialize};

/// Counts that RADV's compiler (ACO) reports of one kernel, for one wave of 64.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Counts {
    /// Instructions, of all branches.
    pub instructions: i64,
    /// Cycles per wave by the compiler's model of the pipeline with all its waves in flight: those of the busiest unit, or the latency
    /// over the number of waves, whichever is more. What lies under a branch counts three quarters where threads may differ, and half
    /// where they agree.
    pub inverse_throughput: i64,
    /// Cycles from the first instruction to the last for one wave alone, memory at the compiler's fixed estimate.
    pub latency: i64,
    /// Cycles of one SIMD that the vector instructions of all branches take to issue: no branch is guessed to be skipped, and no
    /// latency is in it.
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
    /// Branches, the taken and the others.
    pub branches: i64,
}

impl Counts {
    /// The rest of each count beyond that of another kernel. Registers, waves and spills are of the whole kernel and stay.
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
    /// Name of the driver and its version, as it gives them.
    pub driver: String,
    /// Name of the device that it stands in for.
    pub device: String,
    /// One for each kernel, in order.
    pub counts: Vec<Counts>,
}
