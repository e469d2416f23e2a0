"""Holds the names of classes, structs and enums to one definition each in all of src/, benchmark/ and test/.

All of them are in one namespace. Two classes of one name in two libraries compile, and then a program that links both
has the functions of one work on objects of the other (the one definition rule of C++).
"""
import re
import unittest
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = ('src', 'benchmark', 'test')
OF_ONE_FILE = re.compile(r'^namespace \{$.*?^\}  // namespace$', re.MULTILINE | re.DOTALL)
DEFINITION = re.compile(r'^(?:class|struct|enum class|enum) (?:alignas\(\S+\) )?(\w+)\b(?!::)[^;{<]*\{', re.MULTILINE)


def definitions(text):
    """Returns the names of the classes, structs and enums that a C++ text defines for other files, too.

    Left out are what stands in an anonymous namespace or in a class, and specialisations of templates.
    """
    return DEFINITION.findall(OF_ONE_FILE.sub('', text))


class OneDefinition(unittest.TestCase):
    def test_a_name_is_defined_once(self):
        files = defaultdict(list)
        for folder in FOLDERS:
            for path in sorted([*(ROOT / folder).rglob('*.h'), *(ROOT / folder).rglob('*.cpp')]):
                for name in definitions(path.read_text()):
                    files[name].append(str(path.relative_to(ROOT)))
        self.assertGreater(len(files), 500)
        self.assertEqual({name: found for name, found in files.items() if len(found) > 1}, {})

    def test_definitions_are_found(self):
        self.assertEqual(
            definitions('class Before;\nnamespace {\nstruct Local {\n};\n}  // namespace\n\nclass Cell : public Body {\n'
                        ' public:\n  struct Part {};\n};\n\ntemplate <typename T>\nstruct Any {};\n\nenum class Way { kIn };\n'
                        'template <>\nstruct Any<int> {};\n'),
            ['Cell', 'Any', 'Way'])


if __name__ == '__main__':
    unittest.main()
