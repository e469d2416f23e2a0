"""Files as laboratories have them, small and made up: the programs read them right, or refuse them and say why.

Records are those of a paraboloid of 10 um that is pushed into an elastic half space of 1000 Pa (Hertz, incompressible),
from 5 um above it, unless a test says otherwise.
"""
import gzip
import os
import re
import struct
import subprocess
import sys
import unittest
from pathlib import Path

import numpy

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / 'src' / 'workflow'))
sys.path.insert(0, str(ROOT / 'test'))

import programs  # noqa: E402
from in_folder import InFolder  # noqa: E402

TITLES = 'time_s,position_um,force_nN'
BUILT = {'programs': os.environ['MICROINJECTION_PROGRAMS']} if 'MICROINJECTION_PROGRAMS' in os.environ else {}
FAMILIES = ROOT / 'config' / 'families'
TOLERANCE = 0.05  # of a modulus; a part that is wrongly counted costs 20 % and more
SPEED, STEP, NOISE = 2.0, 0.0175, 0.02  # um/s, s, nN
STIFFNESS = 50  # nN/um, of a lever, as 0.05 N/m


def hertz(position, modulus=1000, contact=5):
    """nN, of positions in um."""
    depth = 1e-6 * numpy.clip(numpy.asarray(position) - contact, 0, None)
    return 1e9 * 4 / 3 * modulus / 0.75 * numpy.sqrt(10e-6) * depth**1.5


class Record:
    """Time (s), position (um) and force (nN) of a tip that goes through places, and rests where one comes twice."""

    def __init__(self, *places, seed=1, rest=5):
        parts = [numpy.array(places[:1], dtype=float)]
        self.leg = [0]
        for number, (start, end) in enumerate(zip(places, places[1:])):
            count = round((rest if start == end else abs(end - start) / SPEED) / STEP)
            parts.append(start + (end - start) * numpy.arange(1, count + 1) / count)
            self.leg += [number] * count
        self.random = numpy.random.default_rng(seed)
        self.set(numpy.concatenate(parts))

    def set(self, position, **cell):
        self.position = position
        self.time = STEP * numpy.arange(len(position))
        self.force = hertz(position, **cell) + self.random.normal(0, NOISE, len(position))
        return self

    def columns(self):
        return [self.time, self.position, self.force]


def rows(columns, separator=',', number='%.5f'):
    cells = ([cell if isinstance(cell, str) else number % cell for cell in row] for row in zip(*columns))
    return ''.join(separator.join(row) + '\n' for row in cells)


def table(columns, titles=TITLES, **style):
    return titles + '\n' + rows(columns, **style)


