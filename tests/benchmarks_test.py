"""What scripts/bench and bench-compare reckon with: names, choices, intervals."""

import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "scripts"))
import benchmarks as b  # noqa: E402


class Names(unittest.TestCase):
    def test_plain_drops_how_it_was_timed(self):
        self.assertEqual(b.plain("step/wcsph/3d/1M/iterations:500/real_time"), "step/wcsph/3d/1M")
        self.assertEqual(b.plain("step/wcsph/3d/1M-165/double/iterations:2/manual_time"), "step/wcsph/3d/1M-165/double")

    def test_a_whole_name_means_that_one_alone(self):
        names = ["step/1M", "step/1M-165", "step/1M/double", "rates/1M"]
        self.assertEqual(b.chosen(names, ["step/1M"]), ["step/1M"])
        self.assertEqual(b.chosen(names, ["step/", "step/1M"]), names[:3])

    def test_a_prefix_of_nothing_is_an_error(self):
        with self.assertRaises(SystemExit):
            b.chosen(["step/1M"], ["steps"])


class Intervals(unittest.TestCase):
    def test_few_values_give_their_extremes(self):
        low, high, coverage = b.interval_of_median([3, 1, 2, 5, 4])
        self.assertEqual((low, high), (1, 5))
        self.assertAlmostEqual(coverage, 1 - 2 / 2 ** 5)

    def test_many_values_are_cut_to_95_percent(self):
        # n = 12: the third smallest to the third largest hold the median with 96.1 %, the fourth ones with 85 %.
        low, high, coverage = b.interval_of_median(list(range(12)))
        self.assertEqual((low, high), (2, 9))
        self.assertAlmostEqual(coverage, 0.9614, 4)

    def test_one_value(self):
        self.assertEqual(b.interval_of_median([7])[:2], (7, 7))


class Figures(unittest.TestCase):
    def test_four_digits_and_a_prefix(self):
        self.assertEqual(b.figure(4_568_090), "4.568 M")
        self.assertEqual(b.figure(0.28906), "0.2891")
        self.assertEqual(b.figure(3.2e8), "320 M")


if __name__ == "__main__":
    unittest.main()
