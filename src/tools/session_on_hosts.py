#!/usr/bin/python3
"""A session over several hosts: starts the nodes that run on this one, after the hosts have been checked.

    session_on_hosts.py --hosts FILE --host NAME [ARGUMENT:=VALUE ...]   on each host, the master's first
    session_on_hosts.py --hosts FILE --ssh [ARGUMENT:=VALUE ...]         on the master's host: roslaunch starts the others
    session_on_hosts.py --hosts FILE --list [ARGUMENT:=VALUE ...]        prints which node runs where

The arguments are those of session.launch but `only`, the same on every host: session:=FILE names the session. A host does
not start when it cannot be reached both ways, its clock is off, its messages are of another version, or the session differs.
"""
import argparse
import errno
import hashlib
import os
import shlex
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import host_check  # noqa: E402
import hosts_file  # noqa: E402

MASTER_PORT = 11311
DIGEST = '/hosts/session'  # parameter: of the hosts file and the session
SESSION_DIGEST = '/session/digest'  # parameter that session.launch sets: of all files that the session is made from
PATIENCE = 120             # s for the master's host to start


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--hosts', type=Path, required=True, help='hosts file (config/hosts.yaml)')
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument('--host', help='name of this host in the file')
    what.add_argument('--ssh', action='store_true', help='start the nodes of all hosts from here, by ssh')
    what.add_argument('--list', action='store_true', help='only print which node runs where')
    parser.add_argument('--check-only', action='store_true', help='with --host: check, start nothing; the master\'s host only answers')
    parser.add_argument('arguments', nargs='*', metavar='ARGUMENT:=VALUE')
    arguments = parser.parse_args()
    wrong = [text for text in arguments.arguments if ':=' not in text]
    if wrong:
        parser.error(f'{wrong[0]}: must be ARGUMENT:=VALUE')
    if any(text.startswith('only:=') for text in arguments.arguments):
        parser.error('only: must be left out, because the hosts file says which node runs where')
    return arguments


def digest(arguments, config):
    """Of what all hosts must have in common: the hosts file, the arguments and all files that the session is made from."""
    parts = [arguments.hosts.read_bytes(), *(text.encode() for text in sorted(arguments.arguments)),
             str(config.params[SESSION_DIGEST].value).strip().encode()]
    return hashlib.md5(b'\0'.join(parts)).hexdigest()


def launch_files(arguments, only=()):
    """Of the nodes `only`; without, of all."""
    import roslaunch.rlutil
    words = [*arguments.arguments, *([f'only:={" ".join(only)}'] if only else [])]
    names = roslaunch.rlutil.resolve_launch_arguments(['cell_microinjection', 'session.launch', *words])
    return [(name, words) for name in names]


def loader(host):
    """Returns the command of a shell, before the command that it runs on the host: roslaunch itself sets no ROS_IP there."""
    return f'env -u ROS_HOSTNAME ROS_IP={host.address} {shlex.quote(host.env_loader)}'


def nodes_of(config, hosts, here):
    """Returns the names of the nodes of the host `here` in a roslaunch configuration. Raises HostsError without one."""
    names = [node.name for node in config.nodes if hosts.of_node(node.name) == here]
    if not names:
        raise hosts_file.HostsError(f'hosts/{here.name}/nodes: this session has none of them: nothing runs on this host')
    return names


def assign(config, hosts):
    """Gives each node of a roslaunch configuration the machine of its host."""
    from roslaunch.core import Machine
    for host in hosts.all.values():
        if host != hosts.master:
            config.add_machine(Machine(host.name, host.address, loader(host), user=host.user or None))
    for node in config.nodes:
        host = hosts.of_node(node.name)
        node.machine_name = None if host == hosts.master else host.name
    # The loader has assigned machines before, and does so only once.
    config._assign_machines_complete = False
    config.assign_machines()


def load(arguments):
    import roslaunch.config
    return roslaunch.config.load_config_default(launch_files(arguments), None)


def unknown_nodes(config, hosts):
    """Returns the nodes of the file that this session does not have: a name may be wrong, or an argument leaves it out."""
    names = {node.name for node in config.nodes}
    return [node for host in hosts.all.values() for node in host.nodes if node not in names]


def launch(arguments, hosts, here, config):
    """Starts the nodes of the host `here`; with None, those of all. `config`: of the whole session."""
    import roslaunch.parent
    import rospy

    class Launch(roslaunch.parent.ROSLaunchParent):
        def _load_config(self):
            super()._load_config()
            if here is None:
                assign(self.config, hosts)

    for node in unknown_nodes(config, hosts):
        print(f'session_on_hosts: {node}: this session has no such node', file=sys.stderr)
    uuid = roslaunch.rlutil.get_or_generate_uuid(None, here is not None and here != hosts.master)
    roslaunch.configure_logging(uuid)
    parent = Launch(uuid, launch_files(arguments, nodes_of(config, hosts, here) if here else ()), is_core=False)
    parent.start(auto_terminate=False)
    if here is None or here == hosts.master:
        rospy.set_param(DIGEST, digest(arguments, config))
    print(f'session_on_hosts: {here.name if here else "all hosts"}: started', flush=True)
    parent.spin()


