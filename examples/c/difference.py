#!/usr/bin/env python3
"""How far two pictures of 8 bits are apart, PNG or PPM: difference.py LABEL A B [MEDIAN [NEARLY_ALL]]

Of the pixels that are not black in both, each by its channel that is farthest, in steps of 1/255. Fails where the median is above MEDIAN, or where 1 of
100 pixels is above NEARLY_ALL.
"""

import struct
import sys
import zlib


def read(path):
    """Width and RGB bytes."""
    with open(path, "rb") as file:
        data = file.read()
    return ppm(data) if data[:2] == b"P6" else png(data)


def ppm(data):
    head, texels = data.split(b"\n", 1)
    _, width, height, most = head.split()
    assert most == b"255" and len(texels) == 3 * int(width) * int(height)
    return int(width), texels


def png(data):
    assert data[:8] == b"\x89PNG\r\n\x1a\n", "neither PNG nor PPM"
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, color, _, _, interlaced = struct.unpack(">IIBBBBB", body)
            assert depth == 8 and color in (2, 6) and not interlaced, "RGB or RGBA of 8 bits"
        if kind == b"IDAT":
            packed += body
        at += 12 + length
    channels = 3 if color == 2 else 4
    raw, stride = zlib.decompress(packed), channels * width
    rows, above = [], bytes(stride)
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1 : (y + 1) * (stride + 1)])
        for x in range(stride):
            left = row[x - channels] if x >= channels else 0
            corner = above[x - channels] if x >= channels else 0
            row[x] = (row[x] + (0, left, above[x], (left + above[x]) // 2, paeth(left, above[x], corner))[kind]) & 255
        rows.append(bytes(row))
        above = row
    texels = b"".join(rows)
    return width, texels if channels == 3 else b"".join(texels[i : i + 3] for i in range(0, len(texels), 4))


def paeth(left, above, corner):
    near = left + above - corner
    return min((left, above, corner), key=lambda value: abs(near - value))


def main():
    label, a, b, *limits = sys.argv[1:]
    (width, left), (other, right) = read(a), read(b)
    if width != other or len(left) != len(right):
        sys.exit(f"error: {a} and {b} have different sizes")
    steps = []
    for i in range(0, len(left), 3):
        p, q = left[i : i + 3], right[i : i + 3]
        if any(p) or any(q):
            steps.append(max(abs(x - y) for x, y in zip(p, q)))
    if not steps:
        sys.exit(f"error: {a} and {b} are black")
    steps.sort()
    share = lambda percent: steps[(len(steps) - 1) * percent // 100]
    found = share(50), share(99)
    holds = all(step <= int(limit) for step, limit in zip(found, limits))
    print(f"{'holds' if holds else 'FAILS'}: {label}: median {found[0]} of 255, 95 % within {share(95)}, 99 % within {found[1]}, largest {steps[-1]}, {len(steps)} pixels")
    if not holds:
        sys.exit(f"error: {label}: the limits are {' and '.join(limits)}")


if __name__ == "__main__":
    main()
