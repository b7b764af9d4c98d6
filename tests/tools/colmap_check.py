#!/usr/bin/env python3
"""The survey of map_parcel, flown, photographed and rebuilt by COLMAP from the photographs alone (a step of .ci/nightly).

    colmap_check.py VINEROW [--width PIXELS] [--keep FOLDER]

Needs Debian's colmap, python3-scipy, and the Python package in PYTHONPATH. About half an hour on two cores. Prints the figures of
docs/guides/survey.md; the status is 1 if one of them is missed.
"""

import argparse
import csv
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy
import scipy.spatial
import vinerow

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIO = ROOT / "assets" / "scenarios" / "map_parcel.yaml"


def call(*words, log=None):
    environment = {**os.environ, "QT_QPA_PLATFORM": "offscreen"}
    done = subprocess.run([str(word) for word in words], env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if log:
        log.write_text(done.stdout)
    if done.returncode != 0:
        sys.exit(f"colmap_check: {' '.join(map(str, words[:2]))} failed: {done.stdout[-500:]}")
    return done.stdout


def rebuild(pictures, work):
    """Runs COLMAP with its defaults but 4096 features and the 12 nearest pictures to match; returns the folder of its model as text."""
    database = ["--database_path", work / "database.db"]
    call("colmap", "feature_extractor", *database, "--image_path", pictures, "--ImageReader.single_camera", 1, "--SiftExtraction.use_gpu", 0,
         "--SiftExtraction.num_threads", 2, "--SiftExtraction.max_num_features", 4096, log=work / "features.log")
    call("colmap", "spatial_matcher", *database, "--SiftMatching.use_gpu", 0, "--SiftMatching.num_threads", 2,
         "--SpatialMatching.max_num_neighbors", 12, "--SpatialMatching.max_distance", 120, log=work / "matches.log")
    (work / "sparse").mkdir()
    call("colmap", "mapper", *database, "--image_path", pictures, "--output_path", work / "sparse", log=work / "mapper.log")
    model = work / "sparse" / "0"
    call("colmap", "model_converter", "--input_path", model, "--output_path", model, "--output_type", "TXT")
    return model


def lines_of(file):
    return [line.split() for line in file.read_text().splitlines() if line and not line.startswith("#")]


def camera_places(model):
    """Positions by name: images.txt has two lines for each, the first with rotation and translation of the world in the camera."""
    places = {}
    for words in lines_of(model / "images.txt"):
        if len(words) != 10 or not words[9].endswith(".jpg"):
            continue
        w, x, y, z = map(float, words[1:5])
        R = numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                         [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                         [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
        places[words[9]] = -R.T @ numpy.array([float(word) for word in words[5:8]])
    return places


def similarity(a, b):
    """Scale, rotation, shift that take a onto b with the least squares (Umeyama 1991)."""
    ca, cb = a.mean(axis=0), b.mean(axis=0)
    U, S, Vt = numpy.linalg.svd((b - cb).T @ (a - ca))
    D = numpy.diag([1.0, 1.0, numpy.sign(numpy.linalg.det(U @ Vt))])
    R = U @ D @ Vt
    scale = (S * numpy.diag(D)).sum() / ((a - ca) ** 2).sum()
    return lambda p: scale * (R @ (p - ca).T).T + cb


def surface_distances(points, folder, program):
    """From the terrain, or from the nearest of many points on all surfaces."""
    cloud = folder / "surface.xyz"
    call(program, "cloud", SCENARIO, "--uniform", 300, "--out", cloud)
    surface = numpy.loadtxt(cloud, usecols=(0, 1, 2), skiprows=1)  # after the names of the columns
    to_cloud, _ = scipy.spatial.cKDTree(surface).query(points, workers=2)
    with vinerow.open(SCENARIO) as session:
        ground = numpy.asarray(session.world().terrain.height_at(points[:, 0], points[:, 1])).ravel()
    return numpy.minimum(to_cloud, numpy.abs(points[:, 2] - ground))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("vinerow", type=pathlib.Path)
    parser.add_argument("--width", type=int, default=1368)
    parser.add_argument("--keep", type=pathlib.Path, help="folder of all files; a temporary one without")
    arguments = parser.parse_args()
    if not shutil.which("colmap"):
        sys.exit("colmap_check: colmap is missing (apt-get install colmap)")
    folder = arguments.keep or pathlib.Path(tempfile.mkdtemp(prefix="vinerow_colmap_"))
    folder.mkdir(parents=True, exist_ok=True)
    call(arguments.vinerow, "run", SCENARIO, "--out", folder / "run", "--no-pictures", "--no-report", "--quiet")
    call(arguments.vinerow, "survey", "--log", folder / "run", "--pictures", "--picture-width", arguments.width, "--out", folder / "photos")
    # "Given only the pictures": without the lists beside them.
    pictures = folder / "pictures"
    pictures.mkdir()
    for photo in (folder / "photos" / "pictures").glob("*.jpg"):
        shutil.copy(photo, pictures)
    model = rebuild(pictures, folder)

    with (folder / "photos" / "pictures" / "truth.csv").open(newline="", encoding="utf-8") as file:
        truth = {row["photo"]: numpy.array([float(row[key]) for key in ("x_m", "y_m", "z_m")]) for row in csv.DictReader(file)}
    places = camera_places(model)
    names = sorted(places)
    a, b = numpy.array([places[name] for name in names]), numpy.array([truth[name] for name in names])
    onto = similarity(a, b)
    rms = float(numpy.sqrt(((onto(a) - b) ** 2).sum(axis=1).mean()))
    # points3D.txt: id, x y z, colour, error, then pairs of picture and key point.
    rows = [words for words in lines_of(model / "points3D.txt") if (len(words) - 8) // 2 >= 3]
    points = onto(numpy.array([[float(word) for word in words[1:4]] for words in rows]))
    off = surface_distances(points, folder, arguments.vinerow)
    registered, near = len(names) / len(truth), float((off < 0.1).mean())
    print(f"registered {len(names)} of {len(truth)}")
    print(f"camera positions {100 * rms:.1f} cm rms")
    print(f"{len(points)} points of three photographs or more: median {100 * numpy.median(off):.1f} cm, rms "
          f"{100 * numpy.sqrt((off ** 2).mean()):.1f} cm, {100 * near:.0f} % within 10 cm of the surface")
    if not arguments.keep:
        shutil.rmtree(folder)
    # A few false matches are metres off, so the rms of the points says little.
    return 0 if registered >= 0.95 and rms <= 0.05 and near >= 0.90 else 1


if __name__ == "__main__":
    sys.exit(main())
