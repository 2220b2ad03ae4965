# SPDX-License-Identifier: GPL-3.0-or-later
# termesh. `make` builds the filters into build/bin and the library; `make check` runs
# all tests, with SAN=1 under the address and undefined-behaviour sanitizers.

VERSION = 0.1.0
PREFIX = /usr/local
CC = cc
CXX = c++
AR = ar
CFLAGS = -O2 -g
CXXFLAGS = -O2 -g
WARNINGS = -Wall -Wextra -Wconversion -Wshadow -Wstrict-prototypes -Werror
LDLIBS = -lgmp -lm -lpthread

ifdef SAN
BUILD = build/san
SANITIZE = -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
else
BUILD = build
endif

# -ffp-contract=off: the same bytes on every machine.
TM_CFLAGS = -std=c17 -D_GNU_SOURCE -DTM_VERSION='"$(VERSION)"' -ffp-contract=off \
	$(WARNINGS) $(SANITIZE) -I$(BUILD)/generated $(CFLAGS)

filters := $(basename $(notdir $(wildcard cmd/*.c)))
bin := $(filters:%=$(BUILD)/bin/%)
library := $(BUILD)/libtermesh.a
library_objects := $(patsubst %.c,$(BUILD)/%.o,$(wildcard lib/*/*.c))
common_objects := $(patsubst %.c,$(BUILD)/%.o,$(wildcard cmd/common/*.c))
headers := $(wildcard lib/*/*.h)
unit_tests := $(patsubst tests/unit/%.c,$(BUILD)/tests/%,$(wildcard tests/unit/test_*.c))
oracles := $(patsubst tests/oracle/%.cc,$(BUILD)/tests/%,$(wildcard tests/oracle/*.cc))
generated := $(BUILD)/generated/powers.h

.PHONY: all check bench fuzz lint format install clean
.SECONDARY:

all: $(bin)

# Programs of the tree that write tables of the library.
$(BUILD)/generated/%.h: $(BUILD)/generate/%
	@mkdir -p $(@D)
	$< >$@.new
	mv $@.new $@

$(BUILD)/generate/powers: lib/base/generate/powers.c
	@mkdir -p $(@D)
	$(CC) $(TM_CFLAGS) -o $@ $< $(LDFLAGS) $(LDLIBS)

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
$(oracles): $(BUILD)/tests/%: tests/oracle/%.cc $(library)
	@mkdir -p $(@D)
	$(CXX) -std=c++17 -Wall -Wextra -Werror $(SANITIZE) $(CXXFLAGS) -o $@ $^ $(LDFLAGS) \
		$(LDLIBS)

check: all $(unit_tests) $(oracles)
	sh tests/run.sh $(BUILD)

-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
