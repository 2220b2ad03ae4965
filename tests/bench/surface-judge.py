# SPDX-License-Identifier: GPL-3.0-or-later
"""surface-judge.py [--angle DEG] [--samples N] BEFORE AFTER D: whether the surface of
AFTER is that of BEFORE, moved by no more than D; exit status 1 if not. It shares no code
with what it judges: distances are of dense samples, closest points are VTK's.

BEFORE and AFTER are streams of tetrahedra, or BEFORE an OFF file. D is a part of the
diagonal of BEFORE's bounding box, =D a length. A line for each thing that is looked at:
its value, its limit, ok or FAIL.

surface   faces on the boundary, between different regions, and inside with a marker:
          sampled both ways, with all nodes
curves    edges of these with another number of them than two, between normals that differ
          by more than 40 degrees (--angle), and between different markers, both ways.
          Chains of the second kind that end freely and are shorter than 16 D are noise and
          not asked for, nor are networks of which one in twenty curves ends so, nor any
          where one in twenty of all does: the surface is rough
corners   where other than two curves meet, or two at an angle that the next node of the
          curve does not take back: all are nodes of AFTER
volume    of each region, changed by at most D times the area around it
body      components, Euler number, non-manifold edges, markers and regions there are"""
import argparse
import collections
import math
import sys

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray

NOISE = 16  # a chain that ends freely and is shorter than so many D is noise
ROUGH = 20  # a network is rough where one of so many curves ends so,
SOME = 10  # and more than so many do
SLACK = 1e-9  # of D, and of the diagonal: rounding
FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])


