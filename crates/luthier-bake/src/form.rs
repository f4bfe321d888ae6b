//! Forms of rows of lobes.

use luthier_manifest::LobesForm;

/// Form of the rows of a material.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct RowForm {
    /// Most lobes, if a file or a search decides them; else a material has as many as it needs.
    pub(crate) most: Option<usize>,
    /// Widths for each lobe.
    pub(crate) widths: Widths,
    /// Whether the first interface reflects by a polynomial. A short lobe has one anyway.
    pub(crate) is_curved: bool,
}

impl RowForm {
    /// As many lobes as a material needs.
    pub(crate) const NEEDED: Self = Self { most: None, widths: Widths::Two, is_curved: false };

    /// At most so many lobes of two widths.
    pub(crate) const fn at_most(lobes: usize) -> Self {
        Self { most: Some(lobes), ..Self::NEEDED }
    }

    /// The form that a file asks for.
    pub(crate) const fn asked(form: LobesForm) -> Self {
        let widths = match form {
            LobesForm::ShortLobe => Widths::Short,
            LobesForm::OneWidth => Widths::One,
            LobesForm::NoLobe | LobesForm::OneLobe | LobesForm::TwoLobes | LobesForm::ThreeLobes => Widths::Two,
        };
        Self { widths, ..Self::at_most(form.most()) }
    }
}

/// Widths that rows have for a lobe.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Widths {
    /// Two for each lobe.
    Two,
    /// One for a single lobe.
    One,
    /// None, for a short lobe.
    Short,
}

impl Widths {
    /// Widths of all rows where forms have the same; where they differ, rows have places for two. A form without a lobe has any but a short one's.
    pub(crate) fn common(forms: &[RowForm]) -> Self {
        let all = |has: fn(&RowForm) -> bool| forms.iter().all(has);
        match forms {
            [] => Self::Two,
            _ if all(|form| form.widths == Self::Short) => Self::Short,
            _ if all(|form| form.most == Some(0)) => Self::Two,
            _ if all(|form| form.widths == Self::One || form.most == Some(0)) => Self::One,
            _ => Self::Two,
        }
    }

    /// The name, in keys.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Two => "two",
            Self::One => "one",
            Self::Short => "none",
        }
    }
}
