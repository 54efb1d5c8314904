# make serve   start the service on http://127.0.0.1:8000 (change this with MECHSYNTH_HOST, MECHSYNTH_PORT, ...); with
#              MECHSYNTH_CAD=1 also install the libraries that make solids of parts
# make quick   run the tests that take less than a second of CPU time each: all of them, or those in TESTS=...
# make test    run ruff, mypy, import-linter and the whole pytest suite except the tests that have a target of their own
# make test-faults  kill processes and report the outcome of their jobs, with figures
# make test-cluster  test the service on PostgreSQL with worker hosts (installed if missing, when run as root)
# make test-browser  drive the studio in the system's Chromium, check its types and its accessibility, and run a
#              generated TypeScript client in node (Chromium and node are installed if missing, when run as root)
# make test-cad  run the tests of solids, in a separate environment with the extra cad (.venv-cad, a gigabyte)
# make campaign  check thousands of random problems, as many as fit into MINUTES, or all with MINUTES=inf (independent
#              multibody programs are installed for comparison), and all kinds in the studio on a phone
# make fuzz    send hundreds of requests to each operation, and absurd problems of each kind; takes half an hour.
#              FUZZED=100000 posts that number of corrupted analyses, and a twentieth of it as jobs
# make format  format the sources as required by make check and make test-browser
# make demo    solve one real problem over HTTP, print the answer, and draw it to var/demo.svg
# make docs    build the site in var/site: all pages, the references, and a gallery of machines that the build solves
# make test-docs  build the site, and check that every link works and that all code shown has been run
# make package  build a wheel in dist/
# make vendor  fetch the published files of three.js, with which the studio shows assemblies
# make openapi  write the OpenAPI document to var/openapi.json, and the contract with which a test compares the API
# make types   generate the studio's TypeScript types of the API, service/studio/types/api.d.ts, for an editor
# make lock    resolve the dependencies in pyproject.toml again

PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
STAMP  := $(VENV)/.installed
SERVING := $(VENV)/.serving
INSTALLER := $(VENV)/installer
PIP    := $(PYTHON) -m pip --python $(BIN)/python
UV     := $(INSTALLER)/bin/uv --quiet --config-file $(INSTALLER)/uv.toml
NODE   := tests/node/node_modules/.installed
MULTIBODY := $(VENV)/.multibody
SITE   := $(VENV)/.site
CAD    := $(VENV)/.cad

# Test files are distributed over two processes, in the order of tests/conftest.py. On a machine with more processors:
# make test PROCESSES=4.
PROCESSES := 2
SPREAD := -n $(PROCESSES) --dist loadfile --no-loadscope-reorder
# Tests that have a target of their own are deselected. Folders with nothing else are not even imported.
APART := not campaign and not fuzz and not faults and not browser and not cluster and not site and not cad
BESIDES := $(addprefix --ignore tests/,browser cad cluster faults node)

export PYTHONDONTWRITEBYTECODE :=

.PHONY: marks vendor serve test format fuzz test-cluster engines test-faults test-browser chromium campaign demo check quick bench openapi types lock package docs \
    test-docs clean suite test-cad cad-suite

serve: $(SERVING) $(if $(filter-out 0 false no,$(MECHSYNTH_CAD)),$(CAD))
	@exec $(BIN)/mechsynth serve

demo: $(SERVING)
	@$(BIN)/mechsynth demo --output var/demo.svg

test: $(STAMP)
	@$(MAKE) --no-print-directory -j2 check suite

suite: $(STAMP)
	$(BIN)/pytest -m "$(APART)" $(SPREAD) $(BESIDES)

# Checks the mark `slow` against the CPU time of every test. Needs a machine without other load.
marks: $(STAMP)
	$(BIN)/pytest -m "$(APART)" --check-marks $(SPREAD) $(BESIDES)

# Tests of the service on PostgreSQL with worker hosts: real servers on free ports.
ON_POSTGRESQL := tests/cluster tests/service/api/test_access.py tests/service/api/test_idempotency.py \
    tests/service/api/test_limits.py $(addprefix tests/service/jobs/test_,batch_store.py batches.py events.py faults.py \
    jobs_api.py store.py turns.py upgrade.py)

test-cluster: $(STAMP) engines
	$(BIN)/pytest -m "not embedded" -q --backend postgresql $(SPREAD) $(ON_POSTGRESQL)

