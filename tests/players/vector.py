#!/usr/bin/env python3
"""Chromium plays the animated SVG and the Lottie file, and shows the frames of the PNG sequence.

usage: vector.py COMMAND SCENE OUTPUT_FOLDER

Both are played headless, at frames spread over the animation, and compared with the command's own frames; the Lottie file is
checked against a schema, the SVG sequence and a single SVG frame by an XML parser.
"""
import json
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import jsonschema

from compare import compared

HERE = Path(__file__).resolve().parent
SIZE, FPS, FRAMES = (320, 320), 24, 6
# Largest mean difference and difference of 99 of 100 pixels, of 255: two rasterisers, and keys half a pixel off.
MEAN, P99 = 1.5, 96


def run(*words):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"FAILED: {' '.join(map(str, words))}\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def main():
    command, scene, out = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
    out.mkdir(parents=True, exist_ok=True)
    size = "{}x{}".format(*SIZE)
    render = [command, "render", scene, "--size", size, "--fps", str(FPS)]
    run(*render, "-o", out / "frames", "--format", "png", "--quiet")
    count = len(list((out / "frames").glob("*.png")))
    chosen = sorted({1 + k * (count - 1) // (FRAMES - 1) for k in range(FRAMES)})
    for suffix in ("svg", "json"):
        file = out / f"animation.{suffix}"
        told = run(*render, "-o", file)
        if suffix == "json":
            schema = json.loads((HERE / "lottie.schema.json").read_text())
            jsonschema.validate(json.loads(file.read_text()), schema)
        else:
            ElementTree.parse(file)
        run("node", HERE / "chromium.mjs", file, out / suffix, str(FPS), size, *map(str, chosen))
        mean, p99, frames = compared(out / "frames", out / suffix)
        print(f"   {suffix}: {file.stat().st_size / 1024:.0f} KiB, {frames} frames: mean {mean[0]:.3f}, p99 {p99[0]}; {told.strip().splitlines()[-1]}")
        if mean[0] > MEAN or p99[0] > P99:
            sys.exit(f"FAILED: {suffix}: mean {mean} of at most {MEAN}, p99 {p99} of at most {P99}")
    run(*render, "-o", out / "sequence", "--format", "svg-sequence", "--frames", "1-2", "--quiet")
    for file in (out / "sequence").glob("*.svg"):
        ElementTree.parse(file)


main()
