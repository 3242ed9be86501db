#!/usr/bin/env bash
# The live tests: what a second process hears and sees of the program, sound against picture; and two minutes of a
# face under load (tests/soak.py; an hour of it: tests/soak.py --minutes 60).
# Skipped, and says why, where its tools are not installed; in CI they must be (status 1).
#
#   .ci/live.sh [SECONDS]
set -euo pipefail
cd "$(dirname "$0")/.."

# Ours fails at 20 ms on a quiet machine; beyond 80 ms a viewer sees it, whatever the machine.
limit_ms=80

if ! command -v python3 >/dev/null; then
    status=2
    echo "live: python3 is not installed"
else
    status=0
    python3 tests/live_sync.py --seconds "${1:-20}" --limit-ms "$limit_ms" </dev/null || status=$?
    if [ "$status" = 0 ]; then
        # Two minutes say little of memory (what is still growing into its size may), nor of a trend of less than a
        # picture's time.
        python3 tests/soak.py --minutes 2 --skew-ms "$limit_ms" --skew-share 0.9 --trend-ms 40 --growth-mb 8 </dev/null || status=$?
    fi
fi
if [ "$status" = 2 ] && [ -z "${CI:-}" ]; then
    echo "live: skipped, since a tool named above is not installed (make setup-test installs it)"
    exit 0
fi
exit "$status"
