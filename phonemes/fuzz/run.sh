#!/bin/sh
# Fuzzes readers, one after the other: `phonemes/fuzz/run.sh [SECONDS [TARGET...]]`, 120 seconds
# each unless told. Needs no nightly toolchain and no cargo-fuzz; with them, see README.md.
set -eu
cd "$(dirname "$0")"
seconds=${1:-120}
[ $# -gt 0 ] && shift
[ $# -gt 0 ] || set -- timit_file timit_stream textgrid xlabel hts flite mbrola espeak_events piper \
	gentle mfa_json whisper characters azure polly rhubarb ndjson ndjson_stream
. ./build.sh
for target in "$@"; do
	mkdir -p "corpus/$target" artifacts
	case $target in
	timit_*) seeds=seeds/$target ;;
	ndjson_stream) seeds=../tests/samples/ndjson ;;
	*) seeds=../tests/samples/$(echo "$target" | tr _ -) ;;
	esac
	echo "== $target"
	"$targets/$target" "corpus/$target" "$seeds" -max_total_time="$seconds" \
		-timeout=10 -rss_limit_mb=2048 -max_len=4096 -artifact_prefix="artifacts/$target-" \
		-print_final_stats=1
done
