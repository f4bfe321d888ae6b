//! Options of a bake, beside the settings of its materials.

use luthier_lut::{FormatSet, RowBase, RowLayout, TexelFormat};
use luthier_manifest::{Budget, Decision};
use luthier_material::Material;

use crate::BakeError;

/// Options of a bake, beside the settings of its materials.
///
/// ```
/// # let text = "schema = 1\nname = \"metal\"\n[[layer]]\ntype = \"conductor\"\nior = { n = 0.2, k = 3.0 }\nalpha = 0.1\n";
/// # let read = |_: &str| Err(std::io::ErrorKind::NotFound.into());
/// # let metal = luthier_material::parse("metal.toml", text, &read).unwrap().material;
/// use luthier_bake::{MemoryStore, Options, outline_with};
///
/// let options = Options { search: false, ..Options::default() };
/// let outline = outline_with(&[metal], &options, &|_, _| Err("no images".into()), &MemoryStore::default())?;
/// let (_, rows, _) = &outline.tables[0]; // Fresnel rows
/// assert_eq!((rows.x.size, outline.searches.len()), (128, 0));
/// # Ok::<(), luthier_bake::BakeError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options<'a> {
    /// Limits. Each replaces the limit of the materials.
    pub budget: Budget,
    /// Whether to search for the sizes, mappings and formats that no material decides. Without a search they are fixed
    /// defaults, and budgets do not count.
    pub search: bool,
    /// Base and format of Fresnel rows, in place of a search. Size and axis come from the materials, or are fixed.
    pub rows: Option<(RowBase, TexelFormat)>,
    /// Texel formats that a search may take: the formats of core WebGPU, unless the target is known.
    pub formats: FormatSet,
    /// Layout of rows of lobes. Without one it is [`RowLayout::Steps`] where every tile is read by itself, more than two parts for each view, no limit on bytes holds and
    /// `formats` has its format, else [`RowLayout::Filtered`]. On an NVIDIA H200 a filtered read of four halves costs 1.3 ps, one of 16 bytes in a buffer .44; between two
    /// tiles a sampler reads for no more, and a shader twice in a buffer.
    pub layout: Option<RowLayout>,
    /// Whether an outline fits lobes, whose number decides tables and shaders. A fit takes seconds; a bake always fits.
    pub fits: bool,
    /// Decisions of an earlier search, which stay as long as they hold the budget.
    pub locked: &'a [Decision],
}

impl Default for Options<'_> {
    fn default() -> Self {
        Self {
            budget: Budget::default(),
            search: true,
            rows: None,
            formats: FormatSet::CORE,
            layout: None,
            fits: true,
            locked: &[],
        }
    }
}

/// The tightest limits of the materials; a limit of the options replaces them.
///
/// # Errors
/// [`BakeError::BudgetValue`] of a limit that is not a positive number.
pub(crate) fn budget(materials: &[Material], given: &Budget) -> Result<Budget, BakeError> {
    let stated = materials.iter().map(|material| material.budget).fold(Budget::default(), |a, b| a.tighter(&b));
    let budget = Budget {
        max_abs: given.max_abs.or(stated.max_abs),
        max_rel: given.max_rel.or(stated.max_rel),
        delta_e: given.delta_e.or(stated.delta_e),
        max_bytes: given.max_bytes.or(stated.max_bytes),
        max_cost: given.max_cost.or(stated.max_cost),
        max_lobe_err: given.max_lobe_err.or(stated.max_lobe_err),
        max_albedo_err: given.max_albedo_err.or(stated.max_albedo_err),
    };
    let examples = ["1e-3", "1e-2", "0.5", "65536", "200", "0.05", "0.01"];
    for ((name, value), example) in budget.limits().into_iter().zip(examples) {
        if let Some(value) = value.filter(|v| !(v.is_finite() && *v > 0.0)) {
            return Err(BakeError::BudgetValue { name, value, example });
        }
    }
    Ok(budget)
}
