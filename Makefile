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
.PHONY: help install page wheel serve test test-slow ten-runs any-machine coverage study test-postgres test-kill test-faults fuzz lint audit sbom format types frontend-check bench bench-service docs site gallery mutation examples types stitches lock clean

help:            ## Show the targets
	@grep -E '^[a-z-]+: .*##' $(MAKEFILE_LIST) | sed -E 's/:[^#]*##/\t/' | column -t -s $$'\t'

# --- set-up -----------------------------------------------------------------------------------
$(VENV)/.installed: requirements.lock pyproject.toml
	@$(PYTHON) scripts/check_python.py
	@echo "Making $(VENV) …"
	@test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	@echo "Installing Knitcore's packages …"
	@scripts/install --require-hashes -r requirements.lock
	@scripts/install --no-deps --editable .
	@touch $@

$(VENV)/.installed-dev: requirements-dev.lock $(VENV)/.installed
	@echo "Installing what the tests need …"
	@scripts/install --require-hashes -r requirements-dev.lock
	@touch $@

frontend/node_modules/.installed: frontend/package.json frontend/package-lock.json
	@echo "Installing what bundles the page …"
	@cd frontend && npm ci --no-audit --no-fund --loglevel=error >/dev/null
	@touch $@

# The page also runs as its sources: without Node, or without a way to its packages, it gets those.
PAGE_SOURCES := $(shell find frontend \( -name node_modules -o -name dist -o -name tests \) -prune -o -type f -print)
frontend/dist/index.html: $(PAGE_SOURCES)
	@( $(MAKE) --no-print-directory frontend/node_modules/.installed \
		&& echo "Bundling the page …" && node frontend/build.mjs ) \
		|| echo "The page could not be bundled (it needs Node 18 or newer): its sources are served instead."

page: frontend/dist/index.html ## Bundle the page

wheel: page $(VENV)/.installed ## Build wheel and sdist with the page in them, and the client's, into dist
	$(BIN)/uv build --quiet --out-dir dist . && $(BIN)/uv build --quiet --wheel --out-dir dist client

install: $(VENV)/.installed frontend/dist/index.html ## Make .venv with the product in it, and the page

# numba compiles a kernel when it is first called, which takes up to 10 s: best before somebody waits.
# What it kept of older sources goes first: it fails to load where a class has another name now.
$(VENV)/.compiled: $(VENV)/.installed $(shell grep -rl knitcore.compiled --include=*.py knitcore) knitcore/warm_up.py
	@find knitcore -name '*.nb[ci]' -delete
	@$(BIN)/knitcore warm-up 2>/dev/null
	@touch $@

# --- running ----------------------------------------------------------------------------------
# Python's and Node's packages at once; OPTIONS="--port 8738" goes to `knitcore serve`
serve:           ## Run the tool and print its address
	@$(MAKE) --no-print-directory --silent -j 2 install
	@nice -n 19 $(MAKE) --no-print-directory --silent $(VENV)/.compiled & exec $(BIN)/knitcore serve $(OPTIONS)

# --- checking ---------------------------------------------------------------------------------
test: $(VENV)/.installed-dev frontend/node_modules/.installed ## Run the default suite (browser tests install Chromium if missing)
	scripts/ensure-browsers chromium
	@$(MAKE) --no-print-directory -j 3 $(VENV)/.compiled frontend-check page
	$(BIN)/pytest -n 2 --dist loadgroup -m "not slow"

test-slow: $(VENV)/.installed-dev $(VENV)/.compiled page ## Run the tests that take many seconds: physics, long journeys through the page, wheels
	scripts/ensure-browsers chromium firefox-esr
	$(BIN)/pytest -n 2 --dist loadgroup -m slow

ten-runs: ## Run the default suite ten times, two at a time, in fresh clones; log in build
	scripts/ten-runs

any-machine: $(VENV)/.installed-dev ## Compare answers under several instruction sets of this machine; OPTIONS="--short"
	$(BIN)/python -m scripts.any_machine $(OPTIONS)

coverage: $(VENV)/.installed-dev page ## Tell which lines the default suite runs, workers included
	$(BIN)/pip install --quiet --disable-pip-version-check coverage==7.17.3
	$(BIN)/coverage erase
	$(BIN)/coverage run -m pytest -n 2 --dist loadgroup -m "not slow"; $(BIN)/coverage combine --quiet
	$(BIN)/coverage report

study: $(VENV)/.installed-dev ## Compare with the study's raw data in the folder KNITCORE_STUDY_DATA
	$(BIN)/pytest benchmarks/study

test-postgres: $(VENV)/.installed-dev ## Run the tests of the designs on a real PostgreSQL
	dpkg -s postgresql >/dev/null 2>&1 || apt-get install -y --no-install-recommends postgresql
	$(BIN)/pytest -m postgres tests/app

