//! The terms of a model, read from texels as a shader does.

use std::borrow::Cow;

use glam::DVec3;
use luthier_layers::models::lobes::{
    Axes, Below, Critical, Curve, Family, FilmLight, Frame, LOBES, OneWidth, Paint, Painted, Row, Shaping, Short,
    Slopes, ViewAxis, Wide,
};
use luthier_layers::models::shade::ShaderTerms;
use luthier_layers::models::statistics::diffuse_base::Veil;
use luthier_layers::models::statistics::energy::Energy;
use luthier_layers::terms::Terms;
use luthier_layers::twins::shaded::{Part, Place};
use luthier_lut::{TableKind, TexelFormat, Values, WeightBits, read};
use luthier_manifest::reads;
use luthier_manifest::{
    LayerKind, LayerRecord, LobesRecord, MaterialEntry, PaintedRecord, Reflectance, ShortRecord, VaryingFactor,
    VaryingRecord,
};
use luthier_optics::Rgb;
use luthier_optics::dielectric_albedo::fresnel_dielectric;
use luthier_optics::film_over_f0::{FilmOverF0, WAVES_MAX};
use luthier_optics::microfacet::scaled_distribution;
use luthier_optics::schlick::{DIELECTRIC_F0, F82, edge_dip};
use luthier_optics::stack::Distribution;
use serde::{Deserialize, Serialize};

use crate::error::ReportError;
use crate::measure::references::family_of;
use crate::measure::subject::{Subject, Table};

/// Precision of the weights of a filtering sampler. Formats that core WebGPU does not filter have exact weights in any case: the shader fetches four
/// texels and weighs them itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Weights {
    /// 8 fractional bits: most hardware.
    EightBit,
    /// Weights as precise as the arithmetic: software rasterisers.
    Exact,
}

impl Weights {
    fn bits(self, format: TexelFormat) -> WeightBits {
        match self {
            Self::EightBit if format.is_filterable() => WeightBits::Fixed(8),
            Self::EightBit | Self::Exact => WeightBits::Exact,
        }
    }
}

impl Table<'_> {
    /// A sampled read of a tile.
    pub(crate) fn read(&self, tile: u32, values: [f64; 2], weights: Weights) -> [f64; 4] {
        let entry = self.entry;
        read(entry.kind, &entry.layout, entry.format, self.texels, tile, values, weights.bits(entry.format))
    }

    /// A sampled row of at most so many lobes.
    pub(crate) fn row(&self, most: usize, tile: u32, cos_theta: f64, weights: Weights) -> Row {
        let parts = self.parts(tile, cos_theta, weights);
        let is_short = self.entry.layout.y.as_ref().is_some_and(|y| y.min == f64::from(Short::FIRST_PART));
        if is_short { Row::of_short_parts(&parts) } else { Row::within(most, &parts, self.has_base()) }
    }

    /// A row of lobes between two tiles.
    fn row_between(&self, tile: u32, share: f64, cos_theta: f64, weights: Weights) -> Row {
        Row::of_parts(&self.parts_between(tile, share, cos_theta, weights), self.has_base())
    }

    /// A row of a family, whose lobes have a tail, between two tiles.
    fn family_row(&self, (family, tail): (Family, f64), tile: (u32, f64), cos_theta: f64, weights: Weights) -> Row {
        let parts = self.parts_between(tile.0, tile.1, cos_theta, weights);
        family.of_parts(self.entry.layout.y.as_ref().map_or(0, |y| y.min as i32), &parts, tail)
    }

    /// The parts of a row between two tiles. The stored numbers are interpolated, not the lobes that they encode, because shaders do so.
    fn parts_between(&self, tile: u32, share: f64, cos_theta: f64, weights: Weights) -> Vec<[f64; 4]> {
        let share = match weights.bits(self.entry.format) {
            WeightBits::Exact => share,
            WeightBits::Fixed(bits) => {
                let steps = f64::from(1_u32 << bits);
                libm::round(share * steps) / steps
            }
        };
        if share == 0.0 {
            return self.parts(tile, cos_theta, weights);
        }
        let [first, second] = [tile, tile + 1].map(|tile| self.parts(tile, cos_theta, weights));
        let parts = first.iter().zip(&second).map(|(a, b)| std::array::from_fn(|i| a[i] + share * (b[i] - a[i])));
        parts.collect()
    }

    fn parts(&self, tile: u32, cos_theta: f64, weights: Weights) -> Vec<[f64; 4]> {
        let (first, parts) = self.entry.layout.y.as_ref().map_or((0.0, 1), |y| (y.min, y.size));
        (0..parts).map(|part| self.read(tile, [cos_theta, first + f64::from(part)], weights)).collect()
    }

    /// Whether rows of lobes have the parts of a diffuse base, which come before part 0.
    fn has_base(&self) -> bool {
        self.entry.layout.y.as_ref().is_some_and(|y| y.min < 0.0)
    }
}

