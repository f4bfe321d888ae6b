/* luthier.h: reads the folder of a bake, in C99 or C++, with the C library alone. License: MIT or Apache-2.0, as luthier.
   One file of a program defines LUTHIER_IMPLEMENTATION before it includes this header; all others include it as it is.
       luthier_bake bake;
       luthier_texture texture;
       if (!luthier_open(&bake, "out") || !luthier_read_texture(&bake, &bake.tables[0], &texture)) return puts(bake.error);
       ... upload texture.texels ...
       free(texture.file), luthier_close(&bake);
   Bake with --no-zstd: compressed texels are refused. Functions that return an int return 0 where they fail; `error` of the bake is then a line that begins
   with the name of the file. An engine with files of its own defines LUTHIER_READ_FILE(path, size), a function that returns the bytes of a file for free(). */
#ifndef LUTHIER_H
#define LUTHIER_H
#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif
#define LUTHIER_MOST_BYTES ((size_t)256 << 20) /* of a file; larger ones are refused */

/* A value of manifest.json. The values in it follow it in memory; in an object, names and values take turns. */
typedef struct {
    char type;        /* { object, [ list, " text, 0 number, t true, f false, n null */
    const char *text; /* of a text: UTF-8 that ends with a 0; of a number: where it begins, for strtod */
    size_t size;      /* values from this one to the one beside it */
} luthier_json;

typedef struct { const char *name, *model; const luthier_json *json; } luthier_material; /* its index is its number in the shader */
typedef struct { const char *kind, *format, *file; uint64_t bytes; } luthier_table;      /* bytes of the texels */
typedef struct { const char *name, *resource; unsigned number; const luthier_table *table; } luthier_binding; /* table: NULL if it is none */
typedef struct { const char *target, *form, *file; const luthier_json *json; } luthier_shader; /* its file is a text of `target` */
typedef struct {
    unsigned width, height, vk_format;
    int filtered; /* 1: filter linearly; 0: nearest */
    const unsigned char *texels; size_t bytes; /* row by row without padding, the first row at coordinate 0; they are a part of `file` */
    unsigned char *file; /* for free() */
} luthier_texture;
typedef struct {
    luthier_material *materials; luthier_table *tables; luthier_shader *shaders; luthier_binding *bindings; /* the last of the form `baked` */
    int material_count, table_count, shader_count, binding_count;
    const char *material_buffer; /* the file */
    const luthier_json *json;    /* manifest.json, for what is not above */
    unsigned char *text;
    char folder[256], error[512];
} luthier_bake;

int luthier_open(luthier_bake *bake, const char *folder);
void luthier_close(luthier_bake *bake);                            /* also one that did not open */
int luthier_material_number(luthier_bake *bake, const char *name); /* -1 if there is none */
const luthier_shader *luthier_find_shader(luthier_bake *bake, const char *target, const char *form); /* NULL if there is none */
unsigned char *luthier_read(luthier_bake *bake, const char *file, size_t *size); /* for free(); NULL if it fails */
int luthier_read_texture(luthier_bake *bake, const luthier_table *table, luthier_texture *texture);
const luthier_json *luthier_member(const luthier_json *object, const char *name); /* NULL if there is none, or no object */

#ifdef __cplusplus
}
#endif
#endif
#ifdef LUTHIER_IMPLEMENTATION
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifndef LUTHIER_READ_FILE
#define LUTHIER_READ_FILE luthier__read_file
static unsigned char *luthier__read_file(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    const long length = file && !fseek(file, 0, SEEK_END) ? ftell(file) : -1;
    unsigned char *bytes = length >= 0 && (size_t)length <= LUTHIER_MOST_BYTES ? (unsigned char *)malloc((size_t)length + 1) : NULL;
    if (bytes) rewind(file), *size = fread(bytes, 1, (size_t)length, file);
    if (file) fclose(file);
    return bytes;
}
#endif

