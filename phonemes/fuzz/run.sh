#!/bin/sh
# Fuzzes readers, one after the other: `phonemes/fuzz/run.sh [SECONDS [TARGET...]]`, 120 seconds
# each unless told. Needs no nightly toolchain and no cargo-fuzz; with them, see README.md.
set -eu
cd "$(dirname "$0")"
target_dir=${CARGO_TARGET_DIR:-target}
seconds=${1:-120}
[ $# -gt 0 ] && shift
[ $# -gt 0 ] || set -- timit_file timit_stream textgrid xlabel hts flite mbrola espeak_events piper \
	gentle mfa_json whisper characters azure polly rhubarb ndjson ndjson_stream
host=$(rustc -vV | sed -n 's/^host: //p')
# Coverage, and the checks of debug builds; --target keeps these flags away from build scripts.
RUSTFLAGS="--cfg fuzzing -Cpasses=sancov-module -Ccodegen-units=1 -Cllvm-args=-sanitizer-coverage-level=4 \
	-Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
	-Cllvm-args=-sanitizer-coverage-trace-compares -Cdebug-assertions -Coverflow-checks"
export RUSTFLAGS
cargo build --release --target "$host" --bins
for target in "$@"; do
	mkdir -p "corpus/$target" artifacts
	case $target in
	timit_*) seeds=seeds/$target ;;
	ndjson_stream) seeds=../tests/samples/ndjson ;;
	*) seeds=../tests/samples/$(echo "$target" | tr _ -) ;;
	esac
	echo "== $target"
	"$target_dir/$host/release/$target" "corpus/$target" "$seeds" -max_total_time="$seconds" \
		-timeout=10 -rss_limit_mb=2048 -max_len=4096 -artifact_prefix="artifacts/$target-" \
		-print_final_stats=1
done
