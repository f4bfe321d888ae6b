//! Why a cost cannot be found.

use std::io;

use luthier_lut::UnknownName;
use luthier_shader::ShaderError;
use thiserror::Error;

/// Failure to find a cost.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CostError {
    /// The driver is missing, or it is another one.
    #[error(
        "Mesa's RADV driver is needed to compile for these GPUs, and {0}; no GPU is (Debian and Ubuntu: apt-get install \
         mesa-vulkan-drivers libvulkan1)"
    )]
    NoDriver(String),
    /// A call of Vulkan failed.
    #[cfg(feature = "radv")]
    #[error("{what}: {result}")]
    Vulkan {
        /// Action that failed.
        what: String,
        /// The code that came back.
        result: ash::vk::Result,
    },
    /// The driver does not report a statistic.
    #[error("the driver does not report `{name}`; it reports: {known}")]
    NoStatistic {
        /// Name of the statistic, as RADV has it.
        name: &'static str,
        /// Names of the reported statistics, comma-separated.
        known: String,
    },
    /// A shader that cannot be emitted.
    #[error(transparent)]
    Shader(#[from] ShaderError),
    /// An unknown family.
    #[error(transparent)]
    Family(#[from] UnknownName),
    /// A probe, the process that compiles, cannot be started or asked.
    #[error("cannot {action}: {source}")]
    Process {
        /// Action that failed.
        action: &'static str,
        /// Error of the system.
        source: io::Error,
    },
    /// A failure of a probe, in its own words.
    #[error("{0}")]
    Probe(String),
    /// Times that no costs can be fitted to, or costs that are none.
    #[error("{0}")]
    Fit(String),
    /// Kernels, counts or costs that are not valid JSON.
    #[error("JSON of kernels, counts or costs: {0}")]
    Exchange(#[from] serde_json::Error),
}
