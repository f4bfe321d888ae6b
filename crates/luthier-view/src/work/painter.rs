//! The thread that renders and simulates.

use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::Instant;

use eframe::egui;
use luthier_gpu::{Backdrop, Environment, Gpu, GpuError, LiveValue, Package, RenderSettings, Scene, Shape};
use luthier_lut::Image;
use luthier_manifest::Form;

use crate::error::ViewError;
use crate::host::{Differences, Host};
use crate::work::baker::{Ready, Way};
use crate::work::crop::{Crop, SIDE_MAX, shown};
use crate::work::gathering::{Gathering, Progress};
use crate::work::latest::Latest;
use crate::work::stages::{Goal, MOVING_SECONDS, Stage, affordable};
use crate::work::view::View;

/// Longest side of a rendering that is compared. Its time and memory grow with every pixel, because paths are traced and summed for each.
const COMPARED_SIDE_MAX: u32 = 1024;

/// Seconds per evaluation and per path until they are measured: those of a software adapter.
const SECONDS_AT_FIRST: [f64; 2] = [5e-7, 5e-6];

/// A picture to make, and one to make beside it.
#[derive(Debug, Clone)]
pub(crate) struct PaintOrder {
    pub(crate) version: u64,
    pub(crate) side: Ready,
    pub(crate) other: Option<Ready>,
    /// Paths of each pixel of a simulated picture.
    pub(crate) paths: u32,
    pub(crate) environment: Arc<Environment>,
    /// Values of live numbers.
    pub(crate) live: Arc<[LiveValue]>,
    pub(crate) view: View,
}

/// Progress of an order.
#[derive(Debug)]
pub(crate) struct Painted {
    /// Version of the order.
    pub(crate) version: u64,
    /// True where the order is finished.
    pub(crate) finished: bool,
    /// Pictures so far, of the material and beside it, or the reason why there is none.
    pub(crate) pictures: [Option<Result<Picture, String>>; 2],
    /// Progress of a simulated picture.
    pub(crate) progress: Option<Progress>,
    /// Distance of the two pictures, where both have all their pixels.
    pub(crate) differences: Option<Differences>,
    /// Time that the last picture took.
    pub(crate) seconds: f64,
}

/// A picture: linear, and as a display shows it.
#[derive(Debug, Clone)]
pub(crate) struct Picture {
    pub(crate) image: Arc<Image>,
    pub(crate) rgb8: Arc<Vec<u8>>,
}

/// The thread, and the slots to and from it.
#[derive(Debug)]
pub(crate) struct Painter {
    pub(crate) orders: Arc<Latest<PaintOrder>>,
    pub(crate) painted: Arc<Latest<Painted>>,
    thread: Option<JoinHandle<()>>,
}

impl Painter {
    pub(crate) fn start(
        host: Arc<dyn Host>,
        gpu: Gpu,
        settings: RenderSettings,
        context: egui::Context,
    ) -> Result<Self, ViewError> {
        let (orders, painted) = (Arc::new(Latest::default()), Arc::new(Latest::default()));
        let mut worker = Worker {
            host,
            gpu,
            settings,
            orders: Arc::clone(&orders),
            painted: Arc::clone(&painted),
            context,
            scenes: [None, None],
            gathering: Gathering::default(),
            seconds: SECONDS_AT_FIRST,
        };
        let builder = thread::Builder::new().name("luthier painter".to_owned());
        let thread = builder.spawn(move || worker.work()).map_err(ViewError::Thread)?;
        Ok(Self { orders, painted, thread: Some(thread) })
    }
}

impl Drop for Painter {
    /// Waits for the end of the present pass: a process should not end while a driver works.
    fn drop(&mut self) {
        self.orders.close();
        if let Some(thread) = self.thread.take() {
            // A panic over there has been reported over there.
            let _ = thread.join();
        }
    }
}

struct Worker {
    host: Arc<dyn Host>,
    gpu: Gpu,
    settings: RenderSettings,
    orders: Arc<Latest<PaintOrder>>,
    painted: Arc<Latest<Painted>>,
    context: egui::Context,
    /// Scenes of the two sides.
    scenes: [Option<(Arc<Package>, Scene)>; 2],
    gathering: Gathering,
    /// Per evaluation, and per path, as measured last.
    seconds: [f64; 2],
}

/// Pictures of an order so far.
#[derive(Default)]
struct Made {
    pictures: [Option<Result<Picture, String>>; 2],
    progress: Option<Progress>,
    differences: Option<Differences>,
    seconds: f64,
}

impl Worker {
    fn work(&mut self) {
        while let Some(order) = self.orders.wait() {
            let mut made = Made::default();
            if let Err(error) = self.paint(&order, &mut made) {
                made.pictures[0] = Some(Err(error.to_string()));
                self.show(&order, &made, true);
            }
        }
    }

