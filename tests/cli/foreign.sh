# The common part of the tests of other programs' estimators, behind program.sh.

# Programs in Python find the package `assay`.
export PYTHONPATH=$source_folder/estimators/foreign/python

# tells FILE TEXT: that the text is in it, whatever the width at which the program broke its lines.
tells() { tr -s ' \n' ' ' <"$1" | grep -qF -- "$2" || fail "no \`$2\` in $1"; }

# compile FILE.c: as the manual says, every warning an error, against nothing at all.
compile() {
  cc -std=c11 -O2 -Wall -Wextra -Wpedantic -Werror -fPIC -shared ${2:--nostdlib} \
    -I "$source_folder/estimators" "$1" -o "${1%.c}.so" || fail "$1 does not compile"
}

# verdicts RUN.json: a line of name and verdict for each test.
verdicts() {
  jq -r '.suites[0].tests[] | "\(.name) \(.verdict)"' "$1"
}
# verdict_is RUN.json NAME VERDICT
verdict_is() {
  verdicts "$1" >verdicts.txt
  grep -qxF -- "$2 $3" verdicts.txt || fail "the verdict of $2 is not $3"
}
message() {
  jq -r --arg name "$2" '.suites[0].tests[] | select(.name == $name) | .message' "$1" >err
}

none_left() {
  # By their folder: everything that was started runs here.
  local process
  for process in /proc/[0-9]*; do
    [ "$(readlink "$process/cwd" 2>/dev/null)" = "$work" ] || continue
    [ "${process#/proc/}" -eq $$ ] || [ "${process#/proc/}" -eq "$BASHPID" ] && continue
    [ "$(tr '\0' ' ' <"$process/cmdline" 2>/dev/null)" = "" ] && continue
    grep -q "^PPid:[[:space:]]*$$\$" "$process/status" 2>/dev/null && continue
    fail "left running: $(tr '\0' ' ' <"$process/cmdline")"
  done
}

# same_records ONE.json TWO.json: but for times, threads, and how a library ran.
same_records() {
  local differ='s/"(started|seconds|threads)": *("[^"]*"|[-+0-9.e]+)/"\1": 0/g'
  differ="$differ"'; s/isolated=\\"(true|false)\\"/isolated/g; s/"[a-z]+\.maps/"maps/'
  cmp -s <(sed -E "$differ" "$1") <(sed -E "$differ" "$2") || return 1
  [ ! -d "${1%.json}.maps" ] || diff -r "${1%.json}.maps" "${2%.json}.maps" >/dev/null
}
