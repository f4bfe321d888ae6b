#version 300 es
precision highp float;
precision highp int;

// A picture, or two of them apart.

uniform highp sampler2D show_a;
uniform highp sampler2D show_b;
// One over the number of samples.
uniform vec2 show_scales;
uniform float show_exposure;
// 0 the first, 1 the second to the right of the split, 2 their difference.
uniform int show_mode;
uniform float show_split;
uniform float show_gain;
out vec4 color;

vec3 show_tone(vec3 x) {
    vec3 excess = max(x - 0.8, 0.0) / 0.2;
    return min(x, 0.8) + 0.2 * (1.0 - 1.0 / (1.0 + excess));
}

vec3 show_srgb(vec3 linear) {
    vec3 c = clamp(linear, 0.0, 1.0);
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, vec3(greaterThan(c, vec3(0.0031308))));
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 a = texelFetch(show_a, pixel, 0).rgb * show_scales.x * show_exposure;
    vec3 shown = show_tone(max(a, 0.0));
    if (show_mode > 0) {
        vec3 b = texelFetch(show_b, pixel, 0).rgb * show_scales.y * show_exposure;
        bool is_right = gl_FragCoord.x > show_split * float(textureSize(show_a, 0).x);
        shown = show_mode == 2 ? show_gain * abs(a - b) : is_right ? show_tone(max(b, 0.0)) : shown;
    }
    color = vec4(show_srgb(shown), 1.0);
}
