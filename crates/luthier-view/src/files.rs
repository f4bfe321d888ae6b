//! The material files of the window.

use luthier_material::Material;

use crate::host::MaterialFile;

/// A file, and the last material that it held.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
    pub(crate) label: String,
    /// Kept while the file is broken.
    pub(crate) material: Option<Material>,
    /// Problem of the file now.
    pub(crate) problem: Option<String>,
    /// Revision of the files that the material names.
    pub(crate) revision: u64,
}

impl Entry {
    /// Name in lists.
    pub(crate) fn name(&self) -> &str {
        self.material.as_ref().map_or(&self.label, |material| &material.name)
    }
}

/// The files, and which one is shown.
#[derive(Debug, Default)]
pub(crate) struct Files {
    pub(crate) entries: Vec<Entry>,
    pub(crate) selected: usize,
}

impl Files {
    /// Takes the files on disk. Broken files keep their last material, and the selection stays with its file. Returns the labels of files whose
    /// material changed.
    pub(crate) fn update(&mut self, files: Vec<MaterialFile>) -> Vec<String> {
        let before = self.selected().map(|entry| entry.label.clone());
        let entries = files.into_iter().map(|file| {
            let old = self.named(&file.label);
            let (material, problem) = match file.material {
                Ok(material) => (Some(material), None),
                Err(problem) => (old.and_then(|entry| entry.material.clone()), Some(problem)),
            };
            Entry { label: file.label, material, problem, revision: file.revision }
        });
        let entries: Vec<Entry> = entries.collect();
        let differing =
            entries.iter().filter(|new| self.named(&new.label).map(|old| &old.material) != Some(&new.material));
        let changed = differing.map(|entry| entry.label.clone()).collect();
        self.entries = entries;
        self.selected =
            before.and_then(|label| self.entries.iter().position(|entry| entry.label == label)).unwrap_or(0);
        changed
    }

    fn named(&self, label: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.label == label)
    }

    pub(crate) fn selected(&self) -> Option<&Entry> {
        self.entries.get(self.selected)
    }

    /// Selects the file of a label, if there is one.
    pub(crate) fn select(&mut self, label: &str) {
        if let Some(place) = self.entries.iter().position(|entry| entry.label == label) {
            self.selected = place;
        }
    }

    /// Selects another file, around the ends.
    pub(crate) fn step(&mut self, by: isize) {
        let count = self.entries.len().max(1) as isize;
        self.selected = (self.selected as isize + by).rem_euclid(count) as usize;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(label: &str, albedo: Option<f64>) -> MaterialFile {
        let label = label.to_owned();
        let Some(albedo) = albedo else {
            return MaterialFile { label, material: Err("a mistake".to_owned()), revision: 0 };
        };
        let text = format!("schema = 1\nname = \"m\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = {albedo}\n");
        let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
        let material = Ok(luthier_material::parse(&label, &text, &no_files).unwrap().material);
        MaterialFile { label, material, revision: 0 }
    }

    #[test]
    fn a_broken_file_keeps_its_material() {
        let mut files = Files::default();
        assert_eq!(files.update(vec![file("a", Some(0.5)), file("b", None)]), ["a", "b"]);
        assert!(files.update(vec![file("a", None), file("b", None)]).is_empty());
        assert!(files.entries[0].material.is_some() && files.entries[0].problem.is_some());
        assert!(files.entries[1].material.is_none());
        assert_eq!(files.update(vec![file("a", Some(0.25)), file("b", None)]), ["a"], "it changed when it was mended");
        assert_eq!(files.entries[0].problem, None);
    }

    #[test]
    fn the_selection_stays_with_its_file() {
        let mut files = Files::default();
        files.update(vec![file("a", Some(0.5)), file("b", Some(0.25))]);
        files.step(-1);
        assert_eq!(files.update(vec![file("0", Some(0.1)), file("a", Some(0.1)), file("b", Some(0.25))]), ["0", "a"]);
        assert_eq!(files.selected().unwrap().label, "b");
        files.update(vec![file("0", Some(0.1))]);
        assert_eq!(files.selected().unwrap().label, "0", "its file is gone");
        assert!(files.update(Vec::new()).is_empty() && files.selected().is_none());
        files.step(1);
    }
}
