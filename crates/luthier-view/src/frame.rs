//! One frame of the window.

use eframe::egui::{CentralPanel, Frame, Margin, Panel, Ui};

use crate::app::App;
use crate::keys::actions;
use crate::{panel, picture};

/// Width of the panel in points.
const PANEL: f32 = 340.0;

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
        self.is_still = false;
        let frame = Frame::side_top_panel(ui.style()).inner_margin(Margin::symmetric(12, 8));
        Panel::right("panel").exact_size(PANEL).resizable(false).frame(frame).show(ui, |ui| panel::show(self, ui));
        Panel::bottom("status").show(ui, |ui| panel::status(self, ui));
        CentralPanel::default().frame(Frame::NONE.fill(ui.visuals().panel_fill)).show(ui, |ui| picture::show(self, ui));
        panel::help(self, &context);
        // An edit is one step until the mouse is released, or the number that is being typed is left.
        if !context.input(|input| input.pointer.any_down()) && !context.text_edit_focused() {
            self.history.close();
        }

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
