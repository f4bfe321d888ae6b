// A surface that is the same everywhere.
alias ShadingSurface = f32;

fn shading_surface(material: u32, maps: ShadingMaps, distance: f32) -> ShadingSurface {
    return 0.0;
}

fn shading_factors(material: u32, surface: ShadingSurface) -> ShadingFactors {
    let up = vec3<f32>(0.0, 0.0, 1.0);
    return ShadingFactors(up, 1.0, 1.0, 1.0, up, -1.0);
}

// What a light of a colour sends to the eye.
fn shading_lit(material: u32, surface: ShadingSurface, wi: vec3<f32>, wo: vec3<f32>, light: vec3<f32>) -> vec3<f32> {
    return $lit;
}
