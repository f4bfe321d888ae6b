//! Slope distributions by their names in a manifest.

use luthier_optics::stack::Distribution;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serializer};

pub(crate) fn serialize<S: Serializer>(distribution: &Distribution, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(distribution.name())
}

pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Distribution, D::Error> {
    let name = String::deserialize(deserializer)?;
    Distribution::from_name(&name)
        .ok_or_else(|| D::Error::custom(format!("unknown slope distribution `{name}`; known: beckmann, ggx")))
}
