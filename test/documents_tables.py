"""The tables of the reference against code and configuration, and which documents links lead to."""
import re
from pathlib import Path

import yaml

from documents_checker import PACKAGE, Checker
from documents_project import NODE_FILES, TOPIC_CALL, flatten

DRIVERS = ('/phantom/', '/Geomagic/')  # topics of others that have an emulator here


def table_rows(text, heading):
    """{first cell's words in backquotes: cells} of the tables below a heading."""
    section = re.search(rf'^## {re.escape(heading)}\n(.*?)(?=^## |\Z)', text, re.MULTILINE | re.DOTALL)
    rows = {}
    for line in section.group(1).splitlines() if section else []:
        cells = [cell.strip() for cell in line.strip().strip('|').split('|')]
        for name in re.findall(r'`([^`]+)`', cells[0]) if line.startswith('|') else []:
            rows[name] = cells
    return rows


def check_parameters(project, text):
    """The tables of parameters.md are the files of config/, key by key and default by default."""
    problems = []
    for path in sorted(file for file in project.files if re.fullmatch(r'config/\w+\.yaml', file)):
        wanted = dict(flatten(yaml.compose(project.text(path))))
        rows = table_rows(text, path)
        problems += [f'{path}: {key} = {value} is not in the table' for key, value in wanted.items()
                     if rows.get(key, ['', None])[1] != value]
        problems += [f'{path}: the table has {key}, the file has not' for key in rows if key not in wanted]
    return problems


def fitted_keys(code):
    """{(node, key)} of the maps in session_fit.cpp by which parameters follow the cell."""
    names = dict(re.findall(r'(\bk\w+)\[\] = "(\w+)"', code))
    found = set()
    for keys in re.findall(r'const Keys k\w+ = (\{.*?\});', code, re.DOTALL):
        for node, listed in re.findall(r'\{("\w+"|k\w+),\s*\{([^}]*)\}\}', keys):
            found |= {(names.get(node, node.strip('"')), key) for key in re.findall(r'"([^"]+)"', listed)}
    return found


def check_fitted(project, text):
    """parameters.md says of each key that a session fits to its cell that it is fitted."""
    problems = []
    for node, key in sorted(fitted_keys(project.text('src/session/session_fit.cpp'))):
        row = table_rows(text, f'config/{node}.yaml').get(key)
        if row and 'fitted' not in row[-1]:
            problems.append(f'config/{node}.yaml: {key} is fitted to the cell, and the table does not say so')
    return problems


def check_topics(project, text):
    """Each topic that a node publishes or hears below a name of ours, and each service, is in topics_and_frames.md."""
    calls = {'/' + topic.lstrip('/') for topic in TOPIC_CALL.findall(project.sources(*NODE_FILES))}
    ours = {topic for topic in calls if topic.count('/') > 1 and not topic.startswith(DRIVERS)} | project.services
    return [f'{topic} is not in the tables' for topic in sorted(ours) if f'`{topic}`' not in text]


def files_of(project, node):
    """The files that a node is made of: its own, and what these include of src/nodes and benchmark."""
    found, waiting = set(), [f'src/nodes/{node}_node.cpp', f'src/nodes/programs/{node}.cpp',
                               f'benchmark/{node}/{node}_node.cpp']
    waiting += [path for path in project.code if node == 'haptic_device' and path.endswith('_adapter.cpp')]
    while waiting:
        path = waiting.pop()
        if path in project.code and path not in found:
            found.add(path)
            included = re.findall(r'#include "((?:nodes|benchmark)/[^"]+)"', project.code[path])
            included = [name if name.startswith('benchmark/') else f'src/{name}' for name in included]
            waiting += [name[:-1] + end for name in included for end in ('h', 'cpp')] + [path[:-3] + 'h']
    return found


def check_nodes(project, text):
    """Who publishes a topic is as the tables have it; who reads it knows its name."""
    problems, told = [], {}
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip().strip('|').split('|')]
        for topic in re.findall(r'`(/[a-z_/]+)`', cells[0]) if line.startswith('|') else []:
            nodes = [node for cell in cells[1:] for node in re.findall(r'`(\w+)`', cell) if node in project.programs]
            told[topic] = set(nodes) if len(cells) > 2 else set()
            problems += [f'{topic}: {node} does not know it' for node in nodes
                         if not re.search(rf'["/ ]{topic[1:]}\b', project.joined(files_of(project, node)))]
    for node in sorted(project.programs):
        own = project.joined(path for path in files_of(project, node) if Path(path).stem.startswith(node))
        for topic in re.findall(r'output<[^;()]*>\(\s*"([a-z_/]+)"', own):
            if node not in told.get(f'/{topic}', {node}):
                problems.append(f'/{topic}: {node} publishes it')
    return problems


