//! The two pictures: their makers, and the orders for them.

use std::sync::Arc;

use eframe::egui::{Rect, Theme, Ui};
use luthier_gpu::{Backdrop, LiveValue};
use luthier_manifest::ShadingModel;

use crate::app::App;
use crate::comparison::Against;
use crate::theme::LIGHT_BACKDROP;
use crate::work::baker::{BakeOrder, Subject, Way};
use crate::work::painter::PaintOrder;
use crate::work::view::View;

impl App {
    /// Shows the second picture that was shown last, or none.
    pub(crate) fn toggle_comparison(&mut self) {
        match self.comparison.against.take() {
            Some(against) => self.last_against = Some(against),
            None => self.comparison.against = Some(self.last_against.unwrap_or(Against::Simulation)),
        }
    }

    /// Names of the makers of the two pictures.
    pub(crate) fn names(&self) -> [String; 2] {
        let own = self.material().map_or("", |material| self.own_model(material).name());
        let model = self.model.map_or(own, |model| model.name());
        let second = match self.comparison.against {
            None => String::new(),
            Some(Against::Shader { model: other, form }) => {
                format!("{}, {}", other.map_or(model, |model| model.name()), form.unwrap_or(self.form))
            }
            Some(Against::Simulation) => match self.progress {
                Some(progress) => format!("simulation, {} paths", progress.paths),
                None => "simulation".to_owned(),
            },
        };
        [format!("{model}, {}", self.form), second]
    }

    /// Reason why there is no second picture.
    pub(crate) fn against_problem(&self) -> Option<&str> {
        self.against_problems.iter().flatten().next().map(String::as_str)
    }

    /// The shown material, and the one beside it.
    fn subjects(&self) -> Option<[Option<Subject>; 2]> {
        let material = self.material()?;
        let revision = self.files.selected().map_or(0, |entry| entry.revision);
        let subject = |model: Option<ShadingModel>, way: Way| {
            let mut material = material.clone();
            match model {
                Some(model) => material.shade_by(model),
                None => material.bake.model = Some(self.own_model(&material)),
            }
            Subject { material, way, revision }
        };
        let second = self.comparison.way(self.form).map(|way| match self.comparison.against {
            Some(Against::Shader { model, .. }) => subject(model.or(self.model), way),
            // The simulation needs no model. It gets the same subject for all models, so that another choice keeps its picture.
            _ => Subject { material: material.clone(), way, revision },
        });
        Some([Some(subject(self.model, Way::Shader(self.form))), second])
    }

    /// Values of live numbers of the material that is shown.
    pub(crate) fn live_values(&self) -> Vec<LiveValue> {
        let entry = self.files.selected();
        entry.and_then(|entry| self.live.get(&entry.label)).cloned().unwrap_or_default()
    }

    /// Sends the threads new orders where something changed.
    pub(crate) fn order(&mut self, ui: &Ui, rect: Rect, moving: bool) {
        if let Some(subjects) = self.subjects()
            && self.bake_order.as_ref().is_none_or(|last| last.subjects != subjects)
        {
            if self.bake_order.as_ref().is_none_or(|last| second_maker(&last.subjects) != second_maker(&subjects)) {
                // A picture of another maker is not shown under the name of this one.
                self.canvas.sides[1].clear();
                self.against_problems = [None, None];
                (self.progress, self.differences) = (None, None);
            }
            let version = self.bake_order.as_ref().map_or(1, |last| last.version + 1);
            let order = BakeOrder { version, subjects };
            self.baker.orders.put(order.clone());
            self.bake_order = Some(order);
        }
        let Some((baked, side, other)) = &self.ready else { return };
        let pixels = [rect.width(), rect.height()].map(|points| points * ui.ctx().pixels_per_point());
        let view = View {
            shape: self.shape,
            orbit: self.orbit,
            look: self.look,
            backdrop: self.backdrop(ui.ctx().theme()),
            size: pixels.map(|side| side.round().max(1.0) as u32),
            samples: self.settings.samples,
            environment_samples: self.settings.environment_samples,
            moving,
        };
        let paths = self.comparison.paths;
        let live = self.live_values();
        let is_ordered = |(_, of, for_paths, last)| (of, for_paths, last) == (*baked, paths, view);
        if !self.paint_order.is_some_and(is_ordered) || *self.painted_live != *live {
            let live: Arc<[LiveValue]> = Arc::from(live);
            self.painted_live = Arc::clone(&live);
            let version = self.paint_order.map_or(1, |(last, ..)| last + 1);
            self.paint_order = Some((version, *baked, paths, view));
            let environment = Arc::clone(self.surroundings.environment(self.look.surroundings));
            let (side, other) = (side.clone(), other.clone());
            self.painter.orders.put(PaintOrder { version, side, other, paths, environment, live, view });
        }
    }

    fn backdrop(&self, theme: Theme) -> [f32; 3] {
        match (theme, self.settings.backdrop) {
            (Theme::Dark, Backdrop::Plain(color)) => color,
            (Theme::Dark, Backdrop::Environment) => [0.13; 3],
            (Theme::Light, _) => LIGHT_BACKDROP,
        }
    }
}

/// The maker of the second picture.
fn second_maker(subjects: &[Option<Subject>; 2]) -> Option<(Way, Option<ShadingModel>)> {
    subjects[1].as_ref().map(|subject| (subject.way, subject.material.bake.model))
}
