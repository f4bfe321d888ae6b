//! The tiles of a layer: a number, or none, for each kind of table.

use std::fmt;
use std::ops::{Index, IndexMut};

use luthier_lut::TableKind;
use serde::de::{IgnoredAny, MapAccess, Visitor};
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Numbers of the tiles that serve a layer, by the kind of table. Files have each as `NAME_tile`, null for a missing tile; missing tiles of a
/// whole material are left out.
///
/// ```
/// use luthier_lut::TableKind;
/// use luthier_manifest::Tiles;
///
/// let tiles = Tiles::of([(TableKind::Fresnel, 3)]);
/// assert_eq!((tiles[TableKind::Fresnel], tiles[TableKind::Fgd]), (Some(3), None));
/// let json = serde_json::to_value(tiles).unwrap();
/// assert!(json["fgd_tile"].is_null() && json.get("lobes_tile").is_none());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Tiles([Option<u32>; TableKind::ALL.len()]);

impl Tiles {
    /// These tiles, and none of other kinds.
    pub fn of<const N: usize>(tiles: [(TableKind, u32); N]) -> Self {
        let mut out = Self::default();
        tiles.into_iter().for_each(|(kind, tile)| out[kind] = Some(tile));
        out
    }

    /// The tiles with those of some kinds replaced.
    #[must_use]
    pub fn with<const N: usize>(self, tiles: [(TableKind, Option<u32>); N]) -> Self {
        tiles.into_iter().fold(self, |mut out, (kind, tile)| {
            out[kind] = tile;
            out
        })
    }
}

impl Index<TableKind> for Tiles {
    type Output = Option<u32>;

    fn index(&self, kind: TableKind) -> &Option<u32> {
        &self.0[kind as usize]
    }
}

impl IndexMut<TableKind> for Tiles {
    fn index_mut(&mut self, kind: TableKind) -> &mut Option<u32> {
        &mut self.0[kind as usize]
    }
}

impl Serialize for Tiles {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let written = TableKind::ALL.into_iter().filter(|&kind| kind.facts().slot.is_some() || self[kind].is_some());
        let mut map = serializer.serialize_map(Some(written.clone().count()))?;
        for kind in written {
            map.serialize_entry(&format!("{}_tile", kind.name()), &self[kind])?;
        }
        map.end()
    }
}

impl<'de> Deserialize<'de> for Tiles {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Fields;

        impl<'de> Visitor<'de> for Fields {
            type Value = Tiles;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("numbers of tiles")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Tiles, A::Error> {
                let mut tiles = Tiles::default();
                while let Some(key) = map.next_key::<String>()? {
                    match key.strip_suffix("_tile").and_then(TableKind::from_name) {
                        Some(kind) => tiles[kind] = map.next_value()?,
                        None => drop(map.next_value::<IgnoredAny>()?),
                    }
                }
                Ok(tiles)
            }
        }

        deserializer.deserialize_map(Fields)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_are_fields_by_the_names_of_their_kinds() {
        let tiles = Tiles::of([(TableKind::Fgd, 3), (TableKind::Escape, 0)]);
        let text = serde_json::to_string(&tiles).unwrap();
        assert!(text.starts_with(r#"{"fresnel_tile":null,"distribution_tile":null,"fgd_tile":3,"#), "{text}");
        assert_eq!(serde_json::from_str::<Tiles>(&text).unwrap(), tiles);
        assert!(!text.contains("lobes"), "{text}");
        let lobes = Tiles::of([(TableKind::Lobes, 2)]);
        let text = serde_json::to_string(&lobes).unwrap();
        assert!(text.ends_with(r#""escape_tile":null,"lobes_tile":2}"#), "{text}");
        assert_eq!(serde_json::from_str::<Tiles>(&text).unwrap(), lobes);
        // Files of older versions have fewer, those of newer ones more.
        let few = serde_json::from_str::<Tiles>(r#"{"fgd_tile":3,"escape_tile":0,"later_tile":1,"kind":"x"}"#).unwrap();
        assert_eq!(few, tiles);
    }
}
