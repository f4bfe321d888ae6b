layout(location = 0) in vec3 to_light;
layout(location = 1) in vec3 to_eye;
layout(location = 2) flat in uint material_number;
layout(location = 0) out vec4 color;

void main() {
    color = vec4(luthier_bounded(luthier_eval(material_number, normalize(to_light), normalize(to_eye))), 1.0);
}
