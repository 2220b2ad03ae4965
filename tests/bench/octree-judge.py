# SPDX-License-Identifier: GPL-3.0-or-later
"""octree-judge.py --head: prints the head of the table of octree.sh.
octree-judge.py --off SURFACE: prints a surface as OFF.
octree-judge.py [OPTION…] NAME SURFACE MESH: prints a row: what the mesh of a surface is
worth, measured without a line of ours, and what mesh-check makes of it.
octree-judge.py --aims FILE: what is aimed at, and whether it is so on all rows of FILE.

Options: --cpu SECONDS --memory KB of octree-mesh, --status N its exit status, --notes FILE
what it said, --rate N TetGen's elements per CPU second, --figures FILE the row is appended
to as JSON.

The columns:
elements, nodes
s       CPU seconds
B       peak memory by elements
worst, average, <0.2, <=0   J_ENS
defects faces that do not match, edges and nodes where the boundary is not closed or no
        manifold
shells, Euler   of the boundary, and the surface's if they are others
held    boundary nodes that are not on the surface, by the mesh's own account
nodes off  the largest distance of the other boundary nodes to the surface, by its diagonal
cover   the largest distance of the surface to the boundary, by the size of the cell there
corners of the surface that are no node
sharp   the largest distance of sharp edges to the boundary, by the size of the cell there
x tetgen  elements by CPU seconds, times TetGen's
notes   of octree-mesh that name a place
check   mesh-check: ok, its complaints, or where it counts otherwise"""
import argparse
import json
import math
import subprocess
import sys

import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray

import mixed_stream

FACES = {
    4: [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)],
    5: [(0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
    6: [(0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)],
    8: [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)],
}
# Corner and the three edges that leave it, in the positive order; K.
CORNERS = {
    4: [((0, 1, 2, 3), (1, 2, 0, 3), (2, 0, 1, 3), (3, 0, 2, 1))],
    5: [((0, 1, 3, 4), (1, 2, 0, 4), (2, 3, 1, 4), (3, 0, 2, 4)),
        ((4, 2, 1, 0), (4, 3, 2, 1), (4, 0, 3, 2), (4, 1, 0, 3))],
    6: [((0, 2, 1, 3), (1, 0, 2, 4), (2, 1, 0, 5), (3, 4, 5, 0), (4, 5, 3, 1), (5, 3, 4, 2))],
    8: [((0, 1, 3, 4), (1, 2, 0, 5), (2, 3, 1, 6), (3, 0, 2, 7), (4, 7, 5, 0), (5, 4, 6, 1),
         (6, 5, 7, 2), (7, 6, 4, 3))],
}
IDEAL = {4: [math.sqrt(2) / 2], 5: [math.sqrt(6) / 3, 2 * math.sqrt(6) / 9],
         6: [math.sqrt(3) / 2], 8: [1.0]}
QUESTIONABLE = 0.2
SHARP_DEGREES = 40
ON_SURFACE = 1e-9
SAMPLES = 200  # along the diagonal
MOST_PARTS = 64
NAMED = 5  # rows where an aim is missed
FORMAT = ("%-20s %9s %8s %8s %6s %7s %7s %6s %5s %7s %7s %9s %6s %9s %6s %7s %6s %8s %5s  %s")
HEAD = ["", "elements", "nodes", "s", "B", "worst", "average", "<0.2", "<=0", "defects",
        "shells", "Euler", "held", "nodes off", "cover", "corners", "sharp", "x tetgen",
        "notes", "check"]


def qualities(mesh):
    """J_ENS of every element."""
    worst = [numpy.empty(0)]
    for k, elements in mesh.elements.items():
        quality = numpy.full(len(elements), numpy.inf)
        for triples, ideal in zip(CORNERS[k], IDEAL[k]):
            for triple in triples:
                at = mesh.xyz[elements[:, triple]]
                edges = at[:, 1:] - at[:, :1]
                length = numpy.linalg.norm(edges, axis=2)
                with numpy.errstate(divide="ignore", invalid="ignore"):
                    js = numpy.linalg.det(edges) / length.prod(axis=1)
                js = numpy.nan_to_num(js)
                norm = numpy.where(abs(js) > ideal, numpy.sign(js) * (1 + ideal) - js,
                                   js / ideal)
                quality = numpy.minimum(quality, norm)
        worst.append(quality)
    return numpy.concatenate(worst)


