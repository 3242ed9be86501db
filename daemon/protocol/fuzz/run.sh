#!/bin/sh
# Fuzzes the wire's session: `daemon/protocol/fuzz/run.sh [SECONDS]`, 120 seconds unless told. Needs no
# nightly toolchain and no cargo-fuzz; with them: cargo +nightly fuzz run --fuzz-dir daemon/protocol/fuzz session
set -eu
cd "$(dirname "$0")"
target_dir=${CARGO_TARGET_DIR:-target}
host=$(rustc -vV | sed -n 's/^host: //p')
# Coverage, and the checks of debug builds; --target keeps these flags away from build scripts.
RUSTFLAGS="--cfg fuzzing -Cpasses=sancov-module -Ccodegen-units=1 -Cllvm-args=-sanitizer-coverage-level=4 \
	-Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
	-Cllvm-args=-sanitizer-coverage-trace-compares -Cdebug-assertions -Coverflow-checks"
export RUSTFLAGS
cargo build --release --target "$host" --bins
mkdir -p corpus/session artifacts
"$target_dir/$host/release/session" corpus/session seeds -max_total_time="${1:-120}" \
	-timeout=10 -rss_limit_mb=2048 -max_len=4096 -dict=words.dict -artifact_prefix=artifacts/ \
	-print_final_stats=1
