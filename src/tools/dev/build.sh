# shellcheck shell=bash
# ./dev build and ./dev clean: the catkin workspace, or the core without ROS.

readonly WORKSPACE="$ROOT/catkin_ws"
readonly CORE_BUILD="$ROOT/build/core"

command_build() {
  [[ $* == "" || $* == --core ]] || misuse "build takes nothing or --core, not '$*'"
  setup
  if [[ $* == --core ]]; then
    build_core
  else
    build_workspace
  fi
}

command_clean() {
  [[ $# -eq 0 ]] || misuse "clean takes no arguments"
  rm -rf "$WORKSPACE/build" "$WORKSPACE/devel" "$WORKSPACE/install" "$WORKSPACE/.catkin_workspace" "$ROOT/build" "$ROOT/out"
  say "clean: removed catkin_ws/build, devel and install, build and out"
}

jobs() { echo "${JOBS:-$(nproc)}"; }

# Makes the given targets (by default everything but the tests, installed), then takes the workspace's environment on.
# Programs are looked for in the install space, because ROS's search of a source package follows the workspace's link back
# to the package itself, forty times over: slow, and roslaunch then sees each launch file many times.
build_workspace() {
  [[ $ROOT != *" "* ]] || fail "catkin cannot build below a path with a space in it: $ROOT"
  forget_moved_build "$WORKSPACE/build" "$WORKSPACE/devel" "$WORKSPACE/install"
  # catkin keeps the environment of its tests from the first configuration, and leaves out folders that are not there yet.
  mkdir -p "$WORKSPACE/devel/lib/python3/dist-packages"
  # An installation never forgets by itself a file that has since been renamed.
  [[ $# -gt 0 ]] || rm -rf "$WORKSPACE"/install/share/cell_microinjection/{launch,config,urdf}
  say "build: catkin_make in catkin_ws ($(jobs) jobs)"
  catkin_make -C "$WORKSPACE" -j"$(jobs)" -DPYTHON_EXECUTABLE=/usr/bin/python3 -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    -DCMAKE_EXPORT_COMPILE_COMMANDS=ON "${@:-install}" || fail "the build failed (messages above)"
  source_workspace
}

build_core() {
  forget_moved_build "$CORE_BUILD"
  say "build: core without ROS in build/core ($(jobs) jobs)"
  cmake -S "$ROOT" -B "$CORE_BUILD" -DMICROINJECTION_WITH_ROS=OFF -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    -DPYTHON_EXECUTABLE=/usr/bin/python3 || fail "configuring the core failed (messages above)"
  cmake --build "$CORE_BUILD" --parallel "$(jobs)" "$@" || fail "the build of the core failed (messages above)"
}

# CMake refuses a build folder that was made elsewhere (a copied or moved checkout).
forget_moved_build() {
  local cache="$1/CMakeCache.txt"
  if [[ -f $cache ]] && ! grep -qxF "CMAKE_CACHEFILE_DIR:INTERNAL=$1" "$cache"; then
    say "build: $1 was made for another place; removing it"
    rm -rf "$@"
  fi
}
