#!/usr/bin/env python3
"""Draws reference.png: the reference head, six expressions from three sides (see README.md). Needs Pillow.

Options given here are handed to `mouthpiece still`, as `--head OTHER.glb`.
"""

import io
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

HERE = Path(__file__).resolve().parent
BINARY = HERE.parent.parent / "target/release/mouthpiece"
WIDTH, HEIGHT = 240, 300
# The pictures are drawn larger than they are shown, for fine hair.
SCALE = 2
VIEWS = ["front", "34", "side"]
BYTES_MAX = 250_000


def still(args, view):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "still.png"
        size = f"{WIDTH * SCALE}x{HEIGHT * SCALE}"
        command = [BINARY, "still", "--size", size, "--tier", "high", "--view", view, *args, *sys.argv[1:], "-o", path]
        subprocess.run(list(map(str, command)), check=True)
        return Image.open(path).convert("RGB").resize((WIDTH, HEIGHT), Image.LANCZOS)


def main():
    expressions = json.loads((HERE / "expressions.json").read_text())
    sheet = Image.new("RGB", (WIDTH * len(expressions), HEIGHT * len(VIEWS)))
    for column, args in enumerate(expressions.values()):
        for row, view in enumerate(VIEWS):
            sheet.paste(still(args, view), (column * WIDTH, row * HEIGHT))
    # As many colours as the size allows.
    for colours in (256, 192, 128, 96, 64):
        packed = io.BytesIO()
        sheet.quantize(colours, dither=Image.Dither.NONE).save(packed, "PNG", optimize=True)
        if packed.tell() <= BYTES_MAX:
            break
    (HERE / "reference.png").write_bytes(packed.getvalue())
    print(f"{HERE / 'reference.png'}: {colours} colours, {packed.tell()} bytes")


if __name__ == "__main__":
    main()
