# shellcheck shell=bash
# ./dev format and ./dev lint: the house style, as far as tools can hold it.

command_format() {
  [[ $* == "" || $* == --check ]] || misuse "format takes nothing or --check, not '$*'"
  setup
  format_code "$@"
}

format_code() {
  if [[ ${1:-} == --check ]]; then
    say "format: checking"
    cpp_files | xargs -0r clang-format --dry-run -Werror || return 1
    echo "formatted as .clang-format says"
  else
    say "format: clang-format of src, benchmark and test"
    cpp_files | xargs -0r clang-format -i
  fi
}

cpp_files() { find "$ROOT"/{src,benchmark,test} -name '*.cpp' -print0 -o -name '*.h' -print0; }

command_lint() {
  [[ $# -le 1 && (${1:---quick} == --quick || $1 != -*) ]] || misuse "lint takes --quick or one regular expression, not '$*'"
  setup
  local failed=()
  format_code --check || failed+=(clang-format)
  check_python || failed+=(Python)
  check_package || failed+=(catkin_lint)
  [[ ${1:-} == --quick ]] || run_clang_tidy "${1:-.}" || failed+=(clang-tidy)
  [[ ${#failed[@]} -eq 0 ]] || fail "lint: complaints of ${failed[*]} (above)"
  say "lint: no complaints"
}

check_python() {
  say "lint: Python syntax"
  find "$ROOT"/{src,benchmark,launch,test} -name '*.py' -print0 |
    PYTHONPYCACHEPREFIX="$ROOT/out/pycache" xargs -0r /usr/bin/python3 -m py_compile
}

# Ignored: no other package uses our libraries, so that it does not matter that their targets carry include folders of the
# system; the two branches of an if() that add test/ are not seen as such; urdfdom's key is liburdfdom-dev, which only a
# rosdep database would tell; the tools are run from the source, by ./dev.
check_package() {
  local copy="$ROOT/out/lint/cell_microinjection"
  say "lint: catkin_lint"
  # Of a copy: its walk would see what was built.
  rm -rf "$copy"
  mkdir -p "$copy"
  cp -r "$ROOT"/{package.xml,CMakeLists.txt,src,benchmark,msg,srv,action,launch,config,urdf,test} "$copy"
  catkin_lint -W1 --strict --offline --ignore EXTERNAL_INTERFACE_PATH --ignore DUPLICATE_SUBDIR \
    --ignore MISSING_DEPEND --ignore UNINSTALLED_SCRIPT "$copy"
}

run_clang_tidy() {
  local pattern="^$ROOT/(src|benchmark)/.*$1" database="$ROOT/build/lint"
  say "lint: clang-tidy of the files below src/ and benchmark/ that match '$1' (takes long for all)"
  configure_lint "$database" || return 1
  # Without this, a mistyped pattern would pass. Not grep -q, which ends before sed has written all.
  grep -E '"file":' "$database/compile_commands.json" | sed -e 's/.*: "//' | grep -E "$pattern" >/dev/null ||
    { echo "no file matches"; return 1; }
  /usr/bin/run-clang-tidy -quiet -p "$database" -j "$(jobs)" "$pattern" 2>&1 |
    sed -e '/^clang-tidy/d; /warnings\{0,1\} generated\.$/d'
}

# clang-tidy wants the command of each file, which the workspace's build compiles in groups. Nothing is compiled here: the
# files need the messages' headers only.
configure_lint() {
  forget_moved_build "$1"
  cmake -S "$ROOT" -B "$1" -DMICROINJECTION_UNITY_BUILD=OFF -DCATKIN_DEVEL_PREFIX="$1/devel" -DCATKIN_ENABLE_TESTING=OFF \
    -DPYTHON_EXECUTABLE=/usr/bin/python3 -DCMAKE_BUILD_TYPE=RelWithDebInfo >/dev/null &&
    cmake --build "$1" --parallel "$(jobs)" --target cell_microinjection_generate_messages_cpp >/dev/null
}
