# shellcheck shell=bash
# The environment of every command, whatever the caller's looks like. Sourced by ./dev and by shell.rc; needs ROOT.

prepare_environment() {
  # A python3 of pyenv, conda or a virtual environment knows neither catkin nor matplotlib; another workspace's paths
  # would win over ours.
  export PATH="/usr/bin:$PATH"
  unset PYTHONHOME PYTHONPATH CMAKE_PREFIX_PATH ROS_PACKAGE_PATH ROS_NAMESPACE
  # A decimal comma breaks the numbers that rviz and the URDF parser read.
  export LC_ALL=C.UTF-8
  export ROS_HOME="$ROOT/out/ros" ROS_LOG_DIR="$ROOT/out/ros/log"
  mkdir -p "$ROS_LOG_DIR"  # rospack keeps its cache beside it, and complains where the folder is missing
  if [[ -z ${HOME:-} || ! -w $HOME ]]; then
    export HOME="$ROOT/out/home"
    mkdir -p "$HOME"
  fi
  use_compiler_cache
  # The user's choice where there is one: a haptic device may hang on another machine.
  [[ -n ${ROS_IP:-} || -n ${ROS_HOSTNAME:-} ]] || use_local_names
  export ROS_MASTER_URI="${ROS_MASTER_URI:-http://127.0.0.1:11311}"
  if [[ -f /opt/ros/noetic/setup.bash && ! -e /usr/share/roscpp/cmake ]]; then
    source_ros /opt/ros/noetic/setup.bash
  fi
}

# The core and the workspace compile the same sources: what one has compiled the other takes, where paths below ROOT are
# the same.
use_compiler_cache() {
  COMPILER_LAUNCHER=$(command -v ccache || true)
  export CCACHE_DIR="${CCACHE_DIR:-$ROOT/build/ccache}" CCACHE_BASEDIR="$ROOT" CCACHE_NOHASHDIR=1
}

# ROS's own scripts read variables that may be unset.
source_ros() {
  set +u
  # shellcheck source=/dev/null
  source "$1"
  set -u
}

source_workspace() {
  source_ros "$ROOT/catkin_ws/install/setup.bash"
}

# Nodes name themselves by address, so that it does not matter what, if anything, this machine's name resolves to.
use_local_names() {
  unset ROS_HOSTNAME ROS_IPV6
  export ROS_IP=127.0.0.1
}

# A master of our own, never one that somebody else is using.
use_private_master() {
  local port
  port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
  use_local_names
  export ROS_MASTER_URI="http://127.0.0.1:$port"
}