def polygons_of(mesh):
    """The faces of all elements as {3 or 4: ([n][3 or 4], [n] elements)}."""
    found = {3: ([numpy.empty((0, 3), int)], [numpy.empty(0, int)]),
             4: ([numpy.empty((0, 4), int)], [numpy.empty(0, int)])}
    for k, elements in mesh.elements.items():
        for face in FACES[k]:
            found[len(face)][0].append(elements[:, face])
            found[len(face)][1].append(mesh.order[k])
    return {k: (numpy.concatenate(f), numpy.concatenate(e)) for k, (f, e) in found.items()}


def first_lowest(faces):
    """Each face turned until its lowest node comes first."""
    k = faces.shape[1]
    shift = (numpy.argmin(faces, axis=1)[:, None] + numpy.arange(k)) % k
    return numpy.take_along_axis(faces, shift, axis=1)


def boundary_of(faces, region):
    """Which faces are there once; which one of two between elements of different regions;
    how many others do not meet exactly one from the other side."""
    turned = first_lowest(faces)
    forward = turned[:, 1] < turned[:, -1]
    alike = turned.copy()
    alike[~forward, 1:] = turned[~forward, :0:-1]
    order = numpy.lexsort(alike.T[::-1])
    alike, forward = alike[order], forward[order]
    new = numpy.ones(len(faces), bool)
    new[1:] = (alike[1:] != alike[:-1]).any(axis=1)
    group = numpy.cumsum(new) - 1
    count = numpy.bincount(group) if len(group) else numpy.empty(0, int)
    ahead = numpy.bincount(group, weights=forward) if len(group) else numpy.empty(0)
    wrong = (count > 2) | ((count == 2) & (ahead != 1))
    second = order[1:][~new[1:] & (region[order[1:]] != region[order[:-1]])]
    return order[count[group] == 1], second, int(count[wrong].sum())


def cut_one_side(triangles, quadrilaterals):
    """How many boundary triangles are half of a boundary quadrilateral."""
    halves = [quadrilaterals[:, [i for i in range(4) if i != j]] for j in range(4)]
    both = [numpy.unique(numpy.sort(faces, axis=1), axis=0)
            for faces in (triangles, numpy.concatenate(halves))]
    return sum(map(len, both)) - len(numpy.unique(numpy.concatenate(both), axis=0))


def labels_of(n, a, b):
    """Numbers of the connected parts of n things of which a[i] and b[i] are joined."""
    label = numpy.arange(n)
    while True:
        low = numpy.minimum(label[a], label[b])
        new = label.copy()
        numpy.minimum.at(new, label[a], low)
        numpy.minimum.at(new, label[b], low)
        new = new[new]
        if (new == label).all():
            return label
        label = new


def corners_of(polygons):
    """All corners of polygons of several sizes: node, the node after it, polygon, and the
    number of the corner before it."""
    node, after, polygon, before = [], [], [], []
    start = first = 0
    for faces in polygons:
        n, k = faces.shape
        node.append(faces.ravel())
        after.append(numpy.roll(faces, -1, axis=1).ravel())
        polygon.append(numpy.repeat(first + numpy.arange(n), k))
        at = start + numpy.arange(n * k).reshape(n, k)
        before.append(numpy.roll(at, 1, axis=1).ravel())
        start, first = start + n * k, first + n
    return tuple(map(numpy.concatenate, (node, after, polygon, before)))


