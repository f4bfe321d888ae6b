//! The caller's choices for all materials of a bake.

use luthier_bake::Store;
use luthier_lut::TableKind;
use luthier_manifest::{Form, Reflectance, ShadingModel};
use luthier_material::{Diagnostic, Material, Severity};

use crate::refusals::{of_kept_energy, of_model};

/// Choices of models, reflectances, tables and forms that come before those of material files. The default leaves all to the files.
///
/// ```
/// use luthier::{Shading, ShadingModel};
///
/// let text = "schema = 1\nname = \"gold\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.2\n";
/// let shading = Shading { model: Some(ShadingModel::Elek), ..Shading::default() };
/// let shaded = shading.shaded(vec![luthier::parse("gold.toml", text)?]);
/// assert_eq!(shaded[0].model(), ShadingModel::Elek);
/// # Ok::<(), luthier::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Shading {
    /// The model of all materials.
    pub model: Option<ShadingModel>,
    /// True where nothing may be simulated. Materials whose files name no model take one in closed form; a material whose file names a fitted model
    /// is refused.
    pub no_fit: bool,
    /// The source of an interface's reflectance, such as a table or a curve; `None` leaves it to the files.
    pub reflectance: Option<Reflectance>,
    /// Kinds of tables to bake for every material, in addition to those that its shader reads.
    pub tables: Vec<TableKind>,
    /// Forms of the shaders; empty for every form that all models of the bake have. The form `full` computes all terms, so materials whose files name
    /// no model take one without a fit. With `full` alone, a package has no tables.
    pub forms: Vec<Form>,
}

impl Shading {
    /// The model that these choices give a material; `None` where the material chooses.
    fn model_of(&self, material: &Material) -> Option<ShadingModel> {
        let is_closed = self.no_fit || self.forms.contains(&Form::Full);
        self.model.or_else(|| is_closed.then(|| material.model_without_fit()))
    }

    /// The model by which a material is shaded.
    ///
    /// ```
    /// use luthier::{Shading, ShadingModel};
    /// # let text = "schema = 1\nname = \"coat\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.3\n";
    ///
    /// let coat = luthier::parse("coat.toml", text)?;
    /// assert_eq!(Shading::default().model(&coat), ShadingModel::Lobes);
    /// assert_eq!(Shading { no_fit: true, ..Shading::default() }.model(&coat), coat.model_without_fit());
    /// # Ok::<(), luthier::Error>(())
    /// ```
    pub fn model(&self, material: &Material) -> ShadingModel {
        self.model_of(material).unwrap_or_else(|| material.model())
    }

    /// The materials with their models, reflectances and tables.
    pub fn shaded(&self, mut materials: Vec<Material>) -> Vec<Material> {
        for material in &mut materials {
            material.bake.model = self.model_of(material).or(material.bake.model);
            material.bake.reflectance = self.reflectance.or(material.bake.reflectance);
            let new = self.tables.iter().filter(|kind| !material.bake.tables.contains(kind));
            let new: Vec<TableKind> = new.copied().collect();
            material.bake.tables.extend(new);
        }
        materials
    }

    /// Warnings about features that the model leaves out, and refusals.
    ///
    /// ```
    /// use luthier::{Shading, ShadingModel};
    /// # let text = "schema = 1\nname = \"coat\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.3\n";
    ///
    /// let coat = luthier::parse("coat.toml", text)?;
    /// let fitted = Shading { model: Some(ShadingModel::Lobes), no_fit: true, ..Shading::default() };
    /// assert!(fitted.doubts(&coat)[0].is_error(), "a fitted model without a fit");
    /// # Ok::<(), luthier::Error>(())
    /// ```
    pub fn doubts(&self, material: &Material) -> Vec<Diagnostic> {
        let model = self.model_of(material);
        let chosen = self.reflectance.map(|_| {
            let mut chosen = material.clone();
            chosen.bake.reflectance = self.reflectance;
            chosen
        });
        let mut doubts = of_model(chosen.as_ref().unwrap_or(material), model);
        if self.no_fit && model.is_some_and(ShadingModel::is_fitted) {
            let message = "the model `lobes` is fitted to a simulation, and `--no-fit` makes none";
            let hint = "leave out `--no-fit`, or write `--model elek` in its place".to_owned();
            doubts.push(material.diagnostic(Severity::Error, "bake.model", message, Some(hint)));
        }
        doubts
    }

    /// A warning if the model gains or loses energy.
    pub(crate) fn doubts_of_energy(&self, material: &Material, store: &dyn Store) -> Option<Diagnostic> {
        of_kept_energy(material, self.model_of(material), store)
    }
}
