"""Links of documents."""
import re
from pathlib import Path


def slug(heading):
    """The anchor of a heading."""
    heading = re.sub(r'\[([^\]]*)\]\([^)]*\)', r'\1', heading).strip().lower()
    return re.sub(r'[^\w\- ]', '', heading).replace(' ', '-')


def anchors(text):
    outside = re.sub(r'^```.*?^```', '', text, flags=re.MULTILINE | re.DOTALL)
    return {slug(heading) for heading in re.findall(r'^#+ (.*)$', outside, re.MULTILINE)}


class LinkChecker:
    """Collects what is wrong with a project's documents, a line each."""

    def __init__(self, project):
        self.project = project
        self.problems = []
        self.place = ''

    def report(self, problem):
        self.problems.append(f'{self.place}: {problem}')

    def check_links(self, path, text):
        outside = re.sub(r'`[^`\n]+`', lambda code: ' ' * len(code.group()), text)
        for found in re.finditer(r'\]\(([^)\s]+)\)', outside):
            target, _, anchor = found.group(1).partition('#')
            if '://' in target or target.startswith('mailto:'):
                continue
            self.place = f'{path}:{text.count(chr(10), 0, found.start()) + 1}'
            file = self.resolve(path, target) if target else path
            if file not in self.project.files and file not in self.project.folders:
                self.report(f'link to {target}: there is no such file')
            elif anchor and anchor not in anchors(self.project.text(file)):
                self.report(f'link to {found.group(1)}: there is no such heading')

    @staticmethod
    def resolve(path, target):
        parts = []
        for part in (Path(path).parent / target).as_posix().split('/'):
            if part == '..':
                parts = parts[:-1] if parts else ['..']
            elif part != '.':
                parts.append(part)
        return '/'.join(parts) or '.'
