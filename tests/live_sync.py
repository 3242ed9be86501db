#!/usr/bin/env python3
"""Judges sound against picture from outside: is the flash on the screen when the click is heard?

Starts a private PulseAudio with a null sink and a private Xvfb, runs `mouthpiece sync-test` in them,
records the sink's monitor in one process and the screen in another, each with CLOCK_MONOTONIC
stamps, pairs clicks with flashes and prints by how much the picture is late. Exit status: 0 within
the limit, 1 beyond it, 2 when something needed is not installed.

    tests/live_sync.py [--seconds 60] [--limit-ms 80] [--binary target/release/mouthpiece]

Python's standard library only; libX11 and libpulse are called directly. Needs Xvfb, pulseaudio,
pulseaudio-utils and ALSA's pulse plugin (Debian: xvfb pulseaudio pulseaudio-utils libasound2-plugins).

What the recorders themselves add is measured first, with sound and pictures of this script's own:
- sound: clicks are played through libpulse-simple, which says after each write when the next sample
  will be played; the difference to when the recorder hears them is the recorder's offset. (A null
  sink hands each block to its monitor when the block's first sample is due, so the end of a block
  is heard up to a block early: some 5 ms.)
- screen: a window is filled between two stamps; the difference to when the recorder sees it is the
  offset. What is seen is the X server's picture: a real screen adds its scan-out.
Both are subtracted and printed. The calibration shares the sound server's word for when a sample is
played with the program under test; with a null sink there is no other truth.
"""

import argparse
import array
import bisect
import ctypes
import ctypes.util
import json
import multiprocessing
import os
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import time

RATE = 48_000
LOUD = 6_000  # of 32767: clicks are at 23,000
QUIET_S = 0.3  # between two clicks
SINK = "mouthpiece_test"
POLL_S = 0.002
ENVELOPE_S = 4.0


def main():
    options = arguments()
    for tool in ["Xvfb", "pulseaudio", "parec"]:
        if not shutil.which(tool):
            print(f"live_sync: {tool} is not installed (Debian: xvfb pulseaudio pulseaudio-utils)")
            return 2
    with tempfile.TemporaryDirectory(prefix="live-sync-") as folder, Stage(folder) as stage:
        sound_offset = calibrate_sound(stage)
        screen_offset = calibrate_screen(stage)
        command = [
            options.binary, "-v", "sync-test", str(options.seconds),
            "--size", options.size, "--tier", options.tier,
        ]
        player = subprocess.Popen(command, env=stage.environment)
        clicks, flashes, gaps = record(stage, player, options.seconds + 60)
    clicks = [t - sound_offset for t in clicks]
    flashes = [t - screen_offset for t in flashes]
    return judge(options, clicks, flashes, gaps, sound_offset, screen_offset, player.returncode)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=int, default=60)
    parser.add_argument("--limit-ms", type=float, default=80.0)
    parser.add_argument("--binary", default="target/release/mouthpiece")
    parser.add_argument("--size", default="320x320")
    parser.add_argument("--tier", default="low")
    parser.add_argument("--json", action="store_true", help="print one JSON object as well")
    return parser.parse_args()


class Stage:
    """The private servers. Ends what it started, and nothing else."""

    def __init__(self, folder):
        self.folder = folder
        self.children = []
        self.environment = dict(os.environ)
        for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET", "PULSE_SERVER"]:
            self.environment.pop(name, None)

    def __enter__(self):
        try:
            return self.start()
        except BaseException:
            self.__exit__()
            raise

    def start(self):
        os.chmod(self.folder, 0o700)
        # A home of its own: ALSA's default device is the private server whatever the user has set.
        with open(os.path.join(self.folder, ".asoundrc"), "w", encoding="ascii") as rc:
            rc.write("pcm.!default pulse\nctl.!default pulse\n")
        socket = os.path.join(self.folder, "pulse.sock")
        self.environment |= {
            "HOME": self.folder,
            "XDG_RUNTIME_DIR": self.folder,
            "PULSE_SERVER": f"unix:{socket}",
        }
        self.run([
            "pulseaudio", "-n", "--daemonize=no", "--exit-idle-time=-1", "--use-pid-file=no",
            "--realtime=no", "--high-priority=no", "--log-level=error",
            "-L", f"module-null-sink sink_name={SINK} rate={RATE} format=s16le channels=2",
            "-L", f"module-native-protocol-unix auth-anonymous=1 socket={socket}",
        ])
        wait_for(lambda: os.path.exists(socket), "PulseAudio")
        read, write = os.pipe()
        self.run(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", "800x800x24", "-nolisten", "tcp"],
            pass_fds=[write],
        )
        os.close(write)
        with os.fdopen(read) as answer:
            number = answer.readline().strip()
        if not number:
            raise SystemExit("live_sync: Xvfb did not start")
        self.environment["DISPLAY"] = f":{number}"
        os.environ.update(self.environment)
        return self

    def run(self, command, **more):
        child = subprocess.Popen(
            command, env=self.environment, stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **more,
        )
        self.children.append(child)
        return child

    def __exit__(self, *_):
        for child in reversed(self.children):
            child.terminate()
            try:
                child.wait(5)
            except subprocess.TimeoutExpired:
                child.kill()


