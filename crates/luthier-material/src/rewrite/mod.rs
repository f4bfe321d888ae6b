//! Text of a material file with the numbers of an edited material. Comments, order and all that was not edited stay as they are.

use luthier_optics::Rgb;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Film, Layer, Slab, Surface};
use toml_edit::{Array, ArrayOfTables, DocumentMut, InlineTable, Item, Key, Table, TableLike, Value};

use crate::diagnostic::{Diagnostic, Severity};
use crate::effects::{Effects, FlakeSource};
use crate::material::Material;

/// Returns the text of `original`'s file with the numbers of `edited`, an edited copy: numbers of layers, films and effects. A surface that
/// was given as a roughness or a slope is given by its `alpha`, because no other key has all its values. A `metallic-roughness` layer whose
/// parts no longer fit becomes the dielectric and the diffuse base that it stands for.
///
/// Numbers that have no key of their own are not written: a caller that edits those parses the text and compares.
///
/// ```
/// let text = "schema = 1\nname = \"gilding\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.1 # matt\n";
/// let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
/// let original = luthier_material::parse("gilding.toml", text, &no_files).unwrap().material;
/// let mut edited = original.clone();
/// let surface = &mut edited.stack.layers[0].surface;
/// (surface.alpha_x, surface.alpha_y) = (0.2, 0.2);
/// let rewritten = luthier_material::rewritten(&original, &edited).unwrap();
/// assert_eq!(rewritten, text.replace("0.1 # matt", "0.2 # matt"));
/// ```
///
/// # Errors
/// A diagnostic about the key that has no place for a number.
pub fn rewritten(original: &Material, edited: &Material) -> Result<String, Diagnostic> {
    let mut document: DocumentMut = original.text.parse().map_err(|_| refused(original, "", "the file is not TOML"))?;
    let mut file = File { document: &mut document, original, edited };
    // From the bottom up: a layer that becomes two leaves the numbers of those above it alone.
    for number in (0..original.stack.layers.len()).rev() {
        file.layer(number).map_err(|(key, message)| refused(original, &format!("layer.{number}.{key}"), message))?;
    }
    if let Some(effects) = document.get_mut("effects").and_then(Item::as_table_like_mut) {
        write_effects(effects, original, edited);
    }
    Ok(document.to_string())
}

fn refused(original: &Material, key: &str, message: &str) -> Diagnostic {
    let hint = "leave this number as it is in the file, or change the layer there".to_owned();
    original.diagnostic(Severity::Error, key, message, Some(hint))
}

/// A key of a layer, and why it has no place for a number.
type Refusal = (&'static str, &'static str);

struct File<'a> {
    document: &'a mut DocumentMut,
    original: &'a Material,
    edited: &'a Material,
}

