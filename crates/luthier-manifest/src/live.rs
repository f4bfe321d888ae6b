//! Numbers of materials that a program sets at run time, without a bake.

use serde::{Deserialize, Serialize};

use crate::map::MapSlot;

/// A number, a colour or a direction of a material that a program may set at any place of its surface.
///
/// Its value is a factor on `number`, where that is there, and a value by itself elsewhere.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LiveEntry {
    /// Quantity: that of a map whose texel the program decides.
    pub slot: MapSlot,
    /// Number of the layer from the top; 0 for those of the whole surface.
    pub layer: u32,
    /// Member of `LuthierPlace` that has the value, or the function that writes it there.
    pub member: String,
    /// Value that leaves the material as its file has it: one number, RGB, or a direction.
    pub default: Vec<f64>,
    /// Least and greatest value; shaders hold values to it. No greatest where nothing bounds it, and absent for directions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range: Option<LiveRange>,
    /// Numbers of the file that the value multiplies, one or RGB, in the unit of the key of the file. Absent where it multiplies none, or several.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub number: Vec<f64>,
}

/// Range of a [`LiveEntry`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LiveRange {
    /// Least value.
    pub least: f64,
    /// Greatest value; null where there is none.
    pub most: Option<f64>,
}

impl LiveEntry {
    /// Where a quantity of a layer stands in a `LuthierPlace`.
    pub fn member_of(slot: MapSlot, layer: u32) -> String {
        let own = match slot {
            MapSlot::Normal => return "normal".to_owned(),
            MapSlot::Roughness => return "alpha_factor".to_owned(),
            MapSlot::Thickness if layer == 0 => return "slab_factor".to_owned(),
            MapSlot::Weight => return "weight_factor".to_owned(),
            MapSlot::Patina => return "patina".to_owned(),
            MapSlot::FlakeNormal => return "flake_normal".to_owned(),
            MapSlot::Albedo => return "base_color".to_owned(),
            MapSlot::BaseColor | MapSlot::Metallic => return "luthier_metallic_place".to_owned(),
            MapSlot::F0 => return "luthier_f0_place".to_owned(),
            MapSlot::Lean => return "inner_normal".to_owned(),
            MapSlot::Thickness => "slab_factor",
            MapSlot::Absorption => "absorption_factors",
            MapSlot::Bumps => "normal",
            MapSlot::Alpha => "alpha_factors",
            MapSlot::AlphaX => "alpha_factors.x",
            MapSlot::AlphaY => "alpha_factors.y",
            MapSlot::Tangent => "tangent",
        };
        format!("layers[{layer}].{own}")
    }

    /// A value held to the range.
    pub fn held(&self, value: f64) -> f64 {
        let Some(LiveRange { least, most }) = self.range else { return value };
        value.max(least).min(most.unwrap_or(f64::INFINITY))
    }
}
