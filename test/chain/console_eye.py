"""What a picture of the operator's console shows: which buttons are offered, where they are, and the lamps' colours.

It knows the colours of src/rviz/colours.h and that the buttons stand in a column above STOP, and the lamps and below them
the guards' bars in one to the right of it. It sees what an operator sees: a button that another window hides is not there.
"""

import numpy

BUTTONS = ("Enable", "Home", "Approach", "Indent", "Aspirate", "Inject", "Withdraw", "Disable")
HOLDING = ("Enable", "Home", "Hold", "Approach", "Indent", "Aspirate", "Inject", "Withdraw", "Release", "Disable")  # of a session with a holder
DEVICES = ("Rig", "Camera", "Sensor", "Hand", "Cell", "Injector")
HAND = ("Needle", "Clutch", "Switch")
ROWS = {"inject": (*DEVICES, "Estimate"), "teleoperate": (*HAND, *DEVICES)}  # of lamps
GUARDS = ("Force", "Depth")
STOP, OFFERED, REFUSED = (0xC6, 0x28, 0x28), (0x2B, 0x6C, 0xB0), (0xD5, 0xD8, 0xDC)
LAMPS = {"green": (0x2E, 0x9E, 0x4F), "yellow": (0xF2, 0xB1, 0x0E), "red": (0xD0, 0x2C, 0x2C),
         "grey": (0xA8, 0xAD, 0xB3)}
LEAST_STOP, LEAST_BUTTON, LEAST_LAMP, LEAST_BAR = 30, 20, 5, 5  # px of height; letters are smaller


def runs(column, colour):
    """[(first row, last row)] of a column of pixels that has this colour."""
    same = numpy.concatenate(([False], has(column, colour), [False]))
    edges = numpy.flatnonzero(numpy.diff(same.astype(int)))
    return [(int(a), int(b) - 1) for a, b in zip(edges[::2], edges[1::2])]


class NotSeen(Exception):
    """The picture does not show a console."""


class Console:
    """A picture's console; `name`: which of config/console. @raises NotSeen"""

    def __init__(self, pixels, name="inject", buttons=BUTTONS):
        rows, columns = numpy.nonzero(has(pixels, STOP))
        if rows.size == 0 or rows.max() - rows.min() < LEAST_STOP:
            raise NotSeen("there is no stop button")
        self.stop = (int(columns.min() + 20), int((rows.min() + rows.max()) // 2))
        left, right = int(columns.min()) + 8, int(columns.max())
        self.stop_right = right
        column = pixels[:int(rows.min()), left]
        seen = [(rows_of, offered) for offered, colour in ((True, OFFERED), (False, REFUSED))
                for rows_of in runs(column, colour) if rows_of[1] - rows_of[0] > LEAST_BUTTON]
        # The strip of steps is above them.
        seen = sorted(seen)[-len(buttons):]
        if len(seen) < len(buttons):
            raise NotSeen(f"there are {len(seen)} buttons")
        # Beside that column: the pointer is in the picture.
        self.place = {name: (self.stop[0], (a + b) // 2) for name, ((a, b), _) in zip(buttons, seen)}
        self.offered = {name: offered for name, (_, offered) in zip(buttons, seen)}
        first = seen[0][0][0]
        self.headline = self._lamps(pixels[first - 40:first, left - 8:left + 12])[-1:]
        self.lamps = dict(zip(ROWS[name], self._lamps(pixels[first:, right + 6:right + 34])))
        self.guards = dict(zip(GUARDS, self._bars(pixels[int(rows.min()):, right + 60:right + 200])))

    @staticmethod
    def _bars(pixels):
        """Colours of the guards' bars at their left end, from top to bottom; "empty": nothing of a bar is filled."""
        colours = {"empty": REFUSED, **LAMPS}
        for column in numpy.moveaxis(pixels, 1, 0):
            found = sorted((a, name) for name, colour in colours.items() for a, b in runs(column, colour)
                           if b - a >= LEAST_BAR)
            if len(found) >= len(GUARDS):
                return [name for _, name in found]
        return []

    @staticmethod
    def _lamps(pixels):
        """Colours from top to bottom of the lamps in a strip of pixels, by its column that has most of them."""
        best = []
        for column in numpy.moveaxis(pixels, 1, 0):
            found = sorted((a, name) for name, colour in LAMPS.items() for a, b in runs(column, colour)
                           if b - a >= LEAST_LAMP)
            best = max(best, found, key=len)
        return [name for _, name in best]


def pixels_of(path):
    """Rows x columns x (red, green, blue) of a virtual screen's file (xwd, of 32 bits a pixel). @raises NotSeen"""
    data = numpy.fromfile(path, numpy.uint8)
    if data.size < 100:
        raise NotSeen(f"there is no picture in {path}")
    size, _, _, _, width, height, *_ = header = data[:100].view(">u4").astype(int)
    line, colours = header[12], header[19]
    rows = data[size + 12 * colours:][:height * line].reshape(height, line)
    return rows[:, :4 * width].reshape(height, width, 4)[..., 2::-1].astype(numpy.int16)


def has(pixels, colour):
    """Which pixels have this colour."""
    return numpy.all(abs(pixels - numpy.array(colour, numpy.int16)) <= 3, axis=-1)


def share_of(colour, pixels):
    """The share of a picture that has this colour."""
    return float(numpy.mean(has(pixels, colour)))


def rows_of_offered(pixels, least):
    """[[place, ...], ...] of the offered buttons from top to bottom and from left to right, rows of at least that many."""
    blue = has(pixels, OFFERED)
    rows = {}
    for row in 1 + numpy.flatnonzero(blue[1:].any(axis=1)):
        for a, b in runs(pixels[row], OFFERED):
            if b - a > LEAST_BUTTON and not blue[row - 1, a:b + 1].any():  # its upper edge
                rows.setdefault(int(row), []).append(((a + b) // 2, int(row) + LEAST_BUTTON // 2))
    return [buttons for _, buttons in sorted(rows.items()) if len(buttons) >= least]
