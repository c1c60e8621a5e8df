# `make help` lists the targets. Needed: make, Python 3.11 with the module venv, and at the first call a network.
.DEFAULT_GOAL := help
.SUFFIXES:
.DELETE_ON_ERROR:

OUTPUT ?= out/demo
TESTS ?=
ZIPS ?=
BENCHMARKS ?= camera animate accuracy evidence keyframe_economy sensitivity posing_all frame_poses finishing mend retargeting waiting batch detection

find_python := sh tools/find_python.sh
# Variables, because a comma would end an argument of `call`.
test_parts := --editable '.[blender,dev]'
demo_size := Blender as a Python module, about 500 MB to download, 1.3 GB on disk, one to five minutes
test_size := Blender as a Python module and the test tools, about 600 MB to download, 1.6 GB on disk, two to six minutes
dev_size := libraries and tools, about 200 MB to download, 600 MB on disk, a minute or two
# Whole files to a worker, so that what a file's tests share is made once.
two_at_a_time := --numprocesses 2 --dist loadfile
# What takes long and depends on no version of Python or Blender is tried in one of the two.
quick := -m 'not faults and not slow'
settings := pyproject.toml setup.py
model := presets/models/pose_landmark.onnx
sources := $(shell find __init__.py blender_manifest.toml core operators presets -type f ! -name '*.pyc' 2>/dev/null)

# make_venv FOLDER, PYTHON VERSION, CANDIDATE, WHAT TO INSTALL, WHAT IS SAID: a new virtual environment, complete once it
# has `ready`.
define make_venv
python=$$($(find_python) $(2) $(3)) && \
if [ -x $(1)/bin/python ]; then echo "$(1) is brought up to date ..."; \
else echo "$(1) is set up, once: $(5) ..." && "$$python" -m venv --clear $(1); fi && \
$(1)/bin/python -m pip install --quiet --disable-pip-version-check --upgrade pip && \
$(1)/bin/python -m pip install --quiet --disable-pip-version-check $(4) && \
touch $(1)/ready && echo "$(1) is ready."
endef

check_libraries = python=$$($(find_python) 3.11 $(PYTHON)) && "$$python" tools/check_libraries.py

.PHONY: help
help: ## list the targets
	@sed -n 's/^\([a-z-]*\):.*## /\1|/p' $(firstword $(MAKEFILE_LIST)) | awk -F'|' '{printf "  make %-14s %s\n", $$1, $$2}'

# The network that finds keypoints: 28 MB out of an archive of 41. Where it cannot be had, all else works.
$(model): presets/models/SHA256SUMS tools/fetch_model.py tools/convert_network.py
	@python=$$($(find_python) 3.11 $(PYTHON)) && "$$python" tools/fetch_model.py || echo "keymark detect is left out." >&2

.venv-demo/ready: $(settings) $(sources) $(model)
	@$(check_libraries)
	@rm -rf build
	@$(call make_venv,.venv-demo,3.11,$(PYTHON),'.[blender]',$(demo_size))

.venv-dev/ready: $(settings) | $(model)
	@$(call make_venv,.venv-dev,3.11,$(PYTHON),--editable '.[dev]',$(dev_size))

.venv-test/ready: $(settings) | $(model)
	@$(check_libraries)
	@$(call make_venv,.venv-test,3.11,$(PYTHON),$(test_parts),$(test_size))

# The newest Blender's Python is optional: without it the tests run in the oldest supported Blender only.
.venv-test-313/ready: $(settings)
	@if $(find_python) 3.13 >/dev/null 2>&1; then $(call make_venv,.venv-test-313,3.13,,$(test_parts),$(test_size)); fi

.PHONY: demo
demo: .venv-demo/ready ## convert the demonstration take into out/demo
	.venv-demo/bin/keymark demo --output $(OUTPUT)

# Tests start dozens of processes, each of which would compile all modules anew where the variable is set.
test test-core test-faults: export PYTHONDONTWRITEBYTECODE :=

