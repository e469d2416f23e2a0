#!/usr/bin/python3
"""A session whose needle is led by a controller of one's own: down by 20 um/s until the force is there, then it is held."""
from cell_microinjection import Session

WISHED, FASTEST, PERIOD = 0.5e-6, 20e-6, 0.01  # N, m/s, s


def main():
    with Session('default', 'hand.device:=none', 'injection.mode:=manual') as session:
        for topic in ('/needle/measured_cp', '/cell/predicted_cf', '/controller/injection_state'):
            session.listen(topic, 1)
        session.run_for(0.5)
        target = dict(session.newest('/needle/measured_cp')['pose']['position'])
        while session.time < 12:
            predicted = session.newest('/cell/predicted_cf')
            if predicted['header']['stamp'] > 0:  # else the model has no valid force: the target stays
                force = predicted['wrench']['force']['z']
                target['z'] -= PERIOD * max(-FASTEST, min(FASTEST, FASTEST * (WISHED - force) / WISHED))
            session.say('/teleop/servo_cp', pose={'position': target, 'orientation': {'w': 1.0}},
                        header={'frame_id': 'world', 'stamp': session.now})
            session.run_for(PERIOD)
        state = session.newest('/controller/injection_state')['state']
        print(f'{1e9 * force:.0f} nN of {1e9 * WISHED:.0f}, {state}')


if __name__ == '__main__':
    main()
