// Header of a map of one layer; columns are 0 where there is none.
fn shading_own(material: u32, layer: u32, slot: u32) -> vec4<u32> {
    return shading_map_header(material, $words + $own * layer + slot);
}

// The first channel of a map of one layer; 1 where there is none.
fn shading_own_factor(material: u32, layer: u32, slot: u32, uv: vec2<f32>) -> f32 {
    let header = shading_own(material, layer, slot);
    if header.y == 0u {
        return 1.0;
    }
    return shading_bilinear(header, uv).x;
}

// Textures of one layer at a place.
fn shading_layer_place(material: u32, layer: u32, uv: vec2<f32>) -> LuthierLayerPlace {
    var own = luthier_layer_place();
    $fill
    return own;
}
