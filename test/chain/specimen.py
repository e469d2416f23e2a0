"""What a test puts under the virtual microscope."""

import numpy as np
import rospy
from cell_microinjection.msg import CellState
from geometry_msgs.msg import Point32, TransformStamped

RINGS, SECTORS = 24, 48


def sphere(radius):
    """@returns the state of a round cell of `radius` (m), in the frame cell"""
    state = CellState()
    state.header.frame_id = "cell"
    places = [(0, 0, 1)]
    for ring in range(1, RINGS):
        polar = np.pi * ring / RINGS
        for sector in range(SECTORS):
            turn = 2 * np.pi * (sector + 0.5) / SECTORS
            places.append((np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)))
    places.append((0, 0, -1))
    state.vertices = [Point32(*(radius * np.array(place))) for place in places]
    last = len(places) - 1
    for sector in range(SECTORS):
        beside = (sector + 1) % SECTORS
        state.triangles += [0, 1 + sector, 1 + beside]
        bottom = 1 + (RINGS - 2) * SECTORS
        state.triangles += [last, bottom + beside, bottom + sector]
        for ring in range(RINGS - 2):
            a, b = 1 + ring * SECTORS, 1 + (ring + 1) * SECTORS
            state.triangles += [a + sector, b + sector, a + beside, a + beside, b + sector, b + beside]
    state.displacement = [0] * len(places)
    state.parameter_names, state.parameter_values = ["diameter"], [2 * radius]
    return state


def transform(child, position):
    """@returns the transform world -> child, at `position` (m), now"""
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id, message.header.stamp = "world", rospy.Time.now()
    t = message.transform.translation
    t.x, t.y, t.z = position
    message.transform.rotation.w = 1
    return message
