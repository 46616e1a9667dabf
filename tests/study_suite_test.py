"""What scripts/study reckons with: the front, the tables, and going on where it stopped."""

import stat
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "scripts"))
import study_suite as s  # noqa: E402


def row(size, seconds, error, preset="molten", settings="", status="done", reach="0.01"):
    return {"commit": "c", "preset": preset, "settings": settings, "threads": "1", "status": status, "case": "wave",
            "numerics": preset, "dimensions": "2", "particles": "9", "size": str(size), "steps": "1",
            "wall_time_s": str(seconds), "quantity": "period", "error": str(error), "reach": reach}


class Tables(unittest.TestCase):
    rows = [row(10, 1, 0.04), row(20, 4, 0.02), row(30, 5, 0.03), row(40, 16, 0.004), row(80, 60, "nan", status="diverged")]

    def test_the_front_is_what_no_quicker_run_beats(self):
        points = s.judged(self.rows)["wave", "period"]
        self.assertEqual([p["size"] for p in s.front(points)], ["10", "20", "40"])

    def test_quantities_that_are_only_reported_are_not_judged(self):
        self.assertEqual(s.judged([row(10, 1, 0.04, reach="inf")]), {})

    def test_the_cheapest_run_that_is_good_enough(self):
        line = s.cheapest_table(s.judged(self.rows))[-1]
        self.assertEqual(line, "| wave | period | 16 s: molten, 40 | 16 s: molten, 40 | – |")

    def test_the_least_error_is_bold_within_its_reach(self):
        self.assertIn("**0.4 %**", s.smallest_table(s.judged(self.rows))[-1])
        self.assertIn("no run gave a number", s.smallest_table(s.judged(self.rows[-1:]))[-1])

    def test_a_peer_is_compared_at_its_error_and_at_its_time(self):
        peers = {("wave", "period"): [{"numerics": "peer", "size": "9", "time": 80.0, "err": 0.02}]}
        self.assertEqual(s.peer_lines(s.judged(self.rows), peers)[-1], "| wave | period | peer | 2 % | 20 | 5 |")

    def test_margins_stand_beside_the_own_step(self):
        rows = [row(10, 1, 0.01), row(10, 1, 0.02, settings="step_factor=2"),
                row(10, 1, "nan", settings="step_factor=4", status="diverged")]
        self.assertEqual(s.margin_table(s.judged(rows))[-1], "| wave | period | molten | 1 % | 2 % | diverged |  |")

    def test_changes_are_compared_with_the_default_of_the_same_size(self):
        rows = [row(10, 1, 0.01), row(20, 4, 0.02)]
        rows += [row(10, 2, 0.005, settings="end_time=1 numerics.kernel=gaussian"),
                 row(20, 2, 0.02, settings="end_time=1 numerics.kernel=gaussian"),
                 row(40, 2, 0.02, settings="end_time=1 numerics.kernel=gaussian"),
                 row(20, 2, "nan", settings="numerics.kernel=spiky", status="diverged")]
        self.assertEqual(s.change_table(s.judged(rows))[-2:], ["| kernel=gaussian | 2 | 1 | 0 | 0 | 0.71 | 1.00 |",
                                                               "| kernel=spiky | 1 | 0 | 1 | 1 | nan | nan |"])


class GoingOn(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.log = Path(self.folder.name) / "log"
        program = Path(self.folder.name) / "study"
        program.write_text(f"""#!/bin/sh
echo "$@" >> {self.log}
case "$*" in *refuse*) echo "study: no" >&2; exit 2 ;; esac
echo {",".join(s.COLUMNS)}
echo wave,molten,2,9,$4,1,0.5,period,0.01,0.02
""")
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
        self.before, s.PROGRAM = s.PROGRAM, program
        self.say, s.say = s.say, lambda line: None

    def tearDown(self):
        s.PROGRAM, s.say = self.before, self.say
        self.folder.cleanup()

    def calls(self):
        return len(self.log.read_text().splitlines()) if self.log.exists() else 0

    def test_what_is_there_is_not_run_again_but_for_what_was_refused(self):
        file = Path(self.folder.name) / "results.csv"
        runs = [("wave", 10, "molten", []), ("wave", 20, "molten", []), ("wave", 10, "refuse", [])]
        s.run_all(runs[:1], file, None)
        s.run_all(runs, file, None)
        self.assertEqual(self.calls(), 3)
        s.run_all(runs, file, None)
        self.assertEqual(self.calls(), 4)
        self.assertEqual([r["status"] for r in s.read_rows(file)], ["done", "done", "refused (2)", "refused (2)"])

    def test_every_line_is_kept_as_soon_as_its_run_ends(self):
        file = Path(self.folder.name) / "results.csv"
        s.run_all([("wave", 10, "molten", ["a=1"])], file, None)
        kept = s.read_rows(file, s.KEPT)[0]
        self.assertEqual((kept["settings"], kept["error"], kept["size"]), ("a=1", "0.01", "10"))
        self.assertEqual(kept["commit"], s.COMMIT)

    def test_what_took_too_long_is_not_tried_at_larger_sizes(self):
        file = Path(self.folder.name) / "results.csv"
        Path(s.PROGRAM).write_text(f"#!/bin/sh\necho $@ >> {self.log}\nexec sleep 5\n")
        s.run_all([("wave", 10, "molten", ["a=1"]), ("wave", 20, "molten", ["a=1"]), ("wave", 20, "molten", [])], file, 0.1)
        self.assertEqual(self.calls(), 2)
        self.assertEqual([(r["size"], r["status"]) for r in s.read_rows(file)], [("10", "too long"), ("20", "too long")])

    def test_a_full_study_sees_every_case_before_larger_sizes(self):
        runs = s.plan(False, ["couette", "kleefsman"])
        smallest = [k for k, r in enumerate(runs) if (r[0], r[1]) in {("couette", 10), ("kleefsman", 12000)}]
        self.assertEqual(smallest, list(range(len(smallest))))
        self.assertIn(("kleefsman", 400000, "dias", ["end_time=6"]), runs)


if __name__ == "__main__":
    unittest.main()