    /// Renders the stages of the material, each followed by the same stage of the other side. Then gathers paths.
    fn paint(&mut self, order: &PaintOrder, made: &mut Made) -> Result<(), GpuError> {
        self.prepare(0, &order.side, &order.live)?;
        let view = &order.view;
        let crop = Crop::of(view.size, if order.other.is_some() { COMPARED_SIDE_MAX } else { SIDE_MAX });
        let goal = Goal {
            side: crop.side,
            samples: view.samples,
            environment_samples: self.directions(order)?,
            moving: view.moving,
        };
        let simulates = order.other.as_ref().is_some_and(|other| other.way == Way::Simulation);
        if simulates && view.shape == Shape::Mesh {
            let reason = "the simulation knows no triangles: choose the sphere, the torus or the plane";
            made.pictures[1] = Some(Err(reason.to_owned()));
        }
        let stages = goal.stages(self.seconds[0]);
        let count = stages.len();
        for (i, stage) in stages.into_iter().enumerate() {
            if !self.render(order, &crop, &stage, 0, made)? {
                return Ok(());
            }
            let is_last = i + 1 == count;
            if let Some(other) = order.other.as_ref().filter(|_| made.is_comparable()) {
                self.show(order, made, false);
                let is_in_time = match other.way {
                    Way::Simulation if i == 0 => self.draft(order, &crop, made),
                    // Some paths of each pixel before the long last stage.
                    Way::Simulation if !is_last => self.gather(order, &crop, FEW_PATHS, made),
                    Way::Simulation => Ok(true),
                    Way::Shader(_) => {
                        self.prepare(1, other, &order.live).and_then(|()| self.render(order, &crop, &stage, 1, made))
                    }
                };
                if !made.unless_refused(is_in_time) {
                    return Ok(());
                }
            }
            let gathers = simulates && made.is_comparable();
            if is_last && !gathers && !view.moving {
                self.compare(order, made);
            }
            self.show(order, made, is_last && !gathers && !view.moving);
        }
        if simulates && made.is_comparable() && !view.moving {
            let is_in_time = self.gather(order, &crop, order.paths, made);
            if made.unless_refused(is_in_time) {
                self.compare(order, made);
                self.show(order, made, true);
            }
        }
        Ok(())
    }

    /// Renders one stage of a side. Returns whether there was time.
    fn render(
        &mut self,
        order: &PaintOrder,
        crop: &Crop,
        stage: &Stage,
        side: usize,
        made: &mut Made,
    ) -> Result<bool, GpuError> {
        let begin = Instant::now();
        let settings = self.settings(order, crop, stage);
        let Some((_, scene)) = &self.scenes[side] else { return Ok(false) };
        let Some(image) = scene.render_unless(&[0], &settings, &|| self.orders.is_outdated())? else {
            return Ok(false);
        };
        made.pictures[side] = Some(Ok(picture(order, crop, &image)));
        made.seconds = begin.elapsed().as_secs_f64();
        let evaluations = settings.size * settings.size * stage.samples * stage.samples;
        self.seconds[0] = made.seconds / (f64::from(evaluations) * f64::from(1 + stage.environment_samples));
        Ok(true)
    }

    /// Simulates one path of each pixel of a small picture, unless the picture at hand is of this order. Returns whether there was time.
    fn draft(&mut self, order: &PaintOrder, crop: &Crop, made: &mut Made) -> Result<bool, GpuError> {
        let Some(other) = &order.other else { return Ok(true) };
        self.prepare(1, other, &order.live)?;
        if self.gathering.serves(&other.package, &order.view, crop.side) {
            self.simulated(order, crop, made);
            return Ok(true);
        }
        let side = f64::from(crop.side);
        let scale = affordable(side, MOVING_SECONDS / self.seconds[1]) / side;
        let stage = Stage { scale, samples: order.view.samples, environment_samples: 1 };
        self.add_paths(order, crop, &stage, 1, made)?;
        Ok(!self.orders.is_outdated())
    }

    /// Gathers so many paths of each pixel, and shows and compares them on the way. Returns whether there was time.
    fn gather(&mut self, order: &PaintOrder, crop: &Crop, goal: u32, made: &mut Made) -> Result<bool, GpuError> {
        let stage = Stage { scale: 1.0, samples: order.view.samples, environment_samples: 1 };
        let mut compared = 0;
        while self.add_paths(order, crop, &stage, goal, made)? {
            let paths = made.progress.map_or(0, |progress| progress.paths);
            if paths >= 2 * compared {
                self.compare(order, made);
                compared = paths;
            }
            self.show(order, made, false);
        }
        Ok(!self.orders.is_outdated())
    }

    /// Adds paths to the simulated picture of a size, at most `goal`. Returns whether there are more than before.
    fn add_paths(
        &mut self,
        order: &PaintOrder,
        crop: &Crop,
        stage: &Stage,
        goal: u32,
        made: &mut Made,
    ) -> Result<bool, GpuError> {
        let settings = self.settings(order, crop, stage);
        let (Some(other), Some((_, scene))) = (&order.other, &self.scenes[1]) else { return Ok(false) };
        self.gathering.restart(scene, &other.package, &order.view, &settings)?;
        let before = self.gathering.picture(goal).map_or(0, |(_, progress)| progress.paths);
        let begin = Instant::now();
        let more = self.gathering.add(goal, &|| self.orders.is_outdated())?;
        let seconds = begin.elapsed().as_secs_f64();
        self.simulated(order, crop, made);
        let added = made.progress.map_or(0, |progress| progress.paths.saturating_sub(before));
        if added > 0 {
            made.seconds = seconds;
            self.seconds[1] = seconds / (f64::from(settings.size * settings.size) * f64::from(added));
        }
        Ok(more)
    }

