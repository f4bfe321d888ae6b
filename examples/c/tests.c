/* Faulty files for luthier.h, in memory: tests BAKE... ; with `tests --json BAKE`, manifest.json as luthier.h reads it, a value to a line.
   Compile with -fsanitize=address,undefined -fno-sanitize-recover=all: files lie in memory of their exact size, so that a read beyond one is found. */
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MUTATIONS 6000 /* of the files of a bake */

typedef struct { char name[128]; unsigned char *bytes; size_t size; } file_of_bake;
static file_of_bake files[64];
static int file_count;
static const char FOLDER[] = "bake";

static unsigned char *read_from_memory(const char *path, size_t *size);
#define LUTHIER_READ_FILE(path, size) read_from_memory(path, size)
#define LUTHIER_IMPLEMENTATION
#include "luthier.h"

static unsigned char *copy_of(const unsigned char *bytes, size_t size) {
    unsigned char *copy = malloc(size);
    if (!copy) abort();
    if (size) memcpy(copy, bytes, size);
    return copy;
}

static unsigned char *read_from_memory(const char *path, size_t *size) {
    const size_t skipped = strlen(FOLDER) + 1;
    for (int i = 0; i < file_count; i++)
        if (!strcmp(files[i].name, path + skipped)) return copy_of(files[i].bytes, *size = files[i].size);
    return NULL;
}

static void require(int holds, const char *what, const char *of) {
    if (holds) return;
    fprintf(stderr, "error: %s: %s\n", what, of);
    exit(1);
}

/* An error names a file of the bake. */
static void require_error(const luthier_bake *bake, const char *what) {
    const size_t length = strlen(FOLDER);
    require(!strncmp(bake->error, FOLDER, length) && bake->error[length] == '/' && strstr(bake->error, ": "), what, bake->error);
}

static unsigned sum; /* of everything that was read, so that nothing is left out */
static void touch(const char *text) { while (*text) sum += (unsigned char)*text++; }

/* Opens the bake and reads all its files, as a program does. Returns how many could be read; -1 if it did not open. */
static int read_all(void) {
    luthier_bake bake;
    int count = 0;
    if (!luthier_open(&bake, FOLDER)) return require_error(&bake, "an error without a file"), -1;
    for (int i = 0; i < bake.material_count; i++) {
        touch(bake.materials[i].name), touch(bake.materials[i].model);
        require(luthier_material_number(&bake, bake.materials[i].name) >= 0, "a material without a number", bake.materials[i].name);
    }
    for (int i = 0; i < bake.table_count; i++) {
        luthier_texture texture;
        if (!luthier_read_texture(&bake, &bake.tables[i], &texture)) {
            require_error(&bake, "an error of a table without a file");
            require(!texture.file && !texture.texels, "a refused table with texels", bake.error);
            continue;
        }
        for (size_t b = 0; b < texture.bytes; b++) sum += texture.texels[b];
        free(texture.file);
        count++;
    }
    for (int i = -1; i < bake.shader_count; i++) {
        size_t size;
        unsigned char *bytes = luthier_read(&bake, i < 0 ? bake.material_buffer : bake.shaders[i].file, &size);
        for (size_t b = 0; bytes && b < size; b++) sum += bytes[b];
        if (bytes) count++;
        else require_error(&bake, "an error of a file without its name");
        free(bytes);
    }
    for (int i = 0; i < bake.binding_count; i++) touch(bake.bindings[i].name), touch(bake.bindings[i].resource);
    require(luthier_material_number(&bake, "no such material") == -1 && bake.error[0], "a material that is not there", "");
    require(!luthier_find_shader(&bake, "no such target", "baked") && bake.error[0], "a shader that is not there", "");
    luthier_close(&bake);
    return count;
}

static file_of_bake *file_named(const char *name) {
    for (int i = 0; i < file_count; i++)
        if (!strcmp(files[i].name, name)) return &files[i];
    require(0, "no such file", name);
    return NULL;
}

static void add_from_disk(const char *bake, const char *name) {
    char path[512];
    size_t size = 0;
    unsigned char *bytes = malloc(1 << 24);
    FILE *file;
    snprintf(path, sizeof path, "%s/%s", bake, name);
    file = fopen(path, "rb");
    require(file && bytes, "cannot be read", path);
    size = fread(bytes, 1, 1 << 24, file);
    fclose(file);
    require(size < 1 << 24 && file_count < 64, "too much for this test", path);
    snprintf(files[file_count].name, sizeof files->name, "%s", name);
    files[file_count].bytes = copy_of(bytes, size), files[file_count++].size = size;
    free(bytes);
}

