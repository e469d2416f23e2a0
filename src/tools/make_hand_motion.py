#!/usr/bin/env python3
"""Writes a hand motion for the virtual operator: approach with one clutch stroke, touch, indent, hold, retract; and, where
it is asked for, on through the membrane and an injection before the retraction.

Positions are those of the hand at a haptic device (m). The way between key points is of minimum jerk (Flash and Hogan
1985), which is how hands reach; physiological tremor of 8 to 12 Hz lies on top. It is synthetic: to replay a person's
hand, record /haptic/measured_cp of a session and write it in the same columns.
"""

import argparse
import sys

import numpy as np

RATE = 200.0  # Hz, of the samples


def keypoints(args):
    """(duration s, end position of the hand along z m, clutch, phase) one after the other."""
    gap = args.gap / args.scale  # hand's way to the cell, m
    stroke = 0.6 * gap
    depth = args.depth / args.scale
    return [
        (2.0, -stroke, 0, "approach"),
        (0.2, -stroke, 1, "approach"),  # the clutch is pressed: the hand goes back, the needle stays
        (1.2, 0.0, 1, "approach"),
        (0.2, 0.0, 0, "approach"),
        (1.6, -(gap - stroke) + 2e-3, 0, "approach"),
        (1.0, -(gap - stroke) - 1e-3, 0, "touch"),
        (args.depth / args.speed, -(gap - stroke) - depth, 0, "indent"),
        (args.hold, -(gap - stroke) - depth, 0, "hold"),
    ] + beyond(args, -(gap - stroke)) + [
        (max(args.depth, args.puncture) / args.speed, -(gap - stroke) + 2e-3, 0, "retract"),
        (1.0, 0.0, 0, "retract"),
    ]


def beyond(args, surface):
    """On through the membrane, and the word to inject."""
    if args.puncture <= args.depth:
        return []
    deepest = surface - args.puncture / args.scale
    return [
        ((args.puncture - args.depth) / args.speed, deepest, 0, "puncture"),
        (0.5, deepest, 0, "puncture"),
        (args.inject, deepest, 0, "inject"),
    ]


def minimum_jerk(share):
    return share**3 * (10 - 15 * share + 6 * share**2)


def tremor(times, amplitude, seed):
    """Sum of a few sines between 8 and 12 Hz, rms `amplitude` (m) an axis; shape (n, 3)."""
    random = np.random.default_rng(seed)
    total = np.zeros((len(times), 3))
    for _ in range(6):
        frequency = random.uniform(8, 12)
        total += np.sin(2 * np.pi * frequency * times[:, None] + random.uniform(0, 2 * np.pi, 3))
    return amplitude * total / np.sqrt(6 / 2)


def samples(args):
    rows = []
    begin, z = 0.0, 0.0
    for duration, z_end, clutch, phase in keypoints(args):
        count = max(1, int(round(duration * RATE)))
        for i in range(count):
            rows.append((begin + i / RATE, z + (z_end - z) * minimum_jerk(i / count), clutch, phase))
        begin, z = begin + count / RATE, z_end
    rows.append((begin, z, 0, "retract"))
    times = np.array([row[0] for row in rows])
    shake = tremor(times, args.tremor, args.seed) if args.tremor > 0 else np.zeros((len(times), 3))
    shake *= np.minimum(1, np.minimum(times, times[-1] - times) / 0.5)[:, None]
    return [(t, dx, dy, z + dz, clutch, phase) for (t, z, clutch, phase), (dx, dy, dz) in zip(rows, shake)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", default="-", help="CSV file; - for standard output (default)")
    parser.add_argument("--depth", type=float, default=12e-6, help="indentation meant by the hand, m (default 12e-6)")
    parser.add_argument("--speed", type=float, default=2.5e-6, help="of the needle while it indents, m/s (default 2.5e-6)")
    parser.add_argument("--hold", type=float, default=3.0, help="at depth, s (default 3)")
    parser.add_argument("--puncture", type=float, default=0.0,
                        help="depth to go on to after the hold, through the membrane, m (default 0: not)")
    parser.add_argument("--inject", type=float, default=1.5, help="with --puncture: for the injection, s (default 1.5)")
    parser.add_argument("--gap", type=float, default=32e-6, help="needle's way to the cell, m (default 32e-6)")
    parser.add_argument("--scale", type=float, default=1e-3, help="metres of needle per metre of hand (default 1e-3)")
    parser.add_argument("--tremor", type=float, default=30e-6, help="rms of the hand's tremor, m (default 30e-6)")
    parser.add_argument("--seed", type=int, default=1, help="of the tremor (default 1)")
    args = parser.parse_args()
    for name in ("depth", "speed", "hold", "inject", "gap", "scale"):
        if not getattr(args, name) > 0:
            parser.error(f"--{name} = {getattr(args, name)}: must be positive")
    text = f"# Synthetic: src/tools/make_hand_motion.py --depth {args.depth:g} --speed {args.speed:g} "
    text += f"--hold {args.hold:g} --gap {args.gap:g} --scale {args.scale:g} --tremor {args.tremor:g} --seed {args.seed}\n"
    if args.puncture > 0:
        text = text.rstrip("\n") + f" --puncture {args.puncture:g} --inject {args.inject:g}\n"
    text += "time_s,x_m,y_m,z_m,clutch,phase\n"
    for t, x, y, z, clutch, phase in samples(args):
        text += f"{t:.3f},{x:.9f},{y:.9f},{z:.9f},{clutch},{phase}\n"
    if args.out == "-":
        sys.stdout.write(text)
        return
    with open(args.out, "w", encoding="utf-8") as file:
        file.write(text)


if __name__ == "__main__":
    main()
