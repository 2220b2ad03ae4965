# SPDX-License-Identifier: GPL-3.0-or-later
# termesh. Needs GNU make.
#
#   make                 the filters in build/bin, their completion for bash and zsh in
#                        build/completion, the library in build, static and shared
#   make check           all tests; ONLY=NAME: one test program, or one file of tests/cli;
#                        SAN=1: under the address and undefined-behaviour sanitizers,
#                        in build/san; SAN=thread: under the one for threads, in
#                        build/san-thread; TM_SEED repeats the random ones
#   make coverage        what of lib/ the tests run, by folder, in build/coverage
#   make fuzz            damaged input for every filter, FUZZ_CASES of it, TM_SEED; then
#                        tests/fuzz/targets by libFuzzer, which clang has: each for
#                        FUZZ_SECONDS, FUZZ_TARGETS: only those
#   make limits          in a build in which few things can be numbered, what is more is
#                        refused
#   make bench           all of tests/bench
#   make lint            what the compiler does not see; make format mends its part
#   make warnings        compiles all with all compilers and levels of optimisation
#   make install         into $(DESTDIR)$(PREFIX); make uninstall
#   make clean
#
# Everything that is made is in BUILD, which may be any folder: make BUILD=/tmp/termesh
# Warnings of the compiler are errors with WERROR=1.

# 1.0.0, and the number in the name of the shared library, the first of it.
VERSION := $(shell sed -n 's/^.define TM_VERSION *"\(.*\)"/\1/p' lib/base/version.h)
SOVERSION := $(firstword $(subst ., ,$(VERSION)))

PREFIX = /usr/local
BINDIR = $(PREFIX)/bin
LIBEXECDIR = $(PREFIX)/libexec/termesh/mpi
MANDIR = $(PREFIX)/share/man
LIBDIR = $(PREFIX)/lib
INCLUDEDIR = $(PREFIX)/include
BASHCOMPLETIONDIR = $(PREFIX)/share/bash-completion/completions
ZSHCOMPLETIONDIR = $(PREFIX)/share/zsh/site-functions

CC = cc
CXX = c++
AR = ar
CFLAGS = -O2 -g
CXXFLAGS = -O2 -g
werror = $(if $(filter-out 0,$(WERROR)),-Werror)
WARNINGS = -Wall -Wextra -Wconversion -Wshadow -Wstrict-prototypes $(werror)
LDLIBS = -lgmp -lz -lm -lpthread -Wl,--as-needed -lexpat -Wl,--no-as-needed

# p4est, and MPI, which it needs; for another one than Open MPI set both of its flags. A
# program that does not use p4est is not linked with it. Where it is not installed, what
# uses it is left out.
MPICC = mpicc
MPI_CFLAGS := $(shell $(MPICC) --showme:compile 2>/dev/null)
MPI_LDLIBS := $(shell $(MPICC) --showme:link 2>/dev/null)
has_p4est := $(shell $(CC) $(CPPFLAGS) $(MPI_CFLAGS) -E -x c -include p4est.h /dev/null \
	>/dev/null 2>&1 && echo yes)
ifdef has_p4est
LDLIBS += -Wl,--as-needed -lp4est -lsc $(MPI_LDLIBS) -Wl,--no-as-needed
else
left_out := octree-mesh octree-repair lib/ranks/mpi/start.c \
	$(wildcard $(addsuffix /*.c,$(addprefix lib/octree/,share interior feature layer repair shared_repair))) \
	$(shell grep -lE '^.include.*(p[48]est|brick\.h|octree_estimate|mpi_start)' lib/octree/forest/*.c) \
	$(basename $(notdir $(shell grep -lE 'octree_build|octree/(share|interior|feature|layer|repair|shared_repair)|(mend|octree|repair)_fixture' \
		tests/unit/test_*.c tests/fuzz/targets/*.c)))
endif

# three.js, release 111 (Debian: libjs-three), which draws in the pages of mesh-view and is
# put into them. Where it is not installed, mesh-view is left out.
THREE = /usr/share/javascript/three/three.min.js
ifeq ($(wildcard $(THREE)),)
left_out += mesh-view $(wildcard lib/view/*.c)
endif

# The C library of Gmsh (Debian: libgmsh-dev), which reads and writes the formats of
# gmsh-import and gmsh-export; no other program is linked with it. Where it is not
# installed, both are left out.
has_gmsh := $(shell $(CC) $(CPPFLAGS) -E -x c -include gmshc.h /dev/null >/dev/null 2>&1 && \
	echo yes)
gmsh_filters := gmsh-import gmsh-export
ifndef has_gmsh
left_out += $(gmsh_filters)
endif

FUZZ_CASES = 20000
FUZZ_SECONDS = 60
FUZZ_CC = clang
BUILD = build

ifeq ($(SAN),thread)
override BUILD := $(BUILD)/san-thread
SANITIZE = -fsanitize=thread -fno-omit-frame-pointer
export TSAN_OPTIONS ?= exitcode=99
else ifeq ($(SAN),fuzzer)
override BUILD := $(BUILD)/san-fuzzer
override CC := $(FUZZ_CC)
# No pointer-overflow: it is for NULL + 0 in loops over nothing, which is NULL (C2y, N3322).
SANITIZE = -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize=pointer-overflow \
	-fno-sanitize-recover=all -fno-omit-frame-pointer
# What computes compares no bytes of the input: to trace that is half of its time.
computing := $(foreach folder,element geom octree optimise poly surface tet,\
	$(patsubst %.c,$(BUILD)/%.o,$(wildcard lib/$(folder)/*.c lib/$(folder)/*/*.c)))
