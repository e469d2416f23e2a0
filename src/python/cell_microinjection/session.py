"""A whole session in this process, on virtual time: the nodes of a session file, with the clock in your hand.

    with Session('injection', 'injection.start_when_enabled:=true') as session:
        session.listen('/controller/injection_state', 1)
        session.run_for(0.1)
        session.run_until(lambda: session.newest('/controller/injection_state')['outcome'] == 'injected', limit=60)

The same bytes in every run. There is one virtual clock in a process, and so one session at a time.
"""
import io

import numpy
import roslib.message

from cell_microinjection import _session
from cell_microinjection._core import ConfigError

_INTEGERS = {'int8', 'int16', 'int32', 'int64', 'uint8', 'uint16', 'uint32', 'uint64', 'byte', 'char'}
_NUMBERS = _INTEGERS | {'float32', 'float64', 'bool'}


class SessionError(Exception):
    """A session that does not come to what it was run for."""


class Session:
    """The nodes of a session file on virtual time (doc/guide/simulate.md)."""

    def __init__(self, session='default', *overrides, without=(), **keys):
        """session: a path or a name of config/sessions. overrides: 'hand.device:=none'; keys: cell='human_oocyte'.
        without: nodes that take no part, such as 'vision'.
        @raises ConfigError as the command `session` prints it"""
        words = [*overrides, *(f'{key}:={_text(value)}' for key, value in keys.items())]
        self._session = _session.Session(session, words, list(without))
        self._classes = {}

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Ends the nodes in good order."""
        self._session.close()

    @property
    def time(self):
        """s, since the start."""
        return self._session.time

    @property
    def now(self):
        """s, of the session's clock, which stamps have: it begins at 1."""
        return self.time + 1

    @property
    def topics(self):
        """Names of all topics."""
        return self._session.topics

    def run_for(self, seconds):
        """Runs the nodes. @raises ConfigError when one ends by an error"""
        self._session.run_for(seconds)

    def step(self, seconds=1e-3):
        """Runs the nodes for one period of the control loop."""
        self._session.run_for(seconds)

    def run_until(self, done, limit, stride=0.01):
        """Runs until done(), which is asked each `stride` s. @raises SessionError after `limit` s"""
        if not stride > 0:
            raise ConfigError(f'stride = {stride}: must be > 0 s')
        end = self.time + limit
        while not done():
            if self.time >= end - 1e-9:
                raise SessionError(f'nothing came of it within {limit} s of the session')
            self._session.run_for(min(stride, end - self.time))

    def listen(self, topic, queue=0):
        """Keeps the messages of a topic from now on, for take(); queue: the most of them, 0: all."""
        self._session.listen(topic, queue)

    def newest(self, topic):
        """@returns the newest message as a dict of numbers, texts and arrays; None: none came since the first call."""
        data = self._session.newest(topic)
        return None if data is None else self._read(topic, data)

    def take(self, topic):
        """@returns the messages since listen() or the last call."""
        return [self._read(topic, data) for data in self._session.take(topic)]

    def say(self, topic, **fields):
        """Publishes a message: session.say('/controller/state_command', string='disable'). A header without a stamp has
        the session's time. @raises ConfigError for a field that the message does not have"""
        message = self._class(topic)()
        _fill(message, fields, topic)
        header = getattr(message, 'header', None)
        if header is not None and 'header' not in fields:
            header.stamp = type(header.stamp).from_sec(self.now)
        out = io.BytesIO()
        message.serialize(out)
        self._session.say(topic, out.getvalue())

    def image(self, topic='/microscope/image_raw'):
        """@returns the newest image, (height, width) or (height, width, 3); None: none came since the first call."""
        message = self.newest(topic)
        if message is None:
            return None
        kind = numpy.uint16 if message['encoding'].endswith('16') else numpy.uint8
        pixels = numpy.frombuffer(bytes(message['data']), kind)
        shape = (message['height'], message['width'])
        return pixels.reshape(shape if pixels.size == shape[0] * shape[1] else (*shape, -1))

    def freeze(self, node):
        """As SIGSTOP."""
        self._session.freeze(node)

    def thaw(self, node):
        """As SIGCONT."""
        self._session.thaw(node)

    def kill(self, node):
        """As SIGKILL."""
        self._session.kill(node)

    def restart(self, node):
        """Starts a node anew with the same parameters."""
        self._session.restart(node)

    def delay(self, node, seconds):
        """Has a node step so much late, once."""
        self._session.delay(node, seconds)

    def _class(self, topic):
        name = self._session.type_of(topic)
        if name not in self._classes:
            self._classes[name] = roslib.message.get_message_class(name)
            if self._classes[name] is None:
                raise ConfigError(f'topic = {topic}: Python has no class of {name}: install its package')
        return self._classes[name]

    def _read(self, topic, data):
        message = self._class(topic)()
        message.deserialize(data)
        return to_dict(message)


def to_dict(message):
    """@returns a ROS message as a dict: times are s, fields of numbers arrays."""
    return {name: _value(getattr(message, name), kind)
            for name, kind in zip(message.__slots__, message._slot_types)}  # pylint: disable=protected-access


def _value(value, kind):
    base, is_array, _ = kind.partition('[')
    if is_array:
        if base in _NUMBERS:
            return numpy.frombuffer(value, numpy.uint8) if isinstance(value, bytes) else numpy.asarray(value)
        return [_value(each, base) for each in value]
    if base in ('time', 'duration'):
        return value.to_sec()
    return to_dict(value) if hasattr(value, '__slots__') and hasattr(value, '_slot_types') else value


def _fill(message, fields, where):
    for name, value in fields.items():
        if name not in message.__slots__:
            raise ConfigError(f'{where}: there is no field {name}; known here: {", ".join(message.__slots__)}')
        present = getattr(message, name)
        if isinstance(value, dict):
            _fill(present, value, f'{where}/{name}')
        elif hasattr(present, 'to_sec'):
            setattr(message, name, type(present).from_sec(float(value)))
        else:
            setattr(message, name, value.tolist() if hasattr(value, 'tolist') else value)


def _text(value):
    return str(value).lower() if isinstance(value, bool) else str(value)
