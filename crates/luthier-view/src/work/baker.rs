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

/// How a picture comes about.
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

/// Bakes what is ordered until the orders end.
fn work(host: &dyn Host, orders: &Latest<BakeOrder>, results: &Latest<Baked>, context: &egui::Context) {
    // A side that did not change keeps its package, and with it pipelines and samples.
    let mut last: [Option<(Subject, Ready)>; 2] = [None, None];
    while let Some(BakeOrder { version, subjects }) = orders.wait() {
        let [first, second] = subjects;
        let [first_last, second_last] = &mut last;
        let sides = [bake(host, first_last, first), bake(host, second_last, second)];
        results.put(Baked { version, sides });
        context.request_repaint();
    }
}

fn bake(
    host: &dyn Host,
    last: &mut Option<(Subject, Ready)>,
    subject: Option<Subject>,
) -> Option<Result<Ready, String>> {
    let subject = subject?;
    if let Some((of, ready)) = last
        && *of == subject
    {
        return Some(Ok(ready.clone()));
    }
    let package = match subject.way {
        Way::Shader(form) => host.bake(&subject.material, form),
        Way::Simulation => host.simulated(&subject.material),
    };
    Some(package.map(|package| {
        let ready = Ready { package: Arc::new(package), way: subject.way };
        *last = Some((subject, ready.clone()));
        ready
    }))
}

impl Drop for Baker {
    /// The thread ends after the bake that it is at; nobody waits for it.
    fn drop(&mut self) {
        self.orders.close();
    }
}