class Door:
    """A port of this host that accepts connections, so that the master's host can try the way back."""

    def __init__(self, address):
        self._socket = socket.create_server((address, 0))
        self.port = self._socket.getsockname()[1]
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self):
        while True:
            try:
                self._socket.accept()[0].close()
            except OSError:
                return

    def close(self):
        self._socket.close()


def cannot_listen(here, error, port=None):
    """Returns a HostsError: the address is not one of this host, or the port is in use."""
    at = f', port {port}' if port else ''
    question = 'does a session run here already?' if error.errno == errno.EADDRINUSE else 'does this host have that address?'
    return hosts_file.HostsError(f'hosts/{here.name}/address = {here.address}{at}: this host cannot listen there: '
                                 f'{error.strerror or error}; {question}')


def checked(hosts, here):
    """Returns the errors of this host."""
    try:
        door = Door(here.address)
    except OSError as error:
        raise cannot_listen(here, error) from None
    try:
        return host_check.check((hosts.master.address, host_check.PORT), here.name, here, door.port, hosts.clock_limit)
    finally:
        door.close()


def wait_for_session(arguments, config):
    """Returns an error, or an empty text when the master's host has started the same session."""
    import rosgraph
    master, end = rosgraph.Master('/session_on_hosts'), time.monotonic() + PATIENCE
    while time.monotonic() < end:
        try:
            if master.hasParam(DIGEST):
                same = master.getParam(DIGEST) == digest(arguments, config)
                return '' if same else 'the master\'s host has another hosts file, another session or other arguments'
        except OSError:
            pass
        time.sleep(0.2)
    return f'the master\'s host has started no session within {PATIENCE} s'


def join(arguments, hosts, here):
    errors, config = checked(hosts, here), None
    if not errors and not arguments.check_only:
        config = load(arguments)
        error = wait_for_session(arguments, config)
        errors = [error] if error else []
    if errors:
        raise hosts_file.HostsError('\n'.join(errors))
    if arguments.check_only:
        print(f'session_on_hosts: {here.name}: reaches the master\'s host and is reached; clocks and messages agree')
        return
    launch(arguments, hosts, here, config)


def check_by_ssh(arguments, hosts):
    """Runs --check-only on each other host."""
    for host in hosts.all.values():
        if host == hosts.master:
            continue
        target = f'{host.user}@{host.address}' if host.user else host.address
        command = [loader(host), 'rosrun', 'cell_microinjection', 'session_on_hosts.py', '--hosts', '/dev/stdin',
                   '--host', shlex.quote(host.name), '--check-only']
        done = subprocess.run(['ssh', '-o', 'BatchMode=yes', target, *command], text=True, capture_output=True,
                              input=arguments.hosts.read_text(encoding='utf-8'))
        if done.returncode:
            raise hosts_file.HostsError(f'{host.name}: {(done.stderr or done.stdout).strip()}')


def run(arguments):
    hosts = hosts_file.load(arguments.hosts)
    if arguments.ssh:
        hosts.require_env_loaders()
    if arguments.list:
        for node in load(arguments).nodes:
            print(f'{hosts.of_node(node.name).name}: {node.name}')
        return
    here = hosts.named(arguments.host) if arguments.host else hosts.master
    os.environ.update(ROS_MASTER_URI=f'http://{hosts.master.address}:{MASTER_PORT}', ROS_IP=here.address)
    os.environ.pop('ROS_HOSTNAME', None)
    if here != hosts.master:
        return join(arguments, hosts, here)
    try:
        server = host_check.CheckServer(here.address)
    except OSError as error:
        raise cannot_listen(here, error, host_check.PORT) from None
    try:
        if arguments.ssh:
            check_by_ssh(arguments, hosts)
        if arguments.check_only:
            print(f'session_on_hosts: {here.name}: answers the checks of the others; Ctrl-C ends it', flush=True)
            threading.Event().wait()
        launch(arguments, hosts, None if arguments.ssh else here, load(arguments))
    finally:
        server.close()


def main():
    arguments = parse_arguments()
    try:
        run(arguments)
    except hosts_file.HostsError as error:
        sys.exit(f'session_on_hosts: {error}')
    except KeyboardInterrupt:
        pass
    except Exception as error:  # roslaunch's own, whose texts are for users
        if type(error).__module__.startswith('roslaunch'):
            sys.exit(f'session_on_hosts: {error}')
        raise


if __name__ == '__main__':
    main()
