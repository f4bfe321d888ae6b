use luthier_shader::ShaderError;
use thiserror::Error;

/// Why a cost cannot be found.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CostError {
    /// No driver, or not the one needed.
    #[error(
        "Mesa's RADV driver is needed to compile for these GPUs, and {0}; no GPU is (Debian and Ubuntu: apt-get install \
         mesa-vulkan-drivers libvulkan1)"
    )]
    NoDriver(String),
    /// A call of Vulkan failed.
    #[error("{what}: {result}")]
    Vulkan {
        /// What was being done.
        what: String,
        /// The code that came back.
        result: ash::vk::Result,
    },
    /// The driver reports no such statistic.
    #[error("the driver does not report `{name}`; it reports: {known}")]
    NoStatistic {
        /// As RADV names it.
        name: &'static str,
        /// Those reported, comma-separated.
        known: String,
    },
    /// A shader that cannot be emitted.
    #[error(transparent)]
    Shader(#[from] ShaderError),
}
