# Source this in bash: rosrun, roslaunch, rostopic and rosbag then find fmbpc and its messages, and `fmbpc` is the tool, with completion.
#   . scripts/env.sh
_fmbpc_env() {
  local top=$1 built
  if [ ! -e "$top/devel/setup.bash" ]; then
    echo "fmbpc is not built yet: run '$top/scripts/install' && '$top/scripts/build' first" >&2
    return 1
  fi
  built=$(sed -n 's/^: \${_CATKIN_SETUP_DIR:=\(.*\)}$/\1/p' "$top/devel/setup.sh")
  if [ "$(readlink -f "$built")" != "$(readlink -f "$top/devel")" ]; then
    echo "this tree was built elsewhere and moved here: remove '$top/build' and '$top/devel', then run '$top/scripts/build'" >&2
    return 1
  fi
  local strict=
  case $- in *u*) strict=1; set +u ;; esac  # catkin's script reads unset variables
  # `fmbpc` alone in a folder: below build/, for rosrun refuses a package in which it finds two of that name elsewhere.
  if [ ! -e "$top/build/bin/fmbpc" ]; then
    mkdir -p "$top/build/bin" && ln -s ../../scripts/fmbpc "$top/build/bin/fmbpc" 2>/dev/null || :  # another shell was first
  fi
  export PATH=$top/build/bin:/usr/bin:$PATH
  . "$top/devel/setup.bash"
  # For nodes of this machine (no fence: the ports listen on all addresses) unless the caller says by which name or address others reach it (ROS_HOSTNAME wins over ROS_IP).
  if [ -z "${ROS_HOSTNAME:-}${ROS_IP:-}" ]; then export ROS_HOSTNAME=localhost; fi
  case $- in *i*) . "$top/scripts/fmbpc_completion.bash" ;; esac
  if [ -n "$strict" ]; then set -u; fi
}
if [ -z "${BASH_VERSION:-}" ]; then
  echo "scripts/env.sh is for bash: start bash and source it there" >&2
  unset -f _fmbpc_env
  return 1
fi
if [ "${BASH_SOURCE[0]}" = "$0" ]; then
  echo "scripts/env.sh is to be sourced, it changes this shell: . scripts/env.sh" >&2
  exit 1
fi
_fmbpc_env "$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)" || { unset -f _fmbpc_env; return 1; }
unset -f _fmbpc_env
