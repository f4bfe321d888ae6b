//? layered
{
    /// Values of textures of one layer at a place.
    struct LuthierLayerPlace {
        //? own_normals
        /// Normal of its interface alone, unit, in the frame of the place's normal.
        normal: vec3<f32>,
        //? own_alphas
        /// Factors on its slope parameters along the tangent and along the bitangent.
        alpha_factors: vec2<f32>,
        //? tangents
        /// Direction that its tangent is turned to, unit: (1, 0) is no turn. See `luthier_tangent`.
        tangent: vec2<f32>,
        //? own_slabs
        /// Factor on the thickness of the slab below it.
        slab_factor: f32,
        //? own_tints
        /// Factors on what that slab absorbs, RGB.
        absorption_factors: vec3<f32>,
        //? own_f0
        /// Factor on what its interface does not reflect, RGB: 1 - F0 of the place over that of the material. See `luthier_metallic_place`.
        passing: vec3<f32>,
        //? own_edge
        /// Weight of the correction of its reflectance by an edge tint, RGB. See `luthier_metallic_place`.
        edge: vec3<f32>,
    }

    /// A layer without textures.
    fn luthier_layer_place() -> LuthierLayerPlace {
        var own: LuthierLayerPlace;
        own.normal = vec3<f32>(0.0, 0.0, 1.0);
        own.alpha_factors = vec2<f32>(1.0);
        own.tangent = vec2<f32>(1.0, 0.0);
        own.slab_factor = 1.0;
        own.absorption_factors = vec3<f32>(1.0);
        own.passing = vec3<f32>(1.0);
        own.edge = vec3<f32>(0.0);
        return own;
    }

    //? tangents
    /// `LuthierLayerPlace::tangent` of a texel of a tangent map, 0 to 1: 2 texel - 1 is the cosine and the sine of twice the angle, because a
    /// tangent is a line without an end. A texel without a direction turns nothing.
    fn luthier_tangent(texel: vec2<f32>) -> vec2<f32> {
        let doubled = 2.0 * texel - 1.0;
        let length_sq = dot(doubled, doubled);
        let cos_sin = doubled * inverseSqrt(max(length_sq, 1e-12));
        // Half the angle: the larger of cosine and sine first.
        let larger = sqrt(0.5 + 0.5 * abs(cos_sin.x));
        let smaller = 0.5 * cos_sin.y / larger;
        let beyond = vec2<f32>(abs(smaller), select(-larger, larger, cos_sin.y >= 0.0));
        let turned = select(vec2<f32>(larger, smaller), beyond, cos_sin.x < 0.0);
        return select(vec2<f32>(1.0, 0.0), turned, length_sq >= 0.0004);
    }

}
/// Values of textures at one place of a surface. Factors multiply the numbers of the material.
struct LuthierPlace {
    /// Normal, unit, in the frame of the directions.
    normal: vec3<f32>,
    /// Factor on the slope parameters of every layer.
    alpha_factor: f32,
    /// Factor on the thickness of the slab below the first interface.
    slab_factor: f32,
    /// Factor on the thickness of the film on the first interface.
    film_factor: f32,
    //? surface
    /// Variance, along either axis, of the slopes of the normals that a pixel sees: of a normal map whose texels it averages.
    slope_variance: f32,
    //? base_color
    /// Albedo of diffuse bases, RGB; below 0 that of each material.
    base_color: vec3<f32>,
    //? lobes_metallic, own_f0
    /// F0 of the metal of a `metallic-roughness` base, and its share, see `luthier_metallic_place`; a share below 0 leaves the base of the material.
    metal: vec4<f32>,
    //? lobes_metallic, own_edge
    /// Reflectance that the edge tint of that metal keeps at 82 degrees, RGB.
    metal_edge: vec3<f32>,
    //? lobes_metallic, own_f0
    /// Colour that the base shows where it is no metal, RGB.
    matt: vec3<f32>,
    //? dielectric_f0
    /// F0 of the dielectric above a diffuse base, RGB, see `luthier_f0_place`; below 0 that of each material.
    dielectric_f0: vec3<f32>,
    //? granier
    /// Normal of the lower boundary of that film, unit, in the frame of `normal`.
    inner_normal: vec3<f32>,
    //? flakes
    /// Normal of what lies below the first interface, flakes for instance, unit, in the frame of `normal`.
    flake_normal: vec3<f32>,
    //? patina
    /// Amount of patina, 0 to 1; below 0 all layers are there, without its diffuse term and tarnish.
    patina: f32,
    //? weight
    /// Factor on the weight of a coat.
    weight_factor: f32,
    //? layered
    /// Values of textures of single layers, from the top down.
    layers: array<LuthierLayerPlace, $layers>,
}

