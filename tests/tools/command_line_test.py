#!/usr/bin/env python3
"""The command line itself: help, lists, colours, completion.

    command_line_test.py VINEROW
"""

import json
import os
import pathlib
import pty
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import termios
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from mcap_file import Cdr, Log  # noqa: E402

VINEROW = sys.argv[1]
ROOT = pathlib.Path(__file__).resolve().parents[2]
RED, GREEN = "\x1b[31m", "\x1b[32m"


def vinerow(*arguments, status=0, **environment):
    run = subprocess.run([VINEROW, *arguments], capture_output=True, encoding="utf-8", env={**os.environ, **environment})
    assert run.returncode == status, (arguments, run.returncode, run.stderr)
    return run.stdout if status == 0 else run.stderr


def commands() -> list[str]:
    """Of the help: indented names under headings that are no options."""
    listed = vinerow("--help").split("\n\n")
    blocks = [b for b in listed if not b.startswith(("Vinerow", "Options", "Start", "Exit"))]
    return [line.split()[0] for block in blocks for line in block.splitlines()[1:] if re.match(r"  \w", line)]


def options_of(*command: str) -> set[str]:
    return {o for o in re.findall(r"^  ((?:-\w,)?--[\w-]+.*)$", vinerow(*command, "--help"), re.MULTILINE)
            for o in re.findall(r"--[\w-]+", o.split("  ")[0])}  # fmt: skip


def on_a_terminal(*arguments, progress_columns=0, **environment) -> str:
    """What the command prints where standard output is a terminal; or standard error, of so many columns."""
    master, slave = pty.openpty()
    if progress_columns:
        termios.tcsetwinsize(slave, (24, progress_columns))
    out, err = (subprocess.DEVNULL, slave) if progress_columns else (slave, subprocess.DEVNULL)
    env = {k: v for k, v in os.environ.items() if k != "NO_COLOR"}
    run = subprocess.Popen([VINEROW, *arguments], stdout=out, stderr=err, env={**env, "TERM": "xterm", **environment})
    os.close(slave)
    text = b""
    while True:
        try:
            piece = os.read(master, 65536)
        except OSError:  # the end of a pseudo-terminal
            break
        if not piece:
            break
        text += piece
    run.wait()
    os.close(master)
    return text.decode()


