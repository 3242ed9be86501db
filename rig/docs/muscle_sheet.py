#!/usr/bin/env python3
"""Draws the pictures of muscles beside this file (see README.md). Needs Pillow.

    muscle_sheet.py [muscles]   muscles.png: what each muscle does to the face, contracted by 0, 1/3, 2/3 and 1
    muscle_sheet.py anatomy     anatomy.png: all muscles on the skull, from the front and half from the side

Options behind that are handed to `mouthpiece still`, as `--head OTHER.glb`.
"""

import json
import sys

from PIL import Image, ImageDraw, ImageFont

import sheet

# What of the picture is shown, in sheet.py's pixels: brows and eyes, nose, mouth and chin, cheek and jaw.
CELL = (120, 90)
UPPER, NOSE, LOWER, CHEEK = (60, 88), (60, 136), (60, 178), (62, 150)
MUSCLES = {
    "orbicularis_oris_superior": ("front", LOWER),
    "orbicularis_oris_inferior": ("front", LOWER),
    "levator_labii_superioris": ("front", LOWER),
    "levator_labii_superioris_alaeque_nasi": ("front", NOSE),
    "levator_anguli_oris": ("front", LOWER),
    "zygomaticus_major": ("front", LOWER),
    "zygomaticus_minor": ("front", LOWER),
    "risorius": ("front", LOWER),
    "buccinator": ("front", LOWER),
    "depressor_anguli_oris": ("front", LOWER),
    "depressor_labii_inferioris": ("front", LOWER),
    "mentalis": ("front", LOWER),
    "frontalis_inner": ("front", UPPER),
    "frontalis_outer": ("front", UPPER),
    "corrugator_supercilii": ("front", UPPER),
    "procerus": ("front", UPPER),
    "depressor_supercilii": ("front", UPPER),
    "orbicularis_oculi_orbital": ("front", UPPER),
    "orbicularis_oculi_palpebral": ("front", UPPER),
    "nasalis": ("front", NOSE),
    "dilator_naris": ("front", NOSE),
    "depressor_septi_nasi": ("front", NOSE),
    "platysma": ("34", LOWER),
    "masseter": ("34", CHEEK),
    "temporalis": ("34", (90, 80)),
}
CONTRACTIONS = [0, 0.33, 0.66, 1]
COLUMNS = 3
LABEL = 14
# Of the plate: views at twice sheet.py's size, what is shown of them, and the paper.
PLATE_VIEWS = ["front", "34"]
PLATE = (84, 92, 404, 532)
PAPER = "#a9b1b0"


def muscles(options):
    at_rest = {view: sheet.still(["--view", view], options) for view in ("front", "34")}
    width, height = CELL[0] * len(CONTRACTIONS), CELL[1] + LABEL
    rows = -(-len(MUSCLES) // COLUMNS)
    picture = Image.new("RGB", (width * COLUMNS, height * rows), "#202224")
    draw = ImageDraw.Draw(picture)
    for i, (name, (view, (left, top))) in enumerate(MUSCLES.items()):
        x, y = i // rows * width, i % rows * height
        draw.text((x + 4, y), name.replace("_", " "), fill="white", font=ImageFont.load_default(11))
        for k, contraction in enumerate(CONTRACTIONS):
            drawn = at_rest[view]
            if contraction > 0:
                controls = json.dumps({name: contraction})
                drawn = sheet.still(["--view", view, "--controls", controls], options)
            cell = drawn.crop((left, top, left + CELL[0], top + CELL[1]))
            picture.paste(cell, (x + k * CELL[0], y + LABEL))
    return picture


def anatomy(options):
    sheet.WIDTH, sheet.HEIGHT = 2 * sheet.WIDTH, 2 * sheet.HEIGHT
    left, top, right, bottom = PLATE
    picture = Image.new("RGB", ((right - left) * len(PLATE_VIEWS), bottom - top))
    for i, view in enumerate(PLATE_VIEWS):
        args = ["--show", "muscles", "--view", view, "--background", PAPER]
        picture.paste(sheet.still(args, options).crop(PLATE), (i * (right - left), 0))
    return picture


def main():
    # Each with the bytes that it may take.
    pictures = {"muscles": (muscles, 400_000), "anatomy": (anatomy, 250_000)}
    words = sys.argv[1:]
    name = words.pop(0) if words and words[0] in pictures else "muscles"
    draw, sheet.BYTES_MAX = pictures[name]
    sheet.save(draw(words), sheet.HERE / f"{name}.png")


if __name__ == "__main__":
    main()
