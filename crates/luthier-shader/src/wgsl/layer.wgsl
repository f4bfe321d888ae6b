const LUTHIER_DIELECTRIC: u32 = 0u;
const LUTHIER_CONDUCTOR: u32 = 1u;
const LUTHIER_DIFFUSE: u32 = 2u;
const LUTHIER_MATERIAL_WORDS: u32 = $words_material;
const LUTHIER_LAYER_WORDS: u32 = $words_layer;

/// One layer of a material. Indices are relative to the medium above it; tiles are -1 where there is none.
struct LuthierLayer {
    /// 0 dielectric, 1 conductor, 2 diffuse base.
    kind: u32,
    /// Slope parameter of the micro-surface.
    alpha: f32,
    /// How fast D falls with the squared slope: 1 / alpha^2, over ln 2 for Beckmann.
    falloff: f32,
    /// A quarter of the greatest D, 1 / (4 pi alpha^2).
    peak: f32,
    /// Slope distribution: 0 Beckmann, 1 GGX, 2 Blinn, 3 ABC, 4 SGD.
    distribution: f32,
    /// Parameters of its distribution: b and c of ABC, 1 / alpha and p of SGD.
    shape: vec2<f32>,
    /// Slope parameters along the tangent and the bitangent of the layer.
    alpha_xy: vec2<f32>,
    /// Cosine and sine of the angle from the surface's tangent to the layer's.
    rotation: vec2<f32>,
    /// Real part of the index below, at three wavelengths; F0 of an interface of Schlick's, RGB.
    ior_n: vec3<f32>,
    /// Imaginary part of it; of an interface of Schlick's -1 less the weight of its edge tint.
    ior_k: vec3<f32>,
    /// Real part of the index of the film; 0 without a film.
    film_ior_n: vec3<f32>,
    /// Imaginary part of it.
    film_ior_k: vec3<f32>,
    /// Thickness of the film in wavelengths of the medium above.
    film_thickness_waves: vec3<f32>,
    /// Masking: 0 Smith, 1 Smith for each direction, 2 Schlick's fit, 3 V-cavities, 4 Kelemen and Szirmay-Kalos, 5 implicit.
    masking: u32,
    /// Reflectance: 0 a table, 1 Fresnel's equations, 2 Schlick's form, 3 with Lazanyi's correction.
    reflectance: u32,
    /// Part of the light from below that facets reflect back: 1, or 0 where all of it comes out.
    internal_reflection: f32,
    /// Whether light passes by its own angles with the normal, and not by that of the half vector.
    own_angles: bool,
    //? inner_cosine
    /// Whether its light counts by the cosine of the refracted direction.
    inner_cosine: bool,
    //? power_facets
    /// Reflection below another interface: 0 facets, 1 Blinn and Phong's lobe, 2 Phong's.
    lower_facets: u32,
    //? rougher_below
    /// Whether it is never smoother than an interface above it.
    rougher_below: bool,
    /// Reflectance at normal incidence, where it is a curve.
    f0: vec3<f32>,
    /// Weight of the curve's correction.
    edge_weight: vec3<f32>,
    /// Exponent of it.
    edge_exponent: vec3<f32>,
    /// Index below over index above, for the refracted directions.
    eta: f32,
    /// Index above over index below, for the refracted directions.
    inverse_eta: f32,
    /// Squared cosine of a refracted grazing direction, 1 - 1 / eta^2.
    grazing_cos_sq: f32,
    /// Optical depth of the slab below the interface over ln 2, RGB: light that goes straight through is halved so many times.
    optical_depth_log2: vec3<f32>,
    /// BRDF of a Lambertian base, albedo over pi, RGB.
    lambert: vec3<f32>,
    /// Oren-Nayar slope deviation in radians; 0 is Lambert.
    sigma: f32,
    /// Whether it is a base that sends light of one channel out in others.
    fluoresces: bool,
    /// Rows of its matrix from light to light, over pi.
    reradiated_red: vec3<f32>,
    reradiated_green: vec3<f32>,
    reradiated_blue: vec3<f32>,
    $tiles
    /// Squared cotangent of the critical angle; 0 where nothing is totally reflected.
    critical_cot_sq: f32,
    /// Nominal thickness of the film, nm; 0 without a film.
    film_thickness_nm: f32,
    /// Greatest thickness of the film, nm; 0 without a film.
    film_thickness_max_nm: f32,
    /// Factor on its reflectance, RGB: tarnish under patina.
    tarnish: vec3<f32>,
    /// Factor on what its interface does not reflect, RGB.
    passing: vec3<f32>,
    //? film_f0
    /// Roots of the F0 of the metal below the film at a place, RGB, and the share of the metal.
    film_roots: vec4<f32>,
    //? own_edge
    /// Weight of the correction of its reflectance by an edge tint, RGB.
    edge: vec3<f32>,
    /// Normal of its interface at a place, unit, in the frame of the place.
    normal: vec3<f32>,
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
    let head = luthier_materials[first];
    let tiles = luthier_materials[first + $word_tiles];
    let slab = luthier_materials[first + $word_slab];
    let base = luthier_materials[first + $word_base];
    let real_part = luthier_materials[first + $word_ior_n];
    let imaginary_part = luthier_materials[first + $word_ior_k];
    let numbers = luthier_materials[first + $word_numbers];
    var layer: LuthierLayer;
    //? packed
    {
        //? beyond
        let chosen = luthier_whole(numbers.x);
        //? inner_cosine
        layer.inner_cosine = (chosen & 512u) != 0u;
        //? power_facets
        layer.lower_facets = (chosen >> 10u) & 3u;
        //? rougher_below
        layer.rougher_below = chosen >= 4096u;
        //? beyond
        let kind = chosen & 511u;
        //? else
        let kind = luthier_whole(numbers.x);
        layer.kind = kind & 3u;
        layer.reflectance = (kind >> 2u) & 3u;
        //? internal
        {
            layer.masking = (kind >> 4u) & 7u;
            layer.internal_reflection = select(1.0, 0.0, kind >= 128u);
            //? own_angles
            layer.own_angles = kind >= 256u;
        }
        //? else
        layer.masking = kind >> 4u;
    }
    //? else
    layer.kind = luthier_whole(numbers.x);
    layer.alpha = numbers.y;
    layer.falloff = head.x;
    layer.peak = head.y;
    layer.eta = numbers.z;
    layer.inverse_eta = head.z;
    layer.grazing_cos_sq = head.w;
    layer.optical_depth_log2 = slab.xyz;
    layer.lambert = base.xyz;
    layer.sigma = numbers.w;
    layer.fluoresces = layer.kind == LUTHIER_DIFFUSE && luthier_materials[first + $word_film_thickness_waves].x > 0.5;
    layer.reradiated_red = real_part.xyz;
    layer.reradiated_green = imaginary_part.xyz;
    layer.reradiated_blue = luthier_materials[first + $word_film_ior_n].xyz;
    layer.critical_cot_sq = luthier_materials[first + $word_film_ior_k].w;
    $assign_tiles
    layer.film_thickness_nm = real_part.w;
    layer.film_thickness_max_nm = imaginary_part.w;
    layer.distribution = base.w;
    layer.ior_n = real_part.xyz;
    layer.ior_k = imaginary_part.xyz;
    layer.film_ior_n = luthier_materials[first + $word_film_ior_n].xyz;
    layer.film_ior_k = luthier_materials[first + $word_film_ior_k].xyz;
    layer.film_thickness_waves = luthier_materials[first + $word_film_thickness_waves].xyz;
    layer.f0 = luthier_materials[first + $word_film_ior_n].xyz;
    layer.edge_weight = luthier_materials[first + $word_film_ior_k].xyz;
    layer.edge_exponent = luthier_materials[first + $word_film_thickness_waves].xyz;
    //? abc|sgd
    {
        let is_shaped = base.w > 2.5;
        layer.shape = luthier_materials[first + $word_tangent].xy;
        layer.alpha_xy = select(luthier_materials[first + $word_tangent].xy, vec2<f32>(numbers.y), is_shaped);
    }
    //? else
    layer.alpha_xy = luthier_materials[first + $word_tangent].xy;
    layer.rotation = luthier_materials[first + $word_tangent].zw;
    layer.tarnish = vec3<f32>(1.0);
    layer.passing = vec3<f32>(1.0);
    //? film_f0
    layer.film_roots = vec4<f32>(sqrt(max(real_part.xyz, vec3<f32>(0.0))), select(0.0, 1.0, layer.kind == LUTHIER_CONDUCTOR));
    layer.edge = vec3<f32>(0.0);
    layer.normal = vec3<f32>(0.0, 0.0, 1.0);
    return layer;
}

/// A layer of another slope parameter.
fn luthier_with_alpha(layer: LuthierLayer, alpha: f32) -> LuthierLayer {
    var next = layer;
    next.alpha = alpha;
    //? lobes_family, !free_slopes
    {
        // Not over those of the layer: then its word of them need not be read.
        let sharpness = 1.0 / (alpha * alpha);
        next.peak = sharpness * (0.25 / LUTHIER_PI);
        //? beckmann
        {
            //? ggx
            next.falloff = sharpness * select(1.442695, 1.0, layer.distribution > 0.5);
            //? else
            next.falloff = sharpness * 1.442695;
        }
        //? else
        next.falloff = sharpness;
    }
    //? else
    {
        let sharper = layer.alpha / alpha;
        next.falloff = layer.falloff * (sharper * sharper);
        next.peak = layer.peak * (sharper * sharper);
    }
    return next;
}
