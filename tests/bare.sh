#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Tries the two commands of README.md on a Debian 12 that has git and nothing else: what the package
# lists forget is not seen on a machine that has more installed.
set -euo pipefail

usage() {
    cat <<'END_OF_USAGE'
usage: tests/bare.sh [--cached] [--keep] [--mirror=URL]

    --cached       begin with the Debian of an earlier run (build/bare/base.tar), or keep one there;
                   packages are installed anew in either case
    --keep         leave the Debian, with all that was built in it, in build/bare/debian
    --mirror=URL   take packages from there instead of from where this machine's apt does

Makes a fresh Debian 12, clones what is committed here into it and runs samples/quickstart.sh and
tests/run.sh. Needs root, debootstrap, the network, 10 GB under build/ and an hour of one processor;
skipped without root or debootstrap. Real scenes are those of $LODESTONE_DATA (default
../shared/data), read-only; tests that need them are skipped without.

Logs: build/bare/. Exit code 0 when both passed or all was skipped, 1 otherwise, 2 usage.
END_OF_USAGE
}

cached=0
keep=0
mirror=
for argument in "$@"; do
    case $argument in
    --cached) cached=1 ;;
    --keep) keep=1 ;;
    --mirror=?*) mirror=${argument#*=} ;;
    -h | --help) usage; exit 0 ;;
    *) echo "tests/bare.sh: unknown argument '$argument'" >&2; usage >&2; exit 2 ;;
    esac
done

cd "$(dirname "${BASH_SOURCE[0]}")/.."
root=$PWD
logs=$root/build/bare
debian=$logs/debian
base=$logs/base.tar
data=${LODESTONE_DATA:-$root/../shared/data}
exec </dev/null
export LC_ALL=C.UTF-8

if [ "$(id -u)" -ne 0 ]; then
    echo "skipped: only root can make a Debian to try things in"
    exit 0
fi
if ! command -v debootstrap >/dev/null; then
    echo "skipped: debootstrap is missing (apt-get install debootstrap)"
    exit 0
fi

mkdir -p "$logs"
exec 9>"$logs/lock"
if ! flock --nonblock 9; then
    echo "tests/bare.sh: another run works in build/bare" >&2
    exit 1
fi

# in_background COMMAND...: waits for a command in a way that a signal interrupts. What the command
# mounts is seen by itself alone, and what it starts ends with it.
in_background() {
    local outcome=0
    unshare --mount --propagation private --pid --fork --kill-child "$@" &
    running=$!
    wait "$running" || outcome=$?
    running=
    return "$outcome"
}

# Nothing is mounted where this looks: the mounts are those of the ended commands.
clean_up() {
    [ -z "$running" ] || kill -KILL "$running" 2>/dev/null || true
    [ -z "$running" ] || wait "$running" 2>/dev/null || true
    [ "$keep" = 1 ] || rm -rf --one-file-system "$debian"
}

running=
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP
rm -rf --one-file-system "$debian" "$logs"/*.log "$logs/tests"
mkdir -p "$debian"

# failed NAME LOG
failed() {
    tail -n 40 "$2"
    echo "$1: failed; the whole log: ${2#"$root"/}"
}

# host_mirror: where apt of this machine takes Debian 12 from, else where all do.
host_mirror() {
    local found
    found=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Origin: Debian' \
        'Codename: bookworm' 'Component: main' 2>/dev/null | head -n 1) || true
    echo "${found:-http://deb.debian.org/debian}"
}

# bootstrap: a Debian with git in $debian, from the network or from the earlier one.
bootstrap() {
    if [ "$cached" = 1 ] && [ -e "$base" ]; then
        tar --extract --file "$base" --directory "$debian" --numeric-owner
        return
    fi
    in_background debootstrap --variant=minbase --include=git,ca-certificates \
        bookworm "$debian" "$mirror" || return
    if [ "$cached" = 1 ]; then
        tar --create --file "$base.part" --directory "$debian" --numeric-owner . &&
            mv "$base.part" "$base"
    fi
}

# connect: it reaches the mirror as this machine does, with its proxies, certificates and clock.
connect() {
    cp --dereference /etc/resolv.conf /etc/hosts "$debian/etc/" || return
    apt-config dump | grep -E '^Acquire::(https?|Check-|Retries|ForceIPv)' \
        >"$debian/etc/apt/apt.conf.d/99host" || true
    if [ -d /usr/local/share/ca-certificates ]; then
        cp -r /usr/local/share/ca-certificates "$debian/usr/local/share/" &&
            in_background chroot "$debian" update-ca-certificates
    fi
}

# clone: what is committed here, with its history.
clone() {
    git -c safe.directory='*' clone --quiet --no-hardlinks --no-checkout "$root" \
        "$debian/root/lodestone" && git -C "$debian/root/lodestone" checkout --quiet --detach "$1"
}

# inside COMMAND...: runs it in the clone, as after a login.
inside() {
    local passed=() name
    for name in http_proxy https_proxy no_proxy HTTP_PROXY HTTPS_PROXY NO_PROXY; do
        [ -z "${!name:-}" ] || passed+=("$name=${!name}")
    done
    in_background bash -euc '
        debian=$1 data=$2
        shift 2
        mount -t proc proc "$debian/proc"
        mount --rbind /dev "$debian/dev"
        mount --rbind /sys "$debian/sys"
        if [ -d "$data" ]; then
            mkdir -p "$debian/root/shared/data"
            mount --bind "$data" "$debian/root/shared/data"
            mount -o remount,ro,bind "$debian/root/shared/data"
        fi
        exec chroot "$debian" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin "$@"
    ' bash "$debian" "$data" "${passed[@]}" bash -c 'cd && cd lodestone && "$@"; exit $?' bash "$@"
}

outcome=0

# try NAME LOG COMMAND...: one line that says how it went.
try() {
    local name=$1 log=$logs/$2 start=$SECONDS counts=
    shift 2
    if inside "$@" >"$log" 2>&1; then
        # The last line of tests/run.sh is its counts.
        counts=$(tail -n 1 "$log" | grep -E '^[0-9]+ passed, ' || true)
        echo "$name: passed, ${counts:+$counts, }$((SECONDS - start)) s"
    else
        failed "$name" "$log"
        outcome=1
    fi
}

commit=$(git -c safe.directory='*' rev-parse HEAD)
if [ -n "$(git -c safe.directory='*' status --porcelain)" ]; then
    echo "Only what is committed is tried; there are other changes"
fi
mirror=${mirror:-$(host_mirror)}
start=$SECONDS
log=$logs/debian.log
{ bootstrap && connect && clone "$commit"; } >"$log" 2>&1 || { failed "Debian 12" "$log"; exit 1; }
echo "Debian 12: made, $((SECONDS - start)) s"

try quickstart quickstart.log bash samples/quickstart.sh
try tests/run.sh run.log bash tests/run.sh
# The Debian goes; what its steps said stays.
(cd "$debian/root/lodestone/build/tests" 2>/dev/null && mkdir -p "$logs/tests" &&
    find . -maxdepth 1 -type f -exec cp {} "$logs/tests/" \;) || true
exit "$outcome"
