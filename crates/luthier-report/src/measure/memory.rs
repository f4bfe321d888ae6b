//! Results of earlier judgements, keyed by content: texels, records and stacks. Names and numbers in a bake do not count.

use std::fmt::{Debug, Write as _};

use luthier_layers::models::lobes::{Lobes, Varied};
use luthier_layers::twins::terms::Exact;
use luthier_lut::TableKind;
use luthier_manifest::{MaterialEntry, Tiles};
use luthier_optics::interface::Interface;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use crate::measure::device::Device;
use crate::measure::readers::{bare_users, tiles, users};
use crate::measure::references::References;
use crate::measure::subject::{FilmMap, FilmSource, Subject};

/// Store of results of earlier judgements. It may forget at any time.
pub trait Memory: Sync {
    /// The result of a kind for these inputs.
    fn recall(&self, kind: &'static str, inputs: &Value) -> Option<String>;

    /// Keeps a result.
    fn keep(&self, kind: &'static str, inputs: &Value, result: String);
}

/// Key of the device's values of each material: shaders, record, stack, and texels of the tiles that the material reads.
pub fn contents(subject: &Subject<'_>, device: &dyn Device) -> Vec<Value> {
    let hashed = Remembered { memory: None, tiles: hashes(subject) };
    let materials = 0..subject.manifest.materials.len();
    materials.map(|number| hashed.inputs(subject, number, Some(device), None)).collect()
}

/// Hashes of all tiles.
fn hashes(subject: &Subject<'_>) -> Vec<(TableKind, Vec<String>)> {
    let tables = subject.manifest.tables.iter().filter_map(|table| {
        let table = subject.table(table.kind).ok().flatten()?;
        let (layout, texels) = (&table.entry.layout, table.texels);
        let axes =
            json!([layout.x, layout.y, layout.apron, layout.base, table.entry.format, texels.channels]).to_string();
        let tiles = (0..layout.tiles).map(|tile| {
            let ([x, y], [width, height]) = (layout.origin(tile), layout.tile_size());
            let mut hash = Sha256::new_with_prefix(&axes);
            for (row, column) in (y..y + height).flat_map(|row| (x..x + width).map(move |column| (row, column))) {
                texels.texel(column, row).iter().for_each(|value| hash.update(value.to_bits().to_le_bytes()));
            }
            hex(&hash.finalize())
        });
        Some((table.entry.kind, tiles.collect()))
    });
    tables.collect()
}

/// The memory of a judgement, with the hashes of all tiles.
pub(crate) struct Remembered<'a> {
    memory: Option<&'a dyn Memory>,
    tiles: Vec<(TableKind, Vec<String>)>,
}

impl<'a> Remembered<'a> {
    /// Hashes the tiles, if there is a memory. The tables of the subject must have been checked.
    pub(crate) fn new(memory: Option<&'a dyn Memory>, subject: &Subject<'_>) -> Self {
        Self { memory, tiles: memory.map(|_| hashes(subject)).unwrap_or_default() }
    }

    /// The value of a kind for these inputs.
    pub(crate) fn recall<T: DeserializeOwned>(&self, kind: &'static str, inputs: &Value) -> Option<T> {
        serde_json::from_str(&self.memory?.recall(kind, inputs)?).ok()
    }

    /// Keeps a value. A value without JSON, such as an infinite number, is not kept and judged again.
    pub(crate) fn keep<T: Serialize>(&self, kind: &'static str, inputs: &Value, value: &T) {
        if let (Some(memory), Ok(text)) = (self.memory, serde_json::to_string(value)) {
            memory.keep(kind, inputs, text);
        }
    }

    /// Gives exact terms their lobes, if the model has any. Lobes that were fitted to the stack before are recalled, others are fitted now.
    pub(crate) fn fit(&self, references: &References, entry: &MaterialEntry) {
        if self.memory.is_none() || !entry.shows_lobes() {
            return;
        }
        self.fit_terms(references.baked());
    }

    fn fit_terms(&self, terms: &Exact) {
        let (stack, color, varying) = terms.fitted();
        let inputs = json!({ "stack": stack, "color": format!("{color:?}"), "varying": format!("{varying:?}") });
        terms.take_lobes(&|| {
            self.recall("judge-fits", &inputs).unwrap_or_else(|| {
                let ends: (Lobes, Option<Lobes>) = Varied::of(stack, color, *varying).ends();
                self.keep("judge-fits", &inputs, &ends);
                ends
            })
        });
        if let Some(side) = terms.side().filter(|side| Interface::of(side.fitted().0, 0).is_some()) {
            self.fit_terms(side);
        }
    }