class Help(unittest.TestCase):
    def test_every_command_stands_in_a_group_with_examples_and_exit_statuses(self):
        self.assertGreater(len(commands()), 15)
        for heading in ["Simulate:", "Look at a run:", "Surveys and maps:"]:
            self.assertIn(heading, vinerow("--help"))
        for command in commands():
            text = vinerow(command, "--help")
            self.assertIn("Examples:\n", text, command)
            self.assertIn("Exit status: 0 ", text, command)

    def test_help_is_a_command_too(self):
        self.assertEqual(vinerow("help"), vinerow("--help"))
        self.assertEqual(vinerow("help", "run"), vinerow("run", "--help"))
        self.assertIn("did you mean 'run'", vinerow("help", "runn", status=2))

    def test_a_wrong_option_is_one_line(self):
        for words, sentence in ((["survey", "--picture-width", "1.5", "x.yaml"],
                                 "Could not convert: --picture-width = 1.5; see 'vinerow survey --help'"),
                                (["render", "x", "--width", "5"],
                                 "--width: Value 5 not in range 16 to 8192; see 'vinerow render --help'"),
                                (["render", "x", "--every", "inf"],
                                 "--every: must be <= 1e+09, is 'inf'; see 'vinerow render --help'"),
                                (["compare", "a", "b", "--tolerance", "nan"],
                                 "--tolerance: must be from 0 to 1, is 'nan'; see 'vinerow compare --help'"),
                                (["run"], "scenario is required; see 'vinerow run --help'"),
                                ([], "A subcommand is required; see 'vinerow --help'")):
            self.assertEqual(vinerow(*words, status=2), f"vinerow: {sentence}\n")

    def test_what_a_world_refuses_has_its_place(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "a.yaml"
            file.write_text("vinerow: 1\nworld:\n  type: vineyard\n  obstacles:\n    - {name: box, x_m: 3}\nvehicles: {}\n")
            done = subprocess.run([VINEROW, "validate", file], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (2, f"vinerow: {file}:5: world.obstacles: 'box' has x_m without y_m\n"))

    def test_examples_use_options_and_files_that_exist(self):
        for command in commands():
            examples = re.search(r"Examples:\n((?:  .*\n)+)", vinerow(command, "--help")).group(1)
            for line in examples.splitlines():
                words = shlex.split(line.split(" > ")[0])
                self.assertEqual(words[:2], ["vinerow", command])
                action = [command] + (words[2:3] if "Subcommands:" in vinerow(command, "--help") else [])
                for word in words[2:]:
                    if word.startswith("--"):
                        self.assertIn(word, options_of(*action), line)
                    if word.startswith("assets/"):
                        self.assertTrue((ROOT / word).exists(), line)

    def test_the_example_of_set_means_something_to_its_command(self):
        # Survey and cloud have other parts than a rover's controller; each example is tried on a scenario.
        tried = {"run": "riseholme_rover", "validate": "riseholme_rover", "grid": "vineyard_4ws_two_rows",
                 "survey": "survey_still", "cloud": "map_parcel"}  # fmt: skip
        for command, scenario in tried.items():
            example = re.search(r"e\.g\. --set (\S+)", vinerow(command, "--help")).group(1)
            vinerow("validate", f"{ROOT}/assets/scenarios/{scenario}.yaml", "--files-only", "--set", example)


class List(unittest.TestCase):
    def test_short_by_default_whole_on_demand(self):
        short = vinerow("list")
        parts = json.loads(vinerow("list", "--json"))
        self.assertLess(len(short.splitlines()), len(parts) + 20)
        self.assertLessEqual(max(map(len, short.splitlines())), 130)
        for part in parts:
            self.assertRegex(short, rf"(?m)^  {re.escape(part['name'])} ")
        self.assertIn("lookahead_m", vinerow("list", "pure_pursuit"))
        self.assertIn("lookahead_m", vinerow("list", "controller"))
        self.assertNotIn("lookahead_m", short)
        self.assertEqual(vinerow("list", "--full").count("(version "), len(parts))

    def test_json_tells_what_the_schema_tells(self):
        (part,) = json.loads(vinerow("list", "pure_pursuit", "--json"))
        lookahead = next(p for p in part["parameters"] if p["name"] == "lookahead_m")
        self.assertEqual((lookahead["default"], lookahead["unit"], lookahead["min"], lookahead["min_exclusive"]), (0.75, "m", 0, True))
        self.assertEqual(part["kind"], "controller")

    def test_an_unknown_part_and_two_formats_are_refused(self):
        self.assertIn("did you mean 'pure_pursuit'", vinerow("list", "pure_persuit", status=2))
        vinerow("list", "--json", "--markdown", status=2)

    def test_defaults_have_no_more_digits_than_make_sense(self):
        for default in re.findall(r"default (\S+)", vinerow("list", "--full")):
            for number in re.findall(r"\d+\.\d+", default):
                self.assertLessEqual(len(number), 11, default)


class Info(unittest.TestCase):
    def test_takes_a_log_and_the_runs_folder(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "log.mcap"
            log = Log()
            log.message(log.channel("/rover/note", "std_msgs/msg/String", "string data"), 10**9, Cdr().text("x").message())
            log.write(file)
            by_file = vinerow("info", str(file))
            self.assertRegex(by_file, r"/rover/note +std_msgs/msg/String +1 message ")
            self.assertEqual(vinerow("info", folder), by_file)


class Colours(unittest.TestCase):
    FAILS = "vinerow: 1\nname: c\nduration_s: 0.2\nworld: {type: vineyard, row_count: 2, row_length_m: 10, relief_m: 0}\n" \
        "vehicles: {rover: {type: diff_drive_rover, spawn: {alley: 0, offset_m: 2}}}\n" \
        "criteria: [{metric: rover.distance_m, min: 5}, {metric: rover.contact_count, max: 0}]\n"  # fmt: skip

    def run_it(self, on, *arguments, **environment):
        with tempfile.TemporaryDirectory() as folder:
            scenario = pathlib.Path(folder, "c.yaml")
            scenario.write_text(self.FAILS)
            words = ["run", str(scenario), "--out", folder + "/out", "--no-log", "--no-report", "--quiet", *arguments]
            return on_a_terminal(*words, **environment) if on else vinerow_any(*words, **environment)

    def test_failed_is_red_and_met_is_green_on_a_terminal(self):
        text = self.run_it(True)
        self.assertIn(RED + "FAILED\x1b[0m  rover.distance_m", text)
        self.assertIn(GREEN + "met   \x1b[0m  rover.contact_count", text)

    def test_no_colour_elsewhere_or_where_it_is_not_wanted(self):
        for text in [self.run_it(False), self.run_it(True, NO_COLOR="1"), self.run_it(True, TERM="dumb"), self.run_it(True, "--color", "never")]:
            self.assertIn("FAILED  rover.distance_m", text)
            self.assertNotIn("\x1b", text)

    def test_color_always_wins(self):
        self.assertIn(RED, self.run_it(False, "--color", "always"))
        self.assertIn(RED, self.run_it(True, "--color", "always", NO_COLOR="1"))


class Progress(unittest.TestCase):
    def test_a_bar_stays_on_its_line(self):
        for columns, longest in [(20, 19), (70, 69), (80, 79), (200, None)]:
            with self.subTest(columns=columns), tempfile.TemporaryDirectory() as folder:
                scenario = pathlib.Path(folder, "c.yaml")
                scenario.write_text(Colours.FAILS.replace("duration_s: 0.2", "duration_s: 600"))
                text = on_a_terminal("run", str(scenario), "--out", folder + "/out", "--no-log", "--no-report", "--no-pictures", progress_columns=columns)
                bars = [bar.removesuffix("\x1b[K") for bar in re.split(r"[\r\n]+", text) if bar.startswith("[")]
                self.assertTrue(bars)
                for bar in bars:
                    self.assertLessEqual(len(bar), longest or 200)
                    self.assertTrue(columns < 70 or bar.endswith(" s left"), bar)
                if longest is None:
                    self.assertEqual({bar.index("]") for bar in bars}, {31})


def vinerow_any(*arguments, **environment) -> str:
    run = subprocess.run([VINEROW, *arguments], capture_output=True, encoding="utf-8", env={**os.environ, **environment})
    return run.stdout


class Manual(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        vinerow("docs", "--man", "--out", cls.folder.name)
        cls.pages = {page.stem: page for page in pathlib.Path(cls.folder.name).glob("*.1")}

    def text(self, page: str) -> str:
        """As man shows it, in one line."""
        shown = subprocess.run(["groff", "-man", "-Tascii", "-ww", "-P-cbou", "-rLL=200n", str(self.pages[page])], capture_output=True, text=True)
        self.assertEqual((shown.returncode, shown.stderr), (0, ""), page)
        return " ".join(shown.stdout.split())

    def test_every_command_has_a_page(self):
        self.assertEqual(set(self.pages), {"vinerow"} | {f"vinerow-{command}" for command in commands()})

    @unittest.skipUnless(shutil.which("groff"), "groff is absent")
    def test_pages_have_the_options_examples_and_exit_statuses_of_the_help(self):
        for command in commands():
            text, shown = self.text(f"vinerow-{command}"), vinerow(command, "--help")
            self.assertIn(f"NAME vinerow-{command} - ", text)
            for option in options_of(command) - {"--help"}:
                self.assertRegex(text, rf"[ ,]{option}[ ,{{]", command)
            for line in re.search(r"Examples:\n((?:  .*\n)+)", shown).group(1).splitlines():
                self.assertIn(" ".join(line.split()), text, command)
            self.assertIn(f"EXIT STATUS {re.search('Exit status: (.*)', shown).group(1)}", text)
        whole = self.text("vinerow")
        for command in commands():
            self.assertIn(f"vinerow-{command}(1)", whole)

    @unittest.skipUnless(shutil.which("groff"), "groff is absent")
    def test_actions_of_a_command_are_on_its_page(self):
        text = self.text("vinerow-study")
        for action in ["run", "resume", "table"]:
            self.assertIn(f"vinerow study {action} [options] study", text)
            for option in options_of("study", action) - {"--help"}:
                self.assertIn(f" {option} ", text)


class Gdal(unittest.TestCase):
    def test_where_it_cannot_be_loaded_only_geodata_fail(self):
        with tempfile.TemporaryDirectory() as folder:
            broken = pathlib.Path(folder)
            for name in re.findall(rb"libgdal\.so[.0-9]*", (pathlib.Path(VINEROW).parents[1] / "lib" / "libvinerow.so.0").read_bytes()):
                (broken / name.decode()).touch()
            cloud = broken / "cloud.xyz"
            cloud.write_text("500000 5000000 100\n500001 5000000 100\n500000 5000001 100\n")
            told = vinerow("map", cloud, "--crs", "EPSG:25832", "--out", broken / "map", status=2, LD_LIBRARY_PATH=folder)
            self.assertIn("geodata need GDAL, which cannot be loaded: ", told)
            self.assertIn("file too short", told)
            self.assertIn("vineyard", vinerow("list", "world", LD_LIBRARY_PATH=folder))


class Completion(unittest.TestCase):
    def bash(self, *words: str, cwd=ROOT, **environment: str) -> list[str]:
        """What bash offers for the last word; the shell sources what the command prints."""
        script = (
            'source <("$0" completion bash); shift 0; COMP_WORDS=("$@"); COMP_CWORD=$((${#COMP_WORDS[@]} - 1));'
            ' _vinerow; printf "%s\\n" "${COMPREPLY[@]}"'
        )
        run = subprocess.run(["bash", "-c", script, str(pathlib.Path(VINEROW).resolve()), "vinerow", *words], capture_output=True, text=True, cwd=cwd,
                             env={**os.environ, **environment})
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        return run.stdout.split()

    def test_bash_offers_every_command(self):
        self.assertEqual(sorted(w for w in self.bash("") if w[0] != "-"), sorted(commands()))
        self.assertEqual(sorted(self.bash("re")), ["render", "replay", "report"])

    def test_bash_offers_the_options_that_the_help_shows(self):
        for command in commands():
            offered = {w for w in self.bash(command, "--") if w.startswith("--")}
            self.assertEqual(offered, options_of(command) | {"--color"}, command)

    def test_bash_offers_values_and_files(self):
        self.assertEqual(sorted(self.bash("schema", "")), ["map.json", "report.json", "scenario", "study"])
        self.assertEqual(sorted(self.bash("study", "re")), ["repeat", "report", "resume"])
        self.assertEqual(set(self.bash("study", "resume", "--")), options_of("study", "resume") | {"--color"})
        self.assertEqual(self.bash("study", "run", "READ"), ["README.md"])
        self.assertEqual(sorted(self.bash("compare", "--fail-on", "")), ["difference", "none", "regression"])
        self.assertEqual(self.bash("run", "CHANGE"), ["CHANGELOG.md"])
        self.assertEqual(self.bash("run", "--out", "READ"), ["README.md"])

    def test_bash_offers_kinds_and_names_of_parts(self):
        parts = {part["name"] for part in json.loads(vinerow("list", "--json"))}
        kinds = {part["kind"] for part in json.loads(vinerow("list", "--json"))}
        self.assertEqual(set(self.bash("list", "")), parts | kinds)

    def test_bash_offers_installed_scenarios_where_there_are_no_others(self):
        with tempfile.TemporaryDirectory() as folder:
            prefix, here = pathlib.Path(folder, "prefix"), pathlib.Path(folder, "here")
            (prefix / "bin").mkdir(parents=True)
            (prefix / "bin/vinerow").symlink_to(pathlib.Path(VINEROW).resolve())
            for name in ["scenarios/one.yaml", "scenarios/two.yaml", "studies/three.yaml"]:
                (prefix / "share/vinerow/assets" / name).parent.mkdir(parents=True, exist_ok=True)
                (prefix / "share/vinerow/assets" / name).touch()
            here.mkdir()
            path = {"PATH": f"{prefix}/bin:{os.environ['PATH']}"}
            self.assertEqual(sorted(self.bash("run", "", cwd=here, **path)), ["assets/scenarios/one.yaml", "assets/scenarios/two.yaml"])
            self.assertEqual(self.bash("run", "assets/scenarios/t", cwd=here, **path), ["assets/scenarios/two.yaml"])
            self.assertEqual(self.bash("study", "run", "", cwd=here, **path), ["assets/studies/three.yaml"])
            self.assertEqual(self.bash("run", "--out", "a", cwd=here, **path), [])
            (here / "assets").mkdir()
            self.assertEqual(self.bash("run", "", cwd=here, **path), ["assets"])

    def test_zsh_and_fish_take_their_scripts(self):
        for shell in ["zsh", "fish"]:
            script = vinerow("completion", shell)
            for command in commands():
                self.assertIn(command, script)
            if shutil.which(shell):
                check = subprocess.run([shell, "-n"], input=script, capture_output=True, text=True)
                self.assertEqual((check.returncode, check.stderr), (0, ""))
        if shutil.which("fish"):
            ask = 'source (echo $script | psub); complete -C "vinerow compare --fail-on "'
            env = {**os.environ, "script": vinerow("completion", "fish")}
            told = subprocess.run(["fish", "-c", ask], capture_output=True, text=True, env=env).stdout
            self.assertEqual([line.split("\t")[0] for line in told.splitlines()], ["difference", "none", "regression"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