/// A place without textures.
fn luthier_place() -> LuthierPlace {
    var place: LuthierPlace;
    place.normal = vec3<f32>(0.0, 0.0, 1.0);
    place.alpha_factor = 1.0;
    place.slab_factor = 1.0;
    place.film_factor = 1.0;
    place.inner_normal = vec3<f32>(0.0, 0.0, 1.0);
    place.flake_normal = vec3<f32>(0.0, 0.0, 1.0);
    place.patina = -1.0;
    place.weight_factor = 1.0;
    place.base_color = vec3<f32>(-1.0);
    place.metal = vec4<f32>(-1.0);
    place.metal_edge = vec3<f32>(0.0);
    place.dielectric_f0 = vec3<f32>(-1.0);
    $each_layer
    return place;
}

//? layered, lobes_family|lobes_bumps|lobes_tints
/// Values of textures of a layer, counted from the top.
fn luthier_own_place(place: LuthierPlace, index: u32) -> LuthierLayerPlace {
    var here = place;
    var own = luthier_layer_place();
    if index < $layers {
        own = here.layers[index];
    }
    return own;
}

/// A layer of a material, counted from the top, as it is at a place.
fn luthier_layer_at(place: LuthierPlace, material: u32, index: u32) -> LuthierLayer {
    var layer = luthier_layer(material, index);
    //? layered
    {
        var here = place;
        var own = luthier_layer_place();
        //? weight
        {
            // The record behind the others is the second layer where the first is not.
            //? weight_film
            let number = select(index, select(1u, 0u, luthier_weighs_film(material)), index == luthier_layer_count(material));
            //? else
            let number = select(index, 1u, index == luthier_layer_count(material));
            if number < $layers {
                own = here.layers[number];
            }
        }
        //? else
        if index < $layers {
            own = here.layers[index];
        }
    }
    //? own_normals
    layer.normal = own.normal;
    //? own_slabs
    layer.optical_depth_log2 *= own.slab_factor;
    //? own_tints
    layer.optical_depth_log2 *= own.absorption_factors;
    //? facets_f0
    layer.passing = own.passing;
    //? film_f0, own_f0
    if index == 0u && place.metal.w >= 0.0 {
        layer.film_roots = vec4<f32>(sqrt(max(place.metal.rgb, vec3<f32>(0.0))), place.metal.w);
    }
    //? own_edge
    layer.edge = own.edge;
    //? interface
    var alpha = layer.alpha;
    //? own_alphas
    {
        let own_alphas = max(own.alpha_factors, vec2<f32>(1e-6));
        //? interface, own_widths
        alpha *= sqrt(own_alphas.x * own_alphas.y);
        //? interface, !own_widths
        alpha *= own_alphas.x;
        layer.alpha_xy *= own_alphas;
    }
    //? tangents
    {
        let turn = own.tangent;
        layer.rotation = vec2<f32>(
            layer.rotation.x * turn.x - layer.rotation.y * turn.y, layer.rotation.y * turn.x + layer.rotation.x * turn.y,
        );
    }
    //? surface
    {
        // Slope parameters are twice the variance of Beckmann's slopes, squared.
        let unresolved = 2.0 * max(place.slope_variance, 0.0);
        let scale = place.alpha_factor * place.alpha_factor;
        //? interface
        layer = luthier_with_alpha(layer, clamp(sqrt(alpha * alpha * scale + unresolved), 0.001, 1.0));
        layer.alpha_xy = clamp(sqrt(layer.alpha_xy * layer.alpha_xy * scale + unresolved), vec2<f32>(0.001), vec2<f32>(1.0));
    }
    //? else
    {
        //? interface
        layer = luthier_with_alpha(layer, clamp(alpha * place.alpha_factor, 0.001, 1.0));
        layer.alpha_xy = clamp(layer.alpha_xy * place.alpha_factor, vec2<f32>(0.001), vec2<f32>(1.0));
    }
    //? absorption|film|film_f0
    //? weight_film
    if index == 0u || (index == luthier_layer_count(material) && luthier_weighs_film(material)) {
        layer.optical_depth_log2 *= place.slab_factor;
        layer.film_thickness_waves *= place.film_factor;
        layer.film_thickness_nm *= place.film_factor;
    }
    //? else
    if index == 0u {
        layer.optical_depth_log2 *= place.slab_factor;
        layer.film_thickness_waves *= place.film_factor;
        layer.film_thickness_nm *= place.film_factor;
    }
    //? base_color, diffuse|granier_base
    if place.base_color.x >= 0.0 && layer.kind == LUTHIER_DIFFUSE {
        layer.lambert = place.base_color / LUTHIER_PI;
        layer.fluoresces = false;
    }
    //? chain_patina
    if place.patina >= 0.0 && index > 0u {
        let count = luthier_layer_count(material);
        let base_alpha = luthier_materials[luthier_header(material) + $word_patina].z;
        if base_alpha >= 0.0 && (index == 1u || index == count) {
            layer = luthier_with_alpha(layer, max(mix(layer.alpha, base_alpha, place.patina), 0.001));
            layer.alpha_xy = max(mix(layer.alpha_xy, vec2<f32>(base_alpha), place.patina), vec2<f32>(0.001));
        }
        let tarnish = luthier_materials[luthier_header(material) + $word_patina_tarnish].xyz;
        layer.tarnish = mix(vec3<f32>(1.0), tarnish, place.patina);
    }
    return layer;
}