class Mesh:
    """Nodes, tetrahedra and regions (or none), faces of the surface and their markers."""

    def __init__(self, path):
        with open(path, encoding="ascii") as file:
            lines = [line.split() for line in file if line.strip() and line[0] != "#"]
        self.tets = np.zeros((0, 4), int)
        self.regions = np.zeros(0)
        if lines[0] == ["termesh", "1"]:
            self.read_stream(lines)
        else:
            self.read_off(lines)
        self.find_edges()

    def read_off(self, lines):
        rows = lines[1:] if len(lines[0]) == 1 else [lines[0][1:]] + lines[1:]
        nodes, faces = int(rows[0][0]), int(rows[0][1])
        self.xyz = np.array([row[:3] for row in rows[1:nodes + 1]], float)
        polygons = [list(map(int, row[1:int(row[0]) + 1]))
                    for row in rows[nodes + 1:nodes + 1 + faces]]
        self.faces = np.array([[p[0], p[i], p[i + 1]] for p in polygons
                               for i in range(1, len(p) - 1)])
        self.markers = np.zeros(len(self.faces), int)
        self.boundary = self.faces

    def read_stream(self, lines):
        blocks, at = {}, 1
        while lines[at][0] != ".end":
            count = int(lines[at + 1][0])
            blocks[lines[at][0]] = lines[at + 1], lines[at + 2:at + 2 + count]
            at += 2 + count
        base = int(blocks[".node"][1][0][0])
        self.xyz = np.array([row[1:4] for row in blocks[".node"][1]], float)
        header, rows = blocks[".ele"]
        self.tets = np.array([row[1:5] for row in rows], int) - base
        self.regions = np.array([float(row[5]) if int(header[2]) else 0 for row in rows])
        header, rows = blocks.get(".face", (["0", "0"], []))
        marker = {tuple(sorted(int(v) - base for v in row[1:4])):
                  int(row[4]) if int(header[1]) else 0 for row in rows}
        sides = collections.defaultdict(list)
        for t, corners in enumerate(self.tets[:, FACES].tolist()):
            for face in corners:
                sides[tuple(sorted(face))].append((t, face))
        chosen = [(key, of) for key, of in sides.items() if len(of) == 1 or
                  self.regions[of[0][0]] != self.regions[of[1][0]] or marker.get(key, 0)]
        self.faces = np.array([of[0][1] for _, of in chosen])
        self.markers = np.array([marker.get(key, 0) for key, _ in chosen])
        self.boundary = np.array([of[0][1] for _, of in chosen if len(of) == 1])
        self.owners = [[t for t, _ in of] for _, of in chosen]
        self.all_faces = len(sides)
        self.sides = sides

    def find_edges(self):
        edges = collections.defaultdict(list)
        for f, (a, b, c) in enumerate(self.faces.tolist()):
            for u, v in ((a, b), (b, c), (c, a)):
                edges[min(u, v), max(u, v)].append((f, u < v))
        self.edges = edges

    def areas(self):
        p = self.xyz[self.faces]
        return np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1) / 2

    def normals(self):
        """Of length 1; 0 where a triangle is so thin that it has none."""
        p = self.xyz[self.faces]
        n = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
        longest = max(1e-300, float(np.linalg.norm(np.ptp(self.xyz, axis=0))))
        size = np.linalg.norm(n, axis=1)
        edge = np.max([np.linalg.norm(p[:, i] - p[:, i - 1], axis=1) for i in range(3)],
                      axis=0)
        return np.where((size > 1e-6 * longest * edge)[:, None],
                        n / np.maximum(size, 1e-300)[:, None], 0)

    def thin_normals(self):
        """Thin ones have that of the face beyond their longest edge."""
        normal = self.normals()
        for f in np.flatnonzero(~normal.any(axis=1)):
            at, sign = f, 1
            for _ in range(16):
                v = self.faces[at].tolist()
                u, w = max(((v[i - 1], v[i]) for i in range(3)),
                           key=lambda e: np.linalg.norm(self.xyz[e[0]] - self.xyz[e[1]]))
                beside = self.edges[min(u, w), max(u, w)]
                if len(beside) != 2:
                    break
                if beside[0][1] == beside[1][1]:
                    sign = -sign
                at = beside[0][0] if beside[1][0] == at else beside[1][0]
                if normal[at].any():
                    normal[f] = sign * normal[at]
                    break
        return normal

    def curves(self, angle, markers_count):
        """Feature edges with whether they are so by their angle alone."""
        normal, least = self.thin_normals(), math.cos(math.radians(angle))
        found = {}
        for edge, beside in self.edges.items():
            if len(beside) != 2:
                found[edge] = False
                continue
            (a, turns_a), (b, turns_b) = beside
            if markers_count and self.markers[a] != self.markers[b]:
                found[edge] = False
            elif normal[a].any() and normal[b].any():
                cosine = float(normal[a] @ normal[b])
                if (cosine if turns_a != turns_b else -cosine) < least:
                    found[edge] = True
        return found

    def volume(self):
        p = self.xyz[self.tets]
        each = np.einsum("ij,ij->i", np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]),
                         p[:, 3] - p[:, 0]) / 6
        return {r: float(each[self.regions == r].sum()) for r in np.unique(self.regions)}

    def around(self):
        """The area around each region."""
        area = collections.Counter()
        for a, owners in zip(self.areas(), self.owners):
            for r in {float(self.regions[t]) for t in owners}:
                area[r] += float(a)
        return area

    def body(self):
        """Counts that have to be the same."""
        root = list(range(len(self.tets)))

        def find(x):
            while root[x] != x:
                root[x] = root[root[x]]
                x = root[x]
            return x

        for of in self.sides.values():
            if len(of) == 2 and self.regions[of[0][0]] == self.regions[of[1][0]]:
                root[find(of[0][0])] = find(of[1][0])
        pairs = np.array([[i, j] for i in range(4) for j in range(i)])
        edges = np.unique(np.sort(self.tets[:, pairs].reshape(-1, 2), axis=1), axis=0)
        nodes = len(np.unique(self.tets))
        outer = collections.Counter()
        for a, b, c in self.boundary.tolist():
            for u, v in ((a, b), (b, c), (c, a)):
                outer[min(u, v), max(u, v)] += 1
        return {"components": len({find(t) for t in range(len(self.tets))}),
                "Euler number": nodes - len(edges) + self.all_faces - len(self.tets),
                "non-manifold edges": sum(n != 2 for n in outer.values()),
                "regions": sorted(set(self.regions.tolist())),
                "markers": sorted(set(self.markers.tolist()))}


def at_nodes(found):
    at = collections.defaultdict(list)
    for edge in found:
        at[edge[0]].append(edge)
        at[edge[1]].append(edge)
    return at


def free_chains(mesh, found, least):
    """Chains of edges that are sharp by their angle, end freely and are shorter."""
    at = at_nodes(found)
    for v, here in at.items():
        if len(here) != 1:
            continue
        chain, length, node = [here[0]], 0, v
        while True:
            edge = chain[-1]
            length += float(np.linalg.norm(mesh.xyz[edge[0]] - mesh.xyz[edge[1]]))
            node = edge[0] if edge[1] == node else edge[1]
            onward = [e for e in at[node] if e != edge]
            if len(onward) != 1 or length >= least:
                break
            chain.append(onward[0])
        if length < least and all(found[e] for e in chain):
            yield chain


