#!/usr/bin/env python3
"""The Debian packages of a build: metadata, contents, and programs run from unpacked packages.

    packages_test.py BUILD_DIR VINEROW
"""

import gzip
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

BUILD, VINEROW = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
ROOT = pathlib.Path(__file__).resolve().parents[2]
VERSION = re.search(r"project\(vinerow VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
NAMES = ["vinerow", "libvinerow-dev", "python3-vinerow"]
# Only where OpenCV is at hand.
if (BUILD / "lib/libvinerow_net_host.so").exists():
    NAMES.append("vinerow-nets")
# Short, and with a world from a file beside the scenario.
SCENARIO, DURATION_S = "assets/scenarios/riseholme_rover.yaml", 5
STEP_THROUGH = """
import sys, vinerow
with vinerow.open(sys.argv[1], {"duration_s": float(sys.argv[2])}) as session:
    while not session.over:
        session.step_for(0.5)
    print(session.digest)
"""


def output(*words, **options) -> str:
    run = subprocess.run([str(word) for word in words], capture_output=True, text=True, **options)
    assert run.returncode == 0, (words, run.stdout, run.stderr)
    return run.stdout


class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.scratch = pathlib.Path(folder.name)
        # gzip: xz would take most of the test's time.
        output("cpack", "--config", BUILD / "CPackConfig.cmake", "-G", "DEB", "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=gzip",
               "-B", cls.scratch / "packages")  # fmt: skip
        cls.files = {name: next((cls.scratch / "packages").glob(f"{name}_*.deb")) for name in NAMES}
        cls.system = cls.scratch / "system"
        for name in NAMES:
            output("dpkg-deb", "-x", cls.files[name], cls.scratch / name)
            output("dpkg-deb", "-x", cls.files[name], cls.system)
        (cls.scratch / "here").mkdir()
        cls.environment = {**os.environ, "LD_LIBRARY_PATH": str(cls.system / "usr/lib"),
                           "PYTHONPATH": str(cls.system / "usr/lib/python3/dist-packages")}  # fmt: skip

    def field(self, name: str, field: str) -> str:
        return output("dpkg-deb", "-f", self.files[name], field).strip()

    def contents(self, name: str) -> set[str]:
        root = self.scratch / name
        return {path.relative_to(root).as_posix() for path in root.rglob("*") if not path.is_dir()}

    def programs(self, name: str) -> list[pathlib.Path]:
        files = [self.scratch / name / path for path in self.contents(name)]
        return [file for file in files if not file.is_symlink() and file.read_bytes()[:4] == b"\x7fELF"]

    def unpacked(self, *words, **options) -> str:
        return output(*words, env=self.environment, cwd=self.scratch / "here", **options)

    def test_metadata(self):
        machine = output("dpkg", "--print-architecture").strip()
        self.assertEqual(len(list((self.scratch / "packages").glob("*.deb"))), len(NAMES))
        for name in NAMES:
            self.assertEqual(self.files[name].name, f"{name}_{VERSION}_{machine}.deb")
            self.assertEqual((self.field(name, "Version"), self.field(name, "Architecture")), (VERSION, machine))
            self.assertRegex(self.field(name, "Maintainer"), r"^\S.* <\S+@\S+>$")
            self.assertRegex(self.field(name, "Description"), r"^physics simulator of robots.*\n \w")
        for name, section in zip(NAMES, ["science", "libdevel", "python", "science"]):
            self.assertEqual(self.field(name, "Section"), section)
        self.assertEqual(self.field("libvinerow-dev", "Depends"), f"vinerow (= {VERSION}), libeigen3-dev")
        self.assertTrue(self.field("python3-vinerow", "Depends").startswith(
            f"vinerow (= {VERSION}), python3 (>= 3.11), python3 (<< 3.12), python3-numpy, libc6"))  # fmt: skip
        self.assertEqual(self.field("vinerow", "Recommends"), "libosmesa6, fonts-dejavu-core")

    def test_every_library_is_in_a_package_that_is_required(self):
        for name in set(NAMES) - {"libvinerow-dev"}:
            required = {word.split()[0] for word in self.field(name, "Depends").split(", ")}
            programs = self.programs(name)
            self.assertTrue(programs)
            for program in programs:
                # GDAL is not linked but opened, under this name.
                opened = set(re.findall(rb"libgdal\.so\.\d+", program.read_bytes()))
                self.assertTrue(opened or program.name != "libvinerow.so.0")
                needed = re.findall(r"NEEDED\s+(\S+)", output("objdump", "-p", program))
                for library in needed + [name.decode() for name in opened]:
                    if library == "libvinerow.so.0":
                        self.assertTrue((self.scratch / "vinerow/usr/lib" / library).is_file())
                        continue
                    owners = {line.split(":")[0] for line in output("dpkg-query", "-S", f"*/{library}").splitlines()}
                    self.assertTrue(owners & required, f"{program.name} needs {library} of {owners}, but {name} requires {required}")

    def test_installed_size_is_that_of_the_files(self):
        for name in NAMES:
            size_kB = sum((self.scratch / name / path).lstat().st_size for path in self.contents(name)) / 1024
            self.assertAlmostEqual(float(self.field(name, "Installed-Size")), size_kB, delta=0.02 * size_kB + 100)

    def test_programs_are_stripped_and_search_no_folder_of_the_build(self):
        self.assertEqual({p.name.split(".")[0] for name in NAMES for p in self.programs(name)}, {"vinerow", "libvinerow", "libvinerow_python_host", "_core"} | ({"libvinerow_net_host"} if "vinerow-nets" in NAMES else set()))
        for name in NAMES:
            for program in self.programs(name):
                self.assertNotIn(".symtab", output("readelf", "-SW", program), program)
                self.assertNotRegex(output("objdump", "-p", program), r"R(UN)?PATH", program)

    def test_contents(self):
        commands = {line.split()[0] for line in re.findall(r"^complete .*-a \w+", output(VINEROW, "completion", "fish"), re.MULTILINE)
                    for line in [line.split("-a ")[1]]}  # fmt: skip
        self.assertGreater(len(commands), 15)
        for path in [*(f"share/man/man1/vinerow-{command}.1.gz" for command in commands), "share/man/man1/vinerow.1.gz",
                     "share/bash-completion/completions/vinerow", "share/zsh/vendor-completions/_vinerow",
                     "share/fish/vendor_completions.d/vinerow.fish", "share/doc/vinerow/docs/index.md", "bin/vinerow",
                     *(path.relative_to(ROOT).as_posix().replace("assets", "share/vinerow/assets", 1)
                       for path in (ROOT / "assets").rglob("*") if path.is_file())]:  # fmt: skip
            self.assertIn(f"usr/{path}", self.contents("vinerow"))
        for path in ["include/vinerow/api/plugin.h", "include/vinerow/version.h", "lib/cmake/vinerow/vinerowConfig.cmake", "lib/libvinerow.so"]:
            self.assertIn(f"usr/{path}", self.contents("libvinerow-dev"))
        sources = {path.relative_to(ROOT / "python").as_posix() for path in (ROOT / "python/vinerow").rglob("*")
                   if path.is_file() and "__pycache__" not in path.parts}  # fmt: skip
        installed = {path.removeprefix("usr/lib/python3/dist-packages/") for path in self.contents("python3-vinerow") if "dist-packages" in path}
        self.assertEqual({path for path in installed if not path.endswith(".so")}, sources)
        everything = [path for name in NAMES for path in self.contents(name)]
        self.assertEqual(len(everything), len(set(everything)), "a file is in two packages")
        for path in everything:
            self.assertTrue(path.startswith("usr/"), path)

    def test_copyright_and_changelog(self):
        licence = (ROOT / "LICENSE").read_text().split("are met:")[1]
        for name in NAMES:
            folder = self.scratch / name / "usr/share/doc" / name
            text = (folder / "copyright").read_text()
            self.assertIn(" ".join(licence.split()), " ".join(re.sub(r"^ [.]$", "", text, flags=re.MULTILINE).split()))
            for other in ["Sun Microsystems", "Arm Ltd.", "Apache-2.0", "three.js authors"]:
                self.assertIn(other, text)
            changes = gzip.decompress((folder / "changelog.gz").read_bytes()).decode()
            self.assertTrue(changes.startswith(f"vinerow ({VERSION}) bookworm;"), changes)

    def test_unpacked_command_and_python_package_give_the_digest_of_the_build(self):
        self.assertEqual(self.unpacked(self.system / "usr/bin/vinerow", "--version"), f"vinerow {VERSION}\n")
        digests = {}
        for place, program, scenario in [("build", VINEROW, ROOT / SCENARIO), ("package", self.system / "usr/bin/vinerow", SCENARIO)]:
            # The installed scenario is found by its path in the tree; the folder here has none.
            subprocess.run([program, "run", scenario, "--set", f"duration_s={DURATION_S}", "--out", place, "--no-log", "--no-report", "--quiet"],
                           env=self.environment if place == "package" else None, cwd=self.scratch / "here", capture_output=True)  # fmt: skip
            digests[place] = json.loads((self.scratch / "here" / place / "summary.json").read_text())["digest"]
        digests["python"] = self.unpacked(sys.executable, "-B", "-c", STEP_THROUGH, SCENARIO, DURATION_S).strip()
        self.assertRegex(digests["build"], r"^[0-9a-f]{16,}$")
        self.assertEqual(set(digests.values()), {digests["build"]}, digests)
        loaded = self.unpacked(sys.executable, "-B", "-c", "import vinerow; print(vinerow._core.__file__)").strip()
        self.assertTrue(loaded.startswith(str(self.system)), loaded)
        self.assertEqual(self.unpacked(sys.executable, "-B", "-m", "vinerow", "--version"), f"vinerow {VERSION}\n")


if __name__ == "__main__":
    if not all(map(shutil.which, ["dpkg-deb", "dpkg-shlibdeps", "file", "objdump", "readelf"])):
        print("skipped: dpkg-dev, file or binutils is absent")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
