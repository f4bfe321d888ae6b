//! Why a cost cannot be found.

use std::io;

use luthier_lut::UnknownName;
use luthier_shader::ShaderError;
use thiserror::Error;

/// Failure to find a cost.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CostError {
    /// A driver that is missing, or not the one needed.
    #[error(
        "Mesa's RADV driver is needed to compile for these GPUs, and {0}; no GPU is (Debian and Ubuntu: apt-get install \
         mesa-vulkan-drivers libvulkan1)"
    )]
    NoDriver(String),
    /// A call of Vulkan failed.
    #[error("{what}: {result}")]
    Vulkan {
        /// Action that failed.
        what: String,
        /// The code that came back.
        result: ash::vk::Result,
    },
    /// The driver reports no such statistic.
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
    /// A family that there is not.
    #[error(transparent)]
    Family(#[from] UnknownName),
    /// A process of its own that cannot be had.
    #[error("cannot {action}: {source}")]
    Process {
        /// Action that failed.
        action: &'static str,
        /// Error of the system.
        source: io::Error,
    },
    /// A failure in a process of its own, as it told it.
    #[error("{0}")]
    Probe(String),
    /// Kernels or counts that are not what processes exchange.
    #[error("JSON of kernels or counts: {0}")]
    Exchange(#[from] serde_json::Error),
}
