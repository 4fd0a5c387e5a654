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
# installed. What the tools say is shown only when they fail.
build_project() {
  local folder=$1 targets=() log
  shift
  while [ $# -gt 0 ] && [ "$1" != -- ]; do targets+=("$1"); shift; done
  [ "${1:-}" = -- ] && shift
  local launcher=()
  if command -v ccache >/dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
  mkdir -p "$folder"
  log=$folder/build.log
  if ! { cmake -G Ninja -S . -B "$folder" "${launcher[@]}" "$@" &&
         cmake --build "$folder" --target "${targets[@]}"; } >"$log" 2>&1; then
    tail -n 60 "$log" >&2
    echo "the build failed; all of it is in $log" >&2
    return 1
  fi
}
