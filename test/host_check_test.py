#!/usr/bin/python3
"""The hosts file, and what is checked between two hosts before a session."""
import socket
import sys
import tempfile
import threading
import time
import unittest
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from unittest import mock

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / 'src' / 'tools'))

import host_check  # noqa: E402
import hosts_file  # noqa: E402
import session_on_hosts  # noqa: E402

VERSIONS = {'msg/A': '1', 'msg/B': '2'}
HERE = '127.0.0.1'
LIMIT = 0.005  # s


class HostsFile(unittest.TestCase):
    def load(self, text):
        with tempfile.NamedTemporaryFile('w', suffix='.yaml') as file:
            file.write(text)
            file.flush()
            return hosts_file.load(file.name)

    def refused(self, text, *messages):
        with self.assertRaises(hosts_file.HostsError) as caught:
            self.load(text)
        for message in messages:
            self.assertIn(message, str(caught.exception))

    def test_the_shipped_file_places_nodes(self):
        hosts = hosts_file.load(ROOT / 'config/hosts.yaml')
        self.assertEqual(hosts.of_node('cell_simulator').name, 'solver')
        self.assertEqual(hosts.of_node('micromanipulator'), hosts.master)
        with self.assertRaisesRegex(hosts_file.HostsError, '--host = moon: must be one of rig, haptic, solver'):
            hosts.named('moon')

    def test_numbers_are_those_of_the_programs(self):
        text = '{master: a, clock_limit: %s, hosts: {a: {address: 1.1.1.1}}}'
        for number, value in (('5e-3', 0.005), ('1e-06', 1e-6), ('.01', 0.01), ('5.0E-3', 0.005)):
            self.assertEqual(self.load(text % number).clock_limit, value)
        self.refused(text % '1:30', 'clock_limit = 1:30: must be of type float')

    def test_all_errors_are_named(self):
        self.refused('{master: a, hosts: {a: {address: rig.lab, colour: red}, b: {nodes: [x]}}, speed: 3}',
                     'speed: unknown key', 'hosts/a/colour: unknown key', 'address = rig.lab: must be an IP address',
                     'hosts/b/address is missing')
        self.refused('{master: c, clock_limit: 0.5, hosts: {a: {address: 1.1.1.1, nodes: [x]}, b: {address: 1.1.1.1, '
                     'nodes: [x]}}}', 'master = c: must be one of the hosts: a, b', 'clock_limit = 0.5: must be above 0',
                     'x: two hosts run it', '1.1.1.1: two hosts have it')
        self.refused('{master: a, hosts: {a: {address: 1.1.1.1, nodes: 5}, b: {address: 1.1.1.2, nodes: [7]}}}',
                     'hosts/a/nodes = 5: must be of type list', 'hosts/b/nodes: 7: must be the name of a node')
        for loader in ('~lab/env.sh', 'env.sh'):
            self.refused('{master: a, hosts: {a: {address: 1.1.1.1, env_loader: %s}}}' % loader,
                         f'hosts/a/env_loader = {loader}: must be an absolute path')
        self.refused('[]', 'must be a YAML map')
        self.refused('{master: a, master: b}', 'master: is there twice', 'line 1')
        self.refused('master: a\nclock_limit: 010\n', '010: must be written without the leading zero', 'line 2')
        self.refused('{master: [', 'while parsing')

    def test_by_ssh_every_other_host_needs_a_loader(self):
        text = '{master: a, hosts: {a: {address: 1.1.1.1}, b: {address: 1.1.1.2%s}}}'
        with self.assertRaisesRegex(hosts_file.HostsError, '^hosts/b/env_loader is missing'):
            self.load(text % '').require_env_loaders()
        hosts = self.load(text % ', env_loader: /opt/my lab/env.sh')
        hosts.require_env_loaders()
        self.assertEqual(session_on_hosts.loader(hosts.named('b')),
                         "env -u ROS_HOSTNAME ROS_IP=1.1.1.2 '/opt/my lab/env.sh'")


class Addresses(unittest.TestCase):
    """192.0.2.1 is kept for documents: no host has it."""

    def hosts(self, address):
        host, master = hosts_file.Host('b', address), hosts_file.Host('a', HERE)
        return hosts_file.Hosts(master, LIMIT, {'a': master, 'b': host}), host

    def test_an_address_of_another_host(self):
        with self.assertRaisesRegex(hosts_file.HostsError, 'hosts/b/address = 192.0.2.1: this host cannot listen there: .*have that address'):
            session_on_hosts.checked(*self.hosts('192.0.2.1'))

    def test_a_port_that_is_in_use(self):
        taken = socket.create_server((HERE, 0))
        self.addCleanup(taken.close)
        with self.assertRaises(OSError) as caught:
            host_check.CheckServer(HERE, taken.getsockname()[1])
        error = session_on_hosts.cannot_listen(hosts_file.Host('a', HERE), caught.exception, host_check.PORT)
        self.assertRegex(str(error), 'hosts/a/address = 127.0.0.1, port 11312: .*in use; does a session run here already')


