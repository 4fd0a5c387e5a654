# Sourced, not run: install_packages FILE... installs the Debian packages that the files list and that
# are not there yet. Quiet, and without a network, when nothing is missing.

missing_packages() {
  local package
  grep -hv '^#' "$@" | while read -r package; do
    if [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" != installed ]; then
      echo "$package"
    fi
  done
}

install_packages() {
  local missing as_root=()
  missing=$(missing_packages "$@")
  [ -z "$missing" ] && return 0
  if [ "$(id -u)" -ne 0 ]; then as_root=(sudo); fi
  echo "installing:" $missing >&2
  "${as_root[@]}" apt-get update -qq >&2
  # shellcheck disable=SC2086  # one word a package
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends $missing >&2
}

# build_project FOLDER TARGET... [-- CMAKE_OPTION...] configures and builds, with ccache where it is
# installed. Says nothing when nothing is to be done; else that it builds, on a terminal with a line
# that follows the steps. All that the tools say goes to FOLDER/build.log, shown when they fail.
build_project() {
  local folder=$1 targets=() log
  shift
  while [ $# -gt 0 ] && [ "$1" != -- ]; do targets+=("$1"); shift; done
  [ "${1:-}" = -- ] && shift
  local launcher=()
  if command -v ccache >/dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
  # ccache asks for the first with precompiled headers; no file here uses the time of its compiling.
  # The compiler knows a precompiled header again by its comments too, so they count.
  export CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_COMMENTS=1
  mkdir -p "$folder"
  log=$folder/build.log
  if [ ! -e "$folder/build.ninja" ]; then
    echo "building Assay (a few minutes the first time)…" >&2
  elif ! cmake --build "$folder" --target "${targets[@]}" -- -n 2>&1 | grep -q 'no work to do'; then
    echo "building Assay…" >&2
  fi
  if ! { cmake -G Ninja -S . -B "$folder" "${launcher[@]}" "$@" &&
         cmake --build "$folder" --target "${targets[@]}"; } 2>&1 | follow_steps "$log"; then
    echo "the end of $log:" >&2
    tail -n 60 "$log" >&2
    echo "the build failed; all of it is in $log" >&2
    return 1
  fi
  tell_warnings "$log"
}

# A warning does not end the build unless CI is set (a newer compiler has new ones), but it is said.
tell_warnings() {
  local warnings
  warnings=$(grep -c 'warning:' "$1") || return 0
  echo "$warnings warnings of the compiler, errors where CI is set: $1" >&2
}

# Writes what it reads to a file; on a terminal the last line stands on one line until the end. Needs
# `set -o pipefail` around it for the exit code of what it follows.
follow_steps() {
  if [ ! -t 2 ]; then
    cat >"$1"
    return
  fi
  local line
  while IFS= read -r line; do
    printf '%s\n' "$line" >&3
    case $line in "["*) printf '\r\033[K%.*s' "$((${COLUMNS:-80} - 1))" "$line" >&2 ;; esac
  done 3>"$1"
  printf '\r\033[K' >&2
}
