/* A ball of a baked material in OpenGL 4.5, without a window: ball BAKE MATERIAL OUT.ppm [SIZE]
   The camera, the light and the transfer function are those of `luthier preview` that compare.sh calls. */
#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#define LUTHIER_IMPLEMENTATION
#include "luthier.h"

static void fail(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    fputs("error: ", stderr), vfprintf(stderr, format, arguments), fputc('\n', stderr);
    va_end(arguments);
    exit(1);
}

/* One triangle covers the picture; a fragment asks where its ray meets the ball. */
static const char VERTEX[] =
    "#version 450\n"
    "void main() { gl_Position = vec4(4 * (gl_VertexID & 1) - 1, 4 * (gl_VertexID >> 1) - 1, 0, 1); }\n";

/* After "#version 450", the text of the bake and, where it has these functions, BALL_SURFACE and BALL_FILM. */
static const char FRAGMENT[] =
    "layout(location = 0) uniform uint material;\n"
    "layout(location = 1) uniform float size;\n"
    "layout(location = 0) out vec4 color;\n"
    "const float EYE_DISTANCE = 7.0, HALF_EXTENT = 1.22, LIGHT_ANGULAR_RADIUS = 0.05;\n"
    "const vec3 TO_LIGHT = normalize(vec3(-0.45, 0.7, 0.6)), IRRADIANCE = vec3(1.75, 1.7, 1.62);\n"
    "vec3 srgb(vec3 c) { return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308))); }\n"
    "void main() {\n"
    "    vec3 eye = vec3(0.0, 0.0, EYE_DISTANCE);\n"
    "    vec3 ray = normalize(vec3((2.0 * gl_FragCoord.xy / size - 1.0) * HALF_EXTENT, -EYE_DISTANCE));\n"
    "    vec3 moment = cross(eye, ray);\n"
    "    float depth_sq = 1.0 - dot(moment, moment);\n"
    "    color = vec4(0.0, 0.0, 0.0, 1.0);\n"
    "    if (depth_sq <= 0.0) return;\n"
    "    vec3 normal = normalize(cross(ray, moment) - sqrt(depth_sq) * ray);\n"
    "    vec3 up = abs(normal.y) > 0.9999 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);\n"
    "    vec3 tangent = normalize(cross(up, normal));\n"
    "    mat3 frame = mat3(tangent, cross(normal, tangent), normal);\n"
    "    vec3 wi = TO_LIGHT * frame, wo = -ray * frame;\n"
    "#ifdef BALL_SURFACE\n"
    "    // A light with a size widens highlights.\n"
    "    LuthierPlace place = luthier_place();\n"
    "    place.slope_variance = LIGHT_ANGULAR_RADIUS * LIGHT_ANGULAR_RADIUS / 8.0;\n"
    "#ifdef BALL_FILM\n"
    "    vec2 uv = vec2(0.5 + atan(normal.x, normal.z) / 6.2831853, acos(clamp(normal.y, -1.0, 1.0)) / 3.14159265);\n"
    "    place = luthier_film_place(place, material, uv);\n"
    "#endif\n"
    "    vec3 value = luthier_eval_at(place, material, wi, wo);\n"
    "#else\n"
    "    vec3 value = luthier_eval(material, wi, wo);\n"
    "#endif\n"
    "    color = vec4(srgb(min(luthier_bounded(IRRADIANCE * value), 1.0)), 1.0);\n"
    "}\n";

/* A context of OpenGL 4.5 that draws into no window. */
static void open_display(void) {
    const EGLint wanted[] = { EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE };
    const EGLint version[] = { EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE };
    const char *extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    EGLDisplay display;
    EGLConfig config;
    EGLContext context;
    EGLint count = 0;
    if (extensions && strstr(extensions, "EGL_MESA_platform_surfaceless"))
        display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    else
        display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    if (!eglInitialize(display, NULL, NULL)) fail("EGL: no display (0x%x)", eglGetError());
    if (!eglBindAPI(EGL_OPENGL_API) || !eglChooseConfig(display, wanted, &config, 1, &count) || !count) fail("EGL: no OpenGL (0x%x)", eglGetError());
    context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
    if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) fail("EGL: no context of OpenGL 4.5 (0x%x)", eglGetError());
}

static GLuint compile(GLenum kind, int count, const char **texts, const GLint *lengths) {
    GLuint shader = glCreateShader(kind);
    GLint compiled;
    char log[4096] = "";
    glShaderSource(shader, count, texts, lengths);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    glGetShaderInfoLog(shader, sizeof log, NULL, log);
    if (!compiled) fail("%s", log);
    return shader;
}

static int has(const luthier_shader *shader, const char *function) {
    const luthier_json *list = luthier_member(luthier_member(shader->json, "interface"), "functions"), *at, *name;
    for (at = list; list && at < list + list->size; at += at == list ? 1 : at->size)
        if ((name = luthier_member(at, "name")) != NULL && !strcmp(name->text, function)) return 1;
    return 0;
}

/* The program: the text of the bake between lines of ours. */
static GLuint link_program(luthier_bake *bake) {
    const luthier_shader *shader = luthier_find_shader(bake, "glsl450", "baked");
    const char *vertex = VERTEX, *texts[5];
    GLint lengths[5] = { -1, -1, -1, -1, -1 }, linked;
    GLuint program = glCreateProgram();
    char log[4096] = "";
    unsigned char *glsl;
    size_t size;
    if (!shader || !(glsl = luthier_read(bake, shader->file, &size))) fail("%s", bake->error);
    texts[0] = "#version 450\n";
    texts[1] = has(shader, "luthier_eval_at") && has(shader, "luthier_light") ? "#define BALL_SURFACE\n" : "";
    texts[2] = has(shader, "luthier_film_place") ? "#define BALL_FILM\n" : "";
    texts[3] = (const char *)glsl, lengths[3] = (GLint)size;
    texts[4] = FRAGMENT;
    glAttachShader(program, compile(GL_VERTEX_SHADER, 1, &vertex, NULL));
    glAttachShader(program, compile(GL_FRAGMENT_SHADER, 5, texts, lengths));
    free(glsl);
    glLinkProgram(program);
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    glGetProgramInfoLog(program, sizeof log, NULL, log);
    if (!linked) fail("%s", log);
    return program;
}

