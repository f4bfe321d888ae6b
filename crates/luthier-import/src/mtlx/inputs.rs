//! Inputs of a shader, and what became of each.

use std::sync::Arc;

use super::document::Element;
use super::expression::Expression;
use super::graph::{Graph, Scope};
use super::value::Value;
use crate::{Fate, Line};

/// Fate of an input where nothing else is said, and how it came about.
pub(super) type Note = (&'static str, Fate, &'static str);

/// Inputs of a shader.
pub(super) struct Inputs<'g> {
    graph: &'g mut Graph,
    shader: Arc<Element>,
    scope: Arc<Scope>,
    pub(super) lines: Vec<Line>,
    read: Vec<&'static str>,
    /// Inputs whose value is the default, which changes nothing.
    inert: Vec<&'static str>,
}

impl<'g> Inputs<'g> {
    pub(super) fn new(graph: &'g mut Graph, shader: &Arc<Element>, scope: &Arc<Scope>) -> Self {
        Self {
            graph,
            shader: Arc::clone(shader),
            scope: Arc::clone(scope),
            lines: Vec::new(),
            read: Vec::new(),
            inert: Vec::new(),
        }
    }

    fn say(&mut self, property: &str, fate: Fate, note: impl Into<String>) {
        self.lines.push(Line::new(property, fate, note));
    }

    /// Whether the shader has an input with a value.
    pub(super) fn has(&self, name: &str) -> bool {
        self.shader.input(name).is_some_and(|input| is_given(input))
    }

    fn value(&mut self, name: &'static str, absent: Value) -> Arc<Expression> {
        self.read.push(name);
        let constant = || Arc::new(Expression::Constant(absent));
        let Some(input) = self.shader.input(name).filter(|input| is_given(input)).cloned() else { return constant() };
        let found = self.graph.value(&input, &self.scope);
        for note in std::mem::take(&mut self.graph.notes) {
            self.say(name, Fate::Approximated, note);
        }
        match found {
            Ok(found) => {
                if found.constant().is_some_and(|value| value.three() == absent.three()) {
                    self.inert.push(name);
                }
                found
            }
            Err(reason) => {
                let value = absent.all().iter().map(|v| crate::draft::number(*v)).collect::<Vec<_>>().join(", ");
                self.say(name, Fate::Dropped, format!("{reason}: the default is taken, {value}"));
                constant()
            }
        }
    }

    /// A number that may vary.
    pub(super) fn number(&mut self, name: &'static str, absent: f64) -> Arc<Expression> {
        self.value(name, Value::number(absent))
    }

    /// A colour that may vary.
    pub(super) fn color(&mut self, name: &'static str, absent: [f64; 3]) -> Arc<Expression> {
        self.value(name, Value::rgb(absent))
    }

    /// Normals, where they are given.
    pub(super) fn normal(&mut self, name: &'static str) -> Option<Arc<Expression>> {
        let flat = [0.0, 0.0, 1.0];
        let found = self.has(name).then(|| self.value(name, Value::rgb(flat)))?;
        match found.constant() {
            Some(value) if value.three() != flat => {
                self.say(name, Fate::Dropped, "one direction for all places is not read");
                None
            }
            Some(_) => None,
            None => Some(found),
        }
    }

    /// An input that is not read, where it is given.
    pub(super) fn unread(&mut self, name: &'static str, note: &str) {
        if self.has(name) {
            self.say(name, Fate::Dropped, note);
        }
    }

    /// The version of the shader, where it is named.
    pub(super) fn version(&self) -> Option<&str> {
        self.shader.attribute("version")
    }

    /// A number that is the same everywhere. One that varies has its default.
    pub(super) fn fixed(&mut self, name: &'static str, absent: f64) -> f64 {
        let found = self.number(name, absent).constant();
        found.map_or_else(
            || {
                self.say(name, Fate::Dropped, "it varies here, where a file has one number: the default is taken");
                absent
            },
            Value::first,
        )
    }

    /// A share that a surface does not show, where there is any of it.
    pub(super) fn lost(&mut self, name: &'static str, note: &str) {
        let found = self.color(name, [0.0; 3]);
        if found.constant().is_none_or(|value| value.three().iter().any(|v| *v > 0.0)) {
            self.say(name, Fate::Dropped, note);
        }
    }

    /// A line for each input that has none yet. `details` belong to what was dropped, or is not there.
    pub(super) fn finish(mut self, notes: &[Note], details: &[&str]) -> Vec<Line> {
        let shader = Arc::clone(&self.shader);
        for input in shader.children.iter().filter(|child| child.category == "input") {
            let name = input.name();
            if self.lines.iter().any(|line| line.property == name) {
                continue;
            }
            if self.inert.contains(&name) {
                self.say(name, Fate::Kept, "");
            } else if let Some((_, fate, note)) = notes.iter().find(|(known, ..)| *known == name) {
                self.say(name, *fate, *note);
            } else if self.read.contains(&name) {
                self.say(name, Fate::Kept, "");
            } else if details.iter().any(|known| name.starts_with(known)) {
                self.say(name, Fate::Kept, "it says how something is that is dropped or not there");
            } else {
                self.say(name, Fate::Dropped, "the input is not read");
            }
        }
        self.lines
    }
}

/// Whether an input has a value or a connection.
pub(super) fn is_given(input: &Element) -> bool {
    let is_connected =
        ["nodename", "nodegraph", "interfacename", "output"].iter().any(|name| input.attribute(name).is_some());
    is_connected || input.attribute("value").is_some_and(|value| !value.trim().is_empty())
}
