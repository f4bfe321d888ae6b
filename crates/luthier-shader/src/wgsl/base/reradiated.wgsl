/// Light that a diffuse base sends from wi to wo, RGB, of the light that comes down to it; a fluorescent base sends light of one channel out
/// in others.
fn luthier_reradiated(layer: LuthierLayer, wi: vec3<f32>, wo: vec3<f32>, lit: vec3<f32>) -> vec3<f32> {
    if layer.fluoresces {
        return vec3<f32>(
            dot(layer.reradiated_red, lit), dot(layer.reradiated_green, lit), dot(layer.reradiated_blue, lit),
        );
    }
    return lit * $diffuse(layer, wi, wo);
}
