//! Defaults: the models of materials whose files name none.

/// Kind of material, for the choice of its default model.
///
/// ```
/// use luthier_model::{DefaultFor, ShadingModel};
///
/// let stack: Vec<ShadingModel> = DefaultFor::Stack.models().collect();
/// assert_eq!(stack, [ShadingModel::Lobes, ShadingModel::Belcour, ShadingModel::Yamaguchi]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DefaultFor {
    /// Several layers: models that follow light through them and return no more than falls in, the nearest to the simulation first
    /// (`docs/pages/lobes.md`, `docs/pages/models.md`).
    Stack,
    /// One rough interface: models that give it its further bounces.
    Facets,
    /// Nothing to simulate: closed forms. They agree on one interface, and the first is the cheapest. The last shows everything that a file
    /// can ask for.
    Closed,
}
