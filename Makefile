# make serve   start the service on http://127.0.0.1:8000 (MECHSYNTH_HOST, MECHSYNTH_PORT, ... change it); with
#              MECHSYNTH_CAD=1 also the libraries that make solids of parts
# make quick   the tests that take less than a second of CPU each, of all or of TESTS=...
# make test    ruff, mypy, import-linter and the whole pytest suite but the browser's: see test-browser
# make test-faults  what becomes of jobs when processes are killed, with figures
# make test-cluster  the service on PostgreSQL, RabbitMQ and Redis (installed where they are missing and we are root)
# make test-browser  drive the studio in the system's Chromium, check its types and its accessibility, and run a
#              generated TypeScript client in node (Chromium and node are installed where they are missing and we are root)
# make test-cad  the tests of solids, in an environment of their own with the extra cad (.venv-cad, a gigabyte)
# make campaign  checks with thousands of random problems, as many as fit into MINUTES, or all with MINUTES=inf (independent
#              multibody programs are installed for them), and the studio's kinds on a phone
# make fuzz    hundreds of requests of each operation, and of absurd problems of each kind; half an hour. FUZZED=100000
#              posts so many spoilt analyses, and a twentieth as many jobs
# make format  format the sources as make check and make test-browser want them
# make demo    solve one real problem through HTTP, print it, draw it to var/demo.svg
# make docs    the site, in var/site: all pages, the references, and a gallery of machines that are solved for it
# make test-docs  make the site, and see that every link holds and that what it shows has run
# make package  a wheel, in dist/
# make vendor  fetch three.js, which the studio shows assemblies with, as it is published
# make openapi  write the OpenAPI document to var/openapi.json, and the contract that a test holds the API to
# make types   make the studio's types of the API, service/studio/types/api.d.ts, for an editor
# make lock    resolve the dependencies of pyproject.toml anew

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

# Files of tests are dealt out to two processes.
SPREAD := -n 2 --dist loadfile
# What has a target of its own is not even imported.
APART := not campaign and not fuzz and not faults and not browser and not cluster and not site and not cad
BESIDES := --ignore tests/browser --ignore tests/cad

export PYTHONDONTWRITEBYTECODE :=

.PHONY: marks vendor serve test format fuzz test-cluster engines test-faults test-browser chromium campaign demo check quick bench openapi types lock package docs \
    test-docs clean suite test-cad cad-suite cluster-rabbitmq cluster-redis

serve: $(SERVING) $(if $(filter-out 0 false no,$(MECHSYNTH_CAD)),$(CAD))
	@exec $(BIN)/mechsynth serve

demo: $(SERVING)
	@$(BIN)/mechsynth demo --output var/demo.svg

test: $(STAMP)
	@$(MAKE) --no-print-directory -j2 check suite

suite: $(STAMP)
	$(BIN)/pytest -m "$(APART)" $(SPREAD) $(BESIDES)

# Holds the mark `slow` against the CPU time of every case; on a quiet machine.
marks: $(STAMP)
	$(BIN)/pytest -m "$(APART)" --check-marks $(SPREAD) $(BESIDES)

# The tests of the service on PostgreSQL and Celery: the real servers, on free ports. Each file runs beside one of the
# two brokers; what the broker decides (deployments, restarts, faults) runs beside both.
BY_BROKER := tests/cluster/test_deployment.py tests/cluster/test_restarts.py tests/service/jobs/test_faults.py
ON_RABBITMQ := $(addprefix tests/service/jobs/test_,jobs_api.py turns.py store.py upgrade.py) \
    tests/service/api/test_idempotency.py tests/cluster/test_schema.py
ON_REDIS := $(addprefix tests/service/jobs/test_,batches.py batch_store.py events.py) \
    $(addprefix tests/service/api/test_,limits.py access.py)

test-cluster: $(STAMP) engines
	@$(MAKE) --no-print-directory -j2 --output-sync=target cluster-rabbitmq cluster-redis

