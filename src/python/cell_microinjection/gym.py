"""Injecting as a task for programs that learn, with Gymnasium's interface and without its package.

    env = Inject()
    observation, info = env.reset(seed=1)
    while True:
        observation, reward, terminated, truncated, info = env.step(policy(observation))
        if terminated or truncated:
            break

Each reset draws another cell: 20 to 150 um, 2 to 45 kPa, with or without an oolemma behind its zona, off the needle's
line. The policy hears what an operator hears: the needle as the device tells it, the sensor's force with its noise, the
controller's state. The same seed and the same actions give the same bits.
"""
import multiprocessing

import numpy

from cell_microinjection import _core

#: Names and units of an observation's numbers.
OBSERVATION = _core.trial_observation
#: Words for the number `state` of an observation.
STATES = _core.trial_states
FASTEST = 200e-6  # m/s, along an axis
_SEERS = ('vision', 'calibration', 'visual_servo', 'touch', 'focus')  # which find in images what a policy is to find


class Box:
    """The part of gymnasium.spaces.Box that programs use: numbers between two borders."""

    def __init__(self, low, high, shape=None, seed=None):
        shape = shape if shape is not None else numpy.broadcast(low, high).shape
        self.low, self.high = (numpy.broadcast_to(numpy.asarray(each, float), shape).copy() for each in (low, high))
        self.shape, self.dtype = tuple(shape), numpy.dtype(float)
        self._random = numpy.random.default_rng(seed)

    def seed(self, seed):
        """Draws anew from here."""
        self._random = numpy.random.default_rng(seed)

    def sample(self):
        """@returns a value; where a border is infinite, from a normal distribution."""
        bounded = numpy.isfinite(self.low) & numpy.isfinite(self.high)
        even = self._random.uniform(numpy.where(bounded, self.low, 0), numpy.where(bounded, self.high, 1))
        return numpy.where(bounded, even, self._random.normal(size=self.shape))

    def contains(self, value):
        """@returns whether a value has the shape and lies between the borders."""
        value = numpy.asarray(value)
        return value.shape == self.shape and bool(numpy.all((value >= self.low) & (value <= self.high)))


class _Trial:
    """What the tasks share: a trial of a random cell, stepped by a velocity."""

    metadata = {'render_modes': []}
    render_mode = None
    observation_space = Box(-numpy.inf, numpy.inf, (len(OBSERVATION),))

    def __init__(self, *, steps=1, force_delay=0.0, noise=1.0, faults=0.0):
        """steps: ms that an action lasts. force_delay: s, of the sensor. noise: of the sensor, over its usual one.
        faults: the share of cells at which something of the rig fails, once, drawn with the cell. `info` of the last step
        then has `fault`, None or a dict: kind, begin_s, and size: N of sensor_offset, N/s of sensor_drift, s of
        commands_late, m/s of needle_drift, 0 of sensor_frozen and commands_lost."""
        if int(steps) != steps or steps < 1:
            raise _core.ConfigError(f'steps = {steps}: must be a whole number from 1 on')
        self._steps, self._faults = int(steps), float(faults)
        self._settings = {'force_delay': float(force_delay), 'noise': float(noise), 'faults': self._faults}
        self._trial = None
        self._random = numpy.random.default_rng()

    def reset(self, *, seed=None, options=None):
        """@param options  {'cell': N}: the random cell of this number, instead of one drawn by `seed`
        @returns (observation, info)"""
        if seed is not None:
            self._random = numpy.random.default_rng(seed)
        cell = int((options or {}).get('cell', self._random.integers(1, 2**31 - 1)))
        self._trial = _core.Trial(cell, **self._settings)
        observation = self._trial.observation
        self._begin(observation)
        return observation, {'cell': cell}

    def close(self):
        """Ends the trial."""
        self._trial = None

    def _move(self, velocity, inject=False):
        if self._trial is None:
            raise _core.ConfigError('reset() comes before step()')
        return self._trial.step(velocity[0], velocity[1], velocity[2], inject, self._steps)

    def _begin(self, observation):
        """Of a task: what it remembers."""

    def _last(self, info):
        """@returns the info of a last step, with the fault where faults were asked for"""
        return {**info, 'fault': self._trial.fault} if self._faults else info