def check_arguments(project, text):
    """The table of session.launch has its arguments, and the keys that they set or their defaults where the table gives one."""
    rows, arguments = table_rows(text, 'session.launch'), project.launch['session.launch']
    problems = [f'session.launch: {name} is not in the table' for name in arguments if name not in rows]
    problems += [f'session.launch: the table has {name}, the file has not' for name in rows if name not in arguments]
    for name, default in project.defaults['session.launch'].items():
        key = re.match(r'([a-z_.]+): ', arguments[name])
        default = key.group(1) if key and key.group(1) in project.session_keys else default
        told = re.fullmatch(r'`([^`]*)`', rows[name][1]) if name in rows else None
        if told and told.group(1) not in (default, default.replace(f'$(find {PACKAGE})/', '')) and '$(e' not in default:
            problems.append(f'session.launch: {name} = {default} is not in the table')
    return problems


def check_commands(project, text):
    """Every ./dev command and option of our programs is in commands.md."""
    problems = check_arguments(project, text)
    problems += [f'./dev {name} is not in the table' for name in project.dev if f'`./dev {name}' not in text]
    for program in ('aspirate', 'indent', 'prepare', 'trajectory_error', 'emulate', 'measure_cell', 'session'):
        hidden = {'--help', '--ray', '--at', '--member', '--axis', '--check'}
        rows = table_rows(text, program)
        problems += [f'{program} {option} is not in the table' for option in sorted(project.programs[program] - hidden)
                     if option not in rows]
    return problems


def check_scene_keys(project, text):
    """Every key that the scene's readers ask for is in scene_file.md."""
    code = project.sources('src/cell/model/scene.cpp', 'src/cell/model/puncture_config.cpp', 'src/cell/model/tensegrity_scene.cpp')
    keys = set(re.findall(r'(?:read\w*\(\w+|\.(?:section|sections|choice|text|integer|number|vector|has))[(,]\s*"([a-z_]+)"', code))
    return [f'the key {key} is not in the tables' for key in sorted(keys) if not re.search(rf'[`/]{key}[`/]', text)]


# In the comment of a number of a scene, or of the key that it is under.
ORIGIN = re.compile(r'Table |section |\[\d+\]|of the paper|measured|computed|fitted|chosen|assumed|illustrative')
CHOICES = {'offset', 'requirements'}  # of who uses the cell


def check_origins(project):
    """Each number of a scene of the package says whether it was published (where), computed, fitted, assumed or is illustrative."""
    problems = []
    for path in sorted(path for path in project.files if path.startswith('config/cells/')):
        lines = project.text(path).splitlines()

        def walk(node, above):
            """`above`: whether the key above tells it."""
            for key, value in node.value if isinstance(node, yaml.MappingNode) else [(None, item) for item in node.value]:
                line = (key or value).start_mark.line
                own = bool(key and ORIGIN.search(lines[line].partition('#')[2]))
                if key and key.value in CHOICES:
                    continue
                if not isinstance(value, yaml.ScalarNode):
                    walk(value, own or (above and key is None))
                elif re.fullmatch(r'[-+]?[\d.]+(e[-+]?\d+)?', value.value) and not own and not above:
                    problems.append(f'{path}, line {line + 1}: {lines[line].strip()}: where is it from?')
        walk(yaml.compose('\n'.join(lines)), False)
    return problems


def check_defaults(project):
    """What a document calls the default of a session ("the default cell, `NAME`") is that of config/sessions/default.yaml."""
    keys = {'cell': 'cell', 'rig': 'rig/name', 'hand': 'hand/device', 'motion': 'hand/motion', 'model': 'model'}
    defaults = dict(flatten(yaml.compose(project.text('config/sessions/default.yaml'))))
    return [f'{path}: the default {word} is {defaults.get(keys[word])}, not {name}' for path in project.documents
            for word, name in re.findall(rf'[Tt]he default\s+({"|".join(keys)}),?\s+(?:is\s+)?`(\w+)`', project.text(path))
            if defaults.get(keys[word]) != name]


def reachable(project, start='README.md'):
    """The documents that links lead to."""
    found, waiting = set(), [start]
    while waiting:
        path = waiting.pop()
        if path in found or path not in project.files:
            continue
        found.add(path)
        if path.endswith('.md'):
            waiting += [Checker.resolve(path, target) for target in re.findall(r'\]\(([^)#\s]+)', project.text(path))
                        if '://' not in target]
    return found
