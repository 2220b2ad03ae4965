# SPDX-License-Identifier: GPL-3.0-or-later
"""thesis-lepp.py FOLDER MESH...: prints the tables of Balboa (2020), ours beside his,
from lepp-improve's reports FOLDER/MESH/NUMBER/WAY.json. Of the numbers medians count."""
import glob
import json
import statistics
import sys

FACTORS = ["m=1.00", "m=1.05", "m=1.08", "m=1.10", "m=1.15", "m=1.20"]
# Of swap-centroid 4.2.2 to the letter; and --path fixed, which is compared with the same.
FIXED = "swap-centroid, fixed"
WAYS = ["original", "swap-centroid", FIXED, *FACTORS]
SWEEPS = ["m=1.10", "m=1.10, smooth", "m=1.10, face-swap", "m=1.10, both"]
ANGLES = ["<5", "<10", "<15", "<20", "<25", "<30", ">150", ">160", ">170", ">175"]
VOLUMES = ["<0.05", "<0.1", "<0.15", "<0.2", "<0.25", "<0.3"]
SIZES = range(3, 9)  # of closed stars that have a column; the last is of all larger ones
SIZE_HEAD = [str(size) for size in SIZES] + [">8"]


def published(text):
    """Rows of the thesis: a way, and numbers as they are printed there."""
    return {line.split()[0]: line.split()[1:] for line in text.strip().splitlines()}


