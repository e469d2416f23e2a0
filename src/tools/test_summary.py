"""Sums up the JUnit files of a test run: how many cases ran, which ones failed.

    test_summary.py FOLDER

Exit code 1 when a case failed, when a program ran no case, when a file cannot be read, or when there is no file at all.
"""
import sys
from pathlib import Path
from xml.etree import ElementTree


def cases_of(path):
    """Returns [(name, whether it failed)] of the JUnit file `path`; raises ElementTree.ParseError."""
    cases = []
    for case in ElementTree.parse(path).getroot().iter('testcase'):
        failed = case.find('failure') is not None or case.find('error') is not None
        cases.append((f"{case.get('classname', path.stem)}.{case.get('name', '?')}", failed))
    return cases


def summarise(folder):
    """Returns (number of cases, problems), each problem a line for people, for the JUnit files below `folder`."""
    total, problems = 0, []
    paths = sorted(folder.rglob('*.xml'))
    if not paths:
        problems.append(f'no test left a result in {folder}')
    for path in paths:
        try:
            cases = cases_of(path)
        except ElementTree.ParseError as error:
            problems.append(f'{path.name}: broken result, did the program crash? ({error})')
            continue
        if not cases:
            problems.append(f'{path.name}: ran no test case')
        # A launched test has its cases in a file of its own (rosunit-*); rostest's tells whether it could be launched.
        total += 0 if path.name.startswith('rostest-') else len(cases)
        problems += [f'{path.stem}: {name}' for name, failed in cases if failed]
    return total, problems


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    total, problems = summarise(Path(sys.argv[1]))
    for problem in problems:
        print(f'FAILED  {problem}')
    print(f'{total} test cases, {len(problems)} failed')
    sys.exit(1 if problems else 0)


if __name__ == '__main__':
    main()