/// Quantity of the x axis of a table: an angle or not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AngleAxis {
    Theta,
    /// The cosine of an angle, or no angle at all.
    CosTheta,
}

impl AngleAxis {
    /// The quantity of the x axis of a table.
    ///
    /// # Errors
    /// [`ReportError::Layout`] when the axes are not those of such a table.
    pub(crate) fn of(table: &Table<'_>) -> Result<Self, ReportError> {
        let kind = table.entry.kind;
        let (layout, facts) = (&table.entry.layout, kind.facts());
        if facts.y.is_some() && layout.y.is_none() {
            return Err(ReportError::Layout { kind, reason: "it has no second axis" });
        }
        if !facts.x.contains(&layout.x.quantity.as_str()) {
            let reason = "its x axis is not of a quantity that such tables have";
            return Err(ReportError::Layout { kind, reason });
        }
        Ok(if layout.x.quantity.starts_with("theta") { Self::Theta } else { Self::CosTheta })
    }

    /// The axis value of an angle, from its cosine and squared sine.
    fn value(self, cos_theta: f64, sin_theta_sq: f64) -> f64 {
        match self {
            Self::Theta => libm::atan2(sin_theta_sq.max(0.0).sqrt(), cos_theta),
            Self::CosTheta => cos_theta,
        }
    }

    /// The axis value of a cosine.
    pub(crate) fn value_at(self, cos_theta: f64) -> f64 {
        self.value(cos_theta, (1.0 - cos_theta) * (1.0 + cos_theta))
    }

    /// Cosine and squared sine of an axis value.
    pub(crate) fn cos_and_sin_sq(self, value: f64) -> (f64, f64) {
        match self {
            Self::Theta => {
                let sin = libm::sin(value);
                (libm::cos(value), sin * sin)
            }
            Self::CosTheta => (value, (1.0 - value * value).max(0.0)),
        }
    }
}