engines:
	@ls /usr/lib/postgresql/*/bin/postgres > /dev/null 2>&1 \
	    || { test "$$(id -u)" = 0 && command -v apt-get >/dev/null && apt-get update -q \
	    && apt-get install -qy --no-install-recommends postgresql; } \
	    || { echo "the cluster tests need Debian's postgresql: apt-get install postgresql"; exit 1; }

# Tests that measure wall-clock time run alone, after all others.
TIMED := tests/browser/test_smoothness.py

test-browser: $(STAMP) $(NODE) chromium
	$(BIN)/pytest -m "browser and not campaign" $(SPREAD) --ignore $(TIMED) tests/browser tests/node
	$(BIN)/pytest -m browser $(TIMED)

chromium:
	@test -x /usr/bin/chromium || { test "$$(id -u)" = 0 && command -v apt-get >/dev/null \
	    && apt-get update -q && apt-get install -qy --no-install-recommends chromium; } \
	    || { echo "the browser tests need Debian's chromium: apt-get install chromium"; exit 1; }

# Other tests check the service without the extra cad, so the extra is installed in a separate environment.
test-cad:
	@$(MAKE) --no-print-directory VENV=.venv-cad cad-suite

# All tests of a design run in one process, so that its solids are made once; other tests are grouped by file.
cad-suite: $(VENV)/.cad-tests $(NODE)
	$(BIN)/pytest -m "cad or not slow" -q -n 2 --dist loadgroup tests/cad tests/service/parts/test_parts.py

$(VENV)/.cad-tests: requirements.lock pyproject.toml $(INSTALLER)/uv.toml
	@echo "installing the locked packages and the extra cad (once; a minute or two)"
	@$(INSTALL) --extra cluster --extra telemetry --extra cad --group dev --group mesh
	@$(EDITABLE)
	@touch $@

# Time limit for the random cases, minutes. The cases in the browser get about a quarter of it in addition.
MINUTES := 4
BROWSER_MINUTES := $(if $(filter inf,$(MINUTES)),inf,$(shell expr \( $(MINUTES) + 3 \) / 4))

campaign: $(STAMP) $(MULTIBODY) $(NODE) chromium
	$(BIN)/pytest -m "campaign and not browser and not cad" --campaign-minutes $(MINUTES) $(SPREAD) $(BESIDES)
	$(BIN)/pytest -m "campaign and browser" --campaign-minutes $(BROWSER_MINUTES) $(SPREAD) tests/browser

# Number of corrupted analyses that are posted to a server with a memory limit. A twentieth as many jobs are posted, too.
# The server must survive all of them.
FUZZED := 5000

fuzz: $(STAMP)
	$(BIN)/pytest -m fuzz -s
	$(BIN)/python -m benchmarks.request_fuzz --analyses $(FUZZED) --jobs $$(( $(FUZZED) / 20 ))

# Processes are killed at random and at every write, and the outcome of their jobs is printed. It takes a quarter of an
# hour with a single server, and as long again with a cluster.
test-faults: $(STAMP) engines
	$(BIN)/pytest -m "faults and not cluster" -n 2 -rP -q tests/faults
	$(BIN)/pytest -m "faults and cluster" -s -q --backend postgresql tests/faults
	MECHSYNTH_RESTARTS=10 $(BIN)/pytest -s -q --backend postgresql tests/cluster/test_restarts.py

check: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

format: $(STAMP) $(NODE)
	$(BIN)/ruff format .
	cd service/studio && ../../tests/node/node_modules/.bin/prettier --print-width 120 --write '**/*.js' '!vendor/**'

# For the edit-test loop: all tests except those marked slow, or the given TESTS: make quick TESTS=tests/synthesis
quick: $(STAMP)
	$(BIN)/pytest -m "not slow and $(APART)" -q $(SPREAD) $(BESIDES) $(TESTS)

bench: $(STAMP)
	$(BIN)/python -m benchmarks.analysis
	$(BIN)/python -m benchmarks.motion
	$(BIN)/python -m benchmarks.path
	$(BIN)/python -m benchmarks.function
	$(BIN)/python -m benchmarks.path_fit
	$(BIN)/python -m benchmarks.straight_line
	$(BIN)/python -m benchmarks.dwell
	$(BIN)/python -m benchmarks.parallel_motion
	$(BIN)/python -m benchmarks.quick_return
	$(BIN)/python -m benchmarks.steering
	$(BIN)/python -m benchmarks.curve_match
	$(BIN)/python -m benchmarks.gear_train
	$(BIN)/python -m benchmarks.planetary
	$(BIN)/python -m benchmarks.cam_core
	$(BIN)/python -m benchmarks.cam
	$(BIN)/python -m benchmarks.service
	$(BIN)/python -m benchmarks.opening
	$(BIN)/python -m benchmarks.geometry_fuzz --cases 200

docs: $(SITE)
	$(BIN)/python -m tools.site

# One process builds the site and checks it, the other runs the tutorials.
test-docs: $(SITE)
	$(BIN)/pytest -m site -n 2 --dist loadfile tests/tools/test_site.py tests/tools/test_tutorials.py

# This rewrites tests/service/api/contract.txt. Review the difference before you commit it.
openapi: $(STAMP)
	$(BIN)/python -m tools.contract

types: $(STAMP) $(NODE)
	$(BIN)/python -m tools.studio.types

# The wheel has everything needed outside a checkout: pip install dist/*.whl && mechsynth serve
package: $(INSTALLER)/uv.toml
	@rm -rf build dist
	@$(UV) build --wheel --python $(PYTHON) --require-hashes --build-constraints requirements.lock --out-dir dist
	@rm -rf build
	@ls dist/*.whl

# The files are unchanged except for one import: OrbitControls.js imports 'three', which needs an import map, and a page
# whose policy forbids inline scripts cannot have one. This is the last release that has minified files for browsers.
THREE := 0.185.1
THREE_SUM := a2143f5bf978bd3470a51024b2b6bdd581913ba8f36ff1538d433f3a95adf2df
FOR_STUDIO := service/studio/vendor

vendor:
	@rm -rf var/vendor && mkdir -p var/vendor $(FOR_STUDIO)
	@cd var/vendor && npm pack --silent three@$(THREE) && echo "$(THREE_SUM)  three-$(THREE).tgz" | sha256sum --check --quiet \
	    && tar xzf three-$(THREE).tgz
	@cp var/vendor/package/build/three.core.min.js var/vendor/package/build/three.module.min.js $(FOR_STUDIO)/
	@cp var/vendor/package/LICENSE $(FOR_STUDIO)/three.LICENSE
	@sed "s#} from 'three';#} from './three.module.min.js';#" var/vendor/package/examples/jsm/controls/OrbitControls.js \
	    > $(FOR_STUDIO)/OrbitControls.js

# The virtual environment is created without ensurepip, which some systems do not have. The system's pip installs uv in
# a folder of its own, and uv installs everything else in a tenth of pip's time. uv does not read pip's settings, so an
# index URL in them is passed on.
$(INSTALLER)/uv.toml: requirements.lock
	@test -x $(BIN)/python || $(PYTHON) -m venv --without-pip $(VENV)
	@sed -n "/^uv==/,/# via/p" requirements.lock > $(VENV)/uv.lock
	@$(PIP) install --quiet --disable-pip-version-check --no-compile --upgrade --target $(INSTALLER) --require-hashes \
	    -r $(VENV)/uv.lock
	@{ $(PIP) config get :env:.index-url || $(PIP) config get global.index-url; } 2> /dev/null \
	    | sed 's/.*/index-url = "&"/' > $@

