// A surface that varies.
alias ShadingSurface = LuthierPlace;

// The place of the emitted shader, filled from the maps here and nowhere else.
fn shading_surface(material: u32, maps: ShadingMaps, distance: f32) -> ShadingSurface {
    var surface = luthier_place();
    surface.normal = maps.normal;
    surface.alpha_factor = maps.roughness * maps.roughness;
    surface.slab_factor = maps.thickness;
    $fill
    return surface;
}

fn shading_factors(material: u32, surface: ShadingSurface) -> ShadingFactors {
    return ShadingFactors(
        surface.normal, surface.alpha_factor, surface.slab_factor, surface.film_factor, $below, $patina,
    );
}

// What a light of a colour sends to the eye.
fn shading_lit(material: u32, surface: ShadingSurface, wi: vec3<f32>, wo: vec3<f32>, light: vec3<f32>) -> vec3<f32> {
    return $lit;
}
