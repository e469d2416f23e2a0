# shellcheck shell=bash
# ./dev demo, pictures, bench, paper and shell: programs of the workspace in its environment.

command_demo() {
  [[ ${1:-} != -- ]] || shift
  setup
  build_workspace
  use_private_master
  say "demo: src/tools/demo.py $*"
  exec /usr/bin/python3 "$ROOT/src/tools/demo.py" "$@"
}

command_pictures() {
  [[ ${1:-} != -- ]] || shift
  setup
  build_workspace
  use_private_master
  exec /usr/bin/python3 "$ROOT/src/tools/pictures.py" "$@"
}

command_bench() {
  if [[ $# -eq 0 ]]; then
    list_benches
    return
  fi
  local name=$1 folder="$ROOT/out/bench"
  shift
  [[ ${1:-} != -- ]] || shift
  [[ " $(bench_names | xargs) " == *" $name "* ]] || misuse "no benchmark '$name'; there are: $(bench_names | xargs)"
  setup
  build_bench "$name"
  mkdir -p "$folder"
  rm -f "$folder/$name.csv" "$folder/$name.png"
  say "bench: $name"
  if [[ -f $ROOT/benchmark/$name.cpp ]]; then
    "$(bench_program "$name")" --csv "$folder/$name.csv" "$@"
  else
    /usr/bin/python3 "$ROOT/benchmark/$name.py" --out "$folder" "$@"
  fi
  [[ " $* " == *" --help "* ]] && return
  [[ -s $folder/$name.csv ]] || fail "the benchmark left no $folder/$name.csv"
  if [[ -f $ROOT/benchmark/plot_$name.py ]]; then
    /usr/bin/python3 "$ROOT/benchmark/plot_$name.py" "$folder/$name.csv" "$folder/$name.png"
  fi
  say "bench: results are in"
  ls "$folder/$name".*
}

# A program of its own, or what a script runs: the workspace and more, where CMake has a target of that name.
build_bench() {
  if [[ -f $ROOT/benchmark/$1.cpp ]]; then
    build_targets "bench_$1"
    return
  fi
  build_workspace
  case $1 in
    latency)
      build_targets bench_latency
      install_component emulated_haptic
      ;;
    field | peers) build_targets bench_peers ;;
    python) build_targets bench_force_calls ;;
  esac
  use_private_master
}

bench_names() {
  find "$ROOT/benchmark" -maxdepth 1 \( -name '*.cpp' -o -name '*.py' \) -not -name 'plot_*' -printf '%f\n' |
    sed -e 's/\.[a-z]*$//' | sort
}

# One line a benchmark: its name and the first comment line of its source.
list_benches() {
  local name
  for name in $(bench_names); do
    printf '%-20s %s\n' "$name" "$(sed -n -e '/^#!/d; s/^\(\/\/\/*\|"""\|#\) *//p' "$ROOT/benchmark/$name".{cpp,py} 2>/dev/null |
      head -n 1)"
  done
}

bench_program() {
  local program
  program=$(find "$WORKSPACE/devel/lib" "$WORKSPACE/build" -name "bench_$1" -type f -perm -u+x -print -quit)
  [[ -n $program ]] || fail "the build made no bench_$1; is it in benchmark/CMakeLists.txt?"
  echo "$program"
}

command_paper() {
  [[ ${1:-} != -- ]] || shift
  setup
  build_targets paper
  say "paper: benchmark/paper/report.py $*"
  exec /usr/bin/python3 -B "$ROOT/benchmark/paper/report.py" --programs "$WORKSPACE/devel/lib" --out "$ROOT/out/paper" "$@"
}

command_shell() {
  local isolated=
  if [[ ${1:-} == --isolated ]]; then
    isolated=yes
    shift
  fi
  [[ ${1:-} != -- ]] || shift
  # Standard output belongs to the command.
  { setup; build_workspace; } >&2
  local command=(bash --rcfile "$ROOT/src/tools/dev/shell.rc" -i)
  if [[ $# -gt 0 ]]; then
    command=("$@")
  else
    export MICROINJECTION_ROOT=$ROOT
  fi
  [[ -z $isolated ]] || run_isolated "${command[@]}"
  exec "${command[@]}"
}
