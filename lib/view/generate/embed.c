/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the frame of mesh-view's page as arrays of C: embed THREE PAGE.html STYLE.css
 * SCRIPT.js… . In the page a line "@style", "@script" or "@three" is what goes in there;
 * "@title", "@header" and "@arrays" are cuts, where a mesh goes in. */
#include "../base64.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

typedef struct text {
    char *byte;
    size_t size;
} text;

static void fail(const char *what, const char *file)
{
    fprintf(stderr, "embed: %s: %s\n", file, what);
    exit(1);
}

static void append(text *to, const char *bytes, size_t size)
{
    if (size == 0)
        return;
    char *byte = realloc(to->byte, to->size + size + 1);
    if (!byte)
        fail("out of memory", "");
    to->byte = byte;
    memcpy(byte + to->size, bytes, size);
    to->size += size;
    byte[to->size] = '\0';
}

static void append_file(text *to, const char *name)
{
    FILE *file = fopen(name, "rb");
    char buffer[1 << 16];
    size_t size;
    if (!file)
        fail("cannot be read", name);
    while ((size = fread(buffer, 1, sizeof buffer, file)) > 0)
        append(to, buffer, size);
    if (ferror(file))
        fail("cannot be read", name);
    fclose(file);
}

/* Deflated (RFC 1951), in base64. */
static void append_packed(text *to, const text *from)
{
    const uLong room = compressBound((uLong)from->size);
    unsigned char *packed = malloc(room);
    z_stream z = {.next_in = (unsigned char *)from->byte, .avail_in = (uInt)from->size};
    const int raw_window = -15, memory_level = 9;
    if (!packed || deflateInit2(&z, Z_BEST_COMPRESSION, Z_DEFLATED, raw_window,
                                memory_level, Z_DEFAULT_STRATEGY) != Z_OK)
        fail("out of memory", "");
    z.next_out = packed;
    z.avail_out = (uInt)room;
    if (deflate(&z, Z_FINISH) != Z_STREAM_END)
        fail("cannot be deflated", "");
    const size_t size = z.total_out, letters = tm_base64_size(size);
    deflateEnd(&z);
    char *letter = malloc(letters + 1);
    if (!letter)
        fail("out of memory", "");
    tm_base64(packed, size, letter);
    append(to, letter, letters);
    free(letter);
    free(packed);
}

/* As strings of some bytes each, which compilers and checkers read faster than numbers.
 */
static void put_array(const char *name, const text *bytes)
{
    const size_t a_line = 96;
    printf("static const char view_%s[] =\n    \"", name);
    for (size_t i = 0; i < bytes->size; i++) {
        const unsigned char c = (unsigned char)bytes->byte[i];
        if (i > 0 && i % a_line == 0)
            printf("\"\n    \"");
        if (c < ' ' || c > '~' || strchr("\"\\?", c))
            printf("\\%03o", c);
        else
            putchar(c);
    }
    printf("\";\n");
}

int main(int argc, char **argv)
{
    static const char *const cut[] = {"@title\n", "@header\n", "@arrays\n"};
    static const char *const part[] = {"before_title", "before_header", "before_arrays",
                                       "after_arrays"};
    text three = {0}, packed = {0}, page = {0}, style = {0}, script = {0}, out = {0};
    const int files = 4;
    size_t cuts = 0;
    if (argc <= files)
        fail("THREE PAGE STYLE SCRIPT…", "usage");
    append_file(&three, argv[1]);
    append_packed(&packed, &three);
    append_file(&page, argv[2]);
    append_file(&style, argv[3]);
    for (int i = files; i < argc; i++)
        append_file(&script, argv[i]);
    for (char *line = page.byte, *next; *line; line = next) {
        next = strchr(line, '\n');
        next = next ? next + 1 : line + strlen(line);
        const size_t size = (size_t)(next - line);
        if (strncmp(line, "@style\n", size) == 0)
            append(&out, style.byte, style.size);
        else if (strncmp(line, "@script\n", size) == 0)
            append(&out, script.byte, script.size);
        else if (strncmp(line, "@three\n", size) == 0)
            append(&out, packed.byte, packed.size);
        else if (cuts < 3 && strncmp(line, cut[cuts], size) == 0) {
            put_array(part[cuts++], &out);
            out.size = 0;
        } else
            append(&out, line, size);
    }
    if (cuts != 3)
        fail("has no @title, @header and @arrays, in this order", argv[2]);
    put_array(part[cuts], &out);
    free(three.byte);
    free(packed.byte);
    free(page.byte);
    free(style.byte);
    free(script.byte);
    free(out.byte);
    return fflush(stdout) == 0 && !ferror(stdout) ? 0 : 1;
}
