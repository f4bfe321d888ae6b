//! The picture, or two of them with a divider, or their difference; and the mouse on it.

use eframe::egui::{
    Align2, Color32, CursorIcon, FontId, Painter, PointerButton, Rect, Sense, Stroke, TextureHandle, Ui, pos2, vec2,
};

use crate::app::App;

/// Points of the wheel's smooth motion that make a notch.
const POINTS_PER_NOTCH: f32 = 40.0;

/// Points from the divider within which the mouse takes it.
const GRIP: f32 = 7.0;

/// The picture, and the mouse on it.
pub(crate) fn show(app: &mut App, ui: &mut Ui) {
    let rect = ui.available_rect_before_wrap();
    let response = ui.allocate_rect(rect, Sense::click_and_drag());
    let side = f64::from(rect.width().min(rect.height()).max(1.0));
    let motion = response.drag_delta();
    let share = [motion.x, motion.y].map(|points| f64::from(points) / side);
    let has_divider = app.comparison.against.is_some() && !app.comparison.difference;
    let divider = rect.left() + app.comparison.divider * rect.width();
    let is_near = has_divider && response.hover_pos().is_some_and(|at| (at.x - divider).abs() <= GRIP);
    let (is_pressed, is_down) = ui.input(|input| (input.pointer.primary_pressed(), input.pointer.primary_down()));
    if is_pressed {
        app.canvas.holds_divider = is_near;
    }
    app.canvas.holds_divider &= is_down;
    let holds_divider = app.canvas.holds_divider;
    if holds_divider || is_near {
        ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
    }
    if response.dragged_by(PointerButton::Primary) {
        match response.interact_pointer_pos().filter(|_| holds_divider) {
            Some(at) => {
                app.comparison.divider = ((at.x - rect.left()) / rect.width().max(1.0)).clamp(0.0, 1.0);
            }
            None => app.orbit.drag(share[0], share[1]),
        }
    }
    if response.dragged_by(PointerButton::Secondary) {
        let [right, down] = share.map(|share| 180.0 * share as f32);
        app.look.azimuth_deg = (app.look.azimuth_deg + right + 540.0).rem_euclid(360.0) - 180.0;
        app.look.elevation_deg = (app.look.elevation_deg - down).clamp(-90.0, 90.0);
    }
    let scrolled = ui.input(|input| input.smooth_scroll_delta.y);
    let zooming = response.hovered() && scrolled != 0.0;
    if zooming {
        app.orbit.wheel(f64::from(scrolled / POINTS_PER_NOTCH));
    }
    draw(app, ui, rect);
    let moving = zooming || ui.input(|input| input.pointer.any_down()) && !holds_divider && !app.is_still;
    app.order(ui, rect, moving);
    app.problem(ui, rect);
}

/// Draws the pictures, the divider between them, and the names of their makers.
fn draw(app: &mut App, ui: &Ui, rect: Rect) {
    let painter = ui.painter();
    let names = app.names();
    let is_compared = app.comparison.against.is_some() && !app.canvas.sides[1].is_empty();
    if is_compared && app.comparison.difference {
        let gain = app.comparison.gain;
        if let Some(texture) = app.canvas.difference(ui.ctx(), gain) {
            paint(painter, texture, rect, rect);
            label(ui, rect, Align2::CENTER_TOP, &format!("|{} − {}| × {gain:.0}", names[0], names[1]));
            return;
        }
    }
    let [first, second] = &app.canvas.sides;
    let divider = if is_compared { rect.left() + app.comparison.divider * rect.width() } else { rect.right() };
    if let Some(texture) = &first.texture {
        paint(painter, texture, rect, rect.with_max_x(divider));
    }
    if !is_compared {
        return;
    }
    if let Some(texture) = &second.texture {
        paint(painter, texture, rect, rect.with_min_x(divider));
    }
    painter.vline(divider, rect.y_range(), Stroke::new(3.0, Color32::from_black_alpha(110)));
    painter.vline(divider, rect.y_range(), Stroke::new(1.0, Color32::from_white_alpha(220)));
    label(ui, rect.with_max_x(divider), Align2::RIGHT_TOP, &names[0]);
    label(ui, rect.with_min_x(divider), Align2::LEFT_TOP, &names[1]);
}

/// Paints the part of a picture inside `clip`; the whole picture would fill `rect`.
fn paint(painter: &Painter, texture: &TextureHandle, rect: Rect, clip: Rect) {
    let all = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    painter.with_clip_rect(clip).image(texture.id(), rect, all, Color32::WHITE);
}

/// A line of text at the upper edge of a part of the picture; none where it does not fit.
fn label(ui: &Ui, rect: Rect, anchor: Align2, text: &str) {
    let galley = ui.painter().layout_no_wrap(text.to_owned(), FontId::proportional(12.0), Color32::WHITE);
    let margin = vec2(6.0, 3.0);
    let size = galley.size() + 2.0 * margin;
    let frame = anchor.align_size_within_rect(size, rect.shrink2(vec2(8.0, 8.0)));
    if !rect.contains_rect(frame) {
        return;
    }
    ui.painter().rect_filled(frame, 4.0, Color32::from_black_alpha(150));
    ui.painter().galley(frame.min + margin, galley, Color32::WHITE);
}
