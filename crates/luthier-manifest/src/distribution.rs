//! Slope distributions in a manifest: a name, or an object of a name and parameters.

use luthier_optics::ndf::Shape;
use luthier_optics::stack::Distribution;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A distribution as a manifest has it.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Named {
    /// A distribution whose only parameter is the slope parameter of its layer.
    Plain(String),
    /// A distribution with parameters of its own.
    Shaped(Shaped),
}

/// Parameters as material files have them.
#[derive(Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
enum Shaped {
    Abc { b: f64, c: f64 },
    Sgd { alpha: f64, p: f64 },
}

pub(crate) fn serialize<S: Serializer>(distribution: &Distribution, serializer: S) -> Result<S::Ok, S::Error> {
    let named = match distribution {
        Distribution::Abc(shape) => {
            let [b, c] = shape.parameters();
            Named::Shaped(Shaped::Abc { b, c })
        }
        Distribution::Sgd(shape) => {
            let [alpha, p] = shape.parameters();
            Named::Shaped(Shaped::Sgd { alpha, p })
        }
        plain => Named::Plain(plain.name().to_owned()),
    };
    named.serialize(serializer)
}

pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Distribution, D::Error> {
    let shaped = match Named::deserialize(deserializer)? {
        Named::Plain(name) => return Distribution::from_name(&name).ok_or_else(|| {
            D::Error::custom(format!("unknown slope distribution `{name}`; known: beckmann, ggx, blinn, and abc and sgd with their parameters"))
        }),
        Named::Shaped(Shaped::Abc { b, c }) => Shape::abc(b, c).map(Distribution::Abc),
        Named::Shaped(Shaped::Sgd { alpha, p }) => Shape::sgd(alpha, p).map(Distribution::Sgd),
    };
    shaped.map_err(|error| D::Error::custom(format!("slope distribution: {error}")))
}