impl File<'_> {
    fn layer(&mut self, number: usize) -> Result<(), Refusal> {
        let (before, after) = (&self.original.stack.layers[number], &self.edited.stack.layers[number]);
        let is_moved = self.index_above_differs(number);
        if before == after && !is_moved {
            return Ok(());
        }
        if self.original.brightening().is_some() && is_brighter_or_coat(self.original, self.edited, number) {
            return Err((
                "darkening",
                "the base below this coat is brighter than its colour in the file, and follows from the coat",
            ));
        }
        let (place, is_second) = place_of(self.document, number).ok_or(("type", "this layer is not in the file"))?;
        // Films stand above the layer that they coat.
        for (i, (before, after)) in before.films.iter().zip(&after.films).enumerate() {
            if before != after {
                let of_film = place - self.original.stack.layers[number].films.len() + i;
                film(table_at(self.document, of_film).ok_or(("type", "this film is not in the file"))?, before, after);
            }
        }
        let table = table_at(self.document, place).ok_or(("type", "this layer is not in the file"))?;
        let is_mixed = is_two(table);
        if is_second {
            return self.below_mixed(number, place);
        }
        surface(table, before.surface, after.surface)?;
        if before.base == after.base && !(is_moved && has_implied_index(table, after)) {
            return Ok(());
        }
        if number == 1
            && self.original.is_bare_in_places()
            && matches!(&before.base, Base::Dielectric { ior, .. } if ior.of_engine().is_some())
        {
            return Err(("type", "the index of this layer follows from the medium above, which is not in all places"));
        }
        match (&before.base, &after.base) {
            (_, Base::Conductor { ior }) if is_mixed => {
                drop(table.insert("base_color", rgb(ior.f0().unwrap_or_default())))
            }
            _ if is_mixed => return self.split(number, place),
            (Base::Dielectric { ior: old, slab: before }, Base::Dielectric { ior, slab: after }) => {
                write_index(table, old, ior, true);
                write_slab(table, *before, *after);
            }
            (Base::Conductor { ior: old }, Base::Conductor { ior }) => write_index(table, old, ior, false),
            (Base::Diffuse(before), Base::Diffuse(after)) => {
                if before.albedo != after.albedo {
                    if table.contains_key("reradiation") {
                        return Err(("reradiation", "the re-radiation of this base decides its albedo"));
                    }
                    put(table, "albedo", rgb(after.albedo));
                }
                if before.sigma != after.sigma {
                    put(table, "sigma", number_item(after.sigma));
                }
            }
            _ => return Err(("type", "this layer is of another type")),
        }
        Ok(())
    }

    /// Whether the index of the medium above a layer was edited: the index of a dielectric with an F0 alone follows from it.
    fn index_above_differs(&self, number: usize) -> bool {
        let Some(above) = number.checked_sub(1) else { return false };
        let [before, after] = [self.original, self.edited].map(|material| Some(dielectric(material, above)?.0));
        before != after
    }

    /// Writes the diffuse base of a metallic-roughness layer. Its albedo follows from the layer's `base_color`: another one splits the layer.
    fn below_mixed(&mut self, number: usize, place: usize) -> Result<(), Refusal> {
        let (Base::Diffuse(before), Base::Diffuse(after)) =
            (&self.original.stack.layers[number].base, &self.edited.stack.layers[number].base)
        else {
            return Ok(());
        };
        if before.albedo != after.albedo {
            return self.split(number - 1, place);
        }
        if before.sigma != after.sigma {
            let table = table_at(self.document, place).ok_or(("type", "this layer is not in the file"))?;
            put(table, "sigma", number_item(after.sigma));
        }
        Ok(())
    }

    /// Writes a metallic-roughness layer as the dielectric and the diffuse base that it stands for.
    fn split(&mut self, number: usize, place: usize) -> Result<(), Refusal> {
        let (interface, base) = (&self.edited.stack.layers[number], self.edited.stack.layers.get(number + 1));
        let (Base::Dielectric { ior, slab }, Some(Layer { base: Base::Diffuse(diffuse), .. })) =
            (&interface.base, base)
        else {
            return Err(("base_color", "this layer is a metal"));
        };
        let table = table_at(self.document, place).ok_or(("type", "this layer is not in the file"))?;
        if !is_two(table) {
            return Ok(());
        }
        if varies_color(table) {
            return Err(("maps", "a layer with maps of its base colour, metal or F0 has no other numbers"));
        }
        let maps = table.get("maps").and_then(Item::as_table_like);
        if table.contains_key("f82_tint") {
            return Err(("f82_tint", "a layer with an edge tint is a metal to a share, and has no other numbers"));
        }
        // Both have the normal of the layer.
        let bumps = maps.and_then(|maps| maps.get("bumps")).and_then(Item::as_value).cloned();
        table.remove("metallic");
        table.remove("f0");
        table.remove("sigma");
        put(table, "type", Item::Value("dielectric".into()));
        rename(table, "base_color", "f0", rgb(ior.f0().unwrap_or_default()));
        write_plain_index(table, ior);
        write_slab(table, Slab { thickness_um: 0.0, absorption_per_um: [0.0; 3] }, *slab);
        let mut below = InlineTable::new();
        below.insert("type", "diffuse".into());
        below.insert("albedo", rgb_value(diffuse.albedo));
        if diffuse.sigma != 0.0 {
            below.insert("sigma", value(diffuse.sigma));
        }
        if let Some(bumps) = bumps {
            below.insert("maps", InlineTable::from_iter([("bumps", bumps)]).into());
        }
        match self.document.get_mut("layer") {
            Some(Item::ArrayOfTables(tables)) => insert(tables, place + 1, below.into_table()),
            Some(Item::Value(Value::Array(array))) => array.insert(place + 1, below),
            _ => return Err(("type", "this layer is not in the file")),
        }
        Ok(())
    }
}

