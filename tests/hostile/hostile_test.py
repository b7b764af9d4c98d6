#!/usr/bin/env python3
"""Does tools/hostile notice what goes wrong, by its fork server as by processes of their own?

    hostile_test.py FAKE_PROGRAM FAKE_SERVER
"""

import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))

from hostilelib import watch  # noqa: E402

EXPECTED = {("abort",): (-6, "crash (SIGABRT)"), ("hang",): (-9, "hang"), ("large",): (0, "memory"),
            ("refuse",): (2, ""), ("refuse_silently",): (2, "exit status 2 without one sentence"),
            ("folder",): (0, ""), ("words", "two words"): (0, ""), ("other",): (5, "exit status 5")}


class Watching(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.place = pathlib.Path(self.folder.name)
        (self.place / "here").touch()

    def tearDown(self):
        self.folder.cleanup()

    def check(self, run):
        for words, (status, fault) in EXPECTED.items():
            # 300 MB are too much, and far below the limit of addresses, which is half as much again.
            watch.MOST_KB = 280 * 1024 if words == ("large",) else 4 * 1024 * 1024
            watch.LONGEST_S = 0.5 if words == ("hang",) else 20.0
            outcome = run(list(words))
            self.assertEqual((outcome.status, outcome.fault), (status, fault), words)
            self.assertEqual(outcome.peak_kb > 290 * 1024, words == ("large",), words)

    def test_process_of_its_own(self):
        self.check(lambda words: watch.watch([PROGRAM, *words], self.place, False))

    def test_fork_server(self):
        server = watch.ForkServer(SERVER, False)
        self.check(lambda words: server.watch(words, self.place))
        server.close()

    def test_sanitized_program_without_limit_of_addresses(self):
        server = watch.ForkServer(SERVER, True)
        self.check(lambda words: server.watch(words, self.place))
        server.close()

    def test_fork_server_limits_addresses(self):
        watch.MOST_KB = 64 * 1024  # 96 MB of addresses
        server = watch.ForkServer(SERVER, False)
        outcome = server.watch(["large"], self.place)
        server.close()
        self.assertEqual((outcome.status, outcome.fault), (-6, "crash (SIGABRT)"), outcome.error)


if __name__ == "__main__":
    PROGRAM, SERVER = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1])
