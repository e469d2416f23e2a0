"""Messages that nobody should send: every field of a message with values that are wild, wrong or at the end of their
range, alone and together."""

import random

import genpy
import rospy

KINDS = 250  # of each topic, at least

FLOATS = [float("nan"), float("inf"), float("-inf"), 1e160, -1e160, 1.7e308, -1.7e308, 5e-324, 1e30, 1e9, -1.0, 1.0]
FLOATS32 = [float("nan"), float("inf"), float("-inf"), 3.4e38, -3.4e38, 1e-45, 1e9, -1.0, 1.0]
STRINGS = ["", "x" * 100000, "a\nb\tc", "\x00", "camera", "world", "enable", "no command", "../..", "ä" * 100, "%s%n"]
INTEGERS = {f"{sign}int{bits}": bits for sign in ("", "u") for bits in (8, 16, 32, 64)}


def integers(kind):
    bits = INTEGERS[kind]
    if kind.startswith("u"):
        return [0, 1, 2 ** bits - 1, 2 ** (bits - 1)]
    return [0, 1, -1, 2 ** (bits - 1) - 1, -2 ** (bits - 1)]


def times():
    """Of stamps: none, far back, now and farther and farther ahead, up to the last one that there is."""
    now = rospy.Time.now()
    ahead = [now + rospy.Duration(seconds) for seconds in (-1e6, -1, -0.04, 0.9, 2, 3600)]
    return [rospy.Time(), rospy.Time(0, 1), *ahead, rospy.Time(2 ** 31), rospy.Time(2 ** 32 - 1, 999999999)]


def values(kind):
    """Hostile values of a primitive field."""
    if kind == "float64":
        return FLOATS
    if kind == "float32":
        return FLOATS32
    if kind == "string":
        return STRINGS
    if kind == "bool":
        return [False, True]
    if kind == "time":
        return times()
    if kind == "duration":
        return [rospy.Duration(), rospy.Duration(2 ** 31 - 1, 999999999), rospy.Duration(-2 ** 31, 0)]
    return integers(kind.replace("byte", "int8").replace("char", "uint8"))


def fields(message, path=()):
    """[(path, type)] of all that can be set, arrays as a whole."""
    found = []
    for name, kind in zip(message.__slots__, message._slot_types):
        child = getattr(message, name)
        if "[" in kind or not isinstance(child, genpy.Message):
            found.append((path + (name,), kind))
        else:
            found += fields(child, path + (name,))
    return found


def arrays(kind):
    """Hostile values of an array field; of one with a fixed length its length is kept."""
    element, _, length = kind.partition("[")
    length = length.rstrip("]")
    if element in INTEGERS or element in ("float32", "float64", "bool", "string", "time"):
        if length:
            return [[value] * int(length) for value in values(element)]
        return [[], *([value] for value in values(element)), *([value] * 3 for value in values(element)[:4]),
                [values(element)[0]] * 100000 if element != "string" else ["x"] * 1000]
    return [[]]


def elements(kind, make):
    """Of an array of messages: one and several of them, hostile."""
    element = kind.partition("[")[0]
    return [[make(element)] * count for count in (1, 1, 1, 50)]


def put(message, path, value):
    for name in path[:-1]:
        message = getattr(message, name)
    setattr(message, path[-1], value)


def plausible(make):
    """What the fields are that are not hostile: now, in no frame, unrotated."""
    message = make()
    if hasattr(message, "header"):
        message.header.stamp = rospy.Time.now()
    pose = getattr(message, "pose", None)
    if pose is not None and hasattr(pose, "orientation"):
        pose.orientation.w = 1
    return message


def hostile_elements(classes, kind, source):
    cls = classes(kind)
    message = plausible(cls)
    for path, field in source.sample(fields(message), k=min(2, len(fields(message)))):
        put(message, path, source.choice(arrays(field) if "[" in field else values(field)))
    return message


def hostile_messages(cls, classes, seed):
    """At least KINDS of them. `classes`: type's name -> class, of messages in arrays."""
    source = random.Random(seed)
    make_element = lambda kind: hostile_elements(classes, kind, source)  # noqa: E731

    def choices(kind):
        if "[" not in kind:
            return values(kind)
        simple = arrays(kind)
        return simple if len(simple) > 1 else simple + elements(kind, make_element)

    messages = []
    for path, kind in fields(cls()):
        for value in choices(kind):
            message = plausible(cls)
            put(message, path, value)
            messages.append(message)
    while len(messages) < KINDS:
        message = plausible(cls)
        for path, kind in source.sample(fields(message), k=min(source.randint(1, 5), len(fields(message)))):
            put(message, path, source.choice(choices(kind)))
        messages.append(message)
    return messages
