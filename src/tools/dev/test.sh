# shellcheck shell=bash
# ./dev test: builds the tests, runs them with ctest, and sums the results up.

readonly RESULTS="$ROOT/out/test"

command_test() {
  local kind=ros
  if [[ ${1:-} == --core ]]; then
    kind=core
    shift
  fi
  check_test_folders "$@"
  setup
  "test_$kind" "$@"
}

test_ros() {
  build_workspace
  build_workspace tests
  cmake --install "$WORKSPACE/build" --component tests >/dev/null || fail "the tests of the chain could not be installed"
  use_private_master
  run_tests ros "$WORKSPACE/build" "$WORKSPACE/build/test_results" "$@"
}

test_core() {
  build_core
  # Makes each gtest program write a JUnit file there.
  export GTEST_OUTPUT="xml:$RESULTS/core/"
  run_tests core "$CORE_BUILD" "$RESULTS/core" "$@"
}

# run_tests KIND BUILD_FOLDER JUNIT_FOLDER [TEST_FOLDER...]
# Two witnesses: ctest sees exit codes, the JUnit files name the failed cases and show a program without any case.
run_tests() {
  local kind=$1 build=$2 junit=$3 log="$RESULTS/$1.log" status=0
  shift 3
  say "test: $kind, ${*:-all folders of test/}"
  # What an earlier run left must neither hide nor fake a failure.
  rm -rf "$junit" "$log"
  mkdir -p "$junit" "$RESULTS"
  (cd "$build" && ctest --parallel "$(jobs)" --output-on-failure --no-tests=error --timeout 900 -R "$(name_pattern "$@")") || status=$?
  cp "$build/Testing/Temporary/LastTest.log" "$log" || status=1
  say "test: summary of $kind"
  /usr/bin/python3 "$ROOT/src/tools/test_summary.py" "$junit" || status=1
  [[ $status -eq 0 ]] || fail "tests failed; the full output of all tests is in $log"
  echo "all passed; their full output is in $log"
}

# In the core, ctest's names begin with the folder of test/; with catkin they have it behind the kind of the test, except for
# a rostest with arguments, which is named after its file alone.
name_pattern() {
  [[ $# -gt 0 ]] || { echo . && return; }
  local folder names=()
  for folder in "$@"; do
    names+=("^$folder(_|\$)" "_(gtest|python)_${folder}_")
    compgen -G "$ROOT/test/$folder/*.test" >/dev/null && names+=(_rostest_)
  done
  local IFS='|'
  echo "${names[*]}"
}

check_test_folders() {
  local folder folders
  folders=$(find "$ROOT/test" -mindepth 1 -maxdepth 1 -type d -not -name '__*' -printf '%f ' | xargs -n1 | sort | xargs)
  for folder in "$@"; do
    [[ " $folders " == *" $folder "* ]] || misuse "no tests in '$folder'; the folders of test/ are: $folders"
  done
}
