//! One set of table settings for all materials of a bake.

use std::f64::consts::FRAC_PI_2;
use std::fmt::Debug;

use luthier_layers::elek;
use luthier_lut::{Axis, FormatSet, Mapping, RowBase, TableKind, TexelFormat};
use luthier_manifest::ShadingModel;
use luthier_material::{AlphaMapping, BakeSettings, DistributionMapping, FresnelMapping, Material};

use crate::BakeError;
use crate::fresnel::RowShape;
use crate::plan::{asks_for, shading_model};

/// Axes and formats of every table kind.
#[derive(Debug, Clone)]
pub(crate) struct Settings {
    pub(crate) fresnel: RowShape,
    /// Axes and format of the tables of D; without them D is computed.
    pub(crate) distribution: Option<([Axis; 2], TexelFormat)>,
    pub(crate) fgd: ([Axis; 2], TexelFormat),
    /// Axes at which FGD is computed; those of its tiles unless these were searched for.
    pub(crate) fgd_grid: [Axis; 2],
    /// Axis and format of phase rows; without them phases are computed.
    pub(crate) phase: Option<(Axis, TexelFormat)>,
    pub(crate) thickness: ([Axis; 2], TexelFormat),
    pub(crate) film: ([Axis; 2], TexelFormat),
    pub(crate) escape: ([Axis; 2], TexelFormat),
    pub(crate) asked: Asked,
    /// Formats that tables may have, see [`crate::Options::formats`].
    pub(crate) formats: FormatSet,
}

/// Settings that the materials decide themselves: no search touches them.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Asked {
    pub(crate) fresnel_size: bool,
    pub(crate) fresnel_mapping: bool,
    pub(crate) fresnel_format: bool,
    pub(crate) distribution: bool,
    pub(crate) fgd_size: bool,
    pub(crate) fgd_format: bool,
    pub(crate) phase: bool,
}

impl Asked {
    /// Whether the shape of the tables of a kind that interfaces share is left to the bake, which then aims at an error of its own.
    pub(crate) fn leaves(self, kind: TableKind) -> bool {
        match kind {
            TableKind::Fresnel => !(self.fresnel_size || self.fresnel_mapping || self.fresnel_format),
            TableKind::Fgd => !(self.fgd_size || self.fgd_format),
            _ => false,
        }
    }
}

impl Settings {
    /// The settings that the materials ask for, where they agree, and fixed defaults for the rest.
    ///
    /// # Errors
    /// [`BakeError::Conflict`] where they do not.
    pub(crate) fn of(materials: &[Material]) -> Result<Self, BakeError> {
        let ask = Ask(materials);
        let mapping = ask.one("bake.fresnel.mapping", |b| b.fresnel.mapping)?.unwrap_or(FresnelMapping::Cosine);
        let size = ask.one("bake.fresnel.size", |b| b.fresnel.size)?.unwrap_or(128);
        let row = match mapping {
            FresnelMapping::Cosine => axis("cos_theta", "", [0.0, 1.0], size, Mapping::Linear),
            FresnelMapping::SqrtCosine => axis("cos_theta", "", [0.0, 1.0], size, Mapping::Power { exponent: 2.0 }),
            FresnelMapping::Theta => axis("theta", "rad", [0.0, FRAC_PI_2], size, Mapping::Linear),
        };
        let format = ask.format("bake.fresnel.format", |b| b.fresnel.format, TexelFormat::Rgba16Float)?;
        let fresnel = RowShape { axis: row, format, base: RowBase::Zero };

        let size = ask.one("bake.distribution.size", |b| b.distribution.size)?.unwrap_or([512, 512]);
        let exponent = ask.one("bake.distribution.exponent", |b| b.distribution.exponent)?.unwrap_or(8.0);
        let mapping = ask.one("bake.distribution.mapping", |b| b.distribution.mapping)?;
        let angle = match mapping.unwrap_or(DistributionMapping::Power) {
            DistributionMapping::Power => {
                axis("theta_h", "rad", [0.0, FRAC_PI_2], size[0], Mapping::Power { exponent })
            }
            DistributionMapping::Linear => axis("theta_h", "rad", [0.0, FRAC_PI_2], size[0], Mapping::Linear),
            DistributionMapping::CosPower => {
                axis("cos_theta_h", "", [0.0, 1.0], size[0], Mapping::Power { exponent: 1.0 / exponent })
            }
        };
        let alpha_mapping = ask.one("bake.distribution.alpha_mapping", |b| b.distribution.alpha_mapping)?;
        let slope = match alpha_mapping.unwrap_or(AlphaMapping::Log) {
            AlphaMapping::Log => axis("alpha", "", [elek::ALPHA_MIN, 1.0], size[1], Mapping::Logarithmic),
            AlphaMapping::Linear => axis("alpha", "", [0.0, 1.0], size[1], Mapping::Linear),
        };
        let format = ask.format("bake.distribution.format", |b| b.distribution.format, TexelFormat::Rg16Float)?;
        let distribution = Some(([angle, slope], format));

        let size = ask.one("bake.fgd.size", |b| b.fgd.size)?.unwrap_or([64, 64]);
        let fgd = (
            [
                axis("cos_theta", "", [0.0, 1.0], size[0], Mapping::Power { exponent: 2.0 }),
                axis("alpha", "", [0.0, 1.0], size[1], Mapping::Power { exponent: 3.0 }),
            ],
            ask.format("bake.fgd.format", |b| b.fgd.format, TexelFormat::Rgba16Float)?,
        );
        if let Some(&side) = size.iter().find(|side| !side.is_multiple_of(fgd.1.block_side())) {
            let asks = |has: fn(&BakeSettings) -> bool| materials.iter().position(|m| has(&m.bake));
            let sized = asks(|bake| bake.fgd.size.is_some()).map(|material| (material, "bake.fgd.size"));
            let (material, setting) = sized
                .or_else(|| Some((asks(|bake| bake.fgd.format.is_some())?, "bake.fgd.format")))
                .unwrap_or((0, "bake.fgd.size"));
            return Err(BakeError::Blocks { material, setting, format: fgd.1, side });
        }

        let size = ask.one("bake.phase.size", |b| b.phase.size)?.unwrap_or(256);
        let phase = Some((
            axis("s", "", [0.0, 1.0], size, Mapping::Linear),
            ask.format("bake.phase.format", |b| b.phase.format, TexelFormat::Rgba16Float)?,
        ));

        let size = ask.one("bake.thickness.size", |b| b.thickness.size)?.unwrap_or(256);
        let thickness = (
            ["u", "v"].map(|name| axis(name, "", [0.0, 1.0], size, Mapping::Periodic)),
            ask.format("bake.thickness.format", |b| b.thickness.format, thickness_format(materials))?,
        );
        let film = (
            [
                axis("cos_theta", "", [0.0, 1.0], 64, Mapping::Power { exponent: 2.0 }),
                axis("fraction", "", [0.0, 1.0], 256, Mapping::Linear),
            ],
            TexelFormat::Rgba16Float,
        );
        let escape = (
            [
                axis("cos_theta", "", [0.0, 1.0], 64, Mapping::Linear),
                axis("alpha", "", [0.0, 1.0], 64, Mapping::Power { exponent: 2.0 }),
            ],
            TexelFormat::R16Float,
        );
        let any = |has: fn(&BakeSettings) -> bool| materials.iter().any(|m| has(&m.bake));
        let asked = Asked {
            fresnel_size: any(|b| b.fresnel.size.is_some()),
            fresnel_mapping: any(|b| b.fresnel.mapping.is_some()),
            fresnel_format: any(|b| b.fresnel.format.is_some()),
            distribution: any(|b| b.asks_for(TableKind::Distribution)),
            fgd_size: any(|b| b.fgd.size.is_some()),
            fgd_format: any(|b| b.fgd.format.is_some()),
            phase: any(|b| b.asks_for(TableKind::Phase)),
        };
        let fgd_grid = fgd.0.clone();
        Ok(Self {
            fresnel,
            distribution,
            fgd,
            fgd_grid,
            phase,
            thickness,
            film,
            escape,
            asked,
            formats: FormatSet::CORE,
        })
    }

