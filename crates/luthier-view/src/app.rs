//! The state of the window, its orders and their results.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui::{Align2, Area, ColorImage, Context, Frame, Id, Rect, RichText, Theme, Ui, ViewportCommand};
use luthier_gpu::{Gpu, LiveValue, RenderSettings, Shape};
use luthier_manifest::{Form, ShadingModel};
use luthier_material::Material;

use crate::canvas::Canvas;
use crate::clipboard::Clipboard;
use crate::comparison::{Against, Comparison};
use crate::error::ViewError;
use crate::files::Files;
use crate::history::History;
use crate::host::{Differences, Host, Screenshot};
use crate::keys::Action;
use crate::look::{Look, Surroundings};
use crate::options::Options;
use crate::orbit::Orbit;
use crate::shots::Schedule;
use crate::work::baker::{BakeOrder, Baker, Ready};
use crate::work::gathering::Progress;
use crate::work::latest::Latest;
use crate::work::painter::Painter;
use crate::work::view::View;
use crate::work::watcher::Watcher;

/// Shapes to choose from.
pub(crate) const SHAPES: [(Shape, &str); 4] =
    [(Shape::Mesh, "model"), (Shape::Sphere, "sphere"), (Shape::Torus, "torus"), (Shape::Plane, "plane")];

/// A screenshot on its way: its number, whether the command line asked for it, its pixels.
type Taken = (u32, bool, Arc<ColorImage>);

/// The window.
pub(crate) struct App {
    // What is shown.
    pub(crate) files: Files,
    /// Materials that were edited, by the labels of their files.
    pub(crate) edits: BTreeMap<String, Material>,
    pub(crate) history: History,
    pub(crate) clipboard: Clipboard,
    pub(crate) comparison: Comparison,
    pub(crate) last_against: Option<Against>,
    pub(crate) model: Option<ShadingModel>,
    pub(crate) fits: bool,
    pub(crate) form: Form,
    pub(crate) shape: Shape,
    pub(crate) orbit: Orbit,
    pub(crate) look: Look,
    pub(crate) surroundings: Surroundings,
    pub(crate) help: bool,
    first_look: Look,
    pub(crate) settings: RenderSettings,

    // Threads, the latest orders to them, and what they gave.
    pub(crate) host: Arc<dyn Host>,
    watcher: Watcher,
    pub(crate) baker: Baker,
    pub(crate) painter: Painter,
    files_seen: bool,
    pub(crate) bake_order: Option<BakeOrder>,
    pub(crate) baked: u64,
    bake_problem: Option<String>,
    pub(crate) ready: Option<(u64, Ready, Option<Ready>)>,
    pub(crate) paint_order: Option<(u64, u64, u32, View)>,
    /// Values of live numbers that are not those of the file, by the label of the file, and those of the last order.
    pub(crate) live: BTreeMap<String, Vec<LiveValue>>,
    pub(crate) painted_live: Arc<[LiveValue]>,
    painted: u64,
    finished: bool,
    paint_problem: Option<String>,
    /// Reasons why there is no second picture, from the bake and from the painter.
    pub(crate) against_problems: [Option<String>; 2],
    pub(crate) progress: Option<Progress>,
    pub(crate) differences: Option<Differences>,
    pub(crate) canvas: Canvas,
    /// True while the mouse moves something that changes no picture.
    pub(crate) is_still: bool,
    pub(crate) adapter: String,
    pub(crate) status: String,

    // Screenshots.
    pub(crate) schedule: Option<Schedule>,
    by_hand: u32,
    shots: Arc<Latest<Taken>>,
    pub(crate) message: Option<String>,
    failure: Arc<Mutex<Option<String>>>,
}

impl App {
    pub(crate) fn new(
        context: Context,
        host: Arc<dyn Host>,
        gpu: Gpu,
        options: &Options,
        look: Look,
        surroundings: Surroundings,
        failure: Arc<Mutex<Option<String>>>,
    ) -> Result<Self, ViewError> {
        let shape = if options.shape == Shape::Grid { Shape::Sphere } else { options.shape };
        let adapter = format!("{} ({})", gpu.adapter_name(), gpu.backend());
        Ok(Self {
            files: Files::default(),
            edits: BTreeMap::new(),
            history: History::default(),
            clipboard: Clipboard::default(),
            comparison: options.comparison,
            last_against: None,
            model: options.model,
            fits: options.fits,
            form: options.form,
            shape,
            orbit: Orbit::of(shape),
            look,
            surroundings,
            help: false,
            first_look: look,
            settings: options.settings.clone(),
            watcher: Watcher::start(Arc::clone(&host), context.clone())?,
            baker: Baker::start(Arc::clone(&host), context.clone())?,
            painter: Painter::start(Arc::clone(&host), gpu, options.settings.clone(), context)?,
            host,
            files_seen: false,
            bake_order: None,
            baked: 0,
            bake_problem: None,
            ready: None,
            paint_order: None,
            live: BTreeMap::new(),
            painted_live: Arc::from([]),
            painted: 0,
            finished: false,
            paint_problem: None,
            against_problems: [None, None],
            progress: None,
            differences: None,
            canvas: Canvas::default(),
            is_still: false,
            adapter,
            status: String::new(),
            schedule: options.shots.map(Schedule::new),
            by_hand: 0,
            shots: Arc::new(Latest::default()),
            message: None,
            failure,
        })
    }