def networks(found):
    """Which of the connected networks each edge is in."""
    at, network = at_nodes(found), {}
    for first in found:
        waiting = [] if first in network else [first]
        while waiting:
            edge = waiting.pop()
            if edge not in network:
                network[edge] = first
                waiting.extend(e for v in edge for e in at[v])
    return network


def count_ends(mesh, found, least):
    """Short free chains, and ends of curves, of each network."""
    network, ends, arms = networks(found), collections.Counter(), collections.Counter()
    for chain in free_chains(mesh, found, least):
        ends[network[chain[0]]] += 1
    for here in at_nodes(found).values():
        if len(here) != 2:
            arms[network[here[0]]] += len(here)
    return network, ends, arms


def is_rough(mesh, found, least):
    _, ends, arms = count_ends(mesh, found, least)
    loose = sum(ends.values())
    return loose > SOME and loose * 2 * ROUGH > sum(arms.values())


def drop_rough(mesh, found, least):
    """Networks of which many curves end freely."""
    network, ends, arms = count_ends(mesh, found, least)
    return {e: kind for e, kind in found.items()
            if not kind or ends[network[e]] <= SOME or
            ends[network[e]] * 2 * ROUGH <= arms[network[e]]}


def drop_noise(mesh, found, least):
    found = drop_rough(mesh, found, least)
    while True:
        dropped = {e for chain in free_chains(mesh, found, least) for e in chain}
        if not dropped:
            return found
        found = {e: kind for e, kind in found.items() if e not in dropped}


def corners(mesh, found, angle):
    least, at = math.cos(math.radians(angle)), at_nodes(found)

    def beside(v):
        return [e[0] if e[1] == v else e[1] for e in at[v]]

    def unit(u, v):
        along = mesh.xyz[v] - mesh.xyz[u]
        return along / max(np.linalg.norm(along), 1e-300)

    def turns(v):
        return float(unit(beside(v)[0], v) @ unit(v, beside(v)[1])) < least

    def taken_back(v, before, after):
        """By the next node: the steps of a staircase are no corners."""
        if len(at[after]) != 2 or not turns(after):
            return False
        onward = [w for w in beside(after) if w != v]
        return bool(onward) and float(unit(before, v) @ unit(after, onward[0])) >= least
    return [v for v in at if len(at[v]) != 2 or
            (turns(v) and not taken_back(v, *beside(v)) and
             not taken_back(v, *beside(v)[::-1]))]


def poly_data(xyz, cells):
    """VTK's data of triangles or of lines."""
    data, points, array = vtk.vtkPolyData(), vtk.vtkPoints(), vtk.vtkCellArray()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(xyz, float), deep=1))
    rows = np.hstack([np.full((len(cells), 1), cells.shape[1]), cells])
    array.SetCells(len(cells), numpy_to_vtkIdTypeArray(rows.ravel().astype(np.int64), deep=1))
    data.SetPoints(points)
    if cells.shape[1] == 3:
        data.SetPolys(array)
    else:
        data.SetLines(array)
    return data


def farthest(points, data):
    """The largest distance of the points from the data, and whose it is."""
    locator = vtk.vtkStaticCellLocator()
    locator.SetDataSet(data)
    locator.BuildLocator()
    closest, cell = [0.0] * 3, vtk.vtkGenericCell()
    cell_id, sub_id = vtk.reference(0), vtk.reference(0)
    square = vtk.reference(0.0)
    most, where = 0.0, None
    for p in points.tolist():
        locator.FindClosestPoint(p, closest, cell, cell_id, sub_id, square)
        if square.get() > most:
            most, where = square.get(), p
    return math.sqrt(most), where


def sample_faces(mesh, count):
    """Nodes, and points in a triangular grid as fine as the count allows in each face."""
    spacing = math.sqrt(2 * float(mesh.areas().sum()) / count)
    p = mesh.xyz[mesh.faces]
    longest = np.max([np.linalg.norm(p[:, i] - p[:, i - 1], axis=1) for i in range(3)], axis=0)
    parts = [mesh.xyz[np.unique(mesh.faces)]]
    height = 2 * mesh.areas() / np.maximum(longest, 1e-300)
    along = np.minimum(np.ceil(longest / spacing), 400).astype(int)
    across = np.minimum(np.ceil(height / spacing), 400).astype(int)
    for n in np.unique(np.maximum(2, np.maximum(across, np.sqrt(along * across)).astype(int))):
        some = p[np.maximum(2, np.maximum(across, np.sqrt(along * across)).astype(int)) == n]
        i, j = np.meshgrid(np.arange(n + 1), np.arange(n + 1))
        keep = i + j <= n
        w = np.stack([i[keep], j[keep], n - i[keep] - j[keep]], axis=1) / n
        w = w[w.max(axis=1) < 1]
        parts.append(np.einsum("kc,tcx->tkx", w, some).reshape(-1, 3))
    return np.concatenate(parts)


