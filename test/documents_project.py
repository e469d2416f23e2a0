"""What the documents of a project may name: its files, commands, launch files, topics, keys and identifiers."""
import os
import re
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import yaml

# Folders of the nodes' code.
NODE_FILES = ('src/nodes/*', 'src/nodes/*/*', 'benchmark/emulated_haptic/*')
SKIPPED = {'.git', 'out', 'build', 'catkin_ws', '__pycache__'}
TOPIC_CALL = re.compile(
    r'(?:advertise|output|input|subscribe|subscribeGuarded|follow)<[^;()]*>\(\s*(?:[\w.()]+,\s*)?"(/?[a-z_]+(?:/[a-z_]+)*)"')
OPTION = re.compile(r'\(\s*"([a-z][a-z-]*)(?:,\w)?",\s*(?:po::|boost::program_options::|"this text")')


def flatten(node, prefix=''):
    """Yields (key/of/a/value, the value's text) of a YAML tree; items of a list of maps have no index."""
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            yield from flatten(value, f'{prefix}/{key.value}' if prefix else key.value)
    elif isinstance(node, yaml.SequenceNode) and any(isinstance(item, yaml.MappingNode) for item in node.value):
        for item in node.value:
            yield from flatten(item, prefix)
    elif isinstance(node, yaml.SequenceNode):
        yield prefix, f'[{", ".join(getattr(item, "value", "") for item in node.value)}]'
    elif node is not None:
        yield prefix, node.value


def keys_of(text):
    """All keys of a YAML text, those of its commented examples, too."""
    shown = re.sub(r'^# (?=( {0,6})[a-z_]+:( +[#{["\w/+.-]|\s*$))', '', text, flags=re.MULTILINE)
    found = {key for key, _ in flatten(yaml.compose(text))}
    try:
        found |= {key for key, _ in flatten(yaml.compose(shown))}
    except yaml.YAMLError:
        pass
    return found


def files_below(root):
    """Paths from `root`, but for what was built or written."""
    for folder, folders, names in os.walk(root):
        folders[:] = set(folders) - SKIPPED
        yield from (Path(folder, name).relative_to(root).as_posix() for name in set(names) - SKIPPED)


