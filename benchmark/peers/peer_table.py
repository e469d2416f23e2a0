"""Arithmetic and rows of the table of ./dev bench peers."""
import csv
import math

COLUMNS = ('program', 'model', 'element', 'vertices', 'tetrahedra', 'time_ms_median', 'force_N', 'force_error', 'study',
           'scene', 'mesh', 'depth_um', 'steps', 'time_ms_low', 'time_ms_high', 'error_estimate', 'converged_N',
           'converged_error', 'law', 'law_effect', 'agrees', 'largest_step_um', 'largest_depth_um', 'process_s', 'verdict')

SAME_FORCE = 0.05  # relative, that a stable step may be off the force in the smallest steps
SOUND = 0.8  # of the largest force before: a smaller one has lost the equilibrium


def quantile(values, share):
    """Returns the value below which this share of all lies; nan of none."""
    values = sorted(values)
    if not values:
        return math.nan
    at = share * (len(values) - 1)
    low = int(at)
    high = min(low + 1, len(values) - 1)
    return values[low] + (at - low) * (values[high] - values[low])


def relative_error(force, converged):
    return abs(force / converged - 1) if converged else math.nan


def mesh_error(forces):
    """Returns the error in N of the last of the forces on finer and finer meshes: the larger of the last two changes.

    Elements at the needle are halved from mesh to mesh, and the error is of first order or better, so that the last change
    is as large as the error. Two meshes may agree by chance; three are needed.
    """
    if len(forces) < 3 or not all(math.isfinite(force) for force in forces[-3:]):
        return math.nan
    return max(abs(forces[-1] - forces[-2]), abs(forces[-2] - forces[-3]))


def agree(force, error, other, other_error):
    """Returns whether two forces differ by no more than the sum of their errors."""
    return abs(force - other) <= error + other_error


def largest_step(forces):
    """Returns the largest step with the force of the smallest one: forces at one depth by step; nan of none."""
    smallest = forces[min(forces)]
    stable = [step for step, force in forces.items() if relative_error(force, smallest) <= SAME_FORCE]
    return max(stable, default=math.nan)


def largest_depth(depths, forces):
    """Returns the depth to which forces are finite and do not fall: 0 when the first is lost."""
    reached, largest = 0, 0
    for depth, force in zip(depths, forces):
        if not math.isfinite(force) or force <= 0 or force < SOUND * largest:
            break
        reached, largest = depth, max(largest, force)
    return reached


def text(value):
    if isinstance(value, float):
        return f'{value:.6g}'
    return 'yes' if value is True else 'no' if value is False else str(value)


def write(rows, path):
    with open(path, 'w', encoding='utf-8', newline='') as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator='\n', restval='')
        writer.writeheader()
        for row in rows:
            writer.writerow({key: text(value) for key, value in row.items()})


def line(row):
    """Returns a row for the eye; values that the row lacks are left out."""
    shown = [f'{row["study"]} {row["scene"]} {row.get("mesh", "")}:'.replace(' :', ':'), row['program'], row.get('model', ''),
             row.get('element', '')]
    if row['verdict'] != 'done':
        return ' '.join([*shown, '-', row['verdict']])
    if 'time_ms_median' in row:
        shown.append(f'{row["time_ms_median"]:.3g} ms')
    if 'force_N' in row:
        shown.append(f'{row["depth_um"]:g} um {1e6 * row["force_N"]:.5g} uN')
    if math.isfinite(row.get('force_error', math.nan)):
        shown.append(f'error {100 * row["force_error"]:.2g} %')
    if math.isfinite(row.get('error_estimate', math.nan)):
        shown.append(f'estimate {100 * row["error_estimate"]:.2g} %')
    if 'agrees' in row:
        shown.append('agrees' if row['agrees'] else 'DIFFERS')
    for key, name in (('largest_step_um', 'largest step'), ('largest_depth_um', 'depth')):
        if key in row:
            shown.append(f'{name} {row[key]:g} um')
    return ' '.join(str(word) for word in shown if word)
