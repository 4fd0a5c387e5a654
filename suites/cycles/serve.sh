#!/bin/sh
# Cycles as a program that draws pictures when it is asked, for Assay's plugin `process`.
#   sh serve.sh [SETTING=VALUE]...      settings: scene.py
# Blender says things of its own on standard output: they go to standard error, and the replies,
# through descriptor 3, to where standard output went.
if ! command -v blender >/dev/null; then
  printf 'assay 1 text\nerror Blender is not installed; `bash suites/run.sh suites/cycles.yaml` installs it\n'
  exit 1
fi
exec 3>&1 >&2
exec blender -b --factory-startup -noaudio -P "$(dirname "$0")/serve.py" -- "$@"
