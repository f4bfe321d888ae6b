//! Decoder of the numbers of a layer that a program sets at run time.

use luthier_manifest::MapSlot;
use luthier_optics::stack::Surface;

use crate::diagnostic::Sink;
use crate::material::{Live, LiveNumber};
use crate::section::Section;

/// Keys below `live`, which are those of maps of the same quantities.
const KEYS: [(&str, MapSlot); 13] = [
    ("normal", MapSlot::Normal),
    ("roughness", MapSlot::Roughness),
    ("thickness", MapSlot::Thickness),
    ("absorption", MapSlot::Absorption),
    ("weight", MapSlot::Weight),
    ("bumps", MapSlot::Bumps),
    ("alpha", MapSlot::Alpha),
    ("alpha_x", MapSlot::AlphaX),
    ("alpha_y", MapSlot::AlphaY),
    ("tangent", MapSlot::Tangent),
    ("albedo", MapSlot::Albedo),
    ("base_color", MapSlot::BaseColor),
    ("metallic", MapSlot::Metallic),
];

/// Whether a layer has a map of a quantity, or lets a program set it.
pub(super) fn varies(at: &Section<'_>, key: &str) -> bool {
    ["maps", "live"].iter().any(|table| at.section(table).is_some_and(|table| table.has(key)))
}

/// The live numbers of a layer with a surface.
pub(super) fn decode(at: &Section<'_>, surface: &Surface) -> Live {
    let Some(live) = at.section("live") else { return Live::default() };
    let numbers = KEYS.into_iter().filter(|(key, _)| live.has(key)).map(|(key, slot)| {
        let own = own_slope(slot, surface);
        let factors = own.zip(live.two_numbers(key)).map(|(own, range)| range.map(|alpha| alpha / own));
        LiveNumber { key, slot, factors }
    });
    Live::new(numbers.collect())
}

/// The slope parameter that a quantity is.
fn own_slope(slot: MapSlot, surface: &Surface) -> Option<f64> {
    match slot {
        MapSlot::Alpha | MapSlot::AlphaX => Some(surface.alpha_x),
        MapSlot::AlphaY => Some(surface.alpha_y),
        _ => None,
    }
}

/// Refuses live numbers that say too little, or that no program could set.
pub(super) fn check(at: &Section<'_>, number: usize, surface: &Surface, sink: &mut Sink<'_>) {
    let Some(live) = at.section("live") else { return };
    // A weight below the first layer is refused as that of the layer.
    for (name, own) in [("normal", "bumps"), ("roughness", "alpha")] {
        if number > 0 && live.has(name) {
            let message = format!("a live `{name}` belongs to the first layer: it is that of the whole surface");
            let hint = format!("write `{own}`, which is that of this layer alone, or move it to the first layer");
            sink.error(live.value_span(name), message, Some(hint));
        }
    }
    let has_axes = at.has("alpha_x") && at.has("alpha_y");
    for name in ["alpha_x", "alpha_y", "tangent"].into_iter().filter(|name| live.has(name) && !has_axes) {
        let message = format!("a live `{name}` is that of an anisotropic surface, which this layer has not");
        let hint = "give the layer `alpha_x` and `alpha_y`, which may be equal".to_owned();
        sink.error(live.value_span(name), message, Some(hint));
    }
    if live.has("alpha") && has_axes {
        let message = "a surface of two slope parameters has no `alpha` that could be live";
        sink.error(live.value_span("alpha"), message, Some("write `alpha_x` and `alpha_y`".to_owned()));
    }
    for (name, slot) in [("alpha", MapSlot::Alpha), ("alpha_x", MapSlot::AlphaX), ("alpha_y", MapSlot::AlphaY)] {
        let (Some([least, most]), Some(own)) = (live.two_numbers(name), own_slope(slot, surface)) else { continue };
        if own == 0.0 {
            let message = format!("a smooth surface has no slopes, and `{name}` stays 0 whatever it is multiplied by");
            let hint = "write `alpha = 0.001` in place of `smooth`, which looks the same".to_owned();
            sink.error(live.value_span(name), message, Some(hint));
        } else if least > most {
            let message = format!("the range of `{name}` begins above its end");
            sink.error(live.value_span(name), message, Some(format!("write `{name} = [{most}, {least}]`")));
        } else if own < least * (1.0 - SLACK) || own > most * (1.0 + SLACK) {
            let message =
                format!("the range of `{name}` leaves the slope parameter of the layer out, which is {own:.4}");
            let [low, high] = [least.min(own), most.max(own)];
            sink.error(live.value_span(name), message, Some(format!("write `{name} = [{low:.4}, {high:.4}]`")));
        }
    }
    let metallic = at.number("metallic").unwrap_or(0.0);
    if live.has("base_color") && !varies(at, "metallic") && metallic > 0.0 {
        let message = "a live `base_color` on a metal needs a live `metallic` beside it";
        let hint = "write `metallic = true` under `live`, or `metallic = 0`".to_owned();
        sink.error(live.value_span("base_color"), message, Some(hint));
    }
    if live.has("albedo") && at.has("reradiation") {
        let message = "a live albedo needs an albedo, and this base has `reradiation`";
        sink.error(live.value_span("albedo"), message, Some("give the base an `albedo`, or leave it out".to_owned()));
    }
}

