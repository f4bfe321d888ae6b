//! Colours and spacing.

use eframe::egui::{Color32, Context, CornerRadius, Stroke, Theme, Vec2, Visuals};

/// Varnish.
const ACCENT: [Color32; 2] = [Color32::from_rgb(0xd9, 0x9a, 0x3d), Color32::from_rgb(0x9c, 0x5f, 0x0c)];

/// Linear colour behind the shape in the light theme. The dark theme takes the colour of the settings.
pub(crate) const LIGHT_BACKDROP: [f32; 3] = [0.62, 0.62, 0.61];

/// Sets up both themes.
pub(crate) fn apply(context: &Context) {
    for theme in [Theme::Dark, Theme::Light] {
        let dark = theme == Theme::Dark;
        let mut visuals = if dark { Visuals::dark() } else { Visuals::light() };
        let gray = Color32::from_gray;
        let accent = ACCENT[usize::from(!dark)];
        visuals.panel_fill =
            if dark { Color32::from_rgb(0x1c, 0x1d, 0x20) } else { Color32::from_rgb(0xf7, 0xf6, 0xf3) };
        visuals.window_fill = visuals.panel_fill;
        visuals.extreme_bg_color = if dark { gray(0x10) } else { gray(0xff) };
        visuals.override_text_color = Some(if dark { gray(0xdc) } else { gray(0x22) });
        visuals.weak_text_color = Some(if dark { gray(0x98) } else { gray(0x60) });
        visuals.selection.bg_fill = accent.gamma_multiply(if dark { 0.45 } else { 0.35 });
        visuals.selection.stroke = Stroke::new(1.0, if dark { gray(0xff) } else { gray(0x10) });
        visuals.hyperlink_color = accent;
        visuals.slider_trailing_fill = true;
        for widget in [&mut visuals.widgets.inactive, &mut visuals.widgets.hovered, &mut visuals.widgets.active] {
            widget.corner_radius = CornerRadius::same(4);
        }
        context.set_visuals_of(theme, visuals);
    }
    context.all_styles_mut(|style| {
        style.spacing.item_spacing = Vec2::new(8.0, 5.0);
        style.spacing.slider_width = 120.0;
        style.spacing.interact_size.y = 20.0;
        style.spacing.combo_width = 150.0;
        style.interaction.selectable_labels = false;
    });
}
