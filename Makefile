# Everything one needs: `make help` lists it.

SHELL := /bin/bash
VENV := .venv
BIN := $(VENV)/bin
# The first Python of at least 3.11; `make PYTHON=… install` takes another.
PYTHON ?= $(shell for p in python3 python3.13 python3.12 python3.11; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && { echo $$p; break; }; done)
CORES ?= all
# One more than processors: tests wait for browsers, viewers and Snakemake.
TESTERS = $(shell expr $$(getconf _NPROCESSORS_ONLN) + 1)
# A target is about the study in CONFIG, and its results in RESULTS, or where CONFIG says (results, where none is given).
CONFIG ?= config/config.yaml
# The project's other studies go below RESULTS, and not into it, where the main one is.
MAIN := $(RESULTS)
smoke: override RESULTS := $(if $(MAIN),$(MAIN)/smoke)
beyond: override RESULTS := $(if $(MAIN),$(MAIN)/beyond)
exploratory: override RESULTS := $(if $(MAIN),$(MAIN)/exploratory)
# A bar for every rule in a terminal; elsewhere Snakemake's own lines, of which the rules leave out most.
LOGGER := $(shell test -t 2 && echo --logger rich)
SNAKEMAKE = PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/snakemake --cores $(CORES) --profile workflow/profiles/default $(LOGGER)
INSTALLED := $(VENV)/.installed
# A study (1), checked first: Snakemake would read what is not YAML, or surprising YAML, in words of its own. That
# says what is to come, too; then its targets (2) are made, and the end says where the page is (3: where in it).
run = $(call begin,$(1)) && $(SNAKEMAKE) $(call of,$(1))$(if $(2), -- $(2)) && $(call end,$(3))
begin = results=$$($(BIN)/upswing check "$(1)" --begin$(if $(RESULTS), --results "$(RESULTS)"))
of = --configfile "$(1)"$(if $(RESULTS), --config results="$(RESULTS)")
end = $(if $(value NOTE),$(BIN)/upswing history noted "$$results" && )echo "The report is at $$results/report/index.html$(1)"

# The folder of results that a target is about, for the shell.
folder = results=$(if $(RESULTS),"$(RESULTS)",$(if $(filter file,$(origin CONFIG)),results,$$($(BIN)/upswing check "$(CONFIG)" --folder)))

# Exactly what a lock file (1) lists, each file with its checksum; options (2).
locked = $(PIP) install --no-deps --require-hashes $(2) -r $(1)
PIP = $(BIN)/python -m pip --quiet --disable-pip-version-check

# What is set outside must not choose other packages, nor another encoding.
unexport PYTHONPATH PYTHONHOME
export PYTHONNOUSERSITE := 1
export PYTHONUTF8 := 1
# A note for the entry of the history, as it was given: NOTE="why this was tried".
ifdef NOTE
export UPSWING_NOTE := $(value NOTE)
endif
# A home that cannot be written: caches then lie in .cache here.
export XDG_CACHE_HOME := $(shell d="$${XDG_CACHE_HOME:-$$HOME/.cache}"; \
	mkdir -p "$$d" 2>/dev/null && test -w "$$d" && echo "$$d" || echo "$(CURDIR)/.cache")

.PHONY: help
help: ## Say what there is to make
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-16s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

.PHONY: install
install: writable $(INSTALLED) ## Set up the virtual environment .venv from the lock file

.PHONY: writable
writable:
	@test -w "$(CURDIR)" || { echo "upswing: $(CURDIR): cannot be written, and results, .venv and .snakemake lie in it: copy it to a folder of your own" >&2; exit 1; }

$(INSTALLED): $(VENV)/.locked pyproject.toml | writable
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	@touch $@