def sample_curves(mesh, found, count):
    ends = mesh.xyz[np.array(list(found))]
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    parts = [ends.reshape(-1, 3)]
    for (a, b), n in zip(ends, np.ceil(length * count / max(length.sum(), 1e-300)).astype(int)):
        t = (np.arange(n) + 0.5)[:, None] / n
        parts.append(a + t * (b - a))
    return np.concatenate(parts)


class Judge:
    """Prints and remembers."""

    def __init__(self):
        self.failed = False

    def line(self, what, value, limit, good, more=""):
        self.failed |= not good
        print("%-22s %12s %12s %s%s" % (what, value, limit, "ok" if good else "FAIL", more))

    def distance(self, what, found, most, diagonal):
        value, where = found
        more = "" if where is None else "  at %.6g %.6g %.6g" % tuple(where)
        good = value <= most * (1 + SLACK) + SLACK * diagonal
        self.line(what, "%.5g D" % (value / most) if most else "%.3g" % value, "1 D", good,
                  more)


def judge_curves(judge, before, after, options, most, diagonal):
    several = [len(set(m.markers.tolist())) > 1 for m in (before, after)]
    found = [m.curves(options.angle, all(several)) for m in (before, after)]
    if any(is_rough(m, f, NOISE * most) for m, f in zip((before, after), found)):
        found = [{e: kind for e, kind in f.items() if not kind} for f in found]
    found = [drop_noise(m, f, NOISE * most) for m, f in zip((before, after), found)]
    if bool(found[0]) != bool(found[1]):
        judge.line("curves", len(found[1]), len(found[0]), False)
        return
    if not found[0]:
        return
    lines = [poly_data(m.xyz, np.array(list(f))) for m, f in zip((before, after), found)]
    count = options.samples // 4
    judge.distance("curves, from after",
                   farthest(sample_curves(after, found[1], count), lines[0]), most, diagonal)
    judge.distance("curves, from before",
                   farthest(sample_curves(before, found[0], count), lines[1]), most, diagonal)
    there = {tuple(p) for p in after.xyz[np.unique(after.faces)].tolist()}
    of_before = corners(before, found[0], options.angle)
    kept = sum(tuple(before.xyz[v].tolist()) in there for v in of_before)
    judge.line("corners kept", kept, len(of_before), kept == len(of_before))


def judge_body(judge, before, after, most):
    volumes, around = (before.volume(), after.volume()), before.around()
    for region, old in volumes[0].items():
        change = abs(volumes[1].get(region, 0) - old)
        limit = most * around[region]
        judge.line("volume of %g, change" % region, "%.3g" % change, "%.3g" % limit,
                   change <= limit + SLACK * abs(old))
    was, now = before.body(), after.body()
    for key, value in was.items():
        short = [str(v) if len(str(v)) <= 12 else "%d" % len(v) for v in (now[key], value)]
        judge.line(key, *short, now[key] == value)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--angle", type=float, default=40)
    parser.add_argument("--samples", type=int, default=200000)
    parser.add_argument("before")
    parser.add_argument("after")
    parser.add_argument("distance")
    options = parser.parse_args()
    before, after = Mesh(options.before), Mesh(options.after)
    used = before.xyz[np.unique(before.faces)]
    diagonal = float(np.linalg.norm(np.ptp(used, axis=0)))
    text = options.distance
    most = float(text[1:]) if text[0] == "=" else float(text) * diagonal
    judge = Judge()
    judge.distance("surface, from after", farthest(sample_faces(after, options.samples),
                                                   poly_data(before.xyz, before.faces)),
                   most, diagonal)
    judge.distance("surface, from before", farthest(sample_faces(before, options.samples),
                                                    poly_data(after.xyz, after.faces)),
                   most, diagonal)
    judge_curves(judge, before, after, options, most, diagonal)
    if len(before.tets):
        judge_body(judge, before, after, most)
    print("FAIL" if judge.failed else "pass")
    return int(judge.failed)


sys.exit(main())
