//! The clipboard of the desktop. The window holds what it copied: desktops ask it for the text when somebody pastes.

use arboard::Clipboard as System;

/// The clipboard, opened at its first use.
#[derive(Default)]
pub(crate) struct Clipboard(Option<System>);

impl Clipboard {
    /// Puts a text on the clipboard.
    ///
    /// # Errors
    /// A message for people.
    pub(crate) fn copy(&mut self, text: &str) -> Result<(), String> {
        let system = match &mut self.0 {
            Some(system) => Ok(system),
            None => System::new().map(|system| self.0.insert(system)),
        };
        system.and_then(|system| system.set_text(text)).map_err(|error| format!("cannot copy: {error}"))
    }
}

impl std::fmt::Debug for Clipboard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Clipboard").field("is_open", &self.0.is_some()).finish()
    }
}
