#!/usr/bin/python3
"""Reads YAML files as the C++ programs do, with the numbers of YAML 1.2.

yaml.safe_load has those of YAML 1.1: 1e-6 is a text, 010 is 8, 1:30 is 90; and of a key that is there twice it takes the
last value.
"""
import re

import yaml

_INT, _FLOAT = 'tag:yaml.org,2002:int', 'tag:yaml.org,2002:float'


class _Loader(yaml.SafeLoader):
    yaml_implicit_resolvers = {
        first: [(tag, pattern) for tag, pattern in resolvers if tag not in (_INT, _FLOAT)]
        for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()}

    def construct_yaml_int(self, node):
        if re.match(r'[-+]?0[0-9]', node.value):
            raise yaml.constructor.ConstructorError(None, None, f'{node.value}: must be written without the leading zero: some '
                                                    'programs would read it as octal', node.start_mark)
        return int(node.value)

    def construct_mapping(self, node, deep=False):
        keys = [key for key, _ in node.value if isinstance(key, yaml.ScalarNode)]
        for number, key in enumerate(keys):
            if key.value in (other.value for other in keys[:number]):
                raise yaml.constructor.ConstructorError(None, None, f'{key.value}: is there twice; must be there once',
                                                        key.start_mark)
        return super().construct_mapping(node, deep)


_Loader.add_implicit_resolver(_INT, re.compile(r'[-+]?[0-9]+$'), '-+0123456789')
_Loader.add_implicit_resolver(
    _FLOAT, re.compile(r'[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?$|[-+]?\.(inf|Inf|INF)$|\.(nan|NaN|NAN)$'),
    '-+.0123456789')
_Loader.add_constructor(_INT, _Loader.construct_yaml_int)


def read(path):
    """Returns what is in the file. Raises OSError or yaml.YAMLError, which names the line."""
    with open(path, encoding='utf-8') as file:
        return yaml.load(file, _Loader)
