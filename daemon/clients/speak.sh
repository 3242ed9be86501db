#!/bin/sh
# Speaks a TIMIT label file, with the sound that belongs to it, through a running `mouthpiece run`:
#
#     daemon/clients/speak.sh hello.phn [hello.wav [SOCKET]]
#
# Needs socat, and awk. Without sound a label file can be piped in as it is:
#
#     socat -t 60 - UNIX-CONNECT:"$XDG_RUNTIME_DIR/mouthpiece.sock" < hello.phn
set -eu
labels=$1
sound=${2:-}
socket=${3:-${XDG_RUNTIME_DIR:-/nowhere}/mouthpiece.sock}

messages() {
	if [ -n "$sound" ]; then
		# The daemon reads the file itself; a path in JSON may need more care than this.
		path=$(cd "$(dirname "$sound")" && pwd)/$(basename "$sound")
		printf '{"type":"begin","id":"shell","label_rate":16000,"audio":{"file":"%s"}}\n' "$path"
	else
		printf '{"type":"begin","id":"shell","label_rate":16000}\n'
	fi
	awk 'NF == 3 { printf "{\"type\":\"phones\",\"phones\":[{\"start\":%d,\"end\":%d,\"phone\":\"%s\"}]}\n", $1, $2, $3 }' "$labels"
	printf '{"type":"end"}\n'
}

# socat closes its sending half at the end of the messages and prints answers until the daemon has no more.
answers=$(messages | socat -t 600 - "UNIX-CONNECT:$socket")
printf '%s\n' "$answers" | grep -v '"progress"'
case $answers in
*'"type":"finished"'*) ;;
*) exit 1 ;;
esac
