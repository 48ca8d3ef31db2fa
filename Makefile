# Every target sets up its own environment in .venv; only make and a Python of 3.11 or later are needed.

PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
STAMP  := $(VENV)/.installed
STAMP_DEMO := $(VENV)/.installed-demo
STAMP_ALL := $(VENV)/.installed-all
STAMP_DOCS := $(VENV)/.installed-docs
DEMO   := demo
DOCS_CHECKS ?= not slow

# Many processes are started below, and each would compile the package anew.
unexport PYTHONDONTWRITEBYTECODE

# Types are checked while the pages are built, which keeps one core busy.
ifeq ($(filter types,$(MAKECMDGOALS))$(filter docs,$(MAKECMDGOALS)),typesdocs)
MAKEFLAGS += -j2 --output-sync=target
endif

.DELETE_ON_ERROR:
.PHONY: help demo chromium test test-all mutation lint types bench docs pictures studies tables everything clean

help:
	@echo "make demo      hybrid against bare: reductions, stresses, pressure fields and a film into $(DEMO)/"
	@echo "make test      the tests, without the slow ones"
	@echo "make test-all  all tests"
	@echo "make mutation  break the package in one place at a time: which test notices (tests/mutation; a quarter of an hour)"
	@echo "make lint      style and format"
	@echo "make types     static types"
	@echo "make bench     time, memory and cost curves of the solver"
	@echo "make docs      the documentation as a site, docs/built/index.html, every example run"
	@echo "make pictures  the pictures of the pages anew, docs/figures, and the pages kept with their numbers: three quarters of an hour"
	@echo "make studies   the searches and fronts of the design study anew with their pictures, docs/studies/results: an hour"
	@echo "make tables    what the package holds of slice and sphere, thin and exact walls, and the table of slips: a third of an hour"
	@echo "make everything  every example, figure and table: demo, tables, studies, pictures, the paper, bench, docs; some hours"
	@echo "make clean     remove the environment, caches and the demonstration"

define ENVIRONMENT
@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || \
  { echo "error: $(PYTHON) is older than Python 3.11 or not installed; name another one: make PYTHON=python3.12" >&2; exit 1; }
@$(PYTHON) -m venv $(VENV) || \
  { echo "error: $(PYTHON) cannot make virtual environments; on Debian: apt-get install python3-venv" >&2; exit 1; }
endef

$(STAMP): pyproject.toml
	$(ENVIRONMENT)
	@echo "installing coaxshell with the tools of its development into $(VENV): once, one to three minutes as the network goes"
	@$(BIN)/python -m pip install -qq --disable-pip-version-check --no-input --no-compile -e '.[dev]'
	@touch $@

# The demonstration needs no more than its runs and its film, and imports a third of what they bring: that is compiled then.
$(STAMP_DEMO): pyproject.toml
	$(ENVIRONMENT)
	@echo "installing coaxshell with what a run and a film need into $(VENV): once, half a minute beside what the network takes"
	@$(BIN)/python -m pip install -qq --disable-pip-version-check --no-input --no-compile -e '.[video]'
	@touch $@

# VTK, 764 MB installed, only reads back what we write for ParaView.
$(STAMP_ALL): $(STAMP)
	@echo "installing VTK, 764 MB, into $(VENV): once, for as long as the network takes"
	@$(BIN)/python -m pip install -qq --disable-pip-version-check --no-input -e '.[dev,paraview-check]'
	@touch $@

# Two things at a time: the two runs, then the film beside the figures. What is done in the background does not hear Ctrl-C by itself.
demo: export OPENBLAS_NUM_THREADS = 1
demo: $(STAMP_DEMO)
	@mkdir -p $(DEMO)
	@echo "hybrid against bare: two runs, their reductions, a sheet of fields and a film, about a minute"
	@echo "  bare, and hybrid beside it: a quarter of a minute"
	@$(BIN)/coaxshell run bare --quiet --force --output $(DEMO)/bare.nc > $(DEMO)/bare.txt & \
	  bare=$$!; trap "kill $$bare 2>/dev/null; exit 1" INT TERM; \
	  $(BIN)/coaxshell run hybrid --compare bare --quiet --force --output $(DEMO)/hybrid.nc --figure $(DEMO)/stress.png \
	    > $(DEMO)/reductions.txt || { wait $$bare; exit 1; }; \
	  wait $$bare
	@cat $(DEMO)/reductions.txt
	@echo "  a film of 100 frames; beside it stress at head and tail, and pressure at four instants: three quarters of a minute"
	@$(BIN)/coaxshell animate $(DEMO)/bare.nc --compare $(DEMO)/hybrid.nc --frames 100 --fps 20 --size 360 --quiet --force \
	    --output $(DEMO)/film.mp4 > $(DEMO)/.film 2>&1 & \
	  film=$$!; trap "kill $$film 2>/dev/null; exit 1" INT TERM; \
	  { $(BIN)/coaxshell figure 3 --quiet --force --from $(DEMO)/bare.nc --output $(DEMO)/figure-3.png && \
	    $(BIN)/coaxshell snapshots $(DEMO)/bare.nc --compare $(DEMO)/hybrid.nc --times 0.5,1.2,2,3.1 --columns 2 --quiet --force \
	      --output $(DEMO)/fields.png; } 2> $(DEMO)/.told || { cat $(DEMO)/.told >&2; kill $$film 2>/dev/null; exit 1; }; \
	  wait $$film || { cat $(DEMO)/.film >&2; exit 1; }
	@tail -n 1 $(DEMO)/.film
	@rm -f $(DEMO)/.told $(DEMO)/.film

