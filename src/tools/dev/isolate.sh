# shellcheck shell=bash
# ./dev shell --isolated: a network namespace that has the loopback interface only. roscpp and the ROS master listen on every
# interface and ask nobody who they are; here there is none that others could come through.

readonly NAMESPACE=cell_microinjection

# Runs a command in the namespace, which is made when it is not there yet and shared by all such shells, so that nodes in
# several terminals find each other. As the caller, with the caller's environment and limits.
run_isolated() {
  command -v ip >/dev/null || fail "shell --isolated needs the program ip (package iproute2)"
  if ! as_root ip netns list | grep -qw "$NAMESPACE"; then
    as_root ip netns add "$NAMESPACE" || fail "shell --isolated: the system allows no network namespace (message above)"
  fi
  as_root ip -n "$NAMESPACE" link set lo up || fail "shell --isolated: no loopback interface (message above)"
  use_local_names
  export ROS_MASTER_URI=http://127.0.0.1:11311
  if [[ $EUID -eq 0 ]]; then
    exec ip netns exec "$NAMESPACE" "$@"
  fi
  # sudo keeps neither the environment nor the limits that real time needs.
  exec sudo -E prlimit --rtprio="$(ulimit -r)" --nice="$(ulimit -e)" -- ip netns exec "$NAMESPACE" \
    setpriv --reuid "$EUID" --regid "$(id -g)" --init-groups --inh-caps=-all -- env "PATH=$PATH" \
    "LD_LIBRARY_PATH=${LD_LIBRARY_PATH:-}" "PYTHONPATH=${PYTHONPATH:-}" "HOME=$HOME" "$@"
}
