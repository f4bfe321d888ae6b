//! The thread that bakes.

use std::sync::Arc;
use std::thread;

use eframe::egui;
use luthier_gpu::Package;
use luthier_manifest::Form;
use luthier_material::Material;

use crate::error::ViewError;
use crate::host::Host;
use crate::work::latest::Latest;

/// The way of making a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Way {
    /// By the shader of a model in this form.
    Shader(Form),
    /// By the simulation of the layers.
    Simulation,
}

/// A material that is to be shown.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Subject {
    pub(crate) material: Material,
    pub(crate) way: Way,
    /// Revision of the files that the material names.
    pub(crate) revision: u64,
}

/// Order of the material that is to be shown, and of the one beside it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct BakeOrder {
    pub(crate) version: u64,
    pub(crate) subjects: [Option<Subject>; 2],
}

/// A material that is ready to be shown.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    pub(crate) package: Arc<Package>,
    pub(crate) way: Way,
}

/// Result of an order.
#[derive(Debug)]
pub(crate) struct Baked {
    pub(crate) version: u64,
    pub(crate) sides: [Option<Result<Ready, String>>; 2],
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
        let builder = thread::Builder::new().name("luthier baker".to_owned());
        builder.spawn(move || work(&*host, &todo, &done, &context)).map_err(ViewError::Thread)?;
        Ok(Self { orders, results })
    }
}

/// Bakes the latest order, until the orders end.
fn work(host: &dyn Host, orders: &Latest<BakeOrder>, results: &Latest<Baked>, context: &egui::Context) {
    // A side that did not change keeps its package, and with it pipelines and samples.
    let mut last: [Option<(Subject, Ready)>; 2] = [None, None];
    while let Some(BakeOrder { version, subjects }) = orders.wait() {
        let [first, second] = subjects;
        let first = first.map(|subject| bake(host, &mut last[0], subject));
        let sides = [first, second.map(|subject| bake(host, &mut last[1], subject))];
        results.put(Baked { version, sides });
        context.request_repaint();
    }
}

fn bake(host: &dyn Host, last: &mut Option<(Subject, Ready)>, subject: Subject) -> Result<Ready, String> {
    if let Some((of, ready)) = last
        && *of == subject
    {
        return Ok(ready.clone());
    }
    let package = match subject.way {
        Way::Shader(form) => host.bake(&subject.material, form),
        Way::Simulation => host.simulated(&subject.material),
    };
    let ready = Ready { package: Arc::new(package?), way: subject.way };
    *last = Some((subject, ready.clone()));
    Ok(ready)
}

impl Drop for Baker {
    /// Closes the orders. The thread ends after its present bake, and the window does not wait for it.
    fn drop(&mut self) {
        self.orders.close();
    }
}
