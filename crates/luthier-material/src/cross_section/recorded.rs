//! Cross-sections of materials of a manifest, without their files.

use luthier_manifest::{LayerKind, LayerRecord, LowerReflectance, MaterialEntry};
use luthier_optics::Rgb;
use luthier_optics::fresnel::{FilmLayer, coated};
use luthier_optics::num_complex::Complex64;
use luthier_optics::stack::Surface;

use super::{
    BASE, CrossSection, EXTERIOR, Part, PartKind, PartNumber, SLAB, film_height, flake_cells, glitter, level, nm,
    outline, patina, rgb, roughness, with_room,
};
use crate::doubt::ALPHA_MIN;
use crate::suggest::short;

impl CrossSection {
    /// A cross-section through a material of a manifest, by its layer records. Records have no thickness of a slab: its optical depth is shown
    /// instead. Their indices are relative to the medium above, `relative n`, at the three wavelengths; colours follow from these.
    pub fn recorded(entry: &MaterialEntry) -> Self {
        let exterior = Part {
            kind: PartKind::Exterior,
            layer: None,
            label: "exterior".to_owned(),
            numbers: Vec::new(),
            color: [1.0; 3],
            height: EXTERIOR,
            outline: level(),
        };
        let mut parts = vec![exterior];
        for (number, record) in entry.layers.iter().enumerate() {
            let surface = surface(record);
            let has_facets = record.kind != LayerKind::Diffuse && !surface.is_smooth();
            let outline = if has_facets { outline(&surface) } else { level() };
            if record.film_thickness_max_nm > 0.0 {
                parts.push(film(number, record, outline.clone()));
            }
            let is_last = number + 1 == entry.layers.len();
            let mut medium = medium(number, record, is_last, &surface, outline);
            let own = entry.maps.iter().filter(|map| map.layer == Some(number as u32));
            medium.numbers.extend(own.map(|map| number_of(map.slot.name(), format!("× {}", map.source))));
            parts.push(medium);
        }
        let whole = entry.maps.iter().filter(|map| map.layer.is_none());
        let maps = whole.map(|map| format!("{} map: {}", map.slot.name(), map.source));
        Self { parts: with_room(parts), effects: effects(entry).into_iter().chain(maps).collect() }
    }
}

fn number_of(name: &'static str, value: String) -> PartNumber {
    PartNumber { name, value }
}

/// The micro-surface of a record; a slope parameter of [`ALPHA_MIN`] stands for a smooth one.
fn surface(record: &LayerRecord) -> Surface {
    let [alpha_x, alpha_y] = record.alpha_xy.map(|alpha| if alpha <= ALPHA_MIN { 0.0 } else { alpha });
    Surface { distribution: record.distribution, alpha_x, alpha_y, rotation: record.rotation }
}

fn film(layer: usize, record: &LayerRecord, outline: Vec<[f64; 2]>) -> Part {
    let (nominal, most) = (record.film_thickness_nm, record.film_thickness_max_nm);
    let thickness = if nominal < most { format!("{}, at most {}", nm(nominal), nm(most)) } else { nm(nominal) };
    let mut numbers = vec![number_of("thickness", thickness)];
    numbers.extend(indices(record, record.film_ior_n, record.film_ior_k));
    Part {
        kind: PartKind::Film,
        layer: Some(layer),
        label: "thin film".to_owned(),
        numbers,
        color: reflected(record, true),
        height: film_height(nominal),
        outline,
    }
}

fn medium(layer: usize, record: &LayerRecord, is_last: bool, surface: &Surface, outline: Vec<[f64; 2]>) -> Part {
    let below = match record.f0 {
        Some(f0) => {
            let tint = record.f82_tint.or(record.metal_f82_tint).map(|tint| number_of("edge tint", rgb(tint)));
            [number_of("F0", rgb(f0))].into_iter().chain(tint).collect()
        }
        None => indices(record, record.ior_n, record.ior_k),
    };
    let (kind, label, mut numbers, color, height) = match record.kind {
        LayerKind::Dielectric if !is_last => {
            let mut numbers = below;
            if record.optical_depth != [0.0; 3] {
                numbers.push(number_of("optical depth", rgb(record.optical_depth)));
            }
            (PartKind::Slab, "dielectric", numbers, record.optical_depth.map(|depth| libm::exp(-depth)), SLAB)
        }
        LayerKind::Dielectric => (PartKind::HalfSpace, "dielectric", below, reflected(record, false), BASE),
        LayerKind::Conductor => (PartKind::Conductor, "conductor", below, reflected(record, false), BASE),
        LayerKind::Diffuse => {
            let mut numbers = vec![number_of("albedo", rgb(record.albedo))];
            if record.sigma > 0.0 {
                numbers.push(number_of("facet angle", format!("{} rad", short(record.sigma))));
            }
            if record.reradiation.is_some() {
                numbers.push(number_of("light", "fluorescent".to_owned()));
            }
            (PartKind::Diffuse, "diffuse", numbers, record.albedo, BASE)
        }
    };
    if kind != PartKind::Diffuse {
        numbers.extend(roughness(surface));
    }
    let color = color.map(|c| c.clamp(0.0, 1.0));
    Part { kind, layer: Some(layer), label: label.to_owned(), numbers, color, height, outline }
}