static int luthier__fail(luthier_bake *bake, const char *file, const char *what, const char *of) { /* the first error stays */
    if (!bake->error[0]) snprintf(bake->error, sizeof bake->error, "%s/%.100s: %s%.100s", bake->folder, file, what, of);
    return 0;
}

unsigned char *luthier_read(luthier_bake *bake, const char *file, size_t *size) {
    char path[sizeof bake->folder + 256];
    unsigned char *bytes = NULL;
    bake->error[0] = 0, *size = 0;
    if (!*file || *file == '/' || strpbrk(file, "\\:") || strstr(file, "..") || strlen(file) > 254)
        return luthier__fail(bake, file, "the path leads out of the folder, or is too long", ""), bytes;
    snprintf(path, sizeof path, "%s/%s", bake->folder, file);
    bytes = LUTHIER_READ_FILE(path, size);
    if (*size > LUTHIER_MOST_BYTES) free(bytes), bytes = NULL;
    if (!bytes) luthier__fail(bake, file, "cannot be read, or is too large", "");
    return bytes;
}

/* The parser of JSON. Texts are unescaped where they stand. */
typedef struct { luthier_bake *bake; unsigned char *at, *end; luthier_json *values; size_t count, room; unsigned line, depth; } luthier__parser;
static int luthier__wrong(luthier__parser *p, const char *what) {
    char line[16];
    snprintf(line, sizeof line, " in line %u", p->line);
    return luthier__fail(p->bake, "manifest.json", what, line);
}
static int luthier__next(luthier__parser *p) { /* the next byte that is no space; 0 at the end */
    for (; p->at < p->end && *p->at && strchr(" \n\r\t", *p->at); p->at++) p->line += *p->at == '\n';
    return p->at < p->end ? *p->at : 0;
}
static long luthier__code(luthier__parser *p) { /* four hexadecimal digits; -1 if they are none */
    char digits[5] = "";
    if (p->end - p->at >= 4) memcpy(digits, p->at, 4), p->at += 4;
    return strspn(digits, "0123456789abcdefABCDEF") == 4 ? strtol(digits, NULL, 16) : -1;
}

static int luthier__text(luthier__parser *p) {
    static const char escapes[] = "\"\\/bfnrt", meant[] = "\"\\/\b\f\n\r\t";
    unsigned char *to = p->at;
    for (; p->at < p->end && *p->at != '"'; ) {
        long code = *p->at++, low;
        const char *escape;
        if (code < 0x20 || (code == '\\' && p->at == p->end)) return luthier__wrong(p, "a text without an end");
        if (code != '\\') { *to++ = (unsigned char)code; continue; }
        code = *p->at++;
        if (code && (escape = strchr(escapes, (int)code)) != NULL) { *to++ = (unsigned char)meant[escape - escapes]; continue; }
        code = code == 'u' ? luthier__code(p) : -1;
        if (code >> 10 == 0x36) { /* the first of two surrogates */
            low = p->end - p->at >= 6 && *p->at++ == '\\' && *p->at++ == 'u' ? luthier__code(p) : -1;
            code = low >> 10 == 0x37 ? 0x10000 + ((code & 0x3ff) << 10 | (low & 0x3ff)) : -1;
        }
        if (code <= 0 || code >> 10 == 0x37) return luthier__wrong(p, "a wrong escape");
        if (code >= 0x10000) *to++ = (unsigned char)(0xf0 | code >> 18);
        if (code >= 0x800) *to++ = (unsigned char)(code >= 0x10000 ? 0x80 | (code >> 12 & 63) : 0xe0 | code >> 12);
        if (code >= 0x80) *to++ = (unsigned char)(code >= 0x800 ? 0x80 | (code >> 6 & 63) : 0xc0 | code >> 6);
        *to++ = (unsigned char)(code >= 0x80 ? 0x80 | (code & 63) : code);
    }
    if (p->at == p->end) return luthier__wrong(p, "a text without an end");
    *to = 0, p->at++;
    return 1;
}