def examine(polygons):
    """Of a surface of polygons: edges where not one meets one the other way, nodes where
    it is no manifold, shells, Euler number."""
    node, after, polygon, before = corners_of(polygons)
    edge = numpy.stack([numpy.minimum(node, after), numpy.maximum(node, after)])
    order = numpy.lexsort(edge)
    edge = edge[:, order]
    new = numpy.ones(len(order), bool)
    new[1:] = (edge[:, 1:] != edge[:, :-1]).any(axis=0)
    group = numpy.cumsum(new) - 1
    count = numpy.bincount(group)
    ahead = numpy.bincount(group, weights=node[order] < after[order])
    good = (count == 2) & (ahead == 1)
    pair = order[good[group]].reshape(-1, 2)
    across = numpy.arange(len(node))
    across[pair[:, 0]], across[pair[:, 1]] = pair[:, 1], pair[:, 0]
    # Around a node: the edge before a corner, seen from the polygon beyond it, begins
    # there; a node has one such round, or it is where two parts touch.
    label, turn = numpy.arange(len(node)), across[before]
    for _ in range(10):
        label, turn = numpy.minimum(label, label[turn]), turn[turn]
    rounds = int((label == numpy.arange(len(node))).sum())
    nodes = len(numpy.unique(node))
    faces = int(polygon.max()) + 1
    part = labels_of(faces, polygon[pair[:, 0]], polygon[pair[:, 1]])
    return {"edges": int((~good).sum()), "nodes": abs(rounds - nodes),
            "shells": len(numpy.unique(part)), "euler": nodes - len(count) + faces}


def examine_walls(polygons):
    """The same where more than two may meet at an edge: connected parts, Euler number."""
    node, after, polygon, _ = corners_of(polygons)
    edge = numpy.stack([numpy.minimum(node, after), numpy.maximum(node, after)])
    faces = int(polygon.max()) + 1
    nodes, place = numpy.unique(node, return_inverse=True)
    part = labels_of(faces + len(nodes), polygon, faces + place)
    return {"shells": len(numpy.unique(part)),
            "euler": len(nodes) - len(numpy.unique(edge, axis=1).T) + faces}


def has_walls(triangles):
    """Whether more than two triangles meet at an edge, an odd number of them."""
    node, after, _, _ = corners_of([triangles])
    edge = numpy.sort(numpy.stack([node, after]), axis=0)
    count = numpy.unique(edge, axis=1, return_counts=True)[1]
    return bool(((count > 2) & (count % 2 == 1)).any())


class Closest:
    """The closest place of a set of triangles."""

    def __init__(self, xyz, triangles):
        data = vtk.vtkPolyData()
        points = vtk.vtkPoints()
        points.SetData(numpy_to_vtk(numpy.ascontiguousarray(xyz), deep=True))
        data.SetPoints(points)
        cells = vtk.vtkCellArray()
        rows = numpy.insert(triangles, 0, 3, axis=1).astype(numpy.int64)
        cells.SetCells(len(triangles), numpy_to_vtkIdTypeArray(rows.ravel(), deep=True))
        data.SetPolys(cells)
        self.data = data
        self.locator = vtk.vtkStaticCellLocator()
        self.locator.SetDataSet(data)
        self.locator.BuildLocator()

    def find(self, points):
        """Distances, and which triangles."""
        distance = numpy.empty(len(points))
        triangle = numpy.empty(len(points), int)
        at, cell = [0.0, 0.0, 0.0], vtk.vtkGenericCell()
        which, part, square = vtk.reference(0), vtk.reference(0), vtk.reference(0.0)
        for i, point in enumerate(points.tolist()):
            self.locator.FindClosestPoint(point, at, cell, which, part, square)
            distance[i] = math.sqrt(square.get())
            triangle[i] = which.get()
        return distance, triangle


def normals_of(xyz, triangles):
    """Of length 1; those without area have none."""
    at = xyz[triangles]
    normal = numpy.cross(at[:, 1] - at[:, 0], at[:, 2] - at[:, 0])
    length = numpy.linalg.norm(normal, axis=1)
    return normal / numpy.where(length > 0, length, 1)[:, None]


