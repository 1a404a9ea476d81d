#!/usr/bin/env python3
"""Pillow reads GIF, APNG, WebP and sprite sheets, and shows the frames of the PNG sequence.

usage: pillow.py COMMAND SCENE OUTPUT_FOLDER

Exact for APNG, WebP and sheets; for GIF the mean over neighbourhoods of 8 x 8 pixels, which dithering keeps, and no
flicker: a pixel that is equal in two frames of the sequence is equal in those of the GIF.
"""
import json
import shutil
import subprocess
import sys
from pathlib import Path

try:
    from PIL import Image, ImageChops, ImageSequence, ImageStat
except ImportError:
    print("SKIPPED: Pillow is not installed (pip install pillow)", file=sys.stderr)
    sys.exit(0)

SIZE, FPS = (241, 271), 24
# Largest mean difference of a GIF's neighbourhoods of 8 x 8 pixels, and the mean of all, of 255.
GIF_MEAN, GIF_WORST = 2.0, 40.0


def fail(message):
    sys.exit(f"FAILED: {message}")


def highest(difference):
    return max(high for _, high in (band.getextrema() for band in difference.split()))


def largest(difference):
    """The largest difference of each pixel's channels."""
    first, *others = difference.split()
    for band in others:
        first = ImageChops.lighter(first, band)
    return first


def worst_difference(one, other):
    return highest(ImageChops.difference(one, other))


def render(command, scene, output, *more):
    words = [command, "render", scene, "-o", output, "--size", "{}x{}".format(*SIZE), "--fps", str(FPS), "--quiet", *more]
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True)
    if done.returncode != 0:
        fail(f"{words}: {done.stderr}")


def animation(path):
    """Frames as RGBA, durations in milliseconds, number of repetitions (0: for ever)."""
    image = Image.open(path)
    frames, durations = [], []
    for frame in ImageSequence.Iterator(image):
        frame.load()
        durations.append(frame.info.get("duration", 0))
        frames.append(frame.convert("RGBA"))
    # A GIF without the extension plays once, and Pillow says nothing.
    return frames, durations, image.info.get("loop", 1 if path.suffix == ".gif" else None)


def without_colour_of_clear(image):
    """A clear pixel's colour is nobody's."""
    clear = Image.new("RGBA", image.size)
    clear.paste(image, mask=image.getchannel("A").point(lambda a: 255 if a else 0))
    return clear


def check_animation(path, sequence, loops):
    frames, durations, loop = animation(path)
    if len(frames) != len(sequence) or frames[0].size != SIZE:
        fail(f"{path}: {len(frames)} frames of {frames[0].size}, not {len(sequence)} of {SIZE}")
    wanted = 1000 * len(sequence) / FPS
    if abs(sum(durations) - wanted) > (10 if path.suffix == ".gif" else 1.5):
        fail(f"{path}: lasts {sum(durations)} ms, not {wanted:.1f} ms")
    if loop != (0 if loops else 1):
        fail(f"{path}: loop count {loop}, the scene {'loops' if loops else 'plays once'}")
    if path.suffix != ".gif":
        for number, (frame, own) in enumerate(zip(frames, sequence), 1):
            if worst_difference(without_colour_of_clear(frame), without_colour_of_clear(own)) > 0:
                fail(f"{path}: frame {number} differs from its PNG file")
        said = "pixels exact"
    else:
        said = check_gif(path, frames, sequence)
    size = path.stat().st_size
    print(f"{path.name}: {len(frames)} frames, {sum(durations):.0f} ms (wanted {wanted:.0f}), loop {loop}, {size} bytes; {said}")


def check_gif(path, frames, sequence):
    worst, total = 0.0, 0.0
    for number, (frame, own) in enumerate(zip(frames, sequence), 1):
        solid = own.getchannel("A").point(lambda a: 255 if a >= 128 else 0)
        if worst_difference(frame.getchannel("A"), solid) > 0:
            fail(f"{path}: frame {number}: the clear pixels are not those with less than half the alpha")
        # Only what is drawn in both, before grey.
        boards = []
        for picture in (frame, own):
            board = Image.new("RGB", SIZE, (128, 128, 128))
            board.paste(picture.convert("RGB"), mask=solid)
            boards.append(board.reduce(8))
        difference = ImageChops.difference(*boards)
        worst = max(worst, highest(difference))
        total += sum(ImageStat.Stat(difference).mean) / 3 / len(frames)
    if total > GIF_MEAN or worst > GIF_WORST:
        fail(f"{path}: neighbourhoods differ by {total:.2f} in the mean, {worst} at worst")
    flicker = 0
    for k in range(1, len(frames)):
        mask = largest(ImageChops.difference(sequence[k - 1], sequence[k])).point(lambda d: 0 if d else 255)
        if mask.getbbox() is None or sequence[k - 1].getchannel("A").getextrema()[0] < 255:
            continue
        changed = largest(ImageChops.difference(frames[k - 1], frames[k]))
        flicker += sum(ImageChops.multiply(mask, changed.point(lambda d: 255 if d else 0)).histogram()[1:])
    if flicker:
        fail(f"{path}: {flicker} pixels flicker")
    return f"8 x 8 neighbourhoods differ by {total:.2f} in the mean, {worst:.0f} at worst, of 255; nothing at rest flickers"


def check_sheet(path, sequence):
    table = json.loads(path.with_suffix(".json").read_text())
    sheet = Image.open(path).convert("RGBA")
    if [table["meta"]["size"]["w"], table["meta"]["size"]["h"]] != list(sheet.size) or table["meta"]["image"] != path.name:
        fail(f"{path}: the table describes another sheet")
    if len(table["frames"]) != len(sequence):
        fail(f"{path}: {len(table['frames'])} frames, not {len(sequence)}")
    for entry, own in zip(table["frames"], sequence):
        place, source = entry["frame"], entry["spriteSourceSize"]
        cut = sheet.crop((place["x"], place["y"], place["x"] + place["w"], place["y"] + place["h"]))
        whole = Image.new("RGBA", (entry["sourceSize"]["w"], entry["sourceSize"]["h"]))
        whole.paste(cut, (source["x"], source["y"]))
        if whole.size != own.size or worst_difference(whole, own) > 0:
            fail(f"{path}: {entry['filename']} differs from its PNG file")
    duration = sum(entry["duration"] for entry in table["frames"])
    print(f"{path.name}: {len(sequence)} frames on {sheet.size[0]} x {sheet.size[1]} pixels, {duration} ms; pixels exact")


def main():
    command, scene, out = (Path(word).resolve() for word in sys.argv[1:4])
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    loops = any(line.replace(" ", "").startswith("loop=true") for line in scene.read_text().splitlines())
    for kind, more in (("opaque", ("--background", "#f0ece0")), ("clear", ("--background", "transparent"))):
        folder = out / kind
        render(command, scene, folder, *more)
        sequence = [Image.open(p).convert("RGBA") for p in sorted(folder.glob("*.png"))]
        for suffix in ("gif", "apng", "webp"):
            path = out / f"{kind}.{suffix}"
            render(command, scene, path, *more)
            check_animation(path, sequence, loops)
        path = out / f"{kind}.png"
        render(command, scene, path, "--format", "sprites", *more)
        check_sheet(path, sequence)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main()
