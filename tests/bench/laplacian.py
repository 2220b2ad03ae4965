# SPDX-License-Identifier: GPL-3.0-or-later
"""The fields of OpenFOAM's laplacianFoam for a known solution, for the benchmarks:

laplacian.py start CASE linear|smooth   writes CASE/0/T, with the solution's values at the
                                        centroids of the boundary's faces
laplacian.py error CASE linear|smooth   prints how far CASE/1/T is from it at the centroids of
                                        cells: the root of the mean square by volume, relative
                                        to the solution's; "diverged" where that is above 1

Needs what postProcess -func writeCellCentres and writeCellVolumes write to time 0. The
solution has no source: linear, or sin 1.5x cos 2y exp 2.5z, in coordinates in which the
longest side of the box around the mesh is 1."""
import math
import os
import re
import sys

NUMBER = r"[-+.\deE]+"


def text_of(case, *path):
    with open(os.path.join(case, *path), encoding="ascii") as stream:
        return stream.read()


def values(text, count):
    """Numbers of a field "uniform VALUE;" or "nonuniform List<type> N (VALUE …);", as lists
    of the same length, `count` of them where it is uniform."""
    kind, rest = re.match(r"\s*(uniform|nonuniform\s+List<\w+>\s*\d+)\s*([^;]*);", text).groups()
    if kind == "uniform":
        return [[float(x) for x in re.findall(NUMBER, rest)]] * count
    if "vector" not in kind:
        return [[float(x)] for x in re.findall(NUMBER, rest)]
    return [[float(x) for x in row.split()] for row in re.findall(r"\(([^()]+)\)", rest)]


def internal(case, *path):
    text = text_of(case, *path)
    cells = int(re.search(r"nCells: *(\d+)", text_of(case, "constant/polyMesh/owner")).group(1))
    return values(text.split("internalField", 1)[1], cells)


def patches(case):
    """(name, centroids) of each."""
    sizes = dict(re.findall(r"(\S+)\s*\{[^{}]*nFaces\s+(\d+);",
                            text_of(case, "constant/polyMesh/boundary")))
    boundary = text_of(case, "0/C").split("boundaryField", 1)[1]
    for name, body in re.findall(r"(\S+)\s*\{([^{}]*)\}", boundary):
        yield name, values(body.split("value", 1)[1], int(sizes[name]))


def solution(case, kind):
    points = text_of(case, "constant/polyMesh/points").split("// *", 1)[-1]
    rows = [row.split() for row in re.findall(r"\(([^()]+)\)", points)]
    box = [[float(row[k]) for row in rows] for k in range(3)]
    low = [min(side) for side in box]
    scale = 1 / max(max(side) - min(side) for side in box)

    def value(point):
        x, y, z = ((p - l) * scale for p, l in zip(point, low))
        if kind == "linear":
            return 1 + 2 * x - 3 * y + z / 2
        return math.sin(1.5 * x) * math.cos(2 * y) * math.exp(2.5 * z)
    return value


def start(case, kind):
    u = solution(case, kind)
    with open(os.path.join(case, "0/T"), "w", encoding="ascii") as out:
        print("FoamFile { version 2.0; format ascii; class volScalarField; object T; }\n"
              "dimensions [0 0 0 1 0 0 0];\ninternalField uniform 0;\nboundaryField\n{", file=out)
        for name, centroids in patches(case):
            print(name, "{ type fixedValue; value nonuniform List<scalar>", len(centroids),
                  "(", *["%.15g" % u(point) for point in centroids], "); }", sep="\n", file=out)
        print("}", file=out)


def error(case, kind):
    u = solution(case, kind)
    off = whole = 0
    for (t,), point, (volume,) in zip(internal(case, "1/T"), internal(case, "0/C"),
                                      internal(case, "0/V")):
        off += volume * (t - u(point)) ** 2
        whole += volume * u(point) ** 2
    relative = math.sqrt(off / whole)
    print("%.2e" % relative if relative < 1 else "diverged")


{"start": start, "error": error}[sys.argv[1]](*sys.argv[2:])
