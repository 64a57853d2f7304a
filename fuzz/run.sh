#!/usr/bin/env bash
# Runs every fuzz target: `fuzz/run.sh [SECONDS]`, 60 each without a number, two at a time.
# Starts from the seeds, the fixtures and the stored corpus (fuzz/store.sh), keeps new inputs in
# fuzz/corpus, and fails on a finding, whose input it leaves in fuzz/artifacts and names. Installs
# cargo-fuzz if it is missing; needs a C++ compiler, for libFuzzer.
set -euo pipefail
cd "$(dirname "$0")/.."

seconds=${1:-60}
targets=(keyframes paths check draw round_trip)
# Coverage needs flags of the nightly compiler; a stable one takes them when told to.
if rustup toolchain list 2>/dev/null | grep -q '^nightly'; then
  toolchain=(+nightly)
else
  toolchain=() && export RUSTC_BOOTSTRAP=1
fi
command -v cargo-fuzz >/dev/null || cargo install --quiet --locked cargo-fuzz

# The library has no unsafe code that a sanitizer could watch. Threads of its own would hide
# which input took the time.
cargo "${toolchain[@]}" fuzz build --sanitizer none --codegen-units 16
export RAYON_NUM_THREADS=1
# Much more than a second: the checks of a debug build, coverage, and other work on the machine, make
# what takes 1 s last longer.
limits=(-timeout=60 -rss_limit_mb=1024 -max_len=65536 -print_final_stats=1)

[ -d fuzz/corpus ] || tar -C fuzz -xzf fuzz/corpus.tar.gz

seeds() { # TARGET: folders that are read, not written
  case "$1" in
    keyframes) echo fixtures/keyframes fixtures/refused ;;
    paths) echo fixtures/paths fixtures/keyframes ;;
    check | draw) echo fuzz/seeds/glb fuzz/seeds/draw ;;
  esac
}

one() { # TARGET
  mkdir -p "fuzz/corpus/$1" "fuzz/artifacts/$1"
  local program=fuzz/target/$(rustc -vV | sed -n 's/^host: //p')/release/$1 found=0
  # shellcheck disable=SC2046 # folders without spaces
  "$program" "fuzz/corpus/$1" $(seeds "$1") -artifact_prefix="fuzz/artifacts/$1/" \
    -max_total_time="$seconds" "${limits[@]}" >"fuzz/artifacts/$1.log" 2>&1 || found=$?
  if [ "$found" != 0 ]; then
    tail -40 "fuzz/artifacts/$1.log" >&2
    echo "fuzzing $1: found something; its input is in fuzz/artifacts/$1/" >&2
    return 1
  fi
  local runs
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "fuzz/artifacts/$1.log")
  echo "fuzzing $1: $runs runs, nothing found"
}

failed=0 running=()
for target in "${targets[@]}"; do
  one "$target" & running+=($!)
  if [ "${#running[@]}" = 2 ]; then
    for job in "${running[@]}"; do wait "$job" || failed=1; done
    running=()
  fi
done
for job in "${running[@]}"; do wait "$job" || failed=1; done
exit "$failed"
