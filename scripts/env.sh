# Source this in bash: rosrun, roslaunch, rostopic and rosbag then find fmbpc and its messages, and `fmbpc` is the tool.
#   . scripts/env.sh
_fmbpc_env() {
  local top=$1
  if [ ! -e "$top/devel/setup.bash" ]; then
    echo "fmbpc is not built yet: run $top/scripts/install && $top/scripts/build first" >&2
    return 1
  fi
  if ! grep -q "$top/devel" "$top/devel/setup.sh"; then
    echo "this tree was built elsewhere and moved here: remove $top/build and $top/devel, then run $top/scripts/build" >&2
    return 1
  fi
  local strict=
  case $- in *u*) strict=1; set +u ;; esac  # catkin's script reads unset variables
  export PATH=/usr/bin:$PATH
  . "$top/devel/setup.bash"
  # Alone on this machine unless the caller says by which name or address others reach it (ROS_HOSTNAME wins over ROS_IP).
  if [ -z "${ROS_HOSTNAME:-}${ROS_IP:-}" ]; then export ROS_HOSTNAME=localhost; fi
  if [ -n "$strict" ]; then set -u; fi
  export FMBPC_TOP=$top
}
if [ -z "${BASH_VERSION:-}" ]; then
  echo "scripts/env.sh is for bash: start bash and source it there" >&2
else
  _fmbpc_env "$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)" && fmbpc() { "$FMBPC_TOP/scripts/fmbpc" "$@"; } && export -f fmbpc
fi
unset -f _fmbpc_env
