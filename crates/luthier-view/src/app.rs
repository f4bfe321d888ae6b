//! The window: what it knows, and one frame of it.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui::{
    Align2, Area, CentralPanel, ColorImage, Context, Frame, Id, Margin, Panel, PointerButton, Rect, RichText, Sense,
    TextureHandle, TextureOptions, Theme, Ui, ViewportCommand, pos2,
};
use luthier_gpu::{Gpu, Package, RenderSettings, Shape};
use luthier_manifest::{Form, ShadingModel};
use luthier_material::Material;

use crate::baker::{BakeOrder, Baker};
use crate::error::ViewError;
use crate::files::Files;
use crate::host::{Host, Screenshot};
use crate::keys::{Action, actions};
use crate::latest::Latest;
use crate::look::{Look, Surroundings};
use crate::orbit::Orbit;
use crate::painter::{PaintOrder, Painter, View};
use crate::shots::Schedule;
use crate::theme::LIGHT_BACKDROP;
use crate::watcher::Watcher;
use crate::window::Options;

/// Shapes to choose from.
pub(crate) const SHAPES: [(Shape, &str); 4] =
    [(Shape::Mesh, "model"), (Shape::Sphere, "sphere"), (Shape::Torus, "torus"), (Shape::Plane, "plane")];

/// Points of the wheel's smooth motion that make a notch.
const POINTS_PER_NOTCH: f32 = 40.0;

/// Width of the panel in points.
const PANEL: f32 = 340.0;

/// A screenshot on its way: its number, whether the command line asked for it, its pixels.
type Taken = (u32, bool, Arc<ColorImage>);

/// The window.
pub(crate) struct App {
    // What is shown.
    pub(crate) files: Files,
    /// Materials that were edited, by the labels of their files.
    pub(crate) edits: BTreeMap<String, Material>,
    pub(crate) model: Option<ShadingModel>,
    fits: bool,
    pub(crate) form: Form,
    pub(crate) shape: Shape,
    pub(crate) orbit: Orbit,
    pub(crate) look: Look,
    pub(crate) surroundings: Surroundings,
    pub(crate) help: bool,
    first_look: Look,
    settings: RenderSettings,

    // Threads, the latest orders to them, and what they gave.
    host: Arc<dyn Host>,
    watcher: Watcher,
    baker: Baker,
    painter: Painter,
    files_seen: bool,
    bake_order: Option<BakeOrder>,
    baked: u64,
    bake_problem: Option<String>,
    package: Option<(u64, Form, Arc<Package>)>,
    paint_order: Option<(u64, u64, View)>,
    painted: u64,
    finished: bool,
    paint_problem: Option<String>,
    texture: Option<TextureHandle>,
    pub(crate) adapter: String,
    pub(crate) status: String,

    // Screenshots.
    schedule: Option<Schedule>,
    by_hand: u32,
    shots: Arc<Latest<Taken>>,
    message: Option<String>,
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
            painter: Painter::start(gpu, options.settings.clone(), context)?,
            host,
            files_seen: false,
            bake_order: None,
            baked: 0,
            bake_problem: None,
            package: None,
            paint_order: None,
            painted: 0,
            finished: false,
            paint_problem: None,
            texture: None,
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

    /// The model of a material where none is chosen: the form `full` has no tables, and so no fit.
    pub(crate) fn own_model(&self, material: &Material) -> ShadingModel {
        if self.fits && self.form == Form::Baked { material.model() } else { material.model_without_fit() }
    }

    /// Keeps an edited material; one that is as in its file is no edit.
    pub(crate) fn edit(&mut self, material: Material) {
        let Some(entry) = self.files.selected() else { return };
        if entry.material.as_ref() == Some(&material) {
            self.edits.remove(&entry.label);
        } else {
            self.edits.insert(entry.label.clone(), material);
        }
    }

    pub(crate) fn is_edited(&self) -> bool {
        self.files.selected().is_some_and(|entry| self.edits.contains_key(&entry.label))
    }

