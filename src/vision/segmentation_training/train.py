#!/usr/bin/python3
"""Trains the segmentation network on rendered images and writes its weights for OpenCV.

The images come from render_training_images, seed by seed, and each is shown a few times, mirrored and turned by half a
turn at random. Writes segmentation.onnx, and segmentation.yaml beside it: the classes, the checksum of the weights, and
where they come from. Stops early with what it has learnt at an interrupt (Ctrl-C) or after --minutes.
"""
import argparse
import itertools
import math
import queue
import subprocess
import sys
import threading
import time
import zlib
from pathlib import Path

import numpy as np
import torch
import yaml
from torch import nn
from torch.nn import functional

VALIDATION_SEED = 10_000_000  # seeds from here on are never learnt
NO_LABEL = 255


class Format:
    """What render_training_images writes."""

    def __init__(self, program):
        self.program = program
        described = yaml.safe_load(subprocess.run([program, '--format'], stdout=subprocess.PIPE, check=True).stdout)
        self.width, self.height, self.planes = (described[key] for key in ('width', 'height', 'planes'))
        self.zero, self.unit, self.classes = (described[key] for key in ('zero', 'unit', 'classes'))
        self.image_bytes = self.planes * self.width * self.height
        self.bytes = self.image_bytes + self.width * self.height // 4

    def read(self, stream, count):
        """Returns up to `count` images (n, planes, height, width) and labels (n, height / 2, width / 2), as bytes."""
        data = stream.read(count * self.bytes)
        records = np.frombuffer(data, np.uint8)[:len(data) // self.bytes * self.bytes].reshape(-1, self.bytes)
        return (records[:, :self.image_bytes].reshape(-1, self.planes, self.height, self.width),
                records[:, self.image_bytes:].reshape(-1, self.height // 2, self.width // 2))

    def images(self, first, count):
        """All images of a range of seeds."""
        with subprocess.Popen([self.program, str(first), str(count)], stdout=subprocess.PIPE) as process:
            images = self.read(process.stdout, count)
        if process.returncode != 0 or len(images[0]) != count:
            sys.exit(f'{self.program} {first} {count}: ended with {process.returncode}')
        return images

    def tensor(self, images):
        return (torch.from_numpy(images.astype(np.float32)) - self.zero) / self.unit


def block(inputs, outputs):
    layers = []
    for channels in (inputs, outputs):
        layers += [nn.Conv2d(channels, outputs, 3, padding=1, bias=False), nn.BatchNorm2d(outputs), nn.ReLU(inplace=True)]
    return nn.Sequential(*layers)


class Network(nn.Module):
    """A U-Net (Ronneberger et al. 2015) whose output has half the resolution of its input."""

    def __init__(self, planes, classes, channels):
        super().__init__()
        # 6 x 6: an output pixel lies in the middle of its 2 x 2 input pixels.
        self.stem = nn.Sequential(nn.Conv2d(planes, channels[0], 6, 2, 2, bias=False), nn.BatchNorm2d(channels[0]),
                                  nn.ReLU(inplace=True))
        self.down = nn.ModuleList(block(a, b) for a, b in zip((channels[0], *channels), channels))
        self.up = nn.ModuleList(block(channels[i + 1] + channels[i], channels[i]) for i in reversed(range(len(channels) - 1)))
        self.out = nn.Conv2d(channels[0], classes, 1)

    def forward(self, x):
        x = self.stem(x)
        kept = []
        for i, down in enumerate(self.down):
            x = down(x if i == 0 else functional.max_pool2d(x, 2))
            kept.append(x)
        for up, skip in zip(self.up, reversed(kept[:-1])):
            x = up(torch.cat([functional.interpolate(x, scale_factor=2.0, mode='nearest'), skip], 1))
        return self.out(x)


class ForUse(nn.Module):
    """The network with probabilities at its end."""

    def __init__(self, network):
        super().__init__()
        self.network = network

    def forward(self, x):
        return torch.softmax(self.network(x), 1)


def loss_of(logits, labels, weights):
    """Cross entropy, and one less the soft Dice of the classes that a batch has."""
    entropy = functional.cross_entropy(logits, labels, weights, ignore_index=NO_LABEL)
    seen = (labels != NO_LABEL).unsqueeze(1)
    truth = functional.one_hot(labels.clamp(max=logits.shape[1] - 1), logits.shape[1]).permute(0, 3, 1, 2) * seen
    guess = torch.softmax(logits, 1) * seen
    axes = (0, 2, 3)
    both, either = (truth * guess).sum(axes), truth.sum(axes) + guess.sum(axes)
    dice = (2 * both + 1) / (either + 1)
    return entropy + 0.5 * (1 - dice[truth.sum(axes) > 0].mean())


def turned(images, labels, random):
    """Mirrors and half turns, which no micrograph forbids."""
    for axis in (-1, -2):
        if random.random() < 0.5:
            images, labels = np.flip(images, axis), np.flip(labels, axis)
    return np.ascontiguousarray(images), np.ascontiguousarray(labels)


def coarser(images, labels, random):
    """The same at half the resolution: a quarter of the time to learn from."""
    count, planes, height, width = images.shape
    mean = images.reshape(count, planes, height // 2, 2, width // 2, 2).mean((3, 5), dtype=np.float32)
    return mean, labels[:, random.integers(2)::2, random.integers(2)::2]


class Stream:
    """Images of a range of seeds, rendered and read while others are learnt from."""

    BLOCK = 16  # images

    def __init__(self, layout, first, count):
        self.layout, self.missing = layout, count
        self.process = subprocess.Popen([layout.program, str(first), str(count)], stdout=subprocess.PIPE)
        self.blocks = queue.Queue(8)
        self.stopped = False
        self.thread = threading.Thread(target=self.read, daemon=True)
        self.thread.start()

    def read(self):
        while not self.stopped:
            block = self.layout.read(self.process.stdout, self.BLOCK)
            self.blocks.put(block)
            if len(block[0]) < self.BLOCK:
                break

    def __iter__(self):
        while True:
            images, labels = self.blocks.get()
            self.missing -= len(images)
            yield from zip(images, labels)
            if len(images) < self.BLOCK:
                break
        if self.missing:
            sys.exit(f'train.py: {self.layout.program} ended {self.missing} images too early')

    def close(self):
        self.stopped = True
        self.process.terminate()
        while self.thread.is_alive():
            try:
                self.blocks.get(timeout=0.1)
            except queue.Empty:
                pass
        self.process.wait()


class Pool:
    """Images to learn from: each is shown `repeats` times on average, and replaced by the next."""

    def __init__(self, layout, first, count, size, repeats, random):
        self.random = random
        self.stream = Stream(layout, first, count)
        self.fresh = iter(self.stream)
        pairs = list(itertools.islice(self.fresh, min(size, count)))
        self.images, self.labels = (np.stack(arrays) for arrays in zip(*pairs))
        self.replaced = (count - len(pairs)) / count / repeats  # images for each that is shown
        self.debt = 0.0

    def batch(self, count):
        """Returns images and labels."""
        self.debt += count * self.replaced
        while self.debt >= 1:
            pair = next(self.fresh, None)
            if pair is None:
                break  # all seeds have been used up
            place = self.random.integers(len(self.images))
            self.images[place], self.labels[place] = pair
            self.debt -= 1
        chosen = self.random.choice(len(self.images), count, replace=False)
        pairs = [turned(self.images[i], self.labels[i], self.random) for i in chosen]
        return np.stack([pair[0] for pair in pairs]), np.stack([pair[1] for pair in pairs])

    def close(self):
        self.stream.close()


def confusion(network, layout, images, labels):
    """Returns (truth, guess) -> pixels."""
    classes = len(layout.classes)
    counts = np.zeros((classes, classes), np.int64)
    network.eval()
    with torch.no_grad():
        for i in range(0, len(images), 8):
            guess = network(layout.tensor(images[i:i + 8])).argmax(1).numpy()
            truth = labels[i:i + 8]
            seen = truth != NO_LABEL
            counts += np.bincount(truth[seen].astype(np.int64) * classes + guess[seen],
                                  minlength=classes * classes).reshape(classes, classes)
    network.train()
    return counts


def dice_of(counts):
    """Dice of each class over all pixels."""
    return 2 * np.diag(counts) / np.maximum(counts.sum(0) + counts.sum(1), 1)


def class_weights(labels, classes):
    """Rare classes weigh more, by the fourth root of their share."""
    share = np.array([max((labels == i).sum(), 1) for i in range(classes)]) / (labels != NO_LABEL).sum()
    weights = np.clip(share, 1e-4, 1)**-0.25
    return torch.tensor(weights / (weights * share).sum(), dtype=torch.float32)


def progress(step, steps, loss, began):
    print(f'step {step} of {steps}, loss {loss:.3f}, {time.process_time():.0f} s of processor, '
          f'{time.monotonic() - began:.0f} s', flush=True)


def learn(network, layout, arguments):
    """Trains and returns (images shown, steps)."""
    random = np.random.default_rng(arguments.seed)
    pool = Pool(layout, arguments.first, arguments.images, arguments.pool, arguments.repeats, random)
    weights = class_weights(pool.labels, len(layout.classes))
    steps = int(arguments.images * arguments.repeats) // arguments.batch
    optimizer = torch.optim.AdamW(network.parameters(), lr=arguments.rate, weight_decay=1e-4)
    began, mean, step, done = time.monotonic(), None, 0, 0.0
    try:
        while done < 1:
            pair = pool.batch(arguments.batch)
            done = step / steps
            if arguments.minutes:
                done = max(done, (time.monotonic() - began) / 60 / arguments.minutes)
            if done < arguments.coarse:
                pair = coarser(*pair, random)
            rate = arguments.rate * min(1, (step + 1) / 100) * (0.5 + 0.5 * math.cos(math.pi * min(done, 1)))
            for group in optimizer.param_groups:
                group['lr'] = rate
            loss = loss_of(network(layout.tensor(pair[0])), torch.from_numpy(pair[1].astype(np.int64)), weights)
            optimizer.zero_grad()
            loss.backward()
            optimizer.step()
            step += 1
            mean = loss.item() if mean is None else 0.98 * mean + 0.02 * loss.item()
            if step % 50 == 0:
                progress(step, steps, mean, began)
            if step % 500 == 0:
                write_weights(network, layout, arguments.out / 'segmentation.onnx')
                torch.save(network.state_dict(), arguments.out / 'segmentation.pt')
    except KeyboardInterrupt:
        print('stopped', flush=True)
    pool.close()
    return step * arguments.batch, step


def write_weights(network, layout, path):
    network.eval()
    sample = torch.zeros(1, layout.planes, layout.height, layout.width)
    torch.onnx.export(ForUse(network), sample, str(path), opset_version=11, input_names=['image'],
                      output_names=['probabilities'])
    network.train()


def commit():
    done = subprocess.run(['git', '-C', str(Path(__file__).parent), 'describe', '--always', '--dirty', '--abbrev=12'],
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    return done.stdout.decode().strip() or 'unknown'


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--program', required=True, help='render_training_images')
    parser.add_argument('--out', type=Path, required=True, help='folder of the weights')
    parser.add_argument('--images', type=int, default=40000, help='rendered images')
    parser.add_argument('--repeats', type=float, default=2, help='times that each is shown')
    parser.add_argument('--minutes', type=float, default=0, help='ends after this time at most; 0: no limit')
    parser.add_argument('--coarse', type=float, default=0.4, help='share of the training at half the resolution')
    parser.add_argument('--batch', type=int, default=12)
    parser.add_argument('--pool', type=int, default=1500, help='images to choose from at any time')
    parser.add_argument('--rate', type=float, default=3e-3, help='largest learning rate')
    parser.add_argument('--channels', type=int, nargs='+', default=[12, 24, 48, 96, 96])
    parser.add_argument('--first', type=int, default=0, help='first seed of the images')
    parser.add_argument('--seed', type=int, default=1, help='of the first weights and the order')
    parser.add_argument('--start', type=Path, help='weights (.pt) to go on from')
    parser.add_argument('--validation', type=int, default=300, help='images to judge with')
    arguments = parser.parse_args()
    least = max(arguments.batch, math.ceil(arguments.batch / arguments.repeats))
    if arguments.images < least or arguments.pool < arguments.batch:
        parser.error(f'--images must be at least {least}, and --pool at least --batch = {arguments.batch}')
    return arguments


def main():
    arguments = parse_arguments()
    torch.set_num_threads(1)
    torch.manual_seed(arguments.seed)
    arguments.out.mkdir(parents=True, exist_ok=True)
    layout = Format(arguments.program)
    network = Network(layout.planes, len(layout.classes), arguments.channels)
    if arguments.start:
        network.load_state_dict(torch.load(arguments.start))
    began = time.monotonic()
    shown, steps = learn(network, layout, arguments)
    path = arguments.out / 'segmentation.onnx'
    write_weights(network, layout, path)
    torch.save(network.state_dict(), arguments.out / 'segmentation.pt')
    dice = dice_of(confusion(network, layout, *layout.images(VALIDATION_SEED, arguments.validation)))
    described = {
        'classes': layout.classes,
        'crc32': zlib.crc32(path.read_bytes()),
        'provenance': {
            'command': 'train.py ' + ' '.join(f'--{key} {value}' for key, value in vars(arguments).items()
                                              if key not in ('program', 'out') and value is not None),
            'commit': commit(),
            'images_shown': shown,
            'steps': steps,
            'minutes': round((time.monotonic() - began) / 60, 1),
            'torch': str(torch.__version__),
            'validation': f'{arguments.validation} images from seed {VALIDATION_SEED}',
            'validation_dice': {name: round(float(value), 3) for name, value in zip(layout.classes, dice)},
        },
    }
    (arguments.out / 'segmentation.yaml').write_text(
        '# Weights of the segmentation network (doc/design/segmentation.md). Written by ./dev train.\n' +
        yaml.safe_dump(described, sort_keys=False, width=110))
    for name, value in described['provenance']['validation_dice'].items():
        print(f'{name:22} Dice {value:.3f}')


if __name__ == '__main__':
    main()
