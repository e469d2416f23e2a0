"""Holds the documents to what is there.

Follows every relative link of every .md file. Checks what a document names in backquotes or in a block of commands: paths,
files, ./dev commands and their options, programs and theirs, launch files and arguments, topics, services, keys and
identifiers. Checks the tables of the reference against code and configuration, the length of README.md, the columns of all
documents and the length of the guides' sentences.
"""
import re
import shlex
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parent.parent
SKIPPED = {'.git', 'out', 'build', 'catkin_ws', '__pycache__'}
HISTORY = {'CHANGELOG.md'}  # names what once was, and is wrapped as its entries came
README_LINES, COLUMNS, SENTENCE = 150, 100, 30

PACKAGE = 'cell_microinjection'
# What others' programs are called: their options, topics and identifiers that the documents name.
OTHERS = set('''/publish_rate /phantom /Geomagic /opt --ros-args --help out/demo out/bench out/test out/paper devel/setup.bash
install/setup.bash catkin_make roslaunch rosrun rostopic rosservice rosbag rosparam rosdep sudo apt-get true false none
omni_msgs geomagic_control phantom_omni ros_falcon falconPos falconForce ulimit kill ROS_IP ROS_MASTER_URI HOME PWD
sensor_msgs/Joy geometry_msgs/PoseStamped geometry_msgs/TwistStamped geometry_msgs/WrenchStamped std_msgs/Bool
std_srvs/Trigger std_srvs/SetBool WrenchStamped PoseStamped TwistStamped JointState MarkerArray DiagnosticArray
build/core build/core-address build/core-thread cp cv cf SIGSTOP NAMESPACE/body/servo_cf footpedals/clutch
footpedals/operator_present console/operator_present'''.split())
PLACEHOLDER = re.compile(r'\b[A-Z][A-Z0-9_]*\b|(?<![A-Za-z])(?:NAME|KIND|RIG)(?=_)|\.\.\.|\*')
IDENTIFIER = re.compile(r'[A-Za-z_]\w*(?:::\w+)*(?:\(\))?')
TOPIC_CALL = re.compile(
    r'(?:advertise|output|input|subscribe|subscribeGuarded|follow)<[^;()]*>\(\s*(?:[\w.()]+,\s*)?"(/?[a-z_]+(?:/[a-z_]+)*)"')
OPTION = re.compile(r'\(\s*"([a-z][a-z-]*)(?:,\w)?",\s*(?:po::|boost::program_options::|"this text")')
SUFFIXES = ('md', 'py', 'cpp', 'h', 'launch', 'yaml', 'csv', 'png', 'bag', 'urdf', 'txt', 'xml', 'msg', 'srv', 'action',
            'test', 'sh', 'cff', 'rviz', 'bash')


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


