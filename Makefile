# Every target sets up what it needs in .venv. Wanted beforehand: make, and Python 3.11 or newer with its venv module.

PYTHON ?= python3
SCENE ?= lammps_inputs/scenes/steel_on_glass.toml
OUT ?=
ARGS ?=

VENV := .venv
BIN := $(VENV)/bin
LOCKED := $(VENV)/.locked
READY := $(VENV)/.ready

# An environment that was copied from another folder, or whose Python has gone, is built anew.
ifneq ($(shell test -x $(BIN)/python && test "$$(cat $(LOCKED) 2>/dev/null)" = "$$(pwd -P)" && echo whole),whole)
$(LOCKED): FORCE
endif

.DEFAULT_GOAL := help
.PHONY: help run test lint lowest docs mutants validation clean FORCE

help: ## show this list
	@echo 'make [TARGET] [NAME=value ...]'
	@sed -n 's/^\([a-z]*\):.*## \(.*\)/  make \1 \2/p' Makefile | awk '{ printf "  %s %-10s", $$1, $$2; $$1 = $$2 = ""; print }'
	@echo 'PYTHON=$(PYTHON) is the Python that .venv is made with.'

run: $(READY) ## run a scene: SCENE=file.toml (default steel_on_glass), OUT=folder (default runs/<scene>)
	@$(BIN)/contact1d run "$(SCENE)" $(if $(OUT),--out "$(OUT)")

test: $(READY) ## run the tests: ARGS='-m slow' the long ones, ARGS=tests/unit one room
	@# One process for each core, and small matrices: threads would only get in each other's way. Files come in the order of
	@# testpaths, so that no core waits for a long one at the end. Assertions are rewritten once, not by each process.
	@OPENBLAS_NUM_THREADS=1 PYTHONDONTWRITEBYTECODE= $(BIN)/python -m pytest -n auto --maxprocesses 8 \
		--dist loadfile --no-loadscope-reorder $(ARGS)

lint: $(READY) ## check style, types and the direction of imports
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

lowest: $(READY) ## test what reads scenes and writes decks with the lowest versions that pyproject.toml allows, in .lowest
	@test -x .lowest/bin/python || $(BIN)/python -m venv .lowest
	@$(BIN)/python -c 'import re, tomllib; project = tomllib.load(open("pyproject.toml", "rb"))["project"]; \
		wanted = [*project["dependencies"], *project["optional-dependencies"]["test"][:3], "click>=8.1.8"]; \
		print(*(re.sub(">=([0-9.]+).*", r"==\1", one) for one in wanted), sep="\n")' > .lowest/versions.txt
	@.lowest/bin/python -m pip install -qq --disable-pip-version-check -r .lowest/versions.txt
	@# The wheel is built with the locked tools: the build backend needs newer packages than the program does.
	@rm -f .lowest/*.whl && $(BIN)/python -m pip wheel -qq --disable-pip-version-check --no-deps --no-build-isolation -w .lowest .
	@.lowest/bin/python -m pip install -qq --disable-pip-version-check --no-deps --force-reinstall .lowest/*.whl
	@OPENBLAS_NUM_THREADS=1 .lowest/bin/python -m pytest -q -n auto tests/unit/test_scene*.py tests/unit/test_fit.py \
		tests/unit/test_quantities.py tests/unit/test_wrong_inputs.py tests/unit/test_states.py tests/decks

docs: $(READY) ## build the site in site/, which then needs no network (needs node and npm)
	@command -v node >/dev/null && command -v npm >/dev/null || { echo "make docs needs node and npm, for the packages in docs/site/package.json; \
	on Debian and Ubuntu: apt-get install nodejs npm" >&2; exit 1; }
	@$(BIN)/python -m pip install -qq --disable-pip-version-check -e '.[docs]'
	@mkdir -p .npm && cp docs/site/package.json docs/site/package-lock.json .npm/
	@npm ci --prefix .npm --silent --no-audit --no-fund --ignore-scripts
	@NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --strict --quiet
	@node docs/site/formulas.mjs site .npm
	@mkdir -p site/katex/fonts && cd .npm/node_modules/katex && cp LICENSE dist/katex.min.css ../../../site/katex/ && \
		cp dist/fonts/*.woff2 ../../../site/katex/fonts/

mutants: $(READY) ## put random faults into the code and see whether the tests notice: ARGS='--number 100 --seed 1'
	@OPENBLAS_NUM_THREADS=1 $(BIN)/python -m validation.tools.mutants $(ARGS)

validation: $(READY) ## the paper's statements anew, then VALIDATION.md and its tables
	@rm -rf reproduced  # runs of an older state of the program would be taken over
	@$(BIN)/python -m validation paper --out reproduced
	@cp reproduced/record.json validation/results/paper.json && cp reproduced/*.png docs/reproduced/
	@$(BIN)/python -m validation pages

clean: ## remove .venv and the caches; runs/ stays
	rm -rf $(VENV) .lowest .npm site dist .pytest_cache .mypy_cache .ruff_cache .import_linter_cache .hypothesis
	find workflow analysis potentials lammps_inputs validation tests -name __pycache__ -type d -prune -exec rm -rf {} +

$(LOCKED): requirements.lock
	@command -v "$(PYTHON)" >/dev/null || { echo "contact1d needs Python 3.11 or newer; \
	there is no $(PYTHON). If it has another name: make PYTHON=/path/to/python3" >&2; exit 1; }
	@"$(PYTHON)" -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "contact1d needs Python 3.11 or newer; \
	$(PYTHON) is $$("$(PYTHON)" --version 2>&1). If a newer one is there: make PYTHON=python3.12" >&2; exit 1; }
	@"$(PYTHON)" -c 'import ensurepip, venv' 2>/dev/null || { echo "$(PYTHON) lacks its venv module; \
	on Debian and Ubuntu: apt-get install python3-venv" >&2; exit 1; }
	@echo 'Setting up .venv from requirements.lock: about a minute, once.'
	@"$(PYTHON)" -m venv --clear $(VENV)
	@$(BIN)/python -m pip install -qq --disable-pip-version-check --require-hashes -r requirements.lock
	@pwd -P > $@

$(READY): $(LOCKED) pyproject.toml
	@$(BIN)/python -m pip install -qq --disable-pip-version-check --no-deps --no-build-isolation -e .
	@$(BIN)/python -m compileall -q src workflow analysis potentials  # nor does the first command wait for it
	@touch $@