//? lobes_sides
/// A place as it is for the layers that a coat leaves bare, or for a first layer that its film leaves bare: `coats` is the number of layers that are not there.
fn luthier_place_below_coat(place: LuthierPlace, coats: u32) -> LuthierPlace {
    var next = place;
    if coats == 0u {
        next.film_factor = 1.0;
        return next;
    }
    next.slab_factor = 1.0;
    //? flakes
    next.flake_normal = vec3<f32>(0.0, 0.0, 1.0);
    //? patina
    next.patina = -1.0;
    $each_below_coat
    return next;
}

//? own_f0, brightened
/// The colour that looks like `color` where a coat covers `weight` of the surface and sends back `share` of the light from below.
fn luthier_brightened(color: vec3<f32>, share: f32, weight: f32) -> vec3<f32> {
    let sum = 1.0 - weight * share + share * color;
    let square = max(sum * sum - 4.0 * (1.0 - weight) * share * color, vec3<f32>(0.0));
    return 2.0 * color / (sum + sqrt(square));
}

//? lobes_bumps
/// Normal of an interface of a material at a place, against that of the first one where the place is one of `luthier_place_on_first`.
fn luthier_own_normal(place: LuthierPlace, index: u32) -> vec3<f32> {
    return luthier_own_place(place, index).normal;
}

//? lobes_bumps
/// A place in the frame of its first interface: the normal of that interface is that of the place, and normals of layers are against it.
fn luthier_place_on_first(place: LuthierPlace) -> LuthierPlace {
    let back = vec3<f32>(-place.normal.xy, place.normal.z);
    var next = place;
    next.normal = luthier_local(back, place.layers[0].normal);
    $each_on_first
    next.layers[0].normal = vec3<f32>(0.0, 0.0, 1.0);
    return next;
}

//? lobes_side_frames
{
    /// A place in the frame of the surface: its normal is +z, and normals of layers are against it.
    fn luthier_place_on_surface(place: LuthierPlace) -> LuthierPlace {
        let back = vec3<f32>(-place.normal.xy, place.normal.z);
        var next = place;
        next.normal = vec3<f32>(0.0, 0.0, 1.0);
        $each_on_surface
        return next;
    }

    /// A place in the frame in which the lobes of a material are prepared: that of the first interface, or that of the surface where two sides have frames
    /// of their own.
    fn luthier_place_of_lobes(place: LuthierPlace, material: u32) -> LuthierPlace {
        //? ~lobes_sides
        if !luthier_has_side(material) {
            return luthier_place_on_first(place);
        }
        return luthier_place_on_surface(place);
    }
}

//? dielectric_f0
/// A place with another F0 of the dielectric on the diffuse base of a material.
fn luthier_f0_place(place: LuthierPlace, material: u32, f0: vec3<f32>) -> LuthierPlace {
    let index = luthier_layer_count(material) - 2u;
    let first = luthier_whole(luthier_materials[luthier_header(material)].x) + index * LUTHIER_LAYER_WORDS;
    var next = place;
    next.dielectric_f0 = f0;
    //? facets_f0
    if index < $layers {
        next.layers[index].passing = (1.0 - f0) / max(1.0 - luthier_materials[first + $word_ior_n].xyz, vec3<f32>(1e-6));
    }
    return next;
}