$(VENV)/.locked: requirements.lock requirements-gpu.lock requirements-slurm.lock | writable
	@test -n "$(PYTHON)" || { echo "upswing needs Python 3.11 or newer; none was found. Try: make PYTHON=/path/to/python3 $(MAKECMDGOALS)" >&2; exit 1; }
	$(PYTHON) -m venv --clear $(VENV)
	@# torch first: its CPU build where there is one. Asked for checksums, pip prefers a file whose checksum the index
	@# tells, and a folder tells none; so it chooses without, and what it chose is then checked like everything else.
	sed -n '/^torch==/,/[^\\]$$/p' requirements.lock > $(VENV)/torch.lock
	$(PIP) download --no-deps --dest $(VENV)/torch "$$(grep -o '^torch==[^ ]*' $(VENV)/torch.lock)"
	$(call locked,$(VENV)/torch.lock,--no-index --find-links $(VENV)/torch)
	$(call locked,requirements.lock)
	@# Any other build for Linux cannot even be imported without libraries for a GPU.
	@$(BIN)/python -c "import torch" 2> /dev/null || { echo "This torch needs gigabytes of GPU libraries. README.md says how to do without." >&2; $(call locked,requirements-gpu.lock); }
	$(call locked,requirements-slurm.lock,--target $(VENV)/slurm)
	@rm -r $(VENV)/torch $(VENV)/torch.lock
	@touch $@

.PHONY: reproduce
reproduce: install ## Run the whole study: figures, tables, recordings, report
	@$(call run,$(CONFIG))

.PHONY: slurm
slurm: install ## Run the whole study on a Slurm cluster (see workflow/README.md)
	@$(call begin,$(CONFIG)) && PATH="$(CURDIR)/$(BIN):$$PATH" PYTHONPATH="$(CURDIR)/$(VENV)/slurm" $(BIN)/snakemake --profile workflow/profiles/slurm $(LOGGER) $(call of,$(CONFIG)) && $(call end)

.PHONY: unlock
unlock: install ## After a kill: let the next run begin, when no other is at work
	@$(SNAKEMAKE) $(call of,$(CONFIG)) --unlock

.PHONY: study
study: install ## Run another study: make study CONFIG=config/mine.yaml NOTE="why" (a note goes with every study)
	@test "$(origin CONFIG)" != file || { echo "Say which: make study CONFIG=config/mine.yaml" >&2; exit 1; }
	@$(call run,$(CONFIG))

.PHONY: smoke
smoke: install ## The same in one to two minutes: 2 seeds, short runs, into results/smoke
	@$(call run,config/smoke.yaml)

