# SPDX-License-Identifier: GPL-3.0-or-later
# termesh. Needs GNU make.
#
#   make                 the filters in build/bin, the library build/libtermesh.a
#   make check           all tests; SAN=1: under the address and undefined-behaviour
#                        sanitizers, in build/san; TM_SEED repeats the random ones
#   make fuzz            damaged input for every filter; FUZZ_CASES of it, TM_SEED
#   make bench           all of tests/bench
#   make lint            what the compiler does not see; make format mends its part
#   make install         into $(DESTDIR)$(PREFIX); make uninstall
#   make clean
#
# Everything that is made is in BUILD, which may be any folder: make BUILD=/tmp/termesh

VERSION = 0.1.0
PREFIX = /usr/local
BINDIR = $(PREFIX)/bin
MANDIR = $(PREFIX)/share/man
LIBDIR = $(PREFIX)/lib
INCLUDEDIR = $(PREFIX)/include

CC = cc
CXX = c++
AR = ar
CFLAGS = -O2 -g
CXXFLAGS = -O2 -g
WARNINGS = -Wall -Wextra -Wconversion -Wshadow -Wstrict-prototypes -Werror
LDLIBS = -lgmp -lz -lm -lpthread

# MPI, which p4est needs; for another one than Open MPI set both. A program that does not
# use p4est is not linked with it.
MPI_CFLAGS := $(shell mpicc --showme:compile)
MPI_LDLIBS := $(shell mpicc --showme:link)
LDLIBS += -Wl,--as-needed -lp4est -lsc $(MPI_LDLIBS) -Wl,--no-as-needed

FUZZ_CASES = 20000
BUILD = build

ifneq ($(filter-out 0,$(SAN)),)
override BUILD := $(BUILD)/san
SANITIZE = -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
# No exit status of a filter's own.
export ASAN_OPTIONS ?= exitcode=99
export UBSAN_OPTIONS ?= exitcode=99:print_stacktrace=1
export LSAN_OPTIONS ?= exitcode=99
endif

# -ffp-contract=off: the same bytes on every machine.
TM_CFLAGS = -std=c17 -D_GNU_SOURCE -DTM_VERSION='"$(VERSION)"' -ffp-contract=off \
	$(WARNINGS) $(SANITIZE) -I$(BUILD)/generated \
	$(patsubst -I%,-isystem %,$(MPI_CFLAGS)) $(CFLAGS)

