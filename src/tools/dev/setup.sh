# shellcheck shell=bash
# ./dev setup: the packages of dependencies.txt that this machine lacks; --peers, --cluster, --training: those of
# benchmark/peers, src/workflow or src/vision/segmentation_training, too.

command_setup() {
  [[ $* == "" || $* == --peers || $* == --cluster || $* == --training ]] ||
    misuse "setup takes nothing, --peers, --cluster or --training, not '$*'"
  setup
  case $* in
    --peers)
      [[ $(package_column) == 1 ]] || fail "the programs of ./dev bench peers are packages of Debian 12"
      install_list benchmark/peers/dependencies.txt 1
      touch "$ROOT/benchmark/peers/CMakeLists.txt"  # the next build looks for Bullet again
      ;;
    --cluster)
      [[ $(package_column) == 1 ]] || fail "the profiles in config/workflow need Snakemake 7.8 or later: take it from its makers"
      install_list src/workflow/dependencies.txt 1
      ;;
    --training) setup_training ;;
  esac
}

setup_training() {
  [[ $(package_column) == 1 ]] || fail "./dev train needs PyTorch 1.13 as Debian 12 has it: take it from its makers"
  install_list "$TRAINING/dependencies.txt" 1
}

setup() {
  if [[ -n ${MICROINJECTION_SKIP_SETUP:-} ]]; then
    say "setup: skipped (MICROINJECTION_SKIP_SETUP is set)"
    return
  fi
  resolve_localhost
  install_list dependencies.txt "$(package_column)"
}

# install_list FILE COLUMN: the packages of a list, named as for this system.
install_list() {
  local missing
  missing=$(missing_packages "$@")
  if [[ -z $missing ]]; then
    say "setup: all packages of $1 are there"
    return
  fi
  # shellcheck disable=SC2086
  set -- "$@" $missing
  say "setup: installing $(($# - 2)) missing packages: ${*:3}"
  install_packages "${@:3}"
  missing=$(missing_packages "$1" "$2")
  [[ -z $missing ]] || fail "apt-get did not install:" "$missing"
  prepare_environment  # ROS may have arrived
}

# roslaunch insists on resolving "localhost"; a container or chroot may have no /etc/hosts.
resolve_localhost() {
  ! getent hosts localhost >/dev/null || return 0
  say "setup: this machine does not know 'localhost'; adding it to /etc/hosts"
  echo "127.0.0.1 localhost" | as_root tee -a /etc/hosts >/dev/null || fail "could not write to /etc/hosts"
}

# 1 or 2: the column of dependencies.txt that is for this system.
package_column() {
  local ID="" VERSION_ID="" PRETTY_NAME="an unknown system"
  # shellcheck source=/dev/null
  [[ ! -f /etc/os-release ]] || source /etc/os-release
  case $ID-$VERSION_ID in
    debian-12) echo 1 ;;
    ubuntu-20.04) echo 2 ;;
    *) fail "setup knows Debian 12 and Ubuntu 20.04 with ROS Noetic, and this is $PRETTY_NAME." \
        "Install the like of dependencies.txt yourself and set MICROINJECTION_SKIP_SETUP=1." ;;
  esac
}

# The packages of column $2 of the list $1 that are not installed, on one line each.
missing_packages() {
  local wanted installed
  wanted=$(sed -e 's/#.*//' "$ROOT/$1" | awk -v column="$2" 'NF && $column != "-" {print $column}' | sort -u)
  # dpkg-query fails when it has never heard of one of them, and still answers for the others.
  # shellcheck disable=SC2086
  installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' $wanted 2>/dev/null || true)
  comm -23 <(echo "$wanted") <(echo "$installed" | awk '$1 == "installed" {print $2}' | sort -u)
}

install_packages() {
  if ! apt_get --simulate install "$@" >/dev/null 2>&1; then
    update_package_lists
    apt_get --simulate install "$@" >/dev/null || explain_missing_source
  fi
  if ! apt_get install "$@"; then
    say "setup: once more, with fresh package lists"
    update_package_lists
    apt_get install "$@" || fail "apt-get could not install the packages (its message is above)"
  fi
}

update_package_lists() {
  say "setup: apt-get update"
  apt_get update || fail "apt-get update failed (its message is above); is there a network?"
}

explain_missing_source() {
  fail "apt-get does not know all packages (its message is above). Its sources need, on Debian 12, the main archive;" \
    "on Ubuntu 20.04, universe and packages.ros.org (http://wiki.ros.org/noetic/Installation/Ubuntu)"
}

apt_get() {
  local apt=(env DEBIAN_FRONTEND=noninteractive apt-get -y -q --no-install-recommends
    -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3)
  if [[ $1 == --simulate ]]; then
    "${apt[@]}" "$@"
  else
    as_root "${apt[@]}" "$@"
  fi
}

as_root() {
  if [[ $EUID -eq 0 ]]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    fail "this is neither root nor is there sudo; let root run ./dev setup, or: $*"
  fi
}
