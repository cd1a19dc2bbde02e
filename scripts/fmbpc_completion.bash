# Completion of `fmbpc` in bash: commands, options, names of loops, studies, tunings, models and structures; else files.
# scripts/env.sh sources it; installed under share/bash-completion/completions it is found without a line in ~/.bashrc.

_fmbpc_names() { # names of config/KIND
  local folder
  local -a folders
  IFS=: read -ra folders <<<"${FMBPC_CONFIG_PATH:-}:${_fmbpc_config:-}"
  for folder in "${folders[@]}"; do
    [ -n "$folder" ] && find "$folder/$1" -name '*.yaml' -printf '%f\n' 2>/dev/null
  done | sed 's/\.yaml$//' | sort -u
}

_fmbpc() {
  local word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]:-} tool=${COMP_WORDS[0]} words
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    words=$("$tool" --help 2>/dev/null | sed -n '/^Subcommands:/,$s/^  \([a-z]*\) .*/\1/p')
    words="$words --help --version"
  elif [ "${word#-}" != "$word" ]; then
    words=$("$tool" "$command" --help 2>/dev/null | grep -oE -- '--[a-z-]+' | sort -u)
  else
    case $command in
      run | resolve | evaluate) words=$("$tool" loops --names 2>/dev/null) ;;
      stability) words="$("$tool" loops --names 2>/dev/null) $(_fmbpc_names model)" ;;
      study) words="$("$tool" loops --names 2>/dev/null) $(_fmbpc_names study)" ;;
      tune) words="$("$tool" loops --names 2>/dev/null) $(_fmbpc_names tuning)" ;;
      model | validate) words=$(_fmbpc_names model) ;;
      identify) words=$(_fmbpc_names structure) ;;
      reproduce) words=$("$tool" reproduce --list 2>/dev/null | awk '{print $1; print $2}' | sort -u) ;;
      *) words= ;;
    esac
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  case $command in identify | validate | table | run) mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -- "$word") ;; esac
}

for _fmbpc_config in ../config ../../fmbpc/config; do # of the source tree, installed
  _fmbpc_config=$(cd "$(dirname "${BASH_SOURCE[0]}")/$_fmbpc_config" 2>/dev/null && pwd) && break
done
complete -o filenames -o default -F _fmbpc fmbpc
