# shellcheck shell=bash
# ./dev build and ./dev clean: the catkin workspace, or the core without ROS.

readonly WORKSPACE="$ROOT/catkin_ws"
readonly CORE_BUILD="$ROOT/build/core"
readonly SANITIZERS="address thread"

command_build() {
  [[ $* == "" || $* == --tests || $* == --benchmarks || $* == --core ]] ||
    misuse "build takes nothing, --tests, --benchmarks or --core, not '$*'"
  setup
  case $* in
    --tests) build_tests ;;
    --benchmarks) build_targets benchmarks ;;
    --core) build_core ;;
    *) build_workspace ;;
  esac
}

command_clean() {
  [[ $# -eq 0 ]] || misuse "clean takes no arguments"
  rm -rf "$WORKSPACE"/{build,devel,install,.install,.install.old,src,.catkin_workspace} "$ROOT/build" "$ROOT/out"
  say "clean: removed what is in catkin_ws, build and out"
}

jobs() { echo "${JOBS:-$(nproc)}"; }

# The package is the repository's root. A link from the workspace to all of it would lead back to the workspace, and ROS's
# search of a package would follow it round and round: so each part has a link of its own.
link_package() {
  local package="$WORKSPACE/src/cell_microinjection" part
  [[ ! -L $package ]] || rm "$package"  # of an older checkout
  mkdir -p "$package"
  find "$package" -maxdepth 1 -xtype l -delete
  for part in CMakeLists.txt src benchmark msg srv action launch config urdf test; do
    ln -sfn "../../../$part" "$package/$part"
  done
  # catkin installs it as it is; -C: its time stays while nothing changes.
  install -C -m 644 "$ROOT/package.xml" "$package/package.xml"
}

# Builds and installs all but tests and benchmarks, then takes the workspace's environment on.
build_workspace() {
  build_targets
  install_workspace
  source_workspace
}

# Installs aside, then swaps: a session that runs, or an interrupt, never sees half an installation. Does nothing when
# nothing has changed since. The links share the files with the installation of before; CMake replaces files, it does not
# write into them.
install_workspace() {
  local install="$WORKSPACE/install" aside="$WORKSPACE/.install" old="$WORKSPACE/.install.old"
  if [[ ! -d $install && -d $old ]]; then mv "$old" "$install"; fi  # interrupted between the two steps of a swap
  rm -rf "$aside" "$old"
  [[ -n $(newer_than_installation "$install/.complete") ]] || return 0
  say "build: installs into catkin_ws/install"
  mkdir -p "$aside$WORKSPACE"
  if [[ -d $install ]]; then cp -al "$install" "$aside$install"; fi
  rm -f "$aside$install/.complete"
  touch "$aside/began"
  DESTDIR="$aside" cmake --install "$WORKSPACE/build" >/dev/null || fail "the installation failed (messages above)"
  forget_renamed "$aside"
  mv "$aside/began" "$aside$install/.complete"
  if [[ -d $install ]]; then mv "$install" "$old"; fi
  mv "$aside$install" "$install"
  rm -rf "$aside" "$old"
}

# Something that is installed and newer than the file $1; nothing: the installation is complete. A folder of the sources is
# newer when a file of it has gone; what is built goes with CMake's own lists.
newer_than_installation() {
  if [[ ! -f $1 ]]; then
    echo "$1"
    return
  fi
  find "$ROOT"/{launch,config,urdf,msg,srv,action,src/tools,package.xml} -newer "$1" -not -path '*/__pycache__*' \
    -print -quit
  find "$WORKSPACE/devel" "$WORKSPACE/build" -newer "$1" -type f \( -path "$WORKSPACE/devel/lib/*" -not -name '*_test' \
    -not -name 'bench_*' -not -name '*.pyc' -o -path "$WORKSPACE/devel/include/*" -o -path "$WORKSPACE/devel/share/*" \
    -o -name cmake_install.cmake \) -print -quit
}

# What all tests need: the workspace, the tests of the rooms and the programs of the chain, installed beside the nodes.
build_tests() {
  build_workspace
  build_targets tests
  install_component tests
}

# An installation never forgets by itself a file that has since been renamed. What CMake has not listed goes, from the
# installation below $1.
forget_renamed() {
  comm -23 <(find "$1$WORKSPACE/install" -type f ! -name .catkin ! -name '*.pyc' | sed "s:^$1::" | sort) \
    <(sort -u "$WORKSPACE"/build/install_manifest*.txt) | sed "s:^:$1:" | xargs -r -d '\n' rm
}

# What is installed on request only.
install_component() {
  cmake --install "$WORKSPACE/build" --component "$1" >/dev/null || fail "'$1' could not be installed"
}

# Makes targets of the workspace.
build_targets() {
  [[ $ROOT != *" "* ]] || fail "catkin cannot build below a path with a space in it: $ROOT"
  forget_moved_build "$WORKSPACE/build" "$WORKSPACE/devel" "$WORKSPACE/install"
  link_package
  # catkin keeps the environment of its tests from the first configuration, and leaves out folders that are not there yet.
  mkdir -p "$WORKSPACE/devel/lib/python3/dist-packages"
  say "build: catkin_make $* in catkin_ws ($(jobs) jobs)"
  catkin_make -C "$WORKSPACE" -j"$(jobs)" -DPYTHON_EXECUTABLE=/usr/bin/python3 -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DCMAKE_CXX_COMPILER_LAUNCHER="$COMPILER_LAUNCHER" "$@" || fail "the build failed (messages above)"
}

# build_core [SANITIZER [TARGET...]]: into build/core/plain, or build/core/SANITIZER; all targets when none is given.
build_core() {
  local sanitizer=${1:-} folder
  folder=$(core_folder "$sanitizer")
  shift $(($# > 0))
  forget_moved_build "$folder"
  say "build: core without ROS in ${folder#"$ROOT/"} ($(jobs) jobs)"
  cmake -S "$ROOT" -B "$folder" -DMICROINJECTION_WITH_ROS=OFF -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    -DMICROINJECTION_SANITIZE="$sanitizer" -DPYTHON_EXECUTABLE=/usr/bin/python3 \
    -DCMAKE_CXX_COMPILER_LAUNCHER="$COMPILER_LAUNCHER" || fail "configuring the core failed (messages above)"
  cmake --build "$folder" --parallel "$(jobs)" ${1:+--target "$@"} ||
    fail "the build of the core failed (messages above)"
}

# As deep below the sources as the workspace's build: seen from both, a source has the same relative path, and the compiler
# cache knows that it is the same.
core_folder() { echo "$CORE_BUILD/${1:-plain}"; }

# CMake refuses a build folder that was made elsewhere (a copied or moved checkout).
forget_moved_build() {
  local cache="$1/CMakeCache.txt"
  if [[ -f $cache ]] && ! grep -qxF "CMAKE_CACHEFILE_DIR:INTERNAL=$1" "$cache"; then
    say "build: $1 was made for another place; removing it"
    rm -rf "$@"
  fi
}
