use luthier_shader::ShaderError;
use thiserror::Error;

/// Why a cost cannot be found.
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
}
