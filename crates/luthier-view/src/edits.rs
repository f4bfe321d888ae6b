//! Edits of the material: kept, taken back, made again, copied.

use luthier_material::{Material, rewritten};

use crate::app::App;
use crate::history::Edit;

impl App {
    /// Keeps an edited material; one that is as in its file is no edit.
    pub(crate) fn edit(&mut self, material: Material) {
        let Some(entry) = self.files.selected() else { return };
        let label = entry.label.clone();
        let material = (entry.material.as_ref() != Some(&material)).then_some(material);
        self.history.note(Edit { label: label.clone(), material: self.edits.get(&label).cloned() });
        self.take(Edit { label, material });
    }

    /// Shows the material of an edit.
    fn take(&mut self, Edit { label, material }: Edit) {
        self.files.select(&label);
        match material {
            Some(material) => drop(self.edits.insert(label, material)),
            None => drop(self.edits.remove(&label)),
        }
    }

    pub(crate) fn is_edited(&self) -> bool {
        self.files.selected().is_some_and(|entry| self.edits.contains_key(&entry.label))
    }

    pub(crate) fn reset_edits(&mut self) {
        if let Some(material) = self.files.selected().filter(|_| self.is_edited()).and_then(|e| e.material.clone()) {
            self.history.close();
            self.edit(material);
            self.history.close();
        }
    }

    pub(crate) fn undo(&mut self) {
        if let Some(edit) = self.history.undo(|label| self.edits.get(label).cloned()) {
            self.take(edit);
        }
    }

    pub(crate) fn redo(&mut self) {
        if let Some(edit) = self.history.redo(|label| self.edits.get(label).cloned()) {
            self.take(edit);
        }
    }

    /// Puts the material as it is shown on the clipboard, as the text of a file.
    pub(crate) fn copy(&mut self) {
        let copied = self.text().and_then(|text| self.clipboard.copy(&text));
        self.message = Some(match copied {
            Ok(()) => "copied as TOML".to_owned(),
            Err(problem) => problem,
        });
    }

    /// The text of a file that holds the material as it is shown.
    fn text(&self) -> Result<String, String> {
        let entry = self.files.selected().ok_or("no material")?;
        let original = entry.material.as_ref().ok_or("no material")?;
        let Some(edited) = self.edits.get(&entry.label) else { return Ok(original.text.clone()) };
        let text = rewritten(original, edited).map_err(|refusal| {
            format!("no text for this edit: {}:{}: {}", refusal.label, refusal.line, refusal.message)
        })?;
        let read = self.host.parsed(&entry.label, &text)?;
        let is_same = (&read.stack, &read.layers, &read.effects, &read.bake, &read.budget)
            == (&edited.stack, &edited.layers, &edited.effects, &edited.bake, &edited.budget);
        if is_same { Ok(text) } else { Err("no text for this edit: a file has no key for it".to_owned()) }
    }
}