$(computing): SANITIZE += -fno-sanitize-coverage=trace-cmp
else ifneq ($(filter-out 0,$(SAN)),)
override BUILD := $(BUILD)/san
SANITIZE = -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
# No exit status of a filter's own.
export ASAN_OPTIONS ?= exitcode=99:allocator_may_return_null=1
export UBSAN_OPTIONS ?= exitcode=99:print_stacktrace=1
export LSAN_OPTIONS ?= exitcode=99
endif

# Counts which lines and branches are run; each test's counts go to a folder of its own.
ifneq ($(filter-out 0,$(COVERAGE)),)
override BUILD := $(BUILD)/coverage
SANITIZE = --coverage
CFLAGS = -O1 -g
coverage_counts := $(abspath $(BUILD))/counts
endif

# -ffp-contract=off: the same bytes on every machine. -fPIC: one set of objects for both
# libraries; calls within are not to be intercepted, and so cost no more.
TM_CFLAGS = -std=c17 -D_GNU_SOURCE -ffp-contract=off -fPIC -fno-semantic-interposition \
	$(WARNINGS) $(SANITIZE) -I$(BUILD)/generated \
	$(patsubst -I%,-isystem %,$(MPI_CFLAGS)) $(CPPFLAGS) $(CFLAGS)

# The files of lib/ whose names end with $(1); programs that are run by make are no part
# of the library.
in_library = $(foreach file,$(wildcard lib/*/*$(1) lib/*/*/*$(1)),\
	$(if $(findstring /generate/,$(file)),,$(file)))

filter_sources := $(wildcard cmd/*.c cmd/import/*.c cmd/export/*.c)
filters := $(filter-out $(left_out),$(basename $(notdir $(filter_sources))))
bin := $(filters:%=$(BUILD)/bin/%)
scripts := $(BUILD)/bin/mesh-convert
completions := $(filters:%=$(BUILD)/completion/bash/%)
# Under a launcher these go on as programs of the same name that are linked with MPI: its
# functions of lib/ranks come before those of the library.
rank_filters := $(filter-out $(left_out),$(if $(has_p4est),$(basename $(notdir \
	$(shell grep -lE '^ *\.ranks = true' $(filter_sources))))))
rank_bin := $(rank_filters:%=$(BUILD)/libexec/termesh/mpi/%)
ranks_object := $(BUILD)/lib/ranks/mpi/ranks.o
library := $(BUILD)/libtermesh.a
shared := $(BUILD)/libtermesh.so.$(VERSION)
library_objects := $(patsubst %.c,$(BUILD)/%.o,$(filter-out $(left_out) lib/ranks/mpi/ranks.c,\
	$(call in_library,.c)))
common := $(BUILD)/libcommon.a
common_objects := $(patsubst %.c,$(BUILD)/%.o,$(filter-out cmd/common/gmsh/%,\
	$(wildcard cmd/common/*.c cmd/common/*/*.c)))