    /// The material as it is shown, before the choice of a model.
    pub(crate) fn material(&self) -> Option<&Material> {
        let entry = self.files.selected()?;
        self.edits.get(&entry.label).or(entry.material.as_ref())
    }

    /// The model of a material if none is chosen. The form `full` has no tables, so its model is not fitted.
    pub(crate) fn own_model(&self, material: &Material) -> ShadingModel {
        let has_fit = self.fits && self.form == Form::Baked && !self.comparison.is_of_forms(self.form);
        if has_fit { material.model() } else { material.model_without_fit() }
    }

    pub(crate) fn reset_camera(&mut self) {
        self.orbit = Orbit::of(self.shape);
    }

    pub(crate) fn reset_look(&mut self) {
        self.look = self.first_look;
    }

    pub(crate) fn set_shape(&mut self, shape: Shape) {
        self.shape = shape;
        self.reset_camera();
    }

    /// Asks for a screenshot; it arrives with one of the next frames.
    pub(crate) fn shoot(&mut self, context: &Context) {
        self.by_hand += 1;
        self.request(context, self.by_hand, false);
    }

    pub(crate) fn request(&self, context: &Context, number: u32, asked: bool) {
        let (slot, waker) = (Arc::clone(&self.shots), context.clone());
        context.request_screenshot(move |image| {
            slot.put((number, asked, image));
            waker.request_repaint();
        });
    }

    /// Takes what the threads have.
    pub(crate) fn receive(&mut self, context: &Context) {
        if let Some(files) = self.watcher.files.take() {
            // A saved file replaces the edits of it.
            for label in self.files.update(files) {
                self.edits.remove(&label);
                self.history.forget(&label);
            }
            self.files_seen = true;
            if let Some(schedule) = &mut self.schedule {
                schedule.files_changed();
            }
        }
        if let Some(baked) = self.baker.results.take() {
            self.baked = baked.version;
            let [first, second] = baked.sides;
            let (other, problem) = match second {
                Some(Ok(ready)) => (Some(ready), None),
                Some(Err(problem)) => (None, Some(problem)),
                None => (None, None),
            };
            self.against_problems[0] = problem;
            match first {
                Some(Ok(ready)) => {
                    self.ready = Some((baked.version, ready, other));
                    self.bake_problem = None;
                }
                Some(Err(problem)) => self.bake_problem = Some(problem),
                None => {}
            }
        }
        if let Some(painted) = self.painter.painted.take() {
            (self.painted, self.finished) = (painted.version, painted.finished);
            (self.progress, self.differences) = (painted.progress, painted.differences);
            self.against_problems[1] = None;
            for (side, picture) in painted.pictures.into_iter().enumerate() {
                match picture {
                    Some(Ok(picture)) => {
                        if side == 0 {
                            let (width, height) = (picture.image.width, picture.image.height);
                            self.status = format!("{width} × {height}, {:.0} ms", 1e3 * painted.seconds);
                            self.paint_problem = None;
                        }
                        self.canvas.take(context, side, picture);
                    }
                    Some(Err(problem)) if side == 0 => self.paint_problem = Some(problem),
                    Some(Err(problem)) => self.against_problems[1] = Some(problem),
                    None => {}
                }
            }
            if self.against_problem().is_some() {
                self.canvas.sides[1].clear();
            }
        }
        if let Some((number, asked, image)) = self.shots.take() {
            self.save(context, number, asked, &image);
        }
    }

