"""Pictures of every operator's console with a session that runs, on two sizes of screen: what to look at after a change."""
import contextlib
import os
import sys
import time
from pathlib import Path

import screenshot
from demo_session import DemoSession, SessionError
from processes import Child, wait_until
from rviz_view import RvizError, write_console
from screen import Screen
from session_operator import SessionOperator

ROOT = Path(os.environ.get('MICROINJECTION_ROOT') or Path(__file__).resolve().parents[2])
SIZES = ((1280, 800), (1920, 1080))  # px
PATIENCE = 100  # s of wall time, for rviz to come up, and for the moment of the picture
SETTLE = {'virtual_hand': 1.5, 'none': 6}  # s, for rviz to draw it: a hand does not rest for long
STEPPED = {'hand.device': 'none', 'injection.mode': 'semi_automatic'}
BY_HAND = {'hand.device': 'virtual_hand', 'hand.motion': ROOT / 'config/hand_motions/puncture_and_inject.yaml'}
CAMERA = {'camera.source': 'sim'}
CONSOLES = {'inject': {**STEPPED, **CAMERA}, 'teleoperate': {**BY_HAND, **CAMERA}, 'train': BY_HAND, 'axes': BY_HAND,
            'paper': STEPPED, 'calibrate': {'hand.device': 'none', 'injection.mode': 'manual', **CAMERA}}


def await_moment(session, keys):
    """Until there is something to see. @raises SessionError"""
    session.monitor.go()
    operator = SessionOperator(PATIENCE)
    if keys['hand.device'] == 'virtual_hand':
        operator.wait(lambda: session.monitor.phase == 'hold', "the hand's rest in the cell")
    elif keys['injection.mode'] == 'semi_automatic':
        for command, state in (('approach', 'contact'), ('indent', 'punctured')):
            operator.say(command, lambda state=state: operator.waits_in(state))
    session.check()


def start_rviz(name, size, logs, environment):
    path = logs / f'{name}.rviz'
    write_console(name, path)
    config = path.read_text(encoding='utf-8')
    for key, value in zip(('Width', 'Height'), size):
        before = {'Width': 1280, 'Height': 800}[key]
        config = config.replace(f'  {key}: {before}\n', f'  {key}: {value}\n')
    path.write_text(config, encoding='utf-8')
    return Child(['nice', '-n', '5', 'rosrun', 'cell_microinjection', 'rviz', '-d', str(path)], logs / 'rviz.log',
                 {**os.environ, **environment})


@contextlib.contextmanager
def seen_session(logs, size, keys, start_view):
    """A session with rviz on a screen of its own, until the block ends.
    @param start_view  (environment of the screen) -> Child
    @returns (DemoSession, Screen)
    @raises SessionError"""
    with contextlib.ExitStack() as stack:
        screen = Screen(logs / 'xvfb.log', size, logs)
        stack.callback(screen.close)
        session = DemoSession(ROOT / 'launch/session.launch', logs, keys)
        stack.callback(session.stop)
        session.wait_ready()
        view = start_view(screen.environment)
        stack.callback(view.stop, 10)
        if not wait_until(lambda: session.monitor.has_subscriber('/viz/markers'), PATIENCE):
            raise SessionError(f'rviz does not start; {view.log} ends with\n{view.tail(8)}')
        yield session, screen


def picture(name, size, out, logs):
    """@raises SessionError"""
    logs = logs / f'{name}_{size[0]}'
    logs.mkdir(parents=True)
    keys = {'cell': 'mouse_oocyte_injection', 'injection.layers': 2, **CONSOLES[name]}
    if name == 'train':
        keys.update({'record.folder': logs / 'record', 'record.bag': 'false', 'record.trainee': 'ada',
                     'record.history': logs / 'training.csv'})
    with seen_session(logs, size, keys, lambda environment: start_rviz(name, size, logs, environment)) as (session, screen):
        await_moment(session, keys)
        time.sleep(SETTLE[keys['hand.device']])
        path = out / f'{name}_{size[0]}x{size[1]}.png'
        if not screenshot.take(path, env={**os.environ, **screen.environment}):
            raise SessionError('there is no picture of the screen')
        return path


def main():
    """NAME WIDTH HEIGHT OUT LOGS: one picture; rospy knows one master in a process."""
    name, width, height, out, logs = sys.argv[1:]
    os.environ.pop('DISPLAY', None)
    try:
        print(picture(name, (int(width), int(height)), Path(out), Path(logs)))
    except (SessionError, RvizError, RuntimeError, OSError) as error:
        print(f'{name}: {error}', file=sys.stderr)
        return 1
    return 0


if __name__ == '__main__':
    sys.exit(main())