class Project:
    """What the documents below `root` may name."""

    def __init__(self, root):
        self.root = root
        self.files = {path.relative_to(root).as_posix() for path in root.rglob('*')
                      if path.is_file() and not SKIPPED & set(path.relative_to(root).parts)}
        self.folders = {parent.as_posix() for path in self.files for parent in Path(path).parents}
        self.names = {Path(path).name for path in self.files}
        self.documents = sorted(path for path in self.files if path.endswith('.md'))
        self.code = {path: self.text(path) for path in self.files
                     if path.split('/')[0] in ('src', 'launch', 'config', 'msg', 'urdf', 'dev', 'package.xml', 'CMakeLists.txt',
                                               'dependencies.txt') and not path.endswith(('.csv', '.md'))}
        columns = [self.text(path).split('\n', 1)[0] for path in self.files if path.endswith('.csv')]
        self.words = set(re.findall(r'\w+', '\n'.join([*self.code.values(), *columns])))
        self.read_dev()
        self.read_launch_files()
        self.read_programs()
        self.read_nodes()
        self.keys = {key for path, text in self.code.items() if path.endswith('.yaml') for key in keys_of(text)}

    def text(self, path):
        return (self.root / path).read_text(errors='replace')

    def sources(self, *patterns):
        return '\n'.join(text for path, text in self.code.items() if any(Path(path).match(pattern) for pattern in patterns))

    def read_dev(self):
        """{command of ./dev: its options}, as ./dev itself says."""
        def help_of(*arguments):
            return subprocess.run(['bash', str(self.root / 'dev'), *arguments, '--help'], check=True, text=True,
                                  stdout=subprocess.PIPE, stdin=subprocess.DEVNULL).stdout
        names = re.findall(r'^  (\w+)(?: NAME)?  ', help_of(), re.MULTILINE)
        self.dev = {name: set(re.findall(r'--[a-z][a-z-]*', help_of(name))) | {'--help'} for name in names}

    def read_launch_files(self):
        """{launch file: {argument: what is said of it}}; a fixed value is no argument."""
        self.launch = {}
        for path in self.files:
            if path.startswith('launch/') and path.endswith('.launch'):
                tree = ElementTree.fromstring(self.text(path))
                self.launch[path[len('launch/'):]] = {
                    arg.get('name'): f'{arg.get("doc", "")} {arg.get("default")}' for arg in tree.iter('arg')
                    if arg.get('default') is not None or arg.get('doc')}
        self.arguments = {name for arguments in self.launch.values() for name in arguments}

    def read_programs(self):
        """{program: the options it knows}; empty for a node."""
        self.programs = {Path(path).stem: set() for path in self.files if path.startswith('src/nodes/main/')}
        self.benches = {}
        for path, text in self.code.items():
            options = set(re.findall(r"""add_argument\(\s*['"](--[a-z-]+)""", text))
            options |= {f'--{name}' for name in OPTION.findall(text)}
            place = Path(path)
            if place.parent.as_posix() == 'src/commands' and 'main(' in text:
                shared = self.sources(f'src/commands/{place.stem}_*.cpp')
                options |= {f'--{name}' for name in OPTION.findall(shared)}
                self.programs[place.stem] = options
            elif place.parent.as_posix() == 'src/bench' and not place.name.startswith('plot_') and place.suffix in ('.cpp', '.py'):
                self.benches[place.stem] = options
            elif place.suffix == '.py' and place.parent.as_posix() in ('src/tools', 'src/paper'):
                self.programs[place.name] = options
        self.options = set().union(*self.programs.values(), *self.benches.values(), *self.dev.values())

    def read_nodes(self):
        """Topics, services and global parameters, as the code has them."""
        text = self.sources('src/nodes/*', 'src/nodes/haptic/*')
        self.topics = {'/' + topic.lstrip('/') for topic in TOPIC_CALL.findall(text)}
        self.topics |= set(re.findall(r'"(/[a-z_]+(?:/[a-z_]+)*)"', text))
        self.topics |= {'/' + topic for topic in re.findall(r'"([a-z_]+/[a-z_]+(?:/[a-z_]+)?)"', text)}
        self.topics |= {f'/controller/inject/{part}' for part in ('goal', 'cancel', 'status', 'feedback', 'result')}
        for path, source in self.code.items():
            if path.endswith('_node.cpp'):
                node = Path(path).stem[:-len('_node')]
                self.topics |= {f'/{node}/{name}' for name in re.findall(r'advertiseService[^;"]*\(\s*"(\w+)"', source)}
        self.topics |= set(re.findall(r'<param name="(/[a-z_/]+)"', self.sources('launch/*')))
        self.topics |= {'/use_sim_time', '/lockstep/participants'} & set(re.findall(r'/[a-z_/]+', self.sources('launch/*')))
        self.parts = {part for name in self.topics for part in ('/'.join(name.split('/')[:n]) for n in range(2, 5))}


def documents_prose(text):
    """Yields (number of the first line, paragraph) of the prose: no table, block of commands or heading."""
    paragraph, first, fenced = [], 0, False
    for number, line in enumerate(text.splitlines() + [''], 1):
        fence = line.lstrip().startswith('```')
        fenced ^= fence
        block = fence or fenced or (line.startswith('    ') and not paragraph) or re.match(r'\s*\|', line)
        begins = bool(re.match(r'\s*([-*]|\d+\.) ', line))
        if paragraph and (block or begins or not line.strip() or line.startswith('#')):
            yield first, ' '.join(paragraph)
            paragraph = []
        if line.strip() and not block and not line.startswith('#'):
            first = first if paragraph else number
            paragraph.append(re.sub(r'^\s*([-*]|\d+\.) ', '', line).strip())


