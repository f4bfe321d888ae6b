"""The maps of figures: thickness.png, a grey map of periodic noise; bumps.png, a normal map of a field of bumps; patina.png, where patina grows
first: in blotches and in streaks that water has left, every value as often as every other; crust.png, how thick it lies, most where it grew first; circles.png and rays.png, two fields of
tangents that cross; heights.png, flakes that lie askew; facets.png, flakes without gaps, twice as wide as high as the map of a ball is; paint.png, a picture in
colours; ripples.png, a normal map of waves.

    python3 crates/luthier-lab/maps/make.py
"""

import math
import os
import random
import struct
import zlib

SIZE = 128


def noise(seed, cells):
    """Smooth noise from 0 to 1 that repeats: cubic between random values of a grid."""
    rng = random.Random(seed)
    grid = [[rng.random() for _ in range(cells)] for _ in range(cells)]

    def value(u, v):
        x, y = u * cells, v * cells
        i, j = int(x), int(y)
        s, t = (lambda f: f * f * (3 - 2 * f))(x - i), (lambda f: f * f * (3 - 2 * f))(y - j)
        at = lambda a, b: grid[(j + b) % cells][(i + a) % cells]
        return (at(0, 0) * (1 - s) + at(1, 0) * s) * (1 - t) + (at(0, 1) * (1 - s) + at(1, 1) * s) * t

    return value


def octaves(seed, cells, count, decay=0.5):
    layers = [(noise(seed + k, cells << k), decay**k) for k in range(count)]
    total = sum(weight for _, weight in layers)
    return lambda u, v: sum(weight * value(u, v) for value, weight in layers) / total


def png(name, kind, rows):
    chunk = lambda tag, data: struct.pack(">I", len(data)) + tag + data + struct.pack(">I", zlib.crc32(tag + data))
    wide = len(rows[0]) // (3 if kind == 2 else 1)
    head = struct.pack(">IIBBBBB", wide, len(rows), 8, kind, 0, 0, 0)
    body = zlib.compress(b"".join(b"\0" + bytes(row) for row in rows), 9)
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), name)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", body) + chunk(b"IEND", b""))


def byte(x):
    return max(0, min(255, round(255 * x)))


def at(i):
    return (i + 0.5) / SIZE


def bump(u, v):
    """Height of round bumps on a grid of eight by eight."""
    x, y = 8 * u % 1 - 0.5, 8 * v % 1 - 0.5
    return 0.006 * max(0.0, 1 - (x * x + y * y) / 0.16) ** 2


def normal(u, v):
    step = 0.5 / SIZE
    slope = lambda a, b: (bump(u + a, v + b) - bump(u - a, v - b)) / (2 * step)
    x, y = -slope(step, 0), -slope(0, step)
    length = math.sqrt(x * x + y * y + 1)
    return [byte(0.5 + 0.5 * c / length) for c in (x, y, 1.0)]


thickness = octaves(5, 4, 4)
stretched = lambda u, v: min(1, max(0, 0.5 + 1.8 * (thickness(u, v) - 0.5)))
png("thickness.png", 0, [[byte(stretched(at(i), at(j))) for i in range(SIZE)] for j in range(SIZE)])
png("bumps.png", 2, [[c for i in range(SIZE) for c in normal(at(i), at(j))] for j in range(SIZE)])

# Fine, because the model in its figures is as wide as five hundred pixels.
FINE = 384
blotches, wander, streaks, grain = octaves(21, 4, 7, 0.65), octaves(40, 4, 4), octaves(60, 9, 5), octaves(80, 16, 5, 0.7)
patina = lambda u, v: 0.75 * blotches(u, v) + 0.25 * streaks((u + 0.05 * wander(u, v)) % 1, 0.31)
places = [((i + 0.5) / FINE, (j + 0.5) / FINE) for j in range(FINE) for i in range(FINE)]
grown = [patina(*place) for place in places]
ranks = {place: rank for rank, place in enumerate(sorted(range(FINE * FINE), key=lambda place: grown[place]))}
share = [ranks[i] / (FINE * FINE - 1) for i in range(FINE * FINE)]
# Nowhere thinner than half of the thickest: there the patina would be no patina.
crust = [min(1, max(0.5, 0.95 - 0.3 * s + 0.8 * (grain(*place) - 0.5))) for s, place in zip(share, places)]
for name, texels in [("patina.png", share), ("crust.png", crust)]:
    png(name, 0, [[byte(x) for x in texels[j * FINE : (j + 1) * FINE]] for j in range(FINE)])


