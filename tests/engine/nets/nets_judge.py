#!/usr/bin/env python3
"""Scores of nets against PyTorch, which computes them and writes the ONNX files.

usage: nets_judge.py NET_SCORES [--emulated]

--emulated  also compares with an old processor; a program with a sanitizer does not run there
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
PROGRAM = sys.argv.pop(1)
IS_EMULATED = "--emulated" in sys.argv[1:]

try:
    import numpy as np
    import torch
    from torch import nn
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

# A processor without AVX: its bits must be those of the machine.
OLD_PROCESSOR = ["qemu-x86_64-static", "-cpu", "Nehalem"]


def run(model, planes, under=()):
    height, width = planes.shape[1:]
    done = subprocess.run([*under, PROGRAM, str(model), str(height), str(width)], input=planes.tobytes(), capture_output=True)
    if done.returncode == 77:
        print(f"skipped: {done.stderr.decode().strip()}")
        sys.exit(77)
    return done


def scores_of(model, planes, under=()):
    done = run(model, planes, under)
    assert done.returncode == 0, done.stderr.decode()
    shape = [int(word) for word in done.stderr.split()]
    return np.frombuffer(done.stdout, np.float32).reshape(shape)


def picture(height, width, seed=1):
    return np.random.default_rng(seed).random((3, height, width)).astype(np.float32)


class Coarse(nn.Module):
    """What nets for other tasks contain: normalisation, pooling, transposed convolution, bilinear enlargement, softmax."""

    def __init__(self):
        super().__init__()
        self.first = nn.Sequential(nn.Conv2d(3, 8, 3, 2, 1), nn.BatchNorm2d(8), nn.LeakyReLU(0.1), nn.MaxPool2d(2))
        self.second = nn.Sequential(nn.Conv2d(8, 16, 3, padding=2, dilation=2, groups=4), nn.Sigmoid())
        self.up = nn.ConvTranspose2d(16, 6, 2, 2)
        self.first[1].running_mean.uniform_(-0.5, 0.5)
        self.first[1].running_var.uniform_(0.5, 2.0)

    def forward(self, x):
        y = self.up(self.second(self.first(x)))
        y = nn.functional.interpolate(y, scale_factor=2, mode="bilinear", align_corners=False)
        return torch.softmax(y, 1)


class Flat(nn.Module):
    def forward(self, x):
        return x.mean((2, 3))


class NetsJudge(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        torch.manual_seed(1)
        cls.folder = tempfile.TemporaryDirectory()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def export(self, net, planes):
        file = pathlib.Path(self.folder.name) / f"{self.id().split('.')[-1]}.onnx"
        torch.onnx.export(net.eval(), torch.from_numpy(planes[None]), file, opset_version=11)
        return file

    def compare(self, net, planes, bound):
        file = self.export(net, planes)
        with torch.no_grad():
            expected = net(torch.from_numpy(planes[None]))[0].numpy()
        found = scores_of(file, planes)
        self.assertEqual(found.shape, expected.shape)
        error = float(np.abs(found - expected).max())
        print(f"{self.id()}: largest error {error:.1e} of scores up to {np.abs(expected).max():.2f}")
        self.assertLess(error, bound)

    def test_one_convolution(self):
        # By hand: the class is the colour.
        net = nn.Conv2d(3, 3, 1)
        with torch.no_grad():
            net.weight[:] = torch.eye(3)[:, :, None, None]
            net.bias[:] = torch.tensor([0.0, 1.0, 2.0])
        planes = picture(5, 7)
        found = scores_of(self.export(net, planes), planes)
        np.testing.assert_allclose(found, planes + np.array([0, 1, 2])[:, None, None], atol=1e-6)

    def test_layers_of_other_nets(self):
        self.compare(Coarse(), picture(48, 64), 1e-5)

    def test_the_net_of_the_assets_at_two_sizes(self):
        sys.path.insert(0, str(ROOT / "tools/nets"))
        from train_row_net import RowNet

        for size in ((120, 160), (96, 240)):
            self.compare(RowNet(), picture(*size), 1e-4)

    def test_same_bits_on_an_old_processor(self):
        if not IS_EMULATED or shutil.which(OLD_PROCESSOR[0]) is None:
            self.skipTest("without an emulator")
        for net in (Coarse(), nn.Sequential(nn.Conv2d(3, 24, 3, 2, 1), nn.ReLU(), nn.Conv2d(24, 5, 3, 1, 1))):
            planes = picture(32, 32)
            file = self.export(net, planes)
            np.testing.assert_array_equal(scores_of(file, planes), scores_of(file, planes, OLD_PROCESSOR))

    def fault(self, model, planes):
        done = run(model, planes)
        self.assertEqual(done.returncode, 1)
        words = done.stderr.decode()
        self.assertEqual(words.count("\n"), 1, words)
        return words

    def test_bad_files(self):
        folder = pathlib.Path(self.folder.name)
        planes = picture(8, 8)
        self.assertRegex(self.fault(folder / "none.onnx", planes), "model '.*none.onnx' does not exist or is no file")
        self.assertRegex(self.fault(folder, planes), "does not exist or is no file")
        text = folder / "text.onnx"
        text.write_text("not a net\n")
        self.assertRegex(self.fault(text, planes), "text.onnx' is not an ONNX file that OpenCV can read: ")
        whole = self.export(nn.Conv2d(3, 2, 1), planes).read_bytes()
        for share in (0.0, 0.3, 0.9):
            text.write_bytes(whole[: int(share * len(whole))])
            self.assertRegex(self.fault(text, planes), "text.onnx'")

    def test_nets_that_do_not_fit(self):
        planes = picture(8, 8)
        self.assertRegex(self.fault(self.export(nn.Conv2d(1, 2, 1), planes[:1]), planes), "does not take pictures of 8 x 8 pixels: ")
        self.assertRegex(self.fault(self.export(Flat(), planes), planes), "its result is 1 x 3 numbers, not 1 x classes x height x width")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
