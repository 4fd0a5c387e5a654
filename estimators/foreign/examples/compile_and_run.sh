#!/bin/sh
# Compiles a C program, runs it and tidies up: for a suite that has the source alone.
set -e
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cc -std=c11 -O2 -o "$folder/program" "$1"
"$folder/program"