/* The manifest of a bake, and the files that it names. */
static void load(const char *bake) {
    luthier_bake opened;
    while (file_count) free(files[--file_count].bytes);
    add_from_disk(bake, "manifest.json");
    require(luthier_open(&opened, FOLDER), "a sound manifest is refused", opened.error);
    add_from_disk(bake, opened.material_buffer);
    for (int i = 0; i < opened.table_count; i++) add_from_disk(bake, opened.tables[i].file);
    for (int i = 0; i < opened.shader_count; i++) add_from_disk(bake, opened.shaders[i].file);
    luthier_close(&opened);
}

/* A file is another one until give_back. */
static unsigned char *kept;
static size_t kept_size;
static void take(file_of_bake *file, const void *bytes, size_t size) {
    kept = file->bytes, kept_size = file->size;
    file->bytes = copy_of(bytes, size), file->size = size;
}
static void give_back(file_of_bake *file) {
    free(file->bytes);
    file->bytes = kept, file->size = kept_size;
}

/* xorshift32: the same numbers in every run. */
static unsigned state = 2463534242u;
static unsigned below(unsigned most) {
    state ^= state << 13, state ^= state >> 17, state ^= state << 5;
    return state % most;
}

/* No beginning of a manifest or of a table is taken for the whole. */
static int truncations(void) {
    const int all = read_all();
    int count = 0;
    for (int i = 0; i < file_count; i++) {
        const int is_manifest = !strcmp(files[i].name, "manifest.json");
        size_t end = files[i].size;
        if (!is_manifest && !strstr(files[i].name, ".ktx2")) continue;
        while (is_manifest && end && strchr(" \n", files[i].bytes[end - 1])) end--;
        for (size_t size = 0; size < end; size += size < 512 || end - size < 64 ? 1 : 1 + below((unsigned)(end / 128) + 1), count++) {
            const file_of_bake whole = files[i];
            take(&files[i], whole.bytes, size < end ? size : end - 1);
            const int read = read_all();
            require(is_manifest ? read == -1 : read == all - 1, "a beginning is taken for the whole", files[i].name);
            give_back(&files[i]);
        }
    }
    return count;
}

/* Hostile numbers in every field of the heads of tables. */
static int heads(void) {
    static const unsigned long long hostile[] = { 0, 1, 2, 3, 0x7fffffff, 0x80000000, 0xffffffff, 0x10000, 0x10001, 0x7fffffffffffffff,
        0x8000000000000000, 0xffffffffffffffff, 0xffffffffffffff98, 0x100000000 };
    int count = 0;
    for (int i = 0; i < file_count; i++) {
        if (!strstr(files[i].name, ".ktx2")) continue;
        for (size_t at = 0; at < 104; at += 4)
            for (size_t h = 0; h < sizeof hostile / sizeof *hostile; h++, count++)
                for (size_t width = 4; width <= 8 && at + width <= 104; width += 4) {
                    const file_of_bake whole = files[i];
                    take(&files[i], whole.bytes, whole.size);
                    for (size_t b = 0; b < width; b++) files[i].bytes[at + b] = (unsigned char)(hostile[h] >> 8 * b);
                    read_all();
                    give_back(&files[i]);
                }
    }
    return count;
}

/* A few random changes of a file: other bytes, bytes that matter to JSON, parts gone, doubled and moved. */
static void mutations(int *refused, int *read) {
    static const char bytes[] = "{}[]\",:\\u0eE+-. \n/\xff";
    for (int m = 0; m < MUTATIONS; m++) {
        /* Every second one is of the manifest. */
        file_of_bake *file = m % 2 ? &files[0] : &files[below((unsigned)file_count)];
        unsigned char *text = malloc(file->size + 4096);
        size_t size = file->size;
        if (!text || !size) abort();
        memcpy(text, file->bytes, size);
        for (unsigned change = 1 + below(4); change && size; change--) {
            const size_t at = below((unsigned)(below(2) ? size : size < 256 ? size : 256)), part = 1 + below(64);
            const size_t length = part < size - at ? part : size - at;
            switch (below(5)) {
            case 0: text[at] ^= (unsigned char)(1 << below(8)); break;
            case 1: text[at] = (unsigned char)bytes[below(sizeof bytes)]; break;
            case 2: memmove(text + at, text + at + length, size - at - length), size -= length; break;
            case 3: memmove(text + at + length, text + at, size - at), size += length; break;
            default: memmove(text + at, text + below((unsigned)(size - length) + 1), length);
            }
        }
        take(file, text, size);
        if (read_all() < 0) ++*refused;
        else ++*read;
        give_back(file);
        free(text);
    }
}

