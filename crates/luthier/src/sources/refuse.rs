//! Adds diagnostics to the files that they are about.

use luthier_material::{Diagnostic, Material};
use rayon::prelude::*;

use super::Source;
use crate::Shading;
use crate::refusals::{of_pictures, of_set, too_many};

/// Adds `doubts`, and makes files unusable that cannot be baked. Files are checked one by one, then, if all are usable, as a set.
///
/// ```
/// use luthier::{Source, refusals};
/// # let chalk = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
///
/// let mut sources = ["chalk.toml", "copy.toml"].map(|path| Source::of_text(path.as_ref(), chalk.to_owned()));
/// luthier::refuse(&mut sources, |material| refusals::of_domain(material, None));
/// assert!(sources[1].material().is_none(), "two materials of one name");
/// ```
pub fn refuse(sources: &mut [Source], doubts: impl Fn(&Material) -> Vec<Diagnostic> + Sync) {
    add(sources, |material| [doubts(material), of_pictures(material)].concat());
    let Some(materials) = usable(sources) else { return };
    for (number, diagnostic) in of_set(&materials) {
        sources[number].add(vec![diagnostic]);
    }
}

/// Adds diagnostics of each usable file, in parallel.
pub(super) fn add(sources: &mut [Source], doubts: impl Fn(&Material) -> Vec<Diagnostic> + Sync) {
    sources.par_iter_mut().for_each(|source| {
        if let Some(material) = source.material() {
            let found = doubts(material);
            source.add(found);
        }
    });
}

/// Makes the first file unusable where a package cannot hold all of them.
pub(super) fn refuse_too_many(sources: &mut [Source], shading: &Shading) {
    let Some(materials) = usable(sources) else { return };
    if let Some(diagnostic) = too_many(&shading.shaded(materials)) {
        sources[0].add(vec![diagnostic]);
    }
}

/// The materials, if each file has one.
fn usable(sources: &[Source]) -> Option<Vec<Material>> {
    sources.iter().map(|source| source.material().cloned()).collect()
}