static int luthier__value(luthier__parser *p) {
    const size_t self = p->count++;
    const int first = luthier__next(p), close = first == '{' ? '}' : ']', digit = first == '-' || (first >= '0' && first <= '9');
    const char *word = first == 't' ? "true" : first == 'f' ? "false" : first == 'n' ? "null" : NULL;
    if (p->count > p->room) {
        luthier_json *more = (luthier_json *)realloc(p->values, (p->room = 2 * p->room + 256) * sizeof *more);
        if (!more) return luthier__wrong(p, "no memory is left");
        p->values = more;
    }
    p->values[self].type = (char)(digit ? '0' : first);
    p->values[self].text = (const char *)p->at + (first == '"');
    if (first == '{' || first == '[') {
        int next = (p->at++, luthier__next(p)) == close ? close : ',';
        if (++p->depth > 64) return luthier__wrong(p, "values are nested too deeply");
        for (; next == ','; p->at += next == ',') {
            if (first == '{' && (luthier__next(p) != '"' || !luthier__value(p) || luthier__next(p) != ':')) return luthier__wrong(p, "no name and colon");
            p->at += first == '{';
            if (!luthier__value(p)) return 0;
            next = luthier__next(p);
        }
        if (next != close) return luthier__wrong(p, "neither a comma nor an end");
        p->at++, p->depth--;
    } else if (first == '"') {
        if (p->at++, !luthier__text(p)) return 0;
    } else if (digit) {
        while (p->at < p->end && *p->at && strchr("+-.eE0123456789", *p->at)) p->at++;
    } else if (word && (size_t)(p->end - p->at) >= strlen(word) && !memcmp(p->at, word, strlen(word))) p->at += strlen(word);
    else return luthier__wrong(p, "no value");
    p->values[self].size = p->count - self;
    return 1;
}

const luthier_json *luthier_member(const luthier_json *object, const char *name) {
    const luthier_json *at = object && object->type == '{' ? object + 1 : NULL;
    for (; at && at < object + object->size; at += 1 + at[1].size)
        if (!strcmp(at->text, name)) return at + 1;
    return NULL;
}

/* The member at the end of a path such as "tables[].format". Where it is not there, or of another type, an error and a null. */
static const luthier_json *luthier__want(luthier_bake *bake, const luthier_json *object, const char *path, char type) {
    static const luthier_json null = { 'n', "", 1 };
    const char *dot = strrchr(path, '.');
    const luthier_json *value = luthier_member(object, dot ? dot + 1 : path);
    if (value && value->type == type) return value;
    luthier__fail(bake, "manifest.json", "missing, or of another type: ", path);
    return &null;
}
static const char *luthier__string(luthier_bake *bake, const luthier_json *at, const char *path) { return luthier__want(bake, at, path, '"')->text; }
static uint64_t luthier__whole(luthier_bake *bake, const luthier_json *at, const char *path) {
    const char *text = luthier__want(bake, at, path, '0')->text;
    char *end = NULL; const uint64_t whole = strtoull(text, &end, 10);
    if (*text == '-' || whole > 0xffffffff || (*end && strchr("+-.eE", *end))) luthier__fail(bake, "manifest.json", "no whole number of 32 bits: ", path);
    return whole;
}

/* Room for what a list of the manifest has. `list` becomes its first value. */
static void *luthier__list(luthier_bake *bake, const char *name, size_t size, const luthier_json **list, int *count) {
    const luthier_json *all = luthier__want(bake, bake->json, name, '['), *at = *list = all + 1;
    void *items;
    for (*count = 0; at < all + all->size; at += at->size) ++*count;
    items = calloc((size_t)*count + 1, size);
    if (!items) *count = luthier__fail(bake, "manifest.json", "no memory is left for ", name);
    return items;
}