.PHONY: test
test: .venv-test/ready .venv-test-313/ready ## run the tests in Blender 4.5 and, where there is a Python 3.13, the quick ones in 5.2
	@status=0; \
	if [ -e .venv-test-313/ready ]; then \
	    echo "== Blender 5.2, Python 3.13: all tests but those marked slow, about five minutes on two quiet cores"; \
	    .venv-test-313/bin/python -m pytest $(two_at_a_time) $(quick) $(TESTS) || status=$$?; \
	else \
	    echo "== Blender 5.2 is left out: this machine has no Python 3.13"; \
	fi; \
	echo "== Blender 4.5, Python 3.11: all tests, about seven minutes on two quiet cores"; \
	.venv-test/bin/python -m pytest $(two_at_a_time) $(TESTS) || status=$$?; \
	exit $$status

.PHONY: test-core
test-core: .venv-dev/ready ## run the tests that need no Blender
	@echo "== Without Blender: about two minutes on two quiet cores"
	@.venv-dev/bin/python -m pytest $(two_at_a_time) $(or $(TESTS),tests/core)

# What `make test` does a little of, in earnest: processes are killed, inputs broken, by the hundred.
.PHONY: test-faults
test-faults: .venv-test/ready ## kill conversions and batches at random points, and feed them broken files
	@.venv-test/bin/python -m pytest $(two_at_a_time) -m faults tests/core tests/blender $(TESTS)
	@KEYMARK_FUZZ=$${KEYMARK_FUZZ:-20} .venv-test/bin/python -m pytest $(two_at_a_time) -m fuzz tests/core

# BLENDER=/path/to/blender tests in that one; without it, Debian's newest is fetched into a cache folder.
.PHONY: test-blender
test-blender: .venv-test/ready ## run the tests in a real Blender, and install the package there
	@blender=$${BLENDER:-$$(sh tools/fetch_blender.sh)} || exit 1; status=0; \
	echo "== Inside $$blender"; \
	.venv-test/bin/python tools/test_in_blender.py "$$blender" $(quick) $(or $(TESTS),tests/blender) || status=$$?; \
	echo "== The package, installed in $$blender"; \
	BLENDER="$$blender" .venv-test/bin/python -m pytest -m 'not ui' tests/real_blender || status=$$?; \
	exit $$status

# Mouse and keys in a Blender with a screen; build/screenshots/ then shows every step.
.PHONY: test-ui
test-ui: .venv-test/ready ## go through all steps by mouse and keys in a real Blender, with pictures of each
	@blender=$${BLENDER:-$$(sh tools/fetch_blender.sh)} || exit 1; \
	echo "== A session in $$blender"; \
	BLENDER="$$blender" .venv-test/bin/python -m pytest -m ui tests/real_blender/ui $(TESTS)

# Pictures of Blender are cut from what `make test-ui` took; NAMES="filming keymark" draws those alone.
.PHONY: pictures
pictures: .venv-test/ready ## draw all pictures of the docs anew, from the screenshots of test-ui and the demonstration
	@.venv-test/bin/python tools/draw_pictures.py $(NAMES)

.PHONY: lint
lint: .venv-dev/ready ## check style, formatting and types
	@status=0; \
	.venv-dev/bin/ruff check . || status=1; \
	.venv-dev/bin/ruff format --check . || status=1; \
	.venv-dev/bin/python tools/check_types.py || status=1; \
	exit $$status

.PHONY: format
format: .venv-dev/ready ## put the code into the project's format
	@.venv-dev/bin/ruff check --fix --select I .
	@.venv-dev/bin/ruff format .

# One of them: make package ZIPS='--platform linux-x64 --python 3.13'.
.PHONY: package
package: .venv-test/ready ## build the extension's zips, one a platform and Python of Blender, into dist/
	@.venv-test/bin/python tools/fetch_model.py --best
	@.venv-test/bin/python tools/build_package.py $(ZIPS)

.PHONY: bench
bench: .venv-test/ready ## measure accuracy, keyframes needed, sensitivity, libraries, finishing, waiting and batches
	@for name in $(BENCHMARKS); do echo "== $$name"; .venv-test/bin/python benchmarks/$$name.py || exit $$?; done

.PHONY: clean
clean: ## remove everything that make has made here
	rm -rf .venv-demo .venv-dev .venv-test .venv-test-313 .cache .mypy_cache .pytest_cache .ruff_cache
	rm -rf .hypothesis build dist out wheels keymark.egg-info
