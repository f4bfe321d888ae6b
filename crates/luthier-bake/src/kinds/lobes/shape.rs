//! Shapes of tiles of lobes: parts of rows, numbers of rows, layouts.

use luthier_layers::models::lobes::{
    Family, FitSettings, LOBES, LOBES_MAX, Paint, Row, Short, Varied, Varying, base_below, shown,
};
use luthier_lut::{Axis, Mapping, RowLayout, TexelFormat};
use luthier_manifest::{Budget, LobesForm};
use luthier_material::Material;

use super::rows::{ROWS, has_base, is_family, of_model, side, varying};
use crate::form::{RowForm, Widths};
use crate::options::Options;
use crate::settings::{Shape, axis};

/// Rows by default that suffice for all materials. Layers below a coat have the rows of the others.
fn common_rows(materials: &[Material]) -> usize {
    of_model(materials).map(|material| FitSettings::of(varying(material)).rows).max().unwrap_or(ROWS)
}

/// Numbers of the first part and of the last that rows of materials have, with at most so many lobes.
pub(super) fn parts(materials: &[Material], lobes: usize) -> [i32; 2] {
    let sides: Vec<Material> = of_model(materials).filter_map(side).collect();
    let ends = of_model(materials).chain(&sides).map(|material| match varying(material) {
        Some(Varying::Family(family)) => {
            let parts = family.parts(
                has_lengths(material, family),
                base_below(&material.stack).is_some(),
                family.is_filmed(&material.stack),
            );
            ([family.first_part(), parts as i32 - 1], true)
        }
        _ => ([if has_base(material) { -BASE_PARTS } else { 0 }, Row::parts(lobes) as i32 - 1], false),
    });
    let ends: Vec<([i32; 2], bool)> = ends.collect();
    let ([mut first, mut last], _) = (ends.iter().copied())
        .reduce(|([first, last], _), ([from, to], _)| ([first.min(from), last.max(to)], true))
        .unwrap_or(([0, Row::parts(lobes) as i32 - 1], false));
    let has = |of_family: bool| ends.iter().any(|(_, is_family)| *is_family == of_family);
    if has(true) && has(false) {
        // Beside families other rows have all parts of a base before part 0, or none, and those of two lobes.
        first = if first < 0 { -BASE_PARTS } else { 0 };
        last = last.max(Row::parts(LOBES) as i32 - 1);
    }
    [first, last]
}

/// Number of parts of a diffuse base.
pub(super) const BASE_PARTS: i32 = Row::BASE_PARTS as i32;

/// Whether rows of a family have lengths of light in a slab, or cosines at which the facets below a film are seen.
pub(super) fn has_lengths(material: &Material, family: Family) -> bool {
    let is_under_film = !family.is_coated() && family.is_filmed(&material.stack);
    is_under_film || Paint::of(&material.stack).depth != [0.0; 3]
}

/// The layout of rows that options ask for, or else the cheaper one: see [`Options::layout`].
pub(crate) fn layout(materials: &[Material], options: &Options<'_>, asked: &Budget) -> RowLayout {
    let has_one_tile = |material: &Material| {
        let varying = varying(material);
        !is_family(varying) && Varied::tiles_of(&shown(&material.stack), varying) == 1
    };
    let is_alone =
        |material: &Material| has_one_tile(material) && side(material).is_none_or(|side| has_one_tile(&side));
    let reads = of_model(materials).map(|material| material.bake.lobes.map_or(LOBES, LobesForm::most)).map(reads).max();
    let hides = Widths::of(materials) != Widths::Two || reads.is_some_and(|reads| reads <= HIDDEN_READS);
    options.layout.unwrap_or_else(|| {
        let has_room = asked.max_bytes.is_none() && options.formats.has(RowLayout::Steps.format());
        let in_steps = has_room && !hides && of_model(materials).all(is_alone);
        if in_steps { RowLayout::Steps } else { RowLayout::Filtered }
    })
}

/// The shape of tiles with parts from the first to the last.
pub(super) fn shape([first, last]: [i32; 2], rows: usize, format: TexelFormat) -> Shape {
    let axes = [
        axis("cos_theta", "", [0.0, 1.0], rows as u32, Mapping::Rational { bend: 1.0 }),
        axis("part", "", [first, last].map(f64::from), (last - first) as u32 + 1, Mapping::Apart),
    ];
    Shape::grid(axes, format)
}

/// Parts of rows with so many lobes that the light of a view takes.
pub(super) fn reads(lobes: usize) -> usize {
    [1, 3, 4, 6][lobes.min(LOBES_MAX)]
}

/// Most reads of a texture for a view that take no time of their own: by the costs of the H100 two hide behind the arithmetic of the shader (5.7 ps, 7.2 in a buffer),
/// and three do not (8.2 and 7.5).
pub(super) const HIDDEN_READS: usize = 2;

/// The shape of tiles with these widths, whose parts would otherwise go from the first to the last.
pub(super) fn shape_of(widths: Widths, [first, last]: [i32; 2], rows: usize, format: TexelFormat) -> Shape {
    match widths {
        Widths::Two => shape([first, last], rows, format),
        Widths::One => shape([first, ONE_WIDTH_LAST], rows, format),
        Widths::Short => shape([Short::FIRST_PART, ONE_WIDTH_LAST], rows, format),
    }
}

/// The shape of the tiles of materials with at most so many lobes, with the rows that suffice for all.
pub(super) fn shape_with(materials: &[Material], widths: Widths, lobes: usize, format: TexelFormat) -> Shape {
    shape_of(widths, parts(materials, lobes), common_rows(materials), format)
}

impl Widths {
    /// Widths of all rows by the forms of files.
    pub(super) fn of(materials: &[Material]) -> Self {
        let forms = of_model(materials).map(|material| material.bake.lobes.map_or(RowForm::NEEDED, RowForm::asked));
        Self::common(&forms.collect::<Vec<_>>())
    }

    /// Widths of tiles with such parts.
    pub(super) fn in_parts(parts: &Axis) -> Self {
        match [parts.min, parts.max].map(|part| part as i32) {
            [Short::FIRST_PART, ONE_WIDTH_LAST] => Self::Short,
            [_, ONE_WIDTH_LAST] => Self::One,
            _ => Self::Two,
        }
    }

    /// Parts of rows with so many lobes that the light of a view takes.
    pub(super) fn reads(self, lobes: usize) -> usize {
        match self {
            Self::Two => reads(lobes),
            Self::One => 2,
            Self::Short => 1,
        }
    }
}

/// Number of the last part of rows with one lobe of one width: light takes the parts before it. No other rows end there.
const ONE_WIDTH_LAST: i32 = 2;