.PHONY: readings
readings: install ## Judge every claim under other readings too (40 minutes on 2 cores; goes on where it stopped)
	@$(call run,$(CONFIG),with_readings,#robust)

# Two calls: a call of Snakemake has one configuration, and the page that shows the chapter is of another study.
.PHONY: beyond
beyond: install ## Run what goes beyond the thesis (forty minutes on 2 cores), into results/beyond
	@$(call run,config/beyond.yaml)
	@main=$(if $(MAIN),"$(MAIN)",$$($(BIN)/upswing check "$(CONFIG)" --folder)) && if test -e "$$main/report/index.html"; then \
		$(SNAKEMAKE) --configfile "$(CONFIG)"$(if $(MAIN), --config results="$(MAIN)"); fi

.PHONY: bench
bench: install ## Measure a step against C, numpy and torch, and what the whole study took
	@$(folder) && $(BIN)/python -m tests.benchmarks.run "$$results"

.PHONY: bench-edits
bench-edits: install ## Measure what an edit costs until the page is right again (ten minutes)
	@$(folder) && $(BIN)/python -m tests.benchmarks.edits "$$results"

.PHONY: bench-growth
bench-growth: install ## Measure how time and size grow with seeds and steps (a quarter of an hour)
	@$(folder) && $(BIN)/python -m tests.benchmarks.growth "$$results"

.PHONY: browse
browse: install ## Browse all recordings; make browse FILTER="task=balancing seed=0..4"; WEB=1 as a page
	@$(folder) && $(BIN)/upswing browse --results "$$results" $(if $(WEB),--web) $(FILTER)

.PHONY: doctor
doctor: install ## Check that results are whole; says what to delete where they are not
	@$(folder) && $(BIN)/upswing doctor "$$results"

.PHONY: clean-orphans
clean-orphans: install ## List runs that the study, as it last ran, no longer has; YES=1 deletes them
	@$(folder) && $(BIN)/upswing clean-orphans "$$results" $(if $(YES),--yes)

.PHONY: test
test: install ## Run the tests
	@$(BIN)/python -m pytest --numprocesses $(TESTERS) --dist loadfile --no-loadscope-reorder -m "not heavy"

.PHONY: test-heavy
test-heavy: install ## Run the tests that take long: a real Slurm, jobs killed, sweeps, installations, windows, fuzz
	@$(BIN)/python -m pytest --numprocesses $(TESTERS) --dist loadfile --no-loadscope-reorder -m heavy

.PHONY: test-all
test-all: test test-heavy ## Run all tests, those that take long too

.PHONY: audit
audit: ## Ask a public database for known vulnerabilities of the pinned versions (needs a network)
	$(PYTHON) -m venv --clear .audit-venv
	.audit-venv/bin/python -m pip install --quiet --disable-pip-version-check pip-audit
	.audit-venv/bin/pip-audit --requirement requirements.lock --no-deps --disable-pip; status=$$?; rm -rf .audit-venv; exit $$status

.PHONY: lint
lint: install ## Check style and formatting
	@$(BIN)/ruff check .
	@$(BIN)/ruff format --check .
	@$(BIN)/snakefmt --check Snakefile workflow
	@$(BIN)/lint-imports --no-logo

.PHONY: types
types: install ## Check types
	@$(BIN)/mypy

.PHONY: format
format: install ## Format the code
	@$(BIN)/ruff check --fix --quiet . || true
	@$(BIN)/ruff format .
	@$(BIN)/snakefmt Snakefile workflow

.PHONY: schema
schema: install ## Renew what is generated from the types: schema and key reference
	@$(BIN)/upswing schema > config/schema.json
	@$(BIN)/upswing keys > config/README.md

.PHONY: docs
docs: install ## Build the documentation into build/docs; it reads without a network
	@NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --quiet --strict
	@echo "The documentation is at build/docs/index.html"

.PHONY: screenshots
screenshots: install ## Renew the documentation's pictures of the recordings (needs a Vulkan driver: Mesa's)
	@$(folder) && $(BIN)/upswing screenshots "$$results" --into docs/pictures

.PHONY: exploratory
exploratory: install ## The thesis's claims on the seeds 0 to 29, which were seen before, into results/exploratory; shown beside the others
	@test "$(origin CONFIG)" = file || { echo "make exploratory is about the thesis's study: leave CONFIG out" >&2; exit 1; }
	@mkdir -p build
	@sed 's/{first: 10000, count: [0-9]*}/{first: 0, count: 30}/; s#^results: results#results: results/exploratory#' "$(CONFIG)" > build/exploratory.yaml
	@$(call run,build/exploratory.yaml) && $(BIN)/upswing exploratory "$$results"

.PHONY: readme
readme: install ## Renew what README and documentation show of the results: verdicts, pictures, deviations
	@$(folder) && $(BIN)/upswing readme "$$results"

.PHONY: site
site: install ## Write the report and its recordings as a folder for any static host, build/site
	@$(folder) && $(BIN)/upswing site build/site --results "$$results"

.PHONY: notebook
notebook: install ## Run the documentation's notebook on results, and store what it says
	@$(folder) && $(BIN)/python -m tests.notebook "$$results"

.PHONY: snakemake-report
snakemake-report: install ## Snakemake's own report: every output with its rule, code and time
	@$(folder) && page="$$results/report/snakemake.html" && $(SNAKEMAKE) $(call of,$(CONFIG)) --report "$$page" && echo "Snakemake's report is at $$page"

.PHONY: lock
lock: install ## Renew the lock files from pyproject.toml, for all platforms; NEWEST=1 takes the newest versions
	@CPU_BUILDS="$(CPU_BUILDS)" NEWEST="$(NEWEST)" $(BIN)/python -m tests.portability.lock

.PHONY: portability
portability: install ## Renew the documentation's table of where the lock files can be installed (needs an index)
	@$(BIN)/python -m tests.portability.page

.PHONY: clean
clean: ## Remove results and what Snakemake remembers of them; what was found before, the history, stays
	@$(folder) && test "$$results" = results || test -e "$$results/study.json" || { echo "upswing: $$results: is not the results of a study" >&2; exit 1; }
	@# A history and its checksums are below a folder of this name; a task may be called so, too.
	$(folder) && find "$$results/" -mindepth 1 -not -type d \( -path '*/runs/*' -o -path '*/adopted/*' -o -path '*/benchmarks/*' -o -path '*/logs/*' \
		-o -not -path '*/history/*' \) -delete
	$(folder) && find "$$results/" -mindepth 1 -type d -empty -delete
	$(folder) && if test "$$results" = results; then rm -rf .snakemake; git checkout --quiet -- results; fi
