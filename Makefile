# Everything runs from here: `make help` lists the targets.
PYTHON ?= python3
VENV ?= .venv
BENCH_VENV ?= .venv-bench
# Peers of the benchmarks with an environment each, benchmarks/peer_<name>.txt; the environment is $(BENCH_VENV)-<name>.
APART := pyharm exudyn sundae
# Worker processes of the test run; the default suits two cores.
JOBS ?= 2
# What `make bench` times: a folder or one of its files.
BENCHMARKS ?= benchmarks
BIN := $(VENV)/bin
PAGE := src/torsional/workbench/page
PIP_INSTALL := -m pip install --quiet --retries 10 --timeout 60 -c constraints.txt

# One single-threaded process a core: threads inside BLAS only fight the worker processes for the caches.
export OPENBLAS_NUM_THREADS = 1
export OMP_NUM_THREADS = 1
export PIP_DISABLE_PIP_VERSION_CHECK = 1
export MPLBACKEND = Agg

.DEFAULT_GOAL := help
.NOTPARALLEL:
.DELETE_ON_ERROR:
.PHONY: help demo test test-full lint types imports docs examples page check bench constraints clean

help:  ## list the targets
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' Makefile | while IFS="$$(printf '\t')" read -r name what; do printf '  %-12s %s\n' "$$name" "$$what"; done

demo: $(VENV)/.installed-run  ## install, then compare the shipped truck's dual mass flywheel with its single mass one
	$(BIN)/torsional report examples/truck_dmf.yaml --compare examples/truck_smf.yaml
	@echo "Open it in a browser: $(CURDIR)/report.html"

# Compiled beforehand, since processes that compile one function for different arguments at the same moment may be handed each
# other's code by numba's cache.
test: $(VENV)/.installed-test  ## install what the tests need and run them all
	@$(page_if_node)
	$(BIN)/torsional warmup --quiet
	$(BIN)/python -m pytest -n $(JOBS)

test-full: $(VENV)/.installed-test  ## the tests with the heavy checks
	@$(page_if_node)
	$(BIN)/torsional warmup --quiet
	$(BIN)/python -m pytest -n $(JOBS) -m "full or not full"

lint: $(VENV)/.installed-lint  ## ruff
	$(BIN)/ruff check --no-cache .

types: $(VENV)/.installed-lint  ## mypy, strict, on the package
	$(BIN)/mypy

imports: $(VENV)/.installed-lint  ## imports go down the floors only
	$(BIN)/lint-imports --no-cache

docs: $(VENV)/.installed-docs  ## build the pages, executing them; a warning is an error
	$(BIN)/python -m sphinx -E -W --keep-going -q -b html docs docs/_build/html
	@echo "The pages are in docs/_build/html/index.html"