static void luthier__lists(luthier_bake *bake) {
    const luthier_json *at, *given = luthier_member(luthier_member(bake->json, "names"), "prefix");
    const char *prefix = given && given->type == '"' ? given->text : "luthier"; const size_t end = strlen(prefix);
    int i, j;
    bake->materials = (luthier_material *)luthier__list(bake, "materials", sizeof(luthier_material), &at, &bake->material_count);
    for (i = 0; i < bake->material_count; i++, at += at->size) {
        luthier_material m = { luthier__string(bake, at, "materials[].name"), luthier__string(bake, at, "materials[].model"), at };
        bake->materials[i] = m;
    }
    bake->tables = (luthier_table *)luthier__list(bake, "tables", sizeof(luthier_table), &at, &bake->table_count);
    for (i = 0; i < bake->table_count; i++, at += at->size) {
        luthier_table t = { luthier__string(bake, at, "tables[].kind"), luthier__string(bake, at, "tables[].format"),
            luthier__string(bake, luthier_member(at, "texture"), "tables[].texture.path"), luthier__whole(bake, at, "tables[].texel_bytes") };
        bake->tables[i] = t;
    }
    bake->shaders = (luthier_shader *)luthier__list(bake, "shaders", sizeof(luthier_shader), &at, &bake->shader_count);
    for (i = 0; i < bake->shader_count; i++, at += at->size) {
        luthier_shader s = { luthier__string(bake, at, "shaders[].target"), luthier__string(bake, at, "shaders[].form"),
            luthier__string(bake, luthier_member(at, "file"), "shaders[].file.path"), at };
        bake->shaders[i] = s;
    }
    bake->bindings = (luthier_binding *)luthier__list(bake, "bindings", sizeof(luthier_binding), &at, &bake->binding_count);
    for (i = 0; i < bake->binding_count; i++, at += at->size) {
        luthier_binding b = { luthier__string(bake, at, "bindings[].name"), luthier__string(bake, at, "bindings[].resource"),
            (unsigned)luthier__whole(bake, at, "bindings[].binding"), NULL };
        for (j = 0; j < bake->table_count; j++)
            if (!strncmp(b.name, prefix, end) && b.name[end] == '_' && !strcmp(b.name + end + 1, bake->tables[j].kind)) b.table = &bake->tables[j];
        if (!b.table && (!strcmp(b.resource, "texture_2d<f32>") || !strcmp(b.resource, "buffer<vec4<u32>>")))
            luthier__fail(bake, "manifest.json", "no table for the binding ", b.name);
        bake->bindings[i] = b;
    }
    bake->material_buffer = luthier__string(bake, luthier_member(bake->json, "material_buffer"), "material_buffer.path");
}

int luthier_open(luthier_bake *bake, const char *folder) {
    luthier__parser p;
    size_t size;
    memset(bake, 0, sizeof *bake), memset(&p, 0, sizeof p);
    if ((size_t)snprintf(bake->folder, sizeof bake->folder, "%s", folder) >= sizeof bake->folder) return luthier__fail(bake, "", "the path is too long", "");
    if ((bake->text = luthier_read(bake, "manifest.json", &size)) == NULL) return 0;
    p.bake = bake, p.line = 1, p.at = bake->text, p.end = bake->text + size;
    if (luthier__value(&p) && (luthier__next(&p), p.at != p.end)) luthier__wrong(&p, "more than one value");
    bake->json = p.values;
    if (!bake->error[0] && luthier__whole(bake, bake->json, "schema") != 4) luthier__fail(bake, "manifest.json", "not of schema 4", "");
    if (!bake->error[0]) luthier__lists(bake);
    return bake->error[0] ? luthier_close(bake), 0 : 1;
}

