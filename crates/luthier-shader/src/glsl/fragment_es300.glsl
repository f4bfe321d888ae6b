in vec3 to_light;
in vec3 to_eye;
flat in uint material_number;
layout(location = 0) out vec4 color;

void main() {
    color = vec4(luthier_bounded(luthier_eval(material_number, normalize(to_light), normalize(to_eye))), 1.0);
}