/// Share of a slope parameter that rounding may take: roughnesses are squared, and slopes are tangents.
const SLACK: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use luthier_manifest::{MapSlot, ShadingModel};

    use crate::material::Material;
    use crate::parse;

    const COAT: &str =
        "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\nthickness_um = 20\nabsorption_per_um = 0.05\n";
    const ENGINE: &str = "[[layer]]\ntype = \"metallic-roughness\"\nbase_color = 0.5\nroughness = 0.5\n";
    const METAL: &str = "[[layer]]\ntype = \"conductor\"\nior = \"cu\"\nalpha_x = 0.3\nalpha_y = 0.1\n";

    fn read(layers: &str) -> Result<Material, Vec<String>> {
        let text = format!("schema = 1\nname = \"m\"\n{layers}");
        let parsed = parse("m.toml", &text, &|_| Err(std::io::ErrorKind::NotFound.into()));
        parsed
            .map(|parsed| parsed.material)
            .map_err(|faults| faults.iter().map(|fault| fault.message.clone()).collect())
    }

    /// Ranges of slope parameters become the axes of a family, with the number of the file between; other numbers have none.
    #[test]
    fn ranges_are_axes() {
        let text = format!(
            "{COAT}live = {{ alpha = [0.05, 0.2], thickness = true, absorption = true, weight = true }}\n\
             {ENGINE}live = {{ base_color = true, metallic = true, alpha = [0.1, 0.5] }}\n"
        );
        let material = read(&text).unwrap();
        let family = material.family().unwrap();
        let near = |a: [f64; 2], b: [f64; 2]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(near(family.coat, [0.05, 0.2]) && near(family.base, [0.1, 0.5]) && family.is_metallic, "{family:?}");
        assert_eq!((material.weight(), material.model(), material.has_side()), (Some(1.0), ShadingModel::Lobes, true));
        let factors = material.layers[1].live.of(MapSlot::Alpha).unwrap().factors.unwrap();
        assert!(near(factors, [0.4, 2.0]), "{factors:?}");
        // Without live numbers none of this is.
        let plain = read(&format!("{COAT}{ENGINE}")).unwrap();
        assert!(plain.family().is_none() && plain.weight().is_none() && !plain.layers[0].varies_slab());
    }

    /// The layers below a coat keep their numbers, and have those of the whole surface.
    #[test]
    fn sides_have_their_own() {
        let text = format!(
            "{COAT}live = {{ weight = true, normal = true }}\n{METAL}live = {{ tangent = true, alpha_x = [0.1, 0.4] }}\n"
        );
        let side = read(&text).unwrap().side().unwrap();
        let slots: Vec<MapSlot> = side.layers[0].live.numbers().iter().map(|number| number.slot).collect();
        assert_eq!(slots, [MapSlot::AlphaX, MapSlot::Tangent, MapSlot::Normal]);
    }

    #[test]
    fn what_no_program_could_set_is_refused() {
        let smooth = COAT.replace("alpha = 0.1", "smooth = true");
        let metal = ENGINE.replace("base_color", "metallic = 1\nbase_color");
        for (layers, message) in [
            (format!("{COAT}live = {{ alpha = [0.2, 0.4] }}\n{ENGINE}"), "leaves the slope parameter of the layer out"),
            (format!("{COAT}live = {{ alpha = [0.4, 0.2] }}\n{ENGINE}"), "begins above its end"),
            (format!("{smooth}live = {{ alpha = [0.2, 0.4] }}\n{ENGINE}"), "a smooth surface has no slopes"),
            (format!("{COAT}live = {{ alpha_x = [0.1, 0.4] }}\n{ENGINE}"), "anisotropic surface"),
            (format!("{COAT}{METAL}live = {{ alpha = [0.1, 0.4] }}\n"), "two slope parameters"),
            (format!("{COAT}{METAL}live = {{ roughness = true }}\n"), "belongs to the first layer"),
            (format!("{COAT}{metal}live = {{ base_color = true }}\n"), "needs a live `metallic`"),
            (
                format!("{COAT}live = {{ color = true }}\n{ENGINE}"),
                "unknown key `color` in the `live` of a dielectric layer",
            ),
        ] {
            let faults = read(&layers).unwrap_err();
            assert!(faults.len() == 1 && faults[0].contains(message), "{faults:?}");
        }
    }
}
