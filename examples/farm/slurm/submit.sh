#!/usr/bin/env bash
# Submits a bake as a job array of SHARDS tasks (by default 4), and a merge that begins when all of them have ended well. Prints
# the numbers of both jobs. Needs Slurm's client programs (on Debian: apt-get install slurm-client).
#   LUTHIER_CACHE=/shared/luthier SHARDS=16 ./submit.sh OUT MATERIALS... [OPTIONS OF BAKE]
set -euo pipefail

out=${1:?names no folder to write to}
shift
here=$(cd "$(dirname "$0")" && pwd)
shards=${SHARDS:-4}

bake=$(SHARDS=$shards sbatch --parsable --array="1-$shards" "$here/bake.sbatch" "$@")
# A task that fails for good cancels the merge. With afterany, the merge would compute what that task left out.
merge=$(sbatch --parsable --dependency="afterok:$bake" --kill-on-invalid-dep=yes "$here/merge.sbatch" "$@" --out "$out")
echo "$bake $merge"
