#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What of lib/ the tests have run: coverage.py BUILD, of a build with COVERAGE=1.

Each folder of BUILD/counts has the counts of one test (tests/run.sh). Prints lines and
branches of each folder of lib/, and its files with the most lines that no test has run;
writes these lines to BUILD/not_run.txt, and which test runs which lines to
BUILD/lines_of_tests.json, for tests/bench/mutants.py. Used by make coverage."""

import collections
import json
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
WORST_FILES = 20


def count_files(folder):
    """The paths of all .gcda below a folder."""
    for at, _, names in os.walk(folder):
        for name in sorted(names):
            if name.endswith(".gcda"):
                yield os.path.join(at, name)


def objects_of(test, build):
    """The counts of lib/ of one test, beside the .gcno that they belong to."""
    found = []
    for path in count_files(test):
        part = path.rpartition(build + "/lib/")
        note = os.path.join(build, "lib", part[2][:-len("gcda")] + "gcno")
        if part[1] and os.path.exists(note):
            beside = path[:-len("gcda")] + "gcno"
            if not os.path.exists(beside):
                os.symlink(note, beside)
            found.append(path)
    return found


def run_gcov(objects, work):
    """The files that gcov reports, of many objects."""
    step = 200
    for i in range(0, len(objects), step):
        lines = subprocess.run(["gcov", "-b", "-t", "--json-format", *objects[i:i + step]],
                               cwd=work, capture_output=True, text=True, check=True)
        for line in lines.stdout.splitlines():
            yield from json.loads(line)["files"]


class Counts:
    """Of each file of lib/: lines and branches, and how often they were run."""

    def __init__(self):
        self.line = collections.defaultdict(lambda: collections.defaultdict(int))
        self.branch = collections.defaultdict(lambda: collections.defaultdict(int))

    def add(self, report, run):
        """Adds a file's report; run[file] is the set of its lines that were run."""
        name = os.path.relpath(os.path.join(ROOT, report["file"]), ROOT)
        if not name.startswith("lib/"):
            return
        for line in report["lines"]:
            n = line["line_number"]
            self.line[name][n] += line["count"]
            if line["count"] > 0:
                run[name].add(n)
            for i, branch in enumerate(line["branches"]):
                self.branch[name][n, i] += branch["count"]

    def sums(self, names):
        """Lines, lines run, branches, branches run."""
        lines = [c for name in names for c in self.line[name].values()]
        branches = [c for name in names for c in self.branch[name].values()]
        return (len(lines), sum(c > 0 for c in lines), len(branches),
                sum(c > 0 for c in branches))


def percent(part, whole):
    return f"{100 * part / whole:6.1f}" if whole else "     -"


def show(what, sums):
    lines, run, branches, taken = sums
    print(f"{what:32} {lines:7} {percent(run, lines)} {branches:9} "
          f"{percent(taken, branches)}")


def report(counts):
    folders = collections.defaultdict(list)
    for name in sorted(counts.line):
        folders[os.path.dirname(name)].append(name)
    print(f"{'folder':32} {'lines':>7} {'% run':>6} {'branches':>9} {'% run':>6}")
    for folder in sorted(folders):
        show(folder, counts.sums(folders[folder]))
    show("all of lib/", counts.sums(counts.line))
    missed = {name: sum(c == 0 for c in lines.values())
              for name, lines in counts.line.items()}
    print("\nlines that no test runs, of the files with most of them:")
    for name in sorted(missed, key=lambda name: -missed[name])[:WORST_FILES]:
        print(f"{missed[name]:5}  {name}")


def write_not_run(counts, path):
    with open(path, "w", encoding="utf-8") as out:
        for name in sorted(counts.line):
            with open(os.path.join(ROOT, name), encoding="utf-8") as source:
                text = source.read().splitlines()
            for n, count in sorted(counts.line[name].items()):
                if count == 0 and n <= len(text):
                    out.write(f"{name}:{n}: {text[n - 1].strip()}\n")


def main():
    build = os.path.abspath(sys.argv[1])
    folder = os.path.join(build, "counts")
    counts = Counts()
    tests = {}
    with tempfile.TemporaryDirectory() as work:
        for test in sorted(os.listdir(folder)):
            run = collections.defaultdict(set)
            for found in run_gcov(objects_of(os.path.join(folder, test), build), work):
                counts.add(found, run)
            tests[test] = {name: sorted(lines) for name, lines in run.items() if lines}
    with open(os.path.join(build, "lines_of_tests.json"), "w", encoding="utf-8") as out:
        json.dump(tests, out)
    write_not_run(counts, os.path.join(build, "not_run.txt"))
    report(counts)


if __name__ == "__main__":
    main()
