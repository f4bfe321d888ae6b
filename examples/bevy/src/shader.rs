//! The shader of a bake for Bevy: `lit.wgsl` around the text of the bake.

use crate::surface::Surface;

/// The text that Bevy compiles.
pub fn program(text: &str, surface: &Surface) -> String {
    let has = |name: &str| text.contains(&format!("fn {name}("));
    let reads = (0..surface.width).map(|i| {
        let kind = format!("luthier_numbers.kinds[{}][{}]", i / 4, i % 4);
        let at = format!("luthier_at({kind}, {i}u, uv, textureDimensions(luthier_map_{i}))");
        let texel =
            format!("luthier_numbers.factors[{i}].rgb * textureSample(luthier_map_{i}, luthier_map_sampler, {at}).rgb");
        format!("base = luthier_texel(material, {kind}, distance, {texel}, base);\n")
    });
    let light = if has("luthier_light_lit") {
        "return luthier_light_lit(luthier_prepared, direction * luthier_frame, color);"
    } else {
        "return color * luthier_light(luthier_prepared, direction * luthier_frame);"
    };
    let mut around = String::new();
    if has("luthier_albedo") {
        around += "radiance += lights.ambient_color.rgb * luthier_albedo(luthier_prepared);\n";
    }
    if has("luthier_environment") {
        // The environment is in radiance, and lamps are in the units of Bevy.
        around += "if luthier_numbers.has_environment != 0u { radiance += luthier_environment(luthier_prepared, luthier_frame, 0.0) / view.exposure; }\n";
    }
    let lit = include_str!("lit.wgsl")
        .replace("LUTHIER_CELLS_KIND", &surface.cells().to_string())
        .replace("LUTHIER_TEXEL", &surface.texel())
        .replace("LUTHIER_BEFORE", &surface.before)
        .replace("LUTHIER_READS", &reads.collect::<String>())
        .replace("LUTHIER_AFTER", &surface.after)
        .replace("LUTHIER_LIGHT", light)
        .replace("LUTHIER_AROUND", &around);
    // Group 0 is Bevy's own.
    lit + &text.replace("@group(0)", "@group(#{MATERIAL_BIND_GROUP})")
}
