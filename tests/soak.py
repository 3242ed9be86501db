#!/usr/bin/env python3
"""A face under load for as long as you like: does it hold?

Starts a private PulseAudio with a null sink and a private Xvfb, runs `mouthpiece run` in them, and lets four clients
each speak a sentence every five seconds (any rate, format and size of piece, labels before, with or after their
sound), with barge-in at random; a fifth sends garbage, a sixth begins and asks and never reads. Every sentence
contains a click, with which the picture flashes, so that sound and screen are compared from outside as in
live_sync.py. Prints, and judges by:

- the process lives, and has not panicked (its log), and ends within a second when asked to;
- every utterance that was accepted ended exactly once: finished, stopped or error; the daemon's own count agrees;
- /healthz said well all the time;
- how much memory (RSS) grew after the warm-up;
- how much later the picture is than the sound: median, 99 %, trend.

    tests/soak.py --minutes 2        in `make test`
    tests/soak.py --minutes 60       an hour; --json F writes the figures

Exit status: 0 it holds, 1 it does not, 2 something needed is not installed. The same --seed is the same load.
Python's standard library only; needs what live_sync.py needs.
"""

import argparse
import array
import base64
import json
import math
import multiprocessing
import os
import random
import re
import shutil
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import threading
import time
import urllib.error
import urllib.request

import live_sync

CLIENTS = 4
EVERY_S = 5.0
SENTENCE_S = (0.7, 1.05)  # so that four of them fit into the five seconds
UNEVEN_S = 0.1  # some pictures: evenly spaced clicks would beat with them, and the beat would look like a trend
CLICK_S = 0.3  # from a sentence's beginning to its click
BARGE_IN = 0.08  # of the sentences
PATIENCE_S = 30.0


def main():
    options = arguments()
    for tool in ["Xvfb", "pulseaudio", "parec"]:
        if not shutil.which(tool):
            print(f"soak: {tool} is not installed (Debian: xvfb pulseaudio pulseaudio-utils)")
            return 2
    with tempfile.TemporaryDirectory(prefix="soak-") as folder, live_sync.Stage(folder) as stage:
        sound_offset = live_sync.calibrate_sound(stage)
        screen_offset = live_sync.calibrate_screen(stage)
        daemon = Daemon(options, stage, folder)
        try:
            figures = run(options, daemon)
        finally:
            daemon.kill()
    figures["clicks"] = [t - sound_offset for t in figures["clicks"]]
    figures["flashes"] = [t - screen_offset for t in figures["flashes"]]
    return judge(options, figures)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--minutes", type=float, default=2.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--binary", default="target/release/mouthpiece")
    parser.add_argument("--size", default="320x320")
    parser.add_argument("--warm-up-s", type=float, help="before memory is judged; 300, or half of a shorter run")
    parser.add_argument("--skew-ms", type=float, default=20.0, help="what the skews must keep within")
    parser.add_argument("--skew-share", type=float, default=0.99, help="as many of them; a few minutes know little of 99 %%")
    parser.add_argument("--trend-ms", type=float, default=5.0, help="how much the skew may change over the run, or three standard errors")
    parser.add_argument("--growth-mb", type=float, default=1.0, help="what memory may grow by after the warm-up")
    parser.add_argument("--json", metavar="F", help="write the figures there")
    options = parser.parse_args()
    if options.warm_up_s is None:
        options.warm_up_s = min(300.0, options.minutes * 30.0)
    return options


class Daemon:
    """The program under test."""

    def __init__(self, options, stage, folder):
        self.socket = os.path.join(folder, "face.sock")
        self.log_path = os.path.join(folder, "log")
        self.log = open(self.log_path, "wb")
        self.process = subprocess.Popen(
            [options.binary, "run", "--log-json", "--test", "--http", "127.0.0.1:0", "--listen", self.socket,
             "--size", options.size, "--tier", "low"],
            env=stage.environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=self.log,
        )
        self.http = None
        live_sync.wait_for(self.address, "mouthpiece", PATIENCE_S)
        live_sync.wait_for(lambda: self.healthy() is None, "the face", PATIENCE_S)

    def said(self):
        with open(self.log_path, encoding="utf-8", errors="replace") as log:
            return log.read()

    def address(self):
        if self.process.poll() is not None:
            raise SystemExit("soak: the program ended at once:\n" + self.said())
        found = re.search(r"health is told at (http://[^/]+)/", self.said())
        self.http = found and found[1]
        return self.http

    def page(self, path):
        with urllib.request.urlopen(self.http + path, timeout=10) as answer:
            return json.load(answer)

    def healthy(self):
        """None, or why not."""
        try:
            self.page("/healthz")
            return None
        except urllib.error.HTTPError as error:
            return error.read().decode()
        except OSError as error:
            return str(error)

    def rss_mb(self):
        with open(f"/proc/{self.process.pid}/status", encoding="ascii") as status:
            kb = next(line for line in status if line.startswith("VmRSS:")).split()[1]
        return int(kb) / 1024

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        self.log.close()


