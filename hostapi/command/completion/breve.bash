# Completion of the breve command for bash.
# shellcheck shell=bash disable=SC2207  # words without blanks

_breve() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command='' i options
  for ((i = 1; i < COMP_CWORD; i++)); do
    if [[ ${COMP_WORDS[i]} != -* ]]; then command=${COMP_WORDS[i]}; break; fi
  done
  if [[ -z $command ]]; then
    COMPREPLY=($(compgen -W "run view replay repl check doc lsp help --help --version" -- "$word"))
    return
  fi
  case $before in
    --path | --allow-read | --allow-write | --allow-plugins | --out) COMPREPLY=($(compgen -d -- "$word")); return ;;
    --positions | --trace | --snapshot | --contact-sheet | --movie | --sound | --plot-to | --log | --record | --play) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --accuracy) COMPREPLY=($(compgen -W "fast balanced precise reference conserving" -- "$word")); return ;;
    --format) COMPREPLY=($(compgen -W "markdown html both" -- "$word")); return ;;
    --iterations | --seconds | --seed | --set | --budget | --physics-budget | --memory | --depth | --trace-limit | --allow | --size | --fps | --plot | --speed)
      return ;;
  esac
  case $command in
    run)
      options="--iterations --seconds --seed --set --budget --physics-budget --memory --depth --path --allow-read
        --allow-write --no-files --allow-network --network-address --allow-system --allow-plugins --record --accuracy --watch --coarse-random --strict --quiet --verbose --stats
        --effects --hash --positions --profile --trace --trace-limit --snapshot --contact-sheet --movie --sound --size --fps --plain --arrows --live
        --plot --plot-to --log --help" ;;
    view)
      options="--seed --set --path --allow-read --allow-write --no-files --allow-network --network-address --allow-system --allow-plugins
        --accuracy --watch --size --speed --paused --plain --arrows --software --strict --quiet --verbose --play --help" ;;
    repl)
      options="--seed --path --allow-read --allow-write --no-files --allow-network --network-address --allow-system --allow-plugins --strict --quiet --help" ;;
    replay) options="--allow-plugins --hash --quiet --help" ;;
    check) options="--path --allow --allow-plugins --strict --json --help" ;;
    doc) options="--library --out --format --path --help" ;;
    lsp) options="--path --help" ;;
    help)
      COMPREPLY=($(compgen -W "run view replay repl check doc lsp" -- "$word"))
      return ;;
    *) return ;;
  esac
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$word"))
  elif [[ $command != lsp ]]; then
    COMPREPLY=($(compgen -d -- "$word") $(compgen -f -X '!*.tz' -- "$word"))
  fi
}
complete -o filenames -F _breve breve
