//! The row of facts of a model.

use luthier_lut::TableKind;

use crate::default_for::DefaultFor;
use crate::domain::Limit;
use crate::feature::Feature;
use crate::form::Form;
use crate::parts::ModelPart;
use crate::tolerance::Tolerances;

/// The facts of a model, by which other crates know it. A model is added as one row in `rows.rs`, its formula in luthier-layers, and its module in
/// luthier-shader.
#[derive(Debug, Clone, Copy)]
pub struct Facts {
    /// Name and source, for headers and reports.
    pub title: &'static str,
    /// Heading of pages under which it stands, beside models of the same source or kind.
    pub heading: &'static str,
    /// Models in f64 alone that stand under that heading, too.
    pub beside: &'static [&'static str],
    /// How the model follows light.
    pub family: Family,
    /// Layers that its shader reads.
    pub reach: Reach,
    /// Whether it takes one slope parameter for both axes of a surface.
    pub is_isotropic: bool,
    /// Forms of its shader.
    pub forms: &'static [Form],
    /// Features that it shows.
    pub shows: Shows,
    /// Tables that its `baked` shader reads.
    pub tables: &'static [TableRead],
    /// Parts that a material may choose.
    pub parts: &'static [ModelPart],
    /// Ranges within which it may be used, beside those that hold for all models.
    pub domain: &'static [Limit],
    /// Errors that its shader is held to.
    pub tolerances: Tolerances,
    /// Places among the defaults: the lower the number, the earlier.
    pub default_for: &'static [(DefaultFor, u8)],
}

impl Facts {
    /// Whether a material may choose a part of the model.
    pub fn takes(&self, part: ModelPart) -> bool {
        self.parts.contains(&part)
    }
}

/// How a model follows light through a stack. Models of a family share modules of the shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Down a path of refracted directions, layer by layer.
    Path,
    /// As statistics of lobes, whose energies are tabulated.
    Statistics,
    /// By the boundaries of one film, each with a lobe of its own.
    Beams,
    /// By coefficients of a stack at normal incidence.
    Coefficients,
    /// By the facets of one interface.
    Facets,
    /// By rows of lobes that were fitted to a simulation.
    Lobes,
}

/// Layers that the shader of a model reads from the material buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reach {
    /// None: the numbers of the material are enough.
    None,
    /// The first.
    First,
    /// The first, and the diffuse base.
    FirstAndBase,
    /// All.
    All,
}

/// Features of materials that the shader of a model shows. The model leaves out features that are in no list.
#[derive(Debug, Clone, Copy)]
pub struct Shows {
    /// In both forms, by groups.
    pub always: &'static [&'static [Feature]],
    /// In the form `baked` alone.
    pub baked: &'static [Feature],
    /// In the form `full` alone.
    pub full: &'static [Feature],
}

/// A table that the `baked` shader of a model reads for an interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TableRead {
    /// Kind of table.
    pub kind: TableKind,
    /// Interfaces for which it is read.
    pub when: ReadWhen,
}

/// Interfaces for which a table is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReadWhen {
    /// All interfaces that the model reaches.
    Always,
    /// Interfaces with a tabulated reflectance.
    Tabled,
    /// Interfaces with a tabulated reflectance, and without a film that varies.
    Steady,
    /// Interfaces with a tabulated reflectance, and with a film that varies.
    Varying,
    /// The first interface, if its film varies.
    FirstVarying,
    /// Interfaces with a film.
    Filmed,
    /// Interfaces whose film lies over an F0 of the place, first or not.
    OverF0,
    /// Such interfaces below the first, if the film varies.
    VaryingOverF0,
    /// Conductors without a film.
    BareConductor,
    /// Coats with a tabulated reflectance that are denser than the medium above, over another interface: part of the light from below is totally
    /// reflected there.
    DenserCoat,
}
