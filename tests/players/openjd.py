#!/usr/bin/env python3
"""The farm's job template and Slurm script do what their page says.

usage: openjd.py COMMAND SCENE OUTPUT_FOLDER

`openjd check` accepts the template, `openjd run` renders a chunk and then all chunks, the Slurm script renders each task's
share; every frame has the bytes of a whole run.
"""
import filecmp
import os
import shutil
import subprocess
import sys
from pathlib import Path

FRAMES, SIZE = 10, "160x120"
ROOT = Path(__file__).resolve().parents[2]
TEMPLATE = ROOT / "farm" / "inbetween.template.yaml"


def run(*words, **options):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, **options)
    if done.returncode != 0:
        sys.exit(f"FAILED: {' '.join(map(str, words))}\n{done.stdout}{done.stderr}")
    return done.stdout


def same(folder, whole, numbers):
    names = sorted(p.name for p in folder.iterdir())
    wanted = sorted(p.name for p in whole.iterdir() if int(p.name.split(".")[-2]) in numbers)
    if names != wanted:
        sys.exit(f"FAILED: {folder} has {names}, not {wanted}")
    differing = [n for n in names if not filecmp.cmp(folder / n, whole / n, shallow=False)]
    if differing:
        sys.exit(f"FAILED: {folder}: {differing} differ from a whole run")


def main():
    command, scene, out = (Path(word).resolve() for word in sys.argv[1:4])
    out.mkdir(parents=True, exist_ok=True)
    for name in ("whole", "chunk", "chunks", "slurm"):
        shutil.rmtree(out / name, ignore_errors=True)
    numbers = set(range(1, FRAMES + 1))
    run(command, "render", scene, "-o", out / "whole", "--frames", f"1-{FRAMES}", "--size", SIZE, "--quiet")
    same(out / "whole", out / "whole", numbers)

    openjd = shutil.which("openjd")
    if openjd is None:
        print("SKIPPED: openjd is not installed (pip install openjd-cli)", file=sys.stderr)
    else:
        print(run(openjd, "check", TEMPLATE).strip())
        job = [openjd, "run", TEMPLATE, "--step", "Render"]
        parameters = [f"Scene={scene}", f"Frames=1-{FRAMES}", "ChunkSize=4", f"Size={SIZE}", f"Inbetween={command}"]
        for parameter in parameters:
            job += ["-p", parameter]
        run(*job, "-p", f"OutputDir={out / 'chunk'}", "-tp", "Frame=5-8")
        same(out / "chunk", out / "whole", {5, 6, 7, 8})
        run(*job, "-p", f"OutputDir={out / 'chunks'}")
        same(out / "chunks", out / "whole", numbers)
        print(f"openjd: one chunk and all chunks of {FRAMES} frames, the same bytes as a whole run")

    tasks = 3
    for task in range(tasks):
        environment = dict(
            os.environ,
            INBETWEEN=str(command),
            SLURM_ARRAY_TASK_ID=str(task + 1),
            SLURM_ARRAY_TASK_MIN="1",
            SLURM_ARRAY_TASK_COUNT=str(tasks),
            SLURM_CPUS_PER_TASK="2",
        )
        script = ROOT / "farm" / "slurm.sh"
        run("bash", script, scene, out / "slurm", FRAMES, "--size", SIZE, env=environment)
    same(out / "slurm", out / "whole", numbers)
    print(f"slurm.sh: {tasks} tasks, {FRAMES} frames, the same bytes as a whole run")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main()