class Project:
    """What the documents below `root` may name."""

    def __init__(self, root):
        self.root = root
        self.files = set(files_below(root))
        self.folders = {parent.as_posix() for path in self.files for parent in Path(path).parents}
        self.names = {Path(path).name for path in self.files}
        self.documents = sorted(path for path in self.files if path.endswith('.md'))
        self.code = {path: self.text(path) for path in self.files
                     if path.split('/')[0] in ('src', 'benchmark', 'launch', 'config', 'msg', 'srv', 'action', 'urdf', 'dev', 'package.xml', 'CMakeLists.txt',
                                               'dependencies.txt') and not path.endswith(('.csv', '.md'))}
        columns = [self.text(path).split('\n', 1)[0] for path in self.files if path.endswith('.csv')]
        self.words = set(re.findall(r'\w+', '\n'.join([*self.code.values(), *columns])))
        self.read_dev()
        self.read_launch_files()
        self.read_programs()
        self.read_nodes()
        self.keys = {key for path, text in self.code.items() if path.endswith('.yaml') for key in keys_of(text)}
        self.keys |= set(re.findall(r'<param[^>]* name="([a-z_/]+)"', self.sources('launch/*')))
        self.keys |= set(re.findall(r'"([a-z_]+(?:/[a-z_]+)+)"', self.sources('src/session/session_planner.cpp')))

    def text(self, path):
        return (self.root / path).read_text(errors='replace')

    def sources(self, *patterns):
        return '\n'.join(text for path, text in self.code.items() if any(Path(path).match(pattern) for pattern in patterns))

    def joined(self, paths):
        return '\n'.join(self.code[path] for path in paths)

    def read_dev(self):
        """{command of ./dev: its options}, as ./dev itself says."""
        def help_of(*arguments):
            return subprocess.run(['bash', str(self.root / 'dev'), *arguments, '--help'], check=True, text=True,
                                  stdout=subprocess.PIPE, stdin=subprocess.DEVNULL).stdout
        names = re.findall(r'^  (\w+)(?: NAME)?  ', help_of(), re.MULTILINE)
        self.dev = {name: set(re.findall(r'--[a-z][a-z-]*', help_of(name))) | {'--help'} for name in names}

    def read_launch_files(self):
        """{launch file: {argument: what is said of it}}; a fixed value is no argument."""
        self.launch, self.defaults = {}, {}
        for path in self.files:
            if path.startswith('launch/') and path.endswith('.launch'):
                tree = ElementTree.fromstring(self.text(path))
                self.launch[path[len('launch/'):]] = {
                    arg.get('name'): f'{arg.get("doc", "")} {arg.get("default")}' for arg in tree.iter('arg')
                    if arg.get('default') is not None or arg.get('doc')}
                self.defaults[path[len('launch/'):]] = {
                    arg.get('name'): arg.get('default') for arg in tree.iter('arg') if arg.get('default') is not None}
        self.arguments = {name for arguments in self.launch.values() for name in arguments}
        default = 'config/sessions/default.yaml'
        keys = flatten(yaml.compose(self.text(default))) if default in self.files else ()
        self.session_keys = {key.replace('/', '.') for key, _ in keys} | {'overrides'}

    def read_programs(self):
        """{program: the options it knows}; empty for a node."""
        self.programs = {Path(path).stem.removesuffix('_node'): set() for path in self.files
                         if Path(path).match('src/nodes/programs/*.cpp') or Path(path).match('benchmark/*/*_node.cpp')}
        self.benches = {}
        for path, text in self.code.items():
            options = set(re.findall(r"""add_argument\(\s*['"](--[a-z-]+)""", text))
            options |= {f'--{name}' for name in OPTION.findall(text)}
            place = Path(path)
            if place.parent.as_posix() == 'src/nodes/programs' and options:
                self.programs[place.stem] = options
            elif place.parent.as_posix() == 'src/commands' and 'main(' in text:
                shared = self.sources(f'src/commands/{place.stem}_*.cpp')
                options |= {f'--{name}' for name in OPTION.findall(shared)}
                self.programs[place.stem] = options
            elif place.parent.as_posix() == 'benchmark' and not place.name.startswith('plot_') and place.suffix in ('.cpp', '.py'):
                self.benches[place.stem] = options
            elif place.suffix == '.py' and place.parent.as_posix() in ('src/tools', 'benchmark/paper'):
                renamed = f'RENAME {place.stem})' in self.text('src/nodes/CMakeLists.txt')
                self.programs[place.stem if renamed else place.name] = options
        self.options = set().union(*self.programs.values(), *self.benches.values(), *self.dev.values())

    def read_nodes(self):
        """Topics, services and global parameters, as the code has them."""
        text = self.sources(*NODE_FILES)
        self.topics = {'/' + topic.lstrip('/') for topic in TOPIC_CALL.findall(text)}
        self.topics |= set(re.findall(r'"(/[a-z_]+(?:/[a-z_]+)*)"', text))
        self.topics |= {'/' + topic for topic in re.findall(r'"([a-z_]+/[a-z_]+(?:/[a-z_]+)?)"', text)}
        # A session runs the micromanipulator a second time, with these names.
        self.topics |= {topic.replace('/needle/', '/holder_rig/') for topic in self.topics}
        self.topics |= {f'/controller/inject/{part}' for part in ('goal', 'cancel', 'status', 'feedback', 'result')}
        self.services = set()
        for path, source in self.code.items():
            if path.endswith('_node.cpp'):
                node = Path(path).stem[:-len('_node')]
                parts = re.findall(r'#include "(nodes/[^"]+)\.h"', source + self.code.get(f'{path[:-3]}h', ''))
                source += ''.join(self.code.get(f'src/{part}.cpp', '') for part in parts)
                self.services |= {f'/{node}/{name}' for name in re.findall(r'advertiseService[^;"]*\(\s*"~(\w+)"', source)}
        self.topics |= self.services
        self.topics |= set(re.findall(r'<param name="(/[a-z_/]+)"', self.sources('launch/*')))
        self.topics |= {'/use_sim_time'} & set(re.findall(r'/[a-z_/]+', self.sources('launch/*')))
        self.parts = {part for name in self.topics for part in ('/'.join(name.split('/')[:n]) for n in range(2, 5))}
