"""Animated SVG and Lottie as Chromium shows them, against our own frames.

    python3 keyed.py COMMAND SCENE OUT [--size WxH] [--fps N]

Renders the scene as a PNG sequence, as animated SVG and as Lottie JSON, takes pictures of the last two in Chromium (SMIL and
lottie-web) at some frames and compares them with the first. The SVG is read by an XML parser, the Lottie file is held against the
schema of the Lottie Animation Community, if its package is in $PLAYERS/node_modules. Needs node, Chromium, playwright-core and
lottie-web (see chromium.mjs), Pillow, jsonschema. Exits with 1 if a bound is passed.

The bounds: two rasterisers anti-alias edges differently and keys may be half a pixel off, so a picture full of edges differs there;
a part that is missing, late or misplaced changes far more.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import xml.etree.ElementTree

from compare import compared

MEAN_BOUND = 1.0
P99_BOUND = 48
FRAMES = 8


def run(*command):
    subprocess.run([str(part) for part in command], check=True)


def schema_faults(text):
    players = pathlib.Path(os.environ.get("PLAYERS", "."))
    package = players / "node_modules/@lottie-animation-community/lottie-specs"
    path = package / "src/data/lottie.schema.json"
    if not path.is_file():
        print("SKIPPED: the Lottie schema, npm package @lottie-animation-community/lottie-specs, is not installed")
        return []
    import jsonschema

    validator = jsonschema.Draft202012Validator(json.loads(path.read_text()))
    return [f"{list(fault.path)}: {fault.message[:200]}" for fault in validator.iter_errors(json.loads(text))]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command")
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--size", default="480x360")
    parser.add_argument("--fps", default="12")
    arguments = parser.parse_args()
    here = pathlib.Path(__file__).parent
    arguments.out.mkdir(parents=True, exist_ok=True)
    ours = arguments.out / "png"
    render = [arguments.command, "render", arguments.scene, "--size", arguments.size, "--fps", arguments.fps, "-o"]
    run(*render, ours)
    count = len(list(ours.glob("*.png")))
    frames = sorted({1 + k * (count - 1) // (FRAMES - 1) for k in range(FRAMES)})
    failed = False
    for suffix, reader in [("svg", "SMIL"), ("json", "lottie-web")]:
        file = arguments.out / f"animation.{suffix}"
        run(*render, file)
        if suffix == "svg":
            xml.etree.ElementTree.parse(file)
        else:
            for fault in schema_faults(file.read_text())[:5]:
                print(f"lottie schema: {fault}")
                failed = True
        theirs = arguments.out / suffix
        run("node", here / "chromium.mjs", file, theirs, arguments.fps, arguments.size, *frames)
        mean, p99, number = compared(ours, theirs)
        is_good = mean[0] <= MEAN_BOUND and p99[0] <= P99_BOUND
        failed |= not is_good
        print(
            f"{'ok  ' if is_good else 'FAIL'} {reader}: {number} frames, {file.stat().st_size} bytes; mean {mean[0]:.3f} <= "
            f"{MEAN_BOUND} (frame {mean[1]}), p99 {p99[0]} <= {P99_BOUND} (frame {p99[1]})"
        )
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
