# One word per chore. Needs Python 3.11 or newer; everything else is set up here.
SHELL := /bin/bash
BIN := .venv/bin
JOBS ?= 2
# The browser goes before the tests that measure time: it would run beside them to the end.
EVERY_TEST = $(BIN)/pytest -n $(JOBS) -m "not exclusive" && \
	$(BIN)/pytest -m exclusive tests/browser && $(BIN)/pytest -m exclusive --ignore=tests/browser

.PHONY: run setup test test-full lint format bench screenshots safety mutate soak clean browser toolchain help

help: ## show this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed 's/:.*## /\t/' | expand -t 14

run: .stamps/run ## open the dashboard of the simulated rig
	$(BIN)/pivotrig serve --sim --open

setup: .stamps/dev ## make the environment, with all that tests need

test: .stamps/dev .stamps/page browser toolchain ## run every test
	$(EVERY_TEST)

test-full: export PIVOTRIG_FULL := 1
test-full: .stamps/dev .stamps/page browser toolchain ## the same tests with the full numbers of repetitions
	$(EVERY_TEST)

lint: .stamps/dev .stamps/page ## style, types and the folder rules
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports
	$(BIN)/pyright
	bash .ci/javascript/types

format: .stamps/dev ## put the code into its layout
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

safety: .stamps/dev ## try every fault out and write the table of reaction times
	$(BIN)/python -m tests.faults.table

screenshots: .stamps/dev browser ## take the pictures of the README anew
	$(BIN)/python tests/browser/screenshots.py

bench: .stamps/dev ## measure, against a reference in the same run
	$(BIN)/python -m tests.benchmarks

soak: MINUTES ?= 60
soak: .stamps/dev ## hold the simulated rig to its promises for an hour of faults under load (MINUTES=60)
	$(BIN)/python -m tests.soak --minutes $(MINUTES) $(if $(SEED),--seed $(SEED))

browser:
	@bash .ci/need --program chromium chromium
	@bash .ci/need --library libatomic.so.1 libatomic1

toolchain:
	@bash .ci/need --program avr-g++ gcc-avr
	@bash .ci/need --file /usr/lib/avr/include/avr/io.h avr-libc
	@bash .ci/need --program g++ g++
	@bash .ci/need --file /usr/include/simavr/sim_avr.h libsimavr-dev
	@bash .ci/need --file /usr/include/libelf.h libelf-dev
	@bash .ci/need --program openssl openssl
	@bash .ci/need --program curl curl

.stamps/run: pyproject.toml uv.lock
	@bash .ci/environment --no-dev
	@touch $@

.stamps/dev: pyproject.toml uv.lock
	@bash .ci/environment
	@touch $@ .stamps/run

# What checks the page: TypeScript and axe-core, for the node that pyright brings along.
.stamps/page: .stamps/dev .ci/javascript/package-lock.json .ci/javascript/install
	@bash .ci/javascript/install
	@touch $@

mutate: .stamps/dev toolchain ## change the safety-critical code a line at a time: does a test notice? (an hour)
	$(BIN)/python -m tests.mutation

clean: ## remove everything that was set up
	rm -rf .venv .stamps build mutants mutants.log
