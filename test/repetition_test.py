"""Holds src/ to writing a thing once: no six lines of code stand in two places.

What a language wants written again does not count: blank lines, includes, braces, access specifiers, and the
declarations by which a class says that it overrides its interface.
"""
import re
import unittest
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LENGTH = 6
EMPTY = re.compile(r'[\s{}()\[\];,]*|#.*|//.*|(public|protected|private):|namespace.*|using .*;|(import|from) .*')
STATEMENT = re.compile(r'[^;{}]+')


def code_lines(text, is_cpp):
    """@returns the lines of a text that count, without indentation, each with its number in the file."""
    if is_cpp:
        text = re.sub(r'//.*', '', text)
        text = STATEMENT.sub(lambda found: '\n' * found.group().count('\n') if ' override' in found.group() else found.group(), text)
    return [(number, line.strip()) for number, line in enumerate(text.split('\n'), 1) if not EMPTY.fullmatch(line.strip())]


def repetitions(texts):
    """@param texts: name -> text
    @returns the pairs of places (name, line) whose next LENGTH lines of code are the same"""
    places = defaultdict(list)
    for name, text in texts.items():
        lines = code_lines(text, not name.endswith('.py'))
        for start in range(len(lines) - LENGTH + 1):
            places[tuple(line for _, line in lines[start:start + LENGTH])].append((name, lines[start][0]))
    return [found for found in places.values() if len(found) > 1]


class Repetition(unittest.TestCase):
    def test_no_lines_stand_twice(self):
        texts = {str(path.relative_to(ROOT)): path.read_text(encoding='utf-8')
                 for ending in ('h', 'cpp', 'py') for path in sorted((ROOT / 'src').rglob(f'*.{ending}'))}
        self.assertGreater(len(texts), 500)
        self.assertEqual(repetitions(texts), [])

    def test_a_repetition_is_found(self):
        block = ''.join(f'  work({number});\n' for number in range(LENGTH))
        self.assertEqual(repetitions({'a.cpp': f'int a() {{\n{block}}}\n', 'b.cpp': f'\nint b() {{\n\n{block}}}\n'}), [[('a.cpp', 2), ('b.cpp', 4)]])
        overrides = ''.join(f'  int f{number}(int, \n    int) const override;\n' for number in range(LENGTH))
        self.assertEqual(repetitions({'a.h': overrides, 'b.h': overrides}), [])


if __name__ == '__main__':
    unittest.main()
