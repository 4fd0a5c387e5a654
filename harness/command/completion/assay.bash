# Completion of assay in bash. The program says what may follow; a word with `*` stands for files.
_assay() {
  local words=() word current offers=()
  for word in "${COMP_WORDS[@]:1:COMP_CWORD}"; do
    # Bash takes `=` for a word of its own.
    if [[ ${#words[@]} -gt 0 && ($word == = || ${words[-1]} == *=) ]]; then
      words[-1]+=$word
    else
      words+=("$word")
    fi
  done
  current=${words[-1]-}
  COMPREPLY=()
  while IFS=$'\t' read -r word _; do
    if [[ $word == *'*'* ]]; then
      compopt -o filenames
      mapfile -t offers < <(compgen -f -X "!$word" -- "${current##*=}"
                            compgen -d -- "${current##*=}")
      COMPREPLY+=("${offers[@]}")
    else
      [[ $word == *= ]] && compopt -o nospace
      COMPREPLY+=("${word#"${current%"${current##*=}"}"}")
    fi
  done < <("${COMP_WORDS[0]/#\~/$HOME}" __complete "${words[@]}" 2>/dev/null)
}
complete -F _assay assay
