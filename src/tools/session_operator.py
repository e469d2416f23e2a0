"""Commands of a running session's injection from a terminal, and waiting for its states."""
from demo_session import SessionError
from processes import wait_until


class SessionOperator:
    """Waits at most `patience` (s of wall time) each time. @raises SessionError"""

    def __init__(self, patience):
        import rospy  # late: it takes the master's address from the environment at once
        from cell_microinjection.msg import InjectionStatus, StringStamped
        self.status = None
        self._patience, self._stamped = patience, StringStamped
        self._commands = rospy.Publisher('/controller/state_command', StringStamped, queue_size=1)
        rospy.Subscriber('/controller/injection_state', InjectionStatus, lambda m: setattr(self, 'status', m))
        self.wait(lambda: self.status and self._commands.get_num_connections() > 0, 'the controller')

    def wait(self, condition, what):
        if not wait_until(condition, self._patience, period=0.02):
            raise SessionError(f'{what}: not within {self._patience} s; {self.status}')

    def say(self, command, condition):
        self._commands.publish(self._stamped(string=command))
        self.wait(condition, command)

    def waits_in(self, state):
        return self.status.state == state and self.status.waits
