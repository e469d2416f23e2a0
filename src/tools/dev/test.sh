# shellcheck shell=bash
# ./dev test: builds the tests, runs them with ctest, and sums the results up.

readonly RESULTS="$ROOT/out/test"

command_test() {
  local kind=ros sanitizer=""
  while [[ ${1:-} == --* ]]; do
    case $1 in
      --core) kind=core ;;
      --stalls) STALLS=yes ;;
      --sanitize)
        sanitizer=${2:-}
        [[ -n $sanitizer && " $SANITIZERS " == *" $sanitizer "* ]] ||
          misuse "--sanitize '$sanitizer': must be one of: $SANITIZERS"
        shift
        ;;
      *) misuse "unknown option '$1' of test; the options are: --core, --sanitize, --stalls" ;;
    esac
    shift
  done
  [[ $kind == core || -z $sanitizer ]] || misuse "--sanitize is for the core only: add --core"
  check_test_folders "$@"
  if [[ -n $sanitizer ]]; then
    test_sanitized "$sanitizer" "$@"
  else
    setup
    "test_$kind" "$@"
  fi
}

test_ros() {
  if [[ $# -eq 0 || " $* " == *" chain "* ]]; then
    build_tests
  else
    # shellcheck disable=SC2046
    build_targets $(test_targets "$@")
  fi
  use_private_master
  run_tests ros "$WORKSPACE/build" "$WORKSPACE/build/test_results" "$@"
}

test_core() {
  # shellcheck disable=SC2046
  build_core "" $(test_targets "$@")
  run_core core "$(core_folder)" "$@"
}

# The gtest programs of the named folders of test/, one for each room; with ROS also one for each folder of nodes.
test_targets() {
  local rooms room folder
  rooms=$(sed -n -e 's/^microinjection_room(\([a-z/]*\).*/\1/p' "$ROOT/src/CMakeLists.txt")
  if [[ $kind == ros ]]; then
    rooms+=" rviz $(cd "$ROOT/test" && find nodes -name '*_test.cpp' -printf '%h\n' | sort -u | xargs)"
  fi
  for folder in "$@"; do
    for room in $rooms benchmark commands; do
      [[ $room != "$folder" && $room != "$folder"/* ]] || echo "${room//\//_}_test"
    done
  done
}

# run_core KIND BUILD_FOLDER [TEST_FOLDER...]
run_core() {
  # Makes each gtest program write a JUnit file there.
  export GTEST_OUTPUT="xml:$RESULTS/$1/"
  run_tests "$1" "$2" "$RESULTS/$1" "${@:3}"
}

# test_sanitized SANITIZER [TEST_FOLDER...]: builds only the tests that it runs, because that takes long.
test_sanitized() {
  local sanitizer=$1 targets
  shift
  targets=$(test_targets "$@")
  [[ $# -eq 0 || -n $targets ]] || misuse "no tests of the core in: $*"
  setup
  # shellcheck disable=SC2086
  build_core "$sanitizer" $targets
  "use_${sanitizer}_sanitizer"
  # A sanitized program takes several times as long.
  TEST_TIMEOUT=14400 run_core "core-$sanitizer" "$(core_folder "$sanitizer")" "$@"
}

use_address_sanitizer() {
  export ASAN_OPTIONS=detect_leaks=1 UBSAN_OPTIONS=print_stacktrace=1
  export LSAN_OPTIONS="suppressions='$ROOT/src/tools/dev/leak_suppressions.txt':print_suppressions=0"
}

use_thread_sanitizer() {
  export TSAN_OPTIONS=second_deadlock_stack=1
}

# run_tests KIND BUILD_FOLDER JUNIT_FOLDER [TEST_FOLDER...]
# Two witnesses: ctest sees exit codes, the JUnit files name the failed cases and show a program without any case.
run_tests() {
  local kind=$1 build=$2 junit=$3 log="$RESULTS/$1.log" status=0
  shift 3
  say "test: $kind, ${*:-all folders of test/}"
  local parallel
  parallel=$(test_jobs)
  # Tests run side by side: with a BLAS thread for each core they would wait for each other's threads, up to twenty times
  # as long as they compute. ThreadSanitizer needs it, too: it sees races in libgomp, which is not instrumented.
  export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
  # What an earlier run left must neither hide nor fake a failure.
  rm -rf "$junit" "$log"
  mkdir -p "$junit" "$RESULTS"
  local stalls=""
  if [[ -n ${STALLS:-} ]]; then
    "$ROOT/src/tools/stall_cores.py" &
    stalls=$!
  fi
  (cd "$build" && ctest --parallel "$parallel" --output-on-failure --no-tests=error --timeout "${TEST_TIMEOUT:-900}" -R "$(name_pattern "$@")") || status=$?
  # Without real-time priority it has ended and said so: what passed then, passed without stalls.
  [[ -z $stalls ]] || kill "$stalls" 2>/dev/null || status=1
  cp "$build/Testing/Temporary/LastTest.log" "$log" || status=1
  say "test: summary of $kind"
  /usr/bin/python3 "$ROOT/src/tools/test_summary.py" "$junit" || status=1
  [[ $status -eq 0 ]] || fail "tests failed; the full output of all tests is in $log"
  echo "all passed; their full output is in $log"
}

# Sessions side by side need networks of their own; see in_own_network. Twice the cores: half of the tests mostly wait.
test_jobs() {
  if "$ROOT/src/tools/dev/in_own_network" --possible; then echo $((2 * $(jobs))); else echo 1; fi
}

# In the core, ctest's names begin with the folder of test/; with catkin they have it behind the kind of the test, except for
# a rostest with arguments, which is named after its file alone.
name_pattern() {
  [[ $# -gt 0 ]] || { echo . && return; }
  local folder name names=()
  for folder in "$@"; do
    name=${folder//\//_}
    names+=("^$name(_|\$)" "_(gtest|python)_${name}_")
    compgen -G "$ROOT/test/$folder/*.test" >/dev/null && names+=(_rostest_)
  done
  local IFS='|'
  echo "${names[*]}"
}

check_test_folders() {
  local folder folders
  folders=$(find "$ROOT/test" -mindepth 1 -maxdepth 2 -type d -not -name '__*' -printf '%P\n' | sort | xargs)
  for folder in "$@"; do
    [[ " $folders " == *" $folder "* ]] || misuse "no tests in '$folder'; the folders of test/ are: $folders"
  done
}