/// Terms of one material, read from the shipped tables with f64 arithmetic.
#[derive(Debug)]
pub struct TableTerms<'a> {
    /// Tables by kind, each with the quantity of its x axis.
    tables: [Option<(Table<'a>, AngleAxis)>; TableKind::ALL.len()],
    veil: Veil<3>,
    lobes: Option<Lobes>,
    records: Cow<'a, [LayerRecord]>,
    weights: Weights,
    here: Here,
    /// Terms of the layers below a coat with a weight.
    bare: Option<Box<TableTerms<'a>>>,
}

/// Rows of lobes, and what all of them have in common.
#[derive(Debug)]
struct Lobes {
    /// The first tile.
    tile: u32,
    axis: ViewAxis,
    frame: Frame,
    /// Most lobes of a row.
    most: usize,
    varying: Option<VaryingRecord>,
    /// Tail of the lobes of a family.
    tail: f64,
    /// A family, with slope parameters of coat and base and the colours of the place.
    family: Option<(Family, [Slopes; 2], Paint)>,
}

impl Lobes {
    fn new(record: &LobesRecord, tile: u32) -> Self {
        let critical = Critical {
            cot_sq: record.critical_cot_sq,
            width: record.critical_width,
            plain_share: record.critical_plain_share,
        };
        let axis = ViewAxis::new(2, critical);
        let axes = record.axes.map(|axes| Axes { turn: axes.turn, is_mirrored: axes.is_mirrored });
        let base = record
            .painted
            .map(|PaintedRecord { albedo, moments }| Painted { albedo, is_lambertian: moments.is_some() });
        let shaping = match (record.rise, record.short) {
            (Some(rise), Some(ShortRecord { sharpness })) => Shaping::Short(Short { sharpness, rise }),
            (Some(rise), None) => Shaping::OneWidth(OneWidth { rise, inverse_tail: record.inverse_tails[0].max(1.0) }),
            (None, _) => Shaping::Rows,
        };
        let (wide, curve) = (Wide::new(record.falloff, axis), record.reflectance.map(Curve));
        let frame = Frame { axes, base, shaping, curve, ..Frame::new(record.index, wide) };
        let tail = 1.0 / record.inverse_tails[0].max(1.0);
        let most = most_lobes(record);
        Self { tile, axis, frame, most, varying: record.varying, tail, family: None }
    }

    /// Takes the slope parameters and colours of a place, if rows are those of a family.
    fn place(&mut self, entry: &MaterialEntry, place: &Place) {
        let Some(record) = self.varying.and_then(|varying| varying.family) else { return };
        let family = family_of(record);
        let slopes = [0, family.interface].map(|number| {
            let (own, layer) = (place.layers.get(number), &entry.layers[number]);
            let along = own.map_or([1.0; 2], |own| own.alpha_factors);
            let [cos, sin] = own.map_or([1.0, 0.0], |own| own.tangent.to_array());
            let (s, c) = libm::sincos(layer.rotation);
            Slopes {
                along: [0, 1].map(|i: usize| layer.alpha_xy[i] * along[i] * place.sample.alpha_factor),
                turn: [c * cos - s * sin, s * cos + c * sin],
            }
        });
        self.frame.stretch = family.stretch(slopes);
        // A base of nothing but metal has the F0 of the file.
        let (metal, metallic) = metal_of(entry);
        let plain = Paint {
            metal,
            tint: [1.0; 3],
            metallic,
            film_factor: place.sample.film_factor,
            dielectric: {
                let own = place.layers.get(family.interface).and_then(|own| own.f0).map(|own| own.map(|own| own.f0));
                own.or(entry.layers[family.interface].f0).unwrap_or([DIELECTRIC_F0; 3])
            },
            index: entry.layers[family.interface].eta,
            albedo: place.base_color.or(self.frame.base.map(|base| base.albedo)).unwrap_or_default(),
            depth: {
                let (depths, slabs) = (entry.layers[0].optical_depth, slab_factors(place));
                [0, 1, 2].map(|c: usize| depths[c] * slabs[c])
            },
        };
        let paint = place.metal.map_or(plain, |mix| plain.mixed(mix));
        self.family = Some((family, slopes, paint));
    }
}

/// Changes that the textures of a place make to terms.
#[derive(Debug, Clone, Copy)]
struct Here {
    part: Part,
    alpha_factor: f64,
    /// Factors on the optical depth of the first slab, RGB.
    slab_factors: Rgb,
    film_factor: f64,
    /// A layer, the factor on the light that its interface does not reflect, and the weight of its edge tint.
    passing: Option<(usize, [Rgb; 2])>,
    /// F0 of the metal below a film, and its share.
    metal: (Rgb, f64),
}

impl Here {
    const NOMINAL: Self = Self {
        part: Part::All,
        alpha_factor: 1.0,
        slab_factors: [1.0; 3],
        film_factor: 1.0,
        passing: None,
        metal: ([0.0; 3], 0.0),
    };

    /// Fractional number of the tile of lobes, and the factor by which the slopes of its rows are divided.
    fn tile(&self, varying: &VaryingRecord) -> (f64, f64) {
        let last = f64::from(varying.tiles) - 1.0;
        let alpha = away(self.alpha_factor);
        let slab = self.slab_factors.map(away).iter().sum::<f64>() / 3.0;
        let place = match varying.factor {
            // A step before the root of 0.
            VaryingFactor::AlphaFactor => (alpha * (last + 1.0)).min(last),
            VaryingFactor::SlabFactor => slab * last,
            VaryingFactor::FilmFactor => {
                let [most, least] = varying.factors.unwrap_or([1.0, 0.0]);
                ((most - self.film_factor) / (most - least)).clamp(0.0, 1.0) * last
            }
            VaryingFactor::Family => varying.nominal(),
            VaryingFactor::Patina | VaryingFactor::WeightFactor => match self.part {
                Part::All => 0.0,
                Part::Grown => last - 1.0,
                Part::Bare => last,
            },
        };
        (place, self.alpha_factor.max(varying.least_spread))
    }

    /// Tiles of the energies of each channel, where what the slab absorbs gives each its own.
    fn tinted_tiles(&self, varying: &VaryingRecord) -> Option<[f64; 3]> {
        let [r, g, b] = self.slab_factors;
        let is_tinted = varying.factor == VaryingFactor::SlabFactor && (r != g || g != b);
        is_tinted.then(|| self.slab_factors.map(|factor| away(factor) * (f64::from(varying.tiles) - 1.0)))
    }
}

/// The most lobes that rows of a material have: a table may have parts of more.
pub(crate) fn most_lobes(record: &LobesRecord) -> usize {
    LOBES.max(record.lobes as usize)
}

/// Distance of the root of a factor from 1, along the tiles over it.
fn away(factor: f64) -> f64 {
    1.0 - factor.clamp(0.0, 1.0).sqrt()
}

/// F0 of the metal of a base of nothing but metal, and its share: none of another base.
fn metal_of(entry: &MaterialEntry) -> (Rgb, f64) {
    let f0 = entry.layers.last().filter(|base| base.kind == LayerKind::Conductor).and_then(|base| base.f0);
    f0.map_or(([0.0; 3], 0.0), |f0| (f0, 1.0))
}

/// Factors on the optical depth of the first slab at a place, RGB.
fn slab_factors(place: &Place) -> Rgb {
    let tint = place.layers.first().map_or([1.0; 3], |own| own.absorption_factors);
    tint.map(|tint| tint * place.sample.slab_factor)
}

impl<'a> TableTerms<'a> {
    /// The terms of a material, by number.
    ///
    /// # Errors
    /// A table that does not fit its layout, or a layer that needs a tile and has none.
    pub fn new(subject: &'a Subject<'_>, material: usize, weights: Weights) -> Result<Self, ReportError> {
        let mut terms = Self::whole(subject, material, weights)?;
        let entry = &subject.manifest.materials[material];
        if let Some(side) = entry.side() {
            terms.bare = Some(Box::new(Self::of_side(subject, &side, weights, &Place::NONE)?));
        } else if entry.constants.coat.is_some() {
            terms.bare = Some(Box::new(Self::at(subject, material, weights, &Place::NONE, Part::Bare)?));
        }
        Ok(terms)
    }

    /// The terms of all layers of a material.
    fn whole(subject: &'a Subject<'_>, material: usize, weights: Weights) -> Result<Self, ReportError> {
        let Some(entry) = subject.manifest.materials.get(material) else {
            return Err(ReportError::MaterialCount {
                manifest: subject.manifest.materials.len(),
                stacks: subject.stacks.len(),
            });
        };
        Self::of_entry(subject, entry, Cow::Borrowed(&entry.layers), weights)
    }

    /// The terms of layers by their records, those of a material.
    fn of_entry(
        subject: &'a Subject<'_>,
        entry: &MaterialEntry,
        records: Cow<'a, [LayerRecord]>,
        weights: Weights,
    ) -> Result<Self, ReportError> {
        let mut tables = [None; TableKind::ALL.len()];
        for kind in TableKind::ALL {
            if let Some(table) = subject.table(kind)? {
                tables[kind as usize] = Some((table, AngleAxis::of(&table)?));
            }
        }
        let mut terms = Self {
            tables,
            veil: recorded_veil(entry),
            lobes: entry
                .constants
                .lobes
                .as_ref()
                .and_then(|record| Some(Lobes::new(record, entry.layers.first()?.tiles[TableKind::Lobes]?))),
            records,
            weights,
            here: Here { metal: metal_of(entry), ..Here::NOMINAL },
            bare: None,
        };
        terms.lobes.iter_mut().for_each(|lobes| lobes.place(entry, &Place::NONE));
        for (layer, kind) in read_by(entry) {
            let is_computed = match kind {
                // A layer without a tile has D computed.
                TableKind::Distribution => entry.layers[layer].tiles[kind].is_none() || terms.table(kind).is_none(),
                TableKind::Phase => terms.table(kind).is_none(),
                _ => false,
            };
            if !is_computed && terms.tile(kind, layer).is_none() {
                return Err(ReportError::MissingTile { material: entry.name.clone(), layer, kind });
            }
        }
        Ok(terms)
    }

    /// The terms of some layers of a material at a place, by the records of its manifest.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(crate) fn at(
        subject: &'a Subject<'_>,
        material: usize,
        weights: Weights,
        place: &Place,
        part: Part,
    ) -> Result<Self, ReportError> {
        let mut terms = Self::whole(subject, material, weights)?;
        let entry = &subject.manifest.materials[material];
        terms.place(entry, place, part);
        if let (Part::Bare, Some(bare)) = (part, entry.constants.bare()) {
            // A film leaves its layer, and those below are numbered as with it.
            let missing = usize::from(!entry.weighs_film_of_path());
            let passing = terms.here.passing;
            terms.here.passing = passing.and_then(|(layer, passing)| Some((layer.checked_sub(missing)?, passing)));
            terms.records = std::iter::once(bare).chain(entry.layers.iter().skip(1 + missing)).cloned().collect();
        }
        Ok(terms)
    }

    /// The terms of the layers below a coat, [`MaterialEntry::side`] of a material, at a place of theirs.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(crate) fn of_side(
        subject: &'a Subject<'_>,
        side: &MaterialEntry,
        weights: Weights,
        place: &Place,
    ) -> Result<Self, ReportError> {
        let mut terms = Self::of_entry(subject, side, Cow::Owned(side.layers.clone()), weights)?;
        terms.place(side, place, Part::All);
        Ok(terms)
    }

    /// Takes the values of a place.
    fn place(&mut self, entry: &MaterialEntry, place: &Place, part: Part) {
        let passing = entry.layers.iter().enumerate().find_map(|(layer, record)| {
            let (own, nominal) = (place.layers.get(layer)?.f0?, record.f0?);
            let passing = [0, 1, 2].map(|c: usize| (1.0 - own[c].f0) / (1.0 - nominal[c]).max(1e-6));
            Some((layer, [passing, own.map(|own| own.dip())]))
        });
        self.lobes.iter_mut().for_each(|lobes| lobes.place(entry, place));
        let sample = &place.sample;
        self.here = Here {
            part,
            alpha_factor: sample.alpha_factor,
            slab_factors: slab_factors(place),
            film_factor: sample.film_factor,
            passing,
            metal: place.metal.map_or_else(|| metal_of(entry), |mix| (mix.metal, mix.metallic)),
        };
    }

    fn table(&self, kind: TableKind) -> Option<Table<'a>> {
        Some(self.tables[kind as usize]?.0)
    }

    /// Reflectance of an interface at this place, from its reflectance in the tables.
    fn passed(&self, layer: usize, cos_theta: f64, reflected: Rgb) -> Rgb {
        let here = self.here.passing.filter(|(at, _)| *at == layer);
        let [passing, dip] = here.map_or([[1.0; 3], [0.0; 3]], |(_, here)| here);
        let kept = dip.map(|dip| dip * edge_dip(cos_theta));
        let reflected = [0, 1, 2].map(|c: usize| 1.0 - passing[c] * (1.0 - reflected[c]));
        if kept == [0.0; 3] { reflected } else { [0, 1, 2].map(|c: usize| (reflected[c] - kept[c]).max(0.0)) }
    }

    /// Thickness of the film of a layer at this place, over the greatest thickness.
    fn film_share(&self, layer: usize) -> f64 {
        let record = &self.records[layer];
        let factor = if layer == 0 { self.here.film_factor } else { 1.0 };
        factor * record.film_thickness_nm / record.film_thickness_max_nm
    }

    /// Reflectances of a film over an F0, over the metal of this place and over the dielectric: at a cosine, in the mean over squared sines of a standard deviation.
    /// `None` of any other layer.
    fn film_ends(&self, layer: usize, cos_theta: f64, spread: f64) -> Option<[Rgb; 2]> {
        let record = self.records.get(layer).filter(|record| record.has_film_over_f0())?;
        let (table, _, tile) = self.read_at(TableKind::Phase, layer)?;
        let factor = 2.0 * self.here.film_factor;
        let waves = [0, 1, 2].map(|c: usize| factor * record.film_ior_n[c] * record.film_thickness_waves[c]);
        let film = FilmOverF0 { ior: record.film_ior_n[1], waves };
        let interference = |waves: f64| {
            let [r, g, b, _] = table.read(tile, [(waves / WAVES_MAX).min(1.0), 0.0], self.weights);
            [r, g, b]
        };
        let over = |f0: Rgb| film.reflectance(f0, cos_theta.clamp(0.0, 1.0), spread, interference);
        Some([over(self.here.metal.0), over([DIELECTRIC_F0; 3])])
    }

    /// The tile that a layer reads; `None` if the table does not have it.
    fn tile(&self, kind: TableKind, layer: usize) -> Option<u32> {
        let tiles = self.table(kind)?.entry.layout.tiles;
        self.records.get(layer)?.tiles[kind].filter(|tile| *tile < tiles)
    }

    /// The table of a kind, the quantity of its x axis, and the tile of a layer in it.
    fn read_at(&self, kind: TableKind, layer: usize) -> Option<(Table<'a>, AngleAxis, u32)> {
        let (table, angle) = self.tables[kind as usize]?;
        Some((table, angle, self.tile(kind, layer)?))
    }

    /// Name of the reflectance tile that a layer reads; empty for a layer without one.
    pub(crate) fn fresnel_name(&self, layer: usize) -> &str {
        let kind = if self.tile(TableKind::Film, layer).is_some() { TableKind::Film } else { TableKind::Fresnel };
        self.name(kind, layer)
    }

    /// Name of the tile of a kind that a layer reads; empty for a layer without one.
    pub(crate) fn name(&self, kind: TableKind, layer: usize) -> &str {
        let tile = self.table(kind).zip(self.tile(kind, layer));
        tile.and_then(|(table, tile)| table.entry.tiles.get(tile as usize)).map_or("", |tile| &tile.name)
    }
}

