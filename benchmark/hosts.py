#!/usr/bin/python3
"""A session over three hosts and a network that is slow and loses frames: how far the needle moves after each fault.

The hosts are network namespaces, joined by a switch that delays each frame and loses some. After each fault, the time-outs
of the session (1 s; 5 s for a master that hangs) and half a second, the needle has to rest. Needs root.
"""
import argparse
import csv
import os
import sys
import traceback
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PROGRAMS = ROOT / 'catkin_ws/install/lib/cell_microinjection'
sys.path.insert(0, str(ROOT / 'test' / 'chain'))
sys.path.insert(0, str(ROOT / 'src' / 'tools'))


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--out', type=Path, required=True, help='folder of hosts.csv')
    parser.add_argument('--delay', type=float, default=0.02, help='s one way (default %(default)s)')
    parser.add_argument('--loss', type=float, default=0.05, help='share of the frames (default %(default)s)')
    return parser.parse_args()


def measure(session, three_hosts, path):
    """Writes a row for each fault. Returns the exit status: 1 when the needle did not rest after one."""
    status = 0
    with open(path, 'w', newline='', encoding='utf-8') as file:
        table = csv.writer(file)
        table.writerow(('fault', 'who', 'moved_um', 'rests'))
        for how, who in three_hosts.FAULTS:
            moved = session.measure(how, who)
            rests = moved < three_hosts.STILL
            status = status if rests else 1
            table.writerow((how, who, f'{1e6 * moved:.4f}', int(rests)))
            file.flush()
            print(f'{who} {how}: the needle moved {1e6 * moved:.4f} um: {"rests" if rests else "DOES NOT REST"}', flush=True)
    frames = session.switch.lost + session.switch.passed
    print(f'{frames} frames, {100 * session.switch.lost / frames:.1f} % lost')
    return status


def main():
    arguments = parse_arguments()
    sys.argv[0] = str(PROGRAMS / 'hosts')  # the chain's programs are beside it
    import lossy_network
    if not lossy_network.possible():
        sys.exit('hosts: needs root, /dev/net/tun and a system that allows network namespaces')
    import three_hosts
    arguments.out.mkdir(parents=True, exist_ok=True)
    status = 1
    session = three_hosts.ThreeHosts(arguments.delay, arguments.loss)
    try:
        status = measure(session, three_hosts, arguments.out / 'hosts.csv')
    except Exception:
        traceback.print_exc()
    finally:
        session.close()
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)  # rospy's threads would wait for hosts that are gone


if __name__ == '__main__':
    main()