def run(options, daemon):
    """Load, recorders and looks at the process until the time is over."""
    seconds = options.minutes * 60
    over, quiet = multiprocessing.Event(), multiprocessing.Event()
    counts, child = multiprocessing.Pipe()
    load = multiprocessing.Process(target=load_all, args=(daemon.socket, options.seed, over, quiet, child))
    eye, seen = multiprocessing.Pipe()
    watching = multiprocessing.Process(target=watch, args=(seen,))
    memory, ill = [], []
    with live_sync.Ear() as ear:
        watching.start()
        load.start()
        begun = time.monotonic()
        while time.monotonic() - begun < seconds and daemon.process.poll() is None:
            time.sleep(1.0)
            why = daemon.healthy()
            if why:
                ill.append((time.monotonic() - begun, why))
            if daemon.process.poll() is None:
                memory.append((time.monotonic() - begun, daemon.rss_mb()))
        over.set()
        told = counts.recv() if counts.poll(PATIENCE_S * 2) else None
        status = drained(daemon)
        quiet.set()
        # More than the pipe holds is sent.
        eye.send("stop")
        flashes, gaps = eye.recv()
        clicks = ear.onsets()
    load.join(PATIENCE_S)
    watching.join(PATIENCE_S)
    asked = time.monotonic()
    if daemon.process.poll() is None:
        daemon.process.send_signal(signal.SIGTERM)
        try:
            daemon.process.wait(PATIENCE_S)
        except subprocess.TimeoutExpired:
            pass
    return {
        "seconds": seconds, "told": told, "status": status, "memory": memory, "ill": ill,
        "flashes": flashes, "gaps": gaps, "clicks": clicks,
        "exit": daemon.process.poll(), "end_s": time.monotonic() - asked, "log": daemon.said(),
    }


def drained(daemon):
    """What the daemon says of itself once nothing waits any more."""
    until = time.monotonic() + PATIENCE_S
    status = None
    while time.monotonic() < until and daemon.process.poll() is None:
        try:
            status = daemon.page("/status.json")
        except OSError:
            continue
        if status["utterances"]["queue"] == 0:
            break
        time.sleep(0.2)
    return status


# The screen


def watch(connection):
    """Looks for flashes until told to stop; a process of its own, so that nothing else keeps it from looking."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    eye = live_sync.Watch(live_sync.Screen())
    while not connection.poll():
        eye.look()
    connection.send((eye.flashes, sorted(eye.gaps)[-1000:]))


# The load


class Counts:
    """What the clients were told."""

    def __init__(self):
        self.lock = threading.Lock()
        self.accepted = self.refused = 0
        self.ends = {"finished": 0, "stopped": 0, "error": 0}
        self.wrong = []
        self.waits_ms = []


def load_all(path, seed, over, quiet, connection):
    """All clients, in one process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    counts = Counts()
    speakers = [Speaker(path, n, seed, over, counts) for n in range(CLIENTS)]
    others = [threading.Thread(target=garbage, args=(path, seed, over), daemon=True),
              threading.Thread(target=deaf, args=(path, seed, over), daemon=True)]
    threads = [threading.Thread(target=speaker.run) for speaker in speakers]
    for thread in threads + others:
        thread.start()
    for thread in threads:
        thread.join()
    connection.send({
        "accepted": counts.accepted, "ends": counts.ends, "refused": counts.refused, "wrong": counts.wrong,
        "waits_ms": counts.waits_ms,
    })
    quiet.wait(PATIENCE_S * 2)


