"""A Python participant of the lock step: a test that plays the part of one or more nodes, tick by tick."""

import collections
import queue
import threading

import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Header, String

from links import await_links

INVALID = object()
PATIENCE = 120  # s of wall time; only a chain that hangs takes that long


class Participant:
    """Takes part in the lock step under the name of this node. Between two ticks time stands still."""

    def __init__(self, outputs, inputs, patience=PATIENCE):
        """Returns in the first tick, with every connection in place.
        @param outputs, inputs  topic -> message class; inputs keep their newest message in `seen`."""
        self._patience = patience
        self.seen = {}
        self.now = rospy.Time()
        self.diagnostics, self._reported = {}, {}
        self._ticks = queue.Queue()
        self._outputs = {topic: self._advertise(topic, kind) for topic, kind in outputs.items()}
        self._silences = {topic: self._advertise(topic + "/silent", Header) for topic in outputs}
        self._acknowledgement = self._advertise("/lockstep/acknowledgement", Header)
        # topic -> its newest stamps, each once; a node is never more than a tick ahead.
        self._heard = collections.defaultdict(lambda: collections.deque(maxlen=4))
        self._left, self._feeders = "", {}
        self._changed = threading.Condition()
        self._subscribers = [rospy.Subscriber(topic, kind, self._see, topic) for topic, kind in inputs.items()]
        self._subscribers += [rospy.Subscriber(topic + "/silent", Header, self._hear_silence, topic) for topic in inputs]
        self._subscribers.append(rospy.Subscriber("/lockstep/left", String, self._on_left))
        self._subscribers.append(rospy.Subscriber("/diagnostics", DiagnosticArray, self._on_diagnostics))
        self._subscribers.append(rospy.Subscriber("/clock", Clock, lambda message: self._ticks.put(message.clock)))
        for publisher in self._silences.values():
            publisher.publish(Header())  # the greeting that nodes wait for
        self._acknowledge(rospy.Time())
        try:
            self.now = self._ticks.get(timeout=self._patience)
            self.await_links()
            self._feeders = self._find_feeders(inputs)
        except BaseException:
            self.close()
            raise

    def await_links(self):
        """Returns when whoever has registered a topic is connected with all others of it. How many ticks pass in that
        time would depend on the machine: none does. Call it when this process has registered more topics."""
        await_links(self._patience)

    def _advertise(self, topic, kind):
        return rospy.Publisher(topic, kind, queue_size=100, latch=True)

    def _see(self, message, topic):
        self.seen[topic] = message
        if hasattr(message, "header"):
            self._hear(topic, message.header.stamp)

    def _hear_silence(self, header, topic):
        self._hear(topic, header.stamp)

    def _hear(self, topic, stamp):
        with self._changed:
            if stamp not in self._heard[topic]:  # some say several things in a tick
                self._heard[topic].append(stamp)
            self._changed.notify_all()

    def _on_left(self, message):
        with self._changed:
            self._left = message.data
            self._changed.notify_all()

    def _find_feeders(self, topics):
        """{topic: node} of the inputs that take part in the lock step: their publisher says each tick when it has none."""
        publishers = dict(rosgraph.Master(rospy.get_name()).getSystemState()[0])
        return {topic: publishers[topic + "/silent"][0] for topic in topics if publishers.get(topic + "/silent")}

    def _await_inputs(self, tick):
        """Until `seen` has what was said in this tick. Messages and silences have connections of their own: the next
        tick's silence may come before this one's message."""
        def complete():
            return all(tick in self._heard[topic] or f"{node} " in self._left
                       for topic, node in self._feeders.items())
        with self._changed:
            if not self._changed.wait_for(complete, self._patience):
                raise RuntimeError(f"of {tick} not all of {self._feeders} was heard: {self._heard}")

    def _on_diagnostics(self, message):
        for status in message.status:
            self.diagnostics[status.name] = status
            self._reported[status.name] = message.header.stamp

    def _acknowledge(self, stamp):
        self._acknowledgement.publish(Header(stamp=stamp, frame_id=rospy.get_name()))

    def tick(self, messages=None):
        """One tick with {topic: message}; outputs without one are silent; INVALID withdraws the one before as stamp 0
        does. Returns when the next tick has begun."""
        messages = messages or {}
        for topic, publisher in self._outputs.items():
            if messages.get(topic) is INVALID:
                self._silences[topic].publish(Header(stamp=self.now, frame_id="invalid"))
            elif topic in messages:
                messages[topic].header.stamp = self.now
                publisher.publish(messages[topic])
            else:
                self._silences[topic].publish(Header(stamp=self.now))
        done = self.now
        self._acknowledge(done)
        self.now = self._ticks.get(timeout=self._patience)
        self._await_inputs(done)

    def run(self, ticks, messages=None):
        for _ in range(ticks):
            self.tick(messages() if callable(messages) else messages)

    def run_to_status(self, name, ticks, messages=None):
        """Some ticks, and more until the diagnostics of a later one have come. @returns (level, message) of `name`."""
        self.run(ticks, messages)
        since = self.now
        for _ in range(20000):
            if self._reported.get(name, rospy.Time()) > since:
                return self.status(name)
            self.run(1, messages)
        raise RuntimeError(f"no diagnostics of {name} since {since}: {self._reported}")

    def unsubscribe(self):
        """Hears nothing any more."""
        for subscriber in self._subscribers:
            subscriber.unregister()
        # The next one's time begins anew: what is latched here would be ahead of it.
        for publisher in (*self._outputs.values(), *self._silences.values()):
            publisher.unregister()

    def close(self):
        """Is gone for those that go on. Before another one is made in this process."""
        self.unsubscribe()
        for publisher in [*self._outputs.values(), *self._silences.values(), self._acknowledgement]:
            publisher.unregister()

    def call(self, service, kind, *arguments, messages=None):
        """Calls a service of a node that answers in a tick, which have `messages`, and returns its answer."""
        rospy.wait_for_service(service, timeout=PATIENCE)
        answers = []
        thread = threading.Thread(target=lambda: answers.append(rospy.ServiceProxy(service, kind)(*arguments)))
        thread.start()
        while thread.is_alive():
            self.run(1, messages)
        return answers[0]

    def status(self, name):
        """(level, message) that the diagnostics say of e.g. 'haptic_bridge: loop'."""
        status = self.diagnostics[name]
        return status.level, status.message
