#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether tests see a fault: mutants.py BUILD COUNT [SEED [FOLDER]]

Changes one token of a .c file of lib/ (or of FOLDER in it) at a time, at random: < to <=,
+ to -, && to ||, a number to the next one. The change is killed where a test fails that
runs its line, as `make coverage` in BUILD has found; those that take the least time are run
first, until they have taken so long together that it is not worth it (LIMIT seconds).
Prints one line for each change, and how many were killed.

A copy of the tree, with what is built in it, is in a temporary folder, with the library
shared there, so that a change needs one compilation and one link. Tests that fail there without any change do not count.
"""

import concurrent.futures
import json
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
LIMIT = 180  # seconds of tests for one change
SLOW = 30  # a test that took longer is not run
AT_ONCE = 6  # tests
ONE_TEST = 100  # seconds after which a test that hangs has failed

NOT_LINKED = ("lib/ranks/mpi/ranks.c",)  # of the programs under a launcher only

OTHER = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "+": "-",
         "-": "+", "/": "*", "&&": "||", "||": "&&", "++": "--", "--": "++", "+=": "-=",
         "-=": "+=", "true": "false", "false": "true", "fmin": "fmax", "fmax": "fmin",
         "<<": ">>", ">>": "<<", "%": "/", "&": "|", "|": "&", "!": ""}
TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|\'(?:[^\'\\]|\\.)*\'|//.*|[A-Za-z_]\w*'
                   r'|0[xX][0-9a-fA-F]+\w*|(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?\w*'
                   r'|->|<<=|>>=|\.\.\.|<<|>>|<=|>=|==|!=|&&|\|\||\+\+|--'
                   r'|[-+*/%&|^]=|[-+/%<>&|!]|\S')


def changed(token, before):
    """What a token becomes, or None."""
    if re.fullmatch(r"\d+", token):
        return str(int(token) + 1)
    if re.fullmatch(r"(?:\d+\.\d*|\.\d+)(?:[eE][-+]?\d+)?", token):
        return f"(2 * {token})"
    if token == "&" and not re.fullmatch(r"\w+|\)|\]", before):
        return None  # an address
    return OTHER.get(token)


def places(path):
    """All places where the file can be changed: line, column, token, what it becomes."""
    with open(path, encoding="utf-8") as file:
        text = re.sub(r"/\*.*?\*/", lambda m: re.sub(r"[^\n]", " ", m.group()), file.read(),
                      flags=re.S)
    depth = 0
    for n, line in enumerate(text.splitlines(), 1):
        if line.startswith("#") or line.startswith("static const"):
            continue
        before = ""
        for token in TOKEN.finditer(line):
            depth += (token.group() == "{") - (token.group() == "}")
            other = changed(token.group(), before)
            if other is not None and depth > 0:
                yield n, token.start(), token.group(), other
            before = token.group()


class Tree:
    """A copy of the tree with a shared library, and what is done in it."""

    def __init__(self, folder):
        self.folder = folder
        self.build = os.path.join(folder, "build")
        shutil.copytree(ROOT, folder, dirs_exist_ok=True,
                        ignore=shutil.ignore_patterns("san", "san-*", "coverage", ".git"))
        self.make("tests")
        archive = os.path.join(self.build, "libtermesh.a")
        self.shared = os.path.join(self.build, "libchanged.so")
        self.objects = [self.object_of(source) for source in sources("lib")
                        if os.path.exists(self.object_of(source))]
        self.link(None, None)
        with open(archive, "w", encoding="ascii") as script:
            script.write(f"INPUT({self.shared})\n")
        self.make("tests")

    def run(self, command, **options):
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True,
                              check=False, **options)
        if done.returncode != 0:
            sys.exit(f"{' '.join(command)[:300]}\n{done.stderr[-2000:]}")
        return done

    def make(self, target):
        flags = dict(os.environ, LDFLAGS="-Wl,-rpath," + self.build)
        self.run(["make", "-s", "-j4", target], env=flags)

    def link(self, without, instead):
        objects = [instead if o == without else o for o in self.objects]
        flags = subprocess.run(["mpicc", "--showme:link"], capture_output=True, text=True,
                               check=False).stdout.split()
        self.run(["cc", "-shared", "-o", self.shared + ".new", *objects, "-lgmp", "-lz",
                  "-lm", "-lpthread", "-lexpat", "-lp4est", "-lsc", *flags])
        os.replace(self.shared + ".new", self.shared)

    def object_of(self, source):
        return os.path.join(self.build, source[:-1] + "o")

    def compile(self, source):
        """The object of a file as it is now, beside the good one; None where it does not
        compile."""
        good = self.object_of(source)
        made, keep = good[:-1] + "changed.o", good + ".good"
        os.rename(good, keep)
        done = subprocess.run(["make", "-s", "WERROR=", os.path.relpath(good, self.folder)],
                              cwd=self.folder, capture_output=True, check=False)
        if done.returncode == 0:
            os.replace(good, made)
        os.replace(keep, good)
        return made if done.returncode == 0 else None

    def passes(self, test):
        """Whether a test passes."""
        run = subprocess.Popen(["sh", "tests/run.sh", "build", test], cwd=self.folder,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               start_new_session=True)
        try:
            return run.wait(ONE_TEST) == 0
        except subprocess.TimeoutExpired:
            os.killpg(run.pid, 15)
            run.wait()
            return False


def mutate(tree, source, place):
    """Puts the change into the library. Its object; None where it does not compile, or to
    the same code."""
    line, column, token, other = place
    path = os.path.join(tree.folder, source)
    with open(path, encoding="utf-8") as file:
        text = file.read()
    lines = text.splitlines(keepends=True)
    row = lines[line - 1]
    lines[line - 1] = row[:column] + other + row[column + len(token):]
    with open(path, "w", encoding="utf-8") as file:
        file.write("".join(lines))
    made = tree.compile(source)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    if made and not same_code(tree.object_of(source), made):
        tree.link(tree.object_of(source), made)
        return made
    return None


def same_code(a, b):
    """Whether two objects have the same code and data."""
    with tempfile.TemporaryDirectory() as work:
        bare = [os.path.join(work, name) for name in "ab"]
        for path, to in zip((a, b), bare):
            subprocess.run(["strip", "-g", "-o", to, path], check=True)
        with open(bare[0], "rb") as one, open(bare[1], "rb") as two:
            return one.read() == two.read()


def sources(folder):
    """The .c files below a folder that are part of the library."""
    for at, _, names in os.walk(os.path.join(ROOT, folder)):
        for name in names:
            path = os.path.relpath(os.path.join(at, name), ROOT)
            if name.endswith(".c") and "/generate/" not in path and path not in NOT_LINKED:
                yield path


class Tests:
    """Which tests run a line, and how long they take."""

    def __init__(self, build):
        with open(os.path.join(build, "lines_of_tests.json"), encoding="utf-8") as file:
            self.lines = {test: {name: set(lines) for name, lines in run.items()}
                          for test, run in json.load(file).items()}
        self.seconds = {}
        with open(os.path.join(build, "counts.seconds"), encoding="utf-8") as file:
            for line in file:
                test, took = line.split()
                self.seconds[test] = int(took)
        self.healthy = {}

    def of(self, source, line):
        found = [test for test, run in self.lines.items()
                 if line in run.get(source, ()) and self.seconds.get(test, 0) <= SLOW]
        return sorted(found, key=lambda test: (self.seconds.get(test, 0), test))

    def is_healthy(self, tree, test):
        """Whether it passes without any change."""
        if test not in self.healthy:
            tree.link(None, None)
            self.healthy[test] = tree.passes(test)
        return self.healthy[test]


def judge(tree, tests, source, place, changed_object):
    """What became of the change."""
    begin = time.monotonic()
    able = tests.of(source, place[0])
    if not able:
        return "survived: no test runs it"
    done = 0
    while done < len(able) and time.monotonic() - begin < LIMIT:
        some = able[done:done + AT_ONCE]
        done += len(some)
        with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
            passed = dict(zip(some, pool.map(tree.passes, some)))
        for test in some:
            if not passed[test] and tests.is_healthy(tree, test):
                return f"killed by {test}"
        tree.link(tree.object_of(source), changed_object)
    return f"survived {done} of {len(able)} tests"


def main():
    build, count = os.path.abspath(sys.argv[1]), int(sys.argv[2])
    rng = random.Random(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    folder = sys.argv[4] if len(sys.argv) > 4 else "lib"
    tests = Tests(build)
    everything = [(source, place) for source in sorted(sources(folder))
                  for place in places(os.path.join(ROOT, source))]
    rng.shuffle(everything)
    killed = done = 0
    with tempfile.TemporaryDirectory() as work:
        tree = Tree(os.path.join(work, "tree"))
        for source, place in everything:
            if done == count:
                break
            made = mutate(tree, source, place)
            if not made:
                continue  # it does not compile, or to the same
            verdict = judge(tree, tests, source, place, made)
            done += 1
            killed += verdict.startswith("killed")
            print(f"{source}:{place[0]}:{place[1] + 1}: {place[2]} -> {place[3]}: {verdict}",
                  flush=True)
    print(f"{killed} of {done} killed")


if __name__ == "__main__":
    main()
