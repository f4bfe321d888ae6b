//! The thread that bakes.

use std::sync::Arc;
use std::thread;

use eframe::egui;
use luthier_gpu::Package;
use luthier_manifest::Form;
use luthier_material::Material;

use crate::error::ViewError;
use crate::host::Host;
use crate::latest::Latest;

/// Order of a material that is to be shown.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct BakeOrder {
    pub(crate) version: u64,
    pub(crate) material: Material,
    pub(crate) form: Form,
    /// Revision of the files that the material names.
    pub(crate) revision: u64,
}

/// Result of an order.
#[derive(Debug)]
pub(crate) struct Baked {
    pub(crate) version: u64,
    pub(crate) package: Result<Arc<Package>, String>,
    pub(crate) form: Form,
}

/// The thread, and the slots to and from it.
#[derive(Debug)]
pub(crate) struct Baker {
    pub(crate) orders: Arc<Latest<BakeOrder>>,
    pub(crate) results: Arc<Latest<Baked>>,
}

impl Baker {
    pub(crate) fn start(host: Arc<dyn Host>, context: egui::Context) -> Result<Self, ViewError> {
        let (orders, results) = (Arc::new(Latest::<BakeOrder>::default()), Arc::new(Latest::default()));
        let (todo, done) = (Arc::clone(&orders), Arc::clone(&results));
        let work = move || {
            while let Some(BakeOrder { version, material, form, .. }) = todo.wait() {
                let package = host.bake(&material, form).map(Arc::new);
                done.put(Baked { version, package, form });
                context.request_repaint();
            }
        };
        thread::Builder::new().name("luthier baker".to_owned()).spawn(work).map_err(ViewError::Thread)?;
        Ok(Self { orders, results })
    }
}

impl Drop for Baker {
    /// The thread ends after the bake that it is at; nobody waits for it.
    fn drop(&mut self) {
        self.orders.close();
    }
}