/// Whether an edit of a layer changes a base that is brighter than its colour, or what decides how much brighter it is: the index of the coat, the
/// slope parameter of a metal.
fn is_brighter_or_coat(original: &Material, edited: &Material, number: usize) -> bool {
    let [before, after] = [original, edited].map(|material| &material.stack.layers[number]);
    let indices = [original, edited].map(|material| dielectric(material, number).map(|(ior, _)| ior));
    match (&before.base, &after.base) {
        _ if number == 0 => indices[0] != indices[1],
        (Base::Diffuse(before), Base::Diffuse(after)) => before.albedo != after.albedo,
        // The F0 of no metal is the same in all such surfaces.
        (Base::Dielectric { ior, .. }, _)
            if ior.f0() == Some([0.04; 3]) && original.layers[number].metallic.is_none() =>
        {
            before.base != after.base
        }
        _ => before != after,
    }
}

/// The index and the slab of a layer of a material, if it is a dielectric.
fn dielectric(material: &Material, number: usize) -> Option<(&Ior, &Slab)> {
    match &material.stack.layers.get(number)?.base {
        Base::Dielectric { ior, slab } => Some((ior, slab)),
        _ => None,
    }
}

/// The place in the list of layers of the file of a layer of the stack, and whether it is the diffuse base of a metallic-roughness layer.
fn place_of(document: &DocumentMut, number: usize) -> Option<(usize, bool)> {
    let mut next = 0;
    for place in 0.. {
        let table = document.get("layer")?.get(place)?.as_table_like()?;
        let metal = table.get("metallic").and_then(number_of).unwrap_or(0.0);
        let count = match table.get("type").and_then(Item::as_str)? {
            "thin-film" => 0,
            _ if is_two(table) && (varies_color(table) || metal < 1.0) => 2,
            _ => 1,
        };
        if number < next + count {
            return Some((place, number > next));
        }
        next += count;
    }
    None
}

/// Whether a layer of the file stands for an interface and a diffuse base: a metallic-roughness layer, or a conductor with a map of its F0.
fn is_two(table: &dyn TableLike) -> bool {
    match table.get("type").and_then(Item::as_str) {
        Some("metallic-roughness") => true,
        Some("conductor") => varies_color(table),
        _ => false,
    }
}

/// Whether a layer has a map of its base colour, metal or F0.
fn varies_color(table: &dyn TableLike) -> bool {
    let maps = table.get("maps").and_then(Item::as_table_like);
    maps.is_some_and(|maps| ["base_color", "metallic", "f0"].iter().any(|key| maps.contains_key(key)))
}

fn table_at(document: &mut DocumentMut, place: usize) -> Option<&mut dyn TableLike> {
    document.get_mut("layer")?.get_mut(place)?.as_table_like_mut()
}

/// Whether the index of a layer follows from its F0 and the index above.
fn has_implied_index(table: &dyn TableLike, layer: &Layer) -> bool {
    matches!(&layer.base, Base::Dielectric { ior, .. } if ior.f0().is_some()) && !table.contains_key("ior")
}

/// Keys that give a surface by one number.
const ISOTROPIC: [&str; 5] = ["roughness", "slope_deg", "smooth", "exponent", "alpha"];