/* Manifests that are wrong in one way, each with a part of its error. */
static int hostile_manifests(void) {
    static const struct { const char *text, *error; } cases[] = {
        { "", "no value in line 1" }, { "4", "missing, or of another type: schema" }, { "[]", "schema" }, { "nul", "no value" },
        { "{\"schema\": 3}", "not of schema 4" }, { "{\"schema\": 4.5}", "no whole number of 32 bits: schema" }, { "{\"schema\": -4}", "no whole number" },
        { "{\"schema\": 4294967300}", "no whole number of 32 bits: schema" }, { "{\"schema\": 99999999999999999999999}", "no whole number" },
        { "{\"schema\": \"4\"}", "another type: schema" }, { "{\"schema\": 4}", "materials" }, { "{\"schema\": 4} 5", "more than one value" },
        { "{\"schema\": 4,}", "no name and colon" }, { "{\"schema\"\n 4}", "no name and colon in line 2" }, { "{\"a\": \"b", "a text without an end" },
        { "{\"a\": \"b\\", "a text without an end" }, { "{\"a\": \"\n\"}", "a text without an end" }, { "{\"a\": \"\1\"}", "a text without an end" },
        { "{\"a\": \"\\u00", "a wrong escape" }, { "{\"a\": \"\\u0000\"}", "a wrong escape" }, { "{\"a\": \"\\ud800\"}", "a wrong escape" },
        { "{\"a\": \"\\udc00\"}", "a wrong escape" }, { "{\"a\": \"\\ud83d\\u0041\"}", "a wrong escape" }, { "{\"a\": \"\\x41\"}", "a wrong escape" },
        { "{\"a\": \"\\ud83d", "a wrong escape" },
        { "{\"a\": \"\\ud83d\\u", "a wrong escape" }, { "{\"a\": [1 2]}", "neither a comma nor an end" }, { "{\"a\": [1}", "neither a comma nor an end" },
        { "{\"schema\":4,\"materials\":[[\"name\",\"a\"]]}", "materials[].name" },
        { "{\"schema\":4,\"materials\":[5]}", "materials[].name" }, { "{\"schema\":4,\"materials\":{}}", "another type: materials" },
        { "{\"schema\":4,\"materials\":[],\"tables\":[{\"kind\":\"a\",\"format\":\"b\",\"texture\":\"c\"}]}", "tables[].texture.path" },
        { "{\"schema\":4,\"materials\":[],\"tables\":[{\"kind\":\"a\",\"format\":\"b\",\"texture\":{\"path\":\"c\"},\"texel_bytes\":1e3}]}", "texel_bytes" },
        { "{\"schema\":4,\"materials\":[],\"tables\":[],\"shaders\":[],\"bindings\":[{\"binding\":0,\"name\":\"luthier_fresnel\","
          "\"resource\":\"texture_2d<f32>\"}],\"material_buffer\":{\"path\":\"m\"}}", "no table for the binding luthier_fresnel" },
        { "{\"schema\":4,\"materials\":[],\"tables\":[],\"shaders\":[],\"bindings\":[]}", "material_buffer.path" } };
    static const char *const outside[] = { "../manifest.json", "/etc/passwd", "tables/../../x", "C:x", "a\\b", "", ".." };
    file_of_bake *manifest = file_named("manifest.json");
    static char deep[1000];
    luthier_bake bake;
    size_t size;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        take(manifest, cases[i].text, strlen(cases[i].text));
        require(!luthier_open(&bake, FOLDER) && strstr(bake.error, cases[i].error), cases[i].text, bake.error);
        require_error(&bake, cases[i].text);
        give_back(manifest);
    }
    memset(deep, '[', sizeof deep);
    take(manifest, deep, sizeof deep);
    require(!luthier_open(&bake, FOLDER) && strstr(bake.error, "nested too deeply"), "a deep manifest", bake.error);
    give_back(manifest);
    require(luthier_open(&bake, FOLDER), "a sound manifest is refused", bake.error);
    for (size_t i = 0; i < sizeof outside / sizeof *outside; i++)
        require(!luthier_read(&bake, outside[i], &size) && strstr(bake.error, "leads out of the folder"), outside[i], bake.error);
    require(!luthier_read(&bake, "tables/none.ktx2", &size) && strstr(bake.error, "tables/none.ktx2: cannot be read"), "a missing file", bake.error);
    luthier_close(&bake);
    return (int)(sizeof cases / sizeof *cases + sizeof outside / sizeof *outside) + 2;
}

