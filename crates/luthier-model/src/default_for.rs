//! Defaults: the models of materials whose files name none.

/// Kind of material, for the choice of its default model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DefaultFor {
    /// Several layers: models that follow light through them and return no more than falls in, the nearest to the simulation first
    /// (`docs/pages/lobes.md`, `docs/pages/models.md`).
    Stack,
    /// One rough interface: models that give it its further bounces.
    Facets,
    /// Nothing that is simulated: closed forms. Of one interface all are the same, and the first is the cheapest. The last shows all that a
    /// file can ask for.
    Closed,
}
