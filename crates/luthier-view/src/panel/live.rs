//! Sliders of live numbers, which change pictures without a bake.

use eframe::egui::{Slider, SliderClamping, Ui};
use luthier_gpu::LiveValue;
use luthier_manifest::{LiveEntry, LiveRange, MapSlot};

use super::section;
use crate::app::App;

/// End of the slider of a factor that nothing bounds.
const FACTOR_MOST: f64 = 4.0;

/// The sliders, if the material has live numbers.
pub(crate) fn show(app: &mut App, ui: &mut Ui) {
    let Some(label) = app.files.selected().map(|entry| entry.label.clone()) else { return };
    let Some((_, ready, _)) = &app.ready else { return };
    let Some(entry) = ready.package.manifest.materials.first().filter(|entry| !entry.live.is_empty()) else { return };
    let (name, all) = (entry.name.clone(), entry.live.clone());
    let mut values = app.live_values();
    section(ui, ("live", &name), "live · without a bake", |ui| {
        for live in &all {
            let mut shown = shown(live, &values);
            let ends = shown.clone();
            for (number, label) in shown.iter_mut().zip(labels(live)) {
                ui.label(label);
                let range = range(live);
                let slider = Slider::new(number, range).max_decimals(3).clamping(SliderClamping::Edits);
                ui.add(slider).on_hover_text(hint(live));
                ui.end_row();
            }
            if shown != ends {
                set(live, &shown, &mut values);
            }
        }
    });
    if !values.is_empty() && ui.small_button("as in the file").clicked() {
        values.clear();
    }
    app.live.insert(label, values);
}

/// Numbers of the sliders of a live number, with the values that it has.
fn shown(live: &LiveEntry, values: &[LiveValue]) -> Vec<f64> {
    let own = values.iter().find(|value| (value.slot, value.layer) == (live.slot, live.layer));
    let value: Vec<f64> = match own {
        Some(own) => own.value.iter().take(live.default.len()).map(|value| f64::from(*value)).collect(),
        None => live.default.clone(),
    };
    match (live.slot, value.as_slice()) {
        (MapSlot::Tangent, [x, y, ..]) => vec![libm::atan2(*y, *x).to_degrees()],
        (MapSlot::Normal | MapSlot::Bumps, [x, y, z]) => [x, y].map(|across| across / z).to_vec(),
        _ => value,
    }
}

/// Takes the numbers of the sliders.
fn set(live: &LiveEntry, shown: &[f64], values: &mut Vec<LiveValue>) {
    let vector = match (live.slot, shown) {
        (MapSlot::Tangent, [degrees]) => {
            let (sin, cos) = libm::sincos(degrees.to_radians());
            [cos, sin, 0.0]
        }
        (MapSlot::Normal | MapSlot::Bumps, [x, y]) => {
            let z = 1.0 / (1.0 + x * x + y * y).sqrt();
            [x * z, y * z, z]
        }
        _ => [0, 1, 2].map(|c: usize| live.held(shown.get(c).copied().unwrap_or(0.0))),
    };
    values.retain(|value| (value.slot, value.layer) != (live.slot, live.layer));
    values.push(LiveValue { material: 0, slot: live.slot, layer: live.layer, value: vector.map(|v| v as f32) });
}

fn range(live: &LiveEntry) -> std::ops::RangeInclusive<f64> {
    match (live.slot, live.range) {
        (MapSlot::Tangent, _) => -90.0..=90.0,
        (_, Some(LiveRange { least, most })) => least..=most.unwrap_or(FACTOR_MOST),
        (_, None) => -0.3..=0.3,
    }
}

/// Names of the sliders.
fn labels(live: &LiveEntry) -> Vec<String> {
    let (layer, name) = (live.layer + 1, live.slot.name());
    let factor = if live.number.is_empty() { "" } else { " ×" };
    let parts: &[&str] = match (live.slot, live.default.len()) {
        (MapSlot::Tangent, _) => &[" °"],
        (MapSlot::Normal | MapSlot::Bumps, _) => &[" along u", " along v"],
        (_, 3) => &[" r", " g", " b"],
        _ => &[""],
    };
    parts.iter().map(|part| format!("{layer} · {name}{part}{factor}")).collect()
}

/// Number that a slider multiplies, and where a program writes its value.
fn hint(live: &LiveEntry) -> String {
    let number: Vec<String> = live.number.iter().map(|number| format!("{number:.4}")).collect();
    match number.is_empty() {
        true => live.member.clone(),
        false => format!("{}, a factor on {}", live.member, number.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sliders make again of a value what they show.
    #[test]
    fn sliders_have_the_values() {
        for (slot, default, range) in [
            (MapSlot::Absorption, vec![1.0; 3], Some(LiveRange { least: 0.0, most: None })),
            (MapSlot::Alpha, vec![1.0], Some(LiveRange { least: 0.25, most: Some(2.0) })),
            (MapSlot::Tangent, vec![1.0, 0.0], None),
            (MapSlot::Bumps, vec![0.0, 0.0, 1.0], None),
        ] {
            let member = String::new();
            let live = LiveEntry { slot, layer: 1, member, default: default.clone(), range, number: Vec::new() };
            let mut values = Vec::new();
            let moved: Vec<f64> = shown(&live, &values).iter().map(|number| number + 0.25).collect();
            assert_eq!(moved.len(), labels(&live).len());
            set(&live, &moved, &mut values);
            let again = shown(&live, &values);
            assert!(again.iter().zip(&moved).all(|(a, b)| (a - b).abs() < 1e-5), "{again:?} {moved:?}");
            set(&live, &moved, &mut values);
            assert_eq!(values.len(), 1);
        }
        let alpha = LiveEntry {
            slot: MapSlot::Alpha,
            layer: 0,
            member: String::new(),
            default: vec![1.0],
            range: Some(LiveRange { least: 0.25, most: Some(2.0) }),
            number: vec![0.2],
        };
        let mut values = Vec::new();
        set(&alpha, &[7.0], &mut values);
        assert_eq!(values[0].value[0], 2.0);
    }
}
