"""Runs one program on one case: whatever it does, there is an outcome."""
import math
import os
import resource
import shlex
import signal
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import peer_format

LARGEST_TEXT = 50_000_000  # bytes, of a result
SPARE_TIME = 0.05  # s, that a process's clock may differ from the sum of its steps
ONE_THREAD = {'OMP_NUM_THREADS': '1', 'OPENBLAS_NUM_THREADS': '1', 'MKL_NUM_THREADS': '1'}

DONE, DECLINED, WRONG = 'done', 'declined', 'wrong result'


@dataclass
class Outcome:
    verdict: str  # done, declined: ..., out of time, crashed: ..., failed: ..., no result, wrong result: ...
    result: peer_format.Result = None  # of done only
    process_time: float = math.nan  # s, of the whole process


def last_line(path):
    lines = path.read_text(encoding='utf-8', errors='replace').split('\n')
    return next((line.strip()[:200] for line in reversed(lines) if line.strip()), '')


def own_core(core):
    """Returns what a child does before it starts: it stays on one processor."""
    return (lambda: os.sched_setaffinity(0, {core})) if core is not None else None


def read(path, steps, process_time):
    """Returns the Outcome of a process that ended well."""
    if not path.exists():
        return Outcome('no result')
    if path.stat().st_size > LARGEST_TEXT:
        return Outcome(f'{WRONG}: the text is too long')
    try:
        result = peer_format.read_result(path.read_text(encoding='utf-8'), steps)
    except (peer_format.FormatError, UnicodeDecodeError) as error:
        return Outcome(f'{WRONG}: {error}')
    if result.declined:
        return Outcome(f'{DECLINED}: {result.declined}')
    if sum(result.times) > process_time + SPARE_TIME:
        return Outcome(f'{WRONG}: its steps take {sum(result.times):.3g} s and its process {process_time:.3g} s')
    return Outcome(DONE, result, process_time)


def run(command, case, steps, time_limit, core=None):
    """Runs a command, a text as for a shell, with the paths of case and result behind it. Returns the Outcome."""
    with tempfile.TemporaryDirectory() as folder:
        result, errors = Path(folder) / 'result', Path(folder) / 'errors'
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        with errors.open('wb') as error_file:
            try:
                process = subprocess.Popen([*shlex.split(command), str(case), str(result)], cwd=folder,
                                           env={**os.environ, **ONE_THREAD}, stdin=subprocess.DEVNULL, stdout=error_file,
                                           stderr=error_file, start_new_session=True, preexec_fn=own_core(core))
            except OSError as error:
                return Outcome(f'not started: {error.strerror}')
            try:
                status = process.wait(time_limit)
            except subprocess.TimeoutExpired:
                status = None
            finally:
                end_group(process)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        process_time = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        if status is None:
            return Outcome(f'out of time: {time_limit:g} s', process_time=process_time)
        if status < 0:
            return Outcome(f'crashed: {signal.Signals(-status).name}', process_time=process_time)
        if status > 0:
            return Outcome(f'failed: exit status {status}: {last_line(errors)}', process_time=process_time)
        return read(result, steps, process_time)


def end_group(process):
    """Ends what the program has started, too."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    process.wait()
