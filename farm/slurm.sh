#!/usr/bin/env bash
# One animation rendered by a Slurm job array, a share of the frames for each of its tasks. See README.md beside this file.
#
#   sbatch --array=0-9 farm/slurm.sh SCENE OUTPUT_FOLDER FRAMES [more arguments of `inbetween render`]
#
# FRAMES is how many frames the animation has.
#SBATCH --job-name=inbetween
#SBATCH --array=0-9
#SBATCH --cpus-per-task=4
#SBATCH --mem-per-cpu=1G
#SBATCH --output=inbetween-%A_%a.log
set -euo pipefail

if [ $# -lt 3 ]; then
    echo "usage: sbatch --array=0-9 $0 SCENE OUTPUT_FOLDER FRAMES [arguments]" >&2
    exit 2
fi
scene=$1 output=$2 frames=$3
shift 3

first_task=${SLURM_ARRAY_TASK_MIN:-0}
tasks=${SLURM_ARRAY_TASK_COUNT:-1}
task=$((${SLURM_ARRAY_TASK_ID:?this is a task of a job array, start it by sbatch --array} - first_task))

# Shares that differ by at most one frame, whatever the number of tasks.
first=$((frames * task / tasks + 1))
last=$((frames * (task + 1) / tasks))
if [ "$first" -gt "$last" ]; then
    echo "nothing to do: more tasks than frames"
    exit 0
fi

# A task that is started again leaves out what was completed before.
exec "${INBETWEEN:-inbetween}" render "$scene" --output "$output" --format png --frames "$first-$last" \
    --threads "${SLURM_CPUS_PER_TASK:-1}" --resume "$@"
