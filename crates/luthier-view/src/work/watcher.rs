//! The thread that watches files for changes.

use std::sync::Arc;
use std::thread;
use std::time::Duration;

use eframe::egui;

use crate::error::ViewError;
use crate::host::{Host, MaterialFile};
use crate::work::latest::Latest;

/// Time between two checks. Editors save less often, and a user does not notice such a delay.
const INTERVAL: Duration = Duration::from_millis(150);

/// The thread, and the slot from it.
#[derive(Debug)]
pub(crate) struct Watcher {
    pub(crate) files: Arc<Latest<Vec<MaterialFile>>>,
}

impl Watcher {
    pub(crate) fn start(host: Arc<dyn Host>, context: egui::Context) -> Result<Self, ViewError> {
        let files = Arc::new(Latest::default());
        let slot = Arc::clone(&files);
        let builder = thread::Builder::new().name("luthier watcher".to_owned());
        builder.spawn(move || watch(&*host, &slot, &context)).map_err(ViewError::Thread)?;
        Ok(Self { files })
    }
}

/// Puts changed files into the slot until it is closed.
fn watch(host: &dyn Host, slot: &Latest<Vec<MaterialFile>>, context: &egui::Context) {
    while !slot.is_closed() {
        if let Some(changed) = host.changed() {
            slot.put(changed);
            context.request_repaint();
        }
        thread::sleep(INTERVAL);
    }
}

impl Drop for Watcher {
    fn drop(&mut self) {
        self.files.close();
    }
}