test-kill: $(VENV)/.installed-dev ## Kill the service 50 times while designs are edited
	KNITCORE_KILLS=50 $(BIN)/pytest -s tests/app/service/designs/test_durability.py

test-faults: $(VENV)/.installed-dev ## Full disk, database away for 30 s, clients that vanish, workers that die
	KNITCORE_OUTAGE_S=30 $(BIN)/pytest tests/app/service/test_faults.py tests/app/service/jobs/test_job_kinds.py tests/app/service/compute/test_cluster.py

fuzz: $(VENV)/.installed-dev ## Send thousands of valid and invalid requests, made from the schema, to every operation
	KNITCORE_SCHEMA_EXAMPLES=60 $(BIN)/pytest -s -m slow tests/app/service/web/test_schema.py

frontend-check: frontend/node_modules/.installed
	cd frontend && npm run --silent check && npm run --silent test

lint: $(VENV)/.installed-dev frontend/node_modules/.installed ## ruff, mypy --strict; tsc, eslint, prettier
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	cd frontend && npm run --silent check

.audit/.installed:
	$(PYTHON) -m venv .audit
	.audit/bin/pip install --quiet --disable-pip-version-check pip-audit bandit cyclonedx-bom
	touch $@

audit: .audit/.installed ## Risky code (bandit) and known holes in pinned packages (pip-audit, asks PyPI)
	.audit/bin/bandit --quiet -c pyproject.toml -r app knitcore
	.audit/bin/pip-audit --strict --disable-pip --require-hashes -r requirements.lock

sbom: .audit/.installed ## List the packages of the service in sbom.json (CycloneDX)
	.audit/bin/cyclonedx-py requirements --output-reproducible --of JSON -o sbom.json requirements.lock

format: $(VENV)/.installed-dev frontend/node_modules/.installed ## Format the code
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .
	cd frontend && npm run --silent format

bench: $(VENV)/.installed-dev ## Print the benchmarks (CPU time and ratios)
	for script in benchmarks/*.py; do echo "== $$script"; $(BIN)/python $$script || exit 1; done

bench-service: $(VENV)/.installed-dev ## Fifty people paint beside computations; SECONDS=600 for ten minutes
	$(BIN)/python benchmarks/service.py

docs: $(VENV)/.installed-dev ## Run every example of the documentation
	$(BIN)/pytest -q tests/test_docs.py

site: $(VENV)/.installed-dev ## Build the documentation as a site in build/site; no network needed
	PYTHONPATH=. NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --quiet --strict
	@echo "build/site/index.html; with its search: python -m http.server --directory build/site"

gallery: $(VENV)/.installed-dev ## Make the gallery of the documentation again
	$(BIN)/python scripts/gallery.py

mutation: $(VENV)/.installed-dev ## Would the tests notice? Changes the code in 1,000 ways (half an hour)
	$(BIN)/pip install --quiet --disable-pip-version-check mutmut==3.8.1
	$(BIN)/mutmut run --max-children 2
	$(BIN)/mutmut results

examples: $(VENV)/.installed-dev ## Ask the service for the answers that the API shows as examples
	PYTHONPATH=. $(BIN)/python scripts/api_examples.py

types: $(VENV)/.installed-dev ## Make the page's types and the client from the service's models again
	PYTHONPATH=. $(BIN)/python scripts/page_types.py
	PYTHONPATH=. $(BIN)/python scripts/client_code.py

stitches: install ## Make the packaged relaxed stitches again; OPTIONS="--scheduler tcp://…" or "--workers 2"
	$(BIN)/python -m scripts.stored_stitches $(OPTIONS)
	$(BIN)/python -m scripts.lowest_stitches
	$(BIN)/python -m scripts.bending_stitches

# --- upkeep -----------------------------------------------------------------------------------
lock: $(VENV)/.installed-dev ## Pin the dependencies again
	echo uv | $(BIN)/uv pip compile --quiet --generate-hashes --no-emit-index-url --no-annotate --no-header \
		--python-version 3.11 - -o requirements-uv.lock
	$(BIN)/uv pip compile --quiet --generate-hashes --no-emit-index-url --no-annotate --python-version 3.11 \
		--extra service --extra cluster pyproject.toml -o requirements.lock
	$(BIN)/uv pip compile --quiet --generate-hashes --no-emit-index-url --no-annotate --python-version 3.11 \
		--extra service --extra cluster --extra dev pyproject.toml -c requirements.lock -o requirements-dev.lock

clean:           ## Remove what was installed and built
	rm -rf $(VENV) .audit frontend/node_modules frontend/dist build *.egg-info