/* A table of every format as bakes write it, and with a wrong length, format and compression. */
static int formats(void) {
    static const struct { const char *name; unsigned vk, bytes, filtered; } all[] = { { "r16float", 76, 2, 1 }, { "rg16float", 83, 4, 1 },
        { "rgba16float", 97, 8, 1 }, { "rgba8unorm", 37, 4, 1 }, { "rgb10a2unorm", 64, 4, 1 }, { "rg11b10ufloat", 122, 4, 1 }, { "rgba16unorm", 91, 8, 1 },
        { "bc6h-rgb-ufloat", 143, 0, 1 }, { "r32float", 100, 4, 0 }, { "rgba32float", 109, 16, 0 }, { "rgba16float-steps", 107, 16, 0 } };
    luthier_bake bake;
    const int count = file_count;
    require(luthier_open(&bake, FOLDER), "a sound manifest is refused", bake.error);
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        /* Of 5 x 6 texels BC6H has 2 x 2 blocks of 16 bytes. */
        const unsigned bytes = all[i].bytes ? 30 * all[i].bytes : 64;
        const unsigned words[] = { all[i].vk, 1, 5, 6, 0, 0, 1, 1, 0 };
        luthier_table table = { "kind", all[i].name, "tables/made.ktx2", bytes };
        luthier_texture texture;
        unsigned char *made = calloc(1, 104 + bytes);
        if (!made) abort();
        memcpy(made, "\xabKTX 20\xbb\r\n\x1a\n", 12);
        for (int w = 0; w < 9; w++) made[12 + 4 * w] = (unsigned char)words[w];
        made[80] = 104, made[88] = (unsigned char)bytes, made[89] = (unsigned char)(bytes >> 8);
        snprintf(files[count].name, sizeof files->name, "tables/made.ktx2");
        files[count].bytes = made, files[count].size = 104 + bytes, file_count = count + 1;
        require(luthier_read_texture(&bake, &table, &texture), "a sound table is refused", bake.error);
        require(texture.width == 5 && texture.height == 6 && texture.bytes == bytes && texture.vk_format == all[i].vk, "a table is misread", all[i].name);
        require(texture.filtered == (int)all[i].filtered && texture.texels == texture.file + 104, "a table is misread", all[i].name);
        free(texture.file);
        made[12]++;
        require(!luthier_read_texture(&bake, &table, &texture) && strstr(bake.error, "VkFormat"), "another format", bake.error);
        made[12]--, made[44] = 2;
        require(!luthier_read_texture(&bake, &table, &texture) && strstr(bake.error, "--no-zstd"), "compressed texels", bake.error);
        made[44] = 0, made[20]++, made[24]++;
        if (all[i].bytes) require(!luthier_read_texture(&bake, &table, &texture) && strstr(bake.error, "not as many bytes"), "another size", bake.error);
        made[20]--, made[24]--, table.bytes++;
        require(!luthier_read_texture(&bake, &table, &texture) && strstr(bake.error, "not as many bytes"), "other texel_bytes", bake.error);
        table.bytes--, files[count].size--;
        require(!luthier_read_texture(&bake, &table, &texture) && strstr(bake.error, "the file ends before"), "a byte less", bake.error);
        table.format = "rgba64float";
        require(!luthier_read_texture(&bake, &table, &texture) && strstr(bake.error, "does not know"), "an unknown format", bake.error);
        free(made);
        file_count = count;
    }
    luthier_close(&bake);
    return (int)(sizeof all / sizeof *all);
}

/* Each value in the order of the text: its type, and texts in hexadecimal, numbers as they stand. */
static void print_json(const luthier_json *value) {
    const luthier_json *end = value + value->size;
    const char *text = value->text;
    putchar(value->type);
    if (value->type == '"') while (*text) printf("%02x", (unsigned char)*text++);
    if (value->type == '0') while (*text && strchr("+-.eE0123456789", *text)) putchar(*text++);
    putchar('\n');
    if (value->type != '{' && value->type != '[') return;
    for (const luthier_json *at = value + 1; at < end; at += at->size) print_json(at);
    puts(value->type == '{' ? "}" : "]");
}

int main(int count, char **words) {
    if (count == 3 && !strcmp(words[1], "--json")) {
        luthier_bake bake;
        add_from_disk(words[2], "manifest.json");
        require(luthier_open(&bake, FOLDER), "a sound manifest is refused", bake.error);
        print_json(bake.json);
        luthier_close(&bake);
        free(files[0].bytes);
        return 0;
    }
    require(count > 1, "usage", "tests BAKE...");
    for (int i = 1; i < count; i++) {
        int refused = 0, read = 0, cut, changed, wrong, made;
        load(words[i]);
        require(read_all() == file_count - 1, "a sound bake is refused", words[i]);
        cut = truncations(), changed = heads(), wrong = hostile_manifests(), made = formats();
        mutations(&refused, &read);
        require(refused > MUTATIONS / 10 && read > MUTATIONS / 10, "mutations that are all alike", words[i]);
        printf("%s: %d files; %d beginnings refused, %d hostile heads, %d wrong manifests and paths, %d formats; of %d mutations %d manifests refused, %d read\n",
            words[i], file_count, cut, changed, wrong, made, MUTATIONS, refused, read);
    }
    while (file_count) free(files[--file_count].bytes);
    return sum == 0;
}
