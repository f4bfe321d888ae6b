"""Draws the stand-in pictures of crates/luthier-material/tests/assets: small, deterministic, with the ranges that the materials there have.

    python3 scripts/asset-pictures.py crates/luthier-material/tests/assets
"""

import math
import struct
import sys
import zlib

SIZE = 16


def png(path, width, height, texels):
    """Writes 8-bit texels, each one number or three."""
    channels = 1 if isinstance(texels[0], int) else 3
    flat = [[t] if channels == 1 else list(t) for t in texels]
    rows = b"".join(b"\0" + bytes(sum(flat[y * width : (y + 1) * width], [])) for y in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, 8, 0 if channels == 1 else 2, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def byte(value):
    return round(255 * min(max(value, 0.0), 1.0))


def picture(folder, name, texel):
    """A picture of `texel(u, v)`, at the centres of texels."""
    places = [((x + 0.5) / SIZE, (y + 0.5) / SIZE) for y in range(SIZE) for x in range(SIZE)]
    values = [texel(u, v) for u, v in places]
    bytes_ = [tuple(byte(c) for c in value) if isinstance(value, tuple) else byte(value) for value in values]
    png(f"{folder}/{name}.png", SIZE, SIZE, bytes_)


def wave(u, v, a, b):
    return 0.5 + 0.5 * math.sin(2 * math.pi * (a * u + b * v))


def normal(du, dv):
    length = math.sqrt(du * du + dv * dv + 1)
    return tuple(0.5 + 0.5 * c / length for c in (-du, -dv, 1.0))


def direction(u, v):
    """The doubled angle of circles about the middle, as `tangent` has it."""
    angle = math.atan2(0.5 - v, u - 0.5) + math.pi / 2
    return 0.5 + 0.5 * math.cos(2 * angle), 0.5 + 0.5 * math.sin(2 * angle), 1.0


def main(folder):
    roughness = lambda u, v: 0.3 + 0.6 * wave(u, v, 1, 1)
    metal = lambda u, v: 1.0 if wave(u, v, 1, -1) > 0.7 else 0.0
    strength = lambda u, v: 0.6 + 0.4 * wave(u, v, 2, 0)
    picture(folder, "color", lambda u, v: (0.2 + 0.6 * wave(u, v, 1, 0), 0.5 + 0.3 * wave(u, v, 0, 1), 0.25))
    picture(folder, "stone", lambda u, v: tuple(c + 0.45 * wave(u, v, 2, 1) for c in (0.35, 0.36, 0.5)))
    picture(folder, "brick", lambda u, v: (0.55, 0.5, 0.47) if (8 * v) % 4 < 1 else (0.6 + 0.2 * wave(u, v, 2, 0), 0.35, 0.2))
    picture(folder, "brass", lambda u, v: (0.8 + 0.15 * wave(u, v, 1, 2), 0.65 + 0.1 * wave(u, v, 1, 2), 0.35))
    # Occlusion, roughness and metal, as glTF packs them.
    picture(folder, "orm", lambda u, v: (1.0, roughness(u, v), metal(u, v)))
    picture(folder, "rough", roughness)
    picture(folder, "alpha", lambda u, v: roughness(u, v) ** 2)
    picture(folder, "metal", metal)
    # Weight of a coat in red, as glTF packs it.
    picture(folder, "coat", lambda u, v: (1.0 if wave(u, v, 1, 0) > 0.5 else 0.0, 1.0, 0.0))
    picture(folder, "ribs", lambda u, v: normal(0.25 * math.cos(8 * math.pi * u), 0.0))
    picture(folder, "wrap", lambda u, v: normal(0.1 * math.cos(2 * math.pi * (u + v)), 0.1 * math.cos(4 * math.pi * v)))
    picture(folder, "circles", direction)
    turn = 2 * math.radians(10)
    picture(folder, "ten-degrees", lambda u, v: (0.5 + 0.5 * math.cos(turn), 0.5 + 0.5 * math.sin(turn), 1.0))
    # alpha_x over its largest: r^2 + (1 - r^2) (s b)^2, where s is the strength and b the blue of the texture.
    for name, r, s in [("strength-r01-s05", 0.1, 0.5), ("strength-r03-s1", 0.3, 1.0), ("strength-r04-s05", 0.4, 0.5)]:
        along = lambda b: r * r + (1 - r * r) * (s * b) ** 2
        picture(folder, name, lambda u, v: along(strength(u, v)) / along(1.0))
    png(f"{folder}/white.png", 1, 1, [255])


main(sys.argv[1])
