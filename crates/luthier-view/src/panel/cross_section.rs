//! Cross-section through the material: a sketch, with the numbers of each part beside it.

use eframe::egui::text::{LayoutJob, TextFormat};
use eframe::egui::{
    Color32, FontId, Galley, Mesh, Painter, Rect, RichText, Sense, Shape, Stroke, Ui, ecolor, pos2, vec2,
};
use luthier_material::{CrossSection, Part, PartKind};
use std::sync::Arc;

/// Width of the sketch in points, which is the unit of all heights.
const WIDTH: f32 = 112.0;

/// Distance of the numbers from the sketch, and of a part's numbers from the next ones.
const GAP: f32 = 10.0;

/// Size of letters.
const LETTERS: f32 = 11.5;

/// Sketch and numbers.
pub(super) fn show(ui: &mut Ui, section: &CrossSection) {
    let room = (ui.available_width() - WIDTH - GAP).max(60.0);
    let texts: Vec<Arc<Galley>> = section.parts.iter().map(|part| text(ui, part, room)).collect();
    let heights: Vec<f32> = section
        .parts
        .iter()
        .zip(&texts)
        .map(|(part, text)| (WIDTH * part.height as f32).max(text.size().y + 4.0))
        .collect();
    let size = vec2(WIDTH + GAP + room, heights.iter().sum());
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let sketch = rect.with_max_x(rect.left() + WIDTH);
    let painter = ui.painter().with_clip_rect(ui.clip_rect().intersect(sketch));
    let dark = ui.visuals().dark_mode;
    let mut top = rect.top();
    for ((part, height), galley) in section.parts.iter().zip(&heights).zip(texts) {
        // Each part reaches down to the end, and the next one covers what is not its own.
        fill(&painter, sketch, part, top, paint(part, dark));
        let color = ui.visuals().text_color();
        ui.painter().galley(pos2(sketch.right() + GAP, top + 2.0), galley, color);
        top += height;
    }
    let mut top = rect.top();
    for (part, height) in section.parts.iter().zip(&heights) {
        if part.kind != PartKind::Exterior {
            let line = outline(sketch, part, top).collect();
            let color = if dark { Color32::from_white_alpha(150) } else { Color32::from_black_alpha(150) };
            painter.add(Shape::line(line, Stroke::new(1.0, color)));
        }
        top += height;
    }
    for effect in &section.effects {
        ui.label(RichText::new(effect).size(LETTERS));
    }
}

/// Name and numbers of a part.
fn text(ui: &Ui, part: &Part, room: f32) -> Arc<Galley> {
    let visuals = ui.visuals();
    let [strong, weak, plain] = [visuals.strong_text_color(), visuals.weak_text_color(), visuals.text_color()]
        .map(|color| TextFormat { font_id: FontId::proportional(LETTERS), color, ..TextFormat::default() });
    let mut job = LayoutJob::default();
    job.wrap.max_width = room;
    let name = match part.layer.filter(|_| part.kind != PartKind::Film) {
        Some(number) => format!("{} · {}", number + 1, part.label),
        None => part.label.clone(),
    };
    job.append(&name, 0.0, strong);
    for number in &part.numbers {
        job.append(&format!("\n{} ", number.name), 0.0, weak.clone());
        job.append(&number.value, 0.0, plain.clone());
    }
    ui.painter().layout_job(job)
}

/// Colour of a part. Light that a slab passes is seen on paper, which is darker in the dark theme.
fn paint(part: &Part, dark: bool) -> Color32 {
    let paper = if dark { 0.35 } else { 0.9 };
    let linear = match part.kind {
        PartKind::Exterior => return Color32::TRANSPARENT,
        PartKind::Slab => part.color.map(|c| paper * c as f32),
        PartKind::Film | PartKind::HalfSpace | PartKind::Conductor | PartKind::Diffuse => part.color.map(|c| c as f32),
    };
    let [r, g, b] = linear.map(ecolor::gamma_u8_from_linear_f32);
    Color32::from_rgb(r, g, b)
}

/// The upper boundary of a part, from left to right.
fn outline(sketch: Rect, part: &Part, top: f32) -> impl Iterator<Item = eframe::egui::Pos2> {
    part.outline.iter().map(move |[x, y]: &[f64; 2]| pos2(sketch.left() + WIDTH * *x as f32, top - WIDTH * *y as f32))
}

/// Fills all below the upper boundary of a part.
fn fill(painter: &Painter, sketch: Rect, part: &Part, top: f32, color: Color32) {
    let mut mesh = Mesh::default();
    for (i, point) in outline(sketch, part, top).enumerate() {
        mesh.colored_vertex(point, color);
        mesh.colored_vertex(pos2(point.x, sketch.bottom()), color);
        if let Some(last) = (2 * i as u32).checked_sub(2) {
            mesh.add_triangle(last, last + 1, last + 2);
            mesh.add_triangle(last + 1, last + 2, last + 3);
        }
    }
    painter.add(Shape::mesh(mesh));
}
