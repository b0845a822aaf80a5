#!/usr/bin/env bash
# `mobil crowd` under mpirun: equal hash and picture from one, two and three ranks. A killed rank, or one that hangs,
# ends the run, and --resume continues to the hash of an undisturbed run. Status 77 without MPI.
# Usage: mpi_test.sh BUILD_FOLDER SOURCE_FOLDER MOBIL
set -euo pipefail
mobil=$(realpath "$3")
command -v mpirun >/dev/null || { echo "no mpirun here (Debian: openmpi-bin)"; exit 77; }
scratch=$(mktemp -d)
trap 'kill "${running:-}" 2>/dev/null || true; rm -rf "$scratch"' EXIT
cd "$scratch"
# Two jobs that start simultaneously would compete for one folder. Ranks can outnumber processors, and root can run
# them.
export TMPDIR=$scratch OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none
mpirun -n 2 true >out 2>&1 || { cat out; echo "mpirun cannot start processes here"; exit 77; }
mpirun -n 1 "$mobil" crowd --people 20 --effects none --seconds 0.1 >out 2>&1 || {
  grep -q 'built without MPI' out && { echo "this mobil was built without MPI"; exit 77; }
  cat out
  exit 1
}

crowd=(crowd --people 1000 --shards 12 --effects none --churn 60 --seed 3)
# hash_of: returns the last printed hash
hash_of() { grep '^state hash' | tail -n 1; }
same() {  # same WHAT ONE OTHER
  [ -n "$2" ] && [ "$2" = "$3" ] && return
  echo "$1: '$3' instead of '$2'" >&2
  exit 1
}

alone=$("$mobil" "${crowd[@]}" --seconds 60 | hash_of)
# alone_until "state hash … at tick N": the hash of an undisturbed run at this tick. If this script is delayed, a run
# has passed 60 s before it is killed, and resumes only from there.
alone_until() {
  local tick=${1##* } usual=${alone##* }
  if [ "$tick" = "$usual" ]; then
    echo "$alone"
  else
    "$mobil" "${crowd[@]}" --seconds $((60 + (tick - usual) / 60)) | hash_of
  fi
}
for ranks in 2 3; do
  same "$ranks ranks" "$alone" "$(mpirun -n $ranks "$mobil" "${crowd[@]}" --seconds 60 --balance-every 1s | hash_of)"
done

picture=(crowd --people 40 --shards 4 --effects none --seconds 0.5 --capture)
"$mobil" "${picture[@]}" one.png >/dev/null
mpirun -n 2 "$mobil" "${picture[@]}" two.png >/dev/null
cmp one.png two.png

# Disturbs the run as soon as the second snapshot exists.
rank() {  # rank N: its process
  local status
  for status in /proc/[0-9]*/status; do
    if grep -q "^PPid:[[:space:]]*$running$" "$status" 2>/dev/null &&
      tr '\0' '\n' <"${status%status}environ" 2>/dev/null | grep -q "^OMPI_COMM_WORLD_RANK=$1$"; then
      status=${status#/proc/}
      echo "${status%/status}"
    fi
  done
}
snapshots() {  # snapshots FOLDER COUNT: waits for so many snapshots
  local _
  for _ in $(seq 1500); do
    [ "$(find "$1" -name index 2>/dev/null | wc -l)" -lt "$2" ] || return 0
    sleep 0.01
  done
  cat "$1.out"
  echo "no snapshots appear" >&2
  exit 1
}
begin() {  # begin FOLDER RANK: sets `process` to the process of that rank
  rm -rf "$1"
  mpirun -n 3 "$mobil" "${crowd[@]}" --seconds 3600 --save "$1" --save-every 2s --silence 2s >"$1.out" 2>&1 &
  running=$!
  snapshots "$1" 1
  process=$(rank "$2")
  snapshots "$1" 2
}
for victim in 0 2; do
  begin killed $victim
  [ $victim = 0 ] || sleep 0.0$((RANDOM % 90 + 10))  # at any moment, possibly in a snapshot
  kill -9 "$process"
  started=$SECONDS
  ! wait "$running" || { echo "a run without rank $victim ends well" >&2; exit 1; }
  [ $((SECONDS - started)) -le 10 ] || { echo "a run without rank $victim goes on" >&2; exit 1; }
  grep -q "process rank $victim " killed.out
  ranks=$((victim / 2 + 1))
  went_on=$(mpirun -n $ranks "$mobil" "${crowd[@]}" --seconds 60 --resume killed | hash_of)
  same "after rank $victim was killed, on $ranks ranks" "$(alone_until "$went_on")" "$went_on"
done

begin hung 1
kill -STOP "$process"
! wait "$running" || { echo "a run with a rank that hangs ends well" >&2; exit 1; }
kill -9 "$process" 2>/dev/null || true
grep -q '^cluster: rank 1 has been silent for .* s, since about tick .*--resume goes on' hung.out || {
  cat hung.out
  exit 1
}

# Invalid requests are refused in one line of the first rank, with status 2.
if mpirun -n 2 "$mobil" crowd --people 20 --effects none --resume nowhere >out 2>&1; then exit 1; fi
[ "$(grep -c '^mobil crowd:' out)" = 1 ]
grep -q 'nowhere: no snapshot is there' out
if mpirun -n 2 "$mobil" crowd --people 20 --effects none --shards 1 >out 2>&1; then exit 1; fi
grep -q '1 shards are too few for 2 ranks' out
if mpirun -n 2 "$mobil" crowd --people many >out 2>&1; then exit 1; fi
[ "$(grep -c '^mobil crowd:' out)" = 1 ]