    fn save(&mut self, context: &Context, number: u32, asked: bool, image: &ColorImage) {
        let [width, height] = image.size.map(|length| length as u32);
        let rgb8 = image.pixels.iter().flat_map(|pixel| [pixel.r(), pixel.g(), pixel.b()]).collect();
        let saved = self.host.save(&Screenshot { width, height, rgb8 }, number, asked);
        let last = self.schedule.as_ref().is_some_and(|schedule| schedule.is_last(number));
        if asked && (last || saved.is_err()) {
            *self.failure.lock().unwrap_or_else(PoisonError::into_inner) = saved.err();
            context.send_viewport_cmd(ViewportCommand::Close);
            return;
        }
        // The status line does not mention screenshots of the command line: later ones would show it.
        if !asked {
            self.message = Some(match saved {
                Ok(path) => format!("saved {path}"),
                Err(problem) => problem,
            });
        }
    }

    pub(crate) fn act(&mut self, action: Action, context: &Context) {
        match action {
            Action::Next => self.files.step(1),
            Action::Previous => self.files.step(-1),
            Action::Form => self.form = if self.form == Form::Baked { Form::Full } else { Form::Baked },
            Action::Model => {
                let names = ShadingModel::NAMES;
                let place = self.model.and_then(|model| names.iter().position(|name| *name == model.name()));
                let next = place.map_or(0, |place| place + 1);
                self.model = names.get(next).and_then(|name| ShadingModel::from_name(name));
            }
            Action::Shape => {
                let place = SHAPES.iter().position(|(shape, _)| *shape == self.shape).unwrap_or(0);
                self.set_shape(SHAPES[(place + 1) % SHAPES.len()].0);
            }
            Action::Background => self.look.background = !self.look.background,
            Action::Compare => self.toggle_comparison(),
            Action::Difference => self.comparison.difference = !self.comparison.difference,
            Action::DividerLeft => self.comparison.move_divider(-1.0),
            Action::DividerRight => self.comparison.move_divider(1.0),
            Action::Undo => self.undo(),
            Action::Redo => self.redo(),
            Action::Copy => self.copy(),
            Action::ResetCamera => self.reset_camera(),
            Action::ResetEdits => self.reset_edits(),
            Action::Theme => {
                context.set_theme(if context.theme() == Theme::Dark { Theme::Light } else { Theme::Dark });
            }
            Action::Screenshot => self.shoot(context),
            Action::Help => self.help = !self.help,
            Action::Quit => context.send_viewport_cmd(ViewportCommand::Close),
        }
    }

    /// Shows the problems over the picture, which stays.
    pub(crate) fn problem(&self, ui: &Ui, rect: Rect) {
        let of_file = self.files.selected().and_then(|entry| entry.problem.as_ref());
        let problems: Vec<&String> =
            [of_file, self.bake_problem.as_ref(), self.paint_problem.as_ref()].into_iter().flatten().collect();
        if problems.is_empty() {
            return;
        }
        let visuals = &ui.visuals();
        let frame =
            Frame::window(ui.style()).stroke((1.0, visuals.error_fg_color)).inner_margin(10.0).corner_radius(6.0);
        Area::new(Id::unique("problem"))
            .pivot(Align2::LEFT_BOTTOM)
            .fixed_pos(rect.left_bottom() + eframe::egui::vec2(12.0, -12.0))
            .constrain_to(rect)
            .fade_in(false)
            .show(ui.ctx(), |ui| {
                frame.show(ui, |ui| {
                    ui.set_max_width(rect.width() - 48.0);
                    for problem in problems {
                        ui.label(RichText::new(problem.trim_end()).monospace().size(12.0));
                    }
                    if !self.canvas.sides[0].is_empty() {
                        ui.label(RichText::new("The picture is the last good one.").weak().size(11.0));
                    }
                });
            });
    }

    /// State of the threads.
    pub(crate) fn state(&self) -> &str {
        if let Some(message) = &self.message {
            return message;
        }
        let ordered = self.bake_order.as_ref().map_or(0, |order| order.version);
        let painting = self.paint_order.map_or(0, |(version, ..)| version);
        match () {
            () if !self.files_seen => "reading",
            () if self.material().is_none() => "no material",
            () if ordered != self.baked && self.form == Form::Baked => "baking",
            () if ordered != self.baked => "preparing",
            () if painting == self.painted && !self.finished && self.progress.is_some() => "simulating",
            () if painting != self.painted || !self.finished => "rendering",
            () => "ready",
        }
    }

    /// True while no thread works on anything that would change the window.
    pub(crate) fn settled(&self) -> bool {
        if !self.files_seen {
            return false;
        }
        if self.material().is_none() {
            return true;
        }
        let baked = self.bake_order.as_ref().is_some_and(|order| order.version == self.baked);
        let painted = self.paint_order.is_none_or(|(version, ..)| version == self.painted && self.finished);
        baked && painted && (self.paint_order.is_some() || self.bake_problem.is_some())
    }
}
