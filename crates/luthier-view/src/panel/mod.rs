//! The panel beside the picture, the line below it, and the help.

mod compared;
mod cross_section;
mod live;

use eframe::egui::{
    Align, Align2, Button, CollapsingHeader, ComboBox, Context, Grid, Label, Layout, RichText, ScrollArea, Slider,
    SliderClamping, Ui, Window, vec2,
};
use luthier_gpu::ToneMapping;
use luthier_manifest::{Form, ShadingModel};

use crate::app::{App, SHAPES};
use crate::keys::{KEYS, MOUSE};
use crate::parameter::{Parameter, groups};

/// Value below which a logarithmic slider is linear.
const SMALLEST: f64 = 1e-3;

const TONES: [(ToneMapping, &str); 4] = [
    (ToneMapping::Shoulder, "shoulder"),
    (ToneMapping::None, "none"),
    (ToneMapping::Reinhard, "Reinhard"),
    (ToneMapping::Aces, "ACES"),
];

/// The panel.
pub(crate) fn show(app: &mut App, ui: &mut Ui) {
    title(app, ui);
    choices(app, ui);
    ui.separator();
    ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
        if let Some(material) = app.material() {
            folded(ui, "cross-section", "cross-section", |ui| cross_section::show(ui, &material.cross_section()));
        }
        live::show(app, ui);
        layers(app, ui);
        light(app, ui);
        ui.add_space(8.0);
    });
}

fn title(app: &mut App, ui: &mut Ui) {
    let Some(entry) = app.files.selected() else {
        ui.label(RichText::new("no material").heading());
        return;
    };
    let (name, label) = (entry.name().to_owned(), entry.label.clone());
    let mut chosen = app.files.selected;
    ComboBox::from_id_salt("material")
        .width(ui.available_width())
        .selected_text(RichText::new(name).strong().size(16.0))
        .show_ui(ui, |ui| {
            for (i, entry) in app.files.entries.iter().enumerate() {
                let broken = if entry.problem.is_some() { " (broken)" } else { "" };
                ui.selectable_value(&mut chosen, i, format!("{}{broken}", entry.name()));
            }
        });
    app.files.selected = chosen;
    // The buttons first: a long path has the room that they leave.
    let row = vec2(ui.available_width(), ui.spacing().interact_size.y);
    ui.allocate_ui_with_layout(row, Layout::right_to_left(Align::Center), |ui| {
        edits(app, ui);
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            ui.add(Label::new(RichText::new(label).weak().size(11.5)).truncate());
        });
    });
    if let Some(material) = app.material() {
        ui.label(RichText::new(&material.description).size(12.5));
    }
}

/// Buttons of edits, from right to left.
fn edits(app: &mut App, ui: &mut Ui) {
    if ui.small_button("copy").on_hover_text("the material as TOML, as edited (Ctrl+Shift+C)").clicked() {
        app.copy();
    }
    if button(ui, app.history.can_redo(), "redo", "Ctrl+Shift+Z or Ctrl+Y") {
        app.redo();
    }
    if button(ui, app.history.can_undo(), "undo", "Ctrl+Z") {
        app.undo();
    }
    if app.is_edited() {
        if ui.small_button("reset").on_hover_text("as in its file (R)").clicked() {
            app.reset_edits();
        }
        ui.label(RichText::new("edited").color(ui.visuals().hyperlink_color).size(11.5));
    }
}

/// Adds a small button. Returns true when it is clicked.
fn button(ui: &mut Ui, is_enabled: bool, name: &str, hint: &str) -> bool {
    ui.add_enabled(is_enabled, Button::new(name).small()).on_hover_text(hint).clicked()
}

fn choices(app: &mut App, ui: &mut Ui) {
    let own = app.material().map_or("", |material| app.own_model(material).name());
    Grid::new("choices").num_columns(2).show(ui, |ui| {
        ui.label("model");
        let text = app.model.map_or_else(|| format!("{own} (its own)"), |model| model.name().to_owned());
        ComboBox::from_id_salt("model").width(190.0).selected_text(text).show_ui(ui, |ui| {
            ui.selectable_value(&mut app.model, None, format!("{own} (its own)"));
            for name in ShadingModel::NAMES {
                ui.selectable_value(&mut app.model, ShadingModel::from_name(name), *name);
            }
        });
        ui.end_row();
        ui.label("form");
        ui.horizontal(|ui| {
            for form in Form::ALL {
                let hint = match form {
                    Form::Baked => "reads tables; indices and films bake anew",
                    Form::Full => "evaluates everything; edits need no tables",
                };
                ui.selectable_value(&mut app.form, form, form.name()).on_hover_text(hint);
            }
        });
        ui.end_row();
        ui.label("shape");
        ui.horizontal(|ui| {
            for (shape, name) in SHAPES {
                if ui.selectable_label(app.shape == shape, name).clicked() {
                    app.set_shape(shape);
                }
            }
        });
        ui.end_row();
        compared::choice(app, ui);
    });
    compared::show(app, ui);
}

