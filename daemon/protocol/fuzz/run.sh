#!/bin/sh
# Fuzzes the wire's session: `daemon/protocol/fuzz/run.sh [SECONDS]`, 120 seconds unless told. Needs no
# nightly toolchain and no cargo-fuzz; with them: cargo +nightly fuzz run --fuzz-dir daemon/protocol/fuzz session
set -eu
cd "$(dirname "$0")"
. ../../../phonemes/fuzz/build.sh
mkdir -p corpus/session artifacts
"$targets/session" corpus/session seeds -max_total_time="${1:-120}" \
	-timeout=10 -rss_limit_mb=2048 -max_len=4096 -dict=words.dict -artifact_prefix=artifacts/ \
	-print_final_stats=1
