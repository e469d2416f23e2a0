"""Sessions on virtual time, from Python."""
import importlib.util
import subprocess
import sys
import threading
import unittest

import numpy

if importlib.util.find_spec('cell_microinjection._session') is None:
    raise unittest.SkipTest('needs ROS')

import cell_microinjection as cm  # noqa: E402
from cell_microinjection import gym  # noqa: E402
from cell_microinjection import session as sessions  # noqa: E402

LED = ('hand.device:=none', 'injection.mode:=manual')


class ASessionTest(unittest.TestCase):
    def test_is_stepped_read_and_commanded(self):
        with cm.Session('default', *LED, cell='mouse_oocyte_injection') as session:
            self.assertIsNone(session.newest('/controller/operating_state'))
            session.run_for(0.5)
            self.assertAlmostEqual(session.time, 0.5, 6)
            self.assertEqual(session.newest('/controller/operating_state')['state'], 'ENABLED')
            pose = session.newest('/needle/measured_cp')
            session.step(0.1)
            pose = session.newest('/needle/measured_cp')
            self.assertGreater(pose['header']['stamp'], 1)
            self.assertTrue(numpy.isfinite(list(pose['pose']['position'].values())).all())
            session.say('/controller/state_command', string='disable')
            session.run_for(0.1)
            self.assertEqual(session.newest('/controller/operating_state')['state'], 'DISABLED')

    def test_gives_the_same_bits_each_time(self):
        def run():
            with cm.Session('default') as session:
                session.listen('/cell/predicted_cf')
                session.run_for(2)
                return [message['wrench']['force']['z'] for message in session.take('/cell/predicted_cf')]
        first = run()
        self.assertGreater(len(first), 1000)
        self.assertEqual(first, run())

    def test_injects_until_the_outcome_is_there(self):
        with cm.Session('injection', 'injection.start_when_enabled:=true') as session:
            outcome = lambda: (session.newest('/controller/injection_state') or {}).get('outcome')  # noqa: E731
            session.run_until(lambda: outcome() == 'injected', limit=60)
            with self.assertRaises(cm.SessionError):
                session.run_until(lambda: False, limit=0.1)

    def test_shows_its_image(self):
        with cm.Session('default', *LED, **{'camera.source': 'sim'}) as session:
            session.image()
            session.run_for(0.5)
            image = session.image()
            self.assertEqual(image.ndim, 2)
            self.assertGreater(image.std(), 2)

    def test_a_frozen_node_is_felt(self):
        with cm.Session('default', *LED) as session:
            session.run_for(0.5)
            session.newest('/controller/loop_state')
            session.freeze('micromanipulator')
            session.run_for(0.5)
            self.assertFalse(session.newest('/controller/loop_state')['follows'])
            with self.assertRaisesRegex(cm.ConfigError, 'no such node'):
                session.freeze('nobody')
            for end in (session.kill, session.restart):
                with self.assertRaisesRegex(cm.ConfigError, "program's own"):
                    end('python')

    def test_says_what_is_wrong(self):
        with self.assertRaisesRegex(cm.ConfigError, 'model = wrong: must be one of'):
            cm.Session('default', model='wrong')
        with cm.Session('default', *LED) as session:  # the one before is no more
            with self.assertRaisesRegex(cm.ConfigError, 'a session is open'):
                cm.Session('default')
            with self.assertRaisesRegex(cm.ConfigError, 'no node has it; there are: .*/cell/state'):
                session.newest('/nothing')
            with self.assertRaisesRegex(cm.ConfigError, 'there is no field text; known here: header, string'):
                session.say('/controller/state_command', text='enable')
        with self.assertRaisesRegex(cm.ConfigError, 'without = nobody: .* there are: .*cell_simulator'):
            cm.Session('default', without=['nobody'])
        with self.assertRaisesRegex(cm.ConfigError, 'is closed'):
            session.run_for(1)

    def test_another_thread_waits(self):
        said = []
        with cm.Session('default', *LED) as session:
            runner = threading.Thread(target=session.run_for, args=(20,))
            runner.start()
            while runner.is_alive():
                try:
                    session.newest('/cell/state')
                except cm.ConfigError as error:
                    said.append(str(error))
            runner.join()
            session.newest('/cell/state')
        self.assertTrue(said and all('another thread must wait' in text for text in said), said[:1])

    def test_a_policy_that_raises_ends_it(self):
        with self.assertRaises(ZeroDivisionError):
            with cm.Session('default', *LED) as session:
                session.run_until(lambda: 1 / 0, limit=1)
        with cm.Session('default', *LED) as session:
            session.run_for(0.01)

    def test_the_interpreter_may_end_while_it_runs(self):
        program = ('import cell_microinjection as cm\n'
                   'session = cm.Session("default", "hand.device:=none", "injection.mode:=manual")\n'
                   'session.run_for(0.1)\nprint("end")\n')
        done = subprocess.run([sys.executable, '-c', program], capture_output=True, text=True, check=False, timeout=60)
        self.assertEqual((done.returncode, done.stdout.splitlines()[-1:]), (0, ['end']), done.stderr)

    def test_waits_end_whatever_the_rest(self):
        with cm.Session('default', *LED) as session:
            for start in numpy.linspace(0.01, 0.03, 20):
                session.run_for(start)
                with self.assertRaises(cm.SessionError):
                    session.run_until(lambda: False, limit=0.01, stride=0.003)
            with self.assertRaisesRegex(cm.ConfigError, 'stride = 0'):
                session.run_until(lambda: False, limit=0.01, stride=0)

    def test_listens_to_all_after_the_newest(self):
        with cm.Session('default', *LED) as session:
            session.newest('/cell/state')
            session.listen('/cell/state')
            session.run_for(0.5)
            self.assertGreater(len(session.take('/cell/state')), 20)
            with self.assertRaisesRegex(cm.ConfigError, 'comes before take'):
                session.take('/controller/loop_state')

    def test_messages_are_dicts_of_numbers(self):
        with cm.Session('default', *LED) as session:
            session.newest('/cell/state')
            session.run_for(0.2)
            state = session.newest('/cell/state')
            self.assertIsInstance(state['layer_radii'], numpy.ndarray)
            self.assertEqual(sessions._value(b'\x01\x02', 'uint8[]').tolist(), [1, 2])  # pylint: disable=protected-access


class AnApproachTest(unittest.TestCase):
    def test_by_the_image_ends_above_the_cell(self):
        """The policy cheats: what counts here is the task."""
        env = gym.ApproachByImage()
        self.addCleanup(env.close)
        image, _ = env.reset(seed=4)
        self.assertEqual((image.ndim, image.dtype), (2, numpy.uint8))
        total, info, done = 0.0, {}, False
        for _ in range(300):
            place = env._session.newest('/needle/measured_cp')['pose']['position']  # pylint: disable=protected-access
            away = env._goal - [place['x'], place['z']]  # pylint: disable=protected-access
            image, reward, done, late, info = env.step(numpy.clip(2 * away, -40e-6, 40e-6))
            total += reward
            if done or late:
                break
        self.assertTrue(done, info)
        self.assertGreater(total, 0.7)
        with self.assertRaisesRegex(cm.ConfigError, 'two speeds'):
            env.step([1, 0])


if __name__ == '__main__':
    unittest.main()
