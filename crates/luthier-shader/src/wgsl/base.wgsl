/// Adds what a diffuse base reflects. It ends the stack.
fn luthier_add_diffuse(path: LuthierPath, layer: LuthierLayer) -> LuthierPath {
    let brdf = luthier_diffuse(layer, path.wi, path.wo); //? oren_nayar
    let brdf = luthier_diffuse(layer); //? !oren_nayar
    var next = path;
    next.reflected = path.reflected + path.throughput * brdf;
    next.open = false;
    return next;
}

/// Adds an interface or a diffuse base. //? mixed
fn luthier_add_layer(path: LuthierPath, layer: LuthierLayer) -> LuthierPath { //? mixed
    if layer.kind == LUTHIER_DIFFUSE { //? mixed
        return luthier_add_diffuse(path, layer); //? mixed
    } //? mixed
    return luthier_add_interface(path, layer); //? mixed
} //? mixed
