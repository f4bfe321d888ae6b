use std::collections::BTreeSet;

use luthier_lut::{LayerKind, LayerRecord};

use crate::{Form, MaterialSet};

/// What the materials of a set make use of: the words that conditions in the modules may name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Features(BTreeSet<&'static str>);

impl Features {
    /// Every word there is, for the check that modules name no other.
    #[cfg(test)]
    pub(crate) const ALL: [&'static str; 20] = [
        "absorption",
        "bare",
        "beckmann",
        "below",
        "conductor",
        "diffuse",
        "distribution",
        "fgd",
        "film",
        "fresnel",
        "full",
        "ggx",
        "interface",
        "mixed",
        "oren_nayar",
        "phase",
        "split_root",
        "theta_axis",
        "thickness",
        "bilinear",
    ];

    pub(crate) fn of(set: &MaterialSet<'_>, form: Form) -> Self {
        let mut names = BTreeSet::new();
        let is_diffuse = |layer: &LayerRecord| layer.kind == LayerKind::Diffuse;
        for layer in set.layers() {
            if is_diffuse(layer) {
                names.insert("diffuse");
                if layer.sigma != 0.0 {
                    names.insert("oren_nayar");
                }
                continue;
            }
            names.insert("interface");
            names.insert(if layer.distribution == "ggx" { "ggx" } else { "beckmann" });
            names.insert(if layer.film_ior_n[0] > 0.0 { "film" } else { "bare" });
            if layer.kind == LayerKind::Conductor {
                names.insert("conductor");
            }
        }
        for pair in set.materials.iter().flat_map(|m| m.layers.windows(2)) {
            if pair[0].kind == LayerKind::Dielectric {
                names.insert("below");
                if pair[0].optical_depth.iter().any(|&depth| depth != 0.0) {
                    names.insert("absorption");
                }
            }
        }
        let depth = set.materials.iter().map(|m| m.layers.len()).max().unwrap_or(0);
        for i in 0..depth {
            let mut here = set.materials.iter().filter_map(|m| m.layers.get(i)).map(is_diffuse);
            let first = here.next();
            if here.any(|diffuse| Some(diffuse) != first) {
                names.insert("mixed");
            }
        }
        if form == Form::Full {
            names.insert("full");
        }
        for table in set.tables_read(form) {
            names.insert(table.kind.name());
            if !table.format.is_filterable() {
                names.insert("bilinear");
            }
        }
        Self(names)
    }

    pub(crate) fn has(&self, name: &str) -> bool {
        self.0.contains(name)
    }

    /// The same, and a word that holds for one module only.
    pub(crate) fn with(&self, name: &'static str, holds: bool) -> Self {
        let mut names = self.0.clone();
        if holds {
            names.insert(name);
        }
        Self(names)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::module::words;

    #[test]
    fn modules_name_no_unknown_feature() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/wgsl");
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let module = std::fs::read_to_string(&path).unwrap();
            for word in words(&module) {
                assert!(Features::ALL.contains(&word), "`{word}` in {}", path.display());
            }
        }
    }
}
