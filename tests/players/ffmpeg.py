#!/usr/bin/env python3
"""ffprobe and ffmpeg read MP4 and WebM, and show the frames of the PNG sequence.

usage: ffmpeg.py COMMAND SCENE OUTPUT_FOLDER

Frame count, rate, size, duration and pixel format as asked; decoded frames near ours (PSNR); alpha in WebM; the index of an MP4
first; twice the same bytes.
"""
import json
import math
import re
import shutil
import subprocess
import sys
from pathlib import Path

if shutil.which("ffmpeg") is None or shutil.which("ffprobe") is None:
    print("SKIPPED: ffmpeg is not installed", file=sys.stderr)
    sys.exit(0)

# Odd on purpose.
SIZE = (241, 271)
# Least PSNR of a frame, in dB: chroma is halved, so that edges of saturated colours differ.
LEAST_PSNR, LEAST_ALPHA_PSNR = 30.0, 30.0
BACKGROUND = (0xF0, 0xEC, 0xE0)


def fail(message):
    sys.exit(f"FAILED: {message}")


def run(*words):
    done = subprocess.run([str(w) for w in words], capture_output=True)
    if done.returncode != 0:
        fail(f"{' '.join(map(str, words))}: {done.stderr.decode()}")
    return done.stdout


def render(command, scene, output, *more):
    run(command, "render", scene, "-o", output, "--size", "{}x{}".format(*SIZE), "--quiet", *more)


def probe(path):
    entries = "stream=width,height,pix_fmt,r_frame_rate,nb_read_frames,codec_name:stream_tags:format=duration:format_tags"
    said = json.loads(run("ffprobe", "-v", "error", "-count_frames", "-show_entries", entries, "-of", "json", path))
    return said["streams"][0], said["format"]


def raw(*source):
    return run("ffmpeg", "-v", "error", *source, "-f", "rawvideo", "-pix_fmt", "rgba", "-")


def psnr(one, other):
    error = sum((a - b) ** 2 for a, b in zip(one, other)) / max(1, len(one))
    return 99.0 if error == 0 else 10 * math.log10(255**2 / error)


def frames_of(data, size):
    length = size[0] * size[1] * 4
    return [data[k : k + length] for k in range(0, len(data), length)]


def main():
    command, scene, out = (Path(word).resolve() for word in sys.argv[1:4])
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)

    for fps, rate in (("24", "24/1"), ("23.976", "24000/1001")):
        more = ("--fps", fps, "--background", "#{:02x}{:02x}{:02x}".format(*BACKGROUND))
        render(command, scene, out / "opaque", *more)
        count = len(list((out / "opaque").glob("*.png")))
        path, again = out / f"{fps}.mp4", out / "again.mp4"
        render(command, scene, path, *more)
        render(command, scene, again, "--threads", "1", *more)
        check(path, again, count, rate, (SIZE[0] + 1, SIZE[1] + 1), "yuv420p", [], out / "opaque")
        data = path.read_bytes()
        if not 0 < data.find(b"moov") < data.find(b"mdat"):
            fail(f"{path}: the index does not come first")
        if re.search(rb"x264 - core|Lav[cf]\d", data):
            fail(f"{path}: names its encoder's version")
        shutil.rmtree(out / "opaque")

    more = ("--background", "transparent")
    render(command, scene, out / "clear", *more)
    count = len(list((out / "clear").glob("*.png")))
    path, again = out / "clear.webm", out / "again.webm"
    render(command, scene, path, *more)
    render(command, scene, again, *more)
    # Only libvpx decodes the alpha.
    check(path, again, count, None, SIZE, None, ["-c:v", "libvpx-vp9"], out / "clear")
    print("a transparent MP4 is told of:")
    said = subprocess.run(
        [str(command), "render", str(scene), "-o", str(out / "white.mp4"), "--size", "160x120", "--frames", "1-3", *more],
        capture_output=True,
        text=True,
    )
    note = [line for line in said.stderr.splitlines() if "transparency" in line]
    print(f"  {note[0]}" if note else fail("nothing is said"))


def check(path, again, count, rate, size, pixel_format, decoder, folder):
    if path.read_bytes() != again.read_bytes():
        fail(f"{path}: a second run has other bytes")
    stream, container = probe(path)
    if int(stream["nb_read_frames"]) != count:
        fail(f"{path}: {stream['nb_read_frames']} frames, not {count}")
    if (stream["width"], stream["height"]) != size:
        fail(f"{path}: {stream['width']} x {stream['height']}, not {size}")
    if rate and stream["r_frame_rate"] != rate:
        fail(f"{path}: {stream['r_frame_rate']} frames a second, not {rate}")
    if pixel_format and stream["pix_fmt"] != pixel_format:
        fail(f"{path}: {stream['pix_fmt']}, not {pixel_format}")
    seconds = count / eval(stream["r_frame_rate"])  # noqa: S307: a fraction that ffprobe wrote
    if abs(float(container["duration"]) - seconds) > 0.5 / 24:
        fail(f"{path}: lasts {container['duration']} s, not {seconds:.3f} s")
    decoded = frames_of(raw(*decoder, "-i", path), size)
    pictures = sorted(folder.glob("*.png"))
    colour, alpha = [], []
    for number in {0, count // 3, count // 2, count - 1}:
        own = raw("-i", pictures[number])
        shown = decoded[number]
        # Rows without the padding.
        rows = [shown[y * size[0] * 4 :][: SIZE[0] * 4] for y in range(SIZE[1])]
        shown = b"".join(rows)
        if decoder:
            alpha.append(psnr(shown[3::4], own[3::4]))
            # Before white, as a player shows it.
            shown, own = over_white(shown), over_white(own)
        else:
            shown = bytes(v for k, v in enumerate(shown) if k % 4 != 3)
            own = bytes(v for k, v in enumerate(own) if k % 4 != 3)
        colour.append(psnr(shown, own))
    if min(colour) < LEAST_PSNR or (alpha and min(alpha) < LEAST_ALPHA_PSNR):
        fail(f"{path}: PSNR {min(colour):.1f} dB, alpha {min(alpha, default=99):.1f} dB")
    if alpha and not any(v < 255 for v in decoded[0][3::4]):
        fail(f"{path}: no clear pixel")
    print(
        f"{path.name}: {stream['codec_name']}, {count} frames at {stream['r_frame_rate']}, {size[0]} x {size[1]}, "
        f"{float(container['duration']):.3f} s, {path.stat().st_size} bytes, PSNR at least {min(colour):.1f} dB"
        + (f", of alpha {min(alpha):.1f} dB" if alpha else f", {stream['pix_fmt']}")
    )


def over_white(data):
    shown = bytearray()
    for k in range(0, len(data), 4):
        a = data[k + 3]
        shown += bytes((data[k + c] * a + 255 * (255 - a) + 127) // 255 for c in range(3))
    return bytes(shown)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main()
