//! Tables of energy compensation of renderers.

use luthier_lut::Image;
use luthier_optics::dielectric_albedo::JointMasking;
use luthier_optics::stack::Distribution;

use super::EnergySurface::{FromDenser, FromRarer, Reflector};
use super::{EnergyContainer, EnergyLayout, EnergySurface, EnergyTable, EnergyValue};
use crate::{Nodes, Stored};

const NONE: [f64; 2] = [0.0, f64::INFINITY];

/// OSPRay's least alpha is .001.
const OSPRAY_ROUGHNESS_MIN: f64 = 0.031_622_776_601_683_79;

/// A part of a table in memory: a statement with axes of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Part {
    surface: EnergySurface,
    /// Axes, the fastest first, in the grammar of [`EnergyLayout::parse`].
    axes: &'static str,
    size: [u32; 3],
}

/// One table of a renderer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergyFile {
    /// Name in the renderer.
    pub name: &'static str,
    value: EnergyValue,
    masking: JointMasking,
    parts: &'static [Part],
}

/// The tables of energy compensation of a renderer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergyPreset {
    /// Name on command lines.
    pub name: &'static str,
    /// Its tables.
    pub files: &'static [EnergyFile],
    /// Number type of the texels.
    pub stored: Stored,
    /// File format of a table.
    pub container: EnergyContainer,
    /// Source of the layout.
    pub source: &'static str,
    /// Lowest and highest values of the axes of the roughness, the cosine, and the index as the axis words it.
    limits: [[f64; 2]; 3],
    /// [`EnergyTable::clear_within`].
    clear_within: f64,
}

const fn part(surface: EnergySurface, axes: &'static str, size: [u32; 3]) -> Part {
    Part { surface, axes, size }
}

const fn cycles(name: &'static str, parts: &'static [Part]) -> EnergyFile {
    EnergyFile { name, value: EnergyValue::Albedo, masking: JointMasking::Correlated, parts }
}

const fn openpbr(name: &'static str, value: EnergyValue, parts: &'static [Part]) -> EnergyFile {
    EnergyFile { name, value, masking: JointMasking::Separable, parts }
}

const fn ospray(name: &'static str, value: EnergyValue, parts: &'static [Part]) -> EnergyFile {
    EnergyFile { name, value, masking: JointMasking::Correlated, parts }
}

/// Both sides of an index, one after the other: 1/2.5 to 1, then 1 to 2.5.
const OPENPBR_DIR: &[Part] = &[
    part(FromDenser, "cos_theta,roughness,-ior=1..2.5", [32, 32, 16]),
    part(FromRarer, "cos_theta,roughness,ior=1..2.5", [32, 32, 16]),
];
const OPENPBR_AVG: &[Part] =
    &[part(FromDenser, "roughness,-ior=1..2.5", [32, 16, 1]), part(FromRarer, "roughness,ior=1..2.5", [32, 16, 1])];

/// OSPRay's index is the index above over the index below: 1/3 to 1 for light from the rarer side.
const OSPRAY_DIR: &[Part] = &[part(FromRarer, "cos_theta,inverse_ior,roughness", [16, 16, 16])];
const OSPRAY_AVG: &[Part] = &[part(FromRarer, "inverse_ior,roughness", [16, 16, 1])];

