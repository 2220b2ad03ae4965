# SPDX-License-Identifier: GPL-3.0-or-later
"""judge.py [--limit RATIO] [--figures FILE --mesh MESH --kind KIND] NAME SECONDS BEFORE
AFTER: prints a row of a benchmark's table: how large and how bad the mesh AFTER is, by
tet-stats, how long it took, and whether it is still the same body as BEFORE, by
mesh-check. Without other arguments it prints the table's head.

Each line of the file SECONDS is a run: CPU seconds of the algorithm alone, of the whole
process, and, of ours, the exit status; "-" is not known. Medians count. With --limit the
exit status has to be 1 if the mesh is larger than so many times BEFORE, and 0 if not.
The row is appended to the file FILE too, after MESH and KIND, with tabs."""
import argparse
import json
import statistics
import subprocess
import sys

HEAD = ["", "tets", "ratio", "bad %", "smallest", "largest", "alone s", "whole s", "check"]
FORMAT = "%-27s %8s %6s %6s %8s %8s %8s %8s  %s"
NO_DEFECTS = ["nodes", "elements", "boundary_faces", "components", "euler", "volume", "area",
              "unused_nodes"]
TOLERANCE = 1e-9


def report(program, path):
    """What a filter of ours says about a mesh; mesh-check's exit status is in it."""
    run = subprocess.run([program, "-q", "--json", "-", path], stdout=subprocess.PIPE,
                         check=False)
    return json.loads(run.stdout)


def medians(path):
    """The medians of the columns, as texts."""
    with open(path, encoding="ascii") as lines:
        columns = list(zip(*[line.split() for line in lines]))
    return ["-" if "-" in column else "%.3f" % statistics.median_low(map(float, column))
            for column in columns]


def complaints(before, after):
    """What is wrong with a mesh, and what of the body has changed."""
    found = ["%d %s" % (count, key.replace("_", " ")) for key, count in after.items()
             if count and key not in NO_DEFECTS]
    for key in ["components", "euler"]:
        if after[key] != before[key]:
            found.append("%s %d, was %d" % (key, after[key], before[key]))
    for key in ["volume", "area"]:
        error = abs(after[key] / before[key] - 1)
        if error > TOLERANCE:
            found.append("%s off by %.1e" % (key, error))
    return found


def main():
    if len(sys.argv) == 1:
        print(FORMAT % tuple(HEAD))
        return
    parser = argparse.ArgumentParser()
    parser.add_argument("--limit", type=float)
    parser.add_argument("--figures")
    parser.add_argument("--mesh")
    parser.add_argument("--kind")
    parser.add_argument("name")
    parser.add_argument("seconds")
    parser.add_argument("before")
    parser.add_argument("after")
    options = parser.parse_args()

    body, result = report("mesh-check", options.before), report("mesh-check", options.after)
    quality = report("tet-stats", options.after)
    alone, whole, *status = medians(options.seconds)
    ratio = result["elements"] / body["elements"]
    check = complaints(body, result)
    if options.limit and status:
        too_large = ratio > options.limit
        if too_large:
            check.append("more than %g" % options.limit)
        if float(status[0]) != too_large:
            check.append("exit status %g" % float(status[0]))
    row = [options.name, quality["tets"], "%.3f" % ratio, "%.2f" % quality["bad_percent"],
           "%.2f" % quality["min_dihedral"], "%.2f" % quality["max_dihedral"],
           alone, whole, ", ".join(check) or "ok"]
    print(FORMAT % tuple(row), flush=True)
    if options.figures:
        with open(options.figures, "a", encoding="ascii") as figures:
            print(options.mesh, options.kind, *row, sep="\t", file=figures)


main()