    /// Rows of this form: nothing is left to search for.
    pub(crate) fn take_rows(&mut self, (base, format): (RowBase, TexelFormat)) {
        (self.fresnel.base, self.fresnel.format) = (base, format);
        let asked = &mut self.asked;
        (asked.fresnel_size, asked.fresnel_mapping, asked.fresnel_format) = (true, true, true);
    }
}

/// Four channels where someone reads slopes: Granier and Heidrich's model, or who asks for the table; else the thickness alone.
fn thickness_format(materials: &[Material]) -> TexelFormat {
    let reads_slopes = |material: &Material| {
        shading_model(material) == ShadingModel::GranierHeidrich || asks_for(material, TableKind::Thickness)
    };
    if materials.iter().any(reads_slopes) { TexelFormat::Rgba16Float } else { TexelFormat::R16Float }
}

pub(crate) fn axis(quantity: &str, unit: &str, [min, max]: [f64; 2], size: u32, mapping: Mapping) -> Axis {
    Axis { quantity: quantity.to_owned(), unit: unit.to_owned(), min, max, size, mapping }
}

/// The materials, asked for one setting at a time.
struct Ask<'a>(&'a [Material]);

impl Ask<'_> {
    /// The value that all materials which give one agree on.
    fn one<T: PartialEq + Debug>(
        &self,
        setting: &'static str,
        get: impl Fn(&BakeSettings) -> Option<T>,
    ) -> Result<Option<T>, BakeError> {
        let mut first: Option<(&Material, T)> = None;
        for (number, material) in self.0.iter().enumerate() {
            let Some(value) = get(&material.bake) else { continue };
            match &first {
                None => first = Some((material, value)),
                Some((other, expected)) if *expected != value => {
                    return Err(BakeError::Conflict {
                        material: number,
                        setting,
                        first: other.place(setting),
                        first_value: format!("{expected:?}"),
                        second: material.place(setting),
                        second_value: format!("{value:?}"),
                    });
                }
                Some(_) => {}
            }
        }
        Ok(first.map(|(_, value)| value))
    }

    fn format(
        &self,
        setting: &'static str,
        get: impl Fn(&BakeSettings) -> Option<TexelFormat>,
        default: TexelFormat,
    ) -> Result<TexelFormat, BakeError> {
        Ok(self.one(setting, get)?.unwrap_or(default))
    }
}