impl EnergyPreset {
    /// All presets, by name.
    pub const ALL: [Self; 4] = [
        Self {
            name: "cycles",
            files: &[
                cycles("ggx_E", &[part(Reflector, "roughness,cos_theta", [32, 32, 1])]),
                cycles("ggx_Eavg", &[part(Reflector, "roughness", [32, 1, 1])]),
                cycles("ggx_glass_E", &[part(FromRarer, "roughness,cos_theta,fourth_root_f0", [16, 16, 16])]),
                cycles("ggx_glass_Eavg", &[part(FromRarer, "roughness,fourth_root_f0", [16, 16, 1])]),
                cycles("ggx_glass_inv_E", &[part(FromDenser, "roughness,cos_theta,fourth_root_f0", [16, 16, 16])]),
                cycles("ggx_glass_inv_Eavg", &[part(FromDenser, "roughness,fourth_root_f0", [16, 16, 1])]),
            ],
            stored: Stored::Float,
            container: EnergyContainer::CArray,
            source: "blender/cycles, src/app/cycles_precompute.cpp and src/scene/shader.tables (July 2026)",
            limits: [[1e-4, 1.0], [1e-4, 1.0], [1e-4, 0.99]],
            clear_within: 1e-4,
        },
        Self {
            name: "cycles-32",
            files: &[
                cycles("ggx_E", &[part(Reflector, "roughness,sqrt_cos_theta", [32, 32, 1])]),
                cycles("ggx_Eavg", &[part(Reflector, "roughness", [32, 1, 1])]),
                cycles("ggx_glass_E", &[part(FromRarer, "roughness,sqrt_cos_theta,fourth_root_f0", [32, 32, 32])]),
                cycles("ggx_glass_Eavg", &[part(FromRarer, "roughness,fourth_root_f0", [32, 32, 1])]),
                cycles("ggx_glass_inv_E", &[part(FromDenser, "roughness,sqrt_cos_theta,fourth_root_f0", [32, 32, 32])]),
                cycles("ggx_glass_inv_Eavg", &[part(FromDenser, "roughness,fourth_root_f0", [32, 32, 1])]),
            ],
            stored: Stored::Float,
            container: EnergyContainer::CArray,
            source: "blender/blender after July 2026, intern/cycles/app/cycles_precompute.cpp and scene/shader.tables: glass of 32^3, over the root of the cosine",
            limits: [[1e-4, 1.0], [1e-4, 1.0], [1e-4, 0.99]],
            clear_within: 1e-4,
        },
        Self {
            name: "openpbr",
            files: &[
                openpbr("ideal_dielectric_energy_complement", EnergyValue::Loss, OPENPBR_DIR),
                openpbr("ideal_dielectric_avg_energy_complement", EnergyValue::Loss, OPENPBR_AVG),
                openpbr("opaque_dielectric_energy_complement", EnergyValue::Unreflected, OPENPBR_DIR),
                openpbr("opaque_dielectric_avg_energy_complement", EnergyValue::Unreflected, OPENPBR_AVG),
                openpbr(
                    "ideal_metal_energy_complement",
                    EnergyValue::Loss,
                    &[part(Reflector, "cos_theta,roughness", [32, 32, 1])],
                ),
                openpbr(
                    "ideal_metal_avg_energy_complement",
                    EnergyValue::Loss,
                    &[part(Reflector, "roughness", [32, 1, 1])],
                ),
            ],
            stored: Stored::Unorm16,
            container: EnergyContainer::Words,
            source: "adobe/openpbr-bsdf, impl/openpbr_microfacet_multiple_scattering_data.h and impl/data; the least cosine, .001, and index, 1.0001, follow from its figures",
            limits: [NONE, [1e-3, 1.0], [1.0001, 2.5]],
            clear_within: 0.0,
        },
        Self {
            name: "ospray",
            files: &[
                ospray("albedo_dir", EnergyValue::Albedo, &[part(Reflector, "cos_theta,roughness", [32, 32, 1])]),
                ospray("albedo_avg", EnergyValue::Albedo, &[part(Reflector, "roughness", [32, 1, 1])]),
                ospray("dielectricAlbedo_dir", EnergyValue::Albedo, OSPRAY_DIR),
                ospray("dielectricAlbedo_avg", EnergyValue::Albedo, OSPRAY_AVG),
                ospray(
                    "dielectricRcpEtaAlbedo_dir",
                    EnergyValue::Albedo,
                    &[part(FromDenser, "cos_theta,ior=1..3,roughness", [16, 16, 16])],
                ),
                ospray(
                    "dielectricRcpEtaAlbedo_avg",
                    EnergyValue::Albedo,
                    &[part(FromDenser, "ior=1..3,roughness", [16, 16, 1])],
                ),
                ospray("dielectricReflectionAlbedo_dir", EnergyValue::Reflected, OSPRAY_DIR),
                ospray("dielectricReflectionAlbedo_avg", EnergyValue::Reflected, OSPRAY_AVG),
            ],
            stored: Stored::Float,
            container: EnergyContainer::Raw,
            source: "RenderKit/ospray, modules/cpu/render/bsdfs/MicrofacetAlbedoTables.ispc, after Kulla and Conty 2017",
            limits: [[OSPRAY_ROUGHNESS_MIN, 1.0], NONE, NONE],
            clear_within: 0.0,
        },
    ];

    /// The preset of a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        Self::ALL.iter().find(|preset| preset.name == name)
    }

    /// The statements of a table's parts, which follow each other in memory.
    pub fn tables(&self, file: &EnergyFile) -> Vec<EnergyTable> {
        let tables = file.parts.iter().map(|part| {
            let layout = EnergyLayout::parse(part.axes, Nodes::Ends).unwrap_or_else(|error| unreachable!("{error}"));
            let [slope, angle, index] = self.limits;
            let limits = layout.axes().iter().map(|axis| match axis.quantity {
                quantity if quantity.is_slope() => slope,
                quantity if quantity.is_angle() => angle,
                _ => index,
            });
            let limits: Vec<[f64; 2]> = limits.collect();
            EnergyTable {
                distribution: Distribution::Ggx,
                masking: file.masking,
                surface: part.surface,
                layout: layout.clamped(&limits),
                size: part.size,
                values: vec![file.value],
                stored: self.stored,
                balanced: false,
                clear_within: self.clear_within,
            }
        });
        tables.collect()
    }

    /// A table of the renderer, baked.
    pub fn bake(&self, file: &EnergyFile) -> Vec<Image> {
        self.tables(file).iter().map(EnergyTable::bake).collect()
    }

    /// The file of a baked table, in the renderer's container.
    pub fn write(&self, file: &EnergyFile, parts: &[Image]) -> Vec<u8> {
        let rows = file.parts.first().map_or(1, |part| if part.size[2] > 1 { part.size[1] } else { 1 });
        self.container.write(file.name, parts, rows, self.stored)
    }
}
