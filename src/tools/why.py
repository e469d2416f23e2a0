#!/usr/bin/python3
"""Why a session does not do what it is asked to, and what to do: /session/readiness as a text.

The first reason is the one to mend first; others may follow from it. Where the remedy is a long one, the section of
doc/guide/troubleshooting.md is named.

Exit status: 0 the session is ready; 1 it is not; 2 bad usage; 3 there is no session, or its node readiness is silent.
"""

import argparse
import sys
import textwrap
from queue import Empty, Queue
from xmlrpc.client import ProtocolError

import rospy

from cell_microinjection.msg import Hindrance, Readiness

PATIENCE = 3  # s, for a session's answer; it tells twice a second
WIDTH = 100
LEVELS = {Hindrance.OK: '', Hindrance.WARN: 'warning: ', Hindrance.ERROR: 'error: '}


def text_of(readiness):
    """The message as lines for a person."""
    lines = ['the session is ready' if readiness.ready else 'the session is not ready']
    for number, each in enumerate(readiness.hindrances, 1):
        held = ', holds the needle' if each.holds else ''
        lines.append(f'{number}. {each.node} ({each.status}{held}): {LEVELS.get(each.level, "")}{each.reason}')
        see = f'see "{each.section}" in doc/guide/troubleshooting.md' if each.section else ''
        remedy = f'{each.remedy} ({see})' if each.remedy and see else each.remedy or see
        if remedy:
            lines += textwrap.wrap(remedy, WIDTH, initial_indent='     ', subsequent_indent='     ')
    return '\n'.join(lines)


def newest(queue):
    """The next message, and after it the newest that has come meanwhile; None after PATIENCE."""
    try:
        message = queue.get(timeout=PATIENCE)
        while not queue.empty():
            message = queue.get()
    except Empty:
        return None
    return message


def is_old(readiness):
    """A latched message of a node that has ended or hangs is no answer."""
    return abs((rospy.Time.now() - readiness.header.stamp).to_sec()) > PATIENCE


def main():
    parser = argparse.ArgumentParser(prog='why', description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--watch', action='store_true', help='goes on, and prints what is new, until Ctrl-C')
    arguments = parser.parse_args(rospy.myargv()[1:])
    try:
        rospy.get_master().getPid()
    except (OSError, ProtocolError, ValueError):
        print('why: there is no ROS master: no session runs, or ROS_MASTER_URI names another one. A session that was started '
              'in ./dev shell --isolated is found only from there: try again in a second ./dev shell --isolated',
              file=sys.stderr)
        return 3
    rospy.init_node('why', anonymous=True, disable_signals=True)
    queue = Queue()
    rospy.Subscriber('/session/readiness', Readiness, queue.put)
    said = None
    try:
        while True:
            readiness = newest(queue)
            if readiness is not None and is_old(readiness):
                readiness = newest(queue)
            if readiness is None:
                print('why: nothing on /session/readiness: no session runs, or its node readiness has ended', file=sys.stderr)
                return 3
            if text_of(readiness) != said:
                said = text_of(readiness)
                print(said, flush=True)
            if not arguments.watch:
                return 0 if readiness.ready else 1
    except KeyboardInterrupt:
        return 0


if __name__ == '__main__':
    sys.exit(main())