filters := $(basename $(notdir $(wildcard cmd/*.c)))
bin := $(filters:%=$(BUILD)/bin/%)
library := $(BUILD)/libtermesh.a
library_sources := $(filter-out lib/base/generate/% lib/octree/transition/generate/%, \
	$(wildcard lib/*/*.c lib/*/*/*.c))
library_objects := $(library_sources:%.c=$(BUILD)/%.o)
common_objects := $(patsubst %.c,$(BUILD)/%.o,$(wildcard cmd/common/*/*.c))
headers := $(wildcard lib/*/*.h lib/*/*/*.h)
unit_tests := $(patsubst tests/unit/%.c,$(BUILD)/tests/%,$(wildcard tests/unit/test_*.c))
oracles := $(patsubst tests/oracle/%.cc,$(BUILD)/tests/%,$(wildcard tests/oracle/*.cc))
fuzzer := $(BUILD)/fuzz/fuzz
solver := $(BUILD)/vem/vem-poisson
benchers := $(patsubst tests/bench/%.c,$(BUILD)/bench/%,$(wildcard tests/bench/*.c))
shapes := $(BUILD)/bench/shapes
generated := $(BUILD)/generated/powers.h $(BUILD)/generated/transitions.h
pages := $(wildcard man/*.[157])
sources := $(wildcard lib/*/*.[ch] lib/*/*/*.[ch] lib/*/*/*/*.[ch] cmd/*.c cmd/common/*/*.[ch] tests/*/*.[ch] \
	tests/*/*.cc examples/*.c)

.PHONY: all tests check benchers bench fuzz lint format install uninstall clean
.SECONDARY:

all: $(bin) $(library)

# Programs of the tree that write tables of the library.
$(BUILD)/generated/%.h: $(BUILD)/generate/%
	@mkdir -p $(@D)
	$< >$@.new
	mv $@.new $@

$(BUILD)/generate/powers: lib/base/generate/powers.c
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -o $@ $< $(LDFLAGS) $(LDLIBS)

$(BUILD)/generate/transitions: $(wildcard lib/octree/transition/generate/*.[ch]) \
		lib/octree/transition/face_pieces.c lib/octree/transition/leaf_place.c lib/octree/transition/transition.h \
		lib/element/shape.c
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -o $@ $(filter %.c,$^) $(LDFLAGS) $(LDLIBS)

$(BUILD)/%.o: %.c Makefile | $(generated)
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -MMD -MP -c -o $@ $<

$(library): $(library_objects)
	rm -f $@
	$(AR) rcs $@ $^

$(bin): $(BUILD)/bin/%: $(BUILD)/cmd/%.o $(common_objects) $(library)
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -o $@ $^ $(LDFLAGS) $(LDLIBS)

$(unit_tests): $(BUILD)/tests/%: $(BUILD)/tests/unit/%.o $(library)
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -o $@ $^ $(LDFLAGS) -lcmocka $(LDLIBS)

# C++ programs that compare with the C++ library.
$(oracles): $(BUILD)/tests/%: tests/oracle/%.cc tests/unit/random.h $(library)
	@mkdir -p $(@D)
	$(CXX) -std=c++17 -Wall -Wextra -Werror $(SANITIZE) $(CXXFLAGS) -o $@ $< $(library) \
		$(LDFLAGS) $(LDLIBS)

$(fuzzer): $(patsubst %.c,$(BUILD)/%.o,$(wildcard tests/fuzz/*.c)) $(library)
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -o $@ $^ $(LDFLAGS) $(LDLIBS)

$(benchers): $(BUILD)/bench/%: $(BUILD)/tests/bench/%.o $(library)
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -o $@ $^ $(LDFLAGS) $(LDLIBS)

$(shapes): $(patsubst %.c,$(BUILD)/%.o,$(wildcard tests/shapes/*.c))
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -o $@ $^ $(LDFLAGS) -lm

# Needs SuiteSparse; tests/cli/vem.bats and an example run it.
$(solver): $(patsubst %.c,$(BUILD)/%.o,$(wildcard tests/vem/*.c)) $(library)
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -o $@ $^ $(LDFLAGS) -lcholmod $(LDLIBS)

# What the tests run.
tests: all $(unit_tests) $(oracles) $(fuzzer) $(solver) $(shapes)

check: tests
	sh tests/run.sh $(BUILD)

# Always under the sanitizers.
ifdef SANITIZE
fuzz: all $(fuzzer)
	$(fuzzer) $(BUILD)/bin $(FUZZ_CASES)
else
fuzz:
	$(MAKE) SAN=1 fuzz
endif

# What the benchmarks run; each is a script that can be run alone.
benchers: all $(benchers) $(shapes)

bench: benchers
	for bench in tests/bench/*.sh; do sh "$$bench" || exit; done

lint: $(generated)
	sh tests/lint.sh $(BUILD)

format:
	clang-format -i $(sources)

install: all
	install -d $(DESTDIR)$(BINDIR) $(DESTDIR)$(LIBDIR)/pkgconfig
	install -m 755 $(bin) $(DESTDIR)$(BINDIR)
	install -m 644 $(library) $(DESTDIR)$(LIBDIR)
	for header in $(headers); do \
		install -D -m 644 $$header $(DESTDIR)$(INCLUDEDIR)/termesh/$${header#lib/} || exit; \
	done
	for page in $(pages); do \
		install -D -m 644 $$page $(DESTDIR)$(MANDIR)/man$${page##*.}/$${page#man/} || exit; \
	done
	sed -e 's|@PREFIX@|$(PREFIX)|' -e 's|@LIBDIR@|$(LIBDIR)|' \
		-e 's|@INCLUDEDIR@|$(INCLUDEDIR)|' -e 's|@VERSION@|$(VERSION)|' \
		-e 's|@LDLIBS@|$(LDLIBS)|' lib/termesh.pc.in \
		>$(DESTDIR)$(LIBDIR)/pkgconfig/termesh.pc

uninstall:
	rm -f $(filters:%=$(DESTDIR)$(BINDIR)/%) $(DESTDIR)$(LIBDIR)/libtermesh.a \
		$(DESTDIR)$(LIBDIR)/pkgconfig/termesh.pc
	rm -rf $(DESTDIR)$(INCLUDEDIR)/termesh
	for page in $(pages); do \
		rm -f $(DESTDIR)$(MANDIR)/man$${page##*.}/$${page#man/} || exit; \
	done

clean:
	rm -rf $(BUILD)

-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