/// One section per layer and effect.
fn layers(app: &mut App, ui: &mut Ui) {
    let Some(material) = app.material() else { return };
    let before = material.clone();
    let mut edited = before.clone();
    for (i, group) in groups(&before).into_iter().enumerate() {
        if group.parameters.is_empty() {
            continue;
        }
        section(ui, (&before.name, i), &group.title, |ui| {
            for parameter in &group.parameters {
                let Some(mut value) = parameter.handle.get(&before) else { continue };
                if number(ui, parameter, &mut value) {
                    parameter.handle.set(&mut edited, value);
                }
            }
        });
    }
    if edited != before {
        app.edit(edited);
    }
}

fn section(ui: &mut Ui, id: impl std::hash::Hash + std::fmt::Debug, title: &str, contents: impl FnOnce(&mut Ui)) {
    folded(ui, &id, title, |ui| {
        Grid::new(("grid", &id)).num_columns(2).min_col_width(84.0).show(ui, contents);
    });
}

fn folded(ui: &mut Ui, id: impl std::hash::Hash + std::fmt::Debug, title: &str, contents: impl FnOnce(&mut Ui)) {
    CollapsingHeader::new(RichText::new(title).strong()).id_salt(&id).default_open(true).show(ui, contents);
}

fn number(ui: &mut Ui, parameter: &Parameter, value: &mut f64) -> bool {
    ui.label(parameter.label);
    let slider = Slider::new(value, parameter.range.clone())
        .suffix(parameter.unit)
        .logarithmic(parameter.logarithmic)
        .smallest_positive(SMALLEST)
        .max_decimals(3)
        .clamping(SliderClamping::Edits);
    let changed = ui.add(slider).changed();
    ui.end_row();
    changed
}

fn light(app: &mut App, ui: &mut Ui) {
    section(ui, "light", "light", |ui| {
        let look = &mut app.look;
        let sliders = [
            ("exposure", &mut look.exposure_stops, -8.0..=8.0, " EV"),
            ("light", &mut look.strength, 0.0..=8.0, ""),
            ("azimuth", &mut look.azimuth_deg, -180.0..=180.0, "°"),
            ("elevation", &mut look.elevation_deg, -90.0..=90.0, "°"),
        ];
        for (label, value, range, unit) in sliders {
            ui.label(label);
            ui.add(Slider::new(value, range).suffix(unit).max_decimals(2).clamping(SliderClamping::Edits));
            ui.end_row();
        }
        ui.label("surroundings");
        let chosen = app.surroundings.names().nth(look.surroundings).unwrap_or_default();
        ComboBox::from_id_salt("surroundings").selected_text(chosen).show_ui(ui, |ui| {
            for (i, name) in app.surroundings.names().enumerate() {
                ui.selectable_value(&mut look.surroundings, i, name);
            }
        });
        ui.end_row();
        ui.label("");
        ui.checkbox(&mut look.background, "seen behind");
        ui.end_row();
        ui.label("tone curve");
        let chosen = TONES.iter().find(|(tone, _)| *tone == look.tone).map_or("", |(_, name)| name);
        ComboBox::from_id_salt("tone").selected_text(chosen).show_ui(ui, |ui| {
            for (tone, name) in TONES {
                ui.selectable_value(&mut look.tone, tone, name);
            }
        });
        ui.end_row();
    });
    ui.horizontal(|ui| {
        if ui.button("reset light").clicked() {
            app.reset_look();
        }
        if ui.button("reset camera").clicked() {
            app.reset_camera();
        }
    });
}

/// The line below the picture.
pub(crate) fn status(app: &App, ui: &mut Ui) {
    ui.horizontal(|ui| {
        ui.label(small(app.state()).strong());
        ui.label(small(&app.status).weak());
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.label(small("H help").weak());
            ui.label(small(&app.adapter).weak());
        });
    });
}

fn small(text: &str) -> RichText {
    RichText::new(text).size(11.5)
}

/// Keys and mouse.
pub(crate) fn help(app: &mut App, context: &Context) {
    let mut open = app.help;
    Window::new("Keys")
        .open(&mut open)
        .resizable(false)
        .collapsible(false)
        .anchor(Align2::CENTER_CENTER, vec2(0.0, 0.0))
        .show(context, |ui| {
            Grid::new("keys").num_columns(2).spacing([24.0, 4.0]).show(ui, |ui| {
                for (.., name, _, what) in KEYS.iter().filter(|(.., what)| !what.is_empty()) {
                    ui.label(RichText::new(*name).monospace().strong());
                    ui.label(*what);
                    ui.end_row();
                }
                for (gesture, what) in MOUSE {
                    ui.label(RichText::new(gesture).monospace().strong());
                    ui.label(what);
                    ui.end_row();
                }
            });
        });
    app.help = open;
}