def wait_for(ready, what, seconds=10.0):
    until = time.monotonic() + seconds
    while not ready():
        if time.monotonic() > until:
            raise SystemExit(f"live_sync: {what} did not start")
        time.sleep(0.02)


# Sound


def hear(connection, started):
    """Records until told to stop; sends back when each click was heard."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parec = subprocess.Popen(
        ["parec", "-d", f"{SINK}.monitor", "--raw", "--format=s16le", f"--rate={RATE}",
         "--channels=1", "--latency-msec=5"],
        stdout=subprocess.PIPE, bufsize=0,
    )
    samples, stamps, onsets = 0, [], []
    last_loud = -RATE
    odd = b""
    while not connection.poll():
        piece = parec.stdout.read(65536)
        now = time.monotonic()
        if not piece:
            break
        piece = odd + piece
        odd = piece[len(piece) & ~1:]
        block = array.array("h", piece[:len(piece) & ~1])
        if max(block) > LOUD or min(block) < -LOUD:
            for n, value in enumerate(block):
                if abs(value) > LOUD:
                    if samples + n - last_loud > QUIET_S * RATE:
                        onsets.append(samples + n)
                    last_loud = samples + n
        samples += len(block)
        if not stamps:
            started.set()
        stamps.append((now, samples))
    parec.terminate()
    parec.wait()
    connection.send([sample / RATE + offset_near(stamps, sample) for sample in onsets])


def offset_near(stamps, sample):
    """Time minus sound position around a sample: pieces arrive late, never early, so the least counts."""
    reach = ENVELOPE_S * RATE / 2
    first = bisect.bisect_right(stamps, sample - reach, key=lambda stamp: stamp[1])
    last = bisect.bisect_left(stamps, sample + reach, key=lambda stamp: stamp[1])
    return min(t - n / RATE for t, n in stamps[first:last])


class Ear:
    """The sound recorder's process."""

    def __enter__(self):
        self.connection, child = multiprocessing.Pipe()
        started = multiprocessing.Event()
        self.process = multiprocessing.Process(target=hear, args=(child, started))
        self.process.start()
        if not started.wait(10):
            raise SystemExit("live_sync: the sink's monitor gives no sound")
        time.sleep(0.5)
        return self

    def onsets(self):
        time.sleep(0.5)
        self.connection.send("stop")
        return self.connection.recv()

    def __exit__(self, *_):
        self.process.terminate()
        self.process.join()


def calibrate_sound(stage, clicks=12):
    """By how much later than it is played the recorder hears a sample, seconds."""
    name = ctypes.util.find_library("pulse-simple") or "libpulse-simple.so.0"
    pulse = ctypes.CDLL(name)

    class Spec(ctypes.Structure):
        _fields_ = [("format", ctypes.c_int), ("rate", ctypes.c_uint32), ("channels", ctypes.c_uint8)]

    pulse.pa_simple_new.restype = ctypes.c_void_p
    pulse.pa_simple_get_latency.restype = ctypes.c_uint64
    error = ctypes.c_int()
    spec = Spec(3, RATE, 1)  # PA_SAMPLE_S16LE
    with Ear() as ear:
        stream = pulse.pa_simple_new(
            None, b"calibration", 1, SINK.encode(), b"clicks", ctypes.byref(spec), None, None,
            ctypes.byref(error),
        )
        if not stream:
            raise SystemExit("live_sync: the null sink cannot be played to")
        stream = ctypes.c_void_p(stream)
        block = RATE // 50
        silence = bytes(2 * block)
        click = array.array("h", ([23000] * 12 + [-23000] * 12) * 16).tobytes()
        click += bytes(2 * block - len(click))
        written, at, ends = 0, [], []
        for n in range(50 * (clicks + 2)):
            if n % 50 == 49 and len(at) < clicks:
                at.append(written)
                data = click
            else:
                data = silence
            pulse.pa_simple_write(stream, data, ctypes.c_size_t(len(data)), ctypes.byref(error))
            written += block
            before = time.monotonic()
            latency = pulse.pa_simple_get_latency(stream, ctypes.byref(error)) * 1e-6
            now = (before + time.monotonic()) / 2
            ends.append((now + latency - written / RATE, written))
        pulse.pa_simple_drain(stream, ctypes.byref(error))
        pulse.pa_simple_free(stream)
        heard = ear.onsets()
    if len(heard) != clicks:
        raise SystemExit(f"live_sync: {len(heard)} of {clicks} clicks of the calibration were heard")
    origin = statistics.median(t for t, n in ends if n > RATE)
    errors = [h - (origin + a / RATE) for h, a in zip(heard, at)]
    spread = max(errors) - min(errors)
    print(f"sound recorder: {1e3 * statistics.median(errors):+.1f} ms, spread {1e3 * spread:.1f} ms")
    return statistics.median(errors)


