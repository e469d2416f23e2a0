#!/usr/bin/python3
"""The file that says which host runs which node: config/hosts.yaml."""
import ipaddress
from dataclasses import dataclass, field

import yaml

import yaml_file

KEYS = {'master': str, 'clock_limit': (int, float), 'hosts': dict}
HOST_KEYS = {'address': str, 'nodes': list, 'user': str, 'env_loader': str}
LARGEST_CLOCK_LIMIT = 0.025  # s: half of the shortest time-out


class HostsError(Exception):
    """A message for the user."""


@dataclass(frozen=True)
class Host:
    name: str
    address: str
    nodes: tuple = ()
    user: str = ''
    env_loader: str = ''


@dataclass(frozen=True)
class Hosts:
    master: Host
    clock_limit: float                         # s
    all: dict = field(default_factory=dict)    # {name: Host}

    def of_node(self, name):
        """Returns the host of a node (its name without namespace)."""
        return next((host for host in self.all.values() if name in host.nodes), self.master)

    def named(self, name):
        if name not in self.all:
            raise HostsError(f'--host = {name}: must be one of {", ".join(self.all)}')
        return self.all[name]

    def require_env_loaders(self):
        """Raises HostsError for each host but the master's without one: roslaunch would take a path of its own."""
        missing = [name for name, host in self.all.items() if host != self.master and not host.env_loader]
        if missing:
            raise HostsError('\n'.join(f'hosts/{name}/env_loader is missing: --ssh needs it' for name in missing))


def _check(where, values, keys, required):
    errors = [f'{where}{key}: unknown key; known here: {", ".join(keys)}' for key in values if key not in keys]
    errors += [f'{where}{key} is missing' for key in required if key not in values]
    for key, kind in keys.items():
        if key in values and (not isinstance(values[key], kind) or isinstance(values[key], bool)):
            kinds = kind if isinstance(kind, tuple) else (kind,)
            errors.append(f'{where}{key} = {values[key]}: must be of type {kinds[-1].__name__}')
    return errors


def _check_host(where, host):
    errors = _check(where, host, HOST_KEYS, ('address',))
    address = host.get('address')
    if isinstance(address, str):
        try:
            ipaddress.ip_address(address)
        except ValueError:
            errors.append(f'{where}address = {address}: must be an IP address, which no name server can change')
    loader = host.get('env_loader')
    if isinstance(loader, str) and loader and not loader.startswith('/'):
        errors.append(f'{where}env_loader = {loader}: must be an absolute path: the remote shell does not expand ~')
    if isinstance(host.get('nodes'), list):
        errors += [f'{where}nodes: {node}: must be the name of a node' for node in host['nodes'] if not isinstance(node, str)]
    return errors


def load(path):
    """Returns Hosts. Raises HostsError with all errors at once."""
    try:
        values = yaml_file.read(path)
    except (OSError, yaml.YAMLError) as error:
        raise HostsError(f'{path}: {error}') from None
    if not isinstance(values, dict):
        raise HostsError(f'{path}: must be a YAML map')
    errors = _check('', values, KEYS, ('master', 'hosts'))
    hosts = values['hosts'] if isinstance(values.get('hosts'), dict) else {}
    for name, host in hosts.items():
        errors += _check_host(f'hosts/{name}/', host) if isinstance(host, dict) else [f'hosts/{name}: must be a map']
    if not errors:
        errors += _check_all(values, hosts)
    if errors:
        raise HostsError('\n'.join(f'{path}: {error}' for error in errors))
    made = {name: Host(name, host['address'], tuple(host.get('nodes', ())), host.get('user', ''), host.get('env_loader', ''))
            for name, host in hosts.items()}
    return Hosts(made[values['master']], float(values.get('clock_limit', 0.005)), made)


def _check_all(values, hosts):
    errors = []
    if values['master'] not in hosts:
        errors.append(f'master = {values["master"]}: must be one of the hosts: {", ".join(hosts)}')
    limit = values.get('clock_limit', 0.005)
    if not 0 < limit <= LARGEST_CLOCK_LIMIT:
        errors.append(f'clock_limit = {limit}: must be above 0, up to {LARGEST_CLOCK_LIMIT} s')
    nodes = [node for host in hosts.values() for node in host.get('nodes', ())]
    errors += [f'{node}: two hosts run it; must be one' for node in sorted({node for node in nodes if nodes.count(node) > 1})]
    addresses = [host['address'] for host in hosts.values()]
    errors += [f'address = {address}: two hosts have it' for address in sorted({a for a in addresses if addresses.count(a) > 1})]
    return errors