class Inject(_Trial):
    """To pierce all membranes, give the pulse and come out.

    An action is (vx, vy, vz, inject): the target's velocity, m/s, z away from the cell, and whether the pulse is asked
    for (above 0.5), which the controller gives behind a puncture only. The reward is the training score, 0 to 1, at the
    end (peak force, deformation, lateral error, time, punctures, volume; config/training.yaml says how it counts).
    """

    action_space = Box([-FASTEST, -FASTEST, -FASTEST, 0], [FASTEST, FASTEST, FASTEST, 1])

    def step(self, action):
        """@returns (observation, reward, terminated, truncated, info)"""
        observation = self._move(action, action[3] > 0.5)
        over = self._trial.over
        if not over:
            return observation, 0.0, False, False, {}
        late = observation[0] > 119.9
        score = self._trial.score()
        return observation, score['score'] / 100, not late, late, self._last(score)


class IndentToForce(_Trial):
    """To press with a force and hold it: a share of what the assumed modulus bears, drawn by reset().

    An action is (vx, vy, vz). An observation ends with the wished force, N. The reward of a step is minus the time that
    it took, in s, as long as the true force is off by more than 5 % or, where that is more, two steps of the sensor; the
    task ends when it was within for 0.5 s.
    """

    action_space = Box(-FASTEST, FASTEST, (3,))
    observation_space = Box(-numpy.inf, numpy.inf, (len(OBSERVATION) + 1,))
    TOLERANCE, RESOLVED, HELD, LONGEST = 0.05, 30e-9, 0.5, 60.0  # 1, N, s, s

    def reset(self, *, seed=None, options=None):
        """@returns (observation, info)"""
        observation, info = super().reset(seed=seed, options=options)
        while not options and self._wished < 10 * self.RESOLVED:  # another cell: the sensor would not feel this one's
            observation, info = super().reset()
        return numpy.append(observation, self._wished), info

    def _begin(self, observation):
        diameter, modulus = observation[OBSERVATION.index('diameter_m')], observation[OBSERVATION.index('assumed_modulus_Pa')]
        self._wished = self._random.uniform(0.01, 0.025) * modulus * diameter**2 / 4
        self._within = 0.0

    def step(self, action):
        """@returns (observation, reward, terminated, truncated, info)"""
        observation = self._move(action)
        seconds = 1e-3 * self._steps
        allowed = max(self.TOLERANCE * self._wished, self.RESOLVED)
        good = abs(self._trial.true_force - self._wished) <= allowed
        self._within = self._within + seconds if good else 0.0
        done = self._within >= self.HELD - 1e-9
        late = not done and (self._trial.over or observation[0] > self.LONGEST)
        info = self._last({}) if done or late else {}
        return numpy.append(observation, self._wished), 0.0 if good else -seconds, done, late, info


