//! Fates of the properties of a source.

luthier_lut::named! {
    /// Fate of a property on its way into a material file.
    pub enum Fate("fate") {
        /// It means the same, and the file says it.
        Kept = "kept",
        /// It follows from a formula without error.
        ClosedForm = "closed form",
        /// The file has something near it; the note says what differs.
        Approximated = "approximated",
        /// It is lost.
        Dropped = "dropped",
        /// It is none of a reflectance: the program that draws has it.
        Host = "the host's",
    }
}

/// A property of a source, and what became of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// The property, as the source names it.
    pub property: String,
    /// Its fate.
    pub fate: Fate,
    /// How, or why.
    pub note: String,
}

impl Line {
    pub(crate) fn new(property: &str, fate: Fate, note: impl Into<String>) -> Self {
        Self { property: property.to_owned(), fate, note: note.into() }
    }
}
