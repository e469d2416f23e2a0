"""The tables of the reference against code and configuration, and which documents links lead to."""
import re

import yaml

from documents_checker import Checker
from documents_project import TOPIC_CALL, flatten


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


def check_topics(project, text):
    """Each topic and service that a node has is in topics_and_frames.md."""
    ours = {topic for topic in project.topics if topic.count('/') > 1 and not topic.startswith(
        ('/session', '/link/wave', '/proc', '/phantom', '/spacenav', '/controller/inject/', '/lockstep/participants'))}
    calls = {'/' + topic.lstrip('/') for topic in TOPIC_CALL.findall(project.sources('src/nodes/*', 'src/nodes/haptic/*'))}
    services = {topic for topic in ours if re.search(r'/(tare|reset|calibrate|clog)$', topic)}
    return [f'{topic} is not in the tables' for topic in sorted((calls & ours) | services)
            if f'`{topic}`' not in text and not re.search(r'/(state|button|force_feedback|joy|pose)$', topic) or
            topic in services and f'`{topic}`' not in text]


def check_commands(project, text):
    """Every argument of session.launch, ./dev command and option of our commands is in commands.md."""
    rows = table_rows(text, 'session.launch')
    problems = [f'session.launch: {name} is not in the table' for name in project.launch['session.launch'] if name not in rows]
    problems += [f'session.launch: the table has {name}, the file has not' for name in rows
                 if name not in project.launch['session.launch']]
    problems += [f'./dev {name} is not in the table' for name in project.dev if f'`./dev {name}' not in text]
    for program in ('indent', 'prepare', 'trajectory_error', 'emulate'):
        hidden = {'--help', '--ray'}
        rows = table_rows(text, program)
        problems += [f'{program} {option} is not in the table' for option in sorted(project.programs[program] - hidden)
                     if option not in rows]
    return problems


def check_scene_keys(project, text):
    """Every key that the scene's readers ask for is in scene_file.md."""
    code = project.sources('src/cell/scene.cpp', 'src/cell/puncture_config.cpp', 'src/cell/tensegrity_scene.cpp')
    keys = set(re.findall(r'(?:read\w*\(\w+|\.(?:section|sections|choice|text|integer|number|vector|has))[(,]\s*"([a-z_]+)"', code))
    return [f'the key {key} is not in the tables' for key in sorted(keys) if not re.search(rf'[`/]{key}[`/]', text)]


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