static void bind_texture(luthier_bake *bake, const luthier_binding *binding) {
    static const struct { const char *name; GLenum internal, format, type; } formats[] = {
        { "r16float", GL_R16F, GL_RED, GL_HALF_FLOAT }, { "rg16float", GL_RG16F, GL_RG, GL_HALF_FLOAT },
        { "rgba16float", GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT }, { "rgba8unorm", GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE },
        { "rgb10a2unorm", GL_RGB10_A2, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV },
        { "rg11b10ufloat", GL_R11F_G11F_B10F, GL_RGB, GL_UNSIGNED_INT_10F_11F_11F_REV },
        { "rgba16unorm", GL_RGBA16, GL_RGBA, GL_UNSIGNED_SHORT }, { "bc6h-rgb-ufloat", GL_COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT, 0, 0 },
        { "r32float", GL_R32F, GL_RED, GL_FLOAT }, { "rgba32float", GL_RGBA32F, GL_RGBA, GL_FLOAT } };
    luthier_texture texture;
    GLuint name;
    GLsizei width, height;
    size_t f = 0;
    if (!luthier_read_texture(bake, binding->table, &texture)) fail("%s", bake->error);
    while (f < sizeof formats / sizeof *formats && strcmp(formats[f].name, binding->table->format)) f++;
    if (f == sizeof formats / sizeof *formats) fail("%s: a texture of the format %s", binding->table->file, binding->table->format);
    width = (GLsizei)texture.width, height = (GLsizei)texture.height;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    glTextureStorage2D(name, 1, formats[f].internal, width, height);
    if (formats[f].type) glTextureSubImage2D(name, 0, 0, 0, width, height, formats[f].format, formats[f].type, texture.texels);
    else glCompressedTextureSubImage2D(name, 0, 0, 0, width, height, formats[f].internal, (GLsizei)texture.bytes, texture.texels);
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, texture.filtered ? GL_LINEAR : GL_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, texture.filtered ? GL_LINEAR : GL_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glBindTextureUnit(binding->number, name);
    free(texture.file);
}

static void bind_buffer(unsigned number, const unsigned char *bytes, size_t size) {
    GLuint name;
    glCreateBuffers(1, &name);
    glNamedBufferStorage(name, (GLsizeiptr)size, bytes, 0);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, number, name);
}

/* What the shader reads, at the numbers of the manifest. Samplers are a part of the textures in GLSL. */
static void bind_all(luthier_bake *bake) {
    for (int i = 0; i < bake->binding_count; i++) {
        const luthier_binding *binding = &bake->bindings[i];
        luthier_texture steps;
        size_t size;
        if (!strcmp(binding->resource, "texture_2d<f32>")) bind_texture(bake, binding);
        else if (!strcmp(binding->resource, "buffer<vec4<u32>>")) { /* rows of lobes with steps */
            if (!luthier_read_texture(bake, binding->table, &steps)) fail("%s", bake->error);
            bind_buffer(binding->number, steps.texels, steps.bytes);
            free(steps.file);
        } else if (!strcmp(binding->resource, "buffer")) {
            unsigned char *bytes = luthier_read(bake, bake->material_buffer, &size);
            if (!bytes) fail("%s", bake->error);
            bind_buffer(binding->number, bytes, size);
            free(bytes);
        }
    }
}

static void save(const char *path, int size) {
    unsigned char *rgb = malloc((size_t)size * (size_t)size * 3);
    FILE *file = fopen(path, "wb");
    if (!rgb || !file) fail("%s: cannot be written", path);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, size, size, GL_RGB, GL_UNSIGNED_BYTE, rgb);
    fprintf(file, "P6 %d %d 255\n", size, size);
    for (int row = size - 1; row >= 0; row--) fwrite(rgb + (size_t)row * (size_t)size * 3, 3, (size_t)size, file);
    if (ferror(file) | fclose(file)) fail("%s: cannot be written", path);
    free(rgb);
}

int main(int count, char **words) {
    const int size = count > 4 ? atoi(words[4]) : 512;
    luthier_bake bake;
    GLuint program, target, frame, vertices;
    GLenum error;
    int material;
    if (count < 4 || size < 1 || size > 8192) fail("usage: ball BAKE MATERIAL OUT.ppm [SIZE]");
    if (!luthier_open(&bake, words[1])) fail("%s", bake.error);
    if ((material = luthier_material_number(&bake, words[2])) < 0) fail("%s", bake.error);
    open_display();
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    program = link_program(&bake);
    bind_all(&bake);

    glCreateRenderbuffers(1, &target);
    glNamedRenderbufferStorage(target, GL_RGBA8, size, size);
    glCreateFramebuffers(1, &frame);
    glNamedFramebufferRenderbuffer(frame, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    glCreateVertexArrays(1, &vertices);
    glBindVertexArray(vertices);
    glViewport(0, 0, size, size);
    glUseProgram(program);
    glUniform1ui(0, (GLuint)material);
    glUniform1f(1, (float)size);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    if ((error = glGetError()) != GL_NO_ERROR) fail("OpenGL: 0x%x", error);
    save(words[3], size);
    printf("%s: %s, %s\n", words[3], words[2], glGetString(GL_RENDERER));
    luthier_close(&bake);
    return 0;
}
