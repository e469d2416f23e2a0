"""Text of a case and of a result of ./dev bench peers: doc/reference/peer_format.md. SI units."""
import math
from dataclasses import dataclass, field

VERSION = 1


class FormatError(ValueError):
    """The text is no case, or no result."""


@dataclass
class Case:
    scene: str
    dimension: int
    order: int
    layers: list  # (law, Young's modulus, Poisson's ratio), outermost first
    vertices: int  # nodes below are corners of elements
    nodes: list  # of coordinates: (x, y, z) or, in a section, (r, z)
    elements: list  # (layer, [corners, then midpoints])
    surface: list  # facets of the outer surface
    held: list
    glued: list
    tip_shape: str
    tip_mode: str
    tip_radius: float
    tip_height: float  # z of its lowest point at first contact
    motion: list  # (x, y, z) of the tip since then, of each step


@dataclass
class Result:
    program: str = ''
    model: str = ''
    element: str = ''
    law: str = 'same'
    declined: str = ''
    forces: list = field(default_factory=list)  # (x, y, z), of the cell on the tip; nan: no solution
    times: list = field(default_factory=list)  # s, processor time of each step


class Lines:
    """Lines without comments and empty ones."""

    def __init__(self, text):
        self.lines = [(number, line.split('#')[0].split()) for number, line in enumerate(text.splitlines(), 1)]
        self.lines = [(number, words) for number, words in self.lines if words]
        self.at = 0

    def next(self):
        if self.at == len(self.lines):
            raise FormatError('the text ends early')
        self.at += 1
        return self.lines[self.at - 1][1]

    def expect(self, keyword, count=None):
        """Returns the words behind a keyword."""
        words = self.next()
        if words[0] != keyword:
            self.fail(f"'{words[0]}' instead of '{keyword}'")
        if count is not None and len(words) != count + 1:
            self.fail(f'{keyword} has {len(words) - 1} values instead of {count}')
        return words[1:]

    def fail(self, reason):
        raise FormatError(f'line {self.lines[max(0, self.at - 1)][0] if self.lines else 0}: {reason}')

    def number(self, word, kind=float):
        try:
            return kind(word)
        except ValueError:
            return self.fail(f"'{word}' is no number")

    def row(self, count, kind=float):
        words = self.next()
        if len(words) != count:
            self.fail(f'{len(words)} values instead of {count}')
        return [self.number(word, kind) for word in words]

    def rows(self, keyword, count, kind=float):
        return [self.row(count, kind) for _ in range(self.number(self.expect(keyword, 1)[0], int))]


def read_case(path):
    """Returns the Case of a file. Raises FormatError."""
    with open(path, encoding='utf-8') as file:
        lines = Lines(file.read())
    if lines.expect('peer_case', 1) != [str(VERSION)]:
        lines.fail('another version of the format')
    scene = lines.expect('scene', 1)[0]
    dimension = lines.number(lines.expect('dimension', 1)[0], int)
    order = lines.number(lines.expect('order', 1)[0], int)
    if dimension not in (2, 3) or order not in (1, 2):
        lines.fail('dimension must be 2 or 3, order 1 or 2')
    layers = []
    for _ in range(lines.number(lines.expect('layers', 1)[0], int)):
        law, young, poisson = lines.next()
        layers.append((law, lines.number(young), lines.number(poisson)))
    count, vertices = [lines.number(word, int) for word in lines.expect('nodes', 2)]
    nodes = [lines.row(dimension) for _ in range(count)]
    corners = dimension + 1
    elements = lines.rows('elements', 1 + (corners if order == 1 else corners * (corners + 1) // 2), int)
    surface = lines.rows('surface', dimension if order == 1 else dimension * (dimension + 1) // 2, int)
    held = [row[0] for row in lines.rows('held', 1, int)]
    glued = [row[0] for row in lines.rows('glued', 1, int)]
    shape, mode, radius, height = lines.expect('tip', 4)
    motion = lines.rows('motion', 3)
    lines.expect('end', 0)
    return Case(scene, dimension, order, layers, vertices, nodes, [(row[0], row[1:]) for row in elements], surface, held,
                glued, shape, mode, lines.number(radius), lines.number(height), motion)


def result_text(result):
    """Returns the text of a Result."""
    text = [f'peer_result {VERSION}', f'program {result.program}', f'model {result.model}', f'element {result.element}',
            f'law {result.law}']
    if result.declined:
        text.append(f'declined {result.declined}')
    else:
        text.append(f'steps {len(result.forces)}')
        text += [' '.join(repr(float(value)) for value in (*force, time))
                 for force, time in zip(result.forces, result.times)]
    return '\n'.join(text + ['end', ''])


def read_result(text, steps):
    """Returns the Result of a text that must have this number of steps. Raises FormatError."""
    lines = Lines(text)
    if lines.expect('peer_result', 1) != [str(VERSION)]:
        lines.fail('another version of the format')
    result = Result(*(' '.join(lines.expect(keyword)) for keyword in ('program', 'model', 'element', 'law')))
    words = lines.next()
    if words[0] == 'declined':
        result.declined = ' '.join(words[1:]) or 'without a reason'
    elif words == ['steps', str(steps)]:
        for _ in range(steps):
            *force, time = lines.row(4)
            if not 0 <= time < math.inf:
                lines.fail('the time of a step is no time')
            result.forces.append(tuple(force))
            result.times.append(time)
    else:
        lines.fail(f'{" ".join(words)} instead of steps {steps}')
    lines.expect('end', 0)
    return result