void luthier_close(luthier_bake *bake) {
    free(bake->materials), free(bake->tables), free(bake->bindings), free(bake->shaders), free(bake->text), free((void *)bake->json);
    memset(bake, 0, offsetof(luthier_bake, folder));
}
int luthier_material_number(luthier_bake *bake, const char *name) {
    int i = bake->material_count;
    while (i-- > 0 && strcmp(bake->materials[i].name, name)) {}
    if (i < 0) bake->error[0] = 0, luthier__fail(bake, "manifest.json", "no material ", name);
    return i;
}
const luthier_shader *luthier_find_shader(luthier_bake *bake, const char *target, const char *form) {
    const luthier_shader *at = bake->shaders, *end = at + bake->shader_count;
    while (at < end && (strcmp(at->target, target) || strcmp(at->form, form))) at++;
    if (at == end) bake->error[0] = 0, luthier__fail(bake, "manifest.json", "no shader of this form; bake with --target ", target);
    return at < end ? at : NULL;
}

static uint64_t luthier__number(const unsigned char *at, int bytes) { return bytes ? at[0] | luthier__number(at + 1, bytes - 1) << 8 : 0; }
int luthier_read_texture(luthier_bake *bake, const luthier_table *table, luthier_texture *texture) {
    static const struct { const char *name; unsigned vk, bytes, side; int filtered; } formats[] = {
        { "r16float", 76, 2, 1, 1 }, { "rg16float", 83, 4, 1, 1 }, { "rgba16float", 97, 8, 1, 1 }, { "rgba8unorm", 37, 4, 1, 1 },
        { "rgb10a2unorm", 64, 4, 1, 1 }, { "rg11b10ufloat", 122, 4, 1, 1 }, { "rgba16unorm", 91, 8, 1, 1 }, { "bc6h-rgb-ufloat", 143, 16, 4, 1 },
        { "r32float", 100, 4, 1, 0 }, { "rgba32float", 109, 16, 1, 0 }, { "rgba16float-steps", 107, 16, 1, 0 }, { NULL, 0, 0, 1, 0 } };
    static const unsigned char nothing[104] = { 0 };
    size_t size, f = 0;
    unsigned char *file = luthier_read(bake, table->file, &size);
    const unsigned char *head = file && size >= sizeof nothing ? file : nothing;
    const uint64_t width = luthier__number(head + 20, 4), height = luthier__number(head + 24, 4);
    const uint64_t offset = luthier__number(head + 80, 8), bytes = luthier__number(head + 88, 8);
    const char *wrong = NULL;
    uint64_t side;
    memset(texture, 0, sizeof *texture);
    if (!file) return 0;
    while (formats[f].name && strcmp(formats[f].name, table->format)) f++;
    side = formats[f].side;
    if (!formats[f].name) wrong = "this reader does not know the format ";
    else if (memcmp(head, "\xabKTX 20\xbb\r\n\x1a\n", 12)) wrong = "no KTX2 file of the format ";
    else if (luthier__number(head + 12, 4) != formats[f].vk) wrong = "its VkFormat is not that of ";
    else if (luthier__number(head + 44, 4) == 2) wrong = "compressed with zstd, bake with --no-zstd: ";
    else if (memcmp(head + 28, "\0\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0\0\0\0", 20)) /* depth, layers, faces, levels, compression */
        wrong = "not one plain level of a two-dimensional texture: ";
    else if (width - 1 >= 65536 || height - 1 >= 65536) wrong = "a side is 0 or above 65536: ";
    else if (bytes != table->bytes || bytes != (width + side - 1) / side * ((height + side - 1) / side) * formats[f].bytes)
        wrong = "not as many bytes as its size and the manifest say: ";
    else if (offset < sizeof nothing || offset > size || bytes > size - offset) wrong = "the file ends before its texels of the format ";
    if (wrong) return free(file), luthier__fail(bake, table->file, wrong, table->format);
    texture->width = (unsigned)width, texture->height = (unsigned)height;
    texture->vk_format = formats[f].vk, texture->filtered = formats[f].filtered;
    texture->texels = file + offset, texture->bytes = (size_t)bytes, texture->file = file;
    return 1;
}
#endif