class HostCheck(unittest.TestCase):
    def check(self, own_clock=time.time, own_versions=None, server=True, door=True, **changes):
        self.host = hosts_file.Host('here', HERE)
        listener = socket.create_server((HERE, 0))
        self.addCleanup(listener.close)
        port = listener.getsockname()[1]
        if not door:
            listener.close()
        answer = host_check.CheckServer(HERE, 0, **{'versions': VERSIONS, **changes})
        self.addCleanup(answer.close)
        if not server:
            answer.close()
        return host_check.check((HERE, answer.port), 'here', self.host, port, LIMIT, own_clock, own_versions or VERSIONS)

    def test_good_hosts(self):
        self.assertEqual(self.check(), [])

    def test_clocks_that_are_apart(self):
        for offset in (0.02, -0.02):
            errors = self.check(clock=lambda offset=offset: time.time() + offset)
            self.assertEqual(len(errors), 1)
            self.assertRegex(errors[0], f'clock of here is {"-" if offset > 0 else "[+]"}(19|20|21)[.].* ms from the master')
        self.assertEqual(self.check(clock=lambda: time.time() + 0.002), [])

    def test_ways_that_are_closed(self):
        self.assertRegex(self.check(server=False)[0], 'here does not reach 127.0.0.1:.*refused')
        self.assertRegex(self.check(door=False)[0], 'the master\'s host does not reach here at 127.0.0.1')

    def test_a_way_back_that_is_filtered(self):
        """No answer comes at all: the server gives up after PATIENCE, and the client waits for that."""
        connects = host_check.connects

        def filtered(address, port):
            if port != self.filtered:
                return connects(address, port)
            time.sleep(host_check.PATIENCE + 0.1)
            return 'timed out'

        listener = socket.create_server((HERE, 0))
        self.addCleanup(listener.close)
        self.filtered = listener.getsockname()[1]
        with mock.patch.multiple(host_check, PATIENCE=0.2, connects=filtered):
            answer = host_check.CheckServer(HERE, 0, versions=VERSIONS)
            self.addCleanup(answer.close)
            errors = host_check.check((HERE, answer.port), 'here', hosts_file.Host('here', HERE), self.filtered, LIMIT,
                                      versions=VERSIONS)
        self.assertEqual(len(errors), 1)
        self.assertRegex(errors[0], 'the master\'s host does not reach here at 127.0.0.1:[0-9]+: timed out')

    def test_another_service_on_the_port(self):
        for answer in (b'HTTP/1.0 404 Not Found\r\n\r\n', b'HTTP/1.0 200 OK\r\nContent-Type: text/xml\r\n\r\nno XML', b'SSH-2.0\r\n'):
            server = HTTPServer((HERE, 0), type('Other', (BaseHTTPRequestHandler,), {
                'handle': lambda self, answer=answer: (self.connection.recv(4096), self.connection.sendall(answer))}))
            self.addCleanup(server.server_close)
            self.addCleanup(server.shutdown)
            threading.Thread(target=server.serve_forever, daemon=True).start()
            errors = host_check.check(server.server_address, 'here', hosts_file.Host('here', HERE), 1, LIMIT, versions=VERSIONS)
            self.assertEqual(len(errors), 1)
            self.assertRegex(errors[0], 'here: the check with 127.0.0.1:[0-9]+ failed')

    def test_messages_of_another_version(self):
        errors = self.check(own_versions={'msg/A': '1', 'msg/B': '3', 'msg/C': '4'})
        self.assertEqual(errors, ['here has another version of msg/B, msg/C than the master\'s host: build both from one commit'])

    def test_the_offset_is_that_of_the_fastest_exchange(self):
        """A clock that is 7 ms ahead, behind a network that needs 1 to 20 ms to it and 1 ms back."""
        now = [100.0]
        delays = iter([0.05, 0.02, 0.005, 0.001, 0.012])  # of the first exchange nothing is kept

        def ask():
            now[0] += next(delays)
            reading = now[0] + 0.007
            now[0] += 0.001
            return reading

        offset, uncertainty = host_check.clock_offset(ask, lambda: now[0], 4)
        self.assertAlmostEqual(offset, 0.007)
        self.assertAlmostEqual(uncertainty, 0.001)


if __name__ == '__main__':
    unittest.main()
