#!/usr/bin/python3
"""What is checked between two hosts before a session starts: the way in both directions, clocks, versions of messages.

The master's host answers (CheckServer), each other host asks (check). Names need no check: nodes announce themselves by
the address of their host, because session_on_hosts.py sets ROS_IP on each host, over ssh too.
"""
import importlib
import pkgutil
import socket
import threading
import time
from contextlib import closing
from http.client import HTTPException
from socketserver import ThreadingMixIn
from xml.parsers.expat import ExpatError
from xmlrpc.client import Error, ServerProxy, Transport
from xmlrpc.server import SimpleXMLRPCRequestHandler, SimpleXMLRPCServer

PORT = 11312      # beside the master's
EXCHANGES = 20    # of the clocks' readings; the fastest counts
PATIENCE = 5      # s for a connection
ANSWER = 5        # s more for an answer, which may itself wait for a connection
PACKAGE = 'cell_microinjection'


def message_versions(package=PACKAGE):
    """Returns {type: MD5 of its definition} of all messages and services, as roscpp compares them."""
    versions = {}
    for kind in ('msg', 'srv'):
        module = importlib.import_module(f'{package}.{kind}')
        for _, name, _ in pkgutil.iter_modules(module.__path__):
            kinds = importlib.import_module(f'{package}.{kind}.{name}')
            versions.update({f'{kind}/{cls}': getattr(kinds, cls)._md5sum for cls in vars(kinds)
                             if hasattr(getattr(kinds, cls), '_md5sum')})
    return versions


def connects(address, port):
    """Returns an error, or an empty text: of a TCP connection."""
    try:
        with closing(socket.create_connection((address, port), PATIENCE)):
            return ''
    except OSError as error:
        return str(error)


class _Handler(SimpleXMLRPCRequestHandler):
    protocol_version = 'HTTP/1.1'     # one connection for all exchanges: a new one would be a part of the first half
    disable_nagle_algorithm = True


class _Server(ThreadingMixIn, SimpleXMLRPCServer):
    daemon_threads = True


class _ImpatientTransport(Transport):
    def make_connection(self, host):
        connection = super().make_connection(host)
        connection.timeout = PATIENCE + ANSWER
        return connection


class CheckServer:
    """Answers the other hosts' checks. `clock`: s, of this host; `versions`: of its messages."""

    def __init__(self, address, port=PORT, clock=time.time, versions=None):
        self._server = _Server((address, port), _Handler, logRequests=False, allow_none=True)
        self.port = self._server.server_address[1]
        for name, answer in (('time', clock), ('connects', connects),
                             ('versions', lambda: versions or message_versions())):
            self._server.register_function(answer, name)
        threading.Thread(target=self._server.serve_forever, daemon=True).start()

    def close(self):
        self._server.shutdown()
        self._server.server_close()


def clock_offset(ask, clock=time.time, exchanges=EXCHANGES):
    """Returns (offset, uncertainty) in s of the other clock from this one, from readings of it between two of this one.

    Of all exchanges the fastest is the most exact: the offset is certain within half of its duration, and exact where
    both ways are equally long (Cristian, "Probabilistic clock synchronization", Distributed Computing 3 (1989) 146).
    """
    ask()  # which opens the connection
    best = None
    for _ in range(exchanges):
        before = clock()
        other = ask()
        after = clock()
        found = (other - 0.5 * (before + after), 0.5 * (after - before))
        best = found if best is None or found[1] < best[1] else best
    return best


def check(server, name, host, own_port, limit, clock=time.time, versions=None):
    """Returns the errors between this host (its name and Host) and that of `server` (address, port).

    `own_port`: one of this host that accepts connections; `limit`: largest offset of the clocks, s.
    """
    address, port = server
    error = connects(address, port)
    if error:
        return [f'{name} does not reach {address}:{port}: {error}; is the session of the master\'s host started?']
    errors = []
    try:
        with ServerProxy(f'http://{address}:{port}', transport=_ImpatientTransport(), allow_none=True) as other:
            back = other.connects(host.address, own_port)
            if back:
                errors.append(f'the master\'s host does not reach {name} at {host.address}:{own_port}: {back}')
            offset, uncertainty = clock_offset(other.time, clock)
            if abs(offset) > limit:
                errors.append(f'the clock of {name} is {-1e3 * offset:+.1f} ms from the master\'s (within '
                              f'{1e3 * uncertainty:.1f} ms), allowed {1e3 * limit:g} ms; does chrony or PTP run on both?')
            errors += _compare(name, versions or message_versions(), other.versions())
    except (OSError, Error, HTTPException, ExpatError) as error:  # the last three: of another service on that port
        errors.append(f'{name}: the check with {address}:{port} failed: {error}')
    return errors


def _compare(name, own, other):
    different = sorted(kind for kind in own.keys() | other.keys() if own.get(kind) != other.get(kind))
    return [f'{name} has another version of {", ".join(different)} than the master\'s host: build both from one commit'
            ] if different else []
