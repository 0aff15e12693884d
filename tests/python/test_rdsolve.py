"""The Python module: a run, its tables with units, and how it fails. Values are closed forms of a cantilever."""

import math
import os
import tempfile
import unittest
from pathlib import Path

import rdsolve

DECK = """
units = "SI"
[analysis]
kind = "static"
end_time = 1.0
time_step = 1.0
[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
[sections.s]
shape = "rectangle"
width = 0.01
height = 0.01
[points]
NA = [0.0, 0.0, 0.0]
tip = [1.0, 0.0, 0.0]
[[beams]]
name = "beam"
path = ["NA", "tip"]
elements = 2
shear = false
material = "steel"
section = "s"
orientation = [0.0, 1.0, 0.0]
[[supports]]
at = "NA"
fix = "all"
[[loads]]
at = "tip"
force = [0.0, 0.0, 0.001]
"""


class Module(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.deck = Path(self.folder.name) / "deck.toml"
        self.deck.write_text(DECK)
        self.out = Path(self.folder.name) / "out"

    def test_run_gives_tables_with_units(self):
        result = rdsolve.run(self.deck, output=self.out)
        self.assertEqual(result.status, "done")
        nodes = result["nodes"]
        self.assertEqual(nodes.attrs["units"]["ux"], "m")
        self.assertEqual(nodes.attrs["units"]["wx"], "rad/s")
        # A point whose name is NA is a point.
        self.assertEqual(set(nodes["node"]), {"NA", "tip"})
        tip = nodes[nodes["node"] == "tip"].iloc[-1]
        # F l³/(3 E I) with I = a⁴/12; the stiffness in shear of `shear = false` leaves 1e-5.
        self.assertLess(abs(tip["uz"] / (0.001 * 12.0 / (3.0 * 210e9 * 0.01**4)) - 1.0), 2e-5)
        self.assertIn("nodes", result)
        self.assertEqual(len(result), len(list(result)))

    def test_entries_of_the_deck_are_set(self):
        first = rdsolve.run(self.deck, output=self.out)["nodes"]["uz"].iloc[-1]
        sets = {"loads[0].force": [0.0, 0.0, 0.002], "title": 'a "title"', "units": "mm-t-s", "beams.beam.shear": False}
        second = rdsolve.run(self.deck, set=sets, output=self.out)
        self.assertLess(abs(second["nodes"]["uz"].iloc[-1] / first - 2.0), 1e-6)
        self.assertEqual(second.result["title"], 'a "title"')
        self.assertEqual(second["nodes"].attrs["units"]["ux"], "mm")

    def test_failures_carry_their_code(self):
        with self.assertRaises(rdsolve.Failed) as caught:
            rdsolve.run(self.deck, set={"beams.beam.elemnts": 3}, output=self.out)
        self.assertEqual(caught.exception.code, 3)
        self.assertIn("did you mean `elements`?", caught.exception.said)
        expect = [{"at": "tip", "quantity": "uz", "time": 1.0, "value": 1.0, "tolerance": 0.01, "source": "none"}]
        with self.assertRaises(rdsolve.Failed) as caught:
            rdsolve.run(self.deck, set={"expect": expect}, output=self.out)
        self.assertEqual(caught.exception.code, 5)
        missed = rdsolve.run(self.deck, set={"expect": expect}, output=self.out, check=False)
        self.assertEqual(missed.exit_code, 5)
        with self.assertRaises(KeyError) as caught:
            missed["shells"]
        self.assertIn("nodes", str(caught.exception))

    def test_a_torn_row_is_no_row(self):
        rdsolve.run(self.deck, output=self.out)
        whole = rdsolve.read(self.out)["nodes"]
        table = self.out / "nodes.csv"
        # The last number has lost digits, and is a number still.
        table.write_bytes(table.read_bytes()[:-2])
        with self.assertWarnsRegex(UserWarning, "nodes.csv is incomplete"):
            torn = rdsolve.read(self.out)["nodes"]
        self.assertTrue(torn.equals(whole.iloc[:-1]))
        table.write_bytes(table.read_bytes()[:9])
        with self.assertRaisesRegex(ValueError, "nodes.csv has no whole line"):
            rdsolve.read(self.out)["nodes"]

    def test_values_are_written_as_toml(self):
        for value, text in [
            (True, "true"),
            (1, "1"),
            (1e-7, "1e-07"),
            (math.inf, "inf"),
            ([1.5, "a"], '[1.5, "a"]'),
            ({"ux": {"scale": 2.0}}, '{ "ux" = { "scale" = 2.0 } }'),
            (Path("a") / "b", '"a/b"' if os.sep == "/" else '"a\\\\b"'),
        ]:
            self.assertEqual(rdsolve._toml(value), text)
        with self.assertRaises(TypeError):
            rdsolve._toml(None)


if __name__ == "__main__":
    unittest.main()
