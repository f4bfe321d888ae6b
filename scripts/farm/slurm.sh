#!/usr/bin/env bash
# Bakes eight materials on two Slurm nodes: by a job array, by Ninja's graph whose commands Slurm runs, and by a job array during
# which a node is killed. Compares the packages with a bake by one process, byte for byte. Starts munged, slurmctld and two slurmd of
# its own (scripts/farm/cluster.sh) and ends them. Needs Slurm and Ninja; on Debian: apt-get install --no-install-recommends
# slurm-wlm munge ninja-build. Takes four minutes on two cores.
#   scripts/farm/slurm.sh [FOLDER OF MATERIALS [OPTIONS OF BAKE]]
# The environment variable LUTHIER names the program; by default cargo builds it. KEEP=FOLDER keeps logs, stores and packages there.
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/farm/program.sh
source scripts/farm/cluster.sh

shards=4

need '--no-install-recommends slurm-wlm munge ninja-build' \
  munged slurmctld slurmd sbatch srun squeue sinfo scontrol ninja
take_luthier --release

work=$(mktemp -d)
finish() {
  local code=$?
  stop_cluster
  if [ -n "${KEEP-}" ]; then
    mkdir -p "$KEEP" && cp -r "$work/." "$KEEP/"
  elif [ $code != 0 ]; then
    tail -n 20 "$work"/*/*.log 2>/dev/null || true
  fi
  rm -rf "$work"
  exit $code
}
trap finish EXIT
trap 'exit 130' INT TERM HUP
chmod 711 "$work"

if [ $# -gt 0 ]; then
  arguments=("$(realpath "$1")" "${@:2}")
else
  # Fitted lobes are simulated for seconds each, so that there is a middle of a task.
  mkdir "$work/materials"
  cp materials/varnished-brass.toml \
    materials/papers/{acrylic-lacquer,brass-foil,car-paint,ceramic-glaze,chromium-car-paint,copper-patina,red-lacquer}.toml "$work/materials"
  arguments=("$work/materials" --model lobes)
fi

fail() {
  echo "error: $1" >&2
  exit 1
}
# Results of jobs in a store. A file that is written anew gets another inode. Each share searches sizes for itself, at its beginning.
results() { (cd "$1/objects" && find . -type f ! -name '*-search' -printf '%p %i\n' | sort); }
ended() { [ -z "$(squeue -h -j "$1" 2>/dev/null)" ]; }
running_on() { squeue -h -t R -w "$1" -o %i 2>/dev/null; }
# What Slurm says of the tasks of an array: task, state, node, restarts.
tasks() {
  scontrol -o show job "$1" | grep -o 'ArrayTaskId=.*' |
    sed -E 's/^ArrayTaskId=([0-9]+) .*JobState=([A-Z_]+) .*Restarts=([0-9]+) .* NodeList=([^ ]+) .*/\1 \2 \4 \3/' | sort -n
}
# submit NAME: bakes into $work/NAME with a store of that run, by the files that users copy. Sets bake and merge.
submit() {
  mkdir -p "$work/$1/store"
  read -r bake merge < <(cd "$work/$1" && LUTHIER_CACHE=$work/$1/store SHARDS=$shards \
    "$OLDPWD/examples/farm/slurm/submit.sh" "$work/$1/out" "${arguments[@]}" --events)
  echo "submitted: array $bake, merge $merge"
}
# check NAME: all jobs ended well, and the package has the bytes of the bake by one process.
check() {
  wait_for "end of the jobs" 10000 ended "$bake,$merge"
  echo "task state node restarts"
  tasks "$bake"
  [ "$(tasks "$bake" | grep -c COMPLETED)" = $shards ] || fail "Slurm did not complete all $shards tasks"
  scontrol -o show job "$merge" | grep -q 'JobState=COMPLETED' || fail "Slurm did not complete the merge"
  diff -rq "$work/single/out" "$work/$1/out" || fail "the merged package differs from the bake by one process"
  echo "$(find "$work/$1/out" -type f | wc -l) files, equal to those of the bake by one process"
  grep -hE '^(share|merge) ' "$work/$1"/luthier-*.log
}

step "one process"
LUTHIER_CACHE="" "$LUTHIER" bake "${arguments[@]}" --out "$work/single/out" --quiet

step "a controller and two nodes"
start_cluster "$work/cluster"
sinfo -N -o '%N %t %c'

step "a job array on two nodes"
submit undisturbed
check undisturbed
[ "$(tasks "$bake" | cut -d ' ' -f 3 | sort -u | xargs)" = "node1 node2" ] || fail "Slurm did not use both nodes"
echo "$(results "$work/undisturbed/store" | wc -l) results in the store"

step "Ninja's graph, whose commands Slurm runs"
mkdir "$work/ninja"
(
  cd "$work/ninja"
  LAUNCH="srun --ntasks=1 --job-name=luthier-ninja" SHARDS=$shards "$OLDPWD/examples/farm/ninja/configure.sh" "${arguments[@]}"
  ninja -j $shards
)
diff -rq "$work/single/out" "$work/ninja/out" || fail "the package of Ninja differs from the bake by one process"
nodes_of_ninja=$(sed -n 's/.*Name=luthier-ninja JobState=COMPLETED .*NodeList=\([^ ]*\) .*/\1/p' "$work/cluster/completed")
[ "$(wc -l <<<"$nodes_of_ninja")" = 5 ] || fail "Slurm did not complete four shares and a merge for Ninja"
[ "$(sort -u <<<"$nodes_of_ninja" | xargs)" = "node1 node2" ] || fail "Slurm did not use both nodes for Ninja"
echo "Slurm's record of the nodes: $(xargs <<<"$nodes_of_ninja")"

step "a node killed half-way"
submit killed
# A task on node2 that has finished some of its jobs, not all.
half_way() {
  victim=$(running_on node2)
  [ -n "$victim" ] || return 1
  log=$work/killed/luthier-bake-${victim/_/-}.log
  [ "$(grep -c '"event":"finished"' "$log" 2>/dev/null)" -ge 1 ] && ! grep -q 'jobs run' "$log"
}
wait_for "task on node2 that has finished a job" 10000 half_way
kill_node node2
results "$work/killed/store" >"$work/killed/before"
share=${victim#*_}
echo "killed during task $victim, with $(wc -l <"$work/killed/before") results in the store"
check killed
results "$work/killed/store" >"$work/killed/after"
comm -23 "$work/killed/before" "$work/killed/after" | (! grep .) || fail "results that were in the store are gone, or have been written again"
tasks "$bake" | grep -q "^$share COMPLETED node1 1\$" || fail "task $victim was not started again on node1"
grep -q "JobState=NODE_FAIL.*NodeList=node2.*ArrayJobId=$bake ArrayTaskId=$share " "$work/cluster/completed" ||
  fail "Slurm has no record that node2 failed"

# jobs_of NAME: of the killed task's share, the jobs that ran and those that were in the store, in the run of that name.
jobs_of() { sed -nE "s/^share $share of .*: ([0-9]+) jobs run, ([0-9]+) were in the store/\1 \2/p" "$work/$1"/luthier-bake-*-"$share".log; }
read -r all _ < <(jobs_of undisturbed)
read -r run found < <(jobs_of killed)
[ "$found" -ge 1 ] || fail "the second attempt found nothing of the first in the store"
[ $((run + found)) = "$all" ] || fail "the share has $all jobs; the second attempt ran $run and found $found"
echo "of the $all jobs of share $share, the second attempt found $found in the store and ran $run"
