# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads mixed elements and octants from a termesh stream, and surfaces from OFF and .mdl
files, into numpy's arrays, for the benchmarks."""
import re

import numpy

BLOCK = re.compile(rb"^([a-z]*\.[a-z]+)[ \t]*$", re.MULTILINE)
OFF_COUNTS = 3


def numbers(text):
    """All numbers of a text."""
    return numpy.fromstring(text, dtype=float, sep=" ")


def blocks_of(path):
    """{name: (header, numbers after it)}, of the text form."""
    with open(path, "rb") as stream:
        text = stream.read()
    if not text.startswith(b"termesh 1"):
        raise ValueError(path + " is no termesh stream")
    found = {}
    starts = list(BLOCK.finditer(text))
    for start, end in zip(starts, starts[1:]):
        lines = text[start.end():end.start()].lstrip().split(b"\n", 1)
        found[start.group(1).decode()] = (
            [int(n) for n in lines[0].split()], numbers(lines[1]) if lines[1:] else [])
    return found


def rows(block, width):
    """A block's rows, without the row's own number."""
    header, values = block
    return values.reshape(header[0], width + 1)[:, 1:]


class Mesh:
    """xyz [n][3]; place [n]: the first attribute of nodes, or 0; elements {k: [m][k]} and
    order {k: [m]}, which of all each of them is; region [elements]: their first attribute, or
    0; side [elements]: of the element's octant, or None."""

    def __init__(self, path):
        blocks = blocks_of(path)
        header, values = blocks[".node"]
        attributes = header[2] if len(header) > 2 else 0
        markers = header[3] if len(header) > 3 else 0
        table = values.reshape(header[0], 4 + attributes + markers)
        self.xyz = table[:, 1:4].copy()
        self.place = table[:, 4] if attributes else numpy.zeros(header[0])
        self.read_elements(blocks[".mix"], int(table[0, 0]) if header[0] else 1)
        self.side = None
        if ".octant" in blocks and ".root" in blocks:
            self.read_octants(blocks[".octant"], blocks[".root"])

    def read_elements(self, block, base):
        """Rows have as many nodes as their second number says."""
        header, values = block
        self.count = header[0]
        whole = values.astype(numpy.int64)
        extra = 2 + (header[1] if len(header) > 1 else 0)
        at, starts, kinds = 0, [], []
        listed = whole.tolist()
        for _ in range(self.count):
            starts.append(at + 2)
            kinds.append(listed[at + 1])
            at += extra + listed[at + 1]
        if at != len(listed):
            raise ValueError("the rows of .mix do not fit its header")
        starts, kinds = numpy.array(starts, int), numpy.array(kinds, int)
        self.region = (values[starts + kinds] if extra > 2 else
                       numpy.zeros(self.count)).astype(int)
        self.elements, self.order = {}, {}
        for k in (4, 5, 6, 8):
            self.order[k] = numpy.flatnonzero(kinds == k)
            where = starts[self.order[k]][:, None] + numpy.arange(k)
            self.elements[k] = whole[where] - base

    def read_octants(self, octant, root):
        """The side of each octant goes to its elements."""
        header, values = root
        table = values.reshape(header[0], -1)
        size = float(table[0, 4])
        header, values = octant
        table = values.reshape(header[0], -1)
        base = int(values[0]) if header[0] else 1
        level, first, end = table[:, 1], table[:, 5].astype(int), table[:, 6].astype(int)
        self.side = numpy.repeat(size / 2.0 ** level, end - first)
        if len(self.side) != self.count or (len(first) and first.min() not in (0, base)):
            raise ValueError("the octants do not have all elements")


def read_off(text):
    """Points and polygons, cut to triangles."""
    lines = re.sub(rb"#[^\n]*", b"", text).split(b"OFF", 1)[1]
    values = numbers(lines)
    n, m = int(values[0]), int(values[1])
    xyz = values[OFF_COUNTS:OFF_COUNTS + 3 * n].reshape(n, 3)
    rest = values[OFF_COUNTS + 3 * n:].astype(numpy.int64)
    if len(rest) == 4 * m and (rest[::4] == 3).all():
        return xyz, rest.reshape(m, 4)[:, 1:]
    triangles, at = [], 0
    for _ in range(m):
        k = int(rest[at])
        polygon = rest[at + 1:at + 1 + k]
        triangles += [(polygon[0], polygon[i], polygon[i + 1]) for i in range(1, k - 1)]
        at += 1 + k
    return xyz, numpy.array(triangles)


def read_mdl(text):
    """Points after ARRAY1<POINT3D>], triangles after ARRAY1<STRING>]."""
    words = text.split()
    at = words.index(b"ARRAY1<POINT3D>]") + 1
    n = int(words[at])
    xyz = numpy.array(words[at + 1:at + 1 + 3 * n], float).reshape(n, 3)
    at = words.index(b"ARRAY1<STRING>]") + 1
    m = int(words[at])
    rest = numpy.array(words[at + 1:at + 1 + 6 * m], float).reshape(m, 6)
    return xyz, rest[:, :3].astype(numpy.int64)


def read_surface(path):
    """Points and triangles; equal points are one."""
    with open(path, "rb") as stream:
        text = stream.read()
    xyz, triangles = (read_mdl if path.endswith(".mdl") else read_off)(text)
    xyz, place = numpy.unique(xyz, axis=0, return_inverse=True)
    return xyz, place.ravel()[triangles]
