/// Adds an interface, which is never smoother than those above it.
fn luthier_elek_interface(path: LuthierPath, layer: LuthierLayer) -> LuthierPath {
    //? anisotropic
    {
        var rougher = luthier_with_alpha(layer, max(path.alpha_above, layer.alpha));
        rougher.alpha_xy = vec2<f32>(rougher.alpha);
    }
    //? else
    let rougher = luthier_with_alpha(layer, max(path.alpha_above, layer.alpha));
    var next = luthier_add_interface(path, rougher);
    next.alpha_above = rougher.alpha;
    return next;
}