gmsh_objects := $(patsubst %.c,$(BUILD)/%.o,$(wildcard cmd/common/gmsh/*.c))
headers := $(call in_library,.h)
public_headers := lib/termesh.h $(shell sed -n 's|^.include "\(.*\)"|lib/\1|p' lib/termesh.h)
unit_tests := $(addprefix $(BUILD)/tests/,$(filter-out $(left_out),\
	$(basename $(notdir $(wildcard tests/unit/test_*.c)))))
oracles := $(patsubst tests/oracle/%.cc,$(BUILD)/tests/%,$(wildcard tests/oracle/*.cc))
rank_tests := $(if $(has_p4est),$(patsubst tests/ranks/%.c,$(BUILD)/ranks/%,$(wildcard tests/ranks/*.c)))
fuzzer := $(BUILD)/fuzz/fuzz
fuzz_names := $(filter-out $(left_out),$(basename $(notdir $(wildcard tests/fuzz/targets/*.c))))
fuzz_targets := $(fuzz_names:%=$(BUILD)/fuzz/targets/%)
replays := $(fuzz_names:%=$(BUILD)/fuzz/replay/%)
faults := $(BUILD)/faults/preload.so
solver := $(BUILD)/solve/poisson
benchers := $(patsubst tests/bench/%.c,$(BUILD)/bench/%,$(wildcard tests/bench/*.c))
shapes := $(BUILD)/bench/shapes
page := lib/view/page/page.html lib/view/page/page.css $(addprefix lib/view/page/,\
	data.js facets.js colour.js cut.js section.js lines.js draw.js controls.js pick.js \
	histogram.js state.js panel.js keys.js main.js)
generated := $(BUILD)/generated/powers.h $(BUILD)/generated/transitions.h \
	$(if $(wildcard $(THREE)),$(BUILD)/generated/view_page.h)
pages := $(wildcard man/*.[157])
sources := $(wildcard lib/*.h lib/*/*.[ch] lib/*/*/*.[ch] lib/*/*/*/*.[ch] \
	$(filter_sources) cmd/common/*/*.[ch] tests/*/*.[ch] tests/*/*/*.[ch] tests/*/*.cc examples/*.c examples/*.cc)

.PHONY: all filters tests check coverage benchers bench fuzz lint warnings limits format \
	install uninstall clean
.SECONDARY:

all: $(bin) $(rank_bin) $(scripts) $(completions) $(library) $(shared)
ifndef has_p4est
	@echo "There is no p4est, or no mpicc: octree-mesh and octree-repair are left out." >&2
endif
ifeq ($(wildcard $(THREE)),)
	@echo "There is no $(THREE): mesh-view is left out." >&2
endif
ifndef has_gmsh
	@echo "There is no gmshc.h: gmsh-import and gmsh-export are left out." >&2
endif

filters: $(bin)

# Programs of the tree that write tables of the library.
$(BUILD)/generated/%.h: $(BUILD)/generate/%
	@mkdir -p $(@D)
	$< >$@.new
	mv $@.new $@

$(BUILD)/generate/powers: lib/number/generate/powers.c
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -o $@ $< $(LDFLAGS) $(LDLIBS)

$(BUILD)/generate/transitions: $(wildcard lib/octree/transition/generate/*.[ch]) \
		lib/octree/transition/face_pieces.c lib/octree/transition/leaf_point.c \
		lib/octree/transition/transition.h lib/element/shape.c
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -o $@ $(filter %.c,$^) $(LDFLAGS) $(LDLIBS)

# The page of mesh-view, but for the mesh.
$(BUILD)/generated/view_page.h: $(BUILD)/generate/embed $(THREE) $(page) Makefile
	@mkdir -p $(@D)
	$< $(THREE) $(page) >$@.new
	mv $@.new $@

$(BUILD)/generate/embed: lib/view/generate/embed.c lib/view/base64.h
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -o $@ $< $(LDFLAGS) $(LDLIBS)

$(BUILD)/%.o: %.c Makefile | $(generated)
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -MMD -MP -c -o $@ $<

$(library): $(library_objects)
$(common): $(common_objects)
$(library) $(common):
	rm -f $@
	$(AR) rcs $@ $^

$(shared): $(library_objects) lib/termesh.map
	$(CC) $(TM_CFLAGS) -shared -Wl,-soname,libtermesh.so.$(SOVERSION) \
		-Wl,--version-script=lib/termesh.map -o $@ $(library_objects) $(LDFLAGS) $(LDLIBS)

define link
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -o $@ $(filter %.o,$^) $(filter %.a,$^) $(LDFLAGS) $(LDLIBS)
endef
$(gmsh_filters:%=$(BUILD)/bin/%): $(gmsh_objects)
$(gmsh_filters:%=$(BUILD)/bin/%): private LDLIBS += -lgmsh -ldl
$(filter %-import,$(bin)): $(BUILD)/bin/%: $(BUILD)/cmd/import/%.o $(common) $(library)
	$(link)
$(filter %-export,$(bin)): $(BUILD)/bin/%: $(BUILD)/cmd/export/%.o $(common) $(library)
	$(link)
$(filter-out %-import %-export,$(bin)): $(BUILD)/bin/%: $(BUILD)/cmd/%.o $(common) $(library)
	$(link)

$(filter %-export,$(rank_bin)): $(BUILD)/libexec/termesh/mpi/%: $(BUILD)/cmd/export/%.o \
		$(ranks_object) $(common) $(library)
	$(link)
$(filter-out %-export,$(rank_bin)): $(BUILD)/libexec/termesh/mpi/%: $(BUILD)/cmd/%.o \
		$(ranks_object) $(common) $(library)
	$(link)

$(scripts): $(BUILD)/bin/%: cmd/%.sh
	@mkdir -p $(@D)
	cp $< $@
	chmod 755 $@

# A filter prints its options; the file for zsh is made with that for bash.
$(completions): $(BUILD)/completion/bash/%: $(BUILD)/bin/% cmd/completion.sh
	sh cmd/completion.sh $< $(BUILD)/completion

$(unit_tests): $(BUILD)/tests/%: $(BUILD)/tests/unit/%.o $(common) $(library)
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -o $@ $^ $(LDFLAGS) -lcmocka $(LDLIBS)

# In this one allocations fail.
$(BUILD)/tests/test_memory: private LDFLAGS += -Wl,--wrap=malloc,--wrap=calloc,--wrap=realloc

# Calls all functions with NULL for their tm_error.
$(BUILD)/generated/null_error.h: tests/null_error.py $(headers)
	@mkdir -p $(@D)
	python3 $< $(filter %.h,$^) >$@.new
	mv $@.new $@

$(BUILD)/tests/unit/test_null_error.o: $(BUILD)/generated/null_error.h
$(BUILD)/tests/test_null_error: $(BUILD)/tests/fuzz/damage.o

# C++ programs that compare with the C++ library.
$(oracles): $(BUILD)/tests/%: tests/oracle/%.cc tests/unit/random.h $(library)
	@mkdir -p $(@D)
	$(CXX) -std=c++17 -Wall -Wextra $(werror) $(SANITIZE) $(CPPFLAGS) $(CXXFLAGS) \
		-o $@ $< $(library) $(LDFLAGS) $(LDLIBS)

$(fuzzer): $(patsubst %.c,$(BUILD)/%.o,$(wildcard tests/fuzz/*.c)) $(library)
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -o $@ $^ $(LDFLAGS) $(LDLIBS)

# One target by libFuzzer, and the same for the files of its corpus alone.
$(fuzz_targets): $(BUILD)/fuzz/targets/%: $(BUILD)/tests/fuzz/targets/%.o $(library)
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -fsanitize=fuzzer -o $@ $^ $(LDFLAGS) -lcmocka $(LDLIBS)

$(replays): $(BUILD)/fuzz/replay/%: $(BUILD)/tests/fuzz/targets/%.o \
		$(BUILD)/tests/fuzz/replay/replay.o $(library)
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -o $@ $^ $(LDFLAGS) -lcmocka $(LDLIBS)

# For tests/cli/faults.bats: calls that fail.
$(faults): tests/faults/preload.c
	@mkdir -p $(@D)
	$(CC) $(filter-out -fsanitize%,$(TM_CFLAGS)) -shared -o $@ $< $(LDFLAGS)

$(benchers): $(BUILD)/bench/%: $(BUILD)/tests/bench/%.o $(library)
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -o $@ $^ $(LDFLAGS) $(LDLIBS)

$(shapes): $(patsubst %.c,$(BUILD)/%.o,$(wildcard tests/shapes/*.c))
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -o $@ $^ $(LDFLAGS) -lm

# Needs SuiteSparse; tests/cli/solve.bats, an example and a benchmark run it.
$(solver): $(patsubst %.c,$(BUILD)/%.o,$(wildcard tests/solve/*.c)) $(library)
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -o $@ $^ $(LDFLAGS) -lcholmod $(LDLIBS)

# Programs that mpirun starts.
$(rank_tests): $(BUILD)/ranks/%: $(BUILD)/tests/ranks/%.o $(ranks_object) $(library)
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -o $@ $^ $(LDFLAGS) -lcmocka $(LDLIBS)

# What the tests run.
tests: all $(rank_tests) $(unit_tests) $(oracles) $(fuzzer) $(replays) $(faults) $(solver) \
		$(shapes)

check: tests
	sh tests/run.sh $(BUILD) $(ONLY)

# All tests, or ONLY those, and what of lib/ they run: tests/coverage.py.
ifneq ($(filter-out 0,$(COVERAGE)),)
coverage: tests
	rm -rf $(coverage_counts)
	find $(BUILD) -name '*.gcda' -delete
	-TM_COUNTS=$(coverage_counts) sh tests/run.sh $(BUILD) $(ONLY)
	python3 tests/coverage.py $(BUILD)
else
coverage:
	$(MAKE) COVERAGE=1 coverage
endif

# Always under the sanitizers.
ifeq ($(SAN),fuzzer)
fuzz: $(fuzz_targets)
	sh tests/fuzz/targets.sh $(BUILD) $(FUZZ_SECONDS) $(FUZZ_TARGETS)
else ifneq ($(filter-out 0 thread,$(SAN)),)
fuzz: all $(fuzzer)
	$(fuzzer) $(BUILD)/bin $(FUZZ_CASES)
else
fuzz:
	$(MAKE) SAN=1 fuzz
	$(MAKE) SAN=fuzzer fuzz
endif

# What the benchmarks run; each is a script that can be run alone.
benchers: all $(benchers) $(shapes)

bench: benchers
	for bench in tests/bench/*.sh; do sh "$$bench" || exit; done

lint: WERROR = 1
lint: $(generated) $(BUILD)/generated/null_error.h
	sh tests/lint.sh $(BUILD)

warnings:
	sh tests/warnings.sh $(BUILD)

limits: all
	$(MAKE) BUILD=$(BUILD)/limits CPPFLAGS="$(CPPFLAGS) -DTM_IDS=16000u" filters
	sh tests/limits.sh $(BUILD) $(BUILD)/limits

format:
	clang-format -i $(sources)

install: all
	install -d $(DESTDIR)$(BINDIR) $(DESTDIR)$(LIBDIR)/pkgconfig
	install -m 755 $(bin) $(scripts) $(DESTDIR)$(BINDIR)
ifneq ($(rank_bin),)
	install -d $(DESTDIR)$(LIBEXECDIR)
	install -m 755 $(rank_bin) $(DESTDIR)$(LIBEXECDIR)
endif
	install -d $(DESTDIR)$(BASHCOMPLETIONDIR) $(DESTDIR)$(ZSHCOMPLETIONDIR)
	install -m 644 $(completions) $(DESTDIR)$(BASHCOMPLETIONDIR)
	install -m 644 $(filters:%=$(BUILD)/completion/zsh/_%) $(DESTDIR)$(ZSHCOMPLETIONDIR)
	install -m 644 $(library) $(DESTDIR)$(LIBDIR)
	install -m 755 $(shared) $(DESTDIR)$(LIBDIR)
	for link in libtermesh.so.$(SOVERSION) libtermesh.so; do \
		ln -sf $(notdir $(shared)) $(DESTDIR)$(LIBDIR)/$$link || exit; \
	done
	for header in $(public_headers); do \
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
	rm -f $(filters:%=$(DESTDIR)$(BINDIR)/%) $(scripts:$(BUILD)/bin/%=$(DESTDIR)$(BINDIR)/%) \
		$(rank_filters:%=$(DESTDIR)$(LIBEXECDIR)/%) $(DESTDIR)$(LIBDIR)/libtermesh.* \
		$(DESTDIR)$(LIBDIR)/pkgconfig/termesh.pc \
		$(filters:%=$(DESTDIR)$(BASHCOMPLETIONDIR)/%) \
		$(filters:%=$(DESTDIR)$(ZSHCOMPLETIONDIR)/_%)
	rm -rf $(DESTDIR)$(INCLUDEDIR)/termesh
	rmdir $(DESTDIR)$(LIBEXECDIR) $(DESTDIR)$(dir $(LIBEXECDIR)) 2>/dev/null || :
	for page in $(pages); do \
		rm -f $(DESTDIR)$(MANDIR)/man$${page##*.}/$${page#man/} || exit; \
	done

clean:
	rm -rf $(BUILD)

-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