THEIRS = ["Retinal", "P", "N090", "Femur", "RND2000"]
TABLE_7_1 = published("""
original      1374 926 2623 52848 13016
swap-centroid 4893 1443 28393 270789 45978
m=1.00        5276 1140 19627 187808 55015
m=1.05        3489 1055 11059 132460 35409
m=1.08        2623 1024 8766 114138 30562
m=1.10        2426 1019 7687 105163 28307
m=1.15        1990 992 6741 90028 24191
m=1.20        1757 977 6219 80034 21081
""")
TABLE_7_2 = published("""
swap-centroid 3.56 1.56 10.82 5.12 3.53
m=1.00        3.84 1.23 7.48 3.55 4.23
m=1.05        2.54 1.14 4.22 2.51 2.72
m=1.08        1.91 1.11 3.34 2.16 2.35
m=1.10        1.77 1.10 2.93 1.99 2.17
m=1.15        1.45 1.07 2.57 1.70 1.86
m=1.20        1.28 1.06 2.37 1.51 1.62
""")
# The tables of one mesh have their number in front: of the angles, of the cost, of the
# volumes.
FEMUR = ("7.9", published("""
original      0.09 0.85 2.72 5.21 8.17 11.70 1.61 0.60 0.10 0.01
swap-centroid 0.02 0.09 0.23 0.50 1.14 2.48 0.27 0.11 0.03 0.01
m=1.00        0.00 0.02 0.06 0.16 0.62 2.05 0.08 0.02 0.00 0.00
m=1.05        0.01 0.05 0.12 0.36 1.19 3.22 0.17 0.05 0.01 0.00
m=1.08        0.01 0.06 0.15 0.49 1.57 3.87 0.22 0.06 0.01 0.00
m=1.10        0.01 0.07 0.18 0.59 1.79 4.26 0.25 0.07 0.01 0.00
m=1.15        0.01 0.09 0.26 0.85 2.34 5.11 0.32 0.09 0.02 0.00
m=1.20        0.00 0.01 0.06 0.39 1.72 4.34 0.5 0.1 0.00 0.00
"""), "7.10", published("""
original      52848 1.00 42.99 -
swap-centroid 270789 5.12 18.22 61.43
m=1.00        187808 3.55 10.08 140.958
m=1.05        132460 2.51 15.25 114.456
m=1.08        114138 2.16 18.07 105.599
m=1.10        105163 1.99 19.71 105.116
m=1.15        90028 1.70 23.27 93.72
m=1.20        80034 1.51 26.13 83.64
"""), "8.4", published("""
original      7.12 33.51 56.44 71.26 80.81 86.90
swap-centroid 0.87 5.79 15.56 28.87 43.34 57.22
m=1.00        1.65 10.95 24.95 40.06 54.49 67.08
m=1.05        2.90 16.10 32.15 47.38 60.75 72.05
m=1.08        3.50 18.93 35.79 50.86 63.82 74.40
m=1.10        3.84 20.33 37.75 52.90 65.66 75.80
m=1.15        4.55 23.25 41.76 56.90 69.03 78.35
m=1.20        5.18 25.46 44.91 59.96 71.50 80.26
"""))
RND2000 = ("7.11", published("""
original      1.98 4.34 7.27 10.55 14.13 18.13 4.41 2.70 1.23 0.65
swap-centroid 2.20 3.85 5.30 6.87 8.75 11.31 3.68 2.62 1.50 0.82
m=1.00        0.37 0.87 1.47 2.19 3.30 5.17 1.27 0.77 0.35 0.16
m=1.05        0.45 0.93 1.50 2.30 3.64 5.92 1.28 0.78 0.38 0.19
m=1.08        0.53 1.06 1.70 2.63 4.16 6.79 1.43 0.86 0.44 0.23
m=1.10        0.55 1.12 1.84 2.84 4.50 7.22 1.52 0.91 0.46 0.24
m=1.15        0.65 1.33 2.16 3.36 5.29 8.47 1.73 1.05 0.52 0.28
m=1.20        0.74 1.50 2.42 3.82 5.98 9.42 1.89 1.15 0.57 0.32
"""), "7.12", published("""
original      13016 1.00 55.43 -
swap-centroid 45978 3.53 34.75 9.41
m=1.00        55015 4.23 19.04 48.37
m=1.05        35409 2.72 22.34 34.702
m=1.08        30562 2.35 25.77 30.505
m=1.10        28307 2.17 27.52 30.456
m=1.15        24191 1.86 32.09 25.176
m=1.20        21081 1.62 35.53 22.198
"""), "8.5", published("""
original      11.09 22.76 35.77 49.25 61.57 72.31
swap-centroid 11.16 20.04 31.22 44.81 58.37 70.41
m=1.00        6.42 13.46 25.07 39.87 54.94 68.20
m=1.05        6.40 14.22 27.11 42.58 57.32 69.97
m=1.08        6.80 15.48 28.79 44.78 59.54 71.72
m=1.10        7.36 16.51 30.25 46.12 60.47 72.52
m=1.15        8.02 18.17 32.73 48.45 62.59 74.31
m=1.20        8.47 19.00 33.49 49.26 63.30 74.95
"""))
OURS = ("as 7.3, 7.5, 7.7", {}, "as 7.4, 7.6, 7.8", {}, "as 8.1 to 8.3", {})
THESIS = {"rnd2000": RND2000, "femur": FEMUR}
TABLE_9_1 = published("""
P       70.21 29.43 0.36 0
Retinal 89.68 7.04 3.28 0
N090    59.81 29.03 9.44 1.72
Femur   93.05 5.51 1.39 0.05
RND2000 84.16 5.15 7.56 3.13
""")


def load(mesh, way):
    """The reports of a way; of "original", reports that nothing was done."""
    name = WAYS[1] if way == "original" else way
    path = "%s/%s/*/%s.json" % (sys.argv[1], mesh, name)
    runs = []
    for found in sorted(glob.glob(path)):
        with open(found, encoding="ascii") as report:
            runs.append(json.load(report))
    if way == "original":
        runs = [dict(run, after=run["before"], seconds=None) for run in runs]
    return runs


def median(values):
    """None where one is not known."""
    return None if None in values else statistics.median(values)


def medians(mesh, way, figures):
    """Column by column of what figures(report) gives."""
    return [median(column) for column in zip(*map(figures, load(mesh, way)))]


def shown(values, digits=2):
    """Numbers as text; a list has digits for each."""
    digits = digits if isinstance(digits, list) else [digits] * len(values)
    return ["-" if v is None else "%.*f" % (d, v) for v, d in zip(values, digits)]


