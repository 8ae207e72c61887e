#!/usr/bin/env bash
# What npm's lock file in a folder names, into DEST/node_modules:   npm.sh FOLDER DEST
# DEST/fetched.json is that lock file once all of it is there; then nothing happens. Nor, but for a word, where npm or the
# network is not: who needs it says what it does without.
set -euo pipefail
from=$1 dest=$2
! cmp -s "$from/package-lock.json" "$dest/fetched.json" || exit 0
skip() { echo "$1: without the packages that $from/package.json names"; exit 0; }
command -v npm >/dev/null || skip "no npm"
mkdir -p "$dest"
rm -f "$dest/fetched.json"
cp "$from/package.json" "$from/package-lock.json" "$from/.npmrc" "$dest"
(cd "$dest" && npm ci --prefer-offline --loglevel=error </dev/null) || skip "npm fetched nothing"
cp "$from/package-lock.json" "$dest/fetched.json"
