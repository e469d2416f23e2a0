"""The force over the travel of a needle from a ROS bag, as a record for identify()."""
import numpy
import rosbag

NEEDLE, FORCE = '/needle/measured_cp', '/force_sensor/measured_cf'
FORCE_FRAME = 'needle_tip'
FURTHEST = 0.05  # s, from a force to the positions that it is put between


def curve_of_bag(path, needle=NEEDLE, force=FORCE):
    """@returns {'time_s', 'position_m', 'force_N'}: arrays; the travel along the pipette towards the cell and the force
        along it, at the forces' times. What is not valid is left out.
    @raises ValueError when the bag has no such messages, rosbag.ROSBagException when it is none"""
    places, axes, forces = [], [], []
    with rosbag.Bag(str(path)) as bag:
        for topic, message, _ in bag.read_messages(topics=[needle, force]):
            stamp = message.header.stamp.to_sec()
            if not stamp:  # invalid (CRTK)
                continue
            if topic == needle:
                place = message.pose.position
                places.append((stamp, place.x, place.y, place.z))
                axes.append(_axis_of(message.pose.orientation))
            else:
                if message.header.frame_id.lstrip('/') != FORCE_FRAME:
                    raise ValueError(f'{force} has frame {message.header.frame_id!r}: must be {FORCE_FRAME}')
                forces.append((stamp, message.wrench.force.z))
    for topic, found in ((needle, places), (force, forces)):
        if not found:
            raise ValueError(f'no valid message on {topic}')
    return _curve(numpy.array(places), numpy.array(axes), numpy.array(forces))


def _axis_of(orientation):
    """z of the needle in the world, from a quaternion."""
    x, y, z, w = orientation.x, orientation.y, orientation.z, orientation.w
    return numpy.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])


def _curve(places, axes, forces):
    finite = numpy.isfinite(places).all(axis=1) & numpy.isfinite(axes).all(axis=1)
    places, axes = places[finite], axes[finite]
    order = numpy.argsort(places[:, 0], kind='stable')
    places, axes = places[order], axes[order]
    travel = -(places[:, 1:] * axes).sum(axis=1)
    forces = forces[numpy.argsort(forces[:, 0], kind='stable')]
    after = numpy.searchsorted(places[:, 0], forces[:, 0])
    known = (after > 0) & (after < len(places)) & numpy.isfinite(forces[:, 1])
    forces, after = forces[known], after[known]
    apart = places[after, 0] - places[after - 1, 0]
    forces = forces[apart <= FURTHEST]
    if not len(forces):
        raise ValueError('no force is between two positions of the needle')
    return {'time_s': forces[:, 0] - forces[0, 0],
            'position_m': numpy.interp(forces[:, 0], places[:, 0], travel), 'force_N': forces[:, 1]}