def table(title, head, rows):
    """Prints rows of a name and texts."""
    widths = [max(7, len(h)) for h in head]
    margin = max([24] + [len(name) for name, _ in rows])
    print("\n" + title)
    for name, cells in [("", head), *rows]:
        line = "".join(" %*s" % cell for cell in zip(widths, cells))
        print(("%-*s%s" % (margin, name, line)).rstrip())


def as_printed(way):
    """The way that has its figures in the thesis."""
    return "swap-centroid" if way == FIXED else way


def percent(part, whole):
    return 100 * part / whole if whole else None


def ratio(run):
    return run["after"]["tets"] / run["before"]["tets"]


def by_mesh(title, meshes, theirs, figure, digits):
    """Tables 7.1 and 7.2: a column for each mesh."""
    rows = []
    for way in WAYS:
        ours = [medians(mesh, way, lambda run: [figure(run)])[0] for mesh in meshes]
        if as_printed(way) in theirs:
            rows.append((way, shown(ours, digits) + theirs[as_printed(way)]))
    table(title, meshes + THEIRS, rows)


def by_way(title, head, mesh, theirs, figures, digits=2, extra=()):
    """A table of one mesh: a row for each way, and his below."""
    rows = []
    for way in [*WAYS, *extra]:
        rows.append((way, shown(medians(mesh, way, figures), digits)))
        if as_printed(way) in theirs:
            rows.append(("  thesis", theirs[as_printed(way)]))
    table(title + ": " + mesh + ("" if theirs else ", a mesh of our own"), head, rows)


def cost(run):
    after = run["after"]
    return [after["tets"], ratio(run), after["bad_percent"], run["seconds"]]


def angles(run):
    return [run["after"]["dihedral_percent"][key] for key in ANGLES]


def volumes(run):
    return [run["after"]["volume_quality_percent"][key] for key in VOLUMES]


def chapter_7(meshes):
    by_mesh("Table 7.1: tetrahedra", meshes, TABLE_7_1, lambda r: r["after"]["tets"], 0)
    by_mesh("Table 7.2: times the original", meshes, TABLE_7_2, ratio, 2)
    for mesh in meshes:
        angle_table, their_angles, cost_table, their_cost, _, _ = THESIS.get(mesh, OURS)
        by_way("Table %s: dihedral angles, %%" % angle_table, ANGLES, mesh, their_angles,
               angles)
        by_way("Table %s: size, bad tetrahedra, CPU seconds" % cost_table,
               ["total", "ratio", "bad%", "s"], mesh, their_cost, cost, [0, 2, 2, 3],
               ["m=1.00, 5 passes"])


def sweeps(run):
    """What the sweeps did and came to."""
    share = run["after"]["dihedral_percent"]
    smoothing, swaps = run.get("smoothing"), run.get("face_swaps")
    return [*cost(run)[1:3], share["<15"], share["<30"] - share["<15"], share[">150"],
            smoothing and smoothing["moved"], swaps and swaps["swapped"],
            swaps and swaps["by_sweep"][0], run["seconds"]]


def distance(mesh):
    """How far the two kinds of swap-centroid are from what is printed: 18 columns."""
    _, their_angles, _, their_cost, _, their_volumes = THESIS[mesh]
    name = "swap-centroid"
    printed = [*map(float, their_cost[name][1:3] + their_angles[name] + their_volumes[name])]
    rows = []
    for way in [name, FIXED]:
        ours = medians(mesh, way, lambda run: cost(run)[1:3] + angles(run) + volumes(run))
        off = [100 * abs(our / his - 1) for our, his in zip(ours, printed)]
        rows.append((way, shown([statistics.mean(off), statistics.median(off), max(off)])))
    table("swap-centroid beside the thesis, ratio, bad%, 7.11 and 8.5, % off: " + mesh,
          ["mean", "median", "most"], rows)