//? own_f0
/// A place with another base colour of a `metallic-roughness` material, and another `metallic`, 0 to 1: F0 of its interface and albedo of its base
/// (glTF 2.0, appendix B).
fn luthier_metallic_place(place: LuthierPlace, material: u32, base_color: vec3<f32>, metallic: f32) -> LuthierPlace {
    // Its interface lies above the base, which is the last layer.
    let index = luthier_layer_count(material) - 2u;
    let first = luthier_whole(luthier_materials[luthier_header(material)].x) + index * LUTHIER_LAYER_WORDS;
    let nominal = luthier_materials[first + $word_ior_n].xyz;
    //? brightened
    {
        let header = luthier_header(material);
        // Shares of its light that a diffuse base and a metal get back from the coat, which covers a share of the surface.
        var shares = vec2<f32>(luthier_materials[header + $word_flakes_shape].w, luthier_materials[header + $word_patina_diffuse_albedo].z);
        shares = select(vec2<f32>(0.0), shares, shares.x > 0.0);
        let shape = luthier_materials[header + $word_patina];
        var covered = shape.x;
        //? weight
        covered = saturate(covered * place.weight_factor);
        //? lobes_sides
        {
            var weight = select(1.0, covered, shape.w > 1.5);
            if luthier_has_side(material) {
                weight = saturate(luthier_side_weight(material) * place.weight_factor);
            }
        }
        //? else
        let weight = select(1.0, covered, shape.w > 1.5);
        let metal = luthier_brightened(base_color, shares.y, weight);
        let matt = luthier_brightened(base_color, shares.x, weight);
    }
    //? else
    {
        let metal = base_color;
        let matt = base_color;
    }
    //? dielectric_f0
    let dielectric = select(nominal, place.dielectric_f0, place.dielectric_f0.x >= 0.0);
    //? else
    let dielectric = vec3<f32>(0.04);
    let f0 = dielectric + metallic * (metal - dielectric);
    // Of what it does not reflect, 1 / eta^2 is let through from below.
    let left = luthier_materials[first].z;
    let shown = matt * (1.0 - metallic);
    //? own_edge
    {
        // Schlick's formula has (6/7)^5 = 0.46266436 at a cosine of 1/7, where the tint is that of the metal.
        let edge = (metal + (1.0 - metal) * 0.46266436) * luthier_materials[first + $word_base].xyz;
        // The correction cos (1 - cos)^6 is 1 / 17.651385 there, and 1/126 on average.
        let passed = ((1.0 - f0) * (20.0 / 21.0) + metallic * edge * (17.651385 / 126.0)) * (left * left);
    }
    //? else
    let passed = (1.0 - f0) * (20.0 / 21.0 * left * left);
    var next = place;
    next.base_color = shown / max(passed + shown * (1.0 - passed), vec3<f32>(1e-20));
    //? lobes_metallic
    {
        next.metal = vec4<f32>(metal, metallic);
        next.matt = matt;
        //? own_edge
        next.metal_edge = edge;
    }
    //? facets_f0
    if index < $layers {
        next.layers[index].passing = (1.0 - f0) / max(1.0 - nominal, vec3<f32>(1e-6));
        //? own_edge
        next.layers[index].edge = metallic * 17.651385 * edge;
    }
    return next;
}

//? thickness
/// A place with the film of a material as thick as its table says there. Repeats in uv.
fn luthier_film_place(place: LuthierPlace, material: u32, uv: vec2<f32>) -> LuthierPlace {
    var layer = luthier_layer(material, 0u);
    //? film_f0
    {
        // Or that of the base below a coat.
        let count = luthier_layer_count(material);
        for (var index = 1u; index < count && layer.thickness_tile < 0.0; index += 1u) {
            layer = luthier_layer(material, index);
        }
    }
    if layer.thickness_tile < 0.0 {
        return place;
    }
    let record = luthier_lookup_thickness(layer.thickness_tile, uv);
    var next = place;
    next.film_factor = 2.0 * record.x * layer.film_thickness_max_nm / layer.film_thickness_nm;
    next.inner_normal = normalize(vec3<f32>(record.yz, 1.0));
    return next;
}
