#!/usr/bin/env python3
"""Does a face tracker that knows nothing of Mouthpiece see a face in its stills, with the lips where they are drawn?

Draws expressions from three sides with the release build, asks MediaPipe's face detector how sure it is of a face,
finds the face with MediaPipe's face mesh, and compares its contours of lips and lids and its points on the nose with
those that `mouthpiece still --outline` says were drawn. Distances are shares of the face's height (MediaPipe's topmost
to lowest point in the front view of the same expression). Exit status 1 where a front or three-quarter face is not
found or scores less than --score, or anything is off by more than --limit on the mean. The tracker is trained on
photographs, not made for profiles: of the side views only finding is printed.

    pip install mediapipe==0.10.14
    tests/mediapipe_check.py [--binary target/release/mouthpiece] [--head F.glb] [--keep FOLDER]
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

os.environ.setdefault("GLOG_minloglevel", "2")
os.environ.setdefault("TF_CPP_MIN_LOG_LEVEL", "3")

import cv2  # noqa: E402  (comes with mediapipe)
import mediapipe  # noqa: E402
import numpy  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent
SIZE = 800
VIEWS = ["front", "34", "side"]
# The smile is the one of rig/docs.
EXPRESSIONS = json.loads((ROOT / "rig/docs/faces.json").read_text())
EXPRESSIONS |= {name: ["--expression", name] for name in ("surprise", "anger", "happiness")}
# Numbers of the face mesh's points along the lips, from the subject's right corner over the upper lip and back.
OUTER = [61, 185, 40, 39, 37, 0, 267, 269, 270, 409, 291, 375, 321, 405, 314, 17, 84, 181, 91, 146]
INNER = [78, 191, 80, 81, 82, 13, 312, 311, 310, 415, 308, 324, 318, 402, 317, 14, 87, 178, 88, 95]
# The same along the lids of the subject's left and right eye, and on the nose, by the landmark that is drawn there.
LIDS = {
    "left": [263, 466, 388, 387, 386, 385, 384, 398, 362, 382, 381, 380, 374, 373, 390, 249],
    "right": [33, 246, 161, 160, 159, 158, 157, 173, 133, 155, 154, 153, 145, 144, 163, 7],
}
NOSE = {"prn": [1, 4], "sn": [2], "al_l": [331], "al_r": [102]}
# Where the nose hides it, the tracker guesses.
HIDDEN = {"34": {"al_r"}}
# Lips further apart than this share of the face's height count as open.
OPEN = 0.01


def draw(binary, head, args, view, folder, name):
    picture, outline = folder / f"{name}-{view}.png", folder / f"{name}-{view}.json"
    command = [binary, "still", "--size", f"{SIZE}x{SIZE}", "--tier", "high", "--view", view]
    command += [*args, "--outline", outline, "-o", picture] + (["--head", head] if head else [])
    subprocess.run(list(map(str, command)), check=True)
    return cv2.imread(str(picture)), json.loads(outline.read_text())


def off(points, line):
    """Distance of each point from a closed line."""
    a, b = line, numpy.roll(line, -1, axis=0)
    along = b - a
    length2 = numpy.maximum((along**2).sum(1), 1e-9)
    share = (((points[:, None] - a) * along).sum(2) / length2).clip(0, 1)
    return numpy.linalg.norm(points[:, None] - (a + share[..., None] * along), axis=2).min(1)


def dense(line, points=400):
    """Points at equal steps along a closed line."""
    closed = numpy.vstack([line, line[:1]])
    at = numpy.concatenate([[0], numpy.cumsum(numpy.linalg.norm(numpy.diff(closed, axis=0), axis=1))])
    steps = numpy.linspace(0, at[-1], points, endpoint=False)
    return numpy.stack([numpy.interp(steps, at, closed[:, k]) for k in (0, 1)], axis=1)


def apart(found, drawn):
    """Mean and largest distance between two contours, both ways."""
    both = numpy.concatenate([off(found, drawn), off(dense(drawn), found)])
    return both.mean(), both.max()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", default=ROOT / "target/release/mouthpiece")
    parser.add_argument("--head", help="a head file instead of the built-in head")
    parser.add_argument("--limit", type=float, default=2.0, help="per cent of the face's height (default 2)")
    parser.add_argument("--score", type=float, default=0.93, help="least score of the face detector (default 0.93)")
    parser.add_argument("--keep", type=Path, help="leave pictures there, with both contours drawn in")
    args = parser.parse_args()
    mesh = mediapipe.solutions.face_mesh.FaceMesh(static_image_mode=True, refine_landmarks=True, max_num_faces=1)
    detector = mediapipe.solutions.face_detection.FaceDetection(model_selection=0, min_detection_confidence=0.3)
    failed = []
    print(f"{'still':<17} {'score':<6} {'outer mean':>10} {'max':>6} {'inner mean':>11} {'max':>6} {'lids':>6} {'nose':>6}   (% of face height)")
    with tempfile.TemporaryDirectory() as temporary:
        folder = args.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        for name, controls in EXPRESSIONS.items():
            height = None
            for view in VIEWS:
                still = f"{name} {view}"
                image, outline = draw(args.binary, args.head, controls, view, folder, name)
                rgb = cv2.cvtColor(image, cv2.COLOR_BGR2RGB)
                score = max((d.score[0] for d in detector.process(rgb).detections or []), default=0.0)
                if view != "side" and score < args.score:
                    failed.append(f"{still}: the detector scores {score:.3f}")
                faces = mesh.process(rgb).multi_face_landmarks
                if not faces:
                    print(f"{still:<17} {score:<6.3f} {'none':<6}")
                    if view != "side":
                        failed.append(f"{still}: no face found")
                    continue
                points = numpy.array([[p.x * SIZE, p.y * SIZE] for p in faces[0].landmark])
                height = height or numpy.ptp(points[:468, 1])
                contours = [(numpy.array(outline["lips"][k]), points[n]) for k, n in (("outer", OUTER), ("inner", INNER))]
                row = f"{still:<17} {score:<6.3f}"
                for which, (drawn, found) in zip(("outer", "inner"), contours):
                    if view == "side":
                        continue
                    if which == "inner" and not opened(contours[1][0], height):
                        row += f" {'closed':>11}"
                        continue
                    mean, most = (100 * d / height for d in apart(found, drawn))
                    row += f" {mean:>{10 if which == 'outer' else 11}.2f} {most:>6.2f}"
                    if mean > args.limit:
                        failed.append(f"{still}: {which} contour off by {mean:.2f} %")
                if view != "side":
                    lids = [apart(points[n], around(outline["lids"][side]))[0] for side, n in LIDS.items()]
                    seen = NOSE.keys() - HIDDEN.get(view, set())
                    nose = [numpy.linalg.norm(points[NOSE[k]].mean(0) - outline["landmarks"][k]) for k in seen]
                    for what, distances in (("lids", lids), ("nose", nose)):
                        mean = 100 * numpy.mean(distances) / height
                        row += f" {mean:>6.2f}"
                        if mean > args.limit:
                            failed.append(f"{still}: {what} off by {mean:.2f} %")
                print(row)
                if args.keep:
                    for drawn, found in contours:
                        cv2.polylines(image, [numpy.int32(drawn * 16)], True, (0, 255, 0), 1, cv2.LINE_AA, 4)
                        cv2.polylines(image, [numpy.int32(found * 16)], True, (255, 0, 255), 1, cv2.LINE_AA, 4)
                    cv2.imwrite(str(folder / f"{name}-{view}-contours.png"), image)
    for line in failed:
        print("FAILED", line)
    return 1 if failed else 0


def around(lids):
    """The lids of an eye as one closed line."""
    return numpy.array([*lids["upper"], *reversed(lids["lower"])])


def opened(inner, height):
    """Whether the drawn lips stand apart: the widest gap between upper and lower line."""
    half = len(inner) // 2
    upper, lower = inner[: half + 1], numpy.vstack([inner[:1], inner[:half - 1 : -1]])
    count = min(len(upper), len(lower))
    return (lower[:count, 1] - upper[:count, 1]).max() > OPEN * height


if __name__ == "__main__":
    sys.exit(main())
