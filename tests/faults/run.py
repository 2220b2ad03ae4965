#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Each call of a program that may fail fails once:
run.py [-a | -k KIND] [-j JOBS] PRELOAD <CASES

With -m memory is limited instead, to ten sizes from that with which it says its version
to that with which it comes to its end.

CASES has a command a line, "<FILE command" for one with standard input; `in/` is the
folder where run.py was started, the working folder is another one, in which there is a
file `old`. PRELOAD is preload.c as a library. With -a all calls of all kinds fail, one by
one and all from there on, with -k all those of that kind, otherwise a sample of all;
TM_SEED repeats it.

A command is right where it does as if nothing had failed; or ends with status 4, one
line on standard error that says why, nothing on standard output that could be taken for
a whole stream (unless it could only not be closed), and no file that was not there before, but
trace_*.
What Gmsh cannot do in its own memory may also be the fault of a file: status 3. Prints
what is not right, and how many runs there were; exit status 1 if there were wrong ones."""
import collections
import concurrent.futures
import mmap
import os
import queue
import random
import re
import shlex
import shutil
import struct
import subprocess
import sys
import tempfile

# As preload.c has them; what the message says.
KINDS = {'memory': 'memory', 'map': 'memory', 'thread': 'Resource temporarily unavailable',
         'process': 'Resource temporarily unavailable', 'open': 'Too many open files',
         'read': 'Input/output error', 'write': 'No space left on device',
         'close': 'Input/output error', 'name': 'Input/output error'}
DISTURBED = ('short', 'interrupted')
STEPS = 10  # of limited memory
FOREVER = 2 ** 63
SAMPLE = 2  # calls of a kind, of memory more
MORE = 10
TIMEOUT = 120
INPUT, SYSTEM = 3, 4  # exit statuses

Result = collections.namedtuple('Result', 'status output message files left')


class Place:
    """A folder to run in; one thread at a time."""

    def __init__(self, root, number, inputs):
        self.run = os.path.join(root, 'run%d' % number)
        self.tmp = os.path.join(root, 'tmp%d' % number)
        self.count = os.path.join(root, 'count%d' % number)
        self.inputs = inputs
        self.size = 8 * len(KINDS)
        with open(self.count, 'wb') as file:
            file.write(bytes(self.size))
        with open(self.count, 'r+b') as file:
            self.page = mmap.mmap(file.fileno(), self.size)

    def clear(self):
        for folder in self.run, self.tmp:
            shutil.rmtree(folder, ignore_errors=True)
            os.mkdir(folder)
        os.symlink(self.inputs, os.path.join(self.run, 'in'))
        with open(os.path.join(self.run, 'old'), 'w', encoding='ascii') as file:
            file.write('old\n')
        self.page[:] = bytes(self.size)

    def counts(self):
        return dict(zip(KINDS, struct.unpack('%dQ' % len(KINDS), self.page[:])))

    def files(self, folder):
        found = {}
        for path, _, names in os.walk(folder):
            for name in names:
                with open(os.path.join(path, name), 'rb') as file:
                    found[os.path.relpath(os.path.join(path, name), folder)] = \
                        without_seconds(file.read())
        return found


def without_seconds(text):
    return re.sub(rb'"seconds": *[0-9.e+-]*', b'', text)


def start(place, case, preload, fault):
    """Runs a case with a fault: (kind, first, last)."""
    words = shlex.split(case)
    stdin = subprocess.DEVNULL
    place.clear()
    if words[0].startswith('<'):
        stdin = open(os.path.join(place.run, words.pop(0)[1:]), 'rb')
    environment = dict(os.environ, TMPDIR=place.tmp)
    if fault[0] == 'limit':
        words = ['prlimit', '--core=0', '--as=%d' % fault[1]] + words
    else:
        environment.update(LD_PRELOAD=preload, TM_FAULTS='%s %d %d' % fault,
                           TM_FAULTS_COUNT=place.count)
    try:
        ended = subprocess.run(words, cwd=place.run, env=environment, stdin=stdin,
                               capture_output=True, timeout=TIMEOUT, check=False)
        status, output, message = ended.returncode, ended.stdout, ended.stderr
    except subprocess.TimeoutExpired:
        status, output, message = 'hangs', b'', b''
    if stdin != subprocess.DEVNULL:
        stdin.close()
    return Result(status, without_seconds(output), without_seconds(message),
                  place.files(place.run), os.listdir(place.tmp))


def wrong(case, fault, right, got):
    """What is wrong with what a case did, or None."""
    name = next(word for word in shlex.split(case) if word[0] != '<')
    if got.left:
        return 'leaves ' + ' '.join(got.left)
    if got.status == right.status and got.status != SYSTEM:
        if got.output != right.output:
            return 'writes something else'
        if got.files != right.files:
            return 'writes other files'
        return None
    damaged = name == 'gmsh-import' and got.status == INPUT and b'may be damaged' in got.message
    if (got.status != SYSTEM and not damaged) or fault[0] in DISTURBED:
        return 'ends with %s' % got.status
    if {f: b for f, b in got.files.items() if not f.startswith('trace_')} != {'old': b'old\n'}:
        return 'ends with 4 and leaves files'
    if b'\n.end\n' in got.output and fault[0] != 'close':
        return 'ends with 4 and writes .end'
    lines = got.message.decode(errors='replace').splitlines()
    if len(lines) != 1 or not lines[0].startswith(name + ': '):
        return 'says %d lines' % len(lines)
    if all(why not in lines[0] for why in (KINDS.get(fault[0], 'memory'), 'memory', 'Gmsh')):
        return 'does not say why'
    return None


def faults_of(counts, every, chance):
    """What is to fail in a case with so many calls of each kind: all calls of those in
    `every`, or a sample."""
    faults = [(kind, 0, 0) for kind in DISTURBED if not every or len(every) > 1]
    for kind, count in counts.items():
        numbers = range(1, count + 1)
        if every and kind not in every:
            continue
        if not every:
            some = MORE if kind == 'memory' else SAMPLE
            numbers = sorted(chance.sample(numbers, min(count, some)))
        for first in numbers:
            both = [(kind, first, first), (kind, first, FOREVER)]
            faults += both if every else [chance.choice(both)]
    return faults


class Tests:
    def __init__(self, preload, jobs, root):
        self.preload = os.path.abspath(preload)
        self.places = queue.Queue()
        for number in range(jobs):
            self.places.put(Place(root, number, os.getcwd()))
        self.runs = 0
        self.bad = 0

    def run(self, case, fault):
        place = self.places.get()
        try:
            return start(place, case, self.preload, fault), place.counts()
        finally:
            self.places.put(place)

    def least_memory(self, case, right):
        """The least limit with which a case ends as it should, in bytes."""
        low, high = 1 << 20, 1 << 34
        while high - low > 1 << 16:
            limit = (low + high) // 2
            got, _ = self.run(case, ('limit', limit, 0))
            low, high = (low, limit) if got == right else (limit, high)
        return high

    def limits(self, case):
        """The limits to run a case with."""
        version = case.split()[0 if case[0] != '<' else 1] + ' --version'
        low, high = (self.least_memory(c, self.run(c, ('none', 0, 0))[0])
                     for c in (version, case))
        return [('limit', low + (high - low) * step // STEPS, 0) for step in range(STEPS)]

    def test(self, pool, case, every, chance):
        """Runs a case with all its faults; `every` is as in faults_of(), or None: with
        little memory."""
        right, counts = self.run(case, ('none', 0, 0))
        if right.status not in (0, 1) or right.left:
            print('%s: ends with %s: %s' % (case, right.status, right.message.decode()))
            self.bad += 1
            return
        faults = self.limits(case) if every is None else faults_of(counts, every, chance)
        for fault, (got, _) in zip(faults, pool.map(lambda f: self.run(case, f), faults)):
            self.runs += 1
            what = wrong(case, fault, right, got)
            if what:
                self.bad += 1
                print('%s: %s %d%s of %d: %s: %s' % (
                    case, fault[0], fault[1], '…' if fault[2] == FOREVER else '',
                    counts.get(fault[0], 0), what, got.message.decode(errors='replace')[:300]))
                sys.stdout.flush()


def main():
    words = sys.argv[1:]
    every = None if '-m' in words else tuple(KINDS) if '-a' in words else ()
    if '-k' in words:
        every = (words[words.index('-k') + 1],)
    jobs = int(words[words.index('-j') + 1]) if '-j' in words else 1
    seed = os.environ.get('TM_SEED') or str(random.randrange(10 ** 9))
    cases = [line.strip() for line in sys.stdin if line.strip()]
    with tempfile.TemporaryDirectory() as root, \
            concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        tests = Tests(words[-1], jobs, root)
        for case in cases:
            tests.test(pool, case, every, random.Random(seed + case))
    print('%d runs, %d wrong; TM_SEED=%s' % (tests.runs, tests.bad, seed))
    sys.exit(tests.bad > 0)


main()
