#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs what is missing, builds, runs every test. The last line: N passed, N failed, N skipped.
set -euo pipefail

usage() {
    cat <<'END'
usage: tests/run.sh [--fast] [--tidy-all] [--no-install]

    --fast         no Blender, no POV-Ray, no clang-tidy, no sanitizers: under 2 minutes
                   when build/release is up to date
    --tidy-all     clang-tidy on every .cpp file, and looking deeper, not only on those of the last
                   50 commits that there is time for
    --no-install   fail on a missing package instead of installing it with apt

Logs: build/tests/. Exit code 0 when nothing failed and something passed, 1 otherwise, 2 usage.
END
}

fast=0
install=1
tidy_until=600
for argument in "$@"; do
    case $argument in
    --fast) fast=1 ;;
    --tidy-all) export TIDY_ALL=1 ;;
    --no-install) install=0 ;;
    -h | --help) usage; exit 0 ;;
    *) echo "tests/run.sh: unknown argument '$argument'" >&2; usage >&2; exit 2 ;;
    esac
done

cd "$(dirname "${BASH_SOURCE[0]}")/.."
root=$PWD
logs=$root/build/tests
rm -rf "$logs"
mkdir -p "$logs/scratch"
exec </dev/null
export LC_ALL=C.UTF-8 PYTHONDONTWRITEBYTECODE=1
# A library named by hand would hide that an installed add-on does not find its own.
unset DISPLAY WAYLAND_DISPLAY LODESTONE_LIBRARY

# What the tests may rely on. Nothing of the user's Blender is read or written.
export LODESTONE_BUILD=$root/build/release
export LODESTONE_STAGE=$LODESTONE_BUILD/stage
export LODESTONE_COMMAND=$LODESTONE_BUILD/lodestone
export LODESTONE_DATA=${LODESTONE_DATA:-$root/../shared/data}
export LODESTONE_CACHE=$logs/scratch/cache
export BLENDER_USER_CONFIG=$logs/scratch/config
export BLENDER_USER_DATAFILES=$logs/scratch/datafiles

# stop NAME LOG: a step without which no test can run has failed.
stop() {
    tail -n 60 "$2"
    echo "$1 failed; the whole log: ${2#"$root"/}"
    echo "0 passed, 1 failed, 0 skipped"
    exit 1
}

# build PRESET LOG
build() {
    # quickstart.sh leaves the tests out of the same folder; CMake would remember that.
    cmake --preset "$1" -DLODESTONE_TESTS=ON >"$2" 2>&1 && cmake --build --preset "$1" >>"$2" 2>&1
}

results=()

# finish NAME SECONDS: prints the outcome of a step whose result is $logs/NAME.xml.
finish() {
    results+=("$logs/$1.xml")
    local outcome=0 counts
    counts=$(/usr/bin/python3 tests/count.py "$logs/$1.xml") || outcome=$?
    # A step may be empty of passed tests (all skipped); only failures are worth its log.
    printf '%-12s %4d s   %s\n' "$1" "$2" "${counts##*$'\n'}"
    if [ "$outcome" -ne 0 ] && [[ $counts != *" 0 failed, "* ]]; then
        /usr/bin/python3 tests/count.py --why "$logs/$1.xml"
        echo "---- the end of ${logs#"$root"/}/$1.log"
        tail -n 20 "$logs/$1.log" || true
        echo "----"
    fi
}

# step NAME COMMAND...: runs a command that writes $logs/NAME.xml, for 15 minutes at most.
step() {
    local name=$1 start=$SECONDS
    shift
    # The shell in between says in the log, not on the terminal, that a step crashed.
    bash -c '"$@"; exit $?' "$name" timeout --kill-after=10 900 "$@" >"$logs/$name.log" 2>&1 ||
        echo "exit code $?" >>"$logs/$name.log"
    finish "$name" $((SECONDS - start))
}

