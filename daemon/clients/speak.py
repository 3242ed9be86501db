#!/usr/bin/env python3
"""Speaks a label file, and the sound that belongs to it, through a running `mouthpiece run`.

    daemon/clients/speak.py hello.phn [hello.wav] [--at PLACE] [--alphabet A] [--token-file F] [--caption TEXT]

Python 3.8 or newer, standard library only. PLACE is a socket's path or HOST:PORT. Labels are lines `start end phone`: whole
samples of 16 kHz as TIMIT has them, or seconds where a time has a point. Whoever has a voice of their own copies `Mouthpiece`
and sends labels and sound as they are made.
"""

import argparse
import base64
import json
import os
import socket
import sys
import wave


class Mouthpiece:
    """A connection to the daemon."""

    def __init__(self, place, token=None):
        if "/" in place:
            self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
            self.socket.connect(place)
        else:
            host, _, port = place.rpartition(":")
            self.socket = socket.create_connection((host, int(port)))
        self.answers = self.socket.makefile("r", encoding="utf-8", newline="\n")
        if token is not None:
            self.send(type="auth", token=token)

    def send(self, **message):
        line = json.dumps(message, separators=(",", ":")) + "\n"
        self.socket.sendall(line.encode())

    def begin(self, id, rate=None, channels=1, alphabet="timit"):
        """Opens an utterance; `rate` is that of its sound, which is 16-bit and follows."""
        audio = {} if rate is None else {"audio": {"rate": rate, "channels": channels}}
        self.send(type="begin", id=id, alphabet=alphabet, **audio)

    def phones(self, labels):
        """Labels (start, end, phone), in seconds."""
        phones = [{"start": s, "end": e, "phone": p} for s, e, p in labels]
        self.send(type="phones", phones=phones)

    def sound(self, data):
        """The next bytes of the sound, cut anywhere."""
        self.send(type="audio", data=base64.b64encode(data).decode())

    def end(self):
        self.send(type="end")

    def answer(self):
        """The next answer; none when the daemon has gone."""
        line = self.answers.readline()
        return json.loads(line) if line else None

    def wait(self, id):
        """Prints what is answered until the utterance has ended; whether it was heard to its end."""
        while True:
            answer = self.answer()
            if answer is None:
                print("the daemon has gone", file=sys.stderr)
                return False
            kind = answer["type"]
            if kind != "progress":
                print(json.dumps(answer, ensure_ascii=False))
            if kind in ("finished", "stopped") and answer["id"] == id:
                return kind == "finished"
            # An error before the utterance was accepted names none.
            if kind == "error" and (answer.get("fatal") or "id" not in answer):
                return False


def read_labels(path):
    """The labels of a file, in seconds."""
    with open(path, encoding="utf-8") as file:
        for line in file:
            fields = line.split()
            if len(fields) == 3:
                times = [float(t) if "." in t else int(t) / 16000 for t in fields[:2]]
                yield (*times, fields[2])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("labels")
    parser.add_argument("sound", nargs="?", help="a WAV file of 16 bits")
    runtime = os.environ.get("XDG_RUNTIME_DIR", "/nowhere")
    parser.add_argument("--at", default=f"{runtime}/mouthpiece.sock", help="a path, or HOST:PORT")
    parser.add_argument("--alphabet", default="timit")
    parser.add_argument("--token-file")
    parser.add_argument("--caption")
    args = parser.parse_args()
    token = None
    if args.token_file:
        with open(args.token_file, encoding="ascii") as file:
            token = file.read().strip()

    face = Mouthpiece(args.at, token)
    if args.sound is None:
        face.begin("python", alphabet=args.alphabet)
        face.phones(read_labels(args.labels))
    else:
        with wave.open(args.sound) as sound:
            if sound.getsampwidth() != 2:
                parser.error(f"{args.sound} is not of 16 bits")
            face.begin("python", sound.getframerate(), sound.getnchannels(), args.alphabet)
            face.phones(read_labels(args.labels))
            while data := sound.readframes(sound.getframerate() // 10):
                face.sound(data)
    if args.caption:
        face.send(type="caption", text=args.caption)
    face.end()
    return 0 if face.wait("python") else 1


if __name__ == "__main__":
    sys.exit(main())
