"""How far two folders of pictures differ, frame by frame.

    python3 compare.py OURS THEIRS [--mean BOUND] [--p99 BOUND]

Pictures are paired by the number in their names (NAME.0001.png). Colours are put in front of grey first, so that what cannot
be seen does not count. Differences are of 255, over all pixels and the four channels; p99 is the difference that 99 of 100
pixels stay below, of their channels the worst one.
"""

import argparse
import pathlib
import sys

from PIL import Image, ImageChops


def numbered(folder):
    files = {}
    for path in sorted(pathlib.Path(folder).glob("*.png")):
        number = path.suffixes[-2].lstrip(".") if len(path.suffixes) > 1 else ""
        if number.isdigit():
            files[int(number)] = path
    return files


def over_grey(path):
    picture = Image.open(path).convert("RGBA")
    behind = Image.new("RGBA", picture.size, (128, 128, 128, 255))
    shown = Image.alpha_composite(behind, picture)
    shown.putalpha(picture.getchannel("A"))
    return shown


def difference(a, b):
    """Mean over channels and p99 over pixels of two pictures of one size."""
    a, b = over_grey(a), over_grey(b)
    if a.size != b.size:
        raise ValueError(f"sizes differ: {a.size} and {b.size}")
    channels = ImageChops.difference(a, b).split()
    count = a.size[0] * a.size[1]
    total = sum(value * n for channel in channels for value, n in enumerate(channel.histogram()))
    worst = channels[0]
    for channel in channels[1:]:
        worst = ImageChops.lighter(worst, channel)
    below = 0
    p99 = 255
    for value, n in enumerate(worst.histogram()):
        below += n
        if below >= 0.99 * count:
            p99 = value
            break
    return total / (count * len(channels)), p99


def compared(ours, theirs):
    """The worst mean, the worst p99 and how many frames were compared."""
    ours, theirs = numbered(ours), numbered(theirs)
    if not theirs or set(theirs) - set(ours):
        raise ValueError(f"frames without a counterpart: {sorted(set(theirs) - set(ours)) or 'all'}")
    pairs = [(difference(ours[number], theirs[number]), number) for number in sorted(theirs)]
    mean = max((mean, number) for (mean, _), number in pairs)
    p99 = max((p99, number) for (_, p99), number in pairs)
    return mean, p99, len(pairs)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("ours")
    parser.add_argument("theirs")
    parser.add_argument("--mean", type=float, default=255.0)
    parser.add_argument("--p99", type=int, default=255)
    arguments = parser.parse_args()
    mean, p99, count = compared(arguments.ours, arguments.theirs)
    print(f"{count} frames: mean {mean[0]:.3f} (frame {mean[1]}), p99 {p99[0]} (frame {p99[1]})")
    sys.exit(0 if mean[0] <= arguments.mean and p99[0] <= arguments.p99 else 1)
