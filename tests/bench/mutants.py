#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether tests see a fault: mutants.py BUILD COUNT [SEED [FOLDER]]

Changes one token of a .c file of lib/ (or of FOLDER in it) at a time, at random: < to <=,
+ to -, && to ||, a number to the next one; in each folder as often as in the others. The
change is killed where a test fails that runs its line, as `make coverage` in BUILD has
found: programs of tests/unit first, then files of tests/cli, those first that take the
least time, until they have taken so long together that it is not worth it (LIMIT seconds of
processor time). A test ends where its first case fails. Random tests have the seed SEED.
Prints one line for each change, and how many were killed.

A copy of the tree, with what is built in it, is in a temporary folder, with the library
shared there, so that a change needs one compilation and one link. Tests that fail there
without any change do not count.
"""

import collections
import json
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
LIMIT = 60  # seconds of processor time of the tests of one change
SLOW = 60  # a test that took longer is not run
HANGS = 60  # seconds of processor time after which a program hangs,
STALLS = 400  # seconds of the clock after which a test does
MEMORY = 8 << 30  # bytes, the most of a program

FAILED = ("not ok", "[  FAILED  ]")  # what bats says of a case, and cmocka

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
                        ignore=shutil.ignore_patterns("san", "san-*", "coverage",
                                                      "determinism", ".git"))
        self.make("build/libtermesh.a")
        archive = os.path.join(self.build, "libtermesh.a")
        self.shared = os.path.join(self.build, "libchanged.so")
        self.good = os.path.join(self.build, "libgood.so")
        self.objects = [self.object_of(source) for source in sources("lib")
                        if os.path.exists(self.object_of(source))]
        self.link()
        shutil.copy(self.shared, self.good)
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
        self.run(["make", "-s", "-j2", target], env=flags)

    def link(self, without=None, instead=None):
        """The shared library, with one object instead of another one."""
        objects = [instead if o == without else o for o in self.objects]
        flags = subprocess.run(["mpicc", "--showme:link"], capture_output=True, text=True,
                               check=False).stdout.split()
        self.run(["cc", "-shared", "-o", self.shared + ".new", *objects, "-lgmp", "-lz",
                  "-lm", "-lpthread", "-lexpat", "-lp4est", "-lsc", *flags])
        os.replace(self.shared + ".new", self.shared)

    def exchange(self):
        """The library without a change and that with it change their places."""
        third = self.good + ".third"
        os.rename(self.shared, third)
        os.rename(self.good, self.shared)
        os.rename(third, self.good)

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
        if test.endswith(".bats"):
            command = ["bats", "--tap", "tests/cli/" + test]
        else:
            command = [os.path.join(self.build, "tests", test)]
        path = os.path.join(self.build, "bin") + ":" + os.environ["PATH"]
        within = ["sh", "-c", '. tests/mpi.sh && exec "$@"', "sh"]
        run = subprocess.Popen(within + command, cwd=self.folder, text=True, errors="replace",
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, preexec_fn=set_limits,
                               env=dict(os.environ, PATH=path, TM_BUILD=self.build))
        clock = threading.Timer(STALLS, end_group, [run.pid])
        clock.start()
        failed = any(line.startswith(FAILED) for line in run.stdout)
        if failed:
            end_group(run.pid)
        run.stdout.close()
        status = run.wait()
        clock.cancel()
        return status == 0 and not failed


def set_limits():
    """Of a test, which is a group of processes: what hangs or takes all memory ends."""
    os.setsid()
    resource.setrlimit(resource.RLIMIT_CPU, (HANGS, HANGS))
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def end_group(group):
    try:
        os.killpg(group, signal.SIGKILL)
    except ProcessLookupError:
        pass


def seconds_taken():
    """Processor time of all that was run."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def mutate(tree, source, place):
    """Puts the change into the library; False where it does not compile, or to the same
    code."""
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
        return True
    return False


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
        """Tests that run the line, or where none does, as tables have no code, the file."""
        found = [test for test, run in self.lines.items() if line in run.get(source, ())]
        found = found or [test for test, run in self.lines.items() if source in run]
        found = [test for test in found if self.seconds.get(test, 0) <= SLOW]
        return sorted(found, key=lambda test: (test.endswith(".bats"),
                                               self.seconds.get(test, 0), test))

    def is_healthy(self, tree, test):
        """Whether it passes without any change."""
        if test not in self.healthy:
            tree.exchange()
            self.healthy[test] = tree.passes(test)
            tree.exchange()
        return self.healthy[test]


def judge(tree, tests, source, line):
    """What became of the change."""
    able = tests.of(source, line)
    if not able:
        return "survived: no test runs it"
    begin = seconds_taken()
    for done, test in enumerate(able):
        if seconds_taken() - begin > LIMIT:
            return f"survived {done} of {len(able)} tests"
        if not tree.passes(test) and tests.is_healthy(tree, test):
            return f"killed by {test}"
    return f"survived all {len(able)} tests"


def in_turn(folder, rng):
    """All places, at random, one of each folder after the other."""
    of_folder = collections.defaultdict(list)
    for source in sorted(sources(folder)):
        of_folder[os.path.dirname(source)] += [
            (source, place) for place in places(os.path.join(ROOT, source))]
    for some in of_folder.values():
        rng.shuffle(some)
    while any(of_folder.values()):
        for name in rng.sample(sorted(of_folder), len(of_folder)):
            if of_folder[name]:
                yield of_folder[name].pop()


def main():
    build, count = os.path.abspath(sys.argv[1]), int(sys.argv[2])
    seed = sys.argv[3] if len(sys.argv) > 3 else "1"
    folder = sys.argv[4] if len(sys.argv) > 4 else "lib"
    os.environ["TM_SEED"] = seed
    tests = Tests(build)
    killed = done = 0
    with tempfile.TemporaryDirectory() as work:
        os.environ["TMPDIR"] = work  # of the tests that are ended
        tree = Tree(os.path.join(work, "tree"))
        for source, place in in_turn(folder, random.Random(int(seed))):
            if done == count:
                break
            if not mutate(tree, source, place):
                continue  # it does not compile, or to the same
            verdict = judge(tree, tests, source, place[0])
            done += 1
            killed += verdict.startswith("killed")
            print(f"{source}:{place[0]}:{place[1] + 1}: {place[2]} -> {place[3]}: {verdict}",
                  flush=True)
    print(f"{killed} of {done} killed, seed {seed}")


if __name__ == "__main__":
    main()
