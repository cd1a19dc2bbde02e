#!/usr/bin/python3
"""The aims below bench/identification_table.py: of held-out figures only, and none is called reached that is not."""
import importlib.util
import pathlib
import sys
import unittest

PATH = pathlib.Path(__file__).resolve().parents[1] / "bench" / "identification_table.py"
sys.path.insert(0, str(PATH.parent))
SPEC = importlib.util.spec_from_file_location("identification_table", PATH)
table = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(table)
import identification_runs as runs  # noqa: E402


def report(output, free_run, one_step, linear, validation=None):
    best = {"free_run": free_run, "one_step": one_step, "fit": 80.0}
    crossed = {"best": "state", "state": best, "regressors": None, "linear": dict(best, free_run=linear)}
    return {"cross_validation": {output: crossed}, "validation": validation}


class Aims(unittest.TestCase):
    def verdicts(self, name, told):
        return [cells[-1] for cells in table.aim_rows(name, told)]

    def test_each_aim_is_judged_by_its_own_figure(self):
        self.assertEqual(self.verdicts("tanks", report("y_V", 0.39, 0.051, 0.6)), ["reached", "not reached", "reached"])
        self.assertEqual(self.verdicts("tanks", report("y_V", 0.64, 0.049, 0.6)), ["not reached", "reached", "not reached"])

    def test_no_figure_is_not_reached(self):
        self.assertEqual(self.verdicts("tanks", report("y_V", None, None, 0.6)), ["not reached"] * 3)

    def test_later_rows_judge_where_there_are_any(self):
        figures = {"free_run": {"rmse": 0.2, "fit": 50.0}, "one_step": {"rmse": 0.1}}
        told = report("y", 0.05, 0.05, 0.3, {"y": dict(figures, linear=figures)})
        rows = list(table.aim_rows("drives_2", told))
        self.assertEqual([r[2] for r in rows], ["later rows"] * 2)
        self.assertEqual(rows[0][-1], "not reached")

    def test_linear_beside_itself_is_said(self):
        told = report("y", 0.3, 0.05, 0.3)
        told["cross_validation"]["y"]["best"] = "linear"
        self.assertEqual(self.verdicts("heating", told), ["reached (it is the linear model)"])

    def test_fit_is_better_when_higher(self):
        self.assertTrue(table.is_reached("fit", 97.5, 97.0))
        self.assertFalse(table.is_reached("fit", 96.9, 97.0))


class Page(unittest.TestCase):
    SECTIONS = ["records", *table.SECTIONS]

    def test_tables_stand_between_their_marks(self):
        begin = table.BEGIN % "loops"
        page = "before\n" + begin + "\n\nold\n\n" + table.END + "\nafter\n"
        self.assertEqual(table.written(page, "loops", "new\n"), "before\n" + begin + "\n\nnew\n\n" + table.END + "\nafter\n")
        with self.assertRaises(SystemExit):
            table.written(page, "cases", "new\n")

    def test_the_page_has_the_marks_of_each_section_once(self):
        page = table.PAGE.read_text(encoding="utf-8")
        self.assertEqual(len(self.SECTIONS), page.count(table.END))
        for section in self.SECTIONS:
            self.assertEqual(table.written(page, section, "x"), table.written(table.written(page, section, "y"), section, "x"))


class ClosedLoop(unittest.TestCase):
    def told(self, ratio):
        return {"title": "Tank, model found", "loops": [{"name": "auto", "median": 2.0}, {"name": "shipped", "median": 1.0}],
                "pairs": [{"median_ratio": ratio, "ratio_interval": [ratio, ratio]}]}

    def test_within_five_per_cent_of_the_shipped_model(self):
        self.assertEqual("yes", runs.loop_row("auto_tank", self.told(1.05))[-1])
        self.assertEqual("**no**", runs.loop_row("auto_tank", self.told(1.051))[-1])

    def test_each_study_ships_and_names_the_model_once(self):
        for name, (_, _, _, model) in runs.LOOPS.items():
            text = (runs.CONFIG / "study" / (name + ".yaml")).read_text(encoding="utf-8")
            self.assertEqual(1, text.count(model + ".yaml"), name)
            self.assertTrue((runs.CONFIG / "model" / (model + ".yaml")).exists(), name)


if __name__ == "__main__":
    unittest.main()
