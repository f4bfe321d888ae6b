
// A place of a metallic-roughness surface whose maps say what it is there; their texels hold the numbers of the file, too.
fn shading_metallic(given: LuthierPlace, material: u32, uv: vec2<f32>) -> LuthierPlace {
    let count = luthier_layer_count(material);
    if count < 2u {
        return given;
    }
    var place = given;
    $own_f0
    let colors = shading_own(material, count - 2u, 6u);
    let metals = shading_own(material, count - 2u, 7u);
    if max(colors.y, metals.y) == 0u {
        return place;
    }
    // Without metal the albedo of the base says the base colour.
    let eta = shading_layer(material, count - 2u).eta;
    let passed = 0.96 * 20.0 / (21.0 * eta * eta);
    let albedo = shading_albedo(material);
    var color = albedo * passed / (1.0 - albedo * (1.0 - passed));
    if colors.y > 0u {
        color = shading_bilinear(colors, uv).xyz;
    }
    var metallic = 0.0;
    if metals.y > 0u {
        metallic = shading_bilinear(metals, uv).x;
    }
    return luthier_metallic_place(place, material, color, metallic);
}

// Albedo of the diffuse base of a material.
fn shading_albedo(material: u32) -> vec3<f32> {
    return shading_layer(material, shading_layer_count(material) - 1u).albedo;
}