def connect(path):
    stream = socket.socket(socket.AF_UNIX)
    stream.settimeout(PATIENCE_S)
    stream.connect(path)
    return stream


class Speaker:
    """A client that behaves: speaks every five seconds and keeps account of what it was told."""

    def __init__(self, path, number, seed, over, counts):
        self.random = random.Random(f"{seed}-{number}")
        self.number, self.over, self.counts = number, over, counts
        self.stream = connect(path)
        self.open, self.ended, self.begun = set(), set(), {}
        self.lock = threading.Lock()

    def run(self):
        reader = threading.Thread(target=self.read, daemon=True)
        reader.start()
        start = time.monotonic() + EVERY_S * self.number / CLIENTS
        n = 0
        while not self.over.wait(max(0.0, start + n * EVERY_S - time.monotonic())):
            time.sleep(self.random.uniform(0.0, UNEVEN_S))
            try:
                self.speak(f"{self.number}-{n}")
            except OSError as error:
                self.complain(f"client {self.number} could not send: {error}")
                return
            n += 1
        until = time.monotonic() + PATIENCE_S
        while self.open and time.monotonic() < until:
            time.sleep(0.05)
        for name in sorted(self.open):
            self.complain(f"{name} was accepted and never ended")
        self.stream.shutdown(socket.SHUT_RDWR)
        reader.join(PATIENCE_S)

    def complain(self, what):
        with self.counts.lock:
            self.counts.wrong.append(what)

    def speak(self, name):
        pick = self.random
        rate = pick.choice([8_000, 16_000, 22_050, 44_100, 48_000, 96_000])
        channels, kind = pick.choice([1, 2]), pick.choice(["s16", "f32"])
        seconds = pick.uniform(*SENTENCE_S)
        data = sentence(rate, channels, kind, seconds, pick)
        self.begun[name] = time.monotonic()
        with self.lock:
            self.open.add(name)
        self.send({"type": "begin", "id": name, "audio": {"rate": rate, "channels": channels, "format": kind}})
        labels = {"type": "phones", "phones": phones(seconds, pick)}
        order = pick.choice(["before", "with", "after"])
        if order == "before":
            self.send(labels)
        at = 0
        while at < len(data):
            size = pick.choice([1, 3, 997, 4_096, 20_000, 65_536])
            size = max(size, len(data) // 200)  # a few hundred messages at most
            self.send({"type": "audio", "data": base64.b64encode(data[at:at + size]).decode()})
            at += size
            if order == "with" and labels and at >= len(data) // 2:
                self.send(labels)
                labels = None
        if order == "after":
            self.send(labels)
        self.send({"type": "end"})
        if pick.random() < BARGE_IN:
            time.sleep(pick.uniform(0.0, 1.2))
            self.send({"type": "stop"} if pick.random() < 0.5 else {"type": "stop", "id": name})

    def send(self, message):
        self.stream.sendall(json.dumps(message).encode() + b"\n")

    def read(self):
        for line in self.stream.makefile("rb"):
            self.hear(json.loads(line))

    def hear(self, message):
        kind, name = message["type"], message.get("id")
        counts = self.counts
        with counts.lock:
            if kind == "accepted":
                counts.accepted += 1
            elif kind == "started":
                counts.waits_ms.append(1e3 * (time.monotonic() - self.begun[name]))
            elif kind in counts.ends and name and (kind != "error" or message.get("fatal")):
                counts.ends[kind] += 1
                with self.lock:
                    if name in self.ended or name not in self.open:
                        counts.wrong.append(f"{name} ended twice: {message}")
                    self.ended.add(name)
                    self.open.discard(name)
                if kind == "error":
                    counts.wrong.append(f"an error for what was right: {message}")
            elif kind == "error":
                # A stop for what had ended in between is no fault.
                counts.refused += 1


def sentence(rate, channels, kind, seconds, pick):
    """A quiet hum with one click in it."""
    frames = int(rate * seconds)
    pitch = pick.uniform(90.0, 220.0)
    click = range(int(CLICK_S * rate), int((CLICK_S + 0.008) * rate))
    half = max(1, rate // 4000)  # of a period of the click's 2 kHz
    out = array.array("f" if kind == "f32" else "h")
    for n in range(frames):
        value = 0.08 * math.sin(2 * math.pi * pitch * n / rate)
        if n in click:
            value = 0.8 if (n // half) % 2 == 0 else -0.8
        if kind == "s16":
            value = int(value * 32767)
        out.extend([value] * channels)
    return out.tobytes()


def phones(seconds, pick):
    """Any phones, one after the other, to the end."""
    out, at = [], 0.0
    while at < seconds:
        end = min(seconds, at + pick.uniform(0.05, 0.15))
        out.append({"start": round(at, 4), "end": round(end, 4), "phone": pick.choice(
            ["aa", "iy", "uw", "m", "p", "f", "s", "eh", "pau", "l", "b", "ow"])})
        at = end
    return [p for p in out if p["end"] > p["start"]]


def garbage(path, seed, over):
    """Sends what is nothing, and what is nearly something."""
    pick = random.Random(f"{seed}-garbage")
    lines = [b"\xff\xfe\x00{\n", b"{}\n", b"what?\n", b'{"type":"begin"}\n', b'{"type":"begin","id":"x","id":1}\n',
             b'{"type":"audio","data":"!!"}\n', b'{"type":"end"}\n', b"5 3 aa\n", b"[" * 2_000 + b"\n",
             b'{"type":"phones","phones":[{"start":-1e308,"end":1e308,"phone":"aa"}]}\n', b"x" * 70_000 + b"\n", b"\n"]
    while not over.is_set():
        try:
            with connect(path) as stream:
                stream.settimeout(2.0)
                for _ in range(pick.randrange(1, 200)):
                    if over.wait(0.05):
                        return
                    if pick.random() < 0.3:
                        stream.sendall(pick.randbytes(pick.randrange(1, 2_000)))
                    else:
                        stream.sendall(pick.choice(lines))
                    try:
                        stream.recv(65_536, socket.MSG_DONTWAIT)
                    except BlockingIOError:
                        pass
        except OSError:
            over.wait(0.5)


def deaf(path, seed, over):
    """Begins and asks for as long as it is let, and never reads; then comes again."""
    pick = random.Random(f"{seed}-deaf")
    n = 0
    while not over.is_set():
        try:
            with connect(path) as stream:
                stream.settimeout(10.0)
                stream.sendall(b'{"type":"begin","id":"d"}\n{"type":"phones","phones":'
                               b'[{"start":0,"end":0.05,"phone":"aa"}]}\n{"type":"end"}\n')
                while not over.wait(0.01):
                    n += 1
                    stream.sendall(json.dumps({"type": "ping", "token": f"{n}"}).encode() + b"\n")
        except OSError:
            over.wait(pick.uniform(1.0, 5.0))


# The judgement


def judge(options, figures):
    faults = []

    def fault(what):
        faults.append(what)
        print(f"soak: {what}")

    panics = figures["log"].count("panicked")
    if panics:
        fault(f"{panics} panics")
    if figures["exit"] != 0:
        fault(f"the program ended with status {figures['exit']}")
    elif figures["end_s"] > 1.0:
        fault(f"it took {figures['end_s']:.2f} s to end")
    out = {"minutes": options.minutes, "panics": panics, "exit": figures["exit"], "end_s": figures["end_s"]}
    out["utterances"] = account(figures, fault)
    out["memory"] = memory(options, figures["memory"], fault)
    out["skew"] = skew(options, figures, fault)
    ill = figures["ill"]
    print(f"health: ill {len(ill)} of {len(figures['memory'])} times asked"
          + "".join(f"\n  at {t:.0f} s: {why.strip()[:300]}" for t, why in ill[:5]))
    if ill:
        fault("a face that is watched was not well all the time")
    out["ill"] = len(ill)
    for line in figures["log"].splitlines():
        if '"level":"ERROR"' in line or "panicked" in line:
            print("  " + line[:300])
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump(out, file, indent=1)
            file.write("\n")
    print("soak: " + ("it does not hold" if faults else "it holds"))
    return 1 if faults else 0


def account(figures, fault):
    """Whether every utterance that was accepted ended once."""
    told, status = figures["told"], figures["status"]
    if not told or not status:
        fault("the clients or the daemon gave no account")
        return None
    for what in told["wrong"][:10]:
        fault(what)
    ends = told["ends"]
    print(f"utterances: {told['accepted']} accepted; {ends['finished']} finished, {ends['stopped']} stopped, "
          f"{ends['error']} error; {told['refused']} answers that something was too late")
    if sum(ends.values()) != told["accepted"] or told["accepted"] == 0:
        fault("some were accepted and did not end, or ended twice")
    own = status["utterances"]
    print(f"by the daemon's own count, all clients: {own['accepted']} accepted; {own['finished']} finished, "
          f"{own['stopped']} stopped, {own['error']} error, {own['queue']} waiting")
    if own["finished"] + own["stopped"] + own["error"] != own["accepted"] or own["queue"]:
        fault("the daemon's own count does not add up")
    window, sound = status["window"], status["sound"]
    print(f"pictures: {window['pictures'] / figures['seconds']:.1f} a second; set up again {window['failures']} times; "
          f"sound: ran dry {sound['underruns']} times, lost {sound['losses']}, left out {sound['dropped_s']:.2f} s; "
          f"skipped {status['simulation']['skips']} times")
    waits = sorted(told["waits_ms"])
    if waits:
        print(f"from begin to started, with those before it in turn: median {statistics.median(waits):.0f} ms, "
              f"99 % {quantile(waits, 0.99):.0f} ms")
    return {"told": {k: told[k] for k in ["accepted", "ends"]}, "own": own, "sound": sound, "window": window}


def memory(options, looks, fault):
    """By how much it grew from the minute after the warm-up to the last minute."""
    later = [(t, mb) for t, mb in looks if t >= options.warm_up_s]
    if len(later) < 10:
        fault("too few looks at the memory")
        return None
    end, span = later[-1][0], min(60.0, (later[-1][0] - later[0][0]) / 3)
    first = statistics.median(mb for t, mb in later if t <= later[0][0] + span)
    last = statistics.median(mb for t, mb in later if t >= end - span)
    print(f"memory: {first:.1f} MB after {options.warm_up_s:.0f} s, {last:.1f} MB at the end, "
          f"most {max(mb for _, mb in looks):.1f} MB")
    if last - first > options.growth_mb:
        fault(f"memory grew by {last - first:.1f} MB")
    every = max(1, len(looks) // 60)
    return {"first_mb": first, "last_mb": last, "looks": [(round(t), round(mb, 1)) for t, mb in looks[::every]]}


def skew(options, figures, fault):
    """Sound against picture."""
    clicks, flashes = figures["clicks"], figures["flashes"]
    pairs = []
    for click in clicks:
        near = min(flashes, key=lambda t: abs(t - click), default=None)
        if near is not None and abs(near - click) < 0.25:
            pairs.append((click, 1e3 * (near - click)))
    print(f"{len(clicks)} clicks heard, {len(flashes)} flashes seen, {len(pairs)} pairs; "
          f"longest gap between two looks at the screen {1e3 * max(figures['gaps']):.0f} ms")
    if len(pairs) < 0.9 * len(clicks) or len(pairs) < 10:
        fault("clicks that were heard were not seen")
        return None
    skews = [s for _, s in pairs]
    ordered, sizes = sorted(skews), sorted(abs(s) for s in skews)
    slope, error = live_sync.trend([c - pairs[0][0] for c, _ in pairs], skews)
    hours = (pairs[-1][0] - pairs[0][0])
    drift, drift_error = slope * hours, error * hours
    print(f"picture after sound: median {statistics.median(skews):+.1f} ms, middle 80 % {quantile(ordered, 0.1):+.1f} to "
          f"{quantile(ordered, 0.9):+.1f} ms; 99 % within {quantile(sizes, 0.99):.1f} ms, worst {sizes[-1]:.1f} ms; "
          f"trend over the run {drift:+.1f} ms, standard error {drift_error:.1f} ms")
    if quantile(sizes, options.skew_share) > options.skew_ms:
        fault(f"{100 * options.skew_share:.0f} % of the skews are not within {options.skew_ms:.0f} ms")
    if abs(drift) > max(options.trend_ms, 3 * drift_error):
        fault("the skew has a trend")
    return {"pairs": len(pairs), "median_ms": statistics.median(skews), "p99_ms": quantile(sizes, 0.99),
            "worst_ms": sizes[-1], "trend_ms": drift, "trend_error_ms": drift_error}


def quantile(ordered, share):
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]


if __name__ == "__main__":
    sys.exit(main())