# The studio's page and the documentation are tested in a real browser: Debian's, installed when it is missing and we may.
chromium:
	@command -v chromium >/dev/null || command -v chromium-browser >/dev/null || command -v google-chrome >/dev/null || { \
	  echo "installing chromium for the tests of the pages (once, about a minute)"; \
	  as=$$([ "$$(id -u)" = 0 ] || echo "sudo -n"); \
	  { $$as apt-get update -qq && DEBIAN_FRONTEND=noninteractive $$as apt-get install -y -qq --no-install-recommends chromium; } >/dev/null 2>&1 || \
	  echo "error: chromium could not be installed, so the tests of the pages will fail; on Debian: apt-get install chromium" >&2; }

# Two test processes share the cores; BLAS threads of their own would only spin against each other.
# tests/conftest.py tells which tests one of them carries out together, and which begin.
test: export OPENBLAS_NUM_THREADS = 1
test: $(STAMP) chromium
	@$(BIN)/python -m pytest -q -n 2 -m "not slow"

test-all: export OPENBLAS_NUM_THREADS = 1
test-all: $(STAMP_ALL) chromium
	@$(BIN)/python -m pytest -q -n 2
	@$(MAKE) --no-print-directory docs DOCS_CHECKS="slow or not slow"

mutation: $(STAMP)
	@$(BIN)/python tests/mutation

lint: $(STAMP)
	@$(BIN)/ruff check .
	@$(BIN)/ruff format --check --quiet . || { echo "error: some files are not formatted: $(BIN)/ruff format ." >&2; exit 1; }

types: $(STAMP) | $(if $(filter docs,$(MAKECMDGOALS)),$(STAMP_DOCS))
	@$(BIN)/mypy

bench: $(STAMP) chromium
	@$(BIN)/python -m benchmarks

$(STAMP_DOCS): $(STAMP)
	@echo "installing what builds the documentation into $(VENV): once, about half a minute as the network goes"
	@$(BIN)/python -m pip install -qq --disable-pip-version-check --no-input --no-compile -e '.[dev,docs]'
	@touch $@

# A warning is an error, and nothing is fetched: the checks read the pages that came out.
docs: export OPENBLAS_NUM_THREADS = 1
docs: $(STAMP_DOCS) chromium
	@rm -rf docs/built
	@echo "building the pages and running every example: about two minutes where nothing else is done"
	@$(BIN)/python -m sphinx -W --keep-going -q -b html -d docs/generated/doctrees docs docs/built
	@echo "checking what came out, in a browser too: about a minute"
	@$(BIN)/python -m pytest -q -n 2 --dist loadfile -m "$(DOCS_CHECKS)" docs/checks
	@echo "open docs/built/index.html"

# What the pages show that is not made at every build: `make docs` runs the examples and writes reports and tables itself, `make studies`
# the pictures of its searches.
pictures: export OPENBLAS_NUM_THREADS = 1
pictures: $(STAMP) chromium
	@$(BIN)/python docs/pictures

# The systems, fronts and numbers that the design study's page tells, in the order in which one begins from another.
studies: export OPENBLAS_NUM_THREADS = 1
studies: $(STAMP)
	@$(BIN)/python docs/studies

# What took too long for every build and is read by the package itself; the table of docs/slips.md is printed.
tables: export OPENBLAS_NUM_THREADS = 1
tables: $(STAMP)
	@$(BIN)/python -m coaxshell.apps.paper.sphere map
	@$(BIN)/python -m coaxshell.apps.paper.sphere claims
	@$(BIN)/python -m coaxshell.apps.paper.thickness map
	@$(BIN)/python -m coaxshell.apps.paper.thickness claims
	@$(BIN)/python -m coaxshell.apps.paper.slips

# All that is shown anywhere, anew. Tables of time are printed, for they belong to the machine; the reproduction goes on in its folder.
everything: demo
	@$(MAKE) --no-print-directory tables
	@$(MAKE) --no-print-directory studies
	@$(MAKE) --no-print-directory pictures
	@OPENBLAS_NUM_THREADS=1 $(BIN)/coaxshell reproduce --quiet
	@$(MAKE) --no-print-directory bench
	@$(MAKE) --no-print-directory docs

clean:
	@rm -rf $(VENV) $(DEMO) docs/built docs/generated docs/tutorials build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis
	@find . -name __pycache__ -type d -prune -exec rm -rf {} +
