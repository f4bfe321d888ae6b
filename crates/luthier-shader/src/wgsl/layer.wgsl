const LUTHIER_DIELECTRIC: u32 = 0u; //? below|granier, conductor|granier
const LUTHIER_CONDUCTOR: u32 = 1u; //? granier_bare
const LUTHIER_DIFFUSE: u32 = 2u; //? mixed|granier_base
const LUTHIER_MATERIAL_WORDS: u32 = 11u;
const LUTHIER_LAYER_WORDS: u32 = 11u;

/// One layer of a material. Indices are relative to the medium above it; tiles are -1 where there is none.
struct LuthierLayer {
    /// 0 dielectric, 1 conductor, 2 diffuse base.
    kind: u32,
    /// Slope parameter of the micro-surface. //? interface
    alpha: f32, //? interface
    /// How fast D falls with the squared slope: 1 / alpha^2, over ln 2 for Beckmann. //? interface, chain|smith
    falloff: f32, //? interface, chain|smith
    /// A quarter of the greatest D, 1 / (4 pi alpha^2). //? interface, chain|smith
    peak: f32, //? interface, chain|smith
    /// Index below over index above, for the refracted directions. //? below, statistics
    eta: f32, //? below, statistics
    /// Index above over index below, for the refracted directions. //? below, chain
    inverse_eta: f32, //? below, chain
    /// Squared cosine of a refracted grazing direction, 1 - 1 / eta^2. //? below, chain
    grazing_cos_sq: f32, //? below, chain
    /// How many times the slab below the interface halves light that goes straight through, RGB. //? absorption
    halvings: vec3<f32>, //? absorption
    /// BRDF of a Lambertian base, albedo over pi, RGB. //? diffuse|granier_base
    lambert: vec3<f32>, //? diffuse|granier_base
    /// Oren-Nayar slope deviation in radians; 0 is Lambert. //? oren_nayar
    sigma: f32, //? oren_nayar
    /// Squared cotangent of the critical angle; 0 where nothing is totally reflected. //? total_reflection, fresnel|film_table
    critical_cot_sq: f32, //? total_reflection, fresnel|film_table
    /// Tile of the Fresnel table. //? fresnel
    fresnel_tile: f32, //? fresnel
    /// Tile of the distribution table. //? distribution
    distribution_tile: f32, //? distribution
    /// Tile of the albedo table. //? fgd
    fgd_tile: f32, //? fgd
    /// Tile of the phase table. //? phase
    phase_tile: f32, //? phase
    /// Tile of the thickness table. //? thickness
    thickness_tile: f32, //? thickness
    /// Tile of the film table. //? film_table
    film_tile: f32, //? film_table
    /// Tile of the escape table. //? escape
    escape_tile: f32, //? escape
    /// Nominal thickness of the film, nm; 0 without a film. //? phase|thickness|film_table
    film_thickness_nm: f32, //? phase|thickness|film_table
    /// Greatest thickness of the film, nm; 0 without a film. //? phase|thickness|film_table
    film_thickness_max_nm: f32, //? phase|thickness|film_table
    /// Slope distribution: 0 Beckmann, 1 GGX. //? closed|smith, beckmann, ggx
    distribution: f32, //? closed|smith, beckmann, ggx
    /// Real part of the index below, at three wavelengths. //? full|granier, interface
    ior_n: vec3<f32>, //? full|granier, interface
    /// Imaginary part of it. //? full|granier, interface
    ior_k: vec3<f32>, //? full|granier, interface
    /// Real part of the index of the film; 0 without a film. //? full|granier, film
    film_ior_n: vec3<f32>, //? full|granier, film
    /// Imaginary part of it. //? full|granier, film
    film_ior_k: vec3<f32>, //? full|granier, film
    /// Thickness of the film in wavelengths of the medium above. //? full|granier, film
    film_waves: vec3<f32>, //? full|granier, film
    /// Slope parameters along the tangent and the bitangent of the layer. //? anisotropic
    alpha_xy: vec2<f32>, //? anisotropic
    /// Cosine and sine of the angle from the surface's tangent to the layer's. //? anisotropic
    rotation: vec2<f32>, //? anisotropic
    /// Factor on its reflectance, RGB: tarnish under patina. //? patina
    tarnish: vec3<f32>, //? patina
}

