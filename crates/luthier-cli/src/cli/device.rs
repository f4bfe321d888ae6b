//! The device whose costs count.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;
use luthier_cost::DeviceCost;
use luthier_lut::RowLayout;
use luthier_terminal::{Failure, Outcome};

use crate::input;

/// Options that name a device.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct CostsOf {
    /// Device whose costs choose models of scenes and the layout of rows: h100 (an NVIDIA H100, timed), gcn5, rdna2 or rdna3 (cycles by the compiler of Mesa's RADV driver), or llvmpipe (a program on the CPU, timed)
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(DeviceCost::names().collect::<Vec<_>>()), hide_possible_values = true)]
    pub(crate) device: Option<String>,
    /// Costs of another device: a file that `luthier bench --fit FILE` wrote there
    #[arg(long, value_name = "FILE", conflicts_with = "device")]
    pub(crate) costs: Option<PathBuf>,
}

impl CostsOf {
    /// The layout of rows that the device decides: a sampler's where reads of a buffer are not known to be cheaper.
    pub(crate) fn row_layout(&self) -> Outcome<Option<RowLayout>> {
        let is_dearer = |costs: &DeviceCost| !costs.has_cheap_buffers();
        Ok(self.load()?.filter(is_dearer).map(|_| RowLayout::Filtered))
    }

    /// The costs of the device; `None` without one of the options.
    pub(crate) fn load(&self) -> Outcome<Option<DeviceCost>> {
        if let Some(path) = &self.costs {
            let text = input::named_text(path)?;
            let costs = DeviceCost::parse(&text)
                .map_err(|error| Failure::Input(anyhow::anyhow!("{}: {error}", path.display())))?;
            return Ok(Some(costs));
        }
        Ok(self.device.as_deref().and_then(DeviceCost::shipped))
    }
}