    /// Key of the comparisons of a material. The record contains its maps, by their hashes.
    pub(crate) fn material(
        &self,
        subject: &Subject<'_>,
        number: usize,
        device: Option<&dyn Device>,
        pairs_per_set: u32,
        simulated: &dyn Debug,
    ) -> Value {
        if self.memory.is_none() {
            return Value::Null;
        }
        self.inputs(subject, number, device, Some((pairs_per_set, simulated)))
    }

    fn inputs(
        &self,
        subject: &Subject<'_>,
        number: usize,
        device: Option<&dyn Device>,
        settings: Option<(u32, &dyn Debug)>,
    ) -> Value {
        let entry = &subject.manifest.materials[number];
        // The place of tiles changes the last digits of a device's values, and nothing else.
        let on_device = device.map(|device| {
            let layouts: Vec<_> = subject.manifest.tables.iter().map(|table| &table.layout).collect();
            json!([device.identity(), layouts, entry.layers])
        });
        json!({
            "subject": self.content(subject, number),
            "pairs": settings.map(|(pairs_per_set, _)| pairs_per_set),
            "simulated": settings.map(|(_, simulated)| format!("{simulated:?}")),
            "device": on_device,
        })
    }

    /// Key of the scan of a tile: its texels, and the layers that read it.
    pub(crate) fn tile(&self, subject: &Subject<'_>, kind: TableKind, tile: u32, pairs_per_set: u32) -> Value {
        if self.memory.is_none() {
            return Value::Null;
        }
        let users = users(subject, kind, tile).into_iter();
        let films = subject.films.iter().filter(|_| kind == TableKind::Thickness).map(film);
        let films: Vec<Value> = films.collect();
        let users = users.map(|(number, layer)| {
            json!([nameless(&subject.manifest.materials[number]), subject.stacks[number], layer])
        });
        let bare = bare_users(subject, kind, tile).into_iter();
        let bare =
            bare.map(|number| json!([nameless(&subject.manifest.materials[number]), subject.stacks[number], "bare"]));
        let users: Vec<Value> = users.chain(bare).collect();
        json!({ "kind": kind.name(), "tile": self.hash(kind, tile), "users": users, "films": films, "pairs": pairs_per_set })
    }

    /// A material by its content: its record, its stack, and the texels of the tiles that it reads.
    fn content(&self, subject: &Subject<'_>, number: usize) -> Value {
        let entry = &subject.manifest.materials[number];
        let side = entry.side();
        let of_side = side.iter().flat_map(|side| side.layers.first().map(|record| (side, record)));
        let hashes = entry.layers.iter().map(|record| (entry, record)).chain(of_side).map(|(entry, record)| {
            TableKind::ALL.map(|kind| {
                let first = record.tiles[kind]?;
                let count = tiles(entry, kind);
                Some((first..first + count).map(|tile| self.hash(kind, tile)).collect::<Vec<_>>())
            })
        });
        json!({
            "name": entry.name,
            "entry": nameless(entry),
            "stack": subject.stacks[number],
            "tiles": hashes.collect::<Vec<_>>(),
        })
    }

    fn hash(&self, kind: TableKind, tile: u32) -> &str {
        let tiles = self.tiles.iter().find(|(known, _)| *known == kind).map_or(&[][..], |(_, tiles)| tiles);
        tiles.get(tile as usize).map_or("", String::as_str)
    }
}

/// A film's map by its content.
fn film(map: &FilmMap) -> Value {
    let source = match &map.source {
        FilmSource::Noise { seed, frequency, octaves } => json!([seed, frequency, octaves]),
        FilmSource::Image(image) => {
            let mut hash = Sha256::new();
            image.data.iter().for_each(|value| hash.update(value.to_bits().to_le_bytes()));
            json!([image.width, image.height, hex(&hash.finalize())])
        }
    };
    json!([map.material, map.layer, map.extent_um, source])
}

/// A record without its names and the numbers of its tiles.
fn nameless(entry: &MaterialEntry) -> MaterialEntry {
    let mut entry = entry.clone();
    for text in [&mut entry.name, &mut entry.source, &mut entry.source_hash] {
        text.clear();
    }
    let MaterialEntry { layers, constants, .. } = &mut entry;
    layers.iter_mut().chain(constants.bare_mut()).for_each(|record| record.tiles = Tiles::default());
    entry
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