/// The veil of the layers above a diffuse base, as the record gives it to shaders of the statistical models.
pub(crate) fn recorded_veil(entry: &MaterialEntry) -> Veil<3> {
    let constants = &entry.constants;
    Veil { internal: constants.internal_reflectance, upward: [1.0 - constants.upward_loss; 3] }
}

/// Reflectance of a layer that has no rows because its closed form is as cheap: of an F0, or of transparent media of one index.
fn computed(record: &LayerRecord, cos_theta: f64) -> Option<Rgb> {
    if record.reflectance != Reflectance::Exact || record.film_ior_n[0] > 0.0 {
        return None;
    }
    let Some(f0) = record.f0 else {
        return record.has_one_index().then(|| [fresnel_dielectric(record.ior_n[0], cos_theta); 3]);
    };
    let tint = record.f82_tint.unwrap_or([1.0; 3]);
    Some([0, 1, 2].map(|c: usize| F82 { f0: f0[c], tint: tint[c] }.eval(cos_theta)))
}

/// Layers and tables without which the shader of a material cannot be evaluated.
fn read_by(entry: &MaterialEntry) -> impl Iterator<Item = (usize, TableKind)> {
    let kinds = TableKind::ALL.into_iter().filter(|kind| kind.facts().values != Values::Picture);
    let all = (0..entry.layers.len()).flat_map(move |layer| kinds.clone().map(move |kind| (layer, kind)));
    all.filter(|&(layer, kind)| reads(entry.model, kind, &entry.layers, layer))
}

