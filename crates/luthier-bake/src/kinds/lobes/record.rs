//! The view-independent numbers of rows, for manifests.

use luthier_layers::models::lobes::{
    Axes, Critical, Curve, Family, FitError, OneWidth, Painted, Shaping, Short, SlopeAxis, Varying, base_below,
};
use luthier_lut::{Image, TableKind, TexelFormat};
use luthier_manifest::{
    AxesRecord, FamilyRecord, LobesError, LobesRecord, PaintedRecord, ShortRecord, SlopesRecord, VaryingFactor,
    VaryingRecord,
};
use luthier_material::Material;

use super::fit::{Fits, fit, form};
use super::rows::{has_base, is_family, varying};
use crate::form::Widths;
use crate::graph::{Job, Results};
use crate::settings::Settings;

/// Placeholder numbers where nothing was fitted.
pub(super) const UNFITTED: LobesRecord = LobesRecord {
    index: 1.5,
    falloff: [0.5, 0.1],
    integral: 0.95,
    critical_cot_sq: 0.0,
    critical_width: 0.0,
    critical_plain_share: 0.0,
    lobes: 2,
    inverse_tails: [1.0; 2],
    rise: None,
    short: None,
    reflectance: None,
    varying: None,
    axes: None,
    painted: None,
    error: None,
};

/// Numbers of a short lobe where nothing was fitted, and its reflectance.
const UNFITTED_SHORT: ShortRecord = ShortRecord { sharpness: [5.0, 0.0, 0.0] };
const UNFITTED_CURVE: [f64; 3] = [0.04, 0.36, 0.25];

/// The view-independent numbers of a material's lobes; [`UNFITTED`] in an outline without fits.
pub(crate) fn record(material: &Material, settings: &Settings, results: &Results) -> LobesRecord {
    let axes = Varying::axes(varying(material), &material.stack).map(|Axes { turn, is_mirrored }| AxesRecord {
        turn,
        is_mirrored,
        tiles: Axes::TILES as u32,
    });
    let form = form(material, settings);
    let fits = results.get::<Fits>(fit(material, form.most.is_some()).key());
    let Some((fits, shape)) = fits.zip(settings.shape(TableKind::Lobes)) else {
        let base = base_below(&material.stack).filter(|_| has_base(material) || is_family(varying(material)));
        let painted = base.map(|base| PaintedRecord { albedo: base.albedo, moments: None });
        let varying = varying(material).and_then(|varying| match varying {
            Varying::Family(family) => Some(VaryingRecord {
                factor: VaryingFactor::Family,
                tiles: family.nodes() as u32,
                least_spread: 1.0,
                factors: None,
                family: Some(family_record(family)),
            }),
            _ => None,
        });
        let unfitted = LobesRecord { axes, painted, varying, ..UNFITTED };
        return match material.bake.lobes {
            Some(asked) => {
                let rise = (form.widths != Widths::Two).then_some(0.0);
                let short = (form.widths == Widths::Short).then_some(UNFITTED_SHORT);
                let reflectance = short.map(|_| UNFITTED_CURVE);
                LobesRecord { lobes: asked.most() as u32, rise, short, reflectance, ..unfitted }
            }
            None => unfitted,
        };
    };
    let varied = fits.shaped(form);
    let FitError { lobe, lobe_noise, albedo, albedo_noise } = fits.error(form, shape.x.size as usize);
    let error = Some(LobesError { lobe, lobe_noise, albedo, albedo_noise });
    let lobes = &varied.nodes[0];
    let (wide, Critical { cot_sq, width, plain_share }) = (lobes.frame.wide, lobes.axis.critical());
    let (inverse_tails, rise, short) = match lobes.frame.shaping {
        Shaping::Rows => (varied.stored(0, 0).inverse_tails(), None, None),
        Shaping::OneWidth(OneWidth { rise, inverse_tail }) => ([inverse_tail, 0.0], Some(rise), None),
        Shaping::Short(Short { sharpness, rise }) => ([1.0, 0.0], Some(rise), Some(ShortRecord { sharpness })),
    };
    LobesRecord {
        index: lobes.frame.index,
        falloff: wide.falloff(),
        integral: wide.integral(),
        critical_cot_sq: cot_sq,
        critical_width: width,
        critical_plain_share: plain_share,
        lobes: lobes.rows[0].lobes.len() as u32,
        inverse_tails: texels_of(inverse_tails, shape.format),
        rise,
        short,
        reflectance: lobes.frame.curve.map(|Curve(numbers)| numbers),
        varying: varied.varying().map(|varying| VaryingRecord {
            factor: match varying {
                Varying::Alpha => VaryingFactor::AlphaFactor,
                Varying::Slab => VaryingFactor::SlabFactor,
                Varying::Film(_) => VaryingFactor::FilmFactor,
                Varying::Patina(_) if material.weight().is_some() => VaryingFactor::WeightFactor,
                Varying::Patina(_) => VaryingFactor::Patina,
                Varying::Family(_) => VaryingFactor::Family,
            },
            factors: match varying {
                Varying::Film(factors) => Some(factors),
                Varying::Alpha | Varying::Slab | Varying::Patina(_) | Varying::Family(_) => None,
            },
            family: match varying {
                Varying::Family(family) => Some(family_record(family)),
                Varying::Alpha | Varying::Slab | Varying::Film(_) | Varying::Patina(_) => None,
            },
            tiles: varied.nodes.len() as u32,
            least_spread: varied.least_spread(),
        }),
        axes,
        painted: lobes.frame.base.map(|Painted { albedo, is_lambertian }| PaintedRecord {
            // Fits of families have any colour.
            albedo: base_below(&material.stack).map_or(albedo, |base| base.albedo),
            moments: varied.varying().filter(|_| is_lambertian).map(|_| wide.moments()),
        }),
        error,
    }
}

/// The axes of a family for the manifest.
pub(super) fn family_record(family: Family) -> FamilyRecord {
    let axis = |SlopeAxis { least, most, nodes }| SlopesRecord { least, most, nodes: nodes as u32 };
    FamilyRecord {
        coat: family.is_coated().then(|| axis(family.coat)),
        base: axis(family.base),
        interface: family.interface as u32,
        is_metallic: family.is_metallic,
        is_tinted: family.is_tinted,
        has_tail: family.has_tail,
        sent_back: family.sent_back,
        has_lengths: family.has_lengths,
    }
}

/// Numbers as texels of a format have them.
pub(super) fn texels_of(numbers: [f64; 2], format: TexelFormat) -> [f64; 2] {
    let image = Image { width: 1, height: 1, channels: 2, data: numbers.map(|x| x as f32).to_vec() };
    let texels = format.quantise(&image).data;
    [texels[0], texels[1]].map(f64::from)
}
