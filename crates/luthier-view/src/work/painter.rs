//! The thread that renders.

use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::Instant;

use eframe::egui::{self, ecolor};
use luthier_gpu::{Backdrop, Environment, Gpu, GpuError, Package, RenderSettings, Scene, Shape, ToneMapping};
use luthier_lut::Image;
use luthier_manifest::Form;

use crate::error::ViewError;
use crate::latest::Latest;
use crate::look::Look;
use crate::orbit::Orbit;
use crate::stages::{Goal, Stage};

/// Longest side of a rendering, in pixels.
const SIDE_MAX: u32 = 2048;

/// Seconds per evaluation before any was measured: those of a software adapter.
const SECONDS_AT_FIRST: f64 = 5e-7;

/// View that is seen: the shape, its light, and the place of the eye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct View {
    pub(crate) shape: Shape,
    pub(crate) orbit: Orbit,
    pub(crate) look: Look,
    /// Colour behind the shape where it is not the surroundings.
    pub(crate) backdrop: [f32; 3],
    /// Pixels across and down.
    pub(crate) size: [u32; 2],
    /// Samples along each side of a pixel at rest.
    pub(crate) samples: u32,
    /// Directions of the environment at rest; 0 reads blurred maps where the form can.
    pub(crate) environment_samples: u32,
    /// Whether the mouse is at work.
    pub(crate) moving: bool,
}

/// A picture to make.
#[derive(Debug, Clone)]
pub(crate) struct PaintOrder {
    pub(crate) version: u64,
    pub(crate) package: Arc<Package>,
    pub(crate) form: Form,
    pub(crate) environment: Arc<Environment>,
    pub(crate) view: View,
}

/// A picture.
#[derive(Debug)]
pub(crate) struct Picture {
    /// Version of the order.
    pub(crate) version: u64,
    /// Whether the picture is the last of its order, or an error.
    pub(crate) finished: bool,
    pub(crate) pixels: Result<Pixels, String>,
    /// Time that the picture took.
    pub(crate) seconds: f64,
}

/// sRGB pixels.
#[derive(Debug)]
pub(crate) struct Pixels {
    pub(crate) size: [usize; 2],
    pub(crate) rgb8: Vec<u8>,
}

/// The thread, and the slots to and from it.
#[derive(Debug)]
pub(crate) struct Painter {
    pub(crate) orders: Arc<Latest<PaintOrder>>,
    pub(crate) pictures: Arc<Latest<Picture>>,
    thread: Option<JoinHandle<()>>,
}

impl Painter {
    pub(crate) fn start(gpu: Gpu, settings: RenderSettings, context: egui::Context) -> Result<Self, ViewError> {
        let (orders, pictures) = (Arc::new(Latest::default()), Arc::new(Latest::default()));
        let mut worker = Worker {
            gpu,
            settings,
            orders: Arc::clone(&orders),
            pictures: Arc::clone(&pictures),
            context,
            scene: None,
            seconds: SECONDS_AT_FIRST,
        };
        let work = move || worker.work();
        let thread =
            thread::Builder::new().name("luthier painter".to_owned()).spawn(work).map_err(ViewError::Thread)?;
        Ok(Self { orders, pictures, thread: Some(thread) })
    }
}

impl Drop for Painter {
    /// Waits for the end of the pass at hand: drivers do not like to be left at work.
    fn drop(&mut self) {
        self.orders.close();
        if let Some(thread) = self.thread.take() {
            // A panic over there has been reported over there.
            let _ = thread.join();
        }
    }
}

struct Worker {
    gpu: Gpu,
    settings: RenderSettings,
    orders: Arc<Latest<PaintOrder>>,
    pictures: Arc<Latest<Picture>>,
    context: egui::Context,
    scene: Option<(Arc<Package>, Scene)>,
    /// Per evaluation, as measured last.
    seconds: f64,
}

impl Worker {
    fn work(&mut self) {
        while let Some(order) = self.orders.wait() {
            if let Err(error) = self.paint(&order) {
                let version = order.version;
                self.show(Picture { version, finished: true, pixels: Err(error.to_string()), seconds: 0.0 });
            }
        }
    }

