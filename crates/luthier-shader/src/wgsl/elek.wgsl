/// Adds an interface, which is never smoother than those above it.
fn luthier_elek_interface(path: LuthierPath, layer: LuthierLayer) -> LuthierPath {
    var rougher = luthier_with_alpha(layer, max(path.alpha, layer.alpha)); //? anisotropic
    let rougher = luthier_with_alpha(layer, max(path.alpha, layer.alpha)); //? !anisotropic
    rougher.alpha_xy = vec2<f32>(rougher.alpha); //? anisotropic
    var next = luthier_add_interface(path, rougher);
    next.alpha = rougher.alpha;
    return next;
}