def sharp_edges(xyz, triangles):
    """The sharp edges of a closed surface, those where walls meet among them, and the nodes
    where not two of them meet in nearly a line."""
    node, after, triangle, _ = corners_of([triangles])
    edge = numpy.stack([numpy.minimum(node, after), numpy.maximum(node, after)])
    order = numpy.lexsort(edge)
    first = numpy.ones(len(order), bool)
    first[1:] = (edge[:, order[1:]] != edge[:, order[:-1]]).any(axis=0)
    count = numpy.diff(numpy.append(numpy.flatnonzero(first), len(order)))
    one, other = order[first], order[numpy.flatnonzero(first) + 1]
    normal = normals_of(xyz, triangles)
    cosine = (normal[triangle[one]] * normal[triangle[other]]).sum(axis=1)
    one = one[(count > 2) | (cosine < math.cos(math.radians(SHARP_DEGREES)))]
    sharp = numpy.stack([node[one], after[one]], axis=1)
    at = {}
    for a, b in sharp.tolist():
        at.setdefault(a, []).append(b)
        at.setdefault(b, []).append(a)
    limit = -math.cos(math.radians(SHARP_DEGREES))
    corners = []
    for a, others in at.items():
        if len(others) == 2:
            u, v = xyz[others] - xyz[a]
            if u @ v <= limit * math.sqrt((u @ u) * (v @ v)):
                continue
        corners.append(a)
    return sharp, corners


def samples_of(xyz, triangles, spacing):
    """The nodes, and points in each triangle, about so far from each other."""
    at = xyz[triangles]
    longest = numpy.linalg.norm(at - numpy.roll(at, 1, axis=1), axis=2).max(axis=1)
    parts = numpy.clip(numpy.ceil(longest / spacing), 1, MOST_PARTS).astype(int)
    found = [xyz]
    for n in numpy.unique(parts):
        weights = [(3 * i + 1, 3 * j + 1, 3 * (n - 1 - i - j) + 1)
                   for i in range(n) for j in range(n - i)]
        points = numpy.array(weights) / (3.0 * n) @ at[parts == n]
        found.append(points.reshape(-1, 3))
    return numpy.concatenate(found)


def distances(row, mesh, boundary, surface):
    """Both ways, and of what is sharp."""
    xyz, triangles = surface
    diagonal = float(numpy.linalg.norm(xyz.max(axis=0) - xyz.min(axis=0)))
    faces, element = boundary
    nodes = numpy.unique(numpy.concatenate([f.ravel() for f in faces]))
    held = mesh.place[nodes] < 0
    row["boundary_nodes"], row["held"] = len(nodes), int(held.sum())
    off = Closest(xyz, triangles).find(mesh.xyz[nodes[~held]])[0]
    row["nodes_off"] = float(off.max(initial=0)) / diagonal
    cut = numpy.concatenate([faces[0], faces[1][:, :3], faces[1][:, [0, 2, 3]]])
    owner = numpy.concatenate([element[0], element[1], element[1]])
    closest = Closest(mesh.xyz, cut)

    def by_cell(points):
        """The largest distance to the boundary, by the size of the cell there."""
        if not len(points):
            return 0.0
        distance, which = closest.find(points)
        if mesh.side is not None:
            size = mesh.side[owner[which]]
        else:
            at = mesh.xyz[cut[which]]
            size = numpy.linalg.norm(at - numpy.roll(at, 1, axis=1), axis=2).max(axis=1)
        return float((distance / size).max())

    row["cover"] = by_cell(samples_of(xyz, triangles, diagonal / SAMPLES))
    sharp, corners = sharp_edges(xyz, triangles)
    row["sharp"] = by_cell(xyz[sharp].mean(axis=1))
    lost = 0
    for corner in xyz[corners]:
        gap = numpy.linalg.norm(mesh.xyz[nodes] - corner, axis=1).min()
        lost += bool(gap > ON_SURFACE * diagonal)
    row["corners"], row["corners_lost"] = len(corners), lost


