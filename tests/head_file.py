#!/usr/bin/env python3
"""Opens a head file in other programs and saves it again: what do they keep?

    tests/head_file.py HEAD.glb FOLDER

Writes FOLDER/pygltflib.glb, FOLDER/trimesh.glb and FOLDER/shuffled.glb (by numpy alone: vertices in
another order, every triangle with vertices of its own, long indices, the head moved in its scene),
and prints for each what nodes and attributes are still there. Programs that are not installed are
named and left out. rig/tests/head_file.rs reads what this writes.
"""

import json
import struct
import sys
from pathlib import Path

ATTRIBUTES = {"POSITION", "NORMAL", "TEXCOORD_0", "_SIM", "_OCCLUSION", "_WEIGHT"}
OF_SKIN = {"_CHART", "_REFERENCE", "_VERMILION", "_WET"}


def split(path):
    data = path.read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    return json.loads(data[20 : 20 + length]), data[28 + length :]


def join(path, document, binary):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    head = struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary))
    path.write_bytes(
        head + struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    )


def report(path):
    document, _ = split(path)
    meshes = document["meshes"]
    kept = [n for n in document["nodes"] if "mouthpiece" in (n.get("extras") or {})]
    print(f"{path.name}: {len(document['nodes'])} nodes, {path.stat().st_size} bytes, head's extras on {[n['name'] for n in kept]}")
    for node in document["nodes"]:
        if "mesh" not in node:
            continue
        for primitive in meshes[node["mesh"]]["primitives"]:
            wanted = ATTRIBUTES | (OF_SKIN if node["name"] == "skin" else set())
            lost = wanted - set(primitive["attributes"])
            if lost:
                print(f"  {node['name']}: lost {', '.join(sorted(lost))}")


def with_pygltflib(source, target):
    from pygltflib import GLTF2

    GLTF2().load(str(source)).save(str(target))


def with_trimesh(source, target):
    import trimesh

    trimesh.load(str(source)).export(str(target))


def shuffled(source, target):
    """A program that keeps the meaning and nothing else."""
    import numpy

    random = numpy.random.default_rng(1)
    document, binary = split(source)
    kinds = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
    types = {5123: "<u2", 5125: "<u4", 5126: "<f4"}
    views, accessors, out = [], [], bytearray()

    def values(index):
        accessor = document["accessors"][index]
        view = document["bufferViews"][accessor["bufferView"]]
        width = kinds[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        array = numpy.frombuffer(binary, types[accessor["componentType"]], accessor["count"] * width, start)
        return array.reshape(-1, width)

    def bytes_view(data):
        out.extend(b"\0" * (-len(out) % 4))
        views.append({"buffer": 0, "byteOffset": len(out), "byteLength": len(data)})
        out.extend(data)
        return len(views) - 1

    def accessor(array, component):
        kind = {width: name for name, width in kinds.items()}[array.shape[1]]
        new = {"bufferView": bytes_view(array.tobytes()), "componentType": component, "count": len(array), "type": kind}
        if kind == "VEC3":
            new |= {"min": array.min(0).tolist(), "max": array.max(0).tolist()}
        accessors.append(new)
        return len(accessors) - 1

    for mesh in document["meshes"]:
        for primitive in mesh["primitives"]:
            corners = values(primitive["indices"]).ravel().reshape(-1, 3)
            corners = corners[random.permutation(len(corners))]
            count = document["accessors"][primitive["attributes"]["POSITION"]]["count"]
            unused = numpy.setdiff1d(numpy.arange(count), corners)
            old = numpy.concatenate([corners.ravel(), unused])
            order = random.permutation(len(old))
            place = numpy.empty(len(old), "<u4")
            place[order] = numpy.arange(len(old))
            for name, index in primitive["attributes"].items():
                primitive["attributes"][name] = accessor(values(index)[old[order]].astype("<f4"), 5126)
            primitive["indices"] = accessor(place[: corners.size].reshape(-1, 1), 5125)
    for image in document.get("images", []):
        view = document["bufferViews"][image["bufferView"]]
        start = view.get("byteOffset", 0)
        image["bufferView"] = bytes_view(binary[start : start + view["byteLength"]])
    document |= {"bufferViews": views, "accessors": accessors, "buffers": [{"byteLength": len(out)}]}
    (root,) = document["scenes"][0]["nodes"]
    document["nodes"].append(
        {"name": "stage", "children": [root], "translation": [1, 2, 3], "rotation": [0, 0.6, 0, 0.8], "scale": [2, 2, 2]}
    )
    document["scenes"][0]["nodes"] = [len(document["nodes"]) - 1]
    join(target, document, bytes(out))


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    source, folder = Path(sys.argv[1]), Path(sys.argv[2])
    report(source)
    for name, save in {"pygltflib": with_pygltflib, "trimesh": with_trimesh, "shuffled": shuffled}.items():
        target = folder / f"{name}.glb"
        try:
            save(source, target)
        except ImportError as missing:
            print(f"{name}: left out, {missing.name} is not installed")
            continue
        report(target)


if __name__ == "__main__":
    main()
