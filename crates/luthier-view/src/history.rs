//! History of edits, for undo and redo.

use luthier_material::Material;

/// An edit of a file: the material before it, or after it; `None` is the one in the file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Edit {
    pub(crate) label: String,
    pub(crate) material: Option<Material>,
}

/// Steps that can be taken back, and those that were.
#[derive(Debug, Default)]
pub(crate) struct History {
    past: Vec<Edit>,
    future: Vec<Edit>,
    /// True while edits belong to the last step, because its gesture is not over.
    is_open: bool,
}

/// Steps that are kept.
const STEPS_MAX: usize = 500;

impl History {
    /// Remembers what an edit replaces. Edits of one gesture of one file are one step.
    pub(crate) fn note(&mut self, before: Edit) {
        self.future.clear();
        if self.is_open && self.past.last().is_some_and(|last| last.label == before.label) {
            return;
        }
        self.past.push(before);
        if self.past.len() > STEPS_MAX {
            self.past.remove(0);
        }
        self.is_open = true;
    }

    /// Ends a gesture: the next edit is a step of its own.
    pub(crate) fn close(&mut self) {
        self.is_open = false;
    }

    /// Takes back the last step and returns the edit to show. `current` gives the present material of a file.
    pub(crate) fn undo(&mut self, current: impl Fn(&str) -> Option<Material>) -> Option<Edit> {
        self.close();
        let edit = self.past.pop()?;
        self.future.push(Edit { label: edit.label.clone(), material: current(&edit.label) });
        Some(edit)
    }

    /// The step that was taken back last.
    pub(crate) fn redo(&mut self, current: impl Fn(&str) -> Option<Material>) -> Option<Edit> {
        self.close();
        let edit = self.future.pop()?;
        self.past.push(Edit { label: edit.label.clone(), material: current(&edit.label) });
        Some(edit)
    }

    /// Forgets the steps of a file that was saved, because they belong to its old text.
    pub(crate) fn forget(&mut self, label: &str) {
        self.past.retain(|edit| edit.label != label);
        self.future.retain(|edit| edit.label != label);
    }

    pub(crate) fn can_undo(&self) -> bool {
        !self.past.is_empty()
    }

    pub(crate) fn can_redo(&self) -> bool {
        !self.future.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;
    use std::collections::BTreeMap;

    use super::*;
    use crate::Handle;

    fn material() -> Material {
        let text = "schema = 1\nname = \"m\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.1\n";
        let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
        luthier_material::parse("m.toml", text, &no_files).unwrap().material
    }

    /// Edits by label, as the window keeps them.
    #[derive(Default)]
    struct Edits(RefCell<BTreeMap<String, Material>>);

    impl Edits {
        fn current(&self, label: &str) -> Option<Material> {
            self.0.borrow().get(label).cloned()
        }

        fn drag(&self, history: &mut History, label: &str, alpha: f64) {
            history.note(Edit { label: label.to_owned(), material: self.current(label) });
            let mut edited = self.current(label).unwrap_or_else(material);
            Handle::Alpha(0).set(&mut edited, alpha);
            self.0.borrow_mut().insert(label.to_owned(), edited);
        }

        fn take(&self, edit: Option<Edit>) -> bool {
            let Some(Edit { label, material }) = edit else { return false };
            match material {
                Some(material) => drop(self.0.borrow_mut().insert(label, material)),
                None => drop(self.0.borrow_mut().remove(&label)),
            }
            true
        }

        fn alpha(&self, label: &str) -> Option<f64> {
            self.current(label).and_then(|material| Handle::Alpha(0).get(&material))
        }
    }

    #[test]
    fn a_drag_is_one_step() {
        let (edits, mut history) = (Edits::default(), History::default());
        (0..10).for_each(|i| edits.drag(&mut history, "a", f64::from(20 + i) / 100.0));
        history.close();
        edits.drag(&mut history, "a", 0.9);
        history.close();
        assert!(edits.take(history.undo(|label| edits.current(label))));
        assert_eq!(edits.alpha("a"), Some(0.29));
        assert!(edits.take(history.undo(|label| edits.current(label))));
        assert_eq!(edits.alpha("a"), None, "as in its file");
        assert!(!edits.take(history.undo(|label| edits.current(label))) && !history.can_undo());
        assert!(edits.take(history.redo(|label| edits.current(label))));
        assert!(edits.take(history.redo(|label| edits.current(label))));
        assert_eq!(edits.alpha("a"), Some(0.9));
        assert!(!history.can_redo() && history.can_undo());
    }

    #[test]
    fn an_edit_ends_what_can_be_done_again() {
        let (edits, mut history) = (Edits::default(), History::default());
        edits.drag(&mut history, "a", 0.2);
        edits.take(history.undo(|label| edits.current(label)));
        assert!(history.can_redo());
        edits.drag(&mut history, "a", 0.3);
        assert!(!history.can_redo());
        edits.take(history.undo(|label| edits.current(label)));
        assert_eq!(edits.alpha("a"), None);
    }

    #[test]
    fn files_have_one_history_and_a_saved_one_leaves_it() {
        let (edits, mut history) = (Edits::default(), History::default());
        edits.drag(&mut history, "a", 0.2);
        // A gesture does not reach over two files.
        edits.drag(&mut history, "b", 0.3);
        edits.drag(&mut history, "b", 0.4);
        history.close();
        history.forget("a");
        assert!(edits.take(history.undo(|label| edits.current(label))));
        assert_eq!((edits.alpha("a"), edits.alpha("b")), (Some(0.2), None));
        assert!(!history.can_undo());
    }

    #[test]
    fn old_steps_are_dropped() {
        let (edits, mut history) = (Edits::default(), History::default());
        for i in 0..2 * STEPS_MAX {
            edits.drag(&mut history, "a", i as f64 / 1e4);
            history.close();
        }
        let steps = std::iter::from_fn(|| history.undo(|label| edits.current(label))).count();
        assert_eq!(steps, STEPS_MAX);
    }
}