def examine_mesh(row, mesh, surface):
    """What can be measured of a mesh."""
    quality = qualities(mesh)
    row.update(elements=mesh.count, nodes=len(mesh.xyz), worst=float(quality.min()),
               average=float(quality.mean()), bad=int((quality < QUESTIONABLE).sum()),
               not_positive=int((quality <= 0).sum()))
    faces, element, walls, wrong = [], [], [], 0
    for polygons, owner in polygons_of(mesh).values():
        once, between, more = boundary_of(polygons, mesh.region[owner])
        faces.append(polygons[once])
        element.append(owner[once])
        walls.append((polygons[between], owner[between]))
        wrong += more
    wrong += cut_one_side(*faces)
    boundary = examine(faces)
    row.update(faces=wrong, edges=boundary["edges"], vertices=boundary["nodes"],
               shells=boundary["shells"], euler=boundary["euler"],
               outer_euler=boundary["euler"],
               boundary_faces=sum(map(len, faces)))
    body = examine([surface[1]])
    if has_walls(surface[1]):  # between regions, too
        faces = [numpy.concatenate([f, w[0]]) for f, w in zip(faces, walls)]
        element = [numpy.concatenate([e, w[1]]) for e, w in zip(element, walls)]
        row.update(examine_walls(faces))
        body = examine_walls([surface[1]])
    row.update(surface_shells=body["shells"], surface_euler=body["euler"])
    distances(row, mesh, (faces, element), surface)


def check(row, path):
    """mesh-check's complaints, or what it counts otherwise."""
    try:
        run = subprocess.run(["mesh-check", "-q", "--json", "-", path],
                             stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False)
        told = json.loads(run.stdout)
    except (OSError, ValueError):
        return "-"
    numbers = ["nodes", "elements", "tetrahedra", "pyramids", "wedges", "hexahedra",
               "boundary_faces", "components", "euler", "volume", "area"]
    found = ["%d %s" % (count, key.replace("_", " ")) for key, count in told.items()
             if isinstance(count, (int, float)) and count and key not in numbers]
    # Of the solid: half of the boundary's; a solid with a void has two shells.
    told["boundary's euler"] = 2 * told["euler"]
    own = {"elements": row["elements"], "boundary_faces": row["boundary_faces"],
           "boundary's euler": row["outer_euler"]}
    found += ["%s %d" % (key, told[key]) for key, mine in own.items() if told[key] != mine]
    if told["components"] > row["shells"]:
        found.append("components %d" % told["components"])
    return ", ".join(found) or "ok"


def print_row(row):
    """One line; what is not known is "-"."""
    def text(form, value):
        return "-" if value is None else form % value

    def beside(key):
        value, of_surface = row[key], row["surface_" + key]
        return "%d" % value if value == of_surface else "%d(%d)" % (value, of_surface)

    print(FORMAT % (
        row["name"], row["elements"], row["nodes"], text("%.3f", row["cpu"]),
        text("%.0f", row["bytes"]), "%.4f" % row["worst"], "%.4f" % row["average"],
        row["bad"], row["not_positive"],
        "%d/%d/%d" % (row["faces"], row["edges"], row["vertices"]), beside("shells"),
        beside("euler"), row["held"], "%.1e" % row["nodes_off"], "%.2f" % row["cover"],
        "%d/%d" % (row["corners_lost"], row["corners"]), "%.2f" % row["sharp"],
        text("%.2f", row["times_tetgen"]), row["notes"], row["check"]), flush=True)