/// A whole number n, which the buffer holds as 2^23 + n: its low bits are n.
fn luthier_whole(word: f32) -> u32 {
    return bitcast<u32>(word) & 0x7fffffu;
}

/// Index of the first word of a material in the buffer.
fn luthier_header(material: u32) -> u32 {
    return material * LUTHIER_MATERIAL_WORDS;
}

/// Number of layers of a material.
fn luthier_layer_count(material: u32) -> u32 {
    return luthier_whole(luthier_materials[luthier_header(material)].y);
}

/// A layer of a material, counted from the top.
fn luthier_layer(material: u32, index: u32) -> LuthierLayer {
    let first = luthier_whole(luthier_materials[luthier_header(material)].x) + index * LUTHIER_LAYER_WORDS;
    let head = luthier_materials[first]; //? interface, chain|smith
    let tiles = luthier_materials[first + 1u]; //? fresnel|distribution|fgd|phase
    let slab = luthier_materials[first + 2u]; //? absorption|thickness
    let base = luthier_materials[first + 3u]; //? diffuse|closed|smith|granier_base, diffuse|beckmann|granier_base, diffuse|ggx|granier_base
    let real_part = luthier_materials[first + 4u]; //? full|granier|phase|thickness|film_table, interface|phase|thickness|film_table
    let imaginary_part = luthier_materials[first + 5u]; //? full|granier|phase|thickness|film_table, interface|phase|thickness|film_table
    let numbers = luthier_materials[first + 10u];
    var layer: LuthierLayer;
    layer.kind = luthier_whole(numbers.x);
    layer.alpha = numbers.y; //? interface
    layer.falloff = head.x; //? interface, chain|smith
    layer.peak = head.y; //? interface, chain|smith
    layer.eta = numbers.z; //? below, statistics
    layer.inverse_eta = head.z; //? below, chain
    layer.grazing_cos_sq = head.w; //? below, chain
    layer.halvings = slab.xyz; //? absorption
    layer.lambert = base.xyz; //? diffuse|granier_base
    layer.sigma = numbers.w; //? oren_nayar
    layer.critical_cot_sq = luthier_materials[first + 7u].w; //? total_reflection, fresnel|film_table
    layer.fresnel_tile = tiles.x; //? fresnel
    layer.distribution_tile = tiles.y; //? distribution
    layer.fgd_tile = tiles.z; //? fgd
    layer.phase_tile = tiles.w; //? phase
    layer.thickness_tile = slab.w; //? thickness
    layer.film_tile = luthier_materials[first + 6u].w; //? film_table
    layer.escape_tile = luthier_materials[first + 8u].w; //? escape
    layer.film_thickness_nm = real_part.w; //? phase|thickness|film_table
    layer.film_thickness_max_nm = imaginary_part.w; //? phase|thickness|film_table
    layer.distribution = base.w; //? closed|smith, beckmann, ggx
    layer.ior_n = real_part.xyz; //? full|granier, interface
    layer.ior_k = imaginary_part.xyz; //? full|granier, interface
    layer.film_ior_n = luthier_materials[first + 6u].xyz; //? full|granier, film
    layer.film_ior_k = luthier_materials[first + 7u].xyz; //? full|granier, film
    layer.film_waves = luthier_materials[first + 8u].xyz; //? full|granier, film
    layer.alpha_xy = luthier_materials[first + 9u].xy; //? anisotropic
    layer.rotation = luthier_materials[first + 9u].zw; //? anisotropic
    layer.tarnish = vec3<f32>(1.0); //? patina
    return layer;
}

/// A layer of another slope parameter. //? place|clamped, interface
fn luthier_with_alpha(layer: LuthierLayer, alpha: f32) -> LuthierLayer { //? place|clamped, interface
    var next = layer; //? place|clamped, interface
    let sharper = layer.alpha / alpha; //? place|clamped, interface, chain|smith
    next.alpha = alpha; //? place|clamped, interface
    next.falloff = layer.falloff * (sharper * sharper); //? place|clamped, interface, chain|smith
    next.peak = layer.peak * (sharper * sharper); //? place|clamped, interface, chain|smith
    return next; //? place|clamped, interface
} //? place|clamped, interface