# One lock file has the packages of all extras and groups in pyproject.toml, so users get the versions that developers
# have tested. A package that is not in it, or has another hash, is refused.
INSTALL = $(UV) pip install --python $(BIN)/python --require-hashes --constraints requirements.lock -r pyproject.toml

# Installs the project itself, and compiles all packages to bytecode on all processors.
EDITABLE = $(UV) pip install --python $(BIN)/python --no-deps --build-constraints requirements.lock -e . \
    && $(BIN)/python -m compileall -q -j 0 -x '/tests?/' $(VENV)/lib

# Packages for serving. The kernels of the most common problems are compiled at the first start, and the others while
# the service is running.
$(SERVING): requirements.lock pyproject.toml $(INSTALLER)/uv.toml
	@echo "installing the locked packages (once; half a minute)"
	@$(INSTALL)
	@$(EDITABLE)
	@touch $@

# Additional packages for solids: Open CASCADE and its dependencies.
$(CAD): requirements.lock pyproject.toml | $(SERVING)
	@echo "installing the extra cad (once; a gigabyte)"
	@$(INSTALL) --extra cad
	@touch $@

# Packages for development, with all kernels compiled.
$(STAMP): requirements.lock pyproject.toml $(INSTALLER)/uv.toml
	@echo "installing the locked packages for development and compiling all kernels (once; minutes)"
	@$(INSTALL) --extra cluster --extra telemetry --group dev
	@$(EDITABLE)
	@$(BIN)/mechsynth warm
	@touch $(SERVING) $@

lock: $(INSTALLER)/uv.toml
	@$(UV) pip compile pyproject.toml --python-version 3.11 --universal --generate-hashes --no-emit-index-url --no-header \
	    --all-extras --group dev --group docs --group mesh --group multibody -o requirements.lock

# The node packages that the tests need, at the versions in package-lock.json.
$(NODE): tests/node/package.json tests/node/package-lock.json
	@command -v npm > /dev/null || { test "$$(id -u)" = 0 && command -v apt-get > /dev/null \
	    && apt-get update -q && apt-get install -qy --no-install-recommends nodejs npm; } \
	    || { echo "these tests need node and npm: apt-get install nodejs npm"; exit 1; }
	@cd tests/node && npm ci --ignore-scripts --no-audit --no-fund --loglevel=error
	@touch $@

# Independent multibody programs and a parser for Modelica, which only the campaign uses.
$(MULTIBODY): requirements.lock | $(STAMP)
	@$(INSTALL) --group multibody
	@touch $@

# Packages that build the site and execute its notebooks.
$(SITE): requirements.lock | $(STAMP)
	@$(INSTALL) --group docs
	@touch $@

clean:
	rm -rf $(VENV) .venv-cad var dist tests/node/node_modules
