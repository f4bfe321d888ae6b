out vec4 view_sum;

vec3 view_seen(vec2 at, uint seed) {
    vec3 ray = normalize(at.x * view_right + at.y * view_up - view_eye);
    ViewPlace place;
    if (!view_ball(ray, place)) {
        if (!view_is_lit) {
            return vec3(0.0);
        }
        return view_shows_sky ? view_radiance(ray) : view_backdrop * (1.0 - 0.3 * min(dot(at, at), 2.0));
    }
    mat3 frame = mat3(place.tangent, cross(place.normal, place.tangent), place.normal);
    vec3 wo = -ray * frame;
    ViewSurface surface = view_surface(view_material, place.uv, length(view_eye - place.position));
    vec3 total = vec3(0.0);
    if (view_is_lit && dot(view_irradiance, view_irradiance) > 0.0) {
        total = view_lit(view_lit_material, view_surface_lit(surface), view_light * frame, wo, view_irradiance);
    }
    return total + view_surroundings(view_material, surface, frame, -ray, seed);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    // Rows count from the top.
    int row = view_size - 1 - pixel.y;
    vec2 cell = vec2(view_sample % view_samples, view_sample / view_samples);
    vec2 at = (vec2(pixel.x, row) + (cell + 0.5) / float(view_samples)) / float(view_size);
    uint seed = uint((row * view_size + pixel.x) * view_samples * view_samples + view_sample);
    vec3 seen = view_seen(vec2(2.0 * at.x - 1.0, 1.0 - 2.0 * at.y), seed);
    vec3 before = view_is_first ? vec3(0.0) : texelFetch(view_before, pixel, 0).rgb;
    view_sum = vec4(before + seen, 1.0);
}