class ApproachByImage:
    """To bring the tip above the cell by what the microscope shows: a session with the virtual camera, so it needs ROS.

    An observation is the image, (height, width), uint8, of 30 each second. An action is (vx, vz): m/s along the image's
    axes. The reward of a step is the way that it came nearer, over the distance at the start; the task ends when the tip
    is within 3 um of the place 10 um above the cell, or after 20 s.
    """

    metadata, render_mode = {'render_modes': []}, None
    observation_space = None  # of the image, from reset() on
    action_space = Box(-50e-6, 50e-6, (2,))
    PERIOD, SAY, NEAR, ABOVE, LONGEST = 1 / 30, 5e-3, 3e-6, 10e-6, 20.0

    def __init__(self, *overrides):
        """overrides: keys of a session file, 'camera.rate:=30' among them."""
        self._overrides = ('hand.device:=none', 'injection.mode:=manual', 'camera.source:=sim', *overrides)
        self._session = None
        self._random = numpy.random.default_rng()

    def reset(self, *, seed=None, options=None):
        """@returns (image, info); the needle begins up to 60 um beside the cell"""
        from cell_microinjection.session import Session
        self.close()
        if seed is not None:
            self._random = numpy.random.default_rng(seed)
        self._session = Session('default', *self._overrides, without=_SEERS, **(options or {}))
        for topic in ('/needle/measured_cp', '/cell/state', '/microscope/image_raw'):
            self._session.newest(topic)
        self._session.run_for(0.5)
        self.observation_space = Box(0, 255, self._session.image().shape)
        self._target = dict(self._session.newest('/needle/measured_cp')['pose']['position'])
        radius = self._session.newest('/cell/state')['layer_radii'][0]
        self._goal = numpy.array([0.0, radius + self.ABOVE])
        away = self._random.uniform(20e-6, 60e-6) * self._random.choice([-1, 1])
        while abs(self._target['x'] - away) > 1e-9:
            self._move(numpy.clip((away - self._target['x']) / self.PERIOD, -50e-6, 50e-6), 0.0)
        self._start = self._last = self._distance()
        self._began = self._session.time
        return self._session.image(), {}

    def step(self, action):
        """@returns (image, reward, terminated, truncated, info)"""
        if self._session is None:
            raise _core.ConfigError('reset() comes before step()')
        if not self.action_space.contains(action):
            raise _core.ConfigError('action: must be two speeds from -50e-6 to 50e-6 m/s')
        self._move(float(action[0]), float(action[1]))
        distance = self._distance()
        reward, self._last = (self._last - distance) / self._start, distance
        late = self._session.time - self._began > self.LONGEST
        return self._session.image(), reward, distance < self.NEAR, late, {'distance': distance}

    def close(self):
        """Ends the session."""
        if self._session is not None:
            self._session.close()
        self._session = None

    def _move(self, across, along):
        steps = round(self.PERIOD / self.SAY)
        for _ in range(steps):
            self._target['x'] += across * self.PERIOD / steps
            self._target['z'] += along * self.PERIOD / steps
            self._session.say('/teleop/servo_cp', pose={'position': self._target, 'orientation': {'w': 1.0}},
                              header={'frame_id': 'world', 'stamp': self._session.now})
            self._session.run_for(self.PERIOD / steps)

    def _distance(self):
        place = self._session.newest('/needle/measured_cp')['pose']['position']
        return float(numpy.hypot(place['x'] - self._goal[0], place['z'] - self._goal[1]))


def _serve(connection, make):
    env = make()
    while True:
        word, value = connection.recv()
        if word == 'close':
            break
        try:
            connection.send((True, getattr(env, word)(**value) if word == 'reset' else env.step(value)))
        except Exception as error:  # pylint: disable=broad-except  it is the other process' to handle
            connection.send((False, error))


class Vector:
    """Several environments, each in a process of its own: the same bits as in one process.

    make: a class or a function without arguments, known by its name, such as Inject.
    """

    def __init__(self, make, count):
        context = multiprocessing.get_context('spawn')
        if count < 1:
            raise _core.ConfigError(f'count = {count}: must be at least 1')
        self._pipes, self._processes = [], []
        for _ in range(count):
            here, there = context.Pipe()
            process = context.Process(target=_serve, args=(there, make), daemon=True)
            process.start()
            there.close()
            self._pipes.append(here)
            self._processes.append(process)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def reset(self, seeds):
        """@returns (observations, (n, m); infos)"""
        observations, infos = zip(*self._ask('reset', [{'seed': seed} for seed in seeds]))
        return numpy.array(observations), list(infos)

    def reset_one(self, index, seed):
        """Another cell for one that is over. @returns (observation, info)"""
        self._pipes[index].send(('reset', {'seed': seed}))
        return self._raise(self._pipes[index].recv())

    def step(self, actions):
        """@returns (observations, rewards, terminated, truncated, infos); one that is over needs reset_one()"""
        answers = self._ask('step', actions)
        return (*(numpy.array([answer[i] for answer in answers]) for i in range(4)), [answer[4] for answer in answers])

    def close(self):
        """Ends the processes."""
        for pipe in self._pipes:
            try:
                pipe.send(('close', None))
            except OSError:
                pass
        for process in self._processes:
            process.join(5)
            process.kill()

    def _ask(self, word, values):
        if len(values) != len(self._pipes):
            raise _core.ConfigError(f'{len(values)} of {len(self._pipes)} environments are told: must be all')
        for pipe, value in zip(self._pipes, values):
            pipe.send((word, value))
        answers = [pipe.recv() for pipe in self._pipes]  # all, before one of them is raised
        return [self._raise(answer) for answer in answers]

    @staticmethod
    def _raise(answer):
        good, value = answer
        if not good:
            raise value
        return value
