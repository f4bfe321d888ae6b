//! Tables of the grammar: keys, kinds of values, and bounds.

/// Version of the grammar that this crate reads.
pub(crate) const SCHEMA_VERSION: i64 = 1;

/// A table: its keys, and what must hold between them.
pub(crate) struct Table {
    /// Name, for messages and for the schema.
    pub(crate) name: &'static str,
    /// Description of the table.
    pub(crate) doc: &'static str,
    /// Its keys.
    pub(crate) keys: &'static [Key],
    /// Groups of keys: the table takes exactly one of them.
    pub(crate) exactly_one: Option<Alternatives>,
}

/// Alternative ways to say a thing: a table takes exactly one.
pub(crate) struct Alternatives {
    /// Name of the alternatives, with its article.
    pub(crate) what: &'static str,
    /// Each way is one or more keys that go together.
    pub(crate) forms: &'static [&'static [&'static str]],
    /// The ways as a reader would write them.
    pub(crate) examples: &'static str,
    /// Whether several ways may be given together, so that only one is needed.
    pub(crate) together: bool,
    /// Alternatives that the table has besides.
    pub(crate) and: Option<&'static Alternatives>,
}

/// A key of a table.
pub(crate) struct Key {
    pub(crate) name: &'static str,
    pub(crate) kind: Kind,
    pub(crate) doc: &'static str,
    pub(crate) required: bool,
    /// Value when absent, in JSON; empty when absence has a meaning of its own.
    pub(crate) default: &'static str,
}

/// Kind of a value.
pub(crate) enum Kind {
    /// `true` only.
    True,
    /// `true` or `false`.
    Flag,
    /// A finite number.
    Number(Range),
    /// A whole number between two bounds, both included.
    Integer(i64, i64),
    /// A string.
    Text(TextForm),
    /// One of some strings.
    Choice(&'static [&'static str]),
    /// An array of so many values of one kind.
    List { item: &'static Kind, min: usize, max: usize },
    /// A table.
    Table(&'static Table),
    /// An array of at most so many tables that say in `tag` what they are.
    Tagged { tag: &'static str, variants: &'static [&'static Table], max: usize },
    /// One of several kinds; no two share a TOML type.
    OneOf(&'static [Kind]),
}

/// Layers and films of a material, and lights of a scene.
pub(crate) const LAYERS_MAX: usize = 64;

/// Materials of a scene.
pub(crate) const SCENE_MATERIALS_MAX: usize = 4096;

/// Characters of a name. Files of a bake are named after materials, with up to 30 characters more, and shaders have constants of such
/// names; file systems take 255 bytes.
pub(crate) const NAME_MAX: usize = 100;

/// Bytes of each name in a path, and of the path: what file systems take.
pub(crate) const PATH_MAX: [usize; 2] = [255, 4095];

/// Form of a string.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum TextForm {
    /// Anything.
    Prose,
    /// Letters, digits and hyphens; the first is no hyphen.
    Name,
    /// A string that is not empty.
    Path,
}

/// Bounds of a number.
#[derive(Clone, Copy)]
pub(crate) struct Range {
    pub(crate) min: f64,
    pub(crate) max: f64,
    /// Whether `min` itself is left out.
    pub(crate) above: bool,
}

impl Range {
    pub(crate) fn contains(self, value: f64) -> bool {
        value.is_finite() && value <= self.max && if self.above { value > self.min } else { value >= self.min }
    }
}

pub(crate) const ANY: Range = Range { min: f64::NEG_INFINITY, max: f64::INFINITY, above: false };
/// More than any quantity of a file, in any unit. Its square does not overflow single precision.
const VAST: f64 = 1e12;

pub(crate) const POSITIVE: Range = Range { min: 0.0, max: VAST, above: true };
pub(crate) const NOT_NEGATIVE: Range = Range { min: 0.0, max: VAST, above: false };
pub(crate) const UNIT: Range = Range { min: 0.0, max: 1.0, above: false };
pub(crate) const UNIT_ABOVE_ZERO: Range = Range { min: 0.0, max: 1.0, above: true };

pub(crate) const NOT_NEGATIVE_RGB: Kind =
    Kind::OneOf(&[Kind::Number(NOT_NEGATIVE), Kind::List { item: &Kind::Number(NOT_NEGATIVE), min: 3, max: 3 }]);
pub(crate) const UNIT_RGB: Kind =
    Kind::OneOf(&[Kind::Number(UNIT), Kind::List { item: &Kind::Number(UNIT), min: 3, max: 3 }]);

/// Reflectances whose values a little above 1 are read as 1: colours of wide gamuts exceed 1 in Rec.709.
pub(crate) const REFLECTANCES: [&str; 3] = ["albedo", "base_color", "f0"];
/// Largest reflectance that is read as 1: the primaries of ACEScg have up to 1.71 in Rec.709.
pub(crate) const REFLECTANCE_READ_MAX: f64 = 2.0;

pub(crate) const PATH: Kind = Kind::Text(TextForm::Path);

impl Key {
    pub(crate) const fn required(name: &'static str, kind: Kind, doc: &'static str) -> Self {
        Self { name, kind, doc, required: true, default: "" }
    }

    pub(crate) const fn optional(name: &'static str, kind: Kind, doc: &'static str) -> Self {
        Self { name, kind, doc, required: false, default: "" }
    }

    pub(crate) const fn with_default(name: &'static str, kind: Kind, default: &'static str, doc: &'static str) -> Self {
        Self { name, kind, doc, required: false, default }
    }
}

impl Table {
    /// Every group of alternatives.
    pub(crate) fn alternatives(&self) -> impl Iterator<Item = &Alternatives> {
        std::iter::successors(self.exactly_one.as_ref(), |alternatives| alternatives.and)
    }

    pub(crate) fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|k| k.name == name)
    }
}
