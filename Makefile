# Two commands do everything: `make serve` runs the tool, `make test` runs the tests.
# Set-up happens on the way and is skipped while its inputs have not changed.
SHELL := /bin/bash
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
export OMP_NUM_THREADS ?= 1
export OPENBLAS_NUM_THREADS ?= 1
# Python keeps what it has compiled, whatever the surroundings say: the tests start many processes.
export PYTHONDONTWRITEBYTECODE :=

.DEFAULT_GOAL := help
.PHONY: help install page types wheel serve test test-slow ten-runs any-machine test-hard frontend-check lint format coverage mutation audit bench docs stitches lock clean

help:            ## Show the targets
	@grep -E '^[a-z-]+: .*##' $(MAKEFILE_LIST) | sed -E 's/:[^#]*##/\t/' | column -t -s $$'\t'

# --- set-up -----------------------------------------------------------------------------------
$(VENV)/.installed: requirements.lock pyproject.toml
	@$(PYTHON) scripts/check_python.py
	@echo "Making $(VENV) …"
	@test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	@echo "Installing Knitcore's packages …"
	@scripts/install product
	@scripts/install --no-deps --editable .
	@touch $@

$(VENV)/.installed-tests: $(VENV)/.installed
	@echo "Installing what the tests need …"
	@scripts/install tests
	@touch $@

frontend/node_modules/.installed: frontend/package.json frontend/package-lock.json
	@echo "Installing what bundles the page …"
	@cd frontend && npm ci --no-audit --no-fund --loglevel=error >/dev/null
	@touch $@

# The page also runs as its sources: without Node, or without a way to its packages, it gets those.
STITCHES := frontend/grid/stitches.js
PAGE_SOURCES := $(shell find frontend \( -name node_modules -o -name dist -o -name tests -o -name types.d.ts \) \
	-prune -o -type f -print)
$(STITCHES): scripts/page_stitches.py knitcore/chart/stitch_kinds.py knitcore/chart/stitch_symbols.py
	@PYTHONPATH=. $(PYTHON) scripts/page_stitches.py && touch $@

frontend/dist/index.html: $(PAGE_SOURCES) $(STITCHES)
	@( $(MAKE) --no-print-directory frontend/node_modules/.installed \
		&& echo "Bundling the page …" && node frontend/build.mjs ) \
		|| echo "The page could not be bundled (it needs Node 18 or newer): its sources are served instead."

page: frontend/dist/index.html ## Bundle the page

types: $(VENV)/.installed ## Make the page's types from the service
	@PYTHONPATH=. $(BIN)/python scripts/page_types.py

wheel: page ## Build wheel and sdist with the page in them into dist
	$(BIN)/uv build --quiet --out-dir dist .

install: $(VENV)/.installed frontend/dist/index.html ## Make .venv with the product in it, and the page

# numba compiles a kernel when it is first called, which takes up to 10 s: best before somebody waits.
# What it kept of older sources goes first: it fails to load where a class has another name now.
$(VENV)/.compiled: $(VENV)/.installed $(shell grep -rl knitcore.base.compiled --include=*.py knitcore) knitcore/warm_up.py
	@find knitcore -name '*.nb[ci]' -delete
	@$(BIN)/knitcore warm-up 2>/dev/null
	@touch $@

# --- running ----------------------------------------------------------------------------------
# Python's and Node's packages at once; OPTIONS="--port 8738" goes to `knitcore serve`
serve:           ## Run the tool and print its address
	@$(MAKE) --no-print-directory --silent -j 2 install
	@nice -n 19 $(MAKE) --no-print-directory --silent $(VENV)/.compiled & exec $(BIN)/knitcore serve $(OPTIONS)

# --- checking ---------------------------------------------------------------------------------
# A file's tests share what they compute, so they run in one process; the page's, which are to come
# last, stay last. Each process collects the tests under another seed of hashes: they are the same.
BY_FILE := -n 2 --dist loadfile --no-loadscope-reorder
test: $(VENV)/.installed-tests frontend/node_modules/.installed ## Run the default suite (with Chromium, nginx and PostgreSQL of Debian)
	scripts/ensure-packages chromium nginx-light postgresql
	@$(MAKE) --no-print-directory -j 3 $(VENV)/.compiled frontend-check page
	$(BIN)/pytest $(BY_FILE) -m "not slow"