def commands_of(text):
    """Yields (line, command) of the blocks: indented by four and more after an empty line, or fenced."""
    block, fenced, empty = False, False, True
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith('```'):
            fenced = not fenced
        elif fenced or ((empty or block) and line.startswith('    ')):
            block = True
            yield number, line.strip()
        else:
            block = block and not line.strip()
        empty = not line.strip()


def slug(heading):
    """The anchor of a heading."""
    heading = re.sub(r'\[([^\]]*)\]\([^)]*\)', r'\1', heading).strip().lower()
    return re.sub(r'[^\w\- ]', '', heading).replace(' ', '-')


def anchors(text):
    outside = re.sub(r'^```.*?^```', '', text, flags=re.MULTILINE | re.DOTALL)
    return {slug(heading) for heading in re.findall(r'^#+ (.*)$', outside, re.MULTILINE)}


class Checker:
    """Collects what is wrong with the documents of a project, a line each."""

    def __init__(self, project):
        self.project = project
        self.problems = []

    def check(self):
        for path in self.project.documents:
            text = self.project.text(path)
            self.check_links(path, text)
            if path in HISTORY:
                continue
            self.check_form(path, text)
            for number, line in enumerate(text.splitlines(), 1):
                self.place = f'{path}:{number}'
                if not line.startswith('    ') or '`' in line:
                    for token in re.findall(r'(?<!`)`([^`\n]+)`(?!`)', line):
                        self.check_token(token)
            for number, line in commands_of(text):
                self.place = f'{path}:{number}'
                self.check_command(line)
        return self.problems

    def report(self, problem):
        self.problems.append(f'{self.place}: {problem}')

    # Links and form

    def check_links(self, path, text):
        outside = re.sub(r'`[^`\n]+`', lambda code: ' ' * len(code.group()), text)
        for found in re.finditer(r'\]\(([^)\s]+)\)', outside):
            target, _, anchor = found.group(1).partition('#')
            if '://' in target or target.startswith('mailto:'):
                continue
            self.place = f'{path}:{text.count(chr(10), 0, found.start()) + 1}'
            file = self.resolve(path, target) if target else path
            if file not in self.project.files and file not in self.project.folders:
                self.report(f'link to {target}: there is no such file')
            elif anchor and anchor not in anchors(self.project.text(file)):
                self.report(f'link to {found.group(1)}: there is no such heading')

    @staticmethod
    def resolve(path, target):
        parts = []
        for part in (Path(path).parent / target).as_posix().split('/'):
            if part == '..':
                parts = parts[:-1] if parts else ['..']
            elif part != '.':
                parts.append(part)
        return '/'.join(parts) or '.'

    def check_form(self, path, text):
        lines = text.splitlines()
        self.place = path
        if path == 'README.md' and len(lines) > README_LINES:
            self.report(f'{len(lines)} lines, at most {README_LINES}')
        fenced = False
        for number, line in enumerate(lines, 1):
            fenced ^= line.startswith('```')
            if len(line) > COLUMNS and not fenced and not re.match(r'\s*\||    |\s*!\[', line):
                self.place = f'{path}:{number}'
                self.report(f'{len(line)} columns, at most {COLUMNS}')
        if path == 'README.md' or path.startswith('doc/'):
            for number, paragraph in documents_prose(text):
                self.place = f'{path}:{number}'
                self.check_sentences(paragraph)

    def check_sentences(self, paragraph):
        plain = re.sub(r'!?\[([^\]]*)\]\([^)]*\)', r'\1', re.sub(r'`[^`]*`', 'code', paragraph))
        for sentence in re.split(r'(?<=[.!?])[*_)"]*\s+', plain):
            words = re.findall(r"[\w/^'-]+", sentence)
            if len(words) > SENTENCE:
                self.report(f'a sentence of {len(words)} words, at most {SENTENCE}: {sentence[:60]} ...')

    # Commands

    def check_command(self, line):
        line = re.sub(r'^\$ ', '', line)
        line = re.sub(r'\s#\s.*$', '', line)
        try:
            words = shlex.split(line)
        except ValueError:
            return
        if words[:2] == ['./dev', 'shell'] and '--' in words:
            self.check_dev(words[:words.index('--')])
            words = words[words.index('--') + 1:]
        if not words:
            return
        checks = {'./dev': self.check_dev, 'rosrun': self.check_rosrun, 'roslaunch': self.check_roslaunch,
                  'rostopic': self.check_ros_name, 'rosservice': self.check_ros_name, 'python3': self.check_python}
        if words[0] in checks:
            checks[words[0]](words)

    def check_dev(self, words):
        if len(words) < 2 or PLACEHOLDER.fullmatch(words[1]) or words[1] == '--help':
            return
        known = self.project.dev
        if words[1] not in known:
            return self.report(f'./dev has no command {words[1]}')
        own = words[2:words.index('--')] if '--' in words else words[2:]
        behind = words[words.index('--') + 1:] if '--' in words else []
        options = set(known[words[1]])
        if words[1] == 'bench' and own:
            name = own[0]
            if PLACEHOLDER.fullmatch(name):
                return None
            if name not in self.project.benches:
                return self.report(f'there is no benchmark {name}')
            options |= self.project.benches[name] | {'--csv', '--out'}
        if words[1] in ('demo', 'paper'):
            options |= self.project.programs.get({'demo': 'demo.py', 'paper': 'report.py'}[words[1]], set())
        for word in own + behind:
            if word.startswith('--') and word.split('=')[0] not in options:
                self.report(f'{" ".join(words[:3])}: there is no option {word}')
        if words[1] == 'test':
            for folder in own:
                if re.fullmatch('[a-z_]+', folder) and f'test/{folder}' not in self.project.folders and folder not in ('address', 'thread'):
                    self.report(f'there is no folder test/{folder}')

    def check_rosrun(self, words):
        if len(words) < 3 or words[1] != PACKAGE or PLACEHOLDER.fullmatch(words[2]):
            return
        if words[2] not in self.project.programs:
            return self.report(f'there is no program {words[2]}')
        known = self.project.programs[words[2]] | {'--help'}
        for word in words[3:]:
            if word.startswith('--') and word not in known:
                self.report(f'{words[2]} has no option {word}')
            elif '/' in word and word.startswith(('config/', 'src/', 'launch/')) and word not in self.project.files:
                self.report(f'there is no file {word}')

    def check_roslaunch(self, words):
        words = [word for word in words if not word.startswith(('--', '['))]
        if len(words) < 3 or words[1] != PACKAGE:
            return
        if words[2] not in self.project.launch:
            return self.report(f'there is no launch file {words[2]}')
        for word in words[3:]:
            name, assigned, value = word.partition(':=')
            if not assigned:
                continue
            if name not in self.project.launch[words[2]]:
                self.report(f'{words[2]} has no argument {name}')
            else:
                self.check_value(name, value, [words[2]])

    def check_value(self, name, value, files):
        """A word that an argument takes is a file of that name, or is in what the launch file says of the argument."""
        if not re.fullmatch(r'[a-z][a-z_0-9]*', value):
            return
        if name == 'cell':
            good = f'config/cells/{value}.yaml' in self.project.files
        elif name == 'haptic':
            good = f'launch/haptic/{value}.launch' in self.project.files
        elif name in ('operator', 'record', 'history', 'scene', 'motion'):
            good = True
        else:
            said = ' '.join(self.project.launch[file].get(name, '') for file in files)
            good = value in ('true', 'false') or re.search(rf'\b{value}\b', said)
        if not good:
            self.report(f'{name}:={value}: the argument knows no {value}')

    def check_ros_name(self, words):
        for word in words[1:]:
            if re.fullmatch(r'/[a-z_]+(/[a-z_]+)*', word):
                self.check_name(word)
            elif word.startswith(PACKAGE + '/'):
                kind = re.sub(r'Action(Goal|Result|Feedback)?$', '', word.split('/')[1])
                if not {f'{kind}.msg', f'{kind}.srv', f'{kind}.action'} & self.project.names:
                    self.report(f'there is no message {word}')

    def check_python(self, words):
        script = next((word for word in words[1:] if word.endswith('.py')), '')
        if script and script not in self.project.files:
            return self.report(f'there is no script {script}')
        known = self.project.programs.get(Path(script).name)
        for word in words:
            if known is not None and word.startswith('--') and word not in known | {'--help'}:
                self.report(f'{script} has no option {word}')

    # What stands in backquotes

    def check_token(self, token):
        token = token.strip()
        if token in OTHERS or not re.search(r'[A-Za-z]', token):
            return
        first = token.split()[0]
        if first in ('./dev', 'rosrun', 'roslaunch', 'rostopic', 'rosservice', 'python3') and ' ' in token:
            self.check_command(token)
        elif token.startswith('./dev') or token.startswith('test/') and token in self.project.files:
            pass
        elif ':=' in token:
            for word in token.split():
                if ':=' in word:
                    self.check_argument(*word.split(':=', 1))
        elif first.startswith('--'):
            name = first.split('=')[0]
            if name != '--' and name not in self.project.options | OTHERS:
                self.report(f'no program has an option {name}')
        elif re.match(r'[a-z_/]+: ', token):
            for key in re.findall(r'([a-z_]\w*):', token):
                self.check_word(key)
        elif ' ' in token or re.search(r'[=()<>^+"\\,@$]', token.rstrip('()')):
            for word in re.findall(r'\b[a-z]+_\w+\b', token):
                self.check_word(word)
        elif token.startswith('/'):
            self.check_name(token)
        elif '/' in token or token.rsplit('.', 1)[-1] in SUFFIXES and '.' in token:
            self.check_path(token)
        elif IDENTIFIER.fullmatch(token) or re.fullmatch(r'[\w.:~-]+', token):
            self.check_word(token)

    def check_argument(self, name, value):
        if name.startswith('_'):
            return self.check_word(name[1:].split('/')[-1])
        if name not in self.project.arguments:
            return self.report(f'no launch file has an argument {name}')
        return self.check_value(name, value, [file for file in self.project.launch if name in self.project.launch[file]])

    def check_name(self, token):
        """A topic, service or parameter from /, or the front part of one."""
        token = token.rstrip('/')
        if not re.match('/(tmp|dev|proc)/', token) and not PLACEHOLDER.search(token) and token not in self.project.topics | self.project.parts | OTHERS:
            self.report(f'no node has a topic, service or parameter {token}')

    def check_path(self, token):
        """A file or folder from the root or from src/, an output that the code names, a topic or a key."""
        bare = token.rstrip('/')
        if re.match(r'(~|\$|out/|\.\./|-)', bare) or bare in OTHERS or '://' in bare:
            return
        project = self.project
        if '*' not in bare and (project.root / bare).exists():
            return
        there = {bare, f'src/{bare}', f'test/{bare}'} & (project.files | project.folders) or bare in project.names
        if PLACEHOLDER.search(bare):
            pattern = '.*'.join(re.escape(part) for part in PLACEHOLDER.split(bare))
            known = project.files | project.folders | project.keys | project.topics
            there = any(re.fullmatch(f'(.*/)?{pattern}', name) for name in known) or not re.search(r'[a-z]', bare)
        if not there and '.' in bare:
            there = all(word in project.words for word in re.findall(r'\w+', bare))
        if not there and '/' in token:
            there = f'/{bare}' in project.topics | project.parts or self.is_key(bare) or self.is_scene_key(bare)
        if not there:
            self.report(f'there is no file, topic or key {token}')

    def is_key(self, token):
        return any(f'/{token}/' in f'/{key}/' for key in self.project.keys)

    def is_scene_key(self, token):
        """A key that no file of config uses: each part of it is a text of the code."""
        return all(f'"{part}"' in self.texts() for part in token.split('/'))

    def texts(self):
        if not hasattr(self, '_texts'):
            self._texts = set(re.findall(r'"[a-z_]+"', self.project.sources('src/*/*.cpp', 'src/*/*/*.cpp')))
        return self._texts

    def check_word(self, token):
        if PLACEHOLDER.fullmatch(token) and token not in self.project.words and not re.search('[_a-z]', token):
            return
        words = re.findall(r'[A-Za-z_]\w*', token)
        missing = [word for word in words if word not in self.project.words and word not in OTHERS
                   and not any(word in name for name in (self.project.names if '.' in token else ()))]
        if missing and token not in self.project.dev and not PLACEHOLDER.fullmatch(token):
            self.report(f'{token}: nothing of that name is in the code')


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


