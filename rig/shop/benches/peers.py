#!/usr/bin/env python3
"""Runs peers that PyPI has on the pair that the example `fit_bench` wrote, beside our fit, in turn and on one thread.

    pip install trimesh scipy rtree meshmonk
    cargo build --release -p mouthpiece-shop --example fit_bench
    python3 rig/shop/benches/peers.py target/release/examples/fit_bench [DIR]

Prints for each: seconds (the best of its runs), distances in mm over the face both ways, faces turned over against the
mesh as the landmarks warp it, and how many times our seconds it took. All start from that landmark warp, or are given
the landmarks, whichever they can use; all are measured by the same code, ours included.
"""

import json
import os
import subprocess
import sys
import tempfile
import time

for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[threads] = "1"

import numpy as np  # noqa: E402  (the number of threads is read on import)
import trimesh  # noqa: E402

RUNS = 2
SAMPLES = 5000


def load(path):
    return trimesh.load(path, process=False, maintain_order=True)


def spread(values):
    return {"mean": float(np.mean(values)), "p95": float(np.percentile(values, 95)), "max": float(np.max(values))}


def judge(vertices, template, warped, scan, face, scan_points):
    fitted = trimesh.Trimesh(vertices, template.faces, process=False)
    there = trimesh.proximity.closest_point(scan, vertices[face])[1]
    _, back, where = trimesh.proximity.closest_point(fitted, scan_points)
    back = back[face[template.faces[where]].all(axis=1) & (back < 15.0)]
    a, b = (np.cross(m[1] - m[0], m[2] - m[0]) for m in
            (v[template.faces].swapaxes(0, 1) for v in (vertices, np.asarray(warped.vertices))))
    return {"fit to scan": spread(there), "scan to fit": spread(back), "turned": int(((a * b).sum(1) <= 0).sum())}


def amberg(template, warped, scan, pairs):
    return scaled(trimesh.registration.nricp_amberg, template, warped, scan, pairs)


def sumner(template, warped, scan, pairs):
    return scaled(trimesh.registration.nricp_sumner, template, warped, scan, pairs)


def nearest(mesh, points):
    return np.array([np.argmin(((mesh.vertices - p) ** 2).sum(1)) for p in points])


def scaled(run, template, warped, scan, pairs):
    """trimesh's thresholds are for meshes of about unit size, and its systems for meshes without loose vertices."""
    middle, size = scan.centroid, scan.scale
    unit = lambda v: (np.asarray(v) - middle) / size  # noqa: E731
    used = warped.referenced_vertices
    new = np.cumsum(used) - 1
    mesh = trimesh.Trimesh(unit(warped.vertices)[used], new[warped.faces], process=False)
    target = trimesh.Trimesh(unit(scan.vertices), scan.faces, process=False)
    fitted = np.array(warped.vertices)
    fitted[used] = run(mesh, target, new[nearest(template, pairs[:, :3])], unit(pairs[:, 3:])) * size + middle
    return fitted


def monk(template, warped, scan, pairs):
    import meshmonk

    return np.asarray(meshmonk.pyramid_register(warped, scan).aligned_vertices)


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    folder = sys.argv[2] if len(sys.argv) > 2 else tempfile.mkdtemp()
    run = lambda: json.loads(subprocess.check_output([sys.argv[1], folder, str(3 * RUNS)]))  # noqa: E731
    ours = run()
    template, warped, scan, fitted = (load(f"{folder}/{n}.obj") for n in ("template", "warp", "scan", "fit"))
    pairs = np.loadtxt(f"{folder}/pairs.csv", delimiter=",")
    face = np.loadtxt(f"{folder}/face.csv", delimiter=",")[:, 1] > 0
    scan.remove_unreferenced_vertices()
    points = trimesh.sample.sample_surface_even(scan, SAMPLES, seed=1)[0]
    print(f"template {len(template.faces)} triangles, scan {len(scan.faces)}, {len(pairs)} landmarks")
    rows = []
    for name, peer in (("trimesh nricp_amberg", amberg), ("trimesh nricp_sumner", sumner), ("meshmonk pyramid", monk)):
        try:
            best = np.inf
            for _ in range(RUNS):
                begun = time.perf_counter()
                vertices = peer(template, warped, scan, pairs)
                best = min(best, time.perf_counter() - begun)
            rows.append((name, best, judge(vertices, template, warped, scan, face, points)))
        except Exception as error:  # a peer that does not install or fails is reported, not fatal
            print(f"{name}: {type(error).__name__}: {error}")
    # Ours again, now that the peers have warmed the machine: the better run counts, as for them.
    seconds = min(ours["seconds"]["total"], run()["seconds"]["total"])
    rows.insert(0, ("mouthpiece", seconds, judge(np.asarray(fitted.vertices), template, warped, scan, face, points)))
    for name, taken, found in rows:
        there, back = found["fit to scan"], found["scan to fit"]
        print(
            f"{name:22} {taken:7.3f} s  x{taken / seconds:6.1f}   fit to scan {there['mean']:.3f} / {there['p95']:.3f} /"
            f" {there['max']:.2f}   scan to fit {back['mean']:.3f} / {back['p95']:.3f} / {back['max']:.2f}   turned"
            f" {found['turned']} ({found['turned'] / len(template.faces):.2%})"
        )


if __name__ == "__main__":
    main()