    fn paint(&mut self, order: &PaintOrder) -> Result<(), GpuError> {
        let scene = self.scene(order)?;
        let view = &order.view;
        let window = Window::of(view.size);
        // Blurred maps need the tables, and know no layer's own textures.
        let environment_samples = match order.form {
            Form::Baked if !scene.has_layer_maps(0)? => view.environment_samples,
            Form::Baked | Form::Full => view.environment_samples.max(FULL_FORM_DIRECTIONS),
        };
        let goal = Goal { side: window.side, samples: view.samples, environment_samples, moving: view.moving };
        let stages = goal.stages(self.seconds);
        let count = stages.len();
        for (i, stage) in stages.into_iter().enumerate() {
            let begin = Instant::now();
            let settings = self.settings(order, &window, &stage);
            let Some(image) = scene.render_unless(&[0], &settings, &|| self.orders.is_outdated())? else {
                return self.keep(order, scene);
            };
            let pixels = window.cut(&image, view.look.tone);
            let seconds = begin.elapsed().as_secs_f64();
            let evaluations = settings.size * settings.size * stage.samples * stage.samples;
            self.seconds = seconds / (f64::from(evaluations) * f64::from(1 + stage.environment_samples));
            let finished = i + 1 == count && !view.moving;
            self.show(Picture { version: order.version, finished, pixels: Ok(pixels), seconds });
        }
        self.keep(order, scene)
    }

    /// The scene of an order: the one at hand where it serves, else with other materials, else compiled.
    fn scene(&mut self, order: &PaintOrder) -> Result<Scene, GpuError> {
        match self.scene.take() {
            Some((package, scene)) if scene.form() == order.form => {
                if Arc::ptr_eq(&package, &order.package) {
                    return Ok(scene);
                }
                match scene.rebound(&order.package)? {
                    Some(scene) => Ok(scene),
                    None => self.gpu.scene(&order.package, order.form),
                }
            }
            _ => self.gpu.scene(&order.package, order.form),
        }
    }

    fn keep(&mut self, order: &PaintOrder, scene: Scene) -> Result<(), GpuError> {
        self.scene = Some((Arc::clone(&order.package), scene));
        Ok(())
    }

    fn settings(&self, order: &PaintOrder, window: &Window, stage: &Stage) -> RenderSettings {
        let view = &order.view;
        RenderSettings {
            size: ((f64::from(window.side) * stage.scale).round() as u32).max(1),
            samples: stage.samples,
            shape: view.shape,
            mesh: self.settings.mesh.clone(),
            camera: view.orbit.camera(view.shape, window.widening()),
            lights: view.look.lights(&self.settings),
            light_angular_radius: self.settings.light_angular_radius,
            environment: Arc::clone(&order.environment),
            environment_samples: stage.environment_samples,
            backdrop: if view.look.background { Backdrop::Environment } else { Backdrop::Plain(view.backdrop) },
            exposure: libm::exp2f(view.look.exposure_stops),
            film_tilt: [0.0; 2],
        }
    }

    fn show(&self, picture: Picture) {
        self.pictures.put(picture);
        self.context.request_repaint();
    }
}

/// Directions in which the full form asks for the environment at rest, at least: it reads no maps.
const FULL_FORM_DIRECTIONS: u32 = 16;

/// The part of a square rendering that the window shows: all of its longer side, the middle of the other.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Window {
    side: u32,
    /// Sides of the window over the longer one.
    share: [f64; 2],
}

impl Window {
    fn of([width, height]: [u32; 2]) -> Self {
        let longer = width.max(height).max(1);
        let share = [width, height].map(|length| f64::from(length.max(1)) / f64::from(longer));
        Self { side: longer.min(SIDE_MAX), share }
    }

    fn widening(&self) -> f64 {
        1.0 / self.share[0].min(self.share[1])
    }

    /// Cuts the part out, with tone curve and transfer function.
    fn cut(&self, image: &Image, tone: ToneMapping) -> Pixels {
        let size = self.share.map(|share| ((f64::from(image.width) * share).round() as u32).clamp(1, image.width));
        let [left, top] = size.map(|length| (image.width - length) / 2);
        let mut rgb8 = Vec::with_capacity((size[0] * size[1] * 3) as usize);
        for y in top..top + size[1] {
            for x in left..left + size[0] {
                let texel = image.texel(x, y);
                rgb8.extend(texel.iter().map(|&v| ecolor::gamma_u8_from_linear_f32(tone.value(v).min(1.0))));
            }
        }
        Pixels { size: size.map(|length| length as usize), rgb8 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_cuts_the_middle() {
        let window = Window::of([4, 2]);
        assert_eq!((window.side, window.widening()), (4, 2.0));
        let mut image = Image::zeros(4, 4, 3);
        image.texel_mut(0, 1).copy_from_slice(&[1.0, 0.5, 4.0]);
        let pixels = window.cut(&image, ToneMapping::None);
        assert_eq!(pixels.size, [4, 2]);
        assert_eq!(pixels.rgb8[..6], [255, 188, 255, 0, 0, 0]);
        let high = Window::of([2, 4]);
        assert_eq!(high.cut(&image, ToneMapping::None).size, [2, 4]);
        assert_eq!(Window::of([0, 0]).side, 1);
        assert_eq!(Window::of([10_000, 100]).side, SIDE_MAX);
    }
}