examples: $(VENV)/.installed-run  ## check every model file and run every script in examples/
	@set -e; for file in examples/*.yaml; do [ -e "$$file" ] || continue; echo "torsional check $$file"; $(BIN)/torsional check --quiet "$$file"; done
	@set -e; for file in examples/*.py; do [ -e "$$file" ] || continue; echo "python $$file"; $(BIN)/python "$$file"; done

page: $(PAGE)/index.html  ## the workbench's page: types, tests and build; it needs Node 20.19 or newer

check: lint types imports examples docs page test  ## everything CI runs

bench: $(BENCH_VENV)/.installed-bench $(APART:%=$(BENCH_VENV)-%/.tried)  ## time this project beside its peers, in an environment of their own
	$(BENCH_VENV)/bin/python -m pytest -c benchmarks/pytest.ini $(BENCHMARKS)

constraints:  ## pin anew: names and versions from a fresh environment, into constraints.txt
	@$(check_python)
	rm -rf .venv-pins
	$(PYTHON) -m venv .venv-pins
	.venv-pins/bin/python -m pip install --quiet --retries 10 '.[test,lint,docs,bench]' hatchling editables $(PEERS)
	.venv-pins/bin/python -m pip freeze | grep -v -e '@' -e '^-e' -e '^torsional==' > constraints.txt
	rm -rf .venv-pins

clean:  ## remove what was built, the environments too
	rm -rf $(VENV) $(BENCH_VENV) $(APART:%=$(BENCH_VENV)-%) .venv-pins page/node_modules $(PAGE) docs/_build docs/_generated jupyter_execute .benchmarks build dist
	find src tests benchmarks docs examples -name __pycache__ -type d -prune -exec rm -rf {} +

# --- environments: a stamp file says that an install is done; a change of the project file or of the pins undoes it ---

PEERS := opentorsion

# Asked only when an environment is made: one that is there has the Python it was made with.
define check_python
command -v $(PYTHON) > /dev/null || { echo "There is no '$(PYTHON)' here: install Python 3.11 or newer, or name one, as in: make demo PYTHON=python3.12"; exit 1; }; \
$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "torsional needs Python 3.11 or newer, and '$(PYTHON)' is $$($(PYTHON) -V 2>&1): name another, as in: make demo PYTHON=python3.12"; exit 1; }
endef

$(VENV)/bin/python $(BENCH_VENV)/bin/python:
	@$(check_python)
	@$(PYTHON) -m venv $(@:/bin/python=) || { echo "'$(PYTHON)' cannot make a virtual environment; on Debian and Ubuntu install python3-venv."; rm -rf $(@:/bin/python=); exit 1; }

$(VENV)/.installed-run: pyproject.toml constraints.txt | $(VENV)/bin/python
	@echo "Installing torsional into $(VENV) ..."
	@$(BIN)/python $(PIP_INSTALL) -e .
	@touch $@

$(VENV)/.installed-test $(VENV)/.installed-lint $(VENV)/.installed-docs: $(VENV)/.installed-%: pyproject.toml constraints.txt | $(VENV)/bin/python
	@echo "Installing torsional and what '$*' needs into $(VENV) ..."
	@$(BIN)/python $(PIP_INSTALL) -e '.[$*]'
	@touch $@ $(VENV)/.installed-run

$(BENCH_VENV)/.installed-bench: pyproject.toml constraints.txt | $(BENCH_VENV)/bin/python
	@echo "Installing torsional and its peers into $(BENCH_VENV) ..."
	@$(BENCH_VENV)/bin/python $(PIP_INSTALL) -e '.[test,bench]' $(PEERS)
	@touch $@

# Peers whose pins and this project's exclude each other, or that not every machine has, each in an environment of its own;
# where one cannot be installed the benchmarks go without it, and it is tried again when its list changes or the folder is
# removed.
$(BENCH_VENV)-%/.tried: benchmarks/peer_%.txt
	@$(check_python)
	@echo "Installing $* into $(@D) ..."
	@rm -rf $(@D)
	@{ $(PYTHON) -m venv $(@D) && $(@D)/bin/python -m pip install --quiet --retries 3 --timeout 60 -r $<; } || { echo "$* cannot be installed here: its benchmarks go without it."; rm -rf $(@D); }
	@mkdir -p $(@D) && touch $@

# --- the workbench's page: what it is made of undoes its build ---

define page_if_node
if command -v npm > /dev/null && node -e "const [a, b] = process.versions.node.split('.').map(Number); process.exit(a > 22 || (a == 22 && b > 11) || (a == 20 && b > 18) ? 0 : 1)"; \
then $(MAKE) --no-print-directory page; else echo "Node 20.19 or newer is not here: the workbench's page is not built, and its tests in a browser are skipped."; fi
endef

PAGE_SOURCES := $(shell find page -name node_modules -prune -o -type f -print)

page/node_modules/.installed: page/package.json page/package-lock.json
	@command -v npm > /dev/null || { echo "The workbench's page is built by Node: install Node 20.19 or newer with npm. All else goes without it."; exit 1; }
	@cd page && npm ci --no-audit --no-fund --loglevel=error
	@touch $@

$(PAGE)/index.html: page/node_modules/.installed $(PAGE_SOURCES)
	@cd page && npx tsc --noEmit && npx vitest run && npx vite build --logLevel warn
	@touch $@
