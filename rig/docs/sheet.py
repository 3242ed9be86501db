#!/usr/bin/env python3
"""Draws the sheets of pictures beside this file (see README.md). Needs Pillow.

    sheet.py [reference]     reference.png: the reference head, six faces from three sides
    sheet.py expressions     expressions.png: every expression of the library, from the front
    sheet.py phones          phones.png: every phone of TIMIT held, the mouth from the front and from the side

Options behind that are handed to `mouthpiece still`, as `--head OTHER.glb`.
"""

import io
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

HERE = Path(__file__).resolve().parent
BINARY = HERE.parent.parent / "target/release/mouthpiece"
LIBRARY = HERE.parent / "data/expressions.json"
WIDTH, HEIGHT = 240, 300
# The pictures are drawn larger than they are shown, for fine hair.
SCALE = 2
VIEWS = ["front", "34", "side"]
BYTES_MAX = 280_000
# Of the sheet of expressions: faces a row, and what of the picture is shown, since hair and shirt say nothing.
COLUMNS = 7
FACE = (36, 70, 204, 274)
# The same of the sheet of phones: the mouth from the front and from the side.
PHONES_A_ROW = 6
MOUTHS = {"front": (72, 182, 168, 262), "side": (6, 176, 86, 256)}
# TIMIT's phones by class, as its documentation has them; what is silent has one face.
PHONES = """iy ih eh ey ae aa aw ay ah ao oy ow uh uw ux er ax ix axr ax-h l r w y hh hv el
m em n en eng ng nx b d g p t k dx q bcl dcl gcl pcl tcl kcl jh ch s sh z zh f v th dh h#""".split()


def still(args, options):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "still.png"
        size = f"{WIDTH * SCALE}x{HEIGHT * SCALE}"
        command = [BINARY, "still", "--size", size, "--tier", "high", *args, *options, "-o", path]
        subprocess.run(list(map(str, command)), check=True)
        return Image.open(path).convert("RGB").resize((WIDTH, HEIGHT), Image.LANCZOS)


def reference(options):
    faces = json.loads((HERE / "faces.json").read_text())
    sheet = Image.new("RGB", (WIDTH * len(faces), HEIGHT * len(VIEWS)))
    for column, args in enumerate(faces.values()):
        for row, view in enumerate(VIEWS):
            sheet.paste(still(["--view", view, *args], options), (column * WIDTH, row * HEIGHT))
    return sheet


def expressions(options):
    names = list(json.loads(LIBRARY.read_text())["expressions"])
    left, top, right, bottom = FACE
    width, height = right - left, bottom - top
    sheet = Image.new("RGB", (width * COLUMNS, height * -(-len(names) // COLUMNS)))
    draw = ImageDraw.Draw(sheet)
    for i, name in enumerate(names):
        x, y = i % COLUMNS * width, i // COLUMNS * height
        sheet.paste(still(["--expression", name], options).crop(FACE), (x, y))
        draw.text((x + 5, y + 3), name, fill="white", font=ImageFont.load_default(12))
    return sheet


def phones(options):
    boxes = MOUTHS.values()
    width = sum(right - left for left, _, right, _ in boxes)
    height = max(bottom - top for _, top, _, bottom in boxes)
    sheet = Image.new("RGB", (width * PHONES_A_ROW, height * -(-len(PHONES) // PHONES_A_ROW)))
    draw = ImageDraw.Draw(sheet)
    for i, phone in enumerate(PHONES):
        x, y = i % PHONES_A_ROW * width, i // PHONES_A_ROW * height
        left = x
        for view, box in MOUTHS.items():
            sheet.paste(still(["--view", view, "--phone", phone], options).crop(box), (left, y))
            left += box[2] - box[0]
        draw.text((x + 5, y + 3), phone, fill="white", font=ImageFont.load_default(13))
    return sheet


def save(sheet, path):
    # As many colours as the size allows.
    for colours in (256, 192, 128, 96, 64):
        packed = io.BytesIO()
        sheet.quantize(colours, kmeans=2, dither=Image.Dither.NONE).save(packed, "PNG", optimize=True)
        if packed.tell() <= BYTES_MAX:
            break
    path.write_bytes(packed.getvalue())
    print(f"{path}: {colours} colours, {packed.tell()} bytes")


def main():
    sheets = {"reference": reference, "expressions": expressions, "phones": phones}
    words = sys.argv[1:]
    name = words.pop(0) if words and words[0] in sheets else "reference"
    save(sheets[name](words), HERE / f"{name}.png")


if __name__ == "__main__":
    main()
