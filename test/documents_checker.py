"""What is wrong with the documents of a project, each line and token for itself."""
import functools
import re
import shlex
from pathlib import Path

from documents_links import LinkChecker

HISTORY = {'CHANGELOG.md'}  # names what once was
PACKAGE = 'cell_microinjection'
# What others' programs are called: their options, topics and identifiers that the documents name.
OTHERS = set('''/publish_rate /phantom /Geomagic /opt --ros-args --help out/demo out/bench out/test out/paper devel/setup.bash
install/setup.bash catkin_make roslaunch rosrun rostopic rosservice rosbag rosparam rosdep sudo apt-get true false none
omni_msgs geomagic_control phantom_omni ros_falcon falconPos falconForce ulimit kill ROS_IP ROS_MASTER_URI HOME PWD
sensor_msgs/Joy geometry_msgs/PoseStamped geometry_msgs/TwistStamped geometry_msgs/WrenchStamped std_msgs/Bool
std_srvs/Trigger std_srvs/SetBool WrenchStamped PoseStamped TwistStamped JointState MarkerArray DiagnosticArray
build/core/plain build/core/address build/core/thread cp cv cf SIGSTOP NAMESPACE/body/servo_cf footpedals/clutch
footpedals/operator_present console/operator_present'''.split())
PLACEHOLDER = re.compile(r'\b[A-Z][A-Z0-9_]*\b|(?<![A-Za-z])(?:NAME|KIND|RIG)(?=_)|\.\.\.|\*')
IDENTIFIER = re.compile(r'[A-Za-z_]\w*(?:::\w+)*(?:\(\))?')
WRITTEN = ('csv', 'yaml', 'png', 'bag', 'md', 'active')
SUFFIXES = ('md', 'py', 'cpp', 'h', 'launch', 'yaml', 'csv', 'png', 'bag', 'urdf', 'txt', 'xml', 'msg', 'srv', 'action',
            'test', 'sh', 'cff', 'rviz', 'bash')


def commands_of(text):
    """Yields (line, command) of the blocks: indented by four and more after an empty line, or fenced. A backslash at its
    end joins a line to the next."""
    block, fenced, empty, begun, first = False, False, True, '', 0
    for number, line in enumerate([*text.splitlines(), ''], 1):
        fence = line.lstrip().startswith('```')
        inside = not fence and (fenced or ((empty or block) and line.startswith('    ')))
        if begun and not inside:
            yield first, begun
            begun = ''
        if fence:
            fenced = not fenced
        elif inside:
            block = True
            first = first if begun else number
            begun += line.strip().rstrip('\\')
            if not line.endswith('\\'):
                yield first, begun
                begun = ''
        else:
            block = block and not line.strip()
        empty = not line.strip()


class Checker(LinkChecker):
    """Adds what they name that is not there."""

    def check(self):
        for path in self.project.documents:
            text = self.project.text(path)
            self.check_links(path, text)
            if path in HISTORY:
                continue
            for number, line in enumerate(text.splitlines(), 1):
                self.place = f'{path}:{number}'
                if not line.startswith('    ') or '`' in line:
                    for token in re.findall(r'(?<!`)`([^`\n]+)`(?!`)', line):
                        self.check_token(token)
            for number, line in commands_of(text):
                self.place = f'{path}:{number}'
                self.check_command(line)
        return self.problems

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
        for word in words:
            if re.fullmatch(r'(config|src|launch|test|urdf)/[\w./-]+', word) and not (self.project.root / word).exists():
                self.report(f'there is no file {word}')

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
        if words[2] in ('session', 'simulate'):
            self.check_keys(word.replace(':=', '=') for word in words[3:] if '=' in word and not PLACEHOLDER.search(word.split('=')[0]))
        known = self.project.programs[words[2]] | {'--help'}
        for word in words[3:]:
            if word.startswith('--') and word not in known:
                self.report(f'{words[2]} has no option {word}')

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
            elif name == 'set':
                self.check_keys(value.split())
            else:
                self.check_value(name, value, [words[2]])

    def check_keys(self, words):
        """KEY=VALUE of a session file."""
        for word in words:
            key = word.split('=', 1)[0]
            if key not in self.project.session_keys and not key.startswith('overrides.'):
                self.report(f'a session has no key {key}')

    def check_value(self, name, value, files):
        """A word that an argument takes is a file of that name, or is in what the launch file says of the argument."""
        if not re.fullmatch(r'[a-z][a-z_0-9]*', value):
            return
        if name == 'cell':
            good = f'config/cells/{value}.yaml' in self.project.files
        elif name == 'haptic':
            good = f'config/haptic/{value}.yaml' in self.project.files or value in ('virtual_hand', 'none')
        elif name == 'session':
            good = f'config/sessions/{value}.yaml' in self.project.files
        elif name in ('record', 'only'):
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
        known = self.project.programs.get(Path(script).name)
        for word in words:
            if known is not None and word.startswith('--') and word not in known | {'--help'}:
                self.report(f'{script} has no option {word}')

    # What stands in backquotes

    def check_token(self, token):
        token = token.strip()
        if token in OTHERS or token in self.project.session_keys or not re.search(r'[A-Za-z]', token):
            return
        first = token.split()[0]
        either = re.fullmatch(r'([\w/]+\.)\{(\w+),(\w+)\}', token)
        if either:
            for suffix in either.groups()[1:]:
                self.check_path(either.group(1) + suffix)
        elif first in ('./dev', 'rosrun', 'roslaunch', 'rostopic', 'rosservice', 'python3') and ' ' in token:
            self.check_command(token)
        elif token.startswith('./dev') or token.startswith('test/') and token in self.project.files:
            pass
        elif token.startswith('set:='):
            self.check_argument(*token.split(':=', 1))
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
        if name in self.project.session_keys or name == 'KEY':
            return None
        if name not in self.project.arguments:
            return self.report(f'no launch file has an argument {name}')
        if name == 'set':
            return self.check_keys(value.strip('"').split())
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
        if not there and bare.rsplit('.', 1)[-1] in WRITTEN:  # by a program, into a folder of the user's
            there = bare.rsplit('/', 1)[-1] in self.all_code()
        if not there and '/' in token:
            there = f'/{bare}' in project.topics | project.parts or self.is_key(bare) or self.is_scene_key(bare)
        if not there:
            self.report(f'there is no file, topic or key {token}')

    def is_key(self, token):
        return any(f'/{token}/' in f'/{key}/' for key in self.project.keys)

    def is_scene_key(self, token):
        """A key that no file of config uses: each part of it is a text of the code."""
        return all(f'"{part}"' in self.texts() for part in token.split('/'))

    @functools.lru_cache(maxsize=None)
    def texts(self):
        return set(re.findall(r'"[a-z_]+"', self.project.sources('src/*/*.cpp', 'src/*/*/*.cpp')))

    @functools.lru_cache(maxsize=None)
    def all_code(self):
        return '\n'.join(self.project.code.values())

    def check_word(self, token):
        if PLACEHOLDER.fullmatch(token) and token not in self.project.words and not re.search('[_a-z]', token):
            return
        words = re.findall(r'[A-Za-z_]\w*', token)
        missing = [word for word in words if word not in self.project.words and word not in OTHERS
                   and not any(word in name for name in (self.project.names if '.' in token else ()))]
        if missing and token not in self.project.dev and not PLACEHOLDER.fullmatch(token):
            self.report(f'{token}: nothing of that name is in the code')
