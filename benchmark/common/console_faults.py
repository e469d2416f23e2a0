"""A console that is closed, hangs or is killed while the needle is in the cell: what the 1 kHz loop is late by before and
after, and whether the injection goes on to its end without it."""
import signal
import time
from pathlib import Path

import realtime
from demo_session import DemoSession, SessionError
from session_operator import SessionOperator

FAULTS = ('closed', 'frozen', 'killed')
PATIENCE = 120   # s for each step of the injection
ALLOWED = 1e-3   # share of late periods, beyond the bare loop's, that a fault may add
DRAWN = 30       # Hz, as rviz draws by default


def window(histograms, seconds):
    """{loop: (share of late periods, s that the longest is late by)} of the next `seconds`."""
    before = dict(histograms.newest)
    time.sleep(seconds)
    added = {name: realtime.difference(before[name], after) for name, after in dict(histograms.newest).items()}
    return {name: (late / max(1, count), max(bins, default=0.0)) for name, (count, late, bins) in added.items()}


def strike(view, fault):
    if fault == 'closed':
        view.close()
    elif fault == 'killed':
        view.send_signal(signal.SIGKILL)
    else:
        view.freeze(True)


def injection(session, view, fault, seconds):
    """What is measured of one injection whose console fails in the cell."""
    operator, histograms = SessionOperator(PATIENCE), realtime.Histograms(realtime.SOURCES)
    operator.say('approach', lambda: operator.waits_in('contact'))
    operator.say('indent', lambda: operator.waits_in('punctured'))
    operator.wait(histograms.complete, 'histograms of both loops')
    before = window(histograms, seconds)
    view.check()
    strike(view, fault)
    during = window(histograms, seconds)
    volume = operator.status.volume
    operator.say('inject', lambda: operator.waits_in('punctured') and operator.status.volume > volume)
    operator.say('withdraw', lambda: operator.status.state == 'idle')
    session.check()
    return {'fault': fault, 'before': before, 'during': during, 'outcome': operator.status.outcome}


def run(out, keys, fault, seconds):
    """`keys`: of the session. @raises SessionError"""
    logs = out / 'console_log' / fault
    logs.mkdir(parents=True, exist_ok=True)
    session = DemoSession(Path(realtime.ROOT) / 'launch' / 'session.launch', logs,
                          {**keys, 'record.folder': logs / 'record', 'record.bag': 'false'})
    view = None
    try:
        session.wait_ready()
        view = realtime.start_rviz(session, logs, 'inject', DRAWN)
        if view is None:
            raise SessionError('the console does not start')
        return injection(session, view, fault, seconds)
    finally:
        if view:
            if fault == 'frozen':
                view.freeze(False)
            view.close()
        session.stop()


def beyond(shares):
    """Share of the cell simulator's late periods beyond the bare loop's."""
    return shares['cell_simulator'][0] - shares['bare_timer_loop'][0]


def report(results):
    """Prints a line a fault. Returns whether each injection ended, and no fault made the loop later."""
    for result in results:
        texts = [f'{100 * beyond(result[when]):+.3f} % ({1e3 * result[when]["cell_simulator"][1]:.1f} ms)'
                 for when in ('before', 'during')]
        print(f'console {result["fault"]:<6}: late periods beyond the bare loop (longest) {texts[0]} before, {texts[1]} '
              f'after; the injection ended: {result["outcome"]}')
    added = [beyond(result['during']) - beyond(result['before']) for result in results]
    ended = all(result['outcome'] == 'injected' for result in results)
    print(f'largest share that a fault added: {100 * max(added, default=0):+.3f} %, allowed {100 * ALLOWED:g} %')
    return ended and max(added, default=0) <= ALLOWED
