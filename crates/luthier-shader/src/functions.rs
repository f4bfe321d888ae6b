//! Functions and structures of shaders that programs around them use.

/// Public functions of shaders: calls, and a description of each for the manual.
pub(crate) const FUNCTIONS: [(&str, &str); 25] = [
    ("luthier_eval(material, wi, wo)", "f cos_theta_i, linear Rec.709; a light adds its irradiance times this"),
    (
        "luthier_eval_lit(material, wi, wo, light)",
        "luthier_eval for light of a colour: what a fluorescent base sends out is no factor times the light, and luthier_eval is for white light",
    ),
    ("luthier_eval_lit_at(place, material, wi, wo, light)", "luthier_eval_lit at a place of a surface that varies"),
    ("luthier_light_lit(prepared, wi, light)", "luthier_eval_lit of a prepared material"),
    (
        "luthier_prepare(material, wo), luthier_light(prepared, wi)",
        "luthier_eval in two steps, of which the first is the same for all lights",
    ),
    ("luthier_prepare_at(place, material, wo)", "luthier_prepare at a place of a surface that varies"),
    ("luthier_albedo(prepared)", "directional albedo RGB: of lobes that of its rows, of other models an estimate"),
    (
        "luthier_sample(prepared, u)",
        "a direction of light from three numbers in 0..1, its density, its weight f cos_theta_i / density, and its lobe",
    ),
    ("luthier_pdf(prepared, wi)", "the density in solid angle of a direction that luthier_sample draws"),
    (
        "luthier_propose(prepared, part, u)",
        "a direction that one of LUTHIER_PROPOSALS parts proposes, its density, and its weight, f cos_theta_i over the densities of all parts",
    ),
    (
        "luthier_environment(prepared, frame, turn)",
        "what the prefiltered environment sends to the eye; the columns of frame are tangent, bitangent and normal in the world of the environment, \
         turn in 0..1 is 0 or changes from frame to frame",
    ),
    ("luthier_bounded(radiance)", "a sum over lights within 0..65504, which half floats hold"),
    ("luthier_eval_at(place, material, wi, wo)", "luthier_eval at a place of a surface that varies"),
    ("luthier_place()", "a place without textures; what yours say goes into its members"),
    ("luthier_flake_normal(material, uv, distance)", "flake_normal of a place at a distance from the eye"),
    ("luthier_flake_tilt(material, flake, distance)", "flake_normal for the normal of a flake in a texture"),
    (
        "luthier_layer_place()",
        "a layer without textures; what yours say of one layer goes into the members of layers of a place",
    ),
    ("luthier_tangent(texel)", "tangent of a layer for a texel of a tangent map"),
    (
        "luthier_metallic_place(place, material, base_color, metallic)",
        "the place with another base colour of a metallic-roughness surface, and another metallic",
    ),
    (
        "luthier_f0_place(place, material, f0)",
        "the place with another F0 of the dielectric on a diffuse base; before luthier_metallic_place, where both are called",
    ),
    ("luthier_patina_amount(material, map_value)", "patina of a place for the value of a texture"),
    ("luthier_glitter_normal(material, uv)", "normal of a place"),
    ("luthier_pick(surface, uv)", "the material of a place of a surface, and normal of that place"),
    ("luthier_film_place(place, material, uv)", "the place with a film as thick as its table says"),
    ("luthier_layer(material, index), luthier_layer_count(material)", "the layers as records, from the top"),
];

/// Structures that a program fills.
pub(crate) const STRUCTURES: [&str; 2] = ["LuthierPlace", "LuthierLayerPlace"];

/// Whether programs around a shader may call a function: the manual names it, or it is a look-up.
pub(crate) fn is_public(function: &str) -> bool {
    let mut named =
        FUNCTIONS.iter().flat_map(|(calls, _)| calls.split("), ")).filter_map(|call| call.split('(').next());
    function.starts_with("luthier_lookup_") || named.any(|name| name == function)
}