def aims(path):
    """What is aimed at, and where it is not so."""
    with open(path, encoding="utf-8") as lines:
        rows = [json.loads(line) for line in lines]

    def aim(what, holds, among=None):
        chosen = [row for row in rows if among is None or among(row)]
        failed = [row["name"] for row in chosen if not holds(row)]
        told = "NO, %d of %d: %s" % (len(failed), len(chosen), ", ".join(failed[:NAMED]))
        if not failed:
            told = "yes" if chosen else "nothing to measure"
        elif len(failed) > NAMED:
            told += " ..."
        print("  aim: %-66s %s" % (what, told))

    large = 100000
    aim("all faces matched, boundary closed and manifold",
        lambda r: r["faces"] == r["edges"] == r["vertices"] == 0)
    aim("shells and Euler number of the surface, or a note",
        lambda r: r["notes"] or (r["shells"], r["euler"]) ==
        (r["surface_shells"], r["surface_euler"]))
    aim("no element with J_ENS <= 0", lambda r: r["not_positive"] == 0)
    aim("boundary nodes within 1e-9 of the diagonal", lambda r: r["nodes_off"] <= ON_SURFACE)
    aim("of them at most 0.1 % held back", lambda r: r["held"] <= 0.001 * r["boundary_nodes"])
    aim("the surface within a cell of the boundary, or a note",
        lambda r: r["notes"] or r["cover"] <= 1)
    aim("corners are nodes, or a note", lambda r: r["notes"] or r["corners_lost"] == 0)
    aim("average J_ENS >= 0.806, cortex -s 5 -r", lambda r: r["average"] >= 0.806,
        lambda r: r["name"].startswith("cortex.mdl -s 5 -r"))
    aim("average J_ENS >= 0.553, cortex -s 6", lambda r: r["average"] >= 0.553,
        lambda r: r["name"] == "cortex.mdl -s 6")
    aim("fewer than 100 elements below 0.2, cortex -s 5 -r and -s 6", lambda r: r["bad"] < 100,
        lambda r: r["name"] == "cortex.mdl -s 6" or r["name"].startswith("cortex.mdl -s 5 -r"))
    aim("5 times TetGen's elements by CPU seconds", lambda r: r["times_tetgen"] >= 5,
        lambda r: r["times_tetgen"] is not None)
    aim("at most 300 bytes by element, of %d and more" % large, lambda r: r["bytes"] <= 300,
        lambda r: r["bytes"] is not None and r["elements"] >= large)
    aim("exit status 0", lambda r: r["status"] == 0)
    aim("mesh-check says the same", lambda r: r["check"] == "ok")


def main():
    parser = argparse.ArgumentParser()
    for option, kind in [("--cpu", float), ("--memory", float), ("--status", int),
                         ("--notes", str), ("--rate", float), ("--figures", str)]:
        parser.add_argument(option, type=kind)
    for option in ("--head", "--off", "--aims"):
        parser.add_argument(option, action="store_true")
    parser.add_argument("files", nargs="*")
    args = parser.parse_args()
    if args.head:
        print(FORMAT % tuple(HEAD))
    elif args.aims:
        aims(args.files[0])
    elif args.off:
        xyz, triangles = mixed_stream.read_surface(args.files[0])
        print("OFF\n%d %d 0" % (len(xyz), len(triangles)))
        numpy.savetxt(sys.stdout, xyz, "%.17g")
        numpy.savetxt(sys.stdout, triangles, "3 %d %d %d")
    else:
        name, surface, path = args.files
        mesh = mixed_stream.Mesh(path)
        row = {"name": name, "cpu": args.cpu, "status": args.status, "notes": 0}
        if args.notes:
            with open(args.notes, encoding="utf-8", errors="replace") as notes:
                row["notes"] = sum(" near (" in line for line in notes)
        examine_mesh(row, mesh, mixed_stream.read_surface(surface))
        row["bytes"] = args.memory and 1024 * args.memory / mesh.count
        row["times_tetgen"] = (args.cpu and args.rate and
                               mesh.count / args.cpu / args.rate)
        row["check"] = check(row, path)
        print_row(row)
        if args.figures:
            with open(args.figures, "a", encoding="utf-8") as figures:
                print(json.dumps(row), file=figures)


if __name__ == "__main__":
    main()