# python_step NAME FILE...: unittest files under the system's Python; without files, nothing.
python_step() {
    local name=$1
    shift
    if [ $# -gt 0 ]; then
        PYTHONPATH=$LODESTONE_BUILD/python:$root/tests \
            step "$name" /usr/bin/python3 tests/run_python.py --junit "$logs/$name.xml" "$@"
    fi
}

# blender_step NAME FILE...: unittest files inside one Blender that has the staged add-on.
blender_step() {
    local name=$1
    shift
    if [ $# -gt 0 ]; then
        BLENDER_USER_SCRIPTS=$LODESTONE_STAGE step "$name" \
            blender -b --factory-startup --python-exit-code 1 --python tests/run_python.py \
            -- --junit "$logs/$name.xml" "$@"
    fi
}

# Suites of these names start POV-Ray, as the C tests with the label povray do.
starts_povray='PovrayRun*:PovrayRender*'
# Under the sanitizers these take a third of a minute each, for code that others of their suites run.
runs_twice='BuildPlans.AnyChangeOfAMaterialGivesWhatABuildFromScratchGives'
runs_twice+=':SurfaceDetail.APinHoldsForAllChunks:SurfaceDetail.PixelErrorZeroIsTheOriginal'
runs_twice+=':SurfaceDetail.WhatIsDrawnIsAsNearAsItWasAskedFor:SurfaceDetail.NearChunksAreFineAndFarOnesCoarse'
runs_twice+=':SurfaceDetail.AFlatFieldDoesNotPayForTheRoughestCliff'

# backend_steps: the C++ tests of the backend, in a few processes, for starting one takes as long as
# most tests; then the C tests, a process each.
backend_steps() {
    local but=() label=()
    if [ "$fast" = 1 ]; then
        but=("--gtest_filter=-$starts_povray")
        label=(--label-exclude povray)
    fi
    step backend /usr/bin/python3 tests/run_shards.py --junit "$logs/backend.xml" \
        build/release/tests/backend_tests "${but[@]}"
    step capi ctest --test-dir build/release --parallel "$(nproc)" --output-on-failure \
        --no-tests=error --output-junit "$logs/capi.xml" --label-regex capi "${label[@]}"
}

# behind: begins the long work that has no time limits, the sanitized build, its tests and
# clang-tidy, on what the tests in front leave of the processors. Linux shares them between sessions
# first and looks at nice within one only, so this is a session of its own that asks for little.
# clang-tidy comes last and begins no file later than $tidy_until seconds from the start.
behind() {
    setsid nice -n 19 bash -c '
        echo 19 2>/dev/null >/proc/self/autogroup || true
        logs=$1 tidy_until=$2 SECONDS=$3 left_out=$4
        cmake --preset sanitize -DLODESTONE_TESTS=ON && ninja -C build/sanitize || exit 1
        began=$SECONDS
        # In POV-Ray nothing is sanitized. Of libraries that are opened late the sanitizer notes
        # where their threads keep things, now and then at addresses that are none, and falls over
        # them when it looks for leaks.
        ASAN_OPTIONS=intercept_tls_get_addr=0 timeout --kill-after=10 1800 /usr/bin/python3 tests/run_shards.py \
            --junit "$logs/sanitize.xml" build/sanitize/tests/backend_tests \
            "--gtest_filter=-$left_out" >"$logs/sanitize.log" 2>&1
        timeout --kill-after=10 900 ctest --test-dir build/sanitize --output-on-failure \
            --no-tests=error --label-regex capi --label-exclude povray \
            --output-junit "$logs/sanitize-c.xml" >"$logs/sanitize-c.log" 2>&1
        echo $((SECONDS - began)) >"$logs/sanitize.seconds"
        began=$SECONDS
        TIDY_SECONDS=$((tidy_until - SECONDS)) PYTHONPATH=tests timeout --kill-after=10 3600 \
            /usr/bin/python3 tests/run_python.py \
            --junit "$logs/tidy.xml" tests/lint/test_tidy.py >"$logs/tidy.log" 2>&1
        echo $((SECONDS - began)) >"$logs/tidy.seconds"
    ' behind "$logs" "$tidy_until" $((SECONDS - start)) "$starts_povray:$runs_twice" >"$logs/sanitize-build.log" 2>&1 &
    behind=$!
    trap 'kill -- "-$behind" 2>/dev/null || true' EXIT
}

# caught_up: waits for it.
caught_up() {
    wait "$behind" || true
    trap - EXIT
    [ -e "$logs/tidy.seconds" ] || stop "The sanitized build" "$logs/sanitize-build.log"
    finish sanitize "$(cat "$logs/sanitize.seconds")"
    finish sanitize-c 0
    finish tidy "$(cat "$logs/tidy.seconds")"
    grep --only-matching '[0-9]* files, .* left to --tidy-all' "$logs/tidy.log" || true
}

if [ "$install" = 1 ]; then
    bash samples/install_packages.sh samples/packages.txt tests/packages.txt
fi

start=$SECONDS
echo "Building release"
build release "$logs/build.log" || stop "The build" "$logs/build.log"
printf '%-12s %4d s\n' build $((SECONDS - start))

shopt -s nullglob
lint=()
for file in tests/lint/test_*.py; do
    [[ $file == */test_tidy.py ]] || lint+=("$file")
done
if [ "$fast" = 1 ]; then
    backend_steps
    python_step lint "${lint[@]}"
    python_step python tests/python/test_*.py
else
    backend_steps

    python_step lint "${lint[@]}"
    python_step python tests/python/test_*.py
    behind
    python_step blender tests/blender/test_*.py
    blender_step in-blender tests/blender/blender_test_*.py
    python_step povray tests/povray/test_*.py
    python_step end_to_end tests/end_to_end/test_*.py
    caught_up
fi

echo "Logs: build/tests/; $SECONDS s in all"
/usr/bin/python3 tests/count.py "${results[@]}"
