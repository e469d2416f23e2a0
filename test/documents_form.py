"""Links, columns and sentences of documents."""
import re
from pathlib import Path

README_LINES, COLUMNS, WIDEST, SENTENCE = 150, 100, 120, 30
PRIVATE = re.compile(r'\b(heeds?|distrusts?|judged?s?|tells?|told|says?|said|let go|lets go)\b', re.IGNORECASE)


def documents_prose(text):
    """Yields (number of the first line, paragraph) of the prose: no table, block of commands or heading."""
    paragraph, first, fenced = [], 0, False
    for number, line in enumerate(text.splitlines() + [''], 1):
        fence = line.lstrip().startswith('```')
        fenced ^= fence
        block = fence or fenced or (line.startswith('    ') and not paragraph) or re.match(r'\s*\|', line)
        begins = bool(re.match(r'\s*([-*]|\d+\.) ', line))
        if paragraph and (block or begins or not line.strip() or line.startswith('#')):
            yield first, ' '.join(paragraph)
            paragraph = []
        if line.strip() and not block and not line.startswith('#'):
            first = first if paragraph else number
            paragraph.append(re.sub(r'^\s*([-*]|\d+\.) ', '', line).strip())


def slug(heading):
    """The anchor of a heading."""
    heading = re.sub(r'\[([^\]]*)\]\([^)]*\)', r'\1', heading).strip().lower()
    return re.sub(r'[^\w\- ]', '', heading).replace(' ', '-')


def anchors(text):
    outside = re.sub(r'^```.*?^```', '', text, flags=re.MULTILINE | re.DOTALL)
    return {slug(heading) for heading in re.findall(r'^#+ (.*)$', outside, re.MULTILINE)}


class FormChecker:
    """Collects what is wrong with the form of a project's documents, a line each."""

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

    def check_form(self, path, text):
        lines = text.splitlines()
        self.place = path
        if path == 'README.md' and len(lines) > README_LINES:
            self.report(f'{len(lines)} lines, at most {README_LINES}')
        fenced = False
        for number, line in enumerate(lines, 1):
            fenced ^= line.startswith('```')
            if len(line) > COLUMNS and not fenced and not re.match(r'\s*\||    |\s*!\[', line):
                self.place = f'{path}:{number}'
                self.report(f'{len(line)} columns, at most {COLUMNS}')
            elif len(line) > WIDEST and not re.match(r'\s*\|', line):
                self.place = f'{path}:{number}'
                self.report(f'{len(line)} columns, at most {WIDEST} outside of tables')
        if path == 'README.md' or path.startswith('doc/'):
            for number, paragraph in documents_prose(text):
                self.place = f'{path}:{number}'
                self.check_sentences(paragraph)

    def check_sentences(self, paragraph):
        plain = re.sub(r'!?\[([^\]]*)\]\([^)]*\)', r'\1', re.sub(r'`[^`]*`', 'code', paragraph))
        for sentence in re.split(r'(?<=[.!?])[*_)"]*\s+', plain):
            private = PRIVATE.search(sentence) if self.place.startswith(('README.md', 'doc/guide/')) else None
            if private:
                self.report(f'"{private.group()}" is a private word: {sentence[:60]} ...')
            words = re.findall(r"[A-Za-z0-9][\w/^'.-]*", sentence)
            if len(words) > SENTENCE:
                self.report(f'a sentence of {len(words)} words, at most {SENTENCE}: {sentence[:60]} ...')
