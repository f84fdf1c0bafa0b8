#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# From nothing to pictures: installs what is missing, builds Lodestone, makes the sample street,
# builds its levels, renders it with POV-Ray at full detail and approximated, and compares.
set -euo pipefail

usage() {
    cat <<'END'
usage: samples/quickstart.sh [--all] [--no-install]

    --all          also from the middle and near cameras
    --no-install   fail on a missing package instead of installing it with apt

Results: build/samples/report.md and strip_far.png.
END
}

install=1
all=()
for argument in "$@"; do
    case $argument in
    --all) all=(--all) ;;
    --no-install) install=0 ;;
    -h | --help) usage; exit 0 ;;
    *) echo "quickstart.sh: unknown argument '$argument'" >&2; usage >&2; exit 2 ;;
    esac
done

cd "$(dirname "${BASH_SOURCE[0]}")/.."
exec </dev/null
export LC_ALL=C.UTF-8 PYTHONDONTWRITEBYTECODE=1
unset DISPLAY WAYLAND_DISPLAY
out=build/samples
mkdir -p "$out"

say() {
    printf '\n[%3d s] %s\n' "$SECONDS" "$1"
}

# quietly LOG COMMAND...: shows the end of the log when the command fails.
quietly() {
    local log=$1
    shift
    if ! "$@" >"$log" 2>&1; then
        tail -n 40 "$log" >&2
        echo "failed: $* (the whole log: $log)" >&2
        exit 1
    fi
}

if [ "$install" = 1 ]; then
    say "Packages"
    bash samples/install_packages.sh samples/packages.txt
fi

say "Building Lodestone (a minute)"
tests=OFF
if [ -f build/release/CMakeCache.txt ] && grep -q '^LODESTONE_TESTS:BOOL=ON' build/release/CMakeCache.txt; then
    tests=ON # somebody who runs the tests here keeps them
fi
quietly "$out/build.log" cmake --preset release -DLODESTONE_TESTS=$tests
quietly "$out/build.log" cmake --build --preset release
export LODESTONE_STAGE=$PWD/build/release/stage

say "Making the street (samples/street/make_street.py)"
quietly "$out/street.log" env BLENDER_USER_SCRIPTS="$LODESTONE_STAGE" \
    blender -b --factory-startup --python-exit-code 1 --python samples/street/make_street.py \
    -- --out "$out/street.blend" --json "$out/street.json"

say "Building its levels, rendering, comparing"
/usr/bin/python3 samples/street/compare.py --blend "$out/street.blend" --out "$out" "${all[@]}"

say "Done"
sed -n '/^- /p' "$out/report.md"
echo "Look at $out/strip_far.png and $out/report.md"