impl Terms for TableTerms<'_> {
    /// Lobes may have a reflectance of the first interface of their own.
    fn fresnel(&self, layer: usize, cos_theta_d: f64) -> Rgb {
        if let Some(curve) = self.lobes.as_ref().and_then(|lobes| lobes.frame.curve).filter(|_| layer == 0) {
            return [curve.at(cos_theta_d); 3];
        }
        if let Some(reflected) = computed(&self.records[layer], cos_theta_d) {
            return self.passed(layer, cos_theta_d, reflected);
        }
        let cos_theta_d = self.records[layer].row_cosine(cos_theta_d);
        if let Some([metal, plastic]) = self.film_ends(layer, cos_theta_d, 0.0) {
            return [0, 1, 2].map(|c: usize| plastic[c] + self.here.metal.1 * (metal[c] - plastic[c]));
        }
        let [r, g, b, _] = if let Some((table, _, tile)) = self.read_at(TableKind::Film, layer) {
            table.read(tile, [cos_theta_d, self.film_share(layer)], self.weights)
        } else if let Some((table, angle, tile)) = self.read_at(TableKind::Fresnel, layer) {
            table.read(tile, [angle.value_at(cos_theta_d), 0.0], self.weights)
        } else {
            [f64::NAN; 4]
        };
        self.passed(layer, cos_theta_d, [r, g, b])
    }

    /// A read, if the layer has a tile; else the closed form.
    fn distribution(&self, layer: usize, form: Distribution, alpha: f64, cos_theta_h: f64, sin_theta_h_sq: f64) -> f64 {
        match self.read_at(TableKind::Distribution, layer) {
            Some((table, angle, tile)) => {
                table.read(tile, [angle.value(cos_theta_h, sin_theta_h_sq), alpha], self.weights)[0]
            }
            _ => scaled_distribution(form, alpha, cos_theta_h, sin_theta_h_sq),
        }
    }

    /// The interference term from the row over s, the sum of the cosines times d / (2 d_max) (Granier and Heidrich 2003, eq. 19).
    fn interference(&self, layer: usize, channel: usize, cosines: f64) -> Option<f64> {
        let (table, _, tile) = self.read_at(TableKind::Phase, layer)?;
        let s = 0.5 * cosines * self.film_share(layer);
        Some(table.read(tile, [s, 0.0], self.weights)[channel])
    }
}