fn surface(table: &mut dyn TableLike, before: Surface, after: Surface) -> Result<(), Refusal> {
    if before == after {
        return Ok(());
    }
    for key in ["abc", "sgd", "exponents"] {
        if table.contains_key(key) {
            return Err((key, "the slope parameter of this surface follows from its other numbers"));
        }
    }
    if table.contains_key("alpha_x") {
        put(table, "alpha_x", number_item(after.alpha_x));
        put(table, "alpha_y", number_item(after.alpha_y));
        if before.rotation != after.rotation {
            put(table, "rotation_deg", degrees(after.rotation));
        }
        return Ok(());
    }
    let old = ISOTROPIC.into_iter().find(|key| table.contains_key(key)).unwrap_or("alpha");
    if after.alpha_x == after.alpha_y {
        rename(table, old, "alpha", number_item(after.alpha_x));
    } else {
        rename(table, old, "alpha_x", number_item(after.alpha_x));
        put(table, "alpha_y", number_item(after.alpha_y));
        put(table, "rotation_deg", degrees(after.rotation));
    }
    Ok(())
}

/// Writes an index that was edited, and its F0.
fn write_index(table: &mut dyn TableLike, before: &Ior, after: &Ior, is_transparent: bool) {
    if let Some(f0) = after.f0() {
        if before.f0() != after.f0() {
            put(table, "f0", rgb(f0));
        }
        // Without one it would follow from the new F0.
        if is_transparent {
            write_plain_index(table, after);
        }
    } else if before != after {
        let sample = after.samples()[0];
        if sample.k == 0.0 {
            put(table, "ior", number_item(sample.n));
        } else {
            let mut complex = InlineTable::new();
            complex.insert("n", value(sample.n));
            complex.insert("k", value(sample.k));
            put(table, "ior", Item::Value(Value::InlineTable(complex)));
        }
    }
}

/// Writes an index beside an F0, which is one real number.
fn write_plain_index(table: &mut dyn TableLike, ior: &Ior) {
    put(table, "ior", number_item(ior.samples()[0].n));
}

fn write_slab(table: &mut dyn TableLike, before: Slab, after: Slab) {
    if before.thickness_um != after.thickness_um {
        put(table, "thickness_um", number_item(after.thickness_um));
    }
    if before.absorption_per_um != after.absorption_per_um {
        put(table, "absorption_per_um", rgb(after.absorption_per_um));
    }
}

fn film(table: &mut dyn TableLike, before: &Film, after: &Film) {
    write_index(table, &before.ior, &after.ior, true);
    if before.thickness == after.thickness {
        return;
    }
    match table.get_mut("thickness_nm").and_then(Item::as_table_like_mut) {
        Some(range) => {
            put(range, "min", number_item(after.thickness.min_nm));
            put(range, "max", number_item(after.thickness.max_nm));
        }
        None => put(table, "thickness_nm", number_item(after.thickness.min_nm)),
    }
}

fn write_effects(table: &mut dyn TableLike, original: &Material, edited: &Material) {
    let (before, after): (&Effects, &Effects) = (&original.effects, &edited.effects);
    let mut write = |path: &[&str], before: f64, after: f64, item: fn(f64) -> Item| {
        let Some((key, above)) = path.split_last().filter(|_| before != after) else { return };
        let mut here: &mut dyn TableLike = table;
        for name in above {
            let Some(next) = here.get_mut(name).and_then(Item::as_table_like_mut) else { return };
            here = next;
        }
        put(here, key, item(after));
    };
    if let (Some(before), Some(after)) = (&before.patina, &after.patina) {
        write(&["patina", "extent"], before.extent, after.extent, number_item);
        write(&["patina", "transition"], before.transition, after.transition, number_item);
        if let (Some(before), Some(after)) = (before.base_alpha, after.base_alpha) {
            write(&["patina", "base_alpha"], before, after, number_item);
        }
    }
    if let (Some(before), Some(after)) = (&before.glitter, &after.glitter) {
        write(&["glitter", "frequency"], before.frequency, after.frequency, number_item);
        write(&["glitter", "filled"], before.filled, after.filled, number_item);
        write(&["glitter", "tilt_deg"], before.tilt, after.tilt, degrees);
    }
    if let (Some(before), Some(after)) = (&before.flakes, &after.flakes) {
        write(&["flakes", "scale"], before.scale, after.scale, number_item);
        write(&["flakes", "tiling"], before.tiling, after.tiling, number_item);
        write(&["flakes", "fade_start"], before.fade_start, after.fade_start, number_item);
        if let (FlakeSource::Cells { spread: before, .. }, FlakeSource::Cells { spread: after, .. }) =
            (&before.source, &after.source)
        {
            write(&["flakes", "cells", "spread_deg"], *before, *after, degrees);
        }
    }
    // A reflectance that followed from the absorption of the first layer stays as it was.
    let [slab_before, slab_after] = [original, edited].map(|material| Some(dielectric(material, 0)?.1));
    let patina = table.get_mut("patina").and_then(Item::as_table_like_mut);
    if let (Some(table), Some(patina)) = (patina, &after.patina)
        && table.contains_key("diffuse_remainder")
        && slab_before != slab_after
    {
        rename(table, "diffuse_remainder", "diffuse_albedo", rgb(patina.diffuse_albedo));
    }
}

