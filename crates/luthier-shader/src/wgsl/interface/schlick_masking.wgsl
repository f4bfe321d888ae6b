/// Schlick's fit (1994) to Smith's masking of one direction, k = alpha sqrt(2 / pi).
fn luthier_schlick_masking(layer: LuthierLayer, cos_theta: f32) -> f32 {
    //? anisotropic
    let k = 0.797884561 * sqrt(layer.alpha_xy.x * layer.alpha_xy.y);
    //? else
    let k = 0.797884561 * layer.alpha;
    return cos_theta / (cos_theta * (1.0 - k) + k);
}
