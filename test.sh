#!/usr/bin/env bash
# Runs every test. Installs what only the tests need: a software graphics adapter where
# there is none (Debian's mesa-vulkan-drivers), Node.js and the Khronos glTF validator.
# Nothing is skipped: what cannot be installed is named, and the run fails.
set -euo pipefail
cd "$(dirname "$0")"

VALIDATOR=gltf-validator@2.0.0-dev.3.10

say() { printf '\n== %s\n' "$*"; }

install() { # PACKAGE... of Debian and its kin
  command -v apt-get >/dev/null || { echo "please install: $*" >&2; exit 1; }
  local as_root=()
  [ "$(id -u)" = 0 ] || as_root=(sudo)
  "${as_root[@]}" apt-get update -qq
  DEBIAN_FRONTEND=noninteractive "${as_root[@]}" apt-get install -y -qq --no-install-recommends "$@" >/dev/null
}

has_adapter() { # a Vulkan driver's manifest, or a system that brings its own adapter
  case "$(uname -s)" in Linux) ;; *) return 0 ;; esac
  compgen -G '/usr/share/vulkan/icd.d/*.json' >/dev/null || compgen -G '/etc/vulkan/icd.d/*.json' >/dev/null
}

has_adapter || { say "installing a software graphics adapter"; install mesa-vulkan-drivers; }
command -v npm >/dev/null || { say "installing Node.js"; install nodejs npm; }
if [ ! -d .tools/node_modules/gltf-validator ]; then
  say "installing $VALIDATOR"
  npm install --prefix .tools --no-audit --no-fund --loglevel=error "$VALIDATOR"
fi

# Keeps Mesa's device selection from printing; makes a missing adapter a failure.
export NODEVICE_SELECT=1 DAT2GLB_REQUIRE_ADAPTER=1

say "cargo test"
cargo test

say "Khronos validator over every fixture's output"
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
dat2glb=target/debug/dat2glb
for scheme in all slerp bessel; do
  mkdir "$out/$scheme"
  "$dat2glb" convert fixtures/keyframes/*.dat -o "$out/$scheme/" --scheme "$scheme" -q
done
mkdir "$out/ends"
for ends in natural clamped repeat closed hold; do
  "$dat2glb" convert fixtures/keyframes/closed-loop.dat -o "$out/ends/$ends.gltf" --ends "$ends" -q
  "$dat2glb" convert fixtures/keyframes/closed-loop.dat -o "$out/ends/$ends.glb" --ends "$ends" --no-key-times -q
done
mkdir "$out/paths"
for path in fixtures/paths/*.dat; do
  "$dat2glb" convert "$path" -o "$out/paths/" -q
done
"$dat2glb" convert fixtures/keyframes/chain-even.dat --path fixtures/paths/flight.dat -o "$out/along.gltf" -q
for wrap in "" --no-wrap; do
  "$dat2glb" convert fixtures/paths/flight.dat -o "$out/scenery$wrap.glb" -q --repeat 3 $wrap --export-path \
    --camera fixtures/paths/camera.dat,look-at=root --camera follow --camera keys \
    --camera fixtures/paths/bezier.dat,rotation=fixtures/paths/euler-bezier.dat
done
for interpolation in cubicspline step; do
  mkdir "$out/$interpolation"
  "$dat2glb" convert fixtures/keyframes/*.dat fixtures/paths/{flight,bezier,polyline,loop}.dat \
    -o "$out/$interpolation/" --interpolation "$interpolation" -q
done
mkdir "$out/reduced"
for tolerance in 0.1 0.001; do
  "$dat2glb" reduce "$out/all/chain-even.glb" -o "$out/reduced/chain-$tolerance.glb" --tolerance "$tolerance" -q
  "$dat2glb" reduce "$out/along.gltf" -o "$out/reduced/along-$tolerance.gltf" --tolerance "$tolerance" \
    --tolerance-distance "$tolerance" -q
  "$dat2glb" reduce "$out/scenery.glb" -o "$out/reduced/scenery-$tolerance.glb" --tolerance "$tolerance" -q
done
for kind in chain body flight bezier camera euler; do
  "$dat2glb" example "$kind" | "$dat2glb" convert - -o "$out/$kind.glb" -q
done
mkdir "$out/hostile"
hostile() { # NAME OPTION...; an input on standard input
  "$dat2glb" convert - -o "$out/hostile/$1.glb" -q "${@:2}"
}
printf '# 1 2\n0 1 0 0 0\n1 -1 0 0 0\n2 1 0 0 0\n' | hostile identical
printf '# 1 2\n0 1 0 0 0\n1 0 1 0 0\n2 0 0 1 0\n3 0 0 0 1\n' | hostile half-turns
printf '# 1 2\n0 1 0 0 0\n1 1 8.7e-12 0 0\n2 1 0 8.7e-12 0\n' | hostile billionth-of-a-degree
printf '# 1 2\n0 1 0 0 0\n1e-6 0.8 0.6 0 0\n2e-6 0.6 0.8 0 0\n' | hostile microseconds
printf '# 1 2\n0 1 0 0 0\n31557600 0.8 0.6 0 0\n63115200 0.6 0.8 0 0\n' | hostile years --fps 1/864000
printf '# 1 2\n0 1e-310 0 0 0\n1 8e299 6e299 0 0\n2 1 5e-324 0 0\n' | hostile lengths
printf '# catmull-rom 3\n1 2 3\n1 2 3\n1 2 3\n' | hostile still
printf '# catmull-rom 3\n1e30 0 0\n0 1e-30 0\n-1e30 0 1e-310\n' | hostile huge
node tests/validator/validate.mjs .tools/node_modules "$out"
