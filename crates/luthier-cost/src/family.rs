//! Instruction sets that the driver compiles for.

use serde::{Deserialize, Serialize};

luthier_lut::named! {
    /// An instruction set that Mesa's RADV driver compiles for.
    ///
    /// ```
    /// use luthier_cost::Family;
    ///
    /// // Four plain instructions and a reciprocal: GCN issues them one after the other, RDNA side by side.
    /// assert_eq!([Family::Gcn5, Family::Rdna2].map(|family| family.issue_cycles(4, 1)), [32, 10]);
    /// assert_eq!("rdna3".parse::<Family>().unwrap().chip(), "gfx1100");
    /// ```
    #[derive(Serialize, Deserialize)]
    #[serde(into = "&'static str", try_from = "String")]
    pub enum Family("family") {
        /// Graphics Core Next 5: Vega 10 (2017). Waves of 64.
        Gcn5 = "gcn5",
        /// Navi 21 (2020). Waves of 64 in compute kernels.
        Rdna2 = "rdna2",
        /// Navi 31 (2022), gfx1100. Waves of 64 in compute kernels.
        Rdna3 = "rdna3",
    }
}

impl Family {
    /// The chip, as RADV names it.
    pub fn chip(self) -> &'static str {
        match self {
            Self::Gcn5 => "vega10",
            Self::Rdna2 => "navi21",
            Self::Rdna3 => "gfx1100",
        }
    }

    /// Cycles that one SIMD takes to issue the vector instructions of a wave of 64: plain ones, and quarter-rate ones (reciprocals,
    /// roots, exponentials, logarithms, wide integer products), which have a unit of their own from RDNA on.
    pub fn issue_cycles(self, plain: i64, quarter_rate: i64) -> i64 {
        match self {
            Self::Gcn5 => 4 * plain + 16 * quarter_rate,
            Self::Rdna2 | Self::Rdna3 => (2 * (plain + quarter_rate)).max(8 * quarter_rate),
        }
    }

    /// Variables that the process must have before its first call of the Vulkan loader: they ask for the null device of this family, and turn
    /// the cache of compiled shaders off.
    pub fn environment(self) -> [(&'static str, &'static str); 2] {
        [("RADV_FORCE_FAMILY", self.chip()), ("MESA_SHADER_CACHE_DISABLE", "true")]
    }
}

/// Variables that change the code of RADV, or load layers in front of it. They must be absent.
pub const FOREIGN_VARIABLES: [&str; 8] = [
    "RADV_DEBUG",
    "RADV_PERFTEST",
    "RADV_FORCE_VRS",
    "ACO_DEBUG",
    "AMD_DEBUG",
    "NIR_DEBUG",
    "VK_INSTANCE_LAYERS",
    "VK_LOADER_LAYERS_ENABLE",
];