def clock(seconds, form='{:02d}:{:02d}:{:06.3f}'):
    return [form.format(int(s // 3600) % 24, int(s // 60) % 60, s % 60) for s in seconds]


def grouped(values, mark, sign='.', digits=1):
    """As 1,234.5 with other marks."""
    return [f'{v:,.{digits}f}'.translate(str.maketrans(',.', mark + sign)) for v in values]


def tiff(pages):
    """A file of grey pictures of 8 bit, a page each."""
    data = struct.pack('<2sHI', b'II', 42, 8)
    for number, page in enumerate(pages):
        height, width = page.shape
        start = len(data) + 2 + 9 * 12 + 4  # of the page's bytes: behind its 9 entries
        entries = ((256, width), (257, height), (258, 8), (259, 1), (262, 1), (273, start), (277, 1), (278, height),
                   (279, page.size))
        data += struct.pack('<H', len(entries))
        data += b''.join(struct.pack('<HHII', tag, 4, 1, value) for tag, value in entries)
        data += struct.pack('<I', 0 if number + 1 == len(pages) else start + page.size) + page.tobytes()
    return data


def blurred(picture, deviation):
    """By a Gaussian, in px."""
    y, x = (numpy.fft.fftfreq(size) for size in picture.shape)
    return numpy.fft.ifft2(numpy.fft.fft2(picture) * numpy.exp(-2 * (numpy.pi * deviation)**2 *
                                                               (x[None, :]**2 + y[:, None]**2))).real


def drawn_cell(noise, seed, grain=0):
    """A picture of a cell of 76 um at 0.25 um a pixel, with a zona of 12 um; grain: of its cytoplasm."""
    y, x = numpy.mgrid[0:400, 0:400].astype(float)
    r = numpy.hypot(x - 200, y - 200)
    cytoplasm = blurred(numpy.random.default_rng(9).normal(0, 1, r.shape), 2.2)
    inside = (r < 128) * (-12 + grain * cytoplasm / cytoplasm.std()) if grain else 0
    rings = -38 * numpy.exp(-0.5 * ((r - 152) / 1.5)**2) - 90 * numpy.exp(-0.5 * ((r - 128) / 2.5)**2)
    picture = 158 + rings + inside + numpy.random.default_rng(seed).normal(0, noise, r.shape)
    return numpy.clip(numpy.round(picture), 0, 255).astype(numpy.uint8)


def scene(diameter='60e-6', holding='12e-6', tip='3e-6'):
    return (f'cell:\n  diameter: {diameter}\n'
            '  material: {model: neo_hookean, young_modulus: 1e3, poisson_ratio: 0.49}\n'
            f'holding_pipette: {{contact_radius: {holding}}}\n'
            f'needle:\n  tip: {{shape: hemisphere, radius: {tip}}}\n  contact: {{mode: sticking}}\n')


class LaboratoryFiles(InFolder):
    def setUp(self):
        super().setUp()
        self.way = Record(0, 7)

    def put(self, name, content):
        if isinstance(content, str):
            content = content.encode()
        path = self.folder / name
        path.write_bytes(content)
        return path

    def run_program(self, program, *arguments, limit=60):
        done = subprocess.run([programs.find(program, BUILT), *map(str, arguments)], cwd=self.folder, check=False,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=limit)
        done.stdout, done.stderr = done.stdout.decode(), done.stderr.decode()  # UTF-8, whatever the file was
        self.assertGreaterEqual(done.returncode, 0, f'{program} crashed')
        return done

    def identify(self, content, *options):
        self.put('record.csv', content)
        return self.run_program('identify', '--model', 'hertz', '--tip-radius', '10e-6', '--record', 'record.csv',
                                '--csv', 'found.csv', *options)

    def assert_found(self, content, *options, modulus=1000, said=()):
        """The modulus and its interval are right, and the parts of `said` are."""
        done = self.identify(content, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        line = next(line for line in (self.folder / 'found.csv').read_text().splitlines() if 'young_modulus' in line)
        value, low, high = map(float, line.split(',')[2:5])
        self.assertLess(abs(value / modulus - 1), TOLERANCE)
        self.assertLess(high - low, 2 * TOLERANCE * modulus)
        self.assertLess(abs(value - modulus), high - low, 'four deviations')
        for part in said:
            self.assertIn(part, done.stdout)
        return done.stdout

    def assert_refused(self, done, *parts, status=2):
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        for part in parts:
            self.assertIn(part, done.stderr)

    def assert_each_found(self, cases, **expected):
        for name, (content, *options) in cases.items():
            with self.subTest(name):
                self.assert_found(content, *options, **expected)

    def assert_each_refused(self, cases):
        for name, (content, *parts) in cases.items():
            with self.subTest(name):
                self.assert_refused(self.identify(content), 'record.csv', *parts)

    def test_a_hold_is_no_part_of_the_way_in(self):
        rest = numpy.arange(0, 10, 0.05)
        time = numpy.r_[self.way.time, self.way.time[-1] + 0.05 + rest]
        noise = self.way.random.normal(0, NOISE, len(rest))
        last = self.way.force[-1]
        for name, position, force in (
                ('creep', 7 + 0.6 * (1 - numpy.exp(-rest / 3)), last + noise),
                ('relaxation', 7 + 0.1 * noise, last * (0.6 + 0.4 * numpy.exp(-rest / 2)) + noise)):
            with self.subTest(name):
                record = [time, numpy.r_[self.way.position, position], numpy.r_[self.way.force, force]]
                said = self.assert_found(table(record), said=['of a hold are left out'])
                left_out = sum(map(int, re.findall(r': the (?:last )?(\d+) samples', said)))
                self.assertLess(abs(left_out - len(rest)), 10)
        for name, record in (('back afterwards', Record(0, 7, 7, 0)), ('on the way', Record(0, 3, 3, 7)),
                             ('at first', Record(0, 0, 7))):
            with self.subTest(name):
                self.assert_found(table(record.columns()))
        for count in (1, 2):
            with self.subTest(f'{count} samples'):
                more = [numpy.r_[column, [column[-1]] * count] for column in (self.way.position, self.way.force)]
                self.assert_found(table([STEP * numpy.arange(len(more[0])), *more]))

    def test_a_long_approach_spares_the_contact(self):
        even = numpy.linspace(0, 30, 12000)  # um; the last 100 samples are in contact
        uneven = numpy.r_[numpy.linspace(0, 29.75, 100000), numpy.linspace(29.75, 30, 101)[1:]]
        for name, position, drift in (('12000 rows', even, 0), ('a drift', even, 0.2), ('100000 rows', uneven, 0)):
            with self.subTest(name):
                record = Record(0, 1).set(position, modulus=20000, contact=29.75)
                record.force += drift * position
                self.assert_found(table(record.columns()), modulus=20000, said=['samples farthest from the cell'])
        few = Record(0, 1).set(even, modulus=20000, contact=29.955)  # 18 samples
        done = self.identify(table(few.columns()))
        self.assert_refused(done, 'samples are in contact', status=3)
        self.assertLess(abs(int(re.search(r'only (\d+) samples', done.stderr).group(1)) - 18), 5, 'samples of the file')

    def test_nothing_is_taken_off_a_tip(self):
        time, position, force = self.way.columns()
        for title, value in (('tip_um', position), ('indentation_um', position - 5), ('depth_um', position - 5)):
            with self.subTest(title):
                titles = f'time_s,{title},deflection_um,force_nN'
                self.assert_found(table([time, value, force / STIFFNESS, force], titles),
                                  said=[f"column '{title}' is the tip's: no deflection is taken off it"])

    def test_a_base_is_no_tip(self):
        time, position, force = self.way.columns()
        base = position + force / STIFFNESS
        height, spring = 'time_s,height_um,force_nN', ('--spring-constant', '0.05')
        both = [time, base, force / STIFFNESS, force]
        self.assert_each_found({
            'spring constant': (table([time, base, force], height), *spring),
            'turned': (table([time, -base, -force], height), *spring),
            'an offset': (table([time, base, force + 30], height), *spring),
            'deflection': (table(both, 'time_s,height_um,deflection_um,force_nN'),),
            'chosen': (table([time, base, force]), *spring, '--position-of', 'base'),
            'a tip is chosen': (table([time, position, force], height), *spring, '--position-of', 'tip')})
        done = self.identify(table([time, base, force], height))
        self.assertIn("'height_um' is taken for the tip's position; if it is that of a lever's base, give --spring-",
                      done.stdout)
        self.assert_refused(self.identify(table([time, base, force]), *spring), "'position_um'", '--position-of base')
        self.assert_refused(self.identify(table([time, base, force]), '--position-of', 'base'), '--spring-constant')

    def test_quotes_hold_separators(self):
        time, position, force = self.way.columns()
        titles = '"time (s)","travel, position (um)","force (nN)","mean force (nN)","stage (um)"'
        commas = [['"%s"' % cell for cell in grouped(column, ' ', ',', 4)] for column in self.way.columns()]
        fine = [grouped(1e3 * position, ','), grouped(1e3 * force, ',')]
        self.assert_each_found({
            'in a title': (table([time, position, force, force, position], titles),),
            'as decimal sign': (table(commas, '"time_s","position_um","force_nN"'),),
            'of thousands': (table([time, *(['"%s"' % cell for cell in column] for column in fine)],
                                   '"time_s","position_nm","force_pN"'),)})
        self.assert_each_refused({'a quote that stays open': (table(self.way.columns()).replace(',0.035', ',"0.035'),
                                                              'line 3', 'has 2 cells, the table has 3'),
                                  'a cell too many': (table(self.way.columns()) + '1,2,3,4\n1,2,3\n', 'line 203',
                                                      'has 4 cells')})

    def test_digits_in_threes(self):
        time, position, force = self.way.columns()
        titles = 'time_s;position_nm;force_pN'

        def in_threes(mark, sign, digits):
            columns = [grouped(1e3 * column, mark, sign, digits) for column in (position, force)]
            return table([grouped(time, mark, sign, 3), *columns], titles, separator=';')
        self.assert_each_found({name: (in_threes(*style),) for name, style in {
            'comma': (',', '.', 1), 'point': ('.', ',', 1), 'blank': (' ', ',', 1), 'apostrophe': ("'", '.', 1),
            'no-break space': ('\u00a0', ',', 1), 'narrow space': ('\u202f', ',', 1)}.items()})
        whole = table([grouped(1e3 * time, ',', digits=0), grouped(1e3 * position, ',', digits=0),
                       grouped(1e3 * force, ',', digits=0)], titles.replace('time_s', 'time_ms'), separator=';')
        for name, text in (('whole numbers', whole), ('with points', whole.replace(',', '.'))):
            with self.subTest(name):
                self.assert_found(text, said=['is taken for a number with a separator of thousands'])
        either = [['"%s"' % cell for cell in grouped(force + 5, ' ', ',', 3)]]
        self.assert_each_refused({'decimals or thousands': (
            table([numpy.arange(len(time)), 1e3 * position, *either], 'time_ms,position_nm,force_nN', number='%d'),
            'the comma may be the decimal sign, or separate thousands')})

    def test_a_table_begins_where_its_rows_do(self):
        text, spaced = table(self.way.columns()), rows(self.way.columns(), '   ')
        plain = rows(self.way.columns())
        numbered = ('--column', 'time=1:s', '--column', 'position=2:um', '--column', 'force=3:nN')
        self.assert_each_found({
            'a preamble': ('Force curve\nDate: 1 Jan 2026\n\n' + text,),
            'a preamble of numbers': ('Rate,10,20\nSpring constant,0.05,0.02\nDate,1,2\n' + text,),
            'numbers before it': ('1,2,3\n4,5,6\n\n' + text,),
            'titles in a comment': ('# instrument X\n# time_s position_um force_nN\n' + rows(self.way.columns(), ' '),),
            'titles and units in comments': ('#\n# columns: time height force\n# units: s um nN\n#\n' +
                                             rows(self.way.columns(), ' '),),
            'units below': ('time;position;force\ns;um;nN\n' + rows(self.way.columns(), ';'),),
            'blanks': ('Time (s)   Position (um)   Force (nN)\n' + spaced,),
            'no-break spaces': ('time\u00a0(s),position\u00a0(um),force\u00a0(nN)\n' + plain,),
            'slashes': ('time / s,position / um,force / nN\n' + plain,),
            'a separator at each end': (rows([*self.way.columns(), [''] * 201]).join([TITLES + ',\n', '']),),
            'no titles': (plain, *numbered)})
        self.assert_each_refused({
            'no titles': (plain, 'has no column of the position', 'no titles before line 1', '--column position='),
            'other titles': ('Rate,10\n' + plain, 'has no column of the position', 'Rate,10'),
            'other names': (table(self.way.columns(), 'a,b,c'), "line 1 has the columns 'a', 'b', 'c'")})

    def test_a_separator_that_is_said(self):
        self.assert_each_found({repr(sign): (f'sep={sign}\n' + table(self.way.columns(), TITLES.replace(',', sign),
                                                                     separator=sign),) for sign in ',;\t|:'})

    def test_a_decimal_comma(self):
        commas = table(self.way.columns(), separator=';').replace('.', ',').replace(TITLES, TITLES.replace(',', ';'))
        for name, text in (('semicolons', commas), ('tabs', commas.replace(';', '\t'))):
            with self.subTest(name):
                self.assert_found(text, said=['the decimal sign is a comma'])
        both = commas.replace(';', ',')
        why = 'a comma cannot be the separator and the decimal sign'
        whole = [[str(i) for i in range(201)], *self.way.columns()[1:]]
        self.assert_each_refused({
            'a separator, too': (both, 'line 1', why),
            'without titles': (both.split('\n', 1)[1], 'line 1', why),
            'whole times': (TITLES + '\n' + rows(whole).replace('.', ','), 'line 1', why),
            'one column': (table([*self.way.columns()[:2], grouped(self.way.force, ' ', ',', 5)]), TITLES),
            'some rows': (commas + '1.5;2.5;3.5\n', 'line 203', 'the decimal sign is another one')})

    def test_encodings_and_ends_of_lines(self):
        time, position, force = self.way.columns()
        text = table(self.way.columns())
        greek = table(self.way.columns(), 'time (s),position (\u03bcm),force (nN)')
        self.assert_each_found({
            **{name: (text.encode(name),) for name in ('utf-16', 'utf-16-le', 'utf-16-be', 'utf-8-sig')},
            'utf-16, greek': (greek.encode('utf-16'),), 'utf-8, greek': (greek,),
            'latin-1': (table(self.way.columns(), 'time (s),position (\u00b5m),force (nN)').encode('latin-1'),),
            'micro': (table([time, position, 1e-3 * force], 'time (s),position (um),force (\u00b5N)', number='%.8f'),),
            'a mark and quotes': ('\ufeff' + table(self.way.columns(), '"time (s)","position (um)","force (nN)"'),),
            'a minus sign': (text.replace('-', '\u2212'),),
            **{repr(end): (text.replace('\n', end),) for end in ('\r', '\r\n', '\r\r\n')},
            'gzip': (gzip.compress(text.encode()),)})
        self.assert_each_refused({
            'NUL': (text.replace('0.01750', '0.0\x001750'), 'line 3', 'NUL byte'),
            'NUL at the end': (text + '\0\0', 'NUL byte'),
            'gzip, cut off': (gzip.compress(text.encode())[:1000], 'damaged'),
            'utf-32': (text.encode('utf-32'), 'NUL byte'),
            'a spreadsheet': (b'PK\x03\x04\x14\x00\x06\x00' + bytes(range(256)), 'must be a text file')})

    def test_what_is_no_table_is_refused(self):
        self.assert_each_refused({repr(text): (text, *parts) for text, *parts in (
            ('""\n', 'line 1', 'no row with two numbers'), ('', 'the file is empty'), ('"',), ('\n\n', 'no row'),
            (',,,\n,,,\n', 'no row'), ('#\n%\n//\n', 'no row'), ('1\n', 'no row'), (';', 'no row'),
            ('sep=\n', 'no row'), ('\ufeff', 'empty'), (TITLES + '\n', 'no row'),
            (TITLES + '\n1,2,3\n', '1 rows', 'at least 20'), (table([['nan'] * 30] * 3), 'has no numbers'))})

    def test_no_slip_of_the_unit_gives_a_value(self):
        self.put('record.csv', table(self.way.columns()))
        for options, parts in ((('--model', 'cone', '--half-angle', '35'), ('--half-angle = 35 rad', '35 degrees')),
                               (('--model', 'cone', '--half-angle', '1.571'), ('--half-angle = 1.571',)),
                               (('--model', 'hertz', '--tip-radius', '10'), ('--tip-radius = 10 m', '10 um'))):
            with self.subTest(options):
                self.assert_refused(self.run_program('identify', '--record', 'record.csv', *options), *parts)
        self.put('scene.yaml', scene())
        self.put('um.yaml', scene('60', '12', '3'))
        done = self.run_program('indent', '--scene', 'um.yaml', '--depths', '1', '--csv', 'force.csv')
        self.assert_refused(done, 'um.yaml', 'cell/diameter = 60', '60 um', 'needle/tip/radius = 3')
        done = self.run_program('indent', '--scene', 'scene.yaml', '--depths', '1', '--csv', 'force.csv', limit=10)
        self.assert_refused(done, '--depths', "the cell's diameter")
        self.assertFalse((self.folder / 'force.csv').exists())

    def test_a_value_that_the_record_leaves_open_is_no_success(self):
        record = Record(0, 12, seed=4)
        force = hertz(record.position, 0.9)
        record.force = force + record.random.normal(0, 0.01 * force.max(), len(force))
        done = self.identify(table(record.columns(), number='%.6f'))
        self.assert_refused(done, 'young_modulus', 'the record does not determine it', status=5)
        self.assertIn('open below', done.stdout)
        record.force *= 0.75  # below the least modulus for the ball that is held, too
        self.put('record.csv', table(record.columns(), number='%.6f'))
        self.put('scene.yaml', scene('400e-6', '80e-6', '10e-6'))
        done = self.run_program('identify', '--record', 'record.csv', '--scene', 'scene.yaml', '--families', FAMILIES,
                                '--out', 'found.yaml')
        self.assert_refused(done, 'no scene is written', status=5)
        self.assertFalse((self.folder / 'found.yaml').exists())

    def test_an_optional_column_without_numbers_is_none(self):
        _, position, force = self.way.columns()
        for text in ('nan', '', 'later'):
            with self.subTest(text):
                said = ["column 'time_s', the time, has no numbers", "'later'" if text == 'later' else 'is left out']
                self.assert_found(table([[text] * len(force), position, force]), said=said)
        for name, parts in (('position_um', [self.way.time, ['x'] * len(force), force]),
                            ('force_nN', [self.way.time, position, ['x'] * len(force)])):
            with self.subTest(name):
                self.assert_refused(self.identify(table(parts)), f"'{name}'", 'has no numbers', "'x'")

    def test_times_of_the_day(self):
        _, position, force = self.way.columns()
        for name, times in {
                'noon': clock(43200 + self.way.time), 'over midnight': clock(86398 + self.way.time),
                'minutes': clock(58 + self.way.time, '{1:02d}:{2:06.3f}'),
                'in halves': clock(3600 + self.way.time, '{0:d}:{1:02d}:{2:06.3f} PM'),
                'date': clock(self.way.time, '2026-01-31 {:02d}:{:02d}:{:06.3f}'),
                'German date': clock(self.way.time, '31.01.2026 {:02d}:{:02d}:{:06.3f}'),
                'time zone': clock(self.way.time, '2026-01-31T{:02d}:{:02d}:{:06.3f}+01:00')}.items():
            with self.subTest(name):
                self.assert_found(table([times, position, force]), '--residuals', 'residuals.csv')
                time = numpy.genfromtxt(self.folder / 'residuals.csv', delimiter=',', names=True)['time_s']
                numpy.testing.assert_allclose(time, self.way.time, atol=1.1e-3)

    def test_the_way_in_leads_to_the_deepest_sample(self):
        records = {'back at first': (7, 0, 7), 'three approaches': (0, 7, 0, 7, 0, 7),
                   'each deeper': (0, 6, 0, 6.5, 0, 7), 'each less deep': (0, 7, 0, 6.5, 0, 6),
                   'not out of the cell': (0, 7, 4, 7, 4, 7.1)}
        for name, places in records.items():
            with self.subTest(name):
                record = Record(*places)
                back = numpy.gradient(record.position) < 0
                record.force[back] -= 0.25 * hertz(record.position)[back]  # what a cell loses
                self.assert_found(table(record.columns()), said=['are left out'])

    def test_a_segment_is_chosen_by_its_word(self):
        record = Record(0, 7, 7, 0)
        record.force[numpy.array(record.leg) == 2] *= 0.8
        for words in (('extend', 'pause', 'retract'), ('EXTEND', 'HOLD', 'RETRACT'), ('approach', 'dwell', 'retract'),
                      ('trace', '', 'retrace'), ('loading', 'hold', 'unloading'), ('1', '2', '3'),
                      ('Ext', 'Hold', 'Ret')):
            text = table([*record.columns(), [words[leg] for leg in record.leg]], TITLES + ',segment')
            with self.subTest(words):
                self.assert_found(text, said=['left out'])
                self.assert_found(text, '--segment', words[0], said=['rows of other segments'])
        self.assert_refused(self.identify(text, '--segment', 'x'), '--segment = x', 'Ext, Hold, Ret')
        self.assert_refused(self.identify(table(record.columns()), '--segment', 'x'), "no column 'segment'")

    def test_the_way_in_ends_at_a_puncture(self):
        beyond = numpy.linspace(7, 10, 80)
        time, position = STEP * numpy.arange(281), numpy.r_[self.way.position, beyond]
        noise = self.way.random.normal(0, NOISE, 80)
        for name, force in (('falls', 0.02 * (beyond - 7)), ('rises again', 10 * (beyond - 7)**1.5)):
            record = [time, position, numpy.r_[self.way.force, 0.25 * self.way.force[-1] + force + noise]]
            with self.subTest(name):
                self.assert_found(table(record), said=['the force breaks down', '80 samples'])
                self.assert_found(table([*record, (time > self.way.time[-1]).astype(float)], TITLES + ',punctured'),
                                  said=['80 rows from the puncture on'])

    def test_a_tip_that_snaps_in_punctures_nothing(self):
        time, position, force = self.way.columns()
        near = (position > 4.7) & (position < 5.2)  # um
        self.assert_found(table([time, position, force - near * 3 * (1 - (position - 4.7) / 0.5)]))

    def test_a_scene_in_no_family_is_told_why(self):
        self.put('record.csv', table(self.way.columns()))
        material = 'material: {model: neo_hookean, young_modulus: 17.9e3, poisson_ratio: 0.49}'
        self.put('zona.yaml', f'''cell:
  layers:
    - {{name: zona, outer_radius: 76e-6, {material}}}
    - {{name: inside, outer_radius: 64e-6, {material.replace('17.9e3', '1e3')}}}
holding_pipette: {{contact_radius: 13.6e-6}}
needle:
  tip: {{shape: hemisphere, radius: 3e-6}}
  contact: {{mode: sticking}}
''')
        call = ('identify', '--record', 'record.csv', '--scene', 'zona.yaml', '--model', 'family', '--families')
        self.assert_refused(self.run_program(*call, FAMILIES), 'holding_radius 0.179 of [0.35, 0.364]')
        self.assert_refused(self.run_program(*call, 'nowhere'), 'nowhere', 'no folder')

    def test_no_number_is_read_as_octal(self):
        self.put('scene.yaml', scene())
        text = ('scene: scene.yaml\ndesign: random\nsamples: 010\n'
                'keys: [{key: needle/tip/radius, from: 3e-6, to: 4e-6}]\n'
                'indentation: {depths: [5e-7], tolerance: 0.5}\n')
        self.put('sweep.yaml', text)
        self.assert_refused(self.run_program('sweep', '--file', 'sweep.yaml', '--list'), 'samples', 'octal')
        self.put('sweep.yaml', text.replace('010', '10'))
        self.assertEqual(len(self.run_program('sweep', '--file', 'sweep.yaml', '--list').stdout.splitlines()), 11)

    def measure(self, picture):
        """Status, text, diameter and its half interval in um."""
        self.put('cell.tif', picture)
        done = self.run_program('measure_cell', 'cell.tif', '--pixel-size', '0.25e-6')
        found = re.search(r'^diameter: (\S+) \+- (\S+) um', done.stdout, re.MULTILINE)
        return done.returncode, done.stdout, *(map(float, found.groups()) if found else (0, 0))

    def test_all_pages_of_a_picture_are_seen(self):
        sharp = drawn_cell(1.5, 2)
        dull = numpy.clip(blurred(sharp.astype(float), 12), 0, 255).astype(numpy.uint8)
        for name, pages, first in (('dull first', [dull, sharp], 2), ('sharp first', [sharp, dull], 1)):
            with self.subTest(name):
                status, text, diameter, _ = self.measure(tiff(pages))
                self.assertEqual(status, 0, text)
                self.assertRegex(text, rf'page {first} of 2|image .*{first} of 2')
                self.assertLess(abs(diameter - 76), 1)

    def test_the_interval_of_a_diameter_holds_pictures_of_one_cell(self):
        for noise, seed in ((1, 2), (1.5, 10), (2, 3), (6, 4)):
            with self.subTest(noise=noise, seed=seed):
                status, text, diameter, half = self.measure(tiff([drawn_cell(noise, seed, grain=5)]))
                self.assertEqual(status, 0, text)
                self.assertLess(abs(diameter - 76), half + 0.005, 'the diameter has four digits')
                self.assertLess(half, 3, 'it says something')


if __name__ == '__main__':
    unittest.main()
