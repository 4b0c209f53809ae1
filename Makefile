# SPDX-License-Identifier: GPL-2.0-or-later
# The front door. On a fresh Debian machine `make demo` and `make test` need nothing but make.
# Everything built goes to build/.

BUILD   := build
RELEASE := $(BUILD)/release
JOBS    ?= $(shell nproc)
CMAKE   := cmake -G Ninja -S userland
# The same in tools/test, so that its release stage and `make all` compile each file once.
SETTINGS := -B $(RELEASE) -DCMAKE_BUILD_TYPE=Release -DPHANTOM_BIN=$(CURDIR)/$(BUILD)/bin

.PHONY: help all demo test hard-cases penetration fuzz vm-test vm-debug modules install bench lint clean

help: ## this list
	@awk -F':.*## ' '/^[a-z-]+:.*## /{printf "  make %-11s %s\n", $$1, $$2}' Makefile

all: ## build every program into build/bin
	@tools/bootstrap build
	@mkdir -p $(BUILD)
	@$(MAKE) --no-print-directory programs

.PHONY: programs
programs:
	@$(CMAKE) $(SETTINGS) -DPHANTOM_TESTS=OFF >$(RELEASE).log 2>&1 || { cat $(RELEASE).log; exit 1; }
	@cmake --build $(RELEASE) -j $(JOBS)

demo: ## touch the Stanford bunny: live status, picture, chart, trace
	@tools/bootstrap demo
	@mkdir -p $(BUILD)
	@$(MAKE) --no-print-directory programs
	@tools/demo

test: ## every test that needs no VM and no root, also under ASan and UBSan
	@tools/bootstrap test
	@tools/test

fuzz: ## arbitrary sets and paths through the border, with libFuzzer for SECONDS=600
	@tools/bootstrap fuzz
	@FUZZ_SECONDS=$(or $(SECONDS),600) tools/fuzz

hard-cases: ## a table: what every hard case of contact did with every model and arithmetic
	@$(MAKE) --no-print-directory table TABLE=hard_cases_table

penetration: ## a table: the force under bumpy spheres, in six minutes, against the nearest point
	@$(MAKE) --no-print-directory table TABLE=penetration_bench

.PHONY: table
table:
	@tools/bootstrap build
	@mkdir -p $(BUILD)
	@$(CMAKE) $(SETTINGS) -DPHANTOM_TESTS=ON >$(RELEASE).log 2>&1 || { cat $(RELEASE).log; exit 1; }
	@cmake --build $(RELEASE) -j $(JOBS) --target $(TABLE)
	@$(RELEASE)/bin/$(TABLE)

vm-test: ## boot Debian's RT kernels in QEMU and test the real module there
	@tools/bootstrap vm
	@mkdir -p $(BUILD)
	@$(MAKE) --no-print-directory programs
	@tools/vm-test

vm-debug: ## the same on a kernel with KASAN, lockdep, kmemleak, which the first time is built (15 minutes of CPU)
	@tools/bootstrap debug
	@mkdir -p $(BUILD)
	@$(MAKE) --no-print-directory programs
	@tools/vm-debug

modules: ## build/modules/RELEASE/phantom_rt.ko for Debian's RT kernels, or KDIR=/path/to/headers
	@tools/bootstrap modules
	@$(if $(KDIR),,tools/kernel-headers)
	@$(MAKE) --no-print-directory -j $(JOBS) -C kmod modules $(if $(KDIR),KDIR=$(abspath $(KDIR)))

install: all ## programs, scenes and the udev rule to PREFIX (/usr/local)
	@cmake --install $(RELEASE) --prefix $(or $(PREFIX),/usr/local)

# PHANTOM_PEERS stays on in the build folder: it adds targets that nothing else asks for.
bench: ## query, tick and load times on the bunny; queries beside Embree, Bullet, CGAL, FCL, VTK (PEERS="--quick")
	@tools/bootstrap bench
	@mkdir -p $(BUILD)
	@$(MAKE) --no-print-directory programs
	@$(BUILD)/bin/fdhctl bench scenes/bunny.toml
	@$(CMAKE) $(SETTINGS) -DPHANTOM_PEERS=ON >$(RELEASE).log 2>&1 || { cat $(RELEASE).log; exit 1; }
	@cmake --build $(RELEASE) -j $(JOBS) --target peers_bench
	@$(RELEASE)/bin/peers_bench --out $(BUILD)/bench $(PEERS)

lint: ## clang-format, checkpatch, clang-tidy, shellcheck
	@tools/bootstrap lint
	@tools/lint

clean: ## remove what was built
	rm -rf $(BUILD)
