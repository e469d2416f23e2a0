"""The tables that paper_tensegrity writes."""
from common import read


def rows_of(data_dir, name):
    return read(data_dir / f'tensegrity_{name}.csv')


def members(data_dir):
    return {row['kind']: row for row in rows_of(data_dir, 'members')}


def numbers(data_dir):
    return {row['quantity']: row['value'] for row in rows_of(data_dir, 'numbers')}


def curve(data_dir, name, where='end', **chosen):
    """(depths in um, forces in uN) of one curve."""
    rows = [row for row in rows_of(data_dir, 'curves') if row['curve'] == name and row['where'] == where
            and all(row[key] == value for key, value in chosen.items())]
    return [1e6 * row['depth_m'] for row in rows], [1e6 * row['force_z_N'] for row in rows]


def values(data_dir, name, key):
    return sorted({row[key] for row in rows_of(data_dir, 'curves') if row['curve'] == name})


def slack_cables(data_dir, where, prestrain, depth):
    """Their number in a curve of figure 12 at its point nearest to a depth in um."""
    rows = [row for row in rows_of(data_dir, 'curves')
            if row['curve'] == 'figure_12' and row['where'] == where and row['prestrain'] == prestrain]
    return int(min(rows, key=lambda row: abs(1e6 * row['depth_m'] - depth)).get('slack', 0))


def figure_13(data_dir):
    """[(count, depths, forces)] on a strut's end."""
    return [(int(count), *curve(data_dir, 'figure_13', 'end', count=count))
            for count in values(data_dir, 'figure_13', 'count')]
