# Two commands do everything on a fresh machine with Python >= 3.11, git and make: make optimise, make test.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin

# a file of tests stays in one process, so that its tests share what they set up
SHARED := -n 2 --dist loadfile --no-loadscope-reorder

.PHONY: optimise test verify check format benchmark docs notebooks clean

optimise: $(VENV)/installed
	$(BIN)/damperopt optimise configs/main_gear.yaml

test: $(VENV)/installed-dev
	$(BIN)/python -m pytest $(SHARED) -m "not verify"

# before a version: what takes longer than a commit may wait
verify: $(VENV)/installed-dev
	$(BIN)/python -m pytest $(SHARED) -m verify

# green before each commit: format, lint, types, import contracts, fast tests
check: $(VENV)/installed-dev
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/python -m pytest $(SHARED) -q -m "not slow and not verify"

format: $(VENV)/installed-dev
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .

benchmark: $(VENV)/installed
	$(BIN)/python benchmarks/optimise.py
	$(BIN)/python benchmarks/main_job.py
	$(BIN)/python benchmarks/transients.py
	$(BIN)/python benchmarks/charts.py
	$(BIN)/python benchmarks/memory.py
	$(BIN)/python benchmarks/start.py

# the documentation as HTML; notebooks are run, a warning is an error
docs: $(VENV)/installed-dev
	$(BIN)/python -m sphinx -W --keep-going -b html docs docs/_build/html
	@echo Open docs/_build/html/index.html

# the notebooks as .ipynb beside their text, for Jupyter; the text is what is kept
notebooks: $(VENV)/installed-dev
	$(BIN)/python -m jupytext --to ipynb --update notebooks/*.md

$(VENV)/installed: pyproject.toml
	$(PYTHON) -c 'import sys; sys.version_info >= (3, 11) or sys.exit("damperopt needs Python 3.11 or newer; set PYTHON=...")'
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable .
	touch $@

$(VENV)/installed-dev: $(VENV)/installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	touch $@

clean:
	rm -rf $(VENV) docs/_build build dist .pytest_cache .mypy_cache .ruff_cache
