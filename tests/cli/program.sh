# The common part of the tests of the program, which source it with the arguments ASSAY
# SOURCE_FOLDER. Moves into a temporary folder of the test's own, which is removed at its end.
assay=$1
source_folder=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
export XDG_CACHE_HOME=$work/.cache
unset NO_COLOR FORCE_COLOR CLICOLOR_FORCE GITHUB_ACTIONS
unset GTEST_TOTAL_SHARDS GTEST_SHARD_INDEX TEST_TOTAL_SHARDS TEST_SHARD_INDEX

fail() {
  printf 'FAILED: %s\n' "$*"
  for file in out err; do
    printf -- '--- %s\n' "$file"
    head -c 4000 "$work/$file" 2>/dev/null
  done
  exit 1
}

# expect CODE ARGUMENT…: runs assay into the files `out` and `err`.
expect() {
  local wanted=$1 code=0
  shift
  "$assay" "$@" >out 2>err </dev/null || code=$?
  [ "$code" -eq "$wanted" ] || fail "assay $* ended with $code, not $wanted"
}

# In one line, or over the lines of a message.
contains() {
  grep -qF -- "$2" "$1" || tr -s ' \n' ' ' <"$1" | grep -qF -- "$2" || fail "no \`$2\` in $1"
}
lacks() { ! grep -qF -- "$2" "$1" || fail "\`$2\` in $1"; }
empty() { [ ! -s "$1" ] || fail "$1 is not empty"; }

# A record without its times: reports::without_times.
timeless() {
  /usr/bin/python3 - "$1" <<'END'
import json, sys
def clear(node):
    if isinstance(node, dict):
        return {key: clear(value) for key, value in node.items() if key != "seconds"}
    return [clear(item) for item in node] if isinstance(node, list) else node
record = json.load(open(sys.argv[1]))
del record["started"], record["environment"]["threads"]
print(json.dumps(clear(record), indent=1))
END
}