/// Indices over the index of the medium above, or plain ones if a record has them in air.
fn indices(record: &LayerRecord, n: Rgb, k: Rgb) -> Vec<PartNumber> {
    let names = match record.lower_reflectance {
        LowerReflectance::InPlace => ["relative n", "relative k"],
        LowerReflectance::InAir => ["n", "k"],
    };
    let mut numbers = vec![number_of(names[0], rgb(n))];
    if k != [0.0; 3] {
        numbers.push(number_of(names[1], rgb(k)));
    }
    numbers
}

/// Reflectance at normal incidence at the three wavelengths, with the film or without.
fn reflected(record: &LayerRecord, has_film: bool) -> Rgb {
    if let Some(f0) = record.f0 {
        return f0;
    }
    [0, 1, 2].map(|c| {
        let [film, below] = [(record.film_ior_n, record.film_ior_k), (record.ior_n, record.ior_k)]
            .map(|(n, k)| Complex64::new(n[c], k[c]));
        let film = FilmLayer { ior: film, waves: record.film_thickness_waves[c] };
        let films = if has_film { &[film][..] } else { &[] };
        coated(Complex64::ONE, films, below, 1.0).unpolarised()
    })
}

fn effects(entry: &MaterialEntry) -> Vec<String> {
    let constants = &entry.constants;
    let mut found = Vec::new();
    if let Some(record) = &constants.patina {
        found.push(patina(record.extent, record.transition));
    }
    if let Some(record) = &constants.flakes {
        // Flakes of a normal map are counted by it, and it is among the maps.
        let source = if record.count > 0 { flake_cells(record.count, record.spread) } else { "of a map".to_owned() };
        found.push(super::flakes(&source, record.scale, record.tiling));
    }
    if let Some(record) = &constants.glitter {
        found.push(glitter(record.frequency, record.filled, record.tilt));
    }
    found
}

#[cfg(test)]
mod tests {
    use luthier_manifest::{FileEntry, MapEntry, MapSlot};

    use super::*;

    fn number<'p>(part: &'p Part, name: &str) -> Option<&'p str> {
        part.numbers.iter().find(|number| number.name == name).map(|number| number.value.as_str())
    }

    #[test]
    fn parts_are_those_of_the_records() {
        let coat = LayerRecord {
            kind: LayerKind::Dielectric,
            alpha_xy: [ALPHA_MIN; 2],
            optical_depth: [0.0, 1.0, 2.0],
            ior_n: [1.5; 3],
            film_ior_n: [1.4; 3],
            film_thickness_waves: [0.5; 3],
            film_thickness_nm: 200.0,
            film_thickness_max_nm: 300.0,
            ..LayerRecord::default()
        };
        let metal = LayerRecord {
            kind: LayerKind::Conductor,
            alpha_xy: [0.2, 0.1],
            ior_n: [0.2, 0.4, 1.4],
            ior_k: [3.0, 2.5, 1.9],
            ..LayerRecord::default()
        };
        let map = MapEntry {
            slot: MapSlot::Alpha,
            layer: Some(1),
            source: "wear.png".to_owned(),
            file: FileEntry::default(),
            width: 1,
            height: 1,
            factor: None,
            srgb: false,
            transform: None,
        };
        let whole = MapEntry { slot: MapSlot::Normal, layer: None, ..map.clone() };
        let entry = MaterialEntry { layers: vec![coat, metal], maps: vec![map, whole], ..MaterialEntry::default() };
        let section = CrossSection::recorded(&entry);
        let kinds: Vec<PartKind> = section.parts.iter().map(|part| part.kind).collect();
        assert_eq!(kinds, [PartKind::Exterior, PartKind::Film, PartKind::Slab, PartKind::Conductor]);
        let [_, film, slab, metal] = &section.parts[..] else { panic!("four parts") };
        assert_eq!(number(film, "thickness"), Some("200 nm, at most 300 nm"));
        assert_eq!([number(slab, "relative n"), number(slab, "optical depth")], [Some("1.5"), Some("0, 1, 2")]);
        assert_eq!((number(slab, "surface"), slab.outline.len()), (Some("smooth"), 2));
        assert_eq!(number(metal, "alpha"), Some("0.2 × 0.1"));
        assert_eq!(metal.numbers.last().map(|number| number.value.as_str()), Some("× wear.png"));
        assert!(metal.color[0] > metal.color[2], "{:?}", metal.color);
        assert!((slab.color[2] - libm::exp(-2.0)).abs() < 1e-12);
        assert_eq!(section.effects, ["normal map: wear.png"]);
        // Half a wave changes nothing: the bare interface, (n - 1)^2 / (n + 1)^2.
        let half_wave = LayerRecord { film_thickness_waves: [0.5 / 1.4; 3], ..entry.layers[0].clone() };
        assert!((reflected(&half_wave, true)[0] - 0.04).abs() < 1e-12);
    }
}