class TheDocuments(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.project = Project(ROOT)

    def assert_none(self, problems):
        self.assertFalse(problems, f'{len(problems)} problems:\n' + '\n'.join(problems))

    def assert_table(self, check, path):
        self.assert_none(check(self.project, self.project.text(path)))

    def test_name_what_is_there(self):
        self.assert_none(Checker(self.project).check())

    def test_are_found_from_the_readme(self):
        found = reachable(self.project)
        self.assert_none([f'{path}: no link leads there' for path in self.project.documents
                          if path.startswith('doc/') and path not in found])

    def test_have_every_parameter_and_its_default(self):
        self.assert_table(check_parameters, 'doc/reference/parameters.md')

    def test_have_every_topic(self):
        self.assert_table(check_topics, 'doc/reference/topics_and_frames.md')

    def test_have_every_command_argument_and_option(self):
        self.assert_table(check_commands, 'doc/reference/commands.md')

    def test_have_every_key_of_a_scene(self):
        self.assert_table(check_scene_keys, 'doc/reference/scene_file.md')

    def test_are_read_token_by_token(self):
        self.assertGreater(len(self.project.topics), 40)
        self.assertGreater(len(self.project.keys), 200)
        self.assertIn('--tolerance', self.project.programs['indent'])
        self.assertIn('--isolated', self.project.dev['shell'])
        self.assertIn('/force_sensor/tare', self.project.topics)
        self.assertGreater(sum(len(re.findall('`', self.project.text(path))) for path in self.project.documents), 1000)


class TheCheck(unittest.TestCase):
    """Each thing that a document may get wrong, in a small project, is reported, and what is right is not."""

    FILES = {
        'dev': """#!/bin/bash
case "$*" in
  --help) printf '  test          all tests\\n  bench NAME    a benchmark\\n' ;;
  "test --help") echo 'usage: ./dev test [--core]' ;;
esac
""",
        'launch/session.launch': '<launch><arg name="rig" default="sim" doc="sim or zaber"/><arg name="fixed" value="1"/></launch>',
        'config/bridge.yaml': 'rate: 1000   # Hz\nlimits: {force: 3.0}\n# serial:\n#   baud: 9600   # bit/s\n',
        'src/nodes/bridge_node.cpp': 'cycle.output<Wrench>("haptic/servo_cf"); node.advertiseService<A, B>("tare");\n',
        'src/nodes/main/bridge.cpp': 'int main() {}\n',
        'src/commands/indent.cpp': 'add("depths", po::value(&depths)); int main() {}\n',
        'src/bench/accuracy.cpp': 'add("draws", po::value(&draws));\n',
        'src/cell/scene.cpp': 'reader.number("stretch"); double forceGain = 1;\n',
        'test/cell/scene_test.cpp': '\n',
        'doc/guide/other.md': '# Other page\n\n## How its `rate` is, mostly\n',
    }
    GOOD = """# Title

See [other](doc/guide/other.md#how-its-rate-is-mostly), `config/bridge.yaml`, `scene.cpp`, `cell/scene.cpp`, `limits/force`,
`serial/baud`, `stretch`, `forceGain`, `/haptic/servo_cf`, `/bridge/tare`, `/haptic`, `rig:=zaber`, `--depths`,
`launch/NAME.launch`, `./dev test --core`, `roslaunch cell_microinjection session.launch rig:=sim`.

    ./dev test --core cell
    ./dev bench accuracy -- --draws 3
    rosrun cell_microinjection indent --depths 1
    rostopic echo /haptic/servo_cf          # the force
"""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        for name, text in self.FILES.items():
            self.write(name, text)

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def problems(self, text, name='doc/guide/page.md'):
        self.write(name, text)
        return Checker(Project(self.root)).check()

    def test_accepts_a_document_that_is_right(self):
        good = re.sub(r'(?<=, )`|(?<=,)\n`', '\n`', self.GOOD)
        self.assertEqual(self.problems(good, 'README.md'), [])

    def test_reports_what_is_not_there(self):
        for wrong, reason in {
                '[page](nowhere.md)': 'no such file', '[page](other.md#nothing)': 'no such heading',
                '[page](../other.md)': 'no such file', '![picture](scene.png)': 'no such file',
                '`config/nothing.yaml`': 'no file, topic or key', '`cell/nothing.cpp`': 'no file, topic or key',
                '`limits/torque`': 'no file, topic or key', '`serial/parity`': 'no file, topic or key',
                '`launch/NAME.urdf`': 'no file, topic or key', '`torque_gain`': 'nothing of that name',
                '`/haptic/servo_cx`': 'no node has a topic', '`/bridge/reset`': 'no node has a topic', '`--deep`': 'no program has an option',
                '`speed:=1`': 'no launch file has an argument', '`fixed:=1`': 'no launch file has an argument',
                '`rig:=lathe`': 'knows no lathe', '`./dev demo`': '', '`./dev walk --far`': 'no command walk',
                '`./dev test --bore`': 'no option --bore', '`limits: {torque: 1}`': 'nothing of that name'}.items():
            with self.subTest(wrong=wrong):
                found = self.problems(f'# Page\n\nSee {wrong}.\n')
                self.assertEqual(len(found), 1, found)
                self.assertIn('doc/guide/page.md:3', found[0])
                self.assertIn(reason, found[0])

    def test_reports_commands_that_cannot_be_run(self):
        for wrong, reason in {
                './dev walk': 'no command walk', './dev test --far': 'no option --far', './dev test attic': 'no folder test/attic',
                './dev bench speed': 'no benchmark speed', './dev bench accuracy -- --depths 1': 'no option --depths',
                'rosrun cell_microinjection dent': 'no program dent', 'rosrun cell_microinjection indent --deep': 'no option --deep',
                './dev shell -- rosrun cell_microinjection dent': 'no command shell',
                'roslaunch cell_microinjection other.launch': 'no launch file', 'rostopic echo /haptic/none': 'no node has a topic',
                'roslaunch cell_microinjection session.launch rig:=lathe': 'knows no lathe',
                'roslaunch cell_microinjection session.launch speed:=1': 'no argument speed',
                'rostopic pub -1 /haptic/servo_cf cell_microinjection/Nothing': 'no message', 'python3 src/none.py': 'no script'}.items():
            for block in (f'    {wrong}\n', f'```\n{wrong}\n```\n'):
                with self.subTest(block=block):
                    found = self.problems(f'# Page\n\nText.\n\n{block}')
                    self.assertIn(reason, '\n'.join(found))

    def test_reports_length_columns_and_sentences(self):
        self.assertIn('151 lines', self.problems('word\n\n' * 75 + 'word\n', 'README.md')[0])
        (self.root / 'README.md').unlink()
        self.assertIn('101 columns', self.problems('x' * 101 + '\n')[0])
        self.assertEqual(self.problems('| ' + 'x' * 120 + ' |\n\n    ' + 'x' * 120 + '\n'), [])
        self.assertIn('31 words', self.problems('word\n' * 30 + 'end.\n')[0])
        self.assertEqual(self.problems('word\n' * 29 + 'end. Next one.\n\n- ' + 'word\n  ' * 29 + '\n- item\n'), [])

    def test_reports_tables_that_differ_from_the_code(self):
        project = Project(self.root)
        table = '## config/bridge.yaml\n\n| key | default |\n|---|---|\n| `rate` | 1000 |\n| `limits/force` | 3.0 |\n'
        self.assertEqual(check_parameters(project, table), [])
        self.assertIn('rate = 1000', check_parameters(project, table.replace('1000', '999'))[0])
        self.assertIn('limits/force', check_parameters(project, table.replace('`limits/force`', '`force`'))[0])
        self.assertIn('the file has not', check_parameters(project, table + '| `more` | 1 |\n')[0])
        self.assertEqual(check_topics(project, '`/haptic/servo_cf` `/bridge/tare`'), [])
        self.assertEqual(len(check_topics(project, '')), 2)
        self.assertIn('the key stretch', check_scene_keys(project, '`mesh/size`')[0])

    def test_finds_documents_that_no_link_leads_to(self):
        self.write('README.md', '[other](doc/guide/other.md)\n')
        self.write('doc/guide/lonely.md', '# Lonely\n')
        self.assertEqual(reachable(Project(self.root)), {'README.md', 'doc/guide/other.md'})


if __name__ == '__main__':
    unittest.main()