test-slow: $(VENV)/.installed-tests $(VENV)/.compiled page ## Run the tests that take many seconds: physics, long journeys through the page, wheels
	scripts/ensure-packages chromium firefox-esr nginx-light postgresql
	$(BIN)/pytest $(BY_FILE) -m slow --durations 12

ten-runs: ## Run both suites ten times, two at a time, in fresh clones; logs in build
	scripts/ten-runs 10 build/ten-runs.log test
	scripts/ten-runs 10 build/ten-slow-runs.log test-slow

any-machine: $(VENV)/.installed-tests ## Compare answers under several instruction sets of this machine; OPTIONS="--short"
	$(BIN)/python -m scripts.any_machine $(OPTIONS)

coverage: $(VENV)/.installed-tests page ## Tell which lines the default suite runs, workers included
	$(BIN)/pip install --quiet --disable-pip-version-check coverage==7.17.3
	$(BIN)/coverage erase
	$(BIN)/coverage run -m pytest $(BY_FILE) -m "not slow"; $(BIN)/coverage combine --quiet
	$(BIN)/coverage report

test-hard: $(VENV)/.installed-tests ## Kill the service 50 times, send thousands of hostile requests, take disk, database and workers away
	scripts/ensure-packages postgresql
	$(BIN)/pytest -m postgres tests/app
	KNITCORE_KILLS=50 KNITCORE_OUTAGE_S=30 KNITCORE_SCHEMA_EXAMPLES=60 KNITCORE_SOAK_S=1800 $(BIN)/pytest -s \
		tests/app/whole_service/test_faults.py tests/app/whole_service/test_documented.py tests/app/whole_service/test_soak.py \
		tests/app/service/jobs/test_kinds.py tests/app/service/compute/test_cluster.py

frontend-check: types frontend/node_modules/.installed
	cd frontend && npm run --silent check && npm run --silent test

lint: types $(VENV)/.installed-tests frontend/node_modules/.installed ## ruff, mypy --strict; tsc, eslint, prettier
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	cd frontend && npm run --silent check

.audit/.installed:
	$(PYTHON) -m venv .audit
	.audit/bin/pip install --quiet --disable-pip-version-check pip-audit bandit
	touch $@

build/product.txt: requirements.lock
	@mkdir -p build && sed '/^# --- installer/,$$d' $< >$@

audit: $(VENV)/.installed-tests build/product.txt ## Risky code, licences, list of packages; known holes where PyPI answers
	$(BIN)/ruff check --quiet --select S app knitcore
	$(BIN)/python -m scripts.audit
	@if $(MAKE) --no-print-directory .audit/.installed; then \
		.audit/bin/bandit --quiet --severity-level medium -c pyproject.toml -r app knitcore && \
		{ .audit/bin/pip-audit --strict --disable-pip --require-hashes -r build/product.txt 2>build/holes.txt || \
			{ cat build/holes.txt; grep -q "not found on PyPI" build/holes.txt && echo "Nobody looked for known holes: this index has no list of them."; }; }; \
	else echo "PyPI does not answer: bandit did not run, and nobody looked for known holes."; fi

format: $(VENV)/.installed-tests frontend/node_modules/.installed ## Format the code
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .
	cd frontend && npm run --silent format

bench: $(VENV)/.installed-tests ## Print how fast it is: CPU times and ratios
	for name in first_use goals cost swatch curl yarn page start service readers attacks; do \
		echo "== $$name"; $(BIN)/python -m studies.speed.$$name || exit 1; done

docs: $(VENV)/.installed-tests ## Build the documentation as a site in build/site; no network needed
	PYTHONPATH=. NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --quiet --strict
	@echo "build/site/index.html; with its search: python -m http.server --directory build/site"

mutation: $(VENV)/.installed-tests ## Would the tests notice? Changes the code in 1,000 ways (half an hour)
	$(BIN)/pip install --quiet --disable-pip-version-check mutmut==3.8.1
	$(BIN)/mutmut run --max-children 2
	$(BIN)/mutmut results

stitches: install ## Make the packaged relaxed stitches again; OPTIONS="--scheduler tcp://…" or "--workers 2"
	$(BIN)/python -m scripts.stored_stitches $(OPTIONS)
	$(BIN)/python -m scripts.from_store lowest bending

# --- upkeep -----------------------------------------------------------------------------------
lock: $(VENV)/.installed-tests ## Pin the dependencies again
	scripts/lock

clean:           ## Remove what was installed and built
	rm -rf $(VENV) .audit frontend/node_modules frontend/dist build *.egg-info
