#!/usr/bin/python3
"""What a tool reads and what it will write, as src/base/output_files.h does for the programs in C++."""
import os
from pathlib import Path


def check_outputs(reads, writes):
    """Raises ValueError when an output is an input or cannot be written. Call it before any work.

    reads, writes: {name of the argument: path, or None}.
    """
    reads = {name: Path(path) for name, path in reads.items() if path}
    writes = {name: Path(path) for name, path in writes.items() if path}
    done = {}
    for name, path in writes.items():
        for verb, others in (('read', reads), ('written, too', done)):
            for other, taken in others.items():
                if _are_same(path, taken):
                    raise ValueError(f'{name} = {path}: must be another file than {other}, which is {verb}')
        done[name] = path
    for path in writes.values():
        if path.is_dir():
            raise ValueError(f'{path}: cannot be written: is a folder')
        there = path if path.exists() else next(folder for folder in path.absolute().parents if folder.exists())
        if not os.access(there, os.W_OK) or not (path.exists() or there.is_dir()):
            raise ValueError(f'{path}: cannot be written: {there} may not be changed')
        path.absolute().parent.mkdir(parents=True, exist_ok=True)


def _are_same(one, other):
    if one.exists() and other.exists():
        return one.samefile(other)
    return one.resolve() == other.resolve()
