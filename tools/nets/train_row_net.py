#!/usr/bin/env python3
"""Trains the segmentation net of assets/models/row_net.onnx on pictures of `vinerow dataset`.

    vinerow dataset assets/studies/row_net_dataset.yaml --out datasets/rows
    tools/nets/train_row_net.py datasets/rows assets/models/row_net.onnx

It needs Debian's python3-torch and python3-numpy, and pillow. No real picture takes part. The net is
an encoder and a decoder with shortcuts (after Ronneberger, Fischer, Brox, "U-Net", 2015), small enough
for a picture of 160 x 120 pixels in some milliseconds on one core.
"""

import argparse
import pathlib

import numpy as np
import torch
from PIL import Image
from torch import nn

CLASSES = ["sky", "ground", "leaf", "wood", "post"]
# Labels of the pictures (docs/models/cameras.md) to classes; the rest does not count.
CLASS_OF_LABEL = {0: 0, 1: 1, 2: 2, 3: 3, 4: 2, 5: 2, 6: 4}
IGNORED = 255
# Trunks and posts are a few percent of the pixels, and their feet are what matters.
WEIGHTS = [1.0, 1.0, 1.0, 3.0, 3.0]


def load(folder, part):
    """Pictures, n x h x w x 3 of 0..255, and their classes, n x h x w."""
    table = np.full(256, IGNORED, np.uint8)
    for label, number in CLASS_OF_LABEL.items():
        table[label] = number
    pictures, classes = [], []
    for path in sorted((folder / "images" / part).glob("*.png")):
        pictures.append(np.asarray(Image.open(path).convert("RGB")))
        classes.append(table[np.asarray(Image.open(folder / "semantic" / part / path.name))])
    return np.stack(pictures), np.stack(classes)


class RowNet(nn.Module):
    """n x 3 x h x w of 0..1 to the scores of the classes, n x classes x h x w; h and w are multiples of 8."""

    def __init__(self):
        super().__init__()

        def layer(inputs, outputs, stride=1):
            return nn.Conv2d(inputs, outputs, 3, stride, padding=1)

        self.at_half = nn.Sequential(layer(3, 12, 2), nn.ReLU(), layer(12, 12), nn.ReLU())
        self.at_quarter = nn.Sequential(layer(12, 24, 2), nn.ReLU(), layer(24, 24), nn.ReLU())
        self.at_eighth = nn.Sequential(layer(24, 40, 2), nn.ReLU(), layer(40, 40), nn.ReLU())
        self.to_quarter = nn.Sequential(layer(40 + 24, 24), nn.ReLU())
        self.to_half = nn.Sequential(layer(24 + 12, 12), nn.ReLU())
        self.to_full = nn.Sequential(layer(12 + 3, 8), nn.ReLU(), layer(8, len(CLASSES)))

    def forward(self, picture):
        def twice(x):
            return nn.functional.interpolate(x, scale_factor=2.0, mode="nearest")

        half = self.at_half(picture)
        quarter = self.at_quarter(half)
        x = self.to_quarter(torch.cat([twice(self.at_eighth(quarter)), quarter], 1))
        x = self.to_half(torch.cat([twice(x), half], 1))
        return self.to_full(torch.cat([twice(x), picture], 1))


def varied(random, pictures, classes):
    """Mirrored, brighter or darker, tinted, with another contrast and noise."""
    count = len(pictures)
    x = pictures.astype(np.float32) / 255.0
    mirrored = random.random(count) < 0.5
    x[mirrored] = x[mirrored, :, ::-1]
    classes = classes.copy()
    classes[mirrored] = classes[mirrored, :, ::-1]
    gain = np.exp(random.normal(0.0, 0.2, (count, 1, 1, 1)))
    tint = np.exp(random.normal(0.0, 0.05, (count, 1, 1, 3)))
    gamma = np.exp(random.normal(0.0, 0.15, (count, 1, 1, 1)))
    noise = random.normal(0.0, 0.015, x.shape)
    x = np.clip(gain * tint * np.maximum(x, 1e-4) ** gamma + noise, 0.0, 1.0)
    return x.astype(np.float32), classes


def planes(pictures):
    """n x h x w x 3 of 0..1 as a tensor n x 3 x h x w."""
    return torch.from_numpy(np.ascontiguousarray(pictures.transpose(0, 3, 1, 2)))


def intersection_over_union(net, pictures, classes):
    """Share of each class, over all pictures."""
    both, either = np.zeros(len(CLASSES)), np.zeros(len(CLASSES))
    for i in range(0, len(pictures), 60):
        with torch.no_grad():
            found = net(planes(pictures[i : i + 60].astype(np.float32) / 255.0)).argmax(1).numpy()
        truth = classes[i : i + 60]
        known = truth != IGNORED
        for c in range(len(CLASSES)):
            both[c] += np.sum((found == c) & (truth == c) & known)
            either[c] += np.sum(((found == c) | (truth == c)) & known)
    return both / np.maximum(either, 1)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("model", type=pathlib.Path)
    parser.add_argument("--steps", type=int, default=3000)
    parser.add_argument("--batch", type=int, default=16)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()

    torch.manual_seed(arguments.seed)
    torch.use_deterministic_algorithms(True)
    random = np.random.default_rng(arguments.seed)
    pictures, classes = load(arguments.data, "train")
    others, their_classes = load(arguments.data, "val")
    net = RowNet()
    optimiser = torch.optim.Adam(net.parameters(), 3e-3)
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimiser, arguments.steps)
    loss = nn.CrossEntropyLoss(torch.tensor(WEIGHTS), ignore_index=IGNORED)

    total = 0.0
    for number in range(1, arguments.steps + 1):
        chosen = random.integers(0, len(pictures), arguments.batch)
        seen, wanted = varied(random, pictures[chosen], classes[chosen])
        optimiser.zero_grad()
        value = loss(net(planes(seen)), torch.from_numpy(wanted.astype(np.int64)))
        value.backward()
        optimiser.step()
        schedule.step()
        total += float(value)
        if number % 200 == 0:
            print(f"step {number}: loss {total / 200:.4f}", flush=True)
            total = 0.0

    print(f"{len(pictures)} pictures for training, {len(others)} for validation; intersection over union there:")
    for name, share in zip(CLASSES, intersection_over_union(net, others, their_classes)):
        print(f"  {name:8s} {share:.3f}")
    height, width = pictures.shape[1:3]
    torch.onnx.export(net, torch.zeros(1, 3, height, width), arguments.model, opset_version=11,
                      input_names=["picture"], output_names=["scores"])


if __name__ == "__main__":
    main()
