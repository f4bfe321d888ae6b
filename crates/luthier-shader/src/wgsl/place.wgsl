/// What textures say about one place of a surface. Factors multiply what the material says.
struct LuthierPlace {
    /// Normal, unit, in the frame of the directions.
    normal: vec3<f32>,
    /// Factor on the slope parameters of every layer.
    alpha_factor: f32,
    /// Factor on the thickness of the slab below the first interface.
    slab_factor: f32,
    /// Factor on the thickness of the film on the first interface.
    film_factor: f32,
    /// Normal of the lower boundary of that film, unit, in the frame of `normal`. //? granier
    inner_normal: vec3<f32>, //? granier
    /// Normal of the flakes below the first interface, unit, in the frame of `normal`. //? flakes
    flake_normal: vec3<f32>, //? flakes
    /// Amount of patina, 0 to 1; below 0 all layers are there, without its diffuse term and tarnish. //? patina
    patina: f32, //? patina
}

/// A place without textures.
fn luthier_place() -> LuthierPlace {
    var place: LuthierPlace;
    place.normal = vec3<f32>(0.0, 0.0, 1.0);
    place.alpha_factor = 1.0;
    place.slab_factor = 1.0;
    place.film_factor = 1.0;
    place.inner_normal = vec3<f32>(0.0, 0.0, 1.0); //? granier
    place.flake_normal = vec3<f32>(0.0, 0.0, 1.0); //? flakes
    place.patina = -1.0; //? patina
    return place;
}

/// A layer of a material, counted from the top, as it is at a place.
fn luthier_layer_at(place: LuthierPlace, material: u32, index: u32) -> LuthierLayer {
    var layer = luthier_layer(material, index);
    layer = luthier_with_alpha(layer, clamp(layer.alpha * place.alpha_factor, 0.001, 1.0)); //? interface
    layer.alpha_xy = clamp(layer.alpha_xy * place.alpha_factor, vec2<f32>(0.001), vec2<f32>(1.0)); //? anisotropic
    if index == 0u { //? absorption|film
        layer.halvings *= place.slab_factor; //? absorption
        layer.film_waves *= place.film_factor; //? full|granier, film
        layer.film_thickness_nm *= place.film_factor; //? phase|thickness|film_table
    } //? absorption|film
    if place.patina >= 0.0 && index > 0u { //? patina
        let count = luthier_layer_count(material); //? patina
        let base_alpha = luthier_materials[luthier_header(material) + 6u].z; //? patina
        if base_alpha >= 0.0 && (index == 1u || index == count) { //? patina
            layer = luthier_with_alpha(layer, max(mix(layer.alpha, base_alpha, place.patina), 0.001)); //? patina
            layer.alpha_xy = max(mix(layer.alpha_xy, vec2<f32>(base_alpha), place.patina), vec2<f32>(0.001)); //? patina, anisotropic
        } //? patina
        let tarnish = luthier_materials[luthier_header(material) + 8u].xyz; //? patina
        layer.tarnish = mix(vec3<f32>(1.0), tarnish, place.patina); //? patina
    } //? patina
    return layer;
}

/// A place with the film of a material as thick as its table says there. Repeats in uv. //? thickness
fn luthier_film_place(place: LuthierPlace, material: u32, uv: vec2<f32>) -> LuthierPlace { //? thickness
    let layer = luthier_layer(material, 0u); //? thickness
    if layer.thickness_tile < 0.0 { //? thickness
        return place; //? thickness
    } //? thickness
    let record = luthier_lookup_thickness(layer.thickness_tile, uv); //? thickness
    var next = place; //? thickness
    next.film_factor = 2.0 * record.x * layer.film_thickness_max_nm / layer.film_thickness_nm; //? thickness
    next.inner_normal = normalize(vec3<f32>(record.yz, 1.0)); //? thickness, granier
    return next; //? thickness
} //? thickness

/// A direction in a frame whose normal is `normal` (unit, in the frame of the direction): the least rotation that takes +z
/// there is undone.
fn luthier_turned(normal: vec3<f32>, w: vec3<f32>) -> vec3<f32> {
    let across = w.x * normal.x + w.y * normal.y;
    let along = w.z + across / (1.0 + max(normal.z, 0.0));
    return vec3<f32>(w.xy - normal.xy * along, across + w.z * normal.z);
}
