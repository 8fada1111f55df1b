# `make run` reproduces the paper's experiment, `make test` runs the tests; both install what they need.
SHELL := /bin/bash
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:

PYTHON311 ?= $(firstword $(shell command -v python3.11 2>/dev/null) $(shell command -v uv >/dev/null 2>&1 && uv python find 3.11 2>/dev/null))
VENV ?= .venv
BIN := $(VENV)/bin
FMUS := build/fmus
JOBS ?= 2
# Small matrices only: threads of BLAS cost more than they bring, and would compete with the other run.
export OPENBLAS_NUM_THREADS := 1
export OMP_NUM_THREADS := 1

comma := ,

.PHONY: help run plan prove real nightly test test-long test-slow test-wheel wheel docs check lint types imports fmus setup dev bench lock clean distclean

help:  ## show this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / {printf "  make %-10s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

# Starts in MuJoCo for the bands (0: none), or starts in Bullet instead, which take three times as long.
STARTS ?= 1
BANDS ?= $(if $(filter 1,$(STARTS)),12,0)
run: plan setup fmus  ## the paper's experiment: all runs, figures and the scorecard with bands, in runs/reproduce
	@$(BIN)/cosim reproduce --out runs/reproduce --starts $(STARTS) --bands $(BANDS)

plan:
	@echo "make run does the paper's experiments in Bullet$(if $(filter 1,$(STARTS)),, from $(STARTS) starts)$(if $(filter 0,$(BANDS)),,, then bands over $(BANDS) starts in MuJoCo):" \
	  "$(if $(filter-out 0,$(BANDS)),30 to 40 minutes on two cores (make run BANDS=0: without bands$(comma) 7 min),7 min a start on two cores). In this order:"
	@echo "  1. a virtual environment in $(VENV) and libngspice (the first time: downloads, minutes)"
	@echo "  2. the FMUs from their C sources (the first time: seconds; compiler lines go to $(FMUS)/build.log)"
	@echo "  3. the paper's experiments, figures and scorecard; before it begins it says how long each takes"

PROOF ?= runs/prove
prove: dev fmus  ## the diagnosis on 480 cases with concealed effects (three hours); what is done is kept in runs/prove
	$(BIN)/cosim prove --cases 480 --seed 1 --out $(PROOF) --jobs $(JOBS)
	$(BIN)/cosim prove --table $(PROOF) --page docs/proving-results.md

REAL ?= runs/real
real: dev fmus  ## the diagnosis on public recordings: make real RECORDINGS=folder of their raw files (docs/real-recordings.md)
	test -d $(REAL)/recordings || $(BIN)/python -m evaluation.real --recordings "$(RECORDINGS)" --out $(REAL)/recordings
	test -d $(REAL)/recordings/paper_cooling || $(BIN)/python -m evaluation.real.paper_cooling --out $(REAL)/recordings
	$(BIN)/python -m evaluation.real.table --recordings $(REAL)/recordings --out $(REAL)/diagnoses

test: dev fmus  ## the tests that took less than 2.5 seconds each when measured (twelve minutes on two cores)
	$(BIN)/python -m pytest -n $(JOBS) --dist worksteal -m "not slow and not long"

test-long: dev fmus  ## tests of seconds to a minute each, listed in tests/long_tests.txt (about half an hour)
	$(BIN)/python -m pytest -n $(JOBS) --dist worksteal -m "long and not slow"

test-wheel: dev  ## build the wheel, install it outside the clone and use it (two minutes)
	$(BIN)/python -m pytest -m slow tests/install

wheel: setup  ## the package, in build/wheel
	@rm -rf build/lib build/lib.* build/bdist.* build/wheel  # a module that is gone must not come back from there
	@mkdir -p build/wheel
	$(BIN)/python -m pip wheel --quiet --disable-pip-version-check --no-deps --no-build-isolation -w build/wheel .

docs: $(VENV)/.installed-docs  ## the documents as a searchable site, in build/site
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --quiet --strict

nightly: setup fmus  ## a fabric of 276 links, heated row by row, to its end (an hour), in runs/large_row_by_row
	$(BIN)/cosim run large_row_by_row $(if $(wildcard runs/large_row_by_row/scenario.yaml),--resume)

test-slow: dev fmus  ## tests that take minutes each
	$(BIN)/python -m pytest -n $(JOBS) --dist worksteal -m slow

check: lint types imports  ## style, types and import rules

lint: dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: dev
	$(BIN)/mypy

imports: dev
	$(BIN)/lint-imports

fmus: setup  ## build the FMUs from their C sources
	@mkdir -p $(FMUS)
	@$(MAKE) --no-print-directory -C fmus PYTHON=$(abspath $(BIN))/python BUILD=$(abspath $(FMUS)) COILS=36 \
	  >$(FMUS)/build.log 2>&1 || { tail -n 20 $(FMUS)/build.log; echo "the FMUs cannot be built; all lines: $(FMUS)/build.log"; exit 1; }

bench: dev fmus  ## all measurements of speed and convergence, written to benchmarks/results
	$(BIN)/python -m benchmarks

setup: $(VENV)/.installed  ## virtual environment and libngspice

dev: $(VENV)/.installed-dev  ## the same with the tools for tests and checks

$(VENV)/bin/python:
	@test -n "$(PYTHON311)" || { echo "Python 3.11 is needed (pybullet and scikit-sundae both have wheels for it alone)." \
	  "Install python3.11 and python3.11-venv, or run 'uv python install 3.11'; or name one: make PYTHON311=/path/to/python3.11"; exit 1; }
	@"$(PYTHON311)" -c 'import sys; sys.exit(sys.version_info[:2] != (3, 11))' || { echo "$(PYTHON311) is not Python 3.11"; exit 1; }
	@"$(PYTHON311)" -c 'import venv, ensurepip' 2>/dev/null || { echo "$(PYTHON311) cannot make virtual environments: install python3.11-venv"; exit 1; }
	@command -v gcc >/dev/null || { echo "gcc is needed to build the FMUs: install gcc (Debian, Ubuntu: build-essential)"; exit 1; }
	"$(PYTHON311)" -m venv $(VENV)

$(VENV)/.installed: requirements.lock pyproject.toml setup.py tools/install_ngspice.sh $(wildcard cosim/native/*.[ch]) \
  | $(VENV)/bin/python
	tools/install_ngspice.sh $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation -e .
	@touch $@

$(VENV)/.installed-dev: requirements-dev.lock $(VENV)/.installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements-dev.lock
	@touch $@

$(VENV)/.installed-docs: requirements-docs.lock $(VENV)/.installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements-docs.lock
	@touch $@

lock:  ## pin the newest versions that pyproject.toml allows (needs uv)
	uv pip compile pyproject.toml --extra mujoco --python-version 3.11 --generate-hashes --no-header --no-emit-index-url --upgrade -q -o requirements.lock
	uv pip compile pyproject.toml --extra dev -c requirements.lock --python-version 3.11 --generate-hashes --no-header --no-emit-index-url --upgrade -q -o requirements-dev.lock
	uv pip compile pyproject.toml --extra docs -c requirements-dev.lock --python-version 3.11 --generate-hashes --no-header --no-emit-index-url --upgrade -q -o requirements-docs.lock

clean:  ## remove what is built; runs and the virtual environment stay
	rm -rf build .pytest_cache .mypy_cache .ruff_cache .import_linter_cache .hypothesis
	find . -name __pycache__ -not -path "./$(VENV)/*" -prune -exec rm -rf {} +

distclean: clean  ## remove the virtual environment too
	rm -rf $(VENV) *.egg-info cosim/native/_stepper*.so
