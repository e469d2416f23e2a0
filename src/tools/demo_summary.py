"""The closing summary of a demo from the recorder's files."""
import csv
from types import SimpleNamespace

import yaml_file


def _table(rows):
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    lines = []
    for row in rows:
        # Names to the left, figures to the right.
        cells = [cell.ljust(width) if column < 2 else cell.rjust(width)
                 for column, (cell, width) in enumerate(zip(row, widths))]
        lines.append('  ' + '  '.join(cells).rstrip())
    return lines


def _figure(value):
    return '-' if value is None else f'{value:.3f}' if isinstance(value, float) else str(value)


def _intervals(name, figures):
    quantiles = [key[:-len('_ms')] for key in figures if key.endswith('_ms')]
    said = ', '.join(f'{quantile} {_figure(figures[quantile + "_ms"])} ms' for quantile in quantiles)
    return f'  {name}: {said} (of {figures.get("count", "?")})'


def layers(path):
    """Returns the names of the cell's membranes, outermost first; none where there is no summary."""
    if not path.is_file():
        return []
    return yaml_file.read(path).get('layers') or []


def injection(path):
    """What an injection came to, from the last row of force_depth.csv: as SessionMonitor has it of a live one."""
    with open(path, encoding='utf-8') as file:
        last = list(csv.DictReader(file))[-1]
    return SimpleNamespace(punctures=int(last['layers_punctured']), volume=float(last['injected_volume_m3'] or 0),
                           injection=last['injection_state'])


def training(path):
    """Returns a training session's score as text for people."""
    told = yaml_file.read(path)
    complete = told['outcome'] == 'complete'
    worth = f'{told["score"]:.0f} of 100 points' if complete else f'{told["outcome"]}: {told["reason"]}'
    rows = [('measure', '', 'value', 'reference', 'points', 'of')]
    rows += [(name, '', *(f'{row[key]:.3g}' for key in ('value', 'reference', 'points', 'of')))
             for name, row in told['measures'].items()]
    return '\n'.join([f'Training of {told["trainee"]}: {worth}'] + _table(rows)) + '\n'


def text(path):
    """Returns the summary as text for people."""
    summary = yaml_file.read(path)
    clock = {'wall': 'wall time', 'virtual': 'virtual time'}.get(summary['clock'], summary['clock'])
    lines = ['', f'Session of {_figure(summary["duration_s"])} s of {clock}. Steps that each node really did:']
    rows = [('node', 'topic', 'steps', 'rate (Hz)', 'median interval (ms)', '99 % (ms)')]
    for node in summary['nodes'] or []:
        rows.append((node['node'], node['topic'], *(_figure(node[key]) for key in (
            'count', 'rate_hz', 'interval_median_ms', 'interval_p99_ms'))))
    lines += _table(rows)
    if 'hand_to_force_latency' in summary:
        lines.append(_intervals('hand to force', summary['hand_to_force_latency']))
    if 'bare_timer_loop' in summary:
        lines.append(_intervals('bare 1 kHz timer loop of the same run', summary['bare_timer_loop']))
    return '\n'.join(lines) + '\n'
