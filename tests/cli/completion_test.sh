#!/usr/bin/env bash
# Shells complete, and the manual page is sound. TEST is one of the functions test_… below. A test of a
# shell that is not installed ends with 77.
#   completion_test.sh ASSAY SOURCE_FOLDER TEST
set -uo pipefail

source "$(dirname "$0")/program.sh"
export PATH="$(dirname "$assay"):$PATH"
touch mine.yaml other.yaml run.json
mkdir folder

needs() { command -v "$1" >/dev/null || exit 77; }

# completes SHELL_FUNCTION: holds the lines that it offers for each command line to the table.
completes() {
  local line wanted
  while IFS='|' read -r line wanted; do
    [ "$("$1" "$line" 2>err | LC_ALL=C sort | xargs)" = "$wanted" ] ||
      fail "$1 \`$line\`: $("$1" "$line" 2>&1 | LC_ALL=C sort | xargs), not $wanted"
  done <<'TABLE'
assay re|replay report
assay run --sh|--shard
assay run mine.yaml --color a|always auto
assay run mine.yaml --inconclusive |fail pass
assay run mine.yaml --report m|markdown= metrics=
assay run mi|mine.yaml
assay replay |folder/ run.json
assay describe luminaire/a|luminaire/area
assay list tests oth|other.yaml
assay completion z|zsh
assay init process p|python
TABLE
}

# Readline splits words at blanks and `=`.
in_bash() {
  bash --norc -c '
    source <(assay completion bash)
    compopt() { filenames=yes; }  # readline adds a slash to a folder
    read -ra COMP_WORDS <<<"${1//=/ = }"
    [[ $1 != *[\ =] ]] || COMP_WORDS+=("")
    COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
    $(complete -p assay | sed "s/.*-F \([^ ]*\).*/\1/")
    for word in "${COMPREPLY[@]}"; do [ -d "$word" ] && word+=/; echo "$word"; done' bash "$1"
}
test_bash_completes() {
  completes in_bash
  [ "$(in_bash 'assay run mine.yaml --report json=run')" = run.json ] || fail 'no file after json='
  [ "$(in_bash 'assay run mine.yaml --color=al')" = always ] || fail 'no value after ='
}

# With zsh's own functions replaced by ones that print.
in_zsh() {
  zsh -f -c '
    compdef() { :; }
    _describe() { local -a all; all=("${(@P)4}"); print -l -- "${(@)all%%:*}"; }
    compadd() { local -a all; all=("${(@P)4}"); print -l -- $all; }
    compset() { :; }
    _files() { local p; for p in ${words[CURRENT]}*(N/M) ${words[CURRENT]}*(N.); [[ $p == (*/|${~2}) ]] && print $p; }
    source <(assay completion zsh)
    words=("${(@s: :)1}")
    CURRENT=$#words
    _assay' zsh "$1"
}
test_zsh_completes() {
  needs zsh
  completes in_zsh
}

in_fish() { fish --no-config -c 'source (assay completion fish | psub); complete -C $argv[1]' "$1" | cut -f 1; }
test_fish_completes() {
  needs fish
  completes in_fish
}

test_the_manual_page_has_no_fault() {
  needs mandoc
  expect 0 man
  # A manual page of a program that is not released has no date.
  ! mandoc -T lint out | grep -v 'missing date' >err || fail 'mandoc finds faults'
  mandoc -T ascii out | col -b >page
  contains page 'assay check [OPTIONS] CLAIM'
  contains page '--report KIND=PATH ...'
  [ "$(LC_ALL=C.UTF-8 wc -L <page)" -le 80 ] || fail 'a line of the page is wider than 80 columns'
}

"$3"
