/* Draws the ball of examples/c with ball.frag or ball.hlsl, translated for OpenGL: run BAKE MATERIAL OUT.ppm FRAGMENT.glsl
   A test of these shaders. The translation is `spirv-cross --version 450 --no-es` of the SPIR-V that glslang made. */
#define main main_of_ball
#include "../c/ball.c"
#undef main

/* Two triangles for each cell of a grid over the sphere. Camera and light are those of ball.c. */
static const int VERTICES = 6 * 1024 * 512;
static const char SPHERE[] =
    "#version 450\n"
    "layout(location = 0) out vec3 position;\n"
    "layout(location = 1) out vec3 normal;\n"
    "layout(location = 2) out vec3 tangent;\n"
    "void main() {\n"
    "    const ivec2 corners[6] = ivec2[](ivec2(1, 0), ivec2(0, 0), ivec2(1, 1), ivec2(0, 0), ivec2(0, 1), ivec2(1, 1));\n"
    "    ivec2 cell = ivec2(gl_VertexID / 6 % 1024, gl_VertexID / 6 / 1024) + corners[gl_VertexID % 6];\n"
    "    float phi = 6.28318531 * float(cell.x) / 1024.0, theta = 3.14159265 * float(cell.y) / 512.0;\n"
    "    position = vec3(-cos(phi) * sin(theta), cos(theta), sin(phi) * sin(theta));\n"
    "    normal = position;\n"
    "    tangent = cross(abs(normal.y) > 0.9999 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0), normal);\n"
    "    gl_Position = vec4(7.0 / 1.22 * position.xy, 0.0, 7.0 - position.z);\n"
    "}\n";

/* The uniform block of both shaders, std140. */
typedef struct { float eye[4]; unsigned material, light_count, unused[2]; float lights[4][2][4]; } scene_block;

int main(int count, char **words) {
    const int size = 512;
    /* The direction (-0.45, 0.7, 0.6), unit. */
    scene_block scene = { { 0, 0, 7, 0 }, 0, 1, { 0 }, { { { -0.43863316f, 0.68231825f, 0.58484421f, 0 }, { 1.75f, 1.7f, 1.62f, 0 } } } };
    const char *sphere = SPHERE, *text;
    luthier_bake bake;
    GLuint program, target, frame, vertices, block;
    GLint linked;
    size_t length;
    int material;
    if (count != 5) fail("usage: run BAKE MATERIAL OUT.ppm FRAGMENT.glsl");
    if (!luthier_open(&bake, words[1])) fail("%s", bake.error);
    if ((material = luthier_material_number(&bake, words[2])) < 0) fail("%s", bake.error);
    scene.material = (unsigned)material;
    open_display();
    program = glCreateProgram();
    if ((text = (const char *)luthier__read_file(words[4], &length)) == NULL) fail("%s: cannot be read", words[4]);
    glAttachShader(program, compile(GL_VERTEX_SHADER, 1, &sphere, NULL));
    glAttachShader(program, compile(GL_FRAGMENT_SHADER, 1, &text, &(GLint){ (GLint)length }));
    glLinkProgram(program);
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (!linked) fail("%s: does not link", words[4]);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    bind_all(&bake);
    /* Textures and the sampler of HLSL come out as samplers without numbers. */
    for (int i = 0; i < bake.binding_count; i++) {
        char name[256];
        snprintf(name, sizeof name, "SPIRV_Cross_Combined%sluthier_sampler", bake.bindings[i].name);
        if (glGetUniformLocation(program, name) >= 0) glProgramUniform1i(program, glGetUniformLocation(program, name), (GLint)bake.bindings[i].number);
    }
    glCreateBuffers(1, &block);
    glNamedBufferStorage(block, sizeof scene, &scene, 0);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, block);

    glCreateRenderbuffers(1, &target);
    glNamedRenderbufferStorage(target, GL_SRGB8_ALPHA8, size, size);
    glCreateFramebuffers(1, &frame);
    glNamedFramebufferRenderbuffer(frame, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    glCreateVertexArrays(1, &vertices);
    glBindVertexArray(vertices);
    glViewport(0, 0, size, size);
    glClear(GL_COLOR_BUFFER_BIT);
    glEnable(GL_CULL_FACE);
    glEnable(GL_FRAMEBUFFER_SRGB);
    glUseProgram(program);
    glDrawArrays(GL_TRIANGLES, 0, VERTICES);
    if (glGetError() != GL_NO_ERROR) fail("OpenGL: an error");
    save(words[3], size);
    luthier_close(&bake);
    free((void *)text);
    return 0;
}
