/// Adds an interface, which a material may ask to be no smoother than those above it.
fn luthier_weidlich_wilkie_interface(path: LuthierPath, layer: LuthierLayer) -> LuthierPath {
    let above = select(0.0, path.alpha_above, layer.rougher_below);
    //? anisotropic
    let alpha_xy = max(layer.alpha_xy, vec2<f32>(above));
    //? anisotropic
    var rougher = luthier_with_alpha(layer, sqrt(alpha_xy.x * alpha_xy.y));
    //? else
    let rougher = luthier_with_alpha(layer, max(above, layer.alpha));
    //? anisotropic
    rougher.alpha_xy = alpha_xy;
    var next = luthier_add_interface(path, rougher);
    next.alpha_above = max(path.alpha_above, layer.alpha);
    return next;
}
