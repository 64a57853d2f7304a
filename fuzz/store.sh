#!/usr/bin/env bash
# Stores the fewest of the small inputs in fuzz/corpus that reach what all of these reach, as
# fuzz/corpus.tar.gz: `fuzz/store.sh`, after `fuzz/run.sh`, whose programs it takes.
set -euo pipefail
cd "$(dirname "$0")/.."

programs=fuzz/target/$(rustc -vV | sed -n 's/^host: //p')/release
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export RAYON_NUM_THREADS=1
for target in keyframes paths check draw round_trip; do
  mkdir -p "$work/corpus/$target" "$work/small/$target"
  find "fuzz/corpus/$target" -type f -size -513c -exec cp -t "$work/small/$target" {} +
  "$programs/$target" -set_cover_merge=1 "$work/corpus/$target" "$work/small/$target" \
    >"$work/$target.log" 2>&1 || { tail "$work/$target.log" >&2; exit 1; }
  # Those that take long would fill the minute of a short run.
  # shellcheck disable=SC2046 # names without spaces
  "$programs/$target" $(find "$work/corpus/$target" -type f) 2>&1 |
    awk '/^Executed/ && $4 > 20 { print $2 }' | xargs -r rm
  echo "$target: $(find "$work/corpus/$target" -type f | wc -l) inputs"
done
tar -C "$work" --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner -c corpus | gzip -9n >fuzz/corpus.tar.gz