/// Sets a key. A value that was there leaves its place and its comment to the new one.
fn put(table: &mut dyn TableLike, key: &str, item: Item) {
    rename(table, key, key, item);
}

/// Puts a key with another value in the place of a key; at the end where there was none.
fn rename(table: &mut dyn TableLike, old: &str, new: &str, mut item: Item) {
    if let (Some(before), Some(after)) = (table.get(old).and_then(Item::as_value), item.as_value_mut()) {
        *after.decor_mut() = before.decor().clone();
    }
    if old == new || !table.contains_key(old) {
        match table.get_mut(new) {
            Some(there) => *there = item,
            None => drop(table.insert(new, item)),
        }
        return;
    }
    let keys: Vec<Key> = table.iter().filter_map(|(key, _)| table.key(key).cloned()).collect();
    for key in keys {
        let Some(there) = table.remove(key.get()) else { continue };
        if key.get() == old {
            let fresh = Key::new(new).with_leaf_decor(key.leaf_decor().clone());
            table.entry_format(&fresh).or_insert(std::mem::take(&mut item));
        } else if key.get() != new {
            table.entry_format(&key).or_insert(there);
        }
    }
}

/// Puts a table into a list of tables.
fn insert(tables: &mut ArrayOfTables, place: usize, table: Table) {
    let mut all: Vec<Table> = std::mem::take(tables).into_iter().collect();
    let mut table = table;
    table.decor_mut().set_prefix("\n");
    // Tables are written in the order of their positions in the text; a new one is written where it is in the list.
    all.insert(place.min(all.len()), table);
    tables.extend(all);
}

fn number_of(item: &Item) -> Option<f64> {
    item.as_float().or_else(|| item.as_integer().map(|whole| whole as f64))
}

/// Integers up to here are exact, and read better without a point.
const WHOLE_MAX: f64 = 1e9;

fn value(number: f64) -> Value {
    if number.fract() == 0.0 && number.abs() < WHOLE_MAX { Value::from(number as i64) } else { Value::from(number) }
}

fn number_item(number: f64) -> Item {
    Item::Value(value(number))
}

fn rgb_value(rgb: Rgb) -> Value {
    let [r, g, b] = rgb;
    if r == g && g == b { value(r) } else { Value::Array(rgb.into_iter().map(value).collect::<Array>()) }
}

fn rgb(rgb: Rgb) -> Item {
    Item::Value(rgb_value(rgb))
}

/// Degrees with the fewest digits that are read as an angle in radians.
fn degrees(radians: f64) -> Item {
    let exact = radians.to_degrees();
    let shorter = (0..17).filter_map(|digits| format!("{exact:.digits$e}").parse::<f64>().ok());
    number_item(shorter.into_iter().find(|degrees| degrees.to_radians() == radians).unwrap_or(exact))
}

#[cfg(test)]
mod tests;
