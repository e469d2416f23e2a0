"""What the demo sees of a running session: the virtual hand's phase and the state of the cell, and a line about it."""
import sys
import time


class PaceRecord:
    """Whether the nodes keep the rates of their loops, by what each tells of it once a second."""

    def __init__(self):
        self._slow = {}  # by node: whether it was too slow, since begin()

    def begin(self):
        """Forgets the reports, but not who has reported."""
        self._slow = {node: [] for node in self._slow}

    def add(self, message):
        """@param message  diagnostic_msgs/DiagnosticArray"""
        for status in message.status:
            node, _, name = status.name.partition(': ')
            if name == 'cycle':
                self._slow.setdefault(node, []).append(status.level != 0)

    def reports(self):
        """Returns the least number of reports of any node; 0 before the first."""
        return min(map(len, list(self._slow.values())), default=0)

    def slow(self):
        """Returns the nodes that were too slow in most of their reports."""
        return sorted(node for node, slow in list(self._slow.items()) if 2 * sum(slow) > len(slow))


class SessionMonitor:
    """Listens to a session. Create it only when the master answers."""

    def __init__(self):
        # Imported late, since rospy takes the master's address and the log's folder from the environment at once.
        import rospy
        from cell_microinjection.msg import CellState, InjectionStatus, StringStamped
        from diagnostic_msgs.msg import DiagnosticArray
        self._rospy = rospy
        rospy.init_node('demo', anonymous=True, disable_signals=True)
        self.phase = None
        self.phase_began = time.monotonic()
        self.state = self.injection = None
        self.punctures, self.volume = 0, 0.0  # felt; m^3, given
        self.pace = PaceRecord()
        self._subscribers = [rospy.Subscriber('/virtual_hand/phase', StringStamped, self._on_phase, queue_size=10),
                             rospy.Subscriber('/cell/state', CellState, self._on_state, queue_size=1),
                             rospy.Subscriber('/controller/injection_state', InjectionStatus, self._on_injection,
                                              queue_size=10),
                             rospy.Subscriber('/diagnostics', DiagnosticArray, self.pace.add, queue_size=100)]

    def _on_phase(self, message):
        self.phase_began = time.monotonic()
        self.phase = message.string

    def _on_state(self, message):
        self.state = message

    def _on_injection(self, message):
        # A needle that sets out again counts from zero.
        self.injection = message.state
        self.punctures = max(self.punctures, message.punctures)
        self.volume = max(self.volume, message.volume)

    def phase_age(self):
        """s of wall time since the phase began."""
        return time.monotonic() - self.phase_began

    def has_subscriber(self, topic, node=None):
        """Returns whether a node, or the one of this name, listens to the topic."""
        subscriptions = self._rospy.get_master().getSystemState()[2][1]
        return any(name == topic and (node in nodes if node else nodes) for name, nodes in subscriptions)

    def go(self):
        """Lets the waiting virtual hand begin."""
        self._rospy.set_param('/session/go', True)

    def close(self):
        for subscriber in self._subscribers:
            subscriber.unregister()
        self._rospy.signal_shutdown('the demo is over')

    def figures(self):
        """Depth and force as text."""
        state = self.state
        if state is None:
            return 'waiting for the cell'
        force = (state.force.x ** 2 + state.force.y ** 2 + state.force.z ** 2) ** 0.5
        text = f'depth {1e6 * state.indentation:6.2f} um   force {1e6 * force:6.3f} uN'
        if state.punctured:
            return text + '   punctured'
        return text if state.converged else text + f'   no solution: {state.reason}'


class Progress:
    """One line that follows the session on a terminal; elsewhere a line for each phase."""

    def __init__(self, stream=sys.stdout):
        self._stream = stream
        self._live = stream.isatty()
        self._phase = None

    def show(self, monitor):
        phase = monitor.phase or 'running'
        changed, self._phase = phase != self._phase, phase
        line = f'  {phase:<9} {monitor.figures()}'
        if self._live:
            self._stream.write(('\n' if changed else '') + f'\r\033[K{line}')
        elif changed:
            self._stream.write(line + '\n')
        self._stream.flush()

    def end(self):
        if self._live and self._phase is not None:
            self._stream.write('\n')
            self._stream.flush()
