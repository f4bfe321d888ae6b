//! Choice of the second picture, and the comparison of the two.

use eframe::egui::{ComboBox, RichText, Slider, SliderClamping, Ui};
use luthier_manifest::{Form, ShadingModel};

use crate::app::App;
use crate::comparison::{Against, GAIN, report};

/// The row that chooses the second picture.
pub(super) fn choice(app: &mut App, ui: &mut Ui) {
    ui.label("compare with");
    let own = app.form;
    let against = &mut app.comparison.against;
    let text = against.map_or_else(|| "nothing".to_owned(), name);
    ComboBox::from_id_salt("against").width(190.0).selected_text(text).show_ui(ui, |ui| {
        let forms = Form::ALL.into_iter().filter(|form| *form != own);
        let forms = forms.map(|form| Against::Shader { model: None, form: Some(form) });
        let models = ShadingModel::NAMES.iter().filter_map(|name| ShadingModel::from_name(name));
        let models = models.map(|model| Against::Shader { model: Some(model), form: None });
        ui.selectable_value(against, None, "nothing");
        for other in std::iter::once(Against::Simulation).chain(forms).chain(models) {
            ui.selectable_value(against, Some(other), name(other));
        }
    });
    ui.end_row();
}

fn name(against: Against) -> String {
    match against {
        Against::Simulation => "the simulation".to_owned(),
        Against::Shader { model: Some(model), form: Some(form) } => format!("{}, {form}", model.name()),
        Against::Shader { model: Some(model), form: None } => model.name().to_owned(),
        Against::Shader { model: None, form: Some(form) } => format!("the form {form}"),
        Against::Shader { model: None, form: None } => "itself".to_owned(),
    }
}

/// Divider or difference, and the distance of the two pictures.
pub(super) fn show(app: &mut App, ui: &mut Ui) {
    if app.comparison.against.is_none() {
        return;
    }
    if let Some(problem) = app.against_problem() {
        ui.label(RichText::new(problem).color(ui.visuals().warn_fg_color).size(12.0));
        return;
    }
    ui.horizontal(|ui| {
        let comparison = &mut app.comparison;
        ui.selectable_value(&mut comparison.difference, false, "divider").on_hover_text(", and . move it (D)");
        ui.selectable_value(&mut comparison.difference, true, "difference")
            .on_hover_text("absolute difference in linear light, times a factor (D)");
        let slider = if comparison.difference {
            Slider::new(&mut comparison.gain, GAIN).logarithmic(true).prefix("× ").max_decimals(0)
        } else {
            Slider::new(&mut comparison.divider, 0.0..=1.0).show_value(false)
        };
        let response = ui.add(slider.clamping(SliderClamping::Edits));
        app.is_still |= response.is_pointer_button_down_on() || response.dragged();
    });
    for line in report(app.progress, app.differences) {
        ui.label(RichText::new(line).weak().size(12.0));
    }
}
