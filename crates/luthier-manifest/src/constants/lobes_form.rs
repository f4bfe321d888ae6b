//! How many lobes rows have.

use serde::{Deserialize, Serialize};

use super::LobesRecord;

luthier_lut::named! {
    /// Form of rows of lobes, from the fewest reads of a view to the most.
    ///
    /// ```
    /// use luthier_manifest::LobesForm;
    ///
    /// assert_eq!(LobesForm::ALL.map(LobesForm::most), [0, 1, 1, 1, 2, 3]);
    /// assert_eq!(LobesForm::OneWidth.words(), "one lobe of one width");
    /// ```
    #[derive(Serialize, Deserialize)]
    #[serde(into = "&'static str", try_from = "String")]
    pub enum LobesForm("form of lobes") {
        /// The wide remainder alone, beside one facet of the first interface.
        NoLobe = "no-lobe",
        /// One lobe, all of whose shape but a shift follows from the view, without a remainder.
        ShortLobe = "short-lobe",
        /// One lobe, whose other width follows from the view.
        OneWidth = "one-width",
        /// One lobe of two widths.
        OneLobe = "one-lobe",
        /// Two lobes.
        TwoLobes = "two-lobes",
        /// Three lobes.
        ThreeLobes = "three-lobes",
    }
}

impl LobesForm {
    /// The most lobes.
    pub const fn most(self) -> usize {
        match self {
            Self::NoLobe => 0,
            Self::ShortLobe | Self::OneWidth | Self::OneLobe => 1,
            Self::TwoLobes => 2,
            Self::ThreeLobes => 3,
        }
    }

    /// The form in words.
    pub const fn words(self) -> &'static str {
        match self {
            Self::NoLobe => "no lobe",
            Self::ShortLobe => "one short lobe",
            Self::OneWidth => "one lobe of one width",
            Self::OneLobe => "one lobe",
            Self::TwoLobes => "two lobes",
            Self::ThreeLobes => "three lobes",
        }
    }

    /// The form of the rows of a material; `None` where they are over a factor beside the view.
    pub const fn of(record: &LobesRecord) -> Option<Self> {
        match (record.varying, record.lobes, record.rise) {
            (Some(_), ..) => None,
            (None, 0, _) => Some(Self::NoLobe),
            (None, _, Some(_)) if record.short.is_some() => Some(Self::ShortLobe),
            (None, _, Some(_)) => Some(Self::OneWidth),
            (None, 1, None) => Some(Self::OneLobe),
            (None, 2, None) => Some(Self::TwoLobes),
            (None, _, None) => Some(Self::ThreeLobes),
        }
    }
}
