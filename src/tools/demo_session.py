"""The nodes of a session with a ROS master of their own, started and watched from outside."""
import os
import re
import shlex
import xmlrpc.client

from processes import Child, free_port, wait_until
from session_monitor import SessionMonitor

START_TIMEOUT = 180  # s of wall time, for the nodes to come up and the cell to be meshed
PACE_REPORTS = 3     # of each node, one a second; and
PACE_TIMEOUT = 20    # s of wall time for them: who cannot even report is too slow
STOP_PATIENCE = 40   # s, for the nodes to end by themselves and the bag to be closed


class SessionError(Exception):
    """What went wrong, for the user."""


class DemoSession:
    """session.launch, whose hand rests until monitor.go()."""

    def __init__(self, launch_file, logs, keys):
        """@param keys  of a session file (config/sessions/default.yaml), such as {'hand.device': 'none'}"""
        self._recorded = 'record.folder' in keys
        port = free_port()
        # By address, so that it does not matter what this machine's name resolves to.
        os.environ.pop('ROS_HOSTNAME', None)
        os.environ.update(ROS_MASTER_URI=f'http://127.0.0.1:{port}', ROS_IP='127.0.0.1', ROS_LOG_DIR=str(logs))
        # By its path: a search by name would follow catkin_ws's link to the repository round and round.
        changes = {'hand.wait_for_go': 'true', **keys}
        self._launch = Child(['roslaunch', '-p', str(port), str(launch_file),
                              'set:=' + ' '.join(shlex.quote(f'{key}={value}') for key, value in changes.items())],
                             logs / 'session.log')
        self.monitor = None

    def wait_ready(self):
        """Until the session can begin. @raises SessionError when it cannot within START_TIMEOUT."""
        self._wait(self._master_answers, 'the ROS master does not answer')
        self.monitor = SessionMonitor()
        self._wait(lambda: self.monitor.state is not None, 'nothing came on /cell/state')
        if self._recorded:
            # It is started last, and must not miss the beginning.
            self._wait(lambda: self.monitor.has_subscriber('/cell/predicted_cf', '/session_recorder'),
                       'the recorder does not listen')

    def too_slow(self):
        """Returns the names of nodes whose loops do not keep their rate on this computer, after some seconds; none: all do."""
        pace = self.monitor.pace
        pace.begin()

        def reported():
            self.check()
            return pace.reports() >= PACE_REPORTS
        return pace.slow() if wait_until(reported, PACE_TIMEOUT) else pace.slow() or ['all nodes']

    def check(self):
        """@raises SessionError when a node or the launch has died."""
        dead = re.findall(r'\[([^\[\s]+)-\d+\] process has died', self._launch.output())
        if dead:
            raise SessionError(f'died: {", ".join(dead)}; {self._launch.log} ends with\n{self._launch.tail(20)}')
        if not self._launch.running():
            raise SessionError(f'roslaunch has ended; {self._launch.log} ends with\n{self._launch.tail(20)}')

    def stop(self):
        """Ends the nodes in order, so that the recorder closes its files."""
        if self.monitor:
            self.monitor.close()
        self._launch.stop(STOP_PATIENCE)

    def _master_answers(self):
        try:
            with xmlrpc.client.ServerProxy(os.environ['ROS_MASTER_URI']) as master:
                return master.getPid('/demo')[0] == 1
        except (OSError, xmlrpc.client.Error):
            return False

    def _wait(self, condition, otherwise):
        def there():
            self.check()
            return condition()
        if not wait_until(there, START_TIMEOUT):
            raise SessionError(f'{otherwise} within {START_TIMEOUT} s; {self._launch.log} ends with\n'
                               f'{self._launch.tail(20)}')
