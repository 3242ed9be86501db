"""Closures of the lips by OpenFaceFX (PyPI) beside ours, from the same labels:

    python3 -m venv ~/peer && ~/peer/bin/pip install openfacefx
    ~/peer/bin/python tests/peer_openfacefx.py target/release/mouthpiece tests/fixtures/sentences/*.PHN

It gets a stop's closure and release as the one ARPAbet phone that it knows, and is closed where its viseme PP is
at least 0.9, its own floor for closures. Ours is closed where the lips of the drawn mesh are at most 0.3 mm apart.
Both are judged by the labelled hold (m, em, pcl, bcl): whether they close in it, for how long, and how far the
middle of that is from the middle of the hold.
"""

import csv
import statistics
import subprocess
import sys

from openfacefx import PhonemeSegment, build_viseme_curves

RATE = 240
HOLDS = ("m", "em", "pcl", "bcl")
FOLDED = {
    "ux": "UW", "ax": "AH", "ix": "IH", "axr": "ER", "ax-h": "AH", "el": "L", "em": "M", "en": "N", "eng": "NG",
    "nx": "N", "dx": "D", "hv": "HH", "h#": "sil", "pau": "sil", "epi": "sil", "q": "sil",
}


def read(path):
    with open(path) as lines:
        rows = [line.split() for line in lines]
    return [(phone, int(start) / 16e3, int(end) / 16e3) for start, end, phone in rows]


def arpabet(labels):
    out = []
    for i, (phone, start, end) in enumerate(labels):
        if phone.endswith("cl"):
            after = labels[i + 1][0] if i + 1 < len(labels) else ""
            if after in ("p", "b", "t", "d", "k", "g", "ch", "jh"):
                continue  # the release begins here
            phone = phone[0]
        before = labels[i - 1] if i else ("", 0, 0)
        start = before[1] if before[0].endswith("cl") else start
        out.append(PhonemeSegment(FOLDED.get(phone, phone.upper()), start, end))
    return out


def peer(path, labels):
    times, matrix = build_viseme_curves(arpabet(labels), fps=RATE)
    return list(times), [value >= 0.9 for value in matrix[:, 1]]


def ours(path, labels):
    command = [sys.argv[1], "curves", "--labels", path, "--rate", str(RATE)]
    text = subprocess.run(command, capture_output=True, check=True, text=True).stdout
    rows = list(csv.DictReader(text.splitlines()))
    return [float(r["time_s"]) for r in rows], [float(r["aperture_mm"]) <= 0.3 for r in rows]


def judge(name, curve, files):
    holds, lasts, off = 0, [], []
    for path in files:
        labels = read(path)
        times, closed = curve(path, labels)
        for phone, start, end in labels:
            if phone not in HOLDS:
                continue
            holds += 1
            middle = (start + end) / 2
            inside = [i for i, t in enumerate(times) if start <= t < end and closed[i]]
            if not inside:
                continue
            first = last = min(inside, key=lambda i: abs(times[i] - middle))
            while first > 0 and closed[first - 1]:
                first -= 1
            while last + 1 < len(closed) and closed[last + 1]:
                last += 1
            lasts.append((last - first + 1) / RATE * 1e3)
            off.append(abs((times[first] + times[last]) / 2 - middle) * 1e3)
    print(
        f"{name}: {len(lasts)} of {holds} close, for {statistics.median(lasts):.0f} ms (median), "
        f"{statistics.median(off):.1f} ms from the middle of the hold (median; nine of ten within "
        f"{statistics.quantiles(off, n=10)[8]:.0f})"
    )


judge("OpenFaceFX", peer, sys.argv[2:])
judge("Mouthpiece", ours, sys.argv[2:])
