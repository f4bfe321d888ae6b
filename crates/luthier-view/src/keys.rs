//! Actions of keys.

use eframe::egui::{Context, Event, Key, Modifiers};

/// An action of a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Action {
    Next,
    Previous,
    Form,
    Model,
    Shape,
    Compare,
    Difference,
    DividerLeft,
    DividerRight,
    Background,
    ResetCamera,
    ResetEdits,
    Undo,
    Redo,
    Copy,
    Theme,
    Screenshot,
    Help,
    Quit,
}

const PLAIN: Modifiers = Modifiers::NONE;
const COMMAND: Modifiers = Modifiers::COMMAND;
const COMMAND_SHIFT: Modifiers = Modifiers { shift: true, ..Modifiers::COMMAND };

/// Modifiers and key, their name, what they do in words.
pub(crate) const KEYS: [(Modifiers, Key, &str, Action, &str); 20] = [
    (PLAIN, Key::N, "N", Action::Next, "next material"),
    (PLAIN, Key::P, "P", Action::Previous, "previous material"),
    (PLAIN, Key::M, "M", Action::Model, "next model"),
    (PLAIN, Key::F, "F", Action::Form, "baked or full form"),
    (PLAIN, Key::G, "G", Action::Shape, "next shape"),
    (PLAIN, Key::V, "V", Action::Compare, "comparison on or off"),
    (PLAIN, Key::D, "D", Action::Difference, "difference or divider"),
    (PLAIN, Key::Comma, ",", Action::DividerLeft, "divider to the left"),
    (PLAIN, Key::Period, ".", Action::DividerRight, "divider to the right"),
    (PLAIN, Key::B, "B", Action::Background, "surroundings behind"),
    (PLAIN, Key::C, "C", Action::ResetCamera, "camera as it was"),
    (PLAIN, Key::R, "R", Action::ResetEdits, "material as in its file"),
    (COMMAND, Key::Z, "Ctrl+Z", Action::Undo, "undo"),
    (COMMAND_SHIFT, Key::Z, "Ctrl+Shift+Z", Action::Redo, "redo; Ctrl+Y, too"),
    (COMMAND, Key::Y, "Ctrl+Y", Action::Redo, ""),
    (COMMAND_SHIFT, Key::C, "Ctrl+Shift+C", Action::Copy, "copy as TOML"),
    (PLAIN, Key::T, "T", Action::Theme, "light or dark"),
    (PLAIN, Key::S, "S", Action::Screenshot, "save a screenshot"),
    (PLAIN, Key::H, "H", Action::Help, "this help"),
    (PLAIN, Key::Q, "Q", Action::Quit, "quit"),
];

/// Gestures of the mouse, and their effects.
pub(crate) const MOUSE: [(&str, &str); 4] =
    [("drag", "turn the shape"), ("right drag", "turn the light"), ("drag the divider", "move it"), ("wheel", "zoom")];

/// The actions of keys that were pressed since the last frame; none while a number is being typed.
pub(crate) fn actions(context: &Context) -> Vec<Action> {
    if context.text_edit_focused() {
        return Vec::new();
    }
    context.input(|input| input.events.iter().filter_map(of_event).collect())
}

fn of_event(event: &Event) -> Option<Action> {
    match event {
        // Modifiers as they were when the key was pressed.
        Event::Key { key, pressed: true, modifiers, .. } => KEYS
            .iter()
            .find(|(with, of, ..)| of == key && modifiers.matches_exact(*with))
            .map(|(.., action, _)| *action),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::RawInput;

    use super::*;

    fn pressed(key: Key, modifiers: Modifiers) -> Vec<Action> {
        let context = Context::default();
        let event = Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers };
        let input = RawInput { events: vec![event], ..RawInput::default() };
        let mut found = Vec::new();
        context.run_ui(input, |ui| found = actions(ui.ctx())).textures_delta.clear();
        found
    }

    #[test]
    fn modifiers_tell_actions_apart() {
        let ctrl = Modifiers { ctrl: true, command: true, ..Modifiers::NONE };
        let both = Modifiers { shift: true, ..ctrl };
        assert_eq!(pressed(Key::Z, ctrl), [Action::Undo]);
        assert_eq!(pressed(Key::Z, both), [Action::Redo]);
        assert_eq!(pressed(Key::Y, ctrl), [Action::Redo]);
        assert_eq!(pressed(Key::C, both), [Action::Copy]);
        assert_eq!(pressed(Key::C, Modifiers::NONE), [Action::ResetCamera]);
        assert!(pressed(Key::Z, Modifiers::NONE).is_empty() && pressed(Key::N, ctrl).is_empty());
    }

    #[test]
    fn no_key_has_two_actions() {
        for (i, (modifiers, key, name, ..)) in KEYS.iter().enumerate() {
            let again = KEYS[i + 1..].iter().any(|(other, same, ..)| (other, same) == (modifiers, key));
            assert!(!again, "{name}");
        }
    }
}