impl Energy<3> for TableTerms<'_> {
    fn fgd(&self, layer: usize, cos_theta_i: f64, alpha: f64) -> Rgb {
        match self.read_at(TableKind::Fgd, layer) {
            Some((table, angle, tile)) => {
                let [r, g, b, _] = table.read(tile, [angle.value_at(cos_theta_i), alpha], self.weights);
                self.passed(layer, cos_theta_i, [r, g, b])
            }
            _ => [f64::NAN; 3],
        }
    }

    /// The axis of the table is the cosine outside: that of the direction which refracts to `cos_theta_i`.
    fn escaping(&self, layer: usize, cos_theta_i: f64, alpha: f64, eta: f64) -> f64 {
        match self.read_at(TableKind::Escape, layer) {
            Some((table, _, tile)) => {
                let sin_sq = (1.0 - cos_theta_i) * (1.0 + cos_theta_i) / (eta * eta);
                table.read(tile, [(1.0 - sin_sq).max(0.0).sqrt(), alpha], self.weights)[0]
            }
            _ => f64::NAN,
        }
    }
}

impl ShaderTerms for TableTerms<'_> {
    fn veil(&self) -> Veil<3> {
        self.veil
    }

    fn below(&self, wo: DVec3) -> Option<Below> {
        let Lobes { tile, axis, frame, most, varying, tail, family } = self.lobes.as_ref().filter(|_| wo.z > 0.0)?;
        let (table, cos_theta) = (self.table(TableKind::Lobes)?, axis.cosine(wo.z));
        let row = match (frame.axes, varying) {
            (Some(axes), _) => axes.row(wo, |number| table.row(*most, tile + number as u32, cos_theta, self.weights)),
            (None, Some(_)) if let Some((family, slopes, paint)) = family => {
                let alphas = slopes.map(Slopes::mean);
                let [coat, base] = family.places(alphas).map(|place| (place as usize, place.fract()));
                let of = |coat: usize| {
                    let first = tile + (coat * family.base.nodes + base.0) as u32;
                    table.family_row((*family, *tail), (first, base.1), cos_theta, self.weights)
                };
                let row = if coat.1 > 0.0 { of(coat.0).between(&of(coat.0 + 1), coat.1) } else { of(coat.0) };
                let ends = |cos_theta, spread| self.film_ends(family.interface, cos_theta, spread);
                let film = ends(1.0, 0.0).map(|_| {
                    let ior = self.records[family.interface].film_ior_n[1];
                    FilmLight::new(*family, &row, ior, |cos_theta, spread| ends(cos_theta, spread).unwrap_or_default())
                });
                family.row_in(&row, alphas, (frame, wo.z), paint, film.as_ref())
            }
            (None, Some(varying)) => {
                let (place, spread) = self.here.tile(varying);
                let read = |place: f64| {
                    let first = (place as u32).min(varying.tiles.saturating_sub(2));
                    table.row_between(tile + first, place - f64::from(first), cos_theta, self.weights)
                };
                let row = match self.here.tinted_tiles(varying).map(|places| places.map(read)) {
                    Some([r, g, b]) => read(place).with_channels([&r, &g, &b]),
                    None => read(place),
                };
                row.spread(spread)
            }
            (None, None) => table.row(*most, *tile, cos_theta, self.weights),
        };
        Some(Below::new(*frame, row, wo))
    }

    fn bare(&self) -> Option<&dyn ShaderTerms> {
        self.bare.as_deref().map(|bare| bare as &dyn ShaderTerms)
    }
}
