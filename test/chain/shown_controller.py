"""A controller of a test's own, for a console: it reports a state, and executes enable, disable, pause and resume."""

import rospy
from cell_microinjection.msg import InjectionStatus, OperatingState, StringStamped

NEXT = {"enable": "ENABLED", "resume": "ENABLED", "disable": "DISABLED", "pause": "PAUSED"}
PERIOD = 0.1  # s, of its reports


class ShownController:
    """`parameters`: those that a console reads. The process has to be the node /injection_controller: a console sends
    nothing before that one listens."""

    def __init__(self, **parameters):
        rospy.set_param("/injection_controller", parameters)
        self.state, self.status = "DISABLED", InjectionStatus(state="idle")
        # As the real one: its operating state comes at a change only.
        self._operating = rospy.Publisher("/controller/operating_state", OperatingState, queue_size=10, latch=True)
        self._injection = rospy.Publisher("/controller/injection_state", InjectionStatus, queue_size=1)
        self.change(self.state)
        self._commands = None
        self.listen()
        self._beat = rospy.Timer(rospy.Duration(PERIOD), lambda _: self._injection.publish(self.status))

    def listen(self):
        self._commands = rospy.Subscriber("/controller/state_command", StringStamped,
                                          lambda message: self.change(NEXT.get(message.string, self.state)))

    def deafen(self):
        self._commands.unregister()

    def change(self, state):
        self.state = state
        self._operating.publish(OperatingState(state=state, is_homed=True))

    def close(self):
        self._beat.shutdown()
        self.deafen()