cluster-rabbitmq: OF_ONE_BROKER := $(ON_RABBITMQ)
cluster-redis: OF_ONE_BROKER := $(ON_REDIS)
cluster-rabbitmq cluster-redis: cluster-%:
	$(BIN)/pytest -m "not embedded" -s -q --backend postgres+$* $(BY_BROKER) $(OF_ONE_BROKER)

engines:
	@{ ls /usr/lib/postgresql/*/bin/postgres && test -x /usr/sbin/rabbitmq-server && test -x /usr/bin/redis-server; } \
	    > /dev/null 2>&1 || { test "$$(id -u)" = 0 && command -v apt-get >/dev/null && apt-get update -q \
	    && apt-get install -qy --no-install-recommends postgresql rabbitmq-server redis-server; } \
	    || { echo "the cluster tests need Debian's postgresql, rabbitmq-server and redis-server"; exit 1; }

# What is measured by the clock has the machine to itself.
TIMED := tests/browser/test_smoothness.py

test-browser: $(STAMP) $(NODE) chromium
	$(BIN)/pytest -m "browser and not campaign" $(SPREAD) --ignore $(TIMED)
	$(BIN)/pytest -m browser $(TIMED)

chromium:
	@test -x /usr/bin/chromium || { test "$$(id -u)" = 0 && command -v apt-get >/dev/null \
	    && apt-get update -q && apt-get install -qy --no-install-recommends chromium; } \
	    || { echo "the browser tests need Debian's chromium: apt-get install chromium"; exit 1; }

# The tests of the service say what it does without the extra, so that it is installed beside.
test-cad:
	@$(MAKE) --no-print-directory VENV=.venv-cad cad-suite

# Tests of one design, and of one file where it says nothing of designs, go to one process: solids are made once.
cad-suite: $(VENV)/.cad-tests $(NODE)
	$(BIN)/pytest -m "cad or not slow" -q -n 2 --dist loadgroup tests/cad tests/service/parts/test_parts.py

$(VENV)/.cad-tests: requirements.lock pyproject.toml $(INSTALLER)/uv.toml
	@echo "installing the locked packages and the extra cad (once; a minute or two)"
	@$(INSTALL) --extra cluster --extra telemetry --extra cad --group dev --group mesh
	@$(EDITABLE)
	@touch $@

# How long the random cases may take, in minutes; a quarter of it is the browser's.
MINUTES := 6
BROWSER_MINUTES := $(if $(filter inf,$(MINUTES)),inf,$(shell expr $(MINUTES) / 4 + 1))

campaign: $(STAMP) $(MULTIBODY) chromium
	$(BIN)/pytest -m "campaign and not browser and not cad" --campaign-minutes $(MINUTES) $(SPREAD) $(BESIDES)
	$(BIN)/pytest -m "campaign and browser" --campaign-minutes $(BROWSER_MINUTES) tests/browser

# Spoilt analyses, and a twentieth as many jobs, that are posted to a server under a limit of memory.
FUZZED := 5000

fuzz: $(STAMP)
	$(BIN)/pytest -m fuzz -s
	$(BIN)/python -m benchmarks.request_fuzz --analyses $(FUZZED) --jobs $$(( $(FUZZED) / 20 ))

# Processes are killed at random and at every write, and what became of the jobs is printed. A quarter of an hour on one
# machine, and as long on many.
test-faults: $(STAMP) engines
	$(BIN)/pytest -m "faults and not cluster" -n 2 -rP -q tests/faults
	$(BIN)/pytest -m "faults and cluster" -s -q --backend postgres+rabbitmq tests/faults
	MECHSYNTH_RESTARTS=10,5 $(BIN)/pytest -s -q --backend postgres+rabbitmq tests/cluster/test_restarts.py

check: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

format: $(STAMP) $(NODE)
	$(BIN)/ruff format .
	cd service/studio && ../../tests/node/node_modules/.bin/prettier --print-width 120 --write '**/*.js' '!vendor/**'

# The inner loop: everything but the tests marked slow, or the TESTS that are named: make quick TESTS=tests/synthesis
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

# The tests make the site themselves.
test-docs: $(SITE)
	$(BIN)/pytest -m site tests/tools/test_site.py

# Rewrites tests/service/api/contract.txt; review the difference before you commit it.
openapi: $(STAMP)
	$(BIN)/python -m tools.contract

types: $(STAMP) $(NODE)
	$(BIN)/python -m tools.studio.types

# All that runs outside of a checkout: pip install dist/*.whl && mechsynth serve
package: $(INSTALLER)/uv.toml
	@rm -rf build dist
	@$(UV) build --wheel --python $(PYTHON) --require-hashes --build-constraints requirements.lock --out-dir dist
	@rm -rf build
	@ls dist/*.whl

# As it is published, but for the name by which its controls find it: a page whose policy allows no inline script has no
# import map. This is the last release with files made small for browsers.
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

# The virtual environment is made without ensurepip, which some systems leave out. The system's pip installs uv beside it,
# and uv everything else in a tenth of pip's time. uv reads no settings of pip: an index that they name is passed on.
$(INSTALLER)/uv.toml: requirements.lock
	@test -x $(BIN)/python || $(PYTHON) -m venv --without-pip $(VENV)
	@sed -n "/^uv==/,/# via/p" requirements.lock > $(VENV)/uv.lock
	@$(PIP) install --quiet --disable-pip-version-check --no-compile --upgrade --target $(INSTALLER) --require-hashes \
	    -r $(VENV)/uv.lock
	@{ $(PIP) config get :env:.index-url || $(PIP) config get global.index-url; } 2> /dev/null \
	    | sed 's/.*/index-url = "&"/' > $@

# One lock has the packages of all extras and groups of pyproject.toml: users get the versions that developers have tried.
# A package that is not in it, or has another hash, is refused.
INSTALL = $(UV) pip install --python $(BIN)/python --require-hashes --constraints requirements.lock -r pyproject.toml

# The project itself, and bytecode of everything, on all processors.
EDITABLE = $(UV) pip install --python $(BIN)/python --no-deps --build-constraints requirements.lock -e . \
    && $(BIN)/python -m compileall -q -j 0 -x '/tests?/' $(VENV)/lib

# What serving needs. The kernels of the most usual problems are compiled at the first start, the rest beside it.
$(SERVING): requirements.lock pyproject.toml $(INSTALLER)/uv.toml
	@echo "installing the locked packages (once; half a minute)"
	@$(INSTALL)
	@$(EDITABLE)
	@touch $@

# What solids need besides: Open CASCADE, and what it brings.
$(CAD): requirements.lock pyproject.toml | $(SERVING)
	@echo "installing the extra cad (once; a gigabyte)"
	@$(INSTALL) --extra cad
	@touch $@

# What developing needs, and all kernels compiled.
$(STAMP): requirements.lock pyproject.toml $(INSTALLER)/uv.toml
	@echo "installing the locked packages for development and compiling all kernels (once; minutes)"
	@$(INSTALL) --extra cluster --extra telemetry --group dev
	@$(EDITABLE)
	@$(BIN)/mechsynth warm
	@touch $(SERVING) $@

lock: $(INSTALLER)/uv.toml
	@$(UV) pip compile pyproject.toml --python-version 3.11 --universal --generate-hashes --no-emit-index-url --no-header \
	    --all-extras --group dev --group docs --group mesh --group multibody -o requirements.lock

# What the tests need of node, from the lock beside it.
$(NODE): tests/node/package.json tests/node/package-lock.json
	@command -v npm > /dev/null || { test "$$(id -u)" = 0 && command -v apt-get > /dev/null \
	    && apt-get update -q && apt-get install -qy --no-install-recommends nodejs npm; } \
	    || { echo "these tests need node and npm: apt-get install nodejs npm"; exit 1; }
	@cd tests/node && npm ci --ignore-scripts --no-audit --no-fund --loglevel=error
	@touch $@

# Independent multibody programs and a parser of Modelica, which the campaign alone asks.
$(MULTIBODY): requirements.lock | $(STAMP)
	@$(INSTALL) --group multibody
	@touch $@

# What makes the site, and runs the notebooks in it.
$(SITE): requirements.lock | $(STAMP)
	@$(INSTALL) --group docs
	@touch $@

clean:
	rm -rf $(VENV) .venv-cad var dist tests/node/node_modules
