# Completion of `fmbpc` in bash: commands, options and the words that they take, names of loops, studies, tunings, models and structures; else files.
# scripts/env.sh sources it; installed under share/bash-completion/completions it is found without a line in ~/.bashrc.

_fmbpc_names() { # names of config/KIND
  local folder
  local -a folders
  IFS=: read -ra folders <<<"${FMBPC_CONFIG_PATH:-}:${_fmbpc_config:-}"
  for folder in "${folders[@]}"; do
    [ -n "$folder" ] && find "$folder/$1" -name '*.yaml' -printf '%f\n' 2>/dev/null
  done | sed 's/\.yaml$//' | sort -u
}

_fmbpc_values() { # TOOL COMMAND OPTION: the words of an option's value, as its help lists them; fails if it takes none
  local line
  [[ $3 =~ ^--[a-z-]+$ ]] || return 1
  line=$("$1" "$2" --help 2>/dev/null | sed -nE "s/^ *(-[a-z], *)?$3 +(TEXT|INT|UINT|FLOAT)/\\2/p" | head -n 1)
  [ -n "$line" ] || return 1
  sed -nE 's/^[^ ]*\{([a-z_,]*)\}.*/\1/p; s/^TEXT +([a-z]+(, [a-z]+)+)( \(.*)?$/\1/p' <<<"$line" | tr -d ' ' | tr ',' '\n'
}

_fmbpc() {
  local before=${COMP_WORDS[COMP_CWORD - 1]} # --option VALUE and --option=VALUE
  if [ "$before" = "=" ]; then before=${COMP_WORDS[COMP_CWORD - 2]}; fi
  local word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]:-} tool=${COMP_WORDS[0]} words
  if [ "$word" = "=" ]; then word=; fi
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    words=$("$tool" --help 2>/dev/null | sed -n '/^Subcommands:/,$s/^  \([a-z]*\) .*/\1/p')
    words="$words --help --version"
  elif [ "${word#-}" != "$word" ]; then
    words=$("$tool" "$command" --help 2>/dev/null | grep -oE -- '--[a-z-]+' | sort -u)
  elif [ "${before#--}" != "$before" ] && words=$(_fmbpc_values "$tool" "$command" "$before"); then
    command=
  else
    case $command in
      replay) [ "$COMP_CWORD" -eq 2 ] || words=$("$tool" loops --names 2>/dev/null) ;;
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