def section_7_4(meshes):
    head = ["ratio", "bad%", "<15", "15-30", ">150", "moved", "swapped", "first", "s"]
    for mesh in meshes:
        rows = [(way, shown(medians(mesh, way, sweeps), [2] * 5 + [0] * 3 + [3]))
                for way in SWEEPS]
        if mesh == "rnd2000":  # the shares: from table 7.11
            rows.insert(1, ("  thesis", "2.17 27.52 1.84 5.38 1.52 - - - 30.456".split()))
            rows.insert(4, ("  thesis", "- - - - - - 20 -".split()))
        table("Section 7.4, selective with sweeps: " + mesh, head, rows)
    print("""
swapped: faces, in all and in the first sweep. The thesis, which has pictures here and
no more numbers: smoothing helps little, but visibly on random points (7.4.1); face
swaps help visibly, though there are few, and on Retinal most between 15 and 30 degrees
(7.4.2).""")


def chapter_8(meshes):
    for mesh in meshes:
        number, theirs = THESIS.get(mesh, OURS)[4:]
        by_way("Table %s: tetrahedra by volume quality, %%" % number, VOLUMES, mesh,
               theirs, volumes)


def looked_at(stars):
    return stars["closed"] + stars["open"]


def visits(run):
    """Targets by the stars visited. There is no mean of more than one pass: in the later
    ones a path may end at a star that was refused before, and is not looked at again."""
    stars, targets = run["stars"], run["targets"]
    up_to = [percent(sum(stars["visited"][:n + 1]), targets) for n in [0, 1, 2, 10]]
    mean = looked_at(stars) / targets if run["passes"] == 1 else None
    return [up_to[0], percent(stars["visited"][1], targets), *up_to[2:], mean,
            stars["most_visited"]]


def centroids(run):
    """Table 9.1; and closed stars whose edge no valid removal takes."""
    stars, invalid = run["stars"], run["stars"]["invalid_centroids"]
    tried = run["operations"]["edge_removals"] > 0
    counts = [stars["closed"] - invalid["tangled"] - invalid["outside"], stars["open"],
              invalid["tangled"], invalid["outside"]]
    if tried:
        counts.append(stars["invalid_swaps"])
    shares = [percent(count, looked_at(stars)) for count in counts]
    return shares if tried else shares + [None]


def largest(counts):
    return max((size for size, count in enumerate(counts) if count), default=None)


def by_size(counts):
    """Counts by size: a column for each, the last one for all that are larger."""
    return [counts[size] for size in SIZES] + [sum(counts[SIZES[-1] + 1:])]


def closed_sizes(run):
    sizes, stars = run["stars"]["sizes"], run["stars"]
    closed, count = sizes["closed"], stars["closed"]
    shares = [percent(n, count) for n in by_size(closed)]
    small = sum(closed[:7]) + sum(sizes["open"][:7])
    return [*shares, percent(sum(closed[4:7]), count), percent(sum(closed[:7]), count),
            percent(small, looked_at(stars)), largest(closed)]


def open_sizes(run):
    sizes, count = run["stars"]["sizes"]["open"], run["stars"]["open"]
    shares = [percent(n, count) for n in sizes[1:7]]
    return [*shares, percent(sum(sizes[7:]), count), largest(sizes)]


def operations(run):
    """What is done with closed stars, and how many open ones are refused."""
    stars = run["stars"]
    sizes, refused = stars["sizes"], stars["refused"]
    return [percent(refused["closed"], stars["closed"]),
            percent(sum(sizes["swapped"]), stars["closed"]),
            percent(sum(sizes["inserted"]), stars["closed"]),
            percent(refused["open"], stars["open"]),
            percent(stars["open"], looked_at(stars))]


def of_size(key):
    """The share of one operation among the closed stars of each size."""
    def figures(run):
        sizes = run["stars"]["sizes"]
        return list(map(percent, by_size(sizes[key]), by_size(sizes["closed"])))
    return figures


def swaps_of_changed(run):
    """The share of edge removals among the closed stars that are changed, by size."""
    sizes = run["stars"]["sizes"]
    swapped, inserted = by_size(sizes["swapped"]), by_size(sizes["inserted"])
    return [percent(s, s + i) for s, i in zip(swapped, inserted)]


def by_star(title, head, meshes, ways, figures, digits, theirs):
    """A table of chapter 9: rows for each mesh and way, then what the thesis has."""
    rows = [(mesh + " " + way, shown(medians(mesh, way, figures), digits))
            for mesh in meshes for way in ways]
    rows += [("  thesis: " + name, cells) for name, cells in theirs.items()]
    table(title, head, rows)


