"""The tables of a bake, and the numbers of its materials, as one PNG that every image reader of MaterialX takes as it is.

Readers of MaterialX' own programs know PNG of 8 bits. A texel of a table is therefore two texels of the image, side by side: the upper bytes of its four half
floats, and the lower ones. Tables lie one below the other. Texels of 32 bits, and of 16 bits in 0..1, are rounded to half floats. Below the tables are the
numbers, floats of 32 bits: the four bytes of one are a texel.
"""

import struct
import zlib
from dataclasses import dataclass

# Texels of a side of an image.
LARGEST = 16384


class Unreadable(Exception):
    """A table that cannot be read; the message says how to bake anew."""


def _halves(floats):
    """Bits of half floats."""
    return struct.unpack(f"<{len(floats)}H", struct.pack(f"<{len(floats)}e", *floats))


def _small(bits, mantissa):
    """A float without a sign: 5 bits of exponent above those of the mantissa."""
    exponent, rest = bits >> mantissa, bits & ((1 << mantissa) - 1)
    scale = 2.0**mantissa
    return rest / scale * 2.0**-14 if exponent == 0 else (1 + rest / scale) * 2.0 ** (exponent - 15)


def _wide(channels, code):
    """Texels of numbers of one kind, `channels` each; those that lack are 0, and A is 1."""

    def texels(data):
        numbers = struct.unpack(f"<{len(data) // struct.calcsize(code)}{code}", data)
        if code == "H":
            numbers = [value / 65535 for value in numbers]
        if code == "B":
            numbers = [value / 255 for value in numbers]
        rest = [0.0, 0.0, 0.0, 1.0][channels:]
        return _halves([value for i in range(0, len(numbers), channels) for value in (*numbers[i : i + channels], *rest)])

    return texels


def _packed(unpack):
    """Texels of one word of 32 bits each."""
    return lambda data: _halves([value for (word,) in struct.iter_unpack("<I", data) for value in unpack(word)])


FORMATS = {
    "r16float": _wide(1, "e"),
    "rg16float": _wide(2, "e"),
    "rgba16float": lambda data: struct.unpack(f"<{len(data) // 2}H", data),
    "r32float": _wide(1, "f"),
    "rgba32float": _wide(4, "f"),
    "rgba8unorm": _wide(4, "B"),
    "rgba16unorm": _wide(4, "H"),
    "rgb10a2unorm": _packed(lambda word: [(word >> shift & 1023) / 1023 for shift in (0, 10, 20)] + [(word >> 30) / 3]),
    "rg11b10ufloat": _packed(lambda word: [_small(word & 2047, 6), _small(word >> 11 & 2047, 6), _small(word >> 22, 5), 1.0]),
}


def read(path, texel_format):
    """Width, height and the bits of the half floats of a KTX2 file, row by row."""
    if texel_format not in FORMATS:
        raise Unreadable(f"{path}: has texels of {texel_format}, which this library has no reader for: bake with --layout filtered, and without a format of your own")
    data = path.read_bytes()
    if data[:12] != b"\xabKTX 20\xbb\r\n\x1a\n" or len(data) < 104:
        raise Unreadable(f"{path}: is no KTX2 file: bake anew")
    width, height = struct.unpack_from("<II", data, 20)
    (scheme,) = struct.unpack_from("<I", data, 44)
    offset, length = struct.unpack_from("<QQ", data, 80)
    if scheme != 0:
        raise Unreadable(f"{path}: is compressed: bake with --no-zstd")
    bits = FORMATS[texel_format](data[offset : offset + length])
    if len(bits) != 4 * width * height:
        raise Unreadable(f"{path}: has another size than its head says: bake anew")
    return width, height, bits


@dataclass
class Image:
    """The PNG of a bake: its bytes, its size, the first row of each table by name, and that of the numbers."""

    data: bytes
    width: int
    rows: int
    first: dict
    first_word: int


def pack(tables, numbers):
    """The image of some tables, `(width, height, bits)` by name, and of `numbers`, floats of little end."""
    widest = max((wide for wide, _, _ in tables.values()), default=32)
    width = (2 * widest + 3) // 4 * 4
    rows, first = [], {}
    for name, (wide, high, bits) in tables.items():
        first[name] = len(rows)
        for y in range(high):
            row = bytearray(4 * width)
            for x in range(wide):
                texel = bits[4 * (y * wide + x) : 4 * (y * wide + x + 1)]
                row[8 * x : 8 * x + 8] = bytes([*(value >> 8 for value in texel), *(value & 255 for value in texel)])
            rows.append(bytes(row))
    first_word = len(rows)
    turned = b"".join(numbers[i : i + 4][::-1] for i in range(0, len(numbers), 4))
    rows += [turned[i : i + 4 * width].ljust(4 * width, b"\0") for i in range(0, len(turned), 4 * width)]
    if max(width, len(rows)) > LARGEST:
        raise Unreadable(f"the tables make an image of {width} x {len(rows)} texels, more than {LARGEST}: bake fewer materials at once")
    return Image(png(width, len(rows), b"".join(b"\0" + row for row in rows)), width, len(rows), first, first_word)


def png(width, height, rows):
    """A PNG of RGBA of 8 bits; each row begins with its filter."""
    chunk = lambda kind, body: struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    head = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")