def tangents(turn):
    """Lines around the middle of the map, which is the front of a ball, turned by an angle; v runs against the bitangent."""

    def texel(u, v):
        x, y = 2 * math.pi * (u - 0.5), -math.pi * (v - 0.5)
        doubled = 2 * (math.atan2(y, x) + turn)
        return [byte(0.5 + 0.5 * math.cos(doubled)), byte(0.5 + 0.5 * math.sin(doubled)), 128]

    return texel


def flakes(u, v):
    """Height of flakes: planes that lie askew, each on a square of a grid of 32 by 32."""
    i, j = int(32 * u), int(32 * v)
    rng = random.Random(32 * j + i + 7)
    x, y = 32 * u - i - 0.5, 32 * v - j - 0.5
    return min(1, max(0, 0.5 + 0.8 * (rng.random() - 0.5) * x + 0.8 * (rng.random() - 0.5) * y))


hue = octaves(11, 3, 3)


def paint(u, v):
    """Stripes of two colours that noise bends."""
    stripe = 0.5 + 0.5 * math.sin(2 * math.pi * (6 * v + 1.5 * hue(u, v)))
    share = min(1, max(0, 4 * (stripe - 0.5) + 0.5))
    return [byte(a + share * (b - a)) for a, b in [(0.85, 0.1), (0.35, 0.3), (0.12, 0.6)]]


def rgb(texel):
    return [[c for i in range(SIZE) for c in texel(at(i), at(j))] for j in range(SIZE)]


png("circles.png", 2, rgb(tangents(0.5 * math.pi)))
png("rays.png", 2, rgb(tangents(0.0)))
png("heights.png", 0, [[byte(flakes(at(i), at(j))) for i in range(SIZE)] for j in range(SIZE)])
png("paint.png", 2, rgb(paint))


def ripples(u, v):
    """Normal of two waves that cross, whole waves along both sides, so that they repeat."""
    a = 2 * math.pi * (4 * u + 2 * v)
    b = 2 * math.pi * (2 * u - 5 * v)
    x, y = -0.25 * math.cos(a) - 0.15 * math.cos(b), -0.12 * math.cos(a) + 0.3 * math.cos(b)
    length = math.sqrt(x * x + y * y + 1)
    return [byte(0.5 + 0.5 * c / length) for c in (x, y, 1.0)]


png("ripples.png", 2, rgb(ripples))


def facets(across, down, columns, rows):
    """Heights of flakes without gaps: triangles between corners of random heights, which are off a grid by up to a third of a cell. Repeats."""
    rng = random.Random(13)
    corner = lambda: (0.66 * (rng.random() - 0.5), 0.66 * (rng.random() - 0.5), rng.random())
    corners = [[corner() for _ in range(columns)] for _ in range(rows)]
    heights = [[0.5] * across for _ in range(down)]

    def point(i, j):
        dx, dy, height = corners[j % rows][i % columns]
        return (i + 0.5 + dx) * across / columns, (j + 0.5 + dy) * down / rows, height

    def fill(a, b, c):
        (ax, ay, ah), (bx, by, bh), (cx, cy, ch) = a, b, c
        area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
        for y in range(math.floor(min(ay, by, cy)), math.ceil(max(ay, by, cy)) + 1):
            for x in range(math.floor(min(ax, bx, cx)), math.ceil(max(ax, bx, cx)) + 1):
                px, py = x + 0.5, y + 0.5
                t = ((px - ax) * (cy - ay) - (cx - ax) * (py - ay)) / area
                s = ((bx - ax) * (py - ay) - (px - ax) * (by - ay)) / area
                if t >= 0 and s >= 0 and t + s <= 1:
                    heights[y % down][x % across] = ah + t * (bh - ah) + s * (ch - ah)

    for j in range(rows):
        for i in range(columns):
            a, b, c, d = point(i, j), point(i + 1, j), point(i, j + 1), point(i + 1, j + 1)
            # The cell is cut along one diagonal or the other, so that no direction is preferred.
            for triangle in [(a, b, c), (b, d, c)] if rng.random() < 0.5 else [(a, b, d), (a, d, c)]:
                fill(*triangle)
    return heights


png("facets.png", 0, [[byte(x) for x in row] for row in facets(512, 256, 64, 32)])
