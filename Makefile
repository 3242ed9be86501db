# Mouthpiece. `make demo` to see it, `make test` for everything that CI runs, `make help` for the rest.

.DEFAULT_GOAL := help
.PHONY: help setup setup-test build demo check test bench

CARGO ?= cargo
BINARY := target/release/mouthpiece

help: ## this list
	@sed -n 's/^\([a-z-]*\):[^#]*## \(.*\)/  make \1\t\2/p' Makefile | expand -t 20

setup: ## installs what building and running need and this machine lacks (Debian, Ubuntu)
	@.ci/setup.sh

setup-test: ## the same, and what the live test needs
	@.ci/setup.sh --test

build: ## the program: target/release/mouthpiece
	$(CARGO) build --release --locked

# A window needs a display; macOS always has one.
demo: setup build ## speaks: in a window with sound, or as target/demo.mp4 where there is no display
	@if [ -n "$$DISPLAY$$WAYLAND_DISPLAY" ] || [ "$$(uname -s)" = Darwin ]; then \
		$(BINARY) say --demo; \
	else \
		$(BINARY) export --demo -o target/demo.mp4 && \
		echo "There is no display here, so the demo was written to $(CURDIR)/target/demo.mp4"; \
	fi

# In the release profile, so that build scripts and macros are shared with the build.
check: ## formatting, lints, documentation, licences
	$(CARGO) fmt --all --check
	$(CARGO) clippy --release --locked --workspace --all-targets -- -D warnings
	RUSTDOCFLAGS="-D warnings" $(CARGO) doc --release --locked --workspace --no-deps
	@if $(CARGO) deny --version >/dev/null 2>&1; then \
		$(CARGO) deny --all-features check licenses bans sources; \
	else \
		echo "cargo-deny is not installed: licences are judged by a test of tests/ alone"; \
	fi

test: setup-test check build ## everything that CI runs
	NODE_PATH=$(CURDIR)/target/node/node_modules $(CARGO) test --release --locked --workspace
	.ci/live.sh

bench: build ## the speed of each stage on this machine; springs beside kernels in C, the simulation part by part
	$(BINARY) bench
	$(CARGO) bench --locked -p mouthpiece-rig --bench springs --bench simulation
