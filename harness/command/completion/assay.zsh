#compdef assay
# Completion of assay in zsh. The program says what may follow; a word with `*` stands for files.
_assay() {
  local line word
  local -a offers open
  for line in "${(@f)$("${(@Q)words[1]}" __complete "${(@Q)words[2,CURRENT]}" 2>/dev/null)}"; do
    word=${line%%$'\t'*}
    if [[ $word == *'*'* ]]; then
      compset -P '*='
      _files -g "$word"
    elif [[ $word == *= ]]; then
      open+=("$word")
    elif [[ -n $word ]]; then
      offers+=("${word//:/\\:}:${line#*$'\t'}")
    fi
  done
  (( $#open )) && compadd -S '' -a open
  (( $#offers )) && _describe -t offers assay offers
}
if [[ $zsh_eval_context[-1] == loadautofunc ]]; then _assay "$@"; else compdef _assay assay; fi
