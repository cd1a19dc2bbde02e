# Source this (bash): rosrun, roslaunch, rostopic and rosbag then find fmbpc and its messages.
#   . scripts/env.sh
_fmbpc_top=$(cd "$(dirname "${BASH_SOURCE[0]:-$0}")/.." && pwd)
if [ ! -e "$_fmbpc_top/devel/setup.bash" ]; then
  echo "fmbpc is not built yet: run $_fmbpc_top/scripts/install && $_fmbpc_top/scripts/build first" >&2
else
  case $- in *u*) _fmbpc_strict=1; set +u ;; *) _fmbpc_strict= ;; esac  # catkin's script reads unset variables
  export PATH=/usr/bin:$PATH
  . "$_fmbpc_top/devel/setup.bash"
  export ROS_HOSTNAME=${ROS_HOSTNAME:-localhost}
  [ -z "$_fmbpc_strict" ] || set -u
  unset _fmbpc_strict
fi
unset _fmbpc_top
