//! One set of table settings for all materials of a bake.

use std::collections::BTreeMap;
use std::fmt::Debug;

use luthier_lut::{Axis, FormatSet, Mapping, RowBase, RowLayout, TableKind, TexelFormat};
use luthier_manifest::CandidateForm;
use luthier_material::{BakeSettings, Material};

use crate::BakeError;
use crate::form::RowForm;
use crate::graph::Key;

/// Axes, format and base of the tiles of a kind.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Shape {
    pub(crate) x: Axis,
    pub(crate) y: Option<Axis>,
    pub(crate) format: TexelFormat,
    pub(crate) base: RowBase,
}

impl Shape {
    /// Tiles with two axes.
    pub(crate) fn grid([x, y]: [Axis; 2], format: TexelFormat) -> Self {
        Self { x, y: Some(y), format, base: RowBase::Zero }
    }

    /// Rows.
    pub(crate) fn row(x: Axis, format: TexelFormat) -> Self {
        Self { x, y: None, format, base: RowBase::Zero }
    }

    /// The axes of a kind of table that has two.
    pub(crate) fn axes(&self) -> [Axis; 2] {
        let y = self.y.clone().unwrap_or_else(|| unreachable!("tables of this kind have two axes"));
        [self.x.clone(), y]
    }

    /// The shape of a candidate; none for a closed form.
    fn of(form: &CandidateForm) -> Option<Self> {
        match form.clone() {
            CandidateForm::ClosedForm => None,
            CandidateForm::Table { x, y, format, base } => Some(Self { x, y, format, base }),
        }
    }
}

/// Parts of the shape of a kind that materials decide. No search changes them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Asked {
    pub(crate) size: bool,
    pub(crate) mapping: bool,
    pub(crate) format: bool,
}

impl Asked {
    /// All parts, or none.
    pub(crate) fn all(is_asked: bool) -> Self {
        Self { size: is_asked, mapping: is_asked, format: is_asked }
    }

    pub(crate) fn is_any(self) -> bool {
        self != Self::default()
    }

    pub(crate) fn or(self, other: Self) -> Self {
        Self {
            size: self.size || other.size,
            mapping: self.mapping || other.mapping,
            format: self.format || other.format,
        }
    }
}

/// Shapes of the tables of every kind.
#[derive(Debug, Clone)]
pub(crate) struct Settings {
    /// The shapes without a search.
    fixed: [Shape; TableKind::ALL.len()],
    /// None for kinds that shaders compute.
    shapes: [Option<Shape>; TableKind::ALL.len()],
    asked: [Asked; TableKind::ALL.len()],
    /// Formats that tables may have, see [`crate::Options::formats`].
    pub(crate) formats: FormatSet,
    /// Forms of rows of lobes by the keys of fits, if a search decides them, and none before it has.
    pub(crate) lobes: Option<BTreeMap<Key, RowForm>>,
}

impl Settings {
    /// Settings with these shapes, until a search finds others.
    pub(crate) fn new(fixed: [Shape; TableKind::ALL.len()], asked: [Asked; TableKind::ALL.len()]) -> Self {
        Self { shapes: fixed.clone().map(Some), fixed, asked, formats: FormatSet::CORE, lobes: None }
    }

    /// The shape of the tables of a kind; none for kinds that shaders compute.
    pub(crate) fn shape(&self, kind: TableKind) -> Option<&Shape> {
        self.shapes[kind as usize].as_ref()
    }

    /// The shape that tables of a kind have without a search.
    pub(crate) fn fixed(&self, kind: TableKind) -> &Shape {
        &self.fixed[kind as usize]
    }

    /// The parts of the shape of a kind that the materials decide.
    pub(crate) fn asked(&self, kind: TableKind) -> Asked {
        self.asked[kind as usize]
    }

    /// The formats of a list that the target can read.
    pub(crate) fn allowed(&self, formats: &[TexelFormat]) -> Vec<TexelFormat> {
        formats.iter().copied().filter(|format| self.formats.has(*format)).collect()
    }

    /// Takes the form of a candidate for the tables of a kind.
    pub(crate) fn apply(&mut self, kind: TableKind, form: &CandidateForm) {
        self.shapes[kind as usize] = Shape::of(form);
    }

    /// Takes a shape for tiles of lobes.
    pub(crate) fn take_lobes(&mut self, shape: Shape) {
        let kind = TableKind::Lobes as usize;
        self.fixed[kind] = shape;
        self.shapes[kind] = Some(self.fixed[kind].clone());
    }

    /// Takes a layout for rows of lobes.
    pub(crate) fn take_layout(&mut self, layout: RowLayout) {
        let fixed = self.fixed(TableKind::Lobes).clone();
        self.take_lobes(Shape { format: layout.format(), ..fixed });
    }

    /// Takes a base and format for Fresnel rows, and leaves nothing to search for.
    pub(crate) fn take_rows(&mut self, (base, format): (RowBase, TexelFormat)) {
        let rows = TableKind::Fresnel as usize;
        self.fixed[rows] = Shape { base, format, ..self.fixed[rows].clone() };
        self.shapes[rows] = Some(self.fixed[rows].clone());
        self.asked[rows] = Asked::all(true);
    }
}

pub(crate) fn axis(quantity: &str, unit: &str, [min, max]: [f64; 2], size: u32, mapping: Mapping) -> Axis {
    Axis { quantity: quantity.to_owned(), unit: unit.to_owned(), min, max, size, mapping }
}

/// The materials, asked for one setting at a time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ask<'a>(pub(crate) &'a [Material]);

impl Ask<'_> {
    /// The value of a setting, if all materials that state one agree.
    pub(crate) fn one<T: PartialEq + Debug>(
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

    pub(crate) fn format(
        &self,
        setting: &'static str,
        get: impl Fn(&BakeSettings) -> Option<TexelFormat>,
        default: TexelFormat,
    ) -> Result<TexelFormat, BakeError> {
        Ok(self.one(setting, get)?.unwrap_or(default))
    }
}
