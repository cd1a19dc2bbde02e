# Source this: rosrun, roslaunch, rostopic and rosbag then find fmbpc and its messages.
#   . scripts/env.sh
_fmbpc_top=$(cd "$(dirname "${BASH_SOURCE[0]:-$0}")/.." && pwd)
if [ ! -e "$_fmbpc_top/build/devel/setup.sh" ]; then
  echo "fmbpc is not built yet: run $_fmbpc_top/scripts/install && $_fmbpc_top/scripts/build first" >&2
else
  export PATH=/usr/bin:$PATH
  _CATKIN_SETUP_DIR=$_fmbpc_top/build/devel
  . "$_fmbpc_top/build/devel/setup.sh"
  export ROS_HOSTNAME=${ROS_HOSTNAME:-localhost}
fi
unset _fmbpc_top
