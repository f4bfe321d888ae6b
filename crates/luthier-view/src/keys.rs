//! Actions of keys.

use eframe::egui::{Context, Key};

/// An action of a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Action {
    Next,
    Previous,
    Form,
    Model,
    Shape,
    Background,
    ResetCamera,
    ResetEdits,
    Theme,
    Screenshot,
    Help,
    Quit,
}

/// Key, its name, what it does in words.
pub(crate) const KEYS: [(Key, &str, Action, &str); 12] = [
    (Key::N, "N", Action::Next, "next material"),
    (Key::P, "P", Action::Previous, "previous material"),
    (Key::M, "M", Action::Model, "next model"),
    (Key::F, "F", Action::Form, "baked or full form"),
    (Key::G, "G", Action::Shape, "next shape"),
    (Key::B, "B", Action::Background, "surroundings behind"),
    (Key::C, "C", Action::ResetCamera, "camera as it was"),
    (Key::R, "R", Action::ResetEdits, "material as in its file"),
    (Key::T, "T", Action::Theme, "light or dark"),
    (Key::S, "S", Action::Screenshot, "save a screenshot"),
    (Key::H, "H", Action::Help, "this help"),
    (Key::Q, "Q", Action::Quit, "quit"),
];

/// Gestures of the mouse, and their effects.
pub(crate) const MOUSE: [(&str, &str); 3] =
    [("drag", "turn the shape"), ("right drag", "turn the light"), ("wheel", "zoom")];

/// The actions that were asked for since the last frame; none while a number is being typed.
pub(crate) fn actions(context: &Context) -> Vec<Action> {
    if context.text_edit_focused() {
        return Vec::new();
    }
    context.input(|input| {
        let plain = !input.modifiers.any();
        KEYS.iter().filter(|(key, ..)| plain && input.key_pressed(*key)).map(|(_, _, action, _)| *action).collect()
    })
}