    pub(crate) fn reset_edits(&mut self) {
        if let Some(entry) = self.files.selected() {
            self.edits.remove(&entry.label);
        }
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

    fn request(&self, context: &Context, number: u32, asked: bool) {
        let (slot, waker) = (Arc::clone(&self.shots), context.clone());
        context.request_screenshot(move |image| {
            slot.put((number, asked, image));
            waker.request_repaint();
        });
    }

    /// Takes what the threads have.
    fn receive(&mut self, context: &Context) {
        if let Some(files) = self.watcher.files.take() {
            // What was edited is replaced by what was saved.
            for label in self.files.update(files) {
                self.edits.remove(&label);
            }
            self.files_seen = true;
            if let Some(schedule) = &mut self.schedule {
                schedule.files_changed();
            }
        }
        if let Some(baked) = self.baker.results.take() {
            self.baked = baked.version;
            match baked.package {
                Ok(package) => {
                    self.package = Some((baked.version, baked.form, package));
                    self.bake_problem = None;
                }
                Err(problem) => self.bake_problem = Some(problem),
            }
        }
        if let Some(picture) = self.painter.pictures.take() {
            (self.painted, self.finished) = (picture.version, picture.finished);
            match picture.pixels {
                Ok(pixels) => {
                    let [width, height] = pixels.size;
                    self.status = format!("{width} × {height}, {:.0} ms", 1e3 * picture.seconds);
                    let image = ColorImage::from_rgb(pixels.size, &pixels.rgb8);
                    match &mut self.texture {
                        Some(texture) => texture.set(image, TextureOptions::LINEAR),
                        None => self.texture = Some(context.load_texture("picture", image, TextureOptions::LINEAR)),
                    }
                    self.paint_problem = None;
                }
                Err(problem) => self.paint_problem = Some(problem),
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
        // Later screenshots of the command line do not show that there were earlier ones.
        if !asked {
            self.message = Some(match saved {
                Ok(path) => format!("saved {path}"),
                Err(problem) => problem,
            });
        }
    }

    fn act(&mut self, action: Action, context: &Context) {
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

    /// The picture, and the mouse on it.
    fn picture(&mut self, ui: &mut Ui) {
        let rect = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(rect, Sense::click_and_drag());
        let side = f64::from(rect.width().min(rect.height()).max(1.0));
        let motion = response.drag_delta();
        let share = [motion.x, motion.y].map(|points| f64::from(points) / side);
        if response.dragged_by(PointerButton::Primary) {
            self.orbit.drag(share[0], share[1]);
        }
        if response.dragged_by(PointerButton::Secondary) {
            let [right, down] = share.map(|share| 180.0 * share as f32);
            self.look.azimuth_deg = (self.look.azimuth_deg + right + 540.0).rem_euclid(360.0) - 180.0;
            self.look.elevation_deg = (self.look.elevation_deg - down).clamp(-90.0, 90.0);
        }
        let scrolled = ui.input(|input| input.smooth_scroll_delta.y);
        let zooming = response.hovered() && scrolled != 0.0;
        if zooming {
            self.orbit.wheel(f64::from(scrolled / POINTS_PER_NOTCH));
        }
        if let Some(texture) = &self.texture {
            let all = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter().image(texture.id(), rect, all, eframe::egui::Color32::WHITE);
        }
        let moving = zooming || ui.input(|input| input.pointer.any_down());
        self.order(ui, rect, moving);
        self.problem(ui, rect);
    }

    /// Gives the threads what has changed.
    fn order(&mut self, ui: &Ui, rect: Rect, moving: bool) {
        if let Some(mut material) = self.material().cloned() {
            match self.model {
                Some(model) => material.shade_by(model),
                None => material.bake.model = Some(self.own_model(&material)),
            }
            let (form, revision) = (self.form, self.files.selected().map_or(0, |entry| entry.revision));
            let is_same =
                |last: &BakeOrder| last.material == material && (last.form, last.revision) == (form, revision);
            if !self.bake_order.as_ref().is_some_and(is_same) {
                let version = self.bake_order.as_ref().map_or(1, |last| last.version + 1);
                let order = BakeOrder { version, material, form, revision };
                self.baker.orders.put(order.clone());
                self.bake_order = Some(order);
            }
        }
        let Some((baked, form, package)) = &self.package else { return };
        let pixels = |points: f32| (points * ui.ctx().pixels_per_point()).round().max(1.0) as u32;
        let view = View {
            shape: self.shape,
            orbit: self.orbit,
            look: self.look,
            backdrop: self.backdrop(ui.ctx().theme()),
            size: [pixels(rect.width()), pixels(rect.height())],
            samples: self.settings.samples,
            environment_samples: self.settings.environment_samples,
            moving,
        };
        let environment = Arc::clone(self.surroundings.environment(self.look.surroundings));
        if self.paint_order.is_none_or(|(_, of, last)| of != *baked || last != view) {
            let version = self.paint_order.map_or(1, |(last, ..)| last + 1);
            self.paint_order = Some((version, *baked, view));
            let package = Arc::clone(package);
            self.painter.orders.put(PaintOrder { version, package, form: *form, environment, view });
        }
    }

    fn backdrop(&self, theme: Theme) -> [f32; 3] {
        match (theme, self.settings.backdrop) {
            (Theme::Dark, luthier_gpu::Backdrop::Plain(color)) => color,
            (Theme::Dark, luthier_gpu::Backdrop::Environment) => [0.13; 3],
            (Theme::Light, _) => LIGHT_BACKDROP,
        }
    }

    /// Shows the problems over the picture, which stays.
    fn problem(&self, ui: &Ui, rect: Rect) {
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
                    if self.texture.is_some() {
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
            () if painting != self.painted || !self.finished => "rendering",
            () => "ready",
        }
    }

    /// Whether nothing is going on that would change what the window shows.
    fn settled(&self) -> bool {
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

impl eframe::App for App {
    fn ui(&mut self, ui: &mut Ui, _: &mut eframe::Frame) {
        let context = ui.ctx().clone();
        self.receive(&context);
        let actions = actions(&context);
        if !actions.is_empty() {
            self.message = None;
        }
        for action in actions {
            self.act(action, &context);
        }
        let frame = Frame::side_top_panel(ui.style()).inner_margin(Margin::symmetric(12, 8));
        Panel::right("panel")
            .exact_size(PANEL)
            .resizable(false)
            .frame(frame)
            .show(ui, |ui| crate::panel::show(self, ui));
        Panel::bottom("status").show(ui, |ui| crate::panel::status(self, ui));
        CentralPanel::default().frame(Frame::NONE.fill(ui.visuals().panel_fill)).show(ui, |ui| self.picture(ui));
        crate::panel::help(self, &context);

        let settled = self.settled();
        if let Some(schedule) = &mut self.schedule {
            if let Some(number) = schedule.frame(settled) {
                self.request(&context, number, true);
            }
            if settled {
                context.request_repaint();
            }
        }
    }
}
