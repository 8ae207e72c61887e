#!/usr/bin/env bash
# What npm's lock file in a folder names, into DEST/node_modules:   npm.sh FOLDER DEST
# Nothing happens where it is there already, or, but for a word, where npm or the network is not: who needs it says what
# it does without.
set -euo pipefail
from=$1 dest=$2
! cmp -s "$from/package-lock.json" "$dest/package-lock.json" || exit 0
skip() { echo "$1: without the packages that $from/package.json names"; }
command -v npm >/dev/null || { skip "no npm"; exit 0; }
mkdir -p "$dest"
cp "$from/package.json" "$from/package-lock.json" "$from/.npmrc" "$dest"
(cd "$dest" && npm ci --prefer-offline --loglevel=error </dev/null) || { rm -f "$dest/package-lock.json"; skip "npm fetched nothing"; }