# Screen


class Screen:
    """Reads the brightness of a few pixels at the upper left of an X screen."""

    SIDE = 8
    AT = 8

    def __init__(self):
        x11 = ctypes.CDLL(ctypes.util.find_library("X11") or "libX11.so.6")
        for name in ["XOpenDisplay", "XGetImage", "XCreateGC"]:
            getattr(x11, name).restype = ctypes.c_void_p
        x11.XGetPixel.restype = ctypes.c_ulong
        x11.XGetPixel.argtypes = [ctypes.c_void_p, ctypes.c_int, ctypes.c_int]
        x11.XDefaultRootWindow.restype = ctypes.c_ulong
        self.x11 = x11
        self.display = ctypes.c_void_p(x11.XOpenDisplay(None))
        if not self.display:
            raise SystemExit("live_sync: the private X server does not answer")
        self.root = ctypes.c_ulong(x11.XDefaultRootWindow(self.display))
        self.image = ctypes.c_void_p(x11.XGetImage(*self.region(), PLANES, ZPIXMAP))

    def region(self):
        at, side = ctypes.c_int(self.AT), ctypes.c_uint(self.SIDE)
        return self.display, self.root, at, at, side, side

    def brightness(self):
        """The dimmest of the pixels, 0 to 255, and when it was so."""
        before = time.monotonic()
        zero = ctypes.c_int(0)
        self.x11.XGetSubImage(*self.region(), PLANES, ZPIXMAP, self.image, zero, zero)
        after = time.monotonic()
        dimmest = 255
        for x, y in [(0, 0), (self.SIDE - 1, 0), (0, self.SIDE - 1), (self.SIDE - 1, self.SIDE - 1)]:
            pixel = self.x11.XGetPixel(self.image, x, y)
            dimmest = min(dimmest, pixel & 255, pixel >> 8 & 255, pixel >> 16 & 255)
        return dimmest, (before + after) / 2

    def fill(self, white):
        """Fills the root window; returns when, from before to after."""
        gc = ctypes.c_void_p(self.x11.XCreateGC(self.display, self.root, ctypes.c_ulong(0), None))
        self.x11.XSetForeground(self.display, gc, ctypes.c_ulong(0xFFFFFF if white else 0))
        size = ctypes.c_uint(100)
        zero = ctypes.c_int(0)
        self.x11.XSync(self.display, zero)
        before = time.monotonic()
        self.x11.XFillRectangle(self.display, self.root, gc, zero, zero, size, size)
        self.x11.XSync(self.display, zero)
        after = time.monotonic()
        self.x11.XFreeGC(self.display, gc)
        return (before + after) / 2


PLANES = ctypes.c_ulong(0xFFFFFFFF)
ZPIXMAP = ctypes.c_int(2)
WHITE = 230


class Watch:
    """Finds where the pixels turn white."""

    def __init__(self, screen):
        self.screen = screen
        self.last = None
        self.flashes, self.gaps = [], []

    def look(self):
        value, now = self.screen.brightness()
        white = value >= WHITE
        if self.last:
            was_white, before = self.last
            self.gaps.append(now - before)
            if white and not was_white:
                self.flashes.append((before + now) / 2)
        self.last = white, now
        time.sleep(max(0.0, POLL_S - (time.monotonic() - now)))


