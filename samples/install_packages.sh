#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs the apt packages listed in the given files (one a line, # comments) that are missing.
#
# usage: install_packages.sh FILE...
#
# Nothing missing: no apt call, no root needed. Never asks, needs neither terminal nor screen.
set -euo pipefail

if [ $# -eq 0 ]; then
    echo "usage: install_packages.sh FILE..." >&2
    exit 2
fi

for list in "$@"; do
    if [ ! -r "$list" ]; then
        echo "install_packages.sh: cannot read $list" >&2
        exit 2
    fi
done

mapfile -t wanted < <(sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' -- "$@" | sort -u)
if [ ${#wanted[@]} -eq 0 ]; then
    exit 0
fi

# "ii": wanted and installed. Unknown names make dpkg-query fail and are simply missing.
installed=$(dpkg-query --show --showformat='${db:Status-Abbrev} ${Package}\n' "${wanted[@]}" \
    2>/dev/null | sed -n 's/^.i *//p' || true)
missing=()
for package in "${wanted[@]}"; do
    if ! grep --quiet --line-regexp --fixed-strings -- "$package" <<<"$installed"; then
        missing+=("$package")
    fi
done
if [ ${#missing[@]} -eq 0 ]; then
    exit 0
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
    # sudo that would ask for a password hangs a job without a terminal.
    if ! { [ -t 0 ] && command -v sudo; } >/dev/null && ! sudo -n true 2>/dev/null; then
        echo "These packages are missing and only root can install them. Please run:" >&2
        echo "    sudo apt-get install --no-install-recommends ${missing[*]}" >&2
        exit 1
    fi
    as_root=(sudo)
fi

echo "Installing ${#missing[@]} packages: ${missing[*]}"
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get --quiet=2 -o Dpkg::Use-Pty=0
    -o DPkg::Lock::Timeout=300)
# Without fresh lists a bare machine knows no package; with stale ones a download may be gone.
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! { "${apt[@]}" update && "${apt[@]}" install --yes --no-install-recommends "${missing[@]}"; } \
    </dev/null >"$log" 2>&1; then
    tail -n 40 "$log" >&2
    echo "apt-get failed; the packages that are missing: ${missing[*]}" >&2
    exit 1
fi