    /// Takes the simulated picture at hand.
    fn simulated(&self, order: &PaintOrder, crop: &Crop, made: &mut Made) {
        if let Some((image, progress)) = self.gathering.picture(order.paths) {
            made.pictures[1] = Some(Ok(picture(order, crop, &image)));
            made.progress = Some(progress);
        }
    }

    /// Compares the pictures, if they have the same pixels.
    fn compare(&self, order: &PaintOrder, made: &mut Made) {
        made.differences = match &made.pictures {
            [Some(Ok(a)), Some(Ok(b))] if (a.image.width, a.image.height) == (b.image.width, b.image.height) => {
                self.host.compare(&a.image, &b.image, order.view.look.tone)
            }
            _ => None,
        };
    }

    /// Directions of the environment at rest. Blurred maps need tables and ignore textures of single layers. Compared pictures must differ only by
    /// what is compared, so both sides take directions then.
    fn directions(&self, order: &PaintOrder) -> Result<u32, GpuError> {
        let asked = order.view.environment_samples;
        let Some((_, scene)) = &self.scenes[0] else { return Ok(asked) };
        let reads_maps = scene.form() == Form::Baked && !scene.has_layer_maps(0)? && order.other.is_none();
        Ok(if reads_maps { asked } else { asked.max(SAMPLED_DIRECTIONS) })
    }

    /// Makes the scene of a side: reuses the present one if possible, else gives it other materials, else compiles.
    fn prepare(&mut self, side: usize, ready: &Ready, live: &[LiveValue]) -> Result<(), GpuError> {
        let form = match ready.way {
            Way::Shader(form) => form,
            // The simulation reads the material buffer, which every form binds.
            Way::Simulation => {
                Form::ALL.into_iter().find(|form| ready.package.wgsl(*form).is_ok()).unwrap_or(Form::Baked)
            }
        };
        let mut scene = match self.scenes[side].take() {
            Some((package, scene)) if scene.form() == form => {
                let rebound =
                    if Arc::ptr_eq(&package, &ready.package) { Some(scene) } else { scene.rebound(&ready.package)? };
                rebound.map_or_else(|| self.gpu.scene(&ready.package, form), Ok)?
            }
            _ => self.gpu.scene(&ready.package, form)?,
        };
        scene.set_live(live);
        self.scenes[side] = Some((Arc::clone(&ready.package), scene));
        Ok(())
    }

    fn settings(&self, order: &PaintOrder, crop: &Crop, stage: &Stage) -> RenderSettings {
        let view = &order.view;
        RenderSettings {
            size: ((f64::from(crop.side) * stage.scale).round() as u32).max(1),
            samples: stage.samples,
            shape: view.shape,
            mesh: self.settings.mesh.clone(),
            camera: view.orbit.camera(view.shape, crop.widening()),
            lights: view.look.lights(&self.settings),
            light_angular_radius: self.settings.light_angular_radius,
            environment: Arc::clone(&order.environment),
            environment_samples: stage.environment_samples,
            backdrop: if view.look.background { Backdrop::Environment } else { Backdrop::Plain(view.backdrop) },
            exposure: libm::exp2f(view.look.exposure_stops),
            film_tilt: [0.0; 2],
        }
    }

    fn show(&self, order: &PaintOrder, made: &Made, finished: bool) {
        let Made { pictures, progress, differences, seconds } = made;
        self.painted.put(Painted {
            version: order.version,
            finished,
            pictures: pictures.clone(),
            progress: *progress,
            differences: *differences,
            seconds: *seconds,
        });
        self.context.request_repaint();
    }
}

impl Made {
    /// Keeps a refusal in place of the other picture. Returns true, because a refusal takes no time.
    fn unless_refused(&mut self, is_in_time: Result<bool, GpuError>) -> bool {
        is_in_time.unwrap_or_else(|error| {
            self.pictures[1] = Some(Err(error.to_string()));
            (self.progress, self.differences) = (None, None);
            true
        })
    }

    /// True where the other side has no refusal.
    fn is_comparable(&self) -> bool {
        !matches!(self.pictures[1], Some(Err(_)))
    }
}

/// Paths of each pixel before the last stage of the first picture.
const FEW_PATHS: u32 = 4;

/// Directions in which the environment is asked for at rest, at least, where no blurred maps are read.
const SAMPLED_DIRECTIONS: u32 = 16;

fn picture(order: &PaintOrder, crop: &Crop, image: &Image) -> Picture {
    let image = crop.cut(image);
    let rgb8 = Arc::new(shown(&image, order.view.look.tone));
    Picture { image: Arc::new(image), rgb8 }
}