def paint(connection):
    """Flashes the root window and sends back when; a process of its own, as the program under test."""
    screen, times = Screen(), []
    for n in range(24):
        white = n % 2 == 1
        at = screen.fill(white)
        if white:
            times.append(at)
        time.sleep(0.1 + 0.0037 * n % 0.01)
    screen.fill(False)
    connection.send(times)


def calibrate_screen(stage):
    """By how much later than it is painted the recorder sees a flash, seconds."""
    watch = Watch(Screen())
    connection, child = multiprocessing.Pipe()
    painter = multiprocessing.Process(target=paint, args=(child,))
    painter.start()
    while not connection.poll():
        watch.look()
    painted = connection.recv()
    painter.join()
    if len(painted) != len(watch.flashes):
        raise SystemExit(f"live_sync: {len(watch.flashes)} of {len(painted)} test flashes were seen")
    errors = [seen - at for seen, at in zip(watch.flashes, painted)]
    spread = max(errors) - min(errors)
    print(f"screen recorder: {1e3 * statistics.median(errors):+.1f} ms, spread {1e3 * spread:.1f} ms")
    return statistics.median(errors)


# The test


def record(stage, player, seconds_max):
    """Clicks heard, flashes seen and the gaps between looks while the program runs."""
    until = time.monotonic() + seconds_max
    with Ear() as ear:
        watch = Watch(Screen())
        while player.poll() is None:
            watch.look()
            if time.monotonic() > until:
                player.kill()
                print("live_sync: the program did not end by itself")
        return ear.onsets(), watch.flashes, watch.gaps


def judge(options, clicks, flashes, gaps, sound_offset, screen_offset, status):
    pairs = []
    for click in clicks:
        near = min(flashes, key=lambda t: abs(t - click), default=None)
        if near is not None and abs(near - click) < 0.4:
            pairs.append((click, 1e3 * (near - click)))
    if status != 0:
        print(f"live_sync: the program ended with status {status}")
        return 1
    if len(pairs) < 0.9 * options.seconds:
        print(f"live_sync: {len(clicks)} clicks and {len(flashes)} flashes for {options.seconds} s: "
              "something was not heard or not seen")
        return 1
    skews = [s for _, s in pairs]
    median = statistics.median(skews)
    ordered = sorted(skews)
    low, high = ordered[len(ordered) // 10], ordered[-1 - len(ordered) // 10]
    slope, error = trend([c - pairs[0][0] for c, _ in pairs], skews)
    rate = 1 / statistics.median(gaps)
    print(f"{len(pairs)} clicks; the screen was looked at {rate:.0f} times a second "
          f"(longest gap {1e3 * max(gaps):.0f} ms)")
    print(f"picture after sound: median {median:+.1f} ms, middle 80 % {low:+.1f} to {high:+.1f} ms, "
          f"worst {max(skews, key=abs):+.1f} ms")
    drift = slope * (pairs[-1][0] - pairs[0][0])
    drift_error = error * (pairs[-1][0] - pairs[0][0])
    print(f"trend over the run: {drift:+.1f} ms, standard error {drift_error:.1f} ms")
    if options.json:
        print(json.dumps({
            "median_ms": median, "p10_ms": low, "p90_ms": high, "trend_ms": drift,
            "trend_error_ms": drift_error, "pairs": len(pairs),
            "sound_offset_ms": 1e3 * sound_offset, "screen_offset_ms": 1e3 * screen_offset,
            "looks_per_s": rate, "skews_ms": [round(s, 1) for s in skews],
        }))
    trending = abs(drift) > max(options.limit_ms / 2, 10.0) and abs(drift) > 3 * drift_error
    if abs(median) > options.limit_ms or trending:
        print(f"live_sync: beyond {options.limit_ms:.0f} ms")
        return 1
    return 0


def trend(times, values):
    """Slope of a straight line through the values, and its standard error."""
    mean_t, mean_v = statistics.fmean(times), statistics.fmean(values)
    spread = sum((t - mean_t) ** 2 for t in times)
    if spread == 0.0 or len(times) < 3:
        return 0.0, 0.0
    slope = sum((t - mean_t) * (v - mean_v) for t, v in zip(times, values)) / spread
    rest = sum((v - mean_v - slope * (t - mean_t)) ** 2 for t, v in zip(times, values))
    return slope, (rest / (len(times) - 2) / spread) ** 0.5


if __name__ == "__main__":
    sys.exit(main())