SELECTIVE = "m=1.10"
STOPS = ["m=1.10, one pass", SELECTIVE]
ALL_STARS = ["centroid", "swap-centroid", *STOPS]


def section_9_1_to_9_2(meshes):
    by_star("Section 9.1: targets by terminal stars visited, %",
            ["0", "1", "<=2", "<=10", "mean", "most"], meshes, ALL_STARS, visits,
            [2] * 5 + [0], {"Femur, centroid": ["-", "41.48"],
                            "all, centroid": ["-", "~40", "50-80", "75-99"],
                            "Femur, selective": ["38.99"],
                            "all, selective": ["-", "-", ">50"]})
    print("""
0: the longest edge was refused before. With more than one pass that is so for all that
could not be improved, again in every pass. The thesis names no mean and no maximum.""")
    by_star("Table 9.1: terminal stars, % (no swap: closed, and no valid edge removal)",
            ["closed", "open", "tangled", "outside", "no swap"], meshes, ALL_STARS,
            centroids, 2, TABLE_9_1)


def section_9_3(meshes):
    by_star("Section 9.3.1: closed stars by size, % (<=6 all: open ones too)",
            SIZE_HEAD + ["4-6", "<=6", "<=6 all", "largest"], meshes,
            ["centroid", SELECTIVE], closed_sizes, [2] * 10 + [0],
            {"all": "- 2nd 1st 3rd - - - ~80 ~90 80-90 14".split()})
    by_star("Section 9.3.2: open stars by size, % (the thesis: varies)",
            ["1", "2", "3", "4", "5", "6", ">6", "largest"], meshes,
            ["centroid", SELECTIVE], open_sizes, [2] * 7 + [0], {})


def section_9_4(meshes):
    by_star("Section 9.4: what is done with terminal stars, % of closed, of open, of all",
            ["refused", "swapped", "inserted", "open refused", "open of all"], meshes,
            STOPS, operations, 2, {"all": ["70-75", "similar", "", "~100", "5-15"],
                                   "P": ["55", "", "", "", "29.43"]})
    for mesh in meshes:
        kinds = [("closed stars, refused", of_size("refused")),
                 ("  swapped", of_size("swapped")), ("  inserted", of_size("inserted")),
                 ("  swaps of all changes", swaps_of_changed)]
        rows = [(name, shown(medians(mesh, SELECTIVE, figures)))
                for name, figures in kinds]
        table("Section 9.4.2: by size, %%: %s %s" % (mesh, SELECTIVE), SIZE_HEAD, rows)
    print("""
The thesis, which has pictures here: of size 3 nearly all changes are swaps; their
share falls with the size to nearly 0 for 6 and more; insertions are very rare for 8
and more.""")


def section_9_5(meshes):
    rows = []
    for mesh in meshes:
        every = medians(mesh, SELECTIVE, cost)
        small = medians(mesh, "m=1.10, small stars", cost)
        saved = 100 - percent(small[3], every[3])
        rows.append((mesh, shown([*every[1:3], *small[1:3], saved])))
    table("Section 9.5: m=1.10, and without stars of more than 6 (--max-star 6)",
          ["ratio", "bad%", "ratio 6", "bad% 6", "s saved, %"],
          rows + [("  thesis: open ones too", ["-", "-", "-", "-", "30-50"])])


def main():
    meshes = sys.argv[2:]
    print("""Balboa (2020) and lepp-improve. "thesis", and columns with a capital: his.
rnd2000: medians of %d seeds, another cloud than his; femur: tetgen -pq4, another mesh
than his, of 52848; other surfaces: meshes of our own in place of Retinal, P and N090.
Seconds: of CPU; his are of an i7-6500U.""" % len(load("rnd2000", "m=1.10")))
    chapter_7(meshes)
    section_7_4(meshes)
    chapter_8(meshes)
    distance("rnd2000")
    section_9_1_to_9_2(meshes)
    section_9_3(meshes)
    section_9_4(meshes)
    section_9_5(meshes)


main()
