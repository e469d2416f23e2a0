"""Cases of ./dev bench peers: scene files with some keys set otherwise, and meshes of them."""
import subprocess

import yaml


def changed(scene, keys):
    """Returns a scene's YAML tree with values at dotted keys. Raises KeyError for a key that the scene does not have."""
    for path, value in keys.items():
        *folders, last = path.split('.')
        node = scene
        for folder in folders:
            node = node[folder]
        if last not in node:
            raise KeyError(path)
        node[last] = value
    return scene


class CaseWriter:
    """Writes the cases of scenes to a folder, each once."""

    def __init__(self, program, folder, cells, scenes):
        self.program, self.folder, self.cells, self.scenes = program, folder, cells, scenes
        folder.mkdir(parents=True, exist_ok=True)

    def scene_file(self, name):
        path = self.folder / f'{name}.yaml'
        if not path.exists():
            scene = self.scenes[name]
            tree = yaml.safe_load((self.cells / f'{scene["cell"]}.yaml').read_text(encoding='utf-8'))
            path.write_text(yaml.safe_dump(changed(tree, scene.get('set', {}))), encoding='utf-8')
        return path

    def write(self, name, mesh, level, depths):
        """Returns the path of a case; depths in um. Raises subprocess.CalledProcessError."""
        path = self.folder / f'{name}_{mesh}_{level}_{len(depths)}_{depths[-1]:g}.case'
        if not path.exists():
            subprocess.run([self.program, '--scene', self.scene_file(name), '--mesh', mesh, f'--level={level}', '--depths',
                            ','.join(repr(1e-6 * depth) for depth in depths), '--out', path], check=True)
        return path


def read_counts(path):
    """Returns the columns vertices and tetrahedra (triangles of a section) of a case."""
    counts = {}
    with open(path, encoding='utf-8') as file:
        for line in file:
            if line.startswith('nodes'):
                counts['vertices'] = int(line.split()[2])
            elif line.startswith('elements'):
                counts['tetrahedra'] = int(line.split()[1])
                break
    return counts
